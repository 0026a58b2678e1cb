//! What stands in the way of those who use the command line for the first time.

mod common;

use common::{rocking, succeeds};
use std::path::Path;

const BLOCK: &str = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.56\n[excitation.horizontal]\n";

/// A record that shakes strongly after 12 s.
const LATE: &str = "kind = \"record\"\ndt = 0.5\naccel = [0, 1, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, \
    6, 0, -6, 0, 0, 0]\n";

fn folder(scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("s.toml"), scene).expect("written");
    folder
}

fn summary(folder: &Path) -> serde_json::Value {
    let text = std::fs::read_to_string(folder.join("out/summary.json")).expect("written");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn a_run_without_an_end_goes_on_to_the_end_of_the_record_and_a_free_swing() {
    let folder = folder(&format!("{BLOCK}{LATE}"));
    succeeds(folder.path(), &["run", "s.toml"]);
    // The ground rests from the first of the last zeros on, 14 s, and 20/p = 9.4 s are less than 10 s.
    let own = summary(folder.path());
    assert_eq!(own["options"]["t_end"], 24.0);
    assert_eq!(own["truncated"], false);
    let text = succeeds(folder.path(), &["check", "s.toml"]);
    assert!(text.contains("solver.t_end = 24 s: the ground rests from 14 s on"), "{text}");
}

#[test]
fn a_run_that_cuts_its_record_says_so_and_not_that_the_column_stands() {
    let folder = folder(&format!("{BLOCK}{LATE}[solver]\nt_end = 5.0\n"));
    let output = rocking(folder.path(), &["run", "s.toml", "--report"]);
    let (told, warned) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(told.contains("not overturned up to t = 5 s") && !told.contains("stands"), "{told}");
    assert!(warned.contains("the ground motion is cut: it lasts until t = 14.0000 s"), "{warned}");
    assert_eq!(summary(folder.path())["truncated"], true);
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).expect("written");
    assert!(page.contains("<strong>not overturned</strong>") && !page.contains("<strong>stands</strong>"));
    // The same record to its end overturns the column.
    std::fs::write(folder.path().join("s.toml"), format!("{BLOCK}{LATE}")).expect("written");
    succeeds(folder.path(), &["run", "s.toml"]);
    assert_eq!(summary(folder.path())["status"], "overturned");
}

#[test]
fn a_run_that_ends_while_its_column_falls_does_not_say_that_it_stands() {
    let pulse = "kind = \"sine-pulse\"\namplitude_uplift = 4.0\nomega_p = 5.0\n[restitution]\neta = 0.9\n";
    for friction in ["", "friction = 0.9\n"] {
        // It overturns at t = 3.1 s.
        let folder = folder(&format!("{friction}{BLOCK}{pulse}[solver]\nt_end = 3.0\n"));
        let output = rocking(folder.path(), &["run", "s.toml", "--report"]);
        let (told, warned) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(told.contains("not determined; this run rocks; not overturned up to t = 3 s"), "{told}");
        assert!(told.contains("has the energy to overturn") && !told.contains("stands"), "{told}");
        assert!(warned.contains("past its balance, or with the energy to get there"), "{warned}");
        let own = summary(folder.path());
        assert_eq!((&own["may_overturn"], &own["truncated"]), (&true.into(), &true.into()));
        assert_eq!(own["trust"]["determined"], false);
        let page = std::fs::read_to_string(folder.path().join("out/report.html")).expect("written");
        assert!(
            page.contains("The verdict is <strong>not determined</strong>")
                && page.contains("has not overturned up to")
        );
        assert!(!page.contains("<strong>stands</strong>"));
    }
}

#[test]
fn a_motion_without_an_end_wants_one_of_its_run() {
    let harmonic = "kind = \"harmonic\"\namplitude_g = 0.3\nfrequency = 2\n";
    let folder = folder(&format!("{BLOCK}{harmonic}"));
    let output = rocking(folder.path(), &["run", "s.toml"]);
    let problem = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(problem.contains("solver.t_end") && problem.contains("no end"), "{problem}");
    std::fs::write(folder.path().join("s.toml"), format!("{BLOCK}{harmonic}[solver]\nt_end = 5.0\n")).expect("written");
    let output = rocking(folder.path(), &["run", "s.toml"]);
    assert!(output.status.success() && output.stderr.is_empty(), "no warning: it must be cut somewhere");
    assert!(String::from_utf8_lossy(&output.stdout).contains("the ground still moves"));
}

