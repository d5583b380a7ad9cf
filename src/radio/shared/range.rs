//! From which mean power on two robots count as in range, and from which on one may hear the other at all.

use super::receiver::{Tables, ratio};
use crate::radio::propagation::FadingConfig;
use crate::radio::technology::Phy;

/// Least and greatest level over the noise between which the threshold is looked for, dB, and how finely.
const SEARCHED_DB: [f64; 2] = [-60.0, 120.0];
const FINE_DB: f64 = 1e-6;

/// The mean power at which a lone frame with so much payload comes through with a `probability` over fading, dBm. Where there is no noise a
/// frame comes through at the sensitivity or above.
pub(super) fn threshold_dbm(phy: &Phy, fading: &FadingConfig, payload: u32, probability: f64) -> f64 {
    let quiet = phy.noise == f64::NEG_INFINITY;
    // A level over the noise, or over the sensitivity where there is none.
    let over = if quiet { phy.sensitivity } else { phy.noise };
    if quiet && *fading == FadingConfig::None {
        return over;
    }
    let tables = Tables::of(phy);
    let frame = phy.frame(payload);
    let lock = if phy.capture.is_none() { ratio(phy.lock) } else { 0.0 };
    let success = |level: f64| {
        if quiet {
            return f64::from(u8::from(level >= 1.0));
        }
        let survival = frame
            .sections()
            .map(|section| f64::from(section.bits) * tables.log_survival(section.modulation, level));
        if level > lock { libm::exp(survival.sum()) } else { 0.0 }
    };
    let suffices = |db: f64| {
        let mean = ratio(db);
        fading.mean_of(|gain| success(mean * gain)) >= probability
    };
    let [mut low, mut high] = SEARCHED_DB;
    while high - low > FINE_DB {
        let middle = f64::midpoint(low, high);
        if suffices(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    over + high
}
