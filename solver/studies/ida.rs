//! Incremental dynamic analysis: one run for each record at each level of an intensity measure. Vamvatsikos and Cornell (2002),
//! Earthq. Eng. Struct. Dyn. 31, 491-514.
//!
//! A study is data: each run follows from its index alone, so that a range of runs gives the same rows wherever and whenever it is run.
//! Record `k` has the runs `k L .. (k + 1) L`, `L` the number of levels. One factor scales all components of a record: the factor that brings the
//! horizontal component to the level.

use crate::intensity::Intensity;
use crate::scene::{Scene, Wanted};
use crate::studies::levels::is_same_level;
use rocking_ground::{Excitation, Motion, Record, RecordError};
use std::collections::HashSet;

/// Components of one record.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyRecord {
    /// Name, as in a table.
    pub name: String,
    /// Horizontal component.
    pub horizontal: Record,
    /// Vertical component, upwards positive; `None` for a study of horizontal motion.
    pub vertical: Option<Record>,
}

/// A column, records and levels.
#[derive(Clone, Debug)]
pub struct Ida {
    scene: Scene,
    records: Vec<StudyRecord>,
    intensity: Intensity,
    levels: Vec<f64>,
    free_swing: f64,
    is_followed: bool,
    /// Size of each record in the measure, in SI units, and that of a level of one.
    sizes: Vec<f64>,
    unit: f64,
}

/// Why there is no study.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IdaError {
    /// There is no record.
    #[error("the study has no record; name at least one")]
    NoRecords,
    /// Two records have one name: their runs would count as those of one record.
    #[error("two records are named {0}; give each a name of its own")]
    SameName(String),
    /// There is no level.
    #[error("the study has no level; give at least one")]
    NoLevels,
    /// A level is out of range, or given twice.
    #[error("level {level}: {problem}")]
    Level {
        /// Level, in the unit of the measure.
        level: f64,
        /// What is wrong, and the remedy.
        problem: &'static str,
    },
    /// The measure is one of uplift, and the column does not stand by itself.
    #[error("the column does not stand by itself: no ground motion has a size in {0}")]
    NoUplift(Intensity),
    /// A record cannot be scaled to a size in the measure.
    #[error("record {name}: {error}")]
    Record {
        /// Name of the record.
        name: String,
        /// Why it cannot be scaled.
        error: RecordError,
    },
    /// The duration of the free swing is negative or not finite.
    #[error("free_swing = {0}: the time after a record must be a finite number of seconds, zero or above")]
    FreeSwing(f64),
}

/// A run of a study, before it is made: which record, and how strong.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IdaPoint {
    /// Number of the record, from zero.
    pub record: usize,
    /// Size of the record in the measure of the study.
    pub level: f64,
    /// Factor that brings the record to this size, dimensionless.
    pub scale: f64,
}

/// Longest interval between the rows from which gaps are computed `[s]`.
const LONGEST_ROW_INTERVAL: f64 = 0.01;
/// Longest interval between these rows, as a share of `1/p`, dimensionless.
const ROW_INTERVAL_OF_P: f64 = 0.02;
/// Largest number of these rows, and less where the rows of a long column would fill the memory. In long runs it makes the interval longer than the two bounds
/// above.
const MOST_ROWS: f64 = 20_000.0;

/// Default time from the end of a record to the end of its run `[s]`.
pub(super) const DEFAULT_FREE_SWING: f64 = 10.0;

