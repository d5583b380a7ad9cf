//! What a scenario says about what is measured.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::NonNegative;

/// What is measured and when a mission counts as complete.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MetricsConfig {
    /// Seconds between samples of connectivity and positions; 0 for no samples.
    pub sample_interval: NonNegative,
    /// Samples from one entry of the traffic's series to the next; 0 for no series.
    pub series_every: u32,
    /// How long every target must be held with its links before the mission counts as complete, in seconds; the run then ends.
    pub hold: NonNegative,
}

impl Default for MetricsConfig {
    fn default() -> Self {
        Self {
            sample_interval: NonNegative::new(1.0),
            series_every: 1,
            hold: NonNegative::new(10.0),
        }
    }
}
