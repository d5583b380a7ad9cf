//! What a scenario says of path loss.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::line::Line;
use crate::quantity::{Finite, Positive};

/// How much is lost over distance. Losses are never below 0 dB.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum PathLossConfig {
    /// Free space: 20 log₁₀(4πd/λ) dB.
    Friis,
    /// A straight line over the logarithm of distance.
    LogDistance(LogDistanceConfig),
    /// Two straight lines, the farther one steeper.
    BreakPoint(BreakPointConfig),
    /// Antennas near flat ground, which reflects.
    TwoRay(TwoRayConfig),
}

/// `reference_loss` + 10 · `exponent` · log₁₀(d/`reference_distance`) dB.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LogDistanceConfig {
    /// How steep it is: 2 in free space, 3 as in ns-3, up to 4 where much is in the way.
    pub exponent: Positive,
    /// Distance of the loss that is known, metres.
    pub reference_distance: Positive,
    /// Loss at that distance, dB. `None`: that of free space at the carrier's frequency, 40.2 dB for 1 m at 2.44 GHz.
    pub reference_loss: Option<Finite>,
}

/// As [`LogDistance`](PathLossConfig::LogDistance) up to a distance, and steeper from there on, without a step: by default as IEEE 802.15.4, Annex E, has it. (That states 58.5 dB at 8 m for the line beyond, 0.24 more than the
/// line before has there.)
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BreakPointConfig {
    /// How steep it is at first.
    pub exponent: Positive,
    /// Distance from which on it is steeper, metres.
    pub distance: Positive,
    /// How steep it is from there on.
    pub exponent_beyond: Positive,
    /// Distance of the loss that is known, on the first line, metres.
    pub reference_distance: Positive,
    /// Loss at that distance, dB. `None`: that of free space at the carrier's frequency.
    pub reference_loss: Option<Finite>,
}

/// Two antennas at the same height above flat ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TwoRayConfig {
    /// Height of the antennas, metres.
    pub height: Positive,
    /// Relative permittivity of the ground, above 1, such as 15; antennas are vertical. `None`: free space up to the distance 4πh²/λ, 1 m for 0.1 m at 2.4 GHz, and 40 log₁₀ d − 40 log₁₀ h dB beyond, as for
    /// ground that reflects all.
    pub ground: Option<Positive>,
}

impl Default for PathLossConfig {
    fn default() -> Self {
        Self::LogDistance(LogDistanceConfig::default())
    }
}

impl Default for LogDistanceConfig {
    fn default() -> Self {
        Self {
            exponent: Positive::new(3.0),
            reference_distance: Positive::new(1.0),
            reference_loss: None,
        }
    }
}

impl Default for BreakPointConfig {
    fn default() -> Self {
        Self {
            exponent: Positive::new(2.0),
            distance: Positive::new(8.0),
            exponent_beyond: Positive::new(3.3),
            reference_distance: Positive::new(1.0),
            reference_loss: None,
        }
    }
}

impl Default for TwoRayConfig {
    fn default() -> Self {
        Self {
            height: Positive::new(0.1),
            ground: None,
        }
    }
}

impl PathLossConfig {
    /// What is wrong between fields that are each in range: the field, from here, variants left out, and why, with what would be right.
    #[must_use]
    pub fn problems(&self) -> Vec<(String, String)> {
        match self {
            Self::TwoRay(TwoRayConfig {
                ground: Some(permittivity),
                ..
            }) if permittivity.get() <= 1.0 => {
                let message = format!(
                    "ground of relative permittivity {} reflects nothing: expected above 1, such as 15, or Friis",
                    permittivity.get()
                );
                vec![("ground".to_owned(), message)]
            }
            _ => Vec::new(),
        }
    }
}

impl LogDistanceConfig {
    pub(super) fn line(&self, wavelength: f64) -> Line {
        line(self.exponent, self.reference_distance, self.reference_loss, wavelength)
    }
}

impl BreakPointConfig {
    /// The line before the distance at which it turns.
    pub(super) fn near(&self, wavelength: f64) -> Line {
        line(self.exponent, self.reference_distance, self.reference_loss, wavelength)
    }
}

fn line(exponent: Positive, distance: Positive, loss: Option<Finite>, wavelength: f64) -> Line {
    let distance = distance.get();
    Line {
        distance,
        loss: loss.map_or_else(|| Line::friis(wavelength).loss(distance), Finite::get),
        exponent: exponent.get(),
    }
}
