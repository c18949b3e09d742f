//! Joint calibration of stiffness, damping and friction from observed collapses.

pub(crate) mod ensemble;
mod likelihood;
pub(crate) mod observed;
pub(crate) mod picture;
pub(crate) mod sampler;

use std::ops::ControlFlow;
use std::sync::Arc;

use barrelstack::assemble::PartKind;
use barrelstack::ensemble::Width;
use barrelstack::run::RunFailure;
use barrelstack::scenario::Scenario;
use barrelstack_dynamics::math;
use barrelstack_input::measured::TableError;
use barrelstack_input::names::advice;
use barrelstack_motion::Random;

use self::ensemble::{Built, Course, Shaking, placed, simulate};
use self::observed::{Mode, Observed};
use self::sampler::{Draw, Posterior, sample};
use super::least_squares::normalized;
use super::parameters::Tunable;
use super::result::{inseparable, short};
use super::{CalibrateError, Calibration, Estimate, Parameter, Table};

pub use likelihood::Errors;

/// Settings for a calibration from observed collapses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Maximum factor by which a parameter may be larger or smaller than its value in the scenario. The prior
    /// is uniform in the logarithm of the parameter.
    pub within: f64,
    /// Standard deviation (m) of the position at which each rack and each barrel is placed when a stack is
    /// built.
    pub placement: f64,
    /// Assumed differences between the observations and a correct simulation.
    pub errors: Errors,
    /// Number of parameter sets. Each set is used to simulate every test once.
    pub simulations: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Vector width of the simulations; `None` for the widest that the machine supports. The result does not
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

/// The tests count as informative about a parameter if its posterior interval is narrower than its prior interval by at
/// least this fraction.
const INFORMATIVE: f64 = 0.15;

/// Correlation above which two parameters are reported as inseparable.
const ALIKE: f64 = 0.9;

/// A warning is given if the simulations with the observed mode have less than this share of the posterior weight.
const UNSEEN: f64 = 0.2;

/// Observed collapses, read from a table with one row per test.
///
/// | column | content |
/// |---|---|
/// | `mode` | `ejection`, `rocking`, `rack-sliding`, `overturning`, or `stands` |
/// | `B4.1 fell (s)` | time at which barrel `B4.1` fell, or `stands`; one column per barrel |
/// | `first fall (s)`, `first barrel` | time of the first fall and name of the barrel, if the other falls were not observed |
/// | `loss of seat (s)` | time at which the first body left its seat |
/// | `until (s)` | duration of the observation; required if a barrel or the stack still stood |
/// | `scenario` | scenario of the test, if the tests have different scenarios |
///
/// An empty cell means that the quantity was not observed. Times are measured from the start of the motion.
#[derive(Clone, Debug)]
pub struct Observations {
    file: String,
    tests: Vec<Observed>,
    warnings: Vec<String>,
}

impl Observations {
    /// Reads the observations from a table.
    ///
    /// If a row does not state the end of the observation, the end is the last time in the row plus five times the
    /// standard deviation `errors.reading`.
    ///
    /// # Errors
    /// If a cell is invalid; the error names the first invalid cell.
    pub fn read(table: &Table, errors: &Errors) -> Result<Self, CalibrateError> {
        let (tests, warnings) = Observed::read(table, 5.0 * errors.reading)?;
        Ok(Self { file: table.file().to_owned(), tests, warnings })
    }

    /// Returns, for each test, the scenario that its row names, or `None` if it names none.
    pub fn scenarios(&self) -> impl Iterator<Item = Option<&str>> {
        self.tests.iter().map(|test| test.scenario.as_deref())
    }
}

/// A test that is ready to be simulated.
struct PreparedTest<'a> {
    observed: &'a Observed,
    tunable: Tunable,
    /// Scenario of the test; its run lasts as long as the observation.
    scenario: Scenario,
    /// Ground motion, in a plane or in three dimensions.
    ground: Shaking,
    /// Standard deviation (m at full scale) of the positions of racks and barrels.
    scatter: f64,
}

