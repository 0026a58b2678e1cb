//! Readers of record files. Each format has a file of its own, with its layout in the first lines: [`peer`], [`dyna`] (ESM, ITACA),
//! [`knet`], [`csmip`], [`cosmos`], [`table`]. [`recognition`] recognises the format; [`numbers`] and [`header`] serve all of
//! them, [`heading`], [`sampling`], [`statement`] and [`factor`] tables and AT2 files.

mod cosmos;
mod csmip;
mod dyna;
mod factor;
mod header;
mod heading;
mod knet;
mod numbers;
mod peer;
mod recognition;
mod record_file;
mod sampling;
mod statement;
mod table;

pub use record_file::{Format, RecordFile};
