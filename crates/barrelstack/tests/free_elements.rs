//! Free scenes with force elements, against closed forms.
#![allow(clippy::print_stdout, reason = "prints the differences from closed forms")]

use barrelstack::{Run, Scenario, Summary};

const GRAVITY: f64 = 9.80665;

fn scene(elements: &str, position: [f64; 2], run: &str) -> String {
    format!(
        "schema = 1\nkind = \"free\"\n[[body]]\nname = \"ball\"\nshape = {{ type = \"circle\", radius = \"5 cm\" }}\n\
         mass = \"20 kg\"\nposition = [\"{} m\", \"{} m\"]\n{elements}\n[run]\nsettle = false\n{run}\n",
        position[0], position[1]
    )
}

fn run(elements: &str, position: [f64; 2], duration: f64) -> (Run, Summary) {
    let text = scene(elements, position, &format!("duration = \"{duration} s\""));
    let scenario = Scenario::parse("elements", &text, &[]).unwrap();
    // Written text reads back.
    let written = scenario.to_resolved_toml();
    let again = Scenario::parse("again", &written, &[]).unwrap();
    assert_eq!(again.to_resolved_toml(), written);
    let run = scenario.run().unwrap();
    let summary = Summary::of(&run, None);
    (run, summary)
}

/// Returns the largest force (N) of the only element, its time (s), and the time of its failure (s).
fn force(summary: &Summary) -> (f64, f64, Option<f64>) {
    let [element] = summary.devices.named("elements") else { panic!("one element") };
    (element.peak, element.peak_at, element.broken_at)
}

#[test]
fn a_pendulum_on_a_rod_has_its_period() {
    // Released 0.02 rad from the lowest point; the rod turns about the middle of the ball, which does not spin.
    let (length, stiffness, mass, angle) = (1.0, 1e6, 20.0, 0.02_f64);
    let rod = "[[element]]\nname = \"rod\"\nkind = \"rod\"\nbetween = [\"ground\", \"ball\"]\nat = [\"0 m\", \"2 m\"]\n\
               stiffness = \"1 MN/m\"\nlength = \"1 m\"";
    let long = length + mass * GRAVITY / stiffness;
    let at = [long * angle.sin(), 2.0 - long * angle.cos()];
    let (run, _) = run(rod, at, 6.5);
    let period =
        2.0 * std::f64::consts::PI * (long / GRAVITY).sqrt() * (1.0 + angle * angle / 16.0);
    let (times, poses) = (&run.recording.frames.times, &run.recording.frames.poses);
    // The third fall through the lowest point from the right is after 2 1/4 periods.
    let mut falls = Vec::new();
    for at in 1..times.len() {
        let [before, now] = [poses[at - 1][1][0], poses[at][1][0]];
        if before > 0.0 && now <= 0.0 {
            falls.push(times[at - 1] + (times[at] - times[at - 1]) * before / (before - now));
        }
    }
    let found = (falls[2] - falls[0]) / 2.0;
    println!("period {found} s against {period} s: {:.1e}", found / period - 1.0);
    // Measured: 6.6e-7.
    assert!((found / period - 1.0).abs() < 5e-6, "{found} and {period}");
    // Measured: 6e-7.
    assert!(run.energy.unwrap().residual_ratio() < 5e-6, "{:?}", run.energy);
}

#[test]
fn a_weight_put_on_a_spring_presses_with_twice_its_weight() {
    let guide = "[[element]]\nname = \"spring\"\nkind = \"guide\"\naxis = \"90 deg\"\nbetween = [\"ground\", \"ball\"]\n\
                 at = [\"0 m\", \"1 m\"]\nstiffness = \"8 kN/m\"";
    let (_, summary) = run(guide, [0.0, 1.0], 1.0);
    let (weight, omega) = (20.0 * GRAVITY, (8000.0_f64 / 20.0).sqrt());
    let (peak, at, broken) = force(&summary);
    println!(
        "{peak} N against {} N, {at} s against {} s",
        2.0 * weight,
        std::f64::consts::PI / omega
    );
    // Measured: 6e-7.
    assert!((peak.abs() / (2.0 * weight) - 1.0).abs() < 1e-5, "{peak}");
    // All peaks are equal within the error of the step, and the first is reported; measured 5e-4.
    let halves = at * omega / std::f64::consts::PI;
    assert!((halves - halves.round()).abs() < 5e-3 && halves.round() % 2.0 == 1.0, "{at}");
    assert_eq!(broken, None);
}

