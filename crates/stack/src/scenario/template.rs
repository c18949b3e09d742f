//! Scenario templates: scenarios in which some values are still to be set, such as the base of a study.

use std::path::Path;

use super::error::{Place, Problem, ScenarioError};
use super::field::{Field, Section};
use super::load::{self, Access};
use super::reader::Reader;
use super::title::{CHANGED, without_changed};
use super::tree::{Entry, Node, Origin, Sources, Table, Value};
use super::{MotionSpec, Scenario, Written, merge, renamed, root};

pub use super::load::Language;

/// A scenario that is read repeatedly with different values.
///
/// Values carry the place where they were written, so that an error can name this place.
#[derive(Debug)]
pub struct Template {
    sources: Sources,
    table: Table,
    title: String,
    warnings: Vec<String>,
}

/// A parsed file that contains a scenario among other tables, such as a study.
pub struct Opened {
    /// The file and the files that it extends.
    pub sources: Sources,
    /// The whole content of the file.
    pub table: Table,
    access: Access,
}

impl Opened {
    /// Reads and parses a file.
    ///
    /// # Errors
    /// If the file cannot be read or is not TOML.
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        let name = path.display().to_string();
        let bytes = load::read_file(path, Place::Whole { file: name.clone() })?;
        Self::new(&name, &bytes, Access::Files)
    }

    /// Parses the text of a file, in which `extends` may name built-in scenarios only.
    ///
    /// # Errors
    /// If the text is not TOML.
    pub fn parse(name: &str, text: &str) -> Result<Self, ScenarioError> {
        Self::new(name, text.as_bytes(), Access::BuiltinOnly)
    }

    fn new(name: &str, bytes: &[u8], access: Access) -> Result<Self, ScenarioError> {
        let mut sources = Sources::default();
        let folder = Path::new(name).parent().map(Path::to_path_buf).unwrap_or_default();
        load::add_source(&mut sources, name, bytes, folder)?;
        let table = sources.parse(0)?;
        Ok(Self { sources, table, access })
    }

    /// Returns the name of the file without its extension.
    pub fn stem(&self) -> String {
        load::stem(&self.sources.files[0].name)
    }

    /// Returns the folder of the file.
    pub fn folder(&self) -> &Path {
        &self.sources.files[0].folder
    }

    /// Returns the scenario in the table with the given key, overlaid on the scenario that it extends.
    ///
    /// If `motion` is `true`, the scenario keeps its motion; otherwise, its ground stays at rest.
    ///
    /// # Errors
    /// If an extended scenario cannot be read.
    pub fn template(
        &self,
        key: &str,
        fallback_title: &str,
        motion: bool,
    ) -> Result<Template, ScenarioError> {
        let mut sources = self.sources.clone();
        let (table, origin) = match self.table.get(key) {
            Some(Entry { node: Node { value: Value::Table(table), origin }, .. }) => {
                (table.clone(), *origin)
            }
            _ => (Table::default(), Origin::Whole(0)),
        };
        let mut table = load::extend(&mut sources, table, 0, self.access, &load::SCENARIO)?;
        let warnings = renamed::renew(&mut table, &sources)?;
        let plain =
            |key: &str, value| Entry { key: key.to_owned(), origin, node: Node { origin, value } };
        if table.get("schema").is_none() {
            table.set(plain("schema", Value::Integer(Some(i64::from(root::SCHEMA)))));
        }
        if !motion {
            let none = plain("none", Value::Flag(true));
            table.set(plain("motion", Value::Table(Table { entries: vec![none] })));
        }
        Ok(Template { sources, table, title: fallback_title.to_owned(), warnings })
    }
}

/// A file of another kind, such as a cellar, that contains the tables of a stack scenario in addition to tables of its
/// own.
///
/// Values carry the place where they were written, so that an error can name this place.
#[derive(Clone, Debug)]
pub struct Host {
    sources: Sources,
    table: Table,
}

impl Host {
    /// Parses the bytes of a file, reads the files that it extends, and applies overrides as for a scenario
    /// ([`Scenario::parse`]).
    ///
    /// # Errors
    /// Returns the first problem found, with its place in the text. Bytes that are not UTF-8 are also an error.
    pub fn parse_file(
        path: &Path,
        bytes: &[u8],
        overrides: &[String],
        language: &Language,
    ) -> Result<Self, ScenarioError> {
        let name = path.display().to_string();
        let (sources, table) = load::merged(&name, bytes, overrides, Access::Files, language)?;
        Ok(Self { sources, table })
    }

