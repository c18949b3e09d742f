//! A free scene: arbitrary planar bodies on a ground instead of a stack, for verification and teaching.

use std::collections::BTreeSet;

use barrelstack_columns::column::column_name;
use barrelstack_input::choices::Chosen as _;
use barrelstack_input::declared::{self, Declared as _};
use barrelstack_input::names::advice;
use barrelstack_input::{section, table};

use super::dimension::Dimension;
use super::element::{self, FreeElement};
use super::error::ScenarioError;
use super::field::{Default, Kind, Range, names};
use super::interface::{self, Interface};
use super::nodes::{self, NodeRule};
use super::reader::Reader;
use super::shape::{self, SHAPE};
use super::tree::Table;
use super::writer::Writer;

pub use super::nodes::{ChosenNode, Nodes};
pub use super::shape::{PartShape, Shape};

section! {
    /// The ground of a free scene.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Ground;
    /// The ground: the half-plane below a line through the origin.
    pub static GROUND = "ground";
    /// Slope of the ground, positive if it rises to the right.
    slope: f64 =
        Kind::Quantity(&[Dimension::ANGLE], Range::between(-1.5, 1.5)), Default::Value("\"0 deg\"");
    /// Name by which interfaces and elements refer to the ground.
    kind: String = Kind::Text, Default::Value("\"ground\"");
}

section! {
    /// Viscous drag on a body, proportional to the absolute velocity of the body, not to its velocity relative to the
    /// shaking ground.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Viscous;
    /// Viscous drag on the motion of a body (Candia, de la Llera and Almazán 2008, eq. 2.8).
    pub static VISCOUS = "viscous";
    /// Drag force divided by the velocity of the center of mass.
    linear: f64 =
        Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE), Default::Value("\"0 N s/m\"");
    /// Drag moment divided by the angular velocity.
    angular: f64 =
        Kind::Quantity(&[Dimension::ANGULAR_DAMPING], Range::NOT_NEGATIVE), Default::Value("\"0 N m s\"");
}

/// One body of a free scene.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeBody {
    /// Unique name.
    pub name: String,
    /// Name of the kind of the body, by which interfaces refer to it.
    pub kind: String,
    /// Outline of the body.
    pub shape: Shape,
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia about the center of mass (kg·m²).
    pub inertia: f64,
    /// Center of mass in local coordinates, relative to the reference point of the shape (m).
    pub center_of_mass: [f64; 2],
    /// Initial position of the reference point `[x, z]` (m).
    pub position: [f64; 2],
    /// Initial inclination, counterclockwise (rad).
    pub angle: f64,
    /// Initial velocity of the center of mass (m/s).
    pub velocity: [f64; 2],
    /// Initial angular velocity, counterclockwise (rad/s).
    pub spin: f64,
    /// Contact nodes on the boundary.
    pub nodes: Nodes,
    /// Additional boundaries.
    pub boundaries: Vec<Boundary>,
    /// Name of the group; interfaces can exclude contacts within a group. `None` if the body belongs to no group.
    pub group: Option<String>,
    /// `true` if the body moves with the ground.
    pub fixed_to_ground: bool,
    /// Viscous drag on the body; `None` if there is no drag.
    pub viscous: Option<Viscous>,
}

/// An additional massless boundary of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    /// Name of the kind of the boundary, by which interfaces refer to it.
    pub kind: String,
    /// Outline that other bodies touch, relative to the reference point of the body's shape; `None` if the boundary
    /// has only nodes.
    pub shape: Option<Shape>,
    /// Contact nodes on the boundary.
    pub nodes: Nodes,
}

/// The contact law between two kinds of bodies or boundaries of a free scene.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeInterface {
    /// The two kinds: the first has the nodes (contactor), the second the surface (target).
    pub between: [String; 2],
    /// `true` if the interface also acts between bodies of the same group.
    pub within_groups: bool,
    /// The law.
    pub law: Interface,
}

/// A free scene: arbitrary planar bodies on a ground, instead of a stack.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeScene {
    /// The ground.
    pub ground: Ground,
    /// Bodies, in the order of the file.
    pub bodies: Vec<FreeBody>,
    /// Interfaces, in the order of the file.
    pub interfaces: Vec<FreeInterface>,
    /// Force elements, in the order of the file.
    pub elements: Vec<FreeElement>,
}

