//! Limit states: definitions of the failure of a stack.

use std::collections::BTreeSet;

use super::cases::{Cases, JudgedCase};

/// Definition of the failure of a stack.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LimitState {
    /// Collapse: at least one barrel or rack loses its seat.
    SeatLost,
    /// At least this number of barrels fall.
    Fallen(u32),
}

impl LimitState {
    /// Returns `true` if it is known whether a case reached the limit state.
    pub(super) fn is_known(&self, case: &JudgedCase) -> bool {
        match self {
            Self::SeatLost => true,
            Self::Fallen(_) => case.followed,
        }
    }

    /// Returns `true` if a case reached the limit state.
    pub fn reached(&self, case: &JudgedCase) -> bool {
        match self {
            Self::SeatLost => case.collapsed,
            Self::Fallen(count) => case.fallen() >= *count,
        }
    }

    /// Returns the name for display, worded so that it can follow "chance of".
    pub fn words(&self) -> String {
        match self {
            Self::SeatLost => "collapse (first seat lost)".to_owned(),
            Self::Fallen(1) => "one or more barrels fallen".to_owned(),
            Self::Fallen(count) => format!("{count} or more barrels fallen"),
        }
    }

    /// Returns a short, machine-readable name.
    pub fn name(&self) -> String {
        match self {
            Self::SeatLost => "collapse".to_owned(),
            Self::Fallen(count) => format!("fallen-{count}"),
        }
    }

    /// Returns the limit states to be evaluated.
    ///
    /// The first is collapse. If the numbers of fallen barrels are known, four others follow: at least one barrel, at
    /// least a quarter of the barrels, at least half of them, and all of them fall. For small stacks, some of the four
    /// coincide and are listed once.
    pub(super) fn worth_telling(cases: &Cases) -> Vec<Self> {
        let most = if cases.has_losses() { cases.most_barrels() } else { 0 };
        let counts: BTreeSet<u32> =
            [1, most.div_ceil(4), most.div_ceil(2), most].into_iter().filter(|n| *n > 0).collect();
        std::iter::once(Self::SeatLost).chain(counts.into_iter().map(Self::Fallen)).collect()
    }
}
