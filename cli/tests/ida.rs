//! `rocking ida`: the shipped study checked by hand, folders of components, bad studies.

use crate::common::sweeps::kill_and_go_on;
use crate::common::{Folder, Row, assert_has, failed, project};
use rocking::ground::{Record, Synthetic};
use rocking::{Block, Column, Excitation, Motion, Restitution, Scene, simulate};
use std::process::{Command, Stdio};

const STATUE: &str = "scenes/studies/statue-ida.toml";

/// Runs the shipped study in a folder.
fn study(folder: &Folder, arguments: &[&str]) -> String {
    folder.succeeds(&[&["ida", &project(STATUE), "--out", "ida.csv"], arguments].concat()[..])
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
    let folder = Folder::new();
    study(&folder, &["--quiet"]);
    let table = folder.table("ida.csv");
    assert_eq!(table.len(), 90);
    for (index, row) in table.rows().enumerate() {
        let (seed, step) = (index / 15 + 1, index % 15 + 1);
        assert_eq!((row.text("index"), row.text("record")), (&*index.to_string(), &*format!("seed {seed}")));
        // Decimal levels, and the factor that brings the record there.
        assert_eq!(row.number("pgv"), step as f64 / 10.0);
        let record = Synthetic { seed: seed as u64, frequency: 1.5, duration: 20.0, ..Synthetic::default() };
        let record = record.record().expect("valid");
        let scale = row.number("scale");
        assert!((scale * peak_velocity(&record) / row.number("pgv") - 1.0).abs() < 1e-4);
        if index % 4 != 0 {
            continue;
        }
        let scene = statue(record.scaled(scale).expect("in range"), 30.0);
        let response = simulate(&scene).expect("runs");
        assert_eq!(row.text("outcome") == "overturns", response.status.overturns(), "row {index}");
        assert_eq!(row.number("impacts"), response.impacts as f64, "row {index}");
        for block in 0..2 {
            let peak = response.peak_theta[block] / scene.column.stack(block).slenderness();
            let found = row.number(&format!("peak_{}", block + 1));
            // Output times do not change a run but for rounding.
            assert!((found - peak).abs() <= 1e-9 * peak, "row {index}: {found} and {peak}");
        }
        let first = response.events.first().map(|event| event.t);
        assert_eq!(row.text("first_uplift").parse().ok(), first, "row {index}");
        // The widest gap: 2 c sin φ of the larger relative angle, at most that of both angles added.
        let most =
            0.9 * response.peak_theta[0].sin() + 0.5 * (response.peak_theta[0] + response.peak_theta[1]).min(1.6).sin();
        let gap = row.number("largest_gap");
        assert!(gap <= most * (1.0 + 1e-6) && (gap > 0.0) == first.is_some(), "row {index}: {gap}");
    }
}

/// Counts, fractiles and the likelihood's maximum from the table of runs alone, with formulas of this test's own.
#[test]
fn stripes_and_curves_of_the_shipped_study_are_those_found_by_hand() {
    let folder = Folder::new();
    let told = study(&folder, &[]);
    let runs = folder.table("ida.csv");
    let is_lost = |row: Row| row.text("outcome") == "overturns";
    let demand = |row: Row| {
        if is_lost(row) { f64::INFINITY } else { row.number("peak_1").max(row.number("peak_2")) }
    };
    let stripes = folder.table("ida-stripes.csv");
    assert_eq!(stripes.len(), 15);
    let mut data = Vec::new();
    for stripe in stripes.rows() {
        let own: Vec<Row> = runs.rows().filter(|row| row.text("pgv") == stripe.text("pgv")).collect();
        let mut demands: Vec<f64> = own.iter().map(|row| demand(*row)).collect();
        demands.sort_by(f64::total_cmp);
        // Of six values: the first (0.96), the third (3) and the sixth (5.04).
        for (name, place) in [("peak_16", 0), ("peak_50", 2), ("peak_84", 5)] {
            assert_eq!(stripe.number(name), demands[place], "{name} at {}", stripe.text("pgv"));
        }
        let lost = own.iter().filter(|row| is_lost(**row)).count();
        assert_eq!((stripe.number("runs"), stripe.number("overturns")), (6.0, lost as f64));
        data.push((stripe.number("pgv"), lost as f64));
    }
    let [median, dispersion] = overturning(&folder);
    let [best_median, best_dispersion] = likeliest(&data, 6.0);
    assert!((median / best_median - 1.0).abs() < 1e-5, "{median} and {best_median}");
    assert!((dispersion / best_dispersion - 1.0).abs() < 1e-5, "{dispersion} and {best_dispersion}");
    for state in ["uplift: ", "peak > 0.15: ", "peak > 0.35: ", "overturned: lognormal, median"] {
        assert!(told.lines().any(|line| line.starts_with(state)), "{state}: {told}");
    }
    // Seed 1 overturns the statue at 0.7 m/s and not at 0.8 m/s: the text says so wherever such a record is in the table.
    let weaves = (0..6).any(|record| {
        let fates: Vec<bool> = (0..15).map(|level| is_lost(runs.row(15 * record + level))).collect();
        fates.windows(2).any(|pair| pair[0] && !pair[1])
    });
    assert_eq!(told.contains("not monotonic: "), weaves, "{told}");
}

