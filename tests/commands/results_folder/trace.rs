//! A trial written for other programs: the log has all that happened, and the command refuses what it cannot do.

use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::io;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use desim::engine::{ActorId, SimTime, Span};
use desim::experiment::watch_trial;
use desim::happenings::log::{CopyRecord, Event, Fate, Frame, Log, Selection, Sink, What};
use desim::metrics::TrialRecord;
use desim::radio::LossCause;
use desim::scenario::{Scenario, parse};
use tempfile::tempdir;
use tokio_util::sync::CancellationToken;

const FAULTS: &str =
    "faults: [Crash(robots: [1], at: 3.0, lasts: For(2.0)), Deaf(robots: [2], at: 4.0, lasts: ForGood),
    Partition(line: ((0.0, -5.0), (0.0, 5.0)), during: Between(5.0, 6.0))]";

/// What is logged, as it was handed over.
#[derive(Debug, Default)]
struct Kept {
    frames: Vec<Frame>,
    copies: Vec<CopyRecord>,
    events: Vec<Event>,
    settled: SimTime,
}

impl Sink for Kept {
    fn frame(&mut self, frame: &Frame) -> io::Result<()> {
        assert!(frame.at >= self.settled, "a frame of before what was settled");
        self.frames.push(frame.clone());
        Ok(())
    }

    fn copy(&mut self, record: &CopyRecord) -> io::Result<()> {
        let strays = record.fate == Fate::Strayed;
        assert!(strays || record.at.unwrap_or(record.copy.sent_at) >= self.settled);
        self.copies.push(*record);
        Ok(())
    }

    fn settled(&mut self, until: SimTime) -> io::Result<()> {
        assert!(until >= self.settled);
        self.settled = until;
        Ok(())
    }

    fn event(&mut self, event: &Event) -> io::Result<()> {
        self.events.push(event.clone());
        Ok(())
    }
}

fn scenario(more: &str) -> Scenario {
    let text = format!("Scenario(name: \"traced\", time_limit: 9.0, {more})");
    parse("traced.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"))
}

/// Robots that watch each other, send to one or to all, with one message a frame or several, over both kinds of radios, stand or move, and fail.
fn scenarios() -> Vec<Scenario> {
    let moving = "swarm: (robots: 9, deploy: Cluster(radius: 1.0)), wander: RandomWaypoint(speed: 0.1), motion: (max_speed: 0.1), protocol: Heartbeat";
    let disk = "radio: (loss: Bernoulli(0.3), latency: Uniform(min: 0.01, max: 0.3))";
    let shared = "radio: (technology: Ieee802154(), transmit_power: -45.0)";
    let load = "arena: (size: (80.0, 80.0)), swarm: (robots: 8, deploy: Uniform), protocol: Traffic(to: Next, when: Poisson(60.0), payload: 40)";
    vec![
        scenario(&format!("{moving}, detector: Timeout(0.5), {disk}, {FAULTS}")),
        scenario(&format!(
            "{moving}, detector: Swim(probe_interval: 2.5), gossip: (piggyback: true), {disk}, {FAULTS}"
        )),
        scenario(&format!("{moving}, detector: Timeout(0.5), {shared}, {FAULTS}")),
        scenario(&format!(
            "{moving}, detector: Swim(), gossip: (piggyback: true), {shared}, {FAULTS}"
        )),
        scenario(&format!(
            "{load}, radio: (technology: Ieee802154(), queue: 3, fading: Rayleigh())"
        )),
        scenario(&format!("{load}, radio: (range: 30.0, loss: Bernoulli(0.1))")),
        scenario(
            "swarm: (robots: 20, deploy: Uniform), arena: (size: (6.0, 6.0)), protocol: Rumor(mode: Pull, completion: Reached), gossip: (piggyback: true), radio: (loss: Bernoulli(0.2))",
        ),
    ]
}

