//! Many collapses simulated, and what an observer would have seen of each.

use std::ops::ControlFlow;

use barrelstack_motion::Random;

use super::observed::{Mode, Time};
use crate::assemble::PartKind;
use crate::outcome::Outcome;
use crate::pool;
use crate::run::{Run, run};
use crate::scenario::{BodyOverride, Scenario, Scene, StackBody};

/// What an observer would have seen of a run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Seen {
    /// How the stack went.
    pub(super) mode: Mode,
    /// When the first body left its seat.
    pub(super) loss: Time,
    /// When each barrel had fallen, by name, in the order of the bodies.
    pub(super) falls: Vec<(String, Time)>,
}

impl Seen {
    fn of(run: &Run) -> Option<Self> {
        let mode = match &run.outcome {
            Outcome::Stable => Mode::Stands,
            Outcome::Collapse { mode, .. } => Mode::Collapse(*mode),
            Outcome::Invalid { .. } | Outcome::NotJudged => return None,
        };
        let time = |time: Option<f64>| time.map_or(Time::Never, Time::At);
        let parts = &run.assembly.parts;
        let barrels = run.assembly.of_kind(PartKind::Barrel);
        let fall = |body: usize| (parts[body].name.clone(), time(run.fates.fate(body).fell_at));
        Some(Self {
            mode,
            loss: time(run.fates.collapse_time()),
            falls: barrels.map(fall).collect(),
        })
    }

    /// The first barrel to fall, and when.
    pub(super) fn first_fall(&self) -> Option<(&str, f64)> {
        let fallen = self.falls.iter().filter_map(|(barrel, time)| match time {
            Time::At(time) => Some((barrel.as_str(), *time)),
            Time::Never => None,
        });
        fallen.min_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// When a barrel had fallen; none where there is no such barrel.
    pub(super) fn fall(&self, barrel: &str) -> Option<Time> {
        self.falls.iter().find(|(name, _)| name == barrel).map(|(_, time)| *time)
    }
}

/// Simulates all scenarios, in their order; none where one cannot be simulated.
///
/// The one place that runs stacks for the calibration of collapses.
pub(super) fn simulate(scenarios: &[Scenario], done: &(dyn Fn(usize) + Sync)) -> Vec<Option<Seen>> {
    let one = |scenario: &Scenario| {
        let run = run(scenario, &mut |_| ControlFlow::Continue(())).ok()?;
        Seen::of(&run)
    };
    pool::map(scenarios, one, done)
}

/// A scenario with every rack and every barrel set down a little beside its place, by normal deviates
/// of a standard deviation (m): no two stacks are built alike.
pub(super) fn placed(scenario: &Scenario, scatter: f64, random: &mut Random) -> Scenario {
    let mut changed = scenario.clone();
    let Scene::Stack { stack, .. } = &mut changed.scene else { return changed };
    let (levels, columns, racks) = (stack.levels, stack.columns, stack.racks_per_level());
    for (body, columns) in [(StackBody::Rack, racks), (StackBody::Barrel, columns)] {
        for level in 1..=levels {
            for column in 1..=columns {
                stack.overrides.push(BodyOverride {
                    body,
                    level,
                    column: Some(column),
                    mass: None,
                    fill: None,
                    offset_x: scatter * random.normal(),
                });
            }
        }
    }
    changed
}
