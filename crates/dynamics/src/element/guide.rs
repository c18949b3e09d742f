//! Guides: a spring, a damper and stops that act along an axis of the body to which the guide is fixed.

use super::{Action, Link, Load, Memory, all};
use crate::lanewise;
use crate::real::Real;
use crate::space::{Linear, Space};
use crate::state::State;

/// A guide that is fixed to its first body; a point of the second body moves along the guide.
///
/// Let `e` (m) be the displacement of the point from its position at rest, along an axis that turns with the first
/// body. The force is
///
/// ```text
/// f = k e + c ė                                   within the gap δ
/// f = k e + c ė + kₛ (|e| − δ) sgn e + cₛ ė       beyond the gap δ
/// ```
///
/// The damper of a stop, cₛ, acts only while `|e|` grows.
///
/// The force acts on both bodies at the point of the second body, so momentum is conserved. The guide releases the
/// point permanently as soon as the point is farther than `reach` (m) from the axis, or the force exceeds the strength.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide<S: Space> {
    /// The joined points.
    pub link: Link<S>,
    /// Axis of the guide: a unit vector in the frame of the first body.
    pub axis: S::Vector,
    /// Vector (m) from the first point to the second point at rest, in the frame of the first body.
    pub place: S::Vector,
    /// Stiffness k (N/m).
    pub stiffness: S::Real,
    /// Damping c (N·s/m).
    pub damping: S::Real,
    /// Displacement δ (m) to either side at which the point reaches a stop; infinite for a guide without stops.
    pub gap: S::Real,
    /// Stiffness kₛ of the stops (N/m).
    pub stop_stiffness: S::Real,
    /// Damping cₛ of the stops on approach (N·s/m).
    pub stop_damping: S::Real,
    /// Force (N) above which the guide breaks; infinite if it never breaks.
    pub strength: S::Real,
    /// Distance (m) from the axis beyond which the guide releases the point; infinite if the guide never releases the
    /// point.
    pub reach: S::Real,
    /// Direction in which the distance from the axis is not limited: a unit vector in the frame of the first body. Zero
    /// if the distance is limited in every direction.
    pub free: S::Vector,
}

lanewise!(struct Guide<S> {
    link, axis, place, stiffness, damping, gap, stop_stiffness, stop_damping, strength, reach, free
});

impl<S: Space> Guide<S> {
    /// Creates a guide with a spring and a damper but without stops; its two points coincide at rest.
    pub fn spring(link: Link<S>, axis: S::Vector, stiffness: S::Real, damping: S::Real) -> Self {
        let (never, none) = (S::Real::splat(f64::INFINITY), S::Real::zero());
        Self {
            link,
            axis,
            place: S::Vector::default(),
            stiffness,
            damping,
            gap: never,
            stop_stiffness: none,
            stop_damping: none,
            strength: never,
            reach: never,
            free: S::Vector::default(),
        }
    }

    /// Returns the guide for a first body that may turn about the axis of the guide. The position at rest, `place`,
    /// must have been set before.
    ///
    /// Only the component of `place` along the axis is kept, since the other components turn with the body. `reach` is
    /// increased by the distance of the point from the axis.
    #[must_use]
    pub fn about_axis(self) -> Self {
        let along = self.axis * self.axis.dot(self.place);
        let away = self.place - along;
        Self { place: along, reach: self.reach + away.dot(away).sqrt(), ..self }
    }

    /// Returns the sum of `free` and `stop` for a guide with stops, and `free` for a guide without stops. `free` is the
    /// stiffness or damping of the guide itself, and `stop` is the stiffness or damping of the stops.
    fn with_stops(&self, free: S::Real, stop: S::Real) -> S::Real {
        free + S::Real::select(self.gap.is_finite_mask(), stop, S::Real::zero())
    }

    pub(super) fn stiffness(&self) -> S::Real {
        self.with_stops(self.stiffness, self.stop_stiffness)
    }

    pub(super) fn damping(&self) -> S::Real {
        self.with_stops(self.damping, self.stop_damping)
    }

    pub(super) fn fit(&mut self, state: &State<S>, give: S::Real) {
        let [first, second] = [0, 1].map(|at| {
            let pose = state.poses[self.link.bodies[at]];
            (pose.position, S::rotation(pose.orientation))
        });
        let point = second.0 + S::rotate(second.1, self.link.points[1]);
        let place = S::unrotate(first.1, point - first.0) - self.link.points[0];
        self.place = place + self.axis * give;
    }

    pub(super) fn flaw(&self) -> Option<&'static str> {
        let constants = [self.stiffness, self.damping, self.stop_stiffness, self.stop_damping];
        let length = self.axis.dot(self.axis);
        if !constants.into_iter().all(|it| all(it, |k| k >= 0.0 && k.is_finite())) {
            Some("its stiffness and damping must be finite and not negative")
        } else if !all(length, |l| (l - 1.0).abs() < 1e-9) {
            Some("its axis must be a unit vector")
        } else if !all(self.gap, |d| d >= 0.0) {
            Some("its gap must not be negative")
        } else if ![self.strength, self.reach].into_iter().all(|it| all(it, |f| f > 0.0)) {
            Some("its strength and its reach must be positive")
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
        let (zero, one) = (S::Real::zero(), S::Real::splat(1.0));
        let line = self.link.at_second(state, rotations);
        let rotation = rotations[self.link.bodies[0]];
        let along = S::rotate(rotation, self.axis);
        let offset = S::unrotate(rotation, line.arms[0]) - self.link.points[0] - self.place;
        let e = self.axis.dot(offset);
        let rate = line.rate(state, along);

        let side = S::Real::select(e.lt(zero), -one, one);
        let met = self.gap.lt(e.abs());
        let depth = S::Real::select(met, e.abs() - self.gap, zero);
        let closing = met & zero.lt(side * rate);
        let stop = self.stop_stiffness * depth;
        let elastic = self.stiffness * e + side * stop;
        let damped = self.damping * rate + S::Real::select(closing, self.stop_damping * rate, zero);
        let energy = S::Real::splat(0.5) * (self.stiffness * e * e + stop * depth);

        let counted = |value| S::Real::select(memory.broken, zero, value);
        let elastic = counted(elastic);
        let damped = counted(damped);
        let force = elastic + damped;
        let aside = offset - self.axis * e;
        let aside = aside - self.free * self.free.dot(aside);
        let breaks = self.strength.lt(force.abs()) | (self.reach * self.reach).lt(aside.dot(aside));
        let load = Load { force, energy: counted(energy), elastic, breaks, ..Load::default() };
        Action { load, wrenches: line.pull(along, force, damped) }
    }
}