fn log(scenario: &Scenario, selection: Selection) -> (TrialRecord, Kept) {
    let log = Log::new(selection, scenario.radio.shared().is_some(), Kept::default());
    let (record, log) = watch_trial(scenario, 0, log, &CancellationToken::new()).expect("the trial reaches its end");
    (record, log.into_sink().expect("nothing fails"))
}

#[test]
fn a_log_has_every_frame_and_every_copy_once() {
    for scenario in scenarios() {
        let (record, kept) = log(&scenario, Selection::default());
        let mut sent: BTreeMap<(u32, u8), (u64, u64)> = BTreeMap::new();
        for row in record.traffic.iter().filter(|row| row.sent.frames > 0) {
            let entry = sent.entry((row.robot.0, row.topic)).or_default();
            *entry = (entry.0 + row.sent.frames, entry.1 + row.sent.payload_bytes);
        }
        let mut logged: BTreeMap<(u32, u8), (u64, u64)> = BTreeMap::new();
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        for frame in &kept.frames {
            let number = numbers.entry(frame.sender.0).or_default();
            assert_eq!(frame.number, *number, "frames of robot {} in order", frame.sender);
            *number += 1;
            for (message, payload) in frame.contents() {
                let entry = logged.entry((frame.sender.0, message.topic.0)).or_default();
                *entry = (entry.0 + 1, entry.1 + payload.len() as u64);
            }
        }
        assert_eq!(logged, sent);
        assert!(kept.frames.is_sorted_by_key(|frame| frame.at));
        let headers: u64 = record.traffic.iter().map(|row| row.sent.header_bytes).sum();
        let [frame_header, message_header] = scenario.header_bytes().map(u64::from);
        let of_frame = |frame: &Frame| frame_header + frame.messages.len() as u64 * message_header;
        assert_eq!(kept.frames.iter().map(of_frame).sum::<u64>(), headers);

        for (topic, fates) in record.ledger.iter().enumerate() {
            let of = |fate: Fate| {
                let is_one = |record: &&CopyRecord| usize::from(record.copy.topic.0) == topic && record.fate == fate;
                kept.copies.iter().filter(is_one).count() as u64
            };
            assert_eq!(of(Fate::Delivered), fates.delivered);
            assert_eq!(of(Fate::InFlight), fates.in_flight);
            for (cause, lost) in LossCause::ALL.into_iter().zip(fates.lost) {
                assert_eq!(of(Fate::Lost(cause)), lost, "{cause:?}");
            }
        }
        let once: HashSet<_> = kept
            .copies
            .iter()
            .map(|record| (record.copy.sender, record.copy.sequence, record.copy.receiver))
            .collect();
        assert_eq!(once.len(), kept.copies.len());
        let offered: u64 = kept.frames.iter().map(|frame| frame.offered).sum();
        let strays = kept.copies.iter().filter(|record| record.fate == Fate::Strayed).count();
        assert_eq!(offered + strays as u64, kept.copies.len() as u64);
        // What a radio did with a frame is known when the frame is handed on, but for those that it is not done with at the end.
        let concludes = scenario.radio.shared().is_some();
        let lately = record.simulated.as_secs() - 1.0;
        let is_unknown = |frame: &&Frame| frame.at.as_secs() < lately && frame.sending.is_some() != concludes;
        assert_eq!(kept.frames.iter().find(is_unknown), None);
        copies_belong_to_their_frames(&kept);
        events_are_those_of_the_record(&record, &kept);
    }
}

fn copies_belong_to_their_frames(kept: &Kept) {
    let frames: BTreeMap<_, _> = kept
        .frames
        .iter()
        .map(|frame| ((frame.sender, frame.number), frame))
        .collect();
    for record in &kept.copies {
        let frame = frames[&(record.copy.sender, record.frame)];
        assert_eq!(frame.at, record.copy.sent_at);
        let mut messages = frame.messages.iter();
        let message = messages.find(|message| message.sequence == record.copy.sequence);
        assert_eq!(message.map(|message| message.topic), Some(record.copy.topic));
        assert!(record.at.is_none_or(|at| at >= frame.at) && record.read.is_none_or(|read| Some(read) >= record.at));
    }
}

