//! The model: bodies, interfaces, contact pairs and force elements, which are constant during a run.

use std::collections::BTreeMap;

use crate::body::{Body, BodyId, Inert, Motion, Nodes};
use crate::contact::Interface;
use crate::element::Element;
use crate::pairs::Pairs;
pub use crate::pairs::TellMeeting;
use crate::real::Real;
use crate::space::Space;

/// Index of an interface in its model.
pub type InterfaceId = usize;

/// A pair of boundaries: nodes of the contactor are tested against a surface of the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContactPair {
    /// The body that carries the nodes.
    pub contactor: BodyId,
    /// Index of the node set of the contactor.
    pub nodes: usize,
    /// The body that carries the surface.
    pub target: BodyId,
    /// Index of the surface of the target.
    pub surface: usize,
    /// Index of the interface that contains the contact laws of the pair.
    pub interface: InterfaceId,
    /// Filter that selects contacts by their position relative to a face.
    pub counts: Counts,
}

/// Filter that assigns each contact near a face to exactly one pair. One pair may test the nodes of a face, and another
/// pair may test the exact boundary at the same face. Without the filter, a contact found by both pairs would be
/// counted twice.
///
/// A contact belongs to the face if the other body's center of mass lies in front of the face and the angle between the
/// normals of contact and face is within [`Face::widest`](crate::body::Face::widest).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Counts {
    /// Counts all contacts.
    #[default]
    Everywhere,
    /// Counts only contacts that belong to the contactor's face with this index.
    BeforeFace(usize),
    /// Counts only contacts that do not belong to the contactor's face with this index.
    BehindFace(usize),
    /// Counts only contacts that do not belong to the target's face with this index.
    BehindFaceOfTarget(usize),
}

/// Gap (m) below which impacts between bodies of a stack are predicted.
pub const FORESEEN: f64 = 0.01;

/// Subdivision of time steps during impacts.
///
/// Impact laws are the stiffest contact laws of a model, but they are stiff only at large penetration, so steps are
/// divided only then.
#[derive(Clone, Debug, PartialEq)]
pub struct Substepping<R> {
    /// Number of substeps into which a time step is divided while an impact requires it; an integer, at least one.
    pub substeps: R,
    /// For every interface, the penetration (m) above which a time step is divided; infinite for no limit.
    pub whole_step_depth: Vec<R>,
    /// Amount (m) by which the penetration of a contact at rest may exceed [`whole_step_depth`](Self::whole_step_depth)
    /// before a step is divided. For a contact at rest, an undivided step must only be stable; for an impact, it must
    /// also be accurate.
    pub resting_allowance: R,
    /// Gap (m) below which impacts are predicted. If a larger gap closes within the time over which impacts are
    /// predicted, the impact is detected late. [`FORESEEN`] suits stacks.
    pub foreseen_gap: R,
    /// Additional rules for fast contacts of [`Nodes::Whole`]; `None` to disable them.
    pub fast: Option<Fast<R>>,
}

/// Additional substepping rules for fast contacts of [`Nodes::Whole`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fast<R> {
    /// Displacement (m) along the contact normal during a whole step, above which the step is divided. During an
    /// undivided step, the spring and the damper of such a contact would engage or release too abruptly.
    pub whole_step_way: R,
    /// Approach speed (m/s) above which an impact counts as hard. As soon as a hard impact is predicted, the substeps
    /// are half as long, until no substeps are needed anymore.
    pub hard: R,
}

/// Function that returns the contact pairs of two bodies; the body with the lower ID is given first.
pub type Meet<'a, S> = dyn Fn(&[Body<S>], [BodyId; 2]) -> Vec<ContactPair> + 'a;

/// Bodies, interfaces, contact pairs and force elements; constant during a run and shared between threads.
#[derive(Clone, Debug)]
pub struct Model<S: Space> {
    pub(crate) bodies: Vec<Body<S>>,
    /// Body data that every step reads.
    pub(crate) inert: Vec<Inert<S>>,
    pub(crate) interfaces: Vec<Interface<S>>,
    pub(crate) pairs: Pairs,
    pub(crate) elements: Vec<Element<S>>,
    pub(crate) gravity: S::Vector,
    pub(crate) reach: Vec<f64>,
    /// For every body, the first body with equal boundaries. Boundaries are read from the first body, so that a
    /// thousand equal blocks need no more cache than one block.
    pub(crate) alike: Vec<BodyId>,
    pub(crate) substepping: Substepping<S::Real>,
}

