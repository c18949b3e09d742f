//! What must be the same in all lanes.

use std::mem::{Discriminant, discriminant};

use crate::body::{Body, BodyId, Motion, Nodes};
use crate::contact::{Basis, Exponent, FrictionLaw, Interface, NormalLaw};
use crate::element::Element;
use crate::model::{ContactPair, Model};
use crate::shape::Shape;
use crate::space::Planar;

/// What two models must share to march in one bundle: their bodies, boundaries, laws and pairs in
/// kind and number. Masses, places, sizes and constants may differ.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Topology {
    bodies: Vec<BodyKind>,
    interfaces: Vec<InterfaceKind>,
    pairs: Vec<ContactPair>,
    /// Kind of every force element, and the bodies that it joins.
    elements: Vec<(Discriminant<Element<Planar>>, [BodyId; 2])>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct BodyKind {
    motion: Motion,
    damped: bool,
    /// Kind of every surface, and how many sides it has.
    surfaces: Vec<(Discriminant<Shape>, usize)>,
    /// Kind of every node set, and how many nodes it has.
    nodes: Vec<(Discriminant<Nodes<Planar>>, usize)>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct InterfaceKind {
    normal: Discriminant<NormalLaw>,
    exponent: Option<Exponent>,
    stop: Option<Discriminant<NormalLaw>>,
    rolling: bool,
    friction: Discriminant<FrictionLaw>,
    basis: Basis,
}

impl Topology {
    /// The topology of a model.
    pub fn of(model: &Model<Planar>) -> Self {
        Self {
            bodies: model.bodies.iter().map(BodyKind::of).collect(),
            interfaces: model.interfaces.iter().map(InterfaceKind::of).collect(),
            pairs: model.pairs.clone(),
            elements: model.elements.iter().map(|e| (discriminant(e), e.link().bodies)).collect(),
        }
    }
}

impl BodyKind {
    fn of(body: &Body<Planar>) -> Self {
        let sides = |shape: &Shape| match shape {
            Shape::Polygon(polygon) => polygon.side_count(),
            Shape::Circle(_) | Shape::HalfPlane(_) | Shape::Cradle(_) | Shape::BarrelProfile(_) => {
                0
            }
        };
        let count = |nodes: &Nodes<Planar>| match nodes {
            Nodes::Fixed(nodes) => nodes.len(),
            Nodes::Rounds(rounds) => rounds.len(),
            Nodes::Rolling { .. } => 1,
        };
        let surfaces = body.surfaces.iter().map(|placed| &placed.surface);
        Self {
            motion: body.motion,
            damped: body.damping.is_some(),
            surfaces: surfaces.map(|shape| (discriminant(shape), sides(shape))).collect(),
            nodes: body.nodes.iter().map(|nodes| (discriminant(nodes), count(nodes))).collect(),
        }
    }
}

impl InterfaceKind {
    fn of(interface: &Interface<Planar>) -> Self {
        let exponent = match interface.normal {
            NormalLaw::HuntCrossley { exponent, .. } => Some(exponent),
            NormalLaw::SpeedGap { .. }
            | NormalLaw::KelvinVoigt { .. }
            | NormalLaw::Hertz { .. }
            | NormalLaw::Rebound { .. } => None,
        };
        Self {
            normal: discriminant(&interface.normal),
            exponent,
            stop: interface.stop.as_ref().map(|stop| discriminant(&stop.law)),
            rolling: interface.rolling.is_some(),
            friction: discriminant(&interface.friction),
            basis: interface.basis,
        }
    }
}
