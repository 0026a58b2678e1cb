//! Step programs and contact-force programs as Rust items.

use super::expression::{Style, Writer};
use super::layout::{count, doc, unpack, words_of};
use super::number::number;
use super::quantity::{group, meaning};
use crate::ground::GroundMotion;
use crate::optimise::{Program, Routine};
use crate::symbolic::{Arena, Expr, Node};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use std::collections::{HashMap, HashSet};

/// The type of the accelerations of this many degrees of freedom.
pub fn step_type(dof: usize, ground: GroundMotion) -> Ident {
    match ground {
        GroundMotion::Horizontal => format_ident!("HorizontalDof{dof}"),
        GroundMotion::WithVertical => format_ident!("Dof{dof}"),
    }
}

/// The type of mass matrix and energies of this many degrees of freedom.
fn energy_type(dof: usize) -> Ident {
    format_ident!("EnergiesDof{dof}")
}

/// The type of the weights of this many degrees of freedom.
fn series_type(dof: usize) -> Ident {
    format_ident!("SeriesDof{dof}")
}

/// The name of a contact-force program.
pub fn force_name(index: usize) -> Ident {
    format_ident!("contact_forces_{}", index + 1)
}

/// How a doc line names the ground motion; empty for the program that covers any ground motion.
pub fn words(ground: GroundMotion) -> &'static str {
    match ground {
        GroundMotion::Horizontal => ", the ground moving horizontally only",
        GroundMotion::WithVertical => "",
    }
}

/// Title, cost and constants of a program.
fn describe(title: &str, program: &Program) -> TokenStream {
    let mut text = format!("{title}\n");
    for routine in &program.routines {
        text.push_str(&format!("\n- `{}`: {}", routine.name, program.operations(routine.name).unwrap_or_default()));
    }
    if !program.constants.is_empty() {
        text.push_str("\n\nScene constants, in order:\n");
    }
    for constant in &program.constants {
        // Moments and levers in SI units, and moments over J_1, have no unit of time.
        let is_by_gravity = constant.unit.2 != 0;
        let meaning = meaning(&constant.name, is_by_gravity);
        text.push_str(&format!("\n- `{}` `[{}]`: {meaning}", constant.name, constant.unit));
    }
    doc(&text)
}

/// A step program that all modes with its degrees of freedom share.
pub fn shared_step_program(program: &Program, ground: GroundMotion) -> TokenStream {
    let dof = program.dof;
    let title = format!("Accelerations shared by all modes with {dof} free angle(s){}.", words(ground));
    step_program(&step_type(dof, ground), &title, program, &HashMap::new())
}

