//! From a scenario to the record of one of its trials.

use tokio_util::sync::CancellationToken;

use crate::engine::{ActorId, Span};
use crate::kind::{Start, Swarm, TrialError};
use crate::metrics::TrialRecord;
use crate::motion::deploy;
use crate::radio::Reach;
use crate::scenario::Scenario;
use crate::simulation::{DriverKind, Setup};
use crate::spool::Scratch;

/// Runs trial number `trial` of `scenario`, until `stop` is cancelled.
///
/// # Errors
/// If the robots find no room, or the run stops before its end, or robots counted more of a part than of the whole.
pub fn run_trial(
    scenario: &Scenario,
    trial: u32,
    driver: DriverKind,
    stop: &CancellationToken,
) -> Result<TrialRecord, TrialError> {
    run_trial_in(&Scratch::default(), scenario, trial, driver, stop)
}

/// Runs a trial as [`run_trial`] does, and keeps in `scratch` what of its record would fill the memory.
///
/// # Errors
/// As [`run_trial`].
pub fn run_trial_in(
    scratch: &Scratch,
    scenario: &Scenario,
    trial: u32,
    driver: DriverKind,
    stop: &CancellationToken,
) -> Result<TrialRecord, TrialError> {
    let setup = Setup {
        scratch: scratch.clone(),
        ..setup(scenario, trial)
    };
    run(setup, scenario, driver, stop)
}

/// Runs a trial as [`run_trial`] does, and follows every status of `robot` into [`TrialRecord::trace`]. Whoever is
/// followed, the run is the same, digest and all.
///
/// # Errors
/// As [`run_trial`].
pub fn trace_trial(
    scenario: &Scenario,
    trial: u32,
    robot: ActorId,
    stop: &CancellationToken,
) -> Result<TrialRecord, TrialError> {
    let setup = Setup {
        trace: Some(robot),
        ..setup(scenario, trial)
    };
    run(setup, scenario, DriverKind::Inline, stop)
}

/// Who was in range of whom in a trial, from where robots were: what its record's links are.
#[must_use]
pub fn reach(scenario: &Scenario, trial: u32) -> Reach {
    setup(scenario, trial).reach(scenario.swarm.robots as usize)
}

fn run(
    setup: Setup,
    scenario: &Scenario,
    driver: DriverKind,
    stop: &CancellationToken,
) -> Result<TrialRecord, TrialError> {
    let streams = setup.streams();
    let swarm = &scenario.swarm;
    let body_radius = scenario.motion.body_radius.get();
    let poses = deploy(&swarm.deploy, &scenario.arena, swarm.robots, body_radius, &streams)?;
    let swarm = Swarm {
        poses: &poses,
        sections: scenario.sections(),
        streams,
    };
    let start = Start {
        setup,
        poses: poses.clone(),
        driver,
        stop,
    };
    let record = scenario.protocol.run(&swarm, start)?;
    let mut figures = scenario.protocol.figures().into_iter();
    match figures.find_map(|figure| figure.fault(&record)) {
        Some(fault) => Err(TrialError::Counted(fault)),
        None => Ok(record),
    }
}

fn setup(scenario: &Scenario, trial: u32) -> Setup {
    Setup {
        seed: scenario.seed,
        trial,
        time_limit: Span::from_secs(scenario.time_limit.get()),
        arena: scenario.arena.clone(),
        motion: scenario.motion.clone(),
        control: scenario.control.clone(),
        radio: scenario.radio.clone(),
        own_radio: None,
        piggyback: scenario.gossip.piggyback,
        faults: scenario.faults.clone(),
        metrics: scenario.metrics.clone(),
        detector: scenario.detector.clone(),
        status_interval: scenario.circumstances().status_interval,
        trace: None,
        mission: None,
        rumors: 0,
        completion: scenario.completion(),
        scratch: Scratch::default(),
    }
}
