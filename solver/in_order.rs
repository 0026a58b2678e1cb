//! Results for a range of indices, made on all threads of a pool and handed over in order.
//!
//! Threads take their indices from the front of what is left, a few at a time. A result is therefore handed over soon after it was made, whatever a run
//! costs, and the work ends between two runs. Results do not depend on the number of threads, nor on the time that runs take.

use rayon::{BroadcastContext, ThreadPool};
use std::collections::VecDeque;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

/// Time between two calls of `take`, and for which a thread keeps its results to itself. A user does not notice it, and it is long enough that handing over
/// costs nothing beside runs of microseconds.
const INTERVAL: Duration = Duration::from_millis(50);

/// Most indices that a thread takes at once. Consecutive points of a sweep share work; many more at once would keep the results of other threads
/// waiting where runs suddenly cost a thousand times as much.
const MOST_AT_ONCE: usize = 64;

/// Most results that a thread keeps to itself. They stay in its cache, and handing over 256 costs some microseconds.
const MOST_KEPT: usize = 256;

/// A thread takes more indices at once while those it took cost less than this time.
const SHORT: Duration = Duration::from_millis(2);

/// Indices after which threads wait for each other. It bounds the results that wait in memory for a slow one before them.
const PART: usize = 1 << 16;

/// Computes one result for each index of `range` on the threads of `pool`. `worker` is called once per thread and part of the range and returns the function
/// with which that thread computes. The calling thread hands finished results to `take` in the order of their indices: about 0.1 s after a result and all
/// before it are finished, or when the present run of its thread ends, if that is later. Where no result is due it hands over an empty list, some twenty times
/// a second. When `take` breaks, no further result is begun.
///
/// # Panics
/// If it is called on a thread of `pool`, which would wait for itself; and as `worker`, its functions and `take` do: no further result is begun then.
///
/// ```
/// use std::ops::ControlFlow;
/// let pool = rayon::ThreadPoolBuilder::new().build()?;
/// let mut squares = Vec::new();
/// rocking::in_order(&pool, 0..1000, || |index| index * index, |more| {
///     squares.extend(more);
///     ControlFlow::Continue(())
/// });
/// assert_eq!(squares.len(), 1000);
/// assert_eq!(squares[999], 998_001);
/// # Ok::<(), rayon::ThreadPoolBuildError>(())
/// ```
pub fn in_order<T: Send, W: FnMut(usize) -> T>(
    pool: &ThreadPool,
    range: Range<usize>,
    worker: impl Fn() -> W + Sync,
    mut take: impl FnMut(Vec<T>) -> ControlFlow<()>,
) {
    assert!(
        pool.current_thread_index().is_none(),
        "in_order is called on a thread of its pool; call it from another one"
    );
    let mut next = range.start;
    while next < range.end {
        let end = range.end.min(next.saturating_add(PART));
        if part(pool, next..end, &worker, &mut take).is_break() {
            return;
        }
        next = end;
    }
}

fn part<T: Send, W: FnMut(usize) -> T>(
    pool: &ThreadPool,
    range: Range<usize>,
    worker: &(impl Fn() -> W + Sync),
    take: &mut impl FnMut(Vec<T>) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let front = Front { next: AtomicUsize::new(range.start), end: range.end, is_ended: AtomicBool::new(false) };
    std::thread::scope(|scope| {
        let (sender, made) = channel();
        let front = &front;
        // The sender is dropped when all threads are done, by a panic too: that ends the loop below.
        let on_thread = move |_: BroadcastContext| {
            let _ends = EndsOnPanic(&front.is_ended);
            front.work(worker(), &sender);
        };
        let threads = scope.spawn(move || pool.broadcast(on_thread));
        let (mut next, mut waiting) = (range.start, VecDeque::new());
        let _ends = EndsOnPanic(&front.is_ended);
        loop {
            let results: Vec<(usize, T)> = match made.recv_timeout(INTERVAL) {
                Ok(results) => results,
                Err(RecvTimeoutError::Timeout) => Vec::new(),
                Err(RecvTimeoutError::Disconnected) => break,
            };
            for (index, result) in results {
                let place = index - next;
                waiting.resize_with(waiting.len().max(place + 1), || None);
                waiting[place] = Some(result);
            }
            let due = waiting.iter().take_while(|result| result.is_some()).count();
            next += due;
            if take(waiting.drain(..due).flatten().collect()).is_break() {
                front.is_ended.store(true, Ordering::Relaxed);
                return ControlFlow::Break(());
            }
        }
        threads.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        ControlFlow::Continue(())
    })
}

/// What is left of a range.
struct Front {
    next: AtomicUsize,
    end: usize,
    is_ended: AtomicBool,
}

/// Ends the work where its thread panics: the panic is to arrive before all other results are made.
struct EndsOnPanic<'a>(&'a AtomicBool);

impl Drop for EndsOnPanic<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

