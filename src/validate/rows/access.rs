//! Medium access whose forms are exact, or nearly so.

use super::{EQUAL_LOSS, Row, Setting, anywhere, pair, traffic};
use crate::radio::LossCause;
use crate::validate::forms::access::{m_d_1, pure_aloha};
use crate::validate::forms::airtime::{ieee802154, lora};
use crate::validate::forms::special::ratio;
use crate::validate::reading;

const MS: f64 = 1e-3;

/// Time on air of 20 bytes over 802.15.4, seconds.
fn airtime() -> f64 {
    1e-6 * ieee802154(20)
}

/// Robots that all hear each other over 802.15.4.
fn everybody(seconds: f64, robots: u32, when: &str, radio: &str) -> Setting {
    let load = format!("when: {when}, payload: 20");
    let radio = format!("technology: Ieee802154(), {EQUAL_LOSS}, {radio}");
    traffic(seconds, &anywhere(robots), &load, &radio)
}

pub fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    rows.extend(aloha());
    rows.extend(slotted());
    rows.extend(queues());
    rows.extend(hidden());
    rows.extend(lone());
    rows.extend(advertising());
    rows.push(duty_cycle());
    rows
}

fn aloha() -> Vec<Row> {
    let row = |(robots, rate): (i32, f64)| {
        let seconds = if robots > 20 { 20.0 } else { 60.0 };
        let setting = everybody(
            seconds,
            robots.cast_unsigned(),
            &format!("Poisson({rate:?})"),
            "access: Aloha(), capture: inf",
        );
        let expected = pure_aloha(robots, rate * airtime());
        Row::new(
            "ALOHA",
            format!("aloha.pure.{robots}-robots"),
            (expected, ""),
            setting,
            reading::delivered,
        )
        .form(format!(
            "((1 − ρ) e^(−ρ))^(n − 1), ρ = λT, n = {robots} at {rate} /s (Abramson, 1970)"
        ))
    };
    let mut rows: Vec<Row> = [(10, 20.0), (50, 4.0)].into_iter().map(row).collect();
    let (robots, rate) = (10, 20.0);
    let setting = everybody(20.0, 10, "Poisson(20.0)", "access: Aloha(), capture: inf, queue: 1000");
    let busy = 1.0 - (1.0 - rate * airtime()).powi(robots);
    rows.push(
        Row::new("ALOHA", "aloha.pure.busy", (busy, ""), setting, reading::busy_share)
            .form("the channel is busy 1 − (1 − λT)ⁿ of the time, n = 10 at 20 /s"),
    );
    rows
}

fn slotted() -> Vec<Row> {
    let access = |probability: f64| format!("access: SlottedAloha(slot: 0.0012, probability: {probability:?})");
    let row = |(robots, probability): (i32, f64)| {
        let radio = format!("{}, capture: inf", access(probability));
        let setting = everybody(10.0, robots.cast_unsigned(), "Saturated", &radio);
        let expected = (1.0 - probability).powi(robots - 1);
        Row::new(
            "ALOHA",
            format!("aloha.slotted.{robots}-robots"),
            (expected, ""),
            setting,
            reading::delivered,
        )
        .trials(12)
        .form(format!(
            "(1 − p)^(N − 1), N = {robots}, p = {probability} (Roberts, 1975)"
        ))
    };
    let mut rows: Vec<Row> = [(10, 0.1), (30, 0.05)].into_iter().map(row).collect();
    for (decibels, robots) in [(6.0, 50), (3.0, 20)] {
        let busy = 1.0 / f64::from(robots);
        let radio = format!(
            "{}, capture: {decibels:?}, negligible: 60.0, fading: Rayleigh(doppler: 5000.0)",
            access(busy)
        );
        let setting = everybody(4.0, robots, "Saturated", &radio);
        let z = ratio(decibels);
        let expected = (1.0 - busy * z / (1.0 + z)).powi(robots.cast_signed() - 2) * (1.0 - busy);
        rows.push(
            Row::new("ALOHA", format!("aloha.capture.{decibels}-db"), (expected, ""), setting, reading::delivered)
                .form(format!(
                    "(1 − pz/(1 + z))^(N − 2) (1 − p): Rayleigh fading, N = {robots}, p = 1/N, ratio z of {decibels} dB over all others together"
                ))
                .within(0.005, super::WAVES),
        );
    }
    rows
}

