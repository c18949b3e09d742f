//! Motion in three dimensions: `x` to the right, `y` away from the viewer, `z` up; rotations are right-handed.

use super::{Linear, Quaternion, Rotation3, Space, Vec3};
use crate::real::{Mask, Real};
use crate::solid::{Rounded, Solid};

/// Motion in three dimensions, with a number or a bundle of lanes as its scalar.
///
/// The axes of the body frame are the principal axes, so the inertia consists of three numbers. Spins and moments are
/// in the inertial frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spatial<R = f64>(std::marker::PhantomData<R>);

impl<R: Real> Space for Spatial<R> {
    const SOLIDS_SHARE: bool = true;

    type Real = R;
    type Single = Spatial;
    type Vector = Vec3<R>;
    type Spin = Vec3<R>;
    type Orientation = Quaternion<R>;
    type Rotation = Rotation3<R>;
    /// The principal moments of inertia (kg·m²) about the axes of the body frame.
    ///
    /// A body of revolution must have its axis along `x`; its free rotation is then exact.
    type Inertia = Vec3<R>;
    type Tangent = Vec3<R>;
    type TangentPlane = Vec3<R>;
    /// Isotropic damping coefficients: one for the velocity (N·s/m), and one for the spin (N·m·s).
    type Damping = [R; 2];
    type Surface = Solid<R>;
    type Whole = Rounded<R>;

