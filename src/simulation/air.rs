//! Between a robot that sends and the robots that hear: encode, offer to the medium, put arrivals into inboxes.

use std::any::type_name;
use std::borrow::Borrow as _;

use bytes::BytesMut;
use tokio_util::codec::{Decoder, Encoder};

use super::digest::Digest;
use super::error::RunError;
use super::inbox::Inbox;
use crate::engine::{ActorId, SimTime, Span, outgrows_cache, prefetch};
use crate::faults::Faults;
use crate::metrics::Recorder;
use crate::metrics::detection::CopyFate;
use crate::motion::World;
use crate::protocol::{Address, CodecError, Frame, MessageSize, Output, Protocol, Reception, Topic};
use crate::radio::{Fate, Listener, LossCause, Medium};

/// From an instant to the next.
const INSTANT: Span = Span::from_nanos(1);

/// A copy that will arrive.
struct Arrival {
    receiver: ActorId,
    at: SimTime,
    displacement: [f32; 2],
}

/// A message of the present frame, and the robot that it is for if it is for one.
struct Spoken<M> {
    frame: Frame<M>,
    to: Option<ActorId>,
}

/// What a transmission depends on beside the radio: where everybody is, and what fails.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// Where robots are.
    pub world: &'a World,
    /// What fails.
    pub faults: &'a Faults,
}

/// The radio's side of a run.
pub struct Air<P: Protocol> {
    medium: Medium,
    codec: P::Codec,
    inboxes: Vec<Inbox<P::Heard>>,
    /// The payload under way, and who hears the present sender: buffers, kept to be used again.
    payload: BytesMut,
    listeners: Vec<Listener>,
    /// While a frame for some of them is under way, all of them; else a buffer.
    all_listeners: Vec<Listener>,
    all_hindrances: Vec<f64>,
    /// The messages of the present frame: one, or all of a wake where they share one.
    aboard: Vec<Spoken<P::Heard>>,
    piggyback: bool,
    /// For each robot the number of its next message.
    sequences: Vec<u32>,
    /// The copies of the present frame that will arrive. Fates are decided first and inboxes filled after: the one is
    /// arithmetic, the other waits for memory, and apart each runs at its own pace.
    arrivals: Vec<Arrival>,
    /// Those that will not, and why.
    losses: Vec<(ActorId, LossCause)>,
    /// Which listeners the faults of links hinder, and with what probability; empty where nothing is wrong with links.
    hindrances: Vec<f64>,
    /// The listeners that the present frame reaches in spite of the faults of links.
    reachable: Vec<Listener>,
    /// Since when each robot has been unable to hear; `NEVER` if it hears.
    deaf_since: Vec<SimTime>,
    /// How many robots cannot hear: while all do, nobody is looked up in `deaf_since`.
    deaf: usize,
    /// Receivers whose next arrival may have come forward, for scenarios that wake robots on reception.
    reached: Vec<ActorId>,
    tell_reached: bool,
    /// Whether memory is asked for before it is needed.
    prefetches: bool,
}

impl<P: Protocol> Air<P> {
    /// An empty air around `robots` robots. `piggyback`: whether the messages of a wake share a frame; `wake_on_reception`:
    /// whether [`reached`](Self::take_reached) is kept.
    pub fn new(medium: Medium, robots: usize, piggyback: bool, wake_on_reception: bool) -> Self {
        Self {
            medium,
            codec: P::Codec::default(),
            inboxes: std::iter::repeat_with(Inbox::default).take(robots).collect(),
            payload: BytesMut::with_capacity(256),
            listeners: Vec::new(),
            all_listeners: Vec::new(),
            all_hindrances: Vec::new(),
            aboard: Vec::new(),
            piggyback,
            sequences: vec![0; robots],
            arrivals: Vec::new(),
            losses: Vec::new(),
            hindrances: Vec::new(),
            reachable: Vec::new(),
            deaf_since: vec![SimTime::NEVER; robots],
            deaf: 0,
            reached: Vec::new(),
            tell_reached: wake_on_reception,
            prefetches: outgrows_cache(robots),
        }
    }

    /// Asks for what is kept of `robot`, which is to wake soon.
    pub fn prefetch_row(&self, robot: ActorId) {
        prefetch(&self.inboxes[robot.index()]);
        prefetch(&self.sequences[robot.index()]);
        self.medium.prefetch_row(robot);
    }

