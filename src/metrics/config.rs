//! What a scenario says about what is measured.

use std::collections::BTreeSet;

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
    /// Whether to keep what passed between every two robots, for `pairs.parquet` and the figures `pairs.…`. It costs time and memory.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub pairs: bool,
    /// Whether to keep what became of copies on every link, for `links.parquet`, over a radio on which frames take time. It costs memory.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub links: bool,
    /// Tables that are written only where they are asked for, such as `[Delivery, Hops]`. Each costs time, and room in the results.
    #[serde(skip_serializing_if = "BTreeSet::is_empty")]
    pub record: BTreeSet<AskedTable>,
    /// The older way to say `completion: Held(seconds)`, which belongs to the protocol.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "NonNegative")]
    pub hold: Option<NonNegative>,
}

/// A table that is written only where a scenario asks for it. Each is called as its file is: `Hops` is `hops.parquet`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub enum AskedTable {
    /// What became of copies, by topic and by how far sender and receiver were apart.
    Delivery,
    /// How long copies took, by topic, over time: from one entry of the traffic's series to the next.
    Delays,
    /// How many robots each robot has in range, at each sample.
    Degree,
    /// When each robot came to know each rumour, from whom, and over how many transmissions; of protocols whose robots note it.
    Hops,
    /// What each robot sent and received, by topic, over time: from one entry of the traffic's series to the next.
    Traffic,
    /// Which role each robot started in, and every change of it.
    Roles,
}

impl Default for MetricsConfig {
    fn default() -> Self {
        Self {
            sample_interval: NonNegative::new(1.0),
            series_every: 1,
            pairs: false,
            links: false,
            record: BTreeSet::new(),
            hold: None,
        }
    }
}
