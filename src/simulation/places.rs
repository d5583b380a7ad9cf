//! The world as the radio sees it: where everybody is, and what stands in the way.

use crate::engine::{ActorId, SimTime, Streams};
use crate::geometry::Vec2;
use crate::motion::{ArenaConfig, ObstacleConfig, World};
use crate::quantity::{Finite, NonNegative};
use crate::radio::{Obstacle, Places, RadioSite, Shape};

impl Places for World {
    fn position(&self, robot: ActorId, at: SimTime) -> Vec2 {
        World::position(self, robot, at)
    }

    fn for_each_within(&self, centre: Vec2, at: SimTime, range: f64, visit: &mut dyn FnMut(ActorId, Vec2)) {
        self.for_each_around(centre, at, range, visit);
    }

    fn standing(&self) -> Option<u32> {
        World::standing(self)
    }
}

/// What a radio is told of a run of `robots` robots in `arena` whose clocks are fast by `skews`.
pub(super) fn site(
    streams: Streams,
    robots: usize,
    arena: &ArenaConfig,
    body_radius: f64,
    skews: Vec<f64>,
) -> RadioSite {
    RadioSite {
        streams,
        robots,
        body_radius,
        skews,
        obstacles: arena.obstacles.iter().map(obstacle).collect(),
    }
}

fn obstacle(config: &ObstacleConfig) -> Obstacle {
    let place = |at: (Finite, Finite)| Vec2::new(at.0.get(), at.1.get());
    let shape = match *config {
        ObstacleConfig::Disc { at, radius, .. } => Shape::Disc {
            centre: place(at),
            radius: radius.get(),
        },
        ObstacleConfig::Wall { from, to, .. } => Shape::Segment(place(from), place(to)),
    };
    Obstacle {
        shape,
        attenuation: config.attenuation().map(NonNegative::get),
    }
}
