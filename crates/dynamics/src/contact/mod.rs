//! What a contact pushes back with: the normal law and the friction law of an interface.

mod friction;
mod normal;
pub mod restitution;

use crate::real::Real;
use crate::space::Space;

pub use friction::{Friction, FrictionLaw, Stick};
pub use normal::{Exponent, NormalForce, NormalLaw, Stop};

/// What the stiffness and damping of an interface are stated for.
///
/// With constants per node, refining the nodes of a boundary stiffens the interface, so the number
/// of nodes is then part of the physics (the paper states its constants this way).
/// With constants per length, each node acts for its tributary length and refinement converges.
/// With constants per seat, the nodes of a row that touch share one set of constants, so that their number changes
/// where a seat presses and not how stiff it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Basis {
    /// Constants of one node (N/m, N·s/m).
    Node,
    /// Constants of one meter of boundary (N/m², N·s/m²).
    Length,
    /// Constants of one seat (N/m, N·s/m): a place where two bodies touch, or a whole row of nodes on one surface.
    ///
    /// A row is as deep as its deepest node, and its force is divided among its nodes in proportion to their depths.
    Seat,
}

impl Basis {
    /// What the constants of a node that stands for a length of boundary (m) are multiplied by; of a row of nodes on
    /// the basis of a seat, what those of the whole row are.
    #[inline(always)]
    pub fn weight<R: Real>(self, tributary_length: R) -> R {
        match self {
            Self::Node | Self::Seat => R::splat(1.0),
            Self::Length => tributary_length,
        }
    }

    /// The word used in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Node => "node",
            Self::Length => "length",
            Self::Seat => "seat",
        }
    }
}

/// Resistance to rolling: a moment against the spin ω of one body relative to the other, the normal force
/// times a lever times `ω / √(ω² + ω₀²)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling<R = f64> {
    /// The lever (m).
    pub lever: R,
    /// `ω₀` (rad/s): the spin at which 71 % of the moment is reached.
    pub spin: R,
}

/// How two kinds of surfaces push on each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Interface<S: Space> {
    /// The name, such as "rack-ground".
    pub name: String,
    /// Penetration and its rate to compressive force.
    pub normal: NormalLaw<S::Real>,
    /// What the surfaces meet beyond the stroke of that law; none where it has no end.
    pub stop: Option<Stop<S::Real>>,
    /// How the normal force resists rolling; none where it does not.
    pub rolling: Option<Rolling<S::Real>>,
    /// Slip to friction force.
    pub friction: FrictionLaw<S::Real>,
    /// What the constants are stated for.
    pub basis: Basis,
}

impl<S: Space> Interface<S> {
    /// The stiffness (N/m) at a penetration (m), along the normal or of the stick, whichever is more.
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
