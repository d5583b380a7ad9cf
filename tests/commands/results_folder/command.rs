//! The binary, run as its users run it.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command as Process, Stdio};
use std::time::Duration;

use assert_cmd::Command;
use tempfile::{TempDir, tempdir};

const SMALL: &str = "// Who hears whom?\nScenario(name: \"small\", trials: 3, time_limit: 2.0, \
    arena: (size: (3.0, 3.0)), swarm: (robots: 5, deploy: Uniform), protocol: Heartbeat, detector: Timeout(1.0))";

/// An empty folder with the scenario `small.ron`.
fn place() -> TempDir {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("small.ron"), SMALL).unwrap();
    dir
}

fn desim(dir: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("desim").unwrap();
    command.current_dir(dir).args(arguments);
    command
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_owned()).unwrap()
}

#[test]
fn a_run_reports_and_says_where_its_results_are() {
    let dir = place();
    let out = desim(dir.path(), &["scenario", "small.ron"])
        .assert()
        .success()
        .get_output()
        .clone();
    let report = text(&out.stdout);
    assert!(
        report.contains("Who hears whom?") && report.contains("results/small"),
        "{report}"
    );
    assert_eq!(text(&out.stderr), "", "no progress where there is no terminal");
    assert!(dir.path().join("results/small/trials.parquet").exists());
}

/// Tables of any swarm, a map and pictures of one in which something could be made out.
#[test]
fn a_swarm_that_is_too_large_to_be_drawn_has_its_tables_and_no_pictures() {
    let dir = tempdir().unwrap();
    for robots in [20_000, 20_001] {
        let name = format!("swarm_{robots}");
        let scenario = format!(
            "Scenario(name: \"{name}\", time_limit: 0.1, arena: (size: (200.0, 200.0)), swarm: (robots: {robots}, deploy: Uniform),
             radio: (range: 1.0), protocol: Heartbeat, metrics: (sample_interval: 0.0))"
        );
        fs::write(dir.path().join("large.ron"), scenario).unwrap();
        desim(dir.path(), &["scenario", "large.ron", "--quiet"])
            .assert()
            .success();
        let folder = format!("results/{name}");
        desim(dir.path(), &["report", &folder]).assert().success();
        let is_drawn = robots == 20_000;
        for (file, is_there) in [
            ("robots.parquet", true),
            ("final_0.svg", is_drawn),
            ("trajectories_0.svg", is_drawn),
        ] {
            assert_eq!(
                dir.path().join(&folder).join(file).exists(),
                is_there,
                "{file} of {robots}"
            );
        }
        let page = fs::read_to_string(dir.path().join(&folder).join("report.html")).unwrap();
        assert_eq!(page.contains("The swarm with its traffic"), is_drawn, "{robots}");
    }
}

#[test]
fn json_is_one_document_and_the_summary_on_disk() {
    let dir = place();
    for _ in ["run", "finished already"] {
        let out = desim(dir.path(), &["scenario", "small.ron", "--format", "json"])
            .assert()
            .success();
        assert_eq!(
            out.get_output().stdout,
            fs::read(dir.path().join("results/small/summary.json")).unwrap()
        );
    }
}

#[test]
fn drivers_and_jobs_give_the_same_bytes() {
    let dir = place();
    let variants = [("a", "actors", "1"), ("b", "inline", "3")];
    let tables = variants.map(|(out, driver, jobs)| {
        desim(
            dir.path(),
            &[
                "scenario",
                "small.ron",
                "--quiet",
                "--out",
                out,
                "--driver",
                driver,
                "--jobs",
                jobs,
            ],
        )
        .assert()
        .success()
        .stdout("");
        [
            "trials",
            "bandwidth",
            "latency",
            "connectivity",
            "robots",
            "trajectories",
            "frames",
        ]
        .map(|table| fs::read(dir.path().join(out).join(format!("{table}.parquet"))).unwrap())
    });
    assert!(tables[0] == tables[1]);
}

#[test]
fn finished_results_are_shown_again_without_a_run() {
    let dir = place();
    let first = desim(dir.path(), &["scenario", "small.ron"])
        .assert()
        .success()
        .get_output()
        .clone();
    let manifest = fs::read(dir.path().join("results/small/manifest.json")).unwrap();
    let second = desim(dir.path(), &["scenario", "small.ron"])
        .assert()
        .success()
        .get_output()
        .clone();
    assert_eq!(first.stdout, second.stdout);
    assert_eq!(text(&second.stderr), "results/small holds these results already\n");
    assert_eq!(
        fs::read(dir.path().join("results/small/manifest.json")).unwrap(),
        manifest
    );
}