impl Ida {
    /// Study of a scene. The scene's own ground motion and end are not used: a run ends 10 s after its record ([`Ida::with_free_swing`]).
    ///
    /// ```
    /// use rocking::studies::{Ida, StudyRecord};
    /// use rocking::{Column, Scene, ground::Synthetic, intensity::Intensity};
    ///
    /// let records = (1..=3).map(|seed| {
    ///     let horizontal = Synthetic { seed, ..Synthetic::default() }.record()?;
    ///     Ok(StudyRecord { name: format!("seed {seed}"), horizontal, vertical: None })
    /// });
    /// let records = records.collect::<Result<Vec<_>, rocking::RecordError>>()?;
    /// let scene = Scene::new(Column::equal_blocks(1, 0.3, 1.2, 1.0, 9.81)?);
    /// let pgv = Intensity::named("pgv", None).expect("a measure");
    /// let study = Ida::new(scene, records, pgv, vec![0.05, 0.5, 3.0])?;
    /// let runs = study.runs(0..study.len());
    /// // Three records, three levels: nothing moves at the lowest.
    /// assert_eq!(runs.len(), 9);
    /// assert!(runs.iter().filter(|run| run.level == 0.05).all(|run| run.result.as_ref().is_ok_and(|found| found.largest_gap == 0.0)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`IdaError`]
    pub fn new(
        scene: Scene,
        records: Vec<StudyRecord>,
        intensity: Intensity,
        levels: Vec<f64>,
    ) -> Result<Ida, IdaError> {
        if records.is_empty() {
            return Err(IdaError::NoRecords);
        }
        let mut names = HashSet::new();
        if let Some(twice) = records.iter().find(|record| !names.insert(record.name.as_str())) {
            return Err(IdaError::SameName(twice.name.clone()));
        }
        if levels.is_empty() {
            return Err(IdaError::NoLevels);
        }
        for (place, level) in levels.iter().copied().enumerate() {
            if !(level.is_finite() && level > 0.0) {
                return Err(IdaError::Level { level, problem: "it must be a finite number above zero" });
            }
            if levels[..place].iter().any(|other| is_same_level(other.min(level), other.max(level))) {
                return Err(IdaError::Level { level, problem: "it is there twice; remove one of the two" });
            }
        }
        let unit = intensity.unit_size(&scene.column).ok_or(IdaError::NoUplift(intensity))?;
        let size = |record: &StudyRecord| {
            let (measure, gravity) = (intensity.measure, scene.column.gravity());
            let factor = record.horizontal.factor_to(measure, unit, gravity);
            factor.map_err(|error| IdaError::Record { name: record.name.clone(), error })?;
            Ok(record.horizontal.measure(measure, gravity))
        };
        let sizes = records.iter().map(size).collect::<Result<_, _>>()?;
        Ok(Ida { scene, records, intensity, levels, free_swing: DEFAULT_FREE_SWING, is_followed: true, sizes, unit })
    }

    /// The study with another time after each record `[s]`; default 10.
    ///
    /// # Errors
    /// [`IdaError::FreeSwing`]
    pub fn with_free_swing(self, free_swing: f64) -> Result<Ida, IdaError> {
        if !(free_swing.is_finite() && free_swing >= 0.0) {
            return Err(IdaError::FreeSwing(free_swing));
        }
        Ok(Ida { free_swing, ..self })
    }

    /// The study with or without companion runs, which show whether the verdict of each run is determined ([`crate::trust`]). The default is with
    /// companions, which take 7 to 30 times as long as the runs themselves on one thread, up to 73 times where nine are too few.
    #[must_use]
    pub fn followed(self, is_followed: bool) -> Ida {
        Ida { is_followed, ..self }
    }

    /// Whether each run has companion runs ([`Ida::followed`]).
    pub fn is_followed(&self) -> bool {
        self.is_followed
    }

    /// Its scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Its records.
    pub fn records(&self) -> &[StudyRecord] {
        &self.records
    }

    /// Warnings about its scene and its records, a sentence each, each once ([`Scene::warnings`]).
    pub fn warnings(&self) -> Vec<String> {
        let mut seen = HashSet::new();
        let without_motion = Scene { excitation: Excitation::default(), ..self.scene.clone() };
        let of_scene = self.scene.excitation.vertical.is_some().then(|| {
            "the vertical ground motion of the scene is left out: runs have the motion of their records alone"
                .to_string()
        });
        let of_scene = of_scene.into_iter().chain(without_motion.warnings());
        // Scaled to the highest level; where that leaves the range of numbers, as they are.
        let highest = self.levels.iter().copied().fold(0.0, f64::max) * self.unit;
        let of = |(record, size): (&StudyRecord, &f64)| {
            let factor = self.intensity.measure.factor(*size, highest);
            let scaled = |own: &Record| Motion::Record(own.clone().scaled(factor).unwrap_or_else(|_| own.clone()));
            let [horizontal, vertical] =
                [Some(&record.horizontal), record.vertical.as_ref()].map(|own| own.map(scaled));
            Excitation { horizontal, vertical }.warnings_named(&record.name)
        };
        of_scene
            .chain(self.records.iter().zip(&self.sizes).flat_map(of))
            .filter(|warning| seen.insert(warning.clone()))
            .collect()
    }

    /// Its measure.
    pub fn intensity(&self) -> Intensity {
        self.intensity
    }

    /// Its levels, in the unit of the measure.
    pub fn levels(&self) -> &[f64] {
        &self.levels
    }

    /// How long each run goes on after the end of its record `[s]`.
    pub fn free_swing(&self) -> f64 {
        self.free_swing
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.records.len() * self.levels.len()
    }

    /// Whether there is no run; always false, as [`Ida::new`] refuses a study without records or levels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Record, level and factor of a run.
    ///
    /// # Panics
    /// If there are no more than `index` runs.
    pub fn point(&self, index: usize) -> IdaPoint {
        let (record, level) = (index / self.levels.len(), self.levels[index % self.levels.len()]);
        let scale = self.intensity.measure.factor(self.sizes[record], level * self.unit);
        IdaPoint { record, level, scale }
    }

