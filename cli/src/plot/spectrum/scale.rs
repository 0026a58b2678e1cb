//! An axis of cells: each is centred on its value and reaches half way to its neighbours; values in geometric progression make a
//! logarithmic axis.

use super::points::Axis;
use crate::plot::axis::{self, brief, number};
use std::cmp::Ordering;

/// The values of one axis and where their cells are.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// The key that varies.
    pub key: String,
    /// Ascending, distinct values: two or more; a strip has one.
    pub values: Vec<f64>,
    /// Edges of the cells along the axis, in parts of its length: one more than values.
    pub edges: Vec<f64>,
    is_log: bool,
    /// Values at both ends; their logarithms if the axis is logarithmic.
    ends: [f64; 2],
}

/// Relative difference below which two steps between values count as equal: values come from a table of decimals.
const SAME: f64 = 1e-6;

impl Scale {
    /// The axis of a key with these values, in any order; at least two of them different.
    pub fn of(key: &str, mut values: Vec<f64>) -> Scale {
        values.sort_by(f64::total_cmp);
        values.dedup();
        let is_log =
            values[0] > 0.0 && steady(&values, |from, to| (to / from).ln()) && !steady(&values, |from, to| to - from);
        let along: Vec<f64> = values.iter().map(|value| if is_log { value.ln() } else { *value }).collect();
        let last = along.len() - 1;
        let between = along.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let mut edges = vec![1.5 * along[0] - 0.5 * along[1]];
        edges.extend(between);
        edges.push(1.5 * along[last] - 0.5 * along[last - 1]);
        let ends = [edges[0], edges[last + 1]];
        edges.iter_mut().for_each(|edge| *edge = (*edge - ends[0]) / (ends[1] - ends[0]));
        Scale { key: key.into(), values, edges, is_log, ends }
    }

    /// The axis from the least of these values to the largest, for curves; at least two of them different.
    pub fn over(key: &str, values: Vec<f64>) -> Scale {
        let mut scale = Scale::of(key, values);
        let [first, last] = [0, scale.values.len() - 1].map(|place| scale.values[place]);
        scale.ends = [first, last].map(|end| if scale.is_log { end.ln() } else { end });
        let between = scale.values.windows(2).map(|pair| scale.share(0.5 * (pair[0] + pair[1])));
        scale.edges = [0.0].into_iter().chain(between).chain([1.0]).collect();
        scale
    }

    /// The upward axis of a strip, a panel with one row of cells.
    pub fn strip() -> Scale {
        Scale { key: String::new(), values: vec![0.5], edges: vec![0.0, 1.0], is_log: false, ends: [0.0, 1.0] }
    }

    /// Index of the cell of a value; `None` if the axis does not have the value.
    pub fn place(&self, value: f64) -> Option<usize> {
        // Zeros of either sign are the same.
        self.values.binary_search_by(|probe| probe.partial_cmp(&value).unwrap_or(Ordering::Less)).ok()
    }

    /// Position of a value along the axis, from 0 to 1.
    pub fn share(&self, value: f64) -> f64 {
        let along = if self.is_log { value.ln() } else { value };
        (along - self.ends[0]) / (self.ends[1] - self.ends[0])
    }

    /// Round values along the axis and how they are written; about `count`, fewer on a logarithmic axis that spans little.
    pub fn ticks(&self, count: usize) -> Vec<(f64, String)> {
        if self.is_log {
            let round = self.round_on_log(&[1.0, 2.0, 5.0]);
            let round = if round.len() > 2 * count { self.powers_of_ten(count + 1) } else { round };
            if round.len() >= 2 {
                return round.into_iter().map(|value| (value, brief(value))).collect();
            }
        }
        let range = if self.is_log { self.ends.map(f64::exp) } else { self.ends };
        let step = axis::Axis::over("", range, count).step;
        let [first, last] = [(range[0] / step - 1e-9).ceil(), (range[1] / step + 1e-9).floor()];
        let round = (0..=(last - first) as usize).map(|place| (first + place as f64) * step);
        round.map(|value| (value, number(value, step))).collect()
    }

