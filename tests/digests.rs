//! Every bit of the results of 5,192 runs, as digests: a change of the code that is to change no result changes none of them.
//!
//! `tests/digests/*.txt` have a line per run: its name, the digest of its numbers (rows, events, peaks, forces, times in modes,
//! separations, outcome) and the digest of its warnings. What a run cost (`Work`) is left out. `BLESS=1` writes the files anew: only a
//! commit that mends a bug does that, and says which.

use crate::common::random::Random;
use crate::common::reference;
use crate::common::stress;
use rocking::pattern::Pattern;
use rocking::scene_file::{Setting, Template};
use rocking::sweep::{Ask, Axis, Combine, Sweep};
use rocking::{DynamicsSource, Method, Response, Scene, simulate};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// FNV-1a over 64 bits (Fowler, Noll & Vo).
struct Digest(u64);

impl Digest {
    fn new() -> Digest {
        Digest(0xcbf2_9ce4_8422_2325)
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn text(&mut self, text: &str) {
        self.bytes(text.as_bytes());
        self.bytes(&[0]);
    }

    fn count(&mut self, count: usize) {
        self.bytes(&(count as u64).to_le_bytes());
    }

    fn numbers<'n>(&mut self, numbers: impl IntoIterator<Item = &'n f64>) {
        for number in numbers {
            self.bytes(&number.to_bits().to_le_bytes());
        }
        self.bytes(&[1]);
    }

    fn pattern(&mut self, pattern: &Pattern) {
        pattern.0.iter().for_each(|interface| self.bytes(&interface.sign().to_le_bytes()));
    }
}

/// Digests of the numbers and of the warnings of a response.
fn digests(response: &Response) -> [u64; 2] {
    let (mut numbers, mut words) = (Digest::new(), Digest::new());
    let own = &mut numbers;
    own.text(&serde_json::to_string(&response.status).expect("a name"));
    own.numbers([&response.t_final]);
    own.count(response.overturned_block.unwrap_or(0));
    own.count(response.impacts);
    own.count(response.samples.len());
    for sample in &response.samples {
        own.numbers([&sample.t]);
        own.numbers(sample.theta.iter().chain(&sample.omega).chain(&sample.ground));
        own.pattern(&sample.pattern);
    }
    own.count(response.events.len());
    for event in &response.events {
        own.numbers([&event.t]);
        own.text(&serde_json::to_string(&event.kind).expect("a name"));
        own.count(event.interface.unwrap_or(0));
        event.interfaces.iter().for_each(|interface| own.count(*interface));
        own.pattern(&event.before);
        own.pattern(&event.after);
        own.text(&event.mode_before.to_string());
        own.text(&event.mode.to_string());
        own.count(usize::from(event.mirrored));
        own.numbers(event.theta.iter().chain(&event.omega_before).chain(&event.omega_after));
        own.numbers(&event.energy_lost);
        for impulse in &event.impulses {
            own.numbers([&impulse.normal, &impulse.tangential, &impulse.moment]);
        }
    }
    own.numbers(&response.peak_theta);
    own.numbers(&response.friction_demand);
    own.numbers(&response.min_normal_force);
    // In the order of their texts, as these digests have always had them.
    let times: BTreeMap<String, &f64> =
        response.time_in_mode.iter().map(|(mode, time)| (mode.to_string(), time)).collect();
    for (mode, time) in times {
        own.text(&mode);
        own.numbers([time]);
    }
    for separation in &response.separations {
        own.numbers([&separation.t]);
        own.text(&serde_json::to_string(&separation.during).expect("a name"));
    }
    response.warnings().iter().for_each(|warning| words.text(warning));
    [numbers.0, words.0]
}

