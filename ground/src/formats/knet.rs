//! K-NET and KiK-net: the ASCII format of Japan's strong-motion networks (NIED).
//!
//! ```text
//! Origin Time       2003/07/26 07:13:00      17 lines by position; the value begins in column 19
//! ...
//! Sampling Freq(Hz) 100Hz                    11th
//! Duration Time(s)  60                       12th
//! Dir.              N-S                      13th; KiK-net: 1 to 6
//! Scale Factor      3920(gal)/6182761        14th
//! Max. Acc. (gal)   213.456                  15th
//! Last Correction   2003/07/26 07:12:52
//! Memo.                                      17th
//!   -1234    -1240 ...                       8 integers a row
//! ```
//!
//! The acceleration is the integer times the scale factor; the instrument's zero is the mean of the record, which is removed.
//! The duration is a nominal one and no count of samples: all of them are read, and the user is told where it differs. Only a
//! file that is too short and ends within a number is taken for cut off.

use super::numbers::{Block, Layout, is_text, number, split};
use super::{Format, RecordFile, agreed_dt, agreed_unit, brief, leading_number, peak_warning, positive_dt, tidy};
use crate::{AccelerationUnit, RecordError, TextOptions};

/// Lines of the header.
const HEADER_LINES: usize = 17;

/// Characters before the value.
const VALUE: usize = 18;

/// Relative difference of the samples' peak and the stated one that is told: the zero may be that of another stretch.
const PEAK_DIFFERENCE: f64 = 0.05;

/// Rows of eight integers of nine characters.
const LAYOUT: Layout = Layout { per_row: 8, width: 9 };

/// Place of a line in the header, from 1, and the beginnings of the names that it goes by.
type Entry = (usize, &'static [&'static str]);

const ORIGIN: Entry = (1, &["origin time"]);
const STATION: Entry = (6, &["station code"]);
const FREQUENCY: Entry = (11, &["sampling freq", "sampling"]);
const DURATION: Entry = (12, &["duration time", "duration"]);
const DIRECTION: Entry = (13, &["dir"]);
const SCALE: Entry = (14, &["scale factor", "scale"]);
const PEAK: Entry = (15, &["max. acc.", "max acc."]);

/// Whether these are the lines of such a file.
pub fn is_one(lines: &[&str]) -> bool {
    let first = lines.iter().find(|line| !line.trim().is_empty());
    let begins = first.is_some_and(|line| has_name(line, ORIGIN));
    let head = &lines[..lines.len().min(2 * HEADER_LINES)];
    begins || (head.iter().any(|line| has_name(line, SCALE)) && head.iter().any(|line| has_name(line, FREQUENCY)))
}

fn has_name(line: &str, (_, names): Entry) -> bool {
    let lower = line.trim_start().to_ascii_lowercase();
    names.iter().any(|name| lower.starts_with(name))
}

/// The value from its column on. The names are shorter, so the character before is blank; where it is not, somebody has moved
/// the columns.
fn by_column(line: &str) -> Option<&str> {
    let mut places = line.char_indices().skip(VALUE - 1);
    let (_, before) = places.next()?;
    let (at, _) = places.next()?;
    before.is_whitespace().then_some(&line[at..])
}

/// What follows the name and the unit that belongs to it.
fn by_name(line: &str, entry: Entry) -> Option<&str> {
    let line = line.trim_start();
    let name = entry.1.iter().find(|name| line.to_ascii_lowercase().starts_with(**name))?;
    let rest = line[name.len()..].trim_start_matches(|c: char| c.is_ascii_alphabetic() || c == '.').trim_start();
    let after_unit = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
    Some(after_unit.map_or(rest, |(_, value)| value).trim_start_matches([' ', ':', '=']))
}

/// The header and where it begins.
struct Header<'t> {
    lines: &'t [&'t str],
    first: usize,
}

impl<'t> Header<'t> {
    /// Line, from 1, and value of an entry: by its place, or by its name where another stands there.
    fn find(&self, entry: Entry) -> Option<(usize, &'t str)> {
        let end = self.lines.len().min(self.first + 2 * HEADER_LINES);
        let named = (self.first..end).find(|index| has_name(self.lines[*index], entry));
        let index = named.unwrap_or(self.first + entry.0 - 1);
        let line = self.lines.get(index)?;
        let value = match line.split_once('\t') {
            Some((_, value)) => value,
            None => by_column(line).or_else(|| by_name(line, entry)).unwrap_or(""),
        };
        Some((index + 1, value.trim()))
    }

    fn wanted(&self, entry: Entry, remedy: &'static str) -> Result<(usize, &'t str), RecordError> {
        self.find(entry).filter(|(_, value)| !value.is_empty()).ok_or_else(|| RecordError::Header {
            line: (self.first + entry.0).min(self.lines.len().max(1)),
            problem: format!(
                "`{}` is missing in line {} of the header, or its value in column 19",
                entry.1[0], entry.0
            ),
            remedy,
        })
    }
}

