//! A TOML table that knows where each key and value stands in the file, and which keys have been asked for.

use super::key_value::Setting;
use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::sync::Arc;
use toml::de::{DeTable, DeValue};

/// A range of the file, in bytes.
pub type Place = std::ops::Range<usize>;

/// Something wrong at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrong {
    /// Place in the file.
    pub place: Place,
    /// Dotted key.
    pub key: String,
    /// What is wrong.
    pub problem: String,
    /// What to do.
    pub remedy: String,
    /// What is at fault: a key or a value.
    pub cause: Cause,
}

/// What is at fault in a scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// A key is unknown or missing, or excluded by another one, or its value is of the wrong kind.
    Key,
    /// A value is out of range, or does not go with others; or the text is not TOML.
    Value,
}

/// A key and its value, with their places in the file.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(super) key: Arc<str>,
    pub(super) key_place: Place,
    pub(super) value_place: Place,
    pub(super) value: Value,
}

#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(Arc<str>),
    Number(f64),
    Flag(bool),
    Array(Arc<Vec<(Value, Place)>>),
    Table(Table),
    Other(&'static str),
}

impl Value {
    fn what(&self) -> &'static str {
        match self {
            Value::Text(_) => "text",
            Value::Number(_) => "a number",
            Value::Flag(_) => "true or false",
            Value::Array(_) => "a list",
            Value::Table(_) => "a table",
            Value::Other(what) => what,
        }
    }

    /// The kind of the value in words; of a number, the number itself.
    fn shown(&self) -> String {
        if let Value::Number(number) = self { number.to_string() } else { self.what().into() }
    }

    fn apart(&self) -> Value {
        match self {
            Value::Text(text) => Value::Text((**text).into()),
            Value::Array(items) => {
                Value::Array(Arc::new(items.iter().map(|(item, place)| (item.apart(), place.clone())).collect()))
            }
            Value::Table(table) => Value::Table(table.apart()),
            other => other.clone(),
        }
    }
}

/// Number of keys that a table is usually asked for; room for them is reserved.
const USUAL_KEYS: usize = 16;

thread_local! {
    /// Dotted keys that readers on this thread have asked for; `None` unless [`keys_asked_by`] collects them.
    static ASKED: RefCell<Option<BTreeSet<String>>> = const { RefCell::new(None) };
}

/// What `read` returns, and the dotted keys that it has asked for in tables that it closed: keys that a file may have, whether it has them or not.
/// For the test that compares the reference of keys with the reader.
#[doc(hidden)]
pub fn keys_asked_by<T>(read: impl FnOnce() -> T) -> (T, BTreeSet<String>) {
    ASKED.set(Some(BTreeSet::new()));
    let result = read();
    (result, ASKED.take().unwrap_or_default())
}

/// A table while it is read.
#[derive(Clone, Debug)]
pub struct Table {
    /// Dotted name, empty at the root.
    name: Arc<str>,
    place: Place,
    /// Entries, shared by copies of the table: a sweep reads a copy for each scene.
    pub(super) entries: Arc<Vec<Entry>>,
    /// Keys that a reader has asked for: the keys that are known in this table.
    asked: Vec<Cow<'static, str>>,
}

impl Table {
    /// A table without entries.
    pub(super) fn empty(name: impl Into<Arc<str>>, place: Place) -> Table {
        Table { name: name.into(), place, entries: Arc::default(), asked: Vec::new() }
    }

    /// Reads TOML.
    pub fn parse(text: &str) -> Result<Table, Wrong> {
        let (tree, errors) = DeTable::parse_recoverable(text);
        if let Some(error) = errors.first() {
            let place = error.span().unwrap_or(0..0);
            let start = place.start.min(text.len());
            let line_start = text.as_bytes()[..start].iter().rposition(|b| *b == b'\n').map_or(0, |at| at + 1);
            let line = text[line_start..].lines().next().unwrap_or("");
            let key = line.split('=').next().unwrap_or("").trim().to_string();
            let problem = format!("this is not TOML: {}", error.message().lines().collect::<Vec<_>>().join(", "));
            return Err(Wrong {
                place,
                key,
                problem,
                remedy: format!("correct the line; {}", hint(error.message(), line)),
                cause: Cause::Value,
            });
        }
        let place = tree.span();
        Ok(Table::from_tree("", place, tree.into_inner()))
    }

