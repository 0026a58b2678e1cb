//! What is possible but hardly a record of an earthquake: a warning each.

use crate::unit::{AccelerationUnit, DEFAULT_GRAVITY};

/// Numbers that stand for missing samples in the files of many programs.
const MISSING: [f64; 3] = [-999.0, -9999.0, -99999.0];

/// Largest plausible peak in g: no instrument has recorded it on the ground. Samples with a larger one are likely to be in another unit.
const LARGEST_PEAK_IN_G: f64 = 20.0;

/// Largest plausible share of the peak that the last sample has: those of whole records are below a hundredth.
const LARGEST_LAST_SHARE: f64 = 0.1;

/// Least number of samples whose last one is compared with the peak: shorter records are made by hand.
pub(crate) const LEAST_SAMPLES_OF_SHAKING: usize = 100;

/// Plausible sampling intervals `[s]`: strong motion is sampled at 20 Hz or more, and up to some 1000 Hz.
const PLAUSIBLE_INTERVALS: std::ops::RangeInclusive<f64> = 1e-4..=0.1;

/// Warning that a sample, as it was given, is a number that often stands for a missing one. `dt [s]` is the sampling interval.
pub(crate) fn missing_sample(values: &[f64], dt: f64) -> Option<String> {
    let place = values.iter().position(|value| MISSING.contains(value))?;
    let (sample, t, value) = (place + 1, place as f64 * dt, values[place]);
    Some(format!(
        "sample {sample}, at {t:.6} s, is {value}, which often stands for a missing one, and is read as an acceleration"
    ))
}

/// Warnings about the samples `accel [m/s²]`, which were given in a unit. One g is `gravity [m/s²]`.
pub(crate) fn doubtful_samples(accel: &[f64], unit: AccelerationUnit, gravity: f64) -> Vec<String> {
    let largest = accel.iter().fold(0.0f64, |peak, a| peak.max(a.abs()));
    let peak = largest / gravity;
    let mut warnings = Vec::new();
    if peak == 0.0 {
        warnings.push("all samples are zero: is something else the acceleration?".into());
    }
    if peak > LARGEST_PEAK_IN_G {
        warnings.push(format!("a peak of {peak:.1} g is hardly one; are the samples in another unit than {unit}?"));
    }
    let share = accel.last().map_or(0.0, |last| last.abs()) / largest;
    if accel.len() >= LEAST_SAMPLES_OF_SHAKING && share > LARGEST_LAST_SHARE {
        warnings.push(format!(
            "the last sample is {:.0} % of the peak; does the record end while the ground still shakes?",
            100.0 * share
        ));
    }
    warnings
}

/// Warning that a factor other than one makes a peak `[m/s²]` that no ground has had, where the record's own peak is none of these.
pub(crate) fn scaled_too_far(peak: f64, scale: f64) -> Option<String> {
    let (peak, own) = (peak / DEFAULT_GRAVITY, (peak / scale).abs() / DEFAULT_GRAVITY);
    (peak > LARGEST_PEAK_IN_G && own <= LARGEST_PEAK_IN_G).then(|| {
        format!("it is scaled to a peak above {LARGEST_PEAK_IN_G} g, which no instrument has recorded; is the size to which it is scaled, or the factor, in another unit?")
    })
}

/// Warning about a sampling interval `[s]`.
pub(crate) fn doubtful_interval(dt: f64) -> Option<String> {
    let doubt = "is hardly one; is it in another unit than s, or a number of rows?";
    (!PLAUSIBLE_INTERVALS.contains(&dt)).then(|| format!("a sampling interval of {dt} s {doubt}"))
}
