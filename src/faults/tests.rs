//! The faults of a run, without a run.

use super::*;
use crate::engine::{ActorId, SimTime, Span, Streams};
use crate::geometry::Vec2;
use crate::quantity::{Finite, NonNegative, Positive, Probability};

const ROLES: [&str; 3] = ["free", "networker", "worker"];
const NETWORKER: u8 = 1;
const WORKER: u8 = 2;
const STEP: Span = Span::from_nanos(100_000_000);

fn secs(seconds: f64) -> SimTime {
    SimTime::from_secs(seconds)
}

fn faults(config: &[FaultConfig], robots: usize) -> Faults {
    Faults::new(config, &ROLES, robots, STEP, Streams::new(5, 0))
}

/// Everything that changes up to `end`, with robots that stand at `places`.
fn changes(faults: &mut Faults, places: &[Vec2], end: SimTime) -> Vec<(SimTime, Change)> {
    let (mut all, mut changes) = (Vec::new(), Vec::new());
    while faults.next() <= end {
        let now = faults.next();
        faults.advance(now, places, &mut changes);
        all.extend(changes.drain(..).map(|change| (now, change)));
    }
    all
}

/// Who fails when, up to `end`, if all are networkers from the start.
fn failures(config: FaultConfig, robots: usize, end: SimTime) -> Vec<(ActorId, SimTime)> {
    let mut faults = faults(&[config], robots);
    for robot in 0..robots as u32 {
        faults.enter(SimTime::ZERO, ActorId(robot), NETWORKER);
    }
    let begun = changes(&mut faults, &vec![Vec2::zeros(); robots], end).into_iter();
    begun
        .filter(|(_, change)| change.begins)
        .map(|(at, change)| match change.subject {
            Subject::Robot { robot, .. } => (robot, at),
            Subject::Links(_) => panic!("no link fails here"),
        })
        .collect()
}

fn fallible(share: f64, hazard: f64) -> FaultConfig {
    FaultConfig::Fallible(FallibleConfig {
        share: Probability::new(share),
        hazard: Probability::new(hazard),
        roles: vec!["networker".into(), "worker".into()],
    })
}

fn planned(robots: &[u32], at: f64, lasts: LastsConfig) -> PlannedConfig {
    PlannedConfig {
        robots: robots.to_vec(),
        at: NonNegative::new(at),
        lasts,
    }
}

fn on_join(probability: f64, window: f64) -> FaultConfig {
    FaultConfig::OnJoin(OnJoinConfig {
        probability: Probability::new(probability),
        window: NonNegative::new(window),
        roles: vec!["networker".into(), "worker".into()],
    })
}

fn lasting(seconds: f64) -> LastsConfig {
    LastsConfig::For(Positive::new(seconds))
}

fn between(from: f64, until: f64) -> IntervalConfig {
    IntervalConfig::Between(NonNegative::new(from), NonNegative::new(until))
}

#[test]
fn without_faults_or_with_nobody_fallible_there_is_nothing_to_wait_for() {
    assert_eq!(faults(&[], 10).next(), SimTime::NEVER);
    for harmless in [fallible(0.0, 0.5), fallible(1.0, 0.0)] {
        assert_eq!(faults(&[harmless], 10).next(), SimTime::NEVER);
    }
}

#[test]
fn a_hazard_strikes_after_a_geometric_number_of_control_steps() {
    // Mean 1/h and variance (1 − h)/h² of a geometric number; the mean of n lies within four of its deviations.
    let (hazard, n) = (0.01_f64, 4000.0_f64);
    let failed = failures(fallible(1.0, hazard), 4000, SimTime::NEVER - Span::from_secs(1.0));
    assert_eq!(failed.len(), 4000);
    let mean = failed.iter().map(|(_, at)| at.as_secs() / 0.1).sum::<f64>() / n;
    let tolerance = 4.0 * ((1.0 - hazard) / hazard.powi(2) / n).sqrt();
    assert!((mean - 1.0 / hazard).abs() < tolerance, "{mean}");
    // At a hazard of 1 all fail at the end of their first step.
    assert!(
        failures(fallible(1.0, 1.0), 5, secs(9.0))
            .iter()
            .all(|(_, at)| *at == secs(0.1))
    );
}

