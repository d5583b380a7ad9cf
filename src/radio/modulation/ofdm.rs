//! OFDM of IEEE 802.11g in 20 MHz, by the NIST model (Pei and Henderson, *Validation of OFDM error rate model in ns-3*, 2010).

use libm::{erfc, sqrt};

/// How bits are laid onto a carrier.
#[derive(Clone, Copy)]
pub(super) enum Constellation {
    Bpsk,
    Qpsk,
    Qam16,
    Qam64,
}

/// The rate of the convolutional code of constraint length 7 that 802.11 uses, punctured or not.
#[derive(Clone, Copy)]
pub(super) enum Code {
    Half,
    TwoThirds,
    ThreeQuarters,
}

/// A code's first distances: the least one, the step from one to the next, how many bits all paths of each distance get wrong, and the input bits of a
/// period, by which the sum is divided.
struct Spectrum {
    least: i32,
    step: i32,
    bits: &'static [f64],
    period: f64,
}

const HALF: Spectrum = Spectrum {
    least: 10,
    step: 2,
    bits: &[
        36.0,
        211.0,
        1404.0,
        11_633.0,
        77_433.0,
        502_690.0,
        3_322_763.0,
        21_292_910.0,
        134_365_911.0,
    ],
    period: 1.0,
};

const TWO_THIRDS: Spectrum = Spectrum {
    least: 6,
    step: 1,
    bits: &[
        3.0,
        70.0,
        285.0,
        1276.0,
        6160.0,
        27_128.0,
        117_019.0,
        498_860.0,
        2_103_891.0,
        8_784_123.0,
    ],
    period: 2.0,
};

const THREE_QUARTERS: Spectrum = Spectrum {
    least: 5,
    step: 1,
    bits: &[
        42.0,
        201.0,
        1492.0,
        10_469.0,
        62_935.0,
        379_644.0,
        2_253_373.0,
        13_073_811.0,
        75_152_755.0,
        428_005_675.0,
    ],
    period: 3.0,
};

/// The error rate of decoded bits: the union bound (1/2b) Σ a_d D^d over the code's distances, D = √(4p(1 − p)), p the error rate before decoding. Beyond 1
/// at low ratios, where the bound says nothing.
pub(super) fn bit_error_rate(constellation: Constellation, code: Code, snr: f64) -> f64 {
    let spectrum = match code {
        Code::Half => HALF,
        Code::TwoThirds => TWO_THIRDS,
        Code::ThreeQuarters => THREE_QUARTERS,
    };
    let raw = uncoded(constellation, snr);
    let distance = sqrt(4.0 * raw * (1.0 - raw));
    let step = power(distance, spectrum.step);
    let mut term = power(distance, spectrum.least);
    let mut sum = 0.0;
    for bits in spectrum.bits {
        sum += bits * term;
        term *= step;
    }
    sum / (2.0 * spectrum.period)
}

/// The error rate of bits before decoding, at ratio `snr` of a symbol.
fn uncoded(constellation: Constellation, snr: f64) -> f64 {
    match constellation {
        Constellation::Bpsk => erfc(sqrt(snr)) / 2.0,
        Constellation::Qpsk => erfc(sqrt(snr / 2.0)) / 2.0,
        Constellation::Qam16 => 0.375 * erfc(sqrt(snr / 10.0)),
        Constellation::Qam64 => 7.0 / 24.0 * erfc(sqrt(snr / 42.0)),
    }
}

/// `base` to the power of `exponent` by multiplication, in one order.
fn power(base: f64, exponent: i32) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}
