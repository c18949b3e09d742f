//! Where stresses are told along a boundary, before anything presses.

use std::f64::consts::{PI, TAU};

use barrelstack_dynamics::{BodyId, Nodes, Planar, Shape, Vec2, math};

use super::{BoundaryPoint, CELLS, Cells, StressEnvelope};

fn empty(body: BodyId, points: Vec<BoundaryPoint>, closed: bool, cells: Cells) -> StressEnvelope {
    let count = points.len();
    let length = match cells {
        Cells::Around(radius) => TAU * radius / count as f64,
        Cells::Along(half_length) => 4.0 * half_length / count as f64,
        Cells::Nodes => 0.0,
    };
    StressEnvelope {
        body,
        points,
        lengths: vec![length; count],
        closed,
        at_rest: vec![0.0; count],
        peak: vec![0.0; count],
        cells,
    }
}

/// Cells along a surface that nodes of other bodies press on.
pub(super) fn on_surface(body: BodyId, shape: &Shape) -> Option<StressEnvelope> {
    match shape {
        Shape::Circle(circle) => {
            let points = (0..CELLS)
                .map(|i| {
                    let angle = TAU * (i as f64 + 0.5) / CELLS as f64;
                    let (sin, cos) = math::sin_cos(angle);
                    let normal = Vec2::new(cos, sin);
                    BoundaryPoint {
                        position: normal * circle.radius,
                        normal,
                        coordinate: if angle > PI { angle - TAU } else { angle },
                    }
                })
                .collect();
            Some(empty(body, points, true, Cells::Around(circle.radius)))
        }
        Shape::BarrelProfile(profile) => {
            let half = profile.half_length;
            let cells = CELLS / 2;
            let mut points = Vec::new();
            for side in [1.0, -1.0] {
                for i in 0..cells {
                    let x = half * (2.0 * (i as f64 + 0.5) / cells as f64 - 1.0);
                    let z = profile.radius_at(x);
                    let up = z - profile.bilge_radius + profile.stave_radius;
                    let normal = Vec2::new(x, side * up) * (1.0 / profile.stave_radius);
                    points.push(BoundaryPoint {
                        position: Vec2::new(x, side * z),
                        normal,
                        coordinate: x,
                    });
                }
            }
            Some(empty(body, points, false, Cells::Along(half)))
        }
        Shape::HalfPlane(_) | Shape::Polygon(_) | Shape::Cradle(_) => None,
    }
}

/// One place for every node of a rack.
pub(super) fn on_nodes(body: BodyId, sets: &[Nodes<Planar>]) -> StressEnvelope {
    let nodes = || {
        sets.iter().filter_map(|set| match set {
            Nodes::Fixed(nodes) => Some(nodes),
            Nodes::Rounds(_) | Nodes::Rolling { .. } | Nodes::Whole(_) => None,
        })
    };
    let points = nodes()
        .flatten()
        .map(|node| BoundaryPoint {
            position: node.position,
            normal: Vec2::new(0.0, if node.position.z > 0.0 { 1.0 } else { -1.0 }),
            coordinate: node.position.x,
        })
        .collect();
    let lengths = nodes().flatten().map(|node| node.tributary_length).collect();
    StressEnvelope { lengths, ..empty(body, points, false, Cells::Nodes) }
}
