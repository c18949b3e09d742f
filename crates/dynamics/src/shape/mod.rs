//! Boundaries: the surface Φ = 0 of a target, and the nodes of a contactor.
//!
//! A shape computes, in its own frame, the distance of a point from its surface and the normal ([`Surface::gap`]), its
//! boundary nodes, its outline for drawing, and the mass distribution of its section. Each file has one shape;
//! [`Shape`] lists them.

mod circle;
mod cradle;
mod half_plane;
mod polygon;
mod profile;
mod whole;

use crate::body::Round;
use crate::real::{Mask, Real, both};
use crate::space::{Linear, Planar, Space, Vec2};

use polygon::FLUSH;

pub use circle::Circle;
pub use cradle::Cradle;
pub use half_plane::HalfPlane;
pub use polygon::{Polygon, PolygonError};
pub use profile::BarrelProfile;
pub use whole::{
    Axes, Bearing, MOST_POINTS, NoWhole, Patch, Points, Shares, Slopes, Spread, Touch, Whole,
};

/// Signed distance of a point from a surface, and the normal of the surface at the companion point, which is the point
/// of the surface from which the distance is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap<S: Space> {
    /// Distance (m) from the surface to the point along `normal`; **negative when penetrating**.
    pub distance: S::Real,
    /// Unit normal at the companion point; points out of the target.
    pub normal: S::Vector,
}

/// Distance of a point from a surface, and the nearest piece of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest<S: Space> {
    /// Distance and normal.
    pub gap: Gap<S>,
    /// `true` if the piece is round: a corner or an arc.
    pub round: <S::Real as Real>::Mask,
    /// Distance (m) from the companion point to the nearer end of a straight piece; infinite for a piece without ends.
    pub to_end: S::Real,
    /// Unit vector along the straight piece toward its nearer end.
    pub toward_end: S::Vector,
    /// Signed distance (m) of the point from the core, which is the shape without its rounding.
    pub core: S::Real,
}

impl<S: Space> Nearest<S> {
    /// Creates the result for a piece without ends; `round` contains the lanes in which the piece is round.
    #[inline(always)]
    pub(crate) fn endless(gap: Gap<S>, round: <S::Real as Real>::Mask) -> Self {
        let to_end = S::Real::splat(f64::INFINITY);
        Self { gap, round, to_end, toward_end: S::Vector::default(), core: gap.distance }
    }
}

/// Range of the outward normals of a body's boundary at a point, such as a corner. The range decides on which pieces of
/// another body's surface the point can bear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facing<S: Space> {
    /// Unit vectors that limit the range, defined like [`Round::limits`], but in the frame of the other body's surface.
    pub limits: [S::Vector; 2],
    /// Maximum permitted value of `−n · limit` for each of the two limits, where `n` is the outward normal of a piece
    /// of the other surface. If either value is greater, the point cannot bear on this piece.
    pub most: f64,
    /// Tolerance (m) at the sides of the other surface that the range excludes. A point outside of such a side by less
    /// than this distance can still count as inside the core. For a point farther outside, [`Surface::bearing`] returns
    /// the nearest piece.
    pub slack: f64,
}

impl<S: Space> Facing<S> {
    /// Creates the range for a point from an outward unit normal. At a corner, `normal` is the mean of the normals of
    /// both sides. The range extends to 70° from `normal`, so it includes the normals of both sides of a right-angled
    /// corner.
    #[inline(always)]
    pub(crate) fn outward(normal: S::Vector) -> Self {
        Self { limits: [-normal; 2], most: -0.35, slack: FLUSH }
    }

    /// Returns the lanes in which the point can bear on a piece with the given outward normal.
    #[inline(always)]
    pub(crate) fn includes(&self, normal: S::Vector) -> <S::Real as Real>::Mask {
        let most = S::Real::splat(self.most);
        let [a, b] = both(
            self.limits,
            #[inline(always)]
            |limit| -normal.dot(limit),
        );
        a.le(most) & b.le(most)
    }
}

