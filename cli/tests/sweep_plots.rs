//! Figures of sweeps: every cell shows what the table says, and what cannot be drawn is refused before anything is run.

mod common;

use roxmltree::Document;
use std::collections::BTreeMap;
use std::path::Path;

const SCENE: &str = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.56\n[restitution]\neta = 0.9\n\
    [excitation.horizontal]\nkind = \"sine-pulse\"\namplitude_uplift = 3.0\nomega_p = 5.0\n\
    [solver]\nt_end = 10.0\nrtol = 1e-6\n";

/// Two panels of 12 by 12 cells.
const AXES: &str = "blocks = [1, 2]\nomega_p = { from = 1.0, to = 8.0, steps = 12 }\n\
    amplitude_uplift = { from = 0.5, to = 12.0, steps = 12 }\n";

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
fn folder_with(axes: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("base.toml"), SCENE).expect("written");
    let (above, axes) = axes.split_once("[axes]\n").unwrap_or(("", axes));
    let text = format!("scene = \"base.toml\"\n{above}[axes]\n{axes}");
    std::fs::write(folder.path().join("sweep.toml"), text).expect("written");
    folder
}

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).expect("written")
}

/// Rows of a table: index, values of the axes, outcome, impacts, ...
fn rows(table: &str) -> Vec<Vec<&str>> {
    table.lines().skip(1).map(|line| line.split(',').collect()).collect()
}

/// As [`FILLS`] has it.
fn class(outcome: &str, impacts: &str) -> String {
    match outcome {
        "overturns" => format!("overturns {}", impacts.parse::<usize>().expect("a number").min(3)),
        _ => outcome.into(),
    }
}

/// The parts of a path: where each begins and the corners that follow.
fn parts(path: &str) -> Vec<Vec<[f64; 2]>> {
    let point = |text: &str| {
        let numbers: Vec<f64> = text.split_whitespace().map(|number| number.parse().expect("a number")).collect();
        [numbers[0], numbers[1]]
    };
    let parts = path.split('M').filter(|part| !part.is_empty());
    parts.map(|part| part.trim_end_matches('Z').split('L').map(point).collect()).collect()
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
    std::fs::write(folder.path().join("base.toml"), scene).expect("written");
    let told = common::succeeds(folder.path(), &["sweep", "sweep.toml", "--plot", "f.svg"]);
    assert!(told.contains(" 3 of 3 runs are cut at solver.t_end: the ground still moves there, or"), "{told}");
    let plane = "scene = \"base.toml\"\n[axes]\nomega_p = [4.0, 5.0]\namplitude_uplift = [0.5, 1.1]\n";
    std::fs::write(folder.path().join("sweep.toml"), plane).expect("written");
    let told = common::succeeds(folder.path(), &["sweep", "sweep.toml", "--plot", "f.svg"]);
    assert_eq!(told.matches("4 of 4 runs are cut at solver.t_end").count(), 2, "{told}");
}

#[test]
fn every_cell_shows_what_the_table_says() {
    let folder = folder_with(AXES);
    let told = common::succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv", "--plot", "f.svg"]);
    assert!(
        told.contains("wrote f.svg: Overturning spectrum") && told.contains("wrote f-minimum.svg: Least"),
        "{told}"
    );
    let (table, figure) = (read(folder.path(), "t.csv"), read(folder.path(), "f.svg"));
    let table = rows(&table);
    let wanted: Vec<String> = table.iter().map(|row| class(row[4], row[5])).collect();
    let kinds: std::collections::BTreeSet<&String> = wanted.iter().collect();
    assert!(kinds.len() >= 5, "{kinds:?}");
    assert_eq!(shown(&figure, 2, 12, 12).concat(), wanted);

    let document = Document::parse(&figure).expect("XML");
    let words: Vec<&str> =
        document.descendants().filter(|node| node.has_tag_name("text")).filter_map(|node| node.text()).collect();
    for word in ["1 block", "2 blocks", "Ω / p", "a / (g tan α)", "least that overturns"] {
        assert!(words.contains(&word), "{word} is not in {words:?}");
    }
    let standing = 100.0 * wanted.iter().filter(|class| *class == "rocks").count() as f64 / wanted.len() as f64;
    assert!(words.contains(&format!("rocks and stands, {standing:.0} %").as_str()), "{words:?}");
}

