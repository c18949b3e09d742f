//! From a state to contact forces and accelerations.

use crate::body::{Motion, Nodes};
use crate::contact::{FrictionLaw, NormalLaw, Stick};
use crate::elements::{Elements, Group, PairFrame};
use crate::model::{ContactPair, Model};
use crate::real::{Mask, Real};
use crate::shape::{Gap, Surface};
use crate::space::{Linear, Space, Twist, Wrench};
use crate::state::State;
use crate::strap::{self, Pull};

/// One contact element that touches.
#[derive(Clone, Copy, Debug)]
pub struct Contact<S: Space> {
    /// Which element of [`Elements`].
    pub element: usize,
    /// Which pair of the model.
    pub pair: usize,
    /// Which node of the contactor's node set.
    pub node: u32,
    /// Where it touches; always true in a single run.
    pub touching: <S::Real as Real>::Mask,
    /// The companion point (m), in the frame of the target's surface: both bodies feel the force there.
    pub point: S::Vector,
    /// Unit normal in the same frame, out of the target.
    pub normal: S::Vector,
    /// Penetration (m), never negative.
    pub penetration: S::Real,
    /// Penetration rate (m/s), positive while approaching.
    pub penetration_rate: S::Real,
    /// Compressive force (N), never negative.
    pub normal_force: S::Real,
    /// Tangential velocity of the contactor relative to the target (m/s).
    pub slip_rate: S::Tangent,
    /// Friction force (N) along the slip; the contactor feels its opposite.
    pub friction_force: S::Tangent,
}

/// Energies (J) of all contacts together.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContactTotals<R> {
    /// Energy stored in normal springs (J).
    pub elastic: R,
    /// Energy stored in sticks (J).
    pub stick: R,
}

/// The forces on one body that give nothing back, with their moments about its center of mass.
///
/// The energy ledger multiplies them by the motion of the body.
#[derive(Clone, Copy, Debug)]
pub struct Losses<S: Space> {
    /// Of the dampers of contacts and straps.
    pub damped: Wrench<S>,
    /// Of friction, sticks included.
    pub friction: Wrench<S>,
    /// Of the body's own viscous damping.
    pub viscous: Wrench<S>,
}

impl<S: Space> Default for Losses<S> {
    #[inline(always)]
    fn default() -> Self {
        let none = Wrench::default();
        Self { damped: none, friction: none, viscous: none }
    }
}

/// The sum of the contact forces of one pair.
#[derive(Clone, Copy, Debug)]
pub struct PairForce<S: Space> {
    /// Which pair of the model.
    pub pair: usize,
    /// Force (N) on the contactor, in the inertial frame; the target feels its opposite.
    pub force: S::Vector,
}

/// What can be computed anew from a state; may be dropped at any time.
#[derive(Clone, Debug)]
pub struct Scratch<S: Space> {
    /// The contacts of the last evaluation, in the order of their elements; empty where
    /// [`Scratch::keeps_contacts`] says so.
    pub contacts: Vec<Contact<S>>,
    /// Whether `contacts` are written down. Forces do not need them, only who looks at contacts does.
    pub keeps_contacts: bool,
    /// Their sums over every pair that touches, in the order of the pairs.
    pub pair_forces: Vec<PairForce<S>>,
    /// Their energies.
    pub totals: ContactTotals<S::Real>,
    /// What the straps do, in their order.
    pub pulls: Vec<Pull<S::Real>>,
    /// Forces of contacts and straps on every body, and their moments about its center of mass.
    pub wrenches: Vec<Wrench<S>>,
    /// What of the forces on every body takes energy away.
    pub losses: Vec<Losses<S>>,
    /// Acceleration of every body; zero for prescribed ones.
    pub accelerations: Vec<Twist<S>>,
    /// Rotation of every body.
    pub rotations: Vec<S::Rotation>,
    /// Slip rate of every element (m/s); zero where it does not touch.
    pub slip_rates: Vec<S::Tangent>,
    /// How often the forces have been evaluated.
    pub evaluations: u64,
    /// How many contact elements have been tested in all evaluations.
    pub contact_evaluations: u64,
    /// Accelerations of the state a step started from, for methods that correct.
    pub(crate) old_accelerations: Vec<Twist<S>>,
    /// Slip rates of that state.
    pub(crate) old_slip_rates: Vec<S::Tangent>,
    /// What of the contacts their sticks must know once the step is accepted.
    pressed: Vec<Pressed<S>>,
}

