//! A document: a verdict, blocks in reading order, warnings and provenance.

use crate::{Dots, Figure, Language, Player, Players, Table, figure::Counter};

/// The content of a report or page, independent of the output format.
///
/// [`html`](crate::html) and [`markdown`](crate::markdown) read the same value, so both show the
/// same numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// Name of the run or study; the page title.
    pub title: String,
    /// The answer in plain language; opens the page.
    pub verdict: Verdict,
    /// Content in reading order.
    pub blocks: Vec<Block>,
    /// Provenance: pairs of name and value, shown at the end.
    pub provenance: Vec<(String, String)>,
    /// Technical terms with their meanings; terms that occur in the document are explained where
    /// they occur and listed at the end.
    pub words: Vec<Word>,
    /// Warnings that the reader must know before relying on the result; shown directly after the
    /// first player.
    pub warnings: Vec<String>,
    /// Language of the strings; see [`Document::in_language`].
    pub language: Language,
}

impl Document {
    /// Splits the blocks after the first picture; the first part is empty if there is no picture.
    ///
    /// The first picture is the first player or, without a player, a figure or table that opens the document. In the
    /// output, the sentences of the verdict are between the two parts.
    pub(crate) fn parted(&self) -> (&[Block], &[Block]) {
        let player = |block: &Block| matches!(block, Block::Player(_) | Block::Players(_));
        let opens = |at: &usize| matches!(self.blocks[*at], Block::Figure(_) | Block::Table(_));
        let blocks = &self.blocks;
        let first = || blocks.iter().position(|block| !matches!(block, Block::Heading { .. }));
        let picture = blocks.iter().position(player).or_else(|| first().filter(opens));
        blocks.split_at(picture.map_or(0, |at| at + 1))
    }
}

/// Note on what a report does and does not state, shown after the provenance.
pub(crate) const SCOPE: &str = "This page states the results of a model for the inputs that are listed on the page. \
                         It does not replace the judgment of an engineer who has inspected the stack, its racks and its floor.";

/// Labels of the lines after the provenance that are filled in by hand.
pub(crate) const SIGNATURE: [&str; 4] = ["project", "prepared by", "checked by", "date"];

/// A technical term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// The term as it occurs in a sentence.
    pub word: &'static str,
    /// Meaning of the term in everyday words.
    pub meaning: &'static str,
}

/// The answer in plain language.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdict {
    /// The answer in brief, shown in the largest type on the page. Of a long headline, only the opening is shown in
    /// this type.
    pub headline: String,
    /// Outcomes of all variants, one entry for each direction; empty for a single run.
    pub dots: Vec<Dots>,
    /// Statement on the run that the first picture shows, placed above this picture; may be empty.
    pub shown: String,
    /// Recommended action, as one sentence; may be empty.
    pub advice: String,
    /// A command that shows the effect of the advice; may be empty.
    pub command: String,
    /// Sentences that support the headline, in order.
    pub sentences: Vec<String>,
    /// Sentences with the numbers that support the headline, in a collapsed section on screen.
    pub fine: Vec<String>,
    /// Tone of the verdict, which determines the symbol and the color beside the headline.
    pub tone: Tone,
}

/// Maximum length (bytes) of a headline that is shown as one heading.
const ONE_HEADING: usize = 180;

/// Minimum length (bytes) of the first part when a text is split by [`opening`].
const OPENING: usize = 30;

impl Verdict {
    /// Returns the sentences of the headline that open a page, and the remaining sentences, which follow in smaller
    /// type.
    pub(crate) fn opening(&self) -> (&str, &str) {
        opening(&self.headline, ONE_HEADING)
    }
}

/// Splits a text that is longer than `whole` (bytes) into its opening sentences and the remaining sentences. The second
/// part is empty if the text is not longer, or has no end of a sentence at which to split it.
pub(crate) fn opening(text: &str, whole: usize) -> (&str, &str) {
    let end = text.match_indices(". ").map(|(at, _)| at + 1).find(|end| *end >= OPENING);
    match end.filter(|_| text.len() > whole) {
        Some(end) => (&text[..end], text[end..].trim_start()),
        None => (text, ""),
    }
}

