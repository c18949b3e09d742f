//! Sections of the report of a run, in reading order.

use std::sync::Arc;

use barrelstack_report::{
    Axis, Block, BoundarySample, Cell, Envelope, Figure, Mark, Player, Plot, Scene, Series,
    SeriesStyle, Strip, Table, Trace, capital, significant,
};

use super::inputs::{inputs, not_modeled};
use super::tables::{demand_table, device_table, interface_table};
use super::trust::trust;
use super::unknowns::unknowns;
use super::{drawing, planes, spectrum};
use crate::assemble::PartKind;
use crate::ensemble::RATE;
use crate::run::Run;
use crate::scenario::View;
use crate::summary::{EnergyBalance, Summary};
use crate::variants::{Range, Shown, Spread, Variants};
use crate::watch::{BoundaryPoint, StressEnvelope};

/// Builds all sections.
pub(super) fn all(
    run: &Run,
    summary: &Summary,
    (variants, other): (Option<&Variants>, Option<&Shown>),
    scene: &Arc<Scene>,
) -> Vec<Block> {
    let mut blocks = vec![stage(run, summary, other, scene)];
    let spreads = summary.spreads();
    let worst = spreads.iter().filter_map(|(_, spread)| spread.share).reduce(f64::max);
    let remedy = summary.remedy.iter().flat_map(|found| found.blocks(worst, true)).collect();
    section(&mut blocks, 2, "What would have kept the stack up", remedy);
    let placed: Vec<(&str, &Spread)> =
        spreads.iter().map(|(view, spread)| (view.words(), *spread)).collect();
    section(&mut blocks, 2, "What decides the outcome", unknowns(&placed));
    section(&mut blocks, 2, "Results of all variants", planes::variants(summary));
    section(&mut blocks, 2, "Collapse sequence", sequence(run, scene));
    let trusted = summary.verification.as_ref().map(trust).unwrap_or_default();
    section(&mut blocks, 2, "How far to trust this run", trusted);
    section(&mut blocks, 2, "For the engineer", for_engineers((run, summary, variants), other));
    blocks
}

/// Builds the section for engineers: the results of each plane, and the inputs that both planes share. Its parts are
/// hidden until the reader expands them.
fn for_engineers(own: (&Run, &Summary, Option<&Variants>), other: Option<&Shown>) -> Vec<Block> {
    const PARTS: &str = "odies, demands, line loads, forces, motion, energies";
    let Some(other) = other else {
        let blocks = engineering(own).into_iter().chain(given(own.0)).collect();
        return vec![Block::details(format!("B{PARTS}, inputs and limits"), blocks)];
    };
    let of = |plane: (&Run, &Summary, Option<&Variants>), mark: &str| {
        let view = plane.0.assembly.view.map_or("", View::words);
        let mut blocks = engineering(plane);
        for block in &mut blocks {
            let inner = if let Block::OnScreen { blocks, .. } = block {
                blocks.as_mut_slice()
            } else {
                std::slice::from_mut(block)
            };
            for block in inner {
                if let Block::Figure(figure) = block {
                    figure.id += mark;
                }
            }
        }
        Block::details(format!("{}: b{PARTS}", capital(view)), blocks)
    };
    let mark = other.run.assembly.view.map_or_else(String::new, |view| format!("-{}", view.name()));
    vec![
        of(own, ""),
        of((&other.run, &other.summary, other.variants.as_ref()), &mark),
        Block::details("Inputs and limits", given(own.0)),
    ]
}

/// Returns the player of one plane, or the players of both planes side by side.
pub(super) fn stage(
    run: &Run,
    summary: &Summary,
    other: Option<&Shown>,
    scene: &Arc<Scene>,
) -> Block {
    match other {
        None => Block::Player(player(run, scene)),
        Some(other) => Block::Players(planes::players((run, summary, scene), other)),
    }
}

