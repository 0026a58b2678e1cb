//! `rocking record` tells what it understood of a record and what the record measures, writes it, and lists folders; scenes take
//! the same files.

use crate::common::scenes::SCENE;
use crate::common::{Folder, project, project_text};
use crate::ida;
use rocking::{Motion, Scene};
use serde_json::Value;

const RECORDS: &str = "ground/tests/records";

/// The path of a record of the project.
fn fixture(name: &str) -> String {
    project(&format!("{RECORDS}/{name}"))
}

#[test]
fn a_record_is_told_with_its_measures() {
    let folder = Folder::new();
    let text = folder.succeeds(&["record", &fixture("peer/RSN9001_HOLLOW_MIL090.AT2")]);
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
    let folder = Folder::with("triangle.csv", "t [s], a [m/s2]\n0,0\n0.5,3\n1,0\n");
    let told = folder.answers("record triangle.csv --json");
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
    assert!(folder.succeeds("record triangle.csv").contains("drifts"));
}

#[test]
fn a_record_is_trimmed_scaled_and_written_and_reads_back() {
    let folder = Folder::new();
    let file = fixture("csmip/three-channels.V2");
    let cut = ["record", &file, "--channel", "3", "--trim", "0.1..0.3", "--pga-g", "0.5", "--out", "x.csv", "--json"];
    let told = folder.answers(&cut);
    assert_eq!(told["samples"], 21);
    assert!((told["pga_g"].as_f64().expect("a number") - 0.5).abs() < 1e-12);
    let back = folder.answers("record x.csv --json");
    for key in ["samples", "dt", "pga", "pgv", "pgd", "arias", "significant_start"] {
        assert_eq!(back[key], told[key], "{key}");
    }
    for trim in [&["--trim", "0.1", "0.3"][..], &["--trim=0.1:0.3"], &["--trim", "0.1,0.3"]] {
        let other = folder.answers(&[&["record", &file, "--channel", "3", "--json"], trim].concat()[..]);
        assert_eq!(other["samples"], 21, "{trim:?}");
    }
    assert_eq!(folder.answers("record --trim 0.1.. x.csv --json")["samples"], 11);
    folder.refused("record x.csv --trim 0,1", &["0,1", "decimal comma", "--trim 2..8"]);
    assert_eq!(folder.answers("record x.csv --trim ..0.05 --json")["samples"], 6);
    let twice = folder.answers("record x.csv --scale -2 --json");
    assert!((twice["pga_g"].as_f64().expect("a number") - 1.0).abs() < 1e-12);
    // The written file is the only one there.
    assert_eq!(folder.names(""), ["x.csv"]);
}

#[test]
fn what_the_file_lacks_is_asked_for_by_its_option() {
    let folder = Folder::new();
    let one = fixture("table/one-column.txt");
    // Its first line states the unit; without that line nothing does.
    let text = project_text(&format!("{RECORDS}/table/one-column.txt"));
    let (_, samples) = text.split_once('\n').expect("lines");
    folder.write("silent.txt", samples);
    folder.refused("record silent.txt", &["silent.txt", "unit", "`--units`"]);
    folder.refused(&["record", &one], &["sampling interval", "`--dt`"]);
    folder.refused(&["record", &one, "--units", "gal"], &["sampling interval", "`--dt`"]);
    assert_eq!(folder.answers(&["record", &one, "--units", "gal", "--dt", "0.01", "--json"])["samples"], 42);
    let titled = fixture("table/skip-rows.txt");
    folder.refused(&["record", &titled], &["line 1, column 1", "`Invented`", "`--skip-rows`"]);
    assert_eq!(folder.answers(&["record", &titled, "--skip-rows", "2", "--units", "cm/s2", "--json"])["samples"], 42);
    let several = fixture("table/three-columns.csv");
    folder.refused(&["record", &several], &["h1, up", "`--column`"]);
    assert_eq!(folder.answers(&["record", &several, "--column", "up", "--json"])["component"], "up");
    let at2 = fixture("peer/RSN9001_HOLLOW_MIL090.AT2");
    folder.refused(&["record", &at2, "--dt", "0.02"], &["`--dt` is given as 0.02 s", "line 4"]);
}

