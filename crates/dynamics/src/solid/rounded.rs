//! Capsules, barrels and blocks as contactors, which touch at their deepest points.

use super::barrel::Barrel;
use super::block::{Block, from_block};
use super::closest::{Closest, along, along_barrel, barrels};
use super::flat::{MOST_ON_STAVE, shared, slopes};
use super::{Capsule, Solid, faces};
use crate::lanes::kind;
use crate::real::{Mask as _, Real};
use crate::shape::{
    Axes, Bearing, Gap, MOST_POINTS, Patch, Points, Shares, Slopes, Spread, Touch, Whole,
};
use crate::space::{Rotation3, Spatial, Vec3, Wrench};

/// A convex solid that touches at its deepest points. It is centered at the origin, with its axis along `x`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hull<R = f64> {
    /// A cylinder with hemispherical ends.
    Capsule(Capsule<R>),
    /// A barrel.
    Barrel(Barrel<R>),
    /// A block.
    Block(Block<R>),
}

/// A hull positioned on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded<R = f64> {
    /// The hull.
    pub hull: Hull<R>,
    /// Position (m) of the origin of the hull in the body frame, relative to the center of mass.
    pub center: Vec3<R>,
    /// Rotation from the frame of the hull to the body frame.
    pub rotation: Rotation3<R>,
    /// Tributary length (m) of each contact.
    pub tributary_length: R,
}

/// Number of tangential springs of a line contact: one at the center of pressure, and two along the line.
const OF_LINE: usize = 3;
/// Number of tangential springs of a face contact: one at the center of pressure, and two along each of two axes.
const OF_FACE: usize = 5;
/// Number of tangential springs of a block on the half-space: one for each corner.
const CORNERS: usize = 8;

impl<R: Real> Rounded<R> {
    /// Creates a hull whose center is at the center of mass of the body.
    pub fn centered(hull: Hull<R>) -> Self {
        Self {
            hull,
            center: Vec3::default(),
            rotation: Rotation3::identity(),
            tributary_length: R::splat(1.0),
        }
    }
}

impl<R: Real> Whole<Spatial<R>> for Rounded<R> {
    #[inline(always)]
    fn meet(
        &self,
        surface: &Solid<R>,
        position: Vec3<R>,
        rotation: Rotation3<R>,
        near: R::Mask,
        mut visit: impl FnMut(Patch<Spatial<R>>),
    ) {
        let origin = position + rotation.apply(self.center);
        let frame = rotation.after(self.rotation);
        match (&self.hull, surface) {
            (Hull::Capsule(capsule), Solid::HalfSpace) => {
                let end = frame.apply(Vec3::new(capsule.half_length, R::zero(), R::zero()));
                for (first, center) in [origin - end, origin + end].into_iter().enumerate() {
                    visit(Patch { first, deepest: on_plane(center, capsule.radius), spread: None });
                }
            }
            (Hull::Barrel(barrel), Solid::HalfSpace) => visit(standing(barrel, origin, frame)),
            (Hull::Block(block), Solid::HalfSpace) => {
                for (first, corner) in block.corners().into_iter().enumerate() {
                    let deepest = on_plane(origin + frame.apply(corner), block.rounding);
                    visit(Patch { first, deepest, spread: None });
                }
            }
            // Only points can touch a concave surface.
            (_, Solid::Dish(_)) => {}
            (hull, Solid::Ball(_) | Solid::Capsule(_) | Solid::Barrel(_) | Solid::Block(_)) => {
                let mut patch = meeting(hull, surface, origin, frame, near);
                if let Some(Spread { slopes, .. }) = &mut patch.spread {
                    let arm = origin - position;
                    for slope in [&mut slopes.middle, &mut slopes.deepest, &mut slopes.others] {
                        slope.moment += arm.cross(slope.force);
                    }
                }
                visit(patch);
            }
        }
    }

    #[inline(always)]
    fn points(
        &self,
        surface: &Solid<R>,
        position: Vec3<R>,
        rotation: Rotation3<R>,
        near: R::Mask,
    ) -> Option<Points<Spatial<R>>> {
        let (Hull::Block(block), Solid::Block(target)) = (&self.hull, surface) else { return None };
        let mut points = block_on_block(
            block,
            target,
            position + rotation.apply(self.center),
            rotation.after(self.rotation),
            near,
        );
        for bearing in &mut points.points {
            bearing.touch = midway(bearing.touch.node, bearing.touch.gap);
        }
        Some(points)
    }

