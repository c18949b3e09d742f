//! A circle about the origin: a barrel in transverse section (Candia et al. 2008, eq. 2.3) or a disc.

use std::f64::consts::{PI, TAU};

use super::{BoundaryNode, Gap, Section, parts_of};
use crate::body::Round;
use crate::math;
use crate::real::Real;
use crate::space::{Linear, Planar, Vec2};

/// A circle about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle<R = f64> {
    /// Radius (m).
    pub radius: R,
}

impl<R: Real> Circle<R> {
    #[inline(always)]
    pub(super) fn gap(&self, point: Vec2<R>) -> Gap<Planar<R>> {
        self.gap_from(point, point.dot(point))
    }

    /// Returns the gap at a point, given its squared distance (m²) from the center.
    #[inline(always)]
    pub(super) fn gap_from(&self, point: Vec2<R>, squared: R) -> Gap<Planar<R>> {
        let length = squared.sqrt();
        let at_center = length.le(R::zero());
        let inverse = R::splat(1.0) / R::select(at_center, R::splat(1.0), length);
        let up = Vec2::new(R::zero(), R::splat(1.0));
        Gap { distance: length - self.radius, normal: Vec2::select(at_center, up, point * inverse) }
    }

    /// Returns the squared distance (m²) from the center below which a point may penetrate the circle.
    #[inline(always)]
    pub(super) fn within(&self) -> R {
        // Includes a slack for rounding, so that no node is missed that the exact gap would find.
        self.radius * self.radius * R::splat(1.0 + 1e-14)
    }

    #[inline(always)]
    pub(super) fn may_touch(&self, point: Vec2<R>) -> R::Mask {
        point.dot(point).lt(self.within())
    }
}

impl Circle {
    /// Returns the whole circle as one round piece.
    pub(super) fn rounds(self, tributary_length: f64) -> Vec<Round<Planar>> {
        vec![Round {
            center: Vec2::default(),
            radius: self.radius,
            limits: [Vec2::default(); 2],
            arc_limits: [None; 2],
            sides: [None; 2],
            takes_limit: true,
            greatest_depth: f64::INFINITY,
            tributary_length,
        }]
    }

    pub(super) fn nodes(self, spacing: f64) -> Vec<BoundaryNode> {
        let count = parts_of(TAU * self.radius, spacing).max(3);
        let tributary_length = TAU * self.radius / count as f64;
        points(self.radius, count)
            .map(|position| BoundaryNode { position, tributary_length })
            .collect()
    }

    pub(super) fn outline(self) -> Vec<Vec2> {
        points(self.radius, 72).collect()
    }

    pub(super) fn section(self) -> Section {
        Section {
            measure: PI * self.radius * self.radius,
            centroid: Vec2::default(),
            gyration_squared: 0.5 * self.radius * self.radius,
        }
    }
}

fn points(radius: f64, count: usize) -> impl Iterator<Item = Vec2> {
    (0..count).map(move |i| {
        let (sin, cos) = math::sin_cos(TAU * i as f64 / count as f64);
        Vec2::new(radius * cos, radius * sin)
    })
}
