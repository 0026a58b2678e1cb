//! Every kind of ground motion shakes a column as its samples do: a record of the same motion, sampled finely, gives the same response.

use rocking::{Column, Excitation, Motion, Record, Response, Scene, simulate};
use std::path::Path;

const KINDS: &str = include_str!("pulses.toml");

/// A scene per `[[motion]]` of the file: each is a table as `[excitation.horizontal]` takes it.
fn scenes() -> Vec<(String, Scene)> {
    KINDS
        .split("\n---\n")
        .map(|motion| {
            let text = format!(
                "[[block]]\nhalf_width = 0.3\nhalf_height = 1.0\n[[block]]\nhalf_width = 0.3\nhalf_height = 0.8\n\
                 [restitution]\neta = 0.9\n[solver]\nt_end = 3.0\nrtol = 1e-10\n[output]\ndt = 0.05\n{motion}"
            );
            let scene = Scene::from_toml(&text, Path::new("pulses.toml"));
            (motion.to_string(), scene.unwrap_or_else(|error| panic!("{error}\n{motion}")))
        })
        .collect()
}

fn sampled(motion: &Motion, dt: f64, t_end: f64) -> Record {
    let count = (t_end / dt).round() as usize + 1;
    Record::new((0..count).map(|index| motion.value(index as f64 * dt)).collect(), dt, 0.0).expect("finite")
}

fn largest_difference(a: &Response, b: &Response) -> f64 {
    let pairs = a.samples.iter().zip(&b.samples).flat_map(|(a, b)| a.theta.iter().zip(&b.theta));
    pairs.fold(0.0, |largest, (a, b)| largest.max((a - b).abs()))
}

/// The names of all kinds, as the reader of scenes lists them.
fn names_of_kinds() -> Vec<String> {
    let scene = "[[block]]\nhalf_width = 0.3\nhalf_height = 1.0\n[excitation.horizontal]\nkind = \"none\"\n";
    let error = Scene::from_toml(scene, Path::new("s.toml")).expect_err("there is no such kind").to_string();
    let (_, kinds) = error.split_once("choose one of ").expect("a list of kinds");
    kinds.split(',').map(|name| name.split_whitespace().next().unwrap_or_default().to_string()).collect()
}

#[test]
fn every_kind_is_tried_here() {
    let names = names_of_kinds();
    assert!(names.len() > 10, "{names:?}");
    for name in names {
        assert!(KINDS.contains(&format!("kind = \"{name}\"")), "tests/pulses.toml has no `{name}`");
    }
}

#[test]
fn every_kind_shakes_as_its_samples_do() {
    let mut moved = 0;
    for (text, scene) in scenes() {
        let motion = scene.excitation.horizontal.clone().expect("it is given");
        let exact = simulate(&scene).expect("it runs");
        let with = |dt: f64| {
            let mut other = scene.clone();
            other.excitation =
                Excitation { horizontal: Some(Motion::Record(sampled(&motion, dt, 3.0))), vertical: None };
            largest_difference(&simulate(&other).expect("it runs"), &exact)
        };
        let peak = exact.peak_theta.iter().fold(0.0f64, |peak, angle| peak.max(*angle));
        moved += usize::from(peak > 1e-3);
        if let Motion::Record(_) = motion {
            continue;
        }
        // Samples miss a jump by half an interval: first order, with a factor of the rocking's growth.
        let (coarse, fine) = (with(1e-3), with(1e-4));
        assert!(fine < 2e-2 * peak.max(0.05), "{text}: {coarse:e} {fine:e} of {peak}");
        assert!(fine < 0.5 * coarse.max(1e-9), "{text}: {coarse:e} {fine:e}");
    }
    assert_eq!(moved, scenes().len(), "a motion that moves nothing proves nothing");
}

/// The acceleration of a velocity pulse has the amplitude `velocity · omega`; `g tan α` is 0.75 g.
#[test]
fn an_amplitude_of_a_velocity_pulse_is_one_of_its_acceleration() {
    for (key, velocity) in [
        ("velocity = 2.0", 2.0),
        ("amplitude = 2.0", 2.0 / 8.0),
        ("amplitude_g = 2.0", 2.0 * 9.81 / 8.0),
        ("amplitude_uplift = 2.0", 2.0 * 0.75 * 9.81 / 8.0),
    ] {
        for kind in ["gabor", "mavroeidis-papageorgiou"] {
            let text = format!(
                "[[block]]\nhalf_width = 0.3\nhalf_height = 0.4\n\
                 [excitation.horizontal]\nkind = \"{kind}\"\nomega = 8.0\ngamma = 2.0\n{key}\n"
            );
            let scene = Scene::from_toml(&text, Path::new("pulse.toml")).expect("a scene");
            let found = match scene.excitation.horizontal {
                Some(Motion::Gabor { velocity, .. } | Motion::MavroeidisPapageorgiou { velocity, .. }) => velocity,
                other => panic!("{other:?}"),
            };
            assert!((found / velocity - 1.0).abs() < 1e-14, "{kind}, {key}: {found}");
        }
    }
}

/// Horizontal and vertical are summed, scaled and mirrored alike.
#[test]
fn a_sum_of_halves_is_the_whole() {
    let column = Column::equal_blocks(2, 0.3, 1.8, 1.0, 9.81).expect("sizes above zero");
    let mut whole = Scene::new(column);
    whole.options.t_end = 3.0;
    whole.output_dt = Some(0.05);
    let pulse = |amplitude: f64| Motion::SinePulse { amplitude, omega: 8.0, start: 0.2 };
    whole.excitation.horizontal = Some(pulse(5.0));
    let mut halves = whole.clone();
    halves.excitation.horizontal = Some(Motion::Sum { terms: vec![pulse(2.5), pulse(2.5)] });
    let (whole, halves) = (simulate(&whole).expect("it runs"), simulate(&halves).expect("it runs"));
    assert!(whole.peak_theta[0] > 1e-2);
    assert!(largest_difference(&whole, &halves) < 1e-9);
}
