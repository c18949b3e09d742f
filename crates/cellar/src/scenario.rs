//! A cellar as stated in a file: a room with columns, doors, aisles and places where people work, and blocks of stacks.
//! The file describes one stack; all stacks are copies of it, but may differ in their numbers of levels.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use barrelstack::ground::{GroundError, from_disk};
use barrelstack::scenario::bytes_of;
use barrelstack::scenario::error::ScenarioError;
use barrelstack::scenario::field::{Default, Kind, Range, names};
use barrelstack::scenario::imperfections::IMPERFECTIONS;
use barrelstack::scenario::motion::{MOTION, MotionSpec, Scale, read_shock, write_sequence};
use barrelstack::scenario::pair::INTERFACES;
use barrelstack::scenario::reader::Reader;
use barrelstack::scenario::run::{OUTCOME, RECORD, RUN};
use barrelstack::scenario::stack::STACK;
use barrelstack::scenario::template::{Host, Language};
use barrelstack::scenario::tree::{Entry, Node, Origin, Table, Value};
use barrelstack::scenario::unknowns::UNKNOWNS;
use barrelstack::scenario::{Dimension, Scenario, Setting, Until};
use barrelstack_input::declared::Declared as _;
use barrelstack_input::writer::{Writer, to_toml};
use barrelstack_input::{FileRef, fnv1a, named, section, table};

use crate::start::{START, StartSpec};

/// A length of at most a kilometer.
const LENGTH: Kind = Kind::Quantity(&[Dimension::LENGTH], Range::up_to(1000.0));
/// A distance from zero to a kilometer.
const APART: Kind = Kind::Quantity(&[Dimension::LENGTH], Range::between(0.0, 1000.0));

named! {
    /// A side of the room, for a viewer who looks along `y` with `x` to the right.
    pub enum Side {
        /// The side at `x = 0`.
        Left = "left",
        /// The side where `x` is the length of the room.
        Right = "right",
        /// The side at `y = 0`.
        Near = "near",
        /// The side where `y` is the width of the room.
        Far = "far",
    }
}

section! {
    /// The room.
    #[derive(Clone, Debug, PartialEq)]
    pub struct RoomSpec;
    /// The room: a rectangle with its near left corner at the origin, `x` to the right and `y` away from the viewer.
    pub static ROOM = "room";
    /// Length along x.
    length: f64 = LENGTH, Default::Required;
    /// Width along y.
    width: f64 = LENGTH, Default::Required;
    /// True if the room has walls on its four sides; doors are closed during the shaking. False for an open floor.
    walls: bool = Kind::Flag, Default::Value("true");
    /// Height of walls and columns.
    height: f64 = LENGTH, Default::Value("\"6 m\"");
    /// Stiffness k of walls and columns where a body strikes them.
    stiffness: Option<f64> = Kind::Quantity(&[Dimension::HERTZ_STIFFNESS], Range::POSITIVE),
        Default::Derived("that of a barrel that strikes the ground, `interface.barrel-ground`");
    /// Coefficient of restitution: ratio of the speeds after and before a body strikes a wall or column.
    restitution: Option<f64> = Kind::Number(Range::up_to(1.0)),
        Default::Derived("that of a barrel that strikes the ground, `interface.barrel-ground`");
    /// Friction coefficient between bodies and the walls and columns.
    friction: Option<f64> = Kind::Number(Range::between(0.0, 2.0)),
        Default::Derived("that of a barrel on the ground, `interface.barrel-ground`");
}

section! {
    /// A column.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Column;
    /// A column: a block that reaches from the floor to the height of the walls.
    pub static COLUMN = "column";
    /// Unique name.
    name: String = Kind::Text, Default::Required;
    /// Position of the middle of the column, along x and y.
    at: [f64; 2] = Kind::Point(Dimension::LENGTH), Default::Required;
    /// Side lengths of the column along x and y.
    size: [f64; 2] = Kind::Point(Dimension::LENGTH), Default::Value("[\"0.4 m\", \"0.4 m\"]");
}

section! {
    /// A door.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Door;
    /// A door in a side of the room.
    pub static DOOR = "door";
    /// Unique name.
    name: String = Kind::Text, Default::Required;
    /// Side of the room.
    side: Side = Kind::Choice(names::<Side>), Default::Required;
    /// Position of the middle of the door along its side: x for the near and the far side, otherwise y.
    position: f64 = APART, Default::Required;
    /// Clear width.
    width: f64 = Kind::Quantity(&[Dimension::LENGTH], Range::between(0.6, 20.0)), Default::Value("\"1.2 m\"");
}

