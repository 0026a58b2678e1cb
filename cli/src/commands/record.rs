//! `rocking record FILE`: description and measures of a record file. The record is trimmed, scaled, written and drawn if asked for.

use crate::arguments::{self, Target};
use crate::commands::inputs;
use crate::commands::plot::write;
use crate::error::{Failure, with_dashes};
use crate::number::significant;
use crate::terminal::{json, print, warn};
use crate::text::{printable, shown};
use crate::{output, plot};
use rocking::ground::{Measure, Measures, RecordFile, TextOptions};
use rocking::intensity::{DEFAULT_DAMPING, Intensity};
use rocking::{Column, DEFAULT_GRAVITY, Record, RecordError};
use serde::{Serialize, Serializer};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Significant digits of what is measured.
pub const DIGITS: usize = 5;

/// Describes a record file.
pub fn record(arguments: &arguments::Record, window: Option<Window>) -> Result<(), Failure> {
    // `--trim` may take the file's name as its second word; `Window::of` gives it back. Here no file is named at all.
    let Some(path) = arguments.file.clone() else {
        return Err(Failure::Trim(arguments.trim.join(" "), "no record file is named".into()));
    };
    let is_csv = |out: &&PathBuf| out.extension().is_none_or(|own| own.eq_ignore_ascii_case("csv"));
    if let Some(out) = arguments.out.as_ref().filter(|out| !is_csv(out)) {
        return Err(Failure::RecordIsCsv(out.clone()));
    }
    let column = arguments.scene.as_deref().map(inputs::scene).transpose()?.map(|scene| scene.column);
    let options = options(arguments, column.as_ref());
    let gravity = options.gravity;
    let file = read(&path, &options).map_err(|problem| problem.at(&path))?;
    let mut description = Description::of(&path, &file, gravity);
    let record = file.into_record().map_err(|error| Failure::Record(path.clone(), error))?;
    let record = record.named(path.display().to_string());
    let record = trimmed(record, window, arguments, description.duration)?;
    let is_of_target = |target: &Target| matches!(target.intensity.measure, Measure::Sa { .. });
    let has_spectral = !arguments.sa.is_empty() || arguments.scale_to.as_ref().is_some_and(is_of_target);
    if arguments.damping.is_some() && !has_spectral {
        return Err(Failure::Damping);
    }
    let damping = arguments.damping.unwrap_or(DEFAULT_DAMPING);
    let record = scaled(record, arguments, column.as_ref(), damping, &path)?;
    description.measure(&record);
    description.measure_by(&record, &arguments.sa, damping, column.as_ref());
    let outputs: Vec<PathBuf> = arguments.out.iter().chain(&arguments.plot).cloned().collect();
    let inputs: Vec<PathBuf> = std::iter::once(&path).chain(&arguments.scene).cloned().collect();
    output::check(&outputs, &inputs)?;
    if let Some(out) = &arguments.out {
        output::check_replaced(out, |first| first.starts_with(RECORD_HEADING))?;
        output::file(out, record.to_csv())?;
    }
    if let Some(picture) = &arguments.plot {
        let title = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let figure = plot::record(&title, &record, gravity, &plot::Paper::default());
        write(&figure, picture)?;
    }
    warn(&description.warnings);
    if arguments.json {
        return json(&description);
    }
    let mut text = format!("{}{}\n", description.text(), plot::terminal::series(record.accel()));
    if let Some(out) = &arguments.out {
        let _ = writeln!(text, "wrote {} ({} samples, m/s2)", shown(out), description.samples);
    }
    if let Some(picture) = &arguments.plot {
        let _ = writeln!(text, "wrote {}", shown(picture));
    }
    print(&text)
}

/// The part of a record in a window, if there is one; the file has `duration` seconds.
fn trimmed(
    record: Record,
    window: Option<Window>,
    arguments: &arguments::Record,
    duration: f64,
) -> Result<Record, Failure> {
    let Some(Window { from, to }) = window else { return Ok(record) };
    let outside = |error| Failure::Trim(arguments.trim.join(" "), format!("{error} ({duration} s are in the file)"));
    record.trimmed(from, to).map_err(outside)
}

