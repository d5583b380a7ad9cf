//! Studies that were harmed are never shown as if they were whole; studies that were killed leave nothing of it behind.

use std::fs;

use tempfile::{TempDir, tempdir};

use crate::harm::{Chance, assert_same, desim, flip, kill, timed, tree, tries};

const BASE: &str = "Scenario(name: \"base\", time_limit: 30.0, arena: (size: (4.0, 4.0)), control: (period: 0.5), \
    swarm: (robots: 12, deploy: Uniform), protocol: Heartbeat, gossip: (status: (interval: 0.5)), \
    detector: Timeout(1.2), radio: (loss: Bernoulli(0.2)))";

const STUDY: &str = "// Does loss hurt?\nStudy(name: \"losses\", base: \"base.ron\", trials: 8, factors: [(name: \"loss\", \
    paths: [\"radio.loss\"], levels: [(label: \"some\", values: [Bernoulli(0.2)]), (label: \"much\", values: [Bernoulli(0.4)])])], \
    reference: [\"some\"], figure: \"detection.mistake_rate_hz\", also: [\"detection.query_accuracy\"], \
    pareto: (\"detection.mistake_rate_hz\", \"detection.query_accuracy\"))";

const COMPARE: [&str; 4] = ["compare", "study.ron", "--jobs", "2"];

fn place() -> TempDir {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("base.ron"), BASE).unwrap();
    fs::write(dir.path().join("study.ron"), STUDY).unwrap();
    dir
}

#[test]
fn no_bit_that_flips_changes_what_is_shown_of_a_study() {
    let dir = place();
    timed(dir.path(), &COMPARE);
    timed(dir.path(), &["report", "results/losses"]);
    timed(dir.path(), &["report", "results/losses/some"]);
    let commands: [&[&str]; 3] = [
        &COMPARE,
        &["compare", "study.ron", "--format", "json"],
        &["report", "results/losses", "--out", "/dev/stdout"],
    ];
    flip(dir.path(), &dir.path().join("results"), &commands, tries(40));
}

#[test]
fn a_study_killed_at_any_instant_goes_on_to_the_same_bytes_and_leaves_nothing_behind() {
    let dir = place();
    let whole = timed(dir.path(), &COMPARE);
    let expected = tree(&dir.path().join("results"));
    let mut chance = Chance(3);
    let mut kills: usize = 0;
    while kills < tries(6) {
        fs::remove_dir_all(dir.path().join("results")).unwrap();
        kills += kill(dir.path(), &COMPARE, whole, &mut chance);
        assert_same(&expected, &tree(&dir.path().join("results")), &format!("{kills} kills"));
    }
    println!("{kills} studies killed");
}

/// A kill after the comparison has been written and before the settings have: the trials are still there.
#[test]
fn a_comparison_that_was_altered_before_the_study_was_finished_is_not_gone_on_from() {
    let dir = place();
    timed(dir.path(), &COMPARE);
    let results = dir.path().join("results/losses");
    let manifest = fs::read_to_string(results.join("study.json")).unwrap();
    let mut unfinished: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    unfinished.as_object_mut().unwrap().shift_remove("xxh3_128");
    unfinished["finished"] = false.into();
    fs::write(results.join("study.json"), desim::export::sealed(&unfinished)).unwrap();
    let comparison = fs::read_to_string(results.join("comparison.json")).unwrap();
    fs::write(
        results.join("comparison.json"),
        comparison.replacen("losses", "looses", 1),
    )
    .unwrap();
    let refused = desim(dir.path(), &COMPARE).output().unwrap();
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("comparison.json"), "{said}");
    fs::write(results.join("comparison.json"), comparison).unwrap();
    timed(dir.path(), &COMPARE);
    assert_eq!(fs::read_to_string(results.join("study.json")).unwrap(), manifest);
}

#[test]
fn what_a_killed_attempt_left_in_a_study_goes_when_it_is_shown() {
    let dir = place();
    timed(dir.path(), &COMPARE);
    let results = dir.path().join("results/losses");
    let before = tree(&results);
    fs::create_dir(results.join("much/.trials")).unwrap();
    fs::write(results.join("much/.trials/lock"), "").unwrap();
    fs::create_dir(results.join(".trials")).unwrap();
    fs::write(results.join(".trials/.half.writing"), "half").unwrap();
    timed(dir.path(), &COMPARE);
    assert_same(&before, &tree(&results), "after the study was shown");
    // And before it had said what it was.
    fs::remove_dir_all(&results).unwrap();
    fs::create_dir_all(results.join(".trials")).unwrap();
    fs::write(results.join(".trials/.half.writing"), "half").unwrap();
    timed(dir.path(), &COMPARE);
    assert_same(&before, &tree(&results), "after the study was begun again");
}

#[test]
fn a_setting_whose_results_were_made_by_others_is_named() {
    let dir = place();
    timed(dir.path(), &COMPARE);
    let setting = "results/losses/some";
    timed(
        dir.path(),
        &[
            "scenario", "base.ron", "--trials", "8", "--seed", "5", "--out", setting, "--force", "--quiet",
        ],
    );
    let refused = desim(dir.path(), &COMPARE).output().unwrap();
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(
        said.contains("some/manifest.json is of other results than the study compared"),
        "{said}"
    );
    timed(dir.path(), &[&COMPARE[..], &["--force", "--quiet"]].concat());
    timed(dir.path(), &COMPARE);
}
