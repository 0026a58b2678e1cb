//! Sweeps: what their axes may be, and that rows are the runs of their scenes.

use crate::common::scenes::{BLOCK, OVERTURNS};
use crate::common::sweeps::{BASE, PULSE, SWEEP, folder, table};
use crate::common::{Folder, Row, Table, assert_has, failed};
use std::collections::BTreeSet;

/// Runs the sweep of the folder.
fn swept(folder: &Folder) -> Table {
    Table::of(&table(folder, ""))
}

/// Every row is what `rocking run` says of the scene with those values.
#[test]
fn rows_are_the_runs_of_their_scenes() {
    let folder = folder(SWEEP);
    let table = swept(&folder);
    let header = ["index", "column.blocks", "excitation.horizontal.omega_p", "excitation.horizontal.amplitude_g"];
    assert_eq!(table.columns()[..4], header);
    assert_eq!(table.len(), 60);
    let mut fates = BTreeSet::new();
    for row in table.rows().step_by(3) {
        let [_, blocks, omega, amplitude, outcome, impacts, block, t, truncated, error] = row.cells()[..] else {
            panic!("{row:?}")
        };
        let scene = BASE
            .replace("blocks = 2", &format!("blocks = {blocks}"))
            .replace("omega = 10.0", &format!("omega_p = {omega}"))
            .replace("amplitude = 3.0", &format!("amplitude_g = {amplitude}"));
        folder.write("one.toml", scene);
        let summary = folder.answers("run one.toml --json");
        assert_eq!(summary["status"] == "overturned", outcome == "overturns", "{row:?}");
        assert_eq!(error, "");
        assert_eq!(summary["truncated"].to_string(), truncated, "{row:?}");
        fates.insert(outcome);
        if outcome == "overturns" {
            assert_eq!(summary["impacts"].to_string(), impacts, "{row:?}");
            assert_eq!(summary["overturned_block"].to_string(), block);
            let at = summary["overturned_at"].as_f64().expect("a time");
            assert!((at - t.parse::<f64>().expect("a time")).abs() < 1e-6 * at, "{row:?}");
        } else {
            let has_moved = summary["peak_theta"].as_array().is_some_and(|peaks| peaks.iter().any(|peak| *peak != 0.0));
            assert_eq!(outcome == "rocks", has_moved, "{row:?}");
        }
    }
    assert_eq!(fates.len(), 3, "{fates:?}");
}

/// A sweep over one number says at which of its values the column is lost, whatever their order: in one interval, in several, nowhere.
#[test]
fn the_values_at_which_the_column_is_lost_are_named() {
    let of = |values: &str| {
        let folder = folder(&format!("scene = \"base.toml\"\n[axes]\namplitude_uplift = {values}\n"));
        folder.succeeds("sweep sweep.toml --out t.csv")
    };
    let key = "overturns or collapses at excitation.horizontal.amplitude_uplift";
    assert_has(
        &of("{ from = 1.0, to = 9.0, steps = 33 }"),
        &[&format!("{key} = 2.5 to 6, 6.75 to 9; what lies between")],
    );
    assert_has(&of("[9.0, 6.5, 1.0, 2.5]"), &[&format!("{key} = 2.5, 9; what lies between")]);
    assert!(!of("[1.0, 6.5]").contains("at excitation"));
}

/// Files of a folder stand in the order of the numbers in their names, as the records of a study.
#[test]
fn files_of_a_folder_are_in_the_order_of_their_numbers() {
    let folder = folder("scene = \"base.toml\"\n[axes]\nfile = { folder = \"records\" }\n");
    folder.write("base.toml", BASE.replace(PULSE, "kind = \"record\"\nfile = \"records/R6.csv\""));
    for name in ["R125", "R77", "R6"] {
        folder.write(&format!("records/{name}.csv"), "time,acceleration (m/s2)\n0.0,0.0\n0.1,1.0\n0.2,-1.0\n0.3,0.0\n");
    }
    folder.succeeds("sweep sweep.toml --out t.csv");
    let files = folder.table("t.csv");
    let names = ["records/R6.csv", "records/R77.csv", "records/R125.csv"];
    assert_eq!(files.texts("excitation.horizontal.file"), names);
}

