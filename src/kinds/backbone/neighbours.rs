//! What a robot knows of the robots around it, from their statuses.

use crate::engine::{ActorId, SimTime};
use crate::geometry::Vec2;

use super::message::Status;
use crate::protocol::robot_table::{RobotRow, RobotTable};

/// A robot that was heard of late.
#[derive(Clone, Copy, Debug)]
pub struct Neighbour {
    /// Who.
    pub id: ActorId,
    /// The last frame that it was heard by, among those it sent.
    sequence: u32,
    /// When it was last heard.
    pub heard: SimTime,
    /// Where it was then, metres, in the arena's axes.
    pub position: Vec2,
    /// What it said then.
    pub status: Status,
}

impl RobotRow for Neighbour {
    fn robot(&self) -> ActorId {
        self.id
    }
}

/// The neighbour table.
#[derive(Debug, Default)]
pub struct Neighbours(RobotTable<Neighbour>);

impl Neighbours {
    /// Takes in a status that `id` sent as its frame number `sequence`, from `position`, and that arrived at `heard`.
    /// One that was overtaken by a newer one counts as a sign of life and says nothing else.
    pub fn hear(&mut self, id: ActorId, sequence: u32, heard: SimTime, position: Vec2, status: Status) {
        let Some(known) = self.0.get_mut(id) else {
            self.0.add(Neighbour {
                id,
                sequence,
                heard,
                position,
                status,
            });
            return;
        };
        known.heard = heard;
        if sequence.wrapping_sub(known.sequence).cast_signed() > 0 {
            known.sequence = sequence;
            known.position = position;
            known.status = status;
        }
    }

    /// What is known of `id`, if it was heard of late.
    #[must_use]
    pub fn get(&self, id: ActorId) -> Option<&Neighbour> {
        self.0.get(id)
    }

    /// All of them, in an order that depends on what was heard and on nothing else.
    pub fn iter(&self) -> std::slice::Iter<'_, Neighbour> {
        self.0.iter()
    }

    /// Whether nobody was heard of late.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Forgets those that are `down`.
    pub fn forget(&mut self, down: impl Fn(ActorId) -> bool) {
        self.0.retain(|known| !down(known.id));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    fn hear(neighbours: &mut Neighbours, id: u32, sequence: u32, seconds: f64, x: f64) {
        let at = SimTime::from_secs(seconds);
        neighbours.hear(ActorId(id), sequence, at, Vec2::new(x, 0.0), Status::default());
    }

    #[test]
    fn a_status_overtaken_on_the_way_keeps_the_robot_alive_and_changes_nothing_else() {
        let mut neighbours = Neighbours::default();
        hear(&mut neighbours, 3, 8, 1.0, 0.8);
        hear(&mut neighbours, 3, 7, 1.1, 0.7);
        let known = neighbours.get(ActorId(3)).unwrap();
        assert_eq!((known.heard, known.position.x), (SimTime::from_secs(1.1), 0.8));
    }

    proptest! {
        #[test]
        fn the_table_agrees_with_a_map_after_any_hearing_and_forgetting(
            events in prop::collection::vec((0_u32..12, prop::option::weighted(0.9, 0.0..1.0_f64)), 1..200),
        ) {
            let mut neighbours = Neighbours::default();
            let mut model: BTreeMap<u32, (SimTime, f64)> = BTreeMap::new();
            for (step, (id, heard)) in events.into_iter().enumerate() {
                let now = step as f64 / 10.0;
                if let Some(x) = heard {
                    hear(&mut neighbours, id, step as u32, now, x);
                    model.insert(id, (SimTime::from_secs(now), x));
                } else {
                    neighbours.forget(|robot| robot.0 % 5 == id % 5);
                    model.retain(|robot, _| robot % 5 != id % 5);
                }
                prop_assert_eq!(neighbours.iter().count(), model.len());
                for id in 0..12 {
                    let known = neighbours.get(ActorId(id)).map(|known| (known.heard, known.position.x));
                    prop_assert_eq!(known, model.get(&id).copied());
                }
            }
        }
    }
}
