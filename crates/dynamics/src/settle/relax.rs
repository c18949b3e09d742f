//! Relaxation: steps with fictitious masses and vanishing velocities.

use crate::body::Motion;
use crate::contact::Stick;
use crate::element::Memory;
use crate::forces::{self, Scratch, evaluate};
use crate::lanes::Lanewise;
use crate::model::Model;
use crate::real::{Mask, Real};
use crate::space::{Linear, Planar, Space, Twist, Wrench};
use crate::state::State;

use super::{ROUNDING, gravity};

/// Displacement of a body in free fall in its first step, as a fraction of its reach and multiplied by
/// [`Relaxation::margin`].
const FIRST_FALL: f64 = 1e-4;

/// Maximum displacement of a body in a step, as a fraction of its reach; limited because nonlinear contacts are soft at
/// small penetrations.
const LONGEST_WAY: f64 = 2e-3;

/// Factor that converts displacements per relaxation step to the velocities in the force laws. The factor is a power of
/// two, so that no bits are lost. It is so small that damping forces vanish and smoothed friction laws keep only their
/// static part.
const SLOWLY: f64 = 1.0 / (1_u128 << 100) as f64;

/// A contact, and its position relative to both bodies.
struct Touch<S: Space> {
    element: usize,
    touching: <S::Real as Real>::Mask,
    /// Contactor and target.
    bodies: [usize; 2],
    /// Vectors (m) from the centers of mass of the two bodies to the contact, in the inertial frame.
    arms: [S::Vector; 2],
    /// Rotation from the frame of the target's surface to the inertial frame.
    rotation: S::Rotation,
    /// Unit normal that points out of the target, in the frame of the target's surface.
    normal: S::Vector,
}

/// Total stiffness of all supports of a body, against displacement (N/m) and against rotation (N·m/rad).
#[derive(Clone, Copy)]
struct Held<R> {
    translation: R,
    turn: R,
}

impl<R: Real> Held<R> {
    /// Adds the contribution of a spring, given by its stiffness (N/m); `arm` is the vector (m) from the center of mass
    /// to the point at which the spring acts.
    #[inline(always)]
    fn by(&mut self, stiffness: R, arm: impl Linear<R>) {
        self.translation += stiffness;
        self.turn += stiffness * arm.dot(arm);
    }
}

/// Relaxation state. Each lane converges independently; converged lanes are frozen.
pub(super) struct Relaxation<S: Space> {
    /// Ratio of the fictitious mass of a body to the total stiffness of its contacts.
    ///
    /// For the displacements and rotations of two bodies, the stiffness matrix of a contact of stiffness k is bounded
    /// by a diagonal matrix with entries 4 k. Central differences with a step of 1 are stable if every mass is at least
    /// a quarter of the corresponding diagonal entry. So a ratio of 1 is just stable for springs; larger ratios leave a
    /// margin for slipping friction.
    margin: f64,
    /// The lanes at rest.
    pub(super) resting: <S::Real as Real>::Mask,
    /// `true` for every body that has had a contact or a loaded force element.
    pub(super) met: Vec<bool>,
    /// For each body, the largest distance (m) of its boundary from its center of mass.
    pub(super) reach: Vec<S::Real>,
    /// Displacements and rotations of the bodies in the last step.
    displacements: Vec<Twist<S>>,
    /// For each body, the largest stiffness of its supports so far. The largest value is kept because a body that
    /// briefly loses its contacts must not become light while other bodies lie on it.
    held: Vec<Held<S::Real>>,
    touches: Vec<Touch<S>>,
    /// For each contact element, the lanes in which it touched when the list of contacts was last updated.
    pub(super) touched: Vec<<S::Real as Real>::Mask>,
    /// Number of remaining steps without momentum.
    calm: u64,
    /// Number of steps since the bodies were last stopped.
    since: S::Real,
}

impl<S: Space> Relaxation<S> {
    /// Creates the initial state, with `calm` steps without momentum.
    pub(super) fn new(model: &Model<S>, margin: f64, calm: u64) -> Self {
        Self {
            margin,
            resting: Default::default(),
            met: vec![false; model.bodies.len()],
            reach: model.reach.iter().map(|reach| S::Real::splat(*reach)).collect(),
            displacements: vec![Twist::default(); model.bodies.len()],
            held: vec![
                Held { translation: S::Real::zero(), turn: S::Real::zero() };
                model.bodies.len()
            ],
            touches: Vec::new(),
            touched: Vec::new(),
            calm,
            since: S::Real::zero(),
        }
    }

