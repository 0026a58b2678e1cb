//! What contacts need (`rocking::validity`) does not depend on how long the stretches of a method are.

use crate::common::random::Random;
use rocking::{Block, Column, Method, Motion, Response, Scene, StopReason, simulate};

fn run(text: &str, method: Method) -> Response {
    let mut scene = Scene::from_toml(text, "scene.toml".as_ref()).expect("valid");
    scene.options.method = method;
    simulate(&scene).expect("it runs")
}

/// Vertical motion nearly cancels gravity, so that the friction demand has a narrow crest. Steps of Kutta and Merson are short; a program of another author
/// gave 0.440656, to six digits. Those with long steps are off by up to 5.3e-4; half as much again is allowed.
#[test]
fn demands_of_forces_are_those_of_short_steps() {
    let text = r#"
        [[block]]
        half_width = 0.33
        half_height = 1.09
        [[block]]
        half_width = 0.33
        half_height = 1.18
        [excitation.horizontal]
        kind = "sine-pulse"
        amplitude = 3.9
        omega = 12.2
        [excitation.vertical]
        kind = "harmonic"
        amplitude = 8.5
        omega = 13.8
        [solver]
        t_end = 3.0
    "#;
    let short = run(text, Method::KuttaMerson).friction_demand[0];
    assert!((short / 0.440656 - 1.0).abs() < 2e-6, "{short}");
    for method in [Method::Auto, Method::Taylor, Method::Dop853, Method::DormandPrince54] {
        let demand = run(text, method).friction_demand[0];
        assert!((demand / short - 1.0).abs() < 8e-4, "{method:?}: {demand} and {short}");
    }
}

/// A slender block turns little, and its forces vary with the angle's share of the slenderness: they are read in parts of the time `1/p`. Before, demands were off by
/// 5e-3.
#[test]
fn demands_of_a_slender_block_are_those_of_short_steps() {
    let text = r#"
        [[block]]
        half_width = 0.01
        half_height = 1.0
        [excitation.horizontal]
        kind = "sine-pulse"
        amplitude_uplift = 4.0
        omega_p = 0.5
        [excitation.vertical]
        kind = "cosine-pulse"
        amplitude = -4.905
        omega_p = 0.5
        [solver]
        t_end = 0.6
        rtol = 1e-9
    "#;
    let short = run(text, Method::KuttaMerson).friction_demand[0];
    for method in [Method::Auto, Method::Taylor, Method::Dop853, Method::DormandPrince54] {
        let demand = run(text, method).friction_demand[0];
        assert!((demand / short - 1.0).abs() < 6e-4, "{method:?}: {demand} and {short}");
    }
}

/// A rocking block whose weight vanishes by some 1e-5 of itself for a moment: whatever the tolerance, the account of the contact has the negative force that the
/// run reports, and a demand without bound. Parabolas that steps place elsewhere showed a force that stays positive.
#[test]
fn a_force_that_barely_vanishes_is_the_same_in_all_accounts() {
    for rtol in ["1e-7", "1e-9", "1e-11", "1e-13"] {
        let text = format!(
            "[[block]]\nhalf_width = 0.4\nhalf_height = 1.6\n[initial]\ntheta = [0.09725616036134274]\n[excitation.vertical]\n\
             kind = \"sine-pulse\"\namplitude = 9.809783583975609\nomega = 29.347052025328605\nstart = 0.7401153030786057\n\
             [solver]\nt_end = 3.0\nrtol = {rtol}\n"
        );
        let response = run(&text, Method::Auto);
        let contact = &response.validity.as_ref().expect("an account").contacts[0];
        assert!(response.min_normal_force[0] < 0.0, "{rtol}: {}", response.min_normal_force[0]);
        assert_eq!(contact.min_normal_force.value, response.min_normal_force[0], "{rtol}");
        assert!(contact.tension.time > 0.0 && response.friction_demand[0].is_infinite(), "{rtol}");
    }
}

