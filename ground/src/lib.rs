#![doc = include_str!("../README.md")]

mod bounds;
mod error;
mod excitation;
mod file;
mod formats;
mod impulse;
mod linear;
mod measures;
mod motion;
mod open;
mod options;
mod piece;
mod record;
mod segment;
mod spans;
mod synthetic;
mod timeline;
mod travel;
mod unit;

pub use error::RecordError;
pub use excitation::Excitation;
pub use file::{LARGEST_FILE, read_file};
pub use formats::{Format, RecordFile};
pub use measures::Measures;
pub use motion::{Description, Motion};
pub use open::OpenError;
pub use options::TextOptions;
pub use piece::Piece;
pub use record::{Record, Source};
pub use segment::Segment;
pub use synthetic::Synthetic;
pub use timeline::{Lookahead, Timeline, TimelineCache};
pub use unit::{AccelerationUnit, DEFAULT_GRAVITY};
