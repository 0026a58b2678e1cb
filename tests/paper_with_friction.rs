//! The paper's six amplitudes with its coefficients of friction, 0.8 static and 0.5 kinetic, as one, two and three blocks: what slides, when, how far,
//! and whether the outcomes without sliding hold. Prints the table of docs/book/validation.md.

use rocking::{Friction, Response, Scene, StopReason, simulate};
use std::path::Path;

const AMPLITUDES: [&str; 6] = ["3.00", "3.01", "6.32", "6.33", "7.17", "7.18"];

/// The shipped scene of a column and an amplitude `[αg]`, without friction and with the paper's.
fn runs(column: &str, amplitude: &str) -> [Response; 2] {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/paper-{column}-{amplitude}.toml"));
    let mut scene = Scene::from_file(&file).expect("a shipped scene is valid");
    let without = simulate(&scene).expect("a shipped scene runs");
    scene.friction = Some(Friction::new(vec![0.8], vec![0.5]));
    [without, simulate(&scene).expect("it runs with friction")]
}

/// Slides below are none `[m]`.
const NO_SLIDE: f64 = 1e-6;

/// Length of the way slid at each interface `[m]`, base first; flights have none.
fn ways(response: &Response) -> &[f64] {
    &response.sliding.as_ref().expect("a run with friction").way_slid
}

/// Slides at the end `[m]`, base first.
fn residuals(response: &Response) -> &[f64] {
    &response.sliding.as_ref().expect("a run with friction").residual_slide
}

/// The first row in which some interface has slid `[s]`, and the interface, from 1.
fn first_slide(response: &Response) -> Option<(f64, usize)> {
    response.samples.iter().find_map(|row| {
        let interface = row.slide.iter().position(|slide| slide.abs() > NO_SLIDE)?;
        Some((row.t, interface + 1))
    })
}

fn print_row(column: &str, amplitude: &str, [without, with]: &[Response; 2]) {
    let outcome = |run: &Response| match (run.overturned_at(), run.overturned_block) {
        (Some(t), Some(block)) => format!("block {block} at {t:.2} s"),
        _ => "stands".into(),
    };
    let millimetres = |slide: &f64| if slide.abs() > NO_SLIDE { format!("{:.2}", 1e3 * slide) } else { "0".into() };
    let list = |slides: &[f64]| slides.iter().map(millimetres).collect::<Vec<_>>().join(", ");
    let left = if with.status == StopReason::Overturned { String::new() } else { list(residuals(with)) };
    let first = first_slide(with).map_or("never".into(), |(t, interface)| format!("{interface} at {t:.2} s"));
    let (before, after, way) = (outcome(without), outcome(with), list(ways(with)));
    println!("| {column} | {amplitude} | {before} | {after} | {first} | {way} | {left} |");
}

/// In all 18 cases the friction that the paper's program had changes no outcome and no block that overturns first, and the time of overturning by
/// less than 0.07 s.
#[test]
fn the_papers_outcomes_hold_with_its_friction() {
    for column in ["1-block", "2-blocks", "3-blocks"] {
        for amplitude in AMPLITUDES {
            let both = runs(column, amplitude);
            print_row(column, amplitude, &both);
            let [without, with] = &both;
            assert_eq!((with.status, with.overturned_block), (without.status, without.overturned_block));
            assert!((with.t_final - without.t_final).abs() < 0.07, "{column} {amplitude}: {}", with.t_final);
            let sliding = with.sliding.as_ref().expect("a run with friction");
            assert!(sliding.ambiguous.is_empty() && sliding.jammed.is_empty(), "{column} {amplitude}");
        }
    }
}

/// One block that stands uses its friction up nowhere: 0.55 of 0.8 between impacts and 0.21 of 0.5 at them. Its run is that without friction. One that
/// overturns slides on its way down.
#[test]
fn one_block_slides_only_where_it_falls() {
    for amplitude in AMPLITUDES {
        let [without, with] = runs("1-block", amplitude);
        let has_slid = ways(&with)[0] > 0.0;
        assert_eq!(has_slid, with.status == StopReason::Overturned, "{amplitude}");
        if has_slid {
            let (t, _) = first_slide(&with).expect("rows until it falls");
            assert!(with.t_final - t < 0.2, "{amplitude}: {t} of {}", with.t_final);
        } else {
            assert_eq!((with.peak_theta, with.work), (without.peak_theta, without.work));
        }
    }
}

/// Two blocks slide at impacts: by less than 0.2 mm where they stand, 4 mm before they fall.
#[test]
fn two_blocks_slide_by_millimetres() {
    for amplitude in AMPLITUDES {
        let [_, with] = runs("2-blocks", amplitude);
        let most = if with.status == StopReason::Overturned { 4e-3 } else { 2e-4 };
        let ways = ways(&with);
        assert!(ways.iter().all(|way| *way < most), "{amplitude}: {ways:?}");
        assert!(ways[0] > 1e-5, "{amplitude}: {ways:?}");
    }
}

/// Three blocks slide by up to 9 mm at 3 αg, 24 mm at 6.3 and 40 mm at 7.2, mostly at the base.
#[test]
fn three_blocks_slide_by_millimetres_to_centimetres() {
    let expected = [
        [5.81e-3, 8.46e-3, 3.14e-3],
        [5.83e-3, 8.45e-3, 3.23e-3],
        [23.83e-3, 0.03e-3, 5.15e-3],
        [23.96e-3, 0.03e-3, 5.10e-3],
        [39.77e-3, 0.0, 1.79e-3],
        [40.06e-3, 0.0, 1.76e-3],
    ];
    for (amplitude, expected) in AMPLITUDES.into_iter().zip(expected) {
        let [_, with] = runs("3-blocks", amplitude);
        for (found, expected) in ways(&with).iter().zip(expected) {
            assert!((found - expected).abs() < 2e-5, "{amplitude}: {found} m, {expected} m");
        }
    }
}
