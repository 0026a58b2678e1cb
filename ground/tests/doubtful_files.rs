//! A file that is not surely what it seems is refused with a remedy, and what is plausible but odd is read with a warning.

use rocking_ground::{AccelerationUnit, Format, RecordFile, TextOptions};
use std::fmt::Write as _;

const G: f64 = 9.81;

fn options() -> TextOptions {
    TextOptions::default()
}

fn in_g() -> TextOptions {
    TextOptions { units: Some(AccelerationUnit::G), ..options() }
}

fn read(text: &str, options: &TextOptions) -> RecordFile {
    RecordFile::read(text.as_bytes(), options).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn refused(text: &str, options: &TextOptions) -> String {
    RecordFile::read(text.as_bytes(), options).expect_err(text).to_string()
}

/// Twenty samples between -0.3 and 0.3.
fn samples() -> Vec<f64> {
    (0..20).map(|k| (0.3 * (0.9 * f64::from(k)).sin() * 1e4).round() / 1e4).collect()
}

/// A header, and a row for each sample: its number and its value.
fn table(header: &str, row: impl Fn(usize, f64) -> String) -> String {
    let rows = samples().into_iter().enumerate().map(|(k, a)| row(k, a) + "\n");
    format!("{header}\n{}", rows.collect::<String>())
}

fn seconds(k: usize, a: f64) -> String {
    format!("{:.2},{a}", k as f64 / 100.0)
}

fn value(_: usize, a: f64) -> String {
    a.to_string()
}

fn agrees(file: &RecordFile, size: f64, dt: f64) -> bool {
    let near = |found: f64, expected: f64| (found - expected).abs() < 1e-12;
    file.accel.len() == 20
        && near(file.dt, dt)
        && file.accel.iter().zip(samples()).all(|(found, a)| near(*found, a * size))
}

#[test]
fn spectra_are_no_ground_motion() {
    for header in [
        "Period (s),Sa (g)",
        "Period [sec],Acceleration [g]",
        "T (s),PSa (m/s2)",
        "T,Sa",
        "Sa,T",
        "Periodo [s],PSA [g]",
        "Frequency (Hz),PSA (g)",
        "freq (Hz),a [m/s2]",
        "T,Spectral acceleration (g)",
        "# Period(s),Sa(g)",
    ] {
        for options in [options(), in_g(), TextOptions { column: Some("2".into()), ..in_g() }] {
            let error = refused(&table(header, seconds), &options);
            assert!(error.starts_with("line 1: column") && error.contains("spectrum"), "{header}: {error}");
        }
    }
    // Beside a history, a spectrum is left alone.
    let both = table("Time (s),Acc (g),Period (s),Sa (g)", |k, a| format!("{},1,2", seconds(k, a)));
    assert!(agrees(&read(&both, &options()), G, 0.01));
}

#[test]
fn a_line_with_the_number_of_samples_stands_above_tables_too() {
    for (header, size) in [
        ("# RSN1, NPTS= 20, DT= 0.0100 SEC\nTime (s),Acc (g)", G),
        ("Northridge Rinaldi 228\nNPTS=20, DT=0.01\nTime(s),Acc(m/s2)", 1.0),
        ("# NPTS=20 DT=0.01\n# units m/s2", 1.0),
    ] {
        let file = read(&table(header, seconds), &options());
        assert!(file.format == Format::Table && agrees(&file, size, 0.01), "{header}: {file:?}");
        assert_eq!(file.warnings, [""; 0], "{header}");
    }
    for (header, size) in [
        ("# NPTS=20 DT=0.01\nacc (cm/s2)", 0.01),
        ("# NPTS=20 DT=0.01\n# units m/s2", 1.0),
        ("# Acceleration in m/s2\n# NPTS=20 DT=0.01", 1.0),
        ("# acc [m/s^2]\n# NPTS=20 DT=10 ms", 1.0),
        ("# m/s^2\n# NPTS=20 DT=0.01", 1.0),
        ("Station X\nNPTS=20 DT=0.01 UNITS=M/S2", 1.0),
        ("Station X\nNPTS=20 DT=0.01 (cm/s/s)", 0.01),
    ] {
        let file = read(&table(header, value), &options());
        assert!(agrees(&file, size, 0.01), "{header}: {file:?}");
        assert_eq!(file.warnings, [""; 0], "{header}");
    }
    let silent = read(&table("Station X\nNPTS=20 DT=0.01", value), &options());
    assert!(agrees(&silent, G, 0.01) && silent.warnings[0].contains("states no unit: g is taken"), "{silent:?}");
    assert_eq!(read(&table("Station X\nNPTS=20 DT=0.01", value), &in_g()).warnings, [""; 0]);
}

#[test]
fn an_at2_header_declares_one_column_of_accelerations() {
    let header = "PEER\nA, B, C, 228\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 20, DT= .01 SEC";
    assert_eq!(read(&table(header, value), &options()).format, Format::PeerAt2);
    for columns in [2, 3] {
        let error = refused(&table(header, |_, a| format!("{a} ").repeat(columns)), &options());
        let counts = format!("line 4: the header declares 20 samples and the file has {} numbers", 20 * columns);
        assert!(error.starts_with(&counts) && error.contains("columns beside"), "{error}");
    }
    for line in ["VELOC. TIME SERIES", "PSEUDO-VELOCITY", "TIME HISTORY OF VELOCITY", "DISPL. TIME SERIES IN G"] {
        let error = refused(&table(&header.replace("ACCELERATION TIME SERIES IN UNITS OF G", line), value), &options());
        assert!(error.starts_with("line 3: this is no acceleration"), "{line}: {error}");
    }
    let with = |dt: &str| table(&header.replace(".01 SEC", dt), value);
    assert!(agrees(&read(&with("10 MSEC"), &options()), G, 0.01));
    assert!(refused(&with("1/100 SEC"), &options()).starts_with("line 4: no sampling interval"));
}

#[test]
fn times_have_units_and_numbers_of_rows_are_none() {
    let step = |size: usize| move |k: usize, a: f64| format!("{},{a}", k * size);
    for (header, size) in [
        ("time_ms,acc (g)", 10),
        ("Time ms,Acc [g]", 10),
        ("time_ms,acc_g", 10),
        ("# Time_ms,Acc (g)", 10),
        ("Time_us,acc (g)", 10_000),
        ("Time (µs),acc (g)", 10_000),
    ] {
        let file = read(&table(header, step(size)), &options());
        assert!(agrees(&file, G, 0.01), "{header}: {file:?}");
        assert_eq!(file.warnings, [""; 0], "{header}");
    }
    for header in ["timestep,acc (g)", "Time step,Acc (g)", "timestamp,acc (g)", "Time Index,acc (g)"] {
        let error = refused(&table(header, step(1)), &options());
        assert!(error.contains("sampling interval; give it with `dt`"), "{header}: {error}");
    }
    for header in ["Time Index,Time (s),acc (g)", "Timestep,Time,acc [g]", "Sample #,Time (s),Acc (g)"] {
        let file = read(&table(header, |k, a| format!("{k},{}", seconds(k, a))), &options());
        assert!(agrees(&file, G, 0.01), "{header}: {file:?}");
    }
    // Without names, whole numbers may be seconds, unless `dt` says that they are none.
    let whole = table("", step(1));
    let warned = read(&whole, &in_g());
    assert!(warned.dt == 1.0 && warned.warnings[0].contains("1 s is hardly one"), "{warned:?}");
    assert!(agrees(&read(&whole, &TextOptions { dt: Some(0.01), ..in_g() }), G, 0.01));
    for share in ["IN PERCENT OF G", "(% OF G)", "IN % G "] {
        let text = format!("A\nB\nACCELERATION TIME HISTORY {share}\nNPTS= 20, DT= .01");
        assert!(refused(&table(&text, value), &options()).contains("a share of a unit"), "{share}");
    }
    let tapered = "A\nB\nACCELERATION TIME SERIES, 5% COSINE TAPER, IN UNITS OF G\nNPTS= 20, DT= .01";
    assert!(agrees(&read(&table(tapered, |_, a| format!("{a}")), &options()), G, 0.01));
    for factor in [" / 10", " X 1000", "/10", " * 100", " *9.81"] {
        let text = format!("A\nB\nACCELERATION IN UNITS OF G{factor}\nNPTS= 20, DT= .01");
        let error = refused(&table(&text, value), &options());
        assert!(error.starts_with("line 3: ") && error.contains("unit"), "{factor}: {error}");
    }
    let at2 = read(&table("A\nB\nACCELERATION IN UNITS OF G\nNPTS= 20, DT= 1.", value), &options());
    assert!(at2.warnings[0].contains("1 s is hardly one"), "{at2:?}");
}

#[test]
fn two_columns_need_a_time_or_a_choice() {
    let both = |_: usize, a: f64| format!("{a},{}", -a);
    let given = TextOptions { dt: Some(0.01), ..in_g() };
    for (header, known) in [("NS,EW", "NS, EW"), ("H1,V", "H1, V"), ("acc_x,acc_y", "acc_x, acc_y"), ("", "1 to 2")] {
        let text = table(header, both);
        let error = refused(&text, &given);
        assert!(error.contains(&format!("choose one of {known} with `column`")), "{header}: {error}");
        assert!(agrees(&read(&text, &TextOptions { column: Some("2".into()), ..given.clone() }), -G, 0.01));
    }
    for header in
        ["vel,disp", "Time,Velocity", "Time,Displacement", "Time,Force", "Time,Velocity (g)", "% time velocity"]
    {
        let error = refused(&table(header, seconds), &in_g());
        assert!(error.starts_with("line 1: column") && error.contains("no acceleration"), "{header}: {error}");
    }
    for header in ["# time(sec) N-S(cm/s)", "Time (s),Acc (%g)"] {
        assert!(refused(&table(header, seconds), &options()).contains("no unit of acceleration"), "{header}");
    }
}

#[test]
fn a_row_of_units_gives_the_units_of_the_names_above() {
    for (header, size) in [("Time,Acc\ns,g", G), ("Time,Acc\n[s],[m/s2]", 1.0), ("Time Acc\n(ms) (g)", G)] {
        let row = |k: usize, a: f64| if header.contains("ms") { format!("{} {a}", 10 * k) } else { seconds(k, a) };
        let file = read(&table(header, row), &options());
        assert!(agrees(&file, size, 0.01) && file.component == "Acc", "{header}: {file:?}");
    }
    let three = table("t;a;v\ns;m/s2;m/s", |k, a| format!("{};{a};{a}", k as f64 / 100.0));
    assert!(agrees(&read(&three, &options()), 1.0, 0.01));
    let error =
        refused(&table("Time,Acc\ns,g", seconds), &TextOptions { units: AccelerationUnit::parse("gal"), ..options() });
    assert!(error.contains("line 2 of the file says g"), "{error}");
}

#[test]
fn a_count_above_the_samples_is_no_sample() {
    let given = TextOptions { dt: Some(0.01), ..in_g() };
    for header in ["20", "20\n0.01", "20 0.01"] {
        let text = table(header, value);
        let error = refused(&text, &given);
        assert!(error.starts_with("line 1: 20 is the number of the rows") && error.contains("`skip_rows`"), "{error}");
        let skip_rows = header.lines().count();
        assert!(agrees(&read(&text, &TextOptions { skip_rows, ..given.clone() }), G, 0.01), "{header}");
    }
}

#[test]
fn what_is_hardly_an_acceleration_has_a_warning() {
    for missing in [-999.0, -9999.0, -99999.0] {
        let gap = |k: usize, a: f64| seconds(k, if k == 7 { missing } else { a });
        let file = read(&table("time (s),a (mm/s2)", gap), &options());
        let warning = format!("sample 8, at 0.070000 s, is {missing}, which often");
        assert!(file.warnings.len() == 1 && file.warnings[0].starts_with(&warning), "{file:?}");
    }
    let large = read(&table("time (s),a (g)", |k, a| seconds(k, 100.0 * a)), &options());
    assert!(large.warnings[0].contains("g is hardly one; are the samples in another unit than g?"), "{large:?}");
}

/// 120 samples with a peak of 1 m/s²; of fewer than 100 the last one is not looked at.
#[test]
fn a_record_that_ends_while_the_ground_shakes_has_a_warning() {
    let ending = |count: usize, last: f64| {
        let value = |k: usize| if k == 5 { 1.0 } else { f64::from(u8::from(k + 1 == count)) * last };
        let rows: String = (0..count).map(|k| seconds(k, value(k)) + "\n").collect();
        read(&format!("time (s),a (m/s2)\n{rows}"), &options()).warnings
    };
    for last in [0.5, -0.5] {
        let warnings = ending(120, last);
        assert!(warnings.len() == 1 && warnings[0].starts_with("the last sample is 50 % of the peak"), "{warnings:?}");
    }
    assert_eq!(ending(120, -0.09), [""; 0]);
    assert_eq!(ending(90, -0.5), [""; 0]);
}

/// Rows of so many samples; the last row may be shorter.
fn wrapped(columns: usize) -> String {
    let row = |row: &[f64]| row.iter().map(|sample| format!(" {sample:8.4}")).collect::<String>() + "\n";
    samples().chunks(columns).map(row).collect()
}

/// A row of times, and one of samples.
fn transposed() -> String {
    let row = |value: &dyn Fn(usize) -> f64| (0..20).map(|k| format!(" {:.4}", value(k))).collect::<String>() + "\n";
    row(&|k| 0.01 * k as f64) + &row(&|k| samples()[k])
}

/// Times and samples in turns, all in one row.
fn pairs() -> String {
    (0..20).map(|k| format!(" {:.2} {:.4}", 0.01 * k as f64, samples()[k])).collect::<String>() + "\n"
}

/// Components side by side have no names above them: they are read, with a warning.
#[test]
fn rows_of_two_or_three_samples_have_a_warning() {
    let all = TextOptions { column: Some("all".into()), dt: Some(0.01), ..in_g() };
    let file = read(&wrapped(3), &all);
    assert!(
        file.warnings[0].starts_with("the 3 numbers of each row are read as samples one after another"),
        "{file:?}"
    );
    assert_eq!(read(&wrapped(4), &all).warnings, [""; 0]);
}

#[test]
fn numbers_above_the_samples_and_parts_of_a_file_do_not_pass_unseen() {
    let plain = TextOptions { dt: Some(0.01), ..in_g() };
    let rows: String = samples().iter().map(|sample| format!("{sample}\n")).collect();
    for (head, part) in [
        ("100\n20\n", "line 2: 20 is the number of the rows below it"),
        ("21\n", "line 1: 21 is the number of the rows below it"),
    ] {
        let error = refused(&format!("{head}{rows}"), &plain);
        assert!(error.starts_with(part), "{error}");
    }
    let many = |head: &str| format!("{head}\n{}", rows.repeat(5));
    for between in ["", "# E-W"] {
        let file = read(&format!("{}{}", many("# N-S"), many(between)), &plain);
        let expected =
            "the numbers are in 2 parts, the second of which begins in line 103; they are read as one record";
        assert!(
            file.accel.len() == 200 && file.warnings.iter().any(|warning| warning == expected),
            "{:?}",
            file.warnings
        );
    }
    let whole = read(&many("# acceleration"), &plain).warnings;
    assert!(!whole.iter().any(|warning| warning.contains("parts") || warning.contains("another motion")), "{whole:?}");
    let velocity = read(&many("% VELOCITY TIME HISTORY"), &plain).warnings;
    assert!(velocity[0].starts_with("line 1 names another motion than an acceleration"), "{velocity:?}");
}

/// The interval is right, and the file does not say another one.
#[test]
fn a_gap_is_named_where_the_interval_is_given() {
    let text: String = (0..300).filter(|k| !(100..150).contains(k)).map(|k| seconds(k, 0.1) + "\n").collect();
    let given = TextOptions { dt: Some(0.01), ..in_g() };
    for options in [&given, &in_g()] {
        let error = refused(&text, options);
        assert!(error.starts_with("line 101: ") && error.contains("1.5"), "{error}");
    }
}

/// What looks like a component, a direction, a date or a remark is no factor, no spectrum and no other quantity.
#[test]
fn usual_headers_are_read_without_a_warning() {
    for name in
        ["X1 (g)", "Acc 17/01/1994 (g)", "Acc 1/2 (g)", "SE (g)", "Acc SE (g)", "NS (g) disp. corrected", "a in g"]
    {
        let file = read(&table(&format!("Time (s),{name}"), seconds), &options());
        assert!(agrees(&file, G, 0.01) && file.warnings.is_empty(), "{name}: {:?}", file.warnings);
    }
    let given = TextOptions { dt: Some(0.01), ..options() };
    for remark in [
        "Sampling frequency: 100 Hz\n# units: g",
        "Return period 475 years, units: g",
        "Memphis, TN, acceleration (g)",
        "velocity is filtered (g)",
        "acceleration in g, X direction",
        "acc (g) 18/05/1940",
        "Acceleration in units of gravity (g)",
    ] {
        let file = read(&table(&format!("# {remark}"), |_, a| format!("{a}")), &given);
        assert!(agrees(&file, G, 0.01) && file.warnings.is_empty(), "{remark}: {:?}", file.warnings);
    }
    // A title of as many words as there are columns, and samples that begin with a ramp.
    let all = TextOptions { column: Some("all".into()), dt: Some(0.01), ..in_g() };
    assert!(agrees(&read(&format!("El Centro\n{}", wrapped(2)), &all), G, 0.01));
    let ramp = (0..24).map(|k| format!(" {}{}", 0.1 * f64::from(k), if k % 8 == 7 { "\n" } else { "" }));
    assert_eq!(read(&ramp.collect::<String>(), &all).accel.len(), 24);
    // Thousands that are decimals after all.
    let decimals = "time (s);acc (m/s2)\n0;-998\n1;1.013\n2;250\n";
    assert!(refused(decimals, &options()).contains("`lenient`"));
    let file = read(decimals, &TextOptions { lenient: true, ..options() });
    assert!(file.accel[1] == 1.013 && file.warnings[0].contains("`1.013` may be 1.013 or 1013"), "{file:?}");
    // Text behind the unit belongs to the name.
    let named = |column: &str| TextOptions { column: Some(column.into()), ..options() };
    let both = table("Time (s),Acc (g) EW,Acc (g) NS", |k, a| format!("{},{a}", seconds(k, 0.0)));
    assert!(agrees(&read(&both, &named("Acc NS")), G, 0.01));
    assert!(refused(&both, &options()).contains("Acc EW, Acc NS"));
    assert!(agrees(&read(&table("(s) Time,(g) Acc", seconds), &named("Acc")), G, 0.01));
}

/// A row of numbers with a damaged one is not passed over for headings below it.
#[test]
fn rows_above_a_heading_are_not_lost() {
    let second = table("Time (s),a (g)", seconds);
    let error = refused(&format!("Kobe 1995\n0.00,0.1\n0.01,x.2\n{second}"), &options());
    assert!(error.starts_with("line "), "{error}");
    assert!(
        refused("\"\"\n\"\"\n", &TextOptions { column: Some("all".into()), dt: Some(0.01), ..in_g() }).contains("no")
    );
}

/// Times from Excel with signs of thousands, a title with a number above names, factors of units, and spectra.
#[test]
fn tables_that_spreadsheets_and_reports_hold() {
    for rows in ["990\t\"-998\"\n995\t\"-1,013\"\n", "990;-998\n995;1,013\n", "990;-998\n995;1.013\n"] {
        let error = refused(
            &format!("Time (ms);Acc (mm/s2)\n{rows}").replacen(';', if rows.contains('\t') { "\t" } else { ";" }, 1),
            &options(),
        );
        assert!(
            error.contains("1.013 or ") && error.contains("1013; write the numbers without signs of thousands"),
            "{error}"
        );
    }
    let titled = table("Kobe, January 16, 1995\nTime [s] Accel [g]", |k, a| seconds(k, a).replace(',', " "));
    assert!(agrees(&read(&titled, &options()), G, 0.01));
    for unit in ["% of g", "10^-2 m/s2", "g / 10", "m/s2 x 100"] {
        let error = refused(&table(&format!("# acceleration in {unit}\ntime (s),a"), seconds), &options());
        assert!(error.contains("unit"), "{unit}: {error}");
    }
    for name in ["Acc [g]*10", "Acc x10 (m/s2)", "100*Acc (m/s2)"] {
        let error = refused(&table(&format!("time (s),{name}"), seconds), &options());
        assert!(error.contains("is no unit of acceleration"), "{name}: {error}");
    }
    for names in [
        "T (s),Se (g)",
        "T [s],Se(T) [g]",
        "T (s),S_e(T) (m/s2)",
        "T (s),se (g)",
        "T (s),Se NS (g)",
        "T [s],Spettro [g]",
        "f (Hz),Acc (m/s2)",
    ] {
        let error = refused(&table(names, seconds), &options());
        assert!(error.contains("is one of a spectrum"), "{names}: {error}");
    }
    for name in ["Acceleration (E-W) (g)", "a(t) [g]", "a/g"] {
        assert!(agrees(&read(&table(&format!("t/s,{name}"), seconds), &options()), G, 0.01), "{name}");
    }
}

#[test]
fn samples_that_fill_row_after_row_are_read_as_all_columns() {
    let all = TextOptions { column: Some("all".into()), dt: Some(0.01), ..in_g() };
    for columns in [1, 2, 5, 8, 20] {
        if columns > 1 {
            let error = refused(&wrapped(columns), &TextOptions { column: None, ..all.clone() });
            assert!(error.contains("samples") && error.contains("give `column` as all"), "{error}");
        }
        assert!(agrees(&read(&wrapped(columns), &all), G, 0.01), "{columns}");
        // Interval and unit may stand above the samples, and names of columns are none.
        let header = format!("#20 points at equal spacing\nEl Centro\nDT= 0.01, UNITS=g\nvalues\n{}", wrapped(columns));
        let named = TextOptions { column: Some("ALL".into()), ..options() };
        assert!(agrees(&read(&header, &named), G, 0.01), "{columns}");
    }
    assert!(agrees(&read(&format!("A\nB\nIN UNITS OF G\nNPTS= 20, DT= .01\n{}", wrapped(8)), &options()), G, 0.01));
    // Commas may be decimal points, in the last number too.
    let single: String = (0..20).map(|k| format!("0,{}\n", 1000 + 37 * k)).collect();
    assert!(refused(&single, &all).starts_with("line 1, column 1: `0,1000` has a decimal comma"));
    for columns in [2, 3, 8, 19] {
        let text = wrapped(columns).replace('.', ",");
        assert!(agrees(&read(&text, &all), G, 0.01), "{columns}");
    }
    // A row that is too short within the file is damaged; times and a count are no samples.
    for (text, part) in [
        (
            wrapped(8).replacen(" 0.2381", "", 1),
            "line 2: 7 number(s) where the first row has 8; only the last row may be",
        ),
        (format!("20\n{}", wrapped(1)), "line 1: 20 is the number of the samples that follow"),
        (
            table("", |k, a| format!("{a} {:.2}", 0.01 * (k + 2 * usize::from(k > 4)) as f64)),
            "line 2: the numbers of column 2 never",
        ),
        (format!("20 0.01\n{}", wrapped(2)), "line 1: 20 is the number of the samples that follow"),
        (
            table("time (s), acc (g)", seconds),
            "line 2: the numbers of column 1 never fall: they are times and no samples",
        ),
        (table("", seconds), "line 2: the numbers of column 1 never fall: they are times and no samples"),
        (table("acc (g), vel (m/s)", |_, a| format!("{a},{a}")), "line 1: column `vel` is no acceleration"),
        (
            table("N-S E-W U-D", |_, a| format!("{a} {a} {a}")),
            "line 1: each of the 3 columns is a component (N-S, E-W, U-D)",
        ),
        (transposed(), "line 1: the numbers of the first row rise in equal steps: they are times and no samples"),
        (pairs(), "line 1: half of the numbers of the first row rise in equal steps"),
    ] {
        let error = refused(&text, &all);
        assert!(error.starts_with(part), "{error}");
    }
    // A column of that name is one column.
    let column = read(&table("time (s),all (g)", seconds), &TextOptions { column: Some("all".into()), ..options() });
    assert!(agrees(&column, G, 0.01));
    // One of many numbers a row, though possible, is likely a mistake; one of three components is not.
    let warned = |columns: usize| {
        let whole: String =
            wrapped(columns).lines().filter(|row| row.len() == 9 * columns).fold(String::new(), |mut text, row| {
                let _ = writeln!(text, "{row}");
                text
            });
        read(&whole, &TextOptions { column: Some("1".into()), ..all.clone() }).warnings
    };
    assert_eq!(warned(3), [""; 0]);
    let text = "number 1 of the 5 in each row is read; if samples fill row after row, give `column` as all";
    assert_eq!(warned(5), [text]);
}

/// A line with the sampling interval is a header though it has a number. Other numbers above the samples may be damaged rows, or belong to names.
#[test]
fn headers_may_state_the_interval() {
    for header in [
        "DT= 0.01",
        "DT=0.01",
        "Acc in g, DT=0.01",
        "dt = 0.01 s, units g",
        "Acceleration [g]\nDT= 0.01",
        "El Centro\nDT= 0.01 SEC\nNS",
        "SAMPLING INTERVAL (sec): 0.01",
        "Sampling period = 10 ms",
        "Sampling rate: 100 Hz",
        "Sampling Freq(Hz)  100Hz",
        "20 values, 100 samples per second\nAcceleration in g",
        "Acceleration in g at equally spaced intervals of 0.01 sec",
    ] {
        for header in [header.to_string(), format!("# {}", header.replace('\n', "\n# "))] {
            assert!(agrees(&read(&table(&header, value), &in_g()), G, 0.01), "{header}");
        }
    }
    let named = table("time (ms), acc (cm/s2)\nDT= 0.01", |k, a| format!("{},{a}", 10 * k));
    assert!(agrees(&read(&named, &options()), 0.01, 0.01));
    for header in ["time (s), vel (m/s)\nDT= 0.01", "Period (s), Sa (g)\nDT= 0.01"] {
        assert!(refused(&table(header, seconds), &in_g()).starts_with("line 1: column"), "{header}");
    }
    for first in [
        "Period (s), Sa (g), damping 5%",
        "time (s), vel (m/s)\nDamping 0.05",
        "Velocity 2 in cm/s",
        "NA 0.0",
        "O.12E-3 0.5",
        "DT= -0.01",
        "Period (s), Sa (g), dt = 0.02",
        "velocity in m/s, DT= 0.01",
        "vel (cm/s) DT=0.01",
    ] {
        let error = refused(&table(first, seconds), &in_g());
        assert!(error.contains("is no number, and the file begins like none"), "{first}: {error}");
    }
}

/// A remark that speaks of a conversion, a factor, or the size of something else states no unit of the samples; the unit is then given.
#[test]
fn remarks_on_conversions_state_no_unit() {
    for remark in [
        "# converted from cm/s2 to g",
        "# Acceleration in cm/s2 converted to g",
        "# to convert to m/s2 multiply by 9.81",
        "# multiply by 9.81 to get m/s2",
        "# acceleration m/s2 -> g",
        "# gravity (m/s2): 9.81",
        "# resolution [mg]: 0.1",
        "# noise floor in mg",
        "# PGA (cm/s2): 343.35",
        "# unit of file: see header (cm/s2 or g)",
        "# acceleration in m/s2 (multiply by 0.01)",
        "# scale factor 0.01 units cm/s2",
        "# in m/s2 [x100]",
    ] {
        let text = table(&format!("{remark}\n# DT= 0.01"), value);
        assert!(refused(&text, &options()).contains("unit"), "{remark}");
        assert!(agrees(&read(&text, &in_g()), G, 0.01), "{remark}");
    }
    // A factor on a line of its own is not applied, which a warning says.
    let factor = read(&table("# scale factor: 0.001\n# units: g\n# DT= 0.01", value), &options());
    assert!(agrees(&factor, G, 0.01));
    assert_eq!(factor.warnings, ["line 1 states the factor 0.001; the samples are taken as they are"]);
    // Words of that kind in another part of the line say nothing of the unit, nor does a factor of something else.
    for remark in [
        "# units: g, factor of safety none",
        "# factory units: g",
        "# Acceleration (g), noise removed",
        "# Acceleration in g; quality factor Q=100",
        "# acceleration in multiples of g",
        "# Amplification factor, record 12, in g",
    ] {
        let plain = read(&table(&format!("{remark}\n# DT= 0.01"), value), &options());
        assert!(agrees(&plain, G, 0.01) && plain.warnings.is_empty(), "{remark}: {:?}", plain.warnings);
    }
    // A doubtful unit is not taken, and still contradicts another one that is given.
    let told = read(&table("# converted from cm/s2\n# DT= 0.01", value), &in_g()).warnings;
    assert!(told[0].contains("line 1 states the unit cm/s²"), "{told:?}");
    let lenient = TextOptions { lenient: true, ..options() };
    assert!(agrees(&read(&table("# converted to m/s2\n# DT= 0.01", value), &lenient), 1.0, 0.01));
    assert!(agrees(
        &read(&table("PEER\nX\nCORRECTED RECORD IN CM/S2, NOISE FILTERED\nNPTS= 20, DT= 0.01 SEC", value), &options()),
        0.01,
        0.01
    ));
}

/// A name of a component below the line with the count makes no table of an AT2 file: a cut one is refused.
#[test]
fn an_at2_file_with_a_component_is_no_table() {
    let text = table("PEER\nX\nACCELERATION IN M/S2\nNPTS= 4000, DT= 0.01 SEC\nNS", value);
    assert!(refused(&text, &options()).contains("declares 4000 samples and the file has 20"));
}

/// Samples that were taken at another rate than those of the file say nothing of it; an interval and a rate that differ are refused.
#[test]
fn rates_and_intervals_agree() {
    let text = table("# original sampling rate: 200 Hz\n# sampling rate: 100 Hz", value);
    assert!(agrees(&read(&text, &in_g()), G, 0.01));
    let text = table("# sampling interval: 0.01 s\n# sampling rate: 200 Hz", value);
    assert!(refused(&text, &in_g()).contains("a sampling interval of 0.005 s is stated, and one of 0.01 s in line 1"));
    // Neither a number of steps nor a rate below one a second.
    for remark in ["# time step number 5", "# sampling rate: 0.01", "# fs 100", "# confidence interval of 0.95"] {
        assert!(refused(&table(remark, value), &in_g()).contains("no recognised sampling interval"), "{remark}");
    }
}

/// Two intervals in one line are as doubtful as in two; a rate is no interval.
#[test]
fn a_line_with_two_intervals_is_refused() {
    let text = table("# original dt = 0.005, resampled to dt = 0.01", value);
    assert!(refused(&text, &in_g()).contains("a sampling interval of 0.01 s is stated, and one of 0.005 s in line 1"));
    let given = TextOptions { dt: Some(0.01), ..in_g() };
    assert!(agrees(&read(&text, &given), G, 0.01));
    assert!(refused(&table("# dt = 100 Hz", value), &in_g()).contains("sampling interval"));
}

/// Lines with numbers above the names of components are a header; above one column an acceleration with its unit is one name.
#[test]
fn components_and_whole_lines_are_names() {
    let text = table("Depth (km) : 19.44\nN-S  E-W  U-D", |k, a| format!("{a} {} {k}", 2.0 * a));
    let column = |name: &str| TextOptions { column: Some(name.into()), dt: Some(0.01), ..in_g() };
    let (first, third) = (read(&text, &column("N-S")), read(&text, &column("U-D")));
    assert_eq!((first.component.as_str(), third.component.as_str()), ("N-S", "U-D"));
    assert!(first.accel.len() == third.accel.len() && first.accel != third.accel);
    let given = TextOptions { dt: Some(0.01), ..options() };
    for name in [
        "Acceleration in g",
        "ACCELERATION TIME HISTORY IN UNITS OF G",
        "# Acceleration in g",
        "El Centro 1940\nAcceleration in g",
    ] {
        assert!(agrees(&read(&table(name, value), &given), G, 0.01), "{name}");
    }
    // No sure unit, or two.
    for name in [
        "Acceleration in m/s2 converted from g",
        "Acceleration in cm/s2 or g",
        "Acceleration noise floor in mg",
        "Acceleration time history in g, El Centro (m/s2)",
    ] {
        assert!(RecordFile::read(table(name, value).as_bytes(), &given).is_err(), "{name}");
    }
    // A statement is no name, and gives way to what is given; places are no components.
    let stated = read(&table("Acceleration: cm/s2", value), &TextOptions { dt: Some(0.01), ..in_g() });
    assert!(agrees(&stated, G, 0.01) && stated.warnings[0].contains("states the unit cm/s²"), "{:?}", stated.warnings);
    let places = table("Event 5\nX 1.23 0.45", |k, a| format!("{a} {} {k}", 2.0 * a));
    assert!(refused(&places, &column("1")).contains("is no number"));
}

/// A refused header names the line in which the numbers begin, unless a line above them may be a row.
#[test]
fn the_first_row_of_numbers_is_named() {
    let named = |text: &str| {
        let error = refused(text, &in_g());
        let skip = error.split_once("skip the ").filter(|(_, rest)| rest.contains("line(s) before the numbers"));
        skip.map(|(_, rest)| rest.split(' ').next().expect("a number").parse::<usize>().expect("a number"))
    };
    let long = "065JZC120103\n0120103153957 2012-01-03 BTM\nATUSHI EARTHQUAKE\n\n# remark";
    assert_eq!(named(&table(long, value)), Some(5));
    assert_eq!(named(&format!("STATION 0911\none two three\n{}", wrapped(3))), Some(2));
    assert_eq!(named(&format!("065JZC 3\n{}1 2 3\n{}", wrapped(4), wrapped(4))), None);
    assert_eq!(named(&table("MAGNITUDE 6.5", |_, a| format!("{a};{a}").replace('.', ","))), None);
    for first in ["nan", "inf", "****"] {
        assert_eq!(named(&table(first, value)), None, "{first}");
        assert!(refused(&table(first, value), &in_g()).contains("; mend it, or skip the lines before"), "{first}");
    }
    let backslashes: String = samples().iter().fold(String::new(), |text, sample| text + &format!("{sample}\\\n"));
    assert_eq!(named(&backslashes), None);
}

/// Times of two decimals every 0.005 s: without `dt` there is no interval, with it the times contradict it by up to two of them, which is taken on request.
#[test]
fn times_with_too_few_digits_are_left_out_on_request() {
    let rounded = |k: usize, a: f64| format!("{:.2} {a}", (0.5 * k as f64).round() / 100.0);
    let cut = |k: usize, a: f64| format!("{:.2} {a}", (k / 2) as f64 / 100.0);
    for (row, without) in [
        (&rounded as &dyn Fn(usize, f64) -> String, "give `dt` if times are rounded"),
        (&cut, "give `dt` if times have too few digits"),
    ] {
        let text: String = samples().into_iter().enumerate().map(|(k, a)| row(k, a) + "\n").collect();
        assert!(refused(&text, &in_g()).ends_with(without));
        let given = TextOptions { dt: Some(0.005), ..in_g() };
        let error = refused(&text, &given);
        assert!(error.contains("the times have too few digits: leave them out with `lenient`"), "{error}");
        let file = read(&text, &TextOptions { lenient: true, ..given });
        assert!(agrees(&file, G, 0.005) && file.warnings.len() == 1, "{file:?}");
        assert!(
            file.warnings[0].contains("off its place; times are left out, and rows are taken every 0.005 s"),
            "{file:?}"
        );
    }
    // Two rows are missing: their times are right, and no option closes the gap.
    let gap = |k: usize, a: f64| format!("{:.2} {a}", 0.01 * (if k < 8 { k } else { k + 2 }) as f64);
    let text: String = samples().into_iter().enumerate().map(|(k, a)| gap(k, a) + "\n").collect();
    let error = refused(&text, &TextOptions { dt: Some(0.01), lenient: true, ..in_g() });
    assert!(error.ends_with("intervals of 0.01 s off its place; fill in what is missing above"), "{error}");
}

#[test]
fn text_that_contradicts_the_options_of_a_table_has_a_warning() {
    let text = table("# dt = 0.005 s, units cm/s2", value);
    assert!(agrees(&read(&text, &options()), 0.01, 0.005));
    let file = read(&text, &TextOptions { dt: Some(0.01), ..in_g() });
    assert!(agrees(&file, G, 0.01));
    assert!(file.warnings[0].contains("line 1 states the unit cm/s²"), "{file:?}");
    assert!(file.warnings[1].contains("line 1 states a sampling interval of 0.005 s"), "{file:?}");
    // The unit of a number is not that of the samples.
    assert!(refused(&table("# peak 350 cm/s2", value), &options()).contains("give it with `units`"));
}

#[test]
fn times_that_drift_are_read_if_dt_is_given() {
    // Summed in single precision: 5000 s have a resolution of half a millisecond.
    let mut t = 0.0f32;
    let rows: String = (0..40_000).fold("time (s),acc (g)\n".into(), |mut text, k| {
        let _ = writeln!(text, "{t},{}", f64::from(k % 7) * 0.01);
        t += 0.005;
        text
    });
    let error = refused(&rows, &options());
    assert!(error.contains("s off a constant interval of 0.005") && error.contains("give `dt`"), "{error}");
    assert_eq!(read(&rows, &TextOptions { dt: Some(0.005), ..options() }).dt, 0.005);
    let other = refused(&rows, &TextOptions { dt: Some(0.00501), ..options() });
    assert!(other.contains("`dt` is given as 0.00501 s"), "{other}");
}

/// Times with a mistake among them are refused with the right interval as well: a row that was moved, two that were swapped, a wrong time.
#[test]
fn times_out_of_order_are_refused_though_dt_is_given() {
    let given = TextOptions { dt: Some(0.01), ..options() };
    let rows: Vec<String> = (0..40).map(|k| format!("{:.2},{}", 0.01 * f64::from(k), f64::from(k % 7))).collect();
    let text = |rows: &[String]| format!("time (s),a (m/s2)\n{}\n", rows.join("\n"));
    assert_eq!(read(&text(&rows), &given).dt, 0.01);
    let (mut moved, mut swapped, mut wrong) = (rows.clone(), rows.clone(), rows);
    let row = moved.remove(5);
    moved.insert(17, row);
    swapped.swap(9, 10);
    wrong[12] = "5.00,5".into();
    for (rows, line) in [(moved, 7), (swapped, 11), (wrong, 14)] {
        let error = refused(&text(&rows), &given);
        assert!(error.starts_with(&format!("line {line}: time ")), "{error}");
    }
}

/// In all formats, and what is hardly a sampling interval.
#[test]
fn missing_samples_and_odd_intervals_have_a_warning_in_all_formats() {
    let at2 = |dt: f64| {
        let samples: String = (0..40).map(|k| format!(" {}\n", if k == 3 { -999.0 } else { 0.01 })).collect();
        format!("PEER NGA\nEVENT\nACCELERATION TIME SERIES IN UNITS OF CM/S/S\nNPTS= 40, DT= {dt} SEC\n{samples}")
    };
    let file = read(&at2(0.01), &options());
    assert!(file.warnings.iter().any(|warning| warning.starts_with("sample 4, at 0.030000 s, is -999")), "{file:?}");
    let file = read(&at2(1e-9), &options());
    assert!(file.warnings.iter().any(|warning| warning.contains("a sampling interval of 0.000000001 s")), "{file:?}");
}

#[test]
fn formats_without_a_reader_are_named() {
    let sac = format!(
        "   0.01  -857.0  857.0  1.0  -12345.0\n{}",
        "  -12345.0  -12345.0  -12345.0  -12345.0  -12345.0\n".repeat(13)
    );
    for (text, format) in [
        ("Corrected accelerogram 2016_WTMC_20 GNS Science\nSite WTMC\n", "GeoNet"),
        ("Uncorrected accelerogram 2016_WTMC_20 GNS Science\nSite WTMC\n", "GeoNet"),
        ("2 CORRECTED ACCELEROGRAM\n*\nSAF0A\n", "SMC"),
        (sac.as_str(), "SAC"),
    ] {
        let error = refused(text, &options());
        assert!(error.starts_with("the file is ") && error.contains(format), "{error}");
        assert!(error.contains("a format that is not read; give the record as a table"), "{error}");
    }
}

/// Files whose headers contradict themselves: name, a part of the header, and what it becomes.
const CONTRADICTIONS: [(&str, &str, &str, &str); 4] = [
    ("cosmos/cm.V2", "-239.335550", " -23.933555", "line 25 states a peak of 0.239336 m/s²"),
    (
        "cosmos/cm.V2",
        "       2       1       4",
        "       2       1       2",
        "line 14: the integer header gives the unit g",
    ),
    ("csmip/one-channel.v2", "in cm/sec2.", "in mm/sec2.", "line 15 states a peak of 2.39336"),
    (
        "csmip/one-channel.v2",
        "spaced at  .010 sec",
        "spaced at  .020 sec",
        "line 46: the sampling interval is 0.02 s here and 0.01 s",
    ),
];

/// 42 samples at an interval that is twice the true one: PGA and number of samples do not show it, the duration does.
#[test]
fn a_dyna_file_whose_samples_do_not_fill_its_duration_has_a_warning() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/records/dyna/XX.MIB..HNE.D.55.ASC");
    let text: String = std::fs::read(path).expect("a file").into_iter().map(char::from).collect();
    let told = |text: &str| {
        read(text, &options()).warnings.iter().any(|told| told.contains("says 0.41 s; is the file whole?"))
    };
    assert!(!told(&text));
    assert!(told(&text.replacen("SAMPLING_INTERVAL_S: 0.010000", "SAMPLING_INTERVAL_S: 0.020000", 1)));
}

