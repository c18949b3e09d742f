//! Implements [`Comparable`] for three-dimensional results.

use std::ops::ControlFlow;

use barrelstack::assemble::PartKind;
use barrelstack::compare::{Comparable, Side, Traced, share_of};
use barrelstack::ensemble::CaseResult;
use barrelstack::outcome::Outcome;
use barrelstack::run::cut;
use barrelstack::scenario::View;
use barrelstack::summary::AnySummary;
use barrelstack::variants::{Advance, RunChoice};
use barrelstack::{RunFailure, Scenario};
use barrelstack_report::Pane;

use crate::drawing::{Sight, ground_histories, scene, traces};
use crate::report::provenance;
use crate::run::Run;
use crate::variants::{Answer, Case, answered};
use crate::words::{headline, tone};

impl Comparable for Answer {
    fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    fn variant(&self) -> u32 {
        self.summary.variant
    }

    fn results(&self) -> Vec<Option<Vec<CaseResult>>> {
        let varied = self.summary.ensemble.is_some();
        vec![varied.then(|| self.cases.iter().map(|case| case.result.clone()).collect())]
    }

    fn with_variant(
        &self,
        number: u32,
        observer: &mut (dyn FnMut(Advance) -> ControlFlow<()> + Send),
    ) -> Result<Self, RunFailure> {
        let cases = Some(self.cases.clone());
        answered(&self.scenario, RunChoice::Number(number), cases, observer)
    }

    fn worst(&self) -> (f64, Option<View>) {
        (share_of(self.summary.ensemble.as_ref(), &self.run.outcome), None)
    }

    fn side(self, name: String, _: Option<View>) -> Side {
        let Self { scenario, run, summary, cases } = self;
        let collapsed = summary.ensemble.as_ref().map(|_| {
            let variants = cases.iter().skip(1).map(|Case { result, .. }| result.collapsed());
            (Some("spatial"), variants.collect())
        });
        let drawn = scene(&run, Sight::Across);
        Side {
            name,
            stated: scenario,
            scenario: run.scenario.clone(),
            view: None,
            outcome: run.outcome.clone(),
            end_time: run.end_time,
            cut: cut(run.ending, run.ground.end(), run.end_time),
            collapse_time: match run.outcome {
                Outcome::Collapse { time, .. } => Some(time),
                Outcome::Stable
                | Outcome::NotJudged
                | Outcome::Interrupted
                | Outcome::Invalid { .. } => None,
            },
            pane: Pane {
                mark: String::new(),
                name: String::new(),
                verdict: headline(&run, &summary),
                tone: tone(&run, &summary),
                traces: traces(&run, &drawn),
                scene: drawn,
            },
            ground: ground_histories(&run),
            traced: traced(&run),
            provenance: provenance(&run, &summary),
            summary: AnySummary::Spatial(Box::new(summary)),
            other: None,
            collapsed: collapsed.into_iter().collect(),
        }
    }
}

/// Returns the displacement histories of the first barrel of the top level and of the first rack of the bottom level,
/// each across and along the barrels. A history consists of the times (s) and the displacements (cm).
fn traced(run: &Run) -> Vec<(Traced, [Vec<f64>; 2])> {
    let first =
        |kind, level| run.stack.of_kind(kind).find(|body| run.stack.parts[*body].level == level);
    let (top, base) = (first(PartKind::Barrel, run.stack.levels), first(PartKind::Rack, 1));
    [
        (Traced::TopAcross, top, 0),
        (Traced::TopAlong, top, 1),
        (Traced::BaseAcross, base, 0),
        (Traced::BaseAlong, base, 1),
    ]
    .into_iter()
    .filter_map(|(what, body, axis)| {
        let values = run.path(body?).iter().map(|moved| 100.0 * moved[axis]).collect();
        Some((what, [run.frames.times.clone(), values]))
    })
    .collect()
}
