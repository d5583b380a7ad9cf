//! How rumours spread, and what was heard in vain.

use serde::{Deserialize, Serialize};

use crate::metrics::figures::Pairs;
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::{DIMENSIONLESS, SECONDS, Unit};
use crate::statistics::{Estimate, Estimator, Observation, median_survival};

use super::estimates::Figures;
use super::quantity::{Measured, Named};

/// How rumours spread over the robots that nothing ails at the end of their trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpreadSummary {
    /// Share of all pairs of a robot and a rumour in which the robot knew the rumour at the end: mean over trials, its interval within 0
    /// and 1.
    pub informed_ratio: Measured,
    /// From the start until half of those pairs were informed.
    pub time_to_half: SpreadTime,
    /// From the start until all were.
    pub time_to_all: SpreadTime,
}

/// How long rumours took, trials in which they did not come so far counted as censored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpreadTime {
    /// The Kaplan–Meier median.
    pub median: Estimate,
    /// The mean; absent where a trial is censored.
    pub mean: Estimate,
    /// Always `"s"`.
    pub unit: Unit,
}

/// How long rumours took, over the trials that were counted and had any.
#[derive(Debug, Default)]
pub(super) struct Rumors {
    half: Vec<Observation>,
    all: Vec<Observation>,
}

impl Rumors {
    /// Takes in a trial.
    pub fn count(&mut self, record: &TrialRecord) {
        let Some(pairs) = Pairs::of(record) else { return };
        let until = |wanted: usize| {
            let time = pairs.times.get(wanted - 1).copied();
            Observation {
                time: time.unwrap_or(pairs.end).as_secs(),
                happened: time.is_some(),
            }
        };
        self.half.push(until(pairs.count.div_ceil(2)));
        self.all.push(until(pairs.count));
    }
}

impl SpreadSummary {
    /// How `rumors` spread; `None` if there were none.
    pub(super) fn of(figures: &Figures, rumors: &Rumors) -> Option<Self> {
        (!rumors.all.is_empty()).then(|| Self {
            informed_ratio: figures.measured("spread.informed_ratio", DIMENSIONLESS),
            time_to_half: SpreadTime::of(&rumors.half),
            time_to_all: SpreadTime::of(&rumors.all),
        })
    }
}

impl SpreadTime {
    fn of(observations: &[Observation]) -> Self {
        let complete = observations.iter().all(|observation| observation.happened);
        let times = observations.iter().map(|observation| observation.time);
        Self {
            median: median_survival(observations),
            mean: if complete {
                Estimator::Count.estimate(&times.map(|time| [time, 1.0]).collect::<Vec<_>>())
            } else {
                Estimate::default()
            },
            unit: SECONDS.into(),
        }
    }
}

/// Messages that told their receiver nothing new, as far as the protocol says, in the messages delivered over all trials; 0 where the
/// protocol names none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Duplicates {
    /// On all topics.
    #[serde(flatten)]
    pub total: Estimate,
    /// On each topic.
    pub by_topic: Named<Estimate>,
    /// Always `"1"`.
    pub unit: Unit,
}

impl Duplicates {
    /// By these names of `topics`.
    pub(super) fn of(topics: &[&str], figures: &Figures) -> Self {
        Self {
            total: figures.estimate("duplicates"),
            by_topic: Named::of(topics.iter().copied(), |topic| {
                figures.estimate(&format!("duplicates.by_topic.{}", topics[topic]))
            }),
            unit: DIMENSIONLESS.into(),
        }
    }

    /// Whether there were any.
    #[must_use]
    pub fn any(&self) -> bool {
        self.total.value > Some(0.0)
    }
}
