//! What arrives at robots: decided when the radio knows, read when they wake, lost where they cannot hear, settled at the end.

use super::Air;
use super::transmit::copy_of;
use crate::engine::{ActorId, SimTime, Span, prefetch};
use crate::faults::Health;
use crate::happenings::Observer;
use crate::motion::World;
use crate::protocol::{Concluded, Frame, Protocol, Reception};
use crate::radio::{Arrival, FrameId, LossCause, Outcome};

/// From an instant to the next.
const INSTANT: Span = Span::from_nanos(1);

impl<P: Protocol> Air<P> {
    /// When the radio has something to do next.
    pub fn next_event(&self) -> SimTime {
        self.medium.next()
    }

    /// Lets the radio do what is due at `now`, with everybody where `world` has them.
    pub fn advance(&mut self, now: SimTime, world: &World, observer: &mut impl Observer) {
        while self.medium.next() <= now {
            if let Some(frame) = self.medium.advance(now, world, &mut self.fates) {
                self.decide(now, frame, observer);
            }
            self.tell_conclusions(now, observer);
        }
    }

    /// Tells what the radios of senders are done with: the senders too, where their protocol heeds that.
    pub(super) fn tell_conclusions(&mut self, now: SimTime, observer: &mut impl Observer) {
        for conclusion in self.fates.conclusions.drain(..) {
            observer.concluded(&conclusion);
            if P::HEEDS_OUTCOMES {
                let FrameId { sender, .. } = conclusion.frame;
                let concluded = Concluded {
                    sequence: Some(conclusion.frame.first()),
                    messages: conclusion.frame.messages(),
                    outcome: conclusion.outcome,
                };
                self.outcomes[sender.index()].push(concluded);
                self.told.push((sender, now));
            }
        }
    }

    /// The messages of `robot`, whose radio cannot send, go nowhere: it learns so where its protocol heeds that.
    pub fn refuse(&mut self, now: SimTime, robot: ActorId, messages: usize) {
        if P::HEEDS_OUTCOMES {
            let concluded = Concluded {
                sequence: None,
                messages: messages as u32,
                outcome: Outcome::Dropped(LossCause::SenderDown),
            };
            self.outcomes[robot.index()].push(concluded);
            self.told.push((robot, now));
        }
    }

    /// Moves out what `robot` learns of frames of its own.
    pub fn take_outcomes(&mut self, robot: ActorId, into: &mut Vec<Concluded>) {
        if P::HEEDS_OUTCOMES {
            into.append(&mut self.outcomes[robot.index()]);
        }
    }

    /// Moves out the robots that have learnt something of frames of their own since the last call, and when.
    pub fn take_told(&mut self, into: &mut Vec<(ActorId, SimTime)>) {
        into.append(&mut self.told);
    }

    /// The next robot whose battery is empty, if there is one.
    pub fn take_exhausted(&mut self) -> Option<ActorId> {
        self.fates.exhausted.pop()
    }

    /// Tells what receivers measured of `frame`.
    fn tell_readings(&mut self, now: SimTime, frame: FrameId, observer: &mut impl Observer) {
        if P::SENSES_POWER && self.powers.is_empty() {
            self.powers.resize_with(self.inboxes.len(), Vec::new);
        }
        for reading in self.fates.readings.drain(..) {
            if !self.strays.has(reading.receiver, frame.sender, frame.first()) {
                observer.measured(now, frame, &reading);
            }
            if P::SENSES_POWER && reading.received {
                self.powers[reading.receiver.index()].push((frame, reading.power));
            }
        }
    }

    /// Lets the fates of open copies of `frame` take effect, which the radio has decided at `now`.
    fn decide(&mut self, now: SimTime, frame: FrameId, observer: &mut impl Observer) {
        if self.prefetches {
            self.prefetch_decided();
        }
        if !self.fates.readings.is_empty() {
            self.tell_readings(now, frame, observer);
        }
        for (receiver, cause) in self.fates.losses.drain(..) {
            let strays = self.strays.remove(receiver, frame);
            let lost = self.inboxes[receiver.index()].lose(frame, |reception| {
                if !strays {
                    observer.lost(&copy_of::<P>(&reception.frame, receiver), cause, now);
                }
            });
            assert!(
                lost,
                "the radio loses a copy of {frame:?} at robot {receiver}, where none is open"
            );
        }
        for arrival in self.fates.arrivals.drain(..) {
            let Arrival {
                receiver,
                at,
                displacement,
            } = arrival;
            assert!(at >= now, "the radio decides at {now} what has arrived at {at}");
            let strays = self.strays.has(receiver, frame.sender, frame.first());
            let arrives = self.inboxes[receiver.index()].arrive(frame, at, displacement, |frame| {
                if !strays {
                    observer.arrives(&copy_of::<P>(frame, receiver), at);
                }
            });
            assert!(
                arrives,
                "the radio delivers a copy of {frame:?} to robot {receiver}, for whom none is open"
            );
            if self.tell_reached {
                self.reached.push(receiver);
            }
        }
        self.fates.open.clear();
    }