impl FreeBody {
    /// Returns the kind, the shape (if there is one) and the nodes of each boundary of the body: first its own outline,
    /// then the additional boundaries.
    pub fn outer(&self) -> impl Iterator<Item = (&str, Option<&Shape>, &Nodes)> {
        let own = (self.kind.as_str(), Some(&self.shape), &self.nodes);
        let further = self.boundaries.iter().map(|b| (b.kind.as_str(), b.shape.as_ref(), &b.nodes));
        std::iter::once(own).chain(further)
    }
}

/// Maximum number of bodies of a free scene.
const MOST_BODIES: usize = 5000;

/// Maximum total number of contact nodes in a free scene.
const MOST_NODES: f64 = 2e6;

table! {
    /// An additional massless boundary of a body.
    pub static BOUNDARY = "boundary";
    /// Kind by which interfaces refer to the boundary.
    kind = Kind::Text, Default::Required;
    /// Outline that other bodies touch, relative to the reference point of the body's shape; if not given, the boundary
    /// consists of its nodes only.
    shape = Kind::Table(&SHAPE), Default::Nothing;
    /// Contact nodes on the boundary.
    nodes = NODES_KIND, NODES_DEFAULT;
}

/// Kind of the field `nodes` of a boundary.
const NODES_KIND: Kind = Kind::ChoiceOrTable(names::<NodeRule>, "rule", &nodes::NODES);
const NODES_DEFAULT: Default = Default::Derived(
    "`rolling` for a circle, `corners` for straight sides, otherwise nodes 1 cm apart; must be given if there is no \
     shape",
);

table! {
    /// A rigid body of a free scene.
    pub static BODY = "body";
    /// Unique name.
    name = Kind::Text, Default::Required;
    /// Kind of the body. Interfaces refer to bodies by their kind, and several bodies may have the same kind.
    kind = Kind::Text, Default::Derived("the name");
    /// Outline of the body.
    shape = Kind::Table(&SHAPE), Default::Required;
    /// Mass of the body.
    mass = Kind::Quantity(&[Dimension::MASS], Range::POSITIVE), Default::Required;
    /// Moment of inertia about the center of mass.
    inertia = Kind::Quantity(&[Dimension::INERTIA], Range::POSITIVE),
        Default::Derived("the moment of inertia of a uniform plate with this outline");
    /// Center of mass, relative to the reference point of the shape.
    center_of_mass = Kind::Point(Dimension::LENGTH), Default::Derived("the centroid of the outline");
    /// Initial position of the reference point of the shape.
    position = Kind::Point(Dimension::LENGTH), Default::Required;
    /// Initial inclination, counterclockwise.
    angle = Kind::Quantity(&[Dimension::ANGLE], Range::between(-100.0, 100.0)), Default::Value("\"0 deg\"");
    /// Initial velocity of the center of mass.
    velocity = Kind::Point(Dimension::VELOCITY), Default::Value("[\"0 m/s\", \"0 m/s\"]");
    /// Initial angular velocity, counterclockwise.
    spin = Kind::Quantity(&[Dimension::SPIN], Range::between(-1e4, 1e4)), Default::Value("\"0 rad/s\"");
    /// Contact nodes on the boundary.
    nodes = NODES_KIND, NODES_DEFAULT;
    /// Additional boundaries, each with a kind of its own.
    boundary = Kind::Tables(&BOUNDARY), Default::Nothing;
    /// Group of the body: an interface with `within_groups = false` does not act between two bodies of the same group.
    group = Kind::Text, Default::Nothing;
    /// True if the body moves with the ground.
    fixed_to_ground = Kind::Flag, Default::Value("false");
    /// Viscous drag on the body.
    viscous = Kind::Table(&VISCOUS), Default::Nothing;
}

/// Returns the error message for a body whose columns in tables of results would have the same names as those of
/// another body or of the ground.
pub(super) fn clash(name: &str, column: &str) -> String {
    format!(
        "the columns of \"{name}\" would be called {column}_…, like those of another body or of the ground; give the \
         body another name"
    )
}

