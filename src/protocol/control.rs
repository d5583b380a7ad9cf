//! When robots wake, and where what they repeat begins.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engine::{ActorId, KeyedStreams, Purpose, Span, Streams};
use crate::quantity::{NonNegative, Positive};

/// Where a rhythm begins, by robot and rhythm: one word.
const PHASE: Purpose = Purpose::new("control.phase");

/// When robots wake.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ControlConfig {
    /// Seconds between the control steps of a robot (paper table 1: dt = 0.1 s).
    pub period: Positive,
    /// How what robots repeat lies against each other's: their control steps, and whatever has an interval of its own.
    pub phase: PhaseConfig,
    /// What wakes a robot beside its control step and its timers.
    pub wake: WakeConfig,
    /// By how many parts in a million the clock of a robot is fast or slow at most: drawn once a robot and trial, evenly. Control steps, timers, the times that it
    /// reads and sends, and slots of its radio go by it. Crystals are within 10 to 50; 0: all clocks are right.
    pub clock_drift: NonNegative,
}

impl Default for ControlConfig {
    fn default() -> Self {
        Self {
            period: Positive::new(0.1),
            phase: PhaseConfig::Random,
            wake: WakeConfig::ControlStep,
            clock_drift: NonNegative::new(0.0),
        }
    }
}

impl ControlConfig {
    /// From one control step of a robot to its next.
    #[must_use]
    pub fn period(&self) -> Span {
        Span::from_secs(self.period.get())
    }

    /// By what share clocks are fast or slow at most.
    #[must_use]
    pub fn drift(&self) -> f64 {
        self.clock_drift.get() * 1e-6
    }
}

/// How what robots repeat lies against each other's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum PhaseConfig {
    /// All robots at once (the paper's simulator): every rhythm begins at the start of the trial. No radio on which frames take
    /// time would bear it.
    Together,
    /// Each robot on its own: every rhythm begins at a random phase of its own interval, drawn once a robot and trial. So
    /// whatever happens at a fixed time falls anywhere between two statuses, two probes or two rounds.
    #[default]
    Random,
}

/// What wakes a robot beside its control step and its timers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum WakeConfig {
    /// Nothing: frames wait in the inbox.
    ControlStep,
    /// Every arrival of a frame.
    OnReception,
}

/// Something that robots repeat. Each has phases of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rhythm {
    /// Control steps.
    ControlStep,
    /// Turns of statuses.
    Status,
    /// Turns of requests.
    Request,
    /// Turns of strands.
    Strand,
    /// Rounds in which news is passed on.
    Relay,
    /// Statuses that say nothing new.
    StatusRefresh,
    /// Strands that say nothing new.
    StrandRefresh,
    /// Probes of a failure detector.
    Probe,
    /// Changes of direction.
    Leg,
    /// What a protocol of one's own repeats: a number for each such thing.
    Own(u8),
}

impl Rhythm {
    /// Its number among all, of which no two share one.
    pub(super) const fn number(self) -> u32 {
        match self {
            Self::ControlStep => 0,
            Self::Status => 1,
            Self::Request => 2,
            Self::Strand => 3,
            Self::Relay => 4,
            Self::StatusRefresh => 5,
            Self::StrandRefresh => 6,
            Self::Probe => 7,
            Self::Leg => 8,
            Self::Own(own) => 256 + own as u32,
        }
    }
}

/// Where each robot's rhythms begin, in one trial.
#[derive(Clone, Copy, Debug)]
pub struct Phases(Option<KeyedStreams>);

impl Phases {
    /// As `config` says, in a trial with these `streams`.
    #[must_use]
    pub fn new(config: PhaseConfig, streams: Streams) -> Self {
        Self(match config {
            PhaseConfig::Together => None,
            PhaseConfig::Random => Some(streams.keyed(PHASE)),
        })
    }

    /// How much of an interval is over when `robot` begins with it: a whole number below `interval`, each as likely, in the unit
    /// of `interval`; 0 for all where they are together.
    #[must_use]
    pub fn of(self, robot: ActorId, rhythm: Rhythm, interval: u64) -> u64 {
        let Some(draws) = self.0.filter(|_| interval > 1) else {
            return 0;
        };
        let [word, _] = draws.first_two(robot.0, rhythm.number(), 0);
        ((u128::from(word) * u128::from(interval)) >> 64) as u64
    }

    /// The same of an interval in time.
    #[must_use]
    pub fn span(self, robot: ActorId, rhythm: Rhythm, interval: Span) -> Span {
        Span::from_nanos(self.of(robot, rhythm, interval.as_nanos()))
    }
}
