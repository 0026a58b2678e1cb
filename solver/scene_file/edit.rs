//! Changes of the values in a table: keys are set by their dotted names, and replace keys that they exclude.

use super::key_value::Setting;
use super::table::{Entry, Table, Value, index, without_index};
use std::sync::Arc;

impl Value {
    fn of(setting: &Setting) -> Value {
        match setting {
            Setting::Number(number) => Value::Number(*number),
            Setting::Text(text) => Value::Text(text.as_str().into()),
        }
    }
}

impl Table {
    /// Whether the file gives a table of this dotted name.
    pub fn has_table(&self, name: &str) -> bool {
        let (first, rest) = name.split_once('.').map_or((name, None), |(first, rest)| (first, Some(rest)));
        match (self.entry(first).map(|entry| &entry.value), rest) {
            (Some(Value::Table(table)), Some(rest)) => table.has_table(rest),
            (Some(Value::Table(_)), None) => true,
            _ => false,
        }
    }

    /// Sets a key, given by its dotted name, to a value. Tables that are missing are made, lists and their items are not.
    /// `block[2].mass` is of the second block, `initial.theta[2]` the second item of a list. `None` if a list or item is missing, or if
    /// something else stands in place of a table or list.
    pub fn set(&mut self, key: &str, value: &Setting) -> Option<()> {
        let (first, rest) = key.split_once('.').map_or((key, None), |(first, rest)| (first, Some(rest)));
        let (name, index) = match first.split_once('[') {
            Some((name, _)) => (name, Some(index(first)?)),
            None => (first, None),
        };
        if rest.is_none() && index.is_none() {
            self.set_own(name, Value::of(value));
            return Some(());
        }
        if !self.has(name) && index.is_none() {
            let (place, dotted) = (self.place(), self.dotted(name));
            let table = Table::empty(dotted, place.clone());
            let value = Value::Table(table);
            Arc::make_mut(&mut self.entries).push(Entry {
                key: name.into(),
                key_place: place.clone(),
                value_place: place,
                value,
            });
        }
        if rest.is_some() {
            self.lengthen(name);
        }
        let entries = Arc::make_mut(&mut self.entries);
        let found = match (&mut entries.iter_mut().find(|entry| *entry.key == *name)?.value, index) {
            (Value::Array(items), Some(index)) => &mut Arc::make_mut(items).get_mut(index)?.0,
            (found, None) => found,
            _ => return None,
        };
        match (found, rest) {
            (Value::Table(table), Some(rest)) => table.set(rest, value),
            (Value::Table(_), None) | (_, Some(_)) => None,
            (item, None) => {
                *item = Value::of(value);
                Some(())
            }
        }
    }

    /// Writes the short form of a table as the table: `friction = 0.7` as `[friction] static = 0.7`.
    fn lengthen(&mut self, name: &str) {
        let Some((_, key)) = SHORT_FORMS.into_iter().find(|(short, _)| *short == name) else { return };
        let dotted = self.dotted(name);
        let Some(entry) = Arc::make_mut(&mut self.entries).iter_mut().find(|entry| *entry.key == *name) else { return };
        if !matches!(entry.value, Value::Table(_)) {
            let mut table = Table::empty(dotted, entry.key_place.clone());
            let value = std::mem::replace(&mut entry.value, Value::Number(0.0));
            table.set_own(key, value);
            entry.value = Value::Table(table);
        }
    }

    /// Sets a key of this table itself. A key that is new removes its alternatives, and what is of use with these alone.
    fn set_own(&mut self, name: &str, value: Value) {
        // The usual case in a sweep: the key is there, and no alternative of it.
        if let Some(entry) = Arc::make_mut(&mut self.entries).iter_mut().find(|entry| *entry.key == *name) {
            entry.value = value;
            return;
        }
        let place = self.find(name);
        let entries = Arc::make_mut(&mut self.entries);
        entries.retain(|entry| *entry.key != *name && !replaced_by(name).any(|other| *entry.key == *other));
        entries.push(Entry { key: name.into(), key_place: place.clone(), value_place: place, value });
    }

    /// Dotted names of all keys called `name`, in this table and in tables within, but not in lists. Keys whose values are tables do not count.
    pub fn named(&self, name: &str) -> Vec<String> {
        let of_entry = |entry: &Entry| match &entry.value {
            Value::Table(table) => table.named(name),
            _ if *entry.key == *name => vec![self.dotted(name)],
            _ => Vec::new(),
        };
        self.entries.iter().flat_map(of_entry).collect()
    }
}

