//! Scenario files: what ships is well, overrides reach every field, and what is wrong is named where it stands.

use std::fs;
use std::path::PathBuf;

use desim::cli::check::{Say, check};
use desim::kinds::backbone::BackboneConfig;
use desim::protocol::CompletionConfig;
use desim::protocol::TargetsConfig;
use desim::radio::{LatencyConfig, LossConfig};
use desim::scenario::{Override, Report, Scenario, Style, examine, json_schema, load, parse, question, to_ron};

use crate::shipped;

const BASE: &str = r#"// Does it work?
Scenario(
    name: "base",
    time_limit: 60.0,
    swarm: (robots: 40, deploy: Cluster(radius: 1.5)),
    protocol: Backbone(targets: Ring(count: 4, radius: 4.5, links: 2)),
    radio: (range: 2.0, loss: Bernoulli(0.2)),
)
"#;

fn read(text: &str, overrides: &[&str]) -> Result<Scenario, Report> {
    let overrides: Vec<Override> = overrides.iter().map(|text| text.parse()).collect::<Result<_, _>>()?;
    parse("base.ron", text, &overrides)
}

fn with(overrides: &[&str]) -> Scenario {
    read(BASE, overrides).unwrap_or_else(|report| panic!("{report}"))
}

/// What a person sees of `BASE` with `from` changed to `to`.
fn shown(from: &str, to: &str) -> String {
    assert!(BASE.contains(from));
    read(&BASE.replace(from, to), &[])
        .expect_err("the scenario is wrong")
        .to_string()
}

fn refused(overrides: &[&str]) -> String {
    read(BASE, overrides).expect_err("the override is wrong").to_string()
}

#[test]
fn every_shipped_scenario_is_well_and_begins_with_its_question() {
    for path in shipped::files() {
        let text = fs::read_to_string(&path).unwrap();
        let scenario = load(&path, &[]).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(path.file_stem().unwrap().to_str(), Some(scenario.name.as_str()));
        assert!(
            question(&text).is_some_and(|question| question.ends_with('?')),
            "{}",
            path.display()
        );
    }
}

#[test]
fn every_shipped_scenario_holds_against_the_schema() {
    let validator = jsonschema::validator_for(json_schema().as_value()).unwrap();
    for path in shipped::files() {
        let json = serde_json::to_value(load(&path, &[]).unwrap()).unwrap();
        let faults: Vec<_> = validator.iter_errors(&json).map(|fault| fault.to_string()).collect();
        assert!(faults.is_empty(), "{}: {faults:?}", path.display());
    }
}

#[test]
fn the_schema_states_ranges_and_refuses_what_lies_beyond() {
    let validator = jsonschema::validator_for(json_schema().as_value()).unwrap();
    let well = serde_json::to_value(with(&[])).unwrap();
    for (field, bad) in [
        ("/trials", 0.into()),
        ("/swarm/robots", 2_000_000.into()),
        ("/radio/loss/Bernoulli", 1.5.into()),
        ("/radio/range", 0.into()),
        ("/name", "a/b".into()),
        ("/protocol/Backbone/targets", "Ring".into()),
        ("/protocol/Backbone/targets/Ring/links", 0.into()),
    ] {
        let mut json = well.clone();
        *json.pointer_mut(field).unwrap() = bad;
        assert!(!validator.is_valid(&json), "{field}");
    }
    let mut unknown = well;
    unknown["radio"]["los"] = 1.into();
    assert!(!validator.is_valid(&unknown));
}

