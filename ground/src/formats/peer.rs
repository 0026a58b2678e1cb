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
//! Records processed for the Nuclear Regulatory Commission have seven lines: the old headers, then one with the count. Therefore
//! the line with the count is the last one, among the first ten lines, that names NPTS. The unit is sought in the lines above it, and then in
//! all lines above the numbers.

use super::factor::has_factor;
use super::header::{Entry, brief, number_after, tidy};
use super::heading::Quantity;
use super::numbers::{Block, FixedWidth, is_remark, number, words};
use super::record_file::{Format, RecordFile};
use super::sampling;
use super::statement::{self, HEADER_LINES, Stated, names_count};
use super::table;
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::unit::AccelerationUnit;
use std::iter;

/// Columns of a row, used if blanks do not separate the numbers.
const COLUMNS: FixedWidth = FixedWidth(15);

/// Whether these are the lines of a PEER file. A line with the number of samples stands above tables too: there it is a remark, or the line above the
/// numbers has the headings of their columns.
pub fn is_one(lines: &[&str]) -> bool {
    let Some(header) = header(lines) else { return false };
    let first = first_row(lines, header);
    let is_remark = lines[header].trim_start().starts_with(['#', '%']);
    let row = lines.get(first).copied().unwrap_or("");
    !is_remark && !lines[header + 1..first].iter().any(|line| table::heads(line, row))
}

/// The line with the count: the last one that names NPTS, since headers of older versions of the record come first.
fn header(lines: &[&str]) -> Option<usize> {
    lines[..lines.len().min(HEADER_LINES)].iter().rposition(|line| names_count(line))
}

/// The first line of numbers. Remarks may stand between the header and the numbers.
fn first_row(lines: &[&str], header: usize) -> usize {
    (header + 1..lines.len().min(HEADER_LINES + 1))
        .find(|index| !is_remark(lines[*index]))
        .unwrap_or(lines.len().min(HEADER_LINES + 1).max(header + 1))
}

/// Reads a PEER file.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let header = header(lines).expect("`is_one` found it");
    let remedy = "write it as `NPTS= 4000, DT= .01000 SEC` or `4000 .01000 NPTS, DT`";
    let entry = Entry { line: header + 1, text: lines[header], remedy };
    let (count, dt) = count_and_interval(entry.text);
    let count = count.ok_or_else(|| entry.quoted("no number of samples (NPTS) in"))?;
    let dt = dt.ok_or_else(|| entry.quoted("no sampling interval (DT) in"))?;
    let declared = Some(entry.count(Some(count))?);
    let dt = entry.interval(Some(dt), options)?;
    let first = first_row(lines, header);
    let mut warnings = Vec::new();
    let text = lines[..first].iter().enumerate().map(|(index, line)| (index + 1, *line));
    let (own, stated) = (unit(&lines[..header], options)?, statement::units(text));
    let unit = match own {
        Some((line, unit)) => {
            // Other units in the line of the unit are of other quantities, such as a peak.
            let others = stated.into_iter().filter(|other| other.line != line);
            let all: Vec<_> = iter::once(Stated { line, unit, is_doubtful: false }).chain(others).collect();
            statement::one_unit(&all, options, &mut warnings)?;
            unit
        }
        None => unit_in_text(&stated, lines, options, &mut warnings)?,
    };
    let (span, header_entry) = ((first, lines.len()), (entry.line, "NPTS"));
    let block = Block { lines, span, declared, header: header_entry, columns: Some(COLUMNS), lenient: options.lenient };
    let mut samples = block.read()?;
    samples.warnings.append(&mut warnings);
    let file = RecordFile::of(Format::PeerAt2, unit, unit.in_si(options.gravity), dt, samples);
    let [title, station, component] = event(&lines[..header]);
    Ok(RecordFile { title, station, component, declared, ..file })
}

/// The unit that a header states in other places than its own, else that of `options`, else g.
fn unit_in_text(
    stated: &[Stated],
    lines: &[&str],
    options: &TextOptions,
    warnings: &mut Vec<String>,
) -> Result<AccelerationUnit, RecordError> {
    let remedy = "write `ACCELERATION TIME SERIES IN UNITS OF G` above the line with NPTS";
    match (statement::one_unit(stated, options, warnings)?, options.units) {
        (Some((line, unit)), _) => Entry { line, text: lines[line - 1], remedy }.agreed(unit, options),
        (None, Some(own)) => Ok(own),
        (None, None) => {
            warnings.push("the header states no unit: g is taken (give another one with `units`)".into());
            Ok(AccelerationUnit::G)
        }
    }
}

