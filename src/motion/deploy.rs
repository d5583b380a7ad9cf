//! Deployment: where robots stand when a trial begins.

use std::f64::consts::{PI, TAU};

use rand::RngExt;

use super::arena::Arena;
use super::config::{ArenaConfig, DeployConfig};
use super::occupancy::Occupancy;
use crate::engine::{KeyedStreams, Purpose, Streams};
use crate::geometry::{Pose, Vec2, at_least, wrap_angle};
use crate::quantity::Finite;

const PLACE: Purpose = Purpose::new("motion.deploy.place");
const HEADING: Purpose = Purpose::new("motion.deploy.heading");

/// Random places tried for one robot before deployment gives up. When bodies are to cover half of a region, the last
/// robots need some hundred tries; near the density where random placement jams (0.547, Feder 1980), any number.
const TRIES: u32 = 20_000;

/// Robots cannot be deployed as the scenario asks.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DeployError {
    /// The random search for a free place was given up.
    #[error("found no free place for robot {robot} of {robots} in {tries} tries: use {remedy}")]
    NoRoom {
        /// The first robot without a place.
        robot: u32,
        /// How many were to be deployed.
        robots: u32,
        /// How many places were tried for it.
        tries: u32,
        /// What would make room.
        remedy: &'static str,
    },
    /// A list of places is not as long as the swarm is large.
    #[error("{places} places are listed for {robots} robots: list exactly one for each")]
    WrongCount {
        /// How many places are listed.
        places: usize,
        /// How many robots there are.
        robots: u32,
    },
    /// A given place is not free.
    #[error("robot {robot}, at ({x}, {y}), would overlap {hindrance}: move it further away", x = .place.x, y = .place.y)]
    Taken {
        /// Whose place it is.
        robot: u32,
        /// The place.
        place: Vec2,
        /// What is there.
        hindrance: Hindrance,
    },
}

/// What makes a place unfit for a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hindrance {
    /// The body of another robot.
    Robot(u32),
    /// A wall or an obstacle, or the arena's edge.
    Arena,
}

impl std::fmt::Display for Hindrance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Robot(other) => write!(f, "robot {other}"),
            Self::Arena => f.write_str("a wall or an obstacle"),
        }
    }
}

/// Poses for `robots` robots of `body_radius` metres, in order of their ids: bodies overlap neither each other nor walls
/// nor obstacles; headings are uniform. A robot's draws depend on no other robot's, and its number says nothing about its place
/// but what the deployment itself says of it.
///
/// # Errors
/// If places that the scenario gives are too few, too many or not free, or if a random place was not found in 20,000
/// tries.
pub fn deploy(
    config: &DeployConfig,
    arena: &ArenaConfig,
    robots: u32,
    body_radius: f64,
    streams: &Streams,
) -> Result<Vec<Pose>, DeployError> {
    let site = Site::new(arena, robots, body_radius);
    let places = match config {
        DeployConfig::Cluster { radius } => site.scatter(Region::Disc(radius.get()), streams.keyed(PLACE)),
        DeployConfig::Uniform => site.scatter(Region::Arena, streams.keyed(PLACE)),
        DeployConfig::At(places) => site.at(places),
    }?;
    let headings = streams.keyed(HEADING);
    let pose = |(id, position)| Pose {
        position,
        heading: wrap_angle(PI - TAU * headings.at(id, 0, 0).random::<f64>()),
    };
    Ok((0..robots).zip(places).map(pose).collect())
}

/// Every place of `places` that a robot cannot stand at.
pub(super) fn taken(places: &[(Finite, Finite)], arena: &ArenaConfig, body_radius: f64) -> Vec<DeployError> {
    Site::new(arena, places.len() as u32, body_radius).settle(places).1
}

/// Whether robot 0 can stand at the arena's centre.
pub(super) fn centre_is_free(arena: &ArenaConfig, body_radius: f64) -> bool {
    Arena::new(arena).clearance(Vec2::zeros()) >= at_least(body_radius)
}