/// Demands below 1, half of the columns with vertical motion as well. Measured: 2,954 demands, off by up to 5.7e-4.
#[test]
fn demands_of_random_columns_are_those_of_short_steps() {
    let (mut random, columns) = (Random::new(2), 2000);
    let (mut compared, mut worst) = (0, 0.0f64);
    for index in 0..columns {
        let block = |random: &mut Random| Block::rectangle(random.within(0.2, 0.6), random.within(0.4, 1.5), 1.0);
        let blocks = (0..1 + random.below(3)).map(|_| block(&mut random)).collect();
        let mut scene = Scene::new(Column::new(blocks, 9.81).expect("positive sizes"));
        let [amplitude, omega] = [random.within(2.0, 8.0), random.within(4.0, 14.0)];
        scene.excitation.horizontal = Some(Motion::SinePulse { amplitude, omega, start: 0.0 });
        let [amplitude, omega] = [random.within(1.0, 8.0), random.within(4.0, 20.0)];
        let vertical = Motion::Harmonic { amplitude, omega, start: 0.0, phase: 0.0 };
        scene.excitation.vertical = (index % 2 == 1).then_some(vertical);
        (scene.options.t_end, scene.options.rtol) = (3.0, 1e-9);
        let [long, short] = [Method::Auto, Method::KuttaMerson].map(|method| {
            scene.options.method = method;
            simulate(&scene).expect("it runs")
        });
        // Where rounding has parted the two runs, their demands are of different motions.
        if long.impacts != short.impacts || (long.t_final - short.t_final).abs() > 1e-6 {
            continue;
        }
        for (demand, expected) in long.friction_demand.iter().zip(&short.friction_demand).filter(|(_, own)| **own < 1.0)
        {
            compared += 1;
            worst = worst.max((demand / expected - 1.0).abs());
        }
    }
    println!("{compared} demands of {columns} columns, off by up to {worst:.1e}");
    assert!(compared > columns && worst < 8e-4, "{compared} demands, off by up to {worst}");
}

/// The column is past the point of no return from 1.168 s on: until then the second block swings over its balance and comes back, within one closed-form
/// swing of the default method, while the first one is past its own.
#[test]
fn the_point_of_no_return_is_found_within_long_swings() {
    let text = r#"
        gravity = 12.946757227654004
        [[block]]
        half_width = 0.3903050236760266
        half_height = 0.423671770546983
        [[block]]
        half_width = 0.4155842620564205
        half_height = 0.25458568039442464
        [[block]]
        half_width = 0.5246309061120017
        half_height = 0.678306594083881
        [excitation.horizontal]
        kind = "sum"
        [[excitation.horizontal.term]]
        kind = "cosine-pulse"
        amplitude = 7.880065525992035
        omega = 17.251416669479735
        start = 0.3619160145488641
        [[excitation.horizontal.term]]
        kind = "sine-pulse"
        amplitude = 8.829404792767127
        omega = 5.548191122949024
        [excitation.vertical]
        kind = "half-sine"
        amplitude = 5.182370602328585
        omega = 4.381231807264424
        start = 0.2978480837325374
        [solver]
        t_end = 2.848
    "#;
    for method in [Method::Auto, Method::Taylor, Method::KuttaMerson] {
        let validity = run(text, method).validity.expect("recorded");
        // As the other methods print them, to their last digits.
        assert!((validity.until - 1.16801).abs() < 1e-5, "{method:?}: {}", validity.until);
        let normal = validity.contacts[1].min_normal_force.value;
        assert!((normal - 22.55).abs() < 0.01, "{method:?}: {normal}");
    }
}

/// A block that falls in a free swing: only panels whose least normal force is within 2e-3 of the weight from zero are read in parts.
#[test]
fn a_fall_costs_few_contact_forces() {
    let text = r#"
        [column]
        blocks = 1
        half_width = 0.4
        half_height = 1.56
        [excitation.horizontal]
        kind = "sine-pulse"
        amplitude_uplift = 3
        omega_p = 5
    "#;
    let response = run(text, Method::Auto);
    assert_eq!((response.status, response.work.closed_form_swings), (StopReason::Overturned, 2));
    assert!(response.min_normal_force[0] < 0.0, "{}", response.min_normal_force[0]);
    assert!(response.work.force_calls < 200, "{}", response.work.force_calls);
}
