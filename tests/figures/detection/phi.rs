//! φ-accrual: what φ = 8 means in each dialect, for heartbeats that come every second.

use desim::metrics::detection::Verdict;

use super::{ROBOTS, heartbeats};

/// The window of ten intervals is full of whole seconds when the robot falls silent, so that nothing is left of what was
/// assumed before: 8 · 1 s; 8 · ln 10 · 1 s = 18.4207 s; 1 s + 3 s + 0.1 s · y = 4.5226 s, where y = 5.2260 solves Akka's cubic.
#[test]
fn each_dialect_suspects_exactly_when_its_phi_is_eight() {
    for (dialect, silence) in [
        ("Chitchat", 8.0),
        ("Cassandra", 8.0 * std::f64::consts::LN_10),
        ("Akka", 4.5226),
    ] {
        let detector = format!("PhiAccrual(dialect: {dialect}, window: 10)");
        let faults = "faults: [Mute(robots: [3], at: 30.4)],";
        let record = heartbeats(&detector, "None", 1.0, 60.0, faults);
        let suspicions = &record.detection.suspicions;
        assert_eq!(
            suspicions.len(),
            ROBOTS as usize - 1,
            "{dialect}: once by everybody else"
        );
        for suspicion in suspicions {
            assert_eq!((suspicion.subject.0, suspicion.verdict()), (3, Verdict::Right));
            let after = suspicion.at.since(suspicion.heard).as_secs();
            assert!((after - silence).abs() < 5e-5, "{dialect}: after {after} s");
        }
    }
}

/// In its first seconds a robot knows no interval but the one that is assumed: with intervals of 1 s assumed to be 2 s,
/// chitchat waits for 8 · 2 s after one heartbeat.
#[test]
fn until_intervals_were_seen_the_assumed_one_counts() {
    let detector = "PhiAccrual(dialect: Chitchat, initial_interval: Seconds(2.0))";
    let record = heartbeats(detector, "None", 1.0, 30.0, "faults: [Mute(robots: [3], at: 1.0)],");
    assert!(!record.detection.suspicions.is_empty());
    for suspicion in &record.detection.suspicions {
        let after = suspicion.at.since(suspicion.heard).as_secs();
        assert!((after - 16.0).abs() < 1e-6, "after {after} s");
    }
}

/// With one heartbeat in five lost, intervals have the mean 1/0.8 s and the deviation √0.2/0.8 s, for which Akka's φ is 8 after
/// 1.25 + 3 + 5.2260 · 0.559 = 7.17 s: seven losses in a row, of which 380 pairs are expected to see 380 · 540 · 0.8 · 0.2⁷ = 2 in
/// nine minutes, and with the window's own scatter a few more. A timeout as long as the silence without loss, 4.52 s, would
/// err after four: 263 times.
#[test]
fn akka_learns_to_bear_the_loss_that_it_sees() {
    let record = heartbeats("PhiAccrual(dialect: Akka)", "Bernoulli(0.2)", 1.0, 600.0, "");
    let late = record.detection.suspicions.iter();
    let late = late.filter(|suspicion| suspicion.at.as_secs() > 60.0).count();
    assert!(late < 20, "{late} mistakes");
}
