//! Tables as Parquet.
//!
//! Rows as text go through a piece of at most [`GROUP`] rows into row groups; only this piece is in memory. Every row group but the last has exactly
//! [`GROUP`] rows. The bytes of a file therefore depend on its rows alone: a merged table is, byte for byte, the table of the whole sweep.
//!
//! Tables that other programs have written are read as well, whatever the types of their columns.

use super::column::{Column, Kind, Rows};
use csv::StringRecord;
use parquet::basic::{Encoding, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::record::{Field, Row};
use parquet::schema::types::{ColumnPath, Type};
use rocking::scene_file::Setting;
use std::fs::File;
use std::io::{Error, ErrorKind, Result, Write};
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::sync::Arc;

/// Rows of a row group. Larger groups take more memory (some ten megabytes at this size). Smaller groups make files larger and slower to
/// read. A change of this number changes the bytes of files.
const GROUP: usize = 1 << 16;

/// All types of columns.
const KINDS: [Kind; 4] = [Kind::Whole, Kind::Number, Kind::Truth, Kind::Text];

/// Rows held as columns.
struct Piece {
    columns: Vec<Cells>,
    rows: usize,
}

enum Cells {
    Whole(Values<Int64Type>),
    Number(Values<DoubleType>),
    Truth(Values<BoolType>),
    Text(Values<ByteArrayType>),
}

/// The values of a column, without its blanks.
struct Values<T: DataType> {
    values: Vec<T::T>,
    /// Definition level of each row: 1 for a value, 0 for a blank. `None` for a column without blanks.
    levels: Option<Vec<i16>>,
}

impl<T: DataType> Values<T> {
    fn new(column: &Column) -> Values<T> {
        Values { values: Vec::new(), levels: column.may_be_blank.then(Vec::new) }
    }

    /// Takes a cell of CSV. `None` if it is no value of the column.
    fn push(&mut self, cell: &str, read: impl Fn(&str) -> Option<T::T>) -> Option<()> {
        if let Some(levels) = &mut self.levels {
            levels.push(i16::from(!cell.is_empty()));
            if cell.is_empty() {
                return Some(());
            }
        }
        self.values.push(read(cell)?);
        Some(())
    }

    fn write(&mut self, group: &mut SerializedRowGroupWriter<impl Write + Send>) -> Result<()> {
        let mut column = group.next_column()?.expect("a group has the columns of its piece");
        column.typed::<T>().write_batch(&self.values, self.levels.as_deref(), None)?;
        column.close()?;
        self.values.clear();
        self.levels.iter_mut().for_each(Vec::clear);
        Ok(())
    }
}

impl Piece {
    fn new(columns: &[Column]) -> Piece {
        let cells = |column: &Column| match column.kind {
            Kind::Whole => Cells::Whole(Values::new(column)),
            Kind::Number => Cells::Number(Values::new(column)),
            Kind::Truth => Cells::Truth(Values::new(column)),
            Kind::Text => Cells::Text(Values::new(column)),
        };
        Piece { columns: columns.iter().map(cells).collect(), rows: 0 }
    }

    /// Takes a row of CSV.
    fn push(&mut self, row: &StringRecord) -> Result<()> {
        for (cells, cell) in self.columns.iter_mut().zip(row) {
            let taken = match cells {
                Cells::Whole(values) => values.push(cell, |cell| cell.parse().ok()),
                Cells::Number(values) => values.push(cell, |cell| cell.parse().ok()),
                Cells::Truth(values) => values.push(cell, |cell| cell.parse().ok()),
                Cells::Text(values) => values.push(cell, |cell| Some(ByteArray::from(cell))),
            };
            let wrong = || format!("the row of point {} has a cell `{cell}` that is none of its column", &row[0]);
            taken.ok_or_else(|| Error::new(ErrorKind::InvalidData, wrong()))?;
        }
        self.rows += 1;
        Ok(())
    }
}

/// A table being written.
pub struct Writer<W: Write + Send> {
    file: SerializedFileWriter<W>,
    piece: Piece,
}

impl<W: Write + Send> Writer<W> {
    /// A table with these columns.
    pub fn new(file: W, columns: &[Column]) -> Result<Writer<W>> {
        let fields = columns.iter().map(field).collect::<std::result::Result<_, ParquetError>>()?;
        let schema = Type::group_type_builder("schema").with_fields(fields).build()?;
        let mut properties = WriterProperties::builder();
        for column in columns {
            let path = ColumnPath::new(vec![column.name.clone()]);
            // Values of axes repeat: a dictionary stores each of them once. The index counts up: as differences its numbers take a few bits
            // each. Numbers of results hardly repeat, so that they have no dictionary.
            properties = match (column.kind, column.name.as_str()) {
                (_, "index") => properties
                    .set_column_dictionary_enabled(path.clone(), false)
                    .set_column_encoding(path, Encoding::DELTA_BINARY_PACKED),
                (Kind::Number, _) if column.may_be_blank => properties.set_column_dictionary_enabled(path, false),
                _ => properties,
            };
        }
        let file = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties.build()))?;
        Ok(Writer { file, piece: Piece::new(columns) })
    }

    /// Takes a row of CSV. Writes a row group when [`GROUP`] rows have been taken.
    pub fn push(&mut self, row: &StringRecord) -> Result<()> {
        self.piece.push(row)?;
        if self.piece.rows == GROUP { self.write() } else { Ok(()) }
    }

    fn write(&mut self) -> Result<()> {
        let mut group = self.file.next_row_group()?;
        for cells in &mut self.piece.columns {
            match cells {
                Cells::Whole(values) => values.write(&mut group),
                Cells::Number(values) => values.write(&mut group),
                Cells::Truth(values) => values.write(&mut group),
                Cells::Text(values) => values.write(&mut group),
            }?;
        }
        group.close()?;
        self.piece.rows = 0;
        Ok(())
    }

    /// Writes what is left and the end of the file; returns the file.
    pub fn finish(mut self) -> Result<W> {
        if self.piece.rows > 0 {
            self.write()?;
        }
        Ok(self.file.into_inner()?)
    }
}

