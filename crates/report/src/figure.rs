//! A figure: one picture with a caption, as SVG and as CSV.

use std::collections::HashSet;

use crate::{
    Block, Diagram, Document, Envelope, FloorPlan, Language, Panels, Plot, Strip,
    drawing::{Drawing, Room},
    escape, pages, raster,
};

/// One picture with a caption.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Short name, from which names of files and anchors are derived; a number is appended to a
    /// repeated name.
    pub id: String,
    /// Caption: what the picture shows and how to read it.
    pub caption: String,
    /// The picture.
    pub kind: FigureKind,
    /// Language of the words that the picture adds, such as those of a legend.
    pub language: Language,
}

/// The kinds of pictures.
#[derive(Clone, Debug, PartialEq)]
pub enum FigureKind {
    /// Series plotted on a pair of axes.
    Plot(Plot),
    /// Several plots in rows.
    Panels(Panels),
    /// A scene at selected instants, side by side.
    Strip(Strip),
    /// Stress drawn around a body's outline.
    Envelope(Envelope),
    /// A scene at one instant with labels and arrows.
    Diagram(Diagram),
    /// A floor plan.
    FloorPlan(FloorPlan),
}

macro_rules! kinds {
    ($($kind:ident),*) => {
        $(impl From<$kind> for FigureKind {
            fn from(picture: $kind) -> Self {
                Self::$kind(picture)
            }
        })*
    };
}

kinds!(Plot, Panels, Strip, Envelope, Diagram, FloorPlan);

impl Figure {
    /// Creates a figure.
    pub fn new(
        id: impl Into<String>,
        caption: impl Into<String>,
        picture: impl Into<FigureKind>,
    ) -> Self {
        let language = Language::English;
        Self { id: id.into(), caption: caption.into(), kind: picture.into(), language }
    }

    /// Returns the figure with another language for the words that the picture adds; all other strings are unchanged.
    #[must_use]
    pub(crate) fn in_language(self, language: Language) -> Self {
        Self { language, ..self }
    }

    /// Returns the picture as a standalone SVG document with a white background; text remains text.
    pub fn to_svg(&self) -> String {
        self.draw(&escape::slug(&self.id)).standalone()
    }

    /// Returns the picture in a format; `dpi` (dots per inch) applies to PNG.
    pub fn to_bytes(&self, format: Format, dpi: f64) -> Vec<u8> {
        match format {
            Format::Svg => self.to_svg().into_bytes(),
            Format::Png => self.to_png(dpi),
            Format::Pdf => self.to_pdf(),
        }
    }

    /// Returns the picture as a PNG with a white background and a resolution of `dpi` dots per inch. One px is 1/96
    /// inch, so a font size of 12 px is 9 points at any resolution.
    ///
    /// Text is drawn with the bundled font, so the same figure gives the same file on every
    /// machine.
    pub fn to_png(&self, dpi: f64) -> Vec<u8> {
        raster::png(&self.draw(&escape::slug(&self.id)), dpi)
    }

    /// Returns the picture as a PDF page of its own size, with vector lines and with text in the
    /// bundled font.
    pub fn to_pdf(&self) -> Vec<u8> {
        pages::figure_pdf(self)
    }

    /// Returns the picture's data as CSV at full precision.
    ///
    /// A plot gives one pair of `x` and `y` columns per series. Panels give the columns of each
    /// plot, one plot below the other, separated by an empty line. A strip gives one row per
    /// instant and body, an envelope one row per sample, a diagram one row per arrow, and a floor plan
    /// one row per corner, mark and cell.
    pub fn to_csv(&self) -> String {
        match &self.kind {
            FigureKind::Plot(plot) => plot.to_csv(),
            FigureKind::Panels(panels) => panels.to_csv(),
            FigureKind::Strip(strip) => strip.to_csv(),
            FigureKind::Envelope(envelope) => envelope.to_csv(),
            FigureKind::Diagram(diagram) => diagram.to_csv(),
            FigureKind::FloorPlan(plan) => plan.to_csv(),
        }
    }

    pub(crate) fn draw(&self, id: &str) -> Drawing {
        self.draw_in(id, Room::Page)
    }

    /// Draws the picture for an available width; a strip is drawn the same for all widths, because the page wraps its
    /// panels.
    pub(crate) fn draw_in(&self, id: &str, room: Room) -> Drawing {
        match &self.kind {
            FigureKind::Plot(plot) => plot.draw(id, &self.caption, room),
            FigureKind::Panels(panels) => panels.draw(id, &self.caption, room),
            FigureKind::Strip(strip) => strip.draw(id, &self.caption, self.language),
            FigureKind::Envelope(envelope) => envelope.draw(&self.caption, room, self.language),
            FigureKind::Diagram(diagram) => diagram.draw(id, &self.caption, room),
            FigureKind::FloorPlan(plan) => plan.draw(id, &self.caption, room, self.language),
        }
    }
}

