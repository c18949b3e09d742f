//! Initial poses of bodies, as surveyed after an earthquake or as an earlier run has left them.

use std::collections::BTreeMap;

use barrelstack::scenario::Dimension;
use barrelstack::scenario::error::ScenarioError;
use barrelstack::scenario::field::{Default, Kind, Range};
use barrelstack::scenario::reader::Reader;
use barrelstack::scenario::template::Host;
use barrelstack::scenario::tree::Table;
use barrelstack_dynamics::math;
use barrelstack_input::declared::Declared as _;
use barrelstack_input::names::advice;
use barrelstack_input::writer::Writer;
use barrelstack_input::{FileRef, InputError, section, table};

use crate::plan::Model;
use crate::room::Shift;
use crate::scenario::Standing;

/// Maximum size (bytes) of a file of initial poses or shifts.
const LIMIT: usize = 16 << 20;

/// Maximum number of `[[start.shift]]` tables.
const MOST_SHIFTS: usize = 1000;

section! {
    /// A shift of a stack or of one of its bodies.
    #[derive(Clone, Debug, PartialEq)]
    pub struct ShiftSpec;
    /// A shift of a stack or of one of its bodies before the first shock, relative to its position at rest as built.
    pub static SHIFT = "shift";
    /// Name of the stack: its row and its number in the row, such as "1-2".
    stack: String = Kind::Text, Default::Required;
    /// Name of the body of the stack, such as "B2.1".
    body: Option<String> = Kind::Text, Default::Derived("all bodies of the stack");
    /// Displacement along x, y and z of the room.
    by: [f64; 3] = Kind::Triple(Dimension::LENGTH), Default::Value("[\"0 m\", \"0 m\", \"0 m\"]");
    /// Angle of rotation, counterclockwise from above. A body turns about its center of mass, a stack about the middle
    /// of its footprint.
    turn: f64 = Kind::Quantity(&[Dimension::ANGLE], Range::between(-7.0, 7.0)), Default::Value("\"0 deg\"");
}

table! {
    /// Places from which bodies start, such as those surveyed after an earthquake. All other bodies start as built.
    pub static START = "start";
    /// CSV file with one row for each stack or body; its path is relative to this file. It has the columns `stack` and
    /// `body` (empty for the whole stack), and either shifts (`dx (m)`, `dy (m)`, `dz (m)`, `turn (deg)`) or, for all
    /// bodies of a stack, poses in the frame of the stack (`x (m)`, `y (m)`, `z (m)`, `qw`, `qx`, `qy`, `qz`).
    file = Kind::Text, Default::Nothing;
    /// Shifts, applied in the order of this list, after the shifts in `file`.
    shift = Kind::Tables(&SHIFT), Default::Nothing;
}

/// Initial poses of bodies that do not start as built, stated as poses or as shifts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StartSpec {
    /// File of shifts or poses.
    pub file: Option<FileRef>,
    /// Shifts, applied after the shifts or poses of the file.
    pub shifts: Vec<ShiftSpec>,
}

impl StartSpec {
    /// `true` if all bodies start as built.
    pub fn is_as_built(&self) -> bool {
        self.file.is_none() && self.shifts.is_empty()
    }

    /// Reads the file into memory, if there is one. If it cannot be read, does nothing: [`starts`] then reads it
    /// again and returns the error.
    pub(crate) fn hold(&mut self) {
        if let Some(file) = &mut self.file
            && let Ok(bytes) = file.read(LIMIT)
        {
            file.hold(bytes);
        }
    }

    /// Returns a copy in which the path of the file is replaced by a fingerprint of its content, if it was read.
    pub(crate) fn by_content(&self) -> Self {
        Self { file: self.file.as_ref().map(FileRef::by_content), ..self.clone() }
    }

