//! The module of a baked column: accelerations per mode with literals, energies and contact forces as for every column.

use super::layout::{count, format};
use super::linkage::{self, ground_name};
use super::module::{head, shared_programs, texts, uses};
use super::number::number;
use super::step::{step_program, words};
use crate::bake::{BakedCatalogue, BakedMode};
use crate::ground::GroundMotion;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The Rust text of the equations of one column, whose sizes are literals; formatted.
pub fn baked_module(catalogue: &BakedCatalogue) -> String {
    let (uses, blocks) = (uses(), catalogue.column.blocks.len());
    let contents = format!(
        "Equations of motion of one column of {blocks} block(s), its sizes literals: {} modes.",
        catalogue.modes.len()
    );
    let sizes = catalogue.column.blocks.iter().map(|block| {
        let values = [block.half_width, block.half_height, block.mass, block.inertia].map(number);
        quote! { [#(#values),*] }
    });
    let gravity = number(catalogue.column.gravity);
    let arms = catalogue.modes.iter().map(arms);
    let programs = catalogue.modes.iter().flat_map(|mode| GroundMotion::ALL.map(|ground| program(mode, ground)));
    let shared = shared_programs(&catalogue.shared);
    let table = linkage::table(&catalogue.shared.linkages, |_, _| format_ident!("no_constants"));
    let composites = linkage::composite_table(&catalogue.shared.composites);
    let name = format!("baked column of {blocks} block(s), sizes {:016x}", catalogue.column.digest());
    let blocks = count(blocks);
    let items = format(quote! {
        #uses
        use rocking::generated::{Mirrored, is_column};

        /// `[half_width, half_height, mass, inertia]` per block, base first `[m, m, kg, kg m²]`.
        pub const SIZES: [[f64; 4]; #blocks] = [#(#sizes),*];

        /// Gravity `[m/s²]`.
        pub const GRAVITY: f64 = #gravity;

        /// The mode of a pattern of this column; `None` at rest and for any other column.
        pub fn mode(column: &Column, pattern: &Pattern, ground: GroundMotion) -> Option<Mode> {
            if !is_column(column, GRAVITY, &SIZES) {
                return None;
            }
            match (pattern.signs().as_slice(), ground) { #(#arms)* _ => None }
        }

        /// These equations, for the solver; the name carries a digest of the sizes.
        pub const EQUATIONS: Equations = Equations { name: #name, mode };

        /// Scene constants of the accelerations, which have literals in their place.
        fn no_constants<S: Scalar>(_: &Geometry<S>) -> Vec<S> {
            Vec::new()
        }

        #(#programs)*
        #shared
        #table
        #composites
    });
    let functions = texts(&catalogue.shared.linkages, linkage::force_and_energy_functions);
    head("`rocking_codegen::generate_baked`", &contents) + &items + &functions
}

fn mode_type(mode: &BakedMode, ground: GroundMotion) -> Ident {
    let label = mode.label.to_string().replace('.', "_");
    match ground {
        GroundMotion::Horizontal => format_ident!("HorizontalMode{label}"),
        GroundMotion::WithVertical => format_ident!("Mode{label}"),
    }
}

/// Match arms of the emitted function `mode` for one mode and its mirror image.
fn arms(mode: &BakedMode) -> TokenStream {
    let arms = GroundMotion::ALL.map(|ground| {
        let (program, variant) = (mode_type(mode, ground), ground_name(ground));
        let signs = mode.pattern.signs().into_iter().map(Literal::i8_unsuffixed);
        let mirrored = mode.pattern.mirror().signs().into_iter().map(Literal::i8_unsuffixed);
        quote! {
            (&[#(#signs),*], GroundMotion::#variant) => {
                generated_mode::<#program>(column, pattern, ground, LINKAGES)
            }
            (&[#(#mirrored),*], GroundMotion::#variant) => {
                generated_mode::<Mirrored<#program>>(column, pattern, ground, LINKAGES)
            }
        }
    });
    quote! { #(#arms)* }
}

fn program(mode: &BakedMode, ground: GroundMotion) -> TokenStream {
    let (program, literals) = &mode.accelerations[ground as usize];
    let title = format!("Accelerations of mode {}, pattern {}{}.", mode.label, mode.pattern, words(ground));
    step_program(&mode_type(mode, ground), &title, program, literals)
}
