//! Contact nodes on the boundary of a body of a free scene.

use barrelstack_input::declared::Held;
use barrelstack_input::{named, section, table};

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Kind, Range, names};
use super::reader::Reader;
use super::shape::Shape;
use super::tree::Table;
use super::writer::Writer;

/// Placement of contact nodes on the boundary of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum Nodes {
    /// A node at each corner.
    Corners,
    /// Nodes along the boundary, including the corners, with at most this spacing (m).
    Spacing(f64),
    /// The given number of nodes on each side, or around a curved shape.
    Count(u32),
    /// One node, at the point of a circle that is deepest in the target.
    Rolling,
    /// No nodes: the contact point of every corner and arc of a convex outline is the point that lies deepest in the
    /// other body.
    Exact,
    /// Nodes at chosen points.
    At(Vec<ChosenNode>),
}

section! {
    /// A node at a chosen point.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct ChosenNode;
    /// A contact node at a chosen point.
    static NODE = "node";
    /// Position of the node in the body, relative to the reference point of the shape.
    at: [f64; 2] = Kind::Point(Dimension::LENGTH), Default::Required;
    /// Length of boundary that the node represents; used if constants are stated per meter of boundary.
    tributary_length: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::POSITIVE), Default::Value("\"1 cm\"");
}

named! {
    pub(super) enum NodeRule {
        Corners = "corners",
        Rolling = "rolling",
        Exact = "exact",
    }
}

/// Maximum number of contact nodes of one body.
const MOST_NODES: f64 = 20_000.0;

table! {
    /// Contact nodes of a boundary, given by one of the fields.
    pub static NODES = "nodes";
    /// Rule for the nodes: nodes at the corners, one node at the deepest point of a circle, or exact contact. With
    /// exact contact, the contact point of every corner and arc of the convex outline is the point that lies deepest in
    /// the other body. If both bodies have exact contact, the corners and arcs of both are tested for contact.
    rule = Kind::Choice(names::<NodeRule>), Default::Nothing;
    /// Largest distance between nodes along the boundary.
    spacing = Kind::Quantity(&[Dimension::LENGTH], Range { least: 1e-4, above: false, greatest: 1e3 }),
        Default::Nothing;
    /// Number of nodes on each side, or around a curved shape.
    count = Kind::Integer(1, 2000), Default::Nothing;
    /// Nodes at chosen points.
    list = Kind::Tables(&NODE), Default::Nothing;
    at most one of &["rule", "spacing", "count", "list"];
}

