//! A document as one self-contained HTML page.

use std::fmt::Write as _;

use serde::Serialize;

use crate::document::{SCOPE, SIGNATURE};
use crate::{
    Block, Cell, Document, Figure, FigureKind, Language, Player, Strip, Table, Tone, Verdict,
    document::{FINE, elsewhere},
    drawing::Room,
    escape,
    figure::{Counter, Names},
    glossary::{Glossary, TITLE},
    number,
    page::{Payload, assemble},
    stamp,
    trial::{self, Trial},
};

/// Writes the document as one HTML file that makes no network requests.
///
/// Order: the headline, the first picture, the sentences of the verdict, warnings, a list of
/// sections, all other blocks, and the provenance. Players and interactive plots run
/// in the page; without scripts, and in print, they are SVG pictures.
pub fn html(document: &Document) -> String {
    written(document, None)
}

/// Writes the document like [`html`], with a button that opens an embedded page. `trial` holds this page and its
/// initial data.
pub fn html_with(document: &Document, trial: &Trial<'_>) -> String {
    written(document, Some(trial))
}

fn written(document: &Document, trial: Option<&Trial<'_>>) -> String {
    let mut writer = Writer::of(document);
    writer.header(document);
    if trial.is_some() {
        let opener = document.language.markup(trial::OPENER);
        writer.put(&opener);
    }
    writer.out.push_str("<main id=\"content\">\n");
    let (opening, rest) = document.parted();
    let sections = sections(&document.blocks);
    let provenance = stamp::provenance(document);
    writer.blocks(opening);
    writer.account(&document.verdict);
    writer.warnings(&document.warnings);
    writer.contents(&sections, !provenance.is_empty());
    writer.blocks(rest);
    writer.words();
    writer.provenance(&provenance);
    writer.out.push_str("</main>\n");
    assemble((&document.title, document.language), &writer.out, writer.payload, trial)
}

/// Writes a player alone as one HTML file that makes no network requests, for a cell of a notebook.
///
/// The file has no pictures for print and shows nothing without scripts.
pub fn player_html(title: &str, player: &Player) -> String {
    let document = Document::default();
    let mut writer = Writer { prints: false, ..Writer::of(&document) };
    writer.put("<main id=\"content\">\n");
    writer.player(player);
    writer.put("</main>\n");
    assemble((title, document.language), &writer.out, writer.payload, None)
}

/// Blocks to be added to an existing page: their markup, and the data of their players and plots.
#[derive(Clone, Debug, Serialize)]
pub struct Fragment {
    /// The markup.
    pub markup: String,
    /// The data, as JSON.
    pub data: String,
}

/// Translates blocks from English to a language, and writes them as part of a page that requires scripts, such as a
/// [`Shell`](crate::Shell).
pub fn fragment(blocks: &[Block], language: Language) -> Fragment {
    let english = Document { blocks: blocks.to_vec(), ..Document::default() };
    let document = english.in_language(language);
    let mut writer = Writer { prints: false, ..Writer::of(&document) };
    writer.blocks(&document.blocks);
    Fragment { markup: writer.out, data: writer.payload.into_json() }
}

/// Returns the headings of level 2 that are not in a collapsed section, with their anchors.
fn sections(blocks: &[Block]) -> Vec<(String, String)> {
    let mut names = Names::default();
    let mut list = Vec::new();
    for block in blocks {
        if let Block::Heading { level: 0..=2, text } = block {
            list.push((anchor(&mut names, text), text.clone()));
        }
    }
    list
}

fn anchor(names: &mut Names, text: &str) -> String {
    names.take(&format!("section {text}"))
}

/// Length (bytes) above which a table cell gets a minimum width.
const LONG: usize = 60;

/// Largest number of columns of a table that is still shown as a table on a narrow screen; if a table has more columns,
/// each row becomes a card.
const CARDS: usize = 2;

pub(crate) struct Writer<'a> {
    pub(crate) document: &'a Document,
    out: String,
    pub(crate) payload: Payload,
    pub(crate) names: Names,
    anchors: Names,
    counter: Counter,
    folded: usize,
    glossary: Glossary,
    /// `true` if players include pictures for print and for pages without scripts.
    pub(crate) prints: bool,
}

impl<'a> Writer<'a> {
    fn of(document: &'a Document) -> Self {
        Self {
            document,
            out: String::new(),
            payload: Payload::default(),
            names: Names::default(),
            anchors: Names::default(),
            counter: Counter::default(),
            folded: 0,
            glossary: Glossary::of(&document.words),
            prints: true,
        }
    }

