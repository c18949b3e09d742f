//! Runs planar scenes in the game engines Rapier (in single and in double precision) and Box2D, for comparison with
//! this program.

use barrelstack_dynamics::{Model, Nodes, Planar, Shape, State, Vec2};

use crate::time;

use crate::Failure;

/// Time step (s) of a game that computes 240 steps per second. This is the longest step with which stacks stand in
/// Rapier.
pub(crate) const COARSE: f64 = 1.0 / 240.0;

/// Half the width (m) of the floor, which is so wide that fallen barrels stay on it.
const FLOOR: f32 = 100.0;

/// A scene: bodies that are at rest until the ground moves.
pub(crate) struct Stage<'a> {
    pub(crate) model: &'a Model<Planar>,
    pub(crate) rest: &'a State<Planar>,
    /// Displacement (m) of the ground at a time (s).
    pub(crate) ground: &'a dyn Fn(f64) -> Vec2,
    /// Friction coefficients on the ground and between bodies.
    pub(crate) friction: [f64; 2],
    /// Simulated time (s).
    pub(crate) duration: f64,
}

/// Cost of a game engine.
#[derive(Clone, Copy)]
pub(crate) struct Cost {
    pub(crate) engine: &'static str,
    /// Processor time (s) per simulated second.
    pub(crate) second: f64,
    /// Largest drop (m) of a body from its place at rest in this engine.
    pub(crate) dropped: f64,
}

/// Measures every engine with a time step (s) and otherwise with its default settings. Returns the costs in ascending
/// order.
pub(crate) fn costs(stage: &Stage<'_>, step: f64) -> Result<Vec<Cost>, Failure> {
    flat::shake(stage, step)?;
    let cost = |engine, run: &dyn Fn() -> f64| {
        let mut dropped = 0.0;
        let spent = time::least_of(3, || dropped = run());
        Cost { engine, second: spent / stage.duration, dropped }
    };
    let mut costs = vec![
        cost("Rapier 2-D", &|| single::shake(stage, step)),
        cost("Rapier 2-D, 64 bits", &|| double::shake(stage, step)),
        // The run before shows that it does not fail.
        cost("Box2D", &|| flat::shake(stage, step).unwrap_or(f64::NAN)),
    ];
    costs.sort_by(|a, b| a.second.total_cmp(&b.second));
    Ok(costs)
}

/// A collider: a ball by center and radius, or a convex polygon by its corners.
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

            use super::{FLOOR, Piece, Stage, Vec2, pieces};

            fn vector(v: Vec2) -> Vector {
                Vector::new(v.x as $real, v.z as $real)
            }

            /// Runs the scene; returns the largest drop (m) of a body.
            pub(super) fn shake(stage: &Stage<'_>, step: f64) -> f64 {
                let mut handles = Vec::new();
                let mut bodies = RigidBodySet::new();
                let mut colliders = ColliderSet::new();
                let friction = stage.friction.map(|friction| friction as $real);
                let floor = bodies.insert(RigidBodyBuilder::kinematic_position_based().build());
                let slab = ColliderBuilder::cuboid(FLOOR as $real, 0.5);
                let slab = slab.translation(Vector::new(0.0, -0.5)).friction(friction[0]);
                colliders.insert_with_parent(slab, floor, &mut bodies);
                let all = stage.model.bodies().iter().zip(&stage.rest.poses).enumerate();
                for (id, (body, pose)) in all.skip(1) {
                    let builder = RigidBodyBuilder::dynamic()
                        .can_sleep(false)
                        .translation(vector(pose.position))
                        .rotation(pose.orientation as $real)
                        .additional_mass_properties(MassProperties::new(
                            vector(Vec2::default()),
                            body.mass as $real,
                            body.inertia as $real,
                        ));
                    let handle = bodies.insert(builder.build());
                    handles.push((handle, pose.position.z));
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
                let steps = (stage.duration / step).round() as usize;
                for k in 1..=steps {
                    let moved = vector((stage.ground)(k as f64 * step));
                    if let Some(floor) = bodies.get_mut(floor) {
                        floor.set_next_kinematic_translation(moved);
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
                let drop = |(handle, before): &(RigidBodyHandle, f64)| {
                    before - bodies[*handle].translation().y as f64
                };
                handles.iter().map(drop).fold(0.0, f64::max)
            }
        }
    };
}

peer!(single, rapier2d, f32);
peer!(double, rapier2d_f64, f64);

