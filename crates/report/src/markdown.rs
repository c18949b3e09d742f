//! A document as Markdown, with its figures in separate files.

use crate::document::{SCOPE, SIGNATURE};
use crate::{
    Attachment, Block, Document, Event, Language, Player, Players, Table, Word, attachments,
    document::FINE,
    escape,
    figure::{Counter, Names, pane_letter},
    glossary, number, stamp,
};

/// Markdown text, and the files to which the text refers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MarkdownBundle {
    /// The text.
    pub text: String,
    /// Figures as SVG and CSV, and tables as CSV. The text refers to them by paths in the folder `figure_dir` of
    /// [`markdown`].
    pub files: Vec<Attachment>,
}

/// Writes the document as GitHub-flavored Markdown.
///
/// Each string in [`Verdict::sentences`](crate::Verdict::sentences) and [`Verdict::fine`](crate::Verdict::fine) is on
/// its own line.
///
/// `figure_dir` is the folder of the figures relative to the text, with `/` as separator; if it is
/// empty, the figures are beside the text. A player becomes a strip of frames and a table of
/// events.
pub fn markdown(document: &Document, figure_dir: &str) -> MarkdownBundle {
    let mut writer = Writer {
        out: String::new(),
        folder: figure_dir.trim_end_matches('/').to_owned(),
        names: Names::default(),
        counter: Counter::default(),
        language: document.language,
    };
    let t = |english| document.language.fixed(english);
    let verdict = &document.verdict;
    writer.line(&format!("# {}\n", escape::markdown(&document.title)));
    let headline = escape::markdown(&verdict.headline);
    writer.line(&format!("**{}: {headline}**\n", t(verdict.tone.word())));
    if !verdict.shown.is_empty() {
        writer.line(&format!("{}\n", escape::markdown(&verdict.shown)));
    }
    let (opening, rest) = document.parted();
    writer.blocks(opening, 0);
    if !verdict.advice.is_empty() {
        writer.line(&format!("**{}**\n", escape::markdown(&verdict.advice)));
    }
    for sentence in &verdict.sentences {
        writer.line(&escape::markdown(sentence));
    }
    writer.line("");
    if !verdict.command.is_empty() {
        let to = t("To compare the stack with and without the change:");
        writer.line(&format!("{to}\n\n    {}\n", verdict.command));
    }
    if !document.warnings.is_empty() {
        writer.line(&format!("## {}\n", t("Warnings")));
        writer.list(&document.warnings);
    }
    if !verdict.fine.is_empty() {
        writer.line(&format!("## {}\n", t(FINE)));
        for sentence in &verdict.fine {
            writer.line(&escape::markdown(sentence));
        }
        writer.line("");
    }
    writer.blocks(rest, 0);
    let words = glossary::used(&document.words, &writer.out);
    if !words.is_empty() {
        writer.line(&format!("## {}\n", t(glossary::TITLE)));
        let line = |one: &&Word| format!("**{}**: {}", one.word, escape::markdown(one.meaning));
        for one in words.iter().map(line) {
            writer.line(&format!("- {one}"));
        }
        writer.line("");
    }
    let provenance = stamp::provenance(document);
    if !provenance.is_empty() {
        let heads = ["Provenance", "what", "value"].map(t);
        let [title, what, value] = heads;
        writer.line(&format!("## {title}\n\n| {what} | {value} |\n| :--- | :--- |"));
        for (name, value) in &provenance {
            writer.line(&format!("| {} | {} |", escape::markdown(name), escape::markdown(value)));
        }
        for line in SIGNATURE {
            writer.line(&format!("| {} | |", t(line)));
        }
        writer.line(&format!("\n{}\n", document.language.text(SCOPE)));
    }
    let text = format!("{}\n", writer.out.trim_end());
    MarkdownBundle { text, files: attachments(document) }
}

struct Writer {
    out: String,
    folder: String,
    names: Names,
    counter: Counter,
    language: Language,
}

impl Writer {
    fn line(&mut self, text: &str) {
        self.out.push_str(text);
        self.out.push('\n');
    }

    fn list(&mut self, items: &[String]) {
        for item in items {
            self.line(&format!("- {}", escape::markdown(item)));
        }
        self.line("");
    }

