//! Outcome of a run.

use crate::assemble::{Assembly, PartKind};
use crate::scenario::View;
use crate::watch::{Fates, Loss};

/// Collapse mode of a stack. The names of all modes except gravity are those of Candia, de la Llera and Almazán (2008).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CollapseMode {
    /// Barrels of the top level are thrown out of their cradles, or off the stack with their rack.
    Ejection,
    /// Two or more upper levels rock and fall together.
    Rocking,
    /// A rack walks along the barrels below until its rail passes the ends of these barrels. Among planar models, only
    /// the model along the barrels can show this mode.
    RackSliding,
    /// The whole stack overturns about an edge of its base.
    Overturning,
    /// The stack falls under its own weight before it is shaken.
    Gravity,
}

impl CollapseMode {
    /// The collapse modes of a stack that is shaken, which are all modes except gravity.
    pub const SHAKEN: [Self; 4] =
        [Self::Ejection, Self::Rocking, Self::RackSliding, Self::Overturning];

    /// Returns the mode with the given [`name`](CollapseMode::name).
    pub fn named(name: &str) -> Option<Self> {
        let all = Self::SHAKEN.into_iter().chain([Self::Gravity]);
        all.into_iter().find(|mode| mode.name() == name)
    }

    /// Returns the name of the mode in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ejection => "ejection",
            Self::Rocking => "rocking",
            Self::RackSliding => "rack-sliding",
            Self::Overturning => "overturning",
            Self::Gravity => "gravity",
        }
    }
}

/// Outcome of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Every body kept its seat.
    Stable,
    /// A body left its seat.
    Collapse {
        /// Collapse mode.
        mode: CollapseMode,
        /// Time (s) at which the first body left its seat.
        time: f64,
        /// Name of the first body that left its seat.
        first: String,
        /// Lowest level that collapsed, which is the level of the body `first`.
        from_level: u32,
        /// Highest level that collapsed together with `from_level`.
        to_level: u32,
    },
    /// Not judged, because a free scene has no seats that could be lost.
    NotJudged,
    /// The caller stopped the run before its end, so its outcome is unknown.
    Interrupted,
    /// The computation broke down numerically, or its energy balance does not close.
    Invalid {
        /// Description of the failure: the time and the body of the breakdown, or the error of the energy balance.
        reason: String,
    },
}

impl Outcome {
    /// Returns `true` if a body left its seat.
    pub fn is_collapse(&self) -> bool {
        matches!(self, Self::Collapse { .. })
    }

    /// Returns `true` if the stack collapsed under its own weight before it was shaken.
    pub fn fell_at_rest(&self) -> bool {
        matches!(self, Self::Collapse { mode: CollapseMode::Gravity, .. })
    }

    /// Returns the name of the outcome in files and reports, without its details.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Collapse { .. } => "collapse",
            Self::NotJudged => "not-judged",
            Self::Interrupted => "interrupted",
            Self::Invalid { .. } => "invalid",
        }
    }
}

/// Judges a run by the first body that left its seat, because later losses of seats follow from the first. This body
/// determines the collapse mode:
///
/// - The bottom rack: overturning of the whole stack.
/// - A rack that passed the ends of the barrels below before it tilted, in a longitudinal view: rack
///   sliding.
/// - A rack of the top level, or a barrel from a rack that keeps its own seat: ejection.
/// - Any other rack: rocking of its level and all above.
///
/// This follows Candia, de la Llera and Almazán (2008), who classify the loss of the upper two of three levels as
/// rocking, and the loss of the top level of four (barrels and rack) as ejection of the top barrels.
pub fn judge(assembly: &Assembly, fates: &Fates) -> Outcome {
    if assembly.levels == 0 {
        return Outcome::NotJudged;
    }
    let (Some(time), Some(first)) = (fates.collapse_time(), fates.first()) else {
        return Outcome::Stable;
    };
    let part = &assembly.parts[first];
    let from_level = part.level.unwrap_or(1);
    let slid = matches!(fates.fate(first).left_seat, Some((_, Loss::Slid)));
    collapse(
        time,
        (&part.name, part.kind, from_level),
        slid && assembly.view == Some(View::Longitudinal),
        assembly.levels,
    )
}

/// Returns the collapse of a stack with `levels` levels that begins when a body leaves its seat at `time` (s).
///
/// The body is given by name, kind and level; `slid` is `true` if the body is a rack that slid off along the barrels.
pub fn collapse(
    time: f64,
    (first, kind, from_level): (&str, PartKind, u32),
    slid: bool,
    levels: u32,
) -> Outcome {
    let mode = match kind {
        PartKind::Rack if from_level == 1 => CollapseMode::Overturning,
        PartKind::Rack if slid => CollapseMode::RackSliding,
        PartKind::Rack if from_level < levels => CollapseMode::Rocking,
        PartKind::Rack
        | PartKind::Barrel
        | PartKind::Device
        | PartKind::Wine
        | PartKind::Body
        | PartKind::Ground => CollapseMode::Ejection,
    };
    let barrel_alone = mode == CollapseMode::Ejection && kind == PartKind::Barrel;
    let to_level = if barrel_alone { from_level } else { levels };
    Outcome::Collapse { mode, time, first: first.to_owned(), from_level, to_level }
}
