//! Translation of all strings of a document.

use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

use super::{Language, Translated, Translator, is_phrase, is_prose};
use crate::{
    Axis, Block, Cell, Document, Event, Figure, FigureKind, History, Moment, Plot, Scene, Table,
    Trace, Word, figure::walk,
};

impl Document {
    /// Returns the document in a language, translated from English.
    ///
    /// Numbers, units and commands stay as they are, and so does a string without an entry in the
    /// catalog of the language. Everything that is written from the document (pages, Markdown, PDF,
    /// figures and tables) is in this language.
    #[must_use]
    pub fn in_language(&self, language: Language) -> Self {
        let mut document = self.clone();
        if let Some(catalog) = language.catalog().filter(|_| self.language != language) {
            let translator = Translator::new(catalog);
            let put = |text: &mut String| *text = translator.text(text);
            Visit { text: put, language, scenes: HashMap::new() }.document(&mut document);
            let fixed = |text| language.fixed(text);
            for Word { word, meaning } in &mut document.words {
                (*word, *meaning) = (fixed(word), fixed(meaning));
            }
        }
        document.language = language;
        document
    }

    /// Returns, in alphabetical order, the strings and parts of strings in an English document that have no entry in
    /// the catalog of a language.
    pub fn untranslated(&self, language: Language) -> Vec<String> {
        let Some(catalog) = language.catalog() else { return Vec::new() };
        let translator = Translator::new(catalog);
        let mut missing = BTreeSet::new();
        for Word { word, meaning } in &self.words {
            let unknown = [word, meaning].into_iter().filter(|text| catalog.entry(text).is_none());
            missing.extend(unknown.map(|text| (*text).to_owned()));
        }
        // A capitalized word in a heading counts as a word to be translated, not as a name.
        walk(&self.blocks, &mut |block| {
            let heads: Vec<&String> = match block {
                Block::Heading { text, .. } => vec![text],
                Block::Details { summary, .. } | Block::OnScreen { what: summary, .. } => {
                    vec![summary]
                }
                Block::Table(table) => table.columns.iter().map(|column| &column.name).collect(),
                Block::Paragraph(_)
                | Block::List(_)
                | Block::Figure(_)
                | Block::Player(_)
                | Block::Players(_) => Vec::new(),
            };
            let plain = |text: &&&String| translator.text(text) == ***text && is_phrase(text);
            let kept = heads.iter().filter(plain).map(|text| (*text).clone());
            missing.extend(kept.filter(|text| catalog.entry(text).is_none()));
        });
        let mut document = self.clone();
        let find = |text: &mut String| {
            let Translated { missing: parts, .. } = translator.translated(text);
            missing.extend(parts.into_iter().filter(|part| is_prose(part)));
        };
        Visit { text: find, language, scenes: HashMap::new() }.document(&mut document);
        missing.into_iter().collect()
    }

    /// Returns all strings that [`Document::in_language`] translates, except technical terms and their meanings.
    pub fn texts(&self) -> Vec<String> {
        let mut texts = Vec::new();
        let keep = |text: &mut String| texts.push(text.clone());
        Visit { text: keep, language: self.language, scenes: HashMap::new() }
            .document(&mut self.clone());
        texts
    }
}

/// Visits the strings of a document.
struct Visit<F> {
    text: F,
    language: Language,
    /// Translated scenes by the address of the original scene, since figures share scenes with players.
    scenes: HashMap<*const Scene, Arc<Scene>>,
}

impl<F: FnMut(&mut String)> Visit<F> {
    fn text(&mut self, text: &mut String) {
        if !text.is_empty() {
            (self.text)(text);
        }
    }

