//! Writes a synthetic document with every kind of block: `gallery FOLDER`.
//!
//! The motions are formulas, not dynamics; they only give the pictures content.

use std::{error::Error, f64::consts::TAU, fs, path::PathBuf, sync::Arc};

use barrelstack_report::{
    Animation, Axis, Band, Block, BoundarySample, Cell, ContactForce, Document, Dots, Envelope,
    Event, EventKind, Figure, FigureKind, Film, Frames, History, Mark, Panel, Paper, Player, Plot,
    Polyline, Role, Scene, SceneBody, Series, SeriesStyle, Strip, Table, Tone, Trace, Verdict,
    attachments, document_pdf, html, markdown,
};

const RADIUS: f64 = 0.33;
const PITCH: f64 = 0.737;
const LEVEL: f64 = 0.89;
const DURATION: f64 = 60.0;
const FALL: f64 = 14.0;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: gallery FOLDER")?);
    let figures = folder.join("figures");
    fs::create_dir_all(&figures)?;
    let document = document();
    fs::write(folder.join("report.html"), html(&document))?;
    let bundle = markdown(&document, "figures");
    fs::write(folder.join("report.md"), &bundle.text)?;
    fs::write(folder.join("report.pdf"), document_pdf(&document, Paper::A4))?;
    for block in &document.blocks {
        if let Block::Figure(figure) = block {
            fs::write(figures.join(format!("{}.png", figure.id)), figure.to_png(150.0))?;
            fs::write(figures.join(format!("{}.pdf", figure.id)), figure.to_pdf())?;
        }
        if let Block::Player(player) = block {
            let film = Film::of_run(Arc::clone(&player.scene), 5.0);
            if let Some(animation) = Animation::of(&film, 480) {
                fs::write(folder.join("film.gif"), animation.gif())?;
                fs::write(folder.join("film.png"), animation.apng())?;
            }
        }
    }
    for file in attachments(&document) {
        fs::write(figures.join(file.name), file.bytes)?;
    }
    let empty = Document { blocks: empty_blocks(), ..document };
    fs::write(folder.join("empty.html"), html(&empty))?;
    Ok(())
}

fn ground_acceleration(t: f64) -> f64 {
    let envelope = (t / 4.0).powi(2) * (2.0 - t / 3.5).exp();
    envelope * ((TAU * 1.1 * t).sin() + 0.6 * (TAU * 2.7 * t + 1.0).sin()) * 0.22
}

fn ground_displacement(t: f64) -> f64 {
    0.16 * (t / 4.0).powi(2) * (2.0 - t / 3.5).exp() * (TAU * 0.45 * t).sin()
}

fn scene() -> Scene {
    let hatch = |k: i32| {
        let x = 0.25 * f64::from(k);
        Polyline::open(vec![[x, 0.0], [x - 0.12, -0.12]])
    };
    let mut floor =
        SceneBody::new("floor", Role::Ground, vec![Polyline::rectangle([-9.0, -0.4], [9.0, 0.0])]);
    floor.marks = (-35..=35).map(hatch).collect();
    let mut bodies = vec![floor];
    let mut homes = vec![[0.0, 0.0]];
    for level in 0..4 {
        let z = LEVEL * f64::from(level);
        let beam = Polyline::rectangle([-0.72, 0.0], [0.72, 0.06]);
        let cradle = |x: f64| Polyline::closed(vec![[x - 0.05, 0.06], [x + 0.05, 0.06], [x, 0.17]]);
        let outlines = vec![beam, cradle(-0.69), cradle(0.0), cradle(0.69)];
        bodies.push(SceneBody::new(format!("R{}", level + 1), Role::Rack, outlines));
        homes.push([0.0, z]);
        for (side, column) in [(-0.5, 1), (0.5, 2)] {
            bodies.push(SceneBody::barrel(format!("B{}", 2 * level + column), RADIUS));
            homes.push([side * PITCH, z + 0.12 + RADIUS + 0.02]);
        }
    }
    let count = 3601_i32;
    let times: Vec<f64> = (0..count).map(|k| f64::from(k) * DURATION / 3600.0).collect();
    let poses = times.iter().map(|t| frame(*t, &homes)).collect();
    let forces = times.iter().map(|t| contact_forces(*t, &homes)).collect();
    let event = |time, body, kind, text: &str| Event { time, body, kind, text: text.into() };
    let events = vec![
        event(4.2, Some(2), EventKind::Slip, "rack R1 slides 4 mm on the floor"),
        event(9.05, Some(10), EventKind::Uplift, "rack R4 lifts off the barrels of level 3"),
        event(FALL, Some(12), EventKind::LossOfSeat, "barrel B8 leaves its cradle to the right"),
        event(FALL + 0.78, Some(12), EventKind::Fall, "barrel B8 hits the floor at 5.2 m/s"),
    ];
    let fine: Vec<f64> = (0..6000).map(|k| f64::from(k) * 0.01).collect();
    let history = |label: &str, unit: &str, f: fn(f64) -> f64| History {
        label: label.into(),
        unit: unit.into(),
        times: fine.clone(),
        values: fine.iter().map(|t| f(*t)).collect(),
    };
    let ground = vec![
        history("ground acceleration", "g", ground_acceleration),
        history("ground displacement", "cm", |t| 100.0 * ground_displacement(t)),
    ];
    let frames = Frames { times, poses, forces };
    Scene { bodies, frames, events, ground, ..Scene::default() }
}

