//! Kinematics of rigid motion in two and three dimensions.
//!
//! Contact laws, the contact loop, the integrators, the energy ledger and the run loop are generic over [`Space`], and
//! so independent of the number of dimensions. [`Planar`] is motion in a vertical plane, [`Spatial`] motion in three
//! dimensions.

mod planar;
mod spatial;
mod vector;

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use crate::lanes::Lanewise;
use crate::real::Real;

pub use planar::{Planar, Rotation2, Vec2};
pub use spatial::Spatial;
pub use vector::{Quaternion, Rotation3, Vec3};

/// Common interface of vectors, spins and tangents: addition and scaling.
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
    /// Returns the scalar product.
    fn dot(self, other: Self) -> R;
}

/// Rigid motion in two or three dimensions: the types and operations over which the physics code is generic.
pub trait Space: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// `true` if bodies often consist of several solids. The relative kinematics of a body and a target surface are
    /// then reused for the next contact pair of the same body and surface.
    const SOLIDS_SHARE: bool;

    /// The scalar.
    type Real: Real;
    /// The same space with `f64` as its scalar, for one lane of a bundle.
    type Single: Space<Real = f64>;
    /// Positions (m), velocities (m/s) and forces (N).
    type Vector: Linear<Self::Real> + Lanewise<Single = <Self::Single as Space>::Vector>;
    /// Angular velocities (rad/s) and moments (N·m).
    type Spin: Linear<Self::Real> + Lanewise<Single = <Self::Single as Space>::Spin>;
    /// Orientation of a body, advanced by the integrator.
    type Orientation: Copy
        + Debug
        + PartialEq
        + Send
        + Sync
        + Lanewise<Single = <Self::Single as Space>::Orientation>
        + 'static;
    /// Rotation that can be applied to vectors; computed once from an orientation.
    type Rotation: Copy
        + Debug
        + PartialEq
        + Send
        + Sync
        + Lanewise<Single = <Self::Single as Space>::Rotation>
        + 'static;
    /// Moment of inertia about the center of mass (kg·m²).
    type Inertia: Copy
        + Debug
        + PartialEq
        + Send
        + Sync
        + Lanewise<Single = <Self::Single as Space>::Inertia>
        + 'static;
    /// A displacement (m), velocity (m/s) or force (N) in the tangent plane of a contact.
    type Tangent: Linear<Self::Real> + Lanewise<Single = <Self::Single as Space>::Tangent>;
    /// Data stored with a tangent, so that the tangent can be transported along a curved surface: the normal in three
    /// dimensions; nothing in the plane, where a tangent is a scalar.
    type TangentPlane: Copy
        + Debug
        + Default
        + PartialEq
        + Send
        + Sync
        + Lanewise<Single = <Self::Single as Space>::TangentPlane>
        + 'static;
    /// Viscous damping matrix of a body.
    type Damping: Copy
        + Debug
        + PartialEq
        + Send
        + Sync
        + Lanewise<Single = <Self::Single as Space>::Damping>
        + 'static;
    /// Type of the surfaces that can be the target of a contact.
    type Surface: crate::shape::Surface<Self> + Lanewise<Single = <Self::Single as Space>::Surface>;
    /// Type of the convex solids that touch a target surface at their deepest point, or along a whole line or face.
    ///
    /// In the plane, this type is uninhabited, because the contacts of a convex boundary are those of its corners and
    /// arcs ([`Round`](crate::body::Round)).
    type Whole: crate::shape::Whole<Self> + Lanewise<Single = <Self::Single as Space>::Whole>;

    /// Returns the rotation from the body frame to the inertial frame for an orientation.
    fn rotation(orientation: Self::Orientation) -> Self::Rotation;
    /// Transforms a vector from the rotated frame to the outer frame.
    fn rotate(rotation: Self::Rotation, vector: Self::Vector) -> Self::Vector;
    /// Transforms a vector from the outer frame to the rotated frame.
    fn unrotate(rotation: Self::Rotation, vector: Self::Vector) -> Self::Vector;
    /// Returns the rotation that applies `inner` first and then `outer`.
    fn compose(outer: Self::Rotation, inner: Self::Rotation) -> Self::Rotation;
    /// Returns the rotation from the frame of `inner` to the frame of `outer`.
    fn relative(outer: Self::Rotation, inner: Self::Rotation) -> Self::Rotation;
    /// Transforms a spin or moment from the outer frame to the rotated frame.
    fn unrotate_spin(rotation: Self::Rotation, spin: Self::Spin) -> Self::Spin;
    /// Transforms a spin or moment from the rotated frame to the outer frame.
    fn rotate_spin(rotation: Self::Rotation, spin: Self::Spin) -> Self::Spin;
    /// Returns the velocity, due to a spin, of a point P of a body relative to a point Q of the body. `arm` is the
    /// vector from Q to P.
    fn velocity_at(spin: Self::Spin, arm: Self::Vector) -> Self::Vector;
    /// Returns an upper bound on the length of a vector. The bound is cheaper to compute than the length, and close to
    /// the length for most vectors.
    fn length_bound(vector: Self::Vector) -> Self::Real;
    /// Returns the first coordinate of a vector; bodies are sorted by this coordinate to find neighbors.
    fn first_coordinate(vector: Self::Vector) -> Self::Real;
    /// Returns the magnitude of a spin.
    fn spin_magnitude(spin: Self::Spin) -> Self::Real;
    /// Returns the moment of a force that acts at `arm`.
    fn moment(arm: Self::Vector, force: Self::Vector) -> Self::Spin;
    /// Returns the orientation after rotation with a constant spin (rad/s) for a time (s).
    fn turn(
        orientation: Self::Orientation,
        spin: Self::Spin,
        time: Self::Real,
    ) -> Self::Orientation;
    /// Returns the rotation (rad) from one orientation to a nearby one, as the spin (rad/s) that causes this
    /// rotation in one second.
    fn turn_between(from: Self::Orientation, to: Self::Orientation) -> Self::Spin;
    /// Returns the angle (rad) between two orientations, or an upper bound on this angle.
    fn angle_between(a: Self::Orientation, b: Self::Orientation) -> Self::Real;
    /// Returns the angular acceleration due to a moment alone; [`Space::coast`] and [`Space::momentum`] account for the
    /// torque-free part.
    fn spin_rate(
        inertia: Self::Inertia,
        rotation: Self::Rotation,
        moment: Self::Spin,
    ) -> Self::Spin;
    /// Returns the rotational quantity that is conserved if no moment acts: in three dimensions the angular momentum,
    /// and in the plane the spin, which differs from the angular momentum only by a constant factor.
    fn momentum(inertia: Self::Inertia, rotation: Self::Rotation, spin: Self::Spin) -> Self::Spin;
    /// Returns the spin of a body, given its [`Space::momentum`].
    fn spin_of(
        inertia: Self::Inertia,
        orientation: Self::Orientation,
        momentum: Self::Spin,
    ) -> Self::Spin;
    /// Returns the orientation and the spin after a time (s) during which no moment acts.
    fn coast(
        inertia: Self::Inertia,
        orientation: Self::Orientation,
        spin: Self::Spin,
        time: Self::Real,
    ) -> (Self::Orientation, Self::Spin);
    /// Returns the time derivative of the rotation vector `turned` of a body that rotates with the given spin.
    ///
    /// In three dimensions rotations are not additive, so the integral of a spin over time is not a rotation vector.
    /// The integral of the derivative returned here is a rotation vector.
    fn turn_rate(turned: Self::Spin, spin: Self::Spin) -> Self::Spin;
    /// Returns the smallest principal moment of inertia (kg·m²) in one lane.
    fn least_inertia(inertia: Self::Inertia, lane: usize) -> f64;
    /// Returns the rotational kinetic energy (J).
    fn spin_energy(
        inertia: Self::Inertia,
        rotation: Self::Rotation,
        spin: Self::Spin,
    ) -> Self::Real;
    /// Returns the tangential component of a vector, for a surface with this unit normal.
    fn tangential(vector: Self::Vector, normal: Self::Vector) -> Self::Tangent;
    /// Converts a tangent to a vector, for a surface with this unit normal.
    fn along(tangent: Self::Tangent, normal: Self::Vector) -> Self::Vector;
    /// Returns the data that are stored with a tangent to a surface. `normal` is the unit normal of the surface in a
    /// rotated frame, and `rotation` is the rotation from that frame to the inertial frame.
    fn tangent_plane(rotation: Self::Rotation, normal: Self::Vector) -> Self::TangentPlane;
    /// Transports a tangent from one tangent plane into another.
    fn carry(
        tangent: Self::Tangent,
        from: Self::TangentPlane,
        to: Self::TangentPlane,
    ) -> Self::Tangent;
    /// Transforms a tangent from a rotated frame to the inertial frame.
    fn rotate_tangent(rotation: Self::Rotation, tangent: Self::Tangent) -> Self::Tangent;
    /// Transforms a tangent from the inertial frame to a rotated frame.
    fn unrotate_tangent(rotation: Self::Rotation, tangent: Self::Tangent) -> Self::Tangent;
    /// Returns the rate (m/s, in the inertial frame) at which the displacement of a tangential spring changes because
    /// the spring rotates about the contact normal.
    ///
    /// The spring rotates with the mean spin of the two bodies. `spins` contains the spin (rad/s) of one body, and the
    /// spin of the other body relative to it. `rotation` is the rotation from the frame of `spins` to the inertial
    /// frame.
    fn stick_turn(
        displacement: Self::Tangent,
        plane: Self::TangentPlane,
        rotation: Self::Rotation,
        spins: [Self::Spin; 2],
    ) -> Self::Tangent;
    /// Adds `turn`, the result of [`Space::stick_turn`], to the slip rate `tangent` (m/s), in lanes where the mask is
    /// set.
    fn add_turn(
        mask: <Self::Real as Real>::Mask,
        tangent: Self::Tangent,
        turn: Self::Tangent,
    ) -> Self::Tangent;
    /// Shortens a tangent to the length `limit` (not negative) if it is longer.
    fn shorten(tangent: Self::Tangent, limit: Self::Real) -> Self::Tangent;
    /// Returns `yes` in lanes where the mask is set, and `no` in all other lanes.
    fn choose(
        mask: <Self::Real as Real>::Mask,
        yes: Self::Tangent,
        no: Self::Tangent,
    ) -> Self::Tangent;
    /// Returns `yes` in lanes where the mask is set, and `no` in all other lanes.
    fn choose_vector(
        mask: <Self::Real as Real>::Mask,
        yes: Self::Vector,
        no: Self::Vector,
    ) -> Self::Vector;
    /// Returns `yes` in lanes where the mask is set, and `no` in all other lanes.
    fn choose_plane(
        mask: <Self::Real as Real>::Mask,
        yes: Self::TangentPlane,
        no: Self::TangentPlane,
    ) -> Self::TangentPlane;
    /// Returns the force and the moment of viscous damping: the negative product of the damping matrix and the
    /// velocity.
    fn damp(
        damping: Self::Damping,
        linear: Self::Vector,
        spin: Self::Spin,
    ) -> (Self::Vector, Self::Spin);
}

