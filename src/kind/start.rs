//! A trial that is ready to be run, but for its robots.

use tokio_util::sync::CancellationToken;

use super::mission::Goal;
use crate::geometry::Pose;
use crate::metrics::TrialRecord;
use crate::motion::DeployError;
use crate::protocol::Protocol;
use crate::simulation::{DriverKind, Finished, Observer, RunError, Setup};

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
    pub fn run<P: Protocol>(self, robots: Vec<P>, goal: Goal) -> Result<TrialRecord, RunError> {
        let finished = self.observe(robots, goal, ());
        finished.map(|finished| finished.record)
    }

    /// Runs `robots` as [`run`](Self::run) does while `observer` watches. What it saw can become figures as what robots noted does: here the time
    /// of the last word of a run, which no robot knows.
    ///
    /// ```
    /// use desim::engine::{ActorId, SimTime};
    /// use desim::kind::{Goal, Kind, Start, Swarm};
    /// use desim::metrics::{Noted, NotedFigure, TrialRecord};
    /// use desim::protocol::{Input, Output, Protocol, Serialised};
    /// use desim::simulation::{Observer, RunError, Sent};
    /// # use desim::experiment::run_trial;
    /// # use desim::scenario::parse;
    /// # use desim::simulation::DriverKind;
    /// # use schemars::JsonSchema;
    /// # use serde::{Deserialize, Serialize};
    /// #
    /// # #[derive(Default)]
    /// # struct Robot(u32);
    /// #
    /// # impl Protocol for Robot {
    /// #     type Message = u8;
    /// #     type Heard = u8;
    /// #     type Codec = Serialised<u8>;
    /// #     const TOPICS: &'static [&'static str] = &["word"];
    /// #     const ROLES: &'static [&'static str] = &["robot"];
    /// #
    /// #     fn step(&mut self, _: SimTime, _: &mut Input<u8>, output: &mut Output<u8>) {
    /// #         self.0 += 1;
    /// #         if self.0 <= 30 {
    /// #             output.broadcast(0);
    /// #         }
    /// #     }
    /// # }
    ///
    /// #[derive(Default)]
    /// struct LastWord(SimTime);
    ///
    /// impl Observer for LastWord {
    ///     fn sent(&mut self, message: &Sent<'_>) {
    ///         self.0 = message.at;
    ///     }
    /// }
    ///
    /// # #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    /// # struct Talk;
    /// impl Kind for Talk {
    ///     // ...
    /// #     const NAME: &'static str = "Talk";
    /// #     type Robot = Robot;
    /// #
    /// #     fn robots(&self, swarm: &Swarm<'_>) -> Vec<Robot> {
    /// #         swarm.each(|_| Robot::default())
    /// #     }
    /// #
    ///     fn run(&self, swarm: &Swarm<'_>, start: Start<'_>) -> Result<TrialRecord, RunError> {
    ///         let finished = start.observe(self.robots(swarm), Goal::None, LastWord::default())?;
    ///         let mut record = finished.record;
    ///         record.note(Noted::measured("last_word", ActorId(0), [finished.observer.0.as_secs()]));
    ///         Ok(record)
    ///     }
    ///
    ///     fn figures(&self) -> Vec<NotedFigure> {
    ///         vec![NotedFigure::mean("last_word_s", "last word", "s", "last_word")]
    ///     }
    /// }
    /// #
    /// # desim::kinds::add::<Talk>();
    /// # let scenario = parse("t.ron", "Scenario(name: \"t\", swarm: (robots: 2, deploy: Uniform), protocol: Talk, control: (phase: Together), time_limit: 9.0)", &[]).unwrap();
    /// # let record = run_trial(&scenario, 0, DriverKind::Inline, &Default::default()).unwrap();
    /// # let figures = scenario.figures();
    /// # let seen = figures.figures().zip(figures.read(&record)).find(|(figure, _)| figure.key == "noted.last_word_s");
    /// # assert!((seen.unwrap().1.value().unwrap() - 2.9).abs() < 1e-9);
    /// ```
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn observe<P: Protocol, O: Observer>(
        mut self,
        robots: Vec<P>,
        goal: Goal,
        observer: O,
    ) -> Result<Finished<P, O>, RunError> {
        match goal {
            Goal::None => {}
            Goal::Targets(mission) => self.setup.mission = Some(mission),
            Goal::AllInformed(rumors) => self.setup.rumors = rumors,
        }
        self.setup.observe(self.poses, robots, self.driver, self.stop, observer)
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
