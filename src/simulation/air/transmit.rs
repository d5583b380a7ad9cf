//! A frame on air: who is offered what of it, and what becomes of each copy.

use std::borrow::Borrow as _;

use super::{Air, Arrival, Spoken};
use crate::engine::{ActorId, SimTime};
use crate::faults::Faults;
use crate::happenings::{Copy, Observer};
use crate::protocol::{Address, Frame, MessageSize, Protocol, Reception, Topic};
use crate::radio::{Fate, Listener, LossCause, Medium};

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

/// What becomes of the next frame of `sender` at each of `listeners`. The same for all protocols, so that it is compiled once and
/// the medium's arithmetic into it.
#[inline(never)]
fn decide(
    medium: &mut Medium,
    now: SimTime,
    sender: ActorId,
    listeners: &[Listener],
    arrivals: &mut Vec<Arrival>,
    losses: &mut Vec<(ActorId, LossCause)>,
) {
    medium.transmit(now, sender, listeners.iter().copied(), |receiver, fate| match fate {
        Fate::Arrives { at, displacement } => arrivals.push(Arrival {
            receiver,
            at,
            displacement,
        }),
        Fate::Lost(cause) => losses.push((receiver, cause)),
    });
}

impl<P: Protocol> Air<P> {
    /// Transmits the messages `aboard`, one at least and all of one sender, as one frame.
    #[inline(never)]
    pub(super) fn send(
        &mut self,
        now: SimTime,
        aboard: &[Spoken<P::Heard>],
        faults: &Faults,
        observer: &mut impl Observer,
    ) {
        if aboard.iter().all(|spoken| spoken.to.is_none()) {
            return self.transmit::<false>(now, aboard, faults, observer);
        }
        self.give_up_far(aboard);
        let everyone = P::OVERHEARS || aboard.iter().any(|spoken| spoken.to.is_none());
        if !everyone {
            self.narrow(aboard);
        }
        self.transmit::<true>(now, aboard, faults, observer);
        if !everyone {
            std::mem::swap(&mut self.listeners, &mut self.all_listeners);
            std::mem::swap(&mut self.hindrances, &mut self.all_hindrances);
        }
    }

    /// Loses what is for robots out of range.
    fn give_up_far(&mut self, aboard: &[Spoken<P::Heard>]) {
        for to in aboard.iter().filter_map(|spoken| spoken.to) {
            if !self.is_in_range(to) && !self.losses.iter().any(|loss| loss.0 == to) {
                self.losses.push((to, LossCause::BelowSensitivity));
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

    /// Transmits the messages `aboard` to the present listeners, for whom they share one fate each. `ADDRESSED`: whether one at least
    /// is for one robot.
    // Inlined where a frame has one message, nearly always, the loops over what is aboard are gone.
    #[allow(clippy::inline_always)]
    #[inline(always)]
    pub(super) fn transmit<const ADDRESSED: bool>(
        &mut self,
        now: SimTime,
        aboard: &[Spoken<P::Heard>],
        faults: &Faults,
        observer: &mut impl Observer,
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
        decide(medium, now, sender, listeners, arrivals, losses);
        if self.prefetches {
            self.prefetch_fates(P::topic(aboard[0].frame.message.borrow()), observer);
        }
        for (receiver, cause) in self.losses.drain(..) {
            for at_receiver in copies_for::<P, ADDRESSED>(receiver, cause != LossCause::BelowSensitivity, aboard) {
                observer.lost(&at_receiver.copy(receiver), cause, now);
            }
        }
        for arrival in self.arrivals.drain(..) {
            if self.tell_reached {
                self.reached.push(arrival.receiver);
            }
            let inbox = &mut self.inboxes[arrival.receiver.index()];
            for at_receiver in copies_for::<P, ADDRESSED>(arrival.receiver, true, aboard) {
                observer.arrives(&at_receiver.copy(arrival.receiver), arrival.at);
                inbox.push(Reception {
                    at: arrival.at,
                    frame: at_receiver.into_frame(),
                    displacement: arrival.displacement,
                });
            }
        }
    }

    /// Asks for where the fates of the present frame are written down.
    fn prefetch_fates(&self, topic: Topic, observer: &impl Observer) {
        for arrival in &self.arrivals {
            self.inboxes[arrival.receiver.index()].prefetch_end();
        }
        for &(receiver, cause) in &self.losses {
            observer.prefetch_lost(receiver, topic, cause);
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
}
