//! The sampling interval that the free text of a header states: `DT= .01 SEC`, `Sampling rate (Hz): 100`, `200 samples per second`.

use super::header::leading_number;
use super::heading::{HERTZ, second};
use super::numbers::number;

/// What the number behind a name measures.
#[derive(Clone, Copy, PartialEq)]
enum Measure {
    /// Time from one sample to the next.
    Interval,
    /// Samples per second.
    Rate,
    /// The same, for short: a sign of equality must come before the number, and nothing but a unit of a rate behind it. `FS = 2 g` is a full scale.
    ShortRate,
}

/// Names of the sampling interval and of its inverse, in lower case.
const NAMES: [(&str, Measure); 42] = [
    ("dt", Measure::Interval),
    ("delta t", Measure::Interval),
    ("time step", Measure::Interval),
    ("timestep", Measure::Interval),
    ("time increment", Measure::Interval),
    ("time interval", Measure::Interval),
    ("sampling interval", Measure::Interval),
    ("sample interval", Measure::Interval),
    ("sampling period", Measure::Interval),
    ("sample period", Measure::Interval),
    ("sampling step", Measure::Interval),
    ("zeitschritt", Measure::Interval),
    ("abtastintervall", Measure::Interval),
    ("pas de temps", Measure::Interval),
    ("intervallo di campionamento", Measure::Interval),
    ("passo di campionamento", Measure::Interval),
    ("intervalo de muestreo", Measure::Interval),
    ("equal intervals of", Measure::Interval),
    ("spaced intervals of", Measure::Interval),
    ("at intervals of", Measure::Interval),
    ("sampling rate", Measure::Rate),
    ("samplingrate", Measure::Rate),
    ("sample rate", Measure::Rate),
    ("samplerate", Measure::Rate),
    ("sampling frequency", Measure::Rate),
    ("sample frequency", Measure::Rate),
    ("sampling freq", Measure::Rate),
    ("samples per second", Measure::Rate),
    ("samples per sec", Measure::Rate),
    ("samples/second", Measure::Rate),
    ("samples/sec", Measure::Rate),
    ("samples/s", Measure::Rate),
    ("abtastrate", Measure::Rate),
    ("abtastfrequenz", Measure::Rate),
    ("fréquence d'échantillonnage", Measure::Rate),
    ("frequence d'echantillonnage", Measure::Rate),
    ("frequenza di campionamento", Measure::Rate),
    ("frecuencia de muestreo", Measure::Rate),
    ("tasa de muestreo", Measure::Rate),
    ("muestras por segundo", Measure::Rate),
    ("sps", Measure::ShortRate),
    ("fs", Measure::ShortRate),
];

/// Units of a sampling rate, in lower case.
const RATES: [&str; 8] =
    [HERTZ, "sps", "samples/second", "samples/sec", "samples/s", "samples per second", "samples per sec", "1/s"];

/// Names of a rate that may follow its number: `200 samples per second`.
const PER_SECOND: [&str; 7] = [
    "samples per second",
    "samples per sec",
    "samples/second",
    "samples/sec",
    "samples/s",
    "muestras por segundo",
    "sps",
];

/// Words before a name that say that the samples of the file have another interval.
const OF_OTHER_SAMPLES: [&str; 6] = ["original", "originally", "raw", "recorded", "digitizer", "instrument"];

/// The first of the [`intervals`] that a line states `[s]`.
pub fn interval(line: &str) -> Option<f64> {
    intervals(line).into_iter().next()
}