    #[inline(always)]
    fn rotation(orientation: Quaternion<R>) -> Rotation3<R> {
        orientation.matrix()
    }
    #[inline(always)]
    fn rotate(rotation: Rotation3<R>, vector: Vec3<R>) -> Vec3<R> {
        rotation.apply(vector)
    }
    #[inline(always)]
    fn unrotate(rotation: Rotation3<R>, vector: Vec3<R>) -> Vec3<R> {
        rotation.unapply(vector)
    }
    #[inline(always)]
    fn compose(outer: Rotation3<R>, inner: Rotation3<R>) -> Rotation3<R> {
        outer.after(inner)
    }
    #[inline(always)]
    fn relative(outer: Rotation3<R>, inner: Rotation3<R>) -> Rotation3<R> {
        outer.back().after(inner)
    }
    #[inline(always)]
    fn unrotate_spin(rotation: Rotation3<R>, spin: Vec3<R>) -> Vec3<R> {
        rotation.unapply(spin)
    }
    #[inline(always)]
    fn rotate_spin(rotation: Rotation3<R>, spin: Vec3<R>) -> Vec3<R> {
        rotation.apply(spin)
    }
    #[inline(always)]
    fn velocity_at(spin: Vec3<R>, arm: Vec3<R>) -> Vec3<R> {
        spin.cross(arm)
    }
    /// Returns the length itself, increased by a margin for rounding.
    #[inline(always)]
    fn length_bound(vector: Vec3<R>) -> R {
        vector.length() * R::splat(1.0 + 1e-15)
    }
    #[inline(always)]
    fn first_coordinate(vector: Vec3<R>) -> R {
        vector.x
    }
    #[inline(always)]
    fn spin_magnitude(spin: Vec3<R>) -> R {
        spin.length()
    }
    #[inline(always)]
    fn moment(arm: Vec3<R>, force: Vec3<R>) -> Vec3<R> {
        arm.cross(force)
    }
    #[inline(always)]
    fn turn(orientation: Quaternion<R>, spin: Vec3<R>, time: R) -> Quaternion<R> {
        Quaternion::turn(spin * time).after(orientation).normalized()
    }
    /// Computes the rotation vector from the truncated power series of `asin s / s`, where `s` is the sine of half the
    /// angle. The result is accurate to 1e-14 rad for rotations below 0.2 rad. Larger rotations are underestimated.
    #[inline(always)]
    fn turn_between(from: Quaternion<R>, to: Quaternion<R>) -> Vec3<R> {
        let turn = to.after(from.back());
        let z = turn.v.dot(turn.v);
        let series = R::splat(1.0)
            + z * (R::splat(1.0 / 6.0)
                + z * (R::splat(3.0 / 40.0)
                    + z * (R::splat(15.0 / 336.0)
                        + z * (R::splat(105.0 / 3456.0) + z * R::splat(945.0 / 42_240.0)))));
        let two = R::splat(2.0);
        // A quaternion and its negative are the same rotation.
        turn.v * (series * R::select(turn.w.lt(R::zero()), -two, two))
    }
    /// Computes an upper bound on the angle `θ` from the chord `d = 2 sin(θ/4)` between the two quaternions. The arc
    /// that belongs to this chord is `θ/2`. The chord is at most √2, so the arc is at most 1.1108 times as long as the
    /// chord.
    #[inline(always)]
    fn angle_between(a: Quaternion<R>, b: Quaternion<R>) -> R {
        let square = |w: R, v: Vec3<R>| w * w + v.dot(v);
        let near = square(a.w - b.w, a.v - b.v).min(square(a.w + b.w, a.v + b.v));
        near.sqrt() * R::splat(2.222)
    }
    #[inline(always)]
    fn spin_rate(inertia: Vec3<R>, rotation: Rotation3<R>, moment: Vec3<R>) -> Vec3<R> {
        rotation.apply(rotation.unapply(moment).over(inertia))
    }
    #[inline(always)]
    fn momentum(inertia: Vec3<R>, rotation: Rotation3<R>, spin: Vec3<R>) -> Vec3<R> {
        rotation.apply(rotation.unapply(spin).times(inertia))
    }
    /// Computes the spin from the momentum, and improves it by one step of iterative refinement: the momentum of this
    /// spin differs from the given one by a small error, and the spin that corresponds to this error is added. Without
    /// this step a systematic error would accumulate over a run, since a rotation matrix is orthogonal only up to
    /// rounding.
    #[inline(always)]
    fn spin_of(inertia: Vec3<R>, orientation: Quaternion<R>, momentum: Vec3<R>) -> Vec3<R> {
        let rotation = orientation.matrix();
        let spin = Self::spin_rate(inertia, rotation, momentum);
        let missing = momentum - Self::momentum(inertia, rotation, spin);
        spin + Self::spin_rate(inertia, rotation, missing)
    }
    /// Computes the free rotation in momentum form: the angular momentum **L** is conserved, and the kinetic energy
    ///
    /// ```text
    /// T = ½ (Π₁²/I₁ + (Π₂² + Π₃²)/I₂) + ½ Π₃² (1/I₃ − 1/I₂)      Π = Rᵀ L
    /// ```
    ///
    /// has two terms. The first term is the kinetic energy of a body of revolution, whose motion has an exact solution:
    /// rotation about **L** at `L/I₂`, and about its own axis at `Π₁ (1/I₁ − 1/I₂)`. The second term is the remainder,
    /// which rotates the body about its third axis. A step applies half of the remainder, the motion of the body of
    /// revolution, and the other half of the remainder. This splitting is symplectic, reversible, of second order, and
    /// exact for a body of revolution (after Touma and Wisdom 1994, and Fassò 2003).
    #[inline(always)]
    fn coast(
        inertia: Vec3<R>,
        orientation: Quaternion<R>,
        spin: Vec3<R>,
        time: R,
    ) -> (Quaternion<R>, Vec3<R>) {
        let (one, zero) = (R::splat(1.0), R::zero());
        let rotation = orientation.matrix();
        let body_momentum = rotation.unapply(spin).times(inertia);
        let momentum = rotation.apply(body_momentum);
        let across = one / inertia.y;
        let half = R::splat(0.5) * time * (one / inertia.z - across);
        let about_axis = time * (one / inertia.x - across);

        let axial = |p: Vec3<R>| Quaternion::turn(Vec3::new(p.x * about_axis, zero, zero));
        let about_momentum = Quaternion::turn(momentum * (time * across)).after(orientation);
        // A body of revolution has no remainder.
        let turned = if half.abs().le(zero).all() {
            about_momentum.after(axial(body_momentum))
        } else {
            let third = |p: Vec3<R>| Quaternion::turn(Vec3::new(zero, zero, p.z * half));
            let first = third(body_momentum);
            let p = first.matrix().unapply(body_momentum);
            let axial = axial(p);
            let last = third(axial.matrix().unapply(p));
            about_momentum.after(first).after(axial).after(last)
        };
        let turned = turned.normalized();
        (turned, Self::spin_of(inertia, turned, momentum))
    }
    /// Computes `ω − ½ u × ω + ¹⁄₁₂ u × (u × ω)`, where `u` is `turned` and `ω` is `spin`. This is the inverse of the
    /// derivative of the exponential map, to the order that fourth-order methods need (Munthe-Kaas 1999).
    #[inline(always)]
    fn turn_rate(turned: Vec3<R>, spin: Vec3<R>) -> Vec3<R> {
        let once = turned.cross(spin);
        spin - once * R::splat(0.5) + turned.cross(once) * R::splat(1.0 / 12.0)
    }
    fn least_inertia(inertia: Vec3<R>, lane: usize) -> f64 {
        let Vec3 { x, y, z } = inertia.lane(lane);
        // `min` would drop a NaN, which must be returned so that the model is rejected.
        if x.is_nan() || y.is_nan() || z.is_nan() { f64::NAN } else { x.min(y).min(z) }
    }
    #[inline(always)]
    fn spin_energy(inertia: Vec3<R>, rotation: Rotation3<R>, spin: Vec3<R>) -> R {
        let spin = rotation.unapply(spin);
        R::splat(0.5) * spin.times(inertia).dot(spin)
    }
    #[inline(always)]
    fn tangential(vector: Vec3<R>, normal: Vec3<R>) -> Vec3<R> {
        vector - normal * vector.dot(normal)
    }
    #[inline(always)]
    fn along(tangent: Vec3<R>, _normal: Vec3<R>) -> Vec3<R> {
        tangent
    }
    #[inline(always)]
    fn tangent_plane(rotation: Rotation3<R>, normal: Vec3<R>) -> Vec3<R> {
        rotation.apply(normal)
    }
    /// Rotates the vector by the smallest rotation from one normal to the other, `s′ = s − (n + n′) (s · n′) / (1 + n ·
    /// n′)`: a vector in the old plane keeps its length, and the result is always in the new plane.
    #[inline(always)]
    fn carry(tangent: Vec3<R>, from: Vec3<R>, to: Vec3<R>) -> Vec3<R> {
        // For opposite normals the two planes coincide, so the tangent lies in both.
        let least = R::splat(1e-9);
        let scale = (R::splat(1.0) + from.dot(to)).max(least);
        tangent - (from + to) * (tangent.dot(to) / scale)
    }
    #[inline(always)]
    fn rotate_tangent(rotation: Rotation3<R>, tangent: Vec3<R>) -> Vec3<R> {
        rotation.apply(tangent)
    }
    #[inline(always)]
    fn unrotate_tangent(rotation: Rotation3<R>, tangent: Vec3<R>) -> Vec3<R> {
        rotation.unapply(tangent)
    }
    #[inline(always)]
    fn stick_turn(
        displacement: Vec3<R>,
        normal: Vec3<R>,
        rotation: Rotation3<R>,
        [one, other]: [Vec3<R>; 2],
    ) -> Vec3<R> {
        let mean = rotation.apply(one + other * R::splat(0.5));
        normal.cross(displacement) * mean.dot(normal)
    }
    #[inline(always)]
    fn add_turn(mask: R::Mask, tangent: Vec3<R>, turn: Vec3<R>) -> Vec3<R> {
        tangent + Vec3::select(mask, turn, Vec3::default())
    }
    #[inline(always)]
    fn shorten(tangent: Vec3<R>, limit: R) -> Vec3<R> {
        let square = tangent.dot(tangent);
        let longer = (limit * limit).lt(square);
        if !longer.any() {
            return tangent;
        }
        let length = R::select(longer, square, R::splat(1.0)).sqrt();
        Vec3::select(longer, tangent * (limit / length), tangent)
    }
    #[inline(always)]
    fn choose(mask: R::Mask, yes: Vec3<R>, no: Vec3<R>) -> Vec3<R> {
        Vec3::select(mask, yes, no)
    }
    #[inline(always)]
    fn choose_vector(mask: R::Mask, yes: Vec3<R>, no: Vec3<R>) -> Vec3<R> {
        Vec3::select(mask, yes, no)
    }
    #[inline(always)]
    fn choose_plane(mask: R::Mask, yes: Vec3<R>, no: Vec3<R>) -> Vec3<R> {
        Vec3::select(mask, yes, no)
    }
    #[inline(always)]
    fn damp([linear, angular]: [R; 2], velocity: Vec3<R>, spin: Vec3<R>) -> (Vec3<R>, Vec3<R>) {
        (-(velocity * linear), -(spin * angular))
    }
}
