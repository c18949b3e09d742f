//! Diagnosis of a stack that does not come to rest: the body that fails first, and the cause.

use crate::body::BodyId;
use crate::contact::FrictionLaw;
use crate::forces::{Contact, Scratch};
use crate::model::Model;
use crate::real::{Mask, Real};
use crate::space::{Linear, Pose, Space};
use crate::state::State;

use super::gravity;

/// Displacement of a body, as a fraction of its reach, at which the cause of the displacement is diagnosed. No body
/// moves so far while it settles, but a body that has moved only so far has not yet disturbed others.
const GOING: f64 = 0.1;

/// Displacement of a body, as a fraction of its reach, beyond which it counts as out of place.
const LEFT: f64 = 0.5;

/// Displacement of a body, as a fraction of the largest displacement of any body, at or above which the body also
/// counts as moving.
const WITH_IT: f64 = 0.25;

/// Ratio of penetration to displacement above which a body is classed as sinking.
const SINKS: f64 = 0.5;

/// Ratio above which a body is classed as tipping. The ratio is the displacement of its boundary due to rotation,
/// divided by the displacement of its center of mass; it is 1 if the body rolls, or tips over its corner.
const TURNS: f64 = 0.7;

/// A body that does not come to rest under gravity.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("body \"{body}\" does not come to rest under gravity (it moved {moved:.3} m): {lack}")]
pub struct SettleError {
    /// Name of the lowest body that moves. Bodies above it may move only because they lose their support.
    pub body: String,
    /// Displacement (m) of the body from its initial position, at the time of the error.
    pub moved: f64,
    /// The cause.
    pub lack: Lack,
}

/// Cause of the failure to come to rest.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Lack {
    /// The body has touched no other body, and none of its force elements has been loaded.
    #[error("nothing lies under it, and nothing holds it")]
    Support,
    /// The support of the body is too soft.
    #[error(
        "it sinks {depth:.3} m into \"{on}\": the contacts of {interface} are too soft for the load \
         on them"
    )]
    Stiffness {
        /// Name of the supporting body.
        on: String,
        /// Name of the interface between the two bodies.
        interface: String,
        /// The penetration (m).
        depth: f64,
    },
    /// All contacts of the body slip.
    #[error("it slides on \"{on}\": the friction of {interface} is too low to hold it")]
    Friction {
        /// Name of the supporting body.
        on: String,
        /// Name of the interface between the two bodies.
        interface: String,
    },
    /// The friction law of a contact does not hold the body at rest.
    #[error(
        "it creeps on \"{on}\": the regularized friction of {interface} resists motion, but cannot \
         hold a body at rest"
    )]
    Stick {
        /// Name of the supporting body.
        on: String,
        /// Name of the interface between the two bodies.
        interface: String,
    },
    /// The body turns over on its support.
    #[error("it tips or rolls over: its support \"{on}\" does not keep it upright under its load")]
    Balance {
        /// Name of the supporting body.
        on: String,
    },
    /// The body leaves its support.
    #[error("it is pushed out of place")]
    Place,
    /// The maximum number of steps was reached before the forces balanced, but the body stays in place.
    #[error(
        "after {steps} steps, its residual acceleration is still {unbalanced:.0e} times the acceleration of gravity"
    )]
    Time {
        /// Number of steps taken.
        steps: u64,
        /// Largest residual acceleration of any body after these steps, as a fraction of gravity.
        unbalanced: f64,
    },
}

/// Detector of bodies that move out of place.
pub(super) struct Departure<S: Space> {
    start: Vec<Pose<S>>,
    /// The bodies, the lowest first.
    upward: Vec<BodyId>,
    /// The lowest body that was moving when the first body began to move, and the cause diagnosed at that time.
    first: Option<(BodyId, Lack)>,
}

impl<S: Space> Departure<S> {
    pub(super) fn new(model: &Model<S>, start: Vec<Pose<S>>) -> Self {
        let height = |body: BodyId| -start[body].position.dot(model.gravity).lane(0);
        let mut upward: Vec<BodyId> = (0..start.len()).collect();
        upward.sort_by(|a, b| height(*a).total_cmp(&height(*b)));
        Self { start, upward, first: None }
    }

    /// Returns, for each body, the displacement (m) from its initial position: the largest of its sideways
    /// displacement, its rise, and the amount by which it sinks more than the bodies below. So a body that sinks on
    /// soft contacts together with the bodies below is not counted as displaced.
    fn strayed(&self, model: &Model<S>, poses: &[Pose<S>]) -> Vec<f64> {
        let down = model.gravity * (S::Real::splat(1.0) / gravity(model));
        let mut strayed = vec![0.0; self.start.len()];
        let mut sunk = S::Real::zero();
        for body in &self.upward {
            let displacement = poses[*body].position - self.start[*body].position;
            let fallen = displacement.dot(down);
            let sideways = displacement - down * fallen;
            let sideways = sideways.dot(sideways).sqrt();
            let far = sideways.max(-fallen).max(fallen - sunk).largest_lane();
            strayed[*body] = if far.is_finite() { far } else { f64::INFINITY };
            sunk = sunk.max(fallen);
        }
        strayed
    }

