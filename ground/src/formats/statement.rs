//! What the free text of a header states: the number of samples and their unit.

use super::factor::has_factor;
use super::header::{Entry, leading_number, place_after};
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

/// Whether a line is a name and a value, `Units: cm/s^2`, `Station = ABC`: the header of many a file of one column. A line with several values is none.
pub fn is_pair(line: &str) -> bool {
    let is_sign = |c: char| c == ':' || c == '=';
    let Some((name, value)) = line.split_once(is_sign) else { return false };
    let is_word = |c: char| c.is_alphanumeric() || c.is_whitespace() || "_-.".contains(c);
    !name.trim().is_empty()
        && name.chars().all(is_word)
        && !value.trim().is_empty()
        && !value.contains(|c: char| is_sign(c) || ",;\t".contains(c))
}

/// A unit of acceleration that the text above the samples states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stated {
    /// Line, from 1.
    pub line: usize,
    pub unit: AccelerationUnit,
    /// Whether the text beside the unit speaks of a conversion, a factor, another quantity, or a second unit to choose from.
    pub is_doubtful: bool,
}

/// Whether the text before and after a unit in its part of a line says that the unit need not be that of the samples: a conversion or a factor on either side, or
/// the name of another quantity before it.
fn is_of_another(before: &str, after: &str) -> bool {
    let any_word =
        |text: &str, is: &dyn Fn(&str) -> bool| text.to_lowercase().split(|c: char| !c.is_alphanumeric()).any(is);
    let is_conversion = |word: &str| {
        ["convert", "conversion", "multipli"].iter().any(|begin| word.starts_with(begin))
            || ["multiply", "factor", "factors"].contains(&word)
    };
    let is_quantity = |word: &str| ["resolution", "noise"].contains(&word);
    let is_arrow = |text: &str| ["->", "=>", "\u{2192}", "\u{21d2}"].iter().any(|arrow| text.contains(arrow));
    [before, after].into_iter().any(|text| any_word(text, &is_conversion) || is_arrow(text))
        || any_word(before, &is_quantity)
}

/// The factor that a line states, which no reader of tables applies: `scale factor: 0.001`, `multiply by 9.81`. Not a factor of one, nor that of something
/// else (`crest factor 4.2`).
pub fn factor(line: &str) -> Option<f64> {
    let lower = line.to_lowercase();
    let words: Vec<&str> =
        lower.split(|c: char| c.is_whitespace() || "=:()[]#%".contains(c)).filter(|word| !word.is_empty()).collect();
    let is_factor = |place: usize| match words[place] {
        "factor" | "factors" => {
            place == 0
                || ["scale", "scaling", "conversion", "calibration", "multiplication"].contains(&words[place - 1])
        }
        "by" => place > 0 && ["multiply", "multiplied", "scaled"].contains(&words[place - 1]),
        word => ["scalefactor", "scale_factor"].contains(&word),
    };
    let behind = |place: usize| words[place + 1..].iter().find(|word| **word != "of");
    let found = (0..words.len()).filter(|place| is_factor(*place)).find_map(|place| number(behind(place)?));
    found.filter(|factor| *factor != 1.0)
}

