//! The page on which a trial is watched: what it shows is what happened.

use std::fs;
use std::io::Read;

use assert_cmd::Command;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use desim::experiment::{reach, run_trial, watch_trial};
use desim::metrics::TrialRecord;
use desim::radio::LossCause;
use desim::report::{Film, ReplayInput, replay};
use desim::scenario::{Scenario, parse};
use desim::simulation::DriverKind;
use flate2::read::GzDecoder;
use serde_json::Value;
use tempfile::tempdir;
use tokio_util::sync::CancellationToken;

const DISK: &str = "radio: (loss: Bernoulli(0.3), latency: Constant(0.03)), faults: [
    Crash(robots: [1], at: 3.0, lasts: For(2.0)), Deaf(robots: [2], at: 4.0, lasts: ForGood)]";
const WALLED: &str = "radio: (walls: Block), arena: (size: (4.0, 3.0), obstacles: [Wall(from: (0.4, -1.0), to: (0.4, 1.0)), Disc(at: (1.0, 1.0), radius: 0.2)])";
const SHARED: &str = "radio: (technology: Ieee802154(), transmit_power: -45.0)";

fn text(more: &str) -> String {
    format!(
        "Scenario(name: \"moving\", time_limit: 12.0, swarm: (robots: 9, deploy: Cluster(radius: 1.0)), \
         wander: RandomWaypoint(speed: 0.1), motion: (max_speed: 0.1), protocol: Heartbeat, detector: Timeout(0.5), {more})"
    )
}

fn scenario(more: &str) -> Scenario {
    parse("moving.ron", &text(more), &[]).unwrap_or_else(|report| panic!("{report}"))
}

/// A page read back.
struct Page {
    meta: Value,
    data: Vec<u8>,
    html: String,
}

impl Page {
    fn of(scenario: &Scenario) -> (Self, TrialRecord) {
        let stop = CancellationToken::new();
        let (record, film) = watch_trial(scenario, 0, Film::of(scenario), &stop).expect("the trial reaches its end");
        let reach = reach(scenario, 0);
        let input = ReplayInput {
            scenario,
            question: Some("</script> & co {{title}}{{data}}"),
            record: &record,
            reach: &reach,
            folder: "results/moving",
        };
        (Self::read(replay(&input, film)), record)
    }

    fn read(html: String) -> Self {
        let of = |id: &str| {
            let begins = html.find(&format!("id=\"{id}\"")).expect("it is there");
            let begins = begins + html[begins..].find('>').expect("a tag ends") + 1;
            &html[begins..begins + html[begins..].find("</script>").expect("it ends")]
        };
        let meta = serde_json::from_str(of("meta")).expect("it is JSON");
        let mut data = Vec::new();
        let deflated = STANDARD.decode(of("data").trim()).expect("it is base64");
        GzDecoder::new(&deflated[..])
            .read_to_end(&mut data)
            .expect("it is gzip");
        Self { meta, data, html }
    }

    fn section(&self, name: &str) -> &[u8] {
        let place = |index: usize| self.meta["sections"][name][index].as_u64().expect("a number") as usize;
        assert_eq!(place(0) % 8, 0, "{name} begins where no typed array can");
        &self.data[place(0)..place(0) + place(1)]
    }

    fn words(&self, name: &str) -> Vec<u32> {
        let (words, rest) = self.section(name).as_chunks::<4>();
        assert!(rest.is_empty());
        words.iter().map(|word| u32::from_le_bytes(*word)).collect()
    }

    fn floats(&self, name: &str) -> Vec<f64> {
        self.words(name)
            .into_iter()
            .map(|bits| f64::from(f32::from_bits(bits)))
            .collect()
    }

    /// Along one axis the places of `robot`, metres.
    fn places(&self, axis: &str, robot: usize) -> Vec<f64> {
        let quantum = self.meta["frames"]["quantum_m"].as_f64().unwrap();
        let count = self.meta["frames"]["count"].as_u64().unwrap() as usize;
        let width = self.meta["frames"]["width"].as_u64().unwrap() as usize;
        let mut place = self.words(&format!("{axis}0"))[robot].cast_signed();
        let steps = &self.section(&format!("d{axis}"))[robot * (count - 1) * width..][..(count - 1) * width];
        let mut places = vec![f64::from(place) * quantum];
        for step in steps.chunks(width) {
            place += match *step {
                [a, b] => i32::from(i16::from_le_bytes([a, b])),
                [a, b, c, d] => i32::from_le_bytes([a, b, c, d]),
                _ => panic!("steps of {width} bytes"),
            };
            places.push(f64::from(place) * quantum);
        }
        assert_eq!(places.len(), count);
        places
    }
}

