//! Data sets with known results.

use barrelstack_fragility::Stripe;

/// Returns eight stripes of twenty cases, whose fit is known to five digits from an independent computation.
pub(crate) fn eight_stripes() -> Vec<Stripe> {
    let x = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0];
    let z = [0, 1, 5, 9, 12, 15, 18, 20];
    x.iter()
        .zip(z)
        .map(|(&intensity, failures)| Stripe { intensity, cases: 20, failures })
        .collect()
}
