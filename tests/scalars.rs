//! Generated functions over other scalars: dual numbers, double-doubles.

/// The text of the library's equations once more, for functions that it keeps to itself: its dispatch would compile all linkages of five blocks in
/// each scalar, a minute for one of them.
#[allow(clippy::all, dead_code, missing_docs, unused_variables, reason = "generated code is laid out for reading")]
mod equations {
    include!(concat!(env!("OUT_DIR"), "/equations.rs"));

    /// Scene constants of the accelerations and of the energies, the ground moving vertically as well: the third of four interfaces closed.
    pub fn constants<S: Scalar>(column: &Geometry<S>) -> [Vec<S>; 2] {
        [accelerations_open_1_2_4_of_4(column), energies_open_1_2_4_of_4(column)]
    }
}

use crate::common;
use crate::validation_extended_precision::double::Double;
use proptest::prelude::*;
use rocking::Column;
use rocking::generated::geometry;
use rocking::pattern::Pattern;
use rocking::program::{EnergyProgram, Geometry, Scalar, StepProgram};
use rocking::scalar::Dual;
use std::ops::Add;

/// Accelerations of a pattern with three free angles, in any scalar: constants from the column, then the program.
fn accelerations<S: Scalar>(geometry: &Geometry<S>, x: [S; 6], ground_x: S, gravity: S) -> [S; 3] {
    let [constants, _] = equations::constants(geometry);
    let Ok(constants) = <<equations::Dof3 as StepProgram<S>>::Constants>::try_from(constants.as_slice()) else {
        panic!("as many as the program has")
    };
    let (cos, sin, omega) = rocking::program::split::<S, equations::Dof3>(&x);
    <equations::Dof3 as StepProgram<S>>::acceleration(&constants, &cos, &sin, &omega, ground_x, gravity)
}

/// Four blocks, the third interface closed.
const SIGNS: [i8; 4] = [1, -1, 0, 1];

fn strategy() -> impl Strategy<Value = (Column, Vec<f64>)> {
    (common::column(4), prop::collection::vec(-1.0f64..1.0, 8))
}

fn inputs(random: &[f64]) -> ([f64; 6], f64, f64) {
    let x = std::array::from_fn(|i| if i < 3 { 1.2 * random[i] } else { 5.0 * random[i] });
    (x, 10.0 * random[6], 12.0 + 8.0 * random[7])
}

/// Up to an eighth of a turn, where they are polynomials, and just beyond. The last rounding makes half a place. A sine's polynomial adds 0.078 places
/// at most for each of its relative roundings, of which there are 4.3; a cosine's adds a quarter for that of the square, and 0.08.
#[test]
fn sines_and_cosines_err_by_less_than_the_last_place() {
    let mut worst = [0.0f64; 2];
    // Some of them small, at all places in a binade; the last errs by 0.802.
    let angle = |place: i32| f64::from(place) * 2e-6 * if place % 7 == 0 { 1e-4 } else { 1.0 };
    for angle in (1..400_000).map(angle).chain([0.784_664_113_915_185_2]) {
        let ((sin, cos), exact) = (Scalar::sin_cos(angle), Scalar::sin_cos(Double::from_f64(angle)));
        let error = |found: f64, exact: Double| {
            let last_place = exact.value().abs().next_up() - exact.value().abs();
            ((Double::from_f64(found) - exact).value() / last_place).abs()
        };
        worst = [worst[0].max(error(sin, exact.0)), worst[1].max(error(cos, exact.1))];
    }
    assert!(worst[0] < 0.85 && worst[1] < 0.85, "{worst:?}");
}

/// What is tested here is what the library runs.
#[test]
fn the_constants_are_those_of_the_library() {
    const MASK: usize = 0b1011;
    let run = |(column, _): (Column, Vec<f64>)| {
        let sizes = geometry(&column, &Pattern::from_signs(&SIGNS));
        let linkage = (rocking::generated::equations::LINKAGES.rectangles)(4, MASK).expect("the build covers it");
        let theirs = [linkage.accelerations[1](&sizes), (linkage.energies)(&sizes)];
        prop_assert_eq!(equations::constants(&sizes), theirs);
        Ok(())
    };
    common::runner(20).run(&strategy(), run).expect("equal constants");
}

