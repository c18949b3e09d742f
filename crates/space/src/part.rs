//! Descriptions of three-dimensional bodies, and the ground.

use barrelstack::assemble::PartKind;
use barrelstack_dynamics::{
    Body, BodyId, Motion, Placed, Pose, Quaternion, Rotation3, Solid, Spatial, Vec3,
};

/// Description of a three-dimensional body.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Name in results, equal to the name of the body in the model. The name contains the level, the column and, if
    /// there are several rows, the row.
    pub name: String,
    /// Kind of the body.
    pub kind: PartKind,
    /// Level, 1 at the bottom; 0 for a body outside of a stack.
    pub level: u32,
    /// Column, 1 at the left; racks and barrels are counted separately.
    pub column: u32,
    /// Row, 1 for the row nearest to the viewer; racks and barrels are counted separately.
    pub row: u32,
    /// For a barrel, the rack that carries it; for a rack on isolators, its platform; for a tuned mass, its rack;
    /// `None` for all other bodies.
    pub carrier: Option<BodyId>,
    /// For a rack above the first level, the barrels on which it lies.
    pub supports: Vec<BodyId>,
    /// Characteristic size (m) of the body: for a barrel, its radius at the position of the beams; for a rack, half its
    /// width.
    pub size: f64,
    /// Volume (m³) of the wine in a barrel; 0 for all other bodies.
    pub wine: f64,
    /// Barrels that the tubes of a rack carry, and barrels on which the tubes lie.
    pub(crate) seats: Seats,
    /// Polylines that show the parts of devices that are fixed to the body. Their vertices (m) are in the body frame.
    pub(crate) lines: Vec<Vec<Vec3>>,
}

/// Barrels that the tubes of a rack carry, and barrels on which the tubes lie.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Seats {
    /// For every tube, the barrel that the tube carries, if any.
    pub(crate) carries: Vec<Option<BodyId>>,
    /// For every tube, the barrels on which the tube lies; empty for a tube on the ground, `None` for a tube that rests
    /// on nothing.
    pub(crate) lies_on: Vec<Option<Vec<BodyId>>>,
}

impl Part {
    /// Creates the description of a body outside of a stack.
    pub(crate) fn alone(name: &str, kind: PartKind) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            level: 0,
            column: 0,
            row: 0,
            carrier: None,
            supports: Vec::new(),
            size: 0.0,
            wine: 0.0,
            seats: Seats::default(),
            lines: Vec::new(),
        }
    }
}

/// Creates the ground: everything below a horizontal plane through the origin.
pub(crate) fn ground() -> Body<Spatial> {
    let floor = Placed {
        surface: Solid::HalfSpace,
        offset: Vec3::default(),
        rotation: Rotation3::identity(),
    };
    let pose = Pose { position: Vec3::default(), orientation: Quaternion::identity() };
    // The ground moves as prescribed, so its mass is irrelevant.
    let body = Body::free("ground", 1.0, Vec3::new(1.0, 1.0, 1.0), pose);
    Body { motion: Motion::Prescribed, surfaces: vec![floor], ..body }
}
