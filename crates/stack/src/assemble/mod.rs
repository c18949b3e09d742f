//! Builds the model of a scenario, and records what each of its bodies represents.

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

/// Kind of a body.
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
    /// Sloshing wine in a barrel.
    Wine,
    /// A body of a free scene.
    Body,
}

impl PartKind {
    /// Returns the word used in files and reports.
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

/// A chain of points (m) in the frame of a body, for drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The points (m), from the center of mass.
    pub points: Vec<Vec2>,
    /// `true` if the last point joins the first.
    pub closed: bool,
}

/// Description of a body of the model.
#[derive(Clone, Debug)]
pub struct Part {
    /// The name in results, equal to that of the body.
    pub name: String,
    /// Kind of the body.
    pub kind: PartKind,
    /// Level, 1 at the bottom; `None` in a free scene.
    pub level: Option<u32>,
    /// Column, 1 at the left: of barrels, or of racks for a rack.
    pub column: Option<u32>,
    /// For a barrel the rack that carries it, for wine its barrel, for a rack on an isolator its platform.
    pub carrier: Option<BodyId>,
    /// For a rack above the first level, the bodies it stands on.
    pub supports: Vec<BodyId>,
    /// Characteristic size (m) of the body: for a barrel its radius.
    pub size: f64,
    /// Volume (m³) of the wine in a barrel as the scenario states it, at any length scale; 0 for all other bodies.
    pub wine: f64,
    /// Height (m) of the center of mass above the underside of a rack.
    pub foot: f64,
    /// Lines to draw, in the body frame.
    pub outlines: Vec<Outline>,
    /// `true` for each surface that stands beside the barrels, out of the plane of the drawing: it never meets
    /// barrels.
    pub out_of_plane: Vec<bool>,
}

impl Part {
    /// Creates a part that belongs to no stack.
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

    /// The ground, drawn as a line longer than any picture is wide.
    fn ground() -> Self {
        let points = vec![Vec2::new(-100.0, 0.0), Vec2::new(100.0, 0.0)];
        let outlines = vec![Outline { points, closed: false }];
        Self { outlines, ..Self::alone("ground", PartKind::Ground) }
    }
}

/// A model and the description of its bodies.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// The model.
    pub model: Model<Planar>,
    /// One part for every body, in the same order.
    pub parts: Vec<Part>,
    /// Elements of devices that are installed once the stack stands.
    pub(crate) loose: Vec<Loose>,
    /// Time step (s) that its contacts require; impacts divide it.
    pub step: f64,
    /// The device of every force element of the model.
    pub devices: Vec<&'static Words>,
    /// Height (m) of the stack from the ground to the top of the highest barrel; zero for a free scene.
    pub height: f64,
    /// Number of levels; zero for a free scene.
    pub levels: u32,
    /// The plane of a stack; `None` for a free scene.
    pub view: Option<View>,
    /// Force (N) between a barrel and a rack that the staves bear; infinite for a free scene.
    pub stave_capacity: f64,
    /// Displacement (m) of a rack on the barrels below beyond which it is no longer supported: across the barrels
    /// until friction can no longer hold it on the curved side of the barrel, along them until its rail passes the end.
    pub rack_reach: f64,
}

impl Assembly {
    /// Returns the bodies of a kind, in order.
    pub fn of_kind(&self, kind: PartKind) -> impl Iterator<Item = BodyId> + '_ {
        self.parts.iter().enumerate().filter(move |(_, p)| p.kind == kind).map(|(i, _)| i)
    }

    /// Returns its force elements, followed by those of devices that are not installed yet.
    pub fn elements(&self) -> impl Iterator<Item = &Element<Planar>> {
        let loose = self.loose.iter().map(|loose| &loose.element);
        self.model.elements().iter().chain(loose)
    }

    /// The body driven by the ground motion; every assembly has one.
    pub const GROUND: BodyId = 0;
}

/// Reason why a scenario cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AssembleError {
    /// The bodies do not make a model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A shape is invalid.
    #[error("body \"{body}\": {problem}")]
    Shape {
        /// The body.
        body: String,
        /// The problem.
        problem: String,
    },
    /// Two bodies overlap.
    #[error(
        "\"{first}\" and \"{second}\" overlap by {depth:.3} m or more at the start: move them apart, or \
         let them touch without overlap"
    )]
    Overlap {
        /// One body.
        first: String,
        /// The other.
        second: String,
        /// Depth of the overlap (m).
        depth: f64,
    },
    /// A stack in space was requested in a plane.
    #[error(
        "this works in a plane, and the scenario looks at its stack in space: set stack.view to \"transverse\", across \
         the barrels, to \"longitudinal\", along them, or to \"both\""
    )]
    Space,
    /// A free scene in space was requested in a plane.
    #[error(
        "this works in a plane, and the bodies of the scenario are in space: state them in a plane, with kind = \"free\""
    )]
    FreeInSpace,
    /// A feature that is not supported in space.
    #[error("{reason}")]
    NotInSpace {
        /// The field.
        field: &'static str,
        /// Value of the field, supported values, and the next move.
        reason: String,
    },
    /// A stack that cannot stand as described.
    #[error("{0}")]
    Stack(String),
}

/// Largest step (s) of a free scene with force elements at full scale: a swing of 0.3 s loses 5e-5 with it.
const SWINGING_STEP: f64 = 1e-3;

/// Builds the model of a scenario.
///
/// # Errors
/// When shapes are impossible, bodies overlap, or names repeat.
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
            // Springs between bodies are slow, and their oscillation is the result of interest.
            assembly.step = assembly.step.min(SWINGING_STEP * scale.time());
        }
        let step = scenario.run.step.map(|step| step * scale.time());
        let step = step.unwrap_or(assembly.step * scenario.run.accuracy.step());
        let (model, laws) = (&mut assembly.model, &scene.interfaces);
        keep_restitution(model, laws, step, scale.time(), critical_of_interface);
    }
    Ok(assembly)
}

/// Returns the contact laws of a stack in space, in the order of [`StackPair::ALL`](crate::scenario::StackPair::ALL):
/// those of the plane, where every element is a contact of its own.
pub fn laws_in_space(spec: &StackSpec) -> Vec<Interface<Spatial>> {
    stack::laws(spec, bundle::Shown::Space, Similitude::FULL)
}

/// Returns a contact law in space.
pub fn law_in_space(name: &str, law: &scenario::Interface) -> Interface<Spatial> {
    interfaces::interface(name, law, bundle::Bundle::ONE, Similitude::FULL)
}

/// Returns the contact laws of a free scene in space, in the order of its interfaces.
pub fn laws_of_free(scene: &SpatialScene) -> Vec<Interface<Spatial>> {
    let law = |law: &FreeInterface| law_in_space(&law.between.join("-"), &law.law);
    scene.interfaces.iter().map(law).collect()
}

/// Returns the outline of a shape at an offset on a body.
fn outline_of(placed: &Placed<Planar>) -> Outline {
    let (points, closed) = placed.surface.outline();
    let at = |point| placed.offset + placed.rotation.apply(point);
    Outline { points: points.into_iter().map(at).collect(), closed }
}
