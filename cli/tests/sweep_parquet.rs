//! Tables of sweeps as Parquet: the cells of CSV with types, the same bytes whatever the shards and interruptions.

mod common;

use common::sweeps::{SWEEP, folder, kill_and_go_on, long};
use parquet::basic::{LogicalType, Repetition, Type};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::fs::File;
use std::path::{Path, PathBuf};

/// Runs the sweep of the folder into a table and returns its bytes.
fn table(folder: &Path, name: &str, arguments: &[&str]) -> Vec<u8> {
    common::succeeds(folder, &[&["sweep", "sweep.toml", "--quiet", "--out", name], arguments].concat());
    std::fs::read(folder.join(name)).expect("written")
}

/// The rows of a table of CSV, the header first.
fn rows(csv: &[u8]) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(csv);
    reader.records().map(|row| row.expect("CSV").iter().map(String::from).collect()).collect()
}

fn open(path: &Path) -> SerializedFileReader<File> {
    SerializedFileReader::new(File::open(path).expect("there")).expect("Parquet")
}

/// Whether a table of Parquet has the names and cells of one of CSV; the crate's own reader of rows says so.
fn assert_same_cells(path: &Path, csv: &[u8]) {
    let rows = rows(csv);
    let file = open(path);
    let mut read = 0;
    for (row, expected) in file.get_row_iter(None).expect("rows").zip(&rows[1..]) {
        let row = row.expect("a row");
        let cells: Vec<_> = row.get_column_iter().collect();
        assert_eq!(cells.len(), rows[0].len());
        for (((name, cell), expected_name), text) in cells.into_iter().zip(&rows[0]).zip(expected) {
            assert_eq!(name, expected_name);
            let is_same = match cell {
                Field::Null => text.is_empty(),
                Field::Long(number) => text.parse() == Ok(*number),
                Field::Double(number) => text.parse::<f64>().map(f64::to_bits) == Ok(number.to_bits()),
                Field::Str(found) => found == text && !text.is_empty(),
                other => panic!("{name} is {other:?}"),
            };
            assert!(is_same, "{name}: {cell:?} for `{text}` in {expected:?}");
        }
        read += 1;
    }
    assert_eq!(read, rows.len() - 1);
    assert_eq!(file.metadata().file_metadata().num_rows() as usize, rows.len() - 1);
}

const PEAKS: &str = "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\n\"solver.method\" = [\"taylor\", \"dop853\"]\n\
    blocks = [1, 3]\nomega_p = { from = 1, to = 8, steps = 7 }\neta = [0.9, 1.5, 0.1]\n";

#[test]
fn cells_are_those_of_csv_bit_for_bit() {
    for (sweep, many) in [(SWEEP, 60), (PEAKS, 84)] {
        let folder = folder(sweep);
        let csv = table(folder.path(), "t.csv", &[]);
        table(folder.path(), "t.parquet", &[]);
        assert_same_cells(&folder.path().join("t.parquet"), &csv);
        assert_eq!(rows(&csv).len(), many + 1);
        if sweep == PEAKS {
            // What the comparison is worth: there are errors, blanks, text and numbers of all digits.
            let rows = rows(&csv);
            assert_eq!(rows[0][9..], ["peak_1", "peak_2", "peak_3", "last_mode", "truncated", "error"]);
            assert_eq!(rows.iter().filter(|row| row[5] == "error" && row[14].contains("restitution.eta")).count(), 28);
            assert!(rows.iter().any(|row| row[9].len() > 15 && row[10].is_empty()));
            assert!(rows.iter().any(|row| row[9].len() > 15 && row[11].len() > 15));
        }
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 4, "base, sweep and two tables");
    }
}

