//! One run: scenario in, everything that was seen out.

use std::ops::ControlFlow;

use barrelstack_dynamics::contact::Basis;
use barrelstack_dynamics::{
    EnergySummary, Finish, Method, Motion, Planar, RunError, Scratch, SettleError, Settled,
    Simulation, State, settle, simulate,
};

use crate::assemble::{AssembleError, Assembly, assemble};
use crate::ground::{Ground, GroundError, ground};
use crate::outcome::{Outcome, judge};
use crate::scenario::{self, Scenario, Scene};
use crate::step::default_step;
use crate::watch::{Fates, Recording, Stresses, Thresholds, Watch};

/// Everything that was seen of a run.
#[derive(Clone, Debug)]
pub struct Run {
    /// What was asked for.
    pub scenario: Scenario,
    /// What stood there.
    pub assembly: Assembly,
    /// What shook it.
    pub ground: Ground,
    /// What happened.
    pub outcome: Outcome,
    /// What became of every body.
    pub fates: Fates,
    /// Stress along every boundary.
    pub stresses: Stresses,
    /// Frames and histories.
    pub recording: Recording,
    /// The energy books at the end.
    pub energy: EnergySummary,
    /// How equilibrium was found; none where the scenario starts without.
    pub settled: Option<Settled>,
    /// How it was integrated.
    pub simulation: Simulation,
    /// What was done.
    pub work: Work,
    /// Time (s) that the run reached.
    pub end_time: f64,
    /// Whether the caller stopped it early.
    pub interrupted: bool,
    /// What the reader of the result should know, one sentence each.
    pub warnings: Vec<String>,
}

/// How much was computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Accepted steps.
    pub steps: u64,
    /// Evaluations of all forces.
    pub evaluations: u64,
    /// Contact elements tested.
    pub contact_evaluations: u64,
}

