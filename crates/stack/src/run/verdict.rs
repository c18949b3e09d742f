//! Verdict at the end of a run, planar or three-dimensional.

use barrelstack_dynamics::simulate::RunTotals;
use barrelstack_dynamics::space::Space;
use barrelstack_dynamics::{EnergySummary, RunError};

use super::CUT;
use crate::outcome::Outcome;
use crate::watch::Ending;

/// Maximum ratio of the energy residual to the energy that passed through the system; a run with a larger ratio is
/// invalid.
///
/// A hundredth of this ratio leads to a warning ([`BOOKS_OPEN`]). With an adequate time step, the ratio is about 5e-5,
/// two thousand times smaller.
const BOOKS_BROKEN: f64 = 0.1;

/// Maximum ratio of the energy residual to the energy that passed through the system; a larger ratio leads to a
/// warning.
const BOOKS_OPEN: f64 = 1e-3;

/// Totals of a run without numerical breakdown.
pub struct Ended {
    /// Energy balance at the end.
    pub energy: EnergySummary,
    /// Number of accepted steps.
    pub steps: u64,
}

/// Verdict at the end of a run.
pub struct Verdict {
    /// The outcome.
    pub outcome: Outcome,
    /// Energy balance at the end; `None` after a numerical breakdown.
    pub energy: Option<EnergySummary>,
    /// Number of accepted steps.
    pub steps: u64,
    /// Warnings for the reader of the result, one sentence each.
    pub warnings: Vec<String>,
    /// Reason for the end of the run.
    pub ending: Ending,
}

impl Verdict {
    /// Returns the verdict on a run that ended at `time` (s), with warnings about its energy balance and its end.
    ///
    /// The ground motion ends at `motion_end` (s). `judge` determines the outcome of a valid run that was not
    /// interrupted.
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
                    Outcome::Invalid { reason: broken_balance(&energy) }
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
    /// Returns the totals of a single run.
    pub fn of<S: Space<Real = f64>>(totals: &RunTotals<S>) -> Self {
        Self { energy: totals.energy.summary(0), steps: totals.steps }
    }
}

/// Returns the message that a run is invalid because its energy balance does not close.
fn broken_balance(energy: &EnergySummary) -> String {
    format!(
        "the energy balance is off by {:.2e} times the energy that passed through the system, so the computed motion \
         is meaningless: leave out run.step, or try a tenth of it",
        energy.residual_ratio()
    )
}

fn energy_warning(energy: &EnergySummary) -> Option<String> {
    let ratio = energy.residual_ratio();
    (ratio > BOOKS_OPEN).then(|| {
        format!(
            "the energy balance is off by {:.2} % of the energy that passed through the system: try half the time step \
             (run.step)",
            100.0 * ratio
        )
    })
}

/// Returns the duration (s) of the ground motion that was left when `run.duration` ended a run. Returns `None` if at
/// most [`CUT`] was left, or if the run ended for another reason.
pub fn cut(ending: Ending, motion_end: f64, time: f64) -> Option<f64> {
    let left = motion_end - time;
    (ending == Ending::Duration && left > CUT).then_some(left)
}

/// Returns a warning if the run ended too early to determine the outcome.
fn ending_warning(ending: Ending, outcome: &Outcome, motion_end: f64, time: f64) -> Option<String> {
    match ending {
        Ending::Interrupted => Some(format!(
            "the run was stopped at {time:.3} s, before its end: its results are valid up to that time, and it has no \
             outcome"
        )),
        // A stack that still stands in the middle of a motion has not survived the motion yet.
        Ending::Duration
            if *outcome == Outcome::Stable && cut(ending, motion_end, time).is_some() =>
        {
            Some(format!(
                "the run ends at {time:.1} s, before the motion ends at {motion_end:.1} s: the effect of the remaining \
                 motion is not known; leave out run.duration to cover the whole motion"
            ))
        }
        Ending::Patience => Some(format!(
            "a body was still moving at {time:.1} s, when the run ended; raise run.patience to see it come \
             to rest"
        )),
        Ending::Duration
        | Ending::AfterCollapse
        | Ending::Rest
        | Ending::Broken
        | Ending::NotShaken => None,
    }
}
