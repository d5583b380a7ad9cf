//! One robot, stepped by hand.

use std::any::type_name;
use std::borrow::Borrow as _;
use std::collections::BTreeMap;

use bytes::BytesMut;
use tokio_util::codec::{Decoder, Encoder};

use crate::engine::{ActorId, KeyedStreams, Purpose, SimTime, Span, Streams};
use crate::geometry::{Pose, Vec2};
use crate::protocol::{Address, Frame, Input, Note, Output, Protocol, Reception, Start, TimerId, Wake};

const ROBOT: Purpose = Purpose::new("testing.robot");

/// One robot and what reaches it. A test says when it wakes, what it has heard by then, and what is near. What it answers comes back as
/// an [`Answer`]: messages, velocity, notes; its timers are kept, and run out as time [advances](Self::advance).
///
/// [The module](super) has an example, and so has [the crate's page](crate#test-it).
///
/// # Panics
/// Every method that has a message cross the codec, if it does not come back whole and on its topic, and every one that wakes the robot,
/// if that sends to itself or to a robot that does not exist. So does one that names a robot beyond the swarm.
#[derive(Debug)]
pub struct Solo<P: Protocol> {
    robot: P,
    me: ActorId,
    robots: usize,
    now: SimTime,
    inbox: Vec<Reception<P::Heard>>,
    timers: BTreeMap<u8, SimTime>,
    wakes: u32,
    sequences: Vec<u32>,
    random: KeyedStreams,
    codec: P::Codec,
    /// Where it is, as it senses it: at first the arena's centre.
    pub pose: Pose,
    /// Bodies near it, which it is told of at control steps: nothing at first. The vector to the nearest point of each, metres.
    pub proximity: Vec<Vec2>,
}

/// Something that a robot said.
#[derive(Clone, Debug, PartialEq)]
pub struct Said<M> {
    /// For whom; `None` is everyone.
    pub to: Option<ActorId>,
    /// What its hearers get, through the codec.
    pub message: M,
    /// Length of the payload, bytes.
    pub bytes: usize,
}

/// What a robot did when it woke.
#[derive(Clone, Debug)]
pub struct Answer<M> {
    /// When.
    pub at: SimTime,
    /// Why it woke.
    pub wake: Wake,
    /// What it said, in order.
    pub said: Vec<Said<M>>,
    /// The velocity that it asked for, m/s.
    pub velocity: Option<Vec2>,
    /// What it noted for the metrics.
    pub notes: Vec<Note>,
}

impl<M: Clone> Answer<M> {
    /// What it said, whoever it was for.
    #[must_use]
    pub fn words(&self) -> Vec<M> {
        self.said.iter().map(|said| said.message.clone()).collect()
    }

    /// The sum of what it counted under `name`.
    #[must_use]
    pub fn counted(&self, name: &str) -> u64 {
        let counted = self.notes.iter().filter_map(|note| match note {
            Note::Count { name: counted, n } if *counted == name => Some(*n),
            _ => None,
        });
        counted.sum()
    }

    /// What it measured as `name`, in order.
    #[must_use]
    pub fn measured(&self, name: &str) -> Vec<f64> {
        let measured = self.notes.iter().filter_map(|note| match note {
            Note::Value { name: measured, value } if *measured == name => Some(*value),
            _ => None,
        });
        measured.collect()
    }
}

impl<P: Protocol> Solo<P> {
    /// Robot `me` of a swarm of `robots`, numbered from 0, which is told so ([`Protocol::start`]), at time 0.
    #[must_use]
    pub fn new(me: ActorId, robots: usize, mut robot: P) -> Self {
        robot.start(Start { me, robots });
        Self {
            robot,
            me,
            robots,
            now: SimTime::ZERO,
            inbox: Vec::new(),
            timers: BTreeMap::new(),
            wakes: 0,
            sequences: vec![0; robots],
            random: Streams::new(1, 0).keyed(ROBOT),
            codec: P::Codec::default(),
            pose: Pose::default(),
            proximity: Vec::new(),
        }
    }

    /// The robot itself.
    #[must_use]
    pub const fn robot(&self) -> &P {
        &self.robot
    }

    /// Its time.
    #[must_use]
    pub const fn now(&self) -> SimTime {
        self.now
    }

    /// When its timer `id` runs out, if it is set.
    #[must_use]
    pub fn timer(&self, id: TimerId) -> Option<SimTime> {
        self.timers.get(&id.0).copied()
    }

    /// A broadcast of `from` arrives now, from where the robot is. It is read when the robot next wakes.
    pub fn hears(&mut self, from: ActorId, message: P::Message) {
        let heard = self.through_codec(message).0;
        self.receive(from, Address::Everyone, heard, Vec2::zeros());
    }

    /// What `from` sent to this robot alone arrives now.
    pub fn is_sent(&mut self, from: ActorId, message: P::Message) {
        let heard = self.through_codec(message).0;
        self.receive(from, Address::Me, heard, Vec2::zeros());
    }

    /// What `from` sent to another robot arrives now, as where robots overhear.
    pub fn overhears(&mut self, from: ActorId, message: P::Message) {
        let heard = self.through_codec(message).0;
        self.receive(from, Address::Another, heard, Vec2::zeros());
    }

