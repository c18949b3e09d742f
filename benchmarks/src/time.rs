//! Measurement of processor time, which other programs on the machine hardly affect.

use std::time::Instant;

/// Number of measurements of each figure; the smallest is printed, because disturbances only add
/// time.
const REPEATS: usize = 5;

/// Returns the processor time (s) used so far, or the wall time since `start` if the system does not report it.
fn spent(start: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

/// Returns the processor time (s) that all threads of this process have used; `None` if the system does
/// not report it.
pub(crate) fn of_process() -> Option<f64> {
    of_fields(14)
}

/// Returns the processor time (s) of all commands that this process has run to their end; `None` if the
/// system does not report it.
pub(crate) fn of_commands() -> Option<f64> {
    of_fields(16)
}

/// Returns the sum (s) of two adjacent fields of `/proc/self/stat`: the time spent in user mode, in the field with the
/// number `first` (counted from 1), and the time spent in the kernel. `None` if the file cannot be read.
fn of_fields(first: usize) -> Option<f64> {
    /// Ticks per second, the same on every Linux that reports this file.
    const TICKS: f64 = 100.0;
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program, the second field, is in parentheses and may contain spaces.
    let fields = text.rsplit(')').next()?.split_whitespace().skip(first - 3).take(2);
    Some(fields.filter_map(|field| field.parse::<f64>().ok()).sum::<f64>() / TICKS)
}

/// Shortest duration (s) of a measurement. Work is repeated until this time is reached, because the
/// system updates processor times only every few milliseconds.
const LONG: f64 = 0.1;

/// Returns the smallest processor time (s) of `work` on this thread in [`REPEATS`] measurements.
pub(crate) fn least(work: impl FnMut()) -> f64 {
    least_of(REPEATS, work)
}

/// Returns the smallest processor time (s) of `work` on this thread in a given number of
/// measurements.
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

/// Returns the present clock rate of this core (cycles per second), from a chain of operations of known duration.
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
    // A rotation takes one cycle, a multiplication three.
    4.0 * ROUNDS as f64 / spent
}

/// Returns the number of instructions that `work` executes on this thread.
///
/// `None` if the system does not count instructions; `work` may then not have run.
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

/// Returns `None`: instructions are counted on Linux only.
#[cfg(not(target_os = "linux"))]
pub(crate) fn instructions(_: impl FnOnce()) -> Option<u64> {
    None
}
