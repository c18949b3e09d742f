//! Bundles of eight numbers in one or more vector registers.
//!
//! Implements [`Real`] for the vectors of `fearless_simd`.
#![allow(clippy::inline_always, reason = "vector code is fast only inside its scope")]

use std::fmt;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub, SubAssign};

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdMask, f64x8, mask64x8};

use crate::real::{Mask, Real};

/// A vector unit whose presence on this machine has been checked.
pub(super) trait Unit: Simd + fmt::Debug + Send + Sync + 'static {
    /// Zero-sized proof that the machine has the unit.
    const TOKEN: Self;
}

/// Eight numbers, one for each lane, on which every operation acts at once.
#[derive(Clone, Copy)]
pub(super) struct Bundle<U: Unit>(f64x8<U>);

/// Eight Booleans, one for each lane.
#[derive(Clone, Copy)]
pub(super) struct BundleMask<U: Unit>(mask64x8<U>);

impl<U: Unit> Real for Bundle<U> {
    type Mask = BundleMask<U>;
    const LANES: usize = super::LANES;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(f64x8::splat(U::TOKEN, value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(SimdFloat::sqrt(self.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(SimdBase::abs(self.0))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> BundleMask<U> {
        BundleMask(self.0.simd_lt(other.0))
    }
    #[inline(always)]
    fn le(self, other: Self) -> BundleMask<U> {
        BundleMask(self.0.simd_le(other.0))
    }
    #[inline(always)]
    fn select(mask: BundleMask<U>, yes: Self, no: Self) -> Self {
        Self(mask.0.select(yes.0, no.0))
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0[lane]
    }
    #[inline(always)]
    fn from_lanes(mut value: impl FnMut(usize) -> f64) -> Self {
        let mut lanes = [0.0; 8];
        for (lane, number) in lanes.iter_mut().enumerate() {
            *number = value(lane);
        }
        Self(f64x8::from_slice(U::TOKEN, &lanes))
    }
    #[inline(always)]
    fn with_lane(mut self, lane: usize, value: f64) -> Self {
        self.0[lane] = value;
        self
    }
    #[inline(always)]
    fn scope<T>(work: impl FnOnce() -> T) -> T {
        U::TOKEN.vectorize(
            #[inline(always)]
            || {
                // Puts a bundle on the stack. The compiler aligns a stack frame for bundles only if the frame contains
                // a bundle before register allocation; otherwise bundles that are spilled later would straddle cache
                // lines.
                std::hint::black_box(&Self::splat(0.0));
                work()
            },
        )
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(SimdBase::min(self.0, other.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(SimdBase::max(self.0, other.0))
    }
}

impl<U: Unit> Mask for BundleMask<U> {
    const LANES: usize = super::LANES;

    #[inline(always)]
    fn from_lanes(mut value: impl FnMut(usize) -> bool) -> Self {
        let bits = (0..8).fold(0, |bits, lane| bits | (u64::from(value(lane)) << lane));
        Self(mask64x8::from_bitmask(U::TOKEN, bits))
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.any_true()
    }
    #[inline(always)]
    fn all(self) -> bool {
        self.0.all_true()
    }
    #[inline(always)]
    fn lane(self, lane: usize) -> bool {
        self.0.to_bitmask() >> lane & 1 == 1
    }
}

impl<U: Unit> Default for Bundle<U> {
    #[inline(always)]
    fn default() -> Self {
        Self::splat(0.0)
    }
}

impl<U: Unit> Default for BundleMask<U> {
    #[inline(always)]
    fn default() -> Self {
        Self(mask64x8::splat(U::TOKEN, false))
    }
}

impl<U: Unit> PartialEq for Bundle<U> {
    fn eq(&self, other: &Self) -> bool {
        (0..8).all(|lane| self.lane(lane) == other.lane(lane))
    }
}

impl<U: Unit> PartialEq for BundleMask<U> {
    fn eq(&self, other: &Self) -> bool {
        self.0.to_bitmask() == other.0.to_bitmask()
    }
}

impl<U: Unit> fmt::Debug for Bundle<U> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries((0..8).map(|lane| self.lane(lane))).finish()
    }
}

impl<U: Unit> fmt::Debug for BundleMask<U> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries((0..8).map(|lane| self.lane(lane))).finish()
    }
}

macro_rules! arithmetic {
    ($($operation:ident $method:ident),*) => {$(
        impl<U: Unit> $operation for Bundle<U> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self($operation::$method(self.0, other.0))
            }
        }
    )*};
}
arithmetic!(Add add, Sub sub, Mul mul, Div div);

