//! Record files: PEER AT2 and plain text, told apart by what stands in them.

use super::record::{AccelerationUnit, RecordError, TextOptions};

/// A series read from text.
pub struct Series {
    /// `[m/s²]`
    pub accel: Vec<f64>,
    /// `[s]`
    pub dt: f64,
}

/// The line of an AT2 file with its count and interval is sought among the first ones only.
const HEADER_LINES: usize = 10;

/// A table's time column may be rounded to its last printed digit: a row may be off the grid by this share of `dt`.
const GRID_TOLERANCE: f64 = 0.05;

/// Reads a file of either kind.
pub fn read(text: &str, options: TextOptions) -> Result<Series, RecordError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines: Vec<&str> = text.lines().collect();
    match lines.iter().take(HEADER_LINES).position(|line| line.to_ascii_uppercase().contains("NPTS")) {
        Some(header) => peer(&lines, header, options),
        None => table(&lines, options),
    }
}

/// PEER AT2: title lines, the unit in the line above the header, `NPTS=  4000, DT= .01000 SEC` or `4096 0.0100 NPTS, DT`,
/// then the samples in rows.
fn peer(lines: &[&str], header: usize, options: TextOptions) -> Result<Series, RecordError> {
    let line = header + 1;
    let broken = |problem: &str| RecordError::Header {
        line,
        problem: format!("{problem} in `{}`", lines[header].trim()),
        remedy: "write it as `NPTS= 4000, DT= .01000 SEC` or `4000 .01000 NPTS, DT`",
    };
    let upper = lines[header].to_ascii_uppercase();
    let (count, dt) = if upper.contains('=') {
        (labelled(&upper, "NPTS"), labelled(&upper, "DT"))
    } else {
        let mut numbers = upper.split(separator).filter_map(number);
        (numbers.next(), numbers.next())
    };
    let count = count.ok_or_else(|| broken("no number of samples (NPTS)"))?;
    let dt = dt.ok_or_else(|| broken("no sampling interval (DT)"))?;
    if !(count >= 1.0 && count.fract() == 0.0) {
        return Err(broken("no whole number of samples"));
    }
    if dt.is_nan() || dt <= 0.0 {
        return Err(broken("no sampling interval above zero"));
    }
    if let Some(own) = options.dt.filter(|own| (own - dt).abs() > 1e-9 * dt) {
        let (scene, file) = (format!("{own}"), format!("{dt}"));
        return Err(RecordError::Contradiction { key: "dt", scene, line, file });
    }
    let declared = count as usize;

    let unit = unit_above(lines, header)?;
    let unit = match (unit, options.units) {
        (Some((line, unit)), Some(own)) if unit != own => {
            let (scene, file) = (format!("{own:?}"), format!("{unit:?}"));
            return Err(RecordError::Contradiction { key: "units", scene, line, file });
        }
        (Some((_, unit)), _) => unit,
        (None, own) => own.unwrap_or(AccelerationUnit::G),
    };
    let mut accel = Vec::with_capacity(declared.min(1 << 20));
    for (index, row) in lines.iter().enumerate().skip(header + 1) {
        for (value, _) in numbers(row, index + 1)? {
            accel.push(value * unit.in_si(options.gravity));
        }
    }
    if accel.len() < declared {
        return Err(RecordError::Fewer { line, declared, found: accel.len() });
    }
    accel.truncate(declared);
    Ok(Series { accel, dt })
}

/// The number after `KEY =`, with or without blanks; a unit may touch it (`.01SEC`).
fn labelled(upper: &str, key: &str) -> Option<f64> {
    let (_, rest) = upper.split_once(key)?;
    let rest = rest.trim_start().strip_prefix('=')?.trim_start();
    let word = rest.split(separator).next()?;
    number(word).or_else(|| number(word.trim_end_matches(|c: char| c.is_ascii_alphabetic())))
}

