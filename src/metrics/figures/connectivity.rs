//! Connectivity of the live robots, at the samples of a trial.

use super::figure::Better;
use super::registry::Registry;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::DIMENSIONLESS;
use crate::statistics::{Estimator, mean_value};

pub(super) fn declare(registry: &mut Registry) {
    let share = (DIMENSIONLESS, Better::Higher, Estimator::Share);
    let lambda2 = (DIMENSIONLESS, Better::Higher, Estimator::Median);
    registry.add_plain("lambda2_min", "least λ₂", lambda2, TrialRecord::lambda2_min);
    registry.add_plain(
        "connected_share",
        "time in one piece",
        share,
        TrialRecord::connected_share,
    );
    let robots = ("robots", Better::Higher, Estimator::Mean);
    registry
        .add_plain("neighbours", "live robots in range of a live robot", robots, neighbours)
        .list();
}

/// How many live robots a live robot has in range: mean over the robots of a sample, then over the samples that find any alive; `None` if none does.
fn neighbours(record: &TrialRecord) -> Option<f64> {
    let samples = record.connectivity.iter().filter(|sample| sample.components > 0);
    let seen: Vec<f64> = samples.map(|sample| sample.neighbours).collect();
    mean_value(&seen)
}
