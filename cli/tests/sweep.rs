//! Sweeps: a row per point, the same whatever the threads, shards and interruptions.

mod common;

use common::sweeps::{BASE, SWEEP, folder, kill_and_go_on, long};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

fn table(folder: &Path, arguments: &[&str]) -> String {
    let all = [&["sweep", "sweep.toml", "--out", "t.csv", "--quiet"], arguments].concat();
    common::succeeds(folder, &all);
    std::fs::read_to_string(folder.join("t.csv")).expect("written")
}

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
        let [_, blocks, omega, amplitude, outcome, impacts, block, t, error] = &row[..] else { panic!("{row:?}") };
        let scene = BASE
            .replace("blocks = 2", &format!("blocks = {blocks}"))
            .replace("omega = 10.0", &format!("omega_p = {omega}"))
            .replace("amplitude = 3.0", &format!("amplitude_g = {amplitude}"));
        std::fs::write(folder.path().join("one.toml"), scene).expect("written");
        let summary = common::succeeds(folder.path(), &["run", "one.toml", "--json"]);
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        assert_eq!(summary["status"] == "overturned", outcome == "overturns", "{row:?}");
        assert_eq!(error, "");
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
fn threads_and_shards_change_nothing() {
    let folder = folder(SWEEP);
    let whole = table(folder.path(), &[]);
    assert_eq!(table(folder.path(), &["--threads", "1"]), whole);
    let mut shards = Vec::new();
    for number in [3, 1, 4, 2] {
        let name = format!("part-{number}.csv");
        common::succeeds(
            folder.path(),
            &["sweep", "sweep.toml", "--out", &name, "--shard", &format!("{number}/4"), "--quiet"],
        );
        shards.push(name);
    }
    let mut arguments = vec!["merge", "merged.csv"];
    arguments.extend(shards.iter().map(String::as_str));
    common::succeeds(folder.path(), &arguments);
    assert_eq!(std::fs::read_to_string(folder.path().join("merged.csv")).expect("written"), whole);
    // Of more shards than points some are empty.
    let many: Vec<String> = (1..=61).map(|number| format!("{number}.csv")).collect();
    for (place, name) in many.iter().enumerate() {
        let shard = format!("{}/61", place + 1);
        common::succeeds(folder.path(), &["sweep", "sweep.toml", "--out", name, "--shard", &shard, "--quiet"]);
    }
    let mut arguments = vec!["merge", "merged.csv"];
    arguments.extend(many.iter().map(String::as_str));
    common::succeeds(folder.path(), &arguments);
    assert_eq!(std::fs::read_to_string(folder.path().join("merged.csv")).expect("written"), whole);
}

#[test]
fn shards_that_are_missing_or_of_another_sweep_are_noticed() {
    let folder = folder(SWEEP);
    for number in 1..=4 {
        let (name, shard) = (format!("{number}.csv"), format!("{number}/4"));
        common::succeeds(folder.path(), &["sweep", "sweep.toml", "--out", &name, "--shard", &shard, "--quiet"]);
    }
    let other = "scene = \"base.toml\"\n[axes]\neta = { from = 0.1, to = 0.9, steps = 60 }\n";
    std::fs::write(folder.path().join("other.toml"), other).expect("written");
    common::succeeds(folder.path(), &["sweep", "other.toml", "--out", "other.csv", "--shard", "2/2", "--quiet"]);
    for (arguments, named) in [
        (&["1.csv", "3.csv"][..], &["3.csv", "point 30 where 15 is due"][..]),
        (&["2.csv", "3.csv", "4.csv"], &["2.csv", "point 15 where 0 is due"]),
        (&["1.csv", "2.csv", "2.csv"], &["2.csv", "point 15 where 30 is due"]),
        (&["1.csv", "2.csv", "other.csv"], &["other.csv", "columns", "the others"]),
        // Only who gives the sweep learns of these.
        (&["1.csv", "2.csv", "3.csv", "--sweep", "sweep.toml"], &["sweep.toml", "60 point(s)", "after 45"]),
        (&["1.csv", "--sweep", "other.toml"], &["1.csv", "columns", "other.toml"]),
    ] {
        let output = common::rocking(folder.path(), &[&["merge", "merged.csv"], arguments].concat());
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(named.iter().all(|part| message.contains(part)), "{named:?} in\n{message}");
        assert!(!folder.path().join("merged.csv").exists(), "{arguments:?}");
    }
    let all = ["merge", "merged.csv", "1.csv", "2.csv", "3.csv", "4.csv", "--sweep", "sweep.toml"];
    assert!(common::succeeds(folder.path(), &all).contains("all points of sweep.toml"));
    assert!(common::succeeds(folder.path(), &all[..5]).contains("--sweep FILE would tell"));
}

