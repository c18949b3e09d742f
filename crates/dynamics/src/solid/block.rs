//! A block with rounded edges, and its closest points to another convex solid.

use super::closest::{Closest, along};
use super::rounded::Hull;
use crate::real::Real;
use crate::shape::Gap;
use crate::space::{Linear, Rotation3, Spatial, Vec3};

/// A block about the origin, with its edges along the axes of its frame, stored as its core: the block shrunk by the
/// rounding of its edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block<R = f64> {
    /// Half the side lengths (m) of the core.
    pub half: Vec3<R>,
    /// Distance (m) of the surface from the core.
    pub rounding: R,
}

impl<R: Real> Block<R> {
    /// Returns the radius (m) of an enclosing ball.
    pub(super) fn reach(&self) -> R {
        self.half.length() + self.rounding
    }

    /// Returns the signed distance (m) of a point (m) from the surface, and the surface normal. Inside the core, both
    /// refer to the nearest face.
    #[inline(always)]
    pub(super) fn gap(&self, point: Vec3<R>) -> Gap<Spatial<R>> {
        let (zero, one) = (R::zero(), R::splat(1.0));
        let sign = |x: R| R::select(x.lt(zero), -one, one);
        let side = Vec3::new(sign(point.x), sign(point.y), sign(point.z));
        let past = point.times(side) - self.half;
        let outside = Vec3::new(past.x.max(zero), past.y.max(zero), past.z.max(zero));
        let length = outside.length();
        let away = zero.lt(length);
        let most = past.x.max(past.y).max(past.z);
        let first = most.le(past.x);
        let second = !first & most.le(past.y);
        let of_face = Vec3::select(
            first,
            Vec3::new(one, zero, zero),
            Vec3::select(second, Vec3::new(zero, one, zero), Vec3::new(zero, zero, one)),
        );
        let past_edges = outside * (one / R::select(away, length, one));
        Gap {
            distance: R::select(away, length, most) - self.rounding,
            normal: Vec3::select(away, past_edges, of_face).times(side),
        }
    }

    /// Returns the corners (m) of the core, ordered by the signs of their coordinates.
    #[inline(always)]
    pub(super) fn corners(&self) -> [Vec3<R>; 8] {
        std::array::from_fn(|corner| {
            let side = |bit: usize, half: R| if corner & bit == 0 { -half } else { half };
            Vec3::new(side(1, self.half.x), side(2, self.half.y), side(4, self.half.z))
        })
    }

    /// Returns the support point (m) of the core in a direction.
    #[inline(always)]
    pub(super) fn furthest(&self, direction: Vec3<R>) -> Vec3<R> {
        let side = |x: R, half: R| R::select(x.lt(R::zero()), -half, half);
        Vec3::new(
            side(direction.x, self.half.x),
            side(direction.y, self.half.y),
            side(direction.z, self.half.z),
        )
    }

    /// Returns the block in one lane.
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> Block {
        Block { half: self.half.lane(lane), rounding: self.rounding.lane(lane) }
    }
}

/// Edges of a block, each as the indices of its two corners.
const EDGES: [(usize, usize); 12] = [
    (0, 1),
    (2, 3),
    (4, 5),
    (6, 7),
    (0, 2),
    (1, 3),
    (4, 6),
    (5, 7),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
];

/// Returns the closest points of a block, as target, and another solid, as contactor, in the frame of the block.
///
/// `at` is the origin (m) of the other solid in the frame of the block, and `frame` the rotation from the frame of the
/// other solid to that of the block.
///
/// If the cores are separate, the closest points lie at an edge of the block, or inside a face at the support point of
/// the other solid toward that face. If the cores overlap, the face with the least penetration is used.
pub(super) fn from_block(block: &Block, other: &Hull, at: Vec3, frame: Rotation3) -> Closest {
    let (grown, radius) = (block.rounding, other.rounding());
    let mut best = Closest {
        distance: f64::INFINITY,
        normal: Vec3::new(0.0, 0.0, 1.0),
        point: at,
        evaluations: 0,
        converged: true,
    };
    let toward = |normal: Vec3| at + frame.apply(other.furthest(frame.unapply(-normal)));
    let mut shallowest = Closest { distance: f64::NEG_INFINITY, ..best };
    for face in faces() {
        let support = toward(face);
        best.evaluations += 1;
        let half = block.half.times(face);
        let height = support.dot(face) - half.dot(face);
        let distance = height - grown - radius;
        if distance > shallowest.distance {
            shallowest.distance = distance;
            shallowest.normal = face;
            shallowest.point = support - face * radius;
        }
        let within = support.x.abs() <= block.half.x || face.x != 0.0;
        let within = within && (support.y.abs() <= block.half.y || face.y != 0.0);
        let within = within && (support.z.abs() <= block.half.z || face.z != 0.0);
        if height >= 0.0 && within {
            // No other feature can be nearer than a face that bears.
            return Closest { evaluations: best.evaluations, ..shallowest };
        }
    }
    let corners = block.corners().map(|corner| frame.unapply(corner - at));
    for (from, to) in EDGES {
        let middle = (corners[from] + corners[to]) * 0.5;
        let half = (corners[to] - corners[from]) * 0.5;
        let (place, gap, evaluations, found) = along(other, middle, half);
        best.evaluations += evaluations;
        best.converged &= found;
        let distance = gap.distance - grown;
        if distance < best.distance {
            let on_edge = middle + half * place;
            best.distance = distance;
            best.normal = -frame.apply(gap.normal);
            best.point = at + frame.apply(on_edge - gap.normal * gap.distance);
        }
    }
    // The cores are separate if the support distance along the normal is not less than that at the edge.
    let separated = (toward(best.normal) - block.furthest(best.normal)).dot(best.normal);
    let apart = best.distance + grown + radius;
    if separated < apart - 1e-9 {
        Closest { evaluations: best.evaluations, ..shallowest }
    } else {
        best
    }
}

/// Returns the unit normals of the faces.
fn faces() -> [Vec3; 6] {
    let [x, y, z] = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
    [x, -x, y, -y, z, -z]
}
