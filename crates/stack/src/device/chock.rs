//! Chocks beside the barrels, higher than the cradle, that keep the barrels from rolling out.
//!
//! A barrel that leans on a support at an angle φ from the vertical through its center rolls over the support at a
//! lateral acceleration above g tan φ. For a barrel with mass m and radius r, the energy barrier is m g r (1 − cos φ).

use barrelstack_input::declared::Declared as _;
use barrelstack_input::field::{Default, Kind, Range};
use barrelstack_input::reader::Reader;
use barrelstack_input::{Dimension, InputError, section};

use super::{Cost, Each, LEVELS, Setting, Words, check_levels};
use crate::assemble::Builder;

pub(super) static WORDS: Words = Words {
    candidates: &[
        Setting { name: "chocks in the top level", overrides: &["stack.chock.levels=1"] },
        Setting { name: "chocks in the top three levels", overrides: &["stack.chock.levels=3"] },
    ],
    degraded: &[Setting {
        name: "chocks knocked aside",
        overrides: &["stack.chock.gap=\"4 cm\"", "stack.chock.angle=\"45 deg\""],
    }],
    idle: &["stack.chock.levels=3", "stack.chock.gap=\"4 cm\""],
    cost: Cost {
        dollars: [15.0, 60.0],
        each: Each::Level,
        source: "four hardwood wedges, or horns welded to a rack: an assumption",
    },
    many: "chocks",
    ..Words::silent("chock")
};

section! {
    /// Chocks beside the barrels.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Chocks;
    /// Chocks on the racks at both sides of every barrel, higher than the cradle; they have no effect along the
    /// barrels.
    pub static SECTION = "chock";
    /// Number of levels with chocks, counted from the top; 0 for none.
    levels: u32 = LEVELS, Default::Value("0");
    /// Angle between the vertical and the line from the center of the barrel to the top of the chock. The default is an
    /// assumption.
    angle: f64 =
        Kind::Quantity(&[Dimension::ANGLE], Range::between(0.1, 1.4)), Default::Value("\"55 deg\"");
    /// Clearance between a chock and its barrel. The default is an assumption.
    gap: f64 = Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 0.2)), Default::Value("\"5 mm\"");
}

/// Reads the table of chocks.
pub(super) fn read(reader: Reader<'_>, levels: u32) -> Result<Chocks, InputError> {
    let chocks = Chocks::read_fields(&reader)?;
    check_levels(&reader, chocks.levels, levels)?;
    reader.finish();
    Ok(chocks)
}

impl Chocks {
    /// Returns `true` if the stack has chocks.
    pub fn is_on(&self) -> bool {
        self.levels > 0
    }

    /// Returns `true` if a level of a stack with `levels` levels has chocks.
    pub fn at(&self, level: u32, levels: u32) -> bool {
        level + self.levels > levels
    }

    /// Does nothing, because chocks are solids of the racks.
    #[expect(clippy::unnecessary_wraps, clippy::unused_self, reason = "common device signature")]
    pub(super) fn place(&self, _: &mut Builder<'_>) -> Result<(), String> {
        Ok(())
    }
}
