//! Racks: the frames that carry the barrels of one level, as modeled in either plane.

use barrelstack_input::choices::Chosen;
use barrelstack_input::declared::Held;
use barrelstack_input::{choices, named, table};

use super::catalog;
use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Kind, Range, Section, Variant, Variants, names};
use super::known::known;
use super::reader::Reader;
use super::tree::Table;
use super::writer::Writer;

/// Support on which a rack of an upper level stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RackKind {
    /// Rack-on-barrel: the rack lies on the barrels of the level below.
    OnBarrels,
    /// Rack-on-rack: posts carry the load to the rack below, and no barrel carries another.
    OnRacks,
}

choices! {
    /// Cradle of a barrel in the plane across the barrels.
    ///
    /// All numbers are in SI units.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub enum Cradle;
    /// The kinds of cradles.
    static CRADLES;
    /// Two supports at equal angles from the lowest point of the barrel.
    Supports = "supports" {
        /// Angle between the vertical and the line from the center of the barrel to each support.
        angle: f64 = CRADLE_ANGLE, CATALOG;
    }
    /// A circular trough.
    Arc = "arc" {
        /// Radius of the trough.
        radius: f64 = size(0.01, 10.0), Default::Required;
        /// Half the angle that the trough spans.
        half_angle: f64 = CRADLE_ANGLE, Default::Required;
    }
}

named! {
    /// Division of a seat into contact elements.
    ///
    /// With constants per node, the division affects the results. Constants per seat are divided among the elements, so
    /// that the sum does not depend on the division.
    pub enum SeatContact {
        /// Nodes along flat undersides, and one node at each support of a cradle, as in the paper.
        Nodes = "nodes",
        /// One element at each place where two bodies touch.
        Element = "element",
        /// One element for each of the two rails of a rack, which coincide in the plane across the barrels.
        Rails = "rails",
    }
}

impl SeatContact {
    /// Returns the number of contact elements that coincide in the transverse plane and are modeled there as one
    /// element. Each of them has the constants of a node.
    pub fn behind_each_other(self) -> f64 {
        match self {
            Self::Nodes | Self::Element => 1.0,
            Self::Rails => 2.0,
        }
    }
}

known! {
    /// The posts of a rack that stands on the rack below.
    ///
    /// All numbers are in SI units.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Posts {}
    /// The fields of racks on posts.
    const POSTS;
    /// Height from the foot of the post to the seat of the next rack.
    height as "post_height": f64 = size(0.01, 10.0), CATALOG;
    /// Distance of each post from the middle of the rack, across the barrels.
    half_spacing as "post_half_spacing": f64 = size(0.01, 100.0), CATALOG;
    /// Distance of each post from the middle of the barrel beside it, along the barrels.
    half_spacing_along as "post_half_spacing_along": f64 = size(0.01, 100.0), CATALOG;
    /// Height by which the foot of the next rack overlaps the sides of the post.
    spigot as "post_spigot": f64 = size(0.01, 100.0), CATALOG;
}

known! {
    /// A rack with its dimensions, cradles and seats.
    ///
    /// All numbers are in SI units.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Rack {
        /// Name of the catalog rack on which the rack is based.
        pub base: &'static str,
        /// Support on which the rack stands.
        pub kind: RackKind,
        /// Posts; present exactly when `kind` is [`RackKind::OnRacks`].
        pub posts: Option<Posts>,
    }
    /// The fields of all racks.
    const FIELDS, after {
        /// Catalog rack on which this rack is based.
        base = Kind::Choice(catalog::rack_names), Default::Value("\"two-barrel\"");
    };
    /// Mass of one rack.
    mass: f64 = Kind::Quantity(&[Dimension::MASS], Range::up_to(1e5)), CATALOG;
    /// Number of barrels side by side on one rack, across the barrels.
    barrels: u32 = Kind::Integer(1, 40), CATALOG;
    /// Number of barrels on one rack that lie head to head.
    barrels_deep: u32 = Kind::Integer(1, 40), CATALOG;
    /// Distance between the axes of neighboring barrels.
    pitch: f64 = size(0.05, 10.0), CATALOG;
    /// Overall width of the rack, across the barrels.
    width: f64 = size(0.05, 100.0), CATALOG;
    /// Distance of each rail from the middle of a barrel, along the axis of the barrel.
    rail_half_spacing: f64 = size(0.01, 10.0), CATALOG;
    /// Width of one rail, along the axis of the barrel.
    rail_width: f64 = size(1e-3, 1.0), CATALOG;
    /// Inclination of the barrels along their axes, positive if the rails raise the right end.
    incline: f64 = Kind::Quantity(&[Dimension::ANGLE], Range::between(-0.2, 0.2)), CATALOG;
    /// Height of the lowest point of a carried barrel above the underside of the rack.
    clearance: f64 = size(1e-3, 10.0), CATALOG;
    /// Height of the beams of the rack; the feet are not included.
    beam_height: f64 = size(1e-3, 10.0), CATALOG;
    /// Height of the feet under the beams, with one foot over each barrel below; 0 for straight tubes without feet.
    foot_height: f64 = Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 10.0)), CATALOG;
    /// Cradle in which the rack carries a barrel.
    cradle: Cradle = Kind::ChoiceOrTable(Cradle::names, "type", &CRADLE), CATALOG;
    /// Half the length of one foot of the rack.
    foot_half_length: f64 = size(1e-3, 10.0), CATALOG;
    /// Division of a seat into contact elements: nodes along flat undersides, one element, or one element for each of
    /// two rails. Constants stated per node apply to every contact element; constants stated per seat are divided among
    /// the contact elements of the seat.
    contact: SeatContact = Kind::Choice(names::<SeatContact>), CATALOG;
    /// Penetration at a seat beyond which the impact law of the two bodies also acts.
    seat_stroke: f64 = size(1e-4, 1.0), CATALOG;
    /// Distance between contact nodes on flat undersides.
    node_spacing: f64 = size(1e-3, 0.5), CATALOG;
}

