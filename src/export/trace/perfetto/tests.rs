use std::collections::BTreeMap;

use serde_json::Value;

use super::super::traced::{FAULTS, SHARED, run, scenario, traced};
use super::*;
use crate::scenario::Scenario;

fn written(scenario: &Scenario, selection: &Selection) -> Vec<u8> {
    let perfetto = Perfetto::begin(Vec::new(), run(scenario), selection).unwrap();
    let (record, perfetto) = traced(scenario, selection.clone(), perfetto);
    perfetto.close(&record).unwrap()
}

fn events(scenario: &Scenario, selection: &Selection) -> Vec<Value> {
    let trace: Value = serde_json::from_slice(&written(scenario, selection)).unwrap();
    trace["traceEvents"].as_array().unwrap().clone()
}

fn nanos(event: &Value, of: &str) -> u64 {
    (event[of].as_f64().unwrap() * 1e3).round() as u64
}

fn is(event: &Value, ph: &str) -> bool {
    event["ph"] == ph
}

/// Slices by thread: from when to when, and as what.
fn slices(events: &[Value]) -> BTreeMap<u64, Vec<(u64, u64, String)>> {
    let mut slices: BTreeMap<u64, Vec<(u64, u64, String)>> = BTreeMap::new();
    for event in events {
        let thread = slices.entry(event["tid"].as_u64().unwrap()).or_default();
        let name = || event["name"].as_str().unwrap().to_owned();
        match event["ph"].as_str().unwrap() {
            "X" => {
                let begin = nanos(event, "ts");
                thread.push((begin, begin + nanos(event, "dur"), name()));
            }
            "B" => thread.push((nanos(event, "ts"), u64::MAX, name())),
            "E" => thread.last_mut().unwrap().1 = nanos(event, "ts"),
            _ => {}
        }
    }
    slices
}

fn part(from: f64, until: f64) -> Selection {
    Selection {
        from: SimTime::from_secs(from),
        until: SimTime::from_secs(until),
        ..Selection::default()
    }
}

#[test]
fn on_every_track_slices_lie_one_after_the_other_and_all_arrows_have_both_ends() {
    for (text, set, selection) in [
        (FAULTS, &["time_limit=40.0"][..], Selection::default()),
        (SHARED, &["time_limit=11.0"], part(1.0, 3.0)),
    ] {
        let events = events(&scenario(text, set), &selection);
        let slices = slices(&events);
        for (thread, slices) in &slices {
            for pair in slices.windows(2) {
                assert!(pair[0].1 <= pair[1].0, "on thread {thread}: {pair:?}");
            }
        }
        let mut begun: BTreeMap<u64, (u64, bool)> = BTreeMap::new();
        for event in events.iter().filter(|event| is(event, "s") || is(event, "f")) {
            let (id, at) = (event["id"].as_u64().unwrap(), nanos(event, "ts"));
            let there = &slices[&event["tid"].as_u64().unwrap()];
            let is_within = there.iter().any(|slice| slice.0 <= at && at <= slice.1);
            assert!(is_within, "{event} is in no slice");
            if is(event, "s") {
                assert!(begun.insert(id, (at, false)).is_none(), "{event} twice");
            } else {
                let (begin, is_ended) = begun.get_mut(&id).unwrap();
                assert!(*begin <= at, "{event} leads backwards");
                assert_eq!(event["bp"], "e");
                *is_ended = true;
            }
        }
        assert!(begun.len() > 100);
        assert!(begun.values().all(|(_, is_ended)| *is_ended));
    }
}

#[test]
fn what_lasts_is_drawn_from_the_beginning_of_the_part_to_its_end() {
    let events = events(&scenario(FAULTS, &[]), &part(28.0, 29.0));
    let slices = slices(&events);
    let found: Vec<&(u64, u64, String)> = slices
        .values()
        .flatten()
        .filter(|(.., name)| name == "crash" || name == "deaf")
        .collect();
    // Robots 0 to 2 crashed at 20 s, robot 3 went deaf at 25 s, and none recovers yet.
    assert_eq!(found.len(), 4);
    assert!(
        found
            .iter()
            .all(|slice| (slice.0, slice.1) == (28_000_000_000, 29_000_000_000))
    );
    let mut open = BTreeMap::new();
    for event in events.iter().filter(|event| is(event, "b") || is(event, "e")) {
        *open.entry(event["id"].as_u64().unwrap()).or_insert(0) += if is(event, "b") { 1 } else { -1 };
        let at = nanos(event, "ts");
        assert!((28_000_000_000..=29_000_000_000).contains(&at));
    }
    assert!(!open.is_empty() && open.values().all(|&open| open == 0));
}

#[test]
fn a_suspicion_has_an_arrow_from_what_was_heard_last() {
    let events = events(&scenario(FAULTS, &["time_limit=24.0"]), &Selection::default());
    let last: Vec<&Value> = events.iter().filter(|event| event["name"] == "last heard").collect();
    let begins = last.iter().filter(|event| is(event, "s")).count();
    let suspicions = events.iter().filter(|event| event["cat"] == "suspects").count();
    assert!(begins > 0);
    assert_eq!((begins, last.len()), (suspicions, 2 * suspicions));
    // A suspicion is as late as the detector's timeout, 2.2 s.
    for pair in last.chunks(2) {
        assert!(nanos(pair[1], "ts") >= nanos(pair[0], "ts") + 2_200_000_000);
    }
}

#[test]
fn only_chosen_robots_have_roles_and_what_they_say_and_hear_is_there() {
    let chosen = Selection {
        robots: Some([ActorId(7)].into()),
        ..Selection::default()
    };
    let events = events(&scenario(FAULTS, &["time_limit=5.0", "faults=[]"]), &chosen);
    let of = |cat: &str, ph: &str| {
        let found = events.iter().filter(|event| event["cat"] == cat && event["ph"] == ph);
        found.map(|event| event["pid"].as_u64().unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(of("role", "B"), [8]);
    let copies = events.iter().filter(|event| event["cat"] == "hears");
    for copy in copies {
        assert!(copy["pid"] == 8 || copy["args"]["from"] == 7, "{copy}");
    }
    assert!(of("says", "X").contains(&8));
}

#[test]
fn a_trace_written_twice_is_the_same_bytes_and_is_known_by_its_beginning() {
    let scenario = scenario(FAULTS, &["time_limit=5.0", "faults=[]"]);
    let trace = written(&scenario, &Selection::default());
    assert_eq!(trace, written(&scenario, &Selection::default()));
    let mut gzipped = GzEncoder::new(Vec::new(), Compression::default());
    gzipped.write_all(&trace).unwrap();
    let gzipped = gzipped.finish().unwrap();
    assert!(is_begun_by(&trace) && is_begun_by(&trace[..16]) && is_begun_by(&gzipped[..16]));
    for other in [
        &b"{\"scenario\":1}"[..],
        b"",
        b"[]",
        &[0x1f, 0x8b, 8, 8, 1, 2, 3, 4, 0, 3],
    ] {
        assert!(!is_begun_by(other));
    }
}
