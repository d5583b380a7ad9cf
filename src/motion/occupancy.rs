//! Places already taken, while robots are deployed one by one.

use crate::geometry::Vec2;

const END: u32 = u32::MAX;

/// Points at least a given distance apart, over a rectangle around the origin. Its cells are no smaller than that
/// distance, so a conflict is found within the nine cells around a place.
pub(super) struct Occupancy {
    half: Vec2,
    distance: f64,
    cell: f64,
    columns: usize,
    rows: usize,
    /// The last point put in each cell.
    heads: Vec<u32>,
    /// For each point, the one put in its cell before it.
    before: Vec<u32>,
    places: Vec<Vec2>,
}

impl Occupancy {
    /// Nothing taken yet, for about `count` points between −`half` and `half` that keep `distance` metres apart.
    pub(super) fn new(half: Vec2, distance: f64, count: usize) -> Self {
        let share = (4.0 * half.x * half.y / count.max(1) as f64).sqrt();
        let longest = 2.0 * half.max() / (count.max(1) as f64);
        let cell = distance.max(share).max(longest);
        let (columns, rows) = ((2.0 * half.x / cell) as usize + 1, (2.0 * half.y / cell) as usize + 1);
        Self {
            half,
            distance,
            cell,
            columns,
            rows,
            heads: vec![END; columns * rows],
            before: Vec::with_capacity(count),
            places: Vec::with_capacity(count),
        }
    }

    /// The point, by order of taking, that is too near to `place`.
    pub(super) fn conflict(&self, place: Vec2) -> Option<u32> {
        let (column, row) = self.cell(place);
        let columns = column.saturating_sub(1)..=(column + 1).min(self.columns - 1);
        let mut rows = row.saturating_sub(1)..=(row + 1).min(self.rows - 1);
        rows.find_map(|row| {
            columns
                .clone()
                .find_map(|column| self.conflict_in(row * self.columns + column, place))
        })
    }

    /// Takes `place` for the next point.
    pub(super) fn take(&mut self, place: Vec2) {
        let (column, row) = self.cell(place);
        let head = &mut self.heads[row * self.columns + column];
        self.before.push(*head);
        *head = self.places.len() as u32;
        self.places.push(place);
    }

    /// The places taken, in order.
    pub(super) fn into_places(self) -> Vec<Vec2> {
        self.places
    }

    fn conflict_in(&self, cell: usize, place: Vec2) -> Option<u32> {
        let mut point = self.heads[cell];
        while point != END {
            if (self.places[point as usize] - place).norm() < self.distance {
                return Some(point);
            }
            point = self.before[point as usize];
        }
        None
    }

    fn cell(&self, place: Vec2) -> (usize, usize) {
        let column = (place.x + self.half.x) / self.cell;
        let row = (place.y + self.half.y) / self.cell;
        (
            (column as usize).min(self.columns - 1),
            (row as usize).min(self.rows - 1),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_conflict_is_found_exactly_where_brute_force_finds_one(
            points in prop::collection::vec((-3.0..3.0_f64, -1.0..1.0_f64), 1..80),
            distance in 0.01..1.0_f64,
        ) {
            let mut occupancy = Occupancy::new(Vec2::new(3.0, 1.0), distance, 40);
            let mut taken: Vec<Vec2> = Vec::new();
            for (x, y) in points {
                let place = Vec2::new(x, y);
                let brute = taken.iter().any(|other| (other - place).norm() < distance);
                prop_assert_eq!(occupancy.conflict(place).is_some(), brute);
                occupancy.take(place);
                taken.push(place);
            }
            prop_assert_eq!(occupancy.into_places(), taken);
        }
    }
}
