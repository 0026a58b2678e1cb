//! A table of CSV, its cells by the names of their columns.

use csv::StringRecord;
use std::fmt;

/// A table with a header; all rows have as many cells as it.
#[derive(Clone, PartialEq)]
pub struct Table {
    header: StringRecord,
    rows: Vec<StringRecord>,
}

/// A row of a table.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    header: &'a StringRecord,
    cells: &'a StringRecord,
}

impl Table {
    pub fn of(csv: &str) -> Table {
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let header = reader.headers().expect("a header").clone();
        let rows = reader.records().map(|row| row.unwrap_or_else(|error| panic!("{error} in\n{csv}"))).collect();
        Table { header, rows }
    }

    /// The names of the columns.
    pub fn columns(&self) -> Vec<&str> {
        self.header.iter().collect()
    }

    /// The number of rows, without the header.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    pub fn row(&self, index: usize) -> Row<'_> {
        Row { header: &self.header, cells: &self.rows[index] }
    }

    pub fn rows(&self) -> impl DoubleEndedIterator<Item = Row<'_>> + ExactSizeIterator + Clone {
        self.rows.iter().map(|cells| Row { header: &self.header, cells })
    }

    /// The cells of a column.
    pub fn texts(&self, name: &str) -> Vec<&str> {
        self.rows().map(|row| row.text(name)).collect()
    }

    /// The cells of a column of numbers.
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        self.rows().map(|row| row.number(name)).collect()
    }
}

impl<'a> Row<'a> {
    pub fn text(&self, name: &str) -> &'a str {
        let place = self.header.iter().position(|own| own == name);
        &self.cells[place.unwrap_or_else(|| panic!("no column `{name}` in {:?}", self.header))]
    }

    pub fn number(&self, name: &str) -> f64 {
        self.text(name).parse().unwrap_or_else(|_| panic!("{name} of {self:?} is no number"))
    }

    /// All cells in order.
    pub fn cells(&self) -> Vec<&'a str> {
        self.cells.iter().collect()
    }
}

impl fmt::Debug for Row<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.debug_map().entries(self.header.iter().zip(self.cells)).finish()
    }
}

impl fmt::Debug for Table {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.debug_list().entry(&self.header).entries(&self.rows).finish()
    }
}
