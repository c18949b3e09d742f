//! Convex solids that touch at a point, along a line or over a face, and their contact patches.

use super::{Gap, Shape};
use crate::real::Real;
use crate::space::{Planar, Rotation2, Space, Vec2, Wrench};

/// A convex solid that touches at its deepest point or, where it lies flat on a surface, along a whole line or face.
pub trait Whole<S: Space>: Clone + PartialEq + std::fmt::Debug + Send + Sync + 'static {
    /// Visits the contact patches with a surface, in ascending order of [`Patch::first`] and in the frame of the
    /// surface. Patches without contact may be included; their distance is positive.
    ///
    /// `position` is the center of mass (m) of the solid's body, and `rotation` the rotation from the body frame to the
    /// frame of the surface. In lanes outside of `near`, patches need not be computed and may be passed to `visit` as
    /// patches without contact.
    fn meet(
        &self,
        surface: &S::Surface,
        position: S::Vector,
        rotation: S::Rotation,
        near: <S::Real as Real>::Mask,
        visit: impl FnMut(Patch<S>),
    );

    /// Returns the points that bear on a surface, if the contact consists of several separate points; the arguments are
    /// as in [`Whole::meet`].
    #[inline(always)]
    fn points(
        &self,
        _surface: &S::Surface,
        _position: S::Vector,
        _rotation: S::Rotation,
        _near: <S::Real as Real>::Mask,
    ) -> Option<Points<S>> {
        None
    }

    /// Returns a number that identifies the kind of the solid, such as capsule or block.
    fn kind(&self) -> u64;

    /// Returns the maximum number of tangential springs that the solid needs for one surface.
    fn most_sticks(&self) -> usize;

    /// Returns the center (m, in the body frame, relative to the center of mass) and the radius (m) of an enclosing
    /// ball.
    fn ball(&self) -> (S::Vector, S::Real);

    /// Returns the tributary length (m) of a contact.
    fn tributary_length(&self) -> S::Real;
}

/// A point of a body, and its gap to the surface of another body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch<S: Space> {
    /// The point (m), in the frame of the surface.
    pub node: S::Vector,
    /// The gap at the point.
    pub gap: Gap<S>,
}

impl<S: Space> Touch<S> {
    /// Returns the companion point (m) on the surface.
    #[inline(always)]
    pub(crate) fn companion(&self) -> S::Vector {
        self.node - self.gap.normal * self.gap.distance
    }
}

/// Contact of two bodies: a point contact, or a contact along a line or over a face that they share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch<S: Space> {
    /// Index of the first tangential spring of the patch; less than [`Whole::most_sticks`].
    pub first: usize,
    /// Deepest point of the patch.
    pub deepest: Touch<S>,
    /// Extent of the patch; `None` for a point contact.
    pub spread: Option<Spread<S>>,
}

/// Points that act like parallel springs, with friction at their center of pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Points<S: Space> {
    /// The points.
    pub points: [Bearing<S>; MOST_POINTS],
    /// Unit vectors in the planes of the touching faces, two for each body. The tangential springs are placed on the
    /// lines through the center of pressure in these directions.
    pub axes: [S::Vector; 4],
}

/// Maximum number of bearing points. The polygon that two rectangles share has up to 8 corners and is computed twice,
/// once from each body; the deepest point is added.
pub const MOST_POINTS: usize = 17;

/// A point of [`Points`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bearing<S: Space> {
    /// Point of contact.
    pub touch: Touch<S>,
    /// Weight of the point: the number of springs that it represents, which need not be an integer.
    pub share: S::Real,
    /// Derivative of `share` with respect to the rotation of the contactor (1/rad).
    pub turning: S::Spin,
}