    /// Asks for the inboxes in which decided copies wait.
    fn prefetch_decided(&self) {
        let receivers = || {
            let arrivals = self.fates.arrivals.iter().map(|arrival| arrival.receiver);
            arrivals.chain(self.fates.losses.iter().map(|loss| loss.0))
        };
        receivers().for_each(|receiver| prefetch(&self.inboxes[receiver.index()]));
        receivers().for_each(|receiver| self.inboxes[receiver.index()].prefetch_last());
    }

    /// From `now` on the radio of `robot` does what its `health` allows. A copy is lost if its receiver cannot hear at the instant of its arrival;
    /// one that arrived before can still be read.
    pub fn set_health(
        &mut self,
        now: SimTime,
        robot: ActorId,
        health: Health,
        world: &World,
        observer: &mut impl Observer,
    ) {
        let Health { sends, hears, .. } = health;
        self.medium.enable(now, world, robot, sends, hears);
        if hears != self.hears(robot) {
            self.set_hearing(now, robot, hears, observer);
        }
    }

    fn set_hearing(&mut self, now: SimTime, receiver: ActorId, hears: bool, observer: &mut impl Observer) {
        if hears {
            self.lose_unheard(now, receiver, observer);
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
    fn lose_unheard(&mut self, until: SimTime, receiver: ActorId, observer: &mut impl Observer) {
        if self.hears(receiver) {
            return;
        }
        let since = self.deaf_since[receiver.index()];
        if since < until {
            let mut gone = Vec::new();
            self.inboxes[receiver.index()].drop_arrivals(since, until, |reception| {
                let Frame { sender, sequence, .. } = reception.frame;
                if self.strays.has(receiver, sender, sequence) {
                    gone.push((sender, sequence));
                } else {
                    let copy = copy_of::<P>(&reception.frame, receiver);
                    observer.lost(&copy, LossCause::ReceiverDown, reception.at);
                }
            });
            for (sender, sequence) in gone {
                self.strays.forget(receiver, sender, sequence);
            }
        }
    }

    /// Hands over what has reached `receiver` by `now`, and counts it as delivered.
    pub fn deliver(
        &mut self,
        now: SimTime,
        receiver: ActorId,
        arrived: &mut Vec<Reception<P::Heard>>,
        powers: &mut Vec<f32>,
        observer: &mut impl Observer,
    ) {
        self.lose_unheard(now + INSTANT, receiver, observer);
        self.inboxes[receiver.index()].take_arrived(now, arrived);
        if self.strays.of(receiver).is_empty() {
            for reception in arrived.iter() {
                observer.delivered(&copy_of::<P>(&reception.frame, receiver), reception.at, Some(now));
            }
        } else {
            self.tell_read(now, receiver, arrived, observer);
        }
        if let Some(known) = self.powers.get_mut(receiver.index()) {
            let mut next = 0;
            for reception in arrived.iter() {
                let Frame { sender, sequence, .. } = reception.frame;
                // Both are in order of time, but for what arrives at the same instant: it is hardly ever another than the next.
                let (before, after) = known.split_at(next);
                let is_it = |entry: &&(FrameId, f32)| entry.0.holds(sender, sequence);
                let place = after.iter().position(|entry| is_it(&entry)).map(|place| next + place);
                let place = place.or_else(|| before.iter().position(|entry| is_it(&entry)));
                powers.push(place.map_or(f32::NAN, |place| known[place].1));
                next = place.map_or(next, |place| place + usize::from(known[place].0.messages() == 1));
            }
            known.clear();
        }
    }

    /// Tells what `receiver` reads, where some of it is from out of range.
    #[inline(never)]
    fn tell_read(
        &mut self,
        now: SimTime,
        receiver: ActorId,
        arrived: &[Reception<P::Heard>],
        observer: &mut impl Observer,
    ) {
        for reception in arrived {
            let copy = copy_of::<P>(&reception.frame, receiver);
            if self.strays.has(receiver, copy.sender, copy.sequence) {
                observer.strayed(&copy, reception.at, Some(now));
            } else {
                observer.delivered(&copy, reception.at, Some(now));
            }
        }
        for reception in arrived {
            let Frame { sender, sequence, .. } = reception.frame;
            self.strays.forget(receiver, sender, sequence);
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

    /// Settles what still waits when the run ends at `end`: arrived means delivered; else, known to arrive or open, in flight.
    pub fn settle(&mut self, end: SimTime, observer: &mut impl Observer) {
        for robot in (0..self.inboxes.len() as u32).map(ActorId) {
            if let Some(account) = self.medium.account(end, robot) {
                observer.accounted(robot, &account);
            }
        }
        for receiver in 0..self.inboxes.len() as u32 {
            self.lose_unheard(end + INSTANT, ActorId(receiver), observer);
        }
        for (receiver, inbox) in (0..).map(ActorId).zip(&self.inboxes) {
            for reception in inbox.waiting() {
                let copy = copy_of::<P>(&reception.frame, receiver);
                if self.strays.has(receiver, copy.sender, copy.sequence) {
                    if reception.at <= end {
                        observer.strayed(&copy, reception.at, None);
                    }
                } else if reception.at <= end {
                    observer.delivered(&copy, reception.at, None);
                } else {
                    observer.in_flight(&copy, Some(reception.at).filter(|at| *at < SimTime::NEVER));
                }
            }
        }
    }
}
