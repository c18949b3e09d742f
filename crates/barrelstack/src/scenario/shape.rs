//! Outlines of the bodies of a free scene.

use std::f64::consts::PI;

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Field, Kind, Named, Range, Section, Variant, Variants, names};
use super::reader::Reader;
use super::tree::Table;
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

/// Mass properties of a uniform plate, or of a uniform arc for a cradle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uniform {
    /// Center of mass, from the reference point (m).
    pub centroid: [f64; 2],
    /// Moment of inertia about the center of mass over the mass (m²).
    pub square_radius: f64,
}

impl Shape {
    /// The outlines it is made of: itself, but for a compound.
    pub fn parts(&self) -> Vec<PartShape> {
        match self {
            Self::Compound { parts } => parts.clone(),
            Self::Rectangle { .. }
            | Self::Circle { .. }
            | Self::Polygon { .. }
            | Self::Cradle { .. }
            | Self::BarrelProfile { .. } => {
                vec![PartShape { shape: self.clone(), offset: [0.0, 0.0], turn: 0.0 }]
            }
        }
    }

    /// Mass properties of a uniform plate of this outline; of a uniform arc for a cradle. Where parts of a
    /// compound overlap, matter counts twice; cradles among them, which have no area, count nothing.
    pub fn uniform(&self) -> Uniform {
        match self {
            Self::Rectangle { width, height, corner_radius } => Uniform {
                centroid: [0.0, 0.0],
                square_radius: rounded_rectangle(*width, *height, *corner_radius),
            },
            Self::Circle { radius } => {
                Uniform { centroid: [0.0, 0.0], square_radius: 0.5 * radius * radius }
            }
            Self::Polygon { vertices } => polygon(vertices),
            Self::Cradle { radius, half_angle } => {
                let depth = radius * libm::sin(*half_angle) / half_angle;
                Uniform { centroid: [0.0, -depth], square_radius: radius * radius - depth * depth }
            }
            Self::BarrelProfile { length, bilge_diameter, head_diameter } => {
                let (area, moment) = barrel_profile(*length, *bilge_diameter, *head_diameter);
                Uniform { centroid: [0.0, 0.0], square_radius: moment / area }
            }
            Self::Compound { parts } => compound(parts),
        }
    }

    /// Area enclosed (m²).
    fn area(&self) -> f64 {
        match self {
            Self::Rectangle { width, height, corner_radius } => {
                width * height - (4.0 - PI) * corner_radius * corner_radius
            }
            Self::Circle { radius } => PI * radius * radius,
            Self::Polygon { vertices } => area(vertices),
            Self::Cradle { .. } => 0.0,
            Self::BarrelProfile { length, bilge_diameter, head_diameter } => {
                barrel_profile(*length, *bilge_diameter, *head_diameter).0
            }
            Self::Compound { parts } => parts.iter().map(|part| part.shape.area()).sum(),
        }
    }

    /// Length of the boundary (m); that of the enclosing box for a barrel profile.
    pub fn perimeter(&self) -> f64 {
        match self {
            Self::Rectangle { width, height, corner_radius } => {
                2.0 * (width + height) - (8.0 - 2.0 * PI) * corner_radius
            }
            Self::Circle { radius } => 2.0 * PI * radius,
            Self::Polygon { vertices } => sides(vertices)
                .map(|(a, b)| (b[0] - a[0], b[1] - a[1]))
                .map(|(x, z)| (x * x + z * z).sqrt())
                .sum(),
            Self::Cradle { radius, half_angle } => 2.0 * half_angle * radius,
            Self::BarrelProfile { length, bilge_diameter, .. } => 2.0 * (length + bilge_diameter),
            Self::Compound { parts } => parts.iter().map(|part| part.shape.perimeter()).sum(),
        }
    }
}

/// Parts of one density, each about its own centroid and shifted from there.
fn compound(parts: &[PartShape]) -> Uniform {
    let placed = || {
        parts.iter().map(|part| {
            let own = part.shape.uniform();
            let (sin, cos) = (libm::sin(part.turn), libm::cos(part.turn));
            let [x, z] = own.centroid;
            let place = [part.offset[0] + cos * x - sin * z, part.offset[1] + sin * x + cos * z];
            (part.shape.area(), place, own.square_radius)
        })
    };
    let area: f64 = placed().map(|(area, ..)| area).sum();
    let mean = |axis: usize| placed().map(|(part, at, _)| part * at[axis]).sum::<f64>() / area;
    let centroid = [mean(0), mean(1)];
    let about = |(part, at, own): (f64, [f64; 2], f64)| {
        let (x, z) = (at[0] - centroid[0], at[1] - centroid[1]);
        part / area * (own + x * x + z * z)
    };
    Uniform { centroid, square_radius: placed().map(about).sum() }
}

/// Polar moment over area of a rectangle with rounded corners (m²).
fn rounded_rectangle(w: f64, h: f64, r: f64) -> f64 {
    let (square, quarter) = (r * r, 0.25 * PI * r * r);
    // A square corner goes and a quarter of a disk comes, each shifted from its own centroid.
    let (u, v) = (0.5 * (w - r), 0.5 * (h - r));
    let corner = square * (square / 6.0 + u * u + v * v);
    let offset = 4.0 * r / (3.0 * PI);
    let own = 0.125 * PI * square * square - quarter * 2.0 * offset * offset;
    let (u, v) = (0.5 * w - r + offset, 0.5 * h - r + offset);
    let disk = own + quarter * (u * u + v * v);
    let area = w * h - 4.0 * (square - quarter);
    (w * h * (w * w + h * h) / 12.0 - 4.0 * (corner - disk)) / area
}

fn sides(vertices: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    (0..vertices.len()).map(|i| (vertices[i], vertices[(i + 1) % vertices.len()]))
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Area (m²), positive when counterclockwise.
fn area(vertices: &[[f64; 2]]) -> f64 {
    0.5 * sides(vertices).map(|(a, b)| cross(a, b)).sum::<f64>()
}

fn polygon(vertices: &[[f64; 2]]) -> Uniform {
    let area = area(vertices);
    let mut centroid = [0.0, 0.0];
    let mut second = 0.0;
    for (a, b) in sides(vertices) {
        let c = cross(a, b);
        centroid[0] += (a[0] + b[0]) * c / (6.0 * area);
        centroid[1] += (a[1] + b[1]) * c / (6.0 * area);
        let square = |p: [f64; 2], q: [f64; 2]| p[0] * q[0] + p[1] * q[1];
        second += c * (square(a, a) + square(a, b) + square(b, b)) / 12.0;
    }
    let shift = centroid[0] * centroid[0] + centroid[1] * centroid[1];
    Uniform { centroid, square_radius: second / area - shift }
}

/// Area (m²) and polar moment of area (m⁴) between `±r(x)`, with `r` the parabola of the barrel.
fn barrel_profile(length: f64, bilge: f64, head: f64) -> (f64, f64) {
    // r = b - s u², x = L u / 2, integrated over u from 0 to 1 and doubled.
    let (b, s, half) = (0.5 * bilge, 0.5 * (bilge - head), 0.5 * length);
    let mean = b - s / 3.0;
    let mean_with_square = b / 3.0 - s / 5.0;
    let mean_cube = b * b * b - b * b * s + 0.6 * b * s * s - s * s * s / 7.0;
    let area = 4.0 * half * mean;
    let moment = 4.0 * half * (half * half * mean_with_square + mean_cube / 3.0);
    (area, moment)
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
    fields: &[TYPE],
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
            if 2.0 * corner_radius > width.min(height) {
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
