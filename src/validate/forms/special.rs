//! Integrals, roots and special functions.

use std::f64::consts::PI;

use statrs::distribution::{ContinuousCDF, Normal};
use statrs::function::gamma::{gamma_lr, ln_gamma};

/// The integral of `f` from `low` to `high` by Simpson's rule in `steps` steps, an even number.
pub fn integral(low: f64, high: f64, steps: u32, f: impl Fn(f64) -> f64) -> f64 {
    let step = (high - low) / f64::from(steps);
    let weight = |place: u32| match place {
        _ if place == 0 || place == steps => 1.0,
        _ if place % 2 == 1 => 4.0,
        _ => 2.0,
    };
    let sum: f64 = (0..=steps)
        .map(|place| weight(place) * f(low + step * f64::from(place)))
        .sum();
    sum * step / 3.0
}

/// Where `f`, which falls from above 0 to below, is 0.
pub fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = f64::midpoint(low, high);
        if f(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}

/// Bessel's J0 by its integral, ∫ cos(x sin t) dt/π from 0 to π, of which the trapezoidal rule is exact as soon as its steps are more than x.
pub fn j0(x: f64) -> f64 {
    let steps = 64 + 4 * x.abs() as u32;
    let sum: f64 = (0..steps)
        .map(|step| (x * (PI * (f64::from(step) + 0.5) / f64::from(steps)).sin()).cos())
        .sum();
    sum / f64::from(steps)
}

/// The modified Bessel function I0 by its series.
pub fn i0(x: f64) -> f64 {
    let mut term = 1.0;
    (1..300).fold(1.0, |sum, n| {
        term *= (x / 2.0 / f64::from(n)).powi(2);
        sum + term
    })
}

/// Kummer's 1F1(a; b; x) by its series, Kummer's transformation first where x is negative.
pub fn kummer(a: f64, b: f64, x: f64) -> f64 {
    if x < 0.0 {
        return x.exp() * kummer(b - a, b, -x);
    }
    let mut term = 1.0;
    (0..500).fold(1.0, |sum, n| {
        let n = f64::from(n);
        term *= (a + n) / (b + n) * x / (n + 1.0);
        sum + term
    })
}

/// 1 − Q1(a, b), Marcum's function, as a Poisson mixture of gamma laws.
pub fn marcum_below(a: f64, b: f64) -> f64 {
    let half = a * a / 2.0;
    let term = |n: u32| {
        let n = f64::from(n);
        (n * half.ln() - half - ln_gamma(n + 1.0)).exp() * gamma_lr(n + 1.0, b * b / 2.0)
    };
    if half == 0.0 {
        gamma_lr(1.0, b * b / 2.0)
    } else {
        (0..400).map(term).sum()
    }
}

/// The standard normal distribution function.
pub fn normal(x: f64) -> f64 {
    Normal::standard().cdf(x)
}

/// So many dB as a ratio.
pub fn ratio(db: f64) -> f64 {
    10_f64.powf(db / 10.0)
}

/// A ratio in dB.
pub fn db(ratio: f64) -> f64 {
    10.0 * ratio.log10()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// scipy: `special.j0`, `special.i0`, `special.hyp1f1`, `stats.ncx2.cdf(1, 2, 8)`.
    #[test]
    fn special_functions_have_their_known_values() {
        let near = |found: f64, known: f64| assert!((found - known).abs() < 1e-9, "{found} for {known}");
        near(j0(1.0), 0.765_197_686_557_966_6);
        near(j0(20.0), 0.167_024_664_340_583_2);
        near(i0(2.0), 2.279_585_302_336_067);
        near(kummer(-2.0 / 3.0, 1.0, 0.0), 1.0);
        near(kummer(1.0, 1.0, -3.0), (-3.0_f64).exp());
        near(integral(0.0, PI, 200, f64::sin), 2.0);
        near(root(0.0, 4.0, |x| 2.0 - x * x), 2.0_f64.sqrt());
        assert!((marcum_below(8.0_f64.sqrt(), 1.0) - 0.016_30).abs() < 1e-4);
    }
}
