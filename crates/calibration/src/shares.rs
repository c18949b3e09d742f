//! Joint calibration of stiffness, damping and friction from shares of stacks that fell in an earthquake.

mod statements;

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::Arc;

use barrelstack::run::RunFailure;
use barrelstack::scenario::Scenario;
use barrelstack_dynamics::math;
use barrelstack_fragility::{Conditional, DrawnRun, FEWEST_RUNS, conditional, normal_quantile};
use barrelstack_input::measured::TableError;
use barrelstack_motion::Random;
use barrelstack_report::{Axis, Figure};

use super::collapse::ensemble::{Built, Course, Shaking, placed, simulate};
use super::collapse::observed::Time;
use super::collapse::picture::{Rows, middle};
use super::collapse::sampler::{Draw, Posterior, hypercube};
use super::collapse::{Settings, barrels, estimates, identifiability};
use super::least_squares::normalized;
use super::parameters::Tunable;
use super::result::{ModelShare, short};
use super::{CalibrateError, Calibration, Parameter};

pub use statements::{
    Earthquake, Kind, Likelihood, MODEL_ERROR, Statement, Statements, StatementsError,
};

/// Sentences on what the intervals cover and what they do not.
const COVERS: &str = "The 95 % intervals cover the uncertainty of the statements, of the motion in the cellar and of the \
                      proportions of stacks of each height, and a model error of 10 % in each share. They do not cover \
                      values of the scenario that were not fitted.";

/// Number of parameter sets that are weighted by the likelihood of the statements.
const DRAWS: usize = 20_000;

/// Threshold of the mean likelihood of a statement over the prior. A smaller mean gives a warning; the highest possible
/// likelihood is 1.
const UNLIKELY: f64 = 0.05;

/// Scenario that represents all stacks with a given number of levels. Its motion is that of the earthquake.
#[derive(Clone, Debug)]
pub struct Height {
    /// Number of levels.
    pub levels: usize,
    /// The scenario.
    pub scenario: Scenario,
}

/// Returns the numbers of levels that statements name. For each of them, [`shares`] needs a [`Height`].
pub fn levels(statements: &[&Statement]) -> BTreeSet<usize> {
    statements.iter().flat_map(|one| one.levels.iter().copied()).collect()
}

/// Result of one simulated stack.
struct Shaken {
    /// Parameters, scaled so that −1 and 1 are the ends of the prior range.
    point: Vec<f64>,
    /// Logarithm of the factor by which the motion is multiplied, in standard deviations.
    motion: f64,
    /// Index of the [`Height`] of the stack.
    height: usize,
    /// Share of the barrels that fell; `None` if the stack stands.
    fallen: Option<f64>,
}

/// Fitted share of stacks that fall, as a function of the parameters, the motion and the height.
struct Fit {
    share: Conditional,
    /// For each height, the mean share of the barrels that fall if a stack falls; if no stack of this height fell, the
    /// mean over all heights.
    fallen: Vec<f64>,
    /// For each height, its number of levels, standardized to mean 0 and variance 1; empty if there is only one height.
    heights: Vec<f64>,
}

