//! Times of which some were cut off: what did not happen by the end counts as not yet, never as not at all.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::{Estimate, FEWEST_FOR_MEDIAN, normal_quantile};

/// How long one trial took, or how long it was watched in vain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// The time.
    pub time: f64,
    /// Whether it happened then; otherwise the trial was cut off (censored).
    pub happened: bool,
}

/// The Kaplan–Meier median: the time at which half of the trials are estimated to be done; where the curve is exactly one half for
/// a while, the middle of it, as in R's `survfit`, so that without cut-offs it is the [median](super::median) of the times. Its interval
/// holds the times at which Greenwood's 95 % band of the curve, under the log(−log) transform, contains one half (Brookmeyer and
/// Crowley, 1982), and is there from six trials on: of fewer it holds the median too seldom. What is not reached before the trials end
/// is absent; and where the curve comes to zero, nothing is known of its band, so that an upper end may be absent without cut-offs too.
#[must_use]
pub fn median_survival(observations: &[Observation]) -> Estimate {
    let curve = survival_curve(observations.iter().copied());
    let longest = observations.iter().map(|seen| seen.time).fold(0.0, f64::max);
    let reached = (1..=curve.len()).find(|&steps| half(&curve[..steps]).is_le());
    let value = reached.map(|steps| {
        let time = curve[steps - 1].time;
        let next = curve.get(steps).map_or(longest, |step| step.time);
        if half(&curve[..steps]).is_eq() {
            f64::midpoint(time, next)
        } else {
            time
        }
    });
    let first = |end: usize| curve.iter().find(|step| step.band[end] <= 0.5).map(|step| step.time);
    let ci95 = if observations.len() >= FEWEST_FOR_MEDIAN {
        [first(0), first(1)]
    } else {
        [None; 2]
    };
    Estimate {
        value,
        ci95,
        n: observations.len() as u64,
    }
}

/// How the curve after these steps compares with one half. The product of its factors is rounded, and one half is where the curve of an
/// even number of trials comes to: near it the factors are multiplied out in whole numbers.
fn half(steps: &[Step]) -> Ordering {
    let survival = steps.last().map_or(1.0, |step| step.survival);
    // Each factor rounds twice, by less than 2.3e-16.
    if (survival - 0.5).abs() > 5e-16 * (steps.len() + 1) as f64 {
        return survival.total_cmp(&0.5);
    }
    let product = |factor: fn(&Step) -> u64| {
        let mut digits = vec![1_u64];
        for step in steps {
            multiply(&mut digits, factor(step));
        }
        digits
    };
    let mut survivors = product(|step| step.at_risk - step.happened);
    multiply(&mut survivors, 2);
    let at_risk = product(|step| step.at_risk);
    let size = survivors.len().cmp(&at_risk.len());
    size.then_with(|| survivors.iter().rev().cmp(at_risk.iter().rev()))
}

/// Multiplies a number, given by its digits to the base 2⁶⁴, the lowest first.
fn multiply(digits: &mut Vec<u64>, factor: u64) {
    let mut carry = 0;
    for digit in digits.iter_mut() {
        let product = u128::from(*digit) * u128::from(factor) + carry;
        *digit = product as u64;
        carry = product >> 64;
    }
    if carry > 0 {
        digits.push(carry as u64);
    }
}

/// The survival curve from one time on until the next step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// The time.
    pub time: f64,
    /// Estimated share of trials that are not done by then.
    pub survival: f64,
    /// Greenwood's 95 % band under the log(−log) transform. Where the curve is zero, which tells nothing of its accuracy, the upper end
    /// is that of the step before.
    pub band: [f64; 2],
    /// Trials that were neither done nor cut off before.
    pub at_risk: u64,
    /// Trials that were done just then.
    pub happened: u64,
}

/// The Kaplan–Meier curve, a step for each time at which something happened. At a tie, what happened came before what
/// was cut off.
#[must_use]
pub fn survival_curve(observations: impl IntoIterator<Item = Observation>) -> Vec<Step> {
    let mut sorted: Vec<Observation> = observations.into_iter().collect();
    sorted.sort_unstable_by(|a, b| a.time.total_cmp(&b.time));
    let mut at_risk = sorted.len() as u64;
    let mut survival = 1.0;
    let mut greenwood = 0.0;
    let mut highest = 1.0;
    let mut curve = Vec::new();
    for tied in sorted.chunk_by(|a, b| a.time.total_cmp(&b.time).is_eq()) {
        let happened = tied.iter().filter(|observation| observation.happened).count() as u64;
        if happened > 0 {
            let (risk, survivors) = (at_risk as f64, (at_risk - happened) as f64);
            survival *= survivors / risk;
            greenwood += happened as f64 / (risk * survivors);
            let band = if survival > 0.0 {
                band(survival, greenwood)
            } else {
                [0.0, highest]
            };
            highest = band[1];
            curve.push(Step {
                time: tied[0].time,
                survival,
                band,
                at_risk,
                happened,
            });
        }
        at_risk -= tied.len() as u64;
    }
    curve
}

