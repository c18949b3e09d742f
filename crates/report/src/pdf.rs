//! Writes drawings as pages of a PDF: vector lines, and text in the bundled font.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::Write as _;

use flate2::{Compression, write::ZlibEncoder};
use pdf_writer::{
    Content, Filter, Finish as _, Name, Pdf, Rect, Ref, Str, TextStr,
    types::{CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, UnicodeCmap},
};
use subsetter::GlyphRemapper;

use crate::{
    drawing::Drawing,
    font::Font,
    paint::{Painter, Word, paint},
    style::{Ink, Style},
    tags::Tags,
};

/// A page: a drawing, its headings for the outline of the document, and its structure tags.
pub(crate) struct Page {
    pub(crate) drawing: Drawing,
    /// Text of each heading, and its distance from the top of the drawing.
    pub(crate) sections: Vec<(String, f64)>,
    /// The structure element of each item of the drawing; `None` for decoration.
    pub(crate) tags: Vec<Option<usize>>,
}

/// Writes pages as a PDF with a title and the structure `tags`; one unit of the drawings is `scale`
/// points.
pub(crate) fn pdf(title: &str, pages: &[Page], mut tags: Tags, scale: f64) -> Vec<u8> {
    let mut file = File { pdf: Pdf::new(), last: 0, ink: Used::default() };
    let (catalog, tree, info) = (file.next(), file.next(), file.next());
    let (resources, structure) = (file.next(), file.next());
    let ids: Vec<Ref> = pages.iter().map(|_| file.next()).collect();
    let mut painted = Vec::new();
    for (at, page) in pages.iter().enumerate() {
        painted.push(file.page((at, page, ids[at]), tree, resources, &mut tags, scale));
    }
    let File { pdf, last, .. } = &mut file;
    tags.write(pdf, structure, &ids, &painted, &mut || {
        *last += 1;
        Ref::new(*last)
    });
    let count = i32::try_from(ids.len()).unwrap_or(i32::MAX);
    file.pdf.pages(tree).kids(ids.iter().copied()).count(count);
    file.resources(resources);
    let sections = file.sections(pages, &ids, scale);
    file.pdf.document_info(info).title(TextStr(title)).producer(TextStr("barrelstack"));
    let mut root = file.pdf.catalog(catalog);
    root.pages(tree).lang(TextStr("en-US"));
    root.viewer_preferences().display_doc_title(true);
    root.mark_info().marked(true);
    root.pair(Name(b"StructTreeRoot"), structure);
    if let Some(sections) = sections {
        root.outlines(sections);
    }
    root.finish();
    file.pdf.finish()
}

/// A PDF file under construction.
struct File {
    pdf: Pdf,
    last: i32,
    ink: Used,
}

/// Fonts and opacities that occur on the pages.
#[derive(Default)]
struct Used {
    /// Used glyphs of each font weight; the key is `true` for bold.
    fonts: BTreeMap<bool, Glyphs>,
    /// Opacities in use, in percent.
    opacities: BTreeSet<u8>,
}

/// Used glyphs of a font, by glyph number, with their characters.
#[derive(Default)]
struct Glyphs {
    numbers: GlyphRemapper,
    characters: HashMap<u16, char>,
}

impl File {
    fn next(&mut self) -> Ref {
        self.last += 1;
        Ref::new(self.last)
    }

