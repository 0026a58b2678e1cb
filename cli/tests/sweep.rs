//! Sweeps: what their axes may be, and that rows are the runs of their scenes.

mod common;

use common::sweeps::{BASE, SWEEP, folder, table};

fn rows(text: &str) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    reader.records().map(|row| row.expect("CSV").iter().map(String::from).collect()).collect()
}

/// Every row is what `rocking run` says of the scene with those values.
#[test]
fn rows_are_the_runs_of_their_scenes() {
    let folder = folder(SWEEP);
    let text = table(folder.path(), &[]);
    let rows = rows(&text);
    let header = ["index", "column.blocks", "excitation.horizontal.omega_p", "excitation.horizontal.amplitude_g"];
    assert_eq!(rows[0][..4], header);
    assert_eq!(rows.len(), 61);
    let mut fates = std::collections::BTreeSet::new();
    for row in rows[1..].iter().step_by(3) {
        let [_, blocks, omega, amplitude, outcome, impacts, block, t, truncated, error] = &row[..] else {
            panic!("{row:?}")
        };
        let scene = BASE
            .replace("blocks = 2", &format!("blocks = {blocks}"))
            .replace("omega = 10.0", &format!("omega_p = {omega}"))
            .replace("amplitude = 3.0", &format!("amplitude_g = {amplitude}"));
        std::fs::write(folder.path().join("one.toml"), scene).expect("written");
        let summary = common::succeeds(folder.path(), &["run", "one.toml", "--json"]);
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        assert_eq!(summary["status"] == "overturned", outcome == "overturns", "{row:?}");
        assert_eq!(error, "");
        assert_eq!(summary["truncated"].to_string(), *truncated, "{row:?}");
        fates.insert(outcome.clone());
        if outcome == "overturns" {
            assert_eq!(summary["impacts"].to_string(), *impacts, "{row:?}");
            assert_eq!(summary["overturned_block"].to_string(), *block);
            let at = summary["overturned_at"].as_f64().expect("a time");
            assert!((at - t.parse::<f64>().expect("a time")).abs() < 1e-6 * at, "{row:?}");
        } else {
            let has_moved = summary["peak_theta"].as_array().is_some_and(|peaks| peaks.iter().any(|peak| *peak != 0.0));
            assert_eq!(outcome == "rocks", has_moved, "{row:?}");
        }
    }
    assert_eq!(fates.len(), 3, "{fates:?}");
}