#[test]
fn columns_have_types() {
    let folder = folder(PEAKS);
    table(folder.path(), "t.parquet", &["--threads", "1"]);
    let file = open(&folder.path().join("t.parquet"));
    let text = (Type::BYTE_ARRAY, Some(LogicalType::String));
    let [whole, number] = [(Type::INT64, None), (Type::DOUBLE, None)];
    let (required, optional) = (Repetition::REQUIRED, Repetition::OPTIONAL);
    let expected = [
        ("index", &whole, required),
        ("solver.method", &text, required),
        ("column.blocks", &number, required),
        ("excitation.horizontal.omega_p", &number, required),
        ("restitution.eta", &number, required),
        ("outcome", &text, required),
        ("impacts", &whole, optional),
        ("block", &whole, optional),
        ("overturned_at", &number, optional),
        ("peak_1", &number, optional),
        ("peak_2", &number, optional),
        ("peak_3", &number, optional),
        ("last_mode", &text, optional),
        ("truncated", &text, optional),
        ("error", &text, optional),
    ];
    let fields = file.metadata().file_metadata().schema().get_fields();
    assert_eq!(fields.len(), expected.len());
    for (field, (name, (physical, logical), repetition)) in fields.iter().zip(expected) {
        let info = field.get_basic_info();
        assert_eq!((field.name(), field.get_physical_type()), (name, *physical));
        assert_eq!((info.logical_type_ref(), info.repetition()), (logical.as_ref(), repetition), "{name}");
    }
}

/// A sweep of several row groups, cut elsewhere by its shards.
#[test]
fn shards_make_the_bytes_of_the_whole() {
    let many = "scene = \"base.toml\"\n[axes]\neta = { from = 0.1, to = 0.9, steps = 140 }\n\
        amplitude_g = { from = 0.001, to = 0.01, steps = 1000 }\n";
    for (sweep, count, groups) in [(SWEEP, 4, 1), (SWEEP, 61, 1), (many, 5, 3)] {
        let folder = folder(sweep);
        let csv = table(folder.path(), "t.csv", &[]);
        let whole = table(folder.path(), "t.parquet", &[]);
        assert_eq!(open(&folder.path().join("t.parquet")).num_row_groups(), groups);
        assert_same_cells(&folder.path().join("t.parquet"), &csv);
        let shards: Vec<String> = (1..=count).rev().map(|number| format!("{number}.parquet")).collect();
        for (place, name) in shards.iter().enumerate() {
            table(folder.path(), name, &["--shard", &format!("{}/{count}", count - place)]);
        }
        let mut arguments = vec!["merge", "merged.parquet", "--sweep", "sweep.toml"];
        arguments.extend(shards.iter().map(String::as_str));
        common::succeeds(folder.path(), &arguments);
        assert!(std::fs::read(folder.path().join("merged.parquet")).expect("written") == whole, "{count} shards");
        std::fs::remove_file(folder.path().join("merged.parquet")).expect("there");
        // Without the last one, which has rows however many there are.
        arguments.remove(4);
        let output = common::rocking(folder.path(), &arguments);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2));
        assert!(message.contains("sweep.toml") && message.contains("the other shards"), "{message}");
        assert!(!folder.path().join("merged.parquet").exists());
    }
}

#[test]
fn tables_that_do_not_belong_together_are_refused() {
    let folder = folder(SWEEP);
    for name in ["1.parquet", "2.parquet", "3.parquet", "1.csv", "2.csv"] {
        table(folder.path(), name, &["--shard", &format!("{}/3", &name[..1])]);
    }
    let other = SWEEP.replace("blocks = [1, 2]", "eta = [0.8, 0.9]");
    std::fs::write(folder.path().join("sweep.toml"), other).expect("written");
    table(folder.path(), "other.parquet", &["--shard", "2/3"]);
    std::fs::write(folder.path().join("text.parquet"), "index,outcome\n0,rocks\n").expect("written");
    let bytes = std::fs::read(folder.path().join("1.parquet")).expect("there");
    std::fs::write(folder.path().join("half.parquet"), &bytes[..bytes.len() / 2]).expect("written");
    for (arguments, named) in [
        (&["m.parquet", "1.parquet", "3.parquet"][..], &["3.parquet", "point 40 where 20 is due"][..]),
        (&["m.parquet", "1.parquet", "other.parquet"], &["other.parquet", "columns", "the others"]),
        (&["m.parquet", "1.parquet", "2.csv"], &["2.csv", "other format"]),
        (&["m.csv", "1.csv", "2.parquet"], &["2.parquet", "other format"]),
        (&["m.parquet", "1.parquet", "text.parquet"], &["text.parquet"]),
        (&["m.parquet", "half.parquet"], &["half.parquet"]),
        (&["m.parquet", "1.parquet", "none.parquet"], &["none.parquet"]),
        (&["m.parquet", "1.parquet", "--sweep", "sweep.toml"], &["1.parquet", "columns", "sweep.toml"]),
    ] {
        let output = common::rocking(folder.path(), &[&["merge"], arguments].concat());
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(named.iter().all(|part| message.contains(part)), "{named:?} in\n{message}");
        assert!(!folder.path().join(arguments[0]).exists(), "{arguments:?}");
    }
}