/// The unit named in the line above the header: `ACCELERATION TIME SERIES IN UNITS OF G`.
fn unit_above(lines: &[&str], header: usize) -> Result<Option<(usize, AccelerationUnit)>, RecordError> {
    let Some(index) = (0..header).rev().find(|index| !lines[*index].trim().is_empty()) else { return Ok(None) };
    let upper = lines[index].to_ascii_uppercase();
    if upper.contains("VELOCITY") || upper.contains("DISPLACEMENT") {
        return Err(RecordError::Header {
            line: index + 1,
            problem: format!("this is no acceleration: `{}`", lines[index].trim()),
            remedy: "use the acceleration file (.AT2) of the same record",
        });
    }
    let Some((_, unit)) = upper.split_once("UNITS OF") else { return Ok(None) };
    // Old headers go on after the unit: `UNITS OF G. FILTER POINTS: ...`.
    let name = unit.split([' ', ',', ';', ':']).find(|word| !word.is_empty()).unwrap_or("").trim_end_matches('.');
    let unit = match name.replace("**", "").replace('^', "").as_str() {
        "G" | "G'S" | "(G)" => AccelerationUnit::G,
        "CM/S2" | "CM/SEC2" | "CM/S/S" | "CM/SEC/SEC" | "GAL" => AccelerationUnit::CentimetrePerSecondSquared,
        "M/S2" | "M/SEC2" | "M/S/S" | "M/SEC/SEC" => AccelerationUnit::MetrePerSecondSquared,
        _ => {
            return Err(RecordError::Header {
                line: index + 1,
                problem: format!("the unit `{name}` is not known"),
                remedy: "convert the record to g, m/s/s or cm/s/s and name that unit",
            });
        }
    };
    Ok(Some((index + 1, unit)))
}

/// Plain text: one column of accelerations, or time and acceleration; `#` and `%` begin comments.
fn table(lines: &[&str], options: TextOptions) -> Result<Series, RecordError> {
    let mut rows: Vec<(usize, Vec<f64>)> = Vec::new();
    for (index, row) in lines.iter().enumerate() {
        let row = row.split(['#', '%']).next().unwrap_or("");
        let values: Vec<f64> = numbers(row, index + 1)?.into_iter().map(|(value, _)| value).collect();
        if values.is_empty() {
            continue;
        }
        let expected = rows.first().map_or(values.len().min(2), |(_, first)| first.len());
        if values.len() != expected {
            return Err(RecordError::Columns { line: index + 1, found: values.len(), expected });
        }
        rows.push((index + 1, values));
    }
    if rows.len() < 2 {
        return Err(RecordError::TooShort { count: rows.len() });
    }
    let unit = options.units.ok_or(RecordError::Missing { quantity: "unit", key: "units = \"g\"" })?;
    let dt = if rows[0].1.len() == 1 {
        options.dt.ok_or(RecordError::Missing { quantity: "sampling interval", key: "dt" })?
    } else {
        let first = rows[0].1[0];
        let last = &rows[rows.len() - 1];
        let dt = (last.1[0] - first) / (rows.len() - 1) as f64;
        if let Some(own) = options.dt.filter(|own| (own - dt).abs() > 1e-6 * dt.abs()) {
            let (scene, file) = (format!("{own}"), format!("{dt}"));
            return Err(RecordError::Contradiction { key: "dt", scene, line: last.0, file });
        }
        for (index, (line, row)) in rows.iter().enumerate() {
            if (row[0] - first - index as f64 * dt).abs() > GRID_TOLERANCE * dt.abs() {
                return Err(RecordError::Uneven { line: *line, time: row[0], dt });
            }
        }
        options.dt.unwrap_or(dt)
    };
    let accel = rows.iter().map(|(_, row)| row[row.len() - 1] * unit.in_si(options.gravity)).collect();
    Ok(Series { accel, dt })
}

fn separator(c: char) -> bool {
    c.is_whitespace() || c == ',' || c == ';'
}

/// The numbers of a row, each with its column.
fn numbers(row: &str, line: usize) -> Result<Vec<(f64, usize)>, RecordError> {
    let mut found = Vec::new();
    let mut rest = row;
    loop {
        rest = rest.trim_start_matches(separator);
        let word = rest.split(separator).next().unwrap_or("");
        if word.is_empty() {
            return Ok(found);
        }
        let column = row[..row.len() - rest.len()].chars().count() + 1;
        let value = number(word).ok_or_else(|| RecordError::NotANumber { line, column, text: word.to_string() })?;
        found.push((value, column));
        rest = &rest[word.len()..];
    }
}

