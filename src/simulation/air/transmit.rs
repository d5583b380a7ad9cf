//! A frame on air: who is offered what of it, and what becomes of each copy.

use std::borrow::Borrow as _;

use super::{Air, Numbers, Spoken, Surroundings};
use crate::engine::{ActorId, SimTime, prefetch};
use crate::faults::Faults;
use crate::happenings::{Copy, Observer};
use crate::protocol::{Address, Frame, MessageSize, Protocol, Reception, Topic};
use crate::radio::{Fate, FrameId, Listener, LossCause, Transmission};

/// A message of a frame at one receiver. `ADDRESSED`: whether the frame is not simply for everyone.
struct AtReceiver<'a, P: Protocol, const ADDRESSED: bool> {
    frame: &'a Frame<P::Heard>,
    size: MessageSize,
    address: Address,
}

impl<P: Protocol, const ADDRESSED: bool> AtReceiver<'_, P, ADDRESSED> {
    #[inline]
    fn copy(&self, receiver: ActorId) -> Copy {
        Copy {
            size: self.size,
            address: self.address,
            ..copy_of::<P>(self.frame, receiver)
        }
    }

    #[inline]
    fn into_frame(self) -> Frame<P::Heard> {
        let mut frame = self.frame.clone();
        if ADDRESSED {
            frame.rides = self.size.rides;
            frame.address = self.address;
        }
        frame
    }
}

/// What is told of `frame` at `receiver`.
#[inline]
pub(super) fn copy_of<P: Protocol>(frame: &Frame<P::Heard>, receiver: ActorId) -> Copy {
    Copy {
        sender: frame.sender,
        receiver,
        address: frame.address,
        topic: P::topic(frame.message.borrow()),
        size: frame.size(),
        sequence: frame.sequence,
        sent_at: frame.sent_at,
    }
}

/// What of a frame with the messages `aboard` is for `receiver`, which is `in_range` or hears no broadcast. Of it the first message
/// answers for the frame's header there.
#[inline]
fn copies_for<P: Protocol, const ADDRESSED: bool>(
    receiver: ActorId,
    in_range: bool,
    aboard: &[Spoken<P::Heard>],
) -> impl Iterator<Item = AtReceiver<'_, P, ADDRESSED>> {
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
        Some(AtReceiver { frame, size, address })
    })
}

impl<P: Protocol> Air<P> {
    /// Transmits the messages `aboard`, one at least and all of one sender, as one frame.
    #[inline(never)]
    pub(super) fn send(
        &mut self,
        now: SimTime,
        aboard: &[Spoken<P::Heard>],
        place: Surroundings<'_>,
        observer: &mut impl Observer,
    ) {
        if aboard.iter().all(|spoken| spoken.to.is_none()) {
            return self.transmit::<false>(now, aboard, place, observer);
        }
        let everyone = P::OVERHEARS || aboard.iter().any(|spoken| spoken.to.is_none());
        if everyone || !self.medium.takes_far() {
            self.give_up_far(now, aboard, place, observer);
        }
        if !everyone {
            self.narrow(aboard);
            if self.medium.takes_far() {
                self.add_far(now, aboard, place);
            }
        }
        self.transmit::<true>(now, aboard, place, observer);
        if !everyone {
            std::mem::swap(&mut self.listeners, &mut self.all_listeners);
            std::mem::swap(&mut self.hindrances, &mut self.all_hindrances);
        }
    }

    /// Loses what is for robots out of range.
    fn give_up_far(
        &mut self,
        now: SimTime,
        aboard: &[Spoken<P::Heard>],
        surroundings: Surroundings<'_>,
        observer: &mut impl Observer,
    ) {
        for (place, spoken) in aboard.iter().enumerate() {
            let Some(far) = spoken.to.filter(|to| !self.is_in_range(*to)) else {
                continue;
            };
            if aboard[..place].iter().all(|earlier| earlier.to != Some(far)) {
                let distance = || (surroundings.world.position(far, now) - self.position).norm();
                let distance = observer.heeds_offers().then(distance);
                for at_receiver in copies_for::<P, true>(far, false, aboard) {
                    if let Some(distance) = distance {
                        observer.offered(&at_receiver.copy(far), distance);
                    }
                    observer.lost(&at_receiver.copy(far), LossCause::BelowSensitivity, now);
                }
            }
        }
    }

