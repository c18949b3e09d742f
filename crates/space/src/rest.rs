//! Criterion for the end of a three-dimensional run, the same as in the plane models. A run ends when no body is fast
//! enough to change the outcome and the ground is still or, after a collapse, nearly still.

use std::sync::Arc;

use barrelstack::assemble::PartKind;
use barrelstack::scenario::Scenario;
use barrelstack::watch::rest::{CLIMB, HOLD, ON_FLOOR, calm, quiet_from};
use barrelstack_dynamics::{BodyId, Linear as _, Pose, Space as _, Spatial, State, Twist, Vec3};

use crate::ground::Ground;
use crate::stack::Stack;

/// Poses and twists of all bodies of a stack, the ground first.
pub type Motions<'a> = (&'a [Pose<Spatial>], &'a [Twist<Spatial>]);

/// Detector of the time at which all bodies have come to rest.
#[derive(Clone, Debug)]
pub struct Rest {
    stack: Arc<Stack>,
    /// Times (s) before which the stack always counts as moving: `still_from` while it stands, and `calm_from` after a
    /// collapse. Both are infinite if the run must last for its full duration.
    still_from: f64,
    calm_from: f64,
    /// Kinetic energy per unit mass (m²/s²) below which a body counts as at rest.
    slow: f64,
    /// Last time (s) at which a body was in motion.
    moved: f64,
}

impl Rest {
    /// Creates the detector for the stack of a scenario under a ground motion.
    pub fn new(scenario: &Scenario, stack: Arc<Stack>, ground: &Ground) -> Self {
        let gravity = scenario.run.gravity;
        let calm = || ground.calm_from(gravity * calm(stack.model.interfaces()));
        let (still_from, calm_from) = quiet_from(scenario.run.until, ground.end(), calm);
        Self { stack, still_from, calm_from, slow: gravity * CLIMB, moved: 0.0 }
    }

    /// Records an accepted state; returns `true` if all bodies have come to rest. `collapsed` is `true` after a loss of
    /// a seat.
    pub(crate) fn observe(&mut self, state: &State<Spatial>, collapsed: bool) -> bool {
        self.observe_bodies(state.time, (&state.poses, &state.twists), collapsed)
    }

    /// Records the poses and twists of all bodies at a time (s). Returns `true` if all have come to rest.
    pub fn observe_bodies(&mut self, time: f64, bodies: Motions<'_>, collapsed: bool) -> bool {
        let from = if collapsed { self.calm_from } else { self.still_from };
        let moves = time < from || self.moving(bodies).any(|body| !self.rolls_away(bodies, body));
        if moves {
            self.moved = time;
        }
        self.moved + HOLD <= time
    }

    /// Returns the bodies that are not at rest.
    pub fn moving<'a>(&'a self, bodies: Motions<'a>) -> impl Iterator<Item = BodyId> + 'a {
        (1..self.stack.parts.len()).filter(move |body| self.is_fast(bodies, *body))
    }

    /// Records that the stack is set in motion again at a time (s). This becomes the last time at which a body was in
    /// motion.
    pub fn wake(&mut self, time: f64) {
        self.moved = time;
    }

    fn is_fast(&self, (poses, twists): Motions<'_>, body: BodyId) -> bool {
        let of = &self.stack.model.bodies()[body];
        let velocity = twists[body].linear - twists[Stack::GROUND].linear;
        let rotation = poses[body].orientation.matrix();
        let turning = Spatial::spin_energy(of.inertia, rotation, twists[body].angular);
        self.slow < 0.5 * velocity.dot(velocity) + turning / of.mass
    }

    /// Returns `true` if a body is a barrel on the floor that rolls away from all other bodies.
    fn rolls_away(&self, (poses, twists): Motions<'_>, own: BodyId) -> bool {
        let part = &self.stack.parts[own];
        if part.kind != PartKind::Barrel {
            return false;
        }
        let ground = Stack::GROUND;
        let (here, velocity) = (poses[own].position, twists[own].linear);
        let rise = velocity.z - twists[ground].linear.z;
        let height = here.z - poses[ground].position.z;
        height <= ON_FLOOR * self.stack.bilge_radius
            && 0.5 * rise * rise <= self.slow
            && (1..self.stack.parts.len()).filter(|other| *other != own).all(|other| {
                let apart = poses[other].position - here;
                let parting = twists[other].linear - velocity;
                let level = |v: Vec3| Vec3::new(v.x, v.y, 0.0);
                level(apart).dot(level(parting)) >= 0.0
            })
    }
}
