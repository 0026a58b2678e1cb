//! Ground motion laid out in time, kept from one run to the next.

use super::{Excitation, Segment};
use std::rc::Rc;

/// The segments of the last ground motion.
#[derive(Default)]
pub(crate) struct Layout {
    /// What they are of, and until when `[s]`, where there are many of them.
    of: Option<(Excitation, f64)>,
    segments: Rc<Vec<Segment>>,
}

/// Segments from which on it is seen whether they are the same: fewer are laid out anew in less time.
const MANY_SEGMENTS: usize = 16;

impl Layout {
    /// The segments that cover `0 .. t_end` `[s]`.
    pub fn segments(&mut self, excitation: &Excitation, t_end: f64) -> Rc<Vec<Segment>> {
        if !self.of.as_ref().is_some_and(|(own, until)| *until == t_end && own == excitation) {
            let segments = Rc::make_mut(&mut self.segments);
            excitation.lay_out(t_end, segments);
            self.of = (segments.len() >= MANY_SEGMENTS).then(|| (excitation.clone(), t_end));
        }
        Rc::clone(&self.segments)
    }
}
