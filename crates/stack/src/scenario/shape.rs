//! Outlines of the bodies of a free scene.

use std::f64::consts::PI;

use barrelstack_input::choices::Chosen;
use barrelstack_input::declared::Held;
use barrelstack_input::{choices, section, table};

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Kind, Range, Variant};
use super::reader::Reader;
use super::uniform::{area, cross, sides};
use super::writer::Writer;

choices! {
    /// Outline of a body, relative to its reference point.
    ///
    /// All numbers are in SI units.
    #[derive(Debug, Clone, PartialEq)]
    pub enum Shape;
    /// The shapes that an outline can have.
    static SHAPES;
    /// A rectangle; the reference point is the middle.
    Rectangle = "rectangle" {
        /// Length of the side along local x.
        width: f64 = SIZE, Default::Required;
        /// Length of the side along local z.
        height: f64 = SIZE, Default::Required;
        /// Radius of the rounded corners.
        corner_radius: f64 =
            Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 1e4)), Default::Value("\"0 m\"");
    }
    /// A circle; the reference point is the center.
    Circle = "circle" {
        /// Radius.
        radius: f64 = SIZE, Default::Required;
    }
    /// A polygon; the reference point is the local origin.
    Polygon = "polygon" {
        /// Corners in order around the polygon; sides must not cross.
        vertices: Vec<[f64; 2]> = Kind::Points(Dimension::LENGTH), Default::Required;
    }
    /// A circular trough that is open at the top; the reference point is the center of the circle.
    Cradle = "cradle" {
        /// Radius.
        radius: f64 = SIZE, Default::Required;
        /// Half the angle that the trough spans: the angle from its lowest point to its edge.
        half_angle: f64 =
            Kind::Quantity(&[Dimension::ANGLE], Range::up_to(PI)), Default::Required;
    }
    /// A barrel in side view with its axis along local x; the reference point is the middle.
    BarrelProfile = "barrel-profile" {
        /// Length of the barrel.
        length: f64 = SIZE, Default::Required;
        /// Diameter of the barrel at its middle.
        bilge_diameter: f64 = SIZE, Default::Required;
        /// Diameter of the barrel at its ends.
        head_diameter: f64 = SIZE, Default::Required;
    }
    /// Several outlines joined into one rigid body; the reference point is the local origin.
    Compound = "compound" {
        /// The outlines; where two of them overlap, the mass of the overlap counts twice.
        parts: Vec<PartShape> = Kind::Tables(&PART), Default::Required;
    }
}

/// Shapes that a part of a compound may have: all but the last, which is the compound itself.
static OF_PARTS: &[Variant] = SHAPES.split_at(SHAPES.len() - 1).0;

/// Returns the names of the shapes that a part of a compound may have.
fn part_names() -> Vec<&'static str> {
    OF_PARTS.iter().map(|variant| variant.name).collect()
}

const SIZE: Kind =
    Kind::Quantity(&[Dimension::LENGTH], Range { least: 1e-4, above: false, greatest: 1e4 });

/// Maximum number of corners of a polygon.
const MOST_CORNERS: usize = 200;

table! {
    /// Outline of a body, relative to its reference point.
    pub static SHAPE = "shape";
    /// Shape of the outline.
    type = Kind::Choice(Shape::names), Default::Required;
    of SHAPES, by type;
}

section! {
    /// One part of a compound.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PartShape;
    /// One outline of a compound, with its placement in the body.
    static PART = "part";
    /// Outline of the part.
    shape: Shape = Kind::Table(&PART_SHAPE), Default::Required;
    /// Position of the reference point of the part in the body.
    offset: [f64; 2] = Kind::Point(Dimension::LENGTH), Default::Value("[\"0 m\", \"0 m\"]");
    /// Rotation of the part in the body, counterclockwise.
    turn: f64 =
        Kind::Quantity(&[Dimension::ANGLE], Range::between(-100.0, 100.0)), Default::Value("\"0 deg\"");
}

