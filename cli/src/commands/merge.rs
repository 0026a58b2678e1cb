//! `rocking merge`: one table of the tables of all shards of a sweep.
//!
//! A table holds its points and not how many the sweep has. That the last ones are missing is therefore seen only if the sweep is
//! given as well.

use crate::commands::print;
use crate::commands::sweep::columns;
use crate::error::Failure;
use crate::output;
#[cfg(feature = "parquet")]
use crate::table::parquet;
use crate::table::{self, Column, Format, Rows};
use csv::StringRecord;
use rocking::scene_file::Setting;
use rocking::sweep::{Fate, Sweep};
use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Joins tables in the order of their points. With the sweep's file it is certain that all points are there.
///
/// # Errors
/// [`Failure::Shards`] for tables that do not belong together, [`Failure::ShardsMissing`], [`Failure::InUse`], [`Failure::File`],
/// [`Failure::Scene`], [`Failure::NoParquet`]
pub fn merge(out: &Path, shards: &[PathBuf], sweep: Option<&Path>) -> Result<(), Failure> {
    let format = Format::of(out)?;
    let wanted = sweep.map(Wanted::of).transpose()?;
    let inputs: Vec<PathBuf> = shards.iter().cloned().chain(sweep.map(Path::to_path_buf)).collect();
    output::check(&[out.into()], &inputs)?;
    let mut tables = Vec::new();
    for path in shards {
        if Format::of(path)? != format {
            let problem = format!("{} is to be of the other format, and tables are not converted", out.display());
            return Err(Failure::Shards { path: path.clone(), problem });
        }
        tables.push((first(path)?, path.as_path()));
    }
    // Of more shards than points some have no row; they come first.
    tables.sort();
    let tables: Vec<&Path> = tables.into_iter().map(|(_, path)| path).collect();
    let rows = check(&tables, wanted.as_ref())?;

    let failed = |error: std::io::Error| Failure::File { path: out.into(), problem: error.to_string() };
    let merged = tempfile::NamedTempFile::new_in(output::folder_of(out)).map_err(failed)?;
    match format {
        Format::Csv => join_csv(&tables, merged.as_file(), failed)?,
        #[cfg(feature = "parquet")]
        Format::Parquet => join_parquet(&tables, wanted.as_ref(), merged.as_file(), failed)?,
    }
    let told = match wanted {
        Some(wanted) => format!("all points of {}", wanted.file.display()),
        None => "--sweep FILE would tell whether points after them are missing".into(),
    };
    output::share(&merged).map_err(failed)?;
    merged.persist(out).map_err(|error| failed(error.error))?;
    print(&format!("wrote {rows} row(s) of {} table(s) to {}: {told}\n", tables.len(), out.display()))
}

/// What the tables must make.
struct Wanted<'a> {
    file: &'a Path,
    sweep: Sweep,
    columns: Vec<Column>,
}

impl Wanted<'_> {
    fn of(file: &Path) -> Result<Wanted<'_>, Failure> {
        let sweep = Sweep::from_file(file).map_err(Failure::scene)?;
        Ok(Wanted { file, columns: columns(&sweep)?, sweep })
    }

    /// Whether a row has the values of a point.
    fn has(&self, row: &StringRecord, point: usize) -> bool {
        let is_cell = |(setting, cell): (&Setting, &str)| table::on_one_line(&setting.to_string()) == cell;
        point < self.sweep.len() && self.sweep.settings(point).into_iter().zip(row.iter().skip(1)).all(is_cell)
    }
}

/// The number of the first point of a table that has rows.
fn first(path: &Path) -> Result<Option<u64>, Failure> {
    let row = Rows::open(path).map_err(broken(path))?.rows.next().transpose().map_err(broken(path))?;
    row.map(|row| index(&row, path)).transpose()
}

