//! How rumours spread, and what was heard in vain.

use serde::{Deserialize, Serialize};

use crate::engine::SimTime;
use crate::metrics::record::{TrafficRow, TrialRecord};
use crate::metrics::statistics::{Estimate, Observation, mean, median_survival};

use super::quantity::{DIMENSIONLESS, Measured, Named, Unit};
use super::{SECONDS, mean_over_trials};

/// How rumours spread over the robots that nothing ails at the end of their trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpreadSummary {
    /// Share of all pairs of a robot and a rumour in which the robot knew the rumour at the end: mean over trials.
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

impl SpreadSummary {
    /// How rumours spread in `records`; `None` if there were none.
    pub(super) fn of(records: &[TrialRecord]) -> Option<Self> {
        let trials: Vec<Pairs> = records.iter().filter_map(Pairs::of).collect();
        (!trials.is_empty()).then(|| Self {
            informed_ratio: Measured {
                estimate: mean(&trials.iter().map(Pairs::informed_ratio).collect::<Vec<_>>()),
                unit: DIMENSIONLESS.into(),
            },
            time_to_half: SpreadTime::of(&trials, |count| count.div_ceil(2)),
            time_to_all: SpreadTime::of(&trials, |count| count),
        })
    }
}

/// The pairs of a robot and a rumour in one trial.
struct Pairs {
    count: usize,
    /// When each of the informed ones was informed, in order.
    times: Vec<SimTime>,
    end: SimTime,
}

impl Pairs {
    fn of(record: &TrialRecord) -> Option<Self> {
        let failed = record.failed_at_end();
        let rumors = record.spread.iter();
        let pairs = rumors.flat_map(|rumor| (0..).zip(&rumor.informed));
        let well: Vec<Option<SimTime>> = pairs
            .filter(|(robot, _)| failed.binary_search_by_key(robot, |failed| failed.0).is_err())
            .map(|(_, at)| *at)
            .collect();
        let mut times: Vec<SimTime> = well.iter().copied().flatten().collect();
        times.sort_unstable();
        // Of nobody there is nothing to say.
        (!well.is_empty()).then_some(Self {
            count: well.len(),
            times,
            end: record.simulated,
        })
    }
}

impl Pairs {
    fn informed_ratio(&self) -> f64 {
        self.times.len() as f64 / self.count as f64
    }
}

/// The share of all pairs of a robot and a rumour in which the robot knew the rumour at the end of a trial; `None` without rumours, or without robots that
/// are well.
pub(in crate::metrics) fn informed_ratio(record: &TrialRecord) -> Option<f64> {
    Pairs::of(record).map(|pairs| pairs.informed_ratio())
}

/// Duplicates in the messages delivered in a trial, of the rows of traffic that `counts` accepts; `None` if nothing was.
pub(in crate::metrics) fn duplicate_ratio(record: &TrialRecord, counts: impl Fn(&TrafficRow) -> bool) -> Option<f64> {
    let rows = || record.traffic.iter().filter(|row| counts(row));
    let received: u64 = rows().map(|row| row.received.frames).sum();
    let duplicate: u64 = rows().map(|row| row.duplicate.frames).sum();
    (received > 0).then(|| duplicate as f64 / received as f64)
}

impl SpreadTime {
    /// Until so many of all pairs were informed.
    fn of(trials: &[Pairs], wanted: impl Fn(usize) -> usize) -> Self {
        let observe = |trial: &Pairs| {
            let time = trial.times.get(wanted(trial.count) - 1).copied();
            Observation {
                time: time.unwrap_or(trial.end).as_secs(),
                happened: time.is_some(),
            }
        };
        let observations: Vec<Observation> = trials.iter().map(observe).collect();
        let complete = observations.iter().all(|observation| observation.happened);
        let times: Vec<f64> = observations.iter().map(|observation| observation.time).collect();
        Self {
            median: median_survival(&observations),
            mean: if complete { mean(&times) } else { Estimate::default() },
            unit: SECONDS.into(),
        }
    }
}

/// Messages that told their receiver nothing new, as far as the protocol says, in the messages delivered: mean over trials.
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
    /// Of `records`, by these names of `topics`; `None` if there were none.
    pub(super) fn of(topics: &[&str], records: &[TrialRecord]) -> Option<Self> {
        let mut rows = records.iter().flat_map(|record| &record.traffic);
        let any = rows.any(|row| row.duplicate.frames > 0);
        let share =
            |counts: &dyn Fn(&TrafficRow) -> bool| mean_over_trials(records, |record| duplicate_ratio(record, counts));
        any.then(|| Self {
            total: share(&|_| true),
            by_topic: Named::of(topics.iter().copied(), |topic| {
                share(&|row| usize::from(row.topic) == topic)
            }),
            unit: DIMENSIONLESS.into(),
        })
    }
}