/// The sampling intervals that a line states `[s]`, in its order. Neither a fraction (`DT= 1/100`) nor an unknown unit gives one. From the second on, an interval
/// has a sign of equality, or its number stands before its name: `original dt = 0.005, resampled to dt = 0.01`.
pub fn intervals(line: &str) -> Vec<f64> {
    if !line.contains(|c: char| c.is_ascii_digit()) {
        return Vec::new();
    }
    let line = spaced(line);
    let mut found = Vec::new();
    for (place, name, measure) in places(&line) {
        let before = line[..place].trim_end();
        let clause = &before[before.rfind([',', ';']).map_or(0, |end| end + 1)..];
        let is_of_others =
            name != "dt" && clause.split(|c: char| !c.is_alphanumeric()).any(|word| OF_OTHER_SAMPLES.contains(&word));
        let last_word = before.rsplit(char::is_whitespace).next().unwrap_or("");
        let is_in_list = last_word.trim_end_matches([',', ';', '/']).ends_with("npts");
        let statement = Statement::read(&line[place + name.len()..]);
        let has_sign = statement.as_ref().is_some_and(|stated| stated.has_sign);
        let stated = match number(last_word).filter(|_| PER_SECOND.contains(&name) && !has_sign) {
            Some(rate) => Some(1.0 / rate),
            None if has_sign || found.is_empty() && measure != Measure::ShortRate => {
                statement.and_then(|stated| stated.interval(measure))
            }
            None => None,
        };
        let is_sound = |interval: &f64| *interval > 0.0 && interval.is_finite();
        found.extend(stated.filter(|interval| is_sound(interval) && !is_of_others && !is_in_list));
    }
    found
}

/// A line with blanks in place of the names of a sampling interval: their `period` and `frequency` are no columns of a spectrum.
pub fn without_names(line: &str) -> String {
    let mut rest = line.to_string();
    for (place, name, _) in places(&spaced(line)) {
        rest.replace_range(place..place + name.len(), &" ".repeat(name.len()));
    }
    rest
}

/// A line in lower case, with blanks in place of `_`, and of `-` between letters. All its bytes keep their places.
fn spaced(line: &str) -> String {
    let lower = line.to_ascii_lowercase();
    let is_letter = |place: Option<usize>| {
        place.is_some_and(|place| lower.as_bytes().get(place).is_some_and(u8::is_ascii_alphabetic))
    };
    let is_hyphen = |place: usize| is_letter(place.checked_sub(1)) && is_letter(Some(place + 1));
    let plain = |(place, c)| match c {
        '_' => ' ',
        '-' if is_hyphen(place) => ' ',
        'É' => 'é',
        other => other,
    };
    lower.char_indices().map(plain).collect()
}

/// The names in a line, each with its place, from left to right; none begins inside another one.
fn places(line: &str) -> Vec<(usize, &'static str, Measure)> {
    let is_word = |place: usize, name: &str| {
        !line[..place].ends_with(char::is_alphanumeric) && !line[place + name.len()..].starts_with(char::is_alphabetic)
    };
    let of_name = |(name, measure): &(&'static str, Measure)| {
        let (name, measure) = (*name, *measure);
        line.match_indices(name)
            .filter(move |(place, _)| is_word(*place, name))
            .map(move |(place, _)| (place, name, measure))
            .collect::<Vec<_>>()
    };
    let mut found: Vec<_> = NAMES.iter().flat_map(of_name).collect();
    found.sort_by_key(|(place, name, _)| (*place, usize::MAX - name.len()));
    let mut end = 0;
    found.retain(|(place, name, _)| {
        let is_apart = *place >= end;
        end = if is_apart { place + name.len() } else { end };
        is_apart
    });
    found
}

/// What stands behind a name: a unit in brackets or before a sign, a sign of equality, a number and its unit.
struct Statement<'t> {
    has_sign: bool,
    value: f64,
    /// The unit before the number, empty without one.
    unit_before: &'t str,
    /// What touches the number, empty without it. The E of an exponent is no unit.
    touching: &'t str,
    /// Text behind the number and what touches it.
    behind: &'t str,
}

