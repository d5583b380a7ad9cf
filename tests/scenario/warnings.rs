//! What is allowed and hardly meant is warned of where it stands; what ships is free of it.

use desim::scenario::{Warnings, contents, examine};

use crate::shipped;

const BACKBONE: &str = "Backbone(targets: Ring(count: 3, radius: 3.0))";
const RUMOR: &str = "Rumor(mode: PushPull, sources: Robots([3]))";

/// The warnings about 30 robots with this protocol, these sections and this deployment, and with nothing else to warn of.
fn deployed(protocol: &str, deploy: &str, sections: &str) -> Warnings {
    let text = format!(
        "Scenario(name: \"a\", time_limit: 300.0, swarm: (robots: 30, deploy: {deploy}), protocol: {protocol}, {sections})"
    );
    examine("a.ron", &text, &[])
        .unwrap_or_else(|report| panic!("{report}"))
        .1
}

fn warned(protocol: &str, sections: &str) -> Warnings {
    deployed(protocol, "Cluster(radius: 0.9)", sections)
}

/// The fields that are warned of.
fn fields(warnings: &Warnings) -> Vec<&str> {
    let paths = warnings
        .diagnostics
        .iter()
        .map(|found| found.path.as_deref().unwrap_or(""));
    paths.collect()
}

fn assert_warned(protocol: &str, sections: &str, field: &str, words: &str) {
    let found = warned(protocol, sections);
    assert_eq!(fields(&found), [field], "{sections}: {found:?}");
    let diagnostic = &found.diagnostics[0];
    assert!(diagnostic.message.contains(words), "{sections}: {}", diagnostic.message);
    assert!(diagnostic.help.is_some() && diagnostic.place.is_some());
}

#[test]
fn no_shipped_scenario_is_warned_of_but_the_one_that_asks_what_too_few_robots_do() {
    for path in shipped::files() {
        let name = path.display().to_string();
        let warnings = examine(&name, &contents(&path).unwrap(), &[]).unwrap().1;
        let expected: &[&str] = if name.ends_with("shortage.ron") {
            &["swarm.robots"]
        } else {
            &[]
        };
        assert_eq!(
            fields(&warnings),
            expected,
            "{}",
            warnings.render(desim::scenario::Style::PLAIN)
        );
    }
}

#[test]
fn no_setting_of_a_shipped_study_is_warned_of() {
    for path in shipped::studies() {
        let plan = desim::scenario::load_study(&path).unwrap();
        let warnings = plan.all_warnings();
        assert!(
            warnings.is_empty(),
            "{}",
            warnings.render(desim::scenario::Style::PLAIN)
        );
    }
}

#[test]
fn sound_settings_of_each_protocol_are_not_warned_of() {
    for (protocol, sections) in [
        (
            BACKBONE,
            "radio: (sensing: (range_noise: 0.01)), metrics: (hold: 20.0), motion: (max_speed: 0.05)",
        ),
        (
            "Heartbeat",
            "wander: RandomWalk(speed: 0.02, leg: 5.0), motion: (max_turn_rate: 90.0, max_speed: 0.3)",
        ),
        (
            "Heartbeat",
            "faults: [Crash(robots: [0], at: 290.0), Partition(line: ((1, -1), (1, 1)), during: From(299.0))]",
        ),
        (
            "Heartbeat",
            "radio: (latency: Exponential(mean: 0.8)), detector: Timeout(4.0)",
        ),
        (RUMOR, "gossip: (relay: (interval: 0.3)), metrics: (hold: 5.0)"),
    ] {
        let found = warned(protocol, sections);
        assert!(found.is_empty(), "{sections}: {found:?}");
    }
}

#[test]
fn a_setting_that_nothing_reads_is_warned_of() {
    for (protocol, sections, field) in [
        ("Heartbeat", "radio: (sensing: (bearing_noise: 2.0))", "radio.sensing"),
        (RUMOR, "radio: (sensing: (range_noise: 0.02))", "radio.sensing"),
        (RUMOR, "motion: (max_speed: 0.4)", "motion.max_speed"),
        ("Heartbeat", "motion: (angular: (p: 3.0))", "motion.angular"),
        (
            "Heartbeat",
            "motion: (proximity_range: 0.5), wander: RandomWaypoint(speed: 0.02)",
            "motion.proximity_range",
        ),
        ("Heartbeat", "metrics: (hold: 30.0)", "metrics.hold"),
        (
            BACKBONE,
            "metrics: (sample_interval: 0.0, series_every: 4)",
            "metrics.series_every",
        ),
    ] {
        assert_warned(protocol, sections, field, "nothing reads it");
    }
}

