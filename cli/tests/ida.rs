//! `rocking ida` and `rocking fragility`: the shipped study checked by hand, folders of components, bad input.

mod common;

use common::{root, succeeds};
use rocking::ground::{Record, Synthetic};
use rocking::{Block, Column, Excitation, Motion, Restitution, Scene, simulate};
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

/// The rows of a table by the names of their columns.
fn rows(file: &Path) -> Vec<HashMap<String, String>> {
    let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    lines.map(|line| header.iter().map(ToString::to_string).zip(line.split(',').map(String::from)).collect()).collect()
}

fn number(row: &HashMap<String, String>, name: &str) -> f64 {
    row[name].parse().unwrap_or_else(|_| panic!("`{}` of {name}", row[name]))
}

/// The shipped study, in a folder of its own.
fn study(folder: &Path, arguments: &[&str]) -> String {
    let file = root().join("scenes/studies/statue-ida.toml").display().to_string();
    succeeds(folder, &[&["ida", &file, "--out", "ida.csv"], arguments].concat())
}

/// The statue of `scenes/studies/statue.toml`, made anew.
fn statue(record: Record, t_end: f64) -> Scene {
    let blocks = vec![Block::rectangle(0.45, 0.5, 2700.0), Block::rectangle(0.25, 0.9, 2700.0)];
    let mut scene = Scene::new(Column::new(blocks, 9.81).expect("valid"));
    scene.restitution = Restitution::Eta(0.9);
    scene.options.rtol = 1e-7;
    scene.options.t_end = t_end;
    scene.excitation = Excitation { horizontal: Some(Motion::Record(record)), vertical: None };
    scene
}

/// Peak velocity by the trapezoidal rule on a grid a hundred times finer than the samples.
fn peak_velocity(record: &Record) -> f64 {
    let (mut velocity, mut peak) = (0.0, 0.0_f64);
    for pair in record.accel().windows(2) {
        let at = |k: i32| pair[0] + (pair[1] - pair[0]) * f64::from(k) / 100.0;
        for k in 0..100 {
            velocity += 0.5 * (at(k) + at(k + 1)) * record.dt() / 100.0;
            peak = peak.max(velocity.abs());
        }
    }
    peak
}

/// Six records, fifteen levels: factors and responses of the table are those of runs made by hand.
#[test]
fn the_runs_of_the_shipped_study_are_those_made_by_hand() {
    let folder = tempfile::tempdir().expect("a folder");
    study(folder.path(), &["--quiet"]);
    let rows = rows(&folder.path().join("ida.csv"));
    assert_eq!(rows.len(), 90);
    for (index, row) in rows.iter().enumerate() {
        let (seed, step) = (index / 15 + 1, index % 15 + 1);
        assert_eq!((row["index"].as_str(), row["record"].as_str()), (&*index.to_string(), &*format!("seed {seed}")));
        // Decimal levels, and the factor that brings the record there.
        assert_eq!(number(row, "pgv"), step as f64 / 10.0);
        let record = Synthetic { seed: seed as u64, frequency: 1.5, duration: 20.0, ..Synthetic::default() };
        let record = record.record().expect("valid");
        let scale = number(row, "scale");
        assert!((scale * peak_velocity(&record) / number(row, "pgv") - 1.0).abs() < 1e-4);
        if index % 4 != 0 {
            continue;
        }
        let scene = statue(record.scaled(scale).expect("in range"), 30.0);
        let response = simulate(&scene).expect("runs");
        assert_eq!(row["outcome"] == "overturns", response.status.overturns(), "row {index}");
        assert_eq!(number(row, "impacts"), response.impacts as f64, "row {index}");
        for block in 0..2 {
            let peak = response.peak_theta[block] / scene.column.stack(block).slenderness();
            let found = number(row, &format!("peak_{}", block + 1));
            // Output times do not change a run but for rounding.
            assert!((found - peak).abs() <= 1e-9 * peak, "row {index}: {found} and {peak}");
        }
        let first = response.events.first().map(|event| event.t);
        assert_eq!(row["first_uplift"].parse().ok(), first, "row {index}");
        // The widest gap: 2 c sin φ of the larger relative angle, at most that of both angles added.
        let most =
            0.9 * response.peak_theta[0].sin() + 0.5 * (response.peak_theta[0] + response.peak_theta[1]).min(1.6).sin();
        let gap = number(row, "largest_gap");
        assert!(gap <= most * (1.0 + 1e-6) && (gap > 0.0) == first.is_some(), "row {index}: {gap}");
    }
}