#[test]
fn rows_of_a_sweep_say_whether_they_are_cut() {
    let folder = folder(&format!("{BLOCK}{LATE}"));
    let sweep = "scene = \"s.toml\"\n[axes]\n\"solver.t_end\" = [5, 30]\nscale = [0.1, 1]\n";
    std::fs::write(folder.path().join("sweep.toml"), sweep).expect("written");
    let told = succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
    assert!(told.contains("2 run(s) are cut at solver.t_end"), "{told}");
    let table = std::fs::read_to_string(folder.path().join("t.csv")).expect("written");
    let ends: Vec<&str> = table.lines().map(|line| line.rsplit(',').nth(1).expect("a cell")).collect();
    assert_eq!(ends, ["truncated", "true", "true", "false", "false"], "{table}");
    // Without a given end it follows the start of the record from row to row.
    let sweep = "scene = \"s.toml\"\nask = \"peaks\"\n[axes]\nstart = [0, 100]\n";
    std::fs::write(folder.path().join("sweep.toml"), sweep).expect("written");
    succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
    let table = std::fs::read_to_string(folder.path().join("t.csv")).expect("written");
    assert_eq!(table.matches("overturns").count(), 2, "{table}");
}

/// Housner's block under a pulse that overturns it, as in textbooks.
const OVERTURNS: &str = "kind = \"sine-pulse\"\namplitude_uplift = 4\nomega_p = 5.0\n";

#[test]
fn a_textbook_block_that_overturns_is_valid_up_to_the_point_of_no_return() {
    let folder = folder(&format!("{BLOCK}{OVERTURNS}"));
    let output = rocking(folder.path(), &["run", "s.toml", "--report"]);
    assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    let own = summary(folder.path());
    assert_eq!((&own["outcome"], &own["status"]), (&"overturns".into(), &"overturned".into()));
    let (validity, fallen) = (&own["validity"], own["overturned_at"].as_f64().expect("a time"));
    let until = validity["until"].as_f64().expect("a time");
    assert!(until > 0.0 && until < fallen - 0.1, "{until} {fallen}");
    let contact = &validity["contacts"][0];
    let demand = contact["friction_demand"]["value"].as_f64().expect("finite");
    let whole = own["friction_demand"][0].as_f64().unwrap_or(f64::INFINITY);
    assert!(demand < 1.0 && whole > demand, "{demand} {whole}");
    let [t, theta] = ["t", "theta"].map(|key| contact["friction_demand"][key].as_f64().expect("a number"));
    let alpha = own["alpha"][0].as_f64().expect("a number");
    assert!(t <= until && theta.abs() <= alpha * 1.000001, "{t} {theta}");
    assert!(contact["min_normal_force"]["value"].as_f64().expect("finite") > 0.0);
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).expect("written");
    assert!(!page.contains("The model does not hold") && page.contains("point of no return"));
    // At the point of no return the block is balanced over its corner.
    let rows = std::fs::read_to_string(folder.path().join("out/response.csv")).expect("written");
    let angle =
        |row: &str| -> [f64; 2] { [0, 1].map(|at| row.split(',').nth(at).expect("a cell").parse().expect("a number")) };
    let beyond = rows.lines().skip(1).map(angle).filter(|[_, theta]| theta.abs() > alpha).map(|[t, _]| t);
    let first = beyond.fold(f64::INFINITY, f64::min);
    assert!(until <= first && until > first - 0.0101, "{until} {first}");
}

#[test]
fn durations_of_friction_demand_are_those_of_the_rows() {
    let free = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.56\n[initial]\ntheta = [0.2]\n[solver]\nt_end = 4\n[output]\ndt = 1e-4\n";
    let folder = folder(free);
    succeeds(folder.path(), &["run", "s.toml"]);
    let scene = rocking::Scene::from_toml(free, "s.toml".as_ref()).expect("valid");
    let response = rocking::simulate(&scene).expect("solved");
    let needs = &response.validity.as_ref().expect("forces are recorded").contacts[0];
    let demands = response.samples.iter().map(|row| {
        let force = &row.contact_forces(&scene.column)[0];
        (row.t, force.tangential.abs() / force.normal, row.theta[0])
    });
    let demands: Vec<(f64, f64, f64)> = demands.collect();
    for above in &needs.above {
        let time = 1e-4 * demands.iter().filter(|(_, demand, _)| *demand > above.coefficient).count() as f64;
        // Demands are linear between three places of a panel.
        assert!((above.time - time).abs() <= 0.02 * time + 0.002, "{above:?} {time}");
        assert!((above.share - above.time / 4.0).abs() < 1e-12);
    }
    let largest = demands.iter().fold((0.0, 0.0, 0.0), |most, own| if own.1 > most.1 { *own } else { most });
    let own = needs.friction_demand;
    assert!((own.value - largest.1).abs() < 1e-3 * largest.1, "{own:?} {largest:?}");
    assert!((own.t - largest.0).abs() < 2e-3 && (own.theta - largest.2).abs() < 2e-3, "{own:?} {largest:?}");
}

