//! Faults that were mended, a claim each.

mod common;

use common::sweeps::{BASE, SWEEP, folder, long};
use common::{rocking, succeeds};
use serde_json::Value;
use std::fs::{read, read_dir, read_to_string, write};
use std::path::Path;
use std::process::Command;
use std::time::Duration;

const SCENE: &str = "title = \"one block\"
friction = 0.8
[[block]]
half_width = 0.4
half_height = 1.6
[excitation.horizontal]
kind = \"sine-pulse\"
amplitude = 4.0
omega = 10.0
[solver]
t_end = 2.0
";

/// A folder with `scene.toml`.
fn folder_with(scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path().join("scene.toml"), scene).expect("written");
    folder
}

/// The message of a command that must end with this status.
fn fails(folder: &Path, arguments: &[&str], status: i32, named: &[&str]) -> String {
    let output = rocking(folder, arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {message}");
    assert!(named.iter().all(|part| message.contains(part)), "{named:?} in\n{message}");
    message
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn a_sweep_without_any_result_fails_with_the_first_reason() {
    let folder = folder("scene = \"base.toml\"\n[axes]\neta = [1.5, 2.5]\n");
    for arguments in
        [&["sweep", "sweep.toml"][..], &["sweep", "sweep.toml", "--quiet"], &["sweep", "sweep.toml", "--json"]]
    {
        fails(folder.path(), arguments, 1, &["sweep.csv", "none of the 2 point(s)", "restitution.eta", "1.5"]);
    }
    write(folder.path().join("sweep.toml"), "scene = \"base.toml\"\n[axes]\neta = [1.5, 0.9]\n").expect("written");
    assert!(succeeds(folder.path(), &["sweep", "sweep.toml"]).contains("errors 1"));
}

#[test]
fn an_unreadable_record_does_not_switch_off_the_check_for_unknown_keys() {
    let axes =
        |key: &str| format!("scene = \"base.toml\"\n[axes]\nfile = {{ folder = \"records\" }}\n{key} = [0.3, 0.6]\n");
    let folder = folder(&axes("pga_gg"));
    std::fs::create_dir(folder.path().join("records")).expect("made");
    let synthetic = common::root().join("scenes/records/synthetic.AT2");
    std::fs::copy(&synthetic, folder.path().join("records/b.AT2")).expect("copied");
    write(folder.path().join("records/a.txt"), "no record\n").expect("written");
    let pulse = "kind = \"sine-pulse\"\namplitude = 3.0\nomega = 10.0";
    write(folder.path().join("base.toml"), BASE.replace(pulse, "kind = \"record\"\nfile = \"records/b.AT2\""))
        .expect("written");
    fails(folder.path(), &["sweep", "sweep.toml"], 2, &["pga_gg", "unknown"]);
    assert!(!folder.path().join("sweep.csv").exists());
    write(folder.path().join("sweep.toml"), axes("pga_g")).expect("written");
    let told = succeeds(folder.path(), &["sweep", "sweep.toml"]);
    assert!(told.contains("errors 2") && told.contains("the first error: "), "{told}");
}

#[test]
fn a_figure_of_modes_has_the_format_of_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    succeeds(folder.path(), &["modes", "--blocks", "2", "--svg", "m.png"]);
    assert!(read(folder.path().join("m.png")).expect("written").starts_with(b"\x89PNG\r\n\x1a\n"));
    succeeds(folder.path(), &["modes", "--blocks", "2", "--svg", "m.SVG"]);
    assert!(read_to_string(folder.path().join("m.SVG")).expect("written").starts_with("<svg"));
    fails(folder.path(), &["modes", "--blocks", "2", "--svg", "m.jpg"], 2, &[".svg"]);
}

#[test]
fn a_sweep_file_is_checked_as_a_sweep() {
    let folder = folder(SWEEP);
    let text = succeeds(folder.path(), &["check", "sweep.toml"]);
    for part in ["60 point(s)", "blocks: 2 value(s), from 1 to 2", "base.toml is valid", "rocking sweep sweep.toml"] {
        assert!(text.contains(part), "`{part}` is not in\n{text}");
    }
    let found: Value =
        serde_json::from_str(&succeeds(folder.path(), &["check", "sweep.toml", "--json"])).expect("JSON");
    assert_eq!((&found["points"], found["axes"].as_array().map(Vec::len)), (&60.into(), Some(3)));
    write(folder.path().join("base.toml"), BASE.replace("eta = 0.9", "eta = 9")).expect("written");
    fails(folder.path(), &["check", "sweep.toml"], 2, &["base.toml", "restitution.eta"]);
}

#[test]
fn the_name_of_the_friction_line_covers_no_curve() {
    let folder = folder_with(SCENE);
    succeeds(folder.path(), &["run", "scene.toml", "--plots"]);
    let figure = read_to_string(folder.path().join("out/forces.svg")).expect("written");
    let document = roxmltree::Document::parse(&figure).expect("XML");
    let height = |name: &str| -> f64 {
        let mut texts = document.descendants().filter(|node| node.has_tag_name("text"));
        let text = texts.find(|node| node.text() == Some(name)).unwrap_or_else(|| panic!("{name}"));
        text.attribute("y").and_then(|y| y.parse().ok()).expect("a number")
    };
    assert!(height("friction coefficient 0.8") > height("Time [s]"), "it stands below the panels");
    // White patches below words are the only areas of that fill.
    let patches =
        document.descendants().filter(|node| node.has_tag_name("path") && node.attribute("fill") == Some("#ffffff"));
    assert_eq!(
        patches.count(),
        usize::from(figure.contains("overturned")) * 2 + usize::from(figure.contains("at rest")) * 2
    );
}

#[test]
fn figures_and_reports_of_an_earlier_run_do_not_stay() {
    let folder = folder_with(SCENE);
    succeeds(folder.path(), &["run", "scene.toml", "--plots", "--report"]);
    succeeds(folder.path(), &["plot", "out", "--format", "png"]);
    write(folder.path().join("out/notes.txt"), "mine").expect("written");
    assert_eq!(names(&folder.path().join("out")).len(), 13);
    // A refused scene and a run that is asked for nothing else.
    fails(folder.path(), &["run", "none.toml"], 2, &["none.toml"]);
    assert_eq!(names(&folder.path().join("out")).len(), 13);
    succeeds(folder.path(), &["run", "scene.toml"]);
    assert_eq!(names(&folder.path().join("out")), ["events.json", "notes.txt", "response.csv", "summary.json"]);
    succeeds(folder.path(), &["run", "scene.toml", "--report"]);
    assert_eq!(names(&folder.path().join("out")).len(), 5);
}

#[test]
fn impacts_are_blank_where_a_run_ends_when_its_outcome_is_certain() {
    for (ask, overturns, rocks) in [("outcome", true, false), ("overturns", false, false), ("peaks", true, true)] {
        let folder = folder(&format!("ask = \"{ask}\"\n{SWEEP}"));
        let table = common::sweeps::table(folder.path(), &[]);
        let (mut seen, mut reader) = (0, csv::Reader::from_reader(table.as_bytes()));
        for row in reader.records() {
            let row = row.expect("a row");
            let counted = match &row[4] {
                "no-uplift" => true,
                "rocks" => rocks,
                _ => overturns,
            };
            seen += usize::from(&row[4] != "no-uplift");
            assert_eq!(counted, !row[5].is_empty(), "{ask}: {row:?}");
        }
        assert!(seen > 10);
        succeeds(folder.path(), &["plot", "t.csv"]);
        let figure = read_to_string(folder.path().join("t.svg")).expect("written");
        assert_eq!(figure.contains("overturns (impacts not counted)"), !overturns);
    }
}

#[test]
fn control_characters_reach_no_terminal() {
    let title = SCENE.replace("one block", "red \\u001b[31m, \\u009b, \\u202e and\\nnext <b>");
    let folder = folder_with(&title);
    let name = "a\u{1b}[31mb.toml";
    write(folder.path().join(name), &title).expect("written");
    write(folder.path().join("bad\u{7}.toml"), "title = \"\u{1b}[31m\"\n").expect("written");
    write(folder.path().join("c\u{1b}.AT2"), "1\n").expect("written");
    std::fs::create_dir(folder.path().join("records\u{1b}")).expect("made");
    for arguments in [
        &["run", name, "--out", "o\u{1b}"][..],
        &["run", name, "--json"],
        &["check", name],
        &["check", name, "--json"],
        &["run", "bad\u{7}.toml"],
        &["run", "none\u{1b}.toml"],
        &["record", "c\u{1b}.AT2"],
        &["record", "records\u{1b}"],
        &["plot", "o\u{1b}"],
        &["report", "o\u{1b}", "--out", "r\u{1b}.html"],
        &["init", "i\u{1b}.toml"],
        &["thresholds", "bad\u{7}.toml"],
        &["modes", "--blocks", "1", "--svg", "m\u{1b}.svg"],
    ] {
        let output = rocking(folder.path(), arguments);
        for text in [output.stdout, output.stderr] {
            let text = String::from_utf8(text).expect("text");
            let is_safe = |sign: char| !sign.is_control() && sign != '\u{202e}' || sign == '\n';
            assert!(text.chars().all(is_safe), "{arguments:?}: {text:?}");
        }
    }
    let told = succeeds(folder.path(), &["run", name]);
    assert!(told.starts_with("red \\u{1b}[31m, \\u{9b}, \\u{202e} and next <b>\n"), "{told}");
    let summary: Value = serde_json::from_str(&succeeds(folder.path(), &["run", name, "--json"])).expect("JSON");
    assert_eq!(summary["title"], "red \u{1b}[31m, \u{9b}, \u{202e} and\nnext <b>", "JSON has the text itself");
    let page = read_to_string(folder.path().join("r\u{1b}.html")).expect("written");
    assert!(page.contains("red \\u{1b}[31m, \\u{9b}, \\u{202e} and\nnext &lt;b&gt;"));
    assert!(page.chars().filter(|sign| *sign != '\n' && *sign != '\t').all(|sign| !sign.is_control()));
}

#[test]
fn a_number_that_is_not_finite_is_a_word_in_json() {
    // The lowest contact parts with a force along it.
    let folder = tempfile::tempdir().expect("a folder");
    let scene = common::root().join("scenes/paper-1-block-6.32.toml");
    succeeds(folder.path(), &["run", &scene.to_string_lossy()]);
    let summary: Value =
        serde_json::from_str(&read_to_string(folder.path().join("out/summary.json")).expect("written")).expect("JSON");
    assert_eq!(summary["friction_demand"][0], "infinite");
    succeeds(folder.path(), &["report", "out"]);
    let page = read_to_string(folder.path().join("out/report.html")).expect("written");
    // It parts in the fall, which does not count.
    assert!(!page.contains("no friction coefficient is enough") && page.contains("point of no return"));
    // As earlier versions wrote it.
    let old = read_to_string(folder.path().join("out/summary.json")).expect("written").replace("\"infinite\"", "null");
    write(folder.path().join("out/summary.json"), old).expect("written");
    succeeds(folder.path(), &["report", "out", "--out", "old.html"]);
    assert_eq!(read_to_string(folder.path().join("old.html")).expect("written"), page);
    // A displacement beyond the range of doubles.
    write(folder.path().join("huge.csv"), "t,a\n0,1e304\n1e5,1e304\n2e5,1e304\n").expect("written");
    let output = rocking(folder.path(), &["record", "huge.csv", "--units", "m/s2", "--json"]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(!output.status.success() || text.contains("\"infinite\"") && !text.contains("\"pgd\": null"), "{text}");
}

#[test]
fn shards_of_another_base_scene_are_not_merged() {
    let folder = folder(SWEEP);
    let shard = |number: &str, name: &str| {
        succeeds(folder.path(), &["sweep", "sweep.toml", "--shard", number, "--out", name, "--quiet"]);
    };
    shard("1/2", "1.csv");
    write(folder.path().join("base.toml"), BASE.replace("eta = 0.9", "eta = 0.8")).expect("written");
    shard("2/2", "2.csv");
    let problem = ["2.csv", "base scene", "1.csv", "all shards of one sweep"];
    fails(folder.path(), &["merge", "m.csv", "1.csv", "2.csv"], 2, &problem);
    fails(folder.path(), &["merge", "m.csv", "1.csv", "2.csv", "--sweep", "sweep.toml"], 2, &["1.csv", "sweep.toml"]);
    assert!(!folder.path().join("m.csv").exists());
    shard("1/2", "1.csv");
    succeeds(folder.path(), &["merge", "m.csv", "1.csv", "2.csv", "--sweep", "sweep.toml"]);
}

/// The table of a shard and the digest of its sweep change together: a job that is killed leaves both of the job before.
#[test]
fn a_shard_whose_last_run_was_killed_is_not_merged_with_newer_ones() {
    let folder = folder(&long());
    let shard = |number: &str| ["sweep", "sweep.toml", "--shard", number, "--quiet"].map(String::from);
    let run = |number: &str| {
        let arguments = shard(number);
        succeeds(folder.path(), &arguments.each_ref().map(String::as_str));
    };
    run("1/2");
    run("2/2");
    write(folder.path().join("base.toml"), BASE.replace("eta = 0.9", "eta = 0.8")).expect("written");
    run("1/2");
    let mut killed = Command::new(env!("CARGO_BIN_EXE_rocking"));
    let mut killed =
        killed.args(shard("2/2")).args(["--threads", "1"]).current_dir(folder.path()).spawn().expect("started");
    let is_under_way = || names(folder.path()).iter().any(|name| name.ends_with(".part"));
    while !is_under_way() {
        std::thread::sleep(Duration::from_millis(1));
    }
    killed.kill().expect("SIGKILL");
    assert!(!killed.wait().expect("it ends").success(), "it was killed too late");
    let merge = ["merge", "m.csv", "sweep-1-of-2.csv", "sweep-2-of-2.csv", "--sweep", "sweep.toml"];
    fails(folder.path(), &merge, 2, &["sweep-2-of-2.csv", "base scene"]);
    run("2/2");
    succeeds(folder.path(), &merge);
    // A sweep that is no shard leaves no digest beside its table.
    succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "sweep-2-of-2.csv", "--quiet"]);
    assert!(!names(folder.path()).contains(&"sweep-2-of-2.csv.digest".to_string()));
}

