//! Simulated collapses, reduced to the quantities that an observer of a test records.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use barrelstack::ensemble::{CaseResult, Ensemble, Prepared, Width};
use barrelstack::ground::{Ground, GroundError};
use barrelstack::outcome::Outcome;
use barrelstack::scenario::{BodyOverride, Scenario, Scene, StackBody};
use barrelstack_motion::Random;
use barrelstack_space::variants::run_each;

use super::observed::{Mode, Time};

/// Course of a simulated case, as an observer of a test could record it: the mode of collapse and the times
/// of the events.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Course {
    /// Mode of collapse; `Mode::Stands` if the stack stands.
    pub(crate) mode: Mode,
    /// Time at which the first body left its seat.
    pub(crate) loss: Time,
    /// Name of each barrel and the time at which it counts as fallen, in the order of the bodies.
    pub(crate) falls: Vec<(String, Time)>,
}

impl Course {
    fn of(case: &CaseResult) -> Option<Self> {
        // The tested stack stood before it was shaken, so parameters with which it falls at rest are impossible.
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

    /// Returns the first barrel to fall and the time of its fall; `None` if none falls.
    pub(super) fn first_fall(&self) -> Option<(&str, f64)> {
        let fallen = self.falls.iter().filter_map(|(barrel, time)| match time {
            Time::At(time) => Some((barrel.as_str(), *time)),
            Time::Never => None,
        });
        fallen.min_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Returns the time at which the barrel with the name `barrel` counts as fallen; `None` if there is no such barrel.
    pub(super) fn fall(&self, barrel: &str) -> Option<Time> {
        self.falls.iter().find(|(name, _)| name == barrel).map(|(_, time)| *time)
    }
}

/// Ground motion of a test.
#[derive(Clone)]
pub(crate) enum Shaking {
    /// Motion in a vertical plane.
    Planar(Arc<Ground>),
    /// Motion in three dimensions.
    Spatial(Arc<barrelstack_space::Ground>),
}

impl Shaking {
    /// Returns the motion of a scenario.
    pub(crate) fn of(scenario: &Scenario) -> Result<Self, GroundError> {
        Ok(if scenario.is_spatial() {
            Self::Spatial(Arc::new(barrelstack_space::Ground::of(scenario)?))
        } else {
            Self::Planar(Arc::new(scenario.ground()?))
        })
    }

    /// Returns the motion scaled by a factor.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        match self {
            Self::Planar(ground) => Self::Planar(Arc::new(ground.scaled(factor))),
            Self::Spatial(ground) => Self::Spatial(Arc::new(ground.scaled(factor))),
        }
    }
}

/// A stack that is ready to be shaken.
pub(crate) struct Built {
    pub(crate) scenario: Arc<Scenario>,
    pub(crate) ground: Shaking,
}

/// Simulates all cases on all cores and returns their courses in order. The course of a case that cannot be simulated
/// is `None`.
///
/// `done` is called repeatedly with the number of completed cases, and may cancel the remaining cases. If it does,
/// `simulate` returns `None` instead of the courses.
pub(crate) fn simulate(
    cases: Vec<Built>,
    lanes: Option<Width>,
    done: &(dyn Fn(usize) -> ControlFlow<()> + Sync),
) -> Option<Vec<Option<Course>>> {
    let (mut planar, mut spatial) = (Vec::new(), Vec::new());
    let mut in_space = Vec::new();
    for Built { scenario, ground } in cases {
        in_space.push(matches!(ground, Shaking::Spatial(_)));
        match ground {
            Shaking::Planar(ground) => planar.push(Prepared::shaken_by(scenario, ground)),
            Shaking::Spatial(ground) => spatial.push((scenario, ground)),
        }
    }
    let finished = AtomicUsize::new(0);
    let observer = |_: &CaseResult| done(finished.fetch_add(1, Ordering::Relaxed) + 1);
    let stop = || done(finished.load(Ordering::Relaxed)).is_break();
    let mut planar = Ensemble { cases: planar, lanes }.run_until(&observer, &stop)?.into_iter();
    let before = finished.into_inner();
    let shaken = |(scenario, ground): &(Arc<Scenario>, Arc<barrelstack_space::Ground>)| {
        ((**scenario).clone(), (**ground).clone())
    };
    let mut spatial = run_each(&spatial, &shaken, &|now| done(before + now)).into_iter();
    // Back into the order of the cases.
    let results: Option<Vec<CaseResult>> = in_space
        .into_iter()
        .map(|space| if space { spatial.next().map(|case| case.result) } else { planar.next() })
        .collect();
    let results = results.filter(|all| !all.iter().any(CaseResult::is_interrupted))?;
    Some(results.iter().map(Course::of).collect())
}

/// Returns a copy of the scenario with random offsets of every rack and barrel, since no two stacks are built
/// alike.
///
/// The offsets are normally distributed with the standard deviation `scatter` (m).
pub(crate) fn placed(scenario: &Scenario, scatter: f64, random: &mut Random) -> Scenario {
    let mut changed = scenario.clone();
    let Scene::Stack { stack, .. } = &mut changed.scene else { return changed };
    let (levels, columns, racks) = (stack.levels, stack.columns, stack.racks_per_level());
    let rows = |along: u32| match stack.space {
        Some(_) => (1..=along).map(Some).collect(),
        None => vec![None],
    };
    let along = stack.space.map_or(1, |space| space.columns_along);
    let bodies = [
        (StackBody::Rack, racks, rows(stack.racks_along())),
        (StackBody::Barrel, columns, rows(along)),
    ];
    for (body, columns, rows) in bodies {
        for row in rows {
            for level in 1..=levels {
                for column in 1..=columns {
                    stack.overrides.push(BodyOverride {
                        body,
                        level,
                        column: Some(column),
                        row,
                        mass: None,
                        fill: None,
                        offset_x: scatter * random.normal(),
                        offset_y: row.map_or(0.0, |_| scatter * random.normal()),
                    });
                }
            }
        }
    }
    changed
}
