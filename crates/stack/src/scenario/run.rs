//! Settings of the run and of its recording, and the thresholds of a collapse.

use barrelstack_input::choices::Chosen as _;
use barrelstack_input::declared::Declared as _;
use barrelstack_input::{choices, named, section};

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Kind, Range, names};
use super::reader::Reader;
use super::tree::Table;

/// Fields of `[run]` that determine the end of a run.
pub const ENDS: [&str; 3] = ["until", "duration", "stop_after_collapse"];

choices! {
    /// Time integration method.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub enum Method, among the fields of RUN;
    /// The time integration methods.
    static METHODS;
    /// Velocity Verlet: order two, fixed step.
    VelocityVerlet = "velocity-verlet";
    /// Semi-implicit Euler: order one, fixed step.
    SemiImplicitEuler = "semi-implicit-euler";
    /// Classical Runge-Kutta: order four, fixed step.
    RungeKutta4 = "runge-kutta-4";
    /// Bogacki-Shampine: order three, with error control.
    BogackiShampine = "bogacki-shampine" {
        /// Largest relative error of one step.
        tolerance: f64 =
            Kind::Number(Range { least: 1e-14, above: false, greatest: 0.1 }), Default::Value("1e-6");
    }
}

named! {
    /// Criterion that ends a run before its time limit.
    pub enum Until {
        /// The motion is over, and all bodies have come to rest.
        Rest = "rest",
        /// The verdict is known: 2 s after the first loss of a seat, or once a standing stack has come to rest and the
        /// remaining ground motion is too weak to move it.
        Verdict = "verdict",
        /// The stated duration is over.
        Duration = "duration",
    }
}

named! {
    /// Accuracy of the computed motion.
    pub enum Accuracy {
        /// For statistics of many cases.
        Screening = "screening",
        /// The times of falls differ by at most 10 ms, and the drifts by at most 1 %, from the results with time steps
        /// ten times shorter.
        Standard = "standard",
        /// For single cases in which every number matters.
        Fine = "fine",
    }
}

