//! Stopping rule of a Monte Carlo design, based on the interval of the collapse probability.

use barrelstack_fragility::wilson;
use barrelstack_report::described;

use super::table::StudyTable;

/// Numbers of cases by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Total number of cases.
    pub cases: u64,
    /// Number of cases with a verdict: stable or collapse.
    pub judged: u64,
    /// Number of cases that collapsed.
    pub collapsed: u64,
}

impl Tally {
    /// Counts a case with the given outcome, such as "stable" or "collapse".
    pub fn add(&mut self, outcome: &str) {
        self.cases += 1;
        self.judged += u64::from(matches!(outcome, "stable" | "collapse"));
        self.collapsed += u64::from(outcome == "collapse");
    }

    /// Counts the cases in a table by outcome.
    pub fn of(table: &StudyTable) -> Self {
        let mut tally = Self::default();
        for outcome in table.texts("outcome").unwrap_or_default() {
            tally.add(outcome.as_deref().unwrap_or("error"));
        }
        tally
    }

    /// Returns the sum of two tallies.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            cases: self.cases + other.cases,
            judged: self.judged + other.judged,
            collapsed: self.collapsed + other.collapsed,
        }
    }

    /// Returns the share of collapsed cases among the cases with a verdict, and its 95 % confidence interval (Wilson);
    /// `None` if no case has a verdict.
    pub fn collapse(&self) -> Option<(f64, [f64; 2])> {
        if self.judged == 0 {
            return None;
        }
        // The conversion is exact, since a study has at most ten million cases.
        let [collapsed, judged] =
            [self.collapsed, self.judged].map(|count| u32::try_from(count).unwrap_or(u32::MAX));
        let interval = wilson(collapsed, judged, 0.95);
        Some((f64::from(collapsed) / f64::from(judged), [interval.low, interval.high]))
    }
}

described! {
    /// Rule by which a Monte Carlo design stops before its maximum number of cases.
    #[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
    pub struct StopRule {
        /// Half-width of the 95 % interval (Wilson) of the collapse probability at which sampling stops.
        pub half_width: f64 as "1",
        /// Number of cases before the interval is tested for the first time.
        pub least: u32,
    }
}

impl StopRule {
    /// `true` if the cases counted in `tally` satisfy the rule. `tally` must count all cases from the first one to
    /// the end of a chunk.
    pub(super) fn met(&self, tally: Tally) -> bool {
        let half = tally.collapse().map(|(_, [low, high])| 0.5 * (high - low));
        tally.cases >= u64::from(self.least) && half.is_some_and(|half| half <= self.half_width)
    }
}

#[cfg(test)]
#[expect(clippy::print_stdout, reason = "the rows of the table of validation/statistics.md")]
mod tests {
    use barrelstack_motion::Random;

    use super::{StopRule, Tally};

    /// Simulates studies with a stopping rule, tested after every chunk of 16 cases.
    ///
    /// Returns the fraction of studies whose interval covers the probability, and the mean of the reported share.
    fn stopped(probability: f64, rule: StopRule) -> [f64; 2] {
        const STUDIES: u32 = 2000;
        let mut random = Random::new(32);
        let (mut covered, mut shares) = (0, 0.0);
        for _ in 0..STUDIES {
            let mut tally = Tally::default();
            while !rule.met(tally) {
                for _ in 0..16 {
                    tally.add(if random.uniform() < probability { "collapse" } else { "stable" });
                }
            }
            let (share, [low, high]) = tally.collapse().unwrap();
            covered += u32::from((low..=high).contains(&probability));
            shares += share;
        }
        [f64::from(covered), shares].map(|sum| sum / f64::from(STUDIES))
    }

    #[test]
    fn a_study_that_stops_by_itself_claims_no_more_than_its_interval() {
        println!("| probability | half-width | covered | mean share |");
        for probability in [0.01, 0.05, 0.1, 0.2, 0.3, 0.5] {
            for (half_width, least) in [(0.1, 100), (0.05, 100), (0.03, 100), (0.05, 32)] {
                let [covered, share] = stopped(probability, StopRule { half_width, least });
                println!("| {probability} | {half_width} ({least}) | {covered:.3} | {share:.4} |");
                // Measured: at least 0.936. For 2000 studies with a coverage of 95 %, the fraction has a standard
                // deviation of 0.5 %; without a stopping rule, Wilson's interval covers some probabilities in only 93 %
                // of the studies.
                assert!(covered > 0.93, "{probability} {half_width} {covered}");
                // Measured: the mean share is too low by at most 0.0059, at a half-width of 0.05, since a study with
                // few collapses stops sooner.
                assert!((share - probability).abs() < 0.2 * half_width, "{probability} {share}");
            }
        }
    }

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
