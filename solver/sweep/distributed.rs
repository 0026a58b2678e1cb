//! Distributed axes of sweep files: `{ lognormal = [median, dispersion] }` and the like, and `[sampling]`, by which their values are drawn.

use super::axes::{Axis, Combine};
use super::copula::Copula;
use super::distribution::Distribution;
use super::sampling::{LONGEST_SOBOL, MOST_DIMENSIONS, Sampling, SamplingMethod};
use crate::scene_file::table::{Cause, Place, Table, Wrong};
use crate::scene_file::{Setting, Template};

/// Largest number of samples; a larger one is taken for a mistake, as all values are kept in memory.
const MOST_SAMPLES: u64 = 10_000_000;

/// The section `[sampling]` of a sweep file.
#[derive(Debug)]
pub(super) struct SamplingSection {
    sampling: Sampling,
    correlations: Vec<Correlation>,
}

/// A pair of axes, by the names in the file, and the correlation of their normal scores.
#[derive(Debug)]
struct Correlation {
    table: Table,
    axes: [String; 2],
    value: f64,
}

/// An axis, its place in the file, and the distribution of its values; `None` for an axis whose values are given.
pub(super) type Placed = (Axis, Place, Option<Distribution>);

/// `[sampling]`: how many samples, by which method, from which seed.
pub(super) fn sampling(root: &mut Table) -> Result<Option<SamplingSection>, Wrong> {
    let Some(mut table) = root.table("sampling")? else { return Ok(None) };
    let method = match table.text("method")? {
        None => SamplingMethod::default(),
        Some(name) => SamplingMethod::parse(&name)
            .ok_or_else(|| table.no_such("method", "sampling method", &name, &SamplingMethod::NAMES))?,
    };
    let Some(samples) = table.whole("samples", 1)? else {
        return Err(table.missing("samples", "say how many samples are drawn, e.g. samples = 1000"));
    };
    let most = if method == SamplingMethod::Sobol { u64::from(LONGEST_SOBOL) } else { MOST_SAMPLES };
    if samples > most {
        let remedy = format!("give at most {most} by method `{}`", method.name());
        return Err(table.wrong("samples", format!("{samples} samples are too many"), &remedy));
    }
    let seed = table.whole("seed", 0)?.unwrap_or(0);
    let correlations = table.tables("correlations")?.unwrap_or_default().into_iter().map(correlation);
    let correlations = correlations.collect::<Result<Vec<_>, Wrong>>()?;
    table.close()?;
    Ok(Some(SamplingSection { sampling: Sampling { samples: samples as u32, method, seed }, correlations }))
}

/// `{ axes = ["eta", "amplitude_g"], value = 0.6 }`
fn correlation(mut table: Table) -> Result<Correlation, Wrong> {
    let remedy = "give the keys of two distributed axes, e.g. axes = [\"eta\", \"amplitude_g\"]";
    let Some(axes) = table.settings("axes")? else { return Err(table.missing("axes", remedy)) };
    let names: Vec<String> = axes.iter().map(Setting::to_string).collect();
    let axes = <[String; 2]>::try_from(names);
    let axes = axes.map_err(|names| table.wrong("axes", format!("{} key(s) are no pair", names.len()), remedy))?;
    let remedy = "give the correlation of their normal scores, above -1 and below 1";
    let Some(value) = table.number("value")? else { return Err(table.missing("value", remedy)) };
    if !(-1.0..=1.0).contains(&value) || value.abs() == 1.0 {
        return Err(table.wrong("value", format!("{value} is out of range"), remedy));
    }
    table.close()?;
    Ok(Correlation { table, axes, value })
}

/// The copula of distributed axes; `None` where all are independent.
fn copula(
    root: &Table,
    correlations: &[Correlation],
    distributed: &[Placed],
    template: &Template,
) -> Result<Option<Copula>, Wrong> {
    let mut pairs: Vec<(usize, usize, f64)> = Vec::new();
    for Correlation { table, axes, value } in correlations {
        let wrong = |problem: String, remedy: &str| table.wrong("axes", problem, remedy);
        let place = |name: &String| {
            let full = template.full_name(name);
            let place = distributed.iter().position(|(axis, ..)| full.as_ref() == Ok(&axis.key));
            let known: Vec<&str> = distributed.iter().map(|(axis, ..)| axis.key.as_str()).collect();
            place.ok_or_else(|| {
                wrong(format!("`{name}` is no distributed axis"), &format!("choose two of {}", known.join(", ")))
            })
        };
        let [a, b] = [place(&axes[0])?, place(&axes[1])?];
        let (a, b) = (a.min(b), a.max(b));
        if a == b || pairs.iter().any(|(x, y, _)| (*x, *y) == (a, b)) {
            return Err(wrong("the pair is one axis, or given twice".into(), "give each pair of two axes once"));
        }
        // Values that are names have no order, and so no correlation.
        let is_named = |axis: usize| distributed[axis].0.values.iter().any(|value| matches!(value, Setting::Text(_)));
        if is_named(a) || is_named(b) {
            return Err(wrong("an axis of names has no correlation".into(), "remove it"));
        }
        pairs.push((a, b, *value));
    }
    if pairs.is_empty() {
        return Ok(None);
    }
    let found = Copula::new(distributed.len(), &pairs);
    let problem =
        || "these correlations contradict each other, or leave no freedom to one of the variables".to_string();
    found.map(Some).ok_or_else(|| root.wrong("sampling", problem(), "bring some of the correlations closer to zero"))
}

