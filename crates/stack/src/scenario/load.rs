//! Loading of scenarios from files, text or values, with overrides.

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

use super::error::{Place, Problem, ScenarioError};
use super::field::Section;
use super::reader::{Reader, nearest};
use super::title::Own;
use super::tree::{Entry, Node, Origin, SourceFile, Sources, Table, Value};
use super::{Scenario, Written, builtin, merge, renamed, root};
use crate::system;

/// Maximum size of a scenario file (bytes).
const SIZE_LIMIT: usize = 1 << 20;

/// Maximum number of bytes that are read from a file. This number exceeds [`SIZE_LIMIT`], so that the size of a file
/// that is too large can be reported.
const READ_LIMIT: usize = 256 << 20;

/// Maximum number of scenarios in a chain of `extends`.
const CHAIN_LIMIT: usize = 8;

/// Kinds of scenarios that `extends` may name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Access {
    /// Files and built-in scenarios.
    Files,
    /// Built-in scenarios only.
    BuiltinOnly,
}

/// A kind of file: its fields, and the files of this kind that come with the program.
#[derive(Clone, Copy, Debug)]
pub struct Language {
    /// Definition of the fields at the top level of the file.
    pub root: &'static Section,
    /// Returns the text of a built-in file.
    pub builtin: fn(&str) -> Option<&'static str>,
    /// Returns the names of all built-in files.
    pub names: fn() -> Vec<&'static str>,
}

/// Scenario files: their fields, and the built-in scenarios.
pub(super) const SCENARIO: Language =
    Language { root: &root::ROOT, builtin: builtin::get, names: || builtin::names().collect() };

