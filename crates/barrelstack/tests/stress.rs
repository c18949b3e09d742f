//! Envelopes of contact stress, largest forces before and after the first loss of a seat, and other largest values that
//! pages state.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test")]

use barrelstack::assemble::{PartKind, assemble};
use barrelstack::motion::AccelerationUnit;
use barrelstack::outcome::Outcome;
use barrelstack::report::{document, scene, stress_figure};
use barrelstack::scenario::View;
use barrelstack::watch::StressEnvelope;
use barrelstack::{Record, Run, Scenario, Summary};
use barrelstack_dynamics::{Scratch, State, evaluate, settle};
use barrelstack_report::{FigureKind, markdown};

const RACKS: [&str; 7] = [
    "two-barrel",
    "two-barrel-feet",
    "single-bar",
    "four-barrel",
    "rack-on-rack",
    "two-barrel-inclined",
    "candia-2008",
];

/// Stacks of three levels with every rack in both planes, and the cases of the paper, without motion.
fn stacks() -> Vec<(String, Scenario)> {
    let mut stacks = Vec::new();
    for rack in RACKS {
        for view in View::ALL {
            let columns =
                if view == View::Transverse { 2 } else { 2 - u32::from(rack != "four-barrel") };
            let text = format!(
                "schema = 1\n[stack]\nview = \"{}\"\nlevels = 3\ncolumns = {columns}\nbarrel = \
                 \"bordeaux-225\"\nrack = \"{rack}\"\n[motion]\nnone = true\n[run]\nduration = \"0.01 s\"\n",
                view.name()
            );
            let scenario = Scenario::from_str(&text).unwrap();
            stacks.push((format!("{rack}, {}", view.words()), scenario));
        }
    }
    for name in ["candia-6-barrels", "candia-8-barrels", "candia-8-barrels-longitudinal"] {
        let still = ["run.duration=\"0.01 s\"", "motion.scale.factor=1e-9"];
        let still = still.map(str::to_owned);
        let motion = if name == "candia-6-barrels" {
            vec!["motion={ bundled = 'napa-college-2014', component = 'horizontal-1' }".to_owned()]
        } else {
            Vec::new()
        };
        let changes = [motion, still.to_vec()].concat();
        stacks.push((name.to_owned(), Scenario::builtin(name, &changes).unwrap()));
    }
    stacks
}

#[test]
fn envelopes_at_rest_add_up_to_the_contact_forces_and_the_weight_of_every_body() {
    let page = include_str!("../../../validation/envelopes.md");
    let (mut bodies, mut stale) = (0, 0);
    for (name, scenario) in stacks() {
        let run = scenario.run().unwrap();
        // The contact forces at rest, computed independently of all observers.
        let assembly = assemble(&scenario).unwrap();
        let mut state = State::initial(&assembly.model);
        let mut scratch = Scratch::new(&assembly.model);
        settle(&assembly.model, &mut state, &mut scratch, 1e-10).unwrap();
        evaluate(&assembly.model, &state, &mut scratch);
        let mut contacts = vec![0.0; assembly.parts.len()];
        for contact in &scratch.contacts {
            let pair = assembly.model.pair(contact.pair);
            for body in [pair.contactor, pair.target] {
                contacts[body] += contact.normal_force;
            }
        }
        let joints = run.recording.forces().listed();
        for (body, part) in assembly.parts.iter().enumerate() {
            if !matches!(part.kind, PartKind::Barrel | PartKind::Rack) {
                continue;
            }
            bodies += 1;
            let envelope = run.stresses.of(body).unwrap();
            let (force, due) = (envelope.force_at_rest(), contacts[body]);
            let error = (force / due - 1.0).abs();
            // The bodies below bear the body and its load; wine is part of its barrel.
            let load = |own: bool| -> f64 {
                let on = |joint: &&&barrelstack::watch::Joint| {
                    body == if own { joint.upper } else { joint.lower }
                };
                joints.iter().filter(on).map(|joint| joint.at_rest).sum()
            };
            let wine = assembly
                .parts
                .iter()
                .position(|one| one.kind == PartKind::Wine && one.carrier == Some(body));
            let mass = |id: usize| assembly.model.bodies()[id].mass;
            let weight = 9.806_65 * (mass(body) + wine.map_or(0.0, mass));
            let carried = load(false) + weight;
            let off = (load(true) / carried - 1.0).abs();
            let times = envelope.amplification();
            let row = format!("| {name} | {} | {force:.1} | {due:.1} | {carried:.1} |", part.name);
            println!("{row} {error:.0e}, {off:.0e} |");
            stale += usize::from(!page.contains(&row));
            assert!(error < 1e-6 && off < 1e-6, "{name}, {}: {error:e} {off:e}", part.name);
            assert!((envelope.total.at_rest / due - 1.0).abs() < 1e-6);
            // Every barrel except those on top bears above and below, every rack likewise.
            let sides = |up: bool| {
                let side = |at: &usize| (envelope.points[*at].normal.z > 0.0) == up;
                let loaded = |at: &usize| envelope.at_rest[*at] > 0.0;
                (0..envelope.points.len()).filter(side).any(|at| loaded(&at))
            };
            let bears_above = load(false) > 0.0;
            assert_eq!((sides(true), sides(false)), (bears_above, true), "{name}, {}", part.name);
            assert!(times.is_some_and(|times| times >= 1.0), "{name}, {}", part.name);
            assert!(is_drawn(&run, envelope), "{name}, {}", part.name);
        }
    }
    assert!(bodies > 100 && page.contains(&format!("the {bodies} bodies in the table")));
    assert_eq!(stale, 0, "rows of validation/envelopes.md that are of another state");
}

