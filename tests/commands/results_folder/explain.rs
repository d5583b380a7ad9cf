//! Why a robot was suspected: what is told is what happened.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use desim::engine::ActorId;
use desim::experiment::trace_trial;
use desim::export::sealed;
use desim::radio::LossCause;
use desim::report::{Explanation, Fate};
use desim::scenario::{Scenario, parse};
use desim::text::{Style, columns};
use tempfile::tempdir;
use tokio_util::sync::CancellationToken;

const ROBOTS: u32 = 6;

/// Robots that stand in range of each other and say their statuses at every tenth of a second, loss and failures of every kind as `more` has it.
fn scenario(more: &str) -> Scenario {
    let text = text(more);
    parse("still.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn text(more: &str) -> String {
    format!(
        "Scenario(name: \"still\", time_limit: 20.0, swarm: (robots: {ROBOTS}, deploy: Cluster(radius: 0.5)), \
         control: (phase: Together), protocol: Heartbeat, detector: Timeout(0.35), {more})"
    )
}

fn traced(scenario: &Scenario, robot: u32) -> (desim::metrics::TrialRecord, Explanation) {
    let record =
        trace_trial(scenario, 0, ActorId(robot), &CancellationToken::new()).expect("the trial reaches its end");
    let explanation = Explanation::of(&scenario.name, &record).expect("the robot was traced");
    (record, explanation)
}

const LOSSY: &str = "radio: (loss: Bernoulli(0.5), latency: Constant(0.03)), faults: [
    Deaf(robots: [1], at: 3.0, lasts: For(1.0)), Burst(links: Of([2]), loss: 0.9, during: Between(5.0, 7.0))]";

#[test]
fn what_is_told_of_each_robot_adds_up_to_the_table_and_to_the_ledger() {
    let scenario = scenario(LOSSY);
    let mut lost_in_all = [0; LossCause::ALL.len()];
    let mut told_in_all = 0;
    for robot in 0..ROBOTS {
        let (record, explanation) = traced(&scenario, robot);
        let mut told: BTreeMap<&str, u32> = BTreeMap::new();
        for status in explanation.suspicions.iter().flat_map(|suspicion| &suspicion.statuses) {
            let name = match status.fate {
                Fate::Lost { cause } => cause,
                Fate::OutOfRange => "out_of_range",
                Fate::UnderWay { .. } => "under_way",
                Fate::Arrived { .. } => panic!("a status that arrived was not missed: {status:?}"),
            };
            *told.entry(name).or_default() += 1;
        }
        let mut counted: BTreeMap<&str, u32> = BTreeMap::new();
        let suspicions = record.detection.suspicions.iter();
        for suspicion in suspicions.filter(|suspicion| suspicion.subject == ActorId(robot)) {
            let missed = &suspicion.missed;
            let lost = LossCause::ALL.map(LossCause::name).into_iter().zip(missed.lost);
            for (name, number) in lost.chain([("out_of_range", missed.out_of_range), ("under_way", missed.under_way)]) {
                *counted.entry(name).or_default() += number;
            }
        }
        counted.retain(|_, number| *number > 0);
        assert_eq!(told, counted, "robot {robot}");
        told_in_all += told.values().sum::<u32>();

        let copies = record
            .trace
            .iter()
            .flat_map(|trace| &trace.statuses)
            .flat_map(|status| &status.copies);
        for copy in copies {
            if let desim::metrics::detection::CopyFate::Lost(cause) = copy.fate {
                lost_in_all[cause as usize] += 1;
            }
        }
        if robot == ROBOTS - 1 {
            assert_eq!(lost_in_all, record.ledger[0].lost, "every lost status was followed");
        }
    }
    // Statuses are for all in range, over a disk: none is lost for want of it, and none to others on air.
    let causes = LossCause::ALL.into_iter().zip(lost_in_all);
    let occurs = |(cause, lost)| (lost > 0) == (cause < LossCause::BelowSensitivity);
    assert!(told_in_all > 1000 && { causes }.all(occurs), "{lost_in_all:?}");
}

/// Statuses take 0.25 s. Those of robot 0 that are sent from 1 s to 1.4 s are lost, so the last one arrives at 1.15 s and it is
/// suspected at 1.5 s, with the one of 1.4 s under way. Robot 1 is deaf when that arrives.
#[test]
fn a_status_under_way_at_a_suspicion_is_so_told_though_it_was_lost_on_its_arrival() {
    let scenario = scenario(
        "radio: (latency: Constant(0.25)), faults: [
            Burst(links: Of([0]), loss: 1.0, during: Between(0.95, 1.35)), Deaf(robots: [1], at: 1.6, lasts: For(1.0))]",
    );
    let (record, explanation) = traced(&scenario, 0);
    let missed = &record.detection.suspicions.get(0).unwrap().missed;
    assert_eq!((missed.lost[LossCause::LinkFault as usize], missed.under_way), (4, 1));
    let told = &explanation.suspicions[0];
    assert_eq!((told.observer, told.suspected_s), (1, 1.5));
    let under_way = Fate::UnderWay {
        arrives_s: 1.65,
        lost: Some(LossCause::ReceiverDown.name()),
    };
    assert_eq!(told.statuses.last().map(|status| status.fate), Some(under_way));
    let text = explanation.text(None, Style::PLAIN);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains("under way until 1.650 s, then lost: the receiver was down"),
        "{text}"
    );
}