/// Reads the fields of a free scene from the top level of the file.
pub(super) fn read(root: &Reader<'_>) -> Result<FreeScene, ScenarioError> {
    let ground = Ground::read(root.section("ground")?)?;
    let mut bodies: Vec<FreeBody> = Vec::new();
    let (mut names, mut nodes) = (BTreeSet::new(), 0.0);
    // Column names of the bodies and of the ground in tables.
    let mut columns = BTreeSet::from(["ground".to_owned()]);
    for reader in root.sections("body")? {
        if bodies.len() == MOST_BODIES {
            let message = format!("a free scene has at most {MOST_BODIES} bodies");
            return Err(reader.inconsistent("name", message));
        }
        let name = reader.text("name")?;
        if !names.insert(name.clone()) {
            let message = format!("two bodies are called \"{name}\"; give each its own name");
            return Err(reader.inconsistent("name", message));
        }
        let column = column_name(&name);
        if !columns.insert(column.clone()) {
            return Err(reader.inconsistent("name", clash(&name, &column)));
        }
        let refuse = reader.inconsistent(
            "shape",
            format!(
                "with this body the scene has more than {MOST_NODES} contact nodes: use fewer bodies, or wider \
                 spacings of their nodes"
            ),
        );
        let body = read_body(reader, name)?;
        nodes += nodes::number(&body.nodes, Some(&body.shape));
        for boundary in &body.boundaries {
            nodes += nodes::number(&boundary.nodes, boundary.shape.as_ref());
        }
        if nodes > MOST_NODES {
            return Err(refuse);
        }
        bodies.push(body);
    }
    if bodies.is_empty() {
        return Err(root.missing("body"));
    }
    let interfaces = read_interfaces(root, &ground, &bodies)?;
    let elements = element::read(root, &ground, &bodies)?;
    Ok(FreeScene { ground, bodies, interfaces, elements })
}

fn read_body(reader: Reader<'_>, name: String) -> Result<FreeBody, ScenarioError> {
    let shape = shape::read(reader.section("shape")?)?;
    let nodes = nodes::read(&reader, Some(&shape))?;
    let mut boundaries = Vec::new();
    for reader in reader.sections("boundary")? {
        let shape = match reader.optional_section("shape")? {
            Some(shape) => Some(shape::read(shape)?),
            None => None,
        };
        let nodes = nodes::read(&reader, shape.as_ref())?;
        boundaries.push(Boundary { kind: reader.text("kind")?, shape, nodes });
        reader.finish();
    }
    let mass = reader.quantity("mass")?;
    let uniform = shape.uniform();
    let center_of_mass = reader.optional_point("center_of_mass")?;
    let inertia = reader.optional_quantity("inertia")?;
    // The default inertia, that of a uniform plate, holds about the centroid only.
    if inertia.is_none() && center_of_mass.is_some_and(|center| center != uniform.centroid) {
        let message = format!(
            "the center of mass differs from the centroid [{} m, {} m], so the body is not uniform; give `{}` too",
            uniform.centroid[0],
            uniform.centroid[1],
            reader.path_of("inertia")
        );
        return Err(reader.inconsistent("center_of_mass", message));
    }
    let body = FreeBody {
        kind: reader.optional_text("kind")?.unwrap_or_else(|| name.clone()),
        name,
        inertia: inertia.unwrap_or(mass * uniform.square_radius),
        center_of_mass: center_of_mass.unwrap_or(uniform.centroid),
        shape,
        mass,
        position: reader.point("position")?,
        angle: reader.quantity("angle")?,
        velocity: reader.point("velocity")?,
        spin: reader.quantity("spin")?,
        nodes,
        boundaries,
        group: reader.optional_text("group")?,
        fixed_to_ground: reader.flag("fixed_to_ground")?,
        viscous: declared::Held::read(&reader, "viscous")?,
    };
    reader.finish();
    Ok(body)
}

