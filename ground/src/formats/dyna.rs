//! ESM and ITACA: DYNA, the ASCII format of the European and Italian strong-motion databases.
//!
//! ```text
//! EVENT_NAME: ...
//! SAMPLING_INTERVAL_S: 0.005000
//! NDATA: 4000
//! UNITS: cm/s^2
//! PGA_CM/S^2: -123.456789
//! -0.012345                       one number a row
//! ```
//!
//! Versions have 43, 55 or 64 lines of `KEY: value`; keys are read in any order, up to the first row of numbers. Only the first
//! colon separates key and value. The first version has `COMPONENT: WE`, `NS` or `UP` in place of `STREAM`, and `TIME_FIRST_SAMPLE_S: 050610.120`
//! on the day of the event.

use super::header::{Entry, leading_number, other_duration, seconds_of, tidy};
use super::numbers::{Block, Word, comma_refused, has_decimal_comma, is_text, words};
use super::record_file::{Format, PeakBounds, RecordFile, StatedPeak};
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::unit::AccelerationUnit;

/// Lines among which the keys are sought.
const HEADER_LINES: usize = 200;

/// Headers state the peak with all digits of the samples.
const PEAK: PeakBounds = PeakBounds { rounding: 1e-3, damage: 1e-2 };

/// Whether these are the lines of a DYNA file.
pub fn is_one(lines: &[&str]) -> bool {
    let header = Header::of(lines);
    KEYS.iter().filter(|key| header.find(key).is_some()).count() >= 2
}

/// Keys that a DYNA file is recognised by: even a damaged header has at least two of them.
const KEYS: [&str; 7] =
    ["SAMPLING_INTERVAL_S", "NDATA", "STREAM", "HEADER_FORMAT", "DATA_TYPE", "EVENT_ID", "STATION_CODE"];

/// `KEY: value` lines.
struct Header<'t> {
    /// Line from 1, key in capitals, value.
    entries: Vec<(usize, String, &'t str)>,
    /// The line after the header, from 0.
    end: usize,
}

