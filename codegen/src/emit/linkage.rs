//! Per linkage: the functions that turn a column into scene constants, and the table that finds them.

use super::doc;
use super::expression::Writer;
use super::step::{force_name, step_type};
use crate::optimise::Constant;
use crate::pattern::Linkage;
use crate::symbolic::Arena;
use crate::{Catalogue, GroundMotion, LinkageRecord};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// `open_1_3_of_5`: the linkage's name in generated code.
fn stem(linkage: &Linkage) -> String {
    let open: Vec<String> = (1..=linkage.blocks()).filter(|i| linkage.open[i - 1]).map(|i| i.to_string()).collect();
    format!("open_{}_of_{}", open.join("_"), linkage.blocks())
}

/// All functions of one linkage.
pub fn functions(record: &LinkageRecord) -> TokenStream {
    let (accelerations, others) = (acceleration_functions(record), force_and_energy_functions(record));
    quote! { #accelerations #others }
}

fn acceleration_functions(record: &LinkageRecord) -> TokenStream {
    let stem = stem(&record.linkage);
    let accelerations = GroundMotion::ALL.map(|ground| {
        scene_constants(
            &accelerations_name(&stem, ground),
            &format!("Scene constants of the accelerations where {} move(s){}.", stem.replace('_', " "), words(ground)),
            &record.arena,
            &record.accelerations[ground as usize],
        )
    });
    quote! { #(#accelerations)* }
}

/// The functions of one linkage but those of the accelerations, which a baked column has as literals.
pub fn force_and_energy_functions(record: &LinkageRecord) -> TokenStream {
    let stem = stem(&record.linkage);
    let energies = scene_constants(
        &format_ident!("energies_{stem}"),
        "Scene constants of mass matrix and energies.",
        &record.arena,
        &record.energies,
    );
    let series = scene_constants(
        &format_ident!("series_{stem}"),
        "Scene constants of the weights.",
        &record.arena,
        &record.series,
    );
    let interfaces = record.interfaces.iter().enumerate().map(|(interface, (_, constants))| {
        let number = interface + 1;
        scene_constants(
            &format_ident!("forces_{number}_{stem}"),
            &format!("Scene constants of the contact forces at interface {number}."),
            &record.arena,
            constants,
        )
    });
    quote! { #energies #series #(#interfaces)* }
}

/// The function of the accelerations' scene constants.
pub fn accelerations_name(stem: &str, ground: GroundMotion) -> Ident {
    match ground {
        GroundMotion::Horizontal => format_ident!("horizontal_{stem}"),
        GroundMotion::WithVertical => format_ident!("accelerations_{stem}"),
    }
}

/// What is said of a ground motion in a doc line.
pub fn words(ground: GroundMotion) -> &'static str {
    match ground {
        GroundMotion::Horizontal => ", the ground moving horizontally only",
        GroundMotion::WithVertical => "",
    }
}

/// A function from the column's sizes to scene constants, each with its formula and unit in the doc.
pub fn scene_constants(name: &Ident, title: &str, arena: &Arena, constants: &[Constant]) -> TokenStream {
    let mut text = format!("{title}\n");
    for constant in constants {
        text.push_str(&format!("\n- `{}` ({}) = `{}`", constant.name, constant.unit, arena.text(constant.source)));
    }
    let doc = doc(&text);
    let mut writer = Writer::new(arena, constants.iter().map(|constant| constant.source), column_field);
    for constant in constants {
        writer.bind(&constant.name, constant.source, constant.source);
    }
    let lets = writer.finish();
    let results = constants.iter().map(|constant| format_ident!("{}", constant.name));
    quote! {
        #doc
        fn #name<S: Scalar>(column: &Geometry<S>) -> Vec<S> {
            #(#lets)*
            vec![#(#results),*]
        }
    }
}

/// How a symbol of the column is read: `half_height_2` is `column.half_height[1]`.
fn column_field(symbol: &str) -> TokenStream {
    if symbol == "gravity" {
        return quote! { column.gravity };
    }
    let (family, index) = symbol.rsplit_once('_').expect("block symbols are named family_index");
    let family = format_ident!("{family}");
    let index = index.parse::<usize>().expect("block symbols are numbered from one") - 1;
    let index = proc_macro2::Literal::usize_unsuffixed(index);
    quote! { column.#family[#index] }
}

/// `fn linkage(blocks, mask)`: the equations of a linkage by the bits of its open interfaces.
pub fn table(linkages: &[LinkageRecord], accelerations: impl Fn(&str, GroundMotion) -> Ident) -> TokenStream {
    let arms = linkages.iter().map(|record| {
        let blocks = record.linkage.blocks();
        let mask = record.linkage.open.iter().rev().fold(0usize, |mask, &open| 2 * mask + usize::from(open));
        let stem = stem(&record.linkage);
        let accelerations = GroundMotion::ALL.map(|ground| accelerations(&stem, ground));
        let energies = format_ident!("energies_{stem}");
        let series = format_ident!("series_{stem}");
        let dof = record.linkage.dof();
        let interfaces = record.interfaces.iter().enumerate().map(|(interface, (program, _))| {
            let constants = format_ident!("forces_{}_{stem}", interface + 1);
            let forces = force_name(*program);
            quote! { InterfaceEquations { constants: #constants, forces: #forces } }
        });
        quote! {
            (#blocks, #mask) => LinkageEquations { dof: #dof, accelerations: [#(#accelerations),*], energies: #energies, series: #series, interfaces: vec![#(#interfaces),*] },
        }
    });
    let doc = doc(
        "The equations of a linkage: `blocks` of the column, bit `i` of `mask` set where interface `i + 1` is open.\nWhat the build has not got is `None`.",
    );
    quote! {
        #doc
        pub fn linkage<S: Scalar>(blocks: usize, mask: usize) -> Option<LinkageEquations<S>> {
            Some(match (blocks, mask) { #(#arms)* _ => return None })
        }
    }
}

/// `fn mode(column, pattern, ground)` and the constant by which the solver is given it.
pub fn modes(catalogue: &Catalogue) -> TokenStream {
    let max_blocks = catalogue.max_blocks;
    let arms = (1..=max_blocks).flat_map(|dof| {
        GroundMotion::ALL.map(|ground| {
            let program = step_type(dof, ground);
            let ground = ground_name(ground);
            quote! { (#dof, GroundMotion::#ground) => generated_mode::<#program>(column, pattern, ground, linkage), }
        })
    });
    let name = format!("generated for up to {max_blocks} block(s)");
    quote! {
        /// The mode of a pattern on these equations; `None` at rest and for larger columns.
        pub fn mode(column: &Column, pattern: &Pattern, ground: GroundMotion) -> Option<Mode> {
            match (pattern.dof(), ground) { #(#arms)* _ => None }
        }

        /// These equations, for the solver.
        pub const EQUATIONS: Equations = Equations { name: #name, mode };
    }
}

/// The variant's name.
pub fn ground_name(ground: GroundMotion) -> Ident {
    match ground {
        GroundMotion::Horizontal => format_ident!("Horizontal"),
        GroundMotion::WithVertical => format_ident!("WithVertical"),
    }
}
