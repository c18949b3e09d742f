//! A three-dimensional run of a scenario, and its result.

use std::ops::ControlFlow;

use barrelstack::assemble::{AssembleError, PartKind};
use barrelstack::device::Words;
use barrelstack::outcome::{Outcome, collapse};
use barrelstack::overlap::ALLOWED;
use barrelstack::run::{Progress, UNBALANCED, Work, check_kept, check_length, end_time};
use barrelstack::scenario::Scenario;
use barrelstack::watch::{ElementFate, Ending, Loss};
use barrelstack::{Restless, RunFailure};
use barrelstack_dynamics::{
    BodyId, Contact, Element, EnergySummary, Scratch, Settled, Spatial, State, evaluate, settle,
};

use crate::fate::{Fate, Fates, Heading};
use crate::ground::Ground;
use crate::seats::Seats;
use crate::simulation::Simulation;
use crate::stack::Stack;

/// A stack at rest, ready to be shaken.
#[derive(Clone, Debug)]
pub struct Standing {
    /// The stack.
    pub stack: Stack,
    /// The state at rest.
    pub state: State<Spatial>,
    /// Working memory of the model; it contains the forces in the state at rest.
    pub scratch: Scratch<Spatial>,
    /// Result of settling; `None` if the scenario starts without settling.
    pub settled: Option<Settled>,
}

/// Poses and twists of all bodies, and the contact forces, in the frames of a run.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    /// Times (s).
    pub times: Vec<f64>,
    /// For every frame and body, the position of the center of mass (m) and the quaternion `w`, `x`, `y`, `z` of the
    /// rotation.
    pub poses: Vec<Vec<[f64; 7]>>,
    /// For every frame and body, the velocity of the center of mass (m/s) and the spin (rad/s).
    pub twists: Vec<Vec<[f64; 6]>>,
    /// For every frame, all pairs of surfaces that touch. For each pair: its index in the model, the center of pressure
    /// (m), and the contact force (N). Of the two opposite forces, the one that pushes its body upward is given.
    pub forces: Vec<Vec<(usize, [f64; 6])>>,
}

/// Result of a run.
#[derive(Clone, Debug)]
pub struct Run {
    /// The scenario of the run.
    pub scenario: Scenario,
    /// The stack.
    pub stack: Stack,
    /// The ground motion.
    pub ground: Ground,
    /// The outcome.
    pub outcome: Outcome,
    /// Direction in which the first body left its seat; `None` if no body left its seat.
    pub heading: Option<Heading>,
    /// Outcomes of all bodies, in the order of the parts.
    pub fates: Vec<Fate>,
    /// Time (s) at which the first barrel counted as fallen; `None` if no barrel has fallen.
    pub first_fall: Option<f64>,
    /// Outcomes of all elements of the devices, in the order of the elements in the model.
    pub elements: Vec<ElementFate>,
    /// Forces at the seats.
    pub seats: Seats,
    /// Recorded frames.
    pub frames: Frames,
    /// The final state.
    pub last: State<Spatial>,
    /// Energy balance at the end; `None` if the numbers are no longer finite.
    pub energy: Option<EnergySummary>,
    /// Result of settling; `None` if the scenario starts without settling.
    pub settled: Option<Settled>,
    /// Integration settings.
    pub simulation: barrelstack_dynamics::Simulation,
    /// Numbers of steps, force evaluations and tested contact elements.
    pub work: Work,
    /// Time (s) at which the run ended.
    pub end_time: f64,
    /// Reason for the end of the run.
    pub ending: Ending,
    /// Warnings for the reader of the result, one sentence each.
    pub warnings: Vec<String>,
}

/// Builds the stack of a scenario and settles it.
///
/// ```
/// use barrelstack::Scenario;
/// use barrelstack_space::run::stand;
///
/// let changes = ["stack.view=spatial", "stack.levels=2"].map(str::to_owned);
/// let standing = stand(&Scenario::builtin("demo-napa", &changes)?)?;
/// assert!(standing.settled.is_some_and(|settled| settled.unbalanced < 1e-9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the stack cannot be built, or does not stand.
pub fn stand(scenario: &Scenario) -> Result<Standing, RunFailure> {
    at_rest(scenario, Stack::of(scenario)?)
}

/// Settles a stack.
pub(crate) fn at_rest(scenario: &Scenario, mut stack: Stack) -> Result<Standing, RunFailure> {
    let mut state = State::initial(&stack.model);
    let mut scratch = Scratch::new(&stack.model);
    evaluate(&stack.model, &state, &mut scratch);
    check_overlap(&stack, &scratch)?;
    let rest = |stack: &Stack, state: &mut _, scratch: &mut _| {
        settle(&stack.model, state, scratch, UNBALANCED).map_err(|error| Restless { error })
    };
    let mut settled = None;
    if scenario.run.settle {
        settled = Some(rest(&stack, &mut state, &mut scratch)?);
    }
    let strained = stack.fasten(&mut state).map_err(AssembleError::from)?;
    // Elements under load compress the stack, so the stack is settled again.
    if let Some(before) = settled.filter(|_| strained) {
        let found = rest(&stack, &mut state, &mut scratch)?;
        settled = Some(Settled { steps: before.steps + found.steps, ..found });
    }
    if stack.is_free() {
        // Settling solves for positions only; initial velocities of the scenario apply from here.
        state.twists = stack.model.bodies().iter().map(|body| body.twist).collect();
    }
    Ok(Standing { stack, state, scratch, settled })
}

