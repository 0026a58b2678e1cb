//! Several scenes side by side: generated equations over lanes, in the widest instructions that the machine has.
//!
//! Lanes are arrays, and functions compiled for a set of instructions turn operations on them into vectors: eight doubles at a time with
//! AVX-512, four with AVX2, two with what every machine has. Which one is found out when the program runs. There are no fused
//! multiply-adds, so every lane is bit for bit what `f64` gives, on every machine.

use crate::column::Column;
use crate::dynamics::Ground;
use crate::generated::{Linkages, geometry};
use crate::program::{Scalar, StepProgram, slope};
use crate::sine;
use rocking_codegen::GroundMotion;
use rocking_codegen::pattern::Pattern;
use std::ops::{Add, Mul, Neg, Sub};

/// Doubles side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes<const W: usize>(pub [f64; W]);

/// Scenes that an [`Ensemble`] takes at a time: a vector of AVX-512.
pub const WIDTH: usize = 8;

/// `work`, with all that is inlined into it compiled for the widest instructions of this machine.
pub fn widest<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}

/// One operation, lane by lane.
macro_rules! lane_by_lane {
    ($operation:ident, $method:ident, $symbol:tt) => {
        impl<const W: usize> $operation for Lanes<W> {
            type Output = Lanes<W>;

            #[inline(always)]
            fn $method(mut self, other: Lanes<W>) -> Lanes<W> {
                for lane in 0..W {
                    self.0[lane] = self.0[lane] $symbol other.0[lane];
                }
                self
            }
        }
    };
}

lane_by_lane!(Add, add, +);
lane_by_lane!(Sub, sub, -);
lane_by_lane!(Mul, mul, *);

impl<const W: usize> Neg for Lanes<W> {
    type Output = Lanes<W>;

    #[inline(always)]
    fn neg(mut self) -> Lanes<W> {
        for lane in 0..W {
            self.0[lane] = -self.0[lane];
        }
        self
    }
}

impl<const W: usize> Scalar for Lanes<W> {
    #[inline(always)]
    fn from_f64(value: f64) -> Lanes<W> {
        Lanes([value; W])
    }

    #[inline(always)]
    fn recip(mut self) -> Lanes<W> {
        for lane in 0..W {
            self.0[lane] = 1.0 / self.0[lane];
        }
        self
    }

    #[inline(always)]
    fn sin_cos(self) -> (Lanes<W>, Lanes<W>) {
        let mut is_within = true;
        for lane in 0..W {
            is_within &= sine::is_within_reach(self.0[lane]);
        }
        if is_within { sine::kernels(self) } else { one_by_one(self) }
    }
}

/// Where an angle is beyond the polynomials.
#[inline(never)]
fn one_by_one<const W: usize>(angles: Lanes<W>) -> (Lanes<W>, Lanes<W>) {
    let (mut sin, mut cos) = (angles, angles);
    for lane in 0..W {
        (sin.0[lane], cos.0[lane]) = sine::sin_cos(angles.0[lane]);
    }
    (sin, cos)
}

/// Scenes whose modes run on one program, for their right-hand sides all at once.
///
/// ```
/// use rocking::dynamics::Ground;
/// use rocking::generated::equations::{self, HorizontalDof2};
/// use rocking::lanes::Ensemble;
/// use rocking::{Column, GroundMotion, Mode, pattern::Pattern};
///
/// let columns: Vec<Column> =
///     (0..11).map(|i| Column::equal_blocks(2, 0.3 + 0.01 * f64::from(i), 1.6, 1.0, 9.81)).collect::<Result<_, _>>()?;
/// let pattern = Pattern::from_signs(&[1, -1]);
/// let modes: Vec<_> = columns.iter().map(|column| (column, &pattern)).collect();
/// let linkages = |blocks, mask| equations::linkage::<f64>(blocks, mask);
/// let ensemble =
///     Ensemble::<HorizontalDof2>::new(&modes, GroundMotion::Horizontal, linkages).expect("two blocks are in every build but the smallest");
/// let (x, ground) = ([0.1, 0.02, 0.3, -0.2], Ground { x: 1.0, gravity: 9.81 });
/// let mut slopes = [0.0; 4 * 11];
/// ensemble.slopes(&x.repeat(11), &[ground; 11], &mut slopes);
/// let alone = Mode::generated(&columns[10], &pattern).expect("as above").derivative(&x, ground);
/// assert!(slopes[40..].iter().zip(&alone).all(|(a, b)| (a - b).abs() < 1e-14));
/// # Ok::<(), rocking::ColumnError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Ensemble<P: StepProgram<Lanes<WIDTH>>> {
    scenes: usize,
    /// Of [`WIDTH`] scenes each; the last ones are filled up with the last scene.
    constants: Vec<P::Constants>,
}

