//! Clocks that drift: what of a run goes by them, and how much.

use desim::experiment::run_trial;
use desim::metrics::TrialRecord;
use desim::radio::LossCause;
use desim::scenario::{Scenario, parse};
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

fn scenario(fields: &str) -> Scenario {
    let text =
        format!("Scenario(name: \"clocks\", arena: (size: (4.0, 4.0)), metrics: (sample_interval: 0.0), {fields})");
    parse("clocks.ron", &text, &[]).unwrap_or_else(|report| panic!("{text}\n{report}"))
}

fn run(scenario: &Scenario, driver: DriverKind) -> TrialRecord {
    run_trial(scenario, 0, driver, &CancellationToken::new()).expect("the trial runs")
}

/// In 1000 s a robot that is fast by a share s takes 1000 (1 + s)/0.1 control steps, the first of them at a phase of its own. The mean of s over 60 robots is within
/// 4 · w/√(3 · 60) of 0, and its mean square that of a uniform law.
#[test]
fn control_steps_go_by_each_robots_own_clock() {
    const DRIFT: f64 = 10_000e-6;
    let steps = |drift: f64| {
        let scenario = scenario(&format!(
            "time_limit: 1000.0, swarm: (robots: 60, deploy: Uniform), protocol: Heartbeat, gossip: (status: (interval: 100.0)), detector: None, \
             control: (clock_drift: {:?}), motion: (tick: 0.1)",
            drift * 1e6
        ));
        run(&scenario, DriverKind::Inline)
            .robots
            .iter()
            .map(|robot| robot.steps)
            .collect::<Vec<u64>>()
    };
    assert!(steps(0.0).iter().all(|steps| *steps == 10_000 || *steps == 10_001));
    let shares: Vec<f64> = steps(DRIFT)
        .iter()
        .map(|steps| *steps as f64 / 10_000.5 - 1.0)
        .collect();
    let within = DRIFT + 1e-4;
    assert!(shares.iter().all(|share| share.abs() <= within), "{shares:?}");
    let mean = shares.iter().sum::<f64>() / 60.0;
    let spread = (shares.iter().map(|share| share * share).sum::<f64>() / 60.0).sqrt();
    assert!(mean.abs() < 4.0 * DRIFT / 180.0_f64.sqrt(), "{mean}");
    assert!((spread / (DRIFT / 3.0_f64.sqrt()) - 1.0).abs() < 0.25, "{spread}");
}

#[test]
fn drifting_robots_are_the_same_run_under_both_drivers() {
    for wake in ["ControlStep", "OnReception"] {
        let scenario = scenario(&format!(
            "time_limit: 30.0, swarm: (robots: 20, deploy: Uniform), protocol: Heartbeat, control: (clock_drift: 5000.0, wake: {wake}), \
             detector: Timeout(0.35), radio: (range: 3.0, loss: Bernoulli(0.5), latency: Constant(0.01))"
        ));
        let [actors, inline] = [DriverKind::Actors, DriverKind::Inline].map(|driver| run(&scenario, driver));
        assert!(
            inline.detection.suspicions.len() > 20,
            "{}",
            inline.detection.suspicions.len()
        );
        assert_eq!(actors, inline);
    }
}

/// A timeout of so many seconds is shorter or longer by the share by which the robot's clock is fast or slow: that is when robots are suspected that fell silent.
#[test]
fn timeouts_go_by_the_clock_of_who_waits() {
    const DRIFT: f64 = 0.05;
    let waits = |drift: f64| {
        let scenario = scenario(&format!(
            "time_limit: 60.0, swarm: (robots: 30, deploy: Uniform), protocol: Heartbeat, control: (clock_drift: {:?}), detector: Timeout(20.0), \
             radio: (range: 9.0), faults: [Crash(robots: [0], at: 20.0)]",
            drift * 1e6
        ));
        let record = run(&scenario, DriverKind::Inline);
        let waited = |suspicion: desim::metrics::detection::Suspicion| suspicion.at.since(suspicion.heard).as_secs();
        record.detection.suspicions.iter().map(waited).collect::<Vec<f64>>()
    };
    let right = waits(0.0);
    assert_eq!(right.len(), 29);
    assert!(right.iter().all(|waited| (waited - 20.0).abs() < 1e-6), "{right:?}");
    let drifting = waits(DRIFT);
    assert_eq!(drifting.len(), 29);
    let [least, most] = [f64::min, f64::max].map(|choose| drifting.iter().copied().reduce(choose).expect("29"));
    assert!(
        least > 20.0 / (1.0 + DRIFT) - 1e-6 && most < 20.0 / (1.0 - DRIFT) + 1e-6,
        "{least} {most}"
    );
    assert!(most - least > 20.0 * DRIFT, "{least} {most}");
}

/// Slots of 1.3 ms around frames of 1.184 ms: clocks that are apart by up to 2 · 50 parts in a million of 10 s, which is a millisecond, need a guard of that. Without one neighbours in the frame
/// of slots collide; with the one that `guard` has by itself, none do.
#[test]
fn slots_need_a_guard_against_drift() {
    let collided = |guard: &str, drift: &str, slot: &str| {
        let scenario = scenario(&format!(
            "time_limit: 60.0, swarm: (robots: 20, deploy: Uniform), protocol: Traffic(when: Saturated, payload: 20), control: (period: 0.5, clock_drift: {drift}), \
             radio: Shared(technology: Ieee802154(), access: Tdma(slot: {slot}{guard}), capture: inf)"
        ));
        let record = run(&scenario, DriverKind::Inline);
        let lost = record.ledger[0].lost;
        lost[LossCause::Collision as usize] + lost[LossCause::HalfDuplex as usize]
    };
    assert_eq!(collided(", guard: 0.0", "0.0", "0.0013"), 0);
    assert!(collided(", guard: 0.0", "50.0", "0.0013") > 1000);
    assert_eq!(collided("", "50.0", "0.0024"), 0);
}

#[test]
fn a_slot_that_leaves_no_room_beside_its_guard_is_refused_and_so_are_clocks_that_are_hardly_clocks() {
    let text = "Scenario(name: \"tight\", swarm: (robots: 5, deploy: Uniform), protocol: Traffic(), control: (clock_drift: 50.0), \
        radio: Shared(technology: Ieee802154(), access: Tdma(slot: 0.0015)))";
    let report = parse("tight.ron", text, &[]).expect_err("no room").to_string();
    assert!(report.contains("guard of 0.001 s"), "{report}");
    let text = "Scenario(name: \"wild\", swarm: (robots: 5, deploy: Uniform), protocol: Heartbeat, control: (clock_drift: 200000.0))";
    let report = parse("wild.ron", text, &[]).expect_err("out of range").to_string();
    assert!(report.contains("clock_drift") && report.contains("100000"), "{report}");
}
