//! `rocking fragility`: curves of limit states from the table of a study.

use crate::arguments;
use crate::commands::plot::write;
use crate::commands::spectrum::beside;
use crate::commands::sweep::{OUTCOME, TRUNCATED, TRUST};
use crate::error::{Failure, at};
use crate::table::{Format, INDEX, numbered, open};
use crate::terminal::{json, print, warn};
use crate::text::shown;
use crate::{output, plot};
use csv::StringRecord;
use rocking::Fate;
use rocking::intensity::Intensity;
use rocking::studies::{self, Cells, DEFAULT_STATES, Fit, Fragility, FragilityOptions, LimitState, Observation};
use rocking::sweep::kind_of_result;
use serde::Serialize;
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Fits, prints, writes and draws.
pub fn fragility(request: &arguments::Fragility) -> Result<(), Failure> {
    let Runs { measure, runs, warnings, peaks, has_slides, .. } =
        read(&request.table, request.measure.as_deref(), &request.conditions)?;
    let refused = |problem: String| Failure::Study(request.table.clone(), problem);
    let states = match &request.state[..] {
        [] => DEFAULT_STATES.to_vec(),
        given => {
            let once = given.iter().enumerate().filter(|(place, state)| !given[..*place].contains(state));
            once.map(|(_, state)| *state).collect()
        }
    };
    if let Some((state, lacks)) = states.iter().find_map(|state| Some((state, lacking(state, peaks, has_slides)?))) {
        return Err(refused(format!("the state `{state}` {lacks}")));
    }
    let mut options = FragilityOptions::default();
    (options.replicates, options.confidence, options.seed) =
        (request.replicates as usize, request.confidence, request.seed);
    options.layout = request.layout;
    options.check().map_err(Failure::Bands)?;
    // Curves of some of the rows do not take the place of those of all.
    let kind = if request.conditions.is_empty() { "fragility" } else { "where-fragility" };
    let out = request.out.clone().unwrap_or_else(|| beside(&request.table.with_extension("csv"), kind));
    if Format::of_output(&out)? != Format::Csv {
        return Err(Failure::OnlyCsv(out));
    }
    let outputs = [out.clone(), shares_beside(&out)].into_iter().chain(request.plot.clone());
    output::check(&outputs.collect::<Vec<_>>(), std::slice::from_ref(&request.table))?;
    let mut conclusions = Conclusions::of(&runs, &measure, &states, &options);
    conclusions.rows = request.conditions.iter().map(|(name, value)| format!("{name}={value}")).collect();
    let mut report = conclusions.text();
    report.push_str(&conclusions.write_to(&out)?);
    if let Some(picture) = &request.plot {
        let label = measure.parse().map_or(measure.clone(), |intensity: Intensity| intensity.label());
        let figure = plot::fragility(&label, &conclusions.fragilities, &plot::Paper::default());
        write(&figure, picture)?;
        let _ = writeln!(report, "wrote {}: {}", shown(picture), figure.caption);
    }
    warn(&warnings);
    if request.json { json(&conclusions) } else { print(&report) }
}

/// What a table lacks for a limit state, with the remedy: it has `peaks` columns of peaks, and perhaps columns of slides.
fn lacking(state: &LimitState, peaks: usize, has_slides: bool) -> Option<String> {
    match state {
        LimitState::Peak { .. } if peaks == 0 => {
            Some("needs the columns peak_1, ...: run the sweep with ask = \"peaks\"".into())
        }
        LimitState::Peak { block: Some(block), .. } if *block > peaks => {
            Some(format!("needs the column peak_{block}, and the columns of the table have {peaks} block(s)"))
        }
        LimitState::Slide { .. } if !has_slides => Some(
            "needs the columns residual_slide_1, ...: run the sweep of a scene with friction with ask = \"slides\""
                .into(),
        ),
        _ => None,
    }
}

/// Runs of a table.
pub struct Runs {
    /// Name of the measure: the heading of its column, or the last part of that heading if only this part is a measure.
    pub measure: String,
    pub runs: Vec<Observation>,
    /// Warnings: columns that are neither the record nor the measure, and whose values differ; runs that were cut; runs that are missing.
    pub warnings: Vec<String>,
    /// Number of the columns of peaks, one for each block.
    peaks: usize,
    has_slides: bool,
}