/// Median and dispersion of overturning as the study has them.
fn overturning(folder: &Folder) -> [f64; 2] {
    let curves = folder.table("ida-fragility.csv");
    let curve = curves.rows().find(|row| row.text("state") == "overturned").expect("a state");
    ["median", "dispersion"].map(|name| curve.number(name))
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
    let folder = Folder::new();
    study(&folder, &["--quiet"]);
    let script = project("cli/tests/ida.py");
    let output = Command::new(&python).arg(script).args(["ida.csv", "pgv"]).current_dir(folder.path("")).output();
    let output = output.expect("it has just run");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("numbers");
    let lines: Vec<Vec<f64>> =
        text.lines().map(|line| line.split(' ').map(|word| word.parse().expect("a number")).collect()).collect();
    for (stripe, line) in folder.table("ida-stripes.csv").rows().zip(&lines) {
        let own = ["pgv", "peak_16", "peak_50", "peak_84"].map(|name| stripe.number(name));
        assert_eq!(own, line[..], "NumPy's fractiles");
    }
    for (own, found) in overturning(&folder).into_iter().zip(&lines[15]) {
        assert!((own / found - 1.0).abs() < 1e-6, "{own} and {found}");
    }
}

#[test]
fn tables_and_figures_do_not_depend_on_threads_and_fragility_reads_them_again() {
    let folder = Folder::new();
    study(&folder, &["--quiet", "--threads", "1", "--plot", "a.svg"]);
    let names = ["ida.csv", "ida-stripes.csv", "ida-fragility.csv", "ida-shares.csv", "a.svg", "a-fragility.svg"];
    let first = names.map(|name| folder.bytes(name));
    study(&folder, &["--quiet", "--threads", "2", "--plot", "a.svg"]);
    assert!(names.map(|name| folder.bytes(name)) == first);
    for name in ["a.svg", "a-fragility.svg"] {
        let text = folder.read(name);
        roxmltree::Document::parse(&text).expect("a document");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
    }
    let told = folder.succeeds(&["check", &project(STATUE)]);
    assert_has(&told, &["a valid study of 90 run(s)", "15 level(s), from 0.1 to 1.5"]);
    assert_has(&told, &["  seed 6\n", "limit states: uplift, peak > 0.15"]);
    let unordered =
        "scene = \"base.toml\"\nmeasure = \"pgv\"\nlevels = [0.6, 0.2, 0.4]\n[records.synthetic]\nseeds = [1, 2]\n";
    folder.write("base.toml", "[[block]]\nhalf_width = 0.3\nhalf_height = 1.0\n");
    folder.write("unordered.toml", unordered);
    assert_has(&folder.succeeds("check unordered.toml"), &["3 level(s), from 0.2 to 0.6"]);
    // The curves of the table alone are those of the study.
    folder.succeeds("plot ida.csv");
    assert!(folder.bytes("ida.svg") == first[4], "the figure of the table");
    // The seed of the study is 1.
    let again = folder.succeeds("fragility ida.csv --seed 1 --out b-fragility.csv");
    assert!(again.contains("wrote b-fragility.csv\nwrote b-shares.csv\n"), "{again}");
    assert!(folder.bytes("b-fragility.csv") == first[2] && folder.bytes("b-shares.csv") == first[3]);
    // Only the end of a name says what a table is.
    folder.succeeds("fragility ida.csv --out fragility-of-b.csv");
    assert!(folder.has("fragility-of-b-shares.csv"));
}

