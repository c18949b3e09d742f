//! Motion in a vertical plane: `x` to the right, `z` up, angles measured from `x` toward `z`.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use super::{Linear, Space};
use crate::math;
use crate::real::Real;

/// A vector in the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec2<R = f64> {
    /// Horizontal component, positive to the right.
    pub x: R,
    /// Vertical component, positive upward.
    pub z: R,
}

impl<R: Real> Vec2<R> {
    /// Creates the vector `(x, z)`.
    #[inline(always)]
    pub const fn new(x: R, z: R) -> Self {
        Self { x, z }
    }
    /// Returns the same vector in every lane.
    #[inline(always)]
    pub fn splat(vector: Vec2<f64>) -> Self {
        Self::new(R::splat(vector.x), R::splat(vector.z))
    }
    /// Returns the length.
    #[inline(always)]
    pub fn length(self) -> R {
        self.dot(self).sqrt()
    }
    /// Rotates the vector by a quarter turn from `x` toward `z`.
    #[inline(always)]
    #[must_use]
    pub fn quarter_turn(self) -> Self {
        Self::new(-self.z, self.x)
    }
    /// Returns `yes` in lanes where the mask is set, and `no` in all other lanes.
    #[inline(always)]
    pub fn select(mask: R::Mask, yes: Self, no: Self) -> Self {
        Self::new(R::select(mask, yes.x, no.x), R::select(mask, yes.z, no.z))
    }
}

impl<R: Real> Add for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.z + other.z)
    }
}
impl<R: Real> Sub for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.z - other.z)
    }
}
impl<R: Real> Neg for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.z)
    }
}
impl<R: Real> AddAssign for Vec2<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<R: Real> SubAssign for Vec2<R> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
impl<R: Real> Mul<R> for Vec2<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: R) -> Self {
        Self::new(self.x * factor, self.z * factor)
    }
}
impl<R: Real> Linear<R> for Vec2<R> {
    #[inline(always)]
    fn dot(self, other: Self) -> R {
        self.x * other.x + self.z * other.z
    }
}
impl<R: Real> Linear<R> for R {
    #[inline(always)]
    fn dot(self, other: Self) -> R {
        self * other
    }
}

/// A rotation in the plane, as cosine and sine of its angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation2<R = f64> {
    /// Cosine.
    pub cos: R,
    /// Sine.
    pub sin: R,
}

impl<R: Real> Rotation2<R> {
    /// Creates the rotation by an angle (rad).
    #[inline(always)]
    pub fn new(angle: R) -> Self {
        let (sin, cos) = math::sin_cos(angle);
        Self { cos, sin }
    }
    /// Returns the identity.
    #[inline(always)]
    pub fn identity() -> Self {
        Self { cos: R::splat(1.0), sin: R::zero() }
    }
    /// Rotates a vector.
    #[inline(always)]
    pub fn apply(self, v: Vec2<R>) -> Vec2<R> {
        Vec2::new(self.cos * v.x - self.sin * v.z, self.sin * v.x + self.cos * v.z)
    }
    /// Applies the inverse rotation to a vector.
    #[inline(always)]
    pub fn unapply(self, v: Vec2<R>) -> Vec2<R> {
        Vec2::new(self.cos * v.x + self.sin * v.z, self.cos * v.z - self.sin * v.x)
    }
}

/// Motion in a vertical plane, with a number or a bundle of lanes as its scalar.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Planar<R = f64>(std::marker::PhantomData<R>);

impl<R: Real> Space for Planar<R> {
    const SOLIDS_SHARE: bool = false;

    type Real = R;
    type Single = Planar;
    type Vector = Vec2<R>;
    type Spin = R;
    type Orientation = R;
    type Rotation = Rotation2<R>;
    type Inertia = R;
    type Tangent = R;
    type TangentPlane = ();
    /// Rows of the symmetric damping matrix of Candia et al. (2008, eq. 2.8), which multiplies `(ẋ, ż, θ̇)`. The units
    /// are N·s/m in the upper left 2×2 block, N·m·s in the last diagonal entry, and N·s in all other entries.
    type Damping = [[R; 3]; 3];
    type Surface = crate::shape::Shape<R>;
    type Whole = crate::shape::NoWhole;