/// Counts, fractiles and the likelihood's maximum from the table of runs alone, with formulas of this test's own.
#[test]
fn stripes_and_curves_of_the_shipped_study_are_those_found_by_hand() {
    let folder = tempfile::tempdir().expect("a folder");
    let told = study(folder.path(), &[]);
    let runs = rows(&folder.path().join("ida.csv"));
    let is_lost = |row: &&HashMap<String, String>| row["outcome"] == "overturns";
    let demand = |row: &HashMap<String, String>| {
        if is_lost(&row) { f64::INFINITY } else { number(row, "peak_1").max(number(row, "peak_2")) }
    };
    let stripes = rows(&folder.path().join("ida-stripes.csv"));
    assert_eq!(stripes.len(), 15);
    let mut data = Vec::new();
    for stripe in &stripes {
        let own: Vec<_> = runs.iter().filter(|row| row["pgv"] == stripe["pgv"]).collect();
        let mut demands: Vec<f64> = own.iter().map(|row| demand(row)).collect();
        demands.sort_by(f64::total_cmp);
        // Of six values: the first (0.96), the third (3) and the sixth (5.04).
        for (name, place) in [("peak_16", 0), ("peak_50", 2), ("peak_84", 5)] {
            assert_eq!(number(stripe, name), demands[place], "{name} at {}", stripe["pgv"]);
        }
        let lost = own.iter().copied().filter(is_lost).count();
        assert_eq!((number(stripe, "runs"), number(stripe, "overturns")), (6.0, lost as f64));
        data.push((number(stripe, "pgv"), lost as f64));
    }
    let curves = std::fs::read_to_string(folder.path().join("ida-fragility.csv")).expect("written");
    let row = curves.lines().find(|line| line.starts_with("overturned,")).expect("a state");
    let cells: Vec<&str> = row.split(',').collect();
    let [median, dispersion] = [3, 6].map(|place: usize| cells[place].parse::<f64>().expect("a number"));
    let [best_median, best_dispersion] = likeliest(&data, 6.0);
    assert!((median / best_median - 1.0).abs() < 1e-5, "{median} and {best_median}");
    assert!((dispersion / best_dispersion - 1.0).abs() < 1e-5, "{dispersion} and {best_dispersion}");
    for state in ["uplift: ", "peak > 0.15: ", "peak > 0.35: ", "overturned: lognormal, median"] {
        assert!(told.lines().any(|line| line.starts_with(state)), "{state}: {told}");
    }
    // Seed 1 overturns the statue at 0.7 m/s and not at 0.8 m/s: the text says so wherever such a record is in the table.
    let weaves = (0..6).any(|record| {
        let fates: Vec<bool> = runs[15 * record..15 * (record + 1)].iter().map(|row| is_lost(&row)).collect();
        fates.windows(2).any(|pair| pair[0] && !pair[1])
    });
    assert_eq!(told.contains("not monotonic: "), weaves, "{told}");
}