    /// Parses the bytes of a file like [`Host::parse_file`], except that `extends` may name built-in files only.
    ///
    /// # Errors
    /// Same as [`Host::parse_file`].
    pub fn parse(
        name: &str,
        bytes: &[u8],
        overrides: &[String],
        language: &Language,
    ) -> Result<Self, ScenarioError> {
        let (sources, table) = load::merged(name, bytes, overrides, Access::BuiltinOnly, language)?;
        Ok(Self { sources, table })
    }

    /// Reads a built-in file.
    ///
    /// # Errors
    /// If there is no file with this name, or an override is invalid.
    pub fn builtin(
        name: &str,
        overrides: &[String],
        language: &Language,
    ) -> Result<Self, ScenarioError> {
        let Some(text) = (language.builtin)(name) else {
            let place = Place::Whole { file: name.to_owned() };
            return Err(ScenarioError::new(
                load::unknown_builtin("scenario", name, language),
                place,
            ));
        };
        Self::parse(&format!("{name}.toml"), text.as_bytes(), overrides, language)
    }

    /// Returns the file with further overrides, which replace earlier overrides of the same values.
    ///
    /// # Errors
    /// If an override is invalid.
    pub fn with(&self, overrides: &[String], language: &Language) -> Result<Self, ScenarioError> {
        let mut changed = self.clone();
        let first = changed.sources.overrides.len();
        changed.sources.overrides.extend_from_slice(overrides);
        merge::apply_overrides(&mut changed.table, language.root, &changed.sources, first)?;
        Ok(changed)
    }

    /// Returns a reader of the top-level table of the file, with the fields of `section`.
    ///
    /// # Errors
    /// If the file has a key that `section` does not have.
    pub fn reader(&self, section: &'static Section) -> Result<Reader<'_>, ScenarioError> {
        Reader::open(&self.sources, section, String::new(), Some(&self.table), Origin::Whole(0))
    }

    /// Returns a title that was read from the file. Appends ", changed" if overrides changed the content that the title
    /// describes, or if the title comes from an extended file.
    pub fn titled(&self, title: &str) -> String {
        if load::title_applies(&self.sources, &self.table) {
            title.to_owned()
        } else {
            without_changed(title).to_owned() + CHANGED
        }
    }

    /// Returns the name of the file without its extension.
    pub fn stem(&self) -> String {
        load::stem(&self.sources.files[0].name)
    }

    /// Returns the value at a path such as `block.2.levels`; items of lists are identified by their name or number.
    fn node(&self, path: &str) -> Option<&Node> {
        merge::node_at(&self.table, &path.split('.').collect::<Vec<_>>())
    }

    /// Returns an error whose place is the first of the given paths at which a value was written. If none of the paths
    /// has a value, the place is the whole file.
    pub fn error(&self, paths: &[&str], message: String) -> ScenarioError {
        let written = paths.iter().find_map(|path| self.node(path)).map(|node| node.origin);
        self.sources.error(written.unwrap_or(Origin::Whole(0)), Problem::Inconsistent { message })
    }

    /// Returns the stack of the file as a three-dimensional scenario, with the given values set at the given paths.
    ///
    /// `own` are the keys at the top level of the file that do not belong to the scenario; they are left out.
    ///
    /// # Errors
    /// Returns the first problem found, with the place where the value was written.
    pub fn stack(&self, own: &[&str], changes: &[(&str, Node)]) -> Result<Scenario, ScenarioError> {
        let mut table = self.table.clone();
        for key in own {
            table.remove(key);
        }
        let view = self.node("stack.view");
        let stated = view.filter(|view| {
            matches!(view.origin, Origin::File { file: 0, .. } | Origin::Override(_))
                && view.value != Value::Text("spatial".to_owned())
        });
        if stated.is_some() {
            let message =
                "the stacks of a room are always three-dimensional: leave `stack.view` out"
                    .to_owned();
            return Err(self.error(&["stack.view"], message));
        }
        let origin = self.node("stack").map_or(Origin::Whole(0), |stack| stack.origin);
        let spatial = ("stack.view", Node { origin, value: Value::Text("spatial".to_owned()) });
        for (path, node) in std::iter::once(&spatial).chain(changes) {
            let keys: Vec<&str> = path.split('.').collect();
            merge::set(&mut table, Some(&root::ROOT), &keys, node.clone()).map_err(|message| {
                self.sources.error(node.origin, Problem::Inconsistent { message })
            })?;
        }
        load::finished(self.sources.clone(), table, Vec::new(), None)
    }
}

impl Template {
    /// Removes the given fields from a table, but only those that are inherited from an extended scenario.
    pub fn forget_inherited(&mut self, table: &str, fields: &[&str]) {
        let own = |origin: Origin| match origin {
            Origin::File { file, .. } | Origin::Whole(file) => file == 0,
            Origin::Override(_) | Origin::Default => true,
        };
        if let Some(Entry { node: Node { value: Value::Table(table), .. }, .. }) =
            self.table.get_mut(table)
        {
            table
                .entries
                .retain(|entry| own(entry.node.origin) || !fields.contains(&entry.key.as_str()));
        }
    }