    fn kind(&self) -> u64 {
        kind(&self.hull)
    }

    fn most_sticks(&self) -> usize {
        match self.hull {
            Hull::Capsule(_) => OF_LINE,
            Hull::Barrel(_) => OF_FACE,
            Hull::Block(_) => CORNERS,
        }
    }

    fn ball(&self) -> (Vec3<R>, R) {
        let radius = match &self.hull {
            Hull::Capsule(capsule) => capsule.half_length + capsule.radius,
            Hull::Barrel(barrel) => barrel.reach(),
            Hull::Block(block) => block.reach(),
        };
        (self.center, radius)
    }

    fn tributary_length(&self) -> R {
        self.tributary_length
    }
}

/// Returns a contact point at which the force acts midway between the surfaces. The result therefore does not depend on
/// the choice of the target.
#[inline(always)]
fn midway<R: Real>(point: Vec3<R>, gap: Gap<Spatial<R>>) -> Touch<Spatial<R>> {
    Touch { node: point + gap.normal * (gap.distance * R::splat(0.5)), gap }
}

/// Returns the contact point of a ball on the half-space, given the center (m) and the radius (m) of the ball.
#[inline(always)]
fn on_plane<R: Real>(center: Vec3<R>, radius: R) -> Touch<Spatial<R>> {
    let up = Vec3::new(R::zero(), R::zero(), R::splat(1.0));
    midway(center - up * radius, Gap { distance: center.z - radius, normal: up })
}

/// Returns the contact patch of a standing barrel on the half-space, given by the deepest point of the barrel and the
/// center of its lower head.
///
/// Energy and force are computed at four points of the rim, a quarter turn apart, one of which is the deepest point.
/// They are therefore smooth functions of height and tilt, although an exactly upright barrel has no unique deepest
/// point.
#[inline(always)]
fn standing<R: Real>(
    barrel: &Barrel<R>,
    origin: Vec3<R>,
    frame: Rotation3<R>,
) -> Patch<Spatial<R>> {
    let (zero, one) = (R::zero(), R::splat(1.0));
    let down = frame.unapply(Vec3::new(zero, zero, -one));
    let side = R::select(down.x.lt(zero), -one, one);
    let place = |point: Vec3<R>| on_plane(origin + frame.apply(point), barrel.rounding);
    let [y, z] = [Vec3::new(zero, one, zero), Vec3::new(zero, zero, one)];
    let spread = Spread {
        middle: place(Vec3::new(side * barrel.half_length, zero, zero)),
        shares: Shares { deepest: one, others: one, aside: one },
        radius: barrel.head_radius,
        axes: Axes::Face([frame.apply(y), frame.apply(z)]),
        // The slopes are zero, since the middle is a material point of the barrel and all weights are constant.
        slopes: Slopes::default(),
    };
    Patch { first: 0, deepest: place(barrel.furthest(down)), spread: Some(spread) }
}