#[test]
fn a_scene_that_fails_is_a_row_with_its_error() {
    // A key that some scenes know is no slip: others say so in their rows.
    let folder = folder(
        "scene = \"base.toml\"\n[axes]\nkind = [\"sine-pulse\", \"harmonic\", \"ricker\"]\nphase = [0.1, 0.2]\n",
    );
    folder.succeeds("sweep sweep.toml --out t.csv --json");
    let table = folder.table("t.csv");
    assert_eq!(table.texts("outcome"), ["error", "error", "rocks", "rocks", "error", "error"], "{table:?}");
    assert!(table.texts("error")[..2].iter().all(|error| error.contains("unknown")), "{table:?}");
    // As many columns of peaks as a column may have blocks.
    folder.write("sweep.toml", "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\nblocks = [2, 1000000000]\n");
    let table = swept(&folder);
    assert!(table.columns().len() < 120 && table.texts("error")[1].contains("1 to 100"), "{table:?}");
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\neta = [0.9, 1.5, 0.8]\n");
    let table = swept(&folder);
    assert_eq!(table.texts("outcome").iter().filter(|outcome| **outcome == "error").count(), 1);
    let error = table.texts("error")[1];
    assert!(error.contains("restitution.eta") && error.contains("0 to 1"), "{table:?}");
}

#[test]
fn peaks_are_asked_for_and_paired_axes_run_together() {
    let sweep = "scene = \"base.toml\"\ncombine = \"paired\"\nask = \"peaks\"\n[axes]\nomega_p = [2, 3, 4]\n[axes.excitation.horizontal]\namplitude_g = [0.3, 0.4, 0.5]\n";
    let folder = folder(sweep);
    let table = swept(&folder);
    assert_eq!(table.len(), 3);
    assert_eq!(table.columns()[7..], ["peak_1", "peak_2", "last_mode", "truncated", "error"]);
    folder
        .write("one.toml", BASE.replace("omega = 10.0", "omega_p = 4").replace("amplitude = 3.0", "amplitude_g = 0.5"));
    let summary = folder.answers("run one.toml --json");
    let alpha = 0.4f64.atan2(0.78);
    let expected = summary["peak_theta"][1].as_f64().expect("a number") / alpha;
    assert!((table.row(2).number("peak_2") / expected - 1.0).abs() < 1e-12, "{table:?}");
}

/// Records of a folder and seeds are axes like others.
#[test]
fn records_and_seeds_are_axes() {
    let folder = folder("scene = \"base.toml\"\n[axes]\nfile = { folder = \"records\" }\npga_g = [0.3, 0.6]\n");
    let put = |name: &str| folder.copy("scenes/records/synthetic.AT2", &format!("records/{name}"));
    put("a.AT2");
    put("b.AT2");
    folder.write("base.toml", BASE.replace(PULSE, "kind = \"record\"\nfile = \"records/a.AT2\""));
    let of_records = swept(&folder);
    assert_eq!(of_records.len(), 4);
    let results = |row: usize| of_records.row(row).cells()[3..].to_vec();
    assert_eq!(results(0), results(2), "the same record gives the same row");
    // Velocities that a database gives beside are left out; a vertical component does not shake the base sideways.
    put("a.VT2");
    assert_eq!(swept(&folder), of_records);
    put("RSN1_A-UP.AT2");
    folder.refused("sweep sweep.toml --out t.csv", &["RSN1_A-UP.AT2", "excitation.station"]);
    folder.refused("run sweep.toml --out out", &["`rocking sweep`"]);
    folder.write("base.toml", BASE.replace(PULSE, "kind = \"synthetic\"\npga_g = 0.5"));
    folder.write("sweep.toml", "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\nseed = { from = 1, to = 50 }\n");
    let table = swept(&folder);
    let peaks: BTreeSet<&str> = table.texts("peak_1").into_iter().collect();
    assert!(!table.texts("outcome").contains(&"error"), "whole numbers are whole: {table:?}");
    assert_eq!((table.len(), peaks.len()), (50, 50), "each seed its own: {table:?}");
}