/// Reads the table of a study, or of a sweep over records and a measure: the rows that have each value in its column.
pub fn read(table: &Path, measure: Option<&str>, conditions: &[(String, String)]) -> Result<Runs, Failure> {
    let refused = |problem: String| Failure::Study(table.into(), problem);
    Format::of(table)?;
    let found = open(table).map_err(at(Failure::Study, table))?;
    let columns = Columns::of(found.header.iter().map(String::from).collect(), measure).map_err(refused)?;
    let conditions = columns.conditions(conditions).map_err(refused)?;
    let mut pooling = Pooling::new(&columns);
    let (mut runs, mut numbers) = (Vec::new(), Vec::new());
    for (number, row) in found.rows.enumerate() {
        let row = row.map_err(at(Failure::Study, table))?;
        numbers.extend(columns.index(&row));
        if conditions.iter().all(|(place, value)| is_value(&row[*place], value)) {
            let run = pooling.add(&row, number).and_then(|()| columns.observation(&row, number));
            runs.push(run.map_err(|problem| refused(format!("row {}{problem}", number + 1)))?);
        }
    }
    if runs.is_empty() {
        let problem = match &conditions[..] {
            [] => "it has no row; give the table of a finished study",
            _ => "no row has these values; see its columns for those that there are",
        };
        return Err(refused(problem.into()));
    }
    let name = &columns.names[columns.level];
    let measure = if is_measure(name) || measure.is_some() { name.clone() } else { last_part(name) };
    let mut warnings = pooling.warnings();
    warnings.extend(missing(numbers));
    let (peaks, has_slides) = (columns.peaks.len(), !columns.slides.is_empty());
    Ok(Runs { measure, runs, warnings, peaks, has_slides })
}

/// The warning that numbers of runs, in any order and perhaps of several studies, have gaps; `None` if they have none.
fn missing(mut numbers: Vec<usize>) -> Option<String> {
    numbers.sort_unstable();
    numbers.dedup();
    let (place, next) = numbers.iter().enumerate().find(|(place, number)| place != *number)?;
    let several = numbers[numbers.len() - 1] + 1 - numbers.len();
    let first = if next - place == 1 {
        format!("run {place} is missing")
    } else {
        format!("runs {place} to {} are missing", next - 1)
    };
    Some(if several > next - place { format!("{first}, and {} more", several - (next - place)) } else { first })
}

/// What is gathered of all rows that are read, beside their runs.
struct Pooling<'c> {
    columns: &'c Columns,
    /// For each column that is neither the record nor the measure: the records that have each of its values.
    values: Vec<BTreeMap<String, BTreeSet<String>>>,
    records: BTreeSet<String>,
    /// The number and the row of the first run with these settings.
    seen: HashMap<String, (String, usize)>,
    /// Number of runs with the settings of another one, and another number.
    repeated: usize,
    /// Number of runs that stand and have no peak of the last block.
    short: usize,
    /// Number of runs that end before their ground motion, or while the column may be falling.
    cut: usize,
}

