//! `[excitation.horizontal]` and `[excitation.vertical]`: pulses by their parameters, records by their files. Records of stations: `stations.rs`.

use super::fault::Fault;
use super::reader::Reader;
use super::table::{Table, Wrong};
use crate::column::Column;
use crate::intensity::{DEFAULT_DAMPING, Intensity, NAMES};
use crate::scene::LARGEST;
use rocking_ground::{AccelerationUnit, Excitation, Measure, Motion, Record, RecordError, Synthetic, TextOptions};
use std::f64::consts::TAU;
use std::io::ErrorKind;
use std::path::Path;

/// Kinds of ground motion, as a scene names them.
const KINDS: [&str; 14] = [
    "sine-pulse",
    "cosine-pulse",
    "half-sine",
    "type-c",
    "ricker",
    "antisymmetric-ricker",
    "mavroeidis-papageorgiou",
    "gabor",
    "rectangular",
    "double-rectangular",
    "harmonic",
    "sum",
    "synthetic",
    "record",
];

/// Units in which amplitudes and frequencies may be given.
#[derive(Clone, Copy)]
struct Scales {
    /// Gravity `[m/s²]`.
    gravity: f64,
    /// The acceleration that opens the base of the column at rest, `g tan α` `[m/s²]`.
    uplift: f64,
    /// Frequency parameter of the column as one body `[rad/s]`.
    p: f64,
}

impl Scales {
    fn of(column: &Column) -> Scales {
        let whole = column.stack(0);
        Scales { gravity: column.gravity(), uplift: whole.uplift_acceleration(), p: whole.frequency_parameter() }
    }
}

/// Largest number of cycles of a type C_n.
const MOST_CYCLES: f64 = 1e6;

/// Keys of amplitudes.
const AMPLITUDES: [&str; 3] = ["amplitude", "amplitude_g", "amplitude_uplift"];

/// Units of [`AMPLITUDES`] `[m/s²]`. `uplift` is the acceleration that opens the base of the column at rest.
fn amplitude_units(gravity: f64, uplift: f64) -> [f64; 3] {
    [1.0, gravity, uplift]
}

/// Sets an amplitude, given by its dotted key, in a ground motion that is proportional to it. `false` if the motion has to be read instead: the key
/// is no amplitude, the motion has none, or the value is out of range.
pub(super) fn set_amplitude(excitation: &mut Excitation, key: &str, value: f64, column: &Column) -> bool {
    let Some((component, name)) = key.strip_prefix("excitation.").and_then(|key| key.split_once('.')) else {
        return false;
    };
    let motion = match component {
        "horizontal" => &mut excitation.horizontal,
        "vertical" => &mut excitation.vertical,
        _ => return false,
    };
    let Some(place) = AMPLITUDES.iter().position(|key| *key == name) else { return false };
    let unit = amplitude_units(column.gravity(), column.uplift_acceleration(0))[place];
    let Some(own) = motion.as_mut().and_then(Motion::amplitude_mut) else { return false };
    *own = value * unit;
    unit > 0.0 && own.abs() <= LARGEST
}

/// Refuses keys whose unit is the acceleration that opens the base of a column that does not stand by itself: there is none.
pub(super) fn check_uplift(table: &Table, column: &Column) -> Result<(), Wrong> {
    let has_unit = column.uplift_acceleration(0) > 0.0;
    match table.keys().into_iter().find(|key| !has_unit && key.ends_with("_uplift")) {
        Some(key) => Err(no_uplift(table, &key)),
        None => Ok(()),
    }
}

/// The error that a size is given in units of what opens the base, and nothing does: the column does not stand by itself.
fn no_uplift(table: &Table, key: &str) -> Wrong {
    let problem = "the column does not stand by itself: no acceleration of the ground opens its base";
    table.wrong(key, problem.into(), "give the size in m/s² or g, or other slides")
}

/// What paths of records are relative to, in errors.
pub(crate) const FILE_THAT_NAMES: &str = "the file that names it";

