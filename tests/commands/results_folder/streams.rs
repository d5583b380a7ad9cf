//! The exit status and the files of a command do not depend on who reads what it says; and what it says fits the terminal.

use std::fs;
use std::path::Path;
use std::process::Command;

use desim::text::columns;
use tempfile::{TempDir, tempdir};

const SCENARIO: &str = "// Who hears whom?\nScenario(name: \"small\", trials: 2, time_limit: 4.0, \
    swarm: (robots: 5, deploy: Uniform), protocol: Heartbeat, detector: Timeout(0.35), radio: (loss: Bernoulli(0.4)), arena: (size: (2.5, 2.5)))";

const STUDY: &str = "// Does patience pay?\nStudy(name: \"patience\", base: \"small.ron\", trials: 8, factors: [(name: \"timeout\", \
    paths: [\"detector\"], levels: [(label: \"short\", values: [Timeout(0.25)]), (label: \"long\", values: [Timeout(0.55)])])], \
    reference: [\"short\"], figure: \"detection.mistake_rate_hz\", also: [\"detection.query_accuracy\"])";

/// A folder with a scenario and a study, both run, and files that are wrong.
fn place() -> TempDir {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("small.ron"), SCENARIO).unwrap();
    fs::write(dir.path().join("study.ron"), STUDY).unwrap();
    fs::write(dir.path().join("bad.ron"), SCENARIO.replace("4.0", "-4.0")).unwrap();
    for arguments in ["scenario small.ron --quiet", "compare study.ron --quiet"] {
        assert_eq!(status(dir.path(), arguments, ""), 0);
    }
    dir
}

/// The exit status of desim with these arguments and redirections, as bash has them.
fn status(dir: &Path, arguments: &str, redirected: &str) -> i32 {
    let desim = env!("CARGO_BIN_EXE_desim");
    let script = format!("\"{desim}\" {arguments} {redirected}\nexit ${{PIPESTATUS[0]}}");
    let mut bash = Command::new("bash");
    bash.args(["-c", &script]).current_dir(dir);
    bash.output().unwrap().status.code().unwrap()
}

#[test]
fn the_exit_status_is_the_same_whoever_reads() {
    let dir = place();
    let commands = [
        ("--help", 0),
        ("", 2),
        ("scenario --nonsense", 2),
        ("schema", 0),
        ("check small.ron study.ron", 0),
        ("check small.ron bad.ron", 2),
        ("check --predict small.ron", 0),
        ("check --predict --format json bad.ron", 2),
        ("check --resolved small.ron", 0),
        ("scenario small.ron", 0),
        ("scenario small.ron --format json", 0),
        ("scenario small.ron --out fresh --force", 0),
        ("scenario bad.ron", 2),
        ("scenario small.ron --seed 3", 2),
        ("compare study.ron", 0),
        ("compare study.ron --out fresh-study --force", 0),
        ("compare bad.ron", 2),
        ("report results/small", 0),
        ("report results/patience", 0),
        ("report none", 2),
        ("explain results/small --trial 1 --robot 2", 0),
        ("explain results/small --trial 9 --robot 2", 2),
    ];
    let pipes = [
        ">&-",
        "2>&-",
        ">&- 2>&-",
        ">/dev/full",
        "2>/dev/full",
        ">/dev/full 2>&1",
        "| true",
        "2>&1 >/dev/null | true",
        "2>&1 | head -c 1 >/dev/null",
    ];
    for (arguments, expected) in commands {
        assert_eq!(status(dir.path(), arguments, ""), expected, "{arguments}");
        for pipe in pipes {
            let found = status(dir.path(), &format!("{arguments} "), pipe);
            assert_eq!(found, expected, "desim {arguments} {pipe}");
            let fresh = if arguments.contains("fresh-study") {
                "fresh-study/study.json"
            } else {
                "fresh/manifest.json"
            };
            if arguments.contains("fresh") {
                assert!(dir.path().join(fresh).exists(), "desim {arguments} {pipe}");
            }
        }
    }
}

#[test]
fn every_command_fits_the_terminal_and_uses_its_width() {
    let dir = place();
    let commands: [&[&str]; 15] = [
        &["--help"],
        &["scenario", "--help"],
        &["compare", "--help"],
        &["check", "--help"],
        &["report", "--help"],
        &["explain", "--help"],
        &["schema", "--help"],
        &["check", "small.ron", "study.ron"],
        &["check", "bad.ron"],
        &["check", "--predict", "small.ron"],
        &["scenario", "small.ron"],
        &["compare", "study.ron"],
        &["report", "results/small"],
        &["report", "results/patience"],
        &["explain", "results/small", "--trial", "1", "--robot", "2"],
    ];
    for arguments in commands {
        let widest = |width: usize| {
            let output = Command::new(env!("CARGO_BIN_EXE_desim"))
                .current_dir(dir.path())
                .args(arguments)
                .env("COLUMNS", width.to_string())
                .output()
                .unwrap();
            let said = [output.stdout, output.stderr]
                .map(|text| String::from_utf8(text).unwrap())
                .concat();
            // The file's own lines, and what stands under a place in them, are where they are.
            let is_source = |line: &&str| line.contains(" │ ") || line.trim_start().starts_with('·');
            let lines = said.lines().filter(|line| !is_source(line));
            let widest = lines.max_by_key(|line| columns(line)).unwrap_or_default().to_owned();
            assert!(
                columns(&widest) <= width,
                "{arguments:?} at {width}: {} columns in {widest:?}",
                columns(&widest)
            );
            columns(&widest)
        };
        let widths = [60, 80, 100, 120, 160];
        let found = widths.map(widest);
        // A line is broken at the last blank that fits: what is left over is less than a long word. Or there is no longer line.
        for (width, widest) in widths.into_iter().zip(found) {
            assert!(
                widest + 20 > width || widest == found[4],
                "{arguments:?} uses {widest} of {width} columns: {found:?}"
            );
        }
    }
}