#[test]
fn a_resolved_scenario_reads_back_to_an_equal_one_that_resolves_to_the_same_text() {
    for path in shipped::files() {
        let scenario = load(&path, &[]).unwrap();
        let text = to_ron(&scenario);
        let again = parse("resolved.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(again, scenario);
        assert_eq!(to_ron(&again), text);
    }
}

#[test]
fn an_override_sets_a_field_that_the_file_has_with_or_without_the_names_of_variants() {
    for given in ["protocol.targets.links=3", "protocol.Backbone.targets.Ring.links=3"] {
        let protocol = with(&[given]).protocol;
        let backbone: &BackboneConfig = protocol.as_kind().expect("the protocol has not changed");
        assert!(matches!(
            backbone.targets,
            TargetsConfig::Ring { count: 4, links: 3, .. }
        ));
    }
    assert_eq!(with(&["swarm.robots=60"]).swarm.robots, 60);
    let LossConfig::Bernoulli(loss) = with(&["radio.loss.Bernoulli=0.3"]).radio.disk().loss else {
        panic!("the loss model has changed");
    };
    assert!((loss.get() - 0.3).abs() < 1e-12);
}

#[test]
fn an_override_sets_a_field_that_the_file_leaves_out_and_keeps_the_defaults_around_it() {
    let plain = with(&[]);
    let tuned = with(&["motion.linear.p=3", "arena.size[1]=20", "metrics.hold=1", "trials=5"]);
    assert!((tuned.motion.linear.p.get() - 3.0).abs() < 1e-12);
    assert_eq!(tuned.motion.angular, plain.motion.angular);
    assert_eq!(tuned.arena.size.0, plain.arena.size.0);
    assert!((tuned.arena.size.1.get() - 20.0).abs() < 1e-12);
    assert_eq!(tuned.trials, 5);
}

#[test]
fn an_override_replaces_a_whole_value_and_the_last_one_counts() {
    let scenario = with(&[
        "radio.latency=Constant(0.3)",
        "radio.latency=LogNormal(median: 0.02, sigma: 0.5)",
    ]);
    assert!(matches!(scenario.radio.disk().latency, LatencyConfig::LogNormal { .. }));
    assert_eq!(with(&["name=other"]).name, "other");
    assert_eq!(with(&["name=\"other\""]).name, "other");
}

#[test]
fn an_override_can_mend_what_the_file_lacks() {
    let text = BASE.replace("    time_limit: 60.0,\n", "");
    assert!(read(&text, &[]).is_err());
    assert!(read(&text, &["time_limit=60"]).is_ok());
}

#[test]
fn an_override_cannot_break_out_of_its_place() {
    for given in [
        "trials=1, seed: 2",
        "trials=1)",
        "trials=1 // (",
        "trials=(1",
        "trials=\"",
        "trials=/*",
    ] {
        match read(BASE, &[given]) {
            Ok(scenario) => assert_eq!((scenario.trials, scenario.seed), (1, 1), "{given}"),
            Err(report) => assert!(report.to_string().contains("--set"), "{report}"),
        }
    }
}

#[test]
fn every_diagnostic_has_line_column_and_path() {
    let report = read(&BASE.replace("loss:", "los:").replace("60.0", "-60"), &[]).unwrap_err();
    let found = report.diagnostics.iter().map(|found| {
        let place = found.place.as_ref().unwrap();
        (found.path.as_deref().unwrap(), place.line, place.column)
    });
    assert_eq!(found.collect::<Vec<_>>(), [("time_limit", 4, 17), ("radio.los", 7, 25)]);
}

#[test]
fn columns_are_counted_in_letters_however_many_bytes_they_have() {
    let report = read(&BASE.replace("loss:", "/* é漢🤖 */ los:"), &[]).unwrap_err();
    let place = report.diagnostics[0].place.as_ref().unwrap();
    assert_eq!((place.line, place.column), (7, 25 + 10));
    assert!(report.to_string().contains("/* é漢🤖 */ los"), "{report}");
}

#[test]
fn a_fault_is_underlined_for_as_long_as_the_signs_in_it_are_shown() {
    let shown = shown("\"base\"", "\"a\u{1b}\u{1b}b\"");
    let under = shown.lines().skip_while(|line| !line.contains("\"a␛␛b\"")).nth(1);
    let under = under.unwrap_or_else(|| panic!("{shown}"));
    assert_eq!(under.matches(['─', '┬']).count(), "\"a␛␛b\"".chars().count(), "{shown}");
}

#[test]
fn all_that_is_wrong_is_named_at_once_and_nothing_that_follows_from_it() {
    let text = BASE
        .replace("robots: 40", "robot: 40")
        .replace("links: 2", "links: two")
        .replace("name: \"base\"", "name: \"a b\"")
        .replace("range: 2.0", "range: -2.0, latency: LogNormal(median: 0.1)")
        .replace("60.0", "60.0, control: (period: 0.25), motion: (tick: 0.1, speed: 1)");
    insta::assert_snapshot!(read(&text, &[]).unwrap_err().to_string());
}

#[test]
fn a_relation_between_fields_is_reported_beside_a_fault_that_it_does_not_depend_on() {
    let report = read(&BASE.replace("loss:", "los:").replace("60.0", "5.0"), &[]).unwrap_err();
    let messages: Vec<_> = report.diagnostics.iter().map(|found| found.message.as_str()).collect();
    assert_eq!(messages.len(), 2, "{messages:?}");
    let report = read(&BASE.replace("60.0", "5.0, metrics: (hold: -1)"), &[]).unwrap_err();
    assert_eq!(report.diagnostics.len(), 1, "{report}");
}

#[test]
fn a_scenario_beyond_the_means_of_a_machine_is_refused() {
    for given in [
        &["swarm.robots=1000001"][..],
        &["trials=0"],
        &["time_limit=1e300"],
        &["control.period=1e-9"],
        &["motion.tick=1e-300"],
        &["metrics.sample_interval=1e-5", "swarm.robots=1000"],
        &["time_limit=1e6", "swarm.robots=100000"],
        &["radio.range=1e9", "swarm.robots=1000000", "swarm.deploy=Uniform"],
        &["gossip.status.interval=1e-12"],
        &["arena.size=(1e39, 5)"],
        &["arena.size[1]=2e9"],
    ] {
        assert!(read(BASE, given).is_err(), "{given:?}");
    }
}

#[test]
fn what_grows_beyond_a_machine_is_refused_with_the_bytes_and_the_field_and_what_is_large_is_warned_of() {
    let heartbeat = "protocol=Heartbeat";
    let lossy = [heartbeat, "detector=Timeout(0.15)", "radio.loss=Bernoulli(0.4)"];
    for (given, field, what) in [
        // 40 robots in a cluster, all in range: 1,560 pairs err (1 − p) p / η = 2.4 times a second each.
        (vec!["time_limit=2.4e5"], "time_limit", "for suspicions"),
        (
            vec!["radio.loss=None", "time_limit=8e5", "metrics.sample_interval=0.001"],
            "metrics.sample_interval",
            "for samples",
        ),
        (vec!["trials=1000000"], "trials", "for the other trials"),
        (
            vec![
                "radio.latency=Constant(9900)",
                "time_limit=10000",
                "detector=Timeout(9)",
            ],
            "radio.latency",
            "under way",
        ),
        (
            vec![
                "detector=Timeout(16)",
                "radio.loss=None",
                "gossip.status.interval=5",
                "swarm.robots=500000",
                "swarm.deploy=Uniform",
                "arena.size=(200, 200)",
                "metrics.sample_interval=0",
            ],
            "swarm.robots",
            "whom they hear",
        ),
        (
            vec![
                "detector=Timeout(1)",
                "swarm.robots=1000000",
                "swarm.deploy=Uniform",
                "arena.size=(1030, 1030)",
                "metrics.sample_interval=10",
            ],
            "metrics.sample_interval",
            "for λ₂ of their graph",
        ),
    ] {
        let all: Vec<&str> = lossy.iter().copied().chain(given.iter().copied()).collect();
        let report = read(BASE, &all).expect_err(what);
        let found = report
            .diagnostics
            .iter()
            .find(|found| found.path.as_deref() == Some(field));
        let found = found.unwrap_or_else(|| panic!("{given:?}: {report}"));
        assert!(
            found.message.contains("B of memory") && found.message.contains(what),
            "{report}"
        );
        assert!(found.help.is_some());
    }
    let warned = |given: &[&str]| {
        let given: Vec<Override> = given.iter().map(|text| text.parse().unwrap()).collect();
        let warnings = examine("base.ron", BASE, &given).unwrap().1;
        warnings
            .diagnostics
            .into_iter()
            .map(|found| found.message)
            .collect::<Vec<_>>()
    };
    let large: Vec<&str> = lossy.iter().copied().chain(["time_limit=3e4"]).collect();
    assert!(
        warned(&large).iter().any(|message| message.contains("GB of memory")),
        "{:?}",
        warned(&large)
    );
    let small: Vec<&str> = lossy.iter().copied().chain(["time_limit=400"]).collect();
    assert_eq!(warned(&small), [] as [String; 0]);
}

#[test]
fn more_events_than_weeks_hold_are_refused_and_those_of_days_are_warned_of() {
    // 1,000 robots of which each tells 64 rumours to some hundred others, a million times a second.
    let rumour = [
        "protocol=Rumor(rounds: Poisson, sources: Random(64))",
        "swarm.robots=1000",
        "swarm.deploy=Uniform",
    ];
    let rounds = |interval: &'static str| {
        [
            &rumour[..],
            &[
                interval,
                "radio.latency=Constant(0)",
                "radio.range=3",
                "control.wake=OnReception",
            ],
        ]
        .concat()
    };
    let report = read(BASE, &rounds("gossip.relay.interval=1e-6")).expect_err("that takes months");
    assert!(
        report.to_string().contains("events, which would take weeks"),
        "{report}"
    );
    let given: Vec<Override> = rounds("gossip.relay.interval=2e-4")
        .iter()
        .map(|text| text.parse().unwrap())
        .collect();
    let warnings = examine("base.ron", BASE, &given).unwrap().1;
    assert!(
        warnings.render(Style::PLAIN).contains("which may take days"),
        "{warnings:?}"
    );
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let report = load(&PathBuf::from("scenarios/none.ron"), &[]).unwrap_err();
    assert!(
        report.diagnostics[0]
            .message
            .starts_with("scenarios/none.ron: cannot be read")
    );
    assert!(load(&PathBuf::from("scenarios"), &[]).is_err());
}

