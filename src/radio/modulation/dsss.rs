//! Direct sequence spread spectrum of IEEE 802.11: 1 and 2 Mb/s in 22 MHz.

use std::f64::consts::{PI, SQRT_2};

use libm::{exp, sqrt};

/// Bandwidth over bit rate at 1 Mb/s: by so much is the energy of a bit over the noise's density above the ratio in the band.
const SPREAD: f64 = 22.0;

/// DBPSK at 1 Mb/s: ½ exp(−Eb/N0), Eb/N0 = 22 s.
pub(super) fn dbpsk(snr: f64) -> f64 {
    exp(-SPREAD * snr) / 2.0
}

/// DQPSK at 2 Mb/s: ((√2 + 1)/√(8π√2)) E^(−½) exp(−(2 − √2) E), E = Eb/N0 = 11 s, the approximation for high ratios that ns-3 has as well. Beyond any limit as
/// E goes to 0.
pub(super) fn dqpsk(snr: f64) -> f64 {
    let ratio = SPREAD / 2.0 * snr;
    (SQRT_2 + 1.0) / sqrt(8.0 * PI * SQRT_2) / sqrt(ratio) * exp(-(2.0 - SQRT_2) * ratio)
}
