//! Which failure detector robots run, and its settings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engine::Span;
use crate::quantity::Positive;

/// The failure detector that robots run on each other's status.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum DetectorConfig {
    /// A neighbour not heard for this many seconds is declared inactive (paper section 4.3).
    Timeout(Positive),
}

impl Default for DetectorConfig {
    fn default() -> Self {
        Self::Timeout(Positive::new(4.0))
    }
}

impl DetectorConfig {
    /// The longest silence after which a neighbour that was trusted is suspected.
    #[must_use]
    pub fn longest_silence(&self) -> Span {
        let Self::Timeout(timeout) = self;
        Span::from_secs(timeout.get())
    }
}
