//! The backbone under every detector.

use desim::experiment::run_trial;
use desim::metrics::{Outcome, TrialRecord};
use desim::scenario::parse;
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

const DETECTORS: [&str; 6] = [
    "Timeout(4.0)",
    "NfdS(shift: 3.0)",
    "PhiAccrual(dialect: Chitchat, threshold: 30.0, initial_interval: Seconds(0.2))",
    "PhiAccrual(dialect: Cassandra, threshold: 12.0, initial_interval: Seconds(0.2))",
    "PhiAccrual(dialect: Akka)",
    "Swim()",
];

/// Two targets 3.2 m out, a relay each, at 20 % loss.
fn mission(detector: &str, driver: DriverKind) -> TrialRecord {
    let text = format!(
        "Scenario(name: \"mission\", time_limit: 200.0, swarm: (robots: 8, deploy: Cluster(radius: 0.7)),
         protocol: Backbone(targets: Ring(count: 2, radius: 3.2)),
         radio: (loss: Bernoulli(0.2), latency: Constant(0.01)), detector: {detector})"
    );
    let scenario = parse("mission.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
    run_trial(&scenario, 0, driver, &CancellationToken::new()).expect("the trial reaches its end")
}

#[test]
fn a_small_mission_completes_under_every_detector_the_same_with_both_drivers() {
    for detector in DETECTORS {
        let record = mission(detector, DriverKind::Inline);
        assert!(
            matches!(record.outcome, Outcome::Completed { .. }),
            "{detector}: {:?}",
            record.outcome
        );
        assert_eq!(record, mission(detector, DriverKind::Actors), "{detector}");
    }
}

#[test]
fn only_a_detector_that_sends_has_a_topic_of_its_own() {
    let topics = |detector| mission(detector, DriverKind::Inline).ledger;
    assert_eq!(topics("Timeout(4.0)").len(), 4);
    let with_probes = topics("Swim()");
    assert_eq!(with_probes.len(), 5);
    assert!(with_probes[4].delivered > 1_000, "{}", with_probes[4]);
}