section! {
    /// An aisle.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Aisle;
    /// An aisle: a rectangle along whose longer side people walk.
    pub static AISLE = "aisle";
    /// Unique name.
    name: String = Kind::Text, Default::Required;
    /// Corner with the smaller coordinates x and y.
    from: [f64; 2] = Kind::Point(Dimension::LENGTH), Default::Required;
    /// Opposite corner.
    to: [f64; 2] = Kind::Point(Dimension::LENGTH), Default::Required;
}

section! {
    /// A place where people work.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Place;
    /// A place where people work, from which a path to a door is to stay free.
    pub static PLACE = "place";
    /// Unique name.
    name: String = Kind::Text, Default::Required;
    /// Position along x and y.
    at: [f64; 2] = Kind::Point(Dimension::LENGTH), Default::Required;
}

impl Column {
    /// Returns the corners (m) with the smallest and with the largest coordinates.
    pub fn corners(&self) -> [[f64; 2]; 2] {
        [-0.5, 0.5].map(|s| [0, 1].map(|axis| self.at[axis] + s * self.size[axis]))
    }
}

/// Rows of stacks that are alike; only their numbers of levels may differ from row to row.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Name by which changes refer to the block.
    pub name: Option<String>,
    /// Number of rows; the rows follow each other along y.
    pub rows: u32,
    /// Number of stacks in a row; they follow each other along x.
    pub stacks: u32,
    /// Position (m), along x and y, of the first stack. It is the near left corner of the bounding rectangle of the
    /// stack's footprint.
    pub first: [f64; 2],
    /// Clear distance (m) between neighboring stacks of a row.
    pub spacing: f64,
    /// Clear distance (m) between rows that stand back to back.
    pub between_rows: f64,
    /// Clear distance (m) between two groups of rows.
    pub aisle: f64,
    /// Number of rows that stand back to back before an aisle follows.
    pub rows_together: u32,
    /// Angle (rad) by which every stack is turned, counterclockwise from above.
    pub azimuth: f64,
    /// Number of levels; `None` to use `stack.levels`.
    pub levels: Option<u32>,
    /// Numbers of levels row by row, in place of `levels`; empty if not given.
    pub levels_by_row: Vec<u32>,
}

table! {
    /// A block: rows of stacks, each of which is a copy of the stack that this file describes.
    pub static BLOCK = "block";
    /// Name by which a change can refer to the block.
    name = Kind::Text, Default::Nothing;
    /// Number of rows; the rows follow each other along y.
    rows = Kind::Integer(1, 500), Default::Value("1");
    /// Number of stacks in a row; the stacks follow each other along x.
    stacks = Kind::Integer(1, 500), Default::Value("1");
    /// Position of the near left corner of the first stack.
    first = Kind::Point(Dimension::LENGTH), Default::Required;
    /// Clear distance between neighboring stacks of a row.
    spacing = APART, Default::Value("\"0.1 m\"");
    /// Clear distance between rows that stand back to back.
    between_rows = APART, Default::Value("\"0.1 m\"");
    /// Clear distance between two groups of rows.
    aisle = APART, Default::Value("\"1.2 m\"");
    /// Number of rows that stand back to back before an aisle follows.
    rows_together = Kind::Integer(1, 500), Default::Value("1");
    /// Angle by which every stack is turned, counterclockwise from above; at zero the barrels lie along y.
    azimuth = Kind::Quantity(&[Dimension::ANGLE], Range::between(-7.0, 7.0)), Default::Value("\"0 deg\"");
    /// Number of levels.
    levels = Kind::Integer(1, 12), Default::Derived("`stack.levels`");
    /// Numbers of levels row by row, such as [6, 6, 5].
    levels_by_row = Kind::Values, Default::Nothing;
    at most one of &["levels", "levels_by_row"];
}

fn kinds() -> Vec<&'static str> {
    vec!["cellar"]
}

