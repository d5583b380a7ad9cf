//! Figures of whole runs against their closed forms, where the end of a run, few trials or large numbers make them hard.

use std::path::Path;

use desim::engine::Span;
use desim::experiment::run_trial;
use desim::metrics::comparison::{Comparison, Design, Trials};
use desim::metrics::figures::{Figure, Registry, Samples};
use desim::metrics::{Summary, TrialRecord};
use desim::scenario::{Override, Scenario, load, parse};
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

use crate::shipped;

/// Still robots within range of each other, their clocks apart, whose statuses are followed as soon as they arrive.
fn still(robots: u32, trials: u32, seconds: f64, more: &str) -> Scenario {
    let text = format!(
        "Scenario(name: \"still\", trials: {trials}, time_limit: {seconds:?}, arena: (size: (1.0, 1.0)), \
         swarm: (robots: {robots}, deploy: Uniform), control: (period: 1.0, wake: OnReception, phase: Random), \
         protocol: Heartbeat, {more})"
    );
    read(&text)
}

fn read(text: &str) -> Scenario {
    parse("still.ron", text, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn records(scenario: &Scenario) -> Vec<TrialRecord> {
    let run = |trial| run_trial(scenario, trial, DriverKind::Inline, &CancellationToken::new());
    (0..scenario.trials)
        .map(|trial| run(trial).expect("the trial reaches its end"))
        .collect()
}

fn summary(scenario: &Scenario) -> Summary {
    Summary::of(&scenario.name, scenario.protocol.all_topics(), &[], &records(scenario))
}

#[test]
fn mistakes_under_bursts_last_as_long_as_their_closed_form_says_though_the_end_cuts_many_off() {
    // Under simple Gilbert loss E[T_M] = (m + 1/r) η − TO: 3 + 1/0.04 − 3.5 = 24.5 s, of which what lasts longer than 120 s
    // adds 0.96^116 · 25 = 0.2 s. Four standard errors; the interval's half width is some 2.1 of them.
    let loss = "GilbertElliott(good_to_bad: 0.02, bad_to_good: 0.04)";
    let scenario = still(
        2,
        96,
        120.0,
        &format!(
            "gossip: (status: (interval: 1.0)), detector: Timeout(3.5), radio: (range: 2.0, loss: {loss}, latency: Constant(0.0))"
        ),
    );
    let detection = summary(&scenario).detection;
    let found = &detection.mistake_duration_s;
    let (Some(value), [Some(low), Some(high)]) = (found.estimate.value, found.estimate.ci95) else {
        panic!("{found:?}")
    };
    let error = (high - low) / 2.0 / 2.1;
    assert!((value - 24.4).abs() < 4.0 * error && error < 3.0, "{found:?}");
    assert!(
        found.cut_off > 40 && found.cut_off < detection.mistakes.value / 2,
        "{found:?}"
    );
    let over = records(&scenario);
    let over = over
        .iter()
        .flat_map(|record| &record.detection.suspicions)
        .filter(|mistake| !mistake.cut_off);
    let over: Vec<f64> = over.filter_map(|mistake| mistake.duration.map(Span::as_secs)).collect();
    let flattering = over.iter().sum::<f64>() / over.len() as f64;
    assert!(
        flattering < value - 2.0,
        "{flattering} without what was cut off, {value} with it"
    );
}

#[test]
fn failures_that_the_end_hides_are_counted_and_said() {
    // Robot 1 falls silent at 27 s of 30: a timeout of 4.25 s cannot show it.
    let more = "gossip: (status: (interval: 1.0)), detector: Timeout(4.25), radio: (range: 2.0, loss: None, latency: Constant(0.0)), \
                faults: [Crash(robots: [1], at: 27.0)]";
    let scenario = read(&format!(
        "Scenario(name: \"late\", trials: 3, time_limit: 30.0, arena: (size: (1.0, 1.0)), swarm: (robots: 3, deploy: Uniform), \
         control: (period: 1.0, wake: OnReception), protocol: Heartbeat, {more})"
    ));
    let detection = summary(&scenario).detection;
    let time = &detection.detection_time_s;
    assert_eq!((detection.failures.observed, detection.failures.undetected), (6, 6));
    assert_eq!(
        (time.estimate.value, time.cut_off, time.restricted_to),
        (None, 6, Some(3.0))
    );
}

#[test]
fn a_robot_sends_its_status_every_step_whatever_the_phase_of_its_clock_and_the_end() {
    for (seconds, robots) in [(12.0, 5), (7.3, 4), (1.5, 3)] {
        let more = "gossip: (status: (interval: 1.0)), radio: (range: 2.0, loss: None, latency: Constant(0.0))";
        let scenario = still(robots, 4, seconds, more);
        let records = records(&scenario);
        let sent: Vec<f64> = records
            .iter()
            .flat_map(|record| record.bytes_per_step(|row| row.sent.bytes()))
            .collect();
        let status = records
            .iter()
            .flat_map(|record| &record.traffic)
            .find(|row| row.sent.frames > 0);
        let status = status.map_or(0.0, |row| row.sent.bytes() as f64 / row.sent.frames as f64);
        assert!(status > 0.0);
        for bytes in sent {
            assert!((bytes - status).abs() < 1e-12, "{bytes} B/step instead of {status}");
        }
    }
}

#[test]
fn copies_under_way_at_the_end_bias_neither_delivery_nor_latency() {
    // Three robots say 90 statuses each to two others: 540 copies a trial, 30 trials, 16,200; three in ten are lost: 0.0036 of
    // standard error. Of those that are not, latencies of mean 40 s: 40/√11,340 = 0.38 s. Most of the last 40 s are under way.
    let latency = |loss: &str| {
        format!(
            "gossip: (status: (interval: 1.0)), detector: Timeout(500.0), radio: (range: 2.0, loss: {loss}, latency: Exponential(mean: 40.0))"
        )
    };
    let lossless = summary(&still(3, 30, 90.0, &latency("None")));
    assert_eq!(lossless.delivery_ratio.estimate.value, Some(1.0));
    let under_way = lossless.frames.total.in_flight as f64 / lossless.frames.total.offered as f64;
    assert!(under_way > 0.3, "{under_way}");
    assert!(
        (lossless.latency_s.mean.value.unwrap() - 40.0).abs() < 4.0 * 0.38,
        "{:?}",
        lossless.latency_s
    );
    let lossy = summary(&still(3, 30, 90.0, &latency("Bernoulli(0.3)")));
    assert!(
        (lossy.delivery_ratio.estimate.value.unwrap() - 0.7).abs() < 4.0 * 0.0036,
        "{:?}",
        lossy.delivery_ratio
    );
    assert!(
        (lossy.latency_s.mean.value.unwrap() - 40.0).abs() < 4.0 * 0.38,
        "{:?}",
        lossy.latency_s
    );
    assert!(
        (lossy.latency_s.p50.unwrap() / (40.0 * 2.0_f64.ln()) - 1.0).abs() < 0.06,
        "{:?}",
        lossy.latency_s
    );
}

#[cfg(all(feature = "command", feature = "parquet"))]
#[test]
fn latencies_that_add_up_to_centuries_are_summed_written_and_read_back() {
    use std::fs;

    use serde_json::Value;
    use tempfile::tempdir;

    // 5 robots × 4 others × some 300 statuses of 4e6 s each: 2.4e10 s, 2.4e19 ns, above what 64 bits hold.
    let dir = tempdir().unwrap();
    let text = "Scenario(name: \"mail\", trials: 2, time_limit: 300.0, arena: (size: (1.0, 1.0)), swarm: (robots: 5, deploy: Uniform), \
                control: (period: 1.0), protocol: Heartbeat, gossip: (status: (interval: 1.0)), detector: Timeout(500.0), \
                radio: (range: 2.0, loss: None, latency: Gamma(shape: 2.0, scale: 2e6)))";
    fs::write(dir.path().join("mail.ron"), text).unwrap();
    let desim = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("desim").unwrap();
        let output = command
            .current_dir(dir.path())
            .args(arguments)
            .assert()
            .success()
            .get_output()
            .clone();
        String::from_utf8(output.stdout).unwrap()
    };
    desim(&["scenario", "mail.ron", "--quiet"]);
    let summary: Value =
        serde_json::from_slice(&fs::read(dir.path().join("results/mail/summary.json")).unwrap()).unwrap();
    let mean = summary["latency_s"]["mean"]["value"].as_f64().unwrap();
    // Of some 6,000 copies a trial: σ = √2 · 2e6 s, /√12,000 = 0.65 % of the mean.
    assert!((mean / 4e6 - 1.0).abs() < 4.0 * 0.0065, "{mean}");
    let report = desim(&["report", "results/mail"]);
    assert!(report.contains("Radio"), "{report}");
}

/// What `records` of one setting tell, by the comparison.
fn compared(registry: &Registry, records: &[TrialRecord]) -> Comparison {
    let figures: Vec<Figure> = registry.figures().cloned().collect();
    let mut samples = Samples::new(figures.len());
    for record in records {
        samples.push(&registry.read(record));
    }
    let trials = Trials {
        name: "one".into(),
        label: "one".into(),
        levels: Vec::new(),
        seed: 1,
        samples: samples.into(),
        places: (0..figures.len()).collect(),
    };
    let design = Design {
        study: "one".into(),
        question: None,
        factors: Vec::new(),
        figures,
        compared: vec![0],
        reference: None,
        relevant: 0.05,
        pareto: None,
    };
    Comparison::of(&design, &[trials], None)
}

#[test]
fn every_figure_that_summary_and_comparison_share_has_the_same_value_and_interval_in_both() {
    let mut shared = 0;
    for file in shipped::files() {
        let set = ["trials=3", "time_limit=12.0"].map(|set: &str| set.parse::<Override>().expect("a valid override"));
        let Ok(scenario) = load(Path::new(&file), &set) else {
            continue;
        };
        let records = records(&scenario);
        let topics = scenario.protocol.all_topics();
        let summary = serde_json::to_value(Summary::of(&scenario.name, topics, &[], &records)).unwrap();
        let comparison = compared(&Registry::of(topics), &records);
        for (key, figure) in &comparison.settings[0].figures.0 {
            let place = key.split('.').try_fold(&summary, |place, part| place.get(part));
            let Some(stated) = place.filter(|place| place.get("ci95").is_some()) else {
                continue;
            };
            let found = serde_json::to_value(figure.estimate).unwrap();
            for part in ["value", "ci95", "n"] {
                assert_eq!(stated[part], found[part], "{key} of {}: {part}", file.display());
            }
            shared += 1;
        }
    }
    // 24 files and more with some twenty figures each.
    assert!(shared > 400, "{shared} figures were compared");
}