/// Returns the contact patch of two bounded solids. It is computed lane by lane, except for the closest points of a
/// tube and a barrel in a bundle.
#[inline(always)]
fn meeting<R: Real>(
    hull: &Hull<R>,
    surface: &Solid<R>,
    origin: Vec3<R>,
    frame: Rotation3<R>,
    near: R::Mask,
) -> Patch<Spatial<R>> {
    let nothing = Gap { distance: R::splat(1.0), normal: Vec3::default() };
    let (mut gap, mut point) = (nothing, Vec3::default());
    let (mut middle_gap, mut middle, mut axes) = (nothing, Vec3::default(), [Vec3::default(); 2]);
    let (one, mut radius) = (R::splat(1.0), R::zero());
    let mut shares = Shares { deepest: one, others: R::zero(), aside: R::zero() };
    let mut changes = Slopes::default();
    let (mut solved, mut left) = (R::Mask::default(), near);
    let mut bears = false;
    if let Some(tube) = tube_on_barrel(hull, surface, origin, frame) {
        (gap, point, solved) = (tube.gap, tube.point, tube.found & near);
        gap.distance = R::select(near, gap.distance, one);
        // On the stave of the barrel, or without contact, there is no patch.
        let flat = gap.distance.lt(R::zero()) & R::splat(MOST_ON_STAVE).le(tube.along.abs());
        left = near & (!solved | flat);
    }
    for lane in (0..R::LANES).filter(|lane| left.lane(*lane)) {
        let Some(target) = bounded(surface, lane) else { continue };
        let turned = frame.lane(lane);
        let (contactor, at) = (hull.lane(lane), origin.lane(lane));
        if !solved.lane(lane) {
            let found = closest(&contactor, &target, at, turned);
            put_gap(&mut gap, lane, Gap { distance: found.distance, normal: found.normal });
            put(&mut point, lane, found.point);
            if found.distance >= 0.0 {
                continue;
            }
        }
        let normal = gap.normal.lane(lane);
        if let Some(flat) = shared(&contactor, &target, at, turned, normal) {
            bears = true;
            put_gap(&mut middle_gap, lane, flat.gap);
            put(&mut middle, lane, flat.point);
            shares.deepest = shares.deepest.with_lane(lane, flat.shares.deepest);
            shares.others = shares.others.with_lane(lane, flat.shares.others);
            shares.aside = shares.aside.with_lane(lane, flat.shares.aside);
            radius = radius.with_lane(lane, flat.radius);
            for (axis, single) in axes.iter_mut().zip(flat.axes) {
                put(axis, lane, single);
            }
            let own = slopes(&flat, &contactor, &target, at, turned, normal);
            put_wrench(&mut changes.middle, lane, own.middle);
            put_wrench(&mut changes.deepest, lane, own.deepest);
            put_wrench(&mut changes.others, lane, own.others);
        }
    }
    if !bears {
        return Patch { first: 0, deepest: midway(point, gap), spread: None };
    }
    let axes = match (hull, surface) {
        (Hull::Capsule(_), _) | (_, Solid::Ball(_) | Solid::Capsule(_)) => Axes::Line([axes[0]]),
        _ => Axes::Face(axes),
    };
    let middle = midway(middle, middle_gap);
    let spread = Spread { middle, shares, radius, axes, slopes: changes };
    Patch { first: 0, deepest: midway(point, gap), spread: Some(spread) }
}

/// Closest points of a tube and a barrel, in all lanes together.
struct TubeOnBarrel<R: Real> {
    gap: Gap<Spatial<R>>,
    /// Point (m) of the contactor that is closest to the target.
    point: Vec3<R>,
    /// The lanes in which the search found the closest points.
    found: R::Mask,
    /// Component of the normal along the axis of the barrel.
    along: R,
}

/// Returns the closest points of a tube and a barrel, computed in all lanes of a bundle together. Returns `None` for
/// all other solids, and for a single run, which has only one lane.
#[inline(always)]
fn tube_on_barrel<R: Real>(
    hull: &Hull<R>,
    surface: &Solid<R>,
    origin: Vec3<R>,
    frame: Rotation3<R>,
) -> Option<TubeOnBarrel<R>> {
    // In a single run, the search with its fallback is one function.
    if R::LANES == 1 {
        return None;
    }
    // The terms are those of `closest_of`, in the same order.
    match (hull, surface) {
        (Hull::Capsule(capsule), Solid::Barrel(target)) => {
            let end = frame.apply(Vec3::new(capsule.half_length, R::zero(), R::zero()));
            let (place, gap, found) = along_barrel(target, origin, end);
            let center = origin + end * place;
            Some(TubeOnBarrel {
                gap: Gap { distance: gap.distance - capsule.radius, normal: gap.normal },
                point: center - gap.normal * capsule.radius,
                found,
                along: gap.normal.x,
            })
        }
        (Hull::Barrel(barrel), Solid::Capsule(target)) => {
            let end = frame.unapply(Vec3::new(target.half_length, R::zero(), R::zero()));
            let middle = frame.unapply(-origin);
            let (place, gap, found) = along_barrel(barrel, middle, end);
            let nearest = middle + end * place - gap.normal * gap.distance;
            let normal = -frame.apply(gap.normal);
            Some(TubeOnBarrel {
                gap: Gap { distance: gap.distance - target.radius, normal },
                point: origin + frame.apply(nearest),
                found,
                along: frame.unapply(normal).x,
            })
        }
        (Hull::Capsule(_) | Hull::Barrel(_) | Hull::Block(_), _) => None,
    }
}

