//! Contact laws: the normal law and the friction law of an interface.

mod friction;
mod normal;
pub mod restitution;

use crate::real::Real;
use crate::space::Space;

pub use friction::{Friction, FrictionLaw, Stick};
pub use normal::{Exponent, NormalForce, NormalLaw, Stop};

/// Basis of the stiffness and damping constants of an interface: per node, per length or per seat.
///
/// With constants per node, a boundary with more nodes makes the interface stiffer, so the number of nodes is part of
/// the physics. Candia, de la Llera and Almazán (2008) state constants per node. With constants per length, each node
/// acts for its tributary length, so results converge as the number of nodes grows. With constants per seat, a row of
/// touching nodes has one set of constants. So the number of nodes affects where the force acts, but not the stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Basis {
    /// Constants per node (N/m, N·s/m).
    Node,
    /// Constants per meter of boundary (N/m², N·s/m²).
    Length,
    /// Constants per seat (N/m, N·s/m). A seat is a place where two bodies touch. A row of nodes that touch the same
    /// surface is one seat.
    ///
    /// The depth of a row is the depth of its deepest node. The force of the row is divided among its nodes in
    /// proportion to their depths.
    Seat,
}

impl Basis {
    /// Returns the factor by which the constants of the contact laws are multiplied: the tributary length (m) for
    /// constants per length, and 1 for constants per node or per seat.
    #[inline(always)]
    pub fn weight<R: Real>(self, tributary_length: R) -> R {
        match self {
            Self::Node | Self::Seat => R::splat(1.0),
            Self::Length => tributary_length,
        }
    }

    /// Returns the name of the basis in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Node => "node",
            Self::Length => "length",
            Self::Seat => "seat",
        }
    }
}

/// Rolling resistance: a moment that opposes the relative spin ω of two bodies.
///
/// The moment is the product of the normal force, a lever arm (m) and `ω / √(ω² + ω₀²)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling<R = f64> {
    /// Lever arm (m).
    pub lever: R,
    /// Relative spin `ω₀` (rad/s) at which the moment reaches 71 % (1/√2) of its limit, the product of normal force and
    /// lever arm.
    pub spin: R,
}

/// Contact laws between two kinds of surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface<S: Space> {
    /// Name, such as "rack-ground".
    pub name: String,
    /// Normal law: compressive force from penetration and its rate.
    pub normal: NormalLaw<S::Real>,
    /// Additional contact law that acts beyond the stroke of the normal law; `None` for an unlimited stroke.
    pub stop: Option<Stop<S::Real>>,
    /// Rolling resistance, if any.
    pub rolling: Option<Rolling<S::Real>>,
    /// Friction law: friction force from slip.
    pub friction: FrictionLaw<S::Real>,
    /// Basis of the stiffness and damping constants of the contact laws.
    pub basis: Basis,
}

impl<S: Space> Interface<S> {
    /// Returns the stiffness (N/m) at a penetration (m): the larger of the normal and the tangential stiffness.
    #[inline(always)]
    pub fn stiffness(&self, depth: S::Real) -> S::Real {
        let mut normal = self.normal.tangent_stiffness(depth);
        if let Some(stop) = self.stop {
            let beyond = depth - stop.depth;
            let reached = S::Real::zero().lt(beyond);
            let hard = stop.law.tangent_stiffness(beyond);
            normal += S::Real::select(reached, hard, S::Real::zero());
        }
        normal.max(self.friction.stick_stiffness())
    }
}
