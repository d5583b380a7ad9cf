//! Shadowing: what large things in the way take off or add, slowly varying over places.

use std::f64::consts::TAU;

use libm::{cos, sin, sqrt};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::waves::{FASTEST, WAVES, Waves};
use crate::engine::{Purpose, Streams};
use crate::geometry::Vec2;
use crate::quantity::{NonNegative, Positive};

/// The stream of each wave of shadowing.
const SHADOWING: Purpose = Purpose::new("radio.shadowing");

/// Shadowing by things that are not in the scenario: a normal loss in dB beside the path loss, the same for both directions of a link, correlated as exp(−distance/decorrelation) where an end moves (Gudmundson, *Correlation model for
/// shadow fading in mobile radio systems*, 1991), and by the sum of both distances where both move.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ShadowingConfig {
    /// Standard deviation, dB. 4 is usual indoors.
    pub sigma: NonNegative,
    /// Distance in metres over which the correlation falls to 1/e.
    pub decorrelation: Positive,
}

impl Default for ShadowingConfig {
    fn default() -> Self {
        Self {
            sigma: NonNegative::new(4.0),
            decorrelation: Positive::new(5.0),
        }
    }
}

/// The shadowing of one trial.
#[derive(Debug)]
pub struct Shadowing {
    /// dB for each unit of the waves' sum.
    scale: f64,
    waves: Waves,
}

impl Shadowing {
    /// The shadowing that `config` describes, drawn from the `streams` of a trial.
    #[must_use]
    pub fn new(config: &ShadowingConfig, streams: &Streams) -> Self {
        let waves = Waves::new(streams.keyed(SHADOWING), 0, config.decorrelation.get(), |uniform| {
            let mut end = || {
                // So long that the mean over all waves of J0(2π length · distance) is exp(−distance).
                let above = 1.0 / (1.0 - uniform());
                let length = (sqrt(above * above - 1.0) / TAU).min(FASTEST);
                let direction = TAU * uniform();
                [length * cos(direction), length * sin(direction)]
            };
            let [[ax, ay], [bx, by]] = [end(), end()];
            [ax, ay, bx, by]
        });
        Self {
            scale: config.sigma.get() * sqrt(2.0 / WAVES as f64),
            waves,
        }
    }

    /// The loss in dB between `a`, the place of the robot with the lower number, and `b`, that of the other, in metres: normal around 0. That order makes it the same in both directions. The
    /// mean over both orders would be so too, but its variance would be greater where the ends are near each other.
    #[inline]
    #[must_use]
    pub fn db(&self, a: Vec2, b: Vec2) -> f64 {
        self.scale * f64::from(self.waves.cosines(a, b))
    }
}
