//! Scene files: TOML in, a validated [`Scene`](crate::Scene) out, or an error that names file, line, key and remedy.

mod column;
mod derived;
pub(crate) mod edit;
mod error;
pub(crate) mod excitation;
pub(crate) mod fault;
mod file_kind;
mod key_value;
pub(crate) mod reader;
pub(crate) mod record_cache;
pub(crate) mod stations;
pub(crate) mod table;
mod template;

pub use derived::Derived;
pub use edit::replaced_by;
pub use error::{SceneFileError, text};
pub use file_kind::FileKind;
pub use key_value::Setting;
pub use reader::SceneFile;
pub use table::Cause;
#[doc(hidden)]
pub use table::keys_asked_by;
pub use template::Template;
pub(crate) use template::VariedExcitation;
