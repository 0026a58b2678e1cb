//! `rocking fragility`: curves of the runs in a table, and tables that do not have what a curve needs.

use crate::common::{Folder, assert_has, parsed, unbroken};
use crate::ida::{BLOCK, folder, run};
use std::fmt::Write;

/// Columns of blocks are told by their numbers, not by their order: without `peak_2`, `peak_3` was read in its place.
#[test]
fn a_table_that_lacks_the_column_of_a_block_is_refused() {
    let table = "record,PGV,outcome,peak_1,peak_3\na,0.1,rocks,0.1,0.3\na,0.2,rocks,0.2,0.6\n";
    let folder = Folder::with("t.csv", table);
    folder.refused(&["fragility", "t.csv", "--state", "peak_2 > 0.2"], &["t.csv", "peak_2"]);
    folder.write("t.csv", "record,PGV,outcome,peak_2,peak_1\na,0.1,rocks,0.9,0.1\na,0.2,rocks,0.9,0.2\n");
    let told = folder.succeeds(&["fragility", "t.csv", "--state", "peak_1 > 0.5"]);
    assert!(told.contains("no run"), "{told}");
}

/// Columns of one block say nothing of a second one, whether they are lost or not.
#[test]
fn fragility_takes_each_run_once_and_only_of_columns_with_the_block() {
    let folder = Folder::new();
    let header = "index,record,pgv,outcome,peak_1,peak_2\n";
    let two = "0,a,0.1,rocks,0.1,0.2\n1,a,0.5,overturns,1.0,1.0\n2,b,0.1,rocks,0.1,0.4\n3,b,0.5,rocks,0.1,0.2\n";
    let one = "4,c,0.1,overturns,1.0,\n5,c,0.5,rocks,0.2,\n";
    let table = |rows: &str| folder.write("t.csv", format!("{header}{rows}"));
    let fit = ["fragility", "t.csv", "--state", "peak_2 > 0.3", "--replicates", "0"];
    table(two);
    folder.succeeds(&fit);
    let shares = || folder.read("t-shares.csv");
    let alone = shares();
    table(&format!("{two}{one}"));
    folder.succeeds(&fit);
    assert_eq!(shares(), alone);
    table(&format!("{two}{two}"));
    folder.refused(&fit, &["row 5", "give each run once"]);
    // The same numbers of another record are other runs.
    table(&format!("{two}{}", two.replace(",a,", ",d,").replace(",b,", ",e,")));
    folder.succeeds(&fit);
    table(two);
    folder.refused("fragility t.csv --replicates 3", &["--replicates: 3", "at least 20"]);
    folder.refused("fragility t.csv --out f.xlsx", &["f.xlsx", ".csv"]);
    if cfg!(feature = "parquet") {
        folder.refused("fragility t.csv --out f.parquet", &["f.parquet", "written as CSV"]);
    }
}

/// Of runs that differ by more than their level no record comes back: each run is of a column of its own.
#[test]
fn records_of_a_cloud_of_several_columns_are_not_named() {
    let folder = Folder::new();
    let rows = |alphas: [f64; 6]| {
        let run = |(place, alpha): (usize, f64)| {
            let outcome = if [2, 4].contains(&place) { "overturns" } else { "rocks" };
            format!("a,{},{alpha},{outcome}\n", 0.1 * (place + 1) as f64)
        };
        alphas
            .into_iter()
            .enumerate()
            .map(run)
            .fold("record,pgv,size.alpha,outcome\n".into(), |table: String, row| table + &row)
    };
    let told = |table: String| {
        folder.write("t.csv", table);
        folder.succeeds("fragility t.csv --state overturned --replicates 0")
    };
    assert!(told(rows([0.2; 6])).contains("reach the state and do not at a higher level (a)"));
    let pooled = told(rows([0.1, 0.2, 0.15, 0.25, 0.3, 0.12]));
    assert!(pooled.contains("are not named, as runs of a record differ") && !pooled.contains("(a)"), "{pooled}");
    assert_eq!(folder.table("t-fragility.csv").row(0).text("resurrections"), "");
}

