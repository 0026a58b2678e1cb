//! State vectors whose length is known at compile time, or not: what a method of integration advances.

/// A state or a set of free angles: a fixed array where the size is known at compile time, a `Vec` where it is not.
pub trait StateVector: Clone + Send + Sync {
    /// A list of the same length with entries of another type.
    type Of<T: Clone + Send + Sync>: AsRef<[T]> + AsMut<[T]> + Clone + Send + Sync;

    /// The components.
    fn as_slice(&self) -> &[f64];
    /// The components, to be written.
    fn as_mut_slice(&mut self) -> &mut [f64];
    /// A list with the entry `fill` for each component.
    fn each<T: Clone + Send + Sync>(&self, fill: T) -> Self::Of<T>;
    /// Replaces the components by `Σ weight · vector`, summed vector by vector.
    fn set_to_sum<'v>(&mut self, terms: impl Iterator<Item = (f64, &'v Self)>)
    where
        Self: 'v;
}

impl<const D: usize> StateVector for [f64; D] {
    type Of<T: Clone + Send + Sync> = [T; D];

    #[inline(always)]
    fn each<T: Clone + Send + Sync>(&self, fill: T) -> [T; D] {
        std::array::from_fn(|_| fill.clone())
    }

    // The sum is a value of its own: it stays in registers.
    #[inline(always)]
    fn set_to_sum<'v>(&mut self, terms: impl Iterator<Item = (f64, &'v [f64; D])>) {
        let mut sum = [0.0; D];
        terms.for_each(|(weight, vector)| sum.iter_mut().zip(vector).for_each(|(sum, x)| *sum += weight * x));
        *self = sum;
    }

    #[inline(always)]
    fn as_slice(&self) -> &[f64] {
        self
    }

    #[inline(always)]
    fn as_mut_slice(&mut self) -> &mut [f64] {
        self
    }
}

impl StateVector for Vec<f64> {
    type Of<T: Clone + Send + Sync> = Vec<T>;

    fn each<T: Clone + Send + Sync>(&self, fill: T) -> Vec<T> {
        vec![fill; self.len()]
    }

    fn set_to_sum<'v>(&mut self, terms: impl Iterator<Item = (f64, &'v Vec<f64>)>) {
        self.fill(0.0);
        terms.for_each(|(weight, vector)| self.iter_mut().zip(vector).for_each(|(sum, x)| *sum += weight * x));
    }

    fn as_slice(&self) -> &[f64] {
        self
    }

    fn as_mut_slice(&mut self) -> &mut [f64] {
        self
    }
}
