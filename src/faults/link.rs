//! One fault of links: which, when, and how much they lose.

use super::config::{FaultConfig, LinksConfig, point};
use crate::engine::{ActorId, SimTime};
use crate::geometry::{Vec2, is_left_of};

/// How links fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkFaultKind {
    /// A line splits the arena.
    Partition,
    /// Some links lose more.
    Burst,
}

/// A robot and where it is.
pub(super) type Placed = (ActorId, Vec2);

#[derive(Debug)]
enum Kind {
    /// A point of the line and its direction.
    Partition {
        point: Vec2,
        along: Vec2,
    },
    Burst {
        links: LinksConfig,
        loss: f64,
    },
}

/// One fault of links.
#[derive(Debug)]
pub(super) struct LinkFault {
    kind: Kind,
    from: SimTime,
    until: SimTime,
    pub active: bool,
}

impl LinkFault {
    /// The fault of links that `config` describes, if it is one.
    pub fn new(config: &FaultConfig) -> Option<Self> {
        let (kind, during) = match config {
            FaultConfig::Partition(partition) => {
                let (a, b) = partition.line;
                let (a, b) = (point(a), point(b));
                (Kind::Partition { point: a, along: b - a }, partition.during)
            }
            FaultConfig::Burst(burst) => {
                let (links, loss) = (burst.links.clone(), burst.loss.get());
                (Kind::Burst { links, loss }, burst.during)
            }
            _ => return None,
        };
        let (from, until) = during.bounds();
        Some(Self {
            kind,
            from,
            until,
            active: false,
        })
    }

    /// When it begins or ends, from `now` on if it has not yet.
    pub fn next(&self) -> SimTime {
        if self.active { self.until } else { self.from }
    }

    /// Whether it begins or ends at `now`.
    pub fn advance(&mut self, now: SimTime) -> bool {
        if self.next() > now {
            return false;
        }
        self.active = !self.active;
        if !self.active {
            self.from = SimTime::NEVER;
        }
        true
    }

    /// Probability that it stops a copy between two robots.
    pub fn loss(&self, (sender, from): Placed, (receiver, to): Placed) -> f64 {
        match &self.kind {
            Kind::Partition { point, along } => {
                let left = |place| is_left_of(place, *point, *along);
                f64::from(u8::from(left(from) != left(to)))
            }
            Kind::Burst { links, loss } => {
                let hit = match links {
                    LinksConfig::All => true,
                    LinksConfig::Of(robots) => robots.contains(&sender.0) || robots.contains(&receiver.0),
                    LinksConfig::Pairs(pairs) => {
                        pairs.contains(&(sender.0, receiver.0)) || pairs.contains(&(receiver.0, sender.0))
                    }
                };
                if hit { *loss } else { 0.0 }
            }
        }
    }

    /// How the links fail.
    pub fn kind(&self) -> LinkFaultKind {
        match self.kind {
            Kind::Partition { .. } => LinkFaultKind::Partition,
            Kind::Burst { .. } => LinkFaultKind::Burst,
        }
    }
}