    pub(crate) fn read(reader: Reader<'_>) -> Result<Self, InputError> {
        let file = reader.file("file")?;
        let shifts = reader.sections("shift")?;
        if shifts.len() > MOST_SHIFTS {
            let message = format!(
                "there are {} tables of shifts, but a scenario may have at most {MOST_SHIFTS}: write the shifts to a \
                 file",
                shifts.len()
            );
            return Err(reader.inconsistent("shift", message));
        }
        let shifts = shifts.into_iter().map(ShiftSpec::read).collect::<Result<_, _>>()?;
        reader.finish();
        Ok(Self { file, shifts })
    }

    pub(crate) fn write(&self) -> Table {
        let mut writer = Writer::new(&START);
        writer.optional_text("file", self.file.as_ref().map(|file| file.path.as_str()));
        writer.tables("shift", self.shifts.iter().map(ShiftSpec::write).collect());
        writer.finish()
    }
}

/// Stated initial poses and shifts of the bodies of a stack.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct StackStart {
    /// Stated poses of all bodies of the stack; `None` to start from the poses at rest.
    pub(crate) poses: Option<Vec<[f64; 7]>>,
    /// Shifts, applied one after another to `poses`, or to the poses at rest if `poses` is `None`.
    pub(crate) shifts: Vec<Shift>,
    /// Key path of the last entry in the cellar file that moves the stack: `start.file`, or a shift such as
    /// `start.shift.2`.
    pub(crate) path: String,
    /// If `path` is `start.file`, the line of that file with the last pose or shift of the stack; otherwise `None`.
    pub(crate) line: Option<usize>,
}

/// Returns the stated initial poses and shifts of all stacks that do not start as built, by the name of the stack.
///
/// # Errors
/// If the file cannot be read or is invalid, or a stack or a body is unknown.
pub(crate) fn starts(
    start: &StartSpec,
    host: &Host,
    stacks: &[Standing],
    models: &[Model],
) -> Result<BTreeMap<String, StackStart>, ScenarioError> {
    let mut all = BTreeMap::new();
    if let Some(file) = &start.file {
        let wrong = |message: String| host.error(&["start.file"], message);
        let name = file.resolve().display().to_string();
        let bytes = file.read(LIMIT).map_err(|reason| {
            wrong(format!(
                "cannot read {name}: {reason}; correct the path, which is relative to \
 this file"
            ))
        })?;
        let text = std::str::from_utf8(&bytes)
            .map_err(|_| wrong(format!("{name} is not text in UTF-8: save it as CSV in UTF-8")))?;
        of_file(text, stacks, models, &mut all)
            .map_err(|(line, message)| wrong(format!("{name}:{line}: {message}")))?;
    }
    for (at, shift) in (1..).zip(&start.shifts) {
        let path = format!("start.shift.{at}");
        let wrong = |(field, message): (&str, String)| {
            host.error(&[&format!("{path}.{field}"), &path], message)
        };
        let (standing, model) = stack_named(&shift.stack, stacks, models)
            .map_err(|message| wrong(("stack", message)))?;
        let body = shift.body.as_deref().map(|body| body_named(body, &shift.stack, model));
        let body = body.transpose().map_err(|message| wrong(("body", message)))?;
        let own = own_shift(standing, body, shift.by, shift.turn);
        let stated: &mut StackStart = all.entry(shift.stack.clone()).or_default();
        stated.shifts.push(own);
        (stated.path, stated.line) = (path, None);
    }
    Ok(all)
}

/// Converts a shift along the axes of the room to the axes of a stack.
fn own_shift(standing: &Standing, body: Option<usize>, [x, y, z]: [f64; 3], turn: f64) -> Shift {
    let (sin, cos) = math::sin_cos(standing.azimuth);
    Shift { body, by: [cos * x + sin * y, cos * y - sin * x, z], turn }
}

fn stack_named<'a>(
    name: &str,
    stacks: &'a [Standing],
    models: &'a [Model],
) -> Result<(&'a Standing, &'a Model), String> {
    if let Some(standing) = stacks.iter().find(|standing| standing.name == name) {
        return Ok((standing, &models[standing.model]));
    }
    let known: Vec<&str> = stacks.iter().map(|standing| standing.name.as_str()).collect();
    Err(format!("there is no stack \"{name}\"; {}", advice(name, &known)))
}

