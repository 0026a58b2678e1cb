//! One block against closed forms: 10,000 impacts without loss, a hundred with loss, and the linear limit under a one-sine pulse.
//!
//! Free rocking of a rectangle is `θ̈ = -p² sin(α - θ)` for `θ > 0` (Housner 1963), `p² = 3 g / (4 R)`. With `ψ = α - θ` its
//! first integral and the time from a tilt `θ_0` to the ground are
//!
//! ```text
//!     ω² = 4 p² (D² - sin(α - θ/2) sin(θ/2)),     D² = sin(α - θ_0/2) sin(θ_0/2)
//!     T  = (1/p) ∫ ds / sqrt((s² - k²)(1 - s²)),  s = sin(ψ/2) from k = sin(ψ_0/2) to a = sin(α/2),  k² = a² - D²
//!        = (D/p) R_F(a² (1 - k²), k² (1 - k²), (1 - a²) k²)
//! ```
//!
//! by Carlson's symmetric integral (DLMF 19.29.4, one limit at a zero of a factor). The block lands with `ω = 2 p D`, and an
//! impact with `ω⁺ = η ω⁻` only multiplies D by η: nothing here is integrated in steps.
//!
//! The linear limit `α -> 0` under `a sin Ωt` is, in units `α` and `1/p`, `θ̈ = θ - s - A sin(wτ)` with `A = a / (α g)` and
//! `w = Ω / p`, solved piece by piece (Zhang & Makris 2001): `θ = s + A/(1 + w²) sin(wτ) + c_+ e^τ + c_- e^-τ`. A positive ground
//! acceleration starts the block to the left, `s = -1` (docs/book/model.md, section 4).

use rocking::{Block, Column, EventKind, Method, Motion, Response, Restitution, Scene, StopReason, simulate};
use std::f64::consts::TAU;

const GRAVITY: f64 = 9.81;

/// Hops as small as the block makes them are followed: the closed forms have no rest either `[rad]`.
const NO_STICKING: f64 = 1e-14;

/// Relative tolerance of a step in free rocking: the tightest there is.
const RTOL: f64 = 1e-14;

/// What energy, rate or time may err by per impact, relative: a swing has 28 steps (DOP853) to 560 (order 5), and all of
/// them together err by no more than one of them may. Measured: at most 2e-15. It grows with the tolerance when that is
/// loosened, so it is the integration's error, not the impacts'.
const PER_IMPACT: f64 = RTOL;

/// `R_F(x, y, z)` by Carlson's duplication (DLMF 19.36(i)), to rounding.
fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let mean = |x: f64, y: f64, z: f64| (x + y + z) / 3.0;
    let largest = |x: f64, y: f64, z: f64| {
        let mean = mean(x, y, z);
        [x, y, z].iter().fold(0.0f64, |most, value| most.max((1.0 - value / mean).abs()))
    };
    // The series below stops before terms of sixth order, and each duplication divides the differences by four.
    while largest(x, y, z) > 1e-3 {
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        (x, y, z) = (0.25 * (x + lambda), 0.25 * (y + lambda), 0.25 * (z + lambda));
    }
    let mean = mean(x, y, z);
    let (u, v) = (1.0 - x / mean, 1.0 - y / mean);
    let w = -u - v;
    let (e2, e3) = (u * v - w * w, u * v * w);
    (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / mean.sqrt()
}

/// A free block: slenderness `[rad]` and frequency parameter `[rad/s]`.
#[derive(Clone, Copy)]
struct Housner {
    alpha: f64,
    p: f64,
}

impl Housner {
    fn of(half_width: f64, half_height: f64) -> Housner {
        Housner { alpha: half_width.atan2(half_height), p: (0.75 * GRAVITY / half_width.hypot(half_height)).sqrt() }
    }

    /// Plastic ratio `ω⁺/ω⁻`.
    fn ratio(self) -> f64 {
        1.0 - 1.5 * self.alpha.sin().powi(2)
    }

    /// `D` of the swing from a tilt `[rad]`: the rate on landing is `2 p D`.
    fn swing(self, tilt: f64) -> f64 {
        ((self.alpha - 0.5 * tilt).sin() * (0.5 * tilt).sin()).sqrt()
    }

    /// Time `[s]` from the largest angle of a swing to the ground.
    fn quarter_period(self, swing: f64) -> f64 {
        let a2 = (0.5 * self.alpha).sin().powi(2);
        let k2 = a2 - swing * swing;
        swing / self.p * carlson_rf(a2 * (1.0 - k2), k2 * (1.0 - k2), (1.0 - a2) * k2)
    }
}