    /// Asks for what waits for `robot`, and for who will hear it.
    pub fn prefetch_contents(&self, robot: ActorId, world: &World) {
        self.inboxes[robot.index()].prefetch_contents();
        world.prefetch_neighbours(robot, self.medium.range());
    }

    /// So long what a robot sends reaches nobody.
    pub fn lookahead(&self) -> Span {
        self.medium.lookahead()
    }

    /// Puts on air what `sender` says at `now`, and takes it out of `output`.
    pub fn say(
        &mut self,
        now: SimTime,
        sender: ActorId,
        output: &mut Output<P::Message>,
        place: Surroundings<'_>,
        recorder: &mut Recorder,
        digest: &mut Digest,
    ) -> Result<(), RunError> {
        let Surroundings { world, faults } = place;
        self.listeners.clear();
        let Self { listeners, inboxes, .. } = self;
        let prefetches = self.prefetches;
        world.for_each_within(sender, now, self.medium.range(), |id, from_sender| {
            if prefetches {
                prefetch(&inboxes[id.index()]);
            }
            listeners.push(Listener {
                id,
                sender: -from_sender,
            });
        });
        self.hindrances.clear();
        if faults.trouble_links() {
            let here = world.position(sender, now);
            let hindrance = |listener: &Listener| {
                let there = world.position(listener.id, now);
                faults.link_loss((sender, here), (listener.id, there))
            };
            self.hindrances.extend(self.listeners.iter().map(hindrance));
        }
        for (to, message) in output.drain_said() {
            let spoken = self.encode(now, sender, to, message, recorder, digest)?;
            if self.piggyback {
                self.aboard.push(spoken);
            } else {
                self.send(now, std::slice::from_ref(&spoken), faults, recorder);
            }
        }
        if !self.aboard.is_empty() {
            let mut aboard = std::mem::take(&mut self.aboard);
            self.send(now, &aboard, faults, recorder);
            aboard.clear();
            self.aboard = aboard;
        }
        if let Some(trace) = recorder.trace_of(sender) {
            trace.distances(now, distances(now, sender, self.inboxes.len(), world));
        }
        Ok(())
    }

    /// The bytes of `message`, and what its receivers make of them.
    fn encode(
        &mut self,
        now: SimTime,
        sender: ActorId,
        to: Option<ActorId>,
        message: P::Message,
        recorder: &mut Recorder,
        digest: &mut Digest,
    ) -> Result<Spoken<P::Heard>, RunError> {
        let topic = P::topic(&message);
        self.payload.clear();
        let encoded = self.codec.encode(message, &mut self.payload);
        let bytes = self.payload.len();
        encoded.map_err(|source| codec_error::<P>(topic, bytes, source))?;
        let size = MessageSize {
            payload_bytes: u16::try_from(bytes).map_err(|_| RunError::TooLong {
                protocol: type_name::<P>(),
                topic: topic_name::<P>(topic),
                bytes,
            })?,
            rides: !self.aboard.is_empty(),
        };
        digest.payload(&self.payload);
        if let Some(to) = to {
            self.check_addressee(sender, to, topic)?;
            digest.addressee(to);
        }
        // Every receiver gets the same bytes, so they are decoded once for all.
        let message = self.decode(topic)?;
        let sequence = self.sequences[sender.index()];
        self.sequences[sender.index()] = sequence.wrapping_add(1);
        recorder.transmitted(sender, topic, size);
        if P::STATUS == Some(topic) {
            recorder.status_sent(now, sender, sequence, to.filter(|_| !P::OVERHEARS));
        }
        recorder.offered(topic, self.copies(to));
        let frame = Frame {
            sender,
            sequence,
            sent_at: now,
            payload_bytes: size.payload_bytes,
            rides: size.rides,
            address: Address::Everyone,
            message: message.into(),
        };
        Ok(Spoken { frame, to })
    }

    /// How many robots a message to `to`, or to everyone, is offered to: its addressee, in range or not, and whoever else hears it.
    fn copies(&self, to: Option<ActorId>) -> u64 {
        let in_range = self.listeners.len() as u64;
        match to {
            None => in_range,
            Some(to) if P::OVERHEARS => in_range + u64::from(!self.is_in_range(to)),
            Some(_) => 1,
        }
    }

    fn is_in_range(&self, robot: ActorId) -> bool {
        self.listeners.iter().any(|listener| listener.id == robot)
    }

