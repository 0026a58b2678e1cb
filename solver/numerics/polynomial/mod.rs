//! Polynomials on `[0, 1]`: the dense output of a step, whose roots are events and whose crests are peaks.

pub mod bernstein;
pub mod difference;
pub mod powers;
pub mod track;
