//! The machine code of a right-hand side: no allocation, no bounds check, no panic, no cost of being generic over the scalar.
//!
//! The generated text is compiled by `rustc` alone, with the traits of `solver/mechanics/program.rs` and a stand-in for the rest of the
//! library, and the assembly of one function per program is read. The only call allowed is that of the sine and cosine.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Programs examined: free angles 1 to 5.
const LARGEST: usize = 5;

/// The library as far as generated text names it.
const STAND_IN: &str = r#"
#![allow(dead_code, non_snake_case, unused)]
extern crate self as rocking;
pub mod pattern {
    pub struct Pattern;
    impl Pattern {
        pub fn dof(&self) -> usize { 0 }
    }
}
pub struct Column;
pub struct Mode;
#[derive(Clone, Copy)]
pub enum GroundMotion { Horizontal, WithVertical }
pub mod generated {
    use crate::program::*;
    pub struct Equations {
        pub name: &'static str,
        pub mode: fn(&crate::Column, &crate::pattern::Pattern, crate::GroundMotion) -> Option<crate::Mode>,
    }
    pub fn generated_mode<P>(
        _: &crate::Column,
        _: &crate::pattern::Pattern,
        _: crate::GroundMotion,
        _: Linkages,
    ) -> Option<crate::Mode> {
        None
    }
}
#[inline(never)]
pub fn sine_and_cosine(angle: f64) -> (f64, f64) {
    (angle * 1.5, angle * 0.5)
}
impl program::Scalar for f64 {
    #[inline(always)]
    fn from_f64(value: f64) -> f64 { value }
    #[inline(always)]
    fn recip(self) -> f64 { 1.0 / self }
    #[inline(always)]
    fn sin_cos(self) -> (f64, f64) { sine_and_cosine(self) }
}
"#;

/// A function whose assembly is read: the right-hand side of a program, as the solver calls it.
fn probe(program: &str, dof: usize) -> String {
    let state = 2 * dof;
    format!(
        "#[unsafe(no_mangle)]\npub fn probe_{program}(constants: &<equations::{program} as program::StepProgram<f64>>::Constants, \
         state: &[f64; {state}], ground_x: f64, gravity: f64, slope: &mut [f64; {state}]) {{\n    \
         program::slope::<f64, equations::{program}>(constants, state, ground_x, gravity, slope)\n}}\n"
    )
}

fn programs() -> impl Iterator<Item = (String, usize)> {
    (1..=LARGEST).flat_map(|dof| [(format!("HorizontalDof{dof}"), dof), (format!("Dof{dof}"), dof)])
}

/// Assembly of the probes for a generated text.
fn assembly(folder: &Path, equations: &str) -> String {
    let solver = Path::new(env!("CARGO_MANIFEST_DIR")).join("solver");
    let (traits, scalar) = (solver.join("mechanics/program.rs"), solver.join("numerics/scalar.rs"));
    let probes: String = programs().map(|(program, dof)| probe(&program, dof)).collect();
    let text = format!(
        "{STAND_IN}\npub mod numerics {{ #[path = {scalar:?}] pub mod scalar; }}\n#[path = {traits:?}]\npub mod program;\npub mod equations {{\n{equations}\n}}\n{probes}"
    );
    let (source, output) = (folder.join("probe.rs"), folder.join("probe.s"));
    std::fs::write(&source, text).expect("the temporary folder can be written");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let status = Command::new(rustc)
        .args([
            "--edition",
            "2024",
            "--crate-type",
            "lib",
            "-C",
            "opt-level=3",
            "-C",
            "codegen-units=1",
            "-C",
            "relocation-model=static",
        ])
        .args(["--emit", "asm", "-o"])
        .args([&output, &source])
        .status()
        .expect("rustc runs where cargo does");
    assert!(status.success(), "the generated text compiles");
    std::fs::read_to_string(output).expect("the assembly was written")
}

/// Instructions of a function: the lines between its label and its end that are neither labels nor directives.
fn instructions<'a>(assembly: &'a str, program: &str) -> Vec<&'a str> {
    let label = format!("probe_{program}:");
    let label_with_underscore = format!("_{label}");
    let body = assembly.lines().skip_while(|line| *line != label && *line != label_with_underscore).skip(1);
    let body = body.take_while(|line| !line.starts_with(".Lfunc_end") && !line.contains(".cfi_endproc"));
    let found: Vec<&str> =
        body.map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('.') && !line.ends_with(':')).collect();
    assert!(found.len() > 10, "{program} was found in the assembly");
    found
}

fn temporary_folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).expect("cargo's own folder for temporary files");
    folder
}

#[test]
fn a_right_hand_side_neither_allocates_nor_checks_bounds_nor_panics() {
    let equations = rocking_codegen::generate(LARGEST).expect("a valid size");
    let assembly = assembly(&temporary_folder("straight_line"), &equations);
    for (program, dof) in programs() {
        let body = instructions(&assembly, &program);
        let calls: Vec<&&str> = body
            .iter()
            .filter(|line| line.starts_with("call") || line.starts_with("bl ") || line.starts_with("blr"))
            .collect();
        assert!(
            calls.iter().all(|line| line.contains("sine_and_cosine")),
            "{program} calls more than sines: {calls:?}"
        );
        // One sine and cosine per free angle; small loops may stay loops.
        assert!(calls.len() <= dof, "{program} calls {} sines", calls.len());
        let text = body.join("\n");
        for word in ["panic", "bounds", "alloc", "fail", "ud2", "brk"] {
            assert!(!text.contains(word), "{program} has `{word}`");
        }
    }
}

/// The same text with the scalar written out as `f64` compiles to the same number of instructions.
#[test]
fn being_generic_costs_nothing() {
    let generic = rocking_codegen::generate(LARGEST).expect("a valid size");
    let concrete = generic.replace("<S: Scalar>", "");
    let mut text = String::new();
    let mut word = String::new();
    for character in concrete.chars().chain([' ']) {
        if character.is_alphanumeric() || character == '_' {
            word.push(character);
        } else {
            text.push_str(if word == "S" { "f64" } else { &word });
            word.clear();
            text.push(character);
        }
    }
    let generic = assembly(&temporary_folder("generic"), &generic);
    let concrete = assembly(&temporary_folder("concrete"), &text);
    for (program, _) in programs() {
        assert_eq!(instructions(&generic, &program).len(), instructions(&concrete, &program).len(), "{program}");
    }
}
