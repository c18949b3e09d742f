//! The scalar of the physics: one `f64`, or many of them in lockstep.
//!
//! Every force, shape and integrator is written once against [`Real`].
//! With `f64` it is one run; with a bundle of lanes it is as many runs of one topology side by side.
//! The rule that keeps a lane equal to a single run, bit for bit: a branch on a number becomes a
//! [`Mask`] and a [`Real::select`], a block may be skipped only when no lane wants it, and no
//! operation may differ between the two (no fused multiply-add, no platform sine).

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};

/// A number, or a bundle of numbers that march in lockstep.
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
    /// How many numbers march together.
    const LANES: usize;

    /// Zero in every lane.
    #[inline]
    fn zero() -> Self {
        Self::splat(0.0)
    }
    /// `self > other`.
    #[inline]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// The smaller of the two; `other` where they are equal or not comparable.
    #[inline]
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
    /// The larger of the two; `other` where they are equal or not comparable.
    #[inline]
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }
    /// The number held between `-limit` and `limit`.
    #[inline]
    #[must_use]
    fn clamp_magnitude(self, limit: Self) -> Self {
        self.min(limit).max(-limit)
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
    /// Holds in at least one lane.
    fn any(self) -> bool;
    /// Holds in one lane.
    fn lane(self, lane: usize) -> bool;
}

impl Real for f64 {
    type Mask = bool;
    const LANES: usize = 1;

    #[inline]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline]
    fn abs(self) -> Self {
        Self::abs(self)
    }
    #[inline]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline]
    fn le(self, other: Self) -> bool {
        self <= other
    }
    #[inline]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline]
    fn lane(self, _lane: usize) -> f64 {
        self
    }
}

impl Mask for bool {
    #[inline]
    fn any(self) -> bool {
        self
    }
    #[inline]
    fn lane(self, _lane: usize) -> bool {
        self
    }
}
