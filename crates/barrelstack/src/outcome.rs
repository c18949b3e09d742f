//! What happened to the stack, in one word and with its reasons.

use crate::assemble::{Assembly, PartKind};
use crate::watch::{Fates, Loss};

/// How a stack collapses; the modes of the shaking-table tests behind the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CollapseMode {
    /// Barrels of the top level are thrown out of their cradles, or off the stack with their rack.
    Ejection,
    /// Two or more upper levels, or a level below the top, rock off together.
    Rocking,
    /// A rack walks off the barrels below while it is nearly level.
    RackSliding,
    /// The whole stack turns over about its foot.
    Overturning,
}

impl CollapseMode {
    /// The word used in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ejection => "ejection",
            Self::Rocking => "rocking",
            Self::RackSliding => "rack-sliding",
            Self::Overturning => "overturning",
        }
    }
}

/// What happened to the stack.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Everything kept its seat.
    Stable,
    /// A body left its seat.
    Collapse {
        /// How.
        mode: CollapseMode,
        /// When (s) the first body left its seat.
        time: f64,
        /// Which body that was.
        first: String,
        /// The lowest level whose seat or support gave way.
        from_level: u32,
        /// The highest level that went.
        to_level: u32,
    },
    /// A free scene has no seats to lose.
    NotJudged,
    /// The numbers broke down.
    Invalid {
        /// Why, with time and body.
        reason: String,
    },
}

impl Outcome {
    /// The word used in files and reports.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Collapse { .. } => "collapse",
            Self::NotJudged => "not-judged",
            Self::Invalid { .. } => "invalid",
        }
    }
}

/// How long (s, full scale) after the first loss of seat another one counts as part of the same event.
const SAME_EVENT: f64 = 1.0;

/// Judges a run by the fates of its bodies.
///
/// The event is what leaves its seat within [`SAME_EVENT`] of the first loss.
/// If the bottom rack has turned over it is overturning.
/// Otherwise the lowest rack that left its seat decides: if it slid off while nearly level it is rack
/// sliding; if it carries only the top level it is ejection; if it carries more it is rocking of the
/// levels from there up.
/// If no rack left its seat, barrels alone did: ejection.
pub fn judge(assembly: &Assembly, fates: &Fates, time_scale: f64) -> Outcome {
    if assembly.levels == 0 {
        return Outcome::NotJudged;
    }
    let (Some(time), Some(first)) = (fates.collapse_time(), fates.first()) else {
        return Outcome::Stable;
    };
    let end = time + SAME_EVENT * time_scale;
    let lost = |body: usize| {
        fates.fate(body).left_seat.filter(|(when, _)| *when <= end).map(|(_, loss)| loss)
    };
    let level = |body: usize| assembly.parts[body].level.unwrap_or(1);
    let racks: Vec<(usize, Loss)> = assembly
        .of_kind(PartKind::Rack)
        .filter_map(|body| lost(body).map(|loss| (body, loss)))
        .collect();
    let gone = (0..assembly.parts.len()).filter(|body| lost(*body).is_some());
    let to_level = gone.map(level).max().unwrap_or_else(|| level(first));
    let lowest = racks.iter().min_by_key(|(body, _)| level(*body));
    let (mode, from_level) = match lowest {
        Some((body, _)) if level(*body) == 1 => (CollapseMode::Overturning, 1),
        Some((body, Loss::Slid)) => (CollapseMode::RackSliding, level(*body)),
        Some((body, _)) if level(*body) == assembly.levels => {
            (CollapseMode::Ejection, level(*body))
        }
        Some((body, _)) => (CollapseMode::Rocking, level(*body)),
        None => (CollapseMode::Ejection, level(first)),
    };
    Outcome::Collapse {
        mode,
        time,
        first: assembly.parts[first].name.clone(),
        from_level,
        to_level: to_level.max(from_level),
    }
}
