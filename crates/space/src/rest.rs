//! Rest criterion in space, as in the plane. A run ends when no body is fast enough to change the outcome and the
//! ground is still or, after a collapse, nearly still.

use std::sync::Arc;

use barrelstack::assemble::PartKind;
use barrelstack::scenario::Scenario;
use barrelstack::watch::rest::{CLIMB, HOLD, ON_FLOOR, calm, quiet_from};
use barrelstack_dynamics::{BodyId, Linear as _, Space as _, Spatial, State, Vec3};

use crate::ground::Ground;
use crate::stack::Stack;

/// Detector of the rest of all bodies.
#[derive(Clone, Debug)]
pub(crate) struct Rest {
    stack: Arc<Stack>,
    /// Times (s) from which the ground is still (`still_from`) and nearly still (`calm_from`); infinite if the run does
    /// not end by rest.
    still_from: f64,
    calm_from: f64,
    /// Kinetic energy per mass (m²/s²) below which a body counts as at rest.
    slow: f64,
    /// Last time (s) at which a body was in motion.
    moved: f64,
}

impl Rest {
    pub(crate) fn new(scenario: &Scenario, stack: Arc<Stack>, ground: &Ground) -> Self {
        let gravity = scenario.run.gravity;
        let calm = || ground.calm_from(gravity * calm(stack.model.interfaces()));
        let (still_from, calm_from) = quiet_from(scenario.run.until, ground.end(), calm);
        Self { stack, still_from, calm_from, slow: gravity * CLIMB, moved: 0.0 }
    }

    /// Records an accepted state; returns `true` if all bodies have come to rest. `collapsed` is `true` after a loss of
    /// seat.
    pub(crate) fn observe(&mut self, state: &State<Spatial>, collapsed: bool) -> bool {
        let from = if collapsed { self.calm_from } else { self.still_from };
        let moves = state.time < from
            || (1..self.stack.parts.len())
                .any(|body| self.is_fast(state, body) && !self.rolls_away(state, body));
        if moves {
            self.moved = state.time;
        }
        self.moved + HOLD <= state.time
    }

    fn is_fast(&self, state: &State<Spatial>, body: BodyId) -> bool {
        let of = &self.stack.model.bodies()[body];
        let velocity = state.twists[body].linear - state.twists[Stack::GROUND].linear;
        let rotation = state.poses[body].orientation.matrix();
        let turning = Spatial::spin_energy(of.inertia, rotation, state.twists[body].angular);
        self.slow < 0.5 * velocity.dot(velocity) + turning / of.mass
    }

    /// Returns `true` if a body is a barrel on the floor that rolls away from all other bodies.
    fn rolls_away(&self, state: &State<Spatial>, own: BodyId) -> bool {
        let part = &self.stack.parts[own];
        if part.kind != PartKind::Barrel {
            return false;
        }
        let ground = Stack::GROUND;
        let (here, velocity) = (state.poses[own].position, state.twists[own].linear);
        let rise = velocity.z - state.twists[ground].linear.z;
        let height = here.z - state.poses[ground].position.z;
        height <= ON_FLOOR * self.stack.bilge_radius
            && 0.5 * rise * rise <= self.slow
            && (1..self.stack.parts.len()).filter(|other| *other != own).all(|other| {
                let apart = state.poses[other].position - here;
                let parting = state.twists[other].linear - velocity;
                let level = |v: Vec3| Vec3::new(v.x, v.y, 0.0);
                level(apart).dot(level(parting)) >= 0.0
            })
    }
}
