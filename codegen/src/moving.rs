//! The programs with translations, by their numbers of free angles and translations.

use crate::catalogue::map_in_order;
use crate::error::{GenerateError, LARGEST};
use crate::mechanics::moving_links;
use crate::optimise::{Program, moving_program};
use crate::symbolic::Arena;

/// Columns of up to this many blocks have programs for all of their states.
const ALL_STATES: usize = 3;

/// Larger columns have programs with up to this many translations: two interfaces that slide, or one in flight.
const FEW_TRANSLATIONS: usize = 2;

/// The program for one number of angles and one number of translations.
#[derive(Debug)]
pub struct MovingRecord {
    /// Free angles.
    pub angles: usize,
    /// Free translations: one for each interface that slides, two for each interface in flight.
    pub translations: usize,
    /// Computes the linear system of the accelerations: rows of the matrix, and loads.
    pub program: Program,
}

impl MovingRecord {
    /// Derives the program.
    ///
    /// # Panics
    /// If `translations` is zero.
    pub fn new(angles: usize, translations: usize) -> MovingRecord {
        let mut arena = Arena::new();
        let moving = moving_links(&mut arena, angles, translations);
        let program = moving_program(&mut arena, &moving);
        MovingRecord { angles, translations, program }
    }

    /// Name of the program in the emitted code.
    pub fn name(&self) -> String {
        moving_name(self.angles, self.translations)
    }
}

/// Name of the program for these numbers of angles and translations.
pub fn moving_name(angles: usize, translations: usize) -> String {
    format!("Angles{angles}Translations{translations}")
}

/// Whether a column of `blocks` blocks has a combination of states with these numbers of free angles and translations. An interface with a
/// free angle has at most two translations (in flight). An interface without one has at most one translation (a slide).
pub fn occurs(blocks: usize, angles: usize, translations: usize) -> bool {
    angles <= blocks && translations <= blocks + angles
}

/// `(angles, translations)` of each program in a build for columns of up to `max_blocks` blocks: all that columns of up to three blocks
/// need, and for larger columns those with one or two translations.
///
/// ```
/// assert_eq!(rocking_codegen::moving::covered(1), [(0, 1), (1, 1), (1, 2)]);
/// ```
pub fn covered(max_blocks: usize) -> Vec<(usize, usize)> {
    let pairs = (0..=max_blocks).flat_map(|angles| (1..=max_blocks + angles).map(move |count| (angles, count)));
    let small = max_blocks.min(ALL_STATES);
    pairs.filter(|&(angles, count)| occurs(small, angles, count) || count <= FEW_TRANSLATIONS).collect()
}

/// The programs of [`covered`].
///
/// # Errors
/// [`GenerateError::Size`] if `max_blocks` is out of range.
pub fn moving_catalogue(max_blocks: usize) -> Result<Vec<MovingRecord>, GenerateError> {
    if !(1..=LARGEST).contains(&max_blocks) {
        return Err(GenerateError::Size { max_blocks });
    }
    Ok(map_in_order(&covered(max_blocks), |&(angles, translations)| MovingRecord::new(angles, translations)))
}
