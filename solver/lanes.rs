//! Several scenes side by side: generated equations over lanes, in the widest instructions that the machine has.
//!
//! Lanes are arrays, and functions compiled for a set of instructions turn operations on them into vectors: eight doubles at a time with
//! AVX-512, four with AVX2, two with what every machine has. Which one is found out when the program runs. There are no fused
//! multiply-adds, so every lane is bit for bit what `f64` gives, on every machine.

use crate::column::Column;
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
#[inline(always)]
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
                    self.0[lane] $symbol other.0[lane];
                }
                self
            }
        }
    };
}

lane_by_lane!(Add, add, +=);
lane_by_lane!(Sub, sub, -=);
lane_by_lane!(Mul, mul, *=);

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
        if sine::are_within_reach(&self.0) { sine::kernels(self) } else { one_by_one(self) }
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
/// let ensemble = Ensemble::<HorizontalDof2>::new(&modes, GroundMotion::Horizontal, linkages);
/// let ensemble = ensemble.expect("two blocks are in every build but the smallest");
/// let (x, ground) = ([0.1, 0.02, 0.3, -0.2], Ground { x: 1.0, gravity: 9.81 });
/// let states = ensemble.pack(&x.repeat(11), 4);
/// let mut slopes = states.clone();
/// ensemble.slopes(&states, &ensemble.pack(&[ground.x, ground.gravity].repeat(11), 2), &mut slopes);
/// let alone = Mode::generated(&columns[10], &pattern).expect("as above").derivative(&x, ground);
/// let last = &ensemble.unpack(&slopes, 4)[40..];
/// assert!(last.iter().zip(&alone).all(|(a, b)| (a - b).abs() < 1e-14));
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

    /// A number per scene, of `count` each, scene by scene: into lanes, number by number within a group of scenes. A panic means that
    /// there are not `count` for each.
    pub fn pack(&self, values: &[f64], count: usize) -> Vec<Lanes<WIDTH>> {
        assert_eq!(values.len(), count * self.scenes, "as many as scenes");
        let group = |values: &[f64]| {
            let last = values.len() / count - 1;
            let lanes = |index| Lanes(std::array::from_fn(|lane: usize| values[lane.min(last) * count + index]));
            (0..count).map(lanes).collect::<Vec<_>>()
        };
        values.chunks(WIDTH * count).flat_map(group).collect()
    }

    /// The other way round.
    pub fn unpack(&self, lanes: &[Lanes<WIDTH>], count: usize) -> Vec<f64> {
        let scene = |scene: usize| {
            let group = &lanes[scene / WIDTH * count..][..count];
            group.iter().map(move |lanes| lanes.0[scene % WIDTH])
        };
        (0..self.scenes).flat_map(scene).collect()
    }

    /// `[θ̇, θ̈]` of every scene from its state `[θ, θ̇]` and its ground motion, horizontal acceleration and effective gravity `[m/s²]`: all
    /// in lanes, `2 · dof` of states and slopes, and two of ground motion, for each group of scenes. A panic means that there are not so
    /// many.
    pub fn slopes(&self, states: &[Lanes<WIDTH>], ground: &[Lanes<WIDTH>], slopes: &mut [Lanes<WIDTH>]) {
        let (size, groups) = (2 * P::DOF, self.constants.len());
        assert_eq!((states.len(), slopes.len()), (size * groups, size * groups), "as many states and slopes as scenes");
        assert_eq!(ground.len(), 2 * groups, "as many ground motions as scenes");
        widest(
            #[inline(always)]
            || {
                let mut state = P::state(Lanes::from_f64(0.0));
                let scenes = states.chunks_exact(size).zip(ground.chunks_exact(2)).zip(slopes.chunks_exact_mut(size));
                for (constants, ((own, ground), slopes)) in self.constants.iter().zip(scenes) {
                    state.as_mut().copy_from_slice(own);
                    slope::<Lanes<WIDTH>, P>(constants, &state, ground[0], ground[1], slopes);
                }
            },
        );
    }
}
