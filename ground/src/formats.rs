//! Record files of the formats in use, told apart by what stands in them, never by their names.
//!
//! Every format has a file of its own with the layout in its first lines. They share the lexer ([`numbers`]), the rules on
//! counts and units, and what they hand out: a [`RecordFile`], which says what was understood.

mod cosmos;
mod csmip;
mod dyna;
mod knet;
mod numbers;
mod peer;
mod table;

use crate::record::{Record, RecordError, Source, TextOptions};
use crate::unit::AccelerationUnit;
use serde::Serialize;
use std::fmt;

/// Format of a record file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// PEER, `.AT2`
    PeerAt2,
    /// ESM and ITACA, `.ASC`
    Dyna,
    /// NIED: K-NET `.EW`, `.NS`, `.UD`; KiK-net `.EW1` .. `.UD2`
    KNet,
    /// California Strong Motion Instrumentation Program, volume 2
    Csmip,
    /// Consortium of Organizations for Strong Motion Observation Systems, V1.20
    Cosmos,
    /// Text or CSV: columns of numbers
    Table,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Format::PeerAt2 => "PEER AT2",
            Format::Dyna => "ESM/ITACA DYNA",
            Format::KNet => "K-NET/KiK-net",
            Format::Csmip => "CSMIP V2",
            Format::Cosmos => "COSMOS V2",
            Format::Table => "text table",
        })
    }
}

/// What a record file says.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordFile {
    /// Its format.
    pub format: Format,
    /// Event or title; empty where the file is silent.
    pub title: String,
    /// Station; empty where the file is silent.
    pub station: String,
    /// Direction of the component, as the file names it; empty where it is silent.
    pub component: String,
    /// Unit of the accelerations in the file.
    pub unit: AccelerationUnit,
    /// Number of samples that its header declares.
    pub declared: Option<usize>,
    /// Sampling interval `[s]`.
    pub dt: f64,
    /// Accelerations `[m/s²]`.
    pub accel: Vec<f64>,
    /// Size of the peak acceleration that its header states `[m/s²]`.
    pub stated_peak: Option<f64>,
    /// What channels the file has, in its order: number and direction. One where the format knows no channels.
    pub channels: Vec<String>,
    /// What the user should know of it, a sentence each.
    pub warnings: Vec<String>,
}

impl RecordFile {
    /// Reads a record file of any known format.
    ///
    /// # Errors
    /// [`RecordError`], with line and column where there is one.
    ///
    /// ```
    /// use rocking_ground::{Format, RecordFile, TextOptions};
    /// let text = b"t [s], a [m/s2]\n0, 0.5\n0.02, -1.5\n0.04, 0.25\n";
    /// let file = RecordFile::read(text, &TextOptions::default())?;
    /// assert_eq!((file.format, file.dt, file.accel), (Format::Table, 0.02, vec![0.5, -1.5, 0.25]));
    /// # Ok::<(), rocking_ground::RecordError>(())
    /// ```
    pub fn read(bytes: &[u8], options: &TextOptions) -> Result<RecordFile, RecordError> {
        let text = decode(bytes)?;
        let lines = lines(&text);
        let file = match recognise(&lines) {
            Format::PeerAt2 => peer::read(&lines, options),
            Format::Dyna => dyna::read(&lines, options),
            Format::KNet => knet::read(&lines, options),
            Format::Csmip => csmip::read(&lines, options),
            Format::Cosmos => cosmos::read(&lines, options),
            Format::Table if text.contains('\0') => Err(RecordError::NoText { kind: "binary" }),
            Format::Table => table::read(&lines, options),
        }?;
        file.of_one_channel(options)
    }

    /// The record of these samples, which remembers where it came from.
    ///
    /// # Errors
    /// [`RecordError`] if there are fewer than two samples or a number is not finite.
    pub fn into_record(self) -> Result<Record, RecordError> {
        let source =
            Source { file: String::new(), title: self.title, station: self.station, component: self.component };
        Ok(Record::new(self.accel, self.dt, 0.0)?.with_source(source, self.warnings))
    }

    /// Refuses another channel than the only one.
    fn of_one_channel(self, options: &TextOptions) -> Result<RecordFile, RecordError> {
        match options.channel {
            Some(channel) if self.channels.len() == 1 && channel != 1 && !self.format.has_channels() => {
                Err(RecordError::NoChannel { channel, known: self.channels.join(", ") })
            }
            _ => Ok(self),
        }
    }
}