    /// Translates a fixed English string to the language of the document.
    pub(crate) fn t(&self, english: &'static str) -> &'static str {
        self.document.language.fixed(english)
    }

    /// Returns a word and a number, such as "Figure 3".
    fn numbered(&self, word: &'static str, number: usize) -> String {
        format!("{} {number}", self.t(word))
    }

    /// Appends `markup`, which must contain only escaped text.
    pub(crate) fn put(&mut self, markup: &str) {
        self.out.push_str(markup);
    }

    pub(crate) fn element(&mut self, open: &str, text: &str, close: &str) {
        let text = escape::html(&number::tied(text));
        // Writing to a String cannot fail.
        let _ = writeln!(self.out, "{open}{text}{close}");
    }

    /// Writes an element as [`Writer::element`] does, and marks the technical terms in its text.
    pub(crate) fn explained(&mut self, open: &str, text: &str, close: &str) {
        let text = self.glossary.marked(&number::tied(text));
        let _ = writeln!(self.out, "{open}{text}{close}");
    }

    /// Writes the meanings of the marked terms.
    fn words(&mut self) {
        let list = self.glossary.list(self.document.language.fixed(TITLE));
        self.put(&list);
    }

    fn header(&mut self, document: &Document) {
        let verdict = &document.verdict;
        let tone = verdict.tone;
        let skip = self.t("Skip to the content");
        self.put(&format!("<a class=\"skip\" href=\"#content\">{skip}</a>\n"));
        self.put(&format!("<header class=\"verdict {}\">\n", tone.class()));
        self.element("<p class=\"title\">", &document.title, "</p>");
        self.put(&badge(tone, document.language));
        self.element("<h1>", verdict.opening().0, "</h1>");
        for dots in &verdict.dots {
            if let Some(drawing) = dots.draw(document.language) {
                let words = dots.words(document.language);
                self.element("<p class=\"dots\"><span>", &words, "</span>");
                self.put(&drawing.inline());
                self.put("</p>\n");
            }
        }
        if !verdict.shown.is_empty() {
            self.element("<p class=\"shown\">", &verdict.shown, "</p>");
        }
        let count = document.warnings.len();
        if count > 0 {
            let plural = if count == 1 { "" } else { "s" };
            let count = document.language.text(&format!("{count} warning{plural}"));
            self.put(&format!("<p class=\"heed\"><a href=\"#warnings\">{count}</a></p>\n"));
        }
        self.put("</header>\n");
    }

    /// Writes the sentences of the verdict that follow the first picture.
    fn account(&mut self, verdict: &Verdict) {
        let (_, rest) = verdict.opening();
        let parts = [rest, &verdict.advice, &verdict.command];
        if parts.iter().all(|part| part.is_empty())
            && verdict.sentences.is_empty()
            && verdict.fine.is_empty()
        {
            return;
        }
        let label = self.t("Verdict in words");
        self.put(&format!("<section class=\"account\" aria-label=\"{label}\">\n"));
        if !rest.is_empty() {
            self.explained("<p class=\"rest\">", rest, "</p>");
        }
        if !verdict.advice.is_empty() {
            self.element("<p class=\"advice\">", &verdict.advice, "</p>");
        }
        if !verdict.sentences.is_empty() {
            self.explained("<p class=\"lead\">", &verdict.sentences.join(" "), "</p>");
        }
        if !verdict.command.is_empty() {
            // Without non-breaking spaces, because the command is meant to be copied.
            let command = escape::html(&verdict.command);
            let to = self.t("To compare the stack with and without the change:");
            self.put(&format!("<p class=\"command\">{to} <code>{command}</code></p>\n"));
        }
        if !verdict.fine.is_empty() {
            let fine = self.t(FINE);
            self.put(&format!("<details class=\"fine\">\n<summary>{fine}</summary>\n"));
            self.explained("<p>", &verdict.fine.join(" "), "</p>");
            self.put("</details>\n");
        }
        self.put("</section>\n");
    }

    fn warnings(&mut self, warnings: &[String]) {
        if warnings.is_empty() {
            return;
        }
        let title = self.t("Warnings");
        self.put(&format!(
            "<section class=\"warnings\" id=\"warnings\" aria-label=\"{title}\">\n<h2>{title}</h2>\n<ul>\n"
        ));
        for warning in warnings {
            self.element("<li>", warning, "</li>");
        }
        self.put("</ul>\n</section>\n");
    }

    fn contents(&mut self, sections: &[(String, String)], provenance: bool) {
        if sections.len() < 3 {
            return;
        }
        let label = self.t("Sections");
        self.put(&format!("<nav class=\"contents\" aria-label=\"{label}\"><ul>\n"));
        for (anchor, text) in sections {
            self.element(&format!("<li><a href=\"#{anchor}\">"), text, "</a></li>");
        }
        if provenance {
            let title = self.t("Provenance");
            self.put(&format!("<li><a href=\"#provenance\">{title}</a></li>\n"));
        }
        self.put("</ul></nav>\n");
    }

    fn provenance(&mut self, pairs: &[(String, String)]) {
        if pairs.is_empty() {
            return;
        }
        let title = self.t("Provenance");
        self.put(&format!(
            "<section class=\"provenance\" id=\"provenance\">\n<h2>{title}</h2>\n<dl>\n"
        ));
        for (name, value) in pairs {
            self.element("<div><dt>", name, "</dt>");
            self.element("<dd>", value, "</dd></div>");
        }
        self.put("</dl>\n");
        let scope = self.document.language.text(SCOPE);
        self.element("<p class=\"text\">", &scope, "</p>");
        self.put("<dl class=\"signature\">\n");
        for line in SIGNATURE {
            let line = self.t(line);
            self.element("<div><dt>", line, "</dt><dd></dd></div>");
        }
        self.put("</dl>\n</section>\n");
    }

    fn blocks(&mut self, blocks: &[Block]) {
        for block in blocks {
            match block {
                Block::Heading { level, text } => {
                    let level = (*level).clamp(2, 4);
                    self.glossary.again();
                    // Headings in collapsed content are not listed and need no anchor.
                    let open = if level == 2 && self.folded == 0 {
                        format!("<h2 id=\"{}\">", anchor(&mut self.anchors, text))
                    } else {
                        format!("<h{level}>")
                    };
                    self.element(&open, text, &format!("</h{level}>"));
                }
                Block::Paragraph(text) => self.explained("<p class=\"text\">", text, "</p>"),
                Block::List(items) => {
                    self.put("<ul class=\"text\">\n");
                    for item in items {
                        self.explained("<li>", item, "</li>");
                    }
                    self.put("</ul>\n");
                }
                Block::Table(table) => self.table(table),
                Block::Figure(figure) => self.figure(figure),
                Block::Player(player) => self.player(player),
                Block::Players(players) => self.players(players),
                Block::Details { summary, blocks } => {
                    self.element("<details>\n<summary>", summary, "</summary>");
                    self.put("<div class=\"folded\">\n");
                    self.folded += 1;
                    self.blocks(blocks);
                    self.folded -= 1;
                    self.put("</div>\n</details>\n");
                }
                Block::OnScreen { what, blocks } => {
                    let before = self.counter;
                    self.put("<div class=\"on-screen\">\n");
                    self.blocks(blocks);
                    self.put("</div>\n");
                    let note = elsewhere(what, [before, self.counter], self.document.language);
                    self.element("<p class=\"on-paper\">", &note, "</p>");
                }
            }
        }
    }

    fn table(&mut self, table: &Table) {
        let count = self.counter.table();
        let count = self.numbered("Table", count);
        self.put("<div class=\"table\" tabindex=\"0\" role=\"region\"");
        let label = escape::html(&table.caption);
        let wide = table.columns.len() > CARDS;
        let cards = if wide { " class=\"cards\"" } else { "" };
        self.put(&format!(" aria-label=\"{count}. {label}\">\n<table{cards}>\n"));
        let number = format!("<caption><span><b>{count}.</b> ");
        self.explained(&number, &table.caption, "</span></caption>");
        let numeric = table.numeric();
        let class = |column: usize| if numeric[column] { " class=\"number\"" } else { "" };
        self.put("<thead><tr>");
        for (at, column) in table.columns.iter().enumerate() {
            let unit = if column.unit.is_empty() {
                String::new()
            } else {
                format!(" <span class=\"unit\">({})</span>", escape::html(&column.unit))
            };
            // An empty heading is written as an ordinary cell.
            if column.name.is_empty() && unit.is_empty() {
                self.put("<td></td>");
            } else {
                let name = self.glossary.marked(&column.name);
                self.put(&format!("<th scope=\"col\"{}>{name}{unit}</th>", class(at)));
            }
        }
        self.put("</tr></thead>\n<tbody>\n");
        for row in &table.rows {
            self.put("<tr>");
            for (at, text) in table.shown(row).enumerate() {
                let class = match row.get(at) {
                    Some(Cell::Rated(rating, _)) => format!(" class=\"{}\"", rating.class()),
                    Some(Cell::Text(text) | Cell::Verbatim(text)) if text.len() > LONG => {
                        " class=\"long\"".into()
                    }
                    _ => class(at).to_owned(),
                };
                let mut text = self.glossary.marked(&number::tied(&text));
                // Inside a card, the name of a column and the value are placed side by side, so the value must be one
                // element.
                if wide && text.contains('<') {
                    text = format!("<span>{text}</span>");
                }
                // On a narrow screen, each row becomes a card, in which each value has the name of its column.
                let column = table.columns[at].heading();
                let name = if wide && !column.is_empty() {
                    format!(" data-name=\"{}\"", escape::html(&column))
                } else {
                    String::new()
                };
                self.put(&format!("<td{class}{name}>{text}</td>"));
            }
            self.put("</tr>\n");
        }
        self.put("</tbody>\n</table>\n</div>\n");
    }

    fn figure(&mut self, figure: &Figure) {
        let id = self.names.take(&figure.id);
        let live = match &figure.kind {
            FigureKind::Plot(plot) if plot.is_live() => Some(self.payload.add_plot(&id, plot)),
            FigureKind::Plot(_)
            | FigureKind::Panels(_)
            | FigureKind::Strip(_)
            | FigureKind::Envelope(_)
            | FigureKind::Diagram(_)
            | FigureKind::FloorPlan(_) => None,
        };
        let kind = match &figure.kind {
            FigureKind::Plot(_) | FigureKind::Panels(_) => "plot",
            FigureKind::Strip(_) => "strip",
            FigureKind::Envelope(_) => "envelope",
            FigureKind::Diagram(_) | FigureKind::FloorPlan(_) => "diagram",
        };
        let data = live.map_or(String::new(), |place| format!(" data-plot=\"{place}\""));
        self.put(&format!("<figure class=\"{kind}\" id=\"figure-{id}\"{data}>\n"));
        if live.is_some() {
            self.put("<div class=\"live\"></div>\n");
        }
        if let FigureKind::Strip(strip) = &figure.kind {
            self.strip(strip, &id);
        } else {
            let drawing = figure.draw(&id).inline();
            self.put(&format!("<div class=\"drawing\">{drawing}</div>\n"));
            // Interactive plots adapt to any width.
            if live.is_none() {
                let drawing = figure.draw_in(&format!("{id}-phone"), Room::Phone).inline();
                self.put(&format!("<div class=\"drawing phone\">{drawing}</div>\n"));
            }
        }
        self.caption(&figure.caption);
        self.put("</figure>\n");
    }

    pub(crate) fn caption(&mut self, caption: &str) {
        let number = self.counter.figure();
        let number = format!("<figcaption><b>{}.</b> ", self.numbered("Figure", number));
        self.explained(&number, caption, "</figcaption>");
    }

    pub(crate) fn strip(&mut self, strip: &Strip, id: &str) {
        let drawings = strip.drawings(id, self.document.language);
        let width = drawings.first().map_or(0.0, |drawing| drawing.width.round());
        self.put(&format!("<div class=\"panels\" style=\"--panel:{width}px\">\n"));
        for drawing in drawings {
            self.put(&drawing.inline());
            self.put("\n");
        }
        self.put("</div>\n");
    }
}

/// Returns the markup of a tone: its symbol and its word in a language.
pub fn badge(tone: Tone, language: Language) -> String {
    let word = escape::html(language.fixed(tone.word()));
    format!("<p class=\"tone\">{}<span>{word}</span></p>\n", sign(tone))
}

/// Returns the symbol of a tone as inline SVG. Each tone has its own shape, so that no meaning depends on
/// color alone.
pub(crate) fn sign(tone: Tone) -> &'static str {
    match tone {
        Tone::Stands => {
            r#"<svg class="sign" viewBox="0 0 24 24" aria-hidden="true"><circle cx="12" cy="12" r="11"/><path d="M6.5 12.5l3.8 3.8 7.2-8"/></svg>"#
        }
        Tone::Falls => {
            r#"<svg class="sign" viewBox="0 0 24 24" aria-hidden="true"><path class="fill" d="M12 1.5 23 21.5H1z"/><path d="M12 8.5v6.5M12 18.2v.1"/></svg>"#
        }
        Tone::Invalid => {
            r#"<svg class="sign" viewBox="0 0 24 24" aria-hidden="true"><rect class="fill" x="1.5" y="1.5" width="21" height="21" rx="2"/><path d="M7.5 7.5l9 9M16.5 7.5l-9 9"/></svg>"#
        }
        Tone::Neutral => {
            r#"<svg class="sign" viewBox="0 0 24 24" aria-hidden="true"><circle cx="12" cy="12" r="11"/><path d="M12 11v6.5M12 6.8v.1"/></svg>"#
        }
    }
}