    /// Returns the largest distance (m) of the boundary of a body from its center of mass; 1 m for a body without a
    /// boundary.
    #[inline(always)]
    fn extent(&self, body: usize) -> S::Real {
        let reach = self.reach[body];
        S::Real::select(S::Real::zero().lt(reach), reach, S::Real::splat(1.0))
    }

    /// Returns the residual acceleration (m/s²) of a body; the angular acceleration is multiplied by the reach of the
    /// body.
    #[inline(always)]
    pub(super) fn acceleration(&self, scratch: &Scratch<S>, body: usize) -> S::Real {
        let Twist { linear, angular } = scratch.accelerations[body];
        length::<S>(linear).max(S::spin_magnitude(angular) * self.reach[body])
    }

    /// Returns the lanes at rest, and the largest residual acceleration (m/s²).
    ///
    /// A lane is at rest if the residual of every body is below `tolerance` (a fraction of gravity) plus the rounding
    /// error of stiff contacts.
    pub(super) fn left_over(
        &self,
        model: &Model<S>,
        state: &State<S>,
        scratch: &Scratch<S>,
        tolerance: f64,
    ) -> (<S::Real as Real>::Mask, S::Real) {
        S::Real::scope(
            #[inline(always)]
            || {
                let allowed = S::Real::splat(tolerance) * gravity(model);
                let (mut rests, mut worst) = (!<S::Real as Real>::Mask::default(), S::Real::zero());
                for (i, body) in model.bodies.iter().enumerate() {
                    if body.motion == Motion::Prescribed {
                        continue;
                    }
                    let acceleration = self.acceleration(scratch, i);
                    let place = length::<S>(state.poses[i].position) + self.reach[i];
                    let rounding =
                        S::Real::splat(ROUNDING) * place * self.held[i].translation / body.mass;
                    rests = rests & acceleration.lt(allowed + rounding);
                    worst = S::Real::select(worst.lt(acceleration), acceleration, worst);
                }
                (rests, worst)
            },
        )
    }

    /// Replaces the list of contacts by the contacts of the last force evaluation, and updates the stiffness of the
    /// supports of each body.
    pub(super) fn weigh(&mut self, model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) {
        S::Real::scope(
            #[inline(always)]
            || self.weigh_all(model, state, scratch),
        );
    }

    #[inline(always)]
    fn weigh_all(&mut self, model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) {
        let none = Held { translation: S::Real::zero(), turn: S::Real::zero() };
        let mut now = vec![none; model.bodies.len()];
        self.touches.clear();
        self.touched.clear();
        self.touched.resize(state.contact_elements.len(), Default::default());
        for contact in &scratch.contacts {
            let pair = &model.pair(contact.pair);
            let interface = &model.interfaces[pair.interface];
            let placed = &model.bodies[pair.target].surfaces[pair.surface];
            let target = scratch.rotations[pair.target];
            let rotation = forces::frame_of(model, scratch, contact);
            let origin = state.poses[pair.target].position + S::rotate(target, placed.offset);
            let point = origin + S::rotate(rotation, contact.point);
            let bodies = [pair.contactor, pair.target];
            let arms = [
                point - state.poses[pair.contactor].position,
                point - state.poses[pair.target].position,
            ];
            let zero = S::Real::zero();
            let weight = state.contact_elements.weights[contact.element];
            let weight = S::Real::select(contact.touching, weight, zero);
            let stiffness = interface.stiffness(contact.penetration) * weight;
            for (body, arm) in bodies.into_iter().zip(arms) {
                self.met[body] = true;
                now[body].by(stiffness, arm);
            }
            let (element, touching, normal) = (contact.element, contact.touching, contact.normal);
            self.touched[element] = touching;
            self.touches.push(Touch { element, touching, bodies, arms, rotation, normal });
        }
        for (element, load) in model.elements.iter().zip(&scratch.loads) {
            let bears = S::Real::zero().lt(load.force.abs());
            if bears.any() {
                let stiffness = S::Real::select(bears, element.stiffness(), S::Real::zero());
                for (body, point) in element.ends() {
                    self.met[body] = true;
                    now[body].by(stiffness, point);
                }
            }
        }
        for (held, now) in self.held.iter_mut().zip(now) {
            held.translation = held.translation.max(now.translation);
            held.turn = held.turn.max(now.turn);
        }
    }

