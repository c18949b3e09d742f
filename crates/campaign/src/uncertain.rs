//! Ranges in which the results of a study lie as the uncertain constants of the seats vary.
//!
//! Every run of a study of stack heights, a ranking or a score draws its own friction, stiffness and damping. The same
//! regression as for the variants of a stack ([`Fitted`]) separates the effect of these constants from the sampling
//! error. Since each motion is run at several levels of shaking, the regression has a term for every motion and for the
//! level.

use barrelstack::variants::Constant;
use barrelstack_fragility::{Conditional, Intensities, Interval, Shaken, Shape, Stripe, shaken};
use barrelstack_motion::Random;

pub use barrelstack::variants::Fitted;

use crate::decision::Cases;
use crate::study::{Collected, Column, Distribution, Study, Value};

/// Uncertain constants: for each, the path of its field in a scenario, and its name in reports.
const CONSTANTS: [(&str, &str); 12] = [
    ("interface.rack-ground.friction.coefficient", "friction of racks on the floor"),
    ("interface.rack-ground.stiffness", "stiffness of racks on the floor"),
    ("interface.rack-ground.damping", "damping of racks on the floor"),
    ("interface.rack-ground.restitution", "damping of racks on the floor"),
    ("interface.barrel-rack.friction.coefficient", "friction of barrels on racks"),
    ("interface.barrel-rack.stiffness", "stiffness of barrels on racks"),
    ("interface.barrel-rack.damping", "damping of barrels on racks"),
    ("interface.barrel-rack.restitution", "damping of barrels on racks"),
    ("interface.rack-rack.friction.coefficient", "friction of racks on racks"),
    ("interface.rack-rack.stiffness", "stiffness of racks on racks"),
    ("interface.rack-rack.damping", "damping of racks on racks"),
    ("interface.rack-rack.restitution", "damping of racks on racks"),
];

/// Units of the constants: for each, the notation in tables, and the notation in reports.
const UNITS: [(&str, &str); 7] = [
    ("", "1"),
    ("N/m", "N/m"),
    ("N/m^2", "N/m²"),
    ("N/m^1.5", "N/m^1.5"),
    ("N/m^2.5", "N/m^2.5"),
    ("N s/m", "N·s/m"),
    ("N s/m^2", "N·s/m²"),
];

/// Uncertain constant that a study draws for every run.
#[derive(Clone, Debug, PartialEq)]
struct Drawn {
    /// Name of the column of the constant.
    column: String,
    name: &'static str,
    field: &'static str,
    unit: &'static str,
    distribution: Distribution,
}

impl Drawn {
    fn constant(&self) -> Constant<'_> {
        let value = |deviate| self.distribution.at_deviate(deviate);
        let mut dispersion = self.distribution.dispersion();
        if self.field.ends_with(".restitution")
            && let Some(median) = value(0.0)
        {
            // Convert to the dispersion of the damping ratio, which is proportional to the logarithm of the
            // restitution.
            dispersion /= -libm::log(median);
        }
        let Self { name, field, unit, .. } = *self;
        Constant { name, field, unit, dispersion, value: Box::new(value) }
    }
}

/// Runs of a stack with the constants that were drawn for them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sample {
    constants: Vec<Drawn>,
    /// Names of the motions; each run refers to its motion by the index in this list.
    motions: Vec<String>,
    runs: Vec<Shaken>,
    seed: u64,
    /// Correlation matrix of the standard normal deviates of the constants.
    correlations: Vec<Vec<f64>>,
    /// `true` if there is a run without a verdict, or one whose intensity or constants are not all known.
    incomplete: bool,
}

impl Sample {
    /// Creates a sample from the cases of a study.
    pub(crate) fn of(study: &Study, collected: &Collected, cases: &Cases) -> Self {
        let mut sample = Self::default();
        sample.add(study, collected, cases);
        sample.incomplete |= cases.left_out > 0;
        sample
    }

    /// Adds the cases of another study of the same stack, which may use different motions.
    pub(crate) fn add(&mut self, study: &Study, collected: &Collected, cases: &Cases) {
        if self.runs.is_empty() {
            (self.constants, self.seed) = (drawn(study), study.seed);
            let columns = || self.constants.iter().map(|one| &*one.column);
            let row = |one| columns().map(|other| study.correlation([one, other])).collect();
            self.correlations = columns().map(row).collect();
        }
        let columns = self.constants.iter().map(|one| collected.table.column(&one.column));
        let Some(columns) = columns.collect::<Option<Vec<_>>>() else {
            self.incomplete = true;
            return;
        };
        for case in &cases.all {
            let deviate =
                |(one, column): (&Drawn, &&Column)| match column.values.get(case.row as usize)? {
                    Value::Number(value) => one.distribution.deviate(value),
                    Value::Integer(_) | Value::Text(_) => None,
                };
            let deviates = self.constants.iter().zip(&columns).map(deviate).collect();
            let (Some(deviates), Some(intensity)) = (deviates, case.intensity(cases.main)) else {
                self.incomplete = true;
                continue;
            };
            let name = &cases.records[case.record as usize];
            let known = self.motions.iter().position(|motion| motion == name);
            let motion = known.unwrap_or_else(|| {
                self.motions.push(name.clone());
                self.motions.len() - 1
            });
            self.runs.push(Shaken { deviates, motion, intensity, failed: case.collapsed });
        }
    }

    /// Marks the sample as incomplete, because a run has no verdict.
    pub(crate) fn lacks_a_verdict(&mut self) {
        self.incomplete = true;
    }

