//! From a robot's id to its row in a table of neighbours.

use crate::engine::ActorId;

/// An index of the few robots that one robot knows, out of a swarm of any size: an open-addressed table, at most half
/// full, so that a look-up is a multiplication and mostly one read. Its order never shows.
#[derive(Debug, Default)]
pub struct RowIndex {
    /// A power of two of slots, or none.
    slots: Vec<Slot>,
    used: usize,
}

#[derive(Clone, Copy, Debug)]
struct Slot {
    id: u32,
    /// The row, or [`VACANT`].
    row: u32,
}

const VACANT: u32 = u32::MAX;
const EMPTY: Slot = Slot { id: 0, row: VACANT };

impl RowIndex {
    /// The row of `id`, if it has one.
    #[inline]
    #[must_use]
    pub fn get(&self, id: ActorId) -> Option<usize> {
        if self.slots.is_empty() {
            return None;
        }
        let slot = self.slots[self.find(id)];
        (slot.row != VACANT).then_some(slot.row as usize)
    }

    /// Gives `id` the row `row`, instead of the one that it may have had.
    pub fn set(&mut self, id: ActorId, row: usize) {
        if 2 * (self.used + 1) > self.slots.len() {
            self.grow();
        }
        let place = self.find(id);
        self.used += usize::from(self.slots[place].row == VACANT);
        self.slots[place] = Slot {
            id: id.0,
            row: row as u32,
        };
    }

    /// Forgets `id`.
    pub fn remove(&mut self, id: ActorId) {
        if self.get(id).is_none() {
            return;
        }
        let mut hole = self.find(id);
        self.used -= 1;
        // Later entries of the same run move up, so that no search ends early at the hole.
        let mut next = hole;
        loop {
            self.slots[hole] = EMPTY;
            loop {
                next = (next + 1) & (self.slots.len() - 1);
                let slot = self.slots[next];
                if slot.row == VACANT {
                    return;
                }
                let home = self.home(slot.id);
                let mask = self.slots.len() - 1;
                if next.wrapping_sub(home) & mask >= next.wrapping_sub(hole) & mask {
                    self.slots[hole] = slot;
                    hole = next;
                    break;
                }
            }
        }
    }

    /// Where `id` stands, or the vacant slot where it would.
    #[inline]
    fn find(&self, id: ActorId) -> usize {
        let mask = self.slots.len() - 1;
        let mut place = self.home(id.0);
        while self.slots[place].row != VACANT && self.slots[place].id != id.0 {
            place = (place + 1) & mask;
        }
        place
    }

    #[inline]
    fn home(&self, id: u32) -> usize {
        let spread = id.wrapping_mul(0x9e37_79b9);
        (spread >> (u32::BITS - self.slots.len().trailing_zeros())) as usize
    }

    fn grow(&mut self) {
        let doubled = vec![EMPTY; (2 * self.slots.len()).max(8)];
        for slot in std::mem::replace(&mut self.slots, doubled) {
            if slot.row != VACANT {
                let place = self.find(ActorId(slot.id));
                self.slots[place] = slot;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn it_answers_like_a_map_whatever_is_set_and_removed(
            plan in prop::collection::vec((0_u32..60, prop::option::of(0_usize..1000)), 0..400),
            stride in 1_u32..100_000,
        ) {
            let mut index = RowIndex::default();
            let mut map = BTreeMap::new();
            for (id, row) in plan {
                let id = ActorId(id.wrapping_mul(stride));
                match row {
                    Some(row) => { index.set(id, row); map.insert(id, row); }
                    None => { index.remove(id); map.remove(&id); }
                }
                for known in 0..60_u32 {
                    let id = ActorId(known.wrapping_mul(stride));
                    prop_assert_eq!(index.get(id), map.get(&id).copied());
                }
            }
        }
    }
}
