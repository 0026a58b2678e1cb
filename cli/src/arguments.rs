//! Arguments of the command line.

use crate::keys::Kind;
pub use crate::plot::Picture;
use crate::plot::WIDTHS_MM;
use crate::threads::Threads;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use rocking::ground::AccelerationUnit;
use rocking::intensity::{Intensity, NAMES, UnknownIntensity};
use rocking::studies::{Layout, LimitState, MOST_REPLICATES};
use std::ops::Range;
use std::path::PathBuf;

/// Simulates rocking multi-block columns on equations of motion generated at build time.
#[derive(Debug, Parser)]
#[command(name = "rocking", version, after_help = FIRST_STEPS)]
pub struct Arguments {
    /// Command to carry out.
    #[command(subcommand)]
    pub command: Command,
}

/// First steps for a new user, and what a build may lack, printed after the help.
const FIRST_STEPS: &str = "To begin: `rocking init` writes scene.toml; put in your column and ground motion, then\n\
    `rocking check scene.toml` and `rocking run scene.toml --report`.\n\
    Figures in PDF and tables in Parquet need a build with `--features pdf,parquet`.";

/// A command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a commented scene to begin with.
    Init {
        /// The file.
        #[arg(default_value = "scene.toml")]
        file: PathBuf,
        /// Number of equal blocks.
        #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..=100))]
        blocks: u8,
        /// Excite the column with this record instead of a pulse.
        #[arg(long, value_name = "FILE")]
        record: Option<PathBuf>,
        /// Write over a file of this name.
        #[arg(long)]
        force: bool,
    },
    /// Validate a scene and explain it: sizes, slenderness, thresholds, ground motion; or a sweep: its axes and points; or a study: its records and levels.
    Check {
        /// Scene, sweep or study file (TOML); `-` reads a scene from standard input.
        scene: PathBuf,
        /// Print JSON instead of text.
        #[arg(long)]
        json: bool,
    },
    /// Run a scene and write summary.json, response.csv and events.json.
    ///
    /// Figures (time-history, phase-portrait, slides, energy and forces, .svg, .png and .pdf) and report.html of an earlier run in the folder are removed
    /// when the new results are written: they would show another run. Numbers in JSON that are not finite are the words "infinite", "-infinite" and "not a
    /// number". Regular files are read up to a size: scenes, sweeps and their records up to 64 MiB, files of a run up to 1 GiB.
    Run(Run),
    /// Draw the figures of a run: time-history, phase-portrait, energy, forces, and slides where blocks slide; of the table of a sweep its spectrum, of a
    /// study its curves.
    Plot {
        /// Folder of a finished run, or the table of a sweep or a study (CSV or Parquet), whose figures have its name.
        #[arg(value_name = "DIR|TABLE")]
        folder: PathBuf,
        /// How the figures are written: svg, to be scaled at will; png, in pixels; pdf, to be printed, in builds with `--features pdf`.
        #[arg(long, value_name = "FORMAT", value_parser = picture, default_value = "svg")]
        format: Picture,
        /// Folder for the figures; made if it is not there [default: DIR, or the folder of the table].
        #[arg(long, value_name = "FOLDER")]
        out: Option<PathBuf>,
        /// Angles in degrees: of a run in place of θ/α and rad, of a sweep the slenderness.
        #[arg(long)]
        degrees: bool,
        /// Width on paper in mm; text keeps its 8 pt [default: laid out for 150].
        #[arg(long, value_name = "MM", value_parser = paper_width)]
        width: Option<f64>,
    },
    /// Write one self-contained HTML page of a finished run: outcome, validity, figures and an animation.
    Report {
        /// Folder of the run.
        folder: PathBuf,
        /// File of the page; report.html in the folder unless given.
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// List the independent rocking modes of a column, or draw them.
    Modes {
        /// Number of blocks, 1 to 12.
        #[arg(long, value_parser = clap::value_parser!(u8).range(1..=LARGEST_LISTED))]
        blocks: u8,
        /// Draw the modes into this file (SVG, PNG or PDF by its name) instead of listing them; up to 5 blocks.
        #[arg(long, value_name = "FILE", value_parser = figure)]
        svg: Option<PathBuf>,
        /// Print JSON instead of text.
        #[arg(long, conflicts_with = "svg")]
        json: bool,
        /// List the programs of states that slide and fly instead, by free angles and translations; with --svg, draw the ten states of an
        /// interface.
        #[arg(long)]
        friction: bool,
    },
    /// Print the derivation or the generated code of a mode, or of states that slide and fly.
    Derive {
        /// Number of blocks, 1 to 12.
        #[arg(long, value_parser = clap::value_parser!(u8).range(1..=LARGEST_LISTED))]
        blocks: u8,
        /// Mode K.J: lowest open interface, number among the states of those above. Or the states of all interfaces, base first, like
        /// "(+>,0,f)": closed (0), on the right or left corner (+, -), sliding to the right or left (> or < after it), free (f). `u` after a
        /// corner that slides: the upper face slides on the corner below.
        #[arg(long, value_name = "K.J|STATES")]
        mode: String,
        /// Print operation counts before and after each pass instead.
        #[arg(long, conflicts_with = "format")]
        counts: bool,
        /// What to print.
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
    },
    /// Print at which ground acceleration each interface of a scene's column opens.
    Thresholds {
        /// Scene file (TOML).
        scene: PathBuf,
        /// Print JSON instead of text.
        #[arg(long)]
        json: bool,
    },
    /// Print the description of a record file and its measures, or list the records of a folder.
    ///
    /// PEER AT2, ESM and ITACA (DYNA), K-NET and KiK-net, CSMIP V2, COSMOS V2 and tables of text are recognised by their
    /// content.
    Record(Record),
    /// Run many scenes made from one by axes over its keys; a table with a row each.
    ///
    /// A sweep that was interrupted continues when it is started again. A run ends when its outcome is certain unless the sweep
    /// asks for peaks. The number of impacts of a run that may have ended early is not known: its cell is blank. A sweep without any result exits with 1.
    ///
    /// Of axes that are distributions it prints the probability that the column is lost, and writes TABLE-probability.csv.
    Sweep(Sweep),
    /// Incremental dynamic analysis: each record at each level of an intensity measure; tables, figures and fragility.
    ///
    /// Writes the table of all runs, and beside it TABLE-stripes.csv (counts and fractiles per level), TABLE-fragility.csv (a curve per limit
    /// state) and TABLE-shares.csv (raw shares per state and level). A study that was interrupted continues when it is started again.
    ///
    /// Each run has nine companions with a tighter tolerance or slightly changed ground motion, sizes or friction, and 24 more where these are too few.
    /// A run counts as undecided if its verdict is neither determined nor likely. `trust = false` in the study file turns them off.
    Ida(Ida),
    /// Fragility curves of a table that `rocking ida` has written, or a sweep with `ask = "peaks"` or `"slides"` over records and a measure.
    ///
    /// Writes TABLE-fragility.csv and TABLE-shares.csv beside the table; with `--where size.alpha=0.2`, TABLE-where-size.alpha=0.2-fragility.csv and so on.
    Fragility(Fragility),
    /// Join the tables of all shards of a sweep; exits with 1 where no row has a result.
    ///
    /// `rocking sweep --shard` writes a digest of its sweep, base scene and records beside each table (TABLE.digest); tables whose digests
    /// differ are refused.
    Merge {
        /// The table to write: CSV, or Parquet if its name ends in .parquet.
        out: PathBuf,
        /// The tables of the shards, in any order and of the same format.
        #[arg(required = true)]
        shards: Vec<PathBuf>,
        /// The sweep (TOML). With it the tables are checked for missing points, and probabilities and fractiles are written if the sweep has them.
        #[arg(long, value_name = "FILE")]
        sweep: Option<PathBuf>,
    },
    /// List all keys of scenes, sweeps and studies with types, units and defaults.
    Keys {
        /// Kind of file; all of them if it is left out.
        #[arg(value_enum)]
        file: Option<Kind>,
        /// Print the JSON schema of the kind (of scenes, if none is named) instead of text: for editors and other programs.
        #[arg(long)]
        schema: bool,
    },
    /// Print the completion script of a shell.
    Completions {
        /// The shell.
        shell: Shell,
    },
    /// Print the man page, or write one per command into a folder.
    Man {
        /// Folder for the pages; made if it is not there.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// `rocking run`.
#[derive(Debug, Args)]
pub struct Run {
    /// Scene file (TOML); `-` reads standard input.
    pub scene: PathBuf,
    /// Folder for the results; made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Equations of motion to run on.
    #[arg(long, value_enum, default_value_t = Dynamics::Generated)]
    pub dynamics: Dynamics,
    /// Draw the figures of `rocking plot` into the same folder (SVG).
    #[arg(long)]
    pub plots: bool,
    /// Write report.html as well: one page with outcome, validity, figures and an animation.
    #[arg(long)]
    pub report: bool,
    /// Run the scene alone, without the companions that say how far its verdict can be trusted.
    ///
    /// Companions are the same scene at a tighter tolerance, and with excitation, sizes and friction changed by 1e-9 and 1e-6. They, and the search for the
    /// change of the shaking that changes the verdict, take 7 to 30 times as long as the run on one thread, and up to 73 times where nine are too few;
    /// they run on all. Without them `response.csv` and `events.json` are the same.
    #[arg(long)]
    pub no_trust: bool,
    /// Follow a run by its companions although it took more than five seconds.
    #[arg(long, conflicts_with = "no_trust")]
    pub trust: bool,
    #[command(flatten)]
    pub threads: Threads,
    /// Print nothing but errors.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print the summary as JSON instead of text.
    #[arg(long, conflicts_with = "quiet")]
    pub json: bool,
}

/// `rocking record`: what to print, and units and sampling where the file does not state them.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("spectral").args(["sa", "scale_to"]).multiple(true))]
pub struct Record {
    /// Record file, or a folder of them.
    #[arg(value_name = "FILE", required_unless_present = "trim")]
    pub file: Option<PathBuf>,
    /// Unit of the accelerations where the file is silent: g, mg, m/s2, cm/s2, mm/s2, gal, in/s2, ft/s2.
    #[arg(long, value_parser = unit)]
    pub units: Option<AccelerationUnit>,
    /// Sampling interval in s where the file is silent.
    #[arg(long, value_parser = positive)]
    pub dt: Option<f64>,
    /// Channel of a file that has several, by its number.
    #[arg(long)]
    pub channel: Option<usize>,
    /// Column of a table that holds the accelerations, by its name or its number from 1; `all` where samples fill row after row.
    #[arg(long)]
    pub column: Option<String>,
    /// Leading lines of a table that are skipped.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub skip_rows: usize,
    /// Warn rather than fail where samples are missing, or the header states another peak or contradicts itself.
    #[arg(long)]
    pub lenient: bool,
    /// Multiply the accelerations.
    #[arg(long, value_name = "F", conflicts_with_all = ["pga_g", "scale_to"], value_parser = finite)]
    pub scale: Option<f64>,
    /// Scale to this peak, in g.
    #[arg(long, value_name = "G", value_parser = positive)]
    pub pga_g: Option<f64>,
    /// Scale to a size of any measure: pga, pga_g, pgv, pgd, arias, cav, `sa(PERIOD)`, `sa_g(PERIOD DAMPING)`; pga_uplift and pgv_uplift with --scene.
    #[arg(long, value_name = "MEASURE=SIZE", conflicts_with = "pga_g", value_parser = target)]
    pub scale_to: Option<Target>,
    /// Print the spectral acceleration at this period in s; may be given several times.
    #[arg(long, value_name = "PERIOD", value_parser = positive)]
    pub sa: Vec<f64>,
    /// Damping ratio of the spectral accelerations: of --sa, and of --scale-to where it names none [default: 0.05].
    #[arg(long, value_name = "RATIO", requires = "spectral", value_parser = damping)]
    pub damping: Option<f64>,
    /// Scene whose column measures the record: PGA/(g tan α) and p PGV/(g tan α).
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// Keep what lies between two times, in s from the first sample: `2..8`, `2..`, `..8` or `2 8`.
    #[arg(long, value_names = ["FROM..TO", "TO"], num_args = 1..=2)]
    pub trim: Vec<String>,
    /// Write the record, scaled and trimmed, as a table of time and acceleration (CSV).
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Draw accelerogram, velocity, displacement and the growth of the Arias intensity (SVG, PNG or PDF by the file's name).
    #[arg(long, value_name = "FILE", value_parser = figure)]
    pub plot: Option<PathBuf>,
    /// Print JSON instead of text.
    #[arg(long)]
    pub json: bool,
}

fn finite(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "give a number".to_string())?;
    if value.is_finite() { Ok(value) } else { Err("give a finite number".into()) }
}

/// A finite number for which `holds`, or the remedy.
fn number(text: &str, holds: impl FnOnce(f64) -> bool, remedy: impl Into<String>) -> Result<f64, String> {
    finite(text).and_then(|value| if holds(value) { Ok(value) } else { Err(remedy.into()) })
}

fn damping(text: &str) -> Result<f64, String> {
    number(text, |ratio| (0.0..1.0).contains(&ratio), "give a share of critical damping from 0 to below 1")
}

/// What a record is scaled to.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    pub intensity: Intensity,
    /// Whether the text names the damping ratio of a spectral acceleration.
    pub names_damping: bool,
    /// Size, in the unit of the intensity.
    pub size: f64,
}

fn target(text: &str) -> Result<Target, String> {
    let (name, size) = text.split_once('=').ok_or("write MEASURE=SIZE, e.g. pgv=0.5")?;
    let name = name.trim();
    let intensity = name.parse().map_err(|_: UnknownIntensity| match name.split('(').next() {
        Some(spectral @ ("sa" | "sa_g")) => {
            format!("write {spectral}(PERIOD)=SIZE, e.g. {spectral}(0.5)={}", size.trim())
        }
        _ => format!("there is no measure `{name}`; choose one of {}", NAMES.join(", ")),
    })?;
    let numbers = name.trim_end_matches(')').split_once('(').map_or("", |(_, numbers)| numbers);
    let names_damping = numbers.split_whitespace().count() > 1;
    Ok(Target { intensity, names_damping, size: positive(size.trim())? })
}

fn positive(text: &str) -> Result<f64, String> {
    number(text, |value| value > 0.0, "give a number above zero")
}

fn figure(text: &str) -> Result<PathBuf, String> {
    let file = PathBuf::from(text);
    if Picture::of(&file).is_some() {
        Ok(file)
    } else {
        Err(format!("give a name like figure.svg: its ending is {FORMATS}"))
    }
}

fn picture(text: &str) -> Result<Picture, String> {
    Picture::from_str(text, true).map_err(|_| format!("choose {FORMATS}"))
}

/// Formats of figures, in words.
const FORMATS: &str =
    if cfg!(feature = "pdf") { "svg, png or pdf" } else { "svg or png; PDF needs a build with `--features pdf`" };

fn paper_width(text: &str) -> Result<f64, String> {
    let [least, most] = WIDTHS_MM;
    number(text, |width| (least..=most).contains(&width), format!("give {least} to {most} mm"))
}

fn unit(text: &str) -> Result<AccelerationUnit, String> {
    AccelerationUnit::parse(text).ok_or_else(|| format!("choose {}", AccelerationUnit::NAMES.join(", ")))
}

/// `rocking sweep`.
#[derive(Debug, Args)]
pub struct Sweep {
    /// Sweep file (TOML).
    pub file: PathBuf,
    /// Table of the results: CSV, or Parquet if its name ends in .parquet [default: sweep.csv; NAME-K-of-M.csv of a shard of NAME.toml].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Draw the table (SVG, PNG or PDF by the name).
    ///
    /// With largest angles (`ask = "peaks"`): the largest |θ|/α over `rocking_period`, `p` or `R`, or else over the axis with most values, a curve for each
    /// combination of the others, up to 12; of three records and more their fractiles; with `ask = "slides"` also FILE-slides. Otherwise, over two axes of
    /// numbers, the overturning spectrum, and beside it FILE-minimum: the least value that overturns; the last axis goes upwards, and each combination of
    /// the others is a panel. Over one axis, and over paired axes, a strip of what becomes of the column. `rocking plot TABLE.csv` draws a table that is
    /// there.
    #[arg(long, value_name = "FILE", value_parser = figure)]
    pub plot: Option<PathBuf>,
    /// Run the K-th of M parts only; `rocking merge` joins their tables.
    #[arg(long, value_name = "K/M", value_parser = Shard::parse)]
    pub shard: Option<Shard>,
    #[command(flatten)]
    pub threads: Threads,
    /// Print nothing but errors.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print the counts of outcomes as JSON instead of text.
    #[arg(long, conflicts_with = "quiet")]
    pub json: bool,
}

impl Sweep {
    /// The table of the results.
    pub fn table(&self) -> PathBuf {
        let own = || match self.shard {
            None => "sweep.csv".into(),
            Some(shard) => {
                let mut name = self.file.file_stem().unwrap_or("sweep".as_ref()).to_os_string();
                name.push(format!("-{shard}.csv"));
                name.into()
            }
        };
        self.out.clone().unwrap_or_else(own)
    }
}

/// `rocking ida`.
#[derive(Debug, Args)]
pub struct Ida {
    /// Study file (TOML).
    pub file: PathBuf,
    /// Table of all runs: CSV, or Parquet if its name ends in .parquet.
    #[arg(long, value_name = "FILE", default_value = "ida.csv")]
    pub out: PathBuf,
    /// Draw the curves of all records with their fractiles, and beside it FILE-fragility: the fragility curves (SVG, PNG or PDF by the name).
    #[arg(long, value_name = "FILE", value_parser = figure)]
    pub plot: Option<PathBuf>,
    #[command(flatten)]
    pub threads: Threads,
    /// Print nothing but errors.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print stripes and fragility as JSON instead of text.
    #[arg(long, conflicts_with = "quiet")]
    pub json: bool,
}

/// `rocking fragility`.
#[derive(Debug, Args)]
pub struct Fragility {
    /// Table of runs: CSV or Parquet.
    pub table: PathBuf,
    /// Limit state: `uplift`, `overturned`, `peak > 0.35` (|θ|/α), `peak_2 > 0.35` of the second block, `slide > 0.05` (m); may be given several times
    /// [default: uplift, peak > 0.15, peak > 0.35, overturned].
    #[arg(long = "state", value_name = "STATE", value_parser = state)]
    pub state: Vec<LimitState>,
    /// Column of the intensity measure; the only one with the name of a measure unless given.
    #[arg(long, value_name = "COLUMN")]
    pub measure: Option<String>,
    /// Keep the rows with this value in a column; may be given several times. Rows of all values make one curve unless given.
    #[arg(long = "where", value_name = "COLUMN=VALUE", value_parser = condition)]
    pub conditions: Vec<(String, String)>,
    /// Whether several runs share each level (stripes) or none (cloud); as the table has it unless given.
    #[arg(long, value_name = "LAYOUT", value_parser = PossibleValuesParser::new(Layout::NAMES).try_map(|name| Layout::parse(&name).ok_or("no such layout")))]
    pub layout: Option<Layout>,
    /// Sets of resampled records for the bands; 0 for none.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(0..=MOST_REPLICATES as i64))]
    pub replicates: u32,
    /// Share of the resampled sets within the bands.
    #[arg(long, value_name = "SHARE", default_value_t = 0.9, value_parser = share)]
    pub confidence: f64,
    /// Seed of the resampling.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Table of the curves, beside which the shares are written [default: TABLE-fragility.csv].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Draw the curves (SVG, PNG or PDF by the name).
    #[arg(long, value_name = "FILE", value_parser = figure)]
    pub plot: Option<PathBuf>,
    #[command(flatten)]
    pub threads: Threads,
    /// Print nothing but errors.
    #[arg(long, short)]
    pub quiet: bool,
    /// Print JSON instead of text.
    #[arg(long, conflicts_with = "quiet")]
    pub json: bool,
}

fn condition(text: &str) -> Result<(String, String), String> {
    let (column, value) = text.split_once('=').ok_or("write COLUMN=VALUE, e.g. size.alpha=0.2")?;
    Ok((column.trim().into(), value.trim().into()))
}

fn state(text: &str) -> Result<LimitState, String> {
    text.parse().map_err(|error: rocking::studies::NoLimitState| error.to_string())
}

fn share(text: &str) -> Result<f64, String> {
    number(text, |share| share > 0.0 && share < 1.0, "give a share between 0 and 1")
}

/// A part of a sweep, for one of several machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1.
    number: usize,
    count: usize,
}

