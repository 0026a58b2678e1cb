//! What the free text of a header states: the number of samples, their interval and their unit.

use super::header::{Entry, leading_number, place_after};
use super::heading::second;
use super::numbers::number;
use crate::error::RecordError;
use crate::options::TextOptions;
use crate::unit::AccelerationUnit;

/// Lines among which the line with the number of samples is sought.
pub const HEADER_LINES: usize = 10;

/// Whether a line states the number of samples: `NPTS= 4000, DT= .01 SEC`.
pub fn names_count(line: &str) -> bool {
    line.to_ascii_uppercase().split(|c: char| !c.is_ascii_alphanumeric()).any(|word| word == "NPTS")
        || place_after(line, "NPTS").and_then(leading_number).is_some()
}

/// The sampling interval that follows `DT` `[s]`: `DT= .01 SEC`, `dt = 10 ms`. Neither a fraction (`1/100`) nor an unknown unit of time gives one.
pub fn interval(line: &str) -> Option<f64> {
    let rest = place_after(line, "DT")?;
    let end = rest.find(|c: char| c.is_whitespace() || ",;/".contains(c)).unwrap_or(rest.len());
    let value = leading_number(rest)?;
    if rest[end..].starts_with('/') {
        return None;
    }
    // A unit touches the number, or may be the next word. The E of an exponent is no unit.
    let touching = if number(&rest[..end]).is_some() { "" } else { &rest[..end] };
    let unit = touching.trim_matches(|c: char| !c.is_alphabetic());
    let next = || rest[end..].split(|c: char| !c.is_alphanumeric()).find(|word| !word.is_empty());
    let second = if unit.is_empty() { next().and_then(second).unwrap_or(1.0) } else { second(unit)? };
    Some(value * second).filter(|interval| *interval > 0.0)
}

/// The units of acceleration that a line states: in brackets, after `in` or `units`, or by a name that is nothing but a unit (`cm/s2`). A unit beside
/// a number or a factor belongs to that number: `peak 350 cm/s2`, `10^-2 m/s2`, `% of g`, `g / 10`. Gravity has a unit of its own.
fn units_of(line: &str) -> Vec<AccelerationUnit> {
    if line.to_ascii_lowercase().contains("gravity") {
        return Vec::new();
    }
    let is_end = |c: char| c.is_whitespace() || ",;:=\"'".contains(c);
    // `cm / s / s` is one unit.
    let line = line.replace(" / ", "/");
    let words: Vec<&str> = line.split(is_end).filter(|word| !word.is_empty()).collect();
    let is_number = |place: usize| words.get(place).is_some_and(|word| number(word).is_some());
    let lower = |place: Option<usize>| {
        place.and_then(|place| words.get(place)).map_or(String::new(), |word| word.to_lowercase())
    };
    let stated = |place: usize| {
        let word = words[place];
        let in_brackets = word.starts_with(['[', '(']);
        let [last, before] = [2, 1].map(|back| lower(place.checked_sub(back)));
        let named = in_brackets
            || ["in", "unit", "units"].contains(&before.as_str())
            || before == "of" && WHOLE.contains(&last.as_str())
            || word.contains('/');
        let of_number = is_number(place + 1) || (!in_brackets && place > 0 && is_number(place - 1));
        let has_factor = is_factor(&lower(Some(place + 1))) || is_factor(&before) || before == "of" && is_factor(&last);
        let name = word.trim_matches(['[', '(', ']', ')', '.']);
        AccelerationUnit::parse(name).filter(|_| named && !of_number && !has_factor)
    };
    (0..words.len()).filter_map(stated).collect()
}

/// Words before `of` and a unit that state it whole.
const WHOLE: [&str; 8] = ["unit", "units", "fraction", "fractions", "term", "terms", "multiple", "multiples"];