const CATALOG: Default = Default::Derived("the value in the catalog");

const fn size(least: f64, greatest: f64) -> Kind {
    Kind::Quantity(&[Dimension::LENGTH], Range { least, above: false, greatest })
}

const CRADLE_ANGLE: Kind = Kind::Quantity(&[Dimension::ANGLE], Range::up_to(1.5));

table! {
    /// Cradle of a barrel in the plane across the barrels.
    pub static CRADLE = "cradle";
    /// Two supports, or a circular trough.
    type = Kind::Choice(Cradle::names), Default::Value("\"supports\"");
    of CRADLES, by type;
}

/// Definition of the table of a rack.
pub static RACK: Section = Section {
    name: "rack",
    help: "A rack of the catalog, with any changes.",
    fields: FIELDS,
    variants: Some(Variants { tag: "base", list: &BASES }),
    exclusive: &[],
};

/// Descriptions of the racks of the catalog, and the additional fields of each.
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

/// Returns the seat constants of the catalog rack that a table names in its field `base`.
pub(super) fn seats(reader: &Reader<'_>) -> Result<catalog::Seats, ScenarioError> {
    let known = catalog::rack(reader.chosen()?).ok_or_else(|| reader.missing("base"))?;
    Ok(known.seats)
}

/// Reads a rack.
pub(super) fn read(reader: Reader<'_>) -> Result<Rack, ScenarioError> {
    let Some(known) = catalog::rack(reader.chosen()?) else { return Err(reader.missing("base")) };
    let mut rack = Rack::read_over(&reader, &known.rack)?;
    if let Some(posts) = &mut rack.posts {
        *posts = Posts::read_over(&reader, posts)?;
    }
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
            "`{}` is {} m, but feet {} m high and a beam {} m high leave no room under the barrels",
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

impl Held for Cradle {
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, ScenarioError> {
        let reader = reader.section(name)?;
        let cradle = Self::read_chosen(&reader)?;
        reader.finish();
        Ok(cradle)
    }

    fn write(&self, writer: &mut Writer, name: &'static str) {
        writer.table(name, self.write_as(&CRADLE));
    }

    fn read_over(
        reader: &Reader<'_>,
        name: &'static str,
        known: &Self,
    ) -> Result<Self, ScenarioError> {
        let Some(reader) = reader.optional_section(name)? else { return Ok(*known) };
        let supports = matches!(known, Self::Supports { .. }) && reader.chosen()? == known.name();
        let cradle = if supports && reader.leaves_out("angle") {
            *known
        } else {
            Self::read_chosen(&reader)?
        };
        reader.finish();
        Ok(cradle)
    }
}

/// Writes a rack.
pub(super) fn write(rack: &Rack) -> Table {
    let mut writer = Writer::chosen(&RACK, rack.base);
    rack.write_fields(&mut writer);
    if let Some(posts) = rack.posts {
        posts.write_fields(&mut writer);
    }
    let mut table = writer.finish();
    // In listings of stated values, the feet come after the cradle.
    if let Some(feet) = table.entries.iter().position(|entry| entry.key == "foot_height") {
        table.entries.swap(feet, feet + 1);
    }
    table
}
