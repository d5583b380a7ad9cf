//! A Parquet file as a list of columns over rows of one type.
//!
//! The files hold nothing but their rows: no time of creation, no name of a machine, a fixed writer name. The same
//! rows give the same bytes.

use std::borrow::Cow;
use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, ConvertedType, Encoding, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::{WriterProperties, WriterPropertiesPtr};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};

/// Rows that are held in memory before they are written as a row group.
const ROW_GROUP_ROWS: usize = 1 << 18;

/// A column: its name, and how its value is read off a row.
pub struct Column<R> {
    name: Cow<'static, str>,
    value: Value<R>,
}

type Get<R, T> = Box<dyn Fn(&R) -> T + Send>;

/// How a column's value is read off a row. Ids and counts are signed in the file, because R and others know no unsigned
/// numbers; none of them reaches so far.
enum Value<R> {
    Id(Get<R, u32>),
    OptionalId(Get<R, Option<u32>>),
    Count(Get<R, u64>),
    OptionalCount(Get<R, Option<u64>>),
    Key(Get<R, u64>),
    OptionalKey(Get<R, Option<u64>>),
    F32(Get<R, f32>),
    F64(Get<R, f64>),
    OptionalF64(Get<R, Option<f64>>),
    Text(Get<R, Cow<'static, str>>),
    OptionalText(Get<R, Option<Cow<'static, str>>>),
    ListOfIds(Get<R, Vec<u32>>),
    ListOfF64(Get<R, Vec<f64>>),
    ListOfCounts(Get<R, Vec<u64>>),
}

/// Declares a constructor of [`Column`] for each type of value.
macro_rules! constructors {
    ($($(#[$docs:meta])* $function:ident, $variant:ident, $type:ty;)*) => {
        impl<R> Column<R> {
            $($(#[$docs])*
            pub fn $function(name: impl Into<Cow<'static, str>>, get: impl Fn(&R) -> $type + Send + 'static) -> Self {
                Self { name: name.into(), value: Value::$variant(Box::new(get)) }
            })*
        }
    };
}

constructors! {
    /// Numbers of trials, robots and targets, and other small counts.
    id, Id, u32;
    /// Such numbers, null where there is none.
    optional_id, OptionalId, Option<u32>;
    /// Counts.
    count, Count, u64;
    /// Counts, null where there is none.
    optional_count, OptionalCount, Option<u64>;
    /// Numbers that use all of 64 bits.
    key, Key, u64;
    /// Such numbers, null where there is none.
    optional_key, OptionalKey, Option<u64>;
    /// Single-precision numbers.
    f32, F32, f32;
    /// Double-precision numbers.
    f64, F64, f64;
    /// Double-precision numbers, null where there is none.
    optional_f64, OptionalF64, Option<f64>;
    /// Text.
    text, Text, Cow<'static, str>;
    /// Text, null where there is none.
    optional_text, OptionalText, Option<Cow<'static, str>>;
    /// Lists of small numbers.
    list_of_ids, ListOfIds, Vec<u32>;
    /// Lists of double-precision numbers.
    list_of_f64, ListOfF64, Vec<f64>;
    /// Lists of counts.
    list_of_counts, ListOfCounts, Vec<u64>;
}

/// A Parquet file being written.
pub struct Table<R> {
    columns: Vec<Column<R>>,
    rows: Vec<R>,
    writer: SerializedFileWriter<File>,
}

impl<R> Table<R> {
    /// Starts the file `path`.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn create(path: &Path, columns: Vec<Column<R>>) -> io::Result<Self> {
        let fields = columns
            .iter()
            .map(Column::field)
            .collect::<Result<_, _>>()
            .map_err(into_io)?;
        let schema = Type::group_type_builder("desim")
            .with_fields(fields)
            .build()
            .map_err(into_io)?;
        let writer =
            SerializedFileWriter::new(File::create(path)?, Arc::new(schema), properties(&columns)?).map_err(into_io)?;
        Ok(Self {
            columns,
            rows: Vec::new(),
            writer,
        })
    }

    /// Adds rows.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn extend(&mut self, rows: impl IntoIterator<Item = R>) -> io::Result<()> {
        for row in rows {
            self.rows.push(row);
            if self.rows.len() == ROW_GROUP_ROWS {
                self.write_row_group()?;
            }
        }
        Ok(())
    }

    /// Writes what is left and ends the file.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(mut self) -> io::Result<()> {
        if !self.rows.is_empty() {
            self.write_row_group()?;
        }
        self.writer.close().map(|_| ()).map_err(into_io)
    }

    fn write_row_group(&mut self) -> io::Result<()> {
        let mut group = self.writer.next_row_group().map_err(into_io)?;
        for column in &self.columns {
            column.write(&self.rows, &mut group).map_err(into_io)?;
        }
        group.close().map_err(into_io)?;
        self.rows.clear();
        Ok(())
    }
}

impl<R> Column<R> {
    /// The column in the file's schema.
    fn field(&self) -> Result<TypePtr, ParquetError> {
        let leaf = |name: &str, physical, repetition, logical| {
            let builder = Type::primitive_type_builder(name, physical).with_repetition(repetition);
            builder.with_logical_type(logical).build().map(Arc::new)
        };
        let unsigned = Some(LogicalType::integer(64, false));
        let name = self.name.as_ref();
        match self.value {
            Value::Id(_) => leaf(name, Physical::INT32, Repetition::REQUIRED, None),
            Value::OptionalId(_) => leaf(name, Physical::INT32, Repetition::OPTIONAL, None),
            Value::Count(_) => leaf(name, Physical::INT64, Repetition::REQUIRED, None),
            Value::OptionalCount(_) => leaf(name, Physical::INT64, Repetition::OPTIONAL, None),
            Value::Key(_) => leaf(name, Physical::INT64, Repetition::REQUIRED, unsigned),
            Value::OptionalKey(_) => leaf(name, Physical::INT64, Repetition::OPTIONAL, unsigned),
            Value::F32(_) => leaf(name, Physical::FLOAT, Repetition::REQUIRED, None),
            Value::F64(_) => leaf(name, Physical::DOUBLE, Repetition::REQUIRED, None),
            Value::OptionalF64(_) => leaf(name, Physical::DOUBLE, Repetition::OPTIONAL, None),
            Value::Text(_) => leaf(
                name,
                Physical::BYTE_ARRAY,
                Repetition::REQUIRED,
                Some(LogicalType::String),
            ),
            Value::OptionalText(_) => leaf(
                name,
                Physical::BYTE_ARRAY,
                Repetition::OPTIONAL,
                Some(LogicalType::String),
            ),
            Value::ListOfIds(_) | Value::ListOfF64(_) | Value::ListOfCounts(_) => {
                let physical = match self.value {
                    Value::ListOfF64(_) => Physical::DOUBLE,
                    Value::ListOfCounts(_) => Physical::INT64,
                    _ => Physical::INT32,
                };
                let element = leaf("element", physical, Repetition::REQUIRED, None)?;
                let list = Type::group_type_builder("list").with_repetition(Repetition::REPEATED);
                let list = list.with_fields(vec![element]).build()?;
                let outer = Type::group_type_builder(name).with_repetition(Repetition::REQUIRED);
                let outer = outer
                    .with_logical_type(Some(LogicalType::List))
                    .with_converted_type(ConvertedType::LIST);
                outer.with_fields(vec![Arc::new(list)]).build().map(Arc::new)
            }
        }
    }

    /// Writes the column's values of `rows` as the group's next column.
    fn write(&self, rows: &[R], group: &mut SerializedRowGroupWriter<'_, File>) -> Result<(), ParquetError> {
        match &self.value {
            Value::Id(get) => required::<Int32Type, _>(group, rows.iter().map(|row| get(row).cast_signed())),
            Value::OptionalId(get) => {
                optional::<Int32Type, _>(group, rows.iter().map(|row| get(row).map(u32::cast_signed)))
            }
            Value::OptionalCount(get) | Value::OptionalKey(get) => {
                optional::<Int64Type, _>(group, rows.iter().map(|row| get(row).map(u64::cast_signed)))
            }
            Value::Count(get) | Value::Key(get) => {
                required::<Int64Type, _>(group, rows.iter().map(|row| get(row).cast_signed()))
            }
            Value::F32(get) => required::<FloatType, _>(group, rows.iter().map(get)),
            Value::F64(get) => required::<DoubleType, _>(group, rows.iter().map(get)),
            Value::OptionalF64(get) => optional::<DoubleType, _>(group, rows.iter().map(get)),
            Value::Text(get) => required::<ByteArrayType, _>(group, rows.iter().map(|row| text(get(row)))),
            Value::OptionalText(get) => optional::<ByteArrayType, _>(group, rows.iter().map(|row| get(row).map(text))),
            Value::ListOfIds(get) => list::<Int32Type, _>(group, rows.iter().map(|row| signed(get(row)))),
            Value::ListOfF64(get) => list::<DoubleType, _>(group, rows.iter().map(get)),
            Value::ListOfCounts(get) => {
                let signed = |row| get(row).into_iter().map(u64::cast_signed).collect();
                list::<Int64Type, _>(group, rows.iter().map(signed))
            }
        }
    }
}

fn signed(ids: Vec<u32>) -> Vec<i32> {
    ids.into_iter().map(u32::cast_signed).collect()
}

fn text(text: Cow<'static, str>) -> ByteArray {
    match text {
        Cow::Borrowed(text) => ByteArray::from(text),
        Cow::Owned(text) => ByteArray::from(text.into_bytes()),
    }
}

type Group<'a> = SerializedRowGroupWriter<'a, File>;

/// Values that are always there.
fn required<D: DataType, I: Iterator<Item = D::T>>(group: &mut Group<'_>, values: I) -> Result<(), ParquetError> {
    write_levels::<D>(group, &values.collect::<Vec<_>>(), None, None)
}

/// Values that may be null: level 1 says that a row has one.
fn optional<D: DataType, I: Iterator<Item = Option<D::T>>>(group: &mut Group<'_>, rows: I) -> Result<(), ParquetError> {
    let (mut values, mut present) = (Vec::new(), Vec::new());
    for value in rows {
        present.push(i16::from(value.is_some()));
        values.extend(value);
    }
    write_levels::<D>(group, &values, Some(&present), None)
}

/// Lists: definition level 1 says that there is an element, repetition level 1 that it belongs to the list before.
fn list<D: DataType, I: Iterator<Item = Vec<D::T>>>(group: &mut Group<'_>, rows: I) -> Result<(), ParquetError> {
    let (mut values, mut present, mut continued) = (Vec::new(), Vec::new(), Vec::new());
    for row in rows {
        present.extend(std::iter::repeat_n(1, row.len()).chain(row.is_empty().then_some(0)));
        continued.extend((0..row.len().max(1)).map(|index| i16::from(index > 0)));
        values.extend(row);
    }
    write_levels::<D>(group, &values, Some(&present), Some(&continued))
}

fn write_levels<D: DataType>(
    group: &mut Group<'_>,
    values: &[D::T],
    definition: Option<&[i16]>,
    repetition: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let mut column = group.next_column()?.expect("the schema was made of the same columns");
    column.typed::<D>().write_batch(values, definition, repetition)?;
    column.close()
}

/// Fixed for given columns. Single-precision columns hold positions, which seldom repeat: a dictionary would only
/// cost, while their bytes, split by significance, compress well.
fn properties<R>(columns: &[Column<R>]) -> io::Result<WriterPropertiesPtr> {
    let level = ZstdLevel::try_new(3).map_err(into_io)?;
    let mut builder = WriterProperties::builder()
        .set_created_by(concat!("desim ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_compression(Compression::ZSTD(level));
    for column in columns.iter().filter(|column| matches!(column.value, Value::F32(_))) {
        let path = parquet::schema::types::ColumnPath::from(column.name.as_ref());
        builder = builder
            .set_column_dictionary_enabled(path.clone(), false)
            .set_column_encoding(path, Encoding::BYTE_STREAM_SPLIT);
    }
    Ok(Arc::new(builder.build()))
}

fn into_io(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}
