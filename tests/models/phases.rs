//! Everything that robots repeat begins at a phase of its own interval, so that what happens at a fixed time falls anywhere in it.
//!
//! Pairs of robots 1 m apart, out of reach of all other pairs, so that each is a sample of its own.

use desim::experiment::run_trial;
use desim::metrics::TrialRecord;
use desim::metrics::detection::FailureOutcome;
use desim::scenario::parse;
use desim::simulation::DriverKind;
use tokio_util::sync::CancellationToken;

const PAIRS: u32 = 40;
const LATENCY: f64 = 0.05;

/// A trial of 2 · 40 robots: robots 2k and 2k + 1 are a pair.
fn trial_of(protocol: &str, trial: u32, seconds: f64, settings: &str) -> TrialRecord {
    let places: Vec<String> = (0..2 * PAIRS)
        .map(|robot| {
            let (column, row) = (robot / 2 % 8, robot / 16);
            let x = 5.0 * f64::from(column) + f64::from(robot % 2) - 18.0;
            format!("({x:?}, {:?})", 5.0 * f64::from(row) - 10.0)
        })
        .collect();
    let text = format!(
        "Scenario(name: \"pairs\", time_limit: {seconds:?}, arena: (size: (40.0, 25.0)),
         swarm: (robots: {}, deploy: At([{}])), protocol: {protocol},
         radio: (range: 2.0, latency: Constant({LATENCY:?})), motion: (tick: 0.05), {settings})",
        2 * PAIRS,
        places.join(", "),
    );
    let scenario = parse("pairs.ron", &text, &[]).unwrap_or_else(|report| panic!("{report}"));
    run_trial(&scenario, trial, DriverKind::Inline, &CancellationToken::new()).expect("the trial reaches its end")
}

/// One of each pair, the first in even pairs and the second in odd ones.
fn one_of_each() -> Vec<u32> {
    (0..PAIRS).map(|pair| 2 * pair + pair % 2).collect()
}

/// How long the other of each pair takes to detect a failure of the robots `mute` at `at` seconds, with who failed.
fn detection_times(trials: u32, mute: &[u32], at: f64, settings: &str) -> Vec<(u32, f64)> {
    let faults = format!("metrics: (sample_interval: 0.0), faults: [Mute(robots: {mute:?}, at: {at:?})], {settings}");
    let mut times = Vec::new();
    for trial in 0..trials {
        let record = trial_of("Heartbeat", trial, at + 20.0, &faults);
        assert_eq!(record.detection.failures.len(), mute.len());
        times.extend(record.detection.failures.iter().map(|failure| match failure.outcome {
            FailureOutcome::Detected(after) => (failure.subject.0, after.as_secs()),
            other => panic!("{other:?}"),
        }));
    }
    times
}

/// Kolmogorov and Smirnov: the largest distance between the samples' distribution and the uniform one from `low` to `high`,
/// times the root of their number. Above 1.95 with probability 0.001.
fn distance_from_uniform(samples: impl Iterator<Item = f64>, low: f64, high: f64) -> f64 {
    let mut shares: Vec<f64> = samples.map(|sample| (sample - low) / (high - low)).collect();
    shares.sort_by(f64::total_cmp);
    let number = shares.len() as f64;
    let distance = |(index, share): (usize, &f64)| {
        let below = index as f64 / number;
        (share - below).abs().max((below + 1.0 / number - share).abs())
    };
    shares.iter().enumerate().map(distance).fold(0.0, f64::max) * number.sqrt()
}