/// Estimates parameters of a stack from observed collapses; `scenarios` holds one scenario per test, in order.
///
/// Collapse is chaotic: the course of a single collapse cannot be fitted, but the probability of a course
/// can. Each set of parameters is simulated with random offsets of racks and barrels, since no two stacks are
/// built alike. The set is then weighted by the likelihood of the observations given the simulated course
/// ([`Errors`]). Further rounds sample around likely parameters. The intervals hold the central 95 % of the
/// weight. If too few courses agree with the observations, the likelihood is raised to a power below one,
/// which widens the intervals; the result states the power. The constants of the rack–ground interface keep
/// their ratio to those of the barrel–rack interface, as in [`super::response`].
///
/// The result is a function of the observations, the scenarios and the settings, independent of the number of
/// threads. `report` is called from several threads with the number of completed simulations and the total, and may
/// cancel the calibration.
///
/// # Errors
/// If a scenario is not a stack whose contact laws are linear, cannot be simulated or does not match the observations,
/// or if no simulation within the range runs to its end; [`CalibrateError::Stopped`] if `report` canceled it.
pub fn collapse(
    observations: &Observations,
    scenarios: &[Scenario],
    parameters: &[Parameter],
    settings: &Settings,
    report: &(dyn Fn(usize, usize) -> ControlFlow<()> + Sync),
) -> Result<Calibration, CalibrateError> {
    let tests = prepared(observations, scenarios, parameters, settings)?;
    let Some(lead) = tests.first() else { return Ok(Calibration::default()) };
    let reach = math::log(settings.within);
    let point = |draw: &Draw| draw.point.iter().map(|x| reach * x).collect::<Vec<f64>>();
    let of = settings.simulations * tests.len();
    let mut courses: Vec<Option<Course>> = Vec::new();
    let mut stopped = false;
    let posterior = sample(parameters.len(), settings.simulations, settings.seed, |draws| {
        let before = courses.len();
        let batch: Vec<Built> = draws
            .iter()
            .flat_map(|draw| {
                // One generator for all tests of a sample, so that every stack has its own placement.
                let mut random = Random::new(draw.seed);
                let built = |test: &PreparedTest<'_>| {
                    let scenario = test.tunable.at(&test.scenario, &point(draw));
                    let scenario = Arc::new(placed(&scenario, test.scatter, &mut random));
                    Built { scenario, ground: test.ground.clone() }
                };
                tests.iter().map(built).collect::<Vec<_>>()
            })
            .collect();
        let overall = |done| report(before + done, of.max(before + done));
        let simulated = if stopped { None } else { simulate(batch, settings.lanes, &overall) };
        let Some(simulated) = simulated else {
            stopped = true;
            return vec![f64::NEG_INFINITY; draws.len()];
        };
        let logs = simulated
            .chunks_exact(tests.len())
            .map(|courses| {
                let log = |(test, course): (&PreparedTest<'_>, &Option<Course>)| {
                    course.as_ref().map_or(f64::NEG_INFINITY, |course| {
                        settings.errors.log_likelihood(test.observed, course)
                    })
                };
                tests.iter().zip(courses).map(log).sum()
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
        reason: "in every simulation within the range, the stack falls under its own weight or the run fails: \
                 start from other values"
            .to_owned(),
    })?;
    let estimates = estimates(&lead.tunable, &posterior, reach);
    let correlation = normalized(&posterior.covariance());
    let medians: Vec<f64> =
        (0..parameters.len()).map(|at| reach * posterior.quantile(at, 0.5)).collect();
    let mut warnings = observations.warnings.clone();
    warnings.extend(identifiability(&estimates, &correlation, &posterior, settings.within));
    let mut facts = vec![
        ("tests".to_owned(), tests.len().to_string()),
        ("simulations".to_owned(), courses.len().to_string()),
        ("effective number of draws".to_owned(), short(posterior.effective())),
        ("power of the likelihood".to_owned(), short(posterior.power)),
        (
            "prior range".to_owned(),
            format!("within a factor of {} of the scenario", settings.within),
        ),
        ("seed".to_owned(), settings.seed.to_string()),
    ];
    for (at, test) in tests.iter().enumerate() {
        let (name, share) = alike(test, courses.iter().skip(at).step_by(tests.len()), &posterior);
        if let Some(share) = share {
            facts.push((
                format!("test {}: {name}", at + 1),
                format!("{:.0} % of the weight", 100.0 * share),
            ));
            if share < UNSEEN {
                warnings.push(format!(
                    "test {}: the model hardly reproduces the observed mode ({name}: these simulations have {:.0} % of \
                     the weight): check that motion, geometry and the definition of the mode match the test",
                    at + 1,
                    100.0 * share
                ));
            }
        }
    }
    Ok(Calibration {
        title: format!(
            "collapse {}: simulated with random placements of racks and barrels",
            observations.file
        ),
        scenario: lead.tunable.scenario_lines(&medians),
        estimates,
        correlation,
        condition: None,
        figures: picture::pictures(&tests, &courses, &posterior),
        facts,
        warnings,
        ..Calibration::default()
    })
}

/// Pairs each test with its scenario, and checks that the scenarios agree with each other and with the
/// observations.
fn prepared<'a>(
    observations: &'a Observations,
    scenarios: &[Scenario],
    parameters: &[Parameter],
    settings: &Settings,
) -> Result<Vec<PreparedTest<'a>>, CalibrateError> {
    if scenarios.len() != observations.tests.len() {
        return Err(CalibrateError::Scenario(format!(
            "there are {} scenarios for {} tests: give one scenario per test, in the same order",
            scenarios.len(),
            observations.tests.len()
        )));
    }
    let mut tests: Vec<PreparedTest<'_>> = Vec::new();
    for (at, (observed, scenario)) in observations.tests.iter().zip(scenarios).enumerate() {
        let tunable = Tunable::new(scenario, parameters)?;
        let scale = scenario.run.similitude;
        let mut scenario = scenario.clone();
        scenario.run.duration = Some(observed.until / scale.sqrt());
        scenario.run.stop_after_collapse = None;
        if let Some(lead) = tests.first() {
            let differs = |p: &&Parameter| lead.tunable.start(**p) != tunable.start(**p);
            if let Some(parameter) = parameters.iter().find(differs) {
                return Err(CalibrateError::Scenario(format!(
                    "the scenarios of tests 1 and {} differ in {}, but a fit gives one value for all tests: state the \
                     same value in both scenarios, or do not fit this parameter",
                    at + 1,
                    parameter.name()
                )));
            }
        }
        check(at, observed, &scenario)?;
        let ground = Shaking::of(&scenario).map_err(RunFailure::from)?;
        let scatter = settings.placement / scale;
        tests.push(PreparedTest { observed, tunable, scenario, ground, scatter });
    }
    Ok(tests)
}

