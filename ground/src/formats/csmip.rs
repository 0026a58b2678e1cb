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
//! The line before the samples states all that is needed to read the numbers. It is found by its words, since headers of some years have a
//! line more or less. Velocity and displacement are not read.

use super::header::{ChannelName, Entry, after, choose, leading_number, number_after, tidy};
use super::numbers::{Block, FixedWidth, number};
use super::record_file::{Format, PeakBounds, RecordFile, StatedPeak};
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::unit::AccelerationUnit;

/// Lines of reals before the samples.
const REAL_LINES: usize = 13;

/// Columns of the real header, the block of real numbers above the samples, and of the samples if the line before the samples does not state them.
const COLUMNS: FixedWidth = FixedWidth(10);

/// Headers round the peak to three digits.
const PEAK: PeakBounds = PeakBounds { rounding: 5e-3, damage: 0.1 };

/// Sampling intervals of accelerographs `[s]`. A value outside this range at the place [`REAL_DT`] shows that the header has another layout; it is ignored.
const INTERVALS: std::ops::RangeInclusive<f64> = 1e-3..=0.1;

/// Place of the sampling interval in the real header, from 0.
const REAL_DT: usize = 60;

/// Whether these are the lines of a CSMIP file.
pub fn is_one(lines: &[&str]) -> bool {
    let mut first = lines.iter().filter(|line| !line.trim().is_empty()).take(3);
    first.any(|line| volume(line).is_some()) || lines.iter().any(|line| announces(line) == Some(Quantity::Acceleration))
}

/// The volume that a title names: 1 uncorrected, 2 corrected, 3 spectra. It is `None` for any other line.
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
enum Quantity {
    Acceleration,
    Other,
}

/// The quantity of the samples that a line announces: `4000 points of accel data equally spaced at ...`. It is `None` for any other line.
fn announces(line: &str) -> Option<Quantity> {
    let lower = line.to_ascii_lowercase();
    let (_, kind) = lower.split_once("points of ")?;
    if !(kind.contains("spaced") || kind.contains("data")) {
        return None;
    }
    Some(if kind.trim_start().starts_with("acc") { Quantity::Acceleration } else { Quantity::Other })
}

/// A channel of the file. Lines are counted from 0.
struct Channel<'t> {
    /// Lines of the header of the channel.
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
            let Some(quantity) = announces(line) else { continue };
            last_series = Some(index);
            if quantity == Quantity::Acceleration {
                let ends = |line: &&str| {
                    announces(line).is_some() || line.trim_start().starts_with("/&") || volume(line).is_some()
                };
                let end = lines[index + 1..].iter().position(ends).map_or(lines.len(), |after| index + 1 + after);
                channels.push(Channel { text: &lines[begin..index], announced: index, end });
                begin = index + 1;
            }
        }
        channels
    }

    /// `Chan  1:  90 Deg`: number and direction.
    fn name(&self) -> ChannelName {
        let name = self.text.iter().find_map(|line| {
            let rest = after(line, "chan")?.trim_start_matches(['n', 'N', 'e', 'E', 'l', 'L', '.', ' ']);
            let (number, direction) = rest.split_once(':')?;
            // Several blanks separate further entries of the line.
            let direction = direction.trim_start().split("   ").next().unwrap_or("");
            Some((Some(number.trim().parse().ok()?), tidy(direction)))
        });
        name.unwrap_or_default()
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
        let mut lines = self.text.iter();
        let Some(rest) = lines.find_map(|line| after(line, "station no")) else { return String::new() };
        let number = rest.trim_start_matches(['.', ':', ' ']).split_whitespace().next().unwrap_or("");
        let name = lines.next().and_then(|below| below.trim().split("   ").next()).unwrap_or("");
        tidy(&format!("{number} {name}"))
    }

    /// The sampling interval of the real header `[s]`.
    fn header_dt(&self) -> Option<f64> {
        let from = self.text.len().checked_sub(REAL_LINES)?;
        let reals = self.text[from..].iter().map(|line| COLUMNS.row(line, 0).ok()).collect::<Option<Vec<_>>>()?;
        reals.concat().get(REAL_DT).copied()
    }
}

