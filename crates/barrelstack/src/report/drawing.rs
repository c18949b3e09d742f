//! Converts the bodies and frames of a run to a drawable scene.

use std::sync::Arc;

use barrelstack_dynamics::{Element, Shape};
use barrelstack_motion::STANDARD_GRAVITY;
use barrelstack_report::{
    ContactForce, Event, EventKind, Frames, Ghosts, History, Moment, Point, Polyline, Role, Scene,
    SceneBody, Tie, Tint, significant,
};

use super::depth::depth;
use crate::assemble::{Assembly, Part, PartKind};
use crate::device::FREE;
use crate::motion;
use crate::outcome::Outcome;
use crate::run::Run;
use crate::variants::Variants;
use crate::watch::Loss;

/// Returns the scene of a run.
pub fn scene(run: &Run) -> Arc<Scene> {
    scene_among(run, None)
}

/// Returns the scene of a run, in which the paths and the final poses of the variants are drawn as
/// ghosts.
pub(super) fn scene_among(run: &Run, variants: Option<&Variants>) -> Arc<Scene> {
    let frames = &run.recording.frames;
    let ties = ties(&run.assembly, |element| run.elements.get(element)?.broken_at);
    let (events, moment) = (events(run), moment(run));
    let depth = depth(&run.scenario, &run.assembly, &ties, (&events, moment.as_ref()));
    Arc::new(Scene {
        bodies: (0..run.assembly.parts.len()).map(|i| body(&run.assembly, i)).collect(),
        ties,
        frames: Frames {
            times: frames.times.clone(),
            poses: frames.poses.clone(),
            forces: frames.forces.iter().map(|list| list.iter().map(pushed).collect()).collect(),
        },
        events,
        ground: ground_histories(run),
        moment,
        depth,
        tint: run.assembly.of_kind(PartKind::Barrel).next().map(|_| tint(run)),
        ghosts: variants.and_then(ghosts),
    })
}

/// Converts a contact point and one of the two opposite contact forces to the force to draw: the one that points
/// upward.
fn pushed(&[x, z, fx, fz]: &[f64; 4]) -> ContactForce {
    let sign = if fz < 0.0 { -1.0 } else { 1.0 };
    ContactForce { x, z, fx: sign * fx, fz: sign * fz }
}

/// Returns the scene of the bodies as assembled, before settling.
pub(super) fn still(assembly: &Assembly) -> Scene {
    let poses = assembly.model.bodies().iter().map(|body| body.pose);
    Scene {
        bodies: (0..assembly.parts.len()).map(|i| body(assembly, i)).collect(),
        ties: ties(assembly, |_| None),
        frames: Frames {
            times: vec![0.0],
            poses: vec![poses.map(|p| [p.position.x, p.position.z, p.orientation]).collect()],
            forces: Vec::new(),
        },
        ..Scene::default()
    }
}

/// Maximum number of variants whose paths are drawn; more paths would merge into a black area.
const DRAWN: usize = 128;

/// Returns the paths of the top barrels and the final poses of the barrels, for at most `DRAWN` variants; `None` if
/// there are no paths.
fn ghosts(variants: &Variants) -> Option<Ghosts> {
    let trails = || variants.results.iter().skip(1).take(DRAWN).map(|result| &result.trail);
    let wide = |place: &[f32; 2]| place.map(f64::from);
    let paths: Vec<Vec<Point>> = trails()
        .flat_map(|trail| &trail.paths)
        .map(|path| path.iter().map(wide).collect())
        .collect();
    let ends = trails().flat_map(|trail| {
        trail.barrels.iter().zip(&trail.last).map(|(body, last)| (*body, last.map(f64::from)))
    });
    (!paths.is_empty()).then(|| Ghosts {
        label: "all variants".into(),
        count: trails().filter(|trail| !trail.barrels.is_empty()).count(),
        paths,
        ends: ends.collect(),
    })
}

