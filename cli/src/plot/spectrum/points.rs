//! The table of a sweep as points: what its axes are there, what became of the column, and its largest angles.

use super::class::Class;
use super::refusal::NoSpectrum;
use crate::table::column::{NOT_DETERMINED, Rows, TRUST};
use crate::table::open;
use std::collections::HashMap;
use std::path::Path;

/// An axis by its key, and its different values as a table has them, in the order of their first rows.
pub type Axis = (String, Vec<String>);

/// A whole table.
#[derive(Clone, Debug)]
pub struct Points {
    pub axes: Vec<Axis>,
    /// Numbers of the values of the axes, row by row: as many for each row as there are axes.
    numbers: Vec<usize>,
    /// Classes of the rows.
    pub classes: Vec<Class>,
    /// Largest `|θ|/α` of each block, row by row, as many for each row as [`Points::blocks`]; `NaN` where a row has none, infinite where the column is
    /// lost.
    peaks: Vec<f64>,
    /// Number of columns of peaks; zero where none were asked for.
    pub blocks: usize,
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
        let trust = column(TRUST);
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
        let (mut numbers, mut classes, mut peaks) = (Vec::new(), Vec::new(), Vec::new());
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
        Ok(Points { axes, numbers, classes, peaks, blocks })
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.classes.len()
    }

    /// Numbers of the values of the axes of a row.
    pub fn numbers(&self, row: usize) -> &[usize] {
        &self.numbers[row * self.axes.len()..(row + 1) * self.axes.len()]
    }

    /// Largest `|θ|/α` of a block of a row, from zero, infinite where the column is lost; `None` where the row has no answer, or no such block.
    pub fn peak(&self, row: usize, block: usize) -> Option<f64> {
        self.peaks.get(row * self.blocks + block).copied().filter(|peak| !peak.is_nan())
    }

    /// The same of all blocks.
    pub fn demand(&self, row: usize) -> Option<f64> {
        (0..self.blocks).filter_map(|block| self.peak(row, block)).reduce(f64::max)
    }
}
