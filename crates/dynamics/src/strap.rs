//! Straps: they pull two bodies together, and never push them apart.

use crate::body::BodyId;
use crate::model::Model;
use crate::real::Real;
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

/// How a strap pulls.
pub(crate) struct Taut<S: Space> {
    pub(crate) pull: Pull<S::Real>,
    /// The part of the tension that the damper makes (N).
    damped: S::Real,
    /// The unit vector from its first point to its second.
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

    /// How it pulls at a state; not at all in lanes where it is torn.
    #[inline(always)]
    pub(crate) fn taut(
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

impl<S: Space> Taut<S> {
    /// What the strap does to each of its bodies: the whole wrench about the center of mass, and of that
    /// the part that its damper makes.
    #[inline(always)]
    pub(crate) fn on_bodies(&self) -> [(Wrench<S>, Wrench<S>); 2] {
        [(self.arms[0], self.along), (self.arms[1], -self.along)].map(
            #[inline(always)]
            |(arm, toward)| {
                let lever = S::moment(arm, toward);
                let by = |size: S::Real| Wrench { force: toward * size, moment: lever * size };
                (by(self.pull.tension), by(self.damped))
            },
        )
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
