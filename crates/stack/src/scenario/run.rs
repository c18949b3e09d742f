//! Run and recording settings, and the thresholds of a collapse.

use barrelstack_input::choices::Chosen as _;
use barrelstack_input::declared::Declared as _;
use barrelstack_input::{choices, named, section};

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Kind, Range, names};
use super::reader::Reader;
use super::tree::Table;

/// Fields of `[run]` that end a run early.
pub const ENDS: [&str; 3] = ["until", "duration", "stop_after_collapse"];

choices! {
    /// Time integration.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub enum Method, among the fields of RUN;
    /// The methods.
    static METHODS;
    /// Order two, fixed step.
    VelocityVerlet = "velocity-verlet";
    /// Order one, fixed step.
    SemiImplicitEuler = "semi-implicit-euler";
    /// Order four, fixed step.
    RungeKutta4 = "runge-kutta-4";
    /// Order three with error control.
    BogackiShampine = "bogacki-shampine" {
        /// Relative error allowed in one step.
        tolerance: f64 =
            Kind::Number(Range { least: 1e-14, above: false, greatest: 0.1 }), Default::Value("1e-6");
    }
}

named! {
    /// Criterion that ends a run before its time limit.
    pub enum Until {
        /// The motion is over, and what moves has come to rest.
        Rest = "rest",
        /// The verdict is known: 2 s after the first loss of a seat, or, while the stack stands, once the ground stays calm and what moves has come to rest.
        Verdict = "verdict",
        /// The time is over.
        Duration = "duration",
    }
}

named! {
    /// Accuracy of the computed motion.
    pub enum Accuracy {
        /// For many cases, of which shares are wanted.
        Screening = "screening",
        /// Falls within 10 ms and drifts within 1 % of those of ten times shorter steps.
        Standard = "standard",
        /// For single cases whose every number is wanted.
        Fine = "fine",
    }
}

impl Accuracy {
    /// Returns the time step relative to that of the standard accuracy.
    pub fn step(self) -> f64 {
        match self {
            Self::Screening => 1.25,
            Self::Standard => 1.0,
            Self::Fine => 0.25,
        }
    }
}

/// Maximum duration of a run (s).
const LONGEST_RUN: f64 = 3600.0;

/// Maximum number of steps of a run of fixed step.
const MOST_STEPS: f64 = 1e9;

section! {
    /// Settings of a run.
    ///
    /// Under a similitude `λ` masses are scaled by `λ³`, stiffness by `λ²`, damping by `λ^2.5` and time by `√λ`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct RunSpec;
    /// Settings of the run.
    pub static RUN = "run", by method of METHODS;
    /// Criterion that ends the run: "rest" when the ground is still, or below 0.02 g after a collapse, and what moves has come to rest; "verdict" 2 s after the first loss of a seat, or when a standing stack has come to rest on ground that stays below 0.02 g; "duration" when that is over. Variants of a run that ends by "rest" end by `imperfections.until`.
    until: Until = Kind::Choice(names::<Until>),
        Default::Derived("\"rest\" for a stack, \"duration\" for a free scene");
    /// Longest time that a run which ends by rest goes on after the motion.
    patience: f64 = Kind::Quantity(&[Dimension::TIME], Range::between(0.0, LONGEST_RUN)), Default::Value("\"30 s\"");
    /// Simulated time; of a run that ends by rest, the longest.
    duration: Option<f64> = Kind::Quantity(&[Dimension::TIME], Range::up_to(LONGEST_RUN)),
        Default::Derived("that of the motion, and `patience` or else 5 s more");
    /// Time integration.
    method: Method = Kind::Choice(Method::names), Default::Value("\"velocity-verlet\"");
    /// Accuracy of the motion where no step is given: "standard" takes steps with which falls come within 10 ms and drifts within 1 % of those of ten times shorter ones, "screening" 1.5 times as long ones, "fine" a quarter.
    accuracy: Accuracy = Kind::Choice(names::<Accuracy>), Default::Value("\"standard\"");
    /// Time step, or first step of an adaptive method; "auto" takes it from the contacts and the accuracy. Impacts divide it while they last.
    step: Option<f64> =
        Kind::WordOr("auto", &[Dimension::TIME], Range { least: 1e-9, above: false, greatest: 0.1 }),
        Default::Value("\"auto\"");
    /// Time to keep running after a collapse.
    stop_after_collapse: Option<f64> =
        Kind::Quantity(&[Dimension::TIME], Range::between(0.0, LONGEST_RUN)), Default::Derived("never stop early");
    /// Acceleration of gravity.
    gravity: f64 = Kind::Quantity(&[Dimension::ACCELERATION], Range::between(0.0, 1000.0)),
        Default::Value("\"9.80665 m/s^2\"");
    /// Length scale of Froude similitude applied to bodies, contacts and motion together.
    similitude: f64 = Kind::Number(Range { least: 1e-3, above: false, greatest: 1e3 }), Default::Value("1.0");
    /// True if the bodies are brought to rest under gravity before the motion starts.
    settle: bool = Kind::Flag, Default::Value("true");
}

section! {
    /// Recording of a run.
    #[derive(Debug, Clone, PartialEq)]
    pub struct RecordSpec;
    /// Recording of the run.
    pub static RECORD = "record";
    /// Frames of all poses per second of simulated time.
    frame_rate: f64 =
        Kind::Quantity(&[Dimension::FREQUENCY], Range::between(0.01, 1e4)), Default::Value("\"60 Hz\"");
    /// Samples of time histories per second of simulated time.
    history_rate: f64 =
        Kind::Quantity(&[Dimension::FREQUENCY], Range::between(0.01, 1e5)), Default::Value("\"200 Hz\"");
}

section! {
    /// Thresholds that define a collapse.
    #[derive(Debug, Clone, PartialEq)]
    pub struct OutcomeSpec;
    /// Thresholds that define a collapse; every default is an assumption to be varied.
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

/// Reads the run settings; `until` is the default for the end of the run.
pub(super) fn read_run(reader: Reader<'_>, until: Until) -> Result<RunSpec, ScenarioError> {
    let mut run = RunSpec::read_fields(&reader)?;
    if reader.leaves_out("until") {
        run.until = until;
    }
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

/// Writes the run settings.
pub(super) fn write_run(run: &RunSpec) -> Table {
    let mut writer = run.start();
    run.write_chosen(&mut writer);
    run.write_fields(&mut writer);
    writer.finish()
}
