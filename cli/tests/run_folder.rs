//! The folder of a run: its files are of one run, replaced as a whole or not at all, and refused when they are damaged.

use crate::common::Folder;
#[cfg(unix)]
use crate::common::failed;
use crate::common::scenes::SCENE;
use std::path::Path;

#[test]
fn figures_and_reports_of_an_earlier_run_do_not_stay() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.succeeds("run scene.toml --plots --report");
    folder.succeeds("plot out --format png");
    folder.write("out/notes.txt", "mine");
    assert_eq!(folder.names("out").len(), 13);
    // A refused scene and a run that is asked for nothing else.
    folder.refused("run none.toml", &["none.toml"]);
    assert_eq!(folder.names("out").len(), 13);
    folder.succeeds("run scene.toml");
    assert_eq!(folder.names("out"), ["events.json", "notes.txt", "response.csv", "summary.json"]);
    folder.succeeds("run scene.toml --report");
    assert_eq!(folder.names("out").len(), 5);
}

/// Before a run replaces anything, its figures and its page must have a place.
#[test]
fn a_run_whose_figure_has_no_place_leaves_the_folder_as_it_is() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.succeeds("run scene.toml --out out --plots");
    folder.write("scene.toml", SCENE.replace("amplitude = 4.0", "amplitude = 3.0"));
    folder.make_folder("out/report.html");
    #[cfg(unix)]
    {
        folder.remove("out/energy.svg");
        folder.link("nowhere", "out/energy.svg");
    }
    let before = folder.bytes("out/summary.json");
    folder.refused("run scene.toml --out out --report", &["report.html", "a folder has this name"]);
    if cfg!(unix) {
        folder.refused("run scene.toml --out out --plots", &["energy.svg", "a link"]);
    }
    assert_eq!(folder.bytes("out/summary.json"), before);
    assert!(folder.path("out/time-history.svg").is_file());
}

#[test]
fn results_are_not_written_over_what_they_are_made_of() {
    let record = "excitation.horizontal = { kind = \"record\", file = \"response.csv\" }\n";
    let folder =
        Folder::with("scene.toml", &format!("{record}[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n"));
    let samples = "time,acceleration (m/s2)\n0.0,0.0\n0.1,1.0\n0.2,-1.0\n0.3,0.0\n";
    folder.write("response.csv", samples);
    folder.refused("run scene.toml --out .", &["response.csv"]);
    assert_eq!(folder.read("response.csv"), samples);
    folder.succeeds("run scene.toml --out out --quiet");
    for name in ["summary.json", "response.csv", "events.json"] {
        let own = format!("out/{name}");
        let before = folder.bytes(&own);
        folder.refused(&format!("report out --out {own}"), &[name]);
        assert!(folder.bytes(&own) == before, "{name}");
    }
}

/// Events of many impacts can take more than is read: to run the scene again would give the same file.
#[test]
fn a_file_too_large_to_be_read_is_refused_with_what_makes_it_smaller() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.succeeds("run scene.toml");
    let events = std::fs::File::options().write(true).open(folder.path("out/events.json")).expect("written");
    events.set_len((1 << 30) + 1).expect("a file with a hole takes no space");
    folder.refused("report out", &["events.json", "1073741825 bytes", "output.dt", "solver.t_end"]);
}

/// Files that read well and are not those of the run: cut at the end of a line, or from another run of the same length.
#[test]
fn files_of_another_run_are_refused() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.succeeds("run scene.toml");
    for (file, from, to) in [
        ("response.csv", "\n2.0,", "\n"),
        ("response.csv", "\n0.01,0.0", "\n0.01,0.00"),
        ("events.json", "\"kind\":\"impact\"", "\"kind\":\"opening\""),
    ] {
        let name = format!("out/{file}");
        let whole = folder.read(&name);
        let other = match file {
            "response.csv" if to == "\n" => whole[..whole.find(from).expect("a last row") + 1].to_string(),
            _ => whole.replacen(from, to, 1),
        };
        assert_ne!(whole, other, "`{from}` is in {file}");
        folder.write(&name, other);
        for command in ["plot", "report"] {
            folder
                .refused(&format!("{command} out"), &[file, "cut, changed, or of another run", "run the scene again"]);
        }
        folder.write(&name, whole);
    }
    folder.succeeds("report out");
}

/// Damages that made figures panic, or take all memory.
#[cfg(unix)]
#[test]
fn damaged_run_folders_are_refused_with_file_and_remedy() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.succeeds("run scene.toml");
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
        let name = format!("out/{file}");
        let whole = folder.read(&name);
        assert!(whole.contains(from), "`{from}` is not in {file}");
        folder.write(&name, whole.replacen(from, to, 1));
        for command in ["plot", "report"] {
            let output = folder.limited(&format!("{command} out")).output().expect("a shell");
            failed(&output, 2, &format!("{command} with {from} as {to}"), &[file, "run the scene again"]);
        }
        folder.write(&name, whole);
    }
    folder.succeeds("plot out");
}

#[test]
fn an_earlier_result_survives_a_refused_scene() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.succeeds("run scene.toml --out out");
    let before = folder.bytes("out/response.csv");
    folder.write("scene.toml", SCENE.replace("omega = 10.0", "omega = -1"));
    folder.refused("run scene.toml --out out", &["omega"]);
    assert_eq!(folder.bytes("out/response.csv"), before);
    assert_eq!(folder.names("out").len(), 3, "no temporary file is left");
}

#[test]
fn results_that_cannot_be_put_in_place() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.make_folder("out/response.csv");
    folder.refused("run scene.toml --out out", &["response.csv"]);
    assert_eq!(folder.names("out").len(), 1, "nothing is put beside it");
}

/// Nobody, root included, can make a folder below a file.
/// Of a file where a folder is wanted, of `-` and of folders that are closed, the message is about the name that was given.
#[test]
fn outputs_that_cannot_be_are_named_as_they_were_given() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.write("taken.csv", "a,b\n");
    folder.refused("run scene.toml --out taken.csv", &["taken.csv: a file has this name", "another folder"]);
    for command in ["sweep s.toml --out -", "merge - taken.csv", "init -", "run scene.toml --out -"] {
        folder.write("s.toml", "scene = \"scene.toml\"\n[axes]\neta = [0.9]\n");
        folder.refused(command, &["-: ", "not to standard output"]);
    }
    assert!(!folder.has("-") && folder.read("taken.csv") == "a,b\n");
}

#[test]
fn an_output_folder_that_cannot_be_written() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.write("file", "");
    let out = Path::new("file").join("out");
    folder.refused(&["run", "scene.toml", "--out", &out.to_string_lossy()], &["file", "--out"]);
}
