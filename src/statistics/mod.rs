//! Estimates over trials, each with its 95 % interval.
//!
//! Every estimate is a number to which each trial adds something, to first order: its *term*. A mean is one, a ratio of sums, and
//! the mean of times of which some were cut off. The terms tell how sure the estimate is; what values the figure can take tells how
//! its interval is shaped ([`Estimator`]). How often the intervals hold the truth is simulated by the tests of `coverage`; the
//! table is docs/coverage.md.
//!
//! Reference figures in the tests come from numpy, scipy, R and lifelines; the calls stand beside them.

#[cfg(test)]
mod coverage;
mod difference;
mod epidemic;
mod estimator;
mod family;
mod interval;
mod median;
mod permutation;
mod ranks;
mod spread;
mod survival;
mod terms;
mod times;

pub use difference::difference;
pub use epidemic::SimpleEpidemic;
pub use estimator::{Estimator, mean, mean_value, proportion};
pub use family::{POWER, fewest_trials, holm, testable, trials_needed};
pub use median::median;
pub use permutation::{Part, Tested, least_of_pairs, paired_permutation, ratio_of_sums, sign_permutation};
pub use ranks::{cliffs_delta, cliffs_delta_estimate, least_of_groups, least_of_ranks, mann_whitney, wilcoxon};
pub use spread::{gini, quantile};
pub use survival::{Observation, Step, log_rank, median_survival, survival_curve};
pub use times::{Lasting, Times, pseudo_values, pseudo_values_in_a_row};

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal};

/// Probability that an interval leaves out on either side.
const TAIL: f64 = 0.025;

/// Trials from which the median has an interval that holds it with at least 95 %: of fewer, the outermost two do not.
const FEWEST_FOR_MEDIAN: usize = 6;

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

impl Estimate {
    /// The same, of a mean that cannot be above `longest` where there is one: nor is its interval.
    #[must_use]
    pub fn at_most(mut self, longest: Option<f64>) -> Self {
        self.ci95 = self.ci95.map(|end| Some(end?.min(longest.unwrap_or(f64::INFINITY))));
        self
    }
}

/// The standard normal quantile that leaves out [`TAIL`] above it, 1.96.
fn normal_quantile() -> f64 {
    Normal::standard().inverse_cdf(1.0 - TAIL)
}
