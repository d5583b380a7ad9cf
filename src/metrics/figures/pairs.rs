//! Pairs of robots, where a scenario asks for them: each measure as its mean over pairs.

use super::registry::Registry;
use crate::metrics::pairs::{MEASURES, PairRecord};
use crate::statistics::{Estimator, mean_value};

pub(super) fn declare(registry: &mut Registry) {
    for (place, measure) in MEASURES.iter().enumerate() {
        let value = move |pair: &PairRecord| pair.values.get(place).copied().flatten();
        registry
            .add_plain(
                &format!("pairs.{}", measure.key),
                measure.name,
                (measure.unit, measure.better, Estimator::Mean),
                move |record| mean_value(&record.pairs.iter().filter_map(value).collect::<Vec<f64>>()),
            )
            .list();
    }
}
