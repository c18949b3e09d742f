//! Places from which bodies start, as surveyed after an earthquake or as an earlier run has left them.

use std::collections::BTreeMap;

use barrelstack::scenario::Dimension;
use barrelstack::scenario::error::ScenarioError;
use barrelstack::scenario::field::{Default, Kind, Range};
use barrelstack::scenario::reader::{Reader, nearest};
use barrelstack::scenario::template::Host;
use barrelstack::scenario::tree::Table;
use barrelstack_dynamics::math;
use barrelstack_input::declared::Declared as _;
use barrelstack_input::writer::Writer;
use barrelstack_input::{FileRef, InputError, section, table};

use crate::plan::Model;
use crate::room::Shift;
use crate::scenario::Standing;

/// Maximum size (bytes) of a file of starting places.
const LIMIT: usize = 16 << 20;

/// Maximum number of tables [[start.shift]].
const MOST_SHIFTS: usize = 1000;

section! {
    /// A shift of a stack or of one of its bodies.
    #[derive(Clone, Debug, PartialEq)]
    pub struct ShiftSpec;
    /// A shift before the first shock, from the place at rest as built.
    pub static SHIFT = "shift";
    /// Stack: row and number in the row, such as "1-2".
    stack: String = Kind::Text, Default::Required;
    /// Body of the stack, such as "B2.1".
    body: Option<String> = Kind::Text, Default::Derived("all bodies of the stack");
    /// Displacement along x, y and z of the room.
    by: [f64; 3] = Kind::Triple(Dimension::LENGTH), Default::Value("[\"0 m\", \"0 m\", \"0 m\"]");
    /// Turn, counterclockwise from above; of a body about its center of mass, of a stack about the middle of its
    /// footprint.
    turn: f64 = Kind::Quantity(&[Dimension::ANGLE], Range::between(-7.0, 7.0)), Default::Value("\"0 deg\"");
}

table! {
    /// Places from which bodies start, such as surveyed after an earthquake. The others start as built.
    pub static START = "start";
    /// CSV file, relative to this file, with a row for each stack or body: columns `stack` and `body` (empty: the whole
    /// stack), and shifts `dx (m)`, `dy (m)`, `dz (m)`, `turn (deg)`; or poses in the frame of the stack `x (m)`,
    /// `y (m)`, `z (m)`, `qw`, `qx`, `qy`, `qz`, of all bodies of a stack.
    file = Kind::Text, Default::Nothing;
    /// Shifts, in this order, after those of the file.
    shift = Kind::Tables(&SHIFT), Default::Nothing;
}

/// Places from which bodies start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StartSpec {
    /// File of shifts or poses.
    pub file: Option<FileRef>,
    /// Shifts after those of the file.
    pub shifts: Vec<ShiftSpec>,
}

impl StartSpec {
    /// `true` if all bodies start as built.
    pub fn is_as_built(&self) -> bool {
        self.file.is_none() && self.shifts.is_empty()
    }

    /// Reads the file into memory. A file that cannot be read is an error of the plan.
    pub(crate) fn hold(&mut self) {
        if let Some(file) = &mut self.file
            && let Ok(bytes) = file.read(LIMIT)
        {
            file.hold(bytes);
        }
    }

    /// Returns the same places with the file identified by its content.
    pub(crate) fn by_content(&self) -> Self {
        Self { file: self.file.as_ref().map(FileRef::by_content), ..self.clone() }
    }

