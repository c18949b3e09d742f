//! Fields of `[interface]`.

use barrelstack_input::{fields, named, table};

use crate::scenario::dimension::Dimension;
use crate::scenario::field::{Default, Field, Kind, Range, Section, Variant, Variants, names};

use super::Basis;

named! {
    pub(super) enum Law {
        SpeedGap = "speed-gap",
        KelvinVoigt = "kelvin-voigt",
        HuntCrossley = "hunt-crossley",
        Hertz = "hertz",
        Rebound = "rebound",
    }
}

named! {
    pub(super) enum FrictionKind {
        Coulomb = "coulomb",
        Regularized = "regularized",
        None = "none",
    }
}

const LAW: Field = Field::new(
    "law",
    Kind::Choice(names::<Law>),
    Default::Value("\"speed-gap\""),
    "Normal force as a function of penetration and its rate.",
);

const IMPACT_LAW: Field = Field::new(
    "law",
    Kind::Choice(names::<Law>),
    Default::Value("\"rebound\""),
    "Normal force as a function of penetration and its rate.",
);

const BASIS: Field = Field::new(
    "basis",
    Kind::Choice(names::<Basis>),
    Default::Value("\"node\""),
    "Stiffness and damping are stated per contact node (node) or per meter of boundary (length).",
);

const SEAT_BASIS: Field = Field::new(
    "basis",
    Kind::Choice(names::<Basis>),
    Default::Value("\"seat\""),
    "Stiffness and damping are stated per seat (seat), per contact node (node) or per meter of boundary (length). A \
     seat is one rail on the crown of a barrel, one support of a cradle, one end of a rail or one foot on the ground, \
     or one post.",
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
    Default::Derived(
        "in a stack with a linear law per seat, the stiffness that the catalog gives for the seats of the rack; in a \
         stack with a linear law per node, 9.8 kN/cm; in a stack with a rebound law per node, 5e8 N/m^1.5 between two \
         racks or between a fallen rack and the ground, and 1.2e9 N/m^1.5 between other bodies; there is no default \
         otherwise",
    ),
    "Stiffness k of one seat, of one node or of one meter of boundary. With a linear law, the unit is N/m for a seat \
     or node, and N/m^2 for a meter of boundary. With the exponent 1.5, the unit is N/m^1.5 for a seat or node, and \
     N/m^2.5 for a meter of boundary.",
);

const FRICTION_FIELD: Field = Field::new(
    "friction",
    Kind::Table(&FRICTION),
    Default::Derived(
        "in a stack, Coulomb friction with the coefficient of the pair; there is no default otherwise",
    ),
    "Friction law, which gives the tangential force.",
);

const RESTITUTION: Field = Field::new(
    "restitution",
    Kind::Number(Range::up_to(1.0)),
    Default::Derived(
        "the restitution that the catalog gives for the seats of the rack, if the constants of the stack are stated \
         per seat and `damping` is not given",
    ),
    "Ratio of normal speeds after and before an impact, stated instead of the damping.",
);

const LINEAR: &[Field] = &[
    Field::new(
        "damping",
        Kind::Quantity(&[Dimension::DAMPING, Dimension::DAMPING_PER_LENGTH], Range::NOT_NEGATIVE),
        Default::Derived(
            "in a stack with constants per seat, the damping that follows from the restitution that the catalog gives \
             for the seats of the rack; in a stack with constants per node, 22 N s/cm if the stiffness is not given \
             either",
        ),
        "Damping c of one seat or node (in N s/m), or of one meter of boundary (in N s/m^2).",
    ),
    RESTITUTION,
    Field::new(
        "reference_mass",
        Kind::Quantity(&[Dimension::MASS, Dimension::MASS_PER_LENGTH], Range::POSITIVE),
        Default::Derived(
            "for constants per seat, the mass that the catalog gives for the seats of the rack; for other constants, \
             there is no default, and the mass is required if `restitution` is given",
        ),
        "Mass for which the restitution is stated: the mass on one seat or node (in kg), or on one meter of boundary \
         (in kg/m).",
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
            help: "Linear spring and damper that never pull.",
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
                    "Exponent of the penetration: 1 or 1.5.",
                ),
                Field::new(
                    "damping",
                    Kind::Quantity(&[Dimension::HUNT_CROSSLEY_DAMPING], Range::NOT_NEGATIVE),
                    Default::Derived(
                        "must be given, unless `restitution` and `reference_speed` are given",
                    ),
                    "Damping d: ratio of the damping force to the elastic force, per unit of penetration rate.",
                ),
                RESTITUTION,
                Field::new(
                    "reference_speed",
                    Kind::Quantity(&[Dimension::VELOCITY], Range::POSITIVE),
                    Default::Derived("required if `restitution` is given"),
                    "Impact speed for which the restitution is stated.",
                ),
            ],
        },
        Variant {
            name: "rebound",
            help: "Spring whose force is proportional to the penetration to the power 1.5; it returns a stated \
                fraction of the impact speed, whatever the mass.",
            fields: &fields! {
                /// Ratio of normal speeds after and before an impact.
                restitution = Kind::Number(Range::up_to(1.0)), Default::Value("0.3");
                /// Impact speed below which the contact damps in proportion to the speed, so that bodies come to rest.
                speed = Kind::Quantity(&[Dimension::VELOCITY], Range::POSITIVE), Default::Value("\"0.1 m/s\"");
            },
        },
        Variant {
            name: "hertz",
            help: "Elastic spring whose force is proportional to the penetration to the power 1.5.",
            fields: &[],
        },
    ],
};

