//! The keys of a sweep that vary, and how their values make points.

use crate::scene_file::Setting;

/// A key of the scene and the values it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Dotted name, e.g. `excitation.horizontal.amplitude_g`.
    pub key: String,
    /// Values, in the unit of the key.
    pub values: Vec<Setting>,
}

impl Axis {
    /// Whether the axis is that of a key, or of an entry in the table or list that the key names.
    pub(super) fn is_within(&self, key: &str) -> bool {
        self.key.strip_prefix(key).is_some_and(|below| below.is_empty() || below.starts_with(['.', '[']))
    }
}

/// Last parts of the keys whose values choose a record. Each run has one record, and fractiles are taken over all records.
const OF_RECORDS: [&str; 4] = ["file", "record", "component", "seed"];

/// Whether the values of a key, under its dotted name or by its last part alone, are records: files, records of stations, components of them, seeds of
/// synthetic ones.
pub fn is_of_records(key: &str) -> bool {
    let last = key.strip_prefix("excitation.").map_or(key, |inner| inner.rsplit('.').next().unwrap_or(inner));
    OF_RECORDS.contains(&last)
}

/// How axes make points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Combine {
    /// Each value of an axis with each value of the others; the last axis varies fastest.
    #[default]
    Cartesian,
    /// The first values together, then the second ones, and so on.
    Paired,
    /// The last axes, as many as the number says, are sampled: sample `k` consists of the `k`-th values of all these axes. Each sample is taken with
    /// each combination of the values of the other axes; samples vary fastest.
    Sampled(usize),
}

impl Combine {
    /// Names in sweep files of those that a file may ask for.
    pub const NAMES: [&str; 2] = ["cartesian", "paired"];

    /// The combination of this name in sweep files.
    pub fn parse(name: &str) -> Option<Combine> {
        match name {
            "cartesian" => Some(Combine::Cartesian),
            "paired" => Some(Combine::Paired),
            _ => None,
        }
    }
}
