//! A run of a scenario in space, and its result.

use std::ops::ControlFlow;

use barrelstack::assemble::{AssembleError, PartKind};
use barrelstack::device::Words;
use barrelstack::outcome::{Outcome, collapse};
use barrelstack::overlap::ALLOWED;
use barrelstack::run::{
    Ended, Progress, UNBALANCED, Verdict, Work, check_kept, check_length, end_time, method,
    thresholds,
};
use barrelstack::scenario::Scenario;
use barrelstack::step::restitution_warning;
use barrelstack::watch::{ElementFate, ElementFates, Ending, Loss, PROGRESS, after_collapse};
use barrelstack::{Restless, RunFailure};
use barrelstack_dynamics::{
    BodyId, Contact, Element, EnergyLedger, EnergySummary, Model, Observer, Scratch, Settled,
    Simulation, Spatial, State, Twist, evaluate, settle, simulate,
};

use crate::fate::{Fate, Fates, Heading};
use crate::ground::Ground;
use crate::rest::Rest;
use crate::seats::Seats;
use crate::stack::Stack;

/// A stack at rest, ready to be shaken.
#[derive(Clone, Debug)]
pub struct Standing {
    /// The stack.
    pub stack: Stack,
    /// The state at rest.
    pub state: State<Spatial>,
    /// Working memory with the forces at rest.
    pub scratch: Scratch<Spatial>,
    /// Result of settling; `None` if the scenario starts without settling.
    pub settled: Option<Settled>,
}

/// Poses and twists of all bodies in the frames of a run.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    /// Times (s).
    pub times: Vec<f64>,
    /// For every frame and body, the position of the center of mass (m) and the quaternion `w`, `x`, `y`, `z` of the
    /// rotation.
    pub poses: Vec<Vec<[f64; 7]>>,
    /// For every frame and body, the velocity of the center of mass (m/s) and the spin (rad/s).
    pub twists: Vec<Vec<[f64; 6]>>,
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
    /// The direction in which the first body left its seat.
    pub heading: Option<Heading>,
    /// Fates of all bodies, in the order of the parts.
    pub fates: Vec<Fate>,
    /// Time (s) at which the first barrel counted as fallen.
    pub first_fall: Option<f64>,
    /// Fates of all elements of the devices, in the order of the elements in the model.
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
    pub simulation: Simulation,
    /// Numbers of steps and evaluations.
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

fn at_rest(scenario: &Scenario, mut stack: Stack) -> Result<Standing, RunFailure> {
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
    // Elements under load press the stack together, so it settles again.
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
    let depth = |contact: &&Contact<Spatial>| contact.penetration;
    let deepest = scratch.contacts.iter().max_by(|a, b| depth(a).total_cmp(&depth(b)));
    let Some(contact) = deepest.filter(|contact| contact.penetration > ALLOWED) else {
        return Ok(());
    };
    let pair = stack.model.pair(contact.pair);
    let [first, second] = [pair.contactor, pair.target].map(|body| stack.parts[body].name.clone());
    Err(AssembleError::Overlap { first, second, depth: contact.penetration })
}

/// Runs a scenario in space under the ground motion of the scenario.
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
/// If the motion cannot be read, the stack cannot be built in space, or it does not stand.
pub fn run(scenario: &Scenario) -> Result<Run, RunFailure> {
    let ground = Ground::of(scenario)?;
    run_on(scenario, ground, &mut |_| ControlFlow::Continue(()))
}

/// Returns the latest end (s) of a run; rejects a run that would not finish within a day or would not fit into memory.
pub(crate) fn affordable(
    scenario: &Scenario,
    stack: &Stack,
    ground: &Ground,
) -> Result<f64, RunFailure> {
    let end_time = end_time(scenario, ground.motion_end(), 1.0)?;
    check_length(end_time, stack.step)?;
    // A frame has 13 numbers of every body: position, quaternion, velocity and spin.
    let frames = end_time * scenario.record.frame_rate + 1.0;
    check_kept((frames, stack.parts.len(), 13), (0.0, 0))?;
    Ok(end_time)
}