fn events_are_those_of_the_record(record: &TrialRecord, kept: &Kept) {
    let count = |is_one: fn(&What) -> bool| kept.events.iter().filter(|event| is_one(&event.what)).count();
    let ended = record.faults.iter().filter(|episode| episode.until.is_some()).count();
    assert_eq!(
        count(|what| matches!(what, What::Fails(_) | What::LinksFail(_))),
        record.faults.len()
    );
    assert_eq!(
        count(|what| matches!(what, What::Recovers(_) | What::LinksRecover(_))),
        ended
    );
    let suspicions = count(|what| matches!(what, What::Suspects(..)));
    assert_eq!(suspicions, record.detection.suspicions.len());
}

#[test]
fn parts_of_a_log_make_the_whole() {
    let [scenario, .., shared, _, _, _] = &scenarios()[..] else {
        panic!("there are seven")
    };
    for scenario in [scenario, shared] {
        let (_, whole) = log(scenario, Selection::default());
        let cuts = [0.0, 2.5, 2.55, 6.0, 1e6].map(|at| SimTime::ZERO + Span::from_secs(at));
        let parts = cuts.windows(2).map(|cut| {
            let selection = Selection {
                from: cut[0],
                until: cut[1],
                ..Selection::default()
            };
            log(scenario, selection).1
        });
        let (mut frames, mut copies, mut events) = (Vec::new(), 0, Vec::new());
        for part in parts {
            frames.extend(part.frames);
            copies += part.copies.len();
            events.extend(part.events);
        }
        assert!(frames == whole.frames && events == whole.events && copies == whole.copies.len());
    }
}

#[test]
fn a_log_of_some_robots_and_topics_has_what_these_send_and_are_offered() {
    let scenario = &scenarios()[1];
    let (_, whole) = log(scenario, Selection::default());
    let chosen = [ActorId(3), ActorId(5)];
    let status = desim::protocol::Topic(0);
    let selection = Selection {
        robots: Some(chosen.into()),
        topics: Some([status].into()),
        ..Selection::default()
    };
    let (_, part) = log(scenario, selection);
    let is_wanted = |record: &&CopyRecord| {
        let ends = [record.copy.sender, record.copy.receiver];
        record.copy.topic == status && ends.iter().any(|end| chosen.contains(end))
    };
    let copies: Vec<_> = whole.copies.iter().filter(is_wanted).copied().collect();
    assert_eq!(part.copies, copies);
    let heard: HashSet<_> = copies.iter().map(|record| (record.copy.sender, record.frame)).collect();
    let says =
        |frame: &Frame| chosen.contains(&frame.sender) && frame.messages.iter().any(|message| message.topic == status);
    let frames = whole
        .frames
        .iter()
        .filter(|frame| says(frame) || heard.contains(&(frame.sender, frame.number)));
    assert_eq!(part.frames, frames.cloned().collect::<Vec<_>>());
    let about = |event: &&Event| {
        event
            .robot
            .into_iter()
            .chain(event.what.about())
            .any(|robot| chosen.contains(&robot))
    };
    let links = |event: &&Event| event.robot.is_none();
    let events: Vec<_> = whole
        .events
        .iter()
        .filter(|event| about(event) || links(event))
        .cloned()
        .collect();
    assert_eq!(part.events, events);
}

fn desim(dir: &Path, arguments: &[&str]) -> Assert {
    Command::cargo_bin("desim")
        .unwrap()
        .current_dir(dir)
        .args(arguments)
        .assert()
}

