//! Tables of sweeps as files: the same bytes whatever the threads, shards and interruptions, and nothing lost.

use crate::common::sweeps::{BASE, PULSE, SWEEP, folder, kill_and_go_on, long, start, table};
use crate::common::{Folder, failed};
use std::time::{Duration, Instant};

#[test]
fn threads_and_shards_change_nothing() {
    let folder = folder(SWEEP);
    let whole = table(&folder, "");
    assert_eq!(table(&folder, "--threads 1"), whole);
    let shards = [3, 1, 4, 2].map(|number| {
        let name = format!("part-{number}.csv");
        folder.succeeds(&format!("sweep sweep.toml --out {name} --shard {number}/4 --quiet"));
        name
    });
    folder.succeeds(&format!("merge merged.csv {}", shards.join(" ")));
    assert_eq!(folder.read("merged.csv"), whole);
    // Of more shards than points some are empty.
    let many: Vec<String> = (1..=61).map(|number| format!("{number}.csv")).collect();
    for (place, name) in many.iter().enumerate() {
        let shard = format!("{}/61", place + 1);
        folder.succeeds(&format!("sweep sweep.toml --out {name} --shard {shard} --quiet"));
    }
    folder.succeeds(&format!("merge merged.csv {}", many.join(" ")));
    assert_eq!(folder.read("merged.csv"), whole);
}

#[test]
fn shards_that_are_missing_or_of_another_sweep_are_noticed() {
    let folder = folder(SWEEP);
    for number in 1..=4 {
        folder.succeeds(&format!("sweep sweep.toml --out {number}.csv --shard {number}/4 --quiet"));
    }
    let other = "scene = \"base.toml\"\n[axes]\neta = { from = 0.1, to = 0.9, steps = 60 }\n";
    folder.write("other.toml", other);
    folder.succeeds("sweep other.toml --out other.csv --shard 2/2 --quiet");
    for (arguments, named) in [
        ("1.csv 3.csv", &["3.csv", "point 30 where 15 is due", "points 15 to 29 are missing"][..]),
        ("2.csv 3.csv 4.csv", &["2.csv", "point 15 where 0 is due"]),
        ("1.csv 2.csv 2.csv", &["2.csv", "point 15 where 30 is due"]),
        ("1.csv 2.csv other.csv", &["other.csv", "columns", "the others"]),
        // Only who gives the sweep learns of these.
        ("1.csv 2.csv 3.csv --sweep sweep.toml", &["sweep.toml", "60 point(s)", "after 45"]),
        ("1.csv --sweep other.toml", &["1.csv", "columns", "other.toml"]),
    ] {
        folder.refused(&format!("merge merged.csv {arguments}"), named);
        assert!(!folder.has("merged.csv"), "{arguments:?}");
    }
    let all = "merge merged.csv 1.csv 2.csv 3.csv 4.csv --sweep sweep.toml";
    assert!(folder.succeeds(all).contains("all points of sweep.toml"));
    assert!(folder.succeeds("merge merged.csv 1.csv 2.csv 3.csv").contains("--sweep FILE would tell"));
}

/// Nothing is run or written for a table that could not be written in the end.
#[cfg(not(feature = "parquet"))]
#[test]
fn a_build_without_parquet_names_the_remedy() {
    let folder = folder(SWEEP);
    for arguments in
        ["sweep sweep.toml --out t.parquet", "merge t.parquet 1.csv", "merge t.csv 1.parquet", "plot 1.parquet"]
    {
        folder.write("1.parquet", "PAR1");
        let message = folder.refused(arguments, &["cargo build", "--features parquet"]);
        assert!(message.contains("1.parquet") || message.contains("t.parquet"), "{message}");
    }
    assert_eq!(folder.names("").len(), 3, "base, sweep and 1.parquet");
}

/// Killed without warning at any moment and started again, however often, a sweep gives the bytes of one that was left alone.
#[test]
fn a_sweep_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = folder(&long());
    let whole = table(&folder, "");
    folder.remove("t.csv");
    kill_and_go_on(
        || start(&folder, "t.csv"),
        || {
            // It may be killed between the renaming and its end.
            assert!(!folder.has("t.csv") || folder.read("t.csv") == whole, "the table has its name before it is whole");
            // A line that was cut within, as a full disk or a power cut leaves it.
            let part = folder.names("").into_iter().find(|name| name.ends_with(".part"));
            if let Some(part) = part {
                let bytes = folder.bytes(&part);
                folder.write(&part, &bytes[..bytes.len().saturating_sub(7)]);
            }
        },
    );
    assert_eq!(folder.read("t.csv"), whole);
    assert_eq!(folder.names(""), ["base.toml", "sweep.toml", "t.csv"]);
}