/// Reads the nodes of a boundary; without a shape, only nodes at chosen points are allowed.
pub(super) fn read(reader: &Reader<'_>, shape: Option<&Shape>) -> Result<Nodes, ScenarioError> {
    let Some(nodes) = reader.optional_section("nodes")? else {
        let Some(shape) = shape else { return Err(reader.missing("nodes")) };
        return Ok(match shape {
            Shape::Circle { .. } => Nodes::Rolling,
            Shape::Rectangle { .. } | Shape::Polygon { .. } => Nodes::Corners,
            Shape::Cradle { .. } | Shape::BarrelProfile { .. } | Shape::Compound { .. } => {
                Nodes::Spacing(0.01)
            }
        });
    };
    let rule: Option<NodeRule> = nodes.optional_choice("rule")?;
    let spacing = nodes.optional_quantity("spacing")?;
    let count = nodes.optional_integer("count")?;
    let list = Vec::<ChosenNode>::read(&nodes, "list")?;
    let rule = rule
        .map(|rule| match rule {
            NodeRule::Corners => Nodes::Corners,
            NodeRule::Rolling => Nodes::Rolling,
            NodeRule::Exact => Nodes::Exact,
        })
        .or(spacing.map(Nodes::Spacing))
        .or(count.map(Nodes::Count))
        .or((!list.is_empty()).then_some(Nodes::At(list)))
        .ok_or_else(|| nodes.one_of(&["rule", "spacing", "count", "list"]))?;
    let Some(shape) = shape else {
        if !matches!(rule, Nodes::At(_)) {
            let message = "a boundary without a shape has nodes at chosen points only; write \
                           `nodes = { list = [{ at = [\"0 m\", \"0 m\"] }] }`, or give it a shape";
            let found = ["rule", "spacing", "count"].into_iter().find(|field| nodes.has(field));
            return Err(nodes.inconsistent(found.unwrap_or("rule"), message.to_owned()));
        }
        nodes.finish();
        return Ok(rule);
    };
    let parts = shape.parts();
    let circle = parts.iter().all(|part| matches!(part.shape, Shape::Circle { .. }));
    let cradle = parts.iter().any(|part| matches!(part.shape, Shape::Cradle { .. }));
    match rule {
        Nodes::Exact if cradle => {
            let message = "a cradle is not convex; set a spacing for its nodes";
            return Err(nodes.inconsistent("rule", message.to_owned()));
        }
        Nodes::Rolling if !circle => {
            let message =
                "only a circle rolls on one node; write `nodes = \"corners\"` or a spacing";
            return Err(nodes.inconsistent("rule", message.to_owned()));
        }
        Nodes::Corners if circle => {
            let message = "a circle has no corners; write `nodes = \"rolling\"` or a spacing";
            return Err(nodes.inconsistent("rule", message.to_owned()));
        }
        Nodes::Spacing(spacing) if shape.perimeter() / spacing > MOST_NODES => {
            let message = format!(
                "a spacing of {spacing} m puts more than {MOST_NODES} nodes on a boundary of {} m; take a wider spacing",
                shape.perimeter()
            );
            return Err(nodes.inconsistent("spacing", message));
        }
        Nodes::Count(count) if number(&rule, Some(shape)) > MOST_NODES => {
            let message = format!(
                "{count} nodes on each side make more than {MOST_NODES} nodes on the whole boundary; state a \
                 smaller number"
            );
            return Err(nodes.inconsistent("count", message));
        }
        Nodes::Rolling
        | Nodes::Corners
        | Nodes::Exact
        | Nodes::Spacing(_)
        | Nodes::Count(_)
        | Nodes::At(_) => {}
    }
    nodes.finish();
    Ok(rule)
}

/// Estimates the number of nodes of a boundary. Corners may change the actual number by a few nodes.
pub(super) fn number(nodes: &Nodes, shape: Option<&Shape>) -> f64 {
    let sides = |shape: &Shape| match shape {
        Shape::Polygon { vertices } => vertices.len() as f64,
        Shape::Circle { .. } => 1.0,
        Shape::Rectangle { .. }
        | Shape::Cradle { .. }
        | Shape::BarrelProfile { .. }
        | Shape::Compound { .. } => 4.0,
    };
    let all = |shape: &Shape| shape.parts().iter().map(|part| sides(&part.shape)).sum::<f64>();
    match (nodes, shape) {
        (Nodes::At(list), _) => list.len() as f64,
        (_, None) => 0.0,
        (Nodes::Spacing(spacing), Some(shape)) => shape.perimeter() / spacing,
        (Nodes::Count(count), Some(shape)) => f64::from(*count) * all(shape),
        (Nodes::Rolling | Nodes::Corners | Nodes::Exact, Some(shape)) => all(shape),
    }
}

/// Writes the nodes of a boundary.
pub(super) fn write(nodes: &Nodes) -> Table {
    let mut writer = Writer::new(&NODES);
    match nodes {
        Nodes::Corners => writer.choice("rule", NodeRule::Corners),
        Nodes::Rolling => writer.choice("rule", NodeRule::Rolling),
        Nodes::Exact => writer.choice("rule", NodeRule::Exact),
        Nodes::Spacing(spacing) => writer.quantity("spacing", *spacing),
        Nodes::Count(count) => writer.integer("count", *count),
        Nodes::At(list) => list.write(&mut writer, "list"),
    }
    writer.omit(&["rule", "spacing", "count", "list"]);
    writer.finish()
}
