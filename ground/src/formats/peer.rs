//! PEER AT2.
//!
//! ```text
//! PEER NGA STRONG MOTION DATABASE RECORD
//! event, date, station, component
//! ACCELERATION TIME SERIES IN UNITS OF G
//! NPTS=  4000, DT= .01000 SEC          or   4000   0.0100   NPTS, DT
//!   .1000000E-01  -.2000000E-01  ...        5 to 8 numbers of 15 characters a row, the last row short
//! ```
//!
//! Records processed for the Nuclear Regulatory Commission have seven lines: the old headers, then one with the count. So the
//! count is sought by pattern, the last one among the first ten lines, and the unit in the lines above it.

use super::numbers::{Block, Layout, is_text, number, words};
use super::{Format, RecordFile, agreed_dt, agreed_unit, brief, largest, number_after, positive_dt, tidy, whole_count};
use crate::{AccelerationUnit, RecordError, TextOptions};

/// The line with count and interval is sought among the first ones only.
const HEADER_LINES: usize = 10;

/// Columns of a row where blanks do not part them.
const LAYOUT: Layout = Layout { per_row: 5, width: 15 };

const REMEDY: &str = "write it as `NPTS= 4000, DT= .01000 SEC` or `4000 .01000 NPTS, DT`";

/// Whether these are the lines of such a file.
pub fn is_one(lines: &[&str]) -> bool {
    header(lines).is_some()
}

/// The line with the count: the last that names NPTS, for headers of older versions of the record come first.
fn header(lines: &[&str]) -> Option<usize> {
    let names = |line: &&str| {
        line.to_ascii_uppercase().split(|c: char| !c.is_ascii_alphanumeric()).any(|word| word == "NPTS")
            || number_after(line, "NPTS").is_some()
    };
    lines[..lines.len().min(HEADER_LINES)].iter().rposition(names)
}

/// Reads it.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let header = header(lines).expect("`is_one` found it");
    let line = header + 1;
    let (count, dt) = count_and_interval(lines[header]);
    let broken = |problem: &str| RecordError::Header {
        line,
        problem: format!("{problem} in `{}`", brief(lines[header])),
        remedy: REMEDY,
    };
    if count.is_none() {
        return Err(broken("no number of samples (NPTS)"));
    }
    if dt.is_none() {
        return Err(broken("no sampling interval (DT)"));
    }
    let declared = whole_count(count, line, lines[header], REMEDY)?;
    let dt = agreed_dt(positive_dt(dt, line, lines[header], REMEDY)?, line, options)?;
    let unit = match unit(&lines[..header])? {
        Some((line, unit)) => agreed_unit(unit, line, options)?,
        None => options.units.unwrap_or(AccelerationUnit::G),
    };
    // Remarks may stand between the header and the numbers.
    let mut first = header + 1;
    while first < lines.len().min(HEADER_LINES + 1) && (lines[first].trim().is_empty() || is_text(lines[first])) {
        first += 1;
    }
    let block = Block {
        lines,
        span: (first, lines.len()),
        declared: Some(declared),
        header: (line, "NPTS"),
        layout: Some(LAYOUT),
        lenient: options.lenient,
    };
    let mut samples = block.read()?;
    let scale = unit.in_si(options.gravity);
    let accel: Vec<f64> = samples.values.iter().map(|value| value * scale).collect();
    if unit == AccelerationUnit::G && largest(&accel) > UNBELIEVABLE * options.gravity {
        samples.warnings.push(format!(
            "a peak of {:.1} g is hardly one; are the samples in another unit than the header says?",
            largest(&accel) / options.gravity
        ));
    }
    let (title, station, component) = event(&lines[..header]);
    Ok(RecordFile {
        format: Format::PeerAt2,
        title,
        station,
        component: component.clone(),
        unit,
        declared: Some(declared),
        dt,
        accel,
        stated_peak: None,
        channels: vec![if component.is_empty() { "1".into() } else { format!("1: {component}") }],
        warnings: samples.warnings,
    })
}

/// A peak in g that no instrument has recorded on the ground; more is a file in other units.
const UNBELIEVABLE: f64 = 20.0;