/// Nothing is run or written for a table that could not be written in the end.
#[cfg(not(feature = "parquet"))]
#[test]
fn a_build_without_parquet_names_the_remedy() {
    let folder = folder(SWEEP);
    for arguments in [
        &["sweep", "sweep.toml", "--out", "t.parquet"][..],
        &["merge", "t.parquet", "1.csv"],
        &["merge", "t.csv", "1.parquet"],
        &["plot", "1.parquet"],
    ] {
        std::fs::write(folder.path().join("1.parquet"), "PAR1").expect("written");
        let output = common::rocking(folder.path(), arguments);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(message.contains("1.parquet") || message.contains("t.parquet"), "{message}");
        assert!(message.contains("cargo build") && message.contains("--features parquet"), "{message}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 3, "base, sweep and 1.parquet");
}

/// Killed without warning at any moment and started again, however often, a sweep gives the bytes of one that was left alone.
#[test]
fn a_sweep_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = folder(&long());
    let whole = table(folder.path(), &[]);
    std::fs::remove_file(folder.path().join("t.csv")).expect("there");
    kill_and_go_on(folder.path(), "t.csv", || {
        assert!(!folder.path().join("t.csv").exists(), "the table has its name before it is whole");
        // A line that was cut within, as a full disk or a power cut leaves it.
        let part = std::fs::read_dir(folder.path()).expect("a folder").filter_map(Result::ok).map(|file| file.path());
        if let Some(part) = part.into_iter().find(|file| file.extension().is_some_and(|extension| extension == "part"))
        {
            let bytes = std::fs::read(&part).expect("readable");
            std::fs::write(&part, &bytes[..bytes.len().saturating_sub(7)]).expect("writable");
        }
    });
    assert_eq!(std::fs::read_to_string(folder.path().join("t.csv")).expect("written"), whole);
    let left = std::fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(left, 3, "base, sweep and table");
}

/// What was begun with other inputs is not gone on with.
#[test]
fn a_part_of_another_sweep_is_left_alone() {
    let folder = folder(SWEEP);
    let first = table(folder.path(), &[]);
    std::fs::write(folder.path().join("base.toml"), BASE.replace("eta = 0.9", "eta = 0.8")).expect("written");
    let second = table(folder.path(), &[]);
    assert_ne!(first, second);
    std::fs::write(folder.path().join("base.toml"), BASE).expect("written");
    assert_eq!(table(folder.path(), &[]), first);
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
    assert!(rows(&text)[1..3].iter().all(|row| row[7].contains("unknown")), "{text}");
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
    assert!(rows[2][6].contains("restitution.eta") && rows[2][6].contains("0 to 1"), "{text}");
}

#[test]
fn peaks_are_asked_for_and_paired_axes_run_together() {
    let sweep = "scene = \"base.toml\"\ncombine = \"paired\"\nask = \"peaks\"\n[axes]\nomega_p = [2, 3, 4]\n[axes.excitation.horizontal]\namplitude_g = [0.3, 0.4, 0.5]\n";
    let folder = folder(sweep);
    let rows = rows(&table(folder.path(), &[]));
    assert_eq!(rows.len(), 4);
    assert_eq!(rows[0][7..], ["peak_1", "peak_2", "last_mode", "error"]);
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

/// Shards without a name of their own do not write over each other.
#[test]
fn shards_have_names() {
    let folder = folder(SWEEP);
    let whole = table(folder.path(), &[]);
    for shard in ["1/2", "2/2"] {
        common::succeeds(folder.path(), &["sweep", "sweep.toml", "--shard", shard, "--quiet"]);
    }
    common::succeeds(
        folder.path(),
        &["merge", "m.csv", "sweep-1-of-2.csv", "sweep-2-of-2.csv", "--sweep", "sweep.toml"],
    );
    assert_eq!(std::fs::read_to_string(folder.path().join("m.csv")).expect("written"), whole);
}

/// Of what is left of a sweep rows are kept up to the first that is not the one due.
#[test]
fn a_damaged_part_is_gone_on_with_from_the_damage() {
    let folder = folder(&long().replace("steps = 40", "steps = 400"));
    let mut child = start(folder.path());
    let part = part(folder.path(), &[]);
    while std::fs::metadata(&part).is_ok_and(|metadata| metadata.len() < 40_000) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().expect("SIGKILL");
    child.wait().expect("it ends");
    let rows = std::fs::read_to_string(&part).expect("the sweep is long enough to be killed");
    let (name, whole) = (part.file_name().expect("a name").to_owned(), table(folder.path(), &[]));
    let lines: Vec<&str> = rows.lines().collect();
    let without = [&lines[..100], &lines[101..]].concat().join("\n") + "\n";
    let zeros = [&rows.as_bytes()[..5000], &[0; 4096], &rows.as_bytes()[9096..]].concat();
    let before_zeros = rows[..5000].lines().count() - 2;
    for (damaged, kept) in [
        (without.into_bytes(), "(99 of them".into()),
        (zeros, format!("({before_zeros} of them")),
        (b"another header\n0,\n".to_vec(), "row(s) to".into()),
    ] {
        std::fs::write(folder.path().join(&name), damaged).expect("written");
        let told = common::succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
        assert!(told.contains(&kept), "{kept} in {told}");
        assert!(std::fs::read_to_string(folder.path().join("t.csv")).expect("written") == whole);
    }
}

/// A link leads to its file; what is no file is left alone.
#[cfg(unix)]
#[test]
fn links_are_followed_and_devices_left_alone() {
    let folder = folder(SWEEP);
    let path = folder.path();
    let whole = table(path, &[]);
    std::fs::write(path.join("real.csv"), "old").expect("written");
    std::os::unix::fs::symlink("real.csv", path.join("link.csv")).expect("made");
    common::succeeds(path, &["sweep", "sweep.toml", "--out", "link.csv", "--quiet"]);
    assert!(path.join("link.csv").is_symlink());
    assert_eq!(std::fs::read_to_string(path.join("real.csv")).expect("written"), whole);
    std::os::unix::fs::symlink("nowhere.csv", path.join("dangling.csv")).expect("made");
    let _socket = std::os::unix::net::UnixListener::bind(path.join("socket")).expect("made");
    for (arguments, named) in [
        (&["sweep", "sweep.toml", "--out", "socket"][..], "no file"),
        (&["merge", "socket", "t.csv"], "no file"),
        (&["sweep", "sweep.toml", "--out", "folder/"], "a folder"),
        (&["sweep", "sweep.toml", "--out", "folder/."], "a folder"),
        (&["sweep", "sweep.toml", "--out", "dangling.csv"], "a link"),
        (&["sweep", "sweep.toml", "--out", "nowhere/t.csv"], "no such folder"),
        (&["sweep", "sweep.toml", "--out", "t.csv", "--plot", "nowhere/t.svg"], "no such folder"),
    ] {
        let output = common::rocking(path, arguments);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}\n{message}");
        assert!(message.contains(named), "{arguments:?}\n{message}");
    }
    assert_eq!(std::fs::read_dir(path).expect("a folder").count(), 7, "two inputs, table, file, two links and socket");
}

/// What a sweep reads, or writes as something else, it does not write over.
#[test]
fn a_table_over_an_input_is_refused() {
    let folder = folder(SWEEP);
    let record = BASE.replace(
        "kind = \"sine-pulse\"\namplitude = 3.0\nomega = 10.0",
        "kind = \"record\"\nfile = \"a.AT2\"\npga_g = 0.2",
    );
    std::fs::copy(common::root().join("scenes/records/synthetic.AT2"), folder.path().join("a.AT2")).expect("copied");
    std::fs::write(folder.path().join("base.toml"), record).expect("written");
    let sweep = "scene = \"base.toml\"\n[axes]\neta = [0.5, 0.9]\npga_g = [0.2, 0.3]\n";
    std::fs::write(folder.path().join("sweep.toml"), sweep).expect("written");
    let contents = || {
        let entries = std::fs::read_dir(folder.path()).expect("a folder").map(|entry| entry.expect("there").path());
        let mut all: Vec<_> = entries.map(|path| (path.clone(), std::fs::read(path).expect("a file"))).collect();
        all.sort();
        all
    };
    common::succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "1.csv", "--shard", "1/2", "--quiet"]);
    common::succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "2.csv", "--shard", "2/2", "--quiet"]);
    let before = contents();
    for arguments in [
        &["sweep", "sweep.toml", "--out", "base.toml"][..],
        &["sweep", "sweep.toml", "--out", "./sweep.toml"],
        &["sweep", "sweep.toml", "--out", "a.AT2"],
        &["sweep", "sweep.toml", "--out", "t.svg", "--plot", "t.svg"],
        &["sweep", "sweep.toml", "--out", "t-minimum.svg", "--plot", "t.svg"],
        &["merge", "2.csv", "1.csv", "2.csv"],
        &["merge", "sweep.toml", "1.csv", "2.csv", "--sweep", "sweep.toml"],
        &["merge", "base.toml", "1.csv", "2.csv", "--sweep", "sweep.toml"],
        &["merge", "a.AT2", "1.csv", "2.csv", "--sweep", "sweep.toml"],
    ] {
        let output = common::rocking(folder.path(), arguments);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}\n{message}");
        assert!(message.contains("choose another name"), "{arguments:?}\n{message}");
    }
    assert!(contents() == before, "something was written");
    common::succeeds(folder.path(), &["merge", "t.csv", "2.csv", "1.csv", "--sweep", "sweep.toml"]);
}

