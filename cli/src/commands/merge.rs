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
use crate::table::{self, Column, Format};
use rocking::sweep::Sweep;
use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Joins tables in the order of their points. With the sweep's file it is certain that all points are there.
///
/// # Errors
/// [`Failure::Shards`] for tables that do not belong together, [`Failure::ShardsMissing`], [`Failure::File`], [`Failure::Scene`],
/// [`Failure::NoParquet`]
pub fn merge(out: &Path, shards: &[PathBuf], sweep: Option<&Path>) -> Result<(), Failure> {
    let format = Format::of(out)?;
    let wanted = sweep.map(Wanted::of).transpose()?;
    let mut tables = Vec::new();
    for path in shards {
        if Format::of(path)? != format {
            let problem = format!("{} is to be of the other format, and tables are not converted", out.display());
            return Err(Failure::Shards { path: path.clone(), problem });
        }
        let first = match format {
            Format::Csv => first_of_csv(path)?,
            #[cfg(feature = "parquet")]
            Format::Parquet => {
                parquet::Reader::open(path).and_then(|mut table| table.first_index()).map_err(broken(path))?
            }
        };
        tables.push((first, path.as_path()));
    }
    // Of more shards than points some have no row; they come first.
    tables.sort();
    let tables: Vec<&Path> = tables.into_iter().map(|(_, path)| path).collect();

    let failed = |error: std::io::Error| Failure::File { path: out.into(), problem: error.to_string() };
    let folder = out.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let merged = tempfile::NamedTempFile::new_in(folder).map_err(failed)?;
    let rows = match format {
        Format::Csv => join_csv(&tables, wanted.as_ref(), merged.as_file(), failed)?,
        #[cfg(feature = "parquet")]
        Format::Parquet => join_parquet(&tables, wanted.as_ref(), merged.as_file(), failed)?,
    };
    let told = match wanted {
        Some(Wanted { points, sweep, .. }) if points != rows => {
            return Err(Failure::ShardsMissing { sweep: sweep.into(), points, rows });
        }
        Some(wanted) => format!("all points of {}", wanted.sweep.display()),
        None => "--sweep FILE would tell whether points after them are missing".into(),
    };
    output::share(&merged).map_err(failed)?;
    merged.persist(out).map_err(|error| failed(error.error))?;
    print(&format!("wrote {rows} row(s) of {} table(s) to {}: {told}\n", tables.len(), out.display()))
}

/// What the tables must make.
struct Wanted<'a> {
    sweep: &'a Path,
    points: usize,
    columns: Vec<Column>,
}

impl Wanted<'_> {
    fn of(file: &Path) -> Result<Wanted<'_>, Failure> {
        let sweep = Sweep::from_file(file).map_err(Failure::scene)?;
        Ok(Wanted { sweep: file, points: sweep.len(), columns: columns(&sweep)? })
    }
}

/// The number of the first point of a table that has rows.
fn first_of_csv(path: &Path) -> Result<Option<u64>, Failure> {
    let mut lines = BufReader::new(File::open(path).map_err(broken(path))?).lines();
    lines.nth(1).transpose().map_err(broken(path))?.map(|line| index(&line, path)).transpose()
}

/// Writes the rows of tables; returns how many they are.
fn join_csv(
    tables: &[&Path],
    wanted: Option<&Wanted>,
    out: &File,
    failed: impl Fn(std::io::Error) -> Failure,
) -> Result<usize, Failure> {
    let mut writer = BufWriter::new(out);
    let mut header = wanted.map(|wanted| table::header(&wanted.columns));
    let mut next = 0;
    for (place, path) in tables.iter().enumerate() {
        let lines = BufReader::new(File::open(path).map_err(broken(path))?).lines();
        let mut lines = lines.map(|line| line.map_err(broken(path)));
        let found = lines.next().unwrap_or_else(|| Err(broken(path)("there is no header")))?;
        if *header.get_or_insert_with(|| found.clone()) != found {
            return Err(other_columns(path, wanted));
        }
        if place == 0 {
            writeln!(writer, "{found}").map_err(&failed)?;
        }
        for line in lines {
            let line = line?;
            follows(index(&line, path)?, next, path)?;
            writeln!(writer, "{line}").map_err(&failed)?;
            next += 1;
        }
    }
    writer.flush().map_err(&failed)?;
    Ok(next)
}

/// As [`join_csv`]; the rows of all tables are cut into groups anew.
#[cfg(feature = "parquet")]
fn join_parquet(
    tables: &[&Path],
    wanted: Option<&Wanted>,
    out: &File,
    failed: impl Fn(std::io::Error) -> Failure,
) -> Result<usize, Failure> {
    let open = |path: &Path| parquet::Reader::open(path).map_err(broken(path));
    let columns =
        wanted.map_or_else(|| open(tables[0]).map(|table| table.columns), |wanted| Ok(wanted.columns.clone()))?;
    let mut writer = parquet::Writer::new(BufWriter::new(out), &columns).map_err(&failed)?;
    let mut next = 0;
    for path in tables {
        let mut table = open(path)?;
        if table.columns != columns {
            return Err(other_columns(path, wanted));
        }
        loop {
            let read = writer.take(&mut table).map_err(broken(path))?;
            if read.is_empty() {
                break;
            }
            for index in read {
                follows(*index as u64, next, path)?;
                next += 1;
            }
            writer.write_full().map_err(&failed)?;
        }
    }
    writer.finish().and_then(|mut file| file.flush()).map_err(&failed)?;
    Ok(next)
}

/// The number of the point of a line.
fn index(line: &str, path: &Path) -> Result<u64, Failure> {
    let index = line.split(',').next().and_then(|index| index.parse().ok());
    index.ok_or_else(|| broken(path)(format!("the row `{line}` does not begin with the number of its point")))
}

/// Whether the point is the next one.
fn follows(index: u64, next: usize, path: &Path) -> Result<(), Failure> {
    if index == next as u64 { Ok(()) } else { Err(broken(path)(format!("it has point {index} where {next} is due"))) }
}

fn other_columns(path: &Path, wanted: Option<&Wanted>) -> Failure {
    broken(path)(match wanted {
        Some(wanted) => format!("its columns are not those of {}", wanted.sweep.display()),
        None => "its columns are not those of the others".into(),
    })
}

fn broken<E: ToString>(path: &Path) -> impl Fn(E) -> Failure {
    move |problem| Failure::Shards { path: path.into(), problem: problem.to_string() }
}
