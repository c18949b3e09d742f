//! A drawing: lines, shapes and text with named styles, independent of the output format.

/// A drawing of a known size; y grows downward (px).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drawing {
    pub(crate) width: f64,
    pub(crate) height: f64,
    /// Text alternative for screen readers.
    pub(crate) title: String,
    pub(crate) items: Vec<Item>,
}

/// Separate polylines.
pub(crate) type Runs = Vec<Vec<[f64; 2]>>;

/// One item of a drawing. The field `class` holds one or more class names of the style sheet.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Item {
    Line {
        class: &'static str,
        from: [f64; 2],
        to: [f64; 2],
    },
    Rect {
        class: &'static str,
        lower: [f64; 2],
        size: [f64; 2],
    },
    Circle {
        class: String,
        center: [f64; 2],
        radius: f64,
    },
    /// Polylines (px); `dash` takes precedence over the dash pattern of the style.
    Path {
        class: String,
        dash: &'static str,
        runs: Runs,
        closed: bool,
    },
    /// Polylines in the coordinates of the body (m); the pen width is in meters, too.
    Outline {
        class: String,
        pen: f64,
        runs: Runs,
        closed: bool,
    },
    Text {
        class: &'static str,
        at: [f64; 2],
        anchor: Anchor,
        /// Clockwise rotation about `at`.
        degrees: f64,
        text: String,
    },
    /// Items clipped to a rectangle; `id` is unique within a page.
    Clip {
        id: String,
        lower: [f64; 2],
        size: [f64; 2],
        items: Vec<Self>,
    },
    /// Another drawing with its upper left corner at `at`, scaled by `scale`.
    Nested {
        at: [f64; 2],
        scale: f64,
        drawing: Drawing,
    },
    /// Definitions of bodies (m), for use by [`Item::Scene`].
    Defined(Vec<Body>),
    /// Bodies at their positions in a world with z up, with the `scale` (px/m) and the position
    /// (px) of the origin.
    Scene {
        scale: f64,
        origin: [f64; 2],
        bodies: Vec<Placed>,
    },
}

/// A body that is defined once and drawn many times; `id` is unique within a page.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Body {
    pub(crate) id: String,
    pub(crate) items: Vec<Item>,
}

/// A body at a pose: x and z (m), and the counterclockwise angle (rad). `id` is the name under which
/// [`Item::Defined`] defines the body.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Placed {
    pub(crate) id: String,
    pub(crate) class: &'static str,
    pub(crate) pose: [f64; 3],
}

/// Horizontal alignment of text: which point of the text (start, middle or end) lies at the given position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Drawing {
    pub(crate) fn new(width: f64, height: f64, title: &str) -> Self {
        Self { width, height, title: title.to_owned(), items: Vec::new() }
    }

    pub(crate) fn push(&mut self, item: Item) {
        self.items.push(item);
    }

    pub(crate) fn line(&mut self, class: &'static str, from: [f64; 2], to: [f64; 2]) {
        self.push(Item::Line { class, from, to });
    }

    pub(crate) fn rect(&mut self, class: &'static str, lower: [f64; 2], size: [f64; 2]) {
        self.push(Item::Rect { class, lower, size: size.map(|side| side.max(0.0)) });
    }

    pub(crate) fn path(&mut self, class: &str, dash: &'static str, runs: Runs, closed: bool) {
        self.push(Item::Path { class: class.to_owned(), dash, runs, closed });
    }

    pub(crate) fn text(&mut self, class: &'static str, at: [f64; 2], anchor: Anchor, text: &str) {
        self.turned_text(class, at, anchor, 0.0, text);
    }

    pub(crate) fn turned_text(
        &mut self,
        class: &'static str,
        at: [f64; 2],
        anchor: Anchor,
        degrees: f64,
        text: &str,
    ) {
        if !text.is_empty() {
            self.push(Item::Text { class, at, anchor, degrees, text: text.to_owned() });
        }
    }

    /// Places another drawing inside this drawing without scaling it.
    pub(crate) fn nest(&mut self, at: [f64; 2], drawing: Self) {
        self.push(Item::Nested { at, scale: 1.0, drawing });
    }
}

/// The available width; font sizes do not depend on the width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Room {
    /// A page on a computer screen or on paper.
    Page,
    /// A page on a phone.
    Phone,
}

impl Room {
    /// Returns the length for this width: `page` on a page, and `phone` on a phone.
    pub(crate) fn of(self, page: f64, phone: f64) -> f64 {
        match self {
            Self::Page => page,
            Self::Phone => phone,
        }
    }
}

/// Estimates the width (px) of a line of text of font size `size` (px); the estimate is usually
/// slightly too large.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    0.56 * size * text.chars().count() as f64
}

/// Breaks text of font size `size` (px) into lines that, if possible, are no wider than `width` (px). A line may break
/// after a space or after `.`, `-`, `_` or `/`.
pub(crate) fn broken(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for piece in text.split_inclusive([' ', '.', '-', '_', '/']) {
        let line = lines.last_mut().expect("a line");
        if !line.is_empty() && text_width(&format!("{line}{}", piece.trim_end()), size) > width {
            lines.push(piece.to_owned());
        } else {
            line.push_str(piece);
        }
    }
    lines.iter().map(|line| line.trim_end().to_owned()).collect()
}
