//! Straps that hold the top of a stack.

use barrelstack_input::declared::Declared as _;
use barrelstack_input::section;

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Kind, Named, Range, names};
use super::reader::Reader;

/// What straps tie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ties {
    /// Every barrel to its own rack, down both of its sides.
    BarrelsToRacks,
    /// The same, and every rack to the rack below it, so that the levels become one block.
    LevelsTogether,
}

impl Named for Ties {
    const NAMES: &'static [(&'static str, Self)] =
        &[("barrels-to-racks", Self::BarrelsToRacks), ("levels-together", Self::LevelsTogether)];
}

section! {
    /// Straps on the highest levels of a stack.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Straps;
    /// Straps on the highest levels: they pull, never push, and have no mass.
    pub static STRAP = "strap";
    /// How many of the highest levels are strapped; 0 for no straps.
    levels: u32 = Kind::Integer(0, 12), Default::Value("0");
    /// Every barrel to its rack, or besides every rack to the one below.
    ties: Ties = Kind::Choice(names::<Ties>), Default::Value("\"barrels-to-racks\"");
    /// Force per elongation of one strap; that of a polyester strap is its strength over some 5 to 7 % of its length.
    stiffness: f64 =
        Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE), Default::Value("\"100 kN/m\"");
    /// Force per rate of elongation of one strap, while it is taut.
    damping: f64 =
        Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE), Default::Value("\"0 N s/m\"");
    /// How far one strap gives, on the stack at rest, before it pulls.
    slack: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 1.0)), Default::Value("\"0 m\"");
    /// Force in one strap as it is put on; the stack gives under it, and a part of it is lost.
    pretension: f64 =
        Kind::Quantity(&[Dimension::FORCE], Range::NOT_NEGATIVE), Default::Value("\"0 N\"");
    /// Force above which one strap tears, for good; without it none does.
    strength: Option<f64> =
        Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE), Default::Nothing;
}

/// Reads straps on a stack of a number of levels.
pub(super) fn read(reader: Reader<'_>, levels: u32) -> Result<Straps, ScenarioError> {
    let straps = Straps::read_fields(&reader)?;
    if straps.slack > 0.0 && straps.pretension > 0.0 {
        let message = "a strap with pretension has no slack; leave one of the two out".to_owned();
        return Err(reader.inconsistent("pretension", message));
    }
    if let Some(strength) = straps.strength.filter(|strength| *strength <= straps.pretension) {
        let message = format!(
            "`{}` of {} N is not below the strength of {strength} N",
            reader.path_of("pretension"),
            straps.pretension
        );
        return Err(reader.inconsistent("pretension", message));
    }
    let refused = |message: String| Err(reader.inconsistent("levels", message));
    let path = reader.path_of("levels");
    if straps.levels > levels {
        return refused(format!("`{path}` is {}, but the stack has only {levels}", straps.levels));
    }
    if straps.levels == 1 && straps.ties == Ties::LevelsTogether {
        return refused(format!(
            "`{path}` is 1, but \"levels-together\" ties at least 2; take 2, or \"barrels-to-racks\""
        ));
    }
    reader.finish();
    Ok(straps)
}
