//! A convex polygon with sharp or rounded corners, such as a rack beam, a block or a brick.

use std::f64::consts::TAU;

use super::{BoundaryNode, Facing, Gap, Nearest, Piece, Section, nodes_along};
use crate::body::Round;
use crate::lanewise;
use crate::math;
use crate::real::{Mask as _, Real};
use crate::space::{Linear, Planar, Vec2};

/// Distance (m) outside a side up to which a node still counts as touching, for bodies that are flush: about a
/// nanometer. The value is not a round decimal number: scenes may place nodes at exactly a round distance, where
/// rounding errors would decide whether they touch.
pub(super) const FLUSH: f64 = 1.0 / (1_u64 << 30) as f64;

/// Maximum angle (rad) of each part into which a rounded corner is divided.
const CORNER_STEP: f64 = TAU / 24.0;

/// A convex polygon whose corners may be rounded.
///
/// The polygon is stored as its core, which lies `corner_radius` inside every side. The boundary is the core grown by
/// that radius, so the signed distance is exact at the corners, too.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon<R = f64> {
    /// Sides of the core, counterclockwise (from `x` toward `z`).
    sides: Vec<Side<R>>,
    /// Radius (m) of the corners; zero for sharp corners.
    corner_radius: R,
}

/// A side of the core.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side<R> {
    /// Start point (m).
    start: Vec2<R>,
    /// Midpoint (m). Distances are measured from the midpoint and not from an end, since mirroring exchanges the ends.
    /// So a mirrored polygon has the same rounding errors.
    middle: Vec2<R>,
    /// Unit vector along the side.
    along: Vec2<R>,
    /// Unit vector out of the polygon.
    outward: Vec2<R>,
    /// Half the length of the side (m).
    half_length: R,
}

/// Reason why corners do not form a convex polygon.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PolygonError {
    /// There are fewer than three corners.
    #[error("a polygon needs at least 3 corners, found {found}")]
    TooFew {
        /// The given number of corners.
        found: usize,
    },
    /// A corner turns inward, or three successive corners are in line.
    #[error(
        "the outline does not turn left at corner {corner}, ({x:.6} m, {z:.6} m): list the corners of a convex polygon \
         counterclockwise, without three successive corners on a line"
    )]
    NotConvex {
        /// Number of the corner, counted from 1.
        corner: usize,
        /// Horizontal coordinate of the corner (m).
        x: f64,
        /// Height of the corner (m).
        z: f64,
    },
    /// The corners go around the polygon more than once.
    #[error(
        "the outline goes around the polygon more than once: up to corner {corner}, it turns by more than 360°; list \
         each corner of a convex polygon once"
    )]
    Overlapping {
        /// Number of the corner, counted from 1, at which the first full turn is complete.
        corner: usize,
    },
    /// The corner radius is too large for the polygon.
    #[error("a corner radius of {radius} m is too large for the polygon: choose a smaller radius")]
    RadiusTooLarge {
        /// The given corner radius (m).
        radius: f64,
    },
}

/// Minimum height (m) of a point above a side, and minimum distance (m) from both ends along the side, at which this
/// side is certainly the nearest. For points up to 5 m above the side, the value allows for rounding errors and for the
/// nanometer by which sides are extended.
const CLEAR: f64 = 1e-4;

impl<R: Real> Polygon<R> {
    /// Returns the number of sides.
    pub(crate) fn side_count(&self) -> usize {
        self.sides.len()
    }

    #[inline(always)]
    pub(super) fn gap(&self, point: Vec2<R>) -> Gap<Planar<R>> {
        self.nearest(point, R::zero()).gap
    }

