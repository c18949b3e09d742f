//! A strip: pictures of a scene at selected instants, with equal windows and scales.

use std::{fmt::Write as _, sync::Arc};

use crate::{
    Event, Language, Point, Polyline, Role, Scene, SceneBody, csv_field,
    drawing::{Anchor, Body, Drawing, Item, Placed, text_width},
    number,
    scene::{Extent, hatch, window},
};

/// A scene at selected instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The instants, in reading order; each panel shows the frame nearest to its time.
    pub panels: Vec<Panel>,
}

/// One picture of a strip.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Requested time (s); the caption states the time of the frame shown.
    pub time: f64,
    /// A short note; may be empty.
    pub note: String,
}

/// Maximum width and height (px) of a panel.
const PANEL: [f64; 2] = [165.0, 235.0];
/// Maximum width and height (px) of a single picture.
const STILL: [f64; 2] = [480.0, 380.0];
/// Width (px) of a row of panels.
const ROW: f64 = 760.0;
/// Gap (px) between panels.
const GAP: f64 = 12.0;
/// Space (px) below the lowest body for the hatch of the ground.
const FOOT: f64 = 13.0;
/// Space (px) below the hatch for the caption.
const CAPTION: f64 = 38.0;
/// Distance (px) between the hatch strokes of the ground.
const HATCH: f64 = 10.0;

/// Common window and scale of all pictures of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct View {
    extent: Extent,
    /// Scale (px/m).
    scale: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
    /// `true` if bodies are labeled.
    names: bool,
}

impl View {
    /// Chooses the window and the scale so that frames of a scene fit into the width and height
    /// `most` (px).
    pub(crate) fn of(scene: &Scene, shown: &[usize], most: [f64; 2], names: bool) -> Self {
        let extent = window(scene, shown);
        let (wide, high) = (extent.width().max(1e-6), extent.height().max(1e-6));
        let scale = (most[0] / wide).min(most[1] / high);
        let [width, height] = [(wide * scale).max(120.0), (high * scale + FOOT).max(50.0)];
        Self { extent, scale, width, height, names }
    }

    /// Returns the position (px) of the origin of the scene; a window narrower than the panel is
    /// centered.
    fn origin(&self) -> [f64; 2] {
        let (extent, scale) = (&self.extent, self.scale);
        [
            0.5 * (self.width - extent.width() * scale) - extent.lower[0] * scale,
            self.height - FOOT + extent.lower[1] * scale,
        ]
    }

    /// Converts a point of the scene (m) to the page (px).
    pub(crate) fn on_page(&self, [x, z]: Point) -> [f64; 2] {
        let [x0, z0] = self.origin();
        [x0 + x * self.scale, z0 - z * self.scale]
    }
}

impl Strip {
    /// Creates a strip of `count` panels that summarize the run.
    ///
    /// The panels are the first and the last frame and the most important events: falls are
    /// preferred to losses of seats, losses of seats to all other events, and earlier events to later
    /// events. If there are too few events, instants in the middle of the longest gaps are added.
    pub fn of_run(scene: Arc<Scene>, count: usize) -> Self {
        let own = Arc::clone(&scene);
        Self::of_views(scene, &[&own], count)
    }

