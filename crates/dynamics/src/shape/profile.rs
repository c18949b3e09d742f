//! A barrel in longitudinal section: two curved staves and the two heads that close it.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{BoundaryNode, Facing, Gap, Nearest, Piece, Section, nodes_along};
use crate::body::Round;
use crate::math;
use crate::real::Real;
use crate::space::{Linear as _, Planar, Vec2};

/// The longitudinal outline of a barrel, centered at the origin, with the axis of the barrel along `x`.
///
/// The staves are circular arcs through the bilge and both heads; a parabola would differ by less
/// than 0.15 % in volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarrelProfile<R = f64> {
    /// Half the length between the heads (m).
    pub half_length: R,
    /// Radius at the heads (m).
    pub head_radius: R,
    /// Radius at the bilge (m).
    pub bilge_radius: R,
    /// Radius of the stave's arc (m): `((L/2)² + s²) / 2s`, where `s` is the bilge radius minus the head radius, and
    /// `L` is the length between the heads.
    pub stave_radius: R,
    /// Radius of the rounded edges (m) between staves and heads.
    pub rounding: R,
    /// Height of the center of a rounded edge above the axis (m).
    pub corner_height: R,
}

/// Distance (m) that a point must have from the core and from the heads to be assigned to a stave. At this distance,
/// rounding errors cannot change which piece of the outline is nearest.
const STAVE_MARGIN: f64 = 2e-5;

/// Number of parts into which a rounded edge is divided for drawing.
const EDGE_STEPS: usize = 6;

impl<R: Real> BarrelProfile<R> {
    #[inline(always)]
    pub(super) fn gap(&self, point: Vec2<R>) -> Gap<Planar<R>> {
        self.nearest(point).gap
    }

    #[inline(always)]
    pub(super) fn nearest(&self, point: Vec2<R>) -> Nearest<Planar<R>> {
        let (zero, one) = (R::zero(), R::splat(1.0));
        // By symmetry only the quarter of positive x and z is needed.
        let (left, below) = (point.x.lt(zero), point.z.lt(zero));
        let p = Vec2::new(point.x.abs(), point.z.abs());
        let arc_center = Vec2::new(zero, self.bilge_radius - self.stave_radius);
        // Distances are measured from the core, which lies inside the boundary by the radius of the edges.
        let core_length = self.half_length - self.rounding;
        let corner = Vec2::new(core_length, self.corner_height);

        let from_center = p - arc_center;
        let arc_length = from_center.length();
        let arc_distance = arc_length - (self.stave_radius - self.rounding);
        let arc_normal = from_center * (one / arc_length);
        let head_distance = p.x - core_length;

        // Beyond both the arc and the head: the corner is nearest.
        let beyond_arc = (from_center.z * (corner.x - arc_center.x))
            .lt(from_center.x * (corner.z - arc_center.z));
        let beyond_head = self.corner_height.lt(p.z);
        let outside = zero.lt(arc_distance.max(head_distance));
        let by_corner = outside & beyond_arc & beyond_head;
        let from_corner = p - corner;
        let corner_distance = from_corner.length();
        let safe = R::select(corner_distance.le(zero), one, corner_distance);

        // Inside, the nearer of the stave and the head decides; outside, the one that faces the point.
        let inside_by_head = arc_distance.lt(head_distance);
        let by_head = (outside & beyond_arc) | (!outside & inside_by_head);
        let flat = Vec2::new(one, zero);
        let face_distance = R::select(by_head, head_distance, arc_distance);
        let face_normal = Vec2::select(by_head, flat, arc_normal);
        let normal = Vec2::select(by_corner, from_corner * (one / safe), face_normal);
        let gap = Gap {
            distance: R::select(by_corner, corner_distance, face_distance) - self.rounding,
            normal: Vec2::new(
                R::select(left, -normal.x, normal.x),
                R::select(below, -normal.z, normal.z),
            ),
        };
        let round = by_corner | !by_head;
        let up = R::select(below, -one, one);
        Nearest {
            gap,
            round,
            to_end: R::select(round, R::splat(f64::INFINITY), self.corner_height - p.z),
            toward_end: Vec2::new(zero, up),
            core: gap.distance + self.rounding,
        }
    }

    /// Returns the lanes in which a point (m) lies outside the core and next to a stave, away from the heads, so that the
    /// stave is [nearest](Self::nearest) to it.
    #[inline(always)]
    pub(super) fn is_by_stave(&self, point: Vec2<R>) -> R::Mask {
        let margin = R::splat(STAVE_MARGIN);
        let from_center =
            Vec2::new(point.x, point.z.abs() + (self.stave_radius - self.bilge_radius));
        let core = self.stave_radius - self.rounding + margin;
        let length = self.half_length - self.rounding - margin;
        (core * core).lt(from_center.dot(from_center)) & point.x.abs().lt(length)
    }

