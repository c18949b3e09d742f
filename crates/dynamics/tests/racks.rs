//! Barrels on racks of tubes in three dimensions: at rest, mirrored, in any order, and compared with the plane.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows what it measured")]

use std::f64::consts::FRAC_PI_2;

use barrelstack_dynamics::solid::{
    Barrel, Bulk, Capsule, Cask, Fill, Hull, Part, compound, pairs_between,
};
use barrelstack_dynamics::{
    Body, ContactPair, Model, Nodes, NormalLaw, Quaternion, Rotation3, Spatial, Still, Vec2, Vec3,
};
use barrelstack_scenes::scene::{self, Scene, coulomb, interface};
use barrelstack_scenes::spatial::{ball, floor, gravity_on_slope, solid, yaw};

const G: f64 = 9.81;

fn bordeaux() -> Barrel {
    Barrel::new(0.945, 0.2775, 0.345, 0.01).unwrap()
}

/// Returns a rack for two barrels side by side along `y`: two beams across the barrels, on the floor or on the barrels
/// below, and rails along `x` that form the cradles.
fn rack(name: &str, height: f64, reversed: bool) -> Body<Spatial> {
    let along = Rotation3::identity();
    let across = yaw(FRAC_PI_2).matrix();
    let part = |half_length: f64, center: Vec3, rotation: Rotation3| {
        let tube = Capsule { half_length, radius: 0.025 };
        let bulk = Bulk::of_hollow(&tube, 5.0 * half_length);
        Part { hull: Hull::Capsule(tube), center, rotation, bulk }
    };
    let mut parts = vec![];
    for x in [-0.27, 0.27] {
        parts.push(part(0.75, Vec3::new(x, 0.0, 0.0), across));
    }
    for column in [-0.38, 0.38] {
        for side in [-0.16, 0.16] {
            parts.push(part(0.35, Vec3::new(0.0, column + side, 0.05), along));
        }
    }
    if reversed {
        parts.reverse();
    }
    let mut body = compound(name, &parts, 1.0);
    body.pose.position.z += height;
    body
}

fn barrel(name: &str, y: f64, height: f64) -> Body<Spatial> {
    let cask = Cask { barrel: bordeaux(), wall: 0.025, chime: 0.063, wood: 48.0, density: 982.0 };
    let bulk = cask.bulk(Fill::Frozen);
    let place = Vec3::new(0.0, y, height);
    solid(name, Hull::Barrel(bordeaux()), bulk.mass, bulk.principal().0, place)
}

/// Returns a stack with a number of levels, each with a rack and two barrels.
fn stack(levels: usize, reversed: bool) -> Scene<Spatial> {
    let mut bodies = vec![floor()];
    let mut pairs: Vec<ContactPair> = vec![];
    // A barrel lies 0.32 m above its rails, a rack on the crown of the barrels below.
    let (mut height, mut below) = (0.025, vec![0]);
    for level in 0..levels {
        bodies.push(rack(&format!("rack {level}"), height, reversed));
        let rack = bodies.len() - 1;
        for on in &below {
            pairs.extend(pairs_between(&bodies, rack, *on, 0));
        }
        let axis = height + 0.05 + 0.333;
        below = vec![];
        for (column, y) in [-0.38, 0.38].into_iter().enumerate() {
            bodies.push(barrel(&format!("barrel {level} {column}"), y, axis));
            let barrel = bodies.len() - 1;
            pairs.extend(pairs_between(&bodies, barrel, rack, 0));
            below.push(barrel);
        }
        pairs.extend(pairs_between(&bodies, below[0], below[1], 0));
        height = axis + 0.345 + 0.025;
    }
    let law = NormalLaw::SpeedGap { stiffness: 1e6, damping: 1e3 };
    let laws = interface(law, coulomb(0.4, 1e6, 300.0));
    let gravity = Vec3::new(0.0, 0.0, -G);
    Scene::of(Model::new(bodies, vec![laws], pairs, gravity).unwrap())
}

/// Returns the upward force (N) on a body from its contacts as contactor.
fn pressed(scene: &Scene<Spatial>, contactor: usize) -> f64 {
    let on =
        |force: &&barrelstack_dynamics::forces::PairForce<Spatial>| force.contactor == contactor;
    scene.scratch.pair_forces.iter().filter(on).map(|force| force.force.z).sum()
}

