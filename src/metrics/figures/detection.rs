//! Failure detection: how soon failures are found, how often robots are mistaken, and for how long.

use super::figure::Better;
use super::registry::Registry;
use crate::metrics::detection::{DetectionRecord, FailureOutcome, Suspicion, Verdict};
use crate::metrics::record::TrialRecord;
use crate::metrics::unit::{DIMENSIONLESS, SECONDS};
use crate::statistics::{Estimator, Observation, Times};

pub(super) fn declare(registry: &mut Registry) {
    let count = |record: &TrialRecord| mistakes(&record.detection).count() as f64;
    registry.add_times("detection.detection_time_s", "detection time T_D", |record| {
        detection_times(&record.detection)
    });
    registry.add_ratio(
        "detection.mistake_rate_hz",
        "mistake rate λ_M",
        ("Hz", Better::Lower, Estimator::Rate),
        move |record| [count(record), record.detection.monitored_s],
    );
    registry.add_ratio(
        "detection.mistake_recurrence_s",
        "mistake recurrence T_MR",
        (SECONDS, Better::Higher, Estimator::Recurrence),
        move |record| [record.detection.monitored_s, count(record)],
    );
    registry.add_times("detection.mistake_duration_s", "mistake duration T_M", |record| {
        mistake_durations(&record.detection)
    });
    let share = (DIMENSIONLESS, Better::Higher, Estimator::Share);
    registry.add_ratio("detection.query_accuracy", "query accuracy P_A", share, |record| {
        let seen = &record.detection;
        [seen.monitored_s - seen.mistaken_s, seen.monitored_s]
    });
}

/// The suspicions of a trial that were mistakes.
fn mistakes(trial: &DetectionRecord) -> impl Iterator<Item = Suspicion> {
    trial
        .suspicions
        .iter()
        .filter(|suspicion| suspicion.verdict() == Verdict::Mistake)
}

/// How long each failure was watched until it was detected, or cut off.
#[must_use]
pub fn detection_times(trial: &DetectionRecord) -> Times {
    let seen = trial.failures.iter().map(|failure| Observation {
        time: failure.watched.as_secs(),
        happened: matches!(failure.outcome, FailureOutcome::Detected(_)),
    });
    seen.collect()
}

/// How long each mistake lasted until trust, or until it was cut off.
#[must_use]
pub fn mistake_durations(trial: &DetectionRecord) -> Times {
    // There may be millions: no more room than they need.
    let mut durations = Times::with_capacity(trial.suspicions.len());
    durations.extend(trial.suspicions.iter().filter_map(|suspicion| {
        Some(Observation {
            time: suspicion.duration?.as_secs(),
            happened: !suspicion.cut_off,
        })
    }));
    durations
}
