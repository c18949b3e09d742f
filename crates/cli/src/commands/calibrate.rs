//! `barrelstack calibrate`: contact parameters with their uncertainty, from the user's tests.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context as _;
use barrelstack::Scenario;
use barrelstack::export::Folder;
use barrelstack::scenario::{Dimension, Quantity};
use barrelstack_calibration::collapse::{Errors, Observations, Settings};
use barrelstack_calibration::drop::{GRAVITY, Striker};
use barrelstack_calibration::shares::{Height, Statements, levels, shares};
use barrelstack_calibration::{
    CalibrateError, Calibration, Parameter, Table, collapse, drop, friction, response, sag,
    stiffness, sway,
};
use clap::{Subcommand, ValueEnum};

use crate::args::ScenarioArgs;
use crate::interrupt::Stopped;
use crate::lanes::LanesArgs;
use crate::language::LanguageArgs;
use crate::number::{real, whole};
use crate::printer;
use crate::progress::Progress;
use crate::typed::{typed, word};

/// Text at the end of the help.
const AFTER_HELP: &str = "\
Files are CSV with a header whose columns carry their unit, such as
  penetration (mm),force (kN)
Lines that start with # are skipped; the decimal mark is a point.

Intervals are 95 % intervals and include only the scatter in the file.
A mass or a stiffness given as an option, and the model itself, are taken as exact.";

/// Arguments of `calibrate`.
#[derive(Debug, clap::Args)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct CalibrateArgs {
    /// Kind of test.
    #[command(subcommand)]
    test: Test,
}

/// Kinds of tests, and their arguments.
#[derive(Debug, Subcommand)]
enum Test {
    /// Stiffness k from a press test (columns `penetration (mm),force (kN)`), from the sag under a
    /// load on a rack (columns `load (kg),sag (mm)` and, for a cradle, `angle (deg)`), or from a
    /// tap test (column `period (s)`, with --scenario).
    Stiffness(StiffnessArgs),
    /// Restitution and damping c from drop tests: columns `drop height (mm),rebound height (mm)`,
    /// or the impact times `time (s)` of one bounce sequence.
    Drop(DropArgs),
    /// Friction from pull tests (columns `normal force (N),breakaway force (N)` and, if measured,
    /// `sliding force (N)`), or from tilt tests (`angle (deg)` of first slip and, if measured,
    /// `sliding distance (m),sliding time (s)` from rest at that angle).
    Friction(FrictionArgs),
    /// Stiffness, damping and friction together, from the recorded response of a shaken stack.
    ///
    /// The file has a column `time (s)`, counted from the start of the scenario's motion, and
    /// columns named as in histories.csv, such as `B1.1_displacement_x (mm)`. The fit starts from
    /// the values of the scenario and finds the nearest minimum.
    ///
    /// Impacts, slips and falls make responses chaotic within seconds. Use a short window of mild
    /// shaking (--until) in which bodies slide a little but nothing collapses.
    Response(ResponseArgs),
    /// Stiffness, damping and friction together, from collapses observed on video or by eye.
    ///
    /// Each row of the file is a test: `mode` (ejection, rocking, rack-sliding, overturning or
    /// stands), the times of falls (`B4.1 fell (s)` and so on, or `first fall (s)` and `first
    /// barrel`), `loss of seat (s)`, the end of the observation (`until (s)`), and `scenario` if
    /// the tests have different scenarios. Times are counted from the start of the motion. In a
    /// column of times, `stands` marks a body that did not fall; an empty cell marks what was not observed. `B4.1` is
    /// the first barrel of level 4.
    ///
    /// Many stacks are simulated, each with slightly different geometry, and with parameters drawn
    /// around those of the scenario. Each simulation is weighted by its agreement with the
    /// observations.
    ///
    /// Instead of a table of tests, a TOML file can state shares: how many of the stacks or barrels
    /// fell in an earthquake, with source and uncertainty. The scenario must then describe such a
    /// stack, with the motion of the nearest station; the stack is simulated at every height that a
    /// statement names. The recipe "From what fell in an earthquake" of the guide shows such a file.
    Collapse(CollapseArgs),
}

/// Output options.
#[derive(Debug, clap::Args)]
struct ResultArgs {
    /// Print one JSON document, in SI units, in place of the table.
    #[arg(long)]
    json: bool,
    /// Write a page that plots the measurements and the fit into this folder, which must be new or
    /// empty.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Allow a folder that is not empty, and replace the files of an earlier page.
    #[arg(long, requires = "out")]
    overwrite: bool,
    #[command(flatten)]
    language: LanguageArgs,
}

