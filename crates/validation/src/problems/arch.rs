//! The thinnest semicircular arch that stands under its own weight.

use std::f64::consts::PI;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::math::{cos, sin};
use barrelstack_dynamics::shape::Polygon;
use barrelstack_dynamics::{
    Body, ContactPair, Model, Motion, NormalLaw, Placed, Planar, Shape, Twist, Vec2, settle,
};

use crate::problem::border;
use crate::scene::{DOWN, Scene, centered, coulomb, ground_of, interface, points, pose};
use crate::{Effort, Failure, Outcome, Problem, Tolerance};

/// Radius (m) of the middle line.
const RADIUS: f64 = 5.0;

/// Stiffness (N/m) of a node; the voussoirs weigh some tons, so that hinges open by less than 1e-4 R.
const STIFFNESS: f64 = 1e10;

/// How far (as a share of the thickness) hinges lie within the ring, so that no corner meets a corner.
const INSET: f64 = 2e-3;

/// Voussoirs. With an even number a joint lies at the crown, where the line of thrust wants its hinge;
/// with many the joints lie near the other hinges too, 54.5° from the crown.
const COUNT: usize = 26;

/// The problems of this theory.
pub(super) fn problems() -> Vec<Problem> {
    vec![Problem {
        id: "arch/thinnest".into(),
        title: format!(
            "semicircular arch of {COUNT} voussoirs that cannot slide, under its weight"
        ),
        source: "Milankovitch 1907; validation.md 4.9".into(),
        quantity: "least thickness over radius",
        unit: "",
        exact: 0.1075,
        // A continuous ring may hinge anywhere, an arch of voussoirs at its joints, so it stands thinner.
        tolerance: Tolerance::Relative(2e-2),
        fast: Some(Tolerance::Relative(4e-2)),
        run: Box::new(|effort| {
            let halvings = if effort == Effort::Full { 5 } else { 1 };
            let found =
                border((0.1075 * 0.94, 0.1075 * 1.06), halvings, |ratio| stands(ratio * RADIUS))?;
            // Hinges lie within the ring.
            let ring = found * (1.0 - 2.0 * INSET);
            Ok(Outcome::of(ring)
                .noted(format!("hinges lie {INSET} of the thickness within the ring")))
        }),
    }]
}

/// Whether an arch of a thickness (m) comes to rest without falling in.
fn stands(thickness: f64) -> Result<bool, Failure> {
    // The springings, their upper faces at z = 0.
    let springing = |side: f64| -> Result<Placed<Planar>, Failure> {
        let (half, low) = (0.2 * RADIUS, -0.2 * RADIUS);
        let corners =
            [(-half, low), (half, low), (half, 0.0), (-half, 0.0)].map(|(x, z)| Vec2::new(x, z));
        let place = Vec2::new(side * RADIUS, 0.0);
        Ok(Placed { offset: place, ..centered(polygon(&corners)?) })
    };
    let mut bodies = vec![ground_of(vec![springing(1.0)?, springing(-1.0)?])];
    for at in 0..COUNT {
        bodies.push(voussoir(at, thickness)?);
    }
    // The first voussoir stands on its lower nodes; every joint after it is carried by the nodes of the
    // voussoir before it.
    let pair = |contactor, nodes, target, surface| ContactPair {
        contactor,
        nodes,
        target,
        surface,
        interface: 0,
    };
    let mut pairs = vec![pair(1, 0, 0, 0), pair(COUNT, 1, 0, 1)];
    pairs.extend((1..COUNT).map(|at| pair(at, 1, at + 1, 0)));
    let damping = restitution::damping(STIFFNESS, 0.5, 1000.0);
    let normal = NormalLaw::SpeedGap { stiffness: STIFFNESS, damping };
    let laws = interface(normal, coulomb(5.0, STIFFNESS, damping));
    let mut scene = Scene::of(Model::new(bodies, vec![laws], pairs, DOWN)?);
    Ok(settle(&scene.model, &mut scene.state, &mut scene.scratch, 1e-4, 1e-6).is_ok())
}

fn polygon(corners: &[Vec2]) -> Result<Shape, Failure> {
    let polygon = Polygon::new(corners, 0.0);
    polygon.map(Shape::Polygon).map_err(|problem| Failure::Absent(problem.to_string()))
}

/// Voussoir number `at` from the right springing, with its nodes on the joint before it and on that
/// after it.
fn voussoir(at: usize, thickness: f64) -> Result<Body<Planar>, Failure> {
    let angle = |joint: usize| PI * joint as f64 / COUNT as f64;
    let (from, to) = (angle(at), angle(at + 1));
    let on = |radius: f64, angle: f64| Vec2::new(radius * cos(angle), radius * sin(angle));
    let (inner, outer) = (RADIUS - 0.5 * thickness, RADIUS + 0.5 * thickness);
    let corners = [on(inner, from), on(outer, from), on(outer, to), on(inner, to)];
    let (area, center, inertia) = measures(&corners);
    let mass = 2000.0 * area;
    let local = corners.map(|corner| corner - center);
    let joint = |angle: f64| {
        let inset = INSET * thickness;
        points(&[on(inner + inset, angle) - center, on(outer - inset, angle) - center])
    };
    Ok(Body {
        name: format!("voussoir {at}"),
        motion: Motion::Free,
        mass,
        inertia: 2000.0 * inertia,
        damping: None,
        pose: pose(center.x, center.z, 0.0),
        twist: Twist::default(),
        surfaces: vec![centered(polygon(&local)?)],
        nodes: vec![joint(from), joint(to)],
    })
}

/// Area (m²), center (m) and second moment of area about it (m⁴) of a polygon, by triangles from the
/// origin.
fn measures(corners: &[Vec2]) -> (f64, Vec2, f64) {
    let (mut area, mut first, mut second) = (0.0, Vec2::default(), 0.0);
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let cross = a.x * b.z - a.z * b.x;
        area += 0.5 * cross;
        first += (*a + b) * (cross / 6.0);
        second += cross / 12.0 * (a.dot(*a) + a.dot(b) + b.dot(b));
    }
    let center = first * (1.0 / area);
    (area, center, second - area * center.dot(center))
}