/// A robot that fails at any time of its interval is detected uniformly between TO + d − η and TO + d: on average after
/// TO + d − η/2, σ η/√12. Intervals are rounded up to whole control periods: 1.0 s at 0.3 s are 1.2 s. 400 failures each; of
/// 13 tests at 0.001 each one fails a right program in 77 seeds, and this seed is fixed.
#[test]
fn a_failure_at_any_time_of_the_interval_is_detected_after_a_time_that_is_uniform() {
    for (period, interval, rounded, timeout, offsets) in [
        (0.1, 1.0, 1.0, 3.55, &[30.0, 30.25, 30.5, 30.95][..]),
        (1.0, 1.0, 1.0, 3.55, &[30.0, 30.5, 30.95]),
        (0.3, 1.0, 1.2, 4.25, &[30.0, 30.61, 31.1]),
        (0.25, 0.5, 0.5, 1.8, &[30.01, 30.26, 30.49]),
    ] {
        for &at in offsets {
            let what = format!("period {period} s, interval {interval} s, failure at {at} s");
            let settings = format!(
                "control: (period: {period:?}, wake: OnReception), gossip: (status: (interval: {interval:?})),
                 detector: Timeout({timeout:?})"
            );
            let times = detection_times(10, &one_of_each(), at, &settings);
            let distance = distance_from_uniform(
                times.iter().map(|time| time.1),
                timeout + LATENCY - rounded,
                timeout + LATENCY,
            );
            assert!(distance < 1.95, "{what}: {distance}");
        }
    }
}

/// Together, every status is sent at a whole interval: a failure 0.25 s after one is detected 0.25 s sooner than TO + d.
#[test]
fn robots_that_begin_together_are_all_detected_at_one_instant() {
    let settings = "control: (phase: Together, wake: OnReception), gossip: (status: (interval: 1.0)),
                    detector: Timeout(3.55)";
    let times = detection_times(1, &one_of_each(), 30.25, settings);
    assert!(
        times
            .iter()
            .all(|(_, time)| (time - (3.55 + LATENCY - 0.25)).abs() < 1e-9),
        "{times:?}"
    );
}

/// A robot that falls silent is pinged within a probe interval of 1 s, uniformly, does not answer for as long, and has then
/// log₁₀ 80 · 4 = 7.612 s to deny it. 40 robots fail in each of 20 trials; the mean of one is off by σ = 0.2887/√20 = 0.0645,
/// the largest of 40 by less than four of it but for 40 · 6.3e-5 = 0.25 %.
#[test]
fn whichever_robot_falls_silent_swim_takes_as_long_to_find_it() {
    let settings = "detector: Swim(indirect_checks: 0), control: (wake: OnReception)";
    let times = detection_times(20, &one_of_each(), 30.0, settings);
    let least = 1.0 + 4.0 * 80_f64.log10();
    let distance = distance_from_uniform(times.iter().map(|time| time.1), least, least + 1.0);
    assert!(distance < 1.95, "{distance}");
    for robot in one_of_each() {
        let of_robot: Vec<f64> = times.iter().filter(|time| time.0 == robot).map(|time| time.1).collect();
        let mean = of_robot.iter().sum::<f64>() / 20.0;
        assert!((mean - least - 0.5).abs() < 4.0 * 0.0645, "robot {robot}: {mean}");
    }
}

/// A rumour that robot 2k begins at its first control step reaches robot 2k + 1 with the first round, anywhere within the interval
/// of 1.3 s, at whatever period. 40 rumours in each of 10 trials.
#[test]
fn rounds_of_rumours_begin_anywhere_in_their_interval() {
    let sources: Vec<u32> = (0..PAIRS).map(|pair| 2 * pair).collect();
    for period in [0.1, 0.65, 1.3] {
        let settings = format!(
            "control: (period: {period:?}, wake: OnReception), gossip: (relay: (interval: 1.3)), metrics: (sample_interval: 0.0, hold: 0.0)"
        );
        let protocol = format!("Rumor(mode: Push, sources: Robots({sources:?}))");
        let mut first = Vec::new();
        for trial in 0..10 {
            let record = trial_of(&protocol, trial, 3.0, &settings);
            first.extend(record.spread.iter().zip(0..).map(|(rumor, pair)| {
                let informed = rumor.informed[2 * pair + 1].expect("it is in reach of the source");
                informed.as_secs() - LATENCY
            }));
        }
        let distance = distance_from_uniform(first.into_iter(), 0.0, 1.3);
        assert!(distance < 1.95, "period {period} s: {distance}");
    }
}
