//! COSMOS V1.20: one channel after the other, each with headers that state their own length.
//!
//! ```text
//! Corrected acceleration    (Format v01.20 with 13 text lines)  Src: ...
//! ...                                                              as many lines as columns 47-48 say
//!  100 Integer-header values follow on  10 lines, Format= (10I8)
//!  ...
//!  100 Real-header values follow on  17 lines, Format= (6F13.6)
//!  ...
//!    4 Comment lines follow, each starting with a "|":
//! |...
//!  4000 acceleration pts, approx  20 secs, units=cm/sec2 (04), Format=(8F10.5)
//!  ...
//! End-of-data for Chan  1 acceleration
//! ```
//!
//! Values of the headers count from 0 here, as in the tables of the format's readers: integer 1 is the physical quantity,
//! integer 2 the unit, real 61 the sampling interval. -999 stands for an unknown value.

use super::header::{ChannelName, Entry, after, brief, choose, leading_number, number_after, tidy};
use super::numbers::{Block, FixedWidth, number, words};
use super::record_file::{Format, PeakBounds, RecordFile, StatedPeak};
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::unit::AccelerationUnit;

/// Places of the unit among the integers: 2 by the format's table, 1 in files that count from 1. In other files, place 1 holds the quantity:
/// 1 for accelerations, which is the code of no unit of acceleration.
const UNITS: [usize; 2] = [2, 1];

/// Place of the azimuth among the integers `[°]`. The value 400 means up, 401 down.
const AZIMUTH: usize = 53;

/// Places, from 0, of the sampling interval among the reals `[ms]`: 61 by the format's table; 60 in files whose writers took that number for one counted
/// from 1. Place 33 holds the interval of the recorder, which processing may have changed; some files have it in seconds.
const INTERVALS: [usize; 3] = [61, 60, 33];

/// A number below this is an interval in seconds, one above it in milliseconds: recorders take a sample every 1 to 50 ms.
const BETWEEN_SECONDS_AND_MILLISECONDS: f64 = 0.5;

/// Place of the peak among the reals. The peak is in the unit of the samples.
const PEAK: usize = 63;

/// Value that stands for an unknown one.
const UNKNOWN: f64 = -999.0;

/// Headers round the peak to three digits.
const PEAK_BOUNDS: PeakBounds = PeakBounds { rounding: 5e-3, damage: 0.1 };

/// Columns of the samples if the line before the samples does not state them.
const COLUMNS: FixedWidth = FixedWidth(10);

/// Whether these are the lines of a COSMOS file.
pub fn is_one(lines: &[&str]) -> bool {
    let mut first = lines.iter().filter(|line| !line.trim().is_empty()).take(2);
    first.any(|line| begins_channel(line))
        || lines.iter().take(60).any(|line| line.to_ascii_lowercase().contains("integer-header values follow"))
}

/// Whether a line begins a channel.
fn begins_channel(line: &str) -> bool {
    line.to_ascii_lowercase().contains("(format v")
}

/// The quantity of the samples that a line announces: `4000 acceleration pts, ...`. It is `None` for any other line.
fn announces(line: &str) -> Option<String> {
    let lower = line.to_ascii_lowercase();
    let mut words = words(&lower).map(|word| word.text);
    number(words.next()?)?;
    let quantity = words.next()?.to_string();
    let is_announced = words.next()?.starts_with("p") && (lower.contains("format") || lower.contains("unit"));
    is_announced.then_some(quantity)
}

/// `End-of-data for Chan  1 acceleration`
fn is_end(line: &str) -> bool {
    let lower = line.trim_start().to_ascii_lowercase();
    lower.starts_with("end-of-data") || lower.starts_with("end of data")
}

/// A channel of the file. Lines are counted from 0.
struct Channel<'t> {
    lines: &'t [&'t str],
    begin: usize,
    /// The line before its samples.
    announced: usize,
    /// The line after its samples.
    end: usize,
}

