//! How a scenario is run, what is kept, and when a stack counts as collapsed.

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

/// How a scenario is run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSpec {
    /// Length of the run (s); `None` for the duration of the motion and 5 s more.
    pub duration: Option<f64>,
    /// Time integration.
    pub method: Method,
    /// Time step, or first step of an adaptive method (s); `None` for a step from the stiffest contact.
    pub step: Option<f64>,
    /// Time to keep running after a collapse (s); `None` to run to the end.
    pub stop_after_collapse: Option<f64>,
    /// Acceleration of gravity (m/s²).
    pub gravity: f64,
    /// Length scale `λ` of Froude similitude applied to bodies, contacts and motion: mass `λ³`, stiffness `λ²`,
    /// damping `λ^2.5`, time `√λ`.
    pub similitude: f64,
    /// Whether the bodies are brought to rest under gravity before the motion starts.
    pub settle: bool,
}

/// What is kept of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordSpec {
    /// Frames of all poses per second of simulated time (Hz).
    pub frame_rate: f64,
    /// Samples of time histories per second of simulated time (Hz).
    pub history_rate: f64,
}

/// Thresholds that tell a collapse.
#[derive(Debug, Clone, PartialEq)]
pub struct OutcomeSpec {
    /// A barrel has lost its seat when its center is this many barrel radii away from its place in the rack.
    pub seat_loss_ratio: f64,
    /// A body has fallen when its center is this far below its place at rest (m).
    pub fall_drop: f64,
    /// A rack has slid off when it has moved this part of the distance between its rail and the end of the barrel
    /// below.
    pub rack_slide_ratio: f64,
    /// A level has rocked over when its rack is inclined more than this (rad).
    pub rocking_angle: f64,
    /// The stack has overturned when its bottom rack is inclined more than this (rad).
    pub overturning_angle: f64,
}
