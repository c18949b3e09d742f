//! Three-dimensional cases of a study.
//!
//! The result of each case is bit-identical to that of a single run of its scenario. A case has columns for
//! directions in addition to the columns of a case in a plane.

use std::ops::ControlFlow;

use barrelstack_report::column::Value;
use barrelstack_space::run::run_on;
use barrelstack_space::variants::Case as InSpace;
use barrelstack_space::{Ground, Heading, columns};

use super::Study;
use super::design::PlannedCase;
use super::prepare::Resources;
use crate::ensemble::CaseResult;
use crate::scenario::Scenario;
use crate::watch::Ending;

/// Result of a case, with directions if the case is three-dimensional.
pub(super) struct FinishedCase {
    pub(super) result: CaseResult,
    /// Direction in which the first body left its seat (`None` if no body did), and for each fallen barrel the
    /// direction from its position at rest to its final position.
    ///
    /// `None` for a case in a plane, or without a verdict.
    headings: Option<(Option<Heading>, Vec<Heading>)>,
}

/// Creates a result without directions, for a case in a plane or a case that could not run.
impl From<CaseResult> for FinishedCase {
    fn from(result: CaseResult) -> Self {
        Self { result, headings: None }
    }
}

impl From<InSpace> for FinishedCase {
    fn from(case: InSpace) -> Self {
        let headings = case.headings().map(|(first, debris)| (first, debris.to_vec()));
        Self { headings, result: case.result }
    }
}

impl Study {
    /// Runs a three-dimensional case under all components of its motion, which are scaled by a common factor; `None` if
    /// canceled.
    pub(super) fn run_in_space(
        &self,
        case: &PlannedCase,
        scenario: &Scenario,
        factor: f64,
        resources: &mut Resources<'_>,
    ) -> Option<FinishedCase> {
        let motion = &self.motions[case.motion];
        let ground = resources.cache.in_space(motion, &scenario.motion, scenario.run.similitude);
        let finished = match ground {
            Ok(ground) => run(scenario, ground.scaled(factor).under(scenario), resources.stop)?,
            Err(error) => CaseResult::failed(error.to_string()).into(),
        };
        (resources.report)(&finished.result);
        Some(finished)
    }
}

fn run(scenario: &Scenario, ground: Ground, stop: &dyn Fn() -> bool) -> Option<FinishedCase> {
    let mut going = |_| if stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    match run_on(scenario, ground, &mut going) {
        Ok(run) if run.ending == Ending::Interrupted => None,
        Ok(run) => Some(InSpace::of(&run).into()),
        Err(failure) => Some(InSpace::refused(scenario, &failure).into()),
    }
}

/// Returns the values of a case for the columns that only three-dimensional cases have, in the order of
/// [`columns::specs`].
pub(super) fn values(finished: &FinishedCase) -> impl Iterator<Item = Option<Value>> {
    columns::values(finished.headings.as_ref().map(|(first, debris)| (*first, debris.as_slice())))
}
