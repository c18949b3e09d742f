//! Synthetic campaigns sampled from a known curve.

use barrelstack_fragility::{Lognormal, Stripe};
use barrelstack_motion::Random;

/// Samples counts from a curve.
pub(crate) fn draw(stripes: &[(f64, u32)], curve: &Lognormal, random: &mut Random) -> Vec<Stripe> {
    stripes
        .iter()
        .map(|&(intensity, cases)| {
            let p = curve.probability(intensity);
            let failures = (0..cases).map(|_| u32::from(random.uniform() < p)).sum();
            Stripe { intensity, cases, failures }
        })
        .collect()
}