/// The units of acceleration that a line states: in brackets, after `in`, `units` or `units of`, or by a name that is nothing but a unit (`cm/s2`). A unit
/// beside a number or a factor belongs to that number: `peak 350 cm/s2`, `10^-2 m/s2`, `% of g`, `g / 10`, `gravity (9.81 m/s2)`.
/// With each, whether it is doubtful ([`Stated::is_doubtful`]).
fn units_of(line: &str) -> Vec<(AccelerationUnit, bool)> {
    let is_end = |c: char| c.is_whitespace() || ",;:=\"'".contains(c);
    // `cm / s / s` is one unit.
    let line = line.replace(" / s", "/s").replace(" / S", "/S");
    let is_of_gravity = line.to_ascii_lowercase().contains("gravity");
    let mut end = 0;
    let place = |part: &str| {
        let begin = end;
        end += part.len();
        let length = part.trim_end_matches(is_end).len();
        (length > 0).then_some((begin, begin + length))
    };
    let places: Vec<(usize, usize)> = line.split_inclusive(is_end).filter_map(place).collect();
    let words: Vec<&str> = places.iter().map(|(begin, end)| &line[*begin..*end]).collect();
    let bare = |word: &str| word.trim_matches(['[', '(', ']', ')']).to_ascii_lowercase();
    let is_number = |place: usize| words.get(place).is_some_and(|word| number(&bare(word)).is_some());
    let before = |place: usize, back: usize| place.checked_sub(back).map_or(String::new(), |place| bare(words[place]));
    let stated = |place: usize| {
        let word = words[place];
        let in_brackets = word.starts_with(['[', '(']);
        let last = before(place, 1);
        let named = in_brackets
            || ["in", "unit", "units"].contains(&last.as_str())
            || last == "of" && WHOLE.contains(&before(place, 2).as_str())
            || word.contains('/');
        let follows_number = place > 0 && is_number(place - 1) && (!in_brackets || is_of_gravity);
        let (begin, end) = places[place];
        let is_multiple = has_factor(&line[..begin], &line[end..]);
        let is_parting = [',', ';'];
        let from = line[..begin].rfind(is_parting).unwrap_or(0);
        let until = line[end..].find(is_parting).map_or(line.len(), |length| end + length);
        let name = word.trim_matches(['[', '(', ']', ')', '.']);
        let unit = AccelerationUnit::parse(name)
            .filter(|_| named && !is_number(place + 1) && !follows_number && !is_multiple)?;
        let is_choice = last == "or" || words.get(place + 1).is_some_and(|next| bare(next) == "or");
        Some((unit, is_choice || is_of_another(&line[from..begin], &line[end..until])))
    };
    (0..words.len()).filter_map(stated).collect()
}

/// Words before `of` and a unit that state the unit.
const WHOLE: [&str; 10] =
    ["unit", "units", "fraction", "fractions", "term", "terms", "multiple", "multiples", "part", "parts"];

/// The units that lines, numbered from 1, state.
pub fn units<'t>(lines: impl Iterator<Item = (usize, &'t str)>) -> Vec<Stated> {
    let of_line =
        |(line, text)| units_of(text).into_iter().map(move |(unit, is_doubtful)| Stated { line, unit, is_doubtful });
    lines.flat_map(of_line).collect()
}