/// Median and dispersion of the greatest likelihood, on finer and finer grids.
fn likeliest(data: &[(f64, f64)], runs: f64) -> [f64; 2] {
    let density = |x: f64| (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let normal = |z: f64| {
        let h = z / 200.0;
        let inner: f64 = (1..200).map(|k| if k % 2 == 1 { 4.0 } else { 2.0 } * density(f64::from(k) * h)).sum();
        0.5 + h / 3.0 * (density(0.0) + inner + density(z))
    };
    let likelihood = |[log_median, log_dispersion]: [f64; 2]| -> f64 {
        let term = |(level, reached): &(f64, f64)| {
            let p = normal((level.ln() - log_median) / log_dispersion.exp()).clamp(1e-15, 1.0 - 1e-15);
            reached * p.ln() + (runs - reached) * (1.0 - p).ln()
        };
        data.iter().map(term).sum()
    };
    let (mut centre, mut reach) = ([0.0, -1.0], 2.0);
    while reach > 1e-7 {
        let grid = (-5..=5).flat_map(|a| (-5..=5).map(move |b| [a, b]));
        let places =
            grid.map(|[a, b]| [centre[0] + 0.2 * reach * f64::from(a), centre[1] + 0.2 * reach * f64::from(b)]);
        centre = places.max_by(|a, b| likelihood(*a).total_cmp(&likelihood(*b))).expect("places");
        reach *= 0.6;
    }
    centre.map(f64::exp)
}

/// The same with NumPy where it is installed; `ROCKING_PYTHON` names another interpreter.
#[test]
fn numpy_finds_the_same_if_it_is_installed() {
    let python = std::env::var("ROCKING_PYTHON").unwrap_or("python3".into());
    let has = Command::new(&python).args(["-c", "import numpy"]).stderr(Stdio::null()).status();
    if !has.is_ok_and(|status| status.success()) {
        eprintln!("{python} has no NumPy: nothing is compared");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    study(folder.path(), &["--quiet"]);
    let script = root().join("cli/tests/ida.py");
    let output = Command::new(&python).arg(script).args(["ida.csv", "pgv"]).current_dir(folder.path()).output();
    let output = output.expect("it has just run");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("numbers");
    let lines: Vec<Vec<f64>> =
        text.lines().map(|line| line.split(' ').map(|word| word.parse().expect("a number")).collect()).collect();
    for (stripe, line) in rows(&folder.path().join("ida-stripes.csv")).iter().zip(&lines) {
        let own = ["pgv", "peak_16", "peak_50", "peak_84"].map(|name| number(stripe, name));
        assert_eq!(own, line[..], "NumPy's fractiles");
    }
    let curves = std::fs::read_to_string(folder.path().join("ida-fragility.csv")).expect("written");
    let row = curves.lines().find(|line| line.starts_with("overturned,")).expect("a state");
    let cells: Vec<&str> = row.split(',').collect();
    for (place, found) in [3, 6].into_iter().zip(&lines[15]) {
        let own: f64 = cells[place].parse().expect("a number");
        assert!((own / found - 1.0).abs() < 1e-6, "{own} and {found}");
    }
}

#[test]
fn tables_and_figures_do_not_depend_on_threads_and_fragility_reads_them_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect("written");
    study(folder.path(), &["--quiet", "--threads", "1", "--plot", "a.svg"]);
    let names = ["ida.csv", "ida-stripes.csv", "ida-fragility.csv", "ida-shares.csv", "a.svg", "a-fragility.svg"];
    let first = names.map(read);
    study(folder.path(), &["--quiet", "--threads", "2", "--plot", "a.svg"]);
    assert!(names.map(read) == first);
    for name in ["a.svg", "a-fragility.svg"] {
        let text = String::from_utf8(read(name)).expect("text");
        roxmltree::Document::parse(&text).expect("a document");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
    }
    let file = root().join("scenes/studies/statue-ida.toml").display().to_string();
    let told = succeeds(folder.path(), &["check", &file]);
    assert!(told.contains("a valid study of 90 run(s)") && told.contains("15 level(s), from 0.1 to 1.5"), "{told}");
    assert!(told.contains("  seed 6\n") && told.contains("limit states: uplift, peak > 0.15"), "{told}");
    // The curves of the table alone are those of the study.
    succeeds(folder.path(), &["plot", "ida.csv"]);
    assert!(read("ida.svg") == first[4], "the figure of the table");
    // The seed of the study is 1.
    let again = succeeds(folder.path(), &["fragility", "ida.csv", "--seed", "1", "--out", "b-fragility.csv"]);
    assert!(again.contains("wrote b-fragility.csv\nwrote b-shares.csv\n"), "{again}");
    assert!(read("b-fragility.csv") == first[2] && read("b-shares.csv") == first[3]);
}

const BLOCK: &str = "scene = \"block.toml\"\nmeasure = \"pgv\"\n";

/// A folder with a block and two records of three components.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 0.8\n[restitution]\neta = 0.9\n";
    std::fs::write(folder.path().join("block.toml"), scene).expect("written");
    std::fs::create_dir(folder.path().join("records")).expect("made");
    for (place, name) in ["A_H1", "A_H2", "A_V", "B_H1", "B_H2", "B_V"].iter().enumerate() {
        let record = Synthetic { seed: place as u64, duration: 8.0, ..Synthetic::default() }.record().expect("valid");
        std::fs::write(folder.path().join(format!("records/{name}.csv")), record.to_csv()).expect("written");
    }
    folder
}