impl<R: Real> Nearest<Planar<R>> {
    /// Returns `self` in lanes where `holds` is set, and `other` in all other lanes.
    #[inline(always)]
    fn where_it(self, holds: R::Mask, other: Self) -> Self {
        Self {
            gap: Gap {
                distance: R::select(holds, self.gap.distance, other.gap.distance),
                normal: Vec2::select(holds, self.gap.normal, other.gap.normal),
            },
            round: (holds & self.round) | (!holds & other.round),
            to_end: R::select(holds, self.to_end, other.to_end),
            toward_end: Vec2::select(holds, self.toward_end, other.toward_end),
            core: R::select(holds, self.core, other.core),
        }
    }
}

/// A target surface; all points are in its own frame.
pub trait Surface<S: Space>: Clone + PartialEq + std::fmt::Debug + Send + Sync + 'static {
    /// Returns the signed distance (m) of a point (m) from the surface, and the outward normal at the companion point.
    fn gap(&self, point: S::Vector) -> Gap<S>;

    /// Returns the number of straight sides of a polygon; zero for all other shapes.
    fn side_count(&self) -> usize {
        0
    }

    /// Returns the gap and the nearest piece of the boundary.
    ///
    /// A straight side is extended at both ends by `slack` (m), or shortened if `slack` is negative. So where a corner
    /// of another body coincides with an end of a side, the sign of `slack` and not a rounding error decides whether
    /// the corner lies in front of the side.
    fn nearest(&self, point: S::Vector, slack: S::Real) -> Nearest<S>;

    /// Returns the piece on which a boundary point of another body bears. For a point inside the core, this is the
    /// nearest piece that the [`Facing`] range permits. For all other points, and where the range permits no piece,
    /// the result is `nearest`.
    ///
    /// A point inside does not always press into the nearest piece: a corner of a box that stands flush on an equal box
    /// lies on a side of the lower box, but presses on its top. So the result depends on the outward normals of the
    /// other body's boundary at this point.
    #[inline(always)]
    fn bearing(&self, _point: S::Vector, _facing: &Facing<S>, nearest: Nearest<S>) -> Nearest<S> {
        nearest
    }

    /// Returns `true` wherever `gap(point).distance < 0`, and possibly elsewhere. This test is cheaper than computing
    /// the gap.
    #[inline(always)]
    fn may_touch(&self, point: S::Vector) -> <S::Real as Real>::Mask {
        self.gap(point).distance.lt(S::Real::zero())
    }

    /// Calls `visit` with the index, the position (m) and the gap of every point that penetrates the surface in at
    /// least one lane, in ascending order of the index.
    ///
    /// The indices are `0..count`. For an index, `point` returns the position of the point, and `facing` returns the
    /// range of the outward normals of the boundary there, if known.
    #[inline(always)]
    fn penetrated_by(
        &self,
        count: usize,
        point: impl Fn(usize) -> S::Vector,
        _facing: impl Fn(usize) -> Option<Facing<S>>,
        mut visit: impl FnMut(usize, S::Vector, Gap<S>),
    ) {
        for index in 0..count {
            let point = point(index);
            if self.may_touch(point).any() {
                let gap = self.gap(point);
                if gap.distance.lt(S::Real::zero()).any() {
                    visit(index, point, gap);
                }
            }
        }
    }

    /// Returns lanes in which a round piece of the surface is [nearest](Self::nearest) to a point (m), and no straight side
    /// can [bear](Self::bearing) the point. This is a quick test that does not find all such lanes.
    #[inline(always)]
    fn is_by_arc(&self, _point: S::Vector) -> <S::Real as Real>::Mask {
        <S::Real as Real>::Mask::default()
    }

    /// Returns the radius (m) of a ball about the origin that encloses the surface; infinite for a half-plane.
    fn reach(&self) -> f64;
}

/// A node of a discretized boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryNode {
    /// Position (m) in the frame of the shape.
    pub position: Vec2,
    /// Length of boundary (m) that the node represents.
    pub tributary_length: f64,
}

