//! Building and settling of the stacks of scenarios, one stack alone or many in vector lanes.

use barrelstack_dynamics::lanes::{Task, Topology, Width};
use barrelstack_dynamics::real::Real;
use barrelstack_dynamics::settle::{self, settle_all};
use barrelstack_dynamics::{Element, Planar, Scratch, SettleError, Settled, State, evaluate};

use crate::assemble::{AssembleError, Assembly, assemble};
use crate::overlap::check_overlap;
use crate::rest::Restless;
use crate::run::{RunFailure, check_length, time_step};
use crate::scenario::{Scenario, Scene};

/// Residual acceleration, as a fraction of gravity, below which a stack counts as being at rest.
pub const UNBALANCED: f64 = 1e-10;

/// Minimum number of stacks or cases of the same topology that are run in vector lanes.
///
/// Running in lanes costs as much as about three single runs, even if few lanes are used.
pub(crate) const FEWEST: usize = 3;

/// A stack at rest, ready to be shaken.
#[derive(Clone, Debug)]
pub struct Standing {
    /// The stack.
    pub assembly: Assembly,
    /// The state at rest.
    pub state: State<Planar>,
    /// The forces in the state at rest.
    pub scratch: Scratch<Planar>,
    /// Result of settling; `None` if the scenario starts without settling.
    pub settled: Option<Settled>,
    /// The time step (s).
    pub step: f64,
}

impl Standing {
    /// Returns the largest distance (m) by which a body sank while the stack came to rest.
    pub fn deepest_sinking(&self) -> f64 {
        let sunk = self.assembly.model.bodies().iter().zip(&self.state.poses);
        sunk.map(|(body, now)| body.pose.position.z - now.position.z).fold(0.0, f64::max)
    }
}

/// The stack of a scenario, built or settled; or the error that prevented building or settling it.
#[derive(Debug)]
pub(crate) struct Stack<'a> {
    pub(crate) scenario: &'a Scenario,
    pub(crate) standing: Result<Standing, RunFailure>,
}

impl<'a> Stack<'a> {
    /// Builds the stack of a scenario without settling it, for a run that ends at `end_time` (s) at the latest.
    pub(crate) fn built(scenario: &'a Scenario, end_time: f64) -> Self {
        let build = || {
            let assembly = assemble(scenario)?;
            let state = State::initial(&assembly.model);
            let scratch = Scratch::new(&assembly.model);
            check_overlap(&assembly, &state, scenario.run.similitude)?;
            let step = time_step(scenario, &assembly)?;
            check_length(end_time, step)?;
            Ok(Standing { assembly, state, scratch, settled: None, step })
        };
        Self { scenario, standing: build() }
    }

    /// Returns `true` if this is also the stack of another scenario, which may differ from the scenario of this
    /// stack in motion, end time and recording.
    pub(crate) fn is_of(&self, other: &Scenario) -> bool {
        let own = self.scenario;
        let stands = |scenario: &Scenario| {
            let run = &scenario.run;
            (run.settle, run.gravity, run.similitude, run.accuracy, run.step, run.method)
        };
        let scenes_agree = || match (&own.scene, &other.scene) {
            (Scene::Stack { stack: a, .. }, Scene::Stack { stack: b, .. }) => a == b,
            (a, b) => a == b,
        };
        std::ptr::eq(own, other) || (stands(own) == stands(other) && scenes_agree())
    }
}

/// Builds the stack of a scenario and settles it, for a run that ends at `end_time` (s) at the latest.
///
/// # Errors
/// If the stack cannot be built or does not come to rest under its own weight, or if the time step or the run would be
/// too long.
pub fn stand(scenario: &Scenario, end_time: f64) -> Result<Standing, RunFailure> {
    let mut one = [Stack::built(scenario, end_time)];
    // Settling is never stopped here.
    let _ = stand_all(Width::Scalar, &mut one, &|| false);
    let [Stack { standing, .. }] = one;
    standing
}

/// Settles built stacks and installs their devices. Returns `None` if `stop` returned `true`.
///
/// Stacks of the same topology settle side by side, and the result of each is bit-identical to settling it alone.
pub(crate) fn stand_all(
    width: Width,
    stacks: &mut [Stack<'_>],
    stop: &dyn Fn() -> bool,
) -> Option<()> {
    rest(width, stacks, stop, |scenario, _| scenario.run.settle)?;
    for Stack { scenario, standing } in &mut *stacks {
        let Ok(Standing { assembly, state, scratch, .. }) = standing else { continue };
        if !scenario.run.settle {
            evaluate(&assembly.model, state, scratch);
        }
        if let Err(error) = assembly.fasten(state) {
            *standing = Err(AssembleError::from(error).into());
        }
    }
    // Prestressed elements compress the stack, so it has to settle again.
    rest(width, stacks, stop, |scenario, standing| {
        let strained = |element: &Element<Planar>| element.load(&standing.state).force != 0.0;
        scenario.run.settle && standing.assembly.model.elements().iter().any(strained)
    })?;
    for Stack { scenario, standing } in stacks {
        if let (Scene::Free(_), Ok(standing)) = (&scenario.scene, standing) {
            // Settling solves for positions only; initial velocities of the scenario apply from here.
            let bodies = standing.assembly.model.bodies();
            standing.state.twists = bodies.iter().map(|body| body.twist).collect();
        }
    }
    Some(())
}

/// Settles the stacks that `wanted` selects. If a stack does not settle, the error replaces it. Returns `None` if
/// `stop` returned `true`.
fn rest(
    width: Width,
    stacks: &mut [Stack<'_>],
    stop: &dyn Fn() -> bool,
    wanted: impl Fn(&Scenario, &Standing) -> bool,
) -> Option<()> {
    let mut groups: Vec<(Option<Topology>, Vec<&mut Stack<'_>>)> = Vec::new();
    for stack in stacks {
        let Ok(standing) = &stack.standing else { continue };
        if wanted(stack.scenario, standing) {
            // In scalar runs, the topology does not matter.
            let together = width != Width::Scalar;
            let topology = together.then(|| Topology::of(&standing.assembly.model));
            match groups.iter_mut().find(|(known, _)| *known == topology) {
                Some((_, group)) => group.push(stack),
                None => groups.push((topology, vec![stack])),
            }
        }
    }
    for (_, mut group) in groups {
        let width = if group.len() < FEWEST || !width.is_here() { Width::Scalar } else { width };
        let standing = group.iter_mut().filter_map(|stack| stack.standing.as_mut().ok());
        let stacks = standing.map(|Standing { assembly, state, scratch, .. }| settle::Stack {
            model: &assembly.model,
            state,
            scratch,
        });
        let results = width.run(Settling { stacks: stacks.collect(), stop })??;
        for (Stack { standing, .. }, result) in group.into_iter().zip(results) {
            match (standing.as_mut(), result) {
                (Ok(standing), Ok(found)) => {
                    let before = standing.settled.map_or(0, |settled| settled.steps);
                    standing.settled = Some(Settled { steps: before + found.steps, ..found });
                }
                (_, Err(error)) => *standing = Err(Restless { error }.into()),
                (Err(_), Ok(_)) => {}
            }
        }
    }
    Some(())
}

/// Task that settles stacks of the same topology in vector lanes.
struct Settling<'a> {
    stacks: Vec<settle::Stack<'a>>,
    stop: &'a dyn Fn() -> bool,
}

impl Task for Settling<'_> {
    type Output = Option<Vec<Result<Settled, SettleError>>>;

    fn run<R: Real>(mut self) -> Self::Output {
        settle_all::<R>(&mut self.stacks, UNBALANCED, self.stop)
    }
}
