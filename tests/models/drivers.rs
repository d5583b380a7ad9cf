//! Both drivers run the same robots to the same record, event by event.

use std::path::Path;

use desim::experiment::run_trial;
use desim::metrics::TrialRecord;
use desim::scenario::{Override, Scenario, load};
use desim::simulation::DriverKind;
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
        &[
            "time_limit=5.0",
            "protocol.completion=Held(1.0)",
            "control.wake=OnReception",
        ],
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
    let base = scenario("loss20.ron", &["time_limit=5.0", "protocol.completion=Held(1.0)"]);
    let other = scenario(
        "loss20.ron",
        &["time_limit=5.0", "protocol.completion=Held(1.0)", "seed=2"],
    );
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

/// Latencies that are the same whatever their least value is declared to be, and robots that take their control steps in
/// rounds if it is not zero.
fn assert_same_with_and_without_rounds(file: &str, overrides: &[&str]) {
    let [in_rounds, one_by_one] = ["0.01", "0.0"].map(|least| {
        let latency = format!("radio.latency=Normal(mean: 0.03, std_dev: 0.002, min: {least})");
        let overrides: Vec<&str> = overrides
            .iter()
            .copied()
            .chain([latency.as_str(), "control.phase=Random"])
            .collect();
        run(&scenario(file, &overrides), 0, DriverKind::Inline)
    });
    assert!(in_rounds.ledger.iter().any(|topic| topic.delivered > 0));
    assert_eq!(in_rounds, one_by_one);
}

/// Latencies of ten milliseconds to the nanosecond, which is declared, or not.
fn assert_same_at_the_very_lookahead(overrides: &[&str]) {
    let [in_rounds, one_by_one] = ["Constant(0.01)", "Normal(mean: 0.01, std_dev: 1e-13, min: 0.0)"].map(|latency| {
        let latency = format!("radio.latency={latency}");
        let overrides: Vec<&str> = overrides
            .iter()
            .copied()
            .chain([latency.as_str(), "control.phase=Random"])
            .collect();
        run(&scenario("loss20.ron", &overrides), 0, DriverKind::Inline)
    });
    assert!(in_rounds.ledger.iter().any(|topic| topic.delivered > 0));
    assert_eq!(in_rounds, one_by_one);
}

/// What a robot sends may arrive at the end of the round that it was sent in, and not one nanosecond before.
#[test]
fn a_round_ends_where_the_first_frame_of_it_may_arrive() {
    assert_same_at_the_very_lookahead(&["time_limit=12.0"]);
    assert_same_at_the_very_lookahead(&[
        "time_limit=10.0",
        "protocol=Heartbeat",
        "radio.loss=Bernoulli(0.6)",
        "detector=Timeout(0.25)",
    ]);
}

/// Neither a motion tick nor anything else happens when this run ends, in the middle of a round.
#[test]
fn a_round_ends_with_the_run() {
    for end in ["11.0137", "11.0341", "11.0437", "11.0719"] {
        let limit = format!("time_limit={end}");
        assert_same_with_and_without_rounds("loss20.ron", &[&limit]);
        assert_same_with_and_without_rounds("loss20.ron", &[&limit, "protocol=Heartbeat"]);
        assert_same_at_the_very_lookahead(&[&limit]);
    }
}

#[test]
fn control_steps_taken_in_rounds_are_the_same_run_as_one_by_one() {
    assert_same_with_and_without_rounds("loss20.ron", &["time_limit=20.0"]);
}

#[test]
fn rounds_make_no_difference_to_robots_that_fail_and_recover_as_they_take_a_role() {
    // Robots that join fail within a few milliseconds, before the round is over in which they joined.
    assert_same_with_and_without_rounds(
        "loss20.ron",
        &[
            "time_limit=60.0",
            "faults=[
                Robots(when: Hazard(per_step: 0.001), effect: Crash, lasts: For(0.35)),
                Robots(when: OnJoin(probability: 0.5, window: 0.005), roles: [\"networker\"], effect: Deaf, lasts: For(0.05)),
            ]",
        ],
    );
}

#[test]
fn rounds_make_no_difference_to_timers_between_control_steps_and_to_wakes_on_reception() {
    let overrides = [
        "time_limit=20.0",
        "protocol=Heartbeat",
        "radio.loss=Bernoulli(0.6)",
        "detector=Timeout(0.25)",
    ];
    assert_same_with_and_without_rounds("loss20.ron", &overrides);
    let woken = [&overrides[..], &["control.wake=OnReception"]].concat();
    assert_same_with_and_without_rounds("loss20.ron", &woken);
}

#[test]
fn a_swarm_that_outgrows_the_cache_is_the_same_run_under_both_drivers() {
    assert_same_under_both_drivers(&scenario(
        "heartbeat.ron",
        &["swarm.robots=2100", "arena.size=(150.0, 150.0)", "time_limit=1.0"],
    ));
}
