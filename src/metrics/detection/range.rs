//! Who comes within range of whom and leaves it, among robots that watch each other.
//!
//! Between two ticks robots move in straight lines, so the instant at which two of them cross the range is the root of a square
//! equation. And in a tick a robot gets only so far: a pair that is far from the range is looked at again when it could have come
//! near, and not before. So following costs little a pair, and nothing at all where nobody moves.

use std::collections::VecDeque;

use crate::engine::{ActorId, SimTime, Span};
use crate::motion::World;

/// Ticks after which a pair is looked at again at the latest, less one.
const TICKS: usize = 256;

/// Follows pairs of robots and says when they cross the range.
#[derive(Debug)]
pub struct Ranges {
    range: f64,
    /// Pairs by the tick at which they are looked at next: a ring; empty before anybody moves.
    due: Vec<Vec<Followed>>,
    /// The place in the ring of the present tick.
    now: usize,
    /// What happens until the next tick, in order of time.
    crossings: VecDeque<Crossing>,
}

/// A pair that is followed.
#[derive(Clone, Copy, Debug)]
struct Followed {
    pair: [ActorId; 2],
    within: bool,
}

/// Two robots cross the range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Crossing {
    /// When.
    pub at: SimTime,
    /// Who.
    pub pair: [ActorId; 2],
    /// Whether they are within it from then on.
    pub within: bool,
}

impl Ranges {
    /// Follows nobody yet, with this range in metres.
    pub fn new(range: f64) -> Self {
        Self {
            range,
            due: Vec::new(),
            now: 0,
            crossings: VecDeque::new(),
        }
    }

    /// Whether pairs are followed: from the first time on that anybody moves.
    pub fn follows(&self) -> bool {
        !self.due.is_empty()
    }

    /// Begins to follow.
    pub fn begin(&mut self) {
        self.due.resize_with(TICKS, Vec::new);
    }

    /// Follows `pair`, which is within range as far as is known, from the next tick on. Nothing before it [begins](Self::begin).
    pub fn follow(&mut self, pair: [ActorId; 2]) {
        if self.follows() {
            let next = (self.now + 1) % TICKS;
            self.due[next].push(Followed { pair, within: true });
        }
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
        let mut looked_at = std::mem::take(&mut self.due[self.now]);
        for mut followed in looked_at.drain(..) {
            let ticks = self.look_at(&mut followed, world);
            let next = (self.now + ticks) % TICKS;
            self.due[next].push(followed);
        }
        self.due[self.now] = looked_at;
        self.crossings.make_contiguous().sort_unstable();
    }

    /// Notes when `followed` crosses the range in the coming tick. Returns the ticks after which to look again.
    fn look_at(&mut self, followed: &mut Followed, world: &World) -> usize {
        let [(here, velocity), (there, others)] = followed.pair.map(|robot| world.course(robot));
        let (apart, drift) = (there - here, others - velocity);
        let mut cross = |after: f64, within: bool| {
            if within != followed.within {
                followed.within = within;
                self.crossings.push_back(Crossing {
                    at: world.now() + Span::from_secs(after),
                    pair: followed.pair,
                    within,
                });
            }
        };
        cross(0.0, apart.norm_squared() <= self.range * self.range);
        // The most by which their distance changes in a tick, and more than the rounding of it.
        let reach = 2.0 * world.max_travel() * (1.0 + 1e-9);
        let gap = (apart.norm() - self.range).abs();
        if gap > reach {
            return ((gap / reach) as usize).min(TICKS - 1);
        }
        // |apart + drift t|² = range²
        let (a, b, c) = (
            drift.norm_squared(),
            apart.dot(&drift),
            apart.norm_squared() - self.range * self.range,
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
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::{Pose, Vec2, unit};
    use crate::motion::{ArenaConfig, MotionConfig};
    use crate::quantity::Positive;

    const RANGE: f64 = 0.6;

    /// A world in which eight robots stand in a row, 0.2 m apart.
    fn row() -> World {
        let config = MotionConfig {
            max_speed: Positive::new(0.5),
            ..MotionConfig::default()
        };
        let pose = |robot: u32| Pose {
            position: Vec2::new(0.2 * f64::from(robot), 0.0),
            heading: 0.0,
        };
        World::new(&config, &ArenaConfig::default(), (0..8).map(pose).collect(), RANGE)
    }

    fn pairs() -> impl Iterator<Item = [ActorId; 2]> {
        (0..8).flat_map(|a| (0..a).map(move |b| [ActorId(a), ActorId(b)]))
    }

    fn cross_until(ranges: &mut Ranges, now: SimTime, within: &mut BTreeMap<[ActorId; 2], bool>) {
        while let Some(crossing) = ranges.take_crossing(now) {
            within.insert(crossing.pair, crossing.within);
        }
    }

    proptest! {
        /// Robots drive at random, and rest for more ticks than the ring has places; at instants between the ticks those are within
        /// range of whom it is said.
        #[test]
        fn at_every_instant_those_are_in_range_that_have_crossed_it_into_it_and_not_out_again(
            commands in prop::collection::vec((0_u32..8, 0.05..0.5_f64, 0.0..6.3_f64), 1..60),
            rest in 0..400_usize, shares in prop::collection::vec(0.0..1.0_f64, 8),
        ) {
            let (mut world, mut ranges) = (row(), Ranges::new(RANGE));
            let mut within: BTreeMap<[ActorId; 2], bool> = pairs().map(|pair| (pair, true)).collect();
            let mut checked = 0;
            for tick in 0..600 {
                let drives = !(40..40 + rest).contains(&tick);
                if !drives {
                    (0..8).for_each(|robot| world.command(ActorId(robot), Vec2::zeros()));
                } else if let Some(&(robot, speed, angle)) = commands.get(tick / 4) {
                    world.command(ActorId(robot), unit(angle) * speed);
                }
                world.advance();
                cross_until(&mut ranges, world.now(), &mut within);
                if world.is_moving() {
                    if !ranges.follows() {
                        ranges.begin();
                        pairs().for_each(|pair| ranges.follow(pair));
                    }
                    ranges.look(&world);
                }
                let at = world.now() + Span::from_secs(shares[tick % 8] * world.tick().as_secs());
                cross_until(&mut ranges, at, &mut within);
                for ([a, b], within) in &within {
                    let distance = (world.position(*a, at) - world.position(*b, at)).norm();
                    if ranges.follows() && (distance - RANGE).abs() > 1e-8 {
                        checked += 1;
                        prop_assert_eq!(*within, distance <= RANGE, "{} and {} at {}: {} m", a, b, at, distance);
                    }
                }
            }
            prop_assert!(checked > 0);
        }
    }

    #[test]
    fn a_pair_that_is_far_from_the_range_is_seldom_looked_at() {
        let (mut world, mut ranges) = (row(), Ranges::new(5.0));
        world.command(ActorId(0), Vec2::new(-0.1, 0.0));
        world.advance();
        ranges.begin();
        pairs().for_each(|pair| ranges.follow(pair));
        let mut looked_at = 0;
        for _ in 0..200 {
            looked_at += ranges.due[(ranges.now + 1) % TICKS].len();
            ranges.look(&world);
            assert_eq!(ranges.take_crossing(SimTime::NEVER), None);
            world.advance();
        }
        // 1.6 m at least from the range, of which a tick makes up 0.1 m at most: every 16 ticks or more seldom.
        assert!(looked_at <= 28 * (200 / 16 + 1), "{looked_at}");
    }
}
