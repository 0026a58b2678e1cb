//! Signals during a computation: Ctrl-C ends it.
//!
//! The interpreter's lock is taken every [`INTERVAL`] and no more often: with many threads it is contended.

use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Time between two looks for signals: a user does not notice it, and taking the lock costs a millionth of it.
pub const INTERVAL: Duration = Duration::from_millis(50);

/// Looks for signals while the lock is released.
pub struct Signals {
    last: Instant,
    /// What a handler raised.
    raised: Option<PyErr>,
}

impl Signals {
    pub fn new() -> Signals {
        Signals { last: Instant::now(), raised: None }
    }

    /// Whether to go on.
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
