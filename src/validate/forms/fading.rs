//! Fading: outages, crossings, and what they do to frames and degrees.

use std::f64::consts::{PI, TAU};

use statrs::function::gamma::{gamma, gamma_lr};

use super::special::{i0, integral, kummer, marcum_below};

/// A law of power gains with mean 1.
#[derive(Clone, Copy, Debug)]
pub enum Law {
    Rayleigh,
    /// With its ratio of direct to scattered power.
    Rician(f64),
    /// With its shape.
    Nakagami(f64),
}

impl Law {
    /// P(gain < x).
    pub fn outage(self, x: f64) -> f64 {
        match self {
            Self::Rayleigh => 1.0 - (-x).exp(),
            Self::Rician(k) => marcum_below((2.0 * k).sqrt(), (2.0 * (k + 1.0) * x).sqrt()),
            Self::Nakagami(m) => gamma_lr(m, m * x),
        }
    }

    /// How often a second the amplitude falls through `rho` of its root mean square, where f is the largest Doppler shift, Hz.
    pub fn crossings(self, rho: f64, f: f64) -> f64 {
        let square = rho * rho;
        match self {
            Self::Rayleigh => TAU.sqrt() * f * rho * (-square).exp(),
            Self::Rician(k) => {
                let bessel = i0(2.0 * rho * (k * (k + 1.0)).sqrt());
                (TAU * (k + 1.0)).sqrt() * f * rho * (-k - (k + 1.0) * square).exp() * bessel
            }
            Self::Nakagami(m) => {
                TAU.sqrt() * f * m.powf(m - 0.5) * rho.powf(2.0 * m - 1.0) * (-m * square).exp() / gamma(m)
            }
        }
    }

    /// E(gain^(2/n)): by how much it changes mean degrees where power falls with distance to the n.
    pub fn degree(self, n: f64) -> f64 {
        let a = 2.0 / n;
        match self {
            Self::Rayleigh => gamma(1.0 + a),
            Self::Rician(k) => gamma(1.0 + a) * (1.0 + k).powf(-a) * kummer(-a, 1.0, -k),
            Self::Nakagami(m) => gamma(m + a) / (gamma(m) * m.powf(a)),
        }
    }
}

/// The share of frames lost where each has an exponential gain of its own: ∫ loss(mean · g) e^(−g) dg.
pub fn block_rayleigh(mean: f64, loss: impl Fn(f64) -> f64) -> f64 {
    integral(0.0, 1.0, 4000, |g| loss(mean * g) * (-g).exp())
        + integral(1.0, 40.0, 20_000, |g| loss(mean * g) * (-g).exp())
}

/// 20 log₁₀(4πd/λ): free space, dB, at `frequency` Hz.
pub fn friis(distance: f64, frequency: f64) -> f64 {
    20.0 * (4.0 * PI * distance * frequency / 299_792_458.0).log10()
}

/// The sum of the direct wave and of the one that ground of relative permittivity `ground` reflects, vertical antennas at `height`, dB.
pub fn two_rays(distance: f64, frequency: f64, height: f64, ground: f64) -> f64 {
    let wavelength = 299_792_458.0 / frequency;
    let reflected = distance.hypot(2.0 * height);
    let sine = 2.0 * height / reflected;
    let z = (ground - (1.0 - sine * sine)).sqrt() / ground;
    let reflection = (sine - z) / (sine + z);
    let phase = TAU * (reflected - distance) / wavelength;
    let real = 1.0 / distance + reflection * phase.cos() / reflected;
    let imaginary = reflection * phase.sin() / reflected;
    -20.0 * (wavelength / (4.0 * PI) * real.hypot(imaginary)).log10()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Figures of an independent program (scipy).
    #[test]
    fn forms_have_the_figures_of_another_program() {
        let near = |found: f64, known: f64| assert!((found / known - 1.0).abs() < 1e-3, "{found} for {known}");
        near(Law::Rayleigh.outage(0.1), 0.09516);
        near(Law::Rician(4.0).outage(0.1), 0.01630);
        near(Law::Nakagami(3.0).outage(0.1), 0.003_599);
        near(Law::Rayleigh.crossings(0.3, 20.0), 13.745);
        near(Law::Rayleigh.degree(3.0), 0.902_745);
        near(Law::Rician(4.0).degree(3.0), 0.959_133);
        near(Law::Nakagami(3.0).degree(3.0), 0.964_433);
        near(friis(1.0, 2.44e9), 40.20);
        let loss = |snr: f64| super::super::errors::frame(super::super::errors::o_qpsk(snr), 296);
        near(block_rayleigh(10.0, loss), 0.0712);
    }
}
