//! The arena as robots meet it: walls and obstacles, each answering where its nearest point is.

use super::config::{ArenaConfig, ObstacleConfig};
use crate::geometry::Vec2;

/// The fixed bodies of a world. The arena's four walls come first.
pub(super) struct Arena {
    half: Vec2,
    bodies: Vec<Body>,
}

/// A body that does not move.
enum Body {
    /// One side of the arena: all that lies beyond `offset` in the direction of the unit vector `outward`.
    Side {
        outward: Vec2,
        offset: f64,
    },
    Disc {
        centre: Vec2,
        radius: f64,
    },
    /// The straight line from `from` to `from + along`.
    Wall {
        from: Vec2,
        along: Vec2,
    },
}

/// The nearest point of a body, as seen from another point.
pub(super) struct Nearest {
    /// Unit vector towards it.
    pub(super) towards: Vec2,
    /// Distance to it in metres, negative within the body.
    pub(super) distance: f64,
}

impl Arena {
    pub(super) fn new(config: &ArenaConfig) -> Self {
        let half = Vec2::new(config.size.0.get(), config.size.1.get()) / 2.0;
        let side = |outward: Vec2, offset| Body::Side { outward, offset };
        let sides = [
            side(Vec2::x(), half.x),
            side(-Vec2::x(), half.x),
            side(Vec2::y(), half.y),
            side(-Vec2::y(), half.y),
        ];
        let bodies = sides
            .into_iter()
            .chain(config.obstacles.iter().map(Body::new))
            .collect();
        Self { half, bodies }
    }

    /// Half of the arena's width and height.
    pub(super) fn half(&self) -> Vec2 {
        self.half
    }

    /// The nearest point of each body as seen from `point`, in the order of the scenario.
    pub(super) fn nearest(&self, point: Vec2) -> impl Iterator<Item = Nearest> {
        self.bodies.iter().map(move |body| body.nearest(point))
    }

    /// Distance from `point` to the nearest body, negative within one.
    pub(super) fn clearance(&self, point: Vec2) -> f64 {
        self.nearest(point)
            .map(|nearest| nearest.distance)
            .fold(f64::INFINITY, f64::min)
    }

    /// Moves a disc of `radius` at `place` out of each body in turn. Returns how deep the deepest overlap was.
    pub(super) fn push_out(&self, place: &mut Vec2, radius: f64) -> f64 {
        let mut deepest = 0.0_f64;
        for body in &self.bodies {
            let Nearest { towards, distance } = body.nearest(*place);
            let depth = radius - distance;
            if depth > 0.0 {
                *place -= towards * depth;
                deepest = deepest.max(depth);
            }
        }
        deepest
    }
}

impl Body {
    fn new(config: &ObstacleConfig) -> Self {
        match config {
            ObstacleConfig::Disc { at, radius, .. } => Self::Disc {
                centre: Vec2::new(at.0.get(), at.1.get()),
                radius: radius.get(),
            },
            ObstacleConfig::Wall { from, to, .. } => {
                let from = Vec2::new(from.0.get(), from.1.get());
                let along = Vec2::new(to.0.get(), to.1.get()) - from;
                Self::Wall { from, along }
            }
        }
    }

    fn nearest(&self, point: Vec2) -> Nearest {
        match *self {
            Self::Side { outward, offset } => Nearest {
                towards: outward,
                distance: offset - outward.dot(&point),
            },
            Self::Disc { centre, radius } => {
                let nearest = Nearest::of(centre - point, Vec2::x());
                Nearest {
                    distance: nearest.distance - radius,
                    ..nearest
                }
            }
            Self::Wall { from, along } => {
                let share = along.dot(&(point - from)) / along.norm_squared();
                if !(0.0..=1.0).contains(&share) {
                    return Nearest::of(from + along * share.clamp(0.0, 1.0) - point, Vec2::x());
                }
                let across = Vec2::new(-along.y, along.x).normalize();
                let distance = across.dot(&(from - point));
                Nearest {
                    towards: across * distance.signum(),
                    distance: distance.abs(),
                }
            }
        }
    }
}

impl Nearest {
    /// A single point at `offset`; where that is zero and has no direction, `otherwise` is taken.
    fn of(offset: Vec2, otherwise: Vec2) -> Self {
        let distance = offset.norm();
        Self {
            towards: if distance > 0.0 { offset / distance } else { otherwise },
            distance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::{Finite, Positive};

    fn arena() -> Arena {
        let at = |x, y| (Finite::new(x), Finite::new(y));
        Arena::new(&ArenaConfig {
            size: (Positive::new(10.0), Positive::new(6.0)),
            obstacles: vec![
                ObstacleConfig::Disc {
                    at: at(2.0, 0.0),
                    radius: Positive::new(0.5),
                    attenuation: None,
                },
                ObstacleConfig::Wall {
                    from: at(-2.0, -1.0),
                    to: at(-2.0, 1.0),
                    attenuation: None,
                },
            ],
        })
    }

    #[test]
    fn each_body_reports_the_distance_to_its_nearest_point() {
        let distances = |x, y| {
            arena()
                .nearest(Vec2::new(x, y))
                .map(|nearest| nearest.distance)
                .collect::<Vec<_>>()
        };
        assert_eq!(distances(0.0, 0.0), [5.0, 5.0, 3.0, 3.0, 1.5, 2.0]);
        assert_eq!(distances(2.0, 0.0), [3.0, 7.0, 3.0, 3.0, -0.5, 4.0]);
        // Beyond its end, a wall's nearest point is that end: 3-4-5.
        assert_eq!(distances(1.0, -5.0)[5..], [5.0]);
        assert!((arena().clearance(Vec2::new(0.0, 2.9)) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn a_disc_is_pushed_out_along_the_shortest_way() {
        let pushed = |x, y| {
            let mut place = Vec2::new(x, y);
            let depth = arena().push_out(&mut place, 0.1);
            (place, depth)
        };
        assert_eq!(pushed(0.0, 0.0), (Vec2::new(0.0, 0.0), 0.0));
        let (beyond_the_corner, _) = pushed(5.2, 3.2);
        assert!((beyond_the_corner - Vec2::new(4.9, 2.9)).norm() < 1e-12);
        let (left_of_the_wall, depth) = pushed(-2.04, 0.3);
        assert!((left_of_the_wall - Vec2::new(-2.1, 0.3)).norm() < 1e-12);
        assert!((depth - 0.06).abs() < 1e-12);
        let (on_the_wall, _) = pushed(-2.0, 0.3);
        assert!((on_the_wall.x + 2.0).abs() > 0.099);
    }
}
