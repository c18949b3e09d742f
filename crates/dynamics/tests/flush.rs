//! Equal bodies that are flush with each other: corners, edges and faces coincide exactly or nearly.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use std::f64::consts::FRAC_PI_2;

use barrelstack_dynamics::shape::BarrelProfile;
use barrelstack_dynamics::solid::{Barrel, Block, Hull};
use barrelstack_dynamics::{
    Body, Interface, Model, Node, Nodes, NormalLaw, Planar, Quaternion, Shape, Space, Spatial,
    Still, Vec2, Vec3,
};
use barrelstack_scenes::scene::{
    DOWN, Scene, centered, coulomb, floor, interface, pose, rectangle,
};
use barrelstack_scenes::{GRAVITY, spatial};

const MASS: f64 = 100.0;
const STIFFNESS: f64 = 1e7;
/// Typical lateral offsets (m) of bodies: rounding, round numbers of scenes, and half a body.
const ASIDE: [f64; 10] = [0.0, 1e-16, 1e-12, 1e-10, 1e-9, 3e-9, 1e-6, 1e-5, 1e-4, 1e-3];

fn laws<S: Space<Real = f64>>() -> Interface<S> {
    let normal = NormalLaw::SpeedGap { stiffness: STIFFNESS, damping: 4e4 };
    interface(normal, coulomb(0.5, STIFFNESS, 1e3))
}

/// Kind of contact of a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Touching {
    Exact,
    Corners,
}

fn body(shape: Shape, touching: Touching, x: f64, z: f64, turn: f64) -> Body<Planar> {
    let nodes = match touching {
        Touching::Exact => Nodes::Rounds(shape.rounds(1.0)),
        Touching::Corners => Nodes::Fixed(
            shape
                .nodes(f64::INFINITY)
                .iter()
                .map(|node| Node {
                    position: node.position,
                    tributary_length: 1.0,
                    outward: shape.outward(node.position),
                })
                .collect(),
        ),
    };
    Body {
        surfaces: vec![centered(shape)],
        nodes: vec![nodes],
        ..Body::free("box", MASS, MASS * 0.5 * 0.5 / 6.0, pose(x, z, turn))
    }
}

/// Asserts that stacked bodies come to rest and stay; returns their settlements (m), the lowest first.
fn rests(what: &str, bodies: Vec<Body<Planar>>, seconds: f64) -> Vec<f64> {
    let named = |(i, body)| Body { name: format!("body {i}"), ..body };
    let bodies = bodies.into_iter().enumerate().map(named).collect();
    let all = [vec![floor()], bodies].concat();
    let pairs = barrelstack_scenes::scene::all_pairs(&all)
        .into_iter()
        // Corner nodes are tested on the upper body only, as in a scene whose interfaces name the kinds in order.
        .filter(|pair| {
            !matches!(all[pair.contactor].nodes[..], [Nodes::Fixed(_)])
                || pair.contactor > pair.target
        })
        .collect();
    let model = Model::new(all, vec![laws()], pairs, DOWN)
        .unwrap_or_else(|error| panic!("{what}: {error}"));
    let mut scene = Scene::of(model);
    let start: Vec<Vec2> = scene.state.poses.iter().map(|pose| pose.position).collect();
    scene.settle(1e-9).unwrap_or_else(|error| panic!("{what}: {error}"));
    let rest: Vec<Vec2> = scene.state.poses.iter().map(|pose| pose.position).collect();
    scene.run(&Still, 1e-4, seconds).unwrap();
    for (pose, rest) in scene.state.poses.iter().zip(&rest) {
        let moved = (pose.position - *rest).length();
        assert!(moved < 1e-9, "{what}: moves by {moved:.1e} m after it came to rest");
    }
    rest.iter().zip(&start).skip(1).map(|(rest, start)| start.z - rest.z).collect()
}

/// Asserts that every body has settled by the deformation of its two springs and of those below it.
fn sinks_by_its_springs(what: &str, sunk: &[f64], tolerance: f64) {
    let count = sunk.len();
    let mut below = 0.0;
    for (level, depth) in sunk.iter().enumerate() {
        below += (count - level) as f64 * MASS * GRAVITY / (2.0 * STIFFNESS);
        let error = (depth - below).abs();
        assert!(error < tolerance, "{what}, level {level}: {depth:.9} m instead of {below:.9} m");
    }
}