/// Whether the rows of tables in their order are those of one sweep, whole, each point once; returns how many they are.
fn check(tables: &[&Path], wanted: Option<&Wanted>) -> Result<usize, Failure> {
    let mut header = wanted.map(|wanted| wanted.columns.iter().map(|column| column.name.as_str()).collect());
    let mut next = 0;
    for path in tables {
        let Rows { header: found, rows } = Rows::open(path).map_err(broken(path))?;
        if *header.get_or_insert_with(|| found.clone()) != found {
            return Err(other_columns(path, wanted));
        }
        let outcome = found.iter().position(|name| name == "outcome");
        let outcome = outcome.ok_or_else(|| broken(path)("it has no column `outcome`"))?;
        for row in rows {
            let row = row.map_err(broken(path))?;
            let point = index(&row, path)?;
            if point != next as u64 {
                return Err(broken(path)(format!("it has point {point} where {next} is due")));
            }
            if !is_whole(&row, outcome) {
                return Err(broken(path)(format!("the row of point {point} is not whole")));
            }
            if let Some(wanted) = wanted.filter(|wanted| !wanted.has(&row, next)) {
                let file = wanted.file.display();
                return Err(broken(path)(format!(
                    "the row of point {point} is none of {file}: its axes have other values"
                )));
            }
            next += 1;
        }
    }
    match wanted {
        Some(Wanted { sweep, file, .. }) if sweep.len() != next => {
            Err(Failure::ShardsMissing { sweep: file.into(), points: sweep.len(), rows: next })
        }
        _ => Ok(next),
    }
}

/// Whether a row has an outcome, or an error and no outcome.
fn is_whole(row: &StringRecord, outcome: usize) -> bool {
    let is_fate = [Fate::NoUplift, Fate::Rocks, Fate::Overturns].iter().any(|fate| fate.name() == &row[outcome]);
    let has_error = row.iter().next_back().is_some_and(|error| !error.is_empty());
    is_fate != has_error && (is_fate || &row[outcome] == "error")
}

/// Writes the rows of tables below the header of the first.
fn join_csv(tables: &[&Path], out: &File, failed: impl Fn(std::io::Error) -> Failure) -> Result<(), Failure> {
    let mut writer = BufWriter::new(out);
    for (place, path) in tables.iter().enumerate() {
        let lines = BufReader::new(File::open(path).map_err(broken(path))?).lines();
        for line in lines.skip(usize::from(place > 0)) {
            let line = line.map_err(broken(path))?;
            if !line.is_empty() {
                writeln!(writer, "{line}").map_err(&failed)?;
            }
        }
    }
    writer.flush().map_err(&failed)
}

/// The same; the rows of all tables are cut into groups anew.
#[cfg(feature = "parquet")]
fn join_parquet(
    tables: &[&Path],
    wanted: Option<&Wanted>,
    out: &File,
    failed: impl Fn(std::io::Error) -> Failure,
) -> Result<(), Failure> {
    let open = |path: &Path| parquet::Reader::open(path).map_err(broken(path));
    let columns =
        wanted.map_or_else(|| open(tables[0]).map(|table| table.columns), |wanted| Ok(wanted.columns.clone()))?;
    let mut writer = parquet::Writer::new(BufWriter::new(out), &columns).map_err(&failed)?;
    for path in tables {
        let mut table = open(path)?;
        // Of the same names, but perhaps of other types.
        if table.columns != columns {
            return Err(other_columns(path, wanted));
        }
        while writer.take(&mut table).map_err(broken(path))? > 0 {
            writer.write_full().map_err(&failed)?;
        }
    }
    writer.finish().and_then(|mut file| file.flush()).map_err(&failed)
}

/// The number of the point of a row.
fn index(row: &StringRecord, path: &Path) -> Result<u64, Failure> {
    let index = row.get(0).and_then(|index| index.parse().ok());
    let text = || row.iter().collect::<Vec<_>>().join(",");
    index.ok_or_else(|| broken(path)(format!("the row `{}` does not begin with the number of its point", text())))
}

fn other_columns(path: &Path, wanted: Option<&Wanted>) -> Failure {
    broken(path)(match wanted {
        Some(wanted) => format!("its columns are not those of {}", wanted.file.display()),
        None => "its columns are not those of the others".into(),
    })
}

fn broken<E: ToString>(path: &Path) -> impl Fn(E) -> Failure {
    move |problem| Failure::Shards { path: path.into(), problem: problem.to_string() }
}