/// A part is gone on with only if the records of the base scene are what they were.
#[test]
fn another_record_of_the_same_name_makes_another_table() {
    let folder = folder(
        &long()
            .replace("omega_p = { from = 1, to = 8", "scale = { from = 0.4, to = 0.8")
            .replace("amplitude_g", "start")
            .replace("steps = 40", "steps = 4000"),
    );
    let record =
        BASE.replace("kind = \"sine-pulse\"\namplitude = 3.0\nomega = 10.0", "kind = \"record\"\nfile = \"a.AT2\"");
    std::fs::write(folder.path().join("base.toml"), record).expect("written");
    std::fs::copy(common::root().join("scenes/records/synthetic.AT2"), folder.path().join("a.AT2")).expect("copied");
    let mut parts = Vec::new();
    for _ in 0..2 {
        let mut child = start(folder.path());
        parts.push(part(folder.path(), &parts));
        child.kill().expect("SIGKILL");
        child.wait().expect("it ends");
        let record = std::fs::read_to_string(folder.path().join("a.AT2")).expect("text");
        std::fs::write(folder.path().join("a.AT2"), record.replacen("e-6", "e-5", 1)).expect("written");
    }
    assert!(parts.iter().all(|part| part.exists()), "{parts:?}");
}

/// Starts the sweep of the folder on one thread.
fn start(folder: &Path) -> std::process::Child {
    std::process::Command::new(env!("CARGO_BIN_EXE_rocking"))
        .args(["sweep", "sweep.toml", "--out", "t.csv", "--threads", "1", "--quiet"])
        .current_dir(folder)
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("started")
}

