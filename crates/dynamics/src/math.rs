//! Transcendental functions that return the same bits on every machine; the crate uses no others.

use crate::real::{Mask, Real};

pub use libm::{
    acos, acosh, asin, atan, atan2, cbrt, cos, exp, hypot, log, log1p, log10, pow, sin, tan,
};

/// Returns sine and cosine of an angle (rad) for one number or a bundle of lanes.
///
/// The nearest multiple of π/2 is subtracted from the angle in three parts (Cody and Waite), and sine and cosine of the
/// remainder are evaluated with the minimax polynomials of the FreeBSD mathematics library. The measured error is below
/// 1 ulp for |angle| up to 1e5 rad, which exceeds the rotation of any barrel.
#[inline(always)]
pub fn sin_cos<R: Real>(angle: R) -> (R, R) {
    // Adding and subtracting 1.5·2^52 rounds to the nearest integer without a rounding instruction.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    let quarters =
        (angle * R::splat(std::f64::consts::FRAC_2_PI) + R::splat(ROUNDER)) - R::splat(ROUNDER);
    let r = angle - quarters * R::splat(1.570_796_251_296_997);
    let r = r - quarters * R::splat(7.549_789_415_861_596e-8);
    let r = r - quarters * R::splat(5.390_302_858_158_119e-15);
    let z = r * r;

    let sine = r + r
        * z
        * (R::splat(-1.666_666_666_666_663_2e-1)
            + z * (R::splat(8.333_333_333_322_49e-3)
                + z * (R::splat(-1.984_126_982_985_795e-4)
                    + z * (R::splat(2.755_731_370_707_007e-6)
                        + z * (R::splat(-2.505_076_025_340_686_3e-8)
                            + z * R::splat(1.589_690_995_211_55e-10))))));
    let cosine = R::splat(1.0) - z * R::splat(0.5)
        + z * z
            * (R::splat(4.166_666_666_666_66e-2)
                + z * (R::splat(-1.388_888_888_887_411e-3)
                    + z * (R::splat(2.480_158_728_947_673e-5)
                        + z * (R::splat(-2.755_731_435_139_066_3e-7)
                            + z * (R::splat(2.087_572_321_298_175e-9)
                                + z * R::splat(-1.135_964_755_778_819_5e-11))))));

    // The quadrant, k mod 4, is computed with floating-point numbers, so that lanes need no integers.
    let half = (quarters * R::splat(0.5) + R::splat(ROUNDER)) - R::splat(ROUNDER);
    let odd = R::zero().lt((quarters - half * R::splat(2.0)).abs());
    let quarter_floor = R::select(odd, quarters - R::splat(1.0), quarters);
    let turns = (quarter_floor * R::splat(0.25) + R::splat(ROUNDER)) - R::splat(ROUNDER);
    let opposite = R::zero().lt((quarter_floor - turns * R::splat(4.0)).abs());
    let (s, c) = (R::select(odd, cosine, sine), R::select(odd, -sine, cosine));
    (R::select(opposite, -s, s), R::select(opposite, -c, c))
}

/// Returns `sin x / x` and `cos x` from the square of `x` (rad²).
///
/// Below 0.1 rad, which covers the rotation in one time step, both are evaluated by series whose first omitted terms
/// are below 1e-17, without a square root, a division or a range reduction.
#[inline(always)]
pub fn sinc_cos<R: Real>(square: R) -> (R, R) {
    let one = R::splat(1.0);
    let sinc = one
        + square
            * (R::splat(-1.0 / 6.0)
                + square
                    * (R::splat(1.0 / 120.0)
                        + square * (R::splat(-1.0 / 5040.0) + square * R::splat(1.0 / 362_880.0))));
    let cos = one
        + square
            * (R::splat(-0.5)
                + square
                    * (R::splat(1.0 / 24.0)
                        + square
                            * (R::splat(-1.0 / 720.0)
                                + square
                                    * (R::splat(1.0 / 40_320.0)
                                        + square * R::splat(-1.0 / 3_628_800.0)))));
    let small = square.lt(R::splat(0.01));
    if small.all() {
        return (sinc, cos);
    }
    let angle = R::select(small, one, square).sqrt();
    let (sin_of_it, cos_of_it) = sin_cos(angle);
    (R::select(small, sinc, sin_of_it / angle), R::select(small, cos, cos_of_it))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_agree_with_the_library() {
        let mut worst = 0.0_f64;
        for i in -20_000..20_000 {
            let angle = f64::from(i) * 0.013_7;
            let (s, c) = sin_cos(angle);
            worst = worst.max((s - sin(angle)).abs()).max((c - cos(angle)).abs());
        }
        assert!(worst < 4e-16, "worst {worst:e}"); // measured 2.2e-16
    }

    #[test]
    fn shares_of_small_and_large_turns_agree_with_the_library() {
        let mut worst = 0.0_f64;
        for i in 1..20_000 {
            let angle = f64::from(i) * 1.3e-4;
            let (s, c) = sinc_cos(angle * angle);
            worst = worst.max((s - sin(angle) / angle).abs()).max((c - cos(angle)).abs());
        }
        assert_eq!(sinc_cos(0.0), (1.0, 1.0));
        assert!(worst < 4e-16, "worst {worst:e}"); // measured 2.2e-16
    }
}
