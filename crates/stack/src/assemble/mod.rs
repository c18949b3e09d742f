//! Assembly of the model of a scenario, with a description of each of its bodies.

mod builder;
mod bundle;
mod content;
mod free;
mod interfaces;
mod longitudinal;
mod pairs;
mod posts;
mod similitude;
mod solid;
mod stack;
mod transverse;

use barrelstack_dynamics::{
    BodyId, Element, Interface, Model, ModelError, Placed, Planar, Spatial, Vec2,
};

use crate::device::{Loose, Words};
use crate::scenario::{self, FreeInterface, Scenario, Scene, SpatialScene, StackSpec, View};
use crate::step::{TimeStepping, critical_of_interface, keep_restitution};

pub(crate) use builder::{Builder, Draft};
pub use longitudinal::CHIME_RADIUS;
pub use posts::cup;
pub use similitude::Similitude;
pub(crate) use solid::{Seat, Solid};
pub use transverse::{BAR_RADIUS, TUBE_CORNER};

/// Kind of a body of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartKind {
    /// The ground and everything fixed to it.
    Ground,
    /// A barrel.
    Barrel,
    /// A rack.
    Rack,
    /// A protective device.
    Device,
    /// The sloshing mass of the wine in a barrel.
    Wine,
    /// A body of a free scene.
    Body,
}

impl PartKind {
    /// Returns the name of the kind in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ground => "ground",
            Self::Barrel => "barrel",
            Self::Rack => "rack",
            Self::Device => "device",
            Self::Wine => "wine",
            Self::Body => "body",
        }
    }
}

/// A polyline in the frame of a body, for drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The points (m), relative to the center of mass.
    pub points: Vec<Vec2>,
    /// `true` if the last point is joined to the first.
    pub closed: bool,
}

/// Description of a body of the model.
#[derive(Clone, Debug)]
pub struct Part {
    /// Name in results, the same as the name of the body in the model.
    pub name: String,
    /// Kind of the body.
    pub kind: PartKind,
    /// Level, 1 at the bottom; `None` for a body that belongs to no level, and for all bodies of a free scene.
    pub level: Option<u32>,
    /// Column, 1 at the left: the number of a barrel among the barrels of its level, or the number of a rack among the
    /// racks of its level. A device under or on a rack has the column of the rack. `None` for the ground and for the
    /// bodies of a free scene.
    pub column: Option<u32>,
    /// Body that carries this body: the rack that carries a barrel or a tuned mass, the barrel that contains wine, or
    /// the platform under a rack; `None` for all other bodies.
    pub carrier: Option<BodyId>,
    /// Bodies on which a rack above the first level stands; empty for all other bodies.
    pub supports: Vec<BodyId>,
    /// Characteristic size (m) of the body; for a barrel, its radius.
    pub size: f64,
    /// Volume (m³) of the wine in a barrel at full scale, whatever the length scale; 0 for all other bodies.
    pub wine: f64,
    /// Height (m) of the center of mass of a rack above its underside.
    pub foot: f64,
    /// Outlines to draw, in the body frame.
    pub outlines: Vec<Outline>,
    /// One flag for each surface: `true` if the surface is beside the barrels, out of the plane of the drawing, so that
    /// it never touches a barrel.
    pub out_of_plane: Vec<bool>,
}

impl Part {
    /// Creates a part that has no level, column, carrier or support.
    fn alone(name: &str, kind: PartKind) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            level: None,
            column: None,
            carrier: None,
            supports: Vec::new(),
            size: 0.0,
            wine: 0.0,
            foot: 0.0,
            outlines: Vec::new(),
            out_of_plane: Vec::new(),
        }
    }

    /// Creates the description of the ground, which is drawn as a line longer than the width of any picture.
    fn ground() -> Self {
        let points = vec![Vec2::new(-100.0, 0.0), Vec2::new(100.0, 0.0)];
        let outlines = vec![Outline { points, closed: false }];
        Self { outlines, ..Self::alone("ground", PartKind::Ground) }
    }
}

/// A model and the descriptions of its bodies.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// The model.
    pub model: Model<Planar>,
    /// One part for every body, in the same order.
    pub parts: Vec<Part>,
    /// Force elements of devices that are installed once the stack has settled.
    pub(crate) loose: Vec<Loose>,
    /// Time step (s) that the contacts require; during impacts, it is divided into substeps.
    pub step: f64,
    /// For each force element of the model, the description of its device.
    pub devices: Vec<&'static Words>,
    /// Height (m) of the stack from the ground to the top of the highest barrel; zero for a free scene.
    pub height: f64,
    /// Number of levels; zero for a free scene.
    pub levels: u32,
    /// The plane of a stack; `None` for a free scene.
    pub view: Option<View>,
    /// Largest force (N) between a barrel and a rack that the staves can bear; infinite for a free scene.
    pub stave_capacity: f64,
    /// Displacement (m) of a rack relative to the barrels below, beyond which the rack is no longer supported.
    ///
    /// Beyond this displacement across the barrels, friction no longer holds the rack on the curved side of the barrel.
    /// Beyond this displacement along the barrels, the rail of the rack has passed the ends of the barrels.
    pub rack_reach: f64,
}