impl Pooling<'_> {
    fn new(columns: &Columns) -> Pooling<'_> {
        Pooling {
            columns,
            values: vec![BTreeMap::new(); columns.others.len()],
            records: BTreeSet::new(),
            seen: HashMap::new(),
            repeated: 0,
            short: 0,
            cut: 0,
        }
    }

    /// Adds a row, counted from zero. The error says, after the number of the row, that its run has been added before.
    fn add(&mut self, row: &StringRecord, number: usize) -> Result<(), String> {
        let columns = self.columns;
        // Studies with other records may be pooled: their runs have the same numbers.
        let is_number = |place: &&usize| columns.index == Some(**place);
        let settings = columns.settings.iter().filter(|place| !is_number(place)).map(|place| &row[*place]);
        let index = columns.index.map(|index| &row[index]);
        match self.seen.entry(settings.collect::<Vec<_>>().join(",")) {
            Entry::Vacant(free) => {
                free.insert((index.unwrap_or_default().into(), number));
            }
            Entry::Occupied(first) if index == Some(&first.get().0) => {
                return Err(format!(": the run stands in row {} as well; give each run once", first.get().1 + 1));
            }
            Entry::Occupied(_) => self.repeated += 1,
        }
        let is_standing = Fate::parse(&row[columns.outcome]).is_some_and(|fate| fate.is_decided() && !fate.is_lost());
        let has_last = columns.peaks.last().is_none_or(|place| !row[*place].is_empty());
        self.short += usize::from(is_standing && !has_last);
        let record = columns.record_of(row, number);
        for (values, place) in self.values.iter_mut().zip(&columns.others) {
            values.entry(row[*place].to_string()).or_default().insert(record.clone());
        }
        self.records.insert(record);
        self.cut += usize::from(columns.truncated.is_some_and(|truncated| &row[truncated] == "true"));
        Ok(())
    }

    /// Columns that are neither the record nor the measure, and whose values differ; runs that were cut.
    fn warnings(&self) -> Vec<String> {
        let columns = self.columns;
        // A value of its own for each record is a property of the record, such as its PGA.
        let is_of_record = |values: &BTreeMap<String, BTreeSet<String>>| {
            let is_of_one = |records: &BTreeSet<String>| records.len() == 1;
            !columns.records.is_empty() && values.len() == self.records.len() && values.values().all(is_of_one)
        };
        // Nor is a value of its own for each run an axis.
        let is_of_run = |values: &BTreeMap<String, BTreeSet<String>>| values.len() == self.seen.len() + self.repeated;
        let is_axis = |values: &BTreeMap<String, BTreeSet<String>>| {
            values.len() > 1 && !is_of_record(values) && !is_of_run(values)
        };
        let several = columns.others.iter().zip(&self.values).filter(|(_, values)| is_axis(values));
        let pooled = several.map(|(place, values)| {
            let (name, count) = (&columns.names[*place], values.len());
            format!(
                "the rows of all {count} values of `{name}` make one curve; --where {name}=VALUE keeps those of one"
            )
        });
        let cut = (self.cut > 0).then(|| {
            format!(
                "{} run(s) end before their ground motion, while the column may be falling, or sliding (`{TRUNCATED}`), and count as standing; a later `solver.t_end` settles them",
                self.cut
            )
        });
        let repeated = (self.repeated > 0).then(|| {
            format!(
                "{} run(s) have all settings of a run above; if they are the same runs, give each once",
                self.repeated
            )
        });
        let has_other_columns = columns.others.iter().any(|place| last_part(&columns.names[*place]) == "blocks");
        let short = (self.short > 0 && !has_other_columns).then(|| {
            format!(
                "{} run(s) that stand have no `peak_{}`: this block counts as below every limit there",
                self.short,
                columns.peaks.len()
            )
        });
        pooled.chain(cut).chain(repeated).chain(short).collect()
    }
}

/// Settings that are no axes.
const NO_AXES: [&str; 2] = [INDEX, "scale"];

/// Whether a cell has a value: the same text, or the same number.
fn is_value(cell: &str, value: &str) -> bool {
    let number = |text: &str| text.parse::<f64>().ok();
    cell == value || number(cell).is_some_and(|cell| number(value) == Some(cell))
}

/// The columns of a table of runs, by their places.
struct Columns {
    /// Header of the table.
    names: Vec<String>,
    /// The number of a run, in a table that numbers its runs.
    index: Option<usize>,
    /// What says which run a row is of: all columns but those of results, wherever they stand.
    settings: Vec<usize>,
    /// Columns whose cells name the record of a run.
    records: Vec<usize>,
    /// The column with the level of the measure.
    level: usize,
    /// Settings that are neither the record nor the measure: other axes of a sweep.
    others: Vec<usize>,
    outcome: usize,
    /// The block with which a column was lost.
    block: Option<usize>,
    uplift: Option<usize>,
    trust: Option<usize>,
    truncated: Option<usize>,
    /// One for each block.
    peaks: Vec<usize>,
    /// One for each interface.
    slides: Vec<usize>,
}

impl Columns {
    /// The number of a run, in a table that numbers its runs.
    fn index(&self, row: &StringRecord) -> Option<usize> {
        row[self.index?].parse().ok()
    }

