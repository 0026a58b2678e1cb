//! Per linkage: the functions that turn a column into scene constants, and the table that finds them.

use super::expression::{Style, Writer};
use super::layout::{count, doc, unpack, words_of};
use super::step::{force_name, step_type, words};
use crate::catalogue::{Catalogue, CompositeRecord, LinkageRecord};
use crate::ground::GroundMotion;
use crate::optimise::Constant;
use crate::pattern::Linkage;
use crate::symbolic::{Arena, Expr, Node, Rational};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use std::collections::HashMap;

/// `open_1_3_of_5`: the linkage's name in generated code.
fn stem(linkage: &Linkage) -> String {
    let open: Vec<String> = (1..=linkage.blocks()).filter(|i| linkage.open[i - 1]).map(|i| i.to_string()).collect();
    format!("open_{}_of_{}", open.join("_"), linkage.blocks())
}

/// `with the ground: block 1; link 1: blocks 2, 3`
fn links(linkage: &Linkage) -> String {
    let of_block = linkage.link_of_block();
    let names = (0..=linkage.dof()).filter(|link| of_block.contains(link)).map(|link| {
        let blocks: Vec<String> =
            (1..=of_block.len()).filter(|i| of_block[i - 1] == link).map(|i| i.to_string()).collect();
        let name = if link == 0 { "with the ground".into() } else { format!("link {link}") };
        format!("{name}: block{} {}", if blocks.len() == 1 { "" } else { "s" }, blocks.join(", "))
    });
    names.collect::<Vec<_>>().join("; ")
}

