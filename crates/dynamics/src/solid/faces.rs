//! Contact of the faces of two blocks: the polygon that the faces share, and the share of the force that acts at each
//! corner of the polygon.
//!
//! All computations are scalar, as in [`closest`](super::closest).

use std::f64::consts::FRAC_PI_2;

use super::block::Block;
use super::flat::{WIDEST, smooth};
use crate::math;
use crate::shape::Gap;
use crate::space::{Linear, Rotation3, Spatial, Vec2, Vec3};

/// Maximum number of corners of the polygon that two rectangles share.
const MOST: usize = 8;

/// Tolerance (m) of clipping: a corner that is outside of a face by at most this distance counts as inside, since the
/// corners of flush blocks coincide.
const FLUSH: f64 = 1e-9;

/// A corner of a shared polygon, in the frame of the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    /// Point (m) of the contactor's surface at the corner.
    pub(super) point: Vec3,
    pub(super) gap: Gap<Spatial>,
    /// Number of springs that the corner represents.
    pub(super) share: f64,
    /// Derivative of `share` with respect to the rotation of the contactor (1/rad).
    pub(super) turning: Vec3,
}

/// The polygon that the faces of two blocks share.
pub(super) struct Shared<const CORNERS: usize, const AXES: usize> {
    pub(super) vertices: [Option<Vertex>; CORNERS],
    /// Weight of the polygon in the contact, from 0 to 1: 1 if a face of either block meets the other block, and 0 if
    /// an edge of one block crosses an edge of the other.
    pub(super) flat: f64,
    /// Two unit vectors along the face of the target; [`shared_by_both`] adds two along the face of the contactor.
    pub(super) axes: [Vec3; AXES],
}

/// A side of the polygon, which is part of a side of the contactor's face or of the target's face.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    Contactor(usize),
    Target(usize),
}

/// Corners of a polygon in counterclockwise order, each with the side that follows.
#[derive(Clone, Copy)]
struct Chain {
    corners: [(Vec2, Side); 2 * MOST],
    count: usize,
}

