//! The order of bodies: which of two is listed first, and so which is the contactor, changes no result.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use barrelstack_dynamics::shape::BarrelProfile;
use barrelstack_dynamics::solid::{Barrel, Block, Capsule, Hull};
use barrelstack_dynamics::{
    Body, ContactPair, Interface, Model, Nodes, NormalLaw, Planar, Pose, Quaternion, Shape, Space,
    Spatial, Still, Twist, Vec2, Vec3,
};
use barrelstack_scenes::scene::{DOWN, Scene, centered, coulomb, disc, floor, pose, rectangle};
use barrelstack_scenes::{GRAVITY, scene, spatial};

/// Tolerance of positions (m) over the first second: rounding, which collisions amplify.
const TOLERANCE: f64 = 1e-9;

fn laws<S: Space<Real = f64>>(stiffness: f64) -> Interface<S> {
    let normal = NormalLaw::SpeedGap { stiffness, damping: 2e-3 * stiffness };
    scene::interface(normal, coulomb(0.35, 0.7 * stiffness, 1e-3 * stiffness))
}

/// Pairs as a free scene has them: a circle and a box are one pair.
fn pairs<S: Space>(bodies: &[Body<S>]) -> Vec<ContactPair> {
    let rolls = |id: usize| matches!(bodies[id].nodes[..], [Nodes::Rolling { .. }]);
    let rounds = |id: usize| matches!(bodies[id].nodes[..], [Nodes::Rounds(_)]);
    let mut pairs = scene::all_pairs(bodies);
    pairs.retain(|pair| !(rounds(pair.contactor) && rolls(pair.target)));
    pairs
}

/// Runs a scene and returns the poses of its bodies every 0.1 s, in the order of the bodies, and their speeds.
fn run<S: Space<Real = f64>>(
    bodies: &[Body<S>],
    order: &[usize],
    stiffness: f64,
    gravity: S::Vector,
    seconds: f64,
) -> (Vec<Vec<Pose<S>>>, bool) {
    let ordered: Vec<_> = order.iter().map(|i| bodies[*i].clone()).collect();
    let pairs = pairs(&ordered);
    let mut scene = Scene::of(Model::new(ordered, vec![laws(stiffness)], pairs, gravity).unwrap());
    let place = |body: usize| order.iter().position(|i| *i == body).unwrap();
    let mut seen = vec![];
    let mut touched = false;
    for tenth in 1..=(seconds * 10.0).round() as u32 {
        scene
            .watch(&Still, 1e-4, 0.1 * f64::from(tenth), |_, scratch, _| {
                touched |= scratch.pair_forces.iter().any(|pair| {
                    bodies[order[pair.contactor]].name != "ground"
                        && bodies[order[pair.target]].name != "ground"
                });
                std::ops::ControlFlow::Continue(())
            })
            .unwrap();
        seen.push((0..bodies.len()).map(|body| scene.state.poses[place(body)]).collect());
    }
    (seen, touched)
}

/// Asserts that any order of bodies gives the same positions; the first body is the ground, which may be listed last.
fn any_order<S: Space<Real = f64>>(
    what: &str,
    bodies: &[Body<S>],
    stiffness: f64,
    gravity: S::Vector,
    seconds: f64,
) -> f64 {
    let listed: Vec<usize> = (0..bodies.len()).collect();
    let (expected, touched) = run(bodies, &listed, stiffness, gravity, seconds);
    assert!(touched, "{what}: the bodies do not meet");
    let ground = usize::from(bodies[0].name == "ground");
    let mut reversed = listed.clone();
    reversed[ground..].reverse();
    let mut last = listed.clone();
    last.rotate_left(1);
    let mut worst = 0.0_f64;
    for order in [reversed, last] {
        let (found, _) = run(bodies, &order, stiffness, gravity, seconds);
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            let apart = found.position - expected.position;
            worst = worst.max(S::length_bound(apart));
            worst = worst.max(0.3 * S::angle_between(found.orientation, expected.orientation));
        }
    }
    println!("{what}: {worst:.1e} m");
    worst
}

fn assert_within(what: &str, worst: f64) {
    assert!(worst <= TOLERANCE, "{what}: another order of bodies moves them by {worst:.1e} m");
}

fn thrown(mut body: Body<Planar>, x: f64, z: f64, angular: f64) -> Body<Planar> {
    body.twist = Twist { linear: Vec2::new(x, z), angular };
    body
}

fn planar(name: &str, shape: Shape, mass: f64, pose: Pose<Planar>) -> Body<Planar> {
    Body {
        nodes: vec![Nodes::Rounds(shape.rounds(1.0))],
        surfaces: vec![centered(shape)],
        ..Body::free(name, mass, mass * 0.05, pose)
    }
}

