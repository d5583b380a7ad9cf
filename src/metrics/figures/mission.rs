//! Missions: how long they take, how often they are complete, whom they take.

use super::figure::{Better, COMPLETION, Sample};
use super::registry::Registry;
use crate::metrics::record::{Outcome, TrialRecord};
use crate::metrics::unit::{DIMENSIONLESS, SECONDS, STEPS};
use crate::statistics::{Estimator, Observation, Times};

pub(super) fn declare(registry: &mut Registry) {
    let steps = (STEPS, Better::Lower, Estimator::Count);
    registry.add(COMPLETION, "steps to completion", steps, |record| {
        completion(record).map_or(Sample::default(), |seen| Sample {
            part: [seen.time, 1.0],
            is_censored: !seen.happened,
            times: Times::default(),
        })
    });
    let seconds = (SECONDS, Better::Lower, Estimator::Count);
    registry
        .add("completion_s", "time to completion", seconds, |record| {
            let until = match record.outcome {
                Outcome::Completed { step } => step as f64 * record.control_period.as_secs(),
                Outcome::Censored => record.simulated.as_secs(),
                Outcome::NoMission => return Sample::default(),
            };
            Sample {
                is_censored: record.outcome == Outcome::Censored,
                ..Sample::plain(Some(until))
            }
        })
        .list();
    let share = (DIMENSIONLESS, Better::Higher, Estimator::Share);
    registry.add_plain("completion_ratio", "trials completed", share, |record| {
        completion(record).map(|seen| f64::from(u8::from(seen.happened)))
    });
    let robots = ("robots", Better::Lower, Estimator::Count);
    registry.add_plain("robots_used", "robots used", robots, |record| {
        record.robots_used().map(|robots| robots as f64)
    });
}

/// Control steps until the mission of a trial was complete, or that it was watched in vain; `None` without a mission.
pub(in crate::metrics) fn completion(record: &TrialRecord) -> Option<Observation> {
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
