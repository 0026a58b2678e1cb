//! CSMIP volume 2: corrected records of California's strong-motion programme, one channel after the other.
//!
//! ```text
//! CORRECTED ACCELEROGRAM ...                       25 lines of text
//! ...                                              7 lines of integers (16I5), 13 of reals (8F10), which may touch
//!  4000 points of accel data equally spaced at 0.005 sec, in cm/sec2. (8f10.6)
//!   -.012345   .023456 ...
//!  4000 points of veloc data ...
//! /&  ---------- End of data for channel  1 ----------
//! ```
//!
//! The line before the samples says all that is needed of the numbers; it is sought, since headers of some years have a line
//! more or less. Velocity and displacement are not read.

use super::numbers::{Block, Layout, number};
use super::{
    Format, PEAK_ROUNDING, RecordFile, agreed_dt, agreed_unit, brief, choose, leading_number, number_after,
    peak_warning, positive_dt, tidy, whole_count,
};
use crate::{AccelerationUnit, RecordError, TextOptions};

/// Lines of reals before the samples, and their columns.
const REALS: (usize, Layout) = (13, Layout { per_row: 8, width: 10 });

/// Place of the sampling interval among the reals, from 0.
const REAL_DT: usize = 60;

/// Columns of samples where the line before them does not say.
const LAYOUT: Layout = Layout { per_row: 8, width: 10 };

/// Whether these are the lines of such a file.
pub fn is_one(lines: &[&str]) -> bool {
    let mut first = lines.iter().filter(|line| !line.trim().is_empty()).take(3);
    first.any(|line| volume(line).is_some()) || lines.iter().any(|line| series(line) == Some(Series::Acceleration))
}

/// What a title says of the file: 1 uncorrected, 2 corrected, 3 spectra.
fn volume(line: &str) -> Option<u8> {
    let upper = line.to_ascii_uppercase();
    if upper.contains("UNCORRECTED ACCELEROGRAM") {
        Some(1)
    } else if upper.contains("CORRECTED ACCELEROGRAM") {
        Some(2)
    } else if upper.contains("RESPONSE AND FOURIER AMPLITUDE SPECTRA") {
        Some(3)
    } else {
        None
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Series {
    Acceleration,
    Other,
}

/// What a line announces: `4000 points of accel data equally spaced at ...`.
fn series(line: &str) -> Option<Series> {
    let lower = line.to_ascii_lowercase();
    let (_, kind) = lower.split_once("points of ")?;
    if !(kind.contains("spaced") || kind.contains("data")) {
        return None;
    }
    Some(if kind.trim_start().starts_with("acc") { Series::Acceleration } else { Series::Other })
}

/// A channel of the file, lines from 0.
struct Channel<'t> {
    /// Its header.
    text: &'t [&'t str],
    /// The line before its samples.
    announced: usize,
    /// The line after its samples.
    end: usize,
}

impl<'t> Channel<'t> {
    /// All channels of a file.
    fn all(lines: &'t [&'t str]) -> Vec<Channel<'t>> {
        let mut channels = Vec::new();
        let (mut begin, mut last_series) = (0, None);
        for (index, line) in lines.iter().enumerate() {
            if line.trim_start().starts_with("/&") {
                begin = index + 1;
                continue;
            }
            if volume(line).is_some() && last_series >= Some(begin) {
                // The line that ends a channel is missing, and the next header begins.
                begin = index;
            }
            if series(line).is_some() {
                last_series = Some(index);
            }
            if series(line) == Some(Series::Acceleration) {
                let ends = |line: &&str| {
                    series(line).is_some() || line.trim_start().starts_with("/&") || volume(line).is_some()
                };
                let end = lines[index + 1..].iter().position(ends).map_or(lines.len(), |after| index + 1 + after);
                channels.push(Channel { text: &lines[begin..index], announced: index, end });
            }
        }
        channels
    }

    /// The line of the header in which a word stands, and what follows it.
    fn after(&self, words: &str) -> Option<(&'t str, &'t str)> {
        self.text.iter().find_map(|line| {
            // ASCII capitals keep the places of all bytes.
            let at = line.to_ascii_lowercase().find(words)?;
            Some((*line, &line[at + words.len()..]))
        })
    }

    /// `Chan  1:  90 Deg`: number and direction.
    fn name(&self) -> (Option<usize>, String) {
        let after = |(_, rest): (&str, &'t str)| {
            let rest = rest.trim_start_matches(['n', 'N', 'e', 'E', 'l', 'L', '.', ' ']);
            let (number, direction) = rest.split_once(':')?;
            let number = number.trim().parse().ok()?;
            // Further entries of the line are parted by several blanks.
            let direction = direction.trim_start().split("   ").next().unwrap_or("");
            Some((number, tidy(direction)))
        };
        let lines = self.text.iter().filter_map(|line| {
            let at = line.to_ascii_lowercase().find("chan")?;
            after((line, &line[at + "chan".len()..]))
        });
        lines.map(|(number, direction)| (Some(number), direction)).next().unwrap_or_default()
    }

    /// `Loma Prieta Earthquake`.
    fn event(&self) -> String {
        let event = self.text.iter().find(|line| {
            let lower = line.to_ascii_lowercase();
            lower.contains("earthquake") && volume(line).is_none()
        });
        event.map(|line| tidy(line)).unwrap_or_default()
    }

    /// `Station No. 24436   34.160N, 118.534W` and, in the line below, its name.
    fn station(&self) -> String {
        let Some(at) = self.text.iter().position(|line| line.to_ascii_lowercase().contains("station no")) else {
            return String::new();
        };
        let lower = self.text[at].to_ascii_lowercase();
        let place = lower.find("station no").map_or(0, |place| place + "station no".len());
        let number = self.text[at][place..].trim_start_matches(['.', ':', ' ']).split_whitespace().next().unwrap_or("");
        let below = self.text.get(at + 1).map_or("", |line| line.trim());
        let name = below.split("   ").next().unwrap_or("");
        tidy(&format!("{number} {name}"))
    }

    /// The sampling interval of the real header `[s]`.
    fn header_dt(&self) -> Option<f64> {
        let from = self.text.len().checked_sub(REALS.0)?;
        let reals = self.text[from..].iter().map(|line| REALS.1.row(line, 0).ok()).collect::<Option<Vec<_>>>()?;
        reals.concat().get(REAL_DT).copied()
    }
}

