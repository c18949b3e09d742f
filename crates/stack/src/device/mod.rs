//! Protective devices of a stack. Each device has a file of its own and a line in the list below.
//!
//! The table of a device in `[stack]` holds its settings. The device adds force elements, bodies or contact laws to the
//! stack. Its description ([`Words`]) contains display strings, candidate settings, degraded states, and cost.
//! Forces, energies and drawings of the elements are handled alike for all devices.

mod chock;
mod isolator;
mod lid;
mod pad;
mod strap;
mod tie;
mod tuned_mass;
mod walking_stop;

use barrelstack_dynamics::{Element, Memory, ModelError, Planar, State};
use barrelstack_input::InputError;
use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Field, Kind};
use barrelstack_input::reader::Reader;
use barrelstack_input::writer::Writer;

use crate::assemble::{Assembly, Builder};

pub use chock::Chocks;
pub use isolator::{Isolators, Path};
pub use lid::Lids;
pub use pad::Pads;
pub use strap::{Straps, Ties};
pub use tie::{Anchor, AnchorTies, Side};
pub use tuned_mass::{TunedMass, Tuning};
pub use walking_stop::{Holds, WalkingStops};

/// Declares the devices: for each, its table in `[stack]` with the help text, and the type that holds the table.
macro_rules! devices {
    ($(#[doc = $help:literal] $name:ident: $type:ty),* $(,)?) => {
        /// Settings of all devices of a stack, including devices that the stack does not have.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Devices {
            $(#[doc = $help] pub $name: $type),*
        }

        /// Descriptions of all devices.
        pub static DEVICES: &[&Words] = &[$(&$name::WORDS),*];

        /// The tables of the devices, as fields of the stack.
        pub(crate) const FIELDS: [Field; DEVICES.len()] = [$(Field::new(
            stringify!($name),
            Kind::Table(&$name::SECTION),
            Default::Nothing,
            $help.trim_ascii(),
        )),*];

        $(impl $type {
            /// Description of the device.
            pub const WORDS: &'static Words = &$name::WORDS;
        })*

        impl Devices {
            /// Reads the tables of the devices of a stack with `levels` levels.
            pub(crate) fn read(stack: &Reader<'_>, levels: u32) -> Result<Self, InputError> {
                Ok(Self { $($name: $name::read(stack.section(stringify!($name))?, levels)?),* })
            }

            /// Writes the tables of the devices.
            pub(crate) fn write(&self, stack: &mut Writer) {
                $(stack.table(stringify!($name), self.$name.write());)*
            }

            /// Installs the devices on a stack, one after the other.
            ///
            /// # Errors
            /// If a device does not fit the stack; the message says what to change.
            pub(crate) fn place(&self, builder: &mut Builder<'_>) -> Result<(), String> {
                $(self.$name.place(builder)?;)*
                Ok(())
            }

            /// Returns the table names of all devices that the stack does not have.
            pub fn absent(&self) -> Vec<&'static str> {
                let all = [$((stringify!($name), self.$name.is_on())),*];
                all.into_iter().filter(|(_, on)| !on).map(|(name, _)| name).collect()
            }

            /// Returns the descriptions of the devices that the stack has.
            pub fn present(&self) -> Vec<&'static Words> {
                let all = [$((&$name::WORDS, self.$name.is_on())),*];
                all.into_iter().filter(|(_, on)| *on).map(|(words, _)| words).collect()
            }
        }
    };
}

devices! {
    /// Straps on the top levels.
    strap: Straps,
    /// Stops that keep racks from walking on the barrels below.
    walking_stop: WalkingStops,
    /// Chocks beside the barrels that keep them from rolling out.
    chock: Chocks,
    /// Lids over the barrels of the top levels.
    lid: Lids,
    /// Elastomer pads in the cradles.
    pad: Pads,
    /// Isolators under the bottom racks.
    isolator: Isolators,
    /// Ties of racks to a wall, to the ceiling, or to their neighbors.
    tie: AnchorTies,
    /// Masses on springs and dampers on the racks of one level.
    tuned_mass: TunedMass,
}

/// Description of the force elements of a free scene, which belong to no device of a stack.
pub static FREE: Words = Words { many: "elements", ..Words::silent("element") };

/// Display strings, candidate settings and cost of a device.
#[derive(Debug, PartialEq)]
pub struct Words {
    /// Singular noun for the elements of the device.
    pub one: &'static str,
    /// Plural noun for the elements. With spaces replaced by underscores, it is also the key of the list of elements in
    /// the summary of a run.
    pub many: &'static str,
    /// Noun for the force in an element.
    pub force: &'static str,
    /// Verb for the failure of one element, such as "tears".
    pub breaks: &'static str,
    /// Verb for the failure of several elements, such as "tear".
    pub break_all: &'static str,
    /// State of a failed element, such as "torn".
    pub broken: &'static str,
    /// Settings worth trying on any stack of at least three levels.
    pub candidates: &'static [Setting],
    /// Settings that represent a badly maintained or badly fitted device, to be applied [over](Setting::over) a
    /// candidate.
    pub degraded: &'static [Setting],
    /// Overrides, applied [over](Setting::over) a candidate, with which the device has no effect: it is absent, too
    /// slack or too far away to act, or has the contact law of the seats that it replaces.
    ///
    /// The results are then bit-identical to results without the device, if the time step and the number of substeps
    /// during impacts are the same.
    pub idle: &'static [&'static str],
    /// Cost of the device.
    pub cost: Cost,
}

