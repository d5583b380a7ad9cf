//! Obstacles by cells of a grid, so that a line is held only against those near it.

use std::ops::RangeInclusive;

use super::crossing::{Bounds, Line};
use crate::geometry::Vec2;

/// Cells for each obstacle.
const CELLS_PER_OBSTACLE: f64 = 4.0;
/// Columns and rows at most.
const MOST: f64 = 256.0;
/// By which share of the largest coordinate a line is taken to be wider than it is, so that rounding moves none out of a cell where it meets something.
const ROUNDING: f64 = 1e-9;

/// Which obstacles lie in which cells. An obstacle is in all cells of a rectangle of them.
#[derive(Debug)]
pub(super) struct Grid {
    bounds: Bounds,
    cells_per_metre: Vec2,
    columns: usize,
    rows: usize,
    /// Where the obstacles of each cell begin in `members`, row by row; one more marks the end.
    starts: Vec<u32>,
    members: Vec<u32>,
    /// By obstacle.
    places: Vec<Rectangle>,
}

/// Cells side by side.
#[derive(Clone, Debug)]
struct Rectangle {
    columns: RangeInclusive<usize>,
    rows: RangeInclusive<usize>,
}

impl Grid {
    /// A grid over obstacles that lie in these rectangles.
    pub fn new(obstacles: &[Bounds]) -> Self {
        let bounds = obstacles.iter().copied().reduce(Bounds::and).unwrap_or(Bounds {
            least: Vec2::zeros(),
            most: Vec2::zeros(),
        });
        let extent = bounds.most - bounds.least;
        let cell = {
            let wanted = CELLS_PER_OBSTACLE * obstacles.len() as f64;
            // Square cells, but where all obstacles lie in a line.
            (extent.x * extent.y / wanted).sqrt().max(extent.max() / MOST)
        };
        let count = |length: f64| {
            if length > 0.0 {
                (length / cell).ceil().clamp(1.0, MOST)
            } else {
                1.0
            }
        };
        let counts = extent.map(count);
        let mut grid = Self {
            bounds,
            cells_per_metre: counts.zip_map(&extent, |count, length| if length > 0.0 { count / length } else { 0.0 }),
            columns: counts.x as usize,
            rows: counts.y as usize,
            starts: Vec::new(),
            members: Vec::new(),
            places: Vec::new(),
        };
        grid.places = obstacles.iter().map(|bounds| grid.rectangle(*bounds)).collect();
        grid.fill();
        grid
    }

    /// Calls `visit` once for each obstacle that `line` may meet, and for some others, until it says `false`.
    pub fn visit(&self, line: Line, mut visit: impl FnMut(usize) -> bool) {
        if self.members.is_empty() {
            return;
        }
        let Some(rows) = self.rows_of(line) else {
            return;
        };
        let mut before: Option<RangeInclusive<usize>> = None;
        for row in rows {
            let Some(columns) = self.columns_of(line, row) else {
                before = None;
                continue;
            };
            for column in columns.clone() {
                let cell = row * self.columns + column;
                let [start, end] = [self.starts[cell], self.starts[cell + 1]].map(|start| start as usize);
                for &member in &self.members[start..end] {
                    let place = &self.places[member as usize];
                    // Met already in this row, or in the one before: as a straight line comes once only through a rectangle, these are all.
                    let in_row = column > *columns.start().max(place.columns.start());
                    let in_row_before =
                        row > *place.rows.start() && before.as_ref().is_some_and(|before| meet(before, &place.columns));
                    if !in_row && !in_row_before && !visit(member as usize) {
                        return;
                    }
                }
            }
            before = Some(columns);
        }
    }

    /// Sorts obstacles into cells.
    fn fill(&mut self) {
        let mut cells = vec![Vec::new(); self.columns * self.rows];
        for (index, place) in self.places.iter().enumerate() {
            for row in place.rows.clone() {
                for column in place.columns.clone() {
                    cells[row * self.columns + column].push(index as u32);
                }
            }
        }
        self.starts.push(0);
        for cell in cells {
            self.members.extend(cell);
            self.starts.push(self.members.len() as u32);
        }
    }

    fn rectangle(&self, bounds: Bounds) -> Rectangle {
        let [least, most] = [bounds.least, bounds.most].map(|corner| self.cell(corner));
        Rectangle {
            columns: least[0]..=most[0],
            rows: least[1]..=most[1],
        }
    }

    /// Column and row of a point, the nearest ones if it lies outside.
    fn cell(&self, point: Vec2) -> [usize; 2] {
        let cells = (point - self.bounds.least).component_mul(&self.cells_per_metre);
        let within = |cell: f64, count: usize| (cell.max(0.0) as usize).min(count - 1);
        [within(cells.x, self.columns), within(cells.y, self.rows)]
    }

    /// The rows that `line` comes through.
    fn rows_of(&self, line: Line) -> Option<RangeInclusive<usize>> {
        let margin = self.margin(line);
        let [low, high] = [line.from.y.min(line.to.y) - margin, line.from.y.max(line.to.y) + margin];
        if high < self.bounds.least.y || low > self.bounds.most.y {
            return None;
        }
        let row = |y: f64| self.cell(Vec2::new(self.bounds.least.x, y))[1];
        Some(row(low)..=row(high))
    }

    /// The columns that `line` comes through within a row.
    fn columns_of(&self, line: Line, row: usize) -> Option<RangeInclusive<usize>> {
        let margin = self.margin(line);
        let along = line.to - line.from;
        // The part of the line, as shares of its length, that lies within the row.
        let mut part = [0.0_f64, 1.0];
        if along.y != 0.0 && self.rows > 1 {
            let height = 1.0 / self.cells_per_metre.y;
            let bottom = self.bounds.least.y + row as f64 * height;
            let shares = [bottom - margin, bottom + height + margin].map(|y| (y - line.from.y) / along.y);
            let [enters, leaves] = [shares[0].min(shares[1]), shares[0].max(shares[1])];
            part = [enters.clamp(0.0, 1.0), leaves.clamp(0.0, 1.0)];
        }
        let [left, right] = part.map(|share| line.from.x + along.x * share);
        let [left, right] = [left - margin, right + margin];
        if right < self.bounds.least.x || left > self.bounds.most.x {
            return None;
        }
        let column = |x: f64| self.cell(Vec2::new(x, self.bounds.least.y))[0];
        Some(column(left)..=column(right))
    }

    /// How much wider a line is taken to be, metres.
    fn margin(&self, line: Line) -> f64 {
        let corners = [self.bounds.least, self.bounds.most, line.from, line.to];
        ROUNDING * corners.iter().map(Vec2::amax).fold(0.0, f64::max)
    }
}

impl Bounds {
    fn and(self, other: Self) -> Self {
        Self {
            least: self.least.inf(&other.least),
            most: self.most.sup(&other.most),
        }
    }
}

fn meet(a: &RangeInclusive<usize>, b: &RangeInclusive<usize>) -> bool {
    a.start() <= b.end() && b.start() <= a.end()
}