/// Reads a COSMOS file.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let (channels, others) = channels(lines);
    if channels.is_empty() {
        let line = others.first().copied().unwrap_or(0);
        let remedy = "use the volume 2 file with the acceleration of the same record";
        let entry = Entry { line: line + 1, text: lines[line], remedy };
        return Err(match others.first() {
            Some(_) => entry.quoted("this is no acceleration:"),
            None => entry.wrong("there is no line `... acceleration pts, ..., units=..., Format=(...)`"),
        });
    }
    let names: Vec<ChannelName> = channels.iter().map(Channel::name).collect();
    let mut warnings = Vec::new();
    let (chosen, labels) = choose(&names, options, &mut warnings)?;
    let channel = &channels[chosen];
    if channel.text().first().is_some_and(|line| line.to_ascii_lowercase().contains("uncorrected")) {
        warnings.push("the file is one of volume 1: the acceleration is not corrected".into());
    }

    let remedy = "write it as `4000 acceleration pts, approx 20 secs, units=cm/sec2 (04), Format=(8F10.5)`";
    let entry = Entry { line: channel.announced + 1, text: lines[channel.announced], remedy };
    let count = entry.count(words(entry.text).next().and_then(|word| number(word.text)))?;
    let integers = channel.header("integer-header");
    let reals = channel.header("real-header");
    let unit = channel.unit(&integers, options, &mut warnings)?;
    let dt = channel.interval(&reals, count, options, &mut warnings)?;
    let (span, header) = ((channel.announced + 1, channel.end), (entry.line, "acceleration pts"));
    let columns = FixedWidth::find(after(entry.text, "format").unwrap_or(entry.text)).or(Some(COLUMNS));
    let declared = Some(count);
    let mut samples = Block { lines, span, declared, header, columns, lenient: options.lenient }.read()?;
    warnings.append(&mut samples.warnings);
    samples.warnings = warnings;
    let scale = unit.in_si(options.gravity);
    let mut file = RecordFile::of(Format::Cosmos, unit, scale, dt, samples);
    let peak = reals.get(PEAK).filter(|peak| **peak != UNKNOWN);
    let peak = channel.find("real-header").zip(peak);
    let peak = peak.map(|(index, peak)| StatedPeak { line: index + 1, size: peak * scale, half_digit: 0.0 });
    file.compare_peak(peak, PEAK_BOUNDS, options.lenient)?;
    let component = match (names[chosen].1.as_str(), integers.get(AZIMUTH)) {
        ("", Some(400.0)) => "Up".into(),
        ("", Some(401.0)) => "Down".into(),
        ("", Some(azimuth)) if (0.0..=360.0).contains(azimuth) => format!("{azimuth} deg"),
        (name, _) => name.into(),
    };
    let title = channel.text().get(1).map(|line| tidy(line)).unwrap_or_default();
    Ok(RecordFile { title, station: channel.station(), component, declared, channels: labels, ..file })
}

/// The channels with accelerations, and the lines that announce samples of other quantities.
fn channels<'t>(lines: &'t [&'t str]) -> (Vec<Channel<'t>>, Vec<usize>) {
    let (mut channels, mut others) = (Vec::new(), Vec::new());
    let mut begin = 0;
    for (index, line) in lines.iter().enumerate() {
        if begins_channel(line) {
            begin = index;
        } else if is_end(line) {
            begin = index + 1;
            continue;
        }
        let Some(quantity) = announces(line) else { continue };
        if quantity.starts_with("acc") {
            let ends = |line: &&str| is_end(line) || begins_channel(line) || announces(line).is_some();
            let end = lines[index + 1..].iter().position(ends).map_or(lines.len(), |after| index + 1 + after);
            channels.push(Channel { lines, begin, announced: index, end });
            begin = index + 1;
        } else {
            others.push(index);
        }
    }
    (channels, others)
}

