//! Many collapses simulated, and what an observer would have seen of each.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use barrelstack::ensemble::{CaseResult, Ensemble, Prepared, Width};
use barrelstack::outcome::Outcome;
use barrelstack::scenario::{BodyOverride, Scenario, Scene, StackBody};
use barrelstack_motion::Random;

use super::observed::{Mode, Time};

/// What an observer would have seen of a case.
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
    fn of(case: &CaseResult) -> Option<Self> {
        // A stack that was tested had come to rest first: parameters with which it does not are none of it.
        if case.fell_at_rest() {
            return None;
        }
        let (mode, loss) = match case.outcome.as_ref().ok()? {
            Outcome::Stable => (Mode::Stands, Time::Never),
            Outcome::Collapse { mode, time, .. } => (Mode::Collapse(*mode), Time::At(*time)),
            Outcome::Invalid { .. } | Outcome::NotJudged | Outcome::Interrupted => return None,
        };
        let fall = |(barrel, time): &(String, Option<f64>)| {
            (barrel.clone(), time.map_or(Time::Never, Time::At))
        };
        Some(Self { mode, loss, falls: case.falls.iter().map(fall).collect() })
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

/// Simulates all cases on all cores, in their order; none where one cannot be simulated.
///
/// `done` hears again and again how many cases are done and may stop them; then there is nothing.
pub(super) fn simulate(
    cases: Vec<Prepared>,
    lanes: Option<Width>,
    done: &(dyn Fn(usize) -> ControlFlow<()> + Sync),
) -> Option<Vec<Option<Seen>>> {
    let finished = AtomicUsize::new(0);
    let observer = |_: &CaseResult| done(finished.fetch_add(1, Ordering::Relaxed) + 1);
    let stop = || done(finished.load(Ordering::Relaxed)).is_break();
    let results = Ensemble { cases, lanes }.run_until(&observer, &stop)?;
    Some(results.iter().map(Seen::of).collect())
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
                    row: None,
                    mass: None,
                    fill: None,
                    offset_x: scatter * random.normal(),
                    offset_y: 0.0,
                });
            }
        }
    }
    changed
}