#[test]
fn a_fault_that_can_never_act_is_warned_of_with_the_reason() {
    let corner = "within: Disc(at: (6.0, 6.0), radius: 1.4)";
    let radiation = format!("faults: [Radiation({corner}, hazard: 0.1)]");
    for (protocol, sections, field, why) in [
        (
            "Heartbeat",
            "faults: [Mute(robots: [4], at: 300.0)]",
            "faults[0].at",
            "comes at 300 s",
        ),
        (
            RUMOR,
            "faults: [Crash(robots: [4], at: 9.0), Deaf(robots: [1], at: 1e9)]",
            "faults[1].at",
            "ends at 300 s",
        ),
        (
            "Heartbeat",
            "faults: [Burst(loss: 0.5, during: Between(300, 301))]",
            "faults[0].during",
            "begins at 300 s",
        ),
        (
            "Heartbeat",
            "faults: [Burst(links: Of([2]), loss: 0.0)]",
            "faults[0].loss",
            "probability is 0",
        ),
        (
            BACKBONE,
            "faults: [Fallible(share: 0.5, hazard: 0)]",
            "faults[0].hazard",
            "probability is 0",
        ),
        (
            BACKBONE,
            "faults: [OnJoin(probability: 0, window: 5)]",
            "faults[0].probability",
            "probability is 0",
        ),
        // The nearest place of a centre is (4.93, 4.93): 1.513 m from (6, 6).
        (RUMOR, &radiation, "faults[0].within", "outside"),
        (
            "Heartbeat",
            "faults: [Robots(effect: Crash, within: Rectangle(at: (0, -7), size: (20, 4)), when: At(5))]",
            "faults[0].within",
            "outside",
        ),
        (
            "Heartbeat",
            "faults: [Partition(line: ((-11, 0), (0, 11)))]",
            "faults[0].line",
            "one side",
        ),
        (
            BACKBONE,
            "faults: [Robots(effect: Mute, robots: Given([0]), roles: [\"worker\"], when: At(5))]",
            "faults[0].roles",
            "always the root",
        ),
        (
            BACKBONE,
            "faults: [Robots(effect: Mute, robots: Given([4, 5]), roles: [\"root\"], when: At(5))]",
            "faults[0].roles",
            "only robot 0",
        ),
        (
            "Heartbeat",
            "faults: [Crash(robots: [4], at: 5, lasts: For(1e-10))]",
            "faults[0].lasts",
            "over as it begins",
        ),
    ] {
        assert_warned(protocol, sections, field, why);
    }
    let rim = radiation.replace("1.4", "1.52");
    assert!(warned(RUMOR, &rim).is_empty());
}

#[test]
fn what_takes_longer_than_a_trial_is_warned_of() {
    for (protocol, sections, field, words) in [
        (
            "Heartbeat",
            "detector: Timeout(300.0)",
            "detector",
            "nobody is ever suspected",
        ),
        (
            BACKBONE,
            "detector: NfdS(shift: 299.95)",
            "detector",
            "nobody is ever suspected",
        ),
        (
            "Heartbeat",
            "detector: PhiAccrual(dialect: Cassandra, threshold: 2000.0)",
            "detector",
            "nobody is ever suspected",
        ),
        (
            "Heartbeat",
            "metrics: (sample_interval: 301.0)",
            "metrics.sample_interval",
            "only its start",
        ),
        (
            RUMOR,
            "metrics: (series_every: 400)",
            "metrics.series_every",
            "there is none",
        ),
        (
            RUMOR,
            "gossip: (relay: (interval: 400.0))",
            "gossip.relay.interval",
            "nothing is said twice",
        ),
        (
            "Heartbeat",
            "wander: RandomWaypoint(speed: 0.02, pause: 300.0)",
            "wander",
            "rests",
        ),
        (
            "Heartbeat",
            "wander: RandomWalk(speed: 0.0004, leg: 9.0)",
            "wander",
            "0.120 m",
        ),
        // 297.5 + 3 s.
        (
            "Heartbeat",
            "detector: Timeout(3.0), faults: [Crash(robots: [1], at: 297.5)]",
            "faults[0]",
            "after the end",
        ),
    ] {
        assert_warned(protocol, sections, field, words);
    }
    assert!(
        warned(
            "Heartbeat",
            "detector: Timeout(3.0), faults: [Crash(robots: [1], at: 296.5)]"
        )
        .is_empty()
    );
}

