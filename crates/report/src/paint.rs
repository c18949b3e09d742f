//! Converts a drawing to strokes, fills and text at absolute positions, for formats without style
//! sheets.

use std::collections::HashMap;

use crate::{
    drawing::{Anchor, Body, Item, Placed, Runs},
    font::Font,
    style::{Ink, Style, Tag, dashes},
};

/// A drawing target, such as a raster image or a page of a PDF. Coordinates are in px from the upper
/// left corner, with y downward.
pub(crate) trait Painter {
    /// Draws polylines; the lengths in `style`, such as the line width, are already scaled.
    fn lines(&mut self, runs: &[Vec<[f64; 2]>], closed: bool, style: &Style);
    /// Draws a circle.
    fn circle(&mut self, center: [f64; 2], radius: f64, style: &Style);
    /// Draws a line of text at its position.
    fn word(&mut self, word: &Word<'_>);
    /// Clips the following items to this rectangle, in addition to the clip rectangles already set.
    fn clip(&mut self, lower: [f64; 2], size: [f64; 2]);
    /// Removes the last clip rectangle.
    fn unclip(&mut self);
}

/// A line of text at its position.
pub(crate) struct Word<'a> {
    pub(crate) text: &'a str,
    /// Start of the baseline.
    pub(crate) at: [f64; 2],
    /// Clockwise rotation about `at`.
    pub(crate) degrees: f64,
    pub(crate) size: f64,
    pub(crate) strong: bool,
    pub(crate) ink: Ink,
}

/// Paints the items of a drawing, scaled by `scale`, with the upper left corner at the origin.
pub(crate) fn paint(items: &[Item], scale: f64, painter: &mut dyn Painter) {
    let mut walk = Walk { painter, bodies: HashMap::new(), styles: HashMap::new() };
    walk.items(items, &Transform { origin: [0.0; 2], scale, turn: [1.0, 0.0], up: false });
}

/// Transform from the coordinates of an item to the coordinates of the picture.
#[derive(Clone, Copy)]
struct Transform {
    origin: [f64; 2],
    scale: f64,
    /// Cosine and sine of the rotation angle, which is clockwise on the page.
    turn: [f64; 2],
    /// `true` if the item's second coordinate points up.
    up: bool,
}

impl Transform {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let y = if self.up { -y } else { y };
        let [cos, sin] = self.turn;
        [
            self.origin[0] + self.scale * (cos * x - sin * y),
            self.origin[1] + self.scale * (sin * x + cos * y),
        ]
    }

    fn runs(&self, runs: &Runs) -> Runs {
        let finite = |run: &Vec<[f64; 2]>| -> Vec<[f64; 2]> {
            let points = run.iter().filter(|p| p.iter().all(|v| v.is_finite()));
            points.map(|point| self.at(*point)).collect()
        };
        runs.iter().map(finite).filter(|run| !run.is_empty()).collect()
    }
}

struct Walk<'d, 'p> {
    painter: &'p mut dyn Painter,
    bodies: HashMap<&'d str, &'d Body>,
    styles: HashMap<(Tag, &'d str), Style>,
}

impl<'d> Walk<'d, '_> {
    fn style(&mut self, tag: Tag, class: &'d str, scale: f64) -> Style {
        let known = self.styles.entry((tag, class)).or_insert_with(|| Style::of(tag, class));
        let mut style = known.clone();
        style.stroke_width *= scale;
        style.font_size *= scale;
        style.dash.iter_mut().for_each(|length| *length *= scale);
        style
    }

    fn items(&mut self, items: &'d [Item], transform: &Transform) {
        for item in items {
            self.item(item, transform);
        }
    }

    fn item(&mut self, item: &'d Item, transform: &Transform) {
        match item {
            Item::Line { class, from, to } => {
                let style = self.style(Tag::Shape, class, transform.scale);
                self.painter.lines(&transform.runs(&vec![vec![*from, *to]]), false, &style);
            }
            Item::Rect { class, lower: [x, y], size: [w, h] } => {
                let corners = vec![[*x, *y], [x + w, *y], [x + w, y + h], [*x, y + h]];
                let style = self.style(Tag::Shape, class, transform.scale);
                self.painter.lines(&transform.runs(&vec![corners]), true, &style);
            }
            Item::Circle { class, center, radius } => {
                let style = self.style(Tag::Shape, class, transform.scale);
                self.painter.circle(transform.at(*center), radius * transform.scale, &style);
            }
            Item::Path { class, dash, runs, closed } => {
                let mut style = self.style(Tag::Shape, class, transform.scale);
                if !dash.is_empty() {
                    style.dash = dashes(dash).iter().map(|v| v * transform.scale).collect();
                }
                self.painter.lines(&transform.runs(runs), *closed, &style);
            }
            Item::Outline { class, pen, runs, closed } => {
                let mut style = self.style(Tag::Shape, class, transform.scale);
                style.stroke_width = pen * transform.scale;
                self.painter.lines(&transform.runs(runs), *closed, &style);
            }
            Item::Text { class, at, anchor, degrees, text } => {
                self.word(class, transform.at(*at), *anchor, *degrees, text, transform.scale);
            }
            Item::Clip { lower, size, items, .. } => {
                self.painter.clip(transform.at(*lower), size.map(|side| side * transform.scale));
                self.items(items, transform);
                self.painter.unclip();
            }
            Item::Nested { at, scale, drawing } => {
                let scale = transform.scale * scale;
                let inner = Transform { origin: transform.at(*at), scale, ..*transform };
                let size = [drawing.width, drawing.height].map(|side| side * scale);
                self.painter.clip(inner.origin, size);
                self.items(&drawing.items, &inner);
                self.painter.unclip();
            }
            Item::Defined(bodies) => {
                self.bodies.extend(bodies.iter().map(|body| (body.id.as_str(), body)));
            }
            Item::Scene { scale, origin, bodies } => {
                let world = Transform {
                    origin: transform.at(*origin),
                    scale: transform.scale * scale,
                    ..*transform
                };
                for placed in bodies {
                    self.placed(placed, &world);
                }
            }
        }
    }

    fn placed(&mut self, placed: &Placed, world: &Transform) {
        let Some(body) = self.bodies.get(placed.id.as_str()).copied() else { return };
        let [x, z, angle] = placed.pose;
        let (sin, cos) = angle.sin_cos();
        let origin = Transform { up: true, ..*world }.at([x, z]);
        // A counterclockwise rotation with z up is a negative clockwise rotation on the page.
        self.items(&body.items, &Transform { origin, turn: [cos, -sin], up: true, ..*world });
    }

    fn word(
        &mut self,
        class: &'d str,
        at: [f64; 2],
        anchor: Anchor,
        degrees: f64,
        text: &str,
        scale: f64,
    ) {
        let style = self.style(Tag::Text, class, scale);
        let Some(ink) = style.fill else { return };
        let width = Font::of(style.strong).width(text, style.font_size);
        let back = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5 * width,
            Anchor::End => width,
        };
        let (sin, cos) = degrees.to_radians().sin_cos();
        self.painter.word(&Word {
            text,
            at: [at[0] - back * cos, at[1] - back * sin],
            degrees,
            size: style.font_size,
            strong: style.strong,
            ink,
        });
    }
}
