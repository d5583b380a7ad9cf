//! What passes between every two robots, against closed forms.

use desim::experiment::run_trial;
use desim::metrics::{PAIR_MEASURES, PairRecord, TrialRecord};
use desim::scenario::{Scenario, parse};
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

/// Seconds between statuses, the share of them that is lost, and how long the others take.
const INTERVAL: f64 = 0.5;
const LOSS: f64 = 0.3;
const LATENCY: f64 = 0.02;

/// Two robots in range of each other and a third that is not.
fn trials(sections: &str) -> Vec<TrialRecord> {
    let text = format!(
        "Scenario(name: \"pairs\", time_limit: 2000.0, arena: (size: (10.0, 10.0)), protocol: Heartbeat, \
         swarm: (robots: 3, deploy: At([(0.0, 0.0), (1.0, 0.0), (4.0, 4.0)])), gossip: (status: (interval: {INTERVAL:?})), \
         radio: (range: 2.0, loss: Bernoulli({LOSS:?}), latency: Constant({LATENCY:?})), detector: None, {sections})"
    );
    let scenario: Scenario = parse("pairs.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
    let run = |trial| run_trial(&scenario, trial, DriverKind::Inline, &CancellationToken::new());
    (0..20).map(|trial| run(trial).expect("it reaches its end")).collect()
}

fn value(pair: &PairRecord, key: &str) -> f64 {
    let place = PAIR_MEASURES.iter().position(|measure| measure.key == key).unwrap();
    pair.values[place].unwrap()
}

/// The mean of a measure over trials and both pairs is what it should be, but for four standard errors and a `rounding`.
fn assert_mean(trials: &[TrialRecord], key: &str, expected: f64, rounding: f64) {
    let values: Vec<f64> = trials
        .iter()
        .flat_map(|trial| &trial.pairs)
        .map(|pair| value(pair, key))
        .collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let off = (mean - expected).abs();
    assert!(
        off < 4.0 * (variance / n).sqrt() + rounding,
        "{key}: {mean} instead of {expected}"
    );
}

#[test]
fn two_robots_in_range_are_two_pairs_and_each_copy_counts_once() {
    let trials = trials("metrics: (pairs: true)");
    for trial in &trials {
        let who: Vec<_> = trial
            .pairs
            .iter()
            .map(|pair| (pair.sender.0, pair.receiver.0))
            .collect();
        assert_eq!(who, [(0, 1), (1, 0)]);
        let sum = |count: fn(&PairRecord) -> u64| trial.pairs.iter().map(count).sum::<u64>();
        let fates = &trial.ledger[0];
        assert_eq!(
            (sum(|pair| pair.offered), sum(|pair| pair.delivered)),
            (fates.offered, fates.delivered)
        );
    }
    assert_mean(&trials, "delivery_ratio", 1.0 - LOSS, 0.0);
}

#[test]
fn the_age_of_periodic_statuses_under_loss_is_that_of_the_closed_forms() {
    // A status arrives with probability 1 − p, the k-th after the last that did with k geometric: E k = 1/(1 − p), E k² = (1 + p)/(1 − p)².
    // Ages are those of the arrival, Δ k longer before the next: mean Δ E k² / 2 E k, peak Δ E k; longer than Δ (m + f) for a share
    // pᵐ (1 − f (1 − p)) of the time, which is 5 % at m = 2, f = 0.634921.
    let trials = trials("metrics: (pairs: true)");
    assert_mean(
        &trials,
        "age_mean_s",
        LATENCY + INTERVAL * (1.0 + LOSS) / (2.0 * (1.0 - LOSS)),
        0.0,
    );
    assert_mean(&trials, "age_peak_s", LATENCY + INTERVAL / (1.0 - LOSS), 0.0);
    let p95 = LATENCY + INTERVAL * 2.634_921;
    assert_mean(&trials, "age_p95_s", p95, p95 / 256.0);
}

#[test]
fn pairs_cost_nothing_and_change_nothing_where_nobody_asks_for_them() {
    for (asked, not) in trials("metrics: (pairs: true)").into_iter().zip(trials("metrics: ()")) {
        assert!(not.pairs.is_empty());
        let without = TrialRecord {
            pairs: Vec::new(),
            ..asked
        };
        assert_eq!(without, not);
    }
}
