//! The root is lost, and another robot takes its place.

use std::path::Path;

use desim::experiment::run_trial;
use desim::metrics::{Amount, Outcome, TrialRecord};
use desim::scenario::{Override, load};
use desim::simulation::DriverKind;

/// A trial of the shipped scenario.
fn trial(number: u32, overrides: &[&str]) -> TrialRecord {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/faults/root_crash.ron");
    let overrides: Vec<Override> = overrides
        .iter()
        .map(|text| text.parse().expect("an override"))
        .collect();
    let scenario = load(&path, &overrides).expect("a shipped scenario");
    run_trial(&scenario, number, DriverKind::Inline, &Default::default()).expect("the trial reaches its end")
}

/// The times without a root: their number, the longest.
fn without_root(record: &TrialRecord) -> (u64, f64) {
    let values = record.noted.iter().find_map(|noted| match &noted.amount {
        Amount::Values(values) if noted.name == "without_root_s" => Some(values),
        _ => None,
    });
    values.map_or((0, 0.0), |values| {
        (values.buckets().map(|(_, count)| count).sum(), values.quantile(1.0))
    })
}

/// The detector's timeout, and what the issue grants beyond it, seconds.
const GRANTED_S: f64 = 4.0 + 10.0;

#[test]
fn in_all_trials_a_crashed_root_has_a_successor_within_the_timeout_and_ten_seconds_and_the_mission_completes() {
    for number in 0..super::trials(3) {
        let record = trial(number, &[]);
        let (times, longest) = without_root(&record);
        assert_eq!(times, 1, "trial {number}");
        assert!(longest <= GRANTED_S, "trial {number}: {longest} s without a root");
        assert!(
            matches!(record.outcome, Outcome::Completed { .. }),
            "trial {number} does not complete"
        );
    }
}

#[test]
fn a_root_that_is_there_is_never_voted_out_though_half_of_the_frames_are_lost() {
    let record = trial(0, &["faults=[]", "radio.loss=Bernoulli(0.5)", "time_limit=150.0"]);
    assert_eq!(without_root(&record), (0, 0.0));
    let roots = record.robots.iter().filter(|robot| robot.role == 1).count();
    assert_eq!(roots, 1);
}

#[test]
fn a_root_that_comes_back_stands_down_and_one_that_was_elected_can_be_lost_too() {
    let faults = "faults=[Robots(effect: Crash, roles: [\"root\"], when: At(60.0), lasts: For(30.0)), Robots(effect: Crash, roles: [\"root\"], when: At(120.0))]";
    let record = trial(1, &[faults, "time_limit=200.0"]);
    assert_eq!(without_root(&record).0, 2);
    // The second crash takes whoever calls itself root: with the first one, had it not stood down, there would be three that do at the end.
    let roots = record.robots.iter().filter(|robot| robot.role == 1).count();
    assert_eq!(roots, 2, "the dead one and its successor");
}
