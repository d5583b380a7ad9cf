//! The page of charts, as far as it can be judged without a browser; `.ci/browser` opens it in one.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use desim::metrics::summary::Trials;
use desim::metrics::{Outcome, Summary, TrialRecord};
use desim::report::{PAGE_MARK, PageInput, PageTrials, Watch, page};
use desim::spool::Spool;
use tempfile::tempdir;

use super::fixture::{record, scenario};

const TOPICS: [&str; 4] = ["status", "request", "parent strand", "child strand"];
const ROLES: [&str; 4] = ["free", "root", "networker", "worker"];

fn page_of(records: &[TrialRecord], topics: &[&str], roles: &[&str], question: &str) -> String {
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    let scenario = scenario(records.len() as u32);
    page(&PageInput {
        question: Some(question),
        scenario: &scenario,
        topics: &names(topics),
        roles: &names(roles),
        trials: &PageTrials::of(&scenario, records.iter().cloned()),
        summary: &Summary::of("made-up", topics, roles, records),
        made_by: "desim 9.9",
        watch: None,
    })
}

fn records(trials: u32) -> Vec<TrialRecord> {
    (0..trials).map(record).collect()
}

fn made_up(trials: u32) -> String {
    page_of(&records(trials), &TOPICS, &ROLES, "Does it hold?")
}

