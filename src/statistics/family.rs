//! Many tests at once, and how many trials a test needs.

use statrs::distribution::{ContinuousCDF, Normal};

/// Holm's adjustment (1979) of a family's p-values, in their order: below 0.05 after it, at most one family in twenty without
/// any difference shows one. A test that has no p-value counts for nothing.
#[must_use]
pub fn holm(p_values: &[Option<f64>]) -> Vec<Option<f64>> {
    let mut order: Vec<(f64, usize)> = (0..)
        .zip(p_values)
        .filter_map(|(index, p)| Some(((*p)?, index)))
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut adjusted = vec![None; p_values.len()];
    let mut least: f64 = 0.0;
    for (rank, &(p, index)) in order.iter().enumerate() {
        least = least.max(p * (order.len() - rank) as f64).min(1.0);
        adjusted[index] = Some(least);
    }
    adjusted
}

/// Which tests of a family can show anything at level `alpha`, by the least p-value that each could have given (Tarone, 1990): a test
/// that cannot be significant whatever comes out is no chance to err, and leaves the others their level. The least p-value does not depend on
/// which way the trials came out, so that to choose by it costs nothing. A test without one counts for nothing.
#[must_use]
pub fn testable(least: &[Option<f64>], alpha: f64) -> Vec<bool> {
    let able = |size: usize| move |least: &Option<f64>| least.is_some_and(|least| least * (size as f64) < alpha);
    let size = (1..=least.len()).find(|&size| least.iter().filter(|least| able(size)(least)).count() <= size);
    least
        .iter()
        .map(|least| size.is_some_and(|size| able(size)(least)))
        .collect()
}

/// The fewest trials of which one of so many tests can show anything at level `alpha` after Holm's adjustment, where `least` is the least
/// p-value that so many trials could give. `None` if a thousand do not suffice.
#[must_use]
pub fn fewest_trials(tests: usize, alpha: f64, least: impl Fn(u64) -> f64) -> Option<u64> {
    (2..=1000).find(|&trials| least(trials) * (tests as f64) < alpha)
}

/// Probability with which a planned number of trials finds a difference that is there.
pub const POWER: f64 = 0.8;

/// Pairs of trials after which a two-sided test at level `alpha` finds a mean difference of `size` with probability [`POWER`], if
/// paired differences have standard deviation `deviation` (Guenther, 1981: normal quantiles, and z²/2 more pairs for the
/// estimated deviation). For independent trials, give the square root of the sum of both variances. `None` for a size of zero or
/// what is not finite; at least two.
#[must_use]
pub fn trials_needed(size: f64, deviation: f64, alpha: f64) -> Option<u64> {
    let normal = Normal::standard();
    let z = normal.inverse_cdf(1.0 - alpha / 2.0);
    let pairs = ((z + normal.inverse_cdf(POWER)) * deviation / size).powi(2) + z * z / 2.0;
    (size != 0.0 && pairs.is_finite()).then(|| (pairs.ceil() as u64).max(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adjusted_p_values_are_those_of_statsmodels() {
        // statsmodels.stats.multitest.multipletests([0.01, 0.04, 0.03, 0.005, 0.6], method="holm")[1]
        let p = [0.01, 0.04, 0.03, 0.005, 0.6];
        let adjusted = holm(&p.map(Some));
        for (found, expected) in adjusted.iter().zip([0.04, 0.09, 0.09, 0.025, 0.6]) {
            assert!((found.unwrap() - expected).abs() < 1e-12, "{adjusted:?}");
        }
        assert_eq!(holm(&[None, Some(0.5), Some(0.9)]), [None, Some(1.0), Some(1.0)]);
    }

    #[test]
    fn tests_that_cannot_be_significant_leave_the_others_their_level() {
        // Tarone (1990): of 30 tests of which 20 have a least p-value of 1, ten are left; those of 0.0078 cannot reach 0.05 over 10.
        let mut least = vec![Some(1.0); 20];
        least.extend(vec![Some(2.0 / 2_f64.powi(9)); 10]);
        assert_eq!(testable(&least, 0.05).iter().filter(|&&able| able).count(), 10);
        least.extend(vec![Some(2.0 / 2_f64.powi(9)); 3]);
        assert!(testable(&least, 0.05).iter().all(|able| !able), "13 · 2/2⁹ = 0.051");
        // One of many trials keeps its level beside any number of those that have few.
        least.push(Some(1e-4));
        assert_eq!(testable(&least, 0.05).iter().filter(|&&able| able).count(), 1);
        assert_eq!(testable(&[None, Some(0.01)], 0.05), [false, true]);
    }

    #[test]
    fn a_family_ten_times_as_large_asks_for_three_or_four_trials_more() {
        // 2/2ⁿ · m < 0.05: n > 1 + log2(20 m).
        let least = super::super::least_of_pairs;
        for (tests, trials) in [(1, 6), (3, 7), (10, 9), (30, 11), (66, 12), (300, 14)] {
            assert_eq!(fewest_trials(tests, 0.05, least), Some(trials), "{tests}");
            assert!(least(trials - 1) * tests as f64 >= 0.05);
        }
        // 2/C(2n, n) · 10 < 0.05: C(10, 5) = 252, C(12, 6) = 924.
        assert_eq!(
            fewest_trials(10, 0.05, |n| super::super::least_of_groups(n, n)),
            Some(6)
        );
        assert_eq!(fewest_trials(1, 0.05, |_| 0.5), None);
    }

    #[test]
    fn planned_trials_are_those_of_statsmodels_to_within_one() {
        // statsmodels.stats.power.TTestPower().solve_power(effect_size=..., alpha=..., power=0.8), rounded up
        for (effect, alpha, trials) in [(0.5, 0.05, 34), (0.2, 0.05, 199), (1.0, 0.05, 10), (0.5, 0.01, 51)] {
            let planned = trials_needed(effect, 1.0, alpha).unwrap();
            assert!(planned.abs_diff(trials) <= 1, "{planned} instead of {trials}");
        }
        assert_eq!(trials_needed(0.0, 1.0, 0.05), None);
        assert_eq!(trials_needed(1.0, 0.0, 0.05), Some(2));
    }
}
