//! What a study means at a site: annual rates, from a hazard curve of its own.

use std::path::Path;

use barrelstack_fragility::{Contribution, Hazard, Interval, Lognormal, Rate, chance_within};

use super::DecisionError;
use super::cases::Cases;
use super::curve::{LEVEL, LimitCurve};
use super::limit::LimitState;
use super::loss::{Losses, cost};
use crate::measured::{Table, TableError};
use crate::scenario::Dimension;

/// How often a site is shaken how hard, as read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct SiteHazard {
    /// What the file is called.
    pub file: String,
    /// Name of the measure, which is that of its column.
    pub measure: String,
    /// The curve, in SI units and a year.
    pub hazard: Hazard,
}

/// Measures that a hazard curve may be over, with what they measure.
const MEASURES: [(&str, Dimension); 8] = [
    ("pga", Dimension::ACCELERATION),
    ("pgv", Dimension::VELOCITY),
    ("sa_0.3", Dimension::ACCELERATION),
    ("sa_0.5", Dimension::ACCELERATION),
    ("sa_1.0", Dimension::ACCELERATION),
    ("arias", Dimension::VELOCITY),
    ("cav", Dimension::VELOCITY),
    ("pgd", Dimension::LENGTH),
];

impl SiteHazard {
    /// Reads a table (CSV) of two columns: the intensity with its unit, such as `pgv (cm/s)`, and `rate (1/year)`,
    /// the annual rate at which it is exceeded.
    ///
    /// # Errors
    /// When the file cannot be read, a column or a unit is missing, or the rows are no hazard curve.
    pub fn load(path: &Path) -> Result<Self, TableError> {
        Self::of(&Table::load(path)?)
    }

    /// The same from a text; `file` is what errors call it.
    ///
    /// # Errors
    /// As [`SiteHazard::load`].
    pub fn parse(file: &str, text: &str) -> Result<Self, TableError> {
        Self::of(&Table::parse(file, text)?)
    }

    fn of(table: &Table) -> Result<Self, TableError> {
        let unsuited =
            |reason: String| TableError::Unsuited { file: table.file().to_owned(), reason };
        let known = MEASURES.iter().find(|(name, _)| table.has(name));
        let Some((measure, dimension)) = known else {
            let names: Vec<&str> = MEASURES.iter().map(|(name, _)| *name).collect();
            let found: Vec<&str> = table.names().collect();
            return Err(unsuited(format!(
                "expected a column of one of the measures {}, with its unit, as in `pgv (cm/s)`; found {}",
                names.join(", "),
                found.join(", ")
            )));
        };
        let intensities = table.positive(measure, *dimension)?;
        let rates = table.per_year("rate")?;
        let rows: Vec<(f64, f64)> = intensities.into_iter().zip(rates).collect();
        let hazard = Hazard::new(&rows).map_err(|error| unsuited(error.to_string()))?;
        Ok(Self { file: table.file().to_owned(), measure: (*measure).to_owned(), hazard })
    }
}

/// How often a limit state is reached.
#[derive(Clone, Debug)]
pub struct LimitRate {
    /// What counts as failure.
    pub limit: LimitState,
    /// A year, by the fitted curve.
    pub fitted: Option<Rate>,
    /// Its 95 % interval, for the uncertainty of the curve alone.
    pub interval: Option<Interval>,
    /// A year, by the raw fractions.
    pub raw: Rate,
    /// Chance of at least one within the years asked for, by the fitted curve, or by the raw fractions without.
    pub chance: f64,
}

/// What one stack is expected to lose a year.
#[derive(Clone, Debug)]
pub struct Lost {
    /// Barrels that fall.
    pub fallen: Rate,
    /// Barrels that burst, under few, the central and many.
    pub burst: [Rate; 3],
    /// Wine (m³) that is lost, likewise.
    pub wine: [f64; 3],
    /// What those that burst under the central assumption cost (US$), with their wine, from and to.
    pub money: [f64; 2],
}

/// What a study means at a site.
#[derive(Clone, Debug)]
pub struct Site {
    /// The hazard.
    pub hazard: SiteHazard,
    /// Years for which chances are given.
    pub years: f64,
    /// One for each limit state.
    pub limits: Vec<LimitRate>,
    /// What is expected to be lost a year; none where the study does not tell what falls.
    pub lost: Option<Lost>,
    /// Where the rate of collapse comes from, by intensity.
    pub contributions: Vec<Contribution>,
}

impl Site {
    /// Folds the curves over the measure of the study, of which the first is of collapse, with the hazard.
    pub(super) fn of(
        cases: &Cases,
        curves: &[LimitCurve],
        hazard: &SiteHazard,
        years: f64,
        losses: Option<&Losses>,
    ) -> Result<Self, DecisionError> {
        if cases.measure().name != hazard.measure {
            return Err(TableError::Unsuited {
                file: hazard.file.clone(),
                reason: format!(
                    "the hazard is over {}, but the curves of the study are over {}; give the hazard over that",
                    hazard.measure,
                    cases.measure().name
                ),
            }
            .into());
        }
        let curve = &hazard.hazard;
        let limits = curves.iter().map(|limit| rate(curve, years, limit)).collect();
        let collapse = &curves[0];
        let chance = |x: f64| match &collapse.fit {
            Ok(fit) => fit.curve.probability(x),
            Err(_) => collapse.raw(x),
        };
        let lost = losses.map(|losses| {
            let most = f64::from(losses.barrels);
            let burst = [0, 1, 2].map(|i| curve.expected(most, |x| losses.burst(x, i)));
            let wine =
                [0, 1, 2].map(|i| curve.expected(losses.most_wine, |x| losses.wine(x, i)).low);
            Lost {
                fallen: curve.expected(most, |x| losses.fallen(x)),
                money: cost(burst[1].low, wine[1]),
                wine,
                burst,
            }
        });
        Ok(Self {
            hazard: hazard.clone(),
            years,
            limits,
            lost,
            contributions: curve.contributions(&edges(curve), chance),
        })
    }
}

fn rate(hazard: &Hazard, years: f64, curve: &LimitCurve) -> LimitRate {
    let fitted = curve.fit.as_ref().ok().map(|fit| hazard.rate_of(|x| fit.curve.probability(x)));
    let interval = curve.left_out.as_ref().map(|found| {
        let ln_rate = |curve: &Lognormal| libm::log(hazard.rate_of(|x| curve.probability(x)).low);
        let bounds = found.interval(LEVEL, ln_rate);
        Interval { low: libm::exp(bounds.low), high: libm::exp(bounds.high) }
    });
    let raw = hazard.rate_of(|x| curve.raw(x));
    let chance = chance_within(years, fitted.as_ref().unwrap_or(&raw).low);
    LimitRate { limit: curve.limit.clone(), fitted, interval, raw, chance }
}

/// Twelve stretches of the table, even in the logarithm.
fn edges(hazard: &Hazard) -> Vec<f64> {
    let rows = hazard.rows();
    let (first, last) = (rows[0].0, rows[rows.len() - 1].0);
    let step = libm::log(last / first) / 12.0;
    (0..=12).map(|i| if i == 12 { last } else { first * libm::exp(step * f64::from(i)) }).collect()
}