impl Chain {
    fn push(&mut self, corner: (Vec2, Side)) {
        if self.count < self.corners.len() {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }

    /// Clips the polygon at a side of the target, given as a line at a distance (m) along a unit normal.
    fn cut(&self, normal: Vec2, distance: f64, side: usize) -> Self {
        let mut kept = Self { count: 0, ..*self };
        let past = |corner: Vec2| corner.x * normal.x + corner.z * normal.z - distance;
        for i in 0..self.count {
            let (from, along) = self.corners[i];
            let (to, _) = self.corners[(i + 1) % self.count];
            let (here, there) = (past(from), past(to));
            if here <= FLUSH {
                kept.push((from, along));
            }
            if (here <= FLUSH) != (there <= FLUSH) {
                let place = (here / (here - there)).clamp(0.0, 1.0);
                let next = if here <= FLUSH { Side::Target(side) } else { along };
                kept.push((from + (to - from) * place, next));
            }
        }
        kept
    }
}

/// The sides of a rectangle in counterclockwise order, starting at the corner with the smallest coordinates. Each side
/// is given by the unit vectors along the side and out of the rectangle.
const SIDES: [(Vec2, Vec2); 4] = [
    (Vec2::new(1.0, 0.0), Vec2::new(0.0, -1.0)),
    (Vec2::new(0.0, 1.0), Vec2::new(1.0, 0.0)),
    (Vec2::new(-1.0, 0.0), Vec2::new(0.0, 1.0)),
    (Vec2::new(0.0, -1.0), Vec2::new(-1.0, 0.0)),
];

/// A face of a block in the frame of the target: its middle (m), two unit vectors along the face, the outward unit
/// normal, and half the lengths of its sides (m).
struct Face {
    middle: Vec3,
    along: [Vec3; 2],
    outward: Vec3,
    half: [f64; 2],
}

impl Face {
    /// Returns the face of a block whose outward normal is closest to a direction in the frame of the block.
    ///
    /// `frame` is the rotation from the frame of the block to that of the target, and `at` the origin (m) of the block
    /// in the frame of the target. The second vector along the face is reversed if necessary, so that the cross product
    /// of the two vectors points to the same side as `up`. If `up` is `None`, the outward normal is used instead.
    fn of(block: &Block, direction: Vec3, at: Vec3, frame: Rotation3, up: Option<Vec3>) -> Self {
        let steep = [direction.x.abs(), direction.y.abs(), direction.z.abs()];
        let halves = [block.half.x, block.half.y, block.half.z];
        let [x, y, z] =
            [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
        let axes = [x, y, z];
        let first = usize::from(steep[1] > steep[0]);
        let axis = if steep[2] > steep[first] { 2 } else { first };
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let away = if direction.dot(axes[axis]) < 0.0 { -1.0 } else { 1.0 };
        let outward = frame.apply(axes[axis] * away);
        let mut along = [frame.apply(axes[next]), frame.apply(axes[last])];
        if along[0].cross(along[1]).dot(up.unwrap_or(outward)) < 0.0 {
            along[1] = -along[1];
        }
        let middle = at + outward * halves[axis];
        Self { middle, along, outward, half: [halves[next], halves[last]] }
    }

    /// Returns the position (m) of the corner at which a side starts.
    fn corner(&self, side: usize) -> Vec3 {
        let ends = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let (u, v) = ends[side % 4];
        self.middle + self.along[0] * (u * self.half[0]) + self.along[1] * (v * self.half[1])
    }

    /// Returns the unit vector along a side.
    fn side(&self, side: usize) -> Vec3 {
        let along = SIDES[side % 4].0;
        self.along[0] * along.x + self.along[1] * along.z
    }
}

/// Returns the mean of [`shared`] and of [`shared`] with the blocks exchanged, so that the result does not depend on
/// the choice of the target.
pub(super) fn shared_by_both(
    contactor: &Block,
    target: &Block,
    at: Vec3,
    frame: Rotation3,
    normal: Vec3,
) -> Shared<{ 2 * MOST }, 4> {
    let own = shared(contactor, target, at, frame, normal);
    let back = shared(target, contactor, -frame.unapply(at), frame.back(), -frame.unapply(normal));
    let exchanged = |vertex: Vertex| Vertex {
        point: at + frame.apply(vertex.point - vertex.gap.normal * vertex.gap.distance),
        gap: Gap { normal: -frame.apply(vertex.gap.normal), ..vertex.gap },
        // The derivative is with respect to the rotation of the other block.
        turning: -frame.apply(vertex.turning),
        ..vertex
    };
    let mut vertices = [None; 2 * MOST];
    let both = own.vertices.into_iter().chain(back.vertices.map(|found| found.map(exchanged)));
    for (vertex, found) in vertices.iter_mut().zip(both) {
        let half = |of: Vertex| Vertex { share: 0.5 * of.share, turning: of.turning * 0.5, ..of };
        *vertex = found.map(half);
    }
    let [a, b] = own.axes;
    let [c, d] = back.axes.map(|axis| frame.apply(axis));
    Shared { vertices, flat: own.flat, axes: [a, b, c, d] }
}

/// Returns the polygon that a block shares with a target, in the frame of the target.
///
/// `at` is the origin (m) of the contactor, `frame` the rotation from the frame of the contactor to that of the target,
/// and `normal` points out of the target at the closest points.
///
/// The two faces that meet at the closest points overlap in a polygon, in projection on the face of the target. Each
/// corner of the polygon acts like a number of springs: the angle by which the boundary turns at the corner, divided by
/// 90°. So the whole polygon always acts like four springs. A corner of a block on the face of the other block acts
/// like one spring. If the blocks are rotated relative to each other about the normal, their edges can cross, and two
/// corners of the polygon then replace one corner of a block. The angles by which the boundary of a convex polygon
/// turns change continuously with the pose, and so does the result. Exactly flush faces therefore need no special case.
fn shared(
    contactor: &Block,
    target: &Block,
    at: Vec3,
    frame: Rotation3,
    normal: Vec3,
) -> Shared<MOST, 2> {
    let bearing = Face::of(target, normal, Vec3::default(), Rotation3::identity(), None);
    let up = bearing.outward;
    let resting = Face::of(contactor, frame.unapply(-normal), at, frame, Some(up));
    let down = resting.outward;
    let cosine = up.dot(normal).max(-down.dot(normal)).min(1.0);
    let flat = smooth(1.0 - (1.0 - cosine * cosine) / (WIDEST * WIDEST));
    let projected = |v: Vec3| Vec2::new(v.dot(bearing.along[0]), v.dot(bearing.along[1]));
    let mut chain = Chain { corners: [(Vec2::default(), Side::Contactor(0)); 2 * MOST], count: 0 };
    for side in 0..4 {
        chain.push((projected(resting.corner(side)), Side::Contactor(side)));
    }
    for (side, (_, outward)) in SIDES.into_iter().enumerate() {
        let half = if outward.x == 0.0 { bearing.half[1] } else { bearing.half[0] };
        chain = chain.cut(outward, half, side);
    }
    let grown = contactor.rounding + target.rounding;
    let direction = |side: Side| match side {
        Side::Contactor(side) => projected(resting.side(side)),
        Side::Target(side) => SIDES[side].0,
    };
    let mut vertices = [None; MOST];
    for (i, vertex) in vertices.iter_mut().enumerate().take(chain.count) {
        let (_, leaving) = chain.corners[i];
        let (_, coming) = chain.corners[(i + chain.count - 1) % chain.count];
        let found = match (coming, leaving) {
            (Side::Contactor(_), Side::Contactor(side)) => {
                let corner = resting.corner(side);
                let distance = (corner - bearing.middle).dot(up);
                Some((corner, up, distance, 1.0, Vec3::default()))
            }
            (Side::Target(_), Side::Target(side)) => {
                let corner = bearing.corner(side);
                let distance = (corner - resting.middle).dot(down);
                Some((corner - down * distance, -down, distance, 1.0, Vec3::default()))
            }
            (Side::Contactor(own), Side::Target(other))
            | (Side::Target(other), Side::Contactor(own)) => {
                let (before, after) = (direction(coming), direction(leaving));
                let turn = math::atan2(
                    before.x * after.z - before.z * after.x,
                    before.x * after.x + before.z * after.z,
                );
                let sense = if matches!(leaving, Side::Contactor(_)) { 1.0 } else { -1.0 };
                crossing(&resting, own, &bearing, other).map(
                    |(point, normal, distance, upright)| {
                        let share = upright * turn.max(0.0) / FRAC_PI_2;
                        (point, normal, distance, share, up * (sense * upright / FRAC_PI_2))
                    },
                )
            }
        };
        *vertex = found.map(|(core, normal, distance, share, turning)| Vertex {
            point: core - normal * contactor.rounding,
            gap: Gap { distance: distance - grown, normal },
            share,
            turning,
        });
    }
    Shared { vertices, flat, axes: bearing.along }
}

/// Returns the crossing of a side of the contactor's face with a side of the target's face: the point (m) on the
/// contactor's side, the common unit normal out of the target, the distance (m) along the normal, and a weight from 0
/// to 1.
///
/// The weight vanishes where the common normal deviates strongly from the normal of the target's face. For example, it
/// vanishes for two nearly parallel sides whose common normal lies nearly in the plane of the target's face.
fn crossing(
    resting: &Face,
    own: usize,
    bearing: &Face,
    other: usize,
) -> Option<(Vec3, Vec3, f64, f64)> {
    let (a, b) = (resting.side(own), bearing.side(other));
    let apart = resting.corner(own) - bearing.corner(other);
    let across = a.cross(b);
    let square = across.dot(across);
    if square < 1e-16 {
        return None;
    }
    let normal = across * (1.0 / square.sqrt());
    let normal = if normal.dot(bearing.outward) < 0.0 { -normal } else { normal };
    let upright = smooth((normal.dot(bearing.outward) - 0.7) / 0.2);
    let place = -apart.cross(b).dot(across) / square;
    let point = resting.corner(own) + a * place;
    Some((point, normal, apart.dot(normal), upright))
}