    /// Whether `sender` may send to `to`: another robot of the swarm.
    fn check_addressee(&self, sender: ActorId, to: ActorId, topic: Topic) -> Result<(), RunError> {
        let robots = self.inboxes.len();
        if to == sender || to.index() >= robots {
            return Err(RunError::Addressee {
                protocol: type_name::<P>(),
                topic: topic_name::<P>(topic),
                sender,
                to,
                last: robots - 1,
            });
        }
        Ok(())
    }

    /// What receivers make of the payload of a message on `topic`.
    fn decode(&mut self, topic: Topic) -> Result<P::Message, RunError> {
        let bytes = self.payload.len();
        let (protocol, name) = (type_name::<P>(), topic_name::<P>);
        let decoded = self.codec.decode(&mut self.payload);
        let decoded = decoded.map_err(|source| codec_error::<P>(topic, bytes, source))?;
        let message = decoded.ok_or(RunError::Undecodable {
            protocol,
            topic: name(topic),
            bytes,
        })?;
        let read = P::topic(&message);
        if read != topic {
            return Err(RunError::OtherTopic {
                protocol,
                topic: name(topic),
                bytes,
                read: name(read),
            });
        }
        if !self.payload.is_empty() {
            return Err(RunError::Unread {
                protocol,
                topic: name(topic),
                bytes,
                read: bytes - self.payload.len(),
            });
        }
        Ok(message)
    }

    /// Transmits the messages `aboard`, one at least and all of one sender, as one frame.
    #[inline]
    fn send(&mut self, now: SimTime, aboard: &[Spoken<P::Heard>], faults: &Faults, recorder: &mut Recorder) {
        if aboard.iter().all(|spoken| spoken.to.is_none()) {
            self.transmit::<false>(now, aboard, faults, recorder);
        } else {
            self.address(now, aboard, faults, recorder);
        }
    }

    /// Transmits a frame of which a message at least is for one robot. Those hear it for whom something in it is; the radios of others
    /// drop it, unless robots overhear. An addressee out of range gets nothing.
    #[inline(never)]
    fn address(&mut self, now: SimTime, aboard: &[Spoken<P::Heard>], faults: &Faults, recorder: &mut Recorder) {
        for spoken in aboard {
            if let Some(to) = spoken.to
                && !self.is_in_range(to)
                && !self.losses.iter().any(|loss| loss.0 == to)
            {
                self.losses.push((to, LossCause::BelowSensitivity));
            }
        }
        let everyone = P::OVERHEARS || aboard.iter().any(|spoken| spoken.to.is_none());
        if everyone {
            return self.transmit::<true>(now, aboard, faults, recorder);
        }
        std::mem::swap(&mut self.listeners, &mut self.all_listeners);
        std::mem::swap(&mut self.hindrances, &mut self.all_hindrances);
        self.listeners.clear();
        self.hindrances.clear();
        for (place, &listener) in self.all_listeners.iter().enumerate() {
            if aboard.iter().any(|spoken| spoken.to == Some(listener.id)) {
                self.listeners.push(listener);
                self.hindrances.extend(self.all_hindrances.get(place));
            }
        }
        self.transmit::<true>(now, aboard, faults, recorder);
        std::mem::swap(&mut self.listeners, &mut self.all_listeners);
        std::mem::swap(&mut self.hindrances, &mut self.all_hindrances);
    }

