//! The tables that a scenario asks for: there where it does, gone where it does not, and read back as they were.

use std::fs;

use desim::experiment::run_trial;
use desim::export::Results;
use desim::metrics::TrialRecord;
use desim::scenario::{Scenario, parse};
use desim::simulation::DriverKind;
use tempfile::tempdir;
use tokio_util::sync::CancellationToken;

use super::fixture::{records_of, run};

const TABLES: [&str; 6] = ["Delivery", "Delays", "Degree", "Hops", "Traffic", "Roles"];

/// Rumours among robots of which one fails, so that every table has something to tell.
fn scenario(asked: &str) -> Scenario {
    let text = format!(
        "Scenario(name: \"asked\", trials: 2, time_limit: 6.0, swarm: (robots: 8, deploy: Cluster(radius: 0.9)), \
         protocol: Rumor(mode: PushPull, sources: Random(2), completion: Held(1.0)), gossip: (relay: (interval: 0.5)), \
         radio: (loss: Bernoulli(0.2), latency: Constant(0.02)), faults: [Mute(robots: [3], at: 2.0)], metrics: ({asked}))"
    );
    parse("asked.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn records(scenario: &Scenario) -> Vec<TrialRecord> {
    let run = |trial| run_trial(scenario, trial, DriverKind::Inline, &CancellationToken::new());
    (0..scenario.trials)
        .map(|trial| run(trial).expect("the trial runs"))
        .collect()
}

/// The tables of a folder of results, and the results.
fn written(scenario: &Scenario, records: &[TrialRecord]) -> (Vec<(String, Vec<u8>)>, Results) {
    let dir = tempdir().unwrap();
    run(dir.path(), scenario, 1, &CancellationToken::new(), |trial| {
        Ok(records[trial as usize].clone())
    })
    .unwrap();
    let files = fs::read_dir(dir.path()).unwrap().map(|file| file.unwrap().path());
    let tables = files.filter(|file| file.extension().is_some_and(|extension| extension == "parquet"));
    let name = |file: &std::path::Path| file.file_name().unwrap().to_str().unwrap().to_owned();
    let mut tables: Vec<_> = tables.map(|file| (name(&file), fs::read(&file).unwrap())).collect();
    tables.sort();
    (tables, Results::open(dir.path()).unwrap())
}

#[test]
fn each_table_is_there_where_it_is_asked_for_and_all_else_stays_as_it_is() {
    let plain = scenario("");
    let (without, _) = written(&plain, &records(&plain));
    for table in TABLES {
        let asks = scenario(&format!("record: [{table}]"));
        let records = records(&asks);
        let (mut tables, results) = written(&asks, &records);
        let place = tables
            .iter()
            .position(|(name, _)| *name == format!("{}.parquet", table.to_lowercase()))
            .unwrap_or_else(|| panic!("{table} is not there"));
        tables.remove(place);
        assert!(tables == without, "{table} changes other tables");
        for (read, record) in records_of(&results).iter().zip(&records) {
            assert!(!record.asked.is_empty());
            assert_eq!(read.asked, record.asked);
        }
    }
}

#[test]
fn all_tables_together_are_those_of_each_alone() {
    let all = scenario(&format!("record: [{}]", TABLES.join(", ")));
    let together = records(&all);
    let (_, results) = written(&all, &together);
    for (read, record) in records_of(&results).iter().zip(&together) {
        assert_eq!(read.asked, record.asked);
    }
    let alone = |table: usize| {
        records(&scenario(&format!("record: [{}]", TABLES[table])))
            .remove(0)
            .asked
    };
    let first = &together[0].asked;
    assert_eq!(alone(0).delivery, first.delivery);
    assert_eq!(alone(1).delays, first.delays);
    assert_eq!(alone(2).degree, first.degree);
    assert_eq!(alone(3).hops, first.hops);
    assert_eq!(alone(4).traffic, first.traffic);
    assert_eq!(alone(5).roles, first.roles);
}

#[test]
fn a_table_that_nobody_knows_is_refused_with_the_nearest_name() {
    let text = "Scenario(name: \"a\", swarm: (robots: 2, deploy: Uniform), protocol: Heartbeat, time_limit: 9.0, metrics: (record: [Delay]))";
    let report = parse("a.ron", text, &[]).unwrap_err().to_string();
    assert!(report.contains("Delays") && report.contains("record"), "{report}");
}
