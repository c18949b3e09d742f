//! A rack: what carries the barrels of one level, in both views.

use super::catalog;
use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Field, Kind, Named, Range, Section, Variant, Variants, names};
use super::reader::Reader;
use super::tree::Table;
use super::writer::Writer;

/// How a rack stands on what is below.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RackKind {
    /// Rack-on-barrel: the rack lies on the barrels of the level below.
    OnBarrels,
    /// Rack-on-rack: posts carry the load to the rack below and no barrel carries another.
    OnRacks,
}

/// How a rack holds a barrel in the transverse view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cradle {
    /// Two supports at `±angle` from the lowest point of the barrel.
    Supports {
        /// Angle of each support from the vertical through the center of the barrel (rad).
        angle: f64,
    },
    /// A circular trough.
    Arc {
        /// Radius of the trough (m).
        radius: f64,
        /// Half of the angle the trough spans (rad).
        half_angle: f64,
    },
}

/// How a seat is divided into contact elements, each with the stiffness and damping that the scenario
/// states per node: tests measure a whole seat, so the division is part of the physics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SeatContact {
    /// Nodes along flat undersides, one at each support of a cradle, as in the paper.
    Nodes,
    /// One element where two bodies touch.
    Element,
    /// One element for each of the two rails that a rack has across the barrels.
    Rails,
}

impl SeatContact {
    /// How many elements stand side by side, one behind the other, where a transverse section shows one.
    pub fn behind_each_other(self) -> f64 {
        match self {
            Self::Nodes | Self::Element => 1.0,
            Self::Rails => 2.0,
        }
    }
}

impl Named for SeatContact {
    const NAMES: &'static [(&'static str, Self)] =
        &[("nodes", Self::Nodes), ("element", Self::Element), ("rails", Self::Rails)];
}

/// The posts of a rack that stands on the rack below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posts {
    /// Height from the foot of the post to the seat of the next rack (m).
    pub height: f64,
    /// Distance of each post from the middle of the rack in the transverse view (m).
    pub half_spacing: f64,
    /// Distance of each post from the middle of the outer barrels of the rack in the longitudinal view (m).
    pub half_spacing_along: f64,
    /// How far the foot of the next rack reaches over the sides of the post (m); it must be lifted by
    /// this much before it can slide off.
    pub spigot: f64,
}

/// A rack.
#[derive(Debug, Clone, PartialEq)]
pub struct Rack {
    /// Catalog name the rack was made from.
    pub base: &'static str,
    /// How the rack stands on what is below.
    pub kind: RackKind,
    /// Mass (kg).
    pub mass: f64,
    /// Barrels side by side on one rack in the transverse view.
    pub barrels: u32,
    /// Barrels end to end on one rack in the longitudinal view.
    pub barrels_deep: u32,
    /// Distance between the axes of neighboring barrels (m).
    pub pitch: f64,
    /// Overall width in the transverse view (m).
    pub width: f64,
    /// Distance of each rail from the middle of a barrel along its axis (m).
    pub rail_half_spacing: f64,
    /// Width of one rail along the barrel axis (m).
    pub rail_width: f64,
    /// Angle by which the rails raise the right end of a barrel in the longitudinal view (rad).
    pub incline: f64,
    /// Height of the lowest point of a carried barrel above the underside of the rack (m).
    pub clearance: f64,
    /// Height of the beams (m), above the feet where there are any.
    pub beam_height: f64,
    /// Height of the feet under the beams, one over each barrel below (m); zero for straight tubes
    /// without feet.
    pub foot_height: f64,
    /// How the rack holds a barrel.
    pub cradle: Cradle,
    /// Half of the length of a foot (m).
    pub foot_half_length: f64,
    /// How a seat is divided into contact elements.
    pub contact: SeatContact,
    /// Penetration of a seat (m) beyond which the solids themselves meet, as in impacts.
    pub seat_stroke: f64,
    /// Distance between contact nodes on rails and undersides (m).
    pub node_spacing: f64,
    /// Posts; present exactly when `kind` is [`RackKind::OnRacks`].
    pub posts: Option<Posts>,
}

