//! The command itself, on broken scenario files: it ends by itself with exit status 0 or 2, and says where the fault is.

use std::time::Duration;

use assert_cmd::Command;
use desim::scenario::parse;

use super::mutations;

/// Makes a valid mutant quick to run, and still longer than targets must be held.
const SHORT: &str = "time_limit=12.0";
const MUTANTS: u32 = 300;
const PATIENCE: Duration = Duration::from_secs(60);
/// Mutants with more robots or motion ticks than this are checked but not run: they are valid, and only long.
const MOST_ROBOT_TICKS: f64 = 50_000.0;

fn desim(arguments: &[&str], file: &std::path::Path) -> std::process::Output {
    let mut command = Command::cargo_bin("desim").expect("the command is built with the tests");
    let output = command.args(arguments).arg(file).timeout(PATIENCE).output();
    output.expect("the command starts and ends")
}

#[test]
fn each_of_300_broken_scenario_files_ends_in_exit_status_0_or_2_with_line_and_field_and_never_in_a_panic() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("mutant.ron");
    for mutant in mutations::mutants(MUTANTS) {
        std::fs::write(&file, &mutant.text).expect("the folder can be written to");
        let output = desim(&["check"], &file);
        let said = [output.stdout, output.stderr].concat();
        let said = String::from_utf8_lossy(&said);
        let is_valid = parse("mutant.ron", &mutant.text, &[]).is_ok();
        assert_eq!(
            output.status.code(),
            Some(if is_valid { 0 } else { 2 }),
            "{}: {said}",
            mutant.label
        );
        assert!(!said.contains("panicked"), "{}: {said}", mutant.label);
        assert!(
            is_valid || said.contains("mutant.ron:"),
            "{}: no line is named: {said}",
            mutant.label
        );
    }
}

#[test]
fn a_broken_scenario_file_that_is_still_valid_runs_to_exit_status_0_or_2_and_an_invalid_one_leaves_nothing_behind() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("mutant.ron");
    let out = folder.path().join("results");
    let arguments = [
        "scenario",
        "--trials",
        "1",
        "--force",
        "--quiet",
        "--set",
        SHORT,
        "--out",
        out.to_str().expect("a plain path"),
    ];
    let short = [SHORT.parse().expect("a valid override")];
    let (mut ran, mut refused) = (0, 0);
    for mutant in mutations::mutants(MUTANTS) {
        let scenario = parse("mutant.ron", &mutant.text, &short).ok();
        let is_long = scenario.as_ref().is_some_and(|scenario| {
            let ticks = scenario.time_limit.get() / scenario.motion.tick.get().min(scenario.control.period.get());
            f64::from(scenario.swarm.robots) * ticks > MOST_ROBOT_TICKS
        });
        if is_long {
            continue;
        }
        *if scenario.is_some() { &mut ran } else { &mut refused } += 1;
        std::fs::write(&file, &mutant.text).expect("the folder can be written to");
        let output = desim(&arguments, &file);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(matches!(output.status.code(), Some(0 | 2)), "{}: {said}", mutant.label);
        // Not `scenario`: an invalid number of trials is mended by `--trials`.
        let refused = output.status.code() == Some(2);
        assert!(!refused || !out.exists(), "{} left something behind", mutant.label);
        let _ = std::fs::remove_dir_all(&out);
    }
    assert!(
        ran > 0 && refused > 0,
        "{ran} ran and {refused} were refused, so nothing is shown"
    );
}
