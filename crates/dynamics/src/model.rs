//! Constant data of a run: bodies, interfaces, and contact pairs.

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
    /// Index of its node set.
    pub nodes: usize,
    /// The body that carries the surface.
    pub target: BodyId,
    /// Index of its surface.
    pub surface: usize,
    /// The law between them.
    pub interface: InterfaceId,
    /// Side of a face on which its contacts count.
    pub counts: Counts,
}

/// Side of a face on which the contacts of a pair count, so that none is counted twice where a face has nodes for one
/// body and is tested exactly by another pair.
///
/// A contact belongs to the face if the other body's center of mass lies before it and the angle between the
/// contact's normal and the face's is within [`Face::widest`](crate::body::Face::widest).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Counts {
    /// Everywhere.
    #[default]
    Everywhere,
    /// Contacts with the target that belong to this face of the contactor.
    BeforeFace(usize),
    /// Contacts with the target that do not belong to this face of the contactor.
    BehindFace(usize),
    /// Contacts with the contactor that do not belong to this face of the target.
    BehindFaceOfTarget(usize),
}

/// Gap (m) within which impacts between bodies of stacks are predicted.
pub const FORESEEN: f64 = 0.01;

/// Subdivision of time steps during impacts: their laws are the stiffest, but only while they are deep.
#[derive(Clone, Debug, PartialEq)]
pub struct Substepping<R> {
    /// Number of substeps of a time step while an impact requires it; an integer, one or more.
    pub substeps: R,
    /// For every interface the penetration (m) that whole time steps resolve; infinite for no limit.
    pub whole_step_depth: Vec<R>,
    /// Additional penetration (m) beyond [`whole_step_depth`](Self::whole_step_depth) that whole steps resolve for a
    /// contact at rest: stability allows more depth than the accuracy of an impact.
    pub resting_allowance: R,
    /// Gap (m) within which impacts are predicted; faster ones are predicted later. [`FORESEEN`] suits stacks.
    pub foreseen_gap: R,
    /// Further rules for fast contacts of whole bodies, if any.
    pub fast: Option<Fast<R>>,
}

/// Substepping of contacts of whole bodies that are too fast for the other rules of [`Substepping`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fast<R> {
    /// Displacement (m) of a contact in a whole step above which it engages or releases its spring and damper too
    /// abruptly.
    pub whole_step_way: R,
    /// Approach speed (m/s) above which an impact is hard: substeps are half as long until no impact is left.
    pub hard: R,
}

/// Returns the pairs of two bodies, the lower ID first.
pub type Meet<'a, S> = dyn Fn(&[Body<S>], [BodyId; 2]) -> Vec<ContactPair> + 'a;

/// Bodies, interfaces and pairs; constant during a run and shared between threads.
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
    /// For every body the first one with equal boundaries, which are read there, so that a thousand equal blocks take
    /// the memory of one.
    pub(crate) alike: Vec<BodyId>,
    pub(crate) substepping: Substepping<S::Real>,
}

/// Reason why bodies and pairs do not form a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// Two bodies have the same name.
    #[error("two bodies are named \"{name}\": give each its own name")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// A free body has no mass.
    #[error("body \"{name}\" has mass {mass} kg: a free body needs a positive, finite mass")]
    Mass {
        /// The body.
        name: String,
        /// Its mass (kg).
        mass: f64,
    },
    /// A free body has no moment of inertia.
    #[error(
        "body \"{name}\" has a moment of inertia of {inertia} kg·m²: a free body needs a positive, \
         finite one"
    )]
    Inertia {
        /// The body.
        name: String,
        /// Its least moment of inertia (kg·m²).
        inertia: f64,
    },
    /// A free body has an unbounded surface.
    #[error("body \"{name}\" carries an unbounded surface: only bodies fixed to the ground may")]
    Unbounded {
        /// The body.
        name: String,
    },
    /// A force element is invalid.
    #[error("element \"{name}\": {problem}")]
    Element {
        /// The element.
        name: String,
        /// The problem.
        problem: &'static str,
    },
    /// A pair refers to a missing item.
    #[error("contact pair {pair} names {what} {index}, but there are only {count}")]
    Dangling {
        /// The pair, counted from 0.
        pair: usize,
        /// Kind of the item.
        what: &'static str,
        /// Its index.
        index: usize,
        /// Number of such items.
        count: usize,
    },
}

