//! The energy balance: input, stored energy, losses, and residual.

use crate::body::Motion;
use crate::element::Memory;
use crate::forces::{Losses, Scratch};
use crate::lanewise;
use crate::model::Model;
use crate::real::Real;
use crate::space::{Linear, Pose, Space, Wrench};
use crate::state::State;

/// Energies (J) at one time, and the work (J) done from the start of the run to that time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergySummary {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Gravitational potential energy, relative to the start.
    pub potential: f64,
    /// Energy stored in normal springs and in force elements.
    pub elastic: f64,
    /// Energy stored in the tangential springs of sticking contacts.
    pub stick: f64,
    /// Energy lost in the dampers of contacts and elements, by yielding of elements, and by the breaking of elements.
    pub damped: f64,
    /// Energy lost to friction: by sliding, and in the tangential dampers of sticking contacts.
    pub friction: f64,
    /// Energy lost to viscous damping of bodies.
    pub viscous: f64,
    /// Work of the ground on the bodies.
    pub ground_work: f64,
    /// Work of external forces.
    pub applied_work: f64,
    /// Stored and lost energy, minus the initial energy, the work of the ground and the work of external forces; zero
    /// for an exact integration.
    pub residual: f64,
    /// Energy that has passed through the system so far: the absolute work of the ground and of external forces, plus
    /// the energy available at the start. This available energy is the sum of the kinetic energy, the energy of
    /// springs, and the potential energy relative to its lowest value so far. The residual is stated as a fraction of
    /// the throughput.
    pub throughput: f64,
}

impl EnergySummary {
    /// Returns the absolute residual as a fraction of the throughput.
    pub fn residual_ratio(&self) -> f64 {
        if self.throughput > 0.0 { (self.residual / self.throughput).abs() } else { 0.0 }
    }
}

/// Energy balance of every lane, summed over the accepted steps of a run.
///
/// The work of a force in a step is the displacement of the body, multiplied by the mean of the force at the start of
/// the step and the force at its end. This is the discrete energy balance of the central difference method. For
/// velocity Verlet, the balance holds to rounding, apart from an error that does not accumulate: the velocities at the
/// ends of a step differ from the velocity in its middle. So a linear spring returns all its energy, and the work of
/// dampers, friction and the ground is exact, however abruptly these forces set in.
///
/// The residual is the error of the time integration. Its sources are springs that engage or release within a step,
/// nonlinear force laws, and changes of geometry. Mistakes in the force laws also show in the residual: stored energies
/// are computed from the state alone, so a residual remains if a force is not the derivative of its energy, or if the
/// motion and the balance use different forces.
#[derive(Clone, Debug)]
pub struct EnergyLedger<S: Space> {
    initial: S::Real,
    potential_start: S::Real,
    stick_start: S::Real,
    works: Works<S::Real>,
    /// Poses of the bodies at the last accepted step.
    poses: Vec<Pose<S>>,
    /// Dissipative forces on every body at the last accepted step.
    losses: Vec<Losses<S>>,
    viscous: Vec<Wrench<S>>,
    /// Total force and moment on every body at the last accepted step; see [`Scratch::wrenches`].
    wrenches: Vec<Wrench<S>>,
    /// Plastic elongation and failure of the force elements at the last accepted step.
    memory: Vec<Memory<S>>,
    /// Every external force, with its moment, at the last accepted step; see [`Scratch::applied`].
    pub(crate) applied: Vec<Wrench<S>>,
    /// Spring forces of the force elements at the last accepted step (N).
    springs: Vec<S::Real>,
    stored: Stored<S::Real>,
    /// Sum, over all steps, of the absolute values of the work of the ground and of the work of external forces.
    flow: S::Real,
    deepest: S::Real,
}

/// Work (J) by cause, summed over the steps so far.
#[derive(Clone, Copy, Debug, Default)]
struct Works<R> {
    damped: R,
    friction: R,
    viscous: R,
    ground: R,
    applied: R,
}

/// Stored energies at a state (J).
#[derive(Clone, Copy, Debug, Default)]
struct Stored<R> {
    kinetic: R,
    potential: R,
    elastic: R,
    stick: R,
}

