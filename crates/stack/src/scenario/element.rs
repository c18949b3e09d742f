//! The force elements of a free scene: straps, rods and guides between points of two bodies.

use barrelstack_input::reader::Reader;
use barrelstack_input::writer::Writer;

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Field, Kind, Named, Range, Section, Variant, Variants, names};
use super::free::{FreeBody, Ground};
use super::tree::Table;

/// A force element between two bodies of a free scene.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeElement {
    /// Unique name.
    pub name: String,
    /// Names of its bodies; the label of the ground is one.
    pub between: [String; 2],
    /// Where it is made fast (m), on each body from the reference point of its shape.
    pub points: [[f64; 2]; 2],
    /// Stiffness (N/m).
    pub stiffness: f64,
    /// Damping (N·s/m).
    pub damping: f64,
    /// What it does.
    pub law: ElementLaw,
}

/// What a force element does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ElementLaw {
    /// It pulls, and never pushes.
    Strap {
        /// Length (m) from which on it pulls; the distance of its points at the start without.
        length: Option<f64>,
        /// Tension (N) at which it yields, for good.
        yields_at: Option<f64>,
        /// Tension (N) above which it tears.
        strength: Option<f64>,
    },
    /// It holds a distance, pulling and pushing.
    Rod {
        /// Length (m) at which it bears nothing; the distance of its points at the start without.
        length: Option<f64>,
        /// Damping across it (N·s/m).
        sway_damping: f64,
    },
    /// A spring, a damper and stops along an axis of its first body.
    Guide {
        /// Inclination of the axis in the first body, counterclockwise (rad).
        axis: f64,
        /// Way to either side (m) after which there are stops.
        gap: Option<f64>,
        /// Stiffness of the stops (N/m).
        stop_stiffness: f64,
        /// Damping of the stops on approach (N·s/m).
        stop_damping: f64,
        /// Force (N) above which it breaks.
        strength: Option<f64>,
        /// Distance (m) from the axis beyond which it has let go.
        reach: Option<f64>,
    },
}

const POINT: Kind = Kind::Point(Dimension::LENGTH);
const LENGTH: Kind = Kind::Quantity(&[Dimension::LENGTH], Range::POSITIVE);
const FORCE: Kind = Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE);
const STIFFNESS: Kind = Kind::Quantity(&[Dimension::STIFFNESS], Range::NOT_NEGATIVE);
const DAMPING: Kind = Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE);

const LENGTH_FIELD: Field = Field::new(
    "length",
    LENGTH,
    Default::Derived("the distance of its points at the start"),
    "Distance of its points at which it bears nothing.",
);
const STRENGTH_FIELD: Field = Field::new(
    "strength",
    FORCE,
    Default::Nothing,
    "Force above which it breaks, for good; without it it never does.",
);

/// A force element.
pub static ELEMENT: Section = Section {
    name: "element",
    help: "A force element between points of two bodies of a free scene.",
    fields: &[
        Field::new("name", Kind::Text, Default::Required, "Unique name."),
        Field::new("kind", Kind::Choice(names::<LawName>), Default::Required, "What it does."),
        Field::new(
            "between",
            Kind::Pair,
            Default::Required,
            "The names of two bodies; the ground is called by its label.",
        ),
        Field::new(
            "at",
            POINT,
            Default::Value("[\"0 m\", \"0 m\"]"),
            "Where it is made fast to the first body, from the reference point of its shape.",
        ),
        Field::new(
            "to",
            POINT,
            Default::Value("[\"0 m\", \"0 m\"]"),
            "Where it is made fast to the second body, from the reference point of its shape.",
        ),
        Field::new("stiffness", STIFFNESS, Default::Required, "Force per elongation."),
        Field::new(
            "damping",
            DAMPING,
            Default::Value("\"0 N s/m\""),
            "Force per rate of elongation; of a strap while it is taut.",
        ),
    ],
    variants: Some(Variants {
        tag: "kind",
        list: &[
            Variant {
                name: "strap",
                help: "It pulls its bodies together, and never pushes them apart.",
                fields: &[
                    LENGTH_FIELD,
                    Field::new(
                        "yields_at",
                        FORCE,
                        Default::Nothing,
                        "Force at which it becomes longer for good; without it it never does.",
                    ),
                    STRENGTH_FIELD,
                ],
            },
            Variant {
                name: "rod",
                help: "It holds a distance, pulling and pushing; a pendulum hangs on one.",
                fields: &[
                    LENGTH_FIELD,
                    Field::new(
                        "sway_damping",
                        DAMPING,
                        Default::Value("\"0 N s/m\""),
                        "Force per velocity of its second point across it.",
                    ),
                ],
            },
            Variant {
                name: "guide",
                help: "A spring, a damper and stops along an axis that turns with the first body; it bears nothing \
                       where the second point is at the start.",
                fields: &[
                    Field::new(
                        "axis",
                        Kind::Quantity(&[Dimension::ANGLE], Range::between(-100.0, 100.0)),
                        Default::Value("\"0 deg\""),
                        "Inclination of the axis in the first body, counterclockwise.",
                    ),
                    Field::new(
                        "gap",
                        Kind::Quantity(&[Dimension::LENGTH], Range::NOT_NEGATIVE),
                        Default::Nothing,
                        "Way to either side after which there are stops; without it there are none.",
                    ),
                    Field::new(
                        "stop_stiffness",
                        STIFFNESS,
                        Default::Value("\"0 N/m\""),
                        "Stiffness of the stops.",
                    ),
                    Field::new(
                        "stop_damping",
                        DAMPING,
                        Default::Value("\"0 N s/m\""),
                        "Damping of the stops, on approach only.",
                    ),
                    STRENGTH_FIELD,
                    Field::new(
                        "reach",
                        LENGTH,
                        Default::Nothing,
                        "Distance from the axis beyond which it has let go, for good; without it it never does.",
                    ),
                ],
            },
        ],
    }),
    exclusive: &[],
};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LawName {
    Strap,
    Rod,
    Guide,
}

