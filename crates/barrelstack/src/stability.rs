//! Static stability of a stack: settlement, natural period, and the tilt of the floor at which the
//! stack fails.
//!
//! All results follow from static equilibria, without integration over time.

use barrelstack_dynamics::body::Motion;
use barrelstack_dynamics::settle::settle;
use barrelstack_dynamics::{Lack, Linear as _, Model, Planar, Scratch, State, Vec2, math};
use barrelstack_report::described;

use barrelstack_stack::scenario::{Scenario, View};
use barrelstack_stack::stand::{Standing, UNBALANCED, stand};

use crate::run::RunFailure;

/// Tilt (rad) of the floor at which the period of sway is computed. The tilt is so small that nothing slips.
const NUDGE: f64 = 1e-4;

/// First step (rad) by which the floor is tilted: 2°.
const FIRST_STEP: f64 = 2.0 * std::f64::consts::PI / 180.0;
/// Resolution (rad) of the tilt at failure: 1/16°.
const FINEST_STEP: f64 = FIRST_STEP / 32.0;

/// Largest tilt (rad) that is tried: 45°.
const STEEPEST: f64 = std::f64::consts::FRAC_PI_4;

described! {
    /// Static stability of stacks, with one row for each rack, plane and height.
    #[derive(Clone, Debug)]
    pub struct StabilityTable {
        /// Name and version of the format of this document.
        pub schema: &'static str ["stability/1"],
        /// Title of the scenario.
        pub title: String,
        /// The rows: first the rows for the rack of the scenario, then the rows for the other racks
        /// of the catalog.
        pub rows: Vec<StabilityRow>,
    }

    /// Static stability of one stack, or the reason why the stack does not stand.
    #[derive(Clone, Debug)]
    pub struct StabilityRow {
        /// Name of the rack.
        pub rack: String,
        /// The plane of the model.
        pub view: &'static str ["transverse", "longitudinal"],
        /// Number of levels.
        pub levels: u32,
        /// Stability at rest; null if the stack does not stand on a level floor.
        pub stands: Option<Stability>,
        /// Reason why the stack does not stand on a level floor, or cannot be built; null if the
        /// stack stands.
        pub refused: Option<String>,
    }

    /// Static stability of a stack that stands on a level floor.
    #[derive(Clone, Debug)]
    pub struct Stability {
        /// Largest downward displacement of a body as the stack settles into its contacts.
        pub sinking: f64 as "m",
        /// Longest period of sway while nothing slips, by Rayleigh's quotient; null if the stack
        /// does not withstand a sideways push of 1/10000 of its weight.
        pub period: Option<f64> as "s",
        /// Tilt of the floor at which the stack fails; null if it still stands at 45°.
        pub tilt: Option<f64> as "rad",
        /// Name of the body that fails first when the floor is tilted by `tilt`.
        pub body: Option<String>,
        /// Failure mode of the body that fails first.
        pub failure: Option<&'static str> ["slides", "tips", "is displaced"],
    }
}

/// Computes the static stability of the stack of a scenario, in the plane that the scenario states.
///
/// # Errors
/// As for [`Scenario::run`]; also if the stack does not stand on a level floor.
pub fn stability(scenario: &Scenario) -> Result<Stability, RunFailure> {
    let standing = stand(scenario, 1.0)?;
    let (tilt, first) = tilt_at_failure(&standing).unzip();
    let (body, failure) = first.unzip();
    Ok(Stability {
        sinking: standing.deepest_sinking(),
        period: period_of(&standing),
        tilt,
        body,
        failure,
    })
}

/// Returns the longest sway period (s) of a stack while nothing slips; `None` if the stack does not withstand a
/// sideways push of 1/10000 of its weight.
///
/// # Errors
/// As for [`stability`].
pub fn sway_period(scenario: &Scenario) -> Result<Option<f64>, RunFailure> {
    Ok(period_of(&stand(scenario, 1.0)?))
}

impl StabilityRow {
    /// Computes the row of a [`StabilityTable`] for the stack of a scenario, in the plane that the scenario states;
    /// `None` for a free scene.
    pub fn of(scenario: &Scenario) -> Option<Self> {
        let stack = scenario.stack()?;
        let (stands, refused) = match stability(scenario) {
            Ok(found) => (Some(found), None),
            Err(failure) => (None, Some(failure.to_string())),
        };
        let rack = stack.rack.base.to_owned();
        Some(Self { rack, view: stack.view.name(), levels: stack.levels, stands, refused })
    }
}