table! {
    /// Outline of a part, relative to its reference point.
    static PART_SHAPE = "part-shape";
    /// Shape of the outline; not a compound.
    type = Kind::Choice(part_names), Default::Required;
    of *OF_PARTS, by type;
}

/// Reads and writes an outline as a table.
impl Held for Shape {
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, ScenarioError> {
        read(reader.section(name)?)
    }

    fn write(&self, writer: &mut Writer, name: &'static str) {
        writer.table(name, self.write_as(&SHAPE));
    }
}

/// Reads an outline.
pub(super) fn read(reader: Reader<'_>) -> Result<Shape, ScenarioError> {
    let mut shape = Shape::read_chosen(&reader)?;
    match &mut shape {
        Shape::Rectangle { width, height, corner_radius }
            if 2.0 * *corner_radius >= width.min(*height) =>
        {
            let message = format!(
                "`{}` of {corner_radius} m is too large for a rectangle of {width} m by {height} m",
                reader.path_of("corner_radius")
            );
            return Err(reader.inconsistent("corner_radius", message));
        }
        Shape::BarrelProfile { bilge_diameter, head_diameter, .. }
            if *head_diameter > *bilge_diameter =>
        {
            let message = format!(
                "`{}` is {head_diameter} m, more than the bilge of {bilge_diameter} m; a barrel is widest at the \
                 bilge",
                reader.path_of("head_diameter")
            );
            return Err(reader.inconsistent("head_diameter", message));
        }
        Shape::Compound { parts } if !parts.iter().any(|part| part.shape.area() > 0.0) => {
            let message = "a compound needs a part that encloses an area".to_owned();
            return Err(reader.inconsistent("parts", message));
        }
        Shape::Polygon { vertices } => check_vertices(&reader, vertices)?,
        Shape::Rectangle { .. }
        | Shape::Circle { .. }
        | Shape::Cradle { .. }
        | Shape::BarrelProfile { .. }
        | Shape::Compound { .. } => {}
    }
    reader.finish();
    Ok(shape)
}

/// Checks the corners and orders them counterclockwise.
fn check_vertices(reader: &Reader<'_>, vertices: &mut [[f64; 2]]) -> Result<(), ScenarioError> {
    let wrong = |message: String| Err(reader.inconsistent("vertices", message));
    if !(3..=MOST_CORNERS).contains(&vertices.len()) {
        return wrong(format!(
            "a polygon has from 3 to {MOST_CORNERS} corners, found {}",
            vertices.len()
        ));
    }
    for (i, side) in sides(vertices).enumerate() {
        for (j, other) in sides(vertices).enumerate().skip(i + 1) {
            let neighbors = j == i + 1 || (i == 0 && j == vertices.len() - 1);
            if !neighbors && cross_each_other(side, other) {
                return wrong(format!(
                    "sides {} and {} of the polygon touch; list the corners in order around it",
                    i + 1,
                    j + 1
                ));
            }
        }
    }
    let turned = area(vertices);
    if turned.abs() < 1e-8 {
        return wrong(
            "the polygon has no area; list corners that do not lie on one line".to_owned(),
        );
    }
    if turned < 0.0 {
        vertices.reverse();
    }
    Ok(())
}

fn cross_each_other((a, b): ([f64; 2], [f64; 2]), (c, d): ([f64; 2], [f64; 2])) -> bool {
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        cross([q[0] - p[0], q[1] - p[1]], [r[0] - p[0], r[1] - p[1]])
    };
    let apart = |x: f64, y: f64| (x > 0.0 && y > 0.0) || (x < 0.0 && y < 0.0);
    let boxes_apart =
        (0..2).any(|k| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]));
    !(boxes_apart || apart(side(a, b, c), side(a, b, d)) || apart(side(c, d, a), side(c, d, b)))
}