    /// Powers of ten along the axis, each, or every second, third, ..., so that there are `most` of them or fewer.
    fn powers_of_ten(&self, most: usize) -> Vec<f64> {
        let all = self.round_on_log(&[1.0]);
        let every = all.len().div_ceil(most).max(1);
        all.into_iter().step_by(every).collect()
    }

    /// These digits times powers of ten, as far as the axis reaches.
    fn round_on_log(&self, digits: &[f64]) -> Vec<f64> {
        let powers = self.ends.map(|end| (end / std::f64::consts::LN_10).floor() as i32);
        let round = (powers[0]..=powers[1]).flat_map(|power| digits.iter().map(move |digit| digit * 10f64.powi(power)));
        round.filter(|value| (0.0..=1.0).contains(&self.share(*value))).collect()
    }

    /// Quantity and unit of the axis.
    pub fn label(&self) -> String {
        label(&self.key)
    }
}

/// Whether there are at least three values, and `step` is the same between all neighbours.
fn steady(values: &[f64], step: impl Fn(f64, f64) -> f64) -> bool {
    let first = step(values[0], values[1]);
    values.len() > 2 && values.windows(2).all(|pair| (step(pair[0], pair[1]) / first - 1.0).abs() < SAME)
}

/// Last part of a key of scenes (or the whole key, where the last part has another meaning elsewhere), and the name and unit of its quantity. A density has the
/// unit of its column, which the key does not tell.
const QUANTITIES: [(&str, &str, &str); 69] = [
    ("alpha_degrees", "α", "°"),
    ("alpha", "α", "rad"),
    ("p", "p", "rad/s"),
    ("rocking_period", "2π/p", "s"),
    ("R", "R", "m"),
    ("pga_uplift", "PGA / (g tan α)", ""),
    ("pgv", "PGV", "m/s"),
    ("pgv_uplift", "p PGV / (g tan α)", ""),
    ("pgd", "PGD", "m"),
    ("seed", "Seed", ""),
    ("point", "Point of the sweep", ""),
    ("component", "Component", ""),
    ("amplitude_uplift", "a / (g tan α)", ""),
    ("omega_p", "Ω / p", ""),
    ("amplitude", "a", "m/s²"),
    ("amplitude_g", "a", "g"),
    ("velocity", "v", "m/s"),
    ("omega", "Ω", "rad/s"),
    ("frequency", "Frequency", "Hz"),
    ("period", "Period", "s"),
    ("start", "Start", "s"),
    ("phase", "Phase", "rad"),
    ("duration", "Duration", "s"),
    ("gamma", "γ", ""),
    ("pga", "Peak ground acc.", "m/s²"),
    ("pga_g", "Peak ground acc.", "g"),
    ("scale", "Scale of the record", ""),
    ("damping", "Damping of the ground", ""),
    ("eta", "η", ""),
    ("blocks", "Blocks", ""),
    ("half_width", "Half-width", "m"),
    ("half_height", "Half-height", "m"),
    ("density", "Density", ""),
    ("mass", "Mass", "kg"),
    ("inertia", "Inertia", "kg m²"),
    ("gravity", "g", "m/s²"),
    ("friction", "Friction coefficient", ""),
    ("friction.static", "Static friction coefficient", ""),
    ("friction.kinetic", "Kinetic friction coefficient", ""),
    ("t_end", "End of the run", "s"),
    ("stick_angle", "Stick angle", "rad"),
    ("overturn_angle", "Overturning angle", "rad"),
    ("width", "Width", "m"),
    ("height", "Height", "m"),
    ("diameter", "Diameter", "m"),
    ("depth", "Depth", "m"),
    ("bottom_half_width", "Half-width of the base", "m"),
    ("top_half_width", "Half-width of the top", "m"),
    ("bottom_width", "Width of the base", "m"),
    ("top_width", "Width of the top", "m"),
    ("bottom_diameter", "Diameter of the base", "m"),
    ("top_diameter", "Diameter of the top", "m"),
    ("centroid_height", "Height of the centroid", "m"),
    ("factors", "Restitution factor", ""),
    ("theta", "Initial θ", "rad"),
    ("slide", "Initial slide", "m"),
    ("x", "Initial x", "m"),
    ("y", "Initial y", "m"),
    ("vx", "Initial vx", "m/s"),
    ("vy", "Initial vy", "m/s"),
    ("initial.omega", "Initial ω", "rad/s"),
    ("arias", "Arias intensity", "m/s"),
    ("cav", "CAV", "m/s"),
    ("sa", "Sa", "m/s²"),
    ("sa_g", "Sa", "g"),
    ("sa_period", "Period of Sa", "s"),
    ("sa_damping", "Damping of Sa", ""),
    ("dt", "Interval", "s"),
    ("cycles", "Cycles", ""),
];

