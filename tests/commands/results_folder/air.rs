//! What is said of a radio on which frames take time: in the summary, on the terminal, on the page, in the tables.

use std::path::Path;

use desim::experiment::run_trial;
use desim::export::Results;
use desim::metrics::figures::Samples;
use desim::metrics::{Summary, TrialRecord};
use desim::report::{Input, PageInput, PageTrials, Speed, page, terminal};
use desim::scenario::{Scenario, parse};
use desim::simulation::DriverKind;
use desim::text::{Style, columns};
use tempfile::tempdir;
use tokio_util::sync::CancellationToken;

use super::fixture::{records_of, run};

/// Eight robots that say more to their next than the channel takes, in and out of each other's range.
fn busy() -> Scenario {
    let text = "Scenario(name: \"busy\", trials: 3, time_limit: 4.0, control: (period: 0.5), metrics: (links: true), \
        arena: (size: (80.0, 80.0)), swarm: (robots: 8, deploy: Uniform), faults: [Mute(robots: [2], at: 3.0)], \
        protocol: Traffic(to: Next, when: Poisson(60.0), payload: 40), \
        radio: Shared(technology: Ieee802154(), queue: 3, fading: Rayleigh()))";
    parse("busy.ron", text, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn records(scenario: &Scenario) -> Vec<TrialRecord> {
    let run = |trial| run_trial(scenario, trial, DriverKind::Inline, &CancellationToken::new());
    (0..scenario.trials)
        .map(|trial| run(trial).expect("the trial runs"))
        .collect()
}

fn summary(scenario: &Scenario, records: &[TrialRecord]) -> Summary {
    let (topics, roles) = (scenario.topics(), scenario.protocol.roles());
    Summary::by(&scenario.figures(), &scenario.name, topics, roles, records)
}

fn report(summary: &Summary, width: usize) -> String {
    terminal(&Input {
        question: None,
        summary,
        asked: None,
        control_period_s: 0.5,
        detects: false,
        surprises: &[],
        speed: Speed {
            simulated_s: 12.0,
            delivered: 1000,
            wall_s: 0.0,
        },
        folder: Path::new("results/busy"),
        files: &["radio.parquet"],
        style: Style { width, ..Style::PLAIN },
    })
}

/// From one heading to another.
fn sections<'a>(report: &'a str, from: &str, to: &str) -> &'a str {
    let begin = report.find(from).expect("the heading");
    let length = report[begin..].find(to).expect("the next heading");
    &report[begin..begin + length]
}

#[test]
fn the_terminal_says_how_full_the_channel_was_and_what_was_lost_to_what() {
    let scenario = busy();
    let summary = summary(&scenario, &records(&scenario));
    for width in [80, 120] {
        let report = report(&summary, width);
        assert!(report.lines().all(|line| columns(line) <= width), "{report}");
        let name = format!("the_air_of_a_busy_channel_at_{width}");
        insta::assert_snapshot!(name, sections(&report, "Radio\n", "\nConnectivity"));
    }
}

#[test]
fn all_causes_at_once_stay_lines_of_their_own_with_the_worst_first() {
    let scenario = busy();
    let mut summary = summary(&scenario, &records(&scenario));
    for (place, (_, frames)) in summary.frames.total.lost.0.iter_mut().enumerate() {
        *frames = 1_000_000 * (place as u64 + 1);
    }
    summary.frames.total.offered = 100_000_000;
    let report = report(&summary, 80);
    let (_, lost) = report.split_once("lost to").unwrap();
    let lines: Vec<&str> = lost.lines().take(12).map(str::trim).collect();
    assert_eq!(lines[0], "sender down: 12,000,000, 12.00 % of the copies offered");
    assert_eq!(lines[11], "channel: 1,000,000, 1.00 % of the copies offered");
    assert!(report.lines().all(|line| columns(line) <= 80), "{report}");
}

