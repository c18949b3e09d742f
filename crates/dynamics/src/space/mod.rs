//! The kinematics of rigid motion, in as many dimensions as a space has.
//!
//! Contact laws, the contact loop, the integrators, the energy ledger and the run loop are written
//! against [`Space`] and never name a dimension.
//! [`Planar`] is the vertical plane of the paper, [`Spatial`] the space around it.

mod planar;
mod spatial;
mod vector;

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use crate::real::Real;

pub use planar::{Planar, Rotation2, Vec2};
pub use spatial::Spatial;
pub use vector::{Quaternion, Rotation3, Vec3};

/// What vectors, spins and tangents have in common: they add and scale.
pub trait Linear<R>:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Mul<R, Output = Self>
{
    /// The scalar product with another of its kind.
    fn dot(self, other: Self) -> R;
}

/// Rigid motion in a number of dimensions.
pub trait Space: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// Whether bodies have so many solids that one view of two bodies often serves several pairs.
    const SOLIDS_SHARE: bool;

    /// The scalar.
    type Real: Real;
    /// Positions (m), velocities (m/s) and forces (N).
    type Vector: Linear<Self::Real>;
    /// Angular velocities (rad/s) and moments (N·m).
    type Spin: Linear<Self::Real>;
    /// What is integrated to know how a body is turned.
    type Orientation: Copy + Debug + PartialEq + Send + Sync + 'static;
    /// What turns a vector; computed once from an orientation.
    type Rotation: Copy + Debug + PartialEq + Send + Sync + 'static;
    /// Moment of inertia about the center of mass (kg·m²).
    type Inertia: Copy + Debug + PartialEq + Send + Sync + 'static;
    /// A displacement (m), velocity (m/s) or force (N) in the plane tangent to a contact.
    type Tangent: Linear<Self::Real>;
    /// What a tangent keeps beside it, so that it can be carried along a surface that turns: the normal in
    /// space, nothing in the plane, where a tangent is a number.
    type TangentPlane: Copy + Debug + Default + PartialEq + Send + Sync + 'static;
    /// Viscous damping matrix of a body.
    type Damping: Copy + Debug + PartialEq + Send + Sync + 'static;
    /// The shapes whose surface can be a contact target.
    type Surface: crate::shape::Surface<Self>;
    /// Convex bodies that touch as a whole; none in the plane, where round pieces do.
    type Whole: crate::shape::Whole<Self>;

    /// The rotation that an orientation stands for.
    fn rotation(orientation: Self::Orientation) -> Self::Rotation;
    /// From the turned frame to the outer frame.
    fn rotate(rotation: Self::Rotation, vector: Self::Vector) -> Self::Vector;
    /// From the outer frame to the turned frame.
    fn unrotate(rotation: Self::Rotation, vector: Self::Vector) -> Self::Vector;
    /// First `inner`, then `outer`.
    fn compose(outer: Self::Rotation, inner: Self::Rotation) -> Self::Rotation;
    /// The rotation from the frame of `inner` to the frame of `outer`.
    fn relative(outer: Self::Rotation, inner: Self::Rotation) -> Self::Rotation;
    /// A spin or moment, from the outer frame to the turned frame.
    fn unrotate_spin(rotation: Self::Rotation, spin: Self::Spin) -> Self::Spin;
    /// A spin or moment, from the turned frame to the outer frame.
    fn rotate_spin(rotation: Self::Rotation, spin: Self::Spin) -> Self::Spin;
    /// Velocity that a spin gives to a point at `arm` from the axis.
    fn velocity_at(spin: Self::Spin, arm: Self::Vector) -> Self::Vector;
    /// A bound that no vector of these components is longer than, and few are much shorter: cheaper
    /// than the length.
    fn length_bound(vector: Self::Vector) -> Self::Real;
    /// The first coordinate of a vector, along which bodies are swept for neighbors.
    fn first_coordinate(vector: Self::Vector) -> Self::Real;
    /// The magnitude of a spin.
    fn spin_magnitude(spin: Self::Spin) -> Self::Real;
    /// Moment of a force that acts at `arm`.
    fn moment(arm: Self::Vector, force: Self::Vector) -> Self::Spin;
    /// The orientation after turning at a spin for a time.
    fn turn(
        orientation: Self::Orientation,
        spin: Self::Spin,
        time: Self::Real,
    ) -> Self::Orientation;
    /// The turn (rad) from one orientation to another near it: the spin that does it in a unit of time.
    fn turn_between(from: Self::Orientation, to: Self::Orientation) -> Self::Spin;
    /// How far apart two orientations are (rad); an upper bound will do.
    fn angle_between(a: Self::Orientation, b: Self::Orientation) -> Self::Real;
    /// Angular acceleration that a moment alone gives; what a body does without moments is told by
    /// [`Space::coast`] and [`Space::momentum`].
    fn spin_rate(
        inertia: Self::Inertia,
        rotation: Self::Rotation,
        moment: Self::Spin,
    ) -> Self::Spin;
    /// What a spin keeps where no moment acts, up to a factor that is constant: the angular momentum in
    /// space, the spin itself in the plane.
    fn momentum(inertia: Self::Inertia, rotation: Self::Rotation, spin: Self::Spin) -> Self::Spin;
    /// The spin of a body with what [`Space::momentum`] tells.
    fn spin_of(
        inertia: Self::Inertia,
        orientation: Self::Orientation,
        momentum: Self::Spin,
    ) -> Self::Spin;
    /// How a body is turned and spins after a time without moments.
    fn coast(
        inertia: Self::Inertia,
        orientation: Self::Orientation,
        spin: Self::Spin,
        time: Self::Real,
    ) -> (Self::Orientation, Self::Spin);
    /// The rate of the turn that leads from one orientation to another, once it is `turned` long, at a spin.
    ///
    /// Turns do not add in space, so the sum of a spin over time is no turn; the sum of this is.
    fn turn_rate(turned: Self::Spin, spin: Self::Spin) -> Self::Spin;
    /// The smallest principal moment of inertia (kg·m²) in one lane.
    fn least_inertia(inertia: Self::Inertia, lane: usize) -> f64;
    /// Rotational kinetic energy (J).
    fn spin_energy(
        inertia: Self::Inertia,
        rotation: Self::Rotation,
        spin: Self::Spin,
    ) -> Self::Real;
    /// The part of a vector that is tangent to a surface with this unit normal.
    fn tangential(vector: Self::Vector, normal: Self::Vector) -> Self::Tangent;
    /// A tangent as a vector.
    fn along(tangent: Self::Tangent, normal: Self::Vector) -> Self::Vector;
    /// What is kept with the tangents of a surface with this unit normal.
    fn tangent_plane(normal: Self::Vector) -> Self::TangentPlane;
    /// A tangent, turned from one tangent plane into another.
    fn carry(
        tangent: Self::Tangent,
        from: Self::TangentPlane,
        to: Self::TangentPlane,
    ) -> Self::Tangent;
    /// A tangent, no longer than `limit` (not negative).
    fn shorten(tangent: Self::Tangent, limit: Self::Real) -> Self::Tangent;
    /// `yes` where the mask holds, `no` elsewhere.
    fn choose(
        mask: <Self::Real as Real>::Mask,
        yes: Self::Tangent,
        no: Self::Tangent,
    ) -> Self::Tangent;
    /// The force and moment of viscous damping at a velocity: minus matrix times velocity.
    fn damp(
        damping: Self::Damping,
        linear: Self::Vector,
        spin: Self::Spin,
    ) -> (Self::Vector, Self::Spin);
}

