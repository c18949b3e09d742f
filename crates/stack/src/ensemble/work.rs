//! Work done by all ensembles of this process, for estimates of the time to go.

use std::sync::LazyLock;
use std::sync::atomic::{AtomicI64, AtomicU64, Ordering};
use std::time::Instant;

/// Millionths of a case.
const PARTS: f64 = 1e6;

static DONE: AtomicU64 = AtomicU64::new(0);
static UNDER_WAY: AtomicI64 = AtomicI64::new(0);
static EARLY: AtomicU64 = AtomicU64::new(0);
static AT_REST: AtomicU64 = AtomicU64::new(0);
static SETTLING: Clock = Clock::new();
static SHAKING: Clock = Clock::new();

/// Instant from which the clocks count.
static EPOCH: LazyLock<Instant> = LazyLock::new(Instant::now);

/// Simulated time in cases run by this process, each as a share of the longest that the case may take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Sum over all cases, finished or not, since the process began.
    pub done: f64,
    /// Sum over the cases that run now.
    pub under_way: f64,
    /// Number of cases that ended before their time, since the process began.
    pub early: f64,
    /// Number of cases whose stack has been brought to rest, since the process began.
    pub at_rest: f64,
    /// Time (s) that threads have spent on bringing stacks to rest, since the process began.
    pub settling: f64,
    /// Time (s) that threads have spent on shaking them, since the process began.
    pub shaking: f64,
}

impl Work {
    /// Returns the work of this process so far.
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

    /// Returns the work since an earlier instant.
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

/// Sum of the times of all threads in one kind of work, including those that are in it now.
struct Clock {
    /// Number of threads in it.
    threads: AtomicI64,
    /// Sum of the ends less the sum of the begins (ns).
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

    /// Counts the thread until the guard is dropped.
    fn enter(&'static self) -> Inside {
        self.sum.fetch_sub(now(), Ordering::Relaxed);
        self.threads.fetch_add(1, Ordering::Relaxed);
        Inside(self)
    }
}

/// A thread in a kind of work, until it is dropped.
pub struct Inside(&'static Clock);

impl Drop for Inside {
    fn drop(&mut self) {
        self.0.threads.fetch_sub(1, Ordering::Relaxed);
        self.0.sum.fetch_add(now(), Ordering::Relaxed);
    }
}

/// Returns the time since the epoch (ns); 0 in a page, where the standard library has no clock and nobody reads this
/// one.
fn now() -> i64 {
    if cfg!(target_family = "wasm") {
        return 0;
    }
    i64::try_from(EPOCH.elapsed().as_nanos()).unwrap_or(i64::MAX)
}

/// Counts this thread as bringing stacks to rest until the guard is dropped.
pub fn settling() -> Inside {
    SETTLING.enter()
}

/// Counts this thread as shaking stacks until the guard is dropped, and a number of cases as at rest.
pub fn shaking(cases: usize) -> Inside {
    AT_REST.fetch_add(cases as u64, Ordering::Relaxed);
    SHAKING.enter()
}

/// A case under way, which counts until it is dropped.
#[derive(Debug, Default)]
pub struct Share(u64);

impl Share {
    /// Reports the simulated share of the case.
    pub fn reached(&mut self, share: f64) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1e6")]
        let now = ((share.clamp(0.0, 1.0) * PARTS) as u64).max(self.0);
        DONE.fetch_add(now - self.0, Ordering::Relaxed);
        UNDER_WAY.fetch_add(signed(now) - signed(self.0), Ordering::Relaxed);
        self.0 = now;
    }

    /// Ends the case at this share.
    pub fn end(mut self, share: f64) {
        self.reached(share);
        if share < 0.99 {
            EARLY.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        UNDER_WAY.fetch_sub(signed(self.0), Ordering::Relaxed);
    }
}

fn signed(parts: u64) -> i64 {
    i64::try_from(parts).unwrap_or(i64::MAX)
}
