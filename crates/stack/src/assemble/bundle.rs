//! How many seats of a rack one contact of the model stands for.
//!
//! A plane shows in one place what stands one behind the other. Where constants are stated per seat, a contact there
//! has those of all the seats that it stands for, so the same stack is as stiff, as damped and as rough in either plane
//! and in space, whatever `stack.rack.contact` divides its seats into.
//!
//! | seat | across the barrels | along them | in space |
//! |---|---|---|---|
//! | a rail across a crown | both rails | each | each |
//! | a support of a cradle | both rails | the pair of a rail, which wedges the barrel | each |
//! | an end of a rail on the ground | both rails | the share of one barrel of both ends | each |
//! | a foot on the ground | both rails; each corner half | as an end of a rail | – |
//! | a post | two; each corner half | the share of one barrel of two; each corner half | – |

use barrelstack_dynamics::math;

use crate::scenario::{Basis, Cradle, Friction, Interface, RackKind, SeatContact, StackPair};
use crate::scenario::{StackSpec, View};

/// Rails of a rack, one behind the other across the barrels; as many as it has posts there.
const RAILS: f64 = 2.0;

/// What shows a stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    /// One of its planes.
    Plane(View),
    /// Space, where every seat is a contact.
    Space,
}

/// Seats that one contact stands for, all pressed by one penetration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bundle {
    /// How many.
    pub(super) count: f64,
    /// Cosine of the angle from the contact's normal at which they press.
    pub(super) cosine: f64,
}

impl Bundle {
    /// One seat.
    pub(super) const ONE: Self = Self::of(1.0);

    pub(super) const fn of(count: f64) -> Self {
        Self { count, cosine: 1.0 }
    }

    /// What a contact of a pair stands for; `law` is the one that the scenario states.
    pub(super) fn at(pair: StackPair, law: &Interface, spec: &StackSpec, shown: Shown) -> Self {
        let Shown::Plane(view) = shown else { return Self::ONE };
        let rack = &spec.rack;
        if law.basis != Basis::Seat {
            return Self::of(match view {
                View::Transverse => rack.contact.behind_each_other(),
                View::Longitudinal => 1.0,
            });
        }
        // Along the barrels the plane shows the share of one of those side by side.
        let behind = match view {
            View::Transverse => RAILS,
            View::Longitudinal => RAILS / f64::from(rack.barrels),
        };
        // Two corners bear what is flat, unless a row of nodes does.
        let flat = if rack.contact == SeatContact::Nodes { 1.0 } else { 0.5 };
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

    /// What a contact of a barrel with its cradle stands for.
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

    /// Normal stiffness and damping of the bundle over those of a seat.
    pub(super) fn elements(self) -> f64 {
        self.count * self.cosine * self.cosine
    }

    /// The friction of the bundle: a barrel that lies in a wedge presses on it by more than its weight, and the sticks
    /// of all seats act in full.
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
