//! Capsules and barrels as they touch: with the points that lie deepest.

use super::barrel::Barrel;
use super::closest::{Closest, along_axis, barrels};
use super::{Capsule, Solid};
use crate::real::Real;
use crate::shape::{self, Gap};
use crate::space::{Rotation3, Spatial, Vec3};

/// What touches as a whole, along `x` about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hull<R = f64> {
    /// A tube with round ends.
    Capsule(Capsule<R>),
    /// A barrel.
    Barrel(Barrel<R>),
}

/// A hull at its place on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded<R = f64> {
    /// What it is.
    pub hull: Hull<R>,
    /// Its origin (m) in the body frame, from the center of mass.
    pub center: Vec3<R>,
    /// How its frame is turned in the body frame.
    pub rotation: Rotation3<R>,
    /// Length of boundary (m) that each of its contacts stands for.
    pub tributary_length: R,
}

/// Contacts of a barrel on a plane: the deepest point, and three more around the lower head.
const ON_PLANE: usize = 4;

impl<R: Real> Rounded<R> {
    /// A hull at the center of mass of its body.
    pub fn centered(hull: Hull<R>) -> Self {
        Self {
            hull,
            center: Vec3::default(),
            rotation: Rotation3::identity(),
            tributary_length: R::splat(1.0),
        }
    }
}

impl<R: Real> shape::Whole<Spatial<R>> for Rounded<R> {
    #[inline(always)]
    fn meet(
        &self,
        surface: &Solid<R>,
        position: Vec3<R>,
        rotation: Rotation3<R>,
        mut visit: impl FnMut(usize, Vec3<R>, Gap<Spatial<R>>),
    ) {
        // Both bodies feel the force midway between their surfaces, whichever of them is the target.
        let mut midway = |index: usize, point: Vec3<R>, gap: Gap<Spatial<R>>| {
            visit(index, point + gap.normal * (gap.distance * R::splat(0.5)), gap);
        };
        let origin = position + rotation.apply(self.center);
        let frame = rotation.after(self.rotation);
        match (&self.hull, surface) {
            (Hull::Capsule(capsule), Solid::HalfSpace) => {
                let end = frame.apply(Vec3::new(capsule.half_length, R::zero(), R::zero()));
                on_plane([origin - end, origin + end], capsule.radius, &mut midway);
            }
            (Hull::Barrel(barrel), Solid::HalfSpace) => {
                let points = bearing_points(barrel, frame).map(|point| origin + frame.apply(point));
                on_plane(points, barrel.rounding, &mut midway);
            }
            (hull, Solid::Ball(_) | Solid::Capsule(_) | Solid::Barrel(_)) => {
                let mut gap: Gap<Spatial<R>> = Gap { distance: R::zero(), normal: Vec3::default() };
                let mut point = Vec3::default();
                for lane in 0..R::LANES {
                    let Some(target) = bounded(surface, lane) else { continue };
                    let turned = Rotation3 { rows: frame.rows.map(|row| row.lane(lane)) };
                    let found = closest(&hull.lane(lane), &target, origin.lane(lane), turned);
                    gap.distance = gap.distance.with_lane(lane, found.distance);
                    put(&mut gap.normal, lane, found.normal);
                    put(&mut point, lane, found.point);
                }
                midway(0, point, gap);
            }
        }
    }

    fn most_contacts(&self) -> usize {
        match self.hull {
            Hull::Capsule(_) => 2,
            Hull::Barrel(_) => ON_PLANE,
        }
    }

    fn ball(&self) -> (Vec3<R>, R) {
        let radius = match &self.hull {
            Hull::Capsule(capsule) => capsule.half_length + capsule.radius,
            Hull::Barrel(barrel) => barrel.reach(),
        };
        (self.center, radius)
    }

    fn tributary_length(&self) -> R {
        self.tributary_length
    }
}

/// Balls of a radius (m) on the half-space, one after the other.
#[inline(always)]
fn on_plane<R: Real, const N: usize>(
    centers: [Vec3<R>; N],
    radius: R,
    visit: &mut impl FnMut(usize, Vec3<R>, Gap<Spatial<R>>),
) {
    let up = Vec3::new(R::zero(), R::zero(), R::splat(1.0));
    for (index, center) in centers.into_iter().enumerate() {
        visit(index, center - up * radius, Gap { distance: center.z - radius, normal: up });
    }
}