/// Builds the sections for engineers for one plane.
fn engineering((run, summary, variants): (&Run, &Summary, Option<&Variants>)) -> Vec<Block> {
    let mut blocks = Vec::new();
    section(&mut blocks, 3, "Outcome of every body", vec![Block::Table(fates(summary))]);
    on_screen(&mut blocks, "Displacements", displacements(run, variants));
    let table = demand_table(&summary.demands, &summary.demands_whole_run);
    let shown = if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] };
    section(&mut blocks, 3, "Demands", shown);
    on_screen(&mut blocks, "Line loads on barrels and racks", stresses(run));
    on_screen(&mut blocks, "Forces between bodies", forces(run, summary));
    for one in &summary.devices.0 {
        section(&mut blocks, 3, &capital(one.words.many), device_table(one));
    }
    section(&mut blocks, 3, "Ground motion", motion(run));
    section(&mut blocks, 3, "Energy balance", energy(run, summary));
    blocks
}

fn given(run: &Run) -> Vec<Block> {
    let mut blocks = Vec::new();
    section(&mut blocks, 3, "Inputs", inputs(&run.stated));
    if run.assembly.levels > 0 {
        section(&mut blocks, 3, "What is not modeled", vec![not_modeled(false)]);
    }
    blocks
}

fn section(blocks: &mut Vec<Block>, level: u8, title: &str, content: Vec<Block>) {
    if !content.is_empty() {
        blocks.push(Block::heading(level, title));
        blocks.extend(content);
    }
}

/// Appends a section with a heading of level 3; the printed report omits the section.
fn on_screen(blocks: &mut Vec<Block>, title: &str, content: Vec<Block>) {
    let mut own = Vec::new();
    section(&mut own, 3, title, content);
    if !own.is_empty() {
        blocks.push(Block::on_screen(title, own));
    }
}

/// Returns the player of a run, which shows the given scene of this run.
pub fn player(run: &Run, scene: &Arc<Scene>) -> Player {
    Player {
        id: "player".into(),
        caption: format!(
            "The computed motion of the run, to scale. Arrows show contact forces, each drawn on the body that the \
             force pushes up.{}",
            drawing::legend(scene)
        ),
        scene: Arc::clone(scene),
        traces: traces(run),
    }
}

/// Returns the traces of the centers of the barrels in the top level.
pub(crate) fn traces(run: &Run) -> Vec<Trace> {
    let parts = &run.assembly.parts;
    run.assembly
        .of_kind(PartKind::Barrel)
        .filter(|body| parts[*body].level == Some(run.assembly.levels))
        .map(|body| Trace {
            body,
            point: [0.0, 0.0],
            label: format!("center of {}", parts[body].name),
        })
        .collect()
}

fn sequence(run: &Run, scene: &Arc<Scene>) -> Vec<Block> {
    if run.assembly.levels == 0 {
        return Vec::new();
    }
    let strip = Strip::of_run(Arc::clone(scene), 6);
    vec![Block::Figure(Figure::new("sequence", "The stack at the decisive moments.", strip))]
}

fn fates(summary: &Summary) -> Table {
    Table::of(
        "The largest slip is the largest displacement of the body relative to its support while the stack stood. The \
         displacement at the end is relative to the ground, from the position at rest.",
        &summary.bodies,
        &[
            ("body", "", &|body| Cell::text(&body.name)),
            ("left its seat", "s", &|body| Cell::measured(body.left_seat_at, 2)),
            ("fell", "s", &|body| Cell::measured(body.fell_at, 2)),
            ("fall height", "m", &|body| Cell::measured(body.fall_height, 2)),
            ("largest slip", "cm", &|body| Cell::Measured(100.0 * body.peak_slip, 1)),
            ("at the end", "cm", &|body| Cell::Measured(100.0 * body.residual_displacement, 1)),
        ],
    )
}

/// Plots histories over time, with the collapse marked.
fn history(run: &Run, id: &str, caption: &str, y: Axis, series: Vec<Series>) -> Block {
    let mark = run.fates.collapse_time().map(|at| Mark { at, label: "gives way".into() });
    let plot = Plot::over_time(y, series, mark.into_iter().collect());
    Block::Figure(Figure::new(id, caption, Plot { timeline: true, ..plot }))
}

/// Returns the range of values to plot: it contains zero and all values up to half a second after the collapse, with a
/// margin at both ends. Returns `None` if there is no collapse, or if all values up to that time are zero; a plot with
/// the range `None` shows all values.
///
/// In a plot over this range, falling bodies leave the plot, as in the histories of Candia, de la Llera and Almazán
/// (2008).
pub fn standing_range(run: &Run, series: &[Series]) -> Option<[f64; 2]> {
    standing_until(run.fates.collapse_time()?, series)
}

