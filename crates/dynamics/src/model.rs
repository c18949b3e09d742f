//! What does not change during a run: bodies, interfaces, and which boundaries may meet.

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

/// Nodes of the contactor are tested against a surface of the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContactPair {
    /// The body that carries the nodes.
    pub contactor: BodyId,
    /// Which of its node sets.
    pub nodes: usize,
    /// The body that carries the surface.
    pub target: BodyId,
    /// Which of its surfaces.
    pub surface: usize,
    /// The law between them.
    pub interface: InterfaceId,
    /// Where its contacts count.
    pub counts: Counts,
}

/// Where the contacts of a pair count: so that none is counted twice where a face carries nodes for one
/// body and is tested exactly by another pair.
///
/// A contact is one of the face where the other body's center of mass lies before it and the contact's normal
/// points no further aside than [`Face::widest`](crate::body::Face::widest).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Counts {
    /// Everywhere.
    #[default]
    Everywhere,
    /// Contacts with the target that are of this face of the contactor.
    BeforeFace(usize),
    /// Contacts with the target that are not of this face of the contactor.
    BehindFace(usize),
    /// Contacts with the contactor that are not of this face of the target.
    BehindFaceOfTarget(usize),
}

/// How closely impacts are followed: their laws are the stiffest, but only while they are deep.
#[derive(Clone, Debug, PartialEq)]
pub struct Substepping<R> {
    /// Into how many short steps a time step is divided while an impact asks for it; a whole number, one or
    /// more.
    pub substeps: R,
    /// Of every interface the penetration (m) that whole time steps follow well enough; infinite where
    /// they follow any.
    pub whole_step_depth: Vec<R>,
    /// Penetration (m) beyond [`whole_step_depth`](Self::whole_step_depth) that whole steps still follow where a
    /// contact is at rest: stability allows more depth than the accuracy of an impact does.
    pub resting_allowance: R,
    /// What of whole bodies that are fast asks for more; none where nothing does.
    pub fast: Option<Fast<R>>,
}

/// How contacts of whole bodies are followed that are too fast for what [`Substepping`] says of all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fast<R> {
    /// The way (m) that a contact may go in a whole step: what goes further meets or leaves its spring and its damper too
    /// abruptly.
    pub whole_step_way: R,
    /// The speed of approach (m/s) from which on an impact is hard: short steps are half as long until it is over, and
    /// no impact is left.
    pub hard: R,
}

/// Tells the pairs of two bodies, the lower id first.
pub type Meet<'a, S> = dyn Fn(&[Body<S>], [BodyId; 2]) -> Vec<ContactPair> + 'a;

/// Bodies, interfaces and pairs; constant during a run and shared between threads.
#[derive(Clone, Debug)]
pub struct Model<S: Space> {
    pub(crate) bodies: Vec<Body<S>>,
    /// Of every body what each step asks for.
    pub(crate) inert: Vec<Inert<S>>,
    pub(crate) interfaces: Vec<Interface<S>>,
    pub(crate) pairs: Pairs,
    pub(crate) elements: Vec<Element<S>>,
    pub(crate) gravity: S::Vector,
    pub(crate) reach: Vec<f64>,
    /// Of every body the first whose boundaries are the same: they are read there, so that a thousand equal
    /// blocks take the memory of one.
    pub(crate) alike: Vec<BodyId>,
    pub(crate) substepping: Substepping<S::Real>,
}

/// Why bodies and pairs do not make a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// Two bodies of one name.
    #[error("two bodies are named \"{name}\": give each its own name")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// A free body without mass.
    #[error("body \"{name}\" has mass {mass} kg: a free body needs a positive, finite mass")]
    Mass {
        /// The body.
        name: String,
        /// Its mass (kg).
        mass: f64,
    },
    /// A free body that nothing could keep from spinning.
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
    /// A free body with a surface that has no end.
    #[error("body \"{name}\" carries an unbounded surface: only bodies fixed to the ground may")]
    Unbounded {
        /// The body.
        name: String,
    },
    /// A force element that is none.
    #[error("element \"{name}\": {problem}")]
    Element {
        /// The element.
        name: String,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// A pair that names something that is not there.
    #[error("contact pair {pair} names {what} {index}, but there are only {count}")]
    Dangling {
        /// Which pair, counted from 0.
        pair: usize,
        /// What it names.
        what: &'static str,
        /// The index it gives.
        index: usize,
        /// How many there are.
        count: usize,
    },
}