impl Statement<'_> {
    fn read(text: &str) -> Option<Statement<'_>> {
        let mut rest = text.trim_start();
        let mut unit_before = "";
        if let Some((unit, after)) = rest.strip_prefix(['(', '[']).and_then(|inside| inside.split_once([')', ']'])) {
            (unit_before, rest) = (unit.trim(), after.trim_start());
        } else if let Some(end) = rest.find(['=', ':'])
            && !matches!(Unit::of(rest[..end].trim()), Unit::Unknown)
        {
            // `SAMPLING_INTERVAL_S: 0.01`
            (unit_before, rest) = (rest[..end].trim(), &rest[end..]);
        }
        rest = ["of ", "is "].iter().find_map(|word| rest.strip_prefix(word)).unwrap_or(rest).trim_start();
        let number_on = rest.trim_start_matches(['=', ':']).trim_start();
        let value = leading_number(number_on)?;
        let end = number_on.find(|c: char| c.is_whitespace() || ",;/".contains(c)).unwrap_or(number_on.len());
        let (word, behind) = number_on.split_at(end);
        // A time of the clock, the first of a pair (`5.0 to 25.0 s`), and a number that a comma parts are no intervals.
        let goes_on = ["to ", "-", "\u{2013}"].iter().any(|word| behind.trim_start().starts_with(word));
        let has_comma = behind.strip_prefix(',').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
        if word.contains(':') || goes_on || has_comma {
            return None;
        }
        let touching = if number(word).is_some() { "" } else { word.trim_matches(|c: char| !c.is_alphabetic()) };
        let has_sign = rest.starts_with(['=', ':']);
        Some(Statement { has_sign, value, unit_before, touching, behind })
    }

    /// The interval `[s]` that the number is, or whose inverse it is. The unit decides: `sampling rate: 0.01 s` is an interval.
    fn interval(&self, measure: Measure) -> Option<f64> {
        if self.touching.is_empty() && self.behind.starts_with('/') {
            return None;
        }
        let ends = || {
            self.behind.trim_start().trim_start_matches([')', ']']).is_empty() || self.behind.starts_with([',', ';'])
        };
        match (measure, self.unit()) {
            (_, Unit::Unknown) => None,
            (Measure::ShortRate, Unit::Time(_)) => None,
            (_, Unit::Time(second)) => Some(self.value * second),
            (Measure::Interval, Unit::Rate) => None,
            (Measure::Interval, Unit::None) => Some(self.value),
            (_, Unit::Rate) => Some(1.0 / self.value),
            (Measure::ShortRate, Unit::None) if !ends() => None,
            (_, Unit::None) => Some(1.0 / self.value).filter(|_| self.value >= 1.0),
        }
    }

    /// The unit before the number, else the one that touches it, else the next word if that is a unit.
    fn unit(&self) -> Unit {
        let text = self.behind.trim_start().trim_start_matches(['(', '[']);
        // A unit of a rate that a number follows is the name of that number: `0.01, HZ= 100`.
        let ends = |rest: &str| !rest.trim_start().starts_with(|c: char| c.is_alphanumeric() || "=:".contains(c));
        let next = text.split(|c: char| !c.is_alphanumeric()).find(|word| !word.is_empty());
        match [self.unit_before, self.touching] {
            ["", ""] if RATES.iter().any(|unit| text.strip_prefix(unit).is_some_and(ends)) => Unit::Rate,
            ["", ""] => match next.map_or(Unit::Unknown, Unit::of) {
                Unit::Time(second) => Unit::Time(second),
                _ if next.is_some_and(|word| word != HERTZ && word.ends_with(HERTZ)) => Unit::Unknown,
                _ => Unit::None,
            },
            ["", unit] | [unit, _] => Unit::of(unit),
        }
    }
}

/// The unit of a number behind a name.
enum Unit {
    None,
    Unknown,
    /// Its size `[s]`.
    Time(f64),
    Rate,
}