/// An element that touches in at least one lane.
#[derive(Clone, Copy, Debug)]
struct Pressed<S: Space> {
    element: usize,
    pair: usize,
    touching: <S::Real as Real>::Mask,
    /// Compressive force (N).
    normal_force: S::Real,
}

impl<S: Space> Scratch<S> {
    /// Room for the evaluations of a model.
    pub fn new(model: &Model<S>) -> Self {
        let count = model.bodies.len();
        Self {
            contacts: Vec::new(),
            keeps_contacts: true,
            pair_forces: Vec::new(),
            totals: ContactTotals::default(),
            pulls: vec![Pull::default(); model.straps.len()],
            wrenches: vec![Wrench::default(); count],
            losses: vec![Losses::default(); count],
            accelerations: vec![Twist::default(); count],
            rotations: model.bodies.iter().map(|b| S::rotation(b.pose.orientation)).collect(),
            slip_rates: Vec::new(),
            evaluations: 0,
            contact_evaluations: 0,
            old_accelerations: vec![Twist::default(); count],
            old_slip_rates: Vec::new(),
            pressed: Vec::new(),
        }
    }
}

impl<S: Space> Scratch<S> {
    /// How many elements touch in at least one lane.
    pub fn touching(&self) -> usize {
        self.pressed.len()
    }