#[test]
fn bad_sweeps_name_file_line_key_and_remedy() {
    for (sweep, named) in [
        ("[axes]\neta = [0.5]\n", vec!["sweep.toml", "`scene`", "missing", "base.toml"]),
        ("scene = \"none.toml\"\n[axes]\neta = [0.5]\n", vec!["none.toml"]),
        ("scene = \"base.toml\"\n", vec!["`axes`", "missing"]),
        ("scene = \"base.toml\"\n[axes]\n", vec!["`axes`", "no axis"]),
        ("scene = \"base.toml\"\n[axes]\neta = []\n", vec!["line 3", "no values"]),
        ("scene = \"base.toml\"\n[axes]\neta = { from = 0.1, to = 0.9 }\n", vec!["line 3", "steps"]),
        (
            "scene = \"base.toml\"\n[axes]\neta = { from = 0, to = 1, steps = 0 }\n",
            vec!["line 3", "`axes.eta.steps`", "0 is out of range", "from 1 to 1e7"],
        ),
        ("scene = \"base.toml\"\n[axes]\neta = { from = 0, to = 1, steps = 3, scale = \"log\" }\n", vec!["zero"]),
        (
            "scene = \"base.toml\"\n[axes]\neta = { from = 0, to = 1, steps = 3, scale = \"lag\" }\n",
            vec!["did you mean `log`"],
        ),
        ("scene = \"base.toml\"\ncombine = \"paired\"\n[axes]\neta = [0.5]\nomega = [1, 2]\n", vec!["equally long"]),
        ("scene = \"base.toml\"\nask = \"peak\"\n[axes]\neta = [0.5]\n", vec!["did you mean `peaks`"]),
        (
            "scene = \"base.toml\"\n[axes]\nfile = { folder = \"nowhere\" }\n",
            vec!["nowhere", "relative to the base scene"],
        ),
        ("scene = \"base.toml\"\n[axes]\neta = [0.5]\n[axis]\n", vec!["`axis`", "did you mean `axes`?"]),
        // Every row would say so.
        (
            "scene = \"base.toml\"\n[axes]\neta = [0.5]\namplitud_g = [0.5, 0.7]\n",
            vec![
                "sweep.toml",
                "line 4",
                "horizontal.amplitud_g",
                "base.toml",
                "unknown",
                "did you mean `amplitude_g`?",
            ],
        ),
        (
            "scene = \"base.toml\"\n[axes]\nkind = [\"sine-pulse\", \"ricker\"]\nphase = [0.1]\n",
            vec!["line 4", "horizontal.phase", "unknown"],
        ),
        (
            "scene = \"base.toml\"\n[axes]\nvelocity = [0.5, 0.7]\n",
            vec!["line 2", "`axes`", "`excitation.horizontal.amplitude` of base.toml", "missing"],
        ),
        ("scene = \"base.toml\"\n[axes]\n\"title.x\" = [1, 2]\n", vec!["line 3", "`title` of base.toml"]),
        ("scene = \"base.toml\"\n[axes]\n\"solvr.rtol\" = [1e-5, 1e-6]\n", vec!["line 3", "did you mean `solver`?"]),
        (
            "scene = \"base.toml\"\n[axes]\n\"block[2].mass\" = [1.0]\n",
            vec!["line 3", "no such table", "initial.theta[1]"],
        ),
        ("scene = \"base.toml\"\n[axes]\n\"initial.theta[1]\" = [0.1]\n", vec!["line 3", "no such table or list"]),
        ("scene = \"base.toml\"\n[axes]\nomega = [1]\neta = {}\n", vec!["line 4", "no values"]),
        (
            "scene = \"base.toml\"\n[axes]\neta = { from = 0.1, to = 0.9, steps = 1 }\n",
            vec!["`axes.eta.steps`", "both ends"],
        ),
        ("scene = \"base.toml\"\n[axes]\neta = [0.1, nan]\n", vec!["line 3", "item 2 of the list is NaN"]),
        (
            "scene = \"base.toml\"\n[axes]\nblock[2].mass = [0.1]\n",
            vec!["line 3", "a key with brackets stands in quotes"],
        ),
        ("scene = \"base.toml\"\n[axes]\n\"block[1].mass\" = [1.0]\n", vec!["line 3", "no such table"]),
        ("scene = \"base.toml\"\n[axes]\n\"block[2].mass\" = 0,1\n", vec!["line 3", "decimals have a point"]),
        // One would take the place of the other.
        (
            "scene = \"base.toml\"\n[axes]\namplitude_g = [0.5]\namplitude_uplift = [2, 3]\n",
            vec!["line 4", "`excitation.horizontal.amplitude_g` is an axis as well", "remove one"],
        ),
        ("scene = \"base.toml\"\n[axes]\neta = [0.5]\n\"restitution.eta\" = [0.7]\n", vec!["line 4", "axis as well"]),
        (
            "scene = \"base.toml\"\n[axes]\nfriction = [0.5]\n\"friction.static\" = [0.7]\n",
            vec!["line 4", "`friction` is an axis as well"],
        ),
        (
            "scene = \"base.toml\"\n[axes]\n\"friction.kinetic\" = [0.2]\nfriction = [0.7]\n",
            vec!["line 4", "`friction.kinetic` is an axis as well"],
        ),
    ] {
        let folder = folder(sweep);
        failed(&folder.rocking("sweep sweep.toml --out t.csv"), 2, sweep, &named);
        assert_eq!(folder.names(""), ["base.toml", "sweep.toml"], "something was written for {sweep}");
    }
}

