//! Why bodies do not come to rest: which one goes, and what it lacks.

use crate::body::{BodyId, Motion};
use crate::contact::FrictionLaw;
use crate::forces::{Contact, Scratch};
use crate::model::Model;
use crate::real::{Mask, Real};
use crate::space::{Linear, Pose, Space};
use crate::state::State;

use super::{LEFT, extent, moved};

/// Share of its reach that a body has moved when it is looked at for what it lacks: more than it sinks,
/// and not so much that all is lost.
const GOING: f64 = 0.1;

/// Share of the way of the body that goes furthest from which a body goes with it.
const WITH_IT: f64 = 0.25;

/// Share of the way of its center of mass by which the boundary of a body that turns over has turned: all
/// of it where it rolls, or tips over its corner.
const TURNS: f64 = 0.7;

/// A body that does not come to rest under gravity.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("body \"{body}\" does not come to rest under gravity (it moved {moved:.3} m): {lack}")]
pub struct SettleError {
    /// The lowest of the bodies that go: those above lose their hold with it.
    pub body: String,
    /// How far it moved (m).
    pub moved: f64,
    /// Why it goes.
    pub lack: Lack,
}

/// What a body lacks to come to rest.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Lack {
    /// Nothing was ever in touch with it.
    #[error("nothing lies under it, and nothing holds it")]
    Support,
    /// All its contacts slip.
    #[error("it slides on \"{on}\", more than the friction of {interface} can hold")]
    Friction {
        /// The body it lies on.
        on: String,
        /// The interface between the two.
        interface: String,
    },
    /// Its friction law does not hold what is at rest.
    #[error(
        "it creeps on \"{on}\": the regularized friction of {interface} resists motion, but holds \
         nothing at rest"
    )]
    Stick {
        /// The body it lies on.
        on: String,
        /// The interface between the two.
        interface: String,
    },
    /// It turns over what it lies on.
    #[error(
        "it tips or rolls over on \"{on}\", which does not hold its weight and what it bears upright"
    )]
    Balance {
        /// The body it lies on.
        on: String,
    },
    /// It leaves what bore it.
    #[error("it is pushed out of its place")]
    Place,
    /// The forces neither balance nor move it away.
    #[error(
        "after {steps} steps its forces still miss their balance, by {unbalanced:.0e} of gravity"
    )]
    Time {
        /// The steps.
        steps: u64,
        /// The acceleration that is left, as a share of gravity.
        unbalanced: f64,
    },
}

/// Watches for bodies that go.
pub(super) struct Departure<S: Space> {
    start: Vec<Pose<S>>,
    /// The lowest body that went when the first did, and what it lacked then.
    first: Option<(BodyId, Lack)>,
}

impl<S: Space> Departure<S> {
    pub(super) fn new(start: Vec<Pose<S>>) -> Self {
        Self { start, first: None }
    }

    /// Notes what the first body lacks that moves further than sinking explains.
    ///
    /// By the time that it has left, it has met other bodies and pushed them away.
    pub(super) fn watch(
        &mut self,
        model: &Model<S>,
        state: &State<S>,
        scratch: &Scratch<S>,
        met: &[bool],
    ) {
        let way = |body| moved(state, &self.start, body);
        let goes = |body: BodyId| {
            model.bodies[body].motion == Motion::Free && !(way(body) < GOING * extent(model, body))
        };
        if self.first.is_some() || !(0..model.bodies.len()).any(goes) {
            return;
        }
        let most = (0..model.bodies.len()).map(way).fold(0.0, f64::max);
        let going: Vec<bool> = (0..model.bodies.len()).map(|b| way(b) > WITH_IT * most).collect();
        let height = |body: BodyId| -self.start[body].position.dot(model.gravity).lane(0);
        let lowest = (0..model.bodies.len())
            .filter(|body| going[*body])
            .min_by(|a, b| height(*a).total_cmp(&height(*b)));
        let Some(body) = lowest else { return };
        self.first = Some((body, self.lack(body, model, state, scratch, met, &going)));
    }

    /// Why there is no rest, once a body has left.
    pub(super) fn gone(&self, model: &Model<S>, state: &State<S>) -> Option<SettleError> {
        let left = |body: BodyId| !(moved(state, &self.start, body) < LEFT * extent(model, body));
        let bodies = 0..model.bodies.len();
        let left =
            bodies.into_iter().any(|body| model.bodies[body].motion == Motion::Free && left(body));
        let (body, lack) = self.first.clone().filter(|_| left)?;
        let moved = moved(state, &self.start, body);
        Some(SettleError { body: model.bodies[body].name.clone(), moved, lack })
    }

    /// Why there is no rest, though all are where they were.
    pub(super) fn unbalanced(
        &self,
        model: &Model<S>,
        state: &State<S>,
        (steps, body, unbalanced): (u64, BodyId, f64),
    ) -> SettleError {
        let (body, lack) = self.first.clone().unwrap_or((body, Lack::Time { steps, unbalanced }));
        let moved = moved(state, &self.start, body);
        SettleError { body: model.bodies[body].name.clone(), moved, lack }
    }

    /// What a body lacks that goes, with those others that go.
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
            let pair = &model.pairs[contact.pair];
            contact.touching.any() && (pair.contactor == body || pair.target == body)
        };
        let partner = |contact: &Contact<S>| {
            let pair = &model.pairs[contact.pair];
            if pair.contactor == body { pair.target } else { pair.contactor }
        };
        // What bears it stays; where all go, the last that bears it tells as much as any.
        let bearing: Vec<_> = scratch.contacts.iter().filter(of).collect();
        let staying: Vec<_> = bearing.iter().copied().filter(|c| !going[partner(c)]).collect();
        let bearing = if staying.is_empty() { bearing } else { staying };
        let Some(last) = bearing.first() else {
            return if met[body] { Lack::Place } else { Lack::Support };
        };
        let on = model.bodies[partner(last)].name.clone();
        let law = |contact: &Contact<S>| &model.interfaces[model.pairs[contact.pair].interface];
        if let Some(creeping) =
            bearing.iter().find(|c| matches!(law(c).friction, FrictionLaw::Regularized { .. }))
        {
            let on = model.bodies[partner(creeping)].name.clone();
            return Lack::Stick { on, interface: law(creeping).name.clone() };
        }
        let turn = S::spin_magnitude(S::turn_between(
            self.start[body].orientation,
            state.poses[body].orientation,
        ));
        if turn.largest_lane() * model.reach[body] > TURNS * moved(state, &self.start, body) {
            return Lack::Balance { on };
        }
        let slips = |contact: &&Contact<S>| {
            state.elements.sticks[contact.element].slipping.any()
                || matches!(law(contact).friction, FrictionLaw::Frictionless)
        };
        if bearing.iter().all(slips) {
            return Lack::Friction { on, interface: law(last).name.clone() };
        }
        Lack::Place
    }
}