/// A doubled measure is named as such: without `--measure` it was asked for, and with it not found.
#[test]
fn a_measure_that_is_there_twice_is_refused() {
    let folder = Folder::with("t.csv", "pgv,pgv,outcome\n0.1,0.1,rocks\n0.3,0.3,overturns\n");
    for given in ["", " --measure pgv"] {
        let command = format!("fragility t.csv --state overturned{given}");
        folder.refused(&command, &["several of its columns are called `pgv`"]);
    }
}

/// Tables without the columns of a state, and tables without anything.
#[test]
fn tables_without_what_a_state_needs_are_refused() {
    let folder = folder();
    run(&folder, &format!("{BLOCK}levels = [0.5]\n[records]\nfolder = \"records\"\n"));
    folder.write("empty.csv", "");
    for (arguments, told) in [
        (
            &["fragility", "ida.csv", "--state", "peak_2 > 0.3"][..],
            "needs the column peak_2, and the columns of the table have 1 block(s)",
        ),
        (&["fragility", "ida.csv", "--state", "slide > 0.1"], "residual_slide_1"),
        (&["fragility", "empty.csv"], "it is empty"),
    ] {
        let message = unbroken(&folder.refused(arguments, &[]));
        assert!(message.contains(told), "{arguments:?}: {message}");
    }
}

/// A sweep over records and a measure is a study as well; a cloud of runs, each at a level of its own, is recognised.
#[test]
fn sweeps_and_clouds_have_a_fragility() {
    let base = "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 0.8\n[excitation.horizontal]\nkind = \"synthetic\"\npga_g = 0.3\n[solver]\nt_end = 30.0\n";
    let folder = Folder::with("base.toml", base);
    let sweep =
        "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\nseed = { from = 1, to = 8 }\npgv = [0.2, 0.4, 0.6, 0.8]\n";
    folder.write("sweep.toml", sweep);
    folder.succeeds("sweep sweep.toml --out t.csv --quiet");
    let found = folder.answers("fragility t.csv --state overturned --state peak>0.2 --json");
    assert_eq!((&found["measure"], &found["fragilities"][0]["layout"]), (&"pgv".into(), &"stripes".into()));
    let counts = found["fragilities"][0]["counts"].as_array().expect("a list");
    assert_eq!(counts.iter().map(|count| count["runs"].as_u64()).collect::<Vec<_>>(), [Some(8); 4]);
    // Of one record, there is no curve: a sweep that changes nothing else of the ground motion is of one record as well.
    folder.write(
        "one.toml",
        sweep.replace("seed = { from = 1, to = 8 }\n", "").replace("0.2, 0.4", "0.1, 0.2, 0.3, 0.4, 0.5"),
    );
    folder.succeeds("sweep one.toml --out one.csv --quiet");
    let told = folder.succeeds("fragility one.csv --state overturned");
    assert_has(&told, &["all runs are of one record"]);
    // Runs each at a level of its own.
    let mut cloud = String::from("record,pga_g,outcome\n");
    for k in 0..50 {
        let outcome = if k * 29 % 50 < k { "overturns" } else { "rocks" };
        cloud.push_str(&format!("r{k},{},{outcome}\n", 0.1 + 0.02 * f64::from(k)));
    }
    folder.write("cloud.csv", &cloud);
    let told = folder.succeeds("fragility cloud.csv --state overturned --plot c.svg");
    assert_has(&told, &["overturned: lognormal, median", "over groups"]);
    assert!(told.contains(" Marks are raw shares of groups of neighbouring levels. Shaded are 90 % bands."), "{told}");
    let told = folder.succeeds("fragility cloud.csv --state overturned --confidence 0.57 --plot c.svg");
    assert!(told.contains(" Shaded are 57 % bands."), "{told}");
    // What the table lacks is told.
    for (arguments, word) in [
        ("fragility cloud.csv", "ask = \"peaks\""),
        ("fragility cloud.csv --measure pgv --state uplift", "no column `pgv`"),
        ("fragility none.csv", "none.csv"),
        ("fragility cloud.csv --state toppled", "overturned"),
    ] {
        folder.refused(arguments, &[word]);
    }
}

