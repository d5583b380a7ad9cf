//! How long frames are on air: lone ones, from sender to receiver.

use super::{EQUAL_LOSS, Row, link, pair, traffic};
use crate::validate::forms::airtime::{dsss, ieee802154, lora, ofdm};
use crate::validate::reading;

const MODEL: &str = "airtime";

const US: f64 = 1e-6;

fn row(name: &str, technology: &str, payload: u32, micros: f64) -> Row {
    let radio = format!("technology: {technology}, {EQUAL_LOSS}");
    let setting = link(20.0, 1.0, "Periodic(2.0)", payload, &radio);
    Row::new(
        MODEL,
        format!("airtime.{name}"),
        (micros, "µs"),
        setting,
        reading::latency(US),
    )
    .exact()
}

pub fn rows() -> Vec<Row> {
    let mut rows = vec![
        row("802154.20-bytes", "Ieee802154()", 20, ieee802154(20)).form("(17 + payload) · 32 µs (IEEE 802.15.4)"),
        row("802154.100-bytes", "Ieee802154()", 100, ieee802154(100)).form("(17 + payload) · 32 µs (IEEE 802.15.4)"),
        row("wifi-b.1-mbps", "Wifi(standard: B, rate: Some(1e6))", 20, dsss(20, 1.0))
            .form("192 + ⌈8(36 + payload)/rate⌉ µs (IEEE 802.11b)"),
        row(
            "wifi-b.11-mbps",
            "Wifi(standard: B, rate: Some(11e6))",
            1000,
            dsss(1000, 11.0),
        )
        .form("192 + ⌈8(36 + payload)/rate⌉ µs (IEEE 802.11b)"),
        row("wifi-g.6-mbps", "Wifi(standard: G, rate: Some(6e6))", 20, ofdm(20, 6.0))
            .form("26 + 4⌈(22 + 8(36 + payload))/4 rate⌉ µs (IEEE 802.11g)"),
        row(
            "wifi-g.54-mbps",
            "Wifi(standard: G, rate: Some(54e6))",
            1000,
            ofdm(1000, 54.0),
        )
        .form("26 + 4⌈(22 + 8(36 + payload))/4 rate⌉ µs (IEEE 802.11g)"),
        row("lora.sf7", "LoRa(spreading: 7)", 20, lora(20, 7))
            .form("(12.25 + 8 + 5 ⌈(8 · payload − 4 SF + 44)/4 SF⌉) 2^SF/BW (SX1276 data sheet)"),
        row("lora.sf12", "LoRa(spreading: 12)", 20, lora(20, 12))
            .form("(12.25 + 8 + 5 ⌈(8 · payload − 4 SF + 44)/4(SF − 2)⌉) 2^SF/BW (SX1276 data sheet)"),
        kilobot(),
    ];
    let radio = format!("technology: BleAdvertising(), {EQUAL_LOSS}");
    let load = "senders: Given([0]), when: Periodic(1.0), payload: 31";
    let setting = traffic(20.5, &pair(1.0), load, &radio);
    rows.push(
        Row::new(
            MODEL,
            "airtime.ble.event",
            (3.0 * (128.0 + 8.0 * 31.0), "µs"),
            setting,
            reading::time_on_air(US),
        )
        .exact()
        .form("128 + 8 · payload µs on each of three channels (Bluetooth LE 1M)"),
    );
    rows
}

fn kilobot() -> Row {
    let load = "senders: Given([0]), to: Next, when: Periodic(2.0), payload: 9";
    let place = "arena: (size: (1.0, 1.0)),\n    motion: (body_radius: 0.0165, max_speed: 0.01),\n    swarm: (robots: 2, deploy: At([(0.0, 0.0), (0.05, 0.0)]))";
    let setting = traffic(20.0, place, load, "technology: Kilobot(), access: None");
    Row::new(MODEL, "airtime.kilobot", (4160.0, "µs"), setting, reading::latency(US))
        .exact()
        .form("130 bit times of 256 cycles at 8 MHz (the Kilobot's firmware)")
}
