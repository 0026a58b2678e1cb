//! The columns of a table of runs, by their names, and the run of a row.

use crate::table::column::{OUTCOME, TRUNCATED, TRUST};
use crate::table::{INDEX, is_nameless, is_of_axis, numbered, tidied_cell, tidied_heading};
use csv::StringRecord;
use rocking::intensity::Intensity;
use rocking::studies::{self, Cells, Observation};
use rocking::sweep::kind_of_result;

/// Heading of the column with the scale of the record, which studies have.
const SCALE: &str = "scale";

/// The columns of a table of runs, by their places.
pub struct Columns {
    /// Header of the table.
    pub names: Vec<String>,
    /// The number of a run, in a table that numbers its runs.
    pub index: Option<usize>,
    /// What says which run a row is of: all columns but those of results, wherever they stand.
    pub settings: Vec<usize>,
    /// Columns whose cells name the record of a run.
    pub records: Vec<usize>,
    /// The column with the level of the measure.
    pub level: usize,
    /// The scale of the record, in the table of a study whose measure gives one record one scale at a level, whichever column it shakes.
    pub scale: Option<usize>,
    /// The gravity, where it varies.
    pub gravity: Option<usize>,
    /// Settings that are neither the record nor the measure: other axes of a sweep.
    pub others: Vec<usize>,
    pub outcome: usize,
    /// The block with which a column was lost.
    pub block: Option<usize>,
    pub uplift: Option<usize>,
    pub trust: Option<usize>,
    pub truncated: Option<usize>,
    /// One for each block.
    pub peaks: Vec<usize>,
    /// One for each interface.
    pub slides: Vec<usize>,
}

impl Columns {
    /// The number of a run, in a table that numbers its runs.
    pub fn number(&self, row: &StringRecord) -> Option<usize> {
        row[self.index?].parse().ok()
    }

    /// The columns with these names; without a measure, the level is the one column that has the name of a measure. The error says what is wrong
    /// with the table.
    pub fn of(names: Vec<String>, measure: Option<&str>) -> Result<Columns, String> {
        if names.is_empty() {
            return Err("it is empty; give the table of a finished study".into());
        }
        let level = level(&names, measure)?;
        let column = |name: &str| names.iter().position(|own| own == name);
        let outcome = column(OUTCOME)
            .ok_or_else(|| format!("it has no column `{OUTCOME}`; give a table of `rocking ida` or `rocking sweep`"))?;
        let records = studies::record_columns(&names);
        let settings: Vec<usize> = (0..names.len())
            .filter(|place| kind_of_result(&names[*place]).is_none() && !is_nameless(&names[*place]))
            .collect();
        // Beside the scale of the record other measures are properties of the scaled record.
        let is_property = |name: &str| column(SCALE).is_some() && is_measure(name);
        let is_other = |place: &usize| {
            let name = names[*place].as_str();
            *place != level && !records.contains(place) && ![INDEX, SCALE].contains(&name) && !is_property(name)
        };
        let (peaks, slides) = (numbered(&names, "peak")?, numbered(&names, "residual_slide")?);
        if !peaks.is_empty() && !slides.is_empty() && peaks.len() != slides.len() {
            let (peaks, slides) = (peaks.len(), slides.len());
            return Err(format!("it has {peaks} column(s) `peak_…` and {slides} `residual_slide_…`; give all of them"));
        }
        Ok(Columns {
            others: settings.iter().copied().filter(is_other).collect(),
            index: column(INDEX),
            gravity: column("gravity"),
            scale: column(SCALE).filter(|_| studies::has_one_scale(&names[level])),
            settings,
            records,
            level,
            outcome,
            block: column("block"),
            uplift: column("first_uplift"),
            trust: column(TRUST),
            truncated: column(TRUNCATED),
            peaks,
            slides,
            names,
        })
    }

    /// The places of the other settings that are keys of a scene, as in the table of a sweep: `size.alpha`. A column of another name may be a result.
    pub fn keys(&self) -> impl Iterator<Item = usize> {
        let is_key = |place: &usize| self.names[*place].contains('.') && !is_measure(&self.names[*place]);
        self.others.iter().copied().filter(is_key)
    }

    /// Conditions with the places of their columns, and the value as it is given and as a tidied cell has it. The error names a column that is not there.
    pub fn conditions(&self, given: &[(String, String)]) -> Result<Vec<(usize, [String; 2])>, String> {
        let condition = |(name, value): &(String, String)| {
            let heading = tidied_heading(name);
            let place = self
                .names
                .iter()
                .position(|own| *own == heading)
                .ok_or_else(|| format!("there is no column `{name}`; it has {}", self.names.join(", ")))?;
            Ok((place, [value.clone(), tidied_cell(&heading, value)]))
        };
        given.iter().map(condition).collect()
    }

