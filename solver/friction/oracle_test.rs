//! The search for contact states against brute force over all states, by code that shares no formula with the search
//! (`tests/common/friction_oracle.rs`).

use super::chain::{Chain, Rates};
use super::contact_problem::{Coefficients, Question, Touch};
use super::joint::{Configuration, Face, Joint, Sign, Slip, face};
use super::random::Random;
use super::rows::Answer;
use super::search::Search;
use crate::column::{Block, Column, Shape};
use crate::mechanics::dynamics::Ground;
use crate::numerics::per_block::PerBlock;
use friction_oracle::{Coinciding, Side, Stack, State, accelerations, chosen, impact, touching};

#[allow(dead_code, reason = "unit tests need less of it than tests of whole runs")]
#[path = "../../tests/common/friction_oracle.rs"]
mod friction_oracle;

/// A random stack of one to three blocks, as the search and as the oracle see it. Kinetic friction is at least the share `least_kinetic` of static friction.
struct Case {
    column: Column,
    now: Configuration,
    touch: Vec<Touch>,
    friction: Coefficients,
    stack: Stack,
    state: State,
}

fn case(random: &mut Random, strikes: bool, least_kinetic: f64) -> Case {
    let count = 1 + random.within(0.0, 3.0) as usize;
    let (equal, b, h) = (random.happens(0.3), random.within(0.2, 0.6), random.within(0.3, 1.0));
    let block = |random: &mut Random| match equal {
        true => Block::of_shape(Shape::Prism, [b, b], h, 4.0 * b * h),
        false => {
            let (bottom, half_height) = (b * random.within(0.7, 1.3), h * random.within(0.6, 1.4));
            let half_widths = [bottom, bottom * random.within(0.7, 1.2)];
            Block::of_shape(Shape::Prism, half_widths, half_height, 4.0 * bottom * half_height)
        }
    };
    let blocks: Vec<Block> = (0..count).map(|_| block(random)).collect();
    let column = Column::new(blocks.clone(), 9.81).expect("valid");
    let struck = if strikes { random.within(0.0, count as f64) as usize } else { count };
    let mut now = Configuration {
        joints: PerBlock::new(),
        theta: PerBlock::new(),
        omega: PerBlock::new(),
        slide: PerBlock::new(),
        slide_rate: PerBlock::new(),
        apart: PerBlock::filled([0.0; 2], count),
        apart_rate: PerBlock::filled([0.0; 2], count),
    };
    let (mut touch, mut joints) = (Vec::new(), Vec::new());
    let (mut angle, mut rate) = (0.0, 0.0);
    for i in 0..count {
        let slide = if equal || i == 0 { 0.0 } else { 0.3 * b * random.within(-1.0, 1.0) };
        let side: Sign = if random.happens(0.5) { 1 } else { -1 };
        let is_closed = i != struck && random.happens(0.4);
        let on = face(&column, i, side, slide);
        let slides = random.happens(0.5) && (is_closed || on != Face::Both);
        let slip = if slides { random.within(-1.0, 1.0) } else { 0.0 };
        let state = match slip {
            0.0 => Slip::Sticks,
            slip => Slip::Slides(if slip > 0.0 { 1 } else { -1 }),
        };
        let oracle_side = if side > 0 { Side::Right } else { Side::Left };
        if is_closed {
            now.joints.push(Joint::Closed(state));
            touch.push(Touch::Faces);
            joints.push(friction_oracle::Joint::Closed { slide, slip });
        } else if i == struck {
            rate -= f64::from(side) * random.within(0.1, 2.0);
            now.joints.push(Joint::Corner(side, on, state));
            touch.push(Touch::Faces);
            joints.push(friction_oracle::Joint::Corner { side: oracle_side, slide, slip });
        } else {
            angle += f64::from(side) * random.within(0.01, 0.2);
            rate += random.within(-1.0, 1.0);
            now.joints.push(Joint::Corner(side, on, state));
            touch.push(Touch::Corner(side));
            joints.push(friction_oracle::Joint::Corner { side: oracle_side, slide, slip });
        }
        now.theta.push(angle);
        now.omega.push(rate);
        now.slide.push(slide);
        now.slide_rate.push(slip);
    }
    let coefficients: Vec<f64> = (0..count).map(|_| random.within(0.02, 0.8)).collect();
    let kinetic: Vec<f64> = coefficients.iter().map(|mu| mu * random.within(least_kinetic, 1.0)).collect();
    let cone = |(still, sliding): (&f64, &f64)| friction_oracle::Friction { still: *still, sliding: *sliding };
    let body = |block: &Block| friction_oracle::Block {
        bottom: block.bottom_half_width,
        top: block.top_half_width,
        height: 2.0 * block.half_height,
        centroid: block.centroid_height,
        mass: block.mass,
        inertia: block.inertia,
    };
    let stack = Stack {
        blocks: blocks.iter().map(body).collect(),
        friction: coefficients.iter().zip(&kinetic).map(cone).collect(),
        gravity: 9.81,
        coinciding: Coinciding::BothFaces,
    };
    let state = State::stacked(&stack, &now.theta, &now.omega, &joints);
    let friction = Coefficients { fixed: coefficients, kinetic };
    Case { column, now, touch, friction, stack, state }
}