/// Name of the quantity of a key in the words of the field, and its unit, which may be empty; the last part of an unknown key. The name says which block,
/// interface, term of a sum or component it is of.
fn quantity(key: &str) -> (String, &'static str) {
    let (above, last) = key.rsplit_once('.').unwrap_or(("", key));
    let indexed = |part: &str| {
        let (name, index) = part.strip_suffix(']')?.split_once('[')?;
        Some((name.to_string(), index.to_string()))
    };
    let (name, entry) = indexed(last).map_or((last.to_string(), None), |(name, index)| (name, Some(index)));
    let whole = if above.is_empty() { name.clone() } else { format!("{above}.{name}") };
    let known = |wanted: &str| QUANTITIES.iter().find(|(own, _, _)| own == &wanted);
    let (mut words, unit) = match known(&whole).or_else(|| known(&name)) {
        Some((_, words, unit)) => (words.to_string(), *unit),
        None => (last.to_string(), ""),
    };
    let is_of_interfaces = name == "slide" || name == "factors" || whole.starts_with("friction");
    match entry {
        Some(number) if is_of_interfaces => words.push_str(&format!(" of interface {number}")),
        Some(number) if above == "initial" => words.push_str(&format!(" of block {number}")),
        _ => {}
    }
    for (table, number) in above.split('.').filter_map(indexed) {
        words.push_str(&format!(" of {table} {number}"));
    }
    if above.split('.').any(|table| table == "vertical") {
        words.push_str(", vertical");
    }
    (words, unit)
}

/// Quantity and unit of a key: `Half-width of block 2 [m]`.
pub fn label(key: &str) -> String {
    match quantity(key) {
        (name, "") => name,
        (name, unit) => format!("{name} [{unit}]"),
    }
}

/// A key and its value as the title of a panel: `3 blocks`, `η = 0.9`, a record's file.
pub fn title(key: &str, value: &str) -> String {
    match (key.rsplit('.').next().unwrap_or(key), value) {
        ("blocks", "1") => "1 block".into(),
        ("blocks", count) => format!("{count} blocks"),
        ("file" | "record" | "component" | "kind" | "method", name) => name.into(),
        _ => {
            let (name, unit) = quantity(key);
            let value = value.parse().map_or_else(|_| value.to_string(), brief);
            format!("{name} = {value} {unit}").trim_end().replace(" °", "°")
        }
    }
}

/// The values of an axis as numbers; `None` if one of them is not a finite number.
pub fn numbers(values: &[String]) -> Option<Vec<f64>> {
    let numbers: Option<Vec<f64>> = values.iter().map(|value| value.parse().ok()).collect();
    numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite()))
}

/// A title for each combination of the values of axes; the last axis varies fastest. An axis with a single value is not in the titles.
pub fn titles<'a>(axes: impl IntoIterator<Item = &'a Axis>) -> Vec<String> {
    let mut titles = vec![String::new()];
    for (key, values) in axes.into_iter().filter(|(_, values)| values.len() > 1) {
        let values = shortened(values);
        let with = |above: &String, value: &str| match above.as_str() {
            "" => title(key, value),
            above => format!("{above}, {}", title(key, value)),
        };
        titles = titles.iter().flat_map(|above| values.iter().map(move |value| with(above, value))).collect();
    }
    titles
}

