//! A Parquet file read back by the names and types of its columns, a stretch of rows at a time.

use std::cell::RefCell;
use std::collections::{BTreeMap, VecDeque};

use parquet::basic::Type as Physical;
use parquet::data_type::{ByteArrayType, DataType, DoubleType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::reader::FileReader;

use super::chunks::Chunks;
use super::column::{Levels, Parquet, Reading};
use crate::spool::Section;

/// What is wrong with a table, in words.
pub type Wrong = String;

/// Rows that are read at a time, at most: a trial may have more than memory holds.
const MOST_ROWS: usize = 1 << 14;
/// Numbers of trials that are looked at ahead.
const AHEAD: usize = 1 << 10;
/// The column by whose order rows are read.
const TRIAL: &str = "trial";

/// A table in order of trials, and the stretch of its rows that is at hand: at first none.
pub struct Table {
    reader: Parquet,
    /// The first of the rows at hand, from 0, and how many they are.
    first: usize,
    rows: usize,
    /// The numbers of the trials of the rows to come.
    ahead: VecDeque<u32>,
    looking: Reading,
    /// How far columns are read, by their places.
    columns: RefCell<BTreeMap<usize, Reading>>,
}

impl Table {
    /// The table in a file.
    ///
    /// # Errors
    /// If it is no Parquet file.
    pub fn new(file: &Section) -> Result<Self, Wrong> {
        let chunks = Chunks::of(file).map_err(ParquetError::from);
        let reader = chunks.and_then(Parquet::new);
        let reader = reader.map_err(|error| format!("no Parquet file: {error}"))?;
        Ok(Self {
            reader,
            first: 0,
            rows: 0,
            ahead: VecDeque::new(),
            looking: Reading::default(),
            columns: RefCell::default(),
        })
    }

    /// Goes on to the next rows of trials up to `trial`: to all of them, or so many as are read at a time. False if there are none.
    ///
    /// # Errors
    /// If it does not say of which trials its rows are.
    pub fn advance(&mut self, trial: u32) -> Result<bool, Wrong> {
        self.first += self.rows;
        self.rows = 0;
        while self.rows < MOST_ROWS && self.next_trial()?.is_some_and(|next| next <= trial) {
            self.ahead.pop_front();
            self.rows += 1;
        }
        Ok(self.rows > 0)
    }

    /// Goes on to the next row. False if there is none.
    ///
    /// # Errors
    /// As of [`advance`](Self::advance).
    pub fn advance_by_one(&mut self) -> Result<bool, Wrong> {
        self.first += self.rows;
        self.rows = usize::from(self.next_trial()?.is_some());
        self.ahead.pop_front();
        Ok(self.rows > 0)
    }

    /// The trial of the first row after those at hand, if there is one.
    ///
    /// # Errors
    /// As of [`advance`](Self::advance).
    pub fn next_trial(&mut self) -> Result<Option<u32>, Wrong> {
        if self.ahead.is_empty() {
            let place = self.place_of::<Int32Type>(TRIAL)?;
            let rows = AHEAD.min(self.len() - self.looking.at);
            let mut levels = Levels::default();
            let read = self.looking.read::<Int32Type>(&self.reader, place, rows, &mut levels);
            read.map_err(|error| unreadable(TRIAL, &error))?;
            let numbers = levels.values.into_iter().map(|value| unsigned(TRIAL, value));
            self.ahead = numbers.collect::<Result<_, _>>()?;
        }
        Ok(self.ahead.front().copied())
    }

    /// How many rows there are in all.
    fn len(&self) -> usize {
        usize::try_from(self.reader.metadata().file_metadata().num_rows()).unwrap_or(0)
    }

    /// Whether there is such a column.
    pub fn has(&self, name: &str) -> bool {
        self.place(name).is_some()
    }

    /// Numbers of trials, robots and targets, and other small counts.
    ///
    /// # Errors
    /// If there is no such column, or it is of another type, or it has nulls where none belong. So also below.
    pub fn ids(&self, name: &str) -> Result<Vec<u32>, Wrong> {
        whole(name, self.optional_ids(name)?)
    }

    /// Such numbers, some of them missing.
    pub fn optional_ids(&self, name: &str) -> Result<Vec<Option<u32>>, Wrong> {
        let rows = self.optional::<Int32Type>(name)?;
        rows.into_iter()
            .map(|value| value.map(|value| unsigned(name, value)).transpose())
            .collect()
    }

    /// Counts.
    pub fn counts(&self, name: &str) -> Result<Vec<u64>, Wrong> {
        whole(name, self.optional_counts(name)?)
    }

    /// Counts, some of them missing.
    pub fn optional_counts(&self, name: &str) -> Result<Vec<Option<u64>>, Wrong> {
        let rows = self.optional::<Int64Type>(name)?;
        rows.into_iter()
            .map(|value| value.map(|value| counted(name, value)).transpose())
            .collect()
    }

    /// Numbers that use all of 64 bits.
    pub fn keys(&self, name: &str) -> Result<Vec<u64>, Wrong> {
        whole(name, self.optional_keys(name)?)
    }

    /// Such numbers, some of them missing.
    pub fn optional_keys(&self, name: &str) -> Result<Vec<Option<u64>>, Wrong> {
        let rows = self.optional::<Int64Type>(name)?;
        Ok(rows.into_iter().map(|value| value.map(i64::cast_unsigned)).collect())
    }

    /// Double-precision numbers.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>, Wrong> {
        whole(name, self.optional_numbers(name)?)
    }

    /// Double-precision numbers, some of them missing.
    pub fn optional_numbers(&self, name: &str) -> Result<Vec<Option<f64>>, Wrong> {
        self.optional::<DoubleType>(name)
    }

    /// Text.
    pub fn texts(&self, name: &str) -> Result<Vec<String>, Wrong> {
        whole(name, self.optional_texts(name)?)
    }

    /// Text, some of it missing.
    pub fn optional_texts(&self, name: &str) -> Result<Vec<Option<String>>, Wrong> {
        let rows = self.optional::<ByteArrayType>(name)?;
        let text = |bytes: parquet::data_type::ByteArray| {
            String::from_utf8(bytes.data().to_vec()).map_err(|_| format!("column `{name}` holds what is no text"))
        };
        rows.into_iter().map(|value| value.map(text).transpose()).collect()
    }

    /// Lists of small numbers.
    pub fn lists(&self, name: &str) -> Result<Vec<Vec<u32>>, Wrong> {
        self.lists_of::<Int32Type, _>(name, |value| unsigned(name, value))
    }

    /// Lists of double-precision numbers.
    pub fn lists_of_numbers(&self, name: &str) -> Result<Vec<Vec<f64>>, Wrong> {
        self.lists_of::<DoubleType, _>(name, Ok)
    }

    /// Lists of counts.
    pub fn lists_of_counts(&self, name: &str) -> Result<Vec<Vec<u64>>, Wrong> {
        self.lists_of::<Int64Type, _>(name, |value| counted(name, value))
    }

    fn lists_of<T: DataType, U>(
        &self,
        name: &str,
        read: impl Fn(T::T) -> Result<U, Wrong>,
    ) -> Result<Vec<Vec<U>>, Wrong> {
        let Levels {
            values,
            present,
            continued,
        } = self.levels::<T>(name)?;
        let mut values = values.into_iter();
        let mut rows: Vec<Vec<U>> = Vec::new();
        for (present, continued) in present.into_iter().zip(continued) {
            if continued == 0 {
                rows.push(Vec::new());
            }
            if let (1.., Some(row)) = (present, rows.last_mut()) {
                let value = values.next().ok_or_else(|| format!("its column `{name}` has gaps"))?;
                row.push(read(value)?);
            }
        }
        Ok(rows)
    }

    /// A value or none for each row.
    fn optional<T: DataType>(&self, name: &str) -> Result<Vec<Option<T::T>>, Wrong> {
        let Levels { values, present, .. } = self.levels::<T>(name)?;
        if present.is_empty() {
            return Ok(values.into_iter().map(Some).collect());
        }
        let mut values = values.into_iter();
        let rows = present
            .into_iter()
            .map(|present| if present > 0 { values.next() } else { None });
        Ok(rows.collect())
    }

    /// The place among the leaves of the schema of the column `name`, which is one value or a list.
    fn place(&self, name: &str) -> Option<usize> {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        let is_it = |column: &parquet::schema::types::ColumnDescPtr| {
            column.path().parts().first().is_some_and(|part| part == name)
        };
        schema.columns().iter().position(is_it)
    }

    /// The place of the column `name`, which must be of this type.
    fn place_of<T: DataType>(&self, name: &str) -> Result<usize, Wrong> {
        let place = self.place(name).ok_or_else(|| format!("it has no column `{name}`"))?;
        let schema = self.reader.metadata().file_metadata().schema_descr();
        let there: Physical = schema.column(place).physical_type();
        if there == T::get_physical_type() {
            return Ok(place);
        }
        let wanted = T::get_physical_type();
        Err(format!("its column `{name}` is of type {there}, not {wanted}"))
    }

    /// The rows at hand of the column `name`.
    fn levels<T: DataType>(&self, name: &str) -> Result<Levels<T::T>, Wrong> {
        let place = self.place_of::<T>(name)?;
        let mut columns = self.columns.borrow_mut();
        let column = columns.entry(place).or_default();
        if column.at > self.first {
            *column = Reading::default();
        }
        let mut levels = Levels::default();
        column
            .skip::<T>(&self.reader, place, self.first)
            .and_then(|()| column.read::<T>(&self.reader, place, self.rows, &mut levels))
            .map_err(|error| unreadable(name, &error))?;
        Ok(levels)
    }
}

fn unreadable(name: &str, error: &ParquetError) -> Wrong {
    format!("its column `{name}` cannot be read: {error}")
}

fn unsigned(name: &str, value: i32) -> Result<u32, Wrong> {
    u32::try_from(value).map_err(|_| format!("column `{name}` holds the number {value}"))
}

fn counted(name: &str, value: i64) -> Result<u64, Wrong> {
    u64::try_from(value).map_err(|_| format!("column `{name}` holds the count {value}"))
}

/// Values of which none may be missing.
fn whole<T>(name: &str, rows: Vec<Option<T>>) -> Result<Vec<T>, Wrong> {
    let values: Option<Vec<T>> = rows.into_iter().collect();
    values.ok_or_else(|| format!("its column `{name}` has gaps"))
}