/// Where a body is: its center of mass (m) and how it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<S: Space> {
    /// Position of the center of mass (m) in the inertial frame.
    pub position: S::Vector,
    /// How the body frame is turned.
    pub orientation: S::Orientation,
}

/// How a body moves: velocity of its center of mass (m/s) and angular velocity (rad/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<S: Space> {
    /// Velocity of the center of mass (m/s).
    pub linear: S::Vector,
    /// Angular velocity (rad/s).
    pub angular: S::Spin,
}

impl<S: Space> Default for Twist<S> {
    #[inline(always)]
    fn default() -> Self {
        Self { linear: S::Vector::default(), angular: S::Spin::default() }
    }
}

impl<S: Space> Twist<S> {
    /// `self + other · factor`.
    #[inline(always)]
    #[must_use]
    pub fn plus(self, other: Self, factor: S::Real) -> Self {
        Self {
            linear: self.linear + other.linear * factor,
            angular: self.angular + other.angular * factor,
        }
    }
}

impl<S: Space> Pose<S> {
    /// The pose after moving with a twist for a time (s).
    #[inline(always)]
    #[must_use]
    pub fn moved(self, twist: Twist<S>, time: S::Real) -> Self {
        Self {
            position: self.position + twist.linear * time,
            orientation: S::turn(self.orientation, twist.angular, time),
        }
    }

    /// Pose and twist after moving for a time (s) while no force acts.
    #[inline(always)]
    #[must_use]
    pub fn coasted(self, inertia: S::Inertia, twist: Twist<S>, time: S::Real) -> (Self, Twist<S>) {
        let (orientation, angular) = S::coast(inertia, self.orientation, twist.angular, time);
        let position = self.position + twist.linear * time;
        (Self { position, orientation }, Twist { linear: twist.linear, angular })
    }

    /// The way to another pose near it (m and rad): the twist that goes it in a unit of time.
    #[inline(always)]
    #[must_use]
    pub fn way_to(self, other: Self) -> Twist<S> {
        Twist {
            linear: other.position - self.position,
            angular: S::turn_between(self.orientation, other.orientation),
        }
    }
}

/// Force (N) and moment about the center of mass (N·m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench<S: Space> {
    /// Force (N).
    pub force: S::Vector,
    /// Moment about the center of mass (N·m).
    pub moment: S::Spin,
}

impl<S: Space> Default for Wrench<S> {
    #[inline(always)]
    fn default() -> Self {
        Self { force: S::Vector::default(), moment: S::Spin::default() }
    }
}

impl<S: Space> Wrench<S> {
    /// The sum of both.
    #[inline(always)]
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self { force: self.force + other.force, moment: self.moment + other.moment }
    }

    /// As many times it.
    #[inline(always)]
    #[must_use]
    pub fn times(self, factor: S::Real) -> Self {
        Self { force: self.force * factor, moment: self.moment * factor }
    }

    /// Power (W) on a body that moves with a twist; work (J) on one that went a way.
    #[inline(always)]
    pub fn power(self, twist: Twist<S>) -> S::Real {
        self.force.dot(twist.linear) + self.moment.dot(twist.angular)
    }
}

impl<S: Space> AddAssign for Wrench<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = self.plus(other);
    }
}
