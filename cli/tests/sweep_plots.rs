//! Figures of sweeps: every cell shows what the table says, and what cannot be drawn is refused before anything is run.

use crate::common::figures::{parts, words};
use crate::common::{Folder, Row, Table, assert_has, project_text, root};
use roxmltree::Document;
use std::collections::{BTreeMap, BTreeSet};

const SCENE: &str = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.56\n[restitution]\neta = 0.9\n\
    [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_uplift = 3.0\nomega_p = 5.0\n\
    [solver]\nt_end = 10.0\nrtol = 1e-6\n";

/// Two panels of 12 by 12 cells.
const AXES: &str = "blocks = [1, 2]\nomega_p = { from = 1.0, to = 8.0, steps = 12 }\n\
    amplitude_uplift = { from = 0.5, to = 12.0, steps = 12 }\n";

/// The axis of amplitudes as tables have it.
const AMPLITUDE: &str = "excitation.horizontal.amplitude_uplift";

/// Fills of the cells, and the classes that a table tells apart.
const FILLS: [(&str, &str); 7] = [
    ("#ffffff", "no-uplift"),
    ("#cfdde9", "rocks"),
    ("#e6a52c", "overturns 3"),
    ("#dd6a12", "overturns 2"),
    ("#0065a0", "overturns 1"),
    ("#1f1b2e", "overturns 0"),
    ("#f3d6e4", "error"),
];

/// A folder with a base scene and a sweep over these axes.
fn folder_with(axes: &str) -> Folder {
    let folder = Folder::with("base.toml", SCENE);
    let (above, axes) = axes.split_once("[axes]\n").unwrap_or(("", axes));
    folder.write("sweep.toml", format!("scene = \"base.toml\"\n{above}[axes]\n{axes}"));
    folder
}

/// As [`FILLS`] has it.
fn class(row: Row) -> String {
    match row.text("outcome") {
        "overturns" => format!("overturns {}", row.text("impacts").parse::<usize>().expect("a number").min(3)),
        outcome => outcome.into(),
    }
}

fn contains(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let ends = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let crosses = |(a, b): &(&[f64; 2], &[f64; 2])| {
        (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    };
    ends.filter(crosses).count() % 2 == 1
}

/// What a figure shows at the middle of each cell, a panel after the other from the left, columns of cells from the left, each
/// from the bottom: the fill painted last.
fn shown(figure: &str, panels: usize, columns: usize, rows: usize) -> Vec<Vec<String>> {
    let document = Document::parse(figure).expect("XML");
    let drawn = document.descendants().filter(|node| node.has_tag_name("path"));
    let paths: Vec<_> = drawn
        .map(|node| {
            let attribute = |name: &str| node.attribute(name).unwrap_or_default();
            (parts(attribute("d")), attribute("fill"), attribute("stroke"))
        })
        .collect();
    // Frames are the largest rectangles that are only lines; those of the legend are small.
    let frames = paths.iter().filter(|(parts, _, stroke)| *stroke == "#222222" && parts[0].len() == 5);
    let frames: Vec<_> =
        frames.map(|(parts, ..)| parts[0].clone()).filter(|frame| frame[1][0] - frame[0][0] > 50.0).collect();
    assert_eq!(frames.len(), panels);
    let cell = |frame: &[[f64; 2]], column: usize, row: usize| {
        let [[left, top], _, [right, bottom]] = [frame[0], frame[1], frame[2]];
        let along =
            |from: f64, to: f64, place: usize, count: usize| from + (to - from) * (place as f64 + 0.5) / count as f64;
        let at = [along(left, right, column, columns), along(bottom, top, row, rows)];
        let painted = paths.iter().rev().find(|(parts, fill, _)| {
            fill.starts_with('#') && parts.iter().any(|polygon| polygon.len() > 3 && contains(polygon, at))
        });
        let fill = painted.map(|(_, fill, _)| *fill).expect("something is painted");
        FILLS.iter().find(|(known, _)| *known == fill).map(|(_, class)| class.to_string()).expect("a known fill")
    };
    let panel = |frame: &Vec<[f64; 2]>| {
        (0..columns)
            .flat_map(|column| (0..rows).map(move |row| (column, row)))
            .map(|(x, y)| cell(frame, x, y))
            .collect()
    };
    frames.iter().map(panel).collect()
}

/// Curves and a plane of harmonic motion that goes on beyond the end of the run.
#[test]
fn captions_count_the_runs_that_end_before_the_ground() {
    let folder = folder_with("ask = \"peaks\"\n[axes]\namplitude_uplift = [0.5, 1.1, 1.2]\n");
    let scene = SCENE.replace("sine-pulse", "harmonic").replace("t_end = 10.0", "t_end = 1.0");
    folder.write("base.toml", scene);
    let told = folder.succeeds("sweep sweep.toml --plot f.svg");
    assert!(told.contains(" 3 of 3 runs are cut at solver.t_end: the ground still moves there, the column"), "{told}");
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\nomega_p = [4.0, 5.0]\namplitude_uplift = [0.5, 1.1]\n");
    let told = folder.succeeds("sweep sweep.toml --plot f.svg");
    assert_eq!(told.matches("4 of 4 runs are cut at solver.t_end").count(), 2, "{told}");
}

#[test]
fn every_cell_shows_what_the_table_says() {
    let folder = folder_with(AXES);
    let told = folder.succeeds("sweep sweep.toml --out t.csv --plot f.svg");
    assert_has(&told, &["wrote f.svg: Overturning spectrum", "wrote f-minimum.svg: Least"]);
    let (table, figure) = (folder.table("t.csv"), folder.read("f.svg"));
    let wanted: Vec<String> = table.rows().map(class).collect();
    let kinds: BTreeSet<&String> = wanted.iter().collect();
    assert!(kinds.len() >= 5, "{kinds:?}");
    assert_eq!(shown(&figure, 2, 12, 12).concat(), wanted);

    let words = words(&figure);
    for word in ["1 block", "2 blocks", "Ω / p", "a / (g tan α)", "least that overturns"] {
        assert!(words.contains(&word.into()), "{word} is not in {words:?}");
    }
    let standing = 100.0 * wanted.iter().filter(|class| *class == "rocks").count() as f64 / wanted.len() as f64;
    assert!(words.contains(&format!("rocks and stands, {standing:.0} %")), "{words:?}");
}

#[test]
fn signs_that_xml_does_not_know_are_written_as_escapes() {
    let folder = folder_with("title = [\"a\\u0001b<\", \"c\"]\nomega_p = [1.0, 2.0]\namplitude_uplift = [0.5, 2.0]\n");
    folder.succeeds("sweep sweep.toml --plot f.svg");
    let figure = folder.read("f.svg");
    let document = Document::parse(&figure).expect("XML");
    assert!(document.descendants().any(|node| node.text() == Some("title = a\\u{1}b<")), "{figure}");
}

#[test]
fn points_without_result_are_hatched() {
    // Half-widths below zero are no column.
    let folder = folder_with("half_width = [-0.2, 0.2, 0.4]\namplitude_uplift = [0.5, 2.0, 8.0]\n");
    folder.succeeds("sweep sweep.toml --plot f.svg");
    let (figure, table) = (folder.read("f.svg"), folder.read("sweep.csv"));
    let cells = &shown(&figure, 1, 3, 3)[0];
    assert!(
        cells[..3].iter().all(|class| class == "error") && cells[3..].iter().all(|class| class != "error"),
        "{table}"
    );
    // Cells reach half way to their neighbours: from -0.4 to 0 of -0.4 to 0.5.
    assert!(figure.contains("no result (hatched), 44 %"));
    // Shares are of the runs that have one: 3 of 6 overturn, in cells of other sizes.
    assert!(figure.contains("3 of 9 runs have no result and are left out."), "{figure}");
    let least = folder.read("f-minimum.svg");
    assert!(least.contains("no run overturns up to the end of the axis. 3 of 9 runs have no result"), "{least}");
}

#[test]
fn figures_are_the_same_whenever_they_are_drawn_and_come_as_pixels_too() {
    let folder = folder_with(AXES);
    folder.succeeds("sweep sweep.toml --out t.csv --plot first.svg --quiet");
    let told = folder.succeeds("plot t.csv");
    assert_has(&told, &["wrote t.svg: ", "wrote t-minimum.svg: "]);
    folder.succeeds("plot t.csv --format png --out pixels");
    folder.succeeds("sweep sweep.toml --out t.csv --plot again.PNG --quiet");
    for (first, later) in [("first.svg", "t.svg"), ("first-minimum.svg", "t-minimum.svg")] {
        assert_eq!(folder.read(first), folder.read(later));
    }
    for (first, later) in [("pixels/t.png", "again.PNG"), ("pixels/t-minimum.png", "again-minimum.PNG")] {
        let [first, later] = [first, later].map(|name| folder.bytes(name));
        assert!(first == later && first.starts_with(b"\x89PNG\r\n\x1a\n"));
    }
}

#[test]
fn shards_are_merged_before_they_are_drawn() {
    let folder = folder_with(AXES);
    folder.refused("sweep sweep.toml --shard 1/2 --plot f.svg", &["rocking merge"]);
    folder.succeeds("sweep sweep.toml --out t.csv --plot whole.svg");
    for shard in 1..=3 {
        folder.succeeds(&format!("sweep sweep.toml --shard {shard}/3 --out {shard}.csv"));
    }
    folder.refused("plot 2.csv", &["rocking merge"]);
    folder.succeeds("merge merged.csv 3.csv 1.csv 2.csv");
    folder.succeeds("plot merged.csv");
    assert_eq!(folder.read("whole.svg"), folder.read("merged.svg"));
}

#[test]
fn what_cannot_be_drawn_is_refused_before_it_is_run() {
    let cases = [
        ("omega_p = [1.0]\namplitude_uplift = [3.0]\n", "no axis with numbers has several values"),
        (
            "combine = \"paired\"\n[axes]\nomega_p = [1.0, 2.0, 1.0]\namplitude_uplift = [3.0, 4.0, 4.0]\n",
            "have each value once",
        ),
        ("omega_p = [1.0, 2.0]\namplitude_g = [0.0, 1e-320]\n", "cannot be drawn"),
        ("omega_p = [1.0, 2.0]\namplitude = [-1e308, 1e308]\n", "cannot be drawn"),
        ("omega_p = [1.0, 2.0]\namplitude = [-0.0, 0.0, 1.0]\n", "have each value once"),
        ("density = { from = 1, to = 17 }\nomega_p = [1.0, 2.0]\namplitude_uplift = [3.0, 4.0]\n", "17 panels"),
    ];
    for (axes, said) in cases {
        let folder = folder_with(axes);
        folder.refused("sweep sweep.toml --plot f.svg", &[said]);
        assert_eq!(folder.names(""), ["base.toml", "sweep.toml"], "nothing is written");
    }
    let folder = folder_with("omega_p = [1.0, 2.0]\namplitude_uplift = [3.0, 4.0]\n");
    folder.succeeds("sweep sweep.toml --out t.svg");
    folder.refused("plot t.svg", &["reads this file"]);
    assert!(folder.read("t.svg").starts_with("index,"), "the table is as it was");
    let folder = folder_with("kind = [\"sine-pulse\", \"ricker\"]\n");
    for picture in ["f", "f.jpg"] {
        folder.refused(&format!("sweep sweep.toml --plot {picture}"), &[".svg"]);
    }
    folder.succeeds("sweep sweep.toml");
    for (file, said) in [
        ("sweep.csv", "no axis with numbers"),
        ("sweep.toml", "give the table that `rocking sweep` wrote"),
        ("missing.csv", "missing.csv: "),
    ] {
        folder.refused(&format!("plot {file}"), &[said]);
    }
}

/// The outcome changes at these amplitudes of a sweep over them.
fn changes(table: &Table) -> Vec<(String, f64)> {
    let mut changes: Vec<(String, f64)> = Vec::new();
    for row in table.rows() {
        if changes.last().is_none_or(|(last, _)| *last != class(row)) {
            changes.push((class(row), row.number(AMPLITUDE)));
        }
    }
    changes
}

/// The thresholds of the slender linear block at Ω/p = 5, η = 0.9 in αg: 3.0186, 6.3181 and 7.1681. At α = 1e-3 those of the
/// nonlinear block differ by 1e-4; amplitudes are 0.01 apart.
#[test]
fn validation_a_slender_block_overturns_where_zhang_and_makris_2001_have_it() {
    let axes = "half_width = [0.00156]\nomega_p = [5.0]\namplitude_uplift = { from = 2.0, to = 8.0, steps = 601 }\n";
    let folder = folder_with(axes);
    folder.succeeds("sweep sweep.toml --out t.csv");
    let found = changes(&folder.table("t.csv"));
    let wanted = [("rocks", 2.0), ("overturns 1", 3.02), ("rocks", 6.32), ("overturns 0", 7.17)];
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for ((class, from), (wanted_class, wanted_from)) in found.iter().zip(wanted) {
        assert!(class == wanted_class && (from - wanted_from).abs() < 1e-9, "{found:?}");
    }
}

/// A column of the figure in the README: the same scene and amplitudes at Ω/p = 5.
#[test]
fn the_spectrum_of_the_readme_is_what_its_sweep_says() {
    let readme = project_text("README.md");
    assert!(readme.contains("rocking sweep scenes/sweeps/overturning-spectrum.toml"));
    let base = root().join("scenes/sweeps/column.toml").canonicalize().expect("it is there");
    let sweep = format!(
        "scene = {base:?}\n[axes]\nblocks = [1, 2, 3, 5]\nomega_p = [5.0, 8.0]\n\
         amplitude_uplift = {{ from = 0.5, to = 16.0, steps = 311 }}\n"
    );
    let folder = Folder::with("sweep.toml", &sweep);
    folder.succeeds("sweep sweep.toml --out t.csv --plot f.svg");
    let table = folder.table("t.csv");
    let mut least: BTreeMap<[&str; 2], f64> = BTreeMap::new();
    for row in table.rows().filter(|row| row.text("outcome") == "overturns") {
        let place = ["excitation.horizontal.omega_p", "column.blocks"].map(|name| row.text(name));
        least.entry(place).or_insert_with(|| row.number(AMPLITUDE));
    }
    let found: Vec<f64> = least.into_values().collect();
    let wanted = [3.0, 3.0, 6.6, 6.7, 15.6, 11.95, 12.0, 12.0];
    assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-9), "{found:?}");

    let titles = |figure: &str| -> Vec<String> {
        words(figure).into_iter().filter(|text| text.contains("block") || text.contains("/")).collect()
    };
    for (shown, drawn) in [("overturning-spectrum", "f"), ("overturning-spectrum-minimum", "f-minimum")] {
        let shown = project_text(&format!("docs/{shown}.svg"));
        assert!(shown.len() < 400_000);
        assert_eq!(titles(&shown), titles(&folder.read(&format!("{drawn}.svg"))));
    }
}

