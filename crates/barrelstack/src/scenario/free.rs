//! A free scene: any planar bodies on a ground, for verification and for teaching.

use super::interface::Interface;

/// The ground of a free scene: the half-plane below a line through the origin.
#[derive(Debug, Clone, PartialEq)]
pub struct Ground {
    /// Slope of the surface, positive when it rises to the right (rad).
    pub slope: f64,
    /// Label used by interfaces.
    pub kind: String,
}

/// Outline of a body, about its reference point.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A rectangle; the reference point is its middle.
    Rectangle {
        /// Along local `x` (m).
        width: f64,
        /// Along local `z` (m).
        height: f64,
        /// Radius of the rounded corners (m).
        corner_radius: f64,
    },
    /// A circle; the reference point is its center.
    Circle {
        /// Radius (m).
        radius: f64,
    },
    /// A simple polygon, counterclockwise; the reference point is the local origin.
    Polygon {
        /// Corners `[x, z]` (m).
        vertices: Vec<[f64; 2]>,
    },
    /// A circular trough open upward; the reference point is the center of the circle.
    Cradle {
        /// Radius (m).
        radius: f64,
        /// Half of the angle spanned, from the lowest point (rad).
        half_angle: f64,
    },
    /// A barrel seen from the side, axis along local `x`; the reference point is its middle.
    BarrelProfile {
        /// Length (m).
        length: f64,
        /// Outer diameter at the middle (m).
        bilge_diameter: f64,
        /// Outer diameter at the ends (m).
        head_diameter: f64,
    },
}

/// Where the boundary of a body carries contact nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Nodes {
    /// At the corners.
    Corners,
    /// Along the boundary at most this far apart, corners included (m).
    Spacing(f64),
    /// This many on each side, or around a curved shape.
    Count(u32),
    /// The one point of a circle that is deepest in the target.
    Rolling,
}

/// Viscous drag on a body, relative to the ground at rest (Candia, de la Llera and Almazán 2008, eq. 2.8).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscous {
    /// On the velocity of the center of mass (N·s/m).
    pub linear: f64,
    /// On the spin (N·m·s).
    pub angular: f64,
}

/// One body of a free scene.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeBody {
    /// Unique name.
    pub name: String,
    /// Label used by interfaces.
    pub kind: String,
    /// Outline.
    pub shape: Shape,
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia about the center of mass (kg·m²).
    pub inertia: f64,
    /// Center of mass in local coordinates, from the reference point of the shape (m).
    pub center_of_mass: [f64; 2],
    /// Place of the reference point `[x, z]` at the start (m).
    pub position: [f64; 2],
    /// Inclination at the start, counterclockwise (rad).
    pub angle: f64,
    /// Velocity of the center of mass at the start (m/s).
    pub velocity: [f64; 2],
    /// Spin at the start, counterclockwise (rad/s).
    pub spin: f64,
    /// Contact nodes.
    pub nodes: Nodes,
    /// Whether the body moves with the ground.
    pub fixed_to_ground: bool,
    /// Viscous drag.
    pub viscous: Option<Viscous>,
}

/// The law between two kinds of a free scene.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeInterface {
    /// The two kinds; the first carries the nodes (contactor), the second the surface (target).
    pub between: [String; 2],
    /// The law.
    pub law: Interface,
}

/// A free scene.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeScene {
    /// The ground.
    pub ground: Ground,
    /// Bodies, in the order of the file.
    pub bodies: Vec<FreeBody>,
    /// Interfaces, in the order of the file.
    pub interfaces: Vec<FreeInterface>,
}
