//! Several scenes side by side, for their right-hand sides all at once.

use super::{Baseline, Instructions, Lanes, WIDTH};
use crate::column::Column;
use crate::generated::{Linkages, geometry};
use crate::program::{Scalar, StepProgram};
use crate::sine;
#[cfg(target_arch = "x86_64")]
use pulp::x86::{V3, V4};
use rocking_codegen::GroundMotion;
use rocking_codegen::pattern::Pattern;
use std::fmt;

/// Programs that run in whatever instructions a machine may have.
#[cfg(target_arch = "x86_64")]
pub trait EnsembleProgram: StepProgram<Eight<Baseline>> + StepProgram<Eight<V3>> + StepProgram<Eight<V4>> {}

#[cfg(target_arch = "x86_64")]
impl<P: StepProgram<Eight<Baseline>> + StepProgram<Eight<V3>> + StepProgram<Eight<V4>>> EnsembleProgram for P {}

/// Programs that run in whatever instructions a machine may have.
#[cfg(not(target_arch = "x86_64"))]
pub trait EnsembleProgram: StepProgram<Eight<Baseline>> {}

#[cfg(not(target_arch = "x86_64"))]
impl<P: StepProgram<Eight<Baseline>>> EnsembleProgram for P {}

type Eight<I> = <I as Instructions>::Eight;
type Constants<P, I> = <P as StepProgram<Eight<I>>>::Constants;

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
#[derive(Clone)]
pub struct Ensemble<P: EnsembleProgram> {
    scenes: usize,
    constants: Widest<P>,
}

/// Scene constants of [`WIDTH`] scenes each, in the widest instructions that the machine has; the last ones are filled up with the last scene.
#[derive(Clone)]
enum Widest<P: EnsembleProgram> {
    #[cfg(target_arch = "x86_64")]
    Avx512(V4, Vec<Constants<P, V4>>),
    #[cfg(target_arch = "x86_64")]
    Avx2(V3, Vec<Constants<P, V3>>),
    Baseline(Vec<Constants<P, Baseline>>),
}

impl<P: EnsembleProgram> fmt::Debug for Ensemble<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Ensemble").field("scenes", &self.scenes).finish_non_exhaustive()
    }
}

impl<P: EnsembleProgram> Ensemble<P> {
    /// The modes of these patterns of these columns, all with as many free angles as the program; `None` if one has not, or if there are no
    /// equations for it.
    pub fn new(modes: &[(&Column, &Pattern)], ground: GroundMotion, linkages: Linkages) -> Option<Ensemble<P>> {
        let constants = |(column, pattern): &(&Column, &Pattern)| {
            let equations = linkages(column.len(), crate::generated::mask(pattern))?;
            (equations.dof == Self::DOF).then(|| (equations.accelerations[ground as usize])(&geometry(column, pattern)))
        };
        let constants: Vec<Vec<f64>> = modes.iter().map(constants).collect::<Option<_>>()?;
        let together = |group: &[Vec<f64>]| {
            let last = group.len() - 1;
            let lanes = |index| Lanes(std::array::from_fn(|lane: usize| group[lane.min(last)][index]));
            (0..group[0].len()).map(lanes).collect()
        };
        let constants: Vec<Vec<Lanes<WIDTH>>> = constants.chunks(WIDTH).map(together).collect();
        Some(Ensemble { scenes: modes.len(), constants: Widest::new(&constants)? })
    }

