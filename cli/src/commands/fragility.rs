//! `rocking fragility`: curves of limit states from the table of a study.

use crate::arguments;
use crate::commands::plot::write;
use crate::error::Failure;
use crate::files::beside;
use crate::progress::working;
use crate::table::Format;
use crate::table::by_product::ByProduct;
use crate::table::runs::{self, Runs};
use crate::terminal::{json, print, warn};
use crate::text::shown;
use crate::{output, plot};
use rocking::intensity::Intensity;
use rocking::run_folder::Digest;
use rocking::studies::{DEFAULT_STATES, Fit, Fragility, FragilityOptions, LimitState, Observation};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Fits, prints, writes and draws.
pub fn fragility(request: &arguments::Fragility) -> Result<(), Failure> {
    let Runs { measure, runs, warnings, differ_beside_level, peaks, has_slides } =
        runs::read(&request.table, request.measure.as_deref(), &request.conditions)?;
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
    (options.layout, options.differ_beside_level) = (request.layout, differ_beside_level);
    options.check().map_err(Failure::Bands)?;
    let rows: Vec<String> = request.conditions.iter().map(|(name, value)| format!("{name}={value}")).collect();
    let out = request.out.clone().unwrap_or_else(|| curves_of(&request.table, &rows));
    if Format::of_output(&out)? != Format::Csv {
        return Err(Failure::OnlyCsv(out));
    }
    let shares = shares_beside(&out);
    let outputs = [out.clone(), shares.clone()].into_iter().chain(request.plot.clone());
    output::check(&outputs.collect::<Vec<_>>(), std::slice::from_ref(&request.table))?;
    ByProduct::Curves.check_replaced(&out)?;
    ByProduct::Shares.check_replaced(&shares)?;
    let threads = request.threads.pool()?;
    let conclude = || threads.install(|| Conclusions::of(&runs, &measure, &states, &options));
    let mut conclusions = if request.quiet { conclude() } else { working("curves and their bands", conclude) };
    conclusions.rows = rows;
    let mut report = conclusions.text();
    report.push_str(&conclusions.write_to(&out)?);
    if let Some(picture) = &request.plot {
        let label = measure.parse().map_or(measure.clone(), |intensity: Intensity| intensity.label());
        let figure = plot::fragility(&label, &conclusions.fragilities, &plot::Paper::default());
        write(&figure, picture)?;
        let _ = writeln!(report, "wrote {}: {}", shown(picture), figure.caption);
    }
    if request.quiet {
        return Ok(());
    }
    warn(&warnings);
    if request.json { json(&conclusions) } else { print(&report) }
}

/// What a table lacks for a limit state, with the remedy: it has `peaks` columns of peaks, and perhaps columns of slides.
fn lacking(state: &LimitState, peaks: usize, has_slides: bool) -> Option<String> {
    match state {
        LimitState::Peak { .. } if peaks == 0 => {
            Some("needs the columns peak_1, ...: run the sweep with ask = \"peaks\", or give --state overturned".into())
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

/// Path of the fragility curves beside a table, of all rows or of those for which conditions hold. Curves of some rows do not take the place of those of
/// others: `TABLE-where-size.alpha=0.2-fragility.csv`. Where a condition has characters that do not stand in every file name, its digest tells it from others.
fn curves_of(table: &Path, conditions: &[String]) -> PathBuf {
    let in_name = |sign: char| if sign.is_alphanumeric() || "=._-".contains(sign) { sign } else { '_' };
    let named = |condition: &String| {
        let name: String = condition.chars().map(in_name).collect();
        if name == *condition {
            format!("where-{name}-")
        } else {
            format!("where-{name}-{}-", &Digest::of(condition.as_bytes()).to_string()[..8])
        }
    };
    let kind: String = conditions.iter().map(named).chain(["fragility".to_string()]).collect();
    beside(&table.with_extension("csv"), &kind)
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
        self.write_to(&ByProduct::Curves.of(table))
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

    /// Writes the table of shares: the share of runs that reached each state at each level, with counts, fitted probability and band; a row per state and
    /// level.
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
    /// Blank where it is not known.
    resurrections: Option<usize>,
    statement: String,
}

impl Curve<'_> {
    fn of<'a>(fragility: &Fragility, conclusions: &'a Conclusions) -> Curve<'a> {
        let curve = match fragility.fit {
            Fit::Lognormal { median, dispersion, log_likelihood } => Some([median, dispersion, log_likelihood]),
            _ => None,
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
            fit: fragility.fit.name(),
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
            resurrections: (!fragility.differ_beside_level).then_some(fragility.resurrections.len()),
            statement: fragility.statements().join("; "),
        }
    }
}