#[test]
fn sweeps_carry_what_contacts_need() {
    let folder = folder(&format!("{BLOCK}{OVERTURNS}"));
    let sweep = "scene = \"s.toml\"\nask = \"validity\"\n[axes]\namplitude_uplift = [0.5, 2, 4]\n";
    std::fs::write(folder.path().join("sweep.toml"), sweep).expect("written");
    succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
    let table = std::fs::read_to_string(folder.path().join("t.csv")).expect("written");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let place = |name: &str| rows[0].iter().position(|own| *own == name).expect("a column");
    let number = |row: usize, name: &str| rows[row][place(name)].parse::<f64>().expect("a number");
    assert!((1..4).all(|row| rows[row][place("valid")] == "true" && rows[row].len() == rows[0].len()), "{table}");
    // At rest the column asks for a / g = 0.5 tan α, and all of its weight presses.
    assert!((number(1, "mu_demand") - 0.5 * 0.4 / 1.56).abs() < 1e-3 && number(1, "min_normal") == 1.0, "{table}");
    assert!(number(3, "mu_demand") > number(2, "mu_demand") && number(3, "min_normal") < 1.0, "{table}");
    assert_eq!(number(3, "separations"), 0.0);
}

#[test]
fn run_and_sweep_have_one_vocabulary_and_one_unit() {
    let folder = folder(&format!("{BLOCK}kind = \"sine-pulse\"\namplitude_uplift = 2\nomega_p = 5.0\n"));
    let told = succeeds(folder.path(), &["run", "s.toml"]);
    let own = summary(folder.path());
    assert!(told.starts_with("rocks and stands") && told.contains("largest |θ|/α, base first: 0."), "{told}");
    std::fs::write(
        folder.path().join("sweep.toml"),
        "scene = \"s.toml\"\nask = \"peaks\"\n[axes]\neta = [1]\nlaw = [\"plastic\"]\n",
    )
    .expect("written");
    std::fs::write(folder.path().join("sweep.toml"), "scene = \"s.toml\"\nask = \"peaks\"\n[axes]\ngravity = [9.81]\n")
        .expect("written");
    succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
    let table = std::fs::read_to_string(folder.path().join("t.csv")).expect("written");
    let row: Vec<&str> = table.lines().nth(1).expect("a row").split(',').collect();
    assert_eq!((row[2], row[6].parse::<f64>().ok()), ("rocks", own["peaks"][0].as_f64()), "{table}");
    assert_eq!(own["outcome"], "rocks");
    let (alpha, p) = (own["alpha"][0].as_f64().expect("a number"), own["p"][0].as_f64().expect("a number"));
    assert!(
        (alpha - (0.4f64 / 1.56).atan()).abs() < 1e-15 && (p - (0.75 * 9.81 / 0.4f64.hypot(1.56)).sqrt()).abs() < 1e-12
    );
    assert_eq!(own["peak_theta"][0].as_f64().expect("a number") / alpha, own["peaks"][0].as_f64().expect("a number"));
}

#[test]
fn steps_of_axes_are_decimal_numbers() {
    let folder = folder(&format!("{BLOCK}{OVERTURNS}"));
    let axes =
        "[axes]\namplitude_uplift = { from = 0.1, to = 2.5, steps = 25 }\nstart = { from = -1, to = 1, steps = 21 }\n";
    std::fs::write(folder.path().join("sweep.toml"), format!("scene = \"s.toml\"\n{axes}")).expect("written");
    let sweep = rocking::Sweep::from_file(&folder.path().join("sweep.toml")).expect("valid");
    let texts = |axis: usize| sweep.axes[axis].values.iter().map(ToString::to_string).collect::<Vec<_>>();
    let expected =
        |from: i32, to: i32| (from..=to).map(|tenths| format!("{}", f64::from(tenths) / 10.0)).collect::<Vec<_>>();
    assert_eq!(texts(0), expected(1, 25));
    assert_eq!(texts(1), expected(-10, 10));
}