/// A rack of the catalog, by its place there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Base(usize);

impl Named for Base {
    const NAMES: &'static [(&'static str, Self)] = &{
        let mut names = [("", Self(0)); catalog::RACKS.len()];
        let mut at = 0;
        while at < names.len() {
            names[at] = (catalog::RACKS[at].rack.base, Self(at));
            at += 1;
        }
        names
    };
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CradleKind {
    Supports,
    Arc,
}

impl Named for CradleKind {
    const NAMES: &'static [(&'static str, Self)] =
        &[("supports", Self::Supports), ("arc", Self::Arc)];
}

const CATALOG: Default = Default::Derived("that of the catalog");

const fn size(least: f64, greatest: f64) -> Kind {
    Kind::Quantity(&[Dimension::LENGTH], Range { least, above: false, greatest })
}

const CRADLE_ANGLE: Kind = Kind::Quantity(&[Dimension::ANGLE], Range::up_to(1.5));

/// A cradle.
pub static CRADLE: Section = Section {
    name: "cradle",
    help: "How a rack holds a barrel in the transverse view.",
    fields: &[Field::new(
        "type",
        Kind::Choice(names::<CradleKind>),
        Default::Value("\"supports\""),
        "Two supports, or a circular trough.",
    )],
    variants: Some(Variants {
        tag: "type",
        list: &[
            Variant {
                name: "supports",
                help: "Two supports at equal angles from the lowest point of the barrel.",
                fields: &[Field::new(
                    "angle",
                    CRADLE_ANGLE,
                    CATALOG,
                    "Angle of each support from the vertical through the center of the barrel.",
                )],
            },
            Variant {
                name: "arc",
                help: "A circular trough.",
                fields: &[
                    Field::new(
                        "radius",
                        size(0.01, 10.0),
                        Default::Required,
                        "Radius of the trough.",
                    ),
                    Field::new(
                        "half_angle",
                        CRADLE_ANGLE,
                        Default::Required,
                        "Half of the angle the trough spans.",
                    ),
                ],
            },
        ],
    }),
    exclusive: &[],
};

/// A rack.
pub static RACK: Section = Section {
    name: "rack",
    help: "A rack of the catalog, with what differs.",
    fields: &[
        Field::new(
            "base",
            Kind::Choice(catalog::rack_names),
            Default::Value("\"two-barrel\""),
            "Rack of the catalog.",
        ),
        Field::new(
            "mass",
            Kind::Quantity(&[Dimension::MASS], Range::up_to(1e5)),
            CATALOG,
            "Mass of one rack.",
        ),
        Field::new(
            "barrels",
            Kind::Integer(1, 40),
            CATALOG,
            "Barrels side by side on one rack, in the transverse view.",
        ),
        Field::new(
            "barrels_deep",
            Kind::Integer(1, 40),
            CATALOG,
            "Barrels end to end on one rack, in the longitudinal view.",
        ),
        Field::new(
            "pitch",
            size(0.05, 10.0),
            CATALOG,
            "Distance between the axes of neighboring barrels.",
        ),
        Field::new("width", size(0.05, 100.0), CATALOG, "Overall width across the barrels."),
        Field::new(
            "rail_half_spacing",
            size(0.01, 10.0),
            CATALOG,
            "Distance of each rail from the middle of a barrel, along its axis.",
        ),
        Field::new(
            "rail_width",
            size(1e-3, 1.0),
            CATALOG,
            "Width of one rail along the barrel axis.",
        ),
        Field::new(
            "incline",
            Kind::Quantity(&[Dimension::ANGLE], Range::between(-0.2, 0.2)),
            CATALOG,
            "Angle by which the rails raise the right end of a barrel, in the longitudinal view.",
        ),
        Field::new(
            "clearance",
            size(1e-3, 10.0),
            CATALOG,
            "Height of the lowest point of a carried barrel above the underside of the rack.",
        ),
        Field::new(
            "beam_height",
            size(1e-3, 10.0),
            CATALOG,
            "Height of the beams, above the feet where there are any.",
        ),
        Field::new(
            "foot_height",
            Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 10.0)),
            CATALOG,
            "Height of the feet under the beams, one over each barrel below; 0 for straight tubes without feet.",
        ),
        Field::new(
            "cradle",
            Kind::ChoiceOrTable(names::<CradleKind>, "type", &CRADLE),
            CATALOG,
            "How the rack holds a barrel.",
        ),
        Field::new("foot_half_length", size(1e-3, 10.0), CATALOG, "Half of the length of a foot."),
        Field::new(
            "contact",
            Kind::Choice(names::<SeatContact>),
            CATALOG,
            "How a seat is divided into contact elements, each with the constants per node: nodes along flat \
             undersides, one element, or one for each of two rails.",
        ),
        Field::new(
            "seat_stroke",
            size(1e-4, 1.0),
            CATALOG,
            "Penetration of a seat beyond which the solids themselves meet, by the law of impacts.",
        ),
        Field::new(
            "node_spacing",
            size(1e-3, 0.5),
            CATALOG,
            "Distance between contact nodes on flat undersides.",
        ),
    ],
    variants: Some(Variants { tag: "base", list: &BASES }),
    exclusive: &[],
};

