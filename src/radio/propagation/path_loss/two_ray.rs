//! The exact sum of a direct wave and one that flat ground reflects.

use std::f64::consts::{PI, TAU};

use libm::{cos, hypot, log10, pow, sin, sqrt};

/// Distances that a search tries are a thousandth apart, or a fiftieth of the narrowest fringe.
const STEP: f64 = 1e-3;
const STEPS_OF_A_FRINGE: f64 = 50.0;
/// Nearer than this share of a wavelength no search goes.
const NEAREST: f64 = 0.01;

/// Two vertical antennas at the same height.
#[derive(Clone, Debug)]
pub(super) struct TwoRay {
    wavelength: f64,
    height: f64,
    permittivity: f64,
}

impl TwoRay {
    pub fn new(wavelength: f64, height: f64, permittivity: f64) -> Self {
        Self {
            wavelength,
            height,
            permittivity,
        }
    }

    /// −20 log₁₀(λ/4π · |exp(−jkd)/d + Γ exp(−jkr)/r|) dB, with r the way by the ground and Γ = (sin θ − z)/(sin θ + z), z = √(ε − cos² θ)/ε, Fresnel's coefficient for vertical polarisation, θ the angle between that way
    /// and the ground (Rappaport, *Wireless Communications*, sections 4.5 and 4.6).
    pub fn loss(&self, distance: f64) -> f64 {
        let reflected = hypot(distance, 2.0 * self.height);
        let rise = 2.0 * self.height / reflected;
        let impedance = sqrt(self.permittivity - (1.0 - rise * rise)) / self.permittivity;
        let coefficient = (rise - impedance) / (rise + impedance);
        // How far the reflected wave is behind, without the digits that r − d would lose.
        let behind = 4.0 * self.height * self.height / (reflected + distance);
        let angle = TAU * behind / self.wavelength;
        let [direct, other] = [1.0 / distance, coefficient / reflected];
        let amplitude = hypot(direct + other * cos(angle), other * sin(angle));
        -20.0 * log10(self.wavelength / (4.0 * PI) * amplitude)
    }

    /// The largest distance with at most so much loss. The sum of both waves is at most twice the direct one, so none is beyond 6.02 dB more in free space: from there the search comes nearer, to the first
    /// distance that is near enough.
    pub fn distance_at(&self, loss: f64) -> f64 {
        let mut far = 2.0 * self.wavelength / (4.0 * PI) * pow(10.0, loss / 20.0);
        if !far.is_finite() {
            return far;
        }
        let fringe = self.wavelength / (2.0 * self.height) / STEPS_OF_A_FRINGE;
        let nearer = 1.0 - fringe.min(STEP);
        let mut near = far * nearer;
        while self.loss(near) > loss {
            if near < NEAREST * self.wavelength {
                return 0.0;
            }
            (far, near) = (near, near * nearer);
        }
        for _ in 0..60 {
            let middle = f64::midpoint(near, far);
            if self.loss(middle) > loss {
                far = middle;
            } else {
                near = middle;
            }
        }
        near
    }
}
