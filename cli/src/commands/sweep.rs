//! `rocking sweep`: a table with a row per point, written as it grows, so that a sweep that is cut off goes on where it was.
//!
//! The growing table (`table/growing.rs`) is told from others by a fingerprint of all that decides its rows.

use crate::arguments;
use crate::commands::{json, print, spectrum};
use crate::error::Failure;
use crate::output;
use crate::progress::Points;
use crate::table::growing::Growing;
use crate::table::{Column, Format, Kind, header, quoted};
use rocking::scene_file::{MOST_BLOCKS, Setting};
use rocking::sweep::{Ask, Fate, Row, Sweep};
use serde::Serialize;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Points run together at first. Batches grow and shrink to take [`PATIENCE`]: long enough to keep all threads busy, short enough that
/// little is lost when a sweep is cut off. Rows do not depend on them.
const BATCH: usize = 256;
const MOST: usize = 1 << 16;
const PATIENCE: Duration = Duration::from_millis(250);

/// Runs a sweep, or what is left of it.
///
/// # Errors
/// [`Failure`]
pub fn sweep(asked: &arguments::Sweep) -> Result<(), Failure> {
    let out = asked.table();
    let format = Format::of(&out)?;
    let sweep = Sweep::from_file(&asked.file).map_err(Failure::scene)?;
    if asked.plot.is_some() {
        spectrum::check(asked, &sweep)?;
    }
    let target = check_files(asked, &sweep)?;
    let range = asked.shard.map_or(0..sweep.len(), |shard| shard.points(sweep.len()));
    let columns = columns(&sweep)?;
    let threads = rayon::ThreadPoolBuilder::new().num_threads(asked.threads.map_or(0, usize::from)).build();
    let threads = threads.map_err(|error| Failure::Print { problem: error.to_string() })?;
    let failed = |error: std::io::Error| Failure::File { path: out.clone(), problem: error.to_string() };
    let fingerprint = fingerprint(&sweep, &range, &asked.file)?;
    let mut table = Growing::open(&target, &header(&columns), fingerprint, range.clone())?;
    let bar = Points::new(range.len(), table.next - range.start, asked.quiet || asked.json);
    let resumed = table.next - range.start;
    let (mut size, mut next, mut last) = (BATCH, table.next, Vec::new());
    while table.next < range.end {
        let begun = Instant::now();
        let batch = next..range.end.min(next + size);
        next = batch.end;
        // A batch is written while the one after it runs.
        let run = || sweep.lines(batch, |row| line(&row, columns.len()));
        let (lines, written) = threads.install(|| rayon::join(run, || table.append(last.into_iter())));
        written.map_err(failed)?;
        last = lines;
        bar.reached(table.next - range.start);
        size = if begun.elapsed() < PATIENCE { (2 * size).min(MOST) } else { (size / 2).max(BATCH) };
    }
    bar.finish();
    let broken = |error: std::io::Error| Failure::Part { path: table.part.clone(), problem: error.to_string() };
    let tally = if asked.quiet { None } else { Some(Tally::of(&table.part).map_err(broken)?) };
    table.close(format, &columns)?;
    let drawn = match &asked.plot {
        Some(picture) => spectrum::draw(&out, picture)?,
        None => String::new(),
    };
    let Some(tally) = tally else { return Ok(()) };
    if asked.json {
        return json(&tally);
    }
    let resumed = if resumed > 0 { format!(" ({resumed} of them were there already)") } else { String::new() };
    print(&format!("{tally}wrote {} row(s){resumed} to {}\n{drawn}", range.len(), out.display()))
}

/// Where the table is put, if nothing that the sweep is made of, or writes elsewhere, is written over.
fn check_files(asked: &arguments::Sweep, sweep: &Sweep) -> Result<PathBuf, Failure> {
    let mut outputs = vec![asked.table()];
    outputs.extend(asked.plot.iter().flat_map(|picture| spectrum::files(picture)));
    output::check(&outputs, &inputs_of(&asked.file, sweep))?;
    output::target(&outputs[0])
}

/// The files that a sweep is made of, its own among them.
pub fn inputs_of(file: &Path, sweep: &Sweep) -> Vec<PathBuf> {
    records(sweep).into_iter().chain([file.into(), sweep.template.file().into()]).collect()
}

/// The records of the base scene and of the axes.
fn records(sweep: &Sweep) -> Vec<PathBuf> {
    let axes = sweep.axes.iter().filter(|axis| axis.key.ends_with(".file"));
    let of_axes = axes.flat_map(|axis| &axis.values).map(|value| sweep.template.beside(&value.to_string()));
    sweep.template.records().into_iter().chain(of_axes).collect()
}

/// The column of what became of the column.
pub const OUTCOME: &str = "outcome";

/// The column of when it overturned.
pub const TIME: &str = "overturned_at";

