//! Traffic on its own: robots that say so much so often, with which radios are measured.
//!
//! Messages carry nothing but their length. When a robot sends follows from its own random numbers alone, so that two radios get the same
//! load from the same seed; saturated, it has always one more to send than the radio has taken.

mod kind;

use bytes::{BufMut as _, BytesMut};
use rand::RngExt as _;
use tokio_util::codec::{Decoder, Encoder};

pub use kind::{Recipients, Senders, Timing, TrafficConfig};

use crate::engine::{ActorId, SimTime, Span};
use crate::protocol::{CodecError, Input, Output, Protocol, TimerId, Wake};

/// A message of so many bytes, whatever they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Load(pub u16);

/// Writes a load as zeros, and reads its length back.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadCodec;

impl Encoder<Load> for LoadCodec {
    type Error = CodecError;

    fn encode(&mut self, load: Load, into: &mut BytesMut) -> Result<(), CodecError> {
        into.put_bytes(0, load.0.into());
        Ok(())
    }
}

impl Decoder for LoadCodec {
    type Item = Load;
    type Error = CodecError;

    fn decode(&mut self, from: &mut BytesMut) -> Result<Option<Load>, CodecError> {
        let load = Load(from.len() as u16);
        from.clear();
        Ok(Some(load))
    }
}

/// A robot that sends as its settings say.
#[derive(Clone, Debug)]
pub struct Source {
    timing: Timing,
    payload: u16,
    /// For whom: nobody, if it does not send.
    to: Option<To>,
    begun: bool,
}

/// Whom a robot sends to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum To {
    /// All in range.
    Everyone,
    /// One robot.
    One(ActorId),
}

/// When the next message is due.
const DUE: TimerId = TimerId(0);

/// How many messages a saturated robot has under way: one that is being sent and one that waits.
const UNDER_WAY: usize = 2;

impl Source {
    /// A robot that sends `payload` bytes `to` somebody, or nothing.
    #[must_use]
    pub const fn new(timing: Timing, payload: u16, to: Option<To>) -> Self {
        Self {
            timing,
            payload,
            to,
            begun: false,
        }
    }

    fn say(&self, output: &mut Output<Load>) {
        match self.to {
            Some(To::Everyone) => output.broadcast(Load(self.payload)),
            Some(To::One(robot)) => output.send(robot, Load(self.payload)),
            None => {}
        }
    }
}

impl Protocol for Source {
    type Message = Load;
    type Heard = Load;
    type Codec = LoadCodec;
    const TOPICS: &'static [&'static str] = &["load"];
    const ROLES: &'static [&'static str] = &["robot"];
    const SENSES_PROXIMITY: bool = false;
    const SENSES_POWER: bool = false;
    const HEEDS_OUTCOMES: bool = true;

    fn step(&mut self, now: SimTime, input: &mut Input<Load>, output: &mut Output<Load>) {
        if self.to.is_none() {
            return;
        }
        let begins = !std::mem::replace(&mut self.begun, true);
        let mut uniform = || 1.0 - input.random.random::<f64>();
        match self.timing {
            Timing::Saturated if begins => (0..UNDER_WAY).for_each(|_| self.say(output)),
            Timing::Saturated => input.outcomes.iter().for_each(|_| self.say(output)),
            Timing::Periodic(interval) => {
                let interval = Span::from_secs(interval.get());
                if begins {
                    let phase = Span::from_secs(interval.as_secs() * uniform());
                    output.set_timer(DUE, now + phase);
                } else if input.wake == Wake::Timer(DUE) {
                    self.say(output);
                    output.set_timer(DUE, now + interval);
                }
            }
            Timing::Poisson(rate) => {
                let due = input.wake == Wake::Timer(DUE);
                if due {
                    self.say(output);
                }
                if due || begins {
                    output.set_timer(DUE, now + Span::from_secs(-uniform().ln() / rate.get()));
                }
            }
        }
    }
}
