//! From a scenario to the record of one of its trials.

use std::rc::Rc;

use tokio_util::sync::CancellationToken;

use super::run::RunError;
use super::setup::{DriverKind, Setup};
use crate::engine::Span;
use crate::metrics::{Mission, TrialRecord};
use crate::motion::{DeployError, deploy};
use crate::protocol::backbone::{self, BackboneConfig};
use crate::protocol::heartbeat::{Heartbeat, Settings};
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
    let setup = setup(scenario, trial);
    let poses = deploy(
        &scenario.swarm.deploy,
        &scenario.arena,
        scenario.swarm.robots,
        scenario.motion.body_radius.get(),
        &setup.streams(),
    )?;
    let period = Span::from_secs(scenario.control.period.get());
    let record = match &scenario.protocol {
        ProtocolConfig::Backbone(config) => {
            let robots = backbone::swarm(config, &scenario.gossip, &scenario.detector, period, &poses);
            setup.run(poses, robots, driver, stop)
        }
        ProtocolConfig::Heartbeat => {
            let settings = Rc::new(Settings::new(&scenario.gossip, &scenario.detector, period));
            let robots = poses.iter().map(|_| Heartbeat::new(Rc::clone(&settings))).collect();
            setup.run(poses, robots, driver, stop)
        }
    }?;
    Ok(record)
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
        metrics: scenario.metrics.clone(),
        mission: match &scenario.protocol {
            ProtocolConfig::Backbone(config) => Some(mission(config)),
            ProtocolConfig::Heartbeat => None,
        },
    }
}
