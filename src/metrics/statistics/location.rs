//! Means, medians and proportions with their intervals.

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::spread::quantile;
use super::{Estimate, TAIL, normal_quantile};

/// The mean of `values`, one a trial, with Student's t interval; no interval from fewer than two.
#[must_use]
pub fn mean(values: &[f64]) -> Estimate {
    let n = values.len() as f64;
    // Taken about the first value, so that equal values have exactly their value as the mean, and no variance.
    let mean = values
        .first()
        .map(|first| first + values.iter().map(|value| value - first).sum::<f64>() / n);
    let half_width = mean.and_then(|mean| {
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let student = StudentsT::new(0.0, 1.0, n - 1.0).ok()?;
        Some(student.inverse_cdf(1.0 - TAIL) * (squares / (n - 1.0) / n).sqrt())
    });
    let end = |sign: f64| Some(mean? + sign * half_width?);
    Estimate {
        value: mean,
        ci95: [end(-1.0), end(1.0)],
        n: values.len() as u64,
    }
}

/// The ratio of two sums, of what each trial counts over what it watches, for figures that a short trial may not have on
/// its own: no trial is left out, and a trial weighs as much as it watched. The interval is the ratio estimator's
/// (Cochran, 1977, section 6.3: Student's t of the residuals aᵢ − R bᵢ); neither of the parts is negative, and nor is the
/// interval. No interval from fewer than two trials, no value where nothing was watched.
#[must_use]
pub fn ratio(parts: &[[f64; 2]]) -> Estimate {
    let n = parts.len() as f64;
    let sum = |part: usize| parts.iter().map(|parts| parts[part]).sum::<f64>();
    let watched = sum(1);
    let value = (watched > 0.0).then(|| sum(0) / watched);
    let half_width = value.and_then(|value| {
        let squares: f64 = parts.iter().map(|[a, b]| (a - value * b).powi(2)).sum();
        let student = StudentsT::new(0.0, 1.0, n - 1.0).ok()?;
        Some(student.inverse_cdf(1.0 - TAIL) * (squares / (n - 1.0) / n).sqrt() / (watched / n))
    });
    let end = |sign: f64| Some((value? + sign * half_width?).max(0.0));
    Estimate {
        value,
        ci95: [end(-1.0), end(1.0)],
        n: parts.len() as u64,
    }
}

/// The median of `values`, one a trial and none of them censored, between the order statistics that hold it with at
/// least 95 % whatever the distribution (binomial, equal tails). It needs no random numbers and assumes nothing, which
/// a bootstrap of so few trials does; below six trials there is no such interval.
#[must_use]
pub fn median(values: &[f64]) -> Estimate {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = outermost_rank(sorted.len());
    Estimate {
        value: quantile(&sorted, 0.5),
        ci95: rank.map_or([None; 2], |rank| {
            [Some(sorted[rank - 1]), Some(sorted[sorted.len() - rank])]
        }),
        n: values.len() as u64,
    }
}

/// The greatest rank k for which the k-th least of `n` values exceeds the median with at most [`TAIL`]: that fewer
/// than k of n fair coins fall heads.
fn outermost_rank(n: usize) -> Option<usize> {
    let mut probability = 0.5_f64.powf(n as f64);
    let mut below = 0.0;
    let mut rank = 0;
    // For thousands of trials the first probabilities vanish and are built up in logarithms instead.
    let mut log = -(n as f64) * std::f64::consts::LN_2;
    while rank < n {
        below += probability;
        if below > TAIL {
            break;
        }
        log += ((n - rank) as f64 / (rank + 1) as f64).ln();
        probability = log.exp();
        rank += 1;
    }
    (rank > 0).then_some(rank)
}

/// The share of `trials` that were `successes`, with Wilson's score interval.
#[must_use]
pub fn proportion(successes: u64, trials: u64) -> Estimate {
    if trials == 0 {
        return Estimate::default();
    }
    let share = successes as f64 / trials as f64;
    Estimate {
        value: Some(share),
        ci95: wilson(share, trials as f64, normal_quantile()).map(Some),
        n: trials,
    }
}

