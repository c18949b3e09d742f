//! The paper's figures, drawn from our runs.

use std::sync::Arc;

use barrelstack::assemble::{Assembly, PartKind};
use barrelstack::report::{scene, standing_range, stress_figure};
use barrelstack::run::Run;
use barrelstack::watch::JointForces;
use barrelstack_report::{
    Arrow, Axis, Block, Cell, Diagram, Figure, Mark, Panel, Player, Plot, Point, Scene, Series,
    Strip, Table,
};

use super::numbering;

/// Builds an animation player for a run.
pub(super) fn player(scene: &Arc<Scene>, id: &str, caption: &str) -> Block {
    let player = Player {
        id: id.to_owned(),
        caption: caption.to_owned(),
        scene: Arc::clone(scene),
        traces: Vec::new(),
    };
    Block::on_screen("The animation", vec![Block::Player(player)])
}

/// Builds a row of pictures of selected instants.
pub(super) fn strip(
    scene: &Arc<Scene>,
    id: &str,
    caption: &str,
    panels: impl IntoIterator<Item = (f64, String)>,
) -> Block {
    let panels = panels.into_iter().map(|(time, note)| Panel { time, note }).collect();
    Block::Figure(Figure::new(id, caption, Strip { scene: Arc::clone(scene), panels }))
}

/// Returns the instants of a collapse with their labels: at rest, and before, at and after the loss of a seat.
pub(super) fn moments(run: &Run) -> Vec<(f64, String)> {
    let mut panels = vec![(0.0, "at rest".to_owned())];
    let end = run.end_time;
    let Some(loss) = run.fates.collapse_time() else {
        for part in 1..=5 {
            let time = end * f64::from(part) / 5.0;
            panels.push((time, if part == 5 { "end".into() } else { String::new() }));
        }
        return panels;
    };
    let first = run.fates.first().map_or("", |body| run.assembly.parts[body].name.as_str());
    panels.push((loss - 0.4, "0.4 s before".into()));
    panels.push((loss, format!("{first} leaves its seat")));
    panels.push((loss + 0.35, "0.35 s after".into()));
    panels.push((loss + 0.7, "0.7 s after".into()));
    panels.push((loss + 1.0, "1 s after".into()));
    panels.retain(|(time, _)| *time >= 0.0 && *time <= end);
    panels
}

/// Returns the instants of the events of a collapse with their labels: the loss of a seat, and the fall of each barrel
/// of the top level.
pub(super) fn events(run: &Run) -> Vec<(f64, String)> {
    let mut panels = vec![(0.0, "at rest".to_owned())];
    let Some(loss) = run.fates.collapse_time() else { return moments(run) };
    let parts = &run.assembly.parts;
    let first = run.fates.first().map_or_else(String::new, |body| named(run, body));
    panels.push((loss - 0.3, "0.3 s before".into()));
    panels.push((loss, format!("{first} leaves its seat")));
    let top = run
        .assembly
        .of_kind(PartKind::Barrel)
        .filter(|body| parts[*body].level == Some(run.assembly.levels));
    for body in top {
        if let Some(fell) = run.fates.fate(body).fell_at {
            panels.push((fell, format!("{} has fallen", named(run, body))));
        }
    }
    let last = panels.iter().map(|(time, _)| *time).fold(0.0, f64::max);
    panels.push((last + 0.5, "0.5 s later".into()));
    panels.retain(|(time, _)| *time >= 0.0 && *time <= run.end_time);
    panels.sort_by(|one, other| one.0.total_cmp(&other.0));
    panels
}

/// Returns the number of barrels per level.
fn columns(run: &Run) -> u32 {
    run.scenario.stack().map_or(2, |stack| stack.columns)
}

/// Returns a label with the paper's number and our name of a body, such as "3 = R1"; only the name for a body without a
/// number.
fn named(run: &Run, body: usize) -> String {
    let name = &run.assembly.parts[body].name;
    match numbering::number(name, columns(run)) {
        Some(number) => format!("{number} = {name}"),
        None => name.clone(),
    }
}

/// Distance between the end of an arrow and the center of a barrel, divided by the radius of the
/// barrel. At this distance, the arrow does not cover the body number.
const ARROW_END: f64 = 0.5;

/// Heights (m) of the start and the end of an arrow from a rack to the ground. The rack is too flat for an
/// arrow, so the arrow is drawn below each barrel on the rack.
const GROUND_ARROW: [f64; 2] = [0.07, -0.05];

