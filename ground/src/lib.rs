//! Ground motion for earthquake engineering: strong-motion records, pulses, synthetic records, and their intensity measures.
//!
//! - [`RecordFile`] reads record files of the formats in use (PEER, ESM, K-NET, CSMIP, COSMOS, tables), recognised by their content.
//! - [`Record`] is a validated series of accelerations; [`Measures`] are its PGA, PGV, PGD, Arias intensity and durations.
//! - [`Motion`] is one component of a ground motion as data: a pulse, a wavelet, a record, a sum.
//! - [`Excitation`] is a horizontal and a vertical component. [`Excitation::segments`] divides them into smooth [`Segment`]s with known
//!   ends, so that an integrator never steps across a kink or a jump; [`TimelineCache`] keeps that division from one run to the next.
//!
//! All values are in SI units. Nothing here knows what the ground shakes.

mod bounds;
mod error;
mod excitation;
mod file;
mod formats;
mod impulse;
mod linear;
mod measures;
mod motion;
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
pub use motion::Motion;
pub use options::TextOptions;
pub use piece::Piece;
pub use record::{Record, Source};
pub use segment::Segment;
pub use synthetic::Synthetic;
pub use timeline::{Lookahead, Timeline, TimelineCache};
pub use unit::{AccelerationUnit, DEFAULT_GRAVITY};
