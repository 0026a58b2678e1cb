//! From the bytes of a file to its format's reader. A format is recognised by content, never by the file's name.

use super::header::Entry;
use super::numbers::number;
use super::record_file::{Format, RecordFile};
use super::{cosmos, csmip, dyna, knet, peer, table};
use crate::bounds::{LONGEST_INTERVAL, SHORTEST_INTERVAL};
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::record::{Record, check_range};
use std::borrow::Cow;

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
        let &TextOptions { gravity, dt, .. } = options;
        if !(gravity.is_finite() && gravity > 0.0) {
            return Err(RecordError::Gravity { gravity });
        }
        if let Some(dt) = dt.filter(|dt| !(SHORTEST_INTERVAL..=LONGEST_INTERVAL).contains(dt)) {
            return Err(RecordError::Interval { dt });
        }
        let text = decode(bytes)?;
        // Old files end with Ctrl-Z, files that are cut off may end with zeros.
        let whole = text.trim_end_matches('\u{1a}');
        let text = whole.trim_end_matches(['\u{1a}', '\0']);
        let lines = lines(text);
        if let Some(format) = unknown_format(&lines) {
            return Err(RecordError::UnknownFormat { format });
        }
        let mut file = match recognise(&lines) {
            Format::PeerAt2 => peer::read(&lines, options),
            Format::Dyna => dyna::read(&lines, options),
            Format::KNet => knet::read(&lines, options),
            Format::Csmip => csmip::read(&lines, options),
            Format::Cosmos => cosmos::read(&lines, options),
            Format::Table if text.contains('\0') => Err(RecordError::NoText { kind: "binary" }),
            // Other formats state how many samples there are.
            Format::Table if whole.ends_with('\0') && !lines.is_empty() => {
                let remedy = "fetch or write it again, or cut them off";
                Err(Entry { line: lines.len(), text: "", remedy }
                    .wrong("zero bytes follow this line to the end of the file, which was not written to its end"))
            }
            Format::Table => table::read(&lines, options),
        }?;
        check_range(&file.accel)?;
        file.check_plausibility(options.gravity);
        let of_table = [("column", options.column.is_some()), ("skip_rows", options.skip_rows > 0)];
        if let Some((key, _)) = of_table.into_iter().find(|(_, is_given)| *is_given && file.format != Format::Table) {
            return Err(RecordError::NotOfTable { key, format: file.format.to_string() });
        }
        if file.channels.is_empty() {
            file.channels = vec![if file.component.is_empty() { "1".into() } else { format!("1: {}", file.component) }];
        }
        match options.channel {
            Some(channel) if channel != 1 && !file.format.has_channels() => {
                Err(RecordError::NoChannel { channel, known: file.channels.join(", ") })
            }
            _ => Ok(file),
        }
    }
}

impl Record {
    /// Reads the text of a record file of any format that [`RecordFile`] knows.
    ///
    /// # Errors
    /// [`RecordError`], with line and column.
    pub fn from_text(text: &str, options: TextOptions) -> Result<Record, RecordError> {
        Record::from_bytes(text.as_bytes(), &options)
    }

