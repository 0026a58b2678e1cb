//! Tables as Parquet.
//!
//! ```text
//! rows as text ──> Piece ──> Writer ──> row groups of GROUP rows
//!                    ^
//! Reader ────────────┘
//! ```
//!
//! Only one piece, of at most [`GROUP`] rows, is in memory. Every row group but the last has exactly [`GROUP`] rows. The bytes of a file
//! therefore depend on its rows alone: a merged table is, byte for byte, the table of the whole sweep.

use super::column::{Column, Kind, Rows};
use csv::StringRecord;
use parquet::basic::{Encoding, LogicalType, Repetition, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{ColumnPath, Type};
use rocking::scene_file::Setting;
use std::fs::File;
use std::io::{Error, ErrorKind, Result, Write};
use std::path::Path;
use std::sync::Arc;

/// Rows of a row group. Larger groups take more memory (some ten megabytes at this size). Smaller groups make files larger and slower to
/// read. A change of this number changes the bytes of files.
const GROUP: usize = 1 << 16;

/// Largest number of rows held as text at a time: as text, rows take several times the memory.
const MOST_TEXTS: usize = 1 << 12;

/// Rows held as columns.
struct Piece {
    columns: Vec<Cells>,
    rows: usize,
}

enum Cells {
    Whole(Values<Int64Type>),
    Number(Values<DoubleType>),
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

    fn read(&mut self, reader: &mut ColumnReaderImpl<T>, rows: usize) -> Result<()> {
        match reader.read_records(rows, self.levels.as_mut(), None, &mut self.values)?.0 {
            read if read == rows => Ok(()),
            _ => Err(Error::new(ErrorKind::UnexpectedEof, "a column ends before the others")),
        }
    }

    /// A text for each row.
    fn texts(self, show: impl Fn(&T::T) -> Result<String>) -> Result<Vec<String>> {
        let mut values = self.values.iter().map(show);
        match &self.levels {
            None => values.collect(),
            Some(levels) => {
                let cell = |level: &i16| if *level > 0 { values.next() } else { None };
                levels.iter().map(cell).map(|cell| cell.unwrap_or(Ok(String::new()))).collect()
            }
        }
    }
}

impl Piece {
    fn new(columns: &[Column]) -> Piece {
        let cells = |column: &Column| match column.kind {
            Kind::Whole => Cells::Whole(Values::new(column)),
            Kind::Number => Cells::Number(Values::new(column)),
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
                Cells::Text(values) => values.push(cell, |cell| Some(ByteArray::from(cell))),
            };
            let wrong = || format!("the row of point {} has a cell `{cell}` that is no number", &row[0]);
            taken.ok_or_else(|| Error::new(ErrorKind::InvalidData, wrong()))?;
        }
        self.rows += 1;
        Ok(())
    }

    fn texts(self) -> Result<Vec<StringRecord>> {
        let columns = self.columns.into_iter().map(|cells| match cells {
            Cells::Whole(values) => values.texts(|value| Ok(value.to_string())),
            // Numbers have the text that values of axes have in CSV.
            Cells::Number(values) => values.texts(|value| Ok(Setting::Number(*value).to_string())),
            Cells::Text(values) => values.texts(|value| Ok(value.as_utf8()?.to_string())),
        });
        let columns = columns.collect::<Result<Vec<_>>>()?;
        Ok((0..self.rows).map(|row| columns.iter().map(|column| column[row].as_str()).collect()).collect())
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
        Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let repetition = if column.may_be_blank { Repetition::OPTIONAL } else { Repetition::REQUIRED };
    let field = Type::primitive_type_builder(&column.name, physical).with_repetition(repetition);
    field.with_logical_type(logical).build().map(Arc::new)
}

/// A table being read, a group after the other.
pub struct Reader {
    file: SerializedFileReader<File>,
    /// Columns of the table.
    pub columns: Vec<Column>,
    /// Column readers of the row group that is being read.
    group: Vec<ColumnReader>,
    /// Number of rows of this row group that are still to be read.
    left: usize,
    next_group: usize,
}

impl Reader {
    /// Opens a table that [`Writer`] has written.
    pub fn open(path: &Path) -> Result<Reader> {
        let file = SerializedFileReader::new(File::open(path)?)?;
        let schema = file.metadata().file_metadata().schema();
        let column = |field: &Arc<Type>| {
            let name = field.name();
            let kinds = [Kind::Whole, Kind::Number, Kind::Text]
                .map(|kind| [Column::full(name, kind), Column::sparse(name, kind)]);
            let known =
                kinds.into_iter().flatten().find(|column| self::field(column).is_ok_and(|known| known == *field));
            known
                .ok_or_else(|| Error::new(ErrorKind::InvalidData, format!("no table of a sweep has its column {name}")))
        };
        let columns = schema.get_fields().iter().map(column).collect::<Result<Vec<Column>>>()?;
        if columns.first() != Some(&Column::full("index", Kind::Whole)) {
            return Err(Error::new(ErrorKind::InvalidData, "its first column is not the index of the points"));
        }
        Ok(Reader { file, columns, group: Vec::new(), left: 0, next_group: 0 })
    }

    /// Appends up to `most` rows to `piece`, which has the table's columns. Returns their number: 0 at the end of the file.
    fn read(&mut self, piece: &mut Piece, most: usize) -> Result<usize> {
        while self.left == 0 {
            if self.next_group == self.file.num_row_groups() {
                return Ok(0);
            }
            let group = self.file.get_row_group(self.next_group)?;
            self.group = (0..self.columns.len())
                .map(|place| group.get_column_reader(place))
                .collect::<std::result::Result<_, _>>()?;
            self.left = usize::try_from(group.metadata().num_rows()).map_err(Error::other)?;
            self.next_group += 1;
        }
        let rows = self.left.min(most);
        for (cells, reader) in piece.columns.iter_mut().zip(&mut self.group) {
            match (cells, reader) {
                (Cells::Whole(values), ColumnReader::Int64ColumnReader(reader)) => values.read(reader, rows),
                (Cells::Number(values), ColumnReader::DoubleColumnReader(reader)) => values.read(reader, rows),
                (Cells::Text(values), ColumnReader::ByteArrayColumnReader(reader)) => values.read(reader, rows),
                _ => Err(Error::new(ErrorKind::InvalidData, "a column has another type than its schema says")),
            }?;
        }
        piece.rows += rows;
        self.left -= rows;
        Ok(rows)
    }

    /// Rows of the table as text.
    pub fn rows(mut self) -> Rows {
        let header = self.columns.iter().map(|column| column.name.as_str()).collect();
        let pieces = std::iter::from_fn(move || {
            let mut piece = Piece::new(&self.columns);
            match self.read(&mut piece, MOST_TEXTS) {
                Ok(0) => None,
                read => Some(read.and_then(|_| piece.texts())),
            }
        });
        let rows = pieces.flat_map(|piece| match piece {
            Ok(rows) => rows.into_iter().map(Ok).collect(),
            Err(error) => vec![Err(error)],
        });
        Rows { header, rows: Box::new(rows) }
    }
}
