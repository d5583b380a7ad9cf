//! What counts as the completion of a mission.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::NonNegative;

/// When a mission is complete. A mission asks for several things: that each target is held by a worker with all its links, or
/// that each rumour is known to all live robots. A trial ends when its mission is complete, and the first control step at which the rule was
/// met is its steps to completion. Where nobody is alive nothing is complete.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum CompletionConfig {
    /// All at one control step, whatever becomes of it afterwards: a success is not taken back, as the paper's authors have it.
    Reached,
    /// All at once, without a break for so many seconds.
    Held(NonNegative),
    /// Each target or rumour at some control step of its own, whatever becomes of it afterwards: targets may be visited one after
    /// another, where robots are too few to hold all at once.
    EachVisited,
}

impl Default for CompletionConfig {
    /// Held for 10 s.
    fn default() -> Self {
        Self::Held(NonNegative::new(10.0))
    }
}

impl CompletionConfig {
    /// How long everything must last without a break, seconds.
    #[must_use]
    pub const fn hold(self) -> f64 {
        match self {
            Self::Held(seconds) => seconds.get(),
            Self::Reached | Self::EachVisited => 0.0,
        }
    }
}
