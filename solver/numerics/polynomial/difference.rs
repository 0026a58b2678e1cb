//! A linear function of the state: one component, or the difference of two.

/// A component of the state, or the difference of two, with a sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// One or minus one.
    pub sign: f64,
    /// Index of the component.
    pub upper: usize,
    /// Index of the one that is subtracted.
    pub lower: Option<usize>,
}

impl Difference {
    /// Of the components of a vector.
    #[inline(always)]
    pub fn of(self, x: &[f64]) -> f64 {
        self.by(|index| x[index])
    }

    /// Of whatever has components.
    #[inline(always)]
    pub fn by(self, x: impl Fn(usize) -> f64) -> f64 {
        self.sign * (x(self.upper) - self.lower.map_or(0.0, &x))
    }
}
