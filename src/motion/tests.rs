//! Tests of the world as its users see it. What one part does by itself is tested beside that part.

use proptest::prelude::*;
use std::f64::consts::PI;

use super::*;
use crate::engine::{ActorId, SimTime, Span, Streams};
use crate::geometry::{Pose, Vec2, at_most, unit};
use crate::quantity::{Finite, NonNegative, Positive};

fn pose(x: f64, y: f64, heading: f64) -> Pose {
    Pose {
        position: Vec2::new(x, y),
        heading,
    }
}

pub(super) fn square(side: f64) -> ArenaConfig {
    ArenaConfig {
        size: (Positive::new(side), Positive::new(side)),
        obstacles: Vec::new(),
    }
}

/// An arena of 3 m × 3 m with a disc, and two walls that make a corner.
fn cluttered() -> ArenaConfig {
    let at = |x, y| (Finite::new(x), Finite::new(y));
    ArenaConfig {
        obstacles: vec![
            ObstacleConfig::Disc {
                at: at(0.6, 0.2),
                radius: Positive::new(0.3),
                attenuation: None,
            },
            ObstacleConfig::Wall {
                from: at(-1.0, -0.8),
                to: at(-0.4, 0.9),
                attenuation: None,
            },
            ObstacleConfig::Wall {
                from: at(-0.4, 0.9),
                to: at(0.3, 0.8),
                attenuation: None,
            },
        ],
        ..square(3.0)
    }
}

fn fast() -> MotionConfig {
    MotionConfig {
        max_speed: Positive::new(0.5),
        ..MotionConfig::default()
    }
}

fn ids(world: &World) -> impl Iterator<Item = ActorId> + use<> {
    (0..world.positions().len() as u32).map(ActorId)
}

/// How deep the deepest overlap of bodies is, in metres; an empty world has none.
fn deepest_overlap(world: &World, arena: &ArenaConfig, body_radius: f64) -> f64 {
    let arena = arena::Arena::new(arena);
    let places = world.positions();
    let fixed = places.iter().map(|&place| body_radius - arena.clearance(place));
    let pairs = places.iter().enumerate().flat_map(|(index, a)| {
        let distances = places[..index].iter().map(move |b| (a - b).norm());
        distances.map(|distance| 2.0 * body_radius - distance)
    });
    fixed.chain(pairs).fold(0.0, f64::max)
}

#[test]
fn a_straight_drive_covers_exactly_the_speed_times_the_time() {
    let mut world = World::new(&MotionConfig::default(), &square(10.0), vec![pose(0.0, 0.0, 0.0)], 2.0);
    world.command(ActorId(0), Vec2::new(1.0, 0.0));
    for _ in 0..101 {
        world.advance();
    }
    // The first tick takes the command up; the n-th of the 100 ticks after that is driven at 0.026 (1 − 0.5ⁿ) m/s, for
    // the commanded 1 m/s is beyond the largest speed. The missing shares 0.5ⁿ add up to 1 − 0.5¹⁰⁰.
    let expected = 0.026 * 0.1 * (100.0 - 1.0);
    assert!((world.positions()[0] - Vec2::new(expected, 0.0)).norm() < 1e-12);
    assert_eq!(world.now(), SimTime::from_secs(10.1));
}

#[test]
fn a_command_is_taken_up_at_the_next_tick_and_no_earlier() {
    let mut world = World::new(&MotionConfig::default(), &square(10.0), vec![pose(0.0, 0.0, 0.0)], 2.0);
    world.command(ActorId(0), Vec2::new(0.026, 0.0));
    assert_eq!(world.position(ActorId(0), SimTime::from_secs(0.09)), Vec2::zeros());
    world.advance();
    assert_eq!(world.positions()[0], Vec2::zeros());
    assert!(world.position(ActorId(0), SimTime::from_secs(0.15)).x > 0.0);
}

#[test]
fn a_robot_that_faces_away_ends_on_course_in_its_direction() {
    let mut world = World::new(&MotionConfig::default(), &square(10.0), vec![pose(0.0, 0.0, PI)], 2.0);
    world.command(ActorId(0), unit(0.3) * 0.026);
    for _ in 0..50 {
        world.advance();
    }
    let pose = world.pose(ActorId(0), world.now());
    assert!((pose.heading - 0.3).abs() < 1e-6);
    let before = world.positions()[0];
    world.advance();
    assert!((world.positions()[0] - before - unit(0.3) * 0.0026).norm() < 1e-8);
}