/// A record scaled as the options say: by a factor, to a PGA, to an intensity. Spectral accelerations that name no damping ratio take `damping`.
fn scaled(
    mut record: Record,
    arguments: &arguments::Record,
    column: Option<&Column>,
    damping: f64,
    path: &Path,
) -> Result<Record, Failure> {
    let refused = |error: RecordError| Failure::Record(path.into(), error);
    let gravity = column.map_or(DEFAULT_GRAVITY, Column::gravity);
    if let Some(factor) = arguments.scale {
        record = record.scaled(factor).map_err(refused)?;
    }
    if let Some(peak) = arguments.pga_g {
        record = record.scaled_to_peak(peak * gravity).map_err(refused)?;
    }
    let Some(Target { mut intensity, names_damping, size }) = arguments.scale_to else { return Ok(record) };
    if let Measure::Sa { damping: own, .. } = &mut intensity.measure
        && !names_damping
    {
        *own = damping;
    }
    let unit = match column {
        Some(column) => intensity.unit_size(column).ok_or_else(|| Failure::NoUplift(intensity.to_string()))?,
        None => intensity.unit_size_without_column(gravity).ok_or_else(|| Failure::NoColumn(intensity.to_string()))?,
    };
    record.scaled_to(intensity.measure, size * unit, gravity).map_err(refused)
}

/// How a record that this command has written begins.
const RECORD_HEADING: &str = "t [s]";

/// The span that `--trim` keeps, from the first sample on `[s]`; `to` may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    from: f64,
    to: f64,
}

impl Window {
    /// The window of `--trim`. If `--trim` has two words and no file is named, the first word is the window, and the second becomes `file`.
    pub fn of(arguments: &mut arguments::Record) -> Result<Option<Window>, Failure> {
        if arguments.file.is_none() && arguments.trim.len() == 2 {
            arguments.file = arguments.trim.pop().map(PathBuf::from);
        }
        let given = arguments.trim.join(" ");
        if given.is_empty() {
            return Ok(None);
        }
        let wrong = |problem: &str| Failure::Trim(given.clone(), problem.into());
        if given.matches(',').count() == 1 && given.chars().all(|c| c.is_ascii_digit() || c == ',') {
            return Err(wrong("that may be a number with a decimal comma"));
        }
        let (from, to) = ["..", ",", ":", " "]
            .into_iter()
            .find_map(|delimiter| given.split_once(delimiter))
            .ok_or_else(|| wrong("one time is no window"))?;
        let time = |text: &str, open: f64| match text.trim() {
            "" => Ok(open),
            text => text.parse().ok().filter(|time: &f64| time.is_finite()).ok_or_else(|| wrong("that is no time")),
        };
        let window = Window { from: time(from, 0.0)?, to: time(to.trim_start_matches(['.', '=']), f64::INFINITY)? };
        if window.from >= window.to {
            return Err(wrong(if window.from == window.to { "it is empty" } else { "it ends before it begins" }));
        }
        Ok(Some(window))
    }
}

/// How a record file is read; one g is the gravity of the scene, whose column this is, or [`DEFAULT_GRAVITY`] without a scene.
pub fn options(arguments: &arguments::Record, column: Option<&Column>) -> TextOptions {
    TextOptions {
        gravity: column.map_or(DEFAULT_GRAVITY, Column::gravity),
        dt: arguments.dt,
        units: arguments.units,
        lenient: arguments.lenient,
        channel: arguments.channel,
        skip_rows: arguments.skip_rows,
        column: arguments.column.clone(),
    }
}

/// Why a file is not read.
pub enum Problem {
    System(std::io::Error),
    Content(RecordError),
}

impl Problem {
    pub fn at(self, path: &Path) -> Failure {
        match self {
            Problem::System(error) => Failure::Input(path.into(), error.to_string()),
            Problem::Content(error) => Failure::Record(path.into(), error),
        }
    }
}

