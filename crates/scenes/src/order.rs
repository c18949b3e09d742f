//! Scenes that test whether results depend on the order in which bodies are listed.
//!
//! When the order is reversed, the contactor and the target of every pair of free bodies swap roles.

use std::ops::ControlFlow;

use barrelstack_dynamics::shape::{BarrelProfile, Polygon};
use barrelstack_dynamics::solid::{Barrel, Block, Capsule, Hull};
use barrelstack_dynamics::space::Linear as _;
use barrelstack_dynamics::{
    Body, Interface, Model, Motion, Nodes, NormalLaw, Planar, Quaternion, RunError, Shape, Space,
    Spatial, Still, Twist, Vec2, Vec3,
};

use crate::scene::{DOWN, Scene, all_pairs, centered, coulomb, disc, floor, interface, pose};
use crate::tumble::Random;
use crate::{GRAVITY, spatial};

/// A scene that is run twice: with its bodies in the given order and in reverse order.
pub struct Order<S: Space> {
    /// Name of the scene.
    pub name: String,
    /// The bodies; those with prescribed motion come first.
    pub bodies: Vec<Body<S>>,
    laws: Interface<S>,
    gravity: S::Vector,
}

impl<S: Space<Real = f64>> Order<S> {
    /// Runs the scene with its free bodies in the given order and in reverse order until `end` (s). Returns the largest
    /// difference (m) between the two runs in the position of any body.
    ///
    /// # Errors
    /// If a run fails.
    ///
    /// # Panics
    /// If the bodies do not form a valid model, which is a mistake in the definition of the scene.
    pub fn reversal(&self, step: f64, end: f64) -> Result<f64, RunError> {
        let fixed = self.bodies.iter().take_while(|body| body.motion == Motion::Prescribed).count();
        let mut reversed = self.bodies.clone();
        reversed[fixed..].reverse();
        let (one, mut other) =
            (self.path(self.bodies.clone(), step, end)?, self.path(reversed, step, end)?);
        let mut worst = 0.0_f64;
        for (here, there) in one.iter().zip(&mut other) {
            there[fixed..].reverse();
            for (a, b) in here.iter().zip(there) {
                let apart = *a - *b;
                worst = worst.max(apart.dot(apart).sqrt());
            }
        }
        Ok(worst)
    }

    /// Runs a scene with the given bodies and returns the positions (m) of all bodies after every step.
    fn path(
        &self,
        bodies: Vec<Body<S>>,
        step: f64,
        end: f64,
    ) -> Result<Vec<Vec<S::Vector>>, RunError> {
        let pairs = all_pairs(&bodies);
        let model = Model::new(bodies, vec![self.laws.clone()], pairs, self.gravity)
            .unwrap_or_else(|error| panic!("{}: {error}", self.name));
        let (mut scene, mut all) = (Scene::of(model), Vec::new());
        scene.watch(&Still, step, end, |state, _, _| {
            all.push(state.poses.iter().map(|pose| pose.position).collect());
            ControlFlow::Continue(())
        })?;
        Ok(all)
    }
}

/// Returns the contact law of all scenes, with a stiffness of 2 MN/m and a friction coefficient of 0.35.
fn laws<S: Space<Real = f64>>() -> Interface<S> {
    let normal = NormalLaw::SpeedGap { stiffness: 2e6, damping: 2e3 };
    interface(normal, coulomb(0.35, 2e6, 1e3))
}

/// Returns a planar body of the given kind: circle (0), box (1), box with rounded corners (2), or barrel in side
/// view (3).
fn planar(kind: usize, name: &str, mass: f64, x: f64, z: f64, turn: f64) -> Body<Planar> {
    let radius = 0.3;
    let shape = match kind {
        0 => return disc(name, radius, mass, 0.5 * radius * radius, Vec2::new(x, z)),
        1 => Polygon::rectangle(0.5, 0.4, 0.0).ok().map(Shape::Polygon),
        2 => Polygon::rectangle(0.5, 0.4, 0.08).ok().map(Shape::Polygon),
        _ => BarrelProfile::new(0.7, 0.4, 0.5).map(Shape::BarrelProfile),
    };
    let shape = shape.unwrap_or_else(|| panic!("{name} has no valid shape"));
    Body {
        nodes: vec![Nodes::Rounds(shape.rounds(1.0))],
        surfaces: vec![centered(shape)],
        ..Body::free(name, mass, mass * 0.04, pose(x, z, turn))
    }
}

/// Returns a three-dimensional body of the given kind: ball (0), capsule (1, named "tube"), barrel (2), or block (3).
fn solid(kind: usize, name: &str, mass: f64, place: Vec3, turn: Vec3) -> Body<Spatial> {
    let inertia = Vec3::new(0.03, 0.045, 0.045) * mass;
    let hull = match kind {
        0 => None,
        1 => Some(Hull::Capsule(Capsule { half_length: 0.25, radius: 0.1 })),
        2 => match Barrel::new(0.7, 0.2, 0.25, 0.01) {
            Ok(barrel) => Some(Hull::Barrel(barrel)),
            Err(error) => panic!("{name}: {error}"),
        },
        _ => Some(Hull::Block(Block { half: Vec3::new(0.25, 0.2, 0.15), rounding: 0.01 })),
    };
    let mut body = match hull {
        Some(hull) => spatial::solid(name, hull, mass, inertia, place),
        None => Body { name: name.into(), ..spatial::ball(0.3, mass, place) },
    };
    body.pose.orientation = Quaternion::turn(turn);
    body
}