/// Works like [`standing_range`], for a stack that collapses at the time `collapse` (s).
pub(crate) fn standing_until(collapse: f64, series: &[Series]) -> Option<[f64; 2]> {
    let until = collapse + 0.5;
    let mut range = [0.0_f64; 2];
    for one in series {
        for (_, value) in one.x.iter().zip(&one.y).filter(|(time, _)| **time <= until) {
            range = [range[0].min(*value), range[1].max(*value)];
        }
    }
    let pad = 0.15 * (range[1] - range[0]);
    (pad > 0.0).then_some([range[0] - pad, range[1] + pad])
}

fn displacements(run: &Run, variants: Option<&Variants>) -> Vec<Block> {
    let recording = &run.recording;
    let mut series = Vec::new();
    let stack = run.assembly.levels > 0;
    for part in &run.assembly.parts {
        // For a stack, plot the left column as the paper does: barrels 1, 4 and 7.
        let shown = if stack {
            part.kind == PartKind::Barrel && part.column == Some(1)
        } else {
            part.kind == PartKind::Body
        };
        if let (true, Some(channel)) = (shown, recording.displacement(&part.name)) {
            let values = channel.values.iter().map(|v| 100.0 * v).collect();
            series.push(Series::new(&part.name, recording.times.clone(), values));
        }
    }
    if series.is_empty() {
        return Vec::new();
    }
    let range = standing_range(run, &series);
    let band = variants.map(|variants| band(run, variants)).unwrap_or_default();
    let mut caption = "Horizontal displacement relative to the ground.".to_owned();
    if !band.is_empty() {
        caption += " At every time, the displacements in 90 % of all variants lie between the thin lines; after \
                    the end of a variant, its last displacement is used.";
    }
    series.extend(band);
    let axis = Axis { range, ..Axis::new("displacement", "cm") };
    vec![history(run, "displacements", &caption, axis, series)]
}

/// Returns histories of the 5 % and 95 % fractiles, over the variants, of the horizontal displacement (cm) of the
/// first barrel of the top level; empty if fewer than two variants have a recorded path of this barrel.
///
/// After the end of a variant, its last displacement is used.
fn band(run: &Run, variants: &Variants) -> Vec<Series> {
    let trails = variants.results.iter().skip(1).map(|result| &result.trail);
    let paths: Vec<&[[f32; 2]]> =
        trails.filter_map(|trail| trail.paths.first()).map(Vec::as_slice).collect();
    let name = variants.results.iter().find_map(|result| result.trail.top.first());
    let (Some(name), true) = (name.map(|body| &run.assembly.parts[*body].name), paths.len() > 1)
    else {
        return Vec::new();
    };
    let longest = paths.iter().map(|path| path.len()).max().unwrap_or(0);
    // The histories of the shown run end with that run.
    let recorded = |at: &usize| *at as f64 <= RATE * run.end_time;
    let count = (0..longest).take_while(recorded).count();
    let displacement = |path: &&[[f32; 2]], at: usize| {
        let now = path.get(at).or(path.last())?;
        // Rounded to a tenth of a millimeter, which keeps the page small.
        Some((1e4 * f64::from(now[0] - path.first()?[0])).round() / 100.0)
    };
    let times: Vec<f64> = (0..count).map(|at| at as f64 / RATE).collect();
    let ranges: Vec<Option<Range>> = (0..count)
        .map(|at| Range::of(paths.iter().filter_map(|path| displacement(path, at))))
        .collect();
    let line = |percent: u32, value: fn(&Range) -> f64| {
        let values = ranges.iter().map(|range| range.as_ref().map_or(f64::NAN, value)).collect();
        let label = format!("{name}: {percent} % of all variants are below this line");
        let mut series = Series::new(label, times.clone(), values);
        series.style.muted = true;
        series
    };
    vec![line(5, |range| range.p05), line(95, |range| range.p95)]
}

