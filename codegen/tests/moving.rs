//! Programs with translations against d'Alembert's principle for each combination of states, and this against finite differences.

use rocking_codegen::joints::{Carrier, Joint, Joints, Slip};
use rocking_codegen::mechanics::{Kind, Rows, Vector, rows_of_motion};
use rocking_codegen::moving::{MovingRecord, covered};
use rocking_codegen::optimise::Program;
use rocking_codegen::pattern::Interface;
use rocking_codegen::symbolic::{Arena, Environment, Expr};
use std::collections::{BTreeMap, HashMap};

/// xorshift64* (Vigna 2016).
struct Random(u64);

impl Random {
    fn within(&mut self, a: f64, b: f64) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        a + (b - a) * (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// All combinations of states of so many interfaces; mirror images but for the direction of slides have the same equations.
fn all_joints(blocks: usize) -> Vec<Joints> {
    let mut combinations = vec![Vec::new()];
    for interface in 0..blocks {
        let mut states = vec![Joint::Free];
        for slip in [Slip::Sticks, Slip::Right, Slip::Left] {
            states.extend([Interface::Closed, Interface::Right].map(|side| Joint::Contact(side, slip, Carrier::Lower)));
            if interface > 0 && slip != Slip::Sticks {
                states.push(Joint::Contact(Interface::Right, slip, Carrier::Upper));
            }
        }
        combinations = combinations
            .iter()
            .flat_map(|joints: &Vec<Joint>| states.iter().map(|state| [joints.as_slice(), &[*state]].concat()))
            .collect();
    }
    combinations.into_iter().map(Joints).collect()
}

/// Random values for all symbols.
fn values(rows: &Rows, random: &mut Random) -> Environment {
    let s = &rows.symbols;
    let mut values = Environment::new();
    for coordinate in &rows.coordinates {
        values.insert(coordinate.value, random.within(-0.8, 0.8));
        values.insert(coordinate.rate, random.within(-2.0, 2.0));
        values.insert(coordinate.acceleration, random.within(-3.0, 3.0));
    }
    for pivot in &s.pivot_above {
        // Those of interfaces that slide along the upper face hold the slide.
        if !values.contains_key(pivot) {
            values.insert(*pivot, random.within(-0.6, 0.6));
        }
    }
    for (family, low, high) in
        [(&s.half_height, 0.3, 1.5), (&s.mass, 0.4, 2.5), (&s.inertia, 0.1, 1.0), (&rows.friction, 0.0, 0.9)]
    {
        values.extend(family.iter().map(|symbol| (*symbol, random.within(low, high))));
    }
    values.extend([(s.ground_x, random.within(-4.0, 4.0)), (s.gravity, random.within(5.0, 13.0))]);
    values
}

/// A derivation with values for its symbols.
struct Case {
    joints: Joints,
    arena: Arena,
    rows: Rows,
    values: Environment,
}

impl Case {
    fn new(joints: &Joints, random: &mut Random) -> Case {
        let mut arena = Arena::new();
        let rows = rows_of_motion(&mut arena, joints);
        // Pivots are symbols of their own: sums of them and slides are evaluated.
        let mut values = values(&rows, random);
        for number in 1..=joints.0.len() {
            if let Some(pivot) = arena.symbol_named(&format!("pivot_{number}")) {
                values.insert(pivot, random.within(-0.6, 0.6));
            }
        }
        values.retain(|expr, _| arena.symbol_name(*expr).is_some());
        Case { joints: joints.clone(), arena, rows, values }
    }

    fn value(&self, expr: Expr) -> f64 {
        self.arena.evaluate(expr, &self.values).expect("all symbols have values")
    }

    /// `Σ_{i>=first} m_i ∂G_i/∂θ_a`, turned back into the axes of the link: lateral and axial.
    fn first_moment(&mut self, first: usize, link: usize) -> [f64; 2] {
        let theta = self.rows.symbols.theta[link];
        let mut total = [0.0, 0.0];
        for block in first..self.joints.0.len() {
            let derivative = self.rows.centroids[block].map(|component| self.arena.differentiate(component, theta));
            let mass = self.value(self.rows.symbols.mass[block]);
            for (sum, component) in total.iter_mut().zip(derivative) {
                *sum += mass * self.value(component);
            }
        }
        self.turned_back(total, link)
    }

    fn lever(&mut self, link: usize) -> [f64; 2] {
        let theta = self.rows.symbols.theta[link];
        let top = self.rows.centroids[self.joints.0.len() - 1];
        let derivative: Vector = top.map(|component| self.arena.differentiate(component, theta));
        self.turned_back(derivative.map(|component| self.value(component)), link)
    }

    /// From `(x, y) = (cos · axial + sin · lateral, cos · lateral - sin · axial)`.
    fn turned_back(&self, [x, y]: [f64; 2], link: usize) -> [f64; 2] {
        let (sin, cos) = self.values[&self.rows.symbols.theta[link]].sin_cos();
        [x * sin + y * cos, x * cos - y * sin]
    }

    /// The program's inputs by name.
    fn inputs(&mut self) -> HashMap<String, f64> {
        let mut inputs = HashMap::new();
        let links = self.joints.linkage().link_of_block();
        let angles = self.joints.angles();
        for link in 0..angles {
            let number = link + 1;
            let theta = self.values[&self.rows.symbols.theta[link]];
            inputs.insert(format!("cos_{number}"), theta.cos());
            inputs.insert(format!("sin_{number}"), theta.sin());
            inputs.insert(format!("omega_{number}"), self.values[&self.rows.symbols.omega[link]]);
            inputs.insert(format!("link_inertia_{number}"), self.value(self.rows.matrix[link][link]));
            for (name, [lateral, axial]) in [("moment", self.first_moment(0, link)), ("lever", self.lever(link))] {
                inputs.insert(format!("link_{name}_lateral_{number}"), lateral);
                inputs.insert(format!("link_{name}_axial_{number}"), axial);
            }
        }
        for index in 0..self.joints.translations() {
            let (number, coordinate) = (index + 1, self.rows.coordinates[angles + index].clone());
            let (interface, direction, lift) = match coordinate.kind {
                Kind::Slide(interface) => {
                    let Joint::Contact(_, slip, carrier) = self.joints.0[interface - 1] else { panic!("a contact") };
                    let face = match (carrier, interface) {
                        (Carrier::Upper, _) => links[interface - 1],
                        (Carrier::Lower, 1) => 0,
                        (Carrier::Lower, _) => links[interface - 2],
                    };
                    let turn = match face.checked_sub(1) {
                        None => [1.0, 0.0, 0.0],
                        Some(link) => [format!("cos_{face}"), format!("sin_{face}"), format!("omega_{}", link + 1)]
                            .map(|name| inputs[&name]),
                    };
                    let sign = if slip == Slip::Left { -1.0 } else { 1.0 };
                    (interface, turn, sign * self.values[&self.rows.friction[interface - 1]])
                }
                Kind::Apart(interface, axis) => (interface, [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0]][axis], 0.0),
                Kind::Angle(_) => panic!("angles come first"),
            };
            let mass = (interface - 1..links.len()).map(|block| self.value(self.rows.symbols.mass[block])).sum();
            inputs.extend(
                ["cos_face", "sin_face", "face_omega"]
                    .iter()
                    .zip(direction)
                    .map(|(name, value)| (format!("{name}_{number}"), value)),
            );
            inputs.extend([
                (format!("rate_{number}"), self.values[&coordinate.rate]),
                (format!("carried_mass_{number}"), mass),
                (format!("lift_{number}"), lift),
            ]);
            for link in 0..angles {
                let [lateral, axial] = self.first_moment(interface - 1, link);
                inputs.insert(format!("carried_{number}_lateral_{}", link + 1), lateral);
                inputs.insert(format!("carried_{number}_axial_{}", link + 1), axial);
            }
        }
        let s = &self.rows.symbols;
        inputs.extend([("ground_x".into(), self.values[&s.ground_x]), ("gravity".into(), self.values[&s.gravity])]);
        inputs
    }
}

/// Outputs of the routine `rows`.
fn run(program: &Program, inputs: &HashMap<String, f64>) -> Vec<f64> {
    let mut values: Environment =
        program.arena.symbols().filter_map(|(symbol, name)| Some((symbol, *inputs.get(name)?))).collect();
    let routine = &program.routines[0];
    for statement in &routine.statements {
        let value = program.arena.evaluate(statement.value, &values).expect("inputs and statements before");
        values.insert(statement.symbol, value);
    }
    routine.outputs.iter().map(|output| program.arena.evaluate(*output, &values).expect("known")).collect()
}

#[test]
fn one_program_serves_all_combinations_of_states_with_its_numbers_of_coordinates() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let programs: BTreeMap<(usize, usize), MovingRecord> =
        covered(3).into_iter().map(|pair| (pair, MovingRecord::new(pair.0, pair.1))).collect();
    let mut served: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for joints in (1..=3).flat_map(all_joints).filter(|joints| joints.translations() > 0) {
        let pair = (joints.angles(), joints.translations());
        let mut case = Case::new(&joints, &mut random);
        let inputs = case.inputs();
        let found = run(&programs[&pair].program, &inputs);
        let Rows { matrix, bias, forcing, .. } = &case.rows;
        let loads = bias.iter().zip(forcing).map(|(bias, forcing)| -case.value(*bias) - case.value(*forcing));
        let derived: Vec<f64> = matrix.iter().flatten().map(|entry| case.value(*entry)).chain(loads).collect();
        let scale = derived.iter().fold(1.0f64, |most, value| most.max(value.abs()));
        for (found, derived) in found.iter().zip(&derived) {
            // Sums of some hundred terms of this size.
            assert!((found - derived).abs() <= 1e-13 * scale, "{joints}: {found} against {derived}");
        }
        *served.entry(pair).or_default() += 1;
    }
    assert!(programs.keys().all(|pair| served.contains_key(pair)), "{served:?}");
}

