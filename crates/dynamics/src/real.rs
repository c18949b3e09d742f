//! The scalar of the physics: one `f64`, or many of them in lockstep.
//!
//! Every force, shape and integrator is written once against [`Real`].
//! With `f64` it is one run; with a bundle of lanes it is as many runs of one topology side by side.
//! The rule that keeps a lane equal to a single run, bit for bit: a branch on a number becomes a
//! [`Mask`] and a [`Real::select`], a block may be skipped only when no lane wants it, and no
//! operation may differ between the two (no fused multiply-add, no platform sine).

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};

use crate::lanes::units;

/// A number, or a bundle of numbers that advance in lockstep.
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// The answer of a comparison, lane by lane.
    type Mask: Mask;

    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// The correctly rounded square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// `yes` where the mask holds, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// The number in one lane; lane 0 of an `f64` is itself.
    fn lane(self, lane: usize) -> f64;
    /// The number that `value` gives for each lane.
    #[must_use]
    fn from_lanes(value: impl FnMut(usize) -> f64) -> Self;
    /// How many numbers run together.
    const LANES: usize;

    /// Does work that is full of these numbers, compiled for the unit that computes them.
    ///
    /// All arithmetic of a bundle must be inlined into such a scope: outside of one it is right but slow.
    #[inline(always)]
    fn scope<T>(work: impl FnOnce() -> T) -> T {
        work()
    }

    /// Zero in every lane.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }
    /// `self > other`.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// The smaller of the two; `other` where they are equal or not comparable.
    #[inline(always)]
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
    /// The larger of the two; `other` where they are equal or not comparable.
    #[inline(always)]
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }
    /// The number held between `-limit` and `limit`.
    #[inline(always)]
    #[must_use]
    fn clamp_magnitude(self, limit: Self) -> Self {
        self.min(limit).max(-limit)
    }
    /// Holds where the number is finite.
    #[inline(always)]
    fn is_finite_mask(self) -> Self::Mask {
        // What is no number is not below anything.
        self.abs().lt(Self::splat(f64::INFINITY))
    }
    /// The number with that of one lane replaced.
    #[must_use]
    fn with_lane(self, lane: usize, value: f64) -> Self {
        Self::from_lanes(|l| if l == lane { value } else { self.lane(l) })
    }
    /// The largest over the lanes.
    fn largest_lane(self) -> f64 {
        (0..Self::LANES).map(|lane| self.lane(lane)).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// A truth value for every lane.
pub trait Mask:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + Not<Output = Self>
{
    /// How many truth values there are.
    const LANES: usize;

    /// The truth that `value` gives for each lane.
    #[must_use]
    fn from_lanes(value: impl FnMut(usize) -> bool) -> Self;
    /// Holds in at least one lane.
    fn any(self) -> bool;
    /// Holds in every lane.
    #[inline(always)]
    fn all(self) -> bool {
        !(!self).any()
    }
    /// Holds in one lane.
    fn lane(self, lane: usize) -> bool;
}

impl Real for f64 {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn from_lanes(mut value: impl FnMut(usize) -> f64) -> Self {
        value(0)
    }
    #[inline(always)]
    fn scope<T>(work: impl FnOnce() -> T) -> T {
        units::single(work)
    }
}

impl Mask for bool {
    const LANES: usize = 1;

    #[inline(always)]
    fn from_lanes(mut value: impl FnMut(usize) -> Self) -> Self {
        value(0)
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn lane(self, _lane: usize) -> bool {
        self
    }
}
