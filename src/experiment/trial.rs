//! From a scenario to the record of one of its trials.

use std::sync::{Arc, Mutex, PoisonError};

use tokio_util::sync::CancellationToken;

use crate::engine::{ActorId, Span};
use crate::happenings::{Watch, Watcher};
use crate::kind::{Start, Swarm, TrialError};
use crate::metrics::TrialRecord;
use crate::metrics::detection::StatusTrace;
use crate::motion::deploy;
use crate::radio::RadioKind;
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

/// Runs a trial as [`run_trial`] does while `watch` is told all of it, and gives that back. Whoever watches, the run is the same, digest and all.
///
/// ```
/// use desim::radio::LossCause;
/// use desim::simulation::{Copy, Watch};
///
/// #[derive(Default)]
/// struct Losses(u64);
///
/// impl Watch for Losses {
///     fn lost(&mut self, _: &Copy, _: LossCause, _: desim::engine::SimTime) {
///         self.0 += 1;
///     }
/// }
///
/// let text = std::fs::read_to_string("scenarios/loss20.ron").expect("it ships");
/// let short = ["time_limit=11.0".parse().expect("an override")];
/// let scenario = desim::scenario::parse("loss20.ron", &text, &short).expect("a scenario");
/// let (record, losses) = desim::experiment::watch_trial(&scenario, 0, Losses::default(), &Default::default())?;
/// let lost: u64 = record.ledger.iter().flat_map(|fates| fates.lost).sum();
/// assert_eq!(losses.0, lost);
/// # Ok::<(), desim::experiment::TrialError>(())
/// ```
///
/// # Errors
/// As [`run_trial`].
///
/// # Panics
/// If the scenario's kind of protocol keeps the setup that it was handed when the run is over.
pub fn watch_trial<W: Watch + 'static>(
    scenario: &Scenario,
    trial: u32,
    watch: W,
    stop: &CancellationToken,
) -> Result<(TrialRecord, W), TrialError> {
    let watch = Arc::new(Mutex::new(watch));
    let setup = Setup {
        watcher: Some(Watcher::new(Arc::clone(&watch))),
        ..setup(scenario, trial)
    };
    let record = run(setup, scenario, DriverKind::Inline, stop)?;
    let watch = Arc::into_inner(watch).expect("the setup is gone, and the watcher in it");
    Ok((record, watch.into_inner().unwrap_or_else(PoisonError::into_inner)))
}

/// Runs a trial as [`run_trial`] does, and follows every status of `robot` into [`TrialRecord::trace`], if robots send any.
///
/// # Errors
/// As [`run_trial`].
pub fn trace_trial(
    scenario: &Scenario,
    trial: u32,
    robot: ActorId,
    stop: &CancellationToken,
) -> Result<TrialRecord, TrialError> {
    let (mut record, trace) = watch_trial(scenario, trial, StatusTrace::new(robot), stop)?;
    record.trace = scenario.protocol.has_statuses().then_some(trace);
    Ok(record)
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
        radio: scenario.radio.disk().into_owned(),
        own_radio: scenario
            .radio
            .shared()
            .map(|shared| Arc::new(shared.clone()) as Arc<dyn RadioKind>),
        piggyback: scenario.gossip.piggyback,
        faults: scenario.faults.clone(),
        metrics: scenario.metrics.clone(),
        detector: scenario.detector.clone(),
        status_interval: scenario.circumstances().status_interval,
        watcher: None,
        mission: None,
        rumors: 0,
        completion: scenario.completion(),
        scratch: Scratch::default(),
    }
}