/// Bodies of the plane about a place (m), of every kind that touches exactly.
fn kinds(x: f64, z: f64, angle: f64, mass: f64) -> Vec<(&'static str, Body<Planar>)> {
    let at = pose(x, z, angle);
    let rounded = barrelstack_dynamics::shape::Polygon::rectangle(0.5, 0.4, 0.05).unwrap();
    let profile = BarrelProfile::new(0.7, 0.4, 0.5).unwrap();
    let one = disc("disc", 0.3, mass, 0.045, Vec2::new(x, z));
    vec![
        ("circle", one),
        ("box", planar("box", Shape::Polygon(rectangle(0.5, 0.4)), mass, at)),
        ("rounded box", planar("box", Shape::Polygon(rounded), mass, at)),
        ("barrel", planar("barrel", Shape::BarrelProfile(profile), mass, at)),
    ]
}

#[test]
fn circles_and_boxes_of_the_plane_may_be_listed_in_any_order() {
    for (a, first) in kinds(0.0, 0.4, 0.3, 100.0) {
        for (b, second) in kinds(0.75, 0.5, -0.5, 60.0) {
            for stiffness in [2e6, 2e7] {
                let what = format!("{a} and {b} at {stiffness:.0e} N/m");
                let bodies = [
                    floor(),
                    thrown(first.clone(), 1.5, -0.5, -3.0),
                    Body { name: "other".into(), ..thrown(second.clone(), -0.5, 0.3, 4.0) },
                ];
                assert_within(&what, any_order(&what, &bodies, stiffness, DOWN, 1.0));
            }
        }
    }
}

/// Solids of space at a place (m).
fn solid(kind: usize, mass: f64, place: Vec3, turn: Vec3) -> Body<Spatial> {
    let inertia = Vec3::new(0.02 * mass, 0.03 * mass, 0.035 * mass);
    let hull = match kind {
        0 => return spatial::ball(0.3, mass, place),
        1 => Hull::Capsule(Capsule { half_length: 0.25, radius: 0.15 }),
        2 => Hull::Barrel(Barrel::new(0.7, 0.2, 0.27, 0.02).unwrap()),
        _ => Hull::Block(Block { half: Vec3::new(0.25, 0.2, 0.15), rounding: 0.01 }),
    };
    let mut body = spatial::solid("solid", hull, mass, inertia, place);
    body.pose.orientation = Quaternion::turn(turn);
    body
}

const SOLIDS: [&str; 4] = ["ball", "capsule", "barrel", "block"];

#[test]
fn all_pairs_of_solids_may_be_listed_in_any_order() {
    let down = Vec3::new(0.0, 0.0, -GRAVITY);
    for (a, first) in SOLIDS.iter().enumerate() {
        for (b, second) in SOLIDS.iter().enumerate() {
            let what = format!("{first} and {second}");
            let mut one = solid(a, 100.0, Vec3::new(0.0, 0.0, 0.5), Vec3::new(0.3, 0.5, 0.2));
            one.twist =
                Twist { linear: Vec3::new(1.0, 0.1, 0.0), angular: Vec3::new(1.0, -0.5, 1.5) };
            let mut other = solid(b, 60.0, Vec3::new(0.75, 0.04, 0.55), Vec3::new(-0.4, 0.3, 0.9));
            other.twist =
                Twist { linear: Vec3::new(-0.5, 0.0, 0.3), angular: Vec3::new(-0.5, 1.0, 0.5) };
            other.name = "other".into();
            let flying = [one.clone(), other.clone()];
            let worst = any_order(&format!("{what}, flying"), &flying, 2e6, Vec3::default(), 1.0);
            assert_within(&what, worst); // measured 1.1e-13
            // On a floor collisions amplify rounding by up to thirty times in 0.1 s.
            let bodies = [spatial::floor(), one, other];
            assert_within(&what, any_order(&what, &bodies, 2e6, down, 0.5)); // measured 1.3e-13
        }
    }
}

#[test]
fn four_tumbling_solids_may_be_listed_in_any_order() {
    let down = Vec3::new(0.0, 0.0, -GRAVITY);
    let mut bodies = vec![spatial::floor()];
    for kind in 0..4 {
        let k = kind as f64;
        let place = Vec3::new(0.42 * k - 0.6, 0.03 * k * k, 0.5 + 0.25 * (k - 1.5).abs());
        let mut body = solid(kind, 60.0 + 20.0 * k, place, Vec3::new(0.3 * k, 0.5, 0.2 - 0.2 * k));
        body.twist = Twist {
            linear: Vec3::new(0.8 - 0.6 * k, 0.2 * (k - 1.0), 0.3),
            angular: Vec3::new(2.0 - k, 1.0, k - 3.0),
        };
        body.name = SOLIDS[kind].into();
        bodies.push(body);
    }
    let what = "ball, capsule, barrel and block";
    assert_within(what, any_order(what, &bodies, 2e6, down, 1.0));
}