impl Unit {
    fn of(text: &str) -> Unit {
        match second(text) {
            Some(second) => Unit::Time(second),
            None if RATES.contains(&text) => Unit::Rate,
            None => Unit::Unknown,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_have_units() {
        for (text, dt) in [
            ("NPTS=1991, DT= .01000 SEC", Some(0.01)),
            ("DT=.01SEC", Some(0.01)),
            ("dt = 10 ms", Some(0.01)),
            ("DT= 10MSEC", Some(0.01)),
            ("DT= 1.0E-02 sec", Some(0.01)),
            ("DT=1E-2", Some(0.01)),
            ("DT= .01, NPTS= 4", Some(0.01)),
            ("DT= 1/100 SEC", None),
            ("DT=1E-2SEC", None),
            ("WIDTH= 3", None),
            ("DT= -0.01", None),
            ("DT= 0,01", None),
            ("DT= 200 HZ", None),
            ("dt = 100 (Hz)", None),
            ("NPTS= 60, DT= 0.01, HZ= 100", Some(0.01)),
            ("dt = 0.01, Hz = 100", Some(0.01)),
            ("dt: 0.01 [Hz 100]", Some(0.01)),
            ("original dt = 0.005, resampled to dt = 0.01", Some(0.005)),
            ("SAMPLING INTERVAL (sec): 0.01", Some(0.01)),
            ("Sampling interval: 10 ms", Some(0.01)),
            ("Sample Interval [s] = 0.01", Some(0.01)),
            ("dt [ms] = 10", Some(0.01)),
            ("DT(SEC)= 0.01", Some(0.01)),
            ("SAMPLING_INTERVAL_S: 0.01", Some(0.01)),
            ("time-step 0.01 sec", Some(0.01)),
            ("TIME STEP = 0.01 SEC", Some(0.01)),
            ("Sampling rate: 100 Hz", Some(0.01)),
            ("Sampling rate (Hz): 100", Some(0.01)),
            ("sampling frequency 100Hz", Some(0.01)),
            ("Sampling Freq(Hz)  100Hz", Some(0.01)),
            ("sample rate [sps] = 100", Some(0.01)),
            ("SAMPLES/SEC: 100", Some(0.01)),
            ("100 samples per second", Some(0.01)),
            ("digitised at 200 sps", Some(0.005)),
            ("fs = 100", Some(0.01)),
            ("fs: 100 Hz", Some(0.01)),
            ("Sampling rate: 100 samples/s", Some(0.01)),
            ("Sampling rate: 0.01 s", Some(0.01)),
            ("60 points at equally spaced intervals of 0.02 sec", Some(0.02)),
            ("Tasa de muestreo: 200 Hz", Some(0.005)),
            ("Sampling interval dt (s): 0.01", Some(0.01)),
            ("sampling rate of 200 Hz", Some(0.005)),
            ("Sampling rate: 0.01", None),
            ("Sampling rate: 100 kHz", None),
            ("Sampling interval: 100 Hz", None),
            ("Original sampling rate: 200 Hz", None),
            ("NPTS, DT(SEC): 4000, 0.01", None),
            ("confidence interval of 0.95", None),
            ("fs 100", None),
            ("time step number 5", None),
            ("Sampling rate: 0 Hz", None),
            ("Sampling interval (days): 1", None),
            ("offsets 5", None),
            ("number of samples/sec", None),
            ("Original sampling rate: 200 samples per second", None),
            ("Original sampling rate: 200 sps", None),
            ("original sampling interval of 0.005 s", None),
            ("Original data sampling rate: 200 Hz", None),
            ("Sampling rate: 1,000 Hz", None),
            ("Abtastrate: 62,5 Hz", None),
            ("Pas de temps: 5,0 ms", None),
            ("FS = 2 g", None),
            ("FS: 4 V", None),
            ("fs = 100, 3 channels", Some(0.01)),
            ("Sampling time: 12:30:05", None),
            ("Time interval: 5.0 to 25.0 s", None),
            ("in an interval of 10.2 s (5-95 %)", None),
            ("Channel 3 SPS: 100", Some(0.01)),
            ("Number of samples: 4000 samples/sec: 200", Some(0.005)),
            ("SampleRate(Hz): 200", Some(0.005)),
            ("raw data, sampling rate: 100 Hz", Some(0.01)),
            ("sampling interval of 0.02 s", Some(0.02)),
            ("(dt=0.01)", Some(0.01)),
            ("FRÉQUENCE D'éCHANTILLONNAGE: 100 Hz", Some(0.01)),
        ] {
            assert_eq!(interval(text), dt, "{text}");
        }
        assert_eq!(intervals("original dt = 0.005, resampled to dt = 10 ms"), [0.005, 0.01]);
        assert_eq!(intervals("dt = 0.01 (sampling dt), t-dt 5"), [0.01]);
        assert_eq!(intervals("Sampling rate: 100 samples per second"), [0.01, 0.01]);
        assert_eq!(intervals("sampling interval: 0.01 s, sampling rate: 200 Hz"), [0.01, 0.005]);
    }
}
