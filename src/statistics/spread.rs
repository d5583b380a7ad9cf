//! How values spread: quantiles and inequality.

/// The `q`-quantile of `sorted` values, `q` in [0, 1], of type 7 (Hyndman and Fan, 1996: linear between order
/// statistics at rank (n−1)q, the default of R and numpy). `None` without values.
#[must_use]
pub fn quantile(sorted: &[f64], q: f64) -> Option<f64> {
    let rank = sorted.len().checked_sub(1)? as f64 * q;
    let below = sorted[rank.floor() as usize];
    let above = sorted[rank.ceil() as usize];
    Some(below + (above - below) * rank.fract())
}

/// The Gini coefficient of `values`, none negative: 0 when all are equal, near 1 when one has everything. `None`
/// where their sum is 0.
#[must_use]
pub fn gini(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let sum: f64 = sorted.iter().sum();
    let ranked: f64 = (1..).zip(&sorted).map(|(rank, value)| f64::from(rank) * value).sum();
    (sum > 0.0).then(|| (2.0 * ranked / (n * sum) - (n + 1.0) / n).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quantiles_are_those_of_numpy() {
        // numpy.quantile(x, q), its default method "linear"
        let x = [3.0, 5.0, 7.0, 8.0, 9.0, 11.0, 12.0, 14.0, 25.0, 30.0];
        for (q, expected) in [
            (0.0, 3.0),
            (0.05, 3.9),
            (0.25, 7.25),
            (0.5, 10.0),
            (0.9, 25.5),
            (0.95, 27.75),
            (1.0, 30.0),
        ] {
            assert!((quantile(&x, q).unwrap() - expected).abs() < 1e-12, "{q}");
        }
        assert_eq!((quantile(&[], 0.5), quantile(&[4.0], 0.95)), (None, Some(4.0)));
    }

    #[test]
    fn gini_of_equal_shares_is_zero_and_of_one_owner_is_all_but_its_share() {
        assert_eq!(gini(&[3.0; 7]), Some(0.0));
        assert_eq!(gini(&[0.0, 0.0, 0.0, 8.0]), Some(0.75));
        assert!(
            (gini(&[1.0, 2.0, 3.0, 4.0]).unwrap() - 0.25).abs() < 1e-12,
            "the mean difference 1.25 over twice the mean"
        );
        assert_eq!((gini(&[]), gini(&[0.0, 0.0])), (None, None));
    }

    proptest! {
        #[test]
        fn gini_is_half_the_relative_mean_difference(values in prop::collection::vec(0.0..100.0_f64, 1..40)) {
            let sum: f64 = values.iter().sum();
            prop_assume!(sum > 1.0);
            let differences: f64 = values.iter().flat_map(|a| values.iter().map(move |b| (a - b).abs())).sum();
            let expected = differences / (2.0 * values.len() as f64 * sum);
            prop_assert!((gini(&values).unwrap() - expected).abs() < 1e-9);
        }
    }
}