#[test]
fn a_scene_that_fails_is_a_row_with_its_error() {
    // A key that some scenes know is no slip: others say so in their rows.
    let folder = folder(
        "scene = \"base.toml\"\n[axes]\nkind = [\"sine-pulse\", \"harmonic\", \"ricker\"]\nphase = [0.1, 0.2]\n",
    );
    let output = common::rocking(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv", "--json"]);
    assert!(output.status.success());
    let text = std::fs::read_to_string(folder.path().join("t.csv")).expect("written");
    let outcomes: Vec<String> = rows(&text)[1..].iter().map(|row| row[3].clone()).collect();
    assert_eq!(outcomes, ["error", "error", "rocks", "rocks", "error", "error"], "{text}");
    assert!(rows(&text)[1..3].iter().all(|row| row[8].contains("unknown")), "{text}");
    // As many columns of peaks as a column may have blocks.
    let many = "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\nblocks = [2, 1000000000]\n";
    std::fs::write(folder.path().join("sweep.toml"), many).expect("written");
    let text = table(folder.path(), &[]);
    assert!(rows(&text)[0].len() < 120 && rows(&text)[2].last().is_some_and(|error| error.contains("1 to 100")));
    std::fs::write(folder.path().join("sweep.toml"), "scene = \"base.toml\"\n[axes]\neta = [0.9, 1.5, 0.8]\n")
        .expect("written");
    let text = table(folder.path(), &[]);
    let rows = rows(&text);
    assert_eq!(rows.iter().filter(|row| row[2] == "error").count(), 1);
    assert!(rows[2][7].contains("restitution.eta") && rows[2][7].contains("0 to 1"), "{text}");
}

#[test]
fn peaks_are_asked_for_and_paired_axes_run_together() {
    let sweep = "scene = \"base.toml\"\ncombine = \"paired\"\nask = \"peaks\"\n[axes]\nomega_p = [2, 3, 4]\n[axes.excitation.horizontal]\namplitude_g = [0.3, 0.4, 0.5]\n";
    let folder = folder(sweep);
    let rows = rows(&table(folder.path(), &[]));
    assert_eq!(rows.len(), 4);
    assert_eq!(rows[0][7..], ["peak_1", "peak_2", "last_mode", "truncated", "error"]);
    let scene = BASE.replace("omega = 10.0", "omega_p = 4").replace("amplitude = 3.0", "amplitude_g = 0.5");
    std::fs::write(folder.path().join("one.toml"), scene).expect("written");
    let summary = common::succeeds(folder.path(), &["run", "one.toml", "--json"]);
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    let alpha = 0.4f64.atan2(0.78);
    let expected = summary["peak_theta"][1].as_f64().expect("a number") / alpha;
    assert!((rows[3][8].parse::<f64>().expect("a number") / expected - 1.0).abs() < 1e-12, "{rows:?}");
}

/// Records of a folder and seeds are axes like others.
#[test]
fn records_and_seeds_are_axes() {
    let folder = folder("scene = \"base.toml\"\n[axes]\nfile = { folder = \"records\" }\npga_g = [0.3, 0.6]\n");
    std::fs::create_dir(folder.path().join("records")).expect("made");
    let synthetic = common::root().join("scenes/records/synthetic.AT2");
    for name in ["a.AT2", "b.AT2"] {
        std::fs::copy(&synthetic, folder.path().join("records").join(name)).expect("copied");
    }
    let record = BASE
        .replace("kind = \"sine-pulse\"\namplitude = 3.0\nomega = 10.0", "kind = \"record\"\nfile = \"records/a.AT2\"");
    std::fs::write(folder.path().join("base.toml"), record).expect("written");
    let rows_of_records = rows(&table(folder.path(), &[]));
    assert_eq!(rows_of_records.len(), 5);
    assert_eq!(rows_of_records[1][3..], rows_of_records[3][3..], "the same record gives the same row");
    // Velocities that a database gives beside are left out; a vertical component does not shake the base sideways.
    let beside = |name: &str| std::fs::copy(&synthetic, folder.path().join("records").join(name)).expect("copied");
    beside("a.VT2");
    assert_eq!(rows(&table(folder.path(), &[])), rows_of_records);
    beside("RSN1_A-UP.AT2");
    let output = common::rocking(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(
        !output.status.success() && error.contains("RSN1_A-UP.AT2") && error.contains("excitation.station"),
        "{error}"
    );
    let output = common::rocking(folder.path(), &["run", "sweep.toml", "--out", "out"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("`rocking sweep`"), "{output:?}");
    let synthetic =
        BASE.replace("kind = \"sine-pulse\"\namplitude = 3.0\nomega = 10.0", "kind = \"synthetic\"\npga_g = 0.5");
    std::fs::write(folder.path().join("base.toml"), synthetic).expect("written");
    let seeds = "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\nseed = { from = 1, to = 50 }\n";
    std::fs::write(folder.path().join("sweep.toml"), seeds).expect("written");
    let rows = rows(&table(folder.path(), &[]));
    let peaks: std::collections::BTreeSet<&str> = rows[1..].iter().map(|row| row[6].as_str()).collect();
    assert!(rows.iter().all(|row| row[2] != "error"), "whole numbers are whole: {rows:?}");
    assert_eq!((rows.len(), peaks.len()), (51, 50), "each seed its own: {rows:?}");
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
    ] {
        let folder = folder(sweep);
        let output = common::rocking(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{sweep}\n{message}");
        for part in named {
            assert!(message.contains(part), "`{part}` is missing in\n{message}\nof\n{sweep}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 2, "something was written for {sweep}");
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
    std::fs::write(folder.path().join("base.toml"), base("0.0", "0.0")).expect("written");
    let rows = rows(&table(folder.path(), &[]));
    assert_eq!(rows[0][1..3], ["initial.theta[2]", "initial.omega[1]"]);
    assert_eq!(rows.len(), 5);
    for row in &rows[1..] {
        std::fs::write(folder.path().join("one.toml"), base(&row[1], &row[2])).expect("written");
        let summary = common::succeeds(folder.path(), &["run", "one.toml", "--json"]);
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        let peak = summary["peak_theta"][1].as_f64().expect("a number") / 0.4f64.atan2(0.78);
        assert!((row[8].parse::<f64>().expect("a number") / peak - 1.0).abs() < 1e-12, "{row:?}");
    }
}

/// A key of a scene with both components, or with a list of the same name, says of which it is.
#[test]
fn keys_that_may_be_one_of_several_are_refused() {
    let folder = folder("");
    let vertical = "[excitation.vertical]\nkind = \"harmonic\"\namplitude_g = 0.2\nfrequency = 2.0\n";
    let base = BASE.replace("omega = 10.0", "period = 0.6") + "[initial]\nomega = [0.0, 0.1]\n" + vertical;
    std::fs::write(folder.path().join("base.toml"), base).expect("written");
    for (axis, is_clear) in [
        ("amplitude_g = [0.1]", false),
        ("omega = [1.0]", false),
        ("amplitude = [1.0]", true),
        ("period = [1.0]", true),
        ("\"omega[1]\" = [1.0]", true),
        ("\"excitation.horizontal.amplitude_g\" = [0.1]", true),
    ] {
        std::fs::write(folder.path().join("sweep.toml"), format!("scene = \"base.toml\"\n[axes]\n{axis}\n"))
            .expect("written");
        let output = common::rocking(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.success(), is_clear, "{axis}: {message}");
        assert_eq!(message.contains("one of several keys"), !is_clear, "{axis}: {message}");
    }
}

#[test]
fn axes_are_in_the_order_of_the_file_and_round_numbers_are_round() {
    let sweep = "scene = \"base.toml\"\n[axes]\n\
        excitation.horizontal.omega_p = { from = 0.1, to = 10, steps = 3, scale = \"log\" }\n\
        blocks = { from = 1, to = 4, steps = 3, scale = \"log\" }\n\
        excitation.horizontal.amplitude_g = [0.1]\n";
    let folder = folder(sweep);
    let rows = rows(&table(folder.path(), &[]));
    assert_eq!(rows[0][1..4], ["excitation.horizontal.omega_p", "column.blocks", "excitation.horizontal.amplitude_g"]);
    let values = |axis: usize| rows[1..].iter().map(|row| row[axis].as_str()).collect::<Vec<_>>();
    assert_eq!(values(1), ["0.1", "0.1", "0.1", "1", "1", "1", "10", "10", "10"]);
    assert_eq!(values(2)[..3], ["1", "2", "4"]);
    for (axis, expected) in [
        ("amplitude = { from = 1e-4, to = 1e3, steps = 8", "0.0001,0.001,0.01,0.1,1,10,100,1000"),
        ("rtol = { from = 1e-12, to = 1e-9, steps = 4", "1e-12,1e-11,1e-10,1e-9"),
        ("overturn_angle = { from = 0.1, to = 1.5, steps = 3", "0.1,0.3872983346207417,1.5"),
    ] {
        let sweep = format!("scene = \"base.toml\"\n[axes]\n{axis}, scale = \"log\" }}\n[axes.solver]\n# none\n");
        std::fs::write(folder.path().join("sweep.toml"), sweep).expect("written");
        let text = table(folder.path(), &[]);
        let values: Vec<&str> = text.lines().skip(1).filter_map(|line| line.split(',').nth(1)).collect();
        assert_eq!(values.join(","), expected);
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
    let rows = rows(&table(folder.path(), &[]));
    assert_eq!(rows.len(), 17);
    assert!(rows[1..].iter().all(|row| row[4] != "error"), "{rows:?}");
}

/// Slabs that slide, and drums that rock; the rows are what `rocking run` says of the scenes.
#[test]
fn friction_is_an_axis_and_residual_slides_are_asked_for() {
    let sweep = "scene = \"base.toml\"\nask = \"slides\"\n[axes]\nfriction = [0.2, 0.4, 2.5]\nhalf_width = [0.4, 1.0]\namplitude_g = [0.1, 0.6, 3.0]\n";
    let folder = folder(sweep);
    let text = table(folder.path(), &[]);
    let rows = rows(&text);
    assert_eq!(rows[0][1..4], ["friction", "column.half_width", "excitation.horizontal.amplitude_g"]);
    assert_eq!(
        rows[0][8..],
        ["peak_1", "peak_2", "last_mode", "residual_slide_1", "residual_slide_2", "truncated", "error"]
    );
    let mut fates = std::collections::BTreeSet::new();
    for row in &rows[1..] {
        let scene = BASE
            .replace("half_width = 0.4", &format!("half_width = {}", row[2]))
            .replace("amplitude = 3.0", &format!("amplitude_g = {}", row[3]));
        std::fs::write(folder.path().join("one.toml"), format!("friction = {}\n{scene}", row[1])).expect("written");
        let summary = common::succeeds(folder.path(), &["run", "one.toml", "--json"]);
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        for (interface, cell) in row[11..13].iter().enumerate() {
            let residual = summary["sliding"]["residual_slide"][interface].as_f64().expect("a number");
            let slide: f64 = cell.parse().expect("a number");
            // Rows of a response do not change the motion.
            assert!((slide - residual).abs() <= 1e-9 * residual.abs().max(1e-3), "{row:?}, {residual}");
        }
        let status = match row[4].as_str() {
            "overturns" => "overturned",
            "collapses" => "collapsed",
            "undetermined" => "undetermined",
            _ => "",
        };
        assert!(status.is_empty() || summary["status"] == status, "{row:?}");
        fates.insert(row[4].clone());
    }
    assert!(["no-uplift", "slides", "rocks", "overturns"].iter().all(|fate| fates.contains(*fate)), "{fates:?}");
    // Static and kinetic coefficients by their own names.
    let base = format!("friction = {{ static = 0.5, kinetic = 0.3 }}\n{BASE}");
    std::fs::write(folder.path().join("base.toml"), base).expect("written");
    std::fs::write(folder.path().join("sweep.toml"), "scene = \"base.toml\"\n[axes]\nkinetic = [0.3, 0.4, 0.6]\n")
        .expect("written");
    let text = table(folder.path(), &[]);
    assert!(text.starts_with("index,friction.kinetic,outcome") && text.contains("static"), "{text}");
}

#[test]
fn residual_slides_of_scenes_without_friction_are_refused() {
    let folder = folder("scene = \"base.toml\"\nask = \"slides\"\n[axes]\nomega_p = [2, 3]\n");
    let output = common::rocking(folder.path(), &["sweep", "sweep.toml"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    for part in ["sweep.toml", "line 2", "`ask`", "without friction", "let friction be an axis"] {
        assert!(message.contains(part), "`{part}` is not in {message}");
    }
}

/// What no row could answer is refused: validity with friction, from the base scene or an axis.
#[test]
fn validity_of_scenes_with_friction_is_refused() {
    let folder = folder("scene = \"base.toml\"\nask = \"validity\"\n[axes]\nfriction = [0.3, 0.5]\n");
    let output = common::rocking(folder.path(), &["sweep", "sweep.toml"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    for part in ["sweep.toml", "line 2", "`ask`", "with friction", "slides"] {
        assert!(message.contains(part), "`{part}` is not in {message}");
    }
}

/// `friction = 0.5` of a base scene is short for a static coefficient: an axis may change that, or add a kinetic one.
#[test]
fn coefficients_of_friction_are_axes_over_the_short_form() {
    let outcomes = |base: &str, axes: &str| {
        let folder = folder(&format!("scene = \"base.toml\"\nask = \"slides\"\n[axes]\n{axes}"));
        std::fs::write(folder.path().join("base.toml"), format!("{base}\n{BASE}")).expect("written");
        let text = table(folder.path(), &[]);
        rows(&text)[1..].iter().map(|row| row[2..].to_vec()).collect::<Vec<_>>()
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
    let base = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.vertical]\nkind = \"record\"\nfile = \"records/A_UP.csv\"\n";
    std::fs::write(folder.path().join("base.toml"), base).expect("written");
    std::fs::create_dir(folder.path().join("records")).expect("made");
    let put = |name: &str, text: &str| std::fs::write(folder.path().join("records").join(name), text).expect("written");
    put("A_UP.csv", "t [s],a [m/s2]\n0,0\n0.1,1\n0.2,0\n");
    put("README.md", "where the records are from");
    put("_SearchResults.csv", "the list of the database");
    put("readme.txt", "the same");
    let text = table(folder.path(), &[]);
    assert!(text.lines().count() == 2 && text.contains("A_UP.csv"), "{text}");
    put("A_EW.csv", "t [s],a [m/s2]\n0,0\n0.1,1\n0.2,0\n");
    let output = common::rocking(folder.path(), &["sweep", "sweep.toml"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && message.contains("A_EW.csv is a horizontal component"), "{message}");
}