/// Box2D, through its bindings.
mod flat {
    use std::f64::consts::TAU;

    use boxdd::{
        BodyBuilder, BodyType, Foundation, MassData, Position, ShapeDef, SurfaceMaterial,
        WorldBuilder, shapes,
    };

    use super::{FLOOR, Piece, Stage, Vec2, pieces};
    use crate::Failure;

    /// Number of substeps per step that Box2D recommends.
    const PARTS: i32 = 4;

    /// Largest number of corners of a polygon in Box2D.
    const CORNERS: usize = 8;

    fn vector(v: Vec2) -> boxdd::Vec2 {
        boxdd::Vec2::new(v.x as f32, v.z as f32)
    }

    /// Returns at most [`CORNERS`] corners of a convex polygon: those that reach furthest in evenly spaced
    /// directions.
    fn few(corners: Vec<Vec2>) -> Vec<Vec2> {
        if corners.len() <= CORNERS {
            return corners;
        }
        let furthest = |at: usize| {
            let (z, x) = (TAU * (at as f64 + 0.5) / CORNERS as f64).sin_cos();
            let reach = |corner: &Vec2| corner.x * x + corner.z * z;
            corners.iter().copied().max_by(|a, b| reach(a).total_cmp(&reach(b)))
        };
        let mut some: Vec<Vec2> = (0..CORNERS).filter_map(furthest).collect();
        some.dedup();
        some
    }

    fn position(v: Vec2) -> Position {
        Position::new(v.x as f32, v.z as f32)
    }

    /// Runs the scene; returns the largest drop (m) of a body.
    pub(super) fn shake(stage: &Stage<'_>, step: f64) -> Result<f64, Failure> {
        let foundation = Foundation::initialize_default()?;
        let world =
            WorldBuilder::from(foundation.world_def()).gravity(boxdd::Vec2::new(0.0, -9.81));
        let mut world = foundation.create_world(world.build()?)?;
        let body = || BodyBuilder::from(foundation.body_def()).enable_sleep(false);
        let surface = |friction: f64| {
            let material = SurfaceMaterial::default().with_friction(friction as f32)?;
            ShapeDef::builder().density(0.0).material(material).build()
        };
        let floor = world.create_body(body().body_type(BodyType::Kinematic).build()?)?;
        let slab = [(-FLOOR, -1.0), (FLOOR, -1.0), (FLOOR, 0.0), (-FLOOR, 0.0)];
        let slab = slab.map(|(x, z)| boxdd::Vec2::new(x, z));
        world.body(floor)?.create_polygon(
            &surface(stage.friction[0])?,
            &shapes::polygon_from_points(slab, 0.0)?,
        )?;
        let mut placed_at = Vec::new();
        let all = stage.model.bodies().iter().zip(&stage.rest.poses).enumerate();
        for (number, (matter, pose)) in all.skip(1) {
            let placed = body()
                .body_type(BodyType::Dynamic)
                .position(position(pose.position))
                .angle(pose.orientation as f32);
            let id = world.create_body(placed.build()?)?;
            for piece in pieces(stage.model, number) {
                let surface = surface(stage.friction[1])?;
                match piece {
                    Piece::Ball(center, radius) => {
                        let ball = shapes::circle(vector(center), radius as f32)?;
                        world.body(id)?.create_circle(&surface, &ball)?;
                    }
                    Piece::Hull(corners) => {
                        let corners = few(corners).into_iter().map(vector);
                        let hull = shapes::polygon_from_points(corners, 0.0)?;
                        world.body(id)?.create_polygon(&surface, &hull)?;
                    }
                }
            }
            let (mass, inertia) = (matter.mass as f32, matter.inertia as f32);
            let own = MassData::new(mass, boxdd::Vec2::new(0.0, 0.0), inertia)?;
            world.body(id)?.set_mass_data(own)?;
            placed_at.push((id, pose.position.z));
        }
        let mut before = (stage.ground)(0.0);
        let mut dropped = 0.0_f64;
        for k in 1..=(stage.duration / step).round() as usize {
            let now = (stage.ground)(k as f64 * step);
            world.body(floor)?.set_linear_velocity(vector((now - before) * (1.0 / step)))?;
            drop(world.step(step as f32, PARTS)?);
            before = now;
        }
        for (id, height) in placed_at {
            dropped = dropped.max(height - f64::from(world.body(id)?.position()?.y));
        }
        Ok(dropped)
    }
}
