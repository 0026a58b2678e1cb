//! Tables of sweeps as Parquet: the cells of CSV with types, the same bytes whatever the shards and interruptions.

use crate::common::sweeps::{SWEEP, folder, kill_and_go_on, long, start};
use crate::common::{Folder, Row, unbroken};
use parquet::basic::{Compression, LogicalType, Repetition, Type};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, FloatType, Int32Type};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::Field;
use parquet::schema::parser::parse_message_type;
use std::fs::File;
use std::sync::Arc;

/// Runs the sweep of the folder into a table and returns its bytes.
fn table(folder: &Folder, name: &str, arguments: &str) -> Vec<u8> {
    folder.succeeds(&format!("sweep sweep.toml --quiet --out {name} {arguments}"));
    folder.bytes(name)
}

fn open(folder: &Folder, name: &str) -> SerializedFileReader<File> {
    SerializedFileReader::new(File::open(folder.path(name)).expect("there")).expect("Parquet")
}

/// Whether `t.parquet` has the names and cells of `t.csv`; the crate's own reader of rows says so.
fn assert_same_cells(folder: &Folder) {
    let csv = folder.table("t.csv");
    let file = open(folder, "t.parquet");
    let mut read = 0;
    for (row, expected) in file.get_row_iter(None).expect("rows").zip(csv.rows()) {
        let row = row.expect("a row");
        let cells: Vec<_> = row.get_column_iter().collect();
        assert_eq!(cells.len(), csv.columns().len());
        for (((name, cell), expected_name), text) in cells.into_iter().zip(csv.columns()).zip(expected.cells()) {
            assert_eq!(name, expected_name);
            let is_same = match cell {
                Field::Null => text.is_empty(),
                Field::Long(number) => text.parse() == Ok(*number),
                Field::Double(number) => text.parse::<f64>().map(f64::to_bits) == Ok(number.to_bits()),
                Field::Bool(truth) => text.parse() == Ok(*truth),
                Field::Str(found) => found == text && !text.is_empty(),
                other => panic!("{name} is {other:?}"),
            };
            assert!(is_same, "{name}: {cell:?} for `{text}` in {expected:?}");
        }
        read += 1;
    }
    assert_eq!(read, csv.len());
    assert_eq!(file.metadata().file_metadata().num_rows() as usize, csv.len());
}

const PEAKS: &str = "scene = \"base.toml\"\nask = \"peaks\"\n[axes]\n\"solver.method\" = [\"taylor\", \"dop853\"]\n\
    blocks = [1, 3]\nomega_p = { from = 1, to = 8, steps = 7 }\neta = [0.9, 1.5, 0.1]\n";

#[test]
fn cells_are_those_of_csv_bit_for_bit() {
    for (sweep, many) in [(SWEEP, 60), (PEAKS, 84)] {
        let folder = folder(sweep);
        table(&folder, "t.csv", "");
        table(&folder, "t.parquet", "");
        assert_same_cells(&folder);
        let csv = folder.table("t.csv");
        assert_eq!(csv.len(), many);
        if sweep == PEAKS {
            // What the comparison is worth: there are errors, blanks, text and numbers of all digits.
            assert_eq!(csv.columns()[9..], ["peak_1", "peak_2", "peak_3", "last_mode", "truncated", "error"]);
            let errors = csv.rows().filter(|row| row.text("outcome") == "error");
            assert_eq!(errors.filter(|row| row.text("error").contains("restitution.eta")).count(), 28);
            let has_all_digits = |row: &Row| row.text("peak_1").len() > 15;
            assert!(csv.rows().filter(has_all_digits).any(|row| row.text("peak_2").is_empty()));
            assert!(csv.rows().filter(has_all_digits).any(|row| row.text("peak_3").len() > 15));
        }
        assert_eq!(folder.names("").len(), 4, "base, sweep and two tables");
    }
}

#[test]
fn columns_have_types() {
    let folder = folder(PEAKS);
    table(&folder, "t.parquet", "--threads 1");
    let file = open(&folder, "t.parquet");
    let text = (Type::BYTE_ARRAY, Some(LogicalType::String));
    let [whole, number, truth] = [Type::INT64, Type::DOUBLE, Type::BOOLEAN].map(|physical| (physical, None));
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
        ("truncated", &truth, optional),
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
        table(&folder, "t.csv", "");
        let whole = table(&folder, "t.parquet", "");
        assert_eq!(open(&folder, "t.parquet").num_row_groups(), groups);
        assert_same_cells(&folder);
        let shards: Vec<String> = (1..=count).rev().map(|number| format!("{number}.parquet")).collect();
        for (place, name) in shards.iter().enumerate() {
            table(&folder, name, &format!("--shard {}/{count}", count - place));
        }
        let merge = "merge merged.parquet --sweep sweep.toml";
        folder.succeeds(&format!("{merge} {}", shards.join(" ")));
        assert!(folder.bytes("merged.parquet") == whole, "{count} shards");
        folder.remove("merged.parquet");
        // Without the last one, which has rows however many there are.
        folder.refused(&format!("{merge} {}", shards[1..].join(" ")), &["sweep.toml", "the other shards"]);
        assert!(!folder.has("merged.parquet"));
    }
}