impl StabilityTable {
    /// Returns the table as lines of text.
    pub fn lines(&self) -> Vec<String> {
        let wide = self.rows.iter().map(|row| row.rack.len()).max().unwrap_or(0).max(4);
        let mut lines = vec![
            format!("Static stability with other racks and levels: {}", self.title),
            format!("{:wide$}  plane   levels  sinks (mm)  period (s)  falls at tilt", "rack"),
        ];
        lines.extend(self.rows.iter().map(|row| {
            let plane = if row.view == View::Transverse.name() { "across" } else { "along" };
            let found = match (&row.stands, &row.refused) {
                (Some(found), _) => {
                    let tilt = match (found.tilt, &found.body, found.failure) {
                        (Some(tilt), Some(body), Some(failure)) => {
                            format!("{:.1}°: {body} {failure}", tilt.to_degrees())
                        }
                        _ => "stands at 45°".to_owned(),
                    };
                    let period =
                        found.period.map_or("–".to_owned(), |period| format!("{period:.3}"));
                    format!("{:>10.1}  {period:>10}  {tilt}", 1e3 * found.sinking)
                }
                (None, refused) => refused.clone().unwrap_or_default(),
            };
            format!("{:wide$}  {plane:6}  {:>6}  {found}", row.rack, row.levels)
        }));
        lines
    }
}

/// Returns the longest period (s) of sway by Rayleigh's quotient; `None` if the pushed stack does not come to rest.
///
/// The shape of the motion is the displacement due to a sideways push. The quotient is the work of the push divided by
/// the sum of mass times squared displacement (and moment of inertia times squared rotation) over all bodies.
fn period_of(standing: &Standing) -> Option<f64> {
    let model = &standing.assembly.model;
    let pull = -model.gravity().z * math::sin_cos(NUDGE).0;
    let pulled = |tilt| {
        let (mut state, mut scratch) = (standing.state.clone(), standing.scratch.clone());
        settle(&tilted(model, tilt), &mut state, &mut scratch, UNBALANCED).ok().map(|_| state)
    };
    let pulled = [pulled(-NUDGE)?, pulled(NUDGE)?];
    let (mut work, mut swung) = (0.0, 0.0);
    for (id, body) in model.bodies().iter().enumerate() {
        if body.motion != Motion::Free {
            continue;
        }
        let [left, right] = pulled.each_ref().map(|state| state.poses[id]);
        let moved = (right.position - left.position) * 0.5;
        let turned = 0.5 * (right.orientation - left.orientation);
        work += body.mass * pull * moved.x;
        swung += body.mass * moved.dot(moved) + body.inertia * turned * turned;
    }
    Some(std::f64::consts::TAU * (swung / work).sqrt())
}

/// Returns the smallest tilt (rad) of the floor, to the left or to the right, at which the stack
/// fails, with the body that fails first and its failure mode. Returns `None` if the stack still
/// stands when the floor is tilted by 45° to either side.
fn tilt_at_failure(standing: &Standing) -> Option<(f64, (String, &'static str))> {
    let left = tilt_at_failure_to(standing, -1.0, STEEPEST);
    // The other side needs to be tried only up to the tilt found for the first side.
    let steepest = left.as_ref().map_or(STEEPEST, |(tilt, _)| *tilt);
    tilt_at_failure_to(standing, 1.0, steepest).or(left)
}

/// Returns the tilt at failure to one side, like [`tilt_at_failure`]; `None` if the stack stands at
/// `steepest` (rad).
///
/// The floor is tilted step by step, and the stack settles after each step.
fn tilt_at_failure_to(
    standing: &Standing,
    side: f64,
    steepest: f64,
) -> Option<(f64, (String, &'static str))> {
    let model = &standing.assembly.model;
    let (mut state, mut scratch) = (standing.state.clone(), standing.scratch.clone());
    let (mut tilt, mut step) = (0.0, FIRST_STEP);
    let mut failure = None;
    while tilt < steepest {
        let mut tried: (State<Planar>, Scratch<Planar>) = (state.clone(), scratch.clone());
        let next = (tilt + step).min(steepest);
        let steeper = tilted(model, side * next);
        match settle(&steeper, &mut tried.0, &mut tried.1, UNBALANCED) {
            Ok(_) => {
                (state, scratch) = tried;
                tilt = next;
            }
            Err(error) => {
                failure = Some((error.body, word(&error.lack)));
            }
        }
        // Once a steeper tilt has failed, the step is halved.
        if failure.is_some() {
            if step <= FINEST_STEP {
                break;
            }
            step *= 0.5;
        }
    }
    failure.map(|failure| (tilt, failure))
}

/// Names the failure mode that corresponds to a cause of failure.
fn word(lack: &Lack) -> &'static str {
    match lack {
        Lack::Friction { .. } | Lack::Stick { .. } => "slides",
        Lack::Balance { .. } => "tips",
        Lack::Support | Lack::Stiffness { .. } | Lack::Place | Lack::Time { .. } => "is displaced",
    }
}

/// Returns a model on a floor that is tilted by an angle (rad). The model is expressed in the frame
/// of the floor, where gravity has a component along the floor.
fn tilted(model: &Model<Planar>, angle: f64) -> Model<Planar> {
    let (sin, cos) = math::sin_cos(angle);
    let down = -model.gravity().z;
    let mut tilted = model.clone();
    tilted.set_gravity(Vec2::new(down * sin, -down * cos));
    tilted
}