/// Where robots may be put at random.
#[derive(Clone, Copy)]
enum Region {
    Arena,
    /// Within this distance of the centre, the first robot exactly there.
    Disc(f64),
}

/// The ground that robots are deployed on.
struct Site {
    arena: Arena,
    robots: u32,
    body_radius: f64,
}

impl Site {
    fn new(arena: &ArenaConfig, robots: u32, body_radius: f64) -> Self {
        Self {
            arena: Arena::new(arena),
            robots,
            body_radius,
        }
    }

    fn scatter(&self, region: Region, streams: KeyedStreams) -> Result<Vec<Vec2>, DeployError> {
        let room = self.arena.half().add_scalar(-self.body_radius);
        let (half, radius) = match region {
            Region::Arena => (room, f64::INFINITY),
            Region::Disc(radius) => (room.inf(&Vec2::repeat(radius)), radius),
        };
        let mut occupancy = Occupancy::new(half, 2.0 * self.body_radius, self.robots as usize);
        for robot in 0..self.robots {
            if robot == 0 && matches!(region, Region::Disc(_)) {
                self.check(robot, Vec2::zeros(), self.body_radius, &occupancy)?;
                occupancy.take(Vec2::zeros());
                continue;
            }
            let place = self.find(robot, half, radius, streams, &occupancy);
            occupancy.take(place.ok_or_else(|| self.no_room(robot, region))?);
        }
        Ok(occupancy.into_places())
    }

    /// A free place for `robot`, uniform over what lies both between −`half` and `half` and within `radius`.
    fn find(&self, robot: u32, half: Vec2, radius: f64, streams: KeyedStreams, occupancy: &Occupancy) -> Option<Vec2> {
        if half.min() < 0.0 {
            return None;
        }
        let mut draws = streams.at(robot, 0, 0);
        let mut coordinate = |half: f64| half * (2.0 * draws.random::<f64>() - 1.0);
        (0..TRIES)
            .map(|_| Vec2::new(coordinate(half.x), coordinate(half.y)))
            .filter(|place| place.norm() <= radius)
            .find(|&place| self.check(robot, place, self.body_radius, occupancy).is_ok())
    }

    fn at(&self, places: &[(Finite, Finite)]) -> Result<Vec<Vec2>, DeployError> {
        if places.len() != self.robots as usize {
            return Err(DeployError::WrongCount {
                places: places.len(),
                robots: self.robots,
            });
        }
        let (occupancy, errors) = self.settle(places);
        errors
            .into_iter()
            .next()
            .map_or_else(|| Ok(occupancy.into_places()), Err)
    }

    /// Takes every place, free or not, and reports those that were not.
    fn settle(&self, places: &[(Finite, Finite)]) -> (Occupancy, Vec<DeployError>) {
        let mut occupancy = Occupancy::new(self.arena.half(), at_least(2.0 * self.body_radius), places.len());
        let mut errors = Vec::new();
        for (robot, place) in (0..).zip(places) {
            let place = Vec2::new(place.0.get(), place.1.get());
            errors.extend(self.check(robot, place, at_least(self.body_radius), &occupancy).err());
            occupancy.take(place);
        }
        (occupancy, errors)
    }

    fn check(&self, robot: u32, place: Vec2, clearance: f64, occupancy: &Occupancy) -> Result<(), DeployError> {
        let hindrance = if self.arena.clearance(place) < clearance {
            Some(Hindrance::Arena)
        } else {
            occupancy.conflict(place).map(Hindrance::Robot)
        };
        hindrance.map_or(Ok(()), |hindrance| {
            Err(DeployError::Taken {
                robot,
                place,
                hindrance,
            })
        })
    }

