//! What a scenario says about the shared radio.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::access::AccessConfig;
use super::jammer::NoiseConfig;
use crate::quantity::{Finite, NonNegative, Positive};
use crate::radio::disk_config::{SensingConfig, WallsConfig};
use crate::radio::propagation::{FadingConfig, PathLossConfig, ShadowingConfig};
use crate::radio::technology::{Phy, TechnologyConfig};

/// The shared radio: a technology, how signals spread, and how robots get at the medium. What is `None` is as the technology has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Shared")]
pub struct SharedConfig {
    /// What robots talk by.
    pub technology: TechnologyConfig,
    /// When a robot that has something to send does. `None`, spelt out: at once, on whatever there is; left out: as the technology has it.
    #[serde(default, deserialize_with = "spelt_out", skip_serializing_if = "Option::is_none")]
    pub access: Option<AccessConfig>,
    /// What robots send with, dBm.
    #[serde(default)]
    pub transmit_power: Option<Finite>,
    /// By how much robots differ in that, dB: standard deviation of a normal distribution, drawn once a trial for each.
    #[serde(default = "none")]
    pub transmit_power_spread: NonNegative,
    /// Gain of each antenna, sending and receiving, dB.
    #[serde(default = "no_gain")]
    pub antenna_gain: Finite,
    /// By how much robots differ in that, dB: standard deviation of a normal distribution, drawn once a trial for each.
    #[serde(default = "none")]
    pub antenna_gain_spread: NonNegative,
    /// How much weaker a signal becomes with distance.
    #[serde(default)]
    pub path_loss: PathLossConfig,
    /// What things in the way that are not modelled one by one add to that or take from it: slow changes from place to place.
    #[serde(default)]
    pub shadowing: Option<ShadowingConfig>,
    /// What paths of different lengths make of a signal: fast changes from place to place.
    #[serde(default)]
    pub fading: FadingConfig,
    /// What walls and obstacles of the arena do to signals: `Pass`, `Block`, or `Loss(dB)`. They stop light in any case.
    #[serde(default)]
    pub walls: WallsConfig,
    /// By how many dB a frame must be above all frames of the same technology together that overlap it at a receiver; `inf`: whatever overlaps is lost.
    /// `None`, spelt out: overlaps are noise like any other, and a receiver stays on the first frame that it noticed, as in ns-3.
    #[serde(default, skip_serializing_if = "CaptureConfig::is_own")]
    pub capture: CaptureConfig,
    /// How many frames a robot holds that are to be sent, the one being sent included, at least 1: another is lost.
    #[serde(default = "sixteen")]
    #[schemars(range(min = 1))]
    pub queue: u32,
    /// What else is on air.
    #[serde(default)]
    pub noise: Vec<NoiseConfig>,
    /// Bursts that reach a robot with less than its noise, or its sensitivity if that is less, less so many dB are left out there: they are not even interference.
    #[serde(default = "ten_decibels")]
    pub negligible: NonNegative,
    /// Bytes that every message in a frame carries beside its payload. `None`: one for its topic, if the protocol has more than one, and two for its length where
    /// frames carry several messages.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message_header_bytes: Option<u16>,
    /// Payload of the lone frame that decides who is in range: two robots are where it would come through half of the time, fading averaged out.
    #[serde(default = "twenty")]
    pub range_payload: u16,
    /// What the battery of each robot holds for its radio, joules: a robot whose battery is empty fails for good. `None`: more than it needs.
    #[serde(default)]
    pub battery: Option<Positive>,
    /// Noise of the receiver's sense of where a sender is.
    #[serde(default)]
    pub sensing: SensingConfig,
}

/// When a frame survives others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CaptureConfig {
    /// At the ratio of its technology.
    #[default]
    Own,
    /// As if they were noise.
    AsNoise,
    /// At so many dB above them all, from 0 on.
    Ratio(f64),
}

impl CaptureConfig {
    /// Whether it is the technology's.
    #[must_use]
    pub fn is_own(&self) -> bool {
        *self == Self::Own
    }
}

impl Serialize for CaptureConfig {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Ratio(ratio) => serializer.serialize_some(ratio),
            Self::Own | Self::AsNoise => serializer.serialize_none(),
        }
    }
}

impl<'de> Deserialize<'de> for CaptureConfig {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ratio = Option::<f64>::deserialize(deserializer)?;
        match ratio {
            None => Ok(Self::AsNoise),
            Some(ratio) if ratio >= 0.0 => Ok(Self::Ratio(ratio)),
            Some(ratio) => Err(serde::de::Error::custom(format!(
                "{ratio} is out of range: expected a ratio of at least 0 dB, inf, or None"
            ))),
        }
    }
}

