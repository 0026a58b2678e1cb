//! What a run with friction reports in addition: slides, flights, energy balance.

use super::StopReason;
use serde::{Deserialize, Serialize};

/// What a run with friction reports in addition. Lists have one entry per interface, base first. Where only the outcome is wanted, works, losses and
/// the highest flight are zero, and times end where the outcome is certain.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[non_exhaustive]
pub struct SlidingReport {
    /// Largest magnitude of the slide, counted from the aligned column `[m]`, flights left out.
    pub peak_slide: Vec<f64>,
    /// Slide at the end `[m]`, counted along the lower face where the interface is free.
    pub residual_slide: Vec<f64>,
    /// Length of the path slid `[m]`, back and forth.
    pub way_slid: Vec<f64>,
    /// Time in each kind of contact.
    pub times: Vec<ContactTimes>,
    /// Number of flights.
    pub flights: Vec<usize>,
    /// Largest gap of a flight `[m]`.
    pub highest_flight: f64,
    /// Work of friction at sliding contacts `[J]`, zero or negative.
    pub friction_work: f64,
    /// Energy lost at impacts, and where hops, bounces and slides that are too low to be followed end `[J]`.
    pub impact_losses: f64,
    /// Work of the ground's inertial forces on the column `[J]`. While everything sticks, it is the change of energy plus the losses at impacts.
    pub ground_work: f64,
    /// Works of the ground in each part of the run in which everything sticks, and in each step in which something slides or flies, added up without signs
    /// `[J]`. It depends on the steps: a scale for the balance, where the ground takes back as much as it gives.
    #[serde(default)]
    pub ground_exchange: f64,
    /// Energy at the end less that at the start, relative to the ground `[J]`.
    pub energy_change: f64,
    /// Times at which several motions were admissible `[s]`.
    pub ambiguous: Vec<f64>,
    /// Times at which no acceleration was admissible, or forces grew without bound `[s]`.
    pub jammed: Vec<f64>,
}

/// Time that an interface spends in each kind of contact `[s]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[non_exhaustive]
pub struct ContactTimes {
    /// Time in contact without sliding `[s]`.
    pub sticking: f64,
    /// Time in contact while sliding `[s]`.
    pub sliding: f64,
    /// Time without contact `[s]`.
    pub free: f64,
}

/// Share of the largest energy below which the work of the ground is no scale. While everything sticks that work is a difference of energies, whose
/// rounding was taken for work where the ground does not move.
const LEAST_SHARE_OF_GROUND: f64 = 1e-6;

impl SlidingReport {
    /// Whether the report is one of this number of blocks: it has one entry per interface in each list, and finite slides, energies and instants.
    pub fn is_of(&self, blocks: usize) -> bool {
        let lengths = [&self.peak_slide, &self.residual_slide, &self.way_slid];
        let sums =
            [self.highest_flight, self.friction_work, self.impact_losses, self.ground_work, self.ground_exchange];
        let moments = self.ambiguous.iter().chain(&self.jammed);
        lengths.iter().all(|list| list.len() == blocks)
            && (self.times.len(), self.flights.len()) == (blocks, blocks)
            && lengths
                .into_iter()
                .flatten()
                .chain(&sums)
                .chain([&self.energy_change])
                .chain(moments)
                .all(|value| value.is_finite())
    }

    /// Whether an interface has slid or flown.
    pub fn is_any(&self) -> bool {
        (0..self.way_slid.len()).any(|interface| self.has_moved(interface))
    }

    /// Whether an interface (from zero) has slid or flown.
    ///
    /// # Panics
    /// If the column has no such interface.
    pub fn has_moved(&self, interface: usize) -> bool {
        self.way_slid[interface] > 0.0 || self.flights[interface] > 0
    }

    /// Residual of the energy balance over the work of the ground; over the largest term where the work of the ground is less than a millionth of it. `None`
    /// where nothing slid or flew, or where works were not recorded, as in runs for their outcome only.
    pub fn balance(&self) -> Option<f64> {
        let SlidingReport { ground_work, friction_work, impact_losses, ground_exchange, energy_change, .. } = *self;
        let open = ground_work + friction_work - impact_losses - energy_change;
        let largest = friction_work.abs().max(impact_losses.abs()).max(energy_change.abs()).max(ground_exchange);
        let scale = if ground_work.abs() > LEAST_SHARE_OF_GROUND * largest { ground_work.abs() } else { largest };
        (self.is_any() && scale > 0.0).then(|| (open / scale).abs())
    }

    /// What a user must know before believing a run with friction.
    pub(super) fn warnings(&self, status: StopReason, t_final: f64) -> Vec<String> {
        let mut warnings = Vec::new();
        let times = |list: &[f64]| list.first().map_or(0.0, |first| *first);
        if !self.ambiguous.is_empty() {
            warnings.push(format!(
                "at {} instant(s), the first at t = {:.4} s, friction admits several motions, of which one was taken by the rules of the model (section 16 of its chapter)",
                self.ambiguous.len(),
                times(&self.ambiguous)
            ));
        }
        if !self.jammed.is_empty() {
            warnings.push(format!(
                "at {} instant(s), the first at t = {:.4} s, friction admits no smooth motion: the blocks jam, and strike",
                self.jammed.len(),
                times(&self.jammed)
            ));
        }
        if status == StopReason::Undetermined {
            warnings.push(format!(
                "the run ends at t = {t_final:.4} s: no motion follows from the laws of contact there; with a smaller `stick_angle` or another \
                 `method` the run may go on"
            ));
        }
        warnings
    }
}