impl Reader<'_> {
    /// The ground motion of a scene.
    pub(super) fn excitation(&self, root: &mut Table, column: &Column) -> Result<Excitation, Fault> {
        let Some(mut table) = root.table("excitation")? else { return Ok(Excitation::default()) };
        if let Some(mut station) = table.table("station")? {
            if let Some(other) = ["horizontal", "vertical"].into_iter().find(|name| table.has(name)) {
                return Err(table.clash(other, "station").into());
            }
            let excitation = self.station(&mut station, column)?;
            station.close()?;
            table.close()?;
            return Ok(excitation);
        }
        let mut component = |name: &'static str| -> Result<Option<Motion>, Fault> {
            let Some(mut table) = table.table(name)? else { return Ok(None) };
            let motion = self.motion(&mut table, column)?;
            table.close()?;
            Ok(Some(motion))
        };
        let excitation = Excitation { horizontal: component("horizontal")?, vertical: component("vertical")? };
        table.close()?;
        Ok(excitation)
    }

    fn motion(&self, table: &mut Table, column: &Column) -> Result<Motion, Fault> {
        check_uplift(table, column)?;
        let Some(kind) = table.text("kind")? else {
            return Err(table.missing("kind", &format!("choose one of {}", KINDS.join(", "))).into());
        };
        match kind.as_str() {
            "sum" => self.sum(table, column),
            "record" => {
                let start = start(table)?;
                self.record(table, start, column).map(Motion::Record)
            }
            "synthetic" => Ok(Motion::Record(self.synthetic(table, column)?)),
            _ => Ok(pulse(table, &kind, Scales::of(column))?),
        }
    }

    /// `[[excitation.horizontal.term]]`: each term is read as a component is.
    fn sum(&self, table: &mut Table, column: &Column) -> Result<Motion, Fault> {
        let mut tables = table.tables("term")?.unwrap_or_default();
        if tables.is_empty() {
            // A table in a list has a number in its key, and none in its heading.
            let key = table.dotted("term");
            let heading: String =
                key.split('[').map(|part| part.split_once(']').map_or(part, |(_, rest)| rest)).collect();
            let remedy = format!("add [[{heading}]] for each motion of the sum");
            return Err(table.missing("term", &remedy).into());
        }
        let mut term = |table: &mut Table| -> Result<Motion, Fault> {
            let motion = self.motion(table, column)?;
            table.close()?;
            Ok(motion)
        };
        Ok(Motion::Sum { terms: tables.iter_mut().map(&mut term).collect::<Result<_, _>>()? })
    }

    fn record(&self, table: &mut Table, start: f64, column: &Column) -> Result<Record, Fault> {
        let gravity = column.gravity();
        let options = text_options(table, gravity)?;
        let (units, dt) = (options.units, options.dt);
        let accel = table.numbers("accel")?;
        let of_files = ["lenient", "channel", "skip_rows", "column"].into_iter().find(|key| table.has(key));
        if let Some(key) = of_files.filter(|_| accel.is_some()) {
            return Err(table
                .wrong(key, "`accel` is given, not a file".into(), "remove it, or give `file` instead")
                .into());
        }
        let (record, key) = match (table.text("file")?, accel) {
            (Some(name), None) => (self.record_file(table, "file", &name, &options)?, "file"),
            (None, Some(accel)) => {
                let Some(dt) = dt else { return Err(table.missing("dt", "give the sampling interval in s").into()) };
                let unit = units.unwrap_or(AccelerationUnit::MetrePerSecondSquared);
                let refused = |error: RecordError| match error {
                    RecordError::Interval { .. } => table.wrong(
                        "dt",
                        format!("{dt:e} s is out of range"),
                        "give an interval above 1e-9 s, up to 1e6",
                    ),
                    error => table.wrong("accel", error.to_string(), "correct the samples"),
                };
                (Record::from_samples(&accel, unit, dt, gravity).map_err(refused)?, "accel")
            }
            (Some(_), Some(_)) => {
                return Err(table.clash("accel", "file").into());
            }
            (None, None) => return Err(table.missing("file", "name a record file, or give `accel` and `dt`").into()),
        };
        let target = target(table, column)?;
        let record = match (table.number("scale")?, target) {
            (Some(_), Some(target)) => {
                return Err(table.clash(target.key, "scale").into());
            }
            (Some(factor), None) => record
                .scaled(factor)
                .map_err(|error| table.wrong("scale", error.to_string(), "give a smaller factor"))?,
            (None, Some(target)) => record
                .scaled_to(target.measure, target.size, column.gravity())
                .map_err(|error| table.wrong(key, error.to_string(), "use another record or another size"))?,
            (None, None) => record,
        };
        Ok(record.starting_at(start))
    }

    /// A record of filtered noise, scaled to a size that the scene must give.
    fn synthetic(&self, table: &mut Table, column: &Column) -> Result<Record, Wrong> {
        let (start, seed) = (start(table)?, table.whole("seed", 0)?.unwrap_or(0));
        let mut synthetic = Synthetic { seed, ..noise(table)? };
        let Some(target) = target(table, column)? else {
            let remedy = format!("give one of {}", NAMES.map(|name| format!("`{name}`")).join(", "));
            return Err(table.missing("pga", &remedy));
        };
        if target.measure == Measure::Pga {
            synthetic.pga = target.size;
        }
        let made = self.records.map_or_else(|| synthetic.record(), |records| records.synthetic(&synthetic));
        let record = made.map_err(|error| {
            let key = match error {
                RecordError::OutOfRange { name: "pga", .. } => target.key,
                RecordError::OutOfRange { name, .. } => name,
                _ => "kind",
            };
            table.wrong(key, error.to_string(), "correct the number")
        })?;
        let record = match target.measure {
            Measure::Pga => record,
            measure => {
                let scaled = record.scaled_to(measure, target.size, column.gravity());
                scaled.map_err(|error| table.wrong(target.key, error.to_string(), "correct the number"))?
            }
        };
        Ok(record.starting_at(start))
    }

    pub(crate) fn record_file(
        &self,
        table: &Table,
        key: &str,
        name: &str,
        options: &TextOptions,
    ) -> Result<Record, Fault> {
        let path = self.file.parent().unwrap_or(Path::new("")).join(name);
        let kept = || (path.clone(), format!("{options:?}"));
        if let Some(record) = self.records.and_then(|records| records.get(&kept())) {
            return Ok(record.named(name));
        }
        let bytes = rocking_ground::read_file(&path).map_err(|error| Fault::Record {
            place: table.find(key),
            key: table.dotted(key),
            record: path.clone(),
            problem: match Path::new(name).is_absolute() {
                true => error.to_string(),
                false => format!("{error}; its path is relative to {FILE_THAT_NAMES}"),
            },
            is_missing: error.kind() == ErrorKind::NotFound,
        })?;
        let refused = |error: RecordError| Fault::of_record(table, key, path.clone(), error.to_string());
        let record = Record::from_bytes(&bytes, options).map_err(refused)?;
        if let Some(records) = self.records {
            records.keep(kept(), &record);
        }
        Ok(record.named(name))
    }
}