    pub(crate) fn read(reader: Reader<'_>) -> Result<Self, InputError> {
        let file = reader.file("file")?;
        let shifts = reader.sections("shift")?;
        if shifts.len() > MOST_SHIFTS {
            let message = format!(
                "there are {} shifts; a cellar has at most {MOST_SHIFTS}: state more in a file",
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

/// Where a stack starts.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Begin {
    /// Poses of all bodies.
    pub(crate) poses: Option<Vec<[f64; 7]>>,
    /// Shifts after that.
    pub(crate) shifts: Vec<Shift>,
    /// Path in the scenario of what was stated last.
    pub(crate) path: String,
    /// Line of the file of what was stated last.
    pub(crate) line: Option<usize>,
}

/// Returns where every stack starts that does not start as built, by the name of the stack.
///
/// # Errors
/// If the file cannot be read, or a stack or a body is unknown.
pub(crate) fn begins(
    start: &StartSpec,
    host: &Host,
    stacks: &[Standing],
    models: &[Model],
) -> Result<BTreeMap<String, Begin>, ScenarioError> {
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
        let begin: &mut Begin = all.entry(shift.stack.clone()).or_default();
        begin.shifts.push(own);
        (begin.path, begin.line) = (path, None);
    }
    Ok(all)
}

/// Returns a shift along the axes of the room as a shift along those of a stack.
fn own_shift(standing: &Standing, body: Option<usize>, [x, y, z]: [f64; 3], turn: f64) -> Shift {
    let (sin, cos) = math::sin_cos(standing.azimuth);
    Shift { body, by: [cos * x + sin * y, cos * y - sin * x, z], turn }
}

/// Returns the end of a message that names the most similar of the valid names, or some of them.
fn valid(word: &str, known: &[&str]) -> String {
    match nearest(word, known) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => format!("there are \"{}\" to \"{}\"", known[0], known[known.len() - 1]),
    }
}

fn stack_named<'a>(
    name: &str,
    stacks: &'a [Standing],
    models: &'a [Model],
) -> Result<(&'a Standing, &'a Model), String> {
    match stacks.iter().find(|standing| standing.name == name) {
        Some(standing) => Ok((standing, &models[standing.model])),
        None => {
            let known: Vec<&str> = stacks.iter().map(|standing| standing.name.as_str()).collect();
            Err(format!("there is no stack \"{name}\"; {}", valid(name, &known)))
        }
    }
}

fn body_named(name: &str, stack: &str, model: &Model) -> Result<usize, String> {
    let known: Vec<&str> = model.stack.parts[1..].iter().map(|part| part.name.as_str()).collect();
    let found = known.iter().position(|known| *known == name);
    found
        .ok_or_else(|| format!("stack \"{stack}\" has no body \"{name}\"; {}", valid(name, &known)))
}

/// Columns of poses.
pub(crate) const POSE: [&str; 7] = ["x (m)", "y (m)", "z (m)", "qw", "qx", "qy", "qz"];

/// Columns of shifts.
const SHIFTED: [&str; 4] = ["dx (m)", "dy (m)", "dz (m)", "turn (deg)"];

/// Largest coordinate (m) of a pose, and largest displacement.
const FAR: f64 = 1000.0;

