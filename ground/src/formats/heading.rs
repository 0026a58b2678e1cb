//! Headings of columns: the quantity that a name says, and the unit.
//!
//! A unit stands in brackets (`a [m/s2]`), at the end of a name (`time_ms`, `Acc in g`), or in a row of units below the names. A name that
//! says no quantity (`h1`, `NS`, `n`) may be anything: only its unit tells.

use super::factor::has_factor;
use crate::unit::AccelerationUnit;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    Time,
    Acceleration,
    /// Period, frequency or spectral ordinate: the column of a spectrum.
    Spectrum,
    /// Velocity, displacement or force.
    Other,
}

/// Beginnings of words that only spectra have.
const SPECTRAL: [&str; 12] = [
    "period", "périod", "períod", "frequ", "fréqu", "frecu", "spectr", "spektr", "espectr", "spettr", "pseudo",
    "fourier",
];
/// Words that only spectra have: frequencies and ordinates.
const ORDINATES: [&str; 10] = ["freq", "sa", "sv", "sd", "psa", "psv", "psd", "sae", "sve", "sde"];
/// Unit of frequencies.
pub const HERTZ: &str = "hz";
/// Words that make a time a number of rows, or a point in time of the clock: `Time step`, `Time index`.
const COUNTS: [&str; 8] = ["index", "step", "stamp", "sample", "no", "nr", "number", "count"];
/// Words for time.
const TIMES: [&str; 7] = ["time", "times", "zeit", "uhrzeit", "temps", "tempo", "tiempo"];
/// Whole names for time. Within longer names these words have other meanings.
const SHORT_TIMES: [&str; 6] = ["t", "s", "sec", "secs", "second", "seconds"];
/// Beginnings of words for acceleration.
const ACCELERATIONS: [&str; 3] = ["accel", "acel", "beschl"];
/// Short for acceleration; up to two characters may follow: `acc`, `accx`, `acc1`, but not `accumulated` or `accuracy`.
const ACCELERATION: &str = "acc";
/// Whole names for acceleration.
const SHORT_ACCELERATIONS: [&str; 2] = ["a", "ag"];
/// Beginnings of words for velocity and displacement.
const OTHER_MOTIONS: [&str; 8] = ["vel", "disp", "geschw", "versch", "vitesse", "dépl", "despl", "spost"];
/// Beginnings of words for force.
const FORCES: [&str; 2] = ["force", "kraft"];

fn begins(word: &str, beginnings: &[&str]) -> bool {
    beginnings.iter().any(|begin| word.starts_with(begin))
}

/// Whether a text names a velocity or a displacement.
pub fn names_other_motion(text: &str) -> bool {
    let lower = text.to_lowercase();
    lower.split(|c: char| !c.is_alphanumeric()).any(|word| begins(word, &OTHER_MOTIONS))
}

impl Quantity {
    /// The quantity that a name says. The first word that names a quantity decides; words of spectra go before all others.
    pub fn of(name: &str) -> Option<Quantity> {
        let lower = name.trim().to_lowercase();
        let words = || lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
        if words().any(|word| begins(word, &SPECTRAL) || ORDINATES.contains(&word)) {
            return Some(Quantity::Spectrum);
        }
        let is_short = |word: &str| word.strip_prefix(ACCELERATION).is_some_and(|rest| rest.chars().count() <= 2);
        let is_count = words().any(|word| COUNTS.contains(&word));
        let said = words().find_map(|word| match word {
            _ if TIMES.contains(&word) => Some(Quantity::Time).filter(|_| !is_count),
            _ if begins(word, &ACCELERATIONS) || is_short(word) => Some(Quantity::Acceleration),
            _ if begins(word, &OTHER_MOTIONS) || begins(word, &FORCES) => Some(Quantity::Other),
            _ => None,
        });
        match lower.as_str() {
            short if SHORT_TIMES.contains(&short) => Some(Quantity::Time),
            short if SHORT_ACCELERATIONS.contains(&short) => Some(Quantity::Acceleration),
            _ => said,
        }
    }
}

/// Size of a unit of time `[s]`.
pub fn second(unit: &str) -> Option<f64> {
    match unit.to_lowercase().trim_end_matches('.') {
        "s" | "sec" | "secs" | "second" | "seconds" => Some(1.0),
        "ms" | "msec" | "msecs" | "millisecond" | "milliseconds" => Some(1e-3),
        // The micro sign and the Greek letter.
        "us" | "\u{b5}s" | "\u{3bc}s" | "usec" | "microsecond" | "microseconds" => Some(1e-6),
        "min" | "minutes" => Some(60.0),
        _ => None,
    }
}