    /// Takes one relaxation step: moves the bodies under the forces of the current state, and computes the forces of
    /// the new state.
    pub(super) fn advance(
        &mut self,
        model: &Model<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
    ) {
        self.set_out(model, state, scratch);
        self.arrive(model, state, scratch);
    }

    /// Takes the first part of a step: moves the bodies, and advances the displacements of the tangential springs.
    pub(super) fn set_out(&mut self, model: &Model<S>, state: &mut State<S>, scratch: &Scratch<S>) {
        S::Real::scope(
            #[inline(always)]
            || {
                self.choose_ways(model, scratch);
                self.slide(&mut state.contact_elements.sticks);
                for (i, displacement) in self.displacements.iter().enumerate() {
                    state.poses[i] = state.poses[i].moved(*displacement, S::Real::splat(1.0));
                    state.twists[i] = Twist::default().plus(*displacement, S::Real::splat(SLOWLY));
                }
            },
        );
    }

    /// Takes the second part of a step: computes the forces of the new state, and commits the contact history.
    pub(super) fn arrive(
        &mut self,
        model: &Model<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
    ) {
        let still = S::Real::zero();
        if let Some(origins) =
            state.contact_elements.refresh(model, &state.poses, &state.twists, still)
        {
            self.renumber(&origins, scratch);
        }
        evaluate(model, state, scratch);
        S::Real::scope(
            #[inline(always)]
            || self.slide_fresh(model, &mut state.contact_elements.sticks, scratch),
        );
        let kept = self
            .resting
            .any()
            .then(|| (state.contact_elements.sticks.clone(), state.memory.clone()));
        forces::commit(model, state, scratch);
        if let Some((sticks, memory)) = kept {
            S::Real::scope(
                #[inline(always)]
                || self.keep(state, &sticks, &memory),
            );
        }
    }

    /// Moves the data of the contact elements to the indices of a new list. `origins` contains, for every element of
    /// the new list, its index in the old list; `None` for an element that is new.
    pub(super) fn renumber(&mut self, origins: &[Option<usize>], scratch: &mut Scratch<S>) {
        scratch.renumber(origins);
        let touched =
            |origin: &Option<usize>| origin.map_or_else(Default::default, |o| self.touched[o]);
        self.touched = origins.iter().map(touched).collect();
    }

    /// Restores the contact history and the state of the force elements in lanes at rest.
    #[inline(always)]
    fn keep(&self, state: &mut State<S>, sticks: &[Stick<S>], memory: &[Memory<S>]) {
        let rests = self.resting;
        for (stick, kept) in state.contact_elements.sticks.iter_mut().zip(sticks) {
            stick.displacement = S::choose(rests, kept.displacement, stick.displacement);
            stick.slipping = (rests & kept.slipping) | (!rests & stick.slipping);
        }
        for (now, kept) in state.memory.iter_mut().zip(memory) {
            now.plastic = S::Real::select(rests, kept.plastic, now.plastic);
            now.broken = (rests & kept.broken) | (!rests & now.broken);
        }
    }