impl<U: Unit> Neg for Bundle<U> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<U: Unit> AddAssign for Bundle<U> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<U: Unit> SubAssign for Bundle<U> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<U: Unit> BitAnd for BundleMask<U> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl<U: Unit> BitOr for BundleMask<U> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl<U: Unit> Not for BundleMask<U> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

#[cfg(test)]
mod tests {
    use crate::lanes::{Task, Width};
    use crate::real::{Mask as _, Real};

    /// Task that returns the bits of the minimum and of the maximum of two numbers.
    struct Extremes(f64, f64);

    impl Task for Extremes {
        type Output = [u64; 2];

        fn run<R: Real>(self) -> [u64; 2] {
            let (a, b) = (R::splat(self.0), R::splat(self.1));
            [a.min(b), a.max(b)].map(|number| number.lane(0).to_bits())
        }
    }

    #[test]
    fn the_smaller_and_the_larger_are_those_of_a_single_number() {
        let numbers = [0.0, -0.0, 1.0, -2.5, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        for width in Width::ALL.into_iter().filter(|width| width.is_here()) {
            for (a, b) in numbers.into_iter().flat_map(|a| numbers.map(|b| (a, b))) {
                let alone = Extremes(a, b).run::<f64>();
                assert_eq!(width.run(Extremes(a, b)), Some(alone), "{a} and {b}, {}", width.name());
            }
        }
    }

    /// Task that returns the bits of the results of all operations on pairs of numbers; each lane has one pair.
    struct Operations([[f64; 2]; 8]);

    impl Task for Operations {
        type Output = Vec<[u64; 14]>;

        fn run<R: Real>(self) -> Vec<[u64; 14]> {
            R::scope(|| {
                let [a, b] = [0, 1].map(|side| R::from_lanes(|lane| self.0[lane][side]));
                let (less, at_most) = (a.lt(b), a.le(b));
                let mut sum = a;
                sum += b;
                sum -= R::splat(0.5);
                let numbers = [
                    a + b,
                    a - b,
                    a * b,
                    a / b,
                    -a,
                    a.abs(),
                    a.abs().sqrt(),
                    sum,
                    R::select(less, a, b),
                    a.with_lane(0, 3.0),
                ];
                let masks = [less, less | !at_most, less & at_most, at_most];
                let of = |lane| {
                    let mut bits = [0; 14];
                    // The sign and the payload of NaN are not specified.
                    let bits_of = |x: f64| if x.is_nan() { f64::NAN } else { x }.to_bits();
                    let numbers = numbers.iter().map(|number| bits_of(number.lane(lane)));
                    let masks = masks.iter().map(|mask| u64::from(mask.lane(lane)));
                    bits.iter_mut().zip(numbers.chain(masks)).for_each(|(bit, found)| *bit = found);
                    bits
                };
                (0..R::LANES).map(of).collect()
            })
        }
    }

    #[test]
    fn every_operation_has_in_each_lane_the_bits_of_a_single_number() {
        // Under Miri, which is compiled for AVX2, the test must not pass merely because AVX2 was not detected.
        assert!(!cfg!(target_feature = "avx2") || Width::Avx2.is_here());
        let numbers = [0.0, -0.0, 1.0, -2.5, 1e-310, 0.1, f64::INFINITY, f64::MAX];
        for shift in 0..numbers.len() {
            let pairs: [[f64; 2]; 8] = std::array::from_fn(|lane| {
                [numbers[lane], numbers[(lane + shift) % numbers.len()]]
            });
            let mut alone: Vec<_> =
                pairs.iter().map(|pair| Operations([*pair; 8]).run::<f64>()[0]).collect();
            // The tenth result replaces the number of the first lane only.
            for (result, pair) in alone.iter_mut().zip(&pairs).skip(1) {
                result[9] = pair[0].to_bits();
            }
            for width in Width::ALL.into_iter().skip(1).filter(|width| width.is_here()) {
                assert_eq!(width.run(Operations(pairs)), Some(alone.clone()), "{}", width.name());
            }
        }
    }
}