/// Runs a scenario in space under a given ground motion.
///
/// The observer receives the progress at least every 0.05 s of simulated time, and may stop the run; the results until
/// then are returned.
///
/// # Errors
/// If the stack cannot be built in space, or does not stand.
pub fn run_on(
    scenario: &Scenario,
    ground: Ground,
    observer: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Run, RunFailure> {
    let stack = Stack::of(scenario)?;
    let end_time = affordable(scenario, &stack, &ground)?;
    let Standing { stack, mut state, mut scratch, settled } = at_rest(scenario, stack)?;
    let simulation = Simulation { method: method(scenario), time_step: stack.step, end_time };
    let (evaluations, tested) = (scratch.evaluations, scratch.contact_evaluations);
    scratch.keeps_contacts = false;
    let mut watch = Watch {
        fates: Fates::new(&stack, &state, thresholds(scenario)),
        elements: ElementFates::default(),
        seats: Seats::new(&stack, state.time, &scratch),
        rest: Rest::new(scenario, &stack, &ground),
        frames: Frames::default(),
        every: 1.0 / scenario.record.frame_rate,
        after_collapse: after_collapse(scenario),
        next_look: 0.0,
        steps: 0,
        observer,
        end_time,
        ending: None,
    };
    let result = simulate(&stack.model, &ground, &mut state, &mut scratch, &simulation, &mut watch);
    let Watch { fates, elements, seats, frames, ending, .. } = watch;
    let ending = ending.unwrap_or(Ending::of_time(scenario));
    let ended = result.map(|totals| Ended::of(&totals));
    let judge = || judge(&stack, &fates);
    let Verdict { outcome, energy, steps, warnings: warned, ending } =
        Verdict::of(ended, judge, state.time, ground.end(), ending);
    let warnings = ground
        .warnings
        .iter()
        .cloned()
        .chain(warned)
        .chain(restitution_warning(scenario))
        .collect();
    let heading = fates.collapse().and_then(|(_, body)| fates.all()[body].left_seat);
    let first_fall = fates.first_fall();
    let all = fates.at_end(&state);
    Ok(Run {
        scenario: scenario.clone(),
        outcome,
        heading: heading.map(|(.., heading)| heading),
        fates: all,
        first_fall,
        elements: elements.0,
        seats,
        frames,
        energy,
        settled,
        simulation,
        work: Work {
            steps,
            evaluations: scratch.evaluations - evaluations,
            contact_evaluations: scratch.contact_evaluations - tested,
        },
        end_time: state.time,
        ending,
        warnings,
        ground,
        stack,
        last: state,
    })
}

impl Run {
    /// Returns every element of the devices, with its fate and the description of its device.
    pub(crate) fn devices(
        &self,
    ) -> impl Iterator<Item = ((&Element<Spatial>, &'static Words), &ElementFate)> + Clone {
        let elements = self.stack.model.elements().iter();
        elements.zip(self.stack.devices.iter().copied()).zip(&self.elements)
    }

    /// Returns the displacement x, y, z (m) of a body from its position at rest, relative to the ground, in every frame.
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

/// Slip of a rack along the barrels before it tilts, as a fraction of its reach, above which the rack counts as having
/// slid off. The value is a convention.
const SLID_BEFORE_IT_TILTED: f64 = 0.5;

/// Returns the outcome of a run. As in the plane, the outcome depends on the first body that left its seat; only the
/// criterion for sliding differs.
///
/// A rack has slid off along the barrels if a beam has passed the ends of the barrels, or if the rack tilts in this
/// direction after a slip of more than half of its reach: a round beam drops over the chime before the middle of the
/// beam has passed the chime.
fn judge(stack: &Stack, fates: &Fates<'_>) -> Outcome {
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

/// Maximum number of steps between two calls of the observer.
const PATIENCE: u32 = 16;

/// Combined observer of a run.
struct Watch<'a> {
    fates: Fates<'a>,
    elements: ElementFates,
    seats: Seats,
    rest: Rest<'a>,
    frames: Frames,
    /// Time (s) between two frames.
    every: f64,
    /// Duration (s) of the run after a collapse.
    after_collapse: f64,
    next_look: f64,
    /// Number of steps since the last callback.
    steps: u32,
    observer: &'a mut dyn FnMut(Progress) -> ControlFlow<()>,
    end_time: f64,
    ending: Option<Ending>,
}

impl Observer<Spatial> for Watch<'_> {
    fn observe(
        &mut self,
        _: &Model<Spatial>,
        state: &State<Spatial>,
        scratch: &Scratch<Spatial>,
        _: &EnergyLedger<Spatial>,
    ) -> ControlFlow<()> {
        // The state in which the first loss of seat is found still counts as standing.
        let standing = self.fates.collapse().is_none();
        self.fates.observe(state, scratch);
        self.elements.observe(state, standing, scratch);
        self.seats.observe(state.time, standing, scratch);
        let time = state.time;
        if time >= self.frames.times.len() as f64 * self.every {
            self.frames.times.push(time);
            let pose = |pose: &barrelstack_dynamics::Pose<Spatial>| {
                let (p, q) = (pose.position, pose.orientation);
                [p.x, p.y, p.z, q.w, q.v.x, q.v.y, q.v.z]
            };
            self.frames.poses.push(state.poses.iter().map(pose).collect());
            let twist = |twist: &Twist<Spatial>| {
                let (v, w) = (twist.linear, twist.angular);
                [v.x, v.y, v.z, w.x, w.y, w.z]
            };
            self.frames.twists.push(state.twists.iter().map(twist).collect());
        }
        // Steps of many bodies take long, so their number is limited as well.
        self.steps += 1;
        if time >= self.next_look || self.steps == PATIENCE {
            (self.next_look, self.steps) = (time + PROGRESS, 0);
            if (self.observer)(Progress { time, end_time: self.end_time }).is_break() {
                self.ending = Some(Ending::Interrupted);
            }
        }
        let collapse = self.fates.collapse();
        if self.ending.is_none() {
            self.ending = if self.rest.observe(state, collapse.is_some()) {
                Some(Ending::Rest)
            } else if collapse.is_some_and(|(at, _)| at + self.after_collapse <= time) {
                Some(Ending::AfterCollapse)
            } else {
                None
            };
        }
        if self.ending.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
