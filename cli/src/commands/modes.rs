//! `rocking modes` and `rocking derive`: what the generator knows of a column's modes.

use crate::arguments::Format;
use crate::commands::plot::write;
use crate::error::Failure;
use crate::plot::modes::{LARGEST, draw};
use crate::plot::states;
use crate::posture;
use crate::terminal::print;
use crate::text::shown;
use rocking::GroundMotion;
use rocking::pattern::{ModeLabel, Pattern, modes};
use rocking_codegen::joints::{Joints, combinations};
use rocking_codegen::moving::moving_name;
use rocking_codegen::{Plan, report};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;

/// A mode as it is listed.
#[derive(Debug, Serialize)]
pub struct Row {
    mode: String,
    /// Signs of the interfaces, base first.
    pattern: String,
    /// Number of free angles.
    dof: usize,
    /// Name of the step-time program, which all modes with the same number of free angles share.
    program: String,
    /// Additions, subtractions and multiplications of one evaluation of the accelerations under horizontal ground motion.
    flops: usize,
    /// Divisions of the same evaluation, not counted in `flops`.
    divisions: usize,
    drawing: String,
}

/// The independent modes of a column, in the order of their labels.
pub fn rows(blocks: usize) -> Vec<Row> {
    // One step-time program per number of free angles: modes with the same number have the same operation counts.
    let operations: Vec<_> = (1..=blocks).map(|dof| Plan::new(dof).operations(GroundMotion::Horizontal)).collect();
    let row = |(label, pattern): (ModeLabel, Pattern)| {
        let dof = pattern.dof();
        Row {
            mode: label.to_string(),
            pattern: pattern.to_string(),
            dof,
            program: format!("HorizontalDof{dof}"),
            flops: operations[dof - 1].flops(),
            divisions: operations[dof - 1].divisions,
            drawing: posture::line(&pattern),
        }
    };
    modes(blocks).map(row).collect()
}

/// One line per mode. The drawing comes last: it alone has blanks, and a line is often split at them.
pub fn list_modes(blocks: usize) -> String {
    let width = (2 * blocks + 1).max("pattern".len());
    let mut text = format!("{:<9} {:<width$}  dof  {:<15}  flops  divisions  drawing\n", "mode", "pattern", "program");
    for Row { mode, pattern, dof, program, flops, divisions, drawing } in rows(blocks) {
        let _ = writeln!(
            text,
            "{mode:<9} {pattern:<width$}  {dof:<3}  {program:<15}  {flops:<5}  {divisions:<9}  {drawing}"
        );
    }
    let _ = write!(
        text,
        "{} independent mode(s) of {blocks} block(s), interfaces base first; mirror images are the same modes.\n\
         dof: free angles; program: the step-time program of all modes with as many; flops, divisions: of one call of its accelerations, ground moving horizontally.\n\
         drawing: {}\n",
        mode_count(blocks),
        posture::LINE_KEY
    );
    let largest = rocking::generated::MAX_BLOCKS;
    if blocks > largest {
        let _ = writeln!(
            text,
            "This build has generated equations for columns of up to {largest} blocks. Larger columns run on hand-written ones; of tapered or displaced blocks, only\n\
             the modes with more than {largest} free angles do. ROCKING_MAX_BLOCKS={blocks} builds equations for {blocks} blocks."
        );
    }
    text
}

fn mode_count(blocks: usize) -> u64 {
    (3u64.pow(blocks as u32) - 1) / 2
}

/// Draws the modes into a file.
pub fn draw_modes(blocks: usize, file: &Path) -> Result<(), Failure> {
    let modes = mode_count(blocks);
    if blocks > LARGEST {
        return Err(Failure::CrowdedFigure { blocks, modes, largest: LARGEST });
    }
    write(&draw(blocks), file)?;
    print(&format!("wrote {modes} mode(s) of {blocks} block(s) to {}\n", shown(file)))
}

/// Draws the ten states of an interface into a file.
pub fn draw_states(file: &Path) -> Result<(), Failure> {
    write(&states::draw(), file)?;
    print(&format!("wrote the ten states of an interface to {}\n", shown(file)))
}