/// Returns the part of the caption that explains straps, devices, wine and variants.
pub fn legend(scene: &Scene) -> String {
    let mut legend = String::new();
    if !scene.ties.is_empty() {
        legend += " Bands with a buckle are straps and ties (in a free scene, all force elements); a broken strap or tie disappears.";
    }
    let devices = scene.bodies.iter().filter(|body| body.role == Role::Device);
    let (wine, others): (Vec<_>, Vec<_>) =
        devices.partition(|body| body.name.starts_with(PartKind::Wine.name()));
    if !others.is_empty() {
        legend += " Green bodies are devices.";
    }
    if !wine.is_empty() {
        legend += " The disc in a barrel is the swinging part of its wine.";
    }
    if let Some(ghosts) = &scene.ghosts {
        let paths = format!(
            " With “{}” switched on, thin lines show the paths of the top barrels in each variant until the end of its run; the darker a spot, the more barrels end there.",
            ghosts.label
        );
        legend += &paths;
    }
    legend
}

/// Displacement (m) below which a body counts as motionless. If no body moves farther, the player first shows the start
/// of the run.
const STILL: f64 = 1e-3;

/// Returns the instant that the player shows first: the first loss of a seat or, if all seats are kept, the largest
/// sideways or upward displacement of a body.
///
/// Returns `None` if the run is invalid, interrupted or not judged, or if all seats are kept and no body moves farther
/// than [`STILL`].
fn moment(run: &Run) -> Option<Moment> {
    match &run.outcome {
        Outcome::Collapse { time, first, .. } => {
            let body = run.assembly.parts.iter().position(|part| part.name == *first)?;
            let (_, loss) = run.fates.fate(body).left_seat?;
            let text = match loss {
                Loss::Displaced => format!("here {first} leaves its cradle"),
                Loss::Slid => format!("here rack {first} slides off the barrels below"),
                Loss::Tilted => format!("here rack {first} leaves its seat"),
                Loss::Dropped => format!("here {first} loses its support"),
            };
            Some(Moment { time: *time, body, text, falls: true })
        }
        Outcome::Stable => furthest(run),
        Outcome::NotJudged | Outcome::Interrupted | Outcome::Invalid { .. } => None,
    }
}

/// Returns the time at which the largest sideways or upward displacement from rest occurs, and the
/// body that is displaced.
fn furthest(run: &Run) -> Option<Moment> {
    let mut furthest: Option<(f64, f64, usize, &str)> = None;
    for (body, part) in run.assembly.parts.iter().enumerate() {
        for (axis, word) in [("x", "sways furthest"), ("z", "is lifted highest")] {
            let channel = run.recording.channel(&format!("{} displacement {axis}", part.name));
            let values = channel.map_or(&[][..], |channel| &channel.values);
            for (time, value) in run.recording.times.iter().zip(values) {
                let displacement = if axis == "x" { value.abs() } else { *value };
                if furthest.is_none_or(|(most, ..)| displacement > most) {
                    furthest = Some((displacement, *time, body, word));
                }
            }
        }
    }
    let (displacement, time, body, word) =
        furthest.filter(|(displacement, ..)| *displacement > STILL)?;
    let name = &run.assembly.parts[body].name;
    let text = format!("here {name} {word}, by {} cm", significant(100.0 * displacement, 2));
    Some(Moment { time, body, text, falls: false })
}

/// Returns the quantity by which barrels are colored: in each frame, the largest contact stress on every barrel, as a
/// line load (kN/m).
fn tint(run: &Run) -> Tint {
    let parts = &run.assembly.parts;
    let of = |(part, stress): (&Part, &f64)| {
        if part.kind == PartKind::Barrel { 1e-3 * stress } else { f64::NAN }
    };
    let frames = run.recording.frames.stresses.iter();
    Tint {
        label: "contact line load".into(),
        unit: "kN/m".into(),
        values: frames.map(|frame| parts.iter().zip(frame).map(of).collect()).collect(),
    }
}

