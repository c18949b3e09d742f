//! Vectors in three dimensions and their rotations: unit quaternions, which are integrated over time, and matrices.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use super::Linear;
use crate::math;
use crate::real::Real;

/// A vector in three dimensions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3<R = f64> {
    /// Horizontal component, positive to the right.
    pub x: R,
    /// Horizontal component, positive away from the viewer.
    pub y: R,
    /// Vertical component, positive upward.
    pub z: R,
}

impl<R: Real> Vec3<R> {
    /// Creates the vector `(x, y, z)`.
    #[inline(always)]
    pub const fn new(x: R, y: R, z: R) -> Self {
        Self { x, y, z }
    }
    /// Returns the same vector in every lane.
    #[inline(always)]
    pub fn splat(vector: Vec3<f64>) -> Self {
        Self::new(R::splat(vector.x), R::splat(vector.y), R::splat(vector.z))
    }
    /// Returns the vector in one lane.
    #[inline(always)]
    pub fn lane(self, lane: usize) -> Vec3<f64> {
        Vec3::new(self.x.lane(lane), self.y.lane(lane), self.z.lane(lane))
    }
    /// Returns the length.
    #[inline(always)]
    pub fn length(self) -> R {
        self.dot(self).sqrt()
    }
    /// Returns the cross product.
    #[inline(always)]
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }
    /// Returns the component-wise product.
    #[inline(always)]
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }
    /// Returns the component-wise quotient.
    #[inline(always)]
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        Self::new(self.x / other.x, self.y / other.y, self.z / other.z)
    }
    /// Returns `yes` in lanes where the mask is set, and `no` in all other lanes.
    #[inline(always)]
    pub fn select(mask: R::Mask, yes: Self, no: Self) -> Self {
        Self::new(
            R::select(mask, yes.x, no.x),
            R::select(mask, yes.y, no.y),
            R::select(mask, yes.z, no.z),
        )
    }
    /// Returns the unit vector in the direction of this vector; `instead` if its length is zero.
    #[inline(always)]
    #[must_use]
    pub fn unit_or(self, instead: Self) -> Self {
        let length = self.length();
        let none = length.le(R::zero());
        let inverse = R::splat(1.0) / R::select(none, R::splat(1.0), length);
        Self::select(none, instead, self * inverse)
    }
}

impl<R: Real> Add for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}
impl<R: Real> Sub for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}
impl<R: Real> Neg for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}
impl<R: Real> AddAssign for Vec3<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<R: Real> SubAssign for Vec3<R> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
impl<R: Real> Mul<R> for Vec3<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: R) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}
impl<R: Real> Linear<R> for Vec3<R> {
    #[inline(always)]
    fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y + self.z * other.z
    }
}

/// A unit quaternion, which rotates from the body frame to the outer frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion<R = f64> {
    /// Cosine of half the rotation angle.
    pub w: R,
    /// Vector along the rotation axis, with the sine of half the rotation angle as its length.
    pub v: Vec3<R>,
}

impl<R: Real> Quaternion<R> {
    /// Returns the identity.
    #[inline(always)]
    pub fn identity() -> Self {
        Self { w: R::splat(1.0), v: Vec3::default() }
    }

    /// Creates the right-handed rotation about a vector, by an angle (rad) equal to the length of the vector.
    #[inline(always)]
    pub fn turn(turn: Vec3<R>) -> Self {
        let square = turn.dot(turn) * R::splat(0.25);
        let (share, cos) = math::sinc_cos(square);
        Self { w: cos, v: turn * (share * R::splat(0.5)) }
    }

    /// Returns the rotation that applies `inner` first and then this rotation.
    #[inline(always)]
    #[must_use]
    pub fn after(self, inner: Self) -> Self {
        Self {
            w: self.w * inner.w - self.v.dot(inner.v),
            v: inner.v * self.w + self.v * inner.w + self.v.cross(inner.v),
        }
    }

    /// Returns the quaternion scaled to unit length; every product of two quaternions adds a rounding error to the
    /// length.
    #[inline(always)]
    #[must_use]
    pub fn normalized(self) -> Self {
        let inverse = R::splat(1.0) / (self.w * self.w + self.v.dot(self.v)).sqrt();
        Self { w: self.w * inverse, v: self.v * inverse }
    }

    /// Returns the inverse.
    #[inline(always)]
    #[must_use]
    pub fn back(self) -> Self {
        Self { w: self.w, v: -self.v }
    }

    /// Returns the rotation matrix. The rounding error of the length of the quaternion is corrected, since a systematic
    /// error of 1e-16 would make the angular momentum drift.
    #[inline(always)]
    pub fn matrix(self) -> Rotation3<R> {
        let (w, Vec3 { x, y, z }) = (self.w, self.v);
        let one = R::splat(1.0);
        let two = R::splat(2.0) / (w * w + self.v.dot(self.v));
        Rotation3 {
            rows: [
                Vec3::new(
                    one - two * (y * y + z * z),
                    two * (x * y - w * z),
                    two * (x * z + w * y),
                ),
                Vec3::new(
                    two * (x * y + w * z),
                    one - two * (x * x + z * z),
                    two * (y * z - w * x),
                ),
                Vec3::new(
                    two * (x * z - w * y),
                    two * (y * z + w * x),
                    one - two * (x * x + y * y),
                ),
            ],
        }
    }
}

/// A rotation matrix in three dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation3<R = f64> {
    /// Rows of the matrix.
    pub rows: [Vec3<R>; 3],
}

impl<R: Real> Rotation3<R> {
    /// Returns the identity.
    #[inline(always)]
    pub fn identity() -> Self {
        Quaternion::identity().matrix()
    }
    /// Rotates a vector.
    #[inline(always)]
    pub fn apply(self, v: Vec3<R>) -> Vec3<R> {
        let [x, y, z] = self.rows;
        Vec3::new(x.dot(v), y.dot(v), z.dot(v))
    }
    /// Applies the inverse rotation to a vector.
    #[inline(always)]
    pub fn unapply(self, v: Vec3<R>) -> Vec3<R> {
        let [x, y, z] = self.rows;
        x * v.x + y * v.y + z * v.z
    }
    /// Returns the inverse.
    #[inline(always)]
    #[must_use]
    pub fn back(self) -> Self {
        let [a, b, c] = self.rows;
        Self {
            rows: [Vec3::new(a.x, b.x, c.x), Vec3::new(a.y, b.y, c.y), Vec3::new(a.z, b.z, c.z)],
        }
    }
    /// Returns the rotation that applies `inner` first and then this rotation.
    #[inline(always)]
    #[must_use]
    pub fn after(self, inner: Self) -> Self {
        // Written without `map`, which the compiler does not inline here.
        let [x, y, z] = self.rows;
        Self { rows: [inner.unapply(x), inner.unapply(y), inner.unapply(z)] }
    }
    /// Returns the matrix in one lane.
    #[inline(always)]
    pub fn lane(self, lane: usize) -> Rotation3 {
        let [x, y, z] = self.rows;
        Rotation3 { rows: [x.lane(lane), y.lane(lane), z.lane(lane)] }
    }
}
