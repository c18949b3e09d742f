//! Stiffness, damping and friction together from collapses that were seen.

mod ensemble;
mod likelihood;
mod observed;
mod picture;
mod sampler;

use std::ops::ControlFlow;
use std::sync::Arc;

use barrelstack::ensemble::{Prepared, Width};
use barrelstack::ground::Ground;
use barrelstack::run::RunFailure;
use barrelstack::scenario::Scenario;
use barrelstack_dynamics::math;
use barrelstack_input::measured::TableError;
use barrelstack_motion::Random;

use self::ensemble::{Seen, placed, simulate};
use self::observed::{Mode, Observed};
use self::sampler::{Draw, Posterior, sample};
use super::least_squares::normalized;
use super::parameters::Tunable;
use super::result::{inseparable, short};
use super::{CalibrateError, Calibration, Estimate, Parameter, Table};

pub use likelihood::Errors;

/// How a calibration from collapses goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Every parameter is taken to lie within this factor of its value in the scenario, each value of
    /// its logarithm as likely as another before the tests.
    pub within: f64,
    /// Standard deviation (m) of the place of each rack and each barrel when a stack is built.
    pub placement: f64,
    /// How observations differ from simulations that are right.
    pub errors: Errors,
    /// Sets of parameters that are simulated, each once for every test.
    pub simulations: usize,
    /// Start of all random numbers.
    pub seed: u64,
    /// The vector unit in which simulations run; the widest of the machine without. The result does not
    /// depend on it.
    pub lanes: Option<Width>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            within: 2.0,
            placement: 1e-3,
            errors: Errors::default(),
            simulations: 1000,
            seed: 1,
            lanes: None,
        }
    }
}

/// Share of its width before the tests that an interval must have lost for a test to say something.
const TOLD: f64 = 0.15;

/// Correlation above which two parameters cannot be told apart.
const ALIKE: f64 = 0.9;

/// Weight of simulations that go as observed below which the model does not show what was seen.
const UNSEEN: f64 = 0.2;

/// What was seen of collapses, one row of a table a test.
///
/// | column | what stands in it |
/// |---|---|
/// | `mode` | `ejection`, `rocking`, `rack-sliding`, `overturning`, or `stands` |
/// | `B4.1 fell (s)` | when that barrel had fallen, or `stands`; one column a barrel |
/// | `first fall (s)`, `first barrel` | the same of the first barrel, where others were not seen |
/// | `loss of seat (s)` | when the first body left its seat |
/// | `until (s)` | how long it was watched; needed where something stands |
/// | `scenario` | the scenario of the test, where tests differ |
///
/// An empty cell was not seen. Times count from the start of the motion.
#[derive(Clone, Debug)]
pub struct Observations {
    file: String,
    tests: Vec<Observed>,
    warnings: Vec<String>,
}

impl Observations {
    /// Reads a table.
    ///
    /// # Errors
    /// At the first cell that cannot be what it stands for.
    pub fn read(table: &Table, errors: &Errors) -> Result<Self, CalibrateError> {
        let (tests, warnings) = Observed::read(table, 5.0 * errors.reading)?;
        Ok(Self { file: table.file().to_owned(), tests, warnings })
    }

    /// The scenario that each test names, if it does.
    pub fn scenarios(&self) -> impl Iterator<Item = Option<&str>> {
        self.tests.iter().map(|test| test.scenario.as_deref())
    }
}

/// One test, ready to be simulated.
struct Trial<'a> {
    observed: &'a Observed,
    tunable: Tunable,
    /// Runs until the end of the watch.
    scenario: Scenario,
    /// What shakes it.
    ground: Arc<Ground>,
    /// Standard deviation (m at full scale) of places.
    scatter: f64,
}