/// The points of a barrel's core (m, in its frame) that bear it on the half-space: the deepest one, and
/// three more a quarter turn apart on the circle of the lower head.
///
/// A barrel that stands on its head thus stands on four points, one that leans or lies on the first
/// alone. They turn with the direction in which it leans, which has none where it stands upright; there
/// all are equally deep, and the force of four equal springs and its moment are the same however they
/// are turned. The energy is a function of height and tilt alone, so the force is its slope, and smooth.
#[inline(always)]
fn bearing_points<R: Real>(barrel: &Barrel<R>, frame: Rotation3<R>) -> [Vec3<R>; ON_PLANE] {
    let (zero, one) = (R::zero(), R::splat(1.0));
    let down = frame.unapply(Vec3::new(zero, zero, -one));
    let side = R::select(down.x.lt(zero), -one, one);
    let lowest = Vec3::new(zero, down.y, down.z).unit_or(Vec3::new(zero, zero, one));
    let aside = Vec3::new(zero, -lowest.z, lowest.y);
    let head = Vec3::new(side * barrel.half_length, zero, zero);
    let radius = barrel.head_radius;
    [barrel.furthest(down), head + aside * radius, head - aside * radius, head - lowest * radius]
}

fn put<R: Real>(vector: &mut Vec3<R>, lane: usize, single: Vec3) {
    vector.x = vector.x.with_lane(lane, single.x);
    vector.y = vector.y.with_lane(lane, single.y);
    vector.z = vector.z.with_lane(lane, single.z);
}

impl<R: Real> Hull<R> {
    /// In one lane.
    fn lane(&self, lane: usize) -> Hull {
        match self {
            Self::Capsule(capsule) => Hull::Capsule(capsule.lane(lane)),
            Self::Barrel(barrel) => Hull::Barrel(barrel.lane(lane)),
        }
    }
}

/// A bounded surface in one lane, a ball as a capsule without length; none for the half-space.
fn bounded<R: Real>(surface: &Solid<R>, lane: usize) -> Option<Hull> {
    match surface {
        Solid::HalfSpace => None,
        Solid::Ball(ball) => {
            Some(Hull::Capsule(Capsule { half_length: 0.0, radius: ball.radius.lane(lane) }))
        }
        Solid::Capsule(capsule) => Some(Hull::Capsule(capsule.lane(lane))),
        Solid::Barrel(barrel) => Some(Hull::Barrel(barrel.lane(lane))),
    }
}

/// Where a contactor with its origin at `at` (m) is closest to a target, in the frame of the target, from
/// that of the contactor to which `frame` leads.
fn closest(contactor: &Hull, target: &Hull, at: Vec3, frame: Rotation3) -> Closest {
    match (contactor, target) {
        (Hull::Barrel(barrel), Hull::Barrel(target)) => barrels(target, barrel, at, frame),
        (Hull::Capsule(capsule), _) => {
            let end = frame.apply(Vec3::new(capsule.half_length, 0.0, 0.0));
            let gap = |point| match target {
                Hull::Capsule(target) => target.gap(point),
                Hull::Barrel(target) => target.gap(point),
            };
            let (share, gap, evaluations, converged) = along_axis(gap, at - end, at + end);
            let center = at + end * (2.0 * share - 1.0);
            Closest {
                distance: gap.distance - capsule.radius,
                normal: gap.normal,
                point: center - gap.normal * capsule.radius,
                evaluations,
                converged,
            }
        }
        // The barrel tells how far the axis of the capsule is, in its own frame.
        (Hull::Barrel(barrel), Hull::Capsule(target)) => {
            let end = frame.unapply(Vec3::new(target.half_length, 0.0, 0.0));
            let middle = frame.unapply(-at);
            let (share, gap, evaluations, converged) =
                along_axis(|point| barrel.gap(point), middle - end, middle + end);
            let nearest = middle + end * (2.0 * share - 1.0) - gap.normal * gap.distance;
            Closest {
                distance: gap.distance - target.radius,
                normal: -frame.apply(gap.normal),
                point: at + frame.apply(nearest),
                evaluations,
                converged,
            }
        }
    }
}

impl Rounded {
    /// Where it is closest to a surface; `position` and `rotation` as in [`shape::Whole::meet`].
    ///
    /// None for the half-space, on which it may lie with more than one point.
    pub fn closest(&self, surface: &Solid, position: Vec3, rotation: Rotation3) -> Option<Closest> {
        let origin = position + rotation.apply(self.center);
        let target = bounded(surface, 0)?;
        Some(closest(&self.hull, &target, origin, rotation.after(self.rotation)))
    }
}