#[test]
fn a_robot_that_drives_at_a_wall_stops_at_touch() {
    let mut world = World::new(&fast(), &square(2.0), vec![pose(0.0, 0.0, 0.0)], 2.0);
    world.command(ActorId(0), Vec2::new(0.5, 0.0));
    for _ in 0..60 {
        world.advance();
        assert!(world.positions()[0].x <= 0.93 + 1e-12);
    }
    assert!((world.positions()[0].x - 0.93).abs() < 1e-12);
    let mut seen = Vec::new();
    world.proximity(ActorId(0), world.now(), &mut seen);
    assert_eq!(seen.len(), 1);
    assert!(seen[0].x > 0.0 && seen[0].norm() < 1e-5);
}

#[test]
fn a_robot_pushes_a_standing_one_before_it() {
    let poses = vec![pose(0.0, 0.0, 0.0), pose(0.5, 0.0, 1.0)];
    let mut world = World::new(&fast(), &square(10.0), poses, 2.0);
    world.command(ActorId(0), Vec2::new(0.5, 0.0));
    for _ in 0..40 {
        world.advance();
    }
    let apart = world.positions()[1] - world.positions()[0];
    assert!(world.positions()[1].x > 1.0, "{}", world.positions()[1]);
    assert!((apart - Vec2::new(0.14, 0.0)).norm() < 0.14 * OVERLAP_TOLERANCE);
    assert!((world.pose(ActorId(1), world.now()).heading - 1.0).abs() < 1e-15);
}

#[test]
fn proximity_reports_gaps_between_edges_of_robots_walls_and_obstacles() {
    let at = |x, y| (Finite::new(x), Finite::new(y));
    let arena = ArenaConfig {
        obstacles: vec![
            ObstacleConfig::Disc {
                at: at(0.0, 1.0),
                radius: Positive::new(0.75),
                attenuation: None,
            },
            ObstacleConfig::Wall {
                from: at(-1.0, -0.25),
                to: at(1.0, -0.25),
                attenuation: None,
            },
        ],
        ..square(10.0)
    };
    let poses = vec![pose(0.0, 0.0, 0.0), pose(0.3, 0.0, 0.0), pose(-0.5, 0.0, 0.0)];
    let world = World::new(&MotionConfig::default(), &arena, poses, 2.0);
    let mut seen = Vec::new();
    world.proximity(ActorId(0), SimTime::ZERO, &mut seen);
    // Robot 2 is 0.36 m away from edge to edge, beyond the range of 0.25 m.
    let expected = [Vec2::new(0.16, 0.0), Vec2::new(0.0, 0.18), Vec2::new(0.0, -0.18)];
    assert_eq!(seen.len(), expected.len());
    for (seen, expected) in seen.iter().zip(expected) {
        assert!((seen - expected).norm() < 1e-12);
    }
}

#[test]
fn a_world_at_rest_only_lets_time_pass_and_is_never_rebuilt() {
    let mut world = World::new(&MotionConfig::default(), &square(10.0), vec![pose(1.0, 1.0, 0.5)], 2.0);
    world.command(ActorId(0), Vec2::zeros());
    (0..10).for_each(|_| world.advance());
    assert_eq!(world.now(), SimTime::from_secs(1.0));
    assert_eq!(world.pose(ActorId(0), world.now()), pose(1.0, 1.0, 0.5));
    assert_eq!(world.rebuilds(), 1);

    world.command(ActorId(0), Vec2::new(0.026, 0.0));
    world.advance();
    world.command(ActorId(0), Vec2::zeros());
    (0..40).for_each(|_| world.advance());
    let rebuilds = world.rebuilds();
    world.advance();
    assert!(rebuilds > 1 && world.rebuilds() == rebuilds);
}

#[test]
fn robots_are_deployed_clear_of_each_other_and_of_obstacles() {
    for config in [
        DeployConfig::Uniform,
        DeployConfig::Cluster {
            radius: Positive::new(1.4),
        },
    ] {
        let poses = deploy(&config, &cluttered(), 100, 0.07, &Streams::new(2, 0)).unwrap();
        let world = World::new(&MotionConfig::default(), &cluttered(), poses, 1.0);
        assert!(deepest_overlap(&world, &cluttered(), 0.07) <= 0.0);
    }
}

