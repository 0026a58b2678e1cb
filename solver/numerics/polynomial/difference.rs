//! A linear function of the state: one component, or the difference of two.

/// A component of the state, or the difference of two, with a sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// One or minus one.
    pub sign: f64,
    /// Index of the component.
    pub upper: usize,
    /// Index of the component that is subtracted.
    pub lower: Option<usize>,
}

impl Difference {
    /// Value for the components of a vector.
    #[inline(always)]
    pub fn of(self, x: &[f64]) -> f64 {
        self.by(|index| x[index])
    }

    /// Value for components that a function returns by index.
    #[inline(always)]
    pub fn by(self, x: impl Fn(usize) -> f64) -> f64 {
        self.sign * (x(self.upper) - self.lower.map_or(0.0, &x))
    }
}
