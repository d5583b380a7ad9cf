//! A uniform grid over moving points: who is within reach of a place, at an instant after it was built.

use std::ops::Range;

use crate::engine::prefetch_all;
use crate::geometry::{Vec2, at_most};

/// Cells are allowed up to this many for each point, so that few points in a wide arena cost no memory.
const CELLS_PER_POINT: usize = 4;
/// Near points noted before they are visited.
const BATCH: usize = 64;

/// Points sorted by cell, row by row, so that the cells which a search needs from one row lie side by side in memory.
pub(super) struct Grid {
    wanted_cell: f64,
    origin: Vec2,
    cells_per_metre: f64,
    columns: usize,
    rows: usize,
    /// Where each cell's points begin in the three arrays of points; one more marks the end.
    starts: Vec<u32>,
    /// Points by cell: their positions, which every search reads, apart from what only the near ones are asked for.
    positions: Vec<Vec2>,
    velocities: Vec<Vec2>,
    ids: Vec<u32>,
    /// The largest speed among the points.
    fastest: f64,
    /// The cell of each point in order of id, while building.
    cell_of: Vec<u32>,
}

impl Grid {
    /// An empty grid with cells of `cell` metres, or more where there would be too many of them. The length decides
    /// speed only.
    pub(super) fn new(cell: f64) -> Self {
        Self {
            wanted_cell: cell,
            origin: Vec2::zeros(),
            cells_per_metre: 0.0,
            columns: 1,
            rows: 1,
            starts: vec![0, 0],
            positions: Vec::new(),
            velocities: Vec::new(),
            ids: Vec::new(),
            fastest: 0.0,
            cell_of: Vec::new(),
        }
    }

    /// Takes in points numbered from 0, at `positions` now and moving at `velocities` from now on.
    pub(super) fn rebuild(&mut self, positions: &[Vec2], velocities: &[Vec2]) {
        self.lay_cells(positions);
        self.count(positions);
        self.place(positions, velocities);
        self.fastest = velocities.iter().map(Vec2::norm_squared).fold(0.0, f64::max).sqrt();
    }

    /// Calls `visit` once for each point within `range` of `centre`, [the rim included](at_most), `elapsed` seconds after the
    /// grid was built: with its number and where it is then. The order depends on nothing but what the grid was built from.
    ///
    /// Whether a point is near is as good as random, and a wrong guess of the processor costs more than the test: so points
    /// that may be near are first noted without a branch, over all rows, then visited.
    #[inline]
    pub(super) fn for_each_within(&self, centre: Vec2, elapsed: f64, range: f64, mut visit: impl FnMut(u32, Vec2)) {
        let range = at_most(range);
        let reach = at_most(range + self.fastest * elapsed);
        let (left, right) = (self.column(centre.x - reach), self.column(centre.x + reach));
        let mut near = [0_u32; BATCH];
        let mut found = 0;
        for row in self.row(centre.y - reach)..=self.row(centre.y + reach) {
            let Range { start: first, end } = self.points(row, left, right);
            for (index, position) in (first..).zip(&self.positions[first..end]) {
                near[found] = index as u32;
                found += usize::from((position - centre).norm_squared() <= reach * reach);
                if found == BATCH {
                    self.visit_all(&near, centre, elapsed, range, &mut visit);
                    found = 0;
                }
            }
        }
        self.visit_all(&near[..found], centre, elapsed, range, &mut visit);
    }

    /// Visits those of the points at `indices` that have come within `range`.
    #[inline]
    fn visit_all(&self, indices: &[u32], centre: Vec2, elapsed: f64, range: f64, visit: &mut impl FnMut(u32, Vec2)) {
        for &index in indices {
            let index = index as usize;
            let mut position = self.positions[index];
            if self.fastest > 0.0 {
                position += self.velocities[index] * elapsed;
            }
            if (position - centre).norm_squared() <= range * range {
                visit(self.ids[index], position);
            }
        }
    }

    /// Asks for the points that a search reads.
    pub(super) fn prefetch(&self, centre: Vec2, range: f64) {
        let (left, right) = (self.column(centre.x - range), self.column(centre.x + range));
        for row in self.row(centre.y - range)..=self.row(centre.y + range) {
            let points = self.points(row, left, right);
            prefetch_all(&self.positions[points.clone()]);
            prefetch_all(&self.ids[points]);
        }
    }