/// Reads it.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let first = lines.iter().position(|line| has_name(line, ORIGIN)).unwrap_or(0);
    let header = Header { lines, first };
    let remedy = "write it as `Sampling Freq(Hz) 100Hz`";
    let (line, frequency) = header.wanted(FREQUENCY, remedy)?;
    let frequency_value = leading_number(frequency).filter(|frequency| *frequency > 0.0);
    let dt = frequency_value.map(|frequency| 1.0 / frequency);
    let dt = agreed_dt(positive_dt(dt, line, lines[line - 1], remedy)?, line, options)?;

    let remedy = "write it as `Scale Factor      3920(gal)/6182761`";
    let (scale_line, scale) = header.wanted(SCALE, remedy)?;
    let (unit, scale) = factor(scale).ok_or_else(|| RecordError::Header {
        line: scale_line,
        problem: format!("no scale factor in `{}`", brief(scale)),
        remedy,
    })?;
    let unit = agreed_unit(unit, scale_line, options)?;

    // Somebody may have removed the memo, and remarks may need more than its line.
    let is_row = |line: &str| split(line, 1).is_ok_and(|row| !row.is_empty());
    let memo = first + HEADER_LINES;
    let mut start = scale_line;
    while start < lines.len() && if start < memo { !is_row(lines[start]) } else { is_remark(lines[start]) } {
        start += 1;
    }
    let (duration_line, duration) = header.find(DURATION).unwrap_or_default();
    let block = Block {
        lines,
        span: (start, lines.len()),
        declared: None,
        header: (duration_line, "Duration Time"),
        layout: Some(LAYOUT),
        lenient: options.lenient,
    };
    let samples = block.read()?;
    let count = samples.values.len();
    let mut warnings = samples.warnings;
    if let Some(duration) = leading_number(duration) {
        let nominal = (duration / dt).round() as usize;
        if samples.cut && count < nominal && !options.lenient {
            let (line, key) = block.header;
            return Err(RecordError::Fewer { line, key, declared: nominal, found: count });
        }
        if count != nominal {
            warnings.push(format!(
                "{count} samples at {dt} s are {:.6} s, and line {duration_line} says {duration} s; is the file whole?",
                count as f64 * dt
            ));
        }
    }
    let scale = scale * unit.in_si(options.gravity);
    let mean = samples.values.iter().sum::<f64>() / count.max(1) as f64;
    let accel: Vec<f64> = samples.values.iter().map(|value| (value - mean) * scale).collect();
    let peak = header.find(PEAK).and_then(|(line, value)| Some((line, leading_number(value)?.abs())));
    let stated = peak.map(|(_, peak)| peak * unit.in_si(options.gravity)).filter(|peak| *peak > 0.0);
    warnings.extend(peak_warning(&accel, stated, peak.map_or(0, |(line, _)| line), PEAK_DIFFERENCE));
    let component = header.find(DIRECTION).map(|(_, value)| direction(value)).unwrap_or_default();
    Ok(RecordFile {
        format: Format::KNet,
        title: header.find(ORIGIN).map(|(_, value)| tidy(value)).unwrap_or_default(),
        station: header.find(STATION).map(|(_, value)| tidy(value)).unwrap_or_default(),
        component: component.clone(),
        unit,
        declared: None,
        dt,
        accel,
        stated_peak: stated,
        channels: vec![if component.is_empty() { "1".into() } else { format!("1: {component}") }],
        warnings,
    })
}

/// A line without samples.
fn is_remark(line: &str) -> bool {
    line.trim().is_empty() || is_text(line)
}

/// `3920(gal)/6182761`: unit, and its size for one count. The unit is gal where it is not named.
fn factor(text: &str) -> Option<(AccelerationUnit, f64)> {
    let (full, counts) = text.split_once('/')?;
    let full = full.trim();
    let end = full.find(|c: char| c.is_alphabetic() || c == '(').unwrap_or(full.len());
    let (full, unit) = (full[..end].trim(), full[end..].trim());
    let unit = AccelerationUnit::parse(if unit.is_empty() { "gal" } else { unit })?;
    let scale = number(full)? / leading_number(counts)?;
    (scale.is_finite() && scale > 0.0).then_some((unit, scale))
}

/// KiK-net numbers its six instruments: three in the borehole, three at the surface.
fn direction(text: &str) -> String {
    let name = match text {
        "1" => "N-S borehole",
        "2" => "E-W borehole",
        "3" => "U-D borehole",
        "4" => "N-S surface",
        "5" => "E-W surface",
        "6" => "U-D surface",
        other => return tidy(other),
    };
    format!("{name} ({text})")
}