/// What was begun with other inputs is not gone on with.
#[test]
fn a_part_of_another_sweep_is_left_alone() {
    let folder = folder(SWEEP);
    let first = table(&folder, "");
    folder.write("base.toml", BASE.replace("eta = 0.9", "eta = 0.8"));
    let second = table(&folder, "");
    assert_ne!(first, second);
    folder.write("base.toml", BASE);
    assert_eq!(table(&folder, ""), first);
}

/// Shards without a name of their own do not write over each other.
#[test]
fn shards_have_names() {
    let folder = folder(SWEEP);
    let whole = table(&folder, "");
    for shard in ["1/2", "2/2"] {
        folder.succeeds(&format!("sweep sweep.toml --shard {shard} --quiet"));
    }
    folder.succeeds("merge m.csv sweep-1-of-2.csv sweep-2-of-2.csv --sweep sweep.toml");
    assert_eq!(folder.read("m.csv"), whole);
    folder.write("other.toml", SWEEP);
    folder.succeeds("sweep other.toml --shard 1/2 --quiet");
    assert!(folder.has("other-1-of-2.csv"), "shards of another sweep have other names");
}

/// Of what is left of a sweep rows are kept up to the first that is not the one due.
#[test]
fn a_damaged_part_is_gone_on_with_from_the_damage() {
    let folder = folder(&long().replace("steps = 40", "steps = 400"));
    let mut child = start(&folder, "t.csv");
    let part = part(&folder, &[]);
    while std::fs::metadata(folder.path(&part)).is_ok_and(|metadata| metadata.len() < 40_000) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().expect("SIGKILL");
    child.wait().expect("it ends");
    let rows = folder.read(&part);
    let whole = table(&folder, "");
    let lines: Vec<&str> = rows.lines().collect();
    let without = [&lines[..100], &lines[101..]].concat().join("\n") + "\n";
    let zeros = [&rows.as_bytes()[..5000], &[0; 4096], &rows.as_bytes()[9096..]].concat();
    let before_zeros = rows[..5000].lines().count() - 2;
    for (damaged, kept) in [
        (without.into_bytes(), "(99 of them".into()),
        (zeros, format!("({before_zeros} of them")),
        (b"another header\n0,\n".to_vec(), "row(s) to".into()),
        // A row of another point, one too many, and none that is text.
        (rows.replacen(lines[50], &lines[51].replacen("50,", "49,", 1), 1).into_bytes(), "(49 of them".into()),
        ((whole.clone() + lines[1]).into_bytes(), format!("({} of them", whole.lines().count() - 1)),
        ([&rows.as_bytes()[..5000], b"\xff\xfe\n"].concat(), format!("({before_zeros} of them")),
    ] {
        folder.write(&part, damaged);
        let told = folder.succeeds("sweep sweep.toml --out t.csv");
        assert!(told.contains(&kept), "{kept} in {told}");
        assert!(folder.read("t.csv") == whole);
    }
}

/// A link leads to its file; what is no file is left alone.
#[cfg(unix)]
#[test]
fn links_are_followed_and_devices_left_alone() {
    let folder = folder(SWEEP);
    let whole = table(&folder, "");
    folder.write("real.csv", "index,outcome\n");
    folder.link("real.csv", "link.csv");
    folder.succeeds("sweep sweep.toml --out link.csv --quiet");
    assert!(folder.path("link.csv").is_symlink());
    assert_eq!(folder.read("real.csv"), whole);
    folder.link("nowhere.csv", "dangling.csv");
    let _socket = std::os::unix::net::UnixListener::bind(folder.path("socket")).expect("made");
    for (arguments, named) in [
        ("sweep sweep.toml --out socket", "no file"),
        ("merge socket t.csv", "no file"),
        ("sweep sweep.toml --out folder/", "a folder"),
        ("sweep sweep.toml --out folder/.", "a folder"),
        ("sweep sweep.toml --out dangling.csv", "a link"),
        ("sweep sweep.toml --out nowhere/t.csv", "no such folder"),
        ("sweep sweep.toml --out t.csv --plot nowhere/t.svg", "no such folder"),
    ] {
        folder.refused(arguments, &[named]);
    }
    assert_eq!(folder.names("").len(), 7, "two inputs, table, file, two links and socket");
}