/// An item of a list is a key: each row is the run of its scene.
#[test]
fn items_of_lists_are_axes() {
    let folder = folder(
        "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\n\"theta[2]\" = [0.05, 0.1]\n\"omega[1]\" = [0.0, 0.2]\n",
    );
    let base = |theta: &str, omega: &str| {
        format!("[initial]\ntheta = [0.01, {theta}]\nomega = [{omega}, 0.0]\n")
            + &BASE.replace("omega = 10.0", "period = 0.6")
    };
    folder.write("base.toml", base("0.0", "0.0"));
    let table = swept(&folder);
    assert_eq!(table.columns()[1..3], ["initial.theta[2]", "initial.omega[1]"]);
    assert_eq!(table.len(), 4);
    for row in table.rows() {
        folder.write("one.toml", base(row.text("initial.theta[2]"), row.text("initial.omega[1]")));
        let summary = folder.answers("run one.toml --json");
        let peak = summary["peak_theta"][1].as_f64().expect("a number") / 0.4f64.atan2(0.78);
        assert!((row.number("peak_2") / peak - 1.0).abs() < 1e-12, "{row:?}");
    }
}

/// A key of a scene with both components, or with a list of the same name, says of which it is.
#[test]
fn keys_that_may_be_one_of_several_are_refused() {
    let vertical = "[excitation.vertical]\nkind = \"harmonic\"\namplitude_g = 0.2\nfrequency = 2.0\n";
    let base = BASE.replace("omega = 10.0", "period = 0.6") + "[initial]\nomega = [0.0, 0.1]\n" + vertical;
    let folder = Folder::with("base.toml", &base);
    for (axis, is_clear) in [
        ("amplitude_g = [0.1]", false),
        ("omega = [1.0]", false),
        ("amplitude = [1.0]", true),
        ("period = [1.0]", true),
        ("\"omega[1]\" = [1.0]", true),
        ("\"excitation.horizontal.amplitude_g\" = [0.1]", true),
    ] {
        folder.write("sweep.toml", format!("scene = \"base.toml\"\n[axes]\n{axis}\n"));
        let output = folder.rocking("sweep sweep.toml --out t.csv");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.success(), is_clear, "{axis}: {message}");
        assert_eq!(message.contains("one of several keys"), !is_clear, "{axis}: {message}");
        let own = axis.split(' ').next().expect("a key");
        assert_eq!(message.contains(&format!("{own}\"\n")) && message.contains("e.g. \""), !is_clear, "{message}");
    }
}

#[test]
fn axes_are_in_the_order_of_the_file_and_round_numbers_are_round() {
    let sweep = "scene = \"base.toml\"\n[axes]\n\
        excitation.horizontal.omega_p = { from = 0.1, to = 10, steps = 3, scale = \"log\" }\n\
        blocks = { from = 1, to = 4, steps = 3, scale = \"log\" }\n\
        excitation.horizontal.amplitude_g = [0.1]\n";
    let folder = folder(sweep);
    let table = swept(&folder);
    let axes = ["excitation.horizontal.omega_p", "column.blocks", "excitation.horizontal.amplitude_g"];
    assert_eq!(table.columns()[1..4], axes);
    assert_eq!(table.texts(axes[0]), ["0.1", "0.1", "0.1", "1", "1", "1", "10", "10", "10"]);
    assert_eq!(table.texts(axes[1])[..3], ["1", "2", "4"]);
    for (axis, expected) in [
        ("amplitude = { from = 1e-4, to = 1e3, steps = 8", "0.0001,0.001,0.01,0.1,1,10,100,1000"),
        ("rtol = { from = 1e-12, to = 1e-9, steps = 4", "1e-12,1e-11,1e-10,1e-9"),
        ("overturn_angle = { from = 0.1, to = 1.5, steps = 3", "0.1,0.3872983346207417,1.5"),
    ] {
        folder.write(
            "sweep.toml",
            format!("scene = \"base.toml\"\n[axes]\n{axis}, scale = \"log\" }}\n[axes.solver]\n# none\n"),
        );
        let table = swept(&folder);
        assert_eq!(table.texts(table.columns()[1]).join(","), expected);
    }
}

/// What the README shows is a sweep, with its axes shortened.
#[test]
fn the_sweep_of_the_readme_runs() {
    let readme = include_str!("../../README.md");
    let sweep = readme
        .split("```toml\n")
        .map(|part| part.split("```").next().unwrap_or(""))
        .find(|text| text.contains("[axes]"));
    let sweep = sweep.expect("the README shows a sweep").replace("steps = 100", "steps = 2");
    let folder = folder(&sweep);
    let table = swept(&folder);
    assert_eq!(table.len(), 16);
    assert!(!table.texts("outcome").contains(&"error"), "{table:?}");
}

