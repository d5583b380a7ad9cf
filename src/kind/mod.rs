//! What a protocol says of itself so that it can stand in a scenario: a [`Kind`] is what `protocol: Name(...)` means.
//!
//! A kind is a config, read from the scenario file field by field, that makes the robots of a swarm. Everything else has a
//! default: what it checks, what completes its mission, what closed forms expect of it. [`crate::kinds::add`] puts a kind
//! beside those that desim ships; every command then knows it.
//!
//! ```
//! use desim::engine::SimTime;
//! use desim::kind::{Kind, Sections, Swarm};
//! use desim::protocol::{Input, Output, Protocol, Serialised, Wake};
//! use schemars::JsonSchema;
//! use serde::{Deserialize, Serialize};
//!
//! /// Robots that all say one number at each of their control steps.
//! #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
//! #[serde(deny_unknown_fields, default)]
//! struct Beep {
//!     /// What they say.
//!     tone: u8,
//! }
//!
//! impl Default for Beep {
//!     fn default() -> Self {
//!         Self { tone: 1 }
//!     }
//! }
//!
//! struct Robot(u8);
//!
//! impl Protocol for Robot {
//!     type Message = u8;
//!     type Heard = u8;
//!     type Codec = Serialised<u8>;
//!     const TOPICS: &'static [&'static str] = &["beep"];
//!     const ROLES: &'static [&'static str] = &["robot"];
//!
//!     fn step(&mut self, _: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
//!         if input.wake == Wake::ControlStep {
//!             output.broadcast(self.0);
//!         }
//!     }
//! }
//!
//! impl Kind for Beep {
//!     const NAME: &'static str = "Beep";
//!     type Robot = Robot;
//!
//!     fn robots(&self, swarm: &Swarm<'_>) -> Vec<Robot> {
//!         swarm.each(|_| Robot(self.tone))
//!     }
//!
//!     // What no type says: a path from the config on, and what is wrong there.
//!     fn problems(&self, _: &Sections<'_>) -> Vec<(String, String)> {
//!         let silent = self.tone == 0;
//!         silent.then(|| ("tone".to_owned(), "0 is no tone".to_owned())).into_iter().collect()
//!     }
//! }
//!
//! desim::kinds::add::<Beep>();
//! let text = "Scenario(name: \"beep\", time_limit: 9.0, swarm: (robots: 4, deploy: Uniform), protocol: Beep(tone: 7))";
//! let scenario = desim::scenario::parse("beep.ron", text, &[])?;
//! assert_eq!(scenario.protocol.name(), "Beep");
//!
//! // A field that the kind does not have is found at its place, with the nearest that it has; and so is what it refuses.
//! let faults = |text: &str| desim::scenario::parse("beep.ron", text, &[]).unwrap_err().to_string();
//! assert!(faults(&text.replace("tone", "tune")).contains("did you mean `tone`?"));
//! assert!(faults(&text.replace("tone: 7", "tone: 0")).contains("`protocol.tone`: 0 is no tone"));
//! # Ok::<(), desim::scenario::Report>(())
//! ```

mod any;

mod mission;
mod prediction;
mod problem;
mod sections;
mod shared;
mod start;
pub mod targets;

use std::fmt::Debug;

use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

pub use any::{AnyKind, Entry, ReadConfig, RonReader};
pub use mission::{Goal, InPieces, Targets};
pub use prediction::{Broadcasts, Expected, Holds, Prediction, Unpredicted};
pub use problem::Problem;
pub use sections::{Sections, Swarm};
pub use shared::Shared;
pub use start::{Start, TrialError};

use crate::metrics::{NotedFigure, TrialRecord};
use crate::protocol::detector::DetectorConfig;
use crate::protocol::{CompletionConfig, Layout, Protocol};
use crate::simulation::RunError;

