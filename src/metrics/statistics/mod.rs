//! Estimates over trials, each with its 95 % interval.
//!
//! Reference figures in the tests come from numpy, scipy and lifelines; the calls stand beside them.

mod bootstrap;
mod family;
mod location;
mod permutation;
mod ranks;
mod spread;
mod survival;

pub use bootstrap::Resamples;
pub use family::{POWER, fewest_trials, holm, testable, trials_needed};
pub use location::{mean, median, proportion, ratio, share};
pub use permutation::{Part, Tested, least_of_pairs, paired_permutation, ratio_of_sums, sign_permutation};
pub use ranks::{cliffs_delta, least_of_groups, least_of_ranks, mann_whitney, wilcoxon};
pub use spread::{gini, quantile};
pub use survival::{Observation, Step, log_rank, median_survival, survival_curve};

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal};

/// Probability that an interval leaves out on either side.
const TAIL: f64 = 0.025;

/// Lower and upper end of a 95 % interval, each absent where the trials cannot tell it.
pub type Ci95 = [Option<f64>; 2];

/// An estimate from a number of trials. What the trials cannot tell is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The point estimate.
    pub value: Option<f64>,
    /// Lower and upper end of the 95 % interval.
    pub ci95: Ci95,
    /// Number of trials.
    pub n: u64,
}

/// The standard normal quantile that leaves out [`TAIL`] above it, 1.96.
fn normal_quantile() -> f64 {
    Normal::standard().inverse_cdf(1.0 - TAIL)
}