#[test]
fn results_are_not_written_over_what_they_are_made_of() {
    let record = "excitation.horizontal = { kind = \"record\", file = \"response.csv\" }\n";
    let folder = folder_with(&format!("{record}[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n"));
    let samples = "time,acceleration (m/s2)\n0.0,0.0\n0.1,1.0\n0.2,-1.0\n0.3,0.0\n";
    write(folder.path().join("response.csv"), samples).expect("written");
    fails(folder.path(), &["run", "scene.toml", "--out", "."], 2, &["response.csv"]);
    assert_eq!(read_to_string(folder.path().join("response.csv")).expect("it is still there"), samples);
    succeeds(folder.path(), &["run", "scene.toml", "--out", "out", "--quiet"]);
    for name in ["summary.json", "response.csv", "events.json"] {
        let own = folder.path().join("out").join(name);
        let before = read(&own).expect("written");
        fails(folder.path(), &["report", "out", "--out", &format!("out/{name}")], 2, &[name]);
        assert!(read(&own).expect("it is still there") == before, "{name}");
    }
}

/// Columns of blocks are told by their numbers, not by their order: without `peak_2`, `peak_3` was read in its place.
#[test]
fn a_table_that_lacks_the_column_of_a_block_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let table = "record,PGV,outcome,peak_1,peak_3\na,0.1,rocks,0.1,0.3\na,0.2,rocks,0.2,0.6\n";
    write(folder.path().join("t.csv"), table).expect("written");
    fails(folder.path(), &["fragility", "t.csv", "--state", "peak_2 > 0.2"], 2, &["t.csv", "peak_2"]);
    let swapped = "record,PGV,outcome,peak_2,peak_1\na,0.1,rocks,0.9,0.1\na,0.2,rocks,0.9,0.2\n";
    write(folder.path().join("t.csv"), swapped).expect("written");
    let told = succeeds(folder.path(), &["fragility", "t.csv", "--state", "peak_1 > 0.5"]);
    assert!(told.contains("no run"), "{told}");
}

