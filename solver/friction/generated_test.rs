//! Generated programs against the hand-written rows, in all combinations of states of one to three blocks.

use super::chain::{Chain, Rates};
use super::generated::Generated;
use super::joint::{Configuration, Face, Joint, Slip};
use super::random::Random;
use super::rows::{Coordinate, Rows, coordinates};
use crate::column::{Block, Column, Shape};
use crate::mechanics::dynamics::Ground;
use crate::mechanics::generated::{MAX_BLOCKS, moving};
use crate::numerics::per_block::PerBlock;
use rocking_codegen::pattern::Pattern;
use std::collections::BTreeSet;

/// All states of an interface, with corners on either face.
fn states(interface: usize) -> Vec<Joint> {
    let mut states = vec![Joint::Free];
    for slip in [Slip::Sticks, Slip::Slides(1), Slip::Slides(-1)] {
        states.push(Joint::Closed(slip));
        for side in [1, -1] {
            states.push(Joint::Corner(side, Face::Lower, slip));
            // The ground has no corner.
            if interface > 0 {
                states.push(Joint::Corner(side, Face::Upper, slip));
            }
        }
    }
    states
}

/// All combinations of states of so many interfaces.
pub(super) fn combinations(blocks: usize) -> Vec<Vec<Joint>> {
    let longer = |joints: &Vec<Joint>, interface: usize| {
        states(interface).into_iter().map(|state| [joints.as_slice(), &[state]].concat()).collect::<Vec<_>>()
    };
    (0..blocks).fold(vec![Vec::new()], |combinations, interface| {
        combinations.iter().flat_map(|joints| longer(joints, interface)).collect()
    })
}

/// A column of tapered blocks in these states; sizes, slides and motion are random.
pub(super) fn random_configuration(random: &mut Random, joints: &[Joint]) -> (Column, Configuration) {
    let block = |random: &mut Random| {
        let (bottom, half_height) = (random.within(0.4, 0.6), random.within(0.3, 1.2));
        let half_widths = [bottom, bottom * random.within(0.8, 1.1)];
        let mut block = Block::of_shape(Shape::Prism, half_widths, half_height, random.within(200.0, 3000.0));
        block.centroid_height *= random.within(0.9, 1.1);
        block
    };
    let column = Column::new(joints.iter().map(|_| block(random)).collect(), 9.81).expect("valid");
    let (mut theta, mut omega): (PerBlock<f64>, PerBlock<f64>) = (PerBlock::new(), PerBlock::new());
    for joint in joints {
        let (below, rate) = (theta.last().copied().unwrap_or(0.0), omega.last().copied().unwrap_or(0.0));
        let is_closed = matches!(joint, Joint::Closed(_));
        theta.push(if is_closed { below } else { random.within(-0.6, 0.6) });
        omega.push(if is_closed { rate } else { random.within(-2.0, 2.0) });
    }
    let mut vector = |size: f64| [random.within(-size, size), random.within(-size, size)];
    let mut configuration = Configuration {
        joints: PerBlock::from_slice(joints),
        theta,
        omega,
        slide: joints.iter().map(|_| vector(0.3)[0]).collect(),
        slide_rate: joints.iter().map(|joint| joint.slip().map_or(0.0, Slip::sign) * vector(1.0)[0].abs()).collect(),
        apart: joints.iter().map(|_| vector(0.5)).collect(),
        apart_rate: joints.iter().map(|_| vector(1.5)).collect(),
    };
    for (joint, rate) in joints.iter().zip(configuration.apart_rate.iter_mut()) {
        if *joint != Joint::Free {
            *rate = [0.0; 2];
        }
    }
    (column, configuration)
}

/// Largest difference between program and rows, relative to the largest acceleration, and the numbers of free angles and translations. `None` if the
/// build has no program.
fn difference(random: &mut Random, joints: &[Joint]) -> Option<(f64, (usize, usize))> {
    let (column, configuration) = random_configuration(random, joints);
    compare(random, &column, &configuration)
}