/// Reason why a model is invalid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// Two bodies have the same name.
    #[error("two bodies are named \"{name}\": give each its own name")]
    DuplicateName {
        /// The name of both bodies.
        name: String,
    },
    /// The mass of a free body is not positive or not finite.
    #[error("body \"{name}\" has mass {mass} kg: a free body needs a positive, finite mass")]
    Mass {
        /// Name of the body.
        name: String,
        /// Mass (kg) of the body.
        mass: f64,
    },
    /// The moment of inertia of a free body is not positive or not finite.
    #[error(
        "body \"{name}\" has a moment of inertia of {inertia} kg·m²: a free body needs a positive, \
         finite moment of inertia"
    )]
    Inertia {
        /// Name of the body.
        name: String,
        /// Smallest principal moment of inertia (kg·m²) of the body.
        inertia: f64,
    },
    /// A free body has an unbounded surface.
    #[error("body \"{name}\" has an unbounded surface but is free: fix the body to the ground")]
    Unbounded {
        /// Name of the body.
        name: String,
    },
    /// A force element is invalid.
    #[error("element \"{name}\": {problem}")]
    Element {
        /// Name of the element.
        name: String,
        /// The problem.
        problem: &'static str,
    },
    /// A pair refers to a missing item.
    #[error("contact pair {pair} refers to {what} {index}, but only {count} exist")]
    Dangling {
        /// Index of the pair, counted from 0.
        pair: usize,
        /// Kind of the missing item.
        what: &'static str,
        /// Index of the missing item.
        index: usize,
        /// Number of existing items of this kind.
        count: usize,
    },
}

impl<S: Space> Model<S> {
    /// Creates a model: checks bodies, interfaces and pairs, and sorts the pairs.
    ///
    /// `gravity` is the gravitational acceleration (m/s²).
    ///
    /// # Errors
    /// If two bodies have the same name, if the mass or a moment of inertia of a free body is not positive and finite,
    /// if a free body has an unbounded surface, or if a pair refers to a missing item.
    pub fn new(
        bodies: Vec<Body<S>>,
        interfaces: Vec<Interface<S>>,
        pairs: Vec<ContactPair>,
        gravity: S::Vector,
    ) -> Result<Self, ModelError> {
        Self::of_pairs(bodies, interfaces, Pairs::listed(pairs), gravity)
    }

    /// Creates a model as [`Model::new`] does, with contact pairs that depend only on the kinds of the bodies.
    ///
    /// `kinds` has the kind of every body, numbered from 0. `meet` receives two bodies, the one with the lower ID
    /// first, and returns their pairs. For any other two bodies of the same kinds, it must return equivalent pairs.
    ///
    /// No list of all pairs is stored, since its length would be quadratic in the number of bodies.
    ///
    /// # Errors
    /// As [`Model::new`].
    ///
    /// # Panics
    /// If `kinds` does not have exactly one entry for each body.
    pub fn of_kinds(
        bodies: Vec<Body<S>>,
        interfaces: Vec<Interface<S>>,
        kinds: Vec<usize>,
        meet: &Meet<'_, S>,
        gravity: S::Vector,
    ) -> Result<Self, ModelError> {
        assert_eq!(kinds.len(), bodies.len(), "one kind for each body");
        let pairs = Pairs::of_kinds(kinds, &|between| meet(&bodies, between));
        Self::of_pairs(bodies, interfaces, pairs, gravity)
    }

    pub(crate) fn of_pairs(
        bodies: Vec<Body<S>>,
        interfaces: Vec<Interface<S>>,
        pairs: Pairs,
        gravity: S::Vector,
    ) -> Result<Self, ModelError> {
        let mut names: Vec<&str> = bodies.iter().map(|b| b.name.as_str()).collect();
        names.sort_unstable();
        if let Some(two) = names.windows(2).find(|two| two[0] == two[1]) {
            return Err(ModelError::DuplicateName { name: two[0].to_owned() });
        }
        for body in bodies.iter().filter(|b| b.motion == Motion::Free) {
            for lane in 0..S::Real::LANES {
                let mass = body.mass.lane(lane);
                if !(mass > 0.0 && mass.is_finite()) {
                    return Err(ModelError::Mass { name: body.name.clone(), mass });
                }
                let inertia = S::least_inertia(body.inertia, lane);
                if !(inertia > 0.0 && inertia.is_finite()) {
                    return Err(ModelError::Inertia { name: body.name.clone(), inertia });
                }
            }
            if body.is_unbounded() {
                return Err(ModelError::Unbounded { name: body.name.clone() });
            }
        }
        let mut dangling = Ok(());
        let mut pair = 0;
        pairs.each(&mut |p, contactors, targets| {
            let mut check = |what, index, count| {
                if index >= count && dangling.is_ok() {
                    dangling = Err(ModelError::Dangling { pair, what, index, count });
                }
            };
            check("interface", p.interface, interfaces.len());
            for id in contactors {
                check("body", *id, bodies.len());
                let Some(body) = bodies.get(*id) else { continue };
                check("node set", p.nodes, body.nodes.len());
                match p.counts {
                    Counts::Everywhere | Counts::BehindFaceOfTarget(_) => {}
                    Counts::BeforeFace(face) | Counts::BehindFace(face) => {
                        check("face", face, body.faces.len());
                    }
                }
            }
            for id in targets {
                check("body", *id, bodies.len());
                let Some(body) = bodies.get(*id) else { continue };
                check("surface", p.surface, body.surfaces.len());
                if let Counts::BehindFaceOfTarget(face) = p.counts {
                    check("face", face, body.faces.len());
                }
            }
            pair += 1;
        });
        dangling?;
        let reach: Vec<f64> = bodies.iter().map(Body::reach).collect();
        let alike = alike(&bodies, &reach);
        let inert = bodies.iter().map(Inert::of).collect();
        let whole_step_depth = vec![S::Real::splat(f64::INFINITY); interfaces.len()];
        let substepping = Substepping {
            substeps: S::Real::splat(1.0),
            whole_step_depth,
            resting_allowance: S::Real::zero(),
            foreseen_gap: S::Real::splat(FORESEEN),
            fast: None,
        };
        let elements = Vec::new();
        Ok(Self { bodies, inert, interfaces, pairs, elements, gravity, reach, alike, substepping })
    }