/// A block let go of at a tilt `[rad]`, up to `t_end [s]`. The absolute tolerance is nowhere felt: the hundredth of the hops
/// that lose still has angles of 1e-11 rad.
fn let_go(
    method: Method,
    [half_width, half_height]: [f64; 2],
    restitution: Restitution,
    tilt: f64,
    t_end: f64,
) -> Response {
    let column = Column::new(vec![Block::rectangle(half_width, half_height, 2700.0)], GRAVITY).expect("positive sizes");
    let mut scene = Scene::new(column);
    scene.restitution = restitution;
    scene.initial.theta = vec![tilt];
    scene.options.method = method;
    scene.options.t_end = t_end;
    scene.options.rtol = RTOL;
    scene.options.atol = 1e-30;
    scene.options.stick_angle = NO_STICKING;
    simulate(&scene).expect("a run")
}

#[test]
fn carlsons_integral_has_its_known_values() {
    // DLMF 19.20.1 and 19.20.2: the constants of equal arguments and of the lemniscate, and R_C = acosh.
    assert!((carlson_rf(4.0, 4.0, 4.0) - 0.5).abs() < 1e-16);
    assert!((carlson_rf(0.0, 1.0, 2.0) - 1.311_028_777_146_059_9).abs() < 4e-16);
    assert!((carlson_rf(2.0, 1.0, 1.0) - 2.0f64.sqrt().acosh()).abs() < 4e-16);
}

#[test]
fn the_closed_form_of_a_swing_tends_to_housners_slender_block() {
    let block = Housner { alpha: 1e-6, p: 2.0 };
    let slender = (1.0f64 / (1.0 - 0.6)).acosh() / 2.0;
    // Terms of α², 1e-12.
    assert!((block.quarter_period(block.swing(0.6e-6)) / slender - 1.0).abs() < 1e-11);
}

/// Ten thousand impacts, each of which would conserve energy: `κ (1 - 3/2 sin² α) = 1`.
#[test]
fn validation_energy_stays_through_ten_thousand_impacts_without_loss() {
    const IMPACTS: usize = 10_000;
    let size = [0.4, 1.6];
    let block = Housner::of(size[0], size[1]);
    let tilt = 0.5 * block.alpha;
    let swing = block.swing(tilt);
    let quarter = block.quarter_period(swing);
    for method in Method::ACCURATE {
        let restitution = Restitution::Factors(vec![1.0 / block.ratio()]);
        let response = let_go(method, size, restitution, tilt, (2 * IMPACTS) as f64 * quarter);
        assert_eq!(response.impacts, IMPACTS, "{method:?}");
        // On the ground all energy is kinetic, ½ I_O ω², the potential energy of the upright block left out.
        let kinetic = |omega: f64| (omega / (2.0 * block.p * swing)).powi(2);
        let (mut drift, mut late) = (0.0f64, 0.0f64);
        for (number, event) in response.events.iter().enumerate() {
            let exact = (2 * number + 1) as f64 * quarter;
            late = late.max((event.t / exact - 1.0).abs());
            for omega in [event.omega_before[0], event.omega_after[0]] {
                drift = drift.max((kinetic(omega) - 1.0).abs());
            }
        }
        println!("{method:?}: energy drifts by {drift:.1e}, impact times by {late:.1e}, {} steps", response.work.steps);
        let bar = IMPACTS as f64 * PER_IMPACT;
        assert!(drift < bar && late < bar, "{method:?}: energy {drift:e}, times {late:e}");
    }
}

