//! Rods, which hold two points at a given distance and act in tension and compression.

use super::{Action, Link, Load, Memory, all};
use crate::lanewise;
use crate::real::Real;
use crate::space::{Linear, Space, Wrench};
use crate::state::State;

/// A rod that is hinged to a point of one body and to a point of another.
///
/// The force along the rod is `f = k (d − l) + c ḋ`, with the distance `d` (m) between the points and the length `l` of
/// the rod. A second damper acts across the rod, on the velocity of the second point relative to the first body; it
/// models the damping of a pendulum.
#[derive(Clone, Debug, PartialEq)]
pub struct Rod<S: Space> {
    /// The joined points.
    pub link: Link<S>,
    /// Length l (m): the distance between the points when the rod is unloaded.
    pub length: S::Real,
    /// Stiffness k (N/m).
    pub stiffness: S::Real,
    /// Damping c (N·s/m) along the rod.
    pub damping: S::Real,
    /// Damping (N·s/m) across the rod.
    pub sway_damping: S::Real,
}

lanewise!(struct Rod<S> { link, length, stiffness, damping, sway_damping });

impl<S: Space> Rod<S> {
    pub(super) fn stiffness(&self) -> S::Real {
        self.stiffness
    }

    pub(super) fn damping(&self) -> S::Real {
        self.damping + self.sway_damping
    }

    pub(super) fn fit(&mut self, state: &State<S>, give: S::Real) {
        self.length = self.link.span(state) + give;
    }

    pub(super) fn flaw(&self) -> Option<&'static str> {
        if !all(self.stiffness, |k| k > 0.0 && k.is_finite()) {
            Some("its stiffness must be positive and finite")
        } else if ![self.damping, self.sway_damping]
            .into_iter()
            .all(|it| all(it, |c| c >= 0.0 && c.is_finite()))
        {
            Some("its damping must not be negative")
        } else if !all(self.length, |l| l > 0.0 && l.is_finite()) {
            Some("its length must be positive")
        } else {
            None
        }
    }

    #[inline(always)]
    pub(super) fn act(
        &self,
        state: &State<S>,
        rotations: &[S::Rotation],
        memory: Memory<S>,
    ) -> Action<S> {
        let zero = S::Real::zero();
        let line = self.link.line(state, rotations);
        let holds = zero.lt(line.distance) & !memory.broken;
        let along = line.along(holds);
        let elongation = S::Real::select(holds, line.distance - self.length, zero);
        let elastic = self.stiffness * elongation;
        let damped = S::Real::select(holds, self.damping * line.rate(state, along), zero);
        let mut wrenches = line.pull(along, elastic + damped, damped);

        let seat = self.link.at_second(state, rotations);
        let velocity = seat.velocity(state);
        let across = velocity - along * velocity.dot(along);
        let drag = across * S::Real::select(holds, self.sway_damping, zero);
        for ((whole, damped), (arm, force)) in
            wrenches.iter_mut().zip([(seat.arms[0], drag), (seat.arms[1], -drag)])
        {
            let dragged = Wrench { force, moment: S::moment(arm, force) };
            *whole += dragged;
            *damped += dragged;
        }
        let force = elastic + damped;
        let energy = S::Real::splat(0.5) * elastic * elongation;
        Action { load: Load { force, energy, elastic, ..Load::default() }, wrenches }
    }
}
