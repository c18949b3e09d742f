//! Points of a boundary at which stresses are recorded, and the cells that a contact loads.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use barrelstack_dynamics::{BodyId, Nodes, Planar, Shape, Vec2, math};

use super::follow::Bounds;
use super::{BoundaryPoint, CELLS, Cells, StressEnvelope, TotalForce};

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
        peak_whole_run: vec![0.0; count],
        total: TotalForce::default(),
        cells,
    }
}

/// Returns a stress envelope with cells along the surface of a barrel and with zero stresses.
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

/// Returns a stress envelope with one point for every fixed node of a rack and with zero stresses.
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

impl StressEnvelope {
    /// Returns the cells that a contact with a tributary length (m) loads around a point (m) of the body, and sets
    /// `bounds` to the range of points for which these cells stay the same.
    pub(super) fn place(&self, point: Vec2, length: f64, bounds: &mut Bounds) -> Range<usize> {
        match self.cells {
            Cells::Around(radius) => {
                let count = self.points.len() as f64;
                let width = TAU / count;
                let angle = math::atan2(point.z, point.x).rem_euclid(TAU);
                let (first, last, from, to) = span(angle, length / radius, width);
                let direction = |angle: f64| {
                    let (sin, cos) = math::sin_cos(angle);
                    Vec2::new(cos, sin)
                };
                let first_cell = whole(first.rem_euclid(count));
                let cells = whole((last - first + 1.0).min(count));
                (bounds.from, bounds.to) = (direction(from), direction(to));
                first_cell..first_cell + cells
            }
            Cells::Along(half_length) => {
                let cells = self.points.len() / 2;
                let most = cells as f64 - 1.0;
                let width = 2.0 * half_length / cells as f64;
                let (first, last, from, to) = span(point.x + half_length, length, width);
                let first = whole(first.clamp(0.0, most));
                let last = whole(last.clamp(0.0, most));
                bounds.above = point.z >= 0.0;
                (bounds.from.x, bounds.to.x) = (from - half_length, to - half_length);
                let side = if bounds.above { 0 } else { cells };
                side + first..side + last + 1
            }
            Cells::Nodes => 0..0,
        }
    }
}

/// Returns the first and the last cell whose middle lies in an interval of `length` around a coordinate, and the range
/// of coordinates for which these cells stay the same.
///
/// Cells have the given width; at least one cell is returned.
fn span(coordinate: f64, length: f64, width: f64) -> (f64, f64, f64, f64) {
    let half = 0.5 * length;
    let first = ((coordinate - half) / width + 0.5).floor();
    let last = ((coordinate + half) / width - 0.5).floor();
    let from = ((first - 0.5) * width + half).max((last + 0.5) * width - half);
    let to = ((first + 0.5) * width + half).min((last + 1.5) * width - half);
    (first, last.max(first), from, to)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between zero and the number of cells"
)]
fn whole(number: f64) -> usize {
    number as usize
}