    fn from_tree(name: &str, place: Place, tree: DeTable<'_>) -> Table {
        let mut entries = Vec::new();
        for (key, value) in tree {
            let (key_place, value_place) = (key.span(), value.span());
            let key = key.into_inner();
            let value = value_from_tree(&dot(name, &key), value_place.clone(), value.into_inner());
            entries.push(Entry { key: key.into(), key_place, value_place, value });
        }
        // In the order of the file, so that of several faults the first is named.
        entries.sort_by_key(|entry| entry.key_place.start);
        Table { name: name.into(), place, entries: Arc::new(entries), asked: Vec::new() }
    }

    /// A deep copy: each thread owns its table, so that no `Arc` count is contended.
    pub fn apart(&self) -> Table {
        let entry = |entry: &Entry| Entry { key: (*entry.key).into(), value: entry.value.apart(), ..entry.clone() };
        let entries = Arc::new(self.entries.iter().map(entry).collect());
        Table { name: (*self.name).into(), entries, ..self.clone() }
    }

    /// The full name of a key of this table.
    pub fn dotted(&self, key: &str) -> String {
        dot(&self.name, key)
    }

    /// Where the table stands.
    pub fn place(&self) -> Place {
        self.place.clone()
    }

    /// Whether the file gives this key.
    pub fn has(&self, key: &str) -> bool {
        self.entries.iter().any(|entry| *entry.key == *key)
    }

    /// The keys, in the order of the file.
    pub fn keys(&self) -> Vec<String> {
        self.entries.iter().map(|entry| entry.key.to_string()).collect()
    }

    /// The value as a list: a number or a text alone gives a list of one. `None` if the key is not given or is that of a table.
    pub fn settings(&mut self, key: &str) -> Result<Option<Vec<Setting>>, Wrong> {
        let single = |value: &Value| match value {
            Value::Number(number) if number.is_finite() => Some(Setting::Number(*number)),
            Value::Text(text) => Some(Setting::Text(text.to_string())),
            _ => None,
        };
        self.ask(key.to_string());
        let Some(entry) = self.entry(key) else { return Ok(None) };
        let needed = "finite numbers or texts";
        match &entry.value {
            Value::Array(items) => {
                let item = |(number, (item, _)): (usize, &(Value, Place))| {
                    single(item).ok_or_else(|| {
                        let what = format!("item {} of the list is {}", number + 1, item.shown());
                        self.wrong(key, what, &format!("give {needed}"))
                    })
                };
                items.iter().enumerate().map(item).collect::<Result<_, _>>().map(Some)
            }
            Value::Table(_) => Ok(None),
            value => single(value).map(|value| Some(vec![value])).ok_or_else(|| self.expected(key, value, needed)),
        }
    }

    /// Place of a dotted key. If the key is not given, the place of the innermost table on the way to it.
    pub fn find(&self, key: &str) -> Place {
        // In quotes, a key may have points of its own.
        let (first, rest) = match key.split_once('.') {
            Some((first, rest)) if !self.has(key) => (first, Some(rest)),
            _ => (key, None),
        };
        let entry = self.entry(first).or_else(|| self.entry(without_index(first)));
        if let Some(Entry { value: Value::Array(items), .. }) = entry
            && let Some((item, place)) = index(first).and_then(|index| items.get(index))
        {
            return match (item, rest) {
                (Value::Table(table), Some(rest)) => table.find(rest),
                _ => place.clone(),
            };
        }
        match (entry, rest) {
            (Some(Entry { value: Value::Table(table), .. }), Some(rest)) => table.find(rest),
            (Some(entry), _) => entry.key_place.start..entry.value_place.end.max(entry.key_place.end),
            (None, _) => self.place(),
        }
    }

