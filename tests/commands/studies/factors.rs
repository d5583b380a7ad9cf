//! Studies of several factors, and settings whose names look like something else, run as their users run them.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::{TempDir, tempdir};

use super::command::{comparison, desim, text};

/// The folder of the study `name` and its results, as `desim compare` and `desim report` leave them, and what they printed.
fn finished(name: &str) -> (TempDir, String, String, Value) {
    let dir = tempdir().unwrap();
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/commands/studies/numbers");
    for file in ["base.ron".to_owned(), format!("{name}.ron")] {
        fs::copy(own.join(&file), dir.path().join(&file)).unwrap();
    }
    let compared = desim(dir.path(), &["compare", &format!("{name}.ron")])
        .assert()
        .success();
    let printed = text(&compared.get_output().stdout);
    let out = format!("results/{name}");
    desim(dir.path(), &["report", &out]).assert().success();
    let page = fs::read_to_string(dir.path().join(&out).join("report.html")).unwrap();
    let comparison = comparison(&dir.path().join(&out));
    (dir, printed, page, comparison)
}

/// Of every chart of a page: its name, its data and its layout.
fn charts(page: &str) -> Vec<(String, Value)> {
    let calls = page.split("Plotly.newPlot(\"").skip(1);
    calls
        .map(|call| {
            let (id, rest) = call.split_once("\", ").unwrap();
            let plot = serde_json::Deserializer::from_str(rest).into_iter::<Value>().next();
            (id.to_owned(), plot.unwrap().unwrap())
        })
        .collect()
}

/// The names of the settings that a chart of rows shows, and on what kind of axis.
fn rows(chart: &Value) -> (BTreeSet<&str>, &str) {
    let names = chart["data"][0]["y"].as_array().unwrap();
    (
        names.iter().map(|name| name.as_str().unwrap()).collect(),
        chart["layout"]["yaxis"]["type"].as_str().unwrap(),
    )
}

#[test]
fn levels_that_look_like_numbers_are_drawn_all_of_them_and_compared_by_factors() {
    let (_dir, printed, page, compared) = finished("numbers");
    assert_eq!(compared["settings"].as_array().unwrap().len(), 9);
    // Three figures of which 3 + 3 differences between levels and an interaction are asked for; what all send is the same everywhere.
    let count = |key: &str| compared[key].as_array().unwrap().len();
    assert_eq!(
        (
            count("pairs"),
            count("effects"),
            count("interactions"),
            count("level_means")
        ),
        (0, 18, 3, 18)
    );
    assert_eq!(
        compared["family"]["alike"],
        7 + 4,
        "bytes do not differ, nor does delivery by patience"
    );
    assert_eq!(compared["family"]["tests"], 21 - 11);
    let finding = compared["finding"].as_str().unwrap();
    assert!(
        finding.contains("loss matters most") || finding.contains("patience matters most"),
        "{finding}"
    );
    assert!(finding.contains("the effect of patience depends on loss"), "{finding}");
    let words = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("Effects on query accuracy P_A, averaged over the other factors"),
        "{printed}"
    );
    assert!(!words.contains("pair by pair"), "{printed}");

    let all: BTreeSet<String> = ["0.5", "1.0", "2.0"]
        .iter()
        .flat_map(|a| ["0", "0.2", "0.5"].map(|b| format!("{a}, {b}")))
        .collect();
    let charts = charts(&page);
    let of = |id: &str| {
        &charts
            .iter()
            .find(|(name, _)| name == id)
            .unwrap_or_else(|| panic!("{id}"))
            .1
    };
    for id in ["by-setting-detection-query-accuracy-0", "by-setting-delivery-ratio-0"] {
        let (names, kind) = rows(of(id));
        assert_eq!((names, kind), (all.iter().map(String::as_str).collect(), "category"));
    }
    let lines = of("levels-detection-query-accuracy-0-1-0");
    assert_eq!(lines["data"].as_array().unwrap().len(), 3, "a line a level");
    assert_eq!(
        lines["layout"]["xaxis"]["categoryarray"],
        serde_json::json!(["0.5", "1.0", "2.0"])
    );
    let colours = of("levels-detection-query-accuracy-0-1-1");
    let cells = colours["data"][0]["z"].as_array().unwrap();
    assert_eq!(cells.iter().map(|row| row.as_array().unwrap().len()).sum::<usize>(), 9);
    assert_eq!(colours["layout"]["yaxis"]["type"], "category");
    // What is the same in every setting is said, and not drawn.
    assert!(page.contains("is the same in every setting"));
    assert!(!charts.iter().any(|(id, _)| id.starts_with("by-setting-bandwidth")));
}