/// The pair of bodies that was tested.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Pair {
    BarrelRack,
    RackGround,
    BarrelBarrel,
    BarrelGround,
    RackRack,
}

/// The pair of bodies to which the result applies.
#[derive(Debug, clap::Args)]
struct PairArgs {
    /// Pair of bodies that was tested; the lines printed for use in a scenario apply to this pair.
    #[arg(long, value_enum, default_value = "barrel-rack")]
    interface: Pair,
}

/// Changes to the scenarios of the tests.
#[derive(Debug, clap::Args)]
struct ChangeArgs {
    /// Change a value of the scenario, such as stack.levels=2; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// File of the ground motion, in place of the motion that the scenario states.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
}

impl ChangeArgs {
    /// Returns the arguments that select the scenario `name` and apply the changes to it.
    fn of(&self, name: &str) -> ScenarioArgs {
        let (set, record) = (self.set.clone(), self.record.clone());
        ScenarioArgs { scenario: name.to_owned(), set, record }
    }
}

#[derive(Debug, clap::Args)]
struct StiffnessArgs {
    /// The measurements (CSV).
    file: PathBuf,
    /// Number of seats or contact nodes that share the force; k applies to one seat or node.
    #[arg(
        long, visible_alias = "seats", default_value_t = 1, allow_negative_numbers = true,
        value_parser = whole(1..=u32::MAX)
    )]
    nodes: u32,
    /// Scenario file (TOML) or name of a built-in scenario: the stack that was tapped, in the plane
    /// in which the stack swayed.
    #[arg(long)]
    scenario: Option<String>,
    /// Change a value of the scenario of the tapped stack, such as stack.levels=2; may be repeated.
    #[arg(long, value_name = "PATH=VALUE", requires = "scenario")]
    set: Vec<String>,
    #[command(flatten)]
    pair: PairArgs,
    #[command(flatten)]
    result: ResultArgs,
}

#[derive(Debug, clap::Args)]
struct DropArgs {
    /// The measurements (CSV).
    file: PathBuf,
    /// Mass that is dropped, such as "275 kg".
    #[arg(long, requires = "stiffness", value_name = "MASS")]
    mass: Option<String>,
    /// Stiffness k of one contact node, such as "9.8 kN/cm".
    #[arg(long, requires = "mass", value_name = "K")]
    stiffness: Option<String>,
    /// Number of contact nodes that touch at the same time; k and c apply to one node.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole(1..=u32::MAX))]
    nodes: u32,
    #[command(flatten)]
    pair: PairArgs,
    #[command(flatten)]
    result: ResultArgs,
}

#[derive(Debug, clap::Args)]
struct FrictionArgs {
    /// The measurements (CSV).
    file: PathBuf,
    #[command(flatten)]
    pair: PairArgs,
    #[command(flatten)]
    result: ResultArgs,
}

#[derive(Debug, clap::Args)]
struct ResponseArgs {
    /// Scenario of the test: a file (TOML), or the name of a built-in scenario.
    scenario: String,
    /// The recorded histories (CSV).
    file: PathBuf,
    /// Parameters to fit: k and c of barrel-rack (those of rack-ground change in proportion), mu-br
    /// (friction barrel-rack), mu-rg (friction rack-ground).
    #[arg(long, value_delimiter = ',', default_value = "k,c,mu-br,mu-rg", value_name = "NAMES")]
    fit: Vec<Fitted>,
    /// Ignore rows after this time, such as "1.5 s".
    #[arg(long, value_name = "TIME")]
    until: Option<String>,
    #[command(flatten)]
    changes: ChangeArgs,
    #[command(flatten)]
    result: ResultArgs,
}

