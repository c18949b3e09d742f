//! A link: the straight line between a point of one body and a point of another.

use crate::body::BodyId;
use crate::lanewise;
use crate::real::{Real, both};
use crate::space::{Linear, Space, Wrench};
use crate::state::State;

/// Name of a force element, and the two points that the element joins.
#[derive(Clone, Debug, PartialEq)]
pub struct Link<S: Space> {
    /// Name in results.
    pub name: String,
    /// The joined bodies.
    pub bodies: [BodyId; 2],
    /// Attachment points (m), each in the frame of the body to which it is fixed.
    pub points: [S::Vector; 2],
}

lanewise!(struct Link<S> { name, bodies, points });

/// Geometry of a link at a state.
pub(super) struct Line<S: Space> {
    bodies: [BodyId; 2],
    /// Vectors (m) from the centers of mass of the bodies to their attachment points, in the inertial frame.
    pub(super) arms: [S::Vector; 2],
    /// Vector (m) from the first attachment point to the second, in the inertial frame.
    apart: S::Vector,
    /// Distance (m) between the points.
    pub(super) distance: S::Real,
}

impl<S: Space> Link<S> {
    pub(super) fn flaw(&self, bodies: usize) -> Option<&'static str> {
        let [first, second] = self.bodies;
        if first == second {
            Some("it joins a body to itself")
        } else if first.max(second) >= bodies {
            Some("it joins a body that does not exist")
        } else {
            None
        }
    }

    /// Returns the distance (m) between the points at a state.
    pub fn span(&self, state: &State<S>) -> S::Real {
        let [first, second] = [0, 1].map(|at| {
            let pose = state.poses[self.bodies[at]];
            pose.position + S::rotate(S::rotation(pose.orientation), self.points[at])
        });
        let apart = second - first;
        apart.dot(apart).sqrt()
    }

    #[inline(always)]
    pub(super) fn line(&self, state: &State<S>, rotations: &[S::Rotation]) -> Line<S> {
        let [first, second] = self.bodies;
        let arms = [
            S::rotate(rotations[first], self.points[0]),
            S::rotate(rotations[second], self.points[1]),
        ];
        let apart =
            state.poses[second].position + arms[1] - (state.poses[first].position + arms[0]);
        Line { bodies: self.bodies, arms, apart, distance: apart.dot(apart).sqrt() }
    }

    /// Returns a line of zero length whose ends both lie at the second point: one end moves with the first body, the
    /// other end with the second.
    #[inline(always)]
    pub(super) fn at_second(&self, state: &State<S>, rotations: &[S::Rotation]) -> Line<S> {
        let [first, second] = self.bodies;
        let arm = S::rotate(rotations[second], self.points[1]);
        let apart = state.poses[second].position - state.poses[first].position;
        let (apart, nothing) = (apart + arm, S::Vector::default());
        Line { bodies: self.bodies, arms: [apart, arm], apart: nothing, distance: S::Real::zero() }
    }
}

impl<S: Space> Line<S> {
    /// Returns the unit vector from the first point to the second in the lanes `counts`, where the distance must be
    /// positive. In other lanes, the result is not a unit vector.
    #[inline(always)]
    pub(super) fn along(&self, counts: <S::Real as Real>::Mask) -> S::Vector {
        let one = S::Real::splat(1.0);
        self.apart * (one / S::Real::select(counts, self.distance, one))
    }

    /// Returns the velocity (m/s) of the second point relative to the first.
    #[inline(always)]
    pub(super) fn velocity(&self, state: &State<S>) -> S::Vector {
        let velocity = |body: usize, arm| {
            let twist = state.twists[body];
            twist.linear + S::velocity_at(twist.angular, arm)
        };
        let [first, second] = self.bodies;
        velocity(second, self.arms[1]) - velocity(first, self.arms[0])
    }

    /// Returns the rate of elongation (m/s).
    #[inline(always)]
    pub(super) fn rate(&self, state: &State<S>, along: S::Vector) -> S::Real {
        self.velocity(state).dot(along)
    }

    /// Returns, for each body, the wrench of a tensile force (N) along the line, and the part of this wrench that is
    /// due to a damper whose force is `damped` (N).
    #[inline(always)]
    pub(super) fn pull(
        &self,
        along: S::Vector,
        force: S::Real,
        damped: S::Real,
    ) -> [(Wrench<S>, Wrench<S>); 2] {
        both(
            [(self.arms[0], along), (self.arms[1], -along)],
            #[inline(always)]
            |(arm, toward)| {
                let lever = S::moment(arm, toward);
                let by = |size: S::Real| Wrench { force: toward * size, moment: lever * size };
                (by(force), by(damped))
            },
        )
    }
}
