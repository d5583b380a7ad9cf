//! The figures that have no place of their own in a summary.

use serde::{Deserialize, Serialize};

use super::quantity::Named;
use crate::metrics::figures::Registry;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::Unit;
use crate::statistics::Estimate;

/// A figure as the catalogue declares it, over all trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Listed {
    /// What reports call it.
    pub name: String,
    /// The estimate.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// How many values were cut off, and would have grown, had their trials gone on; absent where none was.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cut_off: Option<u64>,
    /// Its unit.
    pub unit: Unit,
}

impl Listed {
    /// Every figure of the general list that a trial of `records` has.
    pub(super) fn all(registry: &Registry, records: &[TrialRecord]) -> Named<Self> {
        let listed = registry.listed(records).into_iter();
        let known = listed.filter(|(_, estimate, _)| estimate.value.is_some());
        let named = known.map(|(figure, estimate, cut_off)| {
            let listed = Self {
                name: figure.name.clone(),
                estimate,
                cut_off: (cut_off > 0).then_some(cut_off),
                unit: figure.unit.clone(),
            };
            (figure.key.clone(), listed)
        });
        Named(named.collect())
    }
}
