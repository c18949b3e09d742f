//! Three-dimensional bodies on feet, and boxes: load distribution, tipping and rocking.

use std::ops::ControlFlow;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::math::{asin, cos, sin};
use barrelstack_dynamics::space::Linear;
use barrelstack_dynamics::{FrictionLaw, Lack, NormalLaw, Quaternion, Still, Vec3};

use super::{G, STIFFNESS, firm, rough, scene};
use crate::problem::{absolute, border, relative, setting};
use crate::scene::coulomb;
use crate::spatial::{corners, floor, free, points, yaw};
use crate::{Effort, Failure, Problem};

pub(super) fn problems() -> Vec<Problem> {
    let mut list: Vec<Problem> = four_feet().into_iter().chain(three_legs()).collect();
    for (degrees, exact) in
        [(0.0, 0.3), (30.0, 0.346_410_161_5), (70.0, 0.870_852_143_8), (90.0, 0.818_333_333_3)]
    {
        list.push(tips(degrees, exact));
    }
    list.extend(rocks());
    list
}

/// Returns the forces (N) on the feet of a plate of 981 N on equal springs; `feet` contains the positions (m) of the
/// feet relative to the center of mass.
fn loads(feet: &[Vec3]) -> Result<Vec<f64>, Failure> {
    let mut plate = free("plate", 100.0, Vec3::new(10.0, 10.0, 10.0), Vec3::default());
    plate.nodes = vec![points(feet)];
    let gravity = Vec3::new(0.0, 0.0, -G);
    let law = firm(STIFFNESS, 25.0);
    let scene =
        scene(vec![floor(), plate], law, FrictionLaw::Frictionless, gravity)?.settled(1e-10)?;
    let mut loads = vec![0.0; feet.len()];
    for contact in &scene.scratch.contacts {
        loads[contact.node as usize] = contact.normal_force;
    }
    Ok(loads)
}

fn four_feet() -> Vec<Problem> {
    let exact = [357.265_44, 224.067_89, 133.234_56, 266.432_11];
    let feet = || corners(0.7365, 0.27, 0.0).map(|foot| foot - Vec3::new(0.2, 0.05, 0.0));
    shared("plate of 981 N on four equal springs", "plate", exact.to_vec(), &feet())
}

fn three_legs() -> Vec<Problem> {
    let legs = [(0.6, 0.0), (-0.3, 0.4), (-0.3, -0.4)];
    let legs = legs.map(|(x, y)| Vec3::new(x - 0.05, y - 0.1, 0.0));
    shared("tripod under 981 N", "tripod", vec![381.5, 422.375, 177.125], &legs)
}

fn shared(title: &str, name: &str, exact: Vec<f64>, feet: &[Vec3]) -> Vec<Problem> {
    let of = |(foot, exact): (usize, f64)| {
        let feet = feet.to_vec();
        setting(
            format!("space-blocks/{name}-{}", foot + 1),
            title,
            "equilibrium of a rigid plate on springs",
        )
        .quantity("force on a foot", "N", relative(exact, 1e-6))
        .by(move |_| Ok(loads(&feet)?[foot]))
    };
    exact.into_iter().enumerate().map(of).collect()
}

/// Creates the problem of a box that is pushed obliquely and tips over the edge that needs the smallest push.
fn tips(degrees: f64, exact: f64) -> Problem {
    setting(
        format!("space-blocks/tips-{degrees}"),
        format!("box of half sides 0.27 and 0.7365 m, center 0.9 m high, pushed at {degrees}°"),
        "moments about the edges",
    )
    .quantity("smallest push that tips the box over", "g", relative(exact, 1e-3))
    .by(move |effort| {
        let halvings = if effort == Effort::Full { 8 } else { 5 };
        border((0.99 * exact, 1.01 * exact), halvings, |push| {
            let mass = 270.0;
            let inertia = Vec3::new(120.0, 80.0, 55.0);
            let mut body = free("box", mass, inertia, Vec3::new(0.0, 0.0, 0.9));
            body.nodes = vec![points(&corners(0.27, 0.7365, -0.9))];
            let angle = degrees.to_radians();
            let gravity = Vec3::new(push * cos(angle), push * sin(angle), -1.0) * G;
            let (law, grip) = (firm(STIFFNESS, mass), rough(5.0, STIFFNESS, mass));
            let mut scene = scene(vec![floor(), body], law, grip, gravity)?;
            match scene.settle(1e-6) {
                Ok(_) => Ok(false),
                Err(refused) if matches!(refused.lack, Lack::Balance { .. }) => Ok(true),
                Err(refused) => Err(refused.into()),
            }
        })
    })
}

/// The first impact of a box.
struct Impact {
    /// Time (s) of the impact.
    time: f64,
    /// Angular velocity (rad/s) before the impact.
    rate: f64,
    /// Ratio of the angular velocities after and before the impact, computed from the next peak rotation of the box.
    ratio: f64,
}

