//! Tables of sweeps as files: the same bytes whatever the threads, shards and interruptions, and nothing lost.

mod common;

use common::sweeps::{BASE, SWEEP, folder, kill_and_go_on, long, start, table};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

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
    std::fs::write(folder.path().join("other.toml"), SWEEP).expect("written");
    common::succeeds(folder.path(), &["sweep", "other.toml", "--shard", "1/2", "--quiet"]);
    assert!(folder.path().join("other-1-of-2.csv").exists(), "shards of another sweep have other names");
}

/// Of what is left of a sweep rows are kept up to the first that is not the one due.
#[test]
fn a_damaged_part_is_gone_on_with_from_the_damage() {
    let folder = folder(&long().replace("steps = 40", "steps = 400"));
    let mut child = start(folder.path(), "t.csv");
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
        let mut child = start(folder.path(), "t.csv");
        parts.push(part(folder.path(), &parts));
        child.kill().expect("SIGKILL");
        child.wait().expect("it ends");
        let record = std::fs::read_to_string(folder.path().join("a.AT2")).expect("text");
        std::fs::write(folder.path().join("a.AT2"), record.replacen("e-6", "e-5", 1)).expect("written");
    }
    assert!(parts.iter().all(|part| part.exists()), "{parts:?}");
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
    let mut child = start(folder.path(), "t.csv");
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
        (&cut_within, &[][..], &["2.csv", "line 31", "9 cell(s)"][..]),
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
