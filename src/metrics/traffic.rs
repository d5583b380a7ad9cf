//! Messages and bytes by robot, role and topic: a table that a reception finds its cell in by two additions.

use crate::engine::{ActorId, prefetch, prefetch_all};
use crate::protocol::{MessageSize, Role, Topic};
use crate::radio::LossCause;

use super::volume::{TrafficRow, Volume};

/// Bytes that messages carry beside their payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HeaderBytes {
    /// Of each frame, for which its first message answers.
    pub frame: u16,
    /// Of each message.
    pub message: u16,
}

/// Messages and their payload; headers follow from the number of messages and of those that rode in another's frame.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    frames: u64,
    payload_bytes: u64,
}

/// What went one way, cell by cell. Riders stand apart: without piggybacking there are none, and they take no room.
#[derive(Debug, Default)]
struct Ledger {
    counts: Vec<Count>,
    riders: Vec<u64>,
}

impl Ledger {
    fn new(cells: usize) -> Self {
        Self {
            counts: vec![Count::default(); cells],
            riders: Vec::new(),
        }
    }

    #[inline]
    fn add(&mut self, cell: usize, size: MessageSize) {
        let count = &mut self.counts[cell];
        count.frames += 1;
        count.payload_bytes += u64::from(size.payload_bytes);
        if size.rides {
            self.add_rider(cell);
        }
    }

    // Apart: what every reception runs through stays small.
    #[cold]
    #[inline(never)]
    fn add_rider(&mut self, cell: usize) {
        self.riders.resize(self.counts.len(), 0);
        self.riders[cell] += 1;
    }

    fn count(&self, cell: usize) -> Count {
        self.counts.get(cell).copied().unwrap_or_default()
    }

    fn volume(&self, cell: usize, headers: HeaderBytes) -> Volume {
        let Count { frames, payload_bytes } = self.count(cell);
        let begun = frames - self.riders.get(cell).copied().unwrap_or_default();
        Volume {
            frames,
            payload_bytes,
            header_bytes: frames * u64::from(headers.message) + begun * u64::from(headers.frame),
        }
    }
}

/// Bytes of a robot on a topic, headers included.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RobotTraffic {
    pub(super) sent_bytes: u64,
    pub(super) received_bytes: u64,
}

/// Messages of a robot on a topic, and their bytes, headers included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Flow {
    pub(super) sent_frames: u64,
    pub(super) sent_bytes: u64,
    pub(super) received_frames: u64,
    pub(super) received_bytes: u64,
}

/// The traffic of a trial, dense in robots × roles × topics. What is sent, received and lost stands apart: receptions,
/// by far the most, then share a table small enough to stay in the cache.
#[derive(Debug)]
pub(super) struct Traffic {
    roles: usize,
    topics: usize,
    headers: HeaderBytes,
    sent: Ledger,
    received: Ledger,
    /// Takes no room before the first.
    duplicate: Ledger,
    /// A table for each cause, in the order of their numbers. Only what the channel drops has its room from the start: where nothing fails there are no others.
    lost: [Ledger; LossCause::ALL.len()],
    /// Where the cells of each robot's present role begin in these tables.
    starts: Vec<u32>,
}

