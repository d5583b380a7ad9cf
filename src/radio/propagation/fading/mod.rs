//! Fading as fields over places.

mod config;
mod law;
mod shape;
#[cfg(test)]
mod tests;

pub use config::FadingConfig;
pub(in crate::radio) use law::mean;

use std::f64::consts::TAU;

use libm::{cos, sin, sqrt};

use self::shape::Reshaping;
use super::LIGHT;
use super::waves::{EachWave, WAVES, Waves, nearest};
use crate::engine::{KeyedStreams, Purpose, Streams};
use crate::geometry::Vec2;

/// The streams of each wave of fading: its direction and phase, and how it drifts.
const FADING: Purpose = Purpose::new("radio.fading");
const DRIFT: Purpose = Purpose::new("radio.fading.drift");
/// Squares of normal fields that Nakagami fading is made of at most.
const MOST_SQUARES: f64 = 8.0;

/// The fading of one trial.
///
/// Waves come from all around: h = M^(−½) Σ exp j(2π/λ(a · u + b · v) + φ) with random directions u and v at either end, so that the autocorrelation of h is J0(2πf₁τ) J0(2πf₂τ) where the ends go at f₁λ and f₂λ (Akki and Haber,
/// *A statistical model of mobile-to-mobile land communication channel*, 1986). The gain is |h|²; with Rician fading h has a constant part beside.
///
/// M is 32: a gain is then a little less often near 0 than theory has it, below 0.1 in 9.4 % of places rather than 9.5.
#[derive(Debug)]
pub struct Fading {
    /// Normal fields in pairs. None where there is no fading.
    fields: Vec<Field>,
    /// Whether only one of the last pair counts.
    odd: bool,
    /// Amplitude of the direct way.
    direct: f64,
    /// Amplitude of each wave.
    scattered: f64,
    reshaping: Option<Reshaping>,
    drifts: bool,
}

/// A complex normal field.
#[derive(Debug)]
struct Field {
    waves: Waves,
    /// How fast the phase of each wave changes where both ends stand, turns a second.
    drift: EachWave<f64>,
}

impl Fading {
    /// The fading that `config` describes for a carrier of so many Hz, drawn from the `streams` of a trial.
    #[must_use]
    pub fn new(config: &FadingConfig, streams: &Streams, frequency_hz: f64) -> Self {
        let (squares, shape, k) = match *config {
            FadingConfig::None => (0.0, 1.0, 0.0),
            FadingConfig::Rayleigh { .. } => (2.0, 1.0, 0.0),
            FadingConfig::Rician { k, .. } => (2.0, 1.0, k.get()),
            FadingConfig::Nakagami { m, .. } => {
                let squares = nearest(2.0 * m.get()).clamp(1.0, MOST_SQUARES);
                (squares, m.get(), 0.0)
            }
        };
        let doppler = config.doppler();
        let pairs = (squares / 2.0).ceil() as u32;
        let draws = [FADING, DRIFT].map(|purpose| streams.keyed(purpose));
        let reshaped = squares > 0.0 && (shape - squares / 2.0).abs() > 1e-9;
        Self {
            fields: (0..pairs)
                .map(|field| Field::new(draws, field, LIGHT / frequency_hz, doppler))
                .collect(),
            odd: squares < 2.0 * f64::from(pairs),
            direct: sqrt(k / (k + 1.0)),
            scattered: sqrt(2.0 / (squares.max(1.0) * WAVES as f64 * (k + 1.0))),
            reshaping: reshaped.then(|| Reshaping::new(squares / 2.0, shape)),
            drifts: doppler > 0.0,
        }
    }

    /// Whether links change while both ends stand.
    #[must_use]
    pub fn drifts(&self) -> bool {
        self.drifts
    }

    /// The power gain between `a`, the place of the robot with the lower number, and `b`, that of the other, in metres, `at_seconds` after the start. The order makes it the same in both directions.
    #[must_use]
    pub fn gain(&self, a: Vec2, b: Vec2, at_seconds: f64) -> f64 {
        let Some((last, others)) = self.fields.split_last() else {
            return 1.0;
        };
        let pair = |field: &Field| {
            let [real, imaginary] = field.at(a, b, self.drifts.then_some(at_seconds));
            [real * self.scattered + self.direct, imaginary * self.scattered]
        };
        let [real, imaginary] = pair(last);
        let mut gain = real * real;
        if !self.odd {
            gain += imaginary * imaginary;
        }
        for field in others {
            let [real, imaginary] = pair(field);
            gain += real * real + imaginary * imaginary;
        }
        match &self.reshaping {
            Some(reshaping) => reshaping.gain(gain),
            None => gain,
        }
    }
}

impl Field {
    fn new([directions, drifts]: [KeyedStreams; 2], field: u32, wavelength: f64, doppler: f64) -> Self {
        let waves = Waves::new(directions, field, wavelength, |uniform| {
            let [a, b] = [TAU * uniform(), TAU * uniform()];
            [cos(a), sin(a), cos(b), sin(b)]
        });
        let drift = std::array::from_fn(|wave| {
            let angle = (drifts.at(field, wave as u32, 0).next_u64() >> 11) as f64 * (TAU / 9_007_199_254_740_992.0);
            doppler * cos(angle)
        });
        Self { waves, drift }
    }

    /// Its real and imaginary part, each of variance M/2.
    #[inline]
    fn at(&self, a: Vec2, b: Vec2, drifted_s: Option<f64>) -> [f64; 2] {
        let phases = match drifted_s {
            None => *self.waves.phases(),
            Some(seconds) => std::array::from_fn(|wave| {
                let turns = self.drift[wave] * seconds;
                self.waves.phases()[wave] + (turns - nearest(turns)) as f32
            }),
        };
        self.waves.phasors(&phases, a, b).map(f64::from)
    }
}
