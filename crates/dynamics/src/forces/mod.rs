//! Contact forces and accelerations of a state.

mod press;

use crate::body::{BodyId, Motion, Nodes};
use crate::contact::{FrictionLaw, Stick};
use crate::contact_elements::ContactElements;
use crate::element::{self, Load};
use crate::model::{ContactPair, Model};
use crate::real::{Mask, Real};
use crate::shape::Whole;
use crate::space::{Space, Twist, Wrench};
use crate::state::State;

use press::{PairKinematics, touch};

/// A contact element that is in contact.
#[derive(Clone, Copy, Debug)]
pub struct Contact<S: Space> {
    /// Index of the element in [`ContactElements`].
    pub element: usize,
    /// Index of the pair in the model.
    pub pair: usize,
    /// Index of the node in the contactor's node set.
    pub node: u32,
    /// The lanes in which the element is in contact; always `true` in a single run.
    pub touching: <S::Real as Real>::Mask,
    /// Point (m) at which the force acts on both bodies, in the frame of the target's surface. For a fixed node, this
    /// is the companion point, the point of the surface from which the penetration is measured; otherwise, it is the
    /// middle of the overlap.
    pub point: S::Vector,
    /// Unit normal that points out of the target, in the same frame.
    pub normal: S::Vector,
    /// Penetration (m), never negative.
    pub penetration: S::Real,
    /// Penetration rate (m/s), positive while the bodies approach each other.
    pub penetration_rate: S::Real,
    /// Compressive force (N), never negative.
    pub normal_force: S::Real,
    /// Tangential velocity of the contactor relative to the target (m/s).
    pub slip_rate: S::Tangent,
    /// Friction force (N) in the direction of the slip; the opposite force acts on the contactor.
    pub friction_force: S::Tangent,
}

/// Total energies (J) of all contacts.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContactTotals<R> {
    /// Energy stored in normal springs (J).
    pub elastic: R,
    /// Energy (J) stored in the tangential springs of sticking contacts.
    pub stick: R,
}

/// Dissipative forces on one body, with their moments about its center of mass.
///
/// The energy ledger multiplies these forces by the displacement of the body.
#[derive(Clone, Copy, Debug)]
pub struct Losses<S: Space> {
    /// Total force of the dampers of contacts and force elements.
    pub damped: Wrench<S>,
    /// Total friction, including the tangential damping of sticking contacts.
    pub friction: Wrench<S>,
}

impl<S: Space> Default for Losses<S> {
    #[inline(always)]
    fn default() -> Self {
        let none = Wrench::default();
        Self { damped: none, friction: none }
    }
}

/// Total contact force of one pair.
///
/// A contact near the end of a side may be divided between a corner of each body. As the bodies slide along each other,
/// the shares of the corners change, and with them the stored energy. The total includes the force along the side that
/// corresponds to this change of energy, so it may differ from the sum of the contact forces.
#[derive(Clone, Copy, Debug)]
pub struct PairForce<S: Space> {
    /// Index of the pair in the model.
    pub pair: usize,
    /// Contactor of the pair.
    pub contactor: BodyId,
    /// Target of the pair.
    pub target: BodyId,
    /// Force (N) on the contactor, in the inertial frame; the opposite force acts on the target.
    pub force: S::Vector,
}

