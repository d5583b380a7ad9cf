//! What the trials of one setting tell.

use serde::{Deserialize, Serialize};

use super::{Design, Trials, by_key};
use crate::metrics::figures::Sample;
use crate::metrics::statistics::{
    Estimate, Observation, Resamples, Step, median_survival, quantile, ratio_of_sums, survival_curve,
};
use crate::metrics::summary::Named;

/// What the trials of one setting tell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Its name: its results lie in the folder of that name.
    pub name: String,
    /// What people call it: the labels of its levels.
    pub label: String,
    /// The label of its level of each factor, in the order of factors.
    pub levels: Vec<String>,
    /// Its seed.
    pub seed: u64,
    /// Number of trials.
    pub trials: u64,
    /// Its figures, by key.
    pub figures: Named<Estimated>,
}

/// A figure of a setting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimated {
    /// The mean over trials, or the ratio of sums over trials, with its BCa bootstrap interval; of what may be cut off, the
    /// restricted mean.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// The median over trials with its BCa bootstrap interval; absent for ratios of sums.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub median: Option<Estimate>,
    /// How it came about over time, for what may be cut off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub survival: Option<Survival>,
}

/// When trials were done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Survival {
    /// The Kaplan–Meier median.
    pub median: Estimate,
    /// Trials that were cut off.
    pub censored: u64,
    /// The Kaplan–Meier curve with Greenwood's band: share of the trials that are not done yet.
    pub curve: Vec<Step>,
}

impl Setting {
    pub(super) fn of(design: &Design, trials: &Trials) -> Self {
        let count = trials.samples.first().map_or(0, Vec::len);
        let resamples = Resamples::of(&[count]);
        let estimated = |figure: usize| {
            let samples = &trials.samples[figure];
            Estimated {
                estimate: estimate(samples, &resamples),
                median: (!design.figures[figure].is_ratio).then(|| median(samples, &resamples)),
                survival: (design.figures[figure].key == crate::metrics::figures::COMPLETION)
                    .then(|| Survival::of(samples)),
            }
        };
        Self {
            name: trials.name.clone(),
            label: trials.label.clone(),
            levels: trials.levels.clone(),
            seed: trials.seed,
            trials: count as u64,
            figures: by_key(&design.figures, estimated),
        }
    }

    /// A figure by its key.
    #[must_use]
    pub fn figure(&self, key: &str) -> Option<&Estimated> {
        self.figures
            .0
            .iter()
            .find(|(name, _)| name == key)
            .map(|(_, figure)| figure)
    }
}

/// Trials that tell something.
fn telling(samples: &[Sample]) -> u64 {
    let tells = |sample: &&Sample| sample.part.iter().any(|part| part.abs() > 0.0);
    samples.iter().filter(tells).count() as u64
}

/// The ratio of sums with its interval.
pub(super) fn estimate(samples: &[Sample], resamples: &Resamples) -> Estimate {
    let of = |chosen: &[usize]| ratio_of_sums(chosen.iter().map(|&trial| samples[trial].part));
    let value = ratio_of_sums(samples.iter().map(|sample| sample.part));
    Estimate {
        value: value.is_finite().then_some(value),
        ci95: resamples.interval(|chosen| of(&chosen[0])),
        n: telling(samples),
    }
}

fn median(samples: &[Sample], resamples: &Resamples) -> Estimate {
    let of = |chosen: &mut dyn Iterator<Item = usize>| {
        let mut values: Vec<f64> = chosen.filter_map(|trial| samples[trial].value()).collect();
        values.sort_by(f64::total_cmp);
        quantile(&values, 0.5)
    };
    Estimate {
        value: of(&mut (0..samples.len())),
        ci95: resamples.interval(|chosen| of(&mut chosen[0].iter().copied()).unwrap_or(f64::NAN)),
        n: telling(samples),
    }
}

impl Survival {
    fn of(samples: &[Sample]) -> Self {
        let observations = observations(samples);
        Self {
            median: median_survival(&observations),
            censored: observations.iter().filter(|seen| !seen.happened).count() as u64,
            curve: survival_curve(&observations),
        }
    }
}

/// The times that trials took.
pub(super) fn observations(samples: &[Sample]) -> Vec<Observation> {
    let seen = samples.iter().filter_map(|sample| {
        Some(Observation {
            time: sample.value()?,
            happened: !sample.is_censored,
        })
    });
    seen.collect()
}