#[test]
fn headers_that_contradict_themselves_are_refused_unless_lenient() {
    for (name, from, to, part) in CONTRADICTIONS {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/records").join(name);
        let text: String = std::fs::read(path).expect(name).into_iter().map(char::from).collect();
        assert!(text.contains(from), "{name}: {from}");
        let text = text.replacen(from, to, 1);
        let error = refused(&text, &options());
        assert!(error.contains(part) && error.contains("`lenient`"), "{name}: {error}");
        let file = read(&text, &TextOptions { lenient: true, ..options() });
        assert!(!file.warnings.is_empty(), "{name}");
    }
}

#[test]
fn a_table_that_ends_in_zero_bytes_was_not_written_to_its_end() {
    let whole = table("t [s],a [g]", seconds);
    let half = whole.len() / 2;
    for cut in [whole[..half].rfind('\n').expect("lines") + 1, half] {
        let padded = format!("{}{}", &whole[..cut], "\0".repeat(whole.len() - cut));
        let error = refused(&padded, &options());
        assert!(error.contains("zero bytes") && error.contains("line 1"), "{error}");
    }
    // Old programs end a file with Ctrl-Z.
    assert_eq!(read(&format!("{whole}\u{1a}"), &options()).accel.len(), 20);
}

#[test]
fn tables_that_contradict_themselves_are_refused_unless_lenient() {
    let lenient = TextOptions { lenient: true, ..options() };
    for (text, parts) in [
        (table("# units m/s2\nt [s],a [g]", seconds), ["column `a` is in g", "line 1 states m/s²"]),
        (table("# dt=0.01\n# units g\n# dt=0.02", value), ["0.02 s is stated", "0.01 s in line 1"]),
    ] {
        let error = refused(&text, &options());
        assert!(parts.iter().all(|part| error.contains(part)) && error.contains("`lenient`"), "{error}");
        let file = read(&text, &lenient);
        assert!((file.unit, file.dt) == (AccelerationUnit::G, 0.01), "{} {}", file.unit, file.dt);
        assert!(file.warnings.iter().any(|warning| warning.contains(parts[0])), "{:?}", file.warnings);
    }
    let error = refused(&table("t [s],a [g]\ns,cm/s2", seconds), &options());
    assert!(error.contains("`g and cm/s2` of column `a`"), "{error}");
    assert_eq!(read(&table("t [s],a [g]\nsec,g", seconds), &options()).unit, AccelerationUnit::G);
}