fn body_named(name: &str, stack: &str, model: &Model) -> Result<usize, String> {
    let known: Vec<&str> = model.stack.parts[1..].iter().map(|part| part.name.as_str()).collect();
    let found = known.iter().position(|known| *known == name);
    found.ok_or_else(|| {
        format!("stack \"{stack}\" has no body \"{name}\"; {}", advice(name, &known))
    })
}

/// Names of the columns that state a pose in a CSV file.
pub(crate) const POSE: [&str; 7] = ["x (m)", "y (m)", "z (m)", "qw", "qx", "qy", "qz"];

/// Names of the columns that state a shift in a CSV file.
const SHIFTED: [&str; 4] = ["dx (m)", "dy (m)", "dz (m)", "turn (deg)"];

/// Largest magnitude of a number in a file of initial poses or shifts, in the unit of its column.
const FAR: f64 = 1000.0;

/// Returns the cells of a line of a CSV file.
fn cells(line: &str) -> Vec<String> {
    line.split(',').map(|cell| cell.trim().trim_matches('"').to_owned()).collect()
}

/// Columns of a file of initial poses or shifts, as named in its header.
struct Columns {
    names: Vec<String>,
    /// `true` for poses, `false` for shifts.
    poses: bool,
}

impl Columns {
    fn of(header: &str) -> Result<Self, String> {
        let names = cells(header);
        let has = |name: &str| names.iter().any(|known| known == name);
        let known = |name: &str| {
            ["stack", "body"].contains(&name) || POSE.contains(&name) || SHIFTED.contains(&name)
        };
        if let Some(unknown) = names.iter().find(|name| !known(name)) {
            let all: Vec<&str> = ["stack", "body"].into_iter().chain(SHIFTED).chain(POSE).collect();
            return Err(format!("unknown column \"{unknown}\": {}", advice(unknown, &all)));
        }
        if !has("stack") {
            return Err(
                "there is no column `stack`: name the stack of each row, such as 1-2".into()
            );
        }
        let [poses, shifts] = [&POSE[..], &SHIFTED].map(|all| all.iter().any(|name| has(name)));
        if poses && (shifts || !has("body") || !POSE.iter().all(|name| has(name))) {
            let all = POSE.join(", ");
            return Err(format!(
                "a file of poses has the columns stack, body, {all}, and no others"
            ));
        }
        if !poses && !shifts {
            let all = SHIFTED.join(", ");
            return Err(format!("there is no column of shifts: state at least one of {all}"));
        }
        Ok(Self { names, poses })
    }

    /// Splits a line into the cells of a row, one for each column.
    fn row(&self, line: &str) -> Result<Row<'_>, String> {
        let cells = cells(line);
        if cells.len() != self.names.len() {
            return Err(format!(
                "expected {} cells, one for each column of the header, found {}: fill every cell, with 0 where \
                 nothing moved",
                self.names.len(),
                cells.len()
            ));
        }
        Ok(Row { columns: self, cells })
    }
}

/// A row of a file of initial poses or shifts.
struct Row<'a> {
    columns: &'a Columns,
    cells: Vec<String>,
}

impl Row<'_> {
    fn text(&self, name: &str) -> &str {
        let at = self.columns.names.iter().position(|known| known == name);
        at.map_or("", |at| &self.cells[at])
    }

    /// Parses the cells of the columns `names` as numbers; zero for a column that the file does not have.
    fn numbers<const N: usize>(&self, names: [&str; N]) -> Result<[f64; N], String> {
        let mut all = [0.0; N];
        for (value, name) in all.iter_mut().zip(names) {
            if !self.columns.names.iter().any(|known| known == name) {
                continue;
            }
            let text = self.text(name);
            let read = text.parse::<f64>().ok().filter(|value| value.abs() <= FAR);
            *value = read.ok_or_else(|| {
                format!(
                    "column \"{name}\": expected a number up to {FAR} in magnitude, found \"{text}\""
                )
            })?;
        }
        Ok(all)
    }
}

