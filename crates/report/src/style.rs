//! Appearance of drawings: the palette and the style sheet, shared by all output formats of a
//! figure.

use std::sync::LazyLock;

use simplecss::{AttributeOperator, Element, PseudoClass, StyleSheet};

/// Colors by name: first the color on white (and on paper), then the color on a dark page.
///
/// `s0` to `s5` are the colors of series: those of Okabe and Ito, with the text color in place of
/// black.
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

/// Dash patterns of the series, with the same indices as their colors.
pub(crate) const DASHES: [&str; 6] = ["", "8 4", "2 3", "9 3 2 3", "14 5", "5 3"];

/// The style sheet of figures inside a page.
pub(crate) const STYLE: &str = include_str!("../assets/figure.css");

/// Additional style rules for printed documents.
const PAPER: &str = include_str!("../assets/paper.css");

/// Returns the style of a standalone figure: the style sheet with the colors for white paper.
pub(crate) fn standalone_style() -> String {
    on_white(STYLE)
}

fn on_white(style: &str) -> String {
    let mut style = style.to_owned();
    for (name, light, _) in PALETTE {
        style = style.replace(&format!("var(--{name})"), light);
    }
    style
}

/// The parsed style sheet, for formats that are not rendered by a browser.
static SHEET: LazyLock<StyleSheet<'static>> = LazyLock::new(|| {
    static TEXT: LazyLock<String> = LazyLock::new(|| on_white(&[STYLE, PAPER].concat()));
    StyleSheet::parse(&TEXT)
});

/// A color with its opacity (0 to 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ink {
    pub(crate) rgb: [u8; 3],
    pub(crate) opacity: f64,
}

/// Style of a shape or of text. Lengths are in px.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Style {
    pub(crate) fill: Option<Ink>,
    pub(crate) stroke: Option<Ink>,
    pub(crate) stroke_width: f64,
    pub(crate) dash: Vec<f64>,
    pub(crate) round: bool,
    pub(crate) font_size: f64,
    pub(crate) strong: bool,
}

/// Element types that style rules distinguish.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Tag {
    Shape,
    Text,
}

impl Style {
    /// Computes the style of an element with these classes; if no rule matches, the defaults of SVG
    /// apply.
    pub(crate) fn of(tag: Tag, classes: &str) -> Self {
        let mut style = Self {
            fill: Some(Ink { rgb: [0; 3], opacity: 1.0 }),
            stroke: None,
            stroke_width: 1.0,
            dash: Vec::new(),
            round: false,
            font_size: 16.0,
            strong: false,
        };
        let (mut whole, mut fill) = (1.0, 1.0);
        let node = Node { tag: Some(tag), classes };
        // Rules are in the order in which they override each other.
        for rule in SHEET.rules.iter().filter(|rule| rule.selector.matches(&node)) {
            for declaration in &rule.declarations {
                let value = declaration.value;
                match declaration.name {
                    "fill" => style.fill = ink(value),
                    "stroke" => style.stroke = ink(value),
                    "opacity" => whole = length(value),
                    "fill-opacity" => fill = length(value),
                    "stroke-width" => style.stroke_width = length(value),
                    "stroke-dasharray" => style.dash = dashes(value),
                    "stroke-linejoin" => style.round = value == "round",
                    "stroke-linecap" => style.round &= value == "round",
                    "font-size" => style.font_size = length(value),
                    "font-weight" => style.strong = length(value) >= 600.0,
                    // Font families, line caps and digit styles are fixed in these formats.
                    _ => {}
                }
            }
        }
        for (ink, opacity) in [(&mut style.fill, whole * fill), (&mut style.stroke, whole)] {
            if let Some(ink) = ink {
                ink.opacity = opacity;
            }
        }
        style
    }
}

/// Parses the lengths of dashes and gaps.
pub(crate) fn dashes(value: &str) -> Vec<f64> {
    value.split_whitespace().map(length).collect()
}

/// Parses a plain number or a length in px; an invalid value gives zero.
fn length(value: &str) -> f64 {
    value.trim_end_matches("px").parse().unwrap_or(0.0)
}

fn ink(value: &str) -> Option<Ink> {
    let digits = value.strip_prefix('#')?;
    let part = |at: usize| u8::from_str_radix(digits.get(at..at + 2)?, 16).ok();
    Some(Ink { rgb: [part(0)?, part(2)?, part(4)?], opacity: 1.0 })
}

/// An element for selector matching; its parent is the drawing, which has the class `bs`.
struct Node<'a> {
    /// Element type; `None` for the drawing itself.
    tag: Option<Tag>,
    classes: &'a str,
}

impl Element for Node<'_> {
    fn parent_element(&self) -> Option<Self> {
        self.tag.map(|_| Node { tag: None, classes: "bs" })
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        None
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.tag == Some(Tag::Text) && name == "text"
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator<'_>) -> bool {
        name == "class" && operator.matches(self.classes)
    }

    fn pseudo_class_matches(&self, _: PseudoClass<'_>) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sheet_is_read_as_a_browser_reads_it() {
        let line = Style::of(Tag::Shape, "series s1");
        assert_eq!(line.stroke, Some(Ink { rgb: [0xd5, 0x5e, 0x00], opacity: 1.0 }));
        assert_eq!((line.fill, line.stroke_width, line.round), (None, 1.6, true));
        let muted = Style::of(Tag::Shape, "series muted");
        assert_eq!(muted.stroke.unwrap().opacity, 0.6);
        let area = Style::of(Tag::Shape, "area s0");
        assert_eq!(area.fill, Some(Ink { rgb: [0x00, 0x72, 0xb2], opacity: 0.16 }));
        let note = Style::of(Tag::Text, "note");
        assert_eq!((note.font_size, note.fill.unwrap().rgb), (11.0, [0x59, 0x62, 0x6d]));
        let name = Style::of(Tag::Text, "label strong");
        assert_eq!((name.font_size, name.strong), (12.0, true));
        assert_eq!(Style::of(Tag::Shape, "mark").dash, [3.0, 3.0]);
        assert_eq!(Style::of(Tag::Shape, "bs-body bs-open").fill, None);
    }
}
