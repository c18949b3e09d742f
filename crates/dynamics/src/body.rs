//! A rigid body: mass, surfaces that can be touched, and nodes that touch.

use crate::real::Real;
use crate::shape::{HalfPlane, Shape, Surface, Whole};
use crate::space::{Planar, Pose, Rotation2, Space, Twist, Vec2};

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
#[derive(Clone, Debug, PartialEq)]
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
    /// Unit normal of the boundary there out of the body, in the body frame, at a corner the mean of both
    /// sides; none where every direction counts.
    pub outward: Option<S::Vector>,
}

/// A round piece of a convex boundary: a corner, sharp or rounded, or an arc.
///
/// It touches a target with the one point of it that lies deepest, in the direction of the nearest
/// point of the target, so contact is exact wherever it happens. A convex boundary is a chain of
/// straight sides and round pieces, and two of them touch where a round piece of one meets a side or
/// a round piece of the other: every contact belongs to one round piece, and is counted once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Round<S: Space> {
    /// Center (m) in the body frame, from the center of mass.
    pub center: S::Vector,
    /// Radius (m); zero for a sharp corner.
    pub radius: S::Real,
    /// Unit vectors in the body frame that bound its outward normals: those `d` with `d · limit ≤ 0`
    /// for both. Zero vectors bound nothing.
    pub limits: [S::Vector; 2],
    /// The same limits where the boundary goes on with an arc, none where it goes on straight.
    /// Past a straight end a corner still bears against a side: two corners of a block carry it on a
    /// floor, whichever is deeper.
    pub arc_limits: [Option<S::Vector>; 2],
    /// Whether normals on the very limit of an arc belong to this piece and not to its neighbor.
    pub takes_limit: bool,
    /// The straight sides beyond the ends of an arc, as unit normal and distance (m) from the center of
    /// mass: a corner that is nearer to them is theirs to bear.
    pub sides: [Option<(S::Vector, S::Real)>; 2],
    /// Penetration (m) from which on the nearest point lies behind the body and no contact is meant:
    /// an arc's center may lie far beyond the body whose boundary it is.
    pub greatest_depth: S::Real,
    /// Length of boundary (m) that a contact of it stands for.
    pub tributary_length: S::Real,
}

/// A flat piece of boundary that carries nodes, as a plane in the body frame.
///
/// Where nodes and the exact test would both see a contact, the plane decides: against a round body
/// whose center lies before it the nodes count, against one behind it the exact test. Against a body that is
/// not round, whose edges may reach beside the face, the direction of a contact decides as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face<S: Space> {
    /// A point of it (m), from the center of mass.
    pub point: S::Vector,
    /// Unit normal out of the body.
    pub outward: S::Vector,
    /// Cosine of the angle from `outward` up to which a contact's normal out of the body is one of the face;
    /// below -1 where every direction is.
    pub widest: S::Real,
}

/// What of a boundary touches others.
#[derive(Clone, Debug, PartialEq)]
pub enum Nodes<S: Space> {
    /// Nodes fixed to the body, as in the paper.
    Fixed(Vec<Node<S>>),
    /// The round pieces of a convex boundary.
    Rounds(Vec<Round<S>>),
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
    /// A convex body of space, of which the deepest points touch.
    Whole(S::Whole),
}

impl<S: Space> Nodes<S> {
    /// How many nodes there are.
    pub fn count(&self) -> usize {
        match self {
            Self::Fixed(nodes) => nodes.len(),
            Self::Rounds(rounds) => rounds.len(),
            Self::Rolling { .. } => 1,
            Self::Whole(whole) => whole.most_sticks(),
        }
    }
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
    /// Flat pieces that carry nodes where others are tested exactly.
    pub faces: Vec<Face<S>>,
}

/// What of a body every step asks for, without its boundaries: thousands of them stay in the cache.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inert<S: Space> {
    pub(crate) motion: Motion,
    /// Whether viscous damping acts on it.
    pub(crate) damped: bool,
    pub(crate) mass: S::Real,
    pub(crate) inertia: S::Inertia,
}

impl<S: Space> Inert<S> {
    pub(crate) fn of(body: &Body<S>) -> Self {
        let Body { motion, mass, inertia, .. } = *body;
        Self { motion, damped: body.damping.is_some(), mass, inertia }
    }
}

impl Body<Planar> {
    /// The ground: a half-plane below its origin, turned by an angle (rad).
    pub fn ground(orientation: f64) -> Self {
        let floor = Placed {
            surface: Shape::HalfPlane(HalfPlane),
            offset: Vec2::default(),
            rotation: Rotation2::identity(),
        };
        let pose = Pose { position: Vec2::default(), orientation };
        // No force moves it, so its mass is of no account.
        let body = Self::free("ground", 1.0, 1.0, pose);
        Self { motion: Motion::Prescribed, surfaces: vec![floor], ..body }
    }
}

impl<S: Space> Body<S> {
    /// A free body at rest, without boundaries, of a mass (kg) and a moment of inertia (kg·m²).
    pub fn free(
        name: impl Into<String>,
        mass: S::Real,
        inertia: S::Inertia,
        pose: Pose<S>,
    ) -> Self {
        Self {
            name: name.into(),
            motion: Motion::Free,
            mass,
            inertia,
            damping: None,
            pose,
            twist: Twist::default(),
            surfaces: Vec::new(),
            nodes: Vec::new(),
            faces: Vec::new(),
        }
    }

    /// Whether it carries a surface that has no end.
    pub fn is_unbounded(&self) -> bool {
        self.surfaces.iter().any(|placed| placed.surface.reach().is_infinite())
    }

    /// Radius (m) of a ball about the center of mass that holds all nodes and bounded surfaces.
    pub fn reach(&self) -> f64 {
        use crate::space::Linear;
        let length = |v: S::Vector| v.dot(v).sqrt().largest_lane();
        let nodes = self.nodes.iter().flat_map(|nodes| match nodes {
            Nodes::Fixed(nodes) => nodes.iter().map(|n| length(n.position)).collect::<Vec<_>>(),
            // An arc may reach far past the body; the body's surface is what bounds it.
            Nodes::Rounds(_) => Vec::new(),
            Nodes::Rolling { center, radius, .. } => {
                vec![length(*center) + radius.largest_lane()]
            }
            Nodes::Whole(whole) => {
                let (center, radius) = whole.ball();
                vec![length(center) + radius.largest_lane()]
            }
        });
        let surfaces =
            self.surfaces.iter().map(|placed| length(placed.offset) + placed.surface.reach());
        nodes.chain(surfaces).filter(|r| r.is_finite()).fold(0.0, f64::max)
    }
}
