//! From which mean power on two robots count as in range.

use crate::radio::propagation::FadingConfig;
use crate::radio::technology::Phy;

/// Least and greatest level over the noise between which the threshold is looked for, dB.
const SEARCHED_DB: [f64; 2] = [-60.0, 120.0];

/// The mean power at which a lone frame with so much payload comes through with a probability of one half over fading, dBm. Where nothing goes wrong
/// but by a level below the sensitivity, that is the sensitivity itself, as far as fading lets it.
pub(super) fn threshold_dbm(phy: &Phy, fading: &FadingConfig, payload: u32) -> f64 {
    let quiet = phy.noise == f64::NEG_INFINITY;
    // A level over the noise, or over the sensitivity where there is none.
    let over = if quiet { phy.sensitivity } else { phy.noise };
    let success = |ratio: f64| {
        if quiet {
            return f64::from(ratio >= 1.0);
        }
        let sections = phy.sections(payload);
        let survival = sections.map(|section| f64::from(section.bits) * section.modulation.log_survival(ratio));
        let notices = phy.capture.is_some() || ratio > super::receiver::ratio(phy.lock);
        if notices { libm::exp(survival.sum()) } else { 0.0 }
    };
    let half = |db: f64| {
        let mean = super::receiver::ratio(db);
        fading.mean_of(|gain| success(mean * gain)) >= 0.5
    };
    if *fading == FadingConfig::None && quiet {
        return over;
    }
    let [mut low, mut high] = SEARCHED_DB;
    while high - low > 1e-9 {
        let middle = f64::midpoint(low, high);
        if half(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    over + high
}