/// Writes a table of CSV with these columns as Parquet.
pub fn from_csv(csv: &Path, columns: &[Column], file: impl Write + Send) -> Result<()> {
    let mut writer = Writer::new(file, columns)?;
    let unreadable = |error: csv::Error| Error::new(ErrorKind::InvalidData, error);
    let mut reader = csv::Reader::from_path(csv).map_err(unreadable)?;
    let mut row = StringRecord::new();
    while reader.read_record(&mut row).map_err(unreadable)? {
        writer.push(&row)?;
    }
    writer.finish()?.flush()
}

fn field(column: &Column) -> std::result::Result<Arc<Type>, ParquetError> {
    let (physical, logical) = match column.kind {
        Kind::Whole => (Physical::INT64, None),
        Kind::Number => (Physical::DOUBLE, None),
        Kind::Truth => (Physical::BOOLEAN, None),
        Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let repetition = if column.may_be_blank { Repetition::OPTIONAL } else { Repetition::REQUIRED };
    let field = Type::primitive_type_builder(&column.name, physical).with_repetition(repetition);
    field.with_logical_type(logical).build().map(Arc::new)
}

/// The columns of a table that [`Writer`] has written.
pub fn columns(path: &Path) -> Result<Vec<Column>> {
    let column = |field: &Arc<Type>| {
        let name = field.name();
        let kinds = KINDS.map(|kind| [Column::full(name, kind), Column::sparse(name, kind)]);
        let known = kinds.into_iter().flatten().find(|column| self::field(column).is_ok_and(|known| known == *field));
        let unknown = || format!("no table of this program has a column `{name}` of this type");
        known.ok_or_else(|| Error::new(ErrorKind::InvalidData, unknown()))
    };
    let columns: Vec<Column> = schema(&open(path)?).get_fields().iter().map(column).collect::<Result<_>>()?;
    match columns.first() {
        Some(first) if *first == Column::full("index", Kind::Whole) => Ok(columns),
        _ => Err(Error::new(ErrorKind::InvalidData, "its first column is not the index of the points")),
    }
}

/// Rows of a table of any program as text.
pub fn rows(path: &Path) -> Result<Rows> {
    let file = open(path)?;
    let header = schema(&file).get_fields().iter().map(|field| field.name()).collect();
    let mut rows = Some(file.into_iter());
    let next = move || {
        let row = quietly(|| rows.as_mut()?.next()).unwrap_or_else(|| {
            rows = None;
            Some(Err(ParquetError::General("the file is damaged".into())))
        });
        row.map(|row| row.map_err(damage).and_then(|row| texts(&row)))
    };
    Ok(Rows { header, rows: Box::new(std::iter::from_fn(next)) })
}

/// What a function returns; `None` if it panics, as the reader of rows does on some damaged files. Nothing is printed then.
fn quietly<T>(read: impl FnOnce() -> T) -> Option<T> {
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let found = panic::catch_unwind(AssertUnwindSafe(read));
    panic::set_hook(hook);
    found.ok()
}

fn open(path: &Path) -> Result<SerializedFileReader<File>> {
    SerializedFileReader::new(File::open(path)?).map_err(damage)
}

fn schema(file: &SerializedFileReader<File>) -> &Type {
    file.metadata().file_metadata().schema()
}

/// What keeps a file from being read.
fn damage(error: ParquetError) -> Error {
    let text = error.to_string();
    match text.contains("Disabled feature") {
        true => {
            let remedy = "it is compressed in another way than snappy; write it with snappy or without compression";
            Error::new(ErrorKind::InvalidData, remedy)
        }
        false => Error::new(ErrorKind::InvalidData, text),
    }
}

/// Cells as CSV has them: numbers have the text that values of axes have there.
fn texts(row: &Row) -> Result<StringRecord> {
    let text = |(name, field): (&String, &Field)| match field {
        Field::Null => Ok(String::new()),
        Field::Float(value) => Ok(Setting::Number(f64::from(*value)).to_string()),
        Field::Double(value) => Ok(Setting::Number(*value).to_string()),
        Field::Str(text) => Ok(text.clone()),
        Field::Group(_) | Field::ListInternal(_) | Field::MapInternal(_) | Field::Bytes(_) => Err(Error::new(
            ErrorKind::InvalidData,
            format!("a cell of its column `{name}` is no number, text or truth"),
        )),
        // Whole numbers, truths, dates.
        field => Ok(field.to_string()),
    };
    row.get_column_iter().map(text).collect()
}
