//! Devices that protect a stack: each a file beside this one, and a line in the list below.
//!
//! A device is a table of `[stack]`, the force elements that it puts on a stack, and the words that it is
//! told in. What its elements bear, the energy in them, and how they are drawn is the same for all.

mod strap;

use barrelstack_dynamics::{Body, Element, Memory, ModelError, Planar, State};
use barrelstack_input::InputError;
use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Field, Kind};
use barrelstack_input::reader::Reader;
use barrelstack_input::writer::Writer;

use crate::assemble::{Assembly, Part, Similitude};
use crate::scenario::View;

pub use strap::{Straps, Ties};

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

        impl Devices {
            /// Reads the devices of a stack of a number of levels.
            pub(crate) fn read(stack: &Reader<'_>, levels: u32) -> Result<Self, InputError> {
                Ok(Self { $($name: $name::read(stack.section(stringify!($name))?, levels)?),* })
            }

            /// Writes their tables.
            pub(crate) fn write(&self, stack: &mut Writer) {
                $(stack.table(stringify!($name), self.$name.write());)*
            }

            /// Their elements on a stack, one device after the other.
            ///
            /// # Errors
            /// When a device does not go on this stack, with what to do.
            pub(crate) fn place(&self, site: &Site<'_>) -> Result<Vec<Loose>, String> {
                let mut all = Vec::new();
                $(all.extend(self.$name.place(site)?);)*
                Ok(all)
            }
        }
    };
}

devices! {
    /// Straps on the highest levels.
    strap: Straps,
}

/// The words in which a device is told, in files and reports.
#[derive(Debug, PartialEq, Eq)]
pub struct Words {
    /// One element of it.
    pub one: &'static str,
    /// More than one; also the key in the summary.
    pub many: &'static str,
    /// The force in one.
    pub force: &'static str,
    /// What one does that breaks, ...
    pub breaks: &'static str,
    /// ... what more than one do, ...
    pub break_all: &'static str,
    /// ... and what it is then.
    pub broken: &'static str,
}

/// The stack as drawn, on which devices are put.
#[derive(Clone, Copy)]
pub(crate) struct Site<'a> {
    pub(crate) view: View,
    pub(crate) levels: u32,
    pub(crate) mirror: bool,
    pub(crate) scale: Similitude,
    pub(crate) parts: &'a [Part],
    pub(crate) bodies: &'a [Body<Planar>],
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
        self.devices = loose.iter().map(|loose| loose.words).collect();
        let tighten = |Loose { mut element, give, .. }| {
            element.fit(state, give);
            element
        };
        let elements: Vec<_> = loose.into_iter().map(tighten).collect();
        state.memory = vec![Memory::default(); elements.len()];
        self.model.fasten(elements)
    }
}
