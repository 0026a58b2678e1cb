//! `rocking merge`: one table of the tables of all shards of a sweep.
//!
//! A table does not say how many points the sweep has. Missing points at the end are therefore noticed only if the sweep is given as
//! well. Shards of different sweeps differ in their columns, or in the digests beside the tables.

use crate::commands::sweep::{by_products, columns, digest, inputs_of, is_row};
use crate::commands::{fractiles, probability};
use crate::error::{Failure, at};
use crate::files::{folder_of, put_in_place, temporary};
use crate::output;
use crate::table::by_product::{self, ByProduct};
use crate::table::column::{Column, FAILURE, OUTCOME, Rows, has_result};
use crate::table::digest::{digest_file, is_digest};
#[cfg(feature = "parquet")]
use crate::table::parquet;
use crate::table::tally::Counting;
use crate::table::{Format, check_replaced, open};
use crate::terminal::print;
use crate::text::shown;
use csv::StringRecord;
use rocking::ground::read_file;
use rocking::sweep::Sweep;
use std::fs::File;
#[cfg(feature = "parquet")]
use std::io::{BufWriter, Write};
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Joins tables in the order of their points. With the sweep's file, it also checks that all points are there.
pub fn merge(out: &Path, shards: &[PathBuf], sweep: Option<&Path>) -> Result<(), Failure> {
    let format = Format::of_output(out)?;
    let expected = sweep.map(ExpectedSweep::of).transpose()?;
    let mut inputs: Vec<PathBuf> = shards.iter().flat_map(|shard| [shard.clone(), digest_file(shard)]).collect();
    inputs.extend(expected.iter().flat_map(|expected| inputs_of(expected.file, &expected.sweep)));
    let by_products = expected.as_ref().map_or(Vec::new(), |expected| by_products(&expected.sweep));
    let outputs: Vec<PathBuf> = [out.into()].into_iter().chain(by_products.iter().map(|kind| kind.of(out))).collect();
    output::check(&outputs, &inputs)?;
    by_products.iter().try_for_each(|kind| kind.check_replaced(&kind.of(out)))?;
    let mut tables = Vec::new();
    for path in shards {
        if Format::of(path)? != format {
            let problem = format!("{} is to be of the other format, and tables are not converted", shown(out));
            return Err(Failure::Shards(path.clone(), problem));
        }
        tables.push((first(path)?, path.as_path()));
    }
    // Tables without a row, of a sweep with fewer points than shards, come first.
    tables.sort();
    let tables: Vec<&Path> = tables.into_iter().map(|(_, path)| path).collect();

    let failed = |error: std::io::Error| Failure::File(out.into(), error.to_string());
    let target = output::target(out)?;
    check_replaced(&target)?;
    let merged = temporary(folder_of(&target)).map_err(failed)?;
    let counting = match format {
        Format::Csv => join_csv(&tables, expected.as_ref(), merged.as_file(), failed)?,
        #[cfg(feature = "parquet")]
        Format::Parquet => join_parquet(&tables, expected.as_ref(), merged.as_file(), failed)?,
    };
    let first = shards.iter().find(|path| digest_file(path).is_file()).unwrap_or(&shards[0]);
    for path in shards {
        check_digest(path, first, expected.as_ref())?;
    }
    let report = match &expected {
        Some(expected) => format!("all points of {}", shown(expected.file)),
        None => "--sweep FILE would tell whether points after them are missing".into(),
    };
    // A table of errors takes the place of no other table.
    if let Some(failure) = counting.failure(out, true).filter(|_| target.exists()) {
        return Err(failure);
    }
    put_in_place(merged, &target).map_err(failed)?;
    by_product::remove(out, &inputs)?;
    let Counting { tally, rows, .. } = &counting;
    let mut report = format!("{tally}wrote {rows} row(s) of {} table(s) to {}: {report}\n", tables.len(), shown(out));
    if let Some(ExpectedSweep { sweep, .. }) = &expected {
        report.push_str(&probability::write(sweep, &probability::of(sweep, out)?, out)?);
        if by_products.contains(&ByProduct::Fractiles) {
            report.push_str(&fractiles::write(sweep, out)?);
        }
    }
    print(&report)?;
    counting.failure(out, false).map_or(Ok(()), Err)
}