impl<S: Space> EnergyLedger<S> {
    /// Starts the energy balance at a state whose forces are in `scratch`.
    pub fn new(model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) -> Self {
        let stored = stored(model, state, scratch);
        Self {
            initial: stored.kinetic + stored.potential + stored.elastic,
            potential_start: stored.potential,
            stick_start: stored.stick,
            works: Works::default(),
            poses: state.poses.clone(),
            losses: scratch.losses.clone(),
            viscous: scratch.viscous.clone(),
            wrenches: scratch.wrenches.clone(),
            memory: state.memory.clone(),
            applied: scratch.applied.clone(),
            springs: scratch.loads.iter().map(|load| load.elastic).collect(),
            stored,
            flow: S::Real::zero(),
            deepest: stored.potential,
        }
    }

    /// Adds the work done in an accepted step, and updates the stored energies.
    pub fn enter(&mut self, model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) {
        S::Real::scope(
            #[inline(always)]
            || self.book(model, state, scratch),
        );
    }

    #[inline(always)]
    fn book(&mut self, model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) {
        let half = S::Real::splat(0.5);
        let mut step = Works::<S::Real>::default();
        for ((push, old), new) in state.applied.iter().zip(&mut self.applied).zip(&scratch.applied)
        {
            let displacement = self.poses[push.body].way_to(state.poses[push.body]);
            step.applied += old.plus(*new).power(displacement) * half;
            *old = *new;
        }
        for (i, body) in model.inert.iter().enumerate() {
            let displacement = self.poses[i].way_to(state.poses[i]);
            let (old, new) = (&self.losses[i], &scratch.losses[i]);
            step.damped -= old.damped.plus(new.damped).power(displacement) * half;
            step.friction -= old.friction.plus(new.friction).power(displacement) * half;
            if body.damped {
                let viscous = self.viscous[i].plus(scratch.viscous[i]);
                step.viscous -= viscous.power(displacement) * half;
            }
            if body.motion == Motion::Prescribed {
                step.ground -=
                    self.wrenches[i].plus(scratch.wrenches[i]).power(displacement) * half;
            }
            // Saved for the next step here, while the data is in the cache.
            self.poses[i] = state.poses[i];
            self.losses[i] = *new;
            self.wrenches[i] = scratch.wrenches[i];
        }
        let elements = self.memory.iter_mut().zip(&mut self.springs);
        for (((before, spring), now), load) in elements.zip(&state.memory).zip(&scratch.loads) {
            let breaks = now.broken & !before.broken;
            step.damped += S::Real::select(breaks, load.energy, S::Real::zero());
            step.damped += (*spring + load.elastic) * half * (now.plastic - before.plastic);
            (*before, *spring) = (*now, load.elastic);
        }
        self.works.damped += step.damped;
        self.works.friction += step.friction;
        self.works.viscous += step.viscous;
        self.works.ground += step.ground;
        self.works.applied += step.applied;
        self.flow += step.ground.abs() + step.applied.abs();
        self.viscous.copy_from_slice(&scratch.viscous);
        self.stored = stored(model, state, scratch);
        self.deepest = self.deepest.min(self.stored.potential);
    }

    /// Returns the lanes in which the kinetic and the potential energy of every body are finite.
    #[inline(always)]
    pub(crate) fn finite(&self) -> <S::Real as Real>::Mask {
        (self.stored.kinetic + self.stored.potential).is_finite_mask()
    }

    /// Returns the energy balance of one lane.
    pub fn summary(&self, lane: usize) -> EnergySummary {
        let Stored { kinetic, potential, elastic, stick } = self.stored;
        let now = kinetic + potential + elastic;
        let lost = self.works.damped + self.works.friction + self.works.viscous;
        // The work of friction is the sum of the work on the tangential springs and the work of sliding, so it includes
        // the energy stored in these springs.
        let residual = now + lost - self.works.ground - self.works.applied - self.initial;
        let throughput = self.flow + (self.initial - self.deepest);
        EnergySummary {
            kinetic: kinetic.lane(lane),
            potential: (potential - self.potential_start).lane(lane),
            elastic: elastic.lane(lane),
            stick: stick.lane(lane),
            damped: self.works.damped.lane(lane),
            friction: (self.works.friction - (stick - self.stick_start)).lane(lane),
            viscous: self.works.viscous.lane(lane),
            ground_work: self.works.ground.lane(lane),
            applied_work: self.works.applied.lane(lane),
            residual: residual.lane(lane),
            throughput: throughput.lane(lane),
        }
    }
}