/// Positions at a moment: `q + q̇ t + ½ q̈ t²`.
fn at(case: &Case, time: f64) -> Vec<[f64; 2]> {
    let mut values = case.values.clone();
    for each in &case.rows.coordinates {
        let [q, rate, acceleration] = [each.value, each.rate, each.acceleration].map(|expr| case.values[&expr]);
        values.insert(each.value, q + rate * time + 0.5 * acceleration * time * time);
    }
    case.rows
        .centroids
        .iter()
        .map(|g| g.map(|component| case.arena.evaluate(component, &values).expect("known")))
        .collect()
}

#[test]
fn rows_of_slides_are_the_resultant_of_what_is_above_tested_along_the_lifted_face() {
    let mut random = Random(0x2545_F491_4F6C_DD1D);
    for joints in (1..=2).flat_map(all_joints).filter(|joints| joints.translations() > 0) {
        let case = Case::new(&joints, &mut random);
        let step = 1e-3;
        let [before, now, after] = [-step, 0.0, step].map(|time| at(&case, time));
        let s = &case.rows.symbols;
        let ground = [case.values[&s.ground_x], case.values[&s.gravity]];
        let links = joints.linkage().link_of_block();
        for (index, each) in case.rows.coordinates.iter().enumerate() {
            let (interface, [x, y]) = match each.kind {
                Kind::Angle(_) => continue,
                Kind::Apart(interface, axis) => (interface, [[1.0, 0.0], [0.0, 1.0]][axis]),
                Kind::Slide(interface) => {
                    let Joint::Contact(_, slip, carrier) = joints.0[interface - 1] else { panic!("a contact") };
                    let block = if carrier == Carrier::Upper { interface } else { interface - 1 };
                    let angle = if block == 0 || links[block - 1] == 0 {
                        0.0
                    } else {
                        case.values[&s.theta[links[block - 1] - 1]]
                    };
                    let mu =
                        case.values[&case.rows.friction[interface - 1]] * if slip == Slip::Left { -1.0 } else { 1.0 };
                    (interface, [angle.cos() + mu * angle.sin(), mu * angle.cos() - angle.sin()])
                }
            };
            let mut force = [0.0, 0.0];
            for block in interface - 1..joints.0.len() {
                for axis in 0..2 {
                    let acceleration =
                        (before[block][axis] - 2.0 * now[block][axis] + after[block][axis]) / (step * step);
                    force[axis] += case.value(s.mass[block]) * (acceleration + ground[axis]);
                }
            }
            let expected = x * force[0] + y * force[1];
            let terms = case.rows.matrix[index].iter().zip(&case.rows.coordinates);
            let row: f64 = terms.map(|(entry, column)| case.value(*entry) * case.values[&column.acceleration]).sum();
            let row = row + case.value(case.rows.bias[index]) + case.value(case.rows.forcing[index]);
            // The error of the differences is step² / 12 of fourth derivatives: some hundred at these rates.
            assert!((row - expected).abs() < 1e-3, "{joints}, {:?}: {row} against {expected}", each.kind);
        }
    }
}
