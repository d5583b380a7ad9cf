//! Whether a robot can come near enough to a place.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use super::arena::Arena;
use super::config::ArenaConfig;
use crate::geometry::{Vec2, unit};

/// Places tried around the one in question: so many rings, and so many places on each.
const RINGS: u32 = 16;
const PLACES: u32 = 32;
/// Most cells that ways are looked for on, and most of them that obstacles are drawn into.
const CELLS: f64 = 300_000.0;
const DRAWN: f64 = 3_000_000.0;
/// Most distances to bodies that are asked for around all places.
const ASKED: f64 = 3e7;

/// Whether a robot can come near enough to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Nothing known keeps it from there.
    Open,
    /// No place that is near enough has room for its body.
    NoRoom,
    /// Walls and obstacles leave no way there.
    WalledIn,
}

/// Whether a robot of `body_radius` metres that sets out from `from` can come within `near` metres of each of `places`. What
/// is called open may still be too narrow: ways are looked for on a grid, which errs on the open side.
#[must_use]
pub fn reach(arena: &ArenaConfig, body_radius: f64, from: Vec2, places: &[Vec2], near: f64) -> Vec<Reach> {
    let stands = f64::from((RINGS + 1) * PLACES) * places.len() as f64;
    if stands * arena.obstacles.len() as f64 > ASKED {
        return vec![Reach::Open; places.len()];
    }
    let bodies = Arena::new(arena);
    let ways = (!arena.obstacles.is_empty())
        .then(|| Ways::from(arena, &bodies, body_radius, from))
        .flatten();
    let of = |place: &Vec2| {
        let ring = |ring: u32| near * f64::from(ring) / f64::from(RINGS);
        let places = (0..PLACES).map(|part| unit(TAU * f64::from(part) / f64::from(PLACES)));
        let mut around = places.flat_map(|direction| (0..=RINGS).map(move |number| place + direction * ring(number)));
        if !around.any(|stand| bodies.clearance(stand) >= body_radius) {
            Reach::NoRoom
        } else if ways.as_ref().is_some_and(|ways| !ways.lead_to(*place, near)) {
            Reach::WalledIn
        } else {
            Reach::Open
        }
    };
    places.iter().map(of).collect()
}

/// The ground that can be reached, as cells of a grid. A cell is open if some point of it may have room for a body; so a way that
/// there is leads through open cells that touch.
struct Ways {
    cell: f64,
    low: Vec2,
    columns: usize,
    rows: usize,
    reached: Vec<bool>,
}

impl Ways {
    /// What can be reached from `from`; `None` where the grid would be too large.
    fn from(arena: &ArenaConfig, bodies: &Arena, body_radius: f64, from: Vec2) -> Option<Self> {
        let size = 2.0 * bodies.half();
        // Half a body: so the cells that a thin wall closes leave no gap.
        let cell = body_radius / 2.0;
        let cells = (size.x / cell).ceil() * (size.y / cell).ceil();
        if cells > CELLS || cells * arena.obstacles.len() as f64 > DRAWN {
            return None;
        }
        let mut ways = Self {
            cell,
            low: -bodies.half(),
            columns: (size.x / cell).ceil().max(1.0) as usize,
            rows: (size.y / cell).ceil().max(1.0) as usize,
            reached: Vec::new(),
        };
        let margin = body_radius - cell / 2.0_f64.sqrt();
        let count = ways.columns * ways.rows;
        let open: Vec<bool> = (0..count)
            .map(|index| bodies.clearance(ways.centre(index)) >= margin)
            .collect();
        ways.reached = vec![false; count];
        let mut next = VecDeque::from([ways.index(from)]);
        while let Some(index) = next.pop_front() {
            if ways.reached[index] || !open[index] {
                continue;
            }
            ways.reached[index] = true;
            let (column, row) = (index % ways.columns, index / ways.columns);
            for row in row.saturating_sub(1)..=(row + 1).min(ways.rows - 1) {
                for column in column.saturating_sub(1)..=(column + 1).min(ways.columns - 1) {
                    next.push_back(row * ways.columns + column);
                }
            }
        }
        Some(ways)
    }

    fn centre(&self, index: usize) -> Vec2 {
        let (column, row) = (index % self.columns, index / self.columns);
        self.low + Vec2::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell
    }

    fn index(&self, place: Vec2) -> usize {
        let at = (place - self.low) / self.cell;
        (at.y as usize).min(self.rows - 1) * self.columns + (at.x as usize).min(self.columns - 1)
    }

    fn lead_to(&self, place: Vec2, near: f64) -> bool {
        let far = near + self.cell / 2.0_f64.sqrt();
        let mut reached = (0..self.reached.len()).filter(|index| self.reached[*index]);
        reached.any(|index| (self.centre(index) - place).norm() <= far)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::config::ObstacleConfig;
    use crate::motion::tests::square;
    use crate::quantity::{Finite, Positive};

    fn at(x: f64, y: f64) -> (Finite, Finite) {
        (Finite::new(x), Finite::new(y))
    }

    fn wall(from: (f64, f64), to: (f64, f64)) -> ObstacleConfig {
        ObstacleConfig::Wall {
            from: at(from.0, from.1),
            to: at(to.0, to.1),
            attenuation: None,
        }
    }

    fn reached(obstacles: Vec<ObstacleConfig>, places: &[(f64, f64)]) -> Vec<Reach> {
        let arena = ArenaConfig {
            obstacles,
            ..square(8.0)
        };
        let places: Vec<Vec2> = places.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
        reach(&arena, 0.07, Vec2::zeros(), &places, 0.3)
    }

    #[test]
    fn a_place_beyond_the_walls_is_reached_only_as_far_as_a_body_from_them() {
        // The centre comes to 3.93 m, so it is within 0.3 m of 4.22 m and not of 4.24 m.
        let found = reached(Vec::new(), &[(3.0, 3.0), (4.22, 0.0), (4.24, 0.0), (30.0, 0.0)]);
        assert_eq!(found, [Reach::Open, Reach::Open, Reach::NoRoom, Reach::NoRoom]);
    }

    #[test]
    fn a_place_in_an_obstacle_is_reached_only_from_beside_it() {
        let disc = |radius| ObstacleConfig::Disc {
            at: at(2.0, 1.0),
            radius: Positive::new(radius),
            attenuation: None,
        };
        assert_eq!(reached(vec![disc(0.22)], &[(2.0, 1.0)]), [Reach::Open]);
        assert_eq!(reached(vec![disc(0.24)], &[(2.0, 1.0)]), [Reach::NoRoom]);
    }

    #[test]
    fn a_room_without_a_door_is_walled_in_and_one_with_a_door_wider_than_a_body_is_not() {
        let room = |door: f64| {
            vec![
                wall((1.0, 1.0), (3.0, 1.0)),
                wall((3.0, 1.0), (3.0, 3.0)),
                wall((3.0, 3.0), (1.0, 3.0)),
                wall((1.0, 3.0), (1.0, 1.0 + door)),
            ]
        };
        let found = |door| reached(room(door), &[(2.0, 2.0), (2.0, -2.0), (0.8, 2.0)]);
        assert_eq!(found(0.0), [Reach::WalledIn, Reach::Open, Reach::Open]);
        assert_eq!(found(0.2), [Reach::Open; 3]);
        // Slanting walls close as well.
        let across = vec![wall((-4.0, 4.0), (4.0, -1.0))];
        assert_eq!(
            reached(across, &[(3.0, 2.0), (-3.0, -3.0)]),
            [Reach::WalledIn, Reach::Open]
        );
    }
}