/// `true` if the figure of an envelope has stresses at rest.
fn is_drawn(run: &Run, envelope: &StressEnvelope) -> bool {
    let FigureKind::Envelope(picture) = stress_figure(run, envelope).kind else { return false };
    picture.static_stress.iter().any(|stress| *stress > 0.0)
}

#[test]
fn whatever_is_largest_says_until_when() {
    let changes = ["stack.view=longitudinal", "motion.scale.factor=2"].map(str::to_owned);
    let run = Scenario::builtin("demo-napa", &changes).unwrap().run().unwrap();
    let Outcome::Collapse { time, .. } = run.outcome else { panic!("{:?}", run.outcome) };
    let summary = Summary::of(&run, None);
    let (mut later, mut met) = (0, 0);
    for joint in &summary.interfaces {
        let until = [joint.peak_vertical_at, joint.peak_horizontal_at];
        assert!(until.iter().all(|at| *at <= time), "{}: {until:?}, {time}", joint.name);
        assert!(joint.peak_vertical_whole_run.abs() >= joint.peak_vertical.abs());
        later += usize::from(joint.peak_vertical_whole_run_at > time);
        met += usize::from(joint.name.contains(" against "));
    }
    assert!(later > 0 && met > 0, "{later} {met}");
    let (until, whole) = (&summary.demands, &summary.demands_whole_run);
    assert!(whole.stave_utilization > until.stave_utilization, "{until:?}\n{whole:?}");
    assert!(whole.top_drift_ratio > until.top_drift_ratio);
    for envelope in &run.stresses.envelopes {
        assert!(envelope.peak.iter().zip(&envelope.peak_whole_run).all(|(a, b)| a <= b));
    }
}

#[test]
fn bodies_that_meet_only_while_shaken_are_among_the_forces() {
    // Racks side by side with a gap of 2 mm, pushed together.
    let changes =
        ["stack.columns=4", "stack.gap='2 mm'", "stack.levels=3", "motion.scale.factor=1.5"];
    let changes = changes.map(str::to_owned);
    let run = Scenario::builtin("candia-8-barrels", &changes).unwrap().run().unwrap();
    let summary = Summary::of(&run, None);
    let between = |name: &str| summary.interfaces.iter().find(|one| one.name == name);
    let beside = summary
        .interfaces
        .iter()
        .filter(|one| one.name.contains(" against ") && one.peak_horizontal != 0.0);
    let names: Vec<&str> = beside.clone().map(|one| one.name.as_str()).collect();
    println!("{names:?}");
    assert!(!names.is_empty());
    assert!(between("R1.1 on ground").is_some());
    for one in beside {
        let history = run.recording.joints.iter().find(|joint| joint.name == one.name).unwrap();
        assert_eq!(history.horizontal.len(), run.recording.times.len());
        assert_eq!(history.joint.at_rest, 0.0);
        let most = history.horizontal.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
        assert!(most <= one.peak_horizontal_whole_run.abs());
    }
}