/// Mass distribution of a uniform section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Area (m²) of a solid section, or length (m) of a thin section.
    pub measure: f64,
    /// Centroid (m) in the frame of the shape.
    pub centroid: Vec2,
    /// Square of the radius of gyration about the centroid (m²).
    pub gyration_squared: f64,
}

/// A planar shape.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape<R = f64> {
    /// A disc, or a barrel in transverse section.
    Circle(Circle<R>),
    /// The floor.
    HalfPlane(HalfPlane),
    /// A convex polygon, such as a rack beam or a block.
    Polygon(Polygon<R>),
    /// A concave arc that holds a barrel.
    Cradle(Cradle<R>),
    /// A barrel in longitudinal section.
    BarrelProfile(BarrelProfile<R>),
}

impl<R: Real> Surface<Planar<R>> for Shape<R> {
    fn side_count(&self) -> usize {
        match self {
            Self::Polygon(polygon) => polygon.side_count(),
            Self::Circle(_) | Self::HalfPlane(_) | Self::Cradle(_) | Self::BarrelProfile(_) => 0,
        }
    }

    #[inline(always)]
    fn gap(&self, point: Vec2<R>) -> Gap<Planar<R>> {
        match self {
            Self::Circle(shape) => shape.gap(point),
            Self::HalfPlane(shape) => shape.gap(point),
            Self::Polygon(shape) => shape.gap(point),
            Self::Cradle(shape) => shape.gap(point),
            Self::BarrelProfile(shape) => shape.gap(point),
        }
    }

    #[inline(always)]
    fn nearest(&self, point: Vec2<R>, slack: R) -> Nearest<Planar<R>> {
        let none = R::Mask::default();
        match self {
            Self::Circle(shape) => Nearest::endless(shape.gap(point), !none),
            Self::HalfPlane(shape) => Nearest::endless(shape.gap(point), none),
            Self::Polygon(shape) => shape.nearest(point, slack),
            // A cradle is concave and is touched by nodes only.
            Self::Cradle(shape) => Nearest::endless(shape.gap(point), none),
            Self::BarrelProfile(shape) => shape.nearest(point),
        }
    }

    #[inline(always)]
    fn bearing(
        &self,
        point: Vec2<R>,
        facing: &Facing<Planar<R>>,
        nearest: Nearest<Planar<R>>,
    ) -> Nearest<Planar<R>> {
        match self {
            Self::Polygon(shape) => shape.bearing(point, facing, nearest),
            Self::BarrelProfile(shape) => shape.bearing(point, facing, nearest),
            Self::Circle(_) | Self::HalfPlane(_) | Self::Cradle(_) => nearest,
        }
    }

    #[inline(always)]
    fn is_by_arc(&self, point: Vec2<R>) -> R::Mask {
        match self {
            Self::Circle(_) => !R::Mask::default(),
            Self::BarrelProfile(shape) => shape.is_by_stave(point),
            Self::HalfPlane(_) | Self::Polygon(_) | Self::Cradle(_) => R::Mask::default(),
        }
    }

    #[inline(always)]
    fn may_touch(&self, point: Vec2<R>) -> R::Mask {
        match self {
            Self::Circle(shape) => shape.may_touch(point),
            Self::HalfPlane(_) => point.z.lt(R::zero()),
            Self::Polygon(shape) => shape.may_touch(point),
            Self::Cradle(_) | Self::BarrelProfile(_) => self.gap(point).distance.lt(R::zero()),
        }
    }

