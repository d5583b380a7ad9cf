//! The tables that scenarios ask for: they add up to what is always kept, whatever the scenario, and follow closed forms where there are some.

mod closed_forms;
mod foreign;

use std::collections::BTreeMap;

use desim::engine::SimTime;
use desim::experiment::run_trial;
use desim::metrics::{Asked, RobotBytes, TopicFates, TrialRecord};
use desim::scenario::{Scenario, parse};
use desim::simulation::DriverKind;
use proptest::prelude::*;
use tokio_util::sync::CancellationToken;

const ALL: &str = "[Delivery, Delays, Degree, Hops, Traffic, Roles]";

fn scenario(text: &str) -> Scenario {
    parse("asked.ron", text, &[]).unwrap_or_else(|report| panic!("{text}\n{report}"))
}

fn run(scenario: &Scenario, driver: DriverKind) -> TrialRecord {
    run_trial(scenario, 0, driver, &CancellationToken::new()).expect("the trial reaches its end")
}

/// Distances part what the ledger counts, and nothing else.
fn assert_delivery(record: &TrialRecord) {
    let mut sums = vec![TopicFates::default(); record.ledger.len()];
    let mut before = (0, 0.0);
    for band in &record.asked.delivery {
        assert!(
            band.fates.is_balanced() && band.fates.offered > 0,
            "{band:?} has copies, each with one fate"
        );
        assert!(
            (band.topic, band.from_m) >= before && band.from_m < band.to_m,
            "in order of topics and distances"
        );
        before = (band.topic, band.to_m);
        sums[usize::from(band.topic)].add(&band.fates);
    }
    assert_eq!(sums, record.ledger);
}

/// The windows of a table, each once.
fn windows(times: impl Iterator<Item = (SimTime, SimTime)>) -> Vec<(SimTime, SimTime)> {
    let mut windows: Vec<_> = times.collect();
    assert!(windows.is_sorted(), "in order of time");
    windows.dedup();
    windows
}

/// Windows of time tile the trial: what a robot did is in one of them, and they are cut where the series is.
fn assert_traffic(record: &TrialRecord) {
    let entries: Vec<_> = record.asked.traffic.iter().collect();
    let cuts: Vec<SimTime> = record.series.iter().map(|entry| entry.at).collect();
    for (since, at) in windows(entries.iter().map(|entry| (entry.since, entry.at))) {
        let begins = since == SimTime::ZERO || cuts.contains(&since);
        let ends = at == record.simulated || cuts.contains(&at);
        let whole = !cuts.iter().any(|cut| since < *cut && *cut < at);
        assert!(begins && ends && whole && since < at, "from {since} to {at}");
    }
    let mut sums = BTreeMap::new();
    for entry in &entries {
        let sum: &mut [u64; 4] = sums.entry((entry.robot, entry.topic)).or_default();
        let row = [
            entry.sent_frames,
            entry.sent_bytes,
            entry.received_frames,
            entry.received_bytes,
        ];
        assert!(row.iter().any(|count| *count > 0), "only rows with traffic");
        sum.iter_mut().zip(row).for_each(|(sum, count)| *sum += count);
    }
    let mut rows = BTreeMap::new();
    for row in &record.traffic {
        let sum: &mut [u64; 4] = rows.entry((row.robot, row.topic)).or_default();
        let all = [
            row.sent.frames,
            row.sent.bytes(),
            row.received.frames,
            row.received.bytes(),
        ];
        sum.iter_mut().zip(all).for_each(|(sum, count)| *sum += count);
    }
    rows.retain(|_, sum| *sum != [0; 4]);
    assert_eq!(sums, rows);
    // The first window holds the very start, and the last what nobody read; the others hold what the series does.
    for series in &record.series {
        if series.since == SimTime::ZERO || series.at == record.simulated {
            continue;
        }
        let of_window = entries.iter().filter(|entry| entry.at == series.at);
        let mut totals = vec![[0, 0]; series.sent.len()];
        for entry in of_window {
            for place in [usize::from(entry.topic), series.sent.len() - 1] {
                totals[place][0] += entry.sent_bytes;
                totals[place][1] += entry.received_bytes;
            }
        }
        let total = |bytes: &RobotBytes| bytes.total;
        let told = series.sent.iter().map(total).zip(series.received.iter().map(total));
        assert!(told.eq(totals.iter().map(|[sent, received]| (*sent, *received))));
    }
}

