//! What the end of a run says of it, in a plane and in space.

use barrelstack_dynamics::simulate::RunTotals;
use barrelstack_dynamics::space::Space;
use barrelstack_dynamics::{EnergySummary, RunError};

use super::CUT;
use crate::outcome::Outcome;
use crate::watch::Ending;

/// Share of the energy that went through, missing from the books, above which a run is invalid.
///
/// A hundred times what leads to a warning, and two thousand times what a sound step leaves open.
const BOOKS_BROKEN: f64 = 0.1;

/// The same above which the reader is warned.
const BOOKS_OPEN: f64 = 1e-3;

/// What a run that came to its end leaves behind.
pub struct Ended {
    /// The energy books at the end.
    pub energy: EnergySummary,
    /// Accepted steps.
    pub steps: u64,
}

/// What the end of a run says of it.
pub struct Verdict {
    /// What happened.
    pub outcome: Outcome,
    /// The energy books at the end; none where numbers were lost.
    pub energy: Option<EnergySummary>,
    /// Accepted steps.
    pub steps: u64,
    /// What the reader of the result should know, one sentence each.
    pub warnings: Vec<String>,
    /// Why it ended.
    pub ending: Ending,
}

impl Verdict {
    /// Judges a run that ended at a time (s) and whose motion ends at another (s), and says what its end leaves open.
    pub fn of(
        ended: Result<Ended, RunError>,
        judge: impl FnOnce() -> Outcome,
        time: f64,
        motion_end: f64,
        ending: Ending,
    ) -> Self {
        match ended {
            Ok(Ended { energy, steps }) => {
                let broken = energy.residual_ratio() > BOOKS_BROKEN;
                let outcome = if broken {
                    Outcome::Invalid { reason: broken_books(&energy) }
                } else if ending == Ending::Interrupted {
                    Outcome::Interrupted
                } else {
                    judge()
                };
                let mut warnings = Vec::new();
                warnings.extend(energy_warning(&energy).filter(|_| !broken));
                warnings.extend(ending_warning(ending, &outcome, motion_end, time));
                Self { outcome, energy: Some(energy), steps, warnings, ending }
            }
            Err(error) => {
                let RunError::NotFinite { steps, .. } = error;
                let outcome = Outcome::Invalid { reason: error.to_string() };
                let ending = Ending::Broken;
                Self { outcome, energy: None, steps, warnings: Vec::new(), ending }
            }
        }
    }
}

impl Ended {
    /// Of a single run.
    pub fn of<S: Space<Real = f64>>(totals: &RunTotals<S>) -> Self {
        Self { energy: totals.energy.summary(0), steps: totals.steps }
    }
}

/// Why a run whose energy books do not balance has no outcome.
fn broken_books(energy: &EnergySummary) -> String {
    format!(
        "the energy books miss {:.2e} times the energy that went through, so the steps follow no \
         motion of these bodies: leave out run.step, or try a tenth of it",
        energy.residual_ratio()
    )
}

fn energy_warning(energy: &EnergySummary) -> Option<String> {
    let ratio = energy.residual_ratio();
    (ratio > BOOKS_OPEN).then(|| {
        format!(
            "the energy books miss {:.2} % of the energy that went through: try half the step \
             (run.step)",
            100.0 * ratio
        )
    })
}

/// What the end of a run leaves open.
fn ending_warning(ending: Ending, outcome: &Outcome, motion_end: f64, time: f64) -> Option<String> {
    match ending {
        Ending::Interrupted => Some(format!(
            "the run was stopped at {time:.3} s, before its end: its numbers hold until then, and it has no outcome"
        )),
        // A stack that stands in the middle of a motion has not stood it.
        Ending::Duration if *outcome == Outcome::Stable && motion_end - time > CUT => {
            Some(format!(
                "the run ends at {time:.1} s, the motion at {motion_end:.1} s: what the rest of it does is not \
                 known; leave out run.duration to see all of it"
            ))
        }
        Ending::Patience => Some(format!(
            "something still moved at {time:.1} s, when the run ended; a longer run.patience shows \
             more"
        )),
        Ending::Duration
        | Ending::AfterCollapse
        | Ending::Rest
        | Ending::Broken
        | Ending::NotShaken => None,
    }
}
