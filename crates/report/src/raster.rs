//! Rasterizes drawings to pixels.

use std::collections::HashMap;

use png::{BitDepth, ColorType, Compression, Encoder, PixelDimensions, Unit};
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, Rect, Stroke,
    StrokeDash, Transform,
};
use ttf_parser::OutlineBuilder;

use crate::{
    drawing::Drawing,
    font::Font,
    paint::{Painter, Word, paint},
    style::{Ink, Style},
};

/// Number of CSS pixels per inch.
const PX_PER_INCH: f64 = 96.0;

/// Longest side (pixels) of a picture; larger requests are scaled down.
const LARGEST: f64 = 16_000.0;

/// Returns a drawing as a PNG on white, with a resolution of `dpi` dots per inch.
pub(crate) fn png(drawing: &Drawing, dpi: f64) -> Vec<u8> {
    let pixels = rasterize(drawing, dpi / PX_PER_INCH);
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, pixels.width(), pixels.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    let per_meter = whole(dpi / 0.0254);
    let unit = Unit::Meter;
    encoder.set_pixel_dims(Some(PixelDimensions { xppu: per_meter, yppu: per_meter, unit }));
    // Writing to memory cannot fail, and the sizes agree.
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(&rgb(&pixels)))
        .expect("a picture in memory");
    file
}

/// Returns red, green and blue of every pixel; all pixels are opaque.
pub(crate) fn rgb(pixels: &Pixmap) -> Vec<u8> {
    pixels.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect()
}

/// Paints a drawing on white, with `scale` image pixels per CSS pixel.
pub(crate) fn rasterize(drawing: &Drawing, scale: f64) -> Pixmap {
    let scale = scale.min(LARGEST / drawing.width.max(drawing.height).max(1.0));
    let side = |length: f64| whole((length * scale).ceil().max(1.0));
    let (width, height) = (side(drawing.width), side(drawing.height));
    // Both sides are between 1 and LARGEST, so a picture of that size can be created.
    let mut pixels = Pixmap::new(width, height).expect("a picture of this size");
    pixels.fill(Color::WHITE);
    let mut painter =
        Pixels { canvas: pixels, mask: None, clips: Vec::new(), glyphs: HashMap::new() };
    paint(&drawing.items, scale, &mut painter);
    painter.canvas
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "sides of pictures are bounded"
)]
fn whole(value: f64) -> u32 {
    value as u32
}

/// Converts a coordinate to single precision for the rasterizer.
#[expect(clippy::cast_possible_truncation, reason = "a pixel needs no more digits")]
fn short(value: f64) -> f32 {
    value as f32
}

struct Pixels {
    canvas: Pixmap,
    /// Area that may be painted; `None` for the whole picture.
    mask: Option<Mask>,
    /// Stack of the nested clip rectangles, outermost first: left, top, right and bottom of each. Every rectangle lies
    /// within the one before it.
    clips: Vec<[f64; 4]>,
    glyphs: HashMap<(bool, u16), Option<Path>>,
}

impl Pixels {
    fn draw(&mut self, path: &Path, style: &Style) {
        if let Some(ink) = style.fill {
            let rule = FillRule::Winding;
            let mask = self.mask.as_ref();
            self.canvas.fill_path(path, &solid(ink), rule, Transform::identity(), mask);
        }
        if let (Some(ink), true) = (style.stroke, style.stroke_width > 0.0) {
            let stroke = Stroke {
                width: short(style.stroke_width),
                line_cap: if style.round { LineCap::Round } else { LineCap::Butt },
                line_join: if style.round { LineJoin::Round } else { LineJoin::Miter },
                dash: StrokeDash::new(style.dash.iter().map(|v| short(*v)).collect(), 0.0),
                ..Stroke::default()
            };
            let mask = self.mask.as_ref();
            self.canvas.stroke_path(path, &solid(ink), &stroke, Transform::identity(), mask);
        }
    }

    /// Computes the mask from the innermost clip rectangle.
    fn remask(&mut self) {
        let (width, height) = (self.canvas.width(), self.canvas.height());
        self.mask = self.clips.last().and_then(|&[left, top, right, bottom]| {
            let all = left <= 0.0
                && top <= 0.0
                && right >= f64::from(width)
                && bottom >= f64::from(height);
            if all {
                return None;
            }
            let mut mask = Mask::new(width, height)?;
            let edges = [left, top, right, bottom].map(|v| short(v.round()));
            // An empty rectangle hides everything, and so does an empty mask.
            if let Some(rect) = Rect::from_ltrb(edges[0], edges[1], edges[2], edges[3]) {
                let path = PathBuilder::from_rect(rect);
                mask.fill_path(&path, FillRule::Winding, false, Transform::identity());
            }
            Some(mask)
        });
    }
}

fn solid(ink: Ink) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    let [red, green, blue] = ink.rgb;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let alpha = (255.0 * ink.opacity.clamp(0.0, 1.0)).round() as u8;
    paint.set_color_rgba8(red, green, blue, alpha);
    paint
}

impl Painter for Pixels {
    fn lines(&mut self, runs: &[Vec<[f64; 2]>], closed: bool, style: &Style) {
        let mut path = PathBuilder::new();
        for run in runs {
            let mut points = run.iter().map(|p| p.map(short));
            let Some([x, y]) = points.next() else { continue };
            path.move_to(x, y);
            points.for_each(|[x, y]| path.line_to(x, y));
            if closed {
                path.close();
            } else if run.len() == 1 {
                // A segment of zero length, which round caps turn into a dot.
                path.line_to(x, y);
            }
        }
        if let Some(path) = path.finish() {
            self.draw(&path, style);
        }
    }

    fn circle(&mut self, center: [f64; 2], radius: f64, style: &Style) {
        let [x, y] = center.map(short);
        if let Some(path) = PathBuilder::from_circle(x, y, short(radius)) {
            self.draw(&path, style);
        }
    }

    fn word(&mut self, word: &Word<'_>) {
        let font = Font::of(word.strong);
        let scale = word.size / font.units();
        let paint = solid(word.ink);
        let turn = Transform::from_rotate(short(word.degrees));
        let mut pen = 0.0;
        for (glyph, _, width) in font.glyphs(word.text) {
            let known = self.glyphs.entry((word.strong, glyph)).or_insert_with(|| {
                let mut outline = Outline(PathBuilder::new());
                font.outline(glyph, &mut outline);
                outline.0.finish()
            });
            if let Some(path) = known {
                let place = Transform::from_scale(short(scale), short(-scale))
                    .post_translate(short(pen), 0.0)
                    .post_concat(turn)
                    .post_translate(short(word.at[0]), short(word.at[1]));
                let mask = self.mask.as_ref();
                self.canvas.fill_path(path, &paint, FillRule::Winding, place, mask);
            }
            pen += width * word.size;
        }
    }

    fn clip(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
        let [mut left, mut top, mut right, mut bottom] = [x, y, x + width, y + height];
        if let Some(outer) = self.clips.last() {
            (left, top) = (left.max(outer[0]), top.max(outer[1]));
            (right, bottom) = (right.min(outer[2]), bottom.min(outer[3]));
        }
        self.clips.push([left, top, right, bottom]);
        self.remask();
    }

    fn unclip(&mut self) {
        self.clips.pop();
        self.remask();
    }
}

/// Converts the outline of a glyph to a path.
struct Outline(PathBuilder);

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.0.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.0.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.0.close();
    }
}