/// Random commands for everyone, renewed every few ticks, from a stream of their own.
fn drive_at_random(world: &mut World, limit: f64, ticks: u32, seed: u64, mut after_tick: impl FnMut(&World)) {
    use rand::RngExt;
    const COMMAND: crate::engine::Purpose = crate::engine::Purpose::new("test.command");
    let commands = Streams::new(seed, 0).keyed(COMMAND);
    for tick in 0..ticks {
        for id in ids(world) {
            let mut draws = commands.at(id.0, 0, tick);
            if draws.random_bool(0.2) {
                world.command(id, unit(draws.random_range(-PI..PI)) * draws.random_range(0.0..limit));
            }
        }
        world.advance();
        after_tick(world);
    }
}

#[test]
fn the_same_seed_gives_the_same_run_bit_for_bit() {
    let run = || {
        let arena = cluttered();
        let poses = deploy(&DeployConfig::Uniform, &arena, 40, 0.07, &Streams::new(7, 0)).unwrap();
        let mut world = World::new(&fast(), &arena, poses, 1.0);
        drive_at_random(&mut world, 0.5, 200, 3, |_| {});
        world.positions().to_vec()
    };
    assert_eq!(run(), run());
}

#[test]
fn a_crowd_that_all_heads_for_one_place_packs_without_overlap_and_without_freezing_far_out() {
    let poses = deploy(&DeployConfig::Uniform, &square(4.0), 60, 0.07, &Streams::new(1, 0)).unwrap();
    let mut world = World::new(&fast(), &square(4.0), poses, 1.0);
    for _ in 0..400 {
        for id in ids(&world) {
            let towards = -world.position(id, world.now());
            world.command(id, towards);
        }
        world.advance();
        assert!(deepest_overlap(&world, &square(4.0), 0.07) <= 0.07 * OVERLAP_TOLERANCE + 1e-9);
    }
    // Sixty discs as dense as random packings of equal discs are (0.82) fill a disc of 0.6 m.
    let furthest = world.positions().iter().map(Vec2::norm).fold(0.0, f64::max);
    assert!(furthest < 0.75, "{furthest}");
}

/// Neighbours by brute force over extrapolated positions, in order of id.
fn neighbours_by_force(world: &World, id: ActorId, at: SimTime, range: f64) -> Vec<(ActorId, Vec2)> {
    ids(world)
        .filter(|&other| other != id)
        .map(|other| (other, world.position(other, at) - world.position(id, at)))
        .filter(|(_, offset)| offset.norm_squared() <= at_most(range).powi(2))
        .collect()
}

fn neighbours(world: &World, id: ActorId, at: SimTime, range: f64) -> Vec<(ActorId, Vec2)> {
    let mut found = Vec::new();
    world.for_each_within(id, at, range, |other, offset| found.push((other, offset)));
    found.sort_by_key(|&(other, _)| other);
    found
}

#[test]
fn the_mean_degree_of_robots_uniform_in_a_square_is_that_of_a_random_geometric_graph() {
    // P(edge) for R/L = 0.2 is 0.10513; bodies are points, for the closed form knows no exclusion.
    let (trials, robots, body) = (400_u32, 80_u32, 1e-6);
    let config = MotionConfig {
        body_radius: Positive::new(body),
        ..MotionConfig::default()
    };
    let degrees: Vec<f64> = (0..trials)
        .map(|trial| {
            let poses = deploy(
                &DeployConfig::Uniform,
                &square(10.0),
                robots,
                body,
                &Streams::new(5, trial),
            )
            .unwrap();
            let world = World::new(&config, &square(10.0), poses, 2.0);
            let links: usize = ids(&world)
                .map(|id| neighbours(&world, id, SimTime::ZERO, 2.0).len())
                .sum();
            links as f64 / f64::from(robots)
        })
        .collect();
    let x: f64 = 0.2;
    let expected = 79.0 * (PI * x.powi(2) - 8.0 / 3.0 * x.powi(3) + x.powi(4) / 2.0);
    assert_mean(&degrees, expected);
    assert!((expected - 8.31).abs() < 0.005);
}

