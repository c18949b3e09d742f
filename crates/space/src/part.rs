//! What bodies in space mean, and the ground on which they stand.

use barrelstack::assemble::PartKind;
use barrelstack_dynamics::{
    Body, BodyId, Motion, Placed, Pose, Quaternion, Rotation3, Solid, Spatial, Vec3,
};

/// What a body in space means.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The name in results, that of the body: level, column, and row where there are several.
    pub name: String,
    /// What it is.
    pub kind: PartKind,
    /// Level, 1 at the bottom; 0 for what belongs to no stack.
    pub level: u32,
    /// Column, 1 at the left: of barrels, or of racks for a rack.
    pub column: u32,
    /// Row, 1 nearest: of barrels, or of racks for a rack.
    pub row: u32,
    /// For a barrel the rack that carries it.
    pub carrier: Option<BodyId>,
    /// For a rack above the first level, the barrels it lies on.
    pub supports: Vec<BodyId>,
    /// A length (m) that tells the size of the body: for a barrel the radius above the beams, for a rack
    /// half its width.
    pub size: f64,
    /// Volume (m³) of the wine in a barrel; 0 for all else.
    pub wine: f64,
    /// Of a rack which of its tubes lie on which of what is below, and carry which of its barrels, by their numbers.
    pub(crate) seats: Seats,
    /// Lines (m) in the frame of the body that show what of a device is fixed to it.
    pub(crate) lines: Vec<Vec<Vec3>>,
}

/// Which tubes of a rack bear what.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Seats {
    /// For every tube the barrel that it carries.
    pub(crate) carries: Vec<Option<BodyId>>,
    /// For every tube whether it lies on what is below, and on which barrels if these are some.
    pub(crate) lies_on: Vec<Option<Vec<BodyId>>>,
}

impl Part {
    /// What belongs to no stack.
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

/// The ground: all below a level plane through the origin.
pub(crate) fn ground() -> Body<Spatial> {
    let floor = Placed {
        surface: Solid::HalfSpace,
        offset: Vec3::default(),
        rotation: Rotation3::identity(),
    };
    let pose = Pose { position: Vec3::default(), orientation: Quaternion::identity() };
    // No force moves it, so its mass is of no account.
    let body = Body::free("ground", 1.0, Vec3::new(1.0, 1.0, 1.0), pose);
    Body { motion: Motion::Prescribed, surfaces: vec![floor], ..body }
}
