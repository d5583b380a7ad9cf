//! What a scenario says about the radio.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{NonNegative, Positive, Probability};

/// The radio: range, channel, and what a frame carries beside its payload.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RadioConfig {
    /// Communication range C in metres: a robot hears transmissions from at most this far (paper table 1: 2 m).
    pub range: Positive,
    /// Which frames the channel drops.
    pub loss: LossConfig,
    /// How long a frame takes from transmission to arrival, drawn for each reception on its own.
    pub latency: LatencyConfig,
    /// Bytes that every frame carries beside its payload. 5: a 2-byte sender and a 3-byte message header.
    pub header_bytes: u16,
    /// Noise of the receiver's sense of where a sender is.
    pub sensing: SensingConfig,
}

impl Default for RadioConfig {
    fn default() -> Self {
        Self {
            range: Positive::new(2.0),
            loss: LossConfig::None,
            latency: LatencyConfig::Constant(NonNegative::new(0.1)),
            header_bytes: 5,
            sensing: SensingConfig::default(),
        }
    }
}

/// Loss of frames in the channel, for each receiver on its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum LossConfig {
    /// Every frame arrives.
    None,
    /// Each frame is lost with this probability, independently.
    Bernoulli(Probability),
    /// Bursts: each ordered pair of robots is a two-state chain that steps once a frame.
    GilbertElliott {
        /// Probability of going from good to bad at a frame.
        good_to_bad: Probability,
        /// Probability of going from bad to good at a frame; the mean burst is its inverse.
        bad_to_good: Probability,
        /// Loss probability in the good state.
        #[serde(default = "never")]
        good_loss: Probability,
        /// Loss probability in the bad state.
        #[serde(default = "always")]
        bad_loss: Probability,
    },
    /// Loss grows with distance d as `at_range` · (d / range)^`exponent`.
    Distance {
        /// Loss probability at the edge of the range.
        at_range: Probability,
        /// How sharply loss sets in towards the edge.
        exponent: Positive,
    },
}

fn never() -> Probability {
    Probability::new(0.0)
}

fn always() -> Probability {
    Probability::new(1.0)
}

/// Latency of a frame, in seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum LatencyConfig {
    /// Always the same.
    Constant(NonNegative),
    /// Uniform between two bounds.
    Uniform {
        /// Smallest latency.
        min: NonNegative,
        /// Largest latency, not below `min`.
        max: NonNegative,
    },
    /// Normal, drawn again until at least `min` (a truncated normal).
    Normal {
        /// Mean before truncation.
        mean: NonNegative,
        /// Standard deviation before truncation.
        std_dev: NonNegative,
        /// Smallest latency, at most `mean`.
        #[serde(default = "zero")]
        min: NonNegative,
    },
    /// Log-normal.
    LogNormal {
        /// Median.
        median: Positive,
        /// Standard deviation of the logarithm.
        sigma: NonNegative,
    },
    /// Gamma.
    Gamma {
        /// Shape.
        shape: Positive,
        /// Scale; the mean is shape · scale.
        scale: Positive,
    },
    /// Exponential.
    Exponential {
        /// Mean.
        mean: Positive,
    },
}

fn zero() -> NonNegative {
    NonNegative::new(0.0)
}

/// Noise of situated communication.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SensingConfig {
    /// Standard deviation of the sensed range, as a share of it.
    pub range_noise: NonNegative,
    /// Standard deviation of the sensed bearing, in degrees.
    pub bearing_noise: NonNegative,
}

impl Default for SensingConfig {
    fn default() -> Self {
        Self {
            range_noise: zero(),
            bearing_noise: zero(),
        }
    }
}
