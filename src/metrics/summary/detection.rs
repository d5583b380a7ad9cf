//! How well robots knew who had failed.

use serde::{Deserialize, Serialize};

use crate::metrics::detection::{Cause, DetectionRecord, FailureOutcome, Suspicion, Verdict};
use crate::metrics::record::TrialRecord;
use crate::metrics::statistics::{Estimate, ratio};

use super::quantity::{DIMENSIONLESS, Measured, Named, Quantity, Unit};

const SUSPICIONS: &str = "suspicions";
const SECONDS: &str = "s";

/// Failure detection over all trials; [`crate::metrics::detection`] defines the figures. Estimates are ratios of sums over
/// trials, so that a trial without a mistake counts with the time that it was watched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Detection {
    /// Suspicions, by cause and by verdict.
    pub suspicions: Suspicions,
    /// Suspicions that were mistakes.
    pub mistakes: Quantity<u64>,
    /// Failures of robots, once for each observer that monitored the robot then.
    pub failures: Failures,
    /// T_D, of the failures that were detected.
    pub detection_time_s: Measured,
    /// T_MR, monitored time over mistakes.
    pub mistake_recurrence_s: Measured,
    /// T_M, of the mistakes that ended in trust.
    pub mistake_duration_s: Measured,
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
    pub(super) fn of(records: &[TrialRecord]) -> Self {
        let trials: Vec<&DetectionRecord> = records.iter().map(|record| &record.detection).collect();
        let over_trials = |parts: fn(&DetectionRecord) -> [f64; 2]| {
            let parts: Vec<[f64; 2]> = trials.iter().map(|trial| parts(trial)).collect();
            ratio(&parts)
        };
        let of = |estimate: Estimate, unit: &'static str| Measured {
            estimate,
            unit: unit.into(),
        };
        Self {
            suspicions: Suspicions::of(&trials),
            mistakes: Quantity {
                value: trials.iter().map(|trial| mistakes(trial).count() as u64).sum(),
                unit: SUSPICIONS.into(),
            },
            failures: Failures::of(&trials),
            detection_time_s: of(over_trials(detection_times), SECONDS),
            mistake_recurrence_s: of(
                over_trials(|trial| [trial.monitored_s, mistakes(trial).count() as f64]),
                SECONDS,
            ),
            mistake_duration_s: of(over_trials(durations), SECONDS),
            mistake_rate_hz: of(
                over_trials(|trial| [mistakes(trial).count() as f64, trial.monitored_s]),
                "Hz",
            ),
            query_accuracy: of(
                complement(over_trials(|trial| [trial.mistaken_s, trial.monitored_s])),
                DIMENSIONLESS,
            ),
            monitored_s: Quantity {
                value: trials.iter().map(|trial| trial.monitored_s).sum(),
                unit: SECONDS.into(),
            },
        }
    }
}

/// The suspicions of a trial that were mistakes.
pub(in crate::metrics) fn mistakes(trial: &DetectionRecord) -> impl Iterator<Item = &Suspicion> {
    trial
        .suspicions
        .iter()
        .filter(|suspicion| suspicion.verdict() == Verdict::Mistake)
}

/// The sum of the detection times, and how many there are.
pub(in crate::metrics) fn detection_times(trial: &DetectionRecord) -> [f64; 2] {
    let times = trial.failures.iter().filter_map(|failure| match failure.outcome {
        FailureOutcome::Detected(after) => Some(after.as_secs()),
        FailureOutcome::Recovered | FailureOutcome::ObserverFailed | FailureOutcome::Undetected => None,
    });
    times.fold([0.0, 0.0], |[sum, count], time| [sum + time, count + 1.0])
}

/// The sum of the mistakes' durations, and how many there are.
pub(in crate::metrics) fn durations(trial: &DetectionRecord) -> [f64; 2] {
    let durations = trial.suspicions.iter().filter_map(|suspicion| suspicion.duration);
    durations.fold([0.0, 0.0], |[sum, count], duration| {
        [sum + duration.as_secs(), count + 1.0]
    })
}

/// One less a share, with its interval.
fn complement(share: Estimate) -> Estimate {
    let [low, high] = share.ci95.map(|end| end.map(|end| (1.0 - end).max(0.0)));
    Estimate {
        value: share.value.map(|value| 1.0 - value),
        ci95: [high, low],
        n: share.n,
    }
}

impl Suspicions {
    fn of(trials: &[&DetectionRecord]) -> Self {
        let count = |wanted: &dyn Fn(&Suspicion) -> bool| {
            let all = trials.iter().flat_map(|trial| &trial.suspicions);
            all.filter(|suspicion| wanted(suspicion)).count() as u64
        };
        // Probes are no cause where nobody probes.
        let mut causes = Cause::ALL.to_vec();
        causes.retain(|cause| *cause != Cause::Unanswered || count(&|suspicion| suspicion.cause == *cause) > 0);
        Self {
            value: count(&|_| true),
            by_cause: Named::of(causes.iter().map(|cause| cause.name()), |cause| {
                count(&|suspicion| suspicion.cause == causes[cause])
            }),
            by_verdict: Named::of(Verdict::ALL.map(Verdict::name), |verdict| {
                count(&|suspicion| suspicion.verdict() == Verdict::ALL[verdict])
            }),
            unit: SUSPICIONS.into(),
        }
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