/// A finite number as Fortran and others print it: `-.64E-02`, `1.5D+01`.
fn number(word: &str) -> Option<f64> {
    let plain = word.bytes().all(|b| b.is_ascii_digit() || b"+-.eEdD".contains(&b));
    let value: f64 = plain.then(|| word.replace(['d', 'D'], "e")).and_then(|word| word.parse().ok())?;
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::super::Record;
    use super::*;

    const EQUALS: &str = "OWN NUMBERS\nNOWHERE, 1/1/2000\nACCELERATION TIME SERIES IN UNITS OF G\n\
        NPTS=     7, DT=   .0200 SEC\n  .1000000E-01 -.2000000E-01   .3000000E+00  -.64E-02  0.\n  .5 -.25\n";

    fn plain(units: Option<AccelerationUnit>, dt: Option<f64>) -> TextOptions {
        TextOptions { dt, units, ..TextOptions::default() }
    }

    #[test]
    fn both_at2_headers_read_the_same() {
        let first = Record::from_text(EQUALS, TextOptions::default()).expect("valid");
        let counts = EQUALS.replace("NPTS=     7, DT=   .0200 SEC", "    7    0.0200    NPTS, DT");
        assert_eq!(Record::from_text(&counts, TextOptions::default()), Ok(first.clone()));
        assert_eq!(Record::from_text(&EQUALS.replace('\n', "\r\n"), TextOptions::default()), Ok(first.clone()));
        for header in ["NPTS = 7 , DT = .02", "NPTS=7,DT=.02SEC", "7 0.02 NPTS, DT, FILTER 3"] {
            let other = EQUALS.replace("NPTS=     7, DT=   .0200 SEC", header);
            assert_eq!(Record::from_text(&other, TextOptions::default()), Ok(first.clone()), "{header}");
        }
        let error = Record::from_text(&EQUALS.replace(", DT=   .0200 SEC", ""), TextOptions::default());
        assert!(error.expect_err("no interval").to_string().contains("no sampling interval"));
        assert_eq!(first.dt(), 0.02);
        assert_eq!(first.accel().len(), 7);
        assert_eq!(first.accel()[3], -0.0064 * 9.81);
        assert_eq!(first.peak(), 0.5 * 9.81);
    }

    #[test]
    fn the_unit_stands_above_the_header() {
        let gal = EQUALS.replace("UNITS OF G", "UNITS OF CM/S**2");
        assert_eq!(Record::from_text(&gal, TextOptions::default()).expect("valid").peak(), 0.005);
        let points = EQUALS.replace("UNITS OF G", "UNITS OF G. FILTER POINTS: HP=0.1 Hz");
        assert_eq!(Record::from_text(&points, TextOptions::default()).expect("valid").peak(), 0.5 * 9.81);
        for unit in ["MM/S**2", "IN/S**2"] {
            let error =
                Record::from_text(&EQUALS.replace("UNITS OF G", &format!("UNITS OF {unit}")), TextOptions::default());
            assert!(matches!(error, Err(RecordError::Header { line: 3, .. })), "{error:?}");
        }
        let velocity = EQUALS.replace("ACCELERATION", "VELOCITY");
        let error = Record::from_text(&velocity, TextOptions::default()).expect_err("no acceleration");
        assert!(matches!(error, RecordError::Header { line: 3, .. }), "{error}");
        let contradiction = Record::from_text(EQUALS, plain(AccelerationUnit::parse("gal"), None));
        assert!(matches!(contradiction, Err(RecordError::Contradiction { key: "units", line: 3, .. })));
    }

    #[test]
    fn what_is_wrong_is_named_with_its_place() {
        let short = EQUALS.replace("  7,", " 70,");
        assert_eq!(
            Record::from_text(&short, TextOptions::default()),
            Err(RecordError::Fewer { line: 4, declared: 70, found: 7 })
        );
        let word = EQUALS.replace(" -.25", " -x.25");
        assert_eq!(
            Record::from_text(&word, TextOptions::default()),
            Err(RecordError::NotANumber { line: 6, column: 6, text: "-x.25".into() })
        );
        for word in ["nan", "inf", "1e999", "0x10", "--1"] {
            let error = Record::from_text(&format!("0.1\n{word}\n"), plain(Some(AccelerationUnit::G), Some(0.1)));
            assert!(matches!(error, Err(RecordError::NotANumber { line: 2, column: 1, .. })), "{word}: {error:?}");
        }
    }

    #[test]
    fn plain_text_has_one_column_or_two() {
        let one = Record::from_text(
            "# made up\n0.1\n-0.2\n\n0.3\n",
            plain(Some(AccelerationUnit::MetrePerSecondSquared), Some(0.5)),
        );
        let two = Record::from_text(
            "0, 0.1\n0.5; -0.2\n1.0\t0.3\n",
            plain(Some(AccelerationUnit::MetrePerSecondSquared), None),
        );
        assert_eq!(one, two);
        assert_eq!(
            Record::from_text("0.1\n0.2\n", plain(None, Some(0.1))),
            Err(RecordError::Missing { quantity: "unit", key: "units = \"g\"" })
        );
        let uneven = Record::from_text("0 1\n0.1 1\n0.25 1\n0.3 1\n", plain(Some(AccelerationUnit::G), None));
        assert!(matches!(uneven, Err(RecordError::Uneven { line: 3, .. })), "{uneven:?}");
        let ragged = Record::from_text("0 1\n0.1\n", plain(Some(AccelerationUnit::G), None));
        assert_eq!(ragged, Err(RecordError::Columns { line: 2, found: 1, expected: 2 }));
    }
}
