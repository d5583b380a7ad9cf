//! Between a robot that sends and the robots that hear: encode, hand frames to the medium, put copies into inboxes.
//!
//! Whatever the radio, a copy stands in its receiver's inbox from the moment at which its frame is handed over until it is read or known
//! to be lost; while its fate is open it has no arrival yet (`NEVER`). So a frame that is under way takes no place of its own, and what an inbox
//! holds when the run ends is what is in flight.

use bytes::BytesMut;

use super::error::RunError;
use super::inbox::Inbox;
use crate::engine::{ActorId, SimTime, Span, outgrows_cache, prefetch};
use crate::faults::Faults;
use crate::geometry::Vec2;
use crate::happenings::Observer;
use crate::metrics::HeaderBytes;
use crate::motion::World;
use crate::protocol::{Concluded, Frame, Output, Protocol};
use crate::radio::{Fates, FrameId, Listener, Medium, Reach};

mod audience;
mod encode;
mod hearing;
mod strays;
mod transmit;

use audience::Audiences;
use strays::Strays;

/// A message of the present frame, and the robot that it is for if it is for one.
struct Spoken<M> {
    frame: Frame<M>,
    to: Option<ActorId>,
}

/// The numbers of a robot's next message and of its next frame: in step, unless messages share frames.
#[derive(Clone, Copy, Default)]
struct Numbers {
    message: u32,
    frame: u32,
}

impl Numbers {
    fn next(number: &mut u32) -> u32 {
        let next = *number;
        *number = next.wrapping_add(1);
        next
    }
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
    medium: Box<dyn Medium>,
    reach: Reach,
    headers: HeaderBytes,
    codec: P::Codec,
    inboxes: Vec<Inbox<P::Heard>>,
    /// The payload under way, where the present sender is and who hears it: buffers, kept to be used again.
    payload: BytesMut,
    position: Vec2,
    listeners: Vec<Listener>,
    /// Who heard robots that have not moved since, where that is more than a question of distance.
    audiences: Audiences,
    /// Who may hear the present sender though it counts as out of range: no copy is offered to it, and what reaches it is counted apart.
    beyond: Vec<Listener>,
    /// Who of all robots that is, while a frame is handed over.
    is_beyond: Vec<bool>,
    strays: Strays,
    /// While a frame for some of them is under way, all of them; else a buffer.
    all_listeners: Vec<Listener>,
    all_hindrances: Vec<f64>,
    /// The messages of the present frame: one, or all of a wake where they share one.
    aboard: Vec<Spoken<P::Heard>>,
    piggyback: bool,
    numbers: Vec<Numbers>,
    /// What becomes of the copies of the present frame. That is decided first and inboxes are filled after.
    fates: Fates,
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
    /// What robots are to learn of their own frames, and which of them are to be told, and when.
    outcomes: Vec<Vec<Concluded>>,
    told: Vec<(ActorId, SimTime)>,
    /// With what powers frames arrived that are yet to be read, over a radio that knows powers; else empty.
    powers: Vec<Vec<(FrameId, f32)>>,
    /// Whether memory is asked for before it is needed.
    prefetches: bool,
}

impl<P: Protocol> Air<P> {
    /// An empty air around `robots` robots. `headers`: what frames carry beside payloads; `piggyback`: whether the messages of a wake share a frame;
    /// `wake_on_reception`: whether [`reached`](Self::take_reached) is kept.
    pub fn new(
        medium: Box<dyn Medium>,
        robots: usize,
        headers: HeaderBytes,
        piggyback: bool,
        wake_on_reception: bool,
    ) -> Self {
        Self {
            reach: medium.reach(),
            medium,
            headers,
            codec: P::Codec::default(),
            inboxes: std::iter::repeat_with(Inbox::default).take(robots).collect(),
            payload: BytesMut::with_capacity(256),
            position: Vec2::zeros(),
            listeners: Vec::new(),
            audiences: Audiences::default(),
            beyond: Vec::new(),
            is_beyond: vec![false; robots],
            strays: Strays::default(),
            all_listeners: Vec::new(),
            all_hindrances: Vec::new(),
            aboard: Vec::new(),
            piggyback,
            numbers: vec![Numbers::default(); robots],
            fates: Fates::default(),
            hindrances: Vec::new(),
            reachable: Vec::new(),
            deaf_since: vec![SimTime::NEVER; robots],
            deaf: 0,
            reached: Vec::new(),
            tell_reached: wake_on_reception,
            outcomes: vec![Vec::new(); if P::HEEDS_OUTCOMES { robots } else { 0 }],
            told: Vec::new(),
            powers: Vec::new(),
            prefetches: outgrows_cache(robots),
        }
    }

    /// Asks for what is kept of `robot`, which is to wake soon.
    pub fn prefetch_row(&self, robot: ActorId) {
        prefetch(&self.inboxes[robot.index()]);
        prefetch(&self.numbers[robot.index()]);
    }

    /// Asks for what waits for `robot`, and for who will hear it.
    pub fn prefetch_contents(&self, robot: ActorId, world: &World) {
        self.inboxes[robot.index()].prefetch_contents();
        world.prefetch_neighbours(robot, self.reach.farthest());
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
        observer: &mut impl Observer,
    ) -> Result<(), RunError> {
        let Surroundings { world, faults } = place;
        self.position = world.position(sender, now);
        self.listeners.clear();
        let Self { listeners, inboxes, .. } = self;
        let prefetches = self.prefetches;
        match &self.reach {
            Reach::Disk(range) => {
                world.for_each_within(sender, now, *range, |id, from_sender| {
                    if prefetches {
                        prefetch(&inboxes[id.index()]);
                    }
                    listeners.push(Listener {
                        id,
                        sender: -from_sender,
                    });
                });
            }
            Reach::Links(links) => {
                self.beyond.clear();
                let found = [listeners, &mut self.beyond];
                self.audiences.look_up(links.as_ref(), world, now, sender, found);
            }
        }
        self.hindrances.clear();
        if faults.trouble_links() {
            let here = self.position;
            let hindrance = |listener: &Listener| {
                let there = world.position(listener.id, now);
                faults.link_loss((sender, here), (listener.id, there))
            };
            self.hindrances.extend(self.listeners.iter().map(hindrance));
        }
        if output.sends.is_empty() && !self.piggyback {
            // Nearly always: each message is for everyone, in a frame of its own.
            for message in output.broadcasts.drain(..) {
                let spoken = self.encode(now, sender, None, message, observer)?;
                self.transmit::<false>(now, std::slice::from_ref(&spoken), place, observer);
            }
        } else {
            self.say_in_turn(now, sender, output, place, observer)?;
        }
        observer.spoke(now, sender, world);
        Ok(())
    }

    #[inline(never)]
    fn say_in_turn(
        &mut self,
        now: SimTime,
        sender: ActorId,
        output: &mut Output<P::Message>,
        place: Surroundings<'_>,
        observer: &mut impl Observer,
    ) -> Result<(), RunError> {
        for (to, message) in output.drain_said() {
            let spoken = self.encode(now, sender, to, message, observer)?;
            if self.piggyback {
                self.aboard.push(spoken);
            } else {
                self.send(now, std::slice::from_ref(&spoken), place, observer);
            }
        }
        if !self.aboard.is_empty() {
            let mut aboard = std::mem::take(&mut self.aboard);
            self.send(now, &aboard, place, observer);
            aboard.clear();
            self.aboard = aboard;
        }
        Ok(())
    }
}
