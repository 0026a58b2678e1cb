//! Three free angles as one writes them by hand: docs/book/model.md, section 3 for the pattern (+, -, +), held both ways.
//!
//! With `d_k = (p_{k+1} - p_k, 2 h)`, `S_l = m_l (-p_l, h) + (Σ_{i>l} m_i) d_l` and `δ = θ_l - θ_k`, `k < l`,
//!
//! ```text
//!     M_kl = d_k · R(δ) S_l = a cos δ + b sin δ,      M_kl' = -a sin δ + b cos δ
//!     Σ_l M_kl θ̈_l + Σ_{l>k} M_kl' θ̇_l² - Σ_{l<k} M_lk' θ̇_l² + ẍ_g (v cos θ_k - u sin θ_k) - g (u cos θ_k + v sin θ_k) = 0
//! ```
//!
//! with `(u, v) = S_k`. Constants are computed once, sines of differences come from those of the angles.

/// Constants of the equations, the harmonic that drives them, and where they begin.
#[derive(Clone, Copy, Debug)]
pub struct Hinges {
    /// `M_kk [kg m²]`
    pub diagonal: [f64; 3],
    /// `[a, b]` of the pairs (0, 1), (0, 2), (1, 2) `[kg m²]`.
    pub coupling: [[f64; 2]; 3],
    /// `S_k [kg m]`
    pub weight: [[f64; 2]; 3],
    /// Amplitude `[m/s²]` and angular frequency `[rad/s]` of the ground.
    pub ground: [f64; 2],
    /// `[θ, θ̇]` at first.
    pub start: [f64; 6],
}

const GRAVITY: f64 = 9.81;
const SIGNS: [f64; 3] = [1.0, -1.0, 1.0];

impl Hinges {
    /// Three equal blocks of unit density, half-sizes `[m]`.
    pub fn new(half_width: f64, half_height: f64, start: [f64; 6], ground: [f64; 2]) -> Hinges {
        let (b, h) = (half_width, half_height);
        let mass = 4.0 * b * h;
        let inertia = mass * (b * b + h * h) / 3.0;
        let pivot = SIGNS.map(|sign| sign * b);
        let above = [2.0 * mass, mass, 0.0];
        let link: [[f64; 2]; 3] =
            std::array::from_fn(|k| [pivot.get(k + 1).map_or(0.0, |next| next - pivot[k]), 2.0 * h]);
        let weight: [[f64; 2]; 3] =
            std::array::from_fn(|k| [above[k] * link[k][0] - mass * pivot[k], above[k] * link[k][1] + mass * h]);
        let square = |v: [f64; 2]| v[0] * v[0] + v[1] * v[1];
        let diagonal = std::array::from_fn(|k| inertia + mass * square([pivot[k], h]) + above[k] * square(link[k]));
        let coupling = [(0, 1), (0, 2), (1, 2)].map(|(k, l): (usize, usize)| {
            let ([x, y], [u, v]) = (link[k], weight[l]);
            [x * u + y * v, x * v - y * u]
        });
        Hinges { diagonal, coupling, weight, ground, start }
    }

    /// `[θ̇, θ̈]`
    #[inline(always)]
    pub fn slope(&self, t: f64, x: &[f64; 6]) -> [f64; 6] {
        let [amplitude, omega] = self.ground;
        let ground = amplitude * (omega * t).sin();
        let turn = [x[0].sin_cos(), x[1].sin_cos(), x[2].sin_cos()];
        let square = [x[3] * x[3], x[4] * x[4], x[5] * x[5]];
        let pair = |index: usize, k: usize, l: usize| {
            let ([a, b], (sin_k, cos_k), (sin_l, cos_l)) = (self.coupling[index], turn[k], turn[l]);
            let (sin, cos) = (sin_l * cos_k - cos_l * sin_k, cos_l * cos_k + sin_l * sin_k);
            (a * cos + b * sin, b * cos - a * sin)
        };
        let ((m01, n01), (m02, n02), (m12, n12)) = (pair(0, 0, 1), pair(1, 0, 2), pair(2, 1, 2));
        let load = |k: usize| {
            let ([u, v], (sin, cos)) = (self.weight[k], turn[k]);
            GRAVITY * (u * cos + v * sin) - ground * (v * cos - u * sin)
        };
        let load = [
            load(0) - n01 * square[1] - n02 * square[2],
            load(1) + n01 * square[0] - n12 * square[2],
            load(2) + n02 * square[0] + n12 * square[1],
        ];
        // Elimination from the top block down.
        let [m00, m11, m22] = self.diagonal;
        let top = 1.0 / m22;
        let (f0, f1) = (m02 * top, m12 * top);
        let (m00, m01, m11) = (m00 - f0 * m02, m01 - f0 * m12, m11 - f1 * m12);
        let (r0, r1) = (load[0] - f0 * load[2], load[1] - f1 * load[2]);
        let scale = 1.0 / (m00 * m11 - m01 * m01);
        let (a0, a1) = ((r0 * m11 - r1 * m01) * scale, (r1 * m00 - r0 * m01) * scale);
        [x[3], x[4], x[5], a0, a1, (load[2] - m02 * a0 - m12 * a1) * top]
    }
}
