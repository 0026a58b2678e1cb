//! Styles of lines and areas: distinct for the colour-blind, in grey print, and where curves lie on one another.
//!
//! Colours are Okabe and Ito's (2008). Each line has dashes of its own, and later lines are thinner: where a later line covers an
//! earlier one, the earlier line shows on both sides of it and through the gaps between its dashes.

/// Text, frames and ticks.
pub const INK: &str = "#222222";
/// Reference lines, and lines at zero.
pub const GREY: &str = "#777777";
/// Grid.
pub const FAINT: &str = "#e4e4e4";
/// The ground.
pub const GROUND: &str = "#000000";
/// Jumps at impacts.
pub const IMPACT: &str = "#d55e00";

/// Labels of axes, titles of panels `[px]`: 14 px are 8 pt if a sheet of 720 px is printed 15 cm wide.
pub const LABEL: u32 = 14;
/// Numbers at ticks `[px]`.
pub const NUMBER: u32 = 13;
/// Legends and notes `[px]`.
pub const NOTE: u32 = 13;

/// Look of a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Colour in the notation of SVG.
    pub color: &'static str,
    /// `[px]`
    pub width: f64,
    /// Lengths of dashes and gaps in turn `[px]`; none for a solid line.
    pub dashes: &'static [f64],
}

impl Stroke {
    /// A solid line.
    pub const fn solid(color: &'static str, width: f64) -> Stroke {
        Stroke { color, width, dashes: &[] }
    }

    /// A dashed line.
    pub const fn dashed(color: &'static str, width: f64, dashes: &'static [f64]) -> Stroke {
        Stroke { color, width, dashes }
    }
}

/// Line of a reference value: slenderness, weight, uplift amplitude.
pub const REFERENCE: Stroke = Stroke::dashed(GREY, 1.2, &[5.0, 4.0]);
/// Ticks and thin marks.
pub const THIN: Stroke = Stroke::solid(INK, 0.9);

/// Lines of the first seven blocks or interfaces, base first.
const LINES: [Stroke; 7] = [
    Stroke::solid("#0072b2", 2.6),
    Stroke::dashed("#d55e00", 2.1, &[8.0, 5.0]),
    Stroke::dashed("#000000", 1.8, &[1.5, 5.0]),
    Stroke::dashed("#009e73", 1.7, &[9.0, 4.5, 1.5, 4.5]),
    Stroke::dashed("#cc79a7", 1.6, &[15.0, 5.0]),
    Stroke::dashed("#e69f00", 1.5, &[4.5, 4.5]),
    Stroke::dashed("#56b4e9", 1.4, &[9.0, 4.0, 1.5, 4.0, 1.5, 4.0]),
];

/// The line of a block, interface or curve, from zero. Beyond the seventh, colours come again with the dashes of their neighbours: 49 lines are distinct.
pub fn line(index: usize) -> Stroke {
    let dashes = LINES[(index + index / LINES.len()) % LINES.len()].dashes;
    Stroke { dashes, ..LINES[index % LINES.len()].clone() }
}

/// Fills of modes, the mode that lasts longest first. Okabe and Ito's colours at 60 % on white, so that dark text on them is legible.
const FILLS: [&str; 7] = ["#9ad2f2", "#f0c566", "#66c5ab", "#e0afca", "#e69e66", "#f6ef8e", "#66aad1"];
/// Fill of the modes without a fill of their own.
pub const OTHER_FILL: &str = "#c4c4c4";
/// Fill of the mode `rest`; the white of the paper.
pub const REST_FILL: &str = "#ffffff";

/// Number of modes that get a fill of their own.
pub const NAMED_MODES: usize = FILLS.len();

/// The fill of the mode with this rank by time.
pub fn fill(rank: usize) -> &'static str {
    FILLS.get(rank).copied().unwrap_or(OTHER_FILL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_of_49_lines_look_the_same() {
        let lines: Vec<Stroke> = (0..49).map(line).collect();
        for (place, line) in lines.iter().enumerate() {
            assert!(!lines[..place].contains(line), "{place}: {line:?}");
        }
    }
}