    /// Detects bodies that move out of place. Diagnoses the first body that moves farther than a settling body does,
    /// and returns the error as soon as a body is out of place.
    ///
    /// The diagnosis is made early, since a body that is out of place may already have pushed other bodies away.
    pub(super) fn watch(
        &mut self,
        model: &Model<S>,
        state: &State<S>,
        scratch: &Scratch<S>,
        met: &[bool],
    ) -> Result<(), SettleError> {
        let strayed = self.strayed(model, &state.poses);
        let most = most(model, &strayed);
        if most < GOING {
            return Ok(());
        }
        let (first, lack) = if let Some(first) = self.first.take() {
            first
        } else {
            let farthest = strayed.iter().copied().fold(0.0, f64::max);
            let going: Vec<bool> =
                strayed.iter().map(|distance| *distance >= WITH_IT * farthest).collect();
            let lowest = self.upward.iter().copied().find(|body| going[*body]).unwrap_or_default();
            (lowest, self.lack(lowest, model, state, scratch, met, &going))
        };
        if most < LEFT {
            self.first = Some((first, lack));
            return Ok(());
        }
        Err(self.refusal(model, state, first, lack))
    }

    /// Returns `true` if [`Departure::watch`] would report that a body is out of place.
    pub(super) fn has_left(&self, model: &Model<S>, poses: &[Pose<S>]) -> bool {
        most(model, &self.strayed(model, poses)) >= LEFT
    }

    /// Returns the error for a stack in which no body is out of place, but the forces do not balance. The error names
    /// the first body that moved or, if no body moved, the body with the largest residual.
    pub(super) fn unbalanced(
        &mut self,
        model: &Model<S>,
        state: &State<S>,
        (steps, body, unbalanced): (u64, BodyId, f64),
    ) -> SettleError {
        let (body, lack) = self.first.take().unwrap_or((body, Lack::Time { steps, unbalanced }));
        self.refusal(model, state, body, lack)
    }

    fn refusal(&self, model: &Model<S>, state: &State<S>, body: BodyId, lack: Lack) -> SettleError {
        let moved = self.moved(state, body);
        SettleError { body: model.bodies[body].name.clone(), moved, lack }
    }

    /// Returns the displacement (m) of a body, in the lane where it is largest.
    fn moved(&self, state: &State<S>, body: BodyId) -> f64 {
        let displacement = state.poses[body].position - self.start[body].position;
        displacement.dot(displacement).sqrt().largest_lane()
    }

    /// Diagnoses a moving body; `going` contains all bodies that move.
    fn lack(
        &self,
        body: BodyId,
        model: &Model<S>,
        state: &State<S>,
        scratch: &Scratch<S>,
        met: &[bool],
        going: &[bool],
    ) -> Lack {
        let of = |contact: &&Contact<S>| {
            let pair = &model.pair(contact.pair);
            contact.touching.any() && (pair.contactor == body || pair.target == body)
        };
        let partner = |contact: &Contact<S>| {
            let pair = &model.pair(contact.pair);
            if pair.contactor == body { pair.target } else { pair.contactor }
        };
        // The support is among the bodies at rest; if all bodies move, any contact is used.
        let bearing: Vec<_> = scratch.contacts.iter().filter(of).collect();
        let staying: Vec<_> = bearing.iter().copied().filter(|c| !going[partner(c)]).collect();
        let bearing = if staying.is_empty() { bearing } else { staying };
        let Some(last) = bearing.first() else {
            return if met[body] { Lack::Place } else { Lack::Support };
        };
        let on = model.bodies[partner(last)].name.clone();
        let law = |contact: &Contact<S>| &model.interfaces[model.pair(contact.pair).interface];
        if let Some(creeping) =
            bearing.iter().find(|c| matches!(law(c).friction, FrictionLaw::Regularized { .. }))
        {
            let on = model.bodies[partner(creeping)].name.clone();
            return Lack::Stick { on, interface: law(creeping).name.clone() };
        }
        let depth = |contact: &Contact<S>| contact.penetration.largest_lane();
        let deepest = bearing.iter().max_by(|a, b| depth(a).total_cmp(&depth(b)));
        if let Some(deepest) = deepest.filter(|c| depth(c) > SINKS * self.moved(state, body)) {
            let on = model.bodies[partner(deepest)].name.clone();
            let (interface, depth) = (law(deepest).name.clone(), depth(deepest));
            return Lack::Stiffness { on, interface, depth };
        }
        let turn = S::spin_magnitude(S::turn_between(
            self.start[body].orientation,
            state.poses[body].orientation,
        ));
        if turn.largest_lane() * model.reach[body] > TURNS * self.moved(state, body) {
            return Lack::Balance { on };
        }
        let slips = |contact: &&Contact<S>| {
            state.contact_elements.sticks[contact.element].slipping.any()
                || matches!(law(contact).friction, FrictionLaw::Frictionless)
        };
        if bearing.iter().all(slips) {
            return Lack::Friction { on, interface: law(last).name.clone() };
        }
        Lack::Place
    }
}

/// Returns the largest ratio, over all bodies, of the displacement of a body to its extent.
fn most<S: Space>(model: &Model<S>, strayed: &[f64]) -> f64 {
    let shares = strayed.iter().enumerate().map(|(body, far)| far / extent(model, body));
    shares.fold(0.0, f64::max)
}

/// Returns the largest distance (m) of the boundary of a body from its center of mass; 1 m for a body without a
/// boundary.
fn extent<S: Space>(model: &Model<S>, body: usize) -> f64 {
    let reach = model.reach[body];
    if reach > 0.0 { reach } else { 1.0 }
}
