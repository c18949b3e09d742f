//! Losses: barrels that fall, barrels that burst, and their wine.

use barrelstack_fragility::{Interval, Lognormal, grouped_mean};

use super::cases::{Cases, JudgedCase};
use super::curve::{LEVEL, interpolate};

/// Assumed probability that a full barrel bursts in a fall, as a lognormal function of the height of the fall.
///
/// No published drop tests of barrels were found. Of the barrels that toppled at Napa in 2014 about one in
/// ten was lost (Wines & Vines 2016); the levels from which they fell are not recorded. A lognormal function
/// with a median of 5 m and a dispersion of 0.6 agrees with that share. At 0.9 m per level, 0.2 % of the
/// barrels that fall from the second level burst, 4 % from the third, 15 % from the fourth, 29 % from the
/// fifth and 43 % from the sixth. If a stack of four to six levels falls completely, 7 % to 18 % of the
/// barrels above the lowest level burst. Results are also given for medians of 3.5 m and 7 m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Breakage {
    /// Height of fall (m) at which half of the barrels burst.
    pub median: f64,
    /// Standard deviation of the logarithm of the height of fall at which a barrel bursts.
    pub dispersion: f64,
}

impl Breakage {
    /// The three assumptions of breakage, in this order: few barrels burst, the central assumption, many
    /// barrels burst.
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

/// Assumed probability that a full barrel bursts, as a function of the largest force (N) on the barrel after
/// it fell.
///
/// The function has not been tested. It corresponds to the central assumption of [`Breakage`] for a barrel of
/// 269 kg that falls freely on the floor.
///
/// With the default impact law of scenarios, 1.2 × 10⁹ N/m^1.5, a fall from 5 m gives a force of 2.2 MN. The
/// force grows as the height to the power 0.6, so that the dispersion of the force is 0.6 times that of the
/// height. A landing on other barrels or on barrel heads is softer than a landing on the floor, so that the
/// two assumptions differ there.
pub(super) const BURST_BY_FORCE: Lognormal = Lognormal { median: 2.2e6, dispersion: 0.36 };

/// Volume of wine in a bottle (m³).
const BOTTLE: f64 = 0.75e-3;

/// Assumed lower and upper value (US$) of a bottle of wine, for which the cellar could have sold it.
///
/// A barrel of 225 L holds 25 cases of wine (The Californian 2014).
const BOTTLE_COST: [f64; 2] = [4.0, 20.0];

/// Assumed lower and upper cost (US$) of a burst barrel of any size, without its wine.
const BARREL_COST: [f64; 2] = [400.0, 1200.0];

/// Returns the lower and upper cost (US$) of a number of burst barrels and of their wine, whose volume is
/// `wine` (m³).
pub(super) fn cost(barrels: f64, wine: f64) -> [f64; 2] {
    [0, 1].map(|end| wine / BOTTLE * BOTTLE_COST[end] + barrels * BARREL_COST[end])
}

/// Expected losses of one stack at a level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// Intensity (SI) of the level.
    pub intensity: f64,
    /// Number of cases.
    pub cases: usize,
    /// Mean number of barrels that fall.
    pub fallen: f64,
    /// 95 % interval of the mean number of barrels that fall, clustered by record.
    pub interval: Interval,
    /// Expected number of barrels that burst, under each of the three assumptions in [`Breakage::RANGE`].
    pub burst: [f64; 3],
    /// Expected loss of wine (m³), under each of the three assumptions. It is the contents of the barrels
    /// that burst. Leaks from the bungs of intact barrels are not counted.
    pub wine: [f64; 3],
    /// Expected number of barrels that burst, if the largest force on a barrel determines whether it bursts;
    /// `None` if the study does not record forces.
    pub burst_by_force: Option<f64>,
}

/// Expected losses of one stack as a function of the intensity measure of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct Losses {
    /// Losses at each level, in ascending order of intensity.
    pub levels: Vec<Loss>,
    /// Largest number of barrels in the stack of any case.
    pub barrels: u32,
    /// Largest volume of wine (m³) in the stack of any case.
    pub most_wine: f64,
}

impl Losses {
    /// Returns the mean losses at each level, or the reason why they are unknown. Only cases that were
    /// simulated until nothing moved are counted.
    pub(super) fn of(cases: &Cases) -> Result<Self, String> {
        if let Some(reason) = cases.endings.no_losses() {
            return Err(reason);
        }
        if cases.hunted {
            return Err(
                "the levels were chosen by hunts for collapse, so that a mean over the cases belongs to no level of \
                        shaking"
                    .to_owned(),
            );
        }
        let known = cases.with_known_falls();
        let levels = known.groups(known.main).iter().map(|(x, of)| at(*x, of)).collect();
        Ok(Self { levels, barrels: cases.most_barrels(), most_wine: cases.most_wine() })
    }

    /// Returns the expected number of fallen barrels at an intensity.
    pub fn fallen(&self, intensity: f64) -> f64 {
        self.interpolated(intensity, |loss| loss.fallen)
    }

    /// Returns the expected number of burst barrels at an intensity, under the assumption at the index
    /// `assumption` in [`Breakage::RANGE`].
    pub fn burst(&self, intensity: f64, assumption: usize) -> f64 {
        self.interpolated(intensity, |loss| loss.burst[assumption])
    }

    /// Returns the expected loss of wine (m³) at an intensity, under the assumption at the index `assumption`
    /// in [`Breakage::RANGE`].
    pub fn wine(&self, intensity: f64, assumption: usize) -> f64 {
        self.interpolated(intensity, |loss| loss.wine[assumption])
    }

    fn interpolated(&self, intensity: f64, of: impl Fn(&Loss) -> f64) -> f64 {
        let points: Vec<(f64, f64)> = self.levels.iter().map(|l| (l.intensity, of(l))).collect();
        interpolate(&points, intensity)
    }
}

fn at(intensity: f64, of: &[&JudgedCase]) -> Loss {
    let count = of.len() as f64;
    let fallen = of.iter().map(|case| f64::from(case.fallen())).sum::<f64>() / count;
    let burst = Breakage::RANGE.map(|breakage| {
        let falls = of.iter().flat_map(|case| case.falls.iter());
        falls.map(|fall| breakage.probability(*fall)).sum::<f64>() / count
    });
    let wine = Breakage::RANGE.map(|breakage| {
        let falls = of.iter().flat_map(|case| case.falls.iter().zip(&case.wines));
        falls.map(|(fall, wine)| wine * breakage.probability(*fall)).sum::<f64>() / count
    });
    let recorded: Option<Vec<&[f64]>> = of.iter().map(|case| case.forces.as_deref()).collect();
    let burst_by_force = recorded.map(|forces| {
        let all = forces.into_iter().flatten();
        all.map(|force| BURST_BY_FORCE.probability(*force)).sum::<f64>() / count
    });
    let mut records = std::collections::BTreeMap::<u32, (f64, f64)>::new();
    for case in of {
        let record = records.entry(case.record).or_default();
        *record = (record.0 + case.fallen_share(), record.1 + 1.0);
    }
    let most = of.iter().map(|case| case.barrels).max().map_or(0.0, f64::from);
    let share = grouped_mean(&records.into_values().collect::<Vec<_>>(), LEVEL);
    let interval = Interval { low: most * share.low, high: most * share.high };
    Loss { intensity, cases: of.len(), fallen, interval, burst, wine, burst_by_force }
}
