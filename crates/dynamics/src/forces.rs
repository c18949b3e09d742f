//! From a state to contact forces and accelerations.

use crate::body::{Motion, Nodes};
use crate::contact::{Interface, Stick};
use crate::elements::{Group, PairFrame};
use crate::model::{ContactPair, Model};
use crate::real::{Mask, Real};
use crate::shape::{Gap, Surface};
use crate::space::{Linear, Space, Twist, Wrench};
use crate::state::State;

/// One contact element that touches.
#[derive(Clone, Copy, Debug)]
pub struct Contact<S: Space> {
    /// Which element of [`Elements`](crate::elements::Elements).
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

/// Energies (J) and powers (W) of all contacts together.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContactTotals<R> {
    /// Energy stored in normal springs (J).
    pub elastic: R,
    /// Energy stored in sticks (J).
    pub stick: R,
    /// Power lost in contact dampers (W).
    pub damped: R,
    /// Power that bodies lose to friction, sticks included (W).
    pub friction: R,
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
    /// The contacts of the last evaluation, in the order of their elements.
    pub contacts: Vec<Contact<S>>,
    /// Their sums over every pair that touches, in the order of the pairs.
    pub pair_forces: Vec<PairForce<S>>,
    /// Their energies and powers.
    pub totals: ContactTotals<S::Real>,
    /// Contact forces on every body and their moments about its center of mass.
    pub wrenches: Vec<Wrench<S>>,
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
    /// Sticks of the next accepted state, while it is made.
    committed: Vec<Stick<S>>,
}

impl<S: Space> Scratch<S> {
    /// Room for the evaluations of a model.
    pub fn new(model: &Model<S>) -> Self {
        let count = model.bodies.len();
        Self {
            contacts: Vec::new(),
            pair_forces: Vec::new(),
            totals: ContactTotals::default(),
            wrenches: vec![Wrench::default(); count],
            accelerations: vec![Twist::default(); count],
            rotations: model.bodies.iter().map(|b| S::rotation(b.pose.orientation)).collect(),
            slip_rates: Vec::new(),
            evaluations: 0,
            contact_evaluations: 0,
            old_accelerations: vec![Twist::default(); count],
            old_slip_rates: Vec::new(),
            committed: Vec::new(),
        }
    }
}

impl<S: Space> Scratch<S> {
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
        self.contacts.retain_mut(|contact| {
            numbers[contact.element].map(|number| contact.element = number).is_some()
        });
    }
}

/// Fills `scratch` with the forces and accelerations at `state`. Never changes `state`.
pub fn evaluate<S: Space>(model: &Model<S>, state: &State<S>, scratch: &mut Scratch<S>) {
    for (rotation, pose) in scratch.rotations.iter_mut().zip(&state.poses) {
        *rotation = S::rotation(pose.orientation);
    }
    scratch.wrenches.fill(Wrench::default());
    scratch.totals = ContactTotals::default();
    scratch.contacts.clear();
    scratch.pair_forces.clear();
    scratch.slip_rates.clear();
    scratch.slip_rates.resize(state.elements.len(), S::Tangent::default());
    scratch.evaluations += 1;
    scratch.contact_evaluations += state.elements.len() as u64;

    for group in &state.elements.groups {
        touch(model, state, group, scratch);
    }
    accelerate(model, state, scratch);
}

/// The contacts of one pair: gap, normal law, friction law, and the sum of the forces on both bodies.
fn touch<S: Space>(model: &Model<S>, state: &State<S>, group: &Group, scratch: &mut Scratch<S>) {
    let pair = &model.pairs[group.pair];
    let frame = PairFrame::new(model, pair, &state.poses, &scratch.rotations);
    let surface = &model.bodies[pair.target].surfaces[pair.surface].surface;
    let (contactor, target) = (state.twists[pair.contactor], state.twists[pair.target]);
    let meeting = Meeting {
        interface: &model.interfaces[pair.interface],
        pair: group.pair,
        linear: S::unrotate(frame.rotation, contactor.linear - target.linear),
        contactor_spin: S::unrotate_spin(frame.rotation, contactor.angular),
        target_spin: S::unrotate_spin(frame.rotation, target.angular),
        frame,
    };
    let before = scratch.contacts.len();
    let mut total = PairWrench::default();

    match model.pair_nodes(pair) {
        Nodes::Fixed(_) => {
            for element in group.first..group.end {
                let node = meeting.frame.to_surface(state.elements.positions[element]);
                if surface.may_touch(node).any() {
                    let gap = surface.gap(node);
                    meeting.contact(state, element, node, gap, scratch, &mut total);
                }
            }
        }
        Nodes::Rolling { center, radius, .. } => {
            let center = meeting.frame.to_surface(*center);
            let mut gap = surface.gap(center);
            gap.distance -= *radius;
            let node = center - gap.normal * *radius;
            meeting.contact(state, group.first, node, gap, scratch, &mut total);
        }
    }

    if scratch.contacts.len() > before {
        let rotation = meeting.frame.rotation;
        let force = S::rotate(rotation, total.force);
        let on_contactor = &mut scratch.wrenches[pair.contactor];
        on_contactor.force += force;
        on_contactor.moment += S::rotate_spin(rotation, total.contactor_moment);
        let on_target = &mut scratch.wrenches[pair.target];
        on_target.force -= force;
        on_target.moment -= S::rotate_spin(rotation, total.target_moment);
        scratch.pair_forces.push(PairForce { pair: group.pair, force });
    }
}

