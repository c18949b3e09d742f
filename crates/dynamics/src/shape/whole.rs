//! Convex bodies that touch as wholes, and their contact patches.

use super::{Gap, Shape};
use crate::real::Real;
use crate::space::{Planar, Rotation2, Space, Vec2, Wrench};

/// A convex body that touches as a whole: with its deepest point, or with all of a line or a face where it lies flat.
pub trait Whole<S: Space>: Clone + PartialEq + std::fmt::Debug + Send + Sync + 'static {
    /// Visits the patches in which it touches a surface, some possibly open, in the order of their sticks; all in the
    /// frame of the surface.
    ///
    /// `position` is the center of mass (m) of its body, `rotation` transforms from the body frame to that of the
    /// surface.
    fn meet(
        &self,
        surface: &S::Surface,
        position: S::Vector,
        rotation: S::Rotation,
        visit: impl FnMut(Patch<S>),
    );

    /// Returns the points in which it bears on a surface, if these are several separate points; all as in
    /// [`Whole::meet`].
    #[inline(always)]
    fn points(
        &self,
        _surface: &S::Surface,
        _position: S::Vector,
        _rotation: S::Rotation,
    ) -> Option<Points<S>> {
        None
    }

    /// Returns the maximum number of sticks with one surface.
    fn most_sticks(&self) -> usize;

    /// Returns center, in the body frame from the center of mass, and radius (m) of an enclosing ball.
    fn ball(&self) -> (S::Vector, S::Real);

    /// Returns the tributary length of boundary (m) of a contact.
    fn tributary_length(&self) -> S::Real;
}

/// A point of a body, and its distance from the surface of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch<S: Space> {
    /// The point (m).
    pub node: S::Vector,
    /// Its distance and normal.
    pub gap: Gap<S>,
}

impl<S: Space> Touch<S> {
    /// Returns the companion point (m) on the surface.
    #[inline(always)]
    pub(crate) fn companion(&self) -> S::Vector {
        self.node - self.gap.normal * self.gap.distance
    }
}

/// Contact of two bodies: in a point, or along a line or a face that they share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch<S: Space> {
    /// Index of its first stick, of [`Whole::most_sticks`].
    pub first: usize,
    /// Its deepest point.
    pub deepest: Touch<S>,
    /// Its extent; `None` for a point.
    pub spread: Option<Spread<S>>,
}

/// Points that bear like parallel springs, with friction at their center of pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Points<S: Space> {
    /// The points.
    pub points: [Bearing<S>; MOST_POINTS],
    /// Unit vectors along the faces of both bodies in which they lie, for their sticks.
    pub axes: [S::Vector; 4],
}

/// Maximum number of bearing points: the corners of the polygon that two rectangles share, as either body has it, and
/// the deepest.
pub const MOST_POINTS: usize = 17;

/// A point of [`Points`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bearing<S: Space> {
    /// Point of contact.
    pub touch: Touch<S>,
    /// Number of springs that it represents.
    pub share: S::Real,
    /// Derivative of `share` with respect to the rotation of the contactor (1/rad).
    pub turning: S::Spin,
}

/// Extent of a patch, which presses according to the depth of its deepest point, δ, and that of its middle, δ₀.
///
/// A line bears like springs at its deepest point and at the mirror image of that beyond the middle, of depth `2 δ₀ −
/// δ`; a face like two more in the middle. The energy
///
/// ```text
/// E = a U(δ) + b (U(2 δ₀ − δ) + n U(δ₀))      n = 0 for a line, 2 for a face
/// ```
///
/// is with `a = b = 1` that of a tube on its two ends and of a disc on four points of its rim, at any rotation. Where
/// bodies lie flat the deepest point runs from end to end as they rock, but there its part of the force, `a U′(δ) − b
/// U′(2 δ₀ − δ)`, vanishes if `a = b`, so neither force nor moment jumps. A patch that shrinks to a point has the
/// stiffness of one spring, so there `a = b = 1/(2 + n)`.
///
/// As bodies slide and turn, `a`, `b` and the position of the middle change as well, and with them the energy: the
/// corresponding forces keep the energy balance closed, for example for a tube that slides off a head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread<S: Space> {
    /// Its middle.
    pub middle: Touch<S>,
    /// Weights of its parts.
    pub shares: Shares<S::Real>,
    /// Extent (m) from its middle.
    pub radius: S::Real,
    /// Unit vectors along it that turn with a body, for its sticks.
    pub axes: Axes<S>,
    /// Derivatives with respect to the motion of the bodies.
    pub slopes: Slopes<S>,
}

/// Derivatives of a patch with respect to the motion of its contactor relative to its target: displacement (1/m) and
/// rotation about the center of mass of the contactor (1/rad), as forces and moments are of energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slopes<S: Space> {
    /// Of δ₀ (m): the part beyond that of the material points currently at the middle.
    pub middle: Wrench<S>,
    /// Of `a`.
    pub deepest: Wrench<S>,
    /// Of `b`.
    pub others: Wrench<S>,
}

/// Weights of the parts of a patch, each between 0 and 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares<R> {
    /// `a` of [`Spread`].
    pub deepest: R,
    /// `b` of [`Spread`]; less than `a` only if the bodies are rotated out of the plane of the patch.
    pub others: R,
    /// Share of the friction that may act beside the center of pressure; zero for a point.
    pub aside: R,
}

/// Directions in which a patch extends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axes<S: Space> {
    /// A line.
    Line([S::Vector; 1]),
    /// A face.
    Face([S::Vector; 2]),
}

impl<S: Space> Axes<S> {
    /// Returns all axes.
    #[inline(always)]
    pub(crate) fn all(&self) -> &[S::Vector] {
        match self {
            Self::Line(axis) => axis,
            Self::Face(axes) => axes,
        }
    }

    /// Returns `n` of [`Spread`].
    #[inline(always)]
    pub(crate) fn in_the_middle(&self) -> f64 {
        match self {
            Self::Line(_) => 0.0,
            Self::Face(_) => 2.0,
        }
    }
}

/// Empty type: in the plane nothing touches as a whole, since a convex boundary is a chain of round pieces
/// ([`Round`](crate::body::Round)).
#[derive(Clone, Debug, PartialEq)]
pub enum NoWhole {}

impl<R: Real> Whole<Planar<R>> for NoWhole {
    #[inline(always)]
    fn meet(&self, _: &Shape<R>, _: Vec2<R>, _: Rotation2<R>, _: impl FnMut(Patch<Planar<R>>)) {
        match *self {}
    }
    fn most_sticks(&self) -> usize {
        match *self {}
    }
    fn ball(&self) -> (Vec2<R>, R) {
        match *self {}
    }
    fn tributary_length(&self) -> R {
        match *self {}
    }
}
