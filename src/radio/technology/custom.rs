//! A radio of no standard, every number of which may be set.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::phy::{Air, Phy, Supply};
use super::serial::Serial;
use crate::engine::Span;
use crate::quantity::{Finite, NonNegative, Positive};
use crate::radio::Modulation;

/// A radio of no standard: bytes one after the other at one rate. By default it has neither noise nor bit errors, so that whatever is as strong as the sensitivity is heard, unless it
/// meets other frames: then it survives what is 3 dB weaker, as 802.15.4 does. It sends with 0 dBm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CustomConfig {
    /// Bits a second. `None`: frames take no time, but for the preamble, and meet no other.
    pub bit_rate: Option<Positive>,
    /// What comes before a frame's bytes, seconds. Its bits are not judged.
    pub preamble: NonNegative,
    /// Bytes on air beside the payload: headers and check sum.
    pub header_bytes: u16,
    /// Bytes that a frame carries at most, 1 or more.
    #[schemars(range(min = 1))]
    pub max_payload: u16,
    /// Bytes of an acknowledgement, headers included. `None`: it has none.
    pub acknowledgement_bytes: Option<u16>,
    /// Carrier, Hz.
    pub frequency: Positive,
    /// Noise bandwidth of the receiver, Hz.
    pub bandwidth: Positive,
    /// The weakest signal that is received, dBm.
    pub sensitivity: Finite,
    /// Noise in the receiver, its own included, dBm. `None`: there is none.
    pub noise: Option<Finite>,
    /// How bits are sent, as far as their errors go. `None`: no bit goes wrong.
    pub modulation: Modulation,
    /// Energy from which on a clear channel assessment finds the channel busy, dBm. `None`: nobody listens before sending.
    pub assess: Option<Finite>,
    /// The least ratio of signal to noise and interference at which a receiver locks on a frame, dB.
    pub lock: Finite,
    /// What it draws from its battery.
    pub supply: Supply,
}

impl Default for CustomConfig {
    fn default() -> Self {
        Self {
            bit_rate: Some(Positive::new(250e3)),
            preamble: NonNegative::new(0.0),
            header_bytes: 0,
            max_payload: u16::MAX,
            acknowledgement_bytes: None,
            frequency: Positive::new(2.44e9),
            bandwidth: Positive::new(2e6),
            sensitivity: Finite::new(-95.0),
            noise: None,
            modulation: Modulation::None,
            assess: None,
            lock: Finite::new(0.0),
            supply: Supply::default(),
        }
    }
}

impl CustomConfig {
    /// The radio that it describes.
    pub(super) fn phy(&self) -> Phy {
        let serial = Serial {
            preamble: Span::from_secs(self.preamble.get()),
            rate: self.bit_rate.map_or(f64::INFINITY, Positive::get),
            modulation: self.modulation,
        };
        let overhead = u32::from(self.header_bytes);
        Phy {
            frequency: self.frequency.get(),
            bandwidth: self.bandwidth.get(),
            transmit_power: 0.0,
            sensitivity: self.sensitivity.get(),
            noise: self.noise.map_or(f64::NEG_INFINITY, Finite::get),
            assess: self.assess.map(Finite::get),
            carrier: None,
            channels: 1,
            dwell: Span::ZERO,
            lock: self.lock.get(),
            capture: Some(3.0),
            infrared: None,
            max_payload: u32::from(self.max_payload),
            header_bytes: overhead,
            supply: self.supply,
            air: Air::Serial { serial, overhead },
            acknowledgement: self.acknowledgement_bytes.map(|bytes| serial.frame(u32::from(bytes))),
        }
    }

    /// What is wrong between fields that are each in range: the field, from here, and why.
    pub(super) fn problems(&self) -> Vec<(String, String)> {
        let empty = (self.max_payload == 0).then(|| {
            let message = "a frame carries no byte; expected 1 to 65535";
            ("max_payload".to_owned(), message.to_owned())
        });
        empty.into_iter().collect()
    }
}