    /// Creates a strip like [`Strip::of_run`], but chooses from the events of all `views` of the run.
    pub fn of_views(scene: Arc<Scene>, views: &[&Scene], count: usize) -> Self {
        use crate::EventKind::{Fall, LossOfSeat, Note, Slip, Uplift};
        let named = |view: &Scene| {
            let named =
                |event: &Event| (event.time, event.kind, event.body.map(|body| view.name(body)));
            view.events.iter().map(named).collect::<Vec<_>>()
        };
        let mut events: Vec<_> = views.iter().flat_map(|view| named(view)).collect();
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
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
            for (time, kind, body) in events.iter().filter(|(_, kind, _)| kinds.contains(kind)) {
                let inside = *time > first && *time < last;
                if panels.len() < count && inside && far(&panels, *time, 0.03 * span) {
                    let who = body.as_ref().map(|name| format!("{name}: "));
                    let note = format!("{}{}", who.unwrap_or_default(), kind.word());
                    panels.push(Panel { time: *time, note });
                }
            }
        }
        panels.sort_by(|a, b| a.time.total_cmp(&b.time));
        // Little changes before the first event, so that gap is not filled.
        let quiet = usize::from(panels.len() > 2);
        while panels.len() < count && span > 0.0 {
            let gap = |k: usize| panels[k + 1].time - panels[k].time;
            let widest = (quiet..panels.len() - 1).max_by(|&a, &b| gap(a).total_cmp(&gap(b)));
            let Some(widest) = widest else { break };
            let time = panels[widest].time + 0.5 * gap(widest);
            panels.insert(widest + 1, Panel { time, note: String::new() });
        }
        Self { scene, panels }
    }

    /// Creates a strip of one panel: a large picture of the first frame, with the names of the bodies.
    pub(crate) fn still(scene: Arc<Scene>) -> Self {
        let first = scene.frames.times[..scene.frames.len()].first().copied();
        let panels = first.map(|time| Panel { time, note: "start".into() });
        Self { scene, panels: panels.into_iter().collect() }
    }

    /// Draws the panels at equal size. The first drawing defines the bodies, with ids that start with `id`; all
    /// drawings refer to these definitions.
    pub(crate) fn drawings(&self, id: &str, language: Language) -> Vec<Drawing> {
        let frames: Vec<Option<usize>> =
            self.panels.iter().map(|p| self.scene.frames.nearest(p.time)).collect();
        let shown: Vec<usize> = frames.iter().copied().flatten().collect();
        let alone = self.panels.len() == 1;
        let view = View::of(&self.scene, &shown, if alone { STILL } else { PANEL }, alone);
        self.panels
            .iter()
            .zip(frames)
            .enumerate()
            .map(|(at, (panel, frame))| {
                let time = frame.and_then(|f| self.scene.frames.times.get(f)).copied();
                let heading = format!("t = {} s", number::fixed(time.unwrap_or(f64::NAN), 2));
                let note = language.text(&panel.note);
                let title = format!("{heading}. {note}");
                let (width, height) = (view.width, view.height);
                let mut drawing = Drawing::new(width, height + CAPTION, title.trim_end());
                if at == 0 {
                    drawing.push(define_bodies(&self.scene, id, &view, &shown));
                }
                drawing.nest([0.0, 0.0], picture(&self.scene, id, frame, &view));
                drawing.text("label strong", [1.0, height + 16.0], Anchor::Start, &heading);
                let note = fit(&note, width);
                drawing.text("note", [1.0, height + 31.0], Anchor::Start, &note);
                drawing
            })
            .collect()
    }

    pub(crate) fn draw(&self, id: &str, title: &str, language: Language) -> Drawing {
        let drawings = self.drawings(id, language);
        let (wide, high) = drawings.first().map_or((PANEL[0], 0.0), |d| (d.width, d.height));
        let most = (1..drawings.len()).take_while(|n| *n as f64 * (wide + GAP) + wide <= ROW);
        // As many panels as fit into a row, balanced so that the last row has more than one panel.
        let rows = drawings.len().div_ceil(most.count() + 1).max(1);
        let per_row = drawings.len().div_ceil(rows).max(1);
        let mut whole = Drawing::new(
            per_row as f64 * (wide + GAP) + GAP,
            (rows as f64 * (high + GAP) + GAP).max(40.0),
            title,
        );
        for (at, drawing) in drawings.into_iter().enumerate() {
            let (row, column) = (at / per_row, at % per_row);
            let corner = [GAP + column as f64 * (wide + GAP), GAP + row as f64 * (high + GAP)];
            whole.nest(corner, drawing);
        }
        whole
    }

    pub(crate) fn to_csv(&self) -> String {
        let mut out = String::from("time (s),body,x (m),z (m),angle (rad)\n");
        for panel in &self.panels {
            let Some(frame) = self.scene.frames.nearest(panel.time) else { continue };
            for (at, body) in self.scene.bodies.iter().enumerate() {
                let Some(pose) = self.scene.frames.pose(frame, at) else { continue };
                let time = self.scene.frames.times.get(frame).copied().unwrap_or(f64::NAN);
                let name = csv_field(&body.name);
                let [x, z, angle] = pose.map(number::csv_number);
                // Writing to a String cannot fail.
                let _ = writeln!(out, "{},{name},{x},{z},{angle}", number::csv_number(time));
            }
        }
        out
    }
}

