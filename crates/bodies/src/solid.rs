//! Solids of bodies in space as stated in files: ball, capsule, block, barrel, half-space, and compounds.

use barrelstack_dynamics::solid::Barrel;
use barrelstack_input::choices::Chosen;
use barrelstack_input::declared::Held;
use barrelstack_input::field::{Default, Kind, Range, Variant};
use barrelstack_input::reader::Reader;
use barrelstack_input::writer::Writer;
use barrelstack_input::{Dimension, InputError, choices, section, table};

choices! {
    /// A solid about its reference point.
    ///
    /// All numbers are in SI units.
    #[derive(Debug, Clone, PartialEq)]
    pub enum Solid;
    /// The forms of solids.
    static SOLIDS;
    /// The reference point is the center.
    Ball = "ball" {
        /// Radius.
        radius: f64 = SIZE, Default::Required;
    }
    /// A tube with round ends along local x; the reference point is the middle.
    Capsule = "capsule" {
        /// Length with both round ends.
        length: f64 = SIZE, Default::Required;
        /// Radius.
        radius: f64 = SIZE, Default::Required;
    }
    /// A block with rounded edges; the reference point is the middle. Its matter is that of one with sharp edges.
    Block = "block" {
        /// Along local x, y and z.
        sides: [f64; 3] = Kind::Triple(Dimension::LENGTH), Default::Required;
        /// Radius of the rounded edges, which contacts never sink in deeper than.
        rounding: f64 = SIZE, Default::Value("\"5 mm\"");
    }
    /// A barrel with its axis along local x, homogeneous; the reference point is the middle.
    Barrel = "barrel" {
        /// Length.
        length: f64 = SIZE, Default::Required;
        /// Diameter at the middle.
        bilge_diameter: f64 = SIZE, Default::Required;
        /// Diameter at the ends.
        head_diameter: f64 = SIZE, Default::Required;
        /// Radius of the rounded chime between stave and head.
        chime_radius: f64 = SIZE, Default::Value("\"10 mm\"");
    }
    /// All below local z = 0, such as a wall once it is turned; of a body fixed to the ground alone.
    HalfSpace = "half-space";
    /// Several solids that are one body; the reference point is the local origin.
    Compound = "compound" {
        /// The solids, all of one density; where they overlap, matter counts twice.
        parts: Vec<PartSolid> = Kind::Tables(&PART), Default::Required;
    }
}

/// The solids allowed in a compound: those before the half-space.
static OF_PARTS: &[Variant] = SOLIDS.split_at(4).0;

/// Returns their names.
fn part_names() -> Vec<&'static str> {
    OF_PARTS.iter().map(|variant| variant.name).collect()
}

/// Sizes of solids (m): from far below a splinter to far above a building.
const SIZE: Kind =
    Kind::Quantity(&[Dimension::LENGTH], Range { least: 1e-4, above: false, greatest: 1e4 });

table! {
    /// Solid of a body in space, about its reference point.
    pub static SOLID = "solid";
    /// Form of the solid.
    type = Kind::Choice(Solid::names), Default::Required;
    of SOLIDS, by type;
}

table! {
    /// Solid of a part, about its reference point.
    static PART_SOLID = "part-solid";
    /// Form of the solid, bounded and no compound itself.
    type = Kind::Choice(part_names), Default::Required;
    of *OF_PARTS, by type;
}

/// The solid of a part; the same type, read from another table.
impl Held for Solid {
    fn read(reader: &Reader<'_>, name: &'static str) -> Result<Self, InputError> {
        read(reader.section(name)?)
    }

    fn write(&self, writer: &mut Writer, name: &'static str) {
        let section = writer.kind_of(name).section().unwrap_or(&SOLID);
        writer.table(name, self.write_as(section));
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
    /// Rotation in the body: about x, then y, then z of the body, each counterclockwise.
    turn: [f64; 3] =
        Kind::Triple(Dimension::ANGLE), Default::Value("[\"0 deg\", \"0 deg\", \"0 deg\"]");
}

fn read(reader: Reader<'_>) -> Result<Solid, InputError> {
    let solid = Solid::read_chosen(&reader)?;
    match &solid {
        Solid::Capsule { length, radius } if *length < 2.0 * radius => {
            let message = format!(
                "`{}` of {length} m holds no two round ends of {radius} m; it is at least {} m, a ball",
                reader.path_of("length"),
                2.0 * radius
            );
            return Err(reader.inconsistent("length", message));
        }
        Solid::Block { sides, .. } if sides.iter().any(|side| !(2e-4..=1e4).contains(side)) => {
            let message = format!(
                "a side of `{}` is not between 0.0002 m and 10000 m; state all three as lengths above zero",
                reader.path_of("sides")
            );
            return Err(reader.inconsistent("sides", message));
        }
        Solid::Block { sides, rounding } if sides.iter().any(|side| 2.0 * rounding >= *side) => {
            let least = sides.iter().copied().fold(f64::INFINITY, f64::min);
            let message = format!(
                "`{}` of {rounding} m does not fit twice in a side of {least} m; state a smaller one",
                reader.path_of("rounding")
            );
            return Err(reader.inconsistent("rounding", message));
        }
        Solid::Barrel { length, bilge_diameter, head_diameter, chime_radius } => {
            let (head, bilge) = (0.5 * head_diameter, 0.5 * bilge_diameter);
            if let Err(error) = Barrel::new(*length, head, bilge, *chime_radius) {
                return Err(reader.inconsistent("bilge_diameter", error.to_string()));
            }
        }
        Solid::Compound { parts } if parts.is_empty() => return Err(reader.missing("parts")),
        Solid::Ball { .. }
        | Solid::Capsule { .. }
        | Solid::Block { .. }
        | Solid::HalfSpace
        | Solid::Compound { .. } => {}
    }
    reader.finish();
    Ok(solid)
}
