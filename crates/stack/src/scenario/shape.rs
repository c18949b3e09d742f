//! Outlines of the bodies of a free scene.

use std::f64::consts::PI;

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Field, Kind, Named, Range, Section, Variant, Variants, names};
use super::reader::Reader;
use super::tree::Table;
use super::uniform::{area, cross, sides};
use super::writer::Writer;

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
    /// Several outlines that are one body; the reference point is the local origin.
    Compound {
        /// Its parts.
        parts: Vec<PartShape>,
    },
}

/// One outline of several that are one body.
#[derive(Debug, Clone, PartialEq)]
pub struct PartShape {
    /// The outline, no compound itself.
    pub shape: Shape,
    /// Place of its reference point `[x, z]` in the body (m).
    pub offset: [f64; 2],
    /// How it is turned in the body, counterclockwise (rad).
    pub turn: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ShapeName {
    Rectangle,
    Circle,
    Polygon,
    Cradle,
    BarrelProfile,
    Compound,
}

impl Named for ShapeName {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("rectangle", Self::Rectangle),
        ("circle", Self::Circle),
        ("polygon", Self::Polygon),
        ("cradle", Self::Cradle),
        ("barrel-profile", Self::BarrelProfile),
        ("compound", Self::Compound),
    ];
}

/// What a part of a compound may be.
fn part_names() -> Vec<&'static str> {
    let mut all = names::<ShapeName>();
    all.retain(|name| *name != "compound");
    all
}

const SIZE: Kind =
    Kind::Quantity(&[Dimension::LENGTH], Range { least: 1e-4, above: false, greatest: 1e4 });

/// Most corners of a polygon.
const MOST_CORNERS: usize = 200;

const RECTANGLE: Variant = Variant {
    name: "rectangle",
    help: "The reference point is the middle.",
    fields: &[
        Field::new("width", SIZE, Default::Required, "Along local x."),
        Field::new("height", SIZE, Default::Required, "Along local z."),
        Field::new(
            "corner_radius",
            Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 1e4)),
            Default::Value("\"0 m\""),
            "Radius of the rounded corners.",
        ),
    ],
};

const CIRCLE: Variant = Variant {
    name: "circle",
    help: "The reference point is the center.",
    fields: &[Field::new("radius", SIZE, Default::Required, "Radius.")],
};

const POLYGON: Variant = Variant {
    name: "polygon",
    help: "The reference point is the local origin.",
    fields: &[Field::new(
        "vertices",
        Kind::Points(Dimension::LENGTH),
        Default::Required,
        "Corners in order; sides must not cross.",
    )],
};

const CRADLE: Variant = Variant {
    name: "cradle",
    help: "A circular trough open upward; the reference point is the center of the circle.",
    fields: &[
        Field::new("radius", SIZE, Default::Required, "Radius."),
        Field::new(
            "half_angle",
            Kind::Quantity(&[Dimension::ANGLE], Range::up_to(PI)),
            Default::Required,
            "Half of the angle spanned, from the lowest point.",
        ),
    ],
};

const BARREL_PROFILE: Variant = Variant {
    name: "barrel-profile",
    help: "A barrel seen from the side, axis along local x; the reference point is the middle.",
    fields: &[
        Field::new("length", SIZE, Default::Required, "Length."),
        Field::new("bilge_diameter", SIZE, Default::Required, "Diameter at the middle."),
        Field::new("head_diameter", SIZE, Default::Required, "Diameter at the ends."),
    ],
};

const TYPE: Field =
    Field::new("type", Kind::Choice(names::<ShapeName>), Default::Required, "Form of the outline.");

/// An outline.
pub static SHAPE: Section = Section {
    name: "shape",
    help: "Outline of a body, about its reference point.",
    fields: &[TYPE],
    variants: Some(Variants {
        tag: "type",
        list: &[
            RECTANGLE,
            CIRCLE,
            POLYGON,
            CRADLE,
            BARREL_PROFILE,
            Variant {
                name: "compound",
                help: "Several outlines that are one body; the reference point is the local origin.",
                fields: &[Field::new(
                    "parts",
                    Kind::Tables(&PART),
                    Default::Required,
                    "The outlines; where they overlap, matter counts twice.",
                )],
            },
        ],
    }),
    exclusive: &[],
};

/// An outline of a compound.
static PART: Section = Section {
    name: "part",
    help: "One outline of several that are one body.",
    fields: &[
        Field::new("shape", Kind::Table(&PART_SHAPE), Default::Required, "Outline."),
        Field::new(
            "offset",
            Kind::Point(Dimension::LENGTH),
            Default::Value("[\"0 m\", \"0 m\"]"),
            "Place of its reference point in the body.",
        ),
        Field::new(
            "turn",
            Kind::Quantity(&[Dimension::ANGLE], Range::between(-100.0, 100.0)),
            Default::Value("\"0 deg\""),
            "How it is turned in the body, counterclockwise.",
        ),
    ],
    variants: None,
    exclusive: &[],
};

static PART_SHAPE: Section = Section {
    name: "part-shape",
    help: "Outline of a part, about its reference point.",
    fields: &[Field::new(
        "type",
        Kind::Choice(part_names),
        Default::Required,
        "Form of the outline, no compound itself.",
    )],
    variants: Some(Variants {
        tag: "type",
        list: &[RECTANGLE, CIRCLE, POLYGON, CRADLE, BARREL_PROFILE],
    }),
    exclusive: &[],
};

