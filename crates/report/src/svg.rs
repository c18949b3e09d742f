//! Drawings as SVG, inside a page or standalone.

use std::fmt::{Arguments, Write as _};

use crate::{
    drawing::{Anchor, Body, Drawing, Item, Placed, Runs},
    escape,
    style::standalone_style,
};

impl Drawing {
    /// Returns the drawing as an `svg` element for a page that contains the style sheet.
    pub(crate) fn inline(&self) -> String {
        let [w, h] = [self.width, self.height].map(coordinate);
        format!(
            r#"<svg class="bs" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w} {h}" width="{w}" height="{h}" role="img" aria-label="{}">{}</svg>"#,
            escape::html(&self.title),
            markup(&self.items)
        )
    }

    /// Returns the drawing as a standalone SVG file, with its own style sheet and a white background.
    pub(crate) fn standalone(&self) -> String {
        let [w, h] = [self.width, self.height].map(coordinate);
        format!(
            concat!(
                r#"<svg class="bs" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w} {h}" width="{w}" height="{h}" role="img">"#,
                "<title>{title}</title><style>{style}</style>",
                r##"<rect width="{w}" height="{h}" fill="#ffffff"/>{body}</svg>"##,
                "\n"
            ),
            w = w,
            h = h,
            title = escape::html(&self.title),
            style = escape::html(&standalone_style()),
            body = markup(&self.items)
        )
    }
}

fn markup(items: &[Item]) -> String {
    let mut writer = Writer(String::new());
    for item in items {
        writer.item(item);
    }
    writer.0
}

struct Writer(String);

impl Writer {
    fn put(&mut self, markup: Arguments<'_>) {
        // Writing to a String cannot fail, here and below.
        let _ = self.0.write_fmt(markup);
    }

