//! Implementation of [`Repeatable`] for three-dimensional runs. Reruns with small changes show how reliable a result
//! is.

use std::ops::ControlFlow;

use barrelstack::assemble::PartKind;
use barrelstack::ground::from_disk;
use barrelstack::summary::OutcomeSummary;
use barrelstack::verify::Repeatable;
use barrelstack::watch::Ending;
use barrelstack::{Progress, RunFailure, Scenario};
use barrelstack_dynamics::Simulation;

use crate::ground::Ground;
use crate::run::{Run, run_on};
use crate::summary;

impl Repeatable for Run {
    fn again(
        scenario: &Scenario,
        observer: &mut dyn FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Self, RunFailure> {
        let scenario = scenario.with_records(&mut from_disk)?;
        run_on(&scenario, Ground::of(&scenario)?, observer)
    }

    fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    fn is_interrupted(&self) -> bool {
        self.ending == Ending::Interrupted
    }

    fn outcome(&self) -> OutcomeSummary {
        summary::outcome(self).common
    }

    fn falls(&self) -> Vec<Option<f64>> {
        self.stack.of_kind(PartKind::Barrel).map(|body| self.fates[body].fell_at).collect()
    }

    fn times(&self) -> &[f64] {
        &self.frames.times
    }

    fn paths(&self) -> Vec<Vec<[f64; 3]>> {
        (1..self.stack.parts.len()).map(|body| self.path(body)).collect()
    }
}
