//! Heartbeats and status timeouts on their own: the workload on which failure detectors and drivers are measured.
//!
//! Every robot broadcasts a 4-byte status and believes that a neighbour is down when it has not heard it for the
//! timeout. Robots stand still.

use std::rc::Rc;

use bytes::{Buf, BufMut, BytesMut};
use tokio_util::codec::{Decoder, Encoder};

use super::detector::{Circumstances, Detector, DetectorConfig, Monitored, Probe, Sign};
use super::gossip::GossipConfig;
use super::{CodecError, Input, Output, Protocol, Topic, Wake};
use crate::engine::{ActorId, SimTime, Span};

/// Settings that all robots share.
#[derive(Debug)]
pub struct Settings {
    /// Control steps from one status to the next.
    status_every: u64,
    detector: DetectorConfig,
    circumstances: Circumstances,
}

impl Settings {
    /// From a scenario's gossip and detector settings, for a swarm of `robots`.
    #[must_use]
    pub fn new(gossip: &GossipConfig, detector: &DetectorConfig, control_period: Span, robots: usize) -> Self {
        let status_every = gossip.status.steps(control_period);
        Self {
            status_every,
            detector: detector.clone(),
            circumstances: Circumstances {
                robots,
                status_interval: control_period * status_every,
            },
        }
    }
}

/// The status: a counter, so that its four bytes mean something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    /// Statuses that the sender sent before this one.
    pub number: u32,
}

/// What robots say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    /// I am alive.
    Status(Status),
    /// What the failure detector says.
    Probe(Box<Probe>),
}

impl Monitored for Message {
    #[inline]
    fn sign(&self) -> Sign<'_> {
        match self {
            Self::Status(_) => Sign::Status,
            Self::Probe(probe) => Sign::Probe(probe),
        }
    }

    fn probe(probe: Probe) -> Self {
        Self::Probe(Box::new(probe))
    }
}

/// One robot's heartbeat and what it believes of its neighbours.
#[derive(Debug)]
pub struct Heartbeat {
    settings: Rc<Settings>,
    control_steps: u64,
    sent: u32,
    detector: Detector,
}

impl Heartbeat {
    /// Robot `id`, which has heard nobody yet.
    #[must_use]
    pub fn new(id: ActorId, settings: Rc<Settings>) -> Self {
        Self {
            detector: Detector::new(&settings.detector, settings.circumstances, id),
            settings,
            control_steps: 0,
            sent: 0,
        }
    }
}

impl Protocol for Heartbeat {
    type Message = Message;
    type Codec = MessageCodec;
    const TOPICS: &'static [&'static str] = &["status", "probe"];
    const ROLES: &'static [&'static str] = &["robot"];
    const STATUS: Option<Topic> = Some(Topic(0));
    const PROBE: Option<Topic> = Some(Topic(1));
    const SENSES_PROXIMITY: bool = false;

    fn topic(message: &Message) -> Topic {
        Topic(match message {
            Message::Status(_) => 0,
            Message::Probe(_) => 1,
        })
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Message>, output: &mut Output<Message>) {
        self.detector.read(now, &input.inbox, output);
        match input.wake {
            Wake::Timer(_) => self.detector.expire(now, &mut input.random, output),
            Wake::ControlStep => {
                if self.control_steps.is_multiple_of(self.settings.status_every) {
                    output.broadcasts.push(Message::Status(Status { number: self.sent }));
                    self.sent = (self.sent + 1) % NUMBERS;
                }
                self.control_steps += 1;
            }
            Wake::Reception => {}
        }
    }
}

/// Numbers of statuses: with fewer than 31 bits their first byte never begins a probe.
const NUMBERS: u32 = 1 << 30;

/// A status is its number in four bytes, big-endian; a probe is as its detector has it.
#[derive(Debug, Default)]
pub struct MessageCodec;

impl Encoder<Message> for MessageCodec {
    type Error = CodecError;

    fn encode(&mut self, message: Message, bytes: &mut BytesMut) -> Result<(), CodecError> {
        match message {
            Message::Status(status) => bytes.put_u32(status.number),
            Message::Probe(probe) => probe.encode(bytes),
        }
        Ok(())
    }
}

impl Decoder for MessageCodec {
    type Item = Message;
    type Error = CodecError;

    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<Message>, CodecError> {
        if bytes.first().is_some_and(|first| Probe::begins_with(*first)) {
            return Probe::decode(bytes).map(|probe| Some(Message::probe(probe)));
        }
        if bytes.len() < 4 {
            return Ok(None);
        }
        Ok(Some(Message::Status(Status {
            number: bytes.get_u32(),
        })))
    }
}
