//! A kit for testing a protocol without a scenario: one robot stepped by hand ([`Solo`]), and a swarm over a radio that a test
//! scripts ([`Swarm`]).
//!
//! Whatever a robot says crosses its codec, as in a run: what does not come back whole, on the topic that it was said on,
//! fails the test. Time, randomness and order are as in a run, too, and the same in each repetition.
//!
//! ```
//! use desim::engine::{ActorId, SimTime};
//! use desim::protocol::{Input, Output, Protocol, Serialised, Wake};
//! use desim::testing::{Fate, Solo, Swarm};
//!
//! /// Passes the greatest number on that it has heard, each time that it grows.
//! struct Greatest(u32);
//!
//! impl Protocol for Greatest {
//!     type Message = u32;
//!     type Heard = u32;
//!     type Codec = Serialised<u32>;
//!     const TOPICS: &'static [&'static str] = &["greatest"];
//!     const ROLES: &'static [&'static str] = &["robot"];
//!
//!     fn start(&mut self, start: desim::protocol::Start) {
//!         self.0 = start.me.0;
//!     }
//!
//!     fn step(&mut self, now: SimTime, input: &mut Input<u32>, output: &mut Output<u32>) {
//!         let heard = input.inbox.iter().map(|reception| reception.frame.message).max();
//!         let begins = input.wake == Wake::ControlStep && now == SimTime::ZERO;
//!         if begins || heard > Some(self.0) {
//!             self.0 = self.0.max(heard.unwrap_or(0));
//!             output.broadcast(self.0);
//!         }
//!     }
//! }
//!
//! // One robot: it passes on what is greater, and nothing else.
//! let mut robot = Solo::new(ActorId(2), 5, Greatest(0));
//! robot.advance(0.1); // its first control step
//! robot.hears(ActorId(1), 1);
//! assert!(robot.control_step().said.is_empty());
//! robot.hears(ActorId(4), 4);
//! assert_eq!(robot.control_step().words(), [4]);
//!
//! // Five in a row, each hearing its neighbours alone: the greatest crosses four hops.
//! let mut swarm = Swarm::new((0..5).map(|_| Greatest(0)).collect());
//! swarm.radio(|_, from, to, _| if from.0.abs_diff(to.0) == 1 { Fate::Arrives(0.01) } else { Fate::Lost });
//! let agreed = swarm.run_until(10.0, |robots| robots.iter().all(|robot| robot.0 == 4));
//! assert_eq!(agreed, Some(0.4)); // a hop a control step
//! ```

mod solo;
mod swarm;

pub use solo::{Answer, Said, Solo};
pub use swarm::{Fate, Swarm};
