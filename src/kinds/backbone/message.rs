//! What robots say: the paper's four topics (section 4.3), and what their failure detectors say.

use std::rc::Rc;

use crate::engine::ActorId;
use crate::protocol;
use crate::protocol::detector::{Monitored, Probe, Sign};

/// What a robot is to the backbone (paper section 4.1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Role {
    /// Waits in the cluster around the root.
    #[default]
    Free,
    /// The end of all chains.
    Root,
    /// A relay of a chain.
    Networker,
    /// Visits a target.
    Worker,
}

impl Role {
    /// All roles, in the order of their numbers.
    pub const ALL: [Self; 4] = [Self::Free, Self::Root, Self::Networker, Self::Worker];

    /// Its index into [`Protocol::ROLES`](protocol::Protocol::ROLES).
    #[must_use]
    pub const fn index(self) -> protocol::Role {
        protocol::Role(self as u8)
    }
}

/// A message. All are broadcast; those meant for one robot name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    /// Who I am now.
    Status(Status),
    /// Asks, answers and orders.
    Request(Request),
    /// The robots from the root to the sender.
    ParentStrand(Strand),
    /// The robots from the worker to the sender.
    ChildStrand(Strand),
    /// What the failure detector says.
    Probe(Rc<Probe>),
}

impl Monitored for Message {
    #[inline]
    fn sign(&self) -> Sign<'_> {
        match self {
            Self::Status(_) => Sign::Status,
            Self::Probe(probe) => Sign::Probe(probe),
            Self::Request(_) | Self::ParentStrand(_) | Self::ChildStrand(_) => Sign::Other,
        }
    }

    fn probe(probe: Probe) -> Self {
        Self::Probe(Rc::new(probe))
    }
}

/// What every robot says of itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Status {
    /// Its role.
    pub role: Role,
    /// The role that it had before.
    pub previous: Role,
    /// Parent need: whether its chain must grow for the worker to reach the target.
    pub need: bool,
    /// The chain that it belongs to, from 1; a worker names the first of its chains; 0 for none.
    pub chain: u8,
}

/// The request and response topic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Asks a free robot to become the sender's parent in a chain.
    Join {
        /// The robot asked.
        to: ActorId,
        /// Number of this request among the sender's; repetitions have the same.
        sequence: u8,
        /// The chain to join.
        chain: u8,
    },
    /// Asks a networker of the sender's chain that has lost its child to become the sender's parent: the two bridge a
    /// failed robot.
    Adopt {
        /// The robot asked.
        to: ActorId,
        /// Number of this request among the sender's; repetitions have the same.
        sequence: u8,
        /// The chain of both.
        chain: u8,
    },
    /// The root asks a free robot to become the worker of a target that has none left.
    Work {
        /// The robot asked.
        to: ActorId,
        /// Number of this request among the sender's; repetitions have the same.
        sequence: u8,
        /// The target, an index into the mission's.
        target: u8,
    },
    /// The root asks a free robot to replace the end of a chain that fell silent: to become its child there, and to wait
    /// for those beyond.
    Replace {
        /// The robot asked.
        to: ActorId,
        /// Number of this request among the sender's; repetitions have the same.
        sequence: u8,
        /// The chain.
        chain: u8,
        /// The robot that was next to the one that fell silent.
        child: ActorId,
        /// How many robots there are beyond the break, the child and the worker included.
        beyond: u8,
    },
    /// Yes to the request with this number.
    Accept {
        /// Who asked.
        to: ActorId,
        /// The request's number.
        sequence: u8,
    },
    /// No to the request with this number.
    Refuse {
        /// Who asked.
        to: ActorId,
        /// The request's number.
        sequence: u8,
    },
    /// The sender does not count on this robot as its parent: it is free again.
    Release {
        /// The robot let go.
        to: ActorId,
    },
    /// The root's order of what to expand, passed on from robot to robot.
    Order(Order),
    /// The best bid known of an election, passed on from robot to robot.
    Bid(Bid),
}

/// A bid to become the root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bid {
    /// Number of the election; 0 is the state at the start, before any.
    pub term: u8,
    /// How far the bidder is from the root's place, millimetres, and more if it has a duty; 0 of who is the root.
    pub distance: u16,
    /// Who bids.
    pub robot: ActorId,
}

impl Bid {
    /// Whether it is of a newer election than `other`. Numbers wrap: the one less than half a turn ahead is the newer.
    #[must_use]
    pub const fn is_of_newer_term_than(self, other: Self) -> bool {
        self.term.wrapping_sub(other.term).cast_signed() > 0
    }

    /// Whether it beats `other` of the same election: it is less, or of a robot with a lower number.
    #[must_use]
    pub fn is_better_than(self, other: Self) -> bool {
        (self.distance, self.robot) < (other.distance, other.robot)
    }
}

/// Which targets are expanded and which dismantled (paper algorithm 3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Order {
    /// Number of the order; 0 is the state at the start, before any order.
    pub epoch: u8,
    /// The targets whose chains are dismantled; all others are expanded.
    pub dismantled: TargetSet,
    /// Relays in reserve that each chain that is expanded gets (ours).
    pub reserve: u8,
}

/// A set of targets, a bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TargetSet([u8; Self::BYTES]);

impl TargetSet {
    /// Bytes that hold a bit for each target that there can be.
    pub const BYTES: usize = 32;

    /// The set whose bits are in `bytes`, the first target's the lowest of the first; `None` if they are too many.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut set = Self::default();
        set.0.get_mut(..bytes.len())?.copy_from_slice(bytes);
        Some(set)
    }

    /// Its bits, without zero bytes at the end.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        let length = self.0.iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1);
        &self.0[..length]
    }

    /// Whether `target` is in it.
    #[must_use]
    pub const fn contains(&self, target: u8) -> bool {
        self.0[target as usize / 8] & (1 << (target % 8)) != 0
    }

    /// Whether it is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.bytes().is_empty()
    }

    /// Puts `target` in.
    pub const fn insert(&mut self, target: u8) {
        self.0[target as usize / 8] |= 1 << (target % 8);
    }

    /// Takes `target` out.
    pub const fn remove(&mut self, target: u8) {
        self.0[target as usize / 8] &= !(1 << (target % 8));
    }
}

impl Order {
    /// Whether it was given after `other`. Numbers wrap: the one less than half a turn ahead is the newer.
    #[must_use]
    pub const fn is_newer_than(self, other: Self) -> bool {
        self.epoch.wrapping_sub(other.epoch).cast_signed() > 0
    }

    /// Whether `target` is to be expanded.
    #[must_use]
    pub const fn expands(self, target: u8) -> bool {
        !self.dismantled.contains(target)
    }
}

/// The robots of a chain, from one of its ends up to the sender.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Strand {
    /// The chain, from 1; 0 in the root's own strand, which is every chain's.
    pub chain: u8,
    /// The robot that the sender counts on as the next of the chain, by which the two verify that they are linked. The
    /// root, which is linked to whoever names it, names itself.
    pub next: ActorId,
    /// The robots, the sender last: shared by all that hear of them.
    pub robots: Rc<[ActorId]>,
}
