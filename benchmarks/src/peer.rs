//! The same scene in Rapier, double precision, at the step of a game.

use std::f64::consts::TAU;

use rapier2d_f64::prelude::*;

use crate::scene::{AMPLITUDE, PERIOD, Scene};
use crate::{Failure, time};

/// Steps (s): that of a game at 240 Hz, and one near contact accuracy.
const STEPS: [f64; 2] = [1.0 / 240.0, 1e-3];

/// Simulated time (s).
const END: f64 = 1.2;

/// Prints the peer's cost a simulated second beside that of the lanes (s).
pub(crate) fn compare(scene: &Scene, lanes: f64) -> Result<(), Failure> {
    println!("peer: the same eight barrels in Rapier (f64), one core");
    println!("  step       ms a simulated second   lanes take");
    for step in STEPS {
        let spent = time::least(|| shake(scene, step)) / END;
        println!(
            "  {:6.3} ms {:20.3} {:10.3} ms, {:.2} of it",
            1e3 * step,
            1e3 * spent,
            1e3 * lanes,
            lanes / spent
        );
    }
    Ok(())
}

fn shake(scene: &Scene, step: f64) {
    let mut bodies = RigidBodySet::new();
    let mut colliders = ColliderSet::new();
    let rough = |collider: ColliderBuilder, mass: f64| collider.mass(mass).friction(0.22);
    let floor = bodies.insert(RigidBodyBuilder::kinematic_position_based().build());
    let slab = ColliderBuilder::cuboid(10.0, 0.5).translation(Vector::new(0.0, -0.5)).friction(0.5);
    colliders.insert_with_parent(slab, floor, &mut bodies);
    for (body, pose) in scene.model.bodies().iter().zip(&scene.rest.poses).skip(1) {
        let place = Vector::new(pose.position.x, pose.position.z);
        let handle = bodies.insert(RigidBodyBuilder::dynamic().translation(place).build());
        if body.name.starts_with('R') {
            let beam = rough(ColliderBuilder::cuboid(0.75, 0.02), body.mass);
            colliders.insert_with_parent(beam, handle, &mut bodies);
            let barrelstack_dynamics::Nodes::Fixed(supports) = &body.nodes[0] else { continue };
            for support in supports {
                let at = Vector::new(support.position.x, support.position.z);
                let point = rough(ColliderBuilder::ball(0.005), 0.0).translation(at);
                colliders.insert_with_parent(point, handle, &mut bodies);
            }
        } else {
            let barrel = rough(ColliderBuilder::ball(0.35), body.mass);
            colliders.insert_with_parent(barrel, handle, &mut bodies);
        }
    }
    let gravity = Vector::new(0.0, -9.81);
    let parameters = IntegrationParameters { dt: step, ..IntegrationParameters::default() };
    let (mut pipeline, mut islands) = (PhysicsPipeline::new(), IslandManager::new());
    let (mut broad, mut narrow) = (BroadPhaseBvh::new(), NarrowPhase::new());
    let (mut joints, mut multibodies) = (ImpulseJointSet::new(), MultibodyJointSet::new());
    let (mut soft, mut ccd) = (SoftBodySet::new(), CCDSolver::new());
    let steps = (END / step).round() as usize;
    for k in 1..=steps {
        let x = AMPLITUDE * (TAU / PERIOD * k as f64 * step).sin();
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
