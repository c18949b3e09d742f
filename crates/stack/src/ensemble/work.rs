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

    fn enter(&self) {
        self.sum.fetch_sub(now(), Ordering::Relaxed);
        self.threads.fetch_add(1, Ordering::Relaxed);
    }

    fn leave(&self) {
        self.threads.fetch_sub(1, Ordering::Relaxed);
        self.sum.fetch_add(now(), Ordering::Relaxed);
    }
}

/// What a thread does with its cases, whose time counts until this is dropped.
#[must_use]
pub struct Stage {
    shaking: bool,
}

impl Stage {
    /// Begins to bring stacks to rest.
    pub fn settling() -> Self {
        SETTLING.enter();
        Self { shaking: false }
    }

    /// Begins to shake the stacks of a number of cases, which are at rest, unless they are shaken already.
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

/// Returns the time since the epoch (ns); 0 in a page, where the standard library has no clock and nobody reads this
/// one.
fn now() -> i64 {
    if cfg!(target_family = "wasm") {
        return 0;
    }
    i64::try_from(EPOCH.elapsed().as_nanos()).unwrap_or(i64::MAX)
}

/// A case under way, which counts until it is dropped.
#[derive(Debug, Default)]
pub struct Share(u64);

impl Share {
    /// Reports the simulated share of the case, 0 to 1.
    pub fn reached(&mut self, share: f64) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1e6")]
        let now = ((share.clamp(0.0, 1.0) * PARTS) as u64).max(self.0);
        DONE.fetch_add(now - self.0, Ordering::Relaxed);
        UNDER_WAY.fetch_add(signed(now) - signed(self.0), Ordering::Relaxed);
        self.0 = now;
    }

    /// Ends the case at this share, 0 to 1.
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
