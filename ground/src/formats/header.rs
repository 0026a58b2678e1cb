//! Rules for the headers of all formats: counts, intervals, units and channels. Intervals and units of the user may not contradict the file.

use super::numbers::{number, quote, words};
use crate::bounds::{LONGEST_INTERVAL, SHORTEST_INTERVAL};
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::unit::AccelerationUnit;

/// A line of a header that is read, or should be there.
#[derive(Clone, Copy)]
pub struct Entry<'t> {
    /// Place in the file, from 1.
    pub line: usize,
    /// The line, or the part that is read.
    pub text: &'t str,
    /// Remedy if the line cannot be read.
    pub remedy: &'static str,
}

impl Entry<'_> {
    /// The error that something is wrong with the entry.
    pub fn wrong(&self, problem: impl Into<String>) -> RecordError {
        RecordError::Header { line: self.line, problem: problem.into(), remedy: self.remedy }
    }

    /// The error of [`Entry::wrong`] with the text of the entry quoted.
    pub fn quoted(&self, problem: &str) -> RecordError {
        self.wrong(format!("{problem} `{}`", brief(self.text)))
    }

    /// Number of samples.
    pub fn count(&self, count: Option<f64>) -> Result<usize, RecordError> {
        let sound = count.filter(|count| *count >= 1.0 && count.fract() == 0.0 && *count <= MOST_SAMPLES);
        sound.map(|count| count as usize).ok_or_else(|| self.quoted("no whole number of samples in"))
    }

    /// Sampling interval of the file `[s]`, or an error if the user gives another one.
    pub fn interval(&self, dt: Option<f64>, options: &TextOptions) -> Result<f64, RecordError> {
        let sound = dt.filter(|dt| (SHORTEST_INTERVAL..=LONGEST_INTERVAL).contains(dt));
        let dt = sound.ok_or_else(|| self.quoted("no sampling interval above zero, of at most 1e6 s, in"))?;
        match options.dt {
            Some(own) if (own - dt).abs() > 1e-9 * dt => {
                Err(self.contradiction("dt", format!("{own} s"), format!("{dt} s")))
            }
            _ => Ok(dt),
        }
    }

    /// Unit of this name.
    pub fn unit(&self, name: &str, options: &TextOptions) -> Result<AccelerationUnit, RecordError> {
        let unknown = || self.wrong(format!("`{}` is no unit of acceleration that is known", brief(name)));
        self.agreed(AccelerationUnit::parse(name).ok_or_else(unknown)?, options)
    }

    /// The unit of the file, or an error if the user gives another one.
    pub fn agreed(&self, unit: AccelerationUnit, options: &TextOptions) -> Result<AccelerationUnit, RecordError> {
        match options.units {
            Some(own) if own != unit => Err(self.contradiction("units", own.to_string(), unit.to_string())),
            _ => Ok(unit),
        }
    }

    /// The warning that a file contradicts itself.
    ///
    /// # Errors
    /// The same problem, unless the options are lenient.
    pub fn leniently(&self, problem: String, options: &TextOptions) -> Result<String, RecordError> {
        match options.lenient {
            true => Ok(format!("line {}: {problem}", self.line)),
            false => Err(self.wrong(problem)),
        }
    }

    fn contradiction(&self, key: &'static str, given: String, file: String) -> RecordError {
        RecordError::Contradiction { key, given, line: self.line, file }
    }
}

/// Largest number of samples that a header declares: four months at 100 Hz. More is a misread header.
const MOST_SAMPLES: f64 = 1e9;

/// The warning that samples do not fill the duration `[s]` that a line of the header states.
pub fn other_duration(count: usize, dt: f64, line: usize, duration: f64) -> String {
    let own = count as f64 * dt;
    format!("{count} samples at {dt} s are {own:.6} s, and line {line} says {duration} s; is the file whole?")
}

/// A line as an error quotes it.
pub fn brief(line: &str) -> String {
    tidy(line).chars().take(80).collect()
}

/// Text with single blanks inside, no blanks at its ends, and control characters replaced.
pub fn tidy(text: &str) -> String {
    quote(&text.split_whitespace().collect::<Vec<_>>().join(" "), usize::MAX)
}

/// Text after the first `word`, which is given in lower case. The case in `line` does not matter.
pub fn after<'t>(line: &'t str, word: &str) -> Option<&'t str> {
    debug_assert_eq!(word, word.to_ascii_lowercase());
    // A change of the case of ASCII letters keeps the places of all bytes.
    let at = line.to_ascii_lowercase().find(word)?;
    Some(&line[at + word.len()..])
}

/// The number after `key`, which is given in capitals, with `=`, `:` or blanks between. A unit may touch the number (`.01SEC`, `100Hz`).
pub fn number_after(line: &str, key: &str) -> Option<f64> {
    leading_number(place_after(line, key)?)
}