/// The line of a run; an error counts as words.
fn line(name: &str, scene: &Scene) -> String {
    let [numbers, words] = simulate(scene).map_or_else(
        |error| {
            let mut words = Digest::new();
            words.text(&error.to_string());
            [0, words.0]
        },
        |response| digests(&response),
    );
    format!("{name} {numbers:016x} {words:016x}")
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Lines of runs, on all threads, in order.
fn lines(scenes: impl IntoIterator<Item = (String, Scene)>) -> Vec<String> {
    use rayon::prelude::*;
    let scenes: Vec<_> = scenes.into_iter().collect();
    scenes.par_iter().map(|(name, scene)| line(name, scene)).collect()
}

/// Compares with the committed file, or writes it.
fn hold(name: &str, lines: &[String]) {
    let file = root().join("tests/digests").join(format!("{name}.txt"));
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&file, lines.join("\n") + "\n").expect("writable");
    }
    let committed = std::fs::read_to_string(&file).expect("it is committed");
    let committed: Vec<&str> = committed.lines().collect();
    assert_eq!(committed.len(), lines.len(), "{}: number of runs", file.display());
    let changed: Vec<&String> =
        lines.iter().zip(&committed).filter(|(own, committed)| own != *committed).map(|(own, _)| own).collect();
    let first = &changed[..changed.len().min(20)];
    assert!(
        changed.is_empty(),
        "{}: {} of {} runs have changed: {first:#?}",
        file.display(),
        changed.len(),
        lines.len()
    );
}

/// The methods in the order of the committed files.
const METHODS: [Method; 6] =
    [Method::Auto, Method::Dop853, Method::DormandPrince54, Method::Taylor, Method::KuttaMerson, Method::RungeKutta4];

/// Every method and both sources of equations.
fn variants(name: &str, scene: &Scene) -> Vec<(String, Scene)> {
    let mut variants = Vec::new();
    for method in METHODS {
        for dynamics in [DynamicsSource::Generated, DynamicsSource::Generic] {
            let mut scene = scene.clone();
            (scene.options.method, scene.options.dynamics) = (method, dynamics);
            let source = if dynamics == DynamicsSource::Generic { "generic" } else { "generated" };
            variants.push((format!("{name} {} {source}", method.name()), scene));
        }
    }
    variants
}

fn sorted(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    files.retain(|path| path.extension().is_some_and(|own| own == extension));
    files.sort();
    files
}

fn stem(path: &Path) -> String {
    path.file_stem().expect("a file").to_string_lossy().into_owned()
}