/// Fields that exclude each other, because the damping is specified either directly or by a coefficient of restitution.
const EXCLUSIVE: &[&[&str]] =
    &[&["damping", "restitution"], &["damping", "reference_mass"], &["damping", "reference_speed"]];

/// Definition of the table of the contact law of one pair of bodies in a stack.
pub static INTERFACE: Section = Section {
    name: "interface",
    help: "The contact law of one pair of bodies.",
    fields: &[LAW, SEAT_BASIS, STIFFNESS, FRICTION_FIELD],
    variants: Some(LAWS),
    exclusive: EXCLUSIVE,
};

/// Definition of the table of the contact law of one pair of bodies that touch in impacts only: fallen bodies, or
/// neighbors.
pub static IMPACT: Section = Section {
    name: "impact",
    help: "The contact law of one pair of bodies that touch in impacts only.",
    fields: &[IMPACT_LAW, BASIS, STIFFNESS, FRICTION_FIELD],
    variants: Some(LAWS),
    exclusive: EXCLUSIVE,
};

/// Definition of the table of the contact law between two kinds of bodies or boundaries of a free scene.
pub static FREE_INTERFACE: Section = Section {
    name: "free-interface",
    help: "The contact law between two kinds of bodies.",
    fields: &[
        Field::new(
            "between",
            Kind::Pair,
            Default::Required,
            "The two kinds: the first kind has the contact nodes, and the second has the surface; in three dimensions, \
             the order does not matter.",
        ),
        Field::new(
            "within_groups",
            Kind::Flag,
            Default::Value("true"),
            "True if the interface also acts between bodies of the same `group`.",
        ),
        LAW,
        BASIS,
        STIFFNESS,
        FRICTION_FIELD,
    ],
    variants: Some(LAWS),
    exclusive: EXCLUSIVE,
};

/// Range of plausible friction coefficients.
const COEFFICIENT: Range = Range::between(0.0, 5.0);

const COEFFICIENT_FIELD: Field = Field::new(
    "coefficient",
    Kind::Number(COEFFICIENT),
    Default::Derived("in a stack, the coefficient of the pair; there is no default otherwise"),
    "Kinetic coefficient of friction.",
);

table! {
    /// Tangential force of a contact.
    pub static FRICTION = "friction";
    /// Tangential force as a function of slip.
    law = Kind::Choice(names::<FrictionKind>), Default::Value("\"coulomb\"");
    by law {
        /// Elastic and damped tangential spring (stick) up to the static limit, then sliding.
        "coulomb" with [COEFFICIENT_FIELD] {
            /// Static coefficient of friction, at least as large as the kinetic coefficient.
            static_coefficient = Kind::Number(COEFFICIENT), Default::Derived("the kinetic coefficient");
            /// Ratio of the stiffness of the tangential spring to the normal stiffness; with a stiffer spring, the
            /// friction force reverses over a smaller displacement, but the time step must be smaller.
            tangential_stiffness_ratio = Kind::Number(Range::up_to(100.0)),
                Default::Derived("for constants per seat, the ratio in the catalog: 2 on barrels and on posts, and 4 on \
                    the ground; for all other constants, 1");
            /// Ratio of the damping of the tangential spring to the normal damping.
            tangential_damping_ratio = Kind::Number(Range::between(0.0, 100.0)), Default::Value("1.0");
        }
        /// Sliding friction smoothed around zero slip rate; contacts creep and never stick.
        "regularized" with [COEFFICIENT_FIELD] {
            /// Slip rate at which the friction is fully developed.
            velocity = Kind::Quantity(&[Dimension::VELOCITY], Range::POSITIVE), Default::Required;
        }
        /// No tangential force.
        "none" {}
    }
}
