//! The table of a sweep as points. Each point has its values of the axes, the outcome of the column, and the largest angles and the slides.

use super::class::Class;
use super::refusal::NoSpectrum;
use crate::number::counted;
use crate::table::column::{OUTCOME, Rows, TRUST};
use crate::table::{INDEX, is_nameless, numbered, open};
use crate::text::printable;
use csv::StringRecord;
use rocking::Fate;
use rocking::sweep::{ERROR, kind_of_result};
use rocking::trust::Degree;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Key of an axis, and its different values as written in the table, in the order in which they first occur.
pub type Axis = (String, Vec<String>);

/// Number of combinations of the values of axes; the largest number if there are more.
pub fn combinations<'a>(axes: impl IntoIterator<Item = &'a Axis>) -> usize {
    axes.into_iter().fold(1, |count, (_, values)| count.saturating_mul(values.len()))
}

/// Whether a value of an axis can be drawn.
pub fn is_drawn(value: f64) -> bool {
    value == 0.0 || (1e-100..=1e100).contains(&value.abs())
}

/// A whole table.
#[derive(Clone, Debug)]
pub struct Points {
    pub axes: Vec<Axis>,
    /// Index of the value of each axis, row by row: as many entries per row as there are axes.
    numbers: Vec<usize>,
    /// Class of each row.
    pub classes: Vec<Class>,
    /// Largest `|θ|/α` of each block.
    pub angles: Quantity,
    /// Size of the slide of each interface at the end `[m]`.
    pub slides: Quantity,
    /// Number of rows whose runs failed.
    pub errors: usize,
    /// Number of rows whose runs `t_end` cuts.
    truncated: usize,
}

/// A quantity of the rows, with a number for each block or interface.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Places of the columns; none where none were asked for.
    places: Vec<usize>,
    /// Number of columns.
    pub entries: usize,
    /// Row by row. `NaN` where a row has no answer, infinite where the column is lost.
    values: Vec<f64>,
}

impl Quantity {
    /// The quantity of the columns `name_1`, `name_2` and so on of a table, without rows.
    ///
    /// # Errors
    /// What is wrong, if a number is left out.
    fn of_columns(header: &[&str], name: &str) -> Result<Quantity, String> {
        let places = numbered(header, name)?;
        Ok(Quantity { entries: places.len(), places, values: Vec::new() })
    }

    /// Adds the numbers of a row; `known` replaces all of them. A blank is one of a block that the column of the row does not have, unless all are blank: the
    /// number of a lost column may have been removed, as it means nothing.
    ///
    /// # Errors
    /// Place of the first cell that is neither blank nor a number.
    fn add(&mut self, row: &StringRecord, known: Option<f64>) -> Result<(), usize> {
        let cells = || self.places.iter().map(|place| &row[*place]);
        let blank = if cells().all(str::is_empty) { known.unwrap_or(f64::NAN) } else { f64::NAN };
        let number = |place: &usize| match row[*place].parse::<f64>() {
            Ok(number) => Ok(known.unwrap_or(number.abs())),
            Err(_) if row[*place].is_empty() => Ok(blank),
            Err(_) => Err(*place),
        };
        let numbers = self.places.iter().map(number).collect::<Result<Vec<f64>, usize>>()?;
        self.values.extend(numbers);
        Ok(())
    }

    /// The number of a block or interface, counted from zero, in a row; infinite where the column is lost. `None` where the row has no answer.
    pub fn of(&self, row: usize, entry: usize) -> Option<f64> {
        self.values.get(row * self.entries + entry).copied().filter(|number| !number.is_nan())
    }

    /// The largest number of a row; infinite where the column is lost. `None` where the row has no answer.
    pub fn largest(&self, row: usize) -> Option<f64> {
        (0..self.entries).filter_map(|entry| self.of(row, entry)).reduce(f64::max)
    }
}

