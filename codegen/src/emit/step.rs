//! Step programs and contact-force programs as Rust items.

use super::expression::Writer;
use super::{doc, number};
use crate::GroundMotion;
use crate::optimise::{Program, Routine};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use std::collections::HashMap;

/// The type that stands for the accelerations of this many degrees of freedom.
pub fn step_type(dof: usize, ground: GroundMotion) -> Ident {
    match ground {
        GroundMotion::Horizontal => format_ident!("HorizontalDof{dof}"),
        GroundMotion::WithVertical => format_ident!("Dof{dof}"),
    }
}

/// The type that stands for mass matrix and energies of this many degrees of freedom.
pub fn energy_type(dof: usize) -> Ident {
    format_ident!("EnergiesDof{dof}")
}

/// The type that stands for the weights of this many degrees of freedom.
pub fn series_type(dof: usize) -> Ident {
    format_ident!("SeriesDof{dof}")
}

/// The name of a contact-force program.
pub fn force_name(index: usize) -> Ident {
    format_ident!("contact_forces_{}", index + 1)
}

/// What of a program a reader wants to know: costs and constants.
fn describe(title: &str, program: &Program) -> TokenStream {
    let mut text = format!("{title}\n");
    for routine in &program.routines {
        if let Some(operations) = program.operations(routine.name) {
            text.push_str(&format!("\n- `{}`: {operations}", routine.name));
        }
    }
    if !program.constants.is_empty() {
        text.push_str("\n\nScene constants, in order:\n");
    }
    for constant in &program.constants {
        text.push_str(&format!("\n- `{}` ({})", constant.name, constant.unit));
    }
    doc(&text)
}

