//! Runs at every tolerance, method and code: how wrong, how long, how much work.

use crate::double::Double;
use crate::reference::{Reference, difference};
use rocking::program::Scalar;
use rocking::{DynamicsSource, EventKind, Method, Response, Scene, StopReason, Work, simulate};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Share of the relative tolerance that the absolute one is: angles of rocking columns are some hundredths of a radian.
const ATOL_OF_RTOL: f64 = 1e-3;

/// The methods that are compared: all but [`Method::Auto`], which stands for others.
pub const METHODS: [Method; 5] =
    [Method::Dop853, Method::DormandPrince54, Method::Taylor, Method::KuttaMerson, Method::RungeKutta4];

/// What is run, and how long each run is repeated.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Relative tolerances, loose to tight.
    pub tolerances: Vec<f64>,
    /// Those of the generic code but for DOP853, with which everything is compared.
    pub generic_tolerances: Vec<f64>,
    /// Steps of the method without step control `[s]`.
    pub steps: Vec<f64>,
    /// Those of the generic code.
    pub generic_steps: Vec<f64>,
    /// Time spent on one point.
    pub budget: Duration,
}

impl Plan {
    /// All of it: two to three minutes.
    pub fn full() -> Plan {
        Plan {
            tolerances: (3..=13).map(|digits| 10f64.powi(-digits)).collect(),
            generic_tolerances: vec![1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13],
            steps: vec![3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4],
            generic_steps: vec![3e-2, 3e-3, 3e-4],
            budget: Duration::from_millis(150),
        }
    }

    /// A few points: seconds.
    pub fn quick() -> Plan {
        Plan {
            tolerances: vec![1e-4, 1e-7, 1e-10, 1e-13],
            generic_tolerances: vec![1e-4, 1e-10],
            steps: vec![1e-2, 1e-3],
            generic_steps: vec![1e-2],
            budget: Duration::from_millis(5),
        }
    }
}

/// Generated or generic equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// By `rocking_codegen`.
    Generated,
    /// By hand, for any column.
    Generic,
}

impl Code {
    /// For tables.
    pub fn name(self) -> &'static str {
        match self {
            Code::Generated => "generated",
            Code::Generic => "generic",
        }
    }

    fn source(self) -> DynamicsSource {
        match self {
            Code::Generated => DynamicsSource::Generated,
            Code::Generic => DynamicsSource::Generic,
        }
    }
}

/// One scene solved one way.
#[derive(Clone, Debug)]
pub struct Point {
    /// Name of the scene.
    pub scene: &'static str,
    /// Integration method.
    pub method: Method,
    /// Whose equations.
    pub code: Code,
    /// Relative tolerance, or step `[s]` where the method has fixed steps.
    pub setting: f64,
    /// Largest error of an angle in a row `[rad]`; infinite if the run ended otherwise.
    pub angle_error: f64,
    /// Largest error of an impact's time `[s]`; NaN if other interfaces closed.
    pub time_error: f64,
    /// Largest error of a peak angle `[rad]`.
    pub peak_error: f64,
    /// Shortest time of a run `[µs]`.
    pub best: f64,
    /// Median time of a run `[µs]`.
    pub median: f64,
    /// Impacts of the run.
    pub impacts: usize,
    /// Steps and calls.
    pub work: Work,
}

fn with(scene: &Scene, method: Method, code: Code, setting: f64) -> Scene {
    let mut scene = scene.clone();
    (scene.options.method, scene.options.dynamics) = (method, code.source());
    match method {
        Method::RungeKutta4 => scene.options.step = setting,
        _ => (scene.options.rtol, scene.options.atol) = (setting, ATOL_OF_RTOL * setting),
    }
    scene
}

fn rows(response: &Response) -> Vec<Vec<Double>> {
    response.samples.iter().map(|row| row.theta.iter().map(|angle| Double::from_f64(*angle)).collect()).collect()
}

