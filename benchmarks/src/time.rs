//! Processor time, which other users of the machine do not spoil.

use std::time::Instant;

/// How often a figure is measured; the least is printed, since nothing makes a program faster.
const REPEATS: usize = 5;

/// Time (s) that this process has computed; the clock's where the system does not say.
fn spent(start: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

/// The system tells processor time in steps of a few milliseconds: work is repeated until this (s).
const LONG: f64 = 0.1;

/// The least processor time (s) of some work on this thread.
pub(crate) fn least(mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    let mut least = f64::INFINITY;
    for _ in 0..REPEATS {
        let before = spent(start);
        let mut times = 0;
        while times == 0 || spent(start) - before < LONG {
            work();
            times += 1;
        }
        least = least.min((spent(start) - before) / f64::from(times));
    }
    least
}

/// The least time (s) on the clock of some work on any number of threads.
pub(crate) fn least_wall(mut work: impl FnMut()) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..REPEATS {
        let start = Instant::now();
        work();
        least = least.min(start.elapsed().as_secs_f64());
    }
    least
}