/// What a sweep reads, or writes as something else, it does not write over.
#[test]
fn a_table_over_an_input_is_refused() {
    let folder = folder(SWEEP);
    folder.copy("scenes/records/synthetic.AT2", "a.AT2");
    folder.write("base.toml", BASE.replace(PULSE, "kind = \"record\"\nfile = \"a.AT2\"\npga_g = 0.2"));
    let sweep = "scene = \"base.toml\"\n[axes]\neta = [0.5, 0.9]\npga_g = [0.2, 0.3]\n";
    folder.write("sweep.toml", sweep);
    let contents = || {
        let names = folder.names("");
        names.into_iter().map(|name| (name.clone(), folder.bytes(&name))).collect::<Vec<_>>()
    };
    folder.succeeds("sweep sweep.toml --out 1.csv --shard 1/2 --quiet");
    folder.succeeds("sweep sweep.toml --out 2.csv --shard 2/2 --quiet");
    let before = contents();
    for arguments in [
        "sweep sweep.toml --out base.toml",
        "sweep sweep.toml --out ./sweep.toml",
        "sweep sweep.toml --out a.AT2",
        "sweep sweep.toml --out t.svg --plot t.svg",
        "sweep sweep.toml --out t-minimum.svg --plot t.svg",
        "merge 2.csv 1.csv 2.csv",
        "merge sweep.toml 1.csv 2.csv --sweep sweep.toml",
        "merge base.toml 1.csv 2.csv --sweep sweep.toml",
        "merge a.AT2 1.csv 2.csv --sweep sweep.toml",
    ] {
        folder.refused(arguments, &["choose another name"]);
    }
    assert!(contents() == before, "something was written");
    folder.succeeds("merge t.csv 2.csv 1.csv --sweep sweep.toml");
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
    folder.write("base.toml", BASE.replace(PULSE, "kind = \"record\"\nfile = \"a.AT2\""));
    folder.copy("scenes/records/synthetic.AT2", "a.AT2");
    let mut parts = Vec::new();
    for _ in 0..2 {
        let mut child = start(&folder, "t.csv");
        parts.push(part(&folder, &parts));
        child.kill().expect("SIGKILL");
        child.wait().expect("it ends");
        let record = folder.read("a.AT2");
        folder.write("a.AT2", record.replacen("e-6", "e-5", 1));
    }
    assert!(parts.iter().all(|part| folder.has(part)), "{parts:?}");
}

