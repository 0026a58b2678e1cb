//! Claims about blocks that taper and stand displaced, on equations without sliding (docs/book/model.md, sections 1 and 3).

use crate::common;
use approx::assert_relative_eq;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use rocking::column::Shape;
use rocking::ground::Motion;
use rocking::kinematics::outlines;
use rocking::{Block, Column, ColumnError, Scene, StopReason, simulate};

/// Mass, height of the centroid and centroidal inertia of a body of unit density by slices.
fn by_slices(shape: Shape, [bottom, top]: [f64; 2], half_height: f64) -> [f64; 3] {
    let (slices, height) = (100_000, 2.0 * half_height);
    let thickness = height / f64::from(slices);
    let (mut mass, mut first, mut second) = (0.0, 0.0, 0.0);
    for slice in 0..slices {
        let y = (f64::from(slice) + 0.5) * thickness;
        let b = bottom + (top - bottom) * y / height;
        // Measure of a slice, and its second moment about its own diameter.
        let (measure, own) = match shape {
            Shape::Prism => (2.0 * b, 2.0 * b * b * b / 3.0),
            Shape::Drum => (std::f64::consts::PI * b * b, std::f64::consts::PI * b.powi(4) / 4.0),
        };
        mass += measure * thickness;
        first += measure * y * thickness;
        second += (own + measure * y * y) * thickness;
    }
    let centroid = first / mass;
    [mass, centroid, second - mass * centroid * centroid]
}

#[test]
fn tapered_bodies_have_the_inertia_of_their_slices() {
    for shape in [Shape::Prism, Shape::Drum] {
        for half_widths in [[0.5, 0.5], [0.5, 0.3], [0.2, 0.45], [0.5, 0.0]] {
            let [mass, centroid, inertia] = by_slices(shape, half_widths, 0.4);
            let block = Block::of_shape(shape, half_widths, 0.4, mass);
            // The rule of midpoints errs by 1e-10 of the whole.
            assert_relative_eq!(shape.measure(half_widths, 0.4), mass, max_relative = 1e-9);
            assert_relative_eq!(block.centroid_height, centroid, max_relative = 1e-9);
            assert_relative_eq!(block.inertia, inertia, max_relative = 1e-9);
        }
    }
}

/// A tapered body cut into drums has the mass, centre and inertia of the whole.
#[test]
fn a_column_cut_into_drums_is_the_whole() {
    let text = |key: &str| {
        format!(
            "[column]\nblocks = {key}\nhalf_width = 0.555\ntop_half_width = 0.45\nhalf_height = 2.975\ndensity = 2620\nshape = \"drum\"\n"
        )
    };
    let of = |count: &str| Scene::from_toml(&text(count), "cut.toml".as_ref()).expect("valid").column;
    let (whole, cut) = (of("1").stack(0), of("7").stack(0));
    assert_eq!(of("7").len(), 7);
    assert_relative_eq!(whole.mass, cut.mass, max_relative = 1e-14);
    assert_relative_eq!(whole.centroid_height, cut.centroid_height, max_relative = 1e-14);
    assert_relative_eq!(whole.inertia, cut.inertia, max_relative = 1e-14);
}

/// Half-widths of 0.6, 0.5 and 0.4 m: the faces of both parts are as 1.1 to 0.9.
#[test]
fn parts_of_a_tapered_body_share_its_mass_by_their_size() {
    let text = "[column]\nblocks = 2\nhalf_width = 0.6\ntop_half_width = 0.4\nhalf_height = 1.0\nmass = 10.0\n";
    let column = Scene::from_toml(text, "tapered.toml".as_ref()).expect("valid").column;
    for (block, mass) in column.blocks().iter().zip([5.5, 4.5]) {
        assert_relative_eq!(block.mass, mass, max_relative = 1e-14);
    }
}

#[test]
fn a_displaced_drum_opens_on_the_side_to_which_it_overhangs_first() {
    // A cube that overhangs the right end of a wide one by half its half-width: the contact is 1.5 m long.
    let column = Column::new(vec![Block::rectangle(4.0, 1.0, 1.0), Block::rectangle(1.0, 1.0, 1.0)], 10.0);
    let column = column.and_then(|column| column.displaced(vec![0.0, 3.5])).expect("it stands");
    assert_eq!(column.contact(1), [2.5, 4.0]);
    // Levers of the weight to both ends: 1.0 and 0.5 m, and a height of one.
    assert_relative_eq!(column.uplift_acceleration(1), 10.0 * 0.5, max_relative = 1e-15);
    for (amplitude, side) in [(4.999, 0), (-4.999, 0), (-5.001, 1), (9.99, 0), (10.01, -1)] {
        let mut scene = Scene::new(column.clone());
        scene.excitation.horizontal = Some(Motion::Rectangular { amplitude, start: 0.1, duration: 1e-3 });
        scene.options.t_end = 0.2;
        let response = simulate(&scene).expect("it runs");
        let first = response.events.first();
        assert_eq!(first.map_or(0, |event| event.after.0[1].sign()), side, "{amplitude}: {first:?}");
    }
}

#[test]
fn a_block_off_its_support_is_refused() {
    let column = Column::new(vec![Block::rectangle(0.4, 1.0, 1.0); 2], 9.81).expect("valid");
    let refused = column.clone().displaced(vec![0.0, -0.8]);
    assert_eq!(refused, Err(ColumnError::OffSupport { interface: 2, slide: -0.8, limit: 0.8 }));
    assert!(column.displaced(vec![5.0, 0.79]).is_ok(), "the ground is unbounded");
}

