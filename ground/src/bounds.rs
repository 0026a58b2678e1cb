//! Bounds of a record, within which all its measures are finite doubles.

/// Largest acceleration of a record `[m/s²]`. A larger one is a misread unit. Sums of squares and double integrals stay far from overflow.
pub const LARGEST_ACCELERATION: f64 = 1e12;

/// Shortest sampling interval of a record `[s]`. Slopes between samples stay far from overflow.
pub const SHORTEST_INTERVAL: f64 = 1e-100;

/// Longest sampling interval of a record `[s]`: ten days. Displacements stay far from overflow.
pub const LONGEST_INTERVAL: f64 = 1e6;