    /// The columns with these names; without a measure, the level is the one column that has the name of a measure. The error says what is wrong
    /// with the table.
    fn of(names: Vec<String>, measure: Option<&str>) -> Result<Columns, String> {
        if names.is_empty() {
            return Err("it is empty; give the table of a finished study".into());
        }
        let level = level(&names, measure)?;
        let column = |name: &str| names.iter().position(|own| own == name);
        let outcome = column(OUTCOME)
            .ok_or_else(|| format!("it has no column `{OUTCOME}`; give a table of `rocking ida` or `rocking sweep`"))?;
        let records = studies::record_columns(&names);
        let settings: Vec<usize> = (0..names.len())
            .filter(|place| kind_of_result(&names[*place]).is_none() && !names[*place].is_empty())
            .collect();
        let is_other =
            |place: &usize| *place != level && !records.contains(place) && !NO_AXES.contains(&names[*place].as_str());
        Ok(Columns {
            others: settings.iter().copied().filter(is_other).collect(),
            index: column(INDEX),
            settings,
            records,
            level,
            outcome,
            block: column("block"),
            uplift: column("first_uplift"),
            trust: column(TRUST),
            truncated: column(TRUNCATED),
            peaks: numbered(&names, "peak")?,
            slides: numbered(&names, "residual_slide")?,
            names,
        })
    }

    /// Conditions with the places of their columns. The error names a column that is not there.
    fn conditions<'c>(&self, given: &'c [(String, String)]) -> Result<Vec<(usize, &'c str)>, String> {
        let known = || self.names.join(", ");
        let place = |name: &str| {
            let place = self.names.iter().position(|own| own == name);
            place.ok_or_else(|| format!("there is no column `{name}`; it has {}", known()))
        };
        given.iter().map(|(name, value)| Ok((place(name)?, value.as_str()))).collect()
    }

    /// The name of the record of a row.
    fn record_of(&self, row: &StringRecord, number: usize) -> String {
        match &self.records[..] {
            [] if studies::is_of_one_record(&self.names, self.level) => "the record of the scene".into(),
            [] => format!("run {}", number + 1),
            columns => columns.iter().map(|place| &row[*place]).collect::<Vec<_>>().join(", "),
        }
    }

    /// The run of a row, counted from zero. The error says what is wrong with a cell, after the number of the row.
    fn observation(&self, row: &StringRecord, number: usize) -> Result<Observation, String> {
        let wrong = |place: usize, wanted: &str| {
            format!(", column `{}`: `{}` is not {wanted}; correct the cell", self.names[place], &row[place])
        };
        let level: Option<f64> = row[self.level].parse().ok();
        let level = level.filter(|level| level.is_finite() && *level > 0.0);
        // Columns of blocks that this row's column does not have are blank, at the end.
        let numbers = |places: &[usize], least: f64, wanted: &str| -> Result<Vec<f64>, String> {
            let filled = places.iter().rposition(|place| !row[*place].is_empty()).map_or(0, |last| last + 1);
            let number = |place: &usize| {
                let number: Option<f64> = row[*place].parse().ok();
                // A stack that does not stand by itself has infinite peaks.
                number.filter(|number| *number >= least).ok_or_else(|| wrong(*place, wanted))
            };
            places[..filled].iter().map(number).collect()
        };
        let has_uplift = |place: usize| match row[place].parse::<f64>() {
            _ if row[place].is_empty() => Ok(false),
            Ok(time) if time >= 0.0 => Ok(true),
            _ => Err(wrong(place, "a time")),
        };
        let cells = Cells {
            record: self.record_of(row, number),
            level: level.ok_or_else(|| wrong(self.level, "a number above zero"))?,
            outcome: Some(&row[self.outcome]),
            trust: self.trust.map(|trust| &row[trust]),
            has_uplift: self.uplift.map(has_uplift).transpose()?,
            peaks: numbers(&self.peaks, 0.0, "zero or a number above it")?,
            residual_slides: numbers(&self.slides, f64::NEG_INFINITY, "a number")?,
        };
        // The block with which a column was lost is one of it.
        let lost = self.block.and_then(|block| row[block].parse::<usize>().ok()).unwrap_or_default();
        if !self.peaks.is_empty() && lost > self.peaks.len() {
            return Err(format!(
                ": block {lost} was lost, and the table has no column `peak_{lost}`; give all of them"
            ));
        }
        Observation::try_from(cells).map_err(|refused| format!(", {refused}"))
    }
}

