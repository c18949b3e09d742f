//! A seeded random number generator that produces the same numbers on every machine and in every
//! version.
//!
//! The generator is xoshiro256++ (Blackman and Vigna 2021), seeded by splitmix64, from the crate
//! `rand_xoshiro`, which guarantees its values. Normal deviates use the Box-Muller method with this
//! crate's logarithm, sine and cosine.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng as _, SeedableRng as _};

use crate::math::{self, TAU};

/// Random number generator that all synthetic motions use.
///
/// ```
/// use barrelstack_series::random::Random;
/// let (mut one, mut two) = (Random::new(7), Random::new(7));
/// assert_eq!(one.uniform(), two.uniform());
/// ```
#[derive(Clone, Debug)]
pub struct Random {
    bits: Xoshiro256PlusPlus,
    spare: Option<f64>,
}

impl Random {
    /// Creates a generator from `seed`.
    pub fn new(seed: u64) -> Self {
        Self { bits: Xoshiro256PlusPlus::seed_from_u64(seed), spare: None }
    }

    /// Returns 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.bits.next_u64()
    }

    /// Returns a uniform random number in `[0, 1)`, with 53 random bits.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    /// Returns a normal random number with mean 0 and variance 1.
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * math::ln(1.0 - self.uniform())).sqrt();
        let (s, c) = math::sin_cos(TAU * self.uniform());
        self.spare = Some(radius * s);
        radius * c
    }
}
