//! Proofs that the outcome of a run is certain before its end, for runs that request nothing else.

pub mod stands;

pub(crate) mod falls;
pub(crate) mod verdict;