/// Figures of a table have the limit states and the bands of the study, as its table of curves has them: they had the usual ones.
#[test]
fn figures_of_a_table_have_the_states_of_its_study() {
    let folder = folder();
    let study = format!(
        "{BLOCK}levels = {{ from = 0.3, to = 1.2, steps = 10 }}\n[records.synthetic]\nseeds = {{ from = 1, to = 12 }}\n\
         [fragility]\nstates = [\"uplift\", \"peak > 0.6\"]\nconfidence = 0.5\nreplicates = 200\n"
    );
    folder.write("study.toml", study);
    folder.succeeds("ida study.toml --plot ida.svg");
    let first = folder.read("ida-fragility.svg");
    assert!(first.contains("peak &gt; 0.6") && first.contains("50 %"), "{first}");
    folder.succeeds("plot ida.csv");
    let again = folder.read("ida-fragility.svg");
    assert!(again.contains("peak &gt; 0.6") && !again.contains("peak &gt; 0.35") && again.contains("50 %"), "{again}");
    folder.remove("ida-fragility.csv");
    folder.succeeds("plot ida.csv");
    assert!(folder.read("ida-fragility.svg").contains("peak &gt; 0.35"));
}

/// The first keys of a study of the block in [`folder`].
pub const BLOCK: &str = "scene = \"block.toml\"\nmeasure = \"pgv\"\n";

/// A folder with a block and two records of three components.
pub fn folder() -> Folder {
    let scene = "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 0.8\n[restitution]\neta = 0.9\n";
    let folder = Folder::with("block.toml", scene);
    for (place, name) in ["A_H1", "A_H2", "A_V", "B_H1", "B_H2", "B_V"].iter().enumerate() {
        let record = Synthetic { seed: place as u64, duration: 8.0, ..Synthetic::default() }.record().expect("valid");
        folder.write(&format!("records/{name}.csv"), record.to_csv());
    }
    folder
}

/// Runs a study of the folder; what it prints.
pub fn run(folder: &Folder, study: &str) -> String {
    folder.write("study.toml", study);
    let (told, warned) = folder.says("ida study.toml");
    told + &warned
}

/// A folder gives each horizontal component as a record, by its name, or those of one name; the vertical one is scaled by the same factor.
#[test]
fn components_of_a_folder_are_records() {
    let folder = folder();
    let names = || {
        let mut names: Vec<String> = folder.table("ida.csv").texts("record").into_iter().map(String::from).collect();
        names.dedup();
        names
    };
    let files = |names: &[&str]| -> Vec<String> { names.iter().map(|name| format!("records/{name}.csv")).collect() };
    run(&folder, &format!("{BLOCK}levels = [0.3, 0.6]\n[records]\nfolder = \"records\"\n"));
    assert_eq!(names(), files(&["A_H1", "A_H2", "B_H1", "B_H2"]));
    let study =
        format!("{BLOCK}levels = [0.5]\n[records]\nfolder = \"records\"\ncomponent = \"h2\"\nvertical = true\n");
    run(&folder, &study);
    assert_eq!(names(), files(&["A_H2", "B_H2"]));
    let table = folder.table("ida.csv");
    let row = table.row(0);
    let component = |name: &str| {
        let record = Record::open(folder.path(&format!("records/{name}")), &rocking::ground::TextOptions::default());
        Some(Motion::Record(record.expect("a record").scaled(row.number("scale")).expect("in range")))
    };
    let mut scene = Scene::new(Column::equal_blocks(1, 0.2, 0.8, 1.0, 9.81).expect("valid"));
    scene.restitution = Restitution::Eta(0.9);
    scene.options.t_end = 18.0;
    scene.excitation = Excitation { horizontal: component("A_H2.csv"), vertical: component("A_V.csv") };
    let response = simulate(&scene).expect("runs");
    let peak = response.peak_theta[0] / scene.column.slenderness();
    assert!((row.number("peak_1") / peak - 1.0).abs() < 1e-9, "{row:?} {peak}");

    // No file says H1 or H2: the horizontal ones by the order of their names.
    for (own, name) in [("A_H1", "RSN1_X090"), ("A_H2", "RSN1_X000"), ("A_V", "RSN1_X-UP")] {
        folder.write(&format!("peer/{name}.csv"), folder.bytes(&format!("records/{own}.csv")));
    }
    for (component, name) in [("H1", "000"), ("h2", "090")] {
        let study = format!("{BLOCK}levels = [0.5]\n[records]\nfolder = \"peer\"\ncomponent = \"{component}\"\n");
        run(&folder, &study);
        assert_eq!(names(), [format!("peer/RSN1_X{name}.csv")]);
    }
}