    const DOF: usize = <P as StepProgram<Eight<Baseline>>>::DOF;

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
        // Chunks may not be empty, even of no numbers.
        values.chunks((WIDTH * count).max(1)).flat_map(group).collect()
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
        let (size, groups) = (2 * Self::DOF, self.scenes.div_ceil(WIDTH));
        assert_eq!((states.len(), slopes.len()), (size * groups, size * groups), "as many states and slopes as scenes");
        assert_eq!(ground.len(), 2 * groups, "as many ground motions as scenes");
        match &self.constants {
            #[cfg(target_arch = "x86_64")]
            Widest::Avx512(token, constants) => {
                evaluate::<V4, P>(*token, Groups { constants, states, ground, slopes });
            }
            #[cfg(target_arch = "x86_64")]
            Widest::Avx2(token, constants) => evaluate::<V3, P>(*token, Groups { constants, states, ground, slopes }),
            Widest::Baseline(constants) => {
                evaluate::<Baseline, P>(Baseline, Groups { constants, states, ground, slopes });
            }
        }
    }
}

impl<P: EnsembleProgram> Widest<P> {
    /// `None` if the program wants another number of constants.
    fn new(constants: &[Vec<Lanes<WIDTH>>]) -> Option<Widest<P>> {
        #[cfg(target_arch = "x86_64")]
        if let Some(token) = V4::of_this_machine() {
            return Some(Widest::Avx512(token, loaded::<V4, P>(token, constants)?));
        } else if let Some(token) = V3::of_this_machine() {
            return Some(Widest::Avx2(token, loaded::<V3, P>(token, constants)?));
        }
        Some(Widest::Baseline(loaded::<Baseline, P>(Baseline, constants)?))
    }
}

fn loaded<I: Instructions, P: StepProgram<I::Eight>>(
    token: I,
    groups: &[Vec<Lanes<WIDTH>>],
) -> Option<Vec<P::Constants>> {
    let own = |group: &Vec<Lanes<WIDTH>>| {
        let constants: Vec<I::Eight> = group.iter().map(|lanes| token.load(lanes)).collect();
        P::Constants::try_from(&constants).ok()
    };
    groups.iter().map(own).collect()
}

/// What is told of some groups of scenes, and what is asked for.
struct Groups<'a, C> {
    constants: &'a [C],
    states: &'a [Lanes<WIDTH>],
    ground: &'a [Lanes<WIDTH>],
    slopes: &'a mut [Lanes<WIDTH>],
}

/// The same of one.
struct Group<'a, C> {
    constants: &'a C,
    state: &'a [Lanes<WIDTH>],
    ground: &'a [Lanes<WIDTH>],
    slope: &'a mut [Lanes<WIDTH>],
}

impl<'a, C> Groups<'a, C> {
    /// Of so many together, the last ones fewer; `size` is the length of a state.
    fn blocks(self, size: usize, count: usize) -> impl Iterator<Item = Groups<'a, C>> {
        let (states, slopes) = (self.states.chunks(count * size), self.slopes.chunks_mut(count * size));
        let motions = states.zip(self.ground.chunks(count * 2)).zip(slopes);
        self.constants.chunks(count).zip(motions).map(|(constants, ((states, ground), slopes))| Groups {
            constants,
            states,
            ground,
            slopes,
        })
    }

    /// One by one.
    #[inline(always)]
    fn each(&mut self, size: usize) -> impl Iterator<Item = Group<'_, C>> {
        let (states, slopes) = (self.states.chunks_exact(size), self.slopes.chunks_exact_mut(size));
        let motions = states.zip(self.ground.chunks_exact(2)).zip(slopes);
        self.constants.iter().zip(motions).map(
            #[inline(always)]
            |(constants, ((state, ground), slope))| Group { constants, state, ground, slope },
        )
    }
}

/// Groups that are looked after together: few enough to stay in a cache.
const BLOCK: usize = 64;

/// Right-hand sides, block by block: of all groups as if the polynomials held, in a loop that has no other way and keeps their coefficients in
/// registers; then again of those where they may not.
fn evaluate<I: Instructions, P: StepProgram<I::Eight>>(token: I, groups: Groups<'_, P::Constants>) {
    for mut block in groups.blocks(2 * P::DOF, BLOCK) {
        if !by_polynomials::<I, P>(token, &mut block) {
            again_beyond::<I, P>(token, &mut block);
        }
    }
}

