//! `rocking check` of a study: its records with their factors, its levels and limit states.

use crate::error::Failure;
use crate::number::significant;
use crate::terminal::{json, print, warn_of_some};
use crate::text::{printable, shell_word, shown};
use rocking::studies::{Ida, IdaFile, StudyRecord};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;

/// Description of a study.
#[derive(Debug, Serialize)]
struct Findings {
    measure: String,
    levels: Vec<f64>,
    records: Vec<StudiedRecord>,
    runs: usize,
    states: Vec<String>,
    /// Warnings about the scene and the records, each once, and about runs that would be rows with errors.
    warnings: Vec<String>,
}

/// A record of a study.
#[derive(Debug, Serialize)]
struct StudiedRecord {
    name: String,
    has_vertical: bool,
    /// Factors at the lowest and the highest level, dimensionless.
    scales: [f64; 2],
}

/// Reads a study and explains it.
pub fn check(path: &Path, as_json: bool) -> Result<(), Failure> {
    let IdaFile { ida, states, .. } = IdaFile::from_file(path).map_err(Failure::scene)?;
    let record = |(number, record): (usize, &StudyRecord)| {
        let scales = (0..ida.levels().len()).map(|level| ida.point(number * ida.levels().len() + level).scale);
        let around = scales.fold([f64::INFINITY, 0.0_f64], |[low, high], scale| [low.min(scale), high.max(scale)]);
        StudiedRecord { name: record.name.clone(), has_vertical: record.vertical.is_some(), scales: around }
    };
    let findings = Findings {
        measure: ida.intensity().to_string(),
        levels: ida.levels().to_vec(),
        records: ida.records().iter().enumerate().map(record).collect(),
        runs: ida.len(),
        states: states.iter().map(ToString::to_string).collect(),
        warnings: ida.warnings().into_iter().chain(refused(&ida)).collect(),
    };
    warn_of_some(&findings.warnings);
    if as_json {
        return json(&findings);
    }
    let mut text = format!("{}: a valid study of {} run(s)\n", shown(path), findings.runs);
    let [first, last] = [f64::min, f64::max].map(|further| findings.levels.iter().copied().reduce(further));
    let [first, last] = [first, last].map(|level| significant(level.unwrap_or(f64::NAN), 5));
    let label = ida.intensity().label();
    let _ = writeln!(text, "  {label}: {} level(s), from {first} to {last}", findings.levels.len());
    let _ = writeln!(text, "  {} record(s), scaled by", findings.records.len());
    for record in &findings.records {
        let [low, high] = record.scales.map(|scale| significant(scale, 4));
        let vertical = if record.has_vertical { ", with its vertical component" } else { "" };
        let _ = writeln!(text, "    {low} to {high}  {}{vertical}", printable(&record.name));
    }
    let _ = writeln!(text, "  limit states: {}", findings.states.join(", "));
    let _ = writeln!(text, "run the study with `rocking ida {}`", shell_word(&shown(path)));
    print(&text)
}

/// What is said of runs that are refused; the highest level of each record is read.
fn refused(ida: &Ida) -> Option<String> {
    let levels = ida.levels();
    let highest = (0..levels.len()).max_by(|one, other| levels[*one].total_cmp(&levels[*other]))?;
    let reason = |record: usize| match ida.scene_of(record * levels.len() + highest) {
        Err(error) => Some((record, error.to_string())),
        Ok(scene) => scene.check().err().map(|error| (record, error.to_string())),
    };
    let refused: Vec<(usize, String)> = (0..ida.records().len()).filter_map(reason).collect();
    let (first, problem) = refused.first()?;
    Some(format!(
        "at the highest level, {} of {} run(s) are refused, and would be rows with errors; {}: {problem}",
        refused.len(),
        ida.records().len(),
        printable(&ida.records()[*first].name)
    ))
}
