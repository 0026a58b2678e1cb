//! Contenders of one scene: their answers are checked, then they are timed in turn.
//!
//! A time is the median over [`ROUNDS`] rounds of the mean of some milliseconds of runs; in each round every contender has its
//! turn, so that a machine that is slow for a while is slow for all. What biases the figures: caches and branch predictors are
//! warm; heyoka and SciPy are charged for the interpreter that drives them, not for compiling their equations; whole runs of
//! ours include all set-up of a scene and a list of events with patterns, rates and impulses, the peers' no more than times and
//! angles. Errors fall unevenly between tolerances, some by luck.

use std::hint::black_box;
use std::time::Instant;

/// What a run finds: times of impacts `[s]`, then angles at the end `[rad]`. Nothing if the program gives up.
pub type Answer = Vec<f64>;

/// Odd, so that the median is one of them.
const ROUNDS: usize = 25;

/// Length of a turn `[s]`: long against the clock's resolution and the noise of one run.
const TURN: f64 = 2e-3;

/// An answer of ours at its tightest that is further off `[s]`, `[rad]` is wrong.
const TRUSTED: f64 = 1e-9;

/// An answer that is further off `[s]`, `[rad]` is not one.
const USELESS: f64 = 0.1;

/// A program with its method and setting, ready to run.
pub struct Contender<'a> {
    /// Who, with the language that drives it: `rocking`, `heyoka (Python)`.
    pub program: &'static str,
    /// Its integrator.
    pub method: &'static str,
    /// Relative tolerance, or step `[s]`.
    pub setting: f64,
    answer: Box<dyn Fn() -> Answer + 'a>,
    time: Box<dyn Fn(usize) -> f64 + 'a>,
}

/// The name under which our times are.
pub const OURS: &str = "rocking";

impl<'a> Contender<'a> {
    /// One that is compiled in: `work` is timed, `answer` is the same work with what is compared made of it.
    pub fn compiled<T>(
        program: &'static str,
        method: &'static str,
        setting: f64,
        answer: impl Fn() -> Answer + 'a,
        work: impl Fn() -> T + 'a,
    ) -> Contender<'a> {
        let time = move |runs| {
            let start = Instant::now();
            for _ in 0..runs {
                black_box(work());
            }
            start.elapsed().as_secs_f64()
        };
        Contender { program, method, setting, answer: Box::new(answer), time: Box::new(time) }
    }

    /// As [`Contender::compiled`] where the answer is what is timed, or `None`.
    pub fn plain(
        program: &'static str,
        method: &'static str,
        setting: f64,
        work: impl Fn() -> Option<Answer> + Copy + 'a,
    ) -> Contender<'a> {
        Contender::compiled(program, method, setting, move || work().unwrap_or_default(), work)
    }

    /// One that times so many runs itself `[s]`.
    pub fn distant(
        program: &'static str,
        method: &'static str,
        setting: f64,
        answer: impl Fn() -> Answer + 'a,
        time: impl Fn(usize) -> f64 + 'a,
    ) -> Contender<'a> {
        Contender { program, method, setting, answer: Box::new(answer), time: Box::new(time) }
    }
}

/// What a contender reached, and in which time.
#[derive(Clone, Debug)]
pub struct Point {
    /// The scene's name.
    pub scene: &'static str,
    /// As in [`Contender`].
    pub program: &'static str,
    /// As in [`Contender`].
    pub method: &'static str,
    /// As in [`Contender`].
    pub setting: f64,
    /// Largest error of an impact's time `[s]` or an angle at the end `[rad]`.
    pub error: f64,
    /// Time of a run `[s]`.
    pub time: f64,
}

/// Checks all contenders against the reference and times them.
///
/// # Panics
/// If no answer of ours is right.
pub fn contest(scene: &'static str, reference: &[f64], contenders: &[Contender]) -> Vec<Point> {
    let mut points = Vec::new();
    let mut running = Vec::new();
    for contender in contenders {
        let Contender { program, method, setting, .. } = *contender;
        let answer = (contender.answer)();
        let error = error(&answer, reference);
        if error.is_nan() || error > USELESS {
            println!("{scene}: {program} {method} {setting:e} has another answer, {} numbers", answer.len());
            continue;
        }
        points.push(Point { scene, program, method, setting, error, time: f64::NAN });
        running.push((contender, answer));
    }
    let ours = points.iter().filter(|point| point.program == OURS).map(|point| point.error);
    assert!(ours.fold(f64::INFINITY, f64::min) < TRUSTED, "{scene}: none of our answers is right");

    let turns: Vec<usize> = running.iter().map(|(contender, _)| runs_of_a_turn(contender)).collect();
    let mut times = vec![Vec::new(); points.len()];
    for _ in 0..ROUNDS {
        for (((contender, _), runs), times) in running.iter().zip(&turns).zip(&mut times) {
            times.push((contender.time)(*runs) / *runs as f64);
        }
    }
    for ((point, times), (contender, answer)) in points.iter_mut().zip(&mut times).zip(&running) {
        times.sort_by(f64::total_cmp);
        point.time = times[ROUNDS / 2];
        assert_eq!((contender.answer)(), *answer, "{} gives the same answer after being timed", point.program);
    }
    points
}

fn runs_of_a_turn(contender: &Contender) -> usize {
    let once = (contender.time)(1).min((contender.time)(1));
    ((TURN / once) as usize).clamp(1, 10_000)
}

/// Largest difference, NaN where something else happened.
fn error(answer: &[f64], reference: &[f64]) -> f64 {
    if answer.len() != reference.len() {
        return f64::NAN;
    }
    let differences = answer.iter().zip(reference).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, |most, own| if own.is_nan() { own } else { most.max(own) })
}