/// Returns the outlines of a body as polylines in the frame of the body.
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
            // The bung is at the top of the bilge; the hoops are at their usual positions, near the
            // heads and on both sides of the bilge.
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
                PartKind::Device | PartKind::Wine => Role::Device,
                PartKind::Body => Role::Block,
            };
            SceneBody::new(&part.name, role, outlines(assembly, index))
        }
    }
}

/// Returns the elements that are drawn as lines between two bodies: straps, and all elements of a
/// free scene.
fn ties(assembly: &Assembly, torn_at: impl Fn(usize) -> Option<f64>) -> Vec<Tie> {
    assembly
        .elements()
        .enumerate()
        .filter(|(at, element)| {
            matches!(element, Element::Strap(_)) || assembly.devices.get(*at) == Some(&&FREE)
        })
        .map(|(at, element)| Tie {
            bodies: element.link().bodies,
            points: element.link().points.map(|point| [point.x, point.z]),
            torn_at: torn_at(at),
        })
        .collect()
}

fn events(run: &Run) -> Vec<Event> {
    let mut events = Vec::new();
    for (i, part) in run.assembly.parts.iter().enumerate() {
        let fate = run.fates.fate(i);
        // A barrel that leaves its seat by falling is one event, not two.
        let falls_with_it = |time: f64| {
            part.kind == PartKind::Barrel && fate.fell_at.is_some_and(|fell| fell <= time)
        };
        if let Some((time, loss)) = fate.left_seat.filter(|(time, _)| !falls_with_it(*time)) {
            let text = match loss {
                Loss::Displaced => format!("{} leaves its cradle", part.name),
                Loss::Slid => format!("{} leaves the barrels below", part.name),
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

/// Returns the horizontal acceleration and velocity of the ground; empty if there is no motion.
pub(crate) fn ground_histories(run: &Run) -> Vec<History> {
    let Some(motion) = &run.ground.motion else { return Vec::new() };
    let span = (motion.horizontal.natural_step(), run.end_time);
    let velocity = |time: f64| 100.0 * motion.horizontal.at(time).velocity;
    let first = ground_acceleration("ground acceleration", &motion.horizontal, run.end_time);
    vec![first, ground_history("ground velocity", "cm/s", span, &velocity)]
}

/// Returns the acceleration (g) of a component of the ground motion until `end` (s).
pub(crate) fn ground_acceleration(label: &str, component: &motion::History, end: f64) -> History {
    let value = |time: f64| component.at(time).acceleration / STANDARD_GRAVITY;
    ground_history(label, "g", (component.natural_step(), end), &value)
}

/// Samples a quantity of the ground motion, from time 0 to `end` (s), for a plot.
///
/// The quantity is evaluated at intervals of `step` (s), but not more often than every 0.1 ms. Of the samples within
/// each interval of 1/50 s, only the one with the largest magnitude is kept, at its own time, so that the plot shows
/// the true peaks.
pub fn ground_history(
    label: &str,
    unit: &str,
    (step, end): (f64, f64),
    value: &dyn Fn(f64) -> f64,
) -> History {
    /// Maximum number of samples per second that are kept.
    const RATE: f64 = 50.0;
    let (mut times, mut values): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let step = step.max(1e-4);
    let samples = (0..).map(|sample| f64::from(sample) * step);
    for time in samples.take_while(|time| *time <= end) {
        let sample = value(time);
        let bin = |time: f64| (time * RATE + 1e-6).floor();
        match (times.last_mut(), values.last_mut()) {
            (Some(last), Some(most)) if bin(*last) == bin(time) => {
                if sample.abs() > most.abs() {
                    (*last, *most) = (time, sample);
                }
            }
            _ => {
                times.push(time);
                values.push(sample);
            }
        }
    }
    History { label: label.to_owned(), unit: unit.to_owned(), times, values }
}