#[test]
fn signs_that_xml_does_not_know_are_written_as_escapes() {
    let folder = folder_with("title = [\"a\\u0001b<\", \"c\"]\nomega_p = [1.0, 2.0]\namplitude_uplift = [0.5, 2.0]\n");
    common::succeeds(folder.path(), &["sweep", "sweep.toml", "--plot", "f.svg"]);
    let figure = read(folder.path(), "f.svg");
    let document = Document::parse(&figure).expect("XML");
    assert!(document.descendants().any(|node| node.text() == Some("title = a\\u{1}b<")), "{figure}");
}

#[test]
fn points_without_result_are_hatched() {
    // Half-widths below zero are no column.
    let folder = folder_with("half_width = [-0.2, 0.2, 0.4]\namplitude_uplift = [0.5, 2.0, 8.0]\n");
    common::succeeds(folder.path(), &["sweep", "sweep.toml", "--plot", "f.svg"]);
    let figure = read(folder.path(), "f.svg");
    let table = read(folder.path(), "sweep.csv");
    let cells = &shown(&figure, 1, 3, 3)[0];
    assert!(
        cells[..3].iter().all(|class| class == "error") && cells[3..].iter().all(|class| class != "error"),
        "{table}"
    );
    assert!(figure.contains("no result (hatched), 33 %"));
}

#[test]
fn figures_are_the_same_whenever_they_are_drawn_and_come_as_pixels_too() {
    let folder = folder_with(AXES);
    let path = folder.path();
    common::succeeds(path, &["sweep", "sweep.toml", "--out", "t.csv", "--plot", "first.svg", "--quiet"]);
    let told = common::succeeds(path, &["plot", "t.csv"]);
    assert!(told.contains("wrote t.svg: ") && told.contains("wrote t-minimum.svg: "), "{told}");
    common::succeeds(path, &["plot", "t.csv", "--format", "png", "--out", "pixels"]);
    common::succeeds(path, &["sweep", "sweep.toml", "--out", "t.csv", "--plot", "again.PNG", "--quiet"]);
    for (first, later) in [("first.svg", "t.svg"), ("first-minimum.svg", "t-minimum.svg")] {
        assert_eq!(read(path, first), read(path, later));
    }
    for (first, later) in [("pixels/t.png", "again.PNG"), ("pixels/t-minimum.png", "again-minimum.PNG")] {
        let [first, later] = [first, later].map(|name| std::fs::read(path.join(name)).expect("written"));
        assert!(first == later && first.starts_with(b"\x89PNG\r\n\x1a\n"));
    }
}

