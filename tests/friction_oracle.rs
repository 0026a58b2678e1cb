//! The brute-force oracle for contact with friction (`common/friction_oracle.rs`) against closed forms and against itself.
//!
//! Closed forms are those of docs/book/model.md, section 14, by their numbers there: a homogeneous rectangle, `t = b/h`,
//! `A = ẍ_g/(g + ÿ_g)`. A ground acceleration to the right makes a block slide and tip to the left.

use crate::common::friction_oracle::{
    Block, Coinciding, Contact, Friction, Grip, Joint, Side, Solution, Stack, State, Vec2, accelerations, chosen,
    impact, touching,
};
use crate::common::random::Random;

const GRAVITY: f64 = 9.81;

/// Rounding of a dense system of twenty rows whose terms are of order one, relative to them.
const ROUNDING: f64 = 1e-11;

const ALIGNED: Joint = Joint::Closed { slide: 0.0, slip: 0.0 };

fn close(found: f64, expected: f64) {
    let size = expected.abs().max(1.0);
    assert!((found - expected).abs() <= ROUNDING * size, "{found} instead of {expected}");
}

fn stack(blocks: &[Block], friction: &[f64]) -> Stack {
    Stack {
        blocks: blocks.to_vec(),
        friction: friction.iter().map(|mu| Friction::of(*mu)).collect(),
        gravity: GRAVITY,
        coinciding: Coinciding::BothFaces,
    }
}

/// A block of half-height 0.8 m.
fn one_block(slenderness: f64, friction: f64) -> Stack {
    stack(&[Block::rectangle(0.8 * slenderness, 0.8, 700.0)], &[friction])
}

fn only(solutions: Vec<Solution>) -> Solution {
    assert_eq!(solutions.len(), 1, "{solutions:#?}");
    solutions.into_iter().next().expect("one")
}

#[test]
fn sizes_of_trapezoids_are_those_of_integration() {
    let block = Block::trapezoid(0.555, 0.54053, 0.82, 2620.0);
    close(block.mass, 2620.0 * 0.82 * (0.555 + 0.54053));
    close(block.centroid, 0.82 * (0.555 + 2.0 * 0.54053) / (3.0 * (0.555 + 0.54053)));
    // Strips of a hundred-thousandth of the height: an error of 1e-10 of the whole.
    let (strips, mut inertia) = (100_000, 0.0);
    for k in 0..strips {
        let z = (f64::from(k) + 0.5) / f64::from(strips) * block.height;
        let w = 0.555 + (0.54053 - 0.555) * z / block.height;
        let d = z - block.centroid;
        inertia += 2620.0 * block.height / f64::from(strips) * 2.0 * w * (d * d + w * w / 3.0);
    }
    assert!((block.inertia / inertia - 1.0).abs() < 1e-9);
    let cube = Block::rectangle(0.3, 1.2, 1.44);
    close(cube.inertia, 1.44 * (0.09 + 1.44) / 3.0);
    close(cube.centroid, 1.2);
}

/// Closed form 1.
fn critical_friction(a: f64, t: f64) -> f64 {
    (a * (1.0 + 4.0 * t * t) + 3.0 * t) / (4.0 + t * t + 3.0 * a * t)
}