    /// An error at a key.
    pub fn wrong(&self, key: &str, problem: String, remedy: &str) -> Wrong {
        let (place, key) = (self.find(key), self.dotted(key));
        Wrong { place, key, problem, remedy: remedy.into(), cause: Cause::Value }
    }

    /// The error that a key is given beside another one that excludes it.
    pub fn clash(&self, key: &str, other: &str) -> Wrong {
        let wrong = self.wrong(key, format!("`{other}` is given as well"), "remove one of the two");
        Wrong { cause: Cause::Key, ..wrong }
    }

    /// The error that a key is not given, or that it is misspelt.
    pub fn missing(&self, key: &str, remedy: &str) -> Wrong {
        let unasked = || self.entries.iter().filter(|entry| !self.has_asked(&entry.key));
        if let Some(misspelt) = unasked().find(|entry| is_slip(key, &entry.key)) {
            return self.unknown(misspelt, format!("did you mean `{key}`?"));
        }
        // Another key that would do in its place: `heigth` for `height`, where `half_height` is missing.
        let other = |entry| Some((entry, self.meant(entry).filter(|known| !self.has(known))?));
        if let Some((misspelt, known)) = unasked().find_map(other) {
            return self.unknown(misspelt, format!("did you mean `{known}`?"));
        }
        let (place, key) = (self.place(), self.dotted(key));
        Wrong { place, key, problem: "it is missing".into(), remedy: remedy.into(), cause: Cause::Key }
    }

    /// Notes that a key is known here.
    fn ask(&mut self, key: impl Into<Cow<'static, str>>) {
        if self.asked.is_empty() {
            self.asked.reserve(USUAL_KEYS);
        }
        self.asked.push(key.into());
    }

