//! Relaxation: steps with fictitious masses, in which nothing has a speed.

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

/// Share of its reach that a body falls in its first step while nothing holds it.
const FIRST_FALL: f64 = 1e-4;

/// Share of its reach that a body moves in a step at most: contacts that stiffen with penetration are soft
/// when they are met.
const LONGEST_WAY: f64 = 2e-3;

/// Velocities (per step of relaxation) that forces see: a power of two, by which bits do not change, so
/// small that no damper feels it and that of smooth friction laws only what holds at rest is left.
const SLOWLY: f64 = 1.0 / (1_u128 << 100) as f64;

/// A contact, seen from both of its bodies.
struct Touch<S: Space> {
    element: usize,
    touching: <S::Real as Real>::Mask,
    /// Contactor and target.
    bodies: [usize; 2],
    /// From their centers of mass to the contact (m), in the inertial frame.
    arms: [S::Vector; 2],
    /// From the frame of the target's surface to the inertial frame.
    rotation: S::Rotation,
    /// Out of the target, in the surface's frame.
    normal: S::Vector,
}

/// The stiffness of all that holds a body: for its way (N/m) and for its turn (N·m).
#[derive(Clone, Copy)]
struct Held<R> {
    way: R,
    turn: R,
}

impl<R: Real> Held<R> {
    /// Adds a spring (N/m) at an arm (m).
    #[inline(always)]
    fn by(&mut self, stiffness: R, arm: impl Linear<R>) {
        self.way += stiffness;
        self.turn += stiffness * arm.dot(arm);
    }
}

/// What relaxation carries from step to step. Lanes decide alone; a lane that rests stays as it is.
pub(super) struct Relaxation<S: Space> {
    /// Fictitious mass over the stiffness that a body's contacts add up to.
    ///
    /// A contact of stiffness k between two bodies, seen in their ways and turns, is at most four times k
    /// on the diagonal, and central differences with a step of 1 are stable while a mass is a quarter of
    /// the stiffness: so 1 is just stable for springs, and the rest is for friction that breaks.
    margin: f64,
    /// The lanes that rest.
    pub(super) resting: <S::Real as Real>::Mask,
    /// The bodies that have touched something, or hung on something.
    pub(super) met: Vec<bool>,
    /// How far every body extends from its center of mass (m).
    pub(super) reach: Vec<S::Real>,
    /// The ways and turns of the last step.
    ways: Vec<Twist<S>>,
    /// The stiffest that every body has been held: a body that leaves its contacts for a moment must not
    /// become light while others lie on it.
    held: Vec<Held<S::Real>>,
    touches: Vec<Touch<S>>,
    /// Whether every element of the list touched.
    pub(super) touched: Vec<<S::Real as Real>::Mask>,
    /// Steps that are still to be made without momentum.
    calm: u64,
    /// Steps since the last stop.
    since: S::Real,
}

impl<S: Space> Relaxation<S> {
    /// At the start: nothing moves, and no body has been held. The first steps may go without momentum.
    pub(super) fn new(model: &Model<S>, margin: f64, calm: u64) -> Self {
        Self {
            margin,
            resting: Default::default(),
            met: vec![false; model.bodies.len()],
            reach: model.reach.iter().map(|reach| S::Real::splat(*reach)).collect(),
            ways: vec![Twist::default(); model.bodies.len()],
            held: vec![Held { way: S::Real::zero(), turn: S::Real::zero() }; model.bodies.len()],
            touches: Vec::new(),
            touched: Vec::new(),
            calm,
            since: S::Real::zero(),
        }
    }

    /// How far a body extends from its center of mass (m); a meter where it has no boundary.
    #[inline(always)]
    fn extent(&self, body: usize) -> S::Real {
        let reach = self.reach[body];
        S::Real::select(S::Real::zero().lt(reach), reach, S::Real::splat(1.0))
    }

    /// The acceleration (m/s²) that is left to a body, rotation counted at its reach.
    #[inline(always)]
    pub(super) fn acceleration(&self, scratch: &Scratch<S>, body: usize) -> S::Real {
        let Twist { linear, angular } = scratch.accelerations[body];
        length::<S>(linear).max(S::spin_magnitude(angular) * self.reach[body])
    }

