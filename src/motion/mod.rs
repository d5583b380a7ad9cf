//! Motion: the arena, the drive, collisions, and who is near whom. Advances in fixed ticks.

mod config;

pub use config::{ArenaConfig, DeployConfig, MotionConfig, ObstacleConfig, PidConfig};
