//! A row of a sweep depends on its point alone, not on the points that the same thread has run before.

use rocking::scene_file::{Setting, Template};
use rocking::sweep::{Ask, Axis, Combine, Sweep};
use rocking::trust::Degree;
use std::ops::ControlFlow;
use std::path::Path;

fn sweep(combine: Combine, axes: &[(&str, &[f64])]) -> Sweep {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/sweeps/column.toml");
    let axis = |(key, values): &(&str, &[f64])| {
        let values = values.iter().map(|value| Setting::Number(*value)).collect();
        Axis { key: (*key).into(), values }
    };
    let template = Template::from_file(&file).expect("a scene");
    Sweep { template, axes: axes.iter().map(axis).collect(), combine, ask: Ask::Peaks }
}

/// A column that begins beyond its balance overturns without an event, in the mode in which it begins.
#[test]
fn the_last_mode_without_events_is_the_first() {
    let scene =
        "[column]\nblocks = 1\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [0.3]\n[solver]\nt_end = 5\n";
    let template = Template::from_toml(scene.into(), "tilted.toml".as_ref()).expect("a scene");
    let values = vec![Setting::Number(0.3), Setting::Number(-0.3)];
    let axes = vec![Axis { key: "initial.theta[1]".into(), values }];
    let sweep = Sweep { template, axes, combine: Combine::Cartesian, ask: Ask::Peaks };
    for row in sweep.rows(0..2) {
        let outcome = row.result.expect("a run");
        assert_eq!((outcome.impacts, outcome.last_mode.as_deref()), (0, Some("1.1")));
        assert!(outcome.overturned_at.is_some());
    }
}

/// Rows that say whether a column overturns say nothing else than those that say when as well.
#[test]
fn whether_is_answered_as_when() {
    let axes: [(&str, &[f64]); 3] = [
        ("column.blocks", &[1.0, 2.0]),
        ("excitation.horizontal.omega_p", &[2.0, 5.0]),
        ("excitation.horizontal.amplitude_uplift", &[0.9, 2.0, 4.0, 8.0]),
    ];
    let mut sweep = sweep(Combine::Cartesian, &axes);
    let mut rows = |ask: Ask| {
        sweep.ask = ask;
        sweep.rows(0..sweep.len())
    };
    let (when, whether) = (rows(Ask::Outcome), rows(Ask::Overturns));
    assert!(when.iter().any(|row| row.result.as_ref().is_ok_and(|outcome| outcome.overturned_at.is_some())));
    for (mut when, whether) in when.into_iter().zip(whether) {
        if let Ok(outcome) = &mut when.result {
            outcome.overturned_at = None;
        }
        assert_eq!(when, whether);
    }
}

#[test]
fn rows_are_those_of_points_run_alone() {
    let (uplift, in_g) = ("excitation.horizontal.amplitude_uplift", "excitation.horizontal.amplitude_g");
    let (omega, omega_p) = ("excitation.horizontal.omega", "excitation.horizontal.omega_p");
    for (combine, axes) in [
        // Keys of which a scene takes one, so that the later takes the place of the earlier.
        (Combine::Paired, &[(uplift, &[1.5, 2.0, 3.0][..]), (in_g, &[0.9, 0.9, 0.9][..])][..]),
        (Combine::Cartesian, &[(in_g, &[0.5, 0.9]), (uplift, &[3.0])]),
        (Combine::Cartesian, &[(omega, &[3.0, 9.0]), (omega_p, &[5.0]), (uplift, &[2.0, 4.0])]),
        // An amplitude alone, one that no scene may have among them, and before another key changes.
        (Combine::Cartesian, &[(omega, &[3.0, 9.0]), (in_g, &[0.5, 1e9, 0.9])]),
        (Combine::Cartesian, &[(in_g, &[0.5, 0.9]), (omega, &[3.0, 9.0])]),
        // Points without a scene, and a column that changes, in between.
        (Combine::Cartesian, &[(omega_p, &[4.0, -1.0, 6.0]), (uplift, &[2.0, 4.0])]),
        (Combine::Cartesian, &[("column.blocks", &[1.0, 0.0, 2.0]), (uplift, &[2.0, 4.0]), (omega_p, &[5.0, -1.0])]),
    ] {
        let sweep = sweep(combine, axes);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
        let rows = pool.install(|| sweep.rows(0..sweep.len()));
        let alone: Vec<_> = (0..sweep.len()).map(|index| sweep.row(index)).collect();
        assert_eq!(rows, alone, "{axes:?}");
        assert!(rows.iter().any(|row| row.result.is_ok()), "{axes:?}");
    }
}

#[test]
fn points_that_are_spread_over_a_sweep_hold_its_first_and_last() {
    let values: Vec<f64> = (0..2000).map(f64::from).collect();
    let sweep = sweep(Combine::Cartesian, &[("solver.t_end", &values)]);
    for (most, points) in [(1, &[0][..]), (2, &[0, 1999]), (3, &[0, 999, 1999])] {
        assert_eq!(sweep.evenly_spread(most).collect::<Vec<_>>(), points, "{most}");
    }
    assert!(sweep.evenly_spread(3000).eq(0..2000));
}

#[test]
fn reading_scenes_for_their_warnings_can_be_stopped() {
    let axes: Vec<f64> = (1..=50).map(|size| f64::from(size) * 0.1).collect();
    let sweep = sweep(Combine::Cartesian, &[("excitation.horizontal.amplitude_g", &axes)]);
    let mut reads = 0;
    sweep.warnings_observed(0..sweep.len(), 1000, || {
        reads += 1;
        if reads == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!(reads, 3);
}

/// Half of what opens the base moves nothing: each contact carries the weight above it.
#[test]
fn the_smallest_normal_force_is_a_share_of_the_weight_above_its_own_interface() {
    let axes: [(&str, &[f64]); 2] = [("column.blocks", &[2.0]), ("excitation.horizontal.amplitude_uplift", &[0.5])];
    let sweep = Sweep { ask: Ask::Validity, ..sweep(Combine::Cartesian, &axes) };
    let needs = sweep.row(0).result.expect("a run").needs.expect("asked for");
    assert!((needs.min_normal - 1.0).abs() < 1e-12, "{needs:?}");
}

#[test]
fn a_verdict_that_is_not_determined_has_no_demand() {
    let sweep = sweep(Combine::Cartesian, &[("excitation.horizontal.amplitude_uplift", &[2.0])]);
    let mut outcome = sweep.row(0).result.expect("a run");
    let peak = Some(outcome.peaks[0]);
    let expected = [(Degree::Determined, peak), (Degree::Likely, peak), (Degree::NotDetermined, None)];
    for (trust, demand) in expected.map(|(trust, demand)| (Some(trust), demand)).into_iter().chain([(None, peak)]) {
        outcome.trust = trust;
        assert_eq!(outcome.demand(), demand, "{trust:?}");
    }
}