#[test]
fn validation_a_hundred_impacts_come_at_the_times_of_the_elliptic_integral() {
    const ETA: f64 = 0.9;
    const IMPACTS: usize = 100;
    for (size, share) in [([0.4, 1.6], 0.5), ([0.4, 1.6], 0.98), ([0.1, 2.0], 0.7), ([0.9, 1.5], 0.3)] {
        let block = Housner::of(size[0], size[1]);
        let tilt = share * block.alpha;
        let mut swing = block.swing(tilt);
        let mut t = block.quarter_period(swing);
        // When each impact comes, and with which rate.
        let mut exact = vec![(t, 2.0 * block.p * swing)];
        for _ in 1..IMPACTS {
            swing *= ETA;
            t += 2.0 * block.quarter_period(swing);
            exact.push((t, 2.0 * block.p * swing));
        }
        // Half a hop after the last impact.
        let end = t + block.quarter_period(ETA * swing);
        for method in Method::ACCURATE {
            let response = let_go(method, size, Restitution::Eta(ETA), tilt, end);
            assert_eq!(response.impacts, IMPACTS, "{method:?}");
            let (mut off, mut slow) = (0.0f64, 0.0f64);
            for (event, (t, rate)) in response.events.iter().zip(&exact) {
                off = off.max((event.t / t - 1.0).abs());
                slow = slow.max((event.omega_before[0].abs() / rate - 1.0).abs());
            }
            println!("{method:?}, {size:?}, tilt {share} α: times off by {off:.1e}, rates by {slow:.1e}");
            let bar = IMPACTS as f64 * PER_IMPACT;
            assert!(off < bar && slow < bar, "{method:?}, {size:?}: times {off:e}, rates {slow:e}");
        }
    }
}

/// `θ = s + C sin(wτ) + c_+ e^(τ - τ_0) + c_- e^-(τ - τ_0)`, angles in α, times in 1/p.
#[derive(Clone, Copy)]
struct Piece {
    from: f64,
    side: f64,
    /// `C = A / (1 + w²)`, zero after the pulse.
    forced: f64,
    w: f64,
    grows: f64,
    decays: f64,
}

impl Piece {
    fn new(from: f64, side: f64, [theta, rate]: [f64; 2], forced: f64, w: f64) -> Piece {
        let (sine, cosine) = (w * from).sin_cos();
        let (angle, rate) = (theta - side - forced * sine, rate - forced * w * cosine);
        Piece { from, side, forced, w, grows: 0.5 * (angle + rate), decays: 0.5 * (angle - rate) }
    }

    /// Angle and rate.
    fn at(&self, tau: f64) -> [f64; 2] {
        let (sine, cosine) = (self.w * tau).sin_cos();
        let (up, down) = (self.grows * (tau - self.from).exp(), self.decays * (self.from - tau).exp());
        [self.side + self.forced * sine + up + down, self.forced * self.w * cosine + up - down]
    }

    /// The first instant after the start and up to `until` at which the block has come back to the ground.
    fn landing(&self, until: f64) -> Option<f64> {
        const PLACES: usize = 4096;
        let lifted = |tau: f64| self.side * self.at(tau)[0];
        let place = |index: usize| self.from + (until - self.from) * index as f64 / PLACES as f64;
        let index = (1..=PLACES).find(|index| lifted(place(*index)) < 0.0)?;
        let (mut before, mut after) = (place(index - 1), place(index));
        // A landing in the first of the places would be found at the start: no hop of these scenes is that short.
        assert!(index > 1, "a hop below the resolution of the search");
        loop {
            let middle = 0.5 * (before + after);
            if middle <= before || middle >= after {
                return Some(after);
            }
            if lifted(middle) < 0.0 { after = middle } else { before = middle }
        }
    }
}

/// The linear block under a one-sine pulse of amplitude `A`: its pieces with the ends of all but the last, and whether it overturns.
struct Linear {
    pieces: Vec<Piece>,
    overturns: bool,
}

/// Impacts of the free phase that are followed.
const FREE_IMPACTS: usize = 12;

impl Linear {
    fn new(amplitude: f64, w: f64, eta: f64) -> Linear {
        assert!(amplitude > 1.0, "below αg nothing moves");
        let (uplift, end) = ((1.0 / amplitude).asin() / w, TAU / w);
        let mut pieces = vec![Piece::new(uplift, -1.0, [0.0, 0.0], amplitude / (1.0 + w * w), w)];
        let last = |pieces: &[Piece]| pieces[pieces.len() - 1];
        while let Some(tau) = last(&pieces).landing(end) {
            let [_, rate] = last(&pieces).at(tau);
            let Piece { side, forced, .. } = last(&pieces);
            pieces.push(Piece::new(tau, -side, [0.0, eta * rate], forced, w));
        }
        let mut side = last(&pieces).side;
        pieces.push(Piece::new(end, side, last(&pieces).at(end), 0.0, w));
        let mut overturns = false;
        for _ in 0..FREE_IMPACTS {
            // Free, s θ - 1 is c_+ e^τ + c_- e^-τ: it falls to -1 if c_+ is below zero and runs away otherwise.
            let Piece { from, grows, decays, .. } = last(&pieces);
            let (grows, decays) = (side * grows, side * decays);
            overturns = grows >= 0.0;
            if overturns {
                break;
            }
            // -grows e² - e - decays = 0 for e = e^(τ - from), the root above one.
            let e = (1.0 + (1.0 - 4.0 * grows * decays).sqrt()) / (-2.0 * grows);
            let tau = from + e.ln();
            let [_, rate] = last(&pieces).at(tau);
            side = -side;
            pieces.push(Piece::new(tau, side, [0.0, eta * rate], 0.0, w));
        }
        Linear { pieces, overturns }
    }

