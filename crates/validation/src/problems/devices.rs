//! Protection devices with exact answers, each on a stack built from a scenario.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use barrelstack::assemble::PartKind;
use barrelstack::device::Tuning;
use barrelstack::{Ground, Run, Scenario};
use barrelstack_dynamics::math::{cos, exp, sin, tan};
use barrelstack_dynamics::{Body, Guide, Link, Model, Still, Strap, Vec2};
use barrelstack_motion::GroundMotion;

use crate::problem::{absent, relative, setting};
use crate::scene::{Scene, disc, floor};
use crate::swing::{crossings, mean_time, run_crossings};
use crate::{Effort, Failure, GRAVITY, Outcome, Problem};

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list: Vec<Problem> = [30.0, 40.0, 55.0].map(rolls_out).into();
    list.push(hill());
    list.extend([0.8, 2.0].map(dish));
    list.push(slides());
    list.extend([pads(), yields(), between_stops()]);
    for share in [0.05, 0.2] {
        list.extend(den_hartog(share));
    }
    list
}

/// Returns the scenario of a one-level stack. Its rack is so wide and heavy, and its contacts are so stiff, that only
/// the device deforms.
fn scenario(settings: &[String], motion: &str, seconds: f64) -> Result<Scenario, Failure> {
    let text = format!(
        "schema = 1\n[stack]\nlevels = 1\ncolumns = 2\nrack = {{ width = \"8 m\", mass = \"400 kg\" }}\n\
         [interface.rack-ground]\nstiffness = \"50 MN/m\"\ndamping = \"20 kN s/m\"\n\
         [interface.rack-ground.friction]\ncoefficient = 5.0\n\
         [interface.barrel-rack]\nstiffness = \"50 MN/m\"\ndamping = \"20 kN s/m\"\n\
         [interface.barrel-rack.friction]\ncoefficient = 0.0\n{motion}\n\
         [run]\nduration = \"{seconds} s\"\nuntil = \"duration\"\n[record]\nhistory_rate = \"500 Hz\"\n"
    );
    Ok(Scenario::parse("device.toml", &text, settings)?)
}

pub(super) fn one_level(settings: &[String], motion: &str, seconds: f64) -> Result<Run, Failure> {
    Ok(scenario(settings, motion, seconds)?.run()?)
}

/// Runs the stack of [`scenario`] under a push, which is a horizontal ground acceleration (g) that grows for one second
/// and is then constant for one second.
pub(super) fn pressed(settings: &[String], push: f64) -> Result<Run, Failure> {
    run_pushed(&scenario(settings, &self::push(push, 1.0), 1.99)?, push, 1000)
}

/// Runs a scenario under a push, which is a horizontal ground acceleration (g) that grows smoothly for a time (ms) and
/// is then constant for one second.
///
/// The growth is so smooth and the steps are so small that stiff elements do not vibrate.
pub(super) fn run_pushed(scenario: &Scenario, push: f64, rise: u32) -> Result<Run, Failure> {
    let grown = |at: u32| 0.5 * (1.0 - cos(PI * f64::from(at.min(rise)) / f64::from(rise)));
    let samples = (0..rise + 1000).map(|at| push * GRAVITY * grown(at)).collect();
    let motion = GroundMotion::from_acceleration("push", 0.001, samples).map_err(absent)?;
    Ok(scenario.run_on(Ground::from(motion), &mut |_| ControlFlow::Continue(()))?)
}

pub(super) fn push(amplitude: f64, seconds: f64) -> String {
    format!(
        "[motion.pulse]\nkind = \"rectangular\"\namplitude = \"{amplitude} g\"\nperiod = \"{seconds} s\""
    )
}

/// Returns the history of the displacement (m) of a body along an axis, as pairs of time (s) and displacement.
pub(super) fn displacement(run: &Run, body: &str, axis: &str) -> Result<Vec<(f64, f64)>, Failure> {
    let name = format!("{body} displacement {axis}");
    let channel = run.recording.channel(&name).ok_or(Failure::Absent(name))?;
    Ok(run.recording.times.iter().copied().zip(channel.values.iter().copied()).collect())
}

/// Returns the settings for chocks without a gap. The line from the center of a barrel to the top of a chock is at an
/// angle (rad) from the vertical. The cradles are lower than the chocks.
fn chocks(angle: f64) -> Vec<String> {
    vec![
        "stack.chock.levels=1".into(),
        "stack.chock.gap=\"0 m\"".into(),
        format!("stack.chock.angle=\"{angle} rad\""),
        "stack.rack.cradle.angle=\"20 deg\"".into(),
        // As hard as the penalty method allows, so that penetration is negligible.
        "interface.fallen-barrel-rack.law=\"hertz\"".into(),
        "interface.fallen-barrel-rack.stiffness=\"1e11 N/m^1.5\"".into(),
        "interface.fallen-barrel-rack.friction.coefficient=0".into(),
    ]
}