/// Draws the stack at rest with the paper's body numbers. As in the paper, an arrow points from each contact body,
/// which has the contact nodes, to the target body, which has the contact surface.
pub(super) fn contact_bodies(run: &Run, id: &str, caption: &str) -> Block {
    let assembly = &run.assembly;
    let parts = &assembly.parts;
    let columns = columns(run);
    let rest: Vec<Point> = run
        .recording
        .frames
        .poses
        .first()
        .map(|poses| poses.iter().map(|[x, z, _]| [*x, *z]).collect())
        .unwrap_or_default();
    let mut arrows = Vec::new();
    for (contactor, target, _) in designed_pairs(run) {
        let meaning = format!("{} on {}", parts[contactor].name, parts[target].name);
        let ends = if target == Assembly::GROUND {
            let barrels = assembly.of_kind(PartKind::Barrel);
            let above = barrels.filter(|body| parts[*body].carrier == Some(contactor));
            above.map(|body| GROUND_ARROW.map(|z| [rest[body][0], z])).collect()
        } else {
            vec![arrow(parts, &rest, contactor, target)]
        };
        arrows.extend(ends.into_iter().map(|[from, to]| Arrow {
            from,
            to,
            meaning: meaning.clone(),
        }));
    }
    let labels = parts.iter().enumerate().filter_map(|(at, part)| {
        let number = numbering::number(&part.name, columns)?;
        let lift = if part.kind == PartKind::Rack { 0.09 } else { 0.0 };
        let aside = if part.kind == PartKind::Rack && columns == 1 { 0.14 } else { 0.0 };
        Some(([rest[at][0] + aside, rest[at][1] + lift], number.to_string()))
    });
    let diagram = Diagram { scene: scene(run), time: 0.0, labels: labels.collect(), arrows };
    Block::Figure(Figure::new(id, caption, diagram))
}

/// Returns a vertical arrow from a rack into the barrel that it touches, or from the barrel into the rack.
fn arrow(
    parts: &[barrelstack::assemble::Part],
    rest: &[Point],
    from: usize,
    to: usize,
) -> [Point; 2] {
    let end = |body: usize, other: usize| {
        let [x, z] = rest[body];
        if parts[body].kind == PartKind::Barrel {
            [x, z + ARROW_END * parts[body].size * (rest[other][1] - z).signum()]
        } else {
            [rest[other][0], z]
        }
    };
    [end(from, to), end(to, from)]
}

/// Plots the horizontal displacement of the paper's bodies 1, 4 and 7, relative to the ground.
pub(super) fn histories(run: &Run, id: &str, caption: &str) -> Block {
    let recording = &run.recording;
    let columns = columns(run);
    let series: Vec<Series> = [1, 4, 7]
        .into_iter()
        .filter_map(|number| {
            let name = numbering::name(number, columns);
            let channel = recording.displacement(&name)?;
            let values = channel.values.iter().map(|v| 100.0 * v).collect();
            let label = format!("barrel {number} ({name})");
            Some(Series::new(label, recording.times.clone(), values))
        })
        .collect();
    let range = standing_range(run, &series);
    let times = [
        (run.fates.collapse_time(), "loss of a seat"),
        (peak_velocity_time(run), "peak ground velocity"),
    ];
    let mark = |(at, label): (Option<f64>, &str)| Some(Mark { at: at?, label: label.into() });
    let y = Axis { range, ..Axis::new("displacement", "cm") };
    let plot = Plot::over_time(y, series, times.into_iter().filter_map(mark).collect());
    Block::Figure(Figure::new(id, caption, plot))
}

/// Returns the time (s) of peak ground velocity; `None` if the ground velocity was not recorded.
pub(super) fn peak_velocity_time(run: &Run) -> Option<f64> {
    let velocity = &run.recording.channel("ground velocity x")?.values;
    let fastest = velocity.iter().zip(&run.recording.times);
    fastest.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).map(|(_, time)| *time)
}

/// Plots the normal stress along the boundary of the body that has the given `number` in the paper: the stress at rest,
/// and the largest stress at each point until the first loss of a seat. `None` if the run has no such barrel or rack.
pub(super) fn envelope(run: &Run, number: u32, id: &str, caption: &str) -> Option<Block> {
    let name = numbering::name(number, run.scenario.stack()?.columns);
    let body = run.assembly.parts.iter().position(|part| part.name == name)?;
    let figure = stress_figure(run, run.stresses.of(body)?);
    Some(Block::Figure(Figure { id: id.to_owned(), caption: caption.to_owned(), ..figure }))
}

