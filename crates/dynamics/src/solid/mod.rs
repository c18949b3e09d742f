//! Boundaries in three dimensions: ball, half-space, capsule, block, barrel of revolution, and dish ([`Solid`]).
//!
//! Each solid except the dish consists of all points within a certain distance of a convex core. At usual penetrations
//! the cores remain separate, so only distances of separate convex bodies are needed.
//!
//! A target computes the distance of a point from its surface ([`Surface::gap`]). A ball as contactor is represented by
//! its center ([`Nodes::Rolling`](crate::body::Nodes::Rolling)), and feet and legs by their points
//! ([`Nodes::Fixed`](crate::body::Nodes::Fixed)). For a capsule, a block or a barrel as contactor, the contact is
//! computed from its whole shape ([`Rounded`]).

mod barrel;
mod block;
mod closest;
mod compound;
mod faces;
mod flat;
mod mass;
mod rounded;

use crate::real::Real;
use crate::shape::{Gap, Nearest, Surface};
use crate::space::{Spatial, Vec3};

pub use barrel::{Barrel, BarrelError};
pub use block::Block;
pub use closest::Closest;
pub use compound::{Part, compound, pairs_between};
pub use mass::{Bulk, Cask, Fill};
pub use rounded::{Hull, Rounded};

/// A ball about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<R = f64> {
    /// Radius (m).
    pub radius: R,
}

impl<R: Real> Ball<R> {
    #[inline(always)]
    fn gap(&self, point: Vec3<R>) -> Gap<Spatial<R>> {
        let up = Vec3::new(R::zero(), R::zero(), R::splat(1.0));
        Gap { distance: point.length() - self.radius, normal: point.unit_or(up) }
    }
}

/// A spherical cavity about the origin, surrounded by solid material: the dish of a bearing. Only points can touch it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dish<R = f64> {
    /// Radius (m).
    pub radius: R,
}

impl<R: Real> Dish<R> {
    #[inline(always)]
    fn gap(&self, point: Vec3<R>) -> Gap<Spatial<R>> {
        let down = Vec3::new(R::zero(), R::zero(), R::splat(-1.0));
        Gap { distance: self.radius - point.length(), normal: -point.unit_or(down) }
    }
}

/// A cylinder with hemispherical ends, such as a tube of a rack. Its axis is along `x`, and its center is the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule<R = f64> {
    /// Half the length (m) of the axis; the capsule extends beyond the axis by its radius at both ends.
    pub half_length: R,
    /// Radius (m).
    pub radius: R,
}

impl<R: Real> Capsule<R> {
    /// Returns the capsule in one lane.
    #[inline(always)]
    fn lane(&self, lane: usize) -> Capsule {
        Capsule { half_length: self.half_length.lane(lane), radius: self.radius.lane(lane) }
    }

    #[inline(always)]
    fn gap(&self, point: Vec3<R>) -> Gap<Spatial<R>> {
        let along = point.x.clamp_magnitude(self.half_length);
        let from_axis = Vec3::new(point.x - along, point.y, point.z);
        Ball { radius: self.radius }.gap(from_axis)
    }
}

impl Capsule {
    /// Returns the position, on a line, of the point that is closest to the axis of the capsule. The line is at
    /// `middle` (m) at position 0 and at `middle + half` at position 1. Returns NaN if the line is parallel to the
    /// axis.
    ///
    /// Between the ends of the axis, only the transverse distance counts; beyond an end, the axial distance counts as
    /// well.
    #[inline(always)]
    fn nearest_on_line(&self, middle: Vec3, half: Vec3) -> f64 {
        let across = half.y * half.y + half.z * half.z;
        let pull = middle.y * half.y + middle.z * half.z;
        if across == 0.0 {
            return f64::NAN;
        }
        let place = -pull / across;
        let along = middle.x + half.x * place;
        if along.abs() <= self.half_length {
            return place;
        }
        let end = self.half_length.copysign(along);
        -(pull + (middle.x - end) * half.x) / (across + half.x * half.x)
    }
}

/// A solid that can be a target.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid<R = f64> {
    /// Everything below `z = 0`: the floor.
    HalfSpace,
    /// A ball.
    Ball(Ball<R>),
    /// A cylinder with hemispherical ends.
    Capsule(Capsule<R>),
    /// A barrel.
    Barrel(Barrel<R>),
    /// A block.
    Block(Block<R>),
    /// A dish.
    Dish(Dish<R>),
}

impl<R: Real> Surface<Spatial<R>> for Solid<R> {
    #[inline(always)]
    fn gap(&self, point: Vec3<R>) -> Gap<Spatial<R>> {
        match self {
            Self::HalfSpace => {
                let up = Vec3::new(R::zero(), R::zero(), R::splat(1.0));
                Gap { distance: point.z, normal: up }
            }
            Self::Ball(ball) => ball.gap(point),
            Self::Capsule(capsule) => capsule.gap(point),
            Self::Barrel(barrel) => barrel.gap(point),
            Self::Block(block) => block.gap(point),
            Self::Dish(dish) => dish.gap(point),
        }
    }

    #[inline(always)]
    fn nearest(&self, point: Vec3<R>, _slack: R) -> Nearest<Spatial<R>> {
        let none = R::Mask::default();
        let flat = match self {
            Self::HalfSpace => !none,
            Self::Ball(_) | Self::Capsule(_) | Self::Barrel(_) | Self::Block(_) | Self::Dish(_) => {
                none
            }
        };
        Nearest::endless(self.gap(point), !flat)
    }

    fn reach(&self) -> f64 {
        match self {
            Self::HalfSpace => f64::INFINITY,
            Self::Ball(ball) => ball.radius.largest_lane(),
            Self::Capsule(capsule) => (capsule.half_length + capsule.radius).largest_lane(),
            Self::Barrel(barrel) => barrel.reach().largest_lane(),
            Self::Block(block) => block.reach().largest_lane(),
            Self::Dish(dish) => dish.radius.largest_lane(),
        }
    }
}