/// Options with which a user has record files read.
pub(crate) fn text_options(table: &mut Table, gravity: f64) -> Result<TextOptions, Wrong> {
    let units = match table.text("units")? {
        None => None,
        Some(name) => Some(
            AccelerationUnit::parse(&name)
                .ok_or_else(|| table.no_such("units", "unit", &name, &AccelerationUnit::NAMES))?,
        ),
    };
    Ok(TextOptions {
        gravity,
        dt: table.positive("dt")?,
        units,
        lenient: table.flag("lenient")?.unwrap_or(false),
        channel: table.whole("channel", 1)?.map(|channel| channel as usize),
        skip_rows: table.whole("skip_rows", 0)?.unwrap_or(0) as usize,
        column: table.name("column")?,
    })
}

/// The size that a record is scaled to.
pub(super) struct Target {
    pub key: &'static str,
    pub measure: Measure,
    /// Size, in the unit of the measure.
    pub size: f64,
}

/// Size that one of the keys [`NAMES`](crate::intensity::NAMES) gives; `None` without such a key.
pub(super) fn target(table: &mut Table, column: &Column) -> Result<Option<Target>, Wrong> {
    let is_of_spectrum = ["sa", "sa_g"].iter().any(|key| table.has(key));
    if let Some(key) = ["sa_period", "sa_damping"].into_iter().find(|key| table.has(key) && !is_of_spectrum) {
        return Err(table.wrong(key, "nothing is scaled to `sa` or `sa_g`".into(), "remove it, or give one of them"));
    }
    let sa = spectrum(table)?;
    let mut found: Option<Target> = None;
    for key in NAMES {
        let Some(value) = table.number(key)? else { continue };
        if let Some(first) = &found {
            return Err(table.clash(key, first.key));
        }
        if value <= 0.0 {
            return Err(table.wrong(key, format!("{value} is out of range"), "give a number above zero"));
        }
        let intensity = Intensity::named(key, sa)
            .ok_or_else(|| table.missing("sa_period", &format!("give the period of `{key}` in s")))?;
        let unit = intensity.unit_size(column).ok_or_else(|| no_uplift(table, key))?;
        found = Some(Target { key, measure: intensity.measure, size: value * unit });
    }
    Ok(found)
}

