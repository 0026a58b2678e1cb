//! `rocking record` tells what it understood of a record and what the record measures, writes it, and lists folders; scenes take
//! the same files.

mod common;

use common::{rocking, root, succeeds};
use serde_json::Value;
use std::path::Path;

fn fixture(name: &str) -> String {
    root().join("ground/tests/records").join(name).display().to_string()
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let text = succeeds(folder, &[arguments, &["--json"]].concat());
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Runs what must be refused; the message must hold all of `parts`.
fn refused(folder: &Path, arguments: &[&str], parts: &[&str]) {
    let output = rocking(folder, arguments);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(parts.iter().all(|part| message.contains(part)), "{arguments:?}: {parts:?} in\n{message}");
    assert!(!message.contains("panicked"), "{message}");
}

#[test]
fn a_record_is_told_with_its_measures() {
    let here = tempfile::tempdir().expect("a folder");
    let text = succeeds(here.path(), &["record", &fixture("peer/RSN9001_HOLLOW_MIL090.AT2")]);
    for (name, value) in [
        ("format", "PEER AT2"),
        ("event", "Hollow Creek-01, 3/4/2001"),
        ("station", "Mill Bridge"),
        ("component", "090"),
        ("unit", "g"),
        ("dt", "0.01 s"),
        ("samples", "42"),
        ("duration", "0.41 s"),
        ("PGA", "0.24397 g = 2.3934 m/s2, at 0.13 s"),
    ] {
        let line = text.lines().find_map(|line| line.trim_start().strip_prefix(name)?.strip_prefix(' '));
        assert_eq!(line.map(str::trim), Some(value), "{name} in\n{text}");
    }
    for name in ["PGV", "PGD", "Arias intensity", "significant duration"] {
        assert!(text.contains(&format!("  {name} ")), "{name} in\n{text}");
    }
}

/// A triangle of height p and half-base h: PGV = p h, PGD = p h², Arias π/(2g) 2 p² h/3.
#[test]
fn the_measures_of_a_triangle_are_its_closed_forms() {
    let here = tempfile::tempdir().expect("a folder");
    std::fs::write(here.path().join("triangle.csv"), "t [s], a [m/s2]\n0,0\n0.5,3\n1,0\n").expect("written");
    let told = json(here.path(), &["record", "triangle.csv"]);
    let number = |key: &str| told[key].as_f64().unwrap_or_else(|| panic!("{key} in {told}"));
    let close = |key: &str, value: f64| assert!((number(key) - value).abs() < 1e-12, "{key} = {}", number(key));
    close("pga", 3.0);
    close("pga_g", 3.0 / 9.81);
    close("pga_time", 0.5);
    close("pgv", 1.5);
    close("pgd", 0.75);
    close("arias", std::f64::consts::PI / (2.0 * 9.81) * 3.0);
    close("significant_duration", 1.0 - 0.1_f64.cbrt());
    close("duration", 1.0);
    assert_eq!((&told["drifts"], &told["format"], &told["unit"]), (&true.into(), &"table".into(), &"m/s2".into()));
    assert!(succeeds(here.path(), &["record", "triangle.csv"]).contains("drifts"));
}

#[test]
fn a_record_is_trimmed_scaled_and_written_and_reads_back() {
    let here = tempfile::tempdir().expect("a folder");
    let file = fixture("csmip/three-channels.V2");
    let told =
        json(here.path(), &["record", &file, "--channel", "3", "--trim", "0.1..0.3", "--pga", "0.5", "--out", "x.csv"]);
    assert_eq!(told["samples"], 21);
    assert!((told["pga_g"].as_f64().expect("a number") - 0.5).abs() < 1e-12);
    let back = json(here.path(), &["record", "x.csv"]);
    for key in ["samples", "dt", "pga", "pgv", "pgd", "arias", "significant_start"] {
        assert_eq!(back[key], told[key], "{key}");
    }
    for trim in [&["--trim", "0.1", "0.3"][..], &["--trim=0.1:0.3"], &["--trim", "0.1,0.3"]] {
        let other = json(here.path(), &[&["record", &file, "--channel", "3"], trim].concat());
        assert_eq!(other["samples"], 21, "{trim:?}");
    }
    assert_eq!(json(here.path(), &["record", "--trim", "0.1..", "x.csv"])["samples"], 11);
    assert_eq!(json(here.path(), &["record", "x.csv", "--trim", "..0.05"])["samples"], 6);
    let twice = json(here.path(), &["record", "x.csv", "--scale", "-2"]);
    assert!((twice["pga_g"].as_f64().expect("a number") - 1.0).abs() < 1e-12);
    // The written file is the only one there.
    assert_eq!(std::fs::read_dir(here.path()).expect("a folder").count(), 1);
}

#[test]
fn what_the_file_lacks_is_asked_for_by_its_option() {
    let here = tempfile::tempdir().expect("a folder");
    let one = fixture("table/one-column.txt");
    // Its first line states the unit; without that line nothing does.
    let text = std::fs::read_to_string(&one).expect("it ships");
    let (_, samples) = text.split_once('\n').expect("lines");
    std::fs::write(here.path().join("silent.txt"), samples).expect("written");
    refused(here.path(), &["record", "silent.txt"], &["silent.txt", "unit", "`--units`"]);
    refused(here.path(), &["record", &one], &["sampling interval", "`--dt`"]);
    refused(here.path(), &["record", &one, "--units", "gal"], &["sampling interval", "`--dt`"]);
    assert_eq!(json(here.path(), &["record", &one, "--units", "gal", "--dt", "0.01"])["samples"], 42);
    let titled = fixture("table/skip-rows.txt");
    refused(here.path(), &["record", &titled], &["line 1, column 1", "`Invented`", "`--skip-rows`"]);
    assert_eq!(json(here.path(), &["record", &titled, "--skip-rows", "2", "--units", "cm/s2"])["samples"], 42);
    let several = fixture("table/three-columns.csv");
    refused(here.path(), &["record", &several], &["h1, up", "`--column`"]);
    assert_eq!(json(here.path(), &["record", &several, "--column", "up"])["component"], "up");
    let at2 = fixture("peer/RSN9001_HOLLOW_MIL090.AT2");
    refused(here.path(), &["record", &at2, "--dt", "0.02"], &["`--dt` is given as 0.02 s", "line 4"]);
}

#[test]
fn bad_input_is_refused_with_its_place() {
    let here = tempfile::tempdir().expect("a folder");
    let at2 = std::fs::read_to_string(fixture("peer/RSN9001_HOLLOW_MIL090.AT2")).expect("it ships");
    std::fs::write(here.path().join("short.AT2"), at2.replace("NPTS=    42", "NPTS=    50")).expect("written");
    std::fs::write(here.path().join("nan.AT2"), at2.replace("   .3384353E-02", "            NaN")).expect("written");
    std::fs::write(here.path().join("binary"), [0_u8, 159, 146, 150, 255]).expect("written");
    std::fs::write(here.path().join("empty"), "").expect("written");
    refused(here.path(), &["record", "short.AT2"], &["short.AT2", "line 4", "declares 50", "has 42", "`--lenient`"]);
    assert_eq!(json(here.path(), &["record", "short.AT2", "--lenient"])["samples"], 42);
    refused(here.path(), &["record", "nan.AT2"], &["nan.AT2", "line 5, column 13", "`NaN`", "mend or remove"]);
    refused(here.path(), &["record", "binary"], &["binary", "no text", "save it as text"]);
    refused(here.path(), &["record", "empty"], &["empty", "the file is empty"]);
    refused(here.path(), &["record", "none.AT2"], &["none.AT2", "check the path"]);
    refused(here.path(), &["record"], &["<FILE>"]);
    refused(here.path(), &["record", "--trim", "1..2"], &["no record file is named"]);
    let at2 = fixture("peer/RSN9001_HOLLOW_MIL090.AT2");
    for trim in ["2..1", "x..2", "1", "30..40", "nan..1"] {
        refused(here.path(), &["record", &at2, "--trim", trim], &["--trim", trim, "2..8"]);
    }
    for pga in ["0", "-1", "nan", "inf", "x"] {
        refused(here.path(), &["record", &at2, &format!("--pga={pga}")], &["--pga", "give a "]);
    }
    refused(here.path(), &["record", &at2, "--pga", "1", "--scale", "2"], &["cannot be used with"]);
    refused(here.path(), &["record", &at2, "--units", "knots"], &["knots", "choose g, mg, m/s2"]);
    refused(here.path(), &["record", &at2, "--out", "no/folder/x.csv"], &["x.csv", "choose a file"]);
    refused(here.path(), &["record", &at2, "--channel", "2"], &["channel 2"]);
}

#[test]
fn a_folder_is_listed_by_record_and_direction() {
    let here = tempfile::tempdir().expect("a folder");
    for name in ["RSN9001_HOLLOW_MIL090.AT2", "RSN9001_HOLLOW_MIL000.AT2", "RSN9001_HOLLOW_MIL-UP.AT2", "velocity.VT2"]
    {
        std::fs::copy(fixture(&format!("peer/{name}")), here.path().join(name)).expect("copied");
    }
    std::fs::copy(fixture("knet/XXX0010103040506.EW"), here.path().join("XXX0010103040506.EW")).expect("copied");
    let told = json(here.path(), &["record", "."]);
    let groups = told["groups"].as_array().expect("a list");
    let names: Vec<&str> = groups.iter().filter_map(|group| group["record"].as_str()).collect();
    assert_eq!(names, ["RSN9001", "XXX0010103040506"]);
    let components = groups[0]["components"].as_array().expect("a list");
    let listed: Vec<(&str, &str)> =
        components.iter().map(|c| (c["direction"].as_str().unwrap_or(""), c["file"].as_str().unwrap_or(""))).collect();
    assert_eq!(
        listed,
        [
            ("horizontal", "RSN9001_HOLLOW_MIL000.AT2"),
            ("horizontal", "RSN9001_HOLLOW_MIL090.AT2"),
            ("vertical", "RSN9001_HOLLOW_MIL-UP.AT2")
        ]
    );
    assert_eq!(told["unread"][0]["file"], "velocity.VT2");
    let text = succeeds(here.path(), &["record", "."]);
    assert!(text.contains("vertical    RSN9001_HOLLOW_MIL-UP.AT2  PGA 0.2440 g  dt 0.01 s  n 42"), "{text}");
    assert!(text.contains("not read\n  velocity.VT2: line 3: this is no acceleration"), "{text}");
    refused(here.path(), &["record", ".", "--out", "x.csv"], &["--out is for a single record"]);

    let none = tempfile::tempdir().expect("a folder");
    std::fs::write(none.path().join("notes.txt"), "nothing of a record\n").expect("written");
    refused(none.path(), &["record", "."], &["none of its 1 file(s)", "notes.txt"]);
}

/// A scene that shakes with this record.
fn scene(keys: &str) -> String {
    format!(
        "[[block]]\nhalf_width = 0.1\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"record\"\n{keys}\n\
         [solver]\nt_end = 0.5\n"
    )
}

#[test]
fn scenes_take_the_same_files_and_tell_their_warnings_and_origin() {
    let here = tempfile::tempdir().expect("a folder");
    let run = |keys: &str| -> (Value, String) {
        std::fs::write(here.path().join("scene.toml"), scene(keys)).expect("written");
        let output = rocking(here.path(), &["run", "scene.toml", "--out", "out"]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{keys}: {message}");
        let summary = std::fs::read_to_string(here.path().join("out/summary.json")).expect("written");
        (serde_json::from_str(&summary).expect("JSON"), message)
    };
    let file = fixture("csmip/three-channels.V2");
    let (summary, message) = run(&format!("file = '{file}'\nscale = 2.0"));
    let record = &summary["excitation"]["horizontal"];
    assert_eq!(
        (&record["samples"], &record["scale"], &record["component"]),
        (&42.into(), &2.0.into(), &"90 DEG".into())
    );
    assert_eq!(record["file"].as_str(), Some(file.as_str()));
    assert!(summary["warnings"][0].as_str().is_some_and(|warning| warning.contains("3 channels")), "{summary}");
    assert!(message.contains("3 channels"), "{message}");
    let (summary, _) = run(&format!("file = '{file}'\nchannel = 2"));
    assert_eq!(summary["excitation"]["horizontal"]["component"], "UP");
    assert_eq!(
        summary["warnings"].as_array().map(|warnings| warnings.iter().any(|w| w.to_string().contains("3 channels"))),
        Some(false)
    );
    let table = fixture("table/three-columns.csv");
    assert_eq!(run(&format!("file = '{table}'\ncolumn = \"up\"")).0["excitation"]["horizontal"]["component"], "up");
    assert_eq!(run(&format!("file = '{table}'\ncolumn = 2")).0["excitation"]["horizontal"]["component"], "h1");
    let titled = fixture("table/skip-rows.txt");
    run(&format!("file = '{titled}'\nskip_rows = 2\nunits = \"cm/s2\""));

    let at2 = std::fs::read_to_string(fixture("peer/RSN9001_HOLLOW_MIL090.AT2")).expect("it ships");
    std::fs::write(here.path().join("short.AT2"), at2.replace("NPTS=    42", "NPTS=    50")).expect("written");
    let (summary, _) = run("file = \"short.AT2\"\nlenient = true");
    assert!(summary["warnings"][0].as_str().is_some_and(|warning| warning.contains("declares 50")), "{summary}");
    for (keys, parts) in [
        ("file = \"short.AT2\"", ["line 6", "declares 50"]),
        ("file = \"short.AT2\"\nlenient = \"yes\"", ["line 7", "give true or false"]),
        ("file = \"short.AT2\"\nchannel = 0", ["line 7", "give a whole number from 1 to 9e15"]),
        ("file = \"short.AT2\"\nskip_rows = 1.5", ["line 7", "out of range"]),
        ("accel = [0.0, 1.0]\ndt = 0.1\nlenient = true", ["line 8", "give `file` instead"]),
        ("file = \"short.AT2\"\nlenient = true\ndt = 0.02", ["line 6", "`dt` is given as 0.02 s"]),
    ] {
        std::fs::write(here.path().join("scene.toml"), scene(keys)).expect("written");
        refused(here.path(), &["run", "scene.toml", "--out", "out"], &parts);
    }
}

/// `--damping` is that of `--sa` and of `--scale-to`, and nothing without them. Columns are of tables.
#[test]
fn options_that_have_no_effect_are_refused() {
    let here = tempfile::tempdir().expect("a folder");
    let at2 = fixture("peer/RSN9001_HOLLOW_MIL090.AT2");
    let peak = |arguments: &[&str]| {
        let arguments = [&["record", at2.as_str(), "--scale-to", "sa(0.2)=3"], arguments].concat();
        json(here.path(), &arguments)["pga"].as_f64().expect("a number")
    };
    let [usual, damped, named] = [&[][..], &["--damping", "0.2"], &["--sa", "0.2"]].map(peak);
    assert!(usual == named && damped > 1.02 * usual, "{usual} {damped}");
    refused(here.path(), &["record", &at2, "--damping", "0.2"], &["--sa"]);
    for (option, value) in [("--column", "2"), ("--skip-rows", "1")] {
        let key = option.trim_start_matches("--").replace('-', "_");
        refused(here.path(), &["record", &at2, option, value], &["text tables", "PEER AT2", &key[..4]]);
    }
}
