//! One block as one writes it by hand, for all peers that are compiled in.
//!
//! With `s` the side that it leans to and `w = α - s θ` the angle left to its balance, docs/book/model.md, section 3 is
//!
//! ```text
//!     ẅ = p² ((1 + ÿ_g/g) sin w + s ẍ_g/g cos w)          rocks while w < α
//!     at w = α:  ẇ <- -r ẇ,  s <- -s          r = ω⁺/ω⁻
//! ```
//!
//! so both modes are one, and a step needs one sine and cosine.

/// Sizes and impact law of a block on its ground.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// `p² = 3 g / (4 R)` `[1/s²]`.
    pub p2: f64,
    /// Slenderness `α [rad]`.
    pub alpha: f64,
    /// Ratio of the rates after and before an impact.
    pub ratio: f64,
    /// `[m/s²]`
    pub gravity: f64,
}

impl Block {
    /// A homogeneous rectangle, half-sizes `[m]`; `eta` as ratio of the rates, Housner's where there is none.
    pub fn new(half_width: f64, half_height: f64, eta: Option<f64>) -> Block {
        let (gravity, alpha) = (9.81, half_width.atan2(half_height));
        let housner = 1.0 - 1.5 * alpha.sin() * alpha.sin();
        let p2 = 0.75 * gravity / half_width.hypot(half_height);
        Block { p2, alpha, ratio: eta.unwrap_or(housner), gravity }
    }

    /// `ẅ` with `drive = s ẍ_g / g` and `lift = ÿ_g / g`.
    #[inline(always)]
    pub fn acceleration(&self, w: f64, drive: f64, lift: f64) -> f64 {
        let (sin, cos) = w.sin_cos();
        self.p2 * ((1.0 + lift) * sin + drive * cos)
    }

    /// Ground acceleration over gravity that opens it.
    pub fn uplift(&self) -> f64 {
        self.alpha.tan()
    }
}

/// A one-sine pulse on a block, and for how long it is followed.
#[derive(Clone, Copy, Debug)]
pub struct Pulse {
    /// The block.
    pub block: Block,
    /// Amplitude over gravity; must be above the uplift's.
    pub amplitude: f64,
    /// `[rad/s]`
    pub omega: f64,
    /// `[s]`
    pub t_end: f64,
}

impl Pulse {
    /// When the block opens `[s]`: closed form.
    pub fn start(&self) -> f64 {
        (self.block.uplift() / self.amplitude).asin() / self.omega
    }

    /// When the ground comes to rest `[s]`.
    pub fn end(&self) -> f64 {
        std::f64::consts::TAU / self.omega
    }

    /// Smooth stretches: begin, end, and amplitude over gravity.
    pub fn stretches(&self) -> [[f64; 3]; 2] {
        [[self.start(), self.end(), self.amplitude], [self.end(), self.t_end, 0.0]]
    }
}

/// Samples of ground acceleration on a block, linear in between.
#[derive(Clone, Debug)]
pub struct Shaking {
    /// The block.
    pub block: Block,
    /// To the side and upwards, over gravity.
    pub accel: Vec<[f64; 2]>,
    /// `[s]`
    pub dt: f64,
}

/// Ground acceleration over gravity in one interval of samples: `value + slope (t - start)`.
#[derive(Clone, Copy, Debug)]
pub struct Ramp {
    /// `[s]`
    pub start: f64,
    /// `[s]`
    pub end: f64,
    /// At the start, to the side and upwards.
    pub value: [f64; 2],
    /// `[1/s]`
    pub slope: [f64; 2],
}

impl Ramp {
    /// The accelerations at a time.
    #[inline(always)]
    pub fn at(&self, t: f64) -> [f64; 2] {
        [0, 1].map(|k| self.value[k] + self.slope[k] * (t - self.start))
    }
}

impl Shaking {
    /// The intervals.
    pub fn ramps(&self) -> impl Iterator<Item = Ramp> {
        let value = |pair: &[[f64; 2]]| (pair[0], [0, 1].map(|k| (pair[1][k] - pair[0][k]) / self.dt));
        let ramps = self.accel.windows(2).map(value).enumerate();
        ramps.map(|(k, (value, slope))| {
            let [start, end] = [k, k + 1].map(|k| k as f64 * self.dt);
            Ramp { start, end, value, slope }
        })
    }

    /// The intervals from the instant in which the block opens, and the side to which it leans then.
    pub fn ramps_from_start(&self) -> (impl Iterator<Item = Ramp>, f64) {
        let uplift = self.block.uplift();
        let opens = |[side, up]: &[f64; 2]| side.abs() > uplift * (1.0 + up);
        let place = self.accel.iter().position(opens).expect("the record opens the block");
        let sign = self.accel[place][0].signum();
        let cut = move |ramp: Ramp| {
            let Ramp { value, slope, .. } = ramp;
            let excess = sign * value[0] - uplift * (1.0 + value[1]);
            let start = ramp.start + (-excess / (sign * slope[0] - uplift * slope[1])).max(0.0);
            Ramp { start, value: ramp.at(start), ..ramp }
        };
        let ramps = self.ramps().skip(place - 1).enumerate();
        (ramps.map(move |(k, ramp)| if k == 0 { cut(ramp) } else { ramp }), -sign)
    }
}

/// Where a block is.
#[derive(Clone, Copy, Debug)]
pub struct Lean {
    /// Angle left to its balance, and its rate `[rad]`, `[rad/s]`.
    pub w: [f64; 2],
    /// Side: +1 to the right.
    pub side: f64,
}

impl Lean {
    /// On the verge of opening to a side.
    pub fn start(block: &Block, side: f64) -> Lean {
        Lean { w: [block.alpha, 0.0], side }
    }

    /// After an impact with rate `ẇ`.
    pub fn hit(&mut self, block: &Block, rate: f64) {
        *self = Lean { w: [block.alpha, -block.ratio * rate], side: -self.side };
    }

    /// `θ [rad]`
    pub fn theta(&self, block: &Block) -> f64 {
        self.side * (block.alpha - self.w[0])
    }
}
