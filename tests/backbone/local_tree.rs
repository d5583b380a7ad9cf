//! Local trees: what holds between their robots in whole runs.

use desim::experiment::run_trial;
use desim::metrics::{Amount, TrialRecord};
use desim::scenario::{Override, parse};
use desim::simulation::DriverKind;

const WANDERING: &str = r#"Scenario(
    name: "wandering",
    time_limit: 15.0,
    swarm: (robots: 20, deploy: Cluster(radius: 2.0)),
    protocol: LocalTree(memory: 1),
    motion: (max_speed: 0.2),
    wander: RandomWalk(speed: 0.2, leg: 4.0),
    metrics: (sample_interval: 0.1),
)"#;

fn trial(number: u32, driver: DriverKind, overrides: &[&str]) -> TrialRecord {
    let overrides: Vec<Override> = overrides
        .iter()
        .map(|text| text.parse().expect("an override"))
        .collect();
    let scenario = parse("wandering.ron", WANDERING, &overrides).expect("a sound scenario");
    run_trial(&scenario, number, driver, &Default::default()).expect("the trial reaches its end")
}

/// The mean of what was measured under `name`.
fn mean(record: &TrialRecord, name: &str) -> f64 {
    let measured = record.noted.iter().find_map(|noted| match &noted.amount {
        Amount::Values(values) if noted.name == name => Some(values.mean()),
        _ => None,
    });
    measured.expect("it was measured")
}

#[test]
fn where_nobody_moves_and_nothing_is_lost_the_links_that_both_ends_have_hold_all_together() {
    // Nor does anybody make way for another.
    let still = ["wander=Still", "protocol.avoidance_gain=0.0"];
    for number in 0..5 {
        let record = trial(number, DriverKind::Inline, &still);
        assert!((mean(&record, "links_both_connected") - 1.0).abs() < 1e-12);
        assert!(mean(&record, "links_length") >= 1.0 - 1e-6);
        // Two that do not hear the same robots may differ in their trees; where all hear all there is one tree.
        let dense = trial(
            number,
            DriverKind::Inline,
            &[&still[..], &["swarm.deploy=Cluster(radius: 0.9)"]].concat(),
        );
        assert!(mean(&dense, "links_one_sided") < 1e-12);
        assert!((mean(&dense, "links_length") - 1.0).abs() < 1e-6);
    }
}

#[test]
fn robots_that_keep_within_the_middle_of_their_links_are_never_parted_if_all_is_heard() {
    // The margin covers what two robots move in the two steps for which one may not know of the other's place.
    for number in 0..5 {
        let record = trial(
            number,
            DriverKind::Inline,
            &["protocol.keep=Midpoint(margin: 0.1)", "time_limit=60.0"],
        );
        assert!(record.connectivity.iter().all(|sample| sample.components == 1));
    }
}

#[test]
fn a_union_holds_under_loss_and_a_dead_robot_is_let_go() {
    let record = trial(
        0,
        DriverKind::Inline,
        &[
            "radio.loss=Bernoulli(0.2)",
            "faults=[Crash(robots: [3, 5], at: 5.0)]",
            "protocol.memory=5",
        ],
    );
    assert!(mean(&record, "links_either_connected") > 0.9);
    for (robot, state) in record
        .robots
        .iter()
        .enumerate()
        .filter(|(robot, _)| ![3, 5].contains(robot))
    {
        let dead = state.parents.iter().any(|other| [3, 5].contains(&other.0));
        assert!(!dead, "robot {robot} still keeps a dead one");
    }
}

#[test]
fn a_run_is_the_same_whichever_way_robots_are_driven_and_another_one_with_another_seed() {
    let overrides = ["radio.loss=Bernoulli(0.2)"];
    let inline = trial(2, DriverKind::Inline, &overrides);
    assert_eq!(inline.digest, trial(2, DriverKind::Actors, &overrides).digest);
    assert_ne!(inline.digest, trial(3, DriverKind::Inline, &overrides).digest);
}