impl Table {
    /// The key that stands in the file for a dotted key that does not: `excitation.horizontal.amplitude_g` for its `amplitude`. `None` where the key
    /// itself is given, or nothing in its place.
    pub fn stand_in(&self, key: &str) -> Option<String> {
        self.given(key).filter(|given| given != key)
    }

    /// A dotted key if it is given, or the key that stands in its place; `None` if there is neither.
    pub fn given(&self, key: &str) -> Option<String> {
        if let Some((first, rest)) = key.split_once('.') {
            let entry = self.entry(first).or_else(|| self.entry(without_index(first)))?;
            let table = match &entry.value {
                Value::Table(table) => table,
                Value::Array(items) => match items.get(index(first)?)? {
                    (Value::Table(table), _) => table,
                    _ => return None,
                },
                _ => return None,
            };
            return table.given(rest).map(|rest| format!("{first}.{rest}"));
        }
        let others = ALTERNATIVES.iter().filter(|group| group.contains(&key)).flat_map(|group| *group);
        std::iter::once(&key).chain(others).find(|own| self.has(own)).map(|own| own.to_string())
    }
}

/// Groups of keys of which a table takes one. Setting a new one removes the others.
const ALTERNATIVES: [&[&str]; 10] = [
    &["half_width", "width", "diameter"],
    &["bottom_half_width", "bottom_width", "bottom_diameter"],
    &["top_half_width", "top_width", "top_diameter"],
    &["half_height", "height"],
    &["p", "rocking_period", "R"],
    &["amplitude", "amplitude_g", "amplitude_uplift", "velocity"],
    &["omega", "frequency", "period", "omega_p"],
    &["scale", "pga", "pga_g", "pga_uplift", "pgv", "pgv_uplift", "pgd", "arias", "cav", "sa", "sa_g"],
    &["density", "mass"],
    &["eta", "factors", "law"],
];

/// Sizes of a record on a response spectrum, and the keys of the oscillator, which serve them alone.
const SPECTRAL: [&str; 2] = ["sa", "sa_g"];
const OF_SPECTRAL: [&str; 2] = ["sa_period", "sa_damping"];

/// The size that serves a density alone.
const OF_DENSITY: &str = "depth";

/// Keys whose value may stand for a table, and the key in that table.
const SHORT_FORMS: [(&str, &str); 1] = [("friction", "static")];

/// Whether two different keys, given by their dotted names, exclude each other in a scene.
pub fn exclude_each_other(a: &str, b: &str) -> bool {
    let parts = |key: &str| {
        let (table, name) = key.rsplit_once('.').unwrap_or(("", key));
        (table.to_string(), without_index(name).to_string())
    };
    let ((table, name), (other_table, other_name)) = (parts(a), parts(b));
    let is_short_form = |short: &str, table: &str| SHORT_FORMS.iter().any(|(key, _)| short == *key && table == *key);
    table == other_table && name != other_name && are_alternatives(&name, &other_name)
        || is_short_form(a, &other_table)
        || is_short_form(b, &table)
}

/// Keys that a new key of the same table replaces: those of which a table takes one, and what is of use with these alone.
///
/// ```
/// use rocking::scene_file::replaced_by;
/// assert_eq!(replaced_by("mass").collect::<Vec<_>>(), ["density", "depth"]);
/// assert_eq!(replaced_by("rtol").count(), 0);
/// ```
pub fn replaced_by(name: &str) -> impl Iterator<Item = &'static str> {
    let groups = ALTERNATIVES.iter().filter(move |group| group.contains(&name)).flat_map(|group| *group);
    let is_size = are_alternatives(SPECTRAL[0], name) && !SPECTRAL.contains(&name);
    let of_spectral = OF_SPECTRAL.into_iter().filter(move |_| is_size);
    let of_density = std::iter::once(OF_DENSITY).filter(move |_| name == "mass");
    groups.copied().filter(move |other| *other != name).chain(of_spectral).chain(of_density)
}

fn are_alternatives(a: &str, b: &str) -> bool {
    ALTERNATIVES.iter().any(|group| group.contains(&a) && group.contains(&b))
}
