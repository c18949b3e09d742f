//! Equilibrium under gravity: forces, overhangs, rest, and bodies that do not stand.

use crate::common;

use crate::common::{
    DOWN, GRAVITY, Scene, assert_close, bits, block, coulomb, disc, fixed, floor, ground_of,
    interface, pose,
};
use barrelstack_dynamics::shape::Polygon;
use barrelstack_dynamics::{
    Body, FrictionLaw, Lack, Node, Nodes, NormalLaw, Planar, SettleError, Still, Vec2, evaluate,
};
use barrelstack_scenes::theory::overhang;

const MASS: f64 = 40.0;
const STIFFNESS: f64 = 1e7;

fn firm() -> NormalLaw {
    NormalLaw::SpeedGap { stiffness: STIFFNESS, damping: 2e4 }
}

fn rough() -> FrictionLaw {
    coulomb(0.5, STIFFNESS, 1e4)
}

/// Returns a brick whose nodes are slightly inside its corners, so that equal bricks can stand on each other.
fn brick(name: &str, (length, height): (f64, f64), x: f64, z: f64) -> Body<Planar> {
    let mut body = block(name, (length, height), MASS, pose(x, z, 0.0));
    let inner = Polygon::rectangle(length - 0.04, height, 0.0).unwrap();
    body.nodes = vec![fixed(&inner.corner_nodes())];
    body
}

/// Returns a column of bricks.
fn column(count: u32) -> Scene {
    let mut bodies = vec![floor()];
    for i in 0..count {
        bodies.push(brick(&format!("brick {i}"), (0.5, 0.2), 0.0, 0.1 + 0.2 * f64::from(i)));
    }
    Scene::new(bodies, interface(firm(), rough()), DOWN).unwrap()
}

#[test]
fn a_settled_state_is_at_rest_at_its_time() {
    let mut scene = column(3);
    scene.state.time = 7.0;
    let settled = scene.settle(1e-9).unwrap();
    assert!(settled.unbalanced < 1e-9 && settled.steps > 10, "{settled:?}");
    assert_eq!(scene.state.time, 7.0);
    for twist in &scene.state.twists {
        assert_eq!((twist.linear.length(), twist.angular), (0.0, 0.0));
    }
    // Settling a settled state changes nothing.
    let before = bits(&scene.state);
    assert_eq!(scene.settle(1e-9).unwrap().steps, 0);
    assert_eq!(bits(&scene.state), before);
}

/// Returns a disc on two points of the ground at ± an angle (rad).
fn cradled(angle: f64, friction: FrictionLaw) -> Scene {
    let radius = 0.35;
    let mut ground = ground_of(vec![]);
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    ground.nodes = vec![Nodes::Fixed(
        [-1.0, 1.0]
            .map(|side| Node {
                position: Vec2::new(side * radius * sin, -radius * cos),
                tributary_length: 1.0,
                outward: None,
            })
            .to_vec(),
    )];
    let mut barrel = disc("barrel", radius, 275.0, 0.06, Vec2::default());
    barrel.nodes = vec![];
    Scene::new(vec![ground, barrel], interface(firm(), friction), DOWN)
        .unwrap()
        .settled(1e-10)
        .unwrap()
}

#[test]
fn a_rough_cradle_carries_the_weight_by_normal_and_friction_forces() {
    let scene = cradled(0.5, rough());
    let (mut lift, mut thrust) = (0.0, 0.0);
    for contact in &scene.scratch.contacts {
        let (force, _) = barrelstack_dynamics::forces::contact_force(
            &scene.model,
            &scene.state,
            &scene.scratch,
            contact,
        );
        // The ground is the contactor, so the opposite force acts on the barrel.
        lift -= force.z;
        thrust += force.x.abs();
        assert!(contact.friction_force.abs() > 1.0, "friction takes part");
    }
    assert_close("lift", lift, 275.0 * GRAVITY, 1e-9); // measured 4e-11
    assert!(thrust > 0.0);
}

/// Returns the harmonic stack: the topmost of `n` bricks overhangs by a share of the largest overhang.
fn harmonic_stack(n: u32, share: f64) -> Scene {
    let (length, height) = (1.0, 0.2);
    // The lowest of the n bricks lies on a table that ends at x = 0; brick i from the top overhangs the brick below by
    // L/2i.
    let table = Polygon::rectangle(4.0, 1.0, 0.0).unwrap();
    let mut ground =
        ground_of(vec![common::centered(barrelstack_dynamics::Shape::Polygon(table.clone()))]);
    ground.pose = pose(-2.0, -0.5, 0.0);
    ground.nodes = vec![fixed(&table.corner_nodes())];
    let mut bodies = vec![ground];
    let mut edge = 0.0;
    for i in (1..=n).rev() {
        edge += share * 0.5 * length / f64::from(i);
        let level = f64::from(n - i);
        bodies.push(block(
            &format!("brick {i}"),
            (length, height),
            MASS,
            pose(edge - 0.5 * length, height * (level + 0.5), 0.0),
        ));
    }
    assert!((edge - share * overhang(n, length)).abs() < 1e-12);
    Scene::new(bodies, interface(firm(), rough()), DOWN).unwrap()
}

