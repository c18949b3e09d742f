//! Devices and seats in three dimensions, compared with closed forms: across the barrels, along them and at an angle.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use std::f64::consts::TAU;

use barrelstack::Scenario;
use barrelstack::demand::Span;
use barrelstack_dynamics::{Linear as _, Solid, Vec3};
use barrelstack_space::run::{Run, run, stand};
use barrelstack_space::summary;
use barrelstack_space::variants::demands;

const GRAVITY: f64 = 9.80665;

/// Mass (kg) of a full barrel, and of a rack.
const BARREL: f64 = 46.0 + 990.0 * 0.225;
const RACK: f64 = 400.0;

/// Angle (degrees) of the supports of a cradle.
const CRADLE: f64 = 28.0;

/// Returns a motion that pushes (g) along the first component for a time (s).
fn pulse(amplitude: f64, seconds: f64) -> String {
    format!(
        "[motion.pulse]\nkind = \"rectangular\"\namplitude = \"{amplitude} g\"\nperiod = \"{seconds} s\""
    )
}

/// Returns a motion along the first component whose acceleration (g) grows and fades within sixteen seconds, too slowly
/// to cause vibrations.
fn growing(amplitude: f64) -> String {
    format!(
        "[motion.pulse]\nkind = \"half-sine\"\namplitude = \"{amplitude} g\"\nperiod = \"16 s\""
    )
}

/// Returns the largest force (N) in any element.
fn largest(run: &Run) -> f64 {
    run.elements.iter().map(|element| element.peak.0.abs()).fold(0.0, f64::max)
}

/// Returns a stack whose rack is so wide and heavy, and whose contacts are so stiff, that only the device deforms;
/// rotated so that the push comes at an angle (degrees), from 0 across the barrels to 90 along them.
fn stack(settings: &[&str], motion: &str, seconds: f64, angle: f64) -> Scenario {
    let text = format!(
        "schema = 1\n[stack]\nview = \"spatial\"\nazimuth = \"{} deg\"\nlevels = 1\ncolumns = 2\n\
         rack = {{ base = \"two-barrel\", width = \"3 m\", mass = \"{RACK} kg\" }}\n\
         [interface.rack-ground]\nstiffness = \"50 MN/m\"\ndamping = \"20 kN s/m\"\n\
         [interface.rack-ground.friction]\ncoefficient = 5.0\n\
         [interface.barrel-rack]\nlaw = \"kelvin-voigt\"\nbasis = \"node\"\nstiffness = \"50 MN/m\"\ndamping = \"20 kN s/m\"\n\
         [interface.barrel-rack.friction]\ncoefficient = 0.6\n{motion}\n\
         [run]\nduration = \"{seconds} s\"\nuntil = \"duration\"\n[record]\nframe_rate = \"500 Hz\"\n",
        -angle
    );
    let settings: Vec<String> = settings.iter().map(|one| (*one).to_owned()).collect();
    Scenario::parse("device.toml", &text, &settings).unwrap()
}

/// Returns the displacements of a body (m) relative to the ground, with the times (s).
fn ways(run: &Run, name: &str) -> Vec<(f64, Vec3)> {
    let body = run.stack.parts.iter().position(|part| part.name == name).unwrap();
    let at = |pose: &[f64; 7]| Vec3::new(pose[0], pose[1], pose[2]);
    let rest = run.fates[body].rest;
    let frames = run.frames.times.iter().zip(&run.frames.poses);
    frames.map(|(time, poses)| (*time, at(&poses[body]) - at(&poses[0]) - rest)).collect()
}

