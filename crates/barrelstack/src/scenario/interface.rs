//! The law of contact between two kinds of body.

use super::dimension::Dimension;
use super::error::{Problem, ScenarioError};
use super::field::{Default, Field, Kind, Named, Range, Section, Variant, Variants, names};
use super::quantity::QuantityError;
use super::reader::Reader;
use super::tree::Table;
use super::writer::Writer;

/// To what a contact constant belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// Constants hold for one contact node, whatever the spacing of the nodes.
    Node,
    /// Constants hold for one meter of boundary and are multiplied by the tributary length of the node.
    Length,
}

/// Dissipation of a linear law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// `c` (N·s/m per node, or N·s/m² on the basis of length).
    Coefficient(f64),
    /// The damping that gives this restitution to a reference mass.
    Restitution {
        /// Ratio of normal speeds after and before, in `(0, 1]`.
        restitution: f64,
        /// Mass that strikes one node (kg), or one meter of boundary (kg/m).
        reference_mass: f64,
    },
}

/// Penetration and its rate to compressive force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NormalLaw {
    /// `k δ + c δ̇` on approach, `k δ` on rebound (Candia, de la Llera and Almazán 2008, eq. 2.6).
    SpeedGap {
        /// `k` (N/m per node, or N/m² on the basis of length).
        stiffness: f64,
        /// Dissipation.
        damping: Damping,
    },
    /// `max(0, k δ + c δ̇)`.
    KelvinVoigt {
        /// `k` (N/m per node, or N/m² on the basis of length).
        stiffness: f64,
        /// Dissipation.
        damping: Damping,
    },
    /// `k δⁿ (1 + d δ̇)`.
    HuntCrossley {
        /// `k` (N/mⁿ per node, or N/mⁿ⁺¹ on the basis of length).
        stiffness: f64,
        /// `n`, either 1 or 1.5.
        exponent: f64,
        /// `d` (s/m).
        damping: f64,
    },
    /// `k δ^1.5`, without dissipation.
    Hertz {
        /// `k` (N/m^1.5 per node, or N/m^2.5 on the basis of length).
        stiffness: f64,
    },
}

/// Slip to tangential force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Friction {
    /// No friction.
    None,
    /// Coulomb friction with an elastic, damped stick.
    Coulomb {
        /// Kinetic coefficient.
        coefficient: f64,
        /// Static coefficient, not below the kinetic one.
        static_coefficient: f64,
        /// Tangential stiffness over normal stiffness.
        tangential_stiffness_ratio: f64,
        /// Tangential damping over normal damping.
        tangential_damping_ratio: f64,
    },
    /// Coulomb friction smoothed near zero slip rate: it never sticks, it creeps.
    Regularized {
        /// Kinetic coefficient.
        coefficient: f64,
        /// Slip rate at which the friction is fully developed (m/s).
        velocity: f64,
    },
}

/// The law of contact between two kinds of body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interface {
    /// To what stiffness and damping belong.
    pub basis: Basis,
    /// Normal force.
    pub normal: NormalLaw,
    /// Tangential force.
    pub friction: Friction,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Law {
    SpeedGap,
    KelvinVoigt,
    HuntCrossley,
    Hertz,
}

impl Named for Law {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("speed-gap", Self::SpeedGap),
        ("kelvin-voigt", Self::KelvinVoigt),
        ("hunt-crossley", Self::HuntCrossley),
        ("hertz", Self::Hertz),
    ];
}

impl Named for Basis {
    const NAMES: &'static [(&'static str, Self)] =
        &[("node", Self::Node), ("length", Self::Length)];
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FrictionKind {
    None,
    Coulomb,
    Regularized,
}

impl Named for FrictionKind {
    const NAMES: &'static [(&'static str, Self)] =
        &[("coulomb", Self::Coulomb), ("regularized", Self::Regularized), ("none", Self::None)];
}

const LAW: Field = Field::new(
    "law",
    Kind::Choice(names::<Law>),
    Default::Value("\"speed-gap\""),
    "Normal force as a function of penetration and its rate.",
);

const BASIS: Field = Field::new(
    "basis",
    Kind::Choice(names::<Basis>),
    Default::Value("\"node\""),
    "Whether stiffness and damping belong to one contact node or to one meter of boundary.",
);