impl JsonSchema for CaptureConfig {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Capture".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "null"], "minimum": 0.0 })
    }
}

/// Medium access that a scenario names: `None` is one.
pub(in crate::radio) fn spelt_out<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<AccessConfig>, D::Error> {
    let access = Option::<AccessConfig>::deserialize(deserializer)?;
    Ok(Some(access.unwrap_or(AccessConfig::None)))
}

fn none() -> NonNegative {
    NonNegative::new(0.0)
}

fn no_gain() -> Finite {
    Finite::new(0.0)
}

fn ten_decibels() -> NonNegative {
    NonNegative::new(10.0)
}

const fn sixteen() -> u32 {
    16
}

const fn twenty() -> u16 {
    20
}

impl SharedConfig {
    /// The shared radio with all defaults.
    #[must_use]
    pub fn of(technology: TechnologyConfig) -> Self {
        Self {
            technology,
            access: None,
            transmit_power: None,
            transmit_power_spread: none(),
            antenna_gain: no_gain(),
            antenna_gain_spread: none(),
            path_loss: PathLossConfig::default(),
            shadowing: None,
            fading: FadingConfig::default(),
            walls: WallsConfig::Pass,
            capture: CaptureConfig::Own,
            queue: sixteen(),
            noise: Vec::new(),
            negligible: ten_decibels(),
            message_header_bytes: None,
            range_payload: twenty(),
            battery: None,
            sensing: SensingConfig::default(),
        }
    }

    /// How robots get at the medium.
    #[must_use]
    pub fn access(&self) -> AccessConfig {
        self.access
            .clone()
            .unwrap_or_else(|| AccessConfig::of(&self.technology))
    }

    /// Bytes that each frame carries beside its messages, and each message beside its payload.
    #[must_use]
    pub fn headers(&self, topics: usize, several: bool) -> [u16; 2] {
        let message = self
            .message_header_bytes
            .unwrap_or_else(|| u16::from(topics > 1) + 2 * u16::from(several));
        [self.phy().header_bytes as u16, message]
    }

    /// The radio that each robot has.
    ///
    /// # Panics
    /// If it has [`problems`](Self::problems).
    #[must_use]
    pub fn phy(&self) -> Phy {
        let mut phy = self.technology.phy();
        if let Some(power) = self.transmit_power {
            phy.transmit_power = power.get();
        }
        phy.capture = match self.capture {
            // Light that meets light cannot be told apart.
            CaptureConfig::Own if phy.infrared.is_some() => Some(f64::INFINITY),
            CaptureConfig::Own => phy.capture,
            CaptureConfig::AsNoise => None,
            CaptureConfig::Ratio(ratio) => Some(ratio),
        };
        phy
    }

    /// What is wrong between fields that are each in range, for so many robots whose clocks are fast or slow by up to a share of `drift`: the path of the field at fault, from this section on, and what is wrong with it and would
    /// be right.
    #[must_use]
    pub fn problems(&self, robots: u32, drift: f64) -> Vec<(String, String)> {
        let within = |section: &str, problems: Vec<(String, String)>| {
            let path = |(field, message): (String, String)| (format!("{section}.{field}"), message);
            problems.into_iter().map(path).collect::<Vec<_>>()
        };
        let mut found = within("technology", self.technology.problems());
        found.extend(within("path_loss", self.path_loss.problems()));
        found.extend(within("fading", self.fading.problems()));
        if let Some(access) = &self.access {
            found.extend(within("access", access.problems(robots)));
        }
        if self.queue == 0 {
            let message = "a queue of 0 frames sends nothing; expected at least 1";
            found.push(("queue".to_owned(), message.to_owned()));
        }
        if found.is_empty() {
            found.extend(self.misfits(drift));
        }
        found
    }

    /// What of it does not fit together: frames that never fit a slot.
    fn misfits(&self, drift: f64) -> Vec<(String, String)> {
        let phy = self.phy();
        let shortest = phy.airtime(0).as_secs();
        let (slot, guard) = match self.access() {
            AccessConfig::SlottedAloha { slot, .. } => (slot.get(), 0.0),
            AccessConfig::Tdma {
                slot, guard, resync, ..
            } => (slot.get(), guard.map_or(2.0 * drift * resync.get(), NonNegative::get)),
            _ => return Vec::new(),
        };
        if slot - guard >= shortest {
            return Vec::new();
        }
        let message = format!(
            "even a frame without payload is on air for {shortest} s, and does not fit a slot of {slot} s less a guard of {guard} s; make the slot longer"
        );
        vec![("access.slot".to_owned(), message)]
    }
}
