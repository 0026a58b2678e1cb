//! Progress on a terminal, for what takes longer than a second.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// A bar that shows itself on a terminal once a run has taken a second.
pub struct Progress {
    bar: Option<ProgressBar>,
    start: Instant,
}

/// Runs shorter than this need no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// Positions of the bar: it counts whole numbers.
const RESOLUTION: f64 = 1000.0;

impl Progress {
    /// Over a time of `t_end [s]`; `quiet` shows nothing.
    pub fn new(t_end: f64, quiet: bool) -> Progress {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::hidden();
            bar.set_length((t_end * RESOLUTION) as u64);
            let style = ProgressStyle::with_template("{wide_bar} {percent}% {eta}");
            bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        Progress { bar, start: Instant::now() }
    }

    /// Reached `t [s]`.
    pub fn advance(&self, t: f64) {
        if let Some(bar) = self.bar.as_ref().filter(|_| self.start.elapsed() > PATIENCE) {
            if bar.is_hidden() {
                bar.set_draw_target(indicatif::ProgressDrawTarget::stderr());
            }
            bar.set_position((t * RESOLUTION) as u64);
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A bar over the points of a sweep, with their rate and the time that is left.
pub struct Points(Option<ProgressBar>);

impl Points {
    /// Over `count` points of which `known` are there; `quiet` shows nothing.
    pub fn new(count: usize, known: usize, quiet: bool) -> Points {
        let is_seen = !quiet && std::io::stderr().is_terminal();
        Points(is_seen.then(|| {
            let bar = ProgressBar::new(count as u64).with_position(known as u64);
            bar.reset_eta();
            let style = ProgressStyle::with_template("{wide_bar} {human_pos}/{human_len} {per_sec} {eta}");
            bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        }))
    }

    /// So many points are there.
    pub fn reached(&self, count: usize) {
        if let Some(bar) = &self.0 {
            bar.set_position(count as u64);
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