/// Slabs that slide, and drums that rock; the rows are what `rocking run` says of the scenes.
#[test]
fn friction_is_an_axis_and_residual_slides_are_asked_for() {
    let sweep = "scene = \"base.toml\"\nask = \"slides\"\n[axes]\nfriction = [0.2, 0.4, 2.5]\nhalf_width = [0.4, 1.0]\namplitude_g = [0.1, 0.6, 3.0]\n";
    let folder = folder(sweep);
    let table = swept(&folder);
    let axes = ["friction", "column.half_width", "excitation.horizontal.amplitude_g"];
    assert_eq!(table.columns()[1..4], axes);
    assert_eq!(
        table.columns()[8..],
        ["peak_1", "peak_2", "last_mode", "residual_slide_1", "residual_slide_2", "truncated", "error"]
    );
    let mut fates = BTreeSet::new();
    for row in table.rows() {
        let [friction, half_width, amplitude] = axes.map(|axis| row.text(axis));
        let scene = BASE
            .replace("half_width = 0.4", &format!("half_width = {half_width}"))
            .replace("amplitude = 3.0", &format!("amplitude_g = {amplitude}"));
        folder.write("one.toml", format!("friction = {friction}\n{scene}"));
        let summary = folder.answers("run one.toml --json");
        for interface in 1..=2 {
            let residual = summary["sliding"]["residual_slide"][interface - 1].as_f64().expect("a number");
            let slide = row.number(&format!("residual_slide_{interface}"));
            // Rows of a response do not change the motion.
            assert!((slide - residual).abs() <= 1e-9 * residual.abs().max(1e-3), "{row:?}, {residual}");
        }
        let status = match row.text("outcome") {
            "overturns" => "overturned",
            "collapses" => "collapsed",
            "undetermined" => "undetermined",
            _ => "",
        };
        assert!(status.is_empty() || summary["status"] == status, "{row:?}");
        fates.insert(row.text("outcome"));
    }
    assert!(["no-uplift", "slides", "rocks", "overturns"].iter().all(|fate| fates.contains(*fate)), "{fates:?}");
    // Static and kinetic coefficients by their own names.
    let base = format!("friction = {{ static = 0.5, kinetic = 0.3 }}\n{BASE}");
    folder.write("base.toml", base);
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\nkinetic = [0.3, 0.4, 0.6]\n");
    swept(&folder);
    let text = folder.read("t.csv");
    assert!(text.starts_with("index,friction.kinetic,outcome") && text.contains("static"), "{text}");
}

#[test]
fn residual_slides_of_scenes_without_friction_are_refused() {
    let folder = folder("scene = \"base.toml\"\nask = \"slides\"\n[axes]\nomega_p = [2, 3]\n");
    let named = ["sweep.toml", "line 2", "`ask`", "without friction", "let friction be an axis"];
    folder.refused("sweep sweep.toml", &named);
}

/// What no row could answer is refused: validity with friction, from the base scene or an axis.
#[test]
fn validity_of_scenes_with_friction_is_refused() {
    let folder = folder("scene = \"base.toml\"\nask = \"validity\"\n[axes]\nfriction = [0.3, 0.5]\n");
    folder.refused("sweep sweep.toml", &["sweep.toml", "line 2", "`ask`", "with friction", "slides"]);
}

/// `friction = 0.5` of a base scene is short for a static coefficient: an axis may change that, or add a kinetic one.
#[test]
fn coefficients_of_friction_are_axes_over_the_short_form() {
    let outcomes = |base: &str, axes: &str| {
        let folder = folder(&format!("scene = \"base.toml\"\nask = \"slides\"\n[axes]\n{axes}"));
        folder.write("base.toml", format!("{base}\n{BASE}"));
        let cells = |row: Row| row.cells()[2..].iter().map(ToString::to_string).collect::<Vec<_>>();
        swept(&folder).rows().map(cells).collect::<Vec<_>>()
    };
    let long = outcomes("friction = { static = 0.5, kinetic = 0.2 }", "friction.static = [0.3, 0.4]\n");
    assert!(long.iter().all(|row| row[0] != "error"), "{long:?}");
    let of_static = outcomes("friction = 0.5", "\"friction.static\" = [0.3, 0.4]\n");
    assert_eq!(of_static, outcomes("friction = 0.5", "friction = [0.3, 0.4]\n"));
    assert_ne!(of_static, long);
    let of_kinetic = outcomes("friction = 0.5", "\"friction.kinetic\" = [0.2, 0.3]\n");
    assert_eq!(of_kinetic, outcomes("friction = { static = 0.5 }", "\"friction.kinetic\" = [0.2, 0.3]\n"));
}