/// Errors of angles, impact times and peaks.
fn errors(response: &Response, reference: &Reference) -> [f64; 3] {
    let is_complete = response.samples.len() == reference.rows.len() && response.status != StopReason::Overturned;
    let angle = if is_complete { difference(&rows(response), &reference.rows) } else { f64::INFINITY };
    let impacts: Vec<_> = response.events.iter().filter(|event| event.kind == EventKind::Impact).collect();
    let closing = |event: &rocking::Event| -> Vec<usize> {
        match event.interfaces.is_empty() {
            true => event.interface.iter().map(|number| number - 1).collect(),
            false => event.interfaces.iter().map(|number| number - 1).collect(),
        }
    };
    let is_same = impacts.len() == reference.impacts.len()
        && impacts.iter().zip(&reference.impacts).all(|(event, exact)| closing(event) == exact.interfaces);
    let late = impacts
        .iter()
        .zip(&reference.impacts)
        .map(|(event, exact)| (Double::from_f64(event.t) - exact.t).value().abs());
    let time = if is_same { late.fold(0.0, f64::max) } else { f64::NAN };
    let off = response.peak_theta.iter().zip(&reference.peak);
    let off = off.map(|(peak, exact)| (Double::from_f64(*peak) - *exact).value().abs());
    [angle, time, off.fold(0.0, f64::max)]
}

/// All methods and both codes must tell the same story before anything is timed.
///
/// # Panics
/// If one does not.
pub fn check(name: &str, scene: &Scene, reference: &Reference) {
    for method in Method::ACCURATE {
        for code in [Code::Generated, Code::Generic] {
            let response = simulate(&with(scene, method, code, 1e-12)).expect("the scenes run at 1e-12");
            let what = format!("{name}, {} on {} equations", method.name(), code.name());
            assert_eq!(response.status, reference.status, "{what}");
            assert_eq!(response.impacts, reference.impacts.len(), "{what}");
            let [angle, ..] = errors(&response, reference);
            // Local errors of 1e-12 over hundreds of steps, grown by some tens.
            assert!(angle < 1e-9, "{what}: {angle:e} rad");
        }
    }
}

/// Runs a scene in every way of the plan.
pub fn sweep(name: &'static str, scene: &Scene, reference: &Reference, plan: &Plan) -> Vec<Point> {
    let mut points = Vec::new();
    for code in [Code::Generated, Code::Generic] {
        for method in METHODS {
            let settings = match (method, code) {
                (Method::RungeKutta4, Code::Generated) => &plan.steps,
                (Method::RungeKutta4, Code::Generic) => &plan.generic_steps,
                (Method::Dop853, _) | (_, Code::Generated) => &plan.tolerances,
                (_, Code::Generic) => &plan.generic_tolerances,
            };
            for &setting in settings {
                let scene = with(scene, method, code, setting);
                match simulate(&scene) {
                    Ok(response) => points.push(measure(name, &scene, &response, reference, (code, setting, plan))),
                    Err(error) => println!("{name}, {} at {setting:e}: {error}", method.name()),
                }
            }
        }
    }
    points
}

fn measure(
    name: &'static str,
    scene: &Scene,
    response: &Response,
    reference: &Reference,
    (code, setting, plan): (Code, f64, &Plan),
) -> Point {
    const FEWEST: usize = 3;
    let (mut times, begun) = (Vec::new(), Instant::now());
    while times.len() < FEWEST || begun.elapsed() < plan.budget {
        let now = Instant::now();
        let _ = black_box(simulate(black_box(scene)));
        times.push(now.elapsed().as_secs_f64() * 1e6);
    }
    times.sort_by(f64::total_cmp);
    let [angle_error, time_error, peak_error] = errors(response, reference);
    Point {
        scene: name,
        method: scene.options.method,
        code,
        setting,
        angle_error,
        time_error,
        peak_error,
        best: times[0],
        median: times[times.len() / 2],
        impacts: response.impacts,
        work: response.work,
    }
}

/// All points as CSV, with the circumstances of the runs.
pub fn csv(points: &[Point], columns: &str, circumstances: &str) -> String {
    let mut csv = String::from(
        "scene,method,dynamics,rtol_or_step,angle_error_rad,impact_time_error_s,peak_error_rad,best_us,median_us,impacts,\
         steps,rejected,repeated,rhs_calls,",
    );
    csv.push_str(&format!("{columns}\n"));
    for p in points {
        let Work { steps, rejected, repeated, rhs_calls, .. } = p.work;
        csv.push_str(&format!(
            "\"{}\",{},{},{:e},{:.3e},{:.3e},{:.3e},{:.2},{:.2},{},{steps},{rejected},{repeated},{rhs_calls},{circumstances}\n",
            p.scene,
            p.method.name(),
            p.code.name(),
            p.setting,
            p.angle_error,
            p.time_error,
            p.peak_error,
            p.best,
            p.median,
            p.impacts,
        ));
    }
    csv
}