/// Poses of the bodies of a stack, by body index, and the line of the file that states the last of these poses.
type Posed = (BTreeMap<usize, [f64; 7]>, usize);

/// Reads a file of shifts or poses; an error consists of the line number and the message.
fn of_file(
    text: &str,
    stacks: &[Standing],
    models: &[Model],
    all: &mut BTreeMap<String, StackStart>,
) -> Result<(), (usize, String)> {
    let lines = (1..).zip(text.trim_start_matches('\u{feff}').lines());
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty());
    let Some((first, header)) = lines.next() else {
        let message = "the file is empty: its first line must name the columns `stack` and `body`, and the columns of \
                       the shifts or poses";
        return Err((1, message.to_owned()));
    };
    let columns = Columns::of(header).map_err(|message| (first, message))?;
    let (mut posed, mut shifted) = (BTreeMap::<String, Posed>::new(), BTreeMap::new());
    for (line, text) in lines {
        let at_line = |message| (line, message);
        let row = columns.row(text).map_err(at_line)?;
        let name = row.text("stack");
        let in_column = |column: &'static str| move |text| format!("column \"{column}\": {text}");
        let found = stack_named(name, stacks, models).map_err(in_column("stack"));
        let (standing, model) = found.map_err(at_line)?;
        let body = Some(row.text("body")).filter(|body| !body.is_empty());
        let body = body.map(|body| body_named(body, name, model).map_err(in_column("body")));
        let body = body.transpose().map_err(at_line)?;
        if columns.poses {
            add_pose(&row, model, body, line, &mut posed).map_err(at_line)?;
            continue;
        }
        if let Some(before) = shifted.insert((name.to_owned(), body), line) {
            let of = row.text("body");
            let of = if of.is_empty() { String::new() } else { format!("body \"{of}\" of ") };
            let message = format!(
                "a second row for {of}stack \"{name}\", after the row in line {before}: state the sum of both in one \
                 row"
            );
            return Err((line, message));
        }
        let [x, y, z, degrees] = row.numbers(SHIFTED).map_err(at_line)?;
        let stated = all.entry(name.to_owned()).or_default();
        stated.shifts.push(own_shift(standing, body, [x, y, z], degrees.to_radians()));
        (stated.path, stated.line) = ("start.file".to_owned(), Some(line));
    }
    for (name, (bodies, line)) in posed {
        let (_, model) = stack_named(&name, stacks, models).map_err(|message| (line, message))?;
        let parts = &model.stack.parts[1..];
        if let Some(missing) = (0..parts.len()).find(|body| !bodies.contains_key(body)) {
            let message = format!(
                "stack \"{name}\": there is no pose of body \"{}\"; state the poses of all its bodies",
                parts[missing].name
            );
            return Err((line, message));
        }
        let stated = all.entry(name).or_default();
        stated.poses = Some(bodies.into_values().collect());
        (stated.path, stated.line) = ("start.file".to_owned(), Some(line));
    }
    Ok(())
}

/// Reads the pose of a body from a row, and adds it to the poses of its stack.
fn add_pose(
    row: &Row<'_>,
    model: &Model,
    body: Option<usize>,
    line: usize,
    posed: &mut BTreeMap<String, Posed>,
) -> Result<(), String> {
    let Some(body) = body else {
        return Err("column \"body\": a pose needs the name of its body".to_owned());
    };
    let pose = row.numbers(POSE)?;
    let size = pose[3..].iter().map(|part| part * part).sum::<f64>().sqrt();
    if (size - 1.0).abs() > 1e-6 {
        return Err(format!(
            "columns qw, qx, qy, qz: expected a quaternion of length one, found length {size}"
        ));
    }
    let name = row.text("stack");
    let (bodies, last) = posed.entry(name.to_owned()).or_default();
    *last = line;
    match bodies.insert(body, pose) {
        Some(_) => Err(format!(
            "body \"{}\" of stack \"{name}\" has two poses: leave one of them out",
            model.stack.parts[body + 1].name
        )),
        None => Ok(()),
    }
}
