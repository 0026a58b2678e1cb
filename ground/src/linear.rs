//! A ground acceleration that is linear in time, integrated exactly.
//!
//! Over an interval of length `h` from `a` to `b`, with `s = (b - a)/h`:
//!
//! ```text
//! v(τ) = v + a τ + s τ²/2          d(τ) = d + v τ + a τ²/2 + s τ³/6
//! ```

/// An interval of linear acceleration.
#[derive(Clone, Copy)]
pub struct LinearInterval {
    /// Acceleration at the start `[m/s²]`.
    pub a: f64,
    /// Acceleration at the end `[m/s²]`.
    pub b: f64,
    /// Length `[s]`.
    pub h: f64,
    /// Velocity at the start `[m/s]`.
    pub v: f64,
    /// Displacement at the start `[m]`.
    pub d: f64,
}

impl LinearInterval {
    fn slope(&self) -> f64 {
        (self.b - self.a) / self.h
    }

    /// Velocity at `tau` from the start `[m/s]`.
    pub fn velocity(&self, tau: f64) -> f64 {
        self.v + tau * (self.a + 0.5 * tau * self.slope())
    }

    /// Displacement at `tau` from the start `[m]`.
    pub fn displacement(&self, tau: f64) -> f64 {
        self.d + tau * (self.v + tau * (0.5 * self.a + tau * self.slope() / 6.0))
    }

    /// `∫ a² dt` up to `tau` `[m²/s³]`.
    pub fn energy(&self, tau: f64) -> f64 {
        let end = self.a + tau * self.slope();
        tau * (self.a * self.a + self.a * end + end * end) / 3.0
    }

    /// `∫ |a| dt` over the interval `[m/s]`.
    #[inline]
    pub fn absolute(&self) -> f64 {
        let (a, b) = (self.a.abs(), self.b.abs());
        // Two triangles where the sign changes.
        let mean = if self.a * self.b < 0.0 { (a / (a + b)) * a + (b / (a + b)) * b } else { a + b };
        0.5 * self.h * mean
    }

    /// Largest magnitudes of velocity `[m/s]` and displacement `[m]` at the end and where their derivatives vanish. The start is left out.
    pub fn peaks(&self) -> [f64; 2] {
        let largest = |size: fn(&Self, f64) -> f64, places: &[f64]| {
            let inside = places.iter().filter(|tau| **tau > 0.0 && **tau < self.h);
            inside.fold(size(self, self.h).abs(), |largest, tau| largest.max(size(self, *tau).abs()))
        };
        // Zeros of the velocity: `2 q / slope` is the root without cancellation, `v / q` follows from the product of both roots. If the velocity
        // has no zero, both are NaN.
        let root = (self.a * self.a - 2.0 * self.slope() * self.v).sqrt();
        let q = -0.5 * (self.a + root.copysign(self.a));
        [
            largest(Self::velocity, &[-self.a / self.slope()]),
            largest(Self::displacement, &[q / (0.5 * self.slope()), self.v / q]),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_between_the_ends_are_found() {
        // v is largest, 1/4, in the middle, and zero at the end; d ends at 1/2 - 2/6.
        let [v, d] = LinearInterval { a: 1.0, b: -1.0, h: 1.0, v: 0.0, d: 0.0 }.peaks();
        assert!((v - 0.25).abs() < 1e-15 && (d - 1.0 / 6.0).abs() < 1e-15);
        // v = τ - 2τ² turns at 1/2, where d = 1/8 - 1/12 = 1/24, and ends at -1.
        let swing = LinearInterval { a: 1.0, b: -3.0, h: 1.0, v: 0.0, d: 0.0 };
        assert!((swing.displacement(0.5) - 1.0 / 24.0).abs() < 1e-15);
        let [v, d] = LinearInterval { d: 0.2, ..swing }.peaks();
        assert!((v - 1.0).abs() < 1e-15 && (d - (0.2 + 1.0 / 24.0)).abs() < 1e-15);
    }
}
