//! A rigid body: mass, surfaces that can be touched, and nodes that touch.

use crate::real::Real;
use crate::shape::Surface;
use crate::space::{Pose, Space, Twist};

/// Index of a body in its model.
pub type BodyId = usize;

/// Who decides how a body moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Motion {
    /// Forces do.
    Free,
    /// The ground does: the body keeps its place and direction relative to it.
    Prescribed,
}

/// A surface at its place on a body.
#[derive(Clone, Debug)]
pub struct Placed<S: Space> {
    /// The surface, in its own frame.
    pub surface: S::Surface,
    /// Origin of the surface's frame (m), in the body frame, from the center of mass.
    pub offset: S::Vector,
    /// How the surface's frame is turned in the body frame.
    pub rotation: S::Rotation,
}

/// A node fixed to a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node<S: Space> {
    /// Position (m) in the body frame, from the center of mass.
    pub position: S::Vector,
    /// Length of boundary (m) that the node stands for.
    pub tributary_length: S::Real,
}

/// The nodes of one piece of boundary.
#[derive(Clone, Debug, PartialEq)]
pub enum Nodes<S: Space> {
    /// Nodes fixed to the body.
    Fixed(Vec<Node<S>>),
    /// The one node of a round boundary that lies deepest in the target: it travels along the
    /// boundary as the body rolls, so rolling is smooth.
    Rolling {
        /// Center of the circle (m) in the body frame, from the center of mass.
        center: S::Vector,
        /// Radius of the circle (m).
        radius: S::Real,
        /// Length of boundary (m) that the node stands for.
        tributary_length: S::Real,
    },
}

/// A rigid body.
#[derive(Clone, Debug)]
pub struct Body<S: Space> {
    /// The name in messages and results; unique in a model.
    pub name: String,
    /// Who decides how it moves.
    pub motion: Motion,
    /// Mass (kg).
    pub mass: S::Real,
    /// Moment of inertia about the center of mass (kg·m²).
    pub inertia: S::Inertia,
    /// Viscous damping matrix (eq. 2.8) acting on the velocity in the inertial frame.
    pub damping: Option<S::Damping>,
    /// Where it starts.
    pub pose: Pose<S>,
    /// How it starts to move.
    pub twist: Twist<S>,
    /// What can be touched.
    pub surfaces: Vec<Placed<S>>,
    /// What touches.
    pub nodes: Vec<Nodes<S>>,
}

impl<S: Space> Body<S> {
    /// Radius (m) of a ball about the center of mass that holds all nodes and bounded surfaces.
    pub fn reach(&self) -> f64 {
        use crate::space::Linear;
        let length = |v: S::Vector| v.dot(v).sqrt().largest_lane();
        let nodes = self.nodes.iter().flat_map(|nodes| match nodes {
            Nodes::Fixed(nodes) => nodes.iter().map(|n| length(n.position)).collect::<Vec<_>>(),
            Nodes::Rolling { center, radius, .. } => {
                vec![length(*center) + radius.largest_lane()]
            }
        });
        let surfaces =
            self.surfaces.iter().map(|placed| length(placed.offset) + placed.surface.reach());
        nodes.chain(surfaces).filter(|r| r.is_finite()).fold(0.0, f64::max)
    }
}
