//! Keys of scene files: a Python dictionary as TOML, and the other way round.
//!
//! Numbers may be of NumPy, lists may be arrays or tuples, and paths may be `os.PathLike`. `None` leaves a key out. An object with a method
//! `_scene_keys()` stands for the dictionary that the method returns.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use std::fmt::Write as _;
use toml::de::{DeTable, DeValue};

/// What stands at a key.
enum Found<'py> {
    Nothing,
    /// TOML text.
    Value(String),
    Table(Bound<'py, PyDict>),
    Tables(Vec<Bound<'py, PyDict>>),
}

/// The TOML text of a dictionary.
#[pyfunction]
pub fn to_toml(keys: &Bound<'_, PyDict>) -> PyResult<String> {
    let mut text = String::new();
    table(&mut text, "", keys)?;
    Ok(text)
}

/// The table whose keys have an order that counts: the last axis of a sweep runs fastest.
const AXES: &str = "axes";

/// Values first, then tables, as TOML wants it; in [`AXES`] all as values, in their order.
fn table(text: &mut String, path: &str, keys: &Bound<'_, PyDict>) -> PyResult<()> {
    let mut inner = Vec::new();
    for (key, value) in keys.iter() {
        let key = name(path, &key)?;
        let dotted = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        match found(&dotted, &value)? {
            Found::Nothing => {}
            Found::Value(value) => {
                let _ = writeln!(text, "{key} = {value}");
            }
            Found::Table(keys) if path == AXES => {
                let _ = writeln!(text, "{key} = {}", inline(&dotted, &keys)?);
            }
            tables => inner.push((dotted, tables)),
        }
    }
    for (dotted, tables) in inner {
        match tables {
            Found::Table(keys) => {
                let _ = writeln!(text, "\n[{dotted}]");
                table(text, &dotted, &keys)?;
            }
            Found::Tables(list) => {
                for keys in list {
                    let _ = writeln!(text, "\n[[{dotted}]]");
                    table(text, &dotted, &keys)?;
                }
            }
            Found::Nothing | Found::Value(_) => {}
        }
    }
    Ok(())
}

/// A key of a table, as TOML writes it.
fn name(path: &str, key: &Bound<'_, PyAny>) -> PyResult<String> {
    let key: String = key.extract().map_err(|_| PyTypeError::new_err(format!("{path}: a key must be text")))?;
    Ok(bare_or_quoted(&key))
}

/// A table on one line.
fn inline(path: &str, keys: &Bound<'_, PyDict>) -> PyResult<String> {
    let mut entries = Vec::new();
    for (key, value) in keys.iter() {
        let key = name(path, &key)?;
        let dotted = format!("{path}.{key}");
        let value = match found(&dotted, &value)? {
            Found::Nothing => continue,
            Found::Value(value) => value,
            Found::Table(keys) => inline(&dotted, &keys)?,
            Found::Tables(tables) => {
                let tables: PyResult<Vec<String>> = tables.iter().map(|keys| inline(&dotted, keys)).collect();
                format!("[{}]", tables?.join(", "))
            }
        };
        entries.push(format!("{key} = {value}"));
    }
    Ok(format!("{{ {} }}", entries.join(", ")))
}

fn found<'py>(key: &str, value: &Bound<'py, PyAny>) -> PyResult<Found<'py>> {
    let py = value.py();
    if value.is_none() {
        return Ok(Found::Nothing);
    }
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(Found::Value(flag.is_true().to_string()));
    }
    if let Ok(number) = value.cast::<PyFloat>() {
        return Ok(Found::Value(float(number.value())));
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(Found::Value(value.str()?.to_string()));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Found::Value(quoted(text.to_str()?)));
    }
    if let Ok(keys) = value.cast::<PyDict>() {
        return Ok(Found::Table(keys.clone()));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        return list(key, value);
    }
    if let Some(method) = value.getattr_opt(intern!(py, "_scene_keys"))? {
        return found(key, &method.call0()?);
    }
    refuse_units_and_complex(key, value)?;
    if let Some(method) = value.getattr_opt(intern!(py, "tolist"))? {
        let plain = method.call0()?;
        // That of `numpy.longdouble` is itself.
        if !plain.get_type().is(value.get_type()) {
            return found(key, &plain);
        }
    }
    if let Some(method) = value.getattr_opt(intern!(py, "__fspath__"))? {
        return found(key, &method.call0()?);
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(Found::Value(float(number)));
    }
    let kind = value.get_type().name()?;
    Err(PyTypeError::new_err(format!(
        "key `{key}`: a {kind} cannot stand in a scene; give a number, text, a list or a dictionary"
    )))
}