/// Period `[s]` and damping ratio of `sa`; `None` without a period.
pub(crate) fn spectrum(table: &mut Table) -> Result<Option<[f64; 2]>, Wrong> {
    let period = table.positive("sa_period")?;
    let damping = match table.number("sa_damping")? {
        None => DEFAULT_DAMPING,
        Some(damping) if (0.0..1.0).contains(&damping) => damping,
        Some(damping) => {
            let problem = format!("{damping} is out of range");
            return Err(table.wrong(
                "sa_damping",
                problem,
                "give a share of critical damping from 0 to below 1, e.g. 0.05",
            ));
        }
    };
    if period.is_none() && table.has("sa_damping") {
        return Err(table.missing("sa_period", "give the period in s"));
    }
    Ok(period.map(|period| [period, damping]))
}

pub(super) fn start(table: &mut Table) -> Result<f64, Wrong> {
    Ok(table.number("start")?.unwrap_or(0.0))
}

fn phase(table: &mut Table) -> Result<f64, Wrong> {
    Ok(table.number("phase")?.unwrap_or(0.0))
}

fn amplitude(table: &mut Table, scales: Scales) -> Result<f64, Wrong> {
    let [si, g, uplift] = amplitude_units(scales.gravity, scales.uplift);
    let [in_si, in_g, in_uplifts] = AMPLITUDES;
    table.one_of(&[(in_si, &|a| a * si), (in_g, &|a| a * g), (in_uplifts, &|a| a * uplift)])
}

