//! The goldens of the generator are code: compiled here, they run one and two blocks like the equations of this build.

use rocking::generated::Equations;
use rocking::{Column, DynamicsSource, Motion, Restitution, Scene, simulate};

#[allow(clippy::all, dead_code, missing_docs, unused_variables, reason = "generated code is laid out for reading")]
mod one {
    include!("../codegen/tests/golden/equations_1.txt");
}

#[allow(clippy::all, dead_code, missing_docs, unused_variables, reason = "generated code is laid out for reading")]
mod two {
    include!("../codegen/tests/golden/equations_2.txt");
}

#[test]
fn goldens_run() {
    for (blocks, equations) in [(1, one::EQUATIONS), (2, two::EQUATIONS)] {
        for vertical in [None, Some(Motion::SinePulse { amplitude: 3.0, omega: 15.0, start: 0.1 })] {
            let mut scene = Scene::new(Column::equal_blocks(blocks, 0.4, 1.56, 2700.0, 9.81).expect("valid"));
            scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: 7.0, omega: 10.7, start: 0.0 });
            scene.excitation.vertical = vertical;
            scene.restitution = Restitution::Eta(0.9);
            let run = |equations: Option<Equations>| {
                let mut scene = scene.clone();
                scene.options.dynamics = equations.map_or(DynamicsSource::Generated, DynamicsSource::Supplied);
                simulate(&scene).expect("solved")
            };
            let (golden, built) = (run(Some(equations)), run(None));
            assert!(!golden.used_generic && golden.impacts > 3);
            // The same text compiled twice: not a bit differs.
            assert_eq!(golden.events, built.events);
            assert_eq!(golden.peak_theta, built.peak_theta);
        }
    }
}