/// The column of the level: that of the measure or, without one, the one column that has the name of a measure.
fn level(names: &[String], measure: Option<&str>) -> Result<usize, String> {
    let known = || names.join(", ");
    let is_wanted = |name: &str| match measure {
        Some(measure) => name == measure,
        // The whole heading is tried as well: a measure with a period, such as `sa(0.5)`, contains a point itself.
        None => is_measure(name) || is_measure(&last_part(name)),
    };
    let wanted: Vec<usize> = (0..names.len()).filter(|place| is_wanted(&names[*place])).collect();
    match (&wanted[..], measure) {
        ([level], _) => Ok(*level),
        (_, Some(measure)) => Err(format!("there is no column `{measure}`; it has {}", known())),
        ([], None) => Err(format!("no column has the name of a measure; choose one of {} with --measure", known())),
        (several, None) => {
            // A study has its measure beside the scale of the record; others may be properties of the records.
            let of_study = several.iter().find(|place| **place > 0 && names[**place - 1] == "scale");
            let several: Vec<&str> = several.iter().map(|place| names[*place].as_str()).collect();
            of_study.copied().ok_or_else(|| {
                format!("several columns are measures; choose one of {} with --measure", several.join(", "))
            })
        }
    }
}

/// The last part of the heading of an axis, a dotted key of the scene. It may name a measure.
fn last_part(heading: &str) -> String {
    heading.rsplit('.').next().unwrap_or(heading).to_string()
}

fn is_measure(name: &str) -> bool {
    name.parse::<Intensity>().is_ok()
}

/// Paths of the two tables beside the table of a study: of fragility curves and of shares.
pub fn tables(table: &Path) -> [PathBuf; 2] {
    let curves = beside(&table.with_extension("csv"), "fragility");
    let shares = beside(&table.with_extension("csv"), "shares");
    [curves, shares]
}

/// The table of shares beside one of curves.
fn shares_beside(curves: &Path) -> PathBuf {
    let stem = curves.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    match stem.strip_suffix("fragility") {
        Some(start) => {
            let extension = curves.extension().map_or_else(String::new, |own| format!(".{}", own.to_string_lossy()));
            curves.with_file_name(format!("{start}shares{extension}"))
        }
        None => beside(curves, "shares"),
    }
}

/// Fragilities of several limit states.
#[derive(Serialize)]
pub struct Conclusions {
    measure: String,
    /// Conditions on the rows that were read, as given to `--where`; empty for all rows.
    #[serde(skip_serializing_if = "Vec::is_empty", rename = "where")]
    rows: Vec<String>,
    pub fragilities: Vec<Fragility>,
}

impl Conclusions {
    pub fn of(runs: &[Observation], measure: &str, states: &[LimitState], options: &FragilityOptions) -> Conclusions {
        let fragilities = states.iter().map(|state| Fragility::of(runs, *state, options)).collect();
        Conclusions { measure: measure.into(), rows: Vec::new(), fragilities }
    }

    /// In words: a paragraph per state.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for fragility in &self.fragilities {
            let statements = fragility.statements();
            for (place, statement) in statements.iter().enumerate() {
                let _ = match place {
                    0 => writeln!(text, "{}: {statement}", fragility.state),
                    _ => writeln!(text, "  {statement}"),
                };
            }
        }
        text
    }

    /// Writes the tables of curves and of shares beside the `table` of a study. Returns the text that names both files.
    pub fn write(&self, table: &Path) -> Result<String, Failure> {
        self.write_to(&tables(table)[0])
    }

    fn write_to(&self, curves: &Path) -> Result<String, Failure> {
        let shares = shares_beside(curves);
        output::csv(curves, |table| self.write_curves(table))?;
        output::csv(&shares, |table| self.write_shares(table))?;
        Ok(format!("wrote {}\nwrote {}\n", shown(curves), shown(&shares)))
    }

    /// Writes the table of curves: a row per state.
    fn write_curves(&self, table: &mut csv::Writer<Vec<u8>>) -> Result<(), csv::Error> {
        self.fragilities.iter().try_for_each(|fragility| table.serialize(Curve::of(fragility, self)))
    }

    /// Writes the table of shares: the share of runs that reached each state at each level, with counts, fitted probability and band; a row per state and level.
    fn write_shares(&self, table: &mut csv::Writer<Vec<u8>>) -> Result<(), csv::Error> {
        let measure = self.measure.as_str();
        table.write_record(["state", measure, "runs", "reached", "undecided", "share", "curve", "low", "high"])?;
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:?}"));
        for fragility in &self.fragilities {
            for (place, count) in fragility.counts.iter().enumerate() {
                let band = fragility.bands.as_ref().and_then(|bands| bands.at_counts.get(place));
                table.write_record([
                    fragility.state.to_string(),
                    format!("{:?}", count.level),
                    count.runs.to_string(),
                    count.reached.to_string(),
                    count.undecided.to_string(),
                    number(count.share()),
                    number(fragility.probability(count.level)),
                    number(band.map(|band| band[0])),
                    number(band.map(|band| band[1])),
                ])?;
            }
        }
        Ok(())
    }
}

