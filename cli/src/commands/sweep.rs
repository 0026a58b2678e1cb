//! `rocking sweep`: a table with a row per point; a sweep that was interrupted continues with the first missing row.
//!
//! The name of the unfinished table (`table/growing.rs`) holds a digest of all that decides its rows. A shard also writes the digest of the
//! whole sweep into a file beside its table: `rocking merge` compares these digests to recognise shards of another sweep.

use crate::arguments;
use crate::commands::probability::{self, Lost};
use crate::commands::{fractiles, lost_at, spectrum};
use crate::error::Failure;
use crate::output;
use crate::plot::Paper;
use crate::progress::Progress;
use crate::table::column::{Column, FAILURE, Kind, fits, has_result, text};
use crate::table::growing::Growing;
use crate::table::{Format, check_replaced};
use crate::terminal::{json, print, warn_of_some};
use crate::text::{printable, shown};
use csv::StringRecord;
use rocking::Fate;
use rocking::ground::read_file;
use rocking::run_folder::Digest;
use rocking::scene_file::Setting;
use rocking::sweep::{Ask, Field, Row, Sweep};
use rocking::trust::Degree;
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
    let made = Made::of(request, &sweep);
    let inputs = inputs_of(&request.file, &sweep);
    output::check(&made.files(request, &out), &inputs)?;
    let target = output::target(&out)?;
    check_replaced(&target)?;
    let columns = columns(&sweep)?;
    let threads = threads(request.threads)?;
    if !request.quiet {
        warn_of_some(&sweep.warnings(points(request, &sweep), POINTS_READ));
    }
    let digest = TableDigest::of(&sweep, &request.file)?;
    let (table, resumed) = filled(request, &sweep, digest, &target, &columns, &threads)?;
    let (tally, first_error) = Tally::of(&table.part).map_err(Failure::part(&table.part))?;
    let rows = points(request, &sweep).len();
    let failure = |first: String, is_kept| Failure::NoResult { table: out.clone(), points: rows, first, is_kept };
    let first_of_all = first_error.as_ref().filter(|_| tally.errors == rows);
    // A table of errors takes the place of no other table.
    if let Some(first) = first_of_all.filter(|_| target.exists()) {
        table.discard()?;
        return Err(failure(first.clone(), true));
    }
    table.close(format, &columns)?;
    // Only now: an interrupted run leaves the table of an earlier one with the digest of that one.
    match request.shard {
        Some(_) => output::file(&digest_file(&out), digest.to_string())?,
        None => output::remove(&digest_file(&out), &inputs)?,
    }
    // Tables that belong to the table of an earlier sweep of this name.
    for by_product in [probability::table(&out), fractiles::table(&out)] {
        output::remove(&by_product, &inputs)?;
    }
    let lost = if made.probabilities { probability::of(&sweep, &out)? } else { Vec::new() };
    let probabilities = probability::write(&sweep, &lost, &out)?;
    let fractiles = if made.fractiles { fractiles::write(&sweep, &out)? } else { String::new() };
    // Last: where a figure cannot be drawn, the tables and the counts are there.
    let drawn =
        request.plot.as_ref().map_or(Ok(String::new()), |picture| spectrum::draw(&out, picture, &Paper::default()));
    if request.json {
        json(&Counts { tally: &tally, lost })?;
    } else if !request.quiet {
        let wrote = format!("wrote {rows} row(s){} to {}\n", already_there(resumed), shown(&out));
        // If all rows are errors, the failure below states the first one.
        let failed = first_error.as_ref().filter(|_| tally.errors < rows);
        let failed = failed.map_or(String::new(), |error| format!("the first error: {error}\n"));
        let figures = drawn.as_deref().unwrap_or_default();
        let at = if request.shard.is_none() { lost_at::in_words(&sweep, &out)? } else { String::new() };
        print(&format!("{tally}{at}{failed}{wrote}{probabilities}{fractiles}{figures}"))?;
    }
    drawn?;
    first_of_all.map_or(Ok(()), |first| Err(failure(first.clone(), false)))
}

