//! The gamma distribution, from `libm` alone: the same bytes on every machine.

use libm::{exp, lgamma, log};

/// Terms of a series or of a continued fraction at most; far fewer are ever needed.
const MOST_TERMS: u32 = 10_000;
/// Where a term is too small to count.
const NEGLIGIBLE: f64 = 1e-16;
/// Stands for 0 in a denominator.
const TINY: f64 = 1e-300;

/// P(a, x): the chance that a gamma variate of shape `a` and scale 1 is below `x`; and what is left to 1. Both to a relative error of 1e-11.
///
/// A series where x is below a + 1, else a continued fraction (Lentz), as in *Numerical Recipes*, section 6.2.
pub(super) fn below_and_above(a: f64, x: f64) -> [f64; 2] {
    if x <= 0.0 {
        return [0.0, 1.0];
    }
    if x.is_infinite() {
        return [1.0, 0.0];
    }
    let front = exp(a * log(x) - x - lgamma(a));
    if x < a + 1.0 {
        let below = front * series(a, x);
        [below, 1.0 - below]
    } else {
        let above = front * fraction(a, x);
        [1.0 - above, above]
    }
}

/// The density of a gamma variate of shape `a` and scale 1 at `x` > 0, times `x`: that of its logarithm.
pub(super) fn density_of_log(a: f64, x: f64) -> f64 {
    exp(a * log(x) - x - lgamma(a))
}

/// Σ x^n / (a(a + 1)…(a + n)).
fn series(a: f64, x: f64) -> f64 {
    let mut term = 1.0 / a;
    let mut sum = term;
    for n in 1..MOST_TERMS {
        term *= x / (a + f64::from(n));
        sum += term;
        if term < sum * NEGLIGIBLE {
            break;
        }
    }
    sum
}

/// 1/(x + 1 − a − 1(1 − a)/(x + 3 − a − 2(2 − a)/(x + 5 − a − …))).
fn fraction(a: f64, x: f64) -> f64 {
    let mut denominator = x + 1.0 - a;
    let mut forward = 1.0 / TINY;
    let mut backward = 1.0 / denominator;
    let mut value = backward;
    for n in (1..MOST_TERMS).map(f64::from) {
        let numerator = -n * (n - a);
        denominator += 2.0;
        backward = 1.0 / not_zero(numerator * backward + denominator);
        forward = not_zero(denominator + numerator / forward);
        value *= backward * forward;
        if (backward * forward - 1.0).abs() < NEGLIGIBLE {
            break;
        }
    }
    value
}

fn not_zero(x: f64) -> f64 {
    if x.abs() < TINY { TINY } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shapes, arguments, and both chances, by an independent program.
    #[test]
    fn chances_are_those_of_an_independent_program() {
        for (a, x, expected) in [
            (0.5, 0.005, [0.079655674554058, 0.92034432544594]),
            (0.5, 0.25, [0.52049987781305, 0.47950012218695]),
            (0.5, 1.0, [0.84270079294972, 0.15729920705028]),
            (1.0, 0.01, [0.009950166250832, 0.99004983374917]),
            (1.0, 2.0, [0.86466471676339, 0.13533528323661]),
            (3.0, 0.03, [4.3999549397491e-06, 0.99999560004506]),
            (3.0, 6.0, [0.93803119558334, 0.061968804416659]),
            (20.0, 0.2, [3.5626284992395e-33, 1.0]),
            (20.0, 20.0, [0.52974273316076, 0.47025726683924]),
            (20.0, 40.0, [0.99982369710226, 0.00017630289773857]),
            (100.0, 1.0, [3.9812808189569e-159, 1.0]),
            (100.0, 50.0, [3.2000653245851e-10, 0.99999999967999]),
            (100.0, 200.0, [1.0, 1.8438936497115e-15]),
        ] {
            for (found, expected) in below_and_above(a, x).into_iter().zip(expected) {
                let error = (found / expected - 1.0).abs();
                assert!(error < 1e-11, "{a}, {x}: {found}, not {expected}");
            }
        }
        let ends = [0.0, f64::INFINITY].map(|x| below_and_above(2.0, x)[0].to_bits());
        assert_eq!(ends, [0.0_f64, 1.0].map(f64::to_bits));
    }
}