/// Rows of another axis are pooled with a warning, and kept apart by `--where`.
#[test]
fn rows_of_other_axes_are_kept_apart() {
    let folder = Folder::new();
    let mut table = String::from("index,column.alpha,seed,pgv,outcome,truncated\n");
    for (index, (alpha, lost)) in [(0.15, 4), (0.3, 8)].into_iter().enumerate() {
        for record in 0..6 {
            for level in 1..=12 {
                let outcome = if level + record % 3 > lost { "overturns" } else { "rocks" };
                let is_cut = alpha > 0.2 && level == 1;
                let _ = writeln!(table, "{index},{alpha},{record},{},{outcome},{is_cut}", f64::from(level) / 10.0);
            }
        }
    }
    folder.write("t.csv", table);
    let fitted = |condition: &str| {
        let fit = "fragility t.csv --state overturned --replicates 0 --json";
        let (told, warnings) = folder.says(&format!("{fit} {condition}"));
        let found = parsed(&told);
        let counts = found["fragilities"][0]["counts"].as_array().expect("a list");
        (counts.iter().filter_map(|count| count["runs"].as_u64()).sum::<u64>(), warnings)
    };
    let (all, warning) = fitted("");
    let of_all = folder.read("t-fragility.csv");
    assert!(all == 144 && warning.contains("2 values of `column.alpha`") && warning.contains("--where"), "{warning}");
    assert_eq!(fitted("--where column.alpha=0.15"), (72, String::new()));
    // The tables of all rows stay.
    assert_eq!(folder.read("t-fragility.csv"), of_all);
    assert_eq!(folder.table("t-where-column.alpha=0.15-fragility.csv").texts("where"), ["column.alpha=0.15"]);
    assert!(folder.has("t-where-column.alpha=0.15-shares.csv"));
    // Conditions that differ in a sign which no file name has.
    folder.write(
        "u.csv",
        "record,pgv,outcome,kind\na,0.1,rocks,a b\nb,0.2,overturns,a b\na,0.1,rocks,a/b\nb,0.2,overturns,a/b\n",
    );
    let before = folder.names("").len();
    for kind in ["kind=a b", "kind=a/b"] {
        folder.succeeds(&["fragility", "u.csv", "--state", "overturned", "--replicates", "0", "--where", kind][..]);
    }
    assert_eq!(folder.names("").len(), before + 4, "{:?}", folder.names(""));
    assert_eq!(folder.says("fragility t.csv --state overturned --quiet"), (String::new(), String::new()));
    let (runs, warning) = fitted("--where column.alpha=0.30");
    assert!(runs == 72 && warning.contains("6 run(s) end before their ground motion"), "{warning}");
    for (condition, word) in
        [("alpha=0.3", "no column `alpha`"), ("column.alpha=0.4", "no row"), ("alpha", "COLUMN=VALUE")]
    {
        folder.refused(&format!("fragility t.csv --state overturned --where {condition}"), &[word]);
    }
}

/// Another program may have put the columns of a table in another order: each is known by its name.
#[test]
fn columns_may_stand_in_any_order() {
    let folder = Folder::new();
    let names = ["index", "record", "column.alpha", "pgv", "outcome", "impacts", "truncated"];
    let mut rows = vec![names.map(String::from)];
    for (index, place) in (0..40).enumerate() {
        let (record, level, alpha) = (place % 4, place / 4 % 5 + 1, if place < 20 { "0.15" } else { "0.3" });
        let outcome = if level + record > 5 { "overturns" } else { "rocks" };
        let level = format!("0.{level}");
        let texts = [&index.to_string(), &format!("r{record}"), alpha, &level, outcome, "3", "false"];
        rows.push(texts.map(String::from));
    }
    let told = |order: [usize; 7], rows: &[[String; 7]]| {
        let line = |row: &[String; 7]| order.map(|place| row[place].as_str()).join(",");
        folder.write("t.csv", rows.iter().map(line).collect::<Vec<_>>().join("\n") + "\n");
        folder.says("fragility t.csv --state overturned --replicates 0 --json")
    };
    let as_written = told([0, 1, 2, 3, 4, 5, 6], &rows);
    assert!(as_written.1.contains("2 values of `column.alpha`"), "{}", as_written.1);
    for order in [[4, 0, 1, 2, 3, 5, 6], [3, 0, 4, 1, 5, 6, 2], [6, 5, 4, 3, 2, 1, 0]] {
        assert_eq!(told(order, &rows), as_written, "{order:?}");
    }
    // The same run twice, with other results: once is meant.
    let mut twice = rows;
    twice.push(["39", "r3", "0.3", "0.5", "rocks", "4", "false"].map(String::from));
    folder.write("t.csv", twice.iter().map(|row| row.join(",")).collect::<Vec<_>>().join("\n"));
    folder.refused("fragility t.csv --state overturned", &["row 41", "give each run once"]);
}