    /// Dispatches on the shape once instead of at every point.
    #[inline(always)]
    fn penetrated_by(
        &self,
        count: usize,
        point: impl Fn(usize) -> Vec2<R>,
        facing: impl Fn(usize) -> Option<Facing<Planar<R>>>,
        mut visit: impl FnMut(usize, Vec2<R>, Gap<Planar<R>>),
    ) {
        let zero = R::zero();
        match self {
            Self::Circle(shape) => {
                let within = shape.within();
                for index in 0..count {
                    let point = point(index);
                    let squared = point.dot(point);
                    if squared.lt(within).any() {
                        let gap = shape.gap_from(point, squared);
                        if gap.distance.lt(zero).any() {
                            visit(index, point, gap);
                        }
                    }
                }
            }
            Self::HalfPlane(shape) => {
                for index in 0..count {
                    let point = point(index);
                    let gap = shape.gap(point);
                    if gap.distance.lt(zero).any() {
                        visit(index, point, gap);
                    }
                }
            }
            Self::Polygon(shape) => {
                for index in 0..count {
                    let point = point(index);
                    if shape.may_touch(point).any() {
                        let gap = self.gap_facing(point, facing(index));
                        if gap.distance.lt(zero).any() {
                            visit(index, point, gap);
                        }
                    }
                }
            }
            Self::Cradle(_) | Self::BarrelProfile(_) => {
                for index in 0..count {
                    let point = point(index);
                    let gap = self.gap_facing(point, facing(index));
                    if gap.distance.lt(zero).any() {
                        visit(index, point, gap);
                    }
                }
            }
        }
    }

    fn reach(&self) -> f64 {
        match self {
            Self::Circle(shape) => shape.radius.largest_lane(),
            Self::HalfPlane(_) => f64::INFINITY,
            Self::Polygon(shape) => shape.reach(),
            Self::Cradle(shape) => shape.radius.largest_lane(),
            Self::BarrelProfile(shape) => shape.reach(),
        }
    }
}

impl<R: Real> Shape<R> {
    /// Returns the gap at a boundary point of another body, measured from the piece on which the point bears; see
    /// [`Surface::bearing`]. Without `facing`, returns the same as [`Surface::gap`].
    #[inline(always)]
    fn gap_facing(&self, point: Vec2<R>, facing: Option<Facing<Planar<R>>>) -> Gap<Planar<R>> {
        let gap = self.gap(point);
        match facing {
            Some(facing) if gap.distance.lt(R::splat(facing.slack)).any() => {
                self.bearing(point, &facing, Nearest::endless(gap, R::Mask::default())).gap
            }
            _ => gap,
        }
    }
}

impl Shape {
    /// Returns the unit outward normal at a point (m) of the boundary; at a corner, the mean of the normals of both
    /// sides.
    ///
    /// Returns `None` for a point off the boundary, and for every point of a cradle, since a cradle touches only the
    /// body that it carries.
    pub fn outward(&self, point: Vec2) -> Option<Vec2> {
        let near = 1e-9 * self.reach();
        let on_it = self.gap(point).distance.abs() < near;
        on_it
            .then(|| match self {
                Self::Polygon(shape) => Some(shape.outward(point, near)),
                Self::Circle(_) | Self::HalfPlane(_) => Some(self.gap(point).normal),
                Self::BarrelProfile(shape) => Some(shape.outward(point, near)),
                Self::Cradle(_) => None,
            })
            .flatten()
    }

    /// Returns nodes along the whole boundary, at most `spacing` (m) apart. Their tributary lengths add up to the
    /// length of the boundary; a half-plane has no nodes.
    pub fn nodes(&self, spacing: f64) -> Vec<BoundaryNode> {
        match self {
            Self::Circle(shape) => shape.nodes(spacing),
            Self::HalfPlane(_) => Vec::new(),
            Self::Polygon(shape) => shape.nodes(spacing),
            Self::Cradle(shape) => shape.nodes(spacing),
            Self::BarrelProfile(shape) => shape.nodes(spacing),
        }
    }

    /// Returns the round pieces of the boundary, each with a tributary length (m); empty for a half-plane, and for a
    /// cradle, which is not convex.
    pub fn rounds(&self, tributary_length: f64) -> Vec<Round<Planar>> {
        match self {
            Self::Circle(shape) => shape.rounds(tributary_length),
            Self::HalfPlane(_) | Self::Cradle(_) => Vec::new(),
            Self::Polygon(shape) => shape.rounds(tributary_length),
            Self::BarrelProfile(shape) => shape.rounds(tributary_length),
        }
    }

