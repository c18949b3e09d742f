//! Simulates a three-dimensional scene of this program in the game engine Rapier, for comparison.

use barrelstack_dynamics::{
    Model, Nodes, Placed, Quaternion, Rotation3, Solid, Spatial, State, Vec3,
};
use barrelstack_space::{Ground, mesh};
use rapier3d::prelude::*;

use crate::time;

/// Time step (s) at which the result of Rapier has converged for this scene.
pub(crate) const SETTLED: f64 = 0.5e-3;

/// Radius (m) of the ball that represents a node.
const NODE: f64 = 0.005;

/// A stack at rest on moving ground.
pub(crate) struct Stage<'a> {
    pub(crate) model: &'a Model<Spatial>,
    pub(crate) rest: &'a State<Spatial>,
    pub(crate) ground: &'a Ground,
    /// Friction coefficients on the ground and between bodies.
    pub(crate) friction: [f64; 2],
    /// Simulated time (s).
    pub(crate) duration: f64,
}

/// Cost of a run, and its largest drop.
pub(crate) struct Found {
    /// Processor time (s) per simulated second.
    pub(crate) second: f64,
    /// Largest drop (m) of a body from its place at rest in this engine.
    pub(crate) dropped: f64,
}

/// Runs the scene in Rapier with the given time step (s) and otherwise default settings, and measures the cost of the
/// run and the largest drop.
pub(crate) fn cost(stage: &Stage<'_>, step: f64) -> Found {
    let mut dropped = 0.0;
    let spent = time::least_of(3, || dropped = shake(stage, step));
    Found { second: spent / stage.duration, dropped }
}

fn vector(v: Vec3) -> Vector {
    Vector::new(v.x as f32, v.y as f32, v.z as f32)
}

fn turned(q: &Quaternion) -> Rotation {
    Rotation::from_xyzw(q.v.x as f32, q.v.y as f32, q.v.z as f32, q.w as f32)
}

fn turned_by(rotation: &Rotation3) -> Rotation {
    let column = |x, y, z| vector(rotation.apply(Vec3::new(x, y, z)));
    let columns = [column(1.0, 0.0, 0.0), column(0.0, 1.0, 0.0), column(0.0, 0.0, 1.0)];
    Rotation::from_mat3(&Matrix::from_cols(columns[0], columns[1], columns[2]))
}

/// Returns the colliders of a body.
fn colliders(model: &Model<Spatial>, body: usize) -> Vec<ColliderBuilder> {
    let body = &model.bodies()[body];
    if body.surfaces.iter().any(|placed| matches!(placed.surface, Solid::Barrel(_))) {
        let points: Vec<Vector> = mesh::points(body).into_iter().map(vector).collect();
        return ColliderBuilder::convex_hull(&points).into_iter().collect();
    }
    let piece = |placed: &Placed<Spatial>| {
        let piece = match &placed.surface {
            Solid::Ball(ball) => ColliderBuilder::ball(ball.radius as f32),
            Solid::Capsule(tube) => {
                ColliderBuilder::capsule_x(tube.half_length as f32, tube.radius as f32)
            }
            Solid::Block(block) => {
                let out = block.rounding;
                let half = vector(block.half + Vec3::new(out, out, out));
                ColliderBuilder::cuboid(half.x, half.y, half.z)
            }
            Solid::HalfSpace | Solid::Dish(_) | Solid::Barrel(_) => return None,
        };
        let at = Pose::from_parts(vector(placed.offset), turned_by(&placed.rotation));
        Some(piece.position(at))
    };
    let mut pieces: Vec<ColliderBuilder> = body.surfaces.iter().filter_map(piece).collect();
    for nodes in &body.nodes {
        if let Nodes::Fixed(nodes) = nodes {
            let ball = |at: Vec3| ColliderBuilder::ball(NODE as f32).translation(vector(at));
            pieces.extend(nodes.iter().map(|node| ball(node.position)));
        }
    }
    pieces
}

/// Runs the scene in the frame of the ground; returns the largest drop (m) of a body.
fn shake(stage: &Stage<'_>, step: f64) -> f64 {
    let mut bodies = RigidBodySet::new();
    let mut all = ColliderSet::new();
    let friction = stage.friction.map(|friction| friction as f32);
    let floor = bodies.insert(RigidBodyBuilder::fixed().build());
    let slab = ColliderBuilder::cuboid(10.0, 10.0, 0.5).translation(Vector::new(0.0, 0.0, -0.5));
    all.insert_with_parent(slab.friction(friction[0]), floor, &mut bodies);
    let mut handles = Vec::new();
    let poses = stage.model.bodies().iter().zip(&stage.rest.poses).enumerate();
    for (id, (body, pose)) in poses.skip(1) {
        let at = Pose::from_parts(vector(pose.position), turned(&pose.orientation));
        let matter = MassProperties::new(Vector::ZERO, body.mass as f32, vector(body.inertia));
        let body = RigidBodyBuilder::dynamic().can_sleep(false).pose(at);
        let handle = bodies.insert(body.additional_mass_properties(matter).build());
        for collider in colliders(stage.model, id) {
            let collider = collider.density(0.0).friction(friction[1]);
            all.insert_with_parent(collider, handle, &mut bodies);
        }
        handles.push((handle, pose.position.z));
    }
    let parameters = IntegrationParameters { dt: step as f32, ..IntegrationParameters::default() };
    let (mut pipeline, mut islands) = (PhysicsPipeline::new(), IslandManager::new());
    let (mut broad, mut narrow) = (BroadPhaseBvh::new(), NarrowPhase::new());
    let (mut joints, mut multibodies) = (ImpulseJointSet::new(), MultibodyJointSet::new());
    let (mut soft, mut ccd) = (SoftBodySet::new(), CCDSolver::new());
    for k in 0..(stage.duration / step).round() as usize {
        let shaken = vector(stage.ground.acceleration((k as f64 + 0.5) * step));
        pipeline.step(
            Vector::new(0.0, 0.0, -9.81) - shaken,
            &parameters,
            &mut islands,
            &mut broad,
            &mut narrow,
            &mut bodies,
            &mut all,
            &mut joints,
            &mut multibodies,
            &mut soft,
            &mut ccd,
            &(),
            &(),
        );
    }
    let drop = |(handle, before): &(RigidBodyHandle, f64)| {
        before - f64::from(bodies[*handle].translation().z)
    };
    handles.iter().map(drop).fold(0.0, f64::max)
}
