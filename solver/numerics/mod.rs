//! Numerical methods that know nothing of blocks: scalars and sines, vectors of the plane, polynomials, guards, complementarity, random numbers, methods of integration.
//!
//! Nothing here imports from another room of the library.

pub mod elimination;
pub mod guards;
pub mod lemke;
pub mod ode;
pub mod per_block;
pub mod plane;
pub mod polynomial;
pub mod random;
pub mod scalar;
pub mod scalar_types;
pub mod sines;
pub mod state_vector;
pub mod widest;