fn run(folder: &Path, study: &str) -> (bool, String) {
    std::fs::write(folder.join("study.toml"), study).expect("written");
    let output = common::rocking(folder, &["ida", "study.toml"]);
    let text = [output.stdout, output.stderr].concat();
    (output.status.success(), String::from_utf8(text).expect("text"))
}

/// A folder gives each horizontal component as a record, by its name, or those of one name; the vertical one is scaled by the same factor.
#[test]
fn components_of_a_folder_are_records() {
    let folder = folder();
    let names = || -> Vec<String> {
        let mut names: Vec<String> =
            rows(&folder.path().join("ida.csv")).iter().map(|row| row["record"].clone()).collect();
        names.dedup();
        names
    };
    let files = |names: &[&str]| -> Vec<String> { names.iter().map(|name| format!("records/{name}.csv")).collect() };
    let (is_good, told) = run(folder.path(), &format!("{BLOCK}levels = [0.3, 0.6]\n[records]\nfolder = \"records\"\n"));
    assert!(is_good, "{told}");
    assert_eq!(names(), files(&["A_H1", "A_H2", "B_H1", "B_H2"]));
    let study =
        format!("{BLOCK}levels = [0.5]\n[records]\nfolder = \"records\"\ncomponent = \"h2\"\nvertical = true\n");
    let (is_good, told) = run(folder.path(), &study);
    assert!(is_good, "{told}");
    assert_eq!(names(), files(&["A_H2", "B_H2"]));
    let row = &rows(&folder.path().join("ida.csv"))[0];
    let component = |name: &str| {
        let record = Record::open(folder.path().join("records").join(name), &rocking::ground::TextOptions::default());
        Some(Motion::Record(record.expect("a record").scaled(number(row, "scale")).expect("in range")))
    };
    let mut scene = Scene::new(Column::equal_blocks(1, 0.2, 0.8, 1.0, 9.81).expect("valid"));
    scene.restitution = Restitution::Eta(0.9);
    scene.options.t_end = 18.0;
    scene.excitation = Excitation { horizontal: component("A_H2.csv"), vertical: component("A_V.csv") };
    let response = simulate(&scene).expect("runs");
    let peak = response.peak_theta[0] / scene.column.slenderness();
    assert!((number(row, "peak_1") / peak - 1.0).abs() < 1e-9, "{row:?} {peak}");

    // No file says H1 or H2: the horizontal ones by the order of their names.
    std::fs::create_dir(folder.path().join("peer")).expect("made");
    for (own, name) in [("A_H1", "RSN1_X090"), ("A_H2", "RSN1_X000"), ("A_V", "RSN1_X-UP")] {
        let from = folder.path().join(format!("records/{own}.csv"));
        std::fs::copy(from, folder.path().join(format!("peer/{name}.csv"))).expect("copied");
    }
    for (component, name) in [("H1", "000"), ("h2", "090")] {
        let study = format!("{BLOCK}levels = [0.5]\n[records]\nfolder = \"peer\"\ncomponent = \"{component}\"\n");
        let (is_good, told) = run(folder.path(), &study);
        assert!(is_good, "{told}");
        assert_eq!(names(), [format!("peer/RSN1_X{name}.csv")]);
    }
}

/// Killed again and again, it comes to the same bytes.
#[test]
fn an_interrupted_study_goes_on() {
    let folder = folder();
    let study = "trust = false\nscene = \"block.toml\"\nmeasure = \"pga_uplift\"\nlevels = { from = 0.5, to = 6, steps = 300 }\n[records]\nfolder = \"records\"\n";
    let study = format!("{study}[records.synthetic]\nseeds = {{ from = 1, to = 12 }}\n[fragility]\nreplicates = 0\n");
    let (is_good, told) = run(folder.path(), &study);
    assert!(is_good, "{told}");
    let table = || std::fs::read(folder.path().join("ida.csv")).expect("written");
    let whole = table();
    std::fs::remove_file(folder.path().join("ida.csv")).expect("removed");
    let mut kills = 0;
    for wait in (20..).step_by(40) {
        let mut child = Command::new(env!("CARGO_BIN_EXE_rocking"))
            .args(["ida", "study.toml", "--quiet"])
            .current_dir(folder.path())
            .spawn()
            .expect("started");
        std::thread::sleep(std::time::Duration::from_millis(wait));
        child.kill().expect("SIGKILL");
        if child.wait().expect("it ends").success() {
            break;
        }
        kills += 1;
    }
    assert!(kills > 0 && table() == whole, "after {kills} kills");
}