/// Derivatives by every column parameter (gravity, pivots, half-heights, masses, inertias), every angle and every rate.
#[test]
fn dual_numbers_give_the_derivatives_of_the_right_hand_side() {
    const PARAMETERS: usize = 17 + 6;
    let strategy = strategy();
    let run = |(column, random): (Column, Vec<f64>)| {
        let sizes = geometry(&column, &Pattern::from_signs(&SIGNS));
        let (x, ground_x, gravity) = inputs(&random);
        let mut index = 0;
        let dual = sizes.lift(|value| {
            index += 1;
            Dual::<PARAMETERS>::variable(value, index - 1)
        });
        let state = std::array::from_fn(|i| Dual::variable(x[i], 17 + i));
        let exact = accelerations(&dual, state, Dual::constant(ground_x), Dual::constant(gravity));
        let value = accelerations(&sizes, x, ground_x, gravity);
        for link in 0..3 {
            prop_assert_eq!(exact[link].value, value[link]);
        }
        for parameter in 0..PARAMETERS {
            let moved = |sign: f64, d: f64| {
                let mut index = 0;
                let sizes = sizes.lift(|value| {
                    index += 1;
                    if index - 1 == parameter { value + sign * d * value } else { value }
                });
                let mut x = x;
                if parameter >= 17 {
                    x[parameter - 17] += sign * d;
                }
                accelerations(&sizes, x, ground_x, gravity)
            };
            let mut index = 0;
            let mut size = 1.0;
            sizes.lift(|value| {
                if index == parameter {
                    size = value;
                }
                index += 1;
            });
            if size == 0.0 {
                continue;
            }
            // Richardson's extrapolation of central differences: what is left is of fourth order.
            let difference = |d: f64, link: usize| (moved(1.0, d)[link] - moved(-1.0, d)[link]) / (2.0 * d * size);
            for link in 0..3 {
                let d = 1e-3;
                let extrapolated = (4.0 * difference(0.5 * d, link) - difference(d, link)) / 3.0;
                let scale = exact.iter().fold(1.0f64, |s, a| s.max(a.value.abs())) / size.abs();
                let error = (exact[link].derivative[parameter] - extrapolated).abs();
                // Fifth derivatives of up to 1e4 times the size where the mass matrix is nearly singular, times d⁴.
                prop_assert!(error < 1e-6 * scale, "parameter {parameter}: {error:e} of {scale:e}");
            }
        }
        Ok(())
    };
    common::runner(100).run(&strategy, run).expect("duals agree with differences");
}

/// What the accelerations solve is linear in gravity at rest: in double-doubles that holds to their digits, and the accelerations
/// in doubles differ by rounding.
#[test]
fn double_doubles_carry_twice_the_digits() {
    let run = |(column, random): (Column, Vec<f64>)| {
        let sizes = geometry(&column, &Pattern::from_signs(&SIGNS));
        let (x, _, gravity) = inputs(&random);
        let wide = sizes.lift(Double::from_f64);
        let exact = accelerations(&wide, x.map(Double::from_f64), Double::from_f64(0.0), Double::from_f64(gravity));
        let plain = accelerations(&sizes, x, 0.0, gravity);
        let size = plain.iter().fold(1.0f64, |size, a| size.max(a.abs()));
        let error = (0..3).fold(0.0f64, |e, i| e.max((exact[i].value() - plain[i]).abs()));
        // Rounding times the condition of the mass matrix, up to some 1e5 for these columns.
        prop_assert!(error < 1e-9 * size, "{error:e} of {size:e}");

        // M θ̈ = load, row by row, is what the accelerations solve: the residual of the plain ones against the wide mass matrix
        // is rounding, that of the wide ones nothing a double can hold.
        let [_, constants] = equations::constants(&wide);
        type Energies = equations::EnergiesDof3;
        let Ok(constants) = <<Energies as EnergyProgram<Double>>::Constants>::try_from(constants.as_slice()) else {
            panic!("as many as the program has")
        };
        let still = [x[0], x[1], x[2], 0.0, 0.0, 0.0].map(Double::from_f64);
        let (cos, sin, _) = rocking::program::split::<Double, equations::Dof3>(&still);
        let matrix = <Energies as EnergyProgram<Double>>::mass_matrix(&constants, &cos, &sin);
        let at = |gravity: Double| accelerations(&wide, still, Double::from_f64(0.0), gravity);
        // At rest the load is proportional to gravity: three times the gravity is three times the acceleration.
        let (gravity, three) = (Double::from_f64(gravity), Double::from_f64(3.0));
        let (once, thrice) = (at(gravity), at(three * gravity));
        for row in matrix {
            let push = |a: &[Double; 3]| (0..3).map(|k| row[k] * a[k]).fold(Double::from_f64(0.0), Add::add);
            let residual = push(&thrice) - push(&once) * three;
            let scale = push(&thrice).value().abs() + 1.0;
            prop_assert!(residual.value().abs() < 1e-24 * scale, "{:e}", residual.value());
        }
        Ok(())
    };
    common::runner(100).run(&strategy(), run).expect("double-doubles agree");
}