/// Working memory: data that can be recomputed from a state, and may be dropped at any time.
#[derive(Clone, Debug)]
pub struct Scratch<S: Space> {
    /// Contacts of the last evaluation, in the order of their elements; empty unless [`Scratch::keeps_contacts`]. The
    /// contacts do not include the additional force along a side; see [`PairForce`].
    pub contacts: Vec<Contact<S>>,
    /// `true` to store `contacts`. Observers of contacts need them; the computation of forces does not.
    pub keeps_contacts: bool,
    /// Total contact force of every touching pair, in the order of the pairs.
    pub pair_forces: Vec<PairForce<S>>,
    /// Total energies of the contacts.
    pub totals: ContactTotals<S::Real>,
    /// Loads of the force elements, in the order of the elements.
    pub loads: Vec<Load<S::Real>>,
    /// For every external force, in the order of [`State::applied`]: the force, and its moment about the center of mass
    /// of the body.
    pub applied: Vec<Wrench<S>>,
    /// Total force on every body, and its moment about the center of mass: the sum of contact forces, element forces
    /// and external forces.
    pub wrenches: Vec<Wrench<S>>,
    /// Dissipative forces on every body.
    pub losses: Vec<Losses<S>>,
    /// Viscous damping force on every body; empty if no body has viscous damping.
    pub viscous: Vec<Wrench<S>>,
    /// Acceleration of every body due to forces and moments; zero for prescribed bodies.
    pub accelerations: Vec<Twist<S>>,
    /// Rotation of every body.
    pub rotations: Vec<S::Rotation>,
    /// Rate of change (m/s) of the displacement of every tangential spring: the slip rate, plus the rate at which the
    /// rotation of the bodies turns the displacement; zero without contact.
    pub slip_rates: Vec<S::Tangent>,
    /// Number of force evaluations so far.
    pub evaluations: u64,
    /// Number of contact elements tested, summed over the force evaluations so far.
    pub contact_evaluations: u64,
    /// Lanes that need substepping: at the current speeds, the penetration of some contact is predicted to exceed
    /// [`Substepping::whole_step_depth`](crate::model::Substepping::whole_step_depth) within [`Scratch::lookahead`].
    pub(crate) needs_substeps: <S::Real as Real>::Mask,
    /// Lanes in which a predicted impact is [hard](crate::model::Fast::hard).
    pub(crate) is_hard: <S::Real as Real>::Mask,
    /// Time (s) over which impacts are predicted; zero in lanes whose steps are never divided.
    pub(crate) lookahead: S::Real,
    /// Relative kinematics of the last pair; reused if the next pair has the same bodies and the same surface.
    kinematics: Option<PairKinematics<S>>,
    /// Accelerations at the start of the step, for methods that correct their predictions.
    pub(crate) old_accelerations: Vec<Twist<S>>,
    /// Slip rates at the start of the step.
    pub(crate) old_slip_rates: Vec<S::Tangent>,
    /// All touching elements, in order, with their normal forces and the data from which their contact history is
    /// updated when the step is accepted.
    pub pressed: Vec<Pressed<S>>,
    /// Groups of contact elements that are tested in the current evaluation.
    awake: Vec<usize>,
}

/// A contact element that is in contact in at least one lane.
#[derive(Clone, Copy, Debug)]
pub struct Pressed<S: Space> {
    pub(crate) element: usize,
    /// Index of the pair in the model.
    pub pair: usize,
    /// Index of the node in the contactor's node set.
    pub node: u32,
    /// The lanes in which the element is in contact.
    pub touching: <S::Real as Real>::Mask,
    /// Point (m) at which the force acts, in the frame of the target's surface.
    pub point: S::Vector,
    /// Tangent plane of the contact, which is stored in the contact history together with the displacement of the
    /// tangential spring.
    tangent_plane: S::TangentPlane,
    /// Compressive force (N); zero in lanes without contact.
    pub normal_force: S::Real,
    /// Factor by which the constants of the contact laws are multiplied.
    pub weight: S::Real,
}

impl<S: Space> Pressed<S> {
    /// Replaces the values in some lanes by those of another entry of the same element.
    #[inline(always)]
    fn merge(&mut self, lanes: <S::Real as Real>::Mask, other: &Self) {
        self.touching = (self.touching & !lanes) | (other.touching & lanes);
        self.point = S::choose_vector(lanes, other.point, self.point);
        self.tangent_plane = S::choose_plane(lanes, other.tangent_plane, self.tangent_plane);
        self.normal_force = S::Real::select(lanes, other.normal_force, self.normal_force);
        self.weight = S::Real::select(lanes, other.weight, self.weight);
    }
}

impl<S: Space> Scratch<S> {
    /// Allocates the working memory for a model.
    pub fn new(model: &Model<S>) -> Self {
        let count = model.bodies.len();
        Self {
            contacts: Vec::new(),
            keeps_contacts: true,
            pair_forces: Vec::new(),
            totals: ContactTotals::default(),
            loads: vec![Load::default(); model.elements.len()],
            applied: Vec::new(),
            wrenches: vec![Wrench::default(); count],
            losses: vec![Losses::default(); count],
            viscous: vec![Wrench::default(); if model.is_damped() { count } else { 0 }],
            accelerations: vec![Twist::default(); count],
            rotations: model.bodies.iter().map(|b| S::rotation(b.pose.orientation)).collect(),
            slip_rates: Vec::new(),
            evaluations: 0,
            contact_evaluations: 0,
            needs_substeps: <S::Real as Real>::Mask::default(),
            is_hard: <S::Real as Real>::Mask::default(),
            lookahead: S::Real::zero(),
            kinematics: None,
            old_accelerations: vec![Twist::default(); count],
            old_slip_rates: Vec::new(),
            pressed: Vec::new(),
            awake: Vec::new(),
        }
    }
}