    /// Writes a page, and returns the structure elements on the page in the order of their
    /// marked-content identifiers.
    fn page(
        &mut self,
        (at, page, id): (usize, &Page, Ref),
        tree: Ref,
        resources: Ref,
        tags: &mut Tags,
        scale: f64,
    ) -> Vec<usize> {
        let [width, height] = [page.drawing.width, page.drawing.height].map(|side| side * scale);
        let mut painter = Writer { content: Content::new(), height, used: &mut self.ink };
        let mut painted: Vec<usize> = Vec::new();
        let mut items = page.drawing.items.as_slice();
        for run in page.tags.chunk_by(|a, b| a == b) {
            let (here, rest) = items.split_at(run.len().min(items.len()));
            items = rest;
            match run[0] {
                Some(place) => {
                    let number = i32::try_from(painted.len()).unwrap_or(i32::MAX);
                    let role = tags.role(place).to_name();
                    let mut mark = painter.content.begin_marked_content_with_properties(role);
                    mark.properties().identify(number);
                    mark.finish();
                    tags.paint(place, at, number);
                    painted.push(place);
                }
                None => {
                    painter.content.begin_marked_content(Name(b"Artifact"));
                }
            }
            paint(here, scale, &mut painter);
            painter.content.end_marked_content();
        }
        let bytes = deflated(&painter.content.finish());
        let content = self.next();
        let mut written = self.pdf.page(id);
        written.parent(tree).contents(content);
        written.media_box(Rect::new(0.0, 0.0, short(width), short(height)));
        written.pair(Name(b"Resources"), resources);
        written.struct_parents(i32::try_from(at).unwrap_or(i32::MAX));
        written.finish();
        self.pdf.stream(content, &bytes).filter(Filter::FlateDecode);
        painted
    }

    /// Writes the resources that all pages share.
    fn resources(&mut self, id: Ref) {
        let used = std::mem::take(&mut self.ink);
        let fonts: Vec<(String, Ref)> = used
            .fonts
            .iter()
            .map(|(strong, glyphs)| (font_name(*strong), self.font(*strong, glyphs)))
            .collect();
        let mut resources = self.pdf.indirect(id).dict();
        let mut list = resources.insert(Name(b"Font")).dict();
        for (name, font) in &fonts {
            list.pair(Name(name.as_bytes()), *font);
        }
        list.finish();
        let mut states = resources.insert(Name(b"ExtGState")).dict();
        for percent in &used.opacities {
            let opacity = f32::from(*percent) / 100.0;
            let name = opacity_name(*percent);
            let mut state = states.insert(Name(name.as_bytes())).dict();
            state.pair(Name(b"Type"), Name(b"ExtGState"));
            state.pair(Name(b"ca"), opacity).pair(Name(b"CA"), opacity);
        }
    }

    /// Embeds a font, reduced to the used glyphs.
    fn font(&mut self, strong: bool, glyphs: &Glyphs) -> Ref {
        let font = Font::of(strong);
        let [id, descendant, descriptor, program, unicode] = std::array::from_fn(|_| self.next());
        // If the font cannot be reduced, the whole font is embedded.
        let bytes = subsetter::subset(font.bytes, 0, &glyphs.numbers)
            .unwrap_or_else(|_| font.bytes.to_vec());
        let name = format!("BRLSTK+{}", font.name);
        let base = Name(name.as_bytes());
        let system =
            SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
        self.pdf
            .type0_font(id)
            .base_font(base)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(descendant)
            .to_unicode(unicode);
        let mut cid = self.pdf.cid_font(descendant);
        cid.subtype(CidFontType::Type2).base_font(base).system_info(system);
        cid.font_descriptor(descriptor).default_width(0.0);
        cid.cid_to_gid_map_predefined(Name(b"Identity"));
        let widths = glyphs.numbers.remapped_gids().map(|old| short(1000.0 * font.advance(old)));
        cid.widths().consecutive(0, widths);
        cid.finish();
        let thousandths = |length: i16| short((1000.0 * font.share(length)).round());
        let bounds = font.face.global_bounding_box();
        let [left, foot, right, top] =
            [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].map(thousandths);
        // Without a stated height, capitals are assumed to be 0.7 em high, as in most fonts.
        let cap_height = font.face.capital_height().map_or(700.0, thousandths);
        self.pdf
            .font_descriptor(descriptor)
            .name(base)
            .flags(FontFlags::NON_SYMBOLIC)
            .bbox(Rect::new(left, foot, right, top))
            .italic_angle(0.0)
            .ascent(thousandths(font.face.ascender()))
            .descent(thousandths(font.face.descender()))
            .cap_height(cap_height)
            .stem_v(if strong { 130.0 } else { 90.0 })
            .font_file2(program);
        let bytes_deflated = deflated(&bytes);
        let length = i32::try_from(bytes.len()).unwrap_or(i32::MAX);
        self.pdf
            .stream(program, &bytes_deflated)
            .filter(Filter::FlateDecode)
            .pair(Name(b"Length1"), length);
        let mut map = UnicodeCmap::new(Name(b"Custom"), system);
        for (number, old) in glyphs.numbers.remapped_gids().enumerate() {
            if let (Some(character), Ok(number)) =
                (glyphs.characters.get(&old), u16::try_from(number))
            {
                map.pair(number, *character);
            }
        }
        let map = deflated(&map.finish());
        self.pdf.cmap(unicode, &map).filter(Filter::FlateDecode);
        id
    }

