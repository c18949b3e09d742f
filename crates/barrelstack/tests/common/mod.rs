//! Helpers shared by several suites.
#![allow(dead_code, reason = "each suite uses some of these")]

use std::io::Write as _;

/// Reports that a test had to be skipped; writes to standard output directly, since the runner captures the output of
/// passing tests.
pub(crate) fn skipped(why: &str) {
    let notice = format!("skipped: {why}\n");
    std::io::stdout().write_all(notice.as_bytes()).expect("a standard output");
}

/// Generates numbers between 0 and 1, the same on every machine (`SplitMix64`).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) as f64 / 2.0_f64.powi(64)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    pub(crate) fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let index = (self.next() * of.len() as f64) as usize;
        of[index]
    }
}