/// Computes the first impact of a box released at half its slenderness angle, with the scene rotated about the vertical
/// by an angle (rad).
fn first_impact(turned: f64) -> Result<Impact, Failure> {
    let (half_width, half_height, mass) = (0.27, 0.9, 270.0);
    let alpha = 0.291_456_794_5;
    let across = mass * (half_width * half_width + half_height * half_height) / 3.0;
    let inertia = Vec3::new(across + 50.0, across, 60.0);
    let mut body = free("box", mass, inertia, Vec3::default());
    // The box stands on the edge at +x and leans in that direction.
    let lean = Quaternion::turn(Vec3::new(0.0, 0.5 * alpha, 0.0));
    body.pose.orientation = yaw(turned).after(lean);
    let stiffness = 1e9;
    let edge = body.pose.orientation.matrix().apply(Vec3::new(half_width, 0.0, -half_height));
    body.pose.position = -edge - Vec3::new(0.0, 0.0, mass * G / (2.0 * stiffness));
    body.nodes = vec![points(&corners(half_width, 0.5, -half_height))];
    // Damped like the planar block that reproduces Housner's ratio.
    let damping = |ratio| restitution::damping(stiffness, ratio, 0.5 * mass);
    let law = NormalLaw::KelvinVoigt { stiffness, damping: damping(3.0) };
    let grip = coulomb(20.0, stiffness, damping(1.0));
    let mut scene = scene(vec![floor(), body], law, grip, Vec3::new(0.0, 0.0, -G))?;
    let toward = yaw(turned).matrix().apply(Vec3::new(1.0, 0.0, 0.0));
    let axis = Vec3::new(-toward.y, toward.x, 0.0);
    let (mut struck, mut peak, mut before) = (None, 0.0_f64, (0.0, 0.0, f64::INFINITY));
    scene.watch(&Still, 1e-5, 1.0, |state, _, _| {
        let turn = state.poses[1].orientation.matrix();
        let rate = state.twists[1].angular.dot(axis);
        let corner = turn.apply(Vec3::new(-half_width, 0.0, -half_height));
        let height = state.poses[1].position.z + corner.z;
        if height <= 0.0 && struck.is_none() {
            let part = before.2 / (before.2 - height);
            struck = Some((before.0 + part * (state.time - before.0), before.1));
        }
        if struck.is_some() {
            // Sine of the rotation to the other side.
            peak = peak.max(-turn.apply(Vec3::new(0.0, 0.0, 1.0)).dot(toward));
        }
        before = (state.time, rate, height);
        ControlFlow::Continue(())
    })?;
    let (time, rate) = struck.ok_or_else(|| Failure::Absent("the box does not strike".into()))?;
    // Half the square of the angular velocity in the upright position, divided by p².
    let energy = |lean: f64| cos(alpha - lean) - cos(alpha);
    let ratio = (energy(asin(peak)) / energy(0.5 * alpha)).sqrt();
    Ok(Impact { time, rate, ratio })
}

fn rocks() -> Vec<Problem> {
    let mut list = vec![];
    for degrees in [0.0, 30.0, 90.0] {
        let angle = f64::to_radians(degrees);
        let title = format!(
            "box of 0.54 × 1.8 m that rocks, with the scene rotated by {degrees}° about the \
             vertical"
        );
        let mut problem = |name: &str, source, (quantity, unit, exact), of: fn(Impact) -> f64| {
            list.push(
                setting(format!("space-blocks/rocks-{degrees}-{name}"), title.clone(), source)
                    .quantity(quantity, unit, relative(exact, 1e-3))
                    .by(move |_| Ok(of(first_impact(angle)?))),
            );
        };
        let source = "Housner 1963, exact equation";
        let time = ("time of the first impact", "s", 0.471_810_597_6);
        problem("time", source, time, |impact| impact.time);
        let rate = ("angular velocity before the first impact", "rad/s", -0.703_182_112_6);
        problem("rate", source, rate, |impact| impact.rate);
        let ratio = (
            "angular velocity after the first impact, divided by that before",
            "",
            0.876_146_789_0,
        );
        problem("impact", "Housner 1963, eq. 8", ratio, |impact| impact.ratio);
        if degrees > 0.0 {
            list.push(
                setting(format!("space-blocks/rocks-{degrees}-turned"), title, "isotropy of space")
                    .quantity(
                        "relative change of the next peak rotation and of the angular velocity \
                         when the scene is rotated",
                        "",
                        absolute(0.0, 1e-9),
                    )
                    .by(move |_| {
                        let (turned, straight) = (first_impact(angle)?, first_impact(0.0)?);
                        let rate = (turned.rate / straight.rate - 1.0).abs();
                        let ratio = (turned.ratio / straight.ratio - 1.0).abs();
                        Ok(rate.max(ratio))
                    }),
            );
        }
    }
    list
}
