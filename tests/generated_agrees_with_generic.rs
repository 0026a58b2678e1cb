//! Generated code and hand-written code give the same accelerations, mass matrices, energies and contact forces, for every mode
//! and its mirror image.

mod common;

use nalgebra::DMatrix;
use proptest::prelude::*;
use rocking::dynamics::Ground;
use rocking::pattern::Pattern;
use rocking::{Column, Mode};

/// The scales below bound the sums of all terms by size, so few roundings of them bound the difference of two codes that add the
/// terms in different orders (measured: 0.7).
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

fn compare(column: &Column, pattern: &Pattern, x: &[f64], ground: Ground) {
    let generated = Mode::generated(column, pattern).expect("the build covers it");
    let generic = Mode::generic(column, pattern).expect("not at rest");
    let dof = pattern.dof();

    let matrix = DMatrix::from_row_slice(dof, dof, &generic.mass_matrix(x));
    let ours = generated.mass_matrix(x);
    let height: f64 = column.blocks().iter().map(|b| 2.0 * b.half_height + 2.0 * b.half_width).sum();
    let mass: f64 = column.blocks().iter().map(|b| b.mass).sum();
    for (a, b) in ours.iter().zip(matrix.transpose().iter()) {
        assert!((a - b).abs() <= ROUNDINGS * mass * height * height, "{pattern}: mass matrix {a} against {b}");
    }
    let eigenvalues = matrix.symmetric_eigenvalues();
    let (least, most) = (eigenvalues.min(), eigenvalues.max());

    // A solve loses condition × rounding of the result; the load's own rounding is amplified by 1 / least eigenvalue.
    let (a, b) = (generated.derivative(x, ground), generic.derivative(x, ground));
    let rates = x[dof..].iter().fold(0.0f64, |m, w| m.max(w.abs()));
    let push = ground.x.abs() + ground.gravity.abs() + dof as f64 * rates * rates * height;
    let size = b[dof..].iter().fold(0.0f64, |m, a| m.max(a.abs()));
    let bound = ROUNDINGS * (most / least * size + mass * height * push / least);
    for (a, b) in a.iter().zip(&b) {
        assert!((a - b).abs() <= bound, "{pattern}: acceleration {a} against {b}, bound {bound:e}");
    }

    let (a, b) = (generated.energy(x, ground.gravity), generic.energy(x, ground.gravity));
    let scale = b.kinetic + mass * height * ground.gravity.abs();
    assert!(
        (a.kinetic - b.kinetic).abs() <= ROUNDINGS * (scale + most * rates * rates * dof as f64),
        "{pattern}: kinetic"
    );
    assert!((a.potential - b.potential).abs() <= ROUNDINGS * scale, "{pattern}: potential {a:?} {b:?}");

    let forces = generated.contact_forces(x, ground).into_iter().zip(generic.contact_forces(x, ground));
    // Forces are masses times accelerations of points up to a height away, moments another height.
    let force = mass * (push + height * (size + bound / ROUNDINGS));
    for (interface, (a, b)) in forces.enumerate() {
        let close = |a: f64, b: f64, scale: f64| (a - b).abs() <= ROUNDINGS * scale;
        assert!(close(a.normal, b.normal, force), "{pattern}, interface {interface}: N {a:?} {b:?}");
        assert!(close(a.tangential, b.tangential, force), "{pattern}, interface {interface}: T {a:?} {b:?}");
        assert!(close(a.moment, b.moment, force * height), "{pattern}, interface {interface}: M {a:?} {b:?}");
    }
}

fn check(blocks: usize, cases: u32) {
    for pattern in common::patterns(blocks) {
        let dof = pattern.dof();
        let angle = prop::collection::vec(-1.5f64..1.5, dof);
        let rate = prop::collection::vec(-6.0f64..6.0, dof);
        let strategy = (common::column(blocks), angle, rate, -20.0f64..20.0, 1.0f64..25.0);
        common::runner(cases)
            .run(&strategy, |(column, angle, rate, x, gravity)| {
                compare(&column, &pattern, &[angle, rate].concat(), Ground { x, gravity });
                Ok(())
            })
            .expect("generated and generic equations agree");
    }
}

#[test]
fn every_mode_of_up_to_four_blocks_agrees() {
    for (blocks, cases) in [(1, 5000), (2, 2000), (3, 600), (4, 250)] {
        if blocks <= rocking::generated::MAX_BLOCKS {
            check(blocks, cases);
        }
    }
}

#[test]
fn what_the_build_lacks_has_no_generated_mode() {
    let blocks = rocking::generated::MAX_BLOCKS + 1;
    let column = Column::equal_blocks(blocks, 0.4, 2.0, 1.0, 9.81).expect("valid");
    let mut signs = vec![0; blocks];
    signs[0] = 1;
    assert!(Mode::generated(&column, &Pattern::from_signs(&signs)).is_none());
    assert!(Mode::new(&column, &Pattern::from_signs(&signs)).is_some());
}