/// Finds parameters of a stack from collapses that were seen, `scenarios` being those of the tests.
///
/// Collapse is chaotic: the course of one stack cannot be fitted, the chance of it can.
/// Each set of parameters is simulated with racks and barrels a little beside their places, as no two
/// stacks are built alike, and weighs as much as what was seen is likely beside that course
/// ([`Errors`]). Sampling is iterated around what has become likely; the intervals hold the middle
/// 95 % of the weight. Where too few courses come near, the likelihood is raised to a power below one,
/// which widens the intervals and is stated.
/// What is stated for one rack–ground and one barrel–rack interface keeps its ratio between both, as in
/// [`super::response`].
///
/// The result is a function of the observations, the scenarios and the settings; the number of threads
/// is not an input. `tell` hears how many simulations are done, of how many, from several threads, and may stop them.
///
/// # Errors
/// When a scenario is no stack of linear laws or cannot be simulated, does not go with what was seen,
/// or when nothing within the range is like it; and when it was stopped.
pub fn collapse(
    observations: &Observations,
    scenarios: &[Scenario],
    parameters: &[Parameter],
    settings: &Settings,
    tell: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Calibration, CalibrateError> {
    let trials = trials(observations, scenarios, parameters, settings)?;
    let Some(lead) = trials.first() else { return Ok(Calibration::default()) };
    let reach = math::log(settings.within);
    let point = |draw: &Draw| draw.point.iter().map(|x| reach * x).collect::<Vec<f64>>();
    let of = settings.simulations * trials.len();
    let mut courses: Vec<Option<Seen>> = Vec::new();
    let mut stopped = false;
    let posterior = sample(parameters.len(), settings.simulations, settings.seed, |draws| {
        let before = courses.len();
        let batch: Vec<Prepared> = draws
            .iter()
            .flat_map(|draw| {
                // One generator for all tests of a draw: each stack is built anew.
                let mut random = Random::new(draw.seed);
                let built = |trial: &Trial<'_>| {
                    let scenario = trial.tunable.at(&trial.scenario, &point(draw));
                    let scenario = Arc::new(placed(&scenario, trial.scatter, &mut random));
                    Prepared { scenario, ground: Arc::clone(&trial.ground) }
                };
                trials.iter().map(built).collect::<Vec<_>>()
            })
            .collect();
        let told = |done| tell(before + done, of.max(before + done));
        let seen = if stopped { None } else { simulate(batch, settings.lanes, &told) };
        let Some(seen) = seen else {
            stopped = true;
            return vec![f64::NEG_INFINITY; draws.len()];
        };
        let logs = seen
            .chunks_exact(trials.len())
            .map(|tests| {
                let log = |(trial, seen): (&Trial<'_>, &Option<Seen>)| {
                    seen.as_ref().map_or(f64::NEG_INFINITY, |seen| {
                        settings.errors.log_likelihood(trial.observed, seen)
                    })
                };
                trials.iter().zip(tests).map(log).sum()
            })
            .collect();
        courses.extend(seen);
        logs
    });
    if stopped {
        return Err(CalibrateError::Stopped);
    }
    let posterior = posterior.ok_or_else(|| TableError::Unsuited {
        file: observations.file.clone(),
        reason: "no simulation within the range runs to its end: start from a sounder scenario"
            .to_owned(),
    })?;
    let estimates = estimates(&lead.tunable, &posterior, reach);
    let correlation = normalized(&posterior.covariance());
    let medians: Vec<f64> =
        (0..parameters.len()).map(|at| reach * posterior.quantile(at, 0.5)).collect();
    let mut warnings = observations.warnings.clone();
    warnings.extend(identifiability(&estimates, &correlation, &posterior, settings.within));
    let mut facts = vec![
        ("tests".to_owned(), trials.len().to_string()),
        ("simulations".to_owned(), courses.len().to_string()),
        ("draws in effect".to_owned(), short(posterior.effective())),
        ("power of the likelihood".to_owned(), short(posterior.power)),
        ("tried".to_owned(), format!("within a factor of {} of the scenario", settings.within)),
        ("seed".to_owned(), settings.seed.to_string()),
    ];
    for (at, trial) in trials.iter().enumerate() {
        let (name, share) = alike(trial, courses.iter().skip(at).step_by(trials.len()), &posterior);
        if let Some(share) = share {
            facts.push((
                format!("test {}: {name}", at + 1),
                format!("{:.0} % of the weight", 100.0 * share),
            ));
            if share < UNSEEN {
                warnings.push(format!(
                    "test {}: the model hardly shows what was seen ({name} in {:.0} % of the weight): see \
                     whether motion, geometry and the definition of the mode are those of the test",
                    at + 1,
                    100.0 * share
                ));
            }
        }
    }
    Ok(Calibration {
        title: format!(
            "collapse {}: simulated with stacks built anew each time",
            observations.file
        ),
        scenario: lead.tunable.scenario_lines(&medians),
        estimates,
        correlation,
        condition: None,
        figures: picture::pictures(&trials, &courses, &posterior),
        facts,
        warnings,
    })
}

