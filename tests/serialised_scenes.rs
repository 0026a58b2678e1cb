//! A scene that is written as JSON reads back as an equal scene, by the checks of its constructors.

use rocking::{Block, Column, DynamicsSource, Method, Motion, Record, Restitution, Scene, Wanted};

fn text(scene: &Scene) -> String {
    serde_json::to_string(scene).expect("JSON")
}

fn scene() -> Scene {
    let blocks = vec![Block::rectangle(0.4, 0.7, 2700.0), Block::with_mass(0.3, 1.0 / 3.0, 0.1)];
    let mut scene = Scene::new(Column::new(blocks, 9.81).expect("valid"));
    scene.title = "two \"blocks\"".into();
    scene.friction = Some(rocking::Friction::uniform(0.7));
    scene.restitution = Restitution::Factors(vec![0.1, 1.0 / 3.0]);
    scene.initial.theta = vec![1e-3, -2e-3];
    scene.options.t_end = 0.1 + 0.2;
    scene.options.method = Method::Dop853;
    scene.options.dynamics = DynamicsSource::Generic;
    scene.options.wanted = Wanted::Overturns;
    scene.output_dt = Some(0.1);
    let accel = (0..100).map(|sample| libm::sin(f64::from(sample) * 0.7) / 3.0).collect();
    let record = Record::new(accel, 0.01, 0.5).expect("a record").scaled(1.1).expect("finite").named("a.AT2");
    let pulse = Motion::TypeC { amplitude: 1.0 / 7.0, omega: 6.0, start: 0.1, cycles: 2 };
    scene.excitation.horizontal = Some(Motion::Sum { terms: vec![pulse.clone(), Motion::Record(record)] });
    scene.excitation.vertical = Some(pulse);
    scene
}

#[test]
fn a_scene_reads_back_as_an_equal_one() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("readable").path());
    let files = files.filter(|file| file.extension().is_some_and(|extension| extension == "toml"));
    let scenes: Vec<Scene> = files.map(|file| Scene::from_file(&file).expect("a scene")).collect();
    assert!(scenes.len() > 5);
    for scene in
        scenes.into_iter().chain([scene(), Scene::new(Column::equal_blocks(3, 0.4, 1.6, 1.0, 9.81).expect("valid"))])
    {
        let read: Scene = serde_json::from_str(&text(&scene)).expect("a scene");
        assert_eq!(read, scene);
        assert_eq!(read.check(), scene.check());
    }
}

#[test]
fn what_a_constructor_refuses_is_not_read() {
    let whole = text(&scene());
    for (from, to, problem) in [
        ("\"mass\":0.1", "\"mass\":-0.1", "mass = -0.1"),
        ("\"bottom_half_width\":0.3", "\"bottom_half_width\":0.0", "half_width = 0"),
        ("\"gravity\":9.81", "\"gravity\":0.0", "gravity = 0"),
        ("\"dt\":0.01", "\"dt\":-0.01", "interval"),
        ("\"friction\":{", "\"friktion\":{", "friktion"),
        ("\"generic\"", "\"six blocks\"", "six blocks"),
    ] {
        assert!(whole.contains(from), "{from}");
        let error = serde_json::from_str::<Scene>(&whole.replace(from, to)).expect_err(to).to_string();
        assert!(error.contains(problem), "{error}");
    }
}

#[test]
fn a_check_names_all_faults_once() {
    let whole =
        text(&scene()).replace("\"static\":[0.7]", "\"static\":[-1.0]").replace("\"theta\":[", "\"theta\":[7.0,");
    let mut scene: Scene = serde_json::from_str(&whole).expect("numbers");
    scene.options.t_end = -1.0;
    scene.options.rtol = f64::NAN;
    let errors = scene.check().expect_err("faults");
    let keys: Vec<&str> = errors.faults().iter().map(|fault| fault.key.as_str()).collect();
    assert_eq!(keys, ["solver.t_end", "solver.rtol", "friction.static", "initial.theta"]);
    assert_eq!(errors.to_string().lines().count(), 4, "{errors}");
}

/// Several faults of one motion, of both coefficients of friction, and all lists that are missing.
#[test]
fn a_check_goes_on_after_the_first_fault_of_a_kind() {
    let mut scene = scene();
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude: f64::NAN, omega: -1.0, start: f64::INFINITY });
    scene.excitation.vertical = Some(Motion::Sum {
        terms: vec![
            Motion::HalfSine { amplitude: 1.0, omega: 0.0, start: 0.0 },
            Motion::HalfSine { amplitude: f64::NAN, omega: 1.0, start: 0.0 },
        ],
    });
    scene.friction = Some(rocking::Friction::new(vec![-1.0], vec![f64::NAN]));
    scene.initial.x = vec![0.0; scene.column.len()];
    (scene.options.method, scene.options.step) = (Method::RungeKutta4, 1e-300);
    let errors = scene.check().expect_err("faults");
    let keys: Vec<&str> = errors.faults().iter().map(|fault| fault.key.as_str()).collect();
    for key in [
        "friction.static",
        "friction.kinetic",
        "solver.step",
        "excitation.horizontal.amplitude",
        "excitation.horizontal.omega",
        "excitation.horizontal.start",
        "excitation.vertical.term[1].omega",
        "excitation.vertical.term[2].amplitude",
        "initial.y",
        "initial.vx",
        "initial.vy",
    ] {
        assert!(keys.contains(&key), "{key} is not among {keys:?}");
    }
}
