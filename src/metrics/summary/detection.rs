//! How well robots knew who had failed.

use serde::{Deserialize, Serialize};

use crate::metrics::detection::{Cause, DetectionRecord, Verdict};
use crate::metrics::figures::mistakes;
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

impl Detection {
    pub(super) fn of(figures: &Figures) -> Self {
        let trials: Vec<&DetectionRecord> = figures.records.iter().map(|record| &record.detection).collect();
        Self {
            suspicions: Suspicions::of(&trials),
            mistakes: Quantity {
                value: trials.iter().map(|trial| mistakes(trial).count() as u64).sum(),
                unit: SUSPICIONS.into(),
            },
            failures: Failures::of(&trials),
            detection_time_s: figures.lasted("detection.detection_time_s"),
            mistake_recurrence_s: figures.measured("detection.mistake_recurrence_s", SECONDS),
            mistake_duration_s: figures.lasted("detection.mistake_duration_s"),
            mistake_rate_hz: figures.measured("detection.mistake_rate_hz", "Hz"),
            query_accuracy: figures.measured("detection.query_accuracy", DIMENSIONLESS),
            monitored_s: Quantity {
                value: trials.iter().map(|trial| trial.monitored_s).sum(),
                unit: SECONDS.into(),
            },
        }
    }
}

impl Suspicions {
    fn of(trials: &[&DetectionRecord]) -> Self {
        let mut by_cause = Cause::ALL.map(|cause| (cause, 0));
        let mut by_verdict = Verdict::ALL.map(|verdict| (verdict, 0));
        for suspicion in trials.iter().flat_map(|trial| &trial.suspicions) {
            count(&mut by_cause, suspicion.cause);
            count(&mut by_verdict, suspicion.verdict());
        }
        // Probes are no cause where nobody probes.
        let probed = |(cause, number): &(Cause, u64)| *cause != Cause::Unanswered || *number > 0;
        let named = |(cause, number): (Cause, u64)| (cause.name().to_owned(), number);
        Self {
            value: trials.iter().map(|trial| trial.suspicions.len() as u64).sum(),
            by_cause: Named(by_cause.into_iter().filter(probed).map(named).collect()),
            by_verdict: Named::of(Verdict::ALL.map(Verdict::name), |verdict| by_verdict[verdict].1),
            unit: SUSPICIONS.into(),
        }
    }
}

/// One more of `kind`.
fn count<K: PartialEq>(numbers: &mut [(K, u64)], kind: K) {
    if let Some((_, number)) = numbers.iter_mut().find(|(own, _)| *own == kind) {
        *number += 1;
    }
}

impl Failures {
    fn of(trials: &[&DetectionRecord]) -> Self {
        let count = |name: &str| {
            let all = trials.iter().flat_map(|trial| &trial.failures);
            all.filter(|failure| failure.outcome.name() == name).count() as u64
        };
        Self {
            observed: trials.iter().map(|trial| trial.failures.len() as u64).sum(),
            detected: count("detected"),
            recovered: count("recovered"),
            observer_failed: count("observer_failed"),
            undetected: count("undetected"),
            unit: "failures × observers".into(),
        }
    }
}