/// A study has the motion of its records alone: what the scene shakes with beside them is left out with a warning.
#[test]
fn a_vertical_motion_of_the_scene_is_left_out_with_a_warning() {
    let folder = folder();
    let vertical = "[excitation.vertical]\nkind = \"sine-pulse\"\namplitude_g = 0.9\nomega = 6.0\n";
    folder.write("block.toml", folder.read("block.toml") + vertical);
    let study = |vertical: bool| {
        format!("{BLOCK}levels = [0.5]\n[records]\nfolder = \"records\"\ncomponent = \"H1\"\nvertical = {vertical}\n")
    };
    let warning = "the vertical ground motion of the scene is left out";
    for vertical in [false, true] {
        assert!(run(&folder, &study(vertical)).contains(warning));
        assert!(folder.says("check study.toml").1.contains(warning));
    }
    folder.write("block.toml", folder.read("block.toml").replace(vertical, ""));
    assert!(!run(&folder, &study(true)).contains(warning));
}

/// Levels of PGV in cm/s: the records are scaled to peaks that no ground has had.
#[test]
fn levels_in_another_unit_give_a_warning() {
    let folder = folder();
    let study =
        |level: f64| format!("{BLOCK}levels = [0.5, {level}]\n[records]\nfolder = \"records\"\ncomponent = \"H1\"\n");
    let warning = "record records/A_H1.csv: it is scaled to a peak above 20 g";
    assert!(run(&folder, &study(50.0)).contains(warning));
    assert!(!run(&folder, &study(0.6)).contains(warning));
}

/// Killed again and again, it comes to the same bytes.
#[test]
fn an_interrupted_study_goes_on() {
    let folder = folder();
    let study = "trust = false\nscene = \"block.toml\"\nmeasure = \"pga_uplift\"\nlevels = { from = 0.5, to = 6, steps = 300 }\n[records]\nfolder = \"records\"\n";
    let study = format!("{study}[records.synthetic]\nseeds = {{ from = 1, to = 12 }}\n[fragility]\nreplicates = 0\n");
    run(&folder, &study);
    let whole = folder.bytes("ida.csv");
    folder.remove("ida.csv");
    kill_and_go_on(|| folder.start("ida study.toml --quiet"), || {});
    assert!(folder.bytes("ida.csv") == whole);
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
        // The same file by another path.
        (
            with("[0.5]", "[records]\nfiles = [\"records/A_H1.csv\", \"./records/../records/A_H1.csv\"]\n"),
            vec!["twice"],
        ),
        (
            with("[0.5]", "[records.synthetic]\nseeds = { from = 1, to = 1000000 }\n"),
            vec!["records.synthetic.seeds", "1000000 records", "give fewer seeds"],
        ),
        (
            with("[0.5]", "[records.synthetic]\nseeds = [1]\nstart = 1\n"),
            vec!["records.synthetic.start", "known here are seeds, duration, dt"],
        ),
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
        (
            with("[0.5]", "[records]\ndt = 0.01\n[records.synthetic]\nseeds = [1]\n"),
            vec!["`records.dt`", "neither is given", "below [records.synthetic]"],
        ),
        (
            with("[0.5]", "[records]\nunits = \"g\"\n[records.synthetic]\nseeds = [1]\n"),
            vec!["`records.units`", "neither is given"],
        ),
        (with("[0.5]", &format!("{records}[fragility]\nstates = []\n")), vec!["fragility.states", "the list is empty"]),
        (with("[0.5]", &format!("{records}wrong = 1\n")), vec!["records.wrong", "unknown"]),
    ] {
        folder.write("study.toml", &study);
        failed(&folder.rocking("ida study.toml"), 2, &study, &told);
        assert!(!folder.has("ida.csv"), "{study}");
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
        let text = run(&folder, &of_seeds(levels, seeds));
        assert!(text.contains(told), "{text}\nlacks {told}");
        let table = folder.read("ida-fragility.csv");
        assert!(!table.contains("NaN") && !table.contains("inf"), "{table}");
    }
}