impl Points {
    /// Reads the table of a whole sweep.
    pub fn read(file: &Path) -> Result<Points, NoSpectrum> {
        let broken = NoSpectrum::NoTable;
        let failed = |error: std::io::Error| broken(error.to_string());
        let Rows { header, rows } = open(file).map_err(failed)?;
        let column = |name: &str| header.iter().position(|found| found == name);
        let outcome = column(OUTCOME).ok_or_else(|| broken(format!("it has no column {OUTCOME}")))?;
        let (impacts, trust, truncated_at) = (column("impacts"), column(TRUST), column("truncated"));
        let names: Vec<&str> = header.iter().collect();
        let quantity = |name: &str| Quantity::of_columns(&names, name).map_err(broken);
        let (mut angles, mut slides) = (quantity("peak")?, quantity("residual_slide")?);
        let is_setting = |name: &str| name != INDEX && !is_nameless(name) && kind_of_result(name).is_none();
        let is_axis = |place: &usize| is_setting(names[*place]);
        let places: Vec<usize> = (0..outcome).filter(is_axis).collect();
        let mut axes: Vec<Axis> = places.iter().map(|place| (names[*place].into(), Vec::new())).collect();
        let mut seen: Vec<HashMap<String, usize>> = vec![HashMap::new(); axes.len()];
        let (mut numbers, mut classes, mut errors, mut truncated) = (Vec::new(), Vec::new(), 0, 0);
        for row in rows {
            let row = row.map_err(failed)?;
            let values = places.iter().map(|place| &row[*place]);
            for ((axis, seen), value) in axes.iter_mut().zip(&mut seen).zip(values) {
                let number = seen.get(value).copied().unwrap_or_else(|| {
                    axis.1.push(value.into());
                    seen.insert(value.into(), axis.1.len() - 1);
                    axis.1.len() - 1
                });
                numbers.push(number);
            }
            let cell = |place: usize| {
                format!("row {}, column `{}`: `{}`", classes.len() + 1, names[place], printable(&row[place]))
            };
            let counted = match impacts.map(|place| (place, row[place].parse::<u64>())) {
                Some((_, Ok(count))) => Some(count),
                Some((place, Err(_))) if !row[place].is_empty() => {
                    return Err(broken(cell(place) + " is no number of impacts"));
                }
                _ => None,
            };
            let degree = trust.and_then(|trust| Degree::parse(row.get(trust)?));
            let class = match &row[outcome] {
                ERROR => Class::Error,
                word => {
                    let fate = Fate::parse(word).ok_or_else(|| broken(cell(outcome) + " is no outcome"))?;
                    Class::of(fate.as_determined(degree), counted)
                }
            };
            errors += usize::from(&row[outcome] == ERROR);
            truncated += usize::from(truncated_at.and_then(|at| row.get(at)) == Some("true"));
            let known = match class {
                class if !class.has_answer() => Some(f64::NAN),
                class if class.is_lost() => Some(f64::INFINITY),
                _ => None,
            };
            for quantity in [&mut angles, &mut slides] {
                quantity.add(&row, known).map_err(|place| broken(cell(place) + " is no number"))?;
            }
            classes.push(class);
        }
        Ok(Points { axes, numbers, classes, angles, slides, errors, truncated })
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.classes.len()
    }

    /// Whether each combination of the values of the axes occurs once.
    pub fn has_each_once(&self) -> bool {
        let rows: HashSet<&[usize]> = (0..self.len()).map(|row| self.numbers(row)).collect();
        rows.len() == self.len() && rows.len() == combinations(&self.axes)
    }

    /// Sentences for captions on the runs that have no answer, and on those that t_end cuts; empty if there are none.
    pub fn notes(&self) -> String {
        let runs = counted(self.len(), ["run", "runs"]);
        let mut notes = String::new();
        for (class, [has, have]) in [
            (Class::NotDetermined, ["is not determined", "are not determined"]),
            (Class::Error, ["has no result", "have no result"]),
        ] {
            match self.classes.iter().filter(|own| **own == class).count() {
                0 => {}
                1 => notes.push_str(&format!(" 1 of {runs} {has} and is left out.")),
                count => notes.push_str(&format!(" {count} of {runs} {have} and are left out.")),
            }
        }
        notes + &self.truncation()
    }

    /// An entry of a legend on the runs that t_end cuts; `None` if there are none.
    pub fn cut(&self) -> Option<String> {
        let are = if self.truncated == 1 { "is" } else { "are" };
        (self.truncated > 0).then(|| format!("{} of {} runs {are} cut at t_end", self.truncated, self.len()))
    }

    /// A sentence for captions on the runs that t_end cuts; empty if there are none.
    pub fn truncation(&self) -> String {
        match self.truncated {
            0 => String::new(),
            count => format!(
                " {count} of {} are cut at solver.t_end: the ground still moves there, the column may be falling, or blocks slide on.",
                counted(self.len(), ["run", "runs"])
            ),
        }
    }

    /// Index of the value of each axis in a row.
    pub fn numbers(&self, row: usize) -> &[usize] {
        &self.numbers[row * self.axes.len()..(row + 1) * self.axes.len()]
    }
}
