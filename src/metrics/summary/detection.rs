//! How well robots knew who had failed.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::metrics::detection::{Cause, DetectionRecord, Verdict};
use crate::metrics::unit::{DIMENSIONLESS, SECONDS, Unit};

use super::estimates::Figures;
use super::quantity::{Lasted, Measured, Named, Quantity};

const SUSPICIONS: &str = "suspicions";

/// Failure detection over all trials; [`crate::metrics::detection`] defines the figures. Estimates are ratios of sums over
/// trials, so that a trial without a mistake counts with the time that it was watched. What was cut off is neither left out nor
/// taken for over: see [`Lasted`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Detection {
    /// Suspicions, by cause and by verdict.
    pub suspicions: Suspicions,
    /// Suspicions that were mistakes.
    pub mistakes: Quantity<u64>,
    /// Failures of robots, once for each observer that monitored the robot then.
    pub failures: Failures,
    /// T_D; failures that ended, or whose observer or run did, before they were detected are cut off.
    pub detection_time_s: Lasted,
    /// T_MR, monitored time over mistakes.
    pub mistake_recurrence_s: Measured,
    /// T_M; mistakes that did not end in trust are cut off.
    pub mistake_duration_s: Lasted,
    /// λ_M, mistakes over monitored time: of one pair.
    pub mistake_rate_hz: Measured,
    /// P_A, the share of the monitored time not spent in a mistake.
    pub query_accuracy: Measured,
    /// Monitored time, summed over pairs and trials.
    pub monitored_s: Quantity<f64>,
}

/// Suspicions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Suspicions {
    /// All of them.
    pub value: u64,
    /// By cause.
    pub by_cause: Named<u64>,
    /// By verdict.
    pub by_verdict: Named<u64>,
    /// Always `"suspicions"`.
    pub unit: Unit,
}

/// Failures as observers saw them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Failures {
    /// All of them.
    pub observed: u64,
    /// Detected before they or the run ended.
    pub detected: u64,
    /// Ended before they were detected.
    pub recovered: u64,
    /// Not detected before the observer itself could hear no more.
    pub observer_failed: u64,
    /// Not detected by the end of the run.
    pub undetected: u64,
    /// Always `"failures × observers"`.
    pub unit: Unit,
}

/// What detectors did, counted trial by trial.
#[derive(Clone, Debug)]
pub(super) struct Beliefs {
    by_cause: [(Cause, u64); Cause::ALL.len()],
    by_verdict: [(Verdict, u64); Verdict::ALL.len()],
    suspicions: u64,
    monitored_s: f64,
    /// Failures by the names of their outcomes.
    failures: BTreeMap<&'static str, u64>,
}

impl Default for Beliefs {
    fn default() -> Self {
        Self {
            by_cause: Cause::ALL.map(|cause| (cause, 0)),
            by_verdict: Verdict::ALL.map(|verdict| (verdict, 0)),
            suspicions: 0,
            monitored_s: 0.0,
            failures: BTreeMap::new(),
        }
    }
}

impl Beliefs {
    /// Counts those of a trial.
    pub fn count(&mut self, trial: &DetectionRecord) {
        for suspicion in &trial.suspicions {
            one_more(&mut self.by_cause, &suspicion.cause);
            one_more(&mut self.by_verdict, &suspicion.verdict());
        }
        self.suspicions += trial.suspicions.len() as u64;
        self.monitored_s += trial.monitored_s;
        for failure in &trial.failures {
            *self.failures.entry(failure.outcome.name()).or_default() += 1;
        }
    }

    fn of_verdict(&self, wanted: Verdict) -> u64 {
        let found = self.by_verdict.iter().find(|(verdict, _)| *verdict == wanted);
        found.map_or(0, |(_, number)| *number)
    }
}

/// One more of `kind`.
fn one_more<K: PartialEq>(numbers: &mut [(K, u64)], kind: &K) {
    if let Some((_, number)) = numbers.iter_mut().find(|(own, _)| own == kind) {
        *number += 1;
    }
}

impl Detection {
    pub(super) fn of(figures: &Figures, beliefs: &Beliefs) -> Self {
        Self {
            suspicions: Suspicions::of(beliefs),
            mistakes: Quantity {
                value: beliefs.of_verdict(Verdict::Mistake),
                unit: SUSPICIONS.into(),
            },
            failures: Failures::of(beliefs),
            detection_time_s: figures.lasted("detection.detection_time_s"),
            mistake_recurrence_s: figures.measured("detection.mistake_recurrence_s", SECONDS),
            mistake_duration_s: figures.lasted("detection.mistake_duration_s"),
            mistake_rate_hz: figures.measured("detection.mistake_rate_hz", "Hz"),
            query_accuracy: figures.measured("detection.query_accuracy", DIMENSIONLESS),
            monitored_s: Quantity {
                value: beliefs.monitored_s,
                unit: SECONDS.into(),
            },
        }
    }
}

impl Suspicions {
    fn of(beliefs: &Beliefs) -> Self {
        // Probes are no cause where nobody probes.
        let probed = |(cause, number): &(Cause, u64)| *cause != Cause::Unanswered || *number > 0;
        let named = |(cause, number): (Cause, u64)| (cause.name().to_owned(), number);
        Self {
            value: beliefs.suspicions,
            by_cause: Named(beliefs.by_cause.into_iter().filter(probed).map(named).collect()),
            by_verdict: Named::of(Verdict::ALL.map(Verdict::name), |verdict| beliefs.by_verdict[verdict].1),
            unit: SUSPICIONS.into(),
        }
    }
}

impl Failures {
    fn of(beliefs: &Beliefs) -> Self {
        let count = |name: &str| beliefs.failures.get(name).copied().unwrap_or(0);
        Self {
            observed: beliefs.failures.values().sum(),
            detected: count("detected"),
            recovered: count("recovered"),
            observer_failed: count("observer_failed"),
            undetected: count("undetected"),
            unit: "failures × observers".into(),
        }
    }
}
