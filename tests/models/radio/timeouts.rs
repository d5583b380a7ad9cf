//! Heartbeats over the medium, watched by a timeout: what a failure detector makes of each loss model.
//!
//! A heartbeat is sent every η; the watcher suspects when none has arrived for TO, and trusts again at the next
//! arrival. Let G be the number of periods between two arrivals, and m = ⌊TO/η⌋: a gap with G > m is a mistake, of
//! duration Gη − TO. Gaps are independent under Bernoulli loss and under Gilbert's (an arrival finds the link good), so
//! mistakes recur as sums of independent gaps: one with G > m, then K with G ≤ m, where K is geometric with success
//! probability q = P(G > m). Hence, with conditional means and variances,
//!
//! - E[T_MR] = η (E[G | G>m] + E[K] E[G | G≤m]), E[K] = (1−q)/q, Var[K] = (1−q)/q²;
//! - Var[T_MR] = η² (Var[G | G>m] + E[K] Var[G | G≤m] + Var[K] E[G | G≤m]²);
//! - T_M = Gη − TO given G > m, whose variance is η² Var[G | G>m];
//! - 1 − P_A is the ratio R of the summed durations to the summed recurrences, whose standard error over n mistakes is
//!   √(Var[T_M − R T_MR] / n) / E[T_MR], where Cov[T_M, T_MR] = Var[T_M] as a mistake's own gap opens its recurrence.

use desim::engine::{ActorId, SimTime, Span};
use desim::radio::{Fate, LossConfig};

use super::statistics::{assert_near, mean, variance};
use super::{gilbert, listeners, losing, losses, medium, probability};

/// Heartbeat period η, seconds.
const PERIOD: f64 = 1.0;

/// What a watcher's mistakes should be on average.
struct Expected {
    recurrence: f64,
    duration: f64,
}

/// What they were: for each mistake its duration and the time from its start to the next one's.
struct Mistakes {
    durations: Vec<f64>,
    recurrences: Vec<f64>,
}

/// Lets a watcher with `timeout` seconds listen until `count` mistakes and the start of one more are behind it.
fn mistakes(loss: &LossConfig, timeout: f64, count: usize) -> Mistakes {
    let mut medium = medium(&losing(loss.clone()), 2);
    let timeout = Span::from_secs(timeout);
    let mut suspicions: Vec<(SimTime, SimTime)> = Vec::new();
    let mut last = None;
    let mut now = SimTime::ZERO;
    while suspicions.len() <= count {
        medium.transmit(now, ActorId(0), listeners(1..2, 1.0), |_, fate| {
            let Fate::Arrives { at, .. } = fate else { return };
            let deadline = last.map(|last: SimTime| last + timeout);
            suspicions.extend(
                deadline
                    .filter(|deadline| *deadline < at)
                    .map(|deadline| (deadline, at)),
            );
            last = Some(at);
        });
        now += Span::from_secs(PERIOD);
    }
    let starts = suspicions.windows(2);
    Mistakes {
        durations: suspicions[..count]
            .iter()
            .map(|(start, end)| end.since(*start).as_secs())
            .collect(),
        recurrences: starts.map(|pair| pair[1].0.since(pair[0].0).as_secs()).collect(),
    }
}

/// Probability, mean and variance of the gaps among `gaps` (P(G = 1), P(G = 2), …) that `chosen` picks.
fn moments(gaps: &[f64], chosen: impl Fn(usize) -> bool) -> [f64; 3] {
    let sum = |f: &dyn Fn(f64) -> f64| -> f64 {
        let picked = (1..).zip(gaps).filter(|(gap, _)| chosen(*gap));
        picked.map(|(gap, share)| share * f(gap as f64)).sum()
    };
    let share = sum(&|_| 1.0);
    let mean = sum(&|gap| gap) / share;
    [share, mean, sum(&|gap| (gap - mean).powi(2)) / share]
}

