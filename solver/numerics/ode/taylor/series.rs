//! Taylor series of angles whose equations are linear in second derivatives of their sines and cosines.
//!
//! ```text
//! J_a θ̈_a + cos θ_a · C_a + sin θ_a · S_a = 0,     C, S linear in (cos θ)¨, (sin θ)¨ of the other angles and in a forcing
//! ```
//!
//! Coefficients are computed order by order. With `c, s` the coefficients of cosine and sine, `ω` those of the rate,
//!
//! ```text
//! (k+2) s[k+2] = Σ c[j] ω[k+1-j],     (k+2) c[k+2] = -Σ s[j] ω[k+1-j]
//! M(θ) θ̈[k]    = -(c[0] C°[k] + s[0] S°[k] + Σ_{j>0} c[j] C[k-j] + s[j] S[k-j])
//! ```
//!
//! where `°` leaves out the contribution of `θ̈[k]` itself. That contribution is in `M`, so that one factorisation of `M` serves all
//! orders. Four convolutions per angle, in two pairs, are all the work that grows with the order.

use super::alone;
use super::coefficients::{MAX_ORDER, NUMBER, RECIPROCAL, TERMS, reciprocal, turned};
use crate::numerics::state_vector::StateVector;
use std::fmt;
use wide::f64x2;

/// Equations of the form above.
pub trait SeriesSystem {
    /// `[θ, θ̇]`
    type State: StateVector;
    /// One value per angle.
    type Links: StateVector;

    /// Moves the expansion point to `t`: computes the first `orders` coefficients of the forcing there.
    fn expand_at(&mut self, t: f64, orders: usize);

    /// The matrix `M`, row by row, at a state whose cosines and sines are given too.
    fn matrix(&self, x: &Self::State, cos: &Self::Links, sin: &Self::Links, matrix: &mut [f64]);

    /// The weights `[C, S]` of one order.
    fn weights(&mut self, order: usize, cos_ddot: &Self::Links, sin_ddot: &Self::Links) -> [Self::Links; 2];

    /// Sine and cosine.
    fn sin_cos(angle: f64) -> (f64, f64);
}

/// The series at a state.
#[derive(Clone)]
pub struct Series<V, L: StateVector> {
    /// Time of the expansion point `[s]`.
    pub t: f64,
    /// State `[θ, θ̇]` at the expansion point.
    pub x: V,
    /// Highest order of the rates' coefficients that has been computed.
    pub known: usize,
    /// Largest order of the rates' coefficients that may be computed.
    pub largest_order: usize,
    is_begun: bool,
    /// `[c, s]` per angle, order by order.
    pub circle: [L::Of<f64x2>; TERMS],
    /// `[ω, ω]` and `[C, S]` per angle, order by order; the weights of order `k` stand at `k + 1`.
    pub driver: [L::Of<[f64x2; 2]>; TERMS],
    /// Factors of `M = L D Lᵀ`, row by row: `L` below the diagonal, `1 / D` on it.
    factor: Vec<f64>,
    cos_ddot: L,
    sin_ddot: L,
}

impl<V: fmt::Debug, L: StateVector> fmt::Debug for Series<V, L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Series")
            .field("t", &self.t)
            .field("x", &self.x)
            .field("known", &self.known)
            .finish_non_exhaustive()
    }
}

impl<V: StateVector, L: StateVector> Series<V, L> {
    /// Storage for states like `zero` and angles like `zero_links`.
    pub fn new(zero: &V, zero_links: &L, largest_order: usize) -> Series<V, L> {
        let dof = zero_links.as_slice().len();
        Series {
            t: 0.0,
            x: zero.clone(),
            known: 0,
            largest_order,
            is_begun: false,
            circle: std::array::from_fn(|_| zero_links.each(f64x2::ZERO)),
            driver: std::array::from_fn(|_| zero_links.each([f64x2::ZERO; 2])),
            factor: vec![0.0; dof * dof],
            cos_ddot: zero_links.clone(),
            sin_ddot: zero_links.clone(),
        }
    }

    /// Number of angles.
    #[inline(always)]
    pub fn dof(&self) -> usize {
        self.cos_ddot.as_slice().len()
    }

    /// The same value for each angle.
    #[inline(always)]
    pub fn of_each<T: Clone + Send + Sync>(&self, value: T) -> L::Of<T> {
        self.cos_ddot.each(value)
    }

    /// Forgets the series: the equations have changed.
    pub fn forget(&mut self) {
        self.is_begun = false;
    }

    /// Whether the present series is about this place.
    pub fn is_at(&self, t: f64, x: &V) -> bool {
        self.is_begun && self.t == t && self.x.as_slice() == x.as_slice()
    }

