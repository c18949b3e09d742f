//! Stop rule of a Monte Carlo design: the collapse probability and its interval.

use barrelstack_fragility::wilson;
use barrelstack_report::described;

use super::table::StudyTable;

/// Counts of cases by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Cases in all.
    pub cases: u64,
    /// Cases that were judged: stable or collapse.
    pub judged: u64,
    /// Cases that collapsed.
    pub collapsed: u64,
}

impl Tally {
    /// Adds a case by the word for its outcome.
    pub fn add(&mut self, outcome: &str) {
        self.cases += 1;
        self.judged += u64::from(matches!(outcome, "stable" | "collapse"));
        self.collapsed += u64::from(outcome == "collapse");
    }

    /// Returns the tally of a table.
    pub fn of(table: &StudyTable) -> Self {
        let mut tally = Self::default();
        for outcome in table.texts("outcome").unwrap_or_default() {
            tally.add(outcome.as_deref().unwrap_or("error"));
        }
        tally
    }

    /// Returns the sum of both.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            cases: self.cases + other.cases,
            judged: self.judged + other.judged,
            collapsed: self.collapsed + other.collapsed,
        }
    }

    /// Returns the fraction of judged cases that collapsed, with its 95 % interval (Wilson); `None` without any.
    pub fn collapse(&self) -> Option<(f64, [f64; 2])> {
        if self.judged == 0 {
            return None;
        }
        // A study has ten million cases at most.
        let [collapsed, judged] =
            [self.collapsed, self.judged].map(|count| u32::try_from(count).unwrap_or(u32::MAX));
        let interval = wilson(collapsed, judged, 0.95);
        Some((f64::from(collapsed) / f64::from(judged), [interval.low, interval.high]))
    }
}

described! {
    /// When a Monte Carlo design has enough cases.
    #[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
    pub struct StopRule {
        /// Half of the width of the 95 % interval (Wilson) of the collapse probability at which to stop.
        pub half_width: f64 as "1",
        /// Number of cases before the interval is looked at.
        pub least: u32,
    }
}

impl StopRule {
    /// `true` if these cases, all of the chunks up to one, suffice.
    pub(super) fn met(&self, tally: Tally) -> bool {
        let half = tally.collapse().map(|(_, [low, high])| 0.5 * (high - low));
        tally.cases >= u64::from(self.least) && half.is_some_and(|half| half <= self.half_width)
    }
}

#[cfg(test)]
mod tests {
    use super::Tally;

    #[test]
    fn the_interval_is_that_of_wilson() {
        // scipy.stats.binomtest(hits, of).proportion_ci(0.95, "wilson").
        let cases = [
            (0, 10, [0.0, 0.277_532_799_862_889_26]),
            (10, 20, [0.299_298_008_198_212_4, 0.700_701_991_801_787_6]),
            (3, 4, [0.300_641_842_582_401_84, 0.954_412_739_190_299_5]),
        ];
        for (hits, of, [low, high]) in cases {
            let tally = Tally { cases: of, judged: of, collapsed: hits };
            let (_, interval) = tally.collapse().unwrap();
            // Measured: 2e-16.
            assert!(
                (interval[0] - low).abs() < 1e-12 && (interval[1] - high).abs() < 1e-12,
                "{interval:?}"
            );
        }
        assert_eq!(Tally::default().collapse(), None);
    }
}