#[test]
fn of_many_trials_some_are_drawn_and_what_takes_little_is_of_all_of_them() {
    let scenario = scenario(2_001);
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    let registry = scenario.figures();
    let mut summary = Trials::new(&registry, &TOPICS, &ROLES);
    let mut trials = PageTrials::new(&scenario);
    for record in (0..2_001).map(record) {
        summary.add(&record);
        trials.add(record);
    }
    let page = page(&PageInput {
        question: None,
        scenario: &scenario,
        topics: &names(&TOPICS),
        roles: &names(&ROLES),
        trials: &trials,
        summary: &summary.summary("made-up"),
        made_by: "desim 9.9",
        watch: Some(Watch {
            folder: "results/many".to_owned(),
            ..Watch::default()
        }),
    });
    for words in [
        "2,001 trials with seed 1",
        "are drawn from 501 trials, spread evenly over all, and say so.",
        "each robot sent and received in 501 of 2,001 trials, topic by topic",
        "1,601 of 2,001 trials completed",
        "Of the 1,601 steps of the curve 1,000 are drawn and listed, spread evenly.",
        // The slowest.
        "desim replay results/many --trial 2000",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert_eq!(
        page.matches("Drawn from 501 of the 2,001 trials, spread evenly.")
            .count(),
        12
    );
    assert!(page.len() < 10_000_000, "{} bytes", page.len());
}

/// A page without the script that draws, the first on it.
fn without_library(page: &str) -> String {
    let start = page.find("<script").unwrap();
    let end = start + page[start..].find("</script>").unwrap();
    page[..start].to_owned() + &page[end..]
}

/// What a reader finds on a page, without its data: headings, captions, charts, heads and lengths of tables.
fn outline(page: &str) -> String {
    let page = without_library(page);
    let mut lines = Vec::new();
    for part in page.split('<').skip(1) {
        let (tag, text) = part.split_once('>').unwrap_or((part, ""));
        let name = tag.split(' ').next().unwrap_or_default();
        let text = text.trim();
        match name {
            "h1" | "h2" | "h3" | "h4" | "figcaption" | "summary" | "p" if !text.is_empty() => {
                lines.push(format!("{name}: {text}"));
            }
            "th" => {
                if let Some(last) = lines.last_mut().filter(|last| last.starts_with("columns: ")) {
                    last.push_str(" | ");
                    last.push_str(text);
                } else {
                    lines.push(format!("columns: {text}"));
                }
            }
            "td" if tag == "td"
                && lines
                    .last()
                    .is_some_and(|last| last.starts_with("columns: ") && page.contains("overview")) => {}
            "div" if tag.contains("plotly-graph-div") => {
                let id = tag.split('"').nth(1).unwrap_or_default();
                lines.push(format!("chart: {id}"));
            }
            _ => {}
        }
    }
    lines.join("\n")
}

#[test]
fn the_page_of_many_trials() {
    insta::assert_snapshot!(outline(&made_up(7)));
}

#[test]
fn the_page_of_one_trial_without_mission_or_samples_has_no_empty_figures() {
    let still = TrialRecord {
        outcome: Outcome::NoMission,
        connectivity: Spool::default(),
        series: Spool::default(),
        healing: Vec::new(),
        ..record(0)
    };
    insta::assert_snapshot!(outline(&page_of(&[still], &TOPICS, &ROLES, "And alone?")));
}

#[test]
fn every_chart_has_its_data_as_a_table_and_as_a_file() {
    let page = without_library(&made_up(7));
    let figures = page.matches("<figure ").count();
    assert!(figures > 10);
    assert_eq!(page.matches("<figcaption>").count(), figures);
    assert_eq!(page.matches("href=\"data:text/csv;").count(), figures);
    assert_eq!(page.matches("download=\"made-up-").count(), figures);
    assert_eq!(
        page.matches("class=\"plotly-graph-div\"").count(),
        page.matches("Plotly.newPlot(").count()
    );
}

#[test]
fn a_page_asks_for_nothing_from_outside_and_holds_its_script_once() {
    let page = made_up(2);
    assert!(page.contains(PAGE_MARK));
    assert!(
        page.contains("default-src 'none'"),
        "a browser is told to fetch nothing"
    );
    assert_eq!(page.matches("plotly.js v").count(), 1);
    // Only the script for formulas speaks of it.
    assert!(
        !page.contains("speech-rule-engine"),
        "no formulas, no script for formulas"
    );
    let own = without_library(&page);
    for outside in ["src=", "http:", "https:", "@import", "url("] {
        assert!(!own.contains(outside), "{outside}");
    }
    assert!(page.len() < 6_000_000, "{} bytes", page.len());
}

#[test]
fn the_same_results_give_the_same_page() {
    assert!(made_up(3) == made_up(3));
}

#[test]
fn hostile_names_stay_words() {
    let evil = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&";
    let topics = [evil, "request", "%{x}", "child strand"];
    let roles = ["free", evil, "networker", "worker"];
    let question = "</title><b onclick=\"x\">";
    let (hostile, plain) = (page_of(&records(2), &topics, &roles, question), made_up(2));
    let count = |page: &str, tag: &str| without_library(page).to_lowercase().matches(tag).count();
    for tag in ["<script", "</script", "<img", "<b ", "</title"] {
        assert_eq!(count(&hostile, tag), count(&plain, tag), "{tag}");
    }
    assert!(hostile.contains("&lt;/script&gt;"));
}

#[test]
fn results_without_any_traffic_still_make_a_page() {
    let silent = TrialRecord {
        ledger: Vec::new(),
        traffic: Vec::new(),
        latency: desim::metrics::LatencyHistogram::default(),
        robots: Vec::new(),
        ..record(0)
    };
    let page = page_of(&[silent], &TOPICS, &ROLES, "Nobody there?");
    assert!(!page.contains("NaN") || !without_library(&page).contains("NaN"));
}

const SMALL: &str = "// Who hears whom?\nScenario(name: \"small\", trials: 3, time_limit: 2.0, \
    swarm: (robots: 5, deploy: Uniform), protocol: Heartbeat)";

fn desim(dir: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("desim").unwrap();
    command.current_dir(dir).args(arguments);
    command
}

#[test]
fn report_repeats_the_terminal_report_and_puts_a_page_beside_the_tables() {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("small.ron"), SMALL).unwrap();
    let stdout = |arguments: &[&str]| {
        let out = desim(dir.path(), arguments).assert().success().get_output().clone();
        String::from_utf8(out.stdout).unwrap()
    };
    let first = stdout(&["scenario", "small.ron"]);
    let words = |report: &str| report.split("  results").next().unwrap().to_owned();
    let again = stdout(&["report", "results/small"]);
    assert_eq!(words(&first), words(&again));
    assert!(again.contains("report.html") && !first.contains("report.html"));

    let file = dir.path().join("results/small/report.html");
    let page = fs::read(&file).unwrap();
    assert!(String::from_utf8_lossy(&page).contains("Who hears whom?"));
    assert_eq!(
        stdout(&["report", "results/small", "--format", "json"]).into_bytes(),
        fs::read(dir.path().join("results/small/summary.json")).unwrap()
    );
    assert!(fs::read(&file).unwrap() == page, "the same results, the same bytes");

    // A page is found again where results are cleared, and no obstacle where they are reported again.
    fs::remove_file(&file).unwrap();
    stdout(&["report", "results/small", "--out", "elsewhere.html"]);
    assert!(fs::read(dir.path().join("elsewhere.html")).unwrap() == page);
    stdout(&["report", "results/small"]);
    stdout(&["scenario", "small.ron", "--force", "--quiet"]);
    assert!(!file.exists());
}

