//! A trial that is ready to be run, but for its robots.

use tokio_util::sync::CancellationToken;

use super::mission::Goal;
use crate::geometry::Pose;
use crate::metrics::TrialRecord;
use crate::motion::DeployError;
use crate::protocol::Protocol;
use crate::simulation::{DriverKind, RunError, Setup};

/// A trial that is ready to be run, but for its robots.
#[derive(Debug)]
pub struct Start<'a> {
    /// The world.
    pub setup: Setup,
    /// Where robots start, in order of ids.
    pub poses: Vec<Pose>,
    /// How robots are run.
    pub driver: DriverKind,
    /// Cancelled when the run is to stop.
    pub stop: &'a CancellationToken,
}

impl Start<'_> {
    /// Runs `robots` to the end, or until they have reached `goal`.
    ///
    /// # Errors
    /// If a message cannot cross the air, or the run is interrupted.
    pub fn run<P: Protocol>(mut self, robots: Vec<P>, goal: Goal) -> Result<TrialRecord, RunError> {
        match goal {
            Goal::None => {}
            Goal::Targets(mission) => self.setup.mission = Some(mission),
            Goal::AllInformed(rumors) => self.setup.rumors = rumors,
        }
        self.setup.run(self.poses, robots, self.driver, self.stop)
    }
}

/// Why a trial has no record.
#[derive(Debug, thiserror::Error)]
pub enum TrialError {
    /// The robots found no room.
    #[error(transparent)]
    Deploy(#[from] DeployError),
    /// The run stopped before its end.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Robots counted what cannot be ([`NotedFigure::fault`](crate::metrics::NotedFigure::fault)).
    #[error("{0}")]
    Counted(String),
}