#[test]
fn robots_are_where_the_trajectories_have_them() {
    for radio in [DISK, WALLED, SHARED] {
        let (page, record) = Page::of(&scenario(radio));
        let every = page.meta["frames"]["every_s"].as_f64().unwrap();
        let mut checked = 0;
        for robot in 0..9 {
            let [x, y] = ["x", "y"].map(|axis| page.places(axis, robot));
            for (at, places) in &record.trajectories {
                let instant = at.as_secs() / every;
                let (low, share) = (instant.floor() as usize, instant.fract());
                let between = |along: &[f64]| {
                    let next = along.get(low + 1).copied().unwrap_or(along[low]);
                    along[low] + (next - along[low]) * share
                };
                let [there_x, there_y] = places[robot].map(f64::from);
                let off = (between(&x) - there_x).hypot(between(&y) - there_y);
                assert!(off < 0.005, "robot {robot} is {off} m off at {at}");
                checked += 1;
            }
            let moved = (x[0] - x[x.len() - 1]).hypot(y[0] - y[y.len() - 1]);
            assert!(moved > 0.0, "robot {robot} never moved");
        }
        assert!(checked >= 9 * 10);
    }
}

#[test]
fn every_message_and_every_copy_is_there_with_its_fate() {
    for radio in [DISK, SHARED] {
        let (page, record) = Page::of(&scenario(radio));
        let sent: u64 = record.traffic.iter().map(|row| row.sent.frames).sum();
        assert_eq!(page.words("msg_sender").len() as u64, sent);
        let fates = page.section("copy_fate");
        let count = |fate: u8| fates.iter().map(|found| u64::from(*found == fate)).sum::<u64>();
        let ledger = |of: &dyn Fn(&desim::metrics::TopicFates) -> u64| record.ledger.iter().map(of).sum::<u64>();
        assert_eq!(count(0), ledger(&|fates| fates.delivered));
        assert_eq!(count(255), ledger(&|fates| fates.in_flight));
        for cause in LossCause::ALL {
            assert_eq!(
                count(1 + cause as u8),
                ledger(&|fates| fates.lost[cause as usize]),
                "{cause:?}"
            );
        }
        assert!(count(0) > 100 && fates.iter().any(|fate| (1..255).contains(fate)));
        // Each message's copies are its own: nobody hears itself, nothing arrives before it was sent.
        let (first, senders, times) = (page.words("msg_first"), page.words("msg_sender"), page.floats("msg_t"));
        let receivers = page.words("copy_receiver");
        let late = page.section("copy_late").as_chunks::<2>().0;
        assert_eq!(first[senders.len()] as usize, fates.len());
        let mut latest = 0;
        for message in 0..senders.len() {
            for copy in first[message] as usize..first[message + 1] as usize {
                assert_ne!(receivers[copy], senders[message]);
                latest = latest.max(u16::from_le_bytes(late[copy]));
            }
        }
        // Tenths of a millisecond: the constant latency of the one, airtime and medium access of the other.
        assert!(
            if radio == DISK {
                latest == 300
            } else {
                (10..1000).contains(&latest)
            },
            "{latest}"
        );
        assert!(times.is_sorted() && times.iter().all(|time| (0.0..=12.0).contains(time)));
    }
}

#[test]
fn links_of_walls_and_shared_radios_are_those_of_the_reach() {
    for radio in [WALLED, SHARED] {
        let scenario = scenario(radio);
        let (page, record) = Page::of(&scenario);
        let (first, a, b) = (
            page.words("toggle_first"),
            page.words("toggle_a"),
            page.words("toggle_b"),
        );
        assert_eq!(page.meta["links"]["samples"], page.meta["frames"]["count"]);
        let mut linked = std::collections::BTreeSet::new();
        for toggle in 0..*first.last().unwrap() as usize {
            let pair = (a[toggle], b[toggle]);
            if !linked.remove(&pair) {
                linked.insert(pair);
            }
        }
        // At the end: those of the record, but for ends within a millimetre of the limit.
        let at_end = record.links_at_end(&reach(&scenario, 0)).len();
        assert!(linked.len().abs_diff(at_end) <= 1, "{} and {at_end}", linked.len());
        assert!((1..36).contains(&linked.len()) && first.windows(2).skip(1).any(|two| two[0] < two[1]));
    }
    assert!(Page::of(&scenario(DISK)).0.meta["links"].is_null());
}