/// A study whose highest level is out of range is told so before it is run.
#[test]
fn check_names_levels_that_are_refused() {
    let folder = folder();
    let study = |highest: &str| format!("{BLOCK}levels = [0.1, {highest}]\n[records.synthetic]\nseeds = [1, 2]\n");
    for (highest, is_refused) in [("0.5", false), ("1e9", true)] {
        folder.write("study.toml", study(highest));
        let (told, warnings) = folder.says("check study.toml");
        assert!(told.contains("a valid study of 4 run(s)"), "{told}");
        let is_told = warnings
            .contains("at the highest level, 2 of 2 run(s) are refused, and would be rows with errors; seed 1:");
        assert!(is_told == is_refused, "{highest}: {warnings}");
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
        folder.write("study.toml", study);
        let told = folder.succeeds("ida study.toml --out t.csv --plot f.svg");
        (told, folder.read("f.svg"))
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

/// Companions say whether a verdict is determined; what is measured does not depend on them.
#[test]
fn largest_gaps_are_the_same_with_and_without_companions() {
    let folder = folder();
    let study =
        "scene = \"block.toml\"\nmeasure = \"pgv\"\nlevels = [0.2, 0.5]\n[records]\nfiles = [\"records/A_H1.csv\"]\n";
    let gaps = |trust: bool| {
        run(&folder, &format!("trust = {trust}\n{study}"));
        folder.table("ida.csv").texts("largest_gap").into_iter().map(String::from).collect::<Vec<_>>()
    };
    let followed = gaps(true);
    assert!(followed.iter().any(|gap| gap.parse::<f64>().is_ok_and(|gap| gap > 1e-3)), "{followed:?}");
    folder.remove("ida.csv");
    assert_eq!(followed, gaps(false));
}

/// With a record of one push and no free swing, columns are cut while they fall.
#[test]
fn a_run_whose_column_may_be_falling_at_its_end_is_not_determined() {
    let folder = Folder::with("push.csv", "t [s], a [m/s2]\n0, 1\n0.1, 1\n0.2, 1\n0.3, 0\n");
    let study = "measure = \"pga_uplift\"\nlevels = [0.5, 1.2, 6.0]\ntrust = false\nfree_swing = 0\n[records]\nfiles = [\"push.csv\"]\n\
        [scene.column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 0.8\n";
    folder.write("ida.toml", study);
    let told = folder.succeeds("ida ida.toml --out t.csv");
    let table = folder.table("t.csv");
    assert_eq!(table.texts("outcome"), ["no-uplift", "rocks", "not-determined"], "{table:?}");
    // Without companions, only the end of the run leaves a verdict open.
    assert_has(&told, &["\nnot determined: the column may be falling"]);
}

/// The figures of a table are those that the study drew; a damaged table of curves is refused, not left out of account.
#[test]
fn figures_have_the_bands_of_the_table_of_curves() {
    let folder = folder();
    study(&folder, &["--plot", "ida.svg", "--quiet"]);
    let (drawn, curves) = (folder.read("ida-fragility.svg"), folder.read("ida-fragility.csv"));
    folder.succeeds("plot ida.csv");
    assert_eq!(folder.read("ida-fragility.svg"), drawn);
    let header: Vec<&str> = curves.lines().next().expect("a header").split(',').collect();
    let place = |name: &str| header.iter().position(|own| *own == name).expect("a column");
    for (name, cell, told) in [
        ("confidence", "9", "row 1: confidence = 9 is out of range"),
        ("confidence", "nan", "row 1: confidence = NaN is out of range"),
        ("replicates", "9000000000000", "row 1: replicates = 9000000000000 are too many"),
        ("seed", "x", "row 1: `x` is no seed"),
        ("state", "fell", "row 1: `fell` is no limit state"),
        ("layout", "heaps", "row 1: `heaps` is no layout"),
        ("fit", "probit", "row 1: `probit` is no fit"),
    ] {
        let row = curves.lines().nth(1).expect("a row");
        let mut cells: Vec<&str> = row.splitn(header.len(), ',').collect();
        cells[place(name)] = cell;
        folder.write("ida-fragility.csv", curves.replacen(row, &cells.join(","), 1));
        folder.refused("plot ida.csv", &["ida-fragility.csv: ", told, "make it anew with `rocking fragility`"]);
    }
    let row = curves.lines().nth(1).expect("a row");
    folder.write("ida-fragility.csv", curves.replacen(row, &format!("{row}\n{row}"), 1));
    folder.refused("plot ida.csv", &["ida-fragility.csv: row 2: limit state `uplift` is there twice"]);
    folder.remove("ida-fragility.csv");
    folder.succeeds("plot ida.csv");
}