table! {
    /// A cellar: stacks in rows in one room, on one ground.
    pub static CELLAR = "cellar";
    /// Version of the format of cellar files.
    schema = Kind::Integer(1, 1), Default::Required;
    /// Title, in one line.
    title = Kind::Text, Default::Derived("name of the file");
    /// Built-in cellar, or file ending in `.toml`, whose values this cellar overrides.
    extends = Kind::Text, Default::Nothing;
    /// Kind of the file.
    kind = Kind::Choice(kinds), Default::Required;
    /// The room.
    room = Kind::Table(&ROOM), Default::Required;
    /// Columns.
    column = Kind::Tables(&COLUMN), Default::Nothing;
    /// Doors.
    door = Kind::Tables(&DOOR), Default::Nothing;
    /// Aisles, which are to stay free.
    aisle = Kind::Tables(&AISLE), Default::Nothing;
    /// Places where people work.
    place = Kind::Tables(&PLACE), Default::Nothing;
    /// Blocks of stacks.
    block = Kind::Tables(&BLOCK), Default::Required;
    /// The stack, in three dimensions; all stacks of the room are alike.
    stack = Kind::Table(&STACK), Default::Required;
    /// Contact laws by pair of bodies; between bodies of different stacks, the laws of fallen bodies apply.
    interface = Kind::Table(&INTERFACES), Default::Nothing;
    /// Places from which bodies start, such as those surveyed after an earthquake.
    start = Kind::Table(&START), Default::Nothing;
    /// The ground motion along the axes of the room, or a sequence of shocks.
    motion = Kind::Table(&MOTION), Default::Required;
    /// Settings of the run.
    run = Kind::Table(&RUN), Default::Nothing;
    /// Settings of the recording.
    record = Kind::Table(&RECORD), Default::Nothing;
    /// Thresholds that define a collapse.
    outcome = Kind::Table(&OUTCOME), Default::Nothing;
    /// Random differences from stack to stack, which are drawn for every stack, and the number of variants of the room.
    imperfections = Kind::Table(&IMPERFECTIONS), Default::Nothing;
    /// Uncertainty of constants that nobody has measured; the constants are drawn once for all stacks of a variant.
    unknowns = Kind::Table(&UNKNOWNS), Default::Nothing;
}

/// Fields of a cellar that a scenario does not have.
const OWN: [&str; 8] = ["kind", "room", "column", "door", "aisle", "place", "block", "start"];

macro_rules! cellars {
    ($($name:literal),* $(,)?) => {
        const BUILT_IN: &[(&str, &str)] = &[
            $(($name, include_str!(concat!("../scenarios/", $name, ".toml")))),*
        ];
    };
}

cellars!["demo-cellar", "cellar-four-barrel", "cellar-two-barrel"];

/// Returns the names of the built-in cellars.
pub fn names_built_in() -> impl Iterator<Item = &'static str> {
    BUILT_IN.iter().map(|(name, _)| *name)
}

/// Returns the TOML source of a built-in cellar.
pub fn built_in(name: &str) -> Option<&'static str> {
    BUILT_IN.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// Format of cellar files: their fields, and the built-in files that they may extend (cellars, and scenarios of one
/// stack).
const LANGUAGE: Language = Language {
    root: &CELLAR,
    builtin: |name| built_in(name).or_else(|| barrelstack::scenario::builtin::get(name)),
    names: || names_built_in().chain(barrelstack::scenario::builtin::names()).collect(),
};

/// Maximum number of barrels in a room. A run keeps all bodies with their frames in memory.
pub const MOST_BARRELS: u64 = 10_000;

/// Maximum number of columns. The same limit applies to doors, to aisles and to places.
const MOST_ITEMS: usize = 1000;

/// Maximum number of shocks in a sequence. Each shock requires a run of its own.
pub const MOST_SHOCKS: usize = 20;

/// A stack in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Standing {
    /// Name: row and number in the row, such as "3-5".
    pub name: String,
    /// Number of the row, from 1; the numbering continues from block to block.
    pub row: u32,
    /// Number in the row, from 1.
    pub number: u32,
    /// Index of the block of the stack.
    pub block: usize,
    /// Index of the scenario of the stack in [`Cellar::models`].
    pub model: usize,
    /// Position (m) of the origin of the stack.
    pub at: [f64; 2],
    /// Angle (rad) by which the stack is turned counterclockwise.
    pub azimuth: f64,
}