    /// Follows a new list of elements; `origins` tells for each which one of the old list it was.
    ///
    /// Every contact keeps its element, since what touches is within the margin of any list.
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

/// Fills `scratch` with the forces and accelerations at `state`. Never changes `state`.
pub fn evaluate<S: Space>(model: &Model<S>, state: &State<S>, scratch: &mut Scratch<S>) {
    evaluate_within(model, state, S::Real::zero(), scratch);
}

/// As [`evaluate`], with forces that stand for a whole step (s) of an integrator which takes them as
/// constant for half a step before and after ([`NormalForce::within_step`](crate::contact::NormalForce::within_step)).
pub(crate) fn evaluate_within<S: Space>(
    model: &Model<S>,
    state: &State<S>,
    step: S::Real,
    scratch: &mut Scratch<S>,
) {
    S::Real::scope(
        #[inline(always)]
        || clear(state, scratch),
    );
    for group in &state.elements.groups {
        S::Real::scope(
            #[inline(always)]
            || touch(model, state, step, group, scratch),
        );
    }
    S::Real::scope(
        #[inline(always)]
        || {
            pull(model, state, scratch);
            accelerate(model, state, scratch);
        },
    );
}

/// The straps.
#[inline(always)]
fn pull<S: Space>(model: &Model<S>, state: &State<S>, scratch: &mut Scratch<S>) {
    let Scratch { wrenches, losses, rotations, pulls, .. } = scratch;
    strap::pull_all(
        model,
        state,
        rotations,
        pulls,
        #[inline(always)]
        |body, wrench, damped| {
            wrenches[body] += wrench;
            losses[body].damped += damped;
        },
    );
}

/// Rotations of the state at hand, and nothing else yet.
#[inline(always)]
fn clear<S: Space>(state: &State<S>, scratch: &mut Scratch<S>) {
    for (rotation, pose) in scratch.rotations.iter_mut().zip(&state.poses) {
        *rotation = S::rotation(pose.orientation);
    }
    scratch.wrenches.fill(Wrench::default());
    scratch.losses.fill(Losses::default());
    scratch.totals = ContactTotals::default();
    scratch.contacts.clear();
    scratch.pressed.clear();
    scratch.pair_forces.clear();
    scratch.slip_rates.clear();
    scratch.slip_rates.resize(state.elements.len(), S::Tangent::default());
    scratch.evaluations += 1;
    scratch.contact_evaluations += state.elements.len() as u64;
}

/// The contacts of one pair: gap, normal law, friction law, and the sum of the forces on both bodies.
///
/// The paper's laws have a loop of their own, in which nothing is asked at every contact.
#[inline(always)]
fn touch<S: Space>(
    model: &Model<S>,
    state: &State<S>,
    step: S::Real,
    group: &Group,
    scratch: &mut Scratch<S>,
) {
    let interface = &model.interfaces[model.pairs[group.pair].interface];
    match (interface.normal, interface.friction) {
        (
            NormalLaw::SpeedGap { stiffness, damping },
            FrictionLaw::Coulomb {
                static_coefficient,
                kinetic_coefficient,
                tangential_stiffness,
                tangential_damping,
            },
        ) => {
            let normal = NormalLaw::SpeedGap { stiffness, damping };
            let friction = FrictionLaw::Coulomb {
                static_coefficient,
                kinetic_coefficient,
                tangential_stiffness,
                tangential_damping,
            };
            touch_by(normal, friction, model, state, step, group, scratch);
        }
        (normal, friction) => touch_by(normal, friction, model, state, step, group, scratch),
    }
}

/// The contacts of one pair by its laws.
#[inline(always)]
fn touch_by<S: Space>(
    normal: NormalLaw<S::Real>,
    friction: FrictionLaw<S::Real>,
    model: &Model<S>,
    state: &State<S>,
    step: S::Real,
    group: &Group,
    scratch: &mut Scratch<S>,
) {
    let pair = &model.pairs[group.pair];
    let frame = PairFrame::new(model, pair, &state.poses, &scratch.rotations);
    let surface = &model.bodies[pair.target].surfaces[pair.surface].surface;
    let mut press = Press {
        normal,
        friction,
        step,
        frame: &frame,
        twists: (state.twists[pair.contactor], state.twists[pair.target]),
        meeting: None,
        pair: group.pair,
        elements: &state.elements,
        sum: PairWrench::default(),
        totals: scratch.totals,
        slip_rates: &mut scratch.slip_rates,
        pressed: &mut scratch.pressed,
        contacts: scratch.keeps_contacts.then_some(&mut scratch.contacts),
    };
    match model.pair_nodes(pair) {
        Nodes::Fixed(_) => {
            let nodes = &state.elements.positions[group.first..group.end];
            surface.penetrated_by(
                nodes.len(),
                #[inline(always)]
                |index| frame.to_surface(nodes[index]),
                #[inline(always)]
                |index, node, gap| press.node(group.first + index, node, gap),
            );
        }
        Nodes::Rolling { center, radius, .. } => {
            let center = frame.to_surface(*center);
            let mut gap = surface.gap(center);
            gap.distance -= *radius;
            if gap.distance.lt(S::Real::zero()).any() {
                press.node(group.first, center - gap.normal * *radius, gap);
            }
        }
    }
    let Press { meeting, sum, totals, .. } = press;
    let Some(meeting) = meeting else { return };
    scratch.totals = totals;
    let damped = meeting.on_bodies(sum.damped);
    let friction = meeting.on_bodies(sum.friction);
    let (on_contactor, on_target) = meeting.on_bodies(sum.normal.plus(sum.friction));
    scratch.wrenches[pair.contactor] += on_contactor;
    scratch.wrenches[pair.target] += on_target;
    let losses = &mut scratch.losses;
    losses[pair.contactor].damped += damped.0;
    losses[pair.target].damped += damped.1;
    losses[pair.contactor].friction += friction.0;
    losses[pair.target].friction += friction.1;
    scratch.pair_forces.push(PairForce { pair: group.pair, force: on_contactor.force });
}

/// Nodes of a pair that press into a surface, one after the other.
struct Press<'a, S: Space> {
    normal: NormalLaw<S::Real>,
    friction: FrictionLaw<S::Real>,
    /// The step (s) that the forces stand for.
    step: S::Real,
    frame: &'a PairFrame<S>,
    /// Twists of contactor and target.
    twists: (Twist<S>, Twist<S>),
    /// How the bodies meet; asked for by the first node that presses.
    meeting: Option<Meeting<'a, S>>,
    pair: usize,
    elements: &'a Elements<S>,
    sum: PairWrench<S>,
    totals: ContactTotals<S::Real>,
    slip_rates: &'a mut [S::Tangent],
    pressed: &'a mut Vec<Pressed<S>>,
    contacts: Option<&'a mut Vec<Contact<S>>>,
}

