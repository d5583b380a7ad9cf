//! A column of a Parquet file, read a stretch of rows at a time.

use std::any::Any;

use parquet::column::reader::{ColumnReaderImpl, get_typed_column_reader};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};

use super::chunks::Chunks;

/// A Parquet file.
pub type Parquet = SerializedFileReader<Chunks>;

/// How far a column is read.
#[derive(Default)]
pub struct Reading {
    /// The next row.
    pub at: usize,
    /// The group of rows after the one that is read.
    next_group: usize,
    /// The column in the group that is read, of the type that it has, and how many of its rows are left.
    column: Option<Box<dyn Any>>,
    left: usize,
}

/// A column as the file holds it: values where there are some, and for each row and place in a list whether it has one
/// and whether it goes on with the list before.
pub struct Levels<T> {
    pub values: Vec<T>,
    pub present: Vec<i16>,
    pub continued: Vec<i16>,
}

impl<T> Default for Levels<T> {
    fn default() -> Self {
        Self {
            values: Vec::new(),
            present: Vec::new(),
            continued: Vec::new(),
        }
    }
}

impl Reading {
    /// Goes on to row `first`.
    pub fn skip<T: DataType>(&mut self, file: &Parquet, place: usize, first: usize) -> Result<(), ParquetError> {
        while self.at < first {
            let wanted = first - self.at;
            let (column, left) = self.group::<T>(file, place)?;
            let skipped = column.skip_records(wanted.min(left))?;
            self.passed(skipped)?;
        }
        Ok(())
    }

    /// Reads the next rows of column number `place`.
    pub fn read<T: DataType>(
        &mut self,
        file: &Parquet,
        place: usize,
        rows: usize,
        into: &mut Levels<T::T>,
    ) -> Result<(), ParquetError> {
        let end = self.at + rows;
        while self.at < end {
            let wanted = end - self.at;
            let (column, left) = self.group::<T>(file, place)?;
            let (present, continued) = (&mut into.present, &mut into.continued);
            let read = column.read_records(wanted.min(left), Some(present), Some(continued), &mut into.values)?;
            self.passed(read.0)?;
        }
        Ok(())
    }

    fn passed(&mut self, rows: usize) -> Result<(), ParquetError> {
        if rows == 0 {
            return Err(ParquetError::EOF(format!("{} rows too few", self.left)));
        }
        self.at += rows;
        self.left -= rows;
        Ok(())
    }

    /// The column in the group that is read, or, if that is at its end, in the next, and how many of its rows are left.
    fn group<T: DataType>(
        &mut self,
        file: &Parquet,
        place: usize,
    ) -> Result<(&mut ColumnReaderImpl<T>, usize), ParquetError> {
        while self.left == 0 {
            if self.next_group == file.num_row_groups() {
                return Err(ParquetError::EOF("its groups have fewer rows than it".to_owned()));
            }
            let group = file.get_row_group(self.next_group)?;
            self.left = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
            self.column = Some(Box::new(get_typed_column_reader::<T>(group.get_column_reader(place)?)));
            self.next_group += 1;
        }
        let column = self.column.as_mut().and_then(|column| column.downcast_mut());
        let column = column.ok_or_else(|| ParquetError::General("it is read as of two types".to_owned()))?;
        Ok((column, self.left))
    }
}
