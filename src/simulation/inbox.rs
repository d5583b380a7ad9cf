//! Where copies of frames wait for their fate and for their receiver: they go straight here, not through the event queue.

use std::cmp::Ordering;

use crate::engine::{SimTime, prefetch, prefetch_all, prefetch_end, push_tight};
use crate::protocol::{Frame, Reception};
use crate::radio::FrameId;

/// Frames on their way to one robot, and those that arrived since it last woke. Aligned so that none lies across two cache
/// lines: every copy of every frame reads one.
#[derive(Debug)]
#[repr(align(32))]
pub struct Inbox<M> {
    waiting: Vec<Reception<M>>,
    /// No waiting frame arrives later than this.
    latest: SimTime,
}

impl<M> Default for Inbox<M> {
    fn default() -> Self {
        Self {
            waiting: Vec::new(),
            latest: SimTime::ZERO,
        }
    }
}

impl<M> Inbox<M> {
    /// Asks for the memory of the next [`push`](Self::push).
    #[inline]
    pub fn prefetch_end(&self) {
        prefetch_end(&self.waiting);
    }

    /// Asks for what came last.
    pub fn prefetch_last(&self) {
        if let Some(last) = self.waiting.last() {
            prefetch(last);
        }
    }

    /// Asks for all that is waiting.
    pub fn prefetch_contents(&self) {
        prefetch_all(&self.waiting);
    }

    /// Takes in a frame that will arrive at `reception.at`; `NEVER` if its fate is open.
    #[inline]
    pub fn push(&mut self, reception: Reception<M>) {
        self.latest = self.latest.max(reception.at);
        push_tight(&mut self.waiting, reception);
    }

    /// Moves what has arrived by `now` into the empty `arrived`, in order of arrival, then of sender and its sequence.
    pub fn take_arrived(&mut self, now: SimTime, arrived: &mut Vec<Reception<M>>) {
        // Moved and not exchanged: so an inbox stays where it is in memory, and as large as its robot needs it, and what is read is in the cache.
        arrived.append(&mut self.waiting);
        if self.latest > now {
            // Few are still under way when a robot wakes: they go back.
            self.latest = SimTime::ZERO;
            let mut next = 0;
            while let Some(reception) = arrived.get(next) {
                if reception.at > now {
                    self.push(arrived.swap_remove(next));
                } else {
                    next += 1;
                }
            }
        }
        let in_order = |pair: &[Reception<M>]| arrival_order(&pair[0], &pair[1]).is_le();
        if arrived.len() <= FEW {
            arrived.sort_unstable_by(arrival_order);
        } else if !arrived.windows(2).all(in_order) {
            sort_nearly_sorted(arrived);
        }
    }

    /// What is open of `frame` arrives at `at`, with its sender at `displacement`; `tell` is called with each message. Whether anything was open.
    pub fn arrive(
        &mut self,
        frame: FrameId,
        at: SimTime,
        displacement: [f32; 2],
        mut tell: impl FnMut(&Frame<M>),
    ) -> bool {
        // It came lately, and is looked for from the end on.
        let open = self.waiting.iter_mut().rev().filter(|copy| is_open(copy, frame));
        let mut found = false;
        for reception in open.take(frame.messages() as usize) {
            reception.at = at;
            reception.displacement = displacement;
            tell(&reception.frame);
            found = true;
        }
        found
    }

    /// What is open of `frame` is lost: `lose` is called with each message. Whether anything was open.
    pub fn lose(&mut self, frame: FrameId, mut lose: impl FnMut(Reception<M>)) -> bool {
        let mut found = false;
        for _ in 0..frame.messages() {
            let Some(place) = self.waiting.iter().rposition(|copy| is_open(copy, frame)) else {
                break;
            };
            // Those behind it stay in order: they are few, and mostly arrive in it.
            lose(self.waiting.remove(place));
            found = true;
        }
        found
    }

    /// Takes out what arrives within `from..until`, and calls `lose` with each.
    pub fn drop_arrivals(&mut self, from: SimTime, until: SimTime, lose: impl FnMut(Reception<M>)) {
        let lost = |reception: &mut Reception<M>| (from..until).contains(&reception.at);
        self.waiting.extract_if(.., lost).for_each(lose);
    }

    /// The earliest arrival still waiting; `NEVER` if the fate of all is open.
    pub fn next_arrival(&self) -> Option<SimTime> {
        self.waiting.iter().map(|reception| reception.at).min()
    }

    /// All that is still waiting, arrived or not.
    pub fn waiting(&self) -> &[Reception<M>] {
        &self.waiting
    }
}

fn is_open<M>(reception: &Reception<M>, frame: FrameId) -> bool {
    reception.at == SimTime::NEVER && frame.holds(reception.frame.sender, reception.frame.sequence)
}

/// So many the library sorts by insertion too.
const FEW: usize = 20;

