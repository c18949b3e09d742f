//! Free scenes of solid bodies: several parts, exact boundaries, nodes at chosen places.
#![allow(clippy::print_stdout, reason = "prints error messages and results")]

use std::fmt::Write as _;

use barrelstack::scenario::Scene;
use barrelstack::{Run, Scenario};

fn scene(bodies: &str, between: [&str; 2]) -> Scenario {
    Scenario::parse("solids", &text(bodies, between), &[]).unwrap()
}

fn text(bodies: &str, between: [&str; 2]) -> String {
    format!(
        "schema = 1\ntitle = \"solids\"\nkind = \"free\"\n{bodies}\n\
         [[interface]]\nbetween = [\"{}\", \"{}\"]\nstiffness = \"1 MN/m\"\ndamping = \"2 kN s/m\"\n\
         friction = {{ coefficient = 0.5 }}\n\
         [[interface]]\nbetween = [\"box\", \"ground\"]\nstiffness = \"1 MN/m\"\ndamping = \"2 kN s/m\"\n\
         friction = {{ coefficient = 0.5 }}\n[run]\nduration = \"1 s\"\n",
        between[0], between[1]
    )
}

fn run(scenario: &Scenario) -> Run {
    scenario.run().unwrap()
}

fn last(run: &Run) -> Vec<[f64; 3]> {
    run.recording.frames.poses.last().unwrap().clone()
}

fn body(name: &str, shape: &str, nodes: &str, position: [f64; 2], angle: f64) -> String {
    let kind = if name == "ball" { "ball" } else { "box" };
    format!(
        "[[body]]\nname = \"{name}\"\nkind = \"{kind}\"\nshape = {shape}\nnodes = {nodes}\nmass = \"100 kg\"\n\
         position = [\"{} m\", \"{} m\"]\nangle = \"{angle} deg\"\n",
        position[0], position[1]
    )
}

const BOX: &str =
    r#"{ type = "rectangle", width = "0.6 m", height = "0.2 m", corner_radius = "1 cm" }"#;
/// The same rectangle composed of two halves.
const HALVES: &str = r#"{ type = "compound", parts = [
    { shape = { type = "rectangle", width = "0.3 m", height = "0.2 m" }, offset = ["-0.15 m", "0 m"] },
    { shape = { type = "rectangle", width = "0.2 m", height = "0.3 m" }, offset = ["0.15 m", "0 m"], turn = "90 deg" } ] }"#;

#[test]
fn a_compound_has_the_mass_properties_of_what_it_is_made_of() {
    let of = |shape: &str| {
        let text = body("one", shape, "\"exact\"", [0.0, 0.1], 0.0);
        let scenario = scene(&text, ["box", "box"]);
        // The written text is read back.
        let again = Scenario::parse("again", &scenario.to_resolved_toml(), &[]).unwrap();
        assert_eq!(again.to_resolved_toml(), scenario.to_resolved_toml());
        let Scene::Free(free) = scenario.scene else { panic!() };
        (free.bodies[0].inertia, free.bodies[0].center_of_mass)
    };
    let (whole, _) = of(r#"{ type = "rectangle", width = "0.6 m", height = "0.2 m" }"#);
    let (halves, center) = of(HALVES);
    assert!((halves / whole - 1.0).abs() < 1e-14, "{halves} {whole}"); // measured 2e-16
    assert!(center.iter().all(|c| c.abs() < 1e-15));
}

#[test]
fn chosen_nodes_at_the_corners_are_corners() {
    let sharp = r#"{ type = "rectangle", width = "0.6 m", height = "0.2 m" }"#;
    let chosen = r#"{ list = [ { at = ["-0.3 m", "-0.1 m"] }, { at = ["0.3 m", "-0.1 m"] },
        { at = ["0.3 m", "0.1 m"] }, { at = ["-0.3 m", "0.1 m"] } ] }"#;
    let fall = |nodes: &str| {
        let text = body("one", sharp, nodes, [0.0, 0.4], 20.0);
        let mut scenario = scene(&text, ["box", "box"]);
        scenario.run.settle = false;
        last(&run(&scenario))
    };
    assert_eq!(fall("\"corners\""), fall(chosen));
}

#[test]
fn exact_bodies_lie_on_each_other_whichever_comes_first_and_do_not_stand_in_each_other() {
    for upper in [BOX, HALVES] {
        let low = body("low", BOX, "\"exact\"", [0.0, 0.0998], 0.0);
        // Almost half of the upper body hangs over the edge of the lower body, but it does not tip.
        let high = body("high", upper, "\"exact\"", [0.28, 0.2996], 0.0);
        let one = run(&scene(&format!("{low}{high}"), ["box", "box"]));
        let other = run(&scene(&format!("{high}{low}"), ["box", "box"]));
        let (one, other) = (last(&one), last(&other));
        let [a, b] = [one[2], other[1]];
        let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-9, "{apart:e}"); // measured 5e-17
        // By statics, the upper body sinks by 1.2 mm in each joint and rotates by 4.3 mrad; measured: 2.4 mm in all,
        // and 4.7 mrad.
        assert!((a[1] - 0.3).abs() < 3e-3, "{a:?}");
        assert!((a[0] - 0.28).abs() < 1e-3 && a[2].abs() < 5e-3, "{a:?}");
    }
}