    /// Computes the series about a place, at least up to an order.
    #[inline(always)]
    pub fn expand<S: SeriesSystem<State = V, Links = L>>(&mut self, system: &mut S, t: f64, x: &V, order: usize) {
        if !self.is_at(t, x) {
            self.begin_at(system, t, x);
        }
        while self.known < order {
            self.extend(system, order);
        }
    }

    #[inline(always)]
    fn begin_at<S: SeriesSystem<State = V, Links = L>>(&mut self, system: &mut S, t: f64, x: &V) {
        (self.t, self.known, self.is_begun) = (t, 0, true);
        self.x.clone_from(x);
        let dof = self.cos_ddot.as_slice().len();
        let (x, circle) = (self.x.as_slice(), &mut self.circle[..2]);
        for link in 0..dof {
            let (sin, cos) = S::sin_cos(x[link]);
            let rate = x[dof + link];
            circle[0].as_mut()[link] = f64x2::new([cos, sin]);
            self.driver[0].as_mut()[link] = [f64x2::splat(rate), f64x2::ZERO];
            circle[1].as_mut()[link] = f64x2::new([-sin * rate, cos * rate]);
            self.cos_ddot.as_mut_slice()[link] = cos;
            self.sin_ddot.as_mut_slice()[link] = sin;
        }
        system.expand_at(t, self.largest_order);
        system.matrix(&self.x, &self.cos_ddot, &self.sin_ddot, &mut self.factor);
        factorise(&mut self.factor, dof);
    }

    /// Adds one more order; with one angle, all orders up to `order`.
    #[inline(always)]
    pub fn extend<S: SeriesSystem<State = V, Links = L>>(&mut self, system: &mut S, order: usize) {
        if self.cos_ddot.as_slice().len() == 1 {
            self.extend_alone(system, order);
        } else {
            self.extend_coupled(system);
        }
    }

    /// Adds all orders of one angle up to `order`.
    #[inline(always)]
    fn extend_alone<S: SeriesSystem<State = V, Links = L>>(&mut self, system: &mut S, order: usize) {
        let share = f64x2::splat(-self.factor[0]);
        for (k, driver) in (self.known..).zip(&mut self.driver[self.known + 1..=order]) {
            let [cos_weight, sin_weight] = system.weights(k, &self.cos_ddot, &self.sin_ddot);
            driver.as_mut()[0][1] = f64x2::new([cos_weight.as_slice()[0], sin_weight.as_slice()[0]]) * share;
        }
        alone::extend::<L>(&mut self.circle, &mut self.driver, self.known..order);
        self.known = order;
    }

    /// Adds one more order of several angles.
    #[inline(always)]
    fn extend_coupled<S: SeriesSystem<State = V, Links = L>>(&mut self, system: &mut S) {
        // The bound spares checks of indices.
        let (k, dof) = (self.known.min(MAX_ORDER), self.cos_ddot.as_slice().len());
        let next = NUMBER[k + 1];
        let mut sums = convolve(&self.cos_ddot, &self.circle[1..=k + 1], &self.driver[..=k]);
        let sums = sums.as_mut();
        for (link, sums) in sums.iter().enumerate() {
            let [cos_omega, sin_omega] = sums[0].to_array();
            self.cos_ddot.as_mut_slice()[link] = -next * sin_omega;
            self.sin_ddot.as_mut_slice()[link] = next * cos_omega;
        }
        let [cos_weight, sin_weight] = system.weights(k, &self.cos_ddot, &self.sin_ddot);
        // A clone has the length of the angles; all its entries are overwritten.
        let mut load = self.cos_ddot.clone();
        let start = self.circle[0].as_ref();
        for link in 0..dof {
            let ([cos, sin], [of_cos, of_sin]) = (start[link].to_array(), sums[link][1].to_array());
            let own = cos * cos_weight.as_slice()[link] + sin * sin_weight.as_slice()[link];
            load.as_mut_slice()[link] = -((of_cos + of_sin) + own);
        }
        solve(&self.factor, load.as_mut_slice());
        let acceleration = load.as_slice();
        for link in 0..dof {
            let [cos, sin] = start[link].to_array();
            self.cos_ddot.as_mut_slice()[link] -= sin * acceleration[link];
            self.sin_ddot.as_mut_slice()[link] += cos * acceleration[link];
        }
        let [cos_weight, sin_weight] = system.weights(k, &self.cos_ddot, &self.sin_ddot);
        let (known, later) = self.circle.split_at_mut(1);
        let (start, later) = (known[0].as_ref(), later[k + 1].as_mut());
        let driver = self.driver[k + 1].as_mut();
        for link in 0..dof {
            // Products of pairs, so that each pair is stored in one piece, as the next order reads it.
            let rate = f64x2::splat(acceleration[link]) * reciprocal(k + 1);
            // Next coefficients: the share of the convolutions, and the share of θ̈.
            later[link] = (turned(sums[link][0]) + turned(start[link]) * rate) * reciprocal(k + 2);
            driver[link] = [rate, f64x2::new([cos_weight.as_slice()[link], sin_weight.as_slice()[link]])];
        }
        self.known = k + 1;
    }

