//! A free scene in three dimensions: arbitrary bodies on a ground instead of a stack. Each body consists of one or more
//! solids.

use std::collections::BTreeSet;

use barrelstack_bodies::{Solid, SpatialBody};
use barrelstack_columns::column::column_name;
use barrelstack_input::declared::Declared as _;
use barrelstack_input::names::advice;
use barrelstack_input::reader::Reader;
use barrelstack_input::section;
use barrelstack_input::writer::Writer;

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Kind, Range};
use super::free::{FreeInterface, clash};
use super::interface::{self, Basis};

section! {
    /// The ground of a three-dimensional scene: everything below a plane through the origin.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SpatialGround;
    /// The ground: everything below a plane through the origin.
    pub static GROUND = "ground-in-space";
    /// Slope of the ground along x, positive if it rises to the right.
    slope: f64 =
        Kind::Quantity(&[Dimension::ANGLE], Range::between(-1.5, 1.5)), Default::Value("\"0 deg\"");
    /// Name by which interfaces refer to the ground.
    kind: String = Kind::Text, Default::Value("\"ground\"");
}

/// A free scene in three dimensions: arbitrary bodies on a ground, instead of a stack.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialScene {
    /// The ground.
    pub ground: SpatialGround,
    /// Bodies, in the order of the file.
    pub bodies: Vec<SpatialBody>,
    /// Interfaces, in the order of the file.
    pub interfaces: Vec<FreeInterface>,
}

/// Maximum number of bodies of a three-dimensional scene. The number is limited because all pairs of bodies are listed.
const MOST_BODIES: usize = 500;

/// Maximum number of pairs of solids in a three-dimensional scene, including pairs that have no interface.
const MOST_PAIRS: usize = 1_000_000;

/// Returns the number of solids of a body.
fn solids(body: &SpatialBody) -> usize {
    if let Solid::Compound { parts } = &body.solid { parts.len() } else { 1 }
}

/// Reads the fields of a three-dimensional scene from the top level of the file.
pub(super) fn read(root: &Reader<'_>) -> Result<SpatialScene, ScenarioError> {
    let ground = SpatialGround::read(root.section("ground")?)?;
    let mut bodies: Vec<SpatialBody> = Vec::new();
    // Number of pairs so far, and number of solids before the next body, including the ground.
    let (mut pairs, mut before) = (0_usize, 1_usize);
    for reader in root.sections("body")? {
        if bodies.len() == MOST_BODIES {
            let message = format!("a three-dimensional scene has at most {MOST_BODIES} bodies");
            return Err(reader.inconsistent("name", message));
        }
        let name = reader.text("name")?;
        // The name "ground" is reserved for the ground of the model.
        if name == "ground" || bodies.iter().any(|body| body.name == name) {
            let message = format!("two bodies are called \"{name}\"; give each its own name");
            return Err(reader.inconsistent("name", message));
        }
        let column = column_name(&name);
        if column == "ground" || bodies.iter().any(|body| column_name(&body.name) == column) {
            return Err(reader.inconsistent("name", clash(&name, &column)));
        }
        // The error is prepared here, because reading the body consumes the reader.
        let refuse = reader.inconsistent(
            "solid",
            format!(
                "with this body the scene has more than {MOST_PAIRS} pairs of solids: use fewer bodies or parts"
            ),
        );
        let body = SpatialBody::checked(reader)?;
        let new = solids(&body);
        pairs = pairs.saturating_add(new.saturating_mul(before));
        before += new;
        if pairs > MOST_PAIRS {
            return Err(refuse);
        }
        bodies.push(body);
    }
    if bodies.is_empty() {
        return Err(root.missing("body"));
    }
    let interfaces = read_interfaces(root, &ground, &bodies)?;
    Ok(SpatialScene { ground, bodies, interfaces })
}

fn read_interfaces(
    root: &Reader<'_>,
    ground: &SpatialGround,
    bodies: &[SpatialBody],
) -> Result<Vec<FreeInterface>, ScenarioError> {
    let all = bodies.iter().map(SpatialBody::kind).chain([ground.kind.as_str()]);
    let mut known = BTreeSet::new();
    let kinds: Vec<&str> = all.filter(|kind| known.insert(*kind)).collect();
    let mut interfaces: Vec<FreeInterface> = Vec::new();
    for reader in root.sections("interface")? {
        let between = reader.pair("between")?;
        if let Some(kind) = between.iter().find(|kind| !kinds.contains(&kind.as_str())) {
            let message = format!("no body is of the kind \"{kind}\"; {}", advice(kind, &kinds));
            return Err(reader.inconsistent("between", message));
        }
        // Two solids form one contact pair, whatever their order.
        let same = |other: &FreeInterface| {
            other.between == between || other.between.iter().rev().eq(&between)
        };
        if interfaces.iter().any(same) {
            let message = format!(
                "there are two interfaces between \"{}\" and \"{}\"; keep one of them",
                between[0], between[1]
            );
            return Err(reader.inconsistent("between", message));
        }
        if reader.choice::<Basis>("basis")? == Basis::Length {
            let message = "constants per length of boundary are valid only in a plane; in three dimensions, state \
                           stiffness and damping per contact, with basis = \"node\""
                .to_owned();
            return Err(reader.inconsistent("basis", message));
        }
        let within_groups = reader.flag("within_groups")?;
        let law = interface::read(reader, None)?;
        interfaces.push(FreeInterface { between, within_groups, law });
    }
    Ok(interfaces)
}

/// Writes a three-dimensional scene to the top level of the file.
pub(super) fn write(writer: &mut Writer, scene: &SpatialScene) {
    writer.table("ground", scene.ground.write());
    writer.tables("body", scene.bodies.iter().map(SpatialBody::write).collect());
    let interfaces = scene.interfaces.iter().map(interface::write_free).collect();
    writer.tables("interface", interfaces);
}
