//! `rocking ida`: each record at each level of a measure; a table with a row per run, and what follows from it.
//!
//! The table grows as that of a sweep does (`table/growing.rs`): a study that was interrupted continues with the first missing row.

use crate::arguments;
use crate::commands::fragility::Conclusions;
use crate::commands::plot::write;
use crate::error::{Failure, at};
use crate::files::beside;
use crate::output;
use crate::plot::{self, Figure, Paper};
use crate::progress::working;
use crate::table::by_product::ByProduct;
use crate::table::column::{Column, FAILURE, OUTCOME, Rows, fits, has_result, text};
use crate::table::digest::TableDigest;
use crate::table::making::Making;
use crate::table::runs;
use crate::table::tally::likely_in_words;
use crate::table::{Format, check_replaced, open};
use crate::terminal::{json, print, warn, warn_of_some};
use crate::text::{printable, shown};
use csv::StringRecord;
use rocking::Fate;
use rocking::intensity::Intensity;
use rocking::studies::{
    DEFAULT_STATES, FRACTILES, Fit, FragilityOptions, Ida, IdaField, IdaFile, Layout, LimitState, Stripe, stripes,
};
use rocking::sweep::Field;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Runs a study, or the missing runs of an interrupted one.
pub fn ida(request: &arguments::Ida) -> Result<(), Failure> {
    let out = &request.out;
    let format = Format::of_output(out)?;
    let IdaFile { ida, states, options, inputs, .. } = &IdaFile::from_file(&request.file).map_err(Failure::scene)?;
    let stripes_file = ByProduct::Stripes.of(out);
    let by_products = [ByProduct::Stripes, ByProduct::Curves, ByProduct::Shares].map(|kind| (kind, kind.of(out)));
    let pictures = request.plot.as_ref().map(|picture| [picture.clone(), beside(picture, "fragility")]);
    let derived = by_products.iter().map(|(_, file)| file);
    let outputs: Vec<PathBuf> = [out].into_iter().chain(derived).chain(pictures.iter().flatten()).cloned().collect();
    output::check(&outputs, inputs)?;
    let target = output::target(out)?;
    check_replaced(&target)?;
    by_products.iter().try_for_each(|(kind, file)| kind.check_replaced(file))?;
    let threads = request.threads.pool()?;
    if !request.quiet {
        warn_of_some(&ida.warnings());
    }
    let (columns, fields) = (columns(ida), ida.fields());
    let making = Making {
        out,
        target: &target,
        format,
        columns: &columns,
        points: 0..ida.len(),
        threads: &threads,
        shows_progress: !request.quiet && !request.json,
        inputs,
    };
    let is_row = |row: &StringRecord, index: usize| is_row(ida, &columns, row, index);
    let table = making.make(digest(inputs)?, is_row, || {
        let (mut run, fields) = (ida.worker(), &fields);
        move |index| {
            let run = run(index);
            fields.iter().map(|field| text(field.cell(ida, &run))).collect()
        }
    })?;
    // What follows is made of the table, so that it is the same whether or not the study was interrupted.
    let runs = runs::read(out, None, &[])?.runs;
    let stripes = stripes(&runs);
    output::csv(&stripes_file, |table| write_stripes(table, ida, &stripes))?;
    let measure = ida.intensity().to_string();
    let conclude = || threads.install(|| Conclusions::of(&runs, &measure, states, options));
    let conclusions = if request.quiet { conclude() } else { working("fragility curves and their bands", conclude) };
    let mut report = tally(ida, &stripes) + &likely_in_words(table.counting.tally.likely);
    report.push_str(&conclusions.text());
    let _ = writeln!(report, "wrote {} row(s){} to {}", table.counting.rows, table.already_there(), shown(out));
    let _ = writeln!(report, "wrote {}", shown(&stripes_file));
    report.push_str(&conclusions.write(out)?);
    if let Some([picture, curves]) = &pictures {
        let (label, paper) = (ida.intensity().label(), Paper::default());
        let pictures = [
            (plot::ida(&label, &runs, &stripes, &paper), picture.as_path()),
            (plot::fragility(&label, &conclusions.fragilities, &paper), curves.as_path()),
        ];
        report.push_str(&write_figures(&pictures)?);
    }
    if request.json {
        json(&Summary {
            measure,
            likely: table.counting.tally.likely,
            stripes: stripes.iter().map(Line::of).collect(),
            fragility: &conclusions.fragilities,
        })?;
    } else if !request.quiet {
        print(&report)?;
    }
    table.counting.failure(out, false).map_or(Ok(()), Err)
}