/// Name and unit of a column; the unit is empty if none is given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heading {
    pub name: String,
    pub unit: String,
    /// Text after the brackets of the unit, such as a direction: `Acc (g) NS`.
    pub rest: String,
}

impl Heading {
    pub fn parse(text: &str) -> Heading {
        let text = text.trim().trim_matches(['"', '\'']).trim();
        let at_end = || unit_at_end(text).map_or((text, "", ""), |(name, unit)| (name, unit, ""));
        let (name, unit, rest) = unit_in_brackets(text).unwrap_or_else(at_end);
        // With a factor beside it the unit is another one, and none that is known: `Acc [g]*10`, `100*Acc (m/s2)`.
        let unit = if has_factor(name, rest) { format!("{} {unit} {}", name.trim(), rest.trim()) } else { unit.into() };
        let (name, rest) = (name.trim().trim_end_matches([',', '_', '/']), rest.trim());
        // `(s) Time`: the name stands behind.
        let (name, rest) = if name.is_empty() { (rest, "") } else { (name, rest) };
        Heading { name: name.to_string(), unit: unit.trim().to_string(), rest: rest.to_string() }
    }

    /// Name, and what stands behind the unit.
    pub fn component(&self) -> String {
        format!("{} {}", self.name, self.rest).trim().to_string()
    }

    /// Whether the column has the natural periods of a spectrum in the notation of building codes.
    pub fn is_natural_period(&self) -> bool {
        ["Tn", "T_n"].contains(&self.name.as_str())
    }

    /// Whether the column may be the spectrum of building codes: `Se`, `S_e(T)`. `SE` is a direction as well.
    pub fn may_be_code_spectrum(&self) -> bool {
        let first = self.name.split(['(', ' ']).next().unwrap_or("");
        ["se", "s_e"].contains(&first.to_lowercase().as_str())
    }

    /// The quantity of the column: by its name, else by its unit.
    pub fn quantity(&self) -> Option<Quantity> {
        if self.unit.eq_ignore_ascii_case(HERTZ) {
            return Some(Quantity::Spectrum);
        }
        let by_time = || self.second().map(|_| Quantity::Time);
        let by_acceleration = || self.acceleration().map(|_| Quantity::Acceleration);
        Quantity::of(&self.name).or_else(by_time).or_else(by_acceleration)
    }

    /// Whether the column holds times beyond doubt: `T` may be the period of a spectrum.
    pub fn is_surely_time(&self) -> bool {
        self.quantity() == Some(Quantity::Time) && !self.name.eq_ignore_ascii_case("t")
    }

    /// The size of the unit `[s]` if it is a unit of time.
    pub fn second(&self) -> Option<f64> {
        second(&self.unit)
    }

    pub fn acceleration(&self) -> Option<AccelerationUnit> {
        AccelerationUnit::parse(&self.unit)
    }
}

/// The text in the first brackets, or all of a text without brackets.
fn bare(text: &str) -> &str {
    text.trim().trim_start_matches(['[', '(']).split([']', ')']).next().unwrap_or("").trim()
}

/// The text before the brackets of the unit, the unit, and the text after them: `Acceleration (E-W) (cm/s²)`, `a(t) [m/s2]`. Of several brackets the unit
/// stands in the last that hold a known one; a unit of time does not count behind the name of an acceleration, nor the other way round:
/// `Acceleration [g] (S)`. Where no unit is known it is the text in the first brackets.
fn unit_in_brackets(text: &str) -> Option<(&str, &str, &str)> {
    let at = |open: usize| {
        let close = text[open..].find([']', ')']).map_or(text.len(), |length| open + length + 1);
        // The unit may have brackets of its own: `[cm/(s*s)]`.
        (&text[..open], bare(&text[open..]), text[close..].trim_start_matches([']', ')']))
    };
    let mut opens = text.match_indices(['[', '(']).map(|(open, _)| open);
    let named = Quantity::of(&text[..opens.clone().next()?]);
    let is_known = |unit: &str| {
        named != Some(Quantity::Time) && AccelerationUnit::parse(unit).is_some()
            || named != Some(Quantity::Acceleration) && second(unit).is_some()
    };
    let known = opens.clone().rev().find(|open| is_known(at(*open).1));
    known.or_else(|| opens.next()).map(at)
}

