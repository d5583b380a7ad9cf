//! Robots that obey to the letter, without a drive and a body.

use super::*;
use crate::protocol::control::PhaseConfig;

fn ground(config: WanderConfig) -> Ground {
    let control = ControlConfig {
        phase: PhaseConfig::Together,
        ..ControlConfig::default()
    };
    Ground::new(config, Vec2::new(8.2, 6.2), 0.05, &control, Streams::new(5, 0))
}

/// Places of a robot at every 0.1 s.
fn walk(config: WanderConfig, robot: u32, seconds: u32) -> Vec<Vec2> {
    let ground = ground(config);
    let mut wander = Wander::default();
    let mut position = Vec2::zeros();
    let step = |step| {
        let now = SimTime::from_secs(f64::from(step) / 10.0);
        let velocity = wander.velocity(&ground, ActorId(robot), now, position).unwrap();
        position += velocity * 0.1;
        position
    };
    (0..10 * seconds).map(step).collect()
}

fn waypoint(pause: f64) -> WanderConfig {
    WanderConfig::RandomWaypoint {
        speed: Positive::new(0.2),
        pause: NonNegative::new(pause),
    }
}

#[test]
fn a_still_robot_commands_nothing() {
    let mut wander = Wander::default();
    let none = wander.velocity(&Ground::still(), ActorId(0), SimTime::ZERO, Vec2::zeros());
    assert_eq!((none, wander.legs), (None, 0));
}

#[test]
fn a_walker_turns_once_a_leg_and_keeps_its_speed() {
    let config = WanderConfig::RandomWalk {
        speed: Positive::new(0.2),
        leg: Positive::new(1.0),
    };
    let places = walk(config, 3, 20);
    let steps: Vec<Vec2> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(steps.iter().all(|step| (step.norm() - 0.02).abs() < 1e-9));
    let turns = steps
        .windows(2)
        .filter(|pair| (pair[1] - pair[0]).norm() > 1e-6)
        .count();
    assert_eq!(turns, 19);
}

#[test]
fn a_robot_between_waypoints_stays_in_its_ground_and_others_go_elsewhere() {
    let places = walk(waypoint(0.0), 3, 400);
    assert!(places.iter().all(|place| place.x.abs() <= 4.0 && place.y.abs() <= 3.0));
    assert_ne!(places.last(), walk(waypoint(0.0), 4, 400).last());
    let widest = places.iter().map(Vec2::norm).fold(0.0, f64::max);
    assert!(widest > 2.0, "{widest}");
}

#[test]
fn a_robot_rests_at_each_waypoint_and_one_that_is_blocked_takes_another() {
    let places = walk(waypoint(5.0), 3, 200);
    let rests = places.windows(2).filter(|pair| pair[0] == pair[1]).count();
    assert!(rests > 40, "{rests} steps of rest");
    let mut wander = Wander::default();
    let ground = ground(waypoint(0.0));
    for second in 0..200 {
        let now = SimTime::from_secs(f64::from(second));
        wander.velocity(&ground, ActorId(3), now, Vec2::zeros());
    }
    assert!(wander.legs > 2, "{} legs of a robot that cannot move", wander.legs);
}

/// Where each of `robots` robots, which obey to the letter, is after so many control steps of `period` seconds.
fn places_after(config: WanderConfig, period: f64, steps: u64, robots: u32) -> Vec<Vec2> {
    let control = ControlConfig {
        period: Positive::new(period),
        ..ControlConfig::default()
    };
    let ground = Ground::new(config, Vec2::new(8.2, 6.2), 0.1, &control, Streams::new(5, 0));
    let place = |robot| {
        let (mut wander, mut position) = (Wander::default(), Vec2::zeros());
        for step in 0..steps {
            let now = SimTime::ZERO + control.period() * step;
            position += wander.velocity(&ground, ActorId(robot), now, position).unwrap() * period;
        }
        position
    };
    (0..robots).map(place).collect()
}

/// How the numbers of `places` in 8 columns and 6 rows of a room of 2 `half` deviate from `expected` shares: chi-square.
fn chi_square(places: &[Vec2], half: Vec2, expected: &[f64; 48]) -> f64 {
    let mut counts = [0.0; 48];
    for place in places {
        let cell = |axis: usize, cells: f64| {
            let share = f64::midpoint(place[axis] / half[axis], 1.0);
            (share * cells).clamp(0.0, cells - 1.0) as usize
        };
        counts[cell(1, 6.0) * 8 + cell(0, 8.0)] += 1.0;
    }
    let number = places.len() as f64;
    counts
        .iter()
        .zip(expected)
        .map(|(count, share)| (count - number * share).powi(2) / (number * share))
        .sum()
}