fn frame(t: f64, homes: &[[f64; 2]]) -> Vec<[f64; 3]> {
    let ground = ground_displacement(t);
    let place = |(body, home): (usize, &[f64; 2])| {
        if body == 0 {
            return [ground, 0.0, 0.0];
        }
        let height = home[1];
        let sway =
            0.035 * height * (t / 5.0).powi(2) * (2.0 - t / 4.0).exp() * (TAU * 0.8 * t).sin();
        let tilt = -0.3 * sway / (1.0 + height);
        let x = ground + home[0] + 0.3 * sway - tilt * (height - 0.5);
        let barrel = body % 3 != 1;
        let spin = if barrel { -0.9 * sway } else { tilt };
        let seat = [x, height + home[0] * tilt, spin];
        let since = t - FALL;
        if body == 12 && since > 0.0 {
            let floor = RADIUS;
            let landing = ((seat_height() - floor) * 2.0 / 9.81).sqrt();
            let flown = since.min(landing);
            let rolled = (1.4 * (since - landing).max(0.0)).min(3.2);
            let x = home[0] + ground_displacement(FALL) + 0.9 * flown + rolled * 0.6;
            let z = (home[1] - 0.5 * 9.81 * flown * flown).max(floor);
            return [x, z, -2.0 * flown - rolled * 0.6 / RADIUS];
        }
        seat
    };
    homes.iter().enumerate().map(place).collect()
}

fn seat_height() -> f64 {
    3.0 * LEVEL + 0.14 + RADIUS
}

fn contact_forces(t: f64, homes: &[[f64; 2]]) -> Vec<ContactForce> {
    let poses = frame(t, homes);
    let mut list = Vec::new();
    for (body, pose) in poses.iter().enumerate().skip(1) {
        let above = f64::from(u8::try_from((poses.len() - body) / 3).unwrap_or(0));
        let beat = 1.0 + 0.8 * ground_acceleration(t) * (TAU * 4.0 * t).sin();
        let gone = body == 12 && t > FALL;
        for side in [-1.0, 1.0] {
            let size = if gone { 0.0 } else { (1300.0 * (1.0 + above) * beat).max(0.0) };
            let slope = if body % 3 == 1 { 0.0 } else { -side * 0.5 };
            let (x, z) = (pose[0] + side * 0.2, pose[1] - if body % 3 == 1 { 0.0 } else { 0.27 });
            list.push(ContactForce { x, z, fx: slope * size, fz: size });
        }
    }
    list
}

fn series(label: &str, times: &[f64], f: impl Fn(f64) -> f64) -> Series {
    Series::new(label, times.to_vec(), times.iter().map(|t| f(*t)).collect())
}

fn figure(id: &str, caption: &str, kind: FigureKind) -> Block {
    Block::Figure(Figure {
        id: id.into(),
        caption: caption.into(),
        kind,
        language: barrelstack_report::Language::English,
    })
}

fn timeline(y: Axis, series: Vec<Series>) -> Plot {
    let x = Axis { range: Some([0.0, DURATION]), ..Axis::new("time", "s") };
    Plot { x, y, series, interactive: true, timeline: true, ..Plot::default() }
}