/// Components of the other direction are refused by the names of their files; documents in a folder are no records.
#[test]
fn folders_of_files_hold_components_of_one_direction() {
    let folder = folder("scene = \"base.toml\"\n[axes]\n\"excitation.vertical.file\" = { folder = \"records\" }\n");
    folder.write("base.toml", "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.vertical]\nkind = \"record\"\nfile = \"records/A_UP.csv\"\n");
    let put = |name: &str, text: &str| folder.write(&format!("records/{name}"), text);
    put("A_UP.csv", "t [s],a [m/s2]\n0,0\n0.1,1\n0.2,0\n");
    put("README.md", "where the records are from");
    put("_SearchResults.csv", "the list of the database");
    put("readme.txt", "the same");
    let text = table(&folder, "");
    assert!(text.lines().count() == 2 && text.contains("A_UP.csv"), "{text}");
    put("A_EW.csv", "t [s],a [m/s2]\n0,0\n0.1,1\n0.2,0\n");
    folder.refused("sweep sweep.toml", &["A_EW.csv is a horizontal component"]);
}

#[test]
fn a_sweep_without_any_result_fails_with_the_first_reason() {
    let folder = folder("scene = \"base.toml\"\n[axes]\neta = [1.5, 2.5]\n");
    for arguments in ["sweep sweep.toml", "sweep sweep.toml --quiet", "sweep sweep.toml --json"] {
        folder.fails(1, arguments, &["sweep.csv", "none of the 2 point(s)", "restitution.eta", "1.5"]);
    }
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\neta = [1.5, 0.9]\n");
    assert!(folder.succeeds("sweep sweep.toml").contains("errors 1"));
    // A table of errors does not take its place.
    let earlier = folder.read("sweep.csv");
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\neta = [1.5, 2.5]\n");
    folder.fails(1, "sweep sweep.toml", &["none of the 2 point(s)", "left as it was"]);
    assert_eq!(folder.read("sweep.csv"), earlier);
    assert_eq!(folder.names(""), ["base.toml", "sweep.csv", "sweep.toml"]);
}

/// Shards of errors make a table of errors; no picture of one says that nothing overturns.
#[test]
fn errors_alone_are_merged_with_a_failure_and_not_drawn() {
    let folder = folder("scene = \"base.toml\"\n[axes]\neta = [1.5, 2.5]\n");
    for shard in [1, 2] {
        folder.fails(1, &format!("sweep sweep.toml --out {shard}.csv --shard {shard}/2"), &["none of the 1 point(s)"]);
    }
    folder.fails(1, "merge all.csv 1.csv 2.csv", &["all.csv: none of the 2 point(s)", "restitution.eta", "1.5"]);
    assert_eq!(folder.read("all.csv").lines().count(), 3);
    folder.refused("plot all.csv", &["all.csv: none of its 2 run(s) has a result"]);
    folder.fails(1, "sweep sweep.toml --plot picture.svg", &["none of the 2 point(s)"]);
    assert!(!folder.has("all.svg") && !folder.has("picture.svg"));
    // Shards of which one has a result are merged, with the numbers of all.
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\neta = [1.5, 0.9]\n");
    folder.fails(1, "sweep sweep.toml --out 1.csv --shard 1/2", &["left as it was"]);
    folder.remove("1.csv");
    folder.fails(1, "sweep sweep.toml --out 1.csv --shard 1/2", &["none of the 1 point(s)"]);
    folder.remove("2.csv");
    folder.succeeds("sweep sweep.toml --out 2.csv --shard 2/2");
    let told = folder.succeeds("merge all.csv 1.csv 2.csv --sweep sweep.toml");
    assert!(told.contains("errors 1") && told.contains("wrote 2 row(s) of 2 table(s)"), "{told}");
    // Errors alone do not take its place.
    let kept = folder.read("all.csv");
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\neta = [1.5, 2.5]\n");
    for shard in [1, 2] {
        folder.fails(1, &format!("sweep sweep.toml --out e{shard}.csv --shard {shard}/2"), &["none of the 1 point(s)"]);
    }
    folder.fails(1, "merge all.csv e1.csv e2.csv", &["all.csv: none of the 2 point(s)", "left as it was"]);
    assert_eq!(folder.read("all.csv"), kept);
}

/// The first point and the last one have faults of their own, which hide the unknown key.
#[test]
fn an_unknown_key_is_refused_whatever_else_is_wrong() {
    let folder = folder("scene = \"base.toml\"\n[axes]\nseed = [1, 2]\neta = [1.5, 0.9, 2.5]\n");
    folder.refused("sweep sweep.toml", &["sweep.toml, line 3", "`axes.excitation.horizontal.seed`", "unknown"]);
    assert!(!folder.has("sweep.csv"));
}

#[test]
fn a_value_is_given_once() {
    let folder = folder("scene = \"base.toml\"\n[axes]\neta = [0.8, 0.9, 0.8]\n");
    folder.refused("sweep sweep.toml", &["line 3", "`axes.eta`", "0.8 is there twice", "give each value once"]);
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\neta = { from = 0.8, to = 0.8, steps = 3 }\n");
    folder.refused("sweep sweep.toml", &["line 3", "`axes.eta`", "all its values are 0.8", "give different ends"]);
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\neta = { from = 0.8, to = 0.8, steps = 3, bogus = 1 }\n");
    folder.refused("sweep sweep.toml", &["line 3", "bogus", "unknown"]);
    folder.write(
        "sweep.toml",
        "scene = \"base.toml\"\ncombine = \"paired\"\n[axes]\neta = [0.8, 0.8]\nomega = [9.0, 11.0]\n",
    );
    folder.succeeds("sweep sweep.toml");
}

