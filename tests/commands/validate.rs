//! `desim validate`: which rows it takes, what it prints, and what its exit status says.

use std::fs;
use std::process::Output;

use desim::scenario::parse;
use desim::validate::catalogue;
use serde_json::Value;
use tempfile::tempdir;

use crate::studies::command::{desim, text};

/// A quick row.
const QUICK: &str = "airtime.802154.20-bytes";

fn validate(arguments: &[&str]) -> Output {
    let dir = tempdir().unwrap();
    let arguments = [&["validate"], arguments].concat();
    let output = desim(dir.path(), &arguments).output().unwrap();
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0, "it writes no file");
    output
}

#[test]
fn every_printed_scenario_is_checked_and_has_the_seed_asked_for() {
    let output = validate(&["--scenarios", "--seed", "7"]);
    assert!(output.status.success());
    let printed = text(&output.stdout);
    let files: Vec<&str> = printed.split("\n\n").collect();
    let rows = catalogue();
    assert!(rows.len() >= 40);
    assert_eq!(files.len(), rows.len());
    for (file, row) in files.iter().zip(rows) {
        assert!(file.starts_with(&format!("// {}: ", row.name)), "{file}");
        let scenario = parse(&row.name, file, &[]).unwrap_or_else(|report| panic!("{file}\n{report}"));
        assert_eq!((scenario.seed, scenario.trials), (7, row.trials), "{}", row.name);
    }
}

#[test]
fn a_scenario_that_is_printed_alone_is_a_file_that_runs() {
    let dir = tempdir().unwrap();
    let printed = validate(&["--only", QUICK, "--scenarios"]).stdout;
    fs::write(dir.path().join("row.ron"), printed).unwrap();
    desim(dir.path(), &["check", "row.ron"]).assert().success();
    desim(dir.path(), &["scenario", "row.ron", "--quiet"])
        .assert()
        .success();
}

#[test]
fn rows_are_chosen_by_name_or_model_and_the_document_says_all_of_them() {
    let output = validate(&["--only", "airtime.802154", "--only", "walls", "--format", "json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["version"], env!("CARGO_PKG_VERSION"));
    assert!(document["seed"].is_u64() && document["level"] == 0.99);
    let rows = document["rows"].as_array().unwrap();
    let names: Vec<&str> = rows.iter().map(|row| row["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["walls.two", QUICK, "airtime.802154.100-bytes"]);
    for row in rows {
        for key in ["model", "form", "unit", "scenario"] {
            assert!(row[key].is_string(), "{key} of {row}");
        }
        for key in ["expected", "measured", "margin", "trials"] {
            assert!(row[key].is_number(), "{key} of {row}");
        }
        let [low, high] = [0, 1].map(|end| row["interval"][end].as_f64().unwrap());
        let measured = row["measured"].as_f64().unwrap();
        assert!(low <= measured && measured <= high, "{row}");
        assert_eq!(row["verdict"], "agrees", "{row}");
    }
}

#[test]
fn the_table_fits_its_width_and_ends_in_a_sentence_that_no_number_of_jobs_changes() {
    let of = |jobs: &str| {
        text(
            &validate(&[
                "--only",
                "airtime",
                "--only",
                "aloha.pure.10",
                "--quiet",
                "--jobs",
                jobs,
            ])
            .stdout,
        )
    };
    let table = of("1");
    assert_eq!(table, of("2"));
    assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    assert!(table.contains("11 of 11 agree."), "{table}");
}

#[test]
fn what_no_row_has_is_refused_with_the_models() {
    let output = validate(&["--only", "telepathy"]);
    assert_eq!(output.status.code(), Some(2));
    let said = text(&output.stderr);
    assert!(said.contains("no row has `telepathy`"), "{said}");
    assert!(said.contains("path loss, walls, shadowing, fading"), "{said}");
    assert!(output.stdout.is_empty());
}