    /// Writes the outline of the sections; returns `None` if there are no sections.
    fn sections(&mut self, pages: &[Page], ids: &[Ref], scale: f64) -> Option<Ref> {
        let found: Vec<(&str, Ref, f64)> = pages
            .iter()
            .zip(ids)
            .flat_map(|(page, id)| {
                let height = page.drawing.height;
                page.sections
                    .iter()
                    .map(move |(text, y)| (text.as_str(), *id, scale * (height - y)))
            })
            .collect();
        let list = self.next();
        let items: Vec<Ref> = found.iter().map(|_| self.next()).collect();
        let (first, last) = (items.first()?, items.last()?);
        let count = i32::try_from(items.len()).unwrap_or(i32::MAX);
        self.pdf.outline(list).first(*first).last(*last).count(count);
        for (at, (text, page, y)) in found.into_iter().enumerate() {
            let mut item = self.pdf.outline_item(items[at]);
            item.title(TextStr(text)).parent(list);
            if at > 0 {
                item.prev(items[at - 1]);
            }
            if let Some(next) = items.get(at + 1) {
                item.next(*next);
            }
            item.dest().page(page).xyz(0.0, short(y), None);
        }
        Some(list)
    }
}

fn font_name(strong: bool) -> String {
    if strong { "Strong".into() } else { "Regular".into() }
}

fn opacity_name(percent: u8) -> String {
    format!("O{percent}")
}

fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    // Writing to memory cannot fail.
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("memory")
}

/// Rounds to hundredths of a point, which is precise enough and keeps the file small.
#[expect(clippy::cast_possible_truncation, reason = "a page is a few thousand points high")]
fn short(value: f64) -> f32 {
    ((100.0 * value).round() / 100.0) as f32
}

/// Writes the content of one page.
struct Writer<'a> {
    content: Content,
    /// Height of the page (points); in PDF, y starts at the bottom.
    height: f64,
    used: &'a mut Used,
}

impl Writer<'_> {
    fn at(&self, [x, y]: [f64; 2]) -> [f32; 2] {
        [short(x), short(self.height - y)]
    }

    fn opacity(&mut self, opacity: f64) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 100")]
        let percent = (100.0 * opacity.clamp(0.0, 1.0)).round() as u8;
        self.used.opacities.insert(percent);
        self.content.set_parameters(Name(opacity_name(percent).as_bytes()));
    }

    /// Fills and strokes the path drawn by `trace`; fill and stroke have separate opacities.
    fn draw(&mut self, style: &Style, trace: &dyn Fn(&mut Self)) {
        if let Some(ink) = style.fill {
            self.opacity(ink.opacity);
            let [red, green, blue] = color(ink);
            self.content.set_fill_rgb(red, green, blue);
            trace(self);
            self.content.fill_nonzero();
        }
        if let (Some(ink), true) = (style.stroke, style.stroke_width > 0.0) {
            self.opacity(ink.opacity);
            let [red, green, blue] = color(ink);
            self.content.set_stroke_rgb(red, green, blue);
            self.content.set_line_width(short(style.stroke_width));
            self.content.set_dash_pattern(style.dash.iter().map(|v| short(*v)), 0.0);
            let (cap, join) = if style.round {
                (LineCapStyle::RoundCap, LineJoinStyle::RoundJoin)
            } else {
                (LineCapStyle::ButtCap, LineJoinStyle::MiterJoin)
            };
            self.content.set_line_cap(cap).set_line_join(join);
            trace(self);
            self.content.stroke();
        }
    }
}