    /// The name of the record of a row.
    pub fn record_of(&self, row: &StringRecord, number: usize) -> String {
        match &self.records[..] {
            [] if studies::is_of_one_record(&self.names, self.level) => "the record of the scene".into(),
            [] => format!("run {}", number + 1),
            columns => columns.iter().map(|place| &row[*place]).collect::<Vec<_>>().join(", "),
        }
    }

    /// The run of a row, counted from zero. The error says what is wrong with a cell, after the number of the row.
    pub fn observation(&self, row: &StringRecord, number: usize) -> Result<Observation, String> {
        let wrong = |place: usize, wanted: &str| {
            format!(", column `{}`: `{}` is not {wanted}; correct the cell", self.names[place], &row[place])
        };
        if let Some(place) = self.records.iter().find(|place| row[**place].is_empty()) {
            return Err(wrong(*place, "the name of a record"));
        }
        let level: Option<f64> = row[self.level].parse().ok();
        let level = level.filter(|level| level.is_finite() && *level > 0.0);
        // Columns of blocks that this row's column does not have are blank, at the end.
        let numbers = |places: &[usize], least: f64, wanted: &str| -> Result<Vec<f64>, String> {
            let filled = places.iter().rposition(|place| !row[*place].is_empty()).map_or(0, |last| last + 1);
            let number = |place: &usize| {
                let number: Option<f64> = row[*place].parse().ok();
                // A stack that does not stand by itself has infinite peaks.
                number.filter(|number| *number >= least).ok_or_else(|| wrong(*place, wanted))
            };
            places[..filled].iter().map(number).collect()
        };
        let has_uplift = |place: usize| match row[place].parse::<f64>() {
            _ if row[place].is_empty() => Ok(false),
            Ok(time) if time >= 0.0 => Ok(true),
            _ => Err(wrong(place, "a time")),
        };
        let cells = Cells {
            record: self.record_of(row, number),
            level: level.ok_or_else(|| wrong(self.level, "a number above zero"))?,
            outcome: Some(&row[self.outcome]),
            trust: self.trust.map(|trust| &row[trust]),
            has_uplift: self.uplift.map(has_uplift).transpose()?,
            peaks: numbers(&self.peaks, 0.0, "zero or a number above it")?,
            residual_slides: numbers(&self.slides, f64::NEG_INFINITY, "a number")?,
        };
        // The block with which a column was lost is one of it.
        let lost = self.block.and_then(|block| row[block].parse::<usize>().ok()).unwrap_or_default();
        if !self.peaks.is_empty() && lost > self.peaks.len() {
            return Err(format!(
                ": block {lost} was lost, and the table has no column `peak_{lost}`; give all of them"
            ));
        }
        Observation::try_from(cells).map_err(|refused| format!(", {refused}"))
    }
}

/// The column of the level: that of the measure or, without one, the one column that has the name of a measure.
fn level(names: &[String], measure: Option<&str>) -> Result<usize, String> {
    let known = || names.join(", ");
    let is_wanted = |name: &str| match measure {
        Some(measure) => name == measure,
        // The whole heading is tried as well: a measure with a period, such as `sa(0.5)`, contains a point itself.
        None => is_measure(name) || is_measure(&last_part(name)),
    };
    let wanted: Vec<usize> = (0..names.len()).filter(|place| is_wanted(&names[*place])).collect();
    match (&wanted[..], measure) {
        ([level], _) => Ok(*level),
        ([], Some(measure)) => Err(format!("there is no column `{measure}`; it has {}", known())),
        (_, Some(measure)) => Err(format!("several of its columns are called `{measure}`; remove all but one")),
        ([], None) => {
            let possible: Vec<&str> = names.iter().map(String::as_str).filter(|name| is_of_axis(name)).collect();
            Err(match possible[..] {
                [] => {
                    "no column has the name of a measure; give a table of `rocking ida`, or of a sweep over a measure"
                        .into()
                }
                _ => {
                    format!("no column has the name of a measure; choose one of {} with --measure", possible.join(", "))
                }
            })
        }
        (several, None) => {
            // A study has its measure beside the scale of the record; others may be properties of the records.
            let of_study = several.iter().find(|place| **place > 0 && names[**place - 1] == SCALE);
            let several: Vec<&str> = several.iter().map(|place| names[*place].as_str()).collect();
            of_study.copied().ok_or_else(|| match several.iter().all(|name| *name == several[0]) {
                true => format!("several of its columns are called `{}`; remove all but one", several[0]),
                false => format!("several columns are measures; choose one of {} with --measure", several.join(", ")),
            })
        }
    }
}

/// The last part of the heading of an axis, a dotted key of the scene. It may name a measure.
pub fn last_part(heading: &str) -> String {
    heading.rsplit('.').next().unwrap_or(heading).to_string()
}

pub fn is_measure(name: &str) -> bool {
    name.parse::<Intensity>().is_ok()
}
