//! Equilibrium under gravity: contact forces, penetration, overhangs, and bodies that stay at rest.

use std::ops::ControlFlow;

use barrelstack_dynamics::contact::restitution;
use barrelstack_dynamics::math::{atan2, cos, sin};
use barrelstack_dynamics::shape::Polygon;
use barrelstack_dynamics::{
    Body, FrictionLaw, Interface, NormalLaw, Planar, Shape, Still, Vec2, settle,
};

use crate::problem::{absolute, border, relative, setting};
use crate::scene::{
    DOWN, Scene, block, centered, coulomb, disc, fixed, floor, ground_of, interface, points, pose,
    rectangle,
};
use crate::{Effort, Failure, GRAVITY, Outcome, Problem, theory};

const SOURCE: &str = "statics";
const MASS: f64 = 40.0;
const STIFFNESS: f64 = 1e7;

/// Distance (m) from the ends of a brick to its nodes. Without this distance, the nodes of a brick would lie exactly at
/// the ends of an equal brick below.
pub(super) const INSET: f64 = 0.02;

fn firm() -> NormalLaw {
    NormalLaw::SpeedGap { stiffness: STIFFNESS, damping: 2e4 }
}

fn rough() -> FrictionLaw {
    coulomb(0.5, STIFFNESS, 1e4)
}

/// Creates a brick whose nodes are slightly inside its ends.
pub(super) fn brick(
    name: &str,
    (length, height): (f64, f64),
    mass: f64,
    (x, z): (f64, f64),
) -> Body<Planar> {
    let mut body = block(name, (length, height), mass, pose(x, z, 0.0));
    let inner: Polygon = rectangle(length - 2.0 * INSET, height);
    body.nodes = vec![fixed(&inner.corner_nodes())];
    body
}

fn column(count: u32) -> Result<Scene, Failure> {
    let mut bodies = vec![floor()];
    for i in 0..count {
        let place = (0.0, 0.1 + 0.2 * f64::from(i));
        bodies.push(brick(&format!("brick {i}"), (0.5, 0.2), MASS, place));
    }
    Ok(Scene::new(bodies, interface(firm(), rough()), DOWN)?.settled(1e-9)?)
}

/// Returns the problems of this module.
pub(super) fn problems() -> Vec<Problem> {
    let mut list = vec![];
    list.extend((1..=5).map(level_force));
    list.push(sink());
    list.extend([0.2, 0.5, 0.8, 1.1].map(cradle));
    list.push(rest());
    list.extend((1..=5).map(overhang));
    list
}

/// Returns the sum of the normal forces (N) between two bodies, regardless of which of them has the nodes.
fn force_between(scene: &Scene, a: usize, b: usize) -> f64 {
    let joins = |pair: usize| {
        let pair = scene.model.pair(pair);
        (pair.contactor, pair.target) == (a, b) || (pair.contactor, pair.target) == (b, a)
    };
    scene.scratch.contacts.iter().filter(|c| joins(c.pair)).map(|c| c.normal_force).sum()
}

fn level_force(level: usize) -> Problem {
    let exact = (6 - level) as f64 * MASS * GRAVITY;
    setting(
        format!("gravity/level-{level}"),
        format!("five bricks in a column, force under level {level}"),
        SOURCE,
    )
    .quantity("normal force", "N", relative(exact, 1e-8)) // measured 9e-10
    .by(move |_| Ok(force_between(&column(5)?, level - 1, level)))
}

fn sink() -> Problem {
    let exact = 5.0 * MASS * GRAVITY / (2.0 * STIFFNESS);
    setting("gravity/sink", "five bricks in a column, the lowest on two nodes", SOURCE)
        .quantity("penetration of the lowest brick", "m", relative(exact, 1e-8)) // measured 3e-10
        .by(|_| Ok(0.1 - column(5)?.state.poses[1].position.z))
}

/// Creates a disc of a radius (m) that rests on two points of the ground, at plus and minus an angle (rad) from the
/// vertical.
pub(super) fn on_two_points(
    disc: Body<Planar>,
    radius: f64,
    angle: f64,
    laws: Interface<Planar>,
) -> Result<Scene, Failure> {
    let point = |side: f64| Vec2::new(side * radius * sin(angle), -radius * cos(angle));
    let ground = Body { nodes: vec![points(&[point(-1.0), point(1.0)])], ..ground_of(vec![]) };
    let disc = Body { nodes: vec![], ..disc };
    Ok(Scene::new(vec![ground, disc], laws, DOWN)?)
}

