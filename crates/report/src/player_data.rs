//! Data of a player for the page: panes with bodies, packed frames and events, and data that the
//! panes share.

use std::cmp::Ordering;

use serde_json::{Value, json};

use crate::{
    ContactForce, Event, Ghosts, History, Moment, Player, Players, Point, Polyline, Pose2, Scene,
    Tint, Trace,
    pack::{self, POSE_QUANTUM, TIME_QUANTUM},
    scene::{Extent, window},
    simplify::simplify,
};

/// Returns the data of a single player.
///
/// Poses are rounded to multiples of 2⁻¹⁴ (m and rad), times to multiples of 2⁻²⁰ s, and points of
/// application to multiples of 2⁻¹⁰ m. Forces are rounded to multiples of a power of two that is at most
/// 2⁻¹² of the largest component.
pub(crate) fn of_player(player: &Player, id: &str) -> Value {
    let scene = &player.scene;
    let alone = pane("", scene, &player.traces, &whole_window(scene));
    together(id, &[alone], &scene.ground, [&**scene])
}

/// Returns the data that the panes of a player share.
fn together<'a>(
    id: &str,
    panes: &[Value],
    ground: &[History],
    scenes: impl IntoIterator<Item = &'a Scene>,
) -> Value {
    json!({
        "id": id,
        "panes": panes,
        "ground": ground.iter().map(history).collect::<Vec<_>>(),
        "opens": opens(scenes),
        "begins": begins(ground),
    })
}

/// Returns the index of the pane that a player shows first: the pane with the earliest [`Moment`] at which a body
/// falls or, if no body falls, the pane with the earliest [`Moment`]; `None` if no scene has a moment.
fn opens<'a>(scenes: impl IntoIterator<Item = &'a Scene>) -> Option<usize> {
    let moments = scenes.into_iter().map(|scene| scene.moment.as_ref()).enumerate();
    let known = moments
        .filter_map(|(at, moment)| Some((at, moment?)))
        .filter(|(_, moment)| moment.time.is_finite());
    let key = |moment: &Moment| (!moment.falls, moment.time);
    known
        .min_by(|(_, a), (_, b)| key(a).partial_cmp(&key(b)).unwrap_or(Ordering::Equal))
        .map(|(at, _)| at)
}

/// Time (s) by which the start of the player precedes the strong ground motion.
const LEAD_IN: f64 = 1.0;

/// Fraction of the peak of a history above which the ground motion counts as strong.
const STRONG: f64 = 0.1;

/// Returns the time (s) at which a player starts: shortly before the earliest strong ground motion; `None` if there is
/// no ground motion.
fn begins(ground: &[History]) -> Option<f64> {
    let strong = ground.iter().filter_map(|history| {
        let peak = history.values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let mut both = history.times.iter().zip(&history.values);
        both.find(|(_, value)| peak > 0.0 && value.abs() >= STRONG * peak).map(|(time, _)| *time)
    });
    strong.reduce(f64::min).map(|time| time - LEAD_IN)
}

/// Returns the data of several panes at one scale; all windows have the size of the largest window
/// and are aligned at the bottom.
pub(crate) fn of_players(players: &Players, id: &str) -> Value {
    let windows: Vec<Extent> = players.panes.iter().map(|p| whole_window(&p.scene)).collect();
    let most = |size: fn(&Extent) -> f64| windows.iter().map(size).fold(0.0, f64::max);
    let (width, height) = (most(Extent::width), most(Extent::height));
    let bottom = windows.iter().map(|w| w.lower[1]).fold(f64::INFINITY, f64::min);
    let panes: Vec<Value> = players
        .panes
        .iter()
        .zip(&windows)
        .map(|(one, own)| {
            let middle = 0.5 * (own.lower[0] + own.upper[0]);
            let view = Extent {
                lower: [middle - 0.5 * width, bottom],
                upper: [middle + 0.5 * width, bottom + height],
            };
            pane(&one.mark, &one.scene, &one.traces, &view)
        })
        .collect();
    let scenes = players.panes.iter().map(|pane| &*pane.scene);
    let mut value = together(id, &panes, &players.ground, scenes);
    value["overlay"] = json!(players.overlay);
    value
}

fn whole_window(scene: &Scene) -> Extent {
    let all: Vec<usize> = (0..scene.frames.len()).collect();
    window(scene, &all)
}

fn pane(mark: &str, scene: &Scene, traces: &[Trace], view: &Extent) -> Value {
    let count = scene.frames.len();
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
            let value = |f: usize| scene.frames.pose(f, body).map_or(f64::NAN, |p| p[component]);
            channels.push((0..count).map(value).collect::<Vec<f64>>());
        }
    }
    let times = vec![scene.frames.times[..count].to_vec()];
    let traces: Vec<Value> = traces
        .iter()
        .filter(|t| t.body < scene.bodies.len() && t.point.iter().all(|v| v.is_finite()))
        .map(|t| json!({ "body": t.body, "point": t.point, "label": t.label }))
        .collect();
    let ties: Vec<Value> = scene
        .ties
        .iter()
        .filter(|tie| tie.bodies.iter().all(|body| *body < scene.bodies.len()))
        .map(|tie| json!({ "bodies": tie.bodies, "points": tie.points, "torn": tie.torn_at }))
        .collect();
    let moment = scene
        .moment
        .as_ref()
        .filter(|moment| moment.time.is_finite() && moment.body < scene.bodies.len() && count > 0);
    let moment =
        moment.map(|moment| json!({ "t": moment.time, "body": moment.body, "text": moment.text }));
    json!({
        "mark": mark,
        "bodies": bodies,
        "ties": ties,
        "times": pack::channels(&times, count, TIME_QUANTUM),
        "poses": pack::channels(&channels, count, POSE_QUANTUM),
        "forces": forces(&scene.frames.forces, count),
        "events": events(&scene.events, scene.bodies.len()),
        "traces": traces,
        "moment": moment,
        "ghosts": scene.ghosts.as_ref().map(|ghosts| self::ghosts(ghosts, scene.bodies.len())),
        "tint": scene.tint.as_ref().map(|tint| self::tint(tint, scene.bodies.len(), count)),
        "depth": scene.depth.as_ref().map(|depth| depth.value(count)),
        "view": [view.lower[0], view.lower[1], view.upper[0], view.upper[1]],
    })
}

