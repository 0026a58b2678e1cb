//! The compiled module of the Python package `rocking`: arrays, keys and errors handed across, and no mechanics.
//!
//! What users see is written in Python (`python/rocking/`). A scene is the keys of a scene file: Python holds them as a dictionary, and the reader
//! of scene files checks them ([`keys`]). Errors are those of the library ([`error`]). Every computation releases the interpreter's lock, and a
//! signal such as Ctrl-C ends it ([`interrupt`]). Tables are columns ([`table`]).

mod error;
mod interrupt;
mod keys;
mod origin;
mod record;
mod run;
mod scene;
mod study;
mod sweep;
mod table;

use pyo3::prelude::*;
use std::ffi::OsString;

/// The compiled part of the package `rocking`.
#[pymodule]
fn _rocking(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("MAX_BLOCKS", rocking::generated::MAX_BLOCKS)?;
    module.add("MEASURES", rocking::intensity::NAMES.to_vec())?;
    module.add_class::<record::Record>()?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<run::Response>()?;
    module.add_class::<sweep::Sweep>()?;
    module.add_class::<study::StudyRecord>()?;
    module.add_class::<study::Ida>()?;
    module.add_function(wrap_pyfunction!(keys::to_toml, module)?)?;
    module.add_function(wrap_pyfunction!(keys::from_toml, module)?)?;
    module.add_function(wrap_pyfunction!(keys::replaced_by, module)?)?;
    module.add_function(wrap_pyfunction!(scene::scene_text, module)?)?;
    module.add_function(wrap_pyfunction!(run::page, module)?)?;
    module.add_function(wrap_pyfunction!(run::figures, module)?)?;
    module.add_function(wrap_pyfunction!(study::fragility, module)?)?;
    module.add_function(wrap_pyfunction!(study::probability, module)?)?;
    module.add_function(wrap_pyfunction!(study::stripes, module)?)?;
    module.add_function(wrap_pyfunction!(study::measure_label, module)?)?;
    module.add_function(wrap_pyfunction!(study::equal_scales, module)?)?;
    module.add_function(wrap_pyfunction!(study::is_result, module)?)?;
    module.add_function(wrap_pyfunction!(study::record_columns, module)?)?;
    module.add_function(wrap_pyfunction!(study::is_of_one_record, module)?)?;
    module.add_function(wrap_pyfunction!(command_line, module)?)?;
    Ok(())
}

/// The command line with these arguments, the name of the program first; the exit status.
#[pyfunction]
fn command_line(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| rocking_cli::main_with(arguments))
}