    fn texts<'a>(&mut self, texts: impl IntoIterator<Item = &'a mut String>) {
        for text in texts {
            self.text(text);
        }
    }

    fn document(&mut self, document: &mut Document) {
        let verdict = &mut document.verdict;
        self.texts([&mut document.title, &mut verdict.headline, &mut verdict.shown]);
        self.texts([&mut verdict.advice]);
        self.texts(verdict.dots.iter_mut().map(|dots| &mut dots.direction));
        self.texts(verdict.sentences.iter_mut().chain(&mut verdict.fine));
        self.texts(&mut document.warnings);
        for (name, value) in &mut document.provenance {
            self.texts([name, value]);
        }
        self.blocks(&mut document.blocks);
    }

    fn blocks(&mut self, blocks: &mut [Block]) {
        for block in blocks {
            match block {
                Block::Heading { text, .. } | Block::Paragraph(text) => self.text(text),
                Block::List(items) => self.texts(items),
                Block::Table(table) => self.table(table),
                Block::Figure(figure) => self.figure(figure),
                Block::Player(player) => {
                    self.text(&mut player.caption);
                    self.scene(&mut player.scene);
                    self.traces(&mut player.traces);
                }
                Block::Players(players) => {
                    self.text(&mut players.caption);
                    for pane in &mut players.panes {
                        self.texts([&mut pane.name, &mut pane.verdict]);
                        self.scene(&mut pane.scene);
                        self.traces(&mut pane.traces);
                    }
                    self.histories(&mut players.ground);
                    self.texts(&mut players.overlay);
                }
                Block::Details { summary, blocks } | Block::OnScreen { what: summary, blocks } => {
                    self.text(summary);
                    self.blocks(blocks);
                }
            }
        }
    }

    fn table(&mut self, table: &mut Table) {
        self.text(&mut table.caption);
        for column in &mut table.columns {
            self.texts([&mut column.name, &mut column.unit]);
        }
        for cell in table.rows.iter_mut().flatten() {
            match cell {
                Cell::Text(text) | Cell::Rated(_, text) => self.text(text),
                Cell::Verbatim(_) | Cell::Number(..) | Cell::Measured(..) | Cell::Missing => {}
            }
        }
    }

    fn figure(&mut self, figure: &mut Figure) {
        figure.language = self.language;
        self.text(&mut figure.caption);
        match &mut figure.kind {
            FigureKind::Plot(plot) => self.plot(plot),
            FigureKind::Panels(panels) => {
                self.text(&mut panels.title);
                self.texts(&mut panels.lines);
                for plot in panels.rows.iter_mut().flatten() {
                    self.plot(plot);
                }
            }
            FigureKind::Strip(strip) => {
                self.scene(&mut strip.scene);
                self.texts(strip.panels.iter_mut().map(|panel| &mut panel.note));
            }
            FigureKind::Envelope(envelope) => {
                let (name, unit) = &mut envelope.coordinate;
                self.texts([name, unit, &mut envelope.unit]);
            }
            FigureKind::Diagram(diagram) => {
                self.scene(&mut diagram.scene);
                self.texts(diagram.labels.iter_mut().map(|(_, label)| label));
                self.texts(diagram.arrows.iter_mut().map(|arrow| &mut arrow.meaning));
            }
            FigureKind::FloorPlan(plan) => {
                self.texts(plan.regions.iter_mut().map(|region| &mut region.label));
                self.texts(plan.heat.iter_mut().map(|heat| &mut heat.label));
                self.texts(plan.marks.iter_mut().map(|(_, name)| name));
            }
        }
    }

    fn plot(&mut self, plot: &mut Plot) {
        for Axis { label, unit, names, .. } in [&mut plot.x, &mut plot.y] {
            self.texts([label, unit].into_iter().chain(names));
        }
        self.texts(plot.series.iter_mut().map(|series| &mut series.label));
        self.texts(plot.marks.iter_mut().chain(&mut plot.levels).map(|mark| &mut mark.label));
        self.texts(plot.bands.iter_mut().map(|band| &mut band.label));
    }

    fn scene(&mut self, scene: &mut Arc<Scene>) {
        let original = Arc::as_ptr(scene);
        if let Some(known) = self.scenes.get(&original) {
            *scene = Arc::clone(known);
            return;
        }
        let mut own = Scene::clone(scene);
        self.events(&mut own.events);
        self.histories(&mut own.ground);
        self.moment(own.moment.as_mut());
        if let Some(tint) = &mut own.tint {
            self.texts([&mut tint.label, &mut tint.unit]);
        }
        self.texts(own.ghosts.iter_mut().map(|ghosts| &mut ghosts.label));
        if let Some(depth) = &mut own.depth {
            self.events(&mut depth.events);
            self.moment(depth.moment.as_mut());
        }
        *scene = Arc::new(own);
        self.scenes.insert(original, Arc::clone(scene));
    }

    fn events(&mut self, events: &mut [Event]) {
        self.texts(events.iter_mut().map(|event| &mut event.text));
    }

    fn moment(&mut self, moment: Option<&mut Moment>) {
        self.texts(moment.map(|moment| &mut moment.text));
    }

    fn histories(&mut self, histories: &mut [History]) {
        for History { label, unit, .. } in histories {
            self.texts([label, unit]);
        }
    }

    fn traces(&mut self, traces: &mut [Trace]) {
        self.texts(traces.iter_mut().map(|trace| &mut trace.label));
    }
}
