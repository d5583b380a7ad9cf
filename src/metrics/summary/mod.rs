//! The figures of an experiment, as `summary.json` holds them and the reports show them.
//!
//! Everything here follows from the records alone and depends on no machine. Keys and their order are stable.

mod air;
mod bandwidth;
mod detection;
mod estimates;
mod faults;
mod frames;
mod listed;
mod missed;
mod quantity;
mod spread;
mod trials;

pub use super::figures::{detection_times, mistake_durations};
pub use super::unit::Unit;
pub use air::{Delay, RadioSummary, Sending, Wait};
pub use bandwidth::{Bandwidth, Directions, LoadImbalance, Spread, TopicBandwidth};
pub use detection::{Detection, Failures, Suspicions};
pub use faults::{FaultSummary, Healed, HealingSummary, HealingTime};
pub use frames::{Fates, Frames};
pub use listed::Listed;
pub use missed::{MissedSummary, MissedTarget};
pub use quantity::{Lasted, Measured, Named, Quantity};
pub use spread::{Duplicates, SpreadSummary, SpreadTime};
pub use trials::Trials;

use serde::{Deserialize, Serialize};

use crate::engine::Span;

use super::figures::Registry;
use super::latency::LatencyHistogram;
use super::record::TrialRecord;
use super::unit::{DIMENSIONLESS, SECONDS, STEPS};
use crate::statistics::{Estimate, median_survival};
use estimates::Figures;

/// The figures of all trials of one scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the scenario.
    pub scenario: String,
    /// Number of trials.
    pub trials: u64,
    /// Trials that completed their mission.
    pub completed: u64,
    /// XXH3-128 of the trials' digests, in order, each as 16 bytes, least significant first: 32 hexadecimal digits.
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
    /// Payload that arrived at all robots together, over a radio on which frames take time; else absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub goodput_bps: Option<Measured>,
    /// What radios did, over one on which frames take time; else absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radio: Option<RadioSummary>,
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
    /// Control steps simulated, over all trials.
    pub steps: Quantity<u64>,
    /// Time simulated, over all trials.
    pub simulated_s: Quantity<f64>,
    /// The figures that have no place of their own above, by their keys; those that no trial has are absent.
    #[serde(default, skip_serializing_if = "Named::is_empty")]
    pub figures: Named<Listed>,
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
        Self::by(&Registry::of(topics), scenario, topics, roles, records)
    }

    /// As [`of`](Self::of), by the figures of `registry`, which has at least those that desim ships for these topics.
    #[must_use]
    pub fn by(registry: &Registry, scenario: &str, topics: &[&str], roles: &[&str], records: &[TrialRecord]) -> Self {
        let mut trials = Trials::new(registry, topics, roles);
        for record in records {
            trials.add(record);
        }
        trials.summary(scenario)
    }

    fn put_together(trials: &Trials, scenario: &str) -> Self {
        let Trials { topics, roles, .. } = *trials;
        let figures = &Figures(trials.registry.estimate(&trials.samples).collect());
        Self {
            scenario: scenario.to_owned(),
            trials: trials.count,
            completed: trials.completed,
            digest: format!("{:032x}", trials.digest.digest128()),
            completion_ratio: figures.measured("completion_ratio", DIMENSIONLESS),
            steps_to_completion: StepsToCompletion {
                median: median_survival(&trials.missions),
                unit: STEPS.into(),
            },
            missed: MissedSummary::put_together(&trials.failed),
            frames: Frames::of(topics, &trials.ledger),
            delivery_ratio: figures.measured("delivery_ratio", DIMENSIONLESS),
            latency_s: Latency::of(figures, &trials.latency),
            goodput_bps: figures
                .has("goodput_bps")
                .then(|| figures.measured("goodput_bps", "bit/s")),
            radio: RadioSummary::of(figures, &trials.radios),
            bandwidth: Bandwidth::of(topics, roles, &trials.loads),
            load_imbalance: LoadImbalance::of(figures),
            lambda2_min: LeastConnectivity {
                estimate: figures.estimate("lambda2_min"),
                min: LeastConnectivity::least(trials),
                unit: DIMENSIONLESS.into(),
            },
            connected_share: figures.measured("connected_share", DIMENSIONLESS),
            robots_used: figures.measured("robots_used", "robots"),
            faults: FaultSummary::of(roles, &trials.faults),
            healing: HealingSummary::of(topics, roles, &trials.healings),
            spread: SpreadSummary::of(figures, &trials.rumors),
            duplicates: Duplicates::of(topics, figures),
            detection: Detection::of(figures, &trials.beliefs),
            steps: Quantity {
                value: trials.steps,
                unit: STEPS.into(),
            },
            simulated_s: Quantity {
                value: trials.simulated_s,
                unit: SECONDS.into(),
            },
            figures: Listed::all(figures),
        }
    }
}

impl Latency {
    fn of(figures: &Figures, all: &LatencyHistogram) -> Self {
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
    fn least(trials: &Trials) -> Option<f64> {
        let mut figures = trials.registry.figures();
        let pooled = trials
            .samples
            .of(figures.position(|figure| figure.key == "lambda2_min")?);
        pooled.values().map(|(_, value, _)| value).min_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests;