    /// Reads a record file of any format that [`RecordFile`] knows.
    ///
    /// # Errors
    /// [`RecordError`], with line and column.
    pub fn from_bytes(bytes: &[u8], options: &TextOptions) -> Result<Record, RecordError> {
        RecordFile::read(bytes, options)?.into_record()
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

/// A format that has no reader, but looks like one that has.
fn unknown_format(lines: &[&str]) -> Option<&'static str> {
    let line = |index: usize| lines.get(index).copied().unwrap_or("").trim();
    let first = line(0).to_ascii_lowercase();
    let values: Vec<f64> = line(0).split_whitespace().filter_map(number).collect();
    // Five numbers a row, -12345 for each unknown one.
    let is_sac = values.len() == 5 && (1..SAC_REALS).any(|index| line(index).starts_with("-12345.0"));
    if first.contains("accelerogram") && first.contains("gns science") {
        Some("GeoNet V1A or V2A")
    } else if first.starts_with(|c: char| c.is_ascii_digit()) && line(1) == "*" {
        Some("SMC (USGS)")
    } else if is_sac {
        Some("alphanumeric SAC")
    } else {
        None
    }
}

/// Lines of real numbers at the beginning of an alphanumeric SAC file.
const SAC_REALS: usize = 14;

/// The text of a file: UTF-8, UTF-16, or else Latin-1, in which every byte is a character.
fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, RecordError> {
    let sixteen = |bytes: &[u8], from: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.chunks_exact(2).map(|pair| from([pair[0], pair[1]])).collect();
        // A file that is cut off within a character: the replacement character refuses the number that it ends.
        let cut = if bytes.len().is_multiple_of(2) { "" } else { "\u{fffd}" };
        Cow::from(String::from_utf16_lossy(&units) + cut)
    };
    Ok(match bytes {
        [b'P', b'K', 3, 4, ..] => return Err(RecordError::NoText { kind: "a ZIP archive or a spreadsheet" }),
        [0x1f, 0x8b, ..] => return Err(RecordError::NoText { kind: "compressed (gzip)" }),
        [0xff, 0xfe, text @ ..] => sixteen(text, u16::from_le_bytes),
        [0xfe, 0xff, text @ ..] => sixteen(text, u16::from_be_bytes),
        // UTF-16 without a byte order mark: the upper halves of plain letters are zero.
        [1..=255, 0, 1..=255, 0, ..] => sixteen(bytes, u16::from_le_bytes),
        [0, 1..=255, 0, 1..=255, ..] => sixteen(bytes, u16::from_be_bytes),
        _ => match std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)) {
            Ok(text) => text.into(),
            Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect::<String>().into(),
        },
    })
}

/// The lines of a text that ends them with LF, CRLF, or CR alone.
fn lines(text: &str) -> Vec<&str> {
    // The slices of short lines take more memory than their text: no more are reserved than needed.
    let ends = |sign: char| text.matches(sign).count();
    let mut lines = Vec::with_capacity(1 + if text.contains('\n') { ends('\n') } else { ends('\r') });
    let text = text.strip_suffix(['\n', '\r']).unwrap_or(text);
    lines.extend(text.split('\n').flat_map(|line| line.trim_end_matches('\r').split('\r')));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_that_is_none_is_refused() {
        for dt in [-1.0, 0.0, f64::NAN, f64::INFINITY] {
            let options = TextOptions { dt: Some(dt), ..TextOptions::default() };
            for text in [&b"0 1\n0.01 2\n0.02 3\n"[..], b"1\n2\n3\n"] {
                let read = RecordFile::read(text, &options);
                assert!(matches!(read, Err(RecordError::Interval { .. })), "{dt}: {read:?}");
            }
        }
    }

    #[test]
    fn text_is_read_whatever_its_bytes() {
        for bytes in [&b"\xef\xbb\xbf12\n"[..], b"\xff\xfe1\x002\x00\n\x00", b"1\x002\x00\n\x00", b"\x001\x002\x00\n"] {
            assert_eq!(decode(bytes).as_deref(), Ok("12\n"), "{bytes:?}");
        }
        assert_eq!(decode(b"\xff\xfe1\x002").as_deref(), Ok("1\u{fffd}"));
        assert_eq!(decode(b"Sa\xf3 1\n").as_deref(), Ok("Saó 1\n"));
        for bytes in [&b"PK\x03\x04..."[..], b"\x1f\x8b\x08"] {
            assert!(matches!(decode(bytes), Err(RecordError::NoText { .. })), "{bytes:?}");
        }
        assert_eq!(lines("a\r\nb\n"), ["a", "b"]);
        assert_eq!(lines("a\rb"), ["a", "b"]);
        assert_eq!(lines("a\rb\n"), ["a", "b"]);
        assert_eq!(lines("a\n\nb\r\n"), ["a", "", "b"]);
    }
}