/// The part of a sweep that has just been started, once it has a header.
fn part(folder: &Path, known: &[PathBuf]) -> PathBuf {
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(60) {
        let files = std::fs::read_dir(folder).expect("a folder").filter_map(Result::ok).map(|file| file.path());
        let is_part = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "part");
        let found = files
            .filter(|path| is_part(path) && !known.contains(path))
            .find(|path| std::fs::metadata(path).is_ok_and(|metadata| metadata.len() > 0));
        if let Some(found) = found {
            return found;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("no part within a minute");
}

/// Two processes at one table would write between each other's rows: the second is told.
#[cfg(unix)]
#[test]
fn a_sweep_runs_once_at_a_time() {
    let folder = folder(&long().replace("steps = 40", "steps = 4000"));
    let mut child = start(folder.path());
    part(folder.path(), &[]);
    let output = common::rocking(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
    let message = String::from_utf8_lossy(&output.stderr);
    let still_runs = child.try_wait().expect("it can be asked").is_none();
    child.kill().expect("SIGKILL");
    child.wait().expect("it ends");
    assert!(still_runs, "the sweep is too short for this test");
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("t.csv: another process") && message.contains("wait"), "{message}");
}

#[test]
fn rows_that_are_cut_or_of_another_sweep_are_not_merged() {
    let folder = folder(SWEEP);
    for number in 1..=2 {
        let (name, shard) = (format!("{number}.csv"), format!("{number}/2"));
        common::succeeds(folder.path(), &["sweep", "sweep.toml", "--out", &name, "--shard", &shard, "--quiet"]);
    }
    let second = std::fs::read_to_string(folder.path().join("2.csv")).expect("written");
    let last = second.trim_end().rsplit('\n').next().expect("a line");
    let overturned = second.lines().find(|line| line.contains("overturns")).expect("one overturns");
    let cut_within = second.replace(last, last.rsplit_once(',').expect("cells").0);
    let without_outcome = second.replace(overturned, &overturned.replace("overturns", "overt"));
    let cut_at_end = second.trim_end().to_string();
    let no_number = second.replace(overturned, &overturned.replace("overturns,", "overturns,x"));
    let overturns = format!("ask = \"overturns\"\n{SWEEP}");
    std::fs::write(folder.path().join("overturns.toml"), overturns).expect("written");
    std::fs::rename(folder.path().join("sweep.toml"), folder.path().join("old.toml")).expect("renamed");
    std::fs::write(folder.path().join("sweep.toml"), SWEEP.replace("to = 8", "to = 9")).expect("written");
    for (text, arguments, named) in [
        (&cut_within, &[][..], &["2.csv", "record 30", "fields"][..]),
        (&cut_at_end, &[], &["2.csv", "last line is cut"]),
        (&no_number, &["--sweep", "old.toml"], &["2.csv", "is not one of old.toml"]),
        (&second, &["--sweep", "overturns.toml"], &["1.csv", "is not one of overturns.toml"]),
        (&without_outcome, &[], &["2.csv", "not whole", overturned.split(',').next().expect("an index")]),
        (&second, &["--sweep", "sweep.toml"], &["1.csv", "point 6", "is not one of sweep.toml"]),
    ] {
        std::fs::write(folder.path().join("2.csv"), text).expect("written");
        let output = common::rocking(folder.path(), &[&["merge", "t.csv", "1.csv", "2.csv"], arguments].concat());
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(named.iter().all(|part| message.contains(part)), "{named:?} in\n{message}");
        assert!(!folder.path().join("t.csv").exists());
    }
}

#[test]
fn threads_are_some_and_not_too_many() {
    let folder = folder(SWEEP);
    for threads in ["0", "5000", "two"] {
        let output = common::rocking(folder.path(), &["sweep", "sweep.toml", "--threads", threads]);
        assert_eq!(output.status.code(), Some(2), "{threads}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("--threads"), "{threads}");
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
