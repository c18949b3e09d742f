//! Work done by all ensembles of this process, for estimates of the remaining time.

use std::sync::LazyLock;
use std::sync::atomic::{AtomicI64, AtomicU64, Ordering};
use std::time::Instant;

/// Resolution of the progress counters: number of units for a case that is simulated for its usual duration.
const PARTS: f64 = 1e6;

static DONE: AtomicU64 = AtomicU64::new(0);
static UNDER_WAY: AtomicI64 = AtomicI64::new(0);
static EARLY: AtomicU64 = AtomicU64::new(0);
static AT_REST: AtomicU64 = AtomicU64::new(0);
static SETTLING: Clock = Clock::new();
static SHAKING: Clock = Clock::new();

/// Instant from which the clocks measure time.
static EPOCH: LazyLock<Instant> = LazyLock::new(Instant::now);

/// Progress of all cases of this process.
///
/// The progress of a case is its simulated time divided by its usual duration, but at most 1. The usual duration is
/// the duration of the motion: a case may continue after the motion until its stack is at rest, but few cases do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Sum of the progress of all cases, finished or not, since the process began.
    pub done: f64,
    /// Sum of the progress of the cases that are running.
    pub under_way: f64,
    /// Number of cases that ended before their usual duration, since the process began.
    pub early: f64,
    /// Number of cases whose stack has been brought to rest, since the process began.
    pub at_rest: f64,
    /// Time (s) that all threads have spent on bringing stacks to rest, since the process began.
    pub settling: f64,
    /// Time (s) that all threads have spent on shaking stacks, since the process began.
    pub shaking: f64,
}

impl Work {
    /// Returns the progress of all cases of this process up to now.
    pub fn now() -> Self {
        Self {
            done: DONE.load(Ordering::Relaxed) as f64 / PARTS,
            under_way: UNDER_WAY.load(Ordering::Relaxed) as f64 / PARTS,
            early: EARLY.load(Ordering::Relaxed) as f64,
            at_rest: AT_REST.load(Ordering::Relaxed) as f64,
            settling: SETTLING.seconds(),
            shaking: SHAKING.seconds(),
        }
    }

    /// Returns the progress made since `earlier`, the result of an earlier call to [`Work::now`].
    #[must_use]
    pub fn since(self, earlier: Self) -> Self {
        Self {
            done: self.done - earlier.done,
            under_way: self.under_way,
            early: self.early - earlier.early,
            at_rest: self.at_rest - earlier.at_rest,
            settling: self.settling - earlier.settling,
            shaking: self.shaking - earlier.shaking,
        }
    }
}

/// Total time that all threads have spent on one kind of work, including work in progress.
struct Clock {
    /// Number of threads that are doing this kind of work now.
    threads: AtomicI64,
    /// Sum of the times (ns) at which threads finished this work, minus the sum of the times at which threads began it.
    sum: AtomicI64,
}

impl Clock {
    const fn new() -> Self {
        Self { threads: AtomicI64::new(0), sum: AtomicI64::new(0) }
    }

    fn seconds(&self) -> f64 {
        let threads = self.threads.load(Ordering::Relaxed);
        (self.sum.load(Ordering::Relaxed) + threads * now()).max(0) as f64 / 1e9
    }

    fn enter(&self) {
        self.sum.fetch_sub(now(), Ordering::Relaxed);
        self.threads.fetch_add(1, Ordering::Relaxed);
    }

    fn leave(&self) {
        self.threads.fetch_sub(1, Ordering::Relaxed);
        self.sum.fetch_add(now(), Ordering::Relaxed);
    }
}

/// Guard that counts the time of a thread as settling or shaking until it is dropped.
#[must_use]
pub struct Stage {
    shaking: bool,
}

impl Stage {
    /// Creates a guard that counts the time from now on as settling.
    pub fn settling() -> Self {
        SETTLING.enter();
        Self { shaking: false }
    }

    /// Adds `cases` to the number of cases whose stack has been brought to rest, and counts the time from now on as
    /// shaking.
    ///
    /// Only the first call has an effect.
    pub fn shake(&mut self, cases: usize) {
        if !self.shaking {
            SETTLING.leave();
            SHAKING.enter();
            AT_REST.fetch_add(cases as u64, Ordering::Relaxed);
            self.shaking = true;
        }
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        if self.shaking { SHAKING.leave() } else { SETTLING.leave() }
    }
}

/// Returns the time since [`EPOCH`] (ns); 0 on `wasm32`, where the standard library has no clock and the time is not
/// used.
fn now() -> i64 {
    if cfg!(target_family = "wasm") {
        return 0;
    }
    i64::try_from(EPOCH.elapsed().as_nanos()).unwrap_or(i64::MAX)
}

/// Guard of a running case. The progress of the case counts as under way until the guard is dropped.
#[derive(Debug)]
pub struct Share {
    /// Usual duration (s) of the case.
    usual: f64,
    /// Reported progress.
    parts: u64,
}

impl Share {
    /// Starts a case that ends at `end_time` (s) at the latest and whose motion ends at `motion_end` (s), or at zero
    /// without a motion.
    pub fn new(end_time: f64, motion_end: f64) -> Self {
        let usual = if motion_end > 0.0 { end_time.min(motion_end) } else { end_time };
        Self { usual, parts: 0 }
    }

    /// Reports the simulated time (s) of the case.
    pub fn reached(&mut self, time: f64) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1e6")]
        let now = (((time / self.usual).clamp(0.0, 1.0) * PARTS) as u64).max(self.parts);
        DONE.fetch_add(now - self.parts, Ordering::Relaxed);
        UNDER_WAY.fetch_add(signed(now) - signed(self.parts), Ordering::Relaxed);
        self.parts = now;
    }

    /// Ends the case at a simulated time (s).
    pub fn end(mut self, time: f64) {
        self.reached(time);
        if time < 0.99 * self.usual {
            EARLY.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        UNDER_WAY.fetch_sub(signed(self.parts), Ordering::Relaxed);
    }
}

fn signed(parts: u64) -> i64 {
    i64::try_from(parts).unwrap_or(i64::MAX)
}
