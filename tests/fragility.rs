//! Fragility on made-up data: against closed forms, a search by brute force, and statsmodels.

use crate::common::random::Random;
use rocking::Fate;
use rocking::studies::probit::{Maximum, Probit, Trial, fit};
use rocking::studies::{Fit, Fragility, FragilityOptions, LimitState, Observation, fractile};
use statrs::distribution::ContinuousCDF;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Twenty runs at each of fifteen levels.
fn stripes() -> Vec<Trial> {
    let reached = [0, 0, 1, 2, 4, 7, 9, 12, 13, 16, 17, 19, 18, 20, 20];
    let level = |step: usize| (step + 1) as f64 / 10.0;
    reached
        .iter()
        .enumerate()
        .map(|(step, k)| Trial { level: level(step), runs: 20.0, reached: f64::from(*k) })
        .collect()
}

/// Sixty runs, each at a level of its own.
fn cloud() -> Vec<Trial> {
    let trial = |i: i32| {
        let reached = i * 37 % 61 < i + 2;
        Trial { level: 0.05 * 1.07_f64.powi(i), runs: 1.0, reached: f64::from(u8::from(reached)) }
    };
    (0..60).map(trial).collect()
}

fn curve(trials: &[Trial]) -> Probit {
    match fit(trials) {
        Maximum::Curve(curve) => curve,
        other => panic!("a curve: {other:?}"),
    }
}

/// Median, dispersion and log-likelihood by `tests/fragility.py` with Python 3.11, numpy 2.4.6 and statsmodels 0.15.0.
const STATSMODELS: [[f64; 3]; 2] = [
    [0.7016452292054247, 0.40936475577728054, -105.4024825382341],
    [0.3344385074643372, 1.7321913499029047, -34.12560672929881],
];

#[track_caller]
fn agrees(found: &Probit, [median, dispersion, log_likelihood]: [f64; 3]) {
    // statsmodels stops where its deviance changes by less than 1e-14 of it: the parameters are good to the root of that times a few.
    assert!((found.median() / median - 1.0).abs() < 1e-6, "{} and {median}", found.median());
    assert!((found.dispersion() / dispersion - 1.0).abs() < 1e-6, "{} and {dispersion}", found.dispersion());
    assert!(
        (found.log_likelihood / log_likelihood - 1.0).abs() < 1e-12,
        "{} and {log_likelihood}",
        found.log_likelihood
    );
}

#[test]
fn validation_curves_are_those_of_statsmodels() {
    agrees(&curve(&stripes()), STATSMODELS[0]);
    agrees(&curve(&cloud()), STATSMODELS[1]);
}

/// The same where Python and statsmodels are installed; `ROCKING_PYTHON` names another interpreter.
#[test]
fn validation_curves_are_those_of_statsmodels_if_it_is_installed() {
    let python = std::env::var("ROCKING_PYTHON").unwrap_or("python3".into());
    let has = Command::new(&python).args(["-c", "import statsmodels.api"]).stderr(Stdio::null()).status();
    if !has.is_ok_and(|status| status.success()) {
        eprintln!("{python} has no statsmodels: nothing is compared");
        return;
    }
    let line = |trial: &Trial| format!("{:?} {} {}", trial.level, trial.runs, trial.reached);
    let block = |trials: Vec<Trial>| trials.iter().map(line).collect::<Vec<_>>().join("\n");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fragility.py");
    let mut child = Command::new(&python)
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("it has just run");
    let text = [block(stripes()), block(cloud())].join("\n\n");
    child.stdin.take().expect("piped").write_all(text.as_bytes()).expect("written");
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).expect("numbers");
    for (line, trials) in text.lines().zip([stripes(), cloud()]) {
        let numbers: Vec<f64> = line.split_whitespace().map(|number| number.parse().expect("a number")).collect();
        agrees(&curve(&trials), [numbers[0], numbers[1], numbers[2]]);
    }
    assert_eq!(text.lines().count(), 2);
}

