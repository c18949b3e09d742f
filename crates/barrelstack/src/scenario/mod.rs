//! The scenario: what stands where, what shakes it, and how it is run.
//!
//! A scenario is a TOML text in which every quantity carries its unit. Reading it gives plain data in
//! SI units, checked so far that nothing downstream has to check again, or one error with its place.
//!
//! ```
//! use barrelstack::scenario::{Scenario, View};
//!
//! let text = r#"
//!     schema = 1
//!     [stack]
//!     levels = 4
//!     columns = 2
//!     [motion.sine]
//!     amplitude = "4 in"
//!     period = "1.07 s"
//!     cycles = 10
//! "#;
//! let scenario = Scenario::parse("four.toml", text, &[])?;
//! let stack = scenario.stack().expect("a stack");
//! assert_eq!((stack.view, stack.racks_per_level()), (View::Transverse, 1));
//!
//! let error = Scenario::parse("four.toml", &text.replace("levels", "levles"), &[]).unwrap_err();
//! assert_eq!(
//!     error.sentence(),
//!     "four.toml:4:5: unknown key `levles` in [stack]; did you mean `levels`?"
//! );
//! # Ok::<(), barrelstack::scenario::ScenarioError>(())
//! ```
//!
//! Each field is defined once, in a table of [`field::Section`]s next to the type it fills; the reader,
//! the writer of resolved text, the [JSON Schema](schema) and the
//! [reference](mod@reference) all look there. To add a
//! field: a line in that table, a field in the type, a line in its `read` and one in its `write`;
//! leaving one out fails the tests.

pub mod barrel;
pub mod builtin;
pub mod catalog;
pub mod dimension;
pub mod error;
pub mod field;
pub mod free;
pub mod interface;
mod listing;
mod load;
mod merge;
pub mod motion;
pub mod quantity;
pub mod rack;
pub(crate) mod reader;
pub mod reference;
mod root;
pub mod run;
pub mod schema;
pub mod shape;
pub mod stack;
pub mod strap;
pub(crate) mod template;
pub(crate) mod tree;
mod unit;
mod writer;

pub use barrel::{Barrel, Fill};
pub use dimension::Dimension;
pub use error::{Place, Problem, ScenarioError};
pub use free::{FreeBody, FreeInterface, FreeScene, Ground, Nodes, Viscous};
pub use interface::{Basis, Damping, Friction, Interface, NormalLaw};
pub use listing::{Setting, Source};
pub use motion::{
    Amplitude, Direction, FileRef, MeasuredOn, MotionSource, MotionSpec, Processing, Pulse,
    PulseKind, RecordMotion, RecordSource, Scale, Sine, Vertical,
};
pub use quantity::{Quantity, QuantityError};
pub use rack::{Cradle, Posts, Rack, RackKind};
pub use root::ROOT;
pub use run::{Method, OutcomeSpec, RecordSpec, RunSpec};
pub use shape::{Shape, Uniform};
pub use stack::{BodyOverride, StackBody, StackInterfaces, StackSpec, View};
pub use strap::{Straps, Ties};

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
#[expect(clippy::large_enum_variant, reason = "a scenario has one scene and is seldom copied")]
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

    /// The scenario as text that reads back equal: every default written out, every quantity in SI. Paths are kept as written.
    pub fn to_resolved_toml(&self) -> String {
        writer::to_toml(&root::write(self))
    }

    /// As [`Scenario::to_resolved_toml`], in JSON.
    pub fn to_resolved_json(&self) -> serde_json::Value {
        writer::to_json(&root::write(self))
    }

    /// Fingerprint of everything but the title: FNV-1a, 64 bits, of the resolved text.
    ///
    /// Two scenarios with the same fingerprint describe the same run, however they were written.
    /// Records count by their path as written, not by their samples.
    pub fn fingerprint(&self) -> u64 {
        let untitled = Self { title: "-".to_owned(), ..self.clone() };
        fnv1a(untitled.to_resolved_toml().as_bytes())
    }
}

/// FNV-1a, 64 bits (Fowler, Noll and Vo).
pub fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_fingerprint_is_the_published_fnv_1a() {
        // Test vectors of Noll's page on FNV.
        assert_eq!(super::fnv1a(b""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(super::fnv1a(b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(super::fnv1a(b"foobar"), 0x8594_4171_f739_67e8);
    }
}
