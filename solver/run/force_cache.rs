//! Contact forces at the ends of a stretch, kept where they are read more than once.

use crate::column::Column;
use crate::mechanics::dynamics::{ContactForce, Interfaces};
use crate::numerics::per_block::PerBlock;

/// Contact forces of a phase, evaluated where they are read.
pub(super) struct ForceCache {
    /// The forces evaluated last.
    pub last: PerBlock<ContactForce>,
    /// At the start of the stretch.
    pub start: KnownForces,
    /// At its end.
    pub end: KnownForces,
}

/// Contact forces at an instant, as far as they are known.
#[derive(Clone)]
pub(super) struct KnownForces {
    pub known: KnownPart,
    /// Forces at all interfaces.
    pub forces: PerBlock<ContactForce>,
    /// Margins `c N - |M|` of the closed interfaces.
    pub margins: PerBlock<f64>,
}

/// How much is known of contact forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum KnownPart {
    Nothing,
    /// The margins of closed interfaces.
    Margins,
    /// These, and the forces at all interfaces.
    Forces,
}

impl KnownForces {
    /// Keeps forces that have been evaluated at all interfaces, or at the `closed` ones.
    pub fn keep(&mut self, forces: &PerBlock<ContactForce>, which: Interfaces, closed: &[usize], column: &Column) {
        for (margin, &interface) in self.margins.iter_mut().zip(closed) {
            *margin = margin_of(&forces[interface], column, interface);
        }
        self.known = KnownPart::Margins;
        if which == Interfaces::All {
            self.forces.copy_from_slice(forces);
            self.known = KnownPart::Forces;
        }
    }
}

/// `c N - |M|` of a closed interface.
pub(super) fn margin_of(force: &ContactForce, column: &Column, interface: usize) -> f64 {
    column.contact_half_width(interface) * force.normal - force.moment.abs()
}

impl ForceCache {
    pub fn new(blocks: usize, closed: usize) -> ForceCache {
        let (forces, margins) = (PerBlock::filled(ContactForce::default(), blocks), PerBlock::filled(0.0, closed));
        let unknown = KnownForces { known: KnownPart::Nothing, forces: forces.clone(), margins };
        ForceCache { last: forces, start: unknown.clone(), end: unknown }
    }

    /// Forgets all that is known.
    pub fn forget(&mut self) {
        (self.start.known, self.end.known) = (KnownPart::Nothing, KnownPart::Nothing);
    }

    /// Makes the end of the stretch its start.
    pub fn advance(&mut self) {
        std::mem::swap(&mut self.start, &mut self.end);
        self.end.known = KnownPart::Nothing;
    }
}
