//! Tables of runs of which is known what is in them.

use desim::engine::{SimTime, Span};
use desim::metrics::{DelayEntry, RoleChange, TopicFates};
use desim::radio::LossCause;

use super::check;

/// Three robots in a row, of which the outer ones hear the one in the middle, 1 m and 2 m away. Each says a status every half second, at 0.0 s to 9.5 s, and at 10 s.
fn row(sections: &str) -> String {
    format!(
        "Scenario(name: \"row\", time_limit: 10.0, arena: (size: (10.0, 10.0)), protocol: Heartbeat, detector: None, \
         swarm: (robots: 3, deploy: At([(-1.0, 0.0), (0.0, 0.0), (2.0, 0.0)])), control: (period: 0.5, phase: Together), \
         gossip: (status: (interval: 0.5)), {sections})"
    )
}

const STATUSES: u64 = 21;

#[test]
fn copies_stand_in_the_band_of_their_distance() {
    let record = check(&row(
        "metrics: (record: [Delivery, Delays, Degree, Hops, Traffic, Roles]), \
         radio: (range: 2.5, loss: Distance(at_range: 1.0, exponent: 1), latency: Constant(0.7))",
    ));
    let bands: Vec<_> = record
        .asked
        .delivery
        .iter()
        .map(|band| (band.from_m, band.to_m))
        .collect();
    let fourth = 2.0_f64.powf(0.25);
    assert_eq!(bands.len(), 2);
    for ((from, to), metres) in bands.into_iter().zip([1.0, 2.0]) {
        assert!((from - metres).abs() < 1e-12 && (to - metres * fourth).abs() < 1e-12);
    }
    for (band, loss) in record.asked.delivery.iter().zip([1.0 / 2.5, 2.0 / 2.5]) {
        let TopicFates { offered, lost, .. } = band.fates;
        assert_eq!(offered, 2 * STATUSES);
        // Four standard errors of as many draws.
        let expected = offered as f64 * loss;
        let error = 4.0 * (expected * (1.0 - loss)).sqrt();
        assert!((lost[LossCause::Channel as usize] as f64 - expected).abs() < error);
        assert_eq!(lost.iter().sum::<u64>(), lost[LossCause::Channel as usize]);
    }
}

/// What is said at 0.0 s arrives at 0.3 s and is read at 0.5 s, as four copies, and so on: five times in 2.6 s. What is said at 10 s arrives at 10.3 s, and nobody reads it before the end.
#[test]
fn delays_are_counted_where_they_are_read_and_what_nobody_reads_in_the_last_window() {
    let text = row(
        "metrics: (sample_interval: 1.3, series_every: 2, record: [Delivery, Delays, Degree, Hops, Traffic, Roles]), \
         radio: (range: 2.5, latency: Constant(0.3))",
    );
    let record = check(&text.replace("time_limit: 10.0", "time_limit: 10.4"));
    let told: Vec<_> = record.asked.delays.iter().collect();
    let span = Span::from_secs(0.3);
    let entry = |window: u32, rounds: u64| DelayEntry {
        since: SimTime::from_secs(f64::from(window) * 2.6),
        at: SimTime::from_secs(f64::from(window + 1) * 2.6),
        topic: 0,
        copies: 4 * rounds,
        mean_s: 0.3,
        min: span,
        median: span,
        p95: span,
        p99: span,
        max: span,
    };
    assert_eq!(told, [entry(0, 5), entry(1, 5), entry(2, 5), entry(3, 6)]);
    assert_eq!(record.ledger[0].in_flight, 0);
}

#[test]
fn windows_of_traffic_hold_the_start_and_the_end() {
    let record = check(&row(
        "metrics: (sample_interval: 1.5, series_every: 2, record: [Delivery, Delays, Degree, Hops, Traffic, Roles]), \
         radio: (range: 2.5, latency: Constant(0.0), frame_header_bytes: 2, message_header_bytes: 3)",
    ));
    // Cut at 3 s, 6 s and 9 s: statuses at 0 to 3 s, at 3.5 to 6 s, at 6.5 to 9 s, at 9.5 and 10 s.
    let sent: Vec<_> = record
        .asked
        .traffic
        .iter()
        .filter(|entry| entry.robot.0 == 1)
        .map(|entry| {
            let times = [entry.since, entry.at].map(SimTime::as_secs);
            (times, entry.sent_frames, entry.sent_bytes / entry.sent_frames)
        })
        .collect();
    let bytes = 4 + 2 + 3;
    let window = |since, at, frames| ([since, at], frames, bytes);
    assert_eq!(
        sent,
        [
            window(0.0, 3.0, 7),
            window(3.0, 6.0, 6),
            window(6.0, 9.0, 6),
            window(9.0, 10.0, 2)
        ]
    );
}

#[test]
fn degrees_are_those_of_the_row_and_of_none_that_fails() {
    let record = check(&row(
        "metrics: (record: [Delivery, Delays, Degree, Hops, Traffic, Roles]), radio: (range: 2.5), \
         faults: [Deaf(robots: [2], at: 3.5, lasts: For(4.0))]",
    ));
    for sample in &record.asked.degree {
        let fails = (3.5..7.5).contains(&sample.at.as_secs());
        let expected = if fails {
            [Some(1), Some(1), None]
        } else {
            [Some(1), Some(2), Some(1)]
        };
        assert_eq!(sample.neighbours, expected, "at {}", sample.at);
    }
    assert_eq!(record.asked.degree.len(), 11);
}

#[test]
fn robots_of_one_role_have_it_from_the_start() {
    let record = check(&row(
        "metrics: (record: [Delivery, Delays, Degree, Hops, Traffic, Roles])",
    ));
    let start = |robot| RoleChange {
        at: SimTime::ZERO,
        robot: desim::engine::ActorId(robot),
        before: None,
        role: 0,
    };
    assert_eq!(
        record.asked.roles.iter().collect::<Vec<_>>(),
        [start(0), start(1), start(2)]
    );
}