/// Which tables are made of the table of a sweep. They need all its points: shards have none.
#[derive(Clone, Copy)]
struct Made {
    probabilities: bool,
    fractiles: bool,
}

impl Made {
    fn of(request: &arguments::Sweep, sweep: &Sweep) -> Made {
        let is_whole = request.shard.is_none();
        Made { probabilities: is_whole && sweep.samples().is_some(), fractiles: is_whole && fractiles::has(sweep) }
    }

    /// All files that a sweep writes.
    fn files(self, request: &arguments::Sweep, out: &Path) -> Vec<PathBuf> {
        let mut files = vec![out.to_path_buf()];
        files.extend(request.plot.iter().flat_map(|picture| spectrum::files(picture)));
        files.extend(self.probabilities.then(|| probability::table(out)));
        files.extend(self.fractiles.then(|| fractiles::table(out)));
        files.extend(request.shard.map(|_| digest_file(out)));
        files
    }
}

/// The points to be run: all of a sweep, or those of a shard.
fn points(request: &arguments::Sweep, sweep: &Sweep) -> Range<usize> {
    request.shard.map_or(0..sweep.len(), |shard| shard.points(sweep.len()))
}

/// The unfinished table with all its rows, and how many of them an interrupted sweep had left.
fn filled(
    request: &arguments::Sweep,
    sweep: &Sweep,
    mut digest: TableDigest,
    target: &Path,
    columns: &[Column],
    threads: &rayon::ThreadPool,
) -> Result<(Growing, usize), Failure> {
    let points = points(request, sweep);
    let fields = sweep.fields().map_err(Failure::scene)?;
    digest.add(format!("{points:?}").as_bytes());
    let is_row = |row: &StringRecord, point: usize| is_row(sweep, columns, row, point);
    let mut table = Growing::open(target, columns, digest.number(), points.clone(), is_row)?;
    let resumed = table.next - points.start;
    let bar = Progress::of_points(points.len(), resumed, request.quiet || request.json);
    table.fill(points.end, threads, &bar, || {
        let (mut row, fields, ask) = (sweep.worker(), &fields, sweep.ask);
        move |index| {
            let row = row(index);
            let mut cells = StringRecord::with_capacity(USUAL_LENGTH, fields.len());
            fields.iter().for_each(|field| cells.push_field(&cell(&row, *field, ask)));
            cells
        }
    })?;
    Ok((table, resumed))
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

/// How many rows an interrupted run had left, in words; nothing if none.
pub fn already_there(rows: usize) -> String {
    if rows > 0 { format!(" ({rows} of them were there already)") } else { String::new() }
}

/// Largest number of points whose scenes are read before a sweep runs: a scene takes some 10 µs, and each record is read once.
pub const POINTS_READ: usize = 1000;

/// A pool of `count` threads; without a count, as many as the machine has.
pub fn threads(count: Option<u16>) -> Result<rayon::ThreadPool, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count.map_or(0, usize::from)).build();
    pool.map_err(|error| Failure::Threads(error.to_string()))
}

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

pub use crate::table::column::{OUTCOME, TRUNCATED, TRUST};

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

/// The file beside a shard's table that holds the digest of the sweep.
pub fn digest_file(table: &Path) -> PathBuf {
    let mut name = table.file_name().unwrap_or_default().to_os_string();
    name.push(".digest");
    table.with_file_name(name)
}

/// Digest of everything that determines the rows of a table, the version of the program included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableDigest(Digest);

impl TableDigest {
    /// The digest of this version of the program.
    pub fn new() -> TableDigest {
        let mut digest = TableDigest(Digest::default());
        digest.add(env!("CARGO_PKG_VERSION").as_bytes());
        digest
    }

    /// The digest as a number.
    pub fn number(self) -> u64 {
        self.0.number()
    }

