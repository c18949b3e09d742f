//! The scenario: what stands where, what shakes it, and how it is run.

pub mod barrel;
pub mod builtin;
pub mod catalog;
pub mod dimension;
pub mod error;
pub mod field;
pub mod free;
pub mod interface;
mod load;
mod merge;
pub mod motion;
pub mod quantity;
pub mod rack;
mod reader;
pub mod reference;
mod root;
pub mod run;
pub mod schema;
pub mod shape;
pub mod stack;
mod tree;
mod unit;
mod writer;

pub use barrel::{Barrel, Fill};
pub use dimension::Dimension;
pub use error::{Place, Problem, ScenarioError};
pub use free::{FreeBody, FreeInterface, FreeScene, Ground, Nodes, Viscous};
pub use interface::{Basis, Damping, Friction, Interface, NormalLaw};
pub use motion::{
    Amplitude, Direction, FileRef, MotionSource, MotionSpec, Processing, Pulse, PulseKind,
    RecordMotion, RecordSource, Scale, Sine, Vertical,
};
pub use quantity::{Quantity, QuantityError};
pub use rack::{Cradle, Posts, Rack, RackKind};
pub use root::ROOT;
pub use run::{Method, OutcomeSpec, RecordSpec, RunSpec};
pub use shape::{Shape, Uniform};
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

impl Scenario {
    /// The stack, unless the scene is free.
    pub fn stack(&self) -> Option<&StackSpec> {
        match &self.scene {
            Scene::Stack { stack, .. } => Some(stack),
            Scene::Free(_) => None,
        }
    }

    /// The scenario as text that reads back equal: every default written out, every quantity in SI.
    pub fn to_resolved_toml(&self) -> String {
        writer::to_toml(&root::write(self))
    }

    /// As [`Scenario::to_resolved_toml`], in JSON.
    pub fn to_resolved_json(&self) -> serde_json::Value {
        writer::to_json(&root::write(self))
    }

    /// Fingerprint of everything but the title: FNV-1a, 64 bits, of the resolved text.
    ///
    /// Two scenarios with the same fingerprint describe the same run, however they were written. Records count by
    /// their path as written, not by their samples.
    pub fn fingerprint(&self) -> u64 {
        let untitled = Self { title: "-".to_owned(), ..self.clone() };
        fnv1a(untitled.to_resolved_toml().as_bytes())
    }
}

/// FNV-1a, 64 bits (Fowler, Noll and Vo).
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