/// Returns the period (s) of the zero crossings of a quantity after a time (s).
fn period(ways: &[(f64, f64)], after: f64) -> f64 {
    let crossings: Vec<f64> = ways
        .windows(2)
        .filter(|w| w[0].0 > after && w[0].1 * w[1].1 < 0.0)
        .map(|w| w[0].0 + w[0].1 / (w[0].1 - w[1].1) * (w[1].0 - w[0].0))
        .collect();
    assert!(crossings.len() > 2, "it does not swing");
    2.0 * (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64
}

/// Asserts that a value is within a relative tolerance of the exact one.
fn near(what: &str, found: f64, exact: f64, share: f64) {
    let off = found / exact - 1.0;
    println!("{what}: {found:.6} for {exact:.6}, {off:e} off");
    assert!(off.abs() < share, "{what}: {found} for {exact}");
}

#[test]
fn dishes_swing_as_pendulums_in_every_direction() {
    let settings = ["stack.isolator.path=dish", "stack.isolator.friction=0"];
    let run = run(&stack(&settings, &pulse(0.08, 0.15), 6.0, 30.0)).unwrap();
    for (name, axis) in [("across", Vec3::new(1.0, 0.0, 0.0)), ("along", Vec3::new(0.0, 1.0, 0.0))]
    {
        let ways = ways(&run, "platform of R1");
        let ways: Vec<_> = ways.iter().map(|(time, way)| (*time, way.dot(axis))).collect();
        // Measured 3.9e-4 and 8.4e-4 off.
        near(name, period(&ways, 0.3), TAU * (1.0 / GRAVITY).sqrt(), 2e-3);
    }
}

#[test]
fn a_sheet_slides_as_the_block_of_newmark_whatever_the_direction() {
    // Relative to the ground it ends a v/2 (a − μg)/(μg) further back.
    let (push, seconds, friction) = (0.15, 0.4, 0.05);
    let exact = 0.5 * (push - friction) * GRAVITY * seconds * seconds * push / friction;
    let settings =
        ["stack.isolator.path=flat", "stack.isolator.friction=0.05", "stack.isolator.stroke='5 m'"];
    for angle in [0.0, 90.0, 37.0] {
        let run = run(&stack(&settings, &pulse(push, seconds), 4.0, angle)).unwrap();
        let (_, last) = *ways(&run, "platform of R1").last().unwrap();
        // Measured 9.1e-3 to 9.4e-3 off.
        near(&format!("{angle} degrees"), last.length(), exact, 1e-2);
        let (sin, cos) = angle.to_radians().sin_cos();
        let aside = (last.x * sin - last.y * cos).abs();
        println!("{aside:e} m aside");
        assert!(aside < 1e-3 * exact, "{aside} m aside"); // measured 1.6e-4 m
    }
}

#[test]
fn stops_of_a_platform_on_springs_hold_it_both_ways() {
    // Without friction the stack swings on its springs as one mass, at any rotation.
    let spring = 1e5;
    let aboard = 60.0 + RACK + 2.0 * BARREL;
    let settings = [
        "stack.isolator.path=flat",
        "stack.isolator.friction=0",
        "stack.isolator.stroke='5 m'",
        "stack.isolator.recentring='100 kN/m'",
    ];
    let run = run(&stack(&settings, &pulse(0.1, 0.1), 4.0, 60.0)).unwrap();
    let of = |axis: Vec3| -> Vec<(f64, f64)> {
        ways(&run, "platform of R1").iter().map(|(time, way)| (*time, way.dot(axis))).collect()
    };
    let exact = TAU * (aboard / spring).sqrt();
    // Measured 5.1e-4 off across, and 4.1e-3 along.
    near("across", period(&of(Vec3::new(1.0, 0.0, 0.0)), 0.2), exact, 2e-3);
    near("along", period(&of(Vec3::new(0.0, 1.0, 0.0)), 0.2), exact, 5e-3);
}

#[test]
fn a_stack_glides_between_ties_to_walls_on_all_four_sides() {
    let (slack, stiffness) = (0.02, 4e4);
    let (push, seconds) = (0.1, 0.15);
    let speed = push * GRAVITY * seconds;
    let omega = (stiffness / (60.0 + RACK + 2.0 * BARREL)).sqrt();
    let settings = [
        "stack.isolator.path=flat",
        "stack.isolator.friction=0",
        "stack.isolator.stroke='5 m'",
        "stack.tie.levels=1",
        "stack.tie.slack='0.02 m'",
        "stack.tie.stiffness='40 kN/m'",
        // The anchor is so far away that the rotation of a tie is negligible as the stack moves sideways.
        "stack.tie.distance='20 m'",
    ];
    for (angle, axis) in [(0.0, Vec3::new(1.0, 0.0, 0.0)), (90.0, Vec3::new(0.0, 1.0, 0.0))] {
        let run = run(&stack(&settings, &pulse(push, seconds), 5.0, angle)).unwrap();
        assert_eq!(run.elements.len(), 4 + 4);
        let ways = ways(&run, "R1");
        let ways: Vec<_> = ways.iter().map(|(time, way)| (*time, way.dot(axis))).collect();
        // Measured 6.4e-5 across and 6.8e-4 along.
        near(&format!("{angle}"), period(&ways, seconds), 4.0 * slack / speed + TAU / omega, 2e-3);
    }
}

#[test]
fn a_tuned_mass_splits_the_frequency_of_its_platform_both_ways() {
    let (mass, spring) = (150.0, 1e5);
    let aboard = 60.0 + RACK + 2.0 * BARREL;
    let (whole, own): (f64, f64) = (spring / aboard, 0.81 * spring / aboard);
    let own_period = format!("stack.tuned_mass.period='{} s'", TAU / own.sqrt());
    let settings = [
        "stack.isolator.path=flat",
        "stack.isolator.friction=0",
        "stack.isolator.stroke='5 m'",
        "stack.isolator.recentring='100 kN/m'",
        "stack.tuned_mass.mass='150 kg'",
        "stack.tuned_mass.damping_ratio=0",
        "stack.tuned_mass.stroke='5 m'",
        &own_period,
    ];
    let run = run(&stack(&settings, &pulse(0.2, 0.05), 10.0, 30.0)).unwrap();
    let [platform, other] = ["platform of R1", "mass on R1"].map(|name| ways(&run, name));
    // (k₁ + k₂ − ω² m₁)(k₂ − ω² m₂) = k₂².
    let sum = whole + own * (1.0 + mass / aboard);
    let root = (0.25 * sum * sum - whole * own).sqrt();
    for axis in [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)] {
        for square in [0.5 * sum - root, 0.5 * sum + root] {
            // Each mode is isolated in a quantity that the other mode, which is orthogonal with respect to the masses,
            // does not affect.
            let shape = own / (own - square);
            let mode: Vec<(f64, f64)> = platform
                .iter()
                .zip(&other)
                .map(|((time, x), (_, y))| {
                    (*time, aboard * x.dot(axis) + mass * shape * y.dot(axis))
                })
                .collect();
            // Measured 2.8e-3 off along, 3.5e-4 across.
            near("period of a mode", period(&mode, 0.1), TAU / square.sqrt(), 5e-3);
        }
    }
}