/// Draws the curves of a finished table into `picture`, and its fragility into a file beside `picture`. Limit states and bands are those of the table of
/// fragility curves beside the table, if there is one; otherwise the usual ones.
/// Returns the names of both files, with captions. `None` for a table that cannot be read or is not of a study.
pub fn draw(table: &Path, picture: &Path, paper: &Paper) -> Result<Option<String>, Failure> {
    // A table that cannot be read is left to `spectrum::draw`, which reports the failure.
    let Ok(Rows { header, .. }) = open(table) else { return Ok(None) };
    let has = |name: &str| header.iter().any(|own| own == name);
    if !has("scale") || !(has("first_uplift") || has("largest_gap")) {
        return Ok(None);
    }
    if !has("peak_1") {
        return Err(Failure::Study(table.into(), "it has no columns peak_1, ..., which its figure shows".into()));
    }
    let read = runs::read(table, None, &[])?;
    warn(&read.warnings);
    let label = read.measure.parse().map_or(read.measure.clone(), |intensity: Intensity| intensity.label());
    let (states, mut options) = asked(table)?.unwrap_or_else(|| (DEFAULT_STATES.to_vec(), FragilityOptions::default()));
    options.differ_beside_level = read.differ_beside_level;
    let conclusions = Conclusions::of(&read.runs, &read.measure, &states, &options);
    let pictures = [
        (plot::ida(&label, &read.runs, &stripes(&read.runs), paper), picture),
        (plot::fragility(&label, &conclusions.fragilities, paper), &beside(picture, "fragility")),
    ];
    Ok(Some(write_figures(&pictures)?))
}

/// Limit states and options of the table of fragility curves beside a table of runs; `None` if there is none.
fn asked(table: &Path) -> Result<Option<(Vec<LimitState>, FragilityOptions)>, Failure> {
    let curves = ByProduct::Curves.of(table);
    if !curves.exists() {
        return Ok(None);
    }
    let refused = |problem: String| Failure::Curves(curves.clone(), problem);
    let Rows { header, rows } = open(&curves).map_err(at(Failure::Curves, &curves))?;
    let place = |name: &str| header.iter().position(|own| own == name);
    let needed = |name: &str| place(name).ok_or_else(|| refused(format!("there is no column `{name}`")));
    let [state, fit, confidence, replicates] =
        [needed("state")?, needed("fit")?, needed("confidence")?, needed("replicates")?];
    // Tables of earlier versions have neither.
    let [seed, layout] = [place("seed"), place("layout")];
    let (mut states, mut options) = (Vec::new(), FragilityOptions::default());
    let (mut has_curves, mut has_bands) = (false, false);
    for (number, row) in rows.enumerate() {
        let row = row.map_err(at(Failure::Curves, &curves))?;
        let wrong = |name: &str, cell: &str| refused(format!("row {}: `{}` is no {name}", number + 1, printable(cell)));
        let cell = |place: usize| row.get(place).unwrap_or_default();
        let own = cell(state).parse().map_err(|_| wrong("limit state", cell(state)))?;
        if states.contains(&own) {
            return Err(refused(format!("row {}: limit state `{own}` is there twice", number + 1)));
        }
        states.push(own);
        if !Fit::NAMES.contains(&cell(fit)) {
            return Err(wrong("fit", cell(fit)));
        }
        if let Some(name) = layout.map(cell) {
            options.layout = Some(Layout::parse(name).ok_or_else(|| wrong("layout", name))?);
        }
        has_curves |= cell(fit) == "lognormal";
        if cell(replicates).is_empty() {
            continue;
        }
        has_bands = true;
        options.replicates = cell(replicates).parse().map_err(|_| wrong("number of replicates", cell(replicates)))?;
        options.confidence = cell(confidence).parse().map_err(|_| wrong("confidence", cell(confidence)))?;
        if let Some(text) = seed.map(cell) {
            options.seed = text.parse().map_err(|_| wrong("seed", text))?;
        }
        options.check().map_err(|error| refused(format!("row {}: {}", number + 1, error.problem)))?;
    }
    if has_curves && !has_bands {
        options.replicates = 0;
    }
    if states.is_empty() { Err(refused("there are no rows".into())) } else { Ok(Some((states, options))) }
}

/// Writes figures into files; returns the names of the files, with captions.
fn write_figures(pictures: &[(Figure, &Path)]) -> Result<String, Failure> {
    let mut report = String::new();
    for (figure, path) in pictures {
        write(figure, path)?;
        let _ = writeln!(report, "wrote {}: {}", shown(path), figure.caption);
    }
    Ok(report)
}

/// The digest of all that decides the rows.
fn digest(inputs: &[PathBuf]) -> Result<TableDigest, Failure> {
    let mut digest = TableDigest::new();
    for input in inputs {
        digest.add(&rocking::ground::read_file(input).map_err(at(Failure::Input, input))?);
    }
    Ok(digest)
}