/// Whether a word is a factor of a unit: `10^-2`, `x100`, `*`, `%`, `percent`, `hundredths`.
pub fn is_factor(word: &str) -> bool {
    is_multiplied(word)
        || ["*", "x", "×", "^", "/", "%"].contains(&word)
        || ["percent", "tenths", "hundredths", "thousandths", "millionths"].iter().any(|begin| word.starts_with(begin))
}

/// Whether a word is a number with a sign of multiplication, division or a power: `x100`, `100*`, `*10`, `10^-2`, `1/100`.
pub fn is_multiplied(word: &str) -> bool {
    let is_sign = |c: char| "*x×^/".contains(c);
    word.contains(is_sign)
        && word.contains(|c: char| c.is_ascii_digit())
        && word.chars().all(|c| is_sign(c) || c.is_ascii_digit() || "+-.".contains(c))
}

/// The units that lines state, each with the number of its line, from 1.
pub fn units<'t>(lines: impl Iterator<Item = (usize, &'t str)>) -> Vec<(usize, AccelerationUnit)> {
    lines.flat_map(|(line, text)| units_of(text).into_iter().map(move |unit| (line, unit))).collect()
}

/// The unit that a header states: of several the one that the options give, else the first.
///
/// # Errors
/// [`RecordError::Header`] if units differ and the options give none of them; with lenient options that is a warning.
pub fn one_unit(
    stated: &[(usize, AccelerationUnit)],
    options: &TextOptions,
    warnings: &mut Vec<String>,
) -> Result<Option<(usize, AccelerationUnit)>, RecordError> {
    if let Some(own) = stated.iter().find(|(_, unit)| options.units == Some(*unit)) {
        return Ok(Some(*own));
    }
    let Some(&(first, unit)) = stated.first() else { return Ok(None) };
    if let Some((line, other)) = stated.iter().find(|(_, other)| *other != unit) {
        let problem = format!("the unit {other} is stated, and {unit} in line {first}");
        let remedy = "mend the wrong one, give `units`, or take the first with `lenient`";
        warnings.push(Entry { line: *line, text: "", remedy }.leniently(problem, options)?);
    }
    Ok(Some((first, unit)))
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
        ] {
            assert_eq!(interval(text), dt, "{text}");
        }
    }

    #[test]
    fn units_are_those_of_the_samples() {
        let of = |text: &'static str| units([(1, text)].into_iter()).first().map(|(_, unit)| unit.to_string());
        for (text, unit) in [
            ("units m/s2", "m/s²"),
            ("Acceleration in m/s2", "m/s²"),
            ("ACCELERATION IN CM / SEC / SEC", "cm/s²"),
            ("in units of g", "g"),
            ("as fractions of g", "g"),
            ("in meters/second^2", "m/s²"),
            ("acc [m/s^2]", "m/s²"),
            ("m/s^2", "m/s²"),
            ("NPTS=1991 DT=0.01 UNITS=M/S2", "m/s²"),
            ("NPTS=1991 DT=0.01 (cm/s/s)", "cm/s²"),
            ("IN UNITS OF G", "g"),
        ] {
            assert_eq!(of(text).as_deref(), Some(unit), "{text}");
        }
        // Two of them: the user says which it is.
        let (both, mut warnings) = (units([(1, "from cm/s2 in g")].into_iter()), Vec::new());
        let mut one =
            |options: TextOptions| one_unit(&both, &options, &mut warnings).map(|found| found.map(|found| found.1));
        assert!(matches!(one(TextOptions::default()), Err(RecordError::Header { line: 1, .. })), "{both:?}");
        for unit in [AccelerationUnit::G, AccelerationUnit::CentimetrePerSecondSquared] {
            assert_eq!(one(TextOptions { units: Some(unit), ..TextOptions::default() }), Ok(Some(unit)));
        }
        assert_eq!(one(TextOptions { lenient: true, ..TextOptions::default() }), Ok(Some(both[0].1)));
        for text in ["station G", "peak 350 cm/s2", "PGA (g): 0.3", "velocity in m/s", ""] {
            assert_eq!(of(text), None, "{text}");
        }
    }
}