/// Count and interval of a line. The numbers follow their names (`NPTS= 4000, DT= .01 SEC`), or two numbers stand in the order of the names
/// (`4000 .01 NPTS, DT`).
fn count_and_interval(line: &str) -> (Option<f64>, Option<f64>) {
    let (count, dt) = (number_after(line, "NPTS"), sampling::interval(line));
    let mut numbers = words(line).filter_map(|word| number(word.text));
    let (None, Some(first), Some(second)) = (count, numbers.next(), numbers.next()) else { return (count, dt) };
    let upper = line.to_ascii_uppercase();
    let place = |name: &str| upper.split(|c: char| !c.is_ascii_alphanumeric()).position(|word| word == name);
    match (place("NPTS"), place("DT")) {
        (Some(count), Some(dt)) if dt < count => (Some(second), Some(first)),
        _ => (Some(first), Some(second)),
    }
}

/// Line, from 1, and unit that the lines above the header name, nearest line first: `... IN UNITS OF G`, `... TIME HISTORY (G'S): ...`.
fn unit(above: &[&str], options: &TextOptions) -> Result<Option<(usize, AccelerationUnit)>, RecordError> {
    for (index, text) in above.iter().enumerate().rev() {
        let entry = |remedy: &'static str| Entry { line: index + 1, text, remedy };
        let upper = tidy(text).to_ascii_uppercase().replace("UNITS=", "UNITS =").replace(" / S", "/S");
        let after_units =
            ["UNITS OF", "UNITS IN", "UNITS:", "UNITS ="].iter().find_map(|words| upper.split_once(words));
        let series = ["TIME SERIES", "TIME HISTORY", "TIME-SERIES", "TIME-HISTORY", "TIME HISTORIES"];
        let quantity = ["ACCEL", "VEL", "DISP", "PSEUDO"].iter().any(|begin| upper.trim_start().starts_with(begin));
        if !(quantity || after_units.is_some() || series.iter().any(|words| upper.contains(words))) {
            continue;
        }
        // The first word for a quantity decides: `VELOC. TIME SERIES`, `PSEUDO-VELOCITY`.
        let mut quantities = upper.split(|c: char| !c.is_alphabetic()).filter_map(Quantity::of);
        if quantities.find(|quantity| [Quantity::Acceleration, Quantity::Other].contains(quantity))
            == Some(Quantity::Other)
        {
            let remedy = "use the acceleration file (.AT2) of the same record";
            return Err(entry(remedy).quoted("this is no acceleration:"));
        }
        let is_share = |words: &str| {
            let after = upper.split_once(words).and_then(|(_, rest)| rest.split([' ', ',', ';', ':', ')', ']']).next());
            after.is_some_and(|unit| AccelerationUnit::parse(unit).is_some())
        };
        if ["% OF ", "PERCENT OF ", "IN % ", "IN PERCENT "].iter().any(|words| is_share(words)) {
            let remedy = "convert the record to g, m/s/s or cm/s/s and name that unit";
            return Err(
                entry(remedy).wrong(format!("a share of a unit is no unit that is known: `{}`", brief(text.trim())))
            );
        }
        let name = match after_units {
            // Old headers continue after the unit: `UNITS OF G. FILTER POINTS: ...`.
            Some((_, rest)) => {
                let first = rest.split([' ', ',', ';', ':']).find(|word| !word.is_empty());
                // A unit with a factor is none that is known: `UNITS OF G X 1000`.
                first.map(|unit| {
                    let (before, after) = rest.split_once(unit).unwrap_or(("", ""));
                    if has_factor(before, after) { rest } else { unit }
                })
            }
            // `(G'S)`, or `... IN CM/S/S`.
            None => {
                let bracket = upper.split_once(['(', '[']).and_then(|(_, rest)| rest.split([')', ']']).next());
                let is_unit = |name: &&str| AccelerationUnit::parse(name.trim_end_matches('.')).is_some();
                let named = upper.split(" IN ").skip(1).filter_map(|rest| rest.split([' ', ',', ';', ':']).next());
                bracket.filter(is_unit).or_else(|| named.clone().find(is_unit)).or_else(|| named.last())
            }
        };
        let Some(name) = name.map(|name| name.trim().trim_end_matches('.').trim_matches(['(', ')', '[', ']'])) else {
            continue;
        };
        // Brackets and sentences may hold anything; what follows `UNITS OF` is a unit.
        if after_units.is_some() || AccelerationUnit::parse(name).is_some() {
            let remedy = "convert the record to g, m/s/s or cm/s/s and name that unit";
            return Ok(Some((index + 1, entry(remedy).unit(name, options)?)));
        }
    }
    Ok(None)
}

/// `[event, station, component]` of the line `event, date, station, component`; all before the station is the event. It is the second line, or the one below
/// the mark of old headers.
fn event(above: &[&str]) -> [String; 3] {
    let old = above.iter().position(|line| line.to_ascii_uppercase().contains("OLD HEADERS FOLLOW"));
    let line = above.get(old.map_or(1, |old| old + 1)).map(|line| tidy(line)).unwrap_or_default();
    let parts: Vec<&str> = line.split(',').map(str::trim).collect();
    // A place may stand in brackets after the component: `140 (CDMG STATION 955)`.
    match parts.as_slice() {
        [event @ .., station, component] if !event.is_empty() => {
            [event.join(", "), (*station).into(), (*component).into()]
        }
        _ => [line, String::new(), String::new()],
    }
}
