//! The figures of an experiment, as `summary.json` holds them and the reports show them.
//!
//! Everything here follows from the records alone and depends on no machine. Keys and their order are stable.

pub(super) mod bandwidth;
pub(super) mod detection;
pub(super) mod faults;
pub(super) mod frames;
mod missed;
mod quantity;
pub(super) mod spread;

pub use bandwidth::{Bandwidth, Directions, LoadImbalance, Spread, TopicBandwidth};
pub use detection::{Detection, Failures, Suspicions, detection_times, mistake_durations};
pub use faults::{FaultSummary, Healed, HealingSummary, HealingTime};
pub use frames::{Fates, Frames};
pub use missed::{MissedSummary, MissedTarget};
pub use quantity::{Lasted, Measured, Named, Quantity, Unit};
pub use spread::{Duplicates, SpreadSummary, SpreadTime};

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_128;

use crate::engine::Span;

use super::figures::{Registry, Sample};
use super::latency::LatencyHistogram;
use super::noted_figure::NotedFigure;
use super::record::{Outcome, TrialRecord};
use crate::statistics::{Estimate, Estimator, Observation, median_survival};
pub(super) use quantity::DIMENSIONLESS;

pub(super) const STEPS: &str = "control steps";
pub(super) const SECONDS: &str = "s";

/// The figures of all trials of one scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the scenario.
    pub scenario: String,
    /// Number of trials.
    pub trials: u64,
    /// Trials that completed their mission.
    pub completed: u64,
    /// Digest of the trials' digests, in order: 32 hexadecimal digits.
    pub digest: String,
    /// Share of the trials with a mission that completed it, with Wilson's interval.
    pub completion_ratio: Measured,
    /// Steps to completion, trials that did not complete counted as censored.
    pub steps_to_completion: StepsToCompletion,
    /// Why missions failed; absent if none did, or nothing was sampled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub missed: Option<MissedSummary>,
    /// Frames by fate.
    pub frames: Frames,
    /// Share of the copies offered that were delivered, or will be: copies under way at the end are lost as far as they have been, and
    /// no further.
    pub delivery_ratio: Measured,
    /// Latency of copies, whether they arrived before the end or were under way.
    pub latency_s: Latency,
    /// Bytes that robots send and receive.
    pub bandwidth: Bandwidth,
    /// How evenly robots share the load.
    pub load_imbalance: LoadImbalance,
    /// The least λ₂ of a trial's samples.
    pub lambda2_min: LeastConnectivity,
    /// Share of a trial's samples in which the swarm is in one piece: mean over trials, its interval within 0 and 1.
    pub connected_share: Measured,
    /// Robots that a mission took, those that ended in another role than the first: mean over trials.
    pub robots_used: Measured,
    /// What failed; absent if nothing did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faults: Option<FaultSummary>,
    /// How targets got their links back; absent if no robot failed that worked for one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub healing: Option<HealingSummary>,
    /// How rumours spread; absent where there were none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spread: Option<SpreadSummary>,
    /// What was heard in vain.
    pub duplicates: Duplicates,
    /// Failure detection, against the truth.
    pub detection: Detection,
    /// The protocol's own figures, of what its robots count and measure; absent where it has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noted: Option<Named<NotedSummary>>,
    /// Control steps simulated, over all trials.
    pub steps: Quantity<u64>,
    /// Time simulated, over all trials.
    pub simulated_s: Quantity<f64>,
}

/// Control steps until a mission is complete.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepsToCompletion {
    /// The Kaplan–Meier median.
    pub median: Estimate,
    /// Always `"control steps"`.
    pub unit: Unit,
}

/// Time from the start of a transmission to its arrival, also where that comes after the end: to leave long ones out would flatter.
/// Absent where nothing was on its way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Latency {
    /// Median over all copies, within 1/256.
    pub p50: Option<f64>,
    /// 95th percentile over all copies, within 1/256.
    pub p95: Option<f64>,
    /// 99th percentile over all copies, within 1/256.
    pub p99: Option<f64>,
    /// Mean over trials of each trial's mean.
    pub mean: Estimate,
    /// Always `"s"`.
    pub unit: Unit,
}

/// The least λ₂ of each trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeastConnectivity {
    /// Median over trials.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// Least over trials.
    pub min: Option<f64>,
    /// Always `"1"`.
    pub unit: Unit,
}