/// Reads a file of shifts or poses; an error states the line.
fn of_file(
    text: &str,
    stacks: &[Standing],
    models: &[Model],
    all: &mut BTreeMap<String, Begin>,
) -> Result<(), (usize, String)> {
    let cells = |line: &str| -> Vec<String> {
        line.split(',').map(|cell| cell.trim().trim_matches('"').to_owned()).collect()
    };
    let mut lines = (1..).zip(text.trim_start_matches('\u{feff}').lines());
    let mut lines = lines.by_ref().filter(|(_, line)| !line.trim().is_empty());
    let Some((first, header)) = lines.next() else {
        return Err((
            1,
            "the file is empty: its first line names the columns `stack`, `body` and \
 those of shifts or poses"
                .to_owned(),
        ));
    };
    let header = cells(header);
    let column = |name: &str| header.iter().position(|known| known == name);
    let known = |name: &String| {
        ["stack", "body"].iter().chain(&POSE).chain(&SHIFTED).any(|known| known == name)
    };
    if let Some(unknown) = header.iter().find(|name| !known(name)) {
        let columns = format!("stack, body, {} or {}", SHIFTED.join(", "), POSE.join(", "));
        return Err((first, format!("unknown column \"{unknown}\"; the columns are {columns}")));
    }
    let Some(stack_at) = column("stack") else {
        return Err((
            first,
            "there is no column `stack`: name the stack of each row, such as 1-2".to_owned(),
        ));
    };
    let pose_at = POSE.map(column);
    let shift_at = SHIFTED.map(column);
    let poses = pose_at.iter().any(Option::is_some);
    if poses
        && (shift_at.iter().any(Option::is_some)
            || pose_at.iter().any(Option::is_none)
            || column("body").is_none())
    {
        return Err((
            first,
            format!(
                "a file of poses has the columns stack, body, {}, and no \
 others",
                POSE.join(", ")
            ),
        ));
    }
    if !poses && shift_at.iter().all(Option::is_none) {
        return Err((
            first,
            format!(
                "there is no column of shifts: state at least \
 one of {}",
                SHIFTED.join(", ")
            ),
        ));
    }
    let mut found: BTreeMap<String, (BTreeMap<usize, [f64; 7]>, usize)> = BTreeMap::new();
    for (line, row) in lines {
        let row = cells(row);
        if row.len() != header.len() {
            return Err((
                line,
                format!(
                    "there are {} cells, but {} columns: fill every cell, with 0 where \
 nothing moved",
                    row.len(),
                    header.len()
                ),
            ));
        }
        let number = |at: Option<usize>, name: &str| -> Result<f64, (usize, String)> {
            let Some(at) = at else { return Ok(0.0) };
            let value = row[at].parse::<f64>().ok().filter(|value| value.abs() <= FAR);
            value.ok_or_else(|| {
                (
                    line,
                    format!(
                        "column \"{name}\": expected a number up to {FAR} in magnitude, \
 found \"{}\"",
                        row[at]
                    ),
                )
            })
        };
        let name = &row[stack_at];
        let (standing, model) = stack_named(name, stacks, models)
            .map_err(|message| (line, format!("column \"stack\": {message}")))?;
        let body = column("body").map(|at| row[at].as_str()).filter(|body| !body.is_empty());
        let body = body
            .map(|body| body_named(body, name, model))
            .transpose()
            .map_err(|message| (line, format!("column \"body\": {message}")))?;
        if !poses {
            let mut values = [0.0; 4];
            for (value, (at, name)) in values.iter_mut().zip(shift_at.into_iter().zip(SHIFTED)) {
                *value = number(at, name)?;
            }
            let [x, y, z, degrees] = values;
            let begin = all.entry(name.clone()).or_default();
            begin.shifts.push(own_shift(standing, body, [x, y, z], degrees.to_radians()));
            (begin.path, begin.line) = ("start.file".to_owned(), Some(line));
            continue;
        }
        let Some(body) = body else {
            return Err((line, "column \"body\": a pose needs the name of its body".to_owned()));
        };
        let mut pose = [0.0; 7];
        for (value, (at, name)) in pose.iter_mut().zip(pose_at.into_iter().zip(POSE)) {
            *value = number(at, name)?;
        }
        let size = pose[3..].iter().map(|part| part * part).sum::<f64>().sqrt();
        if (size - 1.0).abs() > 1e-6 {
            return Err((
                line,
                format!(
                    "columns qw, qx, qy, qz: expected a quaternion of length one, \
 found length {size}"
                ),
            ));
        }
        let (bodies, last) = found.entry(name.clone()).or_default();
        *last = line;
        if bodies.insert(body, pose).is_some() {
            return Err((
                line,
                format!(
                    "a second pose of body \"{}\" of stack \"{name}\": leave one of \
 them out",
                    model.stack.parts[body + 1].name
                ),
            ));
        }
    }
    for (name, (bodies, line)) in found {
        let (_, model) = stack_named(&name, stacks, models).map_err(|message| (line, message))?;
        let missing = (0..model.stack.parts.len() - 1).find(|body| !bodies.contains_key(body));
        if let Some(body) = missing {
            return Err((
                line,
                format!(
                    "stack \"{name}\": there is no pose of body \"{}\"; state the poses \
 of all its bodies",
                    model.stack.parts[body + 1].name
                ),
            ));
        }
        let begin = all.entry(name).or_default();
        begin.poses = Some(bodies.into_values().collect());
        (begin.path, begin.line) = ("start.file".to_owned(), Some(line));
    }
    Ok(())
}
