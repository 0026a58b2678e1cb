//! `rocking modes` and `rocking derive`: what the generator knows of a column's modes.

use crate::arguments::Format;
use crate::commands::print;
use crate::error::Failure;
use crate::{figure, output};
use rocking::GroundMotion;
use rocking::pattern::{ModeLabel, modes};
use rocking_codegen::Plan;
use std::fmt::Write as _;
use std::path::Path;

/// One line per mode. The drawing comes last: it alone has blanks, and a line is often split at them.
pub fn list_modes(blocks: usize) -> String {
    // One step-time program per number of free angles: all modes that have as many share its operations.
    let operations: Vec<_> = (1..=blocks).map(|dof| Plan::new(dof).operations(GroundMotion::Horizontal)).collect();
    let width = (2 * blocks + 1).max("pattern".len());
    let mut text = format!("{:<9} {:<width$}  dof  program  flops  divisions  drawing\n", "mode", "pattern");
    for (label, pattern) in modes(blocks) {
        let dof = pattern.dof();
        let operations = &operations[dof - 1];
        let _ = writeln!(
            text,
            "{:<9} {:<width$}  {dof:<3}  {:<7}  {:<5}  {:<9}  {}",
            label.to_string(),
            pattern.to_string(),
            format!("Dof{dof}"),
            operations.flops(),
            operations.divisions,
            figure::line(&pattern)
        );
    }
    let _ = write!(
        text,
        "{} independent mode(s) of {blocks} block(s), interfaces base first; mirror images are the same modes.\n\
         dof: free angles; program: the step-time program of all modes with as many; flops, divisions: of one call of its accelerations, ground moving horizontally.\n\
         drawing: {}\n",
        mode_count(blocks),
        figure::LINE_KEY
    );
    text
}

fn mode_count(blocks: usize) -> u64 {
    (3u64.pow(blocks as u32) - 1) / 2
}

/// Draws the modes into a file.
///
/// # Errors
/// [`Failure::CrowdedFigure`], [`Failure::Figure`]
pub fn draw_modes(blocks: usize, file: &Path) -> Result<(), Failure> {
    let modes = mode_count(blocks);
    if blocks > figure::LARGEST {
        return Err(Failure::CrowdedFigure { blocks, modes, largest: figure::LARGEST });
    }
    output::figure(file, &figure::svg(blocks))?;
    print(&format!("wrote {modes} mode(s) of {blocks} block(s) to {}\n", file.display()))
}

/// What is printed of a mode.
pub enum Printed {
    /// The equations, in a format.
    Derivation(Format),
    /// Operation counts.
    Counts,
}

/// What was asked of a mode, as text.
///
/// # Errors
/// [`Failure::Mode`]
pub fn derive(blocks: usize, mode: &str, printed: Printed) -> Result<String, Failure> {
    let pattern = ModeLabel::parse(mode).and_then(|label| label.pattern(blocks));
    let pattern = pattern.ok_or_else(|| Failure::Mode { mode: mode.into(), blocks })?;
    Ok(match printed {
        Printed::Counts => rocking_codegen::report::counts(&pattern),
        Printed::Derivation(Format::Text) => rocking_codegen::report::text(&pattern),
        Printed::Derivation(Format::Rust) => rocking_codegen::report::rust(&pattern),
        Printed::Derivation(Format::Latex) => rocking_codegen::report::latex(&pattern),
    })
}
