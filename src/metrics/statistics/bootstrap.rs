//! Bootstrap intervals that correct for bias and skewness (BCa; Efron, 1987), from keyed resamples: the same numbers of trials
//! are resampled alike for every figure, on every machine.

use rand::RngExt;
use rand_philox::Philox;
use statrs::distribution::{ContinuousCDF, Normal};

use super::{Ci95, TAIL};
use crate::engine::{Purpose, Streams};

const RESAMPLE: Purpose = Purpose::new("statistics.bootstrap");
/// Resamples behind an interval: its ends then hold two digits.
const RESAMPLES: u32 = 2_000;

/// Resamples of one group of trials, or of two that are independent of each other.
#[derive(Clone, Debug)]
pub struct Resamples {
    sizes: Vec<usize>,
    /// For each resample, for each group: the trials drawn with replacement.
    drawn: Vec<Vec<Vec<usize>>>,
}

impl Resamples {
    /// Resamples of groups of these sizes. Trials that are paired, or observed together, are one group.
    #[must_use]
    pub fn of(sizes: &[usize]) -> Self {
        let streams = Streams::new(0, 0).keyed(RESAMPLE);
        let draw = |number, group: usize, size: usize| {
            let mut random: Philox = streams.at(number, group as u32, size as u32);
            (0..size)
                .map(|_| random.random_range(0..size as u64) as usize)
                .collect()
        };
        let groups = |number| {
            sizes
                .iter()
                .enumerate()
                .map(move |(group, &size)| draw(number, group, size))
        };
        Self {
            sizes: sizes.to_vec(),
            drawn: (0..RESAMPLES).map(|number| groups(number).collect()).collect(),
        }
    }

    /// The BCa 95 % interval of `statistic`, a function of the trials chosen from each group. No interval where a group has
    /// fewer than two trials or the statistic is not finite; an end that resamples put at no finite place is absent.
    #[must_use]
    pub fn interval(&self, statistic: impl Fn(&[Vec<usize>]) -> f64) -> Ci95 {
        let all: Vec<Vec<usize>> = self.sizes.iter().map(|&size| (0..size).collect()).collect();
        let observed = statistic(&all);
        if self.sizes.iter().any(|&size| size < 2) || !observed.is_finite() {
            return [None; 2];
        }
        let mut values: Vec<f64> = self.drawn.iter().map(|chosen| statistic(chosen)).collect();
        values.retain(|value| !value.is_nan());
        values.sort_by(f64::total_cmp);
        let below = values.partition_point(|&value| value < observed);
        let up_to = values.partition_point(|&value| value <= observed);
        let share = (below + up_to) as f64 / (2 * values.len().max(1)) as f64;
        // All resamples on one side tell nothing of the bias; the ends are then plain percentiles.
        let bias = if share > 0.0 && share < 1.0 { probit(share) } else { 0.0 };
        let acceleration = acceleration(&all, &statistic);
        let end = |tail: f64| {
            let shifted = bias + probit(tail);
            let level = Normal::standard().cdf(bias + shifted / (1.0 - acceleration * shifted));
            percentile(&values, level).filter(|value| value.is_finite())
        };
        [end(TAIL), end(1.0 - TAIL)]
    }
}

/// How the spread of the statistic changes with its value, from leaving each trial out in turn (of several groups: Efron and
/// Tibshirani's multi-sample form, as in scipy). 0 where that is not finite.
fn acceleration(all: &[Vec<usize>], statistic: &impl Fn(&[Vec<usize>]) -> f64) -> f64 {
    let (mut cubes, mut squares) = (0.0, 0.0);
    let mut left = all.to_vec();
    for group in 0..all.len() {
        let n = all[group].len();
        let values: Vec<f64> = (0..n)
            .map(|trial| {
                left[group].remove(trial);
                let value = statistic(&left);
                left[group].insert(trial, trial);
                value
            })
            .collect();
        let mean = values.iter().sum::<f64>() / n as f64;
        let pulls = || values.iter().map(|value| (n - 1) as f64 * (mean - value) / n as f64);
        cubes += pulls().map(|pull| pull.powi(3)).sum::<f64>();
        squares += pulls().map(|pull| pull.powi(2)).sum::<f64>();
    }
    let acceleration = cubes / (6.0 * squares.powf(1.5));
    if acceleration.is_finite() { acceleration } else { 0.0 }
}