const STIFFNESS: Field = Field::new(
    "stiffness",
    Kind::Quantity(
        &[
            Dimension::STIFFNESS,
            Dimension::STIFFNESS_PER_LENGTH,
            Dimension::HERTZ_STIFFNESS,
            Dimension::HERTZ_STIFFNESS_PER_LENGTH,
        ],
        Range::POSITIVE,
    ),
    Default::Derived("9.8 kN/cm in a stack, for a linear law per node; must be given otherwise"),
    "Stiffness k: N/m per node or N/m^2 per length for a linear law, N/m^1.5 or N/m^2.5 with the exponent 1.5.",
);

const FRICTION_FIELD: Field = Field::new(
    "friction",
    Kind::Table(&FRICTION),
    Default::Derived(
        "Coulomb friction with the coefficient of the pair in a stack; must be given otherwise",
    ),
    "Tangential force.",
);

const LINEAR: &[Field] = &[
    Field::new(
        "damping",
        Kind::Quantity(&[Dimension::DAMPING, Dimension::DAMPING_PER_LENGTH], Range::NOT_NEGATIVE),
        Default::Derived("22 N s/cm in a stack when the stiffness is not given either"),
        "Damping c: N s/m per node or N s/m^2 per length.",
    ),
    Field::new(
        "restitution",
        Kind::Number(Range::up_to(1.0)),
        Default::Nothing,
        "Ratio of normal speeds after and before an impact, in place of the damping.",
    ),
    Field::new(
        "reference_mass",
        Kind::Quantity(&[Dimension::MASS, Dimension::MASS_PER_LENGTH], Range::POSITIVE),
        Default::Derived("must be given with `restitution`"),
        "Mass for which the restitution holds: kg on one node, or kg/m of boundary.",
    ),
];

const LAWS: Variants = Variants {
    tag: "law",
    list: &[
        Variant {
            name: "speed-gap",
            help: "Linear spring, with a damper that acts on approach only.",
            fields: LINEAR,
        },
        Variant {
            name: "kelvin-voigt",
            help: "Linear spring and damper, never pulling.",
            fields: LINEAR,
        },
        Variant {
            name: "hunt-crossley",
            help: "Spring whose damping grows with the penetration.",
            fields: &[
                Field::new(
                    "exponent",
                    Kind::Number(Range::between(1.0, 1.5)),
                    Default::Value("1.5"),
                    "Power of the penetration: 1 or 1.5.",
                ),
                Field::new(
                    "damping",
                    Kind::Quantity(&[Dimension::HUNT_CROSSLEY_DAMPING], Range::NOT_NEGATIVE),
                    Default::Required,
                    "Damping d: ratio of the damping force to the elastic force, per unit of penetration rate.",
                ),
            ],
        },
        Variant {
            name: "hertz",
            help: "Elastic spring with the power 1.5 of the penetration.",
            fields: &[],
        },
    ],
};

/// The law of contact of one pair in a stack.
pub static INTERFACE: Section = Section {
    help: "The law of contact of one pair of bodies.",
    fields: &[LAW, BASIS, STIFFNESS, FRICTION_FIELD],
    variants: Some(LAWS),
    exclusive: &[&["damping", "restitution"], &["damping", "reference_mass"]],
};

/// The law of contact between two kinds of a free scene.
pub static FREE_INTERFACE: Section = Section {
    help: "The law of contact between two kinds of body.",
    fields: &[
        Field::new(
            "between",
            Kind::Pair,
            Default::Required,
            "The two kinds: the first carries the contact nodes, the second the surface.",
        ),
        LAW,
        BASIS,
        STIFFNESS,
        FRICTION_FIELD,
    ],
    variants: Some(LAWS),
    exclusive: &[&["damping", "restitution"], &["damping", "reference_mass"]],
};

/// Greatest coefficient of friction that makes sense.
const COEFFICIENT: Range = Range::between(0.0, 5.0);

const COEFFICIENT_FIELD: Field = Field::new(
    "coefficient",
    Kind::Number(COEFFICIENT),
    Default::Derived("that of the pair in a stack; must be given otherwise"),
    "Kinetic coefficient of friction.",
);

