//! The figures of the catalogue over trials, in the shapes of a summary.

use super::quantity::{Lasted, Measured};
use crate::metrics::figures::Registry;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::SECONDS;
use crate::statistics::{Estimate, Estimator};

/// The figures of a protocol over the trials to be summarised: the ones that comparisons show.
pub(super) struct Figures<'a> {
    pub registry: &'a Registry,
    pub records: &'a [TrialRecord],
}

impl Figures<'_> {
    pub fn estimate(&self, key: &str) -> Estimate {
        self.registry.estimate(key, self.records).0
    }

    pub fn measured(&self, key: &str, unit: &'static str) -> Measured {
        Measured {
            estimate: self.estimate(key),
            unit: unit.into(),
        }
    }

    pub fn lasted(&self, key: &str) -> Lasted {
        let (estimate, lasting) = self.registry.estimate(key, self.records);
        Lasted {
            estimate,
            cut_off: lasting.cut_off,
            restricted_to: lasting.restricted_to,
            unit: SECONDS.into(),
        }
    }
}

/// The mean of whole numbers over trials.
pub(super) fn mean_count(records: &[TrialRecord], count: impl Fn(&TrialRecord) -> f64) -> Estimate {
    Estimator::Count.estimate(&records.iter().map(|record| [count(record), 1.0]).collect::<Vec<_>>())
}