#[test]
fn barrels_sink_into_pads_by_their_weight() {
    // Four supports, each under a slope across the barrel and along it: 4 k n_z² δ = m g.
    let sinks = |stiffness: f64| {
        let settings = [
            &format!("stack.pad.stiffness='{stiffness} N/m'"),
            "stack.pad.friction=0",
            "interface.barrel-rack.friction.coefficient=0",
        ];
        let standing = stand(&stack(&settings, &pulse(1e-6, 0.01), 0.01, 0.0)).unwrap();
        let place = |name: &str| {
            let body = standing.stack.parts.iter().position(|part| part.name == name).unwrap();
            let drawn = standing.stack.model.bodies()[body].pose.position.z;
            drawn - standing.state.poses[body].position.z
        };
        place("B1.1") - place("R1")
    };
    let scenario = stack(&[], &pulse(1e-6, 0.01), 0.01, 0.0);
    let barrelstack::scenario::Scene::Stack { stack: spec, .. } = &scenario.scene else {
        panic!("a stack")
    };
    // The point where a support of 15 mm touches the stave, from the middle of the arc of the stave.
    let (half, [head, bilge]) =
        (0.5 * spec.barrel.length, [spec.barrel.head_diameter, spec.barrel.bilge_diameter]);
    let rise = 0.5 * (bilge - head);
    let arc = (half * half + rise * rise) / (2.0 * rise) + 0.015;
    let along = spec.rack.rail_half_spacing / arc;
    let upward = CRADLE.to_radians().cos() * (1.0 - along * along).sqrt();
    let exact = BARREL * GRAVITY / (4.0 * upward * upward) * (1.0 / 2e5 - 1.0 / 4e5);
    // Measured 7.5e-3 off.
    near("sinks", sinks(2e5) - sinks(4e5), exact, 1e-2);
}