fn rolls_out(degrees: f64) -> Problem {
    let angle = degrees.to_radians();
    let exact = tan(angle);
    setting(
        format!("devices/chock-{degrees}"),
        format!("barrels between chocks at {degrees}° under a sustained push"),
        "statics: roll-out at a/g = tan φ",
    )
    .quantity("smallest push that makes a barrel roll out", "g", relative(exact, 1e-2).fast(2e-2))
    .at_border(0.05, move |amplitude| {
        let run = pressed(&chocks(angle), amplitude)?;
        Ok(run.fates.collapse_time().is_some())
    })
}

/// Duration (s) of the impulse.
const BLOW: f64 = 0.05;

/// Distance (m) from the center of a barrel to the center of the rounded end of a chock over which it rolls.
const ARM: f64 = 0.5 * 0.645_918_367_346_938_8 + 0.015;

/// Returns the smallest ground acceleration (g) that, applied for the time [`BLOW`], makes a barrel roll over the chock
/// on which it leans. The angle (rad) of the chock is that of [`chocks`].
///
/// The rotation θ of the barrel about the end of the chock follows `L θ'' = g sin θ − a cos θ` during the impulse;
/// after the impulse, the barrel must pass the energy barrier `g L (1 − cos θ)`.
fn over_the_hill(angle: f64) -> f64 {
    let passes = |push: f64| {
        let steps = 2000;
        let step = BLOW / f64::from(steps);
        let (mut lean, mut rate) = (angle, 0.0);
        for _ in 0..steps {
            let slope = |lean: f64| GRAVITY * (sin(lean) - push * cos(lean)) / ARM;
            let middle = lean + 0.5 * step * rate;
            rate += step * slope(middle);
            lean = middle + 0.5 * step * rate;
        }
        lean <= 0.0 || 0.5 * ARM * rate * rate > GRAVITY * (1.0 - cos(lean))
    };
    let (mut low, mut high) = (0.0, 20.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if passes(middle) { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

fn hill() -> Problem {
    let angle = 40.0_f64.to_radians();
    let exact = over_the_hill(angle);
    setting(
        "devices/chock-hill",
        "barrels between chocks at 40°, pushed for 0.05 s",
        "energy: m g r (1 − cos φ) over the end of a chock",
    )
    .quantity("smallest push that makes a barrel roll out", "g", relative(exact, 2e-2).fast(3e-2))
    .at_border(0.05, move |amplitude| {
        let run = one_level(&chocks(angle), &push(amplitude, BLOW), 1.2)?;
        // A barrel that passes the chock falls onto the beam.
        let drops = run.assembly.of_kind(PartKind::Barrel).map(|b| run.fates.fate(b).drop);
        Ok(drops.fold(0.0, f64::max) > 0.05)
    })
}

fn dish(radius: f64) -> Problem {
    setting(
        format!("devices/dish-{radius}"),
        format!("a stack on an isolator in dishes of {radius} m after a short push"),
        "pendulum: T = 2π √(R/g)",
    )
    .quantity("period", "s", relative(TAU * (radius / GRAVITY).sqrt(), 5e-3))
    .by(move |_| {
        let settings = [
            "stack.isolator.path=\"dish\"".to_owned(),
            "stack.isolator.friction=0".into(),
            format!("stack.isolator.dish_radius=\"{radius} m\""),
            "interface.barrel-rack.friction.coefficient=0.6".into(),
        ];
        let run = one_level(&settings, &push(0.08, 0.15), 6.0)?;
        let samples = displacement(&run, "platform of R1", "x")?;
        period(&samples, 0.3).ok_or_else(|| Failure::Absent("the platform does not swing".into()))
    })
}

/// Returns the period (s) of an oscillating quantity, from its zero crossings after a time (s); `None` without
/// oscillation.
pub(super) fn period(samples: &[(f64, f64)], after: f64) -> Option<f64> {
    let from = samples.partition_point(|(time, _)| *time <= after);
    mean_time(&crossings(&samples[from..]), 3).map(|half| 2.0 * half)
}

fn slides() -> Problem {
    // Under a push `a` of duration `t`, Newmark's block slides backward relative to the ground, by
    // `a t²/2 · (a − μg)/(μg)`.
    let (push_g, seconds, friction) = (0.15, 0.4, 0.05);
    let over: f64 = push_g - friction;
    let exact = 0.5 * over * GRAVITY * seconds * seconds * push_g / friction;
    setting(
        "devices/sheet",
        "a stack on a sliding sheet with μ = 0.05, pushed with 0.15 g for 0.4 s",
        "Newmark 1965",
    )
    .quantity("residual displacement", "m", relative(exact, 1e-2))
    .by(move |_| {
        let settings = [
            "stack.isolator.path=\"flat\"".to_owned(),
            format!("stack.isolator.friction={friction}"),
            "stack.isolator.stroke=\"5 m\"".into(),
            "interface.barrel-rack.friction.coefficient=0.6".into(),
        ];
        let run = one_level(&settings, &push(push_g, seconds), 4.0)?;
        let last = displacement(&run, "platform of R1", "x")?.last().map(|last| last.1.abs());
        last.ok_or_else(|| Failure::Absent("nothing was recorded".into()))
    })
}

fn pads() -> Problem {
    // Two supports at 28°, each of two elements, bear m g; the barrel sinks by δ/cos 28°.
    let (stiffness, angle) = (4e5, 28.0_f64.to_radians());
    let mass = 46.0 + 990.0 * 0.225;
    let exact = mass * GRAVITY / (2.0 * 2.0 * stiffness * cos(angle) * cos(angle));
    setting("devices/pads", "a full barrel on pads of 400 kN/m without friction", "statics")
        .quantity("settlement of the barrel in its cradle", "m", relative(exact, 1e-2))
        .by(move |_| {
            let settings = [
                format!("stack.pad.stiffness=\"{stiffness} N/m\""),
                "stack.pad.friction=0".into(),
                "interface.barrel-rack.friction.coefficient=0".into(),
            ];
            let run = one_level(&settings, &push(1e-6, 0.01), 0.01)?;
            let named = |name: &str| run.assembly.model.body_named(name);
            let (Some(barrel), Some(rack)) = (named("B1.1"), named("R1")) else {
                return Err(Failure::Absent("no barrel on its rack".into()));
            };
            let bodies = run.assembly.model.bodies();
            let drawn = bodies[barrel].pose.position.z - bodies[rack].pose.position.z;
            let rest = run.fates.rest(barrel).z - run.fates.rest(rack).z;
            Ok(drawn - rest)
        })
}

const MASS: f64 = 100.0;

/// Creates a mass that moves at a speed (m/s) without gravity and is joined to the ground by an element.
fn flying(
    speed: f64,
    element: barrelstack_dynamics::Element<barrelstack_dynamics::Planar>,
) -> Result<Scene, Failure> {
    let mut body = disc("weight", 0.3, MASS, 0.045, Vec2::new(0.0, 3.0));
    body.twist.linear = Vec2::new(speed, 0.0);
    let mut model = Model::new(vec![floor(), body], vec![], vec![], Vec2::default())?;
    model.fasten(vec![element])?;
    Ok(Scene::of(model))
}

fn joined(from: Vec2) -> Link<barrelstack_dynamics::Planar> {
    Link { name: "element".into(), bodies: [0, 1], points: [from, Vec2::default()] }
}

fn yields() -> Problem {
    let (stiffness, force, speed) = (1e5, 2e3, 1.2);
    let exact = (0.5 * MASS * speed * speed - 0.5 * force * force / stiffness) / force;
    setting(
        "devices/tie-yields",
        "a weight caught by a slack tie that yields at 2 kN",
        "energy: ½ m v² = F²/2k + F Δ",
    )
    .quantity("permanent elongation of the tie", "m", relative(exact, 1e-5).fast(1e-4))
    .by(move |effort| {
        let tie = Strap {
            link: joined(Vec2::new(-1.0, 3.0)),
            length: 1.05,
            stiffness,
            damping: 0.0,
            yields_at: force,
            strength: f64::INFINITY,
        };
        let mut scene = flying(speed, tie.into())?;
        scene.run(&Still, if effort == Effort::Full { 1e-5 } else { 1e-4 }, 0.4)?;
        Ok(scene.state.memory[0].plastic)
    })
}

fn between_stops() -> Problem {
    let (gap, speed, omega) = (0.02, 0.3, 60.0);
    setting("devices/stops", "a weight between two elastic stops at ±2 cm", "4 δ/v + 2π/ω")
        .quantity("period", "s", relative(4.0 * gap / speed + TAU / omega, 1e-6).fast(1e-5))
        .by(move |effort| {
            let spring = Guide::spring(joined(Vec2::new(0.0, 3.0)), Vec2::new(1.0, 0.0), 0.0, 0.0);
            let guide = Guide { gap, stop_stiffness: MASS * omega * omega, ..spring };
            let mut scene = flying(speed, guide.into())?;
            let step = if effort == Effort::Full { 1e-5 } else { 5e-5 };
            match run_crossings(&mut scene, step, 1.0, |state| state.poses[1].position.x)?[..] {
                [_, back, ..] => Ok(back),
                _ => Err(Failure::Absent(
                    "the weight does not return to the middle between the stops".into(),
                )),
            }
        })
}

/// Natural frequency (rad/s) of the structure to which a mass is tuned: the square root of stiffness divided by mass.
const OMEGA: f64 = TAU;

/// For a structure with a tuned mass, returns the largest dynamic amplification of its displacement, over all
/// frequencies of a harmonic force.
///
/// The tuned mass is `share` times the mass of the structure. The response to an impulse, which excites all
/// frequencies, is transformed to the frequency domain.
fn largest_answer(share: f64, tuning: Tuning, step: f64) -> Result<f64, Failure> {
    let body = |name: &str, mass: f64, z: f64| Body {
        mass,
        ..disc(name, 0.3, 1.0, 0.045, Vec2::new(0.0, z))
    };
    let mut structure = body("structure", MASS, 3.0);
    structure.twist.linear = Vec2::new(1.0, 0.0);
    let mass = share * MASS;
    let own = tuning.frequency * OMEGA;
    let guide = |bodies: [usize; 2], from: f64, stiffness: f64, damping: f64| {
        let points = [Vec2::new(0.0, from), Vec2::default()];
        let link = Link { name: "guide".into(), bodies, points };
        Guide::spring(link, Vec2::new(1.0, 0.0), stiffness, damping)
    };
    let elements = vec![
        guide([0, 1], 3.0, MASS * OMEGA * OMEGA, 0.0).into(),
        guide([1, 2], 0.0, mass * own * own, 2.0 * tuning.damping_ratio * mass * own).into(),
    ];
    let bodies = vec![floor(), structure, body("mass", mass, 3.0)];
    let mut model = Model::new(bodies, vec![], vec![], Vec2::default())?;
    model.fasten(elements)?;
    let mut scene = Scene::of(model);
    let mut samples = Vec::new();
    scene.watch(&Still, step, 40.0, |state, _, _| {
        samples.push(state.poses[1].position.x);
        ControlFlow::Continue(())
    })?;
    // |X(ω)| of the impulse m v, divided by the static value 1/k; both peaks lie near the frequency of the structure.
    let answer = |omega: f64| {
        let (mut re, mut im) = (0.0, 0.0);
        for (i, x) in samples.iter().enumerate() {
            let phase = omega * step * i as f64;
            re += x * cos(phase);
            im += x * sin(phase);
        }
        (re * re + im * im).sqrt() * step * OMEGA * OMEGA
    };
    let peaks = (0..=60).map(|i| answer(OMEGA * (0.65 + 0.01 * f64::from(i))));
    Ok(peaks.fold(0.0, f64::max))
}

/// Creates two problems for a tuned mass that is `share` times the mass of the structure. The first computes the
/// largest amplification at Den Hartog's tuning. The second finds the best frequency of the tuned mass by a search.
fn den_hartog(share: f64) -> [Problem; 2] {
    let exact = Tuning::den_hartog(share);
    let source = "Den Hartog 1956, section 3.3";
    let title =
        format!("undamped structure with a tuned mass of {share} times the mass of the structure");
    let step = 0.01;
    let peak = setting(format!("devices/tuned-mass-peak-{share}"), title.clone(), source)
        .quantity(
            "largest displacement divided by the static displacement",
            "",
            relative((1.0 + 2.0 / share).sqrt(), 1e-2),
        )
        .by(move |_| largest_answer(share, exact, step));
    let frequency = setting(format!("devices/tuned-mass-frequency-{share}"), title, source)
        .quantity(
            "best frequency of the tuned mass, divided by that of the structure",
            "",
            relative(exact.frequency, 1e-2),
        )
        .by(move |_| {
            let mut best = (f64::INFINITY, exact);
            let mut reach = 0.1;
            let mut middle = Tuning { frequency: 1.0, damping_ratio: 0.2 };
            while reach > 2e-3 {
                for (along, across) in
                    (-2..=2).flat_map(|i| (-2..=2).map(move |j| (f64::from(i), f64::from(j))))
                {
                    let tuning = Tuning {
                        frequency: middle.frequency + 0.5 * reach * along,
                        damping_ratio: middle.damping_ratio * exp(0.5 * reach * 4.0 * across),
                    };
                    let peak = largest_answer(share, tuning, 2.0 * step)?;
                    if peak < best.0 {
                        best = (peak, tuning);
                    }
                }
                middle = best.1;
                reach *= 0.5;
            }
            let note = format!("with a damping of {:.3}, peak {:.3}", best.1.damping_ratio, best.0);
            Ok(Outcome::of(best.1.frequency).noted(note))
        });
    [peak, frequency]
}
