//! Mutated scenes and damaged run folders: every command ends with status 0, 1 or 2, in little memory and within ten seconds of
//! processor time.

use crate::common::Folder;
use std::process::Stdio;
use std::time::{Duration, Instant};

const SCENE: &str = "title = \"fuzz\"
gravity = 9.81
friction = 0.7
[[block]]
half_width = 0.4
half_height = 0.8
density = 2700.0
[[block]]
half_width = 0.3
half_height = 0.7
mass = 900.0
[restitution]
eta = 0.9
[excitation.horizontal]
kind = \"sine-pulse\"
amplitude = 4.0
omega = 10.0
start = 0.1
[excitation.vertical]
kind = \"record\"
accel = [0.0, 1.0, -1.5, 0.5]
dt = 0.02
[initial]
theta = [0.0, 0.0]
[solver]
t_end = 1.0
rtol = 1e-6
[output]
dt = 0.02
";

/// Longest time a command may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Numbers that put arithmetic to the test.
const NUMBERS: [&str; 20] = [
    "0", "-0.0", "1", "-1", "2", "5e-324", "1e-100", "1e-15", "1e-12", "1e-9", "1e-6", "1e6", "1e12", "1e150",
    "-1e300", "1e308", "1e999", "nan", "inf", "\"x\"",
];

/// A generator of Lehmer's kind after Steele & Vigna (2021), 64 bits.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % end.max(1)
    }

    /// The text with some of its numbers, characters or lines changed.
    fn mutated(&mut self, text: &str) -> String {
        let mut text = text.to_string();
        for _ in 0..=self.below(2) {
            text = self.mutated_once(&text);
        }
        text
    }

    fn mutated_once(&mut self, text: &str) -> String {
        let lines: Vec<&str> = text.split('\n').collect();
        let line = self.below(lines.len());
        let mut changed: Vec<String> = lines.iter().map(ToString::to_string).collect();
        match self.below(10) {
            0 => drop(changed.remove(line)),
            1 => changed.insert(line, lines[self.below(lines.len())].into()),
            2 => changed.truncate(line),
            3 => {
                let mut signs: Vec<char> = lines[line].chars().collect();
                let place = self.below(signs.len() + 1);
                let sign = ['"', '[', '{', '}', '-', 'e', '9', '\u{1b}', ',', '.', '\u{feff}'][self.below(11)];
                signs.insert(place, sign);
                changed[line] = signs.into_iter().collect();
            }
            _ => {
                // A number somewhere: most mutations should pass the parser.
                let is_digit = |sign: &char| sign.is_ascii_digit() || ".-e+".contains(*sign);
                let signs: Vec<char> = text.chars().collect();
                let starts: Vec<usize> = (1..signs.len())
                    .filter(|place| {
                        signs[*place].is_ascii_digit()
                            && !is_digit(&signs[place - 1])
                            && !signs[place - 1].is_alphabetic()
                    })
                    .collect();
                if starts.is_empty() {
                    return text.into();
                }
                let start = starts[self.below(starts.len())];
                let end = start + signs[start..].iter().take_while(|sign| is_digit(sign)).count();
                let number = NUMBERS[self.below(NUMBERS.len())];
                return signs[..start].iter().chain(&number.chars().collect::<Vec<_>>()).chain(&signs[end..]).collect();
            }
        }
        changed.join("\n")
    }
}

/// Runs a command; what is wrong with its end, if anything.
fn fault(folder: &Folder, arguments: &str) -> Option<String> {
    let stderr = std::fs::File::create(folder.path("stderr")).expect("made");
    let mut child = folder.limited(arguments).stdout(Stdio::null()).stderr(stderr).spawn().expect("a shell");
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("a child") {
            break status;
        }
        if start.elapsed() > PATIENCE {
            child.kill().expect("killed");
            child.wait().expect("it ends");
            return Some(format!("{arguments:?} takes more than {PATIENCE:?}"));
        }
        std::thread::sleep(Duration::from_millis(1));
    };
    let message = std::fs::read_to_string(folder.path("stderr")).unwrap_or_default();
    let is_fine = matches!(status.code(), Some(0..=2)) && !message.contains("panicked");
    (!is_fine).then(|| format!("{arguments:?} ends with {status}: {message}"))
}

/// Runs so many inputs in four threads, half scenes and half folders; panics with all faults and the inputs that have them.
fn fuzz(inputs: usize, seed: u64) {
    println!("seed {seed}");
    let faults: Vec<String> = std::thread::scope(|scope| {
        let parts: Vec<_> = (0..4).map(|part| scope.spawn(move || faults(inputs / 4, 4 * seed + part))).collect();
        parts.into_iter().flat_map(|part| part.join().expect("a thread")).collect()
    });
    assert!(faults.is_empty(), "{} of {inputs} inputs:\n{}", faults.len(), faults.join("\n"));
}

/// The faults of so many inputs.
fn faults(inputs: usize, seed: u64) -> Vec<String> {
    let mut random = Random(seed);
    let folder = Folder::with("scene.toml", SCENE);
    folder.succeeds("run scene.toml --out run --quiet");
    let files = ["summary.json", "events.json", "response.csv"];
    let whole = files.map(|name| folder.read(&format!("run/{name}")));
    let mut faults = Vec::new();
    for input in 0..inputs {
        let (text, arguments) = if input % 2 == 0 {
            let text = random.mutated(SCENE);
            folder.write("scene.toml", &text);
            let command = [
                "run scene.toml --plots --report --quiet",
                "check scene.toml",
                "check scene.toml --json",
                "run scene.toml --json",
            ];
            (text, command[random.below(command.len())])
        } else {
            let file = random.below(files.len());
            let text = random.mutated(&whole[file]);
            for (place, name) in files.iter().enumerate() {
                let content = if place == file { &text } else { &whole[place] };
                folder.write(&format!("run/{name}"), content);
            }
            (text, ["plot run", "report run"][random.below(2)])
        };
        faults.extend(fault(&folder, arguments).map(|fault| {
            let shown: Vec<&str> = text
                .lines()
                .filter(|line| !whole.iter().any(|whole| whole.contains(line)) && !SCENE.contains(line))
                .collect();
            format!("input {input} of seed {seed}: {fault}\n{}\n", shown.join("\n"))
        }));
    }
    faults
}

#[test]
fn mutated_scenes_and_damaged_folders_end_with_a_status() {
    fuzz(2000, 25);
}

#[test]
#[ignore = "takes half an hour: as many inputs as ROCKING_FUZZ says, or 100,000"]
fn very_many_mutated_inputs_end_with_a_status() {
    let number =
        |name: &str, default: u64| std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default);
    fuzz(number("ROCKING_FUZZ", 100_000) as usize, number("ROCKING_SEED", 1));
}
