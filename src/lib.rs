//! desim runs a robot swarm's own protocol over a radio that loses and delays frames, while the robots move, and says
//! what that cost and how sure it is.
//!
//! Most people need only the command and a scenario file; the README is theirs. This page is for those who bring a
//! protocol of their own, or who want a run inside a program of theirs.
//!
//! # Author: a robot is a state machine
//!
//! Implement [`protocol::Protocol`]. A robot never looks at a clock, a socket or another robot: when it wakes it is
//! handed the time and an [`Input`](protocol::Input) (what reached it, where it is, what is near, randomness of its
//! own), and fills an [`Output`](protocol::Output) (messages, a velocity, timers, notes for the metrics). What it says is
//! really encoded: its codec makes the bytes that are accounted, and other robots see what decodes.
//!
//! # Assemble and run
//!
//! [`simulation::Setup`] is the world: arena, motion, radio, what is measured. Here two robots that say one byte at each control step
//! stand a metre apart on a radio that loses half of what is said:
//!
//! ```
//! use desim::engine::{SimTime, Span};
//! use desim::geometry::{Pose, Vec2};
//! use desim::protocol::control::PhaseConfig;
//! use desim::protocol::{Input, Output, Protocol, Wake};
//! use desim::quantity::Probability;
//! use desim::radio::LossConfig;
//! use desim::simulation::{DriverKind, Setup};
//! # use bytes::BytesMut;
//! # use desim::protocol::CodecError;
//! # use tokio_util::codec::{Decoder, Encoder};
//! # #[derive(Default)]
//! # struct Byte;
//! # impl Encoder<u8> for Byte {
//! #     type Error = CodecError;
//! #     fn encode(&mut self, byte: u8, bytes: &mut BytesMut) -> Result<(), CodecError> {
//! #         bytes.extend_from_slice(&[byte]);
//! #         Ok(())
//! #     }
//! # }
//! # impl Decoder for Byte {
//! #     type Item = u8;
//! #     type Error = CodecError;
//! #     fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<u8>, CodecError> {
//! #         Ok((!bytes.is_empty()).then(|| bytes.split_to(1)[0]))
//! #     }
//! # }
//!
//! struct Beeper;
//!
//! impl Protocol for Beeper {
//!     type Message = u8;
//!     type Heard = u8;
//!     type Codec = Byte; // one byte, as it is
//!     const TOPICS: &'static [&'static str] = &["beep"];
//!     const ROLES: &'static [&'static str] = &["robot"];
//!
//!     fn step(&mut self, _now: SimTime, input: &mut Input<u8>, output: &mut Output<u8>) {
//!         if input.wake == Wake::ControlStep {
//!             output.broadcasts.push(7);
//!         }
//!     }
//! }
//!
//! let mut setup = Setup::lasting(Span::from_secs(60.0));
//! setup.radio.loss = LossConfig::Bernoulli(Probability::new(0.5));
//! setup.control.phase = PhaseConfig::Together;
//!
//! let places = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0)];
//! let poses = places.map(|position| Pose { position, heading: 0.0 }).to_vec();
//! let record = setup.run(poses, vec![Beeper, Beeper], DriverKind::Actors, &Default::default())?;
//!
//! // 601 control steps from 0 to 60 s, two robots, one listener each.
//! let beeps = &record.ledger[0];
//! assert_eq!(beeps.offered, 1202);
//! assert_eq!(beeps.offered, beeps.delivered + beeps.lost[0] + beeps.in_flight);
//! # Ok::<(), desim::simulation::RunError>(())
//! ```
//!
//! The [`TrialRecord`](metrics::TrialRecord) holds what the run left behind: fates, traffic by robot, role and topic,
//! latencies, connectivity over time, where everybody ended. [`metrics::Summary`] makes figures with intervals of many.
//! Who wants to know more gives [`Setup::observe`](simulation::Setup::observe) an [`Observer`](simulation::Observer), which is told
//! what happens as it happens, and has the robots back in the end.
//!
//! # What happens in which order
//!
//! - Time is whole nanoseconds. At one instant: the motion tick, then faults, then robot wakes, then samples.
//! - Robots that wake at one instant all see the world as it was before any of them acted. Their answers take effect in
//!   the order of their wakes, which is first-in-first-out.
//! - A robot that wakes at t has in its inbox what arrived up to and including t, by time of arrival.
//! - A timer wakes its robot at its exact time, between control steps too, and before a control step at the same instant.
//! - A frame waits in its receiver's inbox and wakes nobody, unless the scenario says `wake: OnReception`.
//!
//! # What makes two runs the same
//!
//! The scenario, the seed and the version; not the driver, the number of threads or the build profile. Every random draw
//! is keyed by what it is for ([`engine::Streams`]), so no draw depends on how many came before it.
//!
//! # The floors
//!
//! [`engine`], [`geometry`], [`quantity`], [`statistics`] and [`text`] know no robots; [`radio`], [`motion`], [`protocol`] and [`faults`] are pure
//! models that do not know each other; [`happenings`] is what observers of a run are told; a [`kind`] is a protocol that a scenario can name, and [`kinds`] are those that it can; [`scenario`] is what a run is given and [`metrics`] what it leaves; [`simulation`] is one run,
//! [`experiment`] many; [`export`] and [`report`] put them on disk and into words, [`runs`] does all of it into a folder; `cli` faces people. `ARCHITECTURE.md` walks the paths through them.

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
