//! The program among other programs: permissions, streams, locks and names of files.

use crate::common::scenes::SCENE;
use crate::common::sweeps::{BASE, SWEEP};
use crate::common::{Folder, failed};
use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;

/// `rocking` with a mask of permissions.
fn masked(folder: &Folder, mask: &str, arguments: &str) {
    let script = format!("umask {mask}; exec \"$0\" {arguments}");
    let mut command = Command::new("sh");
    command.args(["-c", &script, env!("CARGO_BIN_EXE_rocking")]).current_dir(folder.path(""));
    let output = command.output().expect("a shell");
    assert!(output.status.success(), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
}

fn mode(folder: &Folder, name: &str) -> u32 {
    fs::metadata(folder.path(name)).expect("a file").permissions().mode() & 0o777
}

#[test]
fn files_have_the_permissions_of_new_files_and_keep_their_own() {
    let folder = Folder::with("scene.toml", SCENE);
    masked(&folder, "077", "run scene.toml --plots --report --quiet");
    let names = folder.names("out");
    assert!(names.len() > 6 && names.contains(&"report.html".to_string()));
    for name in names {
        assert_eq!(mode(&folder, &format!("out/{name}")), 0o600, "{name}");
    }
    masked(&folder, "002", "report out --out page.html");
    assert_eq!(mode(&folder, "page.html"), 0o664);

    folder.write("base.toml", BASE);
    folder.write("sweep.toml", SWEEP);
    let files = ["table.csv", "table.svg"];
    folder.succeeds("sweep sweep.toml --out table.csv --plot table.svg");
    for name in files {
        fs::set_permissions(folder.path(name), Permissions::from_mode(0o640)).expect("set");
    }
    folder.succeeds("sweep sweep.toml --out table.csv --plot table.svg");
    assert_eq!(files.map(|name| mode(&folder, name)), [0o640, 0o640]);
    masked(&folder, "022", "run scene.toml --quiet");
    assert_eq!(mode(&folder, "out/summary.json"), 0o600);
}

#[test]
fn write_protected_files_are_not_replaced() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.write("base.toml", BASE);
    folder.write("sweep.toml", SWEEP);
    folder.succeeds("run scene.toml --report");
    folder.succeeds("sweep sweep.toml --out table.csv");
    let protect = |name: &str, mode: u32| {
        fs::set_permissions(folder.path(name), Permissions::from_mode(mode)).expect("set");
    };
    protect("table.csv", 0o444);
    folder.refused("sweep sweep.toml --out table.csv", &["table.csv", "write-protected"]);
    // A report of an earlier run would be removed.
    for name in ["out/response.csv", "out/report.html"] {
        protect(name, 0o444);
        folder.refused("run scene.toml", &[name, "write-protected"]);
        protect(name, 0o644);
    }
    folder.succeeds("run scene.toml");
}

#[test]
fn two_runs_do_not_write_into_one_folder_at_once() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.succeeds("run scene.toml");
    let before = folder.bytes("out/summary.json");
    let other = File::open(folder.path("out")).expect("a folder");
    other.lock().expect("locked");
    folder.refused("run scene.toml", &["out: another run is being written into it"]);
    assert_eq!(folder.bytes("out/summary.json"), before);
    drop(other);
    folder.succeeds("run scene.toml");
}

#[test]
fn hidden_files_of_users_stay_in_the_folder_of_a_run() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.write("out/.rocking-notes.txt", "mine");
    folder.succeeds("run scene.toml");
    assert_eq!(folder.read("out/.rocking-notes.txt"), "mine");
}

/// The links of `/dev/stdout` lead to the file into which the output goes, whose content would be lost.
#[cfg(target_os = "linux")]
#[test]
fn a_table_does_not_take_the_place_of_the_output() {
    let folder = Folder::with("base.toml", BASE);
    folder.write("sweep.toml", SWEEP);
    folder.write("log", "old\n");
    folder.link("/dev/stdout", "link.csv");
    for out in ["/dev/stdout", "/dev/fd/1", "link.csv"] {
        let log = File::options().append(true).open(folder.path("log")).expect("a file");
        let output = folder.command(&format!("sweep sweep.toml --out {out}")).stdout(log).output().expect("it starts");
        failed(&output, 2, out, &[out, "it is no file"]);
    }
    assert_eq!(folder.read("log"), "old\n");
}