/// `NPTS= 4000, DT= .01 SEC`, or numbers in the order of the names before or after them: `4000 .01 NPTS, DT`.
fn count_and_interval(line: &str) -> (Option<f64>, Option<f64>) {
    let (count, dt) = (number_after(line, "NPTS"), number_after(line, "DT"));
    let mut numbers = words(line).filter_map(|word| number(word.text));
    let (None, Some(first), Some(second)) = (count, numbers.next(), numbers.next()) else { return (count, dt) };
    let upper = line.to_ascii_uppercase();
    let place = |name: &str| upper.split(|c: char| !c.is_ascii_alphanumeric()).position(|word| word == name);
    match (place("NPTS"), place("DT")) {
        (Some(count), Some(dt)) if dt < count => (Some(second), Some(first)),
        _ => (Some(first), Some(second)),
    }
}

/// The unit that the lines above the header name, nearest line first: `... IN UNITS OF G`, `... TIME HISTORY (G'S): ...`.
fn unit(above: &[&str]) -> Result<Option<(usize, AccelerationUnit)>, RecordError> {
    for (index, text) in above.iter().enumerate().rev() {
        let upper = tidy(text).to_ascii_uppercase().replace("UNITS=", "UNITS =");
        let after_units =
            ["UNITS OF", "UNITS IN", "UNITS:", "UNITS ="].iter().find_map(|words| upper.split_once(words));
        let series = ["TIME SERIES", "TIME HISTORY", "TIME-SERIES", "TIME-HISTORY", "TIME HISTORIES"];
        let quantity = ["ACCEL", "VELOC", "DISPL"].iter().any(|begin| upper.trim_start().starts_with(begin));
        let describes = quantity || after_units.is_some() || series.iter().any(|words| upper.contains(words));
        if !describes {
            continue;
        }
        if upper.contains("VELOCITY") || upper.contains("DISPLACEMENT") {
            return Err(RecordError::Header {
                line: index + 1,
                problem: format!("this is no acceleration: `{}`", brief(text)),
                remedy: "use the acceleration file (.AT2) of the same record",
            });
        }
        let name = match after_units {
            // Old headers go on after the unit: `UNITS OF G. FILTER POINTS: ...`.
            Some((_, rest)) => rest.split([' ', ',', ';', ':']).find(|word| !word.is_empty()),
            // `(G'S)`, or `... IN CM/S/S`.
            None => {
                let bracket = upper.split_once(['(', '[']).and_then(|(_, rest)| rest.split([')', ']']).next());
                let last = upper.rsplit_once(" IN ").and_then(|(_, rest)| rest.split([' ', ',', ';', ':']).next());
                bracket.filter(|name| AccelerationUnit::parse(name).is_some()).or(last)
            }
        };
        let Some(name) = name.map(|name| name.trim().trim_end_matches('.')) else { continue };
        match AccelerationUnit::parse(name.trim_matches(['(', ')', '[', ']'])) {
            Some(unit) => return Ok(Some((index + 1, unit))),
            // Brackets and sentences may hold anything; what follows `UNITS OF` is a unit.
            None if after_units.is_none() => {}
            None => {
                return Err(RecordError::Header {
                    line: index + 1,
                    problem: format!("`{name}` is no unit of acceleration that is known"),
                    remedy: "convert the record to g, m/s/s or cm/s/s and name that unit",
                });
            }
        }
    }
    Ok(None)
}

/// Event, station and component of the second line, or of the one below the mark of old headers: `event, date, station,
/// component`, parted by commas.
fn event(above: &[&str]) -> (String, String, String) {
    let old = above.iter().position(|line| line.to_ascii_uppercase().contains("OLD HEADERS FOLLOW"));
    let line = above.get(old.map_or(1, |old| old + 1)).map(|line| tidy(line)).unwrap_or_default();
    let parts: Vec<&str> = line.split(',').map(str::trim).collect();
    // A place may stand in brackets after the component: `140 (CDMG STATION 955)`.
    match parts.as_slice() {
        [event @ .., station, component] if event.len() >= 2 => {
            (event.join(", "), (*station).into(), (*component).into())
        }
        [event, station, component] => ((*event).into(), (*station).into(), (*component).into()),
        _ => (line, String::new(), String::new()),
    }
}
