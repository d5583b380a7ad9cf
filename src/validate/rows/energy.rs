//! What radios draw from their batteries.

use super::{EQUAL_LOSS, Row, pair, traffic};
use crate::validate::forms::airtime::{dsss, ieee802154};
use crate::validate::reading;

const MODEL: &str = "energy";

/// States of a radio, as records have them.
const SEND: usize = 0;
const RECEIVE: usize = 1;
const LISTEN: usize = 2;
const TURN: usize = 3;

pub fn rows() -> Vec<Row> {
    let cc2420 = format!("technology: Ieee802154(), {EQUAL_LOSS}, access: Aloha()");
    let often = "senders: Given([0]), when: Periodic(0.01), payload: 20";
    let wifi = format!("technology: Wifi(standard: B, rate: Some(1e6)), {EQUAL_LOSS}");
    let [duty, heard] = [ieee802154(20), dsss(20, 1.0)].map(|micros| micros * 1e-6 / 0.01);
    vec![
        Row::new(
            MODEL,
            "energy.listener",
            (3.3 * 18.8, "mW"),
            traffic(10.0, &pair(1.0), "senders: Given([])", &cc2420),
            reading::draws(1, &[SEND, RECEIVE, LISTEN, TURN]),
        )
        .exact()
        .form("V · I: a CC2420 that hears nothing, 18.8 mA at 3.3 V (data sheet)"),
        Row::new(
            MODEL,
            "energy.sender",
            (3.3 * 17.4 * duty, "mW"),
            traffic(10.0, &pair(1.0), often, &cc2420),
            reading::draws(0, &[SEND]),
        )
        .form("V · I · T/10 ms for sending: a CC2420 that sends 1.184 ms in 10, 17.4 mA at 3.3 V"),
        Row::new(
            MODEL,
            "energy.receiver",
            (3.0 * 313.0 * heard, "mW"),
            traffic(10.0, &pair(1.0), often, &wifi),
            reading::draws(1, &[RECEIVE]),
        )
        .form("V · I · T/10 ms for receiving: Wi-Fi that hears 640 µs in 10 ms, 313 mA at 3 V"),
    ]
}
