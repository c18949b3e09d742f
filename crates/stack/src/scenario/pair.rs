//! Pairs of kinds of bodies that can touch in a stack. Each pair is declared once, with its contact law.

use super::catalog::{Seat, Seats};
use super::error::ScenarioError;
use super::field::{Default, Field, Kind, Section};
use super::interface::{self, IMPACT, INTERFACE, Interface, PairDefaults};
use super::reader::Reader;
use super::tree::Table;
use super::writer::Writer;

/// Impact stiffness (N/m^1.5) of pairs that include a barrel, and of seats at the end of their stroke.
///
/// With this stiffness, a full barrel of 270 kg that falls from the top of six levels (9.3 m/s) is stopped within
/// 15 mm. The value is an assumption, since no measurement is known. In earthquakes, barrels in cellars visibly
/// bounced, burst and lost their bungs.
const HEAVY: f64 = 1.2e9;

/// Impact stiffness (N/m^1.5) between two racks, and between a fallen rack and the ground.
///
/// With this stiffness, an empty rack that falls from the top of six levels is stopped within 10 mm. If a barrel lands
/// on a rack, several contacts of the rack share the load.
const LIGHT: f64 = 5e8;

/// Declares the pairs. Each entry has the enum variant, the struct field and the name in scenario files before `=`.
/// After `=`, it has the definition of the table of the contact law, the impact stiffness, the default friction
/// coefficient, and the source of that coefficient.
macro_rules! pairs {
    ($(
        $(#[doc = $help:literal])+
        $pair:ident $field:ident $name:literal = $table:ident, $impact:ident, $coefficient:literal, $source:literal;
    )*) => {
        /// Two kinds of bodies that touch in a stack.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum StackPair {
            $($(#[doc = $help])+ $pair),*
        }

        impl StackPair {
            /// All pairs, in the order of their discriminants.
            pub const ALL: &[Self] = &[$(Self::$pair),*];

            /// Returns the name of the pair in scenario files.
            pub fn name(self) -> &'static str {
                match self { $(Self::$pair => $name),* }
            }

            /// Returns the default friction coefficient of the pair.
            pub fn coefficient(self) -> f64 {
                match self { $(Self::$pair => $coefficient),* }
            }

            /// Returns the source of the default friction coefficient of the pair.
            pub fn source(self) -> &'static str {
                match self { $(Self::$pair => $source),* }
            }

            fn table(self) -> &'static Section {
                match self { $(Self::$pair => &$table),* }
            }

            fn defaults(self, seats: &Seats) -> PairDefaults {
                let rebound_stiffness = match self { $(Self::$pair => $impact),* };
                let coefficient = self.coefficient();
                PairDefaults { seat: self.seat(seats), rebound_stiffness, coefficient }
            }
        }

        /// The contact law of each pair of a stack.
        #[derive(Debug, Clone, PartialEq)]
        pub struct StackInterfaces {
            $($(#[doc = $help])+ pub $field: Interface),*
        }

        impl StackInterfaces {
            /// Returns the contact law of a pair.
            pub fn of(&self, pair: StackPair) -> &Interface {
                match pair { $(StackPair::$pair => &self.$field),* }
            }
        }

        /// Definition of the table of the contact laws of a stack.
        pub static INTERFACES: Section = Section {
            name: "interfaces",
            help: "Contact laws of a stack, by pair. A stack stands on its seats: `rack-ground`, `barrel-rack` and, \
                   for racks on posts, `rack-rack`; state measured constants there. The other pairs touch only in \
                   impacts, most of them after a body has left its seat.",
            fields: &[$(Field::new(
                $name,
                Kind::Table(&$table),
                Default::Nothing,
                concat!($($help),+).trim_ascii(),
            )),*],
            variants: None,
            exclusive: &[],
        };

        /// Reads the contact laws of a stack, with the constants of the seats of its racks as defaults.
        pub(super) fn read_interfaces(
            reader: Reader<'_>,
            seats: &Seats,
        ) -> Result<StackInterfaces, ScenarioError> {
            let read = |pair: StackPair| {
                interface::read(reader.section(pair.name())?, Some(pair.defaults(seats)))
            };
            let interfaces = StackInterfaces { $($field: read(StackPair::$pair)?),* };
            reader.finish();
            Ok(interfaces)
        }
    };
}

pairs! {
    /// Seat: rack of the lowest level on the ground.
    RackGround rack_ground "rack-ground" = INTERFACE, HEAVY, 0.5,
        "benchmark of Candia, de la Llera and Almazán (2008); between the 0.4 used in design and the 0.57 to 0.65 \
         found in tests of steel on concrete";
    /// Seat: barrel in its cradle, and barrel under the rack above.
    BarrelRack barrel_rack "barrel-rack" = INTERFACE, HEAVY, 0.3,
        "between the 0.22 to which Candia, de la Llera and Almazán (2008) calibrated one test and the 0.37 to 0.45 \
         found for wood pallets on steel; wood on steel ranges from 0.1 to 0.6 with moisture and finish";
    /// Seat: rack that stands on the posts of the rack below. Racks that stand on barrels do not use it.
    RackRack rack_rack "rack-rack" = INTERFACE, HEAVY, 0.3, "steel on steel, assumption";
    /// Impact: barrel against barrel.
    BarrelBarrel barrel_barrel "barrel-barrel" = IMPACT, HEAVY, 0.4, "wood on wood, assumption";
    /// Impact: barrel that has fallen to the ground.
    BarrelGround barrel_ground "barrel-ground" = IMPACT, HEAVY, 0.4, "wood on concrete, assumption";
    /// Impact: barrel against a rack while it has no seat there, because it has left its seat or the rack is a
    /// neighbor. State the friction here as well if you state that of `barrel-rack`; one does not follow the other.
    FallenBarrelRack fallen_barrel_rack "fallen-barrel-rack" = IMPACT, HEAVY, 0.3,
        "the same as for a barrel on a rack";
    /// Impact: rack of an upper level that has fallen to the ground. The lowest rack has the pair `rack-ground`.
    FallenRackGround fallen_rack_ground "fallen-rack-ground" = IMPACT, LIGHT, 0.5,
        "the same as for a rack on the ground";
    /// Impact: rack against a rack on whose posts it does not stand.
    FallenRackRack fallen_rack_rack "fallen-rack-rack" = IMPACT, LIGHT, 0.3,
        "steel on steel, assumption";
}

impl StackPair {
    /// Returns the constants of the seat that the pair forms; `None` for a pair that touches in impacts only.
    fn seat(self, seats: &Seats) -> Option<Seat> {
        match self {
            Self::RackGround => Some(seats.floor),
            Self::BarrelRack => Some(seats.barrel),
            Self::RackRack => Some(seats.post),
            Self::BarrelBarrel
            | Self::BarrelGround
            | Self::FallenBarrelRack
            | Self::FallenRackGround
            | Self::FallenRackRack => None,
        }
    }
}

/// Writes the contact laws.
pub(super) fn write_interfaces(interfaces: &StackInterfaces) -> Table {
    let mut writer = Writer::new(&INTERFACES);
    for pair in StackPair::ALL {
        writer.table(pair.name(), interface::write(pair.table(), interfaces.of(*pair)));
    }
    writer.finish()
}