/// Standard error that cannot be written loses no result and is no panic.
#[test]
#[cfg(target_os = "linux")]
fn a_full_standard_error_stops_nothing() {
    let folder = folder("scene = \"base.toml\"\n[axes]\nzork = [1, 2]\n");
    folder.write("warned.toml", format!("{BASE}[output]\ndt = 0.1\n").replace("t_end = 6.0", "t_end = 0.3"));
    let full = || std::fs::File::options().write(true).open("/dev/full").expect("a device of Linux");
    let status = |arguments: &str| folder.command(arguments).stderr(full()).status().expect("it runs").code();
    assert_eq!(status("sweep sweep.toml"), Some(2));
    assert!(folder.says("run warned.toml --out warned").1.contains("warning: "));
    assert_eq!(status("run warned.toml --out warned --report --plots"), Some(0));
    assert!(folder.has("warned/report.html"));
}

#[test]
fn an_unreadable_record_does_not_switch_off_the_check_for_unknown_keys() {
    let axes =
        |key: &str| format!("scene = \"base.toml\"\n[axes]\nfile = {{ folder = \"records\" }}\n{key} = [0.3, 0.6]\n");
    let folder = folder(&axes("pga_gg"));
    folder.copy("scenes/records/synthetic.AT2", "records/b.AT2");
    folder.write("records/a.txt", "no record\n");
    folder.write("base.toml", BASE.replace(PULSE, "kind = \"record\"\nfile = \"records/b.AT2\""));
    folder.refused("sweep sweep.toml", &["sweep.toml, line 4", "pga_gg", "unknown"]);
    // As well where the last point has the record.
    folder.write("records/c.txt", "no record\n");
    for arguments in ["sweep sweep.toml", "check sweep.toml"] {
        folder.refused(arguments, &["sweep.toml, line 4", "pga_gg", "unknown"]);
    }
    folder.remove("records/c.txt");
    assert!(!folder.has("sweep.csv"));
    folder.write("sweep.toml", axes("pga_g"));
    let told = folder.succeeds("sweep sweep.toml");
    assert_has(&told, &["errors 2", "the first error: "]);
}

#[test]
fn impacts_are_blank_where_a_run_ends_when_its_outcome_is_certain() {
    for (ask, overturns, rocks) in [("outcome", true, false), ("overturns", false, false), ("peaks", true, true)] {
        let folder = folder(&format!("ask = \"{ask}\"\n{SWEEP}"));
        let mut seen = 0;
        for row in swept(&folder).rows() {
            let counted = match row.text("outcome") {
                "no-uplift" => true,
                "rocks" => rocks,
                _ => overturns,
            };
            seen += usize::from(row.text("outcome") != "no-uplift");
            assert_eq!(counted, !row.text("impacts").is_empty(), "{ask}: {row:?}");
        }
        assert!(seen > 10);
        folder.succeeds("plot t.csv");
        let figure = folder.read("t.svg");
        assert_eq!(figure.contains("overturns (impacts not counted)"), !overturns);
    }
}

/// The line of the base scene has a sound value: the one at fault stands on the axis.
#[test]
fn a_value_of_an_axis_is_not_blamed_on_the_base_scene() {
    let folder = folder("scene = \"base.toml\"\n[axes]\neta = [0.9, 1.5]\n");
    folder.succeeds("sweep sweep.toml --out t.csv");
    let table = folder.read("t.csv");
    assert!(table.contains("axis `restitution.eta`: 1.5 is out of range") && !table.contains("base.toml"), "{table}");
    let told = folder.succeeds("check sweep.toml");
    assert!(told.contains("point 1: axis `restitution.eta`: 1.5 is out of range"), "{told}");
    folder.refused("sweep sweep.toml --out t.xlsx", &["t.xlsx", "CSV or Parquet"]);
    // Nor is the line of a record that is there; paths of an axis are relative to the base scene.
    folder.write("sub/shaken.toml", format!("{BLOCK}kind = \"record\"\nfile = \"a.AT2\"\n"));
    folder.copy("scenes/records/synthetic.AT2", "sub/a.AT2");
    folder.copy("scenes/records/synthetic.AT2", "b.AT2");
    folder.write("files.toml", "scene = \"sub/shaken.toml\"\n[axes]\nfile = [\"a.AT2\", \"b.AT2\"]\n");
    folder.succeeds("sweep files.toml --out f.csv");
    let error = folder.table("f.csv").row(1).text("error").to_string();
    let told = ["axis `excitation.horizontal.file`: sub/b.AT2: ", "relative to sub/shaken.toml"];
    assert!(told.iter().all(|part| error.contains(part)) && !error.contains("line"), "{error}");
}

