//! Paired permutation test: under the hypothesis that two settings do not differ, the two values of a pair could as well
//! stand the other way round (Fisher, 1935).

use rand_philox::Philox;

use crate::engine::{Purpose, Streams};

const SWAP: Purpose = Purpose::new("statistics.permutation");
/// Up to so many pairs all ways to swap them are tried.
const EXACT_PAIRS: usize = 14;
/// Random ways to swap more pairs than that.
const PERMUTATIONS: u32 = 9_999;

/// A trial's part in a ratio of sums over trials: numerator and denominator. A plain value is over 1; where a trial has none,
/// both are 0.
pub type Part = [f64; 2];

/// Ratio of the sums of `parts`; not finite where nothing was counted.
#[must_use]
pub fn ratio_of_sums(parts: impl IntoIterator<Item = Part>) -> f64 {
    let [a, b] = parts
        .into_iter()
        .fold([0.0, 0.0], |[a, b], part| [a + part[0], b + part[1]]);
    a / b
}

/// Two-sided p-value of the difference between the ratios of sums of `a` and `b`, whose parts are paired: over all ways to swap
/// pairs where these are few, else over 9,999 random ones and the one observed (Davison and Hinkley, 1997, section 4.3).
/// `None` without a finite difference.
#[must_use]
pub fn paired_permutation(a: &[Part], b: &[Part]) -> Option<f64> {
    let observed = ratio_of_sums(b.iter().copied()) - ratio_of_sums(a.iter().copied());
    if !observed.is_finite() {
        return None;
    }
    // To swap equals changes nothing: each such pair would only double all counts.
    let all = a.iter().copied().zip(b.iter().copied());
    let (equal, pairs): (Vec<_>, Vec<_>) = all.partition(|(a, b)| are_equal(*a, *b));
    let start = equal
        .iter()
        .fold([0.0; 2], |[x, y], (part, _)| [x + part[0], y + part[1]]);
    let is_as_large = |swapped: &dyn Fn(usize) -> bool| {
        let difference = difference(start, &pairs, swapped);
        // Rounding must not make the same difference a smaller one; a difference without bounds counts as large.
        difference.is_nan() || difference.abs() >= observed.abs() * (1.0 - 1e-9)
    };
    if pairs.len() <= EXACT_PAIRS {
        let ways = 1_u32 << pairs.len();
        let large = (0..ways)
            .filter(|way| is_as_large(&|pair| way >> pair & 1 == 1))
            .count();
        return Some(large as f64 / f64::from(ways));
    }
    let streams = Streams::new(0, 0).keyed(SWAP);
    let large = (0..PERMUTATIONS).filter(|&number| {
        let mut random: Philox = streams.at(number, pairs.len() as u32, 0);
        let words: Vec<u64> = (0..pairs.len().div_ceil(64)).map(|_| random.next_u64()).collect();
        is_as_large(&|pair| words[pair / 64] >> (pair % 64) & 1 == 1)
    });
    Some((large.count() + 1) as f64 / f64::from(PERMUTATIONS + 1))
}

fn are_equal(a: Part, b: Part) -> bool {
    a.iter().zip(b).all(|(a, b)| a.total_cmp(&b).is_eq())
}

/// The difference between the ratios of sums after swapping pairs; both sums begin at `start`.
fn difference(start: Part, pairs: &[(Part, Part)], swapped: &dyn Fn(usize) -> bool) -> f64 {
    let mut sums = [start; 2];
    for (pair, (a, b)) in pairs.iter().enumerate() {
        let (first, second) = if swapped(pair) { (b, a) } else { (a, b) };
        for part in 0..2 {
            sums[0][part] += first[part];
            sums[1][part] += second[part];
        }
    }
    sums[1][0] / sums[1][1] - sums[0][0] / sums[0][1]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(values: &[f64]) -> Vec<Part> {
        values.iter().map(|&value| [value, 1.0]).collect()
    }

    #[test]
    fn few_pairs_have_the_exact_p_value_of_scipy() {
        // scipy.stats.permutation_test((y, x), mean of differences, permutation_type="samples", n_resamples=inf)
        let x = plain(&[12.0, 7.0, 3.0, 25.0, 8.0, 14.0, 9.0, 30.0, 11.0, 5.0]);
        let y = plain(&[10.0, 9.0, 1.5, 21.0, 8.5, 11.0, 4.0, 26.0, 12.0, 2.0]);
        assert_eq!(paired_permutation(&x, &y), Some(0.042_968_75));
        assert_eq!(paired_permutation(&y, &x), Some(0.042_968_75));
    }

    #[test]
    fn many_pairs_come_near_the_exact_p_value() {
        // Twenty pairs that all differ by 1 but five, which differ by −1: sums of ±1 at least as large as 10, 2·P(Bin(20, ½) ≥ 15)
        // = 0.041_39; of 9,999 permutations, ± 3·√(0.0414·0.9586/9,999) = 0.006.
        let a = plain(&[0.0; 20]);
        let b = plain(&std::array::from_fn::<_, 20, _>(
            |pair| if pair < 5 { -1.0 } else { 1.0 },
        ));
        let p = paired_permutation(&a, &b).unwrap();
        assert!((p - 0.0414).abs() < 0.006, "{p}");
    }

    #[test]
    fn equal_pairs_show_no_difference_and_weigh_nothing() {
        let a = plain(&[1.0, 2.0, 3.0]);
        assert_eq!(paired_permutation(&a, &a), Some(1.0));
        let (mut a, mut b) = (plain(&[1.0; 40]), plain(&[1.0; 40]));
        a.extend(plain(&[0.0; 6]));
        b.extend(plain(&[1.0; 6]));
        assert_eq!(paired_permutation(&a, &b), Some(2.0 / 64.0));
    }

    #[test]
    fn a_ratio_of_sums_is_compared_as_a_whole_and_one_over_nothing_not_at_all() {
        let (a, b) = ([[1.0, 10.0], [0.0, 10.0]], [[8.0, 10.0], [9.0, 10.0]]);
        assert_eq!(paired_permutation(&a, &b), Some(0.5));
        assert_eq!(paired_permutation(&[[0.0, 0.0]; 3], &[[1.0, 1.0]; 3]), None);
    }
}