/// `ln L` at a median and a dispersion, by Simpson's rule for Φ: no formula shared with the library.
fn log_likelihood(trials: &[Trial], median: f64, dispersion: f64) -> f64 {
    let normal = |z: f64| {
        let density = |x: f64| (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let h = z / 400.0;
        let weight = |k: i32| match k {
            0 | 400 => 1.0,
            k if k % 2 == 1 => 4.0,
            _ => 2.0,
        };
        0.5 + h / 3.0 * (0..=400).map(|k| weight(k) * density(f64::from(k) * h)).sum::<f64>()
    };
    let term = |trial: &Trial| {
        let p = normal((trial.level / median).ln() / dispersion);
        let part = |count: f64, p: f64| if count > 0.0 { count * p.max(1e-300).ln() } else { 0.0 };
        part(trial.reached, p) + part(trial.runs - trial.reached, 1.0 - p)
    };
    trials.iter().map(term).sum()
}

/// No neighbour of the maximum is more likely, near or far.
#[test]
fn no_other_curve_is_more_likely() {
    for trials in [stripes(), cloud()] {
        let found = curve(&trials);
        let best = log_likelihood(&trials, found.median(), found.dispersion());
        assert!((best / found.log_likelihood - 1.0).abs() < 1e-9);
        for i in -20..=20 {
            for j in -20..=20 {
                for size in [1e-3, 0.05] {
                    let (median, dispersion) = (
                        found.median() * (size * f64::from(i)).exp(),
                        found.dispersion() * (size * f64::from(j)).exp(),
                    );
                    let other = log_likelihood(&trials, median, dispersion);
                    assert!(other <= best + 1e-9, "{median} {dispersion}: {other} above {best}");
                }
            }
        }
    }
}

/// Two levels at equal distance of the median have the closed form `θ = √(x₁ x₂)`, `β = ln(x₂/x₁) / 2 z`.
#[test]
fn two_levels_have_a_closed_form() {
    let run = |record: usize, level: f64, lost: bool| Observation {
        record: format!("{record}"),
        level,
        fate: Some(if lost { Fate::Overturns } else { Fate::Rocks }),
        has_uplift: true,
        peaks: vec![0.4],
        residual_slides: Vec::new(),
    };
    let runs: Vec<Observation> =
        (0..20).flat_map(|record| [run(record, 0.3, record < 4), run(record, 1.2, record < 16)]).collect();
    let found = Fragility::of(&runs, LimitState::Overturned, &FragilityOptions::default());
    let Fit::Lognormal { median, dispersion, .. } = found.fit else { panic!("a curve") };
    // Φ⁻¹(0.8).
    let z = 0.841_621_233_572_914_3;
    assert!((median - 0.6).abs() < 1e-12);
    assert!((dispersion - 4f64.ln() / (2.0 * z)).abs() < 1e-12);
    let goodness = found.goodness.expect("of a curve");
    // Two parameters go through two points: nothing is left over, and nothing is tested.
    assert!(goodness.chi_squared < 1e-20 && goodness.p_value.is_none(), "{goodness:?}");
    // All rock: the share of uplift is one at both levels.
    let uplift = Fragility::of(&runs, LimitState::Uplift, &FragilityOptions::default());
    assert_eq!(uplift.fit, Fit::Always { from: 0.3 });
    assert_eq!(uplift.statements(), ["no curve: every run reaches the state from 0.3 on; begin lower"]);
}

/// Forty records at levels around 0.5, and far from them a level at which one record does what the curve excludes: the fit is as bad on either side.
#[test]
fn a_stripe_far_above_the_median_contradicts_the_curve_as_much_as_one_far_below() {
    let near: Vec<f64> = (0..60).map(|step| 0.35 * (0.75f64 / 0.35).powf(f64::from(step) / 59.0)).collect();
    let goodness = |far: f64, mirrored: bool| {
        let reached =
            |level: f64| (40.0 * 0.5 * libm::erfc(-(level / 0.5).ln() / 0.1 / std::f64::consts::SQRT_2)).round();
        let stripe = |level: f64, reached: f64| {
            (0..40).map(move |record| Observation {
                record: format!("{record}"),
                level: if mirrored { 0.25 / level } else { level },
                fate: Some(if (f64::from(record) < reached) != mirrored { Fate::Overturns } else { Fate::Rocks }),
                has_uplift: true,
                peaks: vec![0.4],
                residual_slides: Vec::new(),
            })
        };
        let runs: Vec<Observation> =
            near.iter().flat_map(|level| stripe(*level, reached(*level))).chain(stripe(far, 39.0)).collect();
        Fragility::of(&runs, LimitState::Overturned, &FragilityOptions::default()).goodness.expect("a curve")
    };
    let [above, below] = [false, true].map(|mirrored| goodness(3.0, mirrored));
    assert!(above.chi_squared > 1e30 && above.p_value == Some(0.0), "{above:?}");
    assert!((above.chi_squared / below.chi_squared - 1.0).abs() < 1e-6, "{above:?} {below:?}");
}

/// A record that overturns at a level and stands above it: said, with the raw shares, and undecided runs are counted apart.
#[test]
fn what_is_not_monotonic_is_said() {
    let fate = |record: usize, level: usize| match (record, level) {
        (0, 2) => Fate::Overturns,
        (1, 3) => Fate::Undetermined,
        (_, level) if level >= 3 + record % 3 => Fate::Overturns,
        _ => Fate::Rocks,
    };
    let runs: Vec<Observation> = (0..6)
        .flat_map(|record| (1..=5).map(move |level| (record, level)))
        .map(|(record, level)| Observation {
            record: format!("r{record}"),
            level: level as f64,
            fate: Some(if (record, level) == (0, 3) { Fate::Rocks } else { fate(record, level) }),
            has_uplift: true,
            peaks: vec![0.5],
            residual_slides: Vec::new(),
        })
        .collect();
    let found = Fragility::of(&runs, LimitState::Overturned, &FragilityOptions::default());
    assert_eq!(found.resurrections, ["r0"]);
    let counts: Vec<[usize; 3]> =
        found.counts.iter().map(|count| [count.runs, count.reached, count.undecided]).collect();
    assert_eq!(counts, [[6, 0, 0], [6, 1, 0], [5, 1, 1], [6, 4, 0], [6, 6, 0]]);
    assert_eq!(found.undecided(), 1);
    let told = found.statements().join("\n");
    assert!(told.contains("not monotonic") && told.contains("(r0)") && told.contains("1 undecided run(s)"), "{told}");
}

/// In binary, 0.07 times 100 is above 7.
#[test]
fn a_fractile_counts_no_value_more_for_rounding() {
    let values: Vec<f64> = (1..=100).map(f64::from).collect();
    assert!(0.07 * values.len() as f64 > 7.0);
    assert_eq!([0.07, 0.071].map(|share| fractile(&values, share)), [7.0, 8.0]);
}

/// A number that is nearly normal: the sum of twelve uniform numbers less six.
fn nearly_normal(random: &mut Random) -> f64 {
    (0..12).map(|_| random.within(0.0, 1.0)).sum::<f64>() - 6.0
}

/// A number of the normal distribution.
fn normal(random: &mut Random) -> f64 {
    statrs::distribution::Normal::standard().inverse_cdf(random.within(1e-12, 1.0))
}

/// How often bands of 90 % hold the truth: records whose capacities are lognormal, `draw` their logarithms, at levels in steps of 0.1 up to `levels` of them.
/// Returns the shares of sets whose bands hold median and dispersion, and of those that have bands.
fn coverage(records: usize, sets: usize, levels: u32, draw: fn(&mut Random) -> f64) -> [f64; 3] {
    let (median, dispersion) = (0.7, 0.4);
    let mut random = Random::new(records as u64);
    let mut held = [0.0; 3];
    for set in 0..sets {
        let capacities: Vec<f64> = (0..records).map(|_| median * (dispersion * draw(&mut random)).exp()).collect();
        let run = |record: usize, level: f64| Observation {
            record: format!("r{record:03}"),
            level,
            fate: Some(if level > capacities[record] { Fate::Overturns } else { Fate::Rocks }),
            has_uplift: true,
            peaks: vec![0.5],
            residual_slides: Vec::new(),
        };
        let levels = (1..=levels).map(|step| f64::from(step) / 10.0);
        let runs: Vec<Observation> = levels
            .flat_map(|level| (0..records).map(move |record| (record, level)))
            .map(|(record, level)| run(record, level))
            .collect();
        let mut options = FragilityOptions::default();
        (options.replicates, options.seed) = (200, set as u64);
        let found = Fragility::of(&runs, LimitState::Overturned, &options);
        let Some(bands) = found.bands else { continue };
        let holds = |band: Option<[f64; 2]>, truth: f64| {
            f64::from(u8::from(band.is_some_and(|[low, high]| low <= truth && truth <= high)))
        };
        held[0] += holds(bands.median, median);
        held[1] += holds(bands.dispersion, dispersion);
        held[2] += f64::from(u8::from(bands.median.is_some()));
    }
    held.map(|count| count / sets as f64)
}

/// With forty records the bands of 90 % hold the median nearly as often as they say. Percentiles of few records are too narrow, those of the
/// dispersion most: docs/book/fragility.md has the shares.
#[test]
fn bands_hold_the_truth_about_as_often_as_they_say() {
    let [median, dispersion, with_bands] = coverage(40, 200, 15, nearly_normal);
    println!("40 records: {median} {dispersion} {with_bands}");
    // ± 3 standard deviations of 200 sets at 90 % are 0.064.
    assert!(median > 0.83 && median < 0.97, "{median}");
    assert!(dispersion > 0.75 && dispersion < 0.97, "{dispersion}");
    assert_eq!(with_bands, 1.0);
}

/// The table of docs/book/fragility.md: `cargo test --release --test solver fragility:: -- --ignored --nocapture`.
#[test]
#[ignore = "a measurement of a minute"]
fn coverage_by_number_of_records() {
    for levels in [15, 30] {
        for records in [6, 10, 20, 40, 80] {
            let [median, dispersion, with_bands] = coverage(records, 1000, levels, normal);
            println!(
                "{levels} levels, {records} records: median {median}, dispersion {dispersion}, sets with bands {with_bands}"
            );
            assert!(median > 0.6 && with_bands > 0.8);
        }
    }
}

/// How often the p-value of a true curve is above 0.99 and below 0.05, where all runs are independent: docs/book/fragility.md has the shares.
#[test]
#[ignore = "a measurement of some seconds"]
fn p_values_of_true_curves() {
    let mut random = Random::new(1);
    for (median, dispersion) in [(0.876f64, 0.23), (0.5, 0.2)] {
        let (mut fitted, mut large, mut small) = (0.0, 0.0, 0.0);
        for _ in 0..1000 {
            let levels = (1..=15).map(|step| f64::from(step) / 10.0);
            let runs = levels.flat_map(|level| (0..20).map(move |run| (run, level)));
            let runs: Vec<Observation> = runs
                .map(|(run, level)| Observation {
                    record: format!("r{run:02}"),
                    level,
                    fate: Some(match normal(&mut random) < (level / median).ln() / dispersion {
                        true => Fate::Overturns,
                        false => Fate::Rocks,
                    }),
                    has_uplift: true,
                    peaks: vec![0.5],
                    residual_slides: Vec::new(),
                })
                .collect();
            let mut options = FragilityOptions::default();
            options.replicates = 0;
            let found = Fragility::of(&runs, LimitState::Overturned, &options);
            let Some(p) = found.goodness.and_then(|goodness| goodness.p_value) else { continue };
            fitted += 1.0;
            large += f64::from(u8::from(p > 0.99));
            small += f64::from(u8::from(p < 0.05));
        }
        println!(
            "median {median}, dispersion {dispersion}: {fitted} curves, p > 0.99 {}, p < 0.05 {}",
            large / fitted,
            small / fitted
        );
        assert!(fitted > 900.0 && small / fitted < 0.1);
    }
}
