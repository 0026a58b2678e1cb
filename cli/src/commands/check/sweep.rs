//! `rocking check` of a sweep: its axes, its table, and scenes of its points, read without running them.

use crate::commands::sweep;
use crate::error::Failure;
use crate::terminal::{json, print, warn_of_some};
use crate::text::{printable, shell_word, shown};
use rocking::scene_file::Setting;
use rocking::sweep::{Axis, Combine, Sweep};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Description of a sweep.
#[derive(Debug, Serialize)]
struct Findings {
    scene: PathBuf,
    combine: &'static str,
    points: usize,
    axes: Vec<AxisFindings>,
    /// Columns of the table.
    columns: Vec<String>,
    #[serde(flatten)]
    scenes: ScenesRead,
}

/// Scenes of a sweep that were read without running them.
#[derive(Debug, Default, Serialize)]
struct ScenesRead {
    /// Number of points whose scenes were read: all points, or evenly spread points that include the first and the last.
    read: usize,
    /// Number of the scenes read that are refused. Their points would be rows with errors.
    refused: usize,
    /// Point and reason of the first refusal.
    first_refusal: Option<String>,
    /// Number of the scenes read whose ground motion continues after `solver.t_end`.
    cut: usize,
    /// Warnings about the axes and these scenes, each once.
    warnings: Vec<String>,
}

impl ScenesRead {
    fn of(sweep: &Sweep) -> ScenesRead {
        let mut found = ScenesRead::default();
        for index in sweep.evenly_spread(sweep::POINTS_READ) {
            found.read += 1;
            match sweep.scene(index) {
                Ok(scene) => {
                    found.cut += usize::from(scene.excitation.moves_after(scene.options.t_end));
                }
                Err(error) => {
                    found.refused += 1;
                    found.first_refusal.get_or_insert_with(|| format!("point {index}: {}", sweep.refusal(error)));
                }
            }
        }
        found.warnings = sweep.warnings(0..sweep.len(), sweep::POINTS_READ);
        found
    }
}

/// An axis: key, number of values, first and last value. For a sampled axis these are the smallest and the largest value.
#[derive(Debug, Serialize)]
struct AxisFindings {
    key: String,
    /// Key of the base scene whose place it takes; `None` if there is none.
    replaces: Option<String>,
    values: usize,
    from: String,
    to: String,
}

/// Reads a sweep and explains it.
pub fn check(path: &Path, as_json: bool) -> Result<(), Failure> {
    let sweep = Sweep::from_file(path).map_err(Failure::scene)?;
    let axis = |(place, axis): (usize, &Axis)| {
        let mut values: Vec<&Setting> = axis.values.iter().collect();
        // Samples have no order of their own.
        if place >= sweep.grid().len() {
            let number = |setting: &Setting| if let Setting::Number(number) = setting { *number } else { 0.0 };
            values.sort_by(|a, b| number(a).total_cmp(&number(b)));
        }
        let [from, to] =
            [values.first(), values.last()].map(|value| value.map_or_else(String::new, ToString::to_string));
        AxisFindings { key: axis.key.clone(), replaces: sweep.replaced(axis), values: axis.values.len(), from, to }
    };
    let findings = Findings {
        scene: sweep.template.file().into(),
        combine: match sweep.combine {
            Combine::Paired => "paired",
            Combine::Sampled(_) => "samples of the distributed axes, with each combination of the others",
            _ => "cartesian",
        },
        points: sweep.len(),
        axes: sweep.axes.iter().enumerate().map(axis).collect(),
        columns: sweep::columns(&sweep)?.into_iter().map(|column| column.name).collect(),
        scenes: ScenesRead::of(&sweep),
    };
    if let ScenesRead { read, refused, first_refusal: Some(first), .. } = &findings.scenes
        && read == refused
    {
        return Err(Failure::NoScene(path.into(), *read, first.clone()));
    }
    warn_of_some(&findings.scenes.warnings);
    if as_json {
        return json(&findings);
    }
    let Findings { scene, combine, points, axes, columns, scenes } = findings;
    let ScenesRead { read, refused, first_refusal, cut, .. } = scenes;
    let mut text = format!("{}: a valid sweep of {points} point(s), {combine}\n", shown(path));
    for AxisFindings { key, replaces, values, from, to } in axes {
        let replaces = replaces.map_or(String::new(), |other| format!(", in place of {other} in the base scene"));
        let _ = writeln!(text, "  {key}: {values} value(s), from {} to {}{replaces}", printable(&from), printable(&to));
    }
    let _ = writeln!(text, "  columns of the table: {}", printable(&columns.join(", ")));
    let which = if read == points { "all points".into() } else { format!("{read} points, evenly spread,") };
    let _ = match first_refusal {
        None => writeln!(text, "  scenes of {which} were read, and are valid"),
        Some(first) => {
            writeln!(
                text,
                "  scenes of {which} were read, and {refused} refused: they would be rows with errors; {}",
                printable(&first)
            )
        }
    };
    if cut > 0 {
        let _ = writeln!(text, "  the ground motion of {cut} of them goes on after solver.t_end, which cuts it");
    }
    let _ = writeln!(
        text,
        "its base scene {} is valid; run the sweep with `rocking sweep {}`",
        shown(&scene),
        shell_word(&shown(path))
    );
    print(&text)
}