#[test]
fn report_refuses_bad_input_with_status_2_and_writes_nothing() {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("small.ron"), SMALL).unwrap();
    for (seed, out) in [("1", "a"), ("1", "b"), ("2", "c")] {
        let arguments = ["scenario", "small.ron", "--quiet", "--seed", seed, "--out", out];
        desim(dir.path(), &arguments).assert().success();
    }
    fs::write(dir.path().join("mine.txt"), "mine").unwrap();
    let cases: [(&[&str], &str); 5] = [
        (&["report", "nowhere"], "nowhere holds no results"),
        (&["report", "small.ron"], "small.ron holds no results"),
        (&["report", "a", "b"], "they hold the same trials"),
        (&["report", "a", "--out", "mine.txt"], "mine.txt is no page of desim"),
        (&["report", "a", "--out", "b"], "b is a folder"),
    ];
    for (arguments, expected) in cases {
        let out = desim(dir.path(), arguments)
            .assert()
            .code(2)
            .stdout("")
            .get_output()
            .clone();
        let message = String::from_utf8(out.stderr).unwrap();
        assert!(message.contains(expected), "{arguments:?}: {message}");
    }
    assert!(!dir.path().join("a/report.html").exists());
    assert_eq!(fs::read(dir.path().join("mine.txt")).unwrap(), b"mine");

    let pooled = desim(dir.path(), &["report", "a", "c"])
        .assert()
        .success()
        .get_output()
        .clone();
    assert!(String::from_utf8(pooled.stdout).unwrap().contains("in 6 trials"));
    assert!(String::from_utf8(pooled.stderr).unwrap().contains("--out FILE"));
    assert!(!dir.path().join("a/report.html").exists());
}

/// A rumour among ten robots in range of each other, in six trials, and its page.
fn rumour(dir: &Path, name: &str, rounds: &str, more: &str) -> String {
    let text = format!(
        "Scenario(name: \"{name}\", trials: 6, time_limit: 60.0, swarm: (robots: 10, deploy: Cluster(radius: 0.6)), \
         protocol: Rumor(rounds: {rounds}, completion: Reached), gossip: (relay: (interval: 1.0, fan_out: Peers(1))), \
         radio: (latency: Constant(0.0)), {more})"
    );
    fs::write(dir.join(format!("{name}.ron")), text).unwrap();
    desim(dir, &["scenario", &format!("{name}.ron"), "--quiet"])
        .assert()
        .success();
    desim(dir, &["report", &format!("results/{name}")]).assert().success();
    without_library(&fs::read_to_string(dir.join(format!("results/{name}/report.html"))).unwrap())
}

#[test]
fn a_rumour_has_its_closed_form_beside_it_where_that_holds_and_failures_are_marked_in_every_chart_over_time() {
    let dir = tempdir().unwrap();
    let poisson = rumour(dir.path(), "poisson", "Poisson", "");
    assert!(poisson.contains("median of the epidemic") && poisson.contains("Dashed are the median"));
    assert!(!poisson.contains("\"yaxis2\""), "nothing failed");
    // Six trials: the one in the middle and the worst by the time that the mission took.
    let command = "desim replay results/poisson --trial ";
    assert_eq!(poisson.matches(command).count(), 2);
    let failing = rumour(
        dir.path(),
        "failing",
        "Poisson",
        "faults: [Crash(robots: [3], at: 1.0, lasts: For(2.0))]",
    );
    assert!(
        !failing.contains("median of the epidemic"),
        "it does not hold with failures"
    );
    let over_time = ["\"time, s\"", "\"control steps\""].map(|axis| failing.matches(axis).count());
    let marked = failing.matches("\"yaxis2\"").count();
    assert_eq!(marked, over_time.iter().sum::<usize>(), "{over_time:?}");
    assert!(marked > 4 && failing.contains("robot 3 fails, in 6 of 6 trials"));
    assert!(!rumour(dir.path(), "periodic", "Periodic", "").contains("median of the epidemic"));
}