/// Hidden files of a folder: parts, and tables half made of them.
fn hidden(folder: &Path) -> Vec<PathBuf> {
    let files = std::fs::read_dir(folder).expect("a folder").map(|file| file.expect("a file").path());
    files.filter(|file| file.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'))).collect()
}

#[test]
fn a_sweep_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = folder(&long());
    let path = folder.path().join("t.parquet");
    let whole = table(folder.path(), "t.parquet", &[]);
    let csv = table(folder.path(), "t.csv", &[]);
    assert_same_cells(&path, &csv);
    std::fs::remove_file(&path).expect("there");
    let mut part = None;
    kill_and_go_on(folder.path(), "t.parquet", || {
        let named = std::fs::read(&path).ok();
        assert!(named.is_none_or(|bytes| bytes == whole), "the table has its name before it is whole");
        let found = hidden(folder.path()).into_iter().find(|file| file.extension().is_some_and(|end| end == "part"));
        part = found.or(part.take());
    });
    assert!(std::fs::read(&path).expect("written") == whole);
    assert!(hidden(folder.path()).is_empty());

    // Killed while the table is made of the part, and between its naming and the part's end.
    let part = part.expect("it was killed while it ran");
    for (made, is_named) in [(&whole[..0], false), (&whole[..whole.len() / 2], false), (&whole[..], false), (&[], true)]
    {
        std::fs::write(&part, &csv).expect("written");
        std::fs::write(part.with_extension("whole"), made).expect("written");
        if !is_named {
            std::fs::remove_file(&path).expect("there");
        }
        assert!(table(folder.path(), "t.parquet", &[]) == whole);
        assert!(hidden(folder.path()).is_empty());
    }

    // As a power cut may leave it: as long as it was, and empty within.
    let mut holed = csv.clone();
    holed[csv.len() / 2..][..100].fill(0);
    std::fs::write(&part, &holed).expect("written");
    std::fs::remove_file(&path).expect("there");
    assert!(table(folder.path(), "t.parquet", &[]) == whole);
    assert!(hidden(folder.path()).is_empty());

    // Rows that are no results, however they came there.
    let text = String::from_utf8(csv).expect("text");
    std::fs::write(&part, text.replacen(",rocks,", ",rocks,x", 1)).expect("written");
    std::fs::remove_file(&path).expect("there");
    let output = common::rocking(folder.path(), &["sweep", "sweep.toml", "--out", "t.parquet", "--quiet"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(message.contains(".part: ") && message.contains("remove this file"), "{message}");
    assert!(!path.exists());
    assert_eq!(hidden(folder.path()), [part]);
}

#[test]
fn a_table_of_parquet_is_drawn_as_one_of_csv() {
    let folder = folder(&SWEEP.replace("steps = 6", "steps = 12"));
    table(folder.path(), "csv.csv", &[]);
    table(folder.path(), "parquet.parquet", &["--plot", "at-once.svg"]);
    common::succeeds(folder.path(), &["plot", "csv.csv"]);
    common::succeeds(folder.path(), &["plot", "parquet.parquet"]);
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("written");
    for end in [".svg", "-minimum.svg"] {
        assert_eq!(read(&format!("csv{end}")), read(&format!("parquet{end}")));
        assert_eq!(read(&format!("csv{end}")), read(&format!("at-once{end}")));
    }
}