impl Summary {
    /// Summarises `records`, in order of trials, of the scenario called `scenario`; `topics` and `roles` are the names
    /// that its protocol gives them.
    #[must_use]
    pub fn of(scenario: &str, topics: &[&str], roles: &[&str], records: &[TrialRecord]) -> Self {
        let completed = records
            .iter()
            .filter(|record| matches!(record.outcome, Outcome::Completed { .. }))
            .count() as u64;
        let registry = Registry::of(topics);
        let figures = &Figures {
            registry: &registry,
            records,
        };
        Self {
            scenario: scenario.to_owned(),
            trials: records.len() as u64,
            completed,
            digest: digest(records),
            completion_ratio: figures.measured("completion_ratio", DIMENSIONLESS),
            steps_to_completion: StepsToCompletion::of(records),
            missed: MissedSummary::of(records),
            frames: Frames::of(topics, records),
            delivery_ratio: figures.measured("delivery_ratio", DIMENSIONLESS),
            latency_s: Latency::of(figures),
            bandwidth: Bandwidth::of(topics, roles, records),
            load_imbalance: LoadImbalance::of(figures),
            lambda2_min: LeastConnectivity::of(figures),
            connected_share: figures.measured("connected_share", DIMENSIONLESS),
            robots_used: figures.measured("robots_used", "robots"),
            faults: FaultSummary::of(roles, records),
            healing: HealingSummary::of(topics, roles, records),
            spread: SpreadSummary::of(figures),
            duplicates: Duplicates::of(topics, figures),
            detection: Detection::of(figures),
            noted: None,
            steps: Quantity {
                value: records.iter().map(|record| record.steps).sum(),
                unit: STEPS.into(),
            },
            simulated_s: Quantity {
                value: records.iter().map(|record| record.simulated.as_secs()).sum(),
                unit: SECONDS.into(),
            },
        }
    }
}

impl Summary {
    /// The same, with the protocol's own figures of what its robots noted in `records`.
    #[must_use]
    pub fn noting(mut self, figures: &[NotedFigure], records: &[TrialRecord]) -> Self {
        let summary = |place: usize| {
            let noted: &NotedFigure = &figures[place];
            let samples: Vec<Sample> = records.iter().map(|record| noted.read(record)).collect();
            NotedSummary {
                name: noted.name.to_owned(),
                estimate: noted.figure().estimate(&samples),
                unit: noted.unit.into(),
            }
        };
        self.noted = (!figures.is_empty()).then(|| Named::of(figures.iter().map(|noted| noted.key), summary));
        self
    }
}

/// A protocol's own figure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NotedSummary {
    /// What reports call it.
    pub name: String,
    /// The figure over trials.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// Its unit.
    pub unit: Unit,
}

/// The figures of a protocol over the trials to be summarised: the ones that comparisons show.
struct Figures<'a> {
    registry: &'a Registry,
    records: &'a [TrialRecord],
}

impl Figures<'_> {
    fn estimate(&self, key: &str) -> Estimate {
        self.registry.estimate(key, self.records).0
    }

    fn measured(&self, key: &str, unit: &'static str) -> Measured {
        Measured {
            estimate: self.estimate(key),
            unit: unit.into(),
        }
    }

    fn lasted(&self, key: &str) -> Lasted {
        let (estimate, lasting) = self.registry.estimate(key, self.records);
        Lasted {
            estimate,
            cut_off: lasting.cut_off,
            restricted_to: lasting.restricted_to,
            unit: SECONDS.into(),
        }
    }
}

/// The mean of whole numbers over trials.
fn mean_count(records: &[TrialRecord], count: impl Fn(&TrialRecord) -> f64) -> Estimate {
    Estimator::Count.estimate(&records.iter().map(|record| [count(record), 1.0]).collect::<Vec<_>>())
}

/// XXH3-128 of the trials' digests, each as 16 bytes, least significant first.
fn digest(records: &[TrialRecord]) -> String {
    let bytes: Vec<u8> = records.iter().flat_map(|record| record.digest.to_le_bytes()).collect();
    format!("{:032x}", xxh3_128(&bytes))
}

/// Control steps until the mission of a trial was complete, or that it was watched in vain; `None` without a mission.
pub(super) fn completion(record: &TrialRecord) -> Option<Observation> {
    let (step, happened) = match record.outcome {
        Outcome::Completed { step } => (step, true),
        Outcome::Censored => (record.steps, false),
        Outcome::NoMission => return None,
    };
    Some(Observation {
        time: step as f64,
        happened,
    })
}

impl StepsToCompletion {
    fn of(records: &[TrialRecord]) -> Self {
        let observations: Vec<Observation> = records.iter().filter_map(completion).collect();
        Self {
            median: median_survival(&observations),
            unit: STEPS.into(),
        }
    }
}

impl Latency {
    fn of(figures: &Figures) -> Self {
        let mut all = LatencyHistogram::default();
        for record in figures.records {
            all.merge(&record.latency);
        }
        let quantile = |q| all.quantile(q).map(Span::as_secs);
        Self {
            p50: quantile(0.5),
            p95: quantile(0.95),
            p99: quantile(0.99),
            mean: figures.estimate("latency_s.mean"),
            unit: SECONDS.into(),
        }
    }
}

impl LeastConnectivity {
    fn of(figures: &Figures) -> Self {
        let minima: Vec<f64> = figures.records.iter().filter_map(TrialRecord::lambda2_min).collect();
        Self {
            estimate: figures.estimate("lambda2_min"),
            min: minima.iter().copied().min_by(f64::total_cmp),
            unit: DIMENSIONLESS.into(),
        }
    }
}

#[cfg(test)]
mod tests;
