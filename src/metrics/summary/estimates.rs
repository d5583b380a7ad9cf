//! The figures of the catalogue over trials, in the shapes of a summary.

use super::quantity::{Lasted, Measured};
use crate::metrics::figures::Estimated;
use crate::metrics::unit::SECONDS;
use crate::statistics::Estimate;

/// The figures of a protocol over the trials to be summarised: the ones that comparisons show.
pub(super) struct Figures<'a>(pub Vec<Estimated<'a>>);

impl Figures<'_> {
    fn find(&self, key: &str) -> Option<&Estimated<'_>> {
        self.0.iter().find(|estimated| estimated.figure.key == key)
    }

    /// Whether there is such a figure.
    pub fn has(&self, key: &str) -> bool {
        self.find(key).is_some()
    }

    pub fn estimate(&self, key: &str) -> Estimate {
        self.find(key).map(|found| found.estimate).unwrap_or_default()
    }

    pub fn measured(&self, key: &str, unit: &'static str) -> Measured {
        Measured {
            estimate: self.estimate(key),
            unit: unit.into(),
        }
    }

    pub fn lasted(&self, key: &str) -> Lasted {
        let found = self.find(key);
        Lasted {
            estimate: self.estimate(key),
            cut_off: found.map_or(0, |found| found.cut_off),
            restricted_to: found.and_then(|found| found.restricted_to),
            unit: SECONDS.into(),
        }
    }
}