/// A `struct` and its `StepProgram`. `literals` are the values of the constants of a baked column.
pub fn step_program(name: &Ident, title: &str, program: &Program, literals: &Literals) -> TokenStream {
    let dof = program.dof;
    let count = literals.remaining(program);
    let (energies, series) = (energy_type(dof), series_type(dof));
    let doc = describe(title, program);
    let state = 2 * dof;
    let acceleration = body(program, "acceleration", literals);
    quote! {
        #doc
        #[derive(Clone, Copy, Debug)]
        pub struct #name;

        impl<S: Scalar> StepProgram<S> for #name {
            const DOF: usize = #dof;
            type Vector = [S; #dof];
            type State = [S; #state];
            type Constants = [S; #count];
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
            fn acceleration(constants: &[S; #count], cos: &[S; #dof], sin: &[S; #dof], omega: &[S; #dof], ground_x: S, gravity: S) -> [S; #dof] {
                #acceleration
            }
        }
    }
}

/// A `struct` and its `EnergyProgram`.
pub fn energy_program(program: &Program) -> TokenStream {
    let dof = program.dof;
    let name = energy_type(dof);
    let count = program.constants.len();
    let title = format!("Mass matrix and energies shared by all modes with {dof} free angle(s).");
    let doc = describe(&title, program);
    let literals = Literals::default();
    let (mass_matrix, energies) = (body(program, "mass_matrix", &literals), body(program, "energies", &literals));
    quote! {
        #doc
        #[derive(Clone, Copy, Debug)]
        pub struct #name;

        impl<S: Scalar> EnergyProgram<S> for #name {
            type Vector = [S; #dof];
            type Matrix = [[S; #dof]; #dof];
            type Constants = [S; #count];

            fn mass_matrix(constants: &[S; #count], cos: &[S; #dof], sin: &[S; #dof]) -> [[S; #dof]; #dof] {
                #mass_matrix
            }

            fn energies(constants: &[S; #count], cos: &[S; #dof], sin: &[S; #dof], omega: &[S; #dof], gravity: S) -> [S; 2] {
                #energies
            }
        }
    }
}

/// A `struct` and its `SeriesProgram`.
pub fn series_program(program: &Program) -> TokenStream {
    let dof = program.dof;
    let name = series_type(dof);
    let count = program.constants.len();
    let title = format!("Weights of the equations of all modes with {dof} free angle(s), for Taylor coefficients.");
    let doc = describe(&title, program);
    let weights = body(program, "weights", &Literals::default());
    quote! {
        #doc
        #[derive(Clone, Copy, Debug)]
        pub struct #name;

        impl<S: Scalar> SeriesProgram<S> for #name {
            type Vector = [S; #dof];
            type Constants = [S; #count];

            #[inline(always)]
            fn weights(constants: &[S; #count], cos_ddot: &[S; #dof], sin_ddot: &[S; #dof], ground_x: S, gravity: S) -> [[S; #dof]; 2] {
                #weights
            }
        }
    }
}

fn body(program: &Program, name: &str, literals: &Literals) -> TokenStream {
    routine_body(program, program.routines.iter().find(|routine| routine.name == name), literals)
}

/// Values of scene constants that are known when the code is written, by name.
#[derive(Clone, Debug, Default)]
pub struct Literals(pub HashMap<String, f64>);

impl Literals {
    /// How many constants a program is still to be given.
    fn remaining(&self, program: &Program) -> usize {
        program.constants.iter().filter(|constant| !self.0.contains_key(&constant.name)).count()
    }
}

fn routine_body(program: &Program, routine: Option<&Routine>, literals: &Literals) -> TokenStream {
    let Some(routine) = routine else { return TokenStream::new() };
    let values = routine.statements.iter().map(|statement| statement.value).chain(routine.outputs.iter().copied());
    let mut writer = Writer::new(&program.arena, values, |symbol| {
        if let Some(value) = literals.0.get(symbol) {
            let value = number(*value);
            return quote! { ground_x.like(#value) };
        }
        let name = format_ident!("{symbol}");
        quote! { #name }
    });
    for statement in &routine.statements {
        writer.bind(&statement.name, statement.symbol, statement.value);
    }
    let outputs: Vec<TokenStream> = routine.outputs.iter().map(|output| writer.read(*output)).collect();
    let lets = writer.finish();
    let result = if routine.name == "mass_matrix" || routine.name == "weights" {
        let rows = outputs.chunks(program.dof).map(|row| quote! { [#(#row),*] });
        quote! { [#(#rows),*] }
    } else {
        quote! { [#(#outputs),*] }
    };
    let used = quote! { #(#lets)* #result }.to_string();
    let inputs = inputs(program, routine, &used, literals);
    quote! { #inputs #(#lets)* #result }
}

/// `let [cos_1, …] = *cos;`, names that the body does not read left out.
fn inputs(program: &Program, routine: &Routine, used: &str, literals: &Literals) -> TokenStream {
    let words: std::collections::HashSet<&str> = used.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let mut lets = TokenStream::new();
    let families: &[&str] = match routine.name {
        "mass_matrix" => &["cos", "sin"],
        "weights" => &["cos_ddot", "sin_ddot"],
        "contact_forces" => &["cos", "sin", "omega", "alpha"],
        _ => &["cos", "sin", "omega"],
    };
    for family in families {
        let names: Vec<String> = (1..=program.dof).map(|index| format!("{family}_{index}")).collect();
        lets.extend(destructure(family, &names, &words));
    }
    let given = program.constants.iter().filter(|constant| !literals.0.contains_key(&constant.name));
    let names: Vec<String> = given.map(|constant| constant.name.clone()).collect();
    lets.extend(destructure("constants", &names, &words));
    lets
}

fn destructure(array: &str, names: &[String], words: &std::collections::HashSet<&str>) -> TokenStream {
    let array = format_ident!("{array}");
    if names.iter().all(|name| !words.contains(name.as_str())) {
        return quote! { let _ = #array; };
    }
    let names = names.iter().map(|name| {
        let ident = format_ident!("{name}");
        if words.contains(name.as_str()) {
            quote! { #ident }
        } else {
            quote! { _ }
        }
    });
    quote! { let [#(#names),*] = *#array; }
}

/// One contact-force program: `[N, T]` or `[N, T, M]`.
pub fn force_program(index: usize, program: &Program) -> TokenStream {
    let name = force_name(index);
    let (dof, count) = (program.dof, program.constants.len());
    let Some(routine) = program.routines.first() else { return TokenStream::new() };
    let body = routine_body(program, Some(routine), &Literals::default());
    let results = routine.outputs.len();
    let operations = program.operations("contact_forces").unwrap_or_default();
    let what = if results == 3 { "closed interface: `[N, T, M]`" } else { "open interface: `[N, T]`" };
    let doc = doc(&format!("Contact forces at one {what}, {dof} free angle(s); {operations}."));
    let values = (0..3).map(|index| {
        if index < results {
            quote! { forces[#index] }
        } else {
            quote! { S::from_f64(0.0) }
        }
    });
    let mismatch = "the caller passes as many angles and constants as the linkage has";
    quote! {
        #doc
        pub fn #name<S: Scalar>(constants: &[S], cos: &[S], sin: &[S], omega: &[S], alpha: &[S], ground_x: S, gravity: S) -> [S; 3] {
            let constants: &[S; #count] = constants.try_into().expect(#mismatch);
            let cos: &[S; #dof] = cos.try_into().expect(#mismatch);
            let sin: &[S; #dof] = sin.try_into().expect(#mismatch);
            let omega: &[S; #dof] = omega.try_into().expect(#mismatch);
            let alpha: &[S; #dof] = alpha.try_into().expect(#mismatch);
            let forces: [S; #results] = { #body };
            [#(#values),*]
        }
    }
}
