//! The median of trials none of which was cut off.

use super::spread::quantile;
use super::{Estimate, TAIL};

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

#[cfg(test)]
mod tests {
    use super::*;

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
            let found = median(&values);
            assert_eq!(found.value, Some(f64::from(n + 1) / 2.0));
            assert_eq!(found.ci95, [Some(low), Some(high)]);
        }
        let five = median(&[1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!((five.value, five.ci95, five.n), (Some(3.0), [None; 2], 5));
        assert_eq!(median(&[]), Estimate::default());
    }
}
