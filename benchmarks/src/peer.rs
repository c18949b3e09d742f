//! The same scenes in the game engine Rapier, in single and in double precision.

use barrelstack_dynamics::{Model, Nodes, Planar, Shape, State, Vec2};

use crate::time;

/// Time step (s) of a game at 240 Hz, which is the longest step with which stacks stand in Rapier.
pub(crate) const COARSE: f64 = 1.0 / 240.0;

/// Simulated time (s).
const END: f64 = 1.2;

/// A scene for Rapier: bodies at rest on moving ground.
pub(crate) struct Stage<'a> {
    pub(crate) model: &'a Model<Planar>,
    pub(crate) rest: &'a State<Planar>,
    /// Displacement (m) of the ground along `x` at a time (s).
    pub(crate) ground: &'a dyn Fn(f64) -> f64,
    /// Friction coefficients on the ground and between bodies.
    pub(crate) friction: [f64; 2],
}

/// Returns the processor time (s) of Rapier per simulated second, in single and in double
/// precision.
pub(crate) fn costs(stage: &Stage<'_>, step: f64) -> [f64; 2] {
    [
        time::least(|| single::shake(stage, step)) / END,
        time::least(|| double::shake(stage, step)) / END,
    ]
}

/// A collider of Rapier: a ball by center and radius, or a convex polygon by its corners.
enum Piece {
    Ball(Vec2, f64),
    Hull(Vec<Vec2>),
}

/// Radius (m) of the ball that represents a node.
const NODE: f64 = 0.005;

fn pieces(model: &Model<Planar>, body: usize) -> Vec<Piece> {
    let body = &model.bodies()[body];
    let of_surface = |placed: &barrelstack_dynamics::Placed<Planar>| match &placed.surface {
        Shape::Circle(circle) => Piece::Ball(placed.offset, circle.radius),
        shape @ (Shape::HalfPlane(_)
        | Shape::Polygon(_)
        | Shape::Cradle(_)
        | Shape::BarrelProfile(_)) => {
            let at = |point: Vec2| placed.offset + placed.rotation.apply(point);
            Piece::Hull(shape.outline().0.into_iter().map(at).collect())
        }
    };
    let mut pieces: Vec<Piece> = body.surfaces.iter().map(of_surface).collect();
    // A body without other solid parts rests on its first set of nodes.
    if let (1, Some(Nodes::Fixed(nodes))) = (body.surfaces.len(), body.nodes.first()) {
        pieces.extend(nodes.iter().map(|node| Piece::Ball(node.position, NODE)));
    }
    pieces
}

macro_rules! peer {
    ($module:ident, $rapier:ident, $real:ty) => {
        mod $module {
            use $rapier::prelude::*;

            use super::{END, Piece, Stage, Vec2, pieces};

            fn vector(v: Vec2) -> Vector {
                Vector::new(v.x as $real, v.z as $real)
            }

            pub(super) fn shake(stage: &Stage<'_>, step: f64) {
                let mut bodies = RigidBodySet::new();
                let mut colliders = ColliderSet::new();
                let friction = stage.friction.map(|friction| friction as $real);
                let floor = bodies.insert(RigidBodyBuilder::kinematic_position_based().build());
                let slab = ColliderBuilder::cuboid(10.0, 0.5);
                let slab = slab.translation(Vector::new(0.0, -0.5)).friction(friction[0]);
                colliders.insert_with_parent(slab, floor, &mut bodies);
                let all = stage.model.bodies().iter().zip(&stage.rest.poses).enumerate();
                for (id, (body, pose)) in all.skip(1) {
                    let builder = RigidBodyBuilder::dynamic()
                        .translation(vector(pose.position))
                        .rotation(pose.orientation as $real)
                        .additional_mass_properties(MassProperties::new(
                            vector(Vec2::default()),
                            body.mass as $real,
                            body.inertia as $real,
                        ));
                    let handle = bodies.insert(builder.build());
                    for piece in pieces(stage.model, id) {
                        let collider = match piece {
                            Piece::Ball(center, radius) => {
                                ColliderBuilder::ball(radius as $real).translation(vector(center))
                            }
                            Piece::Hull(corners) => {
                                let corners: Vec<_> = corners.into_iter().map(vector).collect();
                                let Some(hull) = ColliderBuilder::convex_hull(&corners) else {
                                    continue;
                                };
                                hull
                            }
                        };
                        let collider = collider.density(0.0).friction(friction[1]);
                        colliders.insert_with_parent(collider, handle, &mut bodies);
                    }
                }
                let gravity = Vector::new(0.0, -9.81);
                let parameters =
                    IntegrationParameters { dt: step as $real, ..IntegrationParameters::default() };
                let (mut pipeline, mut islands) = (PhysicsPipeline::new(), IslandManager::new());
                let (mut broad, mut narrow) = (BroadPhaseBvh::new(), NarrowPhase::new());
                let (mut joints, mut multibodies) =
                    (ImpulseJointSet::new(), MultibodyJointSet::new());
                let (mut soft, mut ccd) = (SoftBodySet::new(), CCDSolver::new());
                let steps = (END / step).round() as usize;
                for k in 1..=steps {
                    let x = (stage.ground)(k as f64 * step) as $real;
                    if let Some(floor) = bodies.get_mut(floor) {
                        floor.set_next_kinematic_translation(Vector::new(x, 0.0));
                    }
                    pipeline.step(
                        gravity,
                        &parameters,
                        &mut islands,
                        &mut broad,
                        &mut narrow,
                        &mut bodies,
                        &mut colliders,
                        &mut joints,
                        &mut multibodies,
                        &mut soft,
                        &mut ccd,
                        &(),
                        &(),
                    );
                }
            }
        }
    };
}

peer!(single, rapier2d, f32);
peer!(double, rapier2d_f64, f64);
