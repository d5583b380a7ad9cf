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
