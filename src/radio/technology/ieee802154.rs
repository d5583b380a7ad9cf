//! IEEE 802.15.4 at 2.4 GHz, by default with the figures of a CC2420.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::phy::{Air, Phy, Supply};
use super::serial::Serial;
use crate::engine::Span;
use crate::quantity::{Finite, NonNegative, Positive};
use crate::radio::Modulation;

/// Bits a second (IEEE 802.15.4-2011, clause 10.2).
const RATE: f64 = 250e3;
/// Preamble, start of the frame, and length: bytes.
const PHY_BYTES: u32 = 4 + 1 + 1;
/// Frame control, sequence number, one PAN's number, two short addresses: bytes.
const MAC_BYTES: u32 = 2 + 1 + 2 + 2 + 2;
/// Check sum, bytes.
const CHECK_BYTES: u32 = 2;
/// Bytes of an acknowledgement, without the PHY's.
const ACKNOWLEDGEMENT_BYTES: u32 = 5;
/// Bytes behind the PHY header at most (aMaxPHYPacketSize).
const MOST_BYTES: u32 = 127;
/// What sensitivity is defined by (clause 8.1.7): so many bytes behind the PHY header, lost so often.
const SENSITIVITY_BYTES: u32 = 20;
const SENSITIVITY_LOSS: f64 = 0.01;

/// An IEEE 802.15.4 radio at 2.4 GHz: O-QPSK, 250 kb/s, frames of up to 127 bytes, of which 11 are headers and check sum (short addresses, one PAN).
///
/// A frame is on air for (6 + 11 + payload) · 32 µs, an acknowledgement for 352 µs. All of its bits are judged. Its noise follows from its sensitivity, which the standard
/// defines by one frame in a hundred of 20 bytes lost: 0.509 dB below it.
///
/// It sends with 0 dBm, and its co-channel rejection is 3 dB (CC2420 data sheet). It draws 17.4 mA sending, 18.8 mA hearing and 0.426 mA idle, at 3.3 V (CC2420, as
/// Castalia has them).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Ieee802154Config {
    /// Carrier, Hz. By default 2.44 GHz, channel 18.
    pub frequency: Positive,
    /// The weakest signal of which 99 frames of 20 bytes in a hundred arrive, dBm. −95: CC2420 data sheet, typical. INET has −100.
    pub sensitivity: Finite,
    /// By how many dB above the sensitivity the energy must be that a clear channel assessment takes for a busy channel. 10: the most that the standard
    /// allows (clause 8.2.7).
    pub assess: NonNegative,
    /// The least ratio of signal to noise and interference at which a receiver locks on a frame, dB. −5: as ns-3 has it.
    pub lock: Finite,
}

impl Default for Ieee802154Config {
    fn default() -> Self {
        Self {
            frequency: Positive::new(2.44e9),
            sensitivity: Finite::new(-95.0),
            assess: NonNegative::new(10.0),
            lock: Finite::new(-5.0),
        }
    }
}

impl Ieee802154Config {
    /// The radio that it describes.
    pub(super) fn phy(&self) -> Phy {
        let modulation = Modulation::OQpsk;
        let serial = Serial {
            preamble: Span::ZERO,
            rate: RATE,
            modulation,
        };
        let required = modulation.required_snr_db(8 * (PHY_BYTES + SENSITIVITY_BYTES), SENSITIVITY_LOSS);
        let sensitivity = self.sensitivity.get();
        let header_bytes = PHY_BYTES + MAC_BYTES + CHECK_BYTES;
        Phy {
            frequency: self.frequency.get(),
            bandwidth: 2e6,
            transmit_power: 0.0,
            sensitivity,
            noise: sensitivity - required,
            assess: Some(sensitivity + self.assess.get()),
            carrier: None,
            channels: 1,
            dwell: Span::ZERO,
            lock: self.lock.get(),
            capture: Some(3.0),
            infrared: None,
            max_payload: MOST_BYTES - MAC_BYTES - CHECK_BYTES,
            header_bytes,
            supply: Supply::new(3.3, [0.0174, 0.0188, 0.0188, 0.0188, 0.000_426]),
            air: Air::Serial {
                serial,
                overhead: header_bytes,
            },
            acknowledgement: Some(serial.frame(PHY_BYTES + ACKNOWLEDGEMENT_BYTES)),
        }
    }
}