#[test]
fn whoever_is_followed_the_run_is_the_same() {
    let scenario = scenario(LOSSY);
    let digests: Vec<_> = (0..3).map(|robot| traced(&scenario, robot).0.digest).collect();
    assert!(digests.iter().all(|digest| *digest == digests[0]));
}

/// Statuses at every tenth of a second take a tenth to arrive: the last one of a robot that is mute from 1 s to 2 s is heard
/// at 1 s, and the next one at 2.1 s.
#[test]
fn a_robot_that_was_mute_is_explained_by_that() {
    let (_, explanation) = traced(&scenario("faults: [Mute(robots: [0], at: 1.0, lasts: For(1.0))]"), 0);
    let outage = &explanation.outages[0];
    assert_eq!((outage.effect, outage.from_s, outage.until_s), ("mute", 1.0, Some(2.0)));
    assert_eq!(explanation.suspicions.len(), ROBOTS as usize - 1);
    for suspicion in &explanation.suspicions {
        assert_eq!(
            (suspicion.heard_s, suspicion.suspected_s, suspicion.trusted_s),
            (1.0, 1.35, Some(2.1))
        );
        assert_eq!((suspicion.verdict, suspicion.cause), ("right", "failure"));
        assert!(suspicion.statuses.is_empty());
        let restoring = suspicion
            .restored_by
            .as_ref()
            .map(|status| (status.sent_s, status.fate));
        let arrived = Fate::Arrived {
            arrived_s: 2.1,
            read_s: Some(2.1),
        };
        assert_eq!(restoring, Some((2.0, arrived)));
    }
    insta::assert_snapshot!(explanation.text(Some(2), Style::PLAIN));
}

/// Nothing of robot 0 passes from 1 s on: 1.0, 1.1, 1.2 and 1.3 s are lost when it is suspected at 1.35 s.
#[test]
fn a_burst_on_a_link_is_told_status_by_status() {
    let burst = "faults: [Burst(links: Of([0]), loss: 1.0, during: Between(1.0, 1.55))]";
    let (_, explanation) = traced(&scenario(burst), 0);
    let sent: Vec<f64> = explanation.suspicions[0]
        .statuses
        .iter()
        .map(|status| status.sent_s)
        .collect();
    assert_eq!(sent, [1.0, 1.1, 1.2, 1.3]);
    let cause = LossCause::LinkFault.name();
    let lost = |status: &desim::report::Status| status.fate == Fate::Lost { cause };
    assert!(
        explanation
            .suspicions
            .iter()
            .all(|suspicion| suspicion.statuses.iter().all(lost))
    );
    assert_eq!(explanation.suspicions[0].verdict, "mistake");
    insta::assert_snapshot!(explanation.text(None, Style::PLAIN));
}

#[test]
fn every_width_is_kept() {
    let (_, explanation) = traced(&scenario(LOSSY), 1);
    let widest = |text: &str| text.lines().map(columns).max();
    for width in [40, 60, 80, 120, 160] {
        let style = Style { width, ..Style::PLAIN };
        assert!(widest(&explanation.text(None, style)) <= Some(width), "{width}");
        for number in 1..explanation.suspicions.len() {
            assert!(widest(&explanation.text(Some(number), style)) <= Some(width), "{width}");
        }
    }
}

/// A manifest with the hash that desim would have given it.
fn resealed(mut manifest: serde_json::Value) -> Vec<u8> {
    manifest.as_object_mut().unwrap().shift_remove("xxh3_128");
    sealed(&manifest)
}

fn desim(dir: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("desim")
        .unwrap()
        .current_dir(dir)
        .args(arguments)
        .assert()
}