fn queues() -> Vec<Row> {
    let alone = |load: f64, queue: u32| {
        let load = format!(
            "senders: Given([0]), when: Poisson({:?}), payload: 20",
            load / airtime()
        );
        let radio = format!("technology: Ieee802154(), {EQUAL_LOSS}, access: Aloha(), queue: {queue}");
        traffic(30.0, &pair(1.0), &load, &radio)
    };
    let waits = |load: f64| {
        let expected = m_d_1(load) * airtime() / MS;
        let name = format!("queue.m-d-1.{load}");
        Row::new(
            "queue",
            name,
            (expected, "ms"),
            alone(load, 1000),
            reading::queue_wait(MS),
        )
        .form(format!(
            "M/D/1: mean wait ρT/2(1 − ρ), ρ = {load} (Pollaczek and Khinchine)"
        ))
    };
    let full = Row::new(
        "queue",
        "queue.full",
        (0.5, ""),
        alone(1.0, 1),
        reading::lost_to(LossCause::QueueFull),
    )
    .form("room for one frame: ρ/(1 + ρ) find none, ρ = 1 (Erlang's B)");
    let (slots, slot, share) = (20_u32, 0.002, 0.5);
    let frame = f64::from(slots) * slot;
    let setting = everybody(
        60.0,
        slots,
        &format!("Poisson({:?})", share / frame),
        &format!("access: Tdma(slot: {slot:?}, guard: Some(0.0)), queue: 1000"),
    );
    let expected = frame / 2.0 + share * frame / (2.0 * (1.0 - share)) + airtime();
    let tdma = Row::new(
        "queue",
        "queue.tdma",
        (expected / MS, "ms"),
        setting,
        reading::latency(MS),
    )
    .form("a slot of one's own in each frame of F: F/2 + λF²/2(1 − λF) + T, λF = 0.5")
    .within(
        0.002,
        "the queue is empty at first, and what is left in it at the end is not counted",
    );
    vec![waits(0.3), waits(0.8), full, tdma]
}

/// Two robots that hear a third one between them, and not each other.
pub fn hidden_pair(seconds: f64, rate: f64, radio: &str) -> Setting {
    let place = "arena: (size: (9.0, 9.0), obstacles: [Wall(from: (0.0, -1.0), to: (0.0, 1.0))]),\n    swarm: (robots: 3, deploy: At([(-0.5, 0.0), (0.0, 1.5), (0.5, 0.0)]))";
    let load = format!("senders: Given([0, 2]), when: Poisson({rate:?}), payload: 20");
    let radio = format!("technology: Ieee802154(), {EQUAL_LOSS}, walls: Block, capture: inf, {radio}");
    traffic(seconds, place, &load, &radio)
}

fn hidden() -> Vec<Row> {
    let row = |rate: f64| {
        let load = rate * airtime();
        let expected = (1.0 - load) * (-load).exp();
        let setting = hidden_pair(60.0, rate, "access: Aloha(), queue: 1000");
        Row::new(
            "hidden pair",
            format!("hidden.aloha.{rate}-hz"),
            (expected, ""),
            setting,
            reading::delivered,
        )
        .form(format!("(1 − λT) e^(−λT) without carrier sense, {rate} /s"))
    };
    [50.0, 200.0].into_iter().map(row).collect()
}

/// 802.15.4 with nobody in the way, and with nobody to answer.
fn lone() -> Vec<Row> {
    let load = "senders: Given([0]), to: Next, when: Periodic(0.01), payload: 20";
    let radio = format!("technology: Ieee802154(), {EQUAL_LOSS}");
    let delay = Row::new(
        "CSMA/CA",
        "csma-ca.lone",
        (1440.0, "µs"),
        traffic(60.0, &pair(1.0), load, &radio),
        reading::access_delay(1e-6),
    )
    .form("alone: a backoff of 0 to 7 times 320 µs, 128 µs of assessment, 192 µs of turnaround (IEEE 802.15.4)");
    let far = "technology: Ieee802154(), path_loss: LogDistance(exponent: 3.0, reference_loss: 40.0)";
    let load = "senders: Given([0]), to: Next, when: Periodic(0.1), payload: 20";
    let attempts = Row::new(
        "CSMA/CA",
        "csma-ca.no-answer",
        (4.0, ""),
        traffic(20.05, &pair(4000.0), load, far),
        reading::attempts,
    )
    .exact()
    .form("out of reach: a frame is sent once and again three times (IEEE 802.15.4)");
    vec![delay, attempts]
}

fn advertising() -> Vec<Row> {
    let row = |robots: i32| {
        let (event, mean) = (376e-6, 0.105);
        let clean = (1.0_f64 - 2.0 * event / mean).powi(robots - 2);
        let awake = 1.0 - 4.0 * event / mean;
        let radio = format!("technology: BleAdvertising(interval: 0.1), {EQUAL_LOSS}, capture: inf");
        let setting = traffic(
            20.0,
            &anywhere(robots.cast_unsigned()),
            "when: Saturated, payload: 31",
            &radio,
        );
        Row::new(
            "BLE",
            format!("ble.advertising.{robots}-robots"),
            (clean * awake, ""),
            setting,
            reading::delivered,
        )
        .trials(12)
        .form(format!(
            "(1 − 2T/I)^(n − 2) (1 − 4T/I), T = 376 µs, I = 105 ms on average, n = {robots}"
        ))
        .give_or_take(
            0.01,
            "a receiver that goes on to another channel in the middle of an event may miss all of it",
        )
    };
    vec![row(10), row(50)]
}

fn duty_cycle() -> Row {
    let share = 0.01;
    let airtime = 1e-6 * lora(20, 7);
    let radio = format!("technology: LoRa(spreading: 7, duty_cycle: Some({share:?})), {EQUAL_LOSS}");
    let load = "senders: Given([0]), when: Saturated, payload: 20";
    let seconds = 1000.0 * airtime / share;
    Row::new(
        "LoRa",
        "lora.duty-cycle",
        (share, ""),
        traffic(seconds, &pair(1.0), load, &radio),
        reading::airtime_share,
    )
    .exact()
    .form("saturated, a sender is on air for its duty cycle: 1 %")
    .within(0.001, "the run ends within a thousandth of it")
}
