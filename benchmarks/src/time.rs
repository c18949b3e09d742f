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
pub(crate) fn least(work: impl FnMut()) -> f64 {
    least_of(REPEATS, work)
}

/// The same of so many measurements.
pub(crate) fn least_of(repeats: usize, mut work: impl FnMut()) -> f64 {
    let start = Instant::now();
    let mut least = f64::INFINITY;
    for _ in 0..repeats {
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

/// The clock of this core now (cycles a second), by a chain of operations whose cycles are known.
pub(crate) fn clock() -> f64 {
    const ROUNDS: u64 = 20_000_000;
    let spent = least(|| {
        let mut value = std::hint::black_box(1_u64);
        for _ in 0..ROUNDS {
            value = value.rotate_left(1);
            value = value.wrapping_mul(3);
        }
        std::hint::black_box(value);
    });
    // A rotation takes a cycle, a multiplication three.
    4.0 * ROUNDS as f64 / spent
}

/// How many instructions some work takes on this thread; none, and nothing is done, where the system does not
/// count them.
#[cfg(target_os = "linux")]
pub(crate) fn instructions(work: impl FnOnce()) -> Option<u64> {
    use perf_event::Builder;
    use perf_event::events::Hardware;

    let mut counter = Builder::new().kind(Hardware::INSTRUCTIONS).build().ok()?;
    counter.enable().ok()?;
    work();
    counter.disable().ok()?;
    counter.read().ok().filter(|count| *count > 0)
}

/// Elsewhere nobody counts.
#[cfg(not(target_os = "linux"))]
pub(crate) fn instructions(_: impl FnOnce()) -> Option<u64> {
    None
}