/// Returns the events for the page, without those at a time that is not finite. `bodies` is the number of bodies; the
/// index of a body that does not exist becomes null.
pub(crate) fn events(events: &[Event], bodies: usize) -> Vec<Value> {
    let event = |event: &Event| {
        json!({
            "t": event.time,
            "body": event.body.filter(|body| *body < bodies),
            "kind": event.kind.class(),
            "text": event.text,
        })
    };
    events.iter().filter(|event| event.time.is_finite()).map(event).collect()
}

fn polyline(line: &Polyline) -> Value {
    // Rounded to a tenth of a millimeter, finer than the poses need, to keep the numbers short.
    let short = |v: f64| (v * 1e4).round() / 1e4;
    let finite = line.points.iter().filter(|p| p.iter().all(|v| v.is_finite()));
    let points: Vec<f64> = finite.flatten().map(|v| short(*v)).collect();
    json!({ "closed": line.closed, "points": points })
}

fn history(history: &History) -> Value {
    let count = history.times.len().min(history.values.len());
    json!({
        "label": history.label,
        "unit": history.unit,
        "t": pack::column(&history.times[..count], false),
        "v": pack::column(&history.values[..count], false),
    })
}

/// Quantum of the lengths (m) and angles (rad) of ghosts: about 4 mm and 4 mrad, which is too small to be visible.
const GHOST_QUANTUM: f64 = 1.0 / 256.0;

/// Maximum distance (m) of the drawn line of a ghost from the true path.
const GHOST_TOLERANCE: f64 = 0.01;

/// Packs ghosts. The paths become two channels, x and z, with a gap after every path. The final poses become three
/// channels and a list of bodies.
fn ghosts(ghosts: &Ghosts, bodies: usize) -> Value {
    let mut line: Vec<Point> = Vec::new();
    for path in &ghosts.paths {
        // `simplify` works in pixels, so lengths are expressed in multiples of the tolerance.
        let steps: Vec<Point> = path.iter().map(|p| p.map(|v| v / GHOST_TOLERANCE)).collect();
        line.extend(simplify(&steps, 1.0).into_iter().map(|p| p.map(|v| v * GHOST_TOLERANCE)));
        line.push([f64::NAN; 2]);
    }
    let ends: Vec<&(usize, Pose2)> =
        ghosts.ends.iter().filter(|(body, _)| *body < bodies).collect();
    let channels = [0, 1].map(|axis| line.iter().map(|point| point[axis]).collect::<Vec<f64>>());
    let poses = [0, 1, 2].map(|axis| ends.iter().map(|(_, pose)| pose[axis]).collect::<Vec<f64>>());
    json!({
        "label": ghosts.label,
        "count": ghosts.count,
        "paths": pack::channels(&channels, line.len(), GHOST_QUANTUM),
        "ends": pack::channels(&poses, ends.len(), GHOST_QUANTUM),
        "bodies": ends.iter().map(|(body, _)| body).collect::<Vec<_>>(),
    })
}

/// Quantile of the positive values at which the color scale ends. The scale does not extend to the maximum, because the
/// values of impacts far exceed all others.
const TINT_ENDS: f64 = 0.99;

/// Packs a tint in steps of at most 1/64 of its color scale; values beyond the end of the scale are
/// capped.
fn tint(tint: &Tint, bodies: usize, count: usize) -> Value {
    let value = |frame: usize, body: usize| {
        tint.values.get(frame).and_then(|list| list.get(body)).map_or(f64::NAN, |v| v.max(0.0))
    };
    let mut channels: Vec<Vec<f64>> =
        (0..bodies).map(|body| (0..count).map(|frame| value(frame, body)).collect()).collect();
    let mut above: Vec<f64> = channels.iter().flatten().copied().filter(|v| *v > 0.0).collect();
    above.sort_by(f64::total_cmp);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of a count"
    )]
    let last = (TINT_ENDS * above.len().saturating_sub(1) as f64) as usize;
    let end = above.get(last).copied().unwrap_or(0.0);
    for value in channels.iter_mut().flatten().filter(|value| **value > end) {
        *value = end;
    }
    let quantum = pack::quantum_for(&[0.0, end]) * 1024.0;
    json!({ "label": tint.label, "unit": tint.unit, "v": pack::channels(&channels, count, quantum) })
}

/// Packs forces as four lists of channels: x and z of the point of application, and x and z of the force.
///
/// Channel `i` contains one value per frame, from the force with index `i` in the forces of the frame. The number of
/// channels is the largest number of forces in a frame. Missing and zero forces are gaps.
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
