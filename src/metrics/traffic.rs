//! Frames and bytes by robot, role and topic: a table that a reception finds its cell in by two additions.

use crate::engine::ActorId;
use crate::protocol::{Role, Topic};
use crate::radio::LossCause;

use super::record::{TrafficRow, Volume};

/// Frames and their payload; headers follow from the number of frames.
#[derive(Clone, Copy, Debug, Default)]
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

/// Bytes of a robot on a topic, headers included.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RobotTraffic {
    pub(super) sent_bytes: u64,
    pub(super) received_bytes: u64,
}

/// The traffic of a trial, dense in robots × roles × topics. What is sent, received and lost stands apart: receptions,
/// by far the most, then share a table small enough to stay in the cache.
#[derive(Debug)]
pub(super) struct Traffic {
    roles: usize,
    topics: usize,
    header_bytes: u16,
    sent: Vec<Count>,
    received: Vec<Count>,
    /// A table for each cause, in the order of their numbers.
    lost: [Vec<Count>; LossCause::ALL.len()],
    /// Where the cells of each robot's present role begin in these tables.
    starts: Vec<u32>,
}

impl Traffic {
    /// No traffic yet, every robot in the first role.
    pub(super) fn new(robots: usize, roles: usize, topics: usize, header_bytes: u16) -> Self {
        let cells = robots * roles * topics;
        Self {
            roles,
            topics,
            header_bytes,
            sent: vec![Count::default(); cells],
            received: vec![Count::default(); cells],
            lost: LossCause::ALL.map(|_| vec![Count::default(); cells]),
            starts: (0..robots).map(|robot| (robot * roles * topics) as u32).collect(),
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
        self.starts[robot.index()] = ((robot.index() * self.roles + role) * self.topics) as u32;
    }

    #[inline]
    pub(super) fn sent(&mut self, robot: ActorId, topic: Topic, payload_bytes: u32) {
        let cell = self.cell(robot, topic);
        self.sent[cell].add(payload_bytes);
    }

    #[inline]
    pub(super) fn received(&mut self, robot: ActorId, topic: Topic, payload_bytes: u32) {
        let cell = self.cell(robot, topic);
        self.received[cell].add(payload_bytes);
    }

    #[inline]
    pub(super) fn lost(&mut self, robot: ActorId, topic: Topic, cause: LossCause, payload_bytes: u32) {
        let cell = self.cell(robot, topic);
        self.lost[cause as usize][cell].add(payload_bytes);
    }

    #[inline]
    fn cell(&self, robot: ActorId, topic: Topic) -> usize {
        debug_assert!(
            usize::from(topic.0) < self.topics,
            "topic {} of {}",
            topic.0,
            self.topics
        );
        self.starts[robot.index()] as usize + usize::from(topic.0)
    }

    /// Number of topics.
    pub(super) fn topics(&self) -> usize {
        self.topics
    }

    /// Bytes of each robot on each topic, in whatever role, headers included: robot by robot, topic by topic.
    pub(super) fn by_robot_and_topic(&self) -> Vec<RobotTraffic> {
        let bytes = |count: &Count| count.volume(self.header_bytes).bytes();
        let robots = self.starts.len();
        let mut sums = vec![RobotTraffic::default(); robots * self.topics];
        let per_robot = self.roles * self.topics;
        for (cell, (sent, received)) in self.sent.iter().zip(&self.received).enumerate() {
            let sum = &mut sums[cell / per_robot * self.topics + cell % self.topics];
            sum.sent_bytes += bytes(sent);
            sum.received_bytes += bytes(received);
        }
        sums
    }

    /// The cells that saw traffic, by robot, role, topic.
    pub(super) fn rows(&self) -> Vec<TrafficRow> {
        (0..self.sent.len())
            .filter(|&cell| self.saw_traffic(cell))
            .map(|cell| self.row(cell))
            .collect()
    }

    fn saw_traffic(&self, cell: usize) -> bool {
        let lost = self.lost.iter().any(|counts| counts[cell].frames > 0);
        lost || self.sent[cell].frames > 0 || self.received[cell].frames > 0
    }

    fn row(&self, cell: usize) -> TrafficRow {
        let per_robot = self.roles * self.topics;
        let volume = |count: Count| count.volume(self.header_bytes);
        TrafficRow {
            robot: ActorId((cell / per_robot) as u32),
            role: (cell % per_robot / self.topics) as u8,
            topic: (cell % self.topics) as u8,
            sent: volume(self.sent[cell]),
            received: volume(self.received[cell]),
            lost: LossCause::ALL.map(|cause| volume(self.lost[cause as usize][cell])),
        }
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