/// Refuses numbers of NumPy that are differences of times, which have a unit of their own, dates, or complex.
fn refuse_units_and_complex(key: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
    let py = value.py();
    let Some(dtype) = value.getattr_opt(intern!(py, "dtype"))? else { return Ok(()) };
    let kind = dtype.getattr_opt(intern!(py, "kind"))?.map(|kind| kind.str()).transpose()?;
    let problem = match kind.as_ref().map(|kind| kind.to_str()).transpose()? {
        Some("m") => "has a unit of its own; give numbers in the unit of the key, as value / numpy.timedelta64(1, 's')",
        Some("M") => {
            "is a date; give a number in the unit of the key, for times the seconds since the start of the run"
        }
        Some("c") => "is complex; give real numbers",
        _ => return Ok(()),
    };
    Err(PyTypeError::new_err(format!("key `{key}`: {dtype} {problem}")))
}

fn list<'py>(key: &str, items: &Bound<'py, PyAny>) -> PyResult<Found<'py>> {
    let (mut values, mut tables) = (Vec::new(), Vec::new());
    for item in items.try_iter()? {
        match found(key, &item?)? {
            Found::Value(value) => values.push(value),
            Found::Table(keys) => tables.push(keys),
            Found::Nothing => {
                return Err(PyTypeError::new_err(format!("key `{key}`: None stands in a list; leave it out")));
            }
            Found::Tables(_) => {
                return Err(PyTypeError::new_err(format!("key `{key}`: a list of lists of tables is no scene")));
            }
        }
    }
    match (values.is_empty(), tables.is_empty()) {
        (_, true) => Ok(Found::Value(format!("[{}]", values.join(", ")))),
        (true, false) => Ok(Found::Tables(tables)),
        (false, false) => {
            Err(PyTypeError::new_err(format!("key `{key}`: a list has tables and values; give one of them")))
        }
    }
}

/// A number as text that TOML reads back to the same bits.
fn float(number: f64) -> String {
    if number.is_nan() { "nan".into() } else { format!("{number:?}") }
}

fn bare_or_quoted(key: &str) -> String {
    let is_bare = !key.is_empty() && key.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"_-".contains(&byte));
    if is_bare { key.into() } else { quoted(key) }
}

fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for sign in text.chars() {
        match sign {
            '"' | '\\' => quoted.extend(['\\', sign]),
            _ if sign.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", sign as u32);
            }
            _ => quoted.push(sign),
        }
    }
    quoted + "\""
}

/// Keys that a new key of the same table replaces.
#[pyfunction]
pub fn replaced_by(name: &str) -> Vec<&'static str> {
    rocking::scene_file::replaced_by(name).collect()
}

/// The dictionary of TOML text, in the order of the text: axes have one.
#[pyfunction]
pub fn from_toml<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyDict>> {
    let read = DeTable::parse(text).map_err(|error| PyValueError::new_err(error.to_string()))?;
    dictionary(py, read.into_inner())
}

fn dictionary<'py>(py: Python<'py>, read: DeTable<'_>) -> PyResult<Bound<'py, PyDict>> {
    let mut entries: Vec<_> = read.into_iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    let keys = PyDict::new(py);
    for (key, value) in entries {
        keys.set_item(key.into_inner(), python(py, value.into_inner())?)?;
    }
    Ok(keys)
}

fn python<'py>(py: Python<'py>, value: DeValue<'_>) -> PyResult<Bound<'py, PyAny>> {
    let no_number = |text: &str| PyValueError::new_err(format!("`{text}` is out of range"));
    Ok(match value {
        DeValue::String(text) => text.into_pyobject(py)?.into_any(),
        DeValue::Integer(number) => {
            let whole = i64::from_str_radix(number.as_str(), number.radix());
            whole.map_err(|_| no_number(number.as_str()))?.into_pyobject(py)?.into_any()
        }
        DeValue::Float(number) => {
            let size: f64 = number.as_str().parse().map_err(|_| no_number(number.as_str()))?;
            size.into_pyobject(py)?.into_any()
        }
        DeValue::Boolean(flag) => flag.into_pyobject(py)?.to_owned().into_any(),
        DeValue::Datetime(time) => time.to_string().into_pyobject(py)?.into_any(),
        DeValue::Array(items) => {
            let items = items.into_iter().map(|item| python(py, item.into_inner())).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, items)?.into_any()
        }
        DeValue::Table(table) => dictionary(py, table)?.into_any(),
    })
}
