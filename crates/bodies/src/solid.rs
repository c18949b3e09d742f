//! Solids of bodies in space as a file states them: ball, capsule, block, barrel, half-space, and several as one.

use barrelstack_dynamics::solid::Barrel;
use barrelstack_input::declared::{Declared as _, Held};
use barrelstack_input::field::{Default, Field, Kind, Named, Range, Section, Variant, Variants};
use barrelstack_input::reader::Reader;
use barrelstack_input::tree::Table;
use barrelstack_input::writer::Writer;
use barrelstack_input::{Dimension, InputError, section};

/// A solid about its reference point.
#[derive(Debug, Clone, PartialEq)]
pub enum Solid {
    /// A ball; the reference point is its center.
    Ball {
        /// Radius (m).
        radius: f64,
    },
    /// A tube with round ends along local `x`; the reference point is its middle.
    Capsule {
        /// Length (m) with both ends.
        length: f64,
        /// Radius (m).
        radius: f64,
    },
    /// A block with rounded edges; the reference point is its middle.
    Block {
        /// Along local `x`, `y` and `z` (m).
        sides: [f64; 3],
        /// Radius (m) of its edges.
        rounding: f64,
    },
    /// A barrel with its axis along local `x`; the reference point is its middle.
    Barrel {
        /// Length (m).
        length: f64,
        /// Outer diameter (m) at the middle.
        bilge_diameter: f64,
        /// Outer diameter (m) at the ends.
        head_diameter: f64,
        /// Radius (m) of the chime between stave and head.
        chime_radius: f64,
    },
    /// All below local `z = 0`, for what is fixed to the ground.
    HalfSpace,
    /// Several solids that are one body; the reference point is the local origin.
    Compound {
        /// Its parts.
        parts: Vec<PartSolid>,
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SolidName {
    Ball,
    Capsule,
    Block,
    Barrel,
    HalfSpace,
    Compound,
}

impl Named for SolidName {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("ball", Self::Ball),
        ("capsule", Self::Capsule),
        ("block", Self::Block),
        ("barrel", Self::Barrel),
        ("half-space", Self::HalfSpace),
        ("compound", Self::Compound),
    ];
}

fn solid_names() -> Vec<&'static str> {
    barrelstack_input::field::names::<SolidName>()
}

/// What a part of a compound may be.
fn part_names() -> Vec<&'static str> {
    let bounded = |name: &&str| !["half-space", "compound"].contains(name);
    solid_names().into_iter().filter(bounded).collect()
}

/// Sizes of solids (m): far below a splinter and far above a building.
const SIZE: Kind =
    Kind::Quantity(&[Dimension::LENGTH], Range { least: 1e-4, above: false, greatest: 1e4 });

const BALL: Variant = Variant {
    name: "ball",
    help: "The reference point is the center.",
    fields: &[Field::new("radius", SIZE, Default::Required, "Radius.")],
};

const CAPSULE: Variant = Variant {
    name: "capsule",
    help: "A tube with round ends along local x; the reference point is the middle.",
    fields: &[
        Field::new("length", SIZE, Default::Required, "Length with both round ends."),
        Field::new("radius", SIZE, Default::Required, "Radius."),
    ],
};

const BLOCK: Variant = Variant {
    name: "block",
    help: "A block with rounded edges; the reference point is the middle. Its matter is that of one with sharp edges.",
    fields: &[
        Field::new(
            "sides",
            Kind::Triple(Dimension::LENGTH),
            Default::Required,
            "Along local x, y and z.",
        ),
        Field::new(
            "rounding",
            SIZE,
            Default::Value("\"5 mm\""),
            "Radius of the rounded edges, which contacts never sink in deeper than.",
        ),
    ],
};

const BARREL: Variant = Variant {
    name: "barrel",
    help: "A barrel with its axis along local x, homogeneous; the reference point is the middle.",
    fields: &[
        Field::new("length", SIZE, Default::Required, "Length."),
        Field::new("bilge_diameter", SIZE, Default::Required, "Diameter at the middle."),
        Field::new("head_diameter", SIZE, Default::Required, "Diameter at the ends."),
        Field::new(
            "chime_radius",
            SIZE,
            Default::Value("\"10 mm\""),
            "Radius of the rounded chime between stave and head.",
        ),
    ],
};

/// A solid.
pub static SOLID: Section = Section {
    name: "solid",
    help: "Solid of a body in space, about its reference point.",
    fields: &[Field::new(
        "type",
        Kind::Choice(solid_names),
        Default::Required,
        "Form of the solid.",
    )],
    variants: Some(Variants {
        tag: "type",
        list: &[
            BALL,
            CAPSULE,
            BLOCK,
            BARREL,
            Variant {
                name: "half-space",
                help: "All below local z = 0, such as a wall once it is turned; of a body fixed to the ground alone.",
                fields: &[],
            },
            Variant {
                name: "compound",
                help: "Several solids that are one body; the reference point is the local origin.",
                fields: &[Field::new(
                    "parts",
                    Kind::Tables(&PART),
                    Default::Required,
                    "The solids, all of one density; where they overlap, matter counts twice.",
                )],
            },
        ],
    }),
    exclusive: &[],
};