#[test]
fn a_strap_catches_what_falls_or_tears() {
    // Slack of 0.3 m below an anchor 3 m up.
    let strap = |more: &str| {
        format!(
            "[[element]]\nname = \"strap\"\nkind = \"strap\"\nbetween = [\"ground\", \"ball\"]\nat = [\"0 m\", \"3 m\"]\n\
             length = \"0.8 m\"\nstiffness = \"50 kN/m\"\n{more}"
        )
    };
    let (_, summary) = run(&strap(""), [0.0, 2.5], 0.6);
    let weight = 20.0 * GRAVITY;
    let exact = weight * (1.0 + (1.0 + 2.0 * 5e4 * 0.3 / weight).sqrt());
    let (peak, _, broken) = force(&summary);
    println!("{peak} N against {exact} N: {:.1e}", peak / exact - 1.0);
    // Measured: 1.4e-4, the error of a peak between two steps; with a tenth of the step 4e-7.
    assert!((peak / exact - 1.0).abs() < 1e-3 && broken.is_none());
    let (_, summary) = run(&strap("strength = \"2 kN\""), [0.0, 2.5], 0.6);
    let (peak, _, broken) = force(&summary);
    // Failure is detected after a step of 1 ms in which the tension grows by some 120 N.
    assert!((2000.0..2125.0).contains(&peak), "{peak}");
    // It falls 0.3 m freely and then some 4 cm against the spring.
    assert!(broken.is_some_and(|at| (0.247..0.27).contains(&at)), "{broken:?}");
}

#[test]
fn what_is_wrong_with_an_element_is_told_at_its_place() {
    let refused = |element: &str| {
        let text = scene(&format!("[[element]]\n{element}"), [0.0, 1.0], "");
        let said = Scenario::parse("elements", &text, &[]).unwrap_err().sentence();
        println!("{said}");
        said
    };
    let good = "name = \"a\"\nkind = \"rod\"\nstiffness = \"1 kN/m\"\n";
    let said = refused(&format!("{good}between = [\"ball\", \"bell\"]"));
    assert!(said.contains("no body is called \"bell\"; did you mean `ball`?"), "{said}");
    let said = refused(&format!("{good}between = [\"ball\", \"ball\"]"));
    assert!(said.contains("to itself"), "{said}");
    let said = refused(&format!("{good}gap = \"1 cm\"\nbetween = [\"ball\", \"ground\"]"));
    assert!(said.contains("gap"), "{said}");
    let twice = format!(
        "{good}between = [\"ball\", \"ground\"]\n[[element]]\n{good}between = [\"ball\", \"ground\"]"
    );
    assert!(refused(&twice).contains("two elements are called"));
    let said = refused(
        "name = \"a\"\nkind = \"strap\"\nstiffness = \"0 N/m\"\nbetween = [\"ball\", \"ground\"]",
    );
    assert!(said.contains("carries no force"), "{said}");
    let guide = "name = \"a\"\nkind = \"guide\"\nstiffness = \"1 kN/m\"\nbetween = [\"ground\", \"ball\"]\n";
    let said = refused(&format!("{guide}gap = \"1 cm\""));
    assert!(said.contains("stop_stiffness"), "{said}");
    let said = refused(&format!("{guide}stop_stiffness = \"1 MN/m\""));
    assert!(said.contains("no stops"), "{said}");
    let strap = "name = \"a\"\nkind = \"strap\"\nstiffness = \"1 kN/m\"\nbetween = [\"ground\", \"ball\"]\n";
    let said = refused(&format!("{strap}yields_at = \"2 kN\"\nstrength = \"1 kN\""));
    assert!(said.contains("before it would yield"), "{said}");
}