/// Rejects a stack whose bodies overlap in their initial positions.
fn check_overlap(stack: &Stack, scratch: &Scratch<Spatial>) -> Result<(), AssembleError> {
    match deepest_overlap(stack, scratch) {
        Some((bodies, depth)) if depth > ALLOWED => {
            let [first, second] = bodies.map(|body| stack.parts[body].name.clone());
            Err(AssembleError::Overlap { first, second, depth })
        }
        Some(_) | None => Ok(()),
    }
}

/// Returns the two bodies that overlap most, and the depth (m) of their overlap, from the contacts of the last
/// evaluation in `scratch`; `None` if no bodies touch.
pub fn deepest_overlap(stack: &Stack, scratch: &Scratch<Spatial>) -> Option<([BodyId; 2], f64)> {
    let depth = |contact: &&Contact<Spatial>| contact.penetration;
    let contact = scratch.contacts.iter().max_by(|a, b| depth(a).total_cmp(&depth(b)))?;
    let pair = stack.model.pair(contact.pair);
    Some(([pair.contactor, pair.target], contact.penetration))
}

/// Runs a scenario in three dimensions, under the ground motion of the scenario.
///
/// ```
/// use barrelstack::Scenario;
///
/// let changes = ["stack.view=spatial", "stack.levels=2", "run.duration=2 s"].map(str::to_owned);
/// let run = barrelstack_space::run::run(&Scenario::builtin("demo-napa", &changes)?)?;
/// assert_eq!(run.outcome.kind(), "stable");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the motion cannot be read, or if the stack cannot be built in three dimensions or does not stand.
pub fn run(scenario: &Scenario) -> Result<Run, RunFailure> {
    let ground = Ground::of(scenario)?;
    run_on(scenario, ground, &mut |_| ControlFlow::Continue(()))
}

/// Returns the latest time (s) at which a run can end, or an error if the run would not finish within a day or would
/// not fit into memory.
pub(crate) fn affordable(
    scenario: &Scenario,
    stack: &Stack,
    ground: &Ground,
) -> Result<f64, RunFailure> {
    let end_time = end_time(scenario, ground.motion_end(), 1.0)?;
    check_length(end_time, stack.step)?;
    // A frame has 13 numbers for every body: position, quaternion, velocity and spin. It also has about four contact
    // forces for every body, each with seven numbers.
    let frames = end_time * scenario.record.frame_rate + 1.0;
    check_kept((frames, stack.parts.len(), 13 + 28), (0.0, 0))?;
    Ok(end_time)
}

/// Runs a scenario in three dimensions, under a given ground motion.
///
/// The observer receives the progress at least every 0.05 s of simulated time, and may stop the run; the results until
/// then are returned.
///
/// # Errors
/// If the stack cannot be built in three dimensions, or does not stand.
pub fn run_on(
    scenario: &Scenario,
    ground: Ground,
    observer: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Run, RunFailure> {
    Ok(Simulation::new(scenario, ground)?.run_watched(observer))
}

impl Run {
    /// Returns all elements of the devices. Each comes with the description of its device and with its outcome.
    pub(crate) fn devices(
        &self,
    ) -> impl Iterator<Item = ((&Element<Spatial>, &'static Words), &ElementFate)> + Clone {
        let elements = self.stack.model.elements().iter();
        elements.zip(self.stack.devices.iter().copied()).zip(&self.elements)
    }

    /// Returns the displacement `[x, y, z]` (m) of a body from its position at rest, relative to the ground, in every
    /// frame.
    pub(crate) fn path(&self, body: BodyId) -> Vec<[f64; 3]> {
        let rest = self.fates[body].rest;
        let moved = |poses: &Vec<[f64; 7]>| {
            let (own, ground) = (poses[body], poses[Stack::GROUND]);
            [own[0] - ground[0] - rest.x, own[1] - ground[1] - rest.y, own[2] - ground[2] - rest.z]
        };
        self.frames.poses.iter().map(moved).collect()
    }

    /// Returns the barrels that fell, in the order of the parts.
    pub fn fallen(&self) -> impl Iterator<Item = BodyId> + '_ {
        let fell = |body: &BodyId| self.fates[*body].fell_at.is_some();
        self.stack.of_kind(PartKind::Barrel).filter(fell)
    }

    /// Returns, for each fallen barrel, the direction from its position at rest to its final position.
    pub fn debris(&self) -> impl Iterator<Item = Heading> + '_ {
        self.fallen().map(|body| Heading::of(self.fates[body].moved))
    }
}

/// Slip along the barrels, as a fraction of [`Stack::reach`], above which a rack that tilts in this direction counts as
/// having slid off. The value is a convention.
const SLID_BEFORE_IT_TILTED: f64 = 0.5;

/// Returns the outcome of a run. As in the plane models, the outcome depends on the first body that left its seat; only
/// the criterion for sliding differs.
///
/// A rack has slid off along the barrels if a beam has passed the ends of the barrels, or if the rack tilts in this
/// direction after a slip of more than half of the reach. The reason for the second criterion is that a round beam
/// drops over the chime before the middle of the beam has passed the chime.
pub fn judge(stack: &Stack, fates: &Fates) -> Outcome {
    let Some((time, first)) = fates.collapse() else {
        return if stack.is_free() { Outcome::NotJudged } else { Outcome::Stable };
    };
    let part = &stack.parts[first];
    let fate = &fates.all()[first];
    let slid = match fate.left_seat {
        Some((_, Loss::Slid, heading)) => !heading.is_across(),
        Some((_, Loss::Tilted | Loss::Dropped, heading)) => {
            !heading.is_across() && fate.peak_slip[1] > SLID_BEFORE_IT_TILTED * stack.reach[1]
        }
        Some((_, Loss::Displaced, _)) | None => false,
    };
    collapse(time, (&part.name, part.kind, part.level), slid, stack.levels)
}
