//! The keys of scene, sweep and study files: types that are never made, whose JSON schema and reference are derived from their documentation.
//!
//! The reader of the library is not made of these types. `cli/tests/keys.rs` holds both together: it reads files of all kinds, and compares the keys
//! that the reader asks for with those of the schema.

mod kind;
mod list;
mod motion;
mod scene;
mod station;
mod study;
mod sweep;

pub use kind::Kind;
pub use list::list;
