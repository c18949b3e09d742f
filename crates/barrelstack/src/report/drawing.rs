//! From bodies and frames to a scene that can be drawn.

use std::sync::Arc;

use barrelstack_dynamics::Shape;
use barrelstack_report::{
    ContactForce, Event, EventKind, Frames, History, Polyline, Role, Scene, SceneBody, Tie,
};

use crate::assemble::{Assembly, PartKind};
use crate::run::Run;
use crate::watch::Loss;

/// The scene of a run.
pub fn scene(run: &Run) -> Arc<Scene> {
    let frames = &run.recording.frames;
    Arc::new(Scene {
        bodies: (0..run.assembly.parts.len()).map(|i| body(&run.assembly, i)).collect(),
        ties: ties(run),
        frames: Frames {
            times: frames.times.clone(),
            poses: frames.poses.clone(),
            forces: frames
                .forces
                .iter()
                .map(|list| {
                    list.iter()
                        .map(|&[x, z, fx, fz]| {
                            // Of the two that push each other, the one that is pushed up.
                            let sign = if fz < 0.0 { -1.0 } else { 1.0 };
                            ContactForce { x, z, fx: sign * fx, fz: sign * fz }
                        })
                        .collect()
                })
                .collect(),
        },
        events: events(run),
        ground: ground_histories(run),
    })
}

/// The outlines of a body as lines in its own frame.
pub(super) fn outlines(assembly: &Assembly, body: usize) -> Vec<Polyline> {
    assembly.parts[body]
        .outlines
        .iter()
        .map(|outline| Polyline {
            points: outline.points.iter().map(|p| [p.x, p.z]).collect(),
            closed: outline.closed,
        })
        .collect()
}

fn body(assembly: &Assembly, index: usize) -> SceneBody {
    let part = &assembly.parts[index];
    let surfaces = &assembly.model.bodies()[index].surfaces;
    match (part.kind, surfaces.first().map(|placed| &placed.surface)) {
        (PartKind::Barrel, Some(Shape::Circle(circle))) => {
            SceneBody::barrel(&part.name, circle.radius)
        }
        (PartKind::Barrel, Some(Shape::BarrelProfile(profile))) => {
            let mut body = SceneBody::new(&part.name, Role::Barrel, outlines(assembly, index));
            // The bung, at the top of the bilge, then hoops, where coopers drive them: at the heads
            // and on both sides of the bilge.
            let bilge = profile.radius_at(0.0);
            body.marks.push(Polyline::open(vec![[0.0, 0.9 * bilge], [0.0, bilge]]));
            for share in [0.28, 0.6, -0.6, -0.28, 0.94, -0.94] {
                let x = share * profile.half_length;
                let z = profile.radius_at(x);
                body.marks.push(Polyline::open(vec![[x, -z], [x, z]]));
            }
            body
        }
        (PartKind::Body, Some(Shape::Circle(circle))) => {
            let mut body = SceneBody::barrel(&part.name, circle.radius);
            body.role = Role::Block;
            body
        }
        (kind, _) => {
            let role = match kind {
                PartKind::Ground => Role::Ground,
                PartKind::Rack => Role::Rack,
                PartKind::Barrel => Role::Barrel,
                PartKind::Body => Role::Block,
            };
            SceneBody::new(&part.name, role, outlines(assembly, index))
        }
    }
}

fn ties(run: &Run) -> Vec<Tie> {
    let elements = run.assembly.model.elements().iter().zip(&run.elements);
    elements
        .map(|(element, fate)| Tie {
            bodies: element.link().bodies,
            points: element.link().points.map(|point| [point.x, point.z]),
            torn_at: fate.broken_at,
        })
        .collect()
}

fn events(run: &Run) -> Vec<Event> {
    let mut events = Vec::new();
    for (i, part) in run.assembly.parts.iter().enumerate() {
        let fate = run.fates.fate(i);
        // A barrel that leaves its seat by falling is one thing that happens, not two.
        let falls_with_it = |time: f64| {
            part.kind == PartKind::Barrel && fate.fell_at.is_some_and(|fell| fell <= time)
        };
        if let Some((time, loss)) = fate.left_seat.filter(|(time, _)| !falls_with_it(*time)) {
            let text = match loss {
                Loss::Displaced => format!("{} leaves its cradle", part.name),
                Loss::Slid => format!("{} has slid off the barrels below", part.name),
                Loss::Tilted => format!("{} has tilted off its seat", part.name),
                Loss::Dropped => format!("{} loses its support", part.name),
            };
            events.push(Event { time, body: Some(i), kind: EventKind::LossOfSeat, text });
        }
        if let (Some(time), PartKind::Barrel) = (fate.fell_at, part.kind) {
            let text = format!("{} falls", part.name);
            events.push(Event { time, body: Some(i), kind: EventKind::Fall, text });
        }
    }
    let elements = run.assembly.model.elements().iter().zip(&run.assembly.devices);
    for ((element, device), fate) in elements.zip(&run.elements) {
        if let Some(time) = fate.broken_at {
            let link = element.link();
            let text = format!("the {} {} {}", device.one, link.name, device.breaks);
            let body = Some(link.bodies[0]);
            events.push(Event { time, body, kind: EventKind::Note, text });
        }
    }
    events.sort_by(|a, b| a.time.total_cmp(&b.time));
    events
}

/// Acceleration and velocity of the ground; none where nothing shakes it.
pub(crate) fn ground_histories(run: &Run) -> Vec<History> {
    if run.ground.motion.is_none() {
        return Vec::new();
    }
    let recording = &run.recording;
    let history = |channel: &str, label: &str, unit: &str, factor: f64| {
        let values = recording.channel(channel)?.values.iter().map(|v| v * factor).collect();
        Some(History {
            label: label.to_owned(),
            unit: unit.to_owned(),
            times: recording.times.clone(),
            values,
        })
    };
    [
        history(
            "ground acceleration x",
            "ground acceleration",
            "g",
            1.0 / barrelstack_motion::STANDARD_GRAVITY,
        ),
        history("ground velocity x", "ground velocity", "cm/s", 100.0),
    ]
    .into_iter()
    .flatten()
    .collect()
}