#[test]
fn a_ball_rolls_off_an_exact_box_round_its_corner() {
    let low = body("low", BOX, "\"exact\"", [0.0, 0.0998], 0.0);
    let ball =
        body("ball", r#"{ type = "circle", radius = "0.1 m" }"#, "\"exact\"", [0.1, 0.3], 0.0)
            + "velocity = [\"1 m/s\", \"0 m/s\"]\nspin = \"-10 rad/s\"\n";
    for between in [["ball", "box"], ["box", "ball"]] {
        let mut scenario = scene(&format!("{low}{ball}"), between);
        scenario.run.settle = false;
        let at = last(&run(&scenario));
        // The ball leaves the box and then falls freely.
        assert!(at[2][0] > 0.4 && at[2][1] < 0.1, "{:?}", at[2]);
    }
}

#[test]
fn a_cradle_is_not_convex() {
    let text = body(
        "one",
        r#"{ type = "cradle", radius = "0.3 m", half_angle = "40 deg" }"#,
        "\"exact\"",
        [0.0, 0.3],
        0.0,
    );
    let whole = format!("schema = 1\ntitle = \"solids\"\nkind = \"free\"\n{text}");
    let error = Scenario::parse("solids", &whole, &[]).unwrap_err().to_string();
    assert!(error.contains("a cradle is not convex"), "{error}");
}

#[test]
fn a_part_is_no_compound_itself() {
    let nested = format!("{{ type = \"compound\", parts = [ {{ shape = {HALVES} }} ] }}");
    let text = body("one", &nested.replace('\n', " "), "\"exact\"", [0.0, 0.3], 0.0);
    let whole = format!("schema = 1\ntitle = \"solids\"\nkind = \"free\"\n{text}");
    let error = Scenario::parse("solids", &whole, &[]).unwrap_err().to_string();
    println!("{error}");
    assert!(error.contains("compound") && error.contains("rectangle"), "{error}");
}

#[test]
fn a_restitution_holds_for_its_speed_under_the_law_of_hunt_and_crossley() {
    let speed = (2.0 * 9.80665_f64 * 1.0).sqrt();
    let text = format!(
        "schema = 1\ntitle = \"bounce\"\nkind = \"free\"\n\
         [[body]]\nname = \"disc\"\nshape = {{ type = \"circle\", radius = \"0.35 m\" }}\nmass = \"270 kg\"\n\
         position = [\"0 m\", \"1.35 m\"]\nnodes = \"rolling\"\n\
         [[interface]]\nbetween = [\"disc\", \"ground\"]\nlaw = \"hunt-crossley\"\n\
         stiffness = \"500000 MN/m^1.5\"\nrestitution = 0.4\nreference_speed = \"{speed} m/s\"\n\
         friction = {{ law = \"none\" }}\n[run]\nduration = \"0.8 s\"\nsettle = false\n\
         [record]\nframe_rate = \"2 kHz\"\n"
    );
    let run = run(&Scenario::parse("bounce", &text, &[]).unwrap());
    // The disc falls from 1 m and rises to e² times this height, where e is the restitution.
    let struck = (2.0 / 9.80665_f64).sqrt();
    let frames = &run.recording.frames;
    let risen =
        frames.times.iter().zip(frames.all_poses()).filter(|(time, _)| **time > struck + 0.05);
    let top = risen.map(|(_, poses)| poses[1].position.z - 0.35).fold(0.0, f64::max);
    println!("rises to {top} m");
    assert!((top / 0.16 - 1.0).abs() < 5e-3, "{top}");
}

/// Returns a hexagonal heap of discs with a radius of 20 cm, on the ground.
fn heap(count: usize, across: usize) -> String {
    let mut bodies = String::new();
    for at in 0..count {
        let (row, column) = (at / across, at % across);
        let x = 0.4 * (column as f64 + 0.5 * (row % 2) as f64);
        let z = 0.2 + 0.4 * 0.75_f64.sqrt() * row as f64;
        let _ = write!(
            bodies,
            "[[body]]\nname = \"b{at}\"\nkind = \"box\"\nshape = {{ type = \"circle\", radius = \"0.2 m\" }}\n\
             mass = \"100 kg\"\nposition = [\"{x} m\", \"{z} m\"]\n"
        );
    }
    text(&bodies, ["box", "box"])
}

#[test]
fn five_thousand_bodies_run_and_the_next_one_is_refused_in_words() {
    let settings = ["run.settle=false".to_owned(), "run.duration=\"2 ms\"".to_owned()];
    let scenario = Scenario::parse("heap", &heap(5000, 71), &settings).unwrap();
    let run = run(&scenario);
    // Each disc has six neighbors, except at the boundary of the heap, and each contact is counted at one of its two
    // discs. This gives 14,500 contacts; no other pairs are tested.
    let tested = run.work.contact_evaluations as f64 / run.work.evaluations as f64;
    assert!((14_000.0..16_000.0).contains(&tested), "{tested} contact elements a step");
    let error = Scenario::parse("heap", &heap(5001, 71), &[]).unwrap_err().to_string();
    assert!(error.contains("at most 5000 bodies"), "{error}");
}