fn read_interfaces(
    root: &Reader<'_>,
    ground: &Ground,
    bodies: &[FreeBody],
) -> Result<Vec<FreeInterface>, ScenarioError> {
    let mut kinds: Vec<&str> = Vec::new();
    let mut known = BTreeSet::new();
    let all = bodies.iter().flat_map(FreeBody::outer).map(|(kind, ..)| kind);
    kinds.extend(all.chain([ground.kind.as_str()]).filter(|kind| known.insert(*kind)));
    let mut interfaces: Vec<FreeInterface> = Vec::new();
    for reader in root.sections("interface")? {
        let between = reader.pair("between")?;
        for kind in &between {
            if !kinds.contains(&kind.as_str()) {
                let message =
                    format!("no body is of the kind \"{kind}\"; {}", advice(kind, &kinds));
                return Err(reader.inconsistent("between", message));
            }
        }
        if between[0] == ground.kind {
            let message = format!(
                "the first kind carries the contact nodes, and the ground carries none; write `between = [\"{}\", \"{}\"]`",
                between[1], between[0]
            );
            return Err(reader.inconsistent("between", message));
        }
        if interfaces.iter().any(|known| known.between == between) {
            let message = format!(
                "there are two interfaces between \"{}\" and \"{}\"; keep one of them",
                between[0], between[1]
            );
            return Err(reader.inconsistent("between", message));
        }
        if between[1] != ground.kind
            && of_kind(bodies, &between[1]).all(|(_, shape, _)| shape.is_none())
        {
            let message = format!(
                "no body of the kind \"{}\" has a shape that contact nodes can touch; in `between`, name the kind with \
                 the nodes first",
                between[1]
            );
            return Err(reader.inconsistent("between", message));
        }
        let whole = |kind: &String| {
            of_kind(bodies, kind)
                .any(|(_, _, nodes)| matches!(nodes, Nodes::Exact | Nodes::Rolling))
        };
        let turned = |known: &FreeInterface| known.between.iter().rev().eq(&between);
        if between.iter().all(whole) && interfaces.iter().any(turned) {
            let message = format!(
                "the interface between \"{}\" and \"{}\" is stated twice, once in each order of the two kinds; the \
                 order has no effect, since the contact nodes of both kinds are \"exact\" or \"rolling\": keep one of \
                 the two interfaces",
                between[1], between[0]
            );
            return Err(reader.inconsistent("between", message));
        }
        let within_groups = reader.flag("within_groups")?;
        let law = interface::read(reader, None)?;
        interfaces.push(FreeInterface { between, within_groups, law });
    }
    Ok(interfaces)
}

/// Returns every boundary of the given kind, as a tuple of its kind, shape and nodes.
fn of_kind<'a>(
    bodies: &'a [FreeBody],
    kind: &'a str,
) -> impl Iterator<Item = (&'a str, Option<&'a Shape>, &'a Nodes)> {
    bodies.iter().flat_map(FreeBody::outer).filter(move |(other, ..)| *other == kind)
}

/// Writes the fields of a free scene to the top level of the file.
pub(super) fn write(writer: &mut Writer, scene: &FreeScene) {
    writer.table("ground", scene.ground.write());
    writer.tables("body", scene.bodies.iter().map(write_body).collect());
    let interfaces = scene.interfaces.iter().map(interface::write_free).collect();
    writer.tables("interface", interfaces);
    writer.tables("element", scene.elements.iter().map(FreeElement::write).collect());
}

fn write_boundary(boundary: &Boundary) -> Table {
    let mut writer = Writer::new(&BOUNDARY);
    writer.text("kind", &boundary.kind);
    match &boundary.shape {
        Some(shape) => writer.table("shape", shape.write_as(&SHAPE)),
        None => writer.omit(&["shape"]),
    }
    writer.table("nodes", nodes::write(&boundary.nodes));
    writer.finish()
}

fn write_body(body: &FreeBody) -> Table {
    let mut writer = Writer::new(&BODY);
    writer.text("name", &body.name);
    writer.text("kind", &body.kind);
    writer.quantity("mass", body.mass);
    writer.quantity("inertia", body.inertia);
    writer.point("center_of_mass", body.center_of_mass);
    writer.point("position", body.position);
    writer.quantity("angle", body.angle);
    writer.point("velocity", body.velocity);
    writer.quantity("spin", body.spin);
    writer.flag("fixed_to_ground", body.fixed_to_ground);
    writer.optional_text("group", body.group.as_deref());
    writer.table("shape", body.shape.write_as(&SHAPE));
    writer.table("nodes", nodes::write(&body.nodes));
    writer.tables("boundary", body.boundaries.iter().map(write_boundary).collect());
    declared::Held::write(&body.viscous, &mut writer, "viscous");
    writer.finish()
}
