//! Number of seats of a rack that one contact of the model represents.
//!
//! A plane shows seats that stand one behind the other as one. Where constants are stated per seat, a contact has
//! those of all the seats that it represents, so the same stack is equally stiff, damped and rough in either plane
//! and in space, however `stack.rack.contact` divides its seats.
//!
//! | seat | across the barrels | along them | in space |
//! |---|---|---|---|
//! | a rail across a crown | both rails | each | each |
//! | a support of a cradle | both rails | the pair of a rail, which wedges the barrel | each |
//! | an end of a rail on the ground | both rails | the share of one barrel of both ends | each |
//! | a foot on the ground | both rails; each corner half | as an end of a rail | – |
//! | a post | two; each corner half | the share of one barrel of two; each corner half | – |

use barrelstack_dynamics::math;

use super::longitudinal::has_rows;
use crate::scenario::{Basis, Cradle, Friction, Interface, RackKind, SeatContact, StackPair};
use crate::scenario::{StackSpec, View};

/// Number of rails of a rack, one behind the other across the barrels; also of posts there.
const RAILS: f64 = 2.0;

/// Representation of a stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    /// One of its planes.
    Plane(View),
    /// Space, where every seat is a contact.
    Space,
}

/// Seats that one contact represents, all with the same penetration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bundle {
    /// Number of seats.
    pub(super) count: f64,
    /// Cosine of the angle between the contact normal and the direction in which the seats press.
    pub(super) cosine: f64,
}

impl Bundle {
    /// One seat.
    pub(super) const ONE: Self = Self::of(1.0);

    pub(super) const fn of(count: f64) -> Self {
        Self { count, cosine: 1.0 }
    }

    /// Returns the bundle that a contact of a pair represents; `law` is the one in the scenario.
    pub(super) fn at(pair: StackPair, law: &Interface, spec: &StackSpec, shown: Shown) -> Self {
        let Shown::Plane(view) = shown else { return Self::ONE };
        let rack = &spec.rack;
        if law.basis != Basis::Seat {
            return Self::of(match view {
                View::Transverse => rack.contact.behind_each_other(),
                View::Longitudinal => 1.0,
            });
        }
        // The plane along the barrels shows one slice of those side by side.
        let behind = match view {
            View::Transverse => RAILS,
            View::Longitudinal => RAILS / f64::from(rack.barrels),
        };
        // A flat face bears on its two corners, unless it has a row of nodes.
        let has_row = match view {
            View::Transverse => rack.contact == SeatContact::Nodes,
            View::Longitudinal => has_rows(spec),
        };
        let flat = if has_row { 1.0 } else { 0.5 };
        let on_posts = rack.kind == RackKind::OnRacks;
        Self::of(match (pair, view) {
            (StackPair::BarrelRack, View::Longitudinal) => 1.0,
            // A straight tube lies on its two ends.
            (StackPair::RackGround, View::Transverse) if rack.foot_height > 0.0 && !on_posts => {
                behind * flat
            }
            (StackPair::RackGround, View::Longitudinal) if !on_posts => behind * flat,
            (StackPair::RackRack, _) => 0.5 * behind,
            _ => behind,
        })
    }

    /// Returns the bundle that a contact of a barrel with its cradle represents.
    pub(super) fn of_cradle(law: &Interface, spec: &StackSpec, shown: Shown) -> Self {
        match (shown, spec.rack.cradle) {
            (Shown::Plane(View::Longitudinal), Cradle::Supports { angle })
                if law.basis == Basis::Seat =>
            {
                Self { count: 2.0, cosine: math::sin_cos(angle).1 }
            }
            _ => Self::at(StackPair::BarrelRack, law, spec, shown),
        }
    }

    /// Returns the ratio of the normal stiffness and damping of the bundle to those of one seat.
    pub(super) fn elements(self) -> f64 {
        self.count * self.cosine * self.cosine
    }

    /// Returns the friction of the bundle: a barrel in a wedge presses on it with more than its weight, and the
    /// sticks of all seats act in full.
    pub(super) fn friction(self, friction: Friction) -> Friction {
        if self.cosine == 1.0 {
            return friction;
        }
        let square = self.cosine * self.cosine;
        match friction {
            Friction::None => Friction::None,
            Friction::Coulomb {
                coefficient,
                static_coefficient,
                tangential_stiffness_ratio,
                tangential_damping_ratio,
            } => Friction::Coulomb {
                coefficient: coefficient / self.cosine,
                static_coefficient: static_coefficient / self.cosine,
                tangential_stiffness_ratio: tangential_stiffness_ratio / square,
                tangential_damping_ratio: tangential_damping_ratio / square,
            },
            Friction::Regularized { coefficient, velocity } => {
                Friction::Regularized { coefficient: coefficient / self.cosine, velocity }
            }
        }
    }
}