#[test]
fn bricks_stand_just_inside_the_harmonic_overhang_and_fall_just_outside() {
    for n in 1..=5 {
        let mut inside = harmonic_stack(n, 0.99);
        inside.settle(1e-7).unwrap_or_else(|e| panic!("{n} bricks at 99 %: {e}"));
        let rest: Vec<Vec2> = inside.state.poses.iter().map(|p| p.position).collect();
        inside.run(&Still, 2e-4, 2.0).unwrap();
        for (pose, rest) in inside.state.poses.iter().zip(&rest) {
            assert!((pose.position - *rest).length() < 1e-4, "{n} bricks move at 99 %");
        }
        let mut outside = harmonic_stack(n, 1.01);
        let lost = outside.settle(1e-7);
        let lack = lost.map_err(|error| error.lack);
        assert!(matches!(lack, Err(Lack::Balance { .. })), "{n} bricks at 101 %: {lack:?}");
    }
}

#[test]
fn a_body_in_the_air_does_not_settle_and_is_named() {
    let resting = brick("resting", (0.5, 0.2), 0.0, 0.1);
    let hanging = disc("hanging", 0.2, 10.0, 0.02, Vec2::new(1.0, 8.0));
    let mut scene =
        Scene::new(vec![floor(), resting, hanging], interface(firm(), rough()), DOWN).unwrap();
    let error = scene.settle(1e-9).unwrap_err();
    assert_eq!((error.body.as_str(), &error.lack), ("hanging", &Lack::Support));
    assert!(error.moved > 0.05, "{}", error.moved);
    let text = error.to_string();
    assert!(text.starts_with("body \"hanging\" does not come to rest under gravity (it moved"));
    assert!(text.ends_with("nothing lies under it, and nothing holds it"), "{text}");
}

#[test]
fn a_body_on_a_smooth_slope_does_not_settle() {
    let body = brick("sledge", (0.5, 0.2), 0.0, 0.1);
    let law = interface(firm(), FrictionLaw::Frictionless);
    let mut scene = Scene::new(vec![floor(), body], law, common::gravity_on_slope(0.2)).unwrap();
    let SettleError { body, lack, .. } = scene.settle(1e-9).unwrap_err();
    let expected = Lack::Friction { on: "ground".into(), interface: "contact".into() };
    assert_eq!((body.as_str(), lack), ("sledge", expected));
}

#[test]
fn evaluation_changes_nothing_but_scratch() {
    let mut scene = column(3).settled(1e-9).unwrap();
    let before = scene.state.clone();
    evaluate(&scene.model, &scene.state, &mut scene.scratch);
    assert_eq!(scene.state, before);
}

#[test]
fn dampers_change_not_one_bit_of_where_bodies_come_to_rest() {
    let resting = |damping: f64, tangential: f64| {
        let law = NormalLaw::SpeedGap { stiffness: STIFFNESS, damping };
        let friction = coulomb(0.5, STIFFNESS, tangential);
        let bodies = (0..3).map(|i| {
            brick(&format!("{i}"), (0.5, 0.2), 0.03 * f64::from(i), 0.1 + 0.2 * f64::from(i))
        });
        let bodies = std::iter::once(floor()).chain(bodies).collect();
        bits(
            &Scene::new(bodies, interface(law, friction), DOWN)
                .unwrap()
                .settled(1e-9)
                .unwrap()
                .state,
        )
    };
    let free = resting(0.0, 0.0);
    assert_eq!(free, resting(2e4, 1e4));
    // A restitution of 1e-9 or so.
    assert_eq!(free, resting(1e7, 1e7));
}

#[test]
fn regularized_friction_rests_on_a_level_floor_and_creeps_on_a_slope() {
    let creeping = FrictionLaw::Regularized { coefficient: 0.5, velocity: 1e-3 };
    let scene = |gravity| {
        let body = brick("sledge", (0.5, 0.2), 0.0, 0.1);
        Scene::new(vec![floor(), body], interface(firm(), creeping), gravity).unwrap()
    };
    let locked = scene(DOWN).settle(1e-9).unwrap().locked;
    assert_eq!((locked.holding, locked.friction), (0, 0.0));
    let SettleError { lack, .. } = scene(common::gravity_on_slope(0.1)).settle(1e-9).unwrap_err();
    assert_eq!(lack, Lack::Stick { on: "ground".into(), interface: "contact".into() });
    assert!(lack.to_string().starts_with("it creeps on \"ground\""), "{lack}");
}

#[test]
fn what_is_too_soft_for_its_load_is_said_to_sink() {
    let soft = NormalLaw::SpeedGap { stiffness: 1e3, damping: 10.0 };
    let body = brick("brick", (0.5, 0.2), 0.0, 0.1);
    let mut scene = Scene::new(vec![floor(), body], interface(soft, rough()), DOWN).unwrap();
    // 40 kg on two springs of 1 kN/m: 0.196 m, with a reach of 0.27 m.
    let SettleError { lack, .. } = scene.settle(1e-9).unwrap_err();
    assert!(matches!(lack, Lack::Stiffness { depth, .. } if depth > 0.02), "{lack}");
}