impl Accuracy {
    /// Returns the ratio of the time step to the time step with [`Accuracy::Standard`].
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

/// Maximum number of steps of a run with a fixed step.
const MOST_STEPS: f64 = 1e9;

section! {
    /// Settings of a run.
    ///
    /// With a similitude `λ`, masses are scaled by `λ³`, stiffness by `λ²`, damping by `λ^2.5` and time by `√λ`.
    #[derive(Debug, Clone, PartialEq)]
    pub struct RunSpec;
    /// Settings of the run.
    pub static RUN = "run", by method of METHODS;
    /// Criterion that ends the run. "rest" ends the run when the ground is still and all bodies are at rest; after a
    /// collapse, it is enough that the ground acceleration stays below 0.02 g. "verdict" ends the run 2 s after the
    /// first loss of a seat; a run without such a loss ends when all bodies are at rest and the ground acceleration
    /// stays below 0.02 g. "duration" ends the run after `duration`. If `until` is "rest", `imperfections.until`
    /// determines when the runs of the variants end.
    until: Until = Kind::Choice(names::<Until>),
        Default::Derived("\"rest\" for a stack, \"duration\" for a free scene");
    /// Maximum time for which a run continues after the end of the motion if `until` is "rest" or "verdict".
    patience: f64 = Kind::Quantity(&[Dimension::TIME], Range::between(0.0, LONGEST_RUN)), Default::Value("\"30 s\"");
    /// Simulated time; if `until` is "rest" or "verdict", the maximum simulated time.
    duration: Option<f64> = Kind::Quantity(&[Dimension::TIME], Range::up_to(LONGEST_RUN)),
        Default::Derived("the duration of the motion plus `patience`, or plus 5 s if the run ends by duration");
    /// Time integration method.
    method: Method = Kind::Choice(Method::names), Default::Value("\"velocity-verlet\"");
    /// Accuracy of the computed motion if no step is given. With "standard", the times of falls differ by at most 10
    /// ms, and the drifts by at most 1 %, from the results with steps ten times shorter. The steps of "screening" are
    /// 1.25 times as long as those of "standard", and the steps of "fine" are a quarter as long.
    accuracy: Accuracy = Kind::Choice(names::<Accuracy>), Default::Value("\"standard\"");
    /// Time step, or first step of an adaptive method; "auto" derives it from the contacts and the accuracy. The step is divided during impacts.
    step: Option<f64> =
        Kind::WordOr("auto", &[Dimension::TIME], Range { least: 1e-9, above: false, greatest: 0.1 }),
        Default::Value("\"auto\"");
    /// Time for which the run continues after a collapse.
    stop_after_collapse: Option<f64> =
        Kind::Quantity(&[Dimension::TIME], Range::between(0.0, LONGEST_RUN)), Default::Derived("never stop early");
    /// Acceleration of gravity.
    gravity: f64 = Kind::Quantity(&[Dimension::ACCELERATION], Range::between(0.0, 1000.0)),
        Default::Value("\"9.80665 m/s^2\"");
    /// Length scale of a Froude similitude that is applied to bodies, contacts and motion.
    similitude: f64 = Kind::Number(Range { least: 1e-3, above: false, greatest: 1e3 }), Default::Value("1.0");
    /// True if the bodies are brought to rest under gravity before the motion starts.
    settle: bool = Kind::Flag, Default::Value("true");
}

section! {
    /// Rates at which a run is recorded.
    #[derive(Debug, Clone, PartialEq)]
    pub struct RecordSpec;
    /// Rates at which the run is recorded.
    pub static RECORD = "record";
    /// Number of frames, with the poses of all bodies, per second of simulated time.
    frame_rate: f64 =
        Kind::Quantity(&[Dimension::FREQUENCY], Range::between(0.01, 1e4)), Default::Value("\"60 Hz\"");
    /// Number of samples of time histories per second of simulated time.
    history_rate: f64 =
        Kind::Quantity(&[Dimension::FREQUENCY], Range::between(0.01, 1e5)), Default::Value("\"200 Hz\"");
}

section! {
    /// Thresholds that define a collapse.
    #[derive(Debug, Clone, PartialEq)]
    pub struct OutcomeSpec;
    /// Thresholds that define a collapse; every default is an assumption to be varied.
    pub static OUTCOME = "outcome";
    /// A barrel has lost its seat when the distance of its center from its position in the rack exceeds this number of
    /// barrel radii.
    seat_loss_ratio: f64 = Kind::Number(Range::up_to(10.0)), Default::Value("0.5");
    /// A body counts as fallen when its center is more than this distance below its position at rest.
    fall_drop: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::POSITIVE), Default::Value("\"0.2 m\"");
    /// A rack has left the barrels below when its displacement relative to these barrels exceeds this fraction of the
    /// largest displacement at which they still carry the rack. Beyond that displacement, a rack that moves across the
    /// barrels rests on their curved sides, where friction cannot hold it; if a rack moves along the barrels, one of
    /// its rails lies beyond their ends.
    rack_slide_ratio: f64 = Kind::Number(Range::up_to(10.0)), Default::Value("1.0");
    /// A level counts as tipped over if its rack is inclined by more than this angle.
    rocking_angle: f64 =
        Kind::Quantity(&[Dimension::ANGLE], Range::up_to(3.2)), Default::Value("\"20 deg\"");
    /// The stack counts as overturned if its bottom rack is inclined by more than this angle.
    overturning_angle: f64 =
        Kind::Quantity(&[Dimension::ANGLE], Range::up_to(3.2)), Default::Value("\"30 deg\"");
}

/// Reads the run settings; `until` is the default of the field `until`.
pub(super) fn read_run(reader: Reader<'_>, until: Until) -> Result<RunSpec, ScenarioError> {
    let mut run = RunSpec::read_fields(&reader)?;
    if reader.leaves_out("until") {
        run.until = until;
    }
    if let (Some(duration), Some(step)) = (run.duration, run.step)
        && duration / step > MOST_STEPS
    {
        let message = format!(
            "`{}` of {step} s gives more than 1e9 steps in {duration} s; take a longer step",
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