/// Sorts what mostly is in order: each is taken forward past the few that it is late by. What is far from order is left to the library.
#[inline(never)]
fn sort_nearly_sorted<M>(receptions: &mut [Reception<M>]) {
    let mut patience = 8 * receptions.len();
    for next in 1..receptions.len() {
        let (earlier, rest) = receptions.split_at(next);
        let late = earlier
            .iter()
            .rev()
            .take_while(|other| arrival_order(&rest[0], other).is_lt());
        let late = late.take(patience).count();
        if late > 0 {
            receptions[next - late..=next].rotate_right(1);
        }
        patience -= late;
        if patience == 0 {
            receptions.sort_unstable_by(arrival_order);
            return;
        }
    }
}

fn arrival_order<M>(a: &Reception<M>, b: &Reception<M>) -> Ordering {
    a.at.cmp(&b.at)
        .then_with(|| (a.frame.sender, a.frame.sequence).cmp(&(b.frame.sender, b.frame.sequence)))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::engine::ActorId;
    use crate::protocol::{Address, Frame};

    fn reception(at: u64, sender: u32, sequence: u32) -> Reception<()> {
        Reception {
            at: SimTime::from_nanos(at),
            frame: Frame {
                sender: ActorId(sender),
                sequence,
                sent_at: SimTime::ZERO,
                payload_bytes: 4,
                rides: false,
                address: Address::Everyone,
                message: (),
            },
            displacement: [0.0; 2],
        }
    }

    /// Two messages of robot 1 in one frame and one of robot 2 are open beside one that has arrived.
    #[test]
    fn an_open_copy_waits_until_its_frame_arrives_or_is_lost() {
        const OPEN: u64 = u64::MAX;
        let frame = FrameId::with_messages(ActorId(1), 3, 7, 2);
        let fresh = || {
            let mut inbox = Inbox::default();
            let copies = [(OPEN, 1, 7), (OPEN, 1, 8), (OPEN, 2, 7), (5, 1, 6)];
            for (at, sender, sequence) in copies {
                inbox.push(reception(at, sender, sequence));
            }
            inbox
        };
        let read = |inbox: &mut Inbox<()>, now| {
            let mut arrived = Vec::new();
            inbox.take_arrived(SimTime::from_nanos(now), &mut arrived);
            arrived
                .iter()
                .map(|copy| (copy.frame.sender.0, copy.frame.sequence))
                .collect::<Vec<_>>()
        };

        let mut inbox = fresh();
        assert_eq!(inbox.next_arrival(), Some(SimTime::from_nanos(5)));
        for (now, arrived) in [(9, vec![(1, 6)]), (10, vec![]), (10, vec![])] {
            assert_eq!(read(&mut inbox, now), arrived);
        }
        let mut told = Vec::new();
        let at = SimTime::from_nanos(20);
        assert!(inbox.arrive(frame, at, [0.0, 2.0], |frame| told.push(frame.sequence)));
        told.sort_unstable();
        assert_eq!(told, [7, 8]);
        assert!(!inbox.arrive(frame, at, [0.0; 2], |_| ()), "it is not open any more");
        assert!(!inbox.lose(frame, |_| ()));
        let displaced = inbox.waiting().iter().filter(|copy| copy.displacement()[1] > 1.0);
        assert_eq!(displaced.count(), 2);
        assert_eq!(read(&mut inbox, 19), []);
        assert_eq!(read(&mut inbox, 20), [(1, 7), (1, 8)]);
        assert_eq!(inbox.waiting().len(), 1);

        let mut inbox = fresh();
        let mut lost = Vec::new();
        assert!(inbox.lose(frame, |copy| lost.push(copy.frame.sequence)));
        lost.sort_unstable();
        assert_eq!(lost, [7, 8]);
        assert!(!inbox.lose(FrameId::new(ActorId(1), 6), |_| ()), "that one has arrived");
        assert_eq!(read(&mut inbox, 20), [(1, 6)]);
        assert_eq!(inbox.waiting().len(), 1);
    }

    proptest! {
        #[test]
        fn every_frame_is_read_once_by_the_first_wake_at_or_after_its_arrival_and_in_order(
            frames in prop::collection::vec((0_u64..100, 0_u32..5), 0..60),
            mut wakes in prop::collection::vec(0_u64..120, 1..10),
        ) {
            wakes.sort_unstable();
            let mut inbox = Inbox::default();
            for (sequence, &(at, sender)) in frames.iter().enumerate() {
                inbox.push(reception(at, sender, sequence as u32));
            }
            let mut read = Vec::new();
            for &wake in &wakes {
                let mut arrived = Vec::new();
                inbox.take_arrived(SimTime::from_nanos(wake), &mut arrived);
                prop_assert!(arrived.iter().all(|reception| reception.at.as_nanos() <= wake));
                read.extend(arrived.iter().map(|r| (r.at.as_nanos(), r.frame.sender.0, r.frame.sequence)));
            }
            prop_assert!(read.is_sorted());
            let last = *wakes.last().unwrap();
            prop_assert_eq!(read.len(), frames.iter().filter(|frame| frame.0 <= last).count());
            prop_assert_eq!(inbox.waiting().len(), frames.len() - read.len());
        }
    }
}