/// Of exponential latency of mean d: the share above a timeout TO is e^(−TO/d); the share under way at the end of T is
/// d/T (1 − e^(−T/d)).
#[test]
fn latencies_beyond_a_detector_or_a_trial_are_warned_of_with_their_share() {
    // e^(−4/1.5) = 6.9 %; e^(−4/0.8) = 0.7 % is borne.
    assert_warned(
        "Heartbeat",
        "radio: (latency: Exponential(mean: 1.5))",
        "radio.latency",
        "7 % of statuses",
    );
    assert_warned(
        "Heartbeat",
        "radio: (latency: Constant(5.0))",
        "radio.latency",
        "100 % of statuses",
    );
    // 0.3 (1 − e^(−1/0.3)) = 28.9 %.
    assert_warned(
        RUMOR,
        "radio: (latency: Exponential(mean: 90.0))",
        "radio.latency",
        "about 29 % of all copies",
    );
}

#[test]
fn an_interval_that_control_steps_round_up_is_warned_of_with_what_becomes_of_it() {
    let control = "control: (period: 0.4)";
    let sections = |interval| format!("{control}, gossip: (status: (interval: {interval}))");
    assert_warned("Heartbeat", &sections("0.5"), "gossip.status.interval", "kept at 0.8 s");
    for exact in ["0.4", "1.2", "2.8"] {
        assert!(warned("Heartbeat", &sections(exact)).is_empty());
    }
    assert_warned(
        BACKBONE,
        "gossip: (request: (interval: 0.25))",
        "gossip.request.interval",
        "kept at 0.3 s",
    );
    let poisson = warned("Rumor(rounds: Poisson)", "gossip: (relay: (interval: 0.25))");
    assert!(poisson.is_empty(), "Poisson rounds keep their own time: {poisson:?}");
}

#[test]
fn a_range_below_two_bodies_or_far_beyond_the_arena_is_warned_of() {
    assert_warned(
        "Heartbeat",
        "radio: (range: 0.139)",
        "radio.range",
        "nobody ever hears anybody",
    );
    assert_warned(
        RUMOR,
        "radio: (range: 43.0)",
        "radio.range",
        "everybody hears everybody",
    );
    assert!(warned("Heartbeat", "radio: (range: 42.0)").is_empty());
    assert!(
        warned(
            "Heartbeat",
            "radio: (range: 50, loss: Distance(at_range: 0.9, exponent: 2))"
        )
        .is_empty()
    );
}

#[test]
fn links_that_the_radio_tells_nothing_of_are_warned_of() {
    assert_warned(
        "Heartbeat",
        "metrics: (links: true)",
        "metrics.links",
        "the disk radio measures nothing",
    );
    let shared = warned("Heartbeat", "metrics: (links: true), radio: (technology: Ieee802154())");
    assert!(!fields(&shared).contains(&"metrics.links"), "{shared:?}");
}

#[test]
fn tables_that_stay_empty_or_tell_nothing_over_time_are_warned_of() {
    let field = "metrics.record";
    assert_warned(
        "Heartbeat",
        "metrics: (record: [Hops])",
        field,
        "no robot of this protocol notes",
    );
    assert_warned(
        BACKBONE,
        "metrics: (record: [Roles, Hops])",
        field,
        "Hops, which stays empty",
    );
    assert_warned(
        "Heartbeat",
        "metrics: (record: [Degree], sample_interval: 0.0)",
        field,
        "Degree, which stays empty: nothing is sampled",
    );
    for no_series in ["sample_interval: 0.0", "series_every: 0"] {
        let found = warned(
            "Heartbeat",
            &format!("metrics: (record: [Traffic, Delays], {no_series})"),
        );
        assert_eq!(fields(&found), [field, field], "{found:?}");
        assert!(found.diagnostics.iter().all(|one| one.message.contains("one window")));
    }
    assert!(
        fields(&warned(
            "Heartbeat",
            "metrics: (record: [Delivery, Delays, Degree, Traffic, Roles])"
        ))
        .is_empty()
    );
    assert!(fields(&warned(RUMOR, "metrics: (record: [Hops])")).is_empty());
}