/// The sweep that the tables must make up.
struct ExpectedSweep<'a> {
    file: &'a Path,
    sweep: Sweep,
    columns: Vec<Column>,
}

impl ExpectedSweep<'_> {
    fn of(file: &Path) -> Result<ExpectedSweep<'_>, Failure> {
        let sweep = Sweep::from_file(file).map_err(Failure::scene)?;
        Ok(ExpectedSweep { file, columns: columns(&sweep)?, sweep })
    }
}

/// Refuses a table whose digest is not that of the sweep, or, if no sweep is given, of the first table that has one.
/// A table passes if it has no digest, or if there is none to compare it with.
fn check_digest(path: &Path, first: &Path, expected: Option<&ExpectedSweep>) -> Result<(), Failure> {
    let of_table = |table: &Path| -> Result<Option<String>, Failure> {
        let file = digest_file(table);
        if !file.exists() {
            return Ok(None);
        }
        let text = read_file(&file).map_err(at(Failure::Input, &file))?;
        let text = String::from_utf8(text).ok().filter(|text| is_digest(text));
        let problem = "it is no digest of a sweep; run this shard again".to_string();
        text.map(Some).ok_or(Failure::Input(file, problem))
    };
    let Some(own) = of_table(path)? else { return Ok(()) };
    let (expected, other) = match expected {
        Some(expected) => (Some(digest(&expected.sweep, expected.file)?.to_string()), expected.file),
        None => (of_table(first)?, first),
    };
    match expected {
        Some(expected) if expected != own => {
            let problem = format!("its sweep, base scene or records are not those of {}", shown(other));
            Err(Failure::Shards(path.into(), problem))
        }
        _ => Ok(()),
    }
}

/// The number of the first point of a table; `None` for a table without rows.
fn first(path: &Path) -> Result<Option<u64>, Failure> {
    let row = open(path).map_err(broken(path))?.rows.next().transpose().map_err(broken(path))?;
    row.map(|row| index(&row, path)).transpose()
}

/// Passes the rows of tables to `write`, in order, and counts them. The tables must have the same columns. Each row must have an outcome
/// or an error. Points must count up from zero without gap or repetition. If `expected` is given, the rows must be all rows of that sweep.
fn join(
    tables: &[&Path],
    expected: Option<&ExpectedSweep>,
    mut write: impl FnMut(&StringRecord) -> Result<(), Failure>,
) -> Result<Counting, Failure> {
    let mut header = expected.map(|expected| expected.columns.iter().map(|column| column.name.as_str()).collect());
    let mut counting: Option<Counting> = None;
    for path in tables {
        let Rows { header: found, rows } = open(path).map_err(broken(path))?;
        if *header.get_or_insert_with(|| found.clone()) != found {
            return Err(other_columns(path, expected));
        }
        let column = |name: &str| found.iter().position(|own| own == name);
        let outcome = column(OUTCOME).ok_or_else(|| broken(path)(format!("it has no column `{OUTCOME}`")))?;
        let failure = column(FAILURE);
        let counting = counting.get_or_insert_with(|| Counting::of_columns(&found));
        for row in rows {
            let row = row.map_err(broken(path))?;
            let has_result = has_result(&row[outcome], failure.map_or("", |failure| &row[failure]));
            check_row(&row, (counting.rows, has_result), expected, path)?;
            write(&row)?;
            counting.add(&row);
        }
    }
    let counting = counting.unwrap_or_default();
    match expected {
        Some(ExpectedSweep { sweep, file, .. }) if sweep.len() != counting.rows => {
            Err(Failure::ShardsMissing(file.into(), sweep.len(), counting.rows))
        }
        _ => Ok(counting),
    }
}

