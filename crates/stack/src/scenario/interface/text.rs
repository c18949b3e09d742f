//! Reader and writer of `[interface]`.

use crate::scenario::catalog::Seat;
use crate::scenario::dimension::Dimension;
use crate::scenario::error::{Problem, ScenarioError};
use crate::scenario::field::Section;
use crate::scenario::free::FreeInterface;
use crate::scenario::quantity::QuantityError;
use crate::scenario::reader::Reader;
use crate::scenario::tree::Table;
use crate::scenario::writer::Writer;

use super::fields::{FREE_INTERFACE, FRICTION, FrictionKind, Law};
use super::{Basis, Damping, Friction, Interface, NormalLaw};

/// Stiffness (N/m) and damping (N·s/m) of one contact node of a stack, calibrated by Candia, de la Llera and Almazán
/// (2008).
const NODE: (f64, f64) = (980_000.0, 2200.0);

/// Contact constants of one pair of bodies in a stack, used as defaults for constants that the scenario leaves out.
#[derive(Debug, Clone, Copy)]
pub(in crate::scenario) struct PairDefaults {
    /// Constants of the seat, if the pair is a seat of a rack.
    pub(in crate::scenario) seat: Option<Seat>,
    pub(in crate::scenario) rebound_stiffness: f64,
    pub(in crate::scenario) coefficient: f64,
}

/// Reads a contact law from its table.
pub(in crate::scenario) fn read(
    reader: Reader<'_>,
    defaults: Option<PairDefaults>,
) -> Result<Interface, ScenarioError> {
    let law = reader.choice::<Law>("law")?;
    let basis = reader.choice::<Basis>("basis")?;
    let seat = defaults.and_then(|defaults| defaults.seat);
    if basis == Basis::Seat && seat.is_none() {
        let message = format!(
            "`{}` is \"seat\", but this pair is not a seat of a rack; state its constants per node with \"node\", or per \
             meter of boundary with \"length\"",
            reader.path_of("basis")
        );
        return Err(reader.inconsistent("basis", message));
    }
    let seat = seat.filter(|_| basis == Basis::Seat);
    let exponent = match law {
        Law::SpeedGap | Law::KelvinVoigt => 1.0,
        Law::HuntCrossley => {
            let exponent = reader.number("exponent")?;
            if exponent != 1.0 && exponent != 1.5 {
                let message =
                    format!("`{}` must be 1 or 1.5, found {exponent}", reader.path_of("exponent"));
                return Err(reader.inconsistent("exponent", message));
            }
            exponent
        }
        Law::Hertz | Law::Rebound => 1.5,
    };
    // The constants of the paper belong together, and apply to its contact laws only.
    let is_linear = matches!(law, Law::SpeedGap | Law::KelvinVoigt);
    let node = (is_linear && basis == Basis::Node && defaults.is_some()).then_some(NODE);
    let known = match law {
        Law::SpeedGap | Law::KelvinVoigt => {
            seat.map(|seat| seat.stiffness).or(node.map(|node| node.0))
        }
        Law::Rebound => {
            defaults.filter(|_| basis == Basis::Node).map(|defaults| defaults.rebound_stiffness)
        }
        Law::HuntCrossley | Law::Hertz => None,
    };
    let stiffness_dimension = stiffness_dimension(exponent, basis);
    let stiffness = quantity_in(&reader, "stiffness", stiffness_dimension)?
        .or(known)
        .ok_or_else(|| missing_quantity(&reader, "stiffness", stiffness_dimension))?;
    let own = match (seat, node) {
        (Some(seat), _) => {
            Some(Damping::Restitution { restitution: seat.restitution, reference: seat.mass })
        }
        (None, Some((_, damping))) if !reader.has("stiffness") => {
            Some(Damping::Coefficient(damping))
        }
        (None, _) => None,
    };
    let normal = match law {
        Law::SpeedGap | Law::KelvinVoigt => {
            let damping = read_damping(&reader, linear_damping(basis), own)?;
            if law == Law::SpeedGap {
                NormalLaw::SpeedGap { stiffness, damping }
            } else {
                NormalLaw::KelvinVoigt { stiffness, damping }
            }
        }
        Law::HuntCrossley => {
            let damping = read_damping(&reader, HUNT_CROSSLEY, None)?;
            NormalLaw::HuntCrossley { stiffness, exponent, damping }
        }
        Law::Hertz => NormalLaw::Hertz { stiffness },
        Law::Rebound => NormalLaw::Rebound {
            stiffness,
            restitution: reader.number("restitution")?,
            speed: reader.quantity("speed")?,
        },
    };
    if defaults.is_none() && !reader.has("friction") {
        return Err(reader.missing("friction"));
    }
    let friction = read_friction(reader.section("friction")?, defaults, seat)?;
    reader.finish();
    Ok(Interface { basis, normal, friction })
}

