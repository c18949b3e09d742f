//! How a scenario is run, what is kept, and when a stack counts as collapsed.

use barrelstack_input::section;

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Field, Kind, Named, Range, Section, Variant, Variants, names};
use super::reader::Reader;
use super::tree::Table;
use super::writer::Writer;

/// Fields of `[run]` that end a run early.
pub const ENDS: [&str; 3] = ["until", "duration", "stop_after_collapse"];

/// Time integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Semi-implicit Euler, fixed step.
    SemiImplicitEuler,
    /// Velocity Verlet, fixed step.
    VelocityVerlet,
    /// Classical Runge–Kutta of order four, fixed step.
    RungeKutta4,
    /// Bogacki–Shampine of order three with error control.
    BogackiShampine {
        /// Relative error allowed in one step.
        tolerance: f64,
    },
}

/// What ends a run by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Until {
    /// The motion is over, and what moves has come to rest.
    Rest,
    /// The time is over.
    Duration,
}

impl Named for Until {
    const NAMES: &'static [(&'static str, Self)] =
        &[("rest", Self::Rest), ("duration", Self::Duration)];
}

/// How near the motion of the bodies is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Accuracy {
    /// For many cases, of which shares are wanted.
    Screening,
    /// Falls within 10 ms and drifts within 1 % of those of ten times shorter steps.
    Standard,
    /// For single cases whose every number is wanted.
    Fine,
}

impl Accuracy {
    /// Its time step in those of the standard accuracy.
    pub fn step(self) -> f64 {
        match self {
            Self::Screening => 1.25,
            Self::Standard => 1.0,
            Self::Fine => 0.25,
        }
    }
}

impl Named for Accuracy {
    const NAMES: &'static [(&'static str, Self)] =
        &[("screening", Self::Screening), ("standard", Self::Standard), ("fine", Self::Fine)];
}

/// How a scenario is run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSpec {
    /// What ends the run by itself.
    pub until: Until,
    /// Longest time of a run that ends by rest, after the end of its motion (s).
    pub patience: f64,
    /// Length of the run (s), of one that ends by rest the longest; `None` for that of the motion, with
    /// `patience` or 5 s more.
    pub duration: Option<f64>,
    /// Time integration.
    pub method: Method,
    /// How near the motion is computed, where no step is given.
    pub accuracy: Accuracy,
    /// Time step, or first step of an adaptive method (s); `None` for a step from the contacts.
    pub step: Option<f64>,
    /// Time to keep running after a collapse (s); `None` to run to the end.
    pub stop_after_collapse: Option<f64>,
    /// Acceleration of gravity (m/s²).
    pub gravity: f64,
    /// Length scale `λ` of Froude similitude applied to bodies, contacts and motion: mass `λ³`,
    /// stiffness `λ²`, damping `λ^2.5`, time `√λ`.
    pub similitude: f64,
    /// Whether the bodies are brought to rest under gravity before the motion starts.
    pub settle: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum MethodName {
    SemiImplicitEuler,
    VelocityVerlet,
    RungeKutta4,
    BogackiShampine,
}

impl Named for MethodName {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("velocity-verlet", Self::VelocityVerlet),
        ("semi-implicit-euler", Self::SemiImplicitEuler),
        ("runge-kutta-4", Self::RungeKutta4),
        ("bogacki-shampine", Self::BogackiShampine),
    ];
}

/// Longest run (s).
const LONGEST_RUN: f64 = 3600.0;

/// Most steps of a run of fixed step.
const MOST_STEPS: f64 = 1e9;

/// How it is run.
pub static RUN: Section = Section {
    name: "run",
    help: "How the scenario is run.",
    fields: &[
        Field::new(
            "until",
            Kind::Choice(names::<Until>),
            Default::Derived("\"rest\" for a stack, \"duration\" for a free scene"),
            "What ends the run by itself: the ground is still, or below 0.02 g after a collapse, and what moves has come to rest, or the duration is over.",
        ),
        Field::new(
            "patience",
            Kind::Quantity(&[Dimension::TIME], Range::between(0.0, LONGEST_RUN)),
            Default::Value("\"30 s\""),
            "Longest time that a run which ends by rest goes on after the motion.",
        ),
        Field::new(
            "duration",
            Kind::Quantity(&[Dimension::TIME], Range::up_to(LONGEST_RUN)),
            Default::Derived("that of the motion, and `patience` or else 5 s more"),
            "Simulated time; of a run that ends by rest, the longest.",
        ),
        Field::new(
            "method",
            Kind::Choice(names::<MethodName>),
            Default::Value("\"velocity-verlet\""),
            "Time integration.",
        ),
        Field::new(
            "accuracy",
            Kind::Choice(names::<Accuracy>),
            Default::Value("\"standard\""),
            "How near the motion is computed where no step is given: \"standard\" takes steps with which falls come within 10 ms and drifts within 1 % of those of ten times shorter ones, \"screening\" 1.5 times as long ones, \"fine\" a quarter.",
        ),
        Field::new(
            "step",
            Kind::WordOr(
                "auto",
                &[Dimension::TIME],
                Range { least: 1e-9, above: false, greatest: 0.1 },
            ),
            Default::Value("\"auto\""),
            "Time step, or first step of an adaptive method; \"auto\" takes it from the contacts and the accuracy. Impacts divide it while they last.",
        ),
        Field::new(
            "stop_after_collapse",
            Kind::Quantity(&[Dimension::TIME], Range::between(0.0, LONGEST_RUN)),
            Default::Derived("never stop early"),
            "Time to keep running after a collapse.",
        ),
        Field::new(
            "gravity",
            Kind::Quantity(&[Dimension::ACCELERATION], Range::between(0.0, 1000.0)),
            Default::Value("\"9.80665 m/s^2\""),
            "Acceleration of gravity.",
        ),
        Field::new(
            "similitude",
            Kind::Number(Range { least: 1e-3, above: false, greatest: 1e3 }),
            Default::Value("1.0"),
            "Length scale of Froude similitude applied to bodies, contacts and motion together.",
        ),
        Field::new(
            "settle",
            Kind::Flag,
            Default::Value("true"),
            "Whether the bodies are brought to rest under gravity before the motion starts.",
        ),
    ],
    variants: Some(Variants {
        tag: "method",
        list: &[
            Variant { name: "velocity-verlet", help: "Order two, fixed step.", fields: &[] },
            Variant { name: "semi-implicit-euler", help: "Order one, fixed step.", fields: &[] },
            Variant { name: "runge-kutta-4", help: "Order four, fixed step.", fields: &[] },
            Variant {
                name: "bogacki-shampine",
                help: "Order three with error control.",
                fields: &[Field::new(
                    "tolerance",
                    Kind::Number(Range { least: 1e-14, above: false, greatest: 0.1 }),
                    Default::Value("1e-6"),
                    "Relative error allowed in one step.",
                )],
            },
        ],
    }),
    exclusive: &[],
};

