//! Path loss: what distance alone takes off, in dB.

mod config;
mod line;
#[cfg(test)]
mod tests;
mod two_ray;

pub use config::{BreakPointConfig, LogDistanceConfig, PathLossConfig, TwoRayConfig};

use std::f64::consts::PI;

use self::line::Line;
use self::two_ray::TwoRay;
use super::LIGHT;

/// Path loss at one frequency.
#[derive(Clone, Debug)]
pub struct PathLoss {
    model: Model,
}

#[derive(Clone, Debug)]
enum Model {
    /// Straight lines over the logarithm of distance, nearest first: each holds from its distance on, the first one from 0 on. Losses rise throughout.
    Lines(Vec<Line>),
    /// The sum of a direct and a reflected wave, which does not.
    TwoRay(TwoRay),
}

impl PathLoss {
    /// The path loss that `config` describes, for a carrier of so many Hz.
    #[must_use]
    pub fn new(config: &PathLossConfig, frequency_hz: f64) -> Self {
        let wavelength = LIGHT / frequency_hz;
        let model = match config {
            PathLossConfig::Friis => Model::Lines(vec![Line::friis(wavelength)]),
            PathLossConfig::LogDistance(config) => Model::Lines(vec![config.line(wavelength)]),
            PathLossConfig::BreakPoint(config) => {
                let near = config.near(wavelength);
                Model::Lines(vec![
                    near,
                    near.turned(config.distance.get(), config.exponent_beyond.get()),
                ])
            }
            PathLossConfig::TwoRay(TwoRayConfig { height, ground: None }) => {
                let near = Line::friis(wavelength);
                let height = height.get();
                Model::Lines(vec![near, near.turned(4.0 * PI * height * height / wavelength, 4.0)])
            }
            PathLossConfig::TwoRay(TwoRayConfig {
                height,
                ground: Some(permittivity),
            }) => Model::TwoRay(TwoRay::new(wavelength, height.get(), permittivity.get())),
        };
        Self { model }
    }

    /// The loss in dB over `distance_m` metres, at least 0: near a sender the formulas promise more than was sent.
    #[must_use]
    pub fn loss_db(&self, distance_m: f64) -> f64 {
        let loss = match &self.model {
            Model::Lines(lines) => Line::at(lines, distance_m).loss(distance_m),
            Model::TwoRay(rays) => rays.loss(distance_m),
        };
        loss.max(0.0)
    }

    /// The largest distance in metres over which no more than `loss_db` dB are lost; 0 where `loss_db` is negative, and infinite where it is.
    ///
    /// Over a reflecting ground losses do not rise throughout: nearer than that, more may be lost. The distance is then looked for in steps of a tenth of a percent at most.
    #[must_use]
    pub fn distance_at(&self, loss_db: f64) -> f64 {
        if loss_db < 0.0 {
            return 0.0;
        }
        match &self.model {
            Model::Lines(lines) => {
                let reaches = |line: &&Line| line.loss <= loss_db;
                let line = lines.iter().rev().find(reaches).unwrap_or(&lines[0]);
                line.distance_at(loss_db)
            }
            Model::TwoRay(rays) => rays.distance_at(loss_db),
        }
    }
}