#[test]
fn a_column_of_any_kind_is_scaled_to_a_slenderness_and_a_size() {
    let drums = "[[block]]\ndiameter = 0.9\nheight = 1.0\nname = \"base\"\n[[block]]\nbottom_diameter = 0.8\ntop_diameter = 0.6\nheight = 1.2\ncentroid_height = 0.7\n\
        [[block]]\nwidth = 0.5\nheight = 0.4\nmass = 300\ninertia = 20\n";
    for (size, wanted) in [
        ("alpha = 0.2\np = 1.5", (Some(0.2), Some(1.5), None)),
        ("alpha = 0.15\nR = 4.0", (Some(0.15), None, Some(4.0))),
        ("p = 3.0", (None, Some(3.0), None)),
        ("alpha = 0.1\nrocking_period = 4.0", (Some(0.1), Some(std::f64::consts::TAU / 4.0), None)),
        ("alpha = 0.3", (Some(0.3), None, None)),
    ] {
        let scene = rocking::Scene::from_toml(&format!("{drums}[size]\n{size}\n"), "s.toml".as_ref()).expect("valid");
        let plain = rocking::Scene::from_toml(drums, "s.toml".as_ref()).expect("valid");
        let (own, before) = (scene.column.stack(0), plain.column.stack(0));
        let is = |value: f64, wanted: Option<f64>| wanted.is_none_or(|wanted| (value / wanted - 1.0).abs() < 1e-12);
        assert!(is(own.slenderness(), wanted.0.or(Some(before.slenderness()))), "{size}");
        assert!(is(own.frequency_parameter(), wanted.1) && is(own.radius(), wanted.2), "{size}");
        if (wanted.1, wanted.2) == (None, None) {
            assert!(is(own.radius(), Some(before.radius())), "{size}");
        }
        assert_eq!(scene.looks[0].name, "base");
    }
    let folder = folder(&format!("{BLOCK}{LATE}"));
    std::fs::write(folder.path().join("sweep.toml"), "scene = \"s.toml\"\n[axes]\nalpha = [0.1, 0.2]\np = [1, 2, 3]\n")
        .expect("written");
    let sweep = rocking::Sweep::from_file(&folder.path().join("sweep.toml")).expect("valid");
    let last = sweep.scene(5).expect("valid").column;
    assert!((last.slenderness() - 0.2).abs() < 1e-12 && (last.stack(0).frequency_parameter() - 3.0).abs() < 1e-12);
    let told = succeeds(folder.path(), &["check", "sweep.toml"]);
    assert!(
        told.contains("size.alpha: 2 value(s)") && told.contains("scenes of all points were read, and are valid"),
        "{told}"
    );
}

#[test]
fn widths_heights_and_diameters_are_twice_the_halves() {
    let read = |text: &str| rocking::Scene::from_toml(text, "s.toml".as_ref()).map_err(Box::new);
    let halves =
        read("[column]\nblocks = 3\nshape = \"drum\"\nhalf_width = 0.4\ntop_half_width = 0.3\nhalf_height = 1.5\n")
            .expect("valid");
    let wholes = read("[column]\nblocks = 3\ndiameter = 0.8\ntop_diameter = 0.6\nheight = 3.0\n").expect("valid");
    assert_eq!(halves.column, wholes.column);
    let problem = |text: &str| read(text).expect_err("refused").to_string();
    assert!(
        problem("[column]\nblocks = 1\nwidth = 1\nhalf_width = 1\nheight = 2\n")
            .contains("`half_width` is given as well")
    );
    assert!(
        problem("[column]\nblocks = 1\nshape = \"prism\"\ndiameter = 1\nheight = 2\n").contains("a prism has a width")
    );
    assert!(problem("[column]\nblocks = 1\nwidth = -1\nheight = 2\n").contains("above zero"));
}

#[test]
fn the_report_shows_round_blocks_as_round_and_names_them() {
    let folder = folder(
        "[[block]]\ndiameter = 0.8\nheight = 1.0\n[[block]]\nwidth = 0.7\nheight = 1.0\ndepth = 0.7\nname = \"capital\"\n[initial]\ntheta = [0.1, 0.1]\n",
    );
    succeeds(folder.path(), &["run", "s.toml", "--report"]);
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).expect("written");
    assert!(page.contains("\"round\":[true,false]") && page.contains("2 (capital)"));
}

#[test]
fn a_scene_is_read_from_standard_input() {
    use std::io::Write;
    let folder = folder("");
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_rocking"))
        .args(["run", "-", "--out", "o"])
        .current_dir(folder.path())
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .expect("started");
    child.stdin.take().expect("piped").write_all(format!("{BLOCK}{OVERTURNS}").as_bytes()).expect("written");
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success() && folder.path().join("o/summary.json").exists());
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("overturns at t = "));
}