/// Linear between order statistics, infinite ones included.
fn percentile(sorted: &[f64], level: f64) -> Option<f64> {
    let rank = sorted.len().checked_sub(1)? as f64 * level;
    let (below, above) = (sorted[rank.floor() as usize], sorted[rank.ceil() as usize]);
    Some(if below.total_cmp(&above).is_eq() {
        below
    } else {
        below + (above - below) * rank.fract()
    })
}

fn probit(probability: f64) -> f64 {
    Normal::standard().inverse_cdf(probability)
}

#[cfg(test)]
mod tests {
    use super::super::quantile;
    use super::*;

    const X: [f64; 10] = [12.0, 7.0, 3.0, 25.0, 8.0, 14.0, 9.0, 30.0, 11.0, 5.0];
    const Y: [f64; 10] = [10.0, 9.0, 1.5, 21.0, 8.5, 11.0, 4.0, 26.0, 12.0, 2.0];

    fn pick(values: &[f64], chosen: &[usize]) -> Vec<f64> {
        chosen.iter().map(|&trial| values[trial]).collect()
    }

    fn mean(values: &[f64], chosen: &[usize]) -> f64 {
        chosen.iter().map(|&trial| values[trial]).sum::<f64>() / chosen.len() as f64
    }

    fn median(values: &[f64], chosen: &[usize]) -> f64 {
        let mut picked = pick(values, chosen);
        picked.sort_by(f64::total_cmp);
        quantile(&picked, 0.5).unwrap()
    }

    /// From 2,000 resamples the share beyond an end is 0.025 ± 0.0035 (one standard deviation of a binomial): the end lies
    /// within three of them of scipy's, between its percentiles at 0.0145 and 0.0355; `spread` is that distance, taken from
    /// the standard error σ: σ (z(0.0145) − z(0.025)) = 0.22 σ, and as much again for the bias, which resamples estimate too.
    fn assert_near(interval: Ci95, scipy: [f64; 2], spread: f64) {
        let [Some(low), Some(high)] = interval else {
            panic!("{interval:?}")
        };
        assert!(
            (low - scipy[0]).abs() <= spread && (high - scipy[1]).abs() <= spread,
            "{low} {high}, not {scipy:?}"
        );
    }

    // scipy.stats.bootstrap(data, statistic, n_resamples=400_000, method="BCa", paired=..., rng=numpy.random.default_rng(1))

    #[test]
    fn intervals_of_mean_and_median_are_those_of_scipy() {
        let one = Resamples::of(&[10]);
        // σ = 2.74.
        assert_near(one.interval(|chosen| mean(&X, &chosen[0])), [8.3, 19.0], 0.44 * 2.74);
        // A median of ten takes few values: its ends jump by half the distance between neighbours.
        assert_near(one.interval(|chosen| median(&X, &chosen[0])), [6.5, 18.5], 1.0);
    }

    #[test]
    fn the_interval_of_a_ratio_of_sums_is_that_of_scipy() {
        let one = Resamples::of(&[10]);
        let ratio = one.interval(|chosen| mean(&X, &chosen[0]) / mean(&Y, &chosen[0]));
        // σ = 0.082.
        assert_near(ratio, [1.049_327, 1.375_887], 0.44 * 0.082);
    }

    #[test]
    fn the_interval_of_a_difference_knows_whether_trials_are_paired() {
        let paired = Resamples::of(&[10]).interval(|chosen| mean(&Y, &chosen[0]) - mean(&X, &chosen[0]));
        // σ = 0.73 paired, 3.7 unpaired.
        assert_near(paired, [-3.15, -0.4], 0.44 * 0.73);
        let unpaired = Resamples::of(&[10, 10]).interval(|chosen| mean(&Y, &chosen[1]) - mean(&X, &chosen[0]));
        assert_near(unpaired, [-9.15, 4.70], 0.44 * 3.7);
    }

    #[test]
    fn equal_values_have_no_width_and_one_trial_no_interval() {
        let equal = Resamples::of(&[5]).interval(|chosen| mean(&[0.1; 5], &chosen[0]));
        assert!(equal.iter().all(|end| (end.unwrap() - 0.1).abs() < 1e-15));
        assert_eq!(Resamples::of(&[1]).interval(|_| 1.0), [None; 2]);
        assert_eq!(Resamples::of(&[5]).interval(|_| f64::NAN), [None; 2]);
    }

    #[test]
    fn resamples_are_the_same_each_time() {
        assert_eq!(Resamples::of(&[7, 3]).drawn, Resamples::of(&[7, 3]).drawn);
    }
}
