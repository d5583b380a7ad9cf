//! What a scenario says about the radio: a disk, or a technology on a shared medium.
//!
//! Which of the two it is follows from the fields: a radio with a `technology` is shared. Both are written `radio: (...)`, and a shared one
//! may be called by its name, `radio: Shared(...)`.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value};

use super::disk_config::{DiskConfig, LatencyConfig, LossConfig, SensingConfig, WallsConfig};
use super::propagation::{FadingConfig, PathLossConfig, ShadowingConfig};
use super::shared::{AccessConfig, CaptureConfig, NoiseConfig, SharedConfig, spelt_out};
use super::technology::TechnologyConfig;
use crate::quantity::{Finite, NonNegative, Positive};

/// The radio of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub enum RadioConfig {
    /// Whoever is near enough hears, but for what a channel drops; frames take no time on air.
    Disk(DiskConfig),
    /// Frames take time on air, and everybody is on the same air.
    Shared(Box<SharedConfig>),
}

impl Default for RadioConfig {
    fn default() -> Self {
        Self::Disk(DiskConfig::default())
    }
}

impl From<DiskConfig> for RadioConfig {
    fn from(config: DiskConfig) -> Self {
        Self::Disk(config)
    }
}

impl From<SharedConfig> for RadioConfig {
    fn from(config: SharedConfig) -> Self {
        Self::Shared(Box::new(config))
    }
}

impl RadioConfig {
    /// The disk radio; or the one that is most like a shared radio, for estimates and for what must be said before a run: its range is that of a lone
    /// frame without shadowing and walls, nothing is lost within it, and a frame takes as long as it is on air and medium access takes at least.
    #[must_use]
    pub fn disk(&self) -> Cow<'_, DiskConfig> {
        match self {
            Self::Disk(config) => Cow::Borrowed(config),
            Self::Shared(config) => Cow::Owned(config.like_disk()),
        }
    }

    /// The shared radio, if it is one.
    #[must_use]
    pub fn shared(&self) -> Option<&SharedConfig> {
        match self {
            Self::Disk(_) => None,
            Self::Shared(config) => Some(config),
        }
    }

    /// Whether frames take time on air.
    #[must_use]
    pub fn takes_time(&self) -> bool {
        self.shared().is_some_and(SharedConfig::takes_time)
    }

    /// Bytes that each frame carries beside its messages, and each message beside its payload, of a protocol with so many topics, whose frames carry one message each or
    /// several.
    #[must_use]
    pub fn header_bytes(&self, topics: usize, several: bool) -> [u16; 2] {
        match self {
            Self::Disk(config) => [config.frame_header_bytes, config.message_header_bytes],
            Self::Shared(config) => config.headers(topics, several),
        }
    }

    /// The longest payload of a message that a frame can carry, in bytes, for a protocol with so many topics, whose frames carry one message each or several. `None`:
    /// any.
    #[must_use]
    pub fn longest_message(&self, topics: usize, several: bool) -> Option<u32> {
        let shared = self.shared()?;
        let [_, header] = shared.headers(topics, several);
        Some(shared.phy().max_payload.saturating_sub(header.into()))
    }

    /// How many frames with so much payload a robot can put on air in a second that has it for itself, roughly; over a disk, where they take no time, none is
    /// counted.
    #[must_use]
    pub fn most_frames_a_second(&self, payload: u32) -> f64 {
        self.shared().map_or(0.0, |shared| shared.most_frames_a_second(payload))
    }

    /// What is wrong between fields that are each in range, for a swarm of so many robots whose clocks are fast or slow by up to a share of `drift`: the path of the field at fault, from this section on, and
    /// what is wrong with it and would be right. Empty if the radio can be built.
    #[must_use]
    pub fn problems(&self, robots: u32, drift: f64) -> Vec<(String, String)> {
        match self {
            Self::Disk(config) => config.problems(),
            Self::Shared(config) => config.problems(robots, drift),
        }
    }
}

/// The fields of both.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename = "Shared")]
struct Fields {
    range: Option<Positive>,
    loss: Option<LossConfig>,
    latency: Option<LatencyConfig>,
    frame_header_bytes: Option<u16>,
    message_header_bytes: Option<u16>,
    sensing: Option<SensingConfig>,
    walls: Option<WallsConfig>,
    technology: Option<TechnologyConfig>,
    #[serde(deserialize_with = "spelt_out")]
    access: Option<AccessConfig>,
    transmit_power: Option<Finite>,
    transmit_power_spread: Option<NonNegative>,
    antenna_gain: Option<Finite>,
    antenna_gain_spread: Option<NonNegative>,
    path_loss: Option<PathLossConfig>,
    shadowing: Option<ShadowingConfig>,
    fading: Option<FadingConfig>,
    capture: CaptureConfig,
    queue: Option<u32>,
    noise: Option<Vec<NoiseConfig>>,
    negligible: Option<NonNegative>,
    range_payload: Option<u16>,
    battery: Option<Positive>,
}

