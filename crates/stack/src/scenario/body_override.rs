//! Overrides of individual bodies of a stack.

use barrelstack_input::declared::Declared as _;
use barrelstack_input::{named, section};

use super::barrel::Fill;
use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Kind, Named, Range, names};
use super::reader::Reader;
use super::stack::{COLUMNS, LEVELS, StackSpec};
use super::tree::Table;

named! {
    /// Kind of body that an override changes.
    pub enum StackBody {
        /// A barrel; `column` is its number among the barrels of its level, from the left.
        Barrel = "barrel",
        /// A rack; `column` is its number among the racks of its level, from the left.
        Rack = "rack",
    }
}

section! {
    /// Properties in which one body of a stack differs from the others.
    ///
    /// All numbers are in SI units.
    #[derive(Debug, Clone, PartialEq)]
    pub struct BodyOverride;
    /// A body of the stack that differs from the others.
    pub static OVERRIDE = "override";
    /// Kind of body.
    body as "kind": StackBody = Kind::Choice(names::<StackBody>), Default::Value("\"barrel\"");
    /// Level, 1 at the bottom.
    level: u32 = LEVELS, Default::Required;
    /// Number of the column; 1 is at the left of a stack that is not mirrored. The columns of racks and those of
    /// barrels are numbered separately. If the model is in both planes or in three dimensions, columns are counted
    /// across the barrels.
    column: Option<u32> = COLUMNS, Default::Derived("every column of the level");
    /// Number of the row along the barrels in a three-dimensional model; 1 is nearest to the viewer. The rows of racks
    /// and those of barrels are numbered separately.
    row: Option<u32> = COLUMNS, Default::Derived("every row");
    /// Mass of this body; it replaces the mass that applies to other bodies of its kind.
    mass: Option<f64> = Kind::Quantity(&[Dimension::MASS], Range::up_to(1e5)), Default::Nothing;
    /// Contents of this barrel, which replace the contents that apply to other barrels.
    fill: Option<Fill> = Kind::Choice(names::<Fill>), Default::Nothing;
    /// Displacement of the body from its regular position, positive to the right in a stack that is not mirrored.
    offset_x: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(-1.0, 1.0)), Default::Value("\"0 m\"");
    /// Displacement of the body from its regular position along the barrels, positive away from the viewer; in three
    /// dimensions only.
    offset_y: f64 =
        Kind::Quantity(&[Dimension::LENGTH], Range::between(-1.0, 1.0)), Default::Value("\"0 m\"");
}

/// Reads an override.
pub(super) fn read(reader: Reader<'_>, stack: &StackSpec) -> Result<BodyOverride, ScenarioError> {
    let change = BodyOverride::read_fields(&reader)?;
    let BodyOverride { body, level, column, row, mass, fill, offset_y, .. } = change;
    let only_in_space = [("row", row.is_some()), ("offset_y", offset_y != 0.0)];
    if let Some((name, _)) = only_in_space.iter().find(|(_, given)| *given && stack.space.is_none())
    {
        let message = format!(
            "`{}` applies only with `stack.view = \"spatial\"`; leave it out, because a planar model has only one row \
             and no displacement out of the plane",
            reader.path_of(name)
        );
        return Err(reader.inconsistent(name, message));
    }
    let rows = match body {
        StackBody::Barrel => stack.space.map_or(1, |space| space.columns_along),
        StackBody::Rack => stack.racks_along(),
    };
    let columns = match body {
        StackBody::Barrel => stack.columns,
        StackBody::Rack => stack.racks_per_level(),
    };
    for (name, given, most) in
        [("level", Some(level), stack.levels), ("column", column, columns), ("row", row, rows)]
    {
        if let Some(given) = given
            && given > most
        {
            let message = format!(
                "`{}` is {given}, but the stack has only {most} {name}{} of {}s; lower it",
                reader.path_of(name),
                if most == 1 { "" } else { "s" },
                body.name()
            );
            return Err(reader.inconsistent(name, message));
        }
    }
    if body == StackBody::Rack && fill.is_some() {
        let message = format!(
            "`{}` applies only to barrels; leave it out for a rack",
            reader.path_of("fill")
        );
        return Err(reader.inconsistent("fill", message));
    }
    if let Some(mass) = mass
        && body == StackBody::Barrel
        && mass < stack.barrel.empty_mass
    {
        let message = format!(
            "`{}` is {mass} kg, less than the {} kg of the empty barrel; give the mass of wood and wine together",
            reader.path_of("mass"),
            stack.barrel.empty_mass
        );
        return Err(reader.inconsistent("mass", message));
    }
    reader.finish();
    Ok(change)
}

/// Writes an override.
pub(super) fn write(body: &BodyOverride) -> Table {
    let mut table = body.write();
    // The default is omitted, so that a planar scenario keeps its text and hash.
    if body.offset_y == 0.0 {
        table.remove("offset_y");
    }
    table
}
