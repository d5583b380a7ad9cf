//! The report on the terminal, as people see it.

use std::path::Path;

use desim::metrics::{Outcome, Summary, TrialRecord};
use desim::report::{Input, Speed, terminal};

use crate::fixture::record;

const TOPICS: [&str; 4] = ["status", "request", "parent strand", "child strand"];
const ROLES: [&str; 4] = ["free", "root", "networker", "worker"];

fn report(records: &[TrialRecord], colour: bool) -> String {
    terminal(&Input {
        question: Some(
            "Does the backbone still reach its targets when one frame in five is lost on its way to a robot?",
        ),
        summary: &Summary::of("loss20", &TOPICS, &ROLES, records),
        control_period_s: 0.1,
        surprises: &[],
        speed: Speed {
            simulated_s: 2100.0,
            delivered: 1_250_000,
            wall_s: 17.5,
        },
        folder: Path::new("results/loss20"),
        files: &["bandwidth.parquet", "final_0.svg", "summary.json", "trials.parquet"],
        colour,
    })
}

fn records(trials: u32) -> Vec<TrialRecord> {
    (0..trials).map(record).collect()
}

#[test]
fn the_report_of_many_trials() {
    insta::assert_snapshot!(report(&records(35), false));
}

#[test]
fn the_report_of_one_trial() {
    insta::assert_snapshot!(report(&records(1), false));
}

#[test]
fn the_report_without_a_mission_speaks_of_none() {
    let still = records(3).into_iter().map(|record| TrialRecord {
        outcome: Outcome::NoMission,
        connectivity: Vec::new(),
        ..record
    });
    insta::assert_snapshot!(report(&still.collect::<Vec<_>>(), false));
}

#[test]
fn no_line_is_wider_than_80_columns() {
    for trials in [1, 35, 2000] {
        let report = report(&records(trials), false);
        let widest = report.lines().map(|line| line.chars().count()).max();
        assert!(widest <= Some(80), "{report}");
    }
}

#[test]
fn only_a_terminal_gets_colours() {
    assert!(!report(&records(2), false).contains('\u{1b}'));
    assert!(report(&records(2), true).contains('\u{1b}'));
}