#[cfg(unix)]
#[test]
fn only_regular_files_up_to_a_size_are_read() {
    let folder = folder(SWEEP);
    let pipe = folder.path().join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success()));
    let large = std::fs::File::create(folder.path().join("large")).expect("made");
    large.set_len(1 << 41).expect("a sparse file");
    succeeds(folder.path(), &["run", "base.toml"]);
    for (file, problem) in [("/dev/zero", "device or a pipe"), ("pipe", "device or a pipe"), ("large", "at most")] {
        for arguments in [
            &["run", file][..],
            &["check", file],
            &["thresholds", file],
            &["sweep", file],
            &["plot", file],
            &["record", file],
            &["init", "new.toml", "--record", file],
            &["merge", "m.csv", file],
            &["merge", "m.csv", "sweep.csv", "--sweep", file],
        ] {
            fails(folder.path(), arguments, 2, &[file, problem]);
        }
    }
    std::fs::remove_file(folder.path().join("out/events.json")).expect("there");
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("out/events.json")).expect("a link");
    for command in ["plot", "report"] {
        fails(folder.path(), &[command, "out"], 2, &["events.json", "device or a pipe", "run the scene again"]);
    }
}

/// Files that read well and are not those of the run: cut at the end of a line, or from another run of the same length.
#[test]
fn files_of_another_run_are_refused() {
    let folder = folder_with(SCENE);
    succeeds(folder.path(), &["run", "scene.toml"]);
    for (file, from, to) in [
        ("response.csv", "\n2.0,", "\n"),
        ("response.csv", "\n0.01,0.0", "\n0.01,0.00"),
        ("events.json", "\"kind\":\"impact\"", "\"kind\":\"opening\""),
    ] {
        let path = folder.path().join("out").join(file);
        let whole = read_to_string(&path).expect("written");
        let other = match file {
            "response.csv" if to == "\n" => whole[..whole.find(from).expect("a last row") + 1].to_string(),
            _ => whole.replacen(from, to, 1),
        };
        assert_ne!(whole, other, "`{from}` is in {file}");
        write(&path, other).expect("written");
        for command in ["plot", "report"] {
            fails(
                folder.path(),
                &[command, "out"],
                2,
                &[file, "cut, changed, or of another run", "run the scene again"],
            );
        }
        write(&path, whole).expect("written");
    }
    succeeds(folder.path(), &["report", "out"]);
}