/// Extent of a patch. The pressure on the patch depends on the depth δ of its deepest point and the depth δ₀ of its
/// middle.
///
/// A line acts like two springs: one at its deepest point, and one at the mirror image of that point on the other side
/// of the middle, at the depth `2 δ₀ − δ`. A face has two more springs in the middle. The energy
///
/// ```text
/// E = a U(δ) + b (U(2 δ₀ − δ) + n U(δ₀))      n = 0 for a line, 2 for a face
/// ```
///
/// contains the energy `U` of one spring as a function of its depth. With `a = b = 1`, `E` equals, at any rotation, the
/// energy of a capsule supported at its two ends, or of a disc supported at four points of its rim. When two bodies
/// that lie flat on each other start to rock, the deepest point moves from one end to the other. At that moment the
/// part of the force at the deepest point, `a U′(δ) − b U′(2 δ₀ − δ)`, vanishes if `a = b`, so neither force nor moment
/// jumps. A patch that shrinks to a point has the stiffness of one spring, so there `a = b = 1/(2 + n)`.
///
/// As bodies slide and turn, `a`, `b` and the position of the middle change as well, and so does the energy. The
/// corresponding forces close the energy balance, for example for a capsule that slides off the head of a barrel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread<S: Space> {
    /// Middle of the patch.
    pub middle: Touch<S>,
    /// Weights of the parts of the patch.
    pub shares: Shares<S::Real>,
    /// Half the length (m) of a line; for a face, the distance (m) from its middle to the nearest point of its edge.
    pub radius: S::Real,
    /// Unit vectors along the patch, which turn with one of the bodies. The tangential springs are placed at the center
    /// of pressure and on the lines through it in these directions.
    pub axes: Axes<S>,
    /// Derivatives with respect to the motion of the bodies.
    pub slopes: Slopes<S>,
}

/// Derivatives of the quantities of a patch with respect to the motion of the contactor relative to the target: with
/// respect to its displacement (1/m), stored in [`Wrench::force`], and with respect to its rotation about its center of
/// mass (1/rad), stored in [`Wrench::moment`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slopes<S: Space> {
    /// Derivative of the depth δ₀ (m) at the middle of the patch, without the part due to the motion of the bodies at
    /// the middle. What remains is the change of the depth because the middle shifts to other points of the bodies.
    pub middle: Wrench<S>,
    /// Derivative of `a`, the weight of the deepest point.
    pub deepest: Wrench<S>,
    /// Derivative of `b`, the weight of all springs except the one at the deepest point.
    pub others: Wrench<S>,
}

impl<S: Space> Default for Slopes<S> {
    #[inline(always)]
    fn default() -> Self {
        let none = Wrench::default();
        Self { middle: none, deepest: none, others: none }
    }
}

/// Weights of the parts of a patch, each between 0 and 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares<R> {
    /// Weight of the spring at the deepest point, `a` in [`Spread`].
    pub deepest: R,
    /// Weight of all other springs, `b` in [`Spread`]; less than `a` only if the bodies are inclined to each other.
    pub others: R,
    /// Maximum share of the friction that acts at a distance from the center of pressure; zero for a point contact.
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
    /// Returns the axes as a slice: one for a line, two for a face.
    #[inline(always)]
    pub(crate) fn all(&self) -> &[S::Vector] {
        match self {
            Self::Line(axis) => axis,
            Self::Face(axes) => axes,
        }
    }

    /// Returns the number of springs in the middle of the patch, `n` in [`Spread`].
    #[inline(always)]
    pub(crate) fn in_the_middle(&self) -> f64 {
        match self {
            Self::Line(_) => 0.0,
            Self::Face(_) => 2.0,
        }
    }
}

/// Uninhabited type, because there are no [`Whole`] solids in the plane. Planar convex boundaries touch with their
/// round pieces ([`Round`](crate::body::Round)) instead.
#[derive(Clone, Debug, PartialEq)]
pub enum NoWhole {}

impl<R: Real> Whole<Planar<R>> for NoWhole {
    #[inline(always)]
    fn meet(
        &self,
        _: &Shape<R>,
        _: Vec2<R>,
        _: Rotation2<R>,
        _: R::Mask,
        _: impl FnMut(Patch<Planar<R>>),
    ) {
        match *self {}
    }
    fn kind(&self) -> u64 {
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
