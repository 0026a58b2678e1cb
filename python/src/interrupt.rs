//! Computations that a signal such as Ctrl-C ends: they run on a pool of threads while the calling thread checks for signals.
//!
//! The interpreter's lock is taken every [`INTERVAL`] and no more often: with many threads it is contended. A pool lives for one call only: a process that
//! is forked later does not inherit a broken one.

use pyo3::exceptions::{PyMemoryError, PyOSError, PyValueError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::ops::{ControlFlow, Range};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Time between two checks for signals. A user does not notice this time, and taking the lock costs a millionth of it.
const INTERVAL: Duration = Duration::from_millis(50);

/// Largest number of threads.
const MOST_THREADS: usize = 1024;

/// Checks for signals during a computation that has released the lock.
pub struct Signals {
    last: Instant,
    /// What a handler raised.
    raised: Option<PyErr>,
}

impl Signals {
    pub fn new() -> Signals {
        Signals { last: Instant::now(), raised: None }
    }

    /// Whether the computation may continue. It breaks once a handler has raised an exception.
    pub fn poll(&mut self) -> ControlFlow<()> {
        if self.last.elapsed() < INTERVAL {
            return ControlFlow::Continue(());
        }
        let checked = Python::attach(|py| py.check_signals());
        self.last = Instant::now();
        match checked {
            Ok(()) => ControlFlow::Continue(()),
            Err(raised) => {
                self.raised = Some(raised);
                ControlFlow::Break(())
            }
        }
    }

    /// Ends the computation.
    ///
    /// # Errors
    /// The exception that a signal handler raised.
    pub fn finish(self) -> PyResult<()> {
        self.raised.map_or(Ok(()), Err)
    }
}

/// A pool of threads, 0 for as many as the machine has.
///
/// # Errors
/// `ValueError` for too many threads, `OSError` if there is no pool.
pub fn pool(threads: usize) -> PyResult<ThreadPool> {
    if threads > MOST_THREADS {
        let problem = format!(
            "threads = {threads} is out of range; give at most {MOST_THREADS}, or 0 for as many as the machine has"
        );
        return Err(PyValueError::new_err(problem));
    }
    ThreadPoolBuilder::new().num_threads(threads).build().map_err(|failed| PyOSError::new_err(failed.to_string()))
}

/// Whether a signal has ended a computation; copies tell the same.
#[derive(Clone, Default)]
pub struct Ended(Arc<AtomicBool>);

impl Ended {
    /// What a function of progress returns.
    pub fn progress(&self) -> ControlFlow<()> {
        match self.0.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Checks for signals and keeps whether one has ended the computation.
    fn poll(&self, signals: &mut Signals) -> ControlFlow<()> {
        let polled = signals.poll();
        if polled.is_break() {
            self.0.store(true, Ordering::Relaxed);
        }
        polled
    }
}

/// The results for all indices of a range, in order. Each thread makes its own with what `worker` returns. When a signal has ended the computation, no
/// further result is begun, and those under way see it in the argument of `worker`.
///
/// # Errors
/// What a handler of signals raised. `MemoryError` for more results than the memory has room for, `ValueError` for too many threads, `OSError` if there is
/// no pool.
pub fn in_order<T: Send, W: FnMut(usize) -> T>(
    py: Python<'_>,
    range: Range<usize>,
    threads: usize,
    worker: impl Fn(Ended) -> W + Sync,
) -> PyResult<Vec<T>> {
    let (pool, mut made, mut signals, ended) = (pool(threads)?, Vec::new(), Signals::new(), Ended::default());
    made.try_reserve_exact(range.len()).map_err(|_| {
        PyMemoryError::new_err(format!(
            "{} rows do not fit into the memory; give `start` and `stop` of a part (as Sweep.shard has), or write them with rocking.dask.to_parquet",
            range.len()
        ))
    })?;
    py.detach(|| {
        rocking::in_order(
            &pool,
            range,
            || worker(ended.clone()),
            |results| {
                made.extend(results);
                ended.poll(&mut signals)
            },
        );
    });
    signals.finish()?;
    Ok(made)
}

/// What `work` returns, on the threads of a pool. Its argument shows when a signal has ended it.
///
/// # Errors
/// What a handler of signals raised.
pub fn on_pool<T: Send>(py: Python<'_>, pool: &ThreadPool, work: impl FnOnce(&Ended) -> T + Send) -> PyResult<T> {
    let (mut signals, ended) = (Signals::new(), Ended::default());
    let done = py.detach(|| {
        std::thread::scope(|scope| {
            let (running, finished) = channel::<()>();
            let ended = &ended;
            let work = scope.spawn(move || {
                // Dropped when the work ends, by a panic too: that ends the loop below.
                let _running = running;
                pool.install(|| work(ended))
            });
            while finished.recv_timeout(INTERVAL) == Err(RecvTimeoutError::Timeout) {
                let _ = ended.poll(&mut signals);
            }
            work.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })
    });
    signals.finish()?;
    Ok(done)
}
