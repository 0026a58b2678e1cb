//! The keys of scene, sweep and study files. Their types are never constructed: JSON schema and reference are derived from the doc comments.
//!
//! The library's reader does not use these types. The test `cli/tests/keys.rs` keeps reader and types in agreement: it reads files of all kinds, and
//! compares the keys that the reader asks for with the keys of the schema.

mod kind;
mod list;
mod motion;
mod record;
mod scene;
mod station;
mod study;
mod sweep;

pub use kind::Kind;
pub use list::list;