/// Defines the bodies that have a pose in at least one of the frames `shown`, with ids that start with `id`.
pub(crate) fn define_bodies(scene: &Scene, id: &str, view: &View, shown: &[usize]) -> Item {
    let define = |(at, body): (usize, &SceneBody)| {
        let outlines = body.outlines.iter().map(|line| {
            let open = if line.closed { "" } else { " bs-open" };
            shape(format!("bs-body bs-{}{open}", body.role.class()), line, 1.1 / view.scale)
        });
        let hatch = (body.role == Role::Ground).then(|| ground_hatch(scene, at, view, shown));
        let marks = body.marks.iter().enumerate().map(|(place, line)| {
            let wide = if place == 0 && body.role != Role::Ground { 2.4 } else { 0.7 };
            shape("bs-body bs-open".into(), line, wide / view.scale)
        });
        Body { id: name(id, at), items: outlines.chain(hatch).chain(marks).collect() }
    };
    let drawn = |at: usize| shown.iter().any(|frame| scene.frames.pose(*frame, at).is_some());
    let bodies = scene.bodies.iter().enumerate().filter(|(at, _)| drawn(*at));
    Item::Defined(bodies.map(define).collect())
}

/// Returns the id of a body; the prefix `id` makes it unique within a page.
fn name(id: &str, body: usize) -> String {
    format!("{id}-b{body}")
}

/// Returns the hatch below the part of the ground that is visible in at least one frame.
fn ground_hatch(scene: &Scene, body: usize, view: &View, shown: &[usize]) -> Item {
    let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
    let spare = view.width / view.scale;
    for pose in shown.iter().filter_map(|&frame| scene.frames.pose(frame, body)) {
        reach[0] = reach[0].min(view.extent.lower[0] - pose[0] - spare);
        reach[1] = reach[1].max(view.extent.upper[0] - pose[0] + spare);
    }
    let lines = scene.bodies[body].outlines.iter().filter(|line| !line.closed);
    let strokes = lines.flat_map(|line| hatch(line, HATCH / view.scale, reach));
    Item::Outline {
        class: "bs-body bs-ground bs-open".into(),
        pen: 0.8 / view.scale,
        runs: strokes.map(Vec::from).collect(),
        closed: false,
    }
}

/// Draws the bodies of a scene at a frame, within a border.
pub(crate) fn picture(scene: &Scene, id: &str, frame: Option<usize>, view: &View) -> Drawing {
    let mut drawing = Drawing::new(view.width, view.height, "");
    drawing.rect("frame", [0.5, 0.5], [view.width - 1.0, view.height - 1.0]);
    if let Some(frame) = frame {
        place_bodies(&mut drawing, scene, id, frame, view);
    }
    drawing
}

fn place_bodies(drawing: &mut Drawing, scene: &Scene, id: &str, frame: usize, view: &View) {
    let poses: Vec<_> = (0..scene.bodies.len())
        .filter_map(|at| Some((at, scene.frames.pose(frame, at)?)))
        .collect();
    let placed = poses.iter().map(|(at, pose)| {
        let ground = scene.bodies[*at].role == Role::Ground;
        Placed { id: name(id, *at), class: if ground { "ground" } else { "moving" }, pose: *pose }
    });
    let (scale, origin) = (view.scale, view.origin());
    drawing.push(Item::Scene { scale, origin, bodies: placed.collect() });
    for ends in scene.ties.iter().filter_map(|tie| scene.ends(tie, frame)) {
        let run = ends.map(|end| view.on_page(end)).to_vec();
        drawing.path("bs-tie", "", vec![run], false);
    }
    for (at, [x, z, _]) in poses.iter().filter(|_| view.names) {
        let body = &scene.bodies[*at];
        if matches!(body.role, Role::Barrel | Role::Block) {
            let [x, y] = view.on_page([*x, *z]);
            drawing.text("label", [x, y + 4.0], Anchor::Middle, &body.name);
        }
    }
}

fn shape(class: String, line: &Polyline, pen: f64) -> Item {
    Item::Outline { class, pen, runs: vec![line.points.clone()], closed: line.closed }
}

/// Shortens a note to the width of its panel.
fn fit(note: &str, width: f64) -> String {
    if text_width(note, 11.0) <= width {
        return note.into();
    }
    let mut kept = note.to_owned();
    while kept.pop().is_some() && text_width(&kept, 11.0) + 8.0 > width {}
    format!("{}…", kept.trim_end())
}
