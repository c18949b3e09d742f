//! Rest criterion: the ground is still, or calm after a collapse, and no body is fast enough to change the outcome.

use barrelstack_dynamics::real::{Mask, Real};
use barrelstack_dynamics::{
    BodyId, FrictionLaw, Interface, Linear, Motion, Planar, Space, State, lanewise,
};

use crate::assemble::{Assembly, PartKind};
use crate::ground::Ground;
use crate::scenario::{Scenario, Until};

/// Height (m), at full scale: a body counts as at rest if its kinetic energy could lift it by at most this height.
///
/// This height corresponds to a speed of 0.31 m/s, and is a tenth of the height that lifts a barrel out of the
/// shallowest cradle of the catalog. With less kinetic energy, stacks can sway on their round barrels for minutes,
/// since seats do not resist rolling.
pub const CLIMB: f64 = 0.005;

/// Duration (s), at full scale, for which every body must be at rest.
///
/// This duration is longer than half a period of the tallest stack, so that a turning point is not mistaken for rest.
pub const HOLD: f64 = 3.0;

/// Largest acceleration at which the ground may count as calm, as a fraction of gravity.
///
/// Such an acceleration is too small to make bodies slide or tip. Many records stay below it in their last third.
/// Unless only the verdict is requested, a standing stack is nevertheless simulated to the end of the motion, since its
/// displacements are results.
const CALM: f64 = 0.02;
/// Largest acceleration at which the ground may count as calm, as a fraction of gravity, divided by the smallest
/// friction coefficient.
const CALM_OF_FRICTION: f64 = 0.1;

/// Largest height of the center of a barrel that counts as lying on the floor, divided by the radius of the barrel.
pub const ON_FLOOR: f64 = 1.05;

/// Reason for the end of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// All bodies had come to rest on ground that was still. After a collapse, or if only the verdict is requested,
    /// calm ground is sufficient.
    Rest,
    /// The time for which the run continues after a collapse, which the scenario specifies, is over.
    AfterCollapse,
    /// The duration that the scenario specifies was reached.
    Duration,
    /// The maximum time after the end of the motion had elapsed while bodies still moved.
    Patience,
    /// The caller stopped the run.
    Interrupted,
    /// The computation broke down numerically.
    Broken,
    /// The stack fell under its own weight, so it was not shaken.
    NotShaken,
}

impl Ending {
    /// Returns the name of the reason in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::AfterCollapse => "after-collapse",
            Self::Duration => "duration",
            Self::Patience => "patience",
            Self::Interrupted => "interrupted",
            Self::Broken => "broken",
            Self::NotShaken => "not-shaken",
        }
    }

    /// Returns the reason for the end of a run that reached its end time.
    pub fn of_time(scenario: &Scenario) -> Self {
        match scenario.run.until {
            Until::Rest | Until::Verdict if scenario.run.duration.is_none() => Self::Patience,
            Until::Rest | Until::Verdict | Until::Duration => Self::Duration,
        }
    }
}

/// Detects when all bodies are at rest, in one run or in one run per lane.
///
/// A body rests when its kinetic energy could not lift it by half a centimeter. A barrel that rolls away on the floor
/// and approaches no other body also counts as at rest: it decelerates at about 0.2 m/s² and cannot reach any body.
#[derive(Clone, Debug)]
pub struct Rest<R: Real = f64> {
    /// Time (s) from which the ground is still; infinite if the run does not end when all bodies are at rest.
    still_from: R,
    /// Time (s) from which the ground is calm; infinite if the run does not end when all bodies are at rest.
    calm_from: R,
    /// Largest kinetic energy, divided by the mass, with which a body counts as at rest (m²/s²).
    slow: R,
    /// Duration (s) for which all bodies must be slow before they count as at rest.
    hold: R,
    bodies: Vec<Mover<R>>,
    /// Time (s) at which a body was last in motion.
    moved: R,
}

/// A free body whose motion is observed.
#[derive(Clone, Debug)]
struct Mover<R: Real> {
    body: BodyId,
    /// Moment of inertia divided by the mass (m²).
    inertia: R,
    /// Height (m) of the center above the ground up to which the body counts as a barrel on the floor.
    floor: R,
}

lanewise!(struct Mover<R> { body, inertia, floor });
lanewise!(struct Rest<R> { still_from, calm_from, slow, hold, bodies, moved });

