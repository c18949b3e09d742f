//! Eight barrels on four levels: a scene for which five independent codes agree.
//!
//! The scene exists in two versions. *Bodies* is exactly the scene of the five codes, with one contact point between
//! the crown of a barrel and a flat underside. *Scenario* is the most similar stack that a scenario can describe. The
//! undersides of its racks are rows of nodes, several of which press on the same crown, so its contacts are stiffer.
//!
//! The displacement of the ground is A sin ωt from the start, so the ground starts suddenly. This is how the
//! description "sine base motion of 0.1016 m" is interpreted here. The codes do not document their definition of a
//! fall; here a barrel counts as fallen when it is one level (0.76 m) lower than at the start.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use barrelstack::Scenario;
use barrelstack_dynamics::math::{cos, sin};
use barrelstack_dynamics::{Body, ContactPair, Model, ModelError, NormalLaw, Planar, Vec2};

use crate::drive::Shake;
use crate::problem::{absolute, setting};
use crate::scene::{DOWN, Scene, block, coulomb, disc, floor, interface, pair, points, pose};
use crate::{Effort, Failure, Outcome, Problem};

const SOURCE: &str = "MuJoCo (penalty), YADE, Drake, PyBullet (spring) and a plain penalty code";

const RADIUS: f64 = 0.35;
const PITCH: f64 = 0.76;
const CLEARANCE: f64 = 0.06;
const WIDTH: f64 = 1.50;
const BEAM: f64 = 0.04;
const LEVELS: usize = 4;
const STIFFNESS: f64 = 9.8e5;
const DAMPING: f64 = 2200.0;

/// Drops (m) of a barrel. A barrel that drops by the first distance counts as fallen. The second distance shows how
/// much the result depends on this choice.
const FALLS: [f64; 2] = [0.76, 0.2];

/// Length of the runs (s).
const END: f64 = 10.0;

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    vec![
        first_fall(),
        written(),
        verdict("a-scenario", "scene A (±20°) as a scenario", true, |end| scenario(20.0, end)),
        verdict("c-bodies", "scene C (±35°) from bodies", false, |end| {
            bodies(35.0, end).map(|times| times[0])
        }),
        verdict("c-scenario", "scene C (±35°) as a scenario", false, |end| scenario(35.0, end)),
    ]
}

fn first_fall() -> Problem {
    setting("consensus/a-bodies", "scene A (±20°) from bodies", SOURCE)
        // The five codes give 1.64, 1.73, 1.75 to 1.85, 2.0 and 1.69 s. The reference is the middle of the range of
        // these values, and the tolerance is half of its width.
        .quantity("first fall of a barrel", "s", absolute(1.82, 0.18))
        .by(move |_| match bodies(20.0, 3.0)? {
            [Some(time), Some(earlier)] => Ok(Outcome::of(time).noted(format!(
                "five codes: 1.64 s to 2.0 s; a drop of 0.2 m is reached at {earlier:.2} s"
            ))),
            _ => Err(Failure::Absent("nothing falls in 3 s".into())),
        })
}

/// Creates the problem in which the scene is read from a file. The file describes each body and the nodes of the racks.
fn written() -> Problem {
    Problem {
        id: "consensus/a-file".into(),
        title: "scene A (±20°) as a free scene from a file".into(),
        run: Box::new(|_| {
            let text = include_str!("../../cases/five-codes.toml");
            let run = Scenario::parse("five-codes.toml", text, &[])?.run()?;
            let frames = &run.recording.frames;
            let fallen = |poses: &Vec<[f64; 3]>| {
                let dropped = |body: usize| frames.poses[0][body][1] - poses[body][1];
                (1..poses.len()).any(|body| !is_rack(body) && dropped(body) > FALLS[0])
            };
            let fall = frames.poses.iter().position(fallen);
            let fall = fall.ok_or(Failure::Absent("nothing falls in 3 s".into()))?;
            Ok(Outcome::of(frames.times[fall]))
        }),
        ..first_fall()
    }
}

fn verdict(
    id: &str,
    title: &str,
    falls: bool,
    run: fn(f64) -> Result<Option<f64>, Failure>,
) -> Problem {
    setting(format!("consensus/{id}"), title, SOURCE)
        .quantity(
            "whether a barrel falls in 10 s, 0 or 1",
            "",
            absolute(f64::from(u8::from(falls)), 0.0),
        )
        .by(move |effort| {
            let end = if effort == Effort::Full { END } else { 3.0 };
            Ok(match run(end)? {
                None => Outcome::of(0.0).noted(format!("nothing falls in {end} s")),
                Some(time) => Outcome::of(1.0).noted(format!("falls at {time:.2} s")),
            })
        })
}