/// Draws the values of distributed axes, moves these axes behind the others, and returns how the axes combine.
pub(super) fn sample(
    root: &Table,
    combine: Combine,
    section: Option<SamplingSection>,
    axes: &mut [Placed],
    template: &Template,
) -> Result<Combine, Wrong> {
    axes.sort_by_key(|(.., distribution)| distribution.is_some());
    let first = axes.partition_point(|(.., distribution)| distribution.is_none());
    let SamplingSection { sampling, correlations } = match (section, axes.get(first)) {
        (None, None) => return Ok(combine),
        (Some(section), Some(_)) => section,
        (None, Some((axis, place, _))) => {
            let (key, problem) =
                (format!("axes.{}", axis.key), "it is a distribution, and nothing says how it is sampled".into());
            let remedy = "add [sampling] with `samples`, e.g. samples = 1000".into();
            return Err(Wrong { place: place.clone(), key, problem, remedy, cause: Cause::Key });
        }
        (Some(_), None) => {
            let remedy = "remove it, or give an axis a distribution, e.g. { normal = [mean, standard deviation] }";
            return Err(root.wrong("sampling", "no axis is a distribution".into(), remedy));
        }
    };
    if combine == Combine::Paired {
        let remedy = "leave `combine` out: distributed axes are sampled together, with each combination of the others";
        return Err(root.wrong("combine", "distributed axes are not paired with others".into(), remedy));
    }
    let distributed = &mut axes[first..];
    if sampling.method == SamplingMethod::Sobol && distributed.len() > MOST_DIMENSIONS {
        let problem = format!("{} distributed axes are too many for a Sobol sequence", distributed.len());
        return Err(root.wrong(
            "sampling",
            problem,
            &format!("give at most {MOST_DIMENSIONS}, or choose another method"),
        ));
    }
    let copula = copula(root, &correlations, distributed, template)?;
    distributed.iter_mut().for_each(|(axis, ..)| axis.values.clear());
    for sample in 0..sampling.samples {
        let units: Vec<f64> = (0..distributed.len()).map(|dimension| sampling.unit(sample, dimension)).collect();
        let units = copula.as_ref().map_or(units.clone(), |copula| copula.correlated(&units));
        for ((axis, _, distribution), unit) in distributed.iter_mut().zip(units) {
            axis.values.extend(distribution.as_ref().map(|distribution| distribution.quantile(unit)));
        }
    }
    Ok(Combine::Sampled(distributed.len()))
}

/// Keys of distributions.
pub(super) const KINDS: [&str; 4] = ["normal", "lognormal", "uniform", "discrete"];

/// `{ lognormal = [median, dispersion] }` and the like; a normal or lognormal distribution may have `min` and `max`.
pub(super) fn distribution(table: &mut Table, kind: &'static str) -> Result<Distribution, Wrong> {
    let refused = |table: &Table, (problem, remedy): (String, &str)| table.wrong(kind, problem, remedy);
    if kind == "discrete" {
        let values = table.settings(kind)?.unwrap_or_default();
        let weights = table.numbers("weights")?;
        return Distribution::discrete(values, weights).map_err(|why| refused(table, why));
    }
    let pair = table.numbers(kind)?.unwrap_or_default();
    let [a, b] = pair[..] else {
        let remedy = match kind {
            "normal" => "give `[mean, standard deviation]`",
            "lognormal" => "give `[median, dispersion]`",
            _ => "give `[from, to]`",
        };
        return Err(table.wrong(kind, format!("{} number(s)", pair.len()), remedy));
    };
    if kind == "uniform" {
        return Distribution::uniform(a, b).map_err(|why| refused(table, why));
    }
    let mut bound = |key: &'static str, open: f64| Ok(table.number(key)?.unwrap_or(open));
    let bounds = [bound("min", f64::NEG_INFINITY)?, bound("max", f64::INFINITY)?];
    let made =
        if kind == "normal" { Distribution::normal(a, b, bounds) } else { Distribution::lognormal(a, b, bounds) };
    made.map_err(|why| refused(table, why))
}