/// A peak that is no number says nothing, and is not taken for a small one.
#[test]
fn peaks_are_numbers() {
    let folder = Folder::new();
    for peak in ["nan", "-5", "-inf", "word"] {
        folder.write("t.csv", format!("seed,pga_g,outcome,peak_1\n1,0.1,rocks,0.1\n2,0.2,rocks,{peak}\n"));
        folder
            .refused("fragility t.csv --replicates 0", &["row 2, column `peak_1`", peak, "zero or a number above it"]);
    }
}

/// Undecided runs are left out; the table and the text say what the curve would be if none or all of them reached the state.
#[test]
fn undecided_runs_bound_the_curve() {
    let folder = Folder::new();
    let mut table = String::from("record,pgv,outcome\n");
    for record in 0..8 {
        for level in 1..=6 {
            let outcome = match (level + record % 4, record == 7 && level > 3) {
                (_, true) => "not-determined",
                (5.., _) => "overturns",
                _ => "rocks",
            };
            let _ = writeln!(table, "r{record},{},{outcome}", f64::from(level) / 10.0);
        }
    }
    folder.write("t.csv", &table);
    let fitted = |table: &str| {
        folder.write("one.csv", table);
        let told = folder.succeeds("fragility one.csv --state overturned --replicates 0");
        let found = folder.table("one-fragility.csv");
        (
            told,
            ["median", "dispersion", "median_if_none", "dispersion_if_none", "median_if_all", "dispersion_if_all"]
                .map(|name| found.texts(name)[0].to_string()),
        )
    };
    let (told, [.., none, spread_of_none, all, spread_of_all]) = fitted(&table);
    assert!(told.contains("3 undecided run(s) are left out: "), "{told}");
    let (told, [median, dispersion, without, ..]) = fitted(&table.replace("not-determined", "rocks"));
    assert_eq!([median, dispersion], [none, spread_of_none]);
    assert!(without.is_empty() && !told.contains("undecided"), "{told}");
    let (_, [median, dispersion, ..]) = fitted(&table.replace("not-determined", "overturns"));
    assert_eq!([median, dispersion], [all, spread_of_all]);
}

/// Runs that are not there are named, in whatever order the others stand; several studies in one table have the same numbers.
#[test]
fn missing_runs_are_named() {
    let folder = Folder::with("unused.toml", "");
    let mut rows = Vec::new();
    for (index, (record, level)) in (0..4).flat_map(|record| (1..=5).map(move |level| (record, level))).enumerate() {
        let outcome = if level > 3 + record % 2 { "overturns" } else { "rocks" };
        rows.push(format!("{index},r{record},1.0,0.{level},{outcome},0.1"));
    }
    let warned = |rows: &[String]| {
        folder.write("t.csv", format!("index,record,scale,pgv,outcome,first_uplift\n{}\n", rows.join("\n")));
        folder.says("fragility t.csv --state overturned --replicates 0").1
    };
    assert_eq!(warned(&rows), "");
    let reversed: Vec<String> = rows.iter().rev().cloned().collect();
    assert_eq!(warned(&reversed), "");
    let other = |row: &String| row.replacen(",r", ",s", 1);
    let pooled: Vec<String> = rows.iter().cloned().chain(rows.iter().map(other)).collect();
    assert_eq!(warned(&pooled), "");
    let cut = [&rows[..4], &rows[7..12], &rows[13..]].concat();
    assert_eq!(warned(&cut), "warning: runs 4 to 6 are missing, and 1 more\n");
    assert_eq!(warned(&[&rows[..4], &rows[5..]].concat()), "warning: run 4 is missing\n");
}