/// Returns the largest absolute value.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Returns samples (m/s²) at 200 Hz. One sample is five times as large as all others; at any usual frame rate, it lies
/// between two pictures.
fn spike() -> Vec<f64> {
    let wave = |k: usize| if k == 171 { -3.0 } else { 0.6 * (k as f64 * 0.09).sin() };
    (0..400).map(wave).collect()
}

#[test]
fn peaks_of_the_ground_in_pictures_are_those_of_the_motion() {
    let record = Record::of_samples(
        "spike",
        &[("E", &spike()), ("UP", &[0.0; 400])],
        0.005,
        AccelerationUnit::MetersPerSecondSquared,
    )
    .unwrap();
    let changes = [
        "stack.view=transverse",
        "stack.levels=1",
        "motion.component=E",
        "motion.processing=none",
        "run.duration=2 s",
    ];
    let changes = changes.map(str::to_owned);
    let scenario = Scenario::builtin("demo-napa", &changes).unwrap().with_record(&record).unwrap();
    let run = scenario.run().unwrap();
    let exact = run.ground.motion.as_ref().unwrap().horizontal.pga() / 9.806_65;
    let drawn = scene(&run);
    let [acceleration, velocity] = drawn.ground.as_slice() else { panic!("two histories") };
    println!("{exact} g, drawn {}", largest(&acceleration.values));
    assert!((largest(&acceleration.values) / exact - 1.0).abs() < 1e-9);
    assert!(acceleration.times.is_sorted() && acceleration.times.len() < 110);
    assert_eq!(velocity.unit, "cm/s");
    // The figure of the page shows the same samples.
    let page = markdown(&document(&run, &Summary::of(&run, None)), "figures");
    let file = page.files.iter().find(|file| file.name == "ground-acceleration.csv").unwrap();
    let text = std::str::from_utf8(&file.bytes).unwrap();
    let cells =
        text.lines().filter_map(|line| line.split(',').nth(1)).filter_map(|cell| cell.parse().ok());
    let figure = largest(&cells.collect::<Vec<f64>>());
    assert!((figure / exact - 1.0).abs() < 1e-3, "{figure} {exact}");
}

#[test]
fn crushed_staves_are_in_the_verdict_of_a_run_that_stands() {
    let changes =
        ["stack.view=transverse", "stack.levels=2", "motion.scale.factor=0.2", "run.duration=8 s"];
    let said = |capacity: &str| {
        let capacity = format!("stack.barrel.stave_capacity={capacity}");
        let changes: Vec<String> =
            changes.iter().copied().chain([capacity.as_str()]).map(str::to_owned).collect();
        let run = Scenario::builtin("demo-napa", &changes).unwrap().run().unwrap();
        let summary = Summary::of(&run, None);
        (document(&run, &summary).verdict.headline, summary.demands.stave_utilization.unwrap())
    };
    let (headline, load) = said("1 kN");
    assert!(load > 1.0, "{load}");
    let stated =
        format!("their load reaches up to {:.0} % of their stated capacity.", 100.0 * load);
    let stands = "Shaken across the barrels, the stack stands until the run ends at 8.0 s, 27.0 s before the end \
                  of the motion";
    assert_eq!(headline, format!("{stands}, but staves are crushed: {stated}"));
    let (headline, load) = said("1 MN");
    assert!(load < 1.0, "{load}");
    assert_eq!(headline, format!("{stands}."));
}