/// The output of `rocking derive`.
pub enum Asked {
    /// The equations, in a format.
    Derivation(Format),
    /// Operation counts.
    Counts,
}

/// The derivation or the operation counts of a mode or of states, as text.
pub fn derive(blocks: usize, mode: &str, request: Asked) -> Result<String, Failure> {
    if !mode.trim_start().starts_with('(') {
        let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        let is_label = mode.trim().split_once('.').is_some_and(|(k, j)| is_number(k) && is_number(j));
        let label = ModeLabel::parse(mode.trim()).ok_or_else(|| match is_label {
            true => Failure::Mode(mode.into(), blocks),
            false => Failure::NotAMode(mode.into()),
        })?;
        let pattern = label.pattern(blocks).ok_or_else(|| Failure::Mode(mode.into(), blocks))?;
        return Ok(of_pattern(&pattern, request));
    }
    let joints = Joints::parse(mode).map_err(|error| Failure::States(mode.into(), error))?;
    if joints.0.len() != blocks {
        return Err(Failure::StateCount { given: mode.into(), states: joints.0.len(), blocks });
    }
    match joints.pattern() {
        Some(pattern) if pattern.dof() == 0 => Err(Failure::AtRest(mode.into())),
        Some(pattern) => Ok(of_pattern(&pattern, request)),
        None => Ok(of_joints(&joints, request)),
    }
}

fn of_pattern(pattern: &Pattern, request: Asked) -> String {
    match request {
        Asked::Counts => report::counts(pattern),
        Asked::Derivation(Format::Text) => report::text(pattern),
        Asked::Derivation(Format::Rust) => report::rust(pattern),
        Asked::Derivation(Format::Latex) => report::latex(pattern),
    }
}

fn of_joints(joints: &Joints, request: Asked) -> String {
    match request {
        Asked::Counts => report::moving_counts(joints),
        Asked::Derivation(Format::Text) => report::moving_text(joints),
        Asked::Derivation(Format::Rust) => report::moving_rust(joints),
        Asked::Derivation(Format::Latex) => report::moving_latex(joints),
    }
}

/// States with the same numbers of free coordinates, as they are listed.
#[derive(Debug, Serialize)]
pub struct MovingRow {
    /// Free angles.
    angles: usize,
    /// Free translations: one for each interface that slides, two for each interface in flight.
    translations: usize,
    /// Number of combinations of the ten states of each interface.
    states: u64,
    /// Name of the program that serves all these combinations.
    program: String,
    /// Whether the generated program is compiled into this build. If not, hand-written equations replace the program.
    built: bool,
}

/// Rows of the states of a column with friction, by free angles, then by translations. States in which nothing slides or flies are left out.
pub fn moving_rows(blocks: usize) -> Vec<MovingRow> {
    let counts = combinations(blocks);
    let all = counts.iter().enumerate().flat_map(|(angles, row)| {
        row.iter().enumerate().skip(1).filter(|(_, states)| **states > 0).map(move |(translations, &states)| {
            MovingRow {
                angles,
                translations,
                states,
                program: moving_name(angles, translations),
                built: rocking::generated::moving::moving(angles, translations).is_some(),
            }
        })
    });
    all.collect()
}

/// One line per program.
pub fn list_moving(blocks: usize) -> String {
    let rows = moving_rows(blocks);
    let mut text = format!("{:<6}  {:<12}  {:>14}  {:<22}  built\n", "angles", "translations", "states", "program");
    for MovingRow { angles, translations, states, program, built } in &rows {
        let built = if *built { "yes" } else { "no" };
        let _ = writeln!(text, "{angles:<6}  {translations:<12}  {states:>14}  {program:<22}  {built}");
    }
    let sliding: u64 = rows.iter().map(|row| row.states).sum();
    let _ = write!(
        text,
        "{sliding} of the 10^{blocks} combinations of states of {blocks} block(s) slide or fly, on {} program(s); the others stick: the {} mode(s) of `rocking modes`, their mirror images, and rest.\n\
         translations: one for each interface that slides, two for each that flies; built: whether this build has the program, or the hand-written equations serve.\n",
        rows.len(),
        (3u64.pow(blocks as u32) - 1) / 2,
    );
    text
}
