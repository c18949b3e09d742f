//! A small SVG writer and the palette that figures and page share.

use std::fmt::{Arguments, Write as _};

use crate::escape;

/// Colors by name: on white (and paper), and on the dark page.
///
/// `s0` to `s5` are the series: the Okabe–Ito set, with the text color in place of its black.
pub(crate) const PALETTE: &[(&str, &str, &str)] = &[
    ("paper", "#ffffff", "#14171b"),
    ("panel", "#f6f7f8", "#1b1f24"),
    ("ink", "#1b1f24", "#e8eaed"),
    ("soft", "#59626d", "#a3acb7"),
    ("rule", "#d9dde2", "#343b44"),
    ("grid", "#e6e9ed", "#272d34"),
    ("accent", "#7a1f3d", "#e58aa6"),
    ("s0", "#0072b2", "#56b4e9"),
    ("s1", "#d55e00", "#e8792b"),
    ("s2", "#009e73", "#1fbf92"),
    ("s3", "#b8578f", "#d98fb8"),
    ("s4", "#1b1f24", "#e8eaed"),
    ("s5", "#b07a00", "#e69f00"),
    ("band", "#e9ecf0", "#2a3038"),
    ("ground", "#c9ced4", "#3a424c"),
    ("barrel", "#dcb67f", "#9a7340"),
    ("rack", "#7f8b98", "#8794a3"),
    ("block", "#b9c4cf", "#56626f"),
    ("device", "#8fc7b5", "#2f7f6a"),
    ("line", "#3b3023", "#f0e6d8"),
    ("good", "#00785a", "#3fcf9f"),
    ("bad", "#b84a00", "#f08a4b"),
];

/// Dash patterns of the series, by the same index as their colors.
pub(crate) const DASHES: [&str; 6] = ["", "8 4", "2 3", "9 3 2 3", "14 5", "5 3"];

const STYLE: &str = include_str!("../assets/figure.css");

/// The style of a standalone figure: the page's rules with the colors of white paper.
pub(crate) fn standalone_style() -> String {
    let mut style = STYLE.to_owned();
    for (name, light, _) in PALETTE {
        style = style.replace(&format!("var(--{name})"), light);
    }
    style
}

/// The rules that figures inside a page share.
pub(crate) fn page_style() -> &'static str {
    STYLE
}

/// A drawing of a known size; y grows downward (px).
#[derive(Clone, Debug)]
pub(crate) struct Svg {
    pub(crate) width: f64,
    pub(crate) height: f64,
    title: String,
    body: String,
}

#[derive(Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Svg {
    pub(crate) fn new(width: f64, height: f64, title: &str) -> Self {
        Self { width, height, title: escape::html(title), body: String::new() }
    }

    /// Appends markup that is known to be well formed.
    pub(crate) fn raw(&mut self, markup: &str) {
        self.body.push_str(markup);
    }

    fn put(&mut self, markup: Arguments<'_>) {
        // Writing to a String cannot fail, here and below.
        let _ = self.body.write_fmt(markup);
    }

    pub(crate) fn line(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        let [x1, y1, x2, y2] = [from[0], from[1], to[0], to[1]].map(coordinate);
        self.put(format_args!(
            r#"<line class="{class}" x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}"/>"#
        ));
    }

    pub(crate) fn rect(&mut self, class: &str, lower: [f64; 2], size: [f64; 2]) {
        let [x, y] = lower.map(coordinate);
        let [w, h] = size.map(|v| coordinate(v.max(0.0)));
        self.put(format_args!(
            r#"<rect class="{class}" x="{x}" y="{y}" width="{w}" height="{h}"/>"#
        ));
    }

    pub(crate) fn circle(&mut self, class: &str, center: [f64; 2], radius: f64) {
        let [x, y, r] = [center[0], center[1], radius].map(coordinate);
        self.put(format_args!(r#"<circle class="{class}" cx="{x}" cy="{y}" r="{r}"/>"#));
    }

    /// A path through runs of points; nothing when there is none.
    pub(crate) fn path(&mut self, class: &str, dash: &str, runs: &[Vec<[f64; 2]>], closed: bool) {
        let data = path_data(runs, closed);
        if data.is_empty() {
            return;
        }
        let dash =
            if dash.is_empty() { String::new() } else { format!(r#" stroke-dasharray="{dash}""#) };
        self.put(format_args!(r#"<path class="{class}"{dash} d="{data}"/>"#));
    }

    pub(crate) fn text(&mut self, class: &str, at: [f64; 2], anchor: Anchor, text: &str) {
        self.turned_text(class, at, anchor, 0.0, text);
    }

    pub(crate) fn turned_text(
        &mut self,
        class: &str,
        at: [f64; 2],
        anchor: Anchor,
        degrees: f64,
        text: &str,
    ) {
        if text.is_empty() {
            return;
        }
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

    /// Places another drawing inside this one.
    pub(crate) fn nest(&mut self, at: [f64; 2], inner: &Self) {
        let [x, y, w, h] = [at[0], at[1], inner.width, inner.height].map(coordinate);
        self.put(format_args!(
            r#"<svg x="{x}" y="{y}" width="{w}" height="{h}" viewBox="0 0 {w} {h}">{}</svg>"#,
            inner.body
        ));
    }

    /// For a page that carries the style.
    pub(crate) fn inline(&self) -> String {
        let [w, h] = [self.width, self.height].map(coordinate);
        format!(
            r#"<svg class="bs" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w} {h}" width="{w}" height="{h}" role="img" aria-label="{}">{}</svg>"#,
            self.title, self.body
        )
    }

    /// With its own style and a white ground.
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
            title = self.title,
            style = escape::html(&standalone_style()),
            body = self.body
        )
    }
}

/// Width of a line of text at `size` px, on the generous side.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    0.56 * size * text.chars().count() as f64
}

/// A coordinate to a hundredth of a pixel without trailing zeros; zero when not finite.
pub(crate) fn coordinate(value: f64) -> String {
    if !value.is_finite() {
        return "0".into();
    }
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// Path data through runs of points: absolute starts, then relative steps to 0.05 px.
///
/// Each step starts from the rounded end of the one before, so rounding never adds up.
pub(crate) fn path_data(runs: &[Vec<[f64; 2]>], closed: bool) -> String {
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
            // A lone point: a step of no length, which round caps turn into a dot.
            out.push_str("h0");
        }
    }
    out
}

fn snap(value: f64) -> f64 {
    (value * 20.0).round() / 20.0
}