impl Fields {
    /// Those of the present fields that only the other radio has.
    fn strangers(&self) -> Vec<&'static str> {
        let disk = [
            ("range", self.range.is_some()),
            ("loss", self.loss.is_some()),
            ("latency", self.latency.is_some()),
            ("frame_header_bytes", self.frame_header_bytes.is_some()),
        ];
        let shared = [
            ("access", self.access.is_some()),
            ("transmit_power", self.transmit_power.is_some()),
            ("transmit_power_spread", self.transmit_power_spread.is_some()),
            ("antenna_gain", self.antenna_gain.is_some()),
            ("antenna_gain_spread", self.antenna_gain_spread.is_some()),
            ("path_loss", self.path_loss.is_some()),
            ("shadowing", self.shadowing.is_some()),
            ("fading", self.fading.is_some()),
            ("capture", !self.capture.is_own()),
            ("queue", self.queue.is_some()),
            ("noise", self.noise.is_some()),
            ("negligible", self.negligible.is_some()),
            ("range_payload", self.range_payload.is_some()),
            ("battery", self.battery.is_some()),
        ];
        let strange: &[_] = if self.technology.is_some() { &disk } else { &shared };
        strange.iter().filter(|field| field.1).map(|field| field.0).collect()
    }

    fn shared(self, technology: TechnologyConfig) -> SharedConfig {
        let own = SharedConfig::of(technology);
        SharedConfig {
            access: self.access,
            transmit_power: self.transmit_power,
            transmit_power_spread: self.transmit_power_spread.unwrap_or(own.transmit_power_spread),
            antenna_gain: self.antenna_gain.unwrap_or(own.antenna_gain),
            antenna_gain_spread: self.antenna_gain_spread.unwrap_or(own.antenna_gain_spread),
            path_loss: self.path_loss.unwrap_or(own.path_loss),
            shadowing: self.shadowing,
            fading: self.fading.unwrap_or(own.fading),
            walls: self.walls.unwrap_or(own.walls),
            capture: self.capture,
            queue: self.queue.unwrap_or(own.queue),
            noise: self.noise.unwrap_or(own.noise),
            negligible: self.negligible.unwrap_or(own.negligible),
            message_header_bytes: self.message_header_bytes,
            range_payload: self.range_payload.unwrap_or(own.range_payload),
            battery: self.battery,
            sensing: self.sensing.unwrap_or(own.sensing),
            technology: own.technology,
        }
    }

    fn disk(self) -> DiskConfig {
        let own = DiskConfig::default();
        DiskConfig {
            range: self.range.unwrap_or(own.range),
            loss: self.loss.unwrap_or(own.loss),
            latency: self.latency.unwrap_or(own.latency),
            frame_header_bytes: self.frame_header_bytes.unwrap_or(own.frame_header_bytes),
            message_header_bytes: self.message_header_bytes.unwrap_or(own.message_header_bytes),
            sensing: self.sensing.unwrap_or(own.sensing),
            walls: self.walls.unwrap_or(own.walls),
        }
    }
}

impl<'de> Deserialize<'de> for RadioConfig {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut fields = Fields::deserialize(deserializer)?;
        if let Some(field) = fields.strangers().first() {
            let message = if fields.technology.is_some() {
                format!("`{field}` is for the disk radio, and this one has a `technology`: leave out one of them")
            } else {
                format!("`{field}` is for a radio with a `technology`, such as Ieee802154(): add one, or leave it out")
            };
            return Err(serde::de::Error::custom(message));
        }
        Ok(match fields.technology.take() {
            Some(technology) => fields.shared(technology).into(),
            None => fields.disk().into(),
        })
    }
}

impl Serialize for RadioConfig {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Disk(config) => config.serialize(serializer),
            Self::Shared(config) => config.serialize(serializer),
        }
    }
}

impl JsonSchema for RadioConfig {
    fn schema_name() -> Cow<'static, str> {
        "RadioConfig".into()
    }

    /// The fields of both, in one object, of which either those of the one or of the other may stand.
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let [disk, shared] = [DiskConfig::json_schema(generator), SharedConfig::json_schema(generator)].map(|schema| {
            schema
                .get("properties")
                .and_then(Value::as_object)
                .cloned()
                .unwrap_or_default()
        });
        let without = |mine: &Map<String, Value>, others: &Map<String, Value>| {
            let refused = others.keys().filter(|field| !mine.contains_key(*field));
            refused
                .map(|field| (field.clone(), Value::Bool(false)))
                .collect::<Map<_, _>>()
        };
        let (no_shared, no_disk) = (without(&disk, &shared), without(&shared, &disk));
        let mut properties = disk;
        for (field, shape) in shared {
            properties.entry(field).or_insert(shape);
        }
        json_schema!({
            "description": "The radio: a disk (`range`, `loss`, `latency`), or a `technology` on a shared medium (`Shared(technology: ...)`).",
            "type": "object",
            "properties": properties,
            "additionalProperties": false,
            "anyOf": [
                { "properties": no_shared },
                { "required": ["technology"], "properties": no_disk },
            ],
        })
    }
}
