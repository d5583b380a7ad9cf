//! Heartbeats and status timeouts on their own: the workload on which failure detectors and drivers are measured.
//!
//! Every robot broadcasts a 4-byte status and believes that a neighbour is down when it has not heard it for the
//! timeout. Robots stand still.

use std::rc::Rc;

use bytes::{Buf, BufMut, BytesMut};
use tokio_util::codec::{Decoder, Encoder};

use super::detector::{Detector, DetectorConfig, Monitored};
use super::gossip::GossipConfig;
use super::{CodecError, Input, Output, Protocol, Topic, Wake};
use crate::engine::{SimTime, Span};

/// Settings that all robots share.
#[derive(Debug)]
pub struct Settings {
    /// Control steps from one status to the next.
    status_every: u64,
    detector: DetectorConfig,
}

impl Settings {
    /// From a scenario's gossip and detector settings.
    #[must_use]
    pub fn new(gossip: &GossipConfig, detector: &DetectorConfig, control_period: Span) -> Self {
        Self {
            status_every: gossip.status.steps(control_period),
            detector: detector.clone(),
        }
    }
}

/// The status: a counter, so that its four bytes mean something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    /// Statuses that the sender sent before this one.
    pub number: u32,
}

impl Monitored for Status {
    fn is_status(&self) -> bool {
        true
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
    /// A robot that has heard nobody yet.
    #[must_use]
    pub fn new(settings: Rc<Settings>) -> Self {
        Self {
            detector: Detector::new(&settings.detector),
            settings,
            control_steps: 0,
            sent: 0,
        }
    }
}

impl Protocol for Heartbeat {
    type Message = Status;
    type Codec = StatusCodec;
    const TOPICS: &'static [&'static str] = &["status"];
    const ROLES: &'static [&'static str] = &["robot"];
    const STATUS: Option<Topic> = Some(Topic(0));
    const SENSES_PROXIMITY: bool = false;

    fn step(&mut self, now: SimTime, input: &mut Input<Status>, output: &mut Output<Status>) {
        self.detector.read(&input.inbox, output);
        match input.wake {
            Wake::Timer(_) => self.detector.expire(now, output),
            Wake::ControlStep => {
                if self.control_steps.is_multiple_of(self.settings.status_every) {
                    output.broadcasts.push(Status { number: self.sent });
                    self.sent = self.sent.wrapping_add(1);
                }
                self.control_steps += 1;
            }
            Wake::Reception => {}
        }
    }
}

/// Four bytes, big-endian.
#[derive(Debug, Default)]
pub struct StatusCodec;

impl Encoder<Status> for StatusCodec {
    type Error = CodecError;

    fn encode(&mut self, status: Status, bytes: &mut BytesMut) -> Result<(), CodecError> {
        bytes.put_u32(status.number);
        Ok(())
    }
}

impl Decoder for StatusCodec {
    type Item = Status;
    type Error = CodecError;

    fn decode(&mut self, bytes: &mut BytesMut) -> Result<Option<Status>, CodecError> {
        if bytes.len() < 4 {
            return Ok(None);
        }
        Ok(Some(Status {
            number: bytes.get_u32(),
        }))
    }
}