    /// Puts what has arrived into the inbox; `displacement` is where the sender was, seen from here, metres.
    pub(super) fn receive(&mut self, from: ActorId, address: Address, message: P::Heard, displacement: Vec2) {
        let sequence = self.sequences[from.index()];
        self.sequences[from.index()] += 1;
        self.inbox.push(Reception {
            at: self.now,
            frame: Frame {
                sender: from,
                sequence,
                sent_at: self.now,
                payload_bytes: 0,
                rides: false,
                address,
                message,
            },
            displacement: [displacement.x as f32, displacement.y as f32],
        });
    }

    /// Takes a control step now.
    pub fn control_step(&mut self) -> Answer<P::Heard> {
        self.wake(Wake::ControlStep)
    }

    /// Wakes because something has arrived, as in scenarios with `wake: OnReception`.
    pub fn reception(&mut self) -> Answer<P::Heard> {
        self.wake(Wake::Reception)
    }

    /// Lets `seconds` pass, with a control step at their start. Timers that run out on the way wake the robot at their time,
    /// before a control step; those of the very end wake it at the next call, which begins there. What it did, in order.
    pub fn advance(&mut self, seconds: f64) -> Vec<Answer<P::Heard>> {
        let end = self.now + Span::from_secs(seconds);
        let mut done = self.expire(self.now);
        done.push(self.control_step());
        // The timers of the end itself belong to what comes next.
        while let Some((_, at)) = self.next_timer().filter(|(_, at)| *at < end) {
            done.extend(self.expire(at));
        }
        self.now = end;
        done
    }

    /// Goes to `at`, and wakes for the timers that run out then or have run out.
    pub(super) fn expire(&mut self, at: SimTime) -> Vec<Answer<P::Heard>> {
        self.now = self.now.max(at);
        let mut done = Vec::new();
        // A timer that is set anew for now runs out once more, as in a run.
        while let Some((id, _)) = self.next_timer().filter(|(_, due)| *due <= self.now) {
            self.timers.remove(&id);
            done.push(self.wake(Wake::Timer(TimerId(id))));
        }
        done
    }

    /// The timer that runs out next.
    pub(super) fn next_timer(&self) -> Option<(u8, SimTime)> {
        let all = self.timers.iter().map(|(id, at)| (*id, *at));
        all.min_by_key(|&(id, at)| (at, id))
    }

    /// Goes to `at` without waking.
    pub(super) fn go_to(&mut self, at: SimTime) {
        self.now = self.now.max(at);
    }

    pub(super) fn wake(&mut self, wake: Wake) -> Answer<P::Heard> {
        let mut input = Input {
            me: self.me,
            wake,
            inbox: std::mem::take(&mut self.inbox),
            powers: Vec::new(),
            outcomes: Vec::new(),
            pose: self.pose,
            proximity: match wake {
                Wake::ControlStep => self.proximity.clone(),
                Wake::Timer(_) | Wake::Reception | Wake::Sent => Vec::new(),
            },
            random: self.random.at(self.me.0, 0, self.wakes),
        };
        self.wakes += 1;
        let mut output = Output::default();
        self.robot.step(self.now, &mut input, &mut output);
        for (id, at) in output.timers.drain(..) {
            match at {
                Some(at) => self.timers.insert(id.0, at),
                None => self.timers.remove(&id.0),
            };
        }
        let all: Vec<_> = output.drain_said().collect();
        let mut said = Vec::with_capacity(all.len());
        for (to, message) in all {
            if let Some(to) = to {
                assert!(
                    to != self.me && to.index() < self.robots,
                    "robot {} sent a message to robot {to}, of {} robots",
                    self.me,
                    self.robots
                );
            }
            let (message, bytes) = self.through_codec(message);
            said.push(Said { to, message, bytes });
        }
        Answer {
            at: self.now,
            wake,
            said,
            velocity: output.velocity,
            notes: output.notes,
        }
    }

    /// What receivers make of `message`, and how long its payload is.
    fn through_codec(&mut self, message: P::Message) -> (P::Heard, usize) {
        let topic = P::topic(&message);
        let name = P::TOPICS[usize::from(topic.0)];
        let protocol = type_name::<P>();
        let mut payload = BytesMut::new();
        let encoded = self.codec.encode(message, &mut payload);
        encoded.unwrap_or_else(|error| panic!("{protocol} cannot write a message on {name}: {error}"));
        let bytes = payload.len();
        let decoded = self.codec.decode(&mut payload);
        let decoded = decoded.unwrap_or_else(|error| panic!("{protocol} cannot read a message on {name}: {error}"));
        let decoded =
            decoded.unwrap_or_else(|| panic!("{protocol} reads no message from the {bytes} bytes of one on {name}"));
        assert!(
            payload.is_empty(),
            "{protocol} leaves {} of the {bytes} bytes of a message on {name} unread",
            payload.len()
        );
        let heard = P::Heard::from(decoded);
        let read = P::topic(heard.borrow());
        assert!(
            read == topic,
            "{protocol} reads a message on {name} as one on {}",
            P::TOPICS[usize::from(read.0)]
        );
        (heard, bytes)
    }
}
