//! Robustness of an outcome against small changes.

use barrelstack_report::described;

use super::Repeat;
use crate::summary::OutcomeSummary;

described! {
    /// Agreement between the run and its repeats; `kind`, `mode` and `first` are false if there are no repeats.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Robust {
        /// True if all repeats agree with the run on whether the stack stands or collapses.
        pub kind: bool,
        /// True if all repeats agree with the run on the mode of the collapse.
        pub mode: bool,
        /// True if all repeats agree with the run on the first body that leaves its seat.
        pub first: bool,
        /// Largest difference between the time of the first fall of a barrel in the run and in a repeat; null if no
        /// barrel falls in the run or in at least one of the repeats.
        pub first_fall_within: Option<f64> as "s",
        /// Smallest and largest number of barrels that fall, over the run and its repeats.
        pub barrels_fallen: [usize; 2],
    }
}

impl Robust {
    /// `true` if the kind of the outcome, the mode of the collapse and the first body that leaves its seat are the same
    /// in the run and in all repeats.
    pub fn outcome(&self) -> bool {
        self.kind && self.mode && self.first
    }

    pub(super) fn of(own: &OutcomeSummary, repeats: &[Repeat]) -> Self {
        let all = |same: fn(&OutcomeSummary, &OutcomeSummary) -> bool| {
            !repeats.is_empty() && repeats.iter().all(|repeat| same(own, &repeat.outcome))
        };
        let late = |repeat: &Repeat| Some((repeat.outcome.first_fall? - own.first_fall?).abs());
        let late: Option<Vec<f64>> = repeats.iter().map(late).collect();
        let fallen = || {
            let repeats = repeats.iter().map(|repeat| repeat.outcome.barrels_fallen);
            repeats.chain(std::iter::once(own.barrels_fallen)).flatten()
        };
        Self {
            kind: all(|a, b| a.kind == b.kind),
            mode: all(|a, b| a.mode == b.mode),
            first: all(|a, b| a.first == b.first),
            first_fall_within: late.and_then(|late| late.into_iter().reduce(f64::max)),
            barrels_fallen: [fallen().min(), fallen().max()].map(Option::unwrap_or_default),
        }
    }
}