/// Names of the kinds of bodies: planar bodies first, then three-dimensional bodies.
const KINDS: [[&str; 4]; 2] =
    [["circle", "box", "round box", "barrel profile"], ["ball", "tube", "barrel", "block"]];

/// Returns scenes in which two spinning planar bodies collide off-center. Every pair of kinds has two scenes: one with
/// masses of 100 and 60 kg, and one with 100 kg each.
pub fn planar_pairs() -> Vec<Order<Planar>> {
    let pair = |i: usize| {
        let (a, b, mass) = (i / 4 % 4, i % 4, [60.0, 100.0][i / 16]);
        let mut bodies = vec![
            planar(a, "first", 100.0, -0.5, 0.0, 0.3),
            planar(b, "second", mass, 0.5, 0.1, -0.4),
        ];
        bodies[0].twist = Twist { linear: Vec2::new(1.0, 0.0), angular: 1.0 };
        bodies[1].twist = Twist { linear: Vec2::new(-1.5, 0.0), angular: 2.0 };
        let name = format!("{} and {} of {mass} kg", KINDS[0][a], KINDS[0][b]);
        Order { name, bodies, laws: laws(), gravity: Vec2::default() }
    };
    (0..32).map(pair).collect()
}

/// Returns scenes in which two spinning three-dimensional bodies collide off-center. Every pair of kinds has two
/// scenes: one with masses of 100 and 60 kg, and one with 100 kg each.
pub fn spatial_pairs() -> Vec<Order<Spatial>> {
    let pair = |i: usize| {
        let (a, b, mass) = (i / 4 % 4, i % 4, [60.0, 100.0][i / 16]);
        let turns = [Vec3::new(0.3, -0.2, 0.5), Vec3::new(-0.4, 0.6, 0.2)];
        let mut bodies = vec![
            solid(a, "first", 100.0, Vec3::new(-0.5, 0.0, 0.0), turns[0]),
            solid(b, "second", mass, Vec3::new(0.5, 0.06, 0.08), turns[1]),
        ];
        let linear = Vec3::new(1.0, 0.0, 0.0);
        bodies[0].twist = Twist { linear, angular: Vec3::new(1.0, 0.5, -0.5) };
        bodies[1].twist = Twist { linear: linear * -1.5, angular: Vec3::new(-0.5, 2.0, 1.0) };
        let name = format!("{} and {} of {mass} kg", KINDS[1][a], KINDS[1][b]);
        Order { name, bodies, laws: laws(), gravity: Vec3::default() }
    };
    (0..32).map(pair).collect()
}

/// Returns a scene in which four planar bodies tumble onto a floor and onto each other. Their kinds, masses, poses and
/// velocities depend on `seed`.
pub fn planar_heap(seed: usize) -> Order<Planar> {
    let mut random = Random(seed as u64);
    let mut bodies = vec![floor()];
    for i in 0..4_usize {
        let x = [-0.35, 0.35][i % 2] + random.within(-0.05, 0.05);
        let z = 0.45 + 0.7 * (i / 2) as f64;
        let (mass, turn) = (random.within(40.0, 120.0), random.within(-1.0, 1.0));
        let mut body = planar((i + seed) % 4, &format!("body {i}"), mass, x, z, turn);
        let linear = Vec2::new(random.within(-0.5, 0.5), random.within(-1.0, 0.0));
        body.twist = Twist { linear, angular: random.within(-2.0, 2.0) };
        bodies.push(body);
    }
    Order { name: format!("four on a floor, {seed}"), bodies, laws: laws(), gravity: DOWN }
}

/// Returns a scene in which two three-dimensional bodies tumble onto a floor and onto each other. Their kinds, masses,
/// poses and velocities depend on `seed`.
pub fn spatial_heap(seed: usize) -> Order<Spatial> {
    let mut random = Random(seed as u64);
    let mut bodies = vec![spatial::floor()];
    for (i, kind) in [seed / 4, seed].into_iter().enumerate() {
        let mut near = |size: f64| {
            let mut any = || random.within(-size, size);
            Vec3::new(any(), any(), any())
        };
        let place = Vec3::new(0.0, 0.0, 0.4 + 0.65 * i as f64) + near(0.03);
        let (turn, spin) = (near(0.5), near(1.0));
        let linear = near(0.3);
        let mass = random.within(40.0, 120.0);
        let mut body = solid(kind % 4, &format!("body {i}"), mass, place, turn);
        body.twist = Twist { linear, angular: spin };
        bodies.push(body);
    }
    let gravity = Vec3::new(0.0, 0.0, -GRAVITY);
    let name = format!("{} and {} on a floor", KINDS[1][seed / 4 % 4], KINDS[1][seed % 4]);
    Order { name, bodies, laws: laws(), gravity }
}
