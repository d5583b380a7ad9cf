use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;
use crate::geometry::{Pose, Vec2, unit};
use crate::motion::{ArenaConfig, MotionConfig};
use crate::quantity::Positive;
use crate::radio::Walled;

const RANGE: f64 = 0.6;

/// A world in which eight robots stand in a row, 0.2 m apart, the first at `x`.
fn row(x: f64) -> World {
    let config = MotionConfig {
        max_speed: Positive::new(0.5),
        ..MotionConfig::default()
    };
    let pose = |robot: u32| Pose {
        position: Vec2::new(x + 0.2 * f64::from(robot), 0.0),
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

/// Robots drive as they are commanded, rest from tick 40 on for a while, and go on.
fn advance(world: &mut World, tick: usize, rest: usize, commands: &[(u32, f64, f64)]) {
    if (40..40 + rest).contains(&tick) {
        (0..8).for_each(|robot| world.command(ActorId(robot), Vec2::zeros()));
    } else if let Some(&(robot, speed, angle)) = commands.get(tick / 4) {
        world.command(ActorId(robot), unit(angle) * speed);
    }
    world.advance();
}

fn commands() -> impl Strategy<Value = Vec<(u32, f64, f64)>> {
    prop::collection::vec((0_u32..8, 0.05..0.5_f64, 0.0..6.3_f64), 1..60)
}

proptest! {
    /// Robots drive at random, and rest for more ticks than the ring has places; at instants between the ticks those are within
    /// range of whom it is said.
    #[test]
    fn at_every_instant_those_are_in_range_that_have_crossed_it_into_it_and_not_out_again(
        commands in commands(), rest in 0..400_usize, shares in prop::collection::vec(0.0..1.0_f64, 8),
    ) {
        let (mut world, mut ranges) = (row(0.0), Ranges::new(Reach::Disk(RANGE)));
        let mut within: BTreeMap<[ActorId; 2], bool> = pairs().map(|pair| (pair, true)).collect();
        let mut checked = 0;
        for tick in 0..600 {
            advance(&mut world, tick, rest, &commands);
            cross_until(&mut ranges, world.now(), &mut within);
            if world.is_moving() {
                if !ranges.follows() {
                    ranges.follow_from_now_on();
                    pairs().for_each(|pair| assert!(ranges.follow(pair, SimTime::ZERO)));
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

    /// A wall in the middle, and every second robot heard half as far. Each ordered pair is followed from some tick on, between two of them.
    #[test]
    fn at_every_tick_each_direction_of_a_link_is_as_the_relation_says(
        commands in commands(), rest in 0..400_usize, shares in prop::collection::vec((0..300_usize, 0.0..1.0_f64), 56),
    ) {
        let reach = Walled::reach(RANGE);
        let (mut world, mut ranges) = (row(-0.7), Ranges::new(reach.clone()));
        ranges.begin(&world);
        let directed: Vec<_> = pairs().flat_map(|[a, b]| [[a, b], [b, a]]).zip(shares).collect();
        let mut within: BTreeMap<[ActorId; 2], bool> = BTreeMap::new();
        for tick in 0..600 {
            let hears = |[observer, subject]: [ActorId; 2], world: &World, at: SimTime| {
                let [from, to] = [subject, observer].map(|robot| (robot, world.position(robot, at)));
                reach.hears(from, to)
            };
            for (pair, (_, share)) in directed.iter().filter(|(_, (from, _))| *from == tick) {
                let at = world.now() + Span::from_secs(share * world.tick().as_secs());
                within.insert(*pair, ranges.follow(*pair, at));
                prop_assert_eq!(within[pair], hears(*pair, &world, at));
            }
            advance(&mut world, tick, rest, &commands);
            cross_until(&mut ranges, world.now(), &mut within);
            ranges.go_on(&world);
            if world.is_moving() {
                ranges.look(&world);
            }
            for (pair, within) in &within {
                prop_assert_eq!(*within, hears(*pair, &world, world.now()), "{:?} at {}", pair, world.now());
            }
        }
    }
}

#[test]
fn a_pair_that_is_far_from_the_range_is_seldom_looked_at() {
    let (mut world, mut ranges) = (row(0.0), Ranges::new(Reach::Disk(5.0)));
    world.command(ActorId(0), Vec2::new(-0.1, 0.0));
    world.advance();
    ranges.follow_from_now_on();
    pairs().for_each(|pair| assert!(ranges.follow(pair, SimTime::ZERO)));
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
