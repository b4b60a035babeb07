//! A clock for short calls.

use std::time::{Duration, Instant};

/// How long one measurement may take.
const BUDGET: Duration = Duration::from_millis(700);

/// How long one batch of calls should take: much longer than reading the clock, much shorter than
/// the time slices of other programs.
const BATCH: Duration = Duration::from_micros(500);

/// Nanoseconds of one call: the fastest of many batches, the one least disturbed by other processes.
///
/// `call` is given the number of the call, so that it can walk through different inputs.
pub fn nanoseconds(mut call: impl FnMut(usize)) -> f64 {
    let start = Instant::now();
    let mut calls = 0;
    while start.elapsed() < BATCH {
        call(calls);
        calls += 1;
    }
    let batch = calls.next_multiple_of(64);
    let mut best = f64::INFINITY;
    while start.elapsed() < BUDGET {
        let begin = Instant::now();
        (0..batch).for_each(&mut call);
        best = best.min(begin.elapsed().as_secs_f64() * 1e9 / batch as f64);
    }
    best
}