    /// Enables substeps during impacts. In a new model, substeps are disabled.
    ///
    /// # Panics
    /// If the length of `whole_step_depth` differs from the number of interfaces.
    pub fn set_substepping(&mut self, substepping: Substepping<S::Real>) {
        assert_eq!(
            substepping.whole_step_depth.len(),
            self.interfaces.len(),
            "one penetration for every interface"
        );
        self.substepping = substepping;
    }

    /// Returns the rules for substeps during impacts.
    pub fn substepping(&self) -> &Substepping<S::Real> {
        &self.substepping
    }

    /// Sets the force elements, replacing all earlier ones.
    ///
    /// Forces are summed in the order of the elements. A state of the model needs one entry of `memory` for each
    /// element.
    ///
    /// # Errors
    /// If an element joins a body to itself or to a missing body, or has an invalid constant.
    pub fn fasten(&mut self, elements: Vec<Element<S>>) -> Result<(), ModelError> {
        for element in &elements {
            if let Some(problem) = element.problem(self.bodies.len()) {
                return Err(ModelError::Element { name: element.link().name.clone(), problem });
            }
        }
        self.elements = elements;
        Ok(())
    }

    /// Returns the bodies, in the order of their IDs.
    pub fn bodies(&self) -> &[Body<S>] {
        &self.bodies
    }

    /// Returns the interfaces, in the order of their IDs.
    pub fn interfaces(&self) -> &[Interface<S>] {
        &self.interfaces
    }

    /// Returns the contact pairs, in the order in which their forces are summed; in a model created by
    /// [`Model::of_kinds`], the number of pairs is quadratic in the number of bodies.
    pub fn pairs(&self) -> impl Iterator<Item = ContactPair> + '_ {
        self.pairs.numbers().map(|number| self.pairs.get(number))
    }

    /// Returns the contact pair with the index `number`; [`Contact::pair`](crate::forces::Contact::pair) is such an
    /// index.
    #[inline(always)]
    pub fn pair(&self, number: usize) -> ContactPair {
        self.pairs.get(number)
    }

    /// Returns the index of the first contact pair between different parties of a [joined](crate::join::joined) model.
    pub fn first_foreign_pair(&self) -> usize {
        self.pairs.first_foreign()
    }

    /// Calls `report` once for each kind of pair, with all bodies that may be its contactor and all bodies that may be
    /// its target. Pairs between the parties of a [joined](crate::join::joined) model are left out.
    pub fn each_meeting(&self, report: &mut TellMeeting<'_>) {
        self.pairs.each(report);
    }

    /// Returns the force elements, in the order of [`Scratch::loads`](crate::Scratch::loads).
    pub fn elements(&self) -> &[Element<S>] {
        &self.elements
    }

    /// Returns the gravitational acceleration (m/s²).
    pub fn gravity(&self) -> S::Vector {
        self.gravity
    }

    /// Sets the gravitational acceleration (m/s²).
    pub fn set_gravity(&mut self, gravity: S::Vector) {
        self.gravity = gravity;
    }

    /// Returns the body with the given name; `None` if there is no such body.
    pub fn body_named(&self, name: &str) -> Option<BodyId> {
        self.bodies.iter().position(|b| b.name == name)
    }

    /// Returns `true` if any body has viscous damping.
    pub(crate) fn is_damped(&self) -> bool {
        self.inert.iter().any(|body| body.damped)
    }

    /// Returns the body whose stored boundaries are used for `body`: the first body with equal boundaries.
    #[inline(always)]
    pub(crate) fn bounded(&self, body: BodyId) -> &Body<S> {
        &self.bodies[self.alike[body]]
    }

    /// Returns the node set of the contactor of a pair.
    pub(crate) fn pair_nodes(&self, pair: &ContactPair) -> &Nodes<S> {
        &self.bounded(pair.contactor).nodes[pair.nodes]
    }
}

/// Returns, for every body, the first body with equal boundaries and equal [`Body::reach`].
fn alike<S: Space>(bodies: &[Body<S>], reach: &[f64]) -> Vec<BodyId> {
    let mut firsts: BTreeMap<u64, Vec<BodyId>> = BTreeMap::new();
    let first = |(id, body): (BodyId, &Body<S>)| {
        let known = firsts.entry(reach[id].to_bits()).or_default();
        let same = known.iter().copied().find(|known| {
            let known = &bodies[*known];
            known.surfaces == body.surfaces
                && known.nodes == body.nodes
                && known.faces == body.faces
        });
        same.unwrap_or_else(|| {
            known.push(id);
            id
        })
    };
    bodies.iter().enumerate().map(first).collect()
}