    fn blocks(&mut self, blocks: &[Block], deeper: usize) {
        for block in blocks {
            match block {
                Block::Heading { level, text } => {
                    let depth = usize::from((*level).clamp(2, 4)) + deeper;
                    let hashes = "#".repeat(depth.min(6));
                    self.line(&format!("{hashes} {}\n", escape::markdown(text)));
                }
                Block::Paragraph(text) => self.line(&format!("{}\n", escape::markdown(text))),
                Block::List(items) => self.list(items),
                Block::Table(table) => self.table(table),
                Block::Figure(figure) => {
                    let number = self.counter.figure().to_string();
                    self.picture(&number, &figure.id, &figure.caption);
                }
                Block::Player(player) => self.player(player),
                Block::Players(players) => self.players(players),
                Block::Details { summary, blocks } => {
                    self.line(&format!("**{}**\n", escape::markdown(summary)));
                    self.blocks(blocks, deeper + 1);
                }
                Block::OnScreen { blocks, .. } => self.blocks(blocks, deeper),
            }
        }
    }

    fn picture(&mut self, number: &str, id: &str, caption: &str) {
        let name = self.names.take(id);
        let folder = if self.folder.is_empty() {
            String::new()
        } else {
            // Spaces and parentheses would end the link.
            let safe = self.folder.replace('%', "%25").replace(' ', "%20");
            format!("{}/", safe.replace('(', "%28").replace(')', "%29"))
        };
        let caption = escape::markdown(caption);
        let [figure, data] = ["Figure", "data"].map(|text| self.language.fixed(text));
        self.line(&format!("![{figure} {number}]({folder}{name}.svg)\n"));
        self.line(&format!("**{figure} {number}.** {caption} ([{data}]({folder}{name}.csv))\n"));
    }

    fn player(&mut self, player: &Player) {
        let number = self.counter.figure().to_string();
        self.picture(&number, &player.id, &player.caption);
        self.events(player.scene.events.iter().map(|event| ("", event)).collect());
    }

    fn players(&mut self, players: &Players) {
        let number = self.counter.figure();
        let figure = self.language.fixed("Figure");
        self.line(&format!("**{figure} {number}.** {}\n", escape::markdown(&players.caption)));
        let mut events = Vec::new();
        for (at, (pane, figure)) in players.panes.iter().zip(players.paper_figures()).enumerate() {
            let number = format!("{number}{}", pane_letter(at));
            self.picture(&number, &figure.id, &figure.caption);
            events.extend(pane.scene.events.iter().map(|event| (pane.mark.as_str(), event)));
        }
        events.sort_by(|a: &(&str, &Event), b| a.1.time.total_cmp(&b.1.time));
        self.events(events);
    }

    /// Writes the table of events. Each event is paired with the mark of its pane, which is empty if there is only one
    /// pane.
    fn events(&mut self, mut events: Vec<(&str, &Event)>) {
        events.retain(|(_, event)| event.time.is_finite());
        if events.is_empty() {
            return;
        }
        let [time, event] = ["time", "event"].map(|text| self.language.fixed(text));
        self.line(&format!("| {time} (s) | {event} | |\n| ---: | :--- | :--- |"));
        for (pane, event) in events {
            let time = number::fixed(event.time, 2);
            let who = if pane.is_empty() { String::new() } else { format!("{pane}: ") };
            let text = escape::markdown(&format!("{who}{}", event.text));
            self.line(&format!("| {time} | {} | {text} |", event.kind.word_in(self.language)));
        }
        self.line("");
    }

    fn table(&mut self, table: &Table) {
        let number = self.counter.table();
        let word = self.language.fixed("Table");
        self.line(&format!("**{word} {number}.** {}\n", escape::markdown(&table.caption)));
        if table.columns.is_empty() {
            return;
        }
        let line = |cells: Vec<String>| {
            let cells = cells.iter().map(|cell| format!(" {} |", escape::markdown(cell)));
            format!("|{}", cells.collect::<String>())
        };
        self.line(&line(table.columns.iter().map(crate::Column::heading).collect()));
        let rule = |numeric| if numeric { " ---: |" } else { " :--- |" };
        let rules: String = table.numeric().into_iter().map(rule).collect();
        self.line(&format!("|{rules}"));
        for row in &table.rows {
            self.line(&line(table.shown(row).collect()));
        }
        self.line("");
    }
}