#[test]
fn one_column_with_decimal_commas_is_read() {
    let comma = |_: usize, a: f64| format!("{a:.5}").replace('.', ",");
    let expected: Vec<f64> = samples().iter().map(|a| a * G).collect();
    let close = |file: RecordFile| file.accel.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12);
    let with_dt = TextOptions { dt: Some(0.01), ..options() };
    assert!(close(read(&table("a [g]", comma), &with_dt)));
    let without_name = table("", comma).trim_start().to_string();
    assert!(close(read(&without_name, &TextOptions { dt: Some(0.01), ..in_g() })));
    // Two columns of whole numbers are no decimal fractions.
    let counts = table("", |k, _| format!("{k},{}", 10 + 7 * (k % 3)));
    assert_eq!(read(counts.trim_start(), &in_g()).dt, 1.0);
}

#[test]
fn a_record_of_zeros_has_a_warning() {
    let file = read(&table("t [s],a [g]", |k, _| seconds(k, 0.0)), &options());
    assert!(file.warnings.iter().any(|warning| warning.contains("all samples are zero")), "{:?}", file.warnings);
}

/// A comma in a remark makes no headings of it where the commas of the rows may be decimal ones: whole parts would be read as the record.
#[test]
fn decimal_commas_below_a_remark_are_no_second_column() {
    let rows: String =
        samples().iter().map(|a| format!("{}\n", format!("{:.1}", 10.0 * a).replace('.', ","))).collect();
    for remark in ["# acceleration in m/s2, dt = 0.005 s", "% acc [m/s2], acc [m/s2]", "# acceleration in m/s2"] {
        let told = refused(&format!("{remark}\n{rows}"), &options());
        assert!(told.contains("several columns that may be the acceleration"), "{told}");
    }
    // Times say that there are two columns.
    let pairs = table("# time [s], acceleration [m/s2]", |k, a| format!("{k},{}", (100.0 * a).round()));
    assert!((read(&pairs, &options()).dt - 1.0).abs() < 1e-12);
}