/// The paths in a summary are those of the folder in which the run was made.
#[test]
fn a_report_does_not_take_the_place_of_a_scene_or_a_record() {
    let folder = Folder::with("base.toml", SCENE);
    folder.succeeds("run base.toml");
    for name in ["base.toml", "../base.toml", "new.csv"] {
        let arguments = format!("report {} --out {name}", if name.starts_with("..") { "." } else { "out" });
        let mut command = folder.command(&arguments);
        if name.starts_with("..") {
            command.current_dir(folder.path("out"));
        }
        failed(&command.output().expect("it starts"), 2, name, &[name, "ends in .html"]);
    }
    assert_eq!(folder.read("base.toml"), SCENE);
    folder.succeeds("report out --out page.HTM");
}

#[cfg(target_os = "linux")] // elsewhere such names may not exist
#[test]
fn names_that_are_no_text_lose_no_run_and_no_table() {
    let folder = Folder::with("base.toml", BASE);
    let name = |bytes: &[u8]| folder.path("").join(OsStr::from_bytes(bytes));
    fs::write(name(b"scene\xff.toml"), SCENE).expect("written");
    let run = |arguments: &[&OsStr]| {
        Command::new(env!("CARGO_BIN_EXE_rocking"))
            .args(arguments)
            .current_dir(folder.path(""))
            .output()
            .expect("it starts")
    };
    let output = run(&["run".as_ref(), OsStr::from_bytes(b"scene\xff.toml")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(folder.summary()["scene"]["file"], "scene\u{fffd}.toml");
    folder.succeeds("report out");

    for sweep in [b"s\xfe.toml", b"s\xff.toml"] {
        fs::write(name(sweep), SWEEP).expect("written");
        let output = run(&["sweep".as_ref(), OsStr::from_bytes(sweep), "--shard".as_ref(), "1/2".as_ref()]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    assert!(name(b"s\xfe-1-of-2.csv").is_file() && name(b"s\xff-1-of-2.csv").is_file());
    assert!(name(b"s\xff-1-of-2.csv.digest").is_file());

    folder.make_folder("records");
    let samples = "time,acceleration (m/s2)\n0.0,0.0\n0.1,1.0\n0.2,-1.0\n0.3,0.0\n";
    fs::write(name(b"records/r\xff.csv"), samples).expect("written");
    let listed = folder.answers("record records --json");
    assert!(listed.to_string().contains("r\u{fffd}.csv"), "{listed}");
    let output =
        run(&["init".as_ref(), "--record".as_ref(), OsStr::from_bytes(b"records/r\xff.csv"), "new.toml".as_ref()]);
    failed(&output, 2, "init", &["not UTF-8"]);
    assert!(!folder.has("new.toml"));
    folder
        .write("of.toml", "scene = \"base.toml\"\n[axes]\n\"excitation.horizontal.file\" = { folder = \"records\" }\n");
    folder.refused("sweep of.toml", &["records", "r\u{fffd}.csv is not UTF-8"]);
}

/// A measured record may be called a table, too: whatever no command has written stays. Results of an earlier command are replaced.
#[test]
fn files_that_no_command_has_written_are_not_replaced() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.write("base.toml", BASE);
    folder.write("sweep.toml", SWEEP);
    folder.copy("scenes/records/synthetic.AT2", "record.csv");
    folder.copy("scenes/records/synthetic.AT2", "record.AT2");
    let measured = folder.bytes("record.csv");
    let there = &["record.csv", "no command here has written it"];
    folder.succeeds("sweep sweep.toml --out table.csv");
    folder.refused("sweep sweep.toml --out record.csv", there);
    folder.refused("merge record.csv table.csv", there);
    folder.refused("record record.AT2 --out record.csv", there);
    assert_eq!(folder.bytes("record.csv"), measured);
    folder.succeeds("run scene.toml");
    let rows = folder.bytes("out/response.csv");
    folder.refused("sweep sweep.toml --out out/response.csv", &["out/response.csv"]);
    assert_eq!(folder.bytes("out/response.csv"), rows);

    folder.succeeds("record record.AT2 --out copy.csv");
    folder.succeeds("record record.AT2 --out copy.csv --scale 2");
    folder.write("empty.csv", "");
    folder.succeeds("merge empty.csv table.csv");
    folder.succeeds("sweep sweep.toml --out table.csv");
}

/// A file of a run stands for no table and no folder.
#[test]
fn the_folder_of_a_run_is_drawn_and_not_its_files() {
    let folder = Folder::with("scene.toml", SCENE);
    folder.succeeds("run scene.toml");
    for name in ["response.csv", "events.json", "summary.json"] {
        folder.refused(&format!("plot out/{name}"), &[name, "belongs to a run; give its folder, out"]);
    }
}
