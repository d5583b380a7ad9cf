//! Robots that wander, whose detectors are judged by the time in which they are in range of each other.
//!
//! When two robots meet and part has nothing to do with their heartbeats or with what the channel loses. So what is monitored of a pair
//! is pieces of the stationary process of two robots that stand in range for ever, and with q = P(G > m), s and μ as in
//! [`timeout`](super::timeout) mistakes recur every μ = η/(s q), last E[T_M] = η E[G | G>m] − TO, and take E[T_M]/μ of the time,
//! however many robots there are and however fast. Each figure is a ratio of sums over trials, which are independent of each
//! other: with n trials of numerators aᵢ and denominators bᵢ its standard error is √(Σ(aᵢ − R bᵢ)²/(n(n−1))) / b̄. A figure must lie
//! within four standard errors, and those must be small enough to tell it from the share of time in which robots are in range.

use desim::experiment::run_trial;
use desim::metrics::TrialRecord;
use desim::metrics::detection::Verdict;
use desim::scenario::parse;
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

use super::{Channel, assert_near, bernoulli, gilbert, moments};

const TRIALS: u32 = 10;

/// Trials of `robots` robots that wander over an arena of `side` metres.
fn wander(
    robots: u32,
    side: f64,
    wander: &str,
    loss: &str,
    [period, timeout]: [f64; 2],
    seconds: f64,
) -> Vec<TrialRecord> {
    let text = format!(
        "Scenario(name: \"wander\", time_limit: {seconds:?}, arena: (size: ({side:?}, {side:?})),
         swarm: (robots: {robots}, deploy: Uniform), motion: (max_speed: 0.4), protocol: Heartbeat, wander: {wander},
         control: (period: {period:?}, phase: Random, wake: OnReception), gossip: (status: (interval: {period:?})),
         detector: Timeout({timeout:?}), radio: (range: 2.0, loss: {loss}, latency: Constant(0.02)),
         metrics: (sample_interval: 0.0))"
    );
    let scenario = parse("wander.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
    let run = |trial| run_trial(&scenario, trial, DriverKind::Inline, &CancellationToken::new());
    (0..TRIALS)
        .map(|trial| run(trial).expect("the trial reaches its end"))
        .collect()
}

/// A ratio of sums over trials and its standard error.
fn ratio(records: &[TrialRecord], parts: impl Fn(&TrialRecord) -> [f64; 2]) -> (f64, f64) {
    let parts: Vec<[f64; 2]> = records.iter().map(parts).collect();
    let sum = |part: usize| parts.iter().map(|parts| parts[part]).sum::<f64>();
    let (ratio, n) = (sum(0) / sum(1), parts.len() as f64);
    let residuals = parts.iter().map(|[a, b]| (a - ratio * b).powi(2)).sum::<f64>();
    (ratio, (residuals / (n * (n - 1.0))).sqrt() / (sum(1) / n))
}

fn assert_as_in_range(channel: &Channel, robots: u32, side: f64, way: &str, [period, timeout]: [f64; 2], seconds: f64) {
    let what = format!("{robots} robots, {way}, {}", channel.loss);
    let m = (timeout / period).floor() as usize;
    let q: f64 = channel.gaps[m..].iter().sum();
    let recurrence = period / (channel.arriving * q);
    let duration = period * moments(&channel.gaps, |gap| gap > m).0 - timeout;

    let records = wander(robots, side, way, &channel.loss, [period, timeout], seconds);
    let mistakes = |record: &TrialRecord| {
        let suspicions = record.detection.suspicions.iter();
        suspicions
            .filter(|suspicion| suspicion.verdict() == Verdict::Mistake)
            .count() as f64
    };
    let suspicions: usize = records.iter().map(|record| record.detection.suspicions.len()).sum();
    let mistaken: f64 = records.iter().map(mistakes).sum();
    assert!(suspicions as f64 > 1.3 * mistaken, "{what}: many robots left the range");
    for (figure, parts, expected) in [
        (
            "λ_M",
            &(|record: &TrialRecord| [mistakes(record), record.detection.monitored_s])
                as &dyn Fn(&TrialRecord) -> [f64; 2],
            1.0 / recurrence,
        ),
        (
            "T_M",
            &|record| [record.detection.mistaken_s, mistakes(record)],
            duration,
        ),
        (
            "1 − P_A",
            &|record| [record.detection.mistaken_s, record.detection.monitored_s],
            duration / recurrence,
        ),
    ] {
        let (measured, error) = ratio(&records, parts);
        assert!(
            error < 0.05 * expected,
            "{what}: {figure} is known to {error}, which tells too little"
        );
        assert_near(&format!("{what}: {figure}"), measured, expected, error);
    }
}

#[test]
fn fifteen_to_a_hundred_wandering_robots_make_the_mistakes_of_robots_in_range_at_any_speed() {
    for (robots, side, way, seconds) in [
        (15, 5.0, "RandomWaypoint(speed: 0.04)", 600.0),
        (15, 5.0, "RandomWalk(speed: 0.3, leg: 4.0)", 600.0),
        (40, 8.0, "RandomWalk(speed: 0.04, leg: 15.0)", 200.0),
        (100, 12.0, "RandomWaypoint(speed: 0.3)", 100.0),
    ] {
        assert_as_in_range(&bernoulli(0.2), robots, side, way, [0.5, 1.8], seconds);
    }
}

/// A mistake of 4.5 s on average is long beside the time that robots spend in range: many are cut off, and many a robot is not heard
/// for a while as it comes into range. Robots that part again before one has heard the other for the first time are no pair yet, so
/// that these runs are long enough for all to have met before.
#[test]
fn robots_that_wander_under_bursts_make_the_mistakes_of_robots_in_range_at_any_speed() {
    for (robots, side, way, seconds) in [
        (15, 5.0, "RandomWaypoint(speed: 0.1)", 1500.0),
        (20, 6.0, "RandomWalk(speed: 0.3, leg: 4.0)", 1000.0),
    ] {
        assert_as_in_range(&gilbert(0.05, 0.2), robots, side, way, [1.0, 3.5], seconds);
    }
}
