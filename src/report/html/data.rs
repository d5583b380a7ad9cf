//! From records to the points of charts.

use std::collections::BTreeMap;

use crate::engine::SimTime;
use crate::metrics::TrialRecord;
use crate::statistics::{Observation, quantile, survival_curve};

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

/// The share of `times` that were over by each time, those that were cut off counted as longer than that (Kaplan–Meier): every time if
/// they are few, else as many as a chart can show.
pub fn over_by(times: impl IntoIterator<Item = Observation>) -> Vec<[f64; 2]> {
    let steps = survival_curve(times);
    let last = steps.len().saturating_sub(1);
    let points = last.min(MOST_POINTS);
    (0..=points)
        .filter_map(|point| steps.get((point * last).checked_div(points).unwrap_or(0)))
        .map(|step| [step.time, 1.0 - step.survival])
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
    fn few_times_have_a_point_each_many_are_thinned_and_what_was_cut_off_took_longer() {
        let seen = |time: f64, happened: bool| Observation { time, happened };
        assert_eq!(over_by([seen(3.0, true), seen(1.0, true)]), [[1.0, 0.5], [3.0, 1.0]]);
        // Of two that took longer than 2 s, one is over at 3 s: half of the half that was left.
        let cut = [seen(1.0, true), seen(1.5, true), seen(2.0, false), seen(3.0, true)];
        assert_eq!(over_by(cut), [[1.0, 0.25], [1.5, 0.5], [3.0, 1.0]]);
        assert_eq!(over_by([seen(3.0, false)]), [[0.0; 2]; 0]);
        let many: Vec<_> = (1..=100_000).map(|time| seen(f64::from(time), true)).collect();
        let many = over_by(many);
        assert_eq!(many.len(), MOST_POINTS + 1);
        assert!((many[0][0] - 1.0).abs() < 1e-12 && (many[150][1] - 0.5).abs() < 1e-4);
    }

    #[test]
    fn a_spread_has_the_quantiles_of_numpy() {
        let spread = Spread::of(vec![25.0, 3.0, 5.0, 7.0, 8.0, 9.0, 11.0, 12.0, 14.0, 30.0]).unwrap();
        assert_eq!((spread.n, spread.min, spread.max), (10, 3.0, 30.0));
        assert!((spread.quantiles[0] - 3.9).abs() < 1e-12 && (spread.median() - 10.0).abs() < 1e-12);
    }
}
