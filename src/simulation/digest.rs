//! A digest of everything that happened in a run, in order: two runs are the same run if theirs agree.

use xxhash_rust::xxh3::Xxh3Default;

use crate::engine::{ActorId, SimTime};
use crate::faults::{Change, Subject};
use crate::protocol::{Input, Output, Wake};

/// Collects events; 128 bits of XXH3 at the end.
#[derive(Clone)]
pub struct Digest(Xxh3Default);

impl Digest {
    /// The digest of nothing.
    pub fn new() -> Self {
        Self(Xxh3Default::new())
    }

    /// A robot woke and answered.
    pub fn wake<H, M>(&mut self, now: SimTime, robot: ActorId, input: &Input<H>, output: &Output<M>) {
        let cause = match input.wake {
            Wake::ControlStep => 0,
            Wake::Timer(id) => 1 + u64::from(id.0),
            Wake::Reception => u64::MAX,
        };
        let velocity = output
            .velocity
            .map_or([u64::MAX; 2], |v| [v.x.to_bits(), v.y.to_bits()]);
        self.words(&[
            now.as_nanos(),
            u64::from(robot.0),
            cause,
            input.pose.position.x.to_bits(),
            input.pose.position.y.to_bits(),
            input.pose.heading.to_bits(),
            receptions(input),
            velocity[0],
            velocity[1],
        ]);
        for (id, due) in &output.timers {
            self.words(&[u64::from(id.0), due.map_or(u64::MAX, SimTime::as_nanos)]);
        }
    }

    /// A robot sent these payload bytes.
    pub fn payload(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// A fault began or ended.
    pub fn fault(&mut self, now: SimTime, change: &Change) {
        let robot = match change.subject {
            Subject::Robot { robot, .. } => u64::from(robot.0),
            Subject::Links(_) => u64::MAX,
        };
        self.words(&[now.as_nanos(), u64::from(change.fault), u64::from(change.begins), robot]);
    }

    /// The digest of what was collected.
    pub fn finish(&self) -> u128 {
        self.0.digest128()
    }

    fn words<const N: usize>(&mut self, words: &[u64; N]) {
        self.0.update(words.map(u64::to_le_bytes).as_flattened());
    }
}

/// Folds an inbox into one word: this runs once a delivered frame, where the hash proper would be felt. What a frame said
/// is in its sender's payload, and where its sender stood in the poses, so its identity and its arrival are enough.
fn receptions<M>(input: &Input<M>) -> u64 {
    input.inbox.iter().fold(input.inbox.len() as u64, |hash, reception| {
        let frame = &reception.frame;
        let identity = (u64::from(frame.sender.0) << 32) | u64::from(frame.sequence);
        let word = reception.at.as_nanos() ^ identity.wrapping_mul(0xd6e8_feb8_6659_fd93);
        (hash ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
    })
}
