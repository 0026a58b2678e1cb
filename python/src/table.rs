//! Columns of a table on their way to pandas: a tuple `(name, kind, ...)` each, with arrays wherever there are many numbers.

use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use rocking::Fate;
use rocking::sweep::{Cell, CellKind, ERROR, Field};
use rocking::trust::Degree;
use std::collections::HashMap;
use std::fmt::Display;

/// A column of a table.
pub enum Values {
    /// Whole numbers; `("int", values)`.
    Index(Vec<i64>),
    /// Whole numbers with blanks; `("Int64", values, is_blank)`.
    Whole(Vec<i64>, Vec<bool>),
    /// Numbers with NaN for a blank; `("float", values)`.
    Number(Vec<f64>),
    /// Names of a list known beforehand; `("category", codes, names)`, the code of a blank is -1.
    Names(Vec<i32>, Vec<String>),
    /// Truth values with blanks; `("boolean", values, is_blank)`.
    Truth(Vec<bool>, Vec<bool>),
    /// Text with blanks; `("string", list)`.
    Text(Vec<Option<String>>),
}

/// A column with its name.
pub struct Column {
    pub name: String,
    pub values: Values,
}

impl Column {
    pub fn new(name: impl Into<String>, values: Values) -> Column {
        Column { name: name.into(), values }
    }

    /// The tuple `(name, kind, ...)` for Python.
    pub fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyTuple>> {
        let name = self.name;
        match self.values {
            Values::Index(values) => (name, "int", values.into_pyarray(py)).into_pyobject(py),
            Values::Whole(values, blanks) => {
                (name, "Int64", values.into_pyarray(py), blanks.into_pyarray(py)).into_pyobject(py)
            }
            Values::Number(values) => (name, "float", values.into_pyarray(py)).into_pyobject(py),
            Values::Names(codes, names) => (name, "category", codes.into_pyarray(py), names).into_pyobject(py),
            Values::Truth(values, blanks) => {
                (name, "boolean", values.into_pyarray(py), blanks.into_pyarray(py)).into_pyobject(py)
            }
            Values::Text(values) => (name, "string", values).into_pyobject(py),
        }
    }
}

/// The list of the tuples of all columns for Python.
pub fn into_python(py: Python<'_>, columns: Vec<Column>) -> PyResult<Bound<'_, PyList>> {
    let columns = columns.into_iter().map(|column| column.into_python(py)).collect::<PyResult<Vec<_>>>()?;
    PyList::new(py, columns)
}

/// The words of a column of results.
pub fn words(field: Field) -> Vec<&'static str> {
    match field {
        Field::Trust => Degree::NAMES.to_vec(),
        _ => Fate::NAMES.into_iter().chain([ERROR]).collect(),
    }
}

/// The column of cells of one kind; `words` are those of a column of words, in any order.
pub fn values<'r, E: Display + 'r>(
    kind: CellKind,
    words: impl IntoIterator<Item = impl Into<String>>,
    cells: impl Iterator<Item = Cell<'r, E>>,
) -> Values {
    match kind {
        CellKind::Whole => whole(cells.map(|cell| if let Cell::Whole(number) = cell { Some(number) } else { None })),
        CellKind::Number => {
            Values::Number(cells.map(|cell| if let Cell::Number(number) = cell { number } else { f64::NAN }).collect())
        }
        CellKind::Truth => truth(cells.map(|cell| if let Cell::Truth(truth) = cell { Some(truth) } else { None })),
        CellKind::Word => {
            Names::of(words).column(cells.map(|cell| if let Cell::Word(word) = cell { word } else { "" }))
        }
        _ => {
            let text = |cell: Cell<'_, E>| match cell {
                Cell::Word(word) => Some(word.to_string()),
                Cell::Error(error) => Some(error.to_string()),
                _ => None,
            };
            Values::Text(cells.map(text).collect())
        }
    }
}

/// Whole numbers with blanks.
fn whole(values: impl Iterator<Item = Option<usize>>) -> Values {
    let (values, blanks) = values.map(|value| (value.map_or(0, |value| value as i64), value.is_none())).unzip();
    Values::Whole(values, blanks)
}

/// Truth values with blanks.
fn truth(values: impl Iterator<Item = Option<bool>>) -> Values {
    let (values, blanks) = values.map(|value| (value.unwrap_or_default(), value.is_none())).unzip();
    Values::Truth(values, blanks)
}

/// A list of different names, and the place of each name in it.
pub struct Names {
    names: Vec<String>,
    places: HashMap<String, i32>,
}

impl Names {
    pub fn of<T: Into<String>>(all: impl IntoIterator<Item = T>) -> Names {
        let mut known = Names { names: Vec::new(), places: HashMap::new() };
        for name in all {
            let name = name.into();
            if !known.places.contains_key(&name) {
                known.places.insert(name.clone(), known.names.len() as i32);
                known.names.push(name);
            }
        }
        known
    }

    /// The column of `values` by their places in the list of names; -1 for a value that is not in the list.
    pub fn column<'n>(self, values: impl Iterator<Item = &'n str>) -> Values {
        let codes = values.map(|name| self.places.get(name).copied().unwrap_or(-1)).collect();
        Values::Names(codes, self.names)
    }
}