/// A study of two blocks at six levels and five records: `[index, record, scale, pgv, outcome, impacts, block, truncated, first_uplift, peak_1, peak_2]`.
fn study() -> Vec<Vec<String>> {
    let header = "index,record,scale,pgv,outcome,impacts,block,truncated,first_uplift,peak_1,peak_2";
    let mut rows = vec![header.split(',').map(String::from).collect()];
    for index in 0..30 {
        let (record, level) = (index / 6, index % 6 + 1);
        let size = level + record % 3;
        let (outcome, block, uplift, peak) = match size {
            1..=2 => ("no-uplift", "", "", 0.0),
            3..=5 => ("rocks", "", "1.5", 0.1 * f64::from(size)),
            _ => ("overturns", "2", "1.5", 9.0),
        };
        let peaks = [format!("{:?}", 0.5 * peak), format!("{peak:?}")];
        let cells = [
            &index.to_string(),
            &format!("r{record}"),
            "1.5",
            &format!("0.{level}"),
            outcome,
            "3",
            block,
            "false",
            uplift,
        ];
        rows.push(cells.into_iter().map(String::from).chain(peaks).collect());
    }
    rows
}

/// The table as text, each cell below the header changed by its heading.
fn with(rows: &[Vec<String>], separator: &str, change: impl Fn(&str, &str) -> String) -> String {
    let line = |(number, row): (usize, &Vec<String>)| {
        let cells =
            rows[0].iter().zip(row).map(|(name, cell)| if number == 0 { cell.clone() } else { change(name, cell) });
        cells.collect::<Vec<_>>().join(separator)
    };
    rows.iter().enumerate().map(line).collect::<Vec<_>>().join("\n") + "\n"
}

/// Spreadsheets, pandas and R save a table in words of their own. None of them changes an answer.
#[test]
fn tables_that_other_programs_have_saved_say_the_same() {
    let folder = Folder::new();
    let rows = study();
    let told = |text: String| {
        folder.write("t.csv", text);
        let curves =
            folder.says("fragility t.csv --state uplift --state overturned --state peak>0.35 --replicates 50 --json");
        let figure = folder.says("plot t.csv");
        (curves, figure, folder.read("t.svg"))
    };
    let as_written = told(with(&rows, ",", |_, cell| cell.into()));
    assert_eq!((as_written.0.1.as_str(), as_written.1.1.as_str()), ("", ""));
    let is_number = |cell: &str| cell.parse::<f64>().is_ok();
    let pandas = |name: &str, cell: &str| match (name, cell) {
        ("impacts" | "block" | "index", number) if !number.is_empty() => format!("{number}.0"),
        ("truncated", "false") => "False".into(),
        _ => cell.into(),
    };
    let r = |_: &str, cell: &str| match cell {
        "" => "NA".to_string(),
        "false" => "FALSE".into(),
        cell if is_number(cell) => cell.into(),
        cell => format!("\"{cell}\""),
    };
    let german = |_: &str, cell: &str| if is_number(cell) { cell.replace('.', ",") } else { cell.into() };
    for (text, who) in [
        (with(&rows, ",", pandas), "pandas"),
        (with(&rows, ",", r), "R"),
        (with(&rows, ";", german), "a spreadsheet with decimal commas"),
        (with(&rows, "\t", |_, cell| cell.into()), "tabs"),
        (
            with(&rows, ",", |_, cell| cell.into())
                .replacen("first_uplift", "First_Uplift", 1)
                .replacen("record", "Record", 1),
            "capitals",
        ),
        (with(&rows, ",", |_, cell| cell.into()) + ",,,,,,,,,,\n\n", "empty rows"),
        (
            with(&rows, ",", |name, cell| if name == "truncated" { "0".into() } else { cell.into() }),
            "numbers for truths",
        ),
    ] {
        assert_eq!(told(text), as_written, "{who}");
    }
}