/// The fields of racks on posts.
const POSTS: &[Field] = &[
    Field::new(
        "post_height",
        size(0.01, 10.0),
        CATALOG,
        "Height from the foot of the post to the seat of the next rack.",
    ),
    Field::new(
        "post_half_spacing",
        size(0.01, 100.0),
        CATALOG,
        "Distance of each post from the middle of the rack, in the transverse view.",
    ),
    Field::new(
        "post_half_spacing_along",
        size(0.01, 100.0),
        CATALOG,
        "Distance of each post from the middle of the barrel beside it, in the longitudinal view.",
    ),
    Field::new(
        "post_spigot",
        size(0.01, 100.0),
        CATALOG,
        "How far the foot of the next rack reaches over the sides of the post.",
    ),
];

/// What each rack of the catalog is, and the fields that it has beside those of all.
static BASES: [Variant; catalog::RACKS.len()] = {
    let mut bases = [const { Variant { name: "", help: "", fields: &[] } }; catalog::RACKS.len()];
    let mut at = 0;
    while at < bases.len() {
        let catalog::CatalogRack { rack, help, .. } = &catalog::RACKS[at];
        let fields = if rack.posts.is_some() { POSTS } else { &[] };
        bases[at] = Variant { name: rack.base, help, fields };
        at += 1;
    }
    bases
};

/// Reads a rack.
pub(super) fn read(reader: Reader<'_>) -> Result<Rack, ScenarioError> {
    let Base(base) = reader.choice("base")?;
    let known = &catalog::RACKS[base].rack;
    let or = |name, regular| Ok(reader.optional_quantity(name)?.unwrap_or(regular));
    let cradle = match reader.optional_section("cradle")? {
        Some(cradle) => read_cradle(cradle, known)?,
        None => known.cradle,
    };
    let posts = match known.posts {
        Some(posts) => Some(Posts {
            height: or("post_height", posts.height)?,
            half_spacing: or("post_half_spacing", posts.half_spacing)?,
            half_spacing_along: or("post_half_spacing_along", posts.half_spacing_along)?,
            spigot: or("post_spigot", posts.spigot)?,
        }),
        None => None,
    };
    let rack = Rack {
        base: known.base,
        kind: known.kind,
        mass: or("mass", known.mass)?,
        barrels: reader.optional_integer("barrels")?.unwrap_or(known.barrels),
        barrels_deep: reader.optional_integer("barrels_deep")?.unwrap_or(known.barrels_deep),
        pitch: or("pitch", known.pitch)?,
        width: or("width", known.width)?,
        rail_half_spacing: or("rail_half_spacing", known.rail_half_spacing)?,
        rail_width: or("rail_width", known.rail_width)?,
        incline: or("incline", known.incline)?,
        clearance: or("clearance", known.clearance)?,
        beam_height: or("beam_height", known.beam_height)?,
        cradle,
        foot_height: or("foot_height", known.foot_height)?,
        foot_half_length: or("foot_half_length", known.foot_half_length)?,
        contact: reader.optional_choice("contact")?.unwrap_or(known.contact),
        seat_stroke: or("seat_stroke", known.seat_stroke)?,
        node_spacing: or("node_spacing", known.node_spacing)?,
        posts,
    };
    let span = rack.pitch * f64::from(rack.barrels - 1);
    if rack.width < span {
        let message = format!(
            "`{}` is {} m, less than the {span} m between the axes of the outer barrels",
            reader.path_of("width"),
            rack.width
        );
        return Err(reader.inconsistent("width", message));
    }
    if rack.foot_height + rack.beam_height > rack.clearance {
        let message = format!(
            "`{}` is {} m, but feet of {} m and a beam of {} m leave no room under the barrels",
            reader.path_of("clearance"),
            rack.clearance,
            rack.foot_height,
            rack.beam_height
        );
        return Err(reader.inconsistent("clearance", message));
    }
    reader.finish();
    Ok(rack)
}

