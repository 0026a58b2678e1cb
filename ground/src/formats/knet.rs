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
//! The acceleration is the integer times the scale factor. The mean of the record is taken as the zero of the instrument and removed.
//! The duration is nominal and no count of samples: all samples are read, with a warning if their duration differs from it. A file
//! is cut off if it is too short and ends within a number.

use super::header::{Entry, leading_number, other_duration, seconds_of, tidy};
use super::numbers::{Block, FixedWidth, is_remark, number, split};
use super::record_file::{Format, PeakBounds, RecordFile, StatedPeak};
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::unit::AccelerationUnit;

/// Lines of a header.
const HEADER_LINES: usize = 17;

/// Characters before the value.
const VALUE: usize = 18;

/// The header may state the peak relative to the mean of another part of the record than the mean removed here: hence the wide bounds.
const PEAK_BOUNDS: PeakBounds = PeakBounds { rounding: 0.05, damage: 0.5 };

/// Rows of eight integers of nine characters.
const COLUMNS: FixedWidth = FixedWidth(9);

/// Place of an entry in the header, from 1, and the beginnings that its name may have.
type Place = (usize, &'static [&'static str]);

const ORIGIN: Place = (1, &["origin time"]);
const STATION: Place = (6, &["station code"]);
const FIRST_SAMPLE: Place = (10, &["record time"]);
const FREQUENCY: Place = (11, &["sampling freq", "sampling"]);
const DURATION: Place = (12, &["duration time", "duration"]);
const DIRECTION: Place = (13, &["dir"]);
const SCALE: Place = (14, &["scale factor", "scale"]);
const PEAK: Place = (15, &["max. acc.", "max acc."]);

/// Whether these are the lines of a K-NET file.
pub fn is_one(lines: &[&str]) -> bool {
    let first = lines.iter().find(|line| !line.trim().is_empty());
    let head = &lines[..lines.len().min(2 * HEADER_LINES)];
    let has = |entry: Place| head.iter().any(|line| has_name(line, entry));
    let begins = first.is_some_and(|line| has_name(line, ORIGIN));
    // Other programs begin a table with the time of the earthquake as well.
    begins && [FREQUENCY, SCALE, STATION].into_iter().any(has) || has(SCALE) && has(FREQUENCY)
}

fn has_name(line: &str, (_, names): Place) -> bool {
    let lower = line.trim_start().to_ascii_lowercase();
    names.iter().any(|name| lower.starts_with(name))
}

/// The value from column 19 on. The character before it must be blank since names are shorter: otherwise the columns were moved.
fn by_column(line: &str) -> Option<&str> {
    let mut places = line.char_indices().skip(VALUE - 1);
    let (_, before) = places.next()?;
    let (at, _) = places.next()?;
    before.is_whitespace().then_some(&line[at..])
}

/// The value after the name and its unit.
fn by_name(line: &str, (_, names): Place) -> Option<&str> {
    let line = line.trim_start();
    let name = names.iter().find(|name| line.to_ascii_lowercase().starts_with(**name))?;
    let rest = line[name.len()..].trim_start_matches(|c: char| c.is_ascii_alphabetic() || c == '.').trim_start();
    let after_unit = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
    Some(after_unit.map_or(rest, |(_, value)| value).trim_start_matches([' ', ':', '=', ',', ';']))
}

/// The header and where it begins.
struct Header<'t> {
    lines: &'t [&'t str],
    first: usize,
}

impl<'t> Header<'t> {
    /// Line, from 1, and value of an entry. The line is found by the name of the entry, or by its place if no line has that name.
    fn find(&self, place: Place) -> Option<(usize, &'t str)> {
        let end = self.lines.len().min(self.first + 2 * HEADER_LINES);
        let named = (self.first..end).find(|index| has_name(self.lines[*index], place));
        let index = named.unwrap_or(self.first + place.0 - 1);
        let line = self.lines.get(index)?;
        let value = match line.split_once('\t') {
            Some((_, value)) => value,
            None => by_column(line).or_else(|| by_name(line, place)).unwrap_or(""),
        };
        Some((index + 1, value.trim()))
    }

    fn text(&self, place: Place) -> String {
        self.find(place).map(|(_, value)| tidy(value)).unwrap_or_default()
    }

