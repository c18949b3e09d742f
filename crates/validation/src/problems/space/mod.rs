//! Bodies in space: turning freely, rolling, sliding, standing on feet, and barrels.

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

/// Acceleration of free fall (m/s²) of these problems.
const G: f64 = 9.81;

/// Time step (s).
const STEP: f64 = 2e-5;

/// Stiffness (N/m) of a contact, along the normal and of the stick.
const STIFFNESS: f64 = 1e8;

/// Which part of a pair a body is: sticks live on the target.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Contactor,
    Target,
}

/// The problems of these theories.
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

/// A normal law of a stiffness (N/m), for a mass (kg) that comes to rest on it.
fn firm(stiffness: f64, mass: f64) -> NormalLaw {
    NormalLaw::KelvinVoigt { stiffness, damping: restitution::damping(stiffness, 0.7, mass) }
}

/// Friction of a coefficient, whose sticks have a stiffness (N/m) and damp a mass (kg).
fn rough(coefficient: f64, stiffness: f64, mass: f64) -> FrictionLaw {
    coulomb(coefficient, stiffness, restitution::damping(stiffness, 0.5, mass))
}

/// Bodies with one interface.
fn scene(
    bodies: Vec<Body<Spatial>>,
    normal: NormalLaw,
    friction: FrictionLaw,
    gravity: Vec3,
) -> Result<Scene<Spatial>, Failure> {
    Ok(Scene::new(bodies, interface(normal, friction), gravity)?)
}

/// Free fall straight down.
fn down() -> Vec3 {
    Vec3::new(0.0, 0.0, -G)
}

/// The orientation of a body whose axis `x` points up, but for a lean (rad) toward the outer `x`.
fn upright(lean: f64) -> Quaternion {
    Quaternion::turn(Vec3::new(0.0, lean - FRAC_PI_2, 0.0))
}

/// Where the axis `x` of a body points.
fn axis(orientation: Quaternion) -> Vec3 {
    orientation.matrix().apply(Vec3::new(1.0, 0.0, 0.0))
}