/// All functions of one linkage.
pub fn functions(record: &LinkageRecord) -> TokenStream {
    let (stem, links) = (stem(&record.linkage), links(&record.linkage));
    let (accelerations, others) = (accelerations(record, &stem, &links), forces_and_energies(record, &stem, &links));
    quote! { #accelerations #others }
}

/// The functions of one linkage except those of the accelerations, whose constants are literals in a baked column.
pub fn force_and_energy_functions(record: &LinkageRecord) -> TokenStream {
    forces_and_energies(record, &stem(&record.linkage), &links(&record.linkage))
}

/// `links_2`: the name of the linkage of two links that are arbitrary rigid bodies.
fn composite_stem(record: &CompositeRecord) -> String {
    format!("links_{}", record.linkage.linkage.dof())
}

/// All functions of a linkage of any rigid bodies.
pub fn composite_functions(record: &CompositeRecord) -> TokenStream {
    let (stem, dof) = (composite_stem(record), record.linkage.linkage.dof());
    let links = format!("{dof} link(s) on a body that stands on the ground, body 1");
    let accelerations = accelerations(&record.linkage, &stem, &links);
    let others = forces_and_energies(&record.linkage, &stem, &links);
    let inside = record.inside.iter().enumerate().map(|(index, inside)| {
        let link = index + 1;
        let title = format!(
            "Scene constants of the contact forces at a closed interface inside link {link} of {dof}: bodies {link} and {} are that link below and above it.",
            link + 1
        );
        scene_constants(&quote! {}, &format_ident!("forces_inside_{link}_{stem}"), &title, &inside.arena, &inside.constants, &[])
    });
    quote! { #accelerations #others #(#inside)* }
}

fn accelerations(record: &LinkageRecord, stem: &str, links: &str) -> TokenStream {
    let accelerations = GroundMotion::ALL.map(|ground| {
        scene_constants(
            &quote! {},
            &accelerations_name(stem, ground),
            &format!("Scene constants of the accelerations{}; {links}.", words(ground)),
            &record.arena,
            &record.accelerations[ground as usize],
            &record.energies,
        )
    });
    quote! { #(#accelerations)* }
}

fn forces_and_energies(record: &LinkageRecord, stem: &str, links: &str) -> TokenStream {
    let function = |kind: &str, of: &str, constants: &[Constant]| {
        let title = format!("Scene constants of {of}; {links}.");
        scene_constants(&quote! {}, &format_ident!("{kind}_{stem}"), &title, &record.arena, constants, &record.energies)
    };
    let energies = function("energies", "mass matrix and energies", &record.energies);
    let series = function("series", "the weights", &record.series);
    let interfaces = record.interfaces.iter().enumerate().map(|(interface, (_, constants))| {
        let number = interface + 1;
        function(&format!("forces_{number}"), &format!("the contact forces at interface {number}"), constants)
    });
    quote! { #energies #series #(#interfaces)* }
}

/// Name of the function that computes the scene constants of the accelerations.
pub fn accelerations_name(stem: &str, ground: GroundMotion) -> Ident {
    match ground {
        GroundMotion::Horizontal => format_ident!("horizontal_{stem}"),
        GroundMotion::WithVertical => format_ident!("accelerations_{stem}"),
    }
}

/// A function from the sizes of a column to scene constants, each with a comment of unit and formula. Sub-expressions that equal a constant
/// of `energies` get its name. `visibility` is `pub`, or nothing.
pub fn scene_constants(
    visibility: &TokenStream,
    name: &Ident,
    title: &str,
    arena: &Arena,
    constants: &[Constant],
    energies: &[Constant],
) -> TokenStream {
    let doc = doc(title);
    let style = SceneNames { energies };
    let named = constants.iter().map(|constant| (constant.name.as_str(), constant.source));
    let mut writer = Writer::new(arena, named, &[], &style);
    for constant in constants {
        writer.bind(&constant.name, constant.source, constant.source);
    }
    let lets = writer.finish();
    let results = constants.iter().map(|constant| format_ident!("{}", constant.name));
    let body = quote! { #(#lets)* vec![#(#results),*] };
    let sizes = sizes(&body.to_string());
    quote! {
        #doc
        #visibility fn #name<S: Scalar>(column: &Geometry<S>) -> Vec<S> {
            #sizes
            #body
        }
    }
}

/// `let [h_1, h_2] = leading(&column.half_height);` and the like: the sizes that a body of a function reads.
fn sizes(body: &str) -> TokenStream {
    let read = words_of(body);
    let families = FAMILIES.iter().map(|(family, letter)| {
        let block = |word: &&str| word.strip_prefix(&letter.to_lowercase())?.parse::<usize>().ok();
        let last = read.iter().filter_map(block).max().unwrap_or(0);
        let names: Vec<String> = (1..=last).map(|block| variable(&format!("{family}_{block}"))).collect();
        let family = format_ident!("{family}");
        unpack(&names, &quote! { leading(&column.#family) }, &read)
    });
    let gravity = read.contains("g").then(|| quote! { let g = column.gravity; });
    quote! { #(#families)* #gravity }
}

/// Sizes of the blocks, or of bodies, and the letters of the notation.
const FAMILIES: [(&str, &str); 8] = [
    ("pivot", "p_"),
    ("half_height", "h_"),
    ("mass", "m_"),
    ("inertia", "I_"),
    ("centroid_lateral", "e_x"),
    ("centroid_axial", "e_"),
    ("top_lateral", "t_x"),
    ("top_axial", "t_"),
];

/// A symbol in the letters of the notation: `h_2` is `half_height_2`.
fn letter(symbol: &str) -> String {
    if symbol == "gravity" {
        return "g".into();
    }
    let (family, block) = split(symbol);
    let (_, letter) = FAMILIES.iter().find(|(name, _)| *name == family).expect("every size has a letter");
    format!("{letter}{block}")
}

/// A symbol as generated code reads it: its letter, `i_2` for the moment of inertia.
fn variable(symbol: &str) -> String {
    letter(symbol).to_lowercase()
}

/// Names and formulas of scene expressions.
struct SceneNames<'a> {
    energies: &'a [Constant],
}

impl Style for SceneNames<'_> {
    /// `half_height_2` is `h_2`.
    fn symbol(&self, name: &str) -> TokenStream {
        let name = format_ident!("{}", variable(name));
        quote! { #name }
    }

    /// Names by what a sub-expression is: a constant of `energies` gets its name there, a product the names of its factors, and a lever or a
    /// height the bodies or blocks that it spans.
    fn shared(&self, arena: &Arena, part: Expr) -> Option<String> {
        if let Some(known) = self.energies.iter().find(|constant| constant.source == part) {
            return Some(known.name.clone());
        }
        if let Node::Product(factors) = arena.node(part) {
            let is_plain = factors.iter().all(|(_, power)| *power == 1);
            let of_block = |(factor, _): &(Expr, i32)| arena.symbol_name(*factor)?.rsplit_once('_');
            let factors = factors.iter().filter(|_| is_plain).map(of_block).collect::<Option<Vec<_>>>()?;
            let words = factors.iter().map(|(family, block)| format!("{family}_of_block_{block}"));
            return Some(words.collect::<Vec<_>>().join("_times_"));
        }
        let terms = arena.terms(part);
        if let Some(lever) = body_lever(arena, &terms) {
            return Some(lever);
        }
        let mut heights = Vec::new();
        for (coefficient, term) in &terms {
            let (family, block) = split(arena.symbol_name(*term)?);
            if family != "half_height" || coefficient.denominator != 1 {
                return None;
            }
            heights.push((block, coefficient.numerator));
        }
        match heights[..] {
            [(first, 2), .., (last, 2)] => Some(format!("height_blocks_{first}_to_{last}")),
            [(first, 2), .., (last, 1)] => Some(format!("centroid_height_blocks_{first}_to_{last}")),
            _ => None,
        }
    }

    /// Unit and formula, written with the letters of the notation and with names given before.
    fn remark(&self, arena: &Arena, value: Expr, names: &HashMap<Expr, Ident>) -> Option<String> {
        let letter = |expr: Expr| match (names.get(&expr), arena.symbol_name(expr)) {
            (_, Some(name)) => Some(letter(name)),
            (Some(name), _) if expr != value => Some(name.to_string()),
            _ => None,
        };
        if arena.is_zero(value) {
            return Some("0".into());
        }
        Some(format!("[{}] {}", arena.unit(value), arena.text_with(value, &letter)))
    }
}

/// Name of a sum of levers by where it ends, with `_from_1` added for the first body if that is lower than the last: `left_to_centroid_of_body_2`,
/// `right_to_pivot_above_body_1`.
fn body_lever(arena: &Arena, terms: &[(Rational, Expr)]) -> Option<String> {
    let parts = terms.iter().map(|(coefficient, term)| {
        let (family, body) = split(arena.symbol_name(*term)?);
        Some((family, body, coefficient.numerator))
    });
    let parts = parts.collect::<Option<Vec<_>>>()?;
    let last = |family: &str| parts.iter().filter(|part| part.0 == family).max_by_key(|part| part.1);
    // Sizes of bodies are positive to the right.
    let side = |numerator| if numerator > 0 { "right" } else { "left" };
    let ending_at = |end: String, body: usize| {
        let first = parts.iter().map(|part| part.1).min().filter(|first| *first < body);
        format!("{end}_body_{body}{}", first.map_or(String::new(), |first| format!("_from_{first}")))
    };
    let ends = [
        last("centroid_lateral").map(|&(_, body, sign)| (format!("{}_to_centroid_of", side(sign)), body)),
        last("centroid_axial").map(|&(_, body, _)| ("axial_to_centroid_of".into(), body)),
        last("top_lateral").map(|&(_, body, sign)| {
            let ends_at_pivot = parts.iter().any(|part| part.0 == "pivot" && part.1 == body + 1);
            let end = if ends_at_pivot { "pivot_above" } else { "top_of" };
            (format!("{}_to_{end}", side(sign)), body)
        }),
        last("top_axial").map(|&(_, body, _)| ("axial_to_top_of".into(), body)),
    ];
    let (end, body) = ends.into_iter().flatten().next()?;
    Some(ending_at(end, body))
}

/// Splits a symbol into family and block: `half_height_2` into `half_height` and 2.
fn split(symbol: &str) -> (&str, usize) {
    let (family, block) = symbol.rsplit_once('_').expect("block symbols are named family_block");
    (family, block.parse().expect("block symbols are numbered from one"))
}

/// `fn linkage(blocks, mask)`: the equations of a linkage by the bits of its open interfaces.
pub fn table(linkages: &[LinkageRecord], accelerations: impl Fn(&str, GroundMotion) -> Ident) -> TokenStream {
    let arms = linkages.iter().map(|record| {
        let mask = record.linkage.open.iter().rev().fold(0usize, |mask, &open| 2 * mask + usize::from(open));
        let [blocks, mask] = [record.linkage.blocks(), mask].map(count);
        let equations = equations(record, &stem(&record.linkage), &accelerations);
        quote! { (#blocks, #mask) => #equations, }
    });
    let doc = doc(
        "The equations of a linkage: `blocks` of the column, bit `i` of `mask` set where interface `i + 1` is open; `None` for linkages that this module does not cover.",
    );
    quote! {
        #doc
        pub fn linkage<S: Scalar>(blocks: usize, mask: usize) -> Option<LinkageEquations<S>> {
            Some(match (blocks, mask) { #(#arms)* _ => return None })
        }
    }
}

/// The value `LinkageEquations { .. }` of a linkage.
fn equations(record: &LinkageRecord, stem: &str, accelerations: &impl Fn(&str, GroundMotion) -> Ident) -> TokenStream {
    let accelerations = GroundMotion::ALL.map(|ground| accelerations(stem, ground));
    let (energies, series) = (format_ident!("energies_{stem}"), format_ident!("series_{stem}"));
    let dof = count(record.linkage.dof());
    let interfaces = record.interfaces.iter().enumerate().map(|(interface, (program, _))| {
        interface_equations(&format_ident!("forces_{}_{stem}", interface + 1), *program)
    });
    quote! {
        LinkageEquations {
            dof: #dof,
            accelerations: [#(#accelerations),*],
            energies: #energies,
            series: #series,
            interfaces: Vec::from([#(#interfaces),*]),
        }
    }
}

fn interface_equations(constants: &Ident, program: usize) -> TokenStream {
    let forces = force_name(program);
    quote! { InterfaceEquations { constants: #constants, forces: #forces } }
}

/// `fn composite(dof)`: the equations of `dof` links that are arbitrary rigid bodies.
pub fn composite_table(composites: &[CompositeRecord]) -> TokenStream {
    let arms = composites.iter().map(|record| {
        let stem = composite_stem(record);
        let dof = count(record.linkage.linkage.dof());
        let whole = equations(&record.linkage, &stem, &accelerations_name);
        let inside = record.inside.iter().enumerate().map(|(index, inside)| {
            interface_equations(&format_ident!("forces_inside_{}_{stem}", index + 1), inside.program)
        });
        quote! { #dof => CompositeEquations { linkage: #whole, inside: Vec::from([#(#inside),*]) }, }
    });
    let doc = doc(
        "The equations of `dof` links that are any rigid bodies: of tapered and displaced blocks; `None` for more links than this module covers.",
    );
    let function = if composites.is_empty() {
        quote! { pub fn composite<S: Scalar>(_: usize) -> Option<CompositeEquations<S>> { None } }
    } else {
        quote! {
            pub fn composite<S: Scalar>(dof: usize) -> Option<CompositeEquations<S>> {
                Some(match dof { #(#arms)* _ => return None })
            }
        }
    };
    quote! {
        #doc
        #function

        /// The equations of all linkages.
        pub const LINKAGES: Linkages = Linkages { rectangles: linkage, composite };
    }
}

/// `fn mode(column, pattern, ground)`, and the constant `EQUATIONS` that hands this function to the solver.
pub fn modes(catalogue: &Catalogue) -> TokenStream {
    let max_blocks = catalogue.max_blocks;
    let arms = (1..=max_blocks).flat_map(|dof| {
        GroundMotion::ALL.map(|ground| {
            let (program, dof, ground) = (step_type(dof, ground), count(dof), ground_name(ground));
            quote! { (#dof, GroundMotion::#ground) => generated_mode::<#program>(column, pattern, ground, LINKAGES), }
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

/// Name of the variant of [`GroundMotion`], as an identifier.
pub fn ground_name(ground: GroundMotion) -> Ident {
    format_ident!("{}", format!("{ground:?}"))
}