    /// Leaves those listeners for whom something in the frame is: the radios of others drop it. The rest is kept aside.
    fn narrow(&mut self, aboard: &[Spoken<P::Heard>]) {
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
    }

    /// Adds those listeners for whom something in the frame is and who are out of range.
    fn add_far(&mut self, now: SimTime, aboard: &[Spoken<P::Heard>], place: Surroundings<'_>) {
        let sender = aboard[0].frame.sender;
        for far in aboard.iter().filter_map(|spoken| spoken.to) {
            if self.is_in_range(far) {
                continue;
            }
            let there = place.world.position(far, now);
            self.listeners.push(Listener {
                id: far,
                sender: self.position - there,
            });
            if place.faults.trouble_links() {
                let loss = place.faults.link_loss((sender, self.position), (far, there));
                self.hindrances.push(loss);
            }
        }
    }

    /// Has the medium think of those, too, who count as out of range.
    #[inline(never)]
    fn add_beyond(&mut self, now: SimTime, sender: ActorId, place: Surroundings<'_>) {
        for listener in &self.beyond {
            self.is_beyond[listener.id.index()] = true;
            if place.faults.trouble_links() {
                let there = place.world.position(listener.id, now);
                let loss = place.faults.link_loss((sender, self.position), (listener.id, there));
                self.hindrances.push(loss);
            }
        }
        self.listeners.extend_from_slice(&self.beyond);
    }

    /// Leaves the listeners that were there before.
    #[inline(never)]
    fn leave_out_beyond(&mut self, in_range: usize) {
        self.listeners.truncate(in_range);
        self.hindrances.truncate(in_range);
        for listener in &self.beyond {
            self.is_beyond[listener.id.index()] = false;
        }
    }