fn read_cradle(reader: Reader<'_>, known: &Rack) -> Result<Cradle, ScenarioError> {
    let cradle = match reader.choice::<CradleKind>("type")? {
        CradleKind::Supports => {
            let angle = match (reader.optional_quantity("angle")?, known.cradle) {
                (Some(angle), _) | (None, Cradle::Supports { angle }) => angle,
                (None, Cradle::Arc { .. }) => return Err(reader.missing("angle")),
            };
            Cradle::Supports { angle }
        }
        CradleKind::Arc => Cradle::Arc {
            radius: reader.quantity("radius")?,
            half_angle: reader.quantity("half_angle")?,
        },
    };
    reader.finish();
    Ok(cradle)
}

/// Writes a rack.
pub(super) fn write(rack: &Rack) -> Table {
    let base = catalog::RACKS.iter().position(|known| known.rack.base == rack.base);
    let mut writer = Writer::variant(&RACK, Base(base.unwrap_or(0)));
    writer.quantity("mass", rack.mass);
    writer.integer("barrels", rack.barrels);
    writer.integer("barrels_deep", rack.barrels_deep);
    writer.quantity("pitch", rack.pitch);
    writer.quantity("width", rack.width);
    writer.quantity("rail_half_spacing", rack.rail_half_spacing);
    writer.quantity("rail_width", rack.rail_width);
    writer.quantity("incline", rack.incline);
    writer.quantity("clearance", rack.clearance);
    writer.quantity("beam_height", rack.beam_height);
    writer.table("cradle", write_cradle(&rack.cradle));
    writer.quantity("foot_height", rack.foot_height);
    writer.quantity("foot_half_length", rack.foot_half_length);
    writer.choice("contact", rack.contact);
    writer.quantity("seat_stroke", rack.seat_stroke);
    writer.quantity("node_spacing", rack.node_spacing);
    if let Some(posts) = rack.posts {
        writer.quantity("post_height", posts.height);
        writer.quantity("post_half_spacing", posts.half_spacing);
        writer.quantity("post_half_spacing_along", posts.half_spacing_along);
        writer.quantity("post_spigot", posts.spigot);
    }
    writer.finish()
}

fn write_cradle(cradle: &Cradle) -> Table {
    match *cradle {
        Cradle::Supports { angle } => {
            let mut writer = Writer::variant(&CRADLE, CradleKind::Supports);
            writer.quantity("angle", angle);
            writer.finish()
        }
        Cradle::Arc { radius, half_angle } => {
            let mut writer = Writer::variant(&CRADLE, CradleKind::Arc);
            writer.quantity("radius", radius);
            writer.quantity("half_angle", half_angle);
            writer.finish()
        }
    }
}
