//! How much two estimates differ.

use super::estimator::Estimator;
use super::interval::wider;
use super::permutation::Part;
use super::terms::{Moments, Terms, of_ratio, paired};
use super::{Ci95, Estimate};

/// The second of two estimates less the first, with its interval; `n` counts pairs, or the fewer trials. Means are compared by the
/// trials' own differences where these are `pairs`, else as Welch has it (1947), by Student's t. Shares, rates and medians are compared by their own intervals
/// (Zou and Donner, 2008), which know how far each may be even where nothing was seen.
#[must_use]
pub fn difference(estimator: Estimator, parts: [&[Part]; 2], pairs: bool) -> Estimate {
    let n = parts[0].len().min(parts[1].len()) as u64;
    let none = Estimate {
        n,
        ..Estimate::default()
    };
    let estimates = parts.map(|parts| estimator.estimate(parts));
    let (Some((_, first)), Some((_, second))) = (of_ratio(parts[0]), of_ratio(parts[1])) else {
        return none;
    };
    let (Some(a), Some(b)) = (estimates[0].value, estimates[1].value) else {
        return none;
    };
    let ci95 = match estimator {
        Estimator::Mean | Estimator::Signed | Estimator::Fraction | Estimator::Count | Estimator::Times => {
            of_means(estimator, b - a, [&first, &second], pairs)
        }
        Estimator::Median => of_intervals(estimates, 0.0),
        Estimator::Share | Estimator::ShareOf | Estimator::Rate | Estimator::Recurrence => {
            let correlation = if pairs { correlation(&first, &second) } else { 0.0 };
            of_intervals(estimates, correlation)
        }
    };
    Estimate {
        value: Some(b - a),
        ci95,
        n,
    }
}

fn of_means(estimator: Estimator, value: f64, [first, second]: [&Terms; 2], pairs: bool) -> Ci95 {
    let moments = if pairs {
        Moments::of(&paired(first, second))
    } else {
        Moments::of(first).and_then(|first| Some(Moments::between(first, Moments::of(second)?)))
    };
    match moments {
        Some(moments) if moments.variance > 0.0 => wider(value, moments),
        Some(_) if matches!(estimator, Estimator::Mean | Estimator::Signed | Estimator::Fraction) => [Some(value); 2],
        _ => [None; 2],
    }
}

/// From the ends of both intervals: how far the one may be below and the other above, squared and added, less what they share.
fn of_intervals([a, b]: [Estimate; 2], correlation: f64) -> Ci95 {
    let reach = |estimate: Estimate, end: usize| Some((estimate.ci95[end]? - estimate.value?).abs());
    let difference = a.value.zip(b.value).map(|(a, b)| b - a);
    let end = |sign: f64, [first, second]: [Option<f64>; 2]| {
        let (first, second) = (first?, second?);
        let squared = first * first + second * second - 2.0 * correlation * first * second;
        Some(difference? + sign * squared.max(0.0).sqrt())
    };
    [
        end(-1.0, [reach(a, 1), reach(b, 0)]),
        end(1.0, [reach(a, 0), reach(b, 1)]),
    ]
}

/// The correlation of the terms of paired trials; 0 where one of them does not vary.
fn correlation(first: &Terms, second: &Terms) -> f64 {
    let pairs = || {
        first
            .iter()
            .zip(second)
            .map(|(a, b)| (a.unwrap_or(0.0), b.unwrap_or(0.0)))
    };
    let sum = |of: fn((f64, f64)) -> f64| pairs().map(of).sum::<f64>();
    let correlation = sum(|(a, b)| a * b) / (sum(|(a, _)| a * a) * sum(|(_, b)| b * b)).sqrt();
    if correlation.is_finite() {
        correlation.clamp(-1.0, 1.0)
    } else {
        0.0
    }
}
