//! What a run is made of, for those who bring their own protocol.

use std::str::FromStr;
use std::sync::Arc;

use tokio_util::sync::CancellationToken;

use super::air::Air;
use super::clock::ControlSteps;
use super::digest::Digest;
use super::error::RunError;
use super::places::site;
use super::run::{Ended, Rhythm, Run};
use crate::engine::{ActorId, Actors, Clocks, Driver, Inline, Purpose, SimTime, Span, Streams, block_on};
use crate::faults::{FaultConfig, Faults};
use crate::geometry::Pose;
use crate::happenings::{Observer, Vocabulary, Watcher, Watching};
use crate::metrics::{HeaderBytes, Layout, MetricsConfig, Mission, Recorder, RunEnd, TrialRecord};
use crate::motion::{ArenaConfig, MotionConfig, World};
use crate::protocol::control::{ControlConfig, Phases, Rhythm as Repeated, WakeConfig};
use crate::protocol::detector::{Circumstances, DetectorConfig};
use crate::protocol::{CompletionConfig, Protocol, Robot, Start};
use crate::radio::{DiskConfig, Medium, RadioKind, Reach};
use crate::spool::Scratch;

/// By how much the clock of each robot is fast: one word a robot.
const CLOCKS: Purpose = Purpose::new("control.clocks");

/// How robots are run. Both give the same results, byte for byte.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DriverKind {
    /// A tokio task and a mailbox a robot.
    #[default]
    Actors,
    /// Direct calls: faster, and easier to step through in a debugger.
    Inline,
}

impl FromStr for DriverKind {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "actors" => Ok(Self::Actors),
            "inline" => Ok(Self::Inline),
            other => Err(format!("no driver is called `{other}`: use `actors` or `inline`")),
        }
    }
}

/// The observers of every run: what makes its record.
type Books = (Recorder, Digest);

/// The world that robots are put into, for a run without a scenario: [the crate's page](crate#watch-it) has an example. Lengths are in metres
/// from the arena's centre. A [`Scenario`](crate::scenario::Scenario) makes one for each trial.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// Seed of every random stream.
    pub seed: u64,
    /// Number of the trial: other trials of the same seed draw other numbers. Settings that differ in other fields have common ones.
    pub trial: u32,
    /// When the run ends at the latest.
    pub time_limit: Span,
    /// The arena.
    pub arena: ArenaConfig,
    /// How robots move.
    pub motion: MotionConfig,
    /// When robots wake.
    pub control: ControlConfig,
    /// The disk radio.
    pub radio: DiskConfig,
    /// A radio of the program's own, in place of the disk radio: then nothing of `radio` counts but the bytes of headers.
    pub own_radio: Option<Arc<dyn RadioKind>>,
    /// Whether all messages of a wake go out in one frame.
    pub piggyback: bool,
    /// How robots and links fail.
    pub faults: Vec<FaultConfig>,
    /// What is measured.
    pub metrics: MetricsConfig,
    /// The failure detector that robots run, if they run one: so far back are suspicions traced to what became of the statuses. It is told
    /// here and given to the robots by who makes them.
    pub detector: DetectorConfig,
    /// The longest pause that a robot makes between two statuses; zero if it sends none.
    pub status_interval: Span,
    /// Who watches beside the observer, whatever the protocol; the run is then driven inline.
    pub watcher: Option<Watcher>,
    /// What counts as completion, if anything does.
    pub mission: Option<Mission>,
    /// How many rumours all robots are to know, which then is completion; 0 for none.
    pub rumors: usize,
    /// When the mission, or the spread of the rumours, is complete.
    pub completion: CompletionConfig,
    /// Where what a record keeps of long runs has its files.
    pub scratch: Scratch,
}

impl Setup {
    /// The default world for so long: an empty arena of 10 × 10 m, a radio that loses nothing, no mission.
    #[must_use]
    pub fn lasting(time_limit: Span) -> Self {
        Self {
            time_limit,
            ..Self::default()
        }
    }

