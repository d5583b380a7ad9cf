//! Permutation tests of paired trials: under the hypothesis that two settings do not differ, the two values of a pair could as well
//! stand the other way round (Fisher, 1935).

use rand_philox::Philox;

use crate::engine::{Purpose, Streams};

const SWAP: Purpose = Purpose::new("statistics.permutation");
/// Up to so many pairs all ways to swap them are tried.
const EXACT_PAIRS: usize = 14;
/// Random ways to swap more pairs than that: at least so many, at most so many.
const FEWEST_WAYS: u64 = 9_999;
const MOST_WAYS: u64 = 999_999;
/// Random ways for each test of the family, so that the least p-value that they leave, times the family, is a tenth of 0.05.
const WAYS_A_TEST: u64 = 200;
/// When so many random ways are as large as what was observed, the p-value is known to a twentieth of itself, and no more are tried.
const ENOUGH: u64 = 400;

/// A trial's part in a ratio of sums over trials: numerator and denominator. A plain value is over 1; where a trial has none,
/// both are 0.
pub type Part = [f64; 2];

/// What a test found, and what it could have found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tested {
    /// The two-sided p-value.
    pub p: f64,
    /// The least p-value that these trials could have given, however they had come out.
    pub least: f64,
    /// Whether the two sides are the same in every trial.
    pub alike: bool,
}

/// Ratio of the sums of `parts`; not finite where nothing was counted.
#[must_use]
pub fn ratio_of_sums(parts: impl IntoIterator<Item = Part>) -> f64 {
    let [a, b] = parts
        .into_iter()
        .fold([0.0, 0.0], |[a, b], part| [a + part[0], b + part[1]]);
    a / b
}

/// Tests the difference between ratios of sums whose parts are paired, in a family of so many `tests`. Each stratum has the two sides'
/// parts, a pair a trial; the difference is the mean over strata, and a trial is swapped in all of them together: over all ways where
/// trials are few, else over random ones and the one observed (Davison and Hinkley, 1997, section 4.3), as many as the family asks
/// for, or until enough were as large (Besag and Clifford, 1991). `None` without a finite difference.
#[must_use]
pub fn paired_permutation(strata: &[[&[Part]; 2]], tests: usize) -> Option<Tested> {
    let trials = strata.iter().map(|[a, b]| a.len().min(b.len())).min().unwrap_or(0);
    // To swap equals changes nothing: each such trial would only double all counts.
    let differs = |&trial: &usize| strata.iter().any(|[a, b]| !are_equal(a[trial], b[trial]));
    let (moving, equal): (Vec<usize>, Vec<usize>) = (0..trials).partition(differs);
    let start: Vec<Part> = strata
        .iter()
        .map(|[a, _]| total_of(equal.iter().map(|&trial| a[trial])))
        .collect();
    let difference = |swapped: &Way| {
        let mut place = 0;
        mean_difference(strata, |[a, b]| {
            let mut sums = [start[place]; 2];
            place += 1;
            for (pair, &trial) in moving.iter().enumerate() {
                let (first, second) = if swapped(pair) { (b, a) } else { (a, b) };
                for part in 0..2 {
                    sums[0][part] += first[trial][part];
                    sums[1][part] += second[trial][part];
                }
            }
            sums
        })
    };
    let observed = difference(&|_| false);
    if !observed.is_finite() {
        return None;
    }
    let is_as_large = |swapped: &Way| {
        let difference = difference(swapped);
        // Rounding must not make the same difference a smaller one; a difference without bounds counts as large.
        difference.is_nan() || difference.abs() >= observed.abs() * (1.0 - 1e-9)
    };
    Some(over_ways(moving.len(), tests, &is_as_large))
}

/// Tests whether the mean over trials of a vector is zero, by its squared length, in a family of so many `tests`: if it is, and trials are
/// symmetric about it, each trial's vector could as well have the opposite sign. Trials without a vector weigh nothing. `None` where a
/// number is not finite.
#[must_use]
pub fn sign_permutation(vectors: &[Vec<f64>], tests: usize) -> Option<Tested> {
    if vectors.iter().flatten().any(|value| !value.is_finite()) {
        return None;
    }
    let moving: Vec<&Vec<f64>> = vectors
        .iter()
        .filter(|vector| vector.iter().any(|value| *value != 0.0))
        .collect();
    let length = |flipped: &Way| -> f64 {
        let parts = moving.first().map_or(0, |vector| vector.len());
        let sum = |part: usize| -> f64 {
            let signed = moving.iter().enumerate();
            signed
                .map(|(trial, vector)| if flipped(trial) { -vector[part] } else { vector[part] })
                .sum()
        };
        (0..parts).map(|part| sum(part).powi(2)).sum()
    };
    let observed = length(&|_| false);
    let is_as_large = |flipped: &Way| length(flipped) >= observed * (1.0 - 1e-9);
    Some(over_ways(moving.len(), tests, &is_as_large))
}

