//! Relative kinematics of two bodies at their contact.

use crate::contact_elements::ContactElements;
use crate::forces::Contact;
use crate::model::{ContactPair, Model};
use crate::pair_frame::PairFrame;
use crate::real::Real;
use crate::shape::Gap;
use crate::space::{Linear, Space, Wrench};
use crate::state::State;

/// Relative kinematics of the two bodies of a contact pair, in the frame of the target's surface.
#[derive(Clone, Debug)]
pub(crate) struct PairKinematics<S: Space> {
    of: Between,
    pub(super) frame: PairFrame<S>,
    motion: Motion<S>,
}

/// The bodies of a contact pair.
///
/// The indices are stored in a struct, because the fields of a struct are compared one by one. The comparison of two
/// arrays would wait until all preceding stores have reached the cache, which takes as long as hundreds of operations.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Between {
    contactor: usize,
    target: usize,
    /// Index of the target's surface.
    surface: usize,
}

impl Between {
    fn of(pair: &ContactPair) -> Self {
        Self { contactor: pair.contactor, target: pair.target, surface: pair.surface }
    }
}

/// Relative motion of two bodies.
#[derive(Clone, Copy, Debug)]
struct Motion<S: Space> {
    /// Vector (m) from the center of mass of the target to the center of mass of the contactor.
    apart: S::Vector,
    /// Velocity (m/s) of the contactor relative to the target, at the center of mass of the contactor.
    linear: S::Vector,
    /// Spin (rad/s) of the contactor relative to the target.
    spin: S::Spin,
    /// Spin (rad/s) of the target.
    target_spin: S::Spin,
}

impl<S: Space> PairKinematics<S> {
    /// Computes the relative motion of the bodies of a pair in its frame.
    #[inline(always)]
    pub(super) fn new(frame: PairFrame<S>, pair: &ContactPair, state: &State<S>) -> Self {
        let (contactor, target) = (state.twists[pair.contactor], state.twists[pair.target]);
        let apart = frame.contactor - frame.target;
        let target_spin = S::unrotate_spin(frame.rotation, target.angular);
        let motion = Motion {
            apart,
            linear: S::unrotate(frame.rotation, contactor.linear - target.linear)
                - S::velocity_at(target_spin, apart),
            spin: S::unrotate_spin(frame.rotation, contactor.angular) - target_spin,
            target_spin,
        };
        Self { of: Between::of(pair), frame, motion }
    }

    /// Returns the kinematics of a pair; reuses the kinematics of the previous pair if that pair has the same bodies
    /// and the same surface.
    #[inline(always)]
    pub(super) fn shared<'a>(
        last: &'a mut Option<Self>,
        model: &Model<S>,
        pair: &ContactPair,
        state: &State<S>,
        rotations: &[S::Rotation],
    ) -> &'a Self {
        let of = Between::of(pair);
        if last.as_ref().is_some_and(|known| known.of != of) {
            *last = None;
        }
        match last {
            Some(known) => known,
            none => {
                let frame = PairFrame::new(model, pair, &state.poses, rotations);
                none.insert(Self::new(frame, pair, state))
            }
        }
    }
}

/// Relative pose and relative motion of two bodies, in the frame of the target's surface.
#[derive(Clone, Copy)]
pub(super) struct Meeting<'a, S: Space> {
    frame: &'a PairFrame<S>,
    motion: Motion<S>,
}

impl<'a, S: Space> Meeting<'a, S> {
    #[inline(always)]
    pub(super) fn of(kinematics: &'a PairKinematics<S>) -> Self {
        Self { frame: &kinematics.frame, motion: kinematics.motion }
    }

    /// Returns the spin (rad/s) of the contactor relative to the target.
    #[inline(always)]
    pub(super) fn spin(&self) -> S::Spin {
        self.motion.spin
    }

    /// Returns the spin (rad/s) of the target, and the spin of the contactor relative to the target.
    #[inline(always)]
    pub(super) fn spins(&self) -> [S::Spin; 2] {
        [self.motion.target_spin, self.motion.spin]
    }

    /// Returns the velocity (m/s) of the contactor relative to the target at a point (m), in the surface's frame.
    #[inline(always)]
    pub(super) fn velocity(&self, point: S::Vector) -> S::Vector {
        self.motion.linear + S::velocity_at(self.motion.spin, point - self.frame.contactor)
    }

    /// Returns the contact of a node at `node` (m, in the surface's frame), with its kinematics; its forces are still
    /// zero.
    ///
    /// The force acts on both bodies at the companion point of `node`, and the velocities of both bodies are taken at
    /// this point. So the contact conserves momentum, and the power lost in the contact is the product of the force and
    /// the relative velocity.
    #[inline(always)]
    pub(super) fn contact(
        &self,
        pair: usize,
        elements: &ContactElements<S>,
        element: usize,
        node: S::Vector,
        gap: Gap<S>,
    ) -> Contact<S> {
        let zero = S::Real::zero();
        let touching = gap.distance.lt(zero);
        let point = node - gap.normal * gap.distance;
        let velocity = self.velocity(point);
        let counted = S::Real::select(touching, S::Real::splat(1.0), zero);
        Contact {
            element,
            pair,
            node: elements.nodes[element],
            touching,
            point,
            normal: gap.normal,
            penetration: S::Real::select(touching, -gap.distance, zero),
            penetration_rate: -velocity.dot(gap.normal),
            normal_force: zero,
            slip_rate: S::tangential(velocity, gap.normal) * counted,
            friction_force: S::Tangent::default(),
        }
    }

    /// Converts the wrench of all contacts on the contactor to the wrenches on the contactor and the target, in the
    /// inertial frame.
    #[inline(always)]
    pub(super) fn on_bodies(&self, wrench: Wrench<S>) -> (Wrench<S>, Wrench<S>) {
        let rotation = self.frame.rotation;
        let force = S::rotate(rotation, wrench.force);
        let about_target = wrench.moment + S::moment(self.motion.apart, wrench.force);
        (
            Wrench { force, moment: S::rotate_spin(rotation, wrench.moment) },
            Wrench { force: -force, moment: -S::rotate_spin(rotation, about_target) },
        )
    }
}
