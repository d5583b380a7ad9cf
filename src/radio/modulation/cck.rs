//! Complementary code keying of IEEE 802.11b: 5.5 and 11 Mb/s in 22 MHz.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use libm::{erfc, exp, expm1, log1p, sqrt};

/// Bits that share the fate of one symbol in the form that is used.
const BITS: f64 = 4.0;
/// Noise beyond so many standard deviations is left out: a chance of 4e-33.
const FARTHEST: f64 = 12.0;
/// Of the noise's range, this many panels of five points each: the relative error stays below 1e-8, which the tests show.
const PANELS: u32 = 24;
/// Points and weights of Gauss and Legendre's rule of five points on [−1, 1].
const RULE: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// The rate of independent bit errors that leaves as many frames whole as symbol errors do, of which each takes four bits: 1 − (1 − P)^¼.
pub(super) fn bit_error_rate(energy: f64) -> f64 {
    -expm1(log1p(-symbol_error_rate(energy)) / BITS)
}

/// The chance that one of eight biorthogonal signals is taken for another, at ratio `energy` of its energy to the noise's density:
/// P = 1 − ∫_{−β}^∞ (2Φ(x + β) − 1)⁷ φ(x) dx, β = √(2 energy) (Proakis, *Digital Communications*, biorthogonal signals).
///
/// Computed as Φ(−β) + ∫_{−β}^∞ (1 − (2Φ(x + β) − 1)⁷) φ(x) dx, which loses no digits where P is small.
fn symbol_error_rate(energy: f64) -> f64 {
    let beta = sqrt(2.0 * energy);
    let from = (-beta).max(-FARTHEST);
    let half = (FARTHEST - from) / f64::from(2 * PANELS);
    let mut sum = upper_tail(beta);
    for panel in 0..PANELS {
        let middle = from + f64::from(2 * panel + 1) * half;
        for (point, weight) in RULE {
            let noise = middle + half * point;
            let density = exp(-noise * noise / 2.0) / sqrt(2.0 * PI);
            let any_other = -expm1(7.0 * log1p(-2.0 * upper_tail(noise + beta)));
            sum += half * weight * density * any_other;
        }
    }
    sum
}

/// 1 − Φ(x).
fn upper_tail(x: f64) -> f64 {
    erfc(x * FRAC_1_SQRT_2) / 2.0
}