/// Three robots that hear each other always, of which one crashes: it is found by timeouts, the sooner the shorter, and by nobody who
/// does not look for it. What is sent is the same in any case.
#[test]
fn a_setting_without_a_detector_has_no_figure_of_one_and_is_compared_by_what_it_has() {
    let dir = tempdir().unwrap();
    let base = "Scenario(name: \"base\", time_limit: 30.0, swarm: (robots: 3, deploy: At([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])), \
        protocol: Heartbeat, detector: Timeout(2.5), faults: [Crash(robots: [2], at: 15.0)])";
    let study = "// Does a detector pay?\nStudy(name: \"none\", base: \"base.ron\", trials: 8, factors: [(name: \"detector\", \
        paths: [\"detector\"], levels: [(label: \"nobody\", values: [None]), (label: \"short\", values: [Timeout(1.5)]), \
        (label: \"long\", values: [Timeout(2.5)])])], figure: \"detection.detection_time_s\", \
        also: [\"detection.query_accuracy\", \"delivery_ratio\"], pareto: (\"detection.detection_time_s\", \"delivery_ratio\"))";
    fs::write(dir.path().join("base.ron"), base).unwrap();
    fs::write(dir.path().join("study.ron"), study).unwrap();
    let output = desim(dir.path(), &["compare", "study.ron"]).assert().success();
    let printed = text(&output.get_output().stdout);
    let results = dir.path().join("results/none");
    let compared = comparison(&results);
    assert_eq!(
        compared["finding"].as_str().unwrap().split(". ").last(),
        Some("It is detectably better than long; not comparable with nobody."),
        "{printed}"
    );
    for setting in compared["settings"].as_array().unwrap() {
        let looks = setting["name"] != "nobody";
        for (key, figure) in setting["figures"].as_object().unwrap() {
            // Nobody is ever mistaken, so that no mistake has a duration.
            let always = matches!(key.as_str(), "detection.detection_time_s" | "detection.query_accuracy");
            if key.starts_with("detection.") && (always || !looks) {
                assert_eq!(figure["value"].is_number(), looks, "{key}: {figure}");
                assert_eq!(figure["ci95"][0].is_number(), looks, "{key}: {figure}");
            }
        }
    }
    for pair in compared["pairs"].as_array().unwrap() {
        let with_nobody = [&pair["setting"], &pair["against"]]
            .iter()
            .any(|name| *name == "nobody");
        let of_detectors = pair["figure"] != "delivery_ratio";
        let is_compared = pair["verdict"] != "not_comparable";
        assert_eq!(is_compared, !(with_nobody && of_detectors), "{pair}");
        assert_eq!(
            !is_compared,
            pair["words"].as_str().unwrap().contains("cannot be compared"),
            "{pair}"
        );
    }
    let points = compared["pareto"]["points"].as_array().unwrap();
    assert!(points.iter().all(|point| point["setting"] != "nobody"), "{points:?}");
    desim(dir.path(), &["report", "results/none"]).assert().success();
    let page = fs::read_to_string(results.join("report.html")).unwrap();
    assert!(page.contains("not comparable with nobody") && !page.contains(">NaN<"));
    let alone = desim(dir.path(), &["report", "results/none/nobody"]).assert().success();
    let alone = text(&alone.get_output().stdout);
    assert!(alone.contains("none: robots ran no failure detector"), "{alone}");
    assert!(!alone.contains("mistake"), "{alone}");
}

#[test]
fn every_axis_of_names_is_one_whatever_the_names_and_no_two_settings_share_a_line() {
    let (_dir, _, page, compared) = finished("names");
    let settings = compared["settings"].as_array().unwrap().len();
    let charts = charts(&page);
    for id in [
        "by-setting-detection-query-accuracy-0",
        "by-setting-detection-mistake-rate-hz-0",
    ] {
        let chart = &charts.iter().find(|(name, _)| name == id).unwrap().1;
        let (names, kind) = rows(chart);
        assert_eq!((names.len(), kind), (settings, "category"));
        let order = chart["layout"]["yaxis"]["categoryarray"].as_array().unwrap();
        assert!(order.len() == settings && names.iter().all(|name| order.contains(&(*name).into())));
    }
    // Of 45 pairs a table of settings by settings, and no chart of 45 rows.
    let table = &charts
        .iter()
        .find(|(name, _)| name == "differences-detection-query-accuracy-0")
        .unwrap()
        .1;
    assert_eq!(table["data"][0]["type"], "heatmap");
    assert_eq!(table["data"][0]["z"].as_array().unwrap().len(), settings);
    for (id, chart) in &charts {
        for axis in ["xaxis", "yaxis"] {
            let of_words = |trace: &Value| {
                trace[&axis[..1]]
                    .as_array()
                    .is_some_and(|all| all.iter().any(Value::is_string))
            };
            let any = chart["data"].as_array().unwrap().iter().any(of_words);
            assert!(!any || chart["layout"][axis]["type"] == "category", "{id} {axis}");
        }
    }
}