/// Returns the contact points of two blocks, lane by lane: the corners of the area that their faces share, and the
/// deepest point.
#[inline(always)]
fn block_on_block<R: Real>(
    block: &Block<R>,
    surface: &Block<R>,
    origin: Vec3<R>,
    frame: Rotation3<R>,
    near: R::Mask,
) -> Points<Spatial<R>> {
    let gap = Gap { distance: R::splat(1.0), normal: Vec3::default() };
    let none = Bearing {
        touch: Touch { node: Vec3::default(), gap },
        share: R::zero(),
        turning: Vec3::default(),
    };
    let mut points = Points { points: [none; MOST_POINTS], axes: [Vec3::default(); 4] };
    for lane in (0..R::LANES).filter(|lane| near.lane(*lane)) {
        let (contactor, target) = (block.lane(lane), surface.lane(lane));
        let (at, turned) = (origin.lane(lane), frame.lane(lane));
        let found = closest(&Hull::Block(contactor), &Hull::Block(target), at, turned);
        let gap = Gap { distance: found.distance, normal: found.normal };
        let deepest = &mut points.points[MOST_POINTS - 1];
        put_gap(&mut deepest.touch.gap, lane, gap);
        put(&mut deepest.touch.node, lane, found.point);
        deepest.share = deepest.share.with_lane(lane, 1.0);
        if found.distance >= 0.0 {
            continue;
        }
        let shared = faces::shared_by_both(&contactor, &target, at, turned, found.normal);
        let bears = shared.vertices.iter().flatten().any(|vertex| vertex.gap.distance < 0.0);
        let flat = if bears { shared.flat } else { 0.0 };
        deepest.share = deepest.share.with_lane(lane, 1.0 - flat);
        for (bearing, vertex) in points.points.iter_mut().zip(shared.vertices) {
            let Some(vertex) = vertex else { continue };
            put_gap(&mut bearing.touch.gap, lane, vertex.gap);
            put(&mut bearing.touch.node, lane, vertex.point);
            put(&mut bearing.turning, lane, vertex.turning * flat);
            bearing.share = bearing.share.with_lane(lane, vertex.share * flat);
        }
        for (axis, single) in points.axes.iter_mut().zip(shared.axes) {
            put(axis, lane, single);
        }
    }
    points
}

#[inline(always)]
fn put_gap<R: Real>(gap: &mut Gap<Spatial<R>>, lane: usize, single: Gap<Spatial>) {
    gap.distance = gap.distance.with_lane(lane, single.distance);
    put(&mut gap.normal, lane, single.normal);
}

#[inline(always)]
fn put_wrench<R: Real>(wrench: &mut Wrench<Spatial<R>>, lane: usize, single: Wrench<Spatial>) {
    put(&mut wrench.force, lane, single.force);
    put(&mut wrench.moment, lane, single.moment);
}

#[inline(always)]
fn put<R: Real>(vector: &mut Vec3<R>, lane: usize, single: Vec3) {
    vector.x = vector.x.with_lane(lane, single.x);
    vector.y = vector.y.with_lane(lane, single.y);
    vector.z = vector.z.with_lane(lane, single.z);
}

impl<R: Real> Hull<R> {
    /// Returns the hull in one lane.
    #[inline(always)]
    fn lane(&self, lane: usize) -> Hull {
        match self {
            Self::Capsule(capsule) => Hull::Capsule(capsule.lane(lane)),
            Self::Barrel(barrel) => Hull::Barrel(barrel.lane(lane)),
            Self::Block(block) => Hull::Block(block.lane(lane)),
        }
    }

    /// Returns the signed distance (m) of a point from the surface of the hull, and the surface normal.
    #[inline(always)]
    pub(super) fn gap(&self, point: Vec3<R>) -> Gap<Spatial<R>> {
        match self {
            Self::Capsule(capsule) => capsule.gap(point),
            Self::Barrel(barrel) => barrel.gap(point),
            Self::Block(block) => block.gap(point),
        }
    }
}

