//! What `check --predict` says of the shared radio, held against runs.

use desim::metrics::Summary;
use desim::predict::{Preflight, surprises};
use desim::scenario::Scenario;

use super::{EQUAL_LOSS, EVERYBODY, runs, scenario, with_robots};

fn summary(scenario: &Scenario, trials: u32) -> Summary {
    let records = runs(scenario, trials);
    Summary::by(
        &scenario.figures(),
        &scenario.name,
        scenario.topics(),
        scenario.protocol.roles(),
        &records,
    )
}

fn cell(robots: u32, traffic: &str, radio: &str) -> Scenario {
    let radio = format!("technology: Ieee802154(), capture: inf, {radio}, {EQUAL_LOSS}");
    with_robots(scenario(40.0, traffic, EVERYBODY, &radio), robots)
}

#[test]
fn airtime_overlaps_and_energy_are_as_predicted() {
    for (robots, traffic, radio) in [
        (20, "when: Poisson(8.0), payload: 20", "access: Aloha()"),
        (50, "when: Poisson(4.0), payload: 5", "access: Aloha()"),
        (5, "when: Periodic(0.1), payload: 60", "access: Aloha()"),
        (5, "when: Poisson(10.0), payload: 20", "access: CsmaCa()"),
        (20, "when: Poisson(10.0), payload: 20", "access: CsmaCa()"),
        (
            12,
            "when: Poisson(10.0), payload: 20, senders: Given([0, 1, 2])",
            "access: CsmaCa()",
        ),
        (
            10,
            "when: Poisson(5.0), payload: 20",
            "access: Tdma(slot: 0.002, guard: 0.0)",
        ),
    ] {
        let scenario = cell(robots, traffic, radio);
        let preflight = Preflight::of(&scenario);
        for name in [
            "airtime_s",
            "capacity_robots",
            "radio.airtime_share",
            "overlap_ratio",
            "radio.energy_J",
        ] {
            assert!(
                preflight.get(name).is_some(),
                "{robots} {traffic} {radio}: {name}\n{preflight:#?}"
            );
        }
        // Robots that send periodically meet in every period or never: trials differ much.
        let trials = if traffic.contains("Periodic") { 100 } else { 8 };
        let summary = summary(&scenario, trials);
        assert_eq!(surprises(&scenario, &summary), [], "{robots} {traffic} {radio}");
    }
}

/// What is predicted of another rate than the one that ran disagrees in all that follows from it.
#[test]
fn a_run_at_another_rate_is_a_surprise() {
    let said = cell(20, "when: Poisson(8.0), payload: 20", "access: Aloha()");
    let ran = cell(20, "when: Poisson(9.0), payload: 20", "access: Aloha()");
    let surprises = surprises(&said, &summary(&ran, 8));
    let names: Vec<_> = surprises.iter().map(|surprise| surprise.predicted.name).collect();
    assert_eq!(names, ["radio.airtime_share", "overlap_ratio", "radio.energy_J"]);
}

#[test]
fn where_no_form_holds_the_reason_is_said() {
    let refused = |scenario: &Scenario, name: &str| {
        let preflight = Preflight::of(scenario);
        assert_eq!(preflight.get(name), None);
        let why = preflight.not_predicted.iter().find(|refused| refused.name == name);
        why.unwrap_or_else(|| panic!("{name} is refused: {preflight:#?}"))
            .why
            .clone()
    };
    let full = cell(50, "when: Poisson(20.0), payload: 100", "access: CsmaCa()");
    assert!(refused(&full, "overlap_ratio").contains("no closed form"));
    assert!(refused(&full, "radio.energy_J").contains("frames wait"));
    assert!(refused(&full, "radio.airtime_share").contains("more to send"));
    // 802.15.4 listens with 10 dB less than it receives with: in range, and not heard by those who listen first.
    let deaf = with_robots(
        scenario(
            1.0,
            "when: Poisson(2.0), payload: 20",
            "arena: (size: (9.0, 9.0)), swarm: (robots: 5, deploy: Cluster(radius: 1.0)),",
            "technology: Ieee802154(), transmit_power: -45.0",
        ),
        5,
    );
    assert!(refused(&deaf, "overlap_ratio").contains("hidden"));
    let lora = with_robots(
        scenario(1.0, "when: Poisson(2.0), payload: 20", EVERYBODY, "technology: LoRa()"),
        5,
    );
    assert!(refused(&lora, "radio.airtime_share").contains("medium access"));
    let saturated = cell(5, "when: Saturated, payload: 100", "access: CsmaCa()");
    assert!(refused(&saturated, "radio.airtime_share").contains("steady stream"));
    let wide = with_robots(
        scenario(
            1.0,
            "when: Poisson(2.0), payload: 20",
            "arena: (size: (9000.0, 9000.0)), swarm: (robots: 20, deploy: Uniform),",
            "technology: Ieee802154()",
        ),
        20,
    );
    assert!(refused(&wide, "overlap_ratio").contains("hear each other"));
}

/// Radios that draw so many watts empty their batteries when they have drawn what these hold: all within a few frames of each other.
#[test]
fn the_life_of_a_battery_is_as_predicted() {
    let scenario = cell(10, "when: Poisson(10.0), payload: 20", "access: CsmaCa(), battery: 1.0");
    let expected = Preflight::of(&scenario);
    let lifetime = expected.get("lifetime_s").expect("a form holds");
    for record in runs(&scenario, 3) {
        let air = record.air.as_ref().expect("a shared radio");
        let first = air
            .robots
            .iter()
            .filter_map(|robot| robot.empty_at)
            .min()
            .expect("empty before the end");
        let off = first.as_secs() - lifetime.value;
        assert!(
            off.abs() < lifetime.accuracy + 0.01 * lifetime.value,
            "{first}, {lifetime:?}"
        );
    }
}
