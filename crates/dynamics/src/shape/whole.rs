//! Convex bodies that touch as wholes, and the patches of their surfaces that do.

use super::{Gap, Shape};
use crate::real::Real;
use crate::space::{Planar, Rotation2, Space, Vec2, Wrench};

/// A convex body that touches as a whole: with the point of it that lies deepest, and with all of a line or
/// a face where it lies flat.
pub trait Whole<S: Space>: Clone + PartialEq + std::fmt::Debug + Send + Sync + 'static {
    /// Visits the patches in which it touches a surface, of which some may be apart, in the order of their
    /// sticks; all in the frame of the surface.
    ///
    /// `position` is the center of mass (m) of the body that carries it, `rotation` leads from there to the
    /// frame of the surface.
    fn meet(
        &self,
        surface: &S::Surface,
        position: S::Vector,
        rotation: S::Rotation,
        visit: impl FnMut(Patch<S>),
    );

    /// The points in which it bears on a surface, where these are several that are known each by itself; all
    /// as in [`Whole::meet`].
    #[inline(always)]
    fn points(
        &self,
        _surface: &S::Surface,
        _position: S::Vector,
        _rotation: S::Rotation,
    ) -> Option<Points<S>> {
        None
    }

    /// How many sticks contacts with one surface may have.
    fn most_sticks(&self) -> usize;

    /// Center, in the body frame from the center of mass, and radius (m) of a ball that holds it.
    fn ball(&self) -> (S::Vector, S::Real);

    /// Length of boundary (m) that a contact stands for.
    fn tributary_length(&self) -> S::Real;
}

/// A point of a body, and how far it is from the surface of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch<S: Space> {
    /// The point (m).
    pub node: S::Vector,
    /// Its distance and normal.
    pub gap: Gap<S>,
}

impl<S: Space> Touch<S> {
    /// The companion point (m) on the surface.
    #[inline(always)]
    pub(crate) fn companion(&self) -> S::Vector {
        self.node - self.gap.normal * self.gap.distance
    }
}

/// Where two bodies touch: in a point, or along a line or a face that they share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch<S: Space> {
    /// Its first stick, of [`Whole::most_sticks`].
    pub first: usize,
    /// Its deepest point.
    pub deepest: Touch<S>,
    /// How it extends from there; none where it is a point.
    pub spread: Option<Spread<S>>,
}

/// Points that bear like springs side by side, their friction at what they bear together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Points<S: Space> {
    /// Each of them.
    pub points: [Bearing<S>; MOST_POINTS],
    /// Unit vectors along the face in which they lie: where their sticks are.
    pub axes: [S::Vector; 2],
}

/// How many points bear at a time: the corners of the polygon that two rectangles share, and the deepest.
pub const MOST_POINTS: usize = 9;

/// A point of [`Points`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bearing<S: Space> {
    /// Where it touches.
    pub touch: Touch<S>,
    /// How many springs it stands for.
    pub share: S::Real,
    /// By how much that grows (1/rad) as the contactor turns.
    pub turning: S::Spin,
}

/// How a patch extends: how hard it presses is told by the depth of its deepest point, δ, and that of its
/// middle, δ₀.
///
/// A line bears like springs at its deepest point and at the mirror image of that beyond the middle, of
/// depth `2 δ₀ − δ`; a face like two more in the middle. The energy
///
/// ```text
/// E = a U(δ) + b (U(2 δ₀ − δ) + n U(δ₀))      n = 0 for a line, 2 for a face
/// ```
///
/// is with `a = b = 1` that of a tube on its two ends and of a disc on four points of its rim, however these
/// are turned. Where bodies lie flat the deepest point runs from end to end as they rock, but there its
/// part of the force, `a U′(δ) − b U′(2 δ₀ − δ)`, is none as long as `a = b`, so neither force nor moment
/// jumps. A patch that shrinks to a point has the stiffness of one spring, so there `a = b = 1/(2 + n)`.
///
/// As bodies slide and turn, `a`, `b` and where the middle lies change as well, and with them the energy: that takes
/// forces of its own, without which the books would miss what a tube stores that slides off a head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread<S: Space> {
    /// Its middle.
    pub middle: Touch<S>,
    /// How much each part of it counts.
    pub shares: Shares<S::Real>,
    /// How far (m) it extends from its middle.
    pub radius: S::Real,
    /// Unit vectors along it that turn with a body: where its sticks are.
    pub axes: Axes<S>,
    /// How it changes as the bodies move.
    pub slopes: Slopes<S>,
}

/// How a patch changes as its contactor moves against its target: each per way (1/m) and per turn about the center of
/// mass of the contactor (1/rad), as forces and moments are to energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slopes<S: Space> {
    /// Of δ₀ (m): what the points of the bodies that are its middle at that moment do not tell.
    pub middle: Wrench<S>,
    /// Of `a`.
    pub deepest: Wrench<S>,
    /// Of `b`.
    pub others: Wrench<S>,
}

/// How much each part of a patch counts, each between 0 and 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares<R> {
    /// `a` of [`Spread`].
    pub deepest: R,
    /// `b`: less than `a` only where bodies are turned out of the patch.
    pub others: R,
    /// How much of the friction may lie aside of the center of pressure; none where the patch is a point.
    pub aside: R,
}

/// Along what a patch extends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axes<S: Space> {
    /// A line.
    Line([S::Vector; 1]),
    /// A face.
    Face([S::Vector; 2]),
}

impl<S: Space> Axes<S> {
    /// All of them.
    #[inline(always)]
    pub(crate) fn all(&self) -> &[S::Vector] {
        match self {
            Self::Line(axis) => axis,
            Self::Face(axes) => axes,
        }
    }

    /// `n` of [`Spread`].
    #[inline(always)]
    pub(crate) fn in_the_middle(&self) -> f64 {
        match self {
            Self::Line(_) => 0.0,
            Self::Face(_) => 2.0,
        }
    }
}

/// What touches as a whole in the plane: nothing, since there a convex boundary is a chain of round
/// pieces ([`Round`](crate::body::Round)).
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