/// Every remedy is told with its place, and nothing is left half written.
#[test]
fn bad_studies_are_refused_with_place_and_remedy() {
    let folder = folder();
    let records = "[records]\nfolder = \"records\"\n";
    let with = |levels: &str, rest: &str| format!("{BLOCK}levels = {levels}\n{rest}");
    for (study, told) in [
        (with("[0.5]", ""), vec!["key `records`", "[records.synthetic]"]),
        (with("[0.5]", "[records]\nfiles = []\n"), vec!["key `records`", "no record"]),
        (with("[0.5]", "[records]\nfiles = [\"none.AT2\"]\n"), vec!["none.AT2", "records.files"]),
        (with("[0.5]", "[records]\nfolder = \"nowhere\"\n"), vec!["records.folder", "relative to the study"]),
        (
            with("[0.5]", &format!("{records}component = \"EW\"\n")),
            vec!["records.component", "A (", "has no component `EW`"],
        ),
        (with("[]", records), vec!["key `levels`", "no level"]),
        (with("[0.5, -1]", records), vec!["key `levels`", "above zero"]),
        (with("[0.5, 0.5]", records), vec!["key `levels`", "twice"]),
        (with("[0.5]", "[records]\nfiles = [\"records/A_H1.csv\", \"records/A_H1.csv\"]\n"), vec!["twice"]),
        (
            with("[0.5]", &format!("{records}[fragility]\nstates = [\"toppled\"]\n")),
            vec!["fragility.states", "peak > 0.35"],
        ),
        (with("[0.5]", &format!("{records}[fragility]\nstates = [\"slide > 0.1\"]\n")), vec!["without friction"]),
        (with("[0.5]", &format!("{records}[fragility]\nstates = [\"peak_2 > 0.1\"]\n")), vec!["has 1 block(s)"]),
        (
            with("[0.5]", records).replace("\"pgv\"", "\"pgv_uplft\""),
            vec!["key `measure`", "did you mean `pgv_uplift`"],
        ),
        (with("[0.5]", records).replace("\"pgv\"", "\"sa\""), vec!["sa_period", "period"]),
        (with("[0.5]", "[records.synthetic]\nseeds = [0.5]\n"), vec!["records.synthetic.seeds", "whole numbers"]),
        (with("[0.5]", &format!("{records}wrong = 1\n")), vec!["records.wrong", "unknown"]),
    ] {
        let (is_good, text) = run(folder.path(), &study);
        assert!(!is_good, "{study}\n{text}");
        for word in told {
            assert!(text.contains(word), "{study}\n{text}\nlacks {word}");
        }
        assert!(!folder.path().join("ida.csv").exists(), "{study}");
    }
}

/// Tables without the columns of a state, and tables without anything.
#[test]
fn tables_without_what_a_state_needs_are_refused() {
    let folder = folder();
    let (is_good, told) = run(folder.path(), &format!("{BLOCK}levels = [0.5]\n[records]\nfolder = \"records\"\n"));
    assert!(is_good, "{told}");
    std::fs::write(folder.path().join("empty.csv"), "").expect("written");
    for (arguments, told) in [
        (
            vec!["ida.csv", "--state", "peak_2 > 0.3"],
            "needs the column peak_2, and the columns of the table have 1 block(s)",
        ),
        (vec!["ida.csv", "--state", "slide > 0.1"], "residual_slide_1"),
        (vec!["empty.csv"], "it is empty"),
    ] {
        let output = common::rocking(folder.path(), &[vec!["fragility"], arguments.clone()].concat());
        let text = String::from_utf8_lossy(&output.stderr).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(!output.status.success() && text.contains(told), "{arguments:?}: {text}");
    }
}