#[test]
fn text_that_is_not_utf8_is_refused_at_its_first_bad_byte() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.ron");
    fs::write(&path, b"// \xff\nScenario()").unwrap();
    let report = load(&path, &[]).unwrap_err();
    assert_eq!(
        report.diagnostics[0]
            .place
            .as_ref()
            .map(|place| (place.line, place.column)),
        Some((1, 4))
    );
    fs::write(&path, [b"\xef\xbb\xbf", BASE.replace('\n', "\r\n").as_bytes()].concat()).unwrap();
    assert!(
        load(&path, &[]).is_ok(),
        "a byte order mark and carriage returns do no harm"
    );
}

#[test]
fn the_mistake_of_an_unknown_field() {
    insta::assert_snapshot!(shown("loss:", "los:"));
}

#[test]
fn the_mistake_of_a_field_in_the_wrong_part() {
    insta::assert_snapshot!(shown("robots: 40,", "robots: 40, max_speed: 0.05,"));
}

#[test]
fn the_mistake_of_an_unknown_model() {
    insta::assert_snapshot!(shown("Bernoulli", "Bernouli"));
}

#[test]
fn the_mistake_of_a_number_out_of_range() {
    insta::assert_snapshot!(shown("Bernoulli(0.2)", "Bernoulli(20)"));
}