    /// Writes the state after `h`, by the series up to an order. Returns per angle the sums of the magnitudes of the terms of
    /// `[rate, mean rate]`, the constant term left out.
    #[inline(always)]
    pub fn state_at(&self, order: usize, h: f64, state: &mut V) -> L::Of<f64x2> {
        let dof = self.cos_ddot.as_slice().len();
        let zero = || self.cos_ddot.each(f64x2::ZERO);
        let (mut sums, mut sizes, step) = (zero(), zero(), f64x2::splat(h));
        for j in (1..=order.min(MAX_ORDER)).rev() {
            let shares = f64x2::new([1.0, RECIPROCAL[j + 1]]);
            let links = sums.as_mut().iter_mut().zip(sizes.as_mut()).zip(self.driver[j].as_ref());
            for ((sum, size), driver) in links {
                let own = driver[0] * shares;
                *sum = (*sum + own) * step;
                *size = (*size + own.abs()) * step;
            }
        }
        let x = self.x.as_slice();
        for (link, sum) in sums.as_ref().iter().enumerate() {
            let ([rate, mean], start) = (sum.to_array(), x[dof + link]);
            state.as_mut_slice()[dof + link] = start + rate;
            state.as_mut_slice()[link] = x[link] + h * (start + mean);
        }
        sizes
    }
}

/// The rate's coefficient.
#[inline(always)]
pub fn rate_of(driver: &[f64x2; 2]) -> f64 {
    driver[0].as_array()[0]
}

/// `[Σ c ω, Σ s ω]` and `[Σ c C, Σ s S]` of each angle: products of the first entry of `circle` with the last of `driver`, and so on. The newest
/// entries come last, so that all other products are summed while the newest are still being computed.
#[inline(always)]
fn convolve<L: StateVector>(like: &L, circle: &[L::Of<f64x2>], driver: &[L::Of<[f64x2; 2]>]) -> L::Of<[f64x2; 2]> {
    let (dof, last) = (like.as_slice().len(), circle.len().min(driver.len()) - 1);
    let (circle, driver) = (&circle[..=last], &driver[..=last]);
    let mut sums = like.each([f64x2::ZERO; 2]);
    let mut add = |circle: &L::Of<f64x2>, driver: &L::Of<[f64x2; 2]>| {
        let (circle, driver) = (&circle.as_ref()[..dof], &driver.as_ref()[..dof]);
        for (sum, (circle, driver)) in sums.as_mut().iter_mut().zip(circle.iter().zip(driver)) {
            sum[0] += *circle * driver[0];
            sum[1] += *circle * driver[1];
        }
    };
    if let ([first, known @ .., newest], [start, before @ .., latest]) = (circle, driver) {
        known.iter().zip(before.iter().rev()).for_each(|(circle, driver)| add(circle, driver));
        add(first, latest);
        add(newest, start);
    } else {
        add(&circle[0], &driver[0]);
    }
    sums
}

/// Factorises into `L D Lᵀ` in place: `L` below the diagonal, `1 / D` on it, `D Lᵀ` above it.
#[inline(always)]
fn factorise(matrix: &mut [f64], dof: usize) {
    let matrix = &mut matrix[..dof * dof];
    for row in 0..dof {
        for column in 0..row {
            let mut value = matrix[row * dof + column];
            for inner in 0..column {
                // Above the diagonal stands D Lᵀ of the rows done.
                value -= matrix[inner * dof + row] * matrix[column * dof + inner];
            }
            matrix[column * dof + row] = value;
            matrix[row * dof + column] = value * matrix[column * dof + column];
        }
        let mut diagonal = matrix[row * dof + row];
        for inner in 0..row {
            diagonal -= matrix[inner * dof + row] * matrix[row * dof + inner];
        }
        matrix[row * dof + row] = 1.0 / diagonal;
    }
}

#[inline(always)]
fn solve(factor: &[f64], x: &mut [f64]) {
    let dof = x.len();
    let factor = &factor[..dof * dof];
    for row in 1..dof {
        for column in 0..row {
            x[row] -= factor[row * dof + column] * x[column];
        }
    }
    for row in (0..dof).rev() {
        x[row] *= factor[row * dof + row];
        for above in row + 1..dof {
            x[row] -= factor[above * dof + row] * x[above];
        }
    }
}
