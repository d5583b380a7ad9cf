//! What each trial adds to an estimate, and what that tells of its accuracy.

use super::permutation::Part;

/// What each trial adds to an estimate, to first order; `None` of a trial that tells nothing. They sum to zero.
pub type Terms = Vec<Option<f64>>;

/// The terms of a ratio of sums: the residuals a − R b over the sum of b (Cochran, 1977, section 6.3). `None` if nothing was
/// watched.
pub fn of_ratio(parts: &[Part]) -> Option<(f64, Terms)> {
    let sum = |part: usize| parts.iter().map(|parts| parts[part]).sum::<f64>();
    let watched = sum(1);
    let first = parts.iter().find(|part| part[1] > 0.0).map(|part| part[0] / part[1])?;
    // Equal values are exactly their mean, and have no residuals.
    let are_equal = parts.iter().all(|[a, b]| (a - first * b).abs() <= 0.0);
    let ratio = if are_equal { first } else { sum(0) / watched };
    let term = |&[a, b]: &Part| (a != 0.0 || b != 0.0).then(|| (a - ratio * b) / watched);
    ratio.is_finite().then(|| (ratio, parts.iter().map(term).collect()))
}

/// What each pair of trials adds to the difference of two estimates, the second less the first.
pub fn paired(a: &Terms, b: &Terms) -> Terms {
    together(a, b, |a, b| b - a)
}

/// What each pair of trials adds to what both trials add to.
pub fn summed(a: &Terms, b: &Terms) -> Terms {
    together(a, b, |a, b| a + b)
}

fn together(a: &Terms, b: &Terms, of: fn(f64, f64) -> f64) -> Terms {
    let pair = |(a, b): (&Option<f64>, &Option<f64>)| {
        (a.is_some() || b.is_some()).then(|| of(a.unwrap_or(0.0), b.unwrap_or(0.0)))
    };
    a.iter().zip(b).map(pair).collect()
}

/// How an estimate spreads.
#[derive(Clone, Copy, Debug)]
pub struct Moments {
    /// Trials that tell something; of two groups, the fewer.
    pub trials: usize,
    /// Variance of the estimate.
    pub variance: f64,
    /// Its third central moment; 0 where trials are too few to tell it.
    pub third: f64,
    /// Degrees of freedom of the variance.
    pub freedom: f64,
}

impl Moments {
    /// `None` from fewer than two trials.
    pub fn of(terms: &[Option<f64>]) -> Option<Self> {
        let terms = || terms.iter().flatten();
        let trials = terms().count();
        let n = trials as f64;
        let power = |power: i32| terms().map(|term| term.powi(power)).sum::<f64>();
        (trials > 1).then(|| Self {
            trials,
            variance: power(2) * n / (n - 1.0),
            third: if trials > 2 {
                power(3) * n * n / ((n - 1.0) * (n - 2.0))
            } else {
                0.0
            },
            freedom: n - 1.0,
        })
    }

    /// Of the difference of two independent estimates, the second less the first (Welch, 1947).
    pub fn between(a: Self, b: Self) -> Self {
        let variance = a.variance + b.variance;
        let weighed = |group: Self| group.variance * group.variance / group.freedom;
        let freedom = variance * variance / (weighed(a) + weighed(b));
        Self {
            trials: a.trials.min(b.trials),
            variance,
            third: b.third - a.third,
            freedom: if freedom.is_finite() {
                freedom
            } else {
                a.freedom.min(b.freedom)
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trial_adds_to_a_ratio_what_it_is_off_it_over_all_that_was_watched() {
        // R = 16/8 = 2: off it by 3 − 2, 8 − 6, 1 − 2 and 4 − 6, whatever their own ratios.
        let (ratio, terms) = of_ratio(&[[3.0, 1.0], [8.0, 3.0], [1.0, 1.0], [0.0, 0.0], [4.0, 3.0]]).unwrap();
        assert!((ratio - 2.0).abs() < 1e-15);
        assert_eq!(terms, [Some(0.125), Some(0.25), Some(-0.125), None, Some(-0.25)]);
    }
}
