//! Signals during a computation: Ctrl-C ends it.
//!
//! The interpreter's lock is taken every [`INTERVAL`] and no more often: with many threads it is contended.

use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Time between two checks for signals. A user does not notice this time, and taking the lock costs a millionth of it.
pub const INTERVAL: Duration = Duration::from_millis(50);

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

    /// # Errors
    /// What a handler raised.
    pub fn finish(self) -> PyResult<()> {
        self.raised.map_or(Ok(()), Err)
    }
}