#[test]
fn a_box_rests_on_an_equal_box_wherever_it_stands() {
    let square = || Shape::Polygon(rectangle(0.5, 0.5));
    for touching in [Touching::Exact, Touching::Corners] {
        // Only the corners of the upper box carry it, so all of them must be on the lower box.
        let most = if touching == Touching::Corners { 1e-10 } else { 1.0 };
        let wanted = ASIDE.into_iter().filter(|aside| *aside <= most);
        for aside in wanted.flat_map(|aside| [aside, -aside]) {
            for turns in 0..4 {
                let turn = f64::from(turns) * FRAC_PI_2;
                for upside in [0.0, turn] {
                    let what = format!("{touching:?}, {aside} m aside, turned {turn} on {upside}");
                    let bodies = vec![
                        body(square(), touching, 0.0, 0.25, upside),
                        body(square(), touching, aside, 0.75, turn),
                    ];
                    let sunk = rests(&what, bodies, 0.05);
                    // At an offset the loads of both springs differ by about this amount.
                    sinks_by_its_springs(&what, &sunk, 1e-9 + 1e-3 * aside.abs());
                }
            }
        }
    }
}

#[test]
fn boxes_half_aside_rest() {
    for aside in [0.2, 0.1, -0.1, -0.2] {
        let square = || Shape::Polygon(rectangle(0.5, 0.5));
        let bodies = vec![
            body(square(), Touching::Exact, 0.0, 0.25, 0.0),
            body(square(), Touching::Exact, aside, 0.75, 0.0),
        ];
        rests(&format!("{aside} m aside"), bodies, 0.05);
    }
}

#[test]
fn columns_of_ten_boxes_stand() {
    for touching in [Touching::Exact, Touching::Corners] {
        let asides: &[f64] =
            if touching == Touching::Exact { &[0.0, 1e-12, 1e-6, 1e-4] } else { &[0.0, 1e-12] };
        for aside in asides {
            let square = || Shape::Polygon(rectangle(0.5, 0.5));
            let level = |i: i32| {
                let (i, odd) = (f64::from(i), f64::from(i % 2));
                body(square(), touching, aside * odd, 0.25 + 0.5 * i, FRAC_PI_2 * i)
            };
            let what = format!("ten boxes, {touching:?}, every other {aside} m aside");
            let sunk = rests(&what, (0..10).map(level).collect(), 1.0);
            sinks_by_its_springs(&what, &sunk, 1e-8 + 0.1 * aside);
        }
    }
}

/// Barrels on their heads, with sharp edges.
#[test]
fn a_profile_rests_on_the_head_of_an_equal_one() {
    for aside in ASIDE {
        let profile = || Shape::BarrelProfile(BarrelProfile::new(0.95, 0.555, 0.69).unwrap());
        let bodies = vec![
            body(profile(), Touching::Exact, 0.0, 0.475, FRAC_PI_2),
            body(profile(), Touching::Exact, aside, 1.425, -FRAC_PI_2),
        ];
        let what = format!("heads {aside} m aside");
        let sunk = rests(&what, bodies, 0.05);
        sinks_by_its_springs(&what, &sunk, 1e-9 + 1e-3 * aside);
    }
}

/// Asserts that stacked three-dimensional blocks, each at a position and rotation, come to rest; returns their
/// settlements (m).
fn blocks_rest(
    what: &str,
    hull: Hull,
    blocks: &[(Vec3, Quaternion)],
    turned_pairs: bool,
    seconds: f64,
) -> Vec<f64> {
    let inertia = MASS * 0.5 * 0.5 / 6.0;
    let mut bodies = vec![spatial::floor()];
    for (i, (place, turn)) in blocks.iter().enumerate() {
        let inertia = Vec3::new(inertia, inertia, inertia);
        let mut body = spatial::solid(&format!("block {i}"), hull, MASS, inertia, *place);
        body.pose.orientation = *turn;
        bodies.push(body);
    }
    let pairs = (1..bodies.len())
        .map(|upper| {
            if turned_pairs && upper > 1 {
                barrelstack_scenes::scene::pair(upper - 1, upper)
            } else {
                barrelstack_scenes::scene::pair(upper, upper - 1)
            }
        })
        .collect();
    let down = Vec3::new(0.0, 0.0, -GRAVITY);
    let mut scene: Scene<Spatial> =
        Scene::of(Model::new(bodies, vec![laws()], pairs, down).unwrap());
    let start: Vec<Vec3> = scene.state.poses.iter().map(|pose| pose.position).collect();
    scene.settle(1e-9).unwrap_or_else(|error| panic!("{what}: {error}"));
    let rest: Vec<Vec3> = scene.state.poses.iter().map(|pose| pose.position).collect();
    scene.run(&Still, 1e-4, seconds).unwrap();
    for (pose, rest) in scene.state.poses.iter().zip(&rest) {
        let moved = (pose.position - *rest).length();
        assert!(moved < 1e-9, "{what}: moves by {moved:.1e} m after it came to rest");
    }
    rest.iter().zip(&start).skip(1).map(|(rest, start)| start.z - rest.z).collect()
}

