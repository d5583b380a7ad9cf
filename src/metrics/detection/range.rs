//! Who comes within range of whom and leaves it, among robots that watch each other.
//!
//! Between two ticks robots move in straight lines, so over a disk the instant at which two of them cross the range is the root of a square
//! equation. Over links it is the tick by which they have crossed it, and each direction is followed by itself. And in a tick a robot gets only
//! so far: a pair that is far from the range is looked at again when it could have come near, and not before. So following costs little a pair, and
//! nothing at all where nobody moves.

use std::collections::VecDeque;

use crate::engine::{ActorId, SimTime, Span};
use crate::geometry::{Vec2, at_most};
use crate::motion::World;
use crate::radio::{Links, Reach};

/// Ticks after which a pair is looked at again at the latest, less one.
const TICKS: usize = 256;

/// Follows pairs of robots and says when they cross the range.
#[derive(Debug)]
pub struct Ranges {
    reach: Reach,
    /// Pairs by the tick at which they are looked at next: a ring; empty before anybody is followed.
    due: Vec<Vec<Followed>>,
    /// The place in the ring of the present tick.
    now: usize,
    /// What happens until the next tick, in order of time.
    crossings: VecDeque<Crossing>,
    /// Over links: where all are going.
    ways: Ways,
}

/// A pair that is followed.
#[derive(Clone, Copy, Debug)]
struct Followed {
    /// Who observes, and whom.
    pair: [ActorId; 2],
    /// Whether the one is in range of the other: as far as has been looked.
    within: bool,
}

/// A pair crosses the range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Crossing {
    /// When.
    pub at: SimTime,
    /// Who observes, and whom.
    pub pair: [ActorId; 2],
    /// Whether the observer is in range of the other from then on.
    pub within: bool,
}

/// The ways of all robots from a tick to the next.
#[derive(Debug, Default)]
struct Ways {
    since: SimTime,
    tick: Span,
    /// Where each robot was at the tick, metres, and its velocity, m/s.
    courses: Vec<(Vec2, Vec2)>,
    moving: bool,
}

impl Ways {
    /// Takes in where robots go, which is known as long as nobody moves.
    fn take(&mut self, world: &World) {
        if world.is_moving() || self.moving || self.courses.is_empty() {
            self.since = world.now();
            self.tick = world.tick();
            self.moving = world.is_moving();
            self.courses.clear();
            let robots = 0..world.positions().len() as u32;
            self.courses.extend(robots.map(|robot| world.course(ActorId(robot))));
        }
    }

    /// When they end.
    fn end(&self) -> SimTime {
        self.since + self.tick
    }

    fn rest(&self, pair: [ActorId; 2]) -> bool {
        pair.iter().all(|robot| self.courses[robot.index()].1 == Vec2::zeros())
    }

    fn apart(&self, [a, b]: [ActorId; 2]) -> f64 {
        (self.courses[b.index()].0 - self.courses[a.index()].0).norm()
    }

    /// Whether the observer of `pair` hears the other at `at`.
    fn connect(&self, pair: [ActorId; 2], at: SimTime, links: &dyn Links) -> bool {
        let elapsed = at.since(self.since).as_secs();
        let [observer, subject] = pair.map(|robot| {
            let (place, velocity) = self.courses[robot.index()];
            (robot, place + velocity * elapsed)
        });
        let near = (subject.1 - observer.1).norm_squared() <= at_most(links.farthest()).powi(2);
        near && links.connects(subject, observer)
    }
}

impl Ranges {
    /// Follows nobody yet, among robots that are in range of each other as `reach` says.
    pub fn new(reach: Reach) -> Self {
        Self {
            reach,
            due: Vec::new(),
            now: 0,
            crossings: VecDeque::new(),
            ways: Ways::default(),
        }
    }

    /// Whether two robots are always in range of each other or neither is: who watches each other is then followed once, in either order.
    pub fn are_mutual(&self) -> bool {
        matches!(self.reach, Reach::Disk(_))
    }

    /// Whether pairs are followed: over a disk from the first time on that anybody moves.
    pub fn follows(&self) -> bool {
        !self.due.is_empty()
    }

    /// Begins to follow.
    pub fn follow_from_now_on(&mut self) {
        self.due.resize_with(TICKS, Vec::new);
    }

    /// The run begins, with robots where `world` says.
    pub fn begin(&mut self, world: &World) {
        if !self.are_mutual() {
            self.follow_from_now_on();
            self.ways.take(world);
        }
    }

    /// Robots go on to where `world` says, at each of its ticks.
    pub fn go_on(&mut self, world: &World) {
        if !self.are_mutual() {
            self.ways.take(world);
        }
    }