/// Holds a watcher of `timeout` seconds against `expected`, where gaps have the distribution `gaps`.
fn assert_mistakes(loss: &LossConfig, gaps: &[f64], timeout: f64, expected: &Expected) {
    let count = 10_000;
    let longest_trusted = (timeout / PERIOD).floor() as usize;
    let [q, long, long_variance] = moments(gaps, |gap| gap > longest_trusted);
    let [_, short, short_variance] = moments(gaps, |gap| gap <= longest_trusted);
    let trusted = (1.0 - q) / q;
    let recurrence = PERIOD * (long + trusted * short);
    assert!((recurrence / expected.recurrence - 1.0).abs() < 1e-9);
    assert!((long * PERIOD - timeout - expected.duration).abs() < 1e-9);

    let duration_variance = PERIOD.powi(2) * long_variance;
    let recurrence_variance = PERIOD.powi(2) * (long_variance + trusted * short_variance + trusted / q * short.powi(2));
    let ratio = expected.duration / expected.recurrence;
    let ratio_variance = duration_variance * (1.0 - 2.0 * ratio) + ratio.powi(2) * recurrence_variance;

    let measured = mistakes(loss, timeout, count);
    let error = |variance: f64| (variance / count as f64).sqrt();
    let (durations, recurrences) = (mean(&measured.durations), mean(&measured.recurrences));
    assert_near("E[T_MR]", recurrences, expected.recurrence, error(recurrence_variance));
    assert_near("E[T_M]", durations, expected.duration, error(duration_variance));
    let accuracy = 1.0 - durations / recurrences;
    assert_near(
        "P_A",
        accuracy,
        1.0 - ratio,
        error(ratio_variance) / expected.recurrence,
    );
}

/// E[T_MR] = η / ((1−p) pᵐ) and E[T_M] = (m + 1/(1−p)) η − TO.
#[test]
fn a_timeout_errs_under_independent_loss_as_often_and_as_long_as_its_closed_form_says() {
    for (p, timeout, recurrence, duration, accuracy) in
        [(0.2_f64, 3.5, 156.25, 0.75, 0.9952), (0.1, 2.5, 111.11, 0.6111, 0.9945)]
    {
        let m = f64::floor(timeout / PERIOD);
        let expected = Expected {
            recurrence: PERIOD / ((1.0 - p) * p.powf(m)),
            duration: (m + 1.0 / (1.0 - p)) * PERIOD - timeout,
        };
        assert!((expected.recurrence - recurrence).abs() < 5e-3 && (expected.duration - duration).abs() < 5e-5);
        assert!((1.0 - expected.duration / expected.recurrence - accuracy).abs() < 5e-5);
        let gaps: Vec<f64> = (0..200).map(|lost| (1.0 - p) * p.powi(lost)).collect();
        assert_mistakes(&LossConfig::Bernoulli(probability(p)), &gaps, timeout, &expected);
    }
}

/// E[T_MR] = η (p+r) / (r p (1−r)^(m−1)) and E[T_M] = (m + 1/r) η − TO: the same mean loss of 20 %, four times the
/// mistakes.
#[test]
fn a_timeout_errs_under_bursts_as_often_and_as_long_as_its_closed_form_says() {
    let (p, r, timeout) = (0.05, 0.2, 3.5);
    let expected = Expected {
        recurrence: 39.0625,
        duration: 4.5,
    };
    let burst = (0..2000).map(|longer| p * r * f64::powi(1.0 - r, longer));
    let gaps: Vec<f64> = [1.0 - p].into_iter().chain(burst).collect();
    assert_mistakes(&gilbert(p, r), &gaps, timeout, &expected);
}

/// A robot that fails at phase u of its period, after k losses in a row, is detected TO − (u + k)η later, or at once if
/// it was suspected already: 2.7528 s on average for η = 1 s, TO = 3.5 s, p = 0.2. Phases are spread evenly over the
/// links, which can only narrow the spread that independent ones would have, taken here from the sample.
#[test]
fn a_failure_is_detected_after_the_time_that_the_closed_form_says() {
    let (links, timeout) = (40_000, 3.5);
    let detection_times: Vec<f64> = losses(&LossConfig::Bernoulli(probability(0.2)), links, 40)
        .iter()
        .enumerate()
        .map(|(link, lost)| {
            let phase = (link as f64 + 0.5) / f64::from(links);
            let losses_in_a_row = lost.iter().rev().take_while(|lost| **lost).count() as f64;
            (timeout - (phase + losses_in_a_row) * PERIOD).max(0.0)
        })
        .collect();
    let error = (variance(&detection_times) / f64::from(links)).sqrt();
    assert_near("E[T_D]", mean(&detection_times), 2.7528, error);
}