    pub(super) fn entry(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| *entry.key == *key)
    }

    fn has_asked(&self, key: &str) -> bool {
        self.asked.iter().any(|asked| asked == key)
    }

    fn expected(&self, key: &str, found: &Value, needed: &str) -> Wrong {
        let wrong = self.wrong(key, format!("{} stands here", found.what()), &format!("give {needed}"));
        Wrong { cause: Cause::Key, ..wrong }
    }

    /// Text.
    pub fn text(&mut self, key: &'static str) -> Result<Option<String>, Wrong> {
        self.ask(key);
        match self.entry(key) {
            None => Ok(None),
            Some(Entry { value: Value::Text(text), .. }) => Ok(Some(text.to_string())),
            Some(entry) => Err(self.expected(key, &entry.value, "text in quotes")),
        }
    }

    /// A finite number.
    pub fn number(&mut self, key: &'static str) -> Result<Option<f64>, Wrong> {
        self.ask(key);
        match self.entry(key) {
            None => Ok(None),
            Some(Entry { value: Value::Number(value), .. }) if value.is_finite() => Ok(Some(*value)),
            Some(Entry { value: Value::Number(value), .. }) => {
                Err(self.wrong(key, format!("{value} is not finite"), "give a finite number"))
            }
            Some(entry) => Err(self.expected(key, &entry.value, "a number")),
        }
    }

    /// True or false.
    pub fn flag(&mut self, key: &'static str) -> Result<Option<bool>, Wrong> {
        self.ask(key);
        match self.entry(key) {
            None => Ok(None),
            Some(Entry { value: Value::Flag(flag), .. }) => Ok(Some(*flag)),
            Some(entry) => Err(self.expected(key, &entry.value, "true or false, without quotes")),
        }
    }

    /// A name, or a number in its place, as text.
    pub fn name(&mut self, key: &'static str) -> Result<Option<String>, Wrong> {
        self.ask(key);
        match self.entry(key) {
            None => Ok(None),
            Some(Entry { value: Value::Text(text), .. }) => Ok(Some(text.to_string())),
            Some(Entry { value: Value::Number(number), .. }) => Ok(Some(format!("{number}"))),
            Some(entry) => Err(self.expected(key, &entry.value, "a name in quotes, or a number")),
        }
    }

    /// A finite number above zero.
    pub fn positive(&mut self, key: &'static str) -> Result<Option<f64>, Wrong> {
        match self.number(key)? {
            Some(value) if value <= 0.0 => {
                Err(self.wrong(key, format!("{value} is out of range"), "give a finite number above zero"))
            }
            found => Ok(found),
        }
    }

    /// A list of finite numbers.
    pub fn numbers(&mut self, key: &'static str) -> Result<Option<Vec<f64>>, Wrong> {
        self.ask(key);
        let items = match self.entry(key) {
            None => return Ok(None),
            Some(Entry { value: Value::Array(items), .. }) => items,
            Some(entry) => return Err(self.expected(key, &entry.value, "a list of numbers")),
        };
        let mut numbers = Vec::with_capacity(items.len());
        for (index, (item, place)) in items.iter().enumerate() {
            match item {
                Value::Number(value) if value.is_finite() => numbers.push(*value),
                other => {
                    let problem = format!("number {} of the list is {}", index + 1, other.shown());
                    let (place, key) = (place.clone(), self.dotted(key));
                    return Err(Wrong {
                        place,
                        key,
                        problem,
                        remedy: "give finite numbers".into(),
                        cause: Cause::Value,
                    });
                }
            }
        }
        Ok(Some(numbers))
    }

    /// A finite number, or a list of them.
    pub fn number_or_numbers(&mut self, key: &'static str) -> Result<Option<Vec<f64>>, Wrong> {
        match self.entry(key).map(|entry| &entry.value) {
            None | Some(Value::Array(_)) => self.numbers(key),
            Some(Value::Number(_)) => Ok(self.number(key)?.map(|value| vec![value])),
            Some(other) => Err(self.expected(key, other, "a number, or a list of numbers")),
        }
    }

    /// A whole number from `least` on.
    pub fn whole(&mut self, key: &'static str, least: u32) -> Result<Option<u64>, Wrong> {
        self.whole_up_to(key, least, LARGEST_WHOLE)
    }

    /// A whole number from `least` to `most`.
    pub fn whole_up_to(&mut self, key: &'static str, least: u32, most: f64) -> Result<Option<u64>, Wrong> {
        match self.number(key)? {
            Some(value) if value.fract() != 0.0 || value < f64::from(least) || value > most => {
                // The remedy names the bound of doubles only to a number beyond it: the caller may have a lower bound.
                let end = if most < LARGEST_WHOLE || value > most { format!("to {most:e}") } else { "on".into() };
                let remedy = format!("give a whole number from {least} {end}");
                Err(self.wrong(key, format!("{value} is out of range"), &remedy))
            }
            found => Ok(found.map(|value| value as u64)),
        }
    }

    /// The error that the text of a key is none of `known`; the remedy suggests the nearest one.
    pub fn no_such(&self, key: &str, what: &str, text: &str, known: &[&str]) -> Wrong {
        let nearest =
            known.iter().min_by_key(|name| strsim::levenshtein(name, text)).filter(|name| is_slip(name, text));
        let guess = nearest.map_or(String::new(), |name| format!("did you mean `{name}`? "));
        let remedy = format!("{guess}choose one of {}", known.join(", "));
        // An error has one line: a break would pass for a message of its own.
        let text = text.replace('\n', "\\n").replace('\r', "\\r");
        self.wrong(key, format!("there is no {what} `{text}`"), &remedy)
    }

    /// Exactly one of several keys, each with its conversion.
    pub fn one_of(&mut self, keys: &[(&'static str, &dyn Fn(f64) -> f64)]) -> Result<f64, Wrong> {
        let mut found: Option<(&str, f64)> = None;
        for (key, convert) in keys {
            let Some(value) = self.number(key)? else { continue };
            if let Some((first, _)) = found {
                return Err(self.clash(key, first));
            }
            found = Some((key, convert(value)));
        }
        found.map(|(_, value)| value).ok_or_else(|| {
            let names: Vec<String> = keys.iter().map(|(key, _)| format!("`{key}`")).collect();
            self.missing(keys[0].0, &format!("give one of {}", names.join(", ")))
        })
    }

    /// A table within.
    pub fn table(&mut self, key: impl Into<Cow<'static, str>>) -> Result<Option<Table>, Wrong> {
        let key = key.into();
        self.ask(key.clone());
        match self.entry(&key) {
            None => Ok(None),
            Some(Entry { value: Value::Table(table), key_place, .. }) => {
                Ok(Some(Table { place: key_place.clone(), ..table.clone() }))
            }
            Some(entry) => Err(self.expected(&key, &entry.value, &format!("a table: [{}]", self.dotted(&key)))),
        }
    }

    /// An array of tables.
    pub fn tables(&mut self, key: &'static str) -> Result<Option<Vec<Table>>, Wrong> {
        self.ask(key);
        let items = match self.entry(key) {
            None => return Ok(None),
            Some(Entry { value: Value::Array(items), .. }) => items,
            Some(entry) => return Err(self.expected(key, &entry.value, &format!("tables: [[{}]]", self.dotted(key)))),
        };
        let as_table = |(index, (item, place)): (usize, &(Value, Place))| match item {
            Value::Table(table) => {
                let name = format!("{}[{}]", self.dotted(key), index + 1).into();
                Ok(Table { name, place: place.clone(), ..table.clone() })
            }
            other => Err(self.expected(key, other, &format!("tables: [[{}]]", self.dotted(key)))),
        };
        items.iter().enumerate().map(as_table).collect::<Result<Vec<Table>, Wrong>>().map(Some)
    }

    /// Refuses keys that were never requested.
    pub fn close(&self) -> Result<(), Wrong> {
        ASKED.with_borrow_mut(|asked| {
            if let Some(asked) = asked {
                asked.extend(self.asked.iter().map(|key| self.dotted(key)));
            }
        });
        let Some(unknown) = self.entries.iter().find(|entry| !self.has_asked(&entry.key)) else { return Ok(()) };
        let remedy = match (self.meant(unknown), self.table_of(&unknown.key)) {
            (Some(known), _) => format!("did you mean `{known}`?"),
            (None, Some(table)) => format!("write it below [{table}]"),
            _ if !self.name.is_empty() && OF_NO_TABLE.contains(&&*unknown.key) => {
                format!(
                    "move it to the top of the file, above all tables: below the line [{}] it belongs to that table",
                    self.name
                )
            }
            _ if &*self.name == "excitation" => {
                "write it below [excitation.horizontal] or [excitation.vertical]".into()
            }
            _ => format!("known here are {}: take one of these, or remove it", self.asked.join(", ")),
        };
        Err(self.unknown(unknown, remedy))
    }

    /// The key, of those known here so far, that an unknown one most likely means.
    fn meant(&self, unknown: &Entry) -> Option<&str> {
        let distance = |known: &&Cow<str>| {
            let lower = [known.as_ref(), &*unknown.key].map(str::to_lowercase);
            (strsim::levenshtein(&lower[0], &lower[1]), strsim::levenshtein(known, &unknown.key))
        };
        let nearest = self.asked.iter().min_by_key(distance).map(Cow::as_ref);
        let usual = USUAL_NAMES.iter().find(|(other, key)| **other == *unknown.key && self.has_asked(key));
        usual.map(|(_, key)| *key).or(nearest.filter(|known| is_slip(known, &unknown.key)))
    }

    /// The other table of the scene to which a key belongs. `None` for keys of no table in [`OF_A_TABLE`], and where this table is of no scene.
    fn table_of(&self, key: &str) -> Option<String> {
        let (table, _) = OF_A_TABLE.iter().find(|(_, keys)| keys.contains(&key))?;
        // A study has its scene in a table.
        let (study, name) = match self.name.strip_prefix("scene") {
            Some(rest) => ("scene.", rest.trim_start_matches('.')),
            None => ("", self.name.as_ref()),
        };
        let outermost = name.split(['.', '[']).next().unwrap_or_default();
        (SCENE_TABLES.contains(&outermost) || self.has_asked(table)).then(|| format!("{study}{table}"))
    }

    fn unknown(&self, entry: &Entry, remedy: String) -> Wrong {
        let (place, key) = (entry.key_place.clone(), self.dotted(&entry.key));
        Wrong { place, key, problem: "this key is unknown here".into(), remedy, cause: Cause::Key }
    }
}

/// Index from zero of `block[2]`.
pub fn index(name: &str) -> Option<usize> {
    let (_, index) = name.strip_suffix(']')?.split_once('[')?;
    let number: usize = index.parse().ok().filter(|number: &usize| number.to_string() == index)?;
    number.checked_sub(1)
}

/// `block` of `block[2]`.
pub fn without_index(name: &str) -> &str {
    name.split('[').next().unwrap_or(name)
}

fn dot(name: &str, key: &str) -> String {
    if name.is_empty() { key.into() } else { format!("{name}.{key}") }
}

fn value_from_tree(name: &str, place: Place, value: DeValue<'_>) -> Value {
    match value {
        DeValue::String(text) => Value::Text(text.into()),
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
            .map_or(Value::Other("too large a number"), |n| Value::Number(n as f64)),
        DeValue::Float(float) => {
            let text = float.as_str().replace("inf", "infinity");
            text.parse().map_or(Value::Other("no number"), Value::Number)
        }
        DeValue::Boolean(flag) => Value::Flag(flag),
        DeValue::Datetime(_) => Value::Other("a date"),
        DeValue::Array(items) => {
            let item = |item: toml::Spanned<DeValue>| {
                let place = item.span();
                (value_from_tree(name, place.clone(), item.into_inner()), place)
            };
            Value::Array(Arc::new(items.into_iter().map(item).collect()))
        }
        DeValue::Table(table) => Value::Table(Table::from_tree(name, place, table)),
    }
}

/// Bound below which doubles represent all whole numbers.
const LARGEST_WHOLE: f64 = 9e15;

/// The most likely fault of a line that is not TOML, as a rule that the line breaks.
fn hint(message: &str, line: &str) -> &'static str {
    if message.contains("duplicate key") && line.starts_with('[') {
        "a table stands once, but as many [[block]] as there are blocks"
    } else if line.split('=').next().is_some_and(|key| !key.contains(['"', '\'']) && key.trim().find('[') > Some(0)) {
        "a key with brackets stands in quotes"
    } else if !line.contains(['=', '[']) {
        "a key and its value stand on one line, joined by `=`; a record or a table is no scene: `rocking record` and `rocking plot` show them"
    } else if line.contains('\\') {
        "a path with backslashes stands in single quotes"
    } else {
        "decimals have a point, text stands in quotes, lists in brackets"
    }
}

