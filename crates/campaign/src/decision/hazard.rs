//! Annual rates of collapse and loss at a site, from its hazard curve.

use std::path::Path;

use barrelstack::breakage::cost;
use barrelstack_fragility::{Contribution, Hazard, Interval, Lognormal, Rate, chance_within};

use super::DecisionError;
use super::cases::Cases;
use super::curve::{LEVEL, LimitCurve};
use super::limit::LimitState;
use super::loss::Losses;
use crate::measured::{Table, TableError};
use crate::scenario::Dimension;

/// Hazard curve of a site, read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct SiteHazard {
    /// Name of the file.
    pub file: String,
    /// Name of the intensity measure, which is also the name of its column.
    pub measure: String,
    /// Hazard curve, with intensities in SI units and rates in 1/year.
    pub hazard: Hazard,
}

/// Intensity measures for which a hazard curve may be given, each with its dimension.
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
    /// Reads a hazard curve from a CSV file with two columns.
    ///
    /// One column holds the intensity; its header states the measure and the unit, such as `pgv (cm/s)`. The
    /// other column, `rate (1/year)`, holds the annual rate at which that intensity is exceeded.
    ///
    /// # Errors
    /// If the file cannot be read, a column or a unit is missing, or the rows are not a hazard curve.
    pub fn load(path: &Path) -> Result<Self, TableError> {
        Self::of(&Table::load(path)?)
    }

    /// Parses a hazard curve from text; `file` is the name of the file in error messages.
    ///
    /// # Errors
    /// As for [`SiteHazard::load`].
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
                "expected a column for one of the measures {}, with its unit, as in `pgv (cm/s)`; found {}",
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

/// Annual rate at which a limit state is reached.
#[derive(Clone, Debug)]
pub struct LimitRate {
    /// Limit state.
    pub limit: LimitState,
    /// Rate (1/year) from the fitted curve; `None` if there is no curve.
    pub fitted: Option<Rate>,
    /// 95 % interval of the rate from the fitted curve. It covers the uncertainty of the curve only. `None` if
    /// [`LimitCurve::left_out`] is `None`.
    pub interval: Option<Interval>,
    /// Rate (1/year) from the raw fractions.
    pub raw: Rate,
    /// Probability that the limit state is reached at least once in the exposure time. It follows from the
    /// fitted curve, or from the raw fractions if there is no curve.
    pub chance: f64,
}

/// Expected annual losses of one stack.
#[derive(Clone, Debug)]
pub struct Lost {
    /// Number of barrels that fall per year.
    pub fallen: Rate,
    /// Number of barrels that burst per year, under the low, central and high assumptions about breakage.
    pub burst: [Rate; 3],
    /// Volume of wine lost per year (m³/year), under the low, central and high assumptions about breakage.
    pub wine: [f64; 3],
    /// Lower and upper cost (US$/year) of the barrels that burst and of their wine, under the central assumption about
    /// breakage.
    pub money: [f64; 2],
}

/// Annual rates of a study at a site.
#[derive(Clone, Debug)]
pub struct Site {
    /// Hazard curve of the site.
    pub hazard: SiteHazard,
    /// Exposure time (years).
    pub years: f64,
    /// Rate of each limit state.
    pub limits: Vec<LimitRate>,
    /// Expected annual losses; `None` if the study does not record falls.
    pub lost: Option<Lost>,
    /// Contribution of each range of intensity to the rate of collapse.
    pub contributions: Vec<Contribution>,
}

impl Site {
    /// Convolves the fragility curves of the study with the hazard curve; the first fragility curve must be
    /// the curve of collapse.
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
                    "the hazard curve is for {0}, but the study is for {1}; give a hazard curve for {1}",
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

/// Returns the edges of twelve ranges of intensity that cover the hazard curve and are evenly spaced in the
/// logarithm.
fn edges(hazard: &Hazard) -> Vec<f64> {
    let rows = hazard.rows();
    let (first, last) = (rows[0].0, rows[rows.len() - 1].0);
    let step = libm::log(last / first) / 12.0;
    (0..=12).map(|i| if i == 12 { last } else { first * libm::exp(step * f64::from(i)) }).collect()
}