#[test]
fn who_fails_at_a_share_fails_at_the_same_time_at_a_greater_share_and_no_later_at_a_greater_hazard() {
    let end = secs(100.0);
    let few = failures(fallible(0.2, 0.001), 500, end);
    let more = failures(fallible(0.5, 0.001), 500, end);
    let harder = failures(fallible(0.5, 0.002), 500, end);
    assert!(!few.is_empty() && few.len() < more.len() && more.len() < harder.len());
    assert!(few.iter().all(|failure| more.contains(failure)));
    for (robot, at) in more {
        assert!(harder.iter().any(|(other, earlier)| *other == robot && *earlier <= at));
    }
    // 500 draws at 0.5: four deviations of a binomial are 45.
    let fallible_robots = failures(fallible(0.5, 1.0), 500, end).len();
    assert!(fallible_robots.abs_diff(250) < 45, "{fallible_robots}");
}

#[test]
fn a_control_step_is_borne_once_however_often_faults_are_asked_at_its_instant() {
    // A robot that joins and fails at the very instant of a control step has the faults asked there a second time.
    let places = [Vec2::zeros(); 50];
    let struck = |calls: u32| {
        let mut faults = faults(&[fallible(1.0, 0.001)], 50);
        for robot in 0..50 {
            faults.enter(SimTime::ZERO, ActorId(robot), NETWORKER);
        }
        let mut changes = Vec::new();
        while faults.next() <= secs(100.0) {
            let now = faults.next();
            (0..calls).for_each(|_| faults.advance(now, &places, &mut changes));
        }
        changes
    };
    assert!(!struck(1).is_empty());
    assert_eq!(struck(1), struck(2));
}

#[test]
fn a_robot_bears_hazard_only_in_its_roles() {
    let mut all = faults(&[fallible(1.0, 1.0)], 2);
    all.enter(secs(1.0), ActorId(1), WORKER);
    let struck = changes(&mut all, &[Vec2::zeros(); 2], secs(5.0));
    let [(_, change)] = &struck[..] else {
        panic!("one robot has a role: {struck:?}")
    };
    assert!(matches!(change.subject, Subject::Robot { robot: ActorId(1), .. }));
}

#[test]
fn a_robot_that_joins_fails_within_the_window_with_its_probability_and_never_once_it_has_left() {
    // 1000 draws at 0.3: four deviations of a binomial are 58; a uniform time in 20 s has a deviation of 5.8 s.
    let failed = failures(on_join(0.3, 20.0), 1000, secs(1000.0));
    assert!(failed.len().abs_diff(300) < 58, "{}", failed.len());
    assert!(failed.iter().all(|(_, at)| *at <= secs(20.0)));
    let mean = failed.iter().map(|(_, at)| at.as_secs()).sum::<f64>() / failed.len() as f64;
    assert!((mean - 10.0).abs() < 4.0 * 5.8 / (failed.len() as f64).sqrt(), "{mean}");

    let mut certain = faults(&[on_join(1.0, 20.0)], 2);
    certain.enter(secs(0.0), ActorId(0), NETWORKER);
    certain.enter(secs(0.0), ActorId(1), NETWORKER);
    let due = certain.next();
    certain.enter(secs(0.0), ActorId(0), 0);
    certain.enter(secs(0.0), ActorId(1), WORKER);
    assert!(
        certain.next() >= due,
        "to change between the roles is not to join again"
    );
    let struck = changes(&mut certain, &[Vec2::zeros(); 2], secs(100.0));
    assert_eq!(struck.len(), 1, "robot 0 left in time");
}

