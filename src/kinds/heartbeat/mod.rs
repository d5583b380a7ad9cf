//! Heartbeats and a failure detector on their own: the workload on which detectors and drivers are measured.
//!
//! Every robot broadcasts a 4-byte status, and its detector believes what it believes of those that it hears. Robots stand
//! still, or wander.

mod kind;

use std::convert::Infallible;
use std::marker::PhantomData;
use std::rc::Rc;

use bytes::{Buf, BufMut, BytesMut};
use tokio_util::codec::{Decoder, Encoder};

pub use kind::HeartbeatConfig;

use crate::engine::{ActorId, SimTime, Streams};
use crate::protocol::control::{ControlConfig, Phases, Rhythm};
use crate::protocol::detector::{Carried, Circumstances, Detector, DetectorConfig, Monitored, Probe, Sign};
use crate::protocol::gossip::{GossipConfig, Turns};
use crate::protocol::wander::{Ground, Wander};
use crate::protocol::{CodecError, Input, Output, Protocol, Topic, Wake};

/// Settings that all robots share.
#[derive(Debug)]
pub struct Settings {
    status_turns: Turns,
    detector: DetectorConfig,
    circumstances: Circumstances,
    phases: Phases,
    ground: Ground,
}

impl Settings {
    /// From a scenario's gossip, detector and control settings, for a swarm of `robots`, in a trial with these `streams`.
    #[must_use]
    pub fn new(
        gossip: &GossipConfig,
        detector: &DetectorConfig,
        control: &ControlConfig,
        robots: usize,
        streams: Streams,
    ) -> Self {
        let period = control.period();
        let phases = Phases::new(control.phase, streams);
        Self {
            status_turns: Turns::new(gossip.status.timing(period), Rhythm::Status, phases, streams),
            detector: detector.clone(),
            circumstances: Circumstances {
                robots,
                status_interval: gossip.status.longest_pause(period),
            },
            phases,
            ground: Ground::still(),
        }
    }

    /// The same, for robots that move on `ground`.
    #[must_use]
    pub fn wandering(self, ground: Ground) -> Self {
        Self { ground, ..self }
    }
}

/// The status: a counter, so that its four bytes mean something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    /// Statuses that the sender sent before this one.
    pub number: u32,
}

/// What robots say; `P` carries what their failure detector says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message<P = Infallible> {
    /// I am alive.
    Status(Status),
    /// What the failure detector says.
    Probe(P),
}

impl<P: Carried> Monitored for Message<P> {
    #[inline]
    fn sign(&self) -> Sign<'_> {
        match self {
            Self::Status(_) => Sign::Status,
            Self::Probe(probe) => Sign::Probe(probe.probe()),
        }
    }

    fn probe(probe: Probe) -> Self {
        Self::Probe(P::of(probe).expect("robots whose detector sends have messages for that"))
    }
}

/// One robot's heartbeat and what it believes of its neighbours. Where its detector [sends](DetectorConfig::sends), `P` must
/// be one that can carry that.
#[derive(Debug)]
pub struct Heartbeat<P = Infallible> {
    id: ActorId,
    settings: Rc<Settings>,
    control_steps: u64,
    sent: u32,
    detector: Detector,
    wander: Wander,
    carries: PhantomData<P>,
}

impl<P> Heartbeat<P> {
    /// Robot `id`, which has heard nobody yet.
    #[must_use]
    pub fn new(id: ActorId, settings: Rc<Settings>) -> Self {
        Self {
            id,
            detector: Detector::new(&settings.detector, settings.circumstances, settings.phases, id),
            settings,
            control_steps: 0,
            sent: 0,
            wander: Wander::default(),
            carries: PhantomData,
        }
    }
}

impl<P: Carried> Protocol for Heartbeat<P> {
    type Message = Message<P>;
    type Heard = Message<P>;
    type Codec = MessageCodec<P>;
    const TOPICS: &'static [&'static str] = &["status", "probe"];
    const ROLES: &'static [&'static str] = &["robot"];
    const STATUS: Option<Topic> = Some(Topic(0));
    const PROBE: Option<Topic> = Some(Topic(1));
    const SENSES_PROXIMITY: bool = false;
    const SENSES_POWER: bool = false;

    #[inline]
    fn topic(message: &Message<P>) -> Topic {
        Topic(match message {
            Message::Status(_) => 0,
            Message::Probe(_) => 1,
        })
    }

    fn prefetch(&self) {
        self.detector.prefetch();
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Message<P>>, output: &mut Output<Message<P>>) {
        self.detector.step(now, input, output);
        if input.wake == Wake::ControlStep {
            let settings = &self.settings;
            output.velocity = self
                .wander
                .velocity(&settings.ground, self.id, now, input.pose.position);
            if settings.status_turns.is_due(self.id, self.control_steps) {
                output.broadcasts.push(Message::Status(Status { number: self.sent }));
                self.sent = (self.sent + 1) % NUMBERS;
            }
            self.control_steps += 1;
        }
    }
}

/// Numbers of statuses: with fewer than 31 bits their first byte never begins a probe.
const NUMBERS: u32 = 1 << 30;

/// A status is its number in four bytes, big-endian; a probe is as its detector has it.
#[derive(Debug)]
pub struct MessageCodec<P>(PhantomData<P>);

impl<P> Default for MessageCodec<P> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<P: Carried> Encoder<Message<P>> for MessageCodec<P> {
    type Error = CodecError;

    fn encode(&mut self, message: Message<P>, bytes: &mut BytesMut) -> Result<(), CodecError> {
        match message {
            Message::Status(status) => bytes.put_u32(status.number),
            Message::Probe(probe) => probe.probe().encode(bytes),
        }
        Ok(())
    }
}

impl<P: Carried> Decoder for MessageCodec<P> {
    type Item = Message<P>;
    type Error = CodecError;

    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<Message<P>>, CodecError> {
        if let Some(first) = bytes.first().copied().filter(|first| Probe::begins_with(*first)) {
            let refused = CodecError::Unknown {
                field: "message kind",
                value: first,
            };
            let probe = P::of(Probe::decode(bytes)?).ok_or(refused)?;
            return Ok(Some(Message::Probe(probe)));
        }
        if bytes.len() < 4 {
            return Ok(None);
        }
        Ok(Some(Message::Status(Status {
            number: bytes.get_u32(),
        })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::protocol::detector::Call;

    #[test]
    fn a_message_costs_a_reception_no_more_than_its_status_where_no_detector_sends() {
        assert_eq!(size_of::<Message>(), size_of::<Status>());
    }

    #[test]
    fn statuses_and_probes_decode_to_themselves_and_probes_only_where_they_are_carried() {
        let probe = Probe {
            call: Call::Ping { to: ActorId(3) },
            number: 7,
            news: Vec::new(),
        };
        let status = Status { number: NUMBERS - 1 };
        for message in [Message::Status(status), Message::Probe(Rc::new(probe))] {
            let mut bytes = BytesMut::new();
            MessageCodec::default().encode(message.clone(), &mut bytes).unwrap();
            let alone = MessageCodec::<Infallible>::default().decode(&mut bytes.clone());
            assert_eq!(alone.is_ok(), matches!(message, Message::Status(_)));
            assert_eq!(MessageCodec::default().decode(&mut bytes).unwrap(), Some(message));
        }
    }
}