    /// The digest of all that decides the rows of a sweep: version, sweep file, base scene, axes, records.
    pub fn of(sweep: &Sweep, file: &Path) -> Result<TableDigest, Failure> {
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

    /// Adds bytes, and a zero byte that ends them.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0.add(bytes);
        self.0.add(b"\0");
    }
}

impl std::fmt::Display for TableDigest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
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

/// Number of rows by outcome.
#[derive(Debug, Default, Serialize)]
pub struct Tally {
    no_uplift: usize,
    rocks: usize,
    overturns: usize,
    /// With friction only, as `collapses` and `undetermined`.
    slides: usize,
    collapses: usize,
    undetermined: usize,
    pub errors: usize,
    /// Rows of truncated runs: the blocks stand at `t_end`, and the ground moves on, they may overturn, or they slide on. They are also counted by outcome.
    truncated: usize,
    /// Rows whose verdict is not determined, in sweeps that ask for trust and in studies. They are counted here alone.
    not_determined: usize,
    /// Rows whose verdict is likely. They are also counted by outcome.
    pub likely: usize,
}

impl Tally {
    /// The tally of a table of CSV, and the first error in it.
    pub fn of(path: &Path) -> std::io::Result<(Tally, Option<String>)> {
        let (mut tally, mut first_error) = (Tally::default(), None);
        let mut reader = csv::Reader::from_path(path)?;
        let place = |headers: &StringRecord, column: &str| headers.iter().position(|name| name == column);
        let headers = reader.headers()?;
        let [outcome, truncated, trust] = [OUTCOME, TRUNCATED, TRUST].map(|name| place(headers, name));
        let mut row = StringRecord::new();
        while reader.read_record(&mut row)? {
            tally.truncated += usize::from(truncated.and_then(|place| row.get(place)) == Some("true"));
            let degree = trust.and_then(|place| Degree::parse(row.get(place)?));
            tally.likely += usize::from(degree == Some(Degree::Likely));
            *match outcome.and_then(|outcome| row.get(outcome)).unwrap_or_default() {
                name if name == Fate::Undetermined.name() => &mut tally.undetermined,
                _ if degree == Some(Degree::NotDetermined) => &mut tally.not_determined,
                name if name == Fate::NoUplift.name() => &mut tally.no_uplift,
                name if name == Fate::Rocks.name() => &mut tally.rocks,
                name if name == Fate::Overturns.name() => &mut tally.overturns,
                name if name == Fate::Slides.name() => &mut tally.slides,
                name if name == Fate::Collapses.name() => &mut tally.collapses,
                name if name == Fate::NotDetermined.name() => &mut tally.not_determined,
                _ => {
                    first_error.get_or_insert_with(|| row.iter().next_back().unwrap_or_default().to_string());
                    &mut tally.errors
                }
            } += 1;
        }
        Ok((tally, first_error))
    }
}

/// A line about runs whose verdict is likely; empty if there are none.
pub fn likely_in_words(runs: usize) -> String {
    match runs {
        0 => String::new(),
        _ => format!(
            "likely: {runs} run(s), counted with their own outcome: nine companions do not determine it, and 24 more have it as well \
             (column {TRUST}; the book, trust)\n"
        ),
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Tally { no_uplift, rocks, overturns, errors, .. } = self;
        write!(f, "no uplift {no_uplift}, rocks {rocks}, overturns {overturns}")?;
        let others = [
            ("slides", self.slides),
            ("collapses", self.collapses),
            ("undetermined", self.undetermined),
            ("not determined (column trust)", self.not_determined),
        ];
        for (name, count) in others.iter().filter(|(_, count)| *count > 0) {
            write!(f, ", {name} {count}")?;
        }
        writeln!(f, ", errors {errors}")?;
        f.write_str(&likely_in_words(self.likely))?;
        if self.truncated > 0 {
            writeln!(
                f,
                "{} run(s) are cut at solver.t_end: the ground still moves there, the column may be falling, or blocks slide on",
                self.truncated
            )?;
        }
        Ok(())
    }
}
