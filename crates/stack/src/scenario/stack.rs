//! A stack of barrels on racks, as stated in a scenario.

use barrelstack_input::{fields, named};

use crate::device::{self, Devices};

use super::barrel::{self, BARREL, Barrel};
use super::body_override::{self, BodyOverride, OVERRIDE, StackBody};
use super::catalog;
use super::dimension::Dimension;
use super::error::ScenarioError;
use super::field::{Default, Field, Kind, Range, Section, names};
use super::pair::StackInterfaces;
use super::quantity::rounded;
use super::rack::{self, RACK, Rack};
use super::reader::Reader;
use super::tree::Table;
use super::writer::Writer;

/// The plane of a planar model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// The plane across the barrels, in which barrels are circles.
    Transverse,
    /// The plane along the barrels, in which barrels show their profile.
    Longitudinal,
}

/// A stack and its contact laws.
#[derive(Debug, Clone, PartialEq)]
pub struct StackSpec {
    /// Plane of the model.
    pub view: View,
    /// Number of levels of barrels.
    pub levels: u32,
    /// Number of barrels per level in this plane.
    pub columns: u32,
    /// Number of barrels per level, counted along the barrels, if both planes are requested; `None` for a single plane.
    ///
    /// If both planes are requested, `view` is the transverse plane.
    pub columns_along: Option<u32>,
    /// Additional properties of a three-dimensional model; `None` if the stack is modeled in a plane.
    ///
    /// In three dimensions, `view` is the transverse plane.
    pub space: Option<InSpace>,
    /// The barrel that is used everywhere unless overridden.
    pub barrel: Barrel,
    /// The rack that is used everywhere unless overridden.
    pub rack: Rack,
    /// `true` if the whole stack is mirrored left to right.
    pub mirror: bool,
    /// Clear distance between racks side by side (m).
    pub gap: f64,
    /// Protective devices.
    pub devices: Devices,
    /// Overrides of individual bodies, in the order of the file.
    pub overrides: Vec<BodyOverride>,
    /// Contact laws.
    pub interfaces: StackInterfaces,
}

impl StackSpec {
    /// Returns the number of barrels that one rack carries in this plane.
    pub fn barrels_per_rack(&self) -> u32 {
        match self.view {
            View::Transverse => self.rack.barrels,
            View::Longitudinal => self.rack.barrels_deep,
        }
    }

    /// Returns the overrides that apply to bodies of a kind at the given level and column, in the order of the file.
    /// These include overrides of all columns of the level.
    pub fn changes_of(
        &self,
        body: StackBody,
        level: u32,
        column: u32,
    ) -> impl Iterator<Item = &BodyOverride> {
        self.overrides.iter().filter(move |o| {
            o.body == body && o.level == level && o.column.is_none_or(|c| c == column)
        })
    }

    /// Returns the planar model of a stack that is modeled in three dimensions.
    ///
    /// Overrides of single rows are dropped. In the plane along the barrels, overrides of single columns are dropped as
    /// well.
    #[must_use]
    pub fn in_plane(&self, view: View) -> Self {
        let mut plane = Self { view, space: None, ..self.clone() };
        plane.overrides.retain(|change| change.row.is_none());
        if let (View::Longitudinal, Some(space)) = (view, self.space) {
            plane.columns = space.columns_along;
            plane.overrides.retain(|change| change.column.is_none());
        }
        plane
    }

    /// Returns the stack in the transverse plane only; `None` unless both planes are requested.
    pub fn across(&self) -> Option<Self> {
        self.columns_along.map(|_| Self { columns_along: None, ..self.clone() })
    }

    /// Returns the stack in the longitudinal plane only; `None` unless both planes are requested.
    ///
    /// Overrides of single columns are dropped, because columns are numbered across the barrels.
    pub fn along(&self) -> Option<Self> {
        let columns = self.columns_along?;
        let mut along =
            Self { view: View::Longitudinal, columns, columns_along: None, ..self.clone() };
        along.overrides.retain(|change| change.column.is_none());
        Some(along)
    }

    /// Returns the number of racks on one level of a three-dimensional model, counted along the barrels; 1 for a planar
    /// model.
    pub fn racks_along(&self) -> u32 {
        self.space.map_or(1, |space| space.columns_along / self.rack.barrels_deep.max(1))
    }

    /// Returns the number of racks side by side on one level in this plane.
    pub fn racks_per_level(&self) -> u32 {
        self.columns / self.barrels_per_rack().max(1)
    }
}

