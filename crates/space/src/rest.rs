//! Criterion for the end of a three-dimensional run, the same as in the plane models. A run ends when no body is fast
//! enough to change the outcome and the ground is still or, after a collapse, nearly still.

use std::sync::Arc;

use barrelstack::assemble::PartKind;
use barrelstack::scenario::{Scenario, Until};
use barrelstack::watch::Fading;
use barrelstack::watch::rest::{CLIMB, HOLD, LIVELY, ON_FLOOR, calm, quiet_from};
use barrelstack_dynamics::{BodyId, Linear as _, Pose, Space as _, Spatial, State, Twist, Vec3};

use crate::fate::Fates;
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
    /// Last time (s) at which a body was in motion, or the ground was not yet calm.
    moved: f64,
    /// Decay of the ground motion, for a run that may end before the ground is calm; `None` for every other run.
    fading: Option<Arc<Fading>>,
    /// Time (s) of the next test whether the rest of the motion is faint.
    due: f64,
    /// Largest kinetic energy (J) of all bodies relative to the ground, in all samples.
    liveliest: f64,
    /// Time (s) of the last sample in which the stack was [lively](LIVELY).
    lively: f64,
}

impl Rest {
    /// Creates the detector for the stack of a scenario under a ground motion.
    pub fn new(scenario: &Scenario, stack: Arc<Stack>, ground: &Ground) -> Self {
        let gravity = scenario.run.gravity;
        let calm = || ground.calm_from(gravity * calm(stack.model.interfaces()));
        let (still_from, calm_from) = quiet_from(scenario.run.until, ground.end(), calm);
        let fading = (scenario.run.until == Until::Verdict).then(|| {
            let strength = |time| ground.strength(time);
            Arc::new(Fading::new(ground.end(), ground.resolution(), HOLD, strength))
        });
        let slow = gravity * CLIMB;
        Self {
            stack,
            still_from,
            calm_from,
            slow,
            moved: 0.0,
            fading,
            due: 0.0,
            liveliest: 0.0,
            lively: 0.0,
        }
    }

    /// Records an accepted state; returns `true` if all bodies have come to rest or, if only the verdict is requested, if
    /// the stack can no longer fall. `fates` are the outcomes so far.
    pub(crate) fn observe(&mut self, state: &State<Spatial>, fates: &Fates) -> bool {
        let collapsed = fates.collapse().is_some();
        let bodies = (&*state.poses, &*state.twists);
        let rests = self.observe_bodies(state.time, bodies, collapsed);
        rests || !collapsed && self.is_safe(state.time, bodies, fates.strained())
    }

    /// Records the poses and twists of all bodies at a time (s). Returns `true` if all have come to rest. `collapsed` is
    /// `true` after a loss of seat.
    pub fn observe_bodies(&mut self, time: f64, bodies: Motions<'_>, collapsed: bool) -> bool {
        let from = if collapsed { self.calm_from } else { self.still_from };
        let moves = time < from || self.moving(bodies).any(|body| !self.rolls_away(bodies, body));
        if moves {
            self.moved = time;
        }
        self.moved + HOLD <= time
    }

    /// Returns `true` if the rest of the motion is [faint](Fading), compared with what the stack has withstood since it was
    /// last lively or, at `strained` (s), close to losing a seat.
    fn is_safe(&mut self, time: f64, bodies: Motions<'_>, strained: f64) -> bool {
        let Some(fading) = self.fading.as_ref().filter(|_| self.due <= time) else { return false };
        self.due = time + fading.interval();
        let mass = |body: BodyId| self.stack.model.bodies()[body].mass;
        let energies =
            (1..self.stack.parts.len()).map(|body| mass(body) * self.energy(bodies, body));
        let energy: f64 = energies.sum();
        if energy > LIVELY * self.liveliest {
            self.lively = time;
        }
        self.liveliest = self.liveliest.max(energy);
        let since = strained.max(self.lively);
        since + HOLD <= time && fading.faint_from(since) <= time
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

    fn is_fast(&self, bodies: Motions<'_>, body: BodyId) -> bool {
        self.slow < self.energy(bodies, body)
    }

    /// Returns the kinetic energy of a body relative to the ground, divided by its mass (m²/s²).
    fn energy(&self, (poses, twists): Motions<'_>, body: BodyId) -> f64 {
        let of = &self.stack.model.bodies()[body];
        let velocity = twists[body].linear - twists[Stack::GROUND].linear;
        let rotation = poses[body].orientation.matrix();
        let turning = Spatial::spin_energy(of.inertia, rotation, twists[body].angular);
        0.5 * velocity.dot(velocity) + turning / of.mass
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