/// Runs a scenario for one millisecond and returns the names of its barrels, or an error if the scenario cannot be
/// simulated.
pub(crate) fn barrels(scenario: &Scenario) -> Result<Vec<String>, CalibrateError> {
    let mut short = scenario.clone();
    short.run.duration = Some(1e-3);
    Ok(if short.is_spatial() {
        let run = barrelstack_space::run::run(&short)?;
        let barrels = run.stack.of_kind(PartKind::Barrel);
        barrels.map(|body| run.stack.parts[body].name.clone()).collect()
    } else {
        let run = short.run()?;
        let barrels = run.assembly.of_kind(PartKind::Barrel);
        barrels.map(|body| run.assembly.parts[body].name.clone()).collect()
    })
}

/// Checks that the scenario of a test can be simulated, and that it contains the observed barrels.
fn check(at: usize, observed: &Observed, scenario: &Scenario) -> Result<(), CalibrateError> {
    let barrels = barrels(scenario)?;
    let named = observed.falls.iter().map(|(barrel, _)| barrel).chain(&observed.first_barrel);
    for barrel in named {
        if !barrels.contains(barrel) {
            let known: Vec<&str> = barrels.iter().map(String::as_str).collect();
            return Err(CalibrateError::Scenario(format!(
                "test {}: the scenario has no barrel \"{barrel}\"; {}",
                at + 1,
                advice(barrel, &known)
            )));
        }
    }
    if observed.until > 120.0 {
        return Err(CalibrateError::Run(RunFailure::Duration(format!(
            "test {}: the observation lasts {} s, too long to be simulated many times: shorten it to at most 120 s",
            at + 1,
            observed.until
        ))));
    }
    Ok(())
}

pub(crate) fn estimates(tunable: &Tunable, posterior: &Posterior, reach: f64) -> Vec<Estimate> {
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

/// Returns one sentence for each quantity that the tests do not determine.
pub(crate) fn identifiability(
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
                "the observations do not determine {}: its interval is the range that was tried, not a \
                 measurement; determine it by a separate test, or do not fit it",
                estimate.name
            ));
        } else if posterior.quantile(at, 0.975) > 0.98 || posterior.quantile(at, 0.025) < -0.98 {
            warnings.push(format!(
                "the interval of {} reaches the end of the range that was tried (a factor of {within}): widen the range",
                estimate.name
            ));
        }
    }
    warnings.extend(inseparable(estimates, correlation, ALIKE));
    if posterior.power < 1.0 {
        warnings.push(format!(
            "too few simulations agree with the observations, so the likelihood is raised to the power {} and \
             the intervals are wider than necessary: run more simulations",
            short(posterior.power)
        ));
    }
    warnings
}

/// Returns the name of the observed mode of a test, and the weight of the simulations with this mode; `None`
/// if no mode was observed.
fn alike<'a>(
    test: &PreparedTest<'_>,
    courses: impl Iterator<Item = &'a Option<Course>>,
    posterior: &Posterior,
) -> (String, Option<f64>) {
    let Some(mode) = test.observed.mode else { return (String::new(), None) };
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
