//! `rocking sweep`: a table with a row per point; a sweep that was interrupted continues with the first missing row.
//!
//! The name of the unfinished table (`table/growing.rs`) holds a digest of all that decides its rows. A shard also writes the digest of the
//! whole sweep into a file beside its table: `rocking merge` compares these digests to recognise shards of another sweep.

use crate::arguments;
use crate::commands::probability::{self, Lost};
use crate::commands::spectrum::Drawn;
use crate::commands::{fractiles, lost_at, spectrum};
use crate::error::Failure;
use crate::output;
use crate::plot::Paper;
use crate::table::by_product::ByProduct;
use crate::table::column::{Column, FAILURE, Kind, OUTCOME, fits, has_result, text};
use crate::table::digest::{TableDigest, digest_file, is_digest};
use crate::table::making::Making;
use crate::table::tally::{Counting, Tally};
use crate::table::{Format, check_replaced};
use crate::terminal::{json, print, warn, warn_of_some};
use crate::text::{printable, shown};
use csv::StringRecord;
use rocking::Fate;
use rocking::ground::read_file;
use rocking::scene_file::Setting;
use rocking::sweep::{Ask, Field, Row, Sweep};
use serde::Serialize;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Runs a sweep, or the missing points of an interrupted one.
pub fn sweep(request: &arguments::Sweep) -> Result<(), Failure> {
    let out = request.table();
    let format = Format::of_output(&out)?;
    let sweep = Sweep::from_file(&request.file).map_err(Failure::scene)?;
    if request.plot.is_some() {
        spectrum::check(request, &sweep)?;
    }
    // They need all points: shards have none.
    let by_products = if request.shard.is_none() { by_products(&sweep) } else { Vec::new() };
    let inputs = inputs_of(&request.file, &sweep);
    output::check(&files(request, &out, &by_products), &inputs)?;
    let target = output::target(&out)?;
    check_replaced(&target)?;
    by_products.iter().try_for_each(|kind| kind.check_replaced(&kind.of(&out)))?;
    if request.shard.is_some() {
        output::check_replaced(&digest_file(&out), is_digest)?;
    }
    let columns = columns(&sweep)?;
    let threads = request.threads.pool()?;
    if !request.quiet {
        warn_of_some(&sweep.warnings(points(request, &sweep), POINTS_READ));
    }
    let (digest, points) = (digest(&sweep, &request.file)?, points(request, &sweep));
    let mut of_points = digest;
    of_points.add(format!("{points:?}").as_bytes());
    let making = Making {
        out: &out,
        target: &target,
        format,
        columns: &columns,
        points,
        threads: &threads,
        shows_progress: !request.quiet && !request.json,
        inputs: &inputs,
    };
    let fields = sweep.fields().map_err(Failure::scene)?;
    let is_row = |row: &StringRecord, point: usize| is_row(&sweep, &columns, row, point);
    let table = making.make(of_points, is_row, || {
        let (mut row, fields, ask) = (sweep.worker(), &fields, sweep.ask);
        move |index| {
            let row = row(index);
            let mut cells = StringRecord::with_capacity(USUAL_LENGTH, fields.len());
            fields.iter().for_each(|field| cells.push_field(&cell(&row, *field, ask)));
            cells
        }
    })?;
    // Only now: an interrupted run leaves the table of an earlier one with the digest of that one.
    match request.shard {
        Some(_) => output::file(&digest_file(&out), digest.to_string())?,
        None => output::remove(&digest_file(&out), &inputs, is_digest)?,
    }
    let has = |kind: ByProduct| by_products.contains(&kind);
    let lost = if has(ByProduct::Probability) { probability::of(&sweep, &out)? } else { Vec::new() };
    let probabilities = probability::write(&sweep, &lost, &out)?;
    let fractiles = if has(ByProduct::Fractiles) { fractiles::write(&sweep, &out)? } else { String::new() };
    // Last: where a figure cannot be drawn, the tables and the counts are there.
    let drawn =
        request.plot.as_ref().map_or(Ok(Drawn::default()), |picture| spectrum::draw(&out, picture, &Paper::default()));
    if let Some(drawn) = drawn.as_ref().ok().filter(|_| !request.quiet) {
        warn(&drawn.warnings);
    }
    if request.json {
        json(&Counts { tally: &table.counting.tally, lost })?;
    } else if !request.quiet {
        let Counting { tally, rows, first_error, .. } = &table.counting;
        let wrote = format!("wrote {rows} row(s){} to {}\n", table.already_there(), shown(&out));
        // If all rows are errors, the failure below states the first one.
        let failed = first_error.as_ref().filter(|_| tally.errors < *rows);
        let failed = failed.map_or(String::new(), |error| format!("the first error: {error}\n"));
        let figures = drawn.as_ref().map_or("", |drawn| &drawn.report);
        let at = if request.shard.is_none() { lost_at::in_words(&sweep, &out)? } else { String::new() };
        print(&format!("{tally}{at}{failed}{wrote}{probabilities}{fractiles}{figures}"))?;
    }
    table.counting.failure(&out, false).map_or(Ok(()), Err)?;
    drawn.map(|_| ())
}