impl Scenario {
    /// Reads a scenario from text; [`Scenario::parse`] also takes overrides and a name for error messages.
    ///
    /// ```
    /// use barrelstack_stack::Scenario;
    ///
    /// let run = Scenario::from_str("schema = 1\nextends = \"sliding-block\"")?.run()?;
    /// assert_eq!(run.outcome.kind(), "not-judged");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Same as [`Scenario::parse`].
    #[expect(
        clippy::should_implement_trait,
        reason = "the trait is also implemented, but this function needs no import"
    )]
    pub fn from_str(text: &str) -> Result<Self, ScenarioError> {
        Self::parse("scenario", text, &[])
    }

    /// Reads a scenario file and the files it extends; [`Scenario::load`] also takes overrides.
    ///
    /// # Errors
    ///
    /// Same as [`Scenario::load`].
    pub fn from_path(path: impl AsRef<Path>) -> Result<Self, ScenarioError> {
        Self::load(path.as_ref(), &[])
    }

    /// Reads a scenario from text, without access to the file system.
    ///
    /// `source_name` is the path shown in errors; relative paths in the scenario are relative to
    /// its folder.
    ///
    /// An override is `path=value`, such as `stack.levels=5` or `motion.scale.pgv=60 cm/s`. The value is read as TOML;
    /// a value that is not valid TOML is taken as a string. List items are addressed by name (`body.block.mass`), and
    /// interfaces by pair (`interface.block-ground.stiffness`). Both can also be addressed by number, counted from 1.
    /// `extends` may name a built-in scenario only.
    ///
    /// ```
    /// use barrelstack_stack::scenario::Scenario;
    ///
    /// let text = "schema = 1\nextends = \"candia-8-barrels\"";
    /// let scenario = Scenario::parse("five.toml", text, &["stack.levels=5".to_owned()])?;
    /// assert_eq!(scenario.stack().map(|stack| stack.levels), Some(5));
    /// # Ok::<(), barrelstack_stack::scenario::ScenarioError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the first problem found, with its place in the text.
    pub fn parse(
        source_name: &str,
        text: &str,
        overrides: &[String],
    ) -> Result<Self, ScenarioError> {
        read(source_name, text.as_bytes(), overrides, Access::BuiltinOnly)
    }

    /// Reads a scenario like [`Scenario::parse`], from bytes that are expected to be UTF-8.
    ///
    /// # Errors
    ///
    /// Same as [`Scenario::parse`]; also if the bytes are not UTF-8.
    pub fn parse_bytes(
        source_name: &str,
        bytes: &[u8],
        overrides: &[String],
    ) -> Result<Self, ScenarioError> {
        read(source_name, bytes, overrides, Access::BuiltinOnly)
    }

    /// Reads a scenario file and the files it extends.
    ///
    /// # Errors
    ///
    /// Same as [`Scenario::parse_bytes`]; also if a file cannot be read.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self, ScenarioError> {
        Self::parse_file(path, &bytes_of(path)?, overrides)
    }

    /// Reads a scenario like [`Scenario::load`], from the bytes of its file. This allows the file to be a pipe, which
    /// can be read only once.
    ///
    /// # Errors
    ///
    /// Same as [`Scenario::load`].
    pub fn parse_file(
        path: &Path,
        bytes: &[u8],
        overrides: &[String],
    ) -> Result<Self, ScenarioError> {
        read(&path.display().to_string(), bytes, overrides, Access::Files)
    }

    /// Reads a scenario from a tree of values, such as the values that another program passes.
    ///
    /// Relative paths are relative to the current folder, and errors name the path of the value.
    ///
    /// ```
    /// use barrelstack_stack::scenario::Scenario;
    /// use barrelstack_stack::scenario::tree::{Entry, Node, Origin, Table, Value};
    ///
    /// let node = |value| Node { origin: Origin::Default, value };
    /// let entry = |key: &str, value| Entry {
    ///     key: key.to_owned(),
    ///     origin: Origin::Default,
    ///     node: node(value),
    /// };
    /// let extends = entry("extends", Value::Text("candia-8-barrels".to_owned()));
    /// let levels = Table { entries: vec![entry("levels", Value::Float(2.5))] };
    /// let tree = Table { entries: vec![extends, entry("stack", Value::Table(levels))] };
    /// let error = Scenario::from_tree("mine", tree).unwrap_err();
    /// assert!(error.sentence().starts_with("override `stack.levels=2.5`: "));
    /// ```
    ///
    /// # Errors
    ///
    /// Same as [`Scenario::load`].
    pub fn from_tree(name: &str, mut tree: Table) -> Result<Self, ScenarioError> {
        let mut sources = Sources::default();
        add_source(&mut sources, name, &[], PathBuf::new())?;
        sources.adopt(&mut tree);
        if tree.get("schema").is_none() {
            let schema = Value::Integer(Some(i64::from(root::SCHEMA)));
            let node = Node { origin: Origin::Whole(0), value: schema };
            tree.set(Entry { key: "schema".to_owned(), origin: Origin::Whole(0), node });
        }
        let table = extend(&mut sources, tree, 0, Access::Files, &SCENARIO)?;
        let own = own_title(&sources, &table);
        finished(sources, table, Vec::new(), own)
    }

    /// Returns the scenario with further overrides as in [`Scenario::parse`]. They replace earlier overrides of the
    /// same fields.
    ///
    /// A record in memory ([`Scenario::with_record`]) is not part of the text and is not kept.
    ///
    /// ```
    /// use barrelstack_stack::scenario::Scenario;
    ///
    /// let three = Scenario::builtin("demo-napa", &["stack.levels=3".to_owned()])?;
    /// let six = three.with(&["stack.levels=6".to_owned()])?;
    /// assert_eq!(six, Scenario::builtin("demo-napa", &["stack.levels=6".to_owned()])?);
    /// # Ok::<(), barrelstack_stack::scenario::ScenarioError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the first problem found, with its place in the text.
    pub fn with(&self, overrides: &[String]) -> Result<Self, ScenarioError> {
        let Some((sources, table)) = self.written.source.as_deref() else {
            return Self::parse("scenario", &self.to_resolved_toml(), overrides);
        };
        let (mut sources, mut table) = (sources.clone(), table.clone());
        let first = sources.overrides.len();
        sources.overrides.extend_from_slice(overrides);
        merge::apply_overrides(&mut table, &root::ROOT, &sources, first)?;
        finished(sources, table, self.written.warnings.clone(), self.written.own.clone())
    }

    /// Reads a built-in scenario.
    ///
    /// # Errors
    ///
    /// If there is no scenario with this name, or an override is invalid.
    pub fn builtin(name: &str, overrides: &[String]) -> Result<Self, ScenarioError> {
        let Some(text) = builtin::get(name) else {
            let place = Place::Whole { file: name.to_owned() };
            return Err(ScenarioError::new(unknown_builtin("scenario", name, &SCENARIO), place));
        };
        Self::parse(&format!("{name}.toml"), text, overrides)
    }
}

impl FromStr for Scenario {
    type Err = ScenarioError;

    fn from_str(text: &str) -> Result<Self, ScenarioError> {
        Self::from_str(text)
    }
}

