//! Frames and bytes by robot, role and topic: a table that a reception finds its cell in by two additions.

use crate::engine::ActorId;
use crate::protocol::{Role, Topic};
use crate::radio::LossCause;

use super::record::{TrafficRow, Volume};

/// Frames and their payload; headers follow from the number of frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Count {
    frames: u64,
    payload_bytes: u64,
}

impl Count {
    #[inline]
    fn add(&mut self, payload_bytes: u32) {
        self.frames += 1;
        self.payload_bytes += u64::from(payload_bytes);
    }

    fn volume(self, header_bytes: u16) -> Volume {
        Volume {
            frames: self.frames,
            payload_bytes: self.payload_bytes,
            header_bytes: self.frames * u64::from(header_bytes),
        }
    }
}

/// Traffic of one robot while in one role, on one topic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Cell {
    sent: Count,
    received: Count,
    lost: [Count; LossCause::ALL.len()],
}

/// The traffic of a trial, dense in robots × roles × topics.
#[derive(Debug)]
pub(super) struct Traffic {
    roles: usize,
    topics: usize,
    header_bytes: u16,
    cells: Vec<Cell>,
    /// Where the cells of each robot's present role begin.
    rows: Vec<u32>,
}

impl Traffic {
    /// No traffic yet, every robot in the first role.
    pub(super) fn new(robots: usize, roles: usize, topics: usize, header_bytes: u16) -> Self {
        Self {
            roles,
            topics,
            header_bytes,
            cells: vec![Cell::default(); robots * roles * topics],
            rows: (0..robots).map(|robot| (robot * roles * topics) as u32).collect(),
        }
    }

    /// Accounts what follows for `robot` to `role`.
    ///
    /// # Panics
    /// If the protocol has no such role: its traffic would be another robot's.
    pub(super) fn enter(&mut self, robot: ActorId, role: Role) {
        let role = usize::from(role.0);
        assert!(
            role < self.roles,
            "role {role} reported by robot {robot}, but the protocol has {} roles",
            self.roles
        );
        self.rows[robot.index()] = ((robot.index() * self.roles + role) * self.topics) as u32;
    }

    #[inline]
    pub(super) fn sent(&mut self, robot: ActorId, topic: Topic, payload_bytes: u32) {
        self.cell(robot, topic).sent.add(payload_bytes);
    }

    #[inline]
    pub(super) fn received(&mut self, robot: ActorId, topic: Topic, payload_bytes: u32) {
        self.cell(robot, topic).received.add(payload_bytes);
    }

    #[inline]
    pub(super) fn lost(&mut self, robot: ActorId, topic: Topic, cause: LossCause, payload_bytes: u32) {
        self.cell(robot, topic).lost[cause as usize].add(payload_bytes);
    }

    #[inline]
    fn cell(&mut self, robot: ActorId, topic: Topic) -> &mut Cell {
        debug_assert!(
            usize::from(topic.0) < self.topics,
            "topic {} of {}",
            topic.0,
            self.topics
        );
        &mut self.cells[self.rows[robot.index()] as usize + usize::from(topic.0)]
    }

    /// The cells that saw traffic, by robot, role, topic.
    pub(super) fn rows(&self) -> Vec<TrafficRow> {
        let per_robot = self.roles * self.topics;
        let used = self
            .cells
            .iter()
            .enumerate()
            .filter(|(_, cell)| **cell != Cell::default());
        used.map(|(index, cell)| TrafficRow {
            robot: ActorId((index / per_robot) as u32),
            role: (index % per_robot / self.topics) as u8,
            topic: (index % self.topics) as u8,
            sent: cell.sent.volume(self.header_bytes),
            received: cell.received.volume(self.header_bytes),
            lost: cell.lost.map(|count| count.volume(self.header_bytes)),
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn traffic_is_accounted_to_the_role_held_when_it_flowed() {
        let mut traffic = Traffic::new(2, 2, 2, 5);
        let robot = ActorId(1);
        traffic.sent(robot, Topic(0), 4);
        traffic.enter(robot, Role(1));
        traffic.received(robot, Topic(1), 7);
        traffic.received(robot, Topic(1), 9);
        traffic.lost(robot, Topic(1), LossCause::Channel, 3);
        let rows = traffic.rows();
        assert_eq!(
            rows.iter()
                .map(|row| (row.robot, row.role, row.topic))
                .collect::<Vec<_>>(),
            [(robot, 0, 0), (robot, 1, 1)]
        );
        assert_eq!(
            rows[0].sent,
            Volume {
                frames: 1,
                payload_bytes: 4,
                header_bytes: 5
            }
        );
        assert_eq!(
            rows[1].received,
            Volume {
                frames: 2,
                payload_bytes: 16,
                header_bytes: 10
            }
        );
        assert_eq!(
            rows[1].lost[LossCause::Channel as usize],
            Volume {
                frames: 1,
                payload_bytes: 3,
                header_bytes: 5
            }
        );
    }

    #[test]
    #[should_panic(expected = "role 2 reported by robot 0, but the protocol has 2 roles")]
    fn a_role_that_the_protocol_does_not_have_is_refused() {
        Traffic::new(1, 2, 1, 0).enter(ActorId(0), Role(2));
    }
}