/// Why there is no run.
#[derive(Debug, thiserror::Error)]
pub enum RunFailure {
    /// The motion is missing.
    #[error(transparent)]
    Ground(#[from] GroundError),
    /// The stack cannot be built.
    #[error(transparent)]
    Assemble(#[from] AssembleError),
    /// The stack does not stand by itself.
    #[error(transparent)]
    Settle(#[from] SettleError),
    /// The run would not end, or not begin.
    #[error("{0}")]
    Duration(String),
}

/// Largest share of gravity that may be left unbalanced at rest.
pub(crate) const SETTLE_TOLERANCE: f64 = 1e-10;

/// Deepest overlap (m) of two bodies at the start that sinking under weight can explain.
const OVERLAP_ALLOWED: f64 = 2e-3;

/// Runs a scenario.
///
/// `progress` is told the simulated time (s) every 0.05 s of it and may stop the run; what was seen
/// until then is returned.
/// A breakdown of the numbers is not an error but an outcome: [`Outcome::Invalid`].
///
/// # Errors
/// When the motion cannot be read, the stack cannot be built, or it does not stand.
pub fn run(
    scenario: &Scenario,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Run, RunFailure> {
    let ground = ground(scenario)?;
    let assembly = assemble(scenario)?;
    let model = &assembly.model;
    let time_scale = scenario.run.similitude.sqrt();
    let end_time = end_time(scenario, &ground, time_scale)?;

    let mut state = State::initial(model);
    let mut scratch = Scratch::new(model);
    check_overlap(&assembly, &state, &mut scratch, scenario.run.similitude)?;
    let step = time_step(scenario, &assembly);
    let settled = if scenario.run.settle {
        Some(settle(model, &mut state, &mut scratch, step, SETTLE_TOLERANCE)?)
    } else {
        barrelstack_dynamics::evaluate(model, &state, &mut scratch);
        None
    };
    let free_bodies_start = model.bodies().iter().map(|b| b.twist);
    if matches!(scenario.scene, Scene::Free(_)) {
        // Equilibrium is that of the places; what the scenario sets in motion starts from there.
        state.twists = free_bodies_start.collect();
    }

    let simulation = Simulation { method: method(scenario), time_step: step, end_time };
    let thresholds = thresholds(scenario);
    let rates =
        (scenario.record.frame_rate / time_scale, scenario.record.history_rate / time_scale);
    let (evaluations, elements) = (scratch.evaluations, scratch.contact_evaluations);
    let mut watch = Watch::new(
        &assembly,
        &ground,
        &state,
        &scratch,
        thresholds,
        rates,
        scenario.run.stop_after_collapse.map(|after| after * time_scale),
        progress,
    );
    let result = simulate(model, &ground, &mut state, &mut scratch, &simulation, &mut watch);
    let Watch { recording, stresses, fates, interrupted, .. } = watch;

    let mut warnings = ground.warnings.clone();
    let (outcome, energy, steps) = match result {
        Ok(totals) => {
            let energy = totals.energy.summary(0);
            warnings.extend(energy_warning(&energy));
            if interrupted && totals.finish == Finish::Stopped {
                warnings.push(format!(
                    "the run was stopped at {:.3} s of {end_time:.3} s; what follows holds until then",
                    state.time
                ));
            }
            (judge(&assembly, &fates), energy, totals.steps)
        }
        Err(error @ RunError::NotFinite { .. }) => {
            (Outcome::Invalid { reason: error.to_string() }, EnergySummary::default(), 0)
        }
    };
    warnings.extend(creep_warning(&assembly));
    let work = Work {
        steps,
        evaluations: scratch.evaluations - evaluations,
        contact_evaluations: scratch.contact_evaluations - elements,
    };
    let end_time = state.time;
    Ok(Run {
        scenario: scenario.clone(),
        outcome,
        fates,
        stresses,
        recording,
        energy,
        settled,
        simulation,
        work,
        end_time,
        interrupted,
        warnings,
        ground,
        assembly,
    })
}

/// The step (s) that a scenario asks for, or the one its stiffest contact suggests.
///
/// A scaled stack takes the step of the full one, scaled, so that the two runs are the same run.
pub(crate) fn time_step(scenario: &Scenario, assembly: &Assembly) -> f64 {
    let time_scale = scenario.run.similitude.sqrt();
    match scenario.run.step {
        Some(step) => step * time_scale,
        None => default_step(assembly, time_scale),
    }
}

fn method(scenario: &Scenario) -> Method {
    match scenario.run.method {
        scenario::Method::SemiImplicitEuler => Method::SemiImplicitEuler,
        scenario::Method::VelocityVerlet => Method::VelocityVerlet,
        scenario::Method::RungeKutta4 => Method::RungeKutta4,
        scenario::Method::BogackiShampine { tolerance } => Method::BogackiShampine { tolerance },
    }
}

fn thresholds(scenario: &Scenario) -> Thresholds {
    match &scenario.scene {
        Scene::Stack { outcome, .. } => Thresholds::of(outcome, scenario.run.similitude),
        // A free scene is not judged: nothing in it has a seat.
        Scene::Free(_) => Thresholds {
            seat_loss_ratio: f64::INFINITY,
            fall_drop: f64::INFINITY,
            rack_slide_ratio: f64::INFINITY,
            rocking_angle: f64::INFINITY,
            overturning_angle: f64::INFINITY,
        },
    }
}

fn end_time(scenario: &Scenario, ground: &Ground, time_scale: f64) -> Result<f64, RunFailure> {
    if let Some(duration) = scenario.run.duration {
        return Ok(duration * time_scale);
    }
    match &ground.motion {
        Some(motion) => Ok(motion.duration + 5.0 * time_scale),
        None => Err(RunFailure::Duration(
            "the scenario has no motion, so the run has no natural end: set run.duration, such as \
             \"10 s\""
                .into(),
        )),
    }
}

/// Refuses bodies that stand in each other before anything has moved.
pub(crate) fn check_overlap(
    assembly: &Assembly,
    state: &State<Planar>,
    scratch: &mut Scratch<Planar>,
    length_scale: f64,
) -> Result<(), AssembleError> {
    let model = &assembly.model;
    barrelstack_dynamics::evaluate(model, state, scratch);
    let deepest = scratch.contacts.iter().max_by(|a, b| a.penetration.total_cmp(&b.penetration));
    match deepest {
        Some(contact) if contact.penetration > OVERLAP_ALLOWED * length_scale => {
            let pair = &model.pairs()[contact.pair];
            Err(AssembleError::Overlap {
                first: model.bodies()[pair.contactor].name.clone(),
                second: model.bodies()[pair.target].name.clone(),
                depth: contact.penetration,
            })
        }
        _ => Ok(()),
    }
}

fn energy_warning(energy: &EnergySummary) -> Option<String> {
    let ratio = energy.residual_ratio();
    (ratio > 1e-3).then(|| {
        format!(
            "the energy books miss {:.2} % of the energy that went through: try half the step \
             (run.step)",
            100.0 * ratio
        )
    })
}

/// Laws that cannot hold a body at rest say how fast it creeps.
fn creep_warning(assembly: &Assembly) -> Vec<String> {
    assembly
        .model
        .interfaces()
        .iter()
        .filter(|interface| interface.friction.creep_speed(0.5) > 0.0)
        .map(|interface| {
            format!(
                "{}: the regularized friction law creeps; under half of the friction limit by \
                 {:.2e} m/s",
                interface.name,
                interface.friction.creep_speed(0.5)
            )
        })
        .collect()
}

impl Run {
    /// How many bodies move freely.
    pub fn free_bodies(&self) -> usize {
        self.assembly.model.bodies().iter().filter(|b| b.motion == Motion::Free).count()
    }

    /// What the constants of the interfaces are stated for, such as "node"; "mixed" when they differ.
    pub fn stiffness_basis(&self) -> &'static str {
        let mut bases = self.assembly.model.interfaces().iter().map(|interface| interface.basis);
        let Some(first) = bases.next() else { return Basis::Node.name() };
        if bases.all(|basis| basis == first) { first.name() } else { "mixed" }
    }
}
