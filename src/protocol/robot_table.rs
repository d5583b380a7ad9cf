//! What one robot knows of others: a row each.

use crate::engine::{ActorId, prefetch_all};

/// What is known of a robot.
pub trait RobotRow {
    /// The robot that it is about.
    fn robot(&self) -> ActorId;
}

/// Rows about the few robots that one robot knows, out of a swarm of any size, one a robot at most.
///
/// Rows lie together, in an order that depends on what was added and removed and on nothing else. An open-addressed index
/// leads to them, at most half full: a look-up is a multiplication and mostly one read. The index holds row numbers alone,
/// for in a large swarm what counts is how much memory an arrival touches.
#[derive(Clone, Debug)]
pub struct RobotTable<R> {
    rows: Vec<R>,
    /// Row numbers by robot, or [`VACANT`]: a power of two of them, or none.
    slots: Vec<u32>,
}

const VACANT: u32 = u32::MAX;

/// Room for a few neighbours at once: a table that grows from one is moved four times on the way.
const FEWEST_SLOTS: usize = 32;

impl<R> Default for RobotTable<R> {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            slots: Vec::new(),
        }
    }
}

impl<R: RobotRow> RobotTable<R> {
    /// The row about `robot`, if there is one.
    #[inline]
    #[must_use]
    pub fn get(&self, robot: ActorId) -> Option<&R> {
        Some(&self.rows[self.row_of(robot)?])
    }

    /// The row about `robot`, if there is one.
    #[inline]
    #[must_use]
    pub fn get_mut(&mut self, robot: ActorId) -> Option<&mut R> {
        let row = self.row_of(robot)?;
        Some(&mut self.rows[row])
    }

    /// Adds `row`, about a robot that has none.
    pub fn add(&mut self, row: R) {
        debug_assert!(self.get(row.robot()).is_none(), "a robot has one row");
        if 2 * (self.rows.len() + 1) > self.slots.len() {
            self.grow();
            self.rows.reserve(self.slots.len() / 2 - self.rows.len());
        }
        let slot = self.slot_of(row.robot());
        self.slots[slot] = self.rows.len() as u32;
        self.rows.push(row);
    }

    /// Asks for its memory.
    #[inline]
    pub fn prefetch(&self) {
        prefetch_all(&self.slots);
        prefetch_all(&self.rows);
    }

    /// All rows.
    pub fn iter(&self) -> std::slice::Iter<'_, R> {
        self.rows.iter()
    }

    /// All rows.
    pub fn iter_mut(&mut self) -> std::slice::IterMut<'_, R> {
        self.rows.iter_mut()
    }

    /// Whether there is no row.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Removes the rows that are not to be kept. The last row takes the place of each that goes.
    pub fn retain(&mut self, keep: impl Fn(&R) -> bool) {
        let mut row = 0;
        while row < self.rows.len() {
            if keep(&self.rows[row]) {
                row += 1;
            } else {
                self.remove(row);
            }
        }
    }

    fn remove(&mut self, row: usize) {
        self.vacate(self.slot_of(self.rows[row].robot()));
        let last = self.rows.len() - 1;
        if row < last {
            let slot = self.slot_of(self.rows[last].robot());
            self.slots[slot] = row as u32;
        }
        self.rows.swap_remove(row);
    }

    /// Empties a slot. Later entries of the same run move up, so that no search ends early at the hole.
    fn vacate(&mut self, mut hole: usize) {
        let mask = self.slots.len() - 1;
        let mut next = hole;
        loop {
            next = (next + 1) & mask;
            let row = self.slots[next];
            if row == VACANT {
                self.slots[hole] = VACANT;
                return;
            }
            let home = self.home(self.rows[row as usize].robot());
            if next.wrapping_sub(home) & mask >= next.wrapping_sub(hole) & mask {
                self.slots[hole] = row;
                hole = next;
            }
        }
    }

    #[inline]
    fn row_of(&self, robot: ActorId) -> Option<usize> {
        if self.slots.is_empty() {
            return None;
        }
        let row = self.slots[self.slot_of(robot)];
        (row != VACANT).then_some(row as usize)
    }

    /// The slot of `robot`, or the vacant one where it would be.
    #[inline]
    fn slot_of(&self, robot: ActorId) -> usize {
        let mask = self.slots.len() - 1;
        let mut slot = self.home(robot);
        while self.slots[slot] != VACANT && self.rows[self.slots[slot] as usize].robot() != robot {
            slot = (slot + 1) & mask;
        }
        slot
    }

    #[inline]
    fn home(&self, robot: ActorId) -> usize {
        let spread = robot.0.wrapping_mul(0x9e37_79b9);
        (spread >> (u32::BITS - self.slots.len().trailing_zeros())) as usize
    }

    fn grow(&mut self) {
        let slots = (2 * self.slots.len()).max(FEWEST_SLOTS);
        self.slots.clear();
        self.slots.resize(slots, VACANT);
        for row in 0..self.rows.len() {
            let slot = self.slot_of(self.rows[row].robot());
            self.slots[slot] = row as u32;
        }
    }
}

impl<'t, R> IntoIterator for &'t RobotTable<R> {
    type Item = &'t R;
    type IntoIter = std::slice::Iter<'t, R>;

    fn into_iter(self) -> Self::IntoIter {
        self.rows.iter()
    }
}

impl<'t, R> IntoIterator for &'t mut RobotTable<R> {
    type Item = &'t mut R;
    type IntoIter = std::slice::IterMut<'t, R>;

    fn into_iter(self) -> Self::IntoIter {
        self.rows.iter_mut()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;

    #[derive(Clone, Debug, PartialEq)]
    struct Row(ActorId, u32);

    impl RobotRow for Row {
        fn robot(&self) -> ActorId {
            self.0
        }
    }

    proptest! {
        #[test]
        fn it_answers_like_a_map_whatever_is_added_and_removed(
            plan in prop::collection::vec((0_u32..60, prop::option::of(0_u32..1000)), 0..400),
            stride in 1_u32..100_000,
        ) {
            let mut table: RobotTable<Row> = RobotTable::default();
            let mut map = BTreeMap::new();
            for (robot, value) in plan {
                let id = ActorId(robot.wrapping_mul(stride));
                match (value, table.get_mut(id)) {
                    (Some(value), Some(row)) => { row.1 = value; map.insert(id, value); }
                    (Some(value), None) => { table.add(Row(id, value)); map.insert(id, value); }
                    (None, _) => {
                        table.retain(|row: &Row| row.1 % 7 != robot % 7);
                        map.retain(|_, value| *value % 7 != robot % 7);
                    }
                }
                for known in 0..60_u32 {
                    let id = ActorId(known.wrapping_mul(stride));
                    prop_assert_eq!(table.get(id).map(|row| row.1), map.get(&id).copied());
                }
                prop_assert_eq!(table.iter().count(), map.len());
                prop_assert_eq!(table.is_empty(), map.is_empty());
            }
        }
    }
}
