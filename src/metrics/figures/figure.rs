//! What a figure is, and what a trial tells of one.

use std::mem;

use serde::{Deserialize, Serialize};

use crate::metrics::unit::Unit;
use crate::statistics::{Estimate, Estimator, Lasting, Part, Times, pseudo_values};

/// Key of the steps until a mission is complete.
pub const COMPLETION: &str = "steps_to_completion";

/// What a figure is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Figure {
    /// Its key.
    pub key: String,
    /// What reports call it.
    pub name: String,
    /// Its unit.
    pub unit: Unit,
    /// Which way is better.
    pub better: Better,
    /// Whether it is a ratio of sums, which a trial may not have on its own; otherwise a mean over trials.
    pub is_ratio: bool,
    /// How it is estimated.
    pub estimator: Estimator,
}

/// Which way a figure is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Better {
    /// The less the better.
    Lower,
    /// The more the better.
    Higher,
}

/// What a trial tells of a figure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sample {
    /// Numerator and denominator; both 0 where the trial tells nothing.
    pub part: Part,
    /// Whether the value was cut off: it would have grown larger, had the trial gone on.
    pub is_censored: bool,
    /// The times that the trial tells of, where the figure is their mean; empty for other figures. Its part follows from those of all
    /// trials: see [`pool`].
    pub times: Times,
}

impl Sample {
    /// The trial's own value, if it has one.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        (self.part[1] > 0.0).then(|| self.part[0] / self.part[1])
    }

    /// Of a ratio of sums: the trial's numerator and denominator.
    #[must_use]
    pub fn ratio(part: Part) -> Self {
        Self {
            part,
            ..Self::default()
        }
    }

    /// Of a mean over trials: the trial's value, if it has one.
    #[must_use]
    pub fn plain(value: Option<f64>) -> Self {
        Self::ratio(value.map_or([0.0; 2], |value| [value, 1.0]))
    }

    /// Of a mean of times, of which some may have been cut off.
    #[must_use]
    pub fn times(times: Times) -> Self {
        let is_censored = times.iter().any(|seen| !seen.happened);
        Self {
            is_censored,
            times,
            ..Self::default()
        }
    }
}

/// Gives the samples of one setting and figure their parts where these follow from the times of all trials. Other samples stay as they
/// are.
pub fn pool(samples: &mut [Sample]) -> Option<Lasting> {
    if samples.iter().all(|sample| sample.times.is_empty()) {
        return None;
    }
    let times: Vec<Times> = samples.iter_mut().map(|sample| mem::take(&mut sample.times)).collect();
    let (parts, lasting) = pseudo_values(&times);
    for ((sample, part), times) in samples.iter_mut().zip(parts).zip(times) {
        sample.part = part;
        sample.times = times;
    }
    Some(lasting)
}

impl Figure {
    /// The figure over trials, one sample each. A mean of what was cut off is restricted to the longest, and its interval does not reach
    /// beyond that.
    #[must_use]
    pub fn estimate(&self, samples: &[Sample]) -> Estimate {
        self.estimator.estimate(&parts(samples)).at_most(restriction(samples))
    }
}

/// The longest of what `samples` tell of, if it was cut off.
fn restriction(samples: &[Sample]) -> Option<f64> {
    if samples.iter().all(|sample| !sample.is_censored) {
        return None;
    }
    let seen = samples.iter().flat_map(|sample| {
        let alone = sample.value().filter(|_| sample.times.is_empty());
        let times = sample.times.iter().map(|seen| (seen.time, !seen.happened));
        times.chain(alone.map(|value| (value, sample.is_censored)))
    });
    longest_cut_off(seen)
}

/// The longest of what was `seen`, each with whether it was cut off, if it was.
pub(super) fn longest_cut_off(seen: impl Iterator<Item = (f64, bool)>) -> Option<f64> {
    let longest = seen.max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    longest.filter(|(_, is_cut_off)| *is_cut_off).map(|(time, _)| time)
}

/// The parts of trials.
#[must_use]
pub fn parts(samples: &[Sample]) -> Vec<Part> {
    samples.iter().map(|sample| sample.part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{Estimator, Observation};

    fn figure(estimator: Estimator) -> Figure {
        Figure {
            key: "a".into(),
            name: "a".into(),
            unit: "s".into(),
            better: Better::Lower,
            is_ratio: false,
            estimator,
        }
    }

    #[test]
    fn the_interval_of_a_restricted_mean_ends_where_watching_did() {
        let plain = |value: f64, is_censored: bool| Sample {
            is_censored,
            ..Sample::plain(Some(value))
        };
        let cut_off = [
            plain(10.0, false),
            plain(100.0, true),
            plain(100.0, false),
            plain(99.0, true),
        ];
        let open = [
            plain(10.0, false),
            plain(100.0, false),
            plain(99.0, false),
            plain(99.0, true),
        ];
        let upper = |samples: &[Sample], estimator| figure(estimator).estimate(samples).ci95[1].unwrap();
        assert!((upper(&cut_off, Estimator::Mean) - 100.0).abs() < 1e-12);
        assert!(upper(&open, Estimator::Mean) > 100.0);
        let trial = |times: &[(f64, bool)]| {
            let seen = times.iter().map(|&(time, happened)| Observation { time, happened });
            Sample::times(seen.collect())
        };
        let mut lasting = [
            trial(&[(3.0, true), (50.0, false)]),
            trial(&[(50.0, false), (49.0, true)]),
        ];
        assert_eq!(pool(&mut lasting).unwrap().restricted_to, Some(50.0));
        assert!((upper(&lasting, Estimator::Times) - 50.0).abs() < 1e-12);
    }
}
