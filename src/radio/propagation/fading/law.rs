//! How gains are distributed.

use libm::{exp, lgamma, log, sqrt};

use super::config::FadingConfig;
use crate::radio::propagation::gamma::{below_and_above, density_of_log};

/// Steps of a mean over gains, all as wide by their logarithm.
const STEPS: u32 = 2048;
/// Where the density of the logarithm is too small to count.
const NEGLIGIBLE: f64 = 1e-14;
/// Where a term of a sum is too small to count, as a share of it.
const NEGLIGIBLE_TERM: f64 = 1e-17;
/// By how much the ends of the range of gains are moved outwards until they are out of it.
const OUTWARDS: f64 = 1.25;

impl FadingConfig {
    /// The chance that the power gain is below `x`, to a relative error of 1e-9. Rayleigh: 1 − exp(−x). Rician: 1 − Q1(√(2K), √(2(K + 1)x)). Nakagami: P(m, mx).
    #[must_use]
    pub fn outage(&self, x: f64) -> f64 {
        if x <= 0.0 {
            return 0.0;
        }
        match *self {
            Self::None => f64::from(u8::from(x > 1.0)),
            Self::Rayleigh { .. } => -libm::expm1(-x),
            Self::Rician { k, .. } => rician_below(k.get(), x),
            Self::Nakagami { m, .. } => below_and_above(m.get(), m.get() * x)[0],
        }
    }

    /// The mean of `value` over all gains, which `value` is handed: of what a frame's chance is, say, at the ratio that a gain leaves. By the midpoints of 2048 steps of the gain's logarithm: exact to some 1e-9 where
    /// `value` is smooth over a tenth of a dB; where it jumps, half a step's share of gains is in doubt, at most 0.005.
    pub fn mean_of(&self, value: impl Fn(f64) -> f64) -> f64 {
        mean(&self.gains(), value)
    }

    /// Gains that stand for all, with their weights: what [`mean_of`](Self::mean_of) goes through.
    pub(in crate::radio) fn gains(&self) -> Vec<[f64; 2]> {
        if *self == Self::None {
            return vec![[1.0; 2]];
        }
        let [mut least, mut most] = [1.0; 2];
        while self.density_of_log(least) > NEGLIGIBLE {
            least /= OUTWARDS;
        }
        while self.density_of_log(most) > NEGLIGIBLE {
            most *= OUTWARDS;
        }
        let (start, width) = (log(least), log(most / least) / f64::from(STEPS));
        let gain = |step: u32| exp(start + (f64::from(step) + 0.5) * width);
        (0..STEPS)
            .map(gain)
            .map(|gain| [gain, self.density_of_log(gain)])
            .collect()
    }

    /// The density of the gain's logarithm where the gain is `x` > 0.
    fn density_of_log(&self, x: f64) -> f64 {
        match *self {
            Self::None => 0.0,
            Self::Rayleigh { .. } => density_of_log(1.0, x),
            Self::Rician { k, .. } => rician_density_of_log(k.get(), x),
            Self::Nakagami { m, .. } => density_of_log(m.get(), m.get() * x),
        }
    }
}

/// The mean of `value` over gains with weights.
pub(in crate::radio) fn mean(gains: &[[f64; 2]], value: impl Fn(f64) -> f64) -> f64 {
    let [mut sum, mut weights] = [0.0; 2];
    for &[gain, weight] in gains {
        sum += weight * value(gain);
        weights += weight;
    }
    sum / weights
}

/// Given a Poisson variate N of mean K, the gain times K + 1 is a gamma variate of shape N + 1; and that is below y where a Poisson variate of mean y is above N. So this is Σ over i of the chance that the latter is i and the former
/// below i: terms that are all positive, so that small chances keep their digits.
fn rician_below(k: f64, x: f64) -> f64 {
    let y = (k + 1.0) * x;
    // A Poisson variate of mean y is above this.
    if y - 12.0 * sqrt(y) - 30.0 > f64::from(reach(k)) {
        return 1.0;
    }
    let last = reach(k).max(reach(y));
    let [mut sum, mut below] = [0.0; 2];
    for i in 1..=last {
        below += poisson(k, i - 1);
        sum += poisson(y, i) * below;
    }
    sum.min(1.0)
}

/// x times Σ over n of the chance of n and the density of a gamma variate of shape n + 1: y exp(−K − y) Σ (Ky)^n / n!², from the largest term on in both directions.
fn rician_density_of_log(k: f64, x: f64) -> f64 {
    let y = (k + 1.0) * x;
    let largest = sqrt(k * y) as u32;
    let start = poisson(k, largest) * poisson(y, largest);
    let mut sum = start;
    let mut term = start;
    for n in (largest + 1..).map(f64::from) {
        term *= k * y / (n * n);
        sum += term;
        if term <= sum * NEGLIGIBLE_TERM {
            break;
        }
    }
    term = start;
    for n in (1..=largest).rev().map(f64::from) {
        term *= n * n / (k * y);
        sum += term;
    }
    y * sum
}

/// A Poisson variate of so great a mean is never above this.
fn reach(mean: f64) -> u32 {
    (mean + 12.0 * sqrt(mean) + 30.0) as u32
}

/// The chance that a Poisson variate of such a `mean` is `n`.
fn poisson(mean: f64, n: u32) -> f64 {
    let n = f64::from(n);
    if mean == 0.0 {
        return f64::from(u8::from(n == 0.0));
    }
    exp(n * log(mean) - mean - lgamma(n + 1.0))
}