/// A cellar whose values have been checked. All quantities are in SI units.
#[derive(Clone, Debug)]
pub struct Cellar {
    /// Title, a single line.
    pub title: String,
    /// The room.
    pub room: RoomSpec,
    /// Columns.
    pub columns: Vec<Column>,
    /// Doors.
    pub doors: Vec<Door>,
    /// Aisles.
    pub aisles: Vec<Aisle>,
    /// Places where people work.
    pub places: Vec<Place>,
    /// Blocks of stacks.
    pub blocks: Vec<Block>,
    /// Initial poses of the bodies that do not start as built.
    pub start: StartSpec,
    /// The shocks of a sequence after the first. The first shock is the motion of the stack as stated
    /// ([`Cellar::stated`]).
    pub later: Vec<MotionSpec>,
    /// Scenarios of the stacks as stated, one for each number of levels.
    pub models: Vec<Scenario>,
    /// For every block and row, the index of the model.
    pub(crate) model_of: Vec<Vec<usize>>,
    pub(crate) host: Host,
}

impl Cellar {
    /// Reads the file of a cellar and the files that it extends, and applies changes as for a scenario.
    ///
    /// # Errors
    /// Returns the first problem found, with its place in the file.
    pub fn load(path: &Path, changes: &[String]) -> Result<Self, ScenarioError> {
        Self::parse_file(path, &bytes_of(path)?, changes)
    }

    /// Reads a cellar like [`Cellar::load`], from the bytes of its file.
    ///
    /// # Errors
    /// As for [`Cellar::load`].
    pub fn parse_file(
        path: &Path,
        bytes: &[u8],
        changes: &[String],
    ) -> Result<Self, ScenarioError> {
        Self::of(&Host::parse_file(path, bytes, changes, &LANGUAGE)?)
    }

    /// Reads a cellar from TOML source, which may extend only built-in cellars and scenarios.
    ///
    /// ```
    /// use barrelstack_cellar::Cellar;
    ///
    /// let cellar = Cellar::parse("mine.toml", b"schema = 1\nextends = \"demo-cellar\"", &[])?;
    /// assert_eq!(cellar.barrels(), 40);
    /// # Ok::<(), barrelstack::scenario::ScenarioError>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Cellar::load`].
    pub fn parse(name: &str, bytes: &[u8], changes: &[String]) -> Result<Self, ScenarioError> {
        Self::of(&Host::parse(name, bytes, changes, &LANGUAGE)?)
    }

    /// Reads a built-in cellar.
    ///
    /// # Errors
    /// If there is no cellar with this name, or a change is invalid.
    pub fn builtin(name: &str, changes: &[String]) -> Result<Self, ScenarioError> {
        Self::of(&Host::builtin(name, changes, &LANGUAGE)?)
    }

    /// Returns `true` if a file describes a cellar, or extends a file that does; `false` if a file cannot be read or
    /// parsed.
    pub fn is_stated(path: Option<&Path>, bytes: &[u8]) -> bool {
        is_cellar(path, bytes, 8)
    }

    /// Returns a copy of the cellar to which further overrides are applied, after all earlier overrides.
    ///
    /// # Errors
    /// As for [`Cellar::load`].
    pub fn with(&self, changes: &[String]) -> Result<Self, ScenarioError> {
        Self::of(&self.host.with(changes, &LANGUAGE)?)
    }

    /// Returns all values with their meanings, without the title, in the order of [`Cellar::to_resolved_toml`].
    pub fn settings(&self) -> Vec<Setting> {
        let mut all = barrelstack_input::listing::settings(&self.write(), &CELLAR);
        all.retain(|setting| !["title", "schema", "kind"].contains(&setting.path.as_str()));
        all
    }

    /// Returns the number of barrels.
    pub fn barrels(&self) -> u64 {
        let row = |(block, models): (&Block, &Vec<usize>)| -> u64 {
            models.iter().map(|at| u64::from(block.stacks) * barrels(&self.models[*at])).sum()
        };
        self.blocks.iter().zip(&self.model_of).map(row).sum()
    }

    /// Returns the scenario of the stack as stated. Its motion, settings and imperfections are those of the room.
    pub fn stated(&self) -> &Scenario {
        &self.models[0]
    }

    /// Returns the cellar with the records of its motion in memory.
    ///
    /// # Errors
    /// If a record cannot be read.
    pub fn with_records(&self) -> Result<Self, GroundError> {
        let mut held = self.clone();
        for model in &mut held.models {
            *model = model.with_records(&mut from_disk)?;
        }
        held.start.hold();
        for shock in &mut held.later {
            *shock = shock.clone().with_files(&mut from_disk)?;
        }
        Ok(held)
    }