/// Reads it.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let title = lines.iter().position(|line| !line.trim().is_empty()).unwrap_or(0);
    let refuse = |problem: &str, remedy: &'static str| RecordError::Header {
        line: title + 1,
        problem: format!("{problem}: `{}`", brief(lines.get(title).copied().unwrap_or(""))),
        remedy,
    };
    // Only volume 2 has velocities, whatever its first line says.
    let corrected = lines.iter().any(|line| series(line) == Some(Series::Other));
    match lines.get(title).and_then(|line| volume(line)) {
        Some(1) if !corrected => {
            return Err(refuse(
                "a volume 1 file holds the uncorrected accelerogram",
                "use the volume 2 file (.V2) of the same record",
            ));
        }
        Some(3) => {
            return Err(refuse("a volume 3 file holds spectra", "use the volume 2 file (.V2) of the same record"));
        }
        _ => {}
    }
    let channels = Channel::all(lines);
    if channels.is_empty() {
        return Err(refuse(
            "there is no line `... points of accel data equally spaced at ... sec`",
            "use a volume 2 file (.V2) with accelerations",
        ));
    }
    let names: Vec<(Option<usize>, String)> = channels.iter().map(Channel::name).collect();
    let mut warnings = Vec::new();
    let (chosen, labels) = choose(&names, options, &mut warnings)?;
    let channel = &channels[chosen];

    let (line, announced) = (channel.announced + 1, lines[channel.announced]);
    let remedy = "write it as `4000 points of accel data equally spaced at .005 sec, in cm/sec2. (8f10.6)`";
    let declared = whole_count(announced.split_whitespace().next().and_then(number), line, announced, remedy)?;
    let dt = number_after(announced, "SPACED AT").or_else(|| channel.header_dt());
    let dt = agreed_dt(positive_dt(dt, line, announced, remedy)?, line, options)?;
    let unit = match unit(announced) {
        Unit::Silent => options.units.unwrap_or(AccelerationUnit::CentimetrePerSecondSquared),
        Unit::Known(unit) => agreed_unit(unit, line, options)?,
        Unit::Unknown(name) => {
            let problem = format!("`{name}` is no unit of acceleration that is known");
            return Err(RecordError::Header { line, problem, remedy: "convert the samples to cm/sec2 or g" });
        }
    };
    let block = Block {
        lines,
        span: (channel.announced + 1, channel.end),
        declared: Some(declared),
        header: (line, "points of accel data"),
        layout: Layout::find(announced).or(Some(LAYOUT)),
        lenient: options.lenient,
    };
    let samples = block.read()?;
    let scale = unit.in_si(options.gravity);
    let accel: Vec<f64> = samples.values.iter().map(|value| value * scale).collect();
    warnings.extend(samples.warnings);
    let stated = channel.after("peak acceleration").and_then(|(line, rest)| {
        let rest = rest.trim_start().trim_start_matches('=');
        let value = leading_number(rest)?.abs();
        let unit = rest.split_whitespace().nth(1).and_then(AccelerationUnit::parse)?;
        let place = lines.iter().position(|other| std::ptr::eq(*other, line)).map_or(0, |index| index + 1);
        Some((place, value * unit.in_si(options.gravity)))
    });
    let peak = stated.map(|(_, peak)| peak).filter(|peak| *peak > 0.0);
    warnings.extend(peak_warning(&accel, peak, stated.map_or(0, |(line, _)| line), PEAK_ROUNDING));
    Ok(RecordFile {
        format: Format::Csmip,
        title: channel.event(),
        station: channel.station(),
        component: names[chosen].1.clone(),
        unit,
        declared: Some(declared),
        dt,
        accel,
        stated_peak: peak,
        channels: labels,
        warnings,
    })
}

enum Unit<'t> {
    Silent,
    Known(AccelerationUnit),
    Unknown(&'t str),
}

/// The unit after the last `in`: `.005 sec, in cm/sec2. (8f10.6)`.
fn unit(announced: &str) -> Unit<'_> {
    let lower = announced.to_ascii_lowercase();
    let Some(at) = lower.rfind(" in ").or_else(|| lower.rfind(",in ")) else { return Unit::Silent };
    let rest = &announced[at + " in ".len()..];
    let rest = rest.trim_start().strip_prefix("units of").unwrap_or(rest).trim_start();
    let name = rest.split(['(', ',', ';']).next().unwrap_or("").trim();
    // A descriptor may follow without brackets: `in cm/sec2. 8F10.3`.
    let word = name.split_whitespace().next().unwrap_or("").trim_end_matches('.');
    match AccelerationUnit::parse(name).or_else(|| AccelerationUnit::parse(word)) {
        Some(unit) => Unit::Known(unit),
        None if name.is_empty() => Unit::Silent,
        None => Unit::Unknown(name),
    }
}
