//! Protective devices of a stack: one file each, and a line in the list below.
//!
//! A device is a table of `[stack]`, the force elements, bodies and contact laws that it adds to a stack, and its
//! description: words, candidate settings, degraded states, and price.
//! Forces, energy and drawing of the elements are the same for all.

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

/// Declares the devices: a table of `[stack]` with its help, and the type that its file reads it into.
macro_rules! devices {
    ($(#[doc = $help:literal] $name:ident: $type:ty),* $(,)?) => {
        /// The devices on a stack.
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
            /// Reads the devices of a stack with a number of levels.
            pub(crate) fn read(stack: &Reader<'_>, levels: u32) -> Result<Self, InputError> {
                Ok(Self { $($name: $name::read(stack.section(stringify!($name))?, levels)?),* })
            }

            /// Writes the tables of the devices.
            pub(crate) fn write(&self, stack: &mut Writer) {
                $(stack.table(stringify!($name), self.$name.write());)*
            }

            /// Installs them on a stack, one device after the other.
            ///
            /// # Errors
            /// If a device does not fit this stack, with the next move.
            pub(crate) fn place(&self, builder: &mut Builder<'_>) -> Result<(), String> {
                $(self.$name.place(builder)?;)*
                Ok(())
            }

            /// Returns the tables of the devices that are not on the stack.
            pub fn absent(&self) -> Vec<&'static str> {
                let all = [$((stringify!($name), self.$name.is_on())),*];
                all.into_iter().filter(|(_, on)| !on).map(|(name, _)| name).collect()
            }

            /// Returns the descriptions of the devices on the stack.
            pub fn present(&self) -> Vec<&'static Words> {
                let all = [$((&$name::WORDS, self.$name.is_on())),*];
                all.into_iter().filter(|(_, on)| *on).map(|(words, _)| words).collect()
            }
        }
    };
}

devices! {
    /// Straps on the highest levels.
    strap: Straps,
    /// Stops that keep racks from walking on the barrels below.
    walking_stop: WalkingStops,
    /// Chocks beside the barrels, against rolling out.
    chock: Chocks,
    /// Lids over the barrels of the highest levels.
    lid: Lids,
    /// Elastomer pads in the cradles.
    pad: Pads,
    /// Isolators under the bottom racks.
    isolator: Isolators,
    /// Ties of racks to a wall, to the ceiling, or to their neighbors.
    tie: AnchorTies,
    /// Masses on springs.
    tuned_mass: TunedMass,
}

/// Description of the force elements of a free scene, which belong to no device of a stack.
pub static FREE: Words = Words { many: "elements", ..Words::silent("element") };

/// Display strings, candidate settings and cost of a device.
#[derive(Debug, PartialEq)]
pub struct Words {
    /// Singular of its elements.
    pub one: &'static str,
    /// Plural; with underscores also the key in the summary.
    pub many: &'static str,
    /// Name of the force in one.
    pub force: &'static str,
    /// Verb for the failure of one, ...
    pub breaks: &'static str,
    /// ... of several, ...
    pub break_all: &'static str,
    /// ... and the state after it.
    pub broken: &'static str,
    /// Settings worth trying on any stack of at least three levels.
    pub candidates: &'static [Setting],
    /// Degraded states in use, to be put [over](Setting::over) a candidate.
    pub degraded: &'static [Setting],
    /// Settings to be put [over](Setting::over) a candidate, with which it has no effect: out of reach, as slack or
    /// as weak as can be. Such a stack equals the one without it, to the last bit, at the same time step and division of it
    /// in impacts.
    pub idle: &'static [&'static str],
    /// Cost of the device.
    pub cost: Cost,
}

/// A setting of a device, in words and as overrides of the scenario.
#[derive(Debug, PartialEq, Eq)]
pub struct Setting {
    /// In words.
    pub name: &'static str,
    /// Such as `stack.strap.levels=3`.
    pub overrides: &'static [&'static str],
}

impl Setting {
    /// Returns the words and the overrides as owned strings.
    pub fn to_candidate(&self) -> (String, Vec<String>) {
        let overrides = self.overrides.iter().map(|change| (*change).to_owned());
        (self.name.to_owned(), overrides.collect())
    }

    /// Returns these settings in place of those of another one for the same fields, and the rest of its settings.
    pub fn over(&self, other: &Self) -> Vec<&'static str> {
        let field = |setting: &&'static str| setting.split('=').next();
        let own: Vec<_> = self.overrides.iter().map(field).collect();
        let kept = other.overrides.iter().filter(|setting| !own.contains(&field(setting)));
        kept.chain(self.overrides).copied().collect()
    }
}

/// Cost of a device, bought and installed.
#[derive(Debug, PartialEq)]
pub struct Cost {
    /// Lower and upper bound (US$ of 2024) ...
    pub dollars: [f64; 2],
    /// ... for each of these.
    pub each: Each,
    /// Source of the figures.
    pub source: &'static str,
}

/// Unit of a price.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Each {
    /// A stack.
    Stack,
    /// A level of a stack that has the device.
    Level,
}

impl Words {
    /// Returns candidate settings for a stack with a number of levels, each in words and as overrides of the
    /// scenario.
    ///
    /// The scenario checks if one fits the stack.
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

/// A number of the highest levels; 0 for none.
const LEVELS: Kind = Kind::Integer(0, 12);

/// Returns the lowest level that has a device, which is on the `highest` levels of a number of levels.
pub fn lowest(highest: u32, levels: u32) -> u32 {
    levels.saturating_sub(highest) + 1
}

/// Refuses a device on more levels than a stack has.
fn check_levels(reader: &Reader<'_>, device: u32, stack: u32) -> Result<(), InputError> {
    if device <= stack {
        return Ok(());
    }
    let path = reader.path_of("levels");
    let message = format!("`{path}` is {device}, but the stack has only {stack}");
    Err(reader.inconsistent("levels", message))
}

/// A force element that is not tightened yet.
#[derive(Clone, Debug)]
pub(crate) struct Loose {
    /// The element as drawn, before the stack settles.
    pub(crate) element: Element<Planar>,
    /// Excess (m) of its length over the distance of its ends; negative under pretension.
    give: f64,
    words: &'static Words,
}

impl Assembly {
    /// Installs the devices and tightens them on the stack as it stands in `state`.
    ///
    /// # Errors
    /// If an element that was valid as drawn is invalid on the settled stack.
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