/// The unit that a header states: of several the one that the options give, else the first that is not doubtful.
///
/// # Errors
/// [`RecordError::Header`] if units differ, or the only one is doubtful, and the options give none of them; with lenient options that is a warning.
pub fn one_unit(
    stated: &[Stated],
    options: &TextOptions,
    warnings: &mut Vec<String>,
) -> Result<Option<(usize, AccelerationUnit)>, RecordError> {
    if let Some(own) = stated.iter().find(|one| options.units == Some(one.unit)) {
        return Ok(Some((own.line, own.unit)));
    }
    let mut sure = stated.iter().filter(|one| !one.is_doubtful);
    let Some(first) = sure.next() else {
        let Some(doubtful) = stated.first().filter(|_| options.units.is_none()) else { return Ok(None) };
        let unit = doubtful.unit;
        let problem = format!("the unit {unit} stands beside a conversion, a factor, a choice or another quantity");
        let remedy = "give `units`, or take it with `lenient`";
        warnings.push(Entry { line: doubtful.line, text: "", remedy }.leniently(problem, options)?);
        return Ok(Some((doubtful.line, unit)));
    };
    if let Some(other) = sure.find(|other| other.unit != first.unit) {
        let problem = format!("the unit {} is stated, and {} in line {}", other.unit, first.unit, first.line);
        let remedy = "mend the wrong one, give `units`, or take the first with `lenient`";
        warnings.push(Entry { line: other.line, text: "", remedy }.leniently(problem, options)?);
    }
    Ok(Some((first.line, first.unit)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_have_numbers() {
        for (text, found) in [
            ("scale factor: 0.001", Some(0.001)),
            ("# scale_factor: 427336", Some(427_336.0)),
            ("scalefactor=0.001", Some(0.001)),
            ("multiply by 9.81 to get m/s2", Some(9.81)),
            ("scaled by 0.5", Some(0.5)),
            ("factor of 2", Some(2.0)),
            ("Scale factor: 1.0", None),
            ("crest factor 4.2", None),
            ("Amplification factor, record 12", None),
            ("multiple events of 1994", None),
        ] {
            assert_eq!(factor(text), found, "{text}");
        }
    }

    #[test]
    fn units_are_those_of_the_samples() {
        let of = |text: &'static str| {
            let stated = units([(1, text)].into_iter());
            stated.first().filter(|one| !one.is_doubtful).map(|one| one.unit.to_string())
        };
        for (text, unit) in [
            ("units m/s2", "m/s²"),
            ("Acceleration in m/s2", "m/s²"),
            ("ACCELERATION IN CM / SEC / SEC", "cm/s²"),
            ("in units of g", "g"),
            ("as fractions of g", "g"),
            ("in meters/second^2", "m/s²"),
            ("acceleration in g, X direction", "g"),
            ("El Centro, X (g)", "g"),
            ("acc (g) 18/05/1940", "g"),
            ("Acceleration in units of gravity (g)", "g"),
            ("units: g (gravity)", "g"),
            ("Acceleration / (m/s2)", "m/s²"),
            ("Time / [s], Acc / [g]", "g"),
            ("acceleration as parts of g", "g"),
            ("units: m/s**2", "m/s²"),
            ("acceleration in g, 1/10 scale model", "g"),
            ("acceleration (g) x 2 channels", "g"),
            ("acceleration in g, x 090", "g"),
            ("acc [m/s^2]", "m/s²"),
            ("m/s^2", "m/s²"),
            ("NPTS=1991 DT=0.01 UNITS=M/S2", "m/s²"),
            ("NPTS=1991 DT=0.01 (cm/s/s)", "cm/s²"),
            ("IN UNITS OF G", "g"),
            ("acceleration in multiples of g", "g"),
            ("factory units: g", "g"),
            ("Acceleration in g (north or south)", "g"),
            ("units: g resolution: 16 bit", "g"),
            ("Acceleration in g (noise removed)", "g"),
            ("Acceleration (g), noise removed", "g"),
            ("Acceleration in g; quality factor Q=100", "g"),
            ("units: g, amplification factor at site 1.2", "g"),
            ("Acceleration (cm/s2), converted with a program", "cm/s²"),
            ("CORRECTED RECORD IN CM/S2, NOISE FILTERED", "cm/s²"),
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
        assert_eq!(one(TextOptions { lenient: true, ..TextOptions::default() }), Ok(Some(both[0].unit)));
        for text in [
            "in % of g",
            "Kobe, acceleration (% of g)",
            "[percent of g]",
            "PGA 35% of g",
            "one tenth of g",
            "in g *9.81",
            "in g /9.81",
            "acceleration over gravity (9.81 m/s2), Kobe",
            "courtesy of G. Smith",
            "10^-2 m/s2",
            "in g / 10",
            "in m/s2 x 100",
            "hundredths of g",
            "acceleration of gravity: 9.81 (m/s2)",
            "station G",
            "peak 350 cm/s2",
            "PGA (g): 0.3",
            "velocity in m/s",
            "converted from cm/s2 to g",
            "Acceleration in cm/s2 converted to g",
            "to convert to m/s2 multiply by 9.81",
            "acceleration m/s2 -> g",
            "resolution [mg]: 0.1",
            "noise floor in mg",
            "acceleration in m/s2 (multiply by 0.01)",
            "scale factor 0.01 units cm/s2",
            "in m/s2 [x100]",
            "cm/s2 or g",
            "",
        ] {
            assert_eq!(of(text), None, "{text}");
        }
    }
}