    fn no_room(&self, robot: u32, region: Region) -> DeployError {
        DeployError::NoRoom {
            robot,
            robots: self.robots,
            tries: TRIES,
            remedy: match region {
                Region::Arena => "a larger arena or fewer robots or obstacles",
                Region::Disc(_) => "a larger cluster radius or fewer robots or obstacles",
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::tests::{assert_mean, square};
    use crate::quantity::Positive;

    #[test]
    fn a_cluster_is_uniform_over_its_disc_with_robot_0_at_the_centre() {
        let config = DeployConfig::Cluster {
            radius: Positive::new(2.0),
        };
        let poses: Vec<Pose> = (0..50)
            .flat_map(|trial| deploy(&config, &square(10.0), 100, 1e-6, &Streams::new(9, trial)).unwrap())
            .collect();
        assert!(poses.iter().step_by(100).all(|pose| pose.position == Vec2::zeros()));
        let others: Vec<&Pose> = poses
            .iter()
            .enumerate()
            .filter(|(index, _)| index % 100 != 0)
            .map(|(_, p)| p)
            .collect();
        assert!(others.iter().all(|pose| pose.position.norm() <= 2.0));
        // In a disc the squared distance to the centre is uniform on [0, R²]; so are angles and headings on theirs.
        let of = |measure: fn(&Pose) -> f64| others.iter().map(|pose| measure(pose)).collect::<Vec<_>>();
        assert_mean(&of(|pose| pose.position.norm_squared()), 2.0);
        assert_mean(&of(|pose| pose.position.norm_squared().powi(2)), 16.0 / 3.0);
        assert_mean(&of(|pose| pose.position.y.atan2(pose.position.x)), 0.0);
        assert_mean(&of(|pose| pose.heading), 0.0);
        assert_mean(&of(|pose| pose.heading.powi(2)), PI * PI / 3.0);
    }

    #[test]
    fn another_robots_place_does_not_change_when_more_are_deployed() {
        let config = DeployConfig::Cluster {
            radius: Positive::new(1.5),
        };
        let few = deploy(&config, &square(10.0), 20, 0.07, &Streams::new(2, 0)).unwrap();
        let many = deploy(&config, &square(10.0), 80, 0.07, &Streams::new(2, 0)).unwrap();
        assert_eq!(few[..], many[..20]);
    }

    #[test]
    fn a_cluster_too_small_for_its_robots_is_refused_with_the_remedy() {
        let config = DeployConfig::Cluster {
            radius: Positive::new(0.5),
        };
        let error = deploy(&config, &square(10.0), 60, 0.07, &Streams::new(1, 0)).unwrap_err();
        assert!(
            error
                .to_string()
                .ends_with("use a larger cluster radius or fewer robots or obstacles"),
            "{error}"
        );
        let narrow = deploy(&DeployConfig::Uniform, &square(0.1), 1, 0.07, &Streams::new(1, 0));
        assert!(matches!(narrow, Err(DeployError::NoRoom { robot: 0, .. })));
    }

    #[test]
    fn listed_places_must_be_one_for_each_robot_inside_the_arena_and_apart() {
        let at = |places: &[(f64, f64)]| {
            DeployConfig::At(places.iter().map(|&(x, y)| (Finite::new(x), Finite::new(y))).collect())
        };
        let refused = |places: &[(f64, f64)], robots| {
            deploy(&at(places), &square(2.0), robots, 0.07, &Streams::new(1, 0))
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            refused(&[(0.0, 0.0)], 2),
            "1 places are listed for 2 robots: list exactly one for each"
        );
        assert_eq!(
            refused(&[(0.0, 0.0), (0.1, 0.0)], 2),
            "robot 1, at (0.1, 0), would overlap robot 0: move it further away"
        );
        assert_eq!(
            refused(&[(0.95, 0.0)], 1),
            "robot 0, at (0.95, 0), would overlap a wall or an obstacle: move it further away"
        );
        // A row of touching robots is fine, whatever its coordinates round to.
        let row: Vec<(f64, f64)> = (0..10).map(|index| (0.14 * f64::from(index) - 0.6, 0.93)).collect();
        let poses = deploy(&at(&row), &square(2.0), 10, 0.07, &Streams::new(1, 0)).unwrap();
        assert_eq!(poses[3].position, Vec2::new(0.14 * 3.0 - 0.6, 0.93));
    }
}
