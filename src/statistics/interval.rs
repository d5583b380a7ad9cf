//! Shapes of intervals: of what has no bounds, of shares, and of rates.

use statrs::distribution::{ContinuousCDF, Gamma, StudentsT};

use super::terms::Moments;
use super::{Ci95, TAIL, normal_quantile};

/// Student's quantile that leaves out `tail` above it; `None` without a degree of freedom.
pub fn student(freedom: f64, tail: f64) -> Option<f64> {
    let student = StudentsT::new(0.0, 1.0, freedom).ok()?;
    Some(student.inverse_cdf(1.0 - tail))
}

/// What an interval from so few trials leaves out on either side. Student's quantile is exact for normal values; for skewed ones, of
/// which so few trials cannot tell the skewness, it is too small. These were found by simulation: with them uniform, normal, gamma
/// and exponential values all lie in 93 to 97.5 % of the intervals.
pub fn tail_of_few(trials: usize) -> f64 {
    match trials {
        0..=2 => 0.0175,
        3 => 0.006,
        4 => 0.015,
        5 => 0.02,
        6 => 0.0225,
        _ => TAIL,
    }
}

/// The interval about `value` of Student's t that leaves out `tail` on either side, corrected for skewness by Hall's cubic transformation
/// (1992): t + γt²/3 + γ²t³/27 + γ/6, whose inverse takes the symmetric interval to one that is as skewed as the estimate. Without
/// skewness it is Student's interval.
pub fn skewed(value: f64, moments: Moments, tail: f64) -> Ci95 {
    let Some(quantile) = student(moments.freedom, tail) else {
        return [None; 2];
    };
    let error = moments.variance.sqrt();
    let skewness = moments.third / (moments.variance * error);
    let end = |quantile: f64| {
        let shift = if skewness.is_finite() && skewness.abs() > 1e-6 {
            let bent = 1.0 + skewness * (quantile - skewness / 6.0);
            3.0 / skewness * (bent.cbrt() - 1.0)
        } else {
            quantile
        };
        Some(value - error * shift).filter(|end| end.is_finite())
    };
    [end(quantile), end(-quantile)]
}

/// The farther end on either side of Student's interval, with or without correction for skewness. Differences are seldom skewed, and
/// then the correction does more harm than good; but they may be.
pub fn wider(value: f64, moments: Moments) -> Ci95 {
    let plain = skewed(value, Moments { third: 0.0, ..moments }, TAIL);
    let corrected = skewed(value, moments, TAIL);
    let farther = |end: usize, of: fn(f64, f64) -> f64| Some(of(plain[end]?, corrected[end]?));
    [farther(0, f64::min), farther(1, f64::max)]
}

/// Wilson's score interval for a `share` of `n` at the quantile `z`.
pub fn wilson(share: f64, n: f64, z: f64) -> [f64; 2] {
    let centre = (share + z * z / (2.0 * n)) / (1.0 + z * z / n);
    let half_width = z / (1.0 + z * z / n) * (share * (1.0 - share) / n + z * z / (4.0 * n * n)).sqrt();
    // At the extremes the end is exactly 0 or 1; rounding must not carry it past.
    let low = if share <= 0.0 { 0.0 } else { centre - half_width };
    let high = if share >= 1.0 { 1.0 } else { centre + half_width };
    [low.max(0.0), high.min(1.0)]
}

/// Wilson's interval of a share at the effective number of trials v(1−v)/Var v, with Student's quantile of so few trials for
/// Wilson's; at 0 and 1, where their variance says nothing, the trials count as so many yeses and noes. `None` where they do not differ otherwise.
pub fn share_at(share: f64, moments: Moments) -> Option<[f64; 2]> {
    if share <= 0.0 || share >= 1.0 {
        return Some(wilson(share, moments.trials as f64, normal_quantile()));
    }
    let effective = share * (1.0 - share) / moments.variance;
    // Wilson's interval is skewed as shares are, so that three trials need no more room than two.
    let t = student(moments.freedom, tail_of_few(moments.trials).max(tail_of_few(2)))?;
    effective.is_finite().then(|| wilson(share, effective, t))
}

/// The interval of a rate that was estimated from `events`, over that rate: exact for Poisson events (Garwood, 1936), and its
/// continuation for an effective number of them. Of no events, the ends are in events.
pub fn poisson(events: f64) -> [f64; 2] {
    let quantile =
        |shape: f64, probability: f64| Gamma::new(shape, 1.0).map_or(0.0, |gamma| gamma.inverse_cdf(probability));
    if events <= 0.0 {
        return [0.0, -TAIL.ln()];
    }
    [
        quantile(events, TAIL) / events,
        quantile(events + 1.0, 1.0 - TAIL) / events,
    ]
}

/// How much wider an interval is for the spread being estimated: Student's quantile over the normal one, squared.
pub fn inflation(freedom: f64) -> f64 {
    student(freedom, TAIL).map_or(f64::INFINITY, |t| (t / normal_quantile()).powi(2))
}