impl Shard {
    /// Reads `K/M`.
    pub fn parse(text: &str) -> Result<Shard, String> {
        let numbers = text.split_once('/').and_then(|(k, m)| Some((k.parse().ok()?, m.parse().ok()?)));
        match numbers {
            Some((number, count)) if number >= 1 && number <= count => Ok(Shard { number, count }),
            _ => Err("write K/M, the K-th of M parts, e.g. 2/8".into()),
        }
    }

    /// Points of this part, of `points` in all. The sizes of parts differ by at most one point.
    pub fn points(self, points: usize) -> Range<usize> {
        let edge = |number: usize| (points as u128 * number as u128 / self.count as u128) as usize;
        edge(self.number - 1)..edge(self.number)
    }
}

/// The form in file names: `2-of-8`.
impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}-of-{}", self.number, self.count)
    }
}

/// Largest number of blocks for which modes are listed or derived: the (3^12 - 1)/2 modes of twelve blocks are more than anybody reads.
const LARGEST_LISTED: i64 = 12;

/// Right-hand sides of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Dynamics {
    /// Generated at build time; what the build has not got runs on the generic ones.
    Generated,
    /// Hand-written for any number of blocks.
    Generic,
}

/// How a derivation is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Positions, energies, equations of motion and the step-time program as text.
    Text,
    /// The emitted Rust.
    Rust,
    /// The derivation as a LaTeX document, constants named and couplings in differences of angles.
    Latex,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_cover_all_points_once() {
        for (points, count) in [(10, 3), (7, 7), (3, 5), (1_000_003, 64)] {
            let parts: Vec<Range<usize>> = (1..=count).map(|number| Shard { number, count }.points(points)).collect();
            assert_eq!((parts[0].start, parts[count - 1].end), (0, points));
            assert!(parts.windows(2).all(|pair| pair[0].end == pair[1].start));
            let lengths: Vec<usize> = parts.iter().map(Range::len).collect();
            assert!(lengths.iter().max().zip(lengths.iter().min()).is_some_and(|(most, least)| most - least <= 1));
        }
        assert!(["0/3", "4/3", "1", "a/b", "1/0"].iter().all(|text| Shard::parse(text).is_err()));
    }
}
