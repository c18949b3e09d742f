//! Bodies of three-dimensional test scenes: floors, balls, capsules, blocks, barrels and contact points.

use barrelstack_dynamics::solid::{Ball, Hull, Rounded};
use barrelstack_dynamics::{
    Body, Motion, Node, Nodes, Placed, Pose, Quaternion, Rotation3, Solid, Spatial, Vec3, math,
};

/// Returns gravity (m/s²) in the frame of a slope that descends at an angle (rad) in the direction `heading` (rad, from
/// `x` toward `y`).
pub fn gravity_on_slope(gravity: f64, angle: f64, heading: f64) -> Vec3 {
    let along = gravity * math::sin(angle);
    Vec3::new(along * math::cos(heading), along * math::sin(heading), -gravity * math::cos(angle))
}

/// Returns a rotation by an angle (rad) about the vertical axis.
pub fn yaw(angle: f64) -> Quaternion {
    Quaternion::turn(Vec3::new(0.0, 0.0, angle))
}

/// Places a solid at the center of mass of its body.
pub fn centered(surface: Solid) -> Placed<Spatial> {
    Placed { surface, offset: Vec3::default(), rotation: Rotation3::identity() }
}

/// Returns a free body without surfaces or nodes, from its mass (kg) and principal moments of inertia (kg·m²).
pub fn free(name: &str, mass: f64, inertia: Vec3, position: Vec3) -> Body<Spatial> {
    Body::free(name, mass, inertia, Pose { position, orientation: Quaternion::identity() })
}

/// Returns a ground body with the given surfaces.
pub fn ground_of(surfaces: Vec<Placed<Spatial>>) -> Body<Spatial> {
    // Its motion is prescribed, so its mass is irrelevant.
    let body = free("ground", 1.0, Vec3::new(1.0, 1.0, 1.0), Vec3::default());
    Body { motion: Motion::Prescribed, surfaces, ..body }
}

/// Returns a level floor at `z = 0`.
pub fn floor() -> Body<Spatial> {
    ground_of(vec![centered(Solid::HalfSpace)])
}

/// Returns a free, homogeneous ball of the given radius (m), mass (kg) and center (m).
pub fn ball(radius: f64, mass: f64, center: Vec3) -> Body<Spatial> {
    let inertia = 0.4 * mass * radius * radius;
    Body {
        surfaces: vec![centered(Solid::Ball(Ball { radius }))],
        nodes: vec![Nodes::Rolling { center: Vec3::default(), radius, tributary_length: 1.0 }],
        ..free("ball", mass, Vec3::new(inertia, inertia, inertia), center)
    }
}

/// Returns a node set with one node at each of the given points (m), such as feet or corners of a body.
pub fn points(points: &[Vec3]) -> Nodes<Spatial> {
    Nodes::Fixed(
        points
            .iter()
            .map(|p| Node { position: *p, tributary_length: 1.0, outward: None })
            .collect(),
    )
}

/// Returns the corners (m) of a horizontal rectangle at height `z`, centered on the vertical axis. Its sides have the
/// lengths `2x` and `2y`.
pub fn corners(x: f64, y: f64, z: f64) -> [Vec3; 4] {
    [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(a, b)| Vec3::new(a * x, b * y, z))
}

/// Returns a free capsule, block or barrel that is both contactor and target, with its center of mass in the middle.
pub fn solid(name: &str, hull: Hull, mass: f64, inertia: Vec3, position: Vec3) -> Body<Spatial> {
    Body {
        surfaces: vec![centered(hull.surface())],
        nodes: vec![Nodes::Whole(Rounded::centered(hull))],
        ..free(name, mass, inertia, position)
    }
}
