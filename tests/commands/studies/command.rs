//! `desim compare`, run as its users run it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command as Process, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::{TempDir, tempdir};

const BASE: &str = "Scenario(name: \"base\", time_limit: 20.0, arena: (size: (4.0, 4.0)), control: (period: 0.5), \
    swarm: (robots: 12, deploy: Uniform), protocol: Heartbeat, gossip: (status: (interval: 0.5)), \
    detector: Timeout(1.2), radio: (loss: Bernoulli(0.3)))";

const STUDY: &str = "// Does patience pay?\nStudy(name: \"patience\", base: \"base.ron\", trials: 8, factors: [(name: \"timeout\", \
    paths: [\"detector\"], levels: [(label: \"short\", values: [Timeout(1.2)]), (label: \"long\", values: [Timeout(2.2)])])], \
    reference: [\"short\"], figure: \"detection.mistake_rate_hz\", also: [\"detection.query_accuracy\", \"delivery_ratio\"], \
    pareto: (\"detection.mistake_rate_hz\", \"detection.query_accuracy\"))";

pub fn place() -> TempDir {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("base.ron"), BASE).unwrap();
    fs::write(dir.path().join("study.ron"), STUDY).unwrap();
    dir
}

pub fn desim(dir: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("desim").unwrap();
    command.current_dir(dir).args(arguments);
    command
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_owned()).unwrap()
}

pub fn comparison(dir: &Path) -> Value {
    serde_json::from_slice(&fs::read(dir.join("comparison.json")).unwrap()).unwrap()
}

/// Every file below `dir` but the manifests of settings, which hold wall times.
pub fn bytes(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![dir.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.file_name().unwrap() != "manifest.json" {
                found.insert(
                    path.strip_prefix(dir).unwrap().display().to_string(),
                    fs::read(path).unwrap(),
                );
            }
        }
    }
    found
}

#[test]
fn a_study_is_run_compared_reported_and_then_there() {
    let dir = place();
    let first = desim(dir.path(), &["compare", "study.ron"])
        .assert()
        .success()
        .get_output()
        .clone();
    let report = text(&first.stdout);
    assert!(report.contains("Does patience pay?"), "{report}");
    assert!(report.contains("long has the lowest mistake rate"), "{report}");
    assert!(report.lines().all(|line| line.chars().count() <= 80), "{report}");
    assert_eq!(text(&first.stderr), "");
    let out = dir.path().join("results/patience");
    for file in [
        "comparison.json",
        "study.json",
        "pareto.svg",
        "short/summary.json",
        "long/manifest.json",
    ] {
        assert!(out.join(file).exists(), "{file}");
    }
    let before = bytes(&out);
    let second = desim(dir.path(), &["compare", "study.ron"])
        .assert()
        .success()
        .get_output()
        .clone();
    assert_eq!(text(&second.stderr), "results/patience holds these results already\n");
    assert_eq!(first.stdout, second.stdout);
    assert!(bytes(&out) == before);
    let json = desim(dir.path(), &["compare", "study.ron", "--quiet", "--format", "json"])
        .assert()
        .success();
    assert_eq!(json.get_output().stdout, fs::read(out.join("comparison.json")).unwrap());
    desim(
        dir.path(),
        &["explain", "results/patience/short", "--trial", "0", "--robot", "1"],
    )
    .assert()
    .success();
}

#[test]
fn the_comparison_has_the_same_figures_as_the_summaries_of_its_settings() {
    let dir = place();
    desim(dir.path(), &["compare", "study.ron", "--quiet", "--out", "out"])
        .assert()
        .success();
    let out = dir.path().join("out");
    let compared = comparison(&out);
    for setting in compared["settings"].as_array().unwrap() {
        let name = setting["name"].as_str().unwrap();
        let summary: Value = serde_json::from_slice(&fs::read(out.join(name).join("summary.json")).unwrap()).unwrap();
        let mut same = 0;
        for (key, figure) in setting["figures"].as_object().unwrap() {
            let pointer = format!("/{}", key.replace('.', "/"));
            // Spreads pool robots of all trials, quantiles of latency all frames: these are others.
            let spread = summary.pointer(&pointer).filter(|value| value.is_object());
            let Some(value) = spread
                .map(|estimate| &estimate["value"])
                .filter(|value| value.is_number())
            else {
                continue;
            };
            assert_eq!(figure["value"], *value, "{key}");
            assert_eq!(figure["ci95"], summary.pointer(&pointer).unwrap()["ci95"], "{key}");
            same += 1;
        }
        assert!(same >= 10, "{same} figures are in both");
    }
}