#[test]
fn bad_input_is_refused_with_its_place() {
    let folder = Folder::new();
    let at2 = project_text(&format!("{RECORDS}/peer/RSN9001_HOLLOW_MIL090.AT2"));
    folder.write("short.AT2", at2.replace("NPTS=    42", "NPTS=    50"));
    folder.write("nan.AT2", at2.replace("   .3384353E-02", "            NaN"));
    folder.write("binary", [0_u8, 159, 146, 150, 255]);
    folder.write("empty", "");
    folder.refused("record short.AT2", &["short.AT2", "line 4", "declares 50", "has 42", "`--lenient`"]);
    assert_eq!(folder.answers("record short.AT2 --lenient --json")["samples"], 42);
    folder.refused("record nan.AT2", &["nan.AT2", "line 5, column 13", "`NaN`", "mend or remove"]);
    folder.refused("record binary", &["binary", "no text", "save it as text"]);
    folder.refused("record empty", &["empty", "the file is empty"]);
    folder.refused("record none.AT2", &["none.AT2", "check the path"]);
    folder.refused("record", &["<FILE>"]);
    folder.refused("record --trim 1..2", &["no record file is named"]);
    let at2 = fixture("peer/RSN9001_HOLLOW_MIL090.AT2");
    for trim in ["2..1", "x..2", "1", "30..40", "nan..1"] {
        folder.refused(&["record", &at2, "--trim", trim], &["--trim", trim, "2..8"]);
    }
    for pga in ["0", "-1", "nan", "inf", "x"] {
        folder.refused(&["record", &at2, &format!("--pga-g={pga}")], &["--pga-g", "give a "]);
    }
    folder.refused(&["record", &at2, "--pga-g", "1", "--scale", "2"], &["cannot be used with"]);
    folder.refused(&["record", &at2, "--units", "knots"], &["knots", "choose g, mg, m/s2"]);
    folder.refused(&["record", &at2, "--out", "no/folder/x.csv"], &["x.csv", "choose a file"]);
    for name in ["x.parquet", "x.xlsx"] {
        folder.refused(&["record", &at2, "--out", name], &[name, "written as CSV"]);
    }
    folder.refused(&["record", &at2, "--trim", "5..5"], &["--trim 5..5: it is empty"]);
    folder.refused(&["record", &at2, "--trim", "900.."], &["from 900 s on the record has 0 sample(s)"]);
    folder.refused(&["record", &at2, "--channel", "2"], &["channel 2"]);
}