#[test]
fn a_study_that_can_find_nothing_is_told_so_before_it_runs_with_the_trials_that_it_needs() {
    let dir = tempdir().unwrap();
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/commands/studies/numbers");
    fs::copy(own.join("base.ron"), dir.path().join("base.ron")).unwrap();
    let study = fs::read_to_string(own.join("names.ron")).unwrap();
    // 45 pairs in two figures: 90 · 2/2⁶; 90 · 2/2ⁿ < 0.05 from 12 trials on; below 0.05 · 2⁶/2 = 1.6 one difference is allowed.
    fs::write(dir.path().join("names.ron"), &study).unwrap();
    let checked = desim(dir.path(), &["check", "names.ron"]).assert().success();
    let said = text(&checked.get_output().stdout);
    let words = said
        .split_whitespace()
        .filter(|word| *word != "│")
        .collect::<Vec<_>>()
        .join(" ");
    for part in [
        "6 trials of each setting cannot show any of 90 differences",
        "the least p-value is 0.03",
        "run 12 trials of each setting or more",
        "1 difference at most",
        "names.ron:5",
    ] {
        assert!(words.contains(part), "{part}: {said}");
    }
    let run = desim(dir.path(), &["compare", "names.ron", "--out", "few"])
        .assert()
        .success();
    let (shown, warned) = (text(&run.get_output().stdout), text(&run.get_output().stderr));
    assert!(warned.contains("cannot show any of 90 differences"), "{warned}");
    let shown = shown.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        shown.contains("6 trials cannot show any of") && shown.contains("cannot tell"),
        "{shown}"
    );
    assert!(!shown.contains("unclear"), "{shown}");
    for enough in [
        &["--trials", "12"][..],
        &["--until-width", "0.001", "--most-trials", "12"],
    ] {
        let run = desim(
            dir.path(),
            &["compare", "names.ron", "--quiet", "--out", "enough", "--force"],
        )
        .args(enough)
        .assert()
        .success();
        assert_eq!(text(&run.get_output().stderr), "", "{enough:?}");
    }
    let reference = study.replace("    figure:", "    reference: [\"50 %\"],\n    figure:");
    // Nine differences in two figures: 18 · 2/2ⁿ < 0.05 from 10 trials on.
    fs::write(dir.path().join("names.ron"), reference).unwrap();
    let checked = desim(dir.path(), &["check", "names.ron"]).assert().success();
    assert!(text(&checked.get_output().stdout).contains("run 10 trials"));
}

#[test]
fn a_study_given_for_a_scenario_and_a_scenario_for_a_study_name_the_right_command_in_the_first_line() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/commands/studies/numbers");
    for (arguments, right) in [
        (["scenario", "names.ron"], "desim compare names.ron"),
        (["compare", "base.ron"], "desim scenario base.ron"),
    ] {
        let refused = desim(&own, &arguments).assert().code(2);
        let said = text(&refused.get_output().stderr);
        assert!(said.lines().next().unwrap().contains(right), "{said}");
    }
    assert!(!own.join("results").exists());
}

#[test]
fn more_duplicates_are_worse() {
    // Of ten robots that hear each other all know the rumour after a few rounds; from then on all they hear is heard in vain: of 20 s four times as many
    // rounds at 0.5 s than at 2 s, so that fewer of the messages at 2 s are duplicates.
    let dir = tempdir().unwrap();
    let base = "Scenario(name: \"base\", time_limit: 20.0, arena: (size: (4.0, 4.0)), control: (period: 0.5), \
        swarm: (robots: 10, deploy: Cluster(radius: 0.6)), protocol: Rumor(mode: Push, sources: Robots([0])), \
        gossip: (relay: (fan_out: Peers(1))), radio: (range: 2.0))";
    let study = "Study(name: \"heard\", base: \"base.ron\", trials: 8, factors: [(name: \"interval\", \
        paths: [\"gossip.relay.interval\"], levels: [(label: \"often\", values: [0.5]), (label: \"rarely\", values: [2.0])])], \
        reference: [\"often\"], figure: \"duplicates\")";
    fs::write(dir.path().join("base.ron"), base).unwrap();
    fs::write(dir.path().join("study.ron"), study).unwrap();
    desim(dir.path(), &["compare", "study.ron", "--quiet", "--out", "out"])
        .assert()
        .success();
    let compared = comparison(&dir.path().join("out"));
    let pair = &compared["pairs"][0];
    assert!(pair["difference"]["value"].as_f64().unwrap() < 0.0, "{pair}");
    assert_eq!(pair["verdict"], "better");
}
