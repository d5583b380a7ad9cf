//! Heartbeats and status timeouts on their own: the workload on which failure detectors and drivers are measured.
//!
//! Every robot broadcasts a 4-byte status and believes that a neighbour is down when it has not heard it for the
//! timeout. Robots stand still.

use std::rc::Rc;

use bytes::{Buf, BufMut, BytesMut};
use tokio_util::codec::{Decoder, Encoder};

use super::detector::DetectorConfig;
use super::gossip::GossipConfig;
use super::row_index::RowIndex;
use super::{CodecError, Input, Note, Output, Protocol, TimerId, Topic, Wake};
use crate::engine::{ActorId, SimTime, Span};

const DETECTOR: TimerId = TimerId(0);

/// Settings that all robots share.
#[derive(Debug)]
pub struct Settings {
    /// Control steps from one status to the next.
    status_every: u64,
    /// Silence after which a neighbour is suspected.
    timeout: Span,
}

impl Settings {
    /// From a scenario's gossip and detector settings.
    #[must_use]
    pub fn new(gossip: &GossipConfig, detector: &DetectorConfig, control_period: Span) -> Self {
        let DetectorConfig::Timeout(timeout) = detector;
        Self {
            status_every: gossip.status.steps(control_period),
            timeout: Span::from_secs(timeout.get()),
        }
    }
}

/// The status: a counter, so that its four bytes mean something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status {
    /// Statuses that the sender sent before this one.
    pub number: u32,
}

/// One robot's heartbeat and what it knows of its neighbours.
#[derive(Debug)]
pub struct Heartbeat {
    settings: Rc<Settings>,
    control_steps: u64,
    sent: u32,
    /// Neighbours ever heard, a row each.
    neighbours: Vec<Neighbour>,
    rows: RowIndex,
    /// When the detector's timer fires: never later than the earliest timeout. It is checked then and set again, so that
    /// an arrival costs a store and not a timer.
    armed: SimTime,
}

#[derive(Debug)]
struct Neighbour {
    id: ActorId,
    suspected: bool,
    /// Arrival of its last status.
    last_heard: SimTime,
}

impl Heartbeat {
    /// A robot that has heard nobody yet.
    #[must_use]
    pub fn new(settings: Rc<Settings>) -> Self {
        Self {
            settings,
            control_steps: 0,
            sent: 0,
            neighbours: Vec::new(),
            rows: RowIndex::default(),
            armed: SimTime::NEVER,
        }
    }

    fn hear(&mut self, sender: ActorId, at: SimTime, output: &mut Output<Status>) {
        let Some(row) = self.rows.get(sender) else {
            self.rows.set(sender, self.neighbours.len());
            self.neighbours.push(Neighbour {
                id: sender,
                suspected: false,
                last_heard: at,
            });
            self.arm(at + self.settings.timeout, output);
            return;
        };
        let neighbour = &mut self.neighbours[row];
        neighbour.last_heard = at;
        if neighbour.suspected {
            neighbour.suspected = false;
            output.notes.push(Note::Trusts(sender));
            self.arm(at + self.settings.timeout, output);
        }
    }

    fn arm(&mut self, due: SimTime, output: &mut Output<Status>) {
        if due < self.armed {
            self.armed = due;
            output.timers.push((DETECTOR, Some(due)));
        }
    }

    fn suspect_the_silent(&mut self, now: SimTime, output: &mut Output<Status>) {
        self.armed = SimTime::NEVER;
        let mut next = SimTime::NEVER;
        for neighbour in self.neighbours.iter_mut().filter(|neighbour| !neighbour.suspected) {
            let due = neighbour.last_heard + self.settings.timeout;
            if due <= now {
                neighbour.suspected = true;
                output.notes.push(Note::Suspects(neighbour.id));
            } else {
                next = next.min(due);
            }
        }
        if next < SimTime::NEVER {
            self.arm(next, output);
        }
    }
}

impl Protocol for Heartbeat {
    type Message = Status;
    type Codec = StatusCodec;
    const TOPICS: &'static [&'static str] = &["status"];
    const ROLES: &'static [&'static str] = &["robot"];
    const SENSES_PROXIMITY: bool = false;

    fn topic(_: &Status) -> Topic {
        Topic(0)
    }

    fn step(&mut self, now: SimTime, input: &mut Input<Status>, output: &mut Output<Status>) {
        for reception in &input.inbox {
            self.hear(reception.frame.sender, reception.at, output);
        }
        match input.wake {
            Wake::Timer(_) => self.suspect_the_silent(now, output),
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
