//! From a scenario to the record of one of its trials.

use std::convert::Infallible;
use std::rc::Rc;

use tokio_util::sync::CancellationToken;

use super::error::RunError;
use super::setup::{DriverKind, Setup};
use crate::engine::{ActorId, Span, Streams};
use crate::geometry::Vec2;
use crate::kinds::backbone::{self, BackboneConfig};
use crate::kinds::heartbeat::{Heartbeat, Settings};
use crate::kinds::rumor;
use crate::metrics::{Mission, MissionTarget, TrialRecord};
use crate::motion::{DeployError, deploy};
use crate::protocol::detector::Probe;
use crate::protocol::wander::Ground;
use crate::scenario::{ProtocolConfig, Scenario};

/// Why a trial has no record.
#[derive(Debug, thiserror::Error)]
pub enum TrialError {
    /// The robots found no room.
    #[error(transparent)]
    Deploy(#[from] DeployError),
    /// The run stopped before its end.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// Runs trial number `trial` of `scenario`, until `stop` is cancelled.
///
/// # Errors
/// If the robots find no room, or the run stops before its end.
pub fn run_trial(
    scenario: &Scenario,
    trial: u32,
    driver: DriverKind,
    stop: &CancellationToken,
) -> Result<TrialRecord, TrialError> {
    run(scenario, trial, None, driver, stop)
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
    run(scenario, trial, Some(robot), DriverKind::Inline, stop)
}

fn run(
    scenario: &Scenario,
    trial: u32,
    trace: Option<ActorId>,
    driver: DriverKind,
    stop: &CancellationToken,
) -> Result<TrialRecord, TrialError> {
    let mut setup = Setup {
        trace,
        ..setup(scenario, trial)
    };
    let body_radius = scenario.motion.body_radius.get();
    let swarm = &scenario.swarm;
    let poses = deploy(
        &swarm.deploy,
        &scenario.arena,
        swarm.robots,
        body_radius,
        &setup.streams(),
    )?;
    let control = &scenario.control;
    let streams = setup.streams();
    let record = match &scenario.protocol {
        ProtocolConfig::Backbone(config) => {
            let robots = backbone::swarm(config, &scenario.gossip, &scenario.detector, control, &poses, streams);
            setup.mission = robots.first().map(|robot| mission(config, robot.root()));
            setup.run(poses, robots, driver, stop)
        }
        ProtocolConfig::Heartbeat => {
            let settings = Settings::new(&scenario.gossip, &scenario.detector, control, poses.len(), streams);
            let settings = Rc::new(settings.wandering(ground(scenario, streams)));
            if scenario.detector.sends() {
                let robots = heartbeats::<Rc<Probe>>(swarm.robots, &settings);
                setup.run(poses, robots, driver, stop)
            } else {
                let robots = heartbeats::<Infallible>(swarm.robots, &settings);
                setup.run(poses, robots, driver, stop)
            }
        }
        ProtocolConfig::Rumor(config) => {
            let ground = ground(scenario, streams);
            let robots = rumor::swarm(config, &scenario.gossip, control, swarm.robots, ground, streams);
            setup.rumors = config.sources.rumors();
            setup.run(poses, robots, driver, stop)
        }
    }?;
    Ok(record)
}

/// Where robots of a protocol without a motion of its own go.
fn ground(scenario: &Scenario, streams: Streams) -> Ground {
    let (width, height) = &scenario.arena.size;
    let size = Vec2::new(width.get(), height.get());
    let body_radius = scenario.motion.body_radius.get();
    Ground::new(scenario.wander, size, body_radius, &scenario.control, streams)
}

/// Robots whose messages carry what their detectors say by `P`.
fn heartbeats<P>(robots: u32, settings: &Rc<Settings>) -> Vec<Heartbeat<P>> {
    let ids = (0..robots).map(ActorId);
    ids.map(|id| Heartbeat::new(id, Rc::clone(settings))).collect()
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
        piggyback: scenario.gossip.piggyback,
        faults: scenario.faults.clone(),
        metrics: scenario.metrics.clone(),
        detector: scenario.detector.clone(),
        status_interval: scenario.circumstances().status_interval,
        trace: None,
        mission: None,
        rumors: 0,
        completion: scenario.completion(),
    }
}

/// What the metrics judge: every target held, with its links (paper eqs. 2 to 5).
fn mission(config: &BackboneConfig, root: ActorId) -> Mission {
    let targets = config.targets().into_iter().map(|(position, links)| MissionTarget {
        position,
        links: u32::from(links),
    });
    Mission {
        targets: targets.collect(),
        reach: config.movement_threshold.get(),
        link_limit: config.critical_distance.get(),
        root,
        worker_role: backbone::Role::Worker.index(),
    }
}