fn histories(scene: &Scene) -> Vec<Block> {
    let times = &scene.frames.times;
    let drift = |body: usize| {
        let from = &scene.frames.poses[0][body];
        let at = |k: usize| {
            let now = &scene.frames.poses[k];
            100.0 * (now[body][0] - now[0][0] - from[0])
        };
        Series::new(&scene.bodies[body].name, times.clone(), (0..times.len()).map(at).collect())
    };
    let mut displacement = timeline(
        Axis::new("displacement to the ground", "cm"),
        vec![drift(3), drift(6), drift(9), drift(12)],
    );
    displacement.marks = vec![Mark { at: FALL, label: "B8 leaves its cradle".into() }];
    displacement.bands =
        vec![Band { from: 3.2, to: 17.5, label: "5–95 % of Arias intensity".into() }];
    let force = |phase: f64| {
        move |t: f64| 6.2 + 3.0 * ground_acceleration(t) * (TAU * 3.0 * t + phase).sin()
    };
    let mut forces = timeline(
        Axis::new("normal force", "kN"),
        vec![series("R1 on B1", times, force(0.0)), series("R1 on B2", times, force(2.0))],
    );
    forces.levels = vec![Mark { at: 6.2, label: "self-weight".into() }];
    for value in forces.series[1].y.iter_mut().skip(1200).take(160) {
        *value = f64::NAN;
    }
    let growth = |t: f64| 1.0 - (-t / 9.0).exp();
    let mut energy = timeline(
        Axis::new("energy", "kJ"),
        vec![
            series("put in by the ground", times, |t| 21.0 * growth(t)),
            series("lost to friction", times, |t| 12.0 * growth(t - 0.4).max(0.0)),
            series("lost to impacts", times, |t| 7.5 * growth(t - 0.9).max(0.0)),
            series("kinetic", times, |t| 1.2 * ground_acceleration(t).abs()),
            series("error of the balance", times, |t| 0.01 * t / DURATION),
        ],
    );
    energy.series[0].style.area = true;
    vec![
        Block::Heading { level: 2, text: "Histories".into() },
        Block::Paragraph(
            "Drag across a plot to zoom all of them; click to move the player.".into(),
        ),
        figure(
            "displacement",
            "Horizontal displacement of the right barrels of each level to the ground.",
            FigureKind::Plot(displacement),
        ),
        figure(
            "force",
            "Normal force between rack R1 and the barrels of level 1. The gap is lost contact.",
            FigureKind::Plot(forces),
        ),
        figure(
            "energy",
            "Energy balance: what the ground put in and where it went.",
            FigureKind::Plot(energy),
        ),
    ]
}

fn spectrum() -> Block {
    let periods: Vec<f64> = (0..200).map(|k| 0.02 * 10_f64.powf(f64::from(k) / 80.0)).collect();
    let sa = |scale: f64| {
        move |t: f64| scale * (0.35 + 1.5 * (t / 0.4).powi(2) / (1.0 + (t / 0.4).powf(3.4)))
    };
    let mut list: Vec<Series> = (0..6)
        .map(|k| {
            let f = f64::from(k);
            series("", &periods, move |t| {
                sa(0.5 + 0.2 * f)(t) * (1.0 + 0.15 * (9.0 * t.ln() + f).sin())
            })
        })
        .collect();
    for single in &mut list {
        single.style = SeriesStyle { muted: true, ..SeriesStyle::default() };
    }
    list.push(series("this motion", &periods, sa(1.0)));
    list.push(series("target", &periods, sa(0.86)));
    list[6].style.index = Some(0);
    list[7].style.index = Some(1);
    let plot = Plot {
        x: Axis::new("period", "s").log(),
        y: Axis::new("spectral acceleration", "g").log(),
        series: list,
        marks: vec![Mark { at: 0.82, label: "stack".into() }],
        interactive: true,
        ..Plot::default()
    };
    figure(
        "spectrum",
        "Response spectrum, 5 % damping, with single motions in gray.",
        FigureKind::Plot(plot),
    )
}

