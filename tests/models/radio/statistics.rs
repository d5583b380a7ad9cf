//! Measured figures and how far they may lie from what they should be.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// The chance that a standard normal lies beyond four standard errors, either way.
const SIGNIFICANCE: f64 = 6.334e-5;

/// Asserts that `measured` lies within four of its standard errors of `expected`.
#[track_caller]
pub fn assert_near(what: &str, measured: f64, expected: f64, standard_error: f64) {
    assert!(
        (measured - expected).abs() <= 4.0 * standard_error,
        "{what}: measured {measured}, expected {expected} ± {}",
        4.0 * standard_error
    );
}

/// Mean of `values`.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Sample variance of `values`.
pub fn variance(values: &[f64]) -> f64 {
    let centre = mean(values);
    values.iter().map(|value| (value - centre).powi(2)).sum::<f64>() / (values.len() - 1) as f64
}

/// Correlation of two samples taken side by side; its standard error is 1/√n where there is none.
pub fn correlation(left: &[f64], right: &[f64]) -> f64 {
    let (left_mean, right_mean) = (mean(left), mean(right));
    let products = left.iter().zip(right).map(|(l, r)| (l - left_mean) * (r - right_mean));
    products.sum::<f64>() / (left.len() - 1) as f64 / (variance(left) * variance(right)).sqrt()
}

/// 1 for each `true`, 0 for each `false`.
pub fn indicators(events: &[bool]) -> Vec<f64> {
    events.iter().map(|&event| f64::from(u8::from(event))).collect()
}

/// Kolmogorov–Smirnov: √n times the largest distance between the sample's distribution and `cdf`.
pub fn kolmogorov_smirnov(sample: &[f64], cdf: impl Fn(f64) -> f64) -> f64 {
    let mut sorted = sample.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let distance = |(rank, &value): (usize, &f64)| {
        let expected = cdf(value);
        (expected - rank as f64 / n).max((rank + 1) as f64 / n - expected)
    };
    n.sqrt() * sorted.iter().enumerate().map(distance).fold(0.0, f64::max)
}

/// What [`kolmogorov_smirnov`] may reach: Kolmogorov's distribution has P(D√n > x) ≈ 2 exp(−2x²), so 2.28.
pub fn kolmogorov_limit() -> f64 {
    ((2.0 / SIGNIFICANCE).ln() / 2.0).sqrt()
}

/// Asserts, by chi-square, that `counts` of outcomes 0, 1, 2, … come from the geometric law P(i) = (1 − q) qⁱ.
/// Outcomes that are expected fewer than ten times are counted together.
#[track_caller]
pub fn assert_geometric(what: &str, counts: &[u64], q: f64) {
    let total = counts.iter().sum::<u64>() as f64;
    let cells = (1.0 + (10.0 / (total * (1.0 - q))).ln() / q.ln()).floor() as usize;
    let tail = counts.iter().skip(cells).sum::<u64>();
    let observed = (0..cells).map(|i| counts.get(i).copied().unwrap_or(0)).chain([tail]);
    let expected = (0..cells)
        .map(|i| (1.0 - q) * q.powf(i as f64))
        .chain([q.powf(cells as f64)]);
    let chi_square: f64 = observed
        .zip(expected)
        .map(|(seen, share)| (seen as f64 - total * share).powi(2) / (total * share))
        .sum();
    let law = ChiSquared::new(cells as f64).expect("a positive number of degrees of freedom");
    let limit = law.inverse_cdf(1.0 - SIGNIFICANCE);
    assert!(
        chi_square < limit,
        "{what}: chi-square {chi_square} of {cells} degrees, limit {limit}"
    );
}