/// Friction.
pub static FRICTION: Section = Section {
    help: "Tangential force of a contact.",
    fields: &[Field::new(
        "law",
        Kind::Choice(names::<FrictionKind>),
        Default::Value("\"coulomb\""),
        "Tangential force as a function of slip.",
    )],
    variants: Some(Variants {
        tag: "law",
        list: &[
            Variant {
                name: "coulomb",
                help: "Elastic, damped stick up to the static limit, then sliding.",
                fields: &[
                    COEFFICIENT_FIELD,
                    Field::new(
                        "static_coefficient",
                        Kind::Number(COEFFICIENT),
                        Default::Derived("`coefficient`"),
                        "Static coefficient of friction, not below the kinetic one.",
                    ),
                    Field::new(
                        "tangential_stiffness_ratio",
                        Kind::Number(Range::up_to(100.0)),
                        Default::Value("1.0"),
                        "Tangential stiffness of the stick over the normal stiffness.",
                    ),
                    Field::new(
                        "tangential_damping_ratio",
                        Kind::Number(Range::between(0.0, 100.0)),
                        Default::Value("1.0"),
                        "Tangential damping of the stick over the normal damping.",
                    ),
                ],
            },
            Variant {
                name: "regularized",
                help: "Sliding friction smoothed around zero slip rate; it creeps and never sticks.",
                fields: &[
                    COEFFICIENT_FIELD,
                    Field::new(
                        "velocity",
                        Kind::Quantity(&[Dimension::VELOCITY], Range::POSITIVE),
                        Default::Required,
                        "Slip rate at which the friction is fully developed.",
                    ),
                ],
            },
            Variant { name: "none", help: "No tangential force.", fields: &[] },
        ],
    }),
    exclusive: &[],
};

/// What a stack takes for constants that its scenario leaves out.
#[derive(Debug, Clone, Copy)]
pub(super) struct PairDefaults {
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    pub(super) coefficient: f64,
}

/// Reads a law of contact and ends the reading of its table.
pub(super) fn read(
    reader: Reader<'_>,
    defaults: Option<PairDefaults>,
) -> Result<Interface, ScenarioError> {
    let law = reader.choice::<Law>("law")?;
    let basis = reader.choice::<Basis>("basis")?;
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
        Law::Hertz => 1.5,
    };
    // Constants of the catalogue hold together and for one law only.
    let linear = matches!(law, Law::SpeedGap | Law::KelvinVoigt) && basis == Basis::Node;
    let constants = defaults.filter(|_| linear && !reader.has("stiffness"));
    let stiffness_dimension = stiffness_dimension(exponent, basis);
    let stiffness = match quantity_in(&reader, "stiffness", stiffness_dimension)? {
        Some(stiffness) => stiffness,
        None => match constants {
            Some(constants) => constants.stiffness,
            None => return Err(missing_quantity(&reader, "stiffness", stiffness_dimension)),
        },
    };
    let normal = match law {
        Law::SpeedGap | Law::KelvinVoigt => {
            let damping = read_damping(&reader, basis, constants)?;
            if law == Law::SpeedGap {
                NormalLaw::SpeedGap { stiffness, damping }
            } else {
                NormalLaw::KelvinVoigt { stiffness, damping }
            }
        }
        Law::HuntCrossley => {
            NormalLaw::HuntCrossley { stiffness, exponent, damping: reader.quantity("damping")? }
        }
        Law::Hertz => NormalLaw::Hertz { stiffness },
    };
    if defaults.is_none() && !reader.has("friction") {
        return Err(reader.missing("friction"));
    }
    let friction = read_friction(reader.section("friction")?, defaults)?;
    reader.finish();
    Ok(Interface { basis, normal, friction })
}