#[test]
fn an_interrupted_study_goes_on_and_ends_with_the_same_bytes() {
    let dir = place();
    let long = STUDY.replace("trials: 8", "trials: 60");
    fs::write(dir.path().join("study.ron"), long).unwrap();
    desim(dir.path(), &["compare", "study.ron", "--quiet", "--out", "whole"])
        .assert()
        .success();
    let mut child = Process::new(assert_cmd::cargo::cargo_bin("desim"))
        .current_dir(dir.path())
        .args(["compare", "study.ron", "--quiet", "--out", "pieces", "--jobs", "1"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let trials = dir.path().join("pieces/long/.trials");
    let start = Instant::now();
    let finished = || fs::read_dir(&trials).map_or(0, |entries| entries.flatten().count()) > 2;
    while !finished() && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    Process::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert_eq!(
        child.wait().unwrap().code(),
        Some(130),
        "it was interrupted before its end"
    );
    assert!(!dir.path().join("pieces/comparison.json").exists());
    let again = desim(dir.path(), &["compare", "study.ron", "--out", "pieces", "--jobs", "2"])
        .assert()
        .success();
    let said = text(&again.get_output().stderr);
    assert!(said.starts_with("going on after "), "{said}");
    let [whole, pieces] = ["whole", "pieces"].map(|out| bytes(&dir.path().join(out)));
    assert!(whole.keys().eq(pieces.keys()));
    for (name, content) in &whole {
        assert!(pieces[name] == *content, "{name} differs");
    }
}

#[test]
fn results_of_another_study_are_refused_and_replaced_only_by_force() {
    let dir = place();
    desim(dir.path(), &["compare", "study.ron", "--quiet"])
        .assert()
        .success();
    let before = bytes(&dir.path().join("results"));
    let refused = desim(dir.path(), &["compare", "study.ron", "--quiet", "--trials", "9"])
        .assert()
        .code(2);
    let said = text(&refused.get_output().stderr);
    assert!(
        said.contains("[8,8] there, [9,9] now") && said.contains("--force"),
        "{said}"
    );
    assert!(bytes(&dir.path().join("results")) == before);
    desim(
        dir.path(),
        &["compare", "study.ron", "--quiet", "--trials", "9", "--force"],
    )
    .assert()
    .success();
    assert_eq!(
        comparison(&dir.path().join("results/patience"))["settings"][0]["trials"],
        9
    );
}

#[test]
fn a_finished_study_is_reported_again_with_a_page_that_goes_with_its_results() {
    let dir = place();
    let page = dir.path().join("results/patience/report.html");
    let unfinished = desim(dir.path(), &["report", "results/patience"]).assert().code(2);
    assert!(!text(&unfinished.get_output().stderr).contains("panicked"));
    let compared = desim(dir.path(), &["compare", "study.ron"]).assert().success();
    let mut before = bytes(&dir.path().join("results"));

    let reported = desim(dir.path(), &["report", "results/patience"]).assert().success();
    let shown = text(&reported.get_output().stdout);
    let body = |text: &str| text.split("\n  results ").next().unwrap().to_owned();
    assert_eq!(body(&shown), body(&text(&compared.get_output().stdout)));
    assert!(shown.contains("report.html"), "{shown}");
    assert!(fs::read_to_string(&page).unwrap().contains("Does patience pay?"));
    let json = desim(dir.path(), &["report", "results/patience", "--format", "json"])
        .assert()
        .success();
    assert_eq!(
        json.get_output().stdout,
        fs::read(dir.path().join("results/patience/comparison.json")).unwrap()
    );
    let mut after = bytes(&dir.path().join("results"));
    after.remove("patience/report.html");
    let manifests = [&mut after, &mut before].map(|files| files.remove("patience/study.json").unwrap());
    let [after_page, before_page] = manifests.map(|text| String::from_utf8(text).unwrap());
    assert!(after_page.contains("report.html") && !before_page.contains("report.html"));
    assert!(after == before, "reporting changes nothing else");

    let both = desim(dir.path(), &["report", "results/patience", "results/patience/short"])
        .assert()
        .code(2);
    assert!(text(&both.get_output().stderr).contains("reported alone"));
    desim(dir.path(), &["compare", "study.ron", "--quiet", "--force"])
        .assert()
        .success();
    assert!(!page.exists(), "a page of results that are gone is gone with them");
}

#[test]
fn a_study_that_is_not_finished_is_not_reported() {
    let dir = place();
    desim(dir.path(), &["compare", "study.ron", "--quiet"])
        .assert()
        .success();
    let manifest = dir.path().join("results/patience/study.json");
    let mut unfinished: Value = serde_json::from_slice(&fs::read(&manifest).unwrap()).unwrap();
    unfinished.as_object_mut().unwrap().shift_remove("xxh3_128");
    unfinished["finished"] = false.into();
    fs::write(&manifest, desim::export::sealed(&unfinished)).unwrap();
    let refused = desim(dir.path(), &["report", "results/patience"]).assert().code(2);
    assert!(text(&refused.get_output().stderr).contains("not finished: go on with it by `desim compare`"));
    assert!(!dir.path().join("results/patience/report.html").exists());
}

#[test]
fn a_folder_with_anything_else_in_it_is_left_alone() {
    let dir = place();
    fs::create_dir(dir.path().join("mine")).unwrap();
    fs::write(dir.path().join("mine/notes.txt"), "mine").unwrap();
    desim(dir.path(), &["compare", "study.ron", "--quiet", "--out", "mine"])
        .assert()
        .code(2);
    desim(
        dir.path(),
        &["compare", "study.ron", "--quiet", "--out", "mine/notes.txt"],
    )
    .assert()
    .code(2);
    assert_eq!(fs::read_dir(dir.path().join("mine")).unwrap().count(), 1);
}

#[test]
fn scenario_files_are_paired_where_their_seeds_are_equal_and_else_independent() {
    let dir = place();
    for (name, seed) in [("a", 1), ("b", 1), ("c", 2)] {
        let scenario = BASE.replace("name: \"base\"", &format!("name: \"{name}\", trials: 8, seed: {seed}"));
        fs::write(dir.path().join(format!("{name}.ron")), scenario).unwrap();
    }
    let compare = |files: [&str; 2]| {
        desim(
            dir.path(),
            &["compare", files[0], files[1], "--quiet", "--out", "out", "--force"],
        )
        .assert()
        .success();
        comparison(&dir.path().join("out"))
    };
    let same = compare(["a.ron", "b.ron"]);
    assert_eq!(
        (&same["paired"], &same["pairs"][0]["difference"]["value"]),
        (&true.into(), &0.0.into())
    );
    assert_eq!(same["pairs"][0]["verdict"], "no_detectable_difference");
    let apart = compare(["a.ron", "c.ron"]);
    assert_eq!(apart["paired"], false);
    assert_eq!(apart["pairs"][0]["p"], apart["pairs"][0]["tests"]["mann_whitney"]);
    let twice = desim(dir.path(), &["compare", "a.ron", "a.ron"]).assert().code(2);
    assert!(text(&twice.get_output().stderr).contains("two scenarios are called"));
    desim(dir.path(), &["compare", "a.ron"]).assert().code(2);
    desim(dir.path(), &["compare", "a.ron", "study.ron"]).assert().code(2);
    desim(dir.path(), &["compare", "a.ron", "b.ron", "--figure", "nonsense"])
        .assert()
        .code(2);
}

#[test]
fn trials_are_added_until_the_interval_is_narrow_enough_or_the_cap_is_reached() {
    let dir = place();
    let run = |width: &str, out: &str| {
        let arguments = [
            "compare",
            "study.ron",
            "--quiet",
            "--trials",
            "4",
            "--out",
            out,
            "--until-width",
            width,
        ];
        desim(dir.path(), &arguments)
            .args(["--most-trials", "16"])
            .assert()
            .success();
        comparison(&dir.path().join(out))
    };
    let wide = run("1", "wide");
    assert_eq!(
        (&wide["stopping"]["reached"], &wide["stopping"]["trials"]),
        (&true.into(), &4.into())
    );
    let narrow = run("1e-9", "narrow");
    assert_eq!(
        (&narrow["stopping"]["reached"], &narrow["stopping"]["trials"]),
        (&false.into(), &16.into())
    );
    assert_eq!(narrow["settings"][1]["trials"], 16);
    // As many trials from the start are the same trials.
    desim(
        dir.path(),
        &["compare", "study.ron", "--quiet", "--trials", "16", "--out", "whole"],
    )
    .assert()
    .success();
    let table = |out: &str| fs::read(dir.path().join(out).join("short/trials.parquet")).unwrap_or_default();
    assert!(table("narrow") == table("whole"));
}

#[test]
fn check_says_that_a_study_is_well_and_how_large_it_is() {
    let dir = place();
    let out = desim(dir.path(), &["check", "study.ron", "base.ron"])
        .assert()
        .success();
    let said = text(&out.get_output().stdout);
    assert_eq!(
        said,
        "ok study.ron: patience, a study of 2 settings, 16 trials\nok base.ron: base, 1 trial, 12 robots\n"
    );
    let resolved = desim(dir.path(), &["check", "--resolved", "study.ron"])
        .assert()
        .success();
    assert_eq!(
        text(&resolved.get_output().stdout)
            .matches("// Does patience pay?\nScenario(")
            .count(),
        2
    );
    fs::write(
        dir.path().join("study.ron"),
        STUDY.replace("Timeout(2.2)", "Timeout(0.2)"),
    )
    .unwrap();
    let out = desim(dir.path(), &["check", "study.ron"]).assert().code(2);
    assert!(text(&out.get_output().stdout).contains("study.ron:2"));
}

#[test]
fn the_page_of_a_study_names_trials_to_watch_and_a_study_is_no_folder_of_trials() {
    let dir = place();
    let run = |arguments: &[&str]| desim(dir.path(), arguments).assert().success().get_output().clone();
    run(&["compare", "study.ron", "--quiet"]);
    run(&["report", "results/patience"]);
    let page = || fs::read_to_string(dir.path().join("results/patience/report.html")).unwrap();
    let first = page();
    // What the table says of each setting's trials, read by hand.
    let table = &first[first
        .find("<table class=\"watch\">")
        .expect("there are trials to watch")..];
    let table = &table[..table.find("</table>").unwrap()];
    let commands: Vec<&str> = table
        .split("<code>")
        .skip(1)
        .filter_map(|rest| rest.split("</code>").next())
        .collect();
    assert_eq!(commands.len(), 4, "{table}");
    assert!(!table.contains("<a "), "there is no page yet: {table}");
    for (command, setting) in commands.iter().zip(["short", "short", "long", "long"]) {
        assert!(
            command.starts_with(&format!("desim replay results/patience/{setting} --trial ")),
            "{command}"
        );
    }
    // The worst by the figure that the study is about makes the most mistakes: what a whole report of that trial's setting says.
    let words: Vec<&str> = commands[1].split(' ').collect();
    let mistakes = |setting: &str| {
        let bytes = fs::read(dir.path().join(format!("results/patience/{setting}/summary.json"))).unwrap();
        serde_json::from_slice::<Value>(&bytes).unwrap()["detection"]["mistakes"]["value"]
            .as_u64()
            .unwrap()
    };
    assert!(mistakes("short") > mistakes("long"));
    run(&words[1..]);
    run(&["report", "results/patience"]);
    let trial = words[4];
    let name = if trial == "0" {
        "replay.html".to_owned()
    } else {
        format!("replay-{trial}.html")
    };
    let link = format!("<a href=\"short/{name}\">");
    assert!(page().contains(&link), "{link}");
    assert!(dir.path().join("results/patience/short").join(&name).is_file());
    // Elsewhere the link would lead nowhere.
    run(&["report", "results/patience", "--out", "elsewhere.html"]);
    assert!(
        !fs::read_to_string(dir.path().join("elsewhere.html"))
            .unwrap()
            .contains(&link)
    );
    for command in [
        &["replay", "results/patience"][..],
        &["explain", "results/patience", "--trial", "0", "--robot", "1"],
    ] {
        let refused = desim(dir.path(), command).assert().code(2).get_output().clone();
        let said = text(&refused.stderr);
        assert!(
            said.contains("results/patience holds a study") && said.contains("Its settings are short, long."),
            "{said}"
        );
        assert!(said.contains("such as results/patience/short"), "{said}");
    }
}