/// A random scene of tapered and displaced blocks that start at rest.
fn scene(column: Column, amplitude: f64) -> Scene {
    let uplift = (0..column.len()).map(|i| column.uplift_acceleration(i)).fold(f64::INFINITY, f64::min);
    let mut scene = Scene::new(column);
    scene.excitation.horizontal =
        Some(Motion::SinePulse { amplitude: amplitude * uplift.max(0.5), omega: 9.0, start: 0.05 });
    scene.options.t_end = 1.5;
    scene.output_dt = Some(0.05);
    scene
}

fn random_scenes(count: usize) -> impl Iterator<Item = Scene> {
    let mut runner = common::runner(0);
    let strategy = (1usize..5).prop_flat_map(|n| (common::tapered_and_displaced(n), 0.5f64..3.0));
    (0..count).map(move |_| {
        let (column, amplitude) = strategy.new_tree(&mut runner).expect("a strategy without filters").current();
        scene(column, amplitude)
    })
}

#[test]
fn mirror_images_of_displaced_columns_move_as_mirror_images() {
    for scene in random_scenes(200) {
        let mut mirrored = scene.clone();
        let slides = scene.column.slides().iter().map(|slide| -slide).collect();
        mirrored.column = scene.column.clone().displaced(slides).expect("it stands as the other one does");
        let Some(Motion::SinePulse { amplitude, .. }) = &mut mirrored.excitation.horizontal else { unreachable!() };
        *amplitude = -*amplitude;
        let (one, other) = (simulate(&scene).expect("it runs"), simulate(&mirrored).expect("it runs"));
        assert_eq!(one.status, other.status);
        for (a, b) in one.samples.iter().zip(&other.samples) {
            // Every operation has its mirror image: nothing but signs differs.
            assert!(a.theta.iter().zip(&b.theta).all(|(a, b)| *a == -*b), "{:?} {:?}", a.theta, b.theta);
        }
    }
}

#[test]
fn generated_and_generic_runs_of_displaced_columns_agree() {
    let (mut compared, mut events) = (0, 0);
    for scene in random_scenes(200) {
        let mut generic = scene.clone();
        generic.options.dynamics = rocking::DynamicsSource::Generic;
        let (one, other) = (simulate(&scene).expect("it runs"), simulate(&generic).expect("it runs"));
        // Impacts amplify the tolerance: runs with few of them tell a wrong constant, which changes angles by percents.
        if one.status == StopReason::Overturned || one.events.len() > 30 {
            continue;
        }
        (compared, events) = (compared + 1, events + one.events.len());
        for (a, b) in one.samples.iter().zip(&other.samples) {
            let off = a.theta.iter().zip(&b.theta).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-5, "{}: {:?} {:?}", a.t, a.theta, b.theta);
        }
    }
    assert!(compared > 50 && events > 200, "{compared} {events}");
}

/// Corners of faces that touch lie on the face below, whatever the slides.
#[test]
fn outlines_of_displaced_blocks_stand_on_each_other() {
    let blocks = [(0.5, 0.4, 0.3), (0.45, 0.3, 0.5), (0.25, 0.3, 0.2)];
    let block = |(bottom, top, half): (f64, f64, f64)| Block::of_shape(Shape::Prism, [bottom, top], half, 1.0);
    let column = Column::new(blocks.map(block).to_vec(), 9.81).expect("valid");
    let column = column.displaced(vec![0.3, -0.1, 0.2]).expect("it stands");
    let upright = outlines(&column, &rocking::pattern::Pattern::rest(3), &[0.0; 3]);
    let middles = upright.iter().map(|block| 0.5 * (block.corners[0][0] + block.corners[1][0]));
    for (middle, expected) in middles.zip([0.3, 0.2, 0.4]) {
        assert_relative_eq!(middle, expected, max_relative = 1e-14);
    }
}

/// Seven tapered drums and a cap under a pulse `a` for `t_p` and `-a/2` for twice as long (Dimitri, De Lorenzis & Zavarise 2011).
fn seven_drums(amplitude: f64, duration: f64) -> Scene {
    const JOINTS: [f64; 9] = [1.11, 1.08106, 1.05212, 1.02318, 0.99424, 0.96529, 0.93635, 0.90741, 0.90];
    let block = |index: usize| {
        let half_widths = [0.5 * JOINTS[index], 0.5 * JOINTS[index + 1]];
        let half_height = if index == 7 { 0.105 } else { 0.41 };
        let mass = 2620.0 * Shape::Prism.measure(half_widths, half_height);
        Block::of_shape(Shape::Prism, half_widths, half_height, mass)
    };
    let mut scene = Scene::new(Column::new((0..8).map(block).collect(), 9.81).expect("valid"));
    let level = |amplitude: f64, start: f64, duration: f64| Motion::Rectangular { amplitude, start, duration };
    let terms = vec![level(9.81 * amplitude, 0.0, duration), level(-4.905 * amplitude, duration, 2.0 * duration)];
    scene.excitation.horizontal = Some(Motion::Sum { terms });
    scene.options.t_end = 20.0;
    scene.options.wanted = rocking::Wanted::Outcome;
    scene
}

/// First amplitudes that bring the column down without slip, by a time-stepping program of steps of 5e-4 s: within 2 %.
#[test]
fn validation_seven_tapered_drums_without_slip() {
    for (duration, first) in [(0.1, 3.769), (0.2, 1.478), (0.3, 0.885), (0.34, 0.466), (0.4, 0.293), (0.6, 0.232)] {
        let falls = |share: f64| {
            let status = simulate(&seven_drums(share * first, duration)).expect("it runs").status;
            status == StopReason::Overturned
        };
        assert!(!falls(0.98) && falls(1.02), "{duration} s, {first} g");
    }
}