#[test]
fn run_and_sweep_have_one_vocabulary_and_one_unit() {
    let folder =
        Folder::with("s.toml", &format!("{BLOCK}kind = \"sine-pulse\"\namplitude_uplift = 2\nomega_p = 5.0\n"));
    let told = folder.succeeds("run s.toml");
    let own = folder.summary();
    assert!(told.starts_with("rocks and stands") && told.contains("largest |θ|/α, base first: 0."), "{told}");
    folder.write("sweep.toml", "scene = \"s.toml\"\nask = \"peaks\"\n[axes]\ngravity = [9.81]\n");
    folder.succeeds("sweep sweep.toml --out t.csv");
    let table = folder.table("t.csv");
    let row = table.row(0);
    assert_eq!((row.text("outcome"), Some(row.number("peak_1"))), ("rocks", own["peaks"][0].as_f64()), "{row:?}");
    assert_eq!(own["outcome"], "rocks");
    let (alpha, p) = (own["alpha"][0].as_f64().expect("a number"), own["p"][0].as_f64().expect("a number"));
    assert!(
        (alpha - (0.4f64 / 1.56).atan()).abs() < 1e-15 && (p - (0.75 * 9.81 / 0.4f64.hypot(1.56)).sqrt()).abs() < 1e-12
    );
    assert_eq!(own["peak_theta"][0].as_f64().expect("a number") / alpha, own["peaks"][0].as_f64().expect("a number"));
}

#[test]
fn steps_of_axes_are_decimal_numbers() {
    let folder = Folder::with("s.toml", &format!("{BLOCK}{OVERTURNS}"));
    let axes =
        "[axes]\namplitude_uplift = { from = 0.1, to = 2.5, steps = 25 }\nstart = { from = -1, to = 1, steps = 21 }\n";
    folder.write("sweep.toml", format!("scene = \"s.toml\"\n{axes}"));
    let sweep = rocking::Sweep::from_file(&folder.path("sweep.toml")).expect("valid");
    let texts = |axis: usize| sweep.axes[axis].values.iter().map(ToString::to_string).collect::<Vec<_>>();
    let expected =
        |from: i32, to: i32| (from..=to).map(|tenths| format!("{}", f64::from(tenths) / 10.0)).collect::<Vec<_>>();
    assert_eq!(texts(0), expected(1, 25));
    assert_eq!(texts(1), expected(-10, 10));
}

/// The depth of a block serves its density, which a mass replaces.
#[test]
fn a_mass_replaces_density_and_depth() {
    let base = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\ndensity = 2000\ndepth = 0.5\n[initial]\ntheta = [0.1]\n";
    let folder = Folder::with("base.toml", base);
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\nmass = [100, 200]\n");
    folder.succeeds("sweep sweep.toml");
    folder.write("sweep.toml", "scene = \"base.toml\"\n[axes]\ndensity = [1000, 2500]\n");
    folder.succeeds("sweep sweep.toml");
}

/// Titles that look like numbers are titles: shards of a sweep over them belong to it.
#[test]
fn shards_over_texts_that_look_like_numbers_are_merged() {
    let folder = Folder::new();
    folder.write("base.toml", "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.horizontal]\nkind = \"half-sine\"\namplitude = 3.0\nomega = 5.0\n");
    folder.write(
        "sweep.toml",
        "scene = \"base.toml\"\n[axes]\ntitle = [\"001\", \"1.0\", \"1e3\", \"NA\"]\nomega = [1.0, 2.5, 1e-5]\n",
    );
    folder.succeeds("sweep sweep.toml --out whole.csv");
    for part in 1..=2 {
        folder.succeeds(&format!("sweep sweep.toml --shard {part}/2 --out {part}.csv"));
    }
    folder.succeeds("merge merged.csv 1.csv 2.csv --sweep sweep.toml");
    assert_eq!(folder.read("merged.csv"), folder.read("whole.csv"));
    assert!(folder.read("whole.csv").contains("\n3,1.0,"), "{}", folder.read("whole.csv"));
    // Runs of a sweep have no rows, which would be too many at the last frequency, on whatever thread a point comes first.
    folder.succeeds("sweep sweep.toml --shard 3/12 --out alone.csv");
    let alone = folder.read("alone.csv");
    assert!(
        alone.contains("\n2,001,1e-5,overturns,") && folder.read("whole.csv").contains("\n2,001,1e-5,overturns,"),
        "{alone}"
    );
}