    /// The random streams of this run.
    #[must_use]
    pub fn streams(&self) -> Streams {
        Streams::new(self.seed, self.trial)
    }

    /// Who is in range of whom in a run of so many robots.
    ///
    /// # Panics
    /// If the radio's config has problems: a scenario is checked before it is run.
    #[must_use]
    pub fn reach(&self, robots: usize) -> Reach {
        self.medium(robots).reach()
    }

    /// Puts `robots` at `poses`, in order of their numbers, and runs them to the end, or until `stop` is cancelled.
    ///
    /// # Errors
    /// If a message cannot cross the air, a robot measures what is no number, or the run is interrupted.
    ///
    /// # Panics
    /// If there are not as many poses as robots, or a config has problems: a scenario is checked before it is run. If a robot names a topic or a
    /// role that its protocol does not have.
    pub fn run<P: Protocol>(
        &self,
        poses: Vec<Pose>,
        robots: Vec<P>,
        driver: DriverKind,
        stop: &CancellationToken,
    ) -> Result<TrialRecord, RunError> {
        let finished = self.observe(poses, robots, driver, stop, ());
        finished.map(|finished| finished.record)
    }

    /// Runs robots as [`run`](Self::run) does while `observer` watches: an [`Observer`] or a mutable reference to one. The run is the same, its
    /// record and digest too, whoever watches, but for one that [ends](Observer::judge) it.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    ///
    /// # Panics
    /// As [`run`](Self::run).
    pub fn observe<P: Protocol, O: Observer>(
        &self,
        poses: Vec<Pose>,
        robots: Vec<P>,
        driver: DriverKind,
        stop: &CancellationToken,
        observer: O,
    ) -> Result<Finished<P, O>, RunError> {
        assert_eq!(poses.len(), robots.len(), "every robot needs a pose");
        let swarm = robots.len();
        let clocks = self.clocks(swarm);
        let started = |(mut robot, number): (P, u32)| {
            robot.start(Start {
                me: ActorId(number),
                robots: swarm,
            });
            Robot::new(robot, &clocks)
        };
        let robots = robots.into_iter().zip(0..).map(started).collect();
        let medium = self.medium(swarm);
        let recorder = Recorder::new(self.layout::<P>(swarm, medium.reach()), &self.metrics);
        let books = (recorder, Digest::new());
        // Held for all of the run, and alone.
        let mut watcher = self.watcher.as_ref().map(Watcher::lock);
        let run = async {
            match (watcher.as_deref_mut(), driver) {
                // Watched or not is decided here, and not at every copy.
                (Some(watch), _) => {
                    let vocabulary = Vocabulary {
                        topics: P::topics(&self.detector),
                        roles: P::ROLES,
                        status: P::STATUS,
                    };
                    let observers = (books, (Watching { watch, vocabulary }, observer));
                    let ended = self
                        .run_with(poses, medium, Inline::new(robots), observers, stop)
                        .await?;
                    let Finished {
                        record,
                        robots,
                        observer: (_, observer),
                    } = self.finished(ended);
                    Ok(Finished {
                        record,
                        robots,
                        observer,
                    })
                }
                (None, DriverKind::Actors) => {
                    let robots = Actors::spawn(robots);
                    let ended = self.run_with(poses, medium, robots, (books, observer), stop).await?;
                    Ok(self.finished(ended))
                }
                (None, DriverKind::Inline) => {
                    let robots = Inline::new(robots);
                    let ended = self.run_with(poses, medium, robots, (books, observer), stop).await?;
                    Ok(self.finished(ended))
                }
            }
        };
        block_on(run).map_err(RunError::Runtime)?
    }