/// A `struct` and its `StepProgram`. `literals` holds, by name, the values of constants that become literals in the code.
pub fn step_program(name: &Ident, title: &str, program: &Program, literals: &HashMap<String, f64>) -> TokenStream {
    let (energies, series) = (energy_type(program.dof), series_type(program.dof));
    let doc = describe(title, program);
    let given = program.constants.iter().filter(|constant| !literals.contains_key(&constant.name)).count();
    let [dof, state, given] = [program.dof, 2 * program.dof, given].map(count);
    let acceleration = body(program, "acceleration", literals);
    quote! {
        #doc
        #[derive(Clone, Copy, Debug)]
        pub struct #name;

        impl<S: Scalar> StepProgram<S> for #name {
            const DOF: usize = #dof;
            type Vector = [S; #dof];
            type State = [S; #state];
            type Constants = [S; #given];
            type Energies = #energies;
            type Series = #series;

            #[inline(always)]
            fn vector(fill: S) -> [S; #dof] {
                [fill; #dof]
            }

            #[inline(always)]
            fn state(fill: S) -> [S; #state] {
                [fill; #state]
            }

            #[inline(always)]
            fn acceleration(constants: &[S; #given], cos: &[S; #dof], sin: &[S; #dof], omega: &[S; #dof], ground_x: S, gravity: S) -> [S; #dof] {
                #acceleration
            }
        }
    }
}

/// A `struct` and its `EnergyProgram`.
pub fn energy_program(program: &Program) -> TokenStream {
    let name = energy_type(program.dof);
    let title = format!("Mass matrix and energies shared by all modes with {} free angle(s).", program.dof);
    let doc = describe(&title, program);
    let [dof, given] = [program.dof, program.constants.len()].map(count);
    let [mass_matrix, energies] = ["mass_matrix", "energies"].map(|routine| body(program, routine, &HashMap::new()));
    quote! {
        #doc
        #[derive(Clone, Copy, Debug)]
        pub struct #name;

        impl<S: Scalar> EnergyProgram<S> for #name {
            type Vector = [S; #dof];
            type Matrix = [[S; #dof]; #dof];
            type Constants = [S; #given];

            fn mass_matrix(constants: &[S; #given], cos: &[S; #dof], sin: &[S; #dof]) -> [[S; #dof]; #dof] {
                #mass_matrix
            }

            fn energies(constants: &[S; #given], cos: &[S; #dof], sin: &[S; #dof], omega: &[S; #dof], gravity: S) -> [S; 2] {
                #energies
            }
        }
    }
}

/// A `struct` and its `SeriesProgram`.
pub fn series_program(program: &Program) -> TokenStream {
    let name = series_type(program.dof);
    let title = format!(
        "Weights C_a and S_a in J_a theta_ddot_a + cos_a C_a + sin_a S_a = 0, of all modes with {} free angle(s), for Taylor coefficients.",
        program.dof
    );
    let doc = describe(&title, program);
    let [dof, given] = [program.dof, program.constants.len()].map(count);
    let weights = body(program, "weights", &HashMap::new());
    quote! {
        #doc
        #[derive(Clone, Copy, Debug)]
        pub struct #name;

        impl<S: Scalar> SeriesProgram<S> for #name {
            type Vector = [S; #dof];
            type Constants = [S; #given];

            #[inline(always)]
            fn weights(constants: &[S; #given], cos_ddot: &[S; #dof], sin_ddot: &[S; #dof], ground_x: S, gravity: S) -> [[S; #dof]; 2] {
                #weights
            }
        }
    }
}

/// One contact-force program: `[N, T]` or `[N, T, M]`.
pub fn force_program(index: usize, program: &Program) -> TokenStream {
    let name = force_name(index);
    let Some(routine) = program.routines.first() else { return TokenStream::new() };
    let (what, of_motion) = match routine.outputs.len() {
        3 => ("closed interface: `[N, T, M]`", " M is that of accelerations that satisfy the equations of motion."),
        _ => ("open interface: `[N, T, 0]`", ""),
    };
    let doc = describe(&format!("Contact forces at one {what}, {} free angle(s).{of_motion}", program.dof), program);
    let body = body(program, routine.name, &HashMap::new());
    quote! {
        #doc
        pub fn #name<S: Scalar>(constants: &[S], cos: &[S], sin: &[S], omega: &[S], alpha: &[S], ground_x: S, gravity: S) -> [S; 3] {
            #body
        }
    }
}

/// The function that turns the slices passed to contact-force programs into arrays.
pub fn sized() -> TokenStream {
    quote! {
        /// A slice as an array of the length that its program expects.
        fn sized<T, const LENGTH: usize>(values: &[T]) -> &[T; LENGTH] {
            values.try_into().expect("the caller passes as many angles and constants as the linkage has")
        }
    }
}

/// The statements of a routine as `let`s, and its outputs.
pub fn statements(program: &Program, routine: &Routine) -> (Vec<TokenStream>, Vec<TokenStream>) {
    let statements = routine.statements.iter().map(|statement| (statement.name.as_str(), statement.value));
    let mut writer = Writer::new(&program.arena, statements, &routine.outputs, &StateNames);
    let mut previous: Option<&str> = None;
    for statement in &routine.statements {
        if let Some(text) = group(&statement.name, previous) {
            writer.heading(text);
        }
        writer.bind(&statement.name, statement.symbol, statement.value);
        previous = Some(&statement.name);
    }
    let outputs: Vec<TokenStream> = routine.outputs.iter().map(|output| writer.read(*output)).collect();
    (writer.finish(), outputs)
}

/// Body of a routine: inputs, statements, results.
fn body(program: &Program, name: &str, literals: &HashMap<String, f64>) -> TokenStream {
    let Some(routine) = program.routines.iter().find(|routine| routine.name == name) else {
        return TokenStream::new();
    };
    let (lets, outputs) = statements(program, routine);
    let result = match routine.name {
        "mass_matrix" | "weights" => {
            let rows = outputs.chunks(program.dof).map(|row| quote! { [#(#row),*] });
            quote! { [#(#rows),*] }
        }
        "contact_forces" if outputs.len() == 2 => quote! { [#(#outputs,)* S::from_f64(0.0)] },
        _ => quote! { [#(#outputs),*] },
    };
    let inputs = inputs(program, routine, &quote! { #(#lets)* #result }.to_string(), literals);
    quote! { #inputs #(#lets)* #result }
}

/// `let [cos_1, …] = *cos;`, with `_` for names that the body does not read, and a `let` for each literal that it reads.
fn inputs(program: &Program, routine: &Routine, used: &str, literals: &HashMap<String, f64>) -> TokenStream {
    let read = words_of(used);
    let families: &[&str] = match routine.name {
        "mass_matrix" => &["cos", "sin"],
        "weights" => &["cos_ddot", "sin_ddot"],
        "contact_forces" => &["cos", "sin", "omega", "alpha"],
        _ => &["cos", "sin", "omega"],
    };
    let is_slice = routine.name == "contact_forces";
    let of_family = |family: &&str| (1..=program.dof).map(|link| format!("{family}_{link}")).collect::<Vec<_>>();
    let mut lets: TokenStream =
        families.iter().map(|family| destructure(family, &of_family(family), &read, is_slice)).collect();
    let names = program.constants.iter().map(|constant| constant.name.clone());
    let (known, given): (Vec<String>, Vec<String>) = names.partition(|name| literals.contains_key(name));
    lets.extend(destructure("constants", &given, &read, is_slice));
    for name in known.iter().filter(|name| read.contains(name.as_str())) {
        let (name, value) = (format_ident!("{name}"), number(literals[name]));
        lets.extend(quote! { let #name = ground_x.like(#value); });
    }
    lets
}

fn destructure(array: &str, names: &[String], read: &HashSet<&str>, is_slice: bool) -> TokenStream {
    let (array, length) = (format_ident!("{array}"), count(names.len()));
    let value = if is_slice {
        quote! { *sized::<S, #length>(#array) }
    } else {
        quote! { *#array }
    };
    let lets = unpack(names, &value, read);
    if lets.is_empty() {
        quote! { let _ = #array; }
    } else {
        lets
    }
}

/// Names of parts that statements share: turned vectors and products.
struct StateNames;

impl Style for StateNames {
    fn shared(&self, arena: &Arena, part: Expr) -> Option<String> {
        let name = |expr: Expr| arena.symbol_name(expr);
        match arena.node(part) {
            Node::Product(factors) if factors.iter().all(|(_, power)| *power == 1) => {
                Some(factors.iter().map(|(factor, _)| name(*factor)).collect::<Option<Vec<_>>>()?.join("_times_"))
            }
            // x = cos axial + sin lateral, y = cos lateral - sin axial: `stack_y_2`.
            Node::Sum(terms) if terms.len() == 2 => terms.iter().find_map(|(coefficient, term)| {
                let [(angle, 1), (constant, 1)] = arena.factors(*term)[..] else { return None };
                let ((function, link), constant) = (name(angle)?.split_once('_')?, name(constant)?);
                let (of, axis) = constant.split_once("_axial").or(constant.split_once("_lateral"))?;
                let is_axial = constant.contains("_axial");
                let component = if (function == "cos") == is_axial { "x" } else { "y" };
                let is_opposite = coefficient.is_negative() != (function == "sin" && is_axial);
                let (of, is_opposite) = match of.strip_prefix("minus_") {
                    Some(of) => (of, !is_opposite),
                    None => (of, is_opposite),
                };
                let sign = if is_opposite { "minus_" } else { "" };
                (axis.is_empty() || axis == format!("_{link}")).then(|| format!("{sign}{of}_{component}_{link}"))
            }),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::derivation::derive;
    use crate::pattern::Linkage;

    /// In a baked column `inverse_gravity` may be a literal: what the other constants are does not hang on its being among them.
    #[test]
    fn constants_say_what_they_are_by_their_own_unit() {
        let [mut program, _] = derive(&Linkage { open: vec![true; 3] }).accelerations;
        let described = |program: &Program| describe("title", program).to_string();
        let named = described(&program);
        assert!(named.contains("inverse_gravity") && named.contains("over gravity"), "{named}");
        program.constants.retain(|constant| constant.name != "inverse_gravity");
        let baked = described(&program);
        assert!(!baked.contains("inverse_gravity") && baked.contains("over gravity"), "{baked}");
    }
}
