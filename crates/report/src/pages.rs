//! A document divided into pages, with text, tables and figures one below the other, and numbered
//! footers.

use pdf_writer::types::StructRole;

use crate::document::{SCOPE, SIGNATURE};
use crate::{
    Block, Document, Dots, EventKind, Figure, FigureKind, Panel, Player, Strip, Table, Tone,
    document::{FINE, elsewhere},
    drawing::{Anchor, Drawing, Item},
    escape,
    figure::{Counter, Names, pane_letter},
    font::Font,
    number,
    pdf::{Page, pdf},
    sheet::{Sheet, baseline, row_height, wrap},
    stamp,
    style::{Style, Tag},
    tags::Tags,
};

/// The paper size of a printed document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Paper {
    /// 210 by 297 mm.
    #[default]
    A4,
    /// 8½ by 11 inches.
    Letter,
}

impl Paper {
    /// Returns the width and height (points).
    fn size(self) -> [f64; 2] {
        match self {
            Self::A4 => [595.28, 841.89],
            Self::Letter => [612.0, 792.0],
        }
    }
}

/// Writes the document as a PDF, with the same text and numbers as [`html`](crate::html).
///
/// Figures are vector graphics and text is selectable. The PDF has an outline of sections, the title and page number in
/// every footer, and tags for screen readers. If the document starts with a player in which bodies fall, the first page
/// shows a picture at the time of a fall. Content that is collapsed on the HTML page is in an appendix; a sentence
/// takes the place of [`Block::OnScreen`].
pub fn document_pdf(document: &Document, paper: Paper) -> Vec<u8> {
    let mut flow = Flow::new(document, paper);
    flow.verdict();
    let (opening, rest) = document.parted();
    flow.blocks(opening);
    flow.account();
    flow.warnings();
    flow.blocks(rest);
    flow.provenance();
    flow.appendix();
    let (pages, tags) = flow.finish();
    pdf(&document.title, &pages, tags, 1.0)
}

/// Writes a single figure as a one-page PDF. The page has the size of the figure, at three quarters of a point per px.
pub(crate) fn figure_pdf(figure: &Figure) -> Vec<u8> {
    let drawing = figure.draw(&escape::slug(&figure.id));
    let mut structure = Tags::new();
    let place = structure.open(0, StructRole::Figure, Some(&figure.caption));
    let tags = vec![Some(place); drawing.items.len()];
    pdf(&figure.caption, &[Page { drawing, sections: Vec::new(), tags }], structure, POINTS_PER_PX)
}

const POINTS_PER_PX: f64 = 0.75;
/// Margins (points): at the left and the right, at the top, and at the bottom. The footer is within the bottom margin.
const MARGIN: [f64; 3] = [54.0, 52.0, 60.0];
/// Distance between baselines, as a multiple of the font size.
const LEADING: f64 = 1.4;
/// Largest height of a plot (points).
const PLOT: f64 = 187.0;
/// Distance between blocks (points).
const GAP: f64 = 8.0;

struct Flow<'a> {
    document: &'a Document,
    size: [f64; 2],
    pages: Vec<Page>,
    /// Distance (points) from the top of the current page to the next block. The current page is the last of `pages`.
    y: f64,
    names: Names,
    counter: Counter,
    /// Collapsed sections, for the appendix. For each section: its summary line, its blocks, and the numbers of the
    /// last figure and the last table before it.
    folded: Vec<(&'a str, &'a [Block], Counter)>,
    tags: Tags,
    /// Index of the current structure element.
    current: usize,
}

impl<'a> Flow<'a> {
    fn new(document: &'a Document, paper: Paper) -> Self {
        let mut flow = Self {
            document,
            size: paper.size(),
            pages: Vec::new(),
            y: 0.0,
            names: Names::default(),
            counter: Counter::default(),
            folded: Vec::new(),
            tags: Tags::new(),
            current: 0,
        };
        flow.turn();
        flow
    }

    fn width(&self) -> f64 {
        self.size[0] - 2.0 * MARGIN[0]
    }

    /// Returns the distance (points) from the top of a page to its bottom margin.
    fn floor(&self) -> f64 {
        self.size[1] - MARGIN[2]
    }