impl Hull {
    /// Returns the hull as a target surface.
    pub fn surface(self) -> Solid {
        match self {
            Self::Capsule(capsule) => Solid::Capsule(capsule),
            Self::Barrel(barrel) => Solid::Barrel(barrel),
            Self::Block(block) => Solid::Block(block),
        }
    }

    /// Returns the distance (m) of the surface of the hull from its core.
    pub(super) fn rounding(&self) -> f64 {
        match self {
            Self::Capsule(capsule) => capsule.radius,
            Self::Barrel(barrel) => barrel.rounding,
            Self::Block(block) => block.rounding,
        }
    }

    /// Returns the support point (m) of the core in the direction of a unit vector.
    pub(super) fn furthest(&self, direction: Vec3) -> Vec3 {
        match self {
            Self::Capsule(capsule) => {
                Vec3::new(capsule.half_length * direction.x.signum(), 0.0, 0.0)
            }
            Self::Barrel(barrel) => barrel.furthest(direction),
            Self::Block(block) => block.furthest(direction),
        }
    }
}

/// Converts one lane of a bounded convex surface to a hull; a ball becomes a capsule of zero length. Returns `None` for
/// other surfaces.
#[inline(always)]
fn bounded<R: Real>(surface: &Solid<R>, lane: usize) -> Option<Hull> {
    match surface {
        Solid::HalfSpace | Solid::Dish(_) => None,
        Solid::Ball(ball) => {
            Some(Hull::Capsule(Capsule { half_length: 0.0, radius: ball.radius.lane(lane) }))
        }
        Solid::Capsule(capsule) => Some(Hull::Capsule(capsule.lane(lane))),
        Solid::Barrel(barrel) => Some(Hull::Barrel(barrel.lane(lane))),
        Solid::Block(block) => Some(Hull::Block(block.lane(lane))),
    }
}

/// Returns the closest points of a contactor and a target, in the frame of the target.
///
/// `at` is the origin (m) of the contactor, and `frame` the rotation from the frame of the contactor to that of the
/// target.
fn closest(contactor: &Hull, target: &Hull, at: Vec3, frame: Rotation3) -> Closest {
    f64::scope(
        #[inline(always)]
        || closest_of(contactor, target, at, frame),
    )
}

#[inline(always)]
fn closest_of(contactor: &Hull, target: &Hull, at: Vec3, frame: Rotation3) -> Closest {
    match (contactor, target) {
        (Hull::Barrel(barrel), Hull::Barrel(target)) => barrels(target, barrel, at, frame),
        (Hull::Capsule(capsule), _) => {
            let end = frame.apply(Vec3::new(capsule.half_length, 0.0, 0.0));
            let (place, gap, evaluations, converged) = along(target, at, end);
            let center = at + end * place;
            Closest {
                distance: gap.distance - capsule.radius,
                normal: gap.normal,
                point: center - gap.normal * capsule.radius,
                evaluations,
                converged,
            }
        }
        // Computed in the frame of the contactor.
        (hull, Hull::Capsule(target)) => {
            let end = frame.unapply(Vec3::new(target.half_length, 0.0, 0.0));
            let middle = frame.unapply(-at);
            let (place, gap, evaluations, converged) = along(hull, middle, end);
            let nearest = middle + end * place - gap.normal * gap.distance;
            Closest {
                distance: gap.distance - target.radius,
                normal: -frame.apply(gap.normal),
                point: at + frame.apply(nearest),
                evaluations,
                converged,
            }
        }
        (other, Hull::Block(block)) => from_block(block, other, at, frame),
        // Computed in the frame of the block.
        (Hull::Block(block), target) => {
            let found = from_block(block, target, frame.unapply(-at), frame.back());
            let on_block = found.point - found.normal * found.distance;
            Closest {
                normal: -frame.apply(found.normal),
                point: at + frame.apply(on_block),
                ..found
            }
        }
    }
}

impl Rounded {
    /// Returns the closest points of the hull and a surface; `position` and `rotation` are as in [`Whole::meet`].
    ///
    /// Returns `None` for the half-space, which the hull may touch with several points, and for a dish.
    pub fn closest(&self, surface: &Solid, position: Vec3, rotation: Rotation3) -> Option<Closest> {
        let origin = position + rotation.apply(self.center);
        let target = bounded(surface, 0)?;
        Some(closest(&self.hull, &target, origin, rotation.after(self.rotation)))
    }
}
