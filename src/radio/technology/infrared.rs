//! Communication by infrared light: who is near and in sight hears.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::phy::{Air, Infrared, Phy, Supply};
use super::waveform::{Section, Waveform};
use crate::engine::Span;
use crate::quantity::{Positive, Probability};
use crate::radio::Modulation;

/// Frequency of the light, Hz: 940 nm. For completeness; no formula uses it.
const LIGHT_HZ: f64 = 3.19e14;
/// Clock of a Kilobot, Hz.
const KILOBOT_HZ: f64 = 8e6;
/// Bytes of a Kilobot's frame: data, and their type with a check sum.
const KILOBOT_BYTES: [u32; 2] = [9, 3];
/// Bit times of a byte, start and stop bit included, and of what goes before the first byte.
const KILOBOT_BITS: [u32; 2] = [10, 10];
/// Bytes of data in an e-puck's frame.
const EPUCK_BYTES: u32 = 2;

/// Range and bearing as the simulator ARGoS has it: whoever is in range and in sight hears at once; frames neither take time nor meet, and a
/// robot hears any number of others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ArgosRabConfig {
    /// How far a robot is heard, metres. 3: the foot-bot's, the Khepera IV's and the eye-bot's in ARGoS.
    pub range: Positive,
    /// Bytes that a frame carries at most, 1 or more. 10: the foot-bot's in ARGoS.
    #[schemars(range(min = 1))]
    pub payload: u16,
    /// The chance that a receiver loses a frame, each on its own.
    pub drop: Probability,
}

impl Default for ArgosRabConfig {
    fn default() -> Self {
        Self {
            range: Positive::new(3.0),
            payload: 10,
            drop: Probability::new(0.0),
        }
    }
}

/// The e-puck's range-and-bearing board: infrared at 5 kb/s, two bytes a frame, and frames collide.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EPuckConfig {
    /// How far a robot is heard, metres. 0.8: as in ARGoS.
    pub range: Positive,
    /// Time that every frame is on air, seconds. 5 ms: 16 bits of data, 4 of a check sum, 2 at the end and about 3 at the beginning, 200 µs each, as the
    /// firmware has them.
    pub airtime: Positive,
    /// The chance that a receiver loses a frame that met no other, each on its own.
    pub drop: Probability,
}

impl Default for EPuckConfig {
    fn default() -> Self {
        Self {
            range: Positive::new(0.8),
            airtime: Positive::new(0.005),
            drop: Probability::new(0.0),
        }
    }
}

/// The Kilobot: infrared reflected off the ground, nine bytes a frame, and frames collide.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct KilobotConfig {
    /// How far a robot is heard, metres: 0.07 to 0.1, as the ground reflects.
    pub range: Positive,
    /// Cycles of its clock of 8 MHz that a bit takes, 1 or more. 256: every frame is on air for 4.16 ms. Later firmware has 269: 4.37 ms.
    #[schemars(range(min = 1))]
    pub bit_cycles: u16,
    /// The chance that a receiver loses a frame that met no other, each on its own.
    pub drop: Probability,
}

impl Default for KilobotConfig {
    fn default() -> Self {
        Self {
            range: Positive::new(0.1),
            bit_cycles: 256,
            drop: Probability::new(0.0),
        }
    }
}

impl ArgosRabConfig {
    /// The light that it describes.
    pub(super) fn phy(&self) -> Phy {
        let payload = u32::from(self.payload);
        phy(self.range, self.drop, [payload, 0], Span::ZERO)
    }

    /// What is wrong between fields that are each in range: the field, from here, and why.
    pub(super) fn problems(&self) -> Vec<(String, String)> {
        let empty = (self.payload == 0).then(|| {
            let message = "a frame carries no byte; expected 1 to 65535";
            ("payload".to_owned(), message.to_owned())
        });
        empty.into_iter().collect()
    }
}

impl EPuckConfig {
    /// The light that it describes.
    pub(super) fn phy(&self) -> Phy {
        let airtime = Span::from_secs(self.airtime.get());
        phy(self.range, self.drop, [EPUCK_BYTES, 0], airtime)
    }
}

impl KilobotConfig {
    /// The light that it describes.
    pub(super) fn phy(&self) -> Phy {
        let [bits_of_byte, before] = KILOBOT_BITS;
        let bits = before + KILOBOT_BYTES.iter().sum::<u32>() * bits_of_byte;
        let seconds = f64::from(bits * u32::from(self.bit_cycles)) / KILOBOT_HZ;
        phy(self.range, self.drop, KILOBOT_BYTES, Span::from_secs(seconds))
    }

    /// What is wrong between fields that are each in range: the field, from here, and why.
    pub(super) fn problems(&self) -> Vec<(String, String)> {
        let none = (self.bit_cycles == 0).then(|| {
            let message = "a bit takes no cycle; expected 1 to 65535, such as 256";
            ("bit_cycles".to_owned(), message.to_owned())
        });
        none.into_iter().collect()
    }
}

/// Light over `range` metres, frames of so many bytes of payload and beside it, all of which are on air for `airtime`. What such a board draws is not known.
fn phy(range: Positive, drop: Probability, [payload, beside]: [u32; 2], airtime: Span) -> Phy {
    Phy {
        frequency: LIGHT_HZ,
        bandwidth: 0.0,
        transmit_power: 0.0,
        sensitivity: f64::NEG_INFINITY,
        noise: f64::NEG_INFINITY,
        assess: None,
        carrier: None,
        channels: 1,
        dwell: Span::ZERO,
        lock: f64::NEG_INFINITY,
        capture: None,
        infrared: Some(Infrared {
            range_m: range.get(),
            drop: drop.get(),
        }),
        max_payload: payload,
        header_bytes: beside,
        supply: Supply::default(),
        air: Air::Fixed(Waveform::new([Section {
            airtime,
            bits: 8 * (payload + beside),
            modulation: Modulation::None,
        }])),
        acknowledgement: None,
    }
}