fn results(dir: &Path) {
    let text = "Scenario(name: \"small\", time_limit: 6.0, trials: 2, swarm: (robots: 5, deploy: Cluster(radius: 1.0)), protocol: Heartbeat, detector: Timeout(0.5), radio: (loss: Bernoulli(0.3)))";
    fs::write(dir.join("small.ron"), text).unwrap();
    desim(dir, &["scenario", "small.ron", "--out", "there", "--quiet"]).success();
}

#[test]
fn the_command_writes_each_format_the_same_each_time_and_over_its_own_only() {
    let dir = tempdir().unwrap();
    results(dir.path());
    let there = dir.path().join("there");
    for (format, name) in [("parquet", "trace/copies.parquet"), ("pcapng", "trace.pcapng")] {
        let said = desim(dir.path(), &["trace", "there", "--as", format]).success();
        let said = String::from_utf8_lossy(&said.get_output().stderr).into_owned();
        assert!(said.contains("holds 0 s to 6.00 s of trial 0"), "{said}");
        let first = fs::read(there.join(name)).unwrap();
        assert!(!first.is_empty());
        desim(dir.path(), &["trace", "there", "--as", format]).success();
        assert_eq!(fs::read(there.join(name)).unwrap(), first, "{format}");
        desim(dir.path(), &["trace", "there", "--as", format, "--trial", "1"]).success();
        let other = there.join(name.replace("trace", "trace-1"));
        assert_ne!(fs::read(other).unwrap(), first, "{format}");
    }
    let out = desim(dir.path(), &["trace", "there", "--as", "pcapng", "--out", "-"]).success();
    assert_eq!(out.get_output().stdout, fs::read(there.join("trace.pcapng")).unwrap());
    let left = fs::read_dir(&there).unwrap().flatten().map(|entry| entry.file_name());
    assert!(
        left.into_iter()
            .all(|name| !name.to_string_lossy().contains("unfinished"))
    );
    // The results are as they were: they are read, and made again over their traces.
    desim(dir.path(), &["report", "there"]).success();
    desim(
        dir.path(),
        &[
            "scenario",
            "small.ron",
            "--out",
            "there",
            "--quiet",
            "--force",
            "--set",
            "seed=3",
        ],
    )
    .success();
    assert!(!there.join("trace.pcapng").exists() && !there.join("trace").exists());
}

#[test]
fn what_cannot_be_traced_is_refused_and_nothing_is_written() {
    let dir = tempdir().unwrap();
    results(dir.path());
    fs::write(dir.path().join("mine.txt"), "precious").unwrap();
    fs::create_dir(dir.path().join("folder")).unwrap();
    fs::write(dir.path().join("folder/mine.txt"), "precious").unwrap();
    let cases: [(&[&str], &str); 14] = [
        (&["there", "--as", "pcapng", "--trial", "7"], "there is no trial 7"),
        (&["none", "--as", "pcapng"], "there is no folder none"),
        (&[".", "--as", "pcapng"], "holds no results of desim"),
        (
            &["there", "--as", "pcapng", "--from", "9"],
            "behind the end of the trial, which lasted 6.00 s",
        ),
        (
            &["there", "--as", "pcapng", "--from", "3", "--until", "3"],
            "no time at all",
        ),
        (&["there", "--as", "pcapng", "--from=-1"], "is no time"),
        (&["there", "--as", "pcapng", "--until", "nan"], "is no time"),
        (
            &["there", "--as", "pcapng", "--robots", "2,5"],
            "there is no robot 5: the scenario has robots 0 to 4",
        ),
        (
            &["there", "--as", "pcapng", "--robots", "2-x"],
            "`x` is no robot's number",
        ),
        (
            &["there", "--as", "pcapng", "--topics", "stutus"],
            "there is no topic `stutus`: robots that run Heartbeat talk of status",
        ),
        (
            &["there", "--as", "pcapng", "--out", "mine.txt"],
            "is no trace of this format",
        ),
        (
            &["there", "--as", "parquet", "--out", "folder"],
            "holds something else than a trace",
        ),
        (
            &["there", "--as", "parquet", "--out", "-"],
            "cannot go to standard output",
        ),
        (&["there", "--as", "text"], "invalid value 'text'"),
    ];
    for (arguments, words) in cases {
        let refused = desim(dir.path(), &[&["trace"], arguments].concat()).code(2);
        let said = String::from_utf8_lossy(&refused.get_output().stderr).replace('\n', " ");
        assert!(said.contains(words), "{arguments:?}: {said}");
    }
    assert_eq!(fs::read_to_string(dir.path().join("mine.txt")).unwrap(), "precious");
    assert_eq!(fs::read_dir(dir.path().join("folder")).unwrap().count(), 1);
    assert!(!dir.path().join("there/trace.pcapng").exists());
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 4);
}