#[test]
fn tables_that_do_not_belong_together_are_refused() {
    let folder = folder(SWEEP);
    for name in ["1.parquet", "2.parquet", "3.parquet", "1.csv", "2.csv"] {
        table(&folder, name, &format!("--shard {}/3", &name[..1]));
    }
    let other = SWEEP.replace("blocks = [1, 2]", "eta = [0.8, 0.9]");
    folder.write("sweep.toml", other);
    table(&folder, "other.parquet", "--shard 2/3");
    folder.write("text.parquet", "index,outcome\n0,rocks\n");
    let bytes = folder.bytes("1.parquet");
    folder.write("half.parquet", &bytes[..bytes.len() / 2]);
    for (merged, shards, named) in [
        ("m.parquet", "1.parquet 3.parquet", &["3.parquet", "point 40 where 20 is due"][..]),
        ("m.parquet", "1.parquet other.parquet", &["other.parquet", "columns", "the others"]),
        ("m.parquet", "1.parquet 2.csv", &["2.csv", "other format"]),
        ("m.csv", "1.csv 2.parquet", &["2.parquet", "other format"]),
        ("m.parquet", "1.parquet text.parquet", &["text.parquet"]),
        ("m.parquet", "half.parquet", &["half.parquet"]),
        ("m.parquet", "1.parquet none.parquet", &["none.parquet"]),
        ("m.parquet", "1.parquet --sweep sweep.toml", &["1.parquet", "columns", "sweep.toml"]),
    ] {
        folder.refused(&format!("merge {merged} {shards}"), named);
        assert!(!folder.has(merged), "{shards}");
    }
}

/// A table as pandas writes it: all columns may be blank, numbers have other widths, snappy compresses it. It is read as its twin in CSV is.
#[test]
fn tables_of_other_programs_are_read() {
    let folder = Folder::new();
    let schema =
        "message schema { optional binary record (STRING); optional float pga; optional binary outcome (STRING);
        optional int32 impacts; optional double peak_1; optional boolean truncated; }";
    let schema = Arc::new(parse_message_type(schema).expect("a schema"));
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let file = File::create(folder.path("t.parquet")).expect("a file");
    let mut writer = SerializedFileWriter::new(file, schema, Arc::new(properties)).expect("a table");
    let mut group = writer.next_row_group().expect("a group");
    let (runs, mut csv) = (40, "record,pga,outcome,impacts,peak_1,truncated\n".to_string());
    let is_lost = |run: usize| run * run % 40 < run;
    let outcome = |run: usize| if is_lost(run) { "overturns" } else { "rocks" };
    let present = |is: fn(usize) -> bool| (0..runs).map(|run| i16::from(is(run))).collect::<Vec<_>>();
    let mut column = 0;
    while let Some(mut own) = group.next_column().expect("a column") {
        let texts = |text: &dyn Fn(usize) -> String| -> Vec<ByteArray> {
            (0..runs).map(|run| ByteArray::from(text(run).as_str())).collect()
        };
        let all = present(|_| true);
        match column {
            0 => own.typed::<ByteArrayType>().write_batch(&texts(&|run| format!("r{run}")), Some(&all), None),
            1 => {
                let levels: Vec<f32> = (0..runs).map(|run| 0.25 * (run + 1) as f32).collect();
                own.typed::<FloatType>().write_batch(&levels, Some(&all), None)
            }
            2 => own.typed::<ByteArrayType>().write_batch(&texts(&|run| outcome(run).into()), Some(&all), None),
            3 => own.typed::<Int32Type>().write_batch(&[3; 20], Some(&present(|run| run % 2 == 0)), None),
            4 => own.typed::<DoubleType>().write_batch(&[0.125; 20], Some(&present(|run| run % 2 == 0)), None),
            _ => own.typed::<BoolType>().write_batch(&vec![false; runs], Some(&all), None),
        }
        .expect("written");
        own.close().expect("a column");
        column += 1;
    }
    group.close().expect("a group");
    writer.close().expect("a table");
    for run in 0..runs {
        let [impacts, peak] = if run % 2 == 0 { ["3", "0.125"] } else { ["", ""] };
        csv += &format!("r{run},{},{},{impacts},{peak},false\n", 0.25 * (run + 1) as f64, outcome(run));
    }
    folder.write("c.csv", csv);
    let of = |name: &str| folder.succeeds(&format!("fragility {name} --replicates 0")).replace("c.csv", "t.parquet");
    assert_eq!(of("c.csv").replace("c-", "t-"), of("t.parquet"));
    assert_eq!(folder.read("c-fragility.csv"), folder.read("t-fragility.csv"));
    folder.refused("merge m.parquet t.parquet", &["t.parquet", "does not begin with the number of its point"]);
}