/// What would change an answer without a word is refused, or has a warning.
#[test]
fn tables_that_were_damaged_are_refused_or_have_a_warning() {
    let folder = Folder::new();
    let rows = study();
    let plain = with(&rows, ",", |_, cell| cell.into());
    let fit = "fragility t.csv --state peak>0.35 --state uplift --replicates 0";
    let body: Vec<&str> = plain.lines().skip(1).collect();
    let (but_last, last) = plain.trim_end().rsplit_once(',').expect("several columns");
    for (text, named) in [
        (plain.clone() + &plain, "line 32 is the header once more"),
        (plain.replacen("impacts", "outcome", 1), "two of its columns are called `outcome`"),
        (plain.replacen("false", "falsch", 1), "line 2, column `truncated`: `falsch` is neither true nor false"),
        (plain.replacen(",0.4\n", ",\"0.4\n", 1), "a quote is not closed"),
        (format!("{but_last},\"{last}\n"), "line 31: a quote is not closed"),
        (format!("{but_last},\"{last}"), "line 31: a quote is not closed"),
        (format!("{but_last},\"{last}\n").replace('\n', "\r\n"), "line 31: a quote is not closed"),
        (plain.replacen("false", "falsch", 1).replace('\n', "\r\n"), "line 2, column `truncated`"),
        ("record,pgv,outcome,\"note\na,0.1,rocks,x\n".into(), "line 1: a quote is not closed"),
        (
            with(
                &rows,
                ",",
                |name, cell| if name == "first_uplift" && cell.is_empty() { "-".into() } else { cell.into() },
            ),
            "column `first_uplift`: `-` is not a time",
        ),
        (
            rows.iter().map(|row| row[..10].join(",") + "\n").collect(),
            "block 2 was lost, and the table has no column `peak_2`",
        ),
        (format!("sep=,\n{plain}"), "its first line is no header"),
        (plain.replacen(",r0,", ",,", 1), "row 1, column `record`: `` is not the name of a record"),
        (plain.replacen("scale", "residual_slide_1", 1), "it has 2 column(s) `peak_…` and 1 `residual_slide_…`"),
        (format!("{plain}{}\n", body[3]), "the run stands in row 4 as well"),
    ] {
        folder.write("t.csv", text);
        folder.refused(fit, &[named]);
    }
    // Joined with a table that lacks the column: runs that rock have an uplift, whatever it says.
    let uplifts = |text: String| {
        folder.write("t.csv", text);
        parsed(&folder.says("fragility t.csv --state uplift --replicates 0 --json").0)["fragilities"][0]["counts"]
            .clone()
    };
    let without = |name: &str, cell: &str| if name == "first_uplift" { String::new() } else { cell.into() };
    assert_eq!(uplifts(with(&rows, ",", without)), uplifts(plain.clone()));
    let again: Vec<String> = body.iter().map(|row| format!("1{row}")).collect();
    folder.write("t.csv", format!("{plain}{}\n", again.join("\n")));
    let (_, warning) = folder.says(fit);
    assert!(warning.contains("30 run(s) have all settings of a run above"), "{warning}");
    assert!(!warning.contains("different records"), "{warning}");
    // Jobs that each call their first record r0. In units of uplift a record has another scale for another column.
    let pooled = |measure: &str| {
        let others = with(&rows, ",", |name, cell| if name == "scale" { "2.5".into() } else { cell.into() });
        let others: Vec<String> = others.lines().skip(1).map(|row| format!("1{row}\n")).collect();
        folder.write("t.csv", format!("{plain}{}", others.concat()).replacen("pgv", measure, 1));
        folder.says("fragility t.csv --state overturned --replicates 0").1
    };
    let warning = pooled("pgv");
    let told = "different records share 5 names, such as `r0`: their scales differ at one level";
    assert!(warning.contains(told), "{warning}");
    assert!(pooled("sa_g(0.5)").contains("different records share 5 names"));
    assert!(!pooled("pgv_uplift").contains("different records"));
    let blank = |name: &str, cell: &str| if name == "peak_2" && cell != "9.0" { String::new() } else { cell.into() };
    folder.write("t.csv", with(&rows, ",", blank));
    let (_, warning) = folder.says(fit);
    assert!(warning.contains("that stand have no `peak_2`"), "{warning}");
    assert_eq!(folder.says("plot t.csv").1, warning);
}