impl<S: Space> Scratch<S> {
    /// Returns the number of contact elements that are in contact in at least one lane.
    pub fn touching(&self) -> usize {
        self.pressed.len()
    }

    /// Returns the force of every pair that touches in one lane, with the touching elements of the pair. The pairs are
    /// the same as in a single run of the case in this lane.
    pub fn touching_pairs(
        &self,
        lane: usize,
    ) -> impl Iterator<Item = (&PairForce<S>, &[Pressed<S>])> {
        // Both lists are in the order of the groups of elements.
        let mut pressed = self.pressed.chunk_by(|a, b| a.pair == b.pair);
        let own = self.pair_forces.iter().filter_map(move |pair| Some((pair, pressed.next()?)));
        own.filter(move |(_, pressed)| pressed.iter().any(|one| one.touching.lane(lane)))
    }

    /// Renumbers the elements for a new list; `origins` contains, for every element of the new list, its index in the
    /// old list, or `None` if the old list does not contain the element.
    ///
    /// No contact is lost, since every list contains all touching elements.
    pub(crate) fn renumber(&mut self, origins: &[Option<usize>]) {
        let mut numbers = vec![None; self.slip_rates.len()];
        let mut slip_rates = vec![S::Tangent::default(); origins.len()];
        for (new, origin) in origins.iter().enumerate() {
            if let Some(old) = *origin {
                slip_rates[new] = self.slip_rates[old];
                numbers[old] = Some(new);
            }
        }
        self.slip_rates = slip_rates;
        let follow =
            |element: &mut usize| numbers[*element].map(|number| *element = number).is_some();
        self.contacts.retain_mut(|contact| follow(&mut contact.element));
    }
}

/// Computes the forces and accelerations at `state` into `scratch`. Never changes `state`.
pub fn evaluate<S: Space>(model: &Model<S>, state: &State<S>, scratch: &mut Scratch<S>) {
    evaluate_within(model, state, S::Real::zero(), scratch);
}

/// Evaluates as [`evaluate`] does, but with normal forces that are effective over a whole time step of length `step`
/// (s); see [`NormalForce::within_step`](crate::contact::NormalForce::within_step). The integrator must treat a force
/// as constant from half a step before its evaluation to half a step after it.
pub(crate) fn evaluate_within<S: Space>(
    model: &Model<S>,
    state: &State<S>,
    step: S::Real,
    scratch: &mut Scratch<S>,
) {
    S::Real::scope(
        #[inline(always)]
        || {
            clear(state, scratch);
            wake(model, &state.contact_elements, &mut scratch.awake);
        },
    );
    for at in 0..scratch.awake.len() {
        let group = scratch.awake[at];
        S::Real::scope(
            #[inline(always)]
            || touch(model, state, step, group, scratch),
        );
    }
    S::Real::scope(
        #[inline(always)]
        || {
            act(model, state, scratch);
            accelerate(model, state, scratch);
        },
    );
}

/// Sets every element of a slice to the default of its type. This function is always inlined, so its loop, unlike
/// that of `fill`, is compiled for the vector unit.
#[inline(always)]
fn wipe<T: Default>(all: &mut [T]) {
    for one in all {
        *one = T::default();
    }
}

/// Collects the groups of elements that may touch in the current step, or whose impacts are to be predicted.
///
/// Most groups need no test, so the groups are filtered before any force is computed.
#[inline(always)]
fn wake<S: Space>(model: &Model<S>, elements: &ContactElements<S>, awake: &mut Vec<usize>) {
    awake.clear();
    for group in 0..elements.groups.len() {
        if !asleep(model, elements, group).all() {
            awake.push(group);
        }
    }
}

/// Returns the lanes in which a group of elements cannot touch in the current step and needs no prediction of impacts.
#[inline(always)]
fn asleep<S: Space>(
    model: &Model<S>,
    elements: &ContactElements<S>,
    group: usize,
) -> <S::Real as Real>::Mask {
    let impacts = model.substepping.whole_step_depth[elements.groups[group].interface];
    let foreseen = impacts.lt(S::Real::splat(f64::INFINITY)).any();
    elements.asleep(group, if foreseen { model.substepping.foreseen_gap } else { S::Real::zero() })
}

