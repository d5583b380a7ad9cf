//! Many robots on one channel: Wi-Fi by Bianchi's forms, and 802.15.4 by what independent programs found, for want of a form that holds.

use super::access::hidden_pair;
use super::{EQUAL_LOSS, Row, Setting, anywhere, traffic};
use crate::metrics::TrialRecord;
use crate::radio::LossCause;
use crate::statistics::Part;
use crate::validate::forms::access::{Cell, bianchi, saturation};
use crate::validate::forms::airtime::dsss;
use crate::validate::reading;

pub fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    rows.extend(unicast());
    rows.extend(broadcast());
    rows.extend(csma_ca());
    rows
}

fn saturated(robots: u32, seconds: f64, load: &str) -> Setting {
    let radio = format!("technology: Wifi(standard: B, rate: Some(1e6)), {EQUAL_LOSS}, capture: inf");
    traffic(seconds, &anywhere(robots), &format!("when: Saturated, {load}"), &radio)
}

/// Saturated stations of 802.11b that send 1000 bytes at 1 Mb/s to each other, acknowledged.
fn unicast() -> Vec<Row> {
    let cell = Cell {
        slot: 20.0,
        frame: dsss(1000, 1.0),
        // SIFS, an acknowledgement, DIFS; DIFS alone.
        acknowledged: 10.0 + 304.0 + 50.0,
        collided: 50.0,
    };
    let mut rows = Vec::new();
    for (robots, seconds) in [(5, 20.0), (10, 30.0), (20, 40.0)] {
        let (tau, p) = bianchi(robots, 32.0, 5, 7);
        let setting = || saturated(robots.cast_unsigned(), seconds, "payload: 1000, to: Next");
        let expected = saturation(robots, tau, 8000.0, &cell);
        rows.push(
            Row::new("DCF", format!("dcf.throughput.{robots}-robots"), (expected, "Mb/s"), setting(), reading::goodput)
                .trials(16)
                .form(format!("saturated unicast, {robots} stations at 1 Mb/s, 1000 bytes, windows of 32 to 1024, 7 attempts (Bianchi, 2000)"))
                .within(0.01, "all slots in step, nobody waits out a timeout"),
        );
        rows.push(
            Row::new(
                "DCF",
                format!("dcf.collisions.{robots}-robots"),
                (p, ""),
                setting(),
                reading::failed_attempts,
            )
            .trials(16)
            .form(format!(
                "the same: share of attempts that collide, p = 1 − (1 − τ)^(n − 1), n = {robots} (Bianchi, 2000)"
            ))
            .within(
                0.12,
                "who collided waits out a timeout while others count on: p is a little lower",
            ),
        );
    }
    rows
}

/// Saturated broadcasts: nobody answers, windows stay.
fn broadcast() -> Vec<Row> {
    let row = |robots: i32| {
        let expected = after_batches(robots, 32.0);
        let setting = saturated(robots.cast_unsigned(), 6.0, "payload: 20");
        Row::new("DCF", format!("dcf.broadcast.{robots}-robots"), (expected, ""), setting, reading::delivered)
            .trials(12)
            .form(format!(
                "saturated broadcast, {robots} stations: Σ W^(−k) (1 − 2/W^(k + 1))^(n − 1)/Σ W^(−k), W = 32: who drew 0 goes on at once, with those alone that did too"
            ))
            .within(0.01, "what stations have left to count is taken as independent")
    };
    [2, 5, 10, 20].into_iter().map(row).collect()
}

/// Frames that nobody else sends in the same slot. Behind an idle slot each station sends with q = 2/W; behind a busy one those alone that sent in it may, each with 1/W.
fn after_batches(robots: i32, window: f64) -> f64 {
    let weights = |k: i32| window.powi(-k);
    let clean = |k: i32| weights(k) * (1.0 - 2.0 / window.powi(k + 1)).powi(robots - 1);
    (0..12).map(clean).sum::<f64>() / (0..12).map(weights).sum::<f64>()
}

/// Unslotted CSMA/CA of 802.15.4.
fn csma_ca() -> Vec<Row> {
    const MODEL: &str = "CSMA/CA";
    let setting = |robots: u32| {
        let radio = format!("technology: Ieee802154(), {EQUAL_LOSS}, capture: inf");
        traffic(11.0, &anywhere(robots), "when: Poisson(10.0), payload: 20", &radio)
    };
    let source = "an independent program of the standard's text, mean of its runs";
    let why = "half of the 95 % interval of that program";
    let row = |name: &str,
               robots: u32,
               (expected, half, unit): (f64, f64, &'static str),
               what: &str,
               reading: fn(&TrialRecord) -> Part| {
        Row::new(
            MODEL,
            format!("csma-ca.{name}.{robots}-robots"),
            (expected, unit),
            setting(robots),
            reading,
        )
        .trials(if robots > 20 { 12 } else { 20 })
        .form(format!(
            "{what}, {robots} robots that broadcast 20 bytes at 10 /s: {source}"
        ))
        .give_or_take(half, why)
    };
    let delay: fn(&TrialRecord) -> Part = |record| reading::delay(1e-3)(record);
    let failures: fn(&TrialRecord) -> Part = |record| reading::lost_to(LossCause::AccessFailure)(record);
    let delivered = "copies delivered where overlaps are lost";
    vec![
        row("broadcast", 20, (0.9077, 0.0038, ""), delivered, reading::delivered),
        row("broadcast", 50, (0.6782, 0.0038, ""), delivered, reading::delivered),
        row(
            "delay",
            20,
            (2.5568, 0.0351, "ms"),
            "mean time from a message to its frame on air",
            delay,
        ),
        row(
            "delay",
            50,
            (4.8892, 0.0485, "ms"),
            "mean time from a message to its frame on air",
            delay,
        ),
        row(
            "failures",
            50,
            (0.0340, 0.0011, ""),
            "share that finds no clear channel",
            failures,
        ),
        Row::new(
            MODEL,
            "csma-ca.hidden.50-hz",
            (0.880_35, ""),
            hidden_pair(60.0, 50.0, "queue: 16"),
            reading::delivered,
        )
        .form("a hidden pair with carrier sense, 50 /s: ns-3.37 where overlaps in its traces are lost")
        .give_or_take(0.0022, "half of the 95 % interval of its runs"),
    ]
}
