//! The scenario: what stands where, what shakes it, and how it is run.

pub mod barrel;
pub mod free;
pub mod interface;
pub mod motion;
pub mod rack;
pub mod run;
pub mod stack;

pub use barrel::{Barrel, Fill};
pub use free::{FreeBody, FreeInterface, FreeScene, Ground, Nodes, Shape, Viscous};
pub use interface::{Basis, Damping, Friction, Interface, NormalLaw};
pub use motion::{
    Amplitude, Direction, FileRef, MotionSource, MotionSpec, Processing, Pulse, PulseKind,
    RecordMotion, RecordSource, Scale, Sine, Vertical,
};
pub use rack::{Cradle, Posts, Rack, RackKind};
pub use run::{Method, OutcomeSpec, RecordSpec, RunSpec};
pub use stack::{BodyOverride, StackBody, StackInterfaces, StackSpec, View};

/// A checked scenario in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// One line for people.
    pub title: String,
    /// What stands.
    pub scene: Scene,
    /// What shakes it.
    pub motion: MotionSpec,
    /// How it is run.
    pub run: RunSpec,
    /// What is kept.
    pub record: RecordSpec,
}

/// What stands.
#[derive(Debug, Clone, PartialEq)]
pub enum Scene {
    /// A stack of barrels on racks.
    Stack {
        /// The stack.
        stack: StackSpec,
        /// Thresholds that tell a collapse.
        outcome: OutcomeSpec,
    },
    /// Any planar bodies.
    Free(FreeScene),
}