    /// Returns the same cellar with another number of variants.
    #[must_use]
    pub fn with_variants(mut self, count: u32) -> Self {
        for model in &mut self.models {
            if let barrelstack::scenario::Scene::Stack { imperfections, .. } = &mut model.scene {
                imperfections.variants = count;
            }
        }
        self
    }

    /// Returns the cellar with an aftershock that follows its motion. The aftershock is a record if `record` is given,
    /// otherwise the same motion; it is multiplied by `factor`.
    ///
    /// # Errors
    /// If the cellar has a sequence of shocks, or a motion whose scale cannot be multiplied by a factor.
    pub fn with_aftershock(
        mut self,
        factor: f64,
        record: Option<&Path>,
    ) -> Result<Self, ScenarioError> {
        if !self.later.is_empty() {
            let message =
                "the motion is already a sequence of shocks: add the aftershock to it".to_owned();
            return Err(self.host.error(&["motion.sequence"], message));
        }
        let mut shock = self.stated().motion.clone();
        if let Some(record) = record {
            let file = FileRef::of_caller(record.display().to_string());
            shock = self.stated().with_record_file(&file).motion;
            shock.scale = Scale::Factor(1.0);
        }
        shock.scale = match shock.scale {
            Scale::Factor(own) => Scale::Factor(factor * own),
            Scale::Pga(own) => Scale::Pga(factor * own),
            Scale::Pgv(own) => Scale::Pgv(factor * own),
            Scale::Measure { .. } => {
                let message = "an aftershock needs a motion that is scaled by `factor`, `pga` or `pgv`: state one of them in place of \
                               `measure`";
                return Err(self.host.error(&["motion.scale.measure"], message.to_owned()));
            }
        };
        self.later.push(shock);
        Ok(self)
    }

    /// Returns the cellar as TOML text, with all defaults written out and all quantities in SI units. The text parses
    /// to an equal cellar.
    pub fn to_resolved_toml(&self) -> String {
        to_toml(&self.write())
    }

    /// Returns the fingerprint of the cellar without its title: the 64-bit FNV-1a hash of the resolved text, in which
    /// the path of a record is replaced by the bytes of the record.
    pub fn fingerprint(&self) -> u64 {
        let mut own = self.write();
        own.remove("title");
        own.remove("motion");
        let mut motion = format!("{:016x}", self.stated().fingerprint());
        if !self.later.is_empty() {
            let shocks: Vec<MotionSpec> = self.later.iter().map(MotionSpec::by_content).collect();
            motion += &to_toml(&write_sequence(&shocks));
        }
        if !self.start.is_as_built() {
            own.remove("start");
            motion += &to_toml(&self.start.by_content().write());
        }
        fnv1a(format!("{motion}\n{}", to_toml(&own)).as_bytes())
    }

    fn of(host: &Host) -> Result<Self, ScenarioError> {
        let reader = host.reader(&CELLAR)?;
        reader.integer("schema")?;
        let title = host.titled(&reader.optional_text("title")?.unwrap_or_else(|| host.stem()));
        if reader.optional_text("extends")?.is_some() {
            let message = "`extends` cannot be overridden; write it in the file".to_owned();
            return Err(reader.inconsistent("extends", message));
        }
        let kind = reader.catalog_name("kind")?;
        debug_assert_eq!(kind, "cellar");
        let room = RoomSpec::read(reader.section("room")?)?;
        let columns: Vec<Column> = all(&reader, "column")?;
        let doors: Vec<Door> = all(&reader, "door")?;
        let aisles: Vec<Aisle> = all(&reader, "aisle")?;
        let places: Vec<Place> = all(&reader, "place")?;
        let readers = reader.sections("block")?;
        if readers.is_empty() {
            return Err(reader.missing("block"));
        }
        for inherited in [
            "stack",
            "interface",
            "motion",
            "run",
            "record",
            "outcome",
            "imperfections",
            "unknowns",
        ] {
            reader.skip(inherited);
        }
        let start = match reader.optional_section("start")? {
            Some(start) => StartSpec::read(start)?,
            None => StartSpec::default(),
        };
        let later = later_shocks(host)?;
        reader.finish();
        distinct(host, "column", columns.iter().map(|one| &one.name))?;
        distinct(host, "door", doors.iter().map(|one| &one.name))?;
        distinct(host, "aisle", aisles.iter().map(|one| &one.name))?;
        distinct(host, "place", places.iter().map(|one| &one.name))?;
        let stated = model(host, None)?;
        check(host, &stated)?;
        let mut cellar = Self {
            title,
            room,
            columns,
            doors,
            aisles,
            places,
            blocks: Vec::new(),
            start,
            later,
            models: vec![stated],
            model_of: Vec::new(),
            host: host.clone(),
        };
        cellar.check_items()?;
        cellar.read_blocks(readers)?;
        Ok(cellar)
    }