#[test]
fn the_command_explains_finished_results_and_refuses_all_others() {
    let dir = tempdir().unwrap();
    let more = "faults: [Mute(robots: [0], at: 1.0, lasts: For(1.0))]";
    fs::write(dir.path().join("still.ron"), text(more)).unwrap();
    desim(dir.path(), &["scenario", "still.ron", "--quiet", "--out", "there"]).success();
    let explain = |trial: &str, robot: &str, more: &[&str]| {
        let arguments = ["explain", "there", "--trial", trial, "--robot", robot];
        desim(dir.path(), &[&arguments, more].concat())
    };
    let output = |assert: &assert_cmd::assert::Assert| String::from_utf8(assert.get_output().stdout.clone()).unwrap();
    let error = |assert: &assert_cmd::assert::Assert| String::from_utf8(assert.get_output().stderr.clone()).unwrap();

    let told = explain("0", "0", &[]).success();
    assert_eq!(output(&told), traced(&scenario(more), 0).1.text(None, Style::PLAIN));
    let json = explain("0", "0", &["--suspicion", "2", "--format", "json"]).success();
    let json: serde_json::Value = serde_json::from_str(&output(&json)).unwrap();
    assert_eq!((&json["number"], &json["cause"]), (&2.into(), &"failure".into()));
    let never = explain("0", "3", &[]).success();
    assert_eq!(output(&never), "Robot 3 was never suspected in trial 0 of still.\n");

    for (refused, says) in [
        (explain("4", "0", &[]), "there is no trial 4"),
        (
            explain("0", "6", &[]),
            "there is no robot 6: the scenario has robots 0 to 5",
        ),
        (
            explain("0", "0", &["--suspicion", "6"]),
            "there is no suspicion 6: robot 0 was suspected 5 times",
        ),
        (
            desim(dir.path(), &["explain", "none", "--trial", "0", "--robot", "0"]),
            "there is no folder none",
        ),
        (
            desim(dir.path(), &["explain", ".", "--trial", "0", "--robot", "0"]),
            ". holds no results of desim",
        ),
    ] {
        let refused = refused.code(2);
        assert!(error(&refused).contains(says), "{}", error(&refused));
    }
}

/// A deaf robot goes on saying that it is alive, and answers no probe.
#[test]
fn a_suspicion_by_probes_is_told_as_one() {
    let dir = tempdir().unwrap();
    let text = text("faults: [Deaf(robots: [1], at: 3.0)]")
        .replace("Timeout(0.35)", "Swim(suspicion_mult: 0.0, probe_interval: 1.5)");
    fs::write(dir.path().join("still.ron"), text).unwrap();
    desim(dir.path(), &["scenario", "still.ron", "--quiet", "--out", "there"]).success();
    let told = desim(dir.path(), &["explain", "there", "--trial", "0", "--robot", "1"]).success();
    let told = String::from_utf8(told.get_output().stdout.clone()).unwrap();
    for words in [
        "Robots ran SWIM: one was",
        "mistake       unanswered",
        "It went by probes, which",
    ] {
        assert!(told.contains(words), "{words:?} not in {told}");
    }
}

#[test]
fn robots_without_statuses_are_not_explained() {
    let dir = tempdir().unwrap();
    let text = "Scenario(name: \"news\", time_limit: 60.0, swarm: (robots: 3, deploy: Cluster(radius: 0.5)), protocol: Rumor(mode: Push))";
    fs::write(dir.path().join("news.ron"), text).unwrap();
    desim(dir.path(), &["scenario", "news.ron", "--quiet", "--out", "there"]).success();
    let refused = desim(dir.path(), &["explain", "there", "--trial", "0", "--robot", "1"]).code(2);
    let error = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
    assert!(error.contains("robots that run Rumor send no statuses"), "{error}");
}

#[test]
fn a_manifest_whose_scenario_cannot_be_run_is_refused_by_its_field() {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("still.ron"), text("seed: 3")).unwrap();
    desim(dir.path(), &["scenario", "still.ron", "--quiet", "--out", "there"]).success();
    let path = dir.path().join("there/manifest.json");
    let mut manifest: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    manifest["scenario"]["swarm"]["robots"] = 0.into();
    fs::write(&path, resealed(manifest)).unwrap();
    let refused = desim(dir.path(), &["explain", "there", "--trial", "0", "--robot", "0"]).code(2);
    let error = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
    assert!(error.contains("0 is out of range for `swarm.robots`"), "{error}");
}

#[test]
fn results_of_a_run_that_this_version_runs_otherwise_are_not_explained() {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("still.ron"), text("seed: 3")).unwrap();
    desim(dir.path(), &["scenario", "still.ron", "--quiet", "--out", "there"]).success();
    let path = dir.path().join("there/manifest.json");
    let mut manifest: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    manifest["trials"][0]["digest"] = "0".repeat(32).into();
    fs::write(&path, resealed(manifest)).unwrap();
    let refused = desim(dir.path(), &["explain", "there", "--trial", "0", "--robot", "0"]).code(2);
    let error = String::from_utf8(refused.get_output().stderr.clone()).unwrap();
    assert!(error.contains("does not run trial 0 as the results have it"), "{error}");
}