static PART_SOLID: Section = Section {
    name: "part-solid",
    help: "Solid of a part, about its reference point.",
    fields: &[Field::new(
        "type",
        Kind::Choice(part_names),
        Default::Required,
        "Form of the solid, bounded and no compound itself.",
    )],
    variants: Some(Variants { tag: "type", list: &[BALL, CAPSULE, BLOCK, BARREL] }),
    exclusive: &[],
};

/// The solid of a part; the same type, read from another table.
impl Held for Solid {
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, InputError> {
        read(reader.section(name)?)
    }

    fn write(&self, writer: &mut Writer, name: &'static str) {
        let section = writer.kind_of(name).section().unwrap_or(&SOLID);
        writer.table(name, write(self, section));
    }
}

section! {
    /// A solid of several that are one body.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PartSolid;
    /// One solid of several that are one body.
    pub static PART = "solid-part";
    /// Solid.
    solid: Solid = Kind::Table(&PART_SOLID), Default::Required;
    /// Place of its reference point in the body.
    offset: [f64; 3] = Kind::Triple(Dimension::LENGTH), Default::Value("[\"0 m\", \"0 m\", \"0 m\"]");
    /// How it is turned in the body: about x, then y, then z of the body, each counterclockwise.
    turn: [f64; 3] =
        Kind::Triple(Dimension::ANGLE), Default::Value("[\"0 deg\", \"0 deg\", \"0 deg\"]");
}

fn read(reader: Reader<'_>) -> Result<Solid, InputError> {
    let solid = match reader.choice::<SolidName>("type")? {
        SolidName::Ball => Solid::Ball { radius: reader.quantity("radius")? },
        SolidName::Capsule => {
            let (length, radius) = (reader.quantity("length")?, reader.quantity("radius")?);
            if length < 2.0 * radius {
                let message = format!(
                    "`{}` of {length} m holds no two round ends of {radius} m; it is at least {} m, a ball",
                    reader.path_of("length"),
                    2.0 * radius
                );
                return Err(reader.inconsistent("length", message));
            }
            Solid::Capsule { length, radius }
        }
        SolidName::Block => {
            let (sides, rounding) = (reader.triple("sides")?, reader.quantity("rounding")?);
            if sides.into_iter().any(|side| !(2e-4..=1e4).contains(&side)) {
                let message = format!(
                    "a side of `{}` is not between 0.0002 m and 10000 m; state all three as lengths above zero",
                    reader.path_of("sides")
                );
                return Err(reader.inconsistent("sides", message));
            }
            if sides.into_iter().any(|side| 2.0 * rounding >= side) {
                let least = sides.into_iter().fold(f64::INFINITY, f64::min);
                let message = format!(
                    "`{}` of {rounding} m does not fit twice in a side of {least} m; state a smaller one",
                    reader.path_of("rounding")
                );
                return Err(reader.inconsistent("rounding", message));
            }
            Solid::Block { sides, rounding }
        }
        SolidName::Barrel => {
            let length = reader.quantity("length")?;
            let bilge_diameter = reader.quantity("bilge_diameter")?;
            let head_diameter = reader.quantity("head_diameter")?;
            let chime_radius = reader.quantity("chime_radius")?;
            let (head, bilge) = (0.5 * head_diameter, 0.5 * bilge_diameter);
            if let Err(error) = Barrel::new(length, head, bilge, chime_radius) {
                return Err(reader.inconsistent("bilge_diameter", error.to_string()));
            }
            Solid::Barrel { length, bilge_diameter, head_diameter, chime_radius }
        }
        SolidName::HalfSpace => Solid::HalfSpace,
        SolidName::Compound => {
            let parts = reader.sections("parts")?.into_iter().map(PartSolid::read);
            let parts = parts.collect::<Result<Vec<_>, _>>()?;
            if parts.is_empty() {
                return Err(reader.missing("parts"));
            }
            Solid::Compound { parts }
        }
    };
    reader.finish();
    Ok(solid)
}

fn write(solid: &Solid, section: &'static Section) -> Table {
    let name = match solid {
        Solid::Ball { .. } => SolidName::Ball,
        Solid::Capsule { .. } => SolidName::Capsule,
        Solid::Block { .. } => SolidName::Block,
        Solid::Barrel { .. } => SolidName::Barrel,
        Solid::HalfSpace => SolidName::HalfSpace,
        Solid::Compound { .. } => SolidName::Compound,
    };
    let mut writer = Writer::variant(section, name);
    match solid {
        Solid::Ball { radius } => writer.quantity("radius", *radius),
        Solid::Capsule { length, radius } => {
            writer.quantity("length", *length);
            writer.quantity("radius", *radius);
        }
        Solid::Block { sides, rounding } => {
            writer.triple("sides", *sides);
            writer.quantity("rounding", *rounding);
        }
        Solid::Barrel { length, bilge_diameter, head_diameter, chime_radius } => {
            writer.quantity("length", *length);
            writer.quantity("bilge_diameter", *bilge_diameter);
            writer.quantity("head_diameter", *head_diameter);
            writer.quantity("chime_radius", *chime_radius);
        }
        Solid::HalfSpace => {}
        Solid::Compound { parts } => {
            writer.tables("parts", parts.iter().map(PartSolid::write).collect());
        }
    }
    writer.finish()
}
