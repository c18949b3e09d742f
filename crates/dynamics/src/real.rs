//! The scalar type of the simulation: one `f64`, or many that advance in lockstep.
//!
//! Every force, shape and integrator is written once, generic over [`Real`]. With `f64`, it computes one run; with a
//! bundle of lanes, it computes one run per lane, all of the same topology, side by side. The results of a lane must
//! be bit-identical to those of a single run. So a branch on a number becomes a [`Mask`] and a [`Real::select`], a
//! block may be skipped only if no lane needs it, and the operations on `f64` and on bundles must not differ (no fused
//! multiply-add, and no `sin` from the platform's math library).

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
    /// Result of a comparison, lane by lane.
    type Mask: Mask;

    /// Creates a number that has the same value in every lane.
    fn splat(value: f64) -> Self;
    /// Returns the correctly rounded square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Returns the absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// Returns `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// Returns `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// Returns `yes` in lanes where the mask is set, and `no` in all other lanes.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Returns the number in one lane; an `f64` has only lane 0, which contains the number itself.
    fn lane(self, lane: usize) -> f64;
    /// Creates a number from the `value` of each lane.
    #[must_use]
    fn from_lanes(value: impl FnMut(usize) -> f64) -> Self;
    /// Number of lanes.
    const LANES: usize;

    /// Runs `work`, compiled for the vector unit that computes these numbers.
    ///
    /// All arithmetic on bundles should be inlined into such a scope; outside of a scope, the results are the same but
    /// the code is slow.
    #[inline(always)]
    fn scope<T>(work: impl FnOnce() -> T) -> T {
        work()
    }

    /// Returns zero in every lane.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }
    /// Returns `self > other`.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// Returns the smaller of the two numbers; `other` if they are equal or not comparable.
    #[inline(always)]
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
    /// Returns the larger of the two numbers; `other` if they are equal or not comparable.
    #[inline(always)]
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }
    /// Clamps the number to `-limit..=limit`.
    #[inline(always)]
    #[must_use]
    fn clamp_magnitude(self, limit: Self) -> Self {
        self.min(limit).max(-limit)
    }
    /// Returns `true` in lanes where the number is finite.
    #[inline(always)]
    fn is_finite_mask(self) -> Self::Mask {
        // NaN is not less than anything.
        self.abs().lt(Self::splat(f64::INFINITY))
    }
    /// Returns a copy in which the number in one lane is replaced by `value`.
    #[must_use]
    fn with_lane(self, lane: usize, value: f64) -> Self {
        Self::from_lanes(|l| if l == lane { value } else { self.lane(l) })
    }
    /// Returns the largest of the numbers in all lanes.
    fn largest_lane(self) -> f64 {
        (0..Self::LANES).map(|lane| self.lane(lane)).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Applies a function to both elements of an array.
///
/// `array::map` is not inlined into functions for wide vector units, so every operation in its closure would be a call;
/// these calls took a sixth of the time of a study.
#[inline(always)]
pub(crate) fn both<T, U>([first, second]: [T; 2], apply: impl Fn(T) -> U) -> [U; 2] {
    [apply(first), apply(second)]
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
    /// Number of lanes.
    const LANES: usize;

    /// Creates a mask from the `value` of each lane.
    #[must_use]
    fn from_lanes(value: impl FnMut(usize) -> bool) -> Self;
    /// Returns `true` if at least one lane is set.
    fn any(self) -> bool;
    /// Returns `true` if every lane is set.
    #[inline(always)]
    fn all(self) -> bool {
        !(!self).any()
    }
    /// Returns the value in one lane.
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