impl Format {
    /// Whether a file of it may hold several channels.
    pub fn has_channels(self) -> bool {
        matches!(self, Format::Csmip | Format::Cosmos)
    }
}

/// The format of a file, by its content.
fn recognise(lines: &[&str]) -> Format {
    if cosmos::is_one(lines) {
        Format::Cosmos
    } else if csmip::is_one(lines) {
        Format::Csmip
    } else if knet::is_one(lines) {
        Format::KNet
    } else if dyna::is_one(lines) {
        Format::Dyna
    } else if peer::is_one(lines) {
        Format::PeerAt2
    } else {
        Format::Table
    }
}

/// The text of a file: UTF-8, UTF-16, or else Latin-1, in which every byte is a character.
fn decode(bytes: &[u8]) -> Result<String, RecordError> {
    let sixteen = |bytes: &[u8], from: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.chunks_exact(2).map(|pair| from([pair[0], pair[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    let text = match bytes {
        [b'P', b'K', 3, 4, ..] => return Err(RecordError::NoText { kind: "a ZIP archive or a spreadsheet" }),
        [0x1f, 0x8b, ..] => return Err(RecordError::NoText { kind: "compressed (gzip)" }),
        [0xff, 0xfe, text @ ..] => sixteen(text, u16::from_le_bytes),
        [0xfe, 0xff, text @ ..] => sixteen(text, u16::from_be_bytes),
        // Without its mark, UTF-16 has zeros for the upper halves of plain letters.
        [1..=255, 0, 1..=255, 0, ..] => sixteen(bytes, u16::from_le_bytes),
        [0, 1..=255, 0, 1..=255, ..] => sixteen(bytes, u16::from_be_bytes),
        _ => match std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)) {
            Ok(text) => text.to_string(),
            Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
        },
    };
    // Old files end with Ctrl-Z, cut ones with zeros.
    Ok(text.trim_end_matches(['\u{1a}', '\0']).to_string())
}

/// The lines of a text that ends them with LF, CRLF, or CR alone.
fn lines(text: &str) -> Vec<&str> {
    if text.contains('\n') {
        text.lines().map(|line| line.trim_end_matches('\r')).collect()
    } else {
        text.split('\r').collect()
    }
}

/// A file's sampling interval, which the user may repeat but not contradict.
fn agreed_dt(dt: f64, line: usize, options: &TextOptions) -> Result<f64, RecordError> {
    match options.dt {
        Some(own) if (own - dt).abs() > 1e-9 * dt.abs() => {
            Err(RecordError::Contradiction { key: "dt", given: format!("{own} s"), line, file: format!("{dt} s") })
        }
        _ => Ok(dt),
    }
}

/// A file's unit, which the user may repeat but not contradict.
fn agreed_unit(unit: AccelerationUnit, line: usize, options: &TextOptions) -> Result<AccelerationUnit, RecordError> {
    match options.units {
        Some(own) if own != unit => {
            Err(RecordError::Contradiction { key: "units", given: own.to_string(), line, file: unit.to_string() })
        }
        _ => Ok(unit),
    }
}

/// A sampling interval above zero, or the error that `line` does not give one.
fn positive_dt(dt: Option<f64>, line: usize, quote: &str, remedy: &'static str) -> Result<f64, RecordError> {
    dt.filter(|dt| *dt > 0.0).ok_or_else(|| RecordError::Header {
        line,
        problem: format!("no sampling interval above zero in `{}`", brief(quote)),
        remedy,
    })
}

/// A count of samples, or the error that `line` does not give one.
fn whole_count(count: Option<f64>, line: usize, quote: &str, remedy: &'static str) -> Result<usize, RecordError> {
    let sound = count.filter(|count| *count >= 1.0 && count.fract() == 0.0 && *count <= MOST_SAMPLES);
    sound.map(|count| count as usize).ok_or_else(|| RecordError::Header {
        line,
        problem: format!("no whole number of samples in `{}`", brief(quote)),
        remedy,
    })
}

/// Samples beyond which a count is a misread header: four months at 100 Hz.
const MOST_SAMPLES: f64 = 1e9;

/// A line as an error quotes it.
fn brief(line: &str) -> String {
    line.trim().chars().take(80).collect()
}

/// Text without blanks at its ends and with single ones inside.
fn tidy(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The number after `key` in a line, with `=`, `:` or blanks between; a unit may touch it (`.01SEC`, `100Hz`).
fn number_after(line: &str, key: &str) -> Option<f64> {
    let upper = line.to_ascii_uppercase();
    let at = upper.match_indices(key).find(|(at, _)| !upper[..*at].ends_with(|c: char| c.is_ascii_alphanumeric()))?.0;
    let rest = upper[at + key.len()..].trim_start().trim_start_matches(['=', ':']).trim_start();
    leading_number(rest)
}

/// The number that a text begins with; a unit may touch it.
fn leading_number(text: &str) -> Option<f64> {
    let word = numbers::words(text).next()?.text;
    numbers::number(word).or_else(|| {
        let end = word.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c))).unwrap_or(word.len());
        numbers::number(&word[..end])
    })
}