/// The columns of the table of a study.
fn columns(ida: &Ida) -> Vec<Column> {
    let column = |field: IdaField| {
        let is_full = matches!(
            field,
            IdaField::Index | IdaField::Record | IdaField::Scale | IdaField::Level | IdaField::Result(Field::Outcome)
        );
        let make = if is_full { Column::full } else { Column::sparse };
        make(ida.heading(field), field.kind().into())
    };
    ida.fields().into_iter().map(column).collect()
}

/// The cells that say which run of a study it is: its number, record, scale and level.
fn point(ida: &Ida, index: usize) -> Vec<String> {
    let point = ida.point(index);
    let name = printable(&ida.records()[point.record].name).into_owned();
    vec![index.to_string(), name, format!("{:?}", point.scale), format!("{:?}", point.level)]
}

/// Whether a row may be that of a run of a study.
fn is_row(ida: &Ida, columns: &[Column], row: &StringRecord, index: usize) -> bool {
    let cell =
        |name: &str| columns.iter().zip(row).find(|(column, _)| column.name == name).map_or("", |(_, cell)| cell);
    let is_due = point(ida, index).iter().zip(row).all(|(due, cell)| due == cell);
    is_due && fits(columns, row) && has_result(cell(OUTCOME), cell(FAILURE))
}

/// Writes the table of stripes: counts of outcomes, and fractiles of the largest |θ|/α, `inf` where the column is lost.
fn write_stripes(table: &mut csv::Writer<Vec<u8>>, ida: &Ida, stripes: &[Stripe]) -> Result<(), csv::Error> {
    let fates = Fate::ALL.map(|fate| fate.name().replace('-', "_"));
    let fractiles = FRACTILES.map(|share| format!("peak_{:.0}", 100.0 * share));
    let header = [ida.intensity().to_string(), "runs".into()].into_iter().chain(fates);
    table.write_record(header.chain(["errors".into()]).chain(fractiles))?;
    stripes.iter().try_for_each(|stripe| {
        let row = [format!("{:?}", stripe.level), stripe.runs.to_string()].into_iter();
        let counts = stripe.fates.iter().chain([&stripe.errors]).map(|count| count.to_string());
        let fractiles = match stripe.fractiles {
            Some(values) => values.map(|value| format!("{value:?}")),
            None => FRACTILES.map(|_| String::new()),
        };
        table.write_record(row.chain(counts).chain(fractiles))
    })
}

/// Number of runs, by outcome.
fn tally(ida: &Ida, stripes: &[Stripe]) -> String {
    let (records, levels) = (ida.records().len(), ida.levels().len());
    let mut text = format!("{records} record(s) at {levels} level(s) of {}: ", ida.intensity().label());
    let total = |place: usize| stripes.iter().map(|stripe| stripe.fates[place]).sum::<usize>();
    let always = [Fate::NoUplift, Fate::Rocks, Fate::Overturns];
    let fates = Fate::ALL.iter().enumerate().map(|(place, fate)| (fate, total(place)));
    let report = fates.clone().filter(|(fate, count)| *count > 0 || always.contains(*fate));
    let report: Vec<String> =
        report.map(|(fate, count)| format!("{} {count}", fate.name().replace('-', " "))).collect();
    let errors: usize = stripes.iter().map(|stripe| stripe.errors).sum();
    let _ = writeln!(text, "{}, errors {errors}", report.join(", "));
    let is_open = |(fate, count): (&Fate, usize)| *fate == Fate::NotDetermined && count > 0;
    if fates.clone().any(is_open) {
        let at_the_end =
            "the column may be falling, or slides on, where the run ends (a longer free_swing settles that)";
        let by_companions = "companions end otherwise (the book, trust; with trust = false such runs \
                             count as they end), or ";
        let _ = writeln!(text, "not determined: {}{at_the_end}", if ida.is_followed() { by_companions } else { "" });
    }
    text
}

/// A study as JSON.
#[derive(Serialize)]
struct Summary<'a> {
    measure: String,
    /// Runs whose verdict is likely, which are counted with their own outcome.
    likely: usize,
    stripes: Vec<Line>,
    fragility: &'a [rocking::studies::Fragility],
}

/// A stripe as JSON; a fractile of lost columns is `infinite`.
#[derive(Serialize)]
struct Line {
    level: f64,
    runs: usize,
    outcomes: std::collections::BTreeMap<&'static str, usize>,
    errors: usize,
    undecided: usize,
    peak_fractiles: Option<[f64; 3]>,
}

impl Line {
    fn of(stripe: &Stripe) -> Line {
        Line {
            level: stripe.level,
            runs: stripe.runs,
            outcomes: Fate::ALL.iter().map(|fate| fate.name()).zip(stripe.fates).collect(),
            errors: stripe.errors,
            undecided: stripe.undecided(),
            peak_fractiles: stripe.fractiles,
        }
    }
}
