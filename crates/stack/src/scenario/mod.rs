//! Scenarios: bodies, ground motion and run settings.
//!
//! A scenario is a TOML document in which every quantity carries its unit. Reading a scenario returns either fully
//! checked plain data in SI units, or one error with its place in the document.
//!
//! ```
//! use barrelstack_stack::scenario::{Scenario, View};
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
//! # Ok::<(), barrelstack_stack::scenario::ScenarioError>(())
//! ```
//!
//! Each field is defined once, in a [`field::Section`] next to the type that holds it; the reader, the writer of
//! resolved text, the [JSON Schema](schema) and the [reference](mod@reference) all use that definition. To add a
//! field, add a line to that section, a field to the type, and a line each to its `read` and `write`; tests fail if one
//! is missing.

pub mod barrel;
pub mod body_override;
pub mod builtin;
pub mod catalog;
pub mod element;
pub mod free;
pub mod imperfections;
pub mod interface;
mod known;
mod load;
pub mod nodes;
pub mod pair;
pub mod rack;
pub mod reference;
mod renamed;
mod root;
pub mod run;
pub mod schema;
pub mod shape;
pub mod spatial;
pub mod stack;
pub mod template;
pub mod title;
pub mod uniform;
pub mod unknowns;

pub use barrelstack_input::{
    Dimension, FileRef, Place, Problem, Quantity, QuantityError, Setting, Source, dimension, field,
    quantity,
};
pub use barrelstack_input::{fnv1a, reader, tree};
pub use barrelstack_shaking::motion;
use std::sync::Arc;

use barrelstack_input::{merge, writer};

pub use barrel::{Barrel, Fill};
pub use barrelstack_bodies::SpatialBody;
pub use body_override::{BodyOverride, StackBody};
pub use error::ScenarioError;
pub use free::{
    Boundary, ChosenNode, FreeBody, FreeInterface, FreeScene, Ground, Nodes, PartShape, Viscous,
};
pub use imperfections::Imperfections;
pub use interface::{Basis, Damping, Friction, Interface, NormalLaw};
pub use load::bytes_of;
pub use motion::{
    Amplitude, Direction, MeasuredOn, MotionSource, MotionSpec, Processing, Pulse, PulseKind,
    RecordMotion, RecordSource, Scale, Sine, Vertical,
};
pub use pair::{StackInterfaces, StackPair};
pub use rack::{Cradle, Posts, Rack, RackKind, SeatContact};
pub use root::ROOT;
pub use run::{Accuracy, Method, OutcomeSpec, RecordSpec, RunSpec, Until};
pub use shape::Shape;
pub use spatial::{SpatialGround, SpatialScene};
pub use stack::{InSpace, StackSpec, View};
pub use uniform::Uniform;
pub use unknowns::Unknowns;

/// Errors of a scenario, with the problem, its place, and what to change.
pub mod error {
    pub use barrelstack_input::{InputError as ScenarioError, Place, Problem};
}

/// A checked scenario in SI units.
///
/// ```
/// use barrelstack_stack::Scenario;
///
/// let scenario = Scenario::builtin("demo-napa", &["stack.levels=3".to_owned()])?;
/// println!("{}", scenario.title);
/// assert_eq!(scenario.stack().map(|stack| stack.levels), Some(3));
/// assert!(scenario.to_resolved_toml().contains("levels = 3"));
/// # Ok::<(), barrelstack_stack::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Title, a single line.
    pub title: String,
    /// The bodies.
    pub scene: Scene,
    /// The ground motion.
    pub motion: MotionSpec,
    /// Run settings.
    pub run: RunSpec,
    /// Recording settings.
    pub record: RecordSpec,
    written: Written,
}

/// Information about the text of a scenario. Comparisons of scenarios ignore this information.
#[derive(Clone, Default)]
struct Written {
    /// The sources and the table from which the scenario was read, so that errors can state the place of a value.
    source: Option<Arc<(tree::Sources, tree::Table)>>,
    /// Warnings about the text.
    warnings: Vec<String>,
    /// The title that the user wrote.
    own: Option<title::Own>,
}

impl PartialEq for Written {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl std::fmt::Debug for Written {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Written")
    }
}

/// The bodies of a scenario.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a scenario has one scene and is seldom copied")]
pub enum Scene {
    /// A stack of barrels on racks.
    Stack {
        /// The stack.
        stack: StackSpec,
        /// Thresholds of a collapse.
        outcome: OutcomeSpec,
        /// Random differences from stack to stack.
        imperfections: Imperfections,
        /// Uncertain constants that a whole stack shares.
        unknowns: Unknowns,
    },
    /// Arbitrary planar bodies.
    Free(FreeScene),
    /// Arbitrary three-dimensional bodies.
    Spatial(SpatialScene),
}

impl Scenario {
    /// Replaces an outdated title by a title that is generated from the bodies and the motion. A title that the user
    /// wrote is kept, and the changes are appended to it.
    pub(crate) fn retitle(&mut self) {
        self.title = title::of(self);
    }

    /// Returns the stack; `None` for a free scene.
    pub fn stack(&self) -> Option<&StackSpec> {
        match &self.scene {
            Scene::Stack { stack, .. } => Some(stack),
            Scene::Free(_) | Scene::Spatial(_) => None,
        }
    }