#[test]
fn a_lid_holds_what_would_roll_out() {
    // A barrel that leans on one side of its cradle, A > g tan φ: F = m g (A/(g tan φ) − 1).
    let tan = CRADLE.to_radians().tan();
    let exact = BARREL * GRAVITY * (0.9 / tan - 1.0);
    let settings = [
        "stack.lid.levels=1",
        "stack.lid.gap='0 m'",
        "stack.lid.stiffness='500 MN/m'",
        "interface.barrel-rack.stiffness='500 MN/m'",
        "interface.barrel-rack.friction.coefficient=0",
    ];
    let force = largest(&run(&stack(&settings, &growing(0.9), 8.0, 0.0)).unwrap());
    near("force", force, exact, 2e-3); // measured 6.1e-4
}

#[test]
fn hooks_and_saddles_bear_what_a_rack_without_friction_is_pushed_with() {
    // Two of them, over the barrels below; pads keep these in their cradles.
    let pushed = 0.5 * (RACK + 2.0 * BARREL) * 0.2 * GRAVITY;
    for (holds, angle) in [("across", 0.0), ("along", 90.0)] {
        let settings = [
            "stack.levels=2",
            "stack.walking_stop.levels=12",
            "stack.walking_stop.gap='0 m'",
            "stack.walking_stop.stiffness='50 MN/m'",
            &format!("stack.walking_stop.holds={holds}"),
            "interface.barrel-rack.friction.coefficient=0",
            "stack.pad.stiffness='50 MN/m'",
            "stack.pad.friction=2",
        ];
        let run = run(&stack(&settings, &growing(0.2), 8.0, angle)).unwrap();
        assert_eq!(run.outcome.kind(), "stable", "{holds}: {:?}", run.outcome);
        assert_eq!(run.elements.len(), 2);
        let exact = if holds == "along" { pushed * on_a_slope(&run) } else { pushed };
        for element in &run.elements {
            // Measured 3.9e-4 across and 2.0e-3 along.
            near(holds, element.peak.0.abs(), exact, 5e-3);
        }
    }
}

/// Returns the ratio of the force on the hooks to the push on the rack of the second level along the barrels. Because
/// of the overturning moment, the leading tube carries more than the trailing tube, and the staves slope away under
/// both.
fn on_a_slope(run: &Run) -> f64 {
    let bodies = run.stack.model.bodies();
    let named = |name: &str| bodies.iter().find(|body| body.name == name).unwrap();
    let (rack, load, below) = (named("R2"), named("B2.1"), named("B1.1"));
    let (Solid::Capsule(tube), Solid::Barrel(barrel)) =
        (&rack.surfaces[0].surface, &below.surfaces[0].surface)
    else {
        panic!("tubes on barrels")
    };
    let place = rack.pose.orientation.matrix().apply(rack.surfaces[0].offset);
    // Of the whole push, above the middles of the tubes.
    let center =
        (RACK * rack.pose.position.z + 2.0 * BARREL * load.pose.position.z) / (RACK + 2.0 * BARREL);
    let height = center - (rack.pose.position.z + place.z);
    let arm = place.y.abs();
    let sin = arm / (barrel.stave_radius + barrel.rounding + tube.radius);
    let slope = sin / (1.0 - sin * sin).sqrt() / arm;
    (1.0 + slope * height) / (1.0 - slope * tube.radius)
}

#[test]
fn a_saddle_lets_a_rack_go_along_and_a_hook_lets_it_go_across() {
    for (holds, angle) in [("across", 90.0), ("along", 0.0)] {
        let settings = [
            "stack.levels=2",
            "stack.walking_stop.levels=12",
            "stack.walking_stop.gap='0 m'",
            &format!("stack.walking_stop.holds={holds}"),
            "interface.barrel-rack.friction.coefficient=0",
            "stack.pad.stiffness='50 MN/m'",
            "stack.pad.friction=2",
        ];
        let run = run(&stack(&settings, &pulse(0.05, 0.2), 0.6, angle)).unwrap();
        // It lags behind the ground, on level rounds: v t.
        let (time, way) = *ways(&run, "R2").last().unwrap();
        let gone = 0.05 * GRAVITY * 0.2 * (time - 0.1);
        println!("{holds}: {} m of {gone} m, {:.1} N", way.length(), largest(&run));
        assert!(way.length() > 0.95 * gone); // measured 1.00 and 1.03
        assert!(run.elements.iter().all(|element| element.broken_at.is_none()));
        assert!(largest(&run) < 1.0); // measured 0.0
    }
}