/// The sum of the contact forces of a pair, in the frame of the target's surface.
#[derive(Clone, Copy, Default)]
struct PairWrench<S: Space> {
    /// On the contactor (N); the target feels the opposite.
    force: S::Vector,
    /// Moment of that force about the contactor's center of mass (N·m).
    contactor_moment: S::Spin,
    /// Moment of that force about the target's center of mass (N·m).
    target_moment: S::Spin,
}

/// Two bodies at their contact, seen from the target's surface.
struct Meeting<'a, S: Space> {
    interface: &'a Interface<S>,
    pair: usize,
    frame: PairFrame<S>,
    /// Velocity of the contactor's center of mass less that of the target's (m/s).
    linear: S::Vector,
    contactor_spin: S::Spin,
    target_spin: S::Spin,
}

impl<S: Space> Meeting<'_, S> {
    /// One element; `node` is its position (m) in the surface's frame.
    #[inline]
    fn contact(
        &self,
        state: &State<S>,
        element: usize,
        node: S::Vector,
        gap: Gap<S>,
        scratch: &mut Scratch<S>,
        total: &mut PairWrench<S>,
    ) {
        let zero = S::Real::zero();
        let touching = gap.distance.lt(zero);
        if !touching.any() {
            return;
        }
        let weight = S::Real::select(touching, state.elements.weights[element], zero);

        // Both bodies feel the force at the companion point, and both velocities are taken there:
        // so the pair conserves momentum, and force times relative velocity is the power it loses.
        let point = node - gap.normal * gap.distance;
        let contactor_arm = point - self.frame.contactor;
        let target_arm = point - self.frame.target;
        let velocity = self.linear + S::velocity_at(self.contactor_spin, contactor_arm)
            - S::velocity_at(self.target_spin, target_arm);
        let penetration = S::Real::select(touching, -gap.distance, zero);
        let penetration_rate = -velocity.dot(gap.normal);
        let slip_rate = S::tangential(velocity, gap.normal);

        let normal = self.interface.normal.force(penetration, penetration_rate);
        let normal_force = normal.total * weight;
        let stick = state.elements.sticks[element];
        let friction = self.interface.friction.force::<S>(stick, slip_rate, normal_force, weight);

        let force = gap.normal * normal_force - S::along(friction.force, gap.normal);
        total.force += force;
        total.contactor_moment += S::moment(contactor_arm, force);
        total.target_moment += S::moment(target_arm, force);

        let totals = &mut scratch.totals;
        totals.elastic += normal.energy * weight;
        totals.stick += friction.energy;
        totals.damped += (normal_force - normal.elastic * weight) * penetration_rate;
        totals.friction += friction.force.dot(slip_rate);

        let counted = S::Real::select(touching, S::Real::splat(1.0), zero);
        scratch.slip_rates[element] = slip_rate * counted;
        scratch.contacts.push(Contact {
            element,
            pair: self.pair,
            node: state.elements.nodes[element],
            touching,
            point,
            normal: gap.normal,
            penetration,
            penetration_rate,
            normal_force,
            slip_rate,
            friction_force: friction.force,
        });
    }
}

/// Newton's law for every free body: contact, gravity and viscous damping (eq. 2.8).
fn accelerate<S: Space>(model: &Model<S>, state: &State<S>, scratch: &mut Scratch<S>) {
    for (i, body) in model.bodies.iter().enumerate() {
        if body.motion == Motion::Prescribed {
            scratch.accelerations[i] = Twist::default();
            continue;
        }
        let mut wrench = scratch.wrenches[i];
        if let Some(damping) = body.damping {
            let (force, moment) = S::damp(damping, state.twists[i].linear, state.twists[i].angular);
            wrench.force += force;
            wrench.moment += moment;
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
/// friction can hold, and elements that do not touch forget.
pub(crate) fn commit<S: Space>(model: &Model<S>, state: &mut State<S>, scratch: &mut Scratch<S>) {
    scratch.committed.clear();
    scratch.committed.resize(state.elements.len(), Stick::default());
    let elements = &mut state.elements;
    for contact in &scratch.contacts {
        let element = contact.element;
        let law = &model.interfaces[model.pairs[contact.pair].interface].friction;
        let mut stick = elements.sticks[element].commit(
            law,
            contact.slip_rate,
            contact.normal_force,
            elements.weights[element],
        );
        let counted = S::Real::select(contact.touching, S::Real::splat(1.0), S::Real::zero());
        stick.displacement = stick.displacement * counted;
        stick.slipping = stick.slipping & contact.touching;
        scratch.committed[element] = stick;
    }
    std::mem::swap(&mut elements.sticks, &mut scratch.committed);
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