/// As many latencies as copies were delivered, in the windows in which they were received.
fn assert_delays(record: &TrialRecord) {
    let entries: Vec<_> = record.asked.delays.iter().collect();
    let received = |since, at, topic| {
        let of_window = record.asked.traffic.iter();
        let of_window = of_window.filter(move |row| (row.since, row.at, row.topic) == (since, at, topic));
        of_window.map(|row| row.received_frames).sum::<u64>()
    };
    let mut copies = vec![0; record.ledger.len()];
    let mut sum_s = 0.0;
    for entry in &entries {
        assert_eq!(
            entry.copies,
            received(entry.since, entry.at, entry.topic),
            "{entry:?}, and what was received"
        );
        let spans = [entry.min, entry.median, entry.p95, entry.p99, entry.max];
        assert!(spans.is_sorted(), "{spans:?}");
        let within = entry.min.as_secs() - 1e-12..=entry.max.as_secs() + 1e-12;
        assert!(within.contains(&entry.mean_s), "{entry:?}");
        copies[usize::from(entry.topic)] += entry.copies;
        sum_s += entry.mean_s * entry.copies as f64;
    }
    let delivered: Vec<u64> = record.ledger.iter().map(|fates| fates.delivered).collect();
    assert_eq!(copies, delivered);
    if record.ledger.iter().all(|fates| fates.in_flight == 0) {
        let expected = record.latency.sum_nanos() as f64 * 1e-9;
        assert!(
            (sum_s - expected).abs() <= 1e-9 * expected,
            "{sum_s} s and {expected} s"
        );
        assert_eq!(entries.iter().map(|entry| entry.min).min(), record.latency.min());
        assert_eq!(entries.iter().map(|entry| entry.max).max(), record.latency.max());
    }
}

/// Robots that live have as many neighbours, on average, as connectivity says.
fn assert_degree(record: &TrialRecord) {
    assert_eq!(record.asked.degree.len(), record.connectivity.len());
    for (degree, sample) in record.asked.degree.iter().zip(&record.connectivity) {
        assert_eq!(degree.at, sample.at);
        assert_eq!(degree.neighbours.len(), record.robots.len());
        let live: Vec<f64> = degree
            .neighbours
            .iter()
            .flatten()
            .map(|&robots| robots.into())
            .collect();
        let mean = live.iter().sum::<f64>() / (live.len() as f64).max(1.0);
        assert!((mean - sample.neighbours).abs() < 1e-12, "{degree:?}");
        assert!(live.len() >= sample.components as usize);
    }
}

/// Rumours are trees: whoever knows one had it from a robot that knew it before, over one transmission more.
fn assert_hops(record: &TrialRecord) {
    let hops: Vec<_> = record.asked.hops.iter().collect();
    for (place, hop) in hops.iter().enumerate() {
        let spread = &record.spread[usize::from(hop.rumor)];
        assert_eq!(spread.informed[hop.robot.index()], Some(hop.at));
        assert_eq!(spread.hops[hop.robot.index()], Some(hop.hops));
        match hop.parent {
            None => assert_eq!(hop.hops, 0, "it was begun there"),
            Some(parent) => {
                let before = hops[..place].iter();
                let mut before = before.filter(|one| (one.rumor, one.robot) == (hop.rumor, parent));
                let parent = before
                    .next()
                    .unwrap_or_else(|| panic!("{hop:?}: its parent did not know"));
                // By clocks that are wrong an instant is known to a nanosecond or two.
                let before = parent.at.as_nanos() <= hop.at.as_nanos() + 2;
                assert!(before && hop.hops == parent.hops + 1, "{parent:?}, {hop:?}");
            }
        }
    }
    let informed = record.spread.iter().flat_map(|spread| &spread.informed);
    assert_eq!(hops.len(), informed.flatten().count());
}

/// From the first role to the last, change by change.
fn assert_roles(record: &TrialRecord) {
    let changes: Vec<_> = record.asked.roles.iter().collect();
    assert!(changes.is_sorted_by_key(|change| change.at));
    let mut roles = vec![None; record.robots.len()];
    let mut samples = record.connectivity.iter().peekable();
    let hold = |roles: &[Option<u8>], counts: &[u32]| {
        for (role, count) in (0..).zip(counts) {
            assert_eq!(roles.iter().filter(|one| **one == Some(role)).count(), *count as usize);
        }
    };
    for change in &changes {
        while let Some(sample) = samples.next_if(|sample| sample.at < change.at) {
            hold(&roles, &sample.roles);
        }
        let role = &mut roles[change.robot.index()];
        assert_eq!(*role, change.before);
        assert_ne!(change.before, Some(change.role), "a change");
        *role = Some(change.role);
    }
    samples.for_each(|sample| hold(&roles, &sample.roles));
    let ended: Vec<_> = record.robots.iter().map(|robot| Some(robot.role)).collect();
    assert_eq!(roles, ended);
}

/// Runs the scenario of this text with all tables and with none, under both drivers: the record with all, which holds together.
fn check(text: &str) -> TrialRecord {
    let mut scenario = scenario(text);
    let asked = run(&scenario, DriverKind::Inline);
    assert_eq!(asked, run(&scenario, DriverKind::Actors), "both drivers, {text}");
    assert_delivery(&asked);
    assert_traffic(&asked);
    assert_delays(&asked);
    assert_degree(&asked);
    assert_hops(&asked);
    assert_roles(&asked);
    scenario.metrics.record.clear();
    let unasked = run(&scenario, DriverKind::Inline);
    assert!(unasked.asked.is_empty());
    let without = TrialRecord {
        asked: Asked::default(),
        ..asked.clone()
    };
    assert_eq!(without, unasked, "nothing else changes, {text}");
    asked
}

