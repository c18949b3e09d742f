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
    /// The body moves with the ground: its position and orientation relative to the ground are constant.
    Prescribed,
}

/// A surface positioned on a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed<S: Space> {
    /// The surface, in its own frame.
    pub surface: S::Surface,
    /// Position (m) of the origin of the surface's frame in the body frame, relative to the center of mass.
    pub offset: S::Vector,
    /// Rotation from the surface's frame to the body frame.
    pub rotation: S::Rotation,
}

/// A node fixed to a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node<S: Space> {
    /// Position (m) in the body frame, relative to the center of mass.
    pub position: S::Vector,
    /// Length of boundary (m) that the node represents (its tributary length).
    pub tributary_length: S::Real,
    /// Outward unit normal of the boundary at the node, in the body frame; at a corner, the mean of the normals of both
    /// sides. `None` if contact is possible from every direction.
    pub outward: Option<S::Vector>,
}

/// A round piece of a convex boundary: a corner, sharp or rounded, or an arc.
///
/// A round piece touches a target with its deepest point, so contact is exact wherever it occurs. A convex boundary is
/// a chain of straight sides and round pieces. Two such boundaries touch where a round piece of one meets a side or a
/// round piece of the other, so every contact belongs to one round piece and is counted once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Round<S: Space> {
    /// Position (m) of the center in the body frame, relative to the center of mass.
    pub center: S::Vector,
    /// Radius (m); zero for a sharp corner.
    pub radius: S::Real,
    /// Unit vectors, in the body frame, that limit the range of the outward normals `d` of the piece: `d · limit ≤ 0`
    /// for both. A zero vector sets no bound.
    pub limits: [S::Vector; 2],
    /// The entries of `limits` at which the piece is adjacent to an arc; `None` where it is adjacent to a straight
    /// side. At a straight side, the piece bears on another body even if its deepest point lies beyond the limit: both
    /// lower corners of a block on a floor carry the block, whichever corner is deeper.
    pub arc_limits: [Option<S::Vector>; 2],
    /// `true` if normals exactly at the limit of an arc belong to this piece and not to its neighbor.
    pub takes_limit: bool,
    /// The straight sides adjacent to the ends of an arc, each given by its unit normal and its distance (m) from the
    /// center of mass; `None` for other pieces. A corner of another body that is nearer to such a side than to the arc
    /// touches the side.
    pub sides: [Option<(S::Vector, S::Real)>; 2],
    /// Penetration (m) beyond which there is no contact. The center of an arc may lie far outside its body, so a
    /// surface behind the body may seem to penetrate the arc deeply.
    pub greatest_depth: S::Real,
    /// Length of boundary (m) that a contact of the piece represents.
    pub tributary_length: S::Real,
}

/// A flat piece of boundary with nodes, stored as a plane in the frame of its body.
///
/// A contact at the face may be found twice: by testing the nodes of the face, and by testing the exact boundary
/// ([`Round`]). Only one of the two contacts counts:
///
/// - If the center of mass of the other body is behind the plane, the exact contact counts.
/// - If it is in front of the plane, the contact of the nodes counts, provided that its outward normal is within the
///   angle from `outward` that [`Face::widest`] permits. Otherwise the exact contact counts.
///
/// A face that carries a round body permits every direction. A face that carries other bodies, whose edges may extend
/// past the face, limits the angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face<S: Space> {
    /// A point of the face (m), relative to the center of mass.
    pub point: S::Vector,
    /// Unit normal out of the body.
    pub outward: S::Vector,
    /// Cosine of the largest angle between `outward` and the outward normal of a contact that belongs to the face;
    /// below -1 if contacts in every direction belong to the face.
    pub widest: S::Real,
}

/// A set of contact points on the boundary of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum Nodes<S: Space> {
    /// Nodes fixed to the body, as in Candia, de la Llera and Almazán (2008).
    Fixed(Vec<Node<S>>),
    /// The round pieces of a convex boundary.
    Rounds(Vec<Round<S>>),
    /// A single node at the point of a round boundary that is deepest in the target. The node moves along the boundary
    /// as the body rolls, so rolling is smooth.
    Rolling {
        /// Center of the circle (m) in the body frame, relative to the center of mass.
        center: S::Vector,
        /// Radius of the circle (m).
        radius: S::Real,
        /// Length of boundary (m) that the node represents (its tributary length).
        tributary_length: S::Real,
    },
    /// A convex solid of a three-dimensional model; its contacts are at its deepest points.
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
    /// Source of the motion: forces or the ground.
    pub motion: Motion,
    /// Mass (kg).
    pub mass: S::Real,
    /// Moment of inertia about the center of mass (kg·m²).
    pub inertia: S::Inertia,
    /// Viscous damping matrix (Candia et al. 2008, eq. 2.8), which multiplies the velocity in the inertial frame;
    /// `None` if the body has no viscous damping.
    pub damping: Option<S::Damping>,
    /// Initial pose.
    pub pose: Pose<S>,
    /// Initial twist.
    pub twist: Twist<S>,
    /// Target surfaces.
    pub surfaces: Vec<Placed<S>>,
    /// Sets of contact nodes.
    pub nodes: Vec<Nodes<S>>,
    /// Flat pieces of boundary that carry nodes; see [`Face`].
    pub faces: Vec<Face<S>>,
}

/// Body data that every step reads, stored apart from the boundaries so that the data of thousands of bodies stays in
/// the cache.
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
    /// Creates the ground: a half-plane whose surface passes through the origin at an inclination (rad).
    pub fn ground(orientation: f64) -> Self {
        let floor = Placed {
            surface: Shape::HalfPlane(HalfPlane),
            offset: Vec2::default(),
            rotation: Rotation2::identity(),
        };
        let pose = Pose { position: Vec2::default(), orientation };
        // The ground moves as prescribed, so its mass is irrelevant.
        let body = Self::free("ground", 1.0, 1.0, pose);
        Self { motion: Motion::Prescribed, surfaces: vec![floor], ..body }
    }
}

impl<S: Space> Body<S> {
    /// Creates a free body at rest, without boundaries, from its mass (kg) and its moment of inertia (kg·m²).
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

    /// Returns `true` if the body has an unbounded surface.
    pub fn is_unbounded(&self) -> bool {
        self.surfaces.iter().any(|placed| placed.surface.reach().is_infinite())
    }

    /// Returns the radius (m) of a ball about the center of mass that encloses all nodes and bounded surfaces.
    pub fn reach(&self) -> f64 {
        use crate::space::Linear;
        let length = |v: S::Vector| v.dot(v).sqrt().largest_lane();
        let nodes = self.nodes.iter().flat_map(|nodes| match nodes {
            Nodes::Fixed(nodes) => nodes.iter().map(|n| length(n.position)).collect::<Vec<_>>(),
            // The circle of an arc may extend far beyond the body, so the surface gives the radius.
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
