//! Rumours against the SI epidemic: while n of N robots know, each of the others learns at rate β (1 − p) n / (N − 1).
//! The times between one and the next are exponential, so T is a sum of independent exponentials with the means
//! (N − 1) / (β (1 − p) n (N − n)), n = 1 to N − 1: its mean is their sum, its variance the sum of their squares.

use desim::metrics::{Outcome, Summary, TopicFates, TrialRecord};
use desim::scenario::Scenario;

use super::run;

const ROBOTS: u32 = 20;

fn scenario(more: &str) -> Scenario {
    super::scenario(&format!(
        "Scenario(name: \"si\", time_limit: 200.0, swarm: (robots: {ROBOTS}, deploy: Cluster(radius: 0.9)),
         radio: (loss: Bernoulli(0.5), latency: Constant(0.0)), metrics: (hold: 0.0, sample_interval: 0.0), {more})"
    ))
}

fn time_to_all(record: &TrialRecord) -> f64 {
    let times = record.spread[0].informed.iter();
    let times = times.map(|at| at.expect("every robot was informed").as_secs());
    times.fold(0.0, f64::max)
}

/// The mean and the variance of T for contacts at `rate`.
fn epidemic(rate: f64) -> (f64, f64) {
    let robots = f64::from(ROBOTS);
    let stages = (1..ROBOTS).map(|n| (robots - 1.0) / (rate * f64::from(n) * (robots - f64::from(n))));
    stages.fold((0.0, 0.0), |(mean, variance), stage| {
        (mean + stage, variance + stage * stage)
    })
}

#[test]
fn the_sum_of_the_stages_is_the_closed_form() {
    let harmonic: f64 = (1..ROBOTS).map(|n| 1.0 / f64::from(n)).sum();
    let robots = f64::from(ROBOTS);
    let closed = 2.0 * (robots - 1.0) * harmonic / robots;
    let (mean, variance) = epidemic(1.0);
    assert!((mean - closed).abs() < 1e-12 && (mean - 6.741).abs() < 5e-4, "{mean}");
    assert!((variance - 3.517).abs() < 5e-4, "{variance}");
}

/// Rate 2/s, loss 0.5: an epidemic of rate 1/s. The mean of 200 trials lies within four of its standard errors,
/// √(3.517/200) = 0.133 s. Their variance has a standard error of √((κ − 1)/n) of itself, where κ, the kurtosis of T, is
/// 3 + 6 · Σ stage⁴ / (Σ stage²)² = 4.08: 0.124 of it. Four of those.
#[test]
fn pushed_at_poisson_times_to_a_uniform_peer_a_rumour_takes_the_time_of_the_si_epidemic() {
    let scenario = scenario("protocol: Rumor(rounds: Poisson), gossip: (relay: (interval: 0.5, fan_out: Peers(1)))");
    let times: Vec<f64> = run(&scenario, 200).iter().map(time_to_all).collect();
    let mean = times.iter().sum::<f64>() / 200.0;
    let (expected, variance) = epidemic(1.0);
    assert!(
        (mean - expected).abs() < 4.0 * (variance / 200.0).sqrt(),
        "{mean} for {expected}"
    );
    let spread = times.iter().map(|time| (time - mean).powi(2)).sum::<f64>() / 199.0;
    assert!(
        (spread / variance - 1.0).abs() < 4.0 * 0.124,
        "variance {spread} for {variance}"
    );
}

/// The stages are the same read the other way round: one of the N − n asks at rate β, and meets one of the n with
/// probability n / (N − 1). Request and answer must both arrive: a rate of 4 · 0.5² = 1/s.
#[test]
fn pulled_it_takes_as_long_at_the_rate_at_which_both_request_and_answer_arrive() {
    // A robot answers when it wakes: here at once.
    let scenario = scenario(
        "control: (wake: OnReception), protocol: Rumor(mode: Pull, rounds: Poisson),
         gossip: (relay: (interval: 0.25, fan_out: Peers(1)))",
    );
    let times: Vec<f64> = run(&scenario, 200).iter().map(time_to_all).collect();
    let mean = times.iter().sum::<f64>() / 200.0;
    let (expected, variance) = epidemic(1.0);
    assert!(
        (mean - expected).abs() < 4.0 * (variance / 200.0).sqrt(),
        "{mean} for {expected}"
    );
}