impl Rest {
    /// Creates the rest criterion for a scenario and its ground motion. No body counts as at rest before it has been
    /// observed.
    pub(crate) fn new(scenario: &Scenario, assembly: &Assembly, ground: &Ground) -> Self {
        let scale = scenario.run.similitude;
        let mover = |(body, part): (BodyId, &crate::assemble::Part)| {
            let of = &assembly.model.bodies()[body];
            (of.motion == Motion::Free).then(|| Mover {
                body,
                inertia: of.inertia / of.mass,
                floor: match part.kind {
                    PartKind::Barrel => ON_FLOOR * part.size,
                    PartKind::Ground
                    | PartKind::Rack
                    | PartKind::Device
                    | PartKind::Wine
                    | PartKind::Body => f64::NEG_INFINITY,
                },
            })
        };
        let calm = || ground.calm_from(scenario.run.gravity * calm(assembly.model.interfaces()));
        let (still_from, calm_from) = quiet_from(scenario.run.until, ground.end(), calm);
        Self {
            still_from,
            calm_from,
            slow: scenario.run.gravity * CLIMB * scale,
            hold: HOLD * scale.sqrt(),
            bodies: assembly.parts.iter().enumerate().filter_map(mover).collect(),
            moved: 0.0,
        }
    }
}

/// Returns the earliest times (s) at which a standing stack and a collapsed stack may count as at rest.
///
/// `end` is the end of the motion (s), and `calm` returns the time (s) from which the ground is calm. Both returned
/// times are infinite for [`Until::Duration`].
pub fn quiet_from(until: Until, end: f64, calm: impl FnOnce() -> f64) -> (f64, f64) {
    match until {
        Until::Rest => (end, calm()),
        Until::Verdict => {
            let calm = calm();
            (calm, calm)
        }
        Until::Duration => (f64::INFINITY, f64::INFINITY),
    }
}

/// Returns the largest acceleration at which the ground counts as calm, as a fraction of gravity, for a stack with
/// given contact laws.
pub fn calm<S: Space<Real = f64>>(laws: &[Interface<S>]) -> f64 {
    let holding = laws.iter().map(|interface| match interface.friction {
        FrictionLaw::Coulomb { kinetic_coefficient, .. } => CALM_OF_FRICTION * kinetic_coefficient,
        // Contacts without friction resist slip by the shape of their seats only, and contacts with regularized
        // friction creep.
        FrictionLaw::Frictionless | FrictionLaw::Regularized { .. } => 0.0,
    });
    holding.fold(CALM, f64::min)
}

impl<R: Real> Rest<R> {
    /// Observes an accepted state and returns the lanes at rest. `collapsed` are the lanes with a collapsed stack.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    pub fn observe(&mut self, state: &State<Planar<R>>, collapsed: R::Mask) -> R::Mask {
        let mut moves = state.time.lt(R::select(collapsed, self.calm_from, self.still_from));
        let ground = state.twists[Assembly::GROUND].linear;
        for at in 0..self.bodies.len() {
            // Once every lane has a body that moves, the other bodies need no test.
            if moves.all() {
                break;
            }
            let body = &self.bodies[at];
            let twist = state.twists[body.body];
            let velocity = twist.linear - ground;
            let turning = body.inertia * twist.angular * twist.angular;
            let fast = self.slow.lt(R::splat(0.5) * (velocity.dot(velocity) + turning));
            if (fast & !moves).any() {
                moves = moves | (fast & !self.rolls_away(state, at));
            }
        }
        self.moved = R::select(moves, state.time, self.moved);
        (self.moved + self.hold).le(state.time)
    }

    /// Returns the lanes in which a body is a barrel on the floor that approaches no other body.
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "lanes use vector instructions only if inlined")]
    fn rolls_away(&self, state: &State<Planar<R>>, at: usize) -> R::Mask {
        let ground = state.poses[Assembly::GROUND].position;
        let own = &self.bodies[at];
        let (here, velocity) = (state.poses[own.body].position, state.twists[own.body].linear);
        let rise = velocity.z - state.twists[Assembly::GROUND].linear.z;
        let level = (R::splat(0.5) * rise * rise).le(self.slow);
        let mut away = (here.z - ground.z).le(own.floor) & level;
        for other in self.bodies.iter().filter(|other| other.body != own.body) {
            if !away.any() {
                break;
            }
            let apart = state.poses[other.body].position.x - here.x;
            let parting = state.twists[other.body].linear.x - velocity.x;
            away = away & R::zero().le(apart * parting);
        }
        away
    }
}
