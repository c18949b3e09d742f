//! A strip: the scene at chosen instants side by side, all in one window and to one scale.

use std::{fmt::Write as _, sync::Arc};

use crate::{
    Polyline, Role, Scene, escape, number,
    scene::{Extent, window},
    svg::{Anchor, Svg, coordinate, text_width},
};

/// A scene at chosen instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// What moves.
    pub scene: Arc<Scene>,
    /// The instants, in reading order. Each shows the frame nearest to its time.
    pub panels: Vec<Panel>,
}

/// One picture of a strip.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Time asked for (s); the caption states the time of the frame shown.
    pub time: f64,
    /// A few words; may be empty.
    pub note: String,
}

const PANEL_WIDTH: f64 = 220.0;
const CAPTION: f64 = 38.0;

impl Strip {
    /// A strip of `count` panels that tell the run: the first and the last frame, the events
    /// that matter most (falls before losses of seat before others, earlier before later), and
    /// even steps in time where events are too few.
    pub fn of_run(scene: Arc<Scene>, count: usize) -> Self {
        use crate::EventKind::{Fall, LossOfSeat, Note, Slip, Uplift};
        let times = &scene.frames.times[..scene.frames.len()];
        let (Some(&first), Some(&last)) = (times.first(), times.last()) else {
            return Self { scene, panels: Vec::new() };
        };
        let span = last - first;
        let mut panels = vec![Panel { time: first, note: "start".into() }];
        if count > 1 && span > 0.0 {
            panels.push(Panel { time: last, note: "end".into() });
        }
        let far = |panels: &[Panel], time: f64, least: f64| {
            panels.iter().all(|p| (p.time - time).abs() >= least)
        };
        for kinds in [&[Fall][..], &[LossOfSeat], &[Uplift, Slip, Note]] {
            for event in scene.events.iter().filter(|e| kinds.contains(&e.kind)) {
                let inside = event.time > first && event.time < last;
                if panels.len() < count && inside && far(&panels, event.time, 0.03 * span) {
                    let who = event.body.map(|b| format!("{}: ", scene.name(b)));
                    let note = format!("{}{}", who.unwrap_or_default(), event.kind.word());
                    panels.push(Panel { time: event.time, note });
                }
            }
        }
        let mut parts = count;
        while panels.len() < count && span > 0.0 && parts > 1 {
            for k in 1..parts {
                let time = first + span * k as f64 / parts as f64;
                if panels.len() < count && far(&panels, time, 0.5 * span / count as f64) {
                    panels.push(Panel { time, note: String::new() });
                }
            }
            parts -= 1;
        }
        panels.sort_by(|a, b| a.time.total_cmp(&b.time));
        Self { scene, panels }
    }

    /// Panels as drawings of equal size. Bodies are defined in the first one that is drawn, under
    /// names that start with `id`, and used by all.
    pub(crate) fn drawings(&self, id: &str) -> Vec<Svg> {
        let frames: Vec<Option<usize>> =
            self.panels.iter().map(|p| self.scene.frames.nearest(p.time)).collect();
        let shown: Vec<usize> = frames.iter().copied().flatten().collect();
        let extent = window(&self.scene, &shown);
        let scale = PANEL_WIDTH / extent.width().max(extent.height() * 0.75).max(1e-6);
        let height = (extent.height() * scale).max(60.0);
        self.panels
            .iter()
            .zip(frames)
            .enumerate()
            .map(|(at, (panel, frame))| {
                let time = frame.and_then(|f| self.scene.frames.times.get(f)).copied();
                let heading = format!("t = {} s", number::fixed(time.unwrap_or(f64::NAN), 2));
                let title = format!("{heading}. {}", panel.note);
                let mut svg = Svg::new(PANEL_WIDTH, height + CAPTION, title.trim_end());
                if at == 0 {
                    self.define_bodies(&mut svg, id, scale);
                }
                let mut picture = Svg::new(PANEL_WIDTH, height, "");
                picture.rect("frame", [0.5, 0.5], [PANEL_WIDTH - 1.0, height - 1.0]);
                if let Some(frame) = frame {
                    self.place_bodies(&mut picture, id, frame, &extent, scale);
                }
                svg.nest([0.0, 0.0], &picture);
                svg.text("label strong", [1.0, height + 16.0], Anchor::Start, &heading);
                svg.text("note", [1.0, height + 31.0], Anchor::Start, &fit(&panel.note));
                svg
            })
            .collect()
    }