    /// Returns `true` if the model is three-dimensional, for a stack or a free scene.
    pub fn is_spatial(&self) -> bool {
        match &self.scene {
            Scene::Stack { stack, .. } => stack.space.is_some(),
            Scene::Free(_) => false,
            Scene::Spatial(_) => true,
        }
    }

    /// Returns the place at which one of the given fields was written; `None` if none of them was written.
    ///
    /// Overrides take precedence over the file itself, and the file over the files that it extends. Among fields of
    /// equal precedence, the first one in `fields` applies.
    pub fn place_of(&self, fields: &[String]) -> Option<Place> {
        let (sources, table) = self.written.source.as_deref()?;
        let origin =
            |field: &String| merge::origin_at(table, &field.split('.').collect::<Vec<_>>());
        let rank = |origin: &tree::Origin| match origin {
            tree::Origin::Override(_) => 0,
            tree::Origin::File { file: 0, .. } => 1,
            tree::Origin::File { .. } => 2,
            tree::Origin::Whole(_) | tree::Origin::Default => 3,
        };
        let found = fields.iter().filter_map(origin).filter(|origin| rank(origin) < 3);
        found.min_by_key(rank).map(|origin| sources.place(origin))
    }

    /// Returns warnings about the text of the scenario, for example about the use of a former key.
    pub fn warnings(&self) -> &[String] {
        &self.written.warnings
    }

    /// Returns the random differences from stack to stack; `None` for a free scene.
    pub fn imperfections(&self) -> Option<&Imperfections> {
        match &self.scene {
            Scene::Stack { imperfections, .. } => Some(imperfections),
            Scene::Free(_) | Scene::Spatial(_) => None,
        }
    }

    /// Returns the uncertain constants that a whole stack shares; `None` for a free scene.
    pub fn unknowns(&self) -> Option<&Unknowns> {
        match &self.scene {
            Scene::Stack { unknowns, .. } => Some(unknowns),
            Scene::Free(_) | Scene::Spatial(_) => None,
        }
    }

    /// Returns a quantity with its unit as the user wrote it, for the setting at `path`; `None` if the quantity was not
    /// written as a string.
    pub fn as_written(&self, path: &str) -> Option<&str> {
        if let tree::Value::Text(text) = &self.node(path)?.value { Some(text) } else { None }
    }

    /// Returns the scenario as a table with all defaults, for a file that contains a scenario among other tables.
    pub fn to_table(&self) -> tree::Table {
        root::write(self)
    }

    /// Returns the scenario as TOML text that yields an equal scenario when read, with all defaults written out and all
    /// quantities in SI.
    ///
    /// Paths are unchanged.
    pub fn to_resolved_toml(&self) -> String {
        writer::to_toml(&root::write(self))
    }

    /// Returns the scenario, without title and motion, as the TOML text of a table with the given key, for another file
    /// such as a study.
    ///
    /// In the table, `until` replaces all settings that end a run, because the settings of the scenario were chosen for
    /// its own motion.
    pub fn to_toml_table(&self, key: &str, until: Until) -> String {
        let plain = |key: &str, value| tree::Entry {
            key: key.to_owned(),
            origin: tree::Origin::Default,
            node: tree::Node { origin: tree::Origin::Default, value },
        };
        let mut ended = self.clone();
        ended.run.until = until;
        let mut own = root::write(&ended);
        own.remove("title");
        own.remove("motion");
        if let Some(tree::Entry {
            node: tree::Node { value: tree::Value::Table(run), .. }, ..
        }) = own.get_mut("run")
        {
            for end in run::ENDS.into_iter().filter(|end| *end != "until") {
                run.remove(end);
            }
        }
        writer::to_toml(&tree::Table { entries: vec![plain(key, tree::Value::Table(own))] })
    }

    /// Returns the fingerprint of the scenario without its title: the 64-bit FNV-1a hash of the resolved text.
    ///
    /// Two scenarios with the same fingerprint describe the same run, however they were written. If the bytes of a
    /// record are in memory ([`Scenario::with_records`]), the hash covers the bytes; otherwise, it covers the path as
    /// written. During a run, the bytes are always in memory.
    pub fn fingerprint(&self) -> u64 {
        let motion = self.motion.by_content();
        let untitled = Self { title: "-".to_owned(), motion, ..self.clone() };
        fnv1a(untitled.to_resolved_toml().as_bytes())
    }

    /// Returns all values except the title, defaults included, in the order of the resolved text.
    ///
    /// List items are identified as in overrides: by name or by the pair of kinds that they join, otherwise by number
    /// from 1.
    pub fn settings(&self) -> Vec<Setting> {
        let mut settings = barrelstack_input::listing::settings(&root::write(self), &ROOT);
        settings.retain(|setting| !["title", "schema"].contains(&setting.path.as_str()));
        for setting in &mut settings {
            // For a value with a derived default, only the file shows whether it was given.
            if matches!(setting.source, Source::Derived(_)) && self.node(&setting.path).is_some() {
                setting.source = Source::Given;
            }
        }
        settings
    }

    /// Returns the node that was written at the path of a setting; `None` if no node was written there.
    fn node(&self, path: &str) -> Option<&tree::Node> {
        let (_, table) = self.written.source.as_deref()?;
        let keys: Vec<&str> = path.split('.').collect();
        merge::node_at(table, &keys)
    }
}
