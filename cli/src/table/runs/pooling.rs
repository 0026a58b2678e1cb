//! What the rows of a table have in common: rows of several axes in one curve, runs given twice, runs that are missing or cut.

use super::columns::{Columns, last_part};
use crate::table::column::TRUNCATED;
use csv::StringRecord;
use rocking::Fate;
use rocking::studies::EQUAL_SCALES;
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The warning that numbers of runs, in any order and perhaps of several studies, have gaps; `None` if they have none.
pub fn missing(mut numbers: Vec<usize>) -> Option<String> {
    numbers.sort_unstable();
    numbers.dedup();
    let (place, next) = numbers.iter().enumerate().find(|(place, number)| place != *number)?;
    let several = numbers[numbers.len() - 1] + 1 - numbers.len();
    let first = if next - place == 1 {
        format!("run {place} is missing")
    } else {
        format!("runs {place} to {} are missing", next - 1)
    };
    Some(if several > next - place { format!("{first}, and {} more", several - (next - place)) } else { first })
}

/// Largest number of values of an axis whose rows may have been pooled by mistake: a column with more of them is none.
const MOST_VALUES: usize = 1000;

/// What is gathered of all rows that are read, beside their runs.
pub struct Pooling<'c> {
    columns: &'c Columns,
    /// For each column that is neither the record nor the measure: the records that have each of its values.
    values: Vec<BTreeMap<String, BTreeSet<String>>>,
    /// For each record, the values of the keys of the scene in its first run.
    records: BTreeMap<String, Vec<String>>,
    /// Whether runs of one record have other values of these keys.
    differ_beside_level: bool,
    /// The least and the largest scale of each record at each level, with the keys of the scene.
    scales: HashMap<String, (String, [f64; 2])>,
    /// The number and the row of the first run with these settings.
    seen: HashMap<String, (String, usize)>,
    /// Number of runs.
    rows: usize,
    /// Number of runs with the settings of another one, and another number.
    repeated: usize,
    /// Number of runs that stand and have no peak of the last block.
    short: usize,
    /// Number of runs that end before their ground motion, or while the column may be falling.
    cut: usize,
}