/// Dimension of the damping coefficient of a normal law, followed by the name and the dimension of another field. This
/// field states the mass or speed for which a coefficient of restitution holds.
type DampingUnits = (Dimension, &'static str, Dimension);

const HUNT_CROSSLEY: DampingUnits =
    (Dimension::HUNT_CROSSLEY_DAMPING, "reference_speed", Dimension::VELOCITY);

fn linear_damping(basis: Basis) -> DampingUnits {
    match basis {
        Basis::Node | Basis::Seat => (Dimension::DAMPING, "reference_mass", Dimension::MASS),
        Basis::Length => {
            (Dimension::DAMPING_PER_LENGTH, "reference_mass", Dimension::MASS_PER_LENGTH)
        }
    }
}

fn read_damping(
    reader: &Reader<'_>,
    (damping_dimension, field, dimension): DampingUnits,
    own: Option<Damping>,
) -> Result<Damping, ScenarioError> {
    let damping = quantity_in(reader, "damping", damping_dimension)?;
    let restitution = reader.optional_number("restitution")?;
    let reference = quantity_in(reader, field, dimension)?;
    let known = match own {
        Some(Damping::Restitution { restitution, reference }) => Some((restitution, reference)),
        Some(Damping::Coefficient(_)) | None => None,
    };
    match (damping, restitution, reference, known) {
        (Some(damping), ..) => Ok(Damping::Coefficient(damping)),
        (None, Some(restitution), Some(reference), _)
        | (None, Some(restitution), None, Some((_, reference)))
        | (None, None, Some(reference), Some((restitution, _))) => {
            Ok(Damping::Restitution { restitution, reference })
        }
        (None, Some(_), None, None) => {
            // The error is placed at the restitution, which may come from an override.
            let problem = missing_problem(reader, field, dimension);
            Err(reader.error("restitution", problem))
        }
        (None, None, Some(_), None) => Err(reader.missing("restitution")),
        (None, None, None, _) => {
            own.ok_or_else(|| missing_quantity(reader, "damping", damping_dimension))
        }
    }
}

fn write_damping(
    writer: &mut Writer,
    damping: Damping,
    (damping_dimension, field, dimension): DampingUnits,
) {
    match damping {
        Damping::Coefficient(damping) => {
            writer.quantity_in("damping", damping, damping_dimension);
            writer.omit(&["restitution", field]);
        }
        Damping::Restitution { restitution, reference } => {
            writer.number("restitution", restitution);
            writer.quantity_in(field, reference, dimension);
            writer.omit(&["damping"]);
        }
    }
}

fn read_friction(
    reader: Reader<'_>,
    defaults: Option<PairDefaults>,
    seat: Option<Seat>,
) -> Result<Friction, ScenarioError> {
    let coefficient = || -> Result<f64, ScenarioError> {
        match (reader.optional_number("coefficient")?, defaults) {
            (Some(coefficient), _) => Ok(coefficient),
            (None, Some(defaults)) => Ok(defaults.coefficient),
            (None, None) => Err(reader.missing("coefficient")),
        }
    };
    let friction = match reader.choice::<FrictionKind>("law")? {
        FrictionKind::None => Friction::None,
        FrictionKind::Coulomb => {
            let coefficient = coefficient()?;
            let static_coefficient =
                reader.optional_number("static_coefficient")?.unwrap_or(coefficient);
            if static_coefficient < coefficient {
                let message = format!(
                    "`{}` is {static_coefficient}, below the kinetic coefficient {coefficient}; raise or omit the \
                     static coefficient",
                    reader.path_of("static_coefficient")
                );
                return Err(reader.inconsistent("static_coefficient", message));
            }
            Friction::Coulomb {
                coefficient,
                static_coefficient,
                tangential_stiffness_ratio: reader
                    .optional_number("tangential_stiffness_ratio")?
                    .unwrap_or(seat.map_or(1.0, |seat| seat.stick)),
                tangential_damping_ratio: reader.number("tangential_damping_ratio")?,
            }
        }
        FrictionKind::Regularized => Friction::Regularized {
            coefficient: coefficient()?,
            velocity: reader.quantity("velocity")?,
        },
    };
    reader.finish();
    Ok(friction)
}

fn stiffness_dimension(exponent: f64, basis: Basis) -> Dimension {
    match (exponent == 1.0, basis) {
        (true, Basis::Node | Basis::Seat) => Dimension::STIFFNESS,
        (true, Basis::Length) => Dimension::STIFFNESS_PER_LENGTH,
        (false, Basis::Node | Basis::Seat) => Dimension::HERTZ_STIFFNESS,
        (false, Basis::Length) => Dimension::HERTZ_STIFFNESS_PER_LENGTH,
    }
}

/// Reads a quantity whose dimension depends on the law and the basis.
fn quantity_in(
    reader: &Reader<'_>,
    name: &'static str,
    dimension: Dimension,
) -> Result<Option<f64>, ScenarioError> {
    let Some(quantity) = reader.optional_quantity_with_dimension(name)? else { return Ok(None) };
    if quantity.dimension == dimension {
        return Ok(Some(quantity.value));
    }
    let reason = QuantityError::WrongDimension {
        text: quantity.to_string(),
        found: quantity.dimension.to_string(),
        expected: format!("{dimension} for this law and this `basis`"),
    };
    let example = format!("\"{}\"", dimension.example());
    Err(reader.error(name, Problem::Quantity { field: reader.path_of(name), reason, example }))
}

fn missing_quantity(reader: &Reader<'_>, name: &str, dimension: Dimension) -> ScenarioError {
    reader.section_error(missing_problem(reader, name, dimension))
}

fn missing_problem(reader: &Reader<'_>, name: &str, dimension: Dimension) -> Problem {
    let example = format!("`{name} = \"{}\"`", dimension.example());
    Problem::Missing { field: name.to_owned(), section: reader.label(), example }
}

/// Writes a contact law of a stack as a table.
pub(in crate::scenario) fn write(section: &'static Section, interface: &Interface) -> Table {
    let mut writer = Writer::variant(section, law_of(&interface.normal));
    write_fields(&mut writer, interface);
    writer.finish()
}

/// Writes an interface of a free scene.
pub(in crate::scenario) fn write_free(interface: &FreeInterface) -> Table {
    let mut writer = Writer::variant(&FREE_INTERFACE, law_of(&interface.law.normal));
    writer.pair("between", &interface.between);
    writer.flag("within_groups", interface.within_groups);
    write_fields(&mut writer, &interface.law);
    writer.finish()
}

fn law_of(normal: &NormalLaw) -> Law {
    match normal {
        NormalLaw::SpeedGap { .. } => Law::SpeedGap,
        NormalLaw::KelvinVoigt { .. } => Law::KelvinVoigt,
        NormalLaw::HuntCrossley { .. } => Law::HuntCrossley,
        NormalLaw::Hertz { .. } => Law::Hertz,
        NormalLaw::Rebound { .. } => Law::Rebound,
    }
}

fn write_fields(writer: &mut Writer, interface: &Interface) {
    let basis = interface.basis;
    writer.choice("basis", basis);
    match interface.normal {
        NormalLaw::SpeedGap { stiffness, damping }
        | NormalLaw::KelvinVoigt { stiffness, damping } => {
            writer.quantity_in("stiffness", stiffness, stiffness_dimension(1.0, basis));
            write_damping(writer, damping, linear_damping(basis));
        }
        NormalLaw::HuntCrossley { stiffness, exponent, damping } => {
            writer.quantity_in("stiffness", stiffness, stiffness_dimension(exponent, basis));
            writer.number("exponent", exponent);
            write_damping(writer, damping, HUNT_CROSSLEY);
        }
        NormalLaw::Hertz { stiffness } => {
            writer.quantity_in("stiffness", stiffness, stiffness_dimension(1.5, basis));
        }
        NormalLaw::Rebound { stiffness, restitution, speed } => {
            writer.quantity_in("stiffness", stiffness, stiffness_dimension(1.5, basis));
            writer.number("restitution", restitution);
            writer.quantity("speed", speed);
        }
    }
    writer.table("friction", write_friction(&interface.friction));
}

fn write_friction(friction: &Friction) -> Table {
    match *friction {
        Friction::None => Writer::variant(&FRICTION, FrictionKind::None).finish(),
        Friction::Coulomb {
            coefficient,
            static_coefficient,
            tangential_stiffness_ratio,
            tangential_damping_ratio,
        } => {
            let mut writer = Writer::variant(&FRICTION, FrictionKind::Coulomb);
            writer.number("coefficient", coefficient);
            writer.number("static_coefficient", static_coefficient);
            writer.number("tangential_stiffness_ratio", tangential_stiffness_ratio);
            writer.number("tangential_damping_ratio", tangential_damping_ratio);
            writer.finish()
        }
        Friction::Regularized { coefficient, velocity } => {
            let mut writer = Writer::variant(&FRICTION, FrictionKind::Regularized);
            writer.number("coefficient", coefficient);
            writer.quantity("velocity", velocity);
            writer.finish()
        }
    }
}