    /// Transmits the messages `aboard` to the present listeners, for whom they share one fate each. `ADDRESSED`: whether one at least
    /// is for one robot.
    // Inlined where a frame has one message, nearly always, the loops over what is aboard are gone.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    pub(super) fn transmit<const ADDRESSED: bool>(
        &mut self,
        now: SimTime,
        aboard: &[Spoken<P::Heard>],
        place: Surroundings<'_>,
        observer: &mut impl Observer,
    ) {
        let Frame { sender, sequence, .. } = aboard[0].frame;
        let number = Numbers::next(&mut self.numbers[sender.index()].frame);
        let in_range = self.listeners.len();
        if observer.heeds_offers() {
            self.tell_offers::<ADDRESSED>(aboard, observer);
        }
        if !self.beyond.is_empty() && aboard.iter().any(|spoken| spoken.to.is_none()) {
            self.add_beyond(now, sender, place);
        }
        if !self.hindrances.is_empty() {
            self.hinder(sender, number, place.faults);
        }
        let to = aboard[0]
            .to
            .filter(|to| aboard.iter().all(|spoken| spoken.to == Some(*to)));
        let id = FrameId::with_messages(sender, number, sequence, aboard.len() as u32);
        let frame = Transmission {
            at: now,
            frame: id,
            bytes: self.bytes(aboard),
            to,
            position: self.position,
            listeners: if self.hindrances.is_empty() {
                &self.listeners
            } else {
                &self.reachable
            },
        };
        self.medium.transmit(&frame, place.world, &mut self.fates);
        debug_assert_eq!(self.fates.len(), self.listeners.len(), "each listener has one fate");
        if self.prefetches {
            self.prefetch_fates(P::topic(aboard[0].frame.message.borrow()), observer);
        }
        let beyond = self.listeners.len() > in_range;
        for (receiver, cause) in self.fates.losses.drain(..) {
            if beyond && self.is_beyond[receiver.index()] {
                continue;
            }
            for at_receiver in copies_for::<P, ADDRESSED>(receiver, true, aboard) {
                observer.lost(&at_receiver.copy(receiver), cause, now);
            }
        }
        for arrival in self.fates.arrivals.drain(..) {
            let strays = beyond && self.is_beyond[arrival.receiver.index()];
            if strays {
                self.strays.add(arrival.receiver, id, self.inboxes.len());
            }
            if self.tell_reached {
                self.reached.push(arrival.receiver);
            }
            let inbox = &mut self.inboxes[arrival.receiver.index()];
            for at_receiver in copies_for::<P, ADDRESSED>(arrival.receiver, true, aboard) {
                if strays && at_receiver.address == Address::Me {
                    continue;
                }
                if !strays {
                    observer.arrives(&at_receiver.copy(arrival.receiver), arrival.at);
                }
                inbox.push(Reception {
                    at: arrival.at,
                    frame: at_receiver.into_frame(),
                    displacement: arrival.displacement,
                });
            }
        }
        if !self.fates.open.is_empty() {
            self.await_fates::<ADDRESSED>(id, aboard, beyond);
        }
        if beyond {
            self.leave_out_beyond(in_range);
        }
        if !self.fates.conclusions.is_empty() {
            self.tell_conclusions(now, observer);
        }
    }

    /// Tells of the copies that the present listeners are offered.
    #[inline(never)]
    fn tell_offers<const ADDRESSED: bool>(&self, aboard: &[Spoken<P::Heard>], observer: &mut impl Observer) {
        for listener in &self.listeners {
            for at_receiver in copies_for::<P, ADDRESSED>(listener.id, true, aboard) {
                observer.offered(&at_receiver.copy(listener.id), listener.sender.norm());
            }
        }
    }

    /// The length of a frame with the messages `aboard`, headers included.
    #[inline]
    fn bytes(&self, aboard: &[Spoken<P::Heard>]) -> u32 {
        let message =
            |spoken: &Spoken<P::Heard>| u32::from(self.headers.message) + u32::from(spoken.frame.payload_bytes);
        u32::from(self.headers.frame) + aboard.iter().map(message).sum::<u32>()
    }

    /// Puts copies whose fates are open into the inboxes, where they wait for them.
    #[inline(never)]
    fn await_fates<const ADDRESSED: bool>(&mut self, id: FrameId, aboard: &[Spoken<P::Heard>], beyond: bool) {
        if self.prefetches {
            self.fates
                .open
                .iter()
                .for_each(|receiver| prefetch(&self.inboxes[receiver.index()]));
            self.fates
                .open
                .iter()
                .for_each(|receiver| self.inboxes[receiver.index()].prefetch_end());
        }
        let robots = self.inboxes.len();
        for receiver in self.fates.open.drain(..) {
            let inbox = &mut self.inboxes[receiver.index()];
            let strays = beyond && self.is_beyond[receiver.index()];
            if strays {
                self.strays.add(receiver, id, robots);
            }
            for at_receiver in copies_for::<P, ADDRESSED>(receiver, true, aboard) {
                // What is for a robot out of range and goes to everybody's ears was given up before.
                if strays && at_receiver.address == Address::Me {
                    continue;
                }
                inbox.push(Reception {
                    at: SimTime::NEVER,
                    frame: at_receiver.into_frame(),
                    displacement: [0.0; 2],
                });
            }
        }
    }

    /// Asks for where the fates of the present frame are written down.
    fn prefetch_fates(&self, topic: Topic, observer: &impl Observer) {
        for arrival in &self.fates.arrivals {
            self.inboxes[arrival.receiver.index()].prefetch_end();
        }
        for &(receiver, cause) in &self.fates.losses {
            observer.prefetch_lost(receiver, topic, cause);
        }
    }

    /// Finds the listeners that frame `number` of `sender` reaches in spite of the faults of links; the other copies are lost.
    fn hinder(&mut self, sender: ActorId, number: u32, faults: &Faults) {
        self.reachable.clear();
        for (listener, &loss) in self.listeners.iter().zip(&self.hindrances) {
            if faults.stops(loss, sender, listener.id, number) {
                self.fates.push(listener.id, Fate::Lost(LossCause::LinkFault));
            } else {
                self.reachable.push(*listener);
            }
        }
    }
}