fn compare(random: &mut Random, column: &Column, configuration: &Configuration) -> Option<(f64, (usize, usize))> {
    let joints: &[Joint] = &configuration.joints;
    let kinetic: Vec<f64> = joints.iter().map(|_| random.within(0.0, 0.5)).collect();
    let ground = Ground { x: random.within(-8.0, 8.0), gravity: random.within(4.0, 15.0) };
    let coordinates = coordinates(joints);
    let mut generated = Generated::new(column, configuration, &kinetic)?;
    let both: Vec<[f64; 2]> = coordinates.iter().map(|coordinate| coordinate.of(configuration)).collect();
    let [values, rates] = [0, 1].map(|part| both.iter().map(|pair| pair[part]).collect::<Vec<f64>>());
    let mut ours = vec![0.0; coordinates.len()];
    let is_positive = generated.accelerations(&values, &rates, ground, &mut ours);
    let chain = Chain::new(column, configuration);
    let rows = Rows::new(&chain, joints, &kinetic, &vec![0.0; joints.len()]);
    assert_eq!((is_positive, is_positive), (rows.is_positive(), generated.is_positive(configuration)), "{joints:?}");
    let answer = rows.accelerations(&Rates::of(configuration), ground).expect("moderate friction");
    let theirs = coordinates.iter().map(|coordinate| match coordinate {
        Coordinate::Angle(blocks) => answer.motion.omega[blocks.start],
        Coordinate::Slide(i) => answer.motion.slide[*i],
        Coordinate::Apart(i, axis) => answer.motion.apart[*i][*axis],
    });
    let theirs: Vec<f64> = theirs.collect();
    let scale = theirs.iter().fold(ground.gravity, |most, a| most.max(a.abs()));
    let worst = ours.iter().zip(&theirs).fold(0.0f64, |worst, (a, b)| worst.max((a - b).abs() / scale));
    assert!(worst.is_finite(), "{joints:?}: {ours:?} against {theirs:?}");
    let angles = coordinates.iter().filter(|coordinate| matches!(coordinate, Coordinate::Angle(_))).count();
    Some((worst, (angles, coordinates.len() - angles)))
}

/// Blocks that are 1e4 times as light as those below: what a light block feels is no difference of what heavy ones feel.
#[test]
fn light_blocks_on_heavy_ones_lose_no_digits() {
    let mut random = Random::new(0x51ED_270B);
    for joints in &combinations(3) {
        if coordinates(joints).iter().all(|coordinate| matches!(coordinate, Coordinate::Angle(_))) {
            continue;
        }
        let (column, configuration) = random_configuration(&mut random, joints);
        let mut blocks = column.blocks().to_vec();
        for (place, block) in blocks.iter_mut().enumerate() {
            let share = 1e-4f64.powi(i32::try_from(place).expect("three blocks"));
            (block.mass, block.inertia) = (share * block.mass, share * block.inertia);
        }
        let column = Column::new(blocks, 9.81).expect("valid");
        let (difference, _) = compare(&mut random, &column, &configuration).expect("three blocks have all programs");
        assert!(difference < 1e-11, "{joints:?}: {difference:e}");
    }
}

#[test]
fn generated_programs_give_the_accelerations_of_the_rows_in_all_states() {
    let mut random = Random::new(0x9E37_79B9_7F4A_7C15);
    let (mut worst, mut seen) = (0.0f64, BTreeSet::new());
    for blocks in 1..=MAX_BLOCKS.min(3) {
        for joints in &combinations(blocks) {
            if coordinates(joints).iter().all(|coordinate| matches!(coordinate, Coordinate::Angle(_))) {
                continue;
            }
            let (difference, program) =
                difference(&mut random, joints).expect("columns of up to three blocks have all programs");
            worst = worst.max(difference);
            // Two eliminations of matrices of condition up to some thousand (measured: 6.1e-14).
            assert!(difference < 1e-11, "{joints:?}: {difference:e}");
            seen.insert(program);
        }
    }
    let largest = moving::COVERED.iter().map(|&(angles, _)| angles).max().unwrap_or(0);
    for blocks in 4..=largest {
        for _ in 0..400 {
            let joints = few_translations(&mut random, blocks);
            let (difference, program) = difference(&mut random, &joints).expect("two translations have a program");
            worst = worst.max(difference);
            assert!(difference < 1e-10, "{joints:?}: {difference:e}");
            seen.insert(program);
        }
    }
    eprintln!("largest difference {worst:e}");
    assert!(moving::COVERED.iter().all(|program| seen.contains(program)), "not all programs were compared: {seen:?}");
}

/// States with one or two translations.
fn few_translations(random: &mut Random, blocks: usize) -> Vec<Joint> {
    let closed = random.within(0.0, 0.7);
    let mut joint = |slip: Slip| match random.within(0.0, 1.0) < closed {
        true => Joint::Closed(slip),
        false => Joint::Corner(if random.within(-1.0, 1.0) < 0.0 { -1 } else { 1 }, Face::Lower, slip),
    };
    let mut joints: Vec<Joint> = (0..blocks).map(|_| joint(Slip::Sticks)).collect();
    let [first, second] = [Slip::Slides(1), Slip::Slides(-1)].map(joint);
    let place = |random: &mut Random| random.within(0.0, blocks as f64) as usize;
    match random.within(0.0, 3.0) as usize {
        0 => joints[place(random)] = Joint::Free,
        1 => joints[place(random)] = first,
        _ => {
            joints[place(random)] = first;
            joints[place(random)] = second;
        }
    }
    joints
}