    /// Transmits the messages `aboard` to the present listeners, for whom they share one fate each. `ADDRESSED`: whether one at least
    /// is for one robot.
    // Inlined where a frame has one message, nearly always, the loops over what is aboard are gone.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    fn transmit<const ADDRESSED: bool>(
        &mut self,
        now: SimTime,
        aboard: &[Spoken<P::Heard>],
        faults: &Faults,
        recorder: &mut Recorder,
    ) {
        let sender = aboard[0].frame.sender;
        if !self.hindrances.is_empty() {
            self.hinder(sender, faults);
        }
        let Self {
            medium,
            arrivals,
            losses,
            listeners,
            reachable,
            hindrances,
            ..
        } = self;
        let listeners = if hindrances.is_empty() { listeners } else { reachable };
        medium.transmit(now, sender, listeners.iter().copied(), |receiver, fate| match fate {
            Fate::Arrives { at, displacement } => arrivals.push(Arrival {
                receiver,
                at,
                displacement,
            }),
            Fate::Lost(cause) => losses.push((receiver, cause)),
        });
        if self.prefetches {
            self.prefetch_fates(P::topic(aboard[0].frame.message.borrow()), recorder);
        }
        for (receiver, cause) in self.losses.drain(..) {
            for copy in copies_for::<P, ADDRESSED>(receiver, cause != LossCause::BelowSensitivity, aboard) {
                record_loss::<P>(receiver, copy.frame, copy.size, cause, recorder);
            }
        }
        if let Some(trace) = recorder.trace_of(sender) {
            for arrival in &self.arrivals {
                let copies = copies_for::<P, ADDRESSED>(arrival.receiver, true, aboard).map(|copy| copy.frame);
                for frame in copies.filter(|frame| P::STATUS == Some(P::topic(frame.message.borrow()))) {
                    trace.fate(frame.sequence, arrival.receiver, CopyFate::Arrives(arrival.at));
                }
            }
        }
        for arrival in self.arrivals.drain(..) {
            if self.tell_reached {
                self.reached.push(arrival.receiver);
            }
            let inbox = &mut self.inboxes[arrival.receiver.index()];
            for copy in copies_for::<P, ADDRESSED>(arrival.receiver, true, aboard) {
                inbox.push(Reception {
                    at: arrival.at,
                    frame: copy.into_frame::<ADDRESSED>(),
                    displacement: arrival.displacement,
                });
            }
        }
    }

    /// Asks for where the fates of the present frame are written down.
    fn prefetch_fates(&self, topic: Topic, recorder: &Recorder) {
        for arrival in &self.arrivals {
            self.inboxes[arrival.receiver.index()].prefetch_end();
        }
        for &(receiver, cause) in &self.losses {
            recorder.prefetch_lost(receiver, topic, cause);
        }
    }

    /// Finds the listeners that the frame reaches in spite of the faults of links; the other copies are lost.
    fn hinder(&mut self, sender: ActorId, faults: &Faults) {
        self.reachable.clear();
        let number = self.medium.upcoming(sender);
        for (listener, &loss) in self.listeners.iter().zip(&self.hindrances) {
            if faults.stops(loss, sender, listener.id, number) {
                self.losses.push((listener.id, LossCause::LinkFault));
            } else {
                self.reachable.push(*listener);
            }
        }
    }

    /// From `now` on `receiver` can hear or not. A copy is lost if its receiver cannot hear at the instant of its arrival;
    /// one that arrived before can still be read.
    pub fn set_hearing(&mut self, now: SimTime, receiver: ActorId, hears: bool, recorder: &mut Recorder) {
        if hears == self.hears(receiver) {
            return;
        }
        if hears {
            self.lose_unheard(now, receiver, recorder);
            self.deaf_since[receiver.index()] = SimTime::NEVER;
            self.deaf -= 1;
        } else {
            self.deaf_since[receiver.index()] = now;
            self.deaf += 1;
        }
    }

    fn hears(&self, receiver: ActorId) -> bool {
        self.deaf == 0 || self.deaf_since[receiver.index()] == SimTime::NEVER
    }

    /// Loses what has arrived at `receiver` before `until` and could not be heard.
    fn lose_unheard(&mut self, until: SimTime, receiver: ActorId, recorder: &mut Recorder) {
        if self.hears(receiver) {
            return;
        }
        let since = self.deaf_since[receiver.index()];
        if since < until {
            self.inboxes[receiver.index()].drop_arrivals(since, until, |reception| {
                let frame = &reception.frame;
                record_loss::<P>(receiver, frame, frame.size(), LossCause::ReceiverDown, recorder);
            });
        }
    }

    /// Hands over what has reached `receiver` by `now`, and counts it as delivered.
    pub fn deliver(
        &mut self,
        now: SimTime,
        receiver: ActorId,
        arrived: &mut Vec<Reception<P::Heard>>,
        recorder: &mut Recorder,
    ) {
        self.lose_unheard(now + INSTANT, receiver, recorder);
        self.inboxes[receiver.index()].take_arrived(now, arrived);
        for reception in arrived.iter() {
            record_delivery::<P>(receiver, reception, recorder);
        }
        if recorder.is_tracing() {
            for Reception { frame, .. } in arrived.iter() {
                if let Some(trace) = recorder.trace_of(frame.sender) {
                    trace.read(now, frame.sequence, receiver);
                }
            }
        }
    }

    /// What is on its way to `receiver`.
    pub fn waiting(&self, receiver: ActorId) -> &[Reception<P::Heard>] {
        self.inboxes[receiver.index()].waiting()
    }

    /// The earliest arrival that still waits for `receiver`; none if it cannot hear.
    pub fn next_arrival(&self, receiver: ActorId) -> SimTime {
        let next = || self.inboxes[receiver.index()].next_arrival();
        self.hears(receiver).then(next).flatten().unwrap_or(SimTime::NEVER)
    }

    /// Moves out the robots that frames were sent to since the last call.
    pub fn take_reached(&mut self, into: &mut Vec<ActorId>) {
        into.append(&mut self.reached);
    }

    /// Settles what still waits when the run ends at `end`: arrived means delivered, else in flight.
    pub fn settle(&mut self, end: SimTime, recorder: &mut Recorder) {
        for receiver in 0..self.inboxes.len() as u32 {
            self.lose_unheard(end + INSTANT, ActorId(receiver), recorder);
        }
        for (receiver, inbox) in self.inboxes.iter().enumerate() {
            for reception in inbox.waiting() {
                if reception.at <= end {
                    record_delivery::<P>(ActorId(receiver as u32), reception, recorder);
                } else {
                    let latency = reception.at.since(reception.frame.sent_at);
                    recorder.in_flight(P::topic(reception.frame.message.borrow()), latency);
                }
            }
        }
    }
}

