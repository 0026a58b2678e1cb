//! Progress on a terminal, for what takes longer than a second.

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// A bar that shows itself on a terminal once the work has taken a second.
pub struct Progress {
    bar: Option<ProgressBar>,
    start: Instant,
}

/// Shorter work needs no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// Time between two pictures of a bar that only shows that work goes on.
const TICK: Duration = Duration::from_millis(100);

/// Positions of the bar per second of simulated time: the bar counts in whole numbers.
const RESOLUTION: f64 = 1000.0;

impl Progress {
    /// Progress of a run up to the time `t_end [s]`; `quiet` shows nothing.
    pub fn of_run(t_end: f64, quiet: bool) -> Progress {
        Progress::new((t_end * RESOLUTION) as u64, 0, "{wide_bar} {percent}% {remaining}", quiet)
    }

    /// Progress over `count` points, `known` of which were computed before; `quiet` shows nothing.
    pub fn of_points(count: usize, known: usize, quiet: bool) -> Progress {
        Progress::new(count as u64, known as u64, "{wide_bar} {human_pos}/{human_len} {per_sec} {remaining}", quiet)
    }

    fn new(length: u64, position: u64, template: &str, quiet: bool) -> Progress {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::hidden().with_position(position);
            bar.set_length(length);
            bar.reset_eta();
            let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
            bar.with_style(style.with_key("remaining", remaining))
        });
        Progress { bar, start: Instant::now() }
    }

    /// The run has reached `t [s]`.
    pub fn reached_time(&self, t: f64) {
        self.reached((t * RESOLUTION) as usize);
    }

    /// Moves the bar to `position`, the number of points that are done.
    pub fn reached(&self, position: usize) {
        if let Some(bar) = self.bar.as_ref().filter(|_| self.start.elapsed() > PATIENCE) {
            if bar.is_hidden() {
                bar.set_draw_target(ProgressDrawTarget::stderr());
            }
            bar.set_position(position as u64);
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// The result of work whose length is not known. A terminal shows what is done, and that it goes on.
pub fn working<T>(what: &'static str, work: impl FnOnce() -> T) -> T {
    if !std::io::stderr().is_terminal() {
        return work();
    }
    std::thread::scope(|scope| {
        let (running, finished) = channel::<()>();
        scope.spawn(move || {
            let style = ProgressStyle::with_template("{spinner} {msg} {elapsed}");
            let style = style.unwrap_or_else(|_| ProgressStyle::default_spinner());
            let bar = ProgressBar::hidden().with_style(style).with_message(what);
            let mut pause = PATIENCE;
            while finished.recv_timeout(pause) == Err(RecvTimeoutError::Timeout) {
                if bar.is_hidden() {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                }
                bar.tick();
                pause = TICK;
            }
            bar.finish_and_clear();
        });
        let result = work();
        drop(running);
        result
    })
}

/// The time that is left; nothing until the first point is done, as points that were computed before say nothing of it.
fn remaining(state: &ProgressState, out: &mut dyn Write) {
    if state.per_sec() > 0.0 {
        let _ = write!(out, "{:#}", HumanDuration(state.eta()));
    }
}