/// Properties of a stack that is modeled in three dimensions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InSpace {
    /// Number of barrels per level, counted along the barrels.
    pub columns_along: u32,
    /// Angle (rad) by which the stack is turned, counterclockwise viewed from above; at zero, the motion component that
    /// the scenario names acts across the barrels.
    pub azimuth: f64,
}

impl View {
    /// Both planes.
    pub const ALL: [Self; 2] = [Self::Transverse, Self::Longitudinal];

    /// Returns the name of the plane in files and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Transverse => "transverse",
            Self::Longitudinal => "longitudinal",
        }
    }

    /// Returns a phrase for the orientation of the plane, such as "along the barrels".
    pub fn words(self) -> &'static str {
        match self {
            Self::Transverse => "across the barrels",
            Self::Longitudinal => "along the barrels",
        }
    }
}

named! {
    /// Planes in which a stack is modeled, as stated in files.
    enum Planes {
        Transverse = "transverse",
        Longitudinal = "longitudinal",
        Both = "both",
        Spatial = "spatial",
    }
}

/// Range of the number of levels of a stack.
pub(super) const LEVELS: Kind = Kind::Integer(1, 12);
/// Range of the number of columns of a stack.
pub(super) const COLUMNS: Kind = Kind::Integer(1, 40);

/// A full turn (rad).
const TURN: f64 = 2.0 * std::f64::consts::PI;

/// Fields of the stack other than devices and overrides.
const OWN: [Field; 9] = fields! {
    /// Model of the stack: in the plane across the barrels, in the plane along the barrels, in both planes one after
    /// the other, each under one horizontal component of the record, or in three dimensions ("spatial") under all
    /// components at once.
    view = Kind::Choice(names::<Planes>), Default::Value("\"transverse\"");
    /// Number of levels of barrels.
    levels = LEVELS, Default::Required;
    /// Number of barrels per level, a multiple of the number that one rack carries. If the model is in a single
    /// plane, the barrels in that plane are counted; otherwise, the barrels that lie side by side are counted.
    columns = COLUMNS, Default::Required;
    /// Number of barrels per level, counted along the barrels, if the model is in both planes or in three dimensions.
    columns_along = COLUMNS,
        Default::Derived(
            "in both planes and in three dimensions, the number that one rack carries; not allowed in a single plane",
        );
    /// Angle by which the stack is turned, counterclockwise viewed from above; at zero, `motion.component` shakes the
    /// stack across the barrels, and the other horizontal component shakes it along the barrels.
    azimuth = Kind::Quantity(&[Dimension::ANGLE], Range::between(-TURN, TURN)),
        Default::Derived("in three dimensions, 0 deg; not allowed in planar models");
    /// The barrel.
    barrel = Kind::ChoiceOrTable(catalog::barrel_names, "base", &BARREL), Default::Derived("bordeaux-225");
    /// The rack.
    rack = Kind::ChoiceOrTable(catalog::rack_names, "base", &RACK), Default::Derived("two-barrel");
    /// True to mirror the stack left to right.
    mirror = Kind::Flag, Default::Value("false");
    /// Clear distance between racks side by side.
    gap = Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 10.0)), Default::Value("\"0.05 m\"");
};

const OVERRIDES: Field = Field::new(
    "override",
    Kind::Tables(&OVERRIDE),
    Default::Nothing,
    "Bodies that differ from the others.",
);

/// Concatenates three lists of fields.
const fn joined<const ALL: usize>(lists: [&[Field]; 3]) -> [Field; ALL] {
    let mut all = [OVERRIDES; ALL];
    let (mut list, mut next) = (0, 0);
    while list < lists.len() {
        let mut at = 0;
        while at < lists[list].len() {
            all[next] = lists[list][at];
            (at, next) = (at + 1, next + 1);
        }
        list += 1;
    }
    all
}

/// Definition of the table of a stack.
pub static STACK: Section = Section {
    name: "stack",
    help: "A stack of barrels on racks.",
    fields: &joined::<{ OWN.len() + device::FIELDS.len() + 1 }>([
        &OWN,
        &device::FIELDS,
        &[OVERRIDES],
    ]),
    variants: None,
    exclusive: &[],
};