pub(super) fn unknown_builtin(field: &str, name: &str, language: &Language) -> Problem {
    let valid = (language.names)();
    Problem::UnknownName {
        field: field.to_owned(),
        found: super::quantity::shorten(name),
        nearest: nearest(name, &valid),
        valid: valid.iter().map(|name| (*name).to_owned()).collect(),
    }
}

/// Reads the file of a scenario or of a cellar, and returns its bytes.
///
/// # Errors
/// If the file cannot be read.
pub fn bytes_of(path: &Path) -> Result<Vec<u8>, ScenarioError> {
    read_file(path, Place::Whole { file: path.display().to_string() })
}

pub(super) fn read_file(path: &Path, place: Place) -> Result<Vec<u8>, ScenarioError> {
    system::read(path, READ_LIMIT).map_err(|error| {
        // The error is placed in the file that extends this one, so the path is added.
        let reason = match &place {
            Place::Whole { .. } => error,
            Place::File { .. } | Place::Override { .. } | Place::Unknown => {
                format!("{}: {error}", path.display())
            }
        };
        ScenarioError::new(Problem::Unreadable { reason }, place)
    })
}

fn read(
    name: &str,
    bytes: &[u8],
    overrides: &[String],
    access: Access,
) -> Result<Scenario, ScenarioError> {
    let (mut sources, mut table) = merged(name, bytes, &[], access, &SCENARIO)?;
    let own = own_title(&sources, &table);
    sources.overrides = overrides.to_vec();
    merge::apply_overrides(&mut table, &root::ROOT, &sources, 0)?;
    finished(sources, table, Vec::new(), own)
}

/// Returns the title that the user wrote, with the stack and the motion to which the title applies. The stack and the
/// motion are read from the given table, to which no override has been applied. Returns `None` if the file has no
/// title, or if its title is the title of a built-in scenario.
fn own_title(sources: &Sources, table: &Table) -> Option<Own> {
    let node = &table.get("title")?.node;
    let Value::Text(title) = &node.value else { return None };
    if builtin::titles().any(|known| known == title) {
        return None;
    }
    // A title in an extended file was written for the values of that file, which are not known here.
    let here = matches!(node.origin, Origin::File { file: 0, .. } | Origin::Whole(0));
    let stated = if here { resolved(sources, &mut table.clone()).ok() } else { None };
    Own::of(title, stated.as_ref().map(|(scenario, _)| scenario))
}

/// Replaces former keys in a table by current keys, and reads the scenario from the table. Returns the scenario with a
/// warning for each former key.
fn resolved(
    sources: &Sources,
    table: &mut Table,
) -> Result<(Scenario, Vec<String>), ScenarioError> {
    let warnings = renamed::renew(table, sources)?;
    merge::expand_names(table, &root::ROOT);
    let reader =
        Reader::open(sources, &root::ROOT, String::new(), Some(&*table), Origin::Whole(0))?;
    Ok((root::read(reader, &stem(&sources.files[0].name))?, warnings))
}

/// Parses the bytes of a file, overlays its table on the tables of the files that it extends, and applies the
/// overrides.
pub(super) fn merged(
    name: &str,
    bytes: &[u8],
    overrides: &[String],
    access: Access,
    language: &Language,
) -> Result<(Sources, Table), ScenarioError> {
    let mut sources = Sources { files: Vec::new(), overrides: overrides.to_vec() };
    let folder = Path::new(name).parent().map(Path::to_path_buf).unwrap_or_default();
    add_source(&mut sources, name, bytes, folder)?;
    let table = parsed(&sources, 0)?;
    let mut table = extend(&mut sources, table, 0, access, language)?;
    merge::apply_overrides(&mut table, language.root, &sources, 0)?;
    Ok((sources, table))
}

/// Builds the scenario from a table to which all overrides have been applied.
///
/// The warnings of the scenario are the given `warnings`, followed by those about former keys in the table. `own` is
/// the title that the user wrote; if there is none, a generated title replaces an outdated one.
pub(super) fn finished(
    sources: Sources,
    mut table: Table,
    mut warnings: Vec<String>,
    own: Option<Own>,
) -> Result<Scenario, ScenarioError> {
    let (mut scenario, renewed) = resolved(&sources, &mut table)?;
    warnings.extend(renewed);
    let applies = title_applies(&sources, &table);
    let own = match table.get("title").map(|title| title.node.origin) {
        Some(Origin::Override(_)) => Own::of(&scenario.title, Some(&scenario)),
        _ => own,
    };
    scenario.written = Written { source: Some(Arc::new((sources, table))), warnings, own };
    if !applies {
        scenario.retitle();
    }
    Ok(scenario)
}