/// The part of a sweep that has just been started, once it has a header.
fn part(folder: &Folder, known: &[String]) -> String {
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(60) {
        let has_header = |name: &String| std::fs::metadata(folder.path(name)).is_ok_and(|metadata| metadata.len() > 0);
        let mut parts = folder.names("").into_iter().filter(|name| name.ends_with(".part") && !known.contains(name));
        if let Some(found) = parts.find(has_header) {
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
    let mut child = start(&folder, "t.csv");
    part(&folder, &[]);
    let output = folder.rocking("sweep sweep.toml --out t.csv");
    let still_runs = child.try_wait().expect("it can be asked").is_none();
    child.kill().expect("SIGKILL");
    child.wait().expect("it ends");
    assert!(still_runs, "the sweep is too short for this test");
    failed(&output, 2, "a second sweep", &["t.csv: another process", "wait"]);
}

#[test]
fn rows_that_are_cut_or_of_another_sweep_are_not_merged() {
    let folder = folder(SWEEP);
    for number in 1..=2 {
        folder.succeeds(&format!("sweep sweep.toml --out {number}.csv --shard {number}/2 --quiet"));
    }
    let second = folder.read("2.csv");
    let last = second.trim_end().rsplit('\n').next().expect("a line");
    let overturned = second.lines().find(|line| line.contains("overturns")).expect("one overturns");
    let cut_within = second.replace(last, last.rsplit_once(',').expect("cells").0);
    let without_outcome = second.replace(overturned, &overturned.replace("overturns", "overt"));
    let cut_at_end = second.trim_end().to_string();
    let no_number = second.replace(overturned, &overturned.replace("overturns,", "overturns,x"));
    let overturns = format!("ask = \"overturns\"\n{SWEEP}");
    folder.write("overturns.toml", overturns);
    std::fs::rename(folder.path("sweep.toml"), folder.path("old.toml")).expect("renamed");
    folder.write("sweep.toml", SWEEP.replace("to = 8", "to = 9"));
    for (text, arguments, named) in [
        (&cut_within, "", &["2.csv", "line 31", "9 cell(s)"][..]),
        (&cut_at_end, "", &["2.csv", "last line is cut"]),
        (&no_number, "--sweep old.toml", &["2.csv", "is not one of old.toml"]),
        (&second, "--sweep overturns.toml", &["1.csv", "is not one of overturns.toml"]),
        (&without_outcome, "", &["2.csv", "not whole", overturned.split(',').next().expect("an index")]),
        (&second, "--sweep sweep.toml", &["1.csv", "point 6", "is not one of sweep.toml"]),
    ] {
        folder.write("2.csv", text);
        folder.refused(&format!("merge t.csv 1.csv 2.csv {arguments}"), named);
        assert!(!folder.has("t.csv"));
    }
}

#[test]
fn threads_are_some_and_not_too_many() {
    let folder = folder(SWEEP);
    for threads in ["0", "5000", "two"] {
        for command in ["sweep sweep.toml", "run scene.toml", "fragility t.csv"] {
            folder.refused(&format!("{command} --threads {threads}"), &["--threads"]);
        }
    }
}

#[test]
fn shards_of_another_base_scene_are_not_merged() {
    let folder = folder(SWEEP);
    let shard = |number: &str, name: &str| {
        folder.succeeds(&format!("sweep sweep.toml --shard {number} --out {name} --quiet"));
    };
    shard("1/2", "1.csv");
    folder.write("base.toml", BASE.replace("eta = 0.9", "eta = 0.8"));
    shard("2/2", "2.csv");
    let problem = ["2.csv", "base scene", "1.csv", "all shards of one sweep"];
    folder.refused("merge m.csv 1.csv 2.csv", &problem);
    folder.refused("merge m.csv 1.csv 2.csv --sweep sweep.toml", &["1.csv", "sweep.toml"]);
    assert!(!folder.has("m.csv"));
    shard("1/2", "1.csv");
    folder.succeeds("merge m.csv 1.csv 2.csv --sweep sweep.toml");
}

/// The table of a shard and the digest of its sweep change together: a job that is killed leaves both of the job before.
#[test]
fn a_shard_whose_last_run_was_killed_is_not_merged_with_newer_ones() {
    let folder = folder(&long());
    let shard = |number: &str| format!("sweep sweep.toml --shard {number} --quiet");
    let run = |number: &str| folder.succeeds(&shard(number));
    run("1/2");
    run("2/2");
    folder.write("base.toml", BASE.replace("eta = 0.9", "eta = 0.8"));
    run("1/2");
    let mut killed = folder.start(&(shard("2/2") + " --threads 1"));
    let is_under_way = || folder.names("").iter().any(|name| name.ends_with(".part"));
    while !is_under_way() {
        std::thread::sleep(Duration::from_millis(1));
    }
    killed.kill().expect("SIGKILL");
    assert!(!killed.wait().expect("it ends").success(), "it was killed too late");
    let merge = "merge m.csv sweep-1-of-2.csv sweep-2-of-2.csv --sweep sweep.toml";
    folder.refused(merge, &["sweep-2-of-2.csv", "base scene"]);
    run("2/2");
    folder.succeeds(merge);
    // A sweep that is no shard leaves no digest beside its table.
    folder.succeeds("sweep sweep.toml --out sweep-2-of-2.csv --quiet");
    assert!(!folder.has("sweep-2-of-2.csv.digest"));
}

/// A digest of a sweep does not hang on which records have been read so far: shards that print warnings read all of them first.
#[test]
fn shards_of_records_are_merged_with_their_sweep() {
    let folder = folder("scene = \"base.toml\"\n[axes]\nfile = [\"a.csv\", \"b.csv\"]\n");
    folder.write("base.toml", "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[excitation.horizontal]\nkind = \"record\"\nfile = \"a.csv\"\n");
    for name in ["a.csv", "b.csv"] {
        folder.write(name, "t (s),a (m/s2)\n0,0\n0.01,3.5\n0.02,0\n0.03,-1\n");
    }
    for (first, second) in [("", ""), ("", "--quiet"), ("--quiet", "")] {
        for (shard, quiet) in [("1/2", first), ("2/2", second)] {
            folder.succeeds(&format!("sweep sweep.toml --shard {shard} {quiet}"));
        }
        let told = folder.succeeds("merge m.csv sweep-1-of-2.csv sweep-2-of-2.csv --sweep sweep.toml");
        assert!(told.contains("2 row(s)"), "{told}");
    }
}

/// Names of files may end in a blank; cells of edited tables may have blanks beside their commas.
#[test]
fn names_with_blanks_at_their_ends_are_names_of_their_own() {
    let folder = folder("scene = \"base.toml\"\n[axes]\ntitle = [\"drum\", \"drum \"]\neta = [0.8, 0.9]\n");
    folder.succeeds("sweep sweep.toml --out whole.csv --quiet");
    for number in 1..=2 {
        folder.succeeds(&format!("sweep sweep.toml --out {number}.csv --shard {number}/2 --quiet"));
    }
    for sweep in ["", " --sweep sweep.toml"] {
        folder.succeeds(&format!("merge merged.csv 1.csv 2.csv{sweep}"));
        assert_eq!(folder.read("merged.csv"), folder.read("whole.csv"), "{sweep}");
    }
    folder.succeeds("plot whole.csv --out strips.svg");
    let edited = folder.read("whole.csv").replace(",0.8,", ", 0.8 ,").replace(",false", ", false");
    folder.write("edited.csv", edited.clone());
    folder.succeeds("merge merged.csv edited.csv --sweep sweep.toml");
    folder.write("1.csv", "");
    folder.refused("merge merged.csv 1.csv 2.csv", &["1.csv", "empty", "again"]);
}

/// A shard has its digest beside it: a record of that name would be lost.
#[test]
fn a_digest_over_an_input_is_refused() {
    let folder = folder("scene = \"shaken.toml\"\n[axes]\nfile = [\"records/x.csv.digest\"]\n");
    folder.write(
        "shaken.toml",
        "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 1\n[excitation.horizontal]\nkind = \"record\"\nfile = \"records/a.AT2\"\n",
    );
    folder.copy("scenes/records/synthetic.AT2", "records/a.AT2");
    folder.copy("scenes/records/synthetic.AT2", "records/x.csv.digest");
    let before = folder.read("records/x.csv.digest");
    folder.refused("sweep sweep.toml --shard 1/1 --out records/x.csv", &["x.csv.digest"]);
    assert_eq!(folder.read("records/x.csv.digest"), before);
}

/// Digests of shards are compared with each other, also where the first shard has none.
#[test]
fn shards_of_different_sweeps_are_not_merged_beside_one_without_digest() {
    let folder = folder(SWEEP);
    for number in 1..=2 {
        folder.succeeds(&format!("sweep sweep.toml --out {number}.csv --shard {number}/3 --quiet"));
    }
    folder.write("base.toml", BASE.replace("eta = 0.9", "eta = 0.8"));
    folder.succeeds("sweep sweep.toml --out 3.csv --shard 3/3 --quiet");
    folder.remove("1.csv.digest");
    folder.refused("merge merged.csv 1.csv 2.csv 3.csv", &["3.csv", "2.csv"]);
    assert!(!folder.has("merged.csv"));
}

/// A digest that cannot be read is none that may be left out of account, and none that `merge` may write over.
#[test]
fn a_damaged_digest_is_refused() {
    let folder = folder(SWEEP);
    for number in 1..=2 {
        folder.succeeds(&format!("sweep sweep.toml --out {number}.csv --shard {number}/2 --quiet"));
    }
    let digest = folder.read("1.csv.digest");
    for damaged in [&b"\xff"[..], b"", b"no digest"] {
        folder.write("1.csv.digest", damaged);
        for sweep in ["", " --sweep sweep.toml"] {
            folder.refused(&format!("merge m.csv 1.csv 2.csv{sweep}"), &["1.csv.digest: it is no digest of a sweep"]);
        }
    }
    folder.write("1.csv.digest", &digest);
    folder.refused("merge 1.csv.digest 1.csv 2.csv", &["choose another name"]);
    assert_eq!(folder.read("1.csv.digest"), digest);
    folder.succeeds("merge m.csv 1.csv 2.csv --sweep sweep.toml");
}

/// A table takes the place of no file that ends as scenes and PEER's records do, whether or not the sweep reads it.
#[test]
fn a_table_takes_no_name_of_a_scene_or_a_record_of_peer() {
    let folder = folder(SWEEP);
    for name in ["other.toml", "other.AT2"] {
        folder.write(name, "precious");
        folder.refused(&format!("sweep sweep.toml --out {name}"), &["choose another name"]);
        assert_eq!(folder.read(name), "precious");
    }
}