impl<P: StepProgram<Lanes<WIDTH>>> Ensemble<P> {
    /// The modes of these patterns of these columns, all with as many free angles as the program; `None` if one has not, or if there are no
    /// equations for it.
    pub fn new(modes: &[(&Column, &Pattern)], ground: GroundMotion, linkages: Linkages) -> Option<Ensemble<P>> {
        let constants = |(column, pattern): &(&Column, &Pattern)| {
            let equations = linkages(column.len(), crate::generated::mask(pattern))?;
            (equations.dof == P::DOF).then(|| (equations.accelerations[ground as usize])(&geometry(column, pattern)))
        };
        let constants: Vec<Vec<f64>> = modes.iter().map(constants).collect::<Option<_>>()?;
        let together = |group: &[Vec<f64>]| {
            let last = group.len() - 1;
            let lanes = |index| Lanes(std::array::from_fn(|lane: usize| group[lane.min(last)][index]));
            let lanes: Vec<Lanes<WIDTH>> = (0..group[0].len()).map(lanes).collect();
            P::Constants::try_from(&lanes).ok()
        };
        let constants = constants.chunks(WIDTH).map(together).collect::<Option<_>>()?;
        Some(Ensemble { scenes: modes.len(), constants })
    }

    /// Number of scenes.
    pub fn len(&self) -> usize {
        self.scenes
    }

    /// Whether there is no scene.
    pub fn is_empty(&self) -> bool {
        self.scenes == 0
    }

    /// `[θ̇, θ̈]` of every scene, scene by scene, from their states `[θ, θ̇]` and ground motions: lengths `2 · dof · scenes` and scenes.
    /// A panic means that lengths are others.
    pub fn slopes(&self, states: &[f64], ground: &[Ground], slopes: &mut [f64]) {
        let size = 2 * P::DOF;
        assert_eq!((states.len(), ground.len()), (size * self.scenes, self.scenes), "as many states as scenes");
        assert_eq!(slopes.len(), states.len(), "as many slopes as states");
        widest(
            #[inline(always)]
            || {
                let mut state = P::state(Lanes::from_f64(0.0));
                let mut slope_lanes = P::state(Lanes::from_f64(0.0));
                let groups = states.chunks(WIDTH * size).zip(ground.chunks(WIDTH)).zip(slopes.chunks_mut(WIDTH * size));
                for (constants, ((states, ground), slopes)) in self.constants.iter().zip(groups) {
                    let last = ground.len() - 1;
                    for (index, lanes) in state.as_mut().iter_mut().enumerate() {
                        for lane in 0..WIDTH {
                            lanes.0[lane] = states[lane.min(last) * size + index];
                        }
                    }
                    let (mut x, mut gravity) = (Lanes([0.0; WIDTH]), Lanes([0.0; WIDTH]));
                    for lane in 0..WIDTH {
                        let ground = ground[lane.min(last)];
                        (x.0[lane], gravity.0[lane]) = (ground.x, ground.gravity);
                    }
                    slope::<Lanes<WIDTH>, P>(constants, &state, x, gravity, slope_lanes.as_mut());
                    for (lane, slopes) in slopes.chunks_mut(size).enumerate() {
                        for (slope, lanes) in slopes.iter_mut().zip(slope_lanes.as_ref()) {
                            *slope = lanes.0[lane];
                        }
                    }
                }
            },
        );
    }
}