#[test]
fn faults_that_overlap_are_counted_and_a_robot_is_well_when_all_have_passed() {
    let config = [
        FaultConfig::Silence(planned(&[0], 0.0, lasting(10.0))),
        FaultConfig::Crash(planned(&[0], 5.0, lasting(10.0))),
        FaultConfig::Deaf(planned(&[0], 20.0, LastsConfig::ForGood)),
        FaultConfig::Mute(planned(&[1], 20.0, lasting(1.0))),
    ];
    let mut all = faults(&config, 2);
    let seen: Vec<_> = changes(&mut all, &[Vec2::zeros(); 2], secs(100.0))
        .into_iter()
        .map(|(at, change)| match change.subject {
            Subject::Robot { robot, health, .. } => (
                at.as_secs(),
                robot.0,
                change.begins,
                health.sends,
                health.hears,
                health.acts,
            ),
            Subject::Links(_) => panic!("no link fails here"),
        })
        .collect();
    let expected = [
        (0.0, 0, true, false, false, true),
        (5.0, 0, true, false, false, false),
        (10.0, 0, false, false, false, false),
        (15.0, 0, false, true, true, true),
        (20.0, 0, true, true, false, true),
        (20.0, 1, true, false, true, true),
        (21.0, 1, false, true, true, true),
    ];
    assert_eq!(seen, expected);
}

#[test]
fn radiation_strikes_inside_its_region_and_its_interval_and_again_after_a_recovery() {
    let radiation = FaultConfig::Radiation(RadiationConfig {
        within: RegionConfig::Rectangle {
            at: (Finite::new(2.0), Finite::new(0.0)),
            size: (Positive::new(2.0), Positive::new(1.0)),
        },
        hazard: Probability::new(1.0),
        during: between(10.0, 10.5),
        effect: Effect::Crash,
        lasts: lasting(0.25),
    });
    let places = [Vec2::new(1.0, 0.5), Vec2::new(0.99, 0.0), Vec2::new(2.0, 0.51)];
    let struck: Vec<_> = changes(&mut faults(&[radiation], 3), &places, secs(100.0))
        .into_iter()
        .map(|(at, change)| (at.as_secs(), change.begins))
        .collect();
    // A step of exposure ends at 10.1 s; out of order until 10.35 s, so the next one that counts ends at 10.4 s.
    assert_eq!(struck, [(10.1, true), (10.35, false), (10.4, true), (10.65, false)]);
}

#[test]
fn links_lose_what_each_of_their_faults_takes_while_it_lasts() {
    let at = |x: f64, y: f64| (Finite::new(x), Finite::new(y));
    let burst = |links, loss| {
        FaultConfig::Burst(BurstConfig {
            links,
            loss: Probability::new(loss),
            during: between(1.0, 3.0),
        })
    };
    let mut all = faults(
        &[
            FaultConfig::Partition(PartitionConfig {
                line: (at(0.0, -1.0), at(0.0, 1.0)),
                during: between(2.0, 4.0),
            }),
            burst(LinksConfig::Of(vec![1]), 0.5),
            burst(LinksConfig::Pairs(vec![(2, 1)]), 0.2),
        ],
        3,
    );
    let (west, east) = (Vec2::new(-1.0, 0.0), Vec2::new(1.0, 5.0));
    let mut loss_at = |now: f64| {
        let mut changes = Vec::new();
        while all.next() <= secs(now) {
            all.advance(all.next(), &[Vec2::zeros(); 3], &mut changes);
        }
        let loss = |a, from, b, to| all.link_loss((ActorId(a), from), (ActorId(b), to));
        let across = loss(0, west, 2, east);
        let rounded = |loss: f64| (loss * 1e9).round() / 1e9;
        let burst = [loss(0, west, 1, west), loss(1, west, 2, west), loss(2, west, 0, west)].map(rounded);
        (all.trouble_links(), across, burst)
    };
    assert_eq!(loss_at(0.9), (false, 0.0, [0.0, 0.0, 0.0]));
    assert_eq!(loss_at(1.0), (true, 0.0, [0.5, 0.6, 0.0]));
    assert_eq!(loss_at(2.0), (true, 1.0, [0.5, 0.6, 0.0]));
    assert_eq!(loss_at(3.0), (true, 1.0, [0.0, 0.0, 0.0]));
    assert_eq!(loss_at(4.0), (false, 0.0, [0.0, 0.0, 0.0]));
}

#[test]
#[should_panic(expected = "the faults are unusable")]
fn faults_with_problems_are_refused() {
    let _ = faults(&[FaultConfig::Crash(planned(&[7], 1.0, LastsConfig::ForGood))], 7);
}