#[test]
fn faults_and_suspicions_are_events_and_lead_to_their_causes() {
    let (page, record) = Page::of(&scenario(DISK));
    let events = page.meta["events"].as_array().unwrap();
    let of_kind = |kind: &str| events.iter().filter(|event| event["kind"] == kind).count();
    assert_eq!((of_kind("fault"), of_kind("recovery")), (2, 1));
    assert_eq!(of_kind("suspicion"), record.detection.suspicions.len());
    assert!(of_kind("suspicion") > 5 && of_kind("trust") > 0);
    assert!(events.is_sorted_by(|a, b| a["t"].as_f64() <= b["t"].as_f64()));
    let mistaken = events.iter().find(|event| {
        let detail = event["detail"].as_array().into_iter().flatten();
        detail
            .clone()
            .any(|line| line.as_str().is_some_and(|line| line.contains("lost to channel")))
    });
    let detail = mistaken.expect("statuses were lost")["detail"].to_string();
    assert!(
        detail.contains("desim explain results/moving --trial 0 --robot "),
        "{detail}"
    );
    assert_eq!(page.meta["faults"][0]["what"], "crash");
    assert_eq!(page.meta["question"], "</script> & co {{title}}{{data}}");
    assert!(!page.html.contains("</script> &"), "what others wrote ends no script");
    assert!(page.html.contains("<title>moving, trial 0</title>"));
}

#[test]
fn the_command_writes_a_page_beside_the_results_and_refuses_what_is_none() {
    let dir = tempdir().unwrap();
    let file = dir.path().join("moving.ron");
    fs::write(&file, text(DISK)).unwrap();
    // Its exit status, and what it says.
    let desim = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_desim"));
        let out = command.current_dir(dir.path()).args(arguments).output().unwrap();
        (out.status.code(), String::from_utf8(out.stderr).unwrap())
    };
    let well = |arguments: &[&str]| {
        let (status, said) = desim(arguments);
        assert_eq!(status, Some(0), "{said}");
        said
    };
    well(&["scenario", "moving.ron", "--trials", "2", "--out", "r", "--quiet"]);
    let said = well(&["replay", "r", "--trial", "1"]);
    assert!(said.contains("r/replay-1.html shows the trial"), "{said}");
    let page = Page::read(fs::read_to_string(dir.path().join("r/replay-1.html")).unwrap());
    assert_eq!(page.meta["trial"], 1);
    let other = run_trial(&scenario(DISK), 1, DriverKind::Actors, &CancellationToken::new()).unwrap();
    assert_eq!(page.meta["digest"], format!("{:032x}", other.digest));
    // The report leads to the page of trial 0, once there is one.
    let leads = || {
        let report = fs::read_to_string(dir.path().join("r/report.html")).unwrap();
        report.contains("href=\"replay.html\"")
    };
    well(&["report", "r"]);
    assert!(!leads());
    well(&["replay", "r"]);
    well(&["report", "r"]);
    assert!(leads());
    // It is none of the results: they are shown, held and replaced as before.
    well(&["replay", "r"]);
    well(&[
        "scenario",
        "moving.ron",
        "--trials",
        "1",
        "--out",
        "r",
        "--quiet",
        "--force",
    ]);
    assert!(
        !dir.path().join("r/replay-1.html").exists(),
        "a page of other results is gone with them"
    );
    for (arguments, message) in [
        (&["replay", "nowhere"][..], "there is no folder nowhere"),
        (
            &["replay", "r", "--trial", "7"],
            "there is no trial 7: r has trials 0 to 0",
        ),
        (
            &["replay", "r", "--out", "moving.ron"],
            "moving.ron is no page of desim",
        ),
    ] {
        let (status, said) = desim(arguments);
        assert!(status == Some(2) && said.contains(message), "{said}");
    }
}
