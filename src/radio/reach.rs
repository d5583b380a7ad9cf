//! Who is in range of whom: one notion for all that a run asks it for.

use std::fmt::Debug;
use std::sync::Arc;

use crate::engine::ActorId;
use crate::geometry::{Vec2, at_most};

/// A robot and where it is, metres, arena axes.
pub type Placed = (ActorId, Vec2);

/// Who is in range of whom in a run, from where robots are: whom a frame is offered to, which links the swarm's graph has, when one robot
/// watches another in vain. It says nothing about a single frame: the channel, or what jams it, decides whether that arrives.
///
/// Cheap to clone, and the same throughout a run.
#[derive(Clone, Debug)]
pub enum Reach {
    /// Two robots are in range of each other when their distance is at most so many metres (paper section 3.1).
    Disk(f64),
    /// As a relation says.
    Links(Arc<dyn Links>),
}

/// Who is in range of whom where that does not follow from a distance alone: by walls, shadowing, or powers of robots' own.
pub trait Links: Debug + Send + Sync {
    /// No two robots farther apart than this are connected, metres.
    fn farthest(&self) -> f64;

    /// Whether `to` is in range of what `from` sends. The same ends at the same places always get the same answer; the two directions
    /// of a link may differ.
    fn connects(&self, from: Placed, to: Placed) -> bool;

    /// No robot farther away than this hears anything, metres: robots that count as out of range may hear a frame now and then.
    fn earshot(&self) -> f64 {
        self.farthest()
    }

    /// The same as [`connects`](Self::connects), and whether robots out of range may hear all the same.
    fn contact(&self, from: Placed, to: Placed) -> Contact {
        if self.connects(from, to) {
            Contact::InRange
        } else {
            Contact::None
        }
    }
}

/// What one robot is to what another sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// In range: it is offered what goes to everybody.
    InRange,
    /// Out of range, and yet a frame may reach it now and then. What does is counted apart.
    Beyond,
    /// Out of earshot.
    None,
}

impl Reach {
    /// No two robots farther apart than this are in range, metres.
    #[must_use]
    pub fn farthest(&self) -> f64 {
        match self {
            Self::Disk(range) => *range,
            Self::Links(links) => links.farthest(),
        }
    }

    /// Whether `to` hears `from`: is in range of what it sends. The rim of a disk is [within it](at_most).
    #[must_use]
    pub fn hears(&self, from: Placed, to: Placed) -> bool {
        match self {
            Self::Disk(range) => (to.1 - from.1).norm() <= at_most(*range),
            Self::Links(links) => links.connects(from, to),
        }
    }

    /// Whether the two hear each other.
    #[must_use]
    pub fn linked(&self, a: Placed, b: Placed) -> bool {
        match self {
            Self::Disk(_) => self.hears(a, b),
            Self::Links(links) => links.connects(a, b) && links.connects(b, a),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A wall along the y axis that nothing passes, and a range on either side. From robots with odd numbers it is half as far.
    #[derive(Debug)]
    pub struct Walled {
        pub range: f64,
    }

    impl Walled {
        pub fn reach(range: f64) -> Reach {
            Reach::Links(Arc::new(Self { range }))
        }
    }

    impl Links for Walled {
        fn farthest(&self) -> f64 {
            self.range
        }

        fn connects(&self, (sender, from): Placed, (_, to): Placed) -> bool {
            let range = if sender.0 % 2 == 1 {
                self.range / 2.0
            } else {
                self.range
            };
            (to - from).norm() <= at_most(range) && (from.x < 0.0) == (to.x < 0.0)
        }
    }

    fn at(robot: u32, x: f64, y: f64) -> Placed {
        (ActorId(robot), Vec2::new(x, y))
    }

    #[test]
    fn over_a_disk_robots_hear_each_other_up_to_its_rim() {
        let disk = Reach::Disk(0.7);
        assert!((disk.farthest() - 0.7).abs() < f64::EPSILON);
        let near = (at(0, 0.1, 0.0), at(1, 0.8, 0.0)); // 0.7000000000000001 m apart.
        assert!(disk.hears(near.0, near.1) && disk.hears(near.1, near.0) && disk.linked(near.0, near.1));
        assert!(!disk.linked(at(0, 0.1, 0.0), at(1, 0.800_001, 0.0)));
    }

    #[test]
    fn over_links_one_may_hear_another_and_not_be_heard_and_then_they_are_not_linked() {
        let reach = Walled::reach(2.0);
        let (even, odd) = (at(0, 1.0, 0.0), at(1, 1.0, 1.5));
        assert!(reach.hears(even, odd) && !reach.hears(odd, even));
        assert!(!reach.linked(even, odd) && !reach.linked(odd, even));
        assert!(reach.linked(even, at(1, 1.0, 1.0)) && reach.linked(even, at(2, 1.0, 1.5)));
        assert!(!reach.linked(even, at(2, -0.1, 0.0)), "through the wall");
    }
}