    async fn run_with<P: Protocol, D: Driver<Robot<P>>, O: Observer>(
        &self,
        poses: Vec<Pose>,
        medium: Box<dyn Medium>,
        driver: D,
        observer: O,
        stop: &CancellationToken,
    ) -> Result<Ended<P, O>, RunError> {
        let streams = self.streams();
        let robots = poses.len();
        let control_steps = ControlSteps::new(
            &self.first_steps(robots, streams),
            self.control.period(),
            self.clocks(robots),
        );
        let world = World::new(&self.motion, &self.arena, poses, medium.reach().farthest());
        let rhythm = self.rhythm();
        let air = Air::<P>::new(
            medium,
            robots,
            self.headers::<P>(),
            self.piggyback,
            rhythm.wake_on_reception,
        );
        let faults = Faults::new(&self.faults, P::ROLES, robots, rhythm.control_period, streams);
        let run = Run::new(rhythm, driver, world, air, faults, observer, streams, control_steps);
        run.until_end(stop).await
    }

    /// What users get of a run that ended.
    fn finished<P, O>(&self, ended: Ended<P, (Books, O)>) -> Finished<P, O> {
        let ((recorder, digest), observer) = ended.observer;
        let record = recorder.finish(RunEnd {
            trial: self.trial,
            seed: self.seed,
            steps: ended.steps,
            simulated: ended.at,
            events: ended.events,
            digest: digest.finish(),
            robot_steps: ended.robot_steps,
            poses: ended.poses,
        });
        Finished {
            record,
            robots: ended.robots,
            observer,
        }
    }

    fn rhythm(&self) -> Rhythm {
        Rhythm {
            control_period: self.control.period(),
            sample_interval: Span::from_secs(self.metrics.sample_interval.get()),
            time_limit: SimTime::ZERO + self.time_limit,
            wake_on_reception: self.control.wake == WakeConfig::OnReception,
        }
    }

    /// The radio of this run.
    fn medium(&self, robots: usize) -> Box<dyn Medium> {
        let radio = self.own_radio.as_deref().unwrap_or(&self.radio);
        let body_radius = self.motion.body_radius.get();
        let skews = self.clocks(robots).skews().to_vec();
        radio.medium(&site(self.streams(), robots, &self.arena, body_radius, skews))
    }

    fn headers<P: Protocol>(&self) -> HeaderBytes {
        let topics = P::topics(&self.detector).len();
        let own = self.own_radio.as_ref();
        let [frame, message] = own
            .and_then(|radio| radio.header_bytes(topics, self.piggyback))
            .unwrap_or([self.radio.frame_header_bytes, self.radio.message_header_bytes]);
        HeaderBytes { frame, message }
    }

    fn layout<P: Protocol>(&self, robots: usize, reach: Reach) -> Layout {
        let circumstances = Circumstances {
            robots,
            status_interval: self.status_interval,
        };
        Layout {
            robots,
            topics: P::topics(&self.detector).len(),
            roles: P::ROLES.len(),
            headers: self.headers::<P>(),
            reach,
            control_period: self.control.period(),
            mission: self.mission.clone(),
            rumors: self.rumors,
            completion: self.completion,
            // A status may be that much older than the silence that it began, when its latency is long.
            status_memory: self.detector.longest_silence(circumstances) * 2,
            patience: self.detector.usual_silence(circumstances),
            status: P::STATUS,
            scratch: self.scratch.clone(),
        }
    }

    /// The clocks of so many robots.
    fn clocks(&self, robots: usize) -> Clocks {
        Clocks::drawn(self.control.drift(), robots, self.streams().keyed(CLOCKS))
    }

    /// When each robot takes its first control step, by its own clock.
    fn first_steps(&self, robots: usize, streams: Streams) -> Vec<SimTime> {
        let phases = Phases::new(self.control.phase, streams);
        let first = |robot| SimTime::ZERO + phases.span(ActorId(robot), Repeated::ControlStep, self.control.period());
        (0..robots as u32).map(first).collect()
    }
}

/// A run that reached its end.
#[derive(Debug)]
pub struct Finished<P, O> {
    /// What it left behind.
    pub record: TrialRecord,
    /// The robots as they are now, in order of ids.
    pub robots: Vec<P>,
    /// Whoever watched.
    pub observer: O,
}