/// Reads a stack.
pub(super) fn read(
    reader: Reader<'_>,
    interfaces: StackInterfaces,
) -> Result<StackSpec, ScenarioError> {
    let rack = rack::read(reader.section("rack")?)?;
    let barrel = barrel::read(reader.section("barrel")?, rack.rail_half_spacing)?;
    let levels = reader.integer("levels")?;
    let planes: Planes = reader.choice("view")?;
    let along = reader.optional_integer("columns_along")?;
    let azimuth = reader.optional_quantity("azimuth")?;
    if planes != Planes::Spatial && azimuth.is_some() {
        let message = "`stack.azimuth` applies only with `stack.view = \"spatial\"`; in a plane, choose the direction \
                       of shaking with `motion.component`, such as \"az:30\" for an azimuth of 30 degrees"
            .to_owned();
        return Err(reader.inconsistent("azimuth", message));
    }
    let (columns_along, space) = match (planes, along) {
        (Planes::Both, along) => (Some(along.unwrap_or(rack.barrels_deep)), None),
        (Planes::Spatial, along) => {
            let columns_along = along.unwrap_or(rack.barrels_deep);
            (None, Some(InSpace { columns_along, azimuth: azimuth.unwrap_or(0.0) }))
        }
        (Planes::Transverse | Planes::Longitudinal, None) => (None, None),
        (Planes::Transverse | Planes::Longitudinal, Some(_)) => {
            let message = "`stack.columns_along` applies only with `stack.view = \"both\"` or \"spatial\"; in one \
                           plane, use `stack.columns` for the number of barrels on a level"
                .to_owned();
            return Err(reader.inconsistent("columns_along", message));
        }
    };
    let mut stack = StackSpec {
        view: if planes == Planes::Longitudinal { View::Longitudinal } else { View::Transverse },
        levels,
        columns: reader.integer("columns")?,
        columns_along,
        space,
        barrel,
        rack,
        mirror: reader.flag("mirror")?,
        gap: reader.quantity("gap")?,
        devices: Devices::read(&reader, levels)?,
        overrides: Vec::new(),
        interfaces,
    };
    check_geometry(&reader, &stack, "columns")?;
    let in_space = stack.space.map(|_| stack.in_plane(View::Longitudinal));
    if let Some(along) = stack.along().or(in_space) {
        check_geometry(&reader, &along, "columns_along")?;
    }
    for item in reader.sections("override")? {
        let body = body_override::read(item, &stack)?;
        stack.overrides.push(body);
    }
    reader.finish();
    Ok(stack)
}

fn check_geometry(
    reader: &Reader<'_>,
    stack: &StackSpec,
    field: &'static str,
) -> Result<(), ScenarioError> {
    let per_rack = stack.barrels_per_rack();
    let StackSpec { rack, barrel, columns, .. } = stack;
    if columns % per_rack != 0 {
        let below = (columns / per_rack) * per_rack;
        let nearest = if below == 0 { per_rack } else { below };
        let message = format!(
            "`stack.{field}` is {columns}, but one `{}` rack carries {per_rack} barrels in this plane; take {nearest} \
             columns or set `stack.rack.{}`",
            rack.base,
            match stack.view {
                View::Transverse => "barrels",
                View::Longitudinal => "barrels_deep",
            }
        );
        return Err(reader.inconsistent(field, message));
    }
    if rack.barrels > 1 && barrel.section_diameter > rack.pitch {
        let message = format!(
            "barrels with a diameter of {} m overlap at a rack pitch of {} m; set `stack.rack.pitch` and \
             `stack.rack.width`",
            rounded(barrel.section_diameter),
            rack.pitch
        );
        return Err(reader.inconsistent("barrel", message));
    }
    if 2.0 * rack.rail_half_spacing + rack.rail_width > barrel.length {
        let message = format!(
            "rails at {} m from the middle lie beyond the end of a barrel {} m long; set \
             `stack.rack.rail_half_spacing`",
            rack.rail_half_spacing, barrel.length
        );
        return Err(reader.inconsistent("rack", message));
    }
    Ok(())
}

/// Writes a stack.
pub(super) fn write(stack: &StackSpec) -> Table {
    let mut writer = Writer::new(&STACK);
    let planes = match (stack.columns_along, stack.space, stack.view) {
        (_, Some(_), _) => Planes::Spatial,
        (Some(_), None, _) => Planes::Both,
        (None, None, View::Transverse) => Planes::Transverse,
        (None, None, View::Longitudinal) => Planes::Longitudinal,
    };
    writer.choice("view", planes);
    writer.integer("levels", stack.levels);
    writer.integer("columns", stack.columns);
    match stack.columns_along.or(stack.space.map(|space| space.columns_along)) {
        Some(along) => writer.integer("columns_along", along),
        None => writer.omit(&["columns_along"]),
    }
    writer.optional_quantity("azimuth", stack.space.map(|space| space.azimuth));
    writer.flag("mirror", stack.mirror);
    writer.quantity("gap", stack.gap);
    writer.table("barrel", barrel::write(&stack.barrel));
    writer.table("rack", rack::write(&stack.rack));
    stack.devices.write(&mut writer);
    writer.tables("override", stack.overrides.iter().map(body_override::write).collect());
    writer.finish()
}