    /// Returns the intensities of all runs.
    pub(crate) fn intensities(&self) -> impl Iterator<Item = f64> {
        self.runs.iter().map(|run| run.intensity)
    }

    /// `true` if no constant is drawn, so that the range of a share is its confidence interval.
    pub(crate) fn is_certain(&self) -> bool {
        self.constants.is_empty()
    }

    /// Fits the share of collapses as a function of intensity and constants; `None` if no constant is drawn, if a run
    /// has no verdict, or if there are too few runs.
    pub(crate) fn fit(&self, shape: Shape) -> Option<Intensities> {
        if self.incomplete {
            return None;
        }
        let mut random = Random::new(self.seed);
        let fitted = shaken(&self.runs, shape, || random.uniform())?;
        Some(fitted.correlated(self.correlations.clone()))
    }

    /// Returns the 95 % range of a share of collapses as the uncertain constants vary, and the effect of each constant
    /// on this share.
    pub(crate) fn effect(&self, share: &Conditional) -> Fitted {
        let constants: Vec<Constant<'_>> = self.constants.iter().map(Drawn::constant).collect();
        Fitted::of(share, &constants)
    }
}

/// Returns the uncertain constants that a study draws for every run.
fn drawn(study: &Study) -> Vec<Drawn> {
    let of = |(column, field, unit, distribution): (&str, &str, &str, &Distribution)| {
        let (field, name) = *CONSTANTS.iter().find(|(known, _)| *known == field)?;
        let unit = UNITS.iter().find(|(known, _)| *known == unit).map_or("SI", |(_, unit)| unit);
        let (column, distribution) = (column.to_owned(), distribution.clone());
        Some(Drawn { column, name, field, unit, distribution })
    };
    study.distributions().filter_map(of).collect()
}

impl Sample {
    /// Returns, for each element of `stripes`, the 95 % range of the share of collapses at its intensity as the
    /// constants vary, and the effect of each constant on this share.
    ///
    /// Without uncertain constants, the range is the confidence interval of the share, which `sampled` returns. An
    /// element of the result is `None` if the runs cannot be fitted at its intensity.
    pub(crate) fn at_levels(
        &self,
        stripes: &[Stripe],
        sampled: impl Fn(&Stripe) -> Interval,
    ) -> Vec<Option<Fitted>> {
        let fit = self.fit(Shape::Levels);
        let of = |stripe: &Stripe| {
            if self.is_certain() {
                let Interval { low, high } = sampled(stripe);
                let as_stated = stripe.fraction();
                return Some(Fitted { range: [low, high], as_stated, decides: Vec::new() });
            }
            Some(self.effect(&fit.as_ref()?.at(stripe.intensity)?))
        };
        stripes.iter().map(of).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test")]

    use barrelstack_fragility::wilson;

    use super::*;
    use crate::protect::shaken;
    use crate::scenario::{Scenario, Until};

    #[test]
    fn every_drawn_constant_of_a_stack_is_known_and_its_deviates_return() {
        for (rack, count) in [("two-barrel", 6), ("rack-on-rack", 9)] {
            let change = format!("stack.rack=\"{rack}\"");
            let scenario = ["stack.view=transverse".to_owned(), change];
            let scenario = Scenario::builtin("demo-napa", &scenario).unwrap();
            let motion = "[[motion]]\nbundled = \"napa-college-2014\"\n\n";
            let study = shaken("s", (&scenario, Until::Verdict), 1, motion, &[0.3]).unwrap();
            let drawn = drawn(&study);
            assert_eq!(drawn.len(), study.distributions().count(), "{rack}");
            assert_eq!(drawn.len(), count, "{rack}");
            for one in &drawn {
                assert_ne!(one.unit, "SI", "{}", one.field);
                let constant = one.constant();
                assert!((0.05..1.0).contains(&constant.dispersion), "{}", one.field);
                for deviate in [-2.0, -0.3, 0.0, 1.7] {
                    let value = (constant.value)(deviate).unwrap();
                    let found = one.distribution.deviate(value).unwrap();
                    assert!((found - deviate).abs() < 1e-6, "{} {found}", one.field);
                }
            }
        }
    }

    #[test]
    fn the_correlation_of_friction_reaches_the_fit() {
        let changes = ["stack.view=transverse", "unknowns.friction_correlation=0.4"];
        let scenario = Scenario::builtin("demo-napa", &changes.map(str::to_owned)).unwrap();
        let motion = "[[motion]]\nbundled = \"napa-college-2014\"\n\n";
        let study = shaken("s", (&scenario, Until::Verdict), 1, motion, &[0.3]).unwrap();
        let columns = ["friction rack-ground", "friction barrel-rack", "stiffness barrel-rack"];
        assert_eq!(study.correlation([columns[0], columns[1]]), 0.4);
        assert_eq!(study.correlation([columns[1], columns[2]]), 0.0);
        assert_eq!(study.correlation([columns[2], columns[2]]), 1.0);
    }

    #[test]
    fn without_uncertain_constants_the_range_is_the_interval_of_sampling() {
        let stripe = Stripe { intensity: 0.5, cases: 24, failures: 7 };
        let sampled = |of: &Stripe| wilson(of.failures, of.cases, 0.95);
        let found = Sample::default().at_levels(&[stripe], sampled);
        let (effect, interval) = (found[0].as_ref().unwrap(), sampled(&stripe));
        assert_eq!(effect.range, [interval.low, interval.high]);
        assert!((effect.as_stated - 7.0 / 24.0).abs() < 1e-15 && effect.decisive().is_none());
    }
}
