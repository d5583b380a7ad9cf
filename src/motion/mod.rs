//! Motion: the arena, the drive, collisions, and who is near whom. Advances in fixed ticks.
//!
//! A tick of [`World::advance`] does four things, in this order:
//!
//! 1. **travel**: every robot goes on to where its velocity took it ([`World::position`] said so all along);
//! 2. **steer**: each drive turns its commanded velocity into a speed and a turning rate (paper section 3.1);
//! 3. **contact**: where those velocities would make bodies overlap by the next tick, they are corrected now;
//! 4. **index**: the grids that answer who is near whom are rebuilt, if anything moves.
//!
//! Collisions are settled ahead, on the velocities, so a position between two ticks is exact: it lies on the straight
//! line to the place where the next tick finds the robot. Nothing is corrected after the fact.

mod arena;
mod config;
mod contact;
mod deploy;
mod drive;
mod grid;
mod occupancy;
mod pid;
mod reach;
mod rules;
mod spacing;
mod survey;
mod world;

#[cfg(test)]
mod tests;

pub use config::{ArenaConfig, DeployConfig, MotionConfig, ObstacleConfig, PidConfig};
pub use contact::OVERLAP_TOLERANCE;
pub use deploy::{DeployError, Hindrance, deploy};
pub use reach::{Reach, reach};
pub use rules::Problem;
pub use spacing::Spacing;
pub use survey::{Site, Survey};
pub use world::World;