#[test]
fn shipped_scenes_give_what_they_gave() {
    let scene = |path: PathBuf| variants(&stem(&path), &Scene::from_file(&path).expect("valid"));
    hold("scenes", &lines(sorted(&root().join("scenes"), "toml").into_iter().flat_map(scene)));
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn reference_runs_give_what_they_gave() {
    let folder = root().join("../shared/reference");
    let scene = |path: PathBuf| {
        let run: Value = serde_json::from_str(&std::fs::read_to_string(&path).expect("readable")).expect("JSON");
        variants(&stem(&path), &Scene::from_toml(&reference::scene(&run, ""), &path).expect("valid"))
    };
    hold("references", &lines(sorted(&folder, "json").into_iter().flat_map(scene)));
}

/// Hostile scenes of up to eight blocks, a method after the other.
#[test]
fn random_scenes_give_what_they_gave() {
    let scene = |seed: u64| {
        let mut scene = stress::scene(seed);
        scene.options.method = METHODS[(seed % 6) as usize];
        // The fixed step of the classic method: of the size of the others' steps.
        scene.options.step = 1e-3 * scene.options.t_end;
        (format!("{seed} {}", scene.options.method.name()), scene)
    };
    hold("random", &lines((0..1600).map(scene)));
}

/// What an engineer runs: one to four drums of ordinary sizes under synthetic records and pulses for 12 s, with the default method.
fn everyday(seed: u64) -> Scene {
    let random = &mut Random::new(0xe5e5 + seed);
    let (blocks, slenderness) = ([1, 1, 2, 3, 4][random.below(5)], random.within(0.12, 0.4));
    let half_height = random.within(0.5, 3.0);
    let mut text = format!(
        "[column]\nblocks = {blocks}\nhalf_width = {}\nhalf_height = {half_height}\n",
        half_height * libm::tan(slenderness)
    );
    if random.once_in(2) {
        let _ = writeln!(text, "[restitution]\neta = {}", random.within(0.8, 1.0));
    }
    let pga = slenderness * random.within(0.8, 4.0);
    let motion = |random: &mut Random, size: f64| match random.below(4) {
        0 => format!("kind = \"sine-pulse\"\namplitude_g = {size}\nomega = {}\n", random.within(1.0, 15.0)),
        1 => format!("kind = \"ricker\"\namplitude_g = {size}\nomega = {}\n", random.within(2.0, 15.0)),
        _ => format!("kind = \"synthetic\"\npga_g = {size}\nseed = {}\nduration = 8.0\n", random.below(1000)),
    };
    let _ = write!(text, "[excitation.horizontal]\n{}", motion(random, pga));
    if random.once_in(3) {
        let _ = write!(text, "[excitation.vertical]\n{}", motion(random, 0.5 * pga));
    }
    let rtol = [1e-4, 1e-6, 1e-9, 1e-12][random.below(4)];
    let _ = write!(text, "[solver]\nt_end = 12.0\nrtol = {rtol:e}\natol = {:e}\n[output]\ndt = 0.02\n", 1e-3 * rtol);
    let mut scene = Scene::from_toml(&text, "everyday.toml".as_ref()).expect("valid");
    scene.options.record_forces = !random.once_in(3);
    if random.once_in(4) {
        scene.output_dt = None;
    }
    scene
}

#[test]
fn everyday_scenes_give_what_they_gave() {
    hold("everyday", &lines((0..400).map(|seed| (seed.to_string(), everyday(seed)))));
}

#[test]
fn sweeps_give_what_they_gave() {
    let axis = |key: &str, values: &[f64]| Axis {
        key: key.into(),
        values: values.iter().map(|value| Setting::Number(*value)).collect(),
    };
    let spread = |from: f64, step: f64, count: usize| (0..count).map(|i| from + step * i as f64).collect::<Vec<_>>();
    let pulses = [
        axis("column.blocks", &[1.0, 2.0, 3.0, 5.0]),
        axis("excitation.horizontal.omega_p", &spread(0.5, 0.75, 12)),
        axis("excitation.horizontal.amplitude_uplift", &spread(0.5, 0.8, 16)),
    ];
    let records = [
        axis("column.blocks", &[1.0, 2.0]),
        axis("excitation.horizontal.seed", &spread(1.0, 1.0, 10)),
        axis("excitation.horizontal.pga_g", &spread(0.1, 0.15, 8)),
    ];
    let mut lines = Vec::new();
    for (file, axes) in [("scenes/sweeps/column.toml", &pulses), ("tests/digests/record.toml", &records)] {
        for ask in [Ask::Outcome, Ask::Overturns, Ask::Peaks] {
            let template = Template::from_file(&root().join(file)).expect("a scene");
            let sweep = Sweep { template, axes: axes.to_vec(), combine: Combine::Cartesian, ask };
            for row in sweep.rows(0..sweep.len()) {
                let (mut numbers, mut words) = (Digest::new(), Digest::new());
                match &row.result {
                    Ok(outcome) => {
                        numbers.text(outcome.fate.name());
                        numbers.count(outcome.impacts);
                        numbers.count(outcome.block.unwrap_or(0));
                        numbers.numbers(&outcome.overturned_at);
                        numbers.numbers(&outcome.peaks);
                        numbers.text(outcome.last_mode.as_deref().unwrap_or_default());
                    }
                    Err(error) => words.text(&error.to_string()),
                }
                lines.push(format!(
                    "{} {ask:?} {} {:016x} {:016x}",
                    stem(file.as_ref()),
                    row.index,
                    numbers.0,
                    words.0
                ));
            }
        }
    }
    hold("sweeps", &lines);
}
