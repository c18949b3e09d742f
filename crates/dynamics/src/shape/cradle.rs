//! A concave arc that opens upward: the seat of a barrel on its rack.

use std::f64::consts::FRAC_PI_2;

use super::{BoundaryNode, Gap, Piece, Section, nodes_along, parts_of};
use crate::math;
use crate::real::Real;
use crate::space::{Linear, Planar, Vec2};

/// An arc about the origin that is open upward; the solid material is outside the circle.
///
/// Within the opening angle, a point inside the circle is free, and a point outside of it penetrates the solid. Beyond
/// the opening angle, only the two tips of the arc can be touched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cradle<R = f64> {
    /// Radius of the arc (m).
    pub radius: R,
    /// Sine of half the opening angle, measured from the downward vertical.
    pub sin: R,
    /// Cosine of half the opening angle.
    pub cos: R,
}

impl<R: Real> Cradle<R> {
    #[inline(always)]
    pub(super) fn gap(&self, point: Vec2<R>) -> Gap<Planar<R>> {
        let (zero, one) = (R::zero(), R::splat(1.0));
        let length = point.length();
        let safe = R::select(length.le(zero), one, length);
        // A point is within the opening angle if its direction is nearer to straight down than the tips are.
        let inside = (-point.z).lt(length * self.cos);
        let tip = Vec2::new(
            R::select(point.x.lt(zero), -self.sin, self.sin) * self.radius,
            -(self.cos * self.radius),
        );
        let from_tip = point - tip;
        let tip_distance = from_tip.length();
        let safe_tip = R::select(tip_distance.le(zero), one, tip_distance);
        Gap {
            distance: R::select(inside, tip_distance, self.radius - length),
            normal: Vec2::select(inside, from_tip * (one / safe_tip), -point * (one / safe)),
        }
    }
}

impl Cradle {
    /// Creates a cradle with a radius (m) that extends from the downward vertical by `half_angle` (rad, below π) to
    /// either side.
    pub fn new(radius: f64, half_angle: f64) -> Self {
        let (sin, cos) = math::sin_cos(half_angle);
        Self { radius, sin, cos }
    }

    /// Returns half the opening angle (rad).
    pub fn half_angle(&self) -> f64 {
        math::atan2(self.sin, self.cos)
    }

    pub(super) fn outline(&self) -> Vec<Vec2> {
        self.arc(parts_of(2.0 * self.half_angle(), 5.0_f64.to_radians()))
    }

    pub(super) fn nodes(&self, spacing: f64) -> Vec<BoundaryNode> {
        let half = self.half_angle();
        let arc = Piece::Arc {
            center: Vec2::default(),
            radius: self.radius,
            from: -(FRAC_PI_2 + half),
            turn: 2.0 * half,
        };
        nodes_along(&[arc], false, spacing, f64::INFINITY)
    }

    fn arc(&self, parts: usize) -> Vec<Vec2> {
        let half = self.half_angle();
        (0..=parts)
            .map(|i| {
                let (sin, cos) = math::sin_cos(half * (2.0 * i as f64 / parts as f64 - 1.0));
                Vec2::new(sin, -cos) * self.radius
            })
            .collect()
    }

    /// Returns the mass distribution of a thin uniform arc along the boundary.
    pub(super) fn section(&self) -> Section {
        let half = self.half_angle();
        let centroid = Vec2::new(0.0, -self.radius * self.sin / half);
        Section {
            measure: 2.0 * half * self.radius,
            centroid,
            gyration_squared: self.radius * self.radius - centroid.dot(centroid),
        }
    }
}
