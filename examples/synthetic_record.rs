//! Writes the synthetic accelerogram that ships with the project, in PEER AT2 layout, to standard output:
//!
//! ```text
//! cargo run --example synthetic_record > scenes/records/synthetic.AT2
//! ```
//!
//! Forty sine waves between 0.4 and 12 Hz with phases from a fixed generator and amplitudes falling off on both sides of 2 Hz,
//! under an envelope that rises for two seconds, holds for six and decays: nothing of it was ever measured. Scaled to 0.45 g.

use std::fmt::Write;

/// Sampling interval `[s]`.
const DT: f64 = 0.01;
/// Samples: twenty seconds.
const COUNT: usize = 2001;
/// Peak `[g]`.
const PEAK: f64 = 0.45;
/// Sine waves.
const WAVES: usize = 40;

/// Numbers in `0 .. 1` from a linear congruential generator (Knuth's MMIX constants).
struct Phases(u64);

impl Phases {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Rise, hold, decay, 0 to 1.
fn envelope(t: f64) -> f64 {
    if t < 2.0 {
        (t / 2.0) * (t / 2.0)
    } else if t < 8.0 {
        1.0
    } else {
        libm::exp(-0.35 * (t - 8.0))
    }
}

/// The accelerogram in g.
pub fn samples() -> Vec<f64> {
    let mut phases = Phases(1906);
    let waves: Vec<(f64, f64, f64)> = (0..WAVES)
        .map(|wave| {
            let frequency = 0.4 * libm::pow(30.0, (wave as f64 + phases.next()) / WAVES as f64);
            let ratio = frequency / 2.0;
            (frequency, ratio / (1.0 + ratio * ratio), phases.next())
        })
        .collect();
    let value = |index: usize| {
        let t = index as f64 * DT;
        let sum: f64 = waves.iter().map(|(f, a, phase)| a * libm::sin(std::f64::consts::TAU * (f * t + phase))).sum();
        envelope(t) * sum
    };
    let raw: Vec<f64> = (0..COUNT).map(value).collect();
    let peak = raw.iter().fold(0.0f64, |peak, a| peak.max(a.abs()));
    raw.iter().map(|a| a * PEAK / peak).collect()
}

/// The file.
pub fn text() -> String {
    let mut text = String::from(
        "SYNTHETIC RECORD OF THE ROCKING PROJECT, NOT MEASURED\n\
         Nowhere, forty sine waves under an envelope, examples/synthetic_record.rs\n\
         ACCELERATION TIME SERIES IN UNITS OF G\n",
    );
    let _ = writeln!(text, "NPTS= {COUNT}, DT= {DT:.4} SEC");
    for row in samples().chunks(5) {
        let row: Vec<String> = row.iter().map(|a| format!("{a:15.7e}")).collect();
        let _ = writeln!(text, "{}", row.join(""));
    }
    text
}

#[allow(dead_code, reason = "the test that guards the shipped file includes this one as a module")]
fn main() {
    print!("{}", text());
}
