//! The failure-tolerant connectivity backbone (paper section 4).

mod config;

pub use config::{BackboneConfig, TargetConfig, TargetsConfig};
