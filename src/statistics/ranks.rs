//! Tests and effect sizes that look at order alone, so that one wild trial weighs no more than another.

use statrs::distribution::{ContinuousCDF, Normal};

use super::Estimate;
use super::interval::share_at;
use super::terms::{Moments, Terms, summed};

/// Up to so many values the exact distribution is counted out, as long as no two are equal.
const EXACT: usize = 50;

/// Wilcoxon's signed-rank test of paired differences: two-sided p-value. Differences of zero are left out; exact where there are
/// at most 50 others and no ties, else from the normal distribution with the variance corrected for ties. `None` if all are zero.
#[must_use]
pub fn wilcoxon(differences: &[f64]) -> Option<f64> {
    let mut sizes: Vec<(f64, bool)> = differences
        .iter()
        .filter(|difference| **difference != 0.0)
        .map(|difference| (difference.abs(), *difference > 0.0))
        .collect();
    sizes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let n = sizes.len();
    let Ranked { ranks, ties } = Ranked::of(sizes.iter().map(|(size, _)| *size));
    let positive: f64 = ranks
        .iter()
        .zip(&sizes)
        .filter(|(_, (_, positive))| *positive)
        .map(|(rank, _)| rank)
        .sum();
    let count = n as f64;
    if n == 0 {
        return None;
    }
    if ties == 0.0 && n <= EXACT {
        let ways = signed_rank_ways(n);
        return Some(two_sided(&ways, positive as usize));
    }
    let variance = count * (count + 1.0) * (2.0 * count + 1.0) / 24.0 - ties / 48.0;
    Some(normal_tails(positive - count * (count + 1.0) / 4.0, variance))
}

/// Mann and Whitney's test of two independent samples: two-sided p-value. Exact without ties where neither sample has more than 50
/// values, else from the normal distribution with the variance corrected for ties, and half a unit for continuity. `None` if a
/// sample is empty or all values are equal.
#[must_use]
pub fn mann_whitney(a: &[f64], b: &[f64]) -> Option<f64> {
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let mut pooled: Vec<(f64, bool)> = a.iter().map(|&value| (value, true)).collect();
    pooled.extend(b.iter().map(|&value| (value, false)));
    pooled.sort_by(|x, y| x.0.total_cmp(&y.0));
    let Ranked { ranks, ties } = Ranked::of(pooled.iter().map(|(value, _)| *value));
    let of_a: f64 = ranks
        .iter()
        .zip(&pooled)
        .filter(|(_, (_, is_a))| *is_a)
        .map(|(rank, _)| rank)
        .sum();
    let (first, second) = (a.len() as f64, b.len() as f64);
    let u = of_a - first * (first + 1.0) / 2.0;
    if ties == 0.0 && a.len() <= EXACT && b.len() <= EXACT {
        return Some(two_sided(&rank_sum_ways(a.len(), b.len()), u as usize));
    }
    let all = first + second;
    let variance = first * second / 12.0 * (all + 1.0 - ties / (all * (all - 1.0)));
    let off = u - first * second / 2.0;
    (variance > 0.0).then(|| normal_tails(off.signum() * (off.abs() - 0.5).max(0.0), variance))
}

/// The least p-value that Mann and Whitney's test could give of these values, had the groups been any others of the same sizes. `None` as there.
#[must_use]
pub fn least_of_ranks(a: &[f64], b: &[f64]) -> Option<f64> {
    let mut pooled = [a, b].concat();
    pooled.sort_by(f64::total_cmp);
    let low = mann_whitney(&pooled[..a.len()], &pooled[a.len()..])?;
    Some(low.min(mann_whitney(&pooled[b.len()..], &pooled[..b.len()])?))
}

/// The least two-sided p-value of Mann and Whitney's test of two groups of these sizes without ties: of all choices of the first group among
/// all values, the two at the ends are as extreme as any.
#[must_use]
pub fn least_of_groups(first: u64, second: u64) -> f64 {
    let choices: f64 = (1..=first).map(|rank| (second + rank) as f64 / rank as f64).product();
    (2.0 / choices).min(1.0)
}