/// The mean of `shares`, one a trial, each from 0 to 1, with an interval that stays there too. It is Wilson's at the
/// effective number of trials m(1−m)/(s²/n) and Student's quantile (Korn and Graubard, 1998, with Wilson's interval for
/// theirs): shares that differ less than all or nothing say more than so many yeses and noes. Where every trial has 0 or every
/// trial 1, their spread says nothing, and they count as yeses and noes. No interval from fewer than two.
#[must_use]
pub fn share(shares: &[f64]) -> Estimate {
    let estimate = mean(shares);
    let n = shares.len() as f64;
    let interval = |mean: f64| {
        let student = StudentsT::new(0.0, 1.0, n - 1.0).ok()?;
        let squares: f64 = shares.iter().map(|share| (share - mean).powi(2)).sum();
        let squared_error = squares / (n - 1.0) / n;
        Some(if mean <= 0.0 || mean >= 1.0 {
            wilson(mean, n, normal_quantile())
        } else if squared_error > 0.0 {
            wilson(
                mean,
                mean * (1.0 - mean) / squared_error,
                student.inverse_cdf(1.0 - TAIL),
            )
        } else {
            [mean; 2]
        })
    };
    Estimate {
        ci95: estimate
            .value
            .and_then(interval)
            .map_or([None; 2], |ends| ends.map(Some)),
        ..estimate
    }
}