    fn read_blocks(&mut self, readers: Vec<Reader<'_>>) -> Result<(), ScenarioError> {
        let own = self.models[0].stack().map_or(0, |stack| stack.levels);
        let mut known = BTreeMap::from([(own, 0)]);
        let mut total = 0_u64;
        for reader in readers {
            let block = read_block(&reader)?;
            let by_row = reader.nodes("levels_by_row")?.unwrap_or_default();
            let mut models = Vec::new();
            for row in 0..block.rows as usize {
                let (levels, path) = match block.levels_by_row.get(row) {
                    Some(levels) => (*levels, "levels_by_row"),
                    None => (block.levels.unwrap_or(own), "levels"),
                };
                // The count is checked before anything is built.
                let each = barrels(&self.models[0]) / u64::from(own.max(1)) * u64::from(levels);
                total += each * u64::from(block.stacks);
                if total > MOST_BARRELS {
                    let message = format!(
                        "with row {} of this block the cellar has more than {MOST_BARRELS} barrels, the maximum that \
                         fits into memory: use fewer rows or stacks, or split the cellar into rooms",
                        row + 1
                    );
                    return Err(reader.inconsistent("rows", message));
                }
                let model = if let Some(model) = known.get(&levels) {
                    *model
                } else {
                    let origin = by_row.get(row).map_or(reader.origin_of(path), |node| node.origin);
                    let node = Node { origin, value: Value::Integer(Some(i64::from(levels))) };
                    self.models.push(model(&self.host, Some(("stack.levels", node)))?);
                    known.insert(levels, self.models.len() - 1);
                    self.models.len() - 1
                };
                models.push(model);
            }
            reader.finish();
            self.blocks.push(block);
            self.model_of.push(models);
        }
        Ok(())
    }

    /// Checks the columns, doors, aisles and places of the room: they must have valid sizes and lie inside the room.
    fn check_items(&self) -> Result<(), ScenarioError> {
        let RoomSpec { length, width, .. } = self.room;
        let inside = |[x, y]: [f64; 2]| (0.0..=length).contains(&x) && (0.0..=width).contains(&y);
        let outside = |path: String| {
            let message = format!(
                "it lies outside the room, which is {length} m long and {width} m wide: move it inside, or enlarge \
                 the room"
            );
            Err(self.host.error(&[&path], message))
        };
        for (at, column) in (1..).zip(&self.columns) {
            let [a, b] = column.size;
            if a <= 0.0 || b <= 0.0 {
                let message = format!(
                    "a column has sides of {a} m and {b} m: give it two positive side lengths"
                );
                return Err(self.host.error(&[&format!("column.{at}.size")], message));
            }
            let ends = column.corners();
            if !ends.into_iter().all(inside) {
                return outside(format!("column.{at}.at"));
            }
        }
        for (at, door) in (1..).zip(&self.doors) {
            let side = match door.side {
                Side::Near | Side::Far => length,
                Side::Left | Side::Right => width,
            };
            if door.position - 0.5 * door.width < 0.0 || door.position + 0.5 * door.width > side {
                let message = format!(
                    "the door \"{}\" reaches from {:.2} to {:.2} m, but its side of the room is {side} m long: move \
                     the door, or make it narrower",
                    door.name,
                    door.position - 0.5 * door.width,
                    door.position + 0.5 * door.width
                );
                return Err(self.host.error(&[&format!("door.{at}.position")], message));
            }
        }
        for (at, aisle) in (1..).zip(&self.aisles) {
            let sides = [0, 1].map(|axis| aisle.to[axis] - aisle.from[axis]);
            if sides.into_iter().any(|side| side <= 0.0) {
                let message = format!(
                    "the aisle \"{}\" has sides of {:.2} m and {:.2} m: `to` needs larger coordinates than `from`",
                    aisle.name, sides[0], sides[1]
                );
                return Err(self.host.error(&[&format!("aisle.{at}.to")], message));
            }
            for (end, path) in [(aisle.from, "from"), (aisle.to, "to")] {
                if !inside(end) {
                    return outside(format!("aisle.{at}.{path}"));
                }
            }
        }
        for (at, place) in (1..).zip(&self.places) {
            if !inside(place.at) {
                return outside(format!("place.{at}.at"));
            }
        }
        Ok(())
    }

