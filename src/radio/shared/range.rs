//! From which mean power on two robots count as in range, and from which on one may hear the other at all.

use super::receiver::{Tables, ratio};
use crate::radio::memo::Memo;
use crate::radio::propagation::{FadingConfig, mean};
use crate::radio::technology::Phy;

/// Least and greatest level over the noise between which the threshold is looked for, dB, and how finely.
const SEARCHED_DB: [f64; 2] = [-60.0, 120.0];
const FINE_DB: f64 = 1e-6;

/// The share of lone frames that come through between robots that count as in range, and the least that is worth a thought.
const IN_RANGE: f64 = 0.5;
const FAINTEST: f64 = 0.01;

/// Mean powers over fading, dBm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Levels {
    /// At which a lone frame comes through half of the time.
    pub in_range: f64,
    /// At which one in a hundred does.
    pub faintest: f64,
}

/// Those of all radios of the process.
static KNOWN: Memo<(Phy, FadingConfig, u32), Levels> = Memo::new();

/// The levels of a lone frame with so much payload. Where there is no noise a frame comes through at the sensitivity or above.
pub(super) fn levels(phy: &Phy, fading: &FadingConfig, payload: u32) -> Levels {
    KNOWN.get((phy.clone(), *fading, payload), |(phy, fading, payload)| {
        let gains = fading.gains();
        let level = |probability| level_dbm(phy, &gains, *payload, probability);
        Levels {
            in_range: level(IN_RANGE),
            faintest: level(FAINTEST),
        }
    })
}

/// The mean power at which a lone frame comes through with a probability over `gains`, dBm.
fn level_dbm(phy: &Phy, gains: &[[f64; 2]], payload: u32, probability: f64) -> f64 {
    let quiet = phy.noise == f64::NEG_INFINITY;
    // A level over the noise, or over the sensitivity where there is none.
    let over = if quiet { phy.sensitivity } else { phy.noise };
    if quiet && gains.len() == 1 {
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
        let level = ratio(db);
        mean(gains, |gain| success(level * gain)) >= probability
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