#[test]
fn a_folder_is_listed_by_record_and_direction() {
    let folder = Folder::new();
    for name in ["RSN9001_HOLLOW_MIL090.AT2", "RSN9001_HOLLOW_MIL000.AT2", "RSN9001_HOLLOW_MIL-UP.AT2", "velocity.VT2"]
    {
        folder.copy(&format!("{RECORDS}/peer/{name}"), name);
    }
    folder.copy(&format!("{RECORDS}/knet/XXX0010103040506.EW"), "XXX0010103040506.EW");
    let told = folder.answers("record . --json");
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
    let text = folder.succeeds("record .");
    assert!(text.contains("vertical    RSN9001_HOLLOW_MIL-UP.AT2  PGA 0.2440 g  dt 0.01 s  n 42"), "{text}");
    assert!(text.contains("not read\n  velocity.VT2: line 3: this is no acceleration"), "{text}");
    folder.refused("record . --out x.csv", &["--out is for a single record"]);

    let none = Folder::with("notes.txt", "nothing of a record\n");
    none.refused("record .", &["none of its 1 file(s)", "notes.txt"]);
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
    let folder = Folder::new();
    let run = |keys: &str| -> (Value, String) {
        folder.write("scene.toml", scene(keys));
        let (_, message) = folder.says("run scene.toml --out out");
        (folder.summary(), message)
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

    let at2 = project_text(&format!("{RECORDS}/peer/RSN9001_HOLLOW_MIL090.AT2"));
    folder.write("short.AT2", at2.replace("NPTS=    42", "NPTS=    50"));
    let (summary, _) = run("file = \"short.AT2\"\nlenient = true");
    assert!(summary["warnings"][0].as_str().is_some_and(|warning| warning.contains("declares 50")), "{summary}");
    for (keys, parts) in [
        ("file = \"short.AT2\"", ["line 6", "declares 50"]),
        ("file = \"short.AT2\"\nlenient = \"yes\"", ["line 7", "give true or false"]),
        ("file = \"short.AT2\"\nchannel = 0", ["line 7", "give a whole number from 1 on"]),
        ("file = \"short.AT2\"\nskip_rows = 1.5", ["line 7", "out of range"]),
        ("accel = [0.0, 1.0]\ndt = 0.1\nlenient = true", ["line 8", "give `file` instead"]),
        ("file = \"short.AT2\"\nlenient = true\ndt = 0.02", ["line 6", "`dt` is given as 0.02 s"]),
    ] {
        folder.write("scene.toml", scene(keys));
        folder.refused("run scene.toml --out out", &parts);
    }
}

/// `--damping` is that of `--sa` and of `--scale-to`, and nothing without them. Columns are of tables.
#[test]
fn options_that_have_no_effect_are_refused() {
    let folder = Folder::new();
    let at2 = fixture("peer/RSN9001_HOLLOW_MIL090.AT2");
    let peak = |arguments: &[&str]| {
        let arguments = [&["record", at2.as_str(), "--scale-to", "sa(0.2)=3", "--json"], arguments].concat();
        folder.answers(&arguments[..])["pga"].as_f64().expect("a number")
    };
    let [usual, damped, named] = [&[][..], &["--damping", "0.2"], &["--sa", "0.2"]].map(peak);
    assert!(usual == named && damped > 1.02 * usual, "{usual} {damped}");
    // A ratio that the measure names is its own, also if it is the usual one.
    let own = folder.answers(&["record", &at2, "--scale-to", "sa(0.2 0.05)=3", "--damping", "0.2", "--json"][..]);
    assert_eq!(own["pga"].as_f64(), Some(usual));
    folder.refused(&["record", &at2, "--damping", "0.2"], &["--sa"]);
    folder.refused(&["record", &at2, "--damping", "0.2", "--scale-to", "pgv=0.5"], &["--damping", "--sa"]);
    for (option, value) in [("--column", "2"), ("--skip-rows", "1")] {
        let key = option.trim_start_matches("--").replace('-', "_");
        folder.refused(&["record", &at2, option, value], &["text tables", "PEER AT2", &key[..4]]);
    }
}

#[test]
fn inputs_of_init_and_record_are_not_written_over() {
    let folder = Folder::with("scene.toml", SCENE);
    let samples = "time,acceleration (m/s2)\n0.0,0.0\n0.1,1.0\n0.2,-1.0\n0.3,0.0\n";
    folder.write("a.csv", samples);
    folder.refused("init a.csv --force --record a.csv", &["a.csv"]);
    folder.refused("record a.csv --scene scene.toml --out scene.toml", &["scene.toml"]);
    assert_eq!(folder.read("a.csv"), samples);
    assert_eq!(folder.read("scene.toml"), SCENE);
}

/// The file has the word, not the option.
#[test]
fn words_of_a_record_are_quoted_as_they_are() {
    let folder = Folder::with("a.txt", "units g d 0.01\n0.1 0.2 0.3 0.4 0.5\n0.1 0.2 0.3 0.4 0.5\n");
    folder.refused("record a.txt", &["`units` is no number", "`--skip-rows`"]);
    folder.write("b.txt", "0.1\n0.2\n0.3\n");
    folder.refused("record b.txt", &["`--units`"]);
}

/// Scenes take records at any size, and `rocking record` measures what it scales to.
#[test]
fn records_are_scaled_to_any_measure() {
    let folder = ida::folder();
    for (size, told) in [
        ("pgv=0.5", "PGV                   0.5 m/s"),
        ("pga_g=0.2", "PGA                   0.2 g"),
        ("arias=1.5", "Arias intensity       1.5 m/s"),
        ("cav=3", "CAV                   3 m/s"),
        ("sa_g(0.7)=0.4", "Sa(0.7 s, 5 %)        0.4 g"),
        ("pgv_uplift=2", "p PGV/(g tan α)       2\n"),
        ("pga_uplift=1.25", "PGA/(g tan α)         1.25\n"),
    ] {
        let command = format!("record records/A_H1.csv --scale-to {size} --sa 0.7 --scene block.toml");
        let text = folder.succeeds(&command);
        assert!(text.contains(told), "{size}: {text}");
        // The same size in a scene.
        let (key, value) = size.split_once('=').expect("both");
        let key = key.split('(').next().expect("a name");
        let period = if key.starts_with("sa") { "sa_period = 0.7\n" } else { "" };
        let scene = format!(
            "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 0.8\n[excitation.horizontal]\nkind = \"record\"\nfile = \"records/A_H1.csv\"\n{key} = {value}\n{period}"
        );
        folder.write("scene.toml", scene);
        let scene = Scene::from_file(&folder.path("scene.toml")).expect("valid");
        let Some(Motion::Record(record)) = scene.excitation.horizontal else { panic!("a record") };
        let factor = folder.answers(&format!("{command} --json"))["scale"].as_f64().expect("a number");
        assert!((record.scale() / factor - 1.0).abs() < 1e-12, "{size}: {} and {factor}", record.scale());
    }
    // On Mars, one g of the file and of what is asked for is the gravity of the scene.
    folder.write("mars.toml", "gravity = 3.71\n[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 0.8\n");
    let told = folder.answers("record records/A_H1.csv --scene mars.toml --scale-to pga_g=0.2 --json");
    let pga = ["pga", "pga_g", "pga_uplift", "gravity"].map(|key| told[key].as_f64().expect("a number"));
    for (found, expected) in pga.into_iter().zip([0.2 * 3.71, 0.2, 0.2 / 0.25, 3.71]) {
        assert!((found / expected - 1.0).abs() < 1e-12, "{told}");
    }
    // A column that does not stand by itself has no size in uplift.
    let leaning = "[column]\nblocks = 3\nhalf_width = 0.4\nhalf_height = 3.0\n[initial]\nslide = [0.0, 0.7, 0.7]\n";
    folder.write("leaning.toml", leaning);
    for size in ["pga_uplift=1", "pgv_uplift=1"] {
        let command = format!("record records/A_H1.csv --scale-to {size} --scene leaning.toml");
        folder.refused(&command[..], &["--scale-to pg", "does not stand by itself", "name another measure"]);
    }
    folder.refused("record records/A_H1.csv --scale-to pga_uplift=1", &["name its scene with --scene"]);
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
        folder.write("scene.toml", scene);
        folder.refused("check scene.toml", &[word]);
    }
}