    fn angle(&self, tau: f64) -> f64 {
        self.pieces.iter().rev().find(|piece| piece.from <= tau).map_or(0.0, |piece| piece.at(tau)[0])
    }

    /// Where the block lands, in the pulse and after.
    fn landings(&self) -> Vec<f64> {
        self.pieces.windows(2).filter(|pair| pair[0].side != pair[1].side).map(|pair| pair[1].from).collect()
    }
}

/// Slenderness `[rad]` at which the linear solution is compared.
const SLENDER: f64 = 1e-6;

/// What angles may be off by in α and landings in 1/p: nonlinear terms are some α² = 1e-12 of the linear ones, and while the
/// block hovers near a threshold they grow as e^τ. Measured 7.5e-11 with all methods, whatever the tolerance; 7.5e-9 at
/// α = 1e-5 and 1.2e-12 at 1e-7, as terms of α² must. A thousand α² leave a factor of ten.
const LINEAR: f64 = 1e3 * SLENDER * SLENDER;

const ETA: f64 = 0.9;

/// `Ω / p`
const FREQUENCY: f64 = 5.0;

/// A block of slenderness 1e-6 under a pulse of `amplitude · α g`, and its p. Tolerances are shares of α, not of a radian.
fn slender(method: Method, amplitude: f64, tau_end: f64) -> (Scene, f64) {
    let column = Column::new(vec![Block::rectangle(SLENDER.tan(), 1.0, 1.0)], GRAVITY).expect("positive sizes");
    let p = Housner::of(SLENDER.tan(), 1.0).p;
    let mut scene = Scene::new(column);
    scene.restitution = Restitution::Eta(ETA);
    scene.excitation.horizontal =
        Some(Motion::SinePulse { amplitude: amplitude * SLENDER * GRAVITY, omega: FREQUENCY * p, start: 0.0 });
    scene.options.method = method;
    scene.options.t_end = tau_end / p;
    scene.options.rtol = 1e-13;
    scene.options.atol = 1e-14 * SLENDER;
    scene.options.stick_angle = NO_STICKING;
    (scene, p)
}

#[test]
fn validation_a_slender_block_follows_the_linear_solution_piece_by_piece() {
    // Away from the thresholds: standing, overturning after an impact, standing between, overturning without an impact.
    for amplitude in [1.5, 2.5, 3.0, 4.0, 6.6, 7.1, 8.0] {
        let exact = Linear::new(amplitude, FREQUENCY, ETA);
        let landings = exact.landings();
        // An overturning block is followed to some ten α.
        let tau_end = if exact.overturns { 4.0 } else { landings[6] };
        for method in Method::ACCURATE {
            let (mut scene, p) = slender(method, amplitude, tau_end);
            scene.output_dt = Some(tau_end / p / 1000.0);
            let response = simulate(&scene).expect("a run");
            let mut off = 0.0f64;
            for sample in &response.samples {
                off = off.max((sample.theta[0] / SLENDER - exact.angle(sample.t * p)).abs());
            }
            let impacts = response.events.iter().filter(|event| event.kind == EventKind::Impact);
            let pairs: Vec<_> = impacts.zip(&landings).collect();
            let late = pairs.iter().fold(0.0f64, |most, (event, tau)| most.max((event.t * p - *tau).abs()));
            println!(
                "{method:?}, A = {amplitude}: angles off by {off:.1e} α, {} landings by {late:.1e} / p",
                pairs.len()
            );
            assert!(response.samples.len() > 1000, "rows from start to end");
            // The last landing is the end of the run, on which side of it is rounding.
            assert!(pairs.len() + 1 >= landings.len().min(7), "{method:?}, A = {amplitude}: landings are missing");
            assert!(off < LINEAR && late < LINEAR, "{method:?}, A = {amplitude}: angles {off:e}, landings {late:e}");
        }
    }
}

