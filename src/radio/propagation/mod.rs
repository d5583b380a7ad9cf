//! Propagation: what is left of a signal at a receiver. Each part by itself, as a function of where both ends are, without state.
//!
//! In dB, the loss of a link is that of its distance ([`PathLoss`]), that of what stands in the way ([`Walls`]) and that of what is not in the scenario ([`Shadowing`]); the gain of many ways ([`Fading`]) is a factor beside. All
//! are the same in both directions, where the place of the robot with the lower number is named first, and still where robots are.
//!
//! What reaches a result is computed by `libm` and by polynomials in one order, the same bytes on every machine.

mod fading;
mod gamma;
mod path_loss;
mod shadowing;
mod walls;
mod waves;

pub(in crate::radio) use fading::mean;
pub use fading::{Fading, FadingConfig};
pub use path_loss::{BreakPointConfig, LogDistanceConfig, PathLoss, PathLossConfig, TwoRayConfig};
pub use shadowing::{Shadowing, ShadowingConfig};
pub use walls::Walls;

/// Speed of light, m/s (exact).
const LIGHT: f64 = 299_792_458.0;
