//! Straps: they pull two bodies together, and never push them apart.

use crate::body::BodyId;
use crate::model::Model;
use crate::real::{Mask, Real};
use crate::space::{Linear, Space, Wrench};
use crate::state::State;

/// A strap between a point of one body and a point of another.
///
/// Tension is the force that it pulls with: `T = max(0, k e + c ė)` while its elongation `e` (m), the
/// distance of the two points less `length`, is positive, and zero while it is slack.
/// It has no mass, and nothing touches it on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct Strap<S: Space> {
    /// The name in results.
    pub name: String,
    /// The bodies it ties.
    pub bodies: [BodyId; 2],
    /// Where it is made fast (m), each in the frame of its body.
    pub points: [S::Vector; 2],
    /// Distance of the points (m) from which on it pulls.
    pub length: S::Real,
    /// Stiffness k (N/m).
    pub stiffness: S::Real,
    /// Damping c (N·s/m).
    pub damping: S::Real,
    /// Tension (N) above which it tears, for good; infinite if it never does.
    pub strength: S::Real,
}

/// What a strap does at a state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pull<R> {
    /// Tension (N), never negative.
    pub tension: R,
    /// Energy stored in it (J).
    pub energy: R,
}

/// How a strap pulls, and the unit vector from its first point to its second.
struct Taut<S: Space> {
    pull: Pull<S::Real>,
    /// The part of the tension that the damper makes (N).
    damped: S::Real,
    along: S::Vector,
    /// From the centers of mass to the points (m), in the inertial frame.
    arms: [S::Vector; 2],
}

impl<S: Space> Strap<S> {
    /// What is wrong with it in a model of a number of bodies.
    pub(crate) fn problem(&self, bodies: usize) -> Option<&'static str> {
        let all = |number: S::Real, sound: fn(f64) -> bool| {
            (0..S::Real::LANES).all(|lane| sound(number.lane(lane)))
        };
        let [first, second] = self.bodies;
        if first == second {
            Some("it ties a body to itself")
        } else if first.max(second) >= bodies {
            Some("it ties a body that is not there")
        } else if !all(self.stiffness, |k| k > 0.0 && k.is_finite()) {
            Some("its stiffness must be positive and finite")
        } else if !all(self.damping, |c| c >= 0.0 && c.is_finite()) {
            Some("its damping must not be negative")
        } else if !all(self.length, |l| l >= 0.0 && l.is_finite()) {
            Some("its length must not be negative")
        } else if !all(self.strength, |t| t > 0.0) {
            Some("its strength must be positive")
        } else {
            None
        }
    }

    /// The distance of its points (m).
    pub fn span(&self, state: &State<S>) -> S::Real {
        let [first, second] = [0, 1].map(|at| {
            let pose = state.poses[self.bodies[at]];
            pose.position + S::rotate(S::rotation(pose.orientation), self.points[at])
        });
        let apart = second - first;
        apart.dot(apart).sqrt()
    }

    #[inline(always)]
    fn taut(
        &self,
        state: &State<S>,
        rotations: &[S::Rotation],
        torn: <S::Real as Real>::Mask,
    ) -> Taut<S> {
        let zero = S::Real::zero();
        let [first, second] = self.bodies;
        let arms = [
            S::rotate(rotations[first], self.points[0]),
            S::rotate(rotations[second], self.points[1]),
        ];
        let apart =
            state.poses[second].position + arms[1] - (state.poses[first].position + arms[0]);
        let distance = apart.dot(apart).sqrt();
        let taut = self.length.lt(distance) & zero.lt(distance) & !torn;
        let along =
            apart * (S::Real::splat(1.0) / S::Real::select(taut, distance, S::Real::splat(1.0)));
        let velocity = |body: usize, arm| {
            let twist = state.twists[body];
            twist.linear + S::velocity_at(twist.angular, arm)
        };
        let rate = (velocity(second, arms[1]) - velocity(first, arms[0])).dot(along);
        let elongation = S::Real::select(taut, distance - self.length, zero);
        let elastic = self.stiffness * elongation;
        let tension = (elastic + self.damping * rate).max(zero);
        let tension = S::Real::select(taut, tension, zero);
        let energy = S::Real::splat(0.5) * elastic * elongation;
        Taut { pull: Pull { tension, energy }, damped: tension - elastic, along, arms }
    }
}

/// What the straps of a model do to its bodies: `act` is told of each body the whole wrench about its
/// center of mass, and of that the part that dampers make.
#[inline(always)]
pub(crate) fn pull_all<S: Space>(
    model: &Model<S>,
    state: &State<S>,
    rotations: &[S::Rotation],
    pulls: &mut Vec<Pull<S::Real>>,
    mut act: impl FnMut(BodyId, Wrench<S>, Wrench<S>),
) {
    pulls.clear();
    for (strap, torn) in model.straps.iter().zip(&state.torn) {
        let Taut { pull, damped, along, arms } = strap.taut(state, rotations, *torn);
        for (at, toward) in [(0, along), (1, -along)] {
            let lever = S::moment(arms[at], toward);
            let by = |size: S::Real| Wrench { force: toward * size, moment: lever * size };
            act(strap.bodies[at], by(pull.tension), by(damped));
        }
        pulls.push(pull);
    }
}

/// Straps that were pulled above their strength in an accepted state are torn from then on.
#[inline(always)]
pub(crate) fn tear<S: Space>(
    model: &Model<S>,
    torn: &mut [<S::Real as Real>::Mask],
    pulls: &[Pull<S::Real>],
) {
    for ((strap, torn), pull) in model.straps.iter().zip(torn).zip(pulls) {
        *torn = *torn | strap.strength.lt(pull.tension);
    }
}

/// Whether a mask changed to true in at least one lane.
#[inline(always)]
pub(crate) fn newly<M: Mask>(before: M, now: M) -> M {
    now & !before
}