/// Largest difference between two motions of the blocks, relative to the largest component of `other`, at least 1.
fn off(own: &[[f64; 3]], other: &[[f64; 3]]) -> f64 {
    let size = other.iter().flatten().fold(1.0f64, |size, value| size.max(value.abs()));
    let differences = own.iter().flatten().zip(other.iter().flatten()).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / size
}

/// Largest relative difference of equal motions: search and oracle solve systems of up to nine and twenty rows, condition numbers of some thousands.
const SAME: f64 = 1e-8;

/// Margin of a condition, as a share of the problem's scale, within which search and oracle may take different states.
const NEAR: f64 = 1e-7;

/// Largest relative difference between the motions of search and oracle if the oracle's worst margin is within [`NEAR`] of zero.
const NEAR_SAME: f64 = 1e-6;

/// The motions that search and oracle find for one case, and the states that each takes.
struct Found {
    /// Per block, as [`friction_oracle::Solution::motion`].
    own: Vec<[f64; 3]>,
    states: String,
    admissible: Vec<friction_oracle::Solution>,
    /// The place among the admissible ones of the one that the model's rule takes.
    chosen: Option<usize>,
}

impl Found {
    fn of(random: &mut Random, strikes: bool, least_kinetic: f64) -> Found {
        let Case { column, now, touch, friction, stack, state } = case(random, strikes, least_kinetic);
        let before = Chain::new(&column, &now).motion(&Rates::of(&now));
        let ground = Ground { x: random.within(-12.0, 12.0), gravity: random.within(3.0, 15.0) };
        let admissible = match strikes {
            true => impact(&stack, &state),
            false => accelerations(&stack, &state, [ground.x, ground.gravity - 9.81]),
        };
        let question = if strikes { Question::Impact(before.clone()) } else { Question::Accelerations(ground) };
        let search = Search::new(&column, &now, &touch, &friction, question);
        let solution = search.solve_from(search.first());
        let motion = |answer: &Answer, block: usize| {
            let ([x, y], angular) = (answer.change.linear[block], answer.change.angular[block]);
            match strikes {
                true => {
                    let [u, v] = before.linear[block];
                    [x + u, y + v, angular + before.angular[block]]
                }
                false => [x - ground.x, y - ground.gravity, angular],
            }
        };
        let motions = |answer: &Answer| (0..column.len()).map(|block| motion(answer, block)).collect();
        let chosen = chosen(&admissible, &touching(&stack, &state));
        Found {
            own: solution.as_ref().map_or(Vec::new(), |solution| motions(&solution.answer)),
            states: format!("{:?} of {now:?}", solution.map(|solution| solution.joints)),
            chosen: chosen.and_then(|chosen| admissible.iter().position(|one| std::ptr::eq(one, chosen))),
            admissible,
        }
    }

    /// Whether the search has found this motion of the oracle's.
    fn is(&self, other: &friction_oracle::Solution) -> bool {
        // Near a limit rounding decides between states whose motions are the same there.
        let same = if other.margin.abs() < NEAR { NEAR_SAME } else { SAME };
        self.own.len() == other.motion.len() && off(&self.own, &other.motion) < same
    }
}

/// Takes seven seconds of one core.
#[test]
fn states_found_are_those_of_brute_force_in_twenty_thousand_cases() {
    let (mut random, cases) = (Random::new(1), 20_000);
    let (mut compared, mut several) = ([0; 2], [0; 2]);
    for index in 0..cases {
        let strikes = index % 2 == 1;
        let found = Found::of(&mut random, strikes, 1.0);
        // Cases with several answers are not compared: a rule chooses among them. Nor are cases without any.
        let [only] = &found.admissible[..] else {
            several[usize::from(strikes)] += 1;
            continue;
        };
        assert!(found.is(only), "case {index}: {}\n{:?}\n{only:?}", found.states, found.own);
        compared[usize::from(strikes)] += 1;
    }
    println!("{compared:?} of {cases} compared (accelerations, impacts), {several:?} with several answers or none");
    assert!(compared.iter().all(|count| *count > 9 * cases / 20), "{compared:?}");
}

/// With kinetic below static friction one state in seven has several motions. The one found is always one of them, and mostly the one that the rule takes by
/// the letter: an opening that is admissible by itself begins no slide elsewhere, however little energy that would take.
#[test]
fn states_with_two_coefficients_are_among_those_of_brute_force() {
    let (mut random, cases) = (Random::new(2), 10_000);
    let (mut several, mut by_the_letter, mut checked) = (0, 0, 0);
    for index in 0..cases {
        let found = Found::of(&mut random, index % 2 == 1, 0.4);
        let Some(chosen) = found.chosen else { continue };
        let is_admissible = found.admissible.iter().any(|one| found.is(one));
        assert!(is_admissible, "case {index}: {}\n{:?}\n{:?}", found.states, found.own, found.admissible);
        checked += 1;
        several += usize::from(found.admissible.len() > 1);
        by_the_letter += usize::from(found.is(&found.admissible[chosen]));
    }
    println!("{checked} of {cases} checked, {several} with several motions, {by_the_letter} by the letter of the rule");
    // Measured: 9,998, 693 and 9,918.
    assert!(several > cases / 20 && by_the_letter * 100 > 99 * checked && checked * 100 > 99 * cases);
}