/// Tables that are made of the table of a whole sweep.
pub fn by_products(sweep: &Sweep) -> Vec<ByProduct> {
    let probability = sweep.samples().map(|_| ByProduct::Probability);
    probability.into_iter().chain(fractiles::has(sweep).then_some(ByProduct::Fractiles)).collect()
}

/// All files that a sweep writes.
fn files(request: &arguments::Sweep, out: &Path, by_products: &[ByProduct]) -> Vec<PathBuf> {
    let mut files = vec![out.to_path_buf()];
    files.extend(request.plot.iter().flat_map(|picture| spectrum::files(picture)));
    files.extend(by_products.iter().map(|kind| kind.of(out)));
    files.extend(request.shard.map(|_| digest_file(out)));
    files
}

/// The points to be run: all of a sweep, or those of a shard.
fn points(request: &arguments::Sweep, sweep: &Sweep) -> Range<usize> {
    request.shard.map_or(0..sweep.len(), |shard| shard.points(sweep.len()))
}

/// Room made for a row of a table, in bytes.
const USUAL_LENGTH: usize = 256;

/// Whether a row may be that of a point of a sweep: it has the values of the point, each cell fits its column, there is an outcome or an error, and a time
/// of overturning exactly if the column overturns and the sweep asks for that time.
pub fn is_row(sweep: &Sweep, columns: &[Column], row: &StringRecord, point: usize) -> bool {
    let is_setting = |(setting, cell): (&Setting, &str)| printable(&setting.to_string()) == cell;
    let of_axes = || sweep.settings(point).into_iter().zip(row.iter().skip(1));
    let cells = || columns.iter().zip(row);
    let cell = |name: &str| cells().find(|(column, _)| column.name == name).map_or("", |(_, cell)| cell);
    let is_timed = sweep.ask != Ask::Overturns && cell(OUTCOME) == Fate::Overturns.name();
    point < sweep.len()
        && of_axes().all(is_setting)
        && fits(columns, row)
        && has_result(cell(OUTCOME), cell(FAILURE))
        && is_timed != cell(TIME).is_empty()
}

/// Largest number of points whose scenes are read before a sweep runs: a scene takes some 10 µs, and each record is read once.
pub const POINTS_READ: usize = 1000;

/// The files that a sweep is made of: records, the sweep file itself, and the base scene.
pub fn inputs_of(file: &Path, sweep: &Sweep) -> Vec<PathBuf> {
    records(sweep).into_iter().chain([file.into(), sweep.template.file().into()]).collect()
}

/// The records of the base scene and of the axes, each once, whether or not a scene has been made of them yet.
fn records(sweep: &Sweep) -> Vec<PathBuf> {
    let axes = sweep.axes.iter().filter(|axis| axis.key.ends_with(".file"));
    let of_axes = axes.flat_map(|axis| &axis.values).map(|value| sweep.template.beside(&value.to_string()));
    let of_stations = sweep.axes.iter().filter(|axis| axis.key == "excitation.station.record");
    let of_stations = of_stations.flat_map(|axis| &axis.values);
    let components = of_stations.flat_map(|value| sweep.template.files_of_record(&value.to_string()));
    let mut records: Vec<PathBuf> = sweep.template.records().into_iter().chain(of_axes).chain(components).collect();
    records.sort();
    records.dedup();
    records
}

/// The column of the time of overturning.
pub const TIME: &str = "overturned_at";

/// The columns of the table of a sweep.
pub fn columns(sweep: &Sweep) -> Result<Vec<Column>, Failure> {
    let column = |field: Field| {
        let full = matches!(field, Field::Index | Field::Axis(_) | Field::Outcome);
        let is_number = |place: usize| sweep.axes[place].values.iter().all(|value| matches!(value, Setting::Number(_)));
        let kind = match field {
            Field::Axis(place) if is_number(place) => Kind::Number,
            field => field.kind().into(),
        };
        let make = if full { Column::full } else { Column::sparse };
        make(sweep.heading(field), kind)
    };
    Ok(sweep.fields().map_err(Failure::scene)?.into_iter().map(column).collect())
}

/// A cell of a row as text.
fn cell(row: &Row, field: Field, ask: Ask) -> String {
    match field {
        Field::Index => row.index.to_string(),
        Field::Axis(place) => printable(&row.settings[place].to_string()).into_owned(),
        field => text(field.cell(&row.result, ask)),
    }
}

/// The digest of all that decides the rows of a sweep: version, sweep file, base scene, axes, records.
pub fn digest(sweep: &Sweep, file: &Path) -> Result<TableDigest, Failure> {
    let mut digest = TableDigest::new();
    digest.add(rocking::scene_file::text(file).map_err(Failure::scene)?.as_bytes());
    digest.add(sweep.template.text().as_bytes());
    for axis in &sweep.axes {
        digest.add(axis.key.as_bytes());
        axis.values.iter().for_each(|value| digest.add(value.to_string().as_bytes()));
    }
    // Another record of the same name gives other rows.
    for record in records(sweep) {
        digest.add(&read_file(&record).unwrap_or_default());
    }
    Ok(digest)
}

/// A sweep as JSON.
#[derive(Serialize)]
struct Counts<'a> {
    #[serde(flatten)]
    tally: &'a Tally,
    /// Probabilities of a sweep over distributions.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    lost: Vec<Lost>,
}