/// The tests with their scenarios, checked against each other.
fn trials<'a>(
    observations: &'a Observations,
    scenarios: &[Scenario],
    parameters: &[Parameter],
    settings: &Settings,
) -> Result<Vec<Trial<'a>>, CalibrateError> {
    if scenarios.len() != observations.tests.len() {
        return Err(CalibrateError::Scenario(format!(
            "{} scenarios do not go with {} tests: give one for each, in their order",
            scenarios.len(),
            observations.tests.len()
        )));
    }
    let mut trials: Vec<Trial<'_>> = Vec::new();
    for (at, (observed, scenario)) in observations.tests.iter().zip(scenarios).enumerate() {
        let tunable = Tunable::new(scenario, parameters)?;
        let scale = scenario.run.similitude;
        let mut scenario = scenario.clone();
        scenario.run.duration = Some(observed.until / scale.sqrt());
        scenario.run.stop_after_collapse = None;
        if let Some(lead) = trials.first() {
            let differs = |p: &&Parameter| lead.tunable.start(**p) != tunable.start(**p);
            if let Some(parameter) = parameters.iter().find(differs) {
                return Err(CalibrateError::Scenario(format!(
                    "the scenarios of test 1 and test {} state another {}: one value is looked for, so \
                     state the same, or do not fit it",
                    at + 1,
                    parameter.name()
                )));
            }
        }
        check(at, observed, &scenario)?;
        let ground = Arc::new(scenario.ground().map_err(RunFailure::from)?);
        let scatter = settings.placement / scale;
        trials.push(Trial { observed, tunable, scenario, ground, scatter });
    }
    Ok(trials)
}

/// Runs a test once as its scenario has it: it must be possible, and have the barrels that were seen.
fn check(at: usize, observed: &Observed, scenario: &Scenario) -> Result<(), CalibrateError> {
    let mut short = scenario.clone();
    short.run.duration = Some(1e-3);
    let run = short.run()?;
    let barrels: Vec<&str> = run
        .assembly
        .of_kind(barrelstack::assemble::PartKind::Barrel)
        .map(|body| run.assembly.parts[body].name.as_str())
        .collect();
    let named = observed.falls.iter().map(|(barrel, _)| barrel).chain(&observed.first_barrel);
    for barrel in named {
        if !barrels.contains(&barrel.as_str()) {
            return Err(CalibrateError::Scenario(format!(
                "test {}: the scenario has no barrel \"{barrel}\"; it has {}",
                at + 1,
                barrels.join(", ")
            )));
        }
    }
    if observed.until > 120.0 {
        return Err(CalibrateError::Run(RunFailure::Duration(format!(
            "test {}: {} s are too long to simulate over and over: end the watch at 120 s",
            at + 1,
            observed.until
        ))));
    }
    Ok(())
}

fn estimates(tunable: &Tunable, posterior: &Posterior, reach: f64) -> Vec<Estimate> {
    let estimate = |(at, parameter): (usize, &Parameter)| {
        let value = |share: f64| {
            tunable.start(*parameter) * math::exp(reach * posterior.quantile(at, share))
        };
        Estimate {
            name: parameter.name().to_owned(),
            value: value(0.5),
            low: value(0.025),
            high: value(0.975),
            dimension: tunable.dimension(*parameter),
        }
    };
    tunable.parameters().iter().enumerate().map(estimate).collect()
}

/// What the tests cannot tell, one sentence each.
fn identifiability(
    estimates: &[Estimate],
    correlation: &[Vec<f64>],
    posterior: &Posterior,
    within: f64,
) -> Vec<String> {
    let mut warnings = Vec::new();
    for (at, estimate) in estimates.iter().enumerate() {
        // The middle 95 % of the box is 1.9 wide.
        let width = posterior.quantile(at, 0.975) - posterior.quantile(at, 0.025);
        if width > (1.0 - TOLD) * 1.9 {
            warnings.push(format!(
                "what was seen says nothing about {}: its interval is the range that was tried, not a \
                 measurement; test it on its own, or do not fit it",
                estimate.name
            ));
        } else if posterior.quantile(at, 0.975) > 0.98 || posterior.quantile(at, 0.025) < -0.98 {
            warnings.push(format!(
                "the interval of {} reaches the end of what was tried (a factor of {within}): widen it",
                estimate.name
            ));
        }
    }
    warnings.extend(inseparable(estimates, correlation, ALIKE));
    if posterior.power < 1.0 {
        warnings.push(format!(
            "too few simulations came near to what was seen, so its likelihood counts to the power {} and \
             the intervals are wider than they need be: ask for more",
            short(posterior.power)
        ));
    }
    warnings
}

/// What of a test can be compared in one word, and the weight of the simulations that go so; none where
/// no word was said.
fn alike<'a>(
    trial: &Trial<'_>,
    courses: impl Iterator<Item = &'a Option<Seen>>,
    posterior: &Posterior,
) -> (String, Option<f64>) {
    let Some(mode) = trial.observed.mode else { return (String::new(), None) };
    let name = match mode {
        Mode::Stands => "stands".to_owned(),
        Mode::Collapse(mode) => mode.name().to_owned(),
    };
    let same = |seen: &Option<Seen>| seen.as_ref().is_some_and(|seen| seen.mode == mode);
    let weights = courses.zip(&posterior.weights).filter(|(seen, _)| same(seen));
    (name, Some(weights.fold(0.0, |sum, (_, weight)| sum + weight)))
}

#[cfg(test)]
mod tests;