/// States that stick run on the equations of displaced blocks: pivots are the ends of the overlap of two faces.
#[test]
fn sticking_states_have_the_accelerations_of_the_rows() {
    let mut random = Random::new(0x2545_F491_4F6C_DD1D);
    let mut compared = 0;
    for trial in 0..2000 {
        let signs: Vec<i8> =
            (0..1 + trial % MAX_BLOCKS.min(3)).map(|_| random.within(-1.5, 1.5).round() as i8).collect();
        let pattern = Pattern::from_signs(&signs);
        let all_stick = vec![Joint::Closed(Slip::Sticks); signs.len()];
        let (column, _) = random_configuration(&mut random, &all_stick);
        let slides = signs.iter().map(|_| random.within(-0.1, 0.1)).collect();
        let Ok(column) = column.displaced(slides) else { continue };
        let (mut theta, mut omega) = (Vec::new(), Vec::new());
        for &sign in &signs {
            let (below, rate) = (theta.last().copied().unwrap_or(0.0), omega.last().copied().unwrap_or(0.0));
            theta.push(below + f64::from(sign) * random.within(0.0, 0.3));
            omega.push(if sign == 0 { rate } else { random.within(-2.0, 2.0) });
        }
        let configuration = Configuration::sticking(&column, &pattern, &theta, &omega);
        if pattern.dof() == 0 {
            continue;
        }
        let worst = compare(&mut random, &column, &configuration).expect("the build has the equations of the mode").0;
        assert!(worst < 1e-10, "{pattern}: {worst:e}");
        compared += 1;
    }
    assert!(compared > 1000, "{compared}");
}

/// Times the accelerations by programs and by rows, on eight combinations of states.
#[test]
#[ignore = "a measurement: run with --ignored --nocapture, built to run fast"]
fn speed_of_the_programs_against_the_rows() {
    const CALLS: u32 = 20_000;
    let closed = |slip| Joint::Closed(slip);
    let corner = |slip| Joint::Corner(1, Face::Lower, slip);
    let (sticks, slides) = (Slip::Sticks, Slip::Slides(1));
    let states = [
        vec![closed(slides)],
        vec![corner(slides)],
        vec![Joint::Free],
        vec![corner(sticks), closed(slides), corner(sticks)],
        vec![corner(sticks), corner(slides), corner(slides)],
        vec![corner(sticks), corner(sticks), Joint::Free],
        vec![corner(slides), corner(slides), corner(slides)],
        vec![Joint::Free, Joint::Free, Joint::Free],
    ];
    let mut random = Random::new(0x9E37_79B9_7F4A_7C15);
    for joints in states.into_iter().filter(|joints| joints.len() <= MAX_BLOCKS) {
        let (checked, (angles, translations)) = difference(&mut random, &joints).expect("all programs of three blocks");
        assert!(checked < 1e-11);
        let (column, configuration) = random_configuration(&mut random, &joints);
        let kinetic = vec![0.3; joints.len()];
        let ground = Ground { x: 3.0, gravity: 9.81 };
        let coordinates = coordinates(&joints);
        let mut generated = Generated::new(&column, &configuration, &kinetic).expect("as before");
        let both: Vec<[f64; 2]> = coordinates.iter().map(|coordinate| coordinate.of(&configuration)).collect();
        let [values, rates] = [0, 1].map(|part| both.iter().map(|pair| pair[part]).collect::<Vec<f64>>());
        let mut accelerations = vec![0.0; coordinates.len()];
        let seconds = |call: &mut dyn FnMut()| {
            let best = (0..7).map(|_| {
                let start = std::time::Instant::now();
                (0..CALLS).for_each(|_| call());
                start.elapsed().as_secs_f64() / f64::from(CALLS)
            });
            best.fold(f64::INFINITY, f64::min)
        };
        let program = seconds(&mut || {
            generated.accelerations(std::hint::black_box(&values), &rates, ground, &mut accelerations);
            std::hint::black_box(&accelerations);
        });
        let rows = seconds(&mut || {
            let chain = Chain::new(&column, std::hint::black_box(&configuration));
            let rows = Rows::new(&chain, &joints, &kinetic, &kinetic);
            std::hint::black_box(rows.accelerations(&Rates::of(&configuration), ground));
        });
        let names: Vec<String> = joints.iter().map(|joint| format!("{joint:?}")).collect();
        eprintln!(
            "{angles} angle(s), {translations} translation(s): {:.0} ns, rows {:.0} ns, {:.1} times; {}",
            1e9 * program,
            1e9 * rows,
            rows / program,
            names.join(", ")
        );
    }
}