#[test]
fn the_dissector_names_every_kind_and_every_field_that_is_described() {
    let printed = desim(Path::new("."), &["trace", "--dissector"]).success();
    let script = String::from_utf8(printed.get_output().stdout.clone()).unwrap();
    for kind in desim::kinds::all() {
        assert!(script.contains(&format!("[\"{}\"] = {{", kind.name)), "{}", kind.name);
        for field in (kind.layout)().fields() {
            let name = format!("desim.{}.{}", kind.name.to_lowercase(), field.name.replace(' ', "_"));
            assert!(script.contains(&format!("(\"{name}\", \"{}\"", field.name)), "{name}");
        }
    }
    for place in ["version", "pan", "ether_type", "causes", "fields", "kinds"] {
        assert!(!script.contains(&format!("{{{{{place}}}}}")), "{place} was not filled");
    }
}

#[test]
fn a_frame_is_explained_by_who_heard_it_and_why_others_did_not() {
    let dir = tempdir().unwrap();
    results(dir.path());
    let explain = |frame: &str, more: &[&str]| {
        desim(
            dir.path(),
            &[&["explain", "there", "--trial", "0", "--frame", frame], more].concat(),
        )
    };
    let told = explain("2:7", &[]).success();
    let told = String::from_utf8_lossy(&told.get_output().stdout).into_owned();
    assert!(
        told.contains("Robot 2 said frame 7 at ") && told.contains("number 7"),
        "{told}"
    );
    let json = explain("2:7", &["--format", "json"]).success();
    let story: serde_json::Value = serde_json::from_slice(&json.get_output().stdout).unwrap();
    let scenario = parse(
        "small.ron",
        &fs::read_to_string(dir.path().join("small.ron")).unwrap(),
        &[],
    )
    .unwrap();
    let (_, kept) = log(&scenario, Selection::default());
    let of_it = |record: &&CopyRecord| record.copy.sender == ActorId(2) && record.frame == 7;
    let copies: Vec<_> = kept.copies.iter().filter(of_it).collect();
    let told = story["copies"].as_array().unwrap();
    assert_eq!(told.len() + story["others"].as_array().unwrap().len(), 4);
    assert_eq!(told.len(), copies.len());
    for copy in copies {
        let found = told
            .iter()
            .find(|told| told["receiver"] == copy.copy.receiver.0)
            .unwrap();
        assert_eq!(found["fate"], copy.fate.name());
        assert_eq!(found["cause"].as_str(), copy.fate.cause().map(LossCause::name));
        assert!(found["distance_m"].as_f64().unwrap() <= 2.0);
    }
    for (frame, words) in [
        ("2:700", "robot 2 sent no frame 700 in trial 0: it sent frames 0 to "),
        ("9:0", "there is no robot 9"),
        ("2", "such as 7:120"),
    ] {
        let refused = explain(frame, &[]).code(2);
        let said = String::from_utf8_lossy(&refused.get_output().stderr).replace('\n', " ");
        assert!(said.contains(words), "{said}");
    }
}