/// With semicolons or quotes around them cells are numbers, whichever their decimal sign: times with points, accelerations with commas.
#[test]
fn cells_may_have_decimal_signs_of_their_own() {
    let comma = |a: f64| format!("{a}").replace('.', ",");
    let semicolons = |k: usize, a: f64| format!("{:.2};{}", k as f64 / 100.0, comma(a));
    let quotes = |k: usize, a: f64| format!("{:.2},\"{}\"", k as f64 / 100.0, comma(a));
    let all_quoted = |k: usize, a: f64| format!("\"{:.2}\",\"{}\"", k as f64 / 100.0, comma(a));
    for header in ["time [s];acc [m/s2]", ""] {
        assert!(
            agrees(
                &read(
                    &table(header, semicolons),
                    &TextOptions { units: Some(AccelerationUnit::MetrePerSecondSquared), ..options() }
                ),
                1.0,
                0.01
            ),
            "{header}"
        );
    }
    let rows: [&dyn Fn(usize, f64) -> String; 2] = [&quotes, &all_quoted];
    for row in rows {
        assert!(agrees(&read(&table("time [s],acc [m/s2]", row), &options()), 1.0, 0.01));
    }
}

/// `1,048` may be a thousand and more: beside points, or in quotes, where nothing says that commas are decimal signs, such a file is refused.
#[test]
fn signs_of_thousands_are_no_decimal_commas() {
    let thousands = |k: usize| if k % 4 == 3 { format!("1,{:03}", 17 * k) } else { format!("{}", 900 + k) };
    let quoted = |k: usize| format!("\"{}\"", thousands(k));
    for separator in [";", "\t", ","] {
        let cell: &dyn Fn(usize) -> String = if separator == "," { &quoted } else { &thousands };
        let rows: String = (0..40).map(|k| format!("{:.2}{separator}{}\n", k as f64 / 100.0, cell(k))).collect();
        for header in ["", &format!("time [s]{separator}acc [cm/s2]\n")] {
            refused(&format!("{header}{rows}"), &options());
        }
    }
    // A single one that cannot be a thousand settles it.
    let rows: String = (0..40)
        .map(|k| format!("{:.2};{}\n", k as f64 / 100.0, if k == 7 { "-0,5".into() } else { thousands(k) }))
        .collect();
    let file = read(&format!("time [s];acc [cm/s2]\n{rows}"), &options());
    assert!((file.accel[7] + 0.005).abs() < 1e-12 && (file.accel[3] - 0.01051).abs() < 1e-12, "{:?}", &file.accel[..8]);
}