    /// Returns the stave or head on which a boundary point of another body bears, if the point lies inside the core;
    /// otherwise returns `nearest`. See [`Surface::bearing`](super::Surface::bearing).
    #[inline(always)]
    pub(super) fn bearing(
        &self,
        point: Vec2<R>,
        facing: &Facing<Planar<R>>,
        nearest: Nearest<Planar<R>>,
    ) -> Nearest<Planar<R>> {
        let (zero, one) = (R::zero(), R::splat(1.0));
        let none = R::splat(f64::NEG_INFINITY);
        let side = R::select(point.x.lt(zero), -one, one);
        let up = R::select(point.z.lt(zero), -one, one);
        let from_center =
            Vec2::new(point.x, point.z + up * (self.stave_radius - self.bilge_radius));
        let length = from_center.length();
        let stave = length - (self.stave_radius - self.rounding);
        let head = point.x.abs() - (self.half_length - self.rounding);
        let (of_stave, of_head) = (from_center * (one / length), Vec2::new(side, zero));
        let (stave_faces, head_faces) = (facing.includes(of_stave), facing.includes(of_head));
        let depth = |faces, distance| R::select(faces, distance, none);
        let (by_stave, by_head) = (depth(stave_faces, stave), depth(head_faces, head));
        let deepest = by_stave.max(by_head);
        let past = depth(!stave_faces, stave).max(depth(!head_faces, head));
        let on_head = by_stave.lt(by_head);
        let inside = none.lt(deepest) & deepest.lt(zero) & past.lt(R::splat(facing.slack));
        let normal = Vec2::select(on_head, of_head, of_stave);
        let gap = Gap { distance: deepest - self.rounding, normal };
        let to_end = self.corner_height - point.z.abs();
        let bearing = Nearest {
            gap,
            round: !on_head,
            to_end: R::select(on_head, to_end, R::splat(f64::INFINITY)),
            toward_end: Vec2::new(zero, up),
            core: deepest,
        };
        bearing.where_it(inside, nearest)
    }

    pub(super) fn reach(&self) -> f64 {
        let (a, b) = (self.half_length.largest_lane(), self.bilge_radius.largest_lane());
        (a * a + b * b).sqrt()
    }
}

impl BarrelProfile {
    /// Creates a profile from the length between the heads and the two diameters (m).
    ///
    /// Returns `None` unless `0 < head diameter < bilge diameter` and the length is positive.
    pub fn new(length: f64, head_diameter: f64, bilge_diameter: f64) -> Option<Self> {
        let bulge = 0.5 * (bilge_diameter - head_diameter);
        let half_length = 0.5 * length;
        let ordered = head_diameter > 0.0 && bulge > 0.0 && length > 0.0;
        ordered.then(|| Self {
            half_length,
            head_radius: 0.5 * head_diameter,
            bilge_radius: 0.5 * bilge_diameter,
            stave_radius: (half_length * half_length + bulge * bulge) / (2.0 * bulge),
            rounding: 0.0,
            corner_height: 0.5 * head_diameter,
        })
    }

    /// Returns the profile with edges rounded by a radius (m).
    ///
    /// Returns `None` if the rounding leaves nothing of the heads.
    pub fn rounded(self, rounding: f64) -> Option<Self> {
        let across = self.half_length - rounding;
        let apart = self.stave_radius - rounding;
        let rise = (apart * apart - across * across).max(0.0).sqrt();
        let corner_height = self.bilge_radius - self.stave_radius + rise;
        let sound = rounding >= 0.0 && across > 0.0 && corner_height > 0.0;
        sound.then_some(Self { rounding, corner_height, ..self })
    }

    /// Returns the radius (m) of the barrel at a position along its axis, given as the distance (m) from the bilge.
    pub fn radius_at(&self, x: f64) -> f64 {
        self.bilge_radius - self.stave_radius
            + (self.stave_radius * self.stave_radius - x * x).max(0.0).sqrt()
    }

