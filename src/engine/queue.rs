//! The event queue: one entry a key, moved when its time moves, first-in-first-out on ties.

use std::cmp::Reverse;
use std::hash::{BuildHasherDefault, Hash, Hasher};

use priority_queue::PriorityQueue;

use super::SimTime;

/// What can be scheduled. A key stands in the queue at most once; scheduling it again moves it.
pub trait EventKey: Copy + Eq + Hash {
    /// Rank among events at the same instant, lowest first.
    fn class(&self) -> u8;
}

/// When an entry is due: by time, then class, then the order of scheduling.
type Due = Reverse<(SimTime, u8, u64)>;

/// Pending events, earliest first.
///
/// `priority-queue` neither orders equal priorities nor keeps two equal items; the sequence number does the
/// first, and the second is what makes moving and cancelling an event cheap.
#[derive(Debug)]
pub struct EventQueue<K: EventKey> {
    entries: PriorityQueue<K, Due, BuildHasherDefault<KeyHasher>>,
    scheduled: u64,
}

impl<K: EventKey> EventQueue<K> {
    /// An empty queue with room for `capacity` entries.
    #[must_use]
    pub fn with_capacity(capacity: usize) -> Self {
        Self {
            entries: PriorityQueue::with_capacity_and_hasher(capacity, BuildHasherDefault::default()),
            scheduled: 0,
        }
    }

    /// Schedules `key` at `time`, behind what is already due then in its class. Moves it if it is pending.
    pub fn schedule(&mut self, key: K, time: SimTime) {
        self.scheduled += 1;
        self.entries.push(key, Reverse((time, key.class(), self.scheduled)));
    }

    /// Removes `key`; says whether it was pending.
    pub fn cancel(&mut self, key: &K) -> bool {
        self.entries.remove(key).is_some()
    }

    /// The earliest event, without removing it.
    #[must_use]
    pub fn peek(&self) -> Option<(K, SimTime)> {
        self.entries.peek().map(|(key, Reverse((time, ..)))| (*key, *time))
    }

    /// Removes and returns the earliest event.
    pub fn pop(&mut self) -> Option<(K, SimTime)> {
        self.entries.pop().map(|(key, Reverse((time, ..)))| (key, time))
    }

    /// Number of pending events.
    #[must_use]
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether nothing is pending.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
}

/// Hashes the few machine words of an event key by multiplication: keys are ours, so nobody attacks them,
/// and the map's order never reaches a result.
#[derive(Default)]
pub struct KeyHasher(u64);

impl Hasher for KeyHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(u64::from(byte));
        }
    }

    fn write_u32(&mut self, word: u32) {
        self.write_u64(u64::from(word));
    }

    fn write_u64(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 ^= self.0 >> 32;
    }

    fn write_usize(&mut self, word: usize) {
        self.write_u64(word as u64);
    }

    fn write_isize(&mut self, word: isize) {
        self.write_u64(word as u64);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    struct Key {
        id: u32,
        class: u8,
    }

    impl EventKey for Key {
        fn class(&self) -> u8 {
            self.class
        }
    }

    fn key(id: u32) -> Key {
        Key { id, class: 0 }
    }

    #[test]
    fn equal_times_pop_in_the_order_of_scheduling() {
        let mut queue = EventQueue::with_capacity(8);
        for id in [5, 1, 4, 2, 3] {
            queue.schedule(key(id), SimTime::from_secs(1.0));
        }
        let order: Vec<u32> = std::iter::from_fn(|| queue.pop()).map(|(key, _)| key.id).collect();
        assert_eq!(order, [5, 1, 4, 2, 3]);
    }

    #[test]
    fn a_lower_class_goes_first_at_one_instant() {
        let mut queue = EventQueue::with_capacity(2);
        queue.schedule(Key { id: 1, class: 3 }, SimTime::ZERO);
        queue.schedule(Key { id: 2, class: 0 }, SimTime::ZERO);
        assert_eq!(queue.pop().map(|(key, _)| key.id), Some(2));
    }

    #[test]
    fn a_moved_event_fires_once_at_its_new_time_and_a_cancelled_one_never() {
        let mut queue = EventQueue::with_capacity(2);
        queue.schedule(key(1), SimTime::from_secs(1.0));
        queue.schedule(key(2), SimTime::from_secs(2.0));
        queue.schedule(key(1), SimTime::from_secs(3.0));
        assert!(queue.cancel(&key(2)));
        assert!(!queue.cancel(&key(2)));
        assert_eq!(queue.pop(), Some((key(1), SimTime::from_secs(3.0))));
        assert_eq!(queue.pop(), None);
    }

    proptest! {
        #[test]
        fn events_pop_sorted_by_time_class_and_last_scheduling(
            plan in prop::collection::vec((0_u32..20, 0_u64..5), 1..200),
        ) {
            let class = |id: u32| (id % 3) as u8;
            let mut queue = EventQueue::with_capacity(20);
            let mut expected: Vec<(u64, u8, usize, u32)> = Vec::new();
            for (order, &(id, nanos)) in plan.iter().enumerate() {
                queue.schedule(Key { id, class: class(id) }, SimTime::from_nanos(nanos));
                expected.retain(|entry| entry.3 != id);
                expected.push((nanos, class(id), order, id));
            }
            expected.sort_unstable();
            let popped: Vec<(u64, u32)> = std::iter::from_fn(|| queue.pop())
                .map(|(key, time)| (time.as_nanos(), key.id))
                .collect();
            let expected: Vec<(u64, u32)> = expected.iter().map(|entry| (entry.0, entry.3)).collect();
            prop_assert_eq!(popped, expected);
        }
    }
}