    fn item(&mut self, item: &Item) {
        match item {
            Item::Line { class, from, to } => {
                let [x1, y1, x2, y2] = [from[0], from[1], to[0], to[1]].map(coordinate);
                self.put(format_args!(
                    r#"<line class="{class}" x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}"/>"#
                ));
            }
            Item::Rect { class, lower, size } => self.rect(class, *lower, *size),
            Item::Circle { class, center, radius } => {
                let [x, y, r] = [center[0], center[1], *radius].map(coordinate);
                self.put(format_args!(r#"<circle class="{class}" cx="{x}" cy="{y}" r="{r}"/>"#));
            }
            Item::Path { class, dash, runs, closed } => self.path(class, dash, runs, *closed),
            Item::Outline { class, pen, runs, closed } => self.outline(class, *pen, runs, *closed),
            Item::Text { class, at, anchor, degrees, text } => {
                self.text(class, *at, *anchor, *degrees, text);
            }
            Item::Clip { id, lower, size, items } => {
                self.put(format_args!(r#"<defs><clipPath id="{id}">"#));
                self.rect("", *lower, *size);
                self.put(format_args!(r#"</clipPath></defs><g clip-path="url(#{id})">"#));
                for item in items {
                    self.item(item);
                }
                self.put(format_args!("</g>"));
            }
            Item::Nested { at, scale, drawing } => self.nested(*at, *scale, drawing),
            Item::Defined(bodies) => self.defined(bodies),
            Item::Scene { scale, origin, bodies } => self.scene(*scale, *origin, bodies),
        }
    }

    fn rect(&mut self, class: &str, lower: [f64; 2], size: [f64; 2]) {
        let [x, y] = lower.map(coordinate);
        let [w, h] = size.map(coordinate);
        self.put(format_args!(
            r#"<rect class="{class}" x="{x}" y="{y}" width="{w}" height="{h}"/>"#
        ));
    }

    fn path(&mut self, class: &str, dash: &str, runs: &Runs, closed: bool) {
        let data = path_data(runs, closed);
        if data.is_empty() {
            return;
        }
        let dash =
            if dash.is_empty() { String::new() } else { format!(r#" stroke-dasharray="{dash}""#) };
        self.put(format_args!(r#"<path class="{class}"{dash} d="{data}"/>"#));
    }

    fn outline(&mut self, class: &str, pen: f64, runs: &Runs, closed: bool) {
        let mut data = String::new();
        for run in runs {
            let points = run.iter().filter(|p| p.iter().all(|v| v.is_finite()));
            for (at, [x, z]) in points.enumerate() {
                let letter = if at == 0 { "M" } else { "L" };
                let _ = write!(data, "{letter}{x:.4} {z:.4}");
            }
            if closed && data.ends_with(|c: char| c.is_ascii_digit()) {
                data.push('z');
            }
        }
        if !data.is_empty() {
            self.put(format_args!(r#"<path class="{class}" stroke-width="{pen:.5}" d="{data}"/>"#));
        }
    }

    fn text(&mut self, class: &str, at: [f64; 2], anchor: Anchor, degrees: f64, text: &str) {
        let [x, y] = at.map(coordinate);
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let turn = if degrees == 0.0 {
            String::new()
        } else {
            format!(r#" transform="rotate({degrees} {x} {y})""#)
        };
        let text = escape::html(text);
        self.put(format_args!(
            r#"<text class="{class}" x="{x}" y="{y}" text-anchor="{anchor}"{turn}>{text}</text>"#
        ));
    }

    fn nested(&mut self, at: [f64; 2], scale: f64, drawing: &Drawing) {
        let [x, y] = at.map(coordinate);
        let [w, h] = [drawing.width, drawing.height].map(coordinate);
        let [wide, high] = [drawing.width * scale, drawing.height * scale].map(coordinate);
        self.put(format_args!(
            r#"<svg x="{x}" y="{y}" width="{wide}" height="{high}" viewBox="0 0 {w} {h}">"#
        ));
        for item in &drawing.items {
            self.item(item);
        }
        self.put(format_args!("</svg>"));
    }

    fn defined(&mut self, bodies: &[Body]) {
        self.put(format_args!("<defs>"));
        for body in bodies {
            self.put(format_args!(r#"<g id="{}">"#, body.id));
            for item in &body.items {
                self.item(item);
            }
            self.put(format_args!("</g>"));
        }
        self.put(format_args!("</defs>"));
    }

    fn scene(&mut self, scale: f64, origin: [f64; 2], bodies: &[Placed]) {
        let [left, foot] = origin.map(coordinate);
        self.put(format_args!(
            r#"<g transform="matrix({scale:.6} 0 0 {:.6} {left} {foot})">"#,
            -scale
        ));
        for Placed { id, class, pose: [x, z, angle] } in bodies {
            let degrees = angle.to_degrees();
            self.put(format_args!(
                r##"<use class="{class}" href="#{id}" transform="translate({x:.4} {z:.4}) rotate({degrees:.3})"/>"##
            ));
        }
        self.put(format_args!("</g>"));
    }
}

/// Formats a coordinate to a hundredth of a pixel without trailing zeros; a value that is not
/// finite becomes zero.
fn coordinate(value: f64) -> String {
    if !value.is_finite() {
        return "0".into();
    }
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// Returns path data for polylines, each as an absolute starting point followed by relative steps,
/// which are rounded to 0.05 px.
///
/// Each step starts from the rounded end of the previous step, so rounding errors do not add up.
fn path_data(runs: &[Vec<[f64; 2]>], closed: bool) -> String {
    let mut out = String::new();
    for run in runs {
        let mut points = run.iter().filter(|p| p.iter().all(|v| v.is_finite()));
        let Some(start) = points.next() else { continue };
        let mut pen = start.map(snap);
        let _ = write!(out, "M{} {}", coordinate(pen[0]), coordinate(pen[1]));
        let mut drawn = false;
        for point in points {
            let next = point.map(snap);
            out.push_str(if drawn { " " } else { "l" });
            let step = [next[0] - pen[0], next[1] - pen[1]].map(coordinate);
            out.push_str(&step[0]);
            if !step[1].starts_with('-') {
                out.push(' ');
            }
            out.push_str(&step[1]);
            pen = next;
            drawn = true;
        }
        if closed {
            out.push('z');
        } else if !drawn {
            // A single point becomes a segment of zero length, which round caps turn into a dot.
            out.push_str("h0");
        }
    }
    out
}

fn snap(value: f64) -> f64 {
    (value * 20.0).round() / 20.0
}
