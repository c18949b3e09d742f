//! Properties of a model that must be equal in all lanes.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::mem::discriminant;

use crate::body::{Body, BodyId, Motion, Nodes, Round};
use crate::contact::{Basis, Exponent, Interface, NormalLaw};
use crate::model::Model;
use crate::pairs::Pairs;
use crate::shape::{Surface as _, Whole as _};
use crate::space::Space;

/// Variant of an enum, as a number that does not depend on the scalar.
type Kind = u64;

/// Returns the variant of an enum.
pub(crate) fn kind<T>(value: &T) -> Kind {
    let mut hasher = DefaultHasher::new();
    discriminant(value).hash(&mut hasher);
    hasher.finish()
}

/// Properties that must be equal for models that run in one bundle: kinds and numbers of bodies, boundaries, contact
/// laws and contact pairs.
///
/// Masses, positions, sizes and constants may differ.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Topology {
    bodies: Vec<BodyKind>,
    interfaces: Vec<InterfaceKind>,
    pairs: Pairs,
    /// Kind of every force element, and the bodies that it joins.
    elements: Vec<(Kind, [BodyId; 2])>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct BodyKind {
    name: String,
    motion: Motion,
    damped: bool,
    faces: usize,
    /// Kind of every surface, and the number of its sides.
    surfaces: Vec<(Kind, usize)>,
    /// Kind of every node set, and the number of its nodes.
    nodes: Vec<(Kind, usize)>,
    /// Kind of every convex solid ([`Nodes::Whole`]).
    hulls: Vec<Kind>,
    /// For every round piece, [`Round::takes_limit`], and which of its [`Round::arc_limits`] and [`Round::sides`] are
    /// present.
    rounds: Vec<(bool, [bool; 2], [bool; 2])>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct InterfaceKind {
    name: String,
    normal: (Kind, Option<Exponent>),
    stop: Option<(Kind, Option<Exponent>)>,
    rolling: bool,
    friction: Kind,
    basis: Basis,
}

impl Topology {
    /// Returns the topology of a model.
    pub fn of<S: Space>(model: &Model<S>) -> Self {
        Self {
            bodies: model.bodies.iter().map(BodyKind::of).collect(),
            interfaces: model.interfaces.iter().map(InterfaceKind::of).collect(),
            pairs: model.pairs.clone(),
            elements: model.elements.iter().map(|e| (kind(e), e.link().bodies)).collect(),
        }
    }
}

impl BodyKind {
    fn of<S: Space>(body: &Body<S>) -> Self {
        let rounds = body.nodes.iter().flat_map(|nodes| match nodes {
            Nodes::Rounds(rounds) => rounds.as_slice(),
            Nodes::Fixed(_) | Nodes::Rolling { .. } | Nodes::Whole(_) => &[],
        });
        let hulls = body.nodes.iter().filter_map(|nodes| match nodes {
            Nodes::Whole(whole) => Some(whole.kind()),
            Nodes::Fixed(_) | Nodes::Rounds(_) | Nodes::Rolling { .. } => None,
        });
        let ends = |round: &Round<S>| {
            let arcs = round.arc_limits.map(|limit| limit.is_some());
            (round.takes_limit, arcs, round.sides.map(|side| side.is_some()))
        };
        let surfaces = body.surfaces.iter().map(|placed| &placed.surface);
        Self {
            name: body.name.clone(),
            motion: body.motion,
            damped: body.damping.is_some(),
            faces: body.faces.len(),
            surfaces: surfaces.map(|shape| (kind(shape), shape.side_count())).collect(),
            nodes: body.nodes.iter().map(|set| (kind(set), set.count())).collect(),
            hulls: hulls.collect(),
            rounds: rounds.map(ends).collect(),
        }
    }
}

impl InterfaceKind {
    fn of<S: Space>(interface: &Interface<S>) -> Self {
        let law = |law: &NormalLaw<S::Real>| {
            let exponent = match law {
                NormalLaw::HuntCrossley { exponent, .. } => Some(*exponent),
                NormalLaw::SpeedGap { .. }
                | NormalLaw::KelvinVoigt { .. }
                | NormalLaw::Hertz { .. }
                | NormalLaw::Rebound { .. } => None,
            };
            (kind(law), exponent)
        };
        Self {
            name: interface.name.clone(),
            normal: law(&interface.normal),
            stop: interface.stop.as_ref().map(|stop| law(&stop.law)),
            rolling: interface.rolling.is_some(),
            friction: kind(&interface.friction),
            basis: interface.basis,
        }
    }
}
