//! What a contact problem decides: the pattern and the rates from then on, and the impulses of the contacts.

use crate::mechanics::dynamics::ContactForce;
use crate::numerics::per_block::PerBlock;
use rocking_codegen::pattern::Pattern;

/// What a contact problem has decided.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The pattern from now on.
    pub pattern: Pattern,
    /// Rates of the blocks from now on `[rad/s]`, length N.
    pub omega: PerBlock<f64>,
    /// No pattern was admissible: a block would fly.
    pub separation: bool,
    /// Besides the interfaces that are released, others are critical: their forces and accelerations are at the bounds between two states, and rounding has
    /// chosen. What [`crate::contact::open`] finds an instant later decides: some 1e-6 of the time in which the column falls.
    pub is_critical: bool,
    /// Restitution was left out (docs/book/model.md, section 5).
    pub is_without_restitution: bool,
    /// Kinetic energy before and after `[J]`. Zeros where rates do not jump or `ImpactLaw::is_recorded` is false.
    pub kinetic: [f64; 2],
    /// Impulses at the interfaces on the stack above, base first `[N s]`, `[N m s]`: normal, tangential, moment about the
    /// contact's centre, restitution included, the end of low hops not. Empty where rates do not jump or `ImpactLaw::is_recorded` is false.
    pub impulses: PerBlock<ContactForce>,
    /// The same without restitution; empty where nothing rebounds, and where `impulses` is.
    pub plastic_impulses: PerBlock<ContactForce>,
}

impl Decision {
    /// A decision for this pattern without impulses, and without a separation.
    pub fn without_impulses(pattern: Pattern, omega: PerBlock<f64>) -> Decision {
        Decision {
            pattern,
            omega,
            separation: false,
            is_critical: false,
            is_without_restitution: false,
            kinetic: [0.0; 2],
            impulses: PerBlock::new(),
            plastic_impulses: PerBlock::new(),
        }
    }

    /// Lost share of the kinetic energy before, 0 to 1.
    pub fn share_lost(&self) -> f64 {
        let [before, after] = self.kinetic;
        if before > 0.0 { 1.0 - after / before } else { 0.0 }
    }
}
