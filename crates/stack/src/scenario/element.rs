//! Force elements of a free scene: straps, rods and guides between points of two bodies.

use barrelstack_input::choices::Chosen as _;
use barrelstack_input::declared::Declared as _;
use barrelstack_input::names::advice;
use barrelstack_input::reader::Reader;
use barrelstack_input::{choices, section};

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Kind, Range};
use super::free::{FreeBody, Ground};

section! {
    /// A force element between two bodies of a free scene.
    ///
    /// All numbers are in SI units.
    #[derive(Debug, Clone, PartialEq)]
    pub struct FreeElement;
    /// A force element between points of two bodies of a free scene.
    pub static ELEMENT = "element", by kind of LAWS;
    /// Unique name.
    name: String = Kind::Text, Default::Required;
    /// Law of the element.
    kind: ElementLaw = Kind::Choice(ElementLaw::names), Default::Required;
    /// Names of the two bodies; the ground is named by its `kind`.
    between: [String; 2] = Kind::Pair, Default::Required;
    /// Attachment point on the first body, relative to the reference point of its shape.
    at: [f64; 2] = POINT, Default::Value("[\"0 m\", \"0 m\"]");
    /// Attachment point on the second body, relative to the reference point of its shape.
    to: [f64; 2] = POINT, Default::Value("[\"0 m\", \"0 m\"]");
    /// Force per elongation.
    stiffness: f64 = STIFFNESS, Default::Required;
    /// Force per rate of elongation; a strap damps only while it is taut.
    damping: f64 = DAMPING, Default::Value("\"0 N s/m\"");
}

choices! {
    /// Law of a force element.
    ///
    /// All numbers are in SI units.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub enum ElementLaw, among the fields of ELEMENT;
    /// The laws that a force element can have.
    static LAWS;
    /// A strap, which pulls its bodies together and never pushes them apart.
    Strap = "strap" {
        /// Distance between the attachment points at which the element carries no force.
        length: Option<f64> = LENGTH, AT_START;
        /// Force at which the strap yields and becomes permanently longer; if not given, the strap never yields.
        yields_at: Option<f64> = FORCE, Default::Nothing;
        /// Force above which the strap breaks; if not given, the strap never breaks.
        strength: Option<f64> = FORCE, Default::Nothing;
    }
    /// A rod, which acts in tension and in compression between its two attachment points, such as the rod of a
    /// pendulum.
    Rod = "rod" {
        /// Distance between the attachment points at which the element carries no force.
        length: Option<f64> = LENGTH, AT_START;
        /// Damping force on the second attachment point divided by the velocity of that point, both perpendicular to
        /// the rod.
        sway_damping: f64 = DAMPING, Default::Value("\"0 N s/m\"");
    }
    /// A spring, a damper and stops along an axis that rotates with the first body. The guide carries no force while
    /// the second attachment point is at its initial position relative to the first body.
    Guide = "guide" {
        /// Inclination of the axis in the first body, counterclockwise.
        axis: f64 =
            Kind::Quantity(&[Dimension::ANGLE], Range::between(-100.0, 100.0)), Default::Value("\"0 deg\"");
        /// Stroke to either side before the guide meets a stop; if not given, there are no stops.
        gap: Option<f64> =
            Kind::Quantity(&[Dimension::LENGTH], Range::NOT_NEGATIVE), Default::Nothing;
        /// Stiffness of the stops.
        stop_stiffness: f64 = STIFFNESS, Default::Value("\"0 N/m\"");
        /// Damping of the stops, which acts on approach only.
        stop_damping: f64 = DAMPING, Default::Value("\"0 N s/m\"");
        /// Force above which the guide breaks; if not given, the guide never breaks.
        strength: Option<f64> = FORCE, Default::Nothing;
        /// Distance from the axis beyond which the guide disengages permanently; if not given, the guide never
        /// disengages.
        reach: Option<f64> = LENGTH, Default::Nothing;
    }
}

const POINT: Kind = Kind::Point(Dimension::LENGTH);
const LENGTH: Kind = Kind::Quantity(&[Dimension::LENGTH], Range::POSITIVE);
const FORCE: Kind = Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE);
const STIFFNESS: Kind = Kind::Quantity(&[Dimension::STIFFNESS], Range::NOT_NEGATIVE);
const DAMPING: Kind = Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE);
const AT_START: Default = Default::Derived("the initial distance between the attachment points");

/// Reads the force elements of a free scene.
pub(super) fn read(
    root: &Reader<'_>,
    ground: &Ground,
    bodies: &[FreeBody],
) -> Result<Vec<FreeElement>, ScenarioError> {
    let mut elements: Vec<FreeElement> = Vec::new();
    for reader in root.sections("element")? {
        let element = FreeElement::read_fields(&reader)?;
        let FreeElement { name, between, stiffness, .. } = &element;
        if elements.iter().any(|known| known.name == *name) {
            let message = format!("two elements are called \"{name}\"; give each its own name");
            return Err(reader.inconsistent("name", message));
        }
        for body in between {
            if *body != ground.kind && bodies.iter().all(|known| known.name != *body) {
                let names = bodies.iter().map(|body| body.name.as_str());
                let names: Vec<&str> = names.chain([ground.kind.as_str()]).collect();
                let message = format!("no body is called \"{body}\"; {}", advice(body, &names));
                return Err(reader.inconsistent("between", message));
            }
        }
        if between[0] == between[1] {
            let message = format!("the element ties \"{}\" to itself; name two bodies", between[0]);
            return Err(reader.inconsistent("between", message));
        }
        check_law(&reader, element.kind)?;
        let stops = matches!(element.kind, ElementLaw::Guide { gap: Some(_), .. });
        if *stiffness == 0.0 && !stops {
            let message =
                "an element without stiffness carries no force; state its stiffness".to_owned();
            return Err(reader.inconsistent("stiffness", message));
        }
        elements.push(element);
        reader.finish();
    }
    Ok(elements)
}

fn check_law(reader: &Reader<'_>, law: ElementLaw) -> Result<(), ScenarioError> {
    match law {
        ElementLaw::Guide { gap, stop_stiffness, .. }
            if gap.is_some() != (stop_stiffness > 0.0) =>
        {
            let (given, lacks) = match gap {
                Some(_) => ("gap", "`stop_stiffness`, without which its stops hold nothing"),
                None => ("stop_stiffness", "`gap`, without which there are no stops"),
            };
            let message = format!(
                "a guide with stops also needs {lacks}; state both `gap` and `stop_stiffness`, or \
                 leave both out"
            );
            Err(reader.inconsistent(given, message))
        }
        ElementLaw::Strap { yields_at: Some(yields_at), strength: Some(strength), .. }
            if strength <= yields_at =>
        {
            let message = format!(
                "the strap tears at {strength} N, before it would yield at {yields_at} N; leave `yields_at` out"
            );
            Err(reader.inconsistent("yields_at", message))
        }
        ElementLaw::Guide { .. } | ElementLaw::Strap { .. } | ElementLaw::Rod { .. } => Ok(()),
    }
}