/// Paths of files without the folder of the first one, if all are in that folder. Otherwise the texts are unchanged.
fn shortened(values: &[String]) -> Vec<&str> {
    let folder = |value: &str| value.rfind(['/', '\\']).map_or(0, |end| end + 1);
    let common = folder(&values[0]);
    let is_common = |value: &String| value.as_bytes().get(..common) == values[0].as_bytes().get(..common);
    let start = if values.iter().all(is_common) { common } else { 0 };
    values.iter().map(|value| &value[start..]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_centred_on_their_values_and_geometric_progressions_are_logarithmic() {
        let linear = Scale::of("omega_p", vec![3.0, 1.0, 2.0]);
        assert_eq!((linear.is_log, linear.ends, linear.share(2.0)), (false, [0.5, 3.5], 0.5));
        let log = Scale::of("omega_p", vec![0.1, 1.0, 10.0, 100.0]);
        assert!(log.is_log);
        for (place, value) in log.values.iter().enumerate() {
            let middle = 0.5 * (log.edges[place] + log.edges[place + 1]);
            assert!((log.share(*value) - middle).abs() < 1e-12);
        }
        assert!(!Scale::of("omega_p", vec![0.0, 1.0, 3.0]).is_log);
        assert!(!Scale::of("omega_p", vec![1.0, 2.0]).is_log);
    }

    #[test]
    fn labels_know_whole_keys_before_their_last_parts() {
        let labels =
            ["friction.static", "friction", "excitation.vertical.pga", "block[2].mass", "other.unknown"].map(label);
        let expected = [
            "Static friction coefficient",
            "Friction coefficient",
            "Peak ground acc., vertical [m/s²]",
            "Mass of block 2 [kg]",
            "unknown",
        ];
        assert_eq!(labels, expected);
    }

    #[test]
    fn ticks_are_round_and_inside() {
        let words = |values: Vec<f64>, count| -> Vec<String> {
            Scale::of("eta", values).ticks(count).into_iter().map(|(_, word)| word).collect()
        };
        assert_eq!(words((1..=20).map(|i| 0.5 * f64::from(i)).collect(), 3), ["2", "4", "6", "8", "10"]);
        assert_eq!(words(vec![0.1, 0.2, 0.4, 0.8, 1.6], 3), ["0.1", "0.2", "0.5", "1", "2"]);
        // Nine numbers do not fit where there is room for four.
        assert_eq!(words((-3..=5).map(|power| 10f64.powi(power)).collect(), 4).len(), 5);
        assert!(words(vec![2.1, 2.31, 2.541], 3).len() >= 3, "a narrow logarithmic axis");
    }

    #[test]
    fn keys_are_named_as_in_the_field() {
        assert_eq!(label("excitation.horizontal.omega_p"), "Ω / p");
        assert_eq!(label("excitation.vertical.amplitude_g"), "a, vertical [g]");
        assert_eq!(label("block[2].mass"), "Mass of block 2 [kg]");
        assert_eq!(["1", "5"].map(|count| title("column.blocks", count)), ["1 block", "5 blocks"]);
        assert_eq!(title("restitution.eta", "0.9"), "η = 0.9");
        assert_eq!(title("block[2].half_height", "0.6"), "Half-height of block 2 = 0.6 m");
        assert_eq!(title("excitation.vertical.frequency", "2"), "Frequency, vertical = 2 Hz");
        assert_eq!(title("friction.kinetic[1]", "0.5"), "Kinetic friction coefficient of interface 1 = 0.5");
        assert_eq!(label("initial.theta[1]"), "Initial θ of block 1 [rad]");
        assert_eq!(label("initial.slide[2]"), "Initial slide of interface 2 [m]");
        assert_eq!(label("restitution.factors[2]"), "Restitution factor of interface 2");
        assert_eq!(label("excitation.vertical.term[2].amplitude"), "a of term 2, vertical [m/s²]");
        assert_eq!(label("excitation.horizontal.accel[2]"), "accel[2]");
        assert_eq!(title("column.half_width", "0.4"), "Half-width = 0.4 m");
        assert_eq!(title("excitation.horizontal.file", "a/b.AT2"), "a/b.AT2");
        assert_eq!(shortened(&["r/a".into(), "s/a".into()]), ["r/a", "s/a"]);
    }
}