#[test]
fn a_stack_of_racks_and_barrels_settles_and_its_seats_bear_its_weight() {
    for levels in [1, 2] {
        let scene = stack(levels, false).settled(1e-9).unwrap();
        let bodies = scene.model.bodies();
        let free: f64 = bodies[1..].iter().map(|body| body.mass).sum();
        // The lowest rack transfers the whole weight to the floor.
        let floor = pressed(&scene, 1);
        println!("{levels}: {floor} {}", free * G);
        assert!((floor / (free * G) - 1.0).abs() < 1e-6); // measured 2e-11
        // Every top barrel is carried by its rack.
        let top = scene.model.bodies().len() - 1;
        let weight = bodies[top].mass * G;
        assert!((pressed(&scene, top) / weight - 1.0).abs() < 1e-6);
        let seats =
            scene.scratch.contacts.iter().filter(|c| scene.model.pair(c.pair).contactor == top);
        assert_eq!(seats.count(), 2);
        // The stack stays at rest.
        let mut scene = scene;
        let before = scene.state.poses[top].position;
        scene.run(&Still, 1e-4, 1.0).unwrap();
        let moved = (scene.state.poses[top].position - before).length();
        println!("moved {moved:e}");
        assert!(moved < 1e-9, "{moved:e}"); // measured 5e-14
    }
}

#[test]
fn in_which_order_the_parts_of_a_rack_are_told_changes_nothing_but_rounding() {
    let run = |reversed| {
        let mut scene = stack(2, reversed).settled(1e-9).unwrap();
        scene.state.twists[1].linear = Vec3::new(0.2, 0.3, 0.0);
        scene.run(&Still, 1e-4, 0.05).unwrap();
        scene.state.poses
    };
    let mut worst = 0.0_f64;
    for (one, other) in run(false).into_iter().zip(run(true)) {
        worst = worst.max((one.position - other.position).length());
    }
    println!("{worst:e}");
    assert!(worst < 1e-9, "{worst:e}"); // measured 2e-16
}

#[test]
fn a_barrel_thrown_to_the_other_side_does_the_mirrored_bit_for_bit() {
    let run = |side: f64| {
        let mut body = barrel("barrel", side * 0.1, 0.5);
        let turn = Vec3::new(side * 0.2, 0.3, side * -0.4);
        body.pose.orientation = Quaternion::turn(turn);
        body.twist.linear = Vec3::new(0.3, side * 0.7, -0.5);
        body.twist.angular = Vec3::new(side * 1.0, -2.0, side * 0.7);
        let law = NormalLaw::SpeedGap { stiffness: 1e6, damping: 1e4 };
        let laws = interface(law, coulomb(0.4, 1e6, 1e3));
        let gravity = Vec3::new(0.0, 0.0, -G);
        let mut scene: Scene<Spatial> = Scene::new(vec![floor(), body], laws, gravity).unwrap();
        scene.run(&Still, 2e-4, 2.0).unwrap();
        let (pose, twist) = (scene.state.poses[1], scene.state.twists[1]);
        [
            pose.position.x,
            side * pose.position.y,
            pose.position.z,
            pose.orientation.w,
            side * pose.orientation.v.x,
            pose.orientation.v.y,
            side * pose.orientation.v.z,
            twist.linear.x,
            side * twist.linear.y,
            side * twist.angular.x,
            twist.angular.y,
        ]
        .map(f64::to_bits)
    };
    assert_eq!(run(1.0), run(-1.0));
}

/// The reflections in the planes through the origin that are perpendicular to `x` and to `y`.
const REFLECTIONS: [Vec3; 2] = [Vec3::new(-1.0, 1.0, 1.0), Vec3::new(1.0, -1.0, 1.0)];

/// Mirrors a rotation vector, whose components change sign where those of an ordinary vector do not.
fn turn_mirrored(spin: Vec3, by: Vec3) -> Vec3 {
    -spin.times(by)
}

fn rotation_mirrored(rotation: Rotation3, by: Vec3) -> Rotation3 {
    let [x, y, z] = rotation.rows;
    Rotation3 { rows: [x.times(by) * by.x, y.times(by) * by.y, z.times(by) * by.z] }
}

