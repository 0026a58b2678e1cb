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
//! colon parts key and value.

use super::numbers::{Block, is_text, words};
use super::{
    Format, RecordFile, agreed_dt, agreed_unit, brief, largest, leading_number, positive_dt, tidy, whole_count,
};
use crate::{AccelerationUnit, RecordError, TextOptions};

/// Lines among which the keys are sought.
const HEADER_LINES: usize = 200;

/// Relative difference of the samples' peak and the stated one: up to the first both are rounded alike, up to the second
/// something small was done to the samples, beyond it the file is damaged or its unit is not the one stated.
const PEAK_DIFFERENCE: [f64; 2] = [1e-3, 1e-2];

/// Whether these are the lines of such a file.
pub fn is_one(lines: &[&str]) -> bool {
    let header = Header::of(lines);
    KEYS.iter().filter(|key| header.find(key).is_some()).count() >= 2
}

/// Keys of which a header has two at least, whatever it has lost.
const KEYS: [&str; 7] =
    ["SAMPLING_INTERVAL_S", "NDATA", "STREAM", "HEADER_FORMAT", "DATA_TYPE", "EVENT_ID", "STATION_CODE"];

/// `KEY: value` lines.
struct Header<'t> {
    /// Line from 1, key in capitals, value.
    entries: Vec<(usize, String, &'t str)>,
    /// The line after it, from 0.
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

    fn text(&self, keys: &[&str]) -> String {
        keys.iter().find_map(|key| self.find(key)).map(|(_, value)| tidy(value)).unwrap_or_default()
    }
}

/// Reads it.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let header = Header::of(lines);
    let wrong = |line: usize, problem: String, remedy: &'static str| RecordError::Header { line, problem, remedy };
    if let Some((line, kind)) = header.find("DATA_TYPE") {
        let upper = kind.to_ascii_uppercase();
        if upper.contains("SPECTR") || upper.contains("VELOCITY") || upper.contains("DISPLACEMENT") {
            let problem = format!("this is no acceleration history: `{}`", brief(kind));
            return Err(wrong(line, problem, "use the acceleration file (.ACC) of the same record"));
        }
    }
    refuse_spectrum(lines, header.end)?;
    let remedy = "give it as `SAMPLING_INTERVAL_S: 0.005` and `NDATA: 4000`";
    let place = header.end.max(1);
    let (dt_line, dt) = header
        .find("SAMPLING_INTERVAL_S")
        .ok_or_else(|| wrong(place, "SAMPLING_INTERVAL_S is missing".into(), remedy))?;
    let dt = agreed_dt(positive_dt(leading_number(dt), dt_line, lines[dt_line - 1], remedy)?, dt_line, options)?;
    let (count_line, count) = header.find("NDATA").ok_or_else(|| wrong(place, "NDATA is missing".into(), remedy))?;
    let declared = whole_count(leading_number(count), count_line, lines[count_line - 1], remedy)?;
    let unit = match header.find("UNITS").or_else(|| header.find("UNIT")) {
        None => options.units.unwrap_or(AccelerationUnit::CentimetrePerSecondSquared),
        Some((line, name)) => match AccelerationUnit::parse(name) {
            Some(unit) => agreed_unit(unit, line, options)?,
            None => {
                let problem = format!("`{}` is no unit of acceleration that is known", brief(name));
                return Err(wrong(line, problem, "use the acceleration file (.ACC), in cm/s^2, of the same record"));
            }
        },
    };
    let block = Block {
        lines,
        span: (header.end, lines.len()),
        declared: Some(declared),
        header: (count_line, "NDATA"),
        layout: None,
        lenient: options.lenient,
    };
    let samples = block.read()?;
    let mut warnings = samples.warnings;
    let scale = unit.in_si(options.gravity);
    let accel: Vec<f64> = samples.values.iter().map(|value| value * scale).collect();
    let stated = header.entries.iter().find(|(_, key, _)| key.starts_with("PGA_"));
    let stated = stated.and_then(|(line, key, value)| {
        let unit = AccelerationUnit::parse(&key["PGA_".len()..])?;
        let stated = leading_number(value)?.abs();
        let (scale, rounding) = (unit.in_si(options.gravity), rounding(value));
        (stated > 0.0).then_some((*line, stated * scale, rounding * scale))
    });
    if let Some((line, stated, rounding)) = stated {
        let found = largest(&accel);
        let difference = ((found - stated).abs() - rounding) / found.max(stated);
        if difference > PEAK_DIFFERENCE[1] && !options.lenient {
            return Err(RecordError::Peak { line, stated, found });
        }
        if difference > PEAK_DIFFERENCE[0] {
            warnings.push(format!("the samples' peak is {found:.6} m/s² and line {line} states {stated:.6} m/s²"));
        }
    }
    let network = header.text(&["NETWORK"]);
    let code = header.text(&["STATION_CODE", "STATION_ID"]);
    let name = header.text(&["STATION_NAME"]);
    let code = if network.is_empty() || code.is_empty() { code } else { format!("{network}.{code}") };
    let station = if name.is_empty() || code.is_empty() { format!("{code}{name}") } else { format!("{code} ({name})") };
    let component = header.text(&["STREAM"]);
    Ok(RecordFile {
        format: Format::Dyna,
        title: tidy(&format!(
            "{} {} {}",
            header.text(&["EVENT_NAME"]),
            header.text(&["EVENT_ID"]),
            header.text(&["EVENT_DATE_YYYYMMDD"])
        )),
        station,
        component: component.clone(),
        unit,
        declared: Some(declared),
        dt,
        accel,
        stated_peak: stated.map(|(_, peak, _)| peak),
        channels: vec![if component.is_empty() { "1".into() } else { format!("1: {component}") }],
        warnings,
    })
}

/// Half of the last printed digit's place.
fn rounding(value: &str) -> f64 {
    let decimals = value.split_once('.').map_or(0, |(_, rest)| rest.bytes().take_while(u8::is_ascii_digit).count());
    0.5 * 0.1_f64.powi(decimals as i32)
}

/// Response spectra have the same header and rows of period and ordinate; histories have one number a row.
fn refuse_spectrum(lines: &[&str], first: usize) -> Result<(), RecordError> {
    let mut rows = lines[first..].iter().map(|line| words(line).count()).filter(|columns| *columns > 0).peekable();
    if rows.peek().is_some() && rows.all(|columns| columns == 2) {
        return Err(RecordError::Header {
            line: first + 1,
            problem: "rows of two columns: a response spectrum, not an acceleration history".into(),
            remedy: "use the acceleration file (.ACC) of the same record",
        });
    }
    Ok(())
}
