//! Loss as a straight line over the logarithm of distance.

use std::f64::consts::PI;

use libm::{log10, pow};

/// A loss of `loss` dB at `distance` metres, and 10 · `exponent` dB more each time that the distance is tenfold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub distance: f64,
    pub loss: f64,
    pub exponent: f64,
}

impl Line {
    /// Free space: 20 log₁₀(4πd/λ).
    pub fn friis(wavelength: f64) -> Self {
        Self {
            distance: wavelength / (4.0 * PI),
            loss: 0.0,
            exponent: 2.0,
        }
    }

    /// The line that goes on from this one at `distance` with another exponent.
    pub fn turned(self, distance: f64, exponent: f64) -> Self {
        Self {
            distance,
            loss: self.loss(distance),
            exponent,
        }
    }

    /// The one of `lines` that holds at `distance`.
    pub fn at(lines: &[Self], distance: f64) -> &Self {
        let holds = |line: &&Self| line.distance <= distance;
        lines.iter().rev().find(holds).unwrap_or(&lines[0])
    }

    pub fn loss(self, distance: f64) -> f64 {
        self.loss + 10.0 * self.exponent * log10(distance / self.distance)
    }

    pub fn distance_at(self, loss: f64) -> f64 {
        self.distance * pow(10.0, (loss - self.loss) / (10.0 * self.exponent))
    }
}
