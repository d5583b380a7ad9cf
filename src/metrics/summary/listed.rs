//! The figures that have no place of their own in a summary.

use serde::{Deserialize, Serialize};

use super::estimates::Figures;
use super::quantity::Named;
use crate::metrics::figures::Estimated;
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
    /// Every figure of the general list that a trial has.
    pub(super) fn all(figures: &Figures) -> Named<Self> {
        let known = |found: &&Estimated| found.is_listed && found.estimate.value.is_some();
        let named = figures.0.iter().filter(known).map(|found| {
            let listed = Self {
                name: found.figure.name.clone(),
                estimate: found.estimate,
                cut_off: (found.cut_off > 0).then_some(found.cut_off),
                unit: found.figure.unit.clone(),
            };
            (found.figure.key.clone(), listed)
        });
        Named(named.collect())
    }
}