pub fn read(path: &Path, options: &TextOptions) -> Result<RecordFile, Problem> {
    let bytes = rocking::ground::read_file(path).map_err(Problem::System)?;
    RecordFile::read(&bytes, options).map_err(Problem::Content)
}

/// The description of a record, as text or JSON.
#[derive(Debug, Serialize)]
pub struct Description {
    #[serde(serialize_with = "text_of")]
    pub file: PathBuf,
    pub format: rocking::ground::Format,
    pub title: String,
    pub station: String,
    pub component: String,
    pub channels: Vec<String>,
    /// Unit of the accelerations in the file.
    pub unit: rocking::ground::AccelerationUnit,
    /// Samples that the header declares.
    pub declared: Option<usize>,
    /// Peak that the header states `[m/s²]`.
    pub stated_peak: Option<f64>,
    /// Sampling interval `[s]`.
    pub dt: f64,
    pub samples: usize,
    /// Time from the first sample to the last `[s]`; in JSON it stands among the measures.
    #[serde(skip)]
    pub duration: f64,
    /// Factor of the samples by `--scale`, `--pga-g` or `--scale-to`, dimensionless.
    pub scale: f64,
    /// One g `[m/s²]`.
    pub gravity: f64,
    /// Peak acceleration `[g]`.
    pub pga_g: f64,
    #[serde(flatten)]
    pub measures: Option<Measures>,
    /// Spectral accelerations that were asked for.
    pub spectral: Vec<Spectral>,
    /// Size for the column of `--scene`; `None` without a scene.
    #[serde(flatten)]
    pub of_column: Option<OfColumn>,
    /// Whether the displacement is largest at the end.
    pub drifts: bool,
    pub warnings: Vec<String>,
}

/// A path as text. JSON is UTF-8: other names have replacement signs.
fn text_of<S: Serializer>(path: &Path, to: S) -> Result<S::Ok, S::Error> {
    to.collect_str(&path.display())
}

/// A spectral acceleration.
#[derive(Debug, Serialize)]
pub struct Spectral {
    /// `[s]`
    pub period: f64,
    /// Damping ratio, dimensionless.
    pub damping: f64,
    /// Pseudo-spectral acceleration `[m/s²]`.
    pub sa: f64,
}

/// The size of a record for a column.
#[derive(Debug, Serialize)]
pub struct OfColumn {
    /// `PGA / (g tan α)`, dimensionless.
    pub pga_uplift: f64,
    /// `p PGV / (g tan α)`, dimensionless.
    pub pgv_uplift: f64,
}

impl Description {
    /// The description of a file that was read with this gravity `[m/s²]`.
    pub fn of(path: &Path, file: &RecordFile, gravity: f64) -> Description {
        Description {
            file: path.into(),
            format: file.format,
            title: file.title.clone(),
            station: file.station.clone(),
            component: file.component.clone(),
            channels: file.channels.clone(),
            unit: file.unit,
            declared: file.declared,
            stated_peak: file.stated_peak,
            dt: file.dt,
            samples: file.accel.len(),
            duration: file.accel.len().saturating_sub(1) as f64 * file.dt,
            scale: 1.0,
            gravity,
            pga_g: 0.0,
            measures: None,
            spectral: Vec::new(),
            of_column: None,
            drifts: false,
            warnings: file.warnings.iter().map(|warning| with_dashes(warning)).collect(),
        }
    }

    /// Takes samples and measures from the record as it is after trimming and scaling.
    pub fn measure(&mut self, record: &Record) {
        let measures = record.measures(self.gravity);
        self.samples = record.accel().len();
        self.duration = record.duration();
        self.scale = record.scale();
        self.pga_g = measures.pga / self.gravity;
        self.drifts = measures.drifts();
        self.measures = Some(measures);
    }