    fn write(&self) -> Table {
        let mut writer = Writer::new(&CELLAR);
        writer.integer("schema", 1);
        writer.text("title", &self.title);
        writer.omit(&["extends"]);
        writer.text("kind", "cellar");
        writer.table("room", self.room.write());
        writer.tables("column", self.columns.iter().map(Column::write).collect());
        writer.tables("door", self.doors.iter().map(Door::write).collect());
        writer.tables("aisle", self.aisles.iter().map(Aisle::write).collect());
        writer.tables("place", self.places.iter().map(Place::write).collect());
        writer.tables("block", self.blocks.iter().map(write_block).collect());
        if self.start.is_as_built() {
            writer.omit(&["start"]);
        } else {
            writer.table("start", self.start.write());
        }
        let mut scenario = self.stated().to_table();
        if !self.later.is_empty()
            && let Some(motion) = scenario.get_mut("motion")
        {
            let shocks = std::iter::once(&self.stated().motion).chain(&self.later);
            motion.node.value = Value::Table(write_sequence(shocks));
        }
        for entry in scenario.entries {
            let Value::Table(table) = entry.node.value else { continue };
            if let Some(field) = CELLAR.fields.iter().find(|field| field.name == entry.key) {
                writer.table(field.name, table);
            }
        }
        writer.finish()
    }
}

/// Returns the number of barrels in the stack that a scenario describes.
pub(crate) fn barrels(scenario: &Scenario) -> u64 {
    scenario.stack().map_or(0, |stack| {
        let along = stack.space.map_or(1, |space| space.columns_along);
        u64::from(stack.levels) * u64::from(stack.columns) * u64::from(along)
    })
}

/// Returns the scenario of the stack with the first shock as its motion; `change` replaces one field.
fn model(host: &Host, change: Option<(&'static str, Node)>) -> Result<Scenario, ScenarioError> {
    let reader = host.reader(&CELLAR)?;
    let motion = reader.table("motion").ok().and_then(|motion| motion.get("sequence"));
    let first = match motion.map(|sequence| &sequence.node.value) {
        Some(Value::Array(shocks)) => shocks.first(),
        _ => None,
    };
    let first = first.map(|shock| ("motion", shock.clone()));
    host.stack(&OWN, &change.into_iter().chain(first).collect::<Vec<_>>())
}

/// Returns the shocks of a sequence after the first; empty if the cellar has no sequence.
fn later_shocks(host: &Host) -> Result<Vec<MotionSpec>, ScenarioError> {
    let reader = host.reader(&CELLAR)?;
    let motion = reader.section("motion")?;
    if !motion.has("sequence") {
        return Ok(Vec::new());
    }
    let shocks = motion.sections("sequence")?;
    let message = match shocks.len() {
        0 => "a sequence needs at least one shock: add [[motion.sequence]], or state one shock in [motion]".to_owned(),
        many if many > MOST_SHOCKS => {
            format!("there are {many} shocks; a sequence has at most {MOST_SHOCKS}: keep the strongest")
        }
        _ => {
            let mut all = shocks.into_iter().map(read_shock).collect::<Result<Vec<_>, _>>()?;
            all.remove(0);
            return Ok(all);
        }
    };
    Err(motion.inconsistent("sequence", message))
}

/// Rejects settings that a single stack may have, but a stack in a room may not.
fn check(host: &Host, stated: &Scenario) -> Result<(), ScenarioError> {
    if stated.stack().and_then(|stack| stack.space).is_some_and(|space| space.azimuth != 0.0) {
        let message =
            "in a cellar, whole blocks are turned, not single stacks: state `azimuth` in \
             [[block]]"
                .to_owned();
        return Err(host.error(&["stack.azimuth"], message));
    }
    if stated.run.until != Until::Rest {
        let message =
            "a room is simulated until its bodies rest, because a stack may fall on another late in the run: leave \
             `run.until` out"
                .to_owned();
        return Err(host.error(&["run.until"], message));
    }
    Ok(())
}

/// Reads a list of at most [`MOST_ITEMS`] tables; returns an error if there are more.
fn all<T: barrelstack_input::declared::Declared>(
    reader: &Reader<'_>,
    name: &'static str,
) -> Result<Vec<T>, ScenarioError> {
    let sections = reader.sections(name)?;
    if sections.len() > MOST_ITEMS {
        let message = format!(
            "there are {} tables [[{name}]]; a cellar has at most {MOST_ITEMS}",
            sections.len()
        );
        return Err(reader.inconsistent(name, message));
    }
    sections.into_iter().map(T::read).collect()
}

fn distinct<'a>(
    host: &Host,
    list: &str,
    all: impl Iterator<Item = &'a String>,
) -> Result<(), ScenarioError> {
    let mut known = BTreeSet::new();
    for (at, name) in (1..).zip(all) {
        if !known.insert(name) {
            let message =
                format!("two of [[{list}]] are called \"{name}\"; give each its own name");
            return Err(host.error(&[&format!("{list}.{at}.name")], message));
        }
    }
    Ok(())
}

