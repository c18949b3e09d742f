//! A diagram: a scene at one instant with labels and arrows.

use std::{fmt::Write as _, sync::Arc};

use crate::{
    Point, Scene, csv_field,
    drawing::{Anchor, Drawing, Item, Room},
    number,
    strip::{View, define_bodies, picture},
};

/// A scene at one instant with labels and arrows.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The instant (s); the nearest frame is shown.
    pub time: f64,
    /// Labels and their positions (m).
    pub labels: Vec<(Point, String)>,
    /// Arrows, drawn over the bodies.
    pub arrows: Vec<Arrow>,
}

/// An arrow from one point of the scene to another.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow {
    /// Tail (m).
    pub from: Point,
    /// Head (m).
    pub to: Point,
    /// Meaning of the arrow; written to the CSV of the figure.
    pub meaning: String,
}

/// Maximum width and height (px).
const MOST: [f64; 2] = [620.0, 520.0];
/// Width (px) on a phone.
const PHONE: f64 = 358.0;
/// Length and half width of an arrow's head (px).
const HEAD: [f64; 2] = [8.0, 3.6];

impl Diagram {
    pub(crate) fn draw(&self, id: &str, title: &str, room: Room) -> Drawing {
        let frame = self.scene.frames.nearest(self.time);
        let shown: Vec<usize> = frame.into_iter().collect();
        let view = View::of(&self.scene, &shown, [room.of(MOST[0], PHONE), MOST[1]], false);
        let mut drawing = Drawing::new(view.width, view.height, title);
        drawing.push(define_bodies(&self.scene, id, &view, &shown));
        drawing.nest([0.0, 0.0], picture(&self.scene, id, frame, &view));
        for arrow in &self.arrows {
            draw_arrow(&mut drawing, view.on_page(arrow.from), view.on_page(arrow.to));
        }
        for (place, label) in &self.labels {
            let [x, y] = view.on_page(*place);
            drawing.text("label strong halo", [x, y + 4.0], Anchor::Middle, label);
        }
        drawing
    }

    pub(crate) fn to_csv(&self) -> String {
        let mut out = String::from("from x (m),from z (m),to x (m),to z (m),meaning\n");
        for arrow in &self.arrows {
            let [a, b, c, d] =
                [arrow.from[0], arrow.from[1], arrow.to[0], arrow.to[1]].map(number::csv_number);
            // Writing to a String cannot fail.
            let _ = writeln!(out, "{a},{b},{c},{d},{}", csv_field(&arrow.meaning));
        }
        out
    }
}

fn draw_arrow(drawing: &mut Drawing, from: [f64; 2], to: [f64; 2]) {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    if !(length.is_finite() && length > 0.0) {
        return;
    }
    let [ux, uy] = along.map(|v| v / length);
    let neck = [to[0] - HEAD[0] * ux, to[1] - HEAD[0] * uy];
    let side = |sign: f64| [neck[0] - sign * HEAD[1] * uy, neck[1] + sign * HEAD[1] * ux];
    drawing.push(Item::Circle { class: "arrow tail".into(), center: from, radius: 2.2 });
    drawing.line("arrow", from, neck);
    drawing.path("arrow head", "", vec![vec![side(1.0), to, side(-1.0)]], true);
}