    /// Takes spectral accelerations at `periods [s]`, and the sizes for a column.
    pub fn measure_by(&mut self, record: &Record, periods: &[f64], damping: f64, column: Option<&Column>) {
        let spectral =
            |period: &f64| Spectral { period: *period, damping, sa: record.spectral_acceleration(*period, damping) };
        self.spectral = periods.iter().map(spectral).collect();
        let size = |name: &str, column: &Column| {
            let intensity = Intensity::named(name, None)?;
            Some(record.measure(intensity.measure, column.gravity()) / intensity.unit_size(column)?)
        };
        self.of_column = column.and_then(|column| {
            Some(OfColumn { pga_uplift: size("pga_uplift", column)?, pgv_uplift: size("pgv_uplift", column)? })
        });
    }

    /// Sizes for the line of a list, each with two blanks before.
    pub fn sizes(&self) -> String {
        let mut text = String::new();
        if let Some(measures) = &self.measures {
            let _ = write!(text, "  PGV {} m/s", significant(measures.pgv, 4));
        }
        for Spectral { period, sa, .. } in &self.spectral {
            let _ = write!(text, "  Sa({} s) {} g", significant(*period, 4), significant(sa / self.gravity, 4));
        }
        if let Some(OfColumn { pga_uplift, pgv_uplift }) = self.of_column {
            let sizes = [pga_uplift, pgv_uplift].map(|size| significant(size, 4));
            let _ = write!(text, "  PGA/(g tan α) {}  p PGV/(g tan α) {}", sizes[0], sizes[1]);
        }
        text
    }

    fn text(&self) -> String {
        let mut text = format!("{}\n", shown(&self.file));
        let mut line = |name: &str, value: String| {
            let _ = writeln!(text, "  {name:<22}{value}");
        };
        let known = |value: &str| if value.is_empty() { "-".to_string() } else { printable(value).into_owned() };
        line("format", self.format.to_string());
        line("event", known(&self.title));
        line("station", known(&self.station));
        line("component", known(&self.component));
        if self.channels.len() > 1 {
            line("channels", self.channels.join(", "));
        }
        line("unit", self.unit.to_string());
        line("dt", format!("{} s", significant(self.dt, DIGITS)));
        line("samples", self.samples.to_string());
        line("duration", format!("{} s", significant(self.duration, DIGITS)));
        if self.scale != 1.0 {
            line("scaled by", significant(self.scale, DIGITS));
        }
        let Some(measures) = &self.measures else { return text };
        let pga = format!(
            "{} g = {} m/s2, at {} s",
            significant(self.pga_g, DIGITS),
            significant(measures.pga, DIGITS),
            significant(measures.pga_time, DIGITS)
        );
        line("PGA", pga);
        line("PGV", format!("{} m/s", significant(measures.pgv, DIGITS)));
        let drift = if self.drifts {
            ", at the end: the record drifts, or is cut while the ground moves; correct its baseline to speak of displacements"
        } else {
            ""
        };
        line("PGD", format!("{} m{drift}", significant(measures.pgd, DIGITS)));
        line("Arias intensity", format!("{} m/s", significant(measures.arias, DIGITS)));
        let [duration, from, to] =
            [measures.significant_duration, measures.significant_start, measures.significant_end]
                .map(|time| significant(time, DIGITS));
        line("significant duration", format!("{duration} s (5-95 %), from {from} s to {to} s"));
        line("", format!("{} s (5-75 %)", significant(measures.significant_duration_75, DIGITS)));
        line("CAV", format!("{} m/s", significant(measures.cav, DIGITS)));
        let mean_period =
            measures.mean_period.map_or("-".to_string(), |period| format!("{} s", significant(period, DIGITS)));
        line("mean period", mean_period);
        for Spectral { period, damping, sa } in &self.spectral {
            let [in_g, sa] = [sa / self.gravity, *sa].map(|value| significant(value, DIGITS));
            let name = format!("Sa({} s, {} %)", significant(*period, DIGITS), significant(100.0 * damping, DIGITS));
            line(&name, format!("{in_g} g = {sa} m/s2"));
        }
        if let Some(OfColumn { pga_uplift, pgv_uplift }) = self.of_column {
            line("PGA/(g tan α)", significant(pga_uplift, DIGITS));
            line("p PGV/(g tan α)", significant(pgv_uplift, DIGITS));
        }
        text
    }
}
