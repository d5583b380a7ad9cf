//! Walls: what stands in the straight way between two robots.

mod crossing;
mod grid;
#[cfg(test)]
mod tests;

use self::crossing::{Crossing, Line};
use self::grid::Grid;
use crate::geometry::Vec2;
use crate::radio::site::{Obstacle, Shape};

/// The walls of an arena, for straight lines between places to be held against.
///
/// A line crosses an obstacle once or not at all, be it that an end of it lies within, that it only touches, or that it runs along a wall. Where it goes exactly through a corner, where walls end at the same point, it crosses one of
/// them: the one that takes off most.
#[derive(Debug)]
pub struct Walls {
    obstacles: Vec<(Shape, f64)>,
    grid: Grid,
}

impl Walls {
    /// Such `obstacles`; those that do not say otherwise take off `default_db` dB each.
    #[must_use]
    pub fn new(obstacles: &[Obstacle], default_db: f64) -> Self {
        let with_loss = |obstacle: &Obstacle| (obstacle.shape, obstacle.attenuation.unwrap_or(default_db));
        let bounds: Vec<_> = obstacles.iter().map(|obstacle| obstacle.shape.bounds()).collect();
        Self {
            grid: Grid::new(&bounds),
            obstacles: obstacles.iter().map(with_loss).collect(),
        }
    }

    /// What all obstacles between `a` and `b` take off, dB; the same in both directions.
    #[must_use]
    pub fn loss_db(&self, a: Vec2, b: Vec2) -> f64 {
        let line = Line::between(a, b);
        let mut sum = 0.0;
        let mut corners: Vec<(Vec2, f64)> = Vec::new();
        self.grid.visit(line, |index| {
            let (shape, loss) = self.obstacles[index];
            match shape.crossing(line) {
                Crossing::None => {}
                Crossing::Within => sum += loss,
                Crossing::AtEnd(end) => match corners.iter_mut().find(|(corner, _)| *corner == end) {
                    Some((_, most)) => *most = most.max(loss),
                    None => corners.push((end, loss)),
                },
            }
            true
        });
        sum + corners.iter().map(|(_, loss)| loss).sum::<f64>()
    }

    /// Whether any obstacle is between `a` and `b`, whatever it takes off.
    #[must_use]
    pub fn blocked(&self, a: Vec2, b: Vec2) -> bool {
        let line = Line::between(a, b);
        let mut blocked = false;
        self.grid.visit(line, |index| {
            blocked = !matches!(self.obstacles[index].0.crossing(line), Crossing::None);
            !blocked
        });
        blocked
    }
}
