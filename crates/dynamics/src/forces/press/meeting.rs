//! Two bodies at their contact: where and how fast their nodes touch.

use crate::contact_elements::ContactElements;
use crate::forces::Contact;
use crate::pair_frame::PairFrame;
use crate::real::Real;
use crate::shape::Gap;
use crate::space::{Linear, Space, Twist, Wrench};

/// Two bodies at their contact, seen from the target's surface.
#[derive(Clone, Copy)]
pub(super) struct Meeting<'a, S: Space> {
    frame: &'a PairFrame<S>,
    /// Center of mass of the contactor from that of the target (m).
    apart: S::Vector,
    /// Velocity (m/s), at the contactor's center of mass, of the contactor relative to the target.
    linear: S::Vector,
    /// Spin (rad/s) of the contactor relative to the target.
    pub(super) spin: S::Spin,
}

impl<'a, S: Space> Meeting<'a, S> {
    #[inline(always)]
    pub(super) fn new(frame: &'a PairFrame<S>, contactor: Twist<S>, target: Twist<S>) -> Self {
        let apart = frame.contactor - frame.target;
        let target_spin = S::unrotate_spin(frame.rotation, target.angular);
        Self {
            frame,
            apart,
            linear: S::unrotate(frame.rotation, contactor.linear - target.linear)
                - S::velocity_at(target_spin, apart),
            spin: S::unrotate_spin(frame.rotation, contactor.angular) - target_spin,
        }
    }

    /// Velocity (m/s) of the contactor relative to the target at a point (m), in the surface's frame.
    #[inline(always)]
    pub(super) fn velocity(&self, point: S::Vector) -> S::Vector {
        self.linear + S::velocity_at(self.spin, point - self.frame.contactor)
    }

    /// Where and how fast a node at `node` (m, in the surface's frame) touches; no forces yet.
    ///
    /// Both bodies feel the force at the companion point, and both velocities are taken there:
    /// so the pair conserves momentum, and force times relative velocity is the power it loses.
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

    /// What a wrench of the contactor's contacts does to contactor and target, in the inertial frame.
    #[inline(always)]
    pub(super) fn on_bodies(&self, wrench: Wrench<S>) -> (Wrench<S>, Wrench<S>) {
        let rotation = self.frame.rotation;
        let force = S::rotate(rotation, wrench.force);
        let about_target = wrench.moment + S::moment(self.apart, wrench.force);
        (
            Wrench { force, moment: S::rotate_spin(rotation, wrench.moment) },
            Wrench { force: -force, moment: -S::rotate_spin(rotation, about_target) },
        )
    }
}