fn loop_and_dots() -> Vec<Block> {
    let steps: Vec<f64> = (0..2000).map(|k| f64::from(k) * 0.01).collect();
    let hysteresis = Plot {
        x: Axis::new("slip", "mm"),
        y: Axis::new("friction force", "kN"),
        series: vec![Series::new(
            "R1 on the floor",
            steps.iter().map(|t| 4.0 * (1.0 - (-t / 6.0).exp()) * (TAU * 0.5 * t).sin()).collect(),
            steps.iter().map(|t| 2.4 * (TAU * 0.5 * t + 0.8).sin().clamp(-0.7, 0.7)).collect(),
        )],
        ..Plot::default()
    };
    let levels = vec![0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
    let mut measured =
        Series::new("runs that fell", levels, vec![0.0, 0.02, 0.15, 0.48, 0.8, 0.96]);
    measured.style.dots = true;
    let fragility = Plot {
        x: Axis::new("peak ground acceleration", "g"),
        y: Axis { range: Some([0.0, 1.0]), ..Axis::new("probability of collapse", "") },
        series: vec![measured],
        interactive: true,
        ..Plot::default()
    };
    vec![
        figure("loop", "Friction force over slip.", FigureKind::Plot(hysteresis)),
        figure("fragility", "Share of runs that collapse.", FigureKind::Plot(fragility)),
    ]
}

fn envelopes() -> Vec<Block> {
    let count = 240;
    let bump = |angle: f64, center: f64, width: f64| {
        let away = (angle - center + TAU * 1.5).rem_euclid(TAU) - TAU * 0.5;
        (1.0 - (away / width).powi(2)).max(0.0).sqrt()
    };
    let mut barrel = Envelope {
        outline: vec![Polyline::circle(RADIUS, 96)],
        closed: true,
        unit: "kPa".into(),
        amplification: Some(2.9),
        coordinate: ("angle".into(), "rad".into()),
        ..Envelope::default()
    };
    for k in 0..count {
        let angle = TAU * f64::from(k) / f64::from(count);
        let (nz, nx) = angle.sin_cos();
        barrel.samples.push(BoundarySample {
            x: RADIUS * nx,
            z: RADIUS * nz,
            nx,
            nz,
            coordinate: angle,
        });
        let seats = bump(angle, TAU * 0.68, 0.10) + bump(angle, TAU * 0.82, 0.10);
        let top = bump(angle, TAU * 0.25, 0.12);
        barrel.static_stress.push(42.0 * seats + 55.0 * top);
        let wide = bump(angle, TAU * 0.25, 0.34);
        let wide_seats = bump(angle, TAU * 0.68, 0.12) + bump(angle, TAU * 0.82, 0.12);
        barrel.dynamic_stress.push(122.0 * wide_seats + 148.0 * wide);
    }
    let mut rack = Envelope {
        outline: vec![Polyline::rectangle([-0.72, 0.0], [0.72, 0.06])],
        unit: "kPa".into(),
        amplification: Some(2.6),
        coordinate: ("position".into(), "m".into()),
        ..Envelope::default()
    };
    for k in 0..=160 {
        let x = -0.72 + 0.009 * f64::from(k);
        let near = |center: f64, width: f64| (1.0 - ((x - center) / width).powi(2)).max(0.0);
        rack.samples.push(BoundarySample { x, z: 0.06, nx: 0.0, nz: 1.0, coordinate: x });
        rack.static_stress.push(30.0 * (near(-0.37, 0.05) + near(0.37, 0.05)));
        rack.dynamic_stress.push(80.0 * (near(-0.39, 0.11) + near(0.36, 0.09)));
    }
    vec![
        Block::Heading { level: 2, text: "Contact stress".into() },
        figure(
            "envelope-b1",
            "Normal contact stress on barrel B1: self-weight and the largest value at each point during shaking.",
            FigureKind::Envelope(barrel),
        ),
        figure(
            "envelope-r2",
            "Normal contact stress along the beam of rack R2.",
            FigureKind::Envelope(rack),
        ),
    ]
}

fn tables() -> Vec<Block> {
    let mut demands = Table::new(
        "Demands, largest over the run.",
        &[
            ("demand", ""),
            ("where", ""),
            ("value", "SI unit of the row"),
            ("at", "s"),
            ("limit", ""),
        ],
    );
    let rows = [
        ("top drift over stack height", "B8", 0.052, 9.31, Some(0.05)),
        ("residual slip (m)", "R1", 0.0204, 60.0, None),
        ("normal force (N)", "R1 on B1", 18_240.0, 9.02, None),
        ("stress amplification", "B1", 2.914, 9.02, Some(3.0)),
    ];
    for (name, place, value, time, limit) in rows {
        let limit = limit.map_or(Cell::Missing, |v| Cell::Number(v, 2));
        demands.rows.push(vec![
            Cell::text(name),
            Cell::text(place),
            Cell::Number(value, 3),
            Cell::Number(time, 3),
            limit,
        ]);
    }
    let mut inputs =
        Table::new("Inputs.", &[("input", ""), ("value", ""), ("unit", ""), ("from", "")]);
    for (name, value, unit, from) in [
        ("stiffness of a contact", 9.8e5, "N/m", "assumed"),
        ("friction of rack on floor", 0.4, "", "measured on site"),
        ("mass of a full barrel", 269.0, "kg", "maker's sheet <2024> & scale"),
    ] {
        inputs.rows.push(vec![
            Cell::text(name),
            Cell::Number(value, 3),
            Cell::text(unit),
            Cell::text(from),
        ]);
    }
    vec![
        Block::Heading { level: 2, text: "Numbers".into() },
        Block::Table(demands),
        Block::Details {
            summary: "All inputs".into(),
            blocks: vec![Block::Table(inputs), spectrum_inside()],
        },
    ]
}

fn spectrum_inside() -> Block {
    let times: Vec<f64> = (0..6000).map(|k| f64::from(k) * 0.01).collect();
    let plot = timeline(
        Axis::new("ground acceleration", "g"),
        vec![series("x", &times, ground_acceleration)],
    );
    figure("ground-motion", "The ground motion as applied.", FigureKind::Plot(plot))
}

fn document() -> Document {
    let scene = Arc::new(scene());
    let trace = |body| Trace { body, point: [0.0, 0.0], label: scene.bodies[body].name.clone() };
    let player = Player {
        id: "run".into(),
        caption: "The run. Arrows are contact forces; dashed lines the paths of B8 and B7.".into(),
        traces: vec![trace(12), trace(11)],
        scene: Arc::clone(&scene),
    };
    let panels = [
        (0.0, "start"),
        (9.05, "largest sway"),
        (FALL + 0.05, "B8 leaves"),
        (FALL + 0.5, "in the air"),
        (FALL + 0.8, "on the floor"),
        (DURATION, "end"),
    ];
    let strip = Strip {
        scene: Arc::clone(&scene),
        panels: panels
            .iter()
            .map(|(time, note)| Panel { time: *time, note: (*note).into() })
            .collect(),
    };
    let mut blocks = vec![Block::Player(player)];
    blocks.push(Block::Heading { level: 2, text: "Collapse sequence".into() });
    blocks.push(figure("collapse", "How barrel B8 comes down.", FigureKind::Strip(strip)));
    blocks.extend(histories(&scene));
    blocks.extend(envelopes());
    blocks.push(Block::Heading { level: 2, text: "Ground motion".into() });
    blocks.push(spectrum());
    blocks.extend(loop_and_dots());
    blocks.extend(tables());
    blocks.push(Block::List(vec![
        "A list item.".into(),
        "Another with <b>no</b> markup & all.".into(),
    ]));
    Document {
        title: "Four levels of two barrels, synthetic motion at 0.42 g".into(),
        verdict: Verdict {
            headline: "One barrel of eight falls from the top level.".into(),
            sentences: vec![
                "Barrel B8 leaves its cradle 14.0 s into the shaking and hits the floor 0.8 s later.".into(),
                "The other seven stay on their racks; the bottom rack has moved by 2 cm at the end.".into(),
            ],
            dots: vec![Dots {
                direction: "along the barrels".into(),
                fell: 53,
                stood: 10,
                open: 1,
            }],
            tone: Tone::Falls,
            ..Verdict::default()
        },
        blocks,
        provenance: vec![
            ("program".into(), "barrelstack 0.1.0".into()),
            ("scenario".into(), "gallery, sha256 9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08".into()),
            ("time step".into(), "0.1 ms".into()),
        ],
        warnings: vec!["The motions of this page are formulas; nothing was computed.".into()],
        ..Document::default()
    }
}

/// Empty blocks, which a page must tolerate.
fn empty_blocks() -> Vec<Block> {
    let one = Scene {
        bodies: vec![SceneBody::barrel("B1", RADIUS)],
        frames: Frames { times: vec![0.0], poses: vec![vec![[0.0, RADIUS, 0.0]]], forces: vec![] },
        ..Scene::default()
    };
    let player = |id: &str, scene: Scene| {
        Block::Player(Player {
            id: id.into(),
            caption: id.into(),
            scene: Arc::new(scene),
            traces: vec![],
        })
    };
    let flat =
        timeline(Axis::new("a", ""), vec![Series::new("flat", vec![0.0, 1.0], vec![2.0, 2.0])]);
    let gaps =
        timeline(Axis::new("b", ""), vec![Series::new("gaps", vec![0.0, 1.0], vec![f64::NAN; 2])]);
    vec![
        player("one frame", one),
        player("no frames", Scene::default()),
        figure(
            "nothing",
            "A plot without series.",
            FigureKind::Plot(Plot { interactive: true, ..Plot::default() }),
        ),
        figure("flat", "A level line.", FigureKind::Plot(flat)),
        figure("gaps", "Only gaps.", FigureKind::Plot(gaps)),
        figure("no stress", "An empty envelope.", FigureKind::Envelope(Envelope::default())),
        Block::Table(Table::new("A table without rows.", &[("a", "m"), ("b", "")])),
        Block::Table(Table::new("A table without columns.", &[])),
    ]
}