fn cradle(angle: f64) -> Problem {
    let mass = 275.0;
    let exact = mass * GRAVITY / (2.0 * cos(angle));
    setting(
        format!("gravity/cradle-{angle}"),
        format!("disc of 275 kg on two frictionless points at ±{angle} rad"),
        SOURCE,
    )
    // The disc sinks, so the points touch it a little higher; the effect vanishes with increasing stiffness.
    .quantity("normal force of one point", "N", relative(exact, 1e-4))
    .by(move |_| {
        let (radius, stiffness) = (0.35, 1e9);
        let barrel = disc("barrel", radius, mass, 0.06, Vec2::default());
        let damping = restitution::damping(stiffness, 0.5, mass);
        let normal = NormalLaw::SpeedGap { stiffness, damping };
        let laws = interface(normal, FrictionLaw::Frictionless);
        let scene = on_two_points(barrel, radius, angle, laws)?.settled(1e-10)?;
        let found = scene.scratch.contacts.iter().map(|c| c.normal_force).fold(0.0, f64::max);
        let sunk = -scene.state.poses[1].position.z;
        let steeper = atan2(radius * sin(angle), radius * cos(angle) - sunk);
        let there = mass * GRAVITY / (2.0 * cos(steeper));
        Ok(Outcome::of(found).noted(format!(
            "relative error if the penetration is taken into account: {:.1e}",
            (found / there - 1.0).abs()
        )))
    })
}

fn rest() -> Problem {
    setting(
        "gravity/rest",
        "five bricks in a column, one minute (six seconds in the fast form)",
        SOURCE,
    )
    .quantity("largest drift", "m", absolute(0.0, 1e-6)) // measured 1.2e-13
    .by(|effort| {
        let mut scene = column(5)?;
        let start: Vec<Vec2> = scene.state.poses.iter().map(|p| p.position).collect();
        let mut drift = 0.0_f64;
        let end = if effort == Effort::Full { 60.0 } else { 6.0 };
        scene.watch(&Still, 2e-4, end, |state, _, _| {
            for (pose, start) in state.poses.iter().zip(&start) {
                drift = drift.max((pose.position - *start).length());
            }
            ControlFlow::Continue(())
        })?;
        Ok(drift)
    })
}

/// Returns `true` if a stack of `n` bricks stands. The overhangs of the bricks are `share` times the
/// harmonic overhangs.
fn stands(n: u32, share: f64) -> Result<bool, Failure> {
    let (length, height) = (1.0, 0.2);
    // The lowest brick lies on a table that ends at x = 0; brick i from the top overhangs the brick below by L/2i.
    let table = rectangle(4.0, 1.0);
    let mut ground = ground_of(vec![centered(Shape::Polygon(table.clone()))]);
    ground.pose = pose(-2.0, -0.5, 0.0);
    ground.nodes = vec![fixed(&table.corner_nodes())];
    let mut bodies = vec![ground];
    let mut edge = 0.0;
    for i in (1..=n).rev() {
        edge += share * 0.5 * length / f64::from(i);
        let at = pose(edge - 0.5 * length, height * (f64::from(n - i) + 0.5), 0.0);
        bodies.push(block(&format!("brick {i}"), (length, height), MASS, at));
    }
    let mut scene = Scene::new(bodies, interface(firm(), rough()), DOWN)?;
    Ok(settle(&scene.model, &mut scene.state, &mut scene.scratch, 1e-7).is_ok())
}

fn overhang(n: u32) -> Problem {
    let exact = theory::overhang(n, 1.0);
    setting(
        format!("gravity/overhang-{n}"),
        match n {
            1 => "a brick of 1 m that overhangs the end of a table".into(),
            _ => format!("{n} equal bricks of 1 m that overhang the end of a table"),
        },
        "the harmonic stack",
    )
    .quantity("farthest overhang", "m", relative(exact, 5e-3).fast(1.2e-2))
    .by(move |effort| {
        let halvings = if effort == Effort::Full { 6 } else { 0 };
        let found = border((0.99, 1.01), halvings, |share| Ok(!stands(n, share)?))?;
        Ok(found * exact)
    })
}