/// The reader of rows panics on some files whose end, which describes the columns, is damaged; that is an error like any other.
#[test]
fn damaged_tables_are_read_or_refused() {
    let folder = folder(SWEEP);
    let whole = table(&folder, "t.parquet", "");
    let description = u32::from_le_bytes(whole[whole.len() - 8..][..4].try_into().expect("four bytes")) as usize;
    let mut panics = 0;
    for damage in (0..description).step_by(7) {
        let mut bytes = whole.clone();
        bytes[whole.len() - 8 - description + damage] = 149;
        folder.write("x.parquet", &bytes);
        let output = folder.rocking("plot x.parquet --out figures");
        let message = unbroken(&String::from_utf8_lossy(&output.stderr));
        assert!(matches!(output.status.code(), Some(0 | 2)) && !message.contains("panicked"), "{damage}: {message}");
        panics += usize::from(message.contains("the file is damaged"));
    }
    assert!(panics > 0, "no damage makes the reader panic");
}

/// Hidden files of a folder: parts, and tables half made of them.
fn hidden(folder: &Folder) -> Vec<String> {
    folder.names("").into_iter().filter(|name| name.starts_with('.')).collect()
}

#[test]
fn a_sweep_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = folder(&long());
    let whole = table(&folder, "t.parquet", "");
    let csv = table(&folder, "t.csv", "");
    assert_same_cells(&folder);
    folder.remove("t.parquet");
    let mut part = None;
    kill_and_go_on(
        || start(&folder, "t.parquet"),
        || {
            let named = std::fs::read(folder.path("t.parquet")).ok();
            assert!(named.is_none_or(|bytes| bytes == whole), "the table has its name before it is whole");
            let found = hidden(&folder).into_iter().find(|name| name.ends_with(".part"));
            part = found.or(part.take());
        },
    );
    assert!(folder.bytes("t.parquet") == whole);
    assert!(hidden(&folder).is_empty());

    // Killed while the table is made of the part, and between its naming and the part's end.
    let part = part.expect("it was killed while it ran");
    for (made, is_named) in [(&whole[..0], false), (&whole[..whole.len() / 2], false), (&whole[..], false), (&[], true)]
    {
        folder.write(&part, &csv);
        folder.write(&part.replace(".part", ".whole"), made);
        if !is_named {
            folder.remove("t.parquet");
        }
        assert!(table(&folder, "t.parquet", "") == whole);
        assert!(hidden(&folder).is_empty());
    }

    // As a power cut may leave it: as long as it was, and empty within.
    let mut holed = csv.clone();
    holed[csv.len() / 2..][..100].fill(0);
    folder.write(&part, &holed);
    folder.remove("t.parquet");
    assert!(table(&folder, "t.parquet", "") == whole);
    assert!(hidden(&folder).is_empty());

    // Rows that are no results, however they came there: they and those after them are made anew.
    let text = String::from_utf8(csv).expect("text");
    for (rocks, other) in [(",rocks,", ",rocks,x"), (",rocks,", ",rolls,"), (",rocks,", ","), ("1,", "one,")] {
        folder.write(&part, text.replacen(rocks, other, 2));
        folder.remove("t.parquet");
        assert!(table(&folder, "t.parquet", "") == whole, "{other}");
    }
    assert!(hidden(&folder).is_empty());
}

#[test]
fn a_table_of_parquet_is_drawn_as_one_of_csv() {
    let folder = folder(&SWEEP.replace("steps = 6", "steps = 12"));
    table(&folder, "csv.csv", "");
    table(&folder, "parquet.parquet", "--plot at-once.svg");
    folder.succeeds("plot csv.csv");
    folder.succeeds("plot parquet.parquet");
    for end in [".svg", "-minimum.svg"] {
        assert_eq!(folder.read(&format!("csv{end}")), folder.read(&format!("parquet{end}")));
        assert_eq!(folder.read(&format!("csv{end}")), folder.read(&format!("at-once{end}")));
    }
}
