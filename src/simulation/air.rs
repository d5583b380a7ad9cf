//! Between a robot that sends and the robots that hear: encode, offer to the medium, put arrivals into inboxes.

use std::rc::Rc;

use bytes::BytesMut;
use tokio_util::codec::{Decoder, Encoder};

use super::digest::Digest;
use super::error::RunError;
use super::inbox::Inbox;
use crate::engine::{ActorId, SimTime};
use crate::metrics::Recorder;
use crate::motion::World;
use crate::protocol::{Frame, Protocol, Reception};
use crate::radio::{Fate, Listener, Medium};

/// A copy that will arrive.
struct Arrival {
    receiver: ActorId,
    at: SimTime,
    displacement: [f32; 2],
}

/// The radio's side of a run.
pub struct Air<P: Protocol> {
    medium: Medium,
    codec: P::Codec,
    inboxes: Vec<Inbox<P::Message>>,
    /// The payload under way, and who hears the present sender: buffers, kept to be used again.
    payload: BytesMut,
    listeners: Vec<Listener>,
    /// The copies of the present frame that will arrive. Fates are decided first and inboxes filled after: the one is
    /// arithmetic, the other waits for memory, and apart each runs at its own pace.
    arrivals: Vec<Arrival>,
    /// Receivers whose next arrival may have come forward, for scenarios that wake robots on reception.
    reached: Vec<ActorId>,
    tell_reached: bool,
}

impl<P: Protocol> Air<P> {
    /// An empty air around `robots` robots. `wake_on_reception`: whether [`reached`](Self::take_reached) is kept.
    pub fn new(medium: Medium, robots: usize, wake_on_reception: bool) -> Self {
        Self {
            medium,
            codec: P::Codec::default(),
            inboxes: std::iter::repeat_with(Inbox::default).take(robots).collect(),
            payload: BytesMut::with_capacity(256),
            listeners: Vec::new(),
            arrivals: Vec::new(),
            reached: Vec::new(),
            tell_reached: wake_on_reception,
        }
    }

    /// Broadcasts `messages`, which `sender` sends at `now`.
    pub fn broadcast(
        &mut self,
        now: SimTime,
        sender: ActorId,
        messages: impl Iterator<Item = P::Message>,
        world: &World,
        recorder: &mut Recorder,
        digest: &mut Digest,
    ) -> Result<(), RunError> {
        self.listeners.clear();
        let listeners = &mut self.listeners;
        world.for_each_within(sender, now, self.medium.range(), |id, from_sender| {
            listeners.push(Listener {
                id,
                sender: -from_sender,
            });
        });
        for message in messages {
            self.transmit(now, sender, message, recorder, digest)?;
        }
        Ok(())
    }

    fn transmit(
        &mut self,
        now: SimTime,
        sender: ActorId,
        message: P::Message,
        recorder: &mut Recorder,
        digest: &mut Digest,
    ) -> Result<(), RunError> {
        let topic = P::topic(&message);
        self.payload.clear();
        self.codec.encode(message, &mut self.payload)?;
        let payload_bytes = self.payload.len() as u32;
        digest.payload(&self.payload);
        // Every receiver gets the same bytes, so they are decoded once for all.
        let message = self
            .codec
            .decode(&mut self.payload)?
            .ok_or(RunError::Undecodable { topic })?;
        recorder.transmitted(sender, topic, payload_bytes);
        recorder.offered(topic, self.listeners.len() as u64);
        let frame = Rc::new(Frame {
            sender,
            sequence: self.medium.upcoming(sender),
            sent_at: now,
            topic,
            payload_bytes,
            message,
        });
        let Self { medium, arrivals, .. } = self;
        medium.transmit(
            now,
            sender,
            self.listeners.iter().copied(),
            |receiver, fate| match fate {
                Fate::Arrives { at, displacement } => arrivals.push(Arrival {
                    receiver,
                    at,
                    displacement,
                }),
                Fate::Lost(cause) => recorder.lost(receiver, topic, cause, payload_bytes),
            },
        );
        for arrival in self.arrivals.drain(..) {
            if self.tell_reached {
                self.reached.push(arrival.receiver);
            }
            self.inboxes[arrival.receiver.index()].push(Reception {
                at: arrival.at,
                frame: Rc::clone(&frame),
                displacement: arrival.displacement,
            });
        }
        Ok(())
    }

    /// Hands over what has reached `receiver` by `now`, and counts it as delivered.
    pub fn deliver(
        &mut self,
        now: SimTime,
        receiver: ActorId,
        arrived: &mut Vec<Reception<P::Message>>,
        recorder: &mut Recorder,
    ) {
        self.inboxes[receiver.index()].take_arrived(now, arrived);
        for reception in arrived.iter() {
            record_delivery(receiver, reception, recorder);
        }
    }

    /// The earliest arrival that still waits for `receiver`.
    pub fn next_arrival(&self, receiver: ActorId) -> SimTime {
        self.inboxes[receiver.index()].next_arrival().unwrap_or(SimTime::NEVER)
    }

    /// Moves out the robots that frames were sent to since the last call.
    pub fn take_reached(&mut self, into: &mut Vec<ActorId>) {
        into.append(&mut self.reached);
    }

    /// Settles what still waits when the run ends at `end`: arrived means delivered, else in flight.
    pub fn settle(&self, end: SimTime, recorder: &mut Recorder) {
        for (receiver, inbox) in self.inboxes.iter().enumerate() {
            for reception in inbox.waiting() {
                if reception.at <= end {
                    record_delivery(ActorId(receiver as u32), reception, recorder);
                } else {
                    recorder.in_flight(reception.frame.topic);
                }
            }
        }
    }
}

fn record_delivery<M>(receiver: ActorId, reception: &Reception<M>, recorder: &mut Recorder) {
    let frame = &reception.frame;
    recorder.delivered(
        receiver,
        frame.topic,
        frame.payload_bytes,
        reception.at.since(frame.sent_at),
    );
}