#[derive(Debug, clap::Args)]
struct CollapseArgs {
    /// Scenario of the tests: a file (TOML), or the name of a built-in scenario.
    scenario: String,
    /// Observations: a table of tests (CSV), or statements on the share that fell in an earthquake (TOML).
    file: PathBuf,
    /// Use only the statement that has this id in the TOML file; may be repeated. By default, all statements that
    /// give a share are used.
    #[arg(long, value_name = "ID")]
    statement: Vec<String>,
    /// Parameters to find: k and c of barrel-rack (those of rack-ground change in proportion),
    /// mu-br (friction barrel-rack), mu-rg (friction rack-ground).
    #[arg(long, value_delimiter = ',', default_value = "k,c,mu-br,mu-rg", value_name = "NAMES")]
    fit: Vec<Fitted>,
    /// Range of each parameter: from the value in the scenario divided by this factor to that value multiplied by this
    /// factor.
    #[arg(
        long, default_value_t = Settings::default().within, value_name = "FACTOR", allow_negative_numbers = true,
        value_parser = real("a factor above 1 and up to 100, such as 2", |number| number > 1.0 && number <= 100.0)
    )]
    within: f64,
    /// Standard deviation of observed times, such as "0.05 s".
    #[arg(long, default_value = "0.05 s", value_name = "TIME")]
    timing: String,
    /// Standard deviation of the positions of racks and barrels, such as "1 mm".
    #[arg(long, default_value = "1 mm", value_name = "LENGTH")]
    placement: String,
    /// Number of parameter sets to simulate, each once per test.
    #[arg(long, default_value_t = 1000, allow_negative_numbers = true, value_parser = whole(50_u32..=1_000_000))]
    simulations: u32,
    /// Seed of the random numbers; the same seed gives the same result.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole(0..=u64::MAX))]
    seed: u64,
    #[command(flatten)]
    lanes: LanesArgs,
    #[command(flatten)]
    changes: ChangeArgs,
    #[command(flatten)]
    result: ResultArgs,
}

typed! {
    /// The parameters, by their names on the command line.
    enum Fitted of Parameter {
        K = Self::Stiffness,
        C = Self::Damping,
        MuBr = Self::FrictionBarrelRack,
        MuRg = Self::FrictionRackGround,
    }
}