/// `time_ms`, `Acc in g`, `Zeit/ms`: name and last word, where that word is a unit of the quantity that the name says. `a_g` is no such name, but the
/// usual symbol of the acceleration of the ground.
fn unit_at_end(text: &str) -> Option<(&str, &str)> {
    let fits = |(name, unit): &(&str, &str)| match Quantity::of(name) {
        Some(Quantity::Time) => second(unit).is_some(),
        Some(Quantity::Acceleration) => AccelerationUnit::parse(unit).is_some(),
        _ => false,
    };
    let word = text
        .rsplit_once([' ', '_', ','])
        .filter(|(name, _)| name.len() > 2 || Quantity::of(name) == Some(Quantity::Time));
    let word = word.map(|(name, unit)| (name.trim_end_matches(" in"), unit));
    let parted = |sign: char| text.split_once(sign);
    [word, parted('/'), parted('.')].into_iter().flatten().find(fits)
}

/// Units of columns beside times and accelerations.
const OTHER_UNITS: [&str; 9] = ["m/s", "cm/s", "mm/s", "in/s", "m", "cm", "mm", "in", "-"];

/// The headings of a line. If all cells of the line are units, the names are those of the line `above`, if it has as many.
pub fn headings(text: &str, above: Option<&str>) -> Vec<Heading> {
    let is_unit = |unit: &str| {
        second(unit).is_some()
            || AccelerationUnit::parse(unit).is_some()
            || OTHER_UNITS.contains(&unit.to_lowercase().as_str())
    };
    let own = cells(text);
    let units: Vec<&str> = own.iter().map(|cell| bare(cell.trim_matches('"'))).collect();
    // `(s) Time` has a name behind its unit.
    let is_whole = |cell: &String| {
        let cell = cell.trim_matches('"').trim();
        !cell.starts_with(['[', '(']) || cell.ends_with([']', ')'])
    };
    if !units.iter().all(|unit| is_unit(unit)) || !own.iter().all(is_whole) {
        return own.iter().map(|cell| Heading::parse(cell)).collect();
    }
    let names = above.map(cells).filter(|names| names.len() == units.len());
    let names = names.unwrap_or_else(|| vec![String::new(); units.len()]);
    let is_same = |one: &str, other: &str| {
        let units = [one, other];
        let [one, other] = units.map(AccelerationUnit::parse);
        let [before, after] = units.map(second);
        units[0].is_empty()
            || units[0] == units[1]
            || one.is_some() && one == other
            || before.is_some() && before == after
    };
    let with_unit = |(name, unit): (&String, &&str)| {
        let Heading { name, unit: own, rest } = Heading::parse(name);
        // Two units are none: the table is refused where the column is read.
        let unit = if is_same(&own, unit) { unit.to_string() } else { format!("{own} and {unit}") };
        Heading { name, unit, rest }
    };
    names.iter().zip(&units).map(with_unit).collect()
}