    /// Returns the four edges and the two staves as round pieces.
    pub(super) fn rounds(&self, tributary_length: f64) -> Vec<Round<Planar>> {
        let rise = self.stave_radius - self.bilge_radius;
        // Sine and cosine of the angle of the stave's normal at its end.
        let sin = (self.half_length - self.rounding) / (self.stave_radius - self.rounding);
        let cos = (rise + self.corner_height) / (self.stave_radius - self.rounding);
        let edge = |x: f64, z: f64| {
            let toward_bilge = Vec2::new(-cos * x, sin * z);
            Round {
                center: Vec2::new(x * (self.half_length - self.rounding), z * self.corner_height),
                radius: self.rounding,
                limits: [toward_bilge, Vec2::new(0.0, -z)],
                arc_limits: [Some(toward_bilge), None],
                sides: [None; 2],
                takes_limit: false,
                greatest_depth: f64::INFINITY,
                tributary_length,
            }
        };
        let stave = |z: f64| {
            let limits = [Vec2::new(cos, -sin * z), Vec2::new(-cos, -sin * z)];
            Round {
                center: Vec2::new(0.0, -z * rise),
                radius: self.stave_radius,
                limits,
                arc_limits: limits.map(Some),
                sides: [1.0, -1.0].map(|x| Some((Vec2::new(x, 0.0), self.half_length))),
                takes_limit: true,
                greatest_depth: self.head_radius,
                tributary_length,
            }
        };
        let edges = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let edges = edges.into_iter().map(|(x, z)| edge(x, z));
        edges.chain([1.0, -1.0].map(stave)).collect()
    }

    /// Returns the outward normal at a point (m) of the boundary; at a sharp edge, the mean of the normals of head and
    /// stave. The point counts as lying at an edge if both its coordinates differ from those of the edge by less than
    /// `near` (m).
    pub(super) fn outward(&self, point: Vec2, near: f64) -> Vec2 {
        let normal = self.gap(point).normal;
        let head = Vec2::new(point.x.signum(), 0.0);
        let at_edge = self.rounding == 0.0
            && (point.x.abs() - self.half_length).abs() < near
            && (point.z.abs() - self.corner_height).abs() < near;
        if !at_edge {
            return normal;
        }
        let rise = point.z.signum() * (self.stave_radius - self.bilge_radius);
        let stave = Vec2::new(point.x, point.z + rise);
        let sum = head + stave * (1.0 / stave.length());
        sum * (1.0 / sum.length())
    }

    /// Returns half of the angle (rad) that the arc of a stave spans.
    fn half_stave(&self) -> f64 {
        math::atan2(
            self.half_length - self.rounding,
            self.stave_radius - self.bilge_radius + self.corner_height,
        )
    }

    /// Returns the outline as a closed polyline (m) that starts at the right head and runs over the top, the left head
    /// and the bottom.
    fn chain(&self, parts: usize) -> Vec<Vec2> {
        let half = self.half_stave();
        let direction = |angle: f64| {
            let (sin, cos) = math::sin_cos(angle);
            Vec2::new(sin, cos)
        };
        let stave = (0..=parts).map(|i| {
            let angle = half * (1.0 - 2.0 * i as f64 / parts as f64);
            Vec2::new(0.0, self.bilge_radius - self.stave_radius)
                + direction(angle) * self.stave_radius
        });
        // An edge turns from the end of a stave to the normal of the head, or back.
        let edge = |x: f64, from: f64, to: f64| {
            let center = Vec2::new(x * (self.half_length - self.rounding), self.corner_height);
            let steps = if self.rounding > 0.0 { EDGE_STEPS } else { 0 };
            let at = move |i: usize| {
                let angle = from + (to - from) * i as f64 / EDGE_STEPS as f64;
                center + direction(angle) * self.rounding
            };
            (0..steps).map(at).collect::<Vec<_>>()
        };
        let right = edge(1.0, FRAC_PI_2, half);
        let left = edge(-1.0, -FRAC_PI_2, -half).into_iter().rev();
        let top: Vec<Vec2> = right.into_iter().chain(stave).chain(left).collect();
        top.iter().copied().chain(top.iter().map(|p| -*p)).collect()
    }

    pub(super) fn outline(&self) -> Vec<Vec2> {
        self.chain(24)
    }

    /// Returns nodes along the profile, without regard to the rounding of the edges.
    pub(super) fn nodes(&self, spacing: f64) -> Vec<BoundaryNode> {
        let half =
            math::atan2(self.half_length, self.stave_radius - self.bilge_radius + self.head_radius);
        let rise = self.stave_radius - self.bilge_radius;
        let (a, b) = (self.half_length, self.head_radius);
        let stave = |center, middle: f64| Piece::Arc {
            center,
            radius: self.stave_radius,
            from: middle - half,
            turn: 2.0 * half,
        };
        let pieces = [
            stave(Vec2::new(0.0, -rise), FRAC_PI_2),
            Piece::Side(Vec2::new(-a, b), Vec2::new(-a, -b)),
            stave(Vec2::new(0.0, rise), PI + FRAC_PI_2),
            Piece::Side(Vec2::new(a, -b), Vec2::new(a, b)),
        ];
        nodes_along(&pieces, true, spacing, f64::INFINITY)
    }

    /// Returns the mass distribution of a flat plate with this outline. Its moment of inertia is not that of a barrel.
    pub(super) fn section(&self) -> Section {
        super::polygon::section_of(&self.chain(2000))
    }
}
