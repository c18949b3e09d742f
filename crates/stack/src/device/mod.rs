//! Devices that protect a stack: each a file beside this one, and a line in the list below.
//!
//! A device is a table of `[stack]`, the force elements, bodies and laws of contact that it puts on a stack, and
//! what is said of it: its words, settings worth trying, what becomes of it in use, and its price.
//! What its elements bear, the energy in them, and how they are drawn is the same for all.

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

/// Declares the devices: a table of `[stack]`, with its help, and the type that its file reads it into.
macro_rules! devices {
    ($(#[doc = $help:literal] $name:ident: $type:ty),* $(,)?) => {
        /// The devices on a stack.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Devices {
            $(#[doc = $help] pub $name: $type),*
        }

        /// The words of every device.
        pub static DEVICES: &[&Words] = &[$(&$name::WORDS),*];

        /// The tables of the devices, as fields of the stack.
        pub(crate) const FIELDS: [Field; DEVICES.len()] = [$(Field::new(
            stringify!($name),
            Kind::Table(&$name::SECTION),
            Default::Nothing,
            $help.trim_ascii(),
        )),*];

        $(impl $type {
            /// What is said of them.
            pub const WORDS: &'static Words = &$name::WORDS;
        })*

        impl Devices {
            /// Reads the devices of a stack of a number of levels.
            pub(crate) fn read(stack: &Reader<'_>, levels: u32) -> Result<Self, InputError> {
                Ok(Self { $($name: $name::read(stack.section(stringify!($name))?, levels)?),* })
            }

            /// Writes their tables.
            pub(crate) fn write(&self, stack: &mut Writer) {
                $(stack.table(stringify!($name), self.$name.write());)*
            }

            /// Puts them on a stack, one device after the other.
            ///
            /// # Errors
            /// When a device does not go on this stack, with what to do.
            pub(crate) fn place(&self, builder: &mut Builder<'_>) -> Result<(), String> {
                $(self.$name.place(builder)?;)*
                Ok(())
            }

            /// The tables of those that are not on the stack.
            pub fn absent(&self) -> Vec<&'static str> {
                let all = [$((stringify!($name), self.$name.is_on())),*];
                all.into_iter().filter(|(_, on)| !on).map(|(name, _)| name).collect()
            }

            /// The words of those that are on the stack.
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

/// The words of the force elements of a free scene, which are no device of a stack.
pub static FREE: Words = Words { many: "elements", ..Words::silent("element") };

/// What is said of a device, in files, in reports, and to who looks for the best of them.
#[derive(Debug, PartialEq)]
pub struct Words {
    /// One element of it.
    pub one: &'static str,
    /// More than one; with underscores also the key in the summary.
    pub many: &'static str,
    /// The force in one.
    pub force: &'static str,
    /// What one does that breaks, ...
    pub breaks: &'static str,
    /// ... what more than one do, ...
    pub break_all: &'static str,
    /// ... and what it is then.
    pub broken: &'static str,
    /// Settings worth trying on any stack of at least three levels.
    pub candidates: &'static [Setting],
    /// What becomes of it in use: to be put [over](Setting::over) a candidate.
    pub degraded: &'static [Setting],
    /// Settings to be put [over](Setting::over) a candidate, with which it does nothing: out of reach, as slack or as
    /// weak as can be. Such a stack is the one without it, to the last bit.
    pub idle: &'static [&'static str],
    /// What it costs.
    pub cost: Cost,
}

/// A way to set a device, in words and as settings of the scenario.
#[derive(Debug, PartialEq, Eq)]
pub struct Setting {
    /// In words.
    pub name: &'static str,
    /// Such as `stack.strap.levels=3`.
    pub overrides: &'static [&'static str],
}

impl Setting {
    /// In words and as changes, as others keep them.
    pub fn told(&self) -> (String, Vec<String>) {
        let overrides = self.overrides.iter().map(|change| (*change).to_owned());
        (self.name.to_owned(), overrides.collect())
    }

    /// These settings in place of those of another one for the same fields, and with its others.
    pub fn over(&self, other: &Self) -> Vec<&'static str> {
        let field = |setting: &&'static str| setting.split('=').next();
        let own: Vec<_> = self.overrides.iter().map(field).collect();
        let kept = other.overrides.iter().filter(|setting| !own.contains(&field(setting)));
        kept.chain(self.overrides).copied().collect()
    }
}

/// What a device costs, bought and put on.
#[derive(Debug, PartialEq)]
pub struct Cost {
    /// Least and most (US$ of 2024) ...
    pub dollars: [f64; 2],
    /// ... for each of these.
    pub each: Each,
    /// Where that comes from.
    pub source: &'static str,
}

/// What a price is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Each {
    /// A stack.
    Stack,
    /// A level of a stack that has the device.
    Level,
}

impl Words {
    /// Settings worth trying on a stack of so many levels, each in words and as changes of the scenario.
    ///
    /// Whether one goes on the stack is for the scenario to tell.
    pub fn settings(&self, levels: u32) -> Vec<(String, Vec<String>)> {
        let mut all: Vec<_> = self.candidates.iter().map(Setting::told).collect();
        if self == &strap::WORDS {
            all.extend(strap::about_all(levels));
        }
        all
    }

    /// Of what no report tells.
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

/// The lowest level that has a device, which is on so many of the highest of a number of levels.
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

/// An element that is not tightened yet.
#[derive(Clone, Debug)]
pub(crate) struct Loose {
    /// As the stack is drawn, before it sinks into its contacts.
    pub(crate) element: Element<Planar>,
    /// How much longer (m) it will be than the way between its ends; negative under pretension.
    give: f64,
    words: &'static Words,
}

impl Assembly {
    /// Puts on the devices and tightens them as the stack stands in `state`.
    ///
    /// # Errors
    /// When an element that was sound as drawn is not on the settled stack.
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
