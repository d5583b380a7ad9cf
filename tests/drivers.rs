//! Both drivers run the same robots to the same record, event by event.

use std::path::Path;

use desim::metrics::TrialRecord;
use desim::scenario::{Override, Scenario, load};
use desim::simulation::{DriverKind, run_trial};
use tokio_util::sync::CancellationToken;

fn scenario(file: &str, overrides: &[&str]) -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios").join(file);
    let overrides: Vec<Override> = overrides
        .iter()
        .map(|set| set.parse().expect("a valid override"))
        .collect();
    load(&path, &overrides).expect("a shipped scenario with valid overrides")
}

fn run(scenario: &Scenario, trial: u32, driver: DriverKind) -> TrialRecord {
    run_trial(scenario, trial, driver, &CancellationToken::new()).expect("the trial reaches its end")
}

fn assert_same_under_both_drivers(scenario: &Scenario) {
    let actors = run(scenario, 0, DriverKind::Actors);
    let inline = run(scenario, 0, DriverKind::Inline);
    assert!(
        actors.ledger.iter().any(|topic| topic.delivered > 0),
        "nothing was said, so nothing is shown"
    );
    assert_eq!(actors.digest, inline.digest);
    assert_eq!(actors, inline);
}

#[test]
fn the_backbone_over_a_lossy_radio_is_the_same_run_under_both_drivers() {
    assert_same_under_both_drivers(&scenario("loss20.ron", &["time_limit=30.0"]));
}

#[test]
fn robots_at_random_phases_are_the_same_run_under_both_drivers() {
    assert_same_under_both_drivers(&scenario("loss20.ron", &["time_limit=20.0", "control.phase=Random"]));
}

#[test]
fn robots_woken_by_each_reception_are_the_same_run_under_both_drivers() {
    assert_same_under_both_drivers(&scenario(
        "loss20.ron",
        &["time_limit=5.0", "metrics.hold=1.0", "control.wake=OnReception"],
    ));
}

#[test]
fn heartbeats_with_timers_between_control_steps_are_the_same_run_under_both_drivers() {
    assert_same_under_both_drivers(&scenario(
        "loss20.ron",
        &[
            "time_limit=20.0",
            "protocol=Heartbeat",
            "radio.loss=Bernoulli(0.6)",
            "detector=Timeout(0.25)",
            "control.phase=Random",
        ],
    ));
}

#[test]
fn another_seed_or_another_trial_is_another_run() {
    let base = scenario("loss20.ron", &["time_limit=5.0", "metrics.hold=1.0"]);
    let other = scenario("loss20.ron", &["time_limit=5.0", "metrics.hold=1.0", "seed=2"]);
    let digest = run(&base, 0, DriverKind::Inline).digest;
    assert_ne!(digest, run(&other, 0, DriverKind::Inline).digest);
    assert_ne!(digest, run(&base, 1, DriverKind::Inline).digest);
}

#[test]
fn waking_robots_for_each_reception_changes_when_they_read_and_not_what_arrives() {
    let waiting = scenario("loss20.ron", &["time_limit=20.0", "protocol=Heartbeat"]);
    let woken = scenario(
        "loss20.ron",
        &["time_limit=20.0", "protocol=Heartbeat", "control.wake=OnReception"],
    );
    let (waiting, woken) = (run(&waiting, 0, DriverKind::Inline), run(&woken, 0, DriverKind::Inline));
    assert_eq!(waiting.ledger, woken.ledger);
    assert_eq!(waiting.latency, woken.latency);
    assert!(woken.events > 2 * waiting.events);
}
