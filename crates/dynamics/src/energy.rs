//! The energy ledger: what came in, what is stored, what was lost, and what does not balance.

use crate::body::Motion;
use crate::forces::Scratch;
use crate::model::Model;
use crate::real::Real;
use crate::space::{Linear, Space};
use crate::state::State;

/// Energies and works at one time (J), since the start of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergySummary {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Potential energy in gravity, relative to the start.
    pub potential: f64,
    /// Stored in normal springs.
    pub elastic: f64,
    /// Stored in sticks.
    pub stick: f64,
    /// Lost in contact dampers.
    pub damped: f64,
    /// Lost to friction (sliding and the damping of sticks).
    pub friction: f64,
    /// Lost to viscous damping of bodies.
    pub viscous: f64,
    /// Work that the ground has done on the bodies.
    pub ground_work: f64,
    /// Stored and lost, less what was there at the start and what the ground did; zero in exact
    /// arithmetic and time.
    pub residual: f64,
    /// Absolute flow of energy through the system so far: what the ground gave plus what was there
    /// to be given (motion and springs at the start, and the deepest drop), the measure of the
    /// residual.
    pub throughput: f64,
}

impl EnergySummary {
    /// The residual as a share of the energy that went through the system.
    pub fn residual_ratio(&self) -> f64 {
        if self.throughput > 0.0 { (self.residual / self.throughput).abs() } else { 0.0 }
    }
}

/// Sums energies over the accepted steps of a run; one entry per lane.
#[derive(Clone, Debug)]
pub struct EnergyLedger<S: Space> {
    initial: S::Real,
    potential_start: S::Real,
    stick_start: S::Real,
    works: Works<S::Real>,
    powers: Works<S::Real>,
    stored: Stored<S::Real>,
    /// Absolute work of the ground plus the largest drop of potential energy.
    ground_flow: S::Real,
    deepest: S::Real,
    time: f64,
}

/// Powers (W), or their integrals (J).
#[derive(Clone, Copy, Debug, Default)]
struct Works<R> {
    damped: R,
    friction: R,
    viscous: R,
    ground: R,
}

/// Energies held at a state (J).
#[derive(Clone, Copy, Debug, Default)]
struct Stored<R> {
    kinetic: R,
    potential: R,
    elastic: R,
    stick: R,
}

impl<S: Space> EnergyLedger<S> {
    /// Opens the ledger at a state whose forces are in `scratch`.
    pub fn new(model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) -> Self {
        let stored = stored(model, state, scratch);
        Self {
            initial: stored.kinetic + stored.potential + stored.elastic,
            potential_start: stored.potential,
            stick_start: stored.stick,
            works: Works::default(),
            powers: powers(model, state, scratch),
            stored,
            ground_flow: S::Real::zero(),
            deepest: stored.potential,
            time: state.time,
        }
    }

    /// Enters an accepted step; works are the trapezoid of the powers.
    pub fn enter(&mut self, model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) {
        let half = S::Real::splat(0.5 * (state.time - self.time));
        let now = powers(model, state, scratch);
        let add = |work: &mut S::Real, old: S::Real, new: S::Real| *work += (old + new) * half;
        let before = self.powers;
        add(&mut self.works.damped, before.damped, now.damped);
        add(&mut self.works.friction, before.friction, now.friction);
        add(&mut self.works.viscous, before.viscous, now.viscous);
        add(&mut self.works.ground, before.ground, now.ground);
        self.ground_flow += ((before.ground + now.ground) * half).abs();
        self.powers = now;
        self.stored = stored(model, state, scratch);
        self.deepest = self.deepest.min(self.stored.potential);
        self.time = state.time;
    }

    /// Whether every body's kinetic and potential energy is a finite number.
    pub(crate) fn is_finite(&self) -> bool {
        let sum = self.stored.kinetic + self.stored.potential;
        (0..S::Real::LANES).all(|lane| sum.lane(lane).is_finite())
    }

    /// The books of one lane.
    pub fn summary(&self, lane: usize) -> EnergySummary {
        let Stored { kinetic, potential, elastic, stick } = self.stored;
        let now = kinetic + potential + elastic;
        let lost = self.works.damped + self.works.friction + self.works.viscous;
        // The work of friction is what bodies gave to sticks and to sliding together: sticks are in it.
        let residual = now + lost - self.works.ground - self.initial;
        let throughput = self.ground_flow + (self.initial - self.deepest);
        EnergySummary {
            kinetic: kinetic.lane(lane),
            potential: (potential - self.potential_start).lane(lane),
            elastic: elastic.lane(lane),
            stick: stick.lane(lane),
            damped: self.works.damped.lane(lane),
            friction: (self.works.friction - (stick - self.stick_start)).lane(lane),
            viscous: self.works.viscous.lane(lane),
            ground_work: self.works.ground.lane(lane),
            residual: residual.lane(lane),
            throughput: throughput.lane(lane),
        }
    }
}

fn stored<S: Space>(model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) -> Stored<S::Real> {
    let mut stored = Stored::default();
    for (i, body) in model.bodies.iter().enumerate() {
        if body.motion == Motion::Prescribed {
            continue;
        }
        let twist = state.twists[i];
        stored.kinetic += S::Real::splat(0.5) * body.mass * twist.linear.dot(twist.linear)
            + S::spin_energy(body.inertia, scratch.rotations[i], twist.angular);
        stored.potential -= body.mass * model.gravity.dot(state.poses[i].position);
    }
    stored.elastic = scratch.totals.elastic;
    stored.stick = scratch.totals.stick;
    stored
}

fn powers<S: Space>(model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) -> Works<S::Real> {
    let mut powers = Works {
        damped: scratch.totals.damped,
        friction: scratch.totals.friction,
        viscous: S::Real::zero(),
        ground: S::Real::zero(),
    };
    for (i, body) in model.bodies.iter().enumerate() {
        let twist = state.twists[i];
        if body.motion == Motion::Prescribed {
            let wrench = scratch.wrenches[i];
            powers.ground -= wrench.force.dot(twist.linear);
        } else if let Some(damping) = body.damping {
            let (force, moment) = S::damp(damping, twist.linear, twist.angular);
            powers.viscous -= force.dot(twist.linear) + moment.dot(twist.angular);
        }
    }
    powers
}