/// Right-hand sides of one block by the polynomials, and whether those are sure to have held.
fn by_polynomials<I: Instructions, P: StepProgram<I::Eight>>(token: I, block: &mut Groups<'_, P::Constants>) -> bool {
    token.run(
        #[inline(always)]
        || {
            let mut worst = token.load(&Lanes([0.0; WIDTH]));
            // The length said here and not before: captured it would be a variable.
            for group in block.each(2 * P::DOF) {
                right_hand_side::<I, P>(
                    token,
                    group,
                    #[inline(always)]
                    |angles, sin, cos| {
                        worst = largest_square::<I>(angles, worst);
                        for (angle, (sin, cos)) in angles.iter().zip(sin.iter_mut().zip(cos)) {
                            (*sin, *cos) = sine::kernels(*angle);
                        }
                    },
                );
            }
            are_within_reach::<I>(worst)
        },
    )
}

/// Right-hand sides of those groups of a block where an angle may be beyond the polynomials.
#[cold]
#[inline(never)]
fn again_beyond<I: Instructions, P: StepProgram<I::Eight>>(token: I, block: &mut Groups<'_, P::Constants>) {
    token.run(
        #[inline(always)]
        || {
            for group in block.each(2 * P::DOF) {
                let mut angles = P::vector(token.load(&group.state[0]));
                for (angle, lanes) in angles.as_mut().iter_mut().zip(group.state) {
                    *angle = token.load(lanes);
                }
                let none = token.load(&Lanes([0.0; WIDTH]));
                if !are_within_reach::<I>(largest_square::<I>(angles.as_ref(), none)) {
                    right_hand_side::<I, P>(token, group, I::Eight::sin_cos_each);
                }
            }
        },
    );
}

/// The largest of the squares of eight scenes' angles and of those so far, angles that are no numbers left out: sines need the squares anyway.
#[inline(always)]
fn largest_square<I: Instructions>(angles: &[I::Eight], mut so_far: I::Eight) -> I::Eight {
    for angle in angles {
        so_far = I::max(*angle * *angle, so_far);
    }
    so_far
}

/// Whether the polynomials hold for these largest squares. Of an angle that is no number they give none, as `libm` does.
#[inline(always)]
fn are_within_reach<I: Instructions>(largest_squares: I::Eight) -> bool {
    // Exact: the square of the next double beyond the reach rounds to a larger one.
    I::is_at_most(largest_squares, sine::REACH * sine::REACH)
}

