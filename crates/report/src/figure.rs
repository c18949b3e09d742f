//! A figure: one picture with a caption, as SVG and as CSV.

use std::collections::HashSet;

use crate::{Block, Document, Envelope, Plot, Strip, drawing::Drawing, escape, pages, raster};

/// One picture with a caption.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Short name, made safe for files and anchors; a repeated one gets a number behind it.
    pub id: String,
    /// What the picture shows and how to read it.
    pub caption: String,
    /// The picture.
    pub kind: FigureKind,
}

/// The kinds of pictures.
#[derive(Clone, Debug, PartialEq)]
pub enum FigureKind {
    /// Lines over a pair of axes.
    Plot(Plot),
    /// A scene at chosen instants, side by side.
    Strip(Strip),
    /// Stress drawn around a body's outline.
    Envelope(Envelope),
}

impl Figure {
    /// The picture as a standalone SVG document: white ground, text as text, f64 coordinates.
    pub fn to_svg(&self) -> String {
        self.draw(&escape::slug(&self.id)).standalone()
    }

    /// The picture as a PNG of `dpi` dots per inch on white; its 12 px letters are 9 points high.
    /// The words are drawn with the bundled font, so the same figure gives the same file anywhere.
    pub fn to_png(&self, dpi: f64) -> Vec<u8> {
        raster::png(&self.draw(&escape::slug(&self.id)), dpi)
    }

    /// The picture as a PDF page of its size: lines as lines, words as words in the bundled font.
    pub fn to_pdf(&self) -> Vec<u8> {
        pages::figure_pdf(self)
    }

    /// The picture's data as CSV at full precision.
    ///
    /// A plot gives `x` columns beside `y` columns, one pair for each series; a strip gives one
    /// row for each instant and body; an envelope one row for each sample.
    pub fn to_csv(&self) -> String {
        match &self.kind {
            FigureKind::Plot(plot) => plot.to_csv(),
            FigureKind::Strip(strip) => strip.to_csv(),
            FigureKind::Envelope(envelope) => envelope.to_csv(),
        }
    }

    pub(crate) fn draw(&self, id: &str) -> Drawing {
        match &self.kind {
            FigureKind::Plot(plot) => plot.draw(id, &self.caption),
            FigureKind::Strip(strip) => strip.draw(id, &self.caption),
            FigureKind::Envelope(envelope) => envelope.draw(&self.caption),
        }
    }
}

/// A file that goes beside a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attachment {
    /// File name without a folder.
    pub name: String,
    /// Content.
    pub bytes: Vec<u8>,
}

/// Every figure of a document as `<id>.svg` and `<id>.csv`, every table as `table-<n>.csv`,
/// every player as the SVG and CSV of its picture on paper, in reading order.
pub fn attachments(document: &Document) -> Vec<Attachment> {
    let mut files = Vec::new();
    let mut names = Names::default();
    let mut tables = 0;
    gather(document, &document.blocks, &mut names, &mut tables, &mut files);
    files
}

fn gather(
    document: &Document,
    blocks: &[Block],
    names: &mut Names,
    tables: &mut usize,
    files: &mut Vec<Attachment>,
) {
    for block in blocks {
        match block {
            Block::Figure(figure) => {
                let id = names.take(&figure.id);
                files.push(Attachment::text(format!("{id}.svg"), figure.to_svg()));
                files.push(Attachment::text(format!("{id}.csv"), figure.to_csv()));
            }
            Block::Player(player) => {
                let id = names.take(&player.id);
                let figure = player.paper_figure(&document.blocks);
                files.push(Attachment::text(format!("{id}.svg"), figure.to_svg()));
                files.push(Attachment::text(format!("{id}.csv"), figure.to_csv()));
            }
            Block::Table(table) => {
                *tables += 1;
                files.push(Attachment::text(format!("table-{tables}.csv"), table.to_csv()));
            }
            Block::Details { blocks, .. } => gather(document, blocks, names, tables, files),
            Block::Heading { .. } | Block::Paragraph(_) | Block::List(_) => {}
        }
    }
}

impl Attachment {
    fn text(name: String, text: String) -> Self {
        Self { name, bytes: text.into_bytes() }
    }
}

/// Gives out names that differ, the same ones for the same document in every format.
#[derive(Default)]
pub(crate) struct Names {
    taken: HashSet<String>,
}

impl Names {
    pub(crate) fn take(&mut self, wish: &str) -> String {
        let base = escape::slug(wish);
        let mut name = base.clone();
        let mut count = 1;
        while !self.taken.insert(name.clone()) {
            count += 1;
            name = format!("{base}-{count}");
        }
        name
    }
}
