//! Programs with translations, one for each number of angles and translations: lists in, accelerations out.
//!
//! Which program serves is known only when a stretch begins. So the lists have no fixed length here, and a program copies them into its arrays.

use super::program::{Carried, MovingProgram, MovingState, leading};
use crate::numerics::elimination::eliminate;
use std::array::from_fn;

/// What a program with translations reads: [`Carried`] and [`MovingState`] with lists in place of arrays.
#[derive(Clone, Debug, Default)]
pub struct MovingLists {
    /// Moments of inertia of the links about their pivots `[kg m²]`.
    pub inertia: Vec<f64>,
    /// First moments of the links about their pivots `[kg m]`.
    pub moment: Vec<[f64; 2]>,
    /// From the pivot of each link to the next one `[m]`.
    pub lever: Vec<[f64; 2]>,
    /// Masses that the translations move `[kg]`.
    pub mass: Vec<f64>,
    /// First moments of these masses about the pivots of the links that turn them `[kg m]`; the links of one translation are adjacent.
    pub carried: Vec<[f64; 2]>,
    /// Coefficients of friction with the signs of the slides, dimensionless, per translation; zero in flight.
    pub lift: Vec<f64>,
    /// Cosines of the links' angles.
    pub cos: Vec<f64>,
    /// Sines of the links' angles.
    pub sin: Vec<f64>,
    /// Rates of the links' angles `[rad/s]`.
    pub omega: Vec<f64>,
    /// Horizontal components of the directions `(cos, -sin)` along which the translations move.
    pub face_cos: Vec<f64>,
    /// Minus the vertical components of these directions.
    pub face_sin: Vec<f64>,
    /// Rates at which these directions turn `[rad/s]`.
    pub face_omega: Vec<f64>,
    /// Rates of the translations `[m/s]`.
    pub rate: Vec<f64>,
    /// Horizontal ground acceleration and effective gravity `[m/s²]`.
    pub ground: [f64; 2],
}

impl MovingLists {
    /// Lists of zeros for so many angles and translations.
    pub fn zero(angles: usize, translations: usize) -> MovingLists {
        let (per_link, per_translation) = (vec![0.0; angles], vec![0.0; translations]);
        MovingLists {
            inertia: per_link.clone(),
            moment: vec![[0.0; 2]; angles],
            lever: vec![[0.0; 2]; angles],
            mass: per_translation.clone(),
            carried: vec![[0.0; 2]; angles * translations],
            lift: per_translation.clone(),
            cos: per_link.clone(),
            sin: per_link.clone(),
            omega: per_link,
            face_cos: per_translation.clone(),
            face_sin: per_translation.clone(),
            face_omega: per_translation.clone(),
            rate: per_translation,
            ground: [0.0; 2],
        }
    }
}

/// Writes the second derivatives of the angles, then of the translations, into a list. Returns whether the determinant of the rows is above zero; `None` if
/// they determine nothing.
///
/// # Panics
/// If the lists are not those of [`MovingLists::zero`] for the angles and translations of the program, or the list written has not as many entries as these.
pub type MovingEquations = fn(&MovingLists, &mut [f64]) -> Option<bool>;

/// The equations of a program. Called by generated modules.
pub fn moving_equations<P, const ANGLES: usize, const TRANSLATIONS: usize, const SIZE: usize>() -> MovingEquations
where
    P: MovingProgram<f64, ANGLES, TRANSLATIONS, SIZE>,
{
    |lists, accelerations| {
        let carried = Carried::<f64, ANGLES, TRANSLATIONS> {
            inertia: leading(&lists.inertia),
            moment: leading(&lists.moment),
            lever: leading(&lists.lever),
            mass: leading(&lists.mass),
            carried: from_fn(|each| leading(&lists.carried[each * ANGLES..])),
            lift: leading(&lists.lift),
        };
        let state = MovingState {
            cos: leading(&lists.cos),
            sin: leading(&lists.sin),
            omega: leading(&lists.omega),
            face_cos: leading(&lists.face_cos),
            face_sin: leading(&lists.face_sin),
            face_omega: leading(&lists.face_omega),
            rate: leading(&lists.rate),
            ground_x: lists.ground[0],
            gravity: lists.ground[1],
        };
        let (matrix, loads) = P::rows(&carried, &state);
        let (solution, is_positive) = eliminate(matrix, loads)?;
        accelerations.copy_from_slice(&solution);
        Some(is_positive)
    }
}