impl<S: Space> Press<'_, S> {
    /// The forces of a node at `node` (m), which penetrates in at least one lane; in the frame of the
    /// target's surface.
    #[inline(always)]
    fn node(&mut self, element: usize, node: S::Vector, gap: Gap<S>) {
        if self.meeting.is_none() {
            self.meeting = Some(Meeting::new(self.frame, self.twists.0, self.twists.1));
        }
        let Some(meeting) = &self.meeting else { return };
        let contact = meeting.contact(self.pair, self.elements, element, node, gap);
        let touching = contact.touching;
        let weight = S::Real::select(touching, self.elements.weights[element], S::Real::zero());
        let (depth, rate) = (contact.penetration, contact.penetration_rate);
        let normal = self.normal.force(depth, rate).within_step(depth, rate, self.step);
        let normal_force = normal.total * weight;
        let stick = self.elements.sticks[element];
        let friction = self.friction.force::<S>(stick, contact.slip_rate, normal_force, weight);
        self.totals.elastic += normal.energy * weight;
        self.totals.stick += friction.energy;

        let damped = normal_force - normal.elastic * weight;
        let arm = contact.point - self.frame.contactor;
        let lever = S::moment(arm, contact.normal);
        let sum = &mut self.sum;
        sum.normal += Wrench { force: contact.normal * normal_force, moment: lever * normal_force };
        sum.damped += Wrench { force: contact.normal * damped, moment: lever * damped };
        let sliding = -S::along(friction.force, contact.normal);
        sum.friction += Wrench { force: sliding, moment: S::moment(arm, sliding) };

        self.slip_rates[element] = contact.slip_rate;
        self.pressed.push(Pressed { element, pair: self.pair, touching, normal_force });
        if let Some(contacts) = &mut self.contacts {
            contacts.push(Contact { normal_force, friction_force: friction.force, ..contact });
        }
    }
}

/// Sums of contact forces on the contactor of a pair, in the frame of the target's surface, with their
/// moments about the contactor's center of mass.
#[derive(Clone, Copy, Default)]
struct PairWrench<S: Space> {
    normal: Wrench<S>,
    /// The part of the normal forces that dampers make.
    damped: Wrench<S>,
    friction: Wrench<S>,
}

/// Two bodies at their contact, seen from the target's surface.
struct Meeting<'a, S: Space> {
    frame: &'a PairFrame<S>,
    /// Center of mass of the contactor from that of the target (m).
    apart: S::Vector,
    /// Velocity (m/s), at the contactor's center of mass, of the contactor relative to the target.
    linear: S::Vector,
    /// Spin (rad/s) of the contactor relative to the target.
    spin: S::Spin,
}

impl<'a, S: Space> Meeting<'a, S> {
    #[inline(always)]
    fn new(frame: &'a PairFrame<S>, contactor: Twist<S>, target: Twist<S>) -> Self {
        let apart = frame.contactor - frame.target;
        let target_spin = S::unrotate_spin(frame.rotation, target.angular);
        Self {
            frame,
            apart,
            linear: S::unrotate(frame.rotation, contactor.linear - target.linear)
                - S::velocity_at(target_spin, apart),
            spin: S::unrotate_spin(frame.rotation, contactor.angular) - target_spin,
        }
    }

    /// Where and how fast a node at `node` (m, in the surface's frame) touches; no forces yet.
    ///
    /// Both bodies feel the force at the companion point, and both velocities are taken there:
    /// so the pair conserves momentum, and force times relative velocity is the power it loses.
    #[inline(always)]
    fn contact(
        &self,
        pair: usize,
        elements: &Elements<S>,
        element: usize,
        node: S::Vector,
        gap: Gap<S>,
    ) -> Contact<S> {
        let zero = S::Real::zero();
        let touching = gap.distance.lt(zero);
        let point = node - gap.normal * gap.distance;
        let velocity = self.linear + S::velocity_at(self.spin, point - self.frame.contactor);
        let counted = S::Real::select(touching, S::Real::splat(1.0), zero);
        Contact {
            element,
            pair,
            node: elements.nodes[element],
            touching,
            point,
            normal: gap.normal,
            penetration: S::Real::select(touching, -gap.distance, zero),
            penetration_rate: -velocity.dot(gap.normal),
            normal_force: zero,
            slip_rate: S::tangential(velocity, gap.normal) * counted,
            friction_force: S::Tangent::default(),
        }
    }

    /// What a wrench of [`PairWrench`] does to contactor and target, in the inertial frame.
    #[inline(always)]
    fn on_bodies(&self, wrench: Wrench<S>) -> (Wrench<S>, Wrench<S>) {
        let rotation = self.frame.rotation;
        let force = S::rotate(rotation, wrench.force);
        let about_target = wrench.moment + S::moment(self.apart, wrench.force);
        (
            Wrench { force, moment: S::rotate_spin(rotation, wrench.moment) },
            Wrench { force: -force, moment: -S::rotate_spin(rotation, about_target) },
        )
    }
}