    /// An entry that a file must have.
    fn required(&self, place: Place, remedy: &'static str) -> Result<Entry<'t>, RecordError> {
        let (number, names) = place;
        let found = self.find(place).filter(|(_, value)| !value.is_empty());
        found.map(|(line, text)| Entry { line, text, remedy }).ok_or_else(|| {
            let line = (self.first + number).min(self.lines.len().max(1));
            let problem =
                format!("`{}` is missing in line {number} of the header, or its value in column 19", names[0]);
            RecordError::Header { line, problem, remedy }
        })
    }
}

/// Reads a K-NET file.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let first = lines.iter().position(|line| has_name(line, ORIGIN)).unwrap_or(0);
    let header = Header { lines, first };
    let entry = header.required(FREQUENCY, "write it as `Sampling Freq(Hz) 100Hz`")?;
    let frequency = leading_number(entry.text).filter(|frequency| *frequency > 0.0);
    let dt = Entry { text: lines[entry.line - 1], ..entry }.interval(frequency.map(f64::recip), options)?;
    let entry = header.required(SCALE, "write it as `Scale Factor      3920(gal)/6182761`")?;
    let (unit, scale) = factor(entry.text).ok_or_else(|| entry.quoted("no scale factor in"))?;
    let unit = entry.agreed(unit, options)?;

    // The memo may be missing, so that samples begin early. Or remarks may need more lines than that of the memo.
    let is_row = |line: &str| split(line, 1).is_ok_and(|row| !row.is_empty());
    let memo = first + HEADER_LINES;
    let mut start = entry.line;
    while start < lines.len() && if start < memo { !is_row(lines[start]) } else { is_remark(lines[start]) } {
        start += 1;
    }
    let (duration_line, text) = header.find(DURATION).unwrap_or_default();
    let (span, header_entry) = ((start, lines.len()), (duration_line, "Duration Time"));
    let (columns, lenient) = (Some(COLUMNS), options.lenient);
    let mut samples = Block { lines, span, declared: None, header: header_entry, columns, lenient }.read()?;
    let count = samples.values.len();
    if let Some(duration) = leading_number(text) {
        let nominal = (duration / dt).round() as usize;
        if samples.cut && count < nominal && !lenient {
            let (line, key) = header_entry;
            return Err(RecordError::Fewer { line, key, declared: nominal, found: count });
        }
        if count != nominal {
            samples.warnings.push(other_duration(count, dt, duration_line, duration));
        }
    }
    let mean = samples.values.iter().sum::<f64>() / count.max(1) as f64;
    samples.values.iter_mut().for_each(|value| *value -= mean);
    let mut file = RecordFile::of(Format::KNet, unit, scale * unit.in_si(options.gravity), dt, samples);
    let peak = header.find(PEAK).and_then(|(line, value)| {
        Some(StatedPeak { line, size: leading_number(value)? * unit.in_si(options.gravity), half_digit: 0.0 })
    });
    file.compare_peak(peak, PEAK_BOUNDS, options.lenient)?;
    let component = header.find(DIRECTION).map(|(_, value)| direction(value)).unwrap_or_default();
    if component.contains(BOREHOLE) {
        file.warnings.push("the instrument is in a borehole; files of the surface end in 2 (.EW2, .NS2, .UD2)".into());
    }
    let first_sample = header.find(FIRST_SAMPLE).and_then(|(_, date)| seconds_of(date));
    Ok(RecordFile { title: header.text(ORIGIN), station: header.text(STATION), component, first_sample, ..file })
}

/// `3920(gal)/6182761`: the unit, and one count in that unit. The unit is gal if it is not named.
fn factor(text: &str) -> Option<(AccelerationUnit, f64)> {
    let (full, counts) = text.split_once('/')?;
    let full = full.trim();
    let end = full.find(|c: char| c.is_alphabetic() || c == '(').unwrap_or(full.len());
    let (full, unit) = (full[..end].trim(), full[end..].trim());
    let unit = AccelerationUnit::parse(if unit.is_empty() { "gal" } else { unit })?;
    let scale = number(full)? / leading_number(counts)?;
    (scale.is_finite() && scale > 0.0).then_some((unit, scale))
}

/// Instruments below the surface, in names of components.
const BOREHOLE: &str = "borehole";

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