/// Creates a rack: a beam with two feet and with two support points per barrel. Its feet can touch the ground, and its
/// underside can touch the crowns of the barrels below.
fn rack(level: usize, underside: f64, angle: f64) -> Body<Planar> {
    let center = CLEARANCE + RADIUS - 0.5 * BEAM;
    let mut supports = vec![];
    for side in [-1.0, 1.0] {
        for support in [-1.0, 1.0] {
            supports.push(Vec2::new(
                0.5 * side * PITCH + support * RADIUS * sin(angle),
                center - RADIUS * cos(angle),
            ));
        }
    }
    let foot = |x: f64| Vec2::new(x * WIDTH, -0.5 * BEAM);
    let place = pose(0.0, underside + 0.5 * BEAM, 0.0);
    Body {
        nodes: vec![points(&supports), points(&[foot(-0.5), foot(0.5)])],
        ..block(&format!("R{level}"), (WIDTH, BEAM), 30.0, place)
    }
}

/// Builds the scene of the eight barrels from individual bodies. The two supports of each cradle are at `degrees` to
/// the left and right of the vertical.
///
/// # Errors
/// If the bodies do not form a valid model.
pub fn eight_barrels(degrees: f64) -> Result<Model<Planar>, ModelError> {
    let angle = degrees.to_radians();
    let mut bodies = vec![floor()];
    let pitch = CLEARANCE + 2.0 * RADIUS;
    for level in 0..LEVELS {
        let underside = pitch * level as f64;
        bodies.push(rack(level + 1, underside, angle));
        for (column, side) in [-0.5, 0.5].into_iter().enumerate() {
            let center = Vec2::new(side * PITCH, underside + CLEARANCE + RADIUS);
            let name = format!("B{}.{}", level + 1, column + 1);
            bodies.push(disc(&name, RADIUS, 275.0, 0.5 * RADIUS * RADIUS, center));
        }
    }
    let join = |contactor, nodes, target, interface| ContactPair {
        nodes,
        interface,
        ..pair(contactor, target)
    };
    let mut pairs = vec![];
    for i in 1..bodies.len() {
        // Feet and barrels on the ground.
        pairs.push(join(i, usize::from(is_rack(i)), 0, 0));
        for j in 1..bodies.len() {
            match (is_rack(i), is_rack(j)) {
                // Cradle supports on barrels.
                (true, false) => pairs.push(join(i, 0, j, 1)),
                // Crowns on undersides above; a barrel touches its own rack only at the supports.
                (false, true) if i.div_ceil(3) != j.div_ceil(3) => pairs.push(join(i, 0, j, 1)),
                (false, false) if i < j => pairs.push(join(i, 0, j, 1)),
                _ => {}
            }
        }
    }
    let law = |friction| {
        let normal = NormalLaw::SpeedGap { stiffness: STIFFNESS, damping: DAMPING };
        interface(normal, coulomb(friction, STIFFNESS, DAMPING))
    };
    Model::new(bodies, vec![law(0.5), law(0.22)], pairs, DOWN)
}

/// Returns `true` if the body with the index `body` is a rack. In the list of bodies, each rack is followed by its
/// barrels.
fn is_rack(body: usize) -> bool {
    body > 0 && body % 3 == 1
}

/// Runs the scene that is built from individual bodies. Returns, for each of the two distances in [`FALLS`], the time
/// (s) at which the first barrel has dropped by this distance; `None` if no barrel drops that far.
fn bodies(degrees: f64, end: f64) -> Result<[Option<f64>; 2], Failure> {
    let step = 1e-4;
    let mut scene = Scene::of(eight_barrels(degrees)?).settled(1e-9)?;
    let rest: Vec<f64> = scene.state.poses.iter().map(|p| p.position.z).collect();
    let drive = Shake::Swing { amplitude: 0.1016, omega: TAU / 1.0748 };
    let mut fallen = [None; 2];
    scene.watch(&drive, step, end, |state, _, _| {
        let dropped = |i: usize| {
            if is_rack(i) { 0.0 } else { rest[i] - state.poses[i].position.z }
        };
        let most = (1..rest.len()).map(dropped).fold(0.0, f64::max);
        for (fallen, drop) in fallen.iter_mut().zip(FALLS) {
            if fallen.is_none() && most > drop {
                *fallen = Some(state.time);
            }
        }
        if fallen[0].is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    Ok(fallen)
}

/// Runs the stack that is most similar to the scene and can be described by a scenario. Returns the time (s) at which
/// the first barrel falls; `None` if no barrel falls.
fn scenario(degrees: f64, end: f64) -> Result<Option<f64>, Failure> {
    let text = format!(
        r#"
schema = 1
title = "Consensus scene, supports at ±{degrees}°"
extends = "candia-8-barrels"

[stack]
rack = {{ base = "candia-2008", foot_height = "0 m", clearance = "6 cm", mass = "30 kg", contact = "element", cradle = {{ type = "supports", angle = "{degrees} deg" }} }}

[motion.sine]
amplitude = "0.1016 m"
period = "1.0748 s"
cycles = 12

[run]
duration = "{end} s"
stop_after_collapse = "1 s"
"#
    );
    let scenario = Scenario::parse("consensus.toml", &text, &[])?;
    let run = scenario.run()?;
    Ok(run.fates.first_fall())
}
