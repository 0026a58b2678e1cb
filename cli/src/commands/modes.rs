//! `rocking modes` and `rocking derive`: what the generator knows of a column's modes.

use crate::arguments::Format;
use crate::commands::plot::write;
use crate::error::Failure;
use crate::plot::modes::{LARGEST, draw};
use crate::posture;
use crate::terminal::print;
use crate::text::shown;
use rocking::GroundMotion;
use rocking::pattern::{ModeLabel, Pattern, modes};
use rocking_codegen::Plan;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;

/// A mode as it is listed.
#[derive(Debug, Serialize)]
pub struct Row {
    mode: String,
    /// Signs of the interfaces, base first.
    pattern: String,
    /// Free angles.
    dof: usize,
    /// The step-time program of all modes with as many free angles.
    program: String,
    /// Floating-point operations of one evaluation of the accelerations under horizontal ground motion.
    flops: usize,
    /// Among the flops.
    divisions: usize,
    drawing: String,
}

/// The independent modes of a column, in the order of their labels.
pub fn rows(blocks: usize) -> Vec<Row> {
    // One step-time program per number of free angles: all modes that have as many share its operations.
    let operations: Vec<_> = (1..=blocks).map(|dof| Plan::new(dof).operations(GroundMotion::Horizontal)).collect();
    let row = |(label, pattern): (ModeLabel, Pattern)| {
        let dof = pattern.dof();
        Row {
            mode: label.to_string(),
            pattern: pattern.to_string(),
            dof,
            program: format!("Dof{dof}"),
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
    let mut text = format!("{:<9} {:<width$}  dof  program  flops  divisions  drawing\n", "mode", "pattern");
    for Row { mode, pattern, dof, program, flops, divisions, drawing } in rows(blocks) {
        let _ = writeln!(
            text,
            "{mode:<9} {pattern:<width$}  {dof:<3}  {program:<7}  {flops:<5}  {divisions:<9}  {drawing}"
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

/// The output of `rocking derive`.
pub enum Asked {
    /// The equations, in a format.
    Derivation(Format),
    /// Operation counts.
    Counts,
}

/// The derivation or the operation counts of a mode, as text.
pub fn derive(blocks: usize, mode: &str, asked: Asked) -> Result<String, Failure> {
    let pattern = ModeLabel::parse(mode).and_then(|label| label.pattern(blocks));
    let pattern = pattern.ok_or_else(|| Failure::Mode(mode.into(), blocks))?;
    Ok(match asked {
        Asked::Counts => rocking_codegen::report::counts(&pattern),
        Asked::Derivation(Format::Text) => rocking_codegen::report::text(&pattern),
        Asked::Derivation(Format::Rust) => rocking_codegen::report::rust(&pattern),
        Asked::Derivation(Format::Latex) => rocking_codegen::report::latex(&pattern),
    })
}