#[test]
fn results_of_another_scenario_are_refused_unless_forced() {
    let dir = place();
    desim(dir.path(), &["scenario", "small.ron", "--quiet"])
        .assert()
        .success();
    let before = fs::read(dir.path().join("results/small/summary.json")).unwrap();
    let changed = ["scenario", "small.ron", "--set", "radio.range=3.0"];
    let refused = desim(dir.path(), &changed)
        .assert()
        .code(2)
        .stdout("")
        .get_output()
        .clone();
    let message = text(&refused.stderr);
    assert!(
        message.contains("radio.range: 2.0 there, 3.0 now") && message.contains("--force"),
        "{message}"
    );
    assert_eq!(fs::read(dir.path().join("results/small/summary.json")).unwrap(), before);
    desim(dir.path(), &[&changed[..], &["--force", "--quiet"]].concat())
        .assert()
        .success();
    assert_ne!(fs::read(dir.path().join("results/small/summary.json")).unwrap(), before);
}

#[test]
fn bad_input_is_one_message_and_status_2_and_nothing_written() {
    let dir = place();
    fs::write(dir.path().join("bad.ron"), SMALL.replace("2.0", "-2.0")).unwrap();
    fs::write(
        dir.path().join("crowd.ron"),
        SMALL.replace("Uniform", "Cluster(radius: 0.1)"),
    )
    .unwrap();
    fs::create_dir(dir.path().join("photos")).unwrap();
    fs::write(dir.path().join("photos/cat.jpg"), "").unwrap();
    let before = fs::read_dir(dir.path()).unwrap().count();
    let cases: [(&[&str], &str); 8] = [
        (&["scenario", "missing.ron"], "missing.ron"),
        (&["scenario", "bad.ron"], "time_limit"),
        (&["scenario", "crowd.ron"], "robots"),
        (&["scenario", "small.ron", "--set", "radio.rage=1"], "range"),
        (&["scenario", "small.ron", "--trials", "0"], "trials"),
        (
            &["scenario", "small.ron", "--out", "small.ron"],
            "small.ron is not a folder",
        ),
        (&["scenario", "small.ron", "--out", "photos"], "cat.jpg"),
        (&["check", "bad.ron"], ""),
    ];
    for (arguments, expected) in cases {
        let out = desim(dir.path(), arguments).assert().code(2).get_output().clone();
        let message = text(&out.stderr);
        assert!(message.contains(expected), "{arguments:?}: {message}");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), before, "{arguments:?}");
    }
}

#[test]
fn an_unwritable_place_is_status_1_and_says_where() {
    let dir = place();
    // Below a file, nothing can be made; unlike permissions, this binds every user.
    let out = desim(dir.path(), &["scenario", "small.ron", "--out", "/dev/null/results"])
        .assert()
        .get_output()
        .clone();
    assert!(matches!(out.status.code(), Some(1 | 2)));
    assert!(text(&out.stderr).contains("/dev/null/results"), "{}", text(&out.stderr));
}

#[test]
fn a_reader_that_leaves_early_is_no_fault() {
    let dir = place();
    let script = format!(
        "{} schema | head -c 1 >/dev/null; echo ${{PIPESTATUS[0]}}",
        env!("CARGO_BIN_EXE_desim")
    );
    let out = Process::new("bash")
        .args(["-c", &script])
        .current_dir(dir.path())
        .output()
        .unwrap();
    assert_eq!((text(&out.stdout).trim(), text(&out.stderr).as_str()), ("0", ""));
}

#[test]
fn a_terminated_run_keeps_its_trials_and_goes_on() {
    let dir = place();
    let arguments = [
        "scenario",
        "small.ron",
        "--set",
        "time_limit=2000.0",
        "--jobs",
        "1",
        "--trials",
        "40",
        "--quiet",
    ];
    let mut child = Process::new(env!("CARGO_BIN_EXE_desim"))
        .args(arguments)
        .env("DESIM_LOG", "info")
        .current_dir(dir.path())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut log = BufReader::new(child.stderr.take().unwrap());
    log.read_line(&mut String::new()).unwrap();
    let signal = Process::new("kill")
        .args(["-TERM", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(signal.success());
    let mut last_words = String::new();
    log.read_to_string(&mut last_words).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(
        last_words.contains("of 40 trials are kept in results/small"),
        "{last_words}"
    );

    let kept = || fs::read_dir(dir.path().join("results/small/.trials")).unwrap().count();
    assert!(kept() > 1);
    let resumed = desim(dir.path(), &arguments)
        .timeout(Duration::from_mins(5))
        .assert()
        .success();
    assert_eq!(text(&resumed.get_output().stdout), "");
    assert!(!dir.path().join("results/small/.trials").exists());
}