/// The mean of `samples` lies within four standard errors of `expected`.
pub(super) fn assert_mean(samples: &[f64], expected: f64) {
    let count = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / count;
    let variance = samples.iter().map(|sample| (sample - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let error = (variance / count).sqrt();
    assert!(
        (mean - expected).abs() < 4.0 * error,
        "mean {mean} ± {error}, expected {expected}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn whatever_robots_do_bodies_never_overlap_nor_leave_and_arrive_where_they_were_said_to(
        seed in 0..1000_u64, robots in 1..70_u32, speed in 0.01..0.69_f64, gather in any::<bool>(),
    ) {
        let arena = cluttered();
        let config = MotionConfig { max_speed: Positive::new(speed), ..MotionConfig::default() };
        prop_assert_eq!(config.problems(), vec![]);
        let poses = deploy(&DeployConfig::Uniform, &arena, robots, 0.07, &Streams::new(seed, 0)).unwrap();
        let mut world = World::new(&config, &arena, poses, 1.0);
        let goal = unit(seed as f64);
        let mut arrivals: Vec<Vec2> = world.positions().to_vec();
        drive_at_random(&mut world, 1.0, 60, seed, |world| {
            assert_eq!(world.positions(), arrivals);
            let next = world.now() + world.tick();
            for (place, id) in arrivals.iter_mut().zip(ids(world)) {
                *place = world.position(id, next);
                assert!((*place - world.position(id, world.now())).norm() <= speed * 0.1 + 1e-12);
            }
            assert!(deepest_overlap(world, &arena, 0.07) <= 0.07 * OVERLAP_TOLERANCE + 1e-9);
        });
        if gather {
            for id in ids(&world) {
                let towards = goal - world.position(id, world.now());
                world.command(id, towards * 100.0);
            }
            for _ in 0..60 {
                world.advance();
                prop_assert!(deepest_overlap(&world, &arena, 0.07) <= 0.07 * OVERLAP_TOLERANCE + 1e-9);
            }
        }
    }

    #[test]
    fn nobody_crosses_a_wall_however_hard_it_is_pushed(seed in 0..1000_u64, speed in 0.01..0.69_f64) {
        // A wall from side to side: who starts on the left, stays there.
        let at = |x, y| (Finite::new(x), Finite::new(y));
        let arena = ArenaConfig {
            obstacles: vec![ObstacleConfig::Wall { from: at(0.0, -1.0), to: at(0.0, 1.0), attenuation: None, }],
            ..square(2.0)
        };
        let config = MotionConfig { max_speed: Positive::new(speed), ..MotionConfig::default() };
        let poses = deploy(&DeployConfig::Uniform, &arena, 40, 0.07, &Streams::new(seed, 0)).unwrap();
        let sides: Vec<bool> = poses.iter().map(|pose| pose.position.x > 0.0).collect();
        let mut world = World::new(&config, &arena, poses, 1.0);
        for (id, &right) in ids(&world).zip(&sides) {
            world.command(id, if right { Vec2::new(-1.0, 0.1) } else { Vec2::new(1.0, 0.1) });
        }
        for _ in 0..80 {
            world.advance();
            prop_assert!(world.positions().iter().zip(&sides).all(|(place, &right)| (place.x > 0.0) == right));
        }
    }

    #[test]
    fn a_search_between_ticks_finds_what_brute_force_finds(
        seed in 0..1000_u64, range in 0.01..3.0_f64, neighbour_range in 0.1..3.0_f64, nanos in 0..=100_000_000_u64,
    ) {
        let poses = deploy(&DeployConfig::Uniform, &cluttered(), 60, 0.07, &Streams::new(seed, 1)).unwrap();
        let mut world = World::new(&fast(), &cluttered(), poses, neighbour_range);
        drive_at_random(&mut world, 0.5, 10, seed, |world| {
            let at = world.now() + Span::from_nanos(nanos);
            for id in ids(world).step_by(7) {
                assert_eq!(neighbours(world, id, at, range), neighbours_by_force(world, id, at, range));
            }
        });
    }

    #[test]
    fn proximity_sees_exactly_the_bodies_within_its_range(seed in 0..1000_u64, range in 0.0..0.6_f64) {
        let config = MotionConfig { proximity_range: NonNegative::new(range), ..fast() };
        let poses = deploy(&DeployConfig::Uniform, &square(3.0), 60, 0.07, &Streams::new(seed, 2)).unwrap();
        let mut world = World::new(&config, &square(3.0), poses, 1.0);
        drive_at_random(&mut world, 0.5, 10, seed, |_| {});
        let at = world.now() + Span::from_secs(0.03);
        for id in ids(&world) {
            let mut seen = Vec::new();
            world.proximity(id, at, &mut seen);
            let place = world.position(id, at);
            let robots = neighbours_by_force(&world, id, at, range + 0.14).len();
            let sides = [place.x, -place.x, place.y, -place.y];
            let walls = sides.iter().filter(|&&side| 1.5 - side <= range + 0.07).count();
            prop_assert_eq!(seen.len(), robots + walls);
            prop_assert!(seen.iter().all(|gap| gap.norm() <= range + 1e-5));
        }
    }
}