/// Damages that made figures panic, or take all memory.
#[cfg(unix)]
#[test]
fn damaged_run_folders_are_refused_with_file_and_remedy() {
    let folder = folder_with(SCENE);
    succeeds(folder.path(), &["run", "scene.toml"]);
    for (file, from, to) in [
        ("summary.json", "\"t_end\": 2.0", "\"t_end\": 1e300"),
        ("summary.json", "\"t_end\": 2.0", "\"t_end\": -2.0"),
        ("summary.json", "\"bottom_half_width\": 0.4", "\"bottom_half_width\": 5e-324"),
        ("summary.json", "\"bottom_half_width\": 0.4", "\"bottom_half_width\": 1e300"),
        ("summary.json", "\"overturned_block\": null", "\"overturned_block\": 9"),
        ("summary.json", "\"peak_theta\": [", "\"peak_theta\": [0.1,"),
        ("summary.json", "\"friction_demand\": [", "\"friction_demand\": [0.1,"),
        ("events.json", "\"before\":[", "\"before\":[1,"),
        ("events.json", "\"omega_after\":[", "\"omega_after\":[1.0,"),
        ("events.json", "\"omega_before\":[", "\"omega_before\":[1e300,"),
        ("events.json", "\"t\":", "\"t\":-1"),
        ("response.csv", "\n0.01,", "\n1e300,"),
        ("response.csv", "\n0.02,", "\n0.01,"),
    ] {
        let path = folder.path().join("out").join(file);
        let whole = read_to_string(&path).expect("written");
        assert!(whole.contains(from), "`{from}` is not in {file}");
        write(&path, whole.replacen(from, to, 1)).expect("written");
        for command in ["plot", "report"] {
            let output = common::limited(folder.path(), &[command, "out"]).output().expect("a shell");
            let message = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{from} to {to}: {message}");
            assert!(message.contains(file) && message.contains("run the scene again"), "{message}");
        }
        write(&path, whole).expect("written");
    }
    succeeds(folder.path(), &["plot", "out"]);
}

