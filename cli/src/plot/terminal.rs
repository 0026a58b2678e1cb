//! An accelerogram as text: dots of Braille, for a glance where no picture can be shown.

/// Cells across and down; a cell has two dots across and four down.
const COLUMNS: usize = 72;
const ROWS: usize = 8;

/// Bits of a cell's dots, `[column][row]` (Unicode, block Braille Patterns).
const DOTS: [[u32; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// The whole series. Each column of dots reaches from the smallest to the largest value within it; zero is in the middle.
/// The last line has no line break. Empty for a series of zeros, or of fewer than two samples.
pub fn series(values: &[f64]) -> String {
    let peak = values.iter().fold(0.0f64, |peak, value| peak.max(value.abs()));
    if peak == 0.0 || values.len() < 2 {
        return String::new();
    }
    let (across, down) = (2 * COLUMNS, 4 * ROWS);
    let dot = |value: f64| ((1.0 - value / peak) * 0.5 * (down - 1) as f64).round() as usize;
    let mut cells = [[0u32; COLUMNS]; ROWS];
    for column in 0..across {
        let at = |edge: usize| (edge * (values.len() - 1) + across / 2) / across;
        let inside = &values[at(column)..=at(column + 1).max(at(column))];
        let (least, largest) =
            inside.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(*value), b.max(*value)));
        for row in dot(largest)..=dot(least) {
            cells[row / 4][column / 2] |= DOTS[column % 2][row % 4];
        }
    }
    let line =
        |cells: &[u32; COLUMNS]| -> String { cells.iter().filter_map(|dots| char::from_u32(0x2800 + dots)).collect() };
    cells.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crests_reach_the_edges_and_silence_is_the_middle() {
        let mut values = vec![0.0; 1000];
        values[100] = 2.0;
        values[900] = -2.0;
        let drawn = series(&values);
        let rows: Vec<Vec<char>> = drawn.lines().map(|line| line.chars().collect()).collect();
        assert_eq!((rows.len(), rows[0].len()), (ROWS, COLUMNS));
        let filled = |row: usize| rows[row].iter().filter(|cell| **cell != '\u{2800}').count();
        assert_eq!((filled(0), filled(ROWS - 1)), (1, 1));
        assert!((0..ROWS).map(filled).max() == Some(COLUMNS));
        assert_eq!(series(&[0.0; 5]), "");
    }
}
