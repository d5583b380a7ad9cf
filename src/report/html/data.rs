//! From records to the points of charts.

use std::collections::BTreeMap;

use crate::engine::SimTime;
use crate::metrics::TrialRecord;
use crate::metrics::statistics::quantile;

/// Points that a line is made of at most.
const MOST_POINTS: usize = 300;

/// How values spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// How many.
    pub n: u64,
    /// The least.
    pub min: f64,
    /// Quantiles at 5, 25, 50, 75 and 95 %, of type 7.
    pub quantiles: [f64; 5],
    /// The greatest.
    pub max: f64,
    /// Their mean.
    pub mean: f64,
}

impl Spread {
    /// Of `values`; `None` if there are none.
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let [min, max] = [*values.first()?, *values.last()?];
        let at = |q| quantile(&values, q).unwrap_or(min);
        Some(Self {
            n: values.len() as u64,
            min,
            quantiles: [0.05, 0.25, 0.5, 0.75, 0.95].map(at),
            max,
            mean: values.iter().sum::<f64>() / values.len() as f64,
        })
    }

    /// The median.
    pub fn median(&self) -> f64 {
        self.quantiles[2]
    }
}

/// The quantiles of `values` as an ascending curve: every value if they are few, else quantiles that are evenly apart.
/// Each point is a value and the share of values that are no greater.
pub fn ecdf(mut values: Vec<f64>) -> Vec<[f64; 2]> {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    if n <= MOST_POINTS {
        return (1..)
            .zip(values)
            .map(|(rank, value)| [value, f64::from(rank) / n as f64])
            .collect();
    }
    (0..=MOST_POINTS)
        .map(|point| {
            let rank = (point * n).div_ceil(MOST_POINTS).max(1);
            [values[rank - 1], rank as f64 / n as f64]
        })
        .collect()
}

/// What was sampled at one time, or in one stretch of times, over trials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// When; the end of the stretch, s.
    pub time_s: f64,
    /// Trials that were still running.
    pub trials: u64,
    /// The samples of all of them.
    pub spread: Spread,
}

/// A figure over time, over all trials. If there are more samples than a line can show, those of a stretch of time go
/// together, so that no dip is lost.
pub fn over_time<I: IntoIterator<Item = (SimTime, f64)>>(
    records: &[TrialRecord],
    samples: impl Fn(&TrialRecord) -> I,
) -> Vec<Moment> {
    let mut by_time: BTreeMap<SimTime, Vec<f64>> = BTreeMap::new();
    for record in records {
        for (at, value) in samples(record) {
            by_time.entry(at).or_default().push(value);
        }
    }
    let stretch = by_time.len().div_ceil(MOST_POINTS).max(1);
    let times: Vec<_> = by_time.into_iter().collect();
    let moments = times.chunks(stretch).filter_map(|chunk| {
        let values = chunk.iter().flat_map(|(_, values)| values).copied().collect();
        Some(Moment {
            time_s: chunk.last()?.0.as_secs(),
            trials: chunk.iter().map(|(_, values)| values.len() as u64).max()?,
            spread: Spread::of(values)?,
        })
    });
    moments.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ecdf_of_few_values_has_a_point_each_and_of_many_every_quantile() {
        assert_eq!(ecdf(vec![3.0, 1.0]), [[1.0, 0.5], [3.0, 1.0]]);
        let many = ecdf((1..=100_000).map(f64::from).collect());
        assert_eq!(many.len(), MOST_POINTS + 1);
        assert_eq!((many[0][0].to_bits(), many[150]), (1.0_f64.to_bits(), [50_000.0, 0.5]));
    }

    #[test]
    fn a_spread_has_the_quantiles_of_numpy() {
        let spread = Spread::of(vec![25.0, 3.0, 5.0, 7.0, 8.0, 9.0, 11.0, 12.0, 14.0, 30.0]).unwrap();
        assert_eq!((spread.n, spread.min, spread.max), (10, 3.0, 30.0));
        assert!((spread.quantiles[0] - 3.9).abs() < 1e-12 && (spread.median() - 10.0).abs() < 1e-12);
    }
}
