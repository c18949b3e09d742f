//! The paper's figures, drawn from our runs.

use std::sync::Arc;

use barrelstack_report::{
    Axis, Block, Cell, Figure, FigureKind, Mark, Panel, Player, Plot, Scene, Series, Strip, Table,
};

use super::numbering;
use crate::assemble::PartKind;
use crate::report::{scene, standing_range, stress_figure};
use crate::run::Run;

/// The scene of a run, to be shared by its pictures.
pub(super) fn scene_of(run: &Run) -> Arc<Scene> {
    scene(run)
}

/// A run to watch.
pub(super) fn player(scene: &Arc<Scene>, id: &str, caption: &str) -> Block {
    Block::Player(Player {
        id: id.to_owned(),
        caption: caption.to_owned(),
        scene: Arc::clone(scene),
        traces: Vec::new(),
    })
}

/// A sequence at chosen instants.
pub(super) fn strip(
    scene: &Arc<Scene>,
    id: &str,
    caption: &str,
    panels: impl IntoIterator<Item = (f64, String)>,
) -> Block {
    let panels = panels.into_iter().map(|(time, note)| Panel { time, note }).collect();
    Block::Figure(Figure {
        id: id.to_owned(),
        caption: caption.to_owned(),
        kind: FigureKind::Strip(Strip { scene: Arc::clone(scene), panels }),
    })
}

/// The moments of a collapse: at rest, before, the loss of seat, and how it goes on.
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

/// Histories of the horizontal displacement of the paper's bodies 1, 4 and 7, relative to the ground.
pub(super) fn histories(run: &Run, id: &str, caption: &str) -> Block {
    let recording = &run.recording;
    let columns = run.scenario.stack().map_or(2, |stack| stack.columns);
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
    let mut marks: Vec<Mark> = run
        .fates
        .collapse_time()
        .map(|at| Mark { at, label: "loss of seat".into() })
        .into_iter()
        .collect();
    if let Some(at) = peak_velocity_time(run) {
        marks.push(Mark { at, label: "peak ground velocity".into() });
    }
    Block::Figure(Figure {
        id: id.to_owned(),
        caption: caption.to_owned(),
        kind: FigureKind::Plot(Plot {
            x: Axis::new("time", "s"),
            y: Axis { range, ..Axis::new("displacement", "cm") },
            series,
            marks,
            interactive: true,
            ..Plot::default()
        }),
    })
}

/// When (s) the ground is fastest.
pub(super) fn peak_velocity_time(run: &Run) -> Option<f64> {
    let velocity = &run.recording.channel("ground velocity x")?.values;
    let fastest = velocity.iter().zip(&run.recording.times);
    fastest.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).map(|(_, time)| *time)
}

/// The stress around one of the paper's bodies.
pub(super) fn envelope(run: &Run, number: u32, id: &str, caption: &str) -> Option<Block> {
    let name = numbering::name(number, run.scenario.stack()?.columns);
    let body = run.assembly.parts.iter().position(|part| part.name == name)?;
    let figure = stress_figure(run, run.stresses.of(body)?);
    Some(Block::Figure(Figure { id: id.to_owned(), caption: caption.to_owned(), ..figure }))
}

/// Length of boundary (m) under stress at rest and at any time while the stack stood, on the upper or
/// the lower half of a barrel.
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

/// Which body carries nodes against which, for all bodies that lean on each other by design.
pub(super) fn pairs(run: &Run, caption: &str) -> Table {
    let parts = &run.assembly.parts;
    let columns = run.scenario.stack().map_or(2, |stack| stack.columns);
    let mut table = Table::new(
        caption,
        &[
            ("contact body, with the nodes", ""),
            ("target body, with the surface", ""),
            ("the contact body is", ""),
            ("force at rest", "kN"),
        ],
    );
    let named = |body: usize| match numbering::number(&parts[body].name, columns) {
        Some(number) => format!("{number} = {}", parts[body].name),
        None => parts[body].name.clone(),
    };
    for joint in &run.recording.joints {
        let pair = run.assembly.model.pairs().iter().find(|pair| {
            let between = [pair.contactor, pair.target];
            between == [joint.upper, joint.lower] || between == [joint.lower, joint.upper]
        });
        if let Some(pair) = pair {
            let place = if pair.contactor == joint.upper { "above" } else { "below" };
            table.rows.push(vec![
                Cell::text(named(pair.contactor)),
                Cell::text(named(pair.target)),
                Cell::text(place),
                Cell::Number(1e-3 * joint.at_rest, 3),
            ]);
        }
    }
    table
}

/// Whether every designed contact of a run is carried by nodes of a rack.
pub(super) fn racks_carry_the_nodes(run: &Run) -> bool {
    let parts = &run.assembly.parts;
    run.assembly
        .model
        .pairs()
        .iter()
        .filter(|pair| {
            run.recording.joints.iter().any(|joint| {
                let between = [pair.contactor, pair.target];
                between == [joint.upper, joint.lower] || between == [joint.lower, joint.upper]
            })
        })
        .all(|pair| parts[pair.contactor].kind == PartKind::Rack)
}

/// Largest distance (m at full scale) between two runs of one stack at two scales, at equivalent
/// instants up to a time (s at full scale).
pub(super) fn scale_difference(full: &Run, half: &Run, until: f64) -> f64 {
    let length = half.scenario.run.similitude;
    let (a, b) = (&full.recording.frames, &half.recording.frames);
    let frames = a.times.iter().zip(a.poses.iter().zip(&b.poses));
    let mut largest = 0.0_f64;
    for (_, (one, other)) in frames.take_while(|(time, _)| **time <= until) {
        for (p, q) in one.iter().zip(other) {
            let [dx, dz] = [p[0] - q[0] / length, p[1] - q[1] / length];
            largest = largest.max(dx.hypot(dz));
        }
    }
    largest
}
