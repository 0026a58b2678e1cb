//! A run's folder read back: what plots and reports are made of.
//!
//! `summary.json`, `response.csv` and `events.json` hold all of a run: its column, inputs, history and events. Pictures are made
//! of the files, so that those of an old run, or of one on another machine, are the same.

use crate::error::Failure;
use rocking::pattern::Pattern;
use rocking::{Block, Column, EventKind, Sample, StopReason};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A finished run.
#[derive(Debug)]
pub struct Results {
    /// `summary.json`
    pub summary: Summary,
    /// The column of the summary.
    pub column: Column,
    /// `response.csv`
    pub samples: Vec<Sample>,
    /// `events.json`
    pub events: Vec<Event>,
}

/// What is read of `summary.json`; lengths N per block or interface, base first. The command line writes the file in
/// [`crate::output`].
#[derive(Debug, Deserialize)]
pub struct Summary {
    pub title: String,
    pub version: String,
    /// The scene: its file as it was named, and its text.
    pub scene: SceneText,
    pub status: StopReason,
    /// `[s]`
    pub t_final: f64,
    /// `[s]`
    pub overturned_at: Option<f64>,
    pub overturned_block: Option<usize>,
    /// `[rad]`
    pub peak_theta: Vec<f64>,
    pub impacts: usize,
    /// `[s]`
    pub time_in_mode: BTreeMap<String, f64>,
    /// Dimensionless; none where a contact parts with a force along it.
    pub friction_demand: Vec<Option<f64>>,
    /// `[N]`
    pub min_normal_force: Vec<Option<f64>>,
    pub separations: Vec<Separation>,
    pub method: String,
    /// Modes without generated equations in the build ran on generic ones.
    pub used_generic: bool,
    pub warnings: Vec<String>,
    pub options: Options,
    pub column: ColumnData,
    pub friction: Option<f64>,
    /// As the library serialises them: `kind` and parameters.
    pub excitation: serde_json::Value,
    pub restitution: serde_json::Value,
    /// Horizontal and vertical `[m/s²]`; runs of earlier versions have none.
    peak_ground_acceleration: Option<[f64; 2]>,
}

/// Times in the modes `[s]`, the longest first.
pub fn longest_first(time_in_mode: &BTreeMap<String, f64>) -> Vec<(&str, f64)> {
    let mut modes: Vec<_> = time_in_mode.iter().map(|(mode, time)| (mode.as_str(), *time)).collect();
    modes.sort_by(|a, b| b.1.total_cmp(&a.1));
    modes
}

/// The scene file of a run.
#[derive(Debug, Deserialize)]
pub struct SceneText {
    pub file: PathBuf,
    pub text: String,
}

/// A contact problem without admissible pattern.
#[derive(Debug, Deserialize)]
pub struct Separation {
    /// `[s]`
    pub t: f64,
}

/// What is read of the solver's options.
#[derive(Debug, Deserialize)]
pub struct Options {
    pub t_end: f64,
    pub rtol: f64,
    pub atol: f64,
    pub stick_angle: f64,
    pub overturn_angle: f64,
    pub dynamics: serde_json::Value,
}

/// The column as the library serialises it.
#[derive(Debug, Deserialize)]
pub struct ColumnData {
    blocks: Vec<Block>,
    gravity: f64,
}

/// What is read of an event.
#[derive(Debug, Deserialize)]
pub struct Event {
    /// `[s]`
    pub t: f64,
    /// What happened.
    pub kind: EventKind,
    /// Patterns before and after, as signs, base first.
    pub before: Vec<i8>,
    /// See `before`.
    pub after: Vec<i8>,
    /// Label of the mode after, `rest` where nothing moves.
    pub mode: String,
    /// Angles `[rad]`, per block.
    pub theta: Vec<f64>,
    /// Rates before and after `[rad/s]`, per block.
    pub omega_before: Vec<f64>,
    /// See `omega_before`.
    pub omega_after: Vec<f64>,
}

impl Results {
    /// Reads the folder of a run.
    ///
    /// # Errors
    /// [`Failure::Results`] names the file, and the line where there is one.
    pub fn read(folder: &Path) -> Result<Results, Failure> {
        let summary: Summary = json(&folder.join("summary.json"))?;
        let events: Vec<Event> = json(&folder.join("events.json"))?;
        let broken = |problem: String| Failure::results(&folder.join("summary.json"), problem);
        let column = Column::new(summary.column.blocks.clone(), summary.column.gravity);
        let column = column.map_err(|error| broken(error.to_string()))?;
        let blocks = column.len();
        if summary.peak_theta.len() != blocks {
            return Err(broken(format!("peak_theta has not {blocks} numbers")));
        }
        let samples = samples(&folder.join("response.csv"), blocks)?;
        if let Some(event) = events.iter().find(|event| event.theta.len() != blocks || event.after.len() != blocks) {
            let problem = format!("the event at t = {} s is not of {blocks} block(s)", event.t);
            return Err(Failure::results(&folder.join("events.json"), problem));
        }
        Ok(Results { summary, column, samples, events })
    }

    /// Peak acceleration of the ground, horizontal and vertical `[m/s²]`: of the motion itself, or else of the rows.
    pub fn peak_ground_acceleration(&self) -> [f64; 2] {
        let of_rows = |axis: usize| self.samples.iter().map(|row| row.ground[axis].abs()).fold(0.0, f64::max);
        self.summary.peak_ground_acceleration.unwrap_or_else(|| [of_rows(0), of_rows(1)])
    }
}

fn json<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| Failure::results(path, error))?;
    serde_json::from_str(&text).map_err(|error| Failure::results(path, error))
}

/// The rows of `response.csv`: `t, theta_1.., omega_1.., ground_x, ground_y, pattern`.
fn samples(path: &Path, blocks: usize) -> Result<Vec<Sample>, Failure> {
    let failed = |error: csv::Error| Failure::results(path, error);
    let mut reader = csv::Reader::from_path(path).map_err(failed)?;
    let mut samples = Vec::new();
    for row in reader.records() {
        let row = row.map_err(failed)?;
        let line = row.position().map_or(0, csv::Position::line);
        let broken = |problem: String| Failure::results(path, format!("line {line}: {problem}"));
        if row.len() != 2 * blocks + 4 {
            return Err(broken(format!("{} columns where {} are expected", row.len(), 2 * blocks + 4)));
        }
        let mut numbers = Vec::with_capacity(2 * blocks + 3);
        for text in row.iter().take(2 * blocks + 3) {
            let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
            numbers.push(number.ok_or_else(|| broken(format!("`{text}` is not a finite number")))?);
        }
        let pattern = &row[2 * blocks + 3];
        let pattern = Pattern::parse(pattern).filter(|pattern| pattern.0.len() == blocks);
        samples.push(Sample {
            t: numbers[0],
            theta: numbers[1..=blocks].to_vec(),
            omega: numbers[blocks + 1..=2 * blocks].to_vec(),
            ground: [numbers[2 * blocks + 1], numbers[2 * blocks + 2]],
            pattern: pattern.ok_or_else(|| broken("the pattern is not one of this column".into()))?,
        });
    }
    if samples.is_empty() {
        return Err(Failure::results(path, "there are no rows"));
    }
    Ok(samples)
}