/// Returns the displacement (m) along `x` of a body relative to the ground at the time of its fall; `None` if the body
/// did not fall.
pub(super) fn place_at_fall(run: &Run, name: &str) -> Option<f64> {
    let body = run.assembly.parts.iter().position(|part| part.name == name)?;
    let fell = run.fates.fate(body).fell_at?;
    let (times, channel) = (&run.recording.times, run.recording.displacement(name)?);
    let at = times.iter().position(|time| *time >= fell).or(times.len().checked_sub(1))?;
    channel.values.get(at).copied()
}

/// Returns two lengths (m) along the boundary of the upper or lower half of a barrel: the length that is loaded at
/// rest, and the length that is loaded at any time until the first loss of a seat. `None` if the run has no such
/// barrel.
pub(super) fn footprint(run: &Run, name: &str, upper: bool) -> Option<[f64; 2]> {
    let body = run.assembly.parts.iter().position(|part| part.name == name)?;
    let envelope = run.stresses.of(body)?;
    let mut lengths = [0.0; 2];
    for (at, point) in envelope.points.iter().enumerate() {
        if (point.normal.z > 0.0) == upper {
            for (length, stress) in lengths.iter_mut().zip([&envelope.at_rest, &envelope.peak]) {
                if stress[at] > 0.0 {
                    *length += envelope.lengths[at];
                }
            }
        }
    }
    Some(lengths)
}

/// Builds a collapsible table of all pairs of bodies that touch by design. It states which body of a pair has the
/// contact nodes (contact body) and which has the contact surface (target body).
pub(super) fn pairs(run: &Run, caption: &str) -> Block {
    let table = Table::of(
        caption,
        designed_pairs(run),
        &[
            ("contact body, with the nodes", "", &|(contactor, ..)| {
                Cell::text(named(run, *contactor))
            }),
            ("target body, with the surface", "", &|(_, target, _)| {
                Cell::text(named(run, *target))
            }),
            ("the contact body is", "", &|(contactor, target, _)| {
                Cell::text(if is_above(run, *contactor, *target) { "above" } else { "below" })
            }),
            ("force at rest", "kN", &|(.., at_rest)| Cell::Number(1e-3 * at_rest, 3)),
        ],
    );
    let summary = "The pairs as a table, with the forces at rest";
    Block::details_on_screen(summary, vec![Block::Table(table)])
}

/// Returns, for each pair of bodies that touch by design, the contact body, the target body, and the force at rest (N).
fn designed_pairs(run: &Run) -> impl Iterator<Item = (usize, usize, f64)> {
    let joints = run.recording.joints.iter().map(|history| &history.joint);
    joints.filter(|joint| joint.by_design).filter_map(|joint| {
        let pair = run.assembly.model.pairs().find(|pair| {
            let between = [pair.contactor, pair.target];
            between == [joint.upper, joint.lower] || between == [joint.lower, joint.upper]
        })?;
        Some((pair.contactor, pair.target, joint.at_rest))
    })
}

/// Returns `true` if the body `one` rests on the body `other`.
fn is_above(run: &Run, one: usize, other: usize) -> bool {
    run.recording
        .joints
        .iter()
        .any(|JointForces { joint, .. }| [joint.upper, joint.lower] == [one, other])
}

/// Returns `true` if, in every pair of bodies that touch by design, the contact body (the one with the contact nodes)
/// is a rack.
pub(super) fn racks_carry_the_nodes(run: &Run) -> bool {
    let parts = &run.assembly.parts;
    designed_pairs(run).all(|(contactor, _, _)| parts[contactor].kind == PartKind::Rack)
}

/// Returns the largest distance (m at full scale) between a body at full scale and the same body at
/// half scale. The two runs are compared at equivalent instants up to `until` (s at full scale).
pub(super) fn scale_difference(full: &Run, half: &Run, until: f64) -> f64 {
    let length = half.scenario.run.similitude;
    let (a, b) = (&full.recording.frames, &half.recording.frames);
    let frames = a.times.iter().zip(a.poses.iter().zip(&b.poses));
    let mut largest = 0.0_f64;
    for (_, (one, other)) in frames.take_while(|(time, _)| **time <= until) {
        for (p, q) in one.iter().zip(other) {
            let [dx, dz] = [p[0] - q[0] / length, p[1] - q[1] / length];
            largest = largest.max(libm::hypot(dx, dz));
        }
    }
    largest
}