    /// Returns the gap and the nearest piece; every side is extended at both ends by `slack` (m).
    #[inline(always)]
    pub(super) fn nearest(&self, point: Vec2<R>, slack: R) -> Nearest<Planar<R>> {
        let (zero, one) = (R::zero(), R::splat(1.0));
        if let Some(over) = self.over_one_side(point) {
            return over;
        }
        // For a point inside, the nearest side decides; for a point outside, the nearest point of any side.
        let mut deepest = R::splat(f64::NEG_INFINITY);
        let mut deepest_normal = Vec2::new(zero, one);
        let mut nearest_squared = R::splat(f64::INFINITY);
        let mut nearest = Vec2::new(zero, zero);
        let mut at_corner = R::Mask::default();
        let (mut to_end, mut toward_end) = (R::splat(f64::INFINITY), Vec2::new(zero, zero));
        for side in &self.sides {
            let offset = point - side.middle;
            let height = offset.dot(side.outward);
            let higher = deepest.lt(height);
            deepest = R::select(higher, height, deepest);
            deepest_normal = Vec2::select(higher, side.outward, deepest_normal);

            // Beside the side, its start may be the nearest point. Its end is tested as the start of the next side.
            let along = offset.dot(side.along);
            let above = along.abs().le(side.half_length + slack);
            let apart = Vec2::select(above, side.outward * height, point - side.start);
            let apart_squared = apart.dot(apart);
            let closer = apart_squared.lt(nearest_squared);
            nearest_squared = R::select(closer, apart_squared, nearest_squared);
            nearest = Vec2::select(closer, apart, nearest);
            at_corner = (closer & !above) | (!closer & at_corner);
            to_end = R::select(closer, side.half_length - along.abs(), to_end);
            let ahead = Vec2::select(along.lt(zero), -side.along, side.along);
            toward_end = Vec2::select(closer, ahead, toward_end);
        }
        let distance = nearest_squared.sqrt();
        // A core of two corners has no inside.
        let outside = zero.lt(distance)
            & if self.sides.len() == 2 { !R::Mask::default() } else { zero.lt(deepest) };
        let safe = R::select(outside, distance, one);
        let gap = Gap {
            distance: R::select(outside, distance, deepest) - self.corner_radius,
            normal: Vec2::select(outside, nearest * (one / safe), deepest_normal),
        };
        let core = gap.distance + self.corner_radius;
        let round = outside & at_corner;
        let to_end = R::select(round, R::splat(f64::INFINITY), to_end);
        Nearest { gap, round, to_end, toward_end, core }
    }

    /// Returns the gap and the nearest piece of a point (m) that, in all lanes, lies above one side and clear of its
    /// ends; `None` for any other point. The result is bit-identical to the result of the search among all sides, since
    /// the polygon is convex.
    #[inline(always)]
    fn over_one_side(&self, point: Vec2<R>) -> Option<Nearest<Planar<R>>> {
        let (zero, clear) = (R::zero(), R::splat(CLEAR));
        if self.sides.len() == 2 {
            return None;
        }
        for side in &self.sides {
            let offset = point - side.middle;
            let (height, along) = (offset.dot(side.outward), offset.dot(side.along));
            let over = clear.lt(height) & (along.abs() + clear).lt(side.half_length);
            if over.all() {
                let apart = side.outward * height;
                let distance = apart.dot(apart).sqrt();
                let normal = apart * (R::splat(1.0) / distance);
                let gap = Gap { distance: distance - self.corner_radius, normal };
                return Some(Nearest {
                    gap,
                    round: R::Mask::default(),
                    to_end: side.half_length - along.abs(),
                    toward_end: Vec2::select(along.lt(zero), -side.along, side.along),
                    core: gap.distance + self.corner_radius,
                });
            }
        }
        None
    }

