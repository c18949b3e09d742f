//! Joint calibration of stiffness, damping and friction from observed collapses.

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

use self::ensemble::{Course, placed, simulate};
use self::observed::{Mode, Observed};
use self::sampler::{Draw, Posterior, sample};
use super::least_squares::normalized;
use super::parameters::Tunable;
use super::result::{inseparable, short};
use super::{CalibrateError, Calibration, Estimate, Parameter, Table};

pub use likelihood::Errors;

/// Settings of a calibration from collapses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Factor that bounds every parameter relative to its value in the scenario; the prior is uniform in its logarithm.
    pub within: f64,
    /// Standard deviation (m) of the position of each rack and each barrel when a stack is built.
    pub placement: f64,
    /// Errors of observations relative to correct simulations.
    pub errors: Errors,
    /// Number of parameter sets, each simulated once for every test.
    pub simulations: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Vector unit of the simulations; the widest of the machine if `None`. The result does not depend on it.
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

/// Fraction by which an interval must be narrower than the prior for a test to be informative.
const INFORMATIVE: f64 = 0.15;

/// Correlation above which two parameters are inseparable.
const ALIKE: f64 = 0.9;

/// Weight of the simulations that agree with an observation, below which the model does not reproduce it.
const UNSEEN: f64 = 0.2;

/// Observations of collapses, one row of a table per test.
///
/// | column | content |
/// |---|---|
/// | `mode` | `ejection`, `rocking`, `rack-sliding`, `overturning`, or `stands` |
/// | `B4.1 fell (s)` | time at which that barrel had fallen, or `stands`; one column per barrel |
/// | `first fall (s)`, `first barrel` | the same for the first barrel, if others were not observed |
/// | `loss of seat (s)` | time at which the first body left its seat |
/// | `until (s)` | duration of observation; required if anything stands |
/// | `scenario` | scenario of the test, if tests differ |
///
/// An empty cell was not observed. Times count from the start of the motion.
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
    /// At the first invalid cell.
    pub fn read(table: &Table, errors: &Errors) -> Result<Self, CalibrateError> {
        let (tests, warnings) = Observed::read(table, 5.0 * errors.reading)?;
        Ok(Self { file: table.file().to_owned(), tests, warnings })
    }

    /// Returns the scenario that each test names, if any.
    pub fn scenarios(&self) -> impl Iterator<Item = Option<&str>> {
        self.tests.iter().map(|test| test.scenario.as_deref())
    }
}

/// One test, prepared for simulation.
struct Trial<'a> {
    observed: &'a Observed,
    tunable: Tunable,
    /// Scenario that runs until the end of observation.
    scenario: Scenario,
    /// Ground motion.
    ground: Arc<Ground>,
    /// Standard deviation (m at full scale) of positions.
    scatter: f64,
}

/// Estimates parameters of a stack from observed collapses, `scenarios` being those of the tests.
///
/// Collapse is chaotic: the course of one stack cannot be fitted, but its probability can.
/// Each set of parameters is simulated with random offsets of racks and barrels, since no two
/// stacks are built alike, and weighted by the likelihood of the observations given that course
/// ([`Errors`]). Sampling is iterated around likely parameters; the intervals hold the central
/// 95 % of the weight. If too few courses agree, the likelihood is raised to a power below one,
/// which widens the intervals and is stated.
/// Constants of the rack–ground and barrel–rack interfaces keep their ratio, as in
/// [`super::response`].
///
/// The result is a function of the observations, the scenarios and the settings, independent of the number of
/// threads. `report` is called with the numbers of completed and of all simulations, from several threads, and may stop
/// them.
///
/// # Errors
/// If a scenario is not a stack of linear laws, cannot be simulated or does not match the observations,
/// or if nothing within the range agrees with them; and if it was stopped.
pub fn collapse(
    observations: &Observations,
    scenarios: &[Scenario],
    parameters: &[Parameter],
    settings: &Settings,
    report: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Calibration, CalibrateError> {
    let trials = trials(observations, scenarios, parameters, settings)?;
    let Some(lead) = trials.first() else { return Ok(Calibration::default()) };
    let reach = math::log(settings.within);
    let point = |draw: &Draw| draw.point.iter().map(|x| reach * x).collect::<Vec<f64>>();
    let of = settings.simulations * trials.len();
    let mut courses: Vec<Option<Course>> = Vec::new();
    let mut stopped = false;
    let posterior = sample(parameters.len(), settings.simulations, settings.seed, |draws| {
        let before = courses.len();
        let batch: Vec<Prepared> = draws
            .iter()
            .flat_map(|draw| {
                // One generator for all tests of a sample: each stack is built anew.
                let mut random = Random::new(draw.seed);
                let built = |trial: &Trial<'_>| {
                    let scenario = trial.tunable.at(&trial.scenario, &point(draw));
                    let scenario = Arc::new(placed(&scenario, trial.scatter, &mut random));
                    Prepared { scenario, ground: Arc::clone(&trial.ground) }
                };
                trials.iter().map(built).collect::<Vec<_>>()
            })
            .collect();
        let overall = |done| report(before + done, of.max(before + done));
        let simulated = if stopped { None } else { simulate(batch, settings.lanes, &overall) };
        let Some(simulated) = simulated else {
            stopped = true;
            return vec![f64::NEG_INFINITY; draws.len()];
        };
        let logs = simulated
            .chunks_exact(trials.len())
            .map(|tests| {
                let log = |(trial, course): (&Trial<'_>, &Option<Course>)| {
                    course.as_ref().map_or(f64::NEG_INFINITY, |course| {
                        settings.errors.log_likelihood(trial.observed, course)
                    })
                };
                trials.iter().zip(tests).map(log).sum()
            })
            .collect();
        courses.extend(simulated);
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
                    "test {}: the model hardly shows what was observed ({name} in {:.0} % of the weight): see \
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

/// Combines the tests with their scenarios and checks their consistency.
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

/// Runs a test briefly with its own scenario: it must be possible, and contain the observed barrels.
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

/// Describes what the tests do not determine, one sentence each.
fn identifiability(
    estimates: &[Estimate],
    correlation: &[Vec<f64>],
    posterior: &Posterior,
    within: f64,
) -> Vec<String> {
    let mut warnings = Vec::new();
    for (at, estimate) in estimates.iter().enumerate() {
        // The central 95 % of the prior is 1.9 wide.
        let width = posterior.quantile(at, 0.975) - posterior.quantile(at, 0.025);
        if width > (1.0 - INFORMATIVE) * 1.9 {
            warnings.push(format!(
                "what was observed says nothing about {}: its interval is the range that was tried, not a \
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
            "too few simulations came near to what was observed, so its likelihood counts to the power {} and \
             the intervals are wider than they need be: run more simulations",
            short(posterior.power)
        ));
    }
    warnings
}

/// Returns the observed mode of a test and the weight of the simulations with this mode; `None` if no mode
/// was observed.
fn alike<'a>(
    trial: &Trial<'_>,
    courses: impl Iterator<Item = &'a Option<Course>>,
    posterior: &Posterior,
) -> (String, Option<f64>) {
    let Some(mode) = trial.observed.mode else { return (String::new(), None) };
    let name = match mode {
        Mode::Stands => "stands".to_owned(),
        Mode::Collapse(mode) => mode.name().to_owned(),
    };
    let same = |course: &Option<Course>| course.as_ref().is_some_and(|course| course.mode == mode);
    let weights = courses.zip(&posterior.weights).filter(|(course, _)| same(course));
    (name, Some(weights.fold(0.0, |sum, (_, weight)| sum + weight)))
}

#[cfg(test)]
mod tests;
