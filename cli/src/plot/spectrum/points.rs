//! The table of a sweep as points. Each point has its values of the axes, the outcome of the column, and the largest angles.

use super::class::Class;
use super::refusal::NoSpectrum;
use crate::number::counted;
use crate::table::column::{Rows, TRUST};
use crate::table::open;
use rocking::sweep::NOT_DETERMINED;
use std::collections::HashMap;
use std::path::Path;

/// Key of an axis, and its different values as written in the table, in the order in which they first occur.
pub type Axis = (String, Vec<String>);

/// A whole table.
#[derive(Clone, Debug)]
pub struct Points {
    pub axes: Vec<Axis>,
    /// Index of the value of each axis, row by row: as many entries per row as there are axes.
    numbers: Vec<usize>,
    /// Class of each row.
    pub classes: Vec<Class>,
    /// Largest `|θ|/α` of each block, row by row, with [`Points::blocks`] entries per row. `NaN` where a row has no answer, infinite where the
    /// column is lost.
    peaks: Vec<f64>,
    /// Number of columns of peaks; zero where none were asked for.
    pub blocks: usize,
    /// Number of rows whose runs `t_end` cuts.
    truncated: usize,
}

impl Points {
    /// Reads the table of a whole sweep.
    pub fn read(file: &Path) -> Result<Points, NoSpectrum> {
        let broken = NoSpectrum::NoTable;
        let failed = |error: std::io::Error| broken(error.to_string());
        let Rows { header, rows } = open(file).map_err(failed)?;
        let column = |name: &str| header.iter().position(|found| found == name);
        let (Some(0), Some(outcome), Some(impacts)) = (column("index"), column("outcome"), column("impacts")) else {
            return Err(broken("it has no columns index, outcome and impacts".into()));
        };
        let (trust, truncated_at) = (column(TRUST), column("truncated"));
        let first_peak = column("peak_1");
        let blocks = first_peak.map_or(0, |first| {
            header
                .iter()
                .skip(first)
                .enumerate()
                .take_while(|(place, name)| **name == format!("peak_{}", place + 1))
                .count()
        });
        let mut axes: Vec<Axis> = header.iter().take(outcome).skip(1).map(|key| (key.into(), Vec::new())).collect();
        let mut seen: Vec<HashMap<String, usize>> = vec![HashMap::new(); axes.len()];
        let (mut numbers, mut classes, mut peaks, mut truncated) = (Vec::new(), Vec::new(), Vec::new(), 0);
        for row in rows {
            let row = row.map_err(failed)?;
            for ((axis, seen), value) in axes.iter_mut().zip(&mut seen).zip(row.iter().skip(1)) {
                let number = seen.get(value).copied().unwrap_or_else(|| {
                    axis.1.push(value.into());
                    seen.insert(value.into(), axis.1.len() - 1);
                    axis.1.len() - 1
                });
                numbers.push(number);
            }
            let class = Class::of(&row[outcome], &row[impacts]);
            let class = class.ok_or_else(|| broken(format!("point {} has outcome `{}`", &row[0], &row[outcome])))?;
            truncated += usize::from(truncated_at.and_then(|at| row.get(at)) == Some("true"));
            let is_open = class == Class::Error || trust.is_some_and(|trust| row.get(trust) == Some(NOT_DETERMINED));
            peaks.extend((0..blocks).map(|block| {
                let cell = first_peak.and_then(|first| row.get(first + block)).unwrap_or_default();
                match cell.parse() {
                    _ if is_open => f64::NAN,
                    Ok(_) if class.is_lost() => f64::INFINITY,
                    Ok(peak) => peak,
                    Err(_) => f64::NAN,
                }
            }));
            classes.push(class);
        }
        Ok(Points { axes, numbers, classes, peaks, blocks, truncated })
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.classes.len()
    }

    /// A sentence for captions on the runs that t_end cuts; empty if there are none.
    pub fn truncation(&self) -> String {
        match self.truncated {
            0 => String::new(),
            count => format!(
                " {count} of {} are cut at solver.t_end: the ground still moves there, or the column has the energy to overturn.",
                counted(self.len(), ["run", "runs"])
            ),
        }
    }

    /// Index of the value of each axis in a row.
    pub fn numbers(&self, row: usize) -> &[usize] {
        &self.numbers[row * self.axes.len()..(row + 1) * self.axes.len()]
    }

    /// Largest `|θ|/α` of a block, counted from zero, in a row; infinite where the column is lost. `None` where the row has no answer.
    pub fn peak(&self, row: usize, block: usize) -> Option<f64> {
        self.peaks.get(row * self.blocks + block).copied().filter(|peak| !peak.is_nan())
    }

    /// Largest `|θ|/α` of all blocks in a row; infinite where the column is lost. `None` where the row has no answer.
    pub fn demand(&self, row: usize) -> Option<f64> {
        (0..self.blocks).filter_map(|block| self.peak(row, block)).reduce(f64::max)
    }
}