fn cube() -> Hull {
    let half = Vec3::new(0.245, 0.245, 0.245);
    Hull::Block(Block { half, rounding: 0.005 })
}

/// Asserts that four springs bear a block, however its faces overlap.
fn sinks_by_four(what: &str, sunk: &[f64], tolerance: f64) {
    let doubled: Vec<f64> = sunk.iter().map(|depth| 2.0 * depth).collect();
    sinks_by_its_springs(what, &doubled, 2.0 * tolerance);
}

/// Returns a rotation about the vertical, on any face.
fn turned(about_up: f64, face: u32) -> Quaternion {
    let onto = match face {
        0 => Vec3::default(),
        1..=3 => Vec3::new(f64::from(face) * FRAC_PI_2, 0.0, 0.0),
        _ => Vec3::new(0.0, (f64::from(face) - 4.5) * 2.0 * FRAC_PI_2, 0.0),
    };
    Quaternion::turn(Vec3::new(0.0, 0.0, about_up)).after(Quaternion::turn(onto))
}

#[test]
fn a_block_rests_on_an_equal_block_however_they_are_flush() {
    let asides = ASIDE.into_iter().flat_map(|x| [[x, 0.0], [-x, x], [0.0, -x]]);
    for [x, y] in asides {
        for face in 0..6 {
            let aside = x.abs().max(y.abs());
            for (turn, slack) in
                [(0.0, 0.0), (FRAC_PI_2, 0.0), (1e-6, 1e-6), (0.3, 0.0), (0.785, 0.0)]
            {
                for turned_pairs in [false, true] {
                    let what = format!("face {face}, ({x}, {y}) m aside, turned {turn}");
                    let blocks = [
                        (Vec3::new(0.0, 0.0, 0.25), turned(0.0, (face + 1) % 6)),
                        (Vec3::new(x, y, 0.75), turned(turn, face)),
                    ];
                    let sunk = blocks_rest(&what, cube(), &blocks, turned_pairs, 0.01);
                    sinks_by_four(&what, &sunk, 2e-9 + 1e-3 * (aside + slack));
                }
            }
        }
    }
}

#[test]
fn blocks_that_overhang_rest() {
    for [x, y] in [[0.2, 0.0], [0.1, 0.1], [-0.1, 0.15], [0.0, -0.2]] {
        for turn in [0.0, 0.2, 0.785, FRAC_PI_2] {
            let blocks = [
                (Vec3::new(0.0, 0.0, 0.25), turned(0.0, 0)),
                (Vec3::new(x, y, 0.75), turned(turn, 0)),
            ];
            blocks_rest(
                &format!("({x}, {y}) m aside, turned {turn}"),
                cube(),
                &blocks,
                false,
                0.05,
            );
        }
    }
}

#[test]
fn columns_of_ten_blocks_stand() {
    for (aside, turn) in [(0.0, 0.0), (1e-12, 0.0), (1e-4, FRAC_PI_2), (0.0, 0.1)] {
        let level = |i: i32| {
            let (i, odd) = (f64::from(i), f64::from(i % 2));
            (Vec3::new(aside * odd, 0.0, 0.25 + 0.5 * i), turned(turn * i, 0))
        };
        let what = format!("ten blocks, {aside} m aside, turned {turn}");
        let blocks: Vec<_> = (0..10).map(level).collect();
        let sunk = blocks_rest(&what, cube(), &blocks, false, 0.2);
        sinks_by_four(&what, &sunk, 1e-8 + 0.1 * aside);
    }
}

#[test]
fn a_barrel_rests_on_the_head_of_an_equal_one() {
    let barrel = Hull::Barrel(Barrel::new(0.95, 0.2775, 0.345, 0.01).unwrap());
    for aside in ASIDE {
        let upright = Quaternion::turn(Vec3::new(0.0, -FRAC_PI_2, 0.0));
        let blocks =
            [(Vec3::new(0.0, 0.0, 0.475), upright), (Vec3::new(aside, 0.0, 1.425), upright)];
        let what = format!("heads {aside} m aside");
        let sunk = blocks_rest(&what, barrel, &blocks, false, 0.01);
        sinks_by_four(&what, &sunk, 2e-9 + 1e-3 * aside);
    }
}