/// A way to swap pairs: whether each of them is.
type Way<'a> = dyn Fn(usize) -> bool + 'a;

/// The share of the ways to swap `pairs` pairs that are as large as what was observed.
fn over_ways(pairs: usize, tests: usize, is_as_large: &dyn Fn(&Way) -> bool) -> Tested {
    if pairs <= EXACT_PAIRS {
        let ways = 1_u32 << pairs;
        let large = (0..ways)
            .filter(|way| is_as_large(&|pair| way >> pair & 1 == 1))
            .count();
        return Tested {
            p: large as f64 / f64::from(ways),
            least: least_of_pairs(pairs as u64),
            alike: pairs == 0,
        };
    }
    let most = (WAYS_A_TEST * tests as u64).clamp(FEWEST_WAYS, MOST_WAYS);
    let streams = Streams::new(0, 0).keyed(SWAP);
    let (mut large, mut tried) = (0, 0);
    while tried < most && large < ENOUGH {
        let mut random: Philox = streams.at(tried as u32, pairs as u32, 0);
        let words: Vec<u64> = (0..pairs.div_ceil(64)).map(|_| random.next_u64()).collect();
        large += u64::from(is_as_large(&|pair| words[pair / 64] >> (pair % 64) & 1 == 1));
        tried += 1;
    }
    // Stopped early, the last way is itself as large as what was observed.
    let (large, ways) = if large == ENOUGH {
        (large, tried)
    } else {
        (large + 1, tried + 1)
    };
    Tested {
        p: large as f64 / ways as f64,
        least: least_of_pairs(pairs as u64).max(1.0 / (most + 1) as f64),
        alike: false,
    }
}

/// The least two-sided p-value of a permutation test of so many pairs that differ: the ways are as many as 2 to their power, and of these
/// the one observed and its opposite are always as large. 1 of none.
#[must_use]
pub fn least_of_pairs(pairs: u64) -> f64 {
    2.0_f64.powi(1 - pairs.min(1000) as i32).min(1.0)
}

/// Whether two parts differ by no more than rounding.
fn are_equal(a: Part, b: Part) -> bool {
    a.iter()
        .zip(b)
        .all(|(a, b)| (a - b).abs() <= 1e-12 * a.abs().max(b.abs()))
}

fn total_of(parts: impl Iterator<Item = Part>) -> Part {
    parts.fold([0.0; 2], |[x, y], part| [x + part[0], y + part[1]])
}