/// Refuses a row that is not that of the point `next`, has no result, or is not a row of the sweep expected.
fn check_row(
    row: &StringRecord,
    (next, has_result): (usize, bool),
    expected: Option<&ExpectedSweep>,
    path: &Path,
) -> Result<(), Failure> {
    let point = index(row, path)?;
    let problem = if point != next as u64 {
        format!("it has point {point} where {next} is due{}", missing(point, next as u64))
    } else if !has_result {
        format!("the row of point {point} is not whole")
    } else if let Some(expected) = expected.filter(|expected| !is_row(&expected.sweep, &expected.columns, row, next)) {
        format!("the row of point {point} is not one of {}", shown(expected.file))
    } else {
        return Ok(());
    };
    Err(broken(path)(problem))
}

/// The points that are missing before `point`, where `next` is due, in words with the reason; nothing if the point has come before.
fn missing(point: u64, next: u64) -> String {
    let missing = match point.checked_sub(next) {
        Some(1) => format!("point {next} is missing"),
        Some(_) => format!("points {next} to {} are missing", point - 1),
        None => return String::new(),
    };
    format!("; {missing}: a table before it is not given, or not whole")
}

/// Writes the rows of tables below their header.
fn join_csv(
    tables: &[&Path],
    expected: Option<&ExpectedSweep>,
    out: &File,
    failed: impl Fn(std::io::Error) -> Failure,
) -> Result<Counting, Failure> {
    for path in tables {
        match last_byte(path).map_err(broken(path))? {
            Some(b'\n') => {}
            Some(_) => return Err(broken(path)("its last line is cut: it is not whole, or no table")),
            None => return Err(broken(path)("it is empty: run this shard again")),
        }
    }
    let mut writer = csv::Writer::from_writer(out);
    let mut write = |row: &StringRecord| writer.write_record(row).map_err(|error| failed(error.into()));
    write(&open(tables[0]).map_err(broken(tables[0]))?.header)?;
    let counting = join(tables, expected, write)?;
    writer.flush().map_err(&failed)?;
    Ok(counting)
}

/// The last byte of a file; `None` of an empty one.
fn last_byte(path: &Path) -> std::io::Result<Option<u8>> {
    let mut file = File::open(path)?;
    if file.metadata()?.len() == 0 {
        return Ok(None);
    }
    let mut last = [0];
    file.seek(SeekFrom::End(-1))?;
    file.read_exact(&mut last)?;
    Ok(Some(last[0]))
}

/// [`join_csv`] for Parquet; the rows of all tables are cut into groups anew.
#[cfg(feature = "parquet")]
fn join_parquet(
    tables: &[&Path],
    expected: Option<&ExpectedSweep>,
    out: &File,
    failed: impl Fn(std::io::Error) -> Failure,
) -> Result<Counting, Failure> {
    let columns = |path: &Path| parquet::columns(path).map_err(broken(path));
    let own = expected.map_or_else(|| columns(tables[0]), |expected| Ok(expected.columns.clone()))?;
    for path in tables {
        if columns(path)? != own {
            return Err(other_columns(path, expected));
        }
    }
    let mut writer = parquet::Writer::new(BufWriter::new(out), &own).map_err(&failed)?;
    let counting = join(tables, expected, |row| writer.push(row).map_err(&failed))?;
    writer.finish().and_then(|mut file| file.flush()).map_err(&failed)?;
    Ok(counting)
}

/// The number of the point of a row.
fn index(row: &StringRecord, path: &Path) -> Result<u64, Failure> {
    let index = row.get(0).and_then(|index| index.parse().ok());
    let text = || row.iter().collect::<Vec<_>>().join(",");
    index.ok_or_else(|| broken(path)(format!("the row `{}` does not begin with the number of its point", text())))
}

fn other_columns(path: &Path, expected: Option<&ExpectedSweep>) -> Failure {
    broken(path)(match expected {
        Some(expected) => format!("its columns are not those of {}", shown(expected.file)),
        None => "its columns are not those of the others".into(),
    })
}

fn broken<E: ToString>(path: &Path) -> impl Fn(E) -> Failure {
    at(Failure::Shards, path)
}