/// Protocols with the settings that they heed, over whatever air.
fn protocol() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "protocol: Heartbeat, detector: Timeout(1.5), wander: RandomWaypoint(speed: 0.4), motion: (max_speed: 0.4)",
        "protocol: Rumor(mode: PushPull, sources: Random(3), completion: Held(1.0)), wander: RandomWaypoint(speed: 0.4), motion: (max_speed: 0.4), \
         gossip: (piggyback: true, relay: (interval: 0.3, fan_out: Peers(1)))",
        "protocol: Rumor(sources: Robots([2]), rounds: Poisson, completion: Reached), gossip: (relay: (interval: 0.4))",
        "protocol: Backbone(targets: Ring(count: 2, radius: 2.0), completion: Held(0.5)), gossip: (piggyback: true)",
        "protocol: Traffic(when: Poisson(5.0), payload: 8, to: Next)",
        "protocol: Traffic(when: Poisson(5.0), payload: 8, to: Everyone)",
    ])
}

fn radio() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "radio: (range: 2.0, loss: Bernoulli(0.3), latency: Uniform(min: 0.01, max: 0.3))",
        "radio: (range: 2.2, loss: Distance(at_range: 0.6, exponent: 2), latency: Constant(0.0))",
        "radio: (range: 2.0, latency: Constant(1.2))",
        "radio: (technology: Ieee802154(), queue: 2, transmit_power: -25.0, fading: Rayleigh())",
        "radio: (technology: ArgosRab())",
        "radio: (technology: Ieee802154(), access: Aloha(duty_cycle: 0.3), transmit_power: -20.0, transmit_power_spread: 3.0)",
    ])
}

fn whatever() -> impl Strategy<Value = String> {
    let faults = prop::sample::select(vec![
        "",
        "Crash(robots: [3, 4], at: 2.0, lasts: For(1.5)), Mute(robots: [5], at: 1.0)",
        "Deaf(robots: [3], at: 1.0, lasts: For(2.0)), Partition(line: ((0.1, -5.0), (0.0, 5.0)), during: Between(1.0, 3.0))",
    ]);
    let metrics = prop::sample::select(vec![
        "sample_interval: 1.0",
        "sample_interval: 0.3, series_every: 2",
        "sample_interval: 0.7, series_every: 3",
        "sample_interval: 0.5, series_every: 0",
        "sample_interval: 0.0",
        "sample_interval: 1.0, pairs: true",
    ]);
    let control = prop::sample::select(vec![
        "phase: Random",
        "phase: Together",
        "phase: Random, wake: OnReception",
        "phase: Random, clock_drift: 20000.0",
    ]);
    let parts = (protocol(), radio(), faults, metrics, control, any::<u64>(), 1..50_u32);
    parts.prop_map(|(protocol, radio, faults, metrics, control, seed, tenths)| {
        let seconds = 2.0 + f64::from(tenths) / 10.0;
        format!(
            "Scenario(name: \"any\", seed: {seed}, time_limit: {seconds:?}, arena: (size: (6.0, 6.0)), swarm: (robots: 10, deploy: Uniform), \
             control: (period: 0.2, {control}), faults: [{faults}], metrics: ({metrics}, record: {ALL}), {radio}, {protocol})"
        )
    })
}

/// What one case may happen not to have, these do.
#[test]
fn what_the_tables_are_about_happens() {
    let text = |sections: &str| {
        format!(
            "Scenario(name: \"full\", time_limit: 20.0, arena: (size: (6.0, 6.0)), control: (period: 0.2), \
             metrics: (record: {ALL}), {sections})"
        )
    };
    let rumours = check(&text(
        "swarm: (robots: 12, deploy: Uniform), protocol: Rumor(sources: Random(3), completion: Reached), \
         gossip: (piggyback: true, relay: (interval: 0.4)), \
         radio: (technology: Ieee802154(), transmit_power: -46.0, fading: Rayleigh())",
    ));
    let second_hand = rumours.asked.hops.iter().filter(|hop| hop.hops > 1);
    assert!(second_hand.count() > 5);
    let mut fates = TopicFates::default();
    let bands = rumours.asked.delivery.iter();
    bands.clone().for_each(|band| fates.add(&band.fates));
    let causes = fates.lost.iter().filter(|lost| **lost > 0).count();
    assert!(bands.len() > 4 && causes > 1 && fates.delivered > 0, "{fates}");
    let backbone = check(&text(
        "swarm: (robots: 12, deploy: Cluster(radius: 0.9)), protocol: Backbone(targets: Ring(count: 2, radius: 1.0)), \
         radio: (range: 2.0, loss: Bernoulli(0.1)), \
         faults: [Crash(robots: [3, 4], at: 2.0, lasts: For(5.0))]",
    ));
    assert!(backbone.asked.roles.len() > backbone.robots.len() + 1);
    let failed = backbone.asked.degree.iter().flat_map(|sample| sample.neighbours);
    assert!(failed.filter(Option::is_none).count() > 5);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn every_table_adds_up_to_what_is_always_kept_whatever_the_scenario(text in whatever()) {
        check(&text);
    }
}
