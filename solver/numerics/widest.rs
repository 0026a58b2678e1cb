//! The widest instructions of the machine, chosen at run time.
//!
//! No operation is a fused multiply-add, so that every result is bit for bit that of the plainest instructions, on every machine.

/// Runs `work`. It is compiled, together with all that is inlined into it, for the widest instructions of this machine.
#[inline(always)]
pub fn widest<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}
