//! Three-dimensional bodies: free rotation, rolling, sliding, bodies on feet, and barrels.

mod barrels;
mod blocks;
mod flat;
mod free;
mod rolling;
mod sliding;

use std::f64::consts::FRAC_PI_2;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::{Body, FrictionLaw, NormalLaw, Quaternion, Spatial, Vec3};

use crate::scene::{Scene, coulomb, interface};
use crate::{Failure, Problem};

/// Acceleration of gravity (m/s²) in these problems.
const G: f64 = 9.81;

/// Time step (s).
const STEP: f64 = 2e-5;

/// Stiffness (N/m) of a contact, normal and tangential.
const STIFFNESS: f64 = 1e8;

/// The role of a body in a contact pair.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Contactor,
    Target,
}

/// Returns the problems of all modules about three-dimensional bodies.
pub(super) fn problems() -> Vec<Problem> {
    let theories = [
        free::problems(),
        rolling::problems(),
        sliding::problems(),
        blocks::problems(),
        barrels::problems(),
        flat::problems(),
    ];
    theories.into_iter().flatten().collect()
}

/// Returns a normal contact law with a stiffness (N/m), and with enough damping for a mass (kg) to come to rest on the
/// contact.
fn firm(stiffness: f64, mass: f64) -> NormalLaw {
    NormalLaw::KelvinVoigt { stiffness, damping: restitution::damping(stiffness, 0.7, mass) }
}

/// Returns a Coulomb friction law with a coefficient. Its tangential (sticking) spring has a stiffness (N/m), and its
/// tangential damper has half the critical damping for a mass (kg).
fn rough(coefficient: f64, stiffness: f64, mass: f64) -> FrictionLaw {
    coulomb(coefficient, stiffness, restitution::damping(stiffness, 0.5, mass))
}

/// Creates a scene in which one interface applies to all contacts.
fn scene(
    bodies: Vec<Body<Spatial>>,
    normal: NormalLaw,
    friction: FrictionLaw,
    gravity: Vec3,
) -> Result<Scene<Spatial>, Failure> {
    Ok(Scene::new(bodies, interface(normal, friction), gravity)?)
}

/// Returns the acceleration of gravity (m/s²), which points straight down.
fn down() -> Vec3 {
    Vec3::new(0.0, 0.0, -G)
}

/// Returns the orientation of a body whose axis `x` points up, inclined by an angle (rad) toward the global `x`.
fn upright(lean: f64) -> Quaternion {
    Quaternion::turn(Vec3::new(0.0, lean - FRAC_PI_2, 0.0))
}

/// Returns the direction of the axis `x` of a body.
fn axis(orientation: Quaternion) -> Vec3 {
    orientation.matrix().apply(Vec3::new(1.0, 0.0, 0.0))
}