    /// Returns the side on which a boundary point of another body bears, if the point lies inside the core; otherwise
    /// returns `nearest`. See [`Surface::bearing`](super::Surface::bearing).
    #[inline(always)]
    pub(super) fn bearing(
        &self,
        point: Vec2<R>,
        facing: &Facing<Planar<R>>,
        nearest: Nearest<Planar<R>>,
    ) -> Nearest<Planar<R>> {
        let (zero, none) = (R::zero(), R::splat(f64::NEG_INFINITY));
        let (mut deepest, mut past) = (none, none);
        let mut normal = Vec2::default();
        let (mut to_end, mut toward_end) = (zero, Vec2::default());
        for side in &self.sides {
            let offset = point - side.middle;
            let height = offset.dot(side.outward);
            let faces = facing.includes(side.outward);
            past = R::select(faces, past, past.max(height));
            let higher = faces & deepest.lt(height);
            deepest = R::select(higher, height, deepest);
            normal = Vec2::select(higher, side.outward, normal);
            let along = offset.dot(side.along);
            to_end = R::select(higher, side.half_length - along.abs(), to_end);
            let ahead = Vec2::select(along.lt(zero), -side.along, side.along);
            toward_end = Vec2::select(higher, ahead, toward_end);
        }
        let inside = none.lt(deepest) & deepest.lt(zero) & past.lt(R::splat(facing.slack));
        let gap = Gap { distance: deepest - self.corner_radius, normal };
        let bearing = Nearest { gap, round: R::Mask::default(), to_end, toward_end, core: deepest };
        bearing.where_it(inside, nearest)
    }

    #[inline(always)]
    pub(super) fn may_touch(&self, point: Vec2<R>) -> R::Mask {
        let mut highest = R::splat(f64::NEG_INFINITY);
        for side in &self.sides {
            highest = highest.max((point - side.middle).dot(side.outward));
        }
        highest.lt(self.corner_radius + R::splat(FLUSH))
    }

    pub(super) fn reach(&self) -> f64 {
        let farthest =
            self.sides.iter().map(|side| side.start.length().largest_lane()).fold(0.0, f64::max);
        farthest + self.corner_radius.largest_lane()
    }
}

lanewise!(struct Polygon<R> { sides, corner_radius });
lanewise!(struct Side<R> { start, middle, along, outward, half_length });