fn stresses(run: &Run) -> Vec<Block> {
    let mut blocks = Vec::new();
    for envelope in &run.stresses.envelopes {
        let part = &run.assembly.parts[envelope.body];
        let first = part.column == Some(1);
        let shown = part.level == Some(1) || part.level == Some(run.assembly.levels);
        if first && shown && envelope.amplification().is_some() {
            blocks.push(Block::Figure(stress_figure(run, envelope)));
        }
    }
    if !blocks.is_empty() {
        blocks.insert(
            0,
            Block::Paragraph(
                "The line load is the normal force at a contact per meter of boundary, in the plane of the model; it \
                 is drawn outward from the point at which it acts. It is the force divided by the length of boundary \
                 on which a contact is assumed to bear: at a node, half of the distance to each neighboring node; at \
                 a contact without nodes, 1 cm at full scale. The gray area shows the line load at rest. The area \
                 behind the gray area shows the largest line load until the first loss of a seat."
                    .into(),
            ),
        );
    }
    blocks
}

/// Plots the normal stress along the boundary of a body, at rest and at its maximum.
pub fn stress_figure(run: &Run, envelope: &StressEnvelope) -> Figure {
    let name = &run.assembly.parts[envelope.body].name;
    let mut samples = Vec::new();
    let (mut at_rest, mut peak) = (Vec::new(), Vec::new());
    let mut push = |point: &BoundaryPoint, shift: f64, rest: f64, most: f64| {
        samples.push(BoundarySample {
            x: point.position.x + shift,
            z: point.position.z,
            nx: point.normal.x,
            nz: point.normal.z,
            coordinate: point.coordinate + if envelope.closed { 0.0 } else { shift },
        });
        at_rest.push(1e-3 * rest);
        peak.push(1e-3 * most);
    };
    if envelope.is_on_nodes() {
        // Every node of a rack is drawn as a block as wide as its tributary length; nodes that were
        // never in contact are left out, and a gap separates the blocks.
        let mut order: Vec<usize> =
            (0..envelope.points.len()).filter(|i| envelope.peak[*i] > 0.0).collect();
        order.sort_by(|a, b| {
            let (p, q) = (&envelope.points[*a], &envelope.points[*b]);
            p.normal.z.total_cmp(&q.normal.z).then(p.position.x.total_cmp(&q.position.x))
        });
        for i in order {
            let (point, half) = (&envelope.points[i], 0.5 * envelope.lengths[i]);
            push(point, -half, envelope.at_rest[i], envelope.peak[i]);
            push(point, half, envelope.at_rest[i], envelope.peak[i]);
            push(point, half, f64::NAN, f64::NAN);
        }
    } else {
        for (i, point) in envelope.points.iter().enumerate() {
            push(point, 0.0, envelope.at_rest[i], envelope.peak[i]);
        }
    }
    let (coordinate, unit) = if envelope.closed { ("angle", "rad") } else { ("x", "m") };
    let picture = Envelope {
        outline: drawing::outlines(&run.assembly, envelope.body),
        samples,
        closed: envelope.closed,
        static_stress: at_rest,
        dynamic_stress: peak,
        unit: "kN/m".into(),
        amplification: envelope.amplification(),
        coordinate: (coordinate.into(), unit.into()),
    };
    let caption = format!(
        "Line load (normal force per meter of boundary) on {name}: at rest, and its largest value until the first loss \
         of a seat."
    );
    Figure::new(format!("stress-{name}"), caption, picture)
}

/// States that the model in the plane along the barrels is a slice one barrel wide, and which forces it gives. Empty
/// for all other models, and if a rack carries only one barrel.
fn slice(run: &Run) -> String {
    let barrels = run.scenario.stack().map_or(1, |stack| stack.rack.barrels);
    if run.assembly.view != Some(View::Longitudinal) || barrels == 1 {
        return String::new();
    }
    format!(
        " This plane is a slice one barrel wide: where a rack carries {barrels} barrels side by side, the forces are those \
         of one of them, with its share of the racks."
    )
}

fn forces(run: &Run, summary: &Summary) -> Vec<Block> {
    if summary.interfaces.is_empty() {
        return Vec::new();
    }
    let caption = format!(
        "Force on the upper body of each pair in the run that is shown, or on the body named first if neither body \
         rests on the other; positive up and to the right. Two forces are given: the one of largest magnitude until \
         the first loss of a seat, and the one of largest magnitude over the whole run, falls included.{}",
        slice(run)
    );
    let table = interface_table(&caption, &summary.interfaces);
    let recording = &run.recording;
    let mut blocks = Vec::new();
    if let Some(base) = recording.joints.first() {
        let kilo = |values: &[f64]| values.iter().map(|v| 1e-3 * v).collect();
        blocks.push(history(
            run,
            "base-forces",
            &format!("Force between {}.", base.name.replace(" on ", " and ")),
            Axis::new("force", "kN"),
            vec![
                Series::new("vertical", recording.times.clone(), kilo(&base.vertical)),
                Series::new("horizontal", recording.times.clone(), kilo(&base.horizontal)),
            ],
        ));
    }
    let title = "Largest forces at every interface, in the run that is shown";
    blocks.push(Block::details(title, vec![Block::Table(table)]));
    blocks
}

