//! A room: stacks in their places, and obstacles.

use barrelstack::scenario::Scene;
use barrelstack::{RunFailure, Scenario};
use barrelstack_dynamics::{Interface, ModelError, Spatial};
use barrelstack_space::Ground;

/// A stack in its place in a room.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Name of the stack; unique in its room.
    pub name: String,
    /// Three-dimensional scenario of the stack, in which all random draws have been applied. Its motion and the azimuth
    /// of its stack are ignored.
    pub scenario: Scenario,
    /// Position (m) of the center of the footprint in the room.
    pub at: [f64; 2],
    /// Angle (rad), counterclockwise from the `x` axis of the room to the `x` axis of the stack.
    pub azimuth: f64,
    /// Poses from which the stack starts, in the order of its bodies, without the ground; `None` to start as built. A
    /// pose is the position of the center of mass (m) and the quaternion `w`, `x`, `y`, `z`, both in the frame of the
    /// stack and relative to the ground, as in [`BodyEnd::own`](crate::BodyEnd::own). The bodies start at rest. A loss
    /// of seat is still judged relative to the places as built, so a seat that was lost before the run counts as lost
    /// at time zero.
    pub start: Option<Vec<[f64; 7]>>,
    /// `true` if an earlier run of the same room ended in the poses of `start`. Bodies may then overlap by any depth,
    /// because loads press them into each other. If the poses were stated instead, a deep overlap is an error.
    pub carried_on: bool,
    /// Shifts of bodies before the run. They are applied one after another to the poses of `start` or, if `start` is
    /// `None`, to the poses at rest.
    pub shifts: Vec<Shift>,
}

/// A shift of a body, or of a whole stack, before a run. The bodies start at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// Index of the body among the bodies of the stack, not counting the ground; `None` for all bodies of the stack.
    pub body: Option<usize>,
    /// Displacement (m) along the axes of the stack.
    pub by: [f64; 3],
    /// Angle (rad) of a turn about the vertical, counterclockwise from above: a body turns about its center of mass, a
    /// whole stack about the center of its footprint.
    pub turn: f64,
}

impl Placed {
    /// Creates a stack at a position (m) in the room, with its axes parallel to the axes of the room.
    pub fn new(name: &str, scenario: Scenario, at: [f64; 2]) -> Self {
        let (azimuth, start, shifts) = (0.0, None, Vec::new());
        Self { name: name.to_owned(), scenario, at, azimuth, start, carried_on: false, shifts }
    }
}

/// A block that is fixed to the ground, such as a wall or a column.
#[derive(Clone, Debug)]
pub struct Obstacle {
    /// Name of the obstacle; unique in its room.
    pub name: String,
    /// Center (m) of the block.
    pub center: [f64; 3],
    /// Half-extents (m) of the block along its own axes.
    pub half: [f64; 3],
    /// Angle (rad) by which the block is turned counterclockwise about the vertical.
    pub azimuth: f64,
    /// Contact law between the block and any body.
    pub interface: Interface<Spatial>,
}

/// Stacks and obstacles on one ground.
#[derive(Clone, Debug)]
pub struct Room {
    /// The stacks. Their order does not affect the motion of any body. Sums over stacks (impulses, forces on obstacles,
    /// energies) may differ by rounding.
    pub stacks: Vec<Placed>,
    /// Walls and columns.
    pub obstacles: Vec<Obstacle>,
    /// Ground motion along the axes of the room.
    pub ground: Ground,
}

impl Room {
    /// Returns the total number of bodies in all stacks, without the ground.
    pub fn bodies(&self) -> u64 {
        let of = |placed: &Placed| match &placed.scenario.scene {
            Scene::Stack { stack, .. } => {
                let rack = u64::from(stack.rack.barrels) * u64::from(stack.rack.barrels_deep) + 1;
                let per_level = u64::from(stack.racks_per_level()) * u64::from(stack.racks_along());
                u64::from(stack.levels) * per_level * rack
            }
            Scene::Free(scene) => scene.bodies.len() as u64,
            Scene::Spatial(scene) => scene.bodies.len() as u64,
        };
        self.stacks.iter().map(of).sum()
    }
}

/// Settings of a run, none of which affects the computed motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// Number of threads; zero for all cores.
    pub threads: usize,
    /// `true` to record frames, at the frame rate of the first scenario.
    pub frames: bool,
}

/// Maximum number of bodies.
pub const MOST_BODIES: u64 = 30_000;

/// Reason why a room cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum RoomFailure {
    /// There is no stack.
    #[error("the room has no stack: place at least one")]
    Empty,
    /// There are too many bodies.
    #[error(
        "the room has {bodies} barrels, racks and other bodies, but at most {MOST_BODIES} are allowed (a run of that \
         size needs about 3 GB): divide it into rooms such that nothing can fall from one \
         room into another"
    )]
    Large {
        /// Number of bodies.
        bodies: u64,
    },
    /// Stacks have different gravity or integration methods.
    #[error(
        "stacks \"{first}\" and \"{second}\" differ in run.gravity or run.method: give all stacks of a room the \
         same values"
    )]
    Differ {
        /// Name of the first stack.
        first: String,
        /// Name of a stack whose gravity or integration method differs from that of the first stack.
        second: String,
    },
    /// Two stacks or obstacles have the same name.
    #[error("two stacks or obstacles are named \"{name}\": give each its own name")]
    Name {
        /// The name that occurs twice.
        name: String,
    },
    /// A stack cannot be built, or does not stand.
    #[error("stack \"{name}\": {failure}")]
    Stack {
        /// Name of the stack.
        name: String,
        /// The error.
        failure: Box<RunFailure>,
    },
    /// The number of poses from which a stack starts differs from the number of its bodies.
    #[error(
        "stack \"{name}\" starts from {found} poses, but has {expected} bodies: state one pose for each body"
    )]
    Start {
        /// Name of the stack.
        name: String,
        /// Number of poses.
        found: usize,
        /// Number of bodies.
        expected: usize,
    },
    /// A pose from which a stack starts is invalid.
    #[error(
        "stack \"{name}\": the pose of body {body} is not finite, or its quaternion is not of length one: give a \
         finite position (m) and a unit quaternion"
    )]
    Pose {
        /// Name of the stack.
        name: String,
        /// Number of the body, counted from 1.
        body: usize,
    },
    /// A shift refers to a body that the stack does not have.
    #[error(
        "stack \"{name}\" has {bodies} bodies, but a shift is stated for body {body}: name one of its bodies"
    )]
    Shift {
        /// Name of the stack.
        name: String,
        /// Number of the body, counted from 1.
        body: usize,
        /// Number of bodies.
        bodies: usize,
    },
    /// Bodies of two stacks, or a body and an obstacle, overlap at the start. The error also covers two bodies of the
    /// same stack if the stack does not start as built.
    #[error(
        "\"{first}\" and \"{second}\" overlap by {:.1} mm before the ground moves: move them apart",
        1e3 * depth
    )]
    Overlap {
        /// One of the two bodies, with the name of its stack.
        first: String,
        /// The other body or the obstacle.
        second: String,
        /// Depth (m) of the overlap.
        depth: f64,
    },
    /// A side length of an obstacle is not positive, or not finite.
    #[error("obstacle \"{name}\" has a side of {side} m: give it three positive side lengths")]
    Side {
        /// Name of the obstacle.
        name: String,
        /// Length (m) of the shortest side of the obstacle.
        side: f64,
    },
    /// The bodies of the stacks cannot be combined into one model.
    #[error(transparent)]
    Model(#[from] ModelError),
}
