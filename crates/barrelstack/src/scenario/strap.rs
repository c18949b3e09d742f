//! Straps that hold the top of a stack.

use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Field, Kind, Named, Range, Section, names};
use super::reader::Reader;
use super::tree::Table;
use super::writer::Writer;

/// What straps tie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ties {
    /// Every barrel to its own rack, down both of its sides.
    BarrelsToRacks,
    /// The same, and every rack to the rack below it, so that the levels become one block.
    LevelsTogether,
}

/// Straps on the highest levels of a stack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Straps {
    /// How many of the highest levels are strapped; none with 0.
    pub levels: u32,
    /// What they tie.
    pub ties: Ties,
    /// Force per elongation of one strap (N/m).
    pub stiffness: f64,
    /// Force per rate of elongation of one strap (N·s/m).
    pub damping: f64,
    /// How far one strap gives at rest before it pulls (m).
    pub slack: f64,
    /// Force in one strap as it is put on (N).
    pub pretension: f64,
    /// Force above which one strap tears (N); none if it never does.
    pub strength: Option<f64>,
}

impl Named for Ties {
    const NAMES: &'static [(&'static str, Self)] =
        &[("barrels-to-racks", Self::BarrelsToRacks), ("levels-together", Self::LevelsTogether)];
}

/// Straps.
pub static STRAP: Section = Section {
    name: "strap",
    help: "Straps on the highest levels: they pull, never push, and have no mass.",
    fields: &[
        Field::new(
            "levels",
            Kind::Integer(0, 12),
            Default::Value("0"),
            "How many of the highest levels are strapped; 0 for no straps.",
        ),
        Field::new(
            "ties",
            Kind::Choice(names::<Ties>),
            Default::Value("\"barrels-to-racks\""),
            "Every barrel to its rack, or besides every rack to the one below.",
        ),
        Field::new(
            "stiffness",
            Kind::Quantity(&[Dimension::STIFFNESS], Range::POSITIVE),
            Default::Value("\"100 kN/m\""),
            "Force per elongation of one strap; that of a polyester strap is its strength over some \
             5 to 7 % of its length.",
        ),
        Field::new(
            "damping",
            Kind::Quantity(&[Dimension::DAMPING], Range::NOT_NEGATIVE),
            Default::Value("\"0 N s/m\""),
            "Force per rate of elongation of one strap, while it is taut.",
        ),
        Field::new(
            "slack",
            Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 1.0)),
            Default::Value("\"0 m\""),
            "How far one strap gives, on the stack at rest, before it pulls.",
        ),
        Field::new(
            "pretension",
            Kind::Quantity(&[Dimension::FORCE], Range::NOT_NEGATIVE),
            Default::Value("\"0 N\""),
            "Force in one strap as it is put on; the stack gives under it, and a part of it is lost.",
        ),
        Field::new(
            "strength",
            Kind::Quantity(&[Dimension::FORCE], Range::POSITIVE),
            Default::Nothing,
            "Force above which one strap tears, for good; without it none does.",
        ),
    ],
    variants: None,
    exclusive: &[],
};

/// Reads straps on a stack of a number of levels.
pub(super) fn read(reader: Reader<'_>, levels: u32) -> Result<Straps, ScenarioError> {
    let straps = Straps {
        levels: reader.integer("levels")?,
        ties: reader.choice("ties")?,
        stiffness: reader.quantity("stiffness")?,
        damping: reader.quantity("damping")?,
        slack: reader.quantity("slack")?,
        pretension: reader.quantity("pretension")?,
        strength: reader.optional_quantity("strength")?,
    };
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

/// Writes straps.
pub(super) fn write(straps: &Straps) -> Table {
    let mut writer = Writer::new(&STRAP);
    writer.integer("levels", straps.levels);
    writer.choice("ties", straps.ties);
    writer.quantity("stiffness", straps.stiffness);
    writer.quantity("damping", straps.damping);
    writer.quantity("slack", straps.slack);
    writer.quantity("pretension", straps.pretension);
    writer.optional_quantity("strength", straps.strength);
    writer.finish()
}
