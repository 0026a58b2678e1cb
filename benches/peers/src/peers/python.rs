//! Peers that live in Python: one interpreter for the whole run, spoken to in lines.
//!
//! `python/serve.py` answers `programs`, `answer …` and `time …`; numbers are told so that they read back exactly. The
//! interpreter is that of the environment variable `PEERS_PYTHON`, or `python3`.

use crate::contest::{Answer, Contender};
use std::cell::RefCell;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// The interpreter, if there is one, and which peers it has.
pub struct Python {
    line: Option<RefCell<Line>>,
    programs: Vec<String>,
}

struct Line {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
}

/// Names in the script and here, with who drives the program and its method.
const PROGRAMS: [(&str, &str, &str); 3] =
    [("heyoka", "heyoka (Python)", "taylor"), ("scipy", "SciPy", "dop853"), ("mujoco", "MuJoCo (Python)", "steps")];

impl Python {
    /// Starts it; says which peers it lacks.
    pub fn start() -> Python {
        let interpreter = std::env::var("PEERS_PYTHON").unwrap_or_else(|_| "python3".into());
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/python/serve.py");
        let child =
            Command::new(&interpreter).args(["-uB", script]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let line = child.ok().and_then(|mut child| {
            let (to, from) = (child.stdin.take()?, BufReader::new(child.stdout.take()?));
            Some(RefCell::new(Line { child, to, from }))
        });
        let mut python = Python { line, programs: Vec::new() };
        let programs = python.ask("programs");
        python.programs = programs.split_whitespace().map(String::from).collect();
        for (name, told, _) in PROGRAMS {
            if !python.programs.iter().any(|own| own == name) {
                println!("skipped: {told}, for want of {name} in {interpreter} (PEERS_PYTHON names another)");
            }
        }
        python
    }

    /// The answer to a line; empty if there is none.
    pub fn ask(&self, question: &str) -> String {
        let Some(line) = &self.line else { return String::new() };
        let Line { to, from, .. } = &mut *line.borrow_mut();
        let mut answer = String::new();
        let asked = writeln!(to, "{question}").and_then(|()| from.read_line(&mut answer));
        asked.map(|_| answer.trim().to_string()).unwrap_or_default()
    }

    /// Whether a program is there.
    pub fn has(&self, program: &str) -> bool {
        self.programs.iter().any(|own| own == program)
    }

    /// A program on a scene that the script knows, at several tolerances; none if it is absent. What stands after the scene's
    /// name is told to the script as it is.
    pub fn contenders<'p>(&'p self, program: &str, scene: &str, tolerances: &[f64]) -> Vec<Contender<'p>> {
        let known = PROGRAMS.iter().find(|(name, ..)| *name == program && self.has(name));
        let Some(&(name, told, method)) = known else { return Vec::new() };
        let contender = |&rtol: &f64| {
            let run = format!("{name} {rtol:e} {scene}");
            let question = format!("answer {run}");
            let answer = move || numbers(&self.ask(&question));
            let time = move |runs| {
                let told = numbers(&self.ask(&format!("time {runs} {run}")));
                told.first().copied().unwrap_or(f64::NAN)
            };
            Contender::distant(told, method, rtol, answer, time)
        };
        tolerances.iter().map(contender).collect()
    }
}

/// Numbers of a line.
pub fn numbers(line: &str) -> Answer {
    line.split_whitespace().filter_map(|number| number.parse().ok()).collect()
}

impl Drop for Python {
    fn drop(&mut self) {
        if let Some(line) = &self.line {
            let child = &mut line.borrow_mut().child;
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