#[test]
fn the_mistake_of_text_for_a_number() {
    insta::assert_snapshot!(shown("range: 2.0", "range: \"2 m\""));
}

#[test]
fn the_mistake_of_a_unit_after_a_number() {
    insta::assert_snapshot!(shown("range: 2.0", "range: 2.0 m"));
}

#[test]
fn the_mistake_of_a_fraction_of_a_robot() {
    insta::assert_snapshot!(shown("robots: 40", "robots: 40.5"));
}

#[test]
fn the_mistake_of_a_missing_field() {
    insta::assert_snapshot!(shown("radius: 4.5, ", ""));
}

#[test]
fn the_mistake_of_a_missing_comma() {
    insta::assert_snapshot!(shown("60.0,", "60.0"));
}

#[test]
fn the_mistake_of_a_missing_bracket() {
    insta::assert_snapshot!(shown("links: 2))", "links: 2)"));
}

#[test]
fn the_mistake_of_a_field_given_twice() {
    insta::assert_snapshot!(shown("range: 2.0", "range: 2.0, range: 3.0"));
}

#[test]
fn the_mistake_of_a_model_without_its_number() {
    insta::assert_snapshot!(shown("Bernoulli(0.2)", "Bernoulli"));
}

#[test]
fn the_mistake_of_too_many_brackets() {
    insta::assert_snapshot!(shown(
        "Ring(count: 4, radius: 4.5, links: 2)",
        "Ring((count: 4, radius: 4.5, links: 2))"
    ));
}