/// A setting of a device: a description, and the overrides of the scenario that apply it.
#[derive(Debug, PartialEq, Eq)]
pub struct Setting {
    /// Description, such as "the top rack tied to the ceiling".
    pub name: &'static str,
    /// Overrides of the scenario, such as `stack.strap.levels=3`.
    pub overrides: &'static [&'static str],
}

impl Setting {
    /// Returns the description and the overrides as owned strings.
    pub fn to_candidate(&self) -> (String, Vec<String>) {
        let overrides = self.overrides.iter().map(|change| (*change).to_owned());
        (self.name.to_owned(), overrides.collect())
    }

    /// Returns the overrides of both settings; where both override a field, only the override of `self` is kept.
    pub fn over(&self, other: &Self) -> Vec<&'static str> {
        let field = |setting: &&'static str| setting.split('=').next();
        let own: Vec<_> = self.overrides.iter().map(field).collect();
        let kept = other.overrides.iter().filter(|setting| !own.contains(&field(setting)));
        kept.chain(self.overrides).copied().collect()
    }
}

/// Cost of buying and installing a device.
#[derive(Debug, PartialEq)]
pub struct Cost {
    /// Lower and upper bounds of the cost (US$ of 2024).
    pub dollars: [f64; 2],
    /// Unit to which the bounds apply: a stack or a level.
    pub each: Each,
    /// Source of the bounds.
    pub source: &'static str,
}

/// Unit to which a cost applies: a stack or a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Each {
    /// The whole stack.
    Stack,
    /// Each level that has the device.
    Level,
}

impl Words {
    /// Returns the candidate settings for a stack with `levels` levels, each as a description and overrides of the
    /// scenario.
    ///
    /// The reader of scenarios checks whether a setting fits the stack.
    pub fn settings(&self, levels: u32) -> Vec<(String, Vec<String>)> {
        let mut all: Vec<_> = self.candidates.iter().map(Setting::to_candidate).collect();
        if self == &strap::WORDS {
            all.extend(strap::about_all(levels));
        }
        all
    }

    /// Creates the description of elements that appear in no report.
    pub(crate) const fn silent(one: &'static str) -> Self {
        Self {
            one,
            many: one,
            force: "force",
            breaks: "breaks",
            break_all: "break",
            broken: "broken",
            candidates: &[],
            degraded: &[],
            idle: &[],
            cost: Cost { dollars: [0.0, 0.0], each: Each::Stack, source: "" },
        }
    }
}

/// Kind of the fields that state a number of levels or the number of a level.
const LEVELS: Kind = Kind::Integer(0, 12);

/// Returns the lowest level that has a device, if the top `highest` levels of a stack with `levels` levels have it.
pub fn lowest(highest: u32, levels: u32) -> u32 {
    levels.saturating_sub(highest) + 1
}

/// Rejects a device on more levels than the stack has.
fn check_levels(reader: &Reader<'_>, device: u32, stack: u32) -> Result<(), InputError> {
    if device <= stack {
        return Ok(());
    }
    let path = reader.path_of("levels");
    let message = format!("`{path}` is {device}, but the stack has only {stack} levels; lower it");
    Err(reader.inconsistent("levels", message))
}

/// A force element of a device that is installed and tightened after the stack has settled.
#[derive(Clone, Debug)]
pub(crate) struct Loose {
    /// The element as it is before the stack settles.
    pub(crate) element: Element<Planar>,
    /// Length (m) of the element minus the distance between its ends; negative under pretension.
    give: f64,
    words: &'static Words,
}

impl Assembly {
    /// Installs the devices and tightens them on the stack as it stands in `state`.
    ///
    /// # Errors
    /// If an element that was valid before the stack settled is invalid on the settled stack.
    pub(crate) fn fasten(&mut self, state: &mut State<Planar>) -> Result<(), ModelError> {
        let loose = std::mem::take(&mut self.loose);
        if loose.is_empty() {
            return Ok(());
        }
        self.devices.extend(loose.iter().map(|loose| loose.words));
        let tighten = |Loose { mut element, give, .. }| {
            element.fit(state, give);
            element
        };
        let mut elements = self.model.elements().to_vec();
        elements.extend(loose.into_iter().map(tighten));
        state.memory = vec![Memory::default(); elements.len()];
        self.model.fasten(elements)
    }
}
