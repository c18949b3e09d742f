//! Number of seats of a rack that one contact of the model represents.
//!
//! Seats that stand one behind the other coincide in a planar model. Where constants are stated per seat, a contact has
//! the combined stiffness and damping of all seats that it represents. A stack thus has the same stiffness, damping and
//! friction in either planar model and in the three-dimensional model, for every value of `stack.rack.contact`.
//!
//! | seat | a contact across the barrels | a contact along the barrels | a contact in three dimensions |
//! |---|---|---|---|
//! | a rail on the crown of a barrel | both rails | one rail | one rail |
//! | a support of a cradle | both rails | both supports on a rail, which wedge the barrel | one support |
//! | an end of a rail on the ground | both rails | both ends, divided by the number of barrels side by side | one end |
//! | a foot on the ground | both rails, half at each corner | like an end of a rail | – |
//! | a post | two posts, half at each corner | the same, divided by the number of barrels side by side | – |

use barrelstack_dynamics::math;

use super::longitudinal::has_rows;
use crate::scenario::{Basis, Cradle, Friction, Interface, RackKind, SeatContact, StackPair};
use crate::scenario::{StackSpec, View};

/// Number of rails of a rack that coincide in the planar model across the barrels. The posts of the rack also coincide
/// in pairs.
const RAILS: f64 = 2.0;

/// The kind of model that represents a stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    /// A model in the plane across or along the barrels.
    Plane(View),
    /// A three-dimensional model, in which every seat is a separate contact.
    Space,
}

/// The seats that one contact represents, all with the same penetration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bundle {
    /// Number of seats.
    pub(super) count: f64,
    /// Cosine of the angle between the contact normal and the direction of the forces on the seats.
    pub(super) cosine: f64,
}

impl Bundle {
    /// One seat.
    pub(super) const ONE: Self = Self::of(1.0);

    pub(super) const fn of(count: f64) -> Self {
        Self { count, cosine: 1.0 }
    }

    /// Returns the seats that one contact between the two kinds of bodies of `pair` represents. `law` is the contact
    /// law as stated in the scenario.
    pub(super) fn at(pair: StackPair, law: &Interface, spec: &StackSpec, shown: Shown) -> Self {
        let Shown::Plane(view) = shown else { return Self::ONE };
        let rack = &spec.rack;
        if law.basis != Basis::Seat {
            return Self::of(match view {
                View::Transverse => rack.contact.behind_each_other(),
                View::Longitudinal => 1.0,
            });
        }
        // The planar model along the barrels is a slice one barrel wide.
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
            // A foot is one seat with two corners; a straight tube has one seat at each of its ends.
            (StackPair::RackGround, View::Transverse) if rack.foot_height > 0.0 && !on_posts => {
                behind * flat
            }
            (StackPair::RackGround, View::Longitudinal) if !on_posts => behind * flat,
            (StackPair::RackRack, _) => 0.5 * behind,
            _ => behind,
        })
    }

    /// Returns the seats that a contact of a barrel with its cradle represents.
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

    /// Returns the friction law of the bundle.
    ///
    /// The normal forces of seats that form a wedge add up to the load on the wedge divided by `cosine`. The friction
    /// coefficient is therefore divided by `cosine`. The tangential stiffness and damping are the sums over all seats.
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