/// One place of each of 4,800 robots, so that all are independent: 100 a cell of 48. With 47 degrees of freedom chi-square is
/// below 92 but for 1e-4. Of them a share is within 0.2 m of a wall: a binomial, four σ. Legs of 4 s at 1 m/s mix
/// a room of 8 × 6 m within 80 s (its slowest mode falls off within L²/π²D = 64/(9.9 · 2) = 3.2 s).
#[test]
fn a_walker_is_in_the_long_run_anywhere_with_the_same_probability_walls_included() {
    let config = WanderConfig::RandomWalk {
        speed: Positive::new(1.0),
        leg: Positive::new(4.0),
    };
    let half = Vec2::new(4.0, 3.0);
    for period in [0.1, 0.3, 1.0] {
        let places = places_after(config, period, (80.0 / period) as u64, 4800);
        assert!(places.iter().all(|place| place.x.abs() <= 4.0 && place.y.abs() <= 3.0));
        let deviation = chi_square(&places, half, &[1.0 / 48.0; 48]);
        assert!(deviation < 92.0, "period {period} s: {deviation}");
        let near = places.iter().filter(|place| (half - place.abs()).min() < 0.2).count() as f64;
        let share: f64 = 1.0 - (7.6 * 5.6) / (8.0 * 6.0);
        let error = (4800.0 * share * (1.0 - share)).sqrt();
        assert!(
            (near - 4800.0 * share).abs() < 4.0 * error,
            "period {period} s: {near} near a wall"
        );
    }
}

/// The density of random waypoints in a convex room (Hyytiä, Lassila and Virtamo 2006) is at r proportional to
/// ∫ a₁ a₂ (a₁ + a₂) dφ over half a turn, a₁ and a₂ being the ways from r to the rim in the directions φ and φ + π.
fn waypoint_shares(half: Vec2) -> [f64; 48] {
    let way = |from: Vec2, along: Vec2| {
        let axis = |axis: usize| (half[axis] - from[axis] * along[axis].signum()) / along[axis].abs();
        axis(0).min(axis(1))
    };
    let density = |at: Vec2| -> f64 {
        let turn = |n: u32| {
            let along = unit((f64::from(n) + 0.5) / 180.0 * TAU / 2.0);
            let (ahead, behind) = (way(at, along), way(at, -along));
            ahead * behind * (ahead + behind)
        };
        (0..180).map(turn).sum()
    };
    let mut shares = [0.0; 48];
    for (index, share) in shares.iter_mut().enumerate() {
        let (column, row) = ((index % 8) as f64, (index / 8) as f64);
        for sample in 0..100 {
            let (x, y) = (
                column + (f64::from(sample % 10) + 0.5) / 10.0,
                row + (f64::from(sample / 10) + 0.5) / 10.0,
            );
            *share += density(Vec2::new((x / 4.0 - 1.0) * half.x, (y / 3.0 - 1.0) * half.y));
        }
    }
    let all: f64 = shares.iter().sum();
    shares.map(|share| share / all)
}

/// Waypoints leave a body's width to the walls: they lie within 3.9 × 2.9 m of the centre. The least of 4,800 a cell is 17.
#[test]
fn robots_between_waypoints_are_where_the_known_density_has_them_whatever_the_period() {
    let half = Vec2::new(3.9, 2.9);
    let shares = waypoint_shares(half);
    for period in [0.1, 0.2, 0.5, 1.0] {
        let config = WanderConfig::RandomWaypoint {
            speed: Positive::new(0.5),
            pause: NonNegative::new(0.0),
        };
        let places = places_after(config, period, (160.0 / period) as u64, 4800);
        let deviation = chi_square(&places, half, &shares);
        assert!(deviation < 92.0, "period {period} s: {deviation}");
    }
}

#[test]
fn all_walkers_turn_at_instants_of_their_own_unless_they_are_together() {
    let config = WanderConfig::RandomWalk {
        speed: Positive::new(0.1),
        leg: Positive::new(3.0),
    };
    let first_turns = |phase| {
        let control = ControlConfig {
            phase,
            ..ControlConfig::default()
        };
        let ground = Ground::new(config, Vec2::new(80.0, 60.0), 0.05, &control, Streams::new(5, 0));
        let turn = |robot| {
            let mut wander = Wander::default();
            let mut velocity = |step: u64| {
                let now = SimTime::ZERO + control.period() * step;
                wander.velocity(&ground, ActorId(robot), now, Vec2::zeros()).unwrap()
            };
            let first = velocity(0);
            (1..60).find(|&step| velocity(step) != first).unwrap()
        };
        (0..50).map(turn).collect::<std::collections::BTreeSet<u64>>()
    };
    assert_eq!(first_turns(PhaseConfig::Together).into_iter().collect::<Vec<_>>(), [30]);
    assert!(
        first_turns(PhaseConfig::Random).len() > 15,
        "50 robots at 30 control steps"
    );
}
