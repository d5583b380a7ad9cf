//! desim runs a robot swarm's own protocol over a radio that loses and delays frames, while the robots move, and says
//! what that cost and how sure it is.
//!
//! Who only runs what desim ships needs the command and a scenario file; the README is theirs. This page is for those who bring a
//! protocol of their own. It goes the whole way with one small protocol, a roll call: **[write it](#write-it)**, **[test it](#test-it)**,
//! **[name it in a scenario](#name-it-in-a-scenario)**, **[study it](#study-it)**, **[watch it](#watch-it)**.
//!
//! # Begin
//!
//! `desim new NAME --protocol` writes a crate to change: a protocol, its settings and figures, a test, a scenario and a study. In a crate of
//! your own, `Cargo.toml` needs
//!
//! ```toml
//! [dependencies]
//! desim = { package = "desim-swarm", version = "0.1" }
//! serde = { version = "1", features = ["derive"] } # messages, and settings in a scenario
//! schemars = "1"                                   # settings, as editors and error messages know them
//! # rand = "0.10"                                  # to draw from Input::random
//! # bytes = "1", tokio-util = "0.7"                # for messages that are encoded by hand
//! ```
//!
//! | feature, all on by default | what it adds |
//! |---|---|
//! | `command` | `desim::cli`: the command with every subcommand, pictures, pages of charts |
//! | `parquet` | the tables of a results folder |
//!
//! With `default-features = false` the library still runs scenarios and studies into folders, with figures as JSON.
//!
//! # Write it
//!
//! Robots call "who is near?", and all that hear it answer the one that called. A robot is a state machine: a value that
//! implements [`Protocol`](protocol::Protocol). It never looks at a clock, a socket or another robot. When it wakes, at its control step, at a timer of its own
//! or at an arrival, it is handed the time and an [`Input`](protocol::Input): what reached it, where it is, what is near, randomness of its
//! own. It fills an [`Output`](protocol::Output): messages to all or to one, timers, a velocity, and notes, which become figures.
//!
#![doc = concat!("```\n", include_str!("../examples/roll_call/robot.rs"), "```\n")]
//!
//! Messages are really encoded, and their bytes are what is accounted. [`Serialised`](protocol::Serialised) makes them with serde; a type that
//! implements tokio-util's `Encoder` and `Decoder` makes them by hand. Traffic is told by topic and by
//! [role](protocol::Note::Role).
//!
//! # Test it
//!
//! [`testing`] needs no scenario. [`Solo`](testing::Solo) is one robot that a test steps, [`Swarm`](testing::Swarm) is several, with a
//! function that says of each copy whether and when it arrives.
//!
//! ```
//! # mod robot { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/roll_call/robot.rs")); }
//! # use robot::{Message, Robot};
//! use desim::engine::{ActorId, Span};
//! use desim::testing::{Fate, Solo, Swarm};
//!
//! # fn main() {
//! // Robot 0 of three calls as it begins, and answers who calls it, in one byte.
//! let mut robot = Solo::new(ActorId(0), 3, Robot::calling_every(Span::from_secs(1.0)));
//! assert_eq!(robot.control_step().words(), [Message::Call]);
//! robot.hears(ActorId(2), Message::Call);
//! let said = &robot.control_step().said[0];
//! assert_eq!((said.to, said.message, said.bytes), (Some(ActorId(2)), Message::Answer, 1));
//!
//! // One answers. At the timer, a second after its call, it notes that and calls again.
//! robot.is_sent(ActorId(1), Message::Answer);
//! let woken = robot.advance(1.5);
//! assert_eq!(woken[1].at.as_secs(), 1.0);
//! assert_eq!(woken[1].measured("answers"), [1.0]);
//! assert_eq!(woken[1].words(), [Message::Call]);
//!
//! // In a row, where each hears its neighbours alone, the one in the middle gets two answers.
//! let robots = (0..3).map(|_| Robot::calling_every(Span::from_secs(1.0)));
//! let mut swarm = Swarm::new(robots.collect());
//! swarm.radio(|_now, from, to, _message| {
//!     if from.0.abs_diff(to.0) == 1 { Fate::Arrives(0.01) } else { Fate::Lost }
//! });
//! swarm.run_for(0.9);
//! let answers: Vec<u32> = swarm.robots().iter().map(|robot| robot.answers).collect();
//! assert_eq!(answers, [1, 2, 1]);
//! # }
//! ```
//!
//! # Name it in a scenario
//!
//! A [`Kind`](kind::Kind) is what `protocol: RollCall(...)` means in a scenario file: settings that make the robots of a swarm. Its
//! [figures](metrics::NotedFigure) are read off what robots note. All else that a kind may say has a default: what completes
//! its mission, what is wrong with its settings, which settings of a scenario its robots heed. What no robot can know, an observer of every trial
//! can: [`Start::observe`](kind::Start::observe).
//!
#![doc = concat!(
    "```\n# mod robot { include!(concat!(env!(\"CARGO_MANIFEST_DIR\"), \"/examples/roll_call/robot.rs\")); }\n# fn main() {}\n",
    include_str!("../examples/roll_call/kind.rs"),
    "```\n"
)]
//!
//! A program that [adds](kinds::add) it is the whole command, with one protocol more:
//!
//! ```no_run
//! # mod robot { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/roll_call/robot.rs")); }
//! # mod kind { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/roll_call/kind.rs")); }
//! # use kind::RollCall;
//! # #[cfg(feature = "command")]
//! fn main() -> std::process::ExitCode {
//!     desim::kinds::add::<RollCall>();
//!     desim::cli::main()
//! }
//! # #[cfg(not(feature = "command"))]
//! # fn main() {}
//! ```
//!
//! Its scenario file, metres and seconds:
//!
#![doc = concat!("```ron\n", include_str!("../examples/roll_call/roll_call.ron"), "```\n")]
//!
//! ```sh
//! cargo run --release -- check roll_call.ron --predict   # what is wrong with it, and what to expect
//! cargo run --release -- check roll_call.ron --resolved  # every setting, defaults worked in
//! cargo run --release -- scenario roll_call.ron          # run it, into results/roll_call
//! cargo run --release -- report results/roll_call        # charts
//! ```
//!
//! `--set radio.loss=None` changes a setting for once, `--force` runs again what is there. Results that another build of your program has made are
//! refused, and never mixed with new ones: its protocol may have been another.
//!
//! # Study it
//!
//! A study runs a scenario in several settings, under common random numbers, and holds their figures against each other:
//!
#![doc = concat!("```ron\n", include_str!("../examples/roll_call/loss.ron"), "```\n")]
//!
//! `cargo run --release -- compare loss.ron` runs and reports it; [`runs`] does the same by one call. An answer takes two frames, so
//! of nine others 9 · 0.7² = 4.41 should answer where three frames in ten are lost:
//!
//! ```
//! # mod robot { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/roll_call/robot.rs")); }
//! # mod kind { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/roll_call/kind.rs")); }
//! # use kind::RollCall;
//! use std::path::Path;
//!
//! use desim::metrics::comparison::Verdict;
//! use desim::runs::{Options, StudyRun, run_study};
//! use desim::scenario::load_study;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! desim::kinds::add::<RollCall>();
//! let plan = load_study(Path::new("examples/roll_call/loss.ron"))?;
//! let place = tempfile::tempdir()?;
//! let folder = place.path().join("roll_call_loss");
//! let results = run_study(&StudyRun::of(&plan), &folder, &Options::default(), |_| ())?;
//!
//! // Each setting has each figure: an estimate over its trials, with the ends of its 95 % interval.
//! let answers: Vec<_> = results.comparison.settings.iter()
//!     .filter_map(|setting| Some(setting.figure("noted.answers")?.estimate))
//!     .collect();
//! assert_eq!(answers[0].value, Some(9.0));
//! let [Some(low), Some(high)] = answers[1].ci95 else { panic!("35 trials tell it") };
//! assert!(low < 4.41 && 4.41 < high && high - low < 0.2, "{low} {high}");
//!
//! // Each pair of settings has a difference with an interval, a test and a verdict.
//! let pair = &results.comparison.pairs[0];
//! assert_eq!(pair.verdict, Verdict::Worse);
//! println!("{}", results.comparison.finding);
//! # Ok(())
//! # }
//! ```
//!
//! It prints "none has the highest answers to a call: 9.00 robots. It is detectably better than 30 %." Where intervals are wide and the
//! verdict is [`NoDetectableDifference`](metrics::comparison::Verdict), that does not mean that there is none: the pair's
//! [plan](metrics::comparison::Plan) says how many trials would show one that is worth finding.
//!
//! # Watch it
//!
//! A run can do without a scenario: [`Setup`](simulation::Setup) is the world. What the run leaves is a
//! [`TrialRecord`](metrics::TrialRecord). Who wants to know more gives it an [`Observer`](simulation::Observer), which is told everything as it
//! happens. Here three robots stand in a row, and an observer notes which of them hear each other:
//!
//! ```
//! # mod robot { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/roll_call/robot.rs")); }
//! # use robot::Robot;
//! use std::collections::BTreeSet;
//!
//! use desim::engine::{SimTime, Span};
//! use desim::geometry::{Pose, Vec2};
//! use desim::quantity::{Positive, Probability};
//! use desim::radio::LossConfig;
//! use desim::simulation::{Copy, DriverKind, Observer, Setup};
//!
//! #[derive(Default)]
//! struct Links(BTreeSet<(u32, u32)>);
//!
//! impl Observer for Links {
//!     fn delivered(&mut self, copy: &Copy, _at: SimTime, _read: Option<SimTime>) {
//!         self.0.insert((copy.sender.0, copy.receiver.0));
//!     }
//! }
//!
//! # fn main() -> Result<(), desim::simulation::RunError> {
//! let mut setup = Setup::lasting(Span::from_secs(60.0));
//! setup.radio.range = Positive::new(1.5);
//! setup.radio.loss = LossConfig::Bernoulli(Probability::new(0.5));
//!
//! let places = [-1.0, 0.0, 1.0].map(|x| Pose { position: Vec2::new(x, 0.0), heading: 0.0 });
//! let robots = (0..3).map(|_| Robot::calling_every(Span::from_secs(1.0))).collect();
//! let finished = setup.observe(places.to_vec(), robots, DriverKind::Inline, &Default::default(), Links::default())?;
//! assert_eq!(finished.observer.0, BTreeSet::from([(0, 1), (1, 0), (1, 2), (2, 1)]));
//!
//! // The first topic's ledger: every copy of every call has one fate.
//! let calls = &finished.record.ledger[0];
//! assert_eq!(calls.offered, calls.delivered + calls.lost.iter().sum::<u64>() + calls.in_flight);
//! # Ok(())
//! # }
//! ```
//!
//! # What happens in which order
//!
//! - Time is whole nanoseconds. At one instant: the motion tick, then faults, then events of the radio, then robot wakes, then samples.
//! - Robots that wake at one instant all see the world as it was before any of them acted. Their answers take effect in
//!   the order of their wakes, which is first-in-first-out.
//! - A robot that wakes at t has in its inbox what arrived up to and including t, by time of arrival.
//! - A timer wakes its robot at its exact time, between control steps too, and before a control step at the same instant.
//! - A frame waits in its receiver's inbox and wakes nobody, unless the scenario says `wake: OnReception`.
//!
//! # What makes two runs the same
//!
//! The scenario, the seed, the version, and your own protocol's code; not the driver, the number of threads or the build profile. Every random draw
//! is keyed by what it is for ([`engine::Streams`]), so no draw depends on how many came before it.
//!
//! # Where things are
//!
//! | to | see |
//! |---|---|
//! | write a robot | [`protocol`]; its time and ids in [`engine`], places in [`geometry`], numbers with a range in [`quantity`] |
//! | watch others for failures, take turns, wander | [`protocol::detector`], [`protocol::gossip`], [`protocol::wander`] |
//! | test it | [`testing`] |
//! | name it in a scenario | [`kind`], [`kinds`]; reading and writing the files: [`scenario`] |
//! | have figures of it | [`metrics`]; their intervals and tests: [`statistics`] |
//! | run it into a folder | [`runs`]; trial by trial: [`experiment`]; the files: [`export`], in words and charts: [`report`] |
//! | make a world by hand, and watch it | [`simulation`], [`happenings`]; of the models [`radio`], [`motion`], [`faults`] |
//! | know what closed forms expect | [`predict`] |
//! | lay out text | [`text`] |
//! | keep lists that may outgrow memory | [`spool`] |
//!
//! More protocols to read, each a file: `examples/flood` (questions through many hops), `examples/flock` (robots that move by what they
//! hear), `examples/leader` (a failure detector, and why it erred). `ARCHITECTURE.md` walks the paths through the modules.

#[cfg(feature = "command")]
pub mod cli;
pub mod engine;
pub mod experiment;
pub mod export;
pub mod faults;
pub mod geometry;
pub mod happenings;
pub mod kind;
pub mod kinds;
pub mod metrics;
pub mod motion;
pub mod predict;
pub mod protocol;
pub mod quantity;
pub mod radio;
pub mod report;
pub mod runs;
pub mod scenario;
pub mod simulation;
pub mod spool;
pub mod statistics;
pub mod testing;
pub mod text;
pub mod validate;
