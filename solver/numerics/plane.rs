//! Vectors and rotations of the plane. Rotations are clockwise: `R(θ) (u, v) = (u cos θ + v sin θ, v cos θ - u sin θ)`.

use super::sines;

/// A vector of the plane, `[x, y]`.
pub type Vec2 = [f64; 2];

/// `a + b`
#[inline(always)]
pub fn plus(a: Vec2, b: Vec2) -> Vec2 {
    [a[0] + b[0], a[1] + b[1]]
}

/// `a - b`
#[inline(always)]
pub fn minus(a: Vec2, b: Vec2) -> Vec2 {
    [a[0] - b[0], a[1] - b[1]]
}

/// `factor a`
#[inline(always)]
pub fn scaled(a: Vec2, factor: f64) -> Vec2 {
    [a[0] * factor, a[1] * factor]
}

/// Length of a vector.
#[inline(always)]
pub fn size([x, y]: Vec2) -> f64 {
    libm::hypot(x, y)
}

/// Velocity of a point of a body that turns clockwise at this rate about a point at rest; `r` leads from the point at rest to the other.
#[inline(always)]
pub fn swept(rate: f64, r: Vec2) -> Vec2 {
    [rate * r[1], -rate * r[0]]
}

/// Sine and cosine of an angle.
#[derive(Clone, Copy, Debug)]
pub struct Rotation {
    /// Sine.
    pub sin: f64,
    /// Cosine.
    pub cos: f64,
}

impl Rotation {
    /// No rotation.
    pub const NONE: Rotation = Rotation { sin: 0.0, cos: 1.0 };

    /// Rotation by an angle `[rad]`.
    pub fn by(angle: f64) -> Rotation {
        let (sin, cos) = sines::sin_cos(angle);
        Rotation { sin, cos }
    }

    /// `R(θ) (u, v)`
    #[inline(always)]
    pub fn rotate(self, [u, v]: Vec2) -> Vec2 {
        [u * self.cos + v * self.sin, v * self.cos - u * self.sin]
    }

    /// `R(-θ) (x, y)`
    #[inline(always)]
    pub fn rotate_back(self, [x, y]: Vec2) -> Vec2 {
        [x * self.cos - y * self.sin, x * self.sin + y * self.cos]
    }
}