/// The 95 % band of the curve at a point, S^exp(±z·σ/ln S): never outside [0, 1].
fn band(survival: f64, greenwood: f64) -> [f64; 2] {
    let width = normal_quantile() * greenwood.sqrt() / -survival.ln();
    [survival.powf(width.exp()), survival.powf((-width).exp())]
}

/// The log-rank test (Mantel, 1966) of two independent groups: the probability of curves at least as far apart if nothing differs.
/// It makes no use of pairs, and so says less than it might where trials share their random numbers. `None` where nothing happened.
#[must_use]
pub fn log_rank(a: &[Observation], b: &[Observation]) -> Option<f64> {
    let sorted = |group: &[Observation], counts: fn(&Observation) -> bool| {
        let mut times: Vec<f64> = group.iter().filter(|seen| counts(seen)).map(|seen| seen.time).collect();
        times.sort_unstable_by(f64::total_cmp);
        times
    };
    let [watched_a, watched_b] = [a, b].map(|group| sorted(group, |_| true));
    let [happened_a, happened_b] = [a, b].map(|group| sorted(group, |seen| seen.happened));
    let mut times = [&happened_a[..], &happened_b].concat();
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    let before = |times: &[f64], time: f64| times.partition_point(|other| *other < time);
    let at_risk = |times: &[f64], time: f64| (times.len() - before(times, time)) as f64;
    let just_then =
        |times: &[f64], time: f64| (times.partition_point(|other| *other <= time) - before(times, time)) as f64;
    let (mut surplus, mut variance) = (0.0, 0.0);
    for time in times {
        let (risk_a, risk_b) = (at_risk(&watched_a, time), at_risk(&watched_b, time));
        let (n, share) = (risk_a + risk_b, risk_a / (risk_a + risk_b));
        let events_a = just_then(&happened_a, time);
        let events = events_a + just_then(&happened_b, time);
        surplus += events_a - events * share;
        if n > 1.0 {
            variance += events * share * (1.0 - share) * (n - events) / (n - 1.0);
        }
    }
    let chi_squared = ChiSquared::new(1.0).ok()?;
    (variance > 0.0).then(|| chi_squared.sf(surplus * surplus / variance))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn observed(times: &[u32], cut_off: &[u32]) -> Vec<Observation> {
        let observations = |times: &[u32], happened| -> Vec<_> {
            times
                .iter()
                .map(|&time| Observation {
                    time: f64::from(time),
                    happened,
                })
                .collect()
        };
        [observations(times, true), observations(cut_off, false)].concat()
    }

    fn assert_median(observations: &[Observation], value: Option<f64>, low: Option<f64>, high: Option<f64>) {
        let n = observations.len() as u64;
        assert_eq!(
            median_survival(observations),
            Estimate {
                value,
                ci95: [low, high],
                n
            }
        );
    }

    // Figures: f = survfit(Surv(times, happened) ~ 1, conf.type = "log-log"); quantile(f, 0.5), R 4.2, survival 3.5

    #[test]
    fn remission_times_of_freireich_1963_have_their_published_medians() {
        let treated = observed(
            &[6, 6, 6, 7, 10, 13, 16, 22, 23],
            &[6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35],
        );
        assert_median(&treated, Some(23.0), Some(13.0), None);
        let placebo = observed(
            &[1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23],
            &[],
        );
        assert_median(&placebo, Some(8.0), Some(4.0), Some(11.0));
    }

    #[test]
    fn medians_and_intervals_are_those_of_r() {
        let most_complete = observed(&[1400, 1380, 1420, 1390, 1500, 1600, 1700], &[4000, 4000, 4000]);
        assert_median(&most_complete, Some(1550.0), Some(1380.0), None);
        for (n, median, low, high) in [
            (24, 12.5, 7.0, 17.0),
            (28, 14.5, 9.0, 19.0),
            (30, 15.5, 10.0, 21.0),
            (38, 19.5, 13.0, 25.0),
            (44, 22.5, 15.0, 29.0),
            (300, 150.5, 133.0, 167.0),
        ] {
            let times: Vec<u32> = (1..=n).rev().collect();
            assert_median(&observed(&times, &[]), Some(median), Some(low), Some(high));
        }
    }

    #[test]
    fn fewer_than_six_trials_have_a_median_and_no_interval() {
        assert_median(&observed(&[10, 20, 30, 40], &[]), Some(25.0), None, None);
        assert_median(&observed(&[10], &[20, 30, 40]), None, None, None);
        assert_median(&observed(&[5, 11], &[]), Some(8.0), None, None);
        assert_median(&observed(&[5], &[11]), Some(8.0), None, None);
        assert_median(&observed(&[5, 5], &[11, 12]), Some(8.5), None, None);
        assert_median(&observed(&[5], &[]), Some(5.0), None, None);
        assert_median(&observed(&[1, 2, 3, 4, 5, 6], &[]), Some(3.5), Some(1.0), None);
    }

    #[test]
    fn without_cut_offs_the_median_is_that_of_the_times_however_many_and_however_tied() {
        for n in 1..=300_u32 {
            for ties in [1, 3, 7] {
                let times: Vec<u32> = (0..n).map(|trial| trial * 7919 % n / ties).collect();
                let values: Vec<f64> = times.iter().map(|&time| f64::from(time)).collect();
                let found = median_survival(&observed(&times, &[])).value;
                assert_eq!(found, super::super::median(&values).value, "{n} trials, ties of {ties}");
            }
        }
    }

    /// The median of a Kaplan–Meier curve whose factors are multiplied as fractions, cancelled at each step.
    fn median_by_fractions(observations: &[Observation]) -> Option<f64> {
        let divisor = |mut a: u128, mut b: u128| {
            while b > 0 {
                (a, b) = (b, a % b);
            }
            a
        };
        let curve = survival_curve(observations.iter().copied());
        let longest = observations.iter().map(|seen| seen.time).fold(0.0, f64::max);
        let (mut above, mut below) = (1_u128, 1_u128);
        for (place, step) in curve.iter().enumerate() {
            above = above.checked_mul(u128::from(step.at_risk - step.happened))?;
            below = below.checked_mul(u128::from(step.at_risk))?;
            let common = divisor(above, below);
            (above, below) = (above / common, below / common);
            if 2 * above <= below {
                let next = curve.get(place + 1).map_or(longest, |step| step.time);
                return Some(if 2 * above == below {
                    f64::midpoint(step.time, next)
                } else {
                    step.time
                });
            }
        }
        None
    }

    #[test]
    fn the_median_is_that_of_exact_fractions_with_cut_offs_and_ties() {
        let mut at_one_half = 0;
        for n in 2..=300_u32 {
            // Cut off at the start and at the end, so that the curve often comes to exactly one half between.
            for early in [0, n / 9, n / 4] {
                let times: Vec<u32> = (early..n)
                    .filter(|time| *time < n - n / 5)
                    .map(|time| time / 2 * 2)
                    .collect();
                let cut_off: Vec<u32> = (0..early).chain(n - n / 5..n).collect();
                let observations = observed(&times, &cut_off);
                let expected = median_by_fractions(&observations);
                assert_eq!(
                    median_survival(&observations).value,
                    expected,
                    "{n} trials, {early} cut off early"
                );
                at_one_half += u32::from(expected.is_some_and(|median| median.rem_euclid(2.0) > 0.0));
            }
        }
        assert!(at_one_half > 30, "{at_one_half} medians lay in a flat stretch");
    }

    #[test]
    fn a_curve_and_its_band_are_those_of_lifelines() {
        // lifelines.KaplanMeierFitter().fit(times, happened): survival_function_, confidence_interval_
        let curve = survival_curve(observed(
            &[6, 6, 6, 7, 10, 13, 16, 22, 23],
            &[6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35],
        ));
        for (step, (time, survival, low, high)) in curve.iter().zip([
            (6.0, 0.857_142_857, 0.619_718, 0.951_552),
            (7.0, 0.806_722_689, 0.563_147, 0.922_809),
            (10.0, 0.752_941_176, 0.503_200, 0.889_362),
        ]) {
            assert!((step.time - time).abs() < 1e-12 && (step.survival - survival).abs() < 1e-9);
            assert!((step.band[0] - low).abs() < 1e-6 && (step.band[1] - high).abs() < 1e-6);
        }
        assert_eq!(curve.len(), 7);
    }

    #[test]
    fn the_log_rank_test_is_that_of_lifelines() {
        // lifelines.statistics.logrank_test(times_a, times_b, happened_a, happened_b).p_value
        let treated = observed(
            &[6, 6, 6, 7, 10, 13, 16, 22, 23],
            &[6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35],
        );
        let placebo = observed(
            &[1, 1, 2, 2, 3, 4, 4, 5, 5, 8, 8, 8, 8, 11, 11, 12, 12, 15, 17, 22, 23],
            &[],
        );
        assert!((log_rank(&treated, &placebo).unwrap() - 4.168_809_109e-5).abs() < 1e-12);
        let a = observed(&[1400, 1380, 1420], &[4000, 4000]);
        let b = observed(&[1500, 1380, 1600, 1700], &[4000]);
        assert!((log_rank(&a, &b).unwrap() - 0.899_745_406_580_755).abs() < 1e-9);
        assert_eq!(log_rank(&observed(&[], &[400]), &observed(&[], &[400])), None);
    }

    #[test]
    fn trials_that_were_all_cut_off_say_nothing() {
        assert_median(&observed(&[], &[400, 400]), None, None, None);
        assert_median(&[], None, None, None);
    }

    #[test]
    fn leaving_failures_out_would_flatter_the_median() {
        let honest = median_survival(&observed(&[100, 110, 120], &[400, 400]));
        let flattering = median_survival(&observed(&[100, 110, 120], &[]));
        assert!(honest.value > flattering.value);
    }
}