/// A row of the table of curves.
#[derive(Serialize)]
struct Curve<'a> {
    state: String,
    measure: &'a str,
    /// Conditions on the rows that were read; blank for all rows.
    r#where: String,
    fit: &'static str,
    median: Option<f64>,
    median_low: Option<f64>,
    median_high: Option<f64>,
    dispersion: Option<f64>,
    dispersion_low: Option<f64>,
    dispersion_high: Option<f64>,
    confidence: Option<f64>,
    replicates: Option<usize>,
    replicates_fitted: Option<usize>,
    seed: Option<u64>,
    layout: &'static str,
    chi_squared: Option<f64>,
    degrees_of_freedom: Option<usize>,
    p_value: Option<f64>,
    pseudo_r2: Option<f64>,
    log_likelihood: Option<f64>,
    records: usize,
    runs: usize,
    undecided: usize,
    median_if_none: Option<f64>,
    dispersion_if_none: Option<f64>,
    median_if_all: Option<f64>,
    dispersion_if_all: Option<f64>,
    falls: usize,
    resurrections: usize,
    statement: String,
}

impl Curve<'_> {
    fn of<'a>(fragility: &Fragility, conclusions: &'a Conclusions) -> Curve<'a> {
        let (fit, curve) = match fragility.fit {
            Fit::Lognormal { median, dispersion, log_likelihood } => {
                ("lognormal", Some([median, dispersion, log_likelihood]))
            }
            Fit::NoRuns => ("no-runs", None),
            Fit::OneRecord => ("one-record", None),
            Fit::Never { .. } => ("never", None),
            Fit::Always { .. } => ("always", None),
            Fit::Step { .. } => ("step", None),
            _ => ("falling", None),
        };
        let (bands, goodness) = (fragility.bands.as_ref(), fragility.goodness);
        let [none, all] = [0, 1].map(|end| match fragility.bounds?[end] {
            Fit::Lognormal { median, dispersion, .. } => Some([median, dispersion]),
            _ => None,
        });
        let [median, dispersion] = [bands.and_then(|bands| bands.median), bands.and_then(|bands| bands.dispersion)];
        Curve {
            state: fragility.state.to_string(),
            measure: &conclusions.measure,
            r#where: conclusions.rows.join("; "),
            fit,
            median: curve.map(|curve| curve[0]),
            median_low: median.map(|band| band[0]),
            median_high: median.map(|band| band[1]),
            dispersion: curve.map(|curve| curve[1]),
            dispersion_low: dispersion.map(|band| band[0]),
            dispersion_high: dispersion.map(|band| band[1]),
            confidence: bands.map(|bands| bands.confidence),
            replicates: bands.map(|bands| bands.replicates),
            replicates_fitted: bands.map(|bands| bands.fitted),
            seed: bands.map(|bands| bands.seed),
            layout: fragility.layout.name(),
            chi_squared: goodness.map(|goodness| goodness.chi_squared),
            degrees_of_freedom: goodness.map(|goodness| goodness.degrees_of_freedom),
            p_value: goodness.and_then(|goodness| goodness.p_value),
            pseudo_r2: goodness.map(|goodness| goodness.pseudo_r2),
            log_likelihood: curve.map(|curve| curve[2]),
            records: fragility.records,
            runs: fragility.counts.iter().map(|count| count.runs).sum(),
            undecided: fragility.undecided(),
            median_if_none: none.map(|[median, _]| median),
            dispersion_if_none: none.map(|[_, dispersion]| dispersion),
            median_if_all: all.map(|[median, _]| median),
            dispersion_if_all: all.map(|[_, dispersion]| dispersion),
            falls: fragility.falls.len(),
            resurrections: fragility.resurrections.len(),
            statement: fragility.statements().join("; "),
        }
    }
}
