//! Stand-in.
use crate::engine::Streams;
use crate::geometry::Vec2;
use crate::quantity::{NonNegative, Positive};
use crate::radio::Obstacle;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
/// x
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum PathLossConfig {
    /// x
    LogDistance {
        /// x
        exponent: Positive,
    },
}
impl Default for PathLossConfig {
    fn default() -> Self {
        Self::LogDistance {
            exponent: Positive::new(3.0),
        }
    }
}
impl PathLossConfig {
    /// x
    pub fn problems(&self) -> Vec<(String, String)> {
        Vec::new()
    }
}
/// x
#[derive(Debug)]
pub struct PathLoss(f64, f64);
impl PathLoss {
    /// x
    pub fn new(config: &PathLossConfig, frequency: f64) -> Self {
        let PathLossConfig::LogDistance { exponent } = config;
        Self(
            20.0 * libm::log10(4.0 * std::f64::consts::PI * frequency / 299792458.0),
            exponent.get(),
        )
    }
    /// x
    pub fn loss_db(&self, d: f64) -> f64 {
        (self.0 + 10.0 * self.1 * libm::log10(d.max(1e-9))).max(0.0)
    }
    /// x
    pub fn distance_at(&self, loss: f64) -> f64 {
        libm::exp10((loss - self.0) / 10.0 / self.1)
    }
}
/// x
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ShadowingConfig {
    /// x
    pub sigma: NonNegative,
    /// x
    pub decorrelation: Positive,
}
/// x
#[derive(Debug)]
pub struct Shadowing;
impl Shadowing {
    /// x
    pub fn new(_: &ShadowingConfig, _: &Streams) -> Self {
        Self
    }
    /// x
    pub fn db(&self, _: Vec2, _: Vec2) -> f64 {
        0.0
    }
}
/// x
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum FadingConfig {
    /// x
    #[default]
    None,
}
/// x
#[derive(Debug)]
pub struct Fading;
impl Fading {
    /// x
    pub fn new(_: &FadingConfig, _: &Streams, _: f64) -> Self {
        Self
    }
    /// x
    pub fn gain(&self, _: Vec2, _: Vec2, _: f64) -> f64 {
        1.0
    }
    /// x
    pub fn mean_of(&self, f: impl Fn(f64) -> f64) -> f64 {
        f(1.0)
    }
    /// x
    pub fn is_none(&self) -> bool {
        true
    }
}
/// x
#[derive(Debug)]
pub struct Walls;
impl Walls {
    /// x
    pub fn new(_: Vec<Obstacle>, _: f64) -> Self {
        Self
    }
    /// x
    pub fn loss_db(&self, _: Vec2, _: Vec2) -> f64 {
        0.0
    }
    /// x
    pub fn blocked(&self, _: Vec2, _: Vec2) -> bool {
        false
    }
}
