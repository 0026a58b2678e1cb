//! Contacts at their limits: jams of many blocks, corners at the ends of faces, openings that a method finds a little early.

use super::run;
use rocking::{Method, Response, Scene, StopReason};

fn scene(text: &str) -> Scene {
    Scene::from_toml(text, "scene.toml".as_ref()).expect("valid")
}

fn run_by(method: Method, text: &str) -> Response {
    let mut scene = scene(text);
    scene.options.method = method;
    run(&scene)
}

/// What impacts, and the ends of low hops and slides, take from the energy `[J]`.
fn losses(response: &Response) -> f64 {
    response.sliding.as_ref().expect("friction").impact_losses
}

/// With less kinetic than static friction, a slide is admissible where the column opens, and need not begin: by Dormand-Prince 8(5,3), which found the
/// opening a little early, the lower block slid by 29 mm.
#[test]
fn an_opening_begins_no_slide_that_need_not_begin() {
    let text = include_str!("jams_and_edges/opening.toml");
    for method in [Method::Auto, Method::Dop853, Method::DormandPrince54, Method::KuttaMerson, Method::RungeKutta4] {
        let response = run_by(method, text);
        assert_eq!(response.status, StopReason::Collapsed, "{method:?}");
        let slide = super::slide(&response, 0);
        // All methods but the first at their default tolerances, over 22 impacts.
        assert!((slide - 1.095_295_6e-3).abs() < 1e-8, "{method:?}: {slide}");
    }
}

/// The top block parts, and the contact below, which loses its force in the same instant, slides on: that was called a flight.
#[test]
fn a_contact_that_slides_on_without_force_does_not_part() {
    let response = run(&scene(include_str!("jams_and_edges/unloaded.toml")));
    let states =
        |states: &Option<rocking::joints::Joints>| states.as_ref().map(ToString::to_string).unwrap_or_default();
    let event = response.events.iter().find(|event| states(&event.states_after) == "(-,-<,f)").expect("it slides");
    assert_eq!((states(&event.states_before).as_str(), event.kind), ("(-,-,f)", rocking::EventKind::Slip));
}

/// Five and six blocks have more combinations of states than are tried one by one: the runs ended as undetermined.
#[test]
fn jams_of_many_blocks_have_an_answer() {
    for text in [include_str!("jams_and_edges/jam-5.toml"), include_str!("jams_and_edges/jam-6.toml")] {
        let response = run(&scene(text));
        assert_eq!(response.status, StopReason::EndOfTime);
        assert!(!response.sliding.as_ref().expect("friction").jammed.is_empty());
        assert!(losses(&response) > 0.0, "{}", losses(&response));
    }
}

/// Steps that follow the forces of light blocks into a jam become shorter than times are resolved: the run failed without results.
#[test]
fn light_blocks_jam_without_failing() {
    let text = include_str!("jams_and_edges/jam-7.toml");
    let jams = |method| run_by(method, text).sliding.expect("friction").jammed;
    let [series, steps] = [Method::Auto, Method::Dop853].map(jams);
    assert!((series[0] - steps[0]).abs() < 1e-6, "{series:?} {steps:?}");
}

/// A corner that began within a picometre of the end of its face passed it again and again at the same place.
#[test]
fn a_corner_passes_the_end_of_its_face_once() {
    let text = include_str!("jams_and_edges/edge.toml");
    let [series, steps] = [Method::Auto, Method::Dop853].map(|method| run_by(method, text));
    assert_eq!((series.status, steps.status), (StopReason::AtRest, StopReason::AtRest));
    assert!((series.t_final - steps.t_final).abs() < 1e-9, "{} {}", series.t_final, steps.t_final);
}

/// A slide whose rate is rounding, and which forces stop at once, has a stop: sampled guards found it where the slide had gone back for long, whereupon it
/// began anew, two thousand times.
#[test]
fn slides_that_stop_as_they_begin_stop_once() {
    let phases = |method: Method| {
        let response = run_by(method, include_str!("jams_and_edges/slow-slides.toml"));
        (response.events.len(), response.work.phases)
    };
    let (events, by_series) = phases(Method::Taylor);
    for method in [Method::Dop853, Method::RungeKutta4] {
        let (own, others) = phases(method);
        assert!(
            own.abs_diff(events) <= 5 && others.abs_diff(by_series) <= 10,
            "{own}, {events}: {others}, {by_series}"
        );
    }
}

/// Blocks that had parted and touched still were joined without an impulse, and a slide was turned from one face to another: either gave energy.
#[test]
fn jams_and_edges_give_no_energy() {
    for text in [include_str!("jams_and_edges/jam-energy.toml"), include_str!("jams_and_edges/edge-energy.toml")] {
        let response = run(&scene(text));
        assert_eq!(response.status, StopReason::EndOfTime);
        assert!(losses(&response) > 0.0, "{}", losses(&response));
    }
}