impl<'t> Header<'t> {
    fn of(lines: &[&'t str]) -> Header<'t> {
        let mut entries = Vec::new();
        let mut end = lines.len().min(HEADER_LINES);
        for (index, line) in lines.iter().enumerate().take(HEADER_LINES) {
            match line.split_once(':') {
                Some((key, value)) => entries.push((index + 1, key.trim().to_ascii_uppercase(), value.trim())),
                None if words(line).next().is_none_or(|word| is_text(word.text)) => {}
                None => {
                    end = index;
                    break;
                }
            }
        }
        Header { entries, end }
    }

    /// Line and value of a key; none where the value is blank.
    fn find(&self, key: &str) -> Option<(usize, &'t str)> {
        let entry = self.entries.iter().find(|(_, name, value)| name == key && !value.is_empty());
        entry.map(|(line, _, value)| (*line, *value))
    }

    fn text(&self, key: &str) -> String {
        self.find(key).map(|(_, value)| tidy(value)).unwrap_or_default()
    }
}

/// Number of intervals by which the stated duration may differ from that of the samples: it is from the first to the last, or one more, and rounded.
const INTERVALS_OFF: f64 = 2.0;

/// Reads a DYNA file.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let header = Header::of(lines);
    if let Some((line, text)) = header.find("DATA_TYPE") {
        let upper = text.to_ascii_uppercase();
        if ["SPECTR", "VELOCITY", "DISPLACEMENT"].iter().any(|other| upper.contains(other)) {
            let remedy = "use the acceleration file (.ACC) of the same record";
            return Err(Entry { line, text, remedy }.quoted("this is no acceleration history:"));
        }
    }
    refuse_spectrum(lines, header.end)?;
    let remedy = "give it as `SAMPLING_INTERVAL_S: 0.005` and `NDATA: 4000`";
    let number = |key: &'static str| {
        let missing = Entry { line: header.end.max(1), text: "", remedy };
        let (line, value) = header.find(key).ok_or_else(|| missing.wrong(format!("{key} is missing")))?;
        Ok((Entry { line, text: lines[line - 1], remedy }, leading_number(value)))
    };
    let (entry, dt) = number("SAMPLING_INTERVAL_S")?;
    let dt = entry.interval(dt, options)?;
    let (entry, count) = number("NDATA")?;
    let declared = Some(entry.count(count)?);
    let remedy = "use the acceleration file (.ACC), in cm/s^2, of the same record";
    let unit = match header.find("UNITS").or_else(|| header.find("UNIT")) {
        None => {
            refuse_other_peak(&header, lines, remedy)?;
            options.units.unwrap_or(AccelerationUnit::CentimetrePerSecondSquared)
        }
        Some((line, text)) => Entry { line, text, remedy }.unit(text, options)?,
    };
    let (span, header_entry) = ((header.end, lines.len()), (entry.line, "NDATA"));
    let block = Block { lines, span, declared, header: header_entry, columns: None, lenient: options.lenient };
    let mut samples = block.read()?;
    let count = samples.values.len();
    if let Some((line, text)) = header.find("DURATION_S")
        && let Some(duration) = leading_number(text)
        && (duration - count as f64 * dt).abs() > INTERVALS_OFF * dt
    {
        samples.warnings.push(other_duration(count, dt, line, duration));
    }
    let mut file = RecordFile::of(Format::Dyna, unit, unit.in_si(options.gravity), dt, samples);
    let stated = header.entries.iter().find(|(_, key, _)| key.starts_with("PGA_")).and_then(|(line, key, value)| {
        let scale = AccelerationUnit::parse(&key["PGA_".len()..])?.in_si(options.gravity);
        Some(StatedPeak { line: *line, size: leading_number(value)? * scale, half_digit: half_digit(value) * scale })
    });
    file.compare_peak(stated, PEAK, options.lenient)?;
    let code = header.find("STATION_CODE").or_else(|| header.find("STATION_ID")).map_or("", |(_, code)| code);
    let (network, name) = (header.text("NETWORK"), header.text("STATION_NAME"));
    let code = if network.is_empty() || code.is_empty() { tidy(code) } else { tidy(&format!("{network}.{code}")) };
    let station = if name.is_empty() || code.is_empty() { format!("{code}{name}") } else { format!("{code} ({name})") };
    let title = ["EVENT_NAME", "EVENT_ID", "EVENT_DATE_YYYYMMDD"].map(|key| header.text(key)).join(" ");
    let own = |key: &str| header.find(key).map(|(_, value)| value.to_string());
    let on_day_of_event = || Some(format!("{}_{}", own("EVENT_DATE_YYYYMMDD")?, own("TIME_FIRST_SAMPLE_S")?));
    let first_sample = own("DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS").or_else(on_day_of_event);
    let first_sample = first_sample.and_then(|date| seconds_of(&date));
    let component = [header.text("STREAM"), header.text("COMPONENT")].into_iter().find(|name| !name.is_empty());
    let component = component.unwrap_or_default();
    Ok(RecordFile { title: tidy(&title), station, component, declared, first_sample, ..file })
}

/// Refuses a file without a unit whose header states the peak of a velocity or a displacement alone.
fn refuse_other_peak(header: &Header, lines: &[&str], remedy: &'static str) -> Result<(), RecordError> {
    let peak = |begins: &str| header.entries.iter().find(|(_, key, _)| key.starts_with(begins));
    match peak("PGV_").or_else(|| peak("PGD_")).filter(|_| peak("PGA_").is_none()) {
        Some((line, ..)) => {
            Err(Entry { line: *line, text: lines[*line - 1], remedy }.quoted("this is no acceleration:"))
        }
        None => Ok(()),
    }
}

/// Half a unit of the last printed digit.
fn half_digit(value: &str) -> f64 {
    let decimals = value.split_once('.').map_or(0, |(_, rest)| rest.bytes().take_while(u8::is_ascii_digit).count());
    0.5 * 0.1_f64.powi(decimals as i32)
}

/// Response spectra have the same header and rows of period and ordinate; histories have one number a row.
fn refuse_spectrum(lines: &[&str], first: usize) -> Result<(), RecordError> {
    // A comma would make two columns of one.
    if let Some(text) = lines.get(first).map(|line| line.trim()).filter(|row| has_decimal_comma(row)) {
        return Err(comma_refused(first + 1, Word { column: 1, text }));
    }
    let mut rows = lines[first..].iter().map(|line| words(line).count()).filter(|columns| *columns > 0).peekable();
    if rows.peek().is_some() && rows.all(|columns| columns == 2) {
        let remedy = "use the acceleration file (.ACC) of the same record";
        let problem = "rows of two columns: a response spectrum, not an acceleration history";
        return Err(Entry { line: first + 1, text: "", remedy }.wrong(problem));
    }
    Ok(())
}