impl Assembly {
    /// Returns the IDs of all bodies of a kind, in ascending order.
    pub fn of_kind(&self, kind: PartKind) -> impl Iterator<Item = BodyId> + '_ {
        self.parts.iter().enumerate().filter(move |(_, p)| p.kind == kind).map(|(i, _)| i)
    }

    /// Returns the force elements of the model, followed by the force elements of devices that are not installed yet.
    pub fn elements(&self) -> impl Iterator<Item = &Element<Planar>> {
        let loose = self.loose.iter().map(|loose| &loose.element);
        self.model.elements().iter().chain(loose)
    }

    /// ID of the ground, the body that follows the ground motion. Every assembly has this body.
    pub const GROUND: BodyId = 0;
}

/// Reason why a scenario cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AssembleError {
    /// The bodies do not form a valid model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A shape is invalid.
    #[error("body \"{body}\": {problem}")]
    Shape {
        /// Name of the body.
        body: String,
        /// Description of the problem.
        problem: String,
    },
    /// Two bodies overlap.
    #[error(
        "\"{first}\" and \"{second}\" overlap by {depth:.3} m or more at the start: move them apart, or \
         let them touch without overlap"
    )]
    Overlap {
        /// Name of one body.
        first: String,
        /// Name of the other body.
        second: String,
        /// Depth of the overlap (m).
        depth: f64,
    },
    /// A planar analysis was requested for a three-dimensional stack.
    #[error(
        "this analysis works in a plane, but the stack of the scenario is three-dimensional: set stack.view to \
         \"transverse\" (across the barrels), to \"longitudinal\" (along them), or to \"both\""
    )]
    Space,
    /// A planar analysis was requested for a three-dimensional scene.
    #[error(
        "this analysis works in a plane, but the bodies of the scenario are three-dimensional: use a scenario with \
         kind = \"free\", whose bodies are planar"
    )]
    FreeInSpace,
    /// The scenario uses a feature that is not supported in three dimensions.
    #[error("{reason}")]
    NotInSpace {
        /// Path of the field in the scenario.
        field: &'static str,
        /// Message with the value of the field, the supported values, and what to change.
        reason: String,
    },
    /// The stack cannot be built as described.
    #[error("{0}")]
    Stack(String),
}

/// Largest time step (s) of a free scene with force elements, at full scale.
///
/// With this step, an oscillation with a period of 0.3 s has a relative error of 5e-5.
const SWINGING_STEP: f64 = 1e-3;

/// Builds the model of a scenario.
///
/// # Errors
/// If a shape is invalid, bodies overlap, or names repeat.
pub fn assemble(scenario: &Scenario) -> Result<Assembly, AssembleError> {
    let scale = Similitude::new(scenario.run.similitude);
    let mut assembly = match &scenario.scene {
        Scene::Stack { stack, .. } => stack::assemble(stack, scenario.run.gravity, scale),
        Scene::Free(scene) => free::assemble(scene, scenario.run.gravity, scale),
        Scene::Spatial(_) => return Err(AssembleError::FreeInSpace),
    }?;
    let loose = assembly.loose.iter().map(|loose| &loose.element);
    let stepping = TimeStepping::of(&assembly.model, &loose, scale.time());
    assembly.model.set_substepping(stepping.substepping);
    assembly.step = stepping.step;
    if let Scene::Free(scene) = &scenario.scene {
        if !assembly.model.elements().is_empty() {
            // Oscillations on force elements are results of interest, and a step derived from their period alone would
            // be too inaccurate.
            assembly.step = assembly.step.min(SWINGING_STEP * scale.time());
        }
        let step = scenario.run.step.map(|step| step * scale.time());
        let step = step.unwrap_or(assembly.step * scenario.run.accuracy.step());
        let (model, laws) = (&mut assembly.model, &scene.interfaces);
        keep_restitution(model, laws, step, scale.time(), critical_of_interface);
    }
    Ok(assembly)
}

/// Returns the contact laws of a three-dimensional stack, in the order of
/// [`StackPair::ALL`](crate::scenario::StackPair::ALL).
///
/// These contact laws are the same as in a planar model, except that every seat is a separate contact.
pub fn laws_in_space(spec: &StackSpec) -> Vec<Interface<Spatial>> {
    stack::laws(spec, bundle::Shown::Space, Similitude::FULL)
}

/// Converts a contact law of a scenario to a contact law of a three-dimensional model.
pub fn law_in_space(name: &str, law: &scenario::Interface) -> Interface<Spatial> {
    interfaces::interface(name, law, bundle::Bundle::ONE, Similitude::FULL)
}

/// Returns the contact laws of a three-dimensional scene, in the order of its interfaces.
pub fn laws_of_free(scene: &SpatialScene) -> Vec<Interface<Spatial>> {
    let law = |law: &FreeInterface| law_in_space(&law.between.join("-"), &law.law);
    scene.interfaces.iter().map(law).collect()
}

/// Returns the outline of a shape in the frame of its body.
fn outline_of(placed: &Placed<Planar>) -> Outline {
    let (points, closed) = placed.surface.outline();
    let at = |point| placed.offset + placed.rotation.apply(point);
    Outline { points: points.into_iter().map(at).collect(), closed }
}