section! {
    /// What is kept of a run.
    #[derive(Debug, Clone, PartialEq)]
    pub struct RecordSpec;
    /// What is kept of the run.
    pub static RECORD = "record";
    /// Frames of all poses per second of simulated time.
    frame_rate: f64 =
        Kind::Quantity(&[Dimension::FREQUENCY], Range::between(0.01, 1e4)), Default::Value("\"60 Hz\"");
    /// Samples of time histories per second of simulated time.
    history_rate: f64 =
        Kind::Quantity(&[Dimension::FREQUENCY], Range::between(0.01, 1e5)), Default::Value("\"200 Hz\"");
}

section! {
    /// Thresholds that tell a collapse.
    #[derive(Debug, Clone, PartialEq)]
    pub struct OutcomeSpec;
    /// Thresholds that tell a collapse; every default is an assumption to be varied.
    pub static OUTCOME = "outcome";
    /// A barrel has lost its seat when its center is this many barrel radii away from its place in the rack.
    seat_loss_ratio: f64 = Kind::Number(Range::up_to(10.0)), Default::Value("0.5");
    /// A body has fallen when its center is this far below its place at rest.
    fall_drop: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::POSITIVE), Default::Value("\"0.2 m\"");
    /// A rack has left the barrels below when it has moved this part of its reach on them: across the barrels until friction cannot hold it on the round, along them until its rail passes the end.
    rack_slide_ratio: f64 = Kind::Number(Range::up_to(10.0)), Default::Value("1.0");
    /// A level has rocked over when its rack is inclined more than this.
    rocking_angle: f64 =
        Kind::Quantity(&[Dimension::ANGLE], Range::up_to(3.2)), Default::Value("\"20 deg\"");
    /// The stack has overturned when its bottom rack is inclined more than this.
    overturning_angle: f64 =
        Kind::Quantity(&[Dimension::ANGLE], Range::up_to(3.2)), Default::Value("\"30 deg\"");
}

/// Reads how it is run.
///
/// `until` ends it where the file does not say what does.
pub(super) fn read_run(reader: Reader<'_>, until: Until) -> Result<RunSpec, ScenarioError> {
    let method = match reader.choice::<MethodName>("method")? {
        MethodName::SemiImplicitEuler => Method::SemiImplicitEuler,
        MethodName::VelocityVerlet => Method::VelocityVerlet,
        MethodName::RungeKutta4 => Method::RungeKutta4,
        MethodName::BogackiShampine => {
            Method::BogackiShampine { tolerance: reader.number("tolerance")? }
        }
    };
    let run = RunSpec {
        until: reader.optional_choice("until")?.unwrap_or(until),
        patience: reader.quantity("patience")?,
        duration: reader.optional_quantity("duration")?,
        method,
        accuracy: reader.choice("accuracy")?,
        step: reader.word_or_quantity("step")?,
        stop_after_collapse: reader.optional_quantity("stop_after_collapse")?,
        gravity: reader.quantity("gravity")?,
        similitude: reader.number("similitude")?,
        settle: reader.flag("settle")?,
    };
    if let (Some(duration), Some(step)) = (run.duration, run.step)
        && duration / step > MOST_STEPS
    {
        let message = format!(
            "`{}` of {step} s makes more than 1e9 steps in {duration} s; take a longer step",
            reader.path_of("step")
        );
        return Err(reader.inconsistent("step", message));
    }
    reader.finish();
    Ok(run)
}

/// Writes how it is run.
pub(super) fn write_run(run: &RunSpec) -> Table {
    let name = match run.method {
        Method::SemiImplicitEuler => MethodName::SemiImplicitEuler,
        Method::VelocityVerlet => MethodName::VelocityVerlet,
        Method::RungeKutta4 => MethodName::RungeKutta4,
        Method::BogackiShampine { .. } => MethodName::BogackiShampine,
    };
    let mut writer = Writer::variant(&RUN, name);
    if let Method::BogackiShampine { tolerance } = run.method {
        writer.number("tolerance", tolerance);
    }
    writer.choice("until", run.until);
    writer.quantity("patience", run.patience);
    writer.optional_quantity("duration", run.duration);
    writer.choice("accuracy", run.accuracy);
    writer.word_or_quantity("step", run.step);
    writer.optional_quantity("stop_after_collapse", run.stop_after_collapse);
    writer.quantity("gravity", run.gravity);
    writer.number("similitude", run.similitude);
    writer.flag("settle", run.settle);
    writer.finish()
}