    /// Follows `pair` from `now` on, if anybody is followed. Whether it is within range then: over a disk it is taken to be, for the one has just
    /// heard the other, and looked at from the next tick on.
    pub fn follow(&mut self, pair: [ActorId; 2], now: SimTime) -> bool {
        let [within, at_end] = match &self.reach {
            Reach::Disk(_) => [true; 2],
            Reach::Links(links) => [now, self.ways.end()].map(|at| self.ways.connect(pair, at, links.as_ref())),
        };
        let mut followed = Followed { pair, within };
        followed.cross(|| self.ways.end(), at_end, &mut self.crossings);
        if self.follows() {
            let next = (self.now + 1) % TICKS;
            self.due[next].push(followed);
        }
        within
    }

    /// The next crossing, if it has come by `now`.
    pub fn take_crossing(&mut self, now: SimTime) -> Option<Crossing> {
        self.crossings.pop_front_if(|crossing| crossing.at <= now)
    }

    /// Finds who crosses the range on the way from this tick to the next, in which somebody moves. Every crossing of the ticks
    /// before must have been taken.
    pub fn look(&mut self, world: &World) {
        debug_assert!(self.crossings.is_empty(), "crossings of the past were taken");
        self.now = (self.now + 1) % TICKS;
        match self.reach.clone() {
            Reach::Disk(range) => {
                let range = at_most(range);
                self.look_at_all(|followed, _, crossings| followed.cross_disk(range, world, crossings));
            }
            Reach::Links(links) => {
                // The most by which their distance changes in a tick, as below.
                let most = reach(world);
                self.look_at_all(|followed, ways, crossings| {
                    followed.cross_links(links.as_ref(), ways, most, crossings)
                });
            }
        }
        self.crossings.make_contiguous().sort_unstable();
    }

    /// Has `look_at` note the crossings of those that are due, and say after how many ticks to look at them again.
    fn look_at_all(&mut self, look_at: impl Fn(&mut Followed, &Ways, &mut VecDeque<Crossing>) -> usize) {
        let mut looked_at = std::mem::take(&mut self.due[self.now]);
        for mut followed in looked_at.drain(..) {
            let ticks = look_at(&mut followed, &self.ways, &mut self.crossings);
            let next = (self.now + ticks) % TICKS;
            self.due[next].push(followed);
        }
        self.due[self.now] = looked_at;
    }
}

/// The most by which the distance of two robots changes in a tick, and more than the rounding of it, metres.
fn reach(world: &World) -> f64 {
    2.0 * world.max_travel() * (1.0 + 1e-9)
}

/// The ticks after which to look again at a pair that is so far from the range.
fn ticks_until_near(gap: f64, reach: f64) -> usize {
    ((gap / reach) as usize).min(TICKS - 1)
}

impl Followed {
    /// From `at` on it is `within` range or not, which may be nothing new.
    fn cross(&mut self, at: impl FnOnce() -> SimTime, within: bool, crossings: &mut VecDeque<Crossing>) {
        if within != self.within {
            self.within = within;
            crossings.push_back(Crossing {
                at: at(),
                pair: self.pair,
                within,
            });
        }
    }

    /// Notes when it crosses the rim of the disk in the coming tick. Returns the ticks after which to look again.
    fn cross_disk(&mut self, range: f64, world: &World, crossings: &mut VecDeque<Crossing>) -> usize {
        let [(here, velocity), (there, others)] = self.pair.map(|robot| world.course(robot));
        let (apart, drift) = (there - here, others - velocity);
        let mut cross = |after: f64, within: bool| {
            self.cross(|| world.now() + Span::from_secs(after), within, crossings);
        };
        cross(0.0, apart.norm_squared() <= range * range);
        let reach = reach(world);
        let gap = (apart.norm() - range).abs();
        if gap > reach {
            return ticks_until_near(gap, reach);
        }
        // |apart + drift t|² = range²
        let (a, b, c) = (
            drift.norm_squared(),
            apart.dot(&drift),
            apart.norm_squared() - range * range,
        );
        let discriminant = b * b - a * c;
        if a > 0.0 && discriminant >= 0.0 {
            let (enters, leaves) = ((-b - discriminant.sqrt()) / a, (-b + discriminant.sqrt()) / a);
            let tick = world.tick().as_secs();
            // A root just before the tick is one at its beginning, rounded.
            if b < 0.0 && enters <= tick {
                cross(enters.max(0.0), true);
            }
            if leaves <= tick {
                cross(leaves.max(0.0), false);
            }
        }
        1
    }

    /// Notes whether it has crossed the range by the next tick; what it was by this one is known. Returns the ticks after which to look again.
    fn cross_links(&mut self, links: &dyn Links, ways: &Ways, reach: f64, crossings: &mut VecDeque<Crossing>) -> usize {
        if !ways.rest(self.pair) {
            let within = ways.connect(self.pair, ways.end(), links);
            self.cross(|| ways.end(), within, crossings);
        }
        let gap = ways.apart(self.pair) - at_most(links.farthest());
        if gap > reach { ticks_until_near(gap, reach) } else { 1 }
    }
}

#[cfg(test)]
mod tests;