#[test]
fn every_figure_of_the_radio_stands_in_the_summary_at_the_place_that_its_key_says() {
    let scenario = busy();
    let records = records(&scenario);
    let registry = scenario.figures();
    let mut samples = Samples::new(registry.figures().count());
    for record in &records {
        samples.push(&registry.read(record));
    }
    let summary = serde_json::to_value(summary(&scenario, &records)).unwrap();
    let readme = include_str!("../../../results/README.md");
    let mut found = 0;
    for estimated in registry.estimate(&samples) {
        let key = &estimated.figure.key;
        if !key.starts_with("radio.") && key != "goodput_bps" {
            continue;
        }
        let place = key.split('.').try_fold(&summary, |place, part| place.get(part));
        let place = place.unwrap_or_else(|| panic!("{key} has no place"));
        let stated = serde_json::to_value(estimated.estimate).unwrap();
        for part in ["value", "ci95", "n"] {
            assert_eq!(place[part], stated[part], "{key}: {part}");
        }
        let name = key.trim_start_matches("radio.");
        assert!(readme.contains(&format!("`{name}`")), "{key} is not documented");
        found += 1;
    }
    assert_eq!(found, 12);
}

#[test]
fn the_page_has_charts_of_delivery_by_distance_and_of_causes() {
    let scenario = busy();
    let records = records(&scenario);
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    let page = page(&PageInput {
        question: None,
        scenario: &scenario,
        topics: &names(scenario.topics()),
        roles: &names(scenario.protocol.roles()),
        trials: &PageTrials::of(&scenario, records.iter().cloned()),
        summary: &summary(&scenario, &records),
        made_by: "desim 9.9",
        watch: None,
    });
    for words in [
        "<h2>Air</h2>",
        "Delivery by distance</h3>",
        "What copies were lost to</h3>",
        "distance of the sender, m",
        "power at the receiver, dBm",
        "air: channel",
        "download=\"busy-by-distance.csv\"",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let lost = page.split("<figure id=\"lost-to\"").nth(1).unwrap();
    let table = lost.split("</figure>").next().unwrap();
    let rows = table.matches("<tr>").count();
    let causes = records
        .iter()
        .flat_map(|record| &record.ledger)
        .fold([0; 12], |sum: [u64; 12], fates| {
            std::array::from_fn(|cause| sum[cause] + fates.lost[cause])
        });
    let occurred = causes.iter().filter(|lost| **lost > 0).count();
    assert_eq!(rows, 1 + occurred, "a row for the head and each cause that took a copy");
    assert!(occurred > 3);
}

#[test]
fn the_tables_hold_what_the_trials_told() {
    let dir = tempdir().unwrap();
    let scenario = busy();
    let all = records(&scenario);
    run(dir.path(), &scenario, 1, &CancellationToken::new(), |trial| {
        Ok(all[trial as usize].clone())
    })
    .unwrap();
    for table in ["radio", "waits", "distance", "links"] {
        assert!(dir.path().join(format!("{table}.parquet")).exists(), "{table}");
    }
    let results = Results::open(dir.path()).unwrap();
    let read = records_of(&results);
    for (read, written) in read.iter().zip(&all) {
        assert_eq!(read.air, written.air);
        assert!(read.air.as_ref().is_some_and(|air| air.links.len() == 8));
    }
    assert_eq!(
        summary(&scenario, &read),
        results.summary,
        "the figures follow from the tables"
    );
}

#[test]
fn over_a_disk_and_where_nobody_asks_there_are_no_such_tables() {
    let dir = tempdir().unwrap();
    let mut asked = busy();
    asked.metrics.links = false;
    asked.trials = 1;
    let all = records(&asked);
    run(dir.path(), &asked, 1, &CancellationToken::new(), |trial| {
        Ok(all[trial as usize].clone())
    })
    .unwrap();
    assert!(dir.path().join("radio.parquet").exists() && !dir.path().join("links.parquet").exists());
}
