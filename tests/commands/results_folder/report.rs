//! The report on the terminal, as people see it.

use std::path::Path;

use desim::metrics::{Estimate, Outcome, Summary, TrialRecord};
use desim::motion::Reach;
use desim::predict::{Holds, Prediction, Surprise};
use desim::report::{Asked, Input, Speed, terminal};
use desim::spool::Spool;
use desim::text::{Style, columns};

use super::fixture::record;

const TOPICS: [&str; 4] = ["status", "request", "parent strand", "child strand"];
const COLOURED: Style = Style {
    colour: true,
    ..Style::PLAIN
};
const ROLES: [&str; 4] = ["free", "root", "networker", "worker"];

fn report(records: &[TrialRecord], style: Style) -> String {
    report_with(records, &[], style)
}

fn report_with(records: &[TrialRecord], surprises: &[Surprise], style: Style) -> String {
    terminal(&Input {
        question: Some(
            "Does the backbone still reach its targets when one frame in five is lost on its way to a robot?",
        ),
        summary: &Summary::of("loss20", &TOPICS, &ROLES, records),
        asked: Some(&Asked {
            links: vec![2, 2],
            reach: vec![Reach::Open; 2],
            robots: 9,
        }),
        control_period_s: 0.1,
        detects: true,
        surprises,
        speed: Speed {
            simulated_s: 2100.0,
            delivered: 1_250_000,
            wall_s: 17.5,
        },
        folder: Path::new("results/loss20"),
        files: &["bandwidth.parquet", "final_0.svg", "summary.json", "trials.parquet"],
        style,
    })
}

fn records(trials: u32) -> Vec<TrialRecord> {
    (0..trials).map(record).collect()
}

#[test]
fn the_report_of_many_trials() {
    insta::assert_snapshot!(report(&records(35), Style::PLAIN));
}

#[test]
fn the_report_of_one_trial() {
    insta::assert_snapshot!(report(&records(1), Style::PLAIN));
}

#[test]
fn the_report_without_a_mission_speaks_of_none() {
    let still = records(3).into_iter().map(|record| TrialRecord {
        outcome: Outcome::NoMission,
        connectivity: Spool::default(),
        ..record
    });
    insta::assert_snapshot!(report(&still.collect::<Vec<_>>(), Style::PLAIN));
}

#[test]
fn what_is_not_as_predicted_has_a_section_of_its_own() {
    let surprise = |name, what, unit, value: f64| Surprise {
        predicted: Prediction {
            name,
            what,
            value,
            unit,
            accuracy: 0.0,
            holds: Holds::Throughout,
            formula: "p",
            assumes: "the channel alone".into(),
        },
        measured: Estimate {
            value: Some(1.25 * value),
            ci95: [Some(1.24 * value), Some(1.26 * value)],
            n: 35,
        },
        why: "copies were lost beside the channel (link fault 5.00 %)".into(),
    };
    let surprises = [
        surprise("loss_ratio", "copies lost", "1", 0.2),
        surprise("status_rx_bytes_per_step", "status bytes received", "B/step", 280.0),
        surprise("mistake_duration_s", "duration of a mistake", "s", 0.75),
    ];
    let report = report_with(&records(3), &surprises, Style::PLAIN);
    let section = report
        .split("\nNot as predicted")
        .nth(1)
        .and_then(|rest| rest.split("\nRun\n").next());
    insta::assert_snapshot!(section.unwrap());
    assert!(report.lines().all(|line| line.chars().count() <= 80), "{report}");
}

#[test]
fn a_report_of_robots_without_a_failure_detector_says_so_instead_of_figures() {
    let summary = Summary::of("bare", &TOPICS, &ROLES, &records(2));
    let text = terminal(&Input {
        question: None,
        summary: &summary,
        asked: None,
        control_period_s: 0.1,
        detects: false,
        surprises: &[],
        speed: Speed {
            simulated_s: 1.0,
            delivered: 1,
            wall_s: 1.0,
        },
        folder: Path::new("results/bare"),
        files: &[],
        style: Style::PLAIN,
    });
    assert!(
        text.contains("none: robots ran no failure detector") && !text.contains("suspicions"),
        "{text}"
    );
}

#[test]
fn every_width_is_kept_and_used() {
    for trials in [1, 35, 2000] {
        for width in [60, 80, 100, 120, 160] {
            let report = |width| report(&records(trials), Style { width, ..Style::PLAIN });
            let widest = report(width).lines().map(columns).max().unwrap_or(0);
            // A line is broken at the last blank that fits: what is left over is less than a long word. Or nothing is broken.
            let is_used = widest + 20 > width || report(width) == report(1000);
            assert!(
                widest <= width && is_used,
                "{widest} of {width} columns:\n{}",
                report(width)
            );
        }
    }
}

#[test]
fn a_terminal_that_is_narrow_breaks_words_and_no_figures() {
    let report = report(
        &records(35),
        Style {
            width: 30,
            ..Style::PLAIN
        },
    );
    let too_wide: Vec<&str> = report.lines().filter(|line| columns(line) > 30).collect();
    // A digest and a heading's longest word are as wide as they are.
    assert!(
        too_wide.iter().all(|line| line.split_whitespace().count() == 1),
        "{too_wide:?}"
    );
    insta::assert_snapshot!(report);
}

#[test]
fn only_a_terminal_gets_colours() {
    assert!(!report(&records(2), Style::PLAIN).contains('\u{1b}'));
    assert!(report(&records(2), COLOURED).contains('\u{1b}'));
}