fn color(ink: Ink) -> [f32; 3] {
    ink.rgb.map(|part| f32::from(part) / 255.0)
}

impl Painter for Writer<'_> {
    fn lines(&mut self, runs: &[Vec<[f64; 2]>], closed: bool, style: &Style) {
        if runs.is_empty() {
            return;
        }
        self.draw(style, &|writer| {
            for run in runs {
                for (at, point) in run.iter().enumerate() {
                    let [x, y] = writer.at(*point);
                    if at == 0 {
                        writer.content.move_to(x, y);
                    }
                    // A single point is a segment of zero length, which round caps turn into a dot.
                    if at > 0 || run.len() == 1 {
                        writer.content.line_to(x, y);
                    }
                }
                if closed {
                    writer.content.close_path();
                }
            }
        });
    }

    fn circle(&mut self, [x, y]: [f64; 2], radius: f64, style: &Style) {
        /// Distance of each control point from the nearer end of the cubic that approximates a quarter circle, as a
        /// fraction of the radius.
        const HANDLE: f64 = 0.552_284_75;
        self.draw(style, &|writer| {
            let spot = |u: f64, v: f64| writer.at([x + radius * u, y + radius * v]);
            let start = spot(1.0, 0.0);
            let mut quarters = Vec::new();
            for [u, v] in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]] {
                // A quarter circle from (u, v) to (−v, u).
                let first = spot(u - HANDLE * v, v + HANDLE * u);
                let second = spot(-v + HANDLE * u, u + HANDLE * v);
                quarters.push([first, second, spot(-v, u)]);
            }
            writer.content.move_to(start[0], start[1]);
            for [a, b, c] in quarters {
                writer.content.cubic_to(a[0], a[1], b[0], b[1], c[0], c[1]);
            }
            writer.content.close_path();
        });
    }

    fn word(&mut self, word: &Word<'_>) {
        self.opacity(word.ink.opacity);
        let glyphs = self.used.fonts.entry(word.strong).or_default();
        let mut shown = Vec::new();
        for (glyph, character, _) in Font::of(word.strong).glyphs(word.text) {
            shown.extend(glyphs.numbers.remap(glyph).to_be_bytes());
            glyphs.characters.entry(glyph).or_insert(character);
        }
        let [red, green, blue] = color(word.ink);
        let [x, y] = self.at(word.at);
        let (sin, cos) = word.degrees.to_radians().sin_cos();
        // The matrix needs more digits than positions do.
        #[expect(clippy::cast_possible_truncation, reason = "between −1 and 1")]
        let [sin, cos] = [sin as f32, cos as f32];
        self.content.set_fill_rgb(red, green, blue).begin_text();
        self.content.set_font(Name(font_name(word.strong).as_bytes()), short(word.size));
        self.content.set_text_matrix([cos, -sin, sin, cos, x, y]);
        self.content.show(Str(&shown)).end_text();
    }

    fn clip(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
        let [left, foot] = self.at([x, y + height]);
        self.content.save_state();
        self.content.rect(left, foot, short(width), short(height));
        self.content.clip_nonzero().end_path();
    }

    fn unclip(&mut self) {
        self.content.restore_state();
    }
}
