//! Verdicts of a comparison in words and colours.

use crate::metrics::comparison::Verdict;

/// What is better, what is worse, and what shows no difference.
pub const BETTER: &str = "#009e73";
/// See [`BETTER`].
pub const WORSE: &str = "#d55e00";
/// See [`BETTER`].
pub const UNCLEAR: &str = "#8a8a8a";

/// The colour of a verdict.
pub fn colour(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Better => BETTER,
        Verdict::Worse => WORSE,
        Verdict::NoDetectableDifference | Verdict::CannotTell | Verdict::NotComparable => UNCLEAR,
    }
}

/// A verdict in words.
pub fn words(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Better => "better",
        Verdict::Worse => "worse",
        Verdict::NoDetectableDifference => "no detectable difference",
        Verdict::CannotTell => "cannot tell",
        Verdict::NotComparable => "not comparable",
    }
}
