//! Bluetooth Low Energy: advertising.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::phy::{Air, Phy, Supply};
use super::serial::Serial;
use crate::engine::Span;
use crate::quantity::{Finite, Positive};
use crate::radio::Modulation;

/// Bits a second of LE 1M.
const RATE: f64 = 1e6;
/// The preamble, which only sets the receiver's gain and clock: bytes.
const PREAMBLE_BYTES: u32 = 1;
/// Access address, PDU header, advertiser's address, check sum: bytes.
const OTHER_BYTES: u32 = 4 + 2 + 6 + 3;
/// Bytes of advertising data at most.
const MOST_BYTES: u32 = 31;
/// What sensitivity is defined by (Bluetooth 5, volume 6, part A, section 4.1): the share of bits that are wrong.
const SENSITIVITY_ERRORS: f64 = 1e-3;
/// Intervals between events that Bluetooth 5 allows, seconds (volume 6, part B, section 4.4.2.2.1).
const INTERVALS_S: [f64; 2] = [0.02, 10_485.759_375];

/// Bluetooth Low Energy at 1 Mb/s as robots advertise (ADV_NONCONN_IND): no connection, no carrier sense, no acknowledgement. Each frame is sent on three channels in turn.
///
/// On one channel a frame is on air for 128 + 8 · payload µs, and carries up to 31 bytes. Its noise follows from its sensitivity, which Bluetooth defines by one bit
/// in a thousand wrong: 10.94 dB below it.
///
/// It sends with 0 dBm, and survives what is 21 dB weaker (co-channel C/I, Bluetooth 5, volume 6, part A, section 4.2). It draws 5 mA sending and hearing and 2 µA asleep, at
/// 3 V, as is usual in data sheets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BleAdvertisingConfig {
    /// Time between two advertisements of a robot, seconds, 0.02 to 10 485; up to 10 ms more, drawn each time, keep robots from staying in step.
    pub interval: Positive,
    /// How long a robot listens on one of the three channels before it goes on to the next, seconds.
    pub scan_interval: Positive,
    /// Carrier, Hz. By default 2.426 GHz, the middle one of the three channels (38).
    pub frequency: Positive,
    /// The weakest signal of which one bit in a thousand is wrong, dBm. −95: usual in data sheets.
    pub sensitivity: Finite,
    /// The least ratio of signal to noise and interference at which a receiver locks on a frame, dB. 8: half of all access addresses, 32 bits, come
    /// through without an error.
    pub lock: Finite,
}

impl Default for BleAdvertisingConfig {
    fn default() -> Self {
        Self {
            interval: Positive::new(0.1),
            scan_interval: Positive::new(0.1),
            frequency: Positive::new(2.426e9),
            sensitivity: Finite::new(-95.0),
            lock: Finite::new(8.0),
        }
    }
}

impl BleAdvertisingConfig {
    /// The radio that it describes.
    pub(super) fn phy(&self) -> Phy {
        let modulation = Modulation::Gfsk;
        let serial = Serial {
            preamble: Span::from_secs(f64::from(8 * PREAMBLE_BYTES) / RATE),
            rate: RATE,
            modulation,
        };
        let sensitivity = self.sensitivity.get();
        Phy {
            frequency: self.frequency.get(),
            bandwidth: 1e6,
            transmit_power: 0.0,
            sensitivity,
            noise: sensitivity - modulation.required_snr_db(1, SENSITIVITY_ERRORS),
            assess: None,
            carrier: None,
            channels: 3,
            dwell: Span::from_secs(self.scan_interval.get()),
            lock: self.lock.get(),
            capture: Some(21.0),
            infrared: None,
            max_payload: MOST_BYTES,
            header_bytes: PREAMBLE_BYTES + OTHER_BYTES,
            supply: Supply::new(3.0, [0.005, 0.005, 0.005, 0.005, 2e-6]),
            air: Air::Serial {
                serial,
                overhead: OTHER_BYTES,
            },
            acknowledgement: None,
        }
    }

    /// What is wrong between fields that are each in range: the field, from here, and why.
    pub(super) fn problems(&self) -> Vec<(String, String)> {
        let [least, most] = INTERVALS_S;
        let interval = self.interval.get();
        if (least..=most).contains(&interval) {
            return Vec::new();
        }
        let message = format!("{interval} s between advertisements is out of range: expected {least} to {most} s");
        vec![("interval".to_owned(), message)]
    }
}