/// Estimates parameters of a stack from statements on how many stacks fell in an earthquake.
///
/// `heights` holds one scenario for every number of levels that a statement names. The estimation has three steps:
///
/// 1. `settings.simulations` parameter sets are drawn from the prior ranges. With each set, one stack of one of these
///    heights is simulated, with random offsets of its bodies. The motion of the scenario is multiplied by a random
///    factor, because the shaking in a cellar differs from that at the station ([`Earthquake::motion`]).
/// 2. A probit regression of second degree is fitted to the results. It gives the share of stacks that fall as a
///    function of the parameters, the factor and the height.
/// 3. Another 20 000 parameter sets are drawn from the prior ranges and weighted by the likelihood of the statements.
///    For each set, one factor of the motion and one sample of the regression coefficients are drawn and used for all
///    statements. For each statement, the proportions of stacks of each height are drawn at random; all mixtures are
///    equally probable. The likelihood includes a model error ([`MODEL_ERROR`]).
///
/// The intervals of the parameters contain the central 95 % of the weight.
///
/// The result is a function of the statements, the scenarios and the settings, independent of the number of threads.
/// `report` is called from several threads with the number of completed simulations and the total, and may
/// cancel the calibration.
///
/// # Errors
/// If a scenario is not a stack whose contact laws are linear, or cannot be simulated, if the scenario of a height is
/// missing, or if too few simulations run to their end; [`CalibrateError::Stopped`] if `report` canceled it.
pub fn shares(
    earthquake: &Earthquake,
    statements: &[&Statement],
    heights: &[Height],
    parameters: &[Parameter],
    settings: &Settings,
    report: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Calibration, CalibrateError> {
    let at = |levels| heights.iter().position(|height| height.levels == levels);
    for levels in levels(statements) {
        if at(levels).is_none() {
            return Err(CalibrateError::Scenario(format!(
                "a statement is about stacks of {levels} levels, but there is no scenario of such a stack"
            )));
        }
    }
    let Some(first) = heights.first() else { return Ok(Calibration::default()) };
    let tunable = Tunable::new(&first.scenario, parameters)?;
    let shaken = shake(earthquake, statements, heights, &tunable, settings, report)?;
    let unsuited = |reason: String| TableError::Unsuited {
        file: format!("statements on {}", earthquake.name),
        reason,
    };
    let fit = Fit::new(&shaken, heights, settings.seed).ok_or_else(|| {
        unsuited(format!(
            "only {} of {} simulations run to their end, fewer than {FEWEST_RUNS}; in all others, the stack falls \
             under its own weight or the run fails: start from other values",
            shaken.len(),
            settings.simulations
        ))
    })?;
    let weighed = Weighed::new(statements, heights, parameters.len(), &fit, settings.seed)
        .ok_or_else(|| {
            unsuited(
                "no parameter set within the range agrees with the statements: widen the range"
                    .to_owned(),
            )
        })?;
    let reach = math::log(settings.within);
    let posterior = &weighed.posterior;
    let estimates = estimates(&tunable, posterior, reach);
    let mut correlation = normalized(&posterior.covariance());
    correlation.truncate(parameters.len());
    for row in &mut correlation {
        row.truncate(parameters.len());
    }
    let medians: Vec<f64> =
        (0..parameters.len()).map(|at| reach * posterior.quantile(at, 0.5)).collect();
    let mut warnings = identifiability(&estimates, &correlation, posterior, settings.within);
    warnings.extend(weighed.unlikely(statements));
    let left_out = settings.simulations - shaken.len();
    if left_out > 0 {
        warnings.push(format!(
            "simulations without a result, because the stack falls under its own weight or the run fails: {left_out} \
             of {}",
            settings.simulations
        ));
    }
    let motion = [0.5, 0.025, 0.975]
        .map(|q| math::exp(earthquake.motion * posterior.quantile(parameters.len(), q)));
    let mut facts = vec![
        ("scenario".to_owned(), first.scenario.title.clone()),
        ("statements".to_owned(), statements.len().to_string()),
        ("simulations".to_owned(), shaken.len().to_string()),
        ("effective number of draws".to_owned(), short(posterior.effective())),
        (
            "prior range".to_owned(),
            format!("within a factor of {} of the scenario", settings.within),
        ),
        (
            "motion in the cellar, relative to that of the scenario".to_owned(),
            format!("{:.2} ({:.2} to {:.2})", motion[0], motion[1], motion[2]),
        ),
        ("seed".to_owned(), settings.seed.to_string()),
    ];
    let mut shares = Vec::new();
    for (at, one) in statements.iter().enumerate() {
        let [before, given] = weighed.predicted(at);
        facts.extend(stated(one, before, given));
        shares.push(ModelShare { statement: one.id.clone(), before, given });
    }
    Ok(Calibration {
        title: format!("collapse {}: shares that fell, from simulated stacks", earthquake.name),
        scenario: tunable.scenario_lines(&medians),
        estimates,
        correlation,
        condition: None,
        shares,
        covers: Some(COVERS),
        figures: weighed.figure(statements).into_iter().collect(),
        facts,
        warnings,
    })
}

/// Returns the facts on a statement as pairs of name and value ([`Calibration::facts`]): its text, its source, its
/// uncertainty, how it is used, and the shares that the model predicts.
///
/// `before` and `given` are the prior and the posterior predictive interval ([`Weighed::predicted`]).
fn stated(one: &Statement, before: [f64; 2], given: [f64; 2]) -> Vec<(String, String)> {
    let range = |[low, high]: [f64; 2]| format!("{:.0} to {:.0} %", 100.0 * low, 100.0 * high);
    let error = match (one.low.zip(one.high), one.error) {
        (Some((low, high)), _) => format!(", 95 % interval {}", range([low, high])),
        (None, Some(error)) => format!(", standard error {:.0} %", 100.0 * error),
        (None, None) => String::new(),
    };
    let levels: Vec<String> = one.levels.iter().map(usize::to_string).collect();
    let used = format!(
        "{}: {}{error}; levels: {}, in unknown proportions",
        one.subject(),
        one.bound(),
        levels.join(", ")
    );
    let model = format!("{} before, {} given the statements", range(before), range(given));
    let fact = |name: &str, value: &str| (format!("{}: {name}", one.id), value.to_owned());
    vec![
        fact("statement", &one.statement),
        fact("source", &one.source),
        fact("uncertainty", one.uncertainty.as_deref().unwrap_or_default()),
        fact("used as", &used),
        fact("share by the model, central 90 %", &model),
    ]
}

/// Simulates one stack for each parameter set. Stacks that fall under their own weight and runs that fail are left out.
fn shake(
    earthquake: &Earthquake,
    statements: &[&Statement],
    heights: &[Height],
    tunable: &Tunable,
    settings: &Settings,
    report: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Vec<Shaken>, CalibrateError> {
    let count = tunable.parameters().len();
    let mut grounds = Vec::new();
    for height in heights {
        barrels(&height.scenario)?;
        grounds.push(Shaking::of(&height.scenario).map_err(RunFailure::from)?);
    }
    let mut random = Random::new(settings.seed);
    let points = hypercube(settings.simulations, count + 1, &mut random);
    let reach = math::log(settings.within);
    let counts_barrels = statements.iter().any(|one| one.kind == Kind::Barrels);
    let mut drawn = Vec::new();
    let mut built = Vec::new();
    for (number, mut point) in points.into_iter().enumerate() {
        let height = number % heights.len();
        let motion = normal_quantile(0.5 * (point[count] + 1.0));
        point.truncate(count);
        let at: Vec<f64> = point.iter().map(|x| reach * x).collect();
        let base = &heights[height].scenario;
        let mut scenario = tunable.at(base, &at);
        if !counts_barrels {
            scenario.run.stop_after_collapse = Some(0.1);
        }
        let scatter = settings.placement / scenario.run.similitude;
        let scenario = Arc::new(placed(&scenario, scatter, &mut random));
        let ground = grounds[height].scaled(math::exp(earthquake.motion * motion));
        built.push(Built { scenario, ground });
        drawn.push((point, motion, height));
    }
    let total = settings.simulations;
    let courses = simulate(built, settings.lanes, &|done| report(done, total))
        .ok_or(CalibrateError::Stopped)?;
    let ran = drawn.into_iter().zip(courses).filter_map(|((point, motion, height), course)| {
        Some(Shaken { point, motion, height, fallen: fallen(&course?) })
    });
    Ok(ran.collect())
}

/// Returns the share of the barrels that fell; `None` if the stack stands.
fn fallen(course: &Course) -> Option<f64> {
    matches!(course.loss, Time::At(_)).then(|| {
        let down = course.falls.iter().filter(|(_, time)| matches!(time, Time::At(_))).count();
        down as f64 / course.falls.len().max(1) as f64
    })
}

impl Fit {
    /// Fits the share of stacks that fall to the results of the simulations; `None` if there are too few results.
    fn new(shaken: &[Shaken], heights: &[Height], seed: u64) -> Option<Self> {
        let levels: Vec<f64> = heights.iter().map(|height| height.levels as f64).collect();
        let middle = levels.iter().sum::<f64>() / levels.len() as f64;
        let spread = (levels.iter().map(|l| (l - middle) * (l - middle)).sum::<f64>()
            / levels.len() as f64)
            .sqrt();
        let standard = if spread > 0.0 {
            levels.iter().map(|l| (l - middle) / spread).collect()
        } else {
            vec![]
        };
        let runs: Vec<DrawnRun> = shaken
            .iter()
            .map(|one| DrawnRun {
                deviates: deviates(&one.point, one.motion, standard.get(one.height)),
                second_half: false,
                failed: one.fallen.is_some(),
            })
            .collect();
        let mut random = Random::new(seed ^ 0x7368_6172_6573);
        let share = conditional(&runs, || random.uniform())?;
        let mean = |of: &dyn Fn(&&Shaken) -> bool| {
            let down: Vec<f64> = shaken.iter().filter(of).filter_map(|one| one.fallen).collect();
            (!down.is_empty()).then(|| down.iter().sum::<f64>() / down.len() as f64)
        };
        // If no stack falls at all, the share of fallen barrels is set to its upper bound, the share of fallen stacks.
        let any = mean(&|_| true).unwrap_or(1.0);
        let fallen =
            (0..heights.len()).map(|height| mean(&|one| one.height == height).unwrap_or(any));
        let fallen = fallen.collect();
        Some(Self { share, fallen, heights: standard })
    }
}

/// Returns the parameters, the motion and, if given, the height as deviates of unit variance.
///
/// The parameters are uniform within ±1 and have the variance 1/3, so they are multiplied by √3. The motion and the
/// height have unit variance already.
fn deviates(point: &[f64], motion: f64, height: Option<&f64>) -> Vec<f64> {
    let parameters = point.iter().map(|x| 3.0_f64.sqrt() * x);
    parameters.chain([motion]).chain(height.copied()).collect()
}

/// Parameter sets, weighted by the likelihood of the statements.
struct Weighed {
    /// Parameter sets with their weights. The last coordinate of a set is the logarithm of the factor by which the
    /// motion is multiplied, in standard deviations.
    posterior: Posterior,
    /// For each statement, the shares that the model predicts, one for each parameter set.
    shares: Vec<Vec<f64>>,
    /// Mean likelihood of each statement over all parameter sets, without their weights; at most 1.
    likelihoods: Vec<f64>,
}

impl Weighed {
    fn new(
        statements: &[&Statement],
        heights: &[Height],
        parameters: usize,
        fit: &Fit,
        seed: u64,
    ) -> Option<Self> {
        let mut random = Random::new(seed.rotate_left(17) ^ 0x7765_6967);
        let likelihoods: Vec<Likelihood> = statements
            .iter()
            .filter_map(|one| Some(one.likelihood()?.wider(MODEL_ERROR)))
            .collect();
        let (mut draws, mut logs) = (Vec::new(), Vec::new());
        let mut shares = vec![Vec::new(); statements.len()];
        let mut sums = vec![0.0; statements.len()];
        for _ in 0..DRAWS {
            let mut point: Vec<f64> =
                (0..parameters).map(|_| 2.0 * random.uniform() - 1.0).collect();
            let motion = random.normal();
            let sample = random.bits() >> 33;
            let mut log = 0.0;
            for (at, (one, likelihood)) in statements.iter().zip(&likelihoods).enumerate() {
                // Exponential deviates, divided by their sum, give every mixture the same probability.
                let parts: Vec<f64> =
                    one.levels.iter().map(|_| -math::log(1.0 - random.uniform())).collect();
                let all: f64 = parts.iter().sum();
                let of = |(levels, part): (&usize, &f64)| {
                    let height = heights.iter().position(|height| height.levels == *levels)?;
                    let z = deviates(&point, motion, fit.heights.get(height));
                    let barrels = if one.kind == Kind::Barrels { fit.fallen[height] } else { 1.0 };
                    Some(part / all * fit.share.in_sample(sample as usize, &z) * barrels)
                };
                let share: f64 = one.levels.iter().zip(&parts).filter_map(of).sum();
                let chance = likelihood.of(share);
                shares[at].push(share);
                sums[at] += chance / DRAWS as f64;
                log += math::log(chance);
            }
            point.push(motion);
            draws.push(Draw { point, seed: 0 });
            logs.push(log);
        }
        Some(Self { posterior: Posterior::of(draws, &logs)?, shares, likelihoods: sums })
    }

    /// Returns the prior and the posterior predictive interval of the share in the statement at an index. Each interval
    /// contains the central 90 % of the predictions. The posterior takes all statements into account.
    fn predicted(&self, at: usize) -> [[f64; 2]; 2] {
        let even = vec![1.0; DRAWS];
        [&even, &self.posterior.weights].map(|weights| {
            middle(self.shares[at].iter().copied().zip(weights.iter().copied()).collect())
        })
    }

    /// Returns a warning for each statement whose mean likelihood over the prior ranges is below [`UNLIKELY`].
    fn unlikely<'a>(&'a self, statements: &'a [&Statement]) -> impl Iterator<Item = String> + 'a {
        let pairs = statements.iter().zip(&self.likelihoods);
        pairs.filter(|(_, likelihood)| **likelihood < UNLIKELY).map(|(one, likelihood)| {
            format!(
                "the model hardly agrees with the statement {} within the range (mean likelihood {}): check that \
                 motion, heights and racks of the scenario match the statement, or widen the range",
                one.id,
                short(*likelihood)
            )
        })
    }

    /// Plots the prior and the posterior predictive interval of each share, with the stated shares.
    fn figure(&self, statements: &[&Statement]) -> Option<Figure> {
        let mut rows = Rows::default();
        let mut stated = Vec::new();
        for (at, one) in statements.iter().enumerate() {
            let [before, after] = self.predicted(at);
            rows.bar(format!("{}: before", one.id), before);
            rows.bar(format!("{}: given the statements", one.id), after);
            stated.extend([one.value.unwrap_or(f64::NAN); 2]);
        }
        let caption = "Shares that the model predicts: before the statements are used, and given all statements. Bars \
                       show the central 90 % of the predictions, over the parameters, the motion and the mixture of \
                       heights; marks show the stated shares.";
        let x = Axis { range: Some([0.0, 1.0]), ..Axis::new("share", "") };
        rows.figure("collapse-shares", caption, x, Some(stated))
    }
}

#[cfg(test)]
mod tests;