/// `slide` and `x` both say where blocks are: the motion followed `x`, slenderness and peaks `slide`.
#[test]
fn slides_of_blocks_that_are_placed_are_refused() {
    let placed = "[initial]\nx = [0.0, 0.0]\ny = [0.78, 2.34]\nvx = [0.0, 0.0]\nvy = [0.0, 0.0]\nslide = [0.0, 0.3]\n";
    let column = "friction = 0.5\n[column]\nblocks = 2\nhalf_width = 0.4\nhalf_height = 1.56\n";
    let folder = folder_with(&format!("{column}{placed}"));
    fails(folder.path(), &["check", "scene.toml"], 2, &["line 11", "initial.slide", "leave it out"]);
    write(folder.path().join("scene.toml"), format!("{column}{}", placed.replace("0.3]", "0.0]"))).expect("written");
    succeeds(folder.path(), &["check", "scene.toml"]);
}

#[test]
fn what_a_motion_does_before_the_run_begins_is_said_to_be_lost() {
    let folder = folder_with(&SCENE.replace("omega = 10.0", "omega = 10.0\nstart = -0.3"));
    for command in ["check", "run"] {
        let output = rocking(folder.path(), &[command, "scene.toml"]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains("begins at t = -0.3000 s"), "{command}: {message}");
    }
}

