//! What to make of a difference.

use serde::{Deserialize, Serialize};

/// What to make of a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The setting is better than the other.
    Better,
    /// It is worse.
    Worse,
    /// The trials show no difference, which does not mean that there is none.
    NoDetectableDifference,
    /// So few trials, or so few that differ, cannot show a difference, however large.
    CannotTell,
    /// One of the two has no value of the figure.
    NotComparable,
}