impl Pooling<'_> {
    pub fn new(columns: &Columns) -> Pooling<'_> {
        Pooling {
            columns,
            values: vec![BTreeMap::new(); columns.others.len()],
            records: BTreeMap::new(),
            differ_beside_level: false,
            scales: HashMap::new(),
            seen: HashMap::new(),
            rows: 0,
            repeated: 0,
            short: 0,
            cut: 0,
        }
    }

    /// Adds a row, counted from zero. The error says, after the number of the row, that its run has been added before.
    pub fn add(&mut self, row: &StringRecord, number: usize) -> Result<(), String> {
        let columns = self.columns;
        self.rows += 1;
        // Studies with other records may be pooled: their runs have the same numbers.
        let is_number = |place: &&usize| columns.index == Some(**place);
        let settings = columns.settings.iter().filter(|place| !is_number(place)).map(|place| &row[*place]);
        let index = columns.index.map(|index| &row[index]);
        match self.seen.entry(settings.collect::<Vec<_>>().join(",")) {
            Entry::Vacant(free) => {
                free.insert((index.unwrap_or_default().into(), number));
            }
            Entry::Occupied(first) if index == Some(&first.get().0) => {
                return Err(format!(": the run stands in row {} as well; give each run once", first.get().1 + 1));
            }
            // Without a column that names it, each row may be of a record of its own.
            Entry::Occupied(_) => self.repeated += usize::from(!columns.records.is_empty()),
        }
        let is_standing = Fate::parse(&row[columns.outcome]).is_some_and(|fate| fate.is_decided() && !fate.is_lost());
        let has_last = columns.peaks.last().is_none_or(|place| !row[*place].is_empty());
        self.short += usize::from(is_standing && !has_last);
        let record = columns.record_of(row, number);
        for (values, place) in
            self.values.iter_mut().zip(&columns.others).filter(|(values, _)| values.len() <= MOST_VALUES)
        {
            values.entry(row[*place].to_string()).or_default().insert(record.clone());
        }
        if let Some(scale) = columns.scale.and_then(|place| row[place].parse().ok()).map(f64::abs) {
            // Not the level as a text: 1 and 1.0 are one.
            let level = row[columns.level].parse().unwrap_or(f64::NAN).to_string();
            let settings = columns.keys().chain(columns.gravity).map(|place| &row[place]);
            let key: Vec<&str> = [&record, level.as_str()].into_iter().chain(settings).collect();
            let (_, [least, largest]) =
                self.scales.entry(key.join(",")).or_insert_with(|| (record.clone(), [scale; 2]));
            (*least, *largest) = (least.min(scale), largest.max(scale));
        }
        let keys = || columns.keys().map(|place| &row[place]);
        let first = self.records.entry(record).or_insert_with(|| keys().map(String::from).collect());
        self.differ_beside_level |= !keys().eq(first.iter());
        self.cut += usize::from(columns.truncated.is_some_and(|truncated| &row[truncated] == "true"));
        Ok(())
    }

    /// Whether runs of one record differ in a key of the scene beside those of the record and the measure.
    pub fn differ_beside_level(&self) -> bool {
        self.differ_beside_level
    }

    /// The warning that different records have one name: their scales differ at one level.
    fn shared_names(&self) -> Option<String> {
        let differ = |[least, largest]: &[f64; 2]| *largest > least * (1.0 + EQUAL_SCALES);
        let shared: BTreeSet<&str> =
            self.scales.values().filter(|(_, range)| differ(range)).map(|(record, _)| record.as_str()).collect();
        let first = shared.first()?;
        let names = match shared.len() {
            1 => format!("the name `{first}`"),
            count => format!("{count} names, such as `{first}`"),
        };
        Some(format!(
            "different records share {names}: their scales differ at one level, and they count as one; give each record a name of its own"
        ))
    }

    /// Columns that are neither the record nor the measure, and whose values differ; runs that were cut.
    pub fn warnings(&self) -> Vec<String> {
        let columns = self.columns;
        // A value of its own for each record is a property of the record, such as its PGA.
        let is_of_record = |values: &BTreeMap<String, BTreeSet<String>>| {
            let is_of_one = |records: &BTreeSet<String>| records.len() == 1;
            !columns.records.is_empty() && values.len() == self.records.len() && values.values().all(is_of_one)
        };
        // Nor has an axis nearly as many values as there are runs.
        let most = MOST_VALUES.min(self.rows / 2);
        let is_axis =
            |values: &BTreeMap<String, BTreeSet<String>>| (2..=most).contains(&values.len()) && !is_of_record(values);
        let several = columns.others.iter().zip(&self.values).filter(|(_, values)| is_axis(values));
        let pooled = several.map(|(place, values)| {
            let (name, count) = (&columns.names[*place], values.len());
            format!(
                "the rows of all {count} values of `{name}` make one curve; --where {name}=VALUE keeps those of one"
            )
        });
        let cut = (self.cut > 0).then(|| {
            format!(
                "{} run(s) end before their ground motion, while the column may be falling, or sliding (`{TRUNCATED}`), and count as standing; a later `solver.t_end` settles them",
                self.cut
            )
        });
        let repeated = (self.repeated > 0).then(|| {
            format!(
                "{} run(s) have all settings of a run above; if they are the same runs, give each once",
                self.repeated
            )
        });
        let has_other_columns = columns.others.iter().any(|place| last_part(&columns.names[*place]) == "blocks");
        let short = (self.short > 0 && !has_other_columns).then(|| {
            format!(
                "{} run(s) that stand have no `peak_{}`: limit states do not see this block there",
                self.short,
                columns.peaks.len()
            )
        });
        pooled.chain(self.shared_names()).chain(cut).chain(repeated).chain(short).collect()
    }
}