/// Right-hand sides of one group, sines and cosines as given.
#[inline(always)]
fn right_hand_side<I: Instructions, P: StepProgram<I::Eight>>(
    token: I,
    group: Group<'_, P::Constants>,
    sin_cos_each: impl FnOnce(&[I::Eight], &mut [I::Eight], &mut [I::Eight]),
) {
    let mut angles = P::vector(token.load(&group.state[0]));
    let (mut sin, mut cos, mut omega) = (angles, angles, angles);
    for (index, (angle, omega)) in angles.as_mut().iter_mut().zip(omega.as_mut()).enumerate() {
        (*angle, *omega) = (token.load(&group.state[index]), token.load(&group.state[P::DOF + index]));
    }
    sin_cos_each(angles.as_ref(), sin.as_mut(), cos.as_mut());
    let (ground_x, gravity) = (token.load(&group.ground[0]), token.load(&group.ground[1]));
    let acceleration = P::acceleration(group.constants, &cos, &sin, &omega, ground_x, gravity);
    for (lanes, eight) in group.slope.iter_mut().zip(omega.as_ref().iter().chain(acceleration.as_ref())) {
        *lanes = I::store(*eight);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generated::equations::Dof1;
    use crate::program::slope;

    /// Two blocks, the second not full, with angles beyond the polynomials in both, and one that is not a number before them; `None` if this machine does not have the instructions.
    fn are_scenes<I: Instructions>() -> Option<()>
    where
        Dof1: StepProgram<I::Eight>,
    {
        type Alone = <Dof1 as StepProgram<f64>>::Constants;
        let token = I::of_this_machine()?;
        let count = size_of::<Alone>() / size_of::<f64>();
        let number = |scene: usize, index: usize| 0.3 + 0.1 * ((7 * scene + 3 * index) % 11) as f64;
        let groups = |of_each: usize, number: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<Lanes<WIDTH>>> {
            let lanes = |group: usize, index| Lanes(std::array::from_fn(|lane| number(WIDTH * group + lane, index)));
            (0..BLOCK + 2).map(|group| (0..of_each).map(|index| lanes(group, index)).collect()).collect()
        };
        let state = |scene: usize, index: usize| match scene {
            3 => f64::NAN,
            9..30 | 515.. => number(scene, index),
            _ => 0.1 * number(scene, index),
        };
        assert!((9..30).chain(515..520).any(|scene| scene % WIDTH == 3 && state(scene, 0) > sine::REACH));
        let constants = loaded::<I, Dof1>(token, &groups(count, &number)).expect("as many as it has");
        let (states, ground) =
            (groups(2, &state).concat(), groups(2, &|scene, index| number(scene, 5 + index)).concat());
        let mut slopes = states.clone();
        let groups = Groups { constants: &constants, states: &states, ground: &ground, slopes: &mut slopes };
        evaluate::<I, Dof1>(token, groups);
        for scene in 0..(BLOCK + 2) * WIDTH {
            let own: Vec<f64> = (0..count).map(|index| number(scene, index)).collect();
            let Ok(own) = Alone::try_from(&own[..]) else { panic!("as many as it has") };
            let (x, mut slope_alone) = ([state(scene, 0), state(scene, 1)], [0.0; 2]);
            slope::<f64, Dof1>(&own, &x, number(scene, 5), number(scene, 6), &mut slope_alone);
            let group = &slopes[scene / WIDTH * 2..][..2];
            let found = [group[0].0[scene % WIDTH], group[1].0[scene % WIDTH]];
            assert!(found == slope_alone || scene == 3 && found[1].is_nan(), "{scene}: {found:?} {slope_alone:?}");
        }
        Some(())
    }

    /// One angle just beyond the reach is seen in any lane of any place, whatever is beside it; the reach itself is within.
    fn angles_beyond_are_seen<I: Instructions>() -> Option<()> {
        let token = I::of_this_machine()?;
        let is_within = |angles: &[[f64; WIDTH]; 3]| {
            let eights = angles.map(|lanes| token.load(&Lanes(lanes)));
            are_within_reach::<I>(largest_square::<I>(&eights, token.load(&Lanes([0.0; WIDTH]))))
        };
        for (place, lane) in (0..3).flat_map(|place| (0..WIDTH).map(move |lane| (place, lane))) {
            for others in [0.0, -sine::REACH, f64::NAN] {
                for (angle, expected) in [(sine::REACH, true), (sine::REACH.next_up(), false), (-3.0, false)] {
                    let mut angles = [[others; WIDTH]; 3];
                    angles[place][lane] = angle;
                    assert_eq!(is_within(&angles), expected, "{angle} in lane {lane} of {place} beside {others}");
                }
            }
        }
        Some(())
    }

    #[test]
    fn scenes_side_by_side_are_scenes_in_all_instructions() {
        are_scenes::<Baseline>().expect("every machine has it");
        angles_beyond_are_seen::<Baseline>().expect("every machine has it");
        #[cfg(target_arch = "x86_64")]
        for (name, has_run) in [
            ("AVX2", are_scenes::<V3>().and_then(|()| angles_beyond_are_seen::<V3>())),
            ("AVX-512", are_scenes::<V4>().and_then(|()| angles_beyond_are_seen::<V4>())),
        ] {
            if has_run.is_none() {
                println!("skipped: this machine has no {name}");
            }
        }
    }
}
