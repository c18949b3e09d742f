//! A barrel as a body of revolution about `x`: stave, heads, and a rounded chime between stave and heads.

use crate::real::{Mask, Real};
use crate::shape::Gap;
use crate::space::{Spatial, Vec3};

/// A barrel about the origin with its axis along `x`, stored as its core: the barrel shrunk by the rounding of its
/// chime.
///
/// In the half-plane of `x` and the distance `r` from the axis, the stave of the core is the arc `x² + (r + a)² =
/// R²`, whose center lies on the far side of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barrel<R = f64> {
    /// Half the length (m) of the core.
    pub half_length: R,
    /// Radius (m) of the heads of the core.
    pub head_radius: R,
    /// `R`, the radius (m) of the longitudinal arc of the core's stave.
    pub stave_radius: R,
    /// `a`, the distance (m) by which the center of the stave's arc lies beyond the axis.
    pub stave_offset: R,
    /// Distance (m) of the surface from the core.
    pub rounding: R,
}

/// Invalid dimensions of a barrel.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "a barrel {length} m long cannot have a head radius of {head_radius} m, a bilge radius of {bilge_radius} m and a \
     chime radius of {rounding} m: all lengths must be positive, the bilge must be wider than the heads, the staves \
     must curve lengthwise with a radius of at least the bilge radius, and the chime radius must be smaller than the \
     head radius and smaller than half the length"
)]
pub struct BarrelError {
    length: f64,
    head_radius: f64,
    bilge_radius: f64,
    rounding: f64,
}

impl Barrel {
    /// Creates a barrel from its length (m), the radii (m) of its heads and its bilge, and the rounding radius (m) of
    /// the chime, which is the edge between head and stave.
    ///
    /// # Errors
    /// If the dimensions are invalid; the message of [`BarrelError`] lists the conditions.
    pub fn new(
        length: f64,
        head_radius: f64,
        bilge_radius: f64,
        rounding: f64,
    ) -> Result<Self, BarrelError> {
        let (half, rise) = (0.5 * length, bilge_radius - head_radius);
        let arc = (half * half + rise * rise) / (2.0 * rise);
        let stave_offset = arc - bilge_radius;
        let (half_length, stave_radius) = (half - rounding, arc - rounding);
        let corner = (stave_radius * stave_radius - half_length * half_length).sqrt();
        let barrel = Self {
            half_length,
            head_radius: corner - stave_offset,
            stave_radius,
            stave_offset,
            rounding,
        };
        let sound = rounding >= 0.0
            && rise > 0.0
            && barrel.half_length > 0.0
            && barrel.head_radius > 0.0
            // The formulas need the center of the arc on the far side of the axis.
            && stave_offset >= 0.0
            && arc.is_finite();
        if sound {
            Ok(barrel)
        } else {
            Err(BarrelError { length, head_radius, bilge_radius, rounding })
        }
    }
}

impl<R: Real> Barrel<R> {
    /// Returns the radius (m) of an enclosing ball.
    pub(super) fn reach(&self) -> R {
        let corner = self.half_length * self.half_length + self.head_radius * self.head_radius;
        corner.sqrt().max(self.stave_radius - self.stave_offset) + self.rounding
    }

    /// Returns the signed distance (m) of a point (m) from the surface, and the surface normal.
    ///
    /// Outside of the core, the nearest point of the core lies on the stave, on a head, or on the circle where they
    /// meet. Inside the core, the distance and the normal are those of the stave or of a head, whichever is nearer.
    #[inline(always)]
    pub(super) fn gap(&self, point: Vec3<R>) -> Gap<Spatial<R>> {
        let (zero, one) = (R::zero(), R::splat(1.0));
        let side = R::select(point.x.lt(zero), -one, one);
        let along = point.x.abs();
        let across = Vec3::new(zero, point.y, point.z);
        let radial = across.unit_or(Vec3::new(zero, zero, one));
        let from_axis = across.length();
        let plane = |x: R, r: R| Vec3::new(side * x, zero, zero) + radial * r;

        let from_center = from_axis + self.stave_offset;
        let length = (along * along + from_center * from_center).sqrt();
        let stave = length - self.stave_radius;
        let head = along - self.half_length;
        let corner = self.head_radius + self.stave_offset;

        let inside = stave.le(zero) & head.le(zero);
        let on_head =
            (inside & stave.lt(head)) | (!inside & zero.le(head) & from_axis.le(self.head_radius));
        let before_stave = (along * corner).le(self.half_length * from_center);
        let on_stave = !on_head & (inside | before_stave);

        // The center of the arc lies outside of every barrel, so no length is zero near one.
        let of_stave = plane(along, from_center) * (one / R::select(length.le(zero), one, length));
        // Nearly all queries end here.
        if on_stave.all() {
            return Gap { distance: stave - self.rounding, normal: of_stave };
        }
        let (beyond, outward) = (head, from_axis - self.head_radius);
        let chime = (beyond * beyond + outward * outward).sqrt();
        let at_corner = chime.le(zero);
        let inverse = one / R::select(at_corner, one, chime);
        let past = plane(beyond, outward) * inverse;
        let end = plane(self.half_length, corner) * (one / self.stave_radius);
        let of_chime = Vec3::select(at_corner, end, past);
        let of_head = plane(one, zero);
        let distance = R::select(on_head, head, R::select(on_stave, stave, chime));
        let normal = Vec3::select(on_head, of_head, Vec3::select(on_stave, of_stave, of_chime));
        Gap { distance: distance - self.rounding, normal }
    }

    /// Returns the support point (m) of the core in the direction of a unit vector.
    #[inline(always)]
    pub(super) fn furthest(&self, direction: Vec3<R>) -> Vec3<R> {
        let (zero, one) = (R::zero(), R::splat(1.0));
        let across = Vec3::new(zero, direction.y, direction.z);
        let outward = across.length();
        let radial = across.unit_or(Vec3::new(zero, zero, one));
        let stave = direction * self.stave_radius - radial * self.stave_offset;
        let side = R::select(direction.x.lt(zero), -one, one);
        let chime = Vec3::new(side * self.half_length, zero, zero) + radial * self.head_radius;
        let corner = self.head_radius + self.stave_offset;
        let on_stave = (direction.x.abs() * corner).le(self.half_length * outward);
        Vec3::select(on_stave, stave, chime)
    }

    /// Returns the barrel in one lane.
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> Barrel {
        Barrel {
            half_length: self.half_length.lane(lane),
            head_radius: self.head_radius.lane(lane),
            stave_radius: self.stave_radius.lane(lane),
            stave_offset: self.stave_offset.lane(lane),
            rounding: self.rounding.lane(lane),
        }
    }
}

impl<R: Real> Barrel<R> {
    /// Returns the first three derivatives of `½ (x² + (r + a)²)` with respect to `t` at the position `point + t along`
    /// (m), for `t = 0`. Here `r` is the distance from the axis, and the quantity is half the squared distance from the
    /// center of the stave's arc.
    #[inline(always)]
    pub(super) fn derivatives(&self, point: Vec3<R>, along: Vec3<R>) -> [R; 3] {
        let inverse = R::splat(1.0) / (point.y * point.y + point.z * point.z).sqrt();
        let (across, square) =
            (point.y * along.y + point.z * along.z, along.y * along.y + along.z * along.z);
        // Derivatives of r.
        let first = across * inverse;
        let second = (square - first * first) * inverse;
        let third = R::splat(-3.0) * first * second * inverse;
        let offset = self.stave_offset;
        [
            point.x * along.x + across + offset * first,
            along.x * along.x + square + offset * second,
            offset * third,
        ]
    }
}
