//! Ground motion for earthquake engineering: strong-motion records, pulses, synthetic records, and their intensity measures.
//!
//! - [`RecordFile`] reads record files of the formats in use (PEER, ESM, K-NET, CSMIP, COSMOS, tables), recognised by their content.
//! - [`Record`] is a validated series of accelerations; [`Measures`] are its PGA, PGV, PGD, Arias intensity and durations.
//! - [`Motion`] is one component of a ground motion as data: a pulse, a wavelet, a record, a sum.
//! - [`Excitation`] is a horizontal and a vertical component. [`Excitation::segments`] divides them into smooth [`Segment`]s with known
//!   ends, so that an integrator never steps across a kink or a jump; [`TimelineCache`] keeps that division from one run to the next.
//!
//! All values are in SI units. Nothing here knows what the ground shakes.

mod excitation;
mod file;
mod formats;
mod impulse;
mod measures;
mod motion;
mod overlay;
mod piece;
mod record;
mod segment;
mod synthetic;
mod timeline;
mod travel;
mod unit;

pub use excitation::Excitation;
pub use file::{LARGEST_FILE, read_file};
pub use formats::{Format, RecordFile};
pub use measures::Measures;
pub use motion::Motion;
pub use piece::Piece;
pub use record::{Record, RecordError, Source, TextOptions};
pub use segment::Segment;
pub use synthetic::Synthetic;
pub use timeline::{Lookahead, Timeline, TimelineCache};
pub use unit::AccelerationUnit;

/// Gravity where nothing else is given `[m/s²]`.
pub const DEFAULT_GRAVITY: f64 = 9.81;