impl<S: Space> Model<S> {
    /// Checks bodies, interfaces and pairs, and sorts the pairs.
    ///
    /// `gravity` is the acceleration of free fall (m/s²).
    ///
    /// # Errors
    /// If names repeat, a free body has no mass, no inertia or an unbounded surface, or a pair refers to a missing
    /// item.
    pub fn new(
        bodies: Vec<Body<S>>,
        interfaces: Vec<Interface<S>>,
        pairs: Vec<ContactPair>,
        gravity: S::Vector,
    ) -> Result<Self, ModelError> {
        Self::of_pairs(bodies, interfaces, Pairs::listed(pairs), gravity)
    }

    /// Creates a model as [`Model::new`], where the pairs of two bodies depend only on their kinds, numbered from 0:
    /// `meet` returns the pairs of two bodies, the lower ID first, and must return the same for any others of their
    /// kinds.
    ///
    /// So thousands of bodies need no list of all their pairs, which is quadratic.
    ///
    /// # Errors
    /// As [`Model::new`].
    ///
    /// # Panics
    /// If there is not one kind for each body.
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

    fn of_pairs(
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

    /// Enables substeps during impacts; without this no step is divided.
    ///
    /// # Panics
    /// If there is not one penetration for each interface.
    pub fn set_substepping(&mut self, substepping: Substepping<S::Real>) {
        assert_eq!(
            substepping.whole_step_depth.len(),
            self.interfaces.len(),
            "one penetration for every interface"
        );
        self.substepping = substepping;
    }

    /// Returns the subdivision of steps during impacts.
    pub fn substepping(&self) -> &Substepping<S::Real> {
        &self.substepping
    }

    /// Sets the force elements, replacing those before, in the order in which their forces are summed. A state of the
    /// model must have one entry of `memory` for each.
    ///
    /// # Errors
    /// If an element ties a body to itself or to a missing one, or a constant is invalid.
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

    /// Returns the contact pairs, in the order in which their forces are summed; in a model of kinds their number is
    /// quadratic in that of bodies.
    pub fn pairs(&self) -> impl Iterator<Item = ContactPair> + '_ {
        self.pairs.numbers().map(|number| self.pairs.get(number))
    }

    /// Returns the contact pair with a number, such as that of a [`Contact`](crate::forces::Contact).
    #[inline(always)]
    pub fn pair(&self, number: usize) -> ContactPair {
        self.pairs.get(number)
    }

    /// Calls `report` for each kind of pair, with the candidate contactors and the candidate targets, any of which may
    /// meet.
    pub fn each_meeting(&self, report: &mut TellMeeting<'_>) {
        self.pairs.each(report);
    }

    /// Returns the force elements, in the order of [`Scratch::loads`](crate::Scratch::loads).
    pub fn elements(&self) -> &[Element<S>] {
        &self.elements
    }

    /// Returns the acceleration of free fall (m/s²).
    pub fn gravity(&self) -> S::Vector {
        self.gravity
    }

    /// Sets the acceleration of free fall (m/s²).
    pub fn set_gravity(&mut self, gravity: S::Vector) {
        self.gravity = gravity;
    }

    /// Returns the body with a name.
    pub fn body_named(&self, name: &str) -> Option<BodyId> {
        self.bodies.iter().position(|b| b.name == name)
    }

    /// Returns `true` if any body has viscous damping.
    pub(crate) fn is_damped(&self) -> bool {
        self.inert.iter().any(|body| body.damped)
    }

    /// Returns the body that holds the boundaries of a body.
    #[inline(always)]
    pub(crate) fn bounded(&self, body: BodyId) -> &Body<S> {
        &self.bodies[self.alike[body]]
    }

    /// Returns the nodes that a pair tests.
    pub(crate) fn pair_nodes(&self, pair: &ContactPair) -> &Nodes<S> {
        &self.bounded(pair.contactor).nodes[pair.nodes]
    }
}

/// Returns for every body the first one with equal boundaries, which has the same reach.
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
