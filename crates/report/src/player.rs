//! A player: a scene in motion, and the compact form in which a page carries it.

use std::sync::Arc;

use serde_json::{Value, json};

use crate::{
    Block, ContactForce, Figure, FigureKind, History, Polyline, Scene, Strip, Trace,
    pack::{self, POSE_QUANTUM, TIME_QUANTUM},
    scene::window,
};

/// Moving bodies with controls.
#[derive(Clone, Debug, PartialEq)]
pub struct Player {
    /// Short name, made safe for anchors and file names.
    pub id: String,
    /// What is shown and how to read it.
    pub caption: String,
    /// What moves.
    pub scene: Arc<Scene>,
    /// Points whose paths are drawn.
    pub traces: Vec<Trace>,
}

impl Player {
    /// The player where nothing can play, in a document of these blocks: a strip of six frames,
    /// or the first frame with names when the document shows a strip of this scene anyway.
    pub fn paper_figure(&self, blocks: &[Block]) -> Figure {
        let scene = Arc::clone(&self.scene);
        let strip =
            if shows_strip(blocks, &scene) { Strip::still(scene) } else { Strip::of_run(scene, 6) };
        Figure {
            id: self.id.clone(),
            caption: self.caption.clone(),
            kind: FigureKind::Strip(strip),
        }
    }

    /// The page's form of the player.
    ///
    /// Poses are multiples of 2⁻¹⁴ (m and rad), times of 2⁻²⁰ s, places of forces of 2⁻¹⁰ m and
    /// forces of a power of two at most 2⁻¹² of the largest component.
    pub(crate) fn payload(&self, id: &str) -> Value {
        let scene = &*self.scene;
        let count = scene.frames.len();
        let all: Vec<usize> = (0..count).collect();
        let view = window(scene, &all);
        let bodies: Vec<Value> = scene
            .bodies
            .iter()
            .map(|body| {
                json!({
                    "name": body.name,
                    "role": body.role.class(),
                    "outlines": body.outlines.iter().map(polyline).collect::<Vec<_>>(),
                    "marks": body.marks.iter().map(polyline).collect::<Vec<_>>(),
                })
            })
            .collect();
        let mut channels = Vec::with_capacity(3 * scene.bodies.len());
        for body in 0..scene.bodies.len() {
            for component in 0..3 {
                let value =
                    |f: usize| scene.frames.pose(f, body).map_or(f64::NAN, |p| p[component]);
                channels.push((0..count).map(value).collect::<Vec<f64>>());
            }
        }
        let times = vec![scene.frames.times[..count].to_vec()];
        let events: Vec<Value> = scene
            .events
            .iter()
            .filter(|event| event.time.is_finite())
            .map(|event| {
                json!({
                    "t": event.time,
                    "body": event.body.filter(|b| *b < scene.bodies.len()),
                    "kind": event.kind.class(),
                    "text": event.text,
                })
            })
            .collect();
        let traces: Vec<Value> = self
            .traces
            .iter()
            .filter(|t| t.body < scene.bodies.len() && t.point.iter().all(|v| v.is_finite()))
            .map(|t| json!({ "body": t.body, "point": t.point, "label": t.label }))
            .collect();
        json!({
            "id": id,
            "bodies": bodies,
            "times": pack::channels(&times, count, TIME_QUANTUM),
            "poses": pack::channels(&channels, count, POSE_QUANTUM),
            "forces": forces(&scene.frames.forces, count),
            "events": events,
            "traces": traces,
            "ground": scene.ground.iter().map(history).collect::<Vec<_>>(),
            "view": [view.lower[0], view.lower[1], view.upper[0], view.upper[1]],
        })
    }
}

fn shows_strip(blocks: &[Block], scene: &Arc<Scene>) -> bool {
    blocks.iter().any(|block| match block {
        Block::Figure(Figure { kind: FigureKind::Strip(strip), .. }) => {
            Arc::ptr_eq(&strip.scene, scene)
        }
        Block::Details { blocks, .. } => shows_strip(blocks, scene),
        Block::Figure(_)
        | Block::Player(_)
        | Block::Table(_)
        | Block::Heading { .. }
        | Block::Paragraph(_)
        | Block::List(_) => false,
    })
}

fn polyline(line: &Polyline) -> Value {
    // A tenth of a millimeter, like the poses; it keeps the numbers short.
    let short = |v: f64| (v * 1e4).round() / 1e4;
    let finite = line.points.iter().filter(|p| p.iter().all(|v| v.is_finite()));
    let points: Vec<f64> = finite.flatten().map(|v| short(*v)).collect();
    json!({ "closed": line.closed, "points": points })
}

pub(crate) fn history(history: &History) -> Value {
    let count = history.times.len().min(history.values.len());
    json!({
        "label": history.label,
        "unit": history.unit,
        "t": pack::column(&history.times[..count], false),
        "v": pack::column(&history.values[..count], false),
    })
}

/// Forces as four channels with a slot for each place in the longest list; absent ones are gaps.
fn forces(frames: &[Vec<ContactForce>], count: usize) -> Value {
    let frames = &frames[..frames.len().min(count)];
    let slots = frames.iter().map(Vec::len).max().unwrap_or(0);
    if slots == 0 {
        return Value::Null;
    }
    let pick = |value: fn(&ContactForce) -> f64| -> Vec<Vec<f64>> {
        (0..slots)
            .map(|slot| {
                let at = |f: usize| {
                    let force = frames.get(f).and_then(|list| list.get(slot));
                    force.filter(|f| f.fx != 0.0 || f.fz != 0.0).map_or(f64::NAN, value)
                };
                (0..count).map(at).collect()
            })
            .collect()
    };
    let finite = frames.iter().flatten().flat_map(|f| [f.fx.abs(), f.fz.abs()]);
    let peak = finite.filter(|v| v.is_finite()).fold(0.0, f64::max);
    let quantum = pack::quantum_for(&[0.0, peak]) * 16.0;
    let place = 1.0 / 1024.0;
    json!({
        "slots": slots,
        "x": pack::channels(&pick(|f| f.x), count, place),
        "z": pack::channels(&pick(|f| f.z), count, place),
        "fx": pack::channels(&pick(|f| f.fx), count, quantum),
        "fz": pack::channels(&pick(|f| f.fz), count, quantum),
    })
}