/// Reads the test, fits the parameters, and prints and plots the result.
pub(crate) fn calibrate(args: &CalibrateArgs) -> anyhow::Result<ExitCode> {
    let result = match &args.test {
        Test::Stiffness(args) => &args.result,
        Test::Drop(args) => &args.result,
        Test::Friction(args) => &args.result,
        Test::Response(args) => &args.result,
        Test::Collapse(args) => &args.result,
    };
    // Fail early if the folder cannot be written.
    let folder = result.out.as_ref().map(|out| Folder::prepare(out, result.overwrite));
    let folder = folder.transpose()?;
    let found = match &args.test {
        Test::Stiffness(args) => pressed(args)?,
        Test::Drop(args) => {
            let striker = striker(args)?;
            let table = Table::load(&args.file)?;
            drop::drop(&table, striker, &word(args.pair.interface))?
        }
        Test::Friction(args) => {
            let table = Table::load(&args.file)?;
            friction::friction(&table, &word(args.pair.interface))?
        }
        Test::Response(args) => fitted(args)?,
        Test::Collapse(args) => collapsed(args)?,
    };
    let written = folder.as_ref().map(|folder| {
        crate::interrupt::writes_to(folder.path());
        folder.write_page(&result.language.page(&found.document()))
    });
    if result.json {
        printer::document(&found.to_document())?;
    } else {
        let page = folder.map(|folder| format!("page: {}", folder.report().display()));
        let page = page.into_iter().flat_map(|page| [String::new(), page]);
        printer::lines(found.lines().into_iter().chain(page))?;
        found.warnings.iter().for_each(|warning| printer::warning(warning));
    }
    written.transpose()?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the stiffness from a press, sag or tap test; the columns of the file determine the kind
/// of test.
fn pressed(args: &StiffnessArgs) -> anyhow::Result<Calibration> {
    let table = Table::load(&args.file)?;
    let interface = word(args.pair.interface);
    let Some(scenario) = &args.scenario else {
        anyhow::ensure!(
            !table.has("period"),
            "{}: a tap test needs the stack that was tapped: add its scenario, such as --scenario demo-napa --set \
             stack.view=longitudinal",
            args.file.display()
        );
        return Ok(if table.has("sag") {
            sag::sag(&table, args.nodes, &interface)?
        } else {
            stiffness::stiffness(&table, args.nodes, &interface)?
        });
    };
    let scenario_args =
        ScenarioArgs { scenario: scenario.clone(), set: args.set.clone(), record: None };
    let scenario = super::load(&scenario_args)?;
    sway::sway(&table, &scenario).map_err(|error| placed(error, &scenario, &scenario_args))
}

fn striker(args: &DropArgs) -> anyhow::Result<Option<Striker>> {
    let (Some(mass), Some(stiffness)) = (&args.mass, &args.stiffness) else { return Ok(None) };
    Ok(Some(Striker {
        mass: positive("--mass", mass, Dimension::MASS)?,
        stiffness: positive("--stiffness", stiffness, Dimension::STIFFNESS)?,
        nodes: args.nodes,
        gravity: GRAVITY,
    }))
}

/// Returns the value (SI) of an option that is a positive quantity.
fn positive(option: &str, text: &str, dimension: Dimension) -> anyhow::Result<f64> {
    let suggestion = Quantity::suggestion(text, &[dimension]);
    let example = || format!("{option}: expected {dimension} such as \"{suggestion}\"");
    let value = Quantity::parse_as(text, &[dimension]).with_context(example)?.value;
    anyhow::ensure!(value > 0.0, "{}, above zero; found \"{text}\"", example());
    Ok(value)
}

/// Returns the requested parameters, each once.
fn parameters(fit: &[Fitted]) -> anyhow::Result<Vec<Parameter>> {
    let mut parameters: Vec<Parameter> = Vec::new();
    for fitted in fit {
        let parameter = Parameter::from(*fitted);
        anyhow::ensure!(
            !parameters.contains(&parameter),
            "--fit names {} twice; name it once",
            parameter.name()
        );
        parameters.push(parameter);
    }
    Ok(parameters)
}

/// Adds to the error of a calibration the place where its cause is stated in the scenario; if there is no such place,
/// the name of the scenario.
fn placed(error: CalibrateError, scenario: &Scenario, args: &ScenarioArgs) -> anyhow::Error {
    match error {
        CalibrateError::Run(failure) => super::placed(failure, scenario, args),
        CalibrateError::Scenario(reason) => anyhow::anyhow!("{}: {reason}", args.scenario),
        CalibrateError::Table(error) => error.into(),
        CalibrateError::Stopped => Stopped.into(),
    }
}

fn fitted(args: &ResponseArgs) -> anyhow::Result<Calibration> {
    let parameters = parameters(&args.fit)?;
    let until = args.until.as_deref().map(|until| positive("--until", until, Dimension::TIME));
    let until = until.transpose()?;
    let scenario_args = args.changes.of(&args.scenario);
    let scenario = super::load(&scenario_args)?;
    let table = Table::load(&args.file)?;
    let progress = Progress::new(true);
    let found = response::response(&scenario, &table, &parameters, until, &|done| {
        progress.searched(done as u64, "simulation", "simulations")
    });
    drop(progress);
    found.map_err(|error| placed(error, &scenario, &scenario_args))
}

fn collapsed(args: &CollapseArgs) -> anyhow::Result<Calibration> {
    let parameters = parameters(&args.fit)?;
    let settings = Settings {
        within: args.within,
        placement: positive("--placement", &args.placement, Dimension::LENGTH)?,
        errors: Errors {
            reading: positive("--timing", &args.timing, Dimension::TIME)?,
            ..Errors::default()
        },
        simulations: args.simulations as usize,
        seed: args.seed,
        lanes: args.lanes.lanes,
    };
    if args.file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        return fallen(args, &parameters, &settings);
    }
    anyhow::ensure!(
        args.statement.is_empty(),
        "--statement chooses among the statements of a TOML file, and {} is a table of tests: omit --statement",
        args.file.display()
    );
    let observations = Observations::read(&Table::load(&args.file)?, &settings.errors)?;
    let scenarios: Vec<Scenario> = observations
        .scenarios()
        .map(|name| super::load(&args.changes.of(name.unwrap_or(&args.scenario))))
        .collect::<anyhow::Result<_>>()?;
    let progress = Progress::new(true);
    let found =
        collapse::collapse(&observations, &scenarios, &parameters, &settings, &|done, of| {
            progress.counted(done as u64, of as u64, "runs")
        });
    drop(progress);
    found.map_err(|error| placed(error, &scenarios[0], &args.changes.of(&args.scenario)))
}

/// Fits parameters to statements from a file. Each statement is about the share of stacks that fell in an earthquake.
fn fallen(
    args: &CollapseArgs,
    parameters: &[Parameter],
    settings: &Settings,
) -> anyhow::Result<Calibration> {
    let statements = Statements::load(&args.file)?;
    let (earthquake, chosen) = statements.chosen(&args.statement)?;
    let levels_set =
        args.changes.set.iter().any(|change| change.trim_start().starts_with("stack.levels"));
    anyhow::ensure!(
        !levels_set,
        "--set stack.levels: the statements already state the numbers of levels; omit this change"
    );
    let heights = levels(&chosen)
        .into_iter()
        .map(|levels| {
            let mut changed = args.changes.of(&args.scenario);
            changed.set.push(format!("stack.levels={levels}"));
            Ok(Height { levels, scenario: super::load(&changed)? })
        })
        .collect::<anyhow::Result<Vec<Height>>>()?;
    let progress = Progress::new(true);
    let found = shares(earthquake, &chosen, &heights, parameters, settings, &|done, of| {
        progress.counted(done as u64, of as u64, "runs")
    });
    drop(progress);
    found.map_err(|error| placed(error, &heights[0].scenario, &args.changes.of(&args.scenario)))
}