/// Keys of a scene that stand in no table.
const OF_NO_TABLE: [&str; 3] = ["title", "gravity", "friction"];

/// Tables that only scenes have, but for those of the excitation, which have a `dt` of their own.
const SCENE_TABLES: [&str; 8] = ["size", "block", "column", "initial", "friction", "restitution", "solver", "output"];

/// Tables of a scene, with keys by which they are known.
const OF_A_TABLE: [(&str, &[&str]); 4] = [
    ("solver", &["t_end", "method", "rtol", "atol", "step", "stick_angle", "overturn_angle"]),
    ("initial", &["theta", "slide", "vx", "vy"]),
    ("restitution", &["law", "eta", "factors"]),
    ("output", &["dt", "times", "columns"]),
];

/// What the field calls keys of a scene, with their names.
const USUAL_NAMES: [(&str, &str); 4] =
    [("mu", "friction"), ("g", "gravity"), ("duration", "t_end"), ("weight", "mass")];

/// Whether `written` may be a misspelling of `key`, `key` in capitals, or the last part of `key`, as `width` is of `half_width`.
fn is_slip(key: &str, written: &str) -> bool {
    let is_end = key.strip_suffix(written).is_some_and(|start| start.ends_with('_'));
    is_end || key.eq_ignore_ascii_case(written) || strsim::levenshtein(key, written) <= 1 + written.len() / 4
}