    /// Returns the boundary as a polyline (m) for drawing, and `true` if it is closed.
    pub fn outline(&self) -> (Vec<Vec2>, bool) {
        match self {
            Self::Circle(shape) => (shape.outline(), true),
            Self::HalfPlane(_) => (vec![Vec2::new(-1.0, 0.0), Vec2::new(1.0, 0.0)], false),
            Self::Polygon(shape) => (shape.outline(), true),
            Self::Cradle(shape) => (shape.outline(), false),
            Self::BarrelProfile(shape) => (shape.outline(), true),
        }
    }

    /// Returns the mass distribution of a uniform section inside the boundary or, for a cradle, of a thin section along
    /// the boundary; `None` for a half-plane, which is unbounded.
    pub fn section(&self) -> Option<Section> {
        match self {
            Self::Circle(shape) => Some(shape.section()),
            Self::HalfPlane(_) => None,
            Self::Polygon(shape) => Some(shape.section()),
            Self::Cradle(shape) => Some(shape.section()),
            Self::BarrelProfile(shape) => Some(shape.section()),
        }
    }
}

/// A piece of a boundary.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Piece {
    /// A straight side between two points (m).
    Side(Vec2, Vec2),
    /// An arc that runs counterclockwise.
    Arc {
        /// Center (m).
        center: Vec2,
        /// Radius (m).
        radius: f64,
        /// Direction (rad) from the center to the start of the arc, counterclockwise from `x`.
        from: f64,
        /// Angle of the arc (rad).
        turn: f64,
    },
}

impl Piece {
    fn length(self) -> f64 {
        match self {
            Self::Side(from, to) => (to - from).length(),
            Self::Arc { radius, turn, .. } => radius * turn,
        }
    }

    /// Returns the point (m) at the given fraction of the length of the piece.
    fn at(self, share: f64) -> Vec2 {
        match self {
            Self::Side(from, to) => from + (to - from) * share,
            Self::Arc { center, radius, from, turn } => {
                let (sin, cos) = crate::math::sin_cos(from + turn * share);
                center + Vec2::new(cos, sin) * radius
            }
        }
    }
}

/// Returns nodes along an open or closed boundary. Each piece is divided into equal parts no longer than `spacing` (m),
/// and the direction changes by no more than `most_turn` (rad) within a part.
pub(crate) fn nodes_along(
    pieces: &[Piece],
    closed: bool,
    spacing: f64,
    most_turn: f64,
) -> Vec<BoundaryNode> {
    let mut nodes: Vec<BoundaryNode> = Vec::new();
    for (i, piece) in pieces.iter().enumerate() {
        let length = piece.length();
        let turning = match piece {
            Piece::Side(..) => 1,
            Piece::Arc { turn, .. } => parts_of(*turn, most_turn),
        };
        let parts = parts_of(length, spacing).max(turning);
        let part = length / parts as f64;
        if i == 0 {
            nodes.push(BoundaryNode { position: piece.at(0.0), tributary_length: 0.0 });
        }
        for k in 1..=parts {
            if let Some(last) = nodes.last_mut() {
                last.tributary_length += 0.5 * part;
            }
            if closed && i + 1 == pieces.len() && k == parts {
                nodes[0].tributary_length += 0.5 * part;
            } else {
                let position = piece.at(k as f64 / parts as f64);
                nodes.push(BoundaryNode { position, tributary_length: 0.5 * part });
            }
        }
    }
    nodes
}

/// Returns the smallest number of equal parts of a length such that no part is longer than `spacing`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
pub(crate) fn parts_of(length: f64, spacing: f64) -> usize {
    ((length / spacing - 1e-9).ceil().clamp(1.0, 1e6) as usize).max(1)
}
