//! Rigid bodies: mass, target surfaces, and contact nodes.

use crate::real::Real;
use crate::shape::{HalfPlane, Shape, Surface, Whole};
use crate::space::{Planar, Pose, Rotation2, Space, Twist, Vec2};

/// Index of a body in its model.
pub type BodyId = usize;

/// Source of the motion of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Motion {
    /// The body moves under forces.
    Free,
    /// The body moves with the ground: it keeps its position and orientation relative to it.
    Prescribed,
}

/// A surface positioned on a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed<S: Space> {
    /// The surface, in its own frame.
    pub surface: S::Surface,
    /// Origin of the surface's frame (m), in the body frame, from the center of mass.
    pub offset: S::Vector,
    /// Rotation of the surface's frame in the body frame.
    pub rotation: S::Rotation,
}

/// A node fixed to a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node<S: Space> {
    /// Position (m) in the body frame, from the center of mass.
    pub position: S::Vector,
    /// Tributary length of boundary (m).
    pub tributary_length: S::Real,
    /// Outward unit normal of the boundary there, in the body frame, at a corner the mean of both sides; `None` if
    /// contact is possible from every direction.
    pub outward: Option<S::Vector>,
}

/// A round piece of a convex boundary: a corner, sharp or rounded, or an arc.
///
/// It touches a target with its deepest point, in the direction of the nearest point of the target, so contact is
/// exact wherever it occurs. A convex boundary is a chain of straight sides and round pieces, and two of them touch
/// where a round piece of one meets a side or a round piece of the other: every contact belongs to one round piece,
/// and is counted once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Round<S: Space> {
    /// Center (m) in the body frame, from the center of mass.
    pub center: S::Vector,
    /// Radius (m); zero for a sharp corner.
    pub radius: S::Real,
    /// Unit vectors in the body frame that bound its outward normals `d`: `d · limit ≤ 0` for both. A zero vector is
    /// no bound.
    pub limits: [S::Vector; 2],
    /// The same limits where an arc adjoins; `None` where the boundary continues straight. Past a straight end a
    /// corner still bears against a side: two corners of a block carry it on a floor, whichever is deeper.
    pub arc_limits: [Option<S::Vector>; 2],
    /// `true` if normals exactly at the limit of an arc belong to this piece and not to its neighbor.
    pub takes_limit: bool,
    /// The straight sides adjoining the ends of an arc, as unit normal and distance (m) from the center of mass: a
    /// corner that is nearer to such a side is in contact with the side.
    pub sides: [Option<(S::Vector, S::Real)>; 2],
    /// Penetration (m) beyond which the nearest point lies behind the body and there is no contact: the center of an
    /// arc may lie far beyond its body.
    pub greatest_depth: S::Real,
    /// Tributary length of boundary (m) of its contact.
    pub tributary_length: S::Real,
}

/// A flat piece of boundary that carries nodes, as a plane in the body frame.
///
/// Where nodes and the exact test would both find a contact, the plane decides: a round body whose center is in front
/// of it is handled by the nodes, one whose center is behind it by the exact test. For a body that is not round, whose
/// edges may extend past the face, the direction of the contact decides as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face<S: Space> {
    /// A point of the face (m), from the center of mass.
    pub point: S::Vector,
    /// Unit normal out of the body.
    pub outward: S::Vector,
    /// Cosine of the angle from `outward` up to which a contact's outward normal belongs to the face; below -1 if
    /// every direction does.
    pub widest: S::Real,
}

/// Contact points of a boundary.
#[derive(Clone, Debug, PartialEq)]
pub enum Nodes<S: Space> {
    /// Nodes fixed to the body, as in the paper.
    Fixed(Vec<Node<S>>),
    /// The round pieces of a convex boundary.
    Rounds(Vec<Round<S>>),
    /// The deepest node of a round boundary in the target: it moves along the boundary as the body rolls, so rolling
    /// is smooth.
    Rolling {
        /// Center of the circle (m) in the body frame, from the center of mass.
        center: S::Vector,
        /// Radius of the circle (m).
        radius: S::Real,
        /// Tributary length of boundary (m) of the node.
        tributary_length: S::Real,
    },
    /// A convex body of space, which touches with its deepest points.
    Whole(S::Whole),
}

impl<S: Space> Nodes<S> {
    /// Returns the number of nodes.
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
    /// Name in messages and results; unique in a model.
    pub name: String,
    /// Source of its motion.
    pub motion: Motion,
    /// Mass (kg).
    pub mass: S::Real,
    /// Moment of inertia about the center of mass (kg·m²).
    pub inertia: S::Inertia,
    /// Viscous damping matrix (eq. 2.8) acting on the velocity in the inertial frame.
    pub damping: Option<S::Damping>,
    /// Initial pose.
    pub pose: Pose<S>,
    /// Initial twist.
    pub twist: Twist<S>,
    /// Target surfaces.
    pub surfaces: Vec<Placed<S>>,
    /// Contact nodes.
    pub nodes: Vec<Nodes<S>>,
    /// Flat pieces that carry nodes where others are tested exactly.
    pub faces: Vec<Face<S>>,
}

/// Body data that every step reads, without boundaries: those of thousands of bodies stay in the cache.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inert<S: Space> {
    pub(crate) motion: Motion,
    /// `true` if the body has viscous damping.
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
    /// Returns the ground: a half-plane below its origin, turned by an angle (rad).
    pub fn ground(orientation: f64) -> Self {
        let floor = Placed {
            surface: Shape::HalfPlane(HalfPlane),
            offset: Vec2::default(),
            rotation: Rotation2::identity(),
        };
        let pose = Pose { position: Vec2::default(), orientation };
        // No force moves it, so its mass is irrelevant.
        let body = Self::free("ground", 1.0, 1.0, pose);
        Self { motion: Motion::Prescribed, surfaces: vec![floor], ..body }
    }
}

impl<S: Space> Body<S> {
    /// Returns a free body at rest, without boundaries, of a mass (kg) and a moment of inertia (kg·m²).
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

    /// Returns `true` if it has an unbounded surface.
    pub fn is_unbounded(&self) -> bool {
        self.surfaces.iter().any(|placed| placed.surface.reach().is_infinite())
    }

    /// Returns the radius (m) of a ball about the center of mass that encloses all nodes and bounded surfaces.
    pub fn reach(&self) -> f64 {
        use crate::space::Linear;
        let length = |v: S::Vector| v.dot(v).sqrt().largest_lane();
        let nodes = self.nodes.iter().flat_map(|nodes| match nodes {
            Nodes::Fixed(nodes) => nodes.iter().map(|n| length(n.position)).collect::<Vec<_>>(),
            // An arc may reach far beyond the body; its surface is the bound.
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