#[test]
fn a_channel_that_lets_nothing_through_or_is_never_bad_is_warned_of() {
    assert_warned(
        "Heartbeat",
        "radio: (loss: Bernoulli(1))",
        "radio.loss",
        "loses every frame",
    );
    let chain = |good_to_bad, bad_to_good| {
        format!("radio: (loss: GilbertElliott(good_to_bad: {good_to_bad}, bad_to_good: {bad_to_good}))")
    };
    assert_warned(RUMOR, &chain("0.1", "0"), "radio.loss", "loses every frame");
    assert_warned(RUMOR, &chain("0", "0.1"), "radio.loss", "never in its bad state");
    assert!(warned(RUMOR, &chain("0.1", "0.1")).is_empty());
}

#[test]
fn a_target_that_cannot_be_held_is_warned_of_where_it_stands() {
    let at = |places: &str| format!("Backbone(targets: At([{places}]))");
    let outside = at("(at: (2.0, 0.0)), (at: (5.05, 0.0))");
    assert_warned(
        &outside,
        "",
        "protocol.targets[1].at",
        "target 1, at (5.05, 0), lies outside the arena",
    );
    let disc = "arena: (obstacles: [Disc(at: (2.0, 1.5), radius: 0.5)])";
    assert_warned(&at("(at: (2.1, 1.5))"), disc, "protocol.targets[0].at", "has no room");
    let wall = "arena: (obstacles: [Wall(from: (1.5, -5), to: (1.5, 5))])";
    assert_warned(&at("(at: (2.5, 1.5))"), wall, "protocol.targets[0].at", "walled in");
    assert_warned(
        &at("(at: (2.5, 1.5)), (at: (2.5, 1.5))"),
        "",
        "protocol.targets[1].at",
        "same place as target 0",
    );
    let ring = warned(
        "Backbone(targets: Ring(count: 4, radius: 3.6))",
        "arena: (size: (20.0, 6.0))",
    );
    assert_eq!(fields(&ring), ["protocol.targets"]);
    assert!(
        ring.diagnostics[0].message.contains("target 1") && ring.diagnostics[0].message.contains("1 more"),
        "{ring:?}"
    );
}

/// Targets 3 m from the centre take two chains of one relay each: 1 + 3 · 3 = 10 robots. From a cluster of 0.9 m the way to within
/// 0.3 m of them is 1.8 m: 69.2 s at 0.026 m/s, and 10 s of hold.
#[test]
fn a_mission_that_robots_or_time_do_not_suffice_for_is_warned_of_with_the_numbers() {
    let with = |links: u8, robots: u32, time_limit: f64| {
        let text = format!(
            "Scenario(name: \"a\", time_limit: {time_limit:?}, swarm: (robots: {robots}, deploy: Cluster(radius: 0.9)),
             protocol: Backbone(targets: Ring(count: 3, radius: 3.0, links: {links})))"
        );
        examine("a.ron", &text, &[]).unwrap().1
    };
    let needed = match &with(2, 5, 300.0).diagnostics[..] {
        [only] => only.message.clone(),
        found => panic!("{found:?}"),
    };
    assert!(
        needed.contains("takes 10 robots") && needed.contains("there are 5"),
        "{needed}"
    );
    assert!(with(2, 10, 300.0).is_empty());
    let late = with(1, 20, 79.0);
    assert_eq!(fields(&late), ["time_limit"]);
    assert!(late.diagnostics[0].message.contains("that takes 79 s"), "{late:?}");
    assert!(with(1, 20, 80.0).is_empty());
}

#[test]
fn a_swarm_that_stands_in_pieces_is_warned_of_with_how_often() {
    // 30 robots on 10 m × 10 m with a range of 2 m have 3 neighbours on average, and isolated ones nearly always.
    for protocol in [RUMOR, "Heartbeat"] {
        let found = deployed(protocol, "Uniform", "");
        assert_eq!(fields(&found), ["swarm.deploy"], "{protocol}");
        assert!(
            found.diagnostics[0].message.contains("of the first 100 trials"),
            "{found:?}"
        );
    }
    // Where robots wander they meet.
    assert!(deployed(RUMOR, "Uniform", "wander: RandomWaypoint(speed: 0.02)").is_empty());
    assert!(deployed(RUMOR, "Uniform", "radio: (range: 6.0)").is_empty());
    // Heartbeats need no whole swarm, and pairs that stand apart are independent.
    let places: Vec<String> = (0..30)
        .map(|i| format!("({}, {})", i % 6 - 3, f64::from(i / 6) * 1.2 - 3.0))
        .collect();
    let places = format!("At([{}])", places.join(", "));
    assert!(deployed("Heartbeat", &places, "radio: (range: 1.1)").is_empty());
    let found = deployed(RUMOR, &places, "radio: (range: 1.1)");
    assert!(
        found.diagnostics[0].message.contains("in pieces from the start"),
        "{found:?}"
    );
    assert!(deployed(RUMOR, &places, "radio: (range: 1.21)").is_empty());
}

