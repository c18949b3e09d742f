//! Losses: barrels that fall, barrels that burst, and their wine.

use barrelstack::breakage::Breakage;
use barrelstack_fragility::{Interval, Lognormal, grouped_mean};

use super::cases::{Cases, JudgedCase};
use super::curve::{LEVEL, interpolate};

/// Assumed probability that a full barrel bursts, as a function of the largest force (N) on the barrel from the time at
/// which it counts as fallen, including its impact.
///
/// The function has not been validated by drop tests. It corresponds to the central assumption of [`Breakage`] for a
/// barrel of 269 kg that falls freely on the floor.
///
/// In that assumption, half of the barrels burst in a fall from 5 m. With the default impact stiffness of scenarios,
/// 1.2 × 10⁹ N/m^1.5, such a fall gives a force of 2.2 MN, which is the median here. The force grows as the fall height
/// to the power 0.6, so that the dispersion of the force is 0.6 times the dispersion of the fall height in
/// [`Breakage`]. A landing on other barrels or on barrel heads is softer than a landing on the floor. For such
/// landings, this function and [`Breakage`] therefore give different probabilities.
pub(super) const BURST_BY_FORCE: Lognormal = Lognormal { median: 2.2e6, dispersion: 0.36 };

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
    /// Expected loss of wine (m³) from barrels that burst, under each of the three assumptions in [`Breakage::RANGE`].
    /// Leaks from the bungs of intact barrels are not counted.
    pub wine: [f64; 3],
    /// Expected number of barrels that burst, estimated from the largest force on each fallen barrel; `None` if the
    /// study does not record forces.
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
    /// Returns the mean losses at each level, or the reason why no losses are reported. Only cases that were simulated
    /// until nothing moved are counted.
    pub(super) fn of(cases: &Cases) -> Result<Self, String> {
        if let Some(reason) = cases.endings.no_losses() {
            return Err(reason);
        }
        if cases.hunted {
            return Err(
                "the levels were chosen by searches for collapse, so a mean over the cases does not apply to a given \
                 level of shaking"
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