/// The columns of the table of a sweep.
///
/// # Errors
/// [`Failure::Scene`]
pub fn columns(sweep: &Sweep) -> Result<Vec<Column>, Failure> {
    let mut columns = vec![Column::full("index", Kind::Whole)];
    columns.extend(sweep.axes.iter().map(|axis| {
        let is_number = axis.values.iter().all(|value| matches!(value, Setting::Number(_)));
        Column::full(&axis.key, if is_number { Kind::Number } else { Kind::Text })
    }));
    columns.push(Column::full(OUTCOME, Kind::Text));
    columns.push(Column::sparse("impacts", Kind::Whole));
    columns.push(Column::sparse("block", Kind::Whole));
    columns.push(Column::sparse(TIME, Kind::Number));
    if sweep.ask == Ask::Peaks {
        let base = sweep.template.with(std::iter::empty()).map_err(Failure::scene)?;
        let counts = sweep.axes.iter().filter(|axis| axis.key == "column.blocks").flat_map(|axis| &axis.values);
        // Larger numbers are rows with errors.
        let counts = counts.filter_map(|count| count.to_string().parse().ok()).filter(|count| *count <= MOST_BLOCKS);
        let blocks = 1..=counts.max().unwrap_or(base.column.len());
        columns.extend(blocks.map(|block| Column::sparse(format!("peak_{block}"), Kind::Number)));
        columns.push(Column::sparse("last_mode", Kind::Text));
    }
    columns.push(Column::sparse("error", Kind::Text));
    Ok(columns)
}

/// A row as a line of so many cells of CSV.
fn line(row: &Row, columns: usize) -> String {
    let mut cells = vec![row.index.to_string()];
    cells.extend(row.settings.iter().map(|setting| quoted(&setting.to_string())));
    match &row.result {
        Ok(outcome) => {
            cells.push(outcome.fate.name().into());
            cells.push(outcome.impacts.to_string());
            cells.push(outcome.block.map_or(String::new(), |block| block.to_string()));
            cells.push(outcome.overturned_at.map_or(String::new(), |t| format!("{t:?}")));
            cells.extend(outcome.peaks.iter().map(|peak| format!("{peak:?}")));
            if let Some(mode) = &outcome.last_mode {
                // Columns of fewer blocks than the largest have blank peaks.
                cells.resize(columns - 2, String::new());
                cells.push(mode.clone());
            }
            cells.push(String::new());
        }
        Err(error) => {
            cells.push("error".into());
            cells.resize(columns - 1, String::new());
            cells.push(quoted(&error.to_string()));
        }
    }
    cells.join(",")
}

/// A number that changes with all that decides the rows: version, scene, axes, records, range.
fn fingerprint(sweep: &Sweep, range: &Range<usize>, file: &Path) -> Result<u64, Failure> {
    let mut hash = Fnv::default();
    hash.add(env!("CARGO_PKG_VERSION").as_bytes());
    hash.add(rocking::scene_file::text(file).map_err(Failure::scene)?.as_bytes());
    hash.add(sweep.template.text().as_bytes());
    hash.add(format!("{range:?}").as_bytes());
    for axis in &sweep.axes {
        hash.add(axis.key.as_bytes());
        axis.values.iter().for_each(|value| hash.add(value.to_string().as_bytes()));
    }
    // Another record of the same name gives other rows.
    for record in records(sweep) {
        hash.add(&std::fs::read(record).unwrap_or_default());
    }
    Ok(hash.0)
}

/// Fowler, Noll & Vo's hash, 1a, of 64 bits: the same in every version and on every machine.
#[derive(Debug)]
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Fnv {
        Fnv(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes.iter().chain(b"\0") {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

/// How many rows have which outcome.
#[derive(Debug, Default, Serialize)]
struct Tally {
    no_uplift: usize,
    rocks: usize,
    overturns: usize,
    errors: usize,
}

impl Tally {
    /// Of rows of CSV.
    fn of(path: &Path) -> std::io::Result<Tally> {
        let mut tally = Tally::default();
        let mut reader = csv::Reader::from_path(path)?;
        let outcome = reader.headers()?.iter().position(|name| name == OUTCOME);
        for row in reader.records() {
            let row = row?;
            let name = outcome.and_then(|outcome| row.get(outcome)).unwrap_or_default();
            let count =
                match [Fate::NoUplift, Fate::Rocks, Fate::Overturns].into_iter().find(|fate| fate.name() == name) {
                    Some(Fate::NoUplift) => &mut tally.no_uplift,
                    Some(Fate::Rocks) => &mut tally.rocks,
                    Some(Fate::Overturns) => &mut tally.overturns,
                    None => &mut tally.errors,
                };
            *count += 1;
        }
        Ok(tally)
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Tally { no_uplift, rocks, overturns, errors } = self;
        writeln!(f, "no uplift {no_uplift}, rocks {rocks}, overturns {overturns}, errors {errors}")
    }
}