/// Four drums that turn alike while the ground takes their weight: at the first instant without weight, the states that follow last for nanoseconds. The run
/// went from one to the other without end, and was undetermined.
#[test]
fn drums_that_turn_alike_part_where_their_weight_is_taken() {
    let response = run_by(Method::Auto, include_str!("jams_and_edges/weightless.toml"));
    assert_eq!(response.status, StopReason::EndOfTime);
    assert!(response.sliding.expect("friction").jammed.is_empty());
}

/// The rounding of a normal impulse, times a coefficient of 1e6 and more, was an impulse along a face on which nothing pressed: blocks jammed, and runs were
/// undetermined. However large the coefficient, the motion is that of one that holds.
#[test]
fn huge_coefficients_are_as_large_ones() {
    let with = |mu: f64| {
        let text = include_str!("jams_and_edges/steep.toml").replace("1e4", &format!("{mu:e}"));
        let response = run(&scene(&text));
        assert_eq!(response.status, StopReason::EndOfTime, "{mu:e}");
        assert!(response.sliding.expect("friction").jammed.is_empty(), "{mu:e}");
        response.peak_theta
    };
    let large = with(1e4);
    for mu in [1e6, 1e7, 1e8] {
        for (angle, expected) in with(mu).iter().zip(&large) {
            // It differs by 2.2e-5/μ: what is held by two corners yields along the edge of their cones.
            assert!((angle - expected).abs() < 3e-9, "{mu:e}: {angle} {expected}");
        }
    }
}

/// Several faces meet where a coinciding corner is open by a microradian: five and six equal drums have more combinations of states than are tried one by one,
/// the search from what sticks finds none, and the runs were undetermined.
#[test]
fn faces_that_meet_beside_a_coinciding_corner_have_an_answer() {
    for text in [include_str!("jams_and_edges/drums-5.toml"), include_str!("jams_and_edges/drums-6.toml")] {
        for method in [Method::Auto, Method::Dop853] {
            let response = run_by(method, text);
            assert_eq!(response.status, StopReason::EndOfTime, "{method:?}");
            assert!(losses(&response) > 0.0, "{}", losses(&response));
        }
    }
}

/// Coinciding corners that slide outwards, where the upper face would have to pull, part: the interface is free. The state in which it pulls was taken, and
/// the run was undetermined.
#[test]
fn coinciding_corners_part_where_the_upper_face_would_pull() {
    let text = include_str!("jams_and_edges/outwards.toml");
    for method in [Method::Auto, Method::Dop853, Method::DormandPrince54] {
        let response = run_by(method, text);
        let states = |event: &rocking::response::Event| event.states_after.as_ref().map(ToString::to_string);
        let slip = response.events.iter().find(|event| event.t > 0.7).expect("it goes on");
        assert_eq!(states(slip).as_deref(), Some("(0<,+>u,f)"), "{method:?}");
        assert!((slip.t - 0.709_514).abs() < 1e-6, "{method:?}: {}", slip.t);
        assert_eq!(response.status, StopReason::Collapsed, "{method:?}");
    }
}

/// Hops and slides of a column that rocks on: at larger stick angles a slide that began slowly and slowed down reversed before its end was found. Its rate,
/// lost without the momentum, added energy 20,000 times: 22 kJ to a column that had 12 kJ to lose.
#[test]
fn larger_stick_angles_end_more_hops_and_add_no_energy() {
    let run_at = |stick_angle: &str| {
        let text = include_str!("jams_and_edges/stick-angle.toml");
        run(&scene(&text.replace("stick_angle = 1e-9", &format!("stick_angle = {stick_angle}"))))
    };
    let fine = run_at("1e-9");
    let end = |response: &Response| response.samples.last().expect("a row at the end").theta.clone();
    for stick_angle in ["1e-7", "3e-6", "1.34e-5", "1e-4"] {
        let coarse = run_at(stick_angle);
        assert_eq!(coarse.status, fine.status, "{stick_angle}");
        assert!(coarse.events.len() <= fine.events.len(), "{stick_angle}: {} events", coarse.events.len());
        let apart = end(&coarse).iter().zip(&end(&fine)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-4, "{stick_angle}: {apart} rad apart");
        assert!((losses(&coarse) - losses(&fine)).abs() < 0.2 * losses(&fine), "{stick_angle}: {}", losses(&coarse));
    }
}