/// The largest size of the samples.
fn largest(accel: &[f64]) -> f64 {
    accel.iter().fold(0.0, |peak, a| peak.max(a.abs()))
}

/// How far the peak of the samples may be, relatively, from what a header states before the user is told: headers round to
/// three digits.
const PEAK_ROUNDING: f64 = 5e-3;

/// The sentence that the samples' peak is not the header's, by more than the share `allowed`. Both `[m/s²]`.
fn peak_warning(accel: &[f64], stated: Option<f64>, line: usize, allowed: f64) -> Option<String> {
    let (stated, found) = (stated?, largest(accel));
    let differs = (found - stated).abs() > allowed * found.max(stated);
    differs.then(|| {
        format!("the samples' peak is {found:.6} m/s² and line {line} states {stated:.6} m/s²; is the file whole?")
    })
}

/// The channel that the user chose, by the number that the file gives it or else by its place, and the labels of all channels; the
/// first where nothing is chosen, and told so where there are several. `channels` are numbers and directions.
fn choose(
    channels: &[(Option<usize>, String)],
    options: &TextOptions,
    warnings: &mut Vec<String>,
) -> Result<(usize, Vec<String>), RecordError> {
    let label = |(place, (number, direction)): (usize, &(Option<usize>, String))| {
        tidy(&format!("{}: {direction}", number.unwrap_or(place + 1))).trim_end_matches(':').to_string()
    };
    let names: Vec<String> = channels.iter().enumerate().map(label).collect();
    let known = || names.join(", ");
    let chosen = match options.channel {
        None => {
            if names.len() > 1 {
                warnings.push(format!(
                    "the file has {} channels ({}) and the first one is read; choose another with `channel`",
                    names.len(),
                    known()
                ));
            }
            0
        }
        Some(channel) => channels
            .iter()
            .position(|(number, _)| *number == Some(channel))
            .or_else(|| channel.checked_sub(1).filter(|place| *place < names.len()))
            .ok_or_else(|| RecordError::NoChannel { channel, known: known() })?,
    };
    Ok((chosen, names))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_read_whatever_its_bytes() {
        for bytes in [
            &b"\xef\xbb\xbf12\n"[..],
            b"\xff\xfe1\x002\x00\n\x00",
            b"1\x002\x00\n\x00",
            b"\x001\x002\x00\n",
            b"12\n\x1a",
        ] {
            assert_eq!(decode(bytes).as_deref(), Ok("12\n"), "{bytes:?}");
        }
        assert_eq!(decode(b"Sa\xf3 1\n").as_deref(), Ok("Saó 1\n"));
        for bytes in [&b"PK\x03\x04..."[..], b"\x1f\x8b\x08"] {
            assert!(matches!(decode(bytes), Err(RecordError::NoText { .. })), "{bytes:?}");
        }
        assert_eq!(lines("a\r\nb\n"), ["a", "b"]);
        assert_eq!(lines("a\rb"), ["a", "b"]);
    }

    #[test]
    fn numbers_after_their_keys() {
        assert_eq!(number_after("NPTS=  4000, DT= .01000 SEC", "NPTS"), Some(4000.0));
        assert_eq!(number_after("BANDWIDTH=3 DT=.01SEC", "DT"), Some(0.01));
        assert_eq!(number_after("dt : 5e-3", "DT"), Some(0.005));
        assert_eq!(number_after("NPTS", "NPTS"), None);
        assert_eq!(leading_number("100Hz"), Some(100.0));
    }
}
