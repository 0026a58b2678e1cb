//! The reference of a kind of file as text, from its schema: a heading per table, a line per key.

use super::kind::Kind;
use serde_json::{Map, Value};
use std::fmt::Write as _;

/// A table of a file.
struct Table {
    /// As it is written, such as `[solver]`, `[[block]]`.
    heading: String,
    /// Keys of the table.
    keys: Vec<Key>,
}

/// A key with its description, as printed text.
struct Key {
    name: String,
    kind: String,
    unit: String,
    default: String,
    meaning: String,
}

/// Largest width of a type in its column [characters], since the widest type sets the width of the column.
/// The choices of a wider type are listed after the meaning.
const WIDEST_TYPE: usize = 40;

/// The reference of a kind of file.
pub fn list(kind: Kind) -> String {
    let schema = kind.schema().to_value();
    let mut tables = Vec::new();
    collect(&Schema { root: &schema }, &schema, "", &mut tables);
    let mut text = String::new();
    for Table { heading, keys } in tables {
        let _ = writeln!(text, "{heading}");
        let column = |text: fn(&Key) -> &String| keys.iter().map(|key| text(key).chars().count()).max().unwrap_or(0);
        let [name, kind, unit] = [column(|key| &key.name), column(|key| &key.kind), column(|key| &key.unit)];
        for key in &keys {
            let _ = writeln!(
                text,
                "  {:name$}  {:kind$}  {:unit$}  {}; default: {}",
                key.name, key.kind, key.unit, key.meaning, key.default
            );
        }
        text.push('\n');
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

/// A schema whose definitions are found by their references.
struct Schema<'s> {
    root: &'s Value,
}

impl<'s> Schema<'s> {
    /// The definition that a value refers to; the value itself if it refers to none.
    fn resolved(&self, value: &'s Value) -> &'s Value {
        let reference = value.get("$ref").and_then(Value::as_str).and_then(|reference| reference.strip_prefix('#'));
        reference.and_then(|pointer| self.root.pointer(pointer)).unwrap_or(value)
    }

    /// Alternatives of a value, with nested ones resolved; the value itself if it has none.
    /// `null`, which marks a key that may be absent, is no alternative.
    fn alternatives(&self, value: &'s Value) -> Vec<&'s Value> {
        let value = self.resolved(value);
        let parts = ["anyOf", "oneOf"].iter().find_map(|key| value.get(*key)).and_then(Value::as_array);
        match parts {
            Some(parts) => {
                parts.iter().filter(|part| !is_null(part)).flat_map(|part| self.alternatives(part)).collect()
            }
            None => vec![value],
        }
    }

    /// Keys of a value that is a table or a list of tables, and whether it is a list. `None` for any other value.
    fn table(&self, value: &'s Value) -> Option<(&'s Map<String, Value>, bool)> {
        let of = |value: &'s Value| value.get("properties").and_then(Value::as_object);
        self.alternatives(value).into_iter().find_map(|part| {
            let item = || part.get("items").and_then(|item| of(self.resolved(item)));
            of(part).map(|keys| (keys, false)).or_else(|| item().map(|keys| (keys, true)))
        })
    }

    /// The type of a value in words, such as `number` or the names allowed; of numbers with their bounds.
    fn kind(&self, value: &'s Value, bounds: &Value) -> String {
        let mut kinds: Vec<String> = Vec::new();
        for part in self.alternatives(value) {
            let names = part.get("enum").and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
            let names = names.iter().chain(part.get("const")).filter_map(Value::as_str);
            let names: Vec<String> = names.map(ToString::to_string).collect();
            let kind = match part.get("type").map(types).unwrap_or_default().first().copied() {
                _ if !names.is_empty() => names.join(" | "),
                Some("number") => bounded("number", bounds),
                Some("integer") => bounded("whole number", bounds),
                Some("boolean") => "true or false".into(),
                Some("array") => match part.get("items").map(|item| self.kind(item, &Value::Null)).as_deref() {
                    Some("number") => "list of numbers".into(),
                    Some("text") => "list of texts".into(),
                    Some("table") => "tables".into(),
                    _ => "list".into(),
                },
                Some("object") => "table".into(),
                _ => "text".into(),
            };
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        let is_choice = kinds.len() > 3 || kinds.iter().all(|kind| kind.contains(" | "));
        kinds.join(if is_choice { " | " } else { " or " })
    }
}

fn is_null(part: &Value) -> bool {
    part.get("type").and_then(Value::as_str) == Some("null")
}

/// The types of a value, `null` left out.
fn types(value: &Value) -> Vec<&str> {
    let one = value.as_str().into_iter();
    one.chain(value.as_array().into_iter().flatten().filter_map(Value::as_str)).filter(|name| *name != "null").collect()
}

/// A kind of number with its bounds.
fn bounded(kind: &str, bounds: &Value) -> String {
    let of =
        |key: &str, sign: &str| bounds.get(key).and_then(Value::as_f64).map(|bound| format!("{sign} {}", brief(bound)));
    let bounds = [("minimum", "≥"), ("exclusiveMinimum", ">"), ("maximum", "≤"), ("exclusiveMaximum", "<")];
    let parts: Vec<String> = bounds.into_iter().filter_map(|(key, sign)| of(key, sign)).collect();
    // Whole numbers have no sign: zero as the only bound is not stated.
    if parts.is_empty() || (kind == "whole number" && parts == ["≥ 0"]) {
        return kind.into();
    }
    format!("{kind} {}", parts.join(", "))
}

/// A bound with few digits.
fn brief(bound: f64) -> String {
    match bound {
        bound if bound == std::f64::consts::PI => "pi".into(),
        bound if bound == std::f64::consts::FRAC_PI_2 => "pi/2".into(),
        bound if bound != 0.0 && (bound.abs() < 1e-3 || bound.abs() >= 1e5) => format!("{bound:e}"),
        bound => bound.to_string(),
    }
}

/// Collects a table and the tables within it.
fn collect<'s>(schema: &Schema<'s>, value: &'s Value, path: &str, tables: &mut Vec<Table>) {
    let Some((properties, is_list)) = schema.table(value) else { return };
    let owner = schema.alternatives(value).into_iter().find(|part| part.get("properties").is_some()).unwrap_or(value);
    let owner = if is_list {
        let items = schema.alternatives(value).into_iter().find_map(|part| part.get("items"));
        items.map_or(owner, |items| schema.resolved(items))
    } else {
        owner
    };
    let required = owner.get("required").and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    let text = |value: &Value, key: &str| value.get(key).and_then(Value::as_str).unwrap_or_default().to_string();
    let key = |(name, own): (&String, &'s Value)| {
        let (mut kind, mut meaning) =
            (schema.kind(own, own), text(own, "description").split_whitespace().collect::<Vec<_>>().join(" "));
        if kind.chars().count() > WIDEST_TYPE {
            meaning = format!("{meaning}: {kind}");
            kind = "a name".into();
        }
        let default = match text(own, "x-default") {
            _ if required.iter().any(|required| required.as_str() == Some(name)) => "required".into(),
            default if default.is_empty() => "see below".into(),
            default => default,
        };
        Key { name: name.clone(), kind, unit: text(own, "x-unit"), default, meaning }
    };
    let heading = match (path, is_list) {
        ("", _) => "top level".into(),
        (path, true) => format!("[[{path}]]"),
        (path, false) => format!("[{path}]"),
    };
    tables.push(Table { heading, keys: properties.iter().map(key).collect() });
    for (name, own) in properties {
        // Not listed again: `vertical` has the keys of `horizontal`, `term` those of a component, `scene` those of scene files.
        let is_reported = name == "term" || name == "vertical" || path.is_empty() && name == "scene";
        if !is_reported {
            let below = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
            collect(schema, own, &below, tables);
            of_any_name(schema, own, &below, tables);
        }
    }
}

/// Collects the tables that stand below any name, such as the range or the distribution of an axis.
fn of_any_name<'s>(schema: &Schema<'s>, value: &'s Value, path: &str, tables: &mut Vec<Table>) {
    let below = schema.alternatives(value).into_iter().find_map(|part| part.get("additionalProperties"));
    for part in below.map(|below| schema.alternatives(below)).unwrap_or_default() {
        let before = tables.len();
        collect(schema, part, path, tables);
        if let Some(table) = tables.get_mut(before) {
            let what = part.get("description").and_then(Value::as_str).unwrap_or_default().trim_end_matches('.');
            let mut letters = what.chars();
            let first = letters.next().map(|letter| letter.to_lowercase().to_string()).unwrap_or_default();
            table.heading = format!("[{path}.KEY] {first}{}", letters.as_str());
        }
    }
}