/// Cliff's δ (1993): the probability that a value of `b` exceeds one of `a`, less that of the opposite; from −1 to 1, 0 where
/// neither tends to be larger. `None` if a sample is empty.
#[must_use]
pub fn cliffs_delta(a: &[f64], b: &[f64]) -> Option<f64> {
    let mut sorted = a.to_vec();
    sorted.sort_by(f64::total_cmp);
    let over = |value: f64| {
        let below = sorted.partition_point(|&other| other < value);
        let up_to = sorted.partition_point(|&other| other <= value);
        below as f64 - (sorted.len() - up_to) as f64
    };
    let sum: f64 = b.iter().map(|&value| over(value)).sum();
    (!a.is_empty() && !b.is_empty()).then(|| sum / (a.len() * b.len()) as f64)
}

/// Cliff's δ of two samples, `None` where a trial has no value, with an interval: of the share of pairs in which the second is larger, ties
/// by half, Wilson's at the effective number of trials, so that it stays within −1 and 1 and has a width there too. What each
/// trial adds to it is how its values stand among all of the other sample (Cliff, 1996; paired trials add both).
#[must_use]
pub fn cliffs_delta_estimate(samples: [&[Option<f64>]; 2], pairs: bool) -> Estimate {
    let values = samples.map(|sample| sample.iter().copied().flatten().collect::<Vec<f64>>());
    let n = values[0].len().min(values[1].len()) as u64;
    let Some(delta) = cliffs_delta(&values[0], &values[1]) else {
        return Estimate {
            n,
            ..Estimate::default()
        };
    };
    let share = f64::midpoint(delta, 1.0);
    let terms = |own: usize, other: usize, sign: f64| -> Terms {
        let size = values[own].len() as f64;
        let among = |value: f64| sign * cliffs_delta(&values[other], &[value]).unwrap_or(0.0);
        let term = |value: &Option<f64>| value.map(|value| (among(value) - delta) / 2.0 / size);
        samples[own].iter().map(term).collect()
    };
    let (first, second) = (terms(0, 1, -1.0), terms(1, 0, 1.0));
    let moments = if pairs {
        Moments::of(&summed(&first, &second))
    } else {
        Moments::of(&first).and_then(|first| Some(Moments::between(first, Moments::of(&second)?)))
    };
    let interval = moments.and_then(|moments| share_at(share, moments));
    Estimate {
        value: Some(delta),
        ci95: interval.map_or([None; 2], |ends| ends.map(|end| Some(2.0 * end - 1.0))),
        n,
    }
}

/// Ranks from 1, the mean rank for equal values, and the sum of t³ − t over groups of t equal values.
struct Ranked {
    ranks: Vec<f64>,
    ties: f64,
}

impl Ranked {
    fn of(sorted: impl Iterator<Item = f64>) -> Self {
        let sorted: Vec<f64> = sorted.collect();
        let mut ranked = Self {
            ranks: Vec::new(),
            ties: 0.0,
        };
        for equal in sorted.chunk_by(|a, b| a.total_cmp(b).is_eq()) {
            let (before, count) = (ranked.ranks.len() as f64, equal.len() as f64);
            ranked.ties += count.powi(3) - count;
            ranked
                .ranks
                .extend(std::iter::repeat_n(before + f64::midpoint(count, 1.0), equal.len()));
        }
        ranked
    }
}

/// For each sum of ranks: the share of the 2ⁿ choices of ranks 1 to `n` that have it.
fn signed_rank_ways(n: usize) -> Vec<f64> {
    let mut ways = vec![0.0; n * (n + 1) / 2 + 1];
    ways[0] = 1.0;
    for rank in 1..=n {
        for sum in (0..ways.len()).rev() {
            let with = if sum >= rank { ways[sum - rank] } else { 0.0 };
            ways[sum] = f64::midpoint(ways[sum], with);
        }
    }
    ways
}

/// For each value of U: the share of the orders of `n` values among `m` others that have it. The largest value of all is one of
/// the `n` with probability n / (n + m), and then exceeds all `m` others.
fn rank_sum_ways(n: usize, m: usize) -> Vec<f64> {
    let size = n * m + 1;
    let mut start = vec![0.0; size];
    start[0] = 1.0;
    let mut with: Vec<Vec<f64>> = vec![start; n + 1];
    for others in 1..=m {
        for own in 1..=n {
            let is_own = own as f64 / (own + others) as f64;
            let mut ways = vec![0.0; size];
            for (u, way) in ways.iter_mut().enumerate().take(own * others + 1) {
                let lost = if u >= others { with[own - 1][u - others] } else { 0.0 };
                *way = is_own * lost + (1.0 - is_own) * with[own][u];
            }
            with[own] = ways;
        }
    }
    with.swap_remove(n)
}