/// What the protocol calls `topic`.
fn topic_name<P: Protocol>(topic: Topic) -> &'static str {
    P::TOPICS.get(usize::from(topic.0)).unwrap_or(&"that it does not name")
}

fn codec_error<P: Protocol>(topic: Topic, bytes: usize, source: CodecError) -> RunError {
    RunError::Codec {
        protocol: type_name::<P>(),
        topic: topic_name::<P>(topic),
        bytes,
        source,
    }
}

/// A message at one receiver.
struct Copy<'a, M> {
    frame: &'a Frame<M>,
    size: MessageSize,
    address: Address,
}

impl<M: Clone> Copy<'_, M> {
    #[inline]
    fn into_frame<const ADDRESSED: bool>(self) -> Frame<M> {
        let mut frame = self.frame.clone();
        if ADDRESSED {
            frame.rides = self.size.rides;
            frame.address = self.address;
        }
        frame
    }
}

/// What of a frame with the messages `aboard` is for `receiver`, which is `in_range` or hears no broadcast. Of it the first message
/// answers for the frame's header there.
#[inline]
fn copies_for<P: Protocol, const ADDRESSED: bool>(
    receiver: ActorId,
    in_range: bool,
    aboard: &[Spoken<P::Heard>],
) -> impl Iterator<Item = Copy<'_, P::Heard>> {
    let mut began = false;
    aboard.iter().filter_map(move |Spoken { frame, to }| {
        let mut size = frame.size();
        let mut address = Address::Everyone;
        if ADDRESSED {
            address = match *to {
                None if in_range => Address::Everyone,
                Some(to) if to == receiver => Address::Me,
                Some(_) if P::OVERHEARS && in_range => Address::Another,
                None | Some(_) => return None,
            };
            size.rides = std::mem::replace(&mut began, true);
        }
        Some(Copy { frame, size, address })
    })
}

fn record_loss<P: Protocol>(
    receiver: ActorId,
    frame: &Frame<P::Heard>,
    size: MessageSize,
    cause: LossCause,
    recorder: &mut Recorder,
) {
    let topic = P::topic(frame.message.borrow());
    recorder.lost(receiver, topic, cause, size);
    if P::STATUS == Some(topic) {
        recorder.status_lost(receiver, frame.sender, frame.sequence, cause);
    }
}

fn record_delivery<P: Protocol>(receiver: ActorId, reception: &Reception<P::Heard>, recorder: &mut Recorder) {
    let frame = &reception.frame;
    recorder.delivered(
        receiver,
        P::topic(frame.message.borrow()),
        frame.size(),
        reception.at.since(frame.sent_at),
    );
}

/// How far every robot is from `sender`, metres, in order of ids.
fn distances(now: SimTime, sender: ActorId, robots: usize, world: &World) -> Vec<f32> {
    let here = world.position(sender, now);
    let distance = |robot| (world.position(ActorId(robot), now) - here).norm() as f32;
    (0..robots as u32).map(distance).collect()
}
