//! Pages about changed records: components, spectra and tables before and after the change.

use std::path::Path;

use barrelstack_motion::Record;
use barrelstack_report::{
    Block, Cell, Document, Figure, FigureKind, Panels, Plot, Table, Tone, Verdict, capital, html,
    listed,
};

use super::output::vacant;
use super::panels;
use crate::language::LanguageArgs;
use crate::printer;
use crate::store::store;

/// Text of a page in addition to its figures.
pub(super) struct PageText {
    /// Headline of the page, which states the result in one sentence.
    pub(super) headline: String,
    /// Tables of measures before and after the change.
    pub(super) tables: Vec<Table>,
    /// Language of the page.
    pub(super) language: LanguageArgs,
}

/// Returns `true` if the extension of a path is that of an HTML page.
fn is_page(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("html"))
}

/// Returns an error if a path is given, but neither an HTML page nor a picture can be written to it.
pub(super) fn vacant_figure(path: Option<&Path>, overwrite: bool) -> anyhow::Result<()> {
    let Some(path) = path else { return Ok(()) };
    if is_page(path) { vacant(path, overwrite) } else { panels::vacant_picture(path, overwrite) }
}

/// Writes the panels of a record before and after a change, and prints the path.
///
/// If the extension of the path is `.html`, the panels are written as a page with text, otherwise as a picture.
pub(super) fn write(
    path: &Path,
    figure: &Figure,
    after: &Record,
    text: PageText,
) -> anyhow::Result<()> {
    if let (FigureKind::Panels(panels), true) = (&figure.kind, is_page(path)) {
        let language = text.language;
        let page = language.page(&document(panels, after, text));
        store(path, html(&page).as_bytes())?;
    } else {
        panels::write(path, figure)?;
    }
    printer::lines([format!("written: {}", path.display())])
}

fn document(panels: &Panels, after: &Record, text: PageText) -> Document {
    let heading = |text: &str| Block::heading(2, text);
    let mut blocks = Vec::new();
    // The spectra are the last row, but come first on the page because they matter most.
    if let Some((spectra, components)) = panels.rows.split_last() {
        blocks.push(heading("Spectra"));
        blocks.extend(spectra.iter().enumerate().map(|(at, plot)| live("spectra", at, plot)));
        blocks.push(heading("Components before and after"));
        blocks.extend(text.tables.into_iter().map(Block::Table));
        for (row, plots) in components.iter().enumerate() {
            let name = plots.first().and_then(|plot| plot.y.label.split_once(": "));
            blocks.push(heading(&format!("Component {}", name.map_or("", |(name, _)| name))));
            let id = format!("component-{}", row + 1);
            blocks.extend(plots.iter().enumerate().map(|(at, plot)| live(&id, at, plot)));
        }
    }
    let steps = after.notes.iter().enumerate();
    Document {
        title: panels.title.clone(),
        verdict: Verdict {
            headline: text.headline,
            sentences: panels.lines.iter().map(|line| format!("{line}.")).collect(),
            tone: Tone::Neutral,
            ..Verdict::default()
        },
        blocks,
        provenance: steps
            .map(|(at, note)| (format!("step {}", at + 1), note.clone()))
            .chain([(
                "program".to_owned(),
                concat!("barrelstack ", env!("CARGO_PKG_VERSION")).to_owned(),
            )])
            .collect(),
        warnings: Vec::new(),
        words: Vec::new(),
        ..Document::default()
    }
}

/// Converts a plot to an interactive figure. The identifier of the figure consists of `id`, a hyphen and `at` + 1.
fn live(id: &str, at: usize, plot: &Plot) -> Block {
    let what = match plot.y.label.split_once(": ") {
        Some((channel, quantity)) => format!("{quantity} of {channel}"),
        None => plot.y.label.clone(),
    };
    let lines = listed(plot.series.iter().map(|series| series.label.as_str()));
    Block::Figure(Figure::new(
        format!("{id}-{}", at + 1),
        format!("{}: {lines}.", capital(&what)),
        Plot { interactive: true, ..plot.clone() },
    ))
}

/// Converts the rows of a terminal table to a table of a page.
pub(super) fn table(caption: &str, rows: &[Vec<String>]) -> Table {
    let Some((head, rows)) = rows.split_first() else { return Table::new(caption, &[]) };
    let columns: Vec<(&str, &str)> = head.iter().map(|name| (name.as_str(), "")).collect();
    let mut table = Table::new(caption, &columns);
    // The digits are the same as on the terminal.
    let digits = |text: &str| {
        let digits = text.trim_start_matches(['-', '0', '.']);
        digits.chars().filter(char::is_ascii_digit).count()
    };
    let cell = |text: &String| match text.parse::<f64>() {
        Ok(value) => Cell::Number(value, digits(text)),
        Err(_) => Cell::text(text),
    };
    table.rows = rows.iter().map(|row| row.iter().map(cell).collect()).collect();
    table
}