/// The kind of verdict; always shown as a symbol and a word, never by color alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    /// The stack stands.
    Stands,
    /// The stack falls.
    Falls,
    /// The result is not valid.
    Invalid,
    /// No verdict, as for a study, a comparison or a record.
    #[default]
    Neutral,
}

impl Tone {
    /// Returns the word shown beside the symbol.
    pub fn word(self) -> &'static str {
        match self {
            Self::Stands => "Stands",
            Self::Falls => "Falls",
            Self::Invalid => "Not valid",
            Self::Neutral => "Summary",
        }
    }

    /// Returns the CSS class that sets the color.
    pub fn class(self) -> &'static str {
        match self {
            Self::Stands => "stands",
            Self::Falls => "falls",
            Self::Invalid => "invalid",
            Self::Neutral => "neutral",
        }
    }
}

impl Block {
    /// Creates a heading.
    pub fn heading(level: u8, text: impl Into<String>) -> Self {
        Self::Heading { level, text: text.into() }
    }

    /// Creates content that is not printed. On paper, a sentence that begins with `what` refers to
    /// the HTML page instead.
    pub fn on_screen(what: impl Into<String>, blocks: Vec<Self>) -> Self {
        Self::OnScreen { what: what.into(), blocks }
    }

    /// Creates a block that is collapsed under a summary line on screen, and left out on paper.
    pub fn details_on_screen(summary: impl Into<String>, blocks: Vec<Self>) -> Self {
        let summary = summary.into();
        Self::on_screen(summary.clone(), vec![Self::details(summary, blocks)])
    }

    /// Creates a block that is collapsed under a summary line.
    pub fn details(summary: impl Into<String>, blocks: Vec<Self>) -> Self {
        Self::Details { summary: summary.into(), blocks }
    }
}

/// Summary line of the collapsed section that contains [`Verdict::fine`].
pub(crate) const FINE: &str = "The numbers behind the verdict";

/// Returns the sentence that is printed in place of content that is shown only on screen.
///
/// The sentence consists of `what`, the numbers of the figures and tables in the content, and a reference to the HTML
/// page. `before` and `after` are the counters before and after the content.
pub(crate) fn elsewhere(what: &str, [before, after]: [Counter; 2], language: Language) -> String {
    let numbers =
        [("figure", before.figures, after.figures), ("table", before.tables, after.tables)];
    let list = numbers.into_iter().filter_map(|(word, before, after)| match after - before {
        0 => None,
        1 => Some(language.text(&format!("{word} {after}"))),
        _ => Some(language.text(&format!("{word}s {} to {after}", before + 1))),
    });
    let list = list.collect::<Vec<_>>().join(", ");
    let list = if list.is_empty() { list } else { format!(" ({list})") };
    format!("{what}{list}: {}.", language.fixed("see the HTML page of this report"))
}

/// One piece of content. All text is plain text, which is escaped and never interpreted as markup.
#[expect(
    clippy::large_enum_variant,
    reason = "a document has tens of blocks, so boxing them saves little"
)]
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A heading; levels are clamped to the range from 2 to 4, because level 1 is the verdict.
    Heading {
        /// Level; 2 opens a section and is listed in the contents of the page.
        level: u8,
        /// The text.
        text: String,
    },
    /// A paragraph of plain text.
    Paragraph(String),
    /// A bulleted list of plain sentences.
    List(Vec<String>),
    /// A table.
    Table(Table),
    /// A figure with its caption.
    Figure(Figure),
    /// An animated scene with controls; on paper and in Markdown, a strip of frames and the events.
    Player(Player),
    /// Several scenes side by side with one set of controls; on paper and in Markdown, a strip of
    /// frames for each scene (at the same times for all) and the events.
    Players(Players),
    /// Content that is collapsed on screen and always open on paper.
    Details {
        /// The line that stays visible.
        summary: String,
        /// The collapsed content.
        blocks: Vec<Block>,
    },
    /// Content that is shown on screen and in Markdown; on paper, a sentence refers to the HTML page.
    OnScreen {
        /// Description of the content, such as "Displacements".
        what: String,
        /// The content.
        blocks: Vec<Block>,
    },
}