/// A kind of protocol: what a scenario names, and what is said of it field by field. [The module](self) has an example, and so has
/// [the crate's page](crate#name-it-in-a-scenario).
///
/// Most kinds need no more than [`robots`](Self::robots), [`figures`](Self::figures) and [`problems`](Self::problems), and, if their robots stand
/// still, [`moves`](Self::moves). The rest is for missions, for settings that desim's own protocols share, and for what closed forms expect.
///
/// The config's doc comments are what editors and messages show, from its JSON Schema. It should be a struct with
/// `deny_unknown_fields`, so that a misspelt field is refused; a unit struct is named without brackets.
pub trait Kind: Clone + Debug + PartialEq + Serialize + DeserializeOwned + JsonSchema + Send + Sync + 'static {
    /// What scenarios call it: a name as Rust's types have it, such as `Flood`.
    const NAME: &'static str;

    /// What robots run.
    type Robot: Protocol;

    /// The robots of a swarm, in order of their ids.
    fn robots(&self, swarm: &Swarm<'_>) -> Vec<Self::Robot>;

    /// How its messages lie in their bytes, for those who look at frames: not described, by default. It takes no part in a run.
    #[must_use]
    fn layout() -> Layout {
        Layout::default()
    }

    /// What completes the mission of `robots`, those of a trial before its start: nothing, by default.
    fn goal(&self, robots: &[Self::Robot]) -> Goal {
        let _ = robots;
        Goal::None
    }

    /// Runs a trial. To be written by a kind that has robots of several types for one config, or that wants every trial of a scenario
    /// [observed](Start::observe): what only an observer can know may be added to the record ([`TrialRecord::note`]) and have figures. Others make
    /// [`robots`](Self::robots) and say their [`goal`](Self::goal).
    ///
    /// # Errors
    /// If the run stops before its end.
    fn run(&self, swarm: &Swarm<'_>, start: Start<'_>) -> Result<TrialRecord, RunError> {
        let robots = self.robots(swarm);
        let goal = self.goal(&robots);
        start.run(robots, goal)
    }

    /// What its mission asks of the swarm, in words that go on "no trial can complete: ", such as `targets must be held`.
    /// None, the default, for a kind without a mission.
    #[must_use]
    fn mission(&self) -> Option<&'static str> {
        None
    }

    /// When the mission is complete, if this config says so; else `metrics.hold` does.
    #[must_use]
    fn completion(&self) -> Option<CompletionConfig> {
        None
    }

    /// The same config, its mission complete when `completion` says. None, the default, where the config has no such field.
    #[must_use]
    fn completed_by(&self, completion: CompletionConfig) -> Option<Self> {
        let _ = completion;
        None
    }

    /// The shared settings of a scenario that robots heed: none, by default. The others are refused where they are set, for
    /// they would do nothing.
    fn heeds(&self, sections: &Sections<'_>) -> &'static [Shared] {
        let _ = sections;
        &[]
    }

    /// Why robots do not heed a setting, in words that go on "does not heed it: ".
    fn unheeded(&self, setting: Shared) -> &'static str {
        let _ = setting;
        "its robots do not ask for it"
    }

    /// Whether robots move by themselves, so that nothing is said of where they are later: those that do not heed
    /// [`Shared::Wander`], by default.
    fn moves(&self, sections: &Sections<'_>) -> bool {
        !self.heeds(sections).contains(&Shared::Wander)
    }

    /// What is wrong with the config in this scenario, whose other sections are sound: a path from the config on, such as
    /// `targets[0].at`, and what is wrong.
    fn problems(&self, sections: &Sections<'_>) -> Vec<(String, String)> {
        let _ = sections;
        Vec::new()
    }

    /// What is wrong between the config and other sections, at whole paths, where all counts and periods are sound.
    fn conflicts(&self, sections: &Sections<'_>) -> Vec<Problem> {
        let _ = sections;
        Vec::new()
    }

    /// What is allowed and hardly meant; `completion` is when the mission is complete.
    fn warnings(&self, sections: &Sections<'_>, completion: CompletionConfig) -> Vec<Problem> {
        let _ = (sections, completion);
        Vec::new()
    }

    /// The targets of its mission, for pictures and for words about why a mission failed.
    fn targets(&self) -> Option<Targets> {
        None
    }

    /// A robot that no fault may take, and what it is called.
    fn reserved(&self) -> Option<(u32, &'static str)> {
        None
    }

    /// What becomes of a swarm that does not stand in one piece: nothing worth a word, by default.
    fn in_pieces(&self, sections: &Sections<'_>) -> Option<InPieces> {
        let _ = sections;
        None
    }

    /// Frames that a robot sends in a second at most, statuses and the detector's probes not counted: for the estimate of memory
    /// and time. One a control step, by default.
    fn frames_a_second(&self, sections: &Sections<'_>) -> f64 {
        1.0 / sections.control.period.get()
    }

    /// Seconds within which a robot is sure to wake by a timer of its own, if it is; control steps are counted elsewhere.
    fn wakes_within(&self, sections: &Sections<'_>) -> Option<f64> {
        let _ = sections;
        None
    }

    /// Whether what it sends by `gossip.relay` goes out at control steps.
    fn relays_in_steps(&self) -> bool {
        true
    }

    /// Payload bytes of a status, if all are of one length: for what closed forms say of their cost.
    fn status_bytes(&self) -> Option<f64> {
        None
    }

    /// Whether robots send nothing but statuses.
    fn sends_statuses_alone(&self, sections: &Sections<'_>) -> bool {
        let _ = sections;
        false
    }

    /// The one steady stream that robots send, if they send nothing beside: for what closed forms say of the air. Kinds that send statuses
    /// [alone](Self::sends_statuses_alone) need not say it again.
    fn broadcasts(&self, sections: &Sections<'_>) -> Option<Broadcasts> {
        let _ = sections;
        None
    }

    /// What closed forms say of a run, beside what they say of every swarm.
    fn predict(&self, sections: &Sections<'_>) -> Expected {
        let _ = sections;
        Expected::default()
    }

    /// Figures of what robots count and measure: in the summary, the report, the page, and to be compared in studies as `noted.<key>`.
    fn figures(&self) -> Vec<NotedFigure> {
        Vec::new()
    }

    /// Names of the topics in use where robots run `detector`.
    fn topics(&self, detector: &DetectorConfig) -> &'static [&'static str] {
        Self::Robot::topics(detector)
    }
}
