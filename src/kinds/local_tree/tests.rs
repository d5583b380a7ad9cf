//! Single robots, stepped by hand.

use super::*;
use crate::engine::Streams;
use crate::protocol::control::{PhaseConfig, Phases, Rhythm};
use crate::protocol::gossip::{GossipConfig, Turns};
use crate::testing::Solo;

const SPEED: f64 = 0.2;

fn robot(id: u32, duty: Duty, config: LocalTreeConfig) -> Solo<LocalTree> {
    let streams = Streams::new(1, 0);
    let phases = Phases::new(PhaseConfig::Together, streams);
    let timing = GossipConfig::default()
        .status
        .timing(crate::engine::Span::from_secs(0.1));
    let turns = Turns::new(timing, Rhythm::Status, phases, streams).of(ActorId(id));
    let settings = Settings {
        config,
        range: 2.0,
        max_speed: SPEED,
        period: 0.1,
        ground: Ground::still(),
    };
    let mut solo = Solo::new(
        ActorId(id),
        9,
        LocalTree::new(ActorId(id), Rc::new(settings), turns, duty),
    );
    solo.advance(0.1);
    solo
}

fn says(x: f32, tree: &[u32]) -> Message {
    Message {
        at: [x, 0.0],
        tree: tree.iter().copied().map(ActorId).collect(),
    }
}

fn links(links: Links) -> LocalTreeConfig {
    LocalTreeConfig {
        links,
        ..LocalTreeConfig::default()
    }
}

fn parents(notes: &[Note]) -> Option<Vec<u32>> {
    notes.iter().rev().find_map(|note| match note {
        Note::Parents(parents) => Some(parents.iter().map(|robot| robot.0).collect()),
        _ => None,
    })
}

#[test]
fn a_union_honours_who_counts_on_it_and_an_intersection_drops_who_does_not() {
    let hear = |config| {
        let mut robot = robot(0, Duty::Follows, config);
        robot.hears(ActorId(1), says(1.0, &[2]));
        robot.hears(ActorId(2), says(1.9, &[0, 1]));
        robot.control_step()
    };
    // In its own tree is 1 alone, which does not count on it; 2 does, and is behind 1.
    let union = hear(links(Links::Union));
    assert_eq!(union.words()[0].tree, [ActorId(1)]);
    assert_eq!(parents(&union.notes), Some(vec![1, 2]));
    assert_eq!(parents(&hear(links(Links::Intersection)).notes), None);
}

#[test]
fn one_that_was_not_heard_for_longer_than_the_memory_is_no_neighbour() {
    let config = LocalTreeConfig {
        memory: 2,
        ..LocalTreeConfig::default()
    };
    let mut robot = robot(0, Duty::Follows, config);
    robot.hears(ActorId(1), says(1.0, &[]));
    for _ in 0..3 {
        assert_eq!(robot.control_step().words()[0].tree, [ActorId(1)]);
    }
    let gone = robot.control_step();
    assert!(gone.words()[0].tree.is_empty());
    assert_eq!(parents(&gone.notes), Some(vec![]));
}

#[test]
fn a_worker_stops_where_its_link_would_part_and_a_follower_goes_after_it() {
    let config = LocalTreeConfig::default();
    let mut worker = robot(0, Duty::Worker(2, Vec2::new(-9.0, 0.0)), config.clone());
    let begins = worker.control_step();
    assert!(
        (begins.velocity.unwrap() - Vec2::new(-SPEED, 0.0)).norm() < 1e-9,
        "nobody holds it"
    );
    worker.hears(ActorId(1), says(1.8, &[0]));
    let held = worker.control_step();
    // Half of 2 m less the margin is 0.9 m, which it is away from the middle already.
    assert!(held.velocity.unwrap().norm() < 1e-6, "{held:?}");
    let mut follower = robot(1, Duty::Follows, config);
    follower.hears(ActorId(0), says(-1.0, &[1]));
    assert!(follower.control_step().velocity.unwrap().x < 0.0);
}

#[test]
fn tension_comes_before_the_task_and_is_bounded() {
    let config = LocalTreeConfig {
        keep: Keep::Tension {
            gain: crate::quantity::Positive::new(1.0),
        },
        ..LocalTreeConfig::default()
    };
    let mut worker = robot(0, Duty::Worker(0, Vec2::new(-9.0, 0.0)), config);
    worker.hears(ActorId(1), says(1.95, &[0]));
    let velocity = worker.control_step().velocity.unwrap();
    assert!((velocity - Vec2::new(SPEED, 0.0)).norm() < 1e-9);
}

#[test]
fn a_tree_that_is_renewed_when_it_holds_back_stays_until_then() {
    let config = LocalTreeConfig {
        renew: Renew::WhenHeldBack,
        ..LocalTreeConfig::default()
    };
    let mut robot = robot(0, Duty::Worker(0, Vec2::new(-9.0, 0.0)), config);
    robot.hears(ActorId(1), says(1.2, &[]));
    assert_eq!(robot.control_step().words()[0].tree, [ActorId(1)]);
    // 2 is between them: it would take the place of 1.
    robot.hears(ActorId(2), says(0.6, &[]));
    robot.hears(ActorId(1), says(1.2, &[]));
    assert_eq!(robot.control_step().words()[0].tree, [ActorId(1)]);
    // Now 1 holds it back, so that the next step looks again.
    robot.hears(ActorId(1), says(1.8, &[]));
    robot.control_step();
    assert_eq!(robot.control_step().words()[0].tree, [ActorId(2)]);
}

#[test]
fn the_root_stands_and_duties_are_reported_once() {
    let mut root = robot(0, Duty::Root, LocalTreeConfig::default());
    root.hears(ActorId(1), says(1.0, &[0]));
    let first = root.control_step();
    assert_eq!(first.velocity, Some(Vec2::zeros()));
    let mut worker = robot(3, Duty::Worker(2, Vec2::zeros()), LocalTreeConfig::default());
    let notes = worker.control_step().notes;
    assert!(!notes.contains(&Note::Role(WORKER)), "it said so at its first step");
}
