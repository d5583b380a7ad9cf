//! What the trials of one setting tell.

use serde::{Deserialize, Serialize};

use super::{Design, Trials};
use crate::metrics::figures::{COMPLETION, Figure, Pooled, Sample};
use crate::metrics::summary::Named;
use crate::statistics::{Estimate, Observation, Step, median, median_survival, survival_curve};

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
    /// The mean over trials, or the ratio of sums over trials, as in `summary.json`; of what may be cut off, the restricted mean.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// The median over trials, between order statistics; absent for ratios of sums.
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

impl Estimated {
    /// Of what the `whole` trials tell of `figure`, and what is left where their times are `restricted` to what all settings were watched for.
    pub(super) fn of(figure: &Figure, whole: &Pooled, restricted: &Pooled) -> Self {
        let values = || restricted.parts.iter().filter_map(|part| Sample::ratio(*part).value());
        Self {
            estimate: restricted.estimate(figure),
            median: (!figure.is_ratio).then(|| median(&values().collect::<Vec<f64>>())),
            survival: (figure.key == COMPLETION).then(|| Survival::of(&whole.samples())),
        }
    }
}

impl Setting {
    /// Of `trials`, with what they tell of each figure.
    pub(super) fn of(design: &Design, trials: &Trials, figures: Vec<Estimated>) -> Self {
        let keys = design.figures.iter().map(|figure| figure.key.clone());
        Self {
            name: trials.name.clone(),
            label: trials.label.clone(),
            levels: trials.levels.clone(),
            seed: trials.seed,
            trials: trials.samples.len() as u64,
            figures: Named(keys.zip(figures).collect()),
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

impl Survival {
    fn of(samples: &[Sample]) -> Self {
        let observations = observations(samples);
        Self {
            median: median_survival(&observations),
            censored: observations.iter().filter(|seen| !seen.happened).count() as u64,
            curve: survival_curve(observations.iter().copied()),
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
