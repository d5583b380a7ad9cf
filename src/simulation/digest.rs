//! A digest of everything that happened in a run, in order: two runs are the same run if theirs agree.

use xxhash_rust::xxh3::Xxh3Default;

use crate::engine::{ActorId, SimTime};
use crate::faults::{Change, Subject};
use crate::geometry::Vec2;
use crate::happenings::{Observer, Sent};
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
    fn wake<H, M>(&mut self, now: SimTime, robot: ActorId, input: &Input<H>, output: &Output<M>) {
        let cause = match input.wake {
            Wake::ControlStep => 0,
            Wake::Timer(id) => 1 + u64::from(id.0),
            Wake::Reception => u64::MAX,
            Wake::Sent => u64::MAX - 1,
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
    fn payload(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// The message whose payload was just told is for this robot alone.
    fn addressee(&mut self, to: ActorId) {
        self.words(&[u64::from(to.0)]);
    }

    /// A fault began or ended.
    fn change(&mut self, now: SimTime, change: &Change) {
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

impl Observer for Digest {
    /// Robots wake and answer in order of time anyway, and nothing else counts.
    const IN_ORDER: bool = false;

    #[inline]
    fn woke<H, M>(&mut self, now: SimTime, robot: ActorId, input: &Input<H>, output: &Output<M>) {
        self.wake(now, robot, input, output);
    }

    #[inline]
    fn sent(&mut self, message: &Sent<'_>) {
        self.payload(message.payload);
        if let Some(to) = message.to {
            self.addressee(to);
        }
    }

    fn fault(&mut self, now: SimTime, change: &Change, _: &[Vec2]) {
        self.change(now, change);
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

#[cfg(test)]
mod tests {
    use rand_philox::Philox;

    use super::*;
    use crate::faults::{Effect, Health};
    use crate::geometry::Pose;
    use crate::protocol::{Address, Frame, Reception, TimerId};

    fn reception(at: u64, sequence: u32) -> Reception<()> {
        Reception {
            at: SimTime::from_nanos(at),
            frame: Frame {
                sender: ActorId(3),
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

    fn digest(change: impl FnOnce(&mut Digest, &mut Input<()>, &mut Output<()>)) -> u128 {
        let mut input = Input {
            powers: Vec::new(),
            outcomes: Vec::new(),
            me: ActorId(1),
            wake: Wake::ControlStep,
            inbox: vec![reception(5, 1), reception(6, 2)],
            pose: Pose::default(),
            proximity: Vec::new(),
            random: Philox::from_u64_seed(1),
        };
        let (mut digest, mut output) = (Digest::new(), Output::default());
        change(&mut digest, &mut input, &mut output);
        digest.wake(SimTime::from_nanos(7), ActorId(1), &input, &output);
        digest.finish()
    }

    /// One run against others that differ from it in one thing each.
    #[test]
    fn whatever_a_robot_is_told_and_answers_changes_the_digest() {
        let timer = |id, due: Option<u64>| {
            move |_: &mut Digest, _: &mut Input<()>, output: &mut Output<()>| {
                output.timers.push((TimerId(id), due.map(SimTime::from_nanos)));
            }
        };
        let fault = |begins| {
            move |digest: &mut Digest, _: &mut Input<()>, _: &mut Output<()>| {
                let subject = Subject::Robot {
                    robot: ActorId(2),
                    effect: Effect::Mute,
                    health: Health::WELL,
                };
                let change = Change {
                    fault: 0,
                    begins,
                    subject,
                };
                digest.change(SimTime::from_nanos(4), &change);
            }
        };
        let mut digests = vec![
            digest(|_, _, _| {}),
            digest(timer(0, Some(9))),
            digest(timer(0, Some(10))),
            digest(timer(1, Some(9))),
            digest(timer(0, None)),
            digest(|_, input, _| input.wake = Wake::Reception),
            digest(|_, input, _| input.wake = Wake::Timer(TimerId(0))),
            digest(|_, input, _| input.pose.position.x = 1.0),
            digest(|_, input, _| input.pose.position.y = 1.0),
            digest(|_, input, _| input.pose.heading = 1.0),
            digest(|_, input, _| input.inbox[1].at = SimTime::from_nanos(8)),
            digest(|_, input, _| input.inbox[1].frame.sequence = 9),
            digest(|_, input, _| input.inbox[1].frame.sender = ActorId(4)),
            digest(|_, input, _| input.inbox.truncate(1)),
            digest(|_, _, output| output.velocity = Some(Vec2::zeros())),
            digest(|_, _, output| output.velocity = Some(Vec2::x())),
            digest(|_, _, output| output.velocity = Some(Vec2::y())),
            digest(|digest, _, _| digest.payload(&[1])),
            digest(|digest, _, _| digest.payload(&[2])),
            digest(|digest, _, _| digest.addressee(ActorId(1))),
            digest(|digest, _, _| digest.addressee(ActorId(2))),
            digest(fault(true)),
            digest(fault(false)),
        ];
        let number = digests.len();
        digests.sort_unstable();
        digests.dedup();
        assert_eq!(digests.len(), number);
    }
}