/// Mirrors a body; its solids keep their order.
fn mirrored(body: &Body<Spatial>, by: Vec3) -> Body<Spatial> {
    let mut image = body.clone();
    image.pose.position = body.pose.position.times(by);
    image.pose.orientation.v = turn_mirrored(body.pose.orientation.v, by);
    image.twist.linear = body.twist.linear.times(by);
    image.twist.angular = turn_mirrored(body.twist.angular, by);
    for placed in &mut image.surfaces {
        placed.offset = placed.offset.times(by);
        placed.rotation = rotation_mirrored(placed.rotation, by);
    }
    for nodes in &mut image.nodes {
        // Barrels and tubes are their own mirror images.
        if let Nodes::Whole(whole) = nodes {
            whole.center = whole.center.times(by);
            whole.rotation = rotation_mirrored(whole.rotation, by);
        }
    }
    image
}

#[test]
fn a_stack_of_racks_that_is_thrown_over_does_the_mirrored_bit_for_bit() {
    let scene = stack(2, false).settled(1e-9).unwrap();
    let mut thrown = scene.model.bodies().to_vec();
    for (body, pose) in thrown.iter_mut().zip(&scene.state.poses) {
        body.pose = *pose;
    }
    thrown[1].twist.linear = Vec3::new(0.9, 0.6, 0.0);
    thrown[4].twist.linear = Vec3::new(1.4, -0.8, 0.3);
    thrown[5].twist.angular = Vec3::new(-1.0, 0.5, 2.0);
    let end = |bodies: Vec<Body<Spatial>>| {
        let (laws, pairs) = (scene.model.interfaces().to_vec(), scene.model.pairs().collect());
        let model = Model::new(bodies, laws, pairs, scene.model.gravity()).unwrap();
        let mut scene = Scene::of(model);
        scene.run(&Still, 1e-4, 1.5).unwrap();
        (scene.state.poses, scene.state.twists)
    };
    let (poses, twists) = end(thrown.clone());
    let turned =
        poses.iter().map(|pose| (1.0 - pose.orientation.w.abs()).max(0.0)).fold(0.0, f64::max);
    assert!(turned > 0.1, "nothing fell: {turned}");
    for by in REFLECTIONS {
        let images = thrown.iter().map(|body| mirrored(body, by)).collect();
        let (there, speeds) = end(images);
        for (at, (pose, image)) in poses.iter().zip(&there).enumerate() {
            assert_eq!(pose.position.times(by), image.position, "body {at} by {by:?}");
            assert_eq!(turn_mirrored(pose.orientation.v, by), image.orientation.v);
            assert_eq!(pose.orientation.w, image.orientation.w);
            assert_eq!(twists[at].linear.times(by), speeds[at].linear);
            assert_eq!(turn_mirrored(twists[at].angular, by), speeds[at].angular);
        }
    }
}

#[test]
fn a_ball_in_a_plane_does_what_the_disc_of_the_plane_does() {
    let (radius, mass, slope) = (0.35, 275.0, 0.2);
    let law = NormalLaw::SpeedGap { stiffness: 1e6, damping: 1e4 };
    let friction = coulomb(0.05, 1e6, 1e3);
    let mut plane: Scene = Scene::new(
        vec![
            scene::floor(),
            scene::disc("disc", radius, mass, 0.4 * radius * radius, Vec2::new(0.0, 0.36)),
        ],
        interface(law, friction),
        scene::gravity_on_slope(slope),
    )
    .unwrap();
    let gravity = gravity_on_slope(barrelstack_scenes::GRAVITY, slope, 0.0);
    let body = ball(radius, mass, Vec3::new(0.0, 0.0, 0.36));
    let mut space: Scene<Spatial> =
        Scene::new(vec![floor(), body], interface(law, friction), gravity).unwrap();
    let mut worst = 0.0_f64;
    for tenth in 1..=20 {
        let end = 0.1 * f64::from(tenth);
        plane.run(&Still, 1e-4, end).unwrap();
        space.run(&Still, 1e-4, end).unwrap();
        let (disc, ball) = (plane.state.poses[1].position, space.state.poses[1].position);
        worst = worst.max((disc.x - ball.x).abs()).max((disc.z - ball.z).abs());
        assert_eq!(ball.y, 0.0);
    }
    println!("{worst:e}");
    assert!(worst < 1e-9, "{worst:e}"); // measured 0
}