    /// Scene of a run: records scaled, end and rows set.
    ///
    /// # Errors
    /// [`RecordError`] if scaled accelerations are out of range.
    ///
    /// # Panics
    /// If there are no more than `index` runs.
    pub fn scene_of(&self, index: usize) -> Result<Scene, RecordError> {
        let IdaPoint { record, scale, .. } = self.point(index);
        let StudyRecord { horizontal, vertical, .. } = &self.records[record];
        let end = |record: &Record| record.start() + record.duration();
        let last = vertical.iter().map(end).fold(end(horizontal), f64::max);
        let scaled = |record: &Record| record.clone().scaled(scale).map(Motion::Record);
        let excitation =
            Excitation { horizontal: Some(scaled(horizontal)?), vertical: vertical.as_ref().map(scaled).transpose()? };
        let mut scene = Scene { excitation, ..self.scene.clone() };
        scene.options.t_end = last + self.free_swing;
        scene.options.wanted = Wanted::Everything;
        scene.options.record_forces = false;
        // The interval between samples of the horizontal component is a whole number of row intervals: its kinks are at rows, but for a start between rows, and
        // for `MOST_ROWS`.
        let longest = LONGEST_ROW_INTERVAL.min(ROW_INTERVAL_OF_P / scene.column.largest_frequency_parameter());
        let interval = horizontal.dt() / (horizontal.dt() / longest).ceil();
        // One row stands at each end, and rounding may add another.
        let most_intervals = MOST_ROWS.min(scene.most_rows() - 2.0);
        scene.set_rows(Some(interval.max(scene.options.t_end / most_intervals)));
        Ok(scene)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Column;

    fn scene() -> Scene {
        Scene::new(Column::equal_blocks(1, 0.4, 1.6, 1.0, 9.81).expect("valid"))
    }

    #[test]
    fn a_column_that_does_not_stand_has_no_sizes_in_uplift() {
        let leaning = Column::equal_blocks(3, 0.4, 3.0, 1.0, 9.81).expect("valid");
        let leaning = leaning.displaced(vec![0.0, 0.7, 0.7]).expect("each block stands on the one below");
        let record = Record::new(vec![0.0, 1.0, 0.0], 0.1, 0.0).expect("valid");
        let study = |name: &str| {
            let measure = Intensity::named(name, None).expect("a measure");
            let record = StudyRecord { name: "a".into(), horizontal: record.clone(), vertical: None };
            Ida::new(Scene::new(leaning.clone()), vec![record], measure, vec![1.0]).map(|_| measure)
        };
        for name in ["pga_uplift", "pgv_uplift"] {
            let measure = Intensity::named(name, None).expect("a measure");
            assert_eq!(study(name), Err(IdaError::NoUplift(measure)));
        }
        assert!(study("pga_g").is_ok());
    }

    /// With friction, `MOST_ROWS` rows of a hundred blocks take more memory than a scene may.
    #[test]
    fn scenes_of_long_columns_have_no_more_rows_than_fit() {
        let column = Column::equal_blocks(100, 0.5, 2.5, 1.0, 9.81).expect("valid");
        let scene = Scene { friction: Some(crate::Friction::uniform(0.7)), ..Scene::new(column) };
        let record = Record::new(vec![1.0; 20_001], 0.01, 0.0).expect("valid");
        let record = StudyRecord { name: "a".into(), horizontal: record, vertical: None };
        let pga = Intensity::named("pga", None).expect("a measure");
        let study = Ida::new(scene, vec![record], pga, vec![1.0]).expect("a study");
        let scene = study.scene_of(0).expect("in range");
        assert_eq!(scene.check(), Ok(()));
        assert!(scene.row_times().count() > 10_000.0);
    }

    #[test]
    fn a_run_goes_on_after_the_longer_component() {
        let lasting = |intervals: usize| Record::new(vec![1.0; intervals + 1], 0.1, 0.0).expect("valid");
        let t_end = |horizontal: usize, vertical: usize| {
            let vertical = Some(lasting(vertical));
            let record = StudyRecord { name: "a".into(), horizontal: lasting(horizontal), vertical };
            let pga = Intensity::named("pga", None).expect("a measure");
            let study = Ida::new(scene(), vec![record], pga, vec![1.0]).and_then(|study| study.with_free_swing(1.0));
            study.expect("a study").scene_of(0).expect("in range").options.t_end
        };
        for (horizontal, vertical, end) in [(5, 19, 2.9), (19, 5, 2.9)] {
            assert!((t_end(horizontal, vertical) - end).abs() < 1e-12, "{horizontal} and {vertical}");
        }
    }
}