/// Levels that always or never reach a state, and one record: statements, no curve and no number that is none.
#[test]
fn what_no_curve_fits_is_told() {
    let folder = folder();
    let of_seeds = |levels: &str, seeds: &str| {
        format!(
            "{BLOCK}levels = {levels}\n[records.synthetic]\nseeds = {seeds}\n[fragility]\nstates = [\"overturned\"]\n"
        )
    };
    for (levels, seeds, told) in [
        ("[0.01, 0.02]", "[1, 2, 3]", "overturned: no curve: no run reaches the state up to 0.02; go higher"),
        ("[20.0, 30.0]", "[1, 2, 3]", "overturned: no curve: every run reaches the state from 20 on; begin lower"),
        (
            "[0.01, 30.0]",
            "[1, 2, 3]",
            "overturned: no curve: no run up to 0.01 reaches the state and every run from 30 on does",
        ),
        ("[0.01, 30.0]", "[1]", "overturned: no curve: all runs are of one record"),
    ] {
        let (is_good, text) = run(folder.path(), &of_seeds(levels, seeds));
        assert!(is_good && text.contains(told), "{text}\nlacks {told}");
        let table = std::fs::read_to_string(folder.path().join("ida-fragility.csv")).expect("written");
        assert!(!table.contains("NaN") && !table.contains("inf"), "{table}");
    }
}

/// Where every column is lost there is no angle to draw, and two records have no fractiles.
#[test]
fn a_figure_shows_no_angle_and_no_fractile_that_is_not_there() {
    let folder = folder();
    let figure = |levels: &str, seeds: &str| {
        let study = format!(
            "{BLOCK}levels = {levels}\n[records.synthetic]\nseeds = {seeds}\n[fragility]\nstates = [\"overturned\"]\n"
        );
        std::fs::write(folder.path().join("study.toml"), study).expect("written");
        let told = succeeds(folder.path(), &["ida", "study.toml", "--out", "t.csv", "--plot", "f.svg"]);
        (told, std::fs::read_to_string(folder.path().join("f.svg")).expect("written"))
    };
    let (told, drawn) = figure("[20.0, 30.0]", "[1, 2, 3]");
    assert!(told.contains("Lost: 6 of 6 runs, counted per level on the right.") && drawn.contains(">3/3<"), "{told}");
    assert!(!told.contains("A curve reaches the right edge"), "{told}");
    // Numbers upwards alone, and no curve.
    assert!(!drawn.contains(">0.05<") && !drawn.contains(">0.1<"), "no scale of angles");
    let curves = drawn.matches("stroke=\"#a9a9a9\"").count();
    assert_eq!(curves, 1 + 3, "empty paths of three records, and the key of the legend");
    let (told, drawn) = figure("[0.1, 0.2]", "[1, 2]");
    assert!(told.contains("2 records at 2 levels of") && told.contains("(3 records or more have fractiles as well)"));
    assert!(!drawn.contains(">50 %<"), "{told}");
    let (told, drawn) = figure("[0.1, 0.2]", "[1, 2, 3]");
    assert!(told.contains("with its 16, 50 and 84 % fractiles") && drawn.contains(">50 %<"), "{told}");
}