/// All 19 others hear each of the rounds' broadcasts with probability 0.5, so in a round of one source alone the number
/// informed is binomial: over 300 trials 2,850 of 5,700, σ 38. Four σ.
#[test]
fn a_broadcast_informs_each_robot_in_range_with_the_probability_that_it_arrives() {
    let scenario = Scenario {
        time_limit: desim::quantity::Positive::new(0.15),
        ..scenario(
            "control: (phase: Together), protocol: Rumor(sources: Robots([4])), gossip: (relay: (interval: 50.0))",
        )
    };
    let records = run(&scenario, 300);
    let informed = |record: &TrialRecord| record.spread[0].informed.iter().flatten().count() - 1;
    let all: usize = records.iter().map(informed).sum();
    assert!((all as f64 - 2850.0).abs() < 4.0 * 38.0, "{all}");
    assert!(records.iter().all(|record| record.outcome == Outcome::Censored));
}

#[test]
fn what_robots_hear_twice_is_counted_and_a_finished_rumour_ends_the_trial() {
    let scenario = scenario("protocol: Rumor(), gossip: (relay: (interval: 0.1))");
    for record in run(&scenario, 5) {
        let Outcome::Completed { step } = record.outcome else {
            panic!("{:?}", record.outcome)
        };
        assert_eq!(record.steps, step + 1, "it is not held");
        let received: u64 = record.traffic.iter().map(|row| row.received.frames).sum();
        let duplicate: u64 = record.traffic.iter().map(|row| row.duplicate.frames).sum();
        let read: u64 = received - record.ledger[0].in_flight;
        assert!(duplicate + u64::from(ROBOTS) - 1 <= read, "{duplicate} of {received}");
        assert!(duplicate > 0 && record.ledger.iter().all(TopicFates::is_balanced));
    }
}

/// All of ten robots in range of each other crash at 1.5 s, before those that heard the rumour at once have told the rest, and are
/// well again 20 s later. Nobody knows anything meanwhile, so nothing is known to all.
#[test]
fn a_rumour_is_not_known_to_all_while_nobody_is_alive() {
    let text = |rule: &str| {
        format!(
            "Scenario(name: \"dead\", time_limit: 60.0, swarm: (robots: 10, deploy: Cluster(radius: 0.6)), control: (period: 1.0),
             protocol: Rumor(mode: PushPull, sources: Robots([3]), completion: {rule}), gossip: (relay: (interval: 1.0)),
             radio: (loss: Bernoulli(0.5)), faults: [Crash(robots: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9], at: 0.5, lasts: For(20.0))])"
        )
    };
    for rule in ["Reached", "EachVisited", "Held(3.0)"] {
        for record in run(&super::scenario(&text(rule)), 5) {
            let Outcome::Completed { step } = record.outcome else {
                panic!("{:?}", record.outcome)
            };
            assert!(step >= 20, "complete after {step} steps, while all were down");
            assert!(record.spread[0].informed.iter().all(Option::is_some));
        }
    }
}

/// Robots 5 and 6 crash at the start, and stay so: they learn nothing, and nobody waits for them. Then all crash.
#[test]
fn robots_that_are_down_at_the_end_count_neither_among_the_informed_nor_among_those_to_be() {
    let summary = |robots: &str| {
        let faults = format!("faults: [Crash(robots: {robots}, at: 0.001)]");
        let scenario = scenario(&format!(
            "protocol: Rumor(), gossip: (relay: (interval: 0.1)), {faults}"
        ));
        let records = run(&scenario, 4);
        let unaware = |record: &TrialRecord| record.spread[0].informed.iter().any(Option::is_none);
        assert!(records.iter().all(unaware));
        Summary::of(
            "down",
            scenario.protocol.all_topics(),
            &["ignorant", "knowing"],
            &records,
        )
    };
    let spread = summary("[5, 6]").spread.expect("rumours spread");
    assert_eq!(spread.informed_ratio.estimate.value, Some(1.0));
    assert!(spread.time_to_all.median.value.is_some());
    let everybody: Vec<u32> = (0..ROBOTS).collect();
    assert!(
        summary(&format!("{everybody:?}")).spread.is_none(),
        "of nobody nothing is said"
    );
}