/// Pose of a body: position of its center of mass (m), and orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<S: Space> {
    /// Position of the center of mass (m) in the inertial frame.
    pub position: S::Vector,
    /// Orientation of the body frame.
    pub orientation: S::Orientation,
}

/// Twist of a body: velocity of its center of mass (m/s) and angular velocity (rad/s).
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
    /// Returns `self + other · factor`.
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
    /// Returns the pose after motion with a constant twist for a time (s).
    #[inline(always)]
    #[must_use]
    pub fn moved(self, twist: Twist<S>, time: S::Real) -> Self {
        Self {
            position: self.position + twist.linear * time,
            orientation: S::turn(self.orientation, twist.angular, time),
        }
    }

    /// Returns the pose and the twist after force-free motion for a time (s).
    #[inline(always)]
    #[must_use]
    pub fn coasted(self, inertia: S::Inertia, twist: Twist<S>, time: S::Real) -> (Self, Twist<S>) {
        let (orientation, angular) = S::coast(inertia, self.orientation, twist.angular, time);
        let position = self.position + twist.linear * time;
        (Self { position, orientation }, Twist { linear: twist.linear, angular })
    }

    /// Returns the displacement (m and rad) to a nearby pose, as the twist that causes this displacement in one
    /// second.
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
    /// Returns the sum.
    #[inline(always)]
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self { force: self.force + other.force, moment: self.moment + other.moment }
    }

    /// Returns the wrench scaled by a factor.
    #[inline(always)]
    #[must_use]
    pub fn times(self, factor: S::Real) -> Self {
        Self { force: self.force * factor, moment: self.moment * factor }
    }

    /// Returns the power (W) of the wrench for a twist, or its work (J) for a displacement.
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
