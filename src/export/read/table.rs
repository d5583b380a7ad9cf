//! A Parquet file read back by the names and types of its columns.

use std::fs::File;

use parquet::basic::Type as Physical;
use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::{ByteArrayType, DataType, DoubleType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};

/// What is wrong with a table, in words.
pub type Wrong = String;

/// A group of a table's rows.
pub struct Table {
    reader: SerializedFileReader<File>,
    /// Number of the group.
    group: usize,
}

/// A column as the file holds it: values where there are some, and for each row and place in a list whether it has one
/// and whether it goes on with the list before.
struct Levels<T> {
    values: Vec<T>,
    present: Vec<i16>,
    continued: Vec<i16>,
}

impl Table {
    /// The first rows of the table in a file.
    ///
    /// # Errors
    /// If it is no Parquet file.
    pub fn new(file: File) -> Result<Self, Wrong> {
        SerializedFileReader::new(file)
            .map(|reader| Self { reader, group: 0 })
            .map_err(|error| format!("no Parquet file: {error}"))
    }

    /// Goes on to the next rows; false if there are none.
    pub fn advance(&mut self) -> bool {
        self.group += 1;
        self.group < self.reader.num_row_groups()
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

    fn levels<T: DataType>(&self, name: &str) -> Result<Levels<T::T>, Wrong> {
        let place = self.place(name).ok_or_else(|| format!("it has no column `{name}`"))?;
        let schema = self.reader.metadata().file_metadata().schema_descr();
        let there: Physical = schema.column(place).physical_type();
        if there != T::get_physical_type() {
            let wanted = T::get_physical_type();
            return Err(format!("its column `{name}` is of type {there}, not {wanted}"));
        }
        let mut levels = Levels {
            values: Vec::new(),
            present: Vec::new(),
            continued: Vec::new(),
        };
        self.fill::<T>(place, &mut levels)
            .map_err(|error| format!("its column `{name}` cannot be read: {error}"))?;
        Ok(levels)
    }

    fn fill<T: DataType>(&self, place: usize, into: &mut Levels<T::T>) -> Result<(), ParquetError> {
        // A table without rows has no groups.
        if self.group >= self.reader.num_row_groups() {
            return Ok(());
        }
        let group = self.reader.get_row_group(self.group)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        let mut column = get_typed_column_reader::<T>(group.get_column_reader(place)?);
        let mut read = 0;
        while read < rows {
            let (records, _, _) = column.read_records(
                rows - read,
                Some(&mut into.present),
                Some(&mut into.continued),
                &mut into.values,
            )?;
            if records == 0 {
                return Err(ParquetError::EOF(format!("{read} rows instead of {rows}")));
            }
            read += records;
        }
        Ok(())
    }
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