    /// Where what is left to every body is less than a share of gravity, or than rounding makes of stiff
    /// contacts; and the largest acceleration (m/s²) that is left.
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
                    let rounding = S::Real::splat(ROUNDING) * place * self.held[i].way / body.mass;
                    rests = rests & acceleration.lt(allowed + rounding);
                    worst = S::Real::select(worst.lt(acceleration), acceleration, worst);
                }
                (rests, worst)
            },
        )
    }

    /// Looks at all that touches in the last evaluation, and at how stiff that holds each body.
    pub(super) fn weigh(&mut self, model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) {
        S::Real::scope(
            #[inline(always)]
            || self.weigh_all(model, state, scratch),
        );
    }

    #[inline(always)]
    fn weigh_all(&mut self, model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) {
        let none = Held { way: S::Real::zero(), turn: S::Real::zero() };
        let mut now = vec![none; model.bodies.len()];
        self.touches.clear();
        self.touched.clear();
        self.touched.resize(state.contact_elements.len(), Default::default());
        for contact in &scratch.contacts {
            let pair = &model.pair(contact.pair);
            let interface = &model.interfaces[pair.interface];
            let placed = &model.bodies[pair.target].surfaces[pair.surface];
            let target = scratch.rotations[pair.target];
            let rotation = S::compose(target, placed.rotation);
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
            held.way = held.way.max(now.way);
            held.turn = held.turn.max(now.turn);
        }
    }

    /// One step: from the forces at a state to a state nearer to rest, and the forces there.
    pub(super) fn advance(
        &mut self,
        model: &Model<S>,
        state: &mut State<S>,
        scratch: &mut Scratch<S>,
    ) {
        self.set_out(model, state, scratch);
        self.arrive(model, state, scratch);
    }

    /// The first part of a step: bodies and sticks go their ways.
    pub(super) fn set_out(&mut self, model: &Model<S>, state: &mut State<S>, scratch: &Scratch<S>) {
        S::Real::scope(
            #[inline(always)]
            || {
                self.choose_ways(model, scratch);
                self.slide(&mut state.contact_elements.sticks);
                for (i, way) in self.ways.iter().enumerate() {
                    state.poses[i] = state.poses[i].moved(*way, S::Real::splat(1.0));
                    state.twists[i] = Twist::default().plus(*way, S::Real::splat(SLOWLY));
                }
            },
        );
    }

    /// The second part of a step: the forces where the bodies are now, and what sticks keep of their ways.
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
            || self.slide_fresh(&mut state.contact_elements.sticks, scratch),
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

    /// Follows a new list of elements.
    pub(super) fn renumber(&mut self, origins: &[Option<usize>], scratch: &mut Scratch<S>) {
        scratch.renumber(origins);
        let touched =
            |origin: &Option<usize>| origin.map_or_else(Default::default, |o| self.touched[o]);
        self.touched = origins.iter().map(touched).collect();
    }

    /// Gives lanes that rest back what they remembered.
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

    /// The ways of the next step: a share of those of the last one, which grows until the forces work
    /// against them, and what the forces give to the fictitious masses.
    #[inline(always)]
    fn choose_ways(&mut self, model: &Model<S>, scratch: &Scratch<S>) {
        let (zero, one) = (S::Real::zero(), S::Real::splat(1.0));
        let mut power = zero;
        for ((body, way), forces) in model.bodies.iter().zip(&self.ways).zip(each(model, scratch)) {
            if body.motion == Motion::Free {
                power += forces.power(*way);
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
            let (way, held) = (&mut self.ways[i], self.held[i]);
            let falling = body.mass * gravity / (S::Real::splat(FIRST_FALL) * extent);
            let holds = zero.lt(held.way);
            let stiffness = S::Real::select(holds, held.way, falling);
            // What holds a body in one point through its center of mass does not resist its turn.
            let turning = held.turn.max(S::Real::splat(1e-3) * stiffness * extent * extent);
            let linear = way.linear * carried + forces.force * (given / stiffness);
            let angular = way.angular * carried + forces.moment * (given / turning);
            let length = linear.dot(linear).sqrt().max(S::spin_magnitude(angular) * extent);
            let longest = S::Real::splat(LONGEST_WAY) * extent;
            let cut = longest / length.max(longest);
            *way = Twist { linear: linear * cut, angular: angular * cut };
        }
    }

    /// Takes every stick along with its contact.
    #[inline(always)]
    fn slide(&self, sticks: &mut [Stick<S>]) {
        for touch in &self.touches {
            let way = |of: usize| {
                let way = self.ways[touch.bodies[of]];
                way.linear + S::velocity_at(way.angular, touch.arms[of])
            };
            let slip = S::unrotate(touch.rotation, way(0) - way(1));
            let counted = S::Real::select(touch.touching, S::Real::splat(1.0), S::Real::zero());
            sticks[touch.element].displacement += S::tangential(slip, touch.normal) * counted;
        }
    }

    /// Gives the sticks of contacts that have just met the share of the step for which they touched.
    #[inline(always)]
    fn slide_fresh(&self, sticks: &mut [Stick<S>], scratch: &Scratch<S>) {
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
                sticks[contact.element].displacement += contact.slip_rate * (steps * share);
            }
        }
    }
}

impl<R: Real> Relaxation<Planar<R>> {
    /// Lets a lane begin anew: nothing moves, and no body has been held.
    pub(super) fn begin(&mut self, lane: usize) {
        for (way, held) in self.ways.iter_mut().zip(&mut self.held) {
            way.put(lane, &Twist::default());
            held.way.put(lane, &0.0);
            held.turn.put(lane, &0.0);
        }
        self.since.put(lane, &0.0);
    }
}

#[inline(always)]
fn length<S: Space>(vector: S::Vector) -> S::Real {
    vector.dot(vector).sqrt()
}

/// The force on every body with gravity, and its moment about the center of mass.
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
