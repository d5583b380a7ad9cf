//! Tables of numbers that may outgrow memory: filled row by row, read column by column.

use super::{Scratch, Spool};

/// Rows of a block, the unit in which a column is written and read.
const BLOCK: usize = 1 << 12;

/// A table of numbers. Its latest rows are in memory; the earlier ones are in a file without a name, a column of so many rows after another, so
/// that a column is read without the others.
///
/// ```
/// use desim::spool::{Columns, Scratch};
///
/// let mut table = Columns::new(2, &Scratch::default());
/// for number in 0..10_000 {
///     table.push([f64::from(number), 0.5 * f64::from(number)]);
/// }
/// assert_eq!((table.len(), table.column(1)[9_999]), (10_000, 4_999.5));
/// ```
#[derive(Clone, Debug)]
pub struct Columns {
    /// Of the rows that fill a block: its columns, then those of the next block.
    blocks: Spool<Vec<f64>>,
    /// The rows after them, column by column.
    open: Vec<Vec<f64>>,
}

impl Columns {
    /// A table with so many columns and no row yet, whose file would be in the folder of `scratch`.
    #[must_use]
    pub fn new(columns: usize, scratch: &Scratch) -> Self {
        Self {
            blocks: Spool::new(scratch),
            open: vec![Vec::new(); columns],
        }
    }

    /// How many rows there are.
    #[must_use]
    pub fn len(&self) -> usize {
        let width = self.open.len().max(1);
        self.blocks.len() / width * BLOCK + self.open.first().map_or(0, Vec::len)
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds a row.
    ///
    /// # Panics
    /// If it has not a number for each column.
    pub fn push(&mut self, row: impl IntoIterator<Item = f64>) {
        let rows = self.open.first().map_or(0, Vec::len) + 1;
        let mut row = row.into_iter();
        for column in &mut self.open {
            column.extend(row.next());
        }
        let fits = row.next().is_none() && self.open.iter().all(|column| column.len() == rows);
        assert!(fits, "a row has a number for each of {} columns", self.open.len());
        if rows == BLOCK {
            for column in &mut self.open {
                self.blocks.push(column);
                column.clear();
            }
        }
    }

    /// The numbers of column number `place`, from 0, in order of rows.
    ///
    /// # Panics
    /// If there is no such column, or the file cannot be read.
    #[must_use]
    pub fn column(&self, place: usize) -> Vec<f64> {
        let open = &self.open[place];
        let mut numbers = Vec::with_capacity(self.len());
        for block in (place..self.blocks.len()).step_by(self.open.len()) {
            numbers.extend(self.blocks.get(block).into_iter().flatten());
        }
        numbers.extend(open);
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_read_as_they_were_filled_at_every_length_around_a_block_and_far_beyond_memory() {
        for rows in [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 60 * BLOCK + 7] {
            let mut table = Columns::new(3, &Scratch::default());
            let number = |row: usize, column: usize| (row * 3 + column) as f64;
            for row in 0..rows {
                table.push([0, 1, 2].map(|column| number(row, column)));
            }
            assert_eq!((table.len(), table.is_empty()), (rows, rows == 0));
            for column in [2, 0, 1] {
                let expected: Vec<f64> = (0..rows).map(|row| number(row, column)).collect();
                assert!(table.column(column) == expected, "column {column} of {rows} rows");
            }
            let in_memory = table.blocks.tail.len() + 8 * table.open.iter().map(Vec::capacity).sum::<usize>();
            assert!(in_memory < 5 << 20, "{in_memory} bytes of {rows} rows");
        }
    }

    #[test]
    fn a_table_without_columns_has_no_rows() {
        assert!(Columns::new(0, &Scratch::default()).is_empty());
    }

    #[test]
    #[should_panic(expected = "a row has a number for each of 2 columns")]
    fn rows_of_another_length_are_refused() {
        Columns::new(2, &Scratch::default()).push([1.0, 2.0, 3.0]);
    }
}
