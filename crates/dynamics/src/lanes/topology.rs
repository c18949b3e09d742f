//! Properties of a model that must be equal in all lanes.

use std::mem::{Discriminant, discriminant};

use crate::body::{Body, BodyId, Motion, Nodes, Round};
use crate::contact::{Basis, Exponent, FrictionLaw, Interface, NormalLaw};
use crate::element::Element;
use crate::model::Model;
use crate::pairs::Pairs;
use crate::shape::Shape;
use crate::space::Planar;

/// Properties that must be equal for models that run in one bundle: kinds and numbers of bodies, boundaries, laws and
/// pairs.
///
/// Masses, positions, sizes and constants may differ.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Topology {
    bodies: Vec<BodyKind>,
    interfaces: Vec<InterfaceKind>,
    pairs: Pairs,
    /// Kind of every force element, and the bodies that it joins.
    elements: Vec<(Discriminant<Element<Planar>>, [BodyId; 2])>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct BodyKind {
    name: String,
    motion: Motion,
    damped: bool,
    faces: usize,
    /// Kind of every surface, and the number of its sides.
    surfaces: Vec<(Discriminant<Shape>, usize)>,
    /// Kind of every node set, and the number of its nodes.
    nodes: Vec<(Discriminant<Nodes<Planar>>, usize)>,
    /// For every round piece, `takes_limit`, and which limits and sides are present.
    rounds: Vec<(bool, [bool; 2], [bool; 2])>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct InterfaceKind {
    name: String,
    normal: (Discriminant<NormalLaw>, Option<Exponent>),
    stop: Option<(Discriminant<NormalLaw>, Option<Exponent>)>,
    rolling: bool,
    friction: Discriminant<FrictionLaw>,
    basis: Basis,
}

impl Topology {
    /// Returns the topology of a model.
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
        let rounds = body.nodes.iter().flat_map(|nodes| match nodes {
            Nodes::Rounds(rounds) => rounds.as_slice(),
            Nodes::Fixed(_) | Nodes::Rolling { .. } | Nodes::Whole(_) => &[],
        });
        let ends = |round: &Round<Planar>| {
            let arcs = round.arc_limits.map(|limit| limit.is_some());
            (round.takes_limit, arcs, round.sides.map(|side| side.is_some()))
        };
        let surfaces = body.surfaces.iter().map(|placed| &placed.surface);
        Self {
            name: body.name.clone(),
            motion: body.motion,
            damped: body.damping.is_some(),
            faces: body.faces.len(),
            surfaces: surfaces.map(|shape| (discriminant(shape), sides(shape))).collect(),
            nodes: body.nodes.iter().map(|set| (discriminant(set), set.count())).collect(),
            rounds: rounds.map(ends).collect(),
        }
    }
}

impl InterfaceKind {
    fn of(interface: &Interface<Planar>) -> Self {
        let kind = |law: &NormalLaw| {
            let exponent = match law {
                NormalLaw::HuntCrossley { exponent, .. } => Some(*exponent),
                NormalLaw::SpeedGap { .. }
                | NormalLaw::KelvinVoigt { .. }
                | NormalLaw::Hertz { .. }
                | NormalLaw::Rebound { .. } => None,
            };
            (discriminant(law), exponent)
        };
        Self {
            name: interface.name.clone(),
            normal: kind(&interface.normal),
            stop: interface.stop.as_ref().map(|stop| kind(&stop.law)),
            rolling: interface.rolling.is_some(),
            friction: discriminant(&interface.friction),
            basis: interface.basis,
        }
    }
}