/// Reads a CSMIP file.
pub fn read(lines: &[&str], options: &TextOptions) -> Result<RecordFile, RecordError> {
    let title = lines.iter().position(|line| !line.trim().is_empty()).unwrap_or(0);
    let text = lines.get(title).copied().unwrap_or("");
    let entry = |remedy: &'static str| Entry { line: title + 1, text, remedy };
    let remedy = "use the volume 2 file (.V2) of the same record";
    match volume(text) {
        // A file with velocities is of volume 2, whatever its first line says.
        Some(1) if !lines.iter().any(|line| announces(line) == Some(Quantity::Other)) => {
            return Err(entry(remedy).quoted("a volume 1 file holds the uncorrected accelerogram:"));
        }
        Some(3) => return Err(entry(remedy).quoted("a volume 3 file holds spectra:")),
        _ => {}
    }
    let channels = Channel::all(lines);
    if channels.is_empty() {
        let problem = "there is no line `... points of accel data equally spaced at ... sec`:";
        return Err(entry("use a volume 2 file (.V2) with accelerations").quoted(problem));
    }
    let names: Vec<ChannelName> = channels.iter().map(Channel::name).collect();
    let mut warnings = Vec::new();
    let (chosen, labels) = choose(&names, options, &mut warnings)?;
    let channel = &channels[chosen];

    let announced = lines[channel.announced];
    let remedy = "write it as `4000 points of accel data equally spaced at .005 sec, in cm/sec2. (8f10.6)`";
    let entry = Entry { line: channel.announced + 1, text: announced, remedy };
    let declared = Some(entry.count(announced.split_whitespace().next().and_then(number))?);
    let dt = interval(channel, &entry, options, &mut warnings)?;
    let unit = match unit_name(announced) {
        None => options.units.unwrap_or(AccelerationUnit::CentimetrePerSecondSquared),
        Some(name) => Entry { remedy: "convert the samples to cm/sec2 or g", ..entry }.unit(name, options)?,
    };
    let (span, header) = ((channel.announced + 1, channel.end), (entry.line, "points of accel data"));
    let columns = FixedWidth::find(announced).or(Some(COLUMNS));
    let mut samples = Block { lines, span, declared, header, columns, lenient: options.lenient }.read()?;
    warnings.append(&mut samples.warnings);
    samples.warnings = warnings;
    let mut file = RecordFile::of(Format::Csmip, unit, unit.in_si(options.gravity), dt, samples);
    let header = channel.announced - channel.text.len();
    let peak = channel.text.iter().enumerate().find_map(|(index, line)| {
        let rest = after(line, "peak acceleration")?.trim_start().trim_start_matches('=');
        let unit = rest.split_whitespace().nth(1).and_then(AccelerationUnit::parse)?;
        let size = leading_number(rest)? * unit.in_si(options.gravity);
        Some(StatedPeak { line: header + index + 1, size, half_digit: 0.0 })
    });
    file.compare_peak(peak, PEAK, options.lenient)?;
    let (station, component) = (channel.station(), names[chosen].1.clone());
    Ok(RecordFile { title: channel.event(), station, component, declared, channels: labels, ..file })
}

/// The sampling interval `[s]` of the line before the samples, else that of the real header. Two that differ are an error unless `lenient`.
fn interval(
    channel: &Channel,
    announced: &Entry,
    options: &TextOptions,
    warnings: &mut Vec<String>,
) -> Result<f64, RecordError> {
    let (stated, real) = (number_after(announced.text, "SPACED AT"), channel.header_dt());
    let dt = announced.interval(stated.or(real), options)?;
    if let Some(other) = real.filter(|real| INTERVALS.contains(real) && (real - dt).abs() > 1e-3 * dt) {
        let problem = format!("the sampling interval is {dt} s here and {other} s in the real header");
        if !options.lenient {
            return Err(
                Entry { remedy: "mend the wrong one, or take this one with `lenient`", ..*announced }.wrong(problem)
            );
        }
        warnings.push(format!("line {}: {problem}; {dt} s is taken", announced.line));
    }
    Ok(dt)
}

/// The unit after `units:` or the last `in`: `.005 sec, in cm/sec2. (8f10.6)`.
fn unit_name(announced: &str) -> Option<&str> {
    let lower = announced.to_ascii_lowercase();
    let after = |word: &str| lower.rfind(word).map(|at| &announced[at + word.len()..]);
    let rest = after("units:").or_else(|| after(" in ")).or_else(|| after(",in "))?.trim_start();
    let rest = rest.strip_prefix("units of").unwrap_or(rest).trim_start();
    let name = rest.split(['(', ')', ',', ';']).next().unwrap_or("").trim();
    // A descriptor may follow without brackets: `in cm/sec2. 8F10.3`.
    let word = name.split_whitespace().next()?.trim_end_matches('.');
    Some(if AccelerationUnit::parse(word).is_some() { word } else { name })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_samples_name_their_unit() {
        for (line, unit) in [
            ("4000 points of accel data equally spaced at .005 sec, in cm/sec2. (8f10.6)", Some("cm/sec2")),
            ("3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)", Some("CM/SEC/SEC")),
            ("3251 points of accel data equally spaced at .020 sec. (units: g)", Some("g")),
            ("3251 points of accel data equally spaced at .020 sec.", None),
        ] {
            assert_eq!(unit_name(line), unit, "{line}");
        }
    }
}