fn motion(run: &Run) -> Vec<Block> {
    let Some(motion) = &run.ground.motion else { return Vec::new() };
    let vertical = motion.vertical.as_ref().map(|vertical| ("vertical", vertical));
    let line = |(label, component)| {
        let drawn = drawing::ground_acceleration(label, component, run.end_time);
        Series::new(label, drawn.times, drawn.values)
    };
    let series = std::iter::once(("horizontal", &motion.horizontal)).chain(vertical);
    let series = series.map(line).collect();
    let mut blocks = Vec::new();
    blocks.push(history(
        run,
        "ground-acceleration",
        "Acceleration of the ground.",
        Axis::new("acceleration", "g"),
        series,
    ));
    blocks.extend(spectrum::figures(run, motion));
    blocks
}

/// States the residual of the energy balance of a run, and the energy exchanged.
pub fn balanced(balance: &EnergyBalance) -> String {
    format!(
        "The energy supplied by the ground, by external forces and by gravity equals the energy stored and \
         dissipated, except for a residual of {} times the {} kJ exchanged. The energy exchanged is the work of the \
         ground and of external forces in every step, added up without its sign, plus the energy available at the \
         start, which is the kinetic energy, the energy of springs, and the potential energy above its lowest value \
         in the run.",
        significant(balance.residual_ratio, 2),
        significant(1e-3 * balance.input, 3)
    )
}

/// Plots the energies that change during a run, and the sum of the stored and dissipated energies,
/// which must equal the work of the ground.
fn energy(run: &Run, summary: &Summary) -> Vec<Block> {
    let recording = &run.recording;
    let Some(balance) = &summary.energy else { return Vec::new() };
    // Each energy is plotted as its increase since the start, in kJ.
    let gained = |names: &[&str]| -> Vec<f64> {
        let channels: Vec<&[f64]> = names
            .iter()
            .filter_map(|name| recording.channel(&format!("energy {name}")))
            .map(|channel| channel.values.as_slice())
            .collect();
        let sum = |at: usize| channels.iter().map(|values| values[at] - values[0]).sum::<f64>();
        (0..recording.times.len()).map(|at| 1e-3 * sum(at)).collect()
    };
    let line = |label: &str, names: &[&str], style: SeriesStyle| Series {
        style,
        ..Series::new(label, recording.times.clone(), gained(names))
    };
    let color = |index: usize| SeriesStyle { index: Some(index), ..SeriesStyle::default() };
    let parts: [(&str, &[&str], usize); 5] = [
        ("kinetic", &["kinetic"], 0),
        ("potential", &["potential"], 1),
        ("stored in contacts and devices", &["elastic", "stick"], 3),
        ("lost to friction", &["friction"], 2),
        ("lost to damping", &["damped", "viscous"], 5),
    ];
    // The work of the ground is an area behind all other curves, and their sum should follow its
    // edge.
    let ground = SeriesStyle { area: true, ..color(4) };
    let mut series = vec![line("work of the ground", &["ground work"], ground)];
    series.extend(parts.iter().map(|(label, names, index)| line(label, names, color(*index))));
    let all: Vec<&str> = parts.iter().flat_map(|(_, names, _)| names.iter().copied()).collect();
    series.push(line("sum of stored and dissipated energy", &all, color(10)));
    vec![
        Block::Paragraph(balanced(balance)),
        history(
            run,
            "energy",
            "Change of energy since the start. The shaded area shows the work of the ground; the balance holds where \
             the sum of stored and dissipated energy follows the edge of this area. A falling body converts potential \
             energy to kinetic energy, which friction and damping dissipate.",
            Axis::new("energy", "kJ"),
            series,
        ),
    ]
}