#[test]
fn shards_are_merged_before_they_are_drawn() {
    let folder = folder_with(AXES);
    let path = folder.path();
    let output = common::rocking(path, &["sweep", "sweep.toml", "--shard", "1/2", "--plot", "f.svg"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && message.contains("rocking merge"), "{message}");
    common::succeeds(path, &["sweep", "sweep.toml", "--out", "t.csv", "--plot", "whole.svg"]);
    for shard in ["1/3", "2/3", "3/3"] {
        common::succeeds(path, &["sweep", "sweep.toml", "--shard", shard, "--out", &format!("{}.csv", &shard[..1])]);
    }
    let output = common::rocking(path, &["plot", "2.csv"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && message.contains("rocking merge"), "{message}");
    common::succeeds(path, &["merge", "merged.csv", "3.csv", "1.csv", "2.csv"]);
    common::succeeds(path, &["plot", "merged.csv"]);
    assert_eq!(read(path, "whole.svg"), read(path, "merged.svg"));
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
        let output = common::rocking(folder.path(), &["sweep", "sweep.toml", "--plot", "f.svg"]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && message.contains(said), "{message}");
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 2, "nothing is written");
    }
    let folder = folder_with("omega_p = [1.0, 2.0]\namplitude_uplift = [3.0, 4.0]\n");
    common::succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.svg"]);
    let output = common::rocking(folder.path(), &["plot", "t.svg"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.code() == Some(2) && message.contains("reads this file"), "{message}");
    assert!(read(folder.path(), "t.svg").starts_with("index,"), "the table is as it was");
    let folder = folder_with("kind = [\"sine-pulse\", \"ricker\"]\n");
    for picture in ["f", "f.jpg"] {
        let output = common::rocking(folder.path(), &["sweep", "sweep.toml", "--plot", picture]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && message.contains(".svg"), "{message}");
    }
    common::succeeds(folder.path(), &["sweep", "sweep.toml"]);
    for (file, said) in [
        ("sweep.csv", "no axis with numbers"),
        ("sweep.toml", "give the table that `rocking sweep` wrote"),
        ("missing.csv", "missing.csv: "),
    ] {
        let output = common::rocking(folder.path(), &["plot", file]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && message.contains(said), "{message}");
    }
}

/// The outcome changes at these amplitudes of a sweep over them.
fn changes(table: &str, amplitude: usize) -> Vec<(String, f64)> {
    let classes =
        rows(table).into_iter().map(|row| (class(row[amplitude + 1], row[amplitude + 2]), row[amplitude].to_string()));
    let mut changes: Vec<(String, f64)> = Vec::new();
    for (class, value) in classes {
        if changes.last().is_none_or(|(last, _)| *last != class) {
            changes.push((class, value.parse().expect("a number")));
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
    common::succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
    let found = changes(&read(folder.path(), "t.csv"), 3);
    let wanted = [("rocks", 2.0), ("overturns 1", 3.02), ("rocks", 6.32), ("overturns 0", 7.17)];
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for ((class, from), (wanted_class, wanted_from)) in found.iter().zip(wanted) {
        assert!(class == wanted_class && (from - wanted_from).abs() < 1e-9, "{found:?}");
    }
}

/// A column of the figure in the README: the same scene and amplitudes at Ω/p = 5.
#[test]
fn the_spectrum_of_the_readme_is_what_its_sweep_says() {
    let root = common::root();
    let readme = std::fs::read_to_string(root.join("README.md")).expect("it is there");
    assert!(readme.contains("rocking sweep scenes/sweeps/overturning-spectrum.toml"));
    let base = root.join("scenes/sweeps/column.toml").canonicalize().expect("it is there");
    let folder = tempfile::tempdir().expect("a folder");
    let text = format!(
        "scene = {base:?}\n[axes]\nblocks = [1, 2, 3, 5]\nomega_p = [5.0, 8.0]\n\
         amplitude_uplift = {{ from = 0.5, to = 16.0, steps = 311 }}\n"
    );
    std::fs::write(folder.path().join("sweep.toml"), text).expect("written");
    common::succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv", "--plot", "f.svg"]);
    let table = read(folder.path(), "t.csv");
    let mut least: BTreeMap<(&str, &str), f64> = BTreeMap::new();
    for row in rows(&table).into_iter().filter(|row| row[4] == "overturns") {
        least.entry((row[2], row[1])).or_insert_with(|| row[3].parse().expect("a number"));
    }
    let found: Vec<f64> = least.into_values().collect();
    let wanted = [3.0, 3.0, 6.6, 6.7, 15.6, 11.95, 12.0, 12.0];
    assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-9), "{found:?}");

    let titles = |figure: &str| -> Vec<String> {
        let document = Document::parse(figure).expect("XML");
        let texts = document.descendants().filter(|node| node.has_tag_name("text")).filter_map(|node| node.text());
        texts.filter(|text| text.contains("block") || text.contains("/")).map(String::from).collect()
    };
    for (shown, drawn) in [("overturning-spectrum", "f"), ("overturning-spectrum-minimum", "f-minimum")] {
        let shown = std::fs::read_to_string(root.join(format!("docs/{shown}.svg"))).expect("it is there");
        assert!(shown.len() < 400_000);
        assert_eq!(titles(&shown), titles(&read(folder.path(), &format!("{drawn}.svg"))));
    }
}