/// Reads an outline.
pub(super) fn read(reader: Reader<'_>) -> Result<Shape, ScenarioError> {
    let shape = match reader.choice::<ShapeName>("type")? {
        ShapeName::Rectangle => {
            let (width, height) = (reader.quantity("width")?, reader.quantity("height")?);
            let corner_radius = reader.quantity("corner_radius")?;
            if 2.0 * corner_radius >= width.min(height) {
                let message = format!(
                    "`{}` of {corner_radius} m does not fit in {width} m by {height} m",
                    reader.path_of("corner_radius")
                );
                return Err(reader.inconsistent("corner_radius", message));
            }
            Shape::Rectangle { width, height, corner_radius }
        }
        ShapeName::Circle => Shape::Circle { radius: reader.quantity("radius")? },
        ShapeName::Polygon => Shape::Polygon { vertices: read_vertices(&reader)? },
        ShapeName::Cradle => Shape::Cradle {
            radius: reader.quantity("radius")?,
            half_angle: reader.quantity("half_angle")?,
        },
        ShapeName::BarrelProfile => {
            let bilge_diameter = reader.quantity("bilge_diameter")?;
            let head_diameter = reader.quantity("head_diameter")?;
            if head_diameter > bilge_diameter {
                let message = format!(
                    "`{}` is {head_diameter} m, more than the bilge of {bilge_diameter} m; a barrel is widest at the \
                     bilge",
                    reader.path_of("head_diameter")
                );
                return Err(reader.inconsistent("head_diameter", message));
            }
            Shape::BarrelProfile {
                length: reader.quantity("length")?,
                bilge_diameter,
                head_diameter,
            }
        }
        ShapeName::Compound => Shape::Compound { parts: read_parts(&reader)? },
    };
    reader.finish();
    Ok(shape)
}

fn read_parts(reader: &Reader<'_>) -> Result<Vec<PartShape>, ScenarioError> {
    let mut parts = Vec::new();
    for part in reader.sections("parts")? {
        let shape = read(part.section("shape")?)?;
        parts.push(PartShape {
            shape,
            offset: part.point("offset")?,
            turn: part.quantity("turn")?,
        });
        part.finish();
    }
    if !parts.iter().any(|part| part.shape.area() > 0.0) {
        let message = "a compound needs a part that encloses an area".to_owned();
        return Err(reader.inconsistent("parts", message));
    }
    Ok(parts)
}

/// Reads the corners and turns them counterclockwise.
fn read_vertices(reader: &Reader<'_>) -> Result<Vec<[f64; 2]>, ScenarioError> {
    let mut vertices = reader.points("vertices")?;
    let wrong = |message: String| Err(reader.inconsistent("vertices", message));
    if !(3..=MOST_CORNERS).contains(&vertices.len()) {
        return wrong(format!(
            "a polygon has from 3 to {MOST_CORNERS} corners, found {}",
            vertices.len()
        ));
    }
    for (i, side) in sides(&vertices).enumerate() {
        for (j, other) in sides(&vertices).enumerate().skip(i + 1) {
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
    let turned = area(&vertices);
    if turned.abs() < 1e-8 {
        return wrong(
            "the polygon has no area; list corners that do not lie on one line".to_owned(),
        );
    }
    if turned < 0.0 {
        vertices.reverse();
    }
    Ok(vertices)
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

/// Writes an outline.
pub(super) fn write(shape: &Shape) -> Table {
    match shape {
        Shape::Compound { parts } => {
            let mut writer = Writer::variant(&SHAPE, ShapeName::Compound);
            let part = |part: &PartShape| {
                let mut writer = Writer::new(&PART);
                writer.table("shape", write(&part.shape));
                writer.point("offset", part.offset);
                writer.quantity("turn", part.turn);
                writer.finish()
            };
            writer.tables("parts", parts.iter().map(part).collect());
            writer.finish()
        }
        Shape::Rectangle { width, height, corner_radius } => {
            let mut writer = Writer::variant(&SHAPE, ShapeName::Rectangle);
            writer.quantity("width", *width);
            writer.quantity("height", *height);
            writer.quantity("corner_radius", *corner_radius);
            writer.finish()
        }
        Shape::Circle { radius } => {
            let mut writer = Writer::variant(&SHAPE, ShapeName::Circle);
            writer.quantity("radius", *radius);
            writer.finish()
        }
        Shape::Polygon { vertices } => {
            let mut writer = Writer::variant(&SHAPE, ShapeName::Polygon);
            writer.points("vertices", vertices);
            writer.finish()
        }
        Shape::Cradle { radius, half_angle } => {
            let mut writer = Writer::variant(&SHAPE, ShapeName::Cradle);
            writer.quantity("radius", *radius);
            writer.quantity("half_angle", *half_angle);
            writer.finish()
        }
        Shape::BarrelProfile { length, bilge_diameter, head_diameter } => {
            let mut writer = Writer::variant(&SHAPE, ShapeName::BarrelProfile);
            writer.quantity("length", *length);
            writer.quantity("bilge_diameter", *bilge_diameter);
            writer.quantity("head_diameter", *head_diameter);
            writer.finish()
        }
    }
}