/// The text after `key`, without the blanks, `=` and `:` before it. `key` is in capitals, and found at the start of a word only.
pub fn place_after<'t>(line: &'t str, key: &str) -> Option<&'t str> {
    debug_assert_eq!(key, key.to_ascii_uppercase());
    let upper = line.to_ascii_uppercase();
    let at = upper.match_indices(key).find(|(at, _)| !upper[..*at].ends_with(|c: char| c.is_ascii_alphanumeric()))?.0;
    Some(line[at + key.len()..].trim_start().trim_start_matches(['=', ':']).trim_start())
}

/// The number that a text begins with; a unit may touch it.
pub fn leading_number(text: &str) -> Option<f64> {
    let word = words(text).next()?.text;
    number(word).or_else(|| {
        let end = word.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c))).unwrap_or(word.len());
        number(&word[..end])
    })
}

/// Seconds from an epoch to a date and time: `20010304_050610.120`, `2001/03/04 05:06:10` or, with the day first, `04/03/2001 05:06:10`. Only
/// differences between such times have a meaning.
pub fn seconds_of(date: &str) -> Option<f64> {
    let mut runs = date.split(|c: char| !c.is_ascii_digit()).filter(|run| !run.is_empty());
    let day_first = match [runs.next(), runs.next(), runs.next()] {
        [Some(day), Some(month), Some(year)] if day.len() <= 2 && year.len() == 4 => {
            let (_, time) = date.split_once(year)?;
            Some(format!("{year}{month:0>2}{day:0>2}{time}"))
        }
        _ => None,
    };
    let date = day_first.as_deref().unwrap_or(date);
    let digits: String = date.chars().filter(|c| c.is_ascii_digit() || *c == '.').collect();
    let whole = |from: usize, to: usize| digits.get(from..to)?.parse::<i64>().ok();
    let (year, month, day) = (whole(0, 4)?, whole(4, 6)?, whole(6, 8)?);
    let (hour, minute, second) = (whole(8, 10)?, whole(10, 12)?, digits.get(12..)?.parse::<f64>().ok()?);
    // Days of the calendar, with years that begin in March so that the leap day is the last one.
    let (year, month) = if month < 3 { (year - 1, month + 9) } else { (year, month - 3) };
    let days = 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day;
    Some(((days * 24 + hour) * 60 + minute) as f64 * 60.0 + second)
}

/// Number, where the file gives one, and direction of a channel.
pub type ChannelName = (Option<usize>, String);

/// The place of the requested channel, from 0, and the labels of all channels. The request is a number that the file gives to a channel or, in a
/// file without numbers, the place of a channel, from 1. Without a request it is the first channel, with a warning if there are several.
pub fn choose(
    channels: &[ChannelName],
    options: &TextOptions,
    warnings: &mut Vec<String>,
) -> Result<(usize, Vec<String>), RecordError> {
    let label = |(place, (number, direction)): (usize, &ChannelName)| {
        tidy(&format!("{}: {direction}", number.unwrap_or(place + 1))).trim_end_matches(':').to_string()
    };
    let labels: Vec<String> = channels.iter().enumerate().map(label).collect();
    let chosen = match options.channel {
        None => {
            if labels.len() > 1 {
                warnings.push(format!(
                    "the file has {} channels ({}) and the first one is read; choose another with `channel`",
                    labels.len(),
                    listed(&labels)
                ));
            }
            0
        }
        Some(channel) => channels
            .iter()
            .position(|(number, _)| *number == Some(channel))
            // Places count where the file gives no numbers.
            .or_else(|| {
                let has_numbers = channels.iter().any(|(number, _)| number.is_some());
                channel.checked_sub(1).filter(|place| !has_numbers && *place < labels.len())
            })
            .ok_or_else(|| RecordError::NoChannel { channel, known: listed(&labels) })?,
    };
    Ok((chosen, labels))
}

/// Names for a sentence. Of many names only the first ones are given, with the number of all.
pub fn listed(names: &[impl AsRef<str>]) -> String {
    let mut text = names.iter().take(MOST_LISTED).map(|name| brief(name.as_ref())).collect::<Vec<_>>().join(", ");
    if names.len() > MOST_LISTED {
        text += &format!(", ... ({} in all)", names.len());
    }
    text
}

/// Largest number of names in a sentence.
const MOST_LISTED: usize = 40;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_first_samples_differ_by_seconds() {
        let between = |from: &str, to: &str| Some(seconds_of(to)? - seconds_of(from)?);
        assert_eq!(between("20010304_050610.000", "20010304_050610.125"), Some(0.125));
        assert_eq!(between("2001/03/04 05:06:10", "20010304_060610.000"), Some(3600.0));
        assert_eq!(between("20000228_235959.5", "20000229_000000.5"), Some(1.0));
        assert_eq!(between("20000229_235959.5", "20000301_000000.5"), Some(1.0));
        assert_eq!(between("20011231_235959.5", "20020101_000000.5"), Some(1.0));
        assert_eq!(between("14/11/2010 23:59:59.500", "15/11/2010 00:00:00.500"), Some(1.0));
        assert_eq!(between("4/3/2001 05:06:10", "20010304_050611.000"), Some(1.0));
        assert_eq!(seconds_of("no time"), None);
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