/// Wilson's score interval for a `share` of `n` at the quantile `z`.
fn wilson(share: f64, n: f64, z: f64) -> [f64; 2] {
    let centre = (share + z * z / (2.0 * n)) / (1.0 + z * z / n);
    let half_width = z / (1.0 + z * z / n) * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt();
    // At the extremes the end is exactly 0 or 1; rounding must not carry it past.
    let low = if share <= 0.0 { 0.0 } else { centre - half_width };
    let high = if share >= 1.0 { 1.0 } else { centre + half_width };
    [low.max(0.0), high.min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn assert_interval(estimate: Estimate, low: f64, high: f64) {
        let [Some(a), Some(b)] = estimate.ci95 else {
            panic!("no interval in {estimate:?}")
        };
        assert!(
            (a - low).abs() < 1e-8 && (b - high).abs() < 1e-8,
            "{a} {b} instead of {low} {high}"
        );
    }

    #[test]
    fn mean_and_interval_are_those_of_scipy() {
        // scipy.stats.t.interval(0.95, n - 1, loc=numpy.mean(x), scale=scipy.stats.sem(x))
        let x = [12.0, 7.0, 3.0, 25.0, 8.0, 14.0, 9.0, 30.0, 11.0, 5.0];
        assert!((mean(&x).value.unwrap() - 12.4).abs() < 1e-12);
        assert_interval(mean(&x), 6.198_406_171_035_676, 18.601_593_828_964_326);
        assert_interval(mean(&[1.0, 3.0]), -10.706_204_736_174_694, 14.706_204_736_174_694);
    }

    #[test]
    fn a_ratio_of_sums_over_equal_watches_is_the_mean_and_its_interval() {
        let x = [12.0, 7.0, 3.0, 25.0, 8.0, 14.0, 9.0, 30.0, 11.0, 5.0];
        let doubled = ratio(&x.map(|a| [a, 2.0]));
        assert!((doubled.value.unwrap() - 6.2).abs() < 1e-12);
        assert_interval(doubled, 6.198_406_171_035_676 / 2.0, 18.601_593_828_964_326 / 2.0);
    }

    #[test]
    fn a_ratio_of_proportional_sums_has_no_width_and_one_over_nothing_no_value() {
        let exact = ratio(&[[1.0, 2.0], [5.0, 10.0], [0.0, 0.0]]);
        assert_eq!((exact.value, exact.ci95, exact.n), (Some(0.5), [Some(0.5); 2], 3));
        let nothing = ratio(&[[0.0, 0.0]; 3]);
        assert_eq!((nothing.value, nothing.ci95, nothing.n), (None, [None; 2], 3));
    }

    #[test]
    fn equal_values_are_their_own_mean_without_width() {
        assert_eq!(
            mean(&[0.1; 35]),
            Estimate {
                value: Some(0.1),
                ci95: [Some(0.1); 2],
                n: 35
            }
        );
    }

    #[test]
    fn one_trial_has_no_interval_and_none_has_no_value() {
        assert_eq!(
            mean(&[2.0]),
            Estimate {
                value: Some(2.0),
                ci95: [None; 2],
                n: 1
            }
        );
        for none in [mean(&[]), median(&[]), proportion(0, 0)] {
            assert_eq!(none, Estimate::default());
        }
    }

    #[test]
    fn medians_lie_between_the_order_statistics_of_the_binomial() {
        // ranks k and n + 1 - k, k = scipy.stats.binom.ppf(0.025, n, 0.5); n = 10, 35, 100 also
        // scipy.stats.quantile_test(range(1, n + 1), q=median, p=0.5).confidence_interval(0.95)
        for (n, low, high) in [
            (6, 1.0, 6.0),
            (10, 2.0, 9.0),
            (35, 12.0, 24.0),
            (36, 12.0, 25.0),
            (100, 40.0, 61.0),
            (10_000, 4902.0, 5099.0),
        ] {
            let values: Vec<f64> = (1..=n).rev().map(f64::from).collect();
            assert_interval(median(&values), low, high);
            assert_eq!(median(&values).value, Some(f64::from(n + 1) / 2.0));
        }
        assert_eq!(
            median(&[1.0, 2.0, 3.0, 4.0, 5.0]),
            Estimate {
                value: Some(3.0),
                ci95: [None; 2],
                n: 5
            }
        );
    }

    #[test]
    fn proportions_have_the_wilson_interval_of_scipy() {
        // scipy.stats.binomtest(k, n).proportion_ci(0.95, method="wilson")
        assert_interval(proportion(0, 10), 0.0, 0.277_532_799_862_889_26);
        assert_interval(proportion(10, 10), 0.722_467_200_137_111, 1.0);
        assert_interval(proportion(7, 10), 0.396_778_147_461_145_26, 0.892_208_732_593_699);
        assert_interval(proportion(33, 35), 0.813_929_425_798_350_7, 0.984_186_838_142_891_3);
        assert_interval(proportion(1, 2), 0.094_531_205_734_230_74, 0.905_468_794_265_769_3);
    }

    #[test]
    fn shares_have_an_interval_within_0_and_1_that_is_wilsons_at_the_effective_number_of_trials() {
        // m = 0.99, s²/n = 0.01²: n_e = 99, t = scipy.stats.t.ppf(0.975, 3); statsmodels' proportion_confint(0.99·99, 99,
        // method="wilson") with t for z.
        let found = share(&[1.0, 1.0, 1.0, 0.96]);
        let t: f64 = 3.182_446_305_284_263;
        let (m, n) = (0.99, 99.0);
        let centre = (m + t * t / (2.0 * n)) / (1.0 + t * t / n);
        let half = t / (1.0 + t * t / n) * (m * (1.0 - m) / n + t * t / (4.0 * n * n)).sqrt();
        assert_interval(found, centre - half, centre + half);
        assert!(found.ci95[1] < Some(1.0) && mean(&[1.0, 1.0, 1.0, 0.96]).ci95[1] > Some(1.0));
    }

    #[test]
    fn shares_that_are_all_or_nothing_are_a_proportion_and_equal_ones_their_own_mean() {
        assert_eq!(share(&[1.0; 35]), proportion(35, 35));
        assert_eq!(share(&[0.0; 7]), proportion(0, 7));
        assert_eq!(share(&[0.25; 7]).ci95, [Some(0.25); 2]);
        assert_eq!(share(&[1.0]).ci95, [None; 2]);
        assert_eq!(share(&[]), Estimate::default());
    }

    proptest! {
        #[test]
        fn an_interval_of_shares_holds_their_mean_and_stays_within_0_and_1(shares in prop::collection::vec(0.0..=1.0_f64, 2..40)) {
            let Estimate { value: Some(mean), ci95: [Some(low), Some(high)], .. } = share(&shares) else { panic!() };
            prop_assert!(0.0 <= low && low <= mean + 1e-12 && mean - 1e-12 <= high && high <= 1.0);
        }
    }
}
