//! Work done by all ensembles of this process, for estimates of the time to go.

use std::sync::atomic::{AtomicI64, AtomicU64, Ordering};

/// Millionths of a case.
const PARTS: f64 = 1e6;

static DONE: AtomicU64 = AtomicU64::new(0);
static UNDER_WAY: AtomicI64 = AtomicI64::new(0);
static EARLY: AtomicU64 = AtomicU64::new(0);

/// Simulated time in cases run in planes by this process, each as a share of the longest that the case may take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Work {
    /// Sum over all cases, finished or not, since the process began.
    pub done: f64,
    /// Sum over the cases that run now.
    pub under_way: f64,
    /// Number of cases that ended before their time, since the process began.
    pub early: f64,
}

impl Work {
    /// Returns the work of this process so far.
    pub fn now() -> Self {
        Self {
            done: DONE.load(Ordering::Relaxed) as f64 / PARTS,
            under_way: UNDER_WAY.load(Ordering::Relaxed) as f64 / PARTS,
            early: EARLY.load(Ordering::Relaxed) as f64,
        }
    }

    /// Returns the work since an earlier instant.
    #[must_use]
    pub fn since(self, earlier: Self) -> Self {
        Self { done: self.done - earlier.done, early: self.early - earlier.early, ..self }
    }
}

/// A case under way, which counts until it is dropped.
#[derive(Debug, Default)]
pub(super) struct Share(u64);

impl Share {
    /// Reports the simulated share of the case.
    pub(super) fn reached(&mut self, share: f64) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1e6")]
        let now = ((share.clamp(0.0, 1.0) * PARTS) as u64).max(self.0);
        DONE.fetch_add(now - self.0, Ordering::Relaxed);
        UNDER_WAY.fetch_add(signed(now) - signed(self.0), Ordering::Relaxed);
        self.0 = now;
    }

    /// Ends the case at this share.
    pub(super) fn end(mut self, share: f64) {
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