    /// Computes the displacements of the next step: the response of the fictitious masses to the forces, plus a share
    /// of the last displacements. This share grows until the power of the forces becomes negative.
    #[inline(always)]
    fn choose_ways(&mut self, model: &Model<S>, scratch: &Scratch<S>) {
        let (zero, one) = (S::Real::zero(), S::Real::splat(1.0));
        let mut power = zero;
        for ((body, displacement), forces) in
            model.bodies.iter().zip(&self.displacements).zip(each(model, scratch))
        {
            if body.motion == Motion::Free {
                power += forces.power(*displacement);
            }
        }
        let against = power.lt(zero);
        self.since = S::Real::select(against, zero, self.since) + one;
        let carried = self.since / (self.since + S::Real::splat(3.0));
        let calm = S::Real::splat(if self.calm > 0 { 0.0 } else { 1.0 });
        self.calm = self.calm.saturating_sub(1);
        let carried = S::Real::select(against | self.resting, zero, carried * calm);
        let given = S::Real::select(self.resting, zero, S::Real::splat(1.0 / self.margin));
        let gravity = gravity(model);
        for (i, forces) in each(model, scratch).enumerate() {
            let body = &model.bodies[i];
            if body.motion == Motion::Prescribed {
                continue;
            }
            let extent = self.extent(i);
            let (displacement, held) = (&mut self.displacements[i], self.held[i]);
            let falling = body.mass * gravity / (S::Real::splat(FIRST_FALL) * extent);
            let holds = zero.lt(held.translation);
            let stiffness = S::Real::select(holds, held.translation, falling);
            // A single support through its center of mass does not resist the rotation of a body.
            let turning = held.turn.max(S::Real::splat(1e-3) * stiffness * extent * extent);
            let linear = displacement.linear * carried + forces.force * (given / stiffness);
            let angular = displacement.angular * carried + forces.moment * (given / turning);
            let length = linear.dot(linear).sqrt().max(S::spin_magnitude(angular) * extent);
            let longest = S::Real::splat(LONGEST_WAY) * extent;
            let cut = longest / length.max(longest);
            *displacement = Twist { linear: linear * cut, angular: angular * cut };
        }
    }

    /// Adds the tangential displacement of every contact in this step to the displacement of its tangential spring.
    #[inline(always)]
    fn slide(&self, sticks: &mut [Stick<S>]) {
        for touch in &self.touches {
            let step = |of: usize| {
                let displacement = self.displacements[touch.bodies[of]];
                displacement.linear + S::velocity_at(displacement.angular, touch.arms[of])
            };
            let slip = S::unrotate(touch.rotation, step(0) - step(1));
            let slip = S::rotate_tangent(touch.rotation, S::tangential(slip, touch.normal));
            let spin = |of: usize| {
                S::unrotate_spin(touch.rotation, self.displacements[touch.bodies[of]].angular)
            };
            let spins = [spin(1), spin(0) - spin(1)];
            let stick = &mut sticks[touch.element];
            let (displacement, plane) = (stick.displacement, stick.tangent_plane);
            let turn = S::stick_turn(displacement, plane, touch.rotation, spins);
            let counted = S::Real::select(touch.touching, S::Real::splat(1.0), S::Real::zero());
            stick.displacement += S::add_turn(touch.touching, slip * counted, turn);
        }
    }

    /// Updates the tangential spring of every contact that began in this step: adds the tangential displacement from
    /// the beginning of the contact to the end of the step.
    #[inline(always)]
    fn slide_fresh(&self, model: &Model<S>, sticks: &mut [Stick<S>], scratch: &Scratch<S>) {
        let one = S::Real::splat(1.0);
        for contact in &scratch.contacts {
            let fresh = contact.touching & !self.touched[contact.element];
            if fresh.any() {
                let steps = S::Real::splat(1.0 / SLOWLY);
                let (depth, approach) = (contact.penetration, contact.penetration_rate * steps);
                let partly = fresh & depth.lt(approach);
                let share = depth / S::Real::select(partly, approach, one);
                let share =
                    S::Real::select(partly, share, S::Real::select(fresh, one, S::Real::zero()));
                let slip =
                    S::rotate_tangent(forces::frame_of(model, scratch, contact), contact.slip_rate);
                sticks[contact.element].displacement += slip * (steps * share);
            }
        }
    }
}

impl<R: Real> Relaxation<Planar<R>> {
    /// Resets a lane to the initial state.
    pub(super) fn begin(&mut self, lane: usize) {
        for (displacement, held) in self.displacements.iter_mut().zip(&mut self.held) {
            displacement.put(lane, &Twist::default());
            held.translation.put(lane, &0.0);
            held.turn.put(lane, &0.0);
        }
        self.since.put(lane, &0.0);
    }
}

#[inline(always)]
fn length<S: Space>(vector: S::Vector) -> S::Real {
    vector.dot(vector).sqrt()
}

/// Returns the force on every body, including gravity, and the moment of the force about the center of mass.
#[inline(always)]
fn each<'a, S: Space>(
    model: &'a Model<S>,
    scratch: &'a Scratch<S>,
) -> impl Iterator<Item = Wrench<S>> + 'a {
    model.bodies.iter().zip(&scratch.wrenches).map(
        #[inline(always)]
        |(body, wrench)| Wrench { force: wrench.force + model.gravity * body.mass, ..*wrench },
    )
}