/// Adds the forces of the force elements, and the external forces.
#[inline(always)]
fn act<S: Space>(model: &Model<S>, state: &State<S>, scratch: &mut Scratch<S>) {
    let Scratch { wrenches, losses, rotations, loads, applied, .. } = scratch;
    loads.clear();
    for (element, memory) in model.elements.iter().zip(&state.memory) {
        let action = element.act(state, rotations, *memory);
        for (body, (whole, damped)) in element.link().bodies.into_iter().zip(action.wrenches) {
            wrenches[body] += whole;
            losses[body].damped += damped;
        }
        loads.push(action.load);
    }
    applied.clear();
    for push in &state.applied {
        let wrench = push.wrench(rotations);
        wrenches[push.body] += wrench;
        applied.push(wrench);
    }
}

/// Resets `scratch`, and computes the rotation of every body from its orientation.
#[inline(always)]
fn clear<S: Space>(state: &State<S>, scratch: &mut Scratch<S>) {
    for (rotation, pose) in scratch.rotations.iter_mut().zip(&state.poses) {
        *rotation = S::rotation(pose.orientation);
    }
    wipe(&mut scratch.wrenches);
    wipe(&mut scratch.losses);
    scratch.totals = ContactTotals::default();
    scratch.needs_substeps = <S::Real as Real>::Mask::default();
    scratch.is_hard = <S::Real as Real>::Mask::default();
    scratch.contacts.clear();
    scratch.pressed.clear();
    scratch.pair_forces.clear();
    scratch.kinematics = None;
    wipe(&mut scratch.slip_rates);
    scratch.slip_rates.resize(state.contact_elements.len(), S::Tangent::default());
    scratch.evaluations += 1;
}

/// Computes the acceleration of every free body from contact forces, element forces, gravity and viscous damping
/// (Candia et al. 2008, eq. 2.8).
#[inline(always)]
fn accelerate<S: Space>(model: &Model<S>, state: &State<S>, scratch: &mut Scratch<S>) {
    for (i, body) in model.inert.iter().enumerate() {
        if body.motion == Motion::Prescribed {
            scratch.accelerations[i] = Twist::default();
            continue;
        }
        let mut wrench = scratch.wrenches[i];
        if body.damped
            && let Some(damping) = model.bodies[i].damping
        {
            let (force, moment) = S::damp(damping, state.twists[i].linear, state.twists[i].angular);
            let viscous = Wrench { force, moment };
            scratch.viscous[i] = viscous;
            wrench += viscous;
        }
        let inverse_mass = S::Real::splat(1.0) / body.mass;
        scratch.accelerations[i] = Twist {
            linear: model.gravity + wrench.force * inverse_mass,
            angular: S::spin_rate(body.inertia, scratch.rotations[i], wrench.moment),
        };
    }
}

/// Accepts the state at which `scratch` was evaluated: limits the displacement of every tangential spring to the
/// friction capacity, resets elements without contact, and breaks force elements that fail.
pub(crate) fn commit<S: Space>(model: &Model<S>, state: &mut State<S>, scratch: &Scratch<S>) {
    commit_corrected(
        model,
        state,
        scratch,
        #[inline(always)]
        |_, displacement| displacement,
    );
}

/// Accepts the state as [`commit`] does, with corrected displacements of the tangential springs: `corrected` maps the
/// index of an element and the displacement (m) of its spring to the displacement (m) that is accepted.
pub(crate) fn commit_corrected<S: Space>(
    model: &Model<S>,
    state: &mut State<S>,
    scratch: &Scratch<S>,
    corrected: impl Fn(usize, S::Tangent) -> S::Tangent,
) {
    S::Real::scope(
        #[inline(always)]
        || {
            commit_all(model, &mut state.contact_elements, scratch, &corrected);
            element::commit(&mut state.memory, &scratch.loads);
        },
    );
}

#[inline(always)]
fn commit_all<S: Space>(
    model: &Model<S>,
    elements: &mut ContactElements<S>,
    scratch: &Scratch<S>,
    corrected: &impl Fn(usize, S::Tangent) -> S::Tangent,
) {
    let ContactElements { sticks, .. } = elements;
    let mut next = 0;
    for pressed in scratch.pressed.chunk_by(|a, b| a.pair == b.pair) {
        let interface = &model.interfaces[model.pair(pressed[0].pair).interface];
        // Dispatch on the friction law once per pair, not per contact.
        match interface.friction {
            FrictionLaw::Coulomb {
                static_coefficient,
                kinetic_coefficient,
                tangential_stiffness,
                tangential_damping,
            } => {
                commit_pair(
                    #[inline(always)]
                    || FrictionLaw::Coulomb {
                        static_coefficient,
                        kinetic_coefficient,
                        tangential_stiffness,
                        tangential_damping,
                    },
                    corrected,
                    pressed,
                    &scratch.slip_rates,
                    sticks,
                    &mut next,
                );
            }
            law @ (FrictionLaw::Frictionless | FrictionLaw::Regularized { .. }) => commit_pair(
                #[inline(always)]
                || law,
                corrected,
                pressed,
                &scratch.slip_rates,
                sticks,
                &mut next,
            ),
        }
    }
    sticks[next..].fill(Stick::default());
}