impl<S: Space> Model<S> {
    /// Checks bodies, interfaces and pairs, and puts the pairs in their lasting order.
    ///
    /// `gravity` is the acceleration of free fall (m/s²).
    ///
    /// # Errors
    /// When names repeat, a free body has no mass, no inertia or an unbounded surface, or a pair dangles.
    pub fn new(
        bodies: Vec<Body<S>>,
        interfaces: Vec<Interface<S>>,
        pairs: Vec<ContactPair>,
        gravity: S::Vector,
    ) -> Result<Self, ModelError> {
        Self::of_pairs(bodies, interfaces, Pairs::listed(pairs), gravity)
    }

    /// As [`Model::new`], where how two bodies meet is a matter of their kinds, numbered from 0: `meet` tells
    /// the pairs of two bodies, the lower id first, and would tell the same for any others of their kinds.
    ///
    /// Thousands of bodies need no list of all their pairs, whose number is the square of theirs.
    ///
    /// # Errors
    /// As [`Model::new`].
    ///
    /// # Panics
    /// When there is not one kind for each body.
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
            fast: None,
        };
        let elements = Vec::new();
        Ok(Self { bodies, inert, interfaces, pairs, elements, gravity, reach, alike, substepping })
    }

    /// Divides time steps while impacts ask for it; without this no step is divided.
    ///
    /// # Panics
    /// When there are not as many penetrations as interfaces.
    pub fn set_substepping(&mut self, substepping: Substepping<S::Real>) {
        assert_eq!(
            substepping.whole_step_depth.len(),
            self.interfaces.len(),
            "one penetration for every interface"
        );
        self.substepping = substepping;
    }

    /// How closely impacts are followed.
    pub fn substepping(&self) -> &Substepping<S::Real> {
        &self.substepping
    }

    /// Puts force elements between the bodies, in place of those before, in the order in which their
    /// forces are summed. A state of the model must have one entry of `memory` for each.
    ///
    /// # Errors
    /// When an element ties a body to itself or to one that is not there, or a constant is not a number
    /// that it can be.
    pub fn fasten(&mut self, elements: Vec<Element<S>>) -> Result<(), ModelError> {
        for element in &elements {
            if let Some(problem) = element.problem(self.bodies.len()) {
                return Err(ModelError::Element { name: element.link().name.clone(), problem });
            }
        }
        self.elements = elements;
        Ok(())
    }

    /// The bodies, in the order of their ids.
    pub fn bodies(&self) -> &[Body<S>] {
        &self.bodies
    }

    /// The interfaces, in the order of their ids.
    pub fn interfaces(&self) -> &[Interface<S>] {
        &self.interfaces
    }

    /// The contact pairs, in the order in which their forces are summed; in a model of kinds as many as the
    /// square of its bodies.
    pub fn pairs(&self) -> impl Iterator<Item = ContactPair> + '_ {
        self.pairs.numbers().map(|number| self.pairs.get(number))
    }

    /// The contact pair of a number, such as that of a [`Contact`](crate::forces::Contact).
    #[inline(always)]
    pub fn pair(&self, number: usize) -> ContactPair {
        self.pairs.get(number)
    }

    /// Tells how bodies meet: a pair, and the bodies that may stand in the place of its contactor and of its
    /// target, any of them with any other.
    pub fn each_meeting(&self, tell: &mut TellMeeting<'_>) {
        self.pairs.each(tell);
    }

    /// The force elements, in the order of [`Scratch::loads`](crate::Scratch::loads).
    pub fn elements(&self) -> &[Element<S>] {
        &self.elements
    }

    /// Acceleration of free fall (m/s²).
    pub fn gravity(&self) -> S::Vector {
        self.gravity
    }

    /// The body of a name.
    pub fn body_named(&self, name: &str) -> Option<BodyId> {
        self.bodies.iter().position(|b| b.name == name)
    }

    /// Whether viscous damping acts on any body.
    pub(crate) fn is_damped(&self) -> bool {
        self.inert.iter().any(|body| body.damped)
    }

    /// The body whose boundaries are those of a body.
    #[inline(always)]
    pub(crate) fn bounded(&self, body: BodyId) -> &Body<S> {
        &self.bodies[self.alike[body]]
    }

    /// The nodes that a pair tests.
    pub(crate) fn pair_nodes(&self, pair: &ContactPair) -> &Nodes<S> {
        &self.bounded(pair.contactor).nodes[pair.nodes]
    }
}

/// Of every body the first with the same boundaries, which it can only be among those of the same reach.
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
