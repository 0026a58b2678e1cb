//! `rocking modes`: the table, the drawings in it, and the figure.

use crate::common::figures::words;
use crate::common::{Folder, project_text};
use std::collections::{BTreeSet, HashMap};

/// Lines of the table without its heading, for a column of this many blocks.
fn table(blocks: usize) -> Vec<String> {
    let text = Folder::new().succeeds(&format!("modes --blocks {blocks}"));
    let rows = (3usize.pow(blocks as u32) - 1) / 2;
    let lines: Vec<String> = text.lines().map(String::from).collect();
    assert!(lines[rows + 1].starts_with(&format!("{rows} independent mode(s) of {blocks} block(s)")), "{text}");
    lines[1..=rows].to_vec()
}

/// Pattern to drawing.
fn drawings(blocks: usize) -> HashMap<String, String> {
    let row = |line: String| {
        let fields: Vec<&str> = line.split_whitespace().collect();
        (fields[1].to_string(), fields[6..].join(" "))
    };
    table(blocks).into_iter().map(row).collect()
}

#[test]
fn the_table_has_every_independent_mode_once_in_the_order_of_labels() {
    for blocks in 1..=4 {
        let mut labels = Vec::new();
        for lowest in 1..=blocks {
            labels.extend((1..=3usize.pow((blocks - lowest) as u32)).map(|number| format!("{lowest}.{number}")));
        }
        let rows = table(blocks);
        let listed: Vec<&str> = rows.iter().filter_map(|row| row.split_whitespace().next()).collect();
        assert_eq!(listed, labels);
    }
}

#[test]
fn columns_of_the_table_tell_pattern_free_angles_program_and_operations() {
    let expected = [
        (["2.2", "(0,+,0)", "1", "HorizontalDof1"], "| /=/."),
        (["1.6", "(+,0,-)", "2", "HorizontalDof2"], "/=/. .|"),
        (["1.9", "(+,-,-)", "3", "HorizontalDof3"], "/. .| .\\"),
    ];
    for (columns, drawing) in expected {
        let row = table(3).into_iter().find(|row| row.starts_with(columns[0])).expect("the mode is listed");
        let fields: Vec<&str> = row.split_whitespace().collect();
        assert_eq!(fields[..4], columns, "{row}");
        assert!(row.ends_with(&format!("  {drawing}")), "{row}");
        let derivation = Folder::new().succeeds(&["derive", "--blocks", "3", "--mode", columns[0]]);
        let acceleration = derivation.lines().find(|line| line.contains("`acceleration`")).expect("in the program");
        assert!(acceleration.contains(&format!("{} flops", fields[4])), "{row}\n{acceleration}");
        assert!(acceleration.contains(&format!("), {} division", fields[5])), "{row}\n{acceleration}");
    }
}

/// By hand: blocks of one rigid group are joined, the dot is at the right of a group that pivots on its right corner and at the
/// left of one that pivots on its left, and a group leans as the signs below it and its own add up.
#[test]
fn drawings_show_groups_leans_and_pivots() {
    let by_hand = [
        ("(+)", "/."),
        ("(+,-)", "/. .|"),
        ("(+,+)", "/. /."),
        ("(+,0)", "/=/."),
        ("(0,+)", "| /."),
        ("(+,0,0)", "/=/=/."),
        ("(+,0,-)", "/=/. .|"),
        ("(+,-,0)", "/. .|=|"),
        ("(+,-,+)", "/. .| /."),
        ("(+,+,-)", "/. /. ./"),
        ("(0,0,+)", "|=| /."),
        ("(+,-,-,0)", "/. .| .\\=\\"),
        ("(+,-,-,+)", "/. .| .\\ |."),
        ("(0,+,-,-)", "| /. .| .\\"),
    ];
    for (pattern, drawing) in by_hand {
        let blocks = pattern.matches(['+', '0', '-']).count();
        assert_eq!(drawings(blocks)[pattern], drawing, "{pattern}");
    }
}

#[test]
fn no_two_modes_have_the_same_drawing() {
    for blocks in 1..=5 {
        let drawings = drawings(blocks);
        let distinct: BTreeSet<&String> = drawings.values().collect();
        assert_eq!(distinct.len(), drawings.len());
    }
}

#[test]
fn the_figure_of_the_readme_is_what_its_command_writes() {
    let folder = Folder::new();
    let text = folder.succeeds("modes --blocks 3 --svg modes-3.svg");
    assert_eq!(text, "wrote 13 mode(s) of 3 block(s) to modes-3.svg\n");
    let [written, committed] = [folder.read("modes-3.svg"), project_text("docs/modes-3.svg")];
    assert!(words(&written) == words(&committed), "renew it: rocking modes --blocks 3 --svg docs/modes-3.svg");
}

/// Pivots are the figure's only circles, one of them in the legend; a rigid group is a filled path.
#[test]
fn a_figure_has_every_mode_with_its_groups_and_pivots() {
    let folder = Folder::new();
    for blocks in 1..=5 {
        folder.succeeds(&format!("modes --blocks {blocks} --svg modes.svg"));
        let figure = folder.read("modes.svg");
        for (label, pattern) in rocking::pattern::modes(blocks) {
            let angles = if pattern.dof() == 1 { "angle" } else { "angles" };
            let title = format!("<title>mode {label} {pattern}, {} free {angles}</title>", pattern.dof());
            let (_, rest) = figure.split_once(&title).unwrap_or_else(|| panic!("no `{title}`"));
            let (mode, _) = rest.split_once("</g>").expect("closed");
            let on_the_ground = usize::from(pattern.lowest_open() != Some(0));
            assert_eq!(mode.matches("<circle").count(), pattern.dof(), "{title}");
            assert_eq!(
                mode.matches("fill=\"#").count(),
                2 * pattern.dof() + on_the_ground,
                "pivots and groups of {title}"
            );
            assert!(mode.contains(&format!(">{label}<")), "{title}");
        }
        assert_eq!(figure.matches("<title>mode ").count(), (3usize.pow(blocks as u32) - 1) / 2);
        assert!(!figure.contains("NaN") && !figure.contains("inf"));
    }
}

#[test]
fn a_figure_that_nobody_could_read_is_refused() {
    let folder = Folder::new();
    folder.refused("modes --blocks 6 --svg modes.svg", &["364 modes", "up to 5 blocks"]);
    assert_eq!(folder.names(""), [""; 0], "nothing is written");
}

#[test]
fn a_figure_that_cannot_be_put_in_place_leaves_nothing() {
    let folder = Folder::new();
    folder.make_folder("taken.svg");
    for file in ["taken.svg", "no/such/folder.svg"] {
        folder.refused(&format!("modes --blocks 2 --svg {file}"), &[file, "choose a file"]);
    }
    assert_eq!(folder.names(""), ["taken.svg"], "no temporary file is left");
}

#[test]
fn a_figure_of_modes_has_the_format_of_its_name() {
    let folder = Folder::new();
    folder.succeeds("modes --blocks 2 --svg m.png");
    assert!(folder.bytes("m.png").starts_with(b"\x89PNG\r\n\x1a\n"));
    folder.succeeds("modes --blocks 2 --svg m.SVG");
    assert!(folder.read("m.SVG").starts_with("<svg"));
    folder.refused("modes --blocks 2 --svg m.jpg", &[".svg"]);
}