#[test]
fn the_mistake_of_another_kind_of_value() {
    insta::assert_snapshot!(shown("Bernoulli(0.2)", "0.2"));
}

#[test]
fn a_hold_said_in_the_metrics_is_the_protocols_completion() {
    let completion = |sets: &[&str]| with(sets).completion();
    let held = |seconds| CompletionConfig::Held(desim::quantity::NonNegative::new(seconds));
    assert_eq!(completion(&[]), held(10.0));
    assert_eq!(completion(&["metrics.hold=2.5"]), held(2.5));
    assert_eq!(completion(&["protocol.completion=Held(4)"]), held(4.0));
    assert_eq!(
        completion(&["protocol.completion=EachVisited"]),
        CompletionConfig::EachVisited
    );
    let older = with(&["metrics.hold=2.5"]);
    assert_eq!(
        older,
        with(&["protocol.completion=Held(2.5)"]),
        "said one way, and another"
    );
    assert!(to_ron(&older).contains("completion: Held(2.5)"));
}

#[test]
fn the_mistake_of_two_ways_to_say_when_a_mission_is_complete() {
    insta::assert_snapshot!(refused(&["metrics.hold=1.0", "protocol.completion=Reached"]));
}

#[test]
fn the_mistake_of_a_mission_that_cannot_complete() {
    insta::assert_snapshot!(shown("time_limit: 60.0", "time_limit: 6.0"));
}

#[test]
fn the_mistake_of_statuses_rarer_than_the_timeout_bears() {
    insta::assert_snapshot!(refused(&["detector=Timeout(0.5)", "gossip.status.interval=0.45"]));
}

#[test]
fn the_mistake_of_intervals_that_phi_accrual_assumes_too_short() {
    insta::assert_snapshot!(refused(&[
        "detector=PhiAccrual(dialect: Chitchat, initial_interval: Seconds(0.05))",
        "gossip.status.interval=0.5"
    ]));
}

#[test]
fn the_mistake_of_statuses_that_come_too_late_to_count() {
    insta::assert_snapshot!(refused(&["detector=NfdS(shift: 0.05)", "radio.latency=Constant(0.06)"]));
}

#[test]
fn the_mistake_of_a_setting_of_another_dialect() {
    insta::assert_snapshot!(refused(&[
        "detector=PhiAccrual(dialect: Cassandra, acceptable_pause: Seconds(3.0))"
    ]));
}

#[test]
fn the_mistake_of_a_probe_that_nobody_can_answer_in_time() {
    insta::assert_snapshot!(refused(&["detector=Swim(probe_interval: 0.3, probe_timeout: 0.1)"]));
}

#[test]
fn the_mistake_of_no_time_for_answers_through_others() {
    insta::assert_snapshot!(refused(&["detector=Swim(probe_interval: 0.9, probe_timeout: 0.4)"]));
}

#[test]
fn the_mistake_of_an_override_with_an_unknown_field() {
    insta::assert_snapshot!(refused(&["radio.los=Bernoulli(0.3)"]));
}

#[test]
fn the_mistake_of_an_override_into_another_model() {
    insta::assert_snapshot!(refused(&["radio.latency.median=0.02"]));
}

#[test]
fn the_mistake_of_an_override_without_a_value() {
    insta::assert_snapshot!(refused(&["radio.loss"]));
}

fn checked(files: &[PathBuf], overrides: &[&str], resolved: bool) -> (bool, String) {
    let overrides: Vec<_> = overrides.iter().map(|text| (*text).to_owned()).collect();
    let mut out = Vec::new();
    let say = if resolved { Say::Resolved } else { Say::Well };
    let well = check(files, &overrides, say, None, &mut out).unwrap();
    (well, String::from_utf8(out).unwrap())
}

#[test]
fn check_names_the_faults_of_every_file_and_then_those_that_are_well() {
    let folder = tempfile::tempdir().unwrap();
    let files = ["a.ron", "b.ron", "c.ron"].map(|name| folder.path().join(name));
    fs::write(&files[0], BASE.replace("loss:", "los:")).unwrap();
    fs::write(&files[1], BASE).unwrap();
    fs::write(
        &files[2],
        BASE.replace("range:", "rang:").replace("robots: 40", "robots: 0"),
    )
    .unwrap();
    let (well, text) = checked(&files, &[], false);
    let order = [
        "unknown field `los`",
        "0 is out of range",
        "unknown field `rang`",
        "ok ",
    ]
    .map(|words| text.find(words));
    assert!(
        !well && order.iter().all(Option::is_some) && order.is_sorted(),
        "{text}"
    );
    assert!(text.ends_with("b.ron: base, 1 trial, 40 robots\n"), "{text}");
}

