//! What a run without sliding asks of its contacts: friction, compression, no separation.
//!
//! Contacts count up to the point of no return: from then on some block is past its balance, `|θ_i| > α_i`, and no block comes back over its balance
//! before the column has overturned. What a falling block does at its contacts does not matter: the outcome is known by then. If the column does not
//! overturn, the whole run counts.

use crate::json::number;
use serde::{Deserialize, Serialize};

/// Coefficients of friction for [`ContactNeeds::above`], dimensionless: from polished stone to a value that bare stone on stone hardly reaches.
pub const COEFFICIENTS: [f64; 4] = [0.3, 0.5, 0.7, 1.0];

/// Share of the weight above a contact up to which its normal force counts as zero; its friction demand is then left out, as both forces are rounding where
/// blocks part. If the share were larger, contacts under little load would be left out.
pub const LIGHT_CONTACT: f64 = 1e-9;

/// What the contacts of a run need, up to the point of no return.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Validity {
    /// The point of no return of a run that overturns, otherwise the end of the run `[s]`. It is zero for a column that falls from the start: then no
    /// contact counts, demands are zero and the smallest normal forces infinite.
    pub until: f64,
    /// Per interface, base first.
    pub contacts: Vec<ContactNeeds>,
    /// Number of separations.
    pub separations: usize,
    /// Time of the first contact problem without admissible pattern ([`crate::response::Separation`]) `[s]`; `None` if there is none.
    pub first_separation: Option<f64>,
}

/// What one contact needs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ContactNeeds {
    /// Largest `|T| / N`, dimensionless; infinite if a tangential force acts without compression.
    pub friction_demand: Extreme,
    /// Largest `|P_T| / P_N` of the impulses at impacts, dimensionless; infinite where a contact transmits no compression, or would have to pull. `None` in
    /// files of earlier versions.
    #[serde(default)]
    pub impulse_friction_demand: Option<Extreme>,
    /// Smallest normal force `[N]`.
    pub min_normal_force: Extreme,
    /// Time in which the normal force is below zero.
    pub tension: Span,
    /// Time in which `|T| / N` is above each of [`COEFFICIENTS`].
    pub above: Vec<Exceedance>,
}

/// An extreme of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Extreme {
    /// The value, in the unit of the quantity.
    #[serde(deserialize_with = "number")]
    pub value: f64,
    /// The time at which it occurs `[s]`.
    pub t: f64,
    /// Angle of the block above the contact at that time `[rad]`.
    pub theta: f64,
}

/// A part of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Span {
    /// Duration `[s]`.
    pub time: f64,
    /// Duration as a share of [`Validity::until`], dimensionless.
    pub share: f64,
}

/// Time in which a contact needs more than a coefficient of friction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Exceedance {
    /// The coefficient of friction, dimensionless.
    pub coefficient: f64,
    /// Time in which the contact needs more `[s]`.
    pub time: f64,
    /// Share of [`Validity::until`], dimensionless.
    pub share: f64,
}

impl Validity {
    /// Whether the model without sliding holds if the joints are rough enough: there is no separation, no contact pulls, and a finite coefficient of
    /// friction is enough at each.
    pub fn holds(&self) -> bool {
        let is_pressed = |contact: &ContactNeeds| contact.min_normal_force.value >= 0.0;
        self.separations == 0 && self.contacts.iter().all(is_pressed) && self.largest_demand().is_finite()
    }

    /// Largest friction demand of all contacts at impacts, dimensionless.
    pub fn largest_impulse_demand(&self) -> f64 {
        let demands = self.contacts.iter().filter_map(|contact| contact.impulse_friction_demand);
        demands.fold(0.0, |largest, demand| demand.value.max(largest))
    }

    /// Largest friction demand of all contacts between impacts, dimensionless.
    pub fn largest_demand(&self) -> f64 {
        self.contacts.iter().fold(0.0, |largest, contact| contact.friction_demand.value.max(largest))
    }
}