fn omega(table: &mut Table, scales: Scales) -> Result<f64, Wrong> {
    let keys: [(&'static str, &dyn Fn(f64) -> f64); 4] = [
        ("omega", &|omega| omega),
        ("frequency", &|f| TAU * f),
        ("period", &|period| TAU / period),
        ("omega_p", &|omega| omega * scales.p),
    ];
    let omega = table.one_of(&keys)?;
    if !(omega.is_finite() && omega > 0.0) {
        let key = keys.iter().map(|(key, _)| *key).find(|key| table.has(key)).unwrap_or("omega");
        return Err(table.wrong(key, "it must be above zero".into(), "give a finite number above zero"));
    }
    Ok(omega)
}

/// A number above zero that must be there.
fn needed(table: &mut Table, key: &'static str, remedy: &str) -> Result<f64, Wrong> {
    table.positive(key)?.ok_or_else(|| table.missing(key, remedy))
}

/// Parameters of a pulse defined by a velocity amplitude: `(velocity, omega, phase, gamma)`.
fn velocity_pulse(table: &mut Table, scales: Scales) -> Result<(f64, f64, f64, f64), Wrong> {
    let omega = omega(table, scales)?;
    let velocity = table.one_of(&[
        ("velocity", &|v| v),
        ("amplitude", &|a| a / omega),
        ("amplitude_g", &|a| a * scales.gravity / omega),
        ("amplitude_uplift", &|a| a * scales.uplift / omega),
    ])?;
    let gamma = needed(table, "gamma", "give the number of oscillations in the envelope, e.g. 2")?;
    Ok((velocity, omega, phase(table)?, gamma))
}

/// A motion by a formula.
fn pulse(table: &mut Table, kind: &str, scales: Scales) -> Result<Motion, Wrong> {
    let start = start(table)?;
    let mut wave = || Ok::<_, Wrong>((amplitude(table, scales)?, omega(table, scales)?));
    Ok(match kind {
        "sine-pulse" | "one-sine" | "type-a" => {
            let (amplitude, omega) = wave()?;
            Motion::SinePulse { amplitude, omega, start }
        }
        "cosine-pulse" | "one-cosine" | "type-b" => {
            let (amplitude, omega) = wave()?;
            Motion::CosinePulse { amplitude, omega, start }
        }
        "half-sine" => {
            let (amplitude, omega) = wave()?;
            Motion::HalfSine { amplitude, omega, start }
        }
        "type-c" => {
            let (amplitude, omega) = wave()?;
            let cycles = table
                .whole_up_to("cycles", 1, MOST_CYCLES)?
                .ok_or_else(|| table.missing("cycles", "give n of type C_n, from 1"))?;
            Motion::TypeC { amplitude, omega, start, cycles: cycles as u32 }
        }
        "ricker" | "symmetric-ricker" => {
            let (amplitude, omega) = wave()?;
            Motion::Ricker { amplitude, omega, start }
        }
        "antisymmetric-ricker" => {
            let (amplitude, omega) = wave()?;
            Motion::AntisymmetricRicker { amplitude, omega, start }
        }
        "mavroeidis-papageorgiou" => {
            let (velocity, omega, phase, gamma) = velocity_pulse(table, scales)?;
            Motion::MavroeidisPapageorgiou { velocity, omega, start, phase, gamma }
        }
        "gabor" => {
            let (velocity, omega, phase, gamma) = velocity_pulse(table, scales)?;
            Motion::Gabor { velocity, omega, start, phase, gamma }
        }
        "rectangular" | "double-rectangular" => {
            let amplitude = amplitude(table, scales)?;
            let duration = needed(table, "duration", "give it in s")?;
            match kind {
                "rectangular" => Motion::Rectangular { amplitude, start, duration },
                _ => Motion::DoubleRectangular { amplitude, start, duration },
            }
        }
        "harmonic" => {
            let (amplitude, omega) = wave()?;
            let phase = phase(table)?;
            match table.positive("duration")? {
                None => Motion::Harmonic { amplitude, omega, start, phase },
                Some(duration) => Motion::SineBurst { amplitude, omega, start, phase, duration },
            }
        }
        _ => return Err(table.no_such("kind", "kind", kind, &KINDS)),
    })
}

/// Filtered noise with the seed 0, which the caller replaces.
pub(crate) fn noise(table: &mut Table) -> Result<Synthetic, Wrong> {
    let mut synthetic = Synthetic::default();
    for (key, number) in [
        ("duration", &mut synthetic.duration),
        ("dt", &mut synthetic.dt),
        ("frequency", &mut synthetic.frequency),
        ("damping", &mut synthetic.damping),
    ] {
        *number = table.positive(key)?.unwrap_or(*number);
    }
    Ok(synthetic)
}