    /// The points of one row, from column `left` to column `right`.
    #[inline]
    fn points(&self, row: usize, left: usize, right: usize) -> Range<usize> {
        let cell = row * self.columns;
        self.starts[cell + left] as usize..self.starts[cell + right + 1] as usize
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.origin.x) * self.cells_per_metre) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.origin.y) * self.cells_per_metre) as usize).min(self.rows - 1)
    }

    /// Lays cells over the smallest rectangle that holds all points.
    fn lay_cells(&mut self, positions: &[Vec2]) {
        let first = positions.first().copied().unwrap_or_default();
        let (low, high) = positions.iter().fold((first, first), |(low, high), position| {
            (low.inf(position), high.sup(position))
        });
        let extent = high - low;
        let most = (CELLS_PER_POINT * positions.len().max(1)) as f64;
        let mut cell = self.wanted_cell;
        while (extent.x / cell + 1.0) * (extent.y / cell + 1.0) > most && cell < extent.max() {
            cell *= 2.0;
        }
        self.origin = low;
        self.cells_per_metre = cell.recip();
        self.columns = (extent.x / cell) as usize + 1;
        self.rows = (extent.y / cell) as usize + 1;
    }

    /// Counts the points of each cell and turns the counts into where each cell ends.
    fn count(&mut self, positions: &[Vec2]) {
        self.starts.clear();
        self.starts.resize(self.columns * self.rows + 1, 0);
        self.cell_of.clear();
        for position in positions {
            let cell = self.row(position.y) * self.columns + self.column(position.x);
            self.cell_of.push(cell as u32);
            self.starts[cell] += 1;
        }
        let mut end = 0;
        for start in &mut self.starts {
            end += *start;
            *start = end;
        }
    }

    /// Fills the cells from their ends, the last point first: within a cell, points stand in order of id.
    fn place(&mut self, positions: &[Vec2], velocities: &[Vec2]) {
        self.positions.resize(positions.len(), Vec2::zeros());
        self.velocities.resize(positions.len(), Vec2::zeros());
        self.ids.resize(positions.len(), 0);
        for (id, &cell) in self.cell_of.iter().enumerate().rev() {
            let slot = &mut self.starts[cell as usize];
            *slot -= 1;
            let index = *slot as usize;
            self.positions[index] = positions[id];
            self.velocities[index] = velocities[id];
            self.ids[index] = id as u32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn found(grid: &Grid, centre: Vec2, elapsed: f64, range: f64) -> Vec<(u32, Vec2)> {
        let mut found = Vec::new();
        grid.for_each_within(centre, elapsed, range, |id, place| found.push((id, place)));
        found
    }

    fn vectors(limit: f64, count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Vec2>> {
        prop::collection::vec((-limit..limit, -limit..limit).prop_map(|(x, y)| Vec2::new(x, y)), count)
    }

    #[test]
    fn an_empty_grid_finds_nothing() {
        let mut grid = Grid::new(1.0);
        assert!(found(&grid, Vec2::zeros(), 0.0, 5.0).is_empty());
        grid.rebuild(&[], &[]);
        assert!(found(&grid, Vec2::zeros(), 0.0, 5.0).is_empty());
    }

    #[test]
    fn the_rim_of_the_range_is_within_it() {
        let mut grid = Grid::new(0.5);
        grid.rebuild(
            &[Vec2::new(2.0, 0.0), Vec2::new(0.0, -2.000_000_01)],
            &[Vec2::zeros(); 2],
        );
        assert_eq!(found(&grid, Vec2::zeros(), 0.0, 2.0), [(0, Vec2::new(2.0, 0.0))]);
    }

    #[test]
    fn few_points_far_apart_are_given_few_cells() {
        let mut grid = Grid::new(0.01);
        let positions = [
            Vec2::new(-500.0, -500.0),
            Vec2::new(500.0, 500.0),
            Vec2::new(500.0, -500.0),
        ];
        grid.rebuild(&positions, &[Vec2::zeros(); 3]);
        assert!(grid.starts.len() <= 3 * CELLS_PER_POINT + 1);
    }

    proptest! {
        #[test]
        fn a_search_finds_what_brute_force_finds_each_once(
            positions in vectors(5.0, 1..150),
            speeds in vectors(3.0, 150..151),
            cell in 0.05..4.0_f64, range in 0.0..4.0_f64, elapsed in 0.0..0.5_f64,
            centre in (-6.0..6.0_f64, -6.0..6.0_f64),
        ) {
            let centre = Vec2::new(centre.0, centre.1);
            let velocities = &speeds[..positions.len()];
            let mut grid = Grid::new(cell);
            grid.rebuild(&positions, velocities);
            let mut found = found(&grid, centre, elapsed, range);
            found.sort_by_key(|&(id, _)| id);
            let brute: Vec<_> = (0..positions.len())
                .map(|id| (id as u32, positions[id] + velocities[id] * elapsed))
                .filter(|(_, place)| (place - centre).norm_squared() <= at_most(range).powi(2))
                .collect();
            prop_assert_eq!(found, brute);
        }
    }
}