#[test]
fn check_resolved_writes_a_scenario_file_with_its_question() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("base.ron");
    fs::write(&file, BASE).unwrap();
    let (well, text) = checked(&[file], &["radio.range=3"], true);
    assert!(well);
    assert_eq!(question(&text).as_deref(), Some("Does it work?"));
    assert_eq!(read(&text, &[]).unwrap(), with(&["radio.range=3"]));
}

#[test]
fn check_refuses_overrides_that_are_none_before_it_reads_files() {
    let (well, text) = checked(&[PathBuf::from("none.ron")], &["a", "b"], false);
    assert!(
        !well && text.contains("--set a: no `=`") && text.contains("--set b: no `=`") && !text.contains("none.ron")
    );
}

#[test]
fn the_schema_is_printed_as_json() {
    let mut out = Vec::new();
    desim::cli::schema::schema(false, &mut out).unwrap();
    let printed: serde_json::Value = serde_json::from_slice(&out).unwrap();
    assert_eq!(&printed, json_schema().as_value());
}

/// What the command says of `BASE` with these lines in place of its mission, and its exit status.
fn said(command: &[&str], sections: &str) -> (Option<i32>, String, String) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("base.ron");
    let mission = "protocol: Backbone(targets: Ring(count: 4, radius: 4.5, links: 2)),";
    fs::write(&file, BASE.replace(mission, sections)).unwrap();
    let mut desim = assert_cmd::Command::cargo_bin("desim").unwrap();
    let output = desim
        .args(command)
        .arg(&file)
        .current_dir(folder.path())
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let left = fs::read_dir(folder.path()).unwrap().count();
    assert!(
        output.status.code() != Some(2) || left == 1,
        "something was left behind"
    );
    (output.status.code(), text(output.stdout), text(output.stderr))
}

const UNREAD: &str = "protocol: Heartbeat, motion: (max_speed: 0.05),";

#[test]
fn a_warning_is_printed_with_place_and_remedy_and_leaves_the_exit_status_0() {
    let (status, out, _) = said(&["check"], UNREAD);
    assert_eq!(status, Some(0));
    for part in [
        "warning: `motion.max_speed` is set",
        "base.ron:6:",
        "leave `motion.max_speed` out",
        "ok ",
    ] {
        assert!(out.contains(part), "{part}: {out}");
    }
    let (status, out, err) = said(&["scenario", "--quiet", "--set", "time_limit=2"], UNREAD);
    assert_eq!((status, out.as_str()), (Some(0), ""));
    assert!(
        err.contains("warning: `motion.max_speed`") && err.contains("base.ron:6:"),
        "{err}"
    );
}

#[test]
fn warnings_that_are_denied_end_in_exit_status_2_and_nothing_is_written() {
    for command in ["check", "scenario"] {
        let (status, out, err) = said(&[command, "--deny", "warnings"], UNREAD);
        let all = format!("{out}{err}");
        assert_eq!(status, Some(2), "{all}");
        assert!(
            all.contains("error: 1 warning, and warnings are denied") && !all.contains("ok "),
            "{all}"
        );
    }
}

#[test]
fn warnings_of_a_resolved_scenario_stay_out_of_its_text_and_those_of_json_are_in_it() {
    let (status, out, err) = said(&["check", "--resolved"], UNREAD);
    assert!(status == Some(0) && read(&out, &[]).is_ok(), "{out}");
    assert!(err.contains("warning: `motion.max_speed`"), "{err}");
    let (_, out, _) = said(&["check", "--predict", "--format", "json"], UNREAD);
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    let warning = &json[0]["warnings"][0];
    assert_eq!(
        (&warning["path"], &warning["line"]),
        (&"motion.max_speed".into(), &6.into())
    );
    assert!(json[0]["predictions"].is_array() && warning["help"].is_string());
}