#[test]
fn a_cluster_that_the_walls_cut_off_and_a_robot_alone_are_warned_of() {
    let found = deployed("Heartbeat", "Cluster(radius: 4.94)", "radio: (range: 5.0)");
    assert_eq!(fields(&found), ["swarm.deploy.radius"], "{found:?}");
    let text = "Scenario(name: \"a\", time_limit: 9.0, swarm: (robots: 1, deploy: Uniform), protocol: Heartbeat)";
    assert_eq!(fields(&examine("a.ron", text, &[]).unwrap().1), ["swarm.robots"]);
}

#[test]
fn of_many_warnings_the_first_20_are_shown_and_the_rest_counted() {
    let faults: Vec<String> = (0..5000)
        .map(|i| format!("Crash(robots: [{}], at: 300)", i % 30))
        .collect();
    let found = warned("Heartbeat", &format!("faults: [{}]", faults.join(",\n")));
    assert_eq!((found.diagnostics.len(), found.more, found.count()), (20, 4980, 5000));
    let text = found.render(desim::scenario::Style::PLAIN);
    assert!(
        text.ends_with("and 4980 more\n") && text.len() < 20_000,
        "{}",
        text.len()
    );
}

#[test]
fn an_override_is_named_as_the_place_of_what_it_makes_meaningless() {
    let text = std::fs::read_to_string("scenarios/heartbeat.ron").unwrap();
    let given = "detector=Timeout(4000)".parse().unwrap();
    let found = examine("heartbeat.ron", &text, &[given]).unwrap().1;
    assert_eq!(fields(&found), ["detector"]);
    assert_eq!(
        found.diagnostics[0].place.as_ref().map(|place| place.name.as_str()),
        Some("--set")
    );
}

#[test]
fn what_looks_wrong_with_settings_of_a_study_is_said_once_with_those_that_it_is_about_and_can_be_denied() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "base.ron",
        "Scenario(name: \"base\", time_limit: 20.0, arena: (size: (3.0, 3.0)), swarm: (robots: 4, deploy: Uniform), protocol: Heartbeat, motion: (max_speed: 0.4))",
    );
    write(
        "study.ron",
        "Study(name: \"patience\", base: \"base.ron\", trials: 6, figure: \"detection.mistake_rate_hz\", factors: [(name: \"timeout\",
         paths: [\"detector\"], levels: [(values: [Timeout(2.0)]), (values: [Timeout(20.0)]), (values: [Timeout(30.0)])])])",
    );
    let plan = desim::scenario::load_study(&folder.path().join("study.ron")).unwrap();
    let said: Vec<String> = plan
        .all_warnings()
        .diagnostics
        .into_iter()
        .map(|found| found.message)
        .collect();
    let of = |start: &str| said.iter().filter(|message| message.starts_with(start)).count();
    // What all settings share has no name of one; the others differ in what they say.
    assert_eq!(of("`motion.max_speed` is set"), 1, "{said:?}");
    assert_eq!(of("setting Timeout(20.0): nobody is ever suspected"), 1, "{said:?}");
    assert_eq!(of("setting Timeout(30.0): nobody is ever suspected"), 1, "{said:?}");
    let commands: &[&str] = if cfg!(feature = "command") {
        &["check", "compare"]
    } else {
        &[]
    };
    for command in commands {
        let mut desim = assert_cmd::Command::cargo_bin("desim").unwrap();
        let output = desim
            .args([command, "study.ron", "--deny", "warnings"])
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(
            said.contains("warnings, and warnings are denied") && said.contains("study.ron:"),
            "{said}"
        );
        assert!(!folder.path().join("results").exists());
    }
}