/// A sweep over records and a measure is a study as well; a cloud of runs, each at a level of its own, is recognised.
#[test]
fn sweeps_and_clouds_have_a_fragility() {
    let folder = folder();
    let base = "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 0.8\n[excitation.horizontal]\nkind = \"synthetic\"\npga_g = 0.3\n[solver]\nt_end = 30.0\n";
    std::fs::write(folder.path().join("base.toml"), base).expect("written");
    let sweep =
        "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\nseed = { from = 1, to = 8 }\npgv = [0.2, 0.4, 0.6, 0.8]\n";
    std::fs::write(folder.path().join("sweep.toml"), sweep).expect("written");
    succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv", "--quiet"]);
    let told =
        succeeds(folder.path(), &["fragility", "t.csv", "--state", "overturned", "--state", "peak>0.2", "--json"]);
    let found: serde_json::Value = serde_json::from_str(&told).expect("JSON");
    assert_eq!((&found["measure"], &found["fragilities"][0]["layout"]), (&"pgv".into(), &"stripes".into()));
    let counts = found["fragilities"][0]["counts"].as_array().expect("a list");
    assert_eq!(counts.iter().map(|count| count["runs"].as_u64()).collect::<Vec<_>>(), [Some(8); 4]);
    // Runs each at a level of its own.
    let mut cloud = String::from("record,pga_g,outcome\n");
    for k in 0..50 {
        let outcome = if k * 29 % 50 < k { "overturns" } else { "rocks" };
        cloud.push_str(&format!("r{k},{},{outcome}\n", 0.1 + 0.02 * f64::from(k)));
    }
    std::fs::write(folder.path().join("cloud.csv"), &cloud).expect("written");
    let told = succeeds(folder.path(), &["fragility", "cloud.csv", "--state", "overturned", "--plot", "c.svg"]);
    assert!(told.contains("overturned: lognormal, median") && told.contains("over groups"), "{told}");
    assert!(told.contains(" Marks are raw shares of groups of neighbouring levels. Shaded are 90 % bands."), "{told}");
    let arguments = ["fragility", "cloud.csv", "--state", "overturned", "--confidence", "0.57", "--plot", "c.svg"];
    let told = succeeds(folder.path(), &arguments);
    assert!(told.contains(" Shaded are 57 % bands."), "{told}");
    // What the table lacks is told.
    for (arguments, word) in [
        (vec!["fragility", "cloud.csv"], "ask = \"peaks\""),
        (vec!["fragility", "cloud.csv", "--measure", "pgv", "--state", "uplift"], "no column `pgv`"),
        (vec!["fragility", "none.csv"], "none.csv"),
        (vec!["fragility", "cloud.csv", "--state", "toppled"], "overturned"),
    ] {
        let output = common::rocking(folder.path(), &arguments);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && text.contains(word), "{arguments:?}: {text}");
    }
}

/// Scenes take records at any size, and `rocking record` measures what it scales to.
#[test]
fn records_are_scaled_to_any_measure() {
    let folder = folder();
    for (size, told) in [
        ("pgv=0.5", "PGV                   0.5 m/s"),
        ("pga_g=0.2", "PGA                   0.2 g"),
        ("arias=1.5", "Arias intensity       1.5 m/s"),
        ("cav=3", "CAV                   3 m/s"),
        ("sa_g(0.7)=0.4", "Sa(0.7 s, 5 %)        0.4 g"),
        ("pgv_uplift=2", "p PGV/(g tan α)       2\n"),
        ("pga_uplift=1.25", "PGA/(g tan α)         1.25\n"),
    ] {
        let arguments = ["record", "records/A_H1.csv", "--scale-to", size, "--sa", "0.7", "--scene", "block.toml"];
        let text = succeeds(folder.path(), &arguments);
        assert!(text.contains(told), "{size}: {text}");
        // The same size in a scene.
        let (key, value) = size.split_once('=').expect("both");
        let key = key.split('(').next().expect("a name");
        let period = if key.starts_with("sa") { "sa_period = 0.7\n" } else { "" };
        let scene = format!(
            "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 0.8\n[excitation.horizontal]\nkind = \"record\"\nfile = \"records/A_H1.csv\"\n{key} = {value}\n{period}"
        );
        std::fs::write(folder.path().join("scene.toml"), scene).expect("written");
        let scene = Scene::from_file(&folder.path().join("scene.toml")).expect("valid");
        let Some(Motion::Record(record)) = scene.excitation.horizontal else { panic!("a record") };
        let json = succeeds(folder.path(), &[&arguments[..], &["--json"]].concat());
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        let factor = json["scale"].as_f64().expect("a number");
        assert!((record.scale() / factor - 1.0).abs() < 1e-12, "{size}: {} and {factor}", record.scale());
    }
    for (keys, word) in [
        ("pgv = 0.5\npga_g = 0.2", "remove one of the two"),
        ("pgv = 0.5\nscale = 2", "remove one of the two"),
        ("pgv = -1", "above zero"),
        ("sa = 1", "sa_period"),
        ("pgv = 1\nsa_period = 1", "nothing is scaled to"),
    ] {
        let scene = format!(
            "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 0.8\n[excitation.horizontal]\nkind = \"synthetic\"\n{keys}\n"
        );
        let scene = if keys.contains("scale") {
            scene.replace("synthetic\"", "record\"\nfile = \"records/A_H1.csv\"")
        } else {
            scene
        };
        std::fs::write(folder.path().join("scene.toml"), scene).expect("written");
        let output = common::rocking(folder.path(), &["check", "scene.toml"]);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && text.contains(word), "{keys}: {text}");
    }
}