fn read_block(reader: &Reader<'_>) -> Result<Block, ScenarioError> {
    let rows = reader.integer("rows")?;
    let mut levels_by_row = Vec::new();
    for node in reader.nodes("levels_by_row")?.unwrap_or_default() {
        let levels = reader.read_integer("levels_by_row", &node, Kind::Integer(1, 12))?;
        levels_by_row.push(u32::try_from(levels).unwrap_or(0));
    }
    if !levels_by_row.is_empty() && levels_by_row.len() != rows as usize {
        let message = format!(
            "`levels_by_row` has {} values for {rows} rows; state one value for each row",
            levels_by_row.len()
        );
        return Err(reader.inconsistent("levels_by_row", message));
    }
    Ok(Block {
        name: reader.optional_text("name")?,
        rows,
        stacks: reader.integer("stacks")?,
        first: reader.point("first")?,
        spacing: reader.quantity("spacing")?,
        between_rows: reader.quantity("between_rows")?,
        aisle: reader.quantity("aisle")?,
        rows_together: reader.integer("rows_together")?,
        azimuth: reader.quantity("azimuth")?,
        levels: reader.optional_integer("levels")?,
        levels_by_row,
    })
}

fn write_block(block: &Block) -> Table {
    let mut writer = Writer::new(&BLOCK);
    writer.optional_text("name", block.name.as_deref());
    writer.integer("rows", block.rows);
    writer.integer("stacks", block.stacks);
    writer.point("first", block.first);
    writer.quantity("spacing", block.spacing);
    writer.quantity("between_rows", block.between_rows);
    writer.quantity("aisle", block.aisle);
    writer.integer("rows_together", block.rows_together);
    writer.quantity("azimuth", block.azimuth);
    match block.levels {
        Some(levels) => writer.integer("levels", levels),
        None => writer.omit(&["levels"]),
    }
    writer.omit(&["levels_by_row"]);
    let mut table = writer.finish();
    if !block.levels_by_row.is_empty() {
        let node = |value| Node { origin: Origin::Default, value };
        let levels = block.levels_by_row.iter().map(|n| node(Value::Integer(Some(i64::from(*n)))));
        let node = node(Value::Array(levels.collect()));
        table.set(Entry { key: "levels_by_row".to_owned(), origin: Origin::Default, node });
    }
    table
}

fn is_cellar(path: Option<&Path>, bytes: &[u8], depth: u32) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let mut sources = barrelstack::scenario::tree::Sources::default();
    sources.files.push(barrelstack::scenario::tree::SourceFile {
        name: String::new(),
        text: text.to_owned(),
        folder: std::path::PathBuf::new(),
    });
    let Ok(table) = sources.parse(0) else { return false };
    let text_of = |key: &str| match table.get(key).map(|entry| &entry.node.value) {
        Some(Value::Text(text)) => Some(text.as_str()),
        _ => None,
    };
    match (text_of("kind"), text_of("extends")) {
        (Some(kind), _) => kind == "cellar",
        (None, Some(name)) if built_in(name).is_some() => true,
        (None, Some(name)) if names_a_file(name) && depth > 0 => {
            let Some(folder) = path.and_then(Path::parent) else { return false };
            let next = folder.join(name);
            barrelstack_input::system::read(&next, 1 << 20)
                .is_ok_and(|bytes| is_cellar(Some(&next), &bytes, depth - 1))
        }
        (None, _) => false,
    }
}

fn names_a_file(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension == "toml")
}