impl<'t> Channel<'t> {
    /// The text header: all lines up to the integer header. Without an integer header, as many lines as the first line states.
    fn text(&self) -> &'t [&'t str] {
        let header = &self.lines[self.begin..self.announced];
        let first = header.first().copied().unwrap_or("");
        let stated = after(first, "with").and_then(leading_number).filter(|count| (1.0..=99.0).contains(count));
        // The number is in columns 47 and 48, even if the words around it differ.
        let by_column = || number(first.get(46..48)?.trim());
        let end = self.find("integer-header").map(|index| index - self.begin);
        let length = end.or(stated.or_else(by_column).map(|count| count as usize)).unwrap_or(0);
        &header[..length.min(header.len())]
    }

    /// The first line of the headers, counted from 0 in the file, that has a word (given in lower case).
    fn find(&self, word: &str) -> Option<usize> {
        (self.begin..self.announced).find(|index| self.lines[*index].to_ascii_lowercase().contains(word))
    }

    /// Values of the section of the header that `word` names: fewer than declared if the section is cut off, none if it is missing or unreadable.
    fn header(&self, word: &str) -> Vec<f64> {
        let Some(index) = self.find(word) else { return Vec::new() };
        let line = self.lines[index];
        let count = words(line).next().and_then(|word| leading_number(word.text)).unwrap_or(0.0) as usize;
        let columns = FixedWidth::find(after(line, "format").unwrap_or(line));
        // The header states its number of lines too, but the start of the next part cannot be wrong.
        let next = (index + 1..self.announced).find(|index| self.lines[*index].to_ascii_lowercase().contains("follow"));
        let (span, declared) = ((index + 1, next.unwrap_or(self.announced)), Some(count.clamp(1, 1000)));
        let block = Block { lines: self.lines, span, declared, header: (index + 1, "header"), columns, lenient: true };
        block.read().map(|found| found.values).unwrap_or_default()
    }

    /// `Sta Chan   1: 90 deg (Rcrdr Chan  1) Location:`: number and direction.
    fn name(&self) -> ChannelName {
        let channel = self.text().iter().find_map(|line| {
            let (number, rest) = after(line, "sta chan").or_else(|| after(line, "chan"))?.split_once(':')?;
            let number = number.trim().parse().ok()?;
            let direction = rest.split(['(', ',']).next()?.trim_start().split("   ").next()?;
            Some((Some(number), tidy(direction)))
        });
        channel.unwrap_or_default()
    }

    /// `Statn No: 05-24436  Code:CE-24436  Tarzana`.
    fn station(&self) -> String {
        let line = self.text().iter().find_map(|line| after(line, "statn no:").or_else(|| after(line, "station no:")));
        let Some(line) = line else { return String::new() };
        tidy(after(line, "code:").unwrap_or(line))
    }

    /// The unit: the first candidate of the integer header that agrees with the line before the samples. If there is none, the candidate at the format's
    /// own place contradicts that line: an error unless `lenient`. Without candidates, it is the unit that this line states, else that of `options`.
    fn unit(
        &self,
        integers: &[f64],
        options: &TextOptions,
        warnings: &mut Vec<String>,
    ) -> Result<AccelerationUnit, RecordError> {
        let (line, announced) = (self.announced + 1, self.lines[self.announced]);
        let remedy = "use the volume 2 file, in cm/sec2 or g, of the same record";
        let entry = |line: usize| Entry { line, text: announced, remedy };
        let rest = after(announced, "unit").unwrap_or("").trim_start_matches(['s', 'S', '=', ':', ' ']);
        let name = rest.split([',', '(']).next().unwrap_or("").trim();
        let code = rest.split_once('(').and_then(|(_, rest)| leading_number(rest.split(')').next()?));
        let stated = AccelerationUnit::parse(name).or_else(|| code.and_then(unit_of));
        let candidates: Vec<(usize, AccelerationUnit)> =
            UNITS.into_iter().filter_map(|place| Some((place, unit_of(*integers.get(place)?)?))).collect();
        let goes = |unit: AccelerationUnit| stated.is_none_or(|stated| stated == unit);
        let found = candidates.iter().find(|(_, unit)| goes(*unit));
        let found = found.or(candidates.iter().find(|(place, _)| *place == UNITS[0]));
        if let Some(((place, unit), index)) = found.zip(self.find("integer-header")) {
            let unit = entry(index + 1).agreed(*unit, options)?;
            if *place != UNITS[0] {
                warnings
                    .push(format!("the unit {unit} is value {place} (from 0) of the integer header, not {}", UNITS[0]));
            }
            if let Some(stated) = stated.filter(|_| !goes(unit)) {
                let problem = format!("the integer header gives the unit {unit}, and line {line} {stated}");
                if !options.lenient {
                    let remedy = "mend the wrong one, or take that of the integer header with `lenient`";
                    return Err(Entry { remedy, ..entry(index + 1) }.wrong(problem));
                }
                warnings.push(format!("{problem}; {unit} is taken"));
            }
            return Ok(unit);
        }
        match (stated, options.units) {
            (Some(unit), _) => entry(line).agreed(unit, options),
            (None, _) if !name.is_empty() => entry(line).unit(name, options),
            (None, Some(own)) => Ok(own),
            (None, None) => Err(RecordError::Missing { quantity: "unit", key: "units" }),
        }
    }

    /// The sampling interval: the first candidate of the real header that agrees with the duration in the line before the samples (rounded to
    /// seconds), else the first candidate. Without candidates, it is that of `options`.
    fn interval(
        &self,
        reals: &[f64],
        declared: usize,
        options: &TextOptions,
        warnings: &mut Vec<String>,
    ) -> Result<f64, RecordError> {
        let line = self.find("real-header").map_or(self.announced + 1, |index| index + 1);
        let announced = self.lines[self.announced];
        let duration = number_after(announced, "APPROX").filter(|duration| *duration > 0.0);
        let candidates: Vec<(usize, f64)> = INTERVALS
            .into_iter()
            .filter_map(|place| Some((place, *reals.get(place)?)))
            .filter(|(_, ms)| *ms > 0.0)
            .map(|(place, number)| {
                let is_in_seconds = place == INTERVALS[2] && number < BETWEEN_SECONDS_AND_MILLISECONDS;
                (place, if is_in_seconds { number } else { number / 1000.0 })
            })
            .collect();
        let goes = |dt: f64| {
            duration.is_none_or(|duration| {
                let difference = (dt * declared as f64 - duration).abs();
                difference <= 1.0 + DURATION_ROUNDING * duration
            })
        };
        let found = candidates.iter().find(|(_, dt)| goes(*dt)).or(candidates.first());
        if let Some((place, dt)) = found {
            if *place != INTERVALS[0] {
                warnings.push(format!(
                    "the sampling interval {dt} s is value {place} (from 0) of the real header, not {}",
                    INTERVALS[0]
                ));
            }
            if !goes(*dt) {
                let whole = dt * declared as f64;
                warnings.push(format!(
                    "{declared} samples at {dt} s last {whole:.2} s, and line {} says {}",
                    self.announced + 1,
                    brief(announced)
                ));
            }
        }
        match (found, options.dt) {
            (None, Some(dt)) => Ok(dt),
            (found, _) => {
                let remedy = "give the sampling interval in ms as value 61 (from 0) of the real header, or with `dt`";
                Entry { line, text: self.lines[line - 1], remedy }.interval(found.map(|(_, dt)| *dt), options)
            }
        }
    }
}

/// Share of the stated duration by which the duration of the samples may differ from it, in addition to one second.
const DURATION_ROUNDING: f64 = 0.02;

/// The units of acceleration by their codes (table 2 of the format).
fn unit_of(code: f64) -> Option<AccelerationUnit> {
    match code as i64 {
        2 => Some(AccelerationUnit::G),
        4 | 10 => Some(AccelerationUnit::CentimetrePerSecondSquared),
        7 => Some(AccelerationUnit::InchPerSecondSquared),
        11 => Some(AccelerationUnit::MilliG),
        12 => Some(AccelerationUnit::MicroG),
        _ => None,
    }
}