fn read_damping(
    reader: &Reader<'_>,
    basis: Basis,
    constants: Option<PairDefaults>,
) -> Result<Damping, ScenarioError> {
    let (damping_dimension, mass_dimension) = match basis {
        Basis::Node => (Dimension::DAMPING, Dimension::MASS),
        Basis::Length => (Dimension::DAMPING_PER_LENGTH, Dimension::MASS_PER_LENGTH),
    };
    let damping = quantity_in(reader, "damping", damping_dimension)?;
    let restitution = reader.optional_number("restitution")?;
    let reference_mass = quantity_in(reader, "reference_mass", mass_dimension)?;
    match (damping, restitution, reference_mass, constants) {
        (Some(damping), ..) => Ok(Damping::Coefficient(damping)),
        (None, Some(restitution), Some(reference_mass), _) => {
            Ok(Damping::Restitution { restitution, reference_mass })
        }
        (None, Some(_), None, _) => Err(missing_quantity(reader, "reference_mass", mass_dimension)),
        (None, None, Some(_), _) => Err(reader.missing("restitution")),
        (None, None, None, Some(constants)) => Ok(Damping::Coefficient(constants.damping)),
        (None, None, None, None) => Err(missing_quantity(reader, "damping", damping_dimension)),
    }
}

fn read_friction(
    reader: Reader<'_>,
    defaults: Option<PairDefaults>,
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
                    "`{}` is {static_coefficient}, below the kinetic coefficient {coefficient}; raise it or leave it \
                     out",
                    reader.path_of("static_coefficient")
                );
                return Err(reader.inconsistent("static_coefficient", message));
            }
            Friction::Coulomb {
                coefficient,
                static_coefficient,
                tangential_stiffness_ratio: reader.number("tangential_stiffness_ratio")?,
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
        (true, Basis::Node) => Dimension::STIFFNESS,
        (true, Basis::Length) => Dimension::STIFFNESS_PER_LENGTH,
        (false, Basis::Node) => Dimension::HERTZ_STIFFNESS,
        (false, Basis::Length) => Dimension::HERTZ_STIFFNESS_PER_LENGTH,
    }
}

/// A quantity whose dimension depends on the law and the basis.
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
    let example = format!("`{name} = \"{}\"`", dimension.example());
    let problem = Problem::Missing { field: name.to_owned(), section: reader.label(), example };
    reader.section_error(problem)
}

/// Writes a law of contact of a stack.
pub(super) fn write(interface: &Interface) -> Table {
    let mut writer = Writer::variant(&INTERFACE, law_of(&interface.normal));
    write_fields(&mut writer, interface);
    writer.finish()
}

/// Writes an interface of a free scene.
pub(super) fn write_free(between: &[String; 2], interface: &Interface) -> Table {
    let mut writer = Writer::variant(&FREE_INTERFACE, law_of(&interface.normal));
    writer.pair("between", between);
    write_fields(&mut writer, interface);
    writer.finish()
}

fn law_of(normal: &NormalLaw) -> Law {
    match normal {
        NormalLaw::SpeedGap { .. } => Law::SpeedGap,
        NormalLaw::KelvinVoigt { .. } => Law::KelvinVoigt,
        NormalLaw::HuntCrossley { .. } => Law::HuntCrossley,
        NormalLaw::Hertz { .. } => Law::Hertz,
    }
}

fn write_fields(writer: &mut Writer, interface: &Interface) {
    let basis = interface.basis;
    writer.choice("basis", basis);
    match interface.normal {
        NormalLaw::SpeedGap { stiffness, damping }
        | NormalLaw::KelvinVoigt { stiffness, damping } => {
            writer.quantity_in("stiffness", stiffness, stiffness_dimension(1.0, basis));
            let per_length = basis == Basis::Length;
            match damping {
                Damping::Coefficient(damping) => {
                    let dimension =
                        if per_length { Dimension::DAMPING_PER_LENGTH } else { Dimension::DAMPING };
                    writer.quantity_in("damping", damping, dimension);
                    writer.omit(&["restitution", "reference_mass"]);
                }
                Damping::Restitution { restitution, reference_mass } => {
                    let dimension =
                        if per_length { Dimension::MASS_PER_LENGTH } else { Dimension::MASS };
                    writer.number("restitution", restitution);
                    writer.quantity_in("reference_mass", reference_mass, dimension);
                    writer.omit(&["damping"]);
                }
            }
        }
        NormalLaw::HuntCrossley { stiffness, exponent, damping } => {
            writer.quantity_in("stiffness", stiffness, stiffness_dimension(exponent, basis));
            writer.number("exponent", exponent);
            writer.quantity("damping", damping);
        }
        NormalLaw::Hertz { stiffness } => {
            writer.quantity_in("stiffness", stiffness, stiffness_dimension(1.5, basis));
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
