//! Limit states: what counts as failure.

use std::collections::BTreeSet;

use super::cases::{Case, Cases};

/// What counts as failure of a stack.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LimitState {
    /// A barrel or rack loses its seat: collapse.
    SeatLost,
    /// At least so many barrels fall.
    Fallen(u32),
    /// Collapse in a mode.
    Mode(String),
}

impl LimitState {
    /// Whether a case is beyond it.
    pub fn reached(&self, case: &Case) -> bool {
        match self {
            Self::SeatLost => case.collapsed,
            Self::Fallen(count) => case.fallen() >= *count,
            Self::Mode(mode) => case.collapsed && case.mode.as_deref() == Some(mode),
        }
    }

    /// In words that follow "chance of".
    pub fn words(&self) -> String {
        match self {
            Self::SeatLost => "collapse (first seat lost)".to_owned(),
            Self::Fallen(1) => "a first barrel fallen".to_owned(),
            Self::Fallen(count) => format!("{count} or more barrels fallen"),
            Self::Mode(mode) => format!("collapse by {}", mode.replace('-', " ")),
        }
    }

    /// A short name for programs.
    pub fn name(&self) -> String {
        match self {
            Self::SeatLost => "collapse".to_owned(),
            Self::Fallen(count) => format!("fallen-{count}"),
            Self::Mode(mode) => format!("mode-{mode}"),
        }
    }

    /// Collapse, the first fall, a quarter, half and all of the barrels, and every mode that occurs.
    pub(super) fn worth_telling(cases: &Cases) -> Vec<Self> {
        let most = cases.most_barrels();
        let counts: BTreeSet<u32> =
            [1, most.div_ceil(4), most.div_ceil(2), most].into_iter().filter(|n| *n > 0).collect();
        let modes: BTreeSet<&str> =
            cases.all.iter().filter_map(|case| case.mode.as_deref()).collect();
        std::iter::once(Self::SeatLost)
            .chain(counts.into_iter().map(Self::Fallen))
            .chain(modes.into_iter().map(|mode| Self::Mode(mode.to_owned())))
            .collect()
    }
}