    fn define_bodies(&self, svg: &mut Svg, id: &str, scale: f64) {
        svg.raw("<defs>");
        for (at, body) in self.scene.bodies.iter().enumerate() {
            svg.raw(&format!(r#"<g id="{id}-b{at}">"#));
            for line in &body.outlines {
                let open = if line.closed { "" } else { " open" };
                shape(svg, &format!("body {}{open}", body.role.class()), line, 1.1 / scale);
            }
            for (place, line) in body.marks.iter().enumerate() {
                let wide = if place == 0 { 2.4 } else { 0.7 };
                shape(svg, "body open", line, wide / scale);
            }
            svg.raw("</g>");
        }
        svg.raw("</defs>");
    }

    fn place_bodies(&self, svg: &mut Svg, id: &str, frame: usize, extent: &Extent, scale: f64) {
        let height = svg.height;
        // Centered across when the window is narrower than the panel.
        let x0 = 0.5 * (PANEL_WIDTH - extent.width() * scale) - extent.lower[0] * scale;
        let z0 = height + extent.lower[1] * scale;
        let [x0, z0] = [x0, z0].map(coordinate);
        svg.raw(&format!(r#"<g transform="matrix({scale:.6} 0 0 {:.6} {x0} {z0})">"#, -scale));
        for (at, body) in self.scene.bodies.iter().enumerate() {
            let Some([x, z, angle]) = self.scene.frames.pose(frame, at) else { continue };
            let degrees = angle.to_degrees();
            let class = if body.role == Role::Ground { "ground" } else { "moving" };
            svg.raw(&format!(
                r##"<use class="{class}" href="#{id}-b{at}" transform="translate({x:.4} {z:.4}) rotate({degrees:.3})"/>"##
            ));
        }
        svg.raw("</g>");
    }

    pub(crate) fn draw(&self, id: &str, title: &str) -> Svg {
        let drawings = self.drawings(id);
        let per_row = drawings.len().clamp(1, 3);
        let height = drawings.first().map_or(0.0, |d| d.height);
        let rows = drawings.len().div_ceil(per_row);
        let gap = 12.0;
        let mut svg = Svg::new(
            per_row as f64 * (PANEL_WIDTH + gap) + gap,
            (rows as f64 * (height + gap) + gap).max(40.0),
            title,
        );
        for (at, drawing) in drawings.iter().enumerate() {
            let (row, column) = (at / per_row, at % per_row);
            let corner =
                [gap + column as f64 * (PANEL_WIDTH + gap), gap + row as f64 * (height + gap)];
            svg.nest(corner, drawing);
        }
        svg
    }

    pub(crate) fn to_csv(&self) -> String {
        let mut out = String::from("time (s),body,x (m),z (m),angle (rad)\n");
        for panel in &self.panels {
            let Some(frame) = self.scene.frames.nearest(panel.time) else { continue };
            for (at, body) in self.scene.bodies.iter().enumerate() {
                let Some(pose) = self.scene.frames.pose(frame, at) else { continue };
                let time = self.scene.frames.times.get(frame).copied().unwrap_or(f64::NAN);
                let name = escape::csv(&body.name);
                let [x, z, angle] = pose.map(number::csv_number);
                // Writing to a String cannot fail.
                let _ = writeln!(out, "{},{name},{x},{z},{angle}", number::csv_number(time));
            }
        }
        out
    }
}

fn shape(svg: &mut Svg, class: &str, line: &Polyline, width: f64) {
    let mut data = String::new();
    for (at, [x, z]) in line.points.iter().enumerate() {
        if x.is_finite() && z.is_finite() {
            let letter = if at == 0 { "M" } else { "L" };
            let _ = write!(data, "{letter}{x:.4} {z:.4}");
        }
    }
    if data.starts_with('M') {
        let end = if line.closed { "z" } else { "" };
        svg.raw(&format!(r#"<path class="{class}" stroke-width="{width:.5}" d="{data}{end}"/>"#));
    }
}

/// A note that fits under its panel.
fn fit(note: &str) -> String {
    if text_width(note, 11.0) <= PANEL_WIDTH {
        return note.into();
    }
    let kept: String = note.chars().take(33).collect();
    format!("{}…", kept.trim_end())
}
