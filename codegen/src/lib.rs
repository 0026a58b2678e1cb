//! Derives the equations of motion of every rocking mode of a multi-block column and writes them as Rust.
//!
//! The pipeline is [`derive()`] and [`generate`]: linkage of a pattern -> positions of the centroids -> energies ->
//! Euler-Lagrange -> step-time programs with scene constants hoisted -> Rust text. States in which interfaces slide or fly ([`joints`]) share
//! one program per number of free angles and translations ([`moving`]), derived by d'Alembert's principle. [`report`] prints the same
//! derivations as text or LaTeX. The crate contains no time stepping and no scenes.
//!
//! ```
//! let text = rocking_codegen::generate(2).unwrap();
//! assert!(text.contains("pub struct Dof2"));
//! ```

pub mod bake;
mod catalogue;
mod derivation;
#[cfg(feature = "emit")]
pub mod emit;
mod error;
mod ground;
pub mod joints;
pub mod mechanics;
pub mod moving;
pub mod optimise;
pub mod pattern;
#[cfg(feature = "report")]
pub mod report;
pub mod symbolic;

pub use catalogue::{Catalogue, CompositeRecord, InsideRecord, LinkageRecord, catalogue};
pub use derivation::{Derivation, Plan, derive, derive_forces, derive_in_form};
pub use error::{GenerateError, LARGEST};
pub use ground::GroundMotion;

/// The generated module for columns of up to `max_blocks` blocks, as formatted Rust; the same text on every run.
///
/// # Errors
/// As [`catalogue()`].
#[cfg(feature = "emit")]
pub fn generate(max_blocks: usize) -> Result<String, GenerateError> {
    Ok(emit::module(&catalogue(max_blocks)?))
}

/// The generated module of the programs with translations, as formatted Rust; the same text on every run. These programs serve columns of
/// up to `max_blocks` blocks, in states in which interfaces slide or fly.
///
/// # Errors
/// As [`moving::moving_catalogue`].
#[cfg(feature = "emit")]
pub fn generate_moving(max_blocks: usize) -> Result<String, GenerateError> {
    Ok(emit::moving_module(max_blocks, &moving::moving_catalogue(max_blocks)?))
}

/// Largest column with rocking equations in unit tests, which compile the library once more. Unit tests run no larger column, and each further
/// block triples the number of modes. Integration tests have the equations of all columns.
#[cfg(feature = "emit")]
const UNIT_TEST_MAX_BLOCKS: usize = 3;

/// The modules that a build for columns of up to `max_blocks` blocks includes, each as `(file name without extension, text)`:
/// [`generate`], [`generate`] again for unit tests, with at most three blocks, and [`generate_moving`].
///
/// # Errors
/// As [`catalogue()`].
#[cfg(feature = "emit")]
pub fn modules(max_blocks: usize) -> Result<[(&'static str, String); 3], GenerateError> {
    let of_unit_tests = generate(max_blocks.min(UNIT_TEST_MAX_BLOCKS))?;
    Ok([("equations", generate(max_blocks)?), ("unit_tests", of_unit_tests), ("moving", generate_moving(max_blocks)?)])
}

/// The module of one column of given sizes, as formatted Rust. The scene constants of its accelerations are literals.
///
/// # Errors
/// As [`bake::baked_catalogue`].
#[cfg(feature = "emit")]
pub fn generate_baked(column: &bake::BakedColumn) -> Result<String, GenerateError> {
    Ok(emit::baked_module(&bake::baked_catalogue(column)?))
}
