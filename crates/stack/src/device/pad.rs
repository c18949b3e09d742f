//! Elastomer pads in the cradles. The pads are softer than the contact of wood on steel, and have more damping and
//! friction.

use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Kind, Range};
use barrelstack_input::reader::Reader;
use barrelstack_input::{Dimension, InputError, section};

use super::{Cost, Each, Setting, Words};
use crate::assemble::Builder;
use crate::scenario::{Basis, Damping, Friction, Interface, NormalLaw};

pub(super) static WORDS: Words = Words {
    candidates: &[Setting {
        name: "rubber pads in all cradles",
        overrides: &["stack.pad.stiffness=\"500 kN/m\""],
    }],
    degraded: &[Setting {
        name: "worn pads",
        overrides: &[
            "stack.pad.stiffness=\"1500 kN/m\"",
            "stack.pad.damping=\"2.5 kN s/m\"",
            "stack.pad.friction=0.3",
        ],
    }],
    // Pads and seats get the same stiffness, damping and friction, so that the pads have no effect.
    idle: &[
        "interface.barrel-rack.law=kelvin-voigt",
        "interface.barrel-rack.basis=seat",
        "interface.barrel-rack.stiffness=\"980 kN/m\"",
        "interface.barrel-rack.damping=\"5 kN s/m\"",
        "interface.barrel-rack.friction.coefficient=0.3",
        "interface.barrel-rack.friction.tangential_stiffness_ratio=1",
        "stack.pad.stiffness=\"980 kN/m\"",
        "stack.pad.friction=0.3",
    ],
    cost: Cost {
        dollars: [20.0, 60.0],
        each: Each::Level,
        source: "eight rubber pads 1 cm thick: an assumption",
    },
    many: "pads",
    ..Words::silent("pad")
};

section! {
    /// Pads between barrels and their cradles.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Pads;
    /// Elastomer pads between all barrels and their cradles. Their contact law replaces `interface.barrel-rack` in the
    /// cradles, but not where racks lie on barrels.
    pub static SECTION = "pad";
    /// Stiffness of the pad at one support of a cradle; if not given, there are no pads.
    stiffness: Option<f64> =
        Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Nothing;
    /// Damping of the pad at one support, which acts in both compression and rebound. The default is an assumed value
    /// for rubber.
    damping: f64 =
        Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE), Default::Value("\"5 kN s/m\"");
    /// Friction coefficient of wood on pads. The default is an assumption.
    friction: f64 = Kind::Number(Range::between(0.0, 2.0)), Default::Value("0.6");
}

/// Reads the table of pads.
pub(super) fn read(reader: Reader<'_>, _levels: u32) -> Result<Pads, InputError> {
    Pads::read(reader)
}

impl Pads {
    /// Returns `true` if the stack has pads.
    pub fn is_on(&self) -> bool {
        self.stiffness.is_some()
    }

    /// Returns the contact law of the pad at one support; `None` if the stack has no pads.
    pub fn law(&self) -> Option<Interface> {
        self.stiffness.map(|stiffness| Interface {
            basis: Basis::Seat,
            normal: NormalLaw::KelvinVoigt {
                stiffness,
                damping: Damping::Coefficient(self.damping),
            },
            friction: Friction::Coulomb {
                coefficient: self.friction,
                static_coefficient: self.friction,
                tangential_stiffness_ratio: 1.0,
                tangential_damping_ratio: 1.0,
            },
        })
    }

    /// Replaces the contact law of the cradles by the contact law of the pads.
    #[expect(clippy::unnecessary_wraps, reason = "common device signature")]
    pub(super) fn place(&self, builder: &mut Builder<'_>) -> Result<(), String> {
        if let Some(law) = self.law() {
            builder.cradle_law = builder.add_cradle("pad", &law);
        }
        Ok(())
    }
}