/// `--where` takes what the file shows, and what a tidied table has in its place.
#[test]
fn conditions_are_read_as_cells_are() {
    let folder = Folder::new();
    let rows = study();
    let r = |_: &str, cell: &str| if cell.is_empty() { "NA".to_string() } else { cell.replace("false", "False") };
    folder.write("t.csv", with(&rows, ",", r).replacen("record", "Record", 1));
    let runs = |condition: &str| {
        let told =
            folder.says(&format!("fragility t.csv --state overturned --replicates 0 --json --where {condition}")).0;
        let counts = parsed(&told)["fragilities"][0]["counts"].clone();
        counts.as_array().expect("a list").iter().filter_map(|count| count["runs"].as_u64()).sum::<u64>()
    };
    assert_eq!(
        [runs("truncated=False"), runs("truncated=false"), runs("Record=r1"), runs("record=r1")],
        [30, 30, 6, 6]
    );
    folder.write(
        "t.csv",
        with(&rows, ",", |name, cell| if name == "scale" { "\"1,5\"".into() } else { cell.into() })
            .replacen("scale", "site", 1),
    );
    assert_eq!(runs("site=1,5"), 30);
    folder.write("t.csv", with(&rows, ",", r));
    assert_eq!([runs("pgv=0,1"), runs("pgv=0.10"), runs("first_uplift=NA"), runs("block=2.0")], [5, 5, 6, 9]);
}

/// Rows without the name of a record are of records of their own: equal levels are no repetitions. A name is a name, though it looks like a number.
#[test]
fn names_and_records_are_left_alone() {
    let folder = Folder::new();
    let rows = (0..20).map(|run| format!("0.{},{}\n", 1 + run % 4, if run % 4 > 1 { "overturns" } else { "rocks" }));
    folder.write("t.csv", format!("pga,outcome\n{}", rows.collect::<String>()));
    assert_eq!(folder.says("fragility t.csv --state overturned --replicates 0").1, "");
    let names = ["001", "1", "1.0", "1e5"];
    let runs = names.iter().enumerate().flat_map(|(number, name)| (1..5).map(move |level| (number, name, level)));
    let rows = runs.map(|(number, name, level)| {
        format!("{name},0.{level},{}\n", if level > 1 + number % 3 { "overturns" } else { "rocks" })
    });
    folder.write("t.csv", format!("record,pga,outcome\n{}", rows.collect::<String>()));
    let (told, warning) = folder.says("fragility t.csv --state overturned --replicates 20");
    assert!(warning.is_empty() && told.contains("4 records are "), "{told}{warning}");
    // A line break within a name is no quote that is left open.
    folder.write("t.csv", "record,pga,outcome\n\"Kobe\n1995, Takatori, H1\",0.1,rocks\nb,0.2,overturns\n");
    folder.succeeds("fragility t.csv --state overturned --replicates 0");
}

/// Levels that rounding has moved are one stripe: tables that are put together have both `0.3` and `0.30000000000000004`.
#[test]
fn levels_that_differ_by_rounding_are_one() {
    let table = |shift: f64| {
        let mut table = String::from("record,pgv,outcome,peak_1\n");
        for level in 1..=5 {
            for record in 0..6 {
                let moved = 0.1 * f64::from(level) * (1.0 + shift * f64::from(record));
                let outcome = if record < level { "overturns" } else { "rocks" };
                let _ = writeln!(table, "r{record},{moved:?},{outcome},0.5");
            }
        }
        table
    };
    let curves = |shift: f64| {
        let folder = Folder::with("t.csv", &table(shift));
        let told = folder.answers("fragility t.csv --state overturned --json");
        let state = told["fragilities"][0].clone();
        assert_eq!(
            (&state["layout"], state["counts"].as_array().expect("levels").len()),
            (&"stripes".into(), 5),
            "{told}"
        );
        state["fit"].clone()
    };
    // The representatives of levels are the lowest of them, which rounding has not moved here.
    assert_eq!(curves(2e-16), curves(0.0));
    let apart = Folder::with("t.csv", &table(1e-6)).answers("fragility t.csv --state overturned --json");
    assert_eq!(apart["fragilities"][0]["counts"].as_array().expect("levels").len(), 30);
}

/// Results, numbers of runs and names are no measures.
#[test]
fn columns_that_can_be_no_measure_are_not_offered() {
    let folder = Folder::with(
        "t.csv",
        "index,record,size,outcome,impacts,peak_1\n0,a,0.1,rocks,3,0.1\n1,a,0.2,overturns,1,2.0\n",
    );
    let refused = folder.refused("fragility t.csv --state overturned", &["choose one of size with --measure"]);
    assert!(!unbroken(&refused).contains("impacts"), "{refused}");
    let none = Folder::with("t.csv", "index,outcome,impacts\n0,rocks,3\n");
    none.refused("fragility t.csv --state overturned", &["no column has the name of a measure", "rocking ida"]);
}