    /// Returns the definition of the field at a path such as `interface.rack-ground.friction.coefficient`.
    pub fn field(&self, path: &str) -> Option<&'static Field> {
        let keys: Vec<&str> = path.split('.').map(str::trim).collect();
        merge::field_at(Some(&self.table), &root::ROOT, &keys)
    }

    /// Returns the valid path that is most similar to a misspelled one; `None` if no valid path is similar enough.
    pub fn nearest(&self, path: &str) -> Option<String> {
        let mut keys: Vec<String> = path.split('.').map(|key| key.trim().to_owned()).collect();
        for at in 0..keys.len() {
            let above: Vec<&str> = keys[..at].iter().map(String::as_str).collect();
            let section = if at == 0 {
                &root::ROOT
            } else {
                merge::field_at(Some(&self.table), &root::ROOT, &above)?.kind.section()?
            };
            if section.any_field(&keys[at]).is_none() {
                let known: Vec<&str> = section.all_fields().map(|field| field.name).collect();
                keys[at] = super::reader::nearest(&keys[at], &known)?;
            }
        }
        Some(keys.join("."))
    }

    /// Returns the scenario with the given values set at the given paths.
    ///
    /// # Errors
    /// Returns the first problem found, with the place where the value was written.
    pub fn with<'a>(
        &self,
        changes: impl IntoIterator<Item = (&'a str, &'a Node)>,
    ) -> Result<Scenario, ScenarioError> {
        let mut table = self.table.clone();
        for (path, node) in changes {
            let keys: Vec<&str> = path.split('.').map(str::trim).collect();
            merge::set(&mut table, Some(&root::ROOT), &keys, node.clone()).map_err(|message| {
                self.sources.error(node.origin, Problem::Inconsistent { message })
            })?;
        }
        merge::expand_names(&mut table, &root::ROOT);
        let reader = Reader::open(
            &self.sources,
            &root::ROOT,
            String::new(),
            Some(&table),
            Origin::Whole(0),
        )?;
        let scenario = root::read(reader, &self.title)?;
        let written = Written { warnings: self.warnings.clone(), ..Written::default() };
        Ok(Scenario { written, ..scenario })
    }

    /// Returns the value at a path in a scenario, including defaults; `None` if there is no value at this path.
    pub fn value_in(scenario: &Scenario, path: &str) -> Option<Value> {
        let mut table = root::write(scenario);
        let mut keys = path.split('.').map(str::trim).peekable();
        while let Some(key) = keys.next() {
            let position = table.entries.iter().position(|entry| entry.key == key)?;
            let value = table.entries.swap_remove(position).node.value;
            if keys.peek().is_none() {
                return Some(value);
            }
            match value {
                Value::Table(below) => table = below,
                Value::Array(items) => {
                    let wanted = keys.next()?;
                    let found = items.into_iter().enumerate().find(|(index, item)| {
                        super::reader::item_name(item, *index) == wanted
                            || wanted == (index + 1).to_string()
                    });
                    let Value::Table(below) = found?.1.value else { return None };
                    table = below;
                }
                Value::Text(_)
                | Value::Integer(_)
                | Value::Float(_)
                | Value::Flag(_)
                | Value::Date => return None,
            }
        }
        None
    }

    /// Returns the contents of all files from which the scenario was read, in the order of reading.
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        self.sources.files.iter().map(|file| file.text.as_str())
    }
}

/// Reads the motion in a table whose entries come from the given sources.
///
/// # Errors
/// Returns the first problem found, with its place.
pub fn motion(
    sources: &Sources,
    path: &str,
    table: &Table,
    origin: Origin,
) -> Result<MotionSpec, ScenarioError> {
    let reader =
        Reader::open(sources, &super::motion::MOTION, path.to_owned(), Some(table), origin)?;
    super::motion::read(reader)
}