/// Newton's law for every free body: contact, gravity and viscous damping (eq. 2.8).
#[inline(always)]
fn accelerate<S: Space>(model: &Model<S>, state: &State<S>, scratch: &mut Scratch<S>) {
    for (i, body) in model.bodies.iter().enumerate() {
        if body.motion == Motion::Prescribed {
            scratch.accelerations[i] = Twist::default();
            continue;
        }
        let mut wrench = scratch.wrenches[i];
        if let Some(damping) = body.damping {
            let (force, moment) = S::damp(damping, state.twists[i].linear, state.twists[i].angular);
            let viscous = Wrench { force, moment };
            scratch.losses[i].viscous = viscous;
            wrench += viscous;
        }
        let inverse_mass = S::Real::splat(1.0) / body.mass;
        scratch.accelerations[i] = Twist {
            linear: model.gravity + wrench.force * inverse_mass,
            angular: S::spin_rate(
                body.inertia,
                scratch.rotations[i],
                state.twists[i].angular,
                wrench.moment,
            ),
        };
    }
}

/// Accepts the state that `scratch` was evaluated at: the memory of every stick is cut back to what
/// friction can hold, elements that do not touch forget, and straps that cannot hold tear.
pub(crate) fn commit<S: Space>(model: &Model<S>, state: &mut State<S>, scratch: &Scratch<S>) {
    S::Real::scope(
        #[inline(always)]
        || {
            commit_all(model, &mut state.elements, scratch);
            strap::tear(model, &mut state.torn, &scratch.pulls);
        },
    );
}

#[inline(always)]
fn commit_all<S: Space>(model: &Model<S>, elements: &mut Elements<S>, scratch: &Scratch<S>) {
    let Elements { sticks, weights, .. } = elements;
    let mut next = 0;
    for pressed in scratch.pressed.chunk_by(|a, b| a.pair == b.pair) {
        let interface = &model.interfaces[model.pairs[pressed[0].pair].interface];
        // Asked once for a pair, not at every contact.
        match interface.friction {
            FrictionLaw::Coulomb {
                static_coefficient,
                kinetic_coefficient,
                tangential_stiffness,
                tangential_damping,
            } => {
                let law = FrictionLaw::Coulomb {
                    static_coefficient,
                    kinetic_coefficient,
                    tangential_stiffness,
                    tangential_damping,
                };
                commit_pair(law, pressed, &scratch.slip_rates, sticks, weights, &mut next);
            }
            law @ (FrictionLaw::Frictionless | FrictionLaw::Regularized { .. }) => {
                commit_pair(law, pressed, &scratch.slip_rates, sticks, weights, &mut next);
            }
        }
    }
    sticks[next..].fill(Stick::default());
}

/// Commits the sticks of a pair; those between its contacts, and those before them that no pair has
/// reached yet, forget.
#[inline(always)]
fn commit_pair<S: Space>(
    law: FrictionLaw<S::Real>,
    pressed: &[Pressed<S>],
    slip_rates: &[S::Tangent],
    sticks: &mut [Stick<S>],
    weights: &[S::Real],
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
        *stick = stick.commit(&law, slip_rates[element], contact.normal_force, weights[element]);
        let counted = S::Real::select(contact.touching, S::Real::splat(1.0), S::Real::zero());
        stick.displacement = stick.displacement * counted;
        stick.slipping = stick.slipping & contact.touching;
    }
}

/// The length of boundary (m) that a node of a pair stands for.
pub fn tributary_length<S: Space>(model: &Model<S>, pair: &ContactPair, node: usize) -> S::Real {
    match model.pair_nodes(pair) {
        Nodes::Fixed(nodes) => nodes[node].tributary_length,
        Nodes::Rolling { tributary_length, .. } => *tributary_length,
    }
}

/// The force (N) of a contact on its contactor and the point (m) where it acts, in the inertial frame.
pub fn contact_force<S: Space>(
    model: &Model<S>,
    state: &State<S>,
    scratch: &Scratch<S>,
    contact: &Contact<S>,
) -> (S::Vector, S::Vector) {
    let pair = &model.pairs[contact.pair];
    let placed = &model.bodies[pair.target].surfaces[pair.surface];
    let target = scratch.rotations[pair.target];
    let rotation = S::compose(target, placed.rotation);
    let origin = state.poses[pair.target].position + S::rotate(target, placed.offset);
    let force =
        contact.normal * contact.normal_force - S::along(contact.friction_force, contact.normal);
    (S::rotate(rotation, force), origin + S::rotate(rotation, contact.point))
}
