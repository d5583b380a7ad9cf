//! Thermal noise.

use libm::log10;

/// Boltzmann's constant, J/K (exact).
const BOLTZMANN: f64 = 1.380_649e-23;
/// The temperature at which noise figures are defined, K.
const REFERENCE_K: f64 = 290.0;

/// What a receiver of so many Hz adds to a signal, in dBm: kTB at 290 K and its noise figure in dB.
pub(super) fn thermal_dbm(bandwidth: f64, noise_figure: f64) -> f64 {
    10.0 * log10(1000.0 * BOLTZMANN * REFERENCE_K * bandwidth) + noise_figure
}