/// Rows of another axis are pooled with a warning, and kept apart by `--where`.
#[test]
fn rows_of_other_axes_are_kept_apart() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut table = String::from("index,column.alpha,seed,pgv,outcome,truncated\n");
    for (index, (alpha, lost)) in [(0.15, 4), (0.3, 8)].into_iter().enumerate() {
        for record in 0..6 {
            for level in 1..=12 {
                let outcome = if level + record % 3 > lost { "overturns" } else { "rocks" };
                let is_cut = alpha > 0.2 && level == 1;
                let _ = writeln!(table, "{index},{alpha},{record},{},{outcome},{is_cut}", f64::from(level) / 10.0);
            }
        }
    }
    std::fs::write(folder.path().join("t.csv"), table).expect("written");
    let fitted = |arguments: &[&str]| {
        let common = ["fragility", "t.csv", "--state", "overturned", "--replicates", "0", "--json"];
        let output = common::rocking(folder.path(), &[&common[..], arguments].concat());
        let (text, warnings) = (output.stdout, String::from_utf8_lossy(&output.stderr).into_owned());
        let found: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
        let runs: u64 = found["fragilities"][0]["counts"]
            .as_array()
            .expect("a list")
            .iter()
            .filter_map(|count| count["runs"].as_u64())
            .sum();
        (runs, warnings)
    };
    let (all, warning) = fitted(&[]);
    assert!(all == 144 && warning.contains("2 values of `column.alpha`") && warning.contains("--where"), "{warning}");
    assert_eq!(fitted(&["--where", "column.alpha=0.15"]), (72, String::new()));
    let (runs, warning) = fitted(&["--where", "column.alpha=0.30"]);
    assert!(runs == 72 && warning.contains("6 run(s) end before their ground motion"), "{warning}");
    for (condition, word) in
        [("alpha=0.3", "no column `alpha`"), ("column.alpha=0.4", "no row"), ("alpha", "COLUMN=VALUE")]
    {
        let output =
            common::rocking(folder.path(), &["fragility", "t.csv", "--state", "overturned", "--where", condition]);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && text.contains(word), "{condition}: {text}");
    }
}

/// Companions say whether a verdict is determined; what is measured does not depend on them.
#[test]
fn largest_gaps_are_the_same_with_and_without_companions() {
    let folder = folder();
    let study =
        "scene = \"block.toml\"\nmeasure = \"pgv\"\nlevels = [0.2, 0.5]\n[records]\nfiles = [\"records/A_H1.csv\"]\n";
    let gaps = |trust: bool| {
        let (succeeds, text) = run(folder.path(), &format!("trust = {trust}\n{study}"));
        assert!(succeeds, "{text}");
        rows(&folder.path().join("ida.csv")).iter().map(|row| row["largest_gap"].clone()).collect::<Vec<_>>()
    };
    let followed = gaps(true);
    assert!(followed.iter().any(|gap| gap.parse::<f64>().is_ok_and(|gap| gap > 1e-3)), "{followed:?}");
    std::fs::remove_file(folder.path().join("ida.csv")).expect("it is there");
    assert_eq!(followed, gaps(false));
}

/// With a record of one push and no free swing, columns are cut while they fall.
#[test]
fn a_run_whose_column_may_be_falling_at_its_end_is_not_determined() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("push.csv"), "t [s], a [m/s2]\n0, 1\n0.1, 1\n0.2, 1\n0.3, 0\n").expect("written");
    let study = "measure = \"pga_uplift\"\nlevels = [0.5, 1.2, 6.0]\ntrust = false\nfree_swing = 0\n[records]\nfiles = [\"push.csv\"]\n\
        [scene.column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 0.8\n";
    std::fs::write(folder.path().join("ida.toml"), study).expect("written");
    succeeds(folder.path(), &["ida", "ida.toml", "--out", "t.csv", "--quiet"]);
    let table = std::fs::read_to_string(folder.path().join("t.csv")).expect("written");
    let outcomes: Vec<&str> = table.lines().skip(1).map(|line| line.split(',').nth(4).expect("a cell")).collect();
    assert_eq!(outcomes, ["no-uplift", "rocks", "not-determined"], "{table}");
}