/// Twice the smaller tail at `place` of a symmetric distribution, `place` included; at most 1.
fn two_sided(ways: &[f64], place: usize) -> f64 {
    let low: f64 = ways[..=place].iter().sum();
    let high: f64 = ways[place..].iter().sum();
    (2.0 * low.min(high)).min(1.0)
}

/// The two tails of the normal distribution beyond a deviation from its mean.
fn normal_tails(deviation: f64, variance: f64) -> f64 {
    2.0 * Normal::standard().sf(deviation.abs() / variance.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: [f64; 10] = [12.0, 7.0, 3.0, 25.0, 8.0, 14.0, 9.0, 30.0, 11.0, 5.0];
    const Y: [f64; 10] = [10.0, 9.0, 1.5, 21.0, 8.5, 11.0, 4.0, 26.0, 12.0, 2.0];

    /// statrs computes the normal tail to nine digits.
    fn assert_p(p: Option<f64>, scipy: f64) {
        assert!((p.unwrap() - scipy).abs() < 1e-8, "{p:?} instead of {scipy}");
    }

    #[test]
    fn signed_ranks_have_the_p_values_of_scipy() {
        // scipy.stats.wilcoxon(d, method="exact")
        assert_p(
            wilcoxon(&[1.83, 0.5, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, -1.3, 0.231]),
            0.009_765_625,
        );
        // scipy.stats.wilcoxon(y, x, method="approx"), with ties
        let differences: Vec<f64> = X.iter().zip(Y).map(|(x, y)| y - x).collect();
        assert_p(wilcoxon(&differences), 0.041_094_854_763_548_73);
        // scipy.stats.wilcoxon([(i * 7919 % 101 - 45) / 10 for i in range(1, 61)])
        let many: Vec<f64> = (1..=60).map(|i| f64::from(i * 7919 % 101 - 45) / 10.0).collect();
        assert_p(wilcoxon(&many), 0.182_679_705_744_157_7);
        assert_eq!(wilcoxon(&[0.0; 4]), None);
    }

    #[test]
    fn rank_sums_have_the_p_values_of_scipy_whichever_sample_is_larger() {
        // scipy.stats.mannwhitneyu(a, b, method="exact")
        let (a, b) = ([1.0, 2.0, 3.0, 4.0, 7.0], [5.0, 6.0, 8.0, 9.0, 10.0]);
        assert_p(mann_whitney(&a, &b), 0.031_746_031_746_031_744);
        let (a, b) = ([0.5, 2.0, 3.5], [1.0, 4.0, 5.0, 6.0, 7.0, 8.5, 9.0]);
        assert_p(mann_whitney(&a, &b), 0.066_666_666_666_666_67);
        assert_p(mann_whitney(&b, &a), 0.066_666_666_666_666_67);
    }

    #[test]
    fn rank_sums_with_ties_have_the_p_values_of_scipy() {
        // scipy.stats.mannwhitneyu(a, b), method="asymptotic" with ties
        assert_p(mann_whitney(&X, &Y), 0.649_778_613_786_242_7);
        let a = [1.0, 2.0, 2.0, 3.0, 3.0, 3.0, 4.0, 9.0, 10.0, 11.0];
        let b = [2.0, 3.0, 4.0, 4.0, 5.0, 5.0, 6.0, 7.0, 8.0];
        assert_p(mann_whitney(&a, &b), 0.458_664_171_821_717_5);
        assert_eq!(mann_whitney(&[1.0; 3], &[1.0; 4]), None);
        assert_eq!(mann_whitney(&[], &[1.0]), None);
    }

    #[test]
    fn cliffs_delta_is_what_u_says() {
        // 2 * scipy.stats.mannwhitneyu(y, x).statistic / 100 - 1
        assert!((cliffs_delta(&X, &Y).unwrap() + 0.13).abs() < 1e-12);
        assert_eq!(cliffs_delta(&[1.0, 2.0], &[3.0, 4.0]), Some(1.0));
        assert_eq!(cliffs_delta(&[1.0], &[1.0]), Some(0.0));
        assert_eq!(cliffs_delta(&[], &[1.0]), None);
    }

    #[test]
    fn exact_distributions_add_up_to_one() {
        for ways in [signed_rank_ways(50), rank_sum_ways(50, 50), rank_sum_ways(1, 7)] {
            assert!((ways.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            assert!(ways.iter().all(|way| *way >= 0.0));
        }
    }
}