    #[inline(always)]
    fn rotation(orientation: R) -> Rotation2<R> {
        Rotation2::new(orientation)
    }
    #[inline(always)]
    fn rotate(rotation: Rotation2<R>, vector: Vec2<R>) -> Vec2<R> {
        rotation.apply(vector)
    }
    #[inline(always)]
    fn unrotate(rotation: Rotation2<R>, vector: Vec2<R>) -> Vec2<R> {
        rotation.unapply(vector)
    }
    #[inline(always)]
    fn compose(outer: Rotation2<R>, inner: Rotation2<R>) -> Rotation2<R> {
        Rotation2 {
            cos: outer.cos * inner.cos - outer.sin * inner.sin,
            sin: outer.sin * inner.cos + outer.cos * inner.sin,
        }
    }
    #[inline(always)]
    fn relative(outer: Rotation2<R>, inner: Rotation2<R>) -> Rotation2<R> {
        Rotation2 {
            cos: outer.cos * inner.cos + outer.sin * inner.sin,
            sin: outer.cos * inner.sin - outer.sin * inner.cos,
        }
    }
    #[inline(always)]
    fn unrotate_spin(_rotation: Rotation2<R>, spin: R) -> R {
        spin
    }
    #[inline(always)]
    fn rotate_spin(_rotation: Rotation2<R>, spin: R) -> R {
        spin
    }
    #[inline(always)]
    fn velocity_at(spin: R, arm: Vec2<R>) -> Vec2<R> {
        Vec2::new(-(spin * arm.z), spin * arm.x)
    }
    /// Computes the sum of the larger component and √2 − 1 times the smaller component, which exceeds the length by at
    /// most 8.3 %.
    #[inline(always)]
    fn length_bound(vector: Vec2<R>) -> R {
        let (x, z) = (vector.x.abs(), vector.z.abs());
        x.max(z) + x.min(z) * R::splat(std::f64::consts::SQRT_2 - 1.0)
    }
    #[inline(always)]
    fn first_coordinate(vector: Vec2<R>) -> R {
        vector.x
    }
    #[inline(always)]
    fn spin_magnitude(spin: R) -> R {
        spin.abs()
    }
    #[inline(always)]
    fn moment(arm: Vec2<R>, force: Vec2<R>) -> R {
        arm.x * force.z - arm.z * force.x
    }
    #[inline(always)]
    fn turn(orientation: R, spin: R, time: R) -> R {
        orientation + spin * time
    }
    #[inline(always)]
    fn turn_between(from: R, to: R) -> R {
        to - from
    }
    #[inline(always)]
    fn angle_between(a: R, b: R) -> R {
        (a - b).abs()
    }
    #[inline(always)]
    fn spin_rate(inertia: R, _rotation: Rotation2<R>, moment: R) -> R {
        moment / inertia
    }
    #[inline(always)]
    fn momentum(_inertia: R, _rotation: Rotation2<R>, spin: R) -> R {
        spin
    }
    #[inline(always)]
    fn spin_of(_inertia: R, _orientation: R, momentum: R) -> R {
        momentum
    }
    #[inline(always)]
    fn coast(_inertia: R, orientation: R, spin: R, time: R) -> (R, R) {
        (orientation + spin * time, spin)
    }
    #[inline(always)]
    fn turn_rate(_turned: R, spin: R) -> R {
        spin
    }
    fn least_inertia(inertia: R, lane: usize) -> f64 {
        inertia.lane(lane)
    }
    #[inline(always)]
    fn spin_energy(inertia: R, _rotation: Rotation2<R>, spin: R) -> R {
        R::splat(0.5) * inertia * spin * spin
    }
    /// A tangent is positive in the direction of the normal rotated by a quarter turn from `z` toward `x`: to the right
    /// on a floor.
    #[inline(always)]
    fn tangential(vector: Vec2<R>, normal: Vec2<R>) -> R {
        vector.x * normal.z - vector.z * normal.x
    }
    #[inline(always)]
    fn along(tangent: R, normal: Vec2<R>) -> Vec2<R> {
        Vec2::new(normal.z * tangent, -(normal.x * tangent))
    }
    #[inline(always)]
    fn tangent_plane(_rotation: Rotation2<R>, _normal: Vec2<R>) {}
    #[inline(always)]
    fn carry(tangent: R, (): (), (): ()) -> R {
        tangent
    }
    #[inline(always)]
    fn rotate_tangent(_rotation: Rotation2<R>, tangent: R) -> R {
        tangent
    }
    #[inline(always)]
    fn unrotate_tangent(_rotation: Rotation2<R>, tangent: R) -> R {
        tangent
    }
    #[inline(always)]
    fn stick_turn(_displacement: R, (): (), _rotation: Rotation2<R>, _spins: [R; 2]) -> R {
        R::zero()
    }
    #[inline(always)]
    fn add_turn(_mask: R::Mask, tangent: R, _turn: R) -> R {
        tangent
    }
    #[inline(always)]
    fn shorten(tangent: R, limit: R) -> R {
        tangent.clamp_magnitude(limit)
    }
    #[inline(always)]
    fn choose(mask: R::Mask, yes: R, no: R) -> R {
        R::select(mask, yes, no)
    }
    #[inline(always)]
    fn choose_vector(mask: R::Mask, yes: Vec2<R>, no: Vec2<R>) -> Vec2<R> {
        Vec2::select(mask, yes, no)
    }
    #[inline(always)]
    fn choose_plane(_: R::Mask, (): (), (): ()) {}
    #[inline(always)]
    fn damp(c: [[R; 3]; 3], linear: Vec2<R>, spin: R) -> (Vec2<R>, R) {
        let [x, z, turn] = c;
        let force = Vec2::new(row(x, linear, spin), row(z, linear, spin));
        (-force, -row(turn, linear, spin))
    }
}

/// Returns the product of one row of a damping matrix and a velocity.
#[inline(always)]
fn row<R: Real>(row: [R; 3], linear: Vec2<R>, spin: R) -> R {
    row[0] * linear.x + row[1] * linear.z + row[2] * spin
}