#[test]
fn inputs_of_init_and_record_are_not_written_over() {
    let folder = folder_with(SCENE);
    let samples = "time,acceleration (m/s2)\n0.0,0.0\n0.1,1.0\n0.2,-1.0\n0.3,0.0\n";
    write(folder.path().join("a.csv"), samples).expect("written");
    fails(folder.path(), &["init", "a.csv", "--force", "--record", "a.csv"], 2, &["a.csv"]);
    fails(folder.path(), &["record", "a.csv", "--scene", "scene.toml", "--out", "scene.toml"], 2, &["scene.toml"]);
    assert_eq!(read_to_string(folder.path().join("a.csv")).expect("it is still there"), samples);
    assert_eq!(read_to_string(folder.path().join("scene.toml")).expect("it is still there"), SCENE);
}

/// A digest of a sweep does not hang on which records have been read so far: shards that print warnings read all of them first.
#[test]
fn shards_of_records_are_merged_with_their_sweep() {
    let folder = folder("scene = \"base.toml\"\n[axes]\nfile = [\"a.csv\", \"b.csv\"]\n");
    let base = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.horizontal]\nkind = \"record\"\nfile = \"a.csv\"\n";
    write(folder.path().join("base.toml"), base).expect("written");
    for name in ["a.csv", "b.csv"] {
        write(folder.path().join(name), "t (s),a (m/s2)\n0,0\n0.01,3.5\n0.02,0\n0.03,-1\n").expect("written");
    }
    for (first, second) in [(None, None), (None, Some("--quiet")), (Some("--quiet"), None)] {
        for (shard, quiet) in [("1/2", first), ("2/2", second)] {
            let arguments: Vec<&str> = ["sweep", "sweep.toml", "--shard", shard].into_iter().chain(quiet).collect();
            succeeds(folder.path(), &arguments);
        }
        let told = succeeds(
            folder.path(),
            &["merge", "m.csv", "sweep-1-of-2.csv", "sweep-2-of-2.csv", "--sweep", "sweep.toml"],
        );
        assert!(told.contains("2 row(s)"), "{told}");
    }
}

/// A base scene is read as any scene is: no device, nothing without end. One that is missing is a fault of the key that names it.
#[test]
fn base_scenes_are_regular_files_and_named_by_their_key() {
    let folder = folder("scene = \"no.toml\"\n[axes]\neta = [0.9]\n");
    write(folder.path().join("study.toml"), "scene = \"no.toml\"\nmeasure = \"pga\"\n").expect("written");
    for file in ["sweep.toml", "study.toml"] {
        let named = [file, "line 1", "`scene`", "no.toml: No such file", "relative to this file"];
        fails(folder.path(), &["check", file], 2, &named);
    }
    if cfg!(unix) {
        for file in ["sweep.toml", "study.toml"] {
            let text = read_to_string(folder.path().join(file)).expect("written").replace("no.toml", "/dev/zero");
            write(folder.path().join(file), text).expect("written");
            fails(folder.path(), &["check", file], 2, &[file, "`scene`", "/dev/zero: this is a device or a pipe"]);
        }
    }
}