/// The cells of a line of headings, separated by semicolons, else by commas, else by tabs, else by blanks. Blanks within brackets, and before
/// them, belong to the cell, and so does what stands between quotes.
fn cells(text: &str) -> Vec<String> {
    let text = text.trim();
    let has_pairs = text.matches('"').count().is_multiple_of(2);
    for delimiter in [';', ',', '\t'] {
        let mut is_quoted = false;
        let separates = |sign: char| {
            is_quoted ^= sign == '"' && has_pairs;
            sign == delimiter && !is_quoted
        };
        let cells: Vec<String> = text.trim_end_matches(delimiter).split(separates).map(str::to_string).collect();
        if cells.len() > 1 || text.ends_with(delimiter) {
            return cells;
        }
    }
    let mut cells: Vec<String> = Vec::new();
    let mut open = false;
    for word in text.split_whitespace() {
        match cells.last_mut() {
            Some(cell) if open || (word.starts_with(['[', '(']) && !cell.starts_with(['[', '('])) => {
                cell.push(' ');
                cell.push_str(word);
            }
            _ => cells.push(word.into()),
        }
        open = (open || word.contains(['[', '('])) && !word.ends_with([']', ')']);
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_units_say_the_quantity() {
        use Quantity::*;
        for (text, quantity, unit) in [
            ("t [s]", Some(Time), "s"),
            ("time_ms", Some(Time), "ms"),
            ("Time ms", Some(Time), "ms"),
            ("Time in µs", Some(Time), "µs"),
            ("elapsed (s)", Some(Time), "s"),
            ("Time", Some(Time), ""),
            ("timestep", None, ""),
            ("Time step", None, ""),
            ("timestamp", None, ""),
            ("Time Index", None, ""),
            ("Sample #", None, ""),
            ("Acc in g", Some(Acceleration), "g"),
            ("acc_g", Some(Acceleration), "g"),
            ("a_g", None, ""),
            ("acc_NS (g)", Some(Acceleration), "g"),
            ("NS (g)", Some(Acceleration), "g"),
            ("NS", None, ""),
            ("Velocity (g)", Some(Other), "g"),
            ("Period (s)", Some(Spectrum), "s"),
            ("Spectral acceleration (g)", Some(Spectrum), "g"),
            ("PSa (m/s2)", Some(Spectrum), "m/s2"),
            ("Acc (%g)", Some(Acceleration), "%g"),
            ("Acceleration (E-W) (cm/s²)", Some(Acceleration), "cm/s²"),
            ("a(t) [m/s2]", Some(Acceleration), "m/s2"),
            ("Zeit/ms", Some(Time), "ms"),
            ("t/s", Some(Time), "s"),
            ("a/g", Some(Acceleration), "g"),
            ("Beschl./(m/s²)", Some(Acceleration), "m/s²"),
            ("Time.ms", Some(Time), "ms"),
            ("acc_m/s2", Some(Acceleration), "m/s2"),
            ("Acceleration [g] (S)", Some(Acceleration), "g"),
            ("NS (g) disp. corrected", Some(Acceleration), "g"),
            ("a in g", Some(Acceleration), "g"),
            ("ag in m/s2", Some(Acceleration), "m/s2"),
            ("X1 (g)", Some(Acceleration), "g"),
            ("Acc 17/01/1994 (g)", Some(Acceleration), "g"),
            ("Acc 1/2 (g)", Some(Acceleration), "g"),
            ("Acc* (g)", Some(Acceleration), "g"),
            ("SE (g)", Some(Acceleration), "g"),
            ("Acc [g]*10", Some(Acceleration), "Acc g *10"),
            ("Acc x10 (m/s2)", Some(Acceleration), "Acc x10 m/s2"),
            ("100*Acc (m/s2)", Some(Acceleration), "100*Acc m/s2"),
            ("X10 (g)", Some(Acceleration), "g"),
            ("Acc 1/10 scale (g)", Some(Acceleration), "g"),
            ("(g) Acc", Some(Acceleration), "g"),
            ("f (Hz)", Some(Spectrum), "Hz"),
            ("Sae (g)", Some(Spectrum), "g"),
        ] {
            let heading = Heading::parse(text);
            assert_eq!((heading.quantity(), heading.unit.as_str()), (quantity, unit), "{text}");
        }
    }

    #[test]
    fn a_factor_beside_a_unit_makes_it_another() {
        for text in [
            "Acc [g] * 10",
            "Acc (g) x 10",
            "Acc (g) / 10",
            "Acc x 10 (g)",
            "Acc (g) *2",
            "Acc in 0.01 g",
            "Acc [g]*9.81",
            "Acc (m/s2)/9.81",
            "Acc*100 (g)",
            "Acc 0.01*(m/s2)",
            "Acc in % of g",
            "Acc in percent of g",
            "acc_percent_g",
            "Acc 10^-2 (m/s2)",
            "Acc 1/100 (g)",
        ] {
            assert_eq!(Heading::parse(text).acceleration(), None, "{text}: {:?}", Heading::parse(text));
        }
        for text in [
            "X10 (g)",
            "X1 (g)",
            "Acc 1/10 scale (g)",
            "Acc 17/01/1994 (g)",
            "Acc 1/2 (g)",
            "Acc* (g)",
            "Sta. 12 (g)",
            "Acc (g) x 2",
            "Floor 2.5 (g)",
            "Acc halfspace (g)",
            "acc_x_g",
        ] {
            assert_eq!(
                Heading::parse(text).acceleration(),
                Some(AccelerationUnit::G),
                "{text}: {:?}",
                Heading::parse(text)
            );
        }
    }

    #[test]
    fn a_row_of_units_belongs_to_the_names_above() {
        let own = |name: &str, unit: &str| Heading { name: name.into(), unit: unit.into(), rest: String::new() };
        let expected = [own("Time", "s"), own("Acc", "g")];
        for (units, names) in [("s,g", "Time,Acc"), ("(s) (g)", "Time Acc"), ("[s];[g]", "Time;Acc")] {
            assert_eq!(headings(units, Some(names)), expected, "{units}");
        }
        assert_eq!(headings("s,g", Some("A long title")), [own("", "s"), own("", "g")]);
        assert_eq!(headings("t a [g]", None), [own("t", ""), own("a", "g")]);
        assert_eq!(headings("\"Time, s\",\"Acc, g\"", None), expected);
    }
}