impl Polygon {
    /// Creates a convex polygon from the positions (m) of its corners before rounding, in counterclockwise order, and a
    /// corner radius (m).
    ///
    /// # Errors
    /// If there are fewer than three corners, if a corner does not turn left, if the corners go around more than once,
    /// or if the radius is too large for the polygon.
    pub fn new(corners: &[Vec2], corner_radius: f64) -> Result<Self, PolygonError> {
        let count = corners.len();
        if count < 3 {
            return Err(PolygonError::TooFew { found: count });
        }
        let mut turned = 0.0;
        for i in 0..count {
            let (before, here, after) =
                (corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count]);
            let (a, b) = (here - before, after - here);
            let turn = a.x * b.z - a.z * b.x;
            if turn.is_nan() || turn <= 1e-12 * a.length() * b.length() {
                return Err(PolygonError::NotConvex { corner: i + 1, x: here.x, z: here.z });
            }
            turned += math::atan2(turn, a.dot(b));
            if turned > TAU + 1e-6 {
                return Err(PolygonError::Overlapping { corner: i + 1 });
            }
        }
        if corner_radius == 0.0 {
            return Ok(Self::grown(corners, corner_radius));
        }
        let core: Vec<Vec2> = (0..count)
            .map(|i| {
                let (before, here, after) =
                    (corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count]);
                let (a, b) = (unit(here - before), unit(after - here));
                // Move along the bisector until the point is `corner_radius` from both sides.
                let inward = (a.quarter_turn() + b.quarter_turn()) * (1.0 / (1.0 + a.dot(b)));
                here + inward * corner_radius
            })
            .collect();
        let flipped = (0..count).any(|i| {
            let side = corners[(i + 1) % count] - corners[i];
            let core_side = core[(i + 1) % count] - core[i];
            core_side.dot(side) <= 0.0
        });
        if flipped || corner_radius.is_nan() || corner_radius < 0.0 {
            return Err(PolygonError::RadiusTooLarge { radius: corner_radius });
        }
        Ok(Self::grown(&core, corner_radius))
    }

    /// Creates a bar with round ends: all points within a radius (m) of the line segment between two points (m).
    ///
    /// # Errors
    /// If the points coincide or the radius is not positive.
    pub fn bar(from: Vec2, to: Vec2, radius: f64) -> Result<Self, PolygonError> {
        let length = (to - from).length();
        if !(length > 0.0 && length.is_finite()) {
            return Err(PolygonError::TooFew { found: 1 });
        }
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(PolygonError::RadiusTooLarge { radius });
        }
        Ok(Self::grown(&[from, to], radius))
    }

    /// Returns the corners as round pieces; a sharp corner has radius zero.
    pub(super) fn rounds(&self, tributary_length: f64) -> Vec<Round<Planar>> {
        let count = self.sides.len();
        (0..count)
            .map(|i| Round {
                center: self.sides[i].start,
                radius: self.corner_radius,
                limits: [-self.sides[(i + count - 1) % count].along, self.sides[i].along],
                arc_limits: [None; 2],
                sides: [None; 2],
                takes_limit: true,
                greatest_depth: f64::INFINITY,
                tributary_length,
            })
            .collect()
    }

    fn grown(core: &[Vec2], corner_radius: f64) -> Self {
        let sides = (0..core.len())
            .map(|i| {
                let (start, end) = (core[i], core[(i + 1) % core.len()]);
                let along = unit(end - start);
                Side {
                    start,
                    middle: (start + end) * 0.5,
                    along,
                    outward: -along.quarter_turn(),
                    half_length: 0.5 * (end - start).length(),
                }
            })
            .collect();
        Self { sides, corner_radius }
    }

    /// Creates a rectangle about the origin.
    ///
    /// # Errors
    /// If a side is not positive, or the corner radius leaves no core.
    pub fn rectangle(width: f64, height: f64, corner_radius: f64) -> Result<Self, PolygonError> {
        let (a, b) = (0.5 * width, 0.5 * height);
        Self::new(
            &[Vec2::new(-a, -b), Vec2::new(a, -b), Vec2::new(a, b), Vec2::new(-a, b)],
            corner_radius,
        )
    }

    /// Returns the boundary as a closed polyline (m); rounded corners are divided into steps of at most 15 degrees.
    pub(super) fn outline(&self) -> Vec<Vec2> {
        if self.corner_radius == 0.0 {
            return self.sides.iter().map(|side| side.start).collect();
        }
        let mut chain = Vec::new();
        for i in 0..self.sides.len() {
            let (from, turn) = self.corner(i);
            let steps = super::parts_of(turn, CORNER_STEP);
            for k in 0..=steps {
                let (sin, cos) = math::sin_cos(from + turn * k as f64 / steps as f64);
                chain.push(self.sides[i].start + Vec2::new(cos, sin) * self.corner_radius);
            }
        }
        chain
    }

    /// Returns the start direction (rad) and the angle (rad) of the arc of a rounded corner.
    fn corner(&self, i: usize) -> (f64, f64) {
        let count = self.sides.len();
        let (a, b) = (self.sides[(i + count - 1) % count].along, self.sides[i].along);
        (math::atan2(-a.x, a.z), math::atan2(a.x * b.z - a.z * b.x, a.dot(b)))
    }

    /// Returns the pieces of the boundary in order: the corner arcs and the sides in alternation, or only the sides if
    /// the corners are sharp.
    fn pieces(&self) -> Vec<Piece> {
        let mut pieces = Vec::new();
        for (i, side) in self.sides.iter().enumerate() {
            let (radius, end) = (self.corner_radius, self.sides[(i + 1) % self.sides.len()].start);
            if radius > 0.0 {
                let (from, turn) = self.corner(i);
                pieces.push(Piece::Arc { center: side.start, radius, from, turn });
            }
            let out = side.outward * radius;
            pieces.push(Piece::Side(side.start + out, end + out));
        }
        pieces
    }

    pub(super) fn nodes(&self, spacing: f64) -> Vec<BoundaryNode> {
        nodes_along(&self.pieces(), true, spacing, CORNER_STEP)
    }

    /// Returns the outward unit normal at a point (m) of the boundary; at a sharp corner, the mean of the normals of
    /// both sides. The point counts as lying on a side if its distance from the line of this side is less than `near`
    /// (m).
    pub(super) fn outward(&self, point: Vec2, near: f64) -> Vec2 {
        if self.corner_radius > 0.0 {
            return self.gap(point).normal;
        }
        let touching = self
            .sides
            .iter()
            .filter(|side| (point - side.middle).dot(side.outward).abs() < near)
            .fold(Vec2::default(), |sum, side| sum + side.outward);
        unit(touching)
    }

    /// Returns the corners as nodes; the tributary length of a corner is half the total length of its two adjacent
    /// sides. A rounded corner is divided into parts that turn by at most 15 degrees.
    pub fn corner_nodes(&self) -> Vec<BoundaryNode> {
        nodes_along(&self.pieces(), true, f64::INFINITY, CORNER_STEP)
    }

    /// Divides every side into `parts` equal parts, and returns nodes at the ends of all parts. For rounded corners,
    /// the straight sides and the arcs are instead divided into parts no longer than the length of the longest side of
    /// the core divided by `parts`.
    pub fn nodes_per_side(&self, parts: usize) -> Vec<BoundaryNode> {
        let longest = self.sides.iter().map(|side| 2.0 * side.half_length).fold(0.0, f64::max);
        if self.corner_radius > 0.0 {
            return self.nodes(longest / parts.max(1) as f64);
        }
        let chain: Vec<Vec2> = self
            .sides
            .iter()
            .flat_map(|side| {
                (0..parts.max(1)).map(move |k| {
                    side.start
                        + side.along * (2.0 * side.half_length * k as f64 / parts.max(1) as f64)
                })
            })
            .collect();
        let pieces: Vec<Piece> =
            (0..chain.len()).map(|i| Piece::Side(chain[i], chain[(i + 1) % chain.len()])).collect();
        nodes_along(&pieces, true, f64::INFINITY, CORNER_STEP)
    }

    /// Returns the mirror image of the polygon: every `x` becomes `−x`.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let core: Vec<Vec2> =
            self.sides.iter().rev().map(|side| Vec2::new(-side.start.x, side.start.z)).collect();
        Self::grown(&core, self.corner_radius)
    }

    /// Returns the polygon with every length multiplied by `factor` (positive).
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let core: Vec<Vec2> = self.sides.iter().map(|side| side.start * factor).collect();
        Self::grown(&core, self.corner_radius * factor)
    }

    pub(super) fn section(&self) -> Section {
        section_of(&self.outline())
    }
}

/// Returns area, centroid and radius of gyration of a closed polygon (Green's theorem).
pub(crate) fn section_of(corners: &[Vec2]) -> Section {
    let origin = corners[0];
    let (mut area, mut first, mut second) = (0.0, Vec2::default(), 0.0);
    for i in 0..corners.len() {
        let p = corners[i] - origin;
        let q = corners[(i + 1) % corners.len()] - origin;
        let cross = p.x * q.z - p.z * q.x;
        area += 0.5 * cross;
        first += (p + q) * (cross / 6.0);
        second += cross * (p.dot(p) + p.dot(q) + q.dot(q)) / 12.0;
    }
    let centroid = first * (1.0 / area);
    Section {
        measure: area,
        centroid: centroid + origin,
        gyration_squared: second / area - centroid.dot(centroid),
    }
}

fn unit(v: Vec2) -> Vec2 {
    v * (1.0 / v.length())
}