/// A jam that a guard of forces or slides leads to is one event; each event of an instant begins where the one before has ended.
#[test]
fn jams_are_recorded_once() {
    let response = run(&scene(include_str!("jams_and_edges/two-jams.toml")));
    assert!(response.sliding.as_ref().is_some_and(|sliding| sliding.jammed.len() >= 2), "{:?}", response.sliding);
    let pairs = || response.events.windows(2).filter(|pair| pair[0].t == pair[1].t);
    let repeated = pairs().filter(|pair| pair[0].states_after != pair[1].states_before).count();
    assert!(pairs().count() > 0 && repeated == 0, "{repeated} of {}", pairs().count());
}

/// Columns let go from a small tilt: in their decaying chatter, directions of hops and slides far below the resolution allowed neither accelerations nor impulses,
/// and a quarter of such runs were undetermined. These hops and slides end.
#[test]
fn decaying_chatter_of_many_blocks_has_an_end() {
    for (heights, friction, tilt) in [
        (&[1.5, 1.0, 0.5, 1.5, 1.0, 0.5][..], 0.8, 0.02),
        (&[1.5, 1.0, 0.5, 1.5, 1.0, 0.5], 0.7, 0.005),
        (&[0.5, 1.0, 1.5, 0.5, 1.0], 2.0, 0.02),
    ] {
        let (lower, count) = (3, heights.len());
        let blocks: String =
            heights.iter().map(|height| format!("[[block]]\nhalf_width = 0.5\nhalf_height = {height}\n")).collect();
        let tilts: Vec<f64> = (0..count).map(|block| if block < lower { 0.0 } else { tilt }).collect();
        let text = format!("friction = {friction}\n{blocks}[initial]\ntheta = {tilts:?}\n[solver]\nt_end = 6.0\n");
        for method in [Method::Auto, Method::Dop853] {
            let response = run_by(method, &text);
            assert_ne!(response.status, StopReason::Undetermined, "{friction} {tilt} {method:?}");
            assert!(losses(&response) > 0.0, "{friction} {tilt} {method:?}: {}", losses(&response));
        }
    }
}

/// The states at an event, as text.
fn states_at(response: &Response, t: f64, within: f64) -> Vec<String> {
    let there = response.events.iter().filter(|event| (event.t - t).abs() < within);
    there.filter_map(|event| event.states_after.as_ref()).map(ToString::to_string).collect()
}

/// A contact that slides tips, found a little early in a long step: another contact began a slide that need not begin, and only where the run went on long
/// enough for that step.
#[test]
fn a_tip_of_a_contact_that_slides_on_begins_no_slide_elsewhere() {
    let mut scene = scene(include_str!("jams_and_edges/tip.toml"));
    for t_end in [0.7, 0.75, 1.2] {
        scene.options.t_end = t_end;
        assert_eq!(states_at(&run(&scene), 0.691_017_74, 1e-7), ["(-,0,-<u,+>u,0>)"], "{t_end}");
    }
}

/// The impact in which nothing slides has impulses that press and lie in their cones: it comes before one in which a contact parts.
#[test]
fn an_impact_that_sticks_comes_before_one_that_parts() {
    let response = run(&scene(include_str!("jams_and_edges/press.toml")));
    assert_eq!(states_at(&response, 0.432_250_726_94, 1e-10), ["(-,-,0,f)"]);
}

/// Flat drums of equal coefficients on a base that slides move with it: no more than kinetic friction is asked of them, less than static. They were said to
/// slide without an acceleration, and rounding decided which of them slid when the base stopped.
#[test]
fn drums_above_a_slide_of_the_same_coefficients_stick() {
    for blocks in 2..=6 {
        let text = format!(
            "friction = {{ static = 0.3, kinetic = 0.2 }}\n[column]\nblocks = {blocks}\nhalf_width = 2.0\nhalf_height = 1.0\n\
             [excitation.horizontal]\nkind = \"rectangular\"\namplitude_g = 0.4\nduration = 0.3\n[solver]\nt_end = 2.0\n"
        );
        for method in [Method::Auto, Method::Dop853] {
            let response = run_by(method, &text);
            let sliding = response.sliding.as_ref().expect("friction");
            assert_eq!(states_at(&response, 0.0, 1e-9), [format!("(0<{})", ",0".repeat(blocks - 1))], "{method:?}");
            let [base, others @ ..] = &sliding.way_slid[..] else { unreachable!("there are blocks") };
            // Newmark's way: 0.5 (A g) t² (A/μ - 1) with A = 0.4, μ = 0.2, t = 0.3 s.
            assert!((base - 0.5 * 0.4 * 9.81 * 0.09).abs() < 1e-10, "{base}");
            assert!(others.iter().all(|way| *way == 0.0), "{others:?}");
            assert!(sliding.times[1..].iter().all(|times| times.sliding == 0.0), "{method:?}");
        }
    }
}