/// Commits the contact history of the touching elements of a pair. `next` is the index of the first element whose
/// contact history is neither committed nor reset yet. From there to the last touching element, the contact history of
/// the elements that do not touch is reset.
#[inline(always)]
fn commit_pair<S: Space>(
    law: impl Fn() -> FrictionLaw<S::Real>,
    corrected: &impl Fn(usize, S::Tangent) -> S::Tangent,
    pressed: &[Pressed<S>],
    slip_rates: &[S::Tangent],
    sticks: &mut [Stick<S>],
    next: &mut usize,
) {
    for contact in pressed {
        let element = contact.element;
        while *next < element {
            sticks[*next] = Stick::default();
            *next += 1;
        }
        *next = element + 1;

        let stick = &mut sticks[element];
        stick.displacement = corrected(element, stick.displacement);
        let carried = stick.carried(contact.tangent_plane);
        *stick = carried.commit(&law(), slip_rates[element], contact.normal_force, contact.weight);
        let counted = S::Real::select(contact.touching, S::Real::splat(1.0), S::Real::zero());
        stick.displacement = stick.displacement * counted;
        stick.slipping = stick.slipping & contact.touching;
    }
}

/// Returns the tributary length (m) of a node of a pair.
pub fn tributary_length<S: Space>(model: &Model<S>, pair: &ContactPair, node: usize) -> S::Real {
    match model.pair_nodes(pair) {
        Nodes::Fixed(nodes) => nodes[node].tributary_length,
        Nodes::Rounds(rounds) => rounds[node].tributary_length,
        Nodes::Rolling { tributary_length, .. } => *tributary_length,
        Nodes::Whole(whole) => whole.tributary_length(),
    }
}

/// Returns, for a contact, the rotation from the frame of the target's surface to the inertial frame.
#[inline(always)]
pub(crate) fn frame_of<S: Space>(
    model: &Model<S>,
    scratch: &Scratch<S>,
    contact: &Contact<S>,
) -> S::Rotation {
    let pair = model.pair(contact.pair);
    let placed = &model.bounded(pair.target).surfaces[pair.surface];
    S::compose(scratch.rotations[pair.target], placed.rotation)
}

/// Returns the force (N) of a contact on its contactor and the point (m) at which the force acts, in the inertial
/// frame.
pub fn contact_force<S: Space>(
    model: &Model<S>,
    state: &State<S>,
    scratch: &Scratch<S>,
    contact: &Contact<S>,
) -> (S::Vector, S::Vector) {
    let rotation = frame_of(model, scratch, contact);
    let force =
        contact.normal * contact.normal_force - S::along(contact.friction_force, contact.normal);
    (S::rotate(rotation, force), placed_point(model, state, scratch, contact.pair, contact.point))
}

/// Transforms a point (m) from the frame of the target's surface of a pair to the inertial frame.
fn placed_point<S: Space>(
    model: &Model<S>,
    state: &State<S>,
    scratch: &Scratch<S>,
    pair: usize,
    point: S::Vector,
) -> S::Vector {
    let pair = model.pair(pair);
    let placed = &model.bounded(pair.target).surfaces[pair.surface];
    let target = scratch.rotations[pair.target];
    let rotation = S::compose(target, placed.rotation);
    state.poses[pair.target].position
        + S::rotate(target, placed.offset)
        + S::rotate(rotation, point)
}

/// Returns every pair that touches, with its center of pressure (m) in the inertial frame: the mean of its contact
/// points, weighted by their normal forces.
pub fn centers_of_pressure<S: Space<Real = f64>>(
    model: &Model<S>,
    state: &State<S>,
    scratch: &Scratch<S>,
) -> Vec<(PairForce<S>, S::Vector)> {
    let center = |elements: &[Pressed<S>]| {
        let pair = elements[0].pair;
        let force = scratch.pair_forces.iter().find(|force| force.pair == pair)?;
        let mut weight = 0.0;
        let mut center = S::Vector::default();
        for element in elements {
            weight += element.normal_force;
            if weight > 0.0 {
                center = center + (element.point - center) * (element.normal_force / weight);
            }
        }
        Some((*force, placed_point(model, state, scratch, pair, center)))
    };
    scratch.pressed.chunk_by(|a, b| a.pair == b.pair).filter_map(center).collect()
}
