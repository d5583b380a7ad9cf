//! O-QPSK of IEEE 802.15.4 at 2.4 GHz.

use libm::exp;

/// Symbols, each of four bits.
const SYMBOLS: u32 = 16;

/// BER = (8/15)(1/16) Σ (−1)^k C(16, k) exp(20 s (1/k − 1)), k = 2 to 16 (IEEE 802.15.4-2011, Annex E): the symbol error rate of sixteen orthogonal signals that
/// are detected without a carrier's phase, at Es/N0 = 20 s, times the 8/15 of its bits that are wrong in a wrong symbol.
pub(super) fn bit_error_rate(snr: f64) -> f64 {
    let mut choose = f64::from(SYMBOLS);
    let mut sum = 0.0;
    for k in 2..=SYMBOLS {
        choose *= f64::from(SYMBOLS + 1 - k) / f64::from(k);
        let term = choose * exp(20.0 * snr * (1.0 / f64::from(k) - 1.0));
        sum += if k % 2 == 0 { term } else { -term };
    }
    8.0 / 15.0 / f64::from(SYMBOLS) * sum
}
