//! Record files of every known format are understood as their layouts say, in all their variants, or refused with a place and
//! a remedy.
//!
//! `ground/tests/records/` holds one invented motion, `motion.csv`, written in every format. A file must give that motion within half a
//! unit of the last digit that it prints.

use proptest::prelude::*;
use rocking_ground::{AccelerationUnit, Format, Record, RecordError, RecordFile, TextOptions};
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/records")
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(folder().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn text(name: &str) -> String {
    bytes(name).iter().map(|byte| char::from(*byte)).collect()
}

fn read(name: &str, options: &TextOptions) -> RecordFile {
    RecordFile::read(&bytes(name), options).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn refused(bytes: &[u8], options: &TextOptions) -> RecordError {
    RecordFile::read(bytes, options).expect_err("it must be refused")
}

/// The motion of all files `[m/s²]`.
fn motion() -> Vec<f64> {
    let rows = text("motion.csv");
    let value = |row: &str| row.split_once(',').and_then(|(_, a)| a.trim().parse::<f64>().ok());
    let motion: Vec<f64> = rows.lines().filter_map(value).map(|a| a / 100.0).collect();
    assert_eq!(motion.len(), 42);
    motion
}

fn options() -> TextOptions {
    TextOptions::default()
}

fn channel(channel: usize) -> TextOptions {
    TextOptions { channel: Some(channel), ..options() }
}

/// A file, how it is read, its format, and half a unit of its last digit `[m/s²]`, a tenth added for rounding in the sums.
type Case = (&'static str, TextOptions, Format, f64);

fn cases() -> Vec<Case> {
    let gal = || TextOptions { units: AccelerationUnit::parse("gal"), ..options() };
    // Seven digits of up to 0.25 g; fourteen decimals less the zero; five decimals of cm/s².
    let (e7, f5) = (0.55 * 1e-7 * 9.81, 0.55e-7);
    // Half a count of 3920/6182761 cm/s², and as much again of the mean.
    let count = 0.55 * 2.0 * 3920.0 / 6_182_761.0 * 0.01;
    vec![
        ("motion.csv", options(), Format::Table, f5),
        ("peer/RSN9001_HOLLOW_MIL090.AT2", options(), Format::PeerAt2, e7),
        ("peer/RSN9001_HOLLOW_MIL000.AT2", options(), Format::PeerAt2, e7),
        ("peer/RSN9001_HOLLOW_MIL-UP.AT2", options(), Format::PeerAt2, e7),
        ("peer/nrc-processed.AT2", options(), Format::PeerAt2, e7),
        // Thirteen decimals, cut rather than rounded.
        ("peer/touching.AT2", options(), Format::PeerAt2, 1.1e-13 * 9.81),
        ("peer/dos-latin1-d-exponents.AT2", options(), Format::PeerAt2, 0.55e-4 * 0.01),
        ("dyna/itaca-43.DAT", options(), Format::Dyna, f5),
        ("dyna/XX.MIB..HNE.D.55.ASC", options(), Format::Dyna, 0.55e-4 * 0.01),
        ("dyna/XX.MIB..HNE.D.64.ASC", options(), Format::Dyna, f5),
        ("dyna/any-order-lower-case.asc", options(), Format::Dyna, f5),
        ("knet/XXX0010103040506.EW", options(), Format::KNet, count),
        ("knet/XXXH020103040506.UD2", options(), Format::KNet, count),
        ("csmip/one-channel.v2", options(), Format::Csmip, f5),
        ("csmip/three-channels.V2", channel(3), Format::Csmip, f5),
        ("cosmos/cm.V2", options(), Format::Cosmos, f5),
        ("cosmos/g.V2", options(), Format::Cosmos, e7),
        ("cosmos/inch-touching.V2", options(), Format::Cosmos, 0.55e-5 * 0.0254),
        ("cosmos/milli-g.V2", options(), Format::Cosmos, 0.55e-3 * 9.81e-3),
        ("cosmos/two-channels.V2", channel(2), Format::Cosmos, f5),
        ("table/one-column.txt", TextOptions { dt: Some(0.01), ..gal() }, Format::Table, f5),
        ("table/semicolons-decimal-commas.csv", options(), Format::Table, f5),
        ("table/tabs-milliseconds.tsv", options(), Format::Table, 0.55e-5 * 9.81e-3),
        ("table/blanks-rounded-times.txt", options(), Format::Table, 0.55e-9 * 9.81),
        ("table/skip-rows.txt", TextOptions { skip_rows: 2, ..gal() }, Format::Table, f5),
        ("table/three-columns.csv", TextOptions { column: Some("up".into()), ..options() }, Format::Table, f5),
        ("table/three-columns.csv", TextOptions { column: Some("3".into()), ..options() }, Format::Table, f5),
    ]
}

#[test]
fn the_same_motion_reads_from_every_format() {
    let motion = motion();
    let mean = motion.iter().sum::<f64>() / motion.len() as f64;
    for (name, options, format, tolerance) in cases() {
        let file = read(name, &options);
        assert_eq!((file.format, file.accel.len()), (format, motion.len()), "{name}");
        assert!((file.dt - 0.01).abs() < 1e-15, "{name}: dt = {}", file.dt);
        assert_eq!(file.warnings, [""; 0], "{name}");
        assert!(file.declared.is_none_or(|declared| declared == motion.len()), "{name}");
        // The zero of these instruments is the mean.
        let zero = if format == Format::KNet { mean } else { 0.0 };
        for (sample, (read, wanted)) in file.accel.iter().zip(&motion).enumerate() {
            let off = (read - (wanted - zero)).abs();
            assert!(off <= tolerance, "{name}, sample {}: {read} is off by {off:e}, allowed {tolerance:e}", sample + 1);
        }
    }
}

#[test]
fn errors_of_files_name_them() {
    let open = |path: &Path| Record::open(path, &options());
    let path = folder().join("peer/RSN9001_HOLLOW_MIL090.AT2");
    assert_eq!(open(&path).expect("readable").source().file, path.display().to_string());
    for (path, part) in [(folder(), "this is a folder"), (folder().join("peer/velocity.VT2"), "line 3: this is no acc")]
    {
        let error = open(&path).expect_err("it must be refused").to_string();
        assert!(error.starts_with(&path.display().to_string()) && error.contains(part), "{error}");
    }
}

#[test]
fn files_say_where_they_come_from() {
    let described = |name: &str, options: &TextOptions| {
        let file = read(name, options);
        (file.title, file.station, file.component, file.unit.to_string())
    };
    let own = |title: &str, station: &str, component: &str, unit: &str| {
        (title.to_string(), station.to_string(), component.to_string(), unit.to_string())
    };
    assert_eq!(
        described("peer/RSN9001_HOLLOW_MIL090.AT2", &options()),
        own("Hollow Creek-01, 3/4/2001", "Mill Bridge", "090", "g")
    );
    assert_eq!(
        described("peer/dos-latin1-d-exponents.AT2", &options()),
        own("Arroyo Seco, 3/4/2001", "Estación Peña", "090", "cm/s²")
    );
    assert_eq!(
        described("dyna/any-order-lower-case.asc", &options()),
        own("HOLLOW CREEK XX-2001-0007 20010304", "XX.MIB (MILL_BRIDGE)", "HNE", "cm/s²")
    );
    assert_eq!(described("knet/XXX0010103040506.EW", &options()), own("2001/03/04 05:06:07", "XXX001", "E-W", "cm/s²"));
    assert_eq!(described("knet/XXXH020103040506.UD2", &options()).2, "U-D surface (6)");
    assert_eq!(
        described("csmip/three-channels.V2", &channel(2)),
        own("HOLLOW CREEK EARTHQUAKE", "99123 MILL BRIDGE - NORTH ABUTMENT", "UP", "cm/s²")
    );
    assert_eq!(
        described("cosmos/two-channels.V2", &channel(2)),
        own("HOLLOW CREEK Earthquake of Sun Mar 4, 2001 05:06 UTC", "XX-MIB Mill Bridge", "Up", "cm/s²")
    );
    assert_eq!(read("csmip/three-channels.V2", &channel(2)).channels, ["1: 90 DEG", "2: UP", "3: 360 DEG"]);
    assert_eq!(read("cosmos/two-channels.V2", &channel(2)).channels, ["1: 90 deg", "2: Up"]);
    let peak = read("csmip/one-channel.v2", &options()).stated_peak.expect("stated");
    assert!((peak - 2.39336).abs() < 1e-12);
}

#[test]
fn one_of_several_channels_is_chosen_by_number() {
    for name in ["csmip/three-channels.V2", "cosmos/two-channels.V2"] {
        let first = read(name, &options());
        assert!(first.warnings[0].contains("channels (1: 90"), "{:?}", first.warnings);
        assert_eq!(first.accel, read(name, &channel(1)).accel);
        assert!((first.accel[13] / motion()[13] - 0.5).abs() < 1e-6, "{name}: the first channel is half the motion");
        assert_eq!(read(name, &channel(1)).warnings, [""; 0]);
        let error = refused(&bytes(name), &channel(4)).to_string();
        assert!(error.contains("channel 4") && error.contains("1: 90"), "{error}");
    }
    assert!((read("csmip/three-channels.V2", &channel(2)).accel[13] / motion()[13] + 0.25).abs() < 1e-6);
    // A header's own numbers go before places.
    let renumbered = text("csmip/three-channels.V2").replace("CHAN  1:", "CHAN  7:").replace("CHAN  3:", "CHAN  1:");
    let chosen = RecordFile::read(renumbered.as_bytes(), &channel(1)).expect("channel 1 is the last now");
    assert_eq!(chosen.component, "360 DEG");
    // A number that no channel has is no place.
    let renumbered = renumbered.replace("CHAN  1:", "CHAN  9:");
    let error = refused(renumbered.as_bytes(), &channel(1)).to_string();
    assert!(error.starts_with("channel 1 is not in the file; it has 7: 90 DEG"), "{error}");
    let error = refused(&bytes("peer/nrc-processed.AT2"), &channel(2));
    assert!(matches!(error, RecordError::NoChannel { channel: 2, .. }), "{error}");
}

#[test]
fn what_is_no_acceleration_is_refused_with_advice() {
    for (name, line, parts) in [
        ("peer/velocity.VT2", 3, ["no acceleration", ".AT2"]),
        ("dyna/spectrum.ASC", 49, ["no acceleration", ".ACC"]),
        ("dyna/spectrum-untold.ASC", 64, ["response spectrum", ".ACC"]),
        ("csmip/uncorrected.V1", 1, ["volume 1", "volume 2"]),
        ("cosmos/velocity.V2", 48, ["no acceleration", "acceleration of the same record"]),
        ("cosmos/counts.V0", 48, ["counts", "volume 2"]),
    ] {
        let error = refused(&bytes(name), &options()).to_string();
        assert!(error.starts_with(&format!("line {line}:")), "{name}: {error}");
        assert!(parts.iter().all(|part| error.contains(part)), "{name}: {error}");
    }
}

/// The header's words for a number of samples.
type Counting = fn(usize) -> String;

/// Files with a declared count: name, the text that declares it, how another count is written.
fn counted() -> [(&'static str, &'static str, Counting); 4] {
    [
        ("peer/RSN9001_HOLLOW_MIL090.AT2", "NPTS=    42", |n| format!("NPTS=    {n}")),
        ("dyna/XX.MIB..HNE.D.64.ASC", "NDATA: 42", |n| format!("NDATA: {n}")),
        ("csmip/one-channel.v2", "42 points of accel", |n| format!("{n} points of accel")),
        ("cosmos/cm.V2", "42 acceleration pts", |n| format!("{n} acceleration pts")),
    ]
}

#[test]
fn fewer_samples_than_declared_are_an_error_unless_lenient_and_more_are_a_warning() {
    for (name, count, other) in counted() {
        let text = text(name);
        assert!(text.contains(count), "{name}");
        let more = text.replace(count, &other(45));
        let error = refused(more.as_bytes(), &options());
        assert!(matches!(error, RecordError::Fewer { declared: 45, found: 42, .. }), "{name}: {error}");
        assert!(error.to_string().contains("lenient"), "{error}");
        let lenient = TextOptions { lenient: true, ..options() };
        let file = RecordFile::read(more.as_bytes(), &lenient).expect("lenient");
        assert_eq!(file.accel.len(), 42, "{name}");
        assert!(file.warnings.iter().any(|warning| warning.contains("45")), "{name}: {:?}", file.warnings);

        let fewer = RecordFile::read(text.replace(count, &other(40)).as_bytes(), &options()).expect("the first 40");
        assert_eq!((fewer.accel.len(), fewer.declared), (40, Some(40)), "{name}");
        assert!(fewer.warnings.iter().any(|warning| warning.contains("42 samples")), "{name}: {:?}", fewer.warnings);
    }
}

#[test]
fn a_file_that_is_cut_off_is_refused() {
    for (name, ..) in counted() {
        let text = text(name);
        // Within the last rows of the acceleration: the files of several blocks are cut there too.
        let place = text.find("/&").or(text.find("End-of-data")).or(text.find("points of veloc")).unwrap_or(text.len());
        let cut = if name.starts_with("csmip") { text.find("points of veloc").expect("follows") } else { place };
        let error = refused(&text.as_bytes()[..cut - 90], &options());
        assert!(matches!(error, RecordError::Fewer { declared: 42, .. }), "{name}: {error}");
    }
}

#[test]
fn decimal_commas_of_dyna_are_named() {
    let text = text("dyna/XX.MIB..HNE.D.64.ASC");
    let samples = text.lines().position(|line| line.trim().parse::<f64>().is_ok()).expect("rows of samples");
    let row = |(number, line): (usize, &str)| if number < samples { line.into() } else { line.replace('.', ",") };
    let commas: Vec<String> = text.lines().enumerate().map(row).collect();
    let error = refused(commas.join("\n").as_bytes(), &options());
    assert!(matches!(error, RecordError::DecimalComma { line, .. } if line == samples + 1), "{error}");
}

/// Without unit and quantity the peak that the header states says that the samples are velocities.
#[test]
fn velocities_of_dyna_are_refused_by_their_peak() {
    let text = text("dyna/XX.MIB..HNE.D.64.ASC");
    let without = |line: &&str| !["UNITS", "DATA_TYPE"].iter().any(|key| line.starts_with(key));
    let lines: Vec<String> = text.lines().filter(without).map(|line| line.replace("PGA_CM/S^2", "PGV_CM/S")).collect();
    let error = refused(lines.join("\n").as_bytes(), &options()).to_string();
    assert!(error.contains("this is no acceleration: `PGV_CM/S"), "{error}");
}

/// Spreadsheets part the names of a K-NET header from the values; KiK-net has instruments in boreholes.
#[test]
fn headers_of_knet_may_be_cells_and_boreholes_have_a_warning() {
    let name = "knet/XXX0010103040506.EW";
    let plain = read(name, &options());
    for delimiter in [",", ";"] {
        let cells = |(place, line): (usize, &str)| match line.split_at_checked(18) {
            Some((name, value)) if place < 17 => format!("{}{delimiter}{value}", name.trim_end()),
            _ => line.to_string(),
        };
        let cells: Vec<String> = text(name).lines().enumerate().map(cells).collect();
        let file = RecordFile::read(cells.join("\n").as_bytes(), &options()).expect("a K-NET file");
        assert_eq!((&file.accel, file.dt, &file.component), (&plain.accel, plain.dt, &plain.component));
    }
    let below = text(name).replace("E-W", "2");
    let file = RecordFile::read(below.as_bytes(), &options()).expect("a KiK-net file");
    assert!(file.warnings.iter().any(|warning| warning.contains("in a borehole")), "{:?}", file.warnings);
    // A table may begin with the time of the earthquake.
    let table = "Origin Time,2001/03/04 05:06:07\nTime (s),Acc (g)\n0,0.1\n0.01,0.2\n0.02,0.1\n";
    assert_eq!(RecordFile::read(table.as_bytes(), &options()).expect("a table").accel.len(), 3);
}

#[test]
fn two_units_are_refused_unless_the_options_are_lenient() {
    let peer = text("peer/RSN9001_HOLLOW_MIL090.AT2");
    let (series, count) = ("ACCELERATION TIME SERIES IN UNITS OF G", "NPTS=");
    assert!(peer.contains(series) && peer.contains(count));
    let both = peer.replacen(count, &format!("ACCELERATION IN UNITS OF CM/S2\n{count}"), 1);
    let table = "# units g\n# units m/s2\n0,0.1\n0.01,0.2\n0.02,0.1\n".to_string();
    for text in [both, table] {
        let error = refused(text.as_bytes(), &options()).to_string();
        assert!(error.contains("is stated, and"), "{error}");
        let file = RecordFile::read(text.as_bytes(), &TextOptions { lenient: true, ..options() }).expect("lenient");
        assert!(file.warnings.iter().any(|warning| warning.contains("is stated, and")), "{:?}", file.warnings);
    }
    // A peak in another unit, in the line of the unit.
    let peak = peer.replacen(series, "ACCELERATION TIME SERIES IN G; PGA IN CM/S2 = 293", 1);
    let file = RecordFile::read(peak.as_bytes(), &options()).expect("g");
    assert_eq!(file.accel, read("peer/RSN9001_HOLLOW_MIL090.AT2", &options()).accel);
}

#[test]
fn a_file_that_ends_within_a_number_gives_the_numbers_before_it_where_that_is_allowed() {
    let text = text("peer/RSN9001_HOLLOW_MIL090.AT2");
    let cut = &text[..text.rfind("E-").expect("the last sample") + 2];
    assert!(matches!(refused(cut.as_bytes(), &options()), RecordError::Fewer { line: 4, declared: 42, found: 41, .. }));
    // Without its exponent the last number is another one.
    let other = &text[..text.rfind("E-").expect("the last sample")];
    assert_eq!(refused(other.as_bytes(), &options()), refused(cut.as_bytes(), &options()));
    let file = RecordFile::read(cut.as_bytes(), &TextOptions { lenient: true, ..options() }).expect("lenient");
    assert_eq!(file.accel.len(), 41);
    assert!(file.warnings.iter().any(|warning| warning.contains("line 13, is cut off")), "{:?}", file.warnings);
}

#[test]
fn the_duration_of_a_knet_header_is_no_count_of_samples() {
    let name = "knet/XXX0010103040506.EW";
    let plain = read(name, &options());
    assert!(plain.warnings.is_empty() && plain.declared.is_none(), "{:?}", plain.warnings);
    for duration in ["0", "1", "60", "300", "0.40"] {
        let other = text(name).replace("Duration Time(s)  0.42", &format!("Duration Time(s)  {duration}"));
        let file = RecordFile::read(other.as_bytes(), &options()).expect("nominal");
        assert_eq!(file.accel, plain.accel, "{duration}");
        let says_so = |warning: &String| warning.contains("42 samples at 0.01 s are 0.420000 s, and line 12 says");
        assert!(file.warnings.iter().any(says_so), "{duration}: {:?}", file.warnings);
    }
    let silent = text(name).replace("Duration Time(s)  0.42", "Duration Time(s)  ");
    assert_eq!(RecordFile::read(silent.as_bytes(), &options()), Ok(plain));
    // A file that is too short and ends within a number is cut off.
    let whole = text(name);
    let cut = &whole[..whole.trim_end().len() - 2];
    assert!(matches!(
        refused(cut.as_bytes(), &options()),
        RecordError::Fewer { line: 12, declared: 42, found: 41, .. }
    ));
    let lenient = RecordFile::read(cut.as_bytes(), &TextOptions { lenient: true, ..options() }).expect("lenient");
    assert_eq!(lenient.accel.len(), 41);
}

#[test]
fn a_unit_whose_place_is_counted_from_one_is_found_by_the_line_before_the_samples() {
    let cm = read("cosmos/cm.V2", &options());
    for integers in ["       2       4    -999", "       2       4       2"] {
        let text = text("cosmos/cm.V2").replace("       2       1       4", integers);
        let file = RecordFile::read(text.as_bytes(), &options()).expect("a unit of acceleration");
        assert_eq!(file.accel, cm.accel, "{integers}");
        assert!(file.warnings.iter().any(|warning| warning.contains("value 1 (from 0)")), "{:?}", file.warnings);
    }
    // A quantity of another code there is no unit that the line contradicts.
    let other = text("cosmos/cm.V2").replace("       2       1       4", "       2       2    -999");
    assert_eq!(RecordFile::read(other.as_bytes(), &options()).expect("the line says it").accel, cm.accel);
}

#[test]
fn the_unit_of_a_cosmos_file_is_that_of_its_integer_header() {
    let cm = read("cosmos/cm.V2", &options());
    for (code, size) in [(2, 9.81), (4, 0.01), (7, 0.0254), (10, 0.01), (11, 9.81e-3), (12, 9.81e-6)] {
        let text = text("cosmos/cm.V2").replace("       2       1       4", &format!("       2       1{code:8}"));
        // A unit that contradicts the line before the samples is an error.
        let strict = RecordFile::read(text.as_bytes(), &options());
        assert_eq!(strict.is_ok(), size == 0.01, "{code}: {strict:?}");
        let lenient = TextOptions { lenient: true, ..options() };
        let file = RecordFile::read(text.as_bytes(), &lenient).expect("a unit of acceleration");
        assert!((file.accel[13] / cm.accel[13] * 0.01 / size - 1.0).abs() < 1e-12, "{code}");
        let has_warning = file.warnings.iter().any(|warning| warning.contains("integer header"));
        assert_eq!(has_warning, size != 0.01, "{code}: {:?}", file.warnings);
    }
    // Where the header is silent, the line before the samples says it.
    let silent = text("cosmos/cm.V2").replace("       2       1       4", "       2       1    -999");
    assert_eq!(RecordFile::read(silent.as_bytes(), &options()).expect("the line says it").accel, cm.accel);
    let mute = silent.replace("units=cm/sec2 (04),", "");
    assert!(matches!(refused(mute.as_bytes(), &options()), RecordError::Missing { key: "units", .. }));
}

#[test]
fn line_ends_marks_and_blank_lines_change_nothing() {
    for (name, options, ..) in cases() {
        let plain = read(name, &options);
        let unix = text(name).replace("\r\n", "\n");
        for (what, other) in [
            ("LF", unix.clone()),
            ("CRLF", unix.replace('\n', "\r\n")),
            ("CR", unix.trim_end().replace('\n', "\r")),
            ("blank lines at the end", format!("{unix}\n  \n\n")),
            ("no line end at the end", unix.trim_end().to_string()),
            ("Ctrl-Z", format!("{unix}\u{1a}")),
        ] {
            // Read as it is distributed: one byte a character.
            let latin: Vec<u8> = other.chars().map(|c| u8::try_from(u32::from(c)).expect("Latin-1")).collect();
            assert_eq!(RecordFile::read(&latin, &options), Ok(plain.clone()), "{name} with {what}");
            let marked = [b"\xef\xbb\xbf", other.as_bytes()].concat();
            assert_eq!(RecordFile::read(&marked, &options), Ok(plain.clone()), "{name} with {what} and a mark");
        }
    }
}

#[test]
fn what_is_not_a_finite_number_is_named_with_line_and_column() {
    for (name, sample, line, column) in [
        ("peer/RSN9001_HOLLOW_MIL090.AT2", ".1513094E+00", 6, 64),
        ("dyna/XX.MIB..HNE.D.64.ASC", "148.434530", 74, 1),
        ("knet/XXX0010103040506.EW", "212771", 19, 13),
        ("csmip/one-channel.v2", "148.43453", 48, 12),
        ("cosmos/cm.V2", "148.43453", 50, 12),
        ("table/three-columns.csv", "148.43453\n", 11, 17),
    ] {
        let text = text(name);
        assert!(text.contains(sample), "{name}");
        for word in ["nan", "inf", "1e999", "********", "0x1f"] {
            let broken = text.replacen(
                sample,
                &format!("{word:>0$}{1}", sample.trim().len(), &sample[sample.trim().len()..]),
                1,
            );
            let error = refused(broken.as_bytes(), &TextOptions { column: Some("3".into()), ..options() });
            let column = column + sample.trim().len().saturating_sub(word.len());
            let expected = RecordError::NotANumber { line, column, text: word.into() };
            assert_eq!(error, expected, "{name}");
        }
    }
}

#[test]
fn headers_vary() {
    let unix = |name: &str| text(name).replace("\r\n", "\n");
    let same = |name: &str, from: &str, to: &str| {
        let text = unix(name);
        assert!(text.contains(from), "{name}: {from}");
        let plain = RecordFile::read(text.as_bytes(), &options()).expect("it reads");
        let other = RecordFile::read(text.replace(from, to).as_bytes(), &options());
        let other = other.unwrap_or_else(|error| panic!("{name}: {to}: {error}"));
        assert_eq!((other.format, other.dt, other.accel), (plain.format, plain.dt, plain.accel), "{name}: {to}");
    };
    let at2 = "peer/RSN9001_HOLLOW_MIL090.AT2";
    for header in [
        "NPTS=42 DT=.01",
        "NPTS = 42 , DT = .01",
        "NPTS=42,DT=.01SEC",
        "npts= 42, dt= 1.0E-02 sec",
        "DT= .0100 SEC, NPTS= 42",
        "  42 0.01 NPTS, DT, FILTER 3",
        "  42    0.0100    NPTS, DT",
        "0.0100   42   DT, NPTS",
        "NPTS: 42 DT: 0.01",
        "NPTS, DT: 42 .01",
        "NPTS, DT = 42, .01 SEC",
    ] {
        same(at2, "NPTS=    42, DT=   .0100 SEC,", header);
    }
    for unit in [
        "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz",
        "ACCELERATION TIME HISTORY IN G",
        "Acceleration (g)",
        "Acceleration time series, units: [g]",
        "units = g",
        "ACCELERATION (NO UNIT)",
        "",
    ] {
        same(at2, "ACCELERATION TIME SERIES IN UNITS OF G", unit);
    }
    same(at2, "SEC,\n", "SEC,\nremarks below the header\n\n");
    let dyna = "dyna/XX.MIB..HNE.D.64.ASC";
    for (from, to) in [
        ("UNITS: cm/s^2", "UNITS:"),
        ("UNITS: cm/s^2", "Units : CM/S^2"),
        ("UNITS: cm/s^2", "UNITS: cm/s2"),
        ("HEADER_FORMAT: DYNA 1.2\n", ""),
        ("LOCATION:\n", "LOCATION: 00\nDATE: 2001-03-04 05:06:07\nUSER6: 1 2 3\n\n"),
        ("PGA_CM/S^2: -239.335550", "PGA_CM/S^2: 239.3"),
        ("PGA_CM/S^2: -239.335550", "PGA_CM/S^2:"),
        ("DATA_TYPE: ACCELERATION\n", ""),
        ("HEADER_FORMAT: DYNA 1.2\nDATA_TYPE: ACCELERATION\n", ""),
        ("SAMPLING_INTERVAL_S: 0.010000", "SAMPLING_INTERVAL_S:1.0D-02"),
    ] {
        same(dyna, from, to);
    }
    let knet = "knet/XXX0010103040506.EW";
    for (from, to) in [
        ("Sampling Freq(Hz) 100Hz", "Sampling Freq(Hz) 100"),
        ("Sampling Freq(Hz) 100Hz", "Sampling Freq(Hz)\t100Hz"),
        ("Scale Factor      3920(gal)/6182761", "Scale Factor  3920(gal)/6182761"),
        ("Scale Factor      3920(gal)/6182761", "Scale Factor      3920 (gal) / 6182761"),
        ("Scale Factor      3920(gal)/6182761", "Scale Factor      3920gal/6182761"),
        ("Scale Factor      3920(gal)/6182761", "Scale Factor      3920/6182761"),
        ("Max. Acc. (gal)", "Max. Acc.(gal) "),
        ("Memo.\n", "Memo.             a remark\n"),
        ("Memo.\n", "Memo.             a remark\nof two lines\n"),
        ("Memo.\n", ""),
        ("Dir.              E-W", "Dir.  E-W"),
    ] {
        same(knet, from, to);
    }
    let csmip = "csmip/one-channel.v2";
    for (from, to) in [
        ("in cm/sec2. (8f10.5)", "in cm/sec2."),
        ("in cm/sec2. (8f10.5)", "in cm/sec2. 8F10.5"),
        ("in cm/sec2. (8f10.5)", "in cm/sec/sec. (8F10.5)"),
        ("spaced at  .010 sec", "spaced at 0.010 sec"),
        ("spaced at  .010 sec,", "spaced,"),
        ("CHAN  1: 90 DEG\n", "CHAN  1: 90 DEG\nONE MORE LINE\n"),
        ("/&  ---", "---"),
    ] {
        same(csmip, from, to);
    }
    let cosmos = "cosmos/cm.V2";
    for (from, to) in [
        ("with 13 text lines", "with 14 text lines"),
        ("No filtering\n", "No filtering\none more line\n"),
        ("units=cm/sec2 (04)", "units=cm/s/s"),
        ("       2       1       4", "       2       1    -999"),
        ("units=cm/sec2 (04)", "units=cm/sec2(04)"),
        ("units=cm/sec2 (04)", "units= (04)"),
        ("Format=(8F10.5)", "Format= (8F10.5)"),
        (" 100 Real-header values follow on  17 lines", " 100 Real-header values follow on  20 lines"),
        ("   4 Comment lines follow", "   4 Comment line(s) follow"),
        ("acceleration pts, approx   0 secs", "accel points"),
    ] {
        same(cosmos, from, to);
    }
}

#[test]
fn velocities_and_displacements_of_at2_headers_are_refused_and_units_converted() {
    let text = text("peer/RSN9001_HOLLOW_MIL090.AT2");
    let with = |line: &str| text.replace("ACCELERATION TIME SERIES IN UNITS OF G", line);
    for line in
        ["VELOCITY TIME HISTORY IN UNITS OF CM/SEC", "DISPLACEMENT TIME SERIES IN UNITS OF CM", "Velocity (cm/s)"]
    {
        let error = refused(with(line).as_bytes(), &options()).to_string();
        assert!(error.starts_with("line 3: this is no acceleration"), "{line}: {error}");
    }
    let error = refused(with("ACCELERATION TIME SERIES IN UNITS OF FURLONGS").as_bytes(), &options()).to_string();
    assert!(error.starts_with("line 3: `FURLONGS`") && error.contains("convert"), "{error}");
    let g = RecordFile::read(text.as_bytes(), &options()).expect("in g");
    for (line, size) in [
        ("ACCELERATION TIME SERIES IN UNITS OF CM/S**2", 0.01),
        ("ACCELERATION TIME HISTORY IN M/S/S", 1.0),
        ("ACCELERATION (IN/S/S)", 0.0254),
        ("ACCELERATION TIME SERIES IN UNITS OF MM/SEC2", 0.001),
    ] {
        let other = RecordFile::read(with(line).as_bytes(), &options()).expect("known");
        assert!((other.accel[13] / g.accel[13] * 9.81 / size - 1.0).abs() < 1e-12, "{line}");
    }
    let much = RecordFile::read(text.replace("E+00", "E+03").as_bytes(), &options()).expect("read");
    assert!(much.warnings[0].contains("hardly"), "{:?}", much.warnings);
}

#[test]
fn a_sampling_interval_that_is_not_where_it_belongs_is_found_by_the_duration() {
    let text = text("cosmos/cm.V2").replace("approx   0 secs", "approx  42 secs");
    // 42 samples in 42 s: the interval is 1000 ms. It stands one place early, and 0.42 at its own.
    let (own, early) = ("  -999.000000    10.000000     0.420000", "  1000.000000     0.420000     0.420000");
    assert!(text.contains(own));
    let shifted = RecordFile::read(text.replace(own, early).as_bytes(), &options());
    let shifted = shifted.expect("an interval");
    assert_eq!(shifted.dt, 1.0, "{:?}", shifted.warnings);
    assert!(shifted.warnings[0].contains("value 60"), "{:?}", shifted.warnings);
}

/// The first headers of ITACA have a component in place of the stream, and the first sample on the day of the event.
#[test]
fn the_first_headers_of_itaca_name_component_and_first_sample() {
    let whole = text("dyna/itaca-43.DAT");
    let date = "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS: 20010304_050610.120";
    let first = whole
        .replace(date, "TIME_FIRST_SAMPLE_S: 050610.120")
        .replace("STREAM: HNE", "COMPONENT: UP")
        .replace("PGA_CM/S^2: -239.335550", "DATA_TYPE: PROCESSED ACCELERATION");
    let [whole, first] = [whole, first].map(|text| RecordFile::read(text.as_bytes(), &options()).expect("it is read"));
    assert_eq!((whole.component.as_str(), first.component.as_str()), ("HNE", "UP"));
    assert!(first.first_sample.is_some() && first.first_sample == whole.first_sample);
    assert_eq!((first.accel, first.dt), (whole.accel, whole.dt));
}

/// Without the interval at its place, that of the recorder is taken, with a warning: in ms, or in s.
#[test]
fn the_interval_of_the_recorder_is_in_milliseconds_or_in_seconds() {
    let whole = text("cosmos/cm.V2")
        .replace("  -999.000000    10.000000     0.420000", "  -999.000000  -999.000000     0.420000");
    for interval in ["    10.000000", "     0.010000"] {
        let text = whole.replace("     5.000000", interval);
        let file = RecordFile::read(text.as_bytes(), &options()).expect("it is read");
        assert_eq!((file.dt, file.accel.len()), (0.01, 42), "{interval}");
        assert!(file.warnings[0].contains("is value 33 (from 0) of the real header"), "{:?}", file.warnings);
    }
}

#[test]
fn the_peak_of_a_header_is_checked() {
    let text = text("dyna/XX.MIB..HNE.D.64.ASC").replace("PGA_CM/S^2: -239.335550", "PGA_CM/S^2: 23.9");
    let error = refused(text.as_bytes(), &options());
    assert!(matches!(error, RecordError::Peak { line: 39, stated, .. } if (stated - 0.239).abs() < 1e-12), "{error}");
    let file = RecordFile::read(text.as_bytes(), &TextOptions { lenient: true, ..options() }).expect("lenient");
    assert!(file.warnings[0].contains("line 39"), "{:?}", file.warnings);
}

/// -0.01 stands for magnitudes up to 0.015. Beyond, the peak may differ by a hundredth: 0.0152 exceeds 0.015 by 1.3 % of itself.
#[test]
fn a_stated_peak_is_as_exact_as_it_is_printed() {
    let file = |peak: &str| {
        let header = "SAMPLING_INTERVAL_S: 0.01\nNDATA: 3\nUNITS: cm/s^2\nPGA_CM/S^2: -0.01";
        RecordFile::read(format!("{header}\n0.0\n{peak}\n0.0\n").as_bytes(), &options())
    };
    assert_eq!(file("-0.0148").expect("rounded").warnings, [""; 0]);
    assert!(matches!(file("-0.0152"), Err(RecordError::Peak { line: 4, .. })));
}

#[test]
fn the_user_may_repeat_what_a_file_says_but_not_contradict_it() {
    for (name, own, ..) in cases() {
        let file = read(name, &own);
        let repeated = TextOptions { dt: Some(file.dt), units: Some(file.unit), ..own.clone() };
        assert_eq!(RecordFile::read(&bytes(name), &repeated), Ok(file.clone()), "{name}");
        if own.dt.is_none() {
            let error = refused(&bytes(name), &TextOptions { dt: Some(0.02), ..own.clone() });
            assert!(matches!(error, RecordError::Contradiction { key: "dt", .. }), "{name}: {error}");
        }
        if own.units.is_none() {
            let other = TextOptions { units: AccelerationUnit::parse("ft/s2"), ..own };
            let error = refused(&bytes(name), &other);
            assert!(matches!(error, RecordError::Contradiction { key: "units", .. }), "{name}: {error}");
        }
    }
}

/// Some files begin with their sampling interval: it was a sample without a word.
#[test]
fn an_interval_above_the_samples_has_a_warning() {
    let given = TextOptions { units: Some(AccelerationUnit::G), dt: Some(0.01), ..options() };
    let warnings = |text: &str, skip_rows: usize| {
        let file = RecordFile::read(text.as_bytes(), &TextOptions { skip_rows, ..given.clone() }).expect("readable");
        (file.accel.len(), file.warnings.iter().any(|warning| warning.contains("line 1: the first number is `dt`")))
    };
    assert_eq!(warnings("0.01\n0.1\n-0.2\n0.0\n", 0), (4, true));
    assert_eq!(warnings("0.01\n0.1\n-0.2\n0.0\n", 1), (3, false));
    assert_eq!(warnings("0.02\n0.1\n-0.2\n0.0\n", 0), (4, false));
}

#[test]
fn tables_are_refused_where_they_leave_a_choice_or_are_uneven() {
    let g = TextOptions { units: Some(AccelerationUnit::G), ..options() };
    let error = |text: &str, options: &TextOptions| refused(text.as_bytes(), options).to_string();
    let several = error(&text("table/three-columns.csv"), &options());
    assert!(several.contains("choose one of h1, up with `column`"), "{several}");
    let none = TextOptions { column: Some("acc".into()), ..options() };
    let motions = error("time [s],velocity [m/s],displacement [m]\n0.0,0.1,0.0\n0.1,0.2,0.0\n0.2,0.1,0.0\n", &none);
    assert!(motions.contains("there is no column `acc`; choose one of time, velocity, displacement"), "{motions}");
    let spectrum = error("time [s],Sa [g]\n0.0,0.1\n0.1,0.2\n0.2,0.1\n", &options());
    assert!(spectrum.contains("column `Sa` is no acceleration of the ground"), "{spectrum}");
    let absent = TextOptions { column: Some("h3".into()), ..options() };
    assert!(error(&text("table/three-columns.csv"), &absent).contains("no column `h3`"));
    let twice = error("t, a, a\n0, 1, 2\n0.1, 2, 3\n", &TextOptions { column: Some("a".into()), ..g.clone() });
    assert!(twice.contains("several columns are called `a`") && twice.contains("`column`: 2 or 3"), "{twice}");
    let title = error(&text("table/skip-rows.txt"), &g);
    assert!(title.contains("skip_rows") && title.contains("line 1, column 1: `Invented`"), "{title}");
    for (text, part) in [
        ("0 1\n0.1 1\n0.25 1\n0.3 1\n", "line 3: time 0.25 s comes 0.15 s after the one above, most come 0.1 s"),
        ("0 1\n0.1 1\n0.1 1\n", "line 3"),
        ("0 1\n0.1 1\n0.2 1\n0.4 1\n0.5 1\n", "line 4: time 0.4 s comes 0.2 s after the one above"),
        ("0 1\n0.1 1\n0.2 1\n0.2 1\n0.3 1\n", "line 4: time 0.2 s comes 0 s after the one above"),
        ("0.3 1\n0.2 1\n0.1 1\n", "line 2: time 0.2 s"),
        ("0 1\n0.1\n", "line 2: 1 column(s) where the first row has 2"),
        ("0, 1\n0.1, , 2\n", "line 2, column 5"),
        ("1 2 3\n4 5 6\n", "choose one of 1 to 3 with `column`"),
        ("0.1\n0.2\n", "sampling interval"),
        ("", "the file is empty"),
        (" \n# nothing\n", "the file is empty"),
        ("# nothing\n0 1\n", "1 sample(s)"),
        (
            "# a remark\n0.1 0.2 0.3 0.2\n",
            "line 2: 4 numbers are in the only row, and a row is one sample; if they are samples, give `column` as all",
        ),
        ("t [s], v [m/s]\n0, 1\n0.1, 2\n", "`m/s` of column `v`"),
        ("time (frames), a [g]\n0, 1\n1, 2\n", "line 1: `frames` of column `time` is no unit of time"),
        ("t, a, b\n0, 1\n0.1, 2\n", "line 1: 3 name(s) above 2 column(s)"),
        ("t, a\n0.2, 0\n0.1, 1\n0, 2\n", "line 3: time 0.1 s is not above the one of the row before; sort the rows"),
        ("2011-03-11 0.1\n2011-03-12 0.2\n", "line 1, column 1: `2011-03-11`"),
        ("PK\u{3}\u{4}\u{0}", "a ZIP archive or a spreadsheet; unpack it, or save it as text or CSV"),
        ("1\n2\u{0}\u{0}\n3\n", "the file is no text"),
    ] {
        let error = error(text, &g);
        assert!(error.contains(part), "{text}: {error}");
    }
    assert_eq!(
        refused(b"0.1\n0.2\n", &TextOptions { dt: Some(0.1), ..options() }),
        RecordError::Missing { quantity: "unit", key: "units" }
    );
    // Each component beside its own times.
    let two = "Time1 (s),NS (g),Time2 (s),EW (g)\n0,0,0,0\n0.01,1,0.02,1\n0.02,2,0.04,2\n";
    for (column, dt) in [("NS", 0.01), ("EW", 0.02)] {
        let chosen = TextOptions { column: Some(column.into()), ..options() };
        assert_eq!(RecordFile::read(two.as_bytes(), &chosen).expect("a table").dt, dt, "{column}");
    }
    // Times of three decimals at 256 Hz are off by up to half a thousandth, an eighth of the interval; at 100 Hz they are exact.
    let times = |rate: f64| (0..200).map(|k| format!("{:.3} 1\n", f64::from(k) / rate)).collect::<String>();
    assert!(matches!(refused(times(256.0).as_bytes(), &g), RecordError::Uneven { .. }));
    assert_eq!(RecordFile::read(times(100.0).as_bytes(), &g).expect("even").accel.len(), 200);
    // With the interval, rounded times are read; not with another interval, nor with a row missing.
    let with = |dt: f64| TextOptions { dt: Some(dt), ..g.clone() };
    assert_eq!(RecordFile::read(times(256.0).as_bytes(), &with(1.0 / 256.0)).expect("rounded").dt, 1.0 / 256.0);
    assert!(matches!(refused(times(256.0).as_bytes(), &with(1.0 / 250.0)), RecordError::Contradiction { .. }));
    let gap: String =
        times(256.0).lines().enumerate().filter(|(row, _)| *row != 100).map(|(_, line)| format!("{line}\n")).collect();
    let error = refused(gap.as_bytes(), &with(1.0 / 256.0)).to_string();
    assert!(
        error.starts_with("line 101: time 0.395 s is 1.12 intervals") && error.contains("fill in what is missing"),
        "{error}"
    );

    // Times of two decimals at 250 Hz stand in pairs. The last one may be exact, and the interval that they give is then right.
    for rows in [500, 501] {
        let text: String = (0..rows).map(|row| format!("{:.2} 1\n", 0.004 * f64::from(row))).collect();
        let error = refused(text.as_bytes(), &with(0.004)).to_string();
        assert!(error.contains("leave them out with `lenient`"), "{rows}: {error}");
        let lenient = TextOptions { lenient: true, ..with(0.004) };
        let file = RecordFile::read(text.as_bytes(), &lenient).expect("the interval is given");
        assert!(
            file.dt == 0.004 && file.warnings.iter().any(|warning| warning.contains("times are left out")),
            "{rows}"
        );
    }
}

/// Names and values above one column, in any order: what they say of interval and unit counts, and none is a heading.
#[test]
fn names_and_values_above_a_column_are_its_header() {
    let numbers = "0.0\n10.0\n-20.0\n";
    for header in [
        "Station: XYZ\nEvent: Somewhere\nDT: 0.01\nUnits: cm/s^2\n",
        "Units = cm/s2\nDT = 0.01\nStation: XYZ\n",
        "Station: XYZ\nUnit: cm/s/s\nDT: 0.01 s\n",
        "The Northridge earthquake\nStation: XYZ\nDT: 0.01\nUnits: cm/s^2\n",
        "Station: XYZ\nDT: 0.01\nUnits: cm/s^2\nAcceleration\n",
    ] {
        let file = RecordFile::read(format!("{header}{numbers}").as_bytes(), &options());
        let file = file.unwrap_or_else(|error| panic!("{header}: {error}"));
        assert_eq!((file.accel, file.dt), (vec![0.0, 0.1, -0.2], 0.01), "{header}");
    }
    // Two values are no pair of a name and a value.
    let error = refused(format!("DT: 0.01\nUnits: cm/s2; EW\n{numbers}").as_bytes(), &options()).to_string();
    assert!(error.contains("2 name(s) above 1 column(s)"), "{error}");
}

#[test]
fn tables_are_read_as_spreadsheets_and_scripts_write_them() {
    let column = |column: &str| TextOptions { column: Some(column.into()), ..options() };
    for (text, options) in [
        ("t [s];a [m/s2]\n0,00;1,0\n0,01;-2,5\n0,02;0,0\n", options()),
        ("t [s] a [m/s2]\n0,00 1,0\n0,01 -2,5\n0,02 0,0\n", options()),
        ("\"t [s]\";\"a [m/s2]\"\n\"0,00\";\"1,0\"\n\"0,01\";\"-2,5\"\n\"0,02\";\"0,0\"\n", options()),
        ("\"t [s]\",\"a [m/s2]\"\n\"0.00\",\"1.0\"\n\"0.01\",\"-2.5\"\n\"0.02\",\"0.0\"\n", options()),
        ("Accelerogram of a station\n\nt [s], a [m/s2]\n0, 1\n.01, -2.5D0\n.02, 0\n", options()),
        ("// t, a\nt, a\n[s], [m/s2]\n0, 1,\n.01, -2.5,\n.02, 0,\n", options()),
        ("Uhrzeit [s]; h1 [g]; up [m/s2]\n0; 7; 1\n.01; 8; -2.5\n.02; 9; 0\n", column("up [m/s2]")),
    ] {
        let file = RecordFile::read(text.as_bytes(), &options).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!((file.accel, file.dt), (vec![1.0, -2.5, 0.0], 0.01), "{text}");
    }
    let minutes = RecordFile::read(b"time (min), a [m/s2]\n0, 1\n0.5, 2\n", &options()).expect("minutes");
    assert_eq!(minutes.dt, 30.0);
    // Other columns than times are none, whatever they count.
    for head in [",a [m/s2]", "n,a [m/s2]", "velocity (cm/s),a [m/s2]"] {
        let text = format!("{head}\n0,1\n1,2\n2,3\n");
        assert!(matches!(refused(text.as_bytes(), &options()), RecordError::Missing { key: "dt", .. }), "{head}");
        let with = TextOptions { dt: Some(0.02), ..options() };
        assert_eq!(RecordFile::read(text.as_bytes(), &with).expect("with an interval").dt, 0.02, "{head}");
    }
    let late = RecordFile::read(b"t [s], a [m/s2]\n5, 1\n5.01, 2\n", &options()).expect("late");
    assert!(late.warnings.iter().any(|warning| warning.contains("times begin at 5 s")), "{:?}", late.warnings);
    // Numbers of rows are no times where a column of times follows them, and another component is none either.
    let units = |name: &str| TextOptions { units: Some(AccelerationUnit::MetrePerSecondSquared), ..column(name) };
    for text in ["1 0.00 1\n2 0.01 -2.5\n3 0.02 0\n", "0.00 5 1\n0.01 -1 -2.5\n0.02 3 0\n"] {
        let file = RecordFile::read(text.as_bytes(), &units("3")).expect("a time and a column");
        assert_eq!((file.accel, file.dt), (vec![1.0, -2.5, 0.0], 0.01), "{text}");
    }
}

#[test]
fn numpy_headings_in_remarks_are_read() {
    let text = "# t [s]  a [m/s^2]\n0.000e+00 1.000e+00\n1.000e-02 -2.000e+00\n2.000e-02 0.000e+00\n";
    let file = RecordFile::read(text.as_bytes(), &options()).expect("named");
    assert_eq!((file.accel, file.dt), (vec![1.0, -2.0, 0.0], 0.01));
}

#[test]
fn exponents_of_three_digits_need_no_letter() {
    let text = "A\nB\nACCELERATION IN UNITS OF G\nNPTS= 5, DT= .01\n  0.1234-105 -0.1E-02-0.2E-02\n.5D-1 -.25+001\n";
    let file = RecordFile::read(text.as_bytes(), &TextOptions { gravity: 1.0, ..options() }).expect("five");
    assert_eq!(file.accel, [0.1234e-105, -0.001, -0.002, 0.05, -2.5]);
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_record_beside_the_project_has_the_peak_of_its_readme() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/records");
    let readme = std::fs::read_to_string(folder.join("README.md")).expect("readable");
    let mut count = 0;
    // | file | event | dt (s) | samples | units | PGA (g) | peak at |
    for row in readme.lines().filter(|line| line.starts_with('|')) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [name, _, dt, samples, units, peak, peak_time] = cells.as_slice() else { continue };
        let (Ok(peak), Ok(dt), Ok(samples)) = (peak.parse::<f64>(), dt.parse::<f64>(), samples.parse::<usize>()) else {
            continue;
        };
        let units = units.contains("columns").then_some(AccelerationUnit::G);
        let bytes = std::fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let record = Record::from_bytes(&bytes, &TextOptions { units, ..options() });
        let record = record.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((record.accel().len(), record.warnings()), (samples, &[][..]), "{name}");
        assert!((record.dt() - dt).abs() < 1e-12, "{name}: {}", record.dt());
        let measures = record.measures(9.81);
        assert!((measures.pga / 9.81 - peak).abs() < 5e-5, "{name}: {}", measures.pga / 9.81);
        let time: f64 = peak_time.trim_end_matches('s').trim().parse().expect("a time");
        assert!((measures.pga_time - time).abs() < 1e-9, "{name}: {}", measures.pga_time);
        count += 1;
    }
    assert_eq!(count, 6, "the table of {}", folder.display());
}

#[test]
fn a_record_remembers_its_origin_where_a_run_is_described() {
    let record = read("dyna/XX.MIB..HNE.D.64.ASC", &options()).into_record().expect("valid");
    let record = record.named("XX.MIB..HNE.D.64.ASC").scaled(2.0).expect("finite");
    let motion = rocking_ground::Motion::Record(record);
    let json = serde_json::to_value(motion.description()).expect("described");
    assert_eq!(json["kind"], "record");
    assert_eq!((&json["samples"], &json["scale"], &json["component"]), (&42.into(), &2.0.into(), &"HNE".into()));
    assert_eq!((&json["file"], &json["station"]), (&"XX.MIB..HNE.D.64.ASC".into(), &"XX.MIB (MILL_BRIDGE)".into()));
    assert!((json["peak"].as_f64().expect("a number") - 4.786_711).abs() < 1e-9);
    assert!(json.get("accel").is_none());
    let whole = serde_json::to_value(&motion).expect("serialised");
    assert_eq!(serde_json::from_value::<rocking_ground::Motion>(whole).expect("a motion"), motion);
}

proptest! {
    // A failing case is printed with what it takes to repeat it; no file of regressions is kept.
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_written_record_reads_back_to_the_last_bit(
        accel in prop::collection::vec(prop_oneof![-1e12..1e12, -1.0..1.0, prop::num::f64::ZERO | prop::num::f64::SUBNORMAL], 2..200),
        dt in 1e-6..10.0_f64,
    ) {
        let record = Record::new(accel, dt, 0.0).expect("valid");
        let back = Record::from_text(&record.to_csv(), options()).expect("readable");
        prop_assert_eq!(back.dt().to_bits(), record.dt().to_bits());
        let bits = |record: &Record| record.accel().iter().map(|a| a.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&back), bits(&record));
    }
}