lanewise!(struct Works<R> { damped, friction, viscous, ground, applied });
lanewise!(struct Stored<R> { kinetic, potential, elastic, stick });
lanewise!(struct EnergyLedger<S> {
    initial, potential_start, stick_start, works, poses, losses, viscous, wrenches, memory, applied, springs, stored,
    flow, deepest
});

#[inline(always)]
fn stored<S: Space>(model: &Model<S>, state: &State<S>, scratch: &Scratch<S>) -> Stored<S::Real> {
    let mut stored = Stored::default();
    for (i, body) in model.inert.iter().enumerate() {
        if body.motion == Motion::Prescribed {
            continue;
        }
        let twist = state.twists[i];
        stored.kinetic += S::Real::splat(0.5) * body.mass * twist.linear.dot(twist.linear)
            + S::spin_energy(body.inertia, scratch.rotations[i], twist.angular);
        stored.potential -= body.mass * model.gravity.dot(state.poses[i].position);
    }
    stored.elastic = scratch.totals.elastic;
    for (memory, load) in state.memory.iter().zip(&scratch.loads) {
        stored.elastic += S::Real::select(memory.broken, S::Real::zero(), load.energy);
    }
    stored.stick = scratch.totals.stick;
    stored
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Body, Nodes, Placed};
    use crate::contact::{Basis, FrictionLaw, Interface, NormalLaw};
    use crate::integrate::{Integrator, Method, Still};
    use crate::model::{ContactPair, Counts};
    use crate::shape::{HalfPlane, Shape};
    use crate::space::{Planar, Rotation2, Twist, Vec2};

    /// Returns the residual ratio of a disc that falls on a floor and bounces, with an additional downward acceleration
    /// (m/s²) whose work the balance does not include.
    fn balance_of_a_bounce(unbooked: f64) -> f64 {
        let body = |name: &str, motion, z, surfaces, nodes| Body {
            name: name.to_owned(),
            motion,
            mass: 100.0,
            inertia: 5.0,
            damping: None,
            pose: Pose { position: Vec2::new(0.0, z), orientation: 0.0 },
            twist: Twist::<Planar>::default(),
            surfaces,
            nodes,
            faces: Vec::new(),
        };
        let floor = Placed {
            surface: Shape::HalfPlane(HalfPlane),
            offset: Vec2::default(),
            rotation: Rotation2::identity(),
        };
        let rolling =
            Nodes::Rolling { center: Vec2::default(), radius: 0.3, tributary_length: 1.0 };
        let bodies = vec![
            body("floor", Motion::Prescribed, 0.0, vec![floor], Vec::new()),
            body("disc", Motion::Free, 0.5, Vec::new(), vec![rolling]),
        ];
        let interface = Interface {
            name: "disc-floor".to_owned(),
            normal: NormalLaw::SpeedGap { stiffness: 1e6, damping: 2e3 },
            stop: None,
            rolling: None,
            friction: FrictionLaw::Frictionless,
            basis: Basis::Node,
        };
        let pair = ContactPair {
            contactor: 1,
            nodes: 0,
            target: 0,
            surface: 0,
            interface: 0,
            counts: Counts::Everywhere,
        };
        let gravity = Vec2::new(0.0, -9.81);
        let model = Model::new(bodies, vec![interface], vec![pair], gravity).unwrap();
        let mut state = State::initial(&model);
        let mut scratch = Scratch::new(&model);
        let mut integrator = Integrator::new(Method::VelocityVerlet);
        Integrator::start(&model, &Still, &mut state, &mut scratch);
        let mut ledger = EnergyLedger::new(&model, &state, &scratch);
        for step in 1..=10_000 {
            scratch.accelerations[1].linear.z -= unbooked;
            integrator.step(&model, &Still, &mut state, &mut scratch, f64::from(step) * 1e-4);
            ledger.enter(&model, &state, &scratch);
        }
        ledger.summary(0).residual_ratio()
    }

    #[test]
    fn energy_balances_and_not_with_a_wrong_force() {
        let right = balance_of_a_bounce(0.0);
        assert!(right < 1e-6, "{right:e}"); // measured 3.1e-8
        // A hundredth of the weight.
        let wrong = balance_of_a_bounce(0.0981);
        assert!(wrong > 1e-3, "{wrong:e}"); // measured 3.2e-3
    }
}