impl Front {
    /// Takes up to `at_once` indices; `None` if none is left.
    fn take(&self, at_once: usize) -> Option<Range<usize>> {
        let after = |first: usize| first.saturating_add(at_once).min(self.end);
        let next = |first: usize| (first < self.end).then(|| after(first));
        self.next.fetch_update(Ordering::Relaxed, Ordering::Relaxed, next).ok().map(|first| first..after(first))
    }

    /// Makes results until there is no index left, and sends them.
    fn work<T>(&self, mut made: impl FnMut(usize) -> T, sender: &Sender<Vec<(usize, T)>>) {
        let (mut results, mut sent, mut at_once) = (Vec::new(), Instant::now(), 1);
        while let Some(indices) = self.take(at_once) {
            let begun = Instant::now();
            for index in indices {
                if self.is_ended.load(Ordering::Relaxed) {
                    return;
                }
                results.push((index, made(index)));
                if results.len() == MOST_KEPT || sent.elapsed() > INTERVAL {
                    // Nobody receives once the work was ended.
                    let _ = sender.send(std::mem::take(&mut results));
                    sent = Instant::now();
                }
            }
            at_once = if begun.elapsed() < SHORT { (2 * at_once).min(MOST_AT_ONCE) } else { 1 };
        }
        let _ = sender.send(results);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pool(threads: usize) -> ThreadPool {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool")
    }

    fn run(milliseconds: u64) {
        std::thread::sleep(Duration::from_millis(milliseconds));
    }

    #[test]
    fn results_come_in_order_whatever_they_cost() {
        for threads in [1, 2, 5] {
            let mut found = Vec::new();
            let worker = || {
                |index: usize| {
                    run(if index % 7 == 3 { 2 } else { 0 });
                    index
                }
            };
            in_order(&pool(threads), 10..400, worker, |more| {
                found.extend(more);
                ControlFlow::Continue(())
            });
            assert_eq!(found, (10..400).collect::<Vec<_>>(), "{threads} threads");
        }
        in_order(&pool(1), 3..3, || |_| (), |_| panic!("there is no index"));
    }

    /// A panic in what is called arrives before the results that are left are made: of a thousand, of 2 ms each, some hundred.
    #[test]
    fn a_panic_ends_the_work() {
        let made_until = |panics_in_take: bool| {
            let made = AtomicUsize::new(0);
            let worker = || {
                |index: usize| {
                    assert!(panics_in_take || index != 0, "as asked for");
                    run(2);
                    made.fetch_add(1, Ordering::Relaxed)
                }
            };
            let take = |more: Vec<usize>| match more.is_empty() || !panics_in_take {
                true => ControlFlow::Continue(()),
                false => panic!("as asked for"),
            };
            let pool = pool(2);
            let ended =
                std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| in_order(&pool, 0..1000, worker, take)));
            assert!(ended.is_err());
            made.load(Ordering::Relaxed)
        };
        for panics_in_take in [true, false] {
            let made = made_until(panics_in_take);
            assert!(made < 900, "{made}, in take: {panics_in_take}");
        }
    }

    #[test]
    fn a_range_may_end_with_the_last_index() {
        let mut found = Vec::new();
        let range = usize::MAX - 10..usize::MAX;
        in_order(
            &pool(2),
            range.clone(),
            || |index| index,
            |more| {
                found.extend(more);
                ControlFlow::Continue(())
            },
        );
        assert_eq!(found, range.collect::<Vec<_>>());
    }

    #[test]
    fn a_range_of_several_parts_is_whole() {
        let mut count = 0;
        in_order(
            &pool(2),
            0..2 * PART + 5,
            || |index| index,
            |more| {
                assert!(more.iter().enumerate().all(|(place, index)| *index == count + place));
                count += more.len();
                ControlFlow::Continue(())
            },
        );
        assert_eq!(count, 2 * PART + 5);
    }

    /// Runs of 20 ms after a thousand that cost nothing: a batch of as many again would hand over nothing before the last of them is done.
    #[test]
    fn finished_results_do_not_wait_for_later_ones() {
        let worker = || {
            |index: usize| {
                run(if index < 1000 { 0 } else { 20 });
                index
            }
        };
        let (mut next, mut times) = (0, 0);
        in_order(&pool(2), 0..1040, worker, |more| {
            times += usize::from(more.iter().any(|index| *index >= 1000));
            next += more.len();
            ControlFlow::Continue(())
        });
        // Forty runs take 0.4 s on two threads, each of which hands over every 0.05 s or less often than its runs end.
        assert!(next == 1040 && times >= 4, "{next} results, {times} times of slow ones");
    }

    #[test]
    fn no_result_is_begun_after_the_end() {
        let (begun, ended) = (AtomicUsize::new(0), AtomicBool::new(false));
        let worker = || {
            |_| {
                begun.fetch_add(1, Ordering::Relaxed);
                run(5);
            }
        };
        in_order(&pool(2), 0..100_000, worker, |_| {
            ended.store(true, Ordering::Relaxed);
            ControlFlow::Break(())
        });
        assert!(ended.load(Ordering::Relaxed) && begun.load(Ordering::Relaxed) < 1000);
    }
}