/// Two squat drums, the upper one displaced: where they are shaken long enough the upper one slides off, and nothing overturns.
#[test]
fn collapses_count_as_lost() {
    let scene = "[friction]\nstatic = [0.7, 0.3]\n[column]\nblocks = 2\nhalf_width = 0.3\nhalf_height = 0.6\n[initial]\nslide = [0.0, 0.2]\n\
        [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_g = 0.5\nperiod = 1.0\n";
    let folder = Folder::with("base.toml", scene);
    folder.write(
        "sweep.toml",
        "scene = \"base.toml\"\n[axes]\nperiod = [1.4, 1.5, 1.6]\namplitude_g = [0.4, 0.8, 1.2, 1.6]\n",
    );
    folder.succeeds("sweep sweep.toml --out t.csv --plot f.svg");
    let table = folder.table("t.csv");
    let rows: Vec<Row> = table.rows().collect();
    let lost = rows.iter().filter(|row| ["collapses", "overturns"].contains(&row.text("outcome"))).count();
    let collapsed = rows.iter().filter(|row| row.text("outcome") == "collapses").count();
    assert!(collapsed > 0 && lost < rows.len(), "{collapsed} and {lost} of {}", rows.len());
    let share = format!("overturns or collapses: {:.0} %", 100.0 * lost as f64 / rows.len() as f64);
    assert_has(&folder.read("f.svg"), &[&share, "least that overturns or collapses"]);
    assert_has(&folder.read("f-minimum.svg"), &["Least values that overturn or collapse"]);
}