impl Traffic {
    /// No traffic yet, every robot in the first role.
    pub(super) fn new(robots: usize, roles: usize, topics: usize, headers: HeaderBytes) -> Self {
        let cells = robots * roles * topics;
        Self {
            roles,
            topics,
            headers,
            sent: Ledger::new(cells),
            received: Ledger::new(cells),
            duplicate: Ledger::default(),
            lost: LossCause::ALL.map(|cause| match cause {
                LossCause::Channel => Ledger::new(cells),
                _ => Ledger::default(),
            }),
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

    pub(super) fn prefetch_row(&self, robot: ActorId) {
        prefetch(&self.starts[robot.index()]);
    }

    pub(super) fn prefetch_contents(&self, robot: ActorId) {
        let first = self.cell(robot, Topic(0));
        for ledger in [&self.sent, &self.received] {
            prefetch_all(&ledger.counts[first..first + self.topics]);
        }
    }

    #[inline]
    pub(super) fn prefetch_lost(&self, robot: ActorId, topic: Topic, cause: LossCause) {
        if let Some(count) = self.lost[cause as usize].counts.get(self.cell(robot, topic)) {
            prefetch(count);
        }
    }

    #[inline]
    pub(super) fn sent(&mut self, robot: ActorId, topic: Topic, size: MessageSize) {
        let cell = self.cell(robot, topic);
        self.sent.add(cell, size);
    }

    #[inline]
    pub(super) fn received(&mut self, robot: ActorId, topic: Topic, size: MessageSize) {
        let cell = self.cell(robot, topic);
        self.received.add(cell, size);
    }

    /// What was received told its receiver nothing new.
    pub(super) fn duplicate(&mut self, robot: ActorId, topic: Topic, size: MessageSize) {
        let cell = self.cell(robot, topic);
        self.duplicate.counts.resize(self.sent.counts.len(), Count::default());
        self.duplicate.add(cell, size);
    }

    #[inline]
    pub(super) fn lost(&mut self, robot: ActorId, topic: Topic, cause: LossCause, size: MessageSize) {
        let cell = self.cell(robot, topic);
        if cause != LossCause::Channel {
            let cells = self.sent.counts.len();
            self.lost[cause as usize].counts.resize(cells, Count::default());
        }
        self.lost[cause as usize].add(cell, size);
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
        let robots = self.starts.len();
        let mut sums = vec![RobotTraffic::default(); robots * self.topics];
        let per_robot = self.roles * self.topics;
        for cell in 0..self.sent.counts.len() {
            let sum = &mut sums[cell / per_robot * self.topics + cell % self.topics];
            sum.sent_bytes += self.sent.volume(cell, self.headers).bytes();
            sum.received_bytes += self.received.volume(cell, self.headers).bytes();
        }
        sums
    }

    /// Messages and bytes of each robot on each topic, in whatever role: robot by robot, topic by topic.
    pub(super) fn flows(&self) -> Vec<Flow> {
        let mut flows = vec![Flow::default(); self.starts.len() * self.topics];
        let per_robot = self.roles * self.topics;
        for cell in 0..self.sent.counts.len() {
            let flow = &mut flows[cell / per_robot * self.topics + cell % self.topics];
            let (sent, received) = (
                self.sent.volume(cell, self.headers),
                self.received.volume(cell, self.headers),
            );
            flow.sent_frames += sent.frames;
            flow.sent_bytes += sent.bytes();
            flow.received_frames += received.frames;
            flow.received_bytes += received.bytes();
        }
        flows
    }

    /// The cells that saw traffic, by robot, role, topic.
    pub(super) fn rows(&self) -> Vec<TrafficRow> {
        (0..self.sent.counts.len())
            .filter(|&cell| self.saw_traffic(cell))
            .map(|cell| self.row(cell))
            .collect()
    }

    fn saw_traffic(&self, cell: usize) -> bool {
        let ways = [&self.sent, &self.received, &self.duplicate];
        ways.into_iter()
            .chain(&self.lost)
            .any(|ledger| ledger.count(cell).frames > 0)
    }

    fn row(&self, cell: usize) -> TrafficRow {
        let per_robot = self.roles * self.topics;
        let volume = |ledger: &Ledger| ledger.volume(cell, self.headers);
        TrafficRow {
            robot: ActorId((cell / per_robot) as u32),
            role: (cell % per_robot / self.topics) as u8,
            topic: (cell % self.topics) as u8,
            sent: volume(&self.sent),
            received: volume(&self.received),
            duplicate: volume(&self.duplicate),
            lost: LossCause::ALL.map(|cause| volume(&self.lost[cause as usize])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADERS: HeaderBytes = HeaderBytes { frame: 2, message: 3 };

    #[test]
    fn traffic_is_accounted_to_the_role_held_when_it_flowed() {
        let mut traffic = Traffic::new(2, 2, 2, HEADERS);
        let robot = ActorId(1);
        traffic.sent(robot, Topic(0), MessageSize::alone(4));
        traffic.enter(robot, Role(1));
        traffic.received(robot, Topic(1), MessageSize::alone(7));
        traffic.received(robot, Topic(1), MessageSize::alone(9));
        traffic.lost(robot, Topic(1), LossCause::Channel, MessageSize::alone(3));
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
    fn of_a_frame_with_several_messages_the_first_answers_for_the_frames_header() {
        let mut traffic = Traffic::new(1, 1, 2, HEADERS);
        let rider = MessageSize {
            payload_bytes: 6,
            rides: true,
        };
        traffic.sent(ActorId(0), Topic(0), MessageSize::alone(4));
        traffic.sent(ActorId(0), Topic(1), rider);
        traffic.sent(ActorId(0), Topic(1), rider);
        let headers: Vec<u64> = traffic.rows().iter().map(|row| row.sent.header_bytes).collect();
        assert_eq!(headers, [5, 6]);
    }

    #[test]
    #[should_panic(expected = "role 2 reported by robot 0, but the protocol has 2 roles")]
    fn a_role_that_the_protocol_does_not_have_is_refused() {
        Traffic::new(1, 2, 1, HEADERS).enter(ActorId(0), Role(2));
    }
}