/// A station's record is found in the scene's own folder as well.
#[test]
fn a_record_beside_the_scene_needs_no_folder() {
    let scene = "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.station]\nrecord = \"R1\"\n";
    let folder = folder_with(scene);
    write(folder.path().join("R1_H1.csv"), "t (s),a (m/s2)\n0,0\n0.01,1\n0.02,0\n").expect("written");
    assert!(succeeds(folder.path(), &["run", "scene.toml", "--out", "out"]).starts_with("no uplift, stands at rest"));
}

/// Each of the three commands says which one a file is for.
#[test]
fn files_of_another_kind_are_sent_to_their_command() {
    let folder = folder(SWEEP);
    write(folder.path().join("study.toml"), "scene = \"base.toml\"\nmeasure = \"pga\"\n").expect("written");
    let [run, sweep, ida] = [&["run", "--out", "out"][..], &["sweep"], &["ida", "--out", "ida.csv"]];
    for (command, file, named) in [
        (run, "sweep.toml", "`rocking sweep`"),
        (run, "study.toml", "`rocking ida`"),
        (sweep, "base.toml", "`rocking run`"),
        (sweep, "study.toml", "`rocking ida`"),
        (ida, "base.toml", "`rocking run`"),
        (ida, "sweep.toml", "`rocking sweep`"),
    ] {
        fails(folder.path(), &[command, &[file]].concat(), 2, &[file, "give it to", named]);
    }
}

/// A negative number after an option is its value, and the range of the option says what is wrong.
#[test]
fn negative_values_of_options_are_out_of_range() {
    let folder = folder_with(SCENE);
    write(folder.path().join("a.csv"), "t (s),a (m/s2)\n0,0\n0.01,1\n0.02,0\n").expect("written");
    for (arguments, named) in [
        (&["record", "a.csv", "--pga", "-0.3"][..], ["'-0.3'", "--pga"]),
        (&["record", "a.csv", "--sa", "-1"], ["'-1'", "--sa"]),
        (&["plot", "out", "--width", "-5"], ["'-5'", "--width"]),
        (&["sweep", "scene.toml", "--threads", "-1"], ["'-1'", "--threads"]),
    ] {
        let message = fails(folder.path(), arguments, 2, &named);
        assert!(message.contains("invalid value") && !message.contains("-- "), "{message}");
    }
    let turned = succeeds(folder.path(), &["record", "a.csv", "--scale", "-2"]);
    assert!(turned.contains("PGA"), "{turned}");
}

/// Before a run replaces anything, its figures and its page must have a place.
#[test]
fn a_run_whose_figure_has_no_place_leaves_the_folder_as_it_is() {
    let folder = folder_with(SCENE);
    succeeds(folder.path(), &["run", "scene.toml", "--out", "out", "--plots"]);
    let out = folder.path().join("out");
    write(folder.path().join("scene.toml"), SCENE.replace("amplitude = 4.0", "amplitude = 3.0")).expect("written");
    std::fs::create_dir(out.join("report.html")).expect("made");
    #[cfg(unix)]
    {
        std::fs::remove_file(out.join("energy.svg")).expect("removed");
        std::os::unix::fs::symlink("nowhere", out.join("energy.svg")).expect("made");
    }
    let before = read(out.join("summary.json")).expect("written");
    fails(
        folder.path(),
        &["run", "scene.toml", "--out", "out", "--report"],
        2,
        &["report.html", "a folder has this name"],
    );
    if cfg!(unix) {
        fails(folder.path(), &["run", "scene.toml", "--out", "out", "--plots"], 2, &["energy.svg", "a link"]);
    }
    assert_eq!(read(out.join("summary.json")).expect("written"), before);
    assert!(out.join("time-history.svg").is_file());
}