/// Returns `true` if the title (or the name of the file, if there is no title) describes what the table contains. A
/// title from an extended file, or from before an override, may be outdated.
pub(super) fn title_applies(sources: &Sources, table: &Table) -> bool {
    let parts = ["run.", "record.", "imperfections.", "unknowns."];
    let kept = |change: &String| parts.iter().any(|part| change.starts_with(part));
    let unchanged = sources.overrides.iter().all(kept);
    match table.get("title").map(|title| title.node.origin) {
        Some(Origin::File { file, .. } | Origin::Whole(file)) => file == 0 && unchanged,
        Some(Origin::Override(_)) => true,
        Some(Origin::Default) | None => unchanged,
    }
}

pub(super) fn stem(name: &str) -> String {
    Path::new(name)
        .file_stem()
        .map_or_else(|| name.to_owned(), |s| s.to_string_lossy().into_owned())
}

pub(super) fn add_source(
    sources: &mut Sources,
    name: &str,
    bytes: &[u8],
    folder: PathBuf,
) -> Result<(), ScenarioError> {
    let whole = || Place::Whole { file: name.to_owned() };
    if bytes.len() > SIZE_LIMIT {
        let problem = Problem::TooLarge { size: bytes.len(), limit: SIZE_LIMIT };
        return Err(ScenarioError::new(problem, whole()));
    }
    let text = std::str::from_utf8(bytes).map_err(|error| {
        ScenarioError::new(Problem::NotText { offset: error.valid_up_to() }, whole())
    })?;
    let text = text.to_owned();
    sources.files.push(SourceFile { name: name.to_owned(), text, folder });
    Ok(())
}

fn parsed(sources: &Sources, file: usize) -> Result<Table, ScenarioError> {
    let table = sources.parse(file)?;
    if table.entries.is_empty() {
        let message = "the scenario is empty; start from a built-in one with `extends = \"candia-8-barrels\"`";
        let problem = Problem::Inconsistent { message: message.to_owned() };
        return Err(sources.error(Origin::Whole(file), problem));
    }
    Ok(table)
}

/// Overlays the table of a file on the tables of the scenarios that the file extends.
pub(super) fn extend(
    sources: &mut Sources,
    table: Table,
    file: usize,
    access: Access,
    language: &Language,
) -> Result<Table, ScenarioError> {
    let mut tables: Vec<Table> = Vec::new();
    let mut next = Some((table, file));
    while let Some((mut table, file)) = next {
        next = match table.get("extends").map(|entry| entry.node.clone()) {
            None => None,
            Some(node) => {
                table.remove("extends");
                let problem = |problem| sources.error(node.origin, problem);
                let Value::Text(target) = &node.value else {
                    return Err(problem(Problem::WrongType {
                        field: "extends".to_owned(),
                        expected: "the name of a built-in scenario or a file".to_owned(),
                        found: node.value.describe(),
                    }));
                };
                let is_file = Path::new(target).extension().is_some_and(|e| e == "toml");
                let (name, bytes, folder) = if is_file {
                    if access == Access::BuiltinOnly {
                        let message = format!(
                            "the file \"{target}\" can be extended only by a scenario that is itself read \
                             from a file; extend a built-in scenario instead"
                        );
                        return Err(problem(Problem::Inconsistent { message }));
                    }
                    let path = sources.files[file].folder.join(target);
                    let name = path.display().to_string();
                    let place = sources.place(node.origin);
                    let bytes = read_file(&path, place)?;
                    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
                    (name, bytes, folder)
                } else {
                    let text = (language.builtin)(target)
                        .ok_or_else(|| problem(unknown_builtin("extends", target, language)))?;
                    (format!("{target}.toml"), text.as_bytes().to_vec(), PathBuf::new())
                };
                if tables.len() + 1 >= CHAIN_LIMIT {
                    let message = format!(
                        "more than {CHAIN_LIMIT} scenarios extend one another; check whether one of them extends itself"
                    );
                    return Err(problem(Problem::Inconsistent { message }));
                }
                add_source(sources, &name, &bytes, folder)?;
                let file = sources.files.len() - 1;
                Some((parsed(sources, file)?, file))
            }
        };
        tables.push(table);
    }
    let mut total = tables.pop().unwrap_or_default();
    while let Some(above) = tables.pop() {
        merge::overlay(&mut total, above, Some(language.root));
    }
    Ok(total)
}
