//! Threads on which a command computes.

use crate::error::Failure;
use clap::Args;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Largest accepted number of threads. Each thread has a stack; a larger number is taken for a mistake.
const MOST_THREADS: i64 = 1024;

/// How many threads a command may use.
#[derive(Clone, Copy, Debug, Args)]
pub struct Threads {
    /// Threads of the rows of a table, of companions, of bands; as many as the machine has unless given.
    #[arg(long = "threads", value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    count: Option<u16>,
}

impl Threads {
    /// The threads, started.
    pub fn pool(self) -> Result<ThreadPool, Failure> {
        let pool = ThreadPoolBuilder::new().num_threads(self.count.map_or(0, usize::from)).build();
        pool.map_err(|error| Failure::Threads(error.to_string()))
    }
}