#[test]
fn barrels_roll_out_over_chocks_from_the_tangent_of_their_angle() {
    let exact = 40.0_f64.to_radians().tan();
    let settings = [
        "stack.chock.levels=1",
        "stack.chock.gap='0 m'",
        "stack.chock.angle='40 deg'",
        "stack.rack.cradle.angle='20 deg'",
        "interface.barrel-rack.friction.coefficient=0",
        // Contacts are as stiff as possible, so that penetration is negligible.
        "interface.fallen-barrel-rack.law=hertz",
        "interface.fallen-barrel-rack.stiffness='1e11 N/m^1.5'",
        "interface.fallen-barrel-rack.friction.coefficient=0",
    ];
    for (share, kind) in [(0.97, "stable"), (1.03, "collapse")] {
        let run = run(&stack(&settings, &pulse(share * exact, 2.0), 1.9, 0.0)).unwrap();
        assert_eq!(run.outcome.kind(), kind, "{share} of {exact}: {:?}", run.outcome);
    }
}

#[test]
fn a_mirrored_stack_with_all_devices_has_the_same_forces_on_the_other_side() {
    let all = [
        "stack.levels=3",
        "stack.strap.levels=2",
        "stack.walking_stop.levels=12",
        "stack.walking_stop.holds=both",
        "stack.walking_stop.gap='2 mm'",
        "stack.chock.levels=2",
        "stack.lid.levels=1",
        "stack.pad.stiffness='500 kN/m'",
        "stack.isolator.path=dish",
        "stack.tie.levels=1",
        "stack.tie.side=left",
        "stack.tie.yields_at='3 kN'",
        "stack.tuned_mass.mass='80 kg'",
    ];
    let peaks = |more: &[&str]| {
        let run = run(&stack(&[&all, more].concat(), &pulse(0.3, 0.4), 1.5, 0.0)).unwrap();
        let missing = run.energy.as_ref().unwrap().residual_ratio();
        println!("{:?}, balance {missing:e}", run.outcome);
        assert!(missing < 1e-6, "{missing:e}"); // measured 1.2e-7
        let mut all: Vec<f64> = run.elements.iter().map(|fate| fate.peak.0.abs()).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let (one, other) = (peaks(&[]), peaks(&["stack.mirror=true", "motion.scale.factor=-1"]));
    let bearing = one.iter().filter(|force| **force > 0.0).count();
    println!("{bearing} bear");
    assert!(bearing > 10, "{one:?}"); // measured 21
    let apart = one.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("{apart:e} N apart");
    assert!(apart < 1e-6, "{apart}"); // measured 1.4e-9
}

#[test]
fn seats_bear_weight_and_push_whatever_the_direction() {
    let aboard = RACK + 2.0 * BARREL;
    let still = run(&stack(&[], &pulse(1e-9, 0.01), 0.1, 0.0)).unwrap();
    let pushed = run(&stack(&[], &growing(0.2), 8.0, 37.0)).unwrap();
    let summary = summary::of(&pushed, &pushed.scenario);
    for seat in &summary.interfaces {
        let mass = if seat.name == "R1 on ground" { aboard } else { BARREL };
        // Measured 1.8e-10, 2.1e-6 and 1.5e-5 off.
        near(&seat.name, seat.at_rest, mass * GRAVITY, 1e-8);
        near(&seat.name, seat.peak_horizontal, mass * 0.2 * GRAVITY, 1e-4);
        near(&seat.name, seat.peak_vertical, mass * GRAVITY, 1e-3);
    }
    assert_eq!(summary.interfaces.len(), 3);
    let load = summary.demands.stave_utilization.unwrap();
    near("staves", load, BARREL * GRAVITY / pushed.stack.stave_capacity, 1e-3); // measured 1.5e-5
    // Measured 5.2e-9 and 4.9e-9 off.
    near("still", demands(&still, Span::UntilLoss).stress_amplification.unwrap(), 1.0, 1e-7);
    near("still", demands(&still, Span::UntilLoss).mean_stress_amplification.unwrap(), 1.0, 1e-7);
    // A barrel pushed to a side leans on its supports there.
    let most = summary.demands.stress_amplification.unwrap();
    println!("{most}");
    assert!(most > 1.1); // measured 1.60
}