impl Named for LawName {
    const NAMES: &'static [(&'static str, Self)] =
        &[("strap", Self::Strap), ("rod", Self::Rod), ("guide", Self::Guide)];
}

/// Reads the elements between bodies.
pub(super) fn read(
    root: &Reader<'_>,
    ground: &Ground,
    bodies: &[FreeBody],
) -> Result<Vec<FreeElement>, ScenarioError> {
    let mut elements: Vec<FreeElement> = Vec::new();
    for reader in root.sections("element")? {
        let name = reader.text("name")?;
        if elements.iter().any(|known| known.name == name) {
            let message = format!("two elements are called \"{name}\"; give each its own name");
            return Err(reader.inconsistent("name", message));
        }
        let between = reader.pair("between")?;
        for body in &between {
            if *body != ground.kind && bodies.iter().all(|known| known.name != *body) {
                let names = bodies.iter().map(|body| body.name.as_str()).take(20);
                let names: Vec<&str> = names.chain([ground.kind.as_str()]).collect();
                let message =
                    format!("no body is called \"{body}\"; there are {}", names.join(", "));
                return Err(reader.inconsistent("between", message));
            }
        }
        if between[0] == between[1] {
            let message = format!("it ties \"{}\" to itself; name two bodies", between[0]);
            return Err(reader.inconsistent("between", message));
        }
        let law = read_law(&reader)?;
        let stiffness = reader.quantity("stiffness")?;
        let stops = matches!(law, ElementLaw::Guide { gap: Some(_), .. });
        if stiffness == 0.0 && !stops {
            let message = "an element without stiffness holds nothing; give it one".to_owned();
            return Err(reader.inconsistent("stiffness", message));
        }
        elements.push(FreeElement {
            name,
            between,
            points: [reader.point("at")?, reader.point("to")?],
            stiffness,
            damping: reader.quantity("damping")?,
            law,
        });
        reader.finish();
    }
    Ok(elements)
}

fn read_law(reader: &Reader<'_>) -> Result<ElementLaw, ScenarioError> {
    let law = match reader.choice("kind")? {
        LawName::Strap => ElementLaw::Strap {
            length: reader.optional_quantity("length")?,
            yields_at: reader.optional_quantity("yields_at")?,
            strength: reader.optional_quantity("strength")?,
        },
        LawName::Rod => ElementLaw::Rod {
            length: reader.optional_quantity("length")?,
            sway_damping: reader.quantity("sway_damping")?,
        },
        LawName::Guide => ElementLaw::Guide {
            axis: reader.quantity("axis")?,
            gap: reader.optional_quantity("gap")?,
            stop_stiffness: reader.quantity("stop_stiffness")?,
            stop_damping: reader.quantity("stop_damping")?,
            strength: reader.optional_quantity("strength")?,
            reach: reader.optional_quantity("reach")?,
        },
    };
    match law {
        ElementLaw::Guide { gap, stop_stiffness, .. }
            if gap.is_some() != (stop_stiffness > 0.0) =>
        {
            let (given, lacks) = match gap {
                Some(_) => ("gap", "`stop_stiffness`, without which its stops hold nothing"),
                None => ("stop_stiffness", "`gap`, without which there are no stops"),
            };
            let message = format!("a guide with stops needs {lacks}, too; give both or none");
            Err(reader.inconsistent(given, message))
        }
        ElementLaw::Strap { yields_at: Some(yields_at), strength: Some(strength), .. }
            if strength <= yields_at =>
        {
            let message = format!(
                "it tears at {strength} N, before it would yield at {yields_at} N; leave `yields_at` out"
            );
            Err(reader.inconsistent("yields_at", message))
        }
        ElementLaw::Guide { .. } | ElementLaw::Strap { .. } | ElementLaw::Rod { .. } => Ok(law),
    }
}

/// Writes an element.
pub(super) fn write(element: &FreeElement) -> Table {
    let kind = match element.law {
        ElementLaw::Strap { .. } => LawName::Strap,
        ElementLaw::Rod { .. } => LawName::Rod,
        ElementLaw::Guide { .. } => LawName::Guide,
    };
    let mut writer = Writer::variant(&ELEMENT, kind);
    writer.text("name", &element.name);
    writer.pair("between", &element.between);
    writer.point("at", element.points[0]);
    writer.point("to", element.points[1]);
    writer.quantity("stiffness", element.stiffness);
    writer.quantity("damping", element.damping);
    match element.law {
        ElementLaw::Strap { length, yields_at, strength } => {
            writer.optional_quantity("length", length);
            writer.optional_quantity("yields_at", yields_at);
            writer.optional_quantity("strength", strength);
        }
        ElementLaw::Rod { length, sway_damping } => {
            writer.optional_quantity("length", length);
            writer.quantity("sway_damping", sway_damping);
        }
        ElementLaw::Guide { axis, gap, stop_stiffness, stop_damping, strength, reach } => {
            writer.quantity("axis", axis);
            writer.optional_quantity("gap", gap);
            writer.quantity("stop_stiffness", stop_stiffness);
            writer.quantity("stop_damping", stop_damping);
            writer.optional_quantity("strength", strength);
            writer.optional_quantity("reach", reach);
        }
    }
    writer.finish()
}