/// The amplitude between `low` and `high` at which the outcome changes, to `width`.
fn threshold([mut low, mut high]: [f64; 2], width: f64, mut overturns: impl FnMut(f64) -> bool) -> f64 {
    let below = overturns(low);
    assert_ne!(below, overturns(high), "{low} and {high} must have different outcomes");
    while high - low > width {
        let middle = 0.5 * (low + high);
        if overturns(middle) == below { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn validation_the_thresholds_are_those_of_the_linear_block_to_ten_digits() {
    let brackets = [([2.9, 3.1], 3.0186), ([6.2, 6.4], 6.3181), ([7.0, 7.3], 7.1681)];
    for (bracket, published) in brackets {
        let exact = threshold(bracket, 1e-13, |amplitude| Linear::new(amplitude, FREQUENCY, ETA).overturns);
        assert!((exact - published).abs() < 0.5e-4, "{exact} against {published}");
        for method in Method::ACCURATE {
            // An excess of 1e-11 grows as e^τ: after some 25 units of time it is an α, after 35 it has overturned the block.
            let found = threshold(bracket, 1e-11, |amplitude| {
                let (mut scene, _) = slender(method, amplitude, 40.0);
                scene.options.overturn_angle = 1e4 * SLENDER;
                simulate(&scene).expect("a run").status == StopReason::Overturned
            });
            println!("{method:?}: {found:.12} against {exact:.12}");
            // The bracket's width, and nonlinear terms of some α²: runs at α = 1e-5 are off by 7e-10. Measured 1.0e-11.
            assert!((found - exact).abs() < 1e-10, "{method:?}: {found} against {exact}");
        }
    }
}

/// At loose tolerances a step may reach far beyond the landing, and its dense output name a time several times too late.
#[test]
fn landings_within_long_steps_keep_the_energy() {
    let (half_width, eta) = (0.01f64, 0.9f64);
    let come_to_rest = |method: Method, rtol: f64| {
        let column = Column::equal_blocks(1, half_width, 1.0, 1000.0, GRAVITY).expect("a block");
        let tilt = 0.5 * column.stack(0).slenderness();
        let mut scene = Scene::new(column);
        scene.initial.theta = vec![tilt];
        scene.restitution = Restitution::Eta(eta);
        (scene.options.method, scene.options.rtol, scene.options.t_end) = (method, rtol, 60.0);
        let response = simulate(&scene).expect("a run");
        assert_eq!(response.status, StopReason::AtRest, "{method:?} {rtol}");
        response
    };
    let exact = come_to_rest(Method::Auto, 1e-12);
    for method in [Method::Dop853, Method::DormandPrince54, Method::KuttaMerson, Method::Taylor] {
        for rtol in [1e-2, 1e-3, 1e-4] {
            let found = come_to_rest(method, rtol);
            assert!(
                (found.t_final / exact.t_final - 1.0).abs() < rtol.max(1e-3),
                "{method:?} {rtol}: {}",
                found.t_final
            );
        }
    }
}

/// A wavelet is cut off below 1e-6 of its amplitude. That is no event, but the steps after it begin with another acceleration.
#[test]
fn explicit_steps_go_on_after_a_wavelet_as_exactly_as_series() {
    for amplitude in [0.1, 0.3] {
        let wavelet = Motion::Gabor { velocity: amplitude / 12.0, omega: 12.0, gamma: 2.0, phase: 0.0, start: 0.0 };
        let at_end = |method: Method, rtol: f64| {
            let mut scene = Scene::new(Column::equal_blocks(1, 0.01, 1.0, 1000.0, GRAVITY).expect("a block"));
            scene.initial.theta = vec![0.005];
            scene.excitation.horizontal = Some(wavelet.clone());
            (scene.options.method, scene.options.rtol, scene.options.atol) = (method, rtol, 1e-3 * rtol);
            scene.options.t_end = 4.0;
            scene.output_dt = Some(0.1);
            simulate(&scene).expect("a run").samples.last().expect("rows").theta[0]
        };
        let exact = at_end(Method::Taylor, 1e-14);
        // Before, DOP853 erred by 5e-12.
        for method in [Method::Dop853, Method::DormandPrince54] {
            let error = (at_end(method, 1e-12) - exact).abs();
            assert!(error < 1e-12, "{method:?}, {amplitude}: {error:e} at {exact}");
        }
    }
}