#[test]
fn from_rest_a_block_rests_slides_rocks_or_does_both() {
    let table =
        [(0.25, 0.5, 0.30986), (0.25, 1.0, 0.41558), (0.25, 2.0, 0.58427), (0.5, 1.0, 0.60870), (0.5, 2.0, 0.75862)];
    for (t, a, expected) in table {
        assert!((critical_friction(a, t) - expected).abs() < 5e-6);
    }
    let mut seen = [0; 4];
    for t in [0.1, 0.25, 0.5, 1.0, 1.7] {
        for a in [0.05, 0.2, 0.4, 0.7, 1.1, 2.3] {
            let critical = critical_friction(a, t);
            for mu in [0.03, 0.12, 0.3, 0.45, 0.8, 1.3, critical - 1e-6, critical + 1e-6, a - 1e-6, a + 1e-6] {
                for lift in [0.0, 2.5] {
                    let stack = one_block(t, mu);
                    let ground = [a * (GRAVITY + lift), lift];
                    let found = only(accelerations(&stack, &State::at_rest(&stack), ground));
                    let (expected, kind) = match () {
                        () if a <= mu.min(t) => (Contact::Closed(Grip::Sticks), 0),
                        () if mu < a && mu <= t => (Contact::Closed(Grip::SlidesLeft), 1),
                        () if mu >= critical => (Contact::Corner(Side::Left, Grip::Sticks), 2),
                        () => (Contact::Corner(Side::Left, Grip::SlidesLeft), 3),
                    };
                    assert_eq!(found.contacts, [expected], "t = {t}, A = {a}, mu = {mu}");
                    seen[kind] += 1;
                }
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

#[test]
fn sliding_and_rocking_from_rest_has_its_closed_form() {
    for (t, a, mu, lift) in [(0.25, 1.0, 0.3, 0.0), (0.25, 2.0, 0.5, 1.0), (0.5, 1.0, 0.55, 0.0), (0.5, 2.0, 0.7, -2.0)]
    {
        let stack = one_block(t, mu);
        let weight = GRAVITY + lift;
        let found = only(accelerations(&stack, &State::at_rest(&stack), [-a * weight, lift]));
        let d = 1.0 + 4.0 * t * t - 3.0 * mu * t;
        assert_eq!(found.contacts, [Contact::Corner(Side::Right, Grip::SlidesRight)]);
        close(found.reactions[0].normal / 700.0, weight * (1.0 + t * t) / d);
        close(found.reactions[0].tangential / 700.0, -mu * weight * (1.0 + t * t) / d);
        close(found.motion[0][2], 3.0 * weight * (mu - t) / (0.8 * d));
        // The pivot lies half the base to the right of the middle: M = -c N.
        close(found.reactions[0].moment / 700.0, -0.8 * t * weight * (1.0 + t * t) / d);
    }
}

#[test]
fn housners_landing_sticks_above_a_friction_and_slides_below() {
    let ratio = |t: f64, mu: f64| (1.0 - 2.0 * t * t + 3.0 * mu * t) / (1.0 + 4.0 * t * t - 3.0 * mu * t);
    // The friction is half the critical one, 6/65, rounded.
    assert!((ratio(0.25, 6.0 / 65.0) - 0.79967).abs() < 5e-6);
    for t in [0.1f64, 0.25, 0.4, 0.6] {
        let critical = 3.0 * t / (4.0 + t * t);
        for mu in [0.02, 0.09231, 0.5 * critical, critical - 1e-6, critical + 1e-6, 0.7] {
            let stack = one_block(t, mu);
            let pivot = Joint::Corner { side: Side::Left, slide: 0.0, slip: 0.0 };
            let state = State::stacked(&stack, &[0.0], &[0.7], &[pivot]);
            let found = only(impact(&stack, &state));
            let housner = 1.0 - 1.5 * t.atan().sin().powi(2);
            let sticks = mu >= critical;
            // Friction turns the block on: without it the right corner would be left behind.
            let grip = if sticks { Grip::Sticks } else { Grip::SlidesRight };
            assert_eq!(found.contacts, [Contact::Corner(Side::Right, grip)], "t = {t}, mu = {mu}");
            close(found.motion[0][2] / 0.7, if sticks { housner } else { ratio(t, mu) });
        }
    }
}

#[test]
fn a_released_block_sticks_above_a_friction() {
    for (t, theta) in [(0.25f64, 0.05), (0.25, 0.2), (0.5, 0.1), (0.5, 0.4)] {
        let tau = (t.atan() - theta).tan();
        let critical = 3.0 * tau / (4.0 + tau * tau);
        for (mu, grip) in [(critical - 1e-6, Grip::SlidesRight), (critical + 1e-6, Grip::Sticks)] {
            let stack = one_block(t, mu);
            let pivot = Joint::Corner { side: Side::Right, slide: 0.0, slip: 0.0 };
            let state = State::stacked(&stack, &[theta], &[0.0], &[pivot]);
            let found = only(accelerations(&stack, &state, [0.0, 0.0]));
            assert_eq!(found.contacts, [Contact::Corner(Side::Right, grip)], "t = {t}, mu = {mu}");
        }
    }
}

#[test]
fn a_flat_landing_rests_slides_pivots_or_does_both() {
    let mut seen = [0; 4];
    for k in [0.4f64, 1.0, 2.0, 4.0] {
        let (b, h) = (0.8 / k, 0.8);
        for r in [0.1, 0.35, 0.8, 1.5, 3.0, 7.0] {
            for mu in [0.1, 0.3, 0.6, 0.9, 1.2] {
                let stack = one_block(1.0 / k, mu);
                let (across, down) = (0.9, 0.9 * r);
                let fall = Joint::Free { offset: [0.0, 0.0], rate: [across, -down] };
                let found = only(impact(&stack, &State::stacked(&stack, &[0.0], &[0.0], &[fall])));
                let square = b * b + h * h;
                let enough = mu * (1.0 + 4.0 * k * k) - 3.0 * k;
                let (expected, omega, kind) = match () {
                    () if r >= k && mu >= 1.0 / r => (Contact::Closed(Grip::Sticks), 0.0, 0),
                    () if mu < 1.0 / k && mu < 1.0 / r => (Contact::Closed(Grip::SlidesRight), 0.0, 1),
                    () if enough > 0.0 && r >= (4.0 + k * k - 3.0 * mu * k) / enough => {
                        let omega = 3.0 * (h * across - b * down) / (4.0 * square);
                        (Contact::Corner(Side::Right, Grip::Sticks), omega, 2)
                    }
                    () => {
                        let d = 1.0 + 4.0 / (k * k) - 3.0 * mu / k;
                        let omega = 3.0 * (mu - 1.0 / k) * down / (h * d);
                        (Contact::Corner(Side::Right, Grip::SlidesRight), omega, 3)
                    }
                };
                assert_eq!(found.contacts, [expected], "k = {k}, r = {r}, mu = {mu}");
                close(found.motion[0][2], omega);
                seen[kind] += 1;
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
}

#[test]
fn two_blocks_that_only_slide_have_their_closed_form() {
    let block = Block::rectangle(2.0, 0.3, 500.0);
    let stack = stack(&[block, block], &[0.5, 0.3]);
    let at = |a: f64| only(accelerations(&stack, &State::at_rest(&stack), [a * GRAVITY, 0.0]));
    let gentle = at(0.6);
    // The lower block holds: its friction is 0.5 of both weights, the demand 0.6 of its own and 0.3 of the upper one's.
    assert_eq!(gentle.contacts, [Contact::Closed(Grip::Sticks), Contact::Closed(Grip::SlidesLeft)]);
    close(gentle.slips[1], -2.943);
    let strong = at(1.0);
    assert_eq!(strong.contacts, [Contact::Closed(Grip::SlidesLeft); 2]);
    close(strong.slips[0], -2.943);
    close(strong.slips[1], -3.924);
}

/// Closed form 9. A corner that slides towards the centroid's side drags it down: no acceleration exists above a friction.
#[test]
fn painleves_block_has_no_acceleration_above_a_friction() {
    for (t, theta) in [(1.0f64, 0.1), (0.6, 0.05), (0.5, 0.01), (1.4, 0.3)] {
        let tau = (t.atan() - theta).tan();
        let critical = (1.0 + 4.0 * tau * tau) / (3.0 * tau);
        assert!(critical >= 4.0 / 3.0);
        for (mu, count) in [(critical - 1e-3, 1), (critical + 1e-3, 0)] {
            let stack = one_block(t, mu);
            let pivot = Joint::Corner { side: Side::Right, slide: 0.0, slip: 0.4 };
            let state = State::stacked(&stack, &[theta], &[0.0], &[pivot]);
            assert_eq!(accelerations(&stack, &state, [0.0, 0.0]).len(), count, "t = {t}, mu = {mu}");
            // The other way friction lifts, and all is well.
            let pivot = Joint::Corner { side: Side::Right, slide: 0.0, slip: -0.4 };
            let state = State::stacked(&stack, &[theta], &[0.0], &[pivot]);
            only(accelerations(&stack, &state, [0.0, 0.0]));
        }
    }
}

/// A light drum leans on a heavy one of equal width, right corner on right corner, and is released. It holds as long as the demand lies in
/// the sum of the cones: `T/N` from `-μ` (lower face) to `tan(φ + atan μ)` (upper face).
#[test]
fn corner_on_corner_holds_in_the_sum_of_both_cones() {
    let (light, heavy) = (Block::rectangle(0.5, 1.0, 1.0), Block::rectangle(0.5, 0.4, 1e7));
    let balance = 0.5f64.atan();
    let with = |coinciding: Coinciding, theta: f64, mu: f64| {
        let stack = Stack { coinciding, ..stack(&[heavy, light], &[0.9, mu]) };
        let pivot = Joint::Corner { side: Side::Right, slide: 0.0, slip: 0.0 };
        let state = State::stacked(&stack, &[0.0, theta], &[0.0; 2], &[ALIGNED, pivot]);
        let solutions = accelerations(&stack, &state, [0.0, 0.0]);
        let best = chosen(&solutions, &touching(&stack, &state)).expect("a solution").contacts[1];
        (best, solutions)
    };
    let all = |theta: f64, mu: f64| {
        let ((either, several), (both, one)) =
            (with(Coinciding::EitherFace, theta, mu), with(Coinciding::BothFaces, theta, mu));
        assert_eq!((both, one.len()), (either, 1), "the one answer of both faces is the choice among those of either");
        (both, several)
    };
    for away in [0.1f64, 0.25, 0.4] {
        let tau = away.tan();
        let demand = 3.0 * tau / (4.0 + tau * tau);
        // Short of its balance it pushes inwards, to the left: bounded by the lower face's cone. Then its corner slips outwards.
        let (sticks, solutions) = all(balance - away, demand + 1e-4);
        assert_eq!(sticks, Contact::Corner(Side::Right, Grip::Sticks));
        let stuck = solutions.iter().find(|s| s.contacts[1] == sticks).expect("it is among them");
        assert!((stuck.reactions[1].tangential / stuck.reactions[1].normal + demand).abs() < 1e-6);
        assert_eq!(all(balance - away, demand - 1e-4).0, Contact::Corner(Side::Right, Grip::SlidesRight));
        // Beyond, it pushes outwards: the upper face leans with it, and even ice holds.
        assert!(demand.atan() < balance + away);
        assert_eq!(all(balance + away, 1e-3).0, Contact::Corner(Side::Right, Grip::Sticks));
    }
}

/// Drums that taper, of half-widths about 0.5 m and half-heights of 0.3 to 1 m, `friction` at all interfaces.
fn random_stack(random: &mut Random, blocks: usize, friction: f64) -> Stack {
    let mut block = || {
        let (bottom, taper, height) = (random.within(0.4, 0.6), random.within(0.8, 1.0), random.within(0.6, 2.0));
        Block::trapezoid(bottom, bottom * taper, height, 2600.0)
    };
    let blocks: Vec<Block> = (0..blocks).map(|_| block()).collect();
    let friction = vec![friction; blocks.len()];
    stack(&blocks, &friction)
}

/// Interfaces closed, on a corner, or free by a gap, displaced, with or without slip.
fn random_state(random: &mut Random, stack: &Stack, kinds: &[&str]) -> State {
    let count = stack.blocks.len();
    let (mut theta, mut omega, mut joints) = (vec![], vec![], vec![]);
    let mut below = [0.0, 0.0];
    for interface in 0..count {
        let slide = random.within(-0.15, 0.15);
        let slip = random.pick(&[0.0, 0.0, 0.4, -0.4]);
        let (lean, spin) = (random.within(0.02, 0.2), random.within(-0.8, 0.8));
        let side = random.pick(&[Side::Left, Side::Right]);
        let joint = match random.pick(kinds) {
            "closed" => Joint::Closed { slide, slip },
            "corner" => Joint::Corner { side, slide, slip },
            "lands" => {
                // Faces meet while the blocks turn apart from each other and approach.
                Joint::Free { offset: [slide, 0.0], rate: [slip, -random.within(0.5, 1.5)] }
            }
            _ => Joint::Free { offset: [slide, 0.3], rate: [slip, 0.2] },
        };
        let turn = match joint {
            Joint::Closed { .. } => [0.0, 0.0],
            Joint::Corner { side, .. } => [side.sign() * lean, spin],
            Joint::Free { offset, .. } if offset[1] == 0.0 => [0.0, spin],
            Joint::Free { .. } => [spin * 0.2, spin],
        };
        below = [below[0] + turn[0], below[1] + turn[1]];
        if turn == [0.0, 0.0] && interface > 0 {
            below = [theta[interface - 1], omega[interface - 1]];
        }
        theta.push(below[0]);
        omega.push(below[1]);
        joints.push(joint);
    }
    State::stacked(stack, &theta, &omega, &joints)
}

/// Gaps and slips of the solutions against the geometry of the moved blocks: constraints and their parts in the rates are right.
#[test]
fn contacts_stay_closed_when_blocks_are_moved() {
    let mut random = Random::new(7);
    let (step, mut seen) = (1e-4, [0; 2]);
    for case in 0..300 {
        let friction = random.pick(&[0.2, 0.5]);
        let stack = random_stack(&mut random, 1 + case % 3, friction);
        let state = random_state(&mut random, &stack, &["closed", "corner", "corner", "free"]);
        let ground = [random.within(-8.0, 8.0), random.within(-3.0, 3.0)];
        for solution in accelerations(&stack, &state, ground) {
            let moved = |t: f64| {
                let mut moved = state.clone();
                for (k, place) in moved.place.iter_mut().enumerate() {
                    for (axis, coordinate) in place.iter_mut().enumerate() {
                        *coordinate += t * (state.velocity[k][axis] + 0.5 * t * solution.motion[k][axis]);
                    }
                }
                moved
            };
            for (interface, contact) in solution.contacts.iter().enumerate() {
                let sides: &[Side] = match contact {
                    Contact::Closed(_) => &[Side::Left, Side::Right],
                    Contact::Corner(Side::Left, _) => &[Side::Left],
                    Contact::Corner(Side::Right, _) => &[Side::Right],
                    Contact::Free => &[],
                };
                for side in sides {
                    // The corner that lies on the other face, not beyond its end.
                    let lower = stack.gap(&state, interface, *side, true).1 < 0.0;
                    let gap = |t: f64| stack.gap(&moved(t), interface, *side, lower).0;
                    let second = (gap(step) - 2.0 * gap(0.0) + gap(-step)) / (step * step);
                    // Rounding 1e-16/step² and the third derivative times step.
                    assert!(second.abs() < 1e-5, "case {case}, interface {interface}: gap accelerates at {second}");
                    let beyond = |t: f64| stack.gap(&moved(t), interface, *side, lower).1;
                    let second = (beyond(step) - 2.0 * beyond(0.0) + beyond(-step)) / (step * step);
                    // A corner moves towards its face's end when it slips outwards on the lower face, inwards on the upper one.
                    let along = solution.slips[interface] * side.sign() * if lower { 1.0 } else { -1.0 };
                    let end = stack.gap(&state, interface, *side, lower);
                    if end.1 > -0.3 {
                        assert!((second - along).abs() < 1e-5, "case {case}: slip {along}, geometry {second}");
                        seen[usize::from(lower)] += 1;
                    }
                }
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 30), "{seen:?}");
}

/// Newton's second law for each stack above an interface, from the reactions alone.
#[test]
fn reactions_carry_what_stands_above() {
    let mut random = Random::new(11);
    for case in 0..60 {
        let stack = random_stack(&mut random, 3, 0.5);
        let state = random_state(&mut random, &stack, &["closed", "corner"]);
        let ground = [random.within(-5.0, 5.0), random.within(-3.0, 3.0)];
        for solution in accelerations(&stack, &state, ground) {
            for interface in 0..3 {
                let mut force: Vec2 = [0.0, 0.0];
                for (block, motion) in stack.blocks.iter().zip(&solution.motion).skip(interface) {
                    force[0] += block.mass * (motion[0] + ground[0]);
                    force[1] += block.mass * (motion[1] + ground[1] + GRAVITY);
                }
                let found = solution.reactions[interface];
                for axis in 0..2 {
                    assert!((found.force[axis] - force[axis]).abs() < 1e-6 * (1.0 + force[1].abs()), "case {case}");
                }
                if solution.contacts[interface] == Contact::Closed(Grip::Sticks) {
                    assert!(found.tangential.abs() <= 0.5 * found.normal * (1.0 + 1e-9) + 1e-6);
                }
            }
        }
    }
}

/// How many of 150 random problems of each kind have none, one or several solutions.
fn counts(seed: u64, friction: f64, solve: impl Fn(&mut Random, &Stack) -> usize) -> [usize; 3] {
    let mut random = Random::new(seed);
    let mut counts = [0; 3];
    for case in 0..150 {
        let stack = random_stack(&mut random, 1 + case % 3, friction);
        counts[solve(&mut random, &stack).min(2)] += 1;
    }
    counts
}

#[test]
fn impacts_have_an_answer_and_never_gain_energy() {
    for (seed, friction) in [(1, 0.05), (2, 0.3), (3, 0.5), (4, 0.8)] {
        let found = counts(seed, friction, |random, stack| {
            let state = random_state(random, stack, &["closed", "corner", "lands", "lands", "free"]);
            let before = state.kinetic_energy(stack);
            let solutions = impact(stack, &state);
            for solution in &solutions {
                let after = State { place: state.place.clone(), velocity: solution.motion.clone() };
                let energy = after.kinetic_energy(stack);
                assert!(energy <= before * (1.0 + 1e-9), "seed {seed}: {before} J to {energy} J");
            }
            solutions.len()
        });
        println!("impacts at mu = {friction}: {found:?} with none, one, several answers");
        assert_eq!(found[0], 0, "mu = {friction}");
        assert!(friction > 0.5 || found[2] == 0, "mu = {friction}: {found:?}");
    }
}

#[test]
fn stacks_at_rest_have_one_answer() {
    for (seed, friction) in [(5, 0.05), (6, 0.3), (7, 0.5), (8, 0.8)] {
        let found = counts(seed, friction, |random, stack| {
            let mut slide = || Joint::Closed { slide: random.within(-0.3, 0.3), slip: 0.0 };
            let joints: Vec<Joint> = stack.blocks.iter().map(|_| slide()).collect();
            let zeros = vec![0.0; joints.len()];
            let state = State::stacked(stack, &zeros, &zeros, &joints);
            accelerations(stack, &state, [random.within(-9.0, 9.0), random.within(-5.0, 9.0)]).len()
        });
        println!("stacks from rest at mu = {friction}: {found:?} with none, one, several answers");
        assert_eq!(found, [0, 150, 0], "mu = {friction}");
    }
}

/// Equal aligned drums, some open on corners that coincide: with both faces' rule there is one answer, with either face's there may be
/// several, since a corner on a corner may stay or leave along a side that falls. No impact gains energy.
#[test]
fn coinciding_corners_have_one_answer_if_both_faces_hold() {
    let drum = Block::rectangle(0.4, 0.6, 900.0);
    let mut random = Random::new(21);
    let (mut impacts, mut forces) = ([[0; 3]; 2], [[0; 3]; 2]);
    for case in 0..200 {
        let friction = random.pick(&[0.2, 0.5, 0.8]);
        let mut stack = stack(&vec![drum; 1 + case % 3], &vec![friction; 1 + case % 3]);
        let (mut theta, mut omega, mut joints) = (vec![], vec![], vec![]);
        let mut angle = 0.0;
        for _ in 0..stack.blocks.len() {
            let side = random.pick(&[Side::Left, Side::Right]);
            let open = random.happens(0.5);
            angle += if open { side.sign() * random.within(0.02, 0.2) } else { 0.0 };
            theta.push(angle);
            omega.push(0.0);
            joints.push(if open { Joint::Corner { side, slide: 0.0, slip: 0.0 } } else { ALIGNED });
        }
        let state = State::stacked(&stack, &theta, &omega, &joints);
        let ground = [random.within(-6.0, 6.0), random.within(-3.0, 3.0)];
        let mut spinning = state.clone();
        for velocity in &mut spinning.velocity {
            *velocity = [random.within(-1.0, 1.0), random.within(-1.0, 1.0), random.within(-1.0, 1.0)];
        }
        let before = spinning.kinetic_energy(&stack);
        for (rule, coinciding) in [Coinciding::BothFaces, Coinciding::EitherFace].into_iter().enumerate() {
            stack.coinciding = coinciding;
            forces[rule][accelerations(&stack, &state, ground).len().min(2)] += 1;
            let answers = impact(&stack, &spinning);
            impacts[rule][answers.len().min(2)] += 1;
            for answer in answers {
                let after = State { place: state.place.clone(), velocity: answer.motion };
                assert!(after.kinetic_energy(&stack) <= before * (1.0 + 1e-9), "case {case}");
            }
        }
    }
    println!("equal drums, none, one, several answers by rule: forces {forces:?}, impacts {impacts:?}");
    assert_eq!([forces[0], impacts[0]], [[0, 200, 0]; 2]);
    assert_eq!([forces[1][0], impacts[1][0]], [0; 2]);
}

/// With much friction the choice is the model's without friction, of impacts too: Housner's block in the middle of a stack.
#[test]
fn a_landing_stack_that_moves_as_one_is_housners_block() {
    let block = Block::rectangle(0.3, 0.4, 500.0);
    let stack = stack(&[block; 3], &[5.0; 3]);
    let pivot = Joint::Corner { side: Side::Right, slide: 0.0, slip: 0.0 };
    let state = State::stacked(&stack, &[0.0; 3], &[-0.5; 3], &[pivot, ALIGNED, ALIGNED]);
    let solutions = impact(&stack, &state);
    let one = [Contact::Corner(Side::Left, Grip::Sticks), Contact::Closed(Grip::Sticks), Contact::Closed(Grip::Sticks)];
    let found = chosen(&solutions, &touching(&stack, &state)).expect("an answer");
    assert_eq!(found.contacts, one);
    close(found.motion[0][2] / -0.5, 1.0 - 1.5 * (0.25f64.atan()).sin().powi(2));
}