/// A file that accompanies a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attachment {
    /// File name without a folder.
    pub name: String,
    /// Content.
    pub bytes: Vec<u8>,
}

/// The file formats of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Vector graphics, for pages and for editing.
    Svg,
    /// Raster graphics.
    Png,
    /// Vector graphics, for typesetting.
    Pdf,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 3] = [Self::Svg, Self::Png, Self::Pdf];

    /// Returns the file extension, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Pdf => "pdf",
        }
    }
}

/// Returns every figure of a document with the name of its files, in reading order; a player is
/// represented by its printed picture.
pub fn figures(document: &Document) -> Vec<(String, Figure)> {
    let mut found = Vec::new();
    let mut names = Names::default();
    walk(&document.blocks, &mut |block| match block {
        Block::Figure(figure) => found.push((names.take(&figure.id), figure.clone())),
        Block::Player(player) => {
            let drawn = player.paper_figure(&document.blocks).in_language(document.language);
            found.push((names.take(&player.id), drawn));
        }
        Block::Players(players) => {
            let drawn = players.paper_figures();
            found.extend(
                drawn
                    .into_iter()
                    .map(|figure| (names.take(&figure.id), figure.in_language(document.language))),
            );
        }
        Block::Heading { .. }
        | Block::Paragraph(_)
        | Block::List(_)
        | Block::Table(_)
        | Block::Details { .. }
        | Block::OnScreen { .. } => {}
    });
    found
}

/// Returns the files of a document in reading order.
///
/// Every figure is written as `<id>.svg` and `<id>.csv`, every player as the SVG and CSV of its
/// printed picture, and every table as `table-<n>.csv`.
pub fn attachments(document: &Document) -> Vec<Attachment> {
    let mut files = Vec::new();
    for (id, figure) in figures(document) {
        files.push(Attachment::text(format!("{id}.svg"), figure.to_svg()));
        files.push(Attachment::text(format!("{id}.csv"), figure.to_csv()));
    }
    let mut tables = 0;
    walk(&document.blocks, &mut |block| {
        if let Block::Table(table) = block {
            tables += 1;
            files.push(Attachment::text(format!("table-{tables}.csv"), table.to_csv()));
        }
    });
    files
}

/// Visits blocks in reading order, including collapsed blocks.
pub(crate) fn walk(blocks: &[Block], visit: &mut dyn FnMut(&Block)) {
    for block in blocks {
        visit(block);
        if let Block::Details { blocks, .. } | Block::OnScreen { blocks, .. } = block {
            walk(blocks, visit);
        }
    }
}

impl Attachment {
    fn text(name: String, text: String) -> Self {
        Self { name, bytes: text.into_bytes() }
    }
}

/// Numbers of figures and tables, in reading order; they are the same in every format.
#[derive(Clone, Copy, Default)]
pub(crate) struct Counter {
    pub(crate) figures: usize,
    pub(crate) tables: usize,
}

impl Counter {
    /// Returns the number of the next figure; the panes of a player share one number.
    pub(crate) fn figure(&mut self) -> usize {
        self.figures += 1;
        self.figures
    }

    /// Returns the number of the next table.
    pub(crate) fn table(&mut self) -> usize {
        self.tables += 1;
        self.tables
    }

    /// Counts the figures and tables of blocks that are not written here, so that the numbers continue after them.
    pub(crate) fn skip(&mut self, blocks: &[Block]) {
        walk(blocks, &mut |block| match block {
            Block::Figure(_) | Block::Player(_) | Block::Players(_) => self.figures += 1,
            Block::Table(_) => self.tables += 1,
            Block::Heading { .. }
            | Block::Paragraph(_)
            | Block::List(_)
            | Block::Details { .. }
            | Block::OnScreen { .. } => {}
        });
    }
}

/// Returns the suffix of the figure number for one of several panes that share the number: `a` to `z` for the panes
/// with index 0 to 25, then `-27`, `-28` and so on.
pub(crate) fn pane_letter(pane: usize) -> String {
    u8::try_from(pane)
        .ok()
        .filter(|at| *at < 26)
        .map_or_else(|| format!("-{}", pane + 1), |at| char::from(b'a' + at).to_string())
}

/// Assigns unique names, such as those of figure files and anchors. A document gets the same names in every format.
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
