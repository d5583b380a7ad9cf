//! Bit error rates as textbooks and standards have them.

use std::f64::consts::PI;

use statrs::function::erf::erfc;

use super::special::{integral, normal, ratio, root};

/// Non-coherent detection of 16 orthogonal symbols, Es/N0 = 20 · ratio (IEEE 802.15.4, Annex E): (8/15)(1/16) Σ (−1)^k C(16, k) exp(20 SNR (1/k − 1)), k = 2…16.
pub fn o_qpsk(snr: f64) -> f64 {
    let mut binomial = 16.0;
    let mut sum = 0.0;
    for k in 2..=16 {
        let k = f64::from(k);
        binomial *= (17.0 - k) / k;
        let sign = if k % 2.0 == 0.0 { 1.0 } else { -1.0 };
        sum += sign * binomial * (20.0 * snr * (1.0 / k - 1.0)).exp();
    }
    8.0 / 15.0 / 16.0 * sum
}

/// DBPSK of 1 Mb/s in 22 MHz: ½ e^(−Eb/N0).
pub fn dsss1(snr: f64) -> f64 {
    0.5 * (-22.0 * snr).exp()
}

/// DQPSK of 2 Mb/s in 22 MHz, E = Eb/N0: (√2 + 1)/√(8π√2) E^(−½) e^(−(2 − √2)E), the usual approximation.
pub fn dsss2(snr: f64) -> f64 {
    let root2 = 2.0_f64.sqrt();
    let e = 11.0 * snr;
    (root2 + 1.0) / (8.0 * PI * root2).sqrt() / e.sqrt() * (-(2.0 - root2) * e).exp()
}

/// The chance that one of eight biorthogonal pairs of energy `e` is taken for another: 1 − ∫ (2Φ(x + β) − 1)⁷ φ(x) dx from −β on, β = √(2e).
fn biorthogonal(e: f64) -> f64 {
    let beta = (2.0 * e).sqrt();
    let right = |x: f64| (2.0 * normal(x + beta) - 1.0).powi(7) * (-x * x / 2.0).exp() / (2.0 * PI).sqrt();
    1.0 - integral(-beta, 12.0, 4000, right)
}

/// The rate of independent errors that leaves as many blocks of four bits whole.
fn of_four(block: f64) -> f64 {
    1.0 - (1.0 - block).powf(0.25)
}

/// CCK of 5.5 Mb/s in 22 MHz.
pub fn cck5(snr: f64) -> f64 {
    of_four(biorthogonal(8.0 * snr))
}

/// CCK of 11 Mb/s in 22 MHz.
pub fn cck11(snr: f64) -> f64 {
    of_four(biorthogonal(4.0 * snr))
}

/// Non-coherent detection of two tones: ½ e^(−Eb/2N0).
pub fn gfsk(snr: f64) -> f64 {
    0.5 * (-snr / 2.0).exp()
}

/// Distance profiles of the code of 802.11, rates ½, ⅔ and ¾: free distance, step, weights of errors, bits a step.
struct Code {
    free: i32,
    step: i32,
    weights: &'static [f64],
    bits: f64,
}

const HALF: Code = Code {
    free: 10,
    step: 2,
    weights: &[
        36.0,
        211.0,
        1404.0,
        11633.0,
        77433.0,
        502_690.0,
        3_322_763.0,
        21_292_910.0,
        134_365_911.0,
    ],
    bits: 1.0,
};
const TWO_THIRDS: Code = Code {
    free: 6,
    step: 1,
    weights: &[
        3.0,
        70.0,
        285.0,
        1276.0,
        6160.0,
        27128.0,
        117_019.0,
        498_860.0,
        2_103_891.0,
        8_784_123.0,
    ],
    bits: 2.0,
};
const THREE_QUARTERS: Code = Code {
    free: 5,
    step: 1,
    weights: &[
        42.0,
        201.0,
        1492.0,
        10469.0,
        62935.0,
        379_644.0,
        2_253_373.0,
        13_073_811.0,
        75_152_755.0,
        428_005_675.0,
    ],
    bits: 3.0,
};

/// The union bound behind a hard decision of which a share `p` is wrong: Σ a_d D^d/2b, D = √(4p(1 − p)).
fn coded(code: &Code, p: f64) -> f64 {
    let bhattacharyya = (4.0 * p * (1.0 - p)).sqrt();
    let powers = (0..).map(|place| code.free + code.step * place);
    let sum: f64 = powers
        .zip(code.weights)
        .map(|(power, weight)| weight * bhattacharyya.powi(power))
        .sum();
    (sum / (2.0 * code.bits)).min(0.5)
}

/// OFDM of 802.11g at so many Mb/s, ratio s in 20 MHz: ½ erfc √s, ½ erfc √(s/2), ⅜ erfc √(s/10), 7/24 erfc √(s/42) before the code.
pub fn ofdm(rate: u32, s: f64) -> f64 {
    let bpsk = 0.5 * erfc(s.sqrt());
    let qpsk = 0.5 * erfc((s / 2.0).sqrt());
    let qam16 = 0.375 * erfc((s / 10.0).sqrt());
    let qam64 = 7.0 / 24.0 * erfc((s / 42.0).sqrt());
    match rate {
        6 => coded(&HALF, bpsk),
        9 => coded(&THREE_QUARTERS, bpsk),
        12 => coded(&HALF, qpsk),
        18 => coded(&THREE_QUARTERS, qpsk),
        24 => coded(&HALF, qam16),
        36 => coded(&THREE_QUARTERS, qam16),
        48 => coded(&TWO_THIRDS, qam64),
        _ => coded(&THREE_QUARTERS, qam64),
    }
}

/// The chance that at least one of so many bits goes wrong, each with `error`.
pub fn frame(error: f64, bits: u32) -> f64 {
    1.0 - (1.0 - error).powi(bits.cast_signed())
}

/// The ratio in dB at which frames of so many bits are lost with the chance `loss`.
pub fn needed_db(bit_error: impl Fn(f64) -> f64, bits: u32, loss: f64) -> f64 {
    root(-20.0, 40.0, |db| frame(bit_error(ratio(db)), bits) - loss)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Figures of an independent program (scipy), some of them held against ns-3 as well.
    #[test]
    fn forms_have_the_figures_of_another_program() {
        let near = |found: f64, known: f64, of: f64| assert!((found / known - 1.0).abs() < of, "{found} for {known}");
        near(o_qpsk(ratio(-2.0)), 5.20e-3, 1e-3);
        near(o_qpsk(1.0), 1.615e-4, 1e-3);
        near(needed_db(o_qpsk, 208, 0.01), 0.509, 1e-3);
        let at_1024 = |bit_error: fn(f64) -> f64| needed_db(bit_error, 8192, 0.08);
        for (found, known) in [
            (at_1024(dsss1), -3.09),
            (at_1024(dsss2), 1.55),
            (at_1024(cck5), 4.08),
            (at_1024(cck11), 7.09),
        ] {
            assert!((found - known).abs() < 0.006, "{found} for {known}");
        }
        for (rate, known) in [
            (6, 3.85),
            (9, 6.73),
            (12, 6.86),
            (18, 9.74),
            (24, 13.38),
            (36, 16.48),
            (48, 21.23),
            (54, 22.49),
        ] {
            let found = needed_db(|s| ofdm(rate, s), 8000, 0.1);
            assert!((found - known).abs() < 0.006, "{rate} Mb/s: {found} for {known}");
        }
    }
}