    /// Writes a structure element with `words` as its alternative text. All items that `write` draws belong to this
    /// element, except those in nested elements.
    fn tagged(&mut self, role: StructRole, words: Option<&str>, write: impl FnOnce(&mut Self)) {
        self.settle(Some(self.current));
        let before = self.current;
        self.current = self.tags.open(before, role, words);
        write(self);
        self.settle(Some(self.current));
        self.current = before;
    }

    /// Assigns the structure element with index `element` to all items drawn since the last call; `None` marks these
    /// items as decoration.
    fn settle(&mut self, element: Option<usize>) {
        if let Some(page) = self.pages.last_mut() {
            page.tags.resize(page.drawing.items.len(), element);
        }
    }

    /// Translates a fixed English string to the language of the document.
    fn t(&self, english: &'static str) -> &'static str {
        self.document.language.fixed(english)
    }

    /// Starts a new page.
    fn turn(&mut self) {
        self.settle(Some(self.current));
        let drawing = Drawing::new(self.size[0], self.size[1], "");
        self.pages.push(Page { drawing, sections: Vec::new(), tags: Vec::new() });
        self.y = MARGIN[1];
    }

    /// Starts a new page unless the current page is empty or has at least `height` (points) left.
    fn need(&mut self, height: f64) {
        if self.y + height > self.floor() && self.y > MARGIN[1] {
            self.turn();
        }
    }

    fn page(&mut self) -> &mut Page {
        // A flow starts with a page and never removes one.
        self.pages.last_mut().expect("a page")
    }

    /// Writes a paragraph at a distance of `indent` (points) from the left margin.
    fn text(&mut self, class: &'static str, indent: f64, text: &str) {
        let style = Style::of(Tag::Text, class);
        let leading = LEADING * style.font_size;
        let font = Font::of(style.strong);
        let lines = wrap(font, style.font_size, text, self.width() - indent);
        // No page ends with the first line of a longer paragraph.
        self.need(leading * if lines.len() > 1 { 2.0 } else { 1.0 });
        for line in lines {
            self.need(leading);
            let at = [MARGIN[0] + indent, self.y + style.font_size];
            self.page().drawing.text(class, at, Anchor::Start, &line);
            self.y += leading;
        }
    }

    fn paragraph(&mut self, class: &'static str, text: &str) {
        self.tagged(StructRole::P, None, |flow| flow.text(class, 0.0, text));
        self.y += GAP;
    }

    fn list(&mut self, items: &[String]) {
        const INDENT: f64 = 11.0;
        self.tagged(StructRole::L, None, |flow| {
            for item in items {
                // The bullet stays together with the first two lines.
                flow.need(LEADING * 9.5 * 2.0);
                let dot = [MARGIN[0] + 2.0, flow.y + 9.5];
                flow.tagged(StructRole::LI, None, |flow| {
                    flow.tagged(StructRole::Lbl, None, |flow| {
                        flow.page().drawing.text("page-text", dot, Anchor::Start, "•");
                    });
                    let body = |flow: &mut Self| flow.text("page-text", INDENT, item);
                    flow.tagged(StructRole::LBody, None, body);
                });
                flow.y += 1.5;
            }
        });
        self.y += GAP - 1.5;
    }

    /// Writes a heading, on a new page if the current page has no room for the heading and `follows` (points) of the
    /// content after it.
    fn heading(&mut self, class: &'static str, text: &str, follows: f64) {
        let above = if self.y > MARGIN[1] { 6.0 } else { 0.0 };
        let height = LEADING * Style::of(Tag::Text, class).font_size;
        self.need(above + height + follows);
        self.y += if self.y > MARGIN[1] { above } else { 0.0 };
        if class == "page-section" {
            let y = self.y;
            self.page().sections.push((text.to_owned(), y));
        }
        let role = if class == "page-section" { StructRole::H2 } else { StructRole::H3 };
        self.tagged(role, None, |flow| flow.text(class, 0.0, text));
        self.y += 3.0;
    }

    fn verdict(&mut self) {
        let document = self.document;
        let verdict = &document.verdict;
        self.tagged(StructRole::P, None, |flow| flow.text("page-title", 0.0, &document.title));
        self.y += 6.0;
        let class = match verdict.tone {
            Tone::Stands => "page-bold page-stands",
            Tone::Falls => "page-bold page-falls",
            Tone::Invalid => "page-bold page-invalid",
            Tone::Neutral => "page-bold page-neutral",
        };
        let tone = self.t(verdict.tone.word()).to_uppercase();
        self.tagged(StructRole::P, None, |flow| flow.text(class, 0.0, &tone));
        let (opening, rest) = verdict.opening();
        self.tagged(StructRole::H1, None, |flow| flow.text("page-headline", 0.0, opening));
        if !rest.is_empty() {
            self.paragraph("page-text", rest);
        }
        self.y += 4.0;
        for dots in &verdict.dots {
            self.dots(dots);
        }
        if !verdict.shown.is_empty() {
            self.paragraph("page-text", &verdict.shown);
        }
    }

    /// Writes the sentences of the verdict that follow the first picture.
    fn account(&mut self) {
        let verdict = &self.document.verdict;
        if !verdict.advice.is_empty() {
            self.paragraph("page-bold", &verdict.advice);
        }
        if !verdict.sentences.is_empty() {
            self.paragraph("page-text", &verdict.sentences.join(" "));
        }
        if !verdict.command.is_empty() {
            let to = self.t("To compare the stack with and without the change:");
            self.paragraph("page-text", &format!("{to} {}", verdict.command));
        }
        if !verdict.fine.is_empty() {
            self.heading("page-part", self.t(FINE), 28.0);
            self.paragraph("page-text", &verdict.fine.join(" "));
        }
    }

    /// Draws the outcomes of the variants, scaled to 0.7 points per px.
    fn dots(&mut self, dots: &Dots) {
        const SCALE: f64 = 0.7;
        let Some(drawing) = dots.draw(self.document.language) else { return };
        let height = SCALE * drawing.height;
        self.need(height + 14.0);
        let words = dots.words(self.document.language);
        self.tagged(StructRole::P, None, |flow| flow.text("page-small", 0.0, &words));
        let at = [MARGIN[0], self.y + 1.0];
        self.tagged(StructRole::Figure, Some(&words), |flow| {
            flow.page().drawing.push(Item::Nested { at, scale: SCALE, drawing });
        });
        self.y += height + GAP;
    }

    fn warnings(&mut self) {
        let document = self.document;
        if !document.warnings.is_empty() {
            self.heading("page-section", self.t("Warnings"), 30.0);
            self.list(&document.warnings);
        }
    }

    fn provenance(&mut self) {
        let provenance = stamp::provenance(self.document);
        if provenance.is_empty() {
            return;
        }
        let pairs = provenance.into_iter().map(|(name, value)| vec![name, value]);
        let lines = SIGNATURE.map(|line| vec![self.t(line).to_owned(), String::new()]);
        let rows: Vec<Vec<String>> = pairs.chain(lines).collect();
        self.heading("page-section", self.t("Provenance"), 40.0);
        self.rows(&Sheet::new(Vec::new(), rows, vec![false; 2], self.width()));
        self.paragraph("page-text", &self.document.language.text(SCOPE));
    }

    /// Writes the appendix: the collapsed sections, including those nested in other collapsed sections.
    fn appendix(&mut self) {
        if self.folded.is_empty() {
            return;
        }
        self.heading("page-section", self.t("Appendix"), 60.0);
        let mut at = 0;
        while let Some(&(summary, blocks, counter)) = self.folded.get(at) {
            self.counter = counter;
            self.heading("page-part", summary, self.least(blocks));
            self.blocks(blocks);
            at += 1;
        }
    }

    fn blocks(&mut self, blocks: &'a [Block]) {
        for (at, block) in blocks.iter().enumerate() {
            match block {
                Block::Heading { level, text } => {
                    let class = if *level <= 2 { "page-section" } else { "page-part" };
                    let follows = self.least(&blocks[at + 1..]);
                    self.heading(class, text, follows);
                }
                Block::Paragraph(text) => self.paragraph("page-text", text),
                Block::List(items) => self.list(items),
                Block::Table(table) => self.table(table),
                Block::Figure(figure) => {
                    let number = self.counter.figure().to_string();
                    self.figure(&number, figure);
                }
                Block::Player(player) => self.player(player),
                Block::Players(players) => {
                    let number = self.counter.figure();
                    for (at, figure) in players.paper_figures().into_iter().enumerate() {
                        let figure = figure.in_language(self.document.language);
                        self.figure(&format!("{number}{}", pane_letter(at)), &figure);
                    }
                }
                Block::Details { summary, blocks } => {
                    let see = self.t("see the appendix.");
                    self.paragraph("page-small", &format!("{summary}: {see}"));
                    self.folded.push((summary, blocks, self.counter));
                    self.counter.skip(blocks);
                }
                Block::OnScreen { what, blocks } => {
                    let before = self.counter;
                    self.counter.skip(blocks);
                    let note = elsewhere(what, [before, self.counter], self.document.language);
                    self.paragraph("page-small", &note);
                }
            }
        }
    }

    /// Returns the height (points) of the beginning of `blocks` that must be on the same page as the heading above
    /// `blocks`.
    fn least(&self, blocks: &[Block]) -> f64 {
        let Some((first, rest)) = blocks.split_first() else { return 0.0 };
        let figure = |figure: &Figure| self.picture(figure, "measured").1 + 24.0;
        let least = match first {
            Block::Figure(shown) => figure(shown),
            Block::Player(player) => figure(&self.still(player)),
            Block::Players(players) => players.paper_figures().first().map_or(0.0, figure),
            Block::Table(_) => 66.0,
            Block::Heading { .. } => 24.0 + self.least(rest),
            Block::Details { .. } | Block::OnScreen { .. } => 24.0,
            // A paragraph before a figure introduces it, so they stay together.
            Block::Paragraph(_) if matches!(rest.first(), Some(Block::Figure(_))) => {
                40.0 + self.least(rest)
            }
            Block::Paragraph(_) | Block::List(_) => 28.0,
        };
        least.min(0.8 * (self.floor() - MARGIN[1]))
    }

    /// Returns the drawing of a figure, its height on the page, and its scale, which is as large as the page and the
    /// largest height of a plot allow, but at most 1.
    fn picture(&self, figure: &Figure, id: &str) -> (Drawing, f64, f64) {
        let drawing = figure.draw(id);
        let page = self.floor() - MARGIN[1] - 60.0;
        let most = if matches!(figure.kind, FigureKind::Plot(_)) { PLOT } else { page };
        let scale = POINTS_PER_PX
            .min(self.width() / drawing.width.max(1.0))
            .min(most / drawing.height.max(1.0));
        let height = drawing.height * scale;
        (drawing, height, scale)
    }

    fn figure(&mut self, number: &str, figure: &Figure) {
        let id = self.names.take(&figure.id);
        let caption = format!("{} {number}. {}", self.t("Figure"), figure.caption);
        let style = Style::of(Tag::Text, "page-small");
        let lines = wrap(Font::of(false), style.font_size, &caption, self.width()).len();
        let (drawing, height, scale) = self.picture(figure, &id);
        self.need(height + 4.0 + lines as f64 * LEADING * style.font_size);
        let at = [MARGIN[0], self.y];
        self.tagged(StructRole::Figure, Some(&figure.caption), |flow| {
            flow.page().drawing.push(Item::Nested { at, scale, drawing });
        });
        self.y += height + 4.0;
        self.tagged(StructRole::Caption, None, |flow| flow.text("page-small", 0.0, &caption));
        self.y += GAP;
    }

    /// Returns the picture of a player. If the player is the first figure of the document and bodies fall, the picture
    /// shows the second fall, or the only one. Otherwise, it is the picture from [`Player::paper_figure`].
    fn still(&self, player: &Player) -> Figure {
        let mut falls = player.scene.events.iter().filter(|event| event.kind == EventKind::Fall);
        // At the time of the second fall, the first fall is visible, too.
        let first = falls.next();
        let Some(fall) = falls.next().or(first).filter(|_| self.counter.figures == 0) else {
            return player.paper_figure(&self.document.blocks).in_language(self.document.language);
        };
        let panel = Panel { time: fall.time, note: fall.text.clone() };
        let strip = Strip { scene: player.scene.clone(), panels: vec![panel] };
        Figure::new(&player.id, &player.caption, strip).in_language(self.document.language)
    }

    fn player(&mut self, player: &Player) {
        let still = self.still(player);
        let number = self.counter.figure().to_string();
        self.figure(&number, &still);
        let events = player.scene.events.iter().filter(|event| event.time.is_finite());
        let rows: Vec<Vec<String>> = events
            .map(|event| {
                let time = format!("{} s", number::fixed(event.time, 2));
                vec![
                    time,
                    event.kind.word_in(self.document.language).to_owned(),
                    event.text.clone(),
                ]
            })
            .collect();
        if !rows.is_empty() {
            let numeric = vec![true, false, false];
            self.rows(&Sheet::new(Vec::new(), rows, numeric, self.width()));
        }
    }

    fn table(&mut self, table: &Table) {
        let number = self.counter.table();
        let head = table.columns.iter().map(crate::Column::heading).collect();
        let rows = table.rows.iter().map(|row| table.shown(row).collect()).collect();
        self.need(66.0);
        let caption = format!("{} {number}. {}", self.t("Table"), table.caption);
        self.tagged(StructRole::P, None, |flow| flow.text("page-small", 0.0, &caption));
        self.y += 3.0;
        self.rows(&Sheet::new(head, rows, table.numeric(), self.width()));
    }

    /// Writes the rows of a table, repeating the header row on every page.
    fn rows(&mut self, sheet: &Sheet) {
        self.tagged(StructRole::Table, None, |flow| flow.tagged_rows(sheet));
        self.y += GAP + 2.0;
    }

    fn tagged_rows(&mut self, sheet: &Sheet) {
        let head = sheet.head();
        let head_height = head.as_ref().map_or(0.0, |cells| row_height(cells));
        let mut open = false;
        for at in 0..sheet.len() {
            let cells = sheet.row(at);
            let height = row_height(&cells);
            let first = if open { 0.0 } else { head_height };
            if self.y + first + height > self.floor() && self.y > MARGIN[1] {
                self.turn();
                open = false;
            }
            if let (false, Some(head)) = (open, &head) {
                // A repeated header row is tagged as decoration, not as content.
                self.row(sheet, head, "page-small-bold", (at == 0).then_some(StructRole::TH));
                self.rule("page-line");
            }
            open = true;
            self.row(sheet, &cells, "page-small", Some(StructRole::TD));
            self.rule("page-rule");
        }
    }

    /// Writes a row of cells with a structure role; a row without a role is tagged as decoration.
    fn row(
        &mut self,
        sheet: &Sheet,
        cells: &[Vec<String>],
        class: &'static str,
        role: Option<StructRole>,
    ) {
        let top = self.y;
        let cell = |flow: &mut Self, column: usize, lines: &[String]| {
            let (x, anchor) = sheet.place(column);
            for (line, text) in lines.iter().enumerate() {
                let at = [MARGIN[0] + x, top + baseline(line)];
                flow.page().drawing.text(class, at, anchor, text);
            }
        };
        if let Some(role) = role {
            self.tagged(StructRole::TR, None, |flow| {
                for (column, lines) in cells.iter().enumerate() {
                    flow.tagged(role, None, |flow| cell(flow, column, lines));
                }
            });
        } else {
            for (column, lines) in cells.iter().enumerate() {
                cell(self, column, lines);
            }
            self.settle(None);
        }
        self.y += row_height(cells);
    }

    fn rule(&mut self, class: &'static str) {
        let (left, y) = (MARGIN[0], self.y);
        let right = left + self.width();
        self.page().drawing.line(class, [left, y], [right, y]);
        self.settle(None);
    }

    /// Returns the pages with their footers, and the structure tags.
    fn finish(mut self) -> (Vec<Page>, Tags) {
        self.settle(Some(self.current));
        let (right, y) = (MARGIN[0] + self.width(), self.size[1] - 34.0);
        let (of, word) = (self.pages.len(), self.t("of"));
        let size = Style::of(Tag::Text, "page-foot").font_size;
        let titles = wrap(Font::of(false), size, &self.document.title, self.width() - 80.0);
        let title = match titles.as_slice() {
            [] => String::new(),
            [whole] => whole.clone(),
            [first, ..] => format!("{first} …"),
        };
        for (at, page) in self.pages.iter_mut().enumerate() {
            let drawing = &mut page.drawing;
            drawing.line("page-rule", [MARGIN[0], y - 12.0], [right, y - 12.0]);
            drawing.text("page-foot", [MARGIN[0], y], Anchor::Start, &title);
            let number = format!("{} {word} {of}", at + 1);
            drawing.text("page-foot", [right, y], Anchor::End, &number);
            page.tags.resize(page.drawing.items.len(), None);
        }
        (self.pages, self.tags)
    }
}
