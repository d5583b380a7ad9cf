//! What stands in an arena, as far as signals go.

use crate::geometry::Vec2;

/// A body that takes something off what passes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// Its outline.
    pub shape: ObstacleShape,
    /// Loss each time that a line crosses it, dB; `None`: the same as most.
    pub loss_db: Option<f64>,
}

/// An outline; metres, arena axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ObstacleShape {
    /// A thin straight wall, its ends included.
    Segment {
        /// One end.
        from: Vec2,
        /// The other.
        to: Vec2,
    },
    /// A disc, its rim included.
    Disc {
        /// Its centre.
        centre: Vec2,
        /// Its radius.
        radius: f64,
    },
}
