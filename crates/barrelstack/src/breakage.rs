//! Assumptions about barrels that burst in a fall, and about their cost.

use barrelstack_fragility::Lognormal;

/// Assumed probability that a full barrel bursts in a fall, as a lognormal function of the fall height.
///
/// No published drop tests of barrels were found. Of the barrels that toppled at Napa in 2014 about one in
/// ten was lost (Wines & Vines 2016); the levels from which they fell are not recorded. A lognormal function
/// with a median of 5 m and a dispersion of 0.6 agrees with that share. At 0.9 m per level, 0.2 % of the
/// barrels that fall from the second level burst, 4 % from the third, 15 % from the fourth, 29 % from the
/// fifth and 43 % from the sixth. If a stack of four to six levels falls completely, 7 % to 18 % of the
/// barrels above the lowest level burst. [`Breakage::RANGE`] also has medians of 3.5 m and 7 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breakage {
    /// Fall height (m) at which half of the barrels burst.
    pub median: f64,
    /// Standard deviation of the logarithm of the fall height at which a barrel bursts.
    pub dispersion: f64,
}

impl Breakage {
    /// Three alternative assumptions, in this order: few barrels burst, the central assumption, many barrels
    /// burst.
    pub const RANGE: [Self; 3] = [
        Self { median: 7.0, dispersion: 0.6 },
        Self { median: 5.0, dispersion: 0.6 },
        Self { median: 3.5, dispersion: 0.6 },
    ];

    /// Returns the probability that a barrel bursts in a fall from a height (m).
    pub fn probability(&self, fall: f64) -> f64 {
        Lognormal { median: self.median, dispersion: self.dispersion }.probability(fall)
    }
}

/// Volume of wine in a bottle (m³).
///
/// A barrel of 225 L fills 300 bottles, that is, 25 cases (The Californian 2014).
const BOTTLE: f64 = 0.75e-3;

/// Assumed lower and upper bounds (US$) of the price at which the cellar could have sold a bottle of wine.
const BOTTLE_COST: [f64; 2] = [4.0, 20.0];

/// Assumed lower and upper bounds (US$) of the cost of a burst barrel of any size, without its wine.
const BARREL_COST: [f64; 2] = [400.0, 1200.0];

/// Returns the lower and upper bounds (US$) of the cost of a number of burst barrels and of their wine, whose volume
/// is `wine` (m³).
pub fn cost(barrels: f64, wine: f64) -> [f64; 2] {
    [0, 1].map(|end| wine / BOTTLE * BOTTLE_COST[end] + barrels * BARREL_COST[end])
}
