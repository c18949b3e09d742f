//! Tables for spreadsheet programs: workbooks, and CSV files with decimal commas.

use std::path::Path;

use anyhow::{Context as _, bail};
use barrelstack::spreadsheet;
use barrelstack_input::system;

use crate::store::{store, store_all};

/// File name of the workbook in a folder of tables.
const WORKBOOK: &str = "tables.xlsx";
/// Error message of a build that cannot write workbooks.
const WITHOUT: &str = "this build of the command writes no workbooks; install it with `cargo install barrelstack --features xlsx`, \
                       or open the CSV files";
/// Maximum size (bytes) of each file that [`TableArgs::write`] reads.
const LIMIT: usize = 4 << 30;

/// Options of the commands that write tables into a folder.
#[derive(Clone, Copy, Debug, Default, clap::Args)]
pub(crate) struct TableArgs {
    /// Also write the tables as a workbook, tables.xlsx, into the folder of the results: a sheet for every CSV file, and one
    /// for the provenance.
    #[arg(long)]
    pub(crate) xlsx: bool,
    /// Write CSV files with decimal commas and with semicolons between the columns, as spreadsheet programs in many
    /// languages expect. This program itself reads only tables with decimal points.
    #[arg(long)]
    pub(crate) decimal_comma: bool,
}

impl TableArgs {
    /// Returns an error if one of these options is given, but no folder for the tables (`folder` is `false`).
    pub(crate) fn need(self, folder: bool) -> anyhow::Result<()> {
        let given = [(self.xlsx, "--xlsx"), (self.decimal_comma, "--decimal-comma")];
        match given.into_iter().find(|(given, _)| *given && !folder) {
            Some((_, option)) => {
                bail!(
                    "{option} applies only to tables, but this command writes none: give a folder for tables, or omit \
                     {option}"
                )
            }
            None => Ok(()),
        }
    }

    /// Converts the CSV files among `files` to decimal commas, and appends the workbook, each only if it is
    /// requested.
    pub(crate) fn of(
        self,
        mut files: Vec<(String, Vec<u8>)>,
    ) -> anyhow::Result<Vec<(String, Vec<u8>)>> {
        let book = self.xlsx.then(|| workbook(&files)).transpose()?;
        if self.decimal_comma {
            for (_, bytes) in files.iter_mut().filter(|(name, _)| has_ending(name, "csv")) {
                *bytes = spreadsheet::with_decimal_commas(&text(bytes)).into_bytes();
            }
        }
        files.extend(book.map(|book| (WORKBOOK.to_owned(), book)));
        Ok(files)
    }

    /// Reads the named files of a folder. Writes a workbook of them, and rewrites the CSV files with decimal commas,
    /// each only if it is requested.
    pub(crate) fn write(self, folder: &Path, names: &[&str]) -> anyhow::Result<()> {
        if !self.xlsx && !self.decimal_comma {
            return Ok(());
        }
        let read = |name: &&str| {
            let path = folder.join(name);
            let bytes = system::read_result(&path, LIMIT).map_err(anyhow::Error::msg);
            Ok((
                (*name).to_owned(),
                bytes.with_context(|| format!("cannot read {}", path.display()))?,
            ))
        };
        let files = self.of(names.iter().map(read).collect::<anyhow::Result<_>>()?)?;
        store_all(folder, &files.iter().map(|(name, bytes)| (folder.join(name), bytes.as_slice())))
    }
}

/// Returns an error message if `--xlsx` is among the arguments but this build cannot write workbooks. Called before any
/// work is done.
pub(crate) fn refusal(mut arguments: impl Iterator<Item = std::ffi::OsString>) -> Option<String> {
    let refused = !cfg!(feature = "xlsx") && arguments.any(|argument| argument == "--xlsx");
    refused.then(|| format!("--xlsx: {WITHOUT}"))
}

/// Writes one table, as a workbook if the path ends in `.xlsx`, and otherwise as CSV.
pub(crate) fn write_one(path: &Path, csv: &str) -> anyhow::Result<()> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("xlsx")) {
        return store(path, csv.as_bytes());
    }
    // The other sheet has the name "provenance", so the table needs a different name.
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = if stem.eq_ignore_ascii_case("provenance") { "table".into() } else { stem };
    let about = spreadsheet::provenance(&facts(), &[]);
    let book = book(&[(&name, csv), ("provenance", &about)]);
    store(path, &book.with_context(|| format!("cannot write {}", path.display()))?)
}

/// Returns a workbook with a sheet for each CSV file among `files`, and a provenance sheet with the contents of the
/// JSON files.
fn workbook(files: &[(String, Vec<u8>)]) -> anyhow::Result<Vec<u8>> {
    let of = |ending| files.iter().filter(move |(name, _)| has_ending(name, ending));
    let documents: Vec<String> = of("json").map(|(_, bytes)| text(bytes)).collect();
    let documents: Vec<&str> = documents.iter().map(String::as_str).collect();
    let mut tables: Vec<(String, String)> = of("csv")
        .map(|(name, bytes)| (name.trim_end_matches(".csv").to_owned(), text(bytes)))
        .collect();
    tables.push(("provenance".to_owned(), spreadsheet::provenance(&facts(), &documents)));
    let tables: Vec<(&str, &str)> =
        tables.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    book(&tables).with_context(|| {
        format!("cannot write {WORKBOOK}; leave out --xlsx, and use the other files")
    })
}

/// Returns the bytes of a workbook with one sheet for each table, given as the name of the sheet and CSV text.
#[cfg(feature = "xlsx")]
fn book(tables: &[(&str, &str)]) -> anyhow::Result<Vec<u8>> {
    Ok(spreadsheet::workbook(tables)?)
}

/// Returns an error, because this build writes no workbooks.
#[cfg(not(feature = "xlsx"))]
fn book(_: &[(&str, &str)]) -> anyhow::Result<Vec<u8>> {
    bail!("{WITHOUT}")
}

/// Returns the rows of the provenance sheet that state the name, version and commit of this program, as pairs of label
/// and value.
fn facts() -> Vec<(String, String)> {
    let commit = env!("BARRELSTACK_COMMIT");
    let of = if commit.is_empty() { String::new() } else { format!(", commit {commit}") };
    vec![("written by".to_owned(), format!("barrelstack {}{of}", env!("CARGO_PKG_VERSION")))]
}

fn has_ending(name: &str, ending: &str) -> bool {
    Path::new(name).extension().is_some_and(|of| of == ending)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
