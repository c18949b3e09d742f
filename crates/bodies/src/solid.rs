//! Shapes of three-dimensional bodies, as stated in files: ball, capsule, block, barrel, half-space, and compounds.

use barrelstack_dynamics::solid::Barrel;
use barrelstack_input::choices::Chosen;
use barrelstack_input::declared::Held;
use barrelstack_input::field::{Default, Kind, Range, Variant};
use barrelstack_input::reader::Reader;
use barrelstack_input::writer::Writer;
use barrelstack_input::{Dimension, InputError, choices, section, table};

choices! {
    /// Shape of a body, relative to its reference point.
    ///
    /// All numbers are in SI units.
    #[derive(Debug, Clone, PartialEq)]
    pub enum Solid;
    /// The shapes that a file can state.
    static SOLIDS;
    /// A ball; the reference point is the center.
    Ball = "ball" {
        /// Radius.
        radius: f64 = SIZE, Default::Required;
    }
    /// A cylinder along local x with hemispherical ends; the reference point is the middle.
    Capsule = "capsule" {
        /// Length of the capsule, including both ends.
        length: f64 = SIZE, Default::Required;
        /// Radius.
        radius: f64 = SIZE, Default::Required;
    }
    /// A block with rounded edges; the reference point is the middle. Mass and inertia are those of a block with sharp
    /// edges.
    Block = "block" {
        /// Side lengths along local x, y and z.
        sides: [f64; 3] = Kind::Triple(Dimension::LENGTH), Default::Required;
        /// Radius of the rounded edges; the penetration at a contact must stay below this radius.
        rounding: f64 = SIZE, Default::Value("\"5 mm\"");
    }
    /// A homogeneous barrel with its axis along local x; the reference point is the middle.
    Barrel = "barrel" {
        /// Length of the barrel.
        length: f64 = SIZE, Default::Required;
        /// Diameter of the barrel at its middle.
        bilge_diameter: f64 = SIZE, Default::Required;
        /// Diameter of the barrel at its ends.
        head_diameter: f64 = SIZE, Default::Required;
        /// Radius of the chime, the rounded rim between the staves and a head.
        chime_radius: f64 = SIZE, Default::Value("\"10 mm\"");
    }
    /// Everything below local z = 0, such as a floor or, rotated, a wall; only for a body fixed to the ground.
    HalfSpace = "half-space";
    /// Several solids joined into one rigid body; the reference point is the local origin.
    Compound = "compound" {
        /// The solids, all of the same density; where two of them overlap, the mass of the overlap counts twice.
        parts: Vec<PartSolid> = Kind::Tables(&PART), Default::Required;
    }
}

/// The shapes allowed in a compound: all shapes listed before the half-space.
static OF_PARTS: &[Variant] = SOLIDS.split_at(4).0;

/// Returns the names of the shapes allowed in a compound.
fn part_names() -> Vec<&'static str> {
    OF_PARTS.iter().map(|variant| variant.name).collect()
}

/// A length of a solid, such as a radius, from 0.1 mm to 10 km.
const SIZE: Kind =
    Kind::Quantity(&[Dimension::LENGTH], Range { least: 1e-4, above: false, greatest: 1e4 });

table! {
    /// Shape of a three-dimensional body, relative to its reference point.
    pub static SOLID = "solid";
    /// Shape of the solid.
    type = Kind::Choice(Solid::names), Default::Required;
    of SOLIDS, by type;
}

table! {
    /// Shape of a part of a compound, relative to its reference point.
    static PART_SOLID = "part-solid";
    /// Shape of the part; neither a half-space nor a compound.
    type = Kind::Choice(part_names), Default::Required;
    of *OF_PARTS, by type;
}

/// Reads and writes the solid of a part of a compound. It has the same Rust type as the solid of a body, but its table,
/// `PART_SOLID`, allows fewer shapes than `SOLID`.
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
    /// One part of a compound.
    #[derive(Debug, Clone, PartialEq)]
    pub struct PartSolid;
    /// One solid of a compound, with its placement in the body.
    pub static PART = "solid-part";
    /// Shape of the part.
    solid: Solid = Kind::Table(&PART_SOLID), Default::Required;
    /// Position of the reference point of the part in the body.
    offset: [f64; 3] = Kind::Triple(Dimension::LENGTH), Default::Value("[\"0 m\", \"0 m\", \"0 m\"]");
    /// Rotation of the part: about the axes x, then y, then z of the body, each counterclockwise.
    turn: [f64; 3] =
        Kind::Triple(Dimension::ANGLE), Default::Value("[\"0 deg\", \"0 deg\", \"0 deg\"]");
}

fn read(reader: Reader<'_>) -> Result<Solid, InputError> {
    let solid = Solid::read_chosen(&reader)?;
    match &solid {
        Solid::Capsule { length, radius } if *length < 2.0 * radius => {
            let message = format!(
                "`{}` of {length} m is too short for two round ends with a radius of {radius} m; it must be at least \
                 {} m, twice the radius",
                reader.path_of("length"),
                2.0 * radius
            );
            return Err(reader.inconsistent("length", message));
        }
        Solid::Block { sides, .. } if sides.iter().any(|side| !(2e-4..=1e4).contains(side)) => {
            let message = format!(
                "every side of `{}` must be between 0.0002 m and 10000 m; correct the side outside this range",
                reader.path_of("sides")
            );
            return Err(reader.inconsistent("sides", message));
        }
        Solid::Block { sides, rounding } if sides.iter().any(|side| 2.0 * rounding >= *side) => {
            let least = sides.iter().copied().fold(f64::INFINITY, f64::min);
            let message = format!(
                "`{}` of {rounding} m must be less than half of the shortest side ({least} m); state a smaller radius",
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