/// A record whose link leads nowhere is missing; without it, another component would stand for the one that was asked for.
#[cfg(unix)]
#[test]
fn links_of_a_folder_that_lead_nowhere_are_refused() {
    let folder = folder_with(&SCENE.replace(
        "[excitation.horizontal]\nkind = \"sine-pulse\"\namplitude = 4.0\nomega = 10.0\n",
        "[excitation.station]\nrecord = \"records/RSN1\"\n",
    ));
    let records = folder.path().join("records");
    std::fs::create_dir(&records).expect("made");
    let text = "t (s),a (m/s2)\n0,0\n0.01,1\n0.02,0\n";
    write(records.join("RSN1_X_090.csv"), text).expect("written");
    std::os::unix::fs::symlink("nowhere/RSN1_X_000.csv", records.join("RSN1_X_000.csv")).expect("made");
    fails(folder.path(), &["run", "scene.toml"], 2, &["RSN1_X_000.csv", "No such file"]);
    let study = "scene = \"scene.toml\"\nmeasure = \"pga\"\nlevels = [0.5]\n[records]\nfolder = \"records\"\n";
    write(folder.path().join("ida.toml"), study).expect("written");
    fails(folder.path(), &["ida", "ida.toml"], 2, &["RSN1_X_000.csv", "No such file"]);
    assert!(succeeds(folder.path(), &["record", "records"]).contains("RSN1_X_000.csv"));
}

/// Columns of one block say nothing of a second one, whether they are lost or not.
#[test]
fn fragility_takes_each_run_once_and_only_of_columns_with_the_block() {
    let folder = tempfile::tempdir().expect("a folder");
    let header = "index,record,pgv,outcome,peak_1,peak_2\n";
    let two = "0,a,0.1,rocks,0.1,0.2\n1,a,0.5,overturns,1.0,1.0\n2,b,0.1,rocks,0.1,0.4\n3,b,0.5,rocks,0.1,0.2\n";
    let one = "4,c,0.1,overturns,1.0,\n5,c,0.5,rocks,0.2,\n";
    let table = |rows: &str| write(folder.path().join("t.csv"), format!("{header}{rows}")).expect("written");
    let fit = ["fragility", "t.csv", "--state", "peak_2 > 0.3", "--replicates", "0"];
    table(two);
    succeeds(folder.path(), &fit);
    let shares = || read_to_string(folder.path().join("t-shares.csv")).expect("written");
    let alone = shares();
    table(&format!("{two}{one}"));
    succeeds(folder.path(), &fit);
    assert_eq!(shares(), alone);
    table(&format!("{two}{two}"));
    fails(folder.path(), &fit, 2, &["row 5", "give each run once"]);
    // The same numbers of another record are other runs.
    table(&format!("{two}{}", two.replace(",a,", ",d,").replace(",b,", ",e,")));
    succeeds(folder.path(), &fit);
    table(two);
    fails(folder.path(), &["fragility", "t.csv", "--replicates", "3"], 2, &["--replicates: 3", "at least 20"]);
    fails(folder.path(), &["fragility", "t.csv", "--out", "f.xlsx"], 2, &["f.xlsx", ".csv"]);
    if cfg!(feature = "parquet") {
        fails(folder.path(), &["fragility", "t.csv", "--out", "f.parquet"], 2, &["f.parquet", "written as CSV"]);
    }
}

/// The line of the base scene has a sound value: the one at fault stands on the axis.
#[test]
fn a_value_of_an_axis_is_not_blamed_on_the_base_scene() {
    let folder = folder("scene = \"base.toml\"\n[axes]\neta = [0.9, 1.5]\n");
    succeeds(folder.path(), &["sweep", "sweep.toml", "--out", "t.csv"]);
    let table = read_to_string(folder.path().join("t.csv")).expect("written");
    assert!(table.contains("axis `restitution.eta`: 1.5 is out of range") && !table.contains("base.toml"), "{table}");
    fails(folder.path(), &["sweep", "sweep.toml", "--out", "t.xlsx"], 2, &["t.xlsx", "CSV or Parquet"]);
}

/// The file has the word, not the option.
#[test]
fn words_of_a_record_are_quoted_as_they_are() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path().join("a.txt"), "units g dt 0.01\n0.1 0.2 0.3 0.4 0.5\n0.1 0.2 0.3 0.4 0.5\n").expect("written");
    fails(folder.path(), &["record", "a.txt"], 2, &["`units` is no number", "`--skip-rows`"]);
    write(folder.path().join("b.txt"), "0.1\n0.2\n0.3\n").expect("written");
    fails(folder.path(), &["record", "b.txt"], 2, &["`--units`"]);
}
