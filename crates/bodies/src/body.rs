//! A three-dimensional body as stated in a file: solid, mass properties, pose and initial motion.

use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Kind, Range};
use barrelstack_input::reader::Reader;
use barrelstack_input::{Dimension, InputError, section};

use crate::solid::{SOLID, Solid};

section! {
    /// Viscous drag on a body, proportional to the absolute velocity of the body, not to its velocity relative to the
    /// shaking ground.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Viscous;
    /// Viscous drag on the motion of a three-dimensional body, the same in all directions.
    pub static VISCOUS = "viscous-in-space";
    /// Drag force divided by the velocity of the center of mass.
    linear: f64 =
        Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE), Default::Value("\"0 N s/m\"");
    /// Drag moment divided by the angular velocity.
    angular: f64 =
        Kind::Quantity(&[Dimension::ANGULAR_DAMPING], Range::NOT_NEGATIVE), Default::Value("\"0 N m s\"");
}

section! {
    /// One body of a three-dimensional free scene, which is a scene of arbitrary bodies.
    #[derive(Debug, Clone, PartialEq)]
    pub struct SpatialBody;
    /// A rigid body of a three-dimensional scene, with x to the right, y away from the viewer and z up.
    pub static BODY = "body-in-space", at most one of &["mass", "density"];
    /// Unique name.
    name: String = Kind::Text, Default::Required;
    /// Kind of the body. Interfaces refer to bodies by their kind, and several bodies may have the same kind.
    kind: Option<String> = Kind::Text, Default::Derived("the name");
    /// Contact geometry of the body.
    solid: Solid = Kind::Table(&SOLID), Default::Required;
    /// Mass of the body.
    mass: Option<f64> = Kind::Quantity(&[Dimension::MASS], Range::POSITIVE),
        Default::Derived("`density` times the volume of the solid; a body that is not fixed to the ground needs a \
            mass or a density");
    /// Density of the solid, as an alternative to the mass.
    density: Option<f64> =
        Kind::Quantity(&[Dimension::DENSITY], Range::POSITIVE), Default::Derived("the mass divided by the volume of \
            the solid");
    /// Moments of inertia about the axes through the center of mass that are parallel to local x, y and z. These axes
    /// are taken as the principal axes.
    inertia: Option<[f64; 3]> =
        Kind::Triple(Dimension::INERTIA), Default::Derived("the moments of inertia of a homogeneous solid");
    /// Center of mass, relative to the reference point of the solid.
    center_of_mass: Option<[f64; 3]> =
        Kind::Triple(Dimension::LENGTH), Default::Derived("the center of mass of a homogeneous solid");
    /// Initial position of the reference point of the solid.
    position: [f64; 3] = Kind::Triple(Dimension::LENGTH), Default::Required;
    /// Initial orientation: rotations about the fixed axes x, then y, then z, each counterclockwise.
    orientation: [f64; 3] =
        Kind::Triple(Dimension::ANGLE), Default::Value("[\"0 deg\", \"0 deg\", \"0 deg\"]");
    /// Initial velocity of the center of mass.
    velocity: [f64; 3] =
        Kind::Triple(Dimension::VELOCITY), Default::Value("[\"0 m/s\", \"0 m/s\", \"0 m/s\"]");
    /// Initial angular velocity about the fixed axes x, y and z, each counterclockwise.
    spin: [f64; 3] =
        Kind::Triple(Dimension::SPIN), Default::Value("[\"0 rad/s\", \"0 rad/s\", \"0 rad/s\"]");
    /// Group of the body: an interface with `within_groups = false` does not act between two bodies of the same group.
    group: Option<String> = Kind::Text, Default::Nothing;
    /// True if the body moves with the ground.
    fixed_to_ground: bool = Kind::Flag, Default::Value("false");
    /// Viscous drag on the body.
    viscous: Option<Viscous> = Kind::Table(&VISCOUS), Default::Nothing;
}

impl SpatialBody {
    /// Returns the kind by which interfaces refer to the body.
    pub fn kind(&self) -> &str {
        self.kind.as_deref().unwrap_or(&self.name)
    }

    /// Reads a body and checks the consistency of its fields.
    ///
    /// # Errors
    /// Returns the first problem found, with its place in the file.
    pub fn checked(reader: Reader<'_>) -> Result<Self, InputError> {
        let body = Self::read_fields(&reader)?;
        let wrong = |field, message: String| Err(reader.inconsistent(field, message));
        let free = !body.fixed_to_ground;
        if free && body.solid == Solid::HalfSpace {
            let message = format!(
                "a half-space has no mass, so it cannot move; write `{} = true`, or choose another solid",
                reader.path_of("fixed_to_ground")
            );
            return wrong("solid", message);
        }
        if free && body.mass.is_none() && body.density.is_none() {
            return Err(reader.missing("mass"));
        }
        if !free && (body.velocity != [0.0; 3] || body.spin != [0.0; 3]) {
            let field = if body.velocity == [0.0; 3] { "spin" } else { "velocity" };
            let message = format!(
                "a body fixed to the ground moves only with the ground; leave `{field}` out"
            );
            return wrong(field, message);
        }
        // The inertia of a homogeneous solid is known only about the center of mass of that solid.
        if body.center_of_mass.is_some() && body.inertia.is_none() {
            let message = format!(
                "a stated center of mass means that the body is not homogeneous; state `{}` too",
                reader.path_of("inertia")
            );
            return wrong("center_of_mass", message);
        }
        if let Some([x, y, z]) = body.inertia {
            let most = x.max(y).max(z);
            if x.min(y).min(z) <= 0.0 || most > (x + y + z - most) * (1.0 + 1e-9) {
                let message = format!(
                    "`{}` is {x}, {y} and {z} kg m^2, which no rigid body can have: each moment of inertia must be \
                     above zero, and none may exceed the sum of the other two; correct the three values",
                    reader.path_of("inertia")
                );
                return wrong("inertia", message);
            }
        }
        reader.finish();
        Ok(body)
    }
}