/// The mean over strata of the difference between two ratios, of the sums that `sums` makes of a stratum's sides.
fn mean_difference<'a>(strata: &[[&'a [Part]; 2]], mut sums: impl FnMut([&'a [Part]; 2]) -> [Part; 2]) -> f64 {
    let differences = strata.iter().map(|sides| {
        let [a, b] = sums(*sides);
        b[0] / b[1] - a[0] / a[1]
    });
    differences.sum::<f64>() / strata.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(values: &[f64]) -> Vec<Part> {
        values.iter().map(|&value| [value, 1.0]).collect()
    }

    /// The p-value of a single stratum in a family of its own.
    fn p(a: &[Part], b: &[Part]) -> Option<f64> {
        paired_permutation(&[[a, b]], 1).map(|tested| tested.p)
    }

    #[test]
    fn few_pairs_have_the_exact_p_value_of_scipy() {
        // scipy.stats.permutation_test((y, x), mean of differences, permutation_type="samples", n_resamples=inf)
        let x = plain(&[12.0, 7.0, 3.0, 25.0, 8.0, 14.0, 9.0, 30.0, 11.0, 5.0]);
        let y = plain(&[10.0, 9.0, 1.5, 21.0, 8.5, 11.0, 4.0, 26.0, 12.0, 2.0]);
        assert_eq!(p(&x, &y), Some(0.042_968_75));
        assert_eq!(p(&y, &x), Some(0.042_968_75));
    }

    #[test]
    fn many_pairs_come_near_the_exact_p_value() {
        // Twenty pairs that all differ by 1 but five, which differ by −1: sums of ±1 at least as large as 10, 2·P(Bin(20, ½) ≥ 15)
        // = 0.041_39; of 9,999 permutations, ± 3·√(0.0414·0.9586/9,999) = 0.006.
        let a = plain(&[0.0; 20]);
        let b = plain(&std::array::from_fn::<_, 20, _>(
            |pair| if pair < 5 { -1.0 } else { 1.0 },
        ));
        let p = p(&a, &b).unwrap();
        assert!((p - 0.0414).abs() < 0.006, "{p}");
    }

    #[test]
    fn equal_pairs_show_no_difference_and_weigh_nothing() {
        let a = plain(&[1.0, 2.0, 3.0]);
        assert_eq!(p(&a, &a), Some(1.0));
        // One pair that differs could show nothing, and is not the same for that.
        let (one, other) = (plain(&[3.0, 1.0]), plain(&[3.0, 2.0]));
        let tested = paired_permutation(&[[&one, &other]], 1).unwrap();
        assert_eq!(
            tested,
            Tested {
                p: 1.0,
                least: 1.0,
                alike: false
            }
        );
        let (mut a, mut b) = (plain(&[1.0; 40]), plain(&[1.0; 40]));
        a.extend(plain(&[0.0; 6]));
        b.extend(plain(&[1.0; 6]));
        assert_eq!(p(&a, &b), Some(2.0 / 64.0));
    }

    #[test]
    fn a_ratio_of_sums_is_compared_as_a_whole_and_one_over_nothing_not_at_all() {
        let (a, b) = ([[1.0, 10.0], [0.0, 10.0]], [[8.0, 10.0], [9.0, 10.0]]);
        assert_eq!(p(&a, &b), Some(0.5));
        assert_eq!(p(&[[0.0, 0.0]; 3], &[[1.0, 1.0]; 3]), None);
    }

    #[test]
    fn the_least_p_value_is_that_of_pairs_which_all_lean_one_way_and_a_larger_family_is_given_more_ways() {
        // 2/2⁶, whatever lies beside; equal pairs weigh nothing; of many pairs, one of all ways tried.
        let (a, b) = (plain(&[0.0; 9]), plain(&[1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 0.0, 0.0, 0.0]));
        let few = paired_permutation(&[[&a, &b]], 1).unwrap();
        assert_eq!((few.p, few.least), (2.0 / 64.0, 2.0 / 64.0));
        assert!(paired_permutation(&[[&a, &a]], 1).unwrap().alike);
        let (a, b) = (plain(&[0.0; 40]), plain(&[1.0; 40]));
        for (tests, least) in [(1, 1e-4), (50, 1e-4), (600, 1.0 / 120_000.0)] {
            let many = paired_permutation(&[[&a, &b]], tests).unwrap();
            assert!(
                (many.p / least - 1.0).abs() < 1e-4 && many.least >= many.p,
                "{tests}: {many:?}"
            );
            assert!(many.p * tests as f64 <= 0.005_001);
        }
    }

    #[test]
    fn a_level_is_tested_over_all_levels_of_the_other_factor_together() {
        // numpy over all 2⁶ signs of the trials' mean differences over two strata, d = [(1 + 2)/2, (0 + 3)/2, (2 − 1)/2, (−1 + 0)/2, (3 + 1)/2,
        // (1 + 1)/2]: of sums of ±d, 6 of 64 are at least 6 or at most −6.
        let x = [plain(&[5.0; 6]), plain(&[9.0; 6])];
        let y = [
            plain(&[6.0, 5.0, 7.0, 4.0, 8.0, 6.0]),
            plain(&[11.0, 12.0, 8.0, 9.0, 10.0, 10.0]),
        ];
        let strata = [[&x[0][..], &y[0][..]], [&x[1][..], &y[1][..]]];
        assert_eq!(paired_permutation(&strata, 1).map(|tested| tested.p), Some(6.0 / 64.0));
        let means = [1.5, 1.5, 0.5, -0.5, 2.0, 1.0];
        assert_eq!(p(&plain(&[0.0; 6]), &plain(&means)), Some(6.0 / 64.0));
    }

    #[test]
    fn signs_of_vectors_are_tested_by_the_length_of_their_mean() {
        // itertools.product([1, -1], repeat=5), s = signs @ v, (s ** 2).sum(1) >= observed: 20 of 32.
        let vectors = [
            [1.0, 0.5],
            [2.0, -0.3],
            [0.7, 0.2],
            [-1.4, 0.9],
            [-0.2, -1.1],
            [0.0, 0.0],
        ];
        let tested = sign_permutation(&vectors.map(Vec::from), 1).unwrap();
        assert_eq!((tested.p, tested.least), (20.0 / 32.0, 2.0 / 32.0));
        assert_eq!(
            sign_permutation(&[vec![0.0]], 1).unwrap(),
            Tested {
                p: 1.0,
                least: 1.0,
                alike: true
            }
        );
        assert_eq!(sign_permutation(&[vec![f64::NAN]], 1), None);
    }
}
